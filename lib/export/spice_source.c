/* spice_source.c: the time function of a SPICE source, as an expression of ours
 *
 * The formulas are those of the ngspice manual (version 39, chapter 4, "Voltage and Current
 * Sources"); values that are 0 or missing have the defaults given there. ramp(x) is max(0, x): with
 * it a source is constant until its delay is over. */
#include "export/spice_source.h"

#include <math.h>
#include <string.h>
#include <strings.h>

typedef struct SpiceSourceValues {
    Import *import;
    const SpiceValue *at;
    int count;
    const SpiceTimes *times;
    const char *why;
} SpiceSourceValues;

static bool is_zero(SpiceValue v)
{
    return v.is_number && v.number == 0;
}

/* the i-th number; `other` if it is missing, or is 0 and 0 means the default */
static SpiceValue take(const SpiceSourceValues *g, int i, SpiceValue other, bool zero_is_none)
{
    return i < g->count && !(zero_is_none && is_zero(g->at[i])) ? g->at[i] : other;
}

static SpiceValue plain(const SpiceSourceValues *g, int i)
{
    return take(g, i, spice_of(g->import, 0), false);
}

/* t - delay, 0 before that */
static const char *since(const SpiceSourceValues *g, SpiceValue delay)
{
    return is_zero(delay) ? "t" : import_text(g->import, "ramp(t - %s)", delay.text);
}

static const char *degrees(const SpiceSourceValues *g, SpiceValue phase)
{
    return is_zero(phase) ? "" : import_text(g->import, " + pi/180*%s", phase.text);
}

static const char *offset(const SpiceSourceValues *g, SpiceValue v)
{
    return is_zero(v) ? "" : import_text(g->import, "%s + ", v.text);
}

static SpiceValue one_over_stop(const SpiceSourceValues *g)
{
    const SpiceValue stop = g->times->stop;

    if (stop.is_number)
        return spice_of(g->import, stop.number > 0 ? 1 / stop.number : 0);
    return (SpiceValue){.text = import_text(g->import, "(1/%s)", stop.text)};
}

/* SIN(offset amplitude frequency delay damping phase) */
static const char *make_sine(SpiceSourceValues *g)
{
    const char *time = since(g, plain(g, 3));
    const SpiceValue damping = plain(g, 4);

    return import_text(
        g->import, "%s%s*sin(2*pi*%s*%s%s)%s", offset(g, plain(g, 0)), plain(g, 1).text,
        take(g, 2, one_over_stop(g), true).text, time, degrees(g, plain(g, 5)),
        is_zero(damping) ? "" : import_text(g->import, "*exp(-%s*%s)", damping.text, time));
}

/* PULSE(low high delay rise fall width period) */
static const char *make_pulse(SpiceSourceValues *g)
{
    const SpiceValue step = g->times->step, stop = g->times->stop;

    if (g->count > 7 && !is_zero(g->at[7])) {
        g->why = "a limited number of pulses can't be said";
        return NULL;
    }
    if (g->count < 6 && is_zero(stop)) {
        g->why = "its width is that of .tran, which isn't there";
        return NULL;
    }
    return import_text(
        g->import, "pulse(t, %s, %s, %s, %s, %s, %s%s)", plain(g, 0).alone, plain(g, 1).alone,
        plain(g, 2).alone, take(g, 3, step, true).alone, take(g, 4, step, true).alone,
        take(g, 5, stop, true).alone,
        g->count > 6 && !is_zero(g->at[6]) ? import_text(g->import, ", %s", g->at[6].alone) : "");
}

/* EXP(low high delay1 tau1 delay2 tau2) */
static const char *make_exponential(SpiceSourceValues *g)
{
    const SpiceValue low = plain(g, 0), high = plain(g, 1), step = g->times->step;
    const SpiceValue begin = plain(g, 2);
    const SpiceValue next =
        take(g, 4, (SpiceValue){.text = import_text(g->import, "(%s + %s)", begin.text, step.text)},
             true);
    const SpiceValue up = take(g, 3, step, true), down = take(g, 5, step, true);

    if (is_zero(up) || is_zero(down)) {
        g->why = "its time constants are those of .tran, which isn't there";
        return NULL;
    }
    return import_text(g->import, "%s(%s - %s)*(exp(-ramp(t - %s)/%s) - exp(-ramp(t - %s)/%s))",
                       offset(g, low), high.text, low.text, next.text, down.text, begin.text,
                       up.text);
}

/* SFFM(offset amplitude carrier index signal) */
static const char *make_modulated(SpiceSourceValues *g)
{
    return import_text(
        g->import, "%s%s*sin(2*pi*%s*t%s + %s*sin(2*pi*%s*t%s))", offset(g, plain(g, 0)),
        plain(g, 1).text, take(g, 2, one_over_stop(g), true).text, degrees(g, plain(g, 5)),
        plain(g, 3).text, take(g, 4, one_over_stop(g), true).text, degrees(g, plain(g, 6)));
}

/* t of a PWL: td= shifts it, r= repeats it from that time after its end */
static const char *time_of_pieces(const SpiceSourceValues *g)
{
    const char *time = g->times->delay.text != NULL
                           ? import_text(g->import, "(t - %s)", g->times->delay.text)
                           : "t";
    const char *from = g->times->repeat.text, *length;

    if (from == NULL || (g->times->repeat.is_number && g->times->repeat.number < 0))
        return time;
    length = import_text(g->import, "(%s - %s)", g->at[g->count - 2].text, from);
    return import_text(g->import, "%s - %s*max(0, floor((%s - %s)/%s))", time, length, time, from,
                       length);
}

/* PWL(t0 v0 t1 v1 ...) */
static const char *make_pieces(SpiceSourceValues *g)
{
    Text text = {0};
    const char *made;

    if (g->count < 2 || g->count % 2 != 0) {
        g->why = "it takes pairs of a time and a value";
        return NULL;
    }
    if (g->count == 2)
        return g->at[1].alone;
    text_addf(&text, "pwl(%s", time_of_pieces(g));
    for (int i = 0; i < g->count; i++)
        text_addf(&text, ", %s", g->at[i].alone);
    text_char(&text, ')');
    made = import_text(g->import, "%s", text.at);
    text_free(&text);
    return made;
}

static const struct {
    const char *name;
    int most; /* number of values; 0: any number */
    const char *(*make)(SpiceSourceValues *given);
} sources[] = {{"sin", 6, make_sine},        {"sine", 6, make_sine},      {"pulse", 8, make_pulse},
               {"exp", 6, make_exponential}, {"sffm", 7, make_modulated}, {"pwl", 0, make_pieces}};

static int find(const char *word)
{
    for (int i = 0; i < COUNT(sources); i++)
        if (strcasecmp(sources[i].name, word) == 0)
            return i;
    return -1;
}

bool spice_is_source(const char *word)
{
    return find(word) >= 0;
}

bool spice_source(Import *import, const char *name, const SpiceValue *values, int count,
                  const SpiceTimes *times, const char **out, const char **why)
{
    SpiceSourceValues given = {.import = import, .at = values, .count = count, .times = times};

    const int row = find(name);

    if (sources[row].most > 0 && count > sources[row].most) {
        *why =
            import_text(import, "%s takes %d values here, not %d", name, sources[row].most, count);
        return false;
    }
    *out = sources[row].make(&given);
    *why = given.why;
    return *out != NULL;
}
