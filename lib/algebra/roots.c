/* roots.c: eigenvalues with error bounds, and groups of those that can't be distinguished */
#include "algebra/roots.h"

#include "algebra/algebra_limits.h"
#include "base/memory.h"

#include <math.h>
#include <stdint.h>

/* --- roots --- */

bool root_is_doubtful(const Root *root)
{
    return !root->is_on_axis && root->error > 0 && root->real == 0;
}

Root root_make(double complex value, double error)
{
    Root root = {.real = creal(value), .imaginary = cimag(value)};

    if (fabs(root.real) <= error)
        root.real = 0;
    if (fabs(root.imaginary) <= error && root.real == 0)
        root.imaginary = 0;
    root.real += 0.0; /* never -0 */
    root.error = error + hypot(root.real - creal(value), root.imaginary - cimag(value));
    return root;
}

double complex root_with_noise(double complex value, double noise, double *error)
{
    if (cabs(value) <= ROOT_STRUCTURAL_ZERO * noise &&
        *error <= UNIT_ROUNDOFF * ROOT_STRUCTURAL_ZERO * noise) {
        *error = 0;
        return 0;
    }
    *error += noise;
    return value;
}

double disturbance(int i, int j)
{
    uint64_t z = ((uint64_t)i << 32) + (uint64_t)j + 0x9E3779B97F4A7C15U;

    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U; /* splitmix64 (Steele, Lea and Flood 2014) */
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return ((double)((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-52 - 1;
}

/* --- groups --- */

typedef struct RootsGroups {
    const double complex *value;
    int count;
    int *group, *partner; /* of a root; the conjugate one, itself where real */
    double complex *mean; /* of a group, by the number of its first root */
    double *error;
    int *members; /* room */
    GroupError *error_of;
    void *context;
} RootsGroups;

/* Real ones are those that are farther from every other's conjugate than from their own. */
static void find_partners(RootsGroups *g)
{
    for (int i = 0; i < g->count; i++)
        g->partner[i] = -1;
    for (int i = 0; i < g->count; i++) {
        double best = fabs(cimag(g->value[i]));

        if (g->partner[i] >= 0)
            continue;
        g->partner[i] = i;
        for (int j = i + 1; j < g->count; j++) {
            const double off = cabs(g->value[i] - conj(g->value[j]));

            if (g->partner[j] >= 0 || off >= best)
                continue;
            best = off;
            g->partner[i] = j;
        }
        g->partner[g->partner[i]] = i;
    }
}

static int members_of(const RootsGroups *g, int group)
{
    int count = 0;

    for (int i = 0; i < g->count; i++)
        if (g->group[i] == group)
            g->members[count++] = i;
    return count;
}

static void measure(RootsGroups *g, int group)
{
    const int count = members_of(g, group);
    bool is_real = true;
    double complex sum = 0;
    double spread = 0;
    int mirror;

    for (int k = 0; k < count; k++) {
        sum += g->value[g->members[k]] / count;
        is_real = is_real && g->group[g->partner[g->members[k]]] == group;
    }
    g->mean[group] = is_real ? creal(sum) : sum;
    for (int k = 0; k < count; k++)
        spread = fmax(spread, cabs(g->value[g->members[k]] - sum));
    g->error[group] = fmax(spread, g->error_of(g->context, g->members, count, sum));
    /* the conjugate ones exactly */
    mirror = g->group[g->partner[group]];
    g->mean[mirror] = conj(g->mean[group]);
    g->error[mirror] = g->error[group];
}

static int unite(RootsGroups *g, int one, int other)
{
    const int kept = one < other ? one : other, gone = one < other ? other : one;

    for (int i = 0; i < g->count; i++)
        if (g->group[i] == gone)
            g->group[i] = kept;
    return kept;
}

/* the two groups about within each other's errors that are closest */
static bool closest_groups(const RootsGroups *g, int *one, int *other)
{
    double best = INFINITY;

    for (int i = 0; i < g->count; i++)
        for (int j = i + 1; j < g->count; j++) {
            double off;

            if (g->group[i] != i || g->group[j] != j)
                continue;
            off = cabs(g->mean[i] - g->mean[j]);
            if (off > ROOTS_WITHIN * (g->error[i] + g->error[j]) || off >= best)
                continue;
            best = off;
            *one = i;
            *other = j;
        }
    return isfinite(best);
}

void roots_join(const double complex *value, const double *error, int count, GroupError *error_of,
                void *context, Root *out)
{
    RootsGroups g = {value,
                     count,
                     NEW_ARRAY(int, count),
                     NEW_ARRAY(int, count),
                     mem_array((size_t)count, sizeof(double complex)),
                     NEW_ARRAY(double, count),
                     NEW_ARRAY(int, count),
                     error_of,
                     context};
    int one = 0, other = 0;

    find_partners(&g);
    for (int i = 0; i < count; i++) {
        const int p = g.partner[i];

        g.group[i] = i;
        /* conjugate ones exactly */
        g.mean[i] = p == i ? creal(value[i]) : (value[i] + conj(value[p])) / 2;
        g.error[i] = fmax(error[i], error[p]);
    }
    while (closest_groups(&g, &one, &other)) {
        const int mirror_one = g.group[g.partner[one]], mirror_other = g.group[g.partner[other]];
        const int kept = unite(&g, one, other);

        (void)unite(&g, g.group[mirror_one], g.group[mirror_other]);
        measure(&g, g.group[kept]);
    }
    for (int i = 0; i < count; i++)
        out[i] = root_make(g.mean[g.group[i]], ROOT_SECOND_ORDER * g.error[g.group[i]]);
    MEM_FREE(g.group, g.partner, g.mean, g.error, g.members);
}
