/* family_journals.c: bars in chains and loops with friction in all journals, against Newton-Euler
 *
 * Bars in a plane, one after the other, hang on the ground, or lead back to it. Each journal rubs
 * with up to c N, N the norm of its force. At the end of a short run the oracle writes the
 * equations of the single bars with the forces in the journals as unknowns, at cotree's angles and
 * rates, and iterates the loads: torque = -c N sign(rate) where the journal slips. Where it sticks
 * the torque is cotree's, which has to be within the static bound. */
#include "../unit/session_kit.h"
#include "base/memory.h"
#include "base/text.h"
#include "family.h"

#include <math.h>
#include <string.h>

enum { MOST = 4, JOINTS = MOST + 1, UNKNOWNS = 3 * MOST + 2 * JOINTS };

typedef struct Bars {
    int count, joints;
    double mass[MOST], inertia[MOST], half[MOST], angle[MOST], speed[MOST], pull[MOST];
    double c[JOINTS], ratio;
    double end;
} Bars;

typedef struct Found { /* at the end of the run */
    double angle[MOST], rate[MOST], alpha[MOST], effort[JOINTS], load[JOINTS];
} Found;

/* --- the oracle --- */

static void eliminate(double a[UNKNOWNS][UNKNOWNS + 1], int n, double *x)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;

        for (int i = k + 1; i < n; i++)
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        for (int j = 0; j <= n; j++) {
            const double kept = a[k][j];

            a[k][j] = a[pivot][j];
            a[pivot][j] = kept;
        }
        for (int i = 0; i < n; i++) {
            const double part = i == k ? 0 : a[i][k] / a[k][k];

            for (int j = k; j <= n && part != 0; j++)
                a[i][j] -= part * a[k][j];
        }
    }
    for (int k = 0; k < n; k++)
        x[k] = a[k][n] / a[k][k];
}

/* bar and end (-1, 1) on either side of a joint, from bar j - 1 to bar j; -1: the ground */
static int side_of(const Bars *b, int j, int side, double *end)
{
    const int bar = side == 0 ? j - 1 : j;

    *end = side == 0 ? 1 : -1;
    return bar < b->count ? bar : -1;
}

static double slip_of(const Bars *b, const Found *f, int j)
{
    return (j < b->count ? f->rate[j] : 0) - (j > 0 ? f->rate[j - 1] : 0);
}

static void forces(const Bars *b, const Found *f, const double *torque, double *x)
{
    double a[UNKNOWNS][UNKNOWNS + 1] = {{0}};
    const int first = 3 * b->count, n = first + 2 * b->joints;

    for (int i = 0; i < b->count; i++) {
        a[3 * i][3 * i] = a[3 * i + 1][3 * i + 1] = b->mass[i];
        a[3 * i + 2][3 * i + 2] = b->inertia[i];
        a[3 * i][n] = b->pull[i];
        a[3 * i + 1][n] = -b->mass[i] * 9.81;
    }
    for (int j = 0; j < b->joints; j++)
        for (int side = 0; side < 2; side++) {
            const int sign = side == 0 ? -1 : 1, fx = first + 2 * j;
            double end, rx, ry;
            const int bar = side_of(b, j, side, &end);

            if (bar < 0)
                continue;
            rx = end * b->half[bar] * cos(f->angle[bar]);
            ry = end * b->half[bar] * sin(f->angle[bar]);
            a[3 * bar][fx] = a[3 * bar + 1][fx + 1] = -sign;
            a[3 * bar + 2][fx] = sign * ry;
            a[3 * bar + 2][fx + 1] = -sign * rx;
            a[3 * bar + 2][n] += sign * torque[j];
            a[fx][3 * bar] = a[fx + 1][3 * bar + 1] = sign;
            a[fx][3 * bar + 2] = -sign * ry;
            a[fx + 1][3 * bar + 2] = sign * rx;
            a[fx][n] += sign * f->rate[bar] * f->rate[bar] * rx;
            a[fx + 1][n] += sign * f->rate[bar] * f->rate[bar] * ry;
        }
    eliminate(a, n, x);
}

/* the loads by iteration; false: they don't settle */
static bool settle(const Bars *b, const Found *f, double *load, double *x)
{
    double torque[JOINTS] = {0}, moved = 1;

    memset(load, 0, JOINTS * sizeof(double));
    for (int turn = 0; turn < 2000 && moved > 1e-12; turn++) {
        moved = 0;
        for (int j = 0; j < b->joints; j++) {
            const double slip = slip_of(b, f, j);

            torque[j] = fabs(slip) < 1e-9 ? f->effort[j] : -b->c[j] * load[j] * (slip > 0 ? 1 : -1);
        }
        forces(b, f, torque, x);
        for (int j = 0; j < b->joints; j++) {
            const double now = hypot(x[3 * b->count + 2 * j], x[3 * b->count + 2 * j + 1]);

            moved = fmax(moved, fabs(now - load[j]) / (1 + now));
            load[j] = now;
        }
    }
    return moved <= 1e-12;
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

static void draw(Member *member, Bars *b)
{
    *b = (Bars){.count = 1 + chance(member, MOST), .end = pick(member, 0.01, 0.6)};
    b->joints = b->count + (b->count > 2 && chance(member, 2) == 0);
    b->ratio = chance(member, 2) == 0 ? 1 : pick(member, 1, 1.5);
    for (int i = 0; i < b->count; i++) {
        b->mass[i] = pick(member, 0.3, 3);
        b->half[i] = pick(member, 0.1, 0.5);
        b->inertia[i] = b->mass[i] * b->half[i] * b->half[i] * pick(member, 0.1, 1);
        b->angle[i] = pick(member, -3, 3);
        b->speed[i] = chance(member, 3) == 0 ? 0 : pick(member, -4, 4);
        b->pull[i] = chance(member, 2) == 0 ? 0 : pick(member, -5, 5);
    }
    for (int j = 0; j < b->joints; j++)
        b->c[j] = pick(member, 0, 0.06);
}

static void write_bars(Member *member, const Bars *b, Text *out)
{
    double x = 0, y = 0, before = 0;

    text_add(out, "scene planar; gravity [0, -9.81]\n");
    for (int i = 0; i < b->count; i++) {
        text_addf(out, "body b%d mass=%.17g inertia=%.17g\narm a%d b%d [%.17g, 0]\n", i, b->mass[i],
                  b->inertia[i], i, i, -b->half[i]);
        text_addf(out, "arm e%d b%d [%.17g, 0]\nforce F%d b%d [%.17g, 0]\n", i, i, b->half[i], i, i,
                  b->pull[i]);
        x += 2 * b->half[i] * cos(b->angle[i]);
        y += 2 * b->half[i] * sin(b->angle[i]);
    }
    text_addf(out, "arm g ground [%.17g, %.17g]\n", x, y);
    for (int j = 0; j < b->joints; j++) {
        char tail[16] = "ground", head[16] = "g";

        if (j > 0)
            (void)snprintf(tail, sizeof tail, "e%d", j - 1);
        if (j < b->count)
            (void)snprintf(head, sizeof head, "a%d", j);
        text_addf(out, "revolute j%d %s %s\n", j, tail, head);
        text_addf(out, "friction f%d j%d mu=0.5 radius=%.17g static=%.17g\n", j, j, 2 * b->c[j],
                  b->ratio);
    }
    if (chance(member, 2) == 0)
        text_add(out, "tree absolute\n");
    if (chance(member, 3) == 0)
        text_add(out, "form embedded\n");
    for (int i = 0; i < b->count; i++) {
        const bool is_free = b->joints == b->count || i < b->count - 2;

        text_addf(out, "%s j%d = %.17g\n", is_free ? "init" : "guess", i, b->angle[i] - before);
        if (is_free)
            text_addf(out, "init j%d' = %.17g\n", i, b->speed[i]);
        before = b->angle[i];
    }
}

static void read_end(Kit *kit, const Bars *b, Found *out)
{
    char name[32];

    for (int i = 0; i < b->count; i++) {
        (void)snprintf(name, sizeof name, "b%d.theta", i);
        out->angle[i] = kit_value(kit, name);
        (void)snprintf(name, sizeof name, "b%d.theta'", i);
        out->rate[i] = kit_value(kit, name);
        (void)snprintf(name, sizeof name, "b%d.theta''", i);
        out->alpha[i] = kit_value(kit, name);
    }
    for (int j = 0; j < b->joints; j++) {
        (void)snprintf(name, sizeof name, "f%d.effort", j);
        out->effort[j] = kit_value(kit, name);
        (void)snprintf(name, sizeof name, "f%d.load", j);
        out->load[j] = kit_value(kit, name);
    }
}

static Verdict compare(Member *member, const Bars *b, const Found *f)
{
    double load[JOINTS] = {0}, x[UNKNOWNS] = {0};
    bool right = true;

    if (!settle(b, f, load, x))
        return REFUSED;
    for (int j = 0; j < b->joints; j++) {
        const double size = 1 + fabs(load[j]), slip = slip_of(b, f, j);
        const double most = b->c[j] * (fabs(slip) < 1e-9 ? b->ratio : 1) * load[j];

        right = keeps(member, "load", fabs(f->load[j] - load[j]), 1e-6 * size) && right;
        right = keeps(member, "bound", fabs(f->effort[j]) - most, 1e-6 * size) && right;
        right = (fabs(slip) < 1e-9 ||
                 keeps(member, "effort", fabs(f->effort[j] + most * (slip > 0 ? 1 : -1)),
                       1e-6 * size)) &&
                right;
    }
    for (int i = 0; i < b->count; i++)
        right = keeps(member, "alpha", fabs(f->alpha[i] - x[3 * i + 2]),
                      1e-5 * (1 + fabs(x[3 * i + 2]))) &&
                right;
    return right ? AGREES : DISAGREES;
}

static Verdict bars_in_journals(Member *member)
{
    Bars b;
    Found found = {0};
    Text text = {0};
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    draw(member, &b);
    write_bars(member, &b, &text);
    text_addf(&text, "simulate %.17g\n", b.end);
    tell(member, "%s", text.at);
    if (kit_do(&kit, text.at) == CT_OK) {
        read_end(&kit, &b, &found);
        verdict = compare(member, &b, &found);
    } else {
        tell(member, "refused: %s\n", kit.error.message);
    }
    text_free(&text);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {{"bars_in_journals", 60, 0.03, 0, bars_in_journals}};

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
