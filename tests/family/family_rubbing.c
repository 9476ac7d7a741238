/* family_rubbing.c: friction in two and three directions between many, against time stepping
 *
 * Pucks on a plane rub on it and on each other, balls in their sockets turn about all axes. The
 * oracle knows no modes: steps of
 *
 *     M (v' - v) = h f(t, x) + sum of h w_k P_k,  |P_k| <= T_k,  P_k = -T_k d_k with d_k along w_k
 * v' where that moves
 *
 * (Moreau), P by sweeps, each projected onto its disc or ball. Its error falls with h; the
 * difference of h and h/2 bounds what cotree may differ by. Where more pucks stick than there are
 * motions a run may be refused: which of them holds is not determined. */
#include "../unit/session_kit.h"
#include "base/memory.h"
#include "base/text.h"
#include "family.h"

#include <math.h>

enum { MOST = 3, PARTS = 2 * MOST, SWEEPS = 4000, STEPS = 4000 };

typedef struct Scene {
    int axes; /* 2: pucks, 3: balls */
    int count, parts;
    double mass[MOST], spring[MOST], constant[MOST][3], swing[MOST][3], pace[MOST], phase[MOST];
    double place[MOST][3], speed[MOST][3];
    int first[PARTS], second[PARTS]; /* second -1: the ground */
    double bound[PARTS];
    double end;
} Scene;

/* --- the oracle --- */

static void push(const Scene *s, int k, const double impulse[3], double v[MOST][3])
{
    for (int a = 0; a < s->axes; a++) {
        v[s->first[k]][a] += impulse[a] / s->mass[s->first[k]];
        if (s->second[k] >= 0)
            v[s->second[k]][a] -= impulse[a] / s->mass[s->second[k]];
    }
}

/* one impulse, with the others as they are; how far it moves */
static double rub_once(const Scene *s, int k, double h, double v[MOST][3], double impulse[3])
{
    const double own =
        1 / s->mass[s->first[k]] + (s->second[k] >= 0 ? 1 / s->mass[s->second[k]] : 0);
    double wanted[3] = {0}, move[3] = {0}, norm = 0, moved = 0;

    for (int a = 0; a < s->axes; a++) {
        const double rate = v[s->first[k]][a] - (s->second[k] >= 0 ? v[s->second[k]][a] : 0);

        wanted[a] = impulse[a] - rate / own;
        norm = hypot(norm, wanted[a]);
    }
    for (int a = 0; a < s->axes; a++) {
        wanted[a] *= norm > h * s->bound[k] ? h * s->bound[k] / norm : 1;
        move[a] = wanted[a] - impulse[a];
        impulse[a] = wanted[a];
        moved = fmax(moved, fabs(move[a]));
    }
    push(s, k, move, v);
    return moved;
}

static void rub(const Scene *s, double h, double v[MOST][3], double impulse[PARTS][3])
{
    for (int k = 0; k < s->parts; k++)
        push(s, k, impulse[k], v);
    for (int turn = 0; turn < SWEEPS; turn++) {
        double moved = 0;

        for (int k = 0; k < s->parts; k++)
            moved = fmax(moved, rub_once(s, k, h, v, impulse[k]));
        if (moved < 1e-15 * h)
            break;
    }
}

static void step_through(const Scene *s, int steps, double x[MOST][3], double v[MOST][3])
{
    const double h = s->end / steps;
    double impulse[PARTS][3] = {{0}};

    memcpy(x, s->place, sizeof s->place);
    memcpy(v, s->speed, sizeof s->speed);
    for (int k = 0; k < steps; k++) {
        const double t = (k + 0.5) * h;
        double before[MOST][3];

        memcpy(before, v, sizeof before);
        for (int i = 0; i < s->count; i++)
            for (int a = 0; a < s->axes; a++)
                v[i][a] +=
                    h / s->mass[i] *
                    (s->constant[i][a] + s->swing[i][a] * sin(s->pace[i] * t + s->phase[i] + a) -
                     s->spring[i] * (x[i][a] + h / 2 * v[i][a]));
        rub(s, h, v, impulse);
        for (int i = 0; i < s->count; i++)
            for (int a = 0; a < s->axes; a++)
                x[i][a] += h / 2 * (before[i][a] + v[i][a]);
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

static void add_part(Member *member, Scene *s, int first, int second)
{
    s->first[s->parts] = first;
    s->second[s->parts] = second;
    s->bound[s->parts++] = pick(member, 0.5, 5);
}

static void draw(Member *member, Scene *s, int axes)
{
    *s = (Scene){.axes = axes, .count = 1 + chance(member, MOST), .end = pick(member, 0.5, 3)};
    for (int i = 0; i < s->count; i++) {
        const bool pushes = chance(member, 2) == 0, swings = chance(member, 3) > 0;
        const bool moves = chance(member, 2) == 0;

        s->mass[i] = pick(member, 0.3, 4);
        s->spring[i] = axes == 3 || chance(member, 2) == 0 ? 0 : pick(member, 1, 30);
        s->pace[i] = pick(member, 0.5, 6);
        s->phase[i] = pick(member, 0, 6);
        for (int a = 0; a < axes; a++) {
            s->constant[i][a] = pushes ? pick(member, -4, 4) : 0;
            s->swing[i][a] = swings ? pick(member, 0, 9) : 0;
            s->speed[i][a] = moves ? pick(member, -1, 1) : 0;
        }
        if (axes == 3 || chance(member, 4) > 0)
            add_part(member, s, i, -1);
        if (axes == 2 && i > 0 && chance(member, 4) > 0)
            add_part(member, s, i, i - 1);
    }
    if (s->parts == 0)
        add_part(member, s, 0, -1);
}

static void write_load(const Scene *s, int i, int a, Text *out)
{
    text_addf(out, "%.17g + %.17g*sin(%.17g*t + %.17g)", s->constant[i][a], s->swing[i][a],
              s->pace[i], s->phase[i] + a);
}

static void write_pucks(Member *member, const Scene *s, Text *out)
{
    static const char *const axes[] = {"s1", "s2"};

    for (int i = 0; i < s->count; i++) {
        text_addf(out,
                  "body m%d mass=%.17g inertia=[1, 1, 1]\nplanarjoint p%d ground m%d\n"
                  "driver d%d p%d.theta = 0\n",
                  i, s->mass[i], i, i, i, i);
        for (int a = 0; a < 2; a++) {
            text_addf(out, "actuator l%d%d p%d.%s force=", i, a, i, axes[a]);
            write_load(s, i, a, out);
            text_addf(out, " - %.17g*p%d.%s\ninit p%d.%s = 0, p%d.%s' = %.17g\n", s->spring[i], i,
                      axes[a], i, axes[a], i, axes[a], s->speed[i][a]);
        }
    }
    for (int k = 0; k < s->parts; k++)
        if (s->second[k] >= 0)
            text_addf(out, "friction f%d m%d m%d force=%.17g\n", k, s->second[k], s->first[k],
                      s->bound[k]);
        else if (chance(member, 2) == 0)
            text_addf(out, "friction f%d p%d force=%.17g\n", k, s->first[k], s->bound[k]);
        else
            text_addf(out, "friction f%d ground m%d force=%.17g\n", k, s->first[k], s->bound[k]);
}

static void write_balls(const Scene *s, Text *out)
{
    static const char axes[] = "xyz";

    for (int i = 0; i < s->count; i++) {
        text_addf(out,
                  "body m%d mass=1 inertia=[%.17g, %.17g, %.17g]\nspherical p%d ground m%d\n"
                  "torque l%d m%d [",
                  i, s->mass[i], s->mass[i], s->mass[i], i, i, i, i);
        for (int a = 0; a < 3; a++) {
            write_load(s, i, a, out);
            text_add(out, a < 2 ? ", " : "]\n");
        }
        for (int a = 0; a < 3; a++)
            text_addf(out, "init m%d.w%c = %.17g\n", i, axes[a], s->speed[i][a]);
    }
    for (int k = 0; k < s->parts; k++)
        text_addf(out, "friction f%d p%d torque=%.17g\n", k, s->first[k], s->bound[k]);
}

static Verdict compare(Member *member, const Scene *s, Kit *kit)
{
    const char *kind = s->axes == 3 ? "w" : "v";
    double x[2][MOST][3] = {{{0}}}, v[2][MOST][3] = {{{0}}};
    bool right = true;

    for (int k = 0; k < 2; k++)
        step_through(s, STEPS << k, x[k], v[k]);
    for (int i = 0; i < s->count; i++)
        for (int a = 0; a < s->axes; a++) {
            const double unsure =
                4 * fabs(v[0][i][a] - v[1][i][a]) + 4 * fabs(x[0][i][a] - x[1][i][a]);
            char name[64];

            (void)snprintf(name, sizeof name, "m%d.%s%c", i, kind, "xyz"[a]);
            right = keeps(member, name, fabs(kit_value(kit, name) - v[1][i][a]),
                          2e-3 * (1 + fabs(v[1][i][a])) + unsure) &&
                    right;
            (void)snprintf(name, sizeof name, "m%d.%c", i, "xy"[a % 2]);
            right = (s->axes == 3 || keeps(member, name, fabs(kit_value(kit, name) - x[1][i][a]),
                                           2e-3 * (1 + fabs(x[1][i][a])) + unsure)) &&
                    right;
        }
    return right ? AGREES : DISAGREES;
}

static Verdict run_scene(Member *member, int axes)
{
    static const char *const methods[] = {"auto", "auto", "radau", "bdf", "ida"};
    Scene s = {0};
    Text text = {0};
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    draw(member, &s, axes);
    if (axes == 2)
        write_pucks(member, &s, &text);
    else
        write_balls(&s, &text);
    if (chance(member, 3) == 0)
        text_add(&text, "tree absolute\n");
    if (chance(member, 3) == 0)
        text_add(&text, "form embedded\n");
    text_addf(&text, "simulate %.17g method=%s\n", s.end, methods[chance(member, COUNT(methods))]);
    tell(member, "%s", text.at);
    if (kit_do(&kit, text.at) == CT_OK)
        verdict = compare(member, &s, &kit);
    else
        tell(member, "refused: %s\n", kit.error.message);
    text_free(&text);
    kit_free(&kit);
    return verdict;
}

static Verdict pucks_that_rub(Member *member)
{
    return run_scene(member, 2);
}

static Verdict balls_that_rub(Member *member)
{
    return run_scene(member, 3);
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"pucks_that_rub", 20, 0.3, 0, pucks_that_rub},
        {"balls_that_rub", 40, 0, 0, balls_that_rub},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
