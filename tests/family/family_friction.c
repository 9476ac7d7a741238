/* family_friction.c: friction, brakes and clutches between many, against time stepping
 *
 * Masses in a row rub on the ground and on their neighbours, so that more parts may stick than
 * there are motions. The same as joints, as shafts and as slides. The oracle knows no modes: steps
 * of
 *
 *     M (v' - v) = h f(t, x) + sum of h w_k P_k,  abs P_k <= T_k,  P_k = -T_k sign(w_k v') where it
 * moves
 *
 * (Moreau), P by projected sweeps. Its error falls with h: that of h and h/2 together is below h^2
 * but where something begins or ends to slip, and their difference bounds what cotree may differ
 * by. */
#include "../unit/session_kit.h"
#include "base/memory.h"
#include "base/text.h"
#include "family.h"
#include "units.h"

#include <math.h>

enum { MOST = 4, PARTS = 2 * MOST, SWEEPS = 4000 };

typedef struct Row {
    int count, parts;
    double mass[MOST], spring[MOST], constant[MOST], swing[MOST], pace[MOST], phase[MOST];
    double place[MOST], speed[MOST];
    int first[PARTS], second[PARTS]; /* second -1: the ground */
    double bound[PARTS];
    double end;
} Row;

/* --- the oracle --- */

static double rate_of(const Row *r, int k, const double *v)
{
    return v[r->first[k]] - (r->second[k] >= 0 ? v[r->second[k]] : 0);
}

static void push(const Row *r, int k, double impulse, double *v)
{
    v[r->first[k]] += impulse / r->mass[r->first[k]];
    if (r->second[k] >= 0)
        v[r->second[k]] -= impulse / r->mass[r->second[k]];
}

/* impulses of friction by sweeps, each within h T */
static void rub(const Row *r, double h, double *v, double *impulse)
{
    for (int k = 0; k < r->parts; k++)
        push(r, k, impulse[k], v);
    for (int turn = 0; turn < SWEEPS; turn++) {
        double moved = 0;

        for (int k = 0; k < r->parts; k++) {
            const double own =
                1 / r->mass[r->first[k]] + (r->second[k] >= 0 ? 1 / r->mass[r->second[k]] : 0);
            const double most = h * r->bound[k];
            double wanted = impulse[k] - rate_of(r, k, v) / own;

            wanted = fmin(most, fmax(-most, wanted));
            push(r, k, wanted - impulse[k], v);
            moved = fmax(moved, fabs(wanted - impulse[k]));
            impulse[k] = wanted;
        }
        if (moved < 1e-15 * h)
            break;
    }
}

static void step_through(const Row *r, int steps, double *x, double *v)
{
    const double h = r->end / steps;
    double impulse[PARTS] = {0};

    memcpy(x, r->place, sizeof r->place);
    memcpy(v, r->speed, sizeof r->speed);
    for (int k = 0; k < steps; k++) {
        const double t = (k + 0.5) * h;
        double before[MOST];

        memcpy(before, v, sizeof before);
        for (int i = 0; i < r->count; i++) {
            const double half = x[i] + h / 2 * v[i];

            v[i] += h / r->mass[i] *
                    (r->constant[i] + r->swing[i] * sin(r->pace[i] * t + r->phase[i]) -
                     r->spring[i] * half);
        }
        rub(r, h, v, impulse);
        for (int i = 0; i < r->count; i++)
            x[i] += h / 2 * (before[i] + v[i]);
    }
}

/* --- the same in statements --- */

static int chance(Member *member, int count)
{
    return (int)(test_random(&member->random) % (uint64_t)count);
}

static double pick(Member *member, double low, double high)
{
    return test_uniform(&member->random, low, high);
}

static void add_part(Member *member, Row *r, int first, int second)
{
    r->first[r->parts] = first;
    r->second[r->parts] = second;
    r->bound[r->parts++] = pick(member, 0.5, 5);
}

static void draw(Member *member, Row *r)
{
    *r = (Row){.count = 1 + chance(member, MOST), .end = pick(member, 0.5, 3)};
    for (int i = 0; i < r->count; i++) {
        r->mass[i] = pick(member, 0.3, 4);
        r->spring[i] = chance(member, 2) == 0 ? 0 : pick(member, 1, 30);
        r->constant[i] = chance(member, 2) == 0 ? 0 : pick(member, -6, 6);
        r->swing[i] = chance(member, 3) == 0 ? 0 : pick(member, 0, 12);
        r->pace[i] = pick(member, 0.5, 6);
        r->phase[i] = pick(member, 0, 6);
        r->speed[i] = chance(member, 2) == 0 ? 0 : pick(member, -1, 1);
        r->place[i] = chance(member, 2) == 0 || r->spring[i] == 0 ? 0 : pick(member, -0.3, 0.3);
        if (chance(member, 4) > 0)
            add_part(member, r, i, -1);
        if (i > 0 && chance(member, 4) > 0)
            add_part(member, r, i - 1, i);
    }
    if (r->parts == 0)
        add_part(member, r, 0, -1);
}

/* joints along or about an axis */
static void write_joints(Member *member, const Row *r, Text *out)
{
    const bool turns = chance(member, 2) == 0;
    const char *bound = turns ? "torque" : "force";

    text_add(out, "scene planar\n");
    for (int i = 0; i < r->count; i++) {
        text_addf(out, "body m%d mass=%.17g inertia=%.17g\n%s s%d ground m%d%s\n", i, r->mass[i],
                  turns ? r->mass[i] : 0, turns ? "revolute" : "prismatic", i, i,
                  turns ? "" : " axis=x");
        text_addf(out, "actuator l%d s%d %s=%.17g + %.17g*sin(%.17g*t + %.17g)\n", i, i, bound,
                  r->constant[i], r->swing[i], r->pace[i], r->phase[i]);
        text_addf(out, "spring k%d s%d k=%.17g\n", i, i, r->spring[i]);
    }
    for (int k = 0; k < r->parts; k++)
        if (r->second[k] < 0)
            text_addf(out, "%s f%d s%d %s=%.17g\n", chance(member, 2) == 0 ? "friction" : "brake",
                      k, r->first[k], bound, r->bound[k]);
        else
            text_addf(out, "clutch f%d s%d s%d %s=%.17g\n", k, r->first[k], r->second[k], bound,
                      r->bound[k]);
    if (chance(member, 3) == 0)
        text_add(out, "tree absolute\n");
    if (chance(member, 3) == 0)
        text_add(out, "form embedded\n");
    for (int i = 0; i < r->count; i++)
        text_addf(out, "init s%d = %.17g, s%d' = %.17g\n", i, r->place[i], i, r->speed[i]);
}

/* the terminals of a shaft or slide */
static void write_terminals(Member *member, const Row *r, Text *out)
{
    const bool turns = chance(member, 2) == 0;
    const char *bound = turns ? "torque" : "force";

    for (int i = 0; i < r->count; i++) {
        text_addf(out, "%s m%d a%d 0 %s=%.17g\n", turns ? "flywheel" : "slug", i, i,
                  turns ? "J" : "m", r->mass[i]);
        text_addf(out, "%ssource l%d a%d 0 %.17g + %.17g*sin(%.17g*t + %.17g)\n", bound, i, i,
                  r->constant[i], r->swing[i], r->pace[i], r->phase[i]);
        if (r->spring[i] > 0)
            text_addf(out, "%s k%d a%d 0 k=%.17g\ninit k%d.%s = %.17g\n", turns ? "shaft" : "rod",
                      i, i, r->spring[i], i, bound, r->spring[i] * r->place[i]);
        text_addf(out, "init m%d.%s = %.17g\n", i, turns ? "w" : "v", r->speed[i]);
    }
    for (int k = 0; k < r->parts; k++)
        if (r->second[k] < 0)
            text_addf(out, "%s f%d a%d 0 %s=%.17g\n", chance(member, 2) == 0 ? "friction" : "brake",
                      k, r->first[k], bound, r->bound[k]);
        else
            text_addf(out, "clutch f%d a%d a%d %s=%.17g\n", k, r->first[k], r->second[k], bound,
                      r->bound[k]);
}

static Verdict compare(Member *member, const Row *r, Kit *kit, bool joints)
{
    enum { STEPS = 4000 };
    double x[2][MOST], v[2][MOST];
    bool right = true;

    for (int k = 0; k < 2; k++)
        step_through(r, STEPS << k, x[k], v[k]);
    for (int i = 0; i < r->count; i++) {
        const double unsure = 4 * fabs(v[0][i] - v[1][i]) + 4 * fabs(x[0][i] - x[1][i]);
        char name[64];

        if (joints)
            (void)snprintf(name, sizeof name, "s%d'", i);
        else
            (void)snprintf(name, sizeof name, "m%d.momentum/%.17g", i, r->mass[i]);
        right = keeps(member, name, fabs(kit_value(kit, name) - v[1][i]),
                      2e-3 * (1 + fabs(v[1][i])) + unsure) &&
                right;
        (void)snprintf(name, sizeof name, "s%d", i);
        right = (!joints || keeps(member, name, fabs(kit_value(kit, name) - x[1][i]),
                                  2e-3 * (1 + fabs(x[1][i])) + unsure)) &&
                right;
    }
    return right ? AGREES : DISAGREES;
}

static Verdict run_row(Member *member, bool joints)
{
    static const char *const methods[] = {"auto", "auto", "radau", "bdf", "ida"};
    Row r;
    Text text = {0};
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    draw(member, &r);
    if (joints)
        write_joints(member, &r, &text);
    else
        write_terminals(member, &r, &text);
    text_addf(&text, "simulate %.17g method=%s\n", r.end, methods[chance(member, COUNT(methods))]);
    tell(member, "%s", text.at);
    if (kit_do(&kit, text.at) == CT_OK)
        verdict = compare(member, &r, &kit, joints);
    else
        tell(member, "refused: %s\n", kit.error.message);
    text_free(&text);
    kit_free(&kit);
    return verdict;
}

static Verdict joints_that_rub(Member *member)
{
    return run_row(member, true);
}

static Verdict shafts_and_slides_that_rub(Member *member)
{
    return run_row(member, false);
}

/* The same as a Functional Mock-up Unit, against a run of small tolerances: both are exact between
 * events, so that more can be asked than of the oracle. */
static Verdict units_that_rub(Member *member)
{
    static const char *const ways[] = {"exchange", "simulation"};
    const bool joints = chance(member, 2) == 0;
    Row r;
    Text text = {0}, items = {0};
    Work w;
    Verdict verdict = AGREES;
    FILE *script;

    draw(member, &r);
    if (joints)
        write_joints(member, &r, &text);
    else
        write_terminals(member, &r, &text);
    for (int i = 0; i < r.count; i++)
        if (joints)
            text_addf(&items, " s%d s%d'", i, i);
        else
            text_addf(&items, " m%d.momentum", i);
    tell(member, "%s", text.at);
    if (!work_open(&w))
        return REFUSED;
    text_addf(&text,
              "simulate %.17g every=%.17g rtol=1e-10 atol=1e-11\nexport csv%s > \"%s\"\n"
              "export fmu%s version=%d > \"%s\"\n",
              r.end, r.end / 8, items.at, w.numbers, items.at, 2 + chance(member, 2), w.unit);
    script = fopen(w.script, "w");
    if (script != NULL) {
        char arguments[300];

        (void)fputs(text.at, script);
        (void)fclose(script);
        (void)snprintf(arguments, sizeof arguments, "-q %s", w.script);
        if (!does("cotree", arguments, &w))
            verdict = REFUSED;
        for (int i = 0; i < 2 && verdict == AGREES; i++) {
            (void)snprintf(arguments, sizeof arguments, "%s %s %s 2e-6", w.unit, ways[i],
                           w.numbers);
            if (!does("fmu_master", arguments, &w)) {
                tell(member, "%s\n", ways[i]);
                verdict = DISAGREES;
            }
        }
    }
    if (verdict != AGREES)
        report_said(member, &w);
    work_close(&w);
    text_free(&text);
    text_free(&items);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"joints_that_rub", 60, 0, 0, joints_that_rub},
        {"shafts_and_slides_that_rub", 60, 0, 0, shafts_and_slides_that_rub},
        {"units_that_rub", 2, 0, 0, units_that_rub},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
