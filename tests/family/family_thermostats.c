/* family_thermostats.c: on/off controllers by two events, against exponentials in closed form
 *
 * A store of capacity C, its loss x/R and a source that a memory S turns on: with tau = R C,
 *
 *     tau x' = (on ? top : 0) - x
 *
 * One event turns the source on where x has fallen below `low`, one off above `high`. From x0 the
 * level x1 is reached after tau log((x0 - top)/(x1 - top)). A second event may carry the first on:
 * the source follows a relay that events set from S, at the same instant. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams", "ida"};

/* the same equations in three domains; a source of flow, the store, the loss, the level's letter */
typedef struct Domain {
    const char *source, *store, *loss, *letter;
} Domain;
static const Domain domains[] = {
    {"isource H 0 a %s", "capacitor C a 0 %.17g", "resistor R a 0 %.17g", "v"},
    {"heatsource H a 0 %s", "heatcap C a 0 C=%.17g", "heatres R a 0 R=%.17g", "T"},
    {"pump H a 0 flow=%s", "tank C a 0 C=%.17g", "pipe R a 0 R=%.17g", "p"},
};

typedef struct Thermostat {
    double top, low, high, R, C, x; /* x: at first */
    bool on, relay;
    const Domain *domain;
} Thermostat;

/* x after `time`, and how often the source has been turned on and off */
static double thermostat_run(const Thermostat *s, double time, int *ons, int *offs)
{
    const double tau = s->R * s->C;
    double x = s->x;
    bool on = s->on;

    *ons = *offs = 0;
    for (;;) {
        const double top = on ? s->top : 0, level = on ? s->high : s->low;
        const double wait = tau * log((x - top) / (level - top));

        /* the source is off below the lower level: that was never crossed */
        if (!on && x <= s->low && *offs == 0)
            return x * exp(-time / tau);
        if (wait > time)
            return top + (x - top) * exp(-time / tau);
        time -= wait;
        x = level;
        *(on ? offs : ons) += 1;
        on = !on;
    }
}

static void thermostat_draw(Member *m, Thermostat *s)
{
    *s = (Thermostat){.top = member_decades(m, 0.1, 1e4),
                      .R = member_decades(m, 1e-2, 1e2),
                      .C = member_decades(m, 1e-2, 1e2),
                      .relay = member_one_of(m, 3) == 0,
                      .domain = &domains[member_one_of(m, COUNT(domains))]};
    s->low = s->top * member_between(m, 0.1, 0.6);
    s->high = s->low + member_decades(m, 1e-3, 0.3) * (0.9 * s->top - s->low);
    s->on = member_one_of(m, 3) > 0;
    s->x = s->low * member_between(m, 0, 0.9); /* cold */
    if (member_one_of(m, 2))
        s->x = s->low + (s->high - s->low) * member_between(m, 0.1, 0.9);
}

static void thermostat_write(Script *text, const Thermostat *s)
{
    char law[80];

    (void)snprintf(law, sizeof law, "if(%s > 0.5, %.17g, 0)", s->relay ? "Q.v" : "S.v",
                   s->top / s->R);
    *text = (Script){0};
    write_line(text, "capacitor S s 0 1\nisource Is s 0 0\ncapacitor Q q 0 1\nisource Iq q 0 0");
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    write_line(text, s->domain->source, law);
    write_line(text, s->domain->store, s->C);
    write_line(text, s->domain->loss, s->R);
#pragma GCC diagnostic pop
    write_line(text, "event on when=C.%s < %.17g S.v=1", s->domain->letter, s->low);
    write_line(text, "event off when=C.%s > %.17g S.v=0", s->domain->letter, s->high);
    if (s->relay)
        write_line(text, "event up when=S.v > 0.5 Q.v=1\nevent down when=S.v < 0.5 Q.v=0");
    write_line(text, "init C.%s = %.17g, S.v = %d, Q.v = %d", s->domain->letter, s->x, s->on,
               s->on);
}

/* the times that `show events` has for an event: "NAME  N times: ...", or one time alone */
static int times_of(const char *text, const char *name)
{
    const char *run = text != NULL ? strstr(text, "in the last run") : NULL;
    char start[20];
    const char *at;
    int count = 0;

    (void)snprintf(start, sizeof start, "\n  %s ", name);
    at = run != NULL ? strstr(run, start) : NULL;
    if (at == NULL)
        return -1;
    at += strlen(start) + strspn(at + strlen(start), " ");
    if (strncmp(at, "not", 3) == 0)
        return 0;
    return sscanf(at, "%d times", &count) == 1 &&
                   strncmp(at + strspn(at, "0123456789"), " times", 6) == 0
               ? count
               : 1;
}

static Verdict thermostat_compare(Member *m, const Thermostat *s, Kit *kit, double until,
                                  double rtol)
{
    char look[20];
    int ons, offs;
    const double wanted = thermostat_run(s, until, &ons, &offs);
    double got;
    bool right;

    (void)snprintf(look, sizeof look, "C.%s", s->domain->letter);
    got = kit_value(kit, look);
    tell(m, "%s is %.12g, not %.12g\n", look, got, wanted);
    right =
        keeps(m, "level", fabs(got - wanted) / s->top, fmax(1e-9, 100 * rtol * (ons + offs + 2)));
    if (kit_do(kit, "show events\n") != CT_OK || times_of(kit->text, "on") != ons ||
        times_of(kit->text, "off") != offs) {
        tell(m, "on %d times, off %d times, not:\n%s\n", ons, offs, kit->text);
        right = false;
    }
    return right ? AGREES : DISAGREES;
}

static Verdict thermostat_member(Member *m)
{
    static Script text;
    Thermostat s;
    double tau, down, up, until, rtol;
    Kit kit = kit_new();
    Verdict verdict = DISAGREES;

    thermostat_draw(m, &s);
    tau = s.R * s.C;
    down = tau * log(s.high / s.low);
    up = tau * log((s.top - s.low) / (s.top - s.high));
    /* the middle of a fall, after the first rise and some periods */
    until = tau * log((s.top - s.x) / (s.top - s.high)) + member_one_of(m, 7) * (down + up) +
            member_between(m, 0.2, 0.8) * down;
    if (!s.on && s.x > s.low)
        until = tau * log(s.x / s.low) + member_one_of(m, 7) * (down + up) +
                member_between(m, 0.2, 0.8) * up;
    /* its instants are told apart: by far less than the gap */
    rtol = fmin(member_decades(m, 1e-10, 1e-5), 1e-4 * (s.high - s.low) / s.top);
    thermostat_write(&text, &s);
    write_line(&text, "simulate %.17g every=%.17g rtol=%.3g atol=%.3g method=%s", until, until / 7,
               rtol, rtol * 1e-3, methods[member_one_of(m, COUNT(methods))]);
    tell(m, "%s", text.text);
    if (kit_do(&kit, text.text) != CT_OK)
        tell(m, "%s\n%s\n", kit.error.message, kit.error.hint);
    else
        verdict = thermostat_compare(m, &s, &kit, until, rtol);
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    {"thermostats switch at their instants", 100, 0, 0, thermostat_member},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
