/* modal_groups.c: eigenvalues of M^-1 K by discs about the diagonal of modal coordinates
 *
 * Weighting row k by d_k and column k by 1/d_k does not change eigenvalues. Weights that balance
 * rows and columns make the discs of slow modes as small as these modes. A common weight of a group
 * then reduces its discs to the coupling among its members, while the other discs may grow until
 * they meet it. */
#include "algebra/modal.h"

#include "algebra/schur.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Discs {
    const Modal *m;
    double *size;  /* n x n: weighted entries off the diagonal, errors on it */
    double *reach; /* of a row in all */
    int *order;    /* modes that aren't rigid, by the lower ends of their discs */
    int count;
} Discs;

static void weigh(Discs *d)
{
    const int n = d->m->n;
    double *weight = NEW_ARRAY(double, n);

    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            /* what doesn't change rigid modes has no effect */
            d->size[i * n + k] = d->m->is_still[i] || d->m->is_still[k]
                                     ? 0
                                     : fabs(d->m->off[i * n + k]) + d->m->error[i * n + k];
    matrix_balance(d->size, n, weight);
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            if (i != k)
                d->size[i * n + k] *= weight[i] / weight[k];
            d->reach[i] += d->size[i * n + k];
        }
    for (int i = 0; i < n; i++)
        d->reach[i] *= 1 + n * 0x1p-52;
    mem_free(weight);
}

static double beginning(const Discs *d, int k)
{
    return d->m->square[k] - d->reach[k];
}

/* by insertion: modes are nearly in order */
static void sort(Discs *d)
{
    for (int k = 0; k < d->m->n; k++) {
        int at = d->count;

        if (d->m->is_still[k])
            continue;
        for (; at > 0 && beginning(d, d->order[at - 1]) > beginning(d, k); at--)
            d->order[at] = d->order[at - 1];
        d->order[at] = k;
        d->count++;
    }
}

/* The weight (1: none) that reduces outside entries in rows first..end of the order as far as
 * possible. The discs of other rows grow by the group's entries in them, and must remain disjoint
 * from these. */
static double group_weight(const Discs *d, int first, int end, double begin, double last)
{
    const int n = d->m->n;
    double weight = 0;

    for (int o = 0; o < d->count; o++) {
        const int k = d->order[o];
        const double square = d->m->square[k];
        double apart, from_group = 0;

        if (o >= first && o < end)
            continue;
        apart = (square > last ? square - last : begin - square) - d->reach[k];
        for (int i = first; i < end; i++)
            from_group += d->size[k * n + d->order[i]];
        if (from_group > 0)
            weight = fmax(weight, apart > 0 ? 2 * from_group / apart : 1);
    }
    return weight < 1 ? weight : 1;
}

/* rows first..end of the order: mean, and how far any eigenvalue of theirs is off it at most */
static void measure(const Discs *d, int first, int end, double weight, double *mean, double *error)
{
    const int n = d->m->n;

    *mean = *error = 0;
    for (int i = first; i < end; i++)
        *mean += d->m->square[d->order[i]] / (end - first);
    for (int i = first; i < end; i++) {
        const int k = d->order[i];
        double inside = 0;

        for (int j = first; j < end; j++)
            inside += d->size[k * n + d->order[j]];
        /* the rest of the row, and once more the group's own for its rounding */
        *error = fmax(*error, fabs(d->m->square[k] - *mean) + inside +
                                  weight * fmax(d->reach[k] - inside, 0) + n * 0x1p-52 * inside);
    }
    if (end - first > 1)
        *error += (end - first) * 0x1p-52 * fabs(*mean);
}

bool modal_groups(const Modal *m, int *group, double *mean, double *error)
{
    const int n = m->n;
    Discs d = {m, NEW_ARRAY(double, n *n), NEW_ARRAY(double, n), NEW_ARRAY(int, n), 0};
    bool sound = true;
    int still = -1;

    weigh(&d);
    for (int k = 0; k < n; k++) {
        if (m->is_still[k] && still < 0)
            still = k;
        group[k] = still;
        mean[k] = error[k] = 0;
        sound = sound && isfinite(m->square[k]) && isfinite(d.reach[k]);
    }
    sort(&d);
    for (int first = 0, end; first < d.count && sound; first = end) {
        double last = m->square[d.order[first]] + d.reach[d.order[first]], of_all, within;
        const double begin = beginning(&d, d.order[first]);

        for (end = first + 1; end < d.count && beginning(&d, d.order[end]) <= last; end++)
            last = fmax(last, m->square[d.order[end]] + d.reach[d.order[end]]);
        measure(&d, first, end, group_weight(&d, first, end, begin, last), &of_all, &within);
        for (int i = first; i < end; i++) {
            group[d.order[i]] = d.order[first];
            mean[d.order[i]] = of_all;
            error[d.order[i]] = within;
        }
    }
    MEM_FREE(d.size, d.reach, d.order);
    return sound;
}
