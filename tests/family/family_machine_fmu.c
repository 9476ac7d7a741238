/* family_machine_fmu.c: FMUs of machines in which something jumps, in a simulator of our own,
 * against equations of another kind
 *
 * Random machines with switches, diodes, sampled control and events become Functional Mock-up
 * Units; tests/fmu/master.c runs them, for model exchange and for co-simulation, and holds their
 * outputs against those of the oracle of machine_hybrid.h. */
#include "machine_hybrid_draw.h"
#include "units.h"

enum { ITEMS = 10, ROWS = 5 };

/* a row of the oracle's, unless something jumps there; false: it isn't sure of it */
static bool write_row(Hybrid *h, double *at, double to, Real *y, const int *item, FILE *out)
{
    static Asks asks;
    const HybridAnswer answer = hybrid_asks(h, at, to, y, &asks);

    if (answer != HYBRID_ANSWERS)
        return answer == HYBRID_JUMPS;
    if (to == 0) {
        (void)fprintf(out, "t");
        for (int i = 0; i < ITEMS; i++)
            (void)fprintf(out, ",%s", asks.ask[item[i]].text);
        (void)fprintf(out, "\n");
        return true;
    }
    (void)fprintf(out, "%.17g", to);
    for (int i = 0; i < ITEMS; i++)
        (void)fprintf(out, ",%.17g", asks.ask[item[i]].wanted);
    (void)fprintf(out, "\n");
    return true;
}

static bool write_numbers(Hybrid *h, const int *item, const Work *w)
{
    Real y[MOST_STATES];
    double at = 0;
    FILE *out = fopen(w->numbers, "w");
    bool known;

    if (out == NULL)
        return false;
    memcpy(y, h->d.y, sizeof y);
    known = hybrid_starts(h, y) && !h->unsure && write_row(h, &at, 0, y, item, out);
    for (int row = 0; row < ROWS && known; row++)
        known = write_row(h, &at, 0.0131 + 0.0951 * row, y, item, out);
    return fclose(out) == 0 && known;
}

static bool write_script(Member *member, Hybrid *h, int *item, const Work *w)
{
    static Instant now;
    static Asks asks;
    FILE *out = fopen(w->script, "w");

    if (out == NULL)
        return false;
    memset(&now, 0, sizeof now);
    for (int b = 0; b < BODIES; b++)
        now.R[b] = turn_about(vec(0, 0, 1), 0);
    ask_all(&h->d.m, &now, &asks);
    (void)fprintf(out, "%sexport fmu", h->d.script.text);
    for (int i = 0; i < ITEMS; i++) {
        bool again = true;

        while (again) {
            item[i] = member_one_of(member, asks.count);
            again = false;
            for (int k = 0; k < i; k++)
                again = again || item[k] == item[i];
        }
        (void)fprintf(out, " %s", asks.ask[item[i]].text);
    }
    (void)fprintf(out, " version=%d > \"%s\"\n", 2 + member_one_of(member, 2), w->unit);
    return fclose(out) == 0;
}

static Verdict unit_runs(Member *member)
{
    static Hybrid h;
    static const char *const ways[] = {"exchange", "simulation"};
    Work w;
    int item[ITEMS];
    char arguments[300];
    Verdict verdict = AGREES;

    while (!draw_hybrid(member, &h, false))
        ;
    draw_tree(member, &h.d, member_one_of(member, 3));
    tell(member, "%s", h.d.script.text);
    if (!work_open(&w))
        return REFUSED;
    (void)snprintf(arguments, sizeof arguments, "-q %s", w.script);
    if (!write_script(member, &h, item, &w) || !write_numbers(&h, item, &w) ||
        !does("cotree", arguments, &w)) {
        report_said(member, &w);
        verdict = REFUSED;
    }
    for (int i = 0; i < 2 && verdict == AGREES; i++) {
        (void)snprintf(arguments, sizeof arguments, "%s %s %s 1e-6", w.unit, ways[i], w.numbers);
        if (!does("fmu_master", arguments, &w)) {
            tell(member, "%s\n", ways[i]);
            report_said(member, &w);
            verdict = DISAGREES;
        }
    }
    work_close(&w);
    return verdict;
}

/* Members that went wrong once: Newton's method stopped at the kink of a diode's law. */
static Verdict that_failed(Member *member)
{
    member->random = 9922 * 0x9E3779B97F4A7C15U + (member->number % 2 == 0 ? 2 : 7);
    (void)test_random(&member->random);
    return unit_runs(member);
}

static const Family families[] = {
    {"units of machines jump where and as their parts do", 1, 0.5, 0, unit_runs},
    {"units that failed once jump so", 2, 0, 0, that_failed},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
