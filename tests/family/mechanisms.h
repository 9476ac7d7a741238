/* mechanisms.h: a mechanism of one freedom as a script and as masses, run and compared */
#ifndef COTREE_TESTS_MECHANISMS_H
#define COTREE_TESTS_MECHANISMS_H

#include "../unit/session_kit.h"
#include "family.h"
#include "one_freedom.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

#define FAR 25 /* rad: what turns faster is followed for a shorter time */

enum { MOST_COMPARED = 24 };
typedef struct Trial {
    Script script;
    OneFreedom one;
    Real phi, rate;      /* at the start; once it has run, at the end */
    double time;         /* s */
    double size;         /* of the mechanism, m */
    double least_length; /* m, to which tolerances are absolute; 0: 1 */
    bool planar;
    int compared;
    struct {
        char name[16]; /* of a frame */
        int mass;      /* where it is in the oracle's masses */
    } compare[MOST_COMPARED];
} Trial;

static inline double draw(Member *member, double low, double high)
{
    return test_uniform(&member->random, low, high);
}

/* evenly over decades */
static inline double draw_decades(Member *member, double low, double high)
{
    return pow(10, draw(member, low, high));
}

static inline int draw_one_of(Member *member, int count)
{
    return (int)(test_random(&member->random) % (uint64_t)count);
}

/* place the name where masses[mass] is, at the end and as a guess */
static inline void compare_with(Trial *trial, const char *name, int mass)
{
    if (trial->compared == MOST_COMPARED)
        return;
    (void)snprintf(trial->compare[trial->compared].name, sizeof trial->compare[0].name, "%s", name);
    trial->compare[trial->compared++].mass = mass;
}

/* a rod along x of its own frame, with frames NAMEa and NAMEb at its ends */
static inline void write_rod(Script *script, const char *name, double mass, double length)
{
    write_line(script, "body %s mass=%.17g inertia=%.17g", name, mass, mass * length * length / 12);
    write_line(script, "arm %sa %s [%.17g, 0]; arm %sb %s [%.17g, 0]", name, name, -length / 2,
               name, name, length / 2);
}

static inline void write_guess(Script *script, const char *name, Spot at, double angle)
{
    write_line(script, "guess %s.x=%.17g, %s.y=%.17g, %s.theta=%.17g", name, (double)at.at[0].v,
               name, (double)at.at[1].v, name, angle);
}

/* The largest distance between frames and oracle at the end of the run. */
static inline double largest_miss(Kit *kit, const Trial *trial, const Masses *end)
{
    static const char axes[] = "xyz";
    double largest = 0;

    for (int k = 0; k < trial->compared; k++)
        for (int i = 0; i < (trial->planar ? 2 : 3); i++) {
            char name[32];
            double miss;

            (void)snprintf(name, sizeof name, "%s.%c", trial->compare[k].name, axes[i]);
            miss = fabs(kit_value(kit, name) - (double)end->spot[trial->compare[k].mass].at[i].v);
            if (!(miss <= largest))
                largest = miss;
        }
    return largest;
}

/* Run the script, whose last statement is the run, and compare. The bound is that of
 * research/numerics.md 8.8: 1e3 times the tolerance, or 1e-6. */
static inline Verdict run_trial(Member *member, Trial *trial, double tolerance)
{
    static Masses end;
    Kit kit = kit_new();
    const double bound = trial->size * fmax(1e3 * tolerance, 1e-6);
    double miss;
    ct_status status = kit_do(&kit, trial->script.text);

    tell(member, "%s", trial->script.text);
    if (status != CT_OK) {
        tell(member, "refused: %s\n", kit.error.message);
        kit_free(&kit);
        return REFUSED;
    }
    end.count = 0;
    trial->one.place(trial->one.mechanism, jet(trial->phi), &end);
    miss = largest_miss(&kit, trial, &end);
    tell(member, "phi %.12g, missed by %.3g, bound %.3g\n%s%s\n", (double)trial->phi, miss, bound,
         ct_remarks(kit.session), kit.text != NULL ? kit.text : "");
    kit_free(&kit);
    return keeps(member, "frames", miss, bound) ? AGREES : DISAGREES;
}

/* run_trial() of a script, with a tolerance, form and method of its own */
static inline Verdict run_any_way(Member *member, Trial *trial)
{
    static const char *const methods[] = {"", "", "", " method=dop853", " method=radau"};
    const char *method = methods[draw_one_of(member, COUNT(methods))];
    const bool low_order = strcmp(method, " method=radau") == 0; /* would take too long */
    const double tolerance = draw_decades(member, low_order ? -9 : -12, -6);

    trial->time = (double)one_freedom_run(&trial->one, trial->time, FAR, &trial->phi, &trial->rate);
    if (draw_one_of(member, 3) == 0)
        write_line(&trial->script, "form embedded");
    if (trial->least_length == 0)
        write_line(&trial->script, "simulate %.17g rtol=%.3g%s", trial->time, tolerance, method);
    else
        write_line(&trial->script, "simulate %.17g rtol=%.3g atol=%.3g%s", trial->time, tolerance,
                   tolerance * fmin(1, trial->least_length), method);
    return run_trial(member, trial, tolerance);
}

#endif
