/* family_far.c: linear equations of chains far from rest against Lagrange's equations in numbers of
 * more digits
 *
 * Rods in a plane, each on the one before, at any angles and speeds. With the angles a_i from the
 * horizontal, the sums of those of the hinges,
 *
 *     sum_j c_ij cos(a_i - a_j) a_j'' + sum_j c_ij sin(a_i - a_j) a_j'^2 + g_i cos(a_i) = 0
 *
 * whose derivatives are written down here, and solved for by elimination. Every entry has to come
 * out, small ones beside a row's largest aside: bounds of long chains tell next to none of them
 * from 0. */
#include "family.h"
#include "linear_entries.h"

#include "base/text.h"

#include <math.h>

enum { MOST = 60 };

typedef long double Real;

typedef struct OrientationClass {
    int n;
    double length[MOST], mass[MOST], inertia[MOST], angle[MOST], speed[MOST]; /* of hinges */
} OrientationClass;

/* --- Lagrange --- */

typedef struct Lagrange {
    Real c[MOST][MOST], g[MOST], a[MOST], v[MOST]; /* a, v: angles and speeds from the ground */
    Real m[MOST][3 * MOST];                        /* mass matrix beside right sides */
} Lagrange;

static void find_constants(const OrientationClass *chain, Lagrange *e)
{
    for (int i = 0; i < chain->n; i++) {
        Real beyond = 0;

        for (int k = i + 1; k < chain->n; k++)
            beyond += chain->mass[k];
        e->g[i] = 9.81L * chain->length[i] * (chain->mass[i] / 2 + beyond);
        e->c[i][i] = chain->inertia[i] +
                     (Real)chain->length[i] * chain->length[i] * (chain->mass[i] / 4 + beyond);
        e->a[i] = chain->angle[i] + (i > 0 ? e->a[i - 1] : 0);
        e->v[i] = chain->speed[i] + (i > 0 ? e->v[i - 1] : 0);
        for (int j = 0; j < i; j++)
            e->c[i][j] = e->c[j][i] =
                (Real)chain->length[j] * chain->length[i] * (chain->mass[i] / 2 + beyond);
    }
}

/* Gauss, with exchange of rows, for so many right sides behind the matrix */
static void eliminate(Lagrange *e, int n, int sides)
{
    for (int k = 0; k < n; k++) {
        int best = k;

        for (int i = k + 1; i < n; i++)
            if (fabsl(e->m[i][k]) > fabsl(e->m[best][k]))
                best = i;
        for (int j = 0; j < n + sides; j++) {
            const Real was = e->m[k][j];

            e->m[k][j] = e->m[best][j];
            e->m[best][j] = was;
        }
        for (int i = 0; i < n; i++) {
            const Real by = e->m[i][k] / e->m[k][k];

            for (int j = k; j < n + sides && i != k; j++)
                e->m[i][j] -= by * e->m[k][j];
        }
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < sides; j++)
            e->m[i][n + j] /= e->m[i][i];
}

static void put_mass(Lagrange *e, int n)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            e->m[i][j] = e->c[i][j] * cosl(e->a[i] - e->a[j]);
}

/* a'' by a and a', n x 2n behind the mass matrix */
static void differentiate(Lagrange *e, int n)
{
    Real w[MOST]; /* a'' */

    put_mass(e, n);
    for (int i = 0; i < n; i++) {
        e->m[i][n] = -e->g[i] * cosl(e->a[i]);
        for (int j = 0; j < n; j++)
            e->m[i][n] -= e->c[i][j] * sinl(e->a[i] - e->a[j]) * e->v[j] * e->v[j];
    }
    eliminate(e, n, 1);
    for (int i = 0; i < n; i++)
        w[i] = e->m[i][n];
    put_mass(e, n);
    for (int i = 0; i < n; i++) {
        Real own = e->g[i] * sinl(e->a[i]);

        for (int j = 0; j < n; j++) {
            const Real s = e->c[i][j] * sinl(e->a[i] - e->a[j]);
            const Real c = e->c[i][j] * cosl(e->a[i] - e->a[j]);
            const Real by = s * w[j] - c * e->v[j] * e->v[j]; /* of what falls, by a_i */

            own += j != i ? by : 0;
            e->m[i][n + j] = j != i ? -by : 0;
            e->m[i][2 * n + j] = -2 * s * e->v[j];
        }
        e->m[i][n + i] = own;
    }
    eliminate(e, n, 2 * n);
}

/* the same of hinges: differences of rows, sums of columns from the last one on */
static Real of_hinges(const Lagrange *e, int n, int row, int by, int first)
{
    Real sum = 0;

    for (int k = by; k < n; k++)
        sum += e->m[row][first + k] - (row > 0 ? e->m[row - 1][first + k] : 0);
    return sum;
}

/* --- members --- */

static void make_chain(Member *m, OrientationClass *chain)
{
    const bool is_even = member_one_of(m, 2) == 0;

    chain->n = 2 + member_one_of(m, MOST - 1);
    for (int i = 0; i < chain->n; i++) {
        chain->length[i] = is_even ? 1 : member_between(m, 0.5, 1.5);
        chain->mass[i] = is_even ? 1 : member_between(m, 0.5, 2);
        chain->inertia[i] = is_even ? 0.125 : member_between(m, 0.01, 0.2);
        chain->angle[i] = ldexp(floor(1024 * member_between(m, -1, 1)), -10);
        chain->speed[i] = ldexp(floor(1024 * member_between(m, -1, 1)), -10);
    }
}

static void write_chain(const OrientationClass *chain, Text *out)
{
    text_add(out, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 0; i < chain->n; i++) {
        text_addf(out,
                  "body b%d mass=%.17g inertia=%.17g\narm a%d b%d [%.17g, 0]\n"
                  "arm e%d b%d [%.17g, 0]\n",
                  i, chain->mass[i], chain->inertia[i], i, i, -chain->length[i] / 2, i, i,
                  chain->length[i] / 2);
        if (i == 0)
            text_add(out, "revolute h0 ground a0\n");
        else
            text_addf(out, "revolute h%d e%d a%d\n", i, i - 1, i);
        text_addf(out, "init h%d = %.17g, h%d' = %.17g\n", i, chain->angle[i], i, chain->speed[i]);
    }
    text_add(out, "tree joint\nlinearize\n");
}

/* the worst entry of A, beside the largest of its row */
static double compare(const OrientationClass *chain, const double *entries, int states)
{
    static Lagrange e;
    const int n = chain->n;
    double worst = 0;

    find_constants(chain, &e);
    differentiate(&e, n);
    for (int i = 0; i < n; i++) {
        double largest = 0, off = 0;

        for (int k = 0; k < 2 * n; k++) {
            const double right = (double)of_hinges(&e, n, i, k % n, k < n ? n : 2 * n);

            largest = fmax(largest, fabs(right));
            off = fmax(off, fabs(entries[(n + i) * states + k] - right));
        }
        worst = fmax(worst, off / largest);
    }
    return worst;
}

static Verdict chains_far_from_rest(Member *m)
{
    OrientationClass chain;
    Text text = {0};
    Verdict verdict = REFUSED;
    char reason[200];
    double *entries;
    int states = 0;

    make_chain(m, &chain);
    write_chain(&chain, &text);
    entries = linear_entries(text.at, &states, reason, sizeof reason);
    if (entries != NULL)
        verdict = keeps(m, "an entry", compare(&chain, entries, states), 1e-7) ? AGREES : DISAGREES;
    if (verdict != AGREES || m->told)
        tell(m, "%s%s\n", text.at, reason);
    text_free(&text);
    free(entries);
    return verdict;
}

/* A member that went wrong once: an entry of 1e-6 of its row was taken for 0. */
static Verdict that_failed(Member *m)
{
    m->random = 9912 * 0x9E3779B97F4A7C15U + 97;
    (void)test_random(&m->random);
    return chains_far_from_rest(m);
}

static const Family families[] = {
    {"chains_far_from_rest", 30, 0, 0, chains_far_from_rest},
    {"chains_that_failed_once", 1, 0, 0, that_failed},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
