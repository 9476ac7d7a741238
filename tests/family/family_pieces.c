/* family_pieces.c: random networks and multipliers of diodes and switches with resistances, at any
 * tolerance and by any method, against matrix exponentials between changes of sides (pieces.h)
 *
 * A run may be off by MANY tolerances in each state, and in a node's voltage by what that makes of
 * it there, on whatever sides it puts diodes. */
#include "../unit/session_kit.h"
#include "family.h"
#include "networks_script.h"
#include "pieces.h"

#define MANY  100 /* tolerances: more than errors may add up to */
#define STEPS 1e4 /* what stability may cost */

static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams", "ida"};

/* how a value that the run tells compares */
typedef struct Told {
    Member *m;
    Kit *kit;
    double t;
    Verdict verdict;
    double worst; /* of the errors, in what they may be */
} Told;

static void hold_against(Told *told, const char *name, double wanted, double within)
{
    char look[64];
    double got;

    (void)snprintf(look, sizeof look, "%s at %.17g", name, told->t);
    got = kit_value(told->kit, look);
    told->worst = fmax(told->worst, fabs(got - wanted) / within);
    if (fabs(got - wanted) <= within)
        return;
    tell(told->m, "%s is %.9g, not %.9g within %.2g\n", look, got, wanted, within);
    told->verdict = DISAGREES;
}

static void compare_at(Told *told, const Pieces *o, double off)
{
    double v[ROOM + 1], spread[ROOM + 1];
    char name[16];

    if (!pieces_read(o, off, v, spread)) {
        tell(told->m, "no sides at t = %.9g\n", o->t);
        told->verdict = REFUSED;
        return;
    }
    for (int i = 1; i <= o->net->nodes; i++) {
        (void)snprintf(name, sizeof name, "n%d.v", i);
        hold_against(told, name, v[i],
                     spread[i] + o->net->tolerance * (1 + fabs(v[i])) + EXACT * o->largest);
    }
    for (int i = 0; i < o->net->count; i++) {
        const Part *p = &o->net->part[i];
        const double across = (p->plus > 0 ? v[p->plus] : 0) - (p->minus > 0 ? v[p->minus] : 0);

        (void)snprintf(name, sizeof name, "C%d.v", i);
        if (p->kind == CAPACITOR)
            hold_against(told, name, across, off * (1 + fabs(across)) + EXACT * o->largest);
    }
    for (int c = 0; c < o->coils; c++) {
        const double i = o->z[o->rank + c];

        (void)snprintf(name, sizeof name, "L%d.i", o->coil[c]);
        hold_against(told, name, i, off * (1 + fabs(i)) + EXACT * 1e-2 * o->largest);
    }
}

static Verdict compare(Member *m, const Network *net, Kit *kit)
{
    Pieces *o = calloc(1, sizeof *o);
    Told told = {.m = m, .kit = kit, .verdict = AGREES};
    bool sound = pieces_begin(o, net);

    for (int k = 0; k < POINTS && sound; k++) {
        told.t = net->end * (k + 1) / POINTS;
        sound = pieces_go_to(o, told.t);
        if (sound)
            compare_at(&told, o, MANY * net->tolerance);
    }
    if (!sound)
        tell(m, "the oracle ends at t = %.9g\n", o->t);
    tell(m, "worst error: %.3g of what it may be\n", told.worst);
    pieces_free(o);
    return sound ? told.verdict : DISAGREES;
}

static Verdict run_network(Member *m, const Network *net)
{
    Script *script = malloc(sizeof *script);
    Kit kit = kit_new();
    Verdict verdict;

    write_script(script, net);
    tell(m, "%s", script->text);
    if (kit_do(&kit, script->text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = REFUSED;
    } else {
        verdict = compare(m, net, &kit);
    }
    kit_free(&kit);
    free(script);
    return verdict;
}

/* Stability limits explicit methods to the time that the smallest resistance and capacitor have:
 * they are for networks where that isn't everything. */
static const char *pick_method(uint64_t *random, const Network *net)
{
    const char *method = methods[pick(random, sizeof methods / sizeof methods[0])];
    double quickest = INFINITY;

    for (int i = 0; i < net->count; i++) {
        const Part *p = &net->part[i];

        for (int k = 0; k < net->count; k++)
            if (p->kind == CAPACITOR && net->part[k].kind == DIODE)
                quickest = fmin(quickest, p->value * net->part[k].on);
    }
    return net->end > STEPS * quickest && (strcmp(method, "dop853") == 0 || method[0] == 'a')
               ? "auto"
               : method;
}

static Verdict networks(Member *m)
{
    Network net;

    make(&net, &m->random, WITH_RESISTANCES);
    net.tolerance = test_decades(&m->random, 1e-9, 1e-3);
    net.method = pick_method(&m->random, &net);
    return run_network(m, &net);
}

static Verdict multipliers(Member *m)
{
    Network net;

    make_multiplier(&net, &m->random);
    net.tolerance = test_decades(&m->random, 1e-9, 1e-3);
    net.method = pick_method(&m->random, &net);
    return run_network(m, &net);
}

/* Members that went wrong once: an open diode that blocked for good what the tolerance makes of a
 * resistor beside a coil; a closed one whose current was past its end too slowly to be seen; ends
 * of a multiplier that were met late, and to and fro; diodes that were closed at an instant at
 * which they still blocked; a row read far within a step that the source alone led; leaks that
 * push closed diodes back, which the exponentials left closed. */
static Verdict those_that_failed(Member *m)
{
    static const struct {
        uint64_t seed, number;
        bool multiplies;
        double tolerance;
    } failed[] = {
        {77, 375, false, 3.73e-6}, {502, 157, false, 6.8e-7},  {502, 26, true, 1.01e-8},
        {12, 47, true, 1e-3},      {12, 47, true, 3.45e-5},    {20261123, 144, false, 2.76e-7},
        {9102, 2, true, 2.36e-9},  {9912, 22, false, 4.91e-8}, {9913, 14, false, 5.86e-9}};
    const size_t which = (size_t)m->number % (sizeof failed / sizeof failed[0]);
    Network net;

    m->random = failed[which].seed * 0x9E3779B97F4A7C15U + failed[which].number;
    (void)test_random(&m->random);
    if (failed[which].multiplies)
        make_multiplier(&net, &m->random);
    else
        make(&net, &m->random, WITH_RESISTANCES);
    net.tolerance = failed[which].tolerance;
    net.method = "auto";
    return run_network(m, &net);
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"networks follow exponentials at any tolerance", 10, 0.01, 0, networks},
        {"multipliers follow exponentials at any tolerance", 2, 0.01, 0, multipliers},
        {"networks that failed once follow them", 9, 0, 0, those_that_failed},
    };

    return test_faults + family_main(families, sizeof families / sizeof families[0], argc, argv);
}
