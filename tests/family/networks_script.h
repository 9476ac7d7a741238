/* networks_script.h: a random network in statements */
#ifndef COTREE_TESTS_NETWORKS_SCRIPT_H
#define COTREE_TESTS_NETWORKS_SCRIPT_H

#include "networks.h"

#include <stdarg.h>
#include <stdio.h>

typedef struct Script {
    char text[8192];
    size_t length;
} Script;

__attribute__((format(printf, 2, 3))) static void put(Script *script, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    script->length += (size_t)vsnprintf(script->text + script->length,
                                        sizeof script->text - script->length, format, arguments);
    va_end(arguments);
}

static void put_part(Script *script, const Network *net, int i)
{
    const Part *p = &net->part[i];
    char ends[64], sides[64] = "";

    (void)snprintf(ends, sizeof ends, "%s%d %s%d", p->plus > 0 ? "n" : "", p->plus,
                   p->minus > 0 ? "n" : "", p->minus);
    if (!net->ideal)
        (void)snprintf(sides, sizeof sides, " Ron=%.17g Roff=%.17g", p->on, p->off);
    switch (p->kind) {
    case RESISTOR:
        put(script, "resistor R%d %s %.17g\n", i, ends, p->value);
        break;
    case CAPACITOR:
        put(script, "capacitor C%d %s %.17g\n", i, ends, p->value);
        break;
    case COIL:
        put(script, "inductor L%d %s %.17g\n", i, ends, p->value);
        break;
    case SOURCE:
        put(script, "vsource V%d s%d 0 %.17g*sin(w*t + %.17g)\nresistor RS%d s%d n%d %.17g\n", i, i,
            p->value, p->phase, i, i, p->plus, p->series);
        break;
    case DIODE:
        if (net->exponential)
            put(script, "diode D%d %s Is=%.17g n=%.17g\n", i, ends, p->Is, p->scale);
        else
            put(script, "diode D%d %s Vf=%.17g%s\n", i, ends, p->least, sides);
        break;
    case SWITCH:
        put(script, "switch S%d %s%d m%d when=sin(w*t + %.17g) > %.17g%s\n", i,
            p->plus > 0 ? "n" : "", p->plus, i, p->phase, p->level, sides);
        put(script, "resistor RS%d m%d %s%d %.17g\n", i, i, p->minus > 0 ? "n" : "", p->minus,
            p->series);
        break;
    }
}

static void write_script(Script *script, const Network *net)
{
    bool any = false;

    script->length = 0;
    put(script, "w = %.17g\n", net->omega);
    for (int i = 0; i < net->count; i++)
        put_part(script, net, i);
    for (int i = 0; i < net->count; i++)
        if (net->part[i].kind == CAPACITOR && net->part[i].start != 0) {
            put(script, "%s C%d.v = %.17g", any ? "," : "init", i, net->part[i].start);
            any = true;
        }
    if (net->longer > 0)
        put(script, "%sevent over when=t > %.17g do=stop", any ? "\n" : "", 1.001 * net->end);
    any = any || net->longer > 0;
    put(script, "%ssimulate %.17g every=%.17g rtol=%.3g atol=%.3g method=%s\n", any ? "\n" : "",
        net->longer > 0 ? net->longer * net->end : net->end,
        net->end / POINTS, /* rows at the points: between them a transient may lie */
        net->tolerance > 0 ? net->tolerance : 1e-9, net->tolerance > 0 ? net->tolerance : 1e-10,
        net->method != NULL ? net->method : "auto");
}

#endif
