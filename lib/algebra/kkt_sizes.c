/* kkt_sizes.c: largest sizes so far, saved and restored */
#include "algebra/kkt_sizes.h"

#include "algebra/algebra_limits.h"
#include "algebra/linear.h"
#include "base/four.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

KktSizes kkt_sizes_new(const Pattern *rows)
{
    return (KktSizes){.rows = rows,
                      .reach = NEW_ARRAY(double, rows->rows),
                      .square = NEW_ARRAY(double, rows->rows),
                      .norm = NEW_ARRAY(double, rows->columns),
                      .most = NEW_ARRAY(double, rows->columns),
                      .kept = NEW_ARRAY(double, rows->rows + 2 * rows->columns)};
}

void kkt_sizes_free(KktSizes *sizes)
{
    MEM_FREE(sizes->reach, sizes->square, sizes->norm, sizes->most, sizes->kept);
}

void kkt_sizes_see(KktSizes *sizes, const double *phi_u, const int *rows, int m)
{
    const Pattern *g = sizes->rows;

    for (int k = 0; k < m; k++)
        for (int e = g->start[rows[k]]; e < g->start[rows[k] + 1]; e++) {
            const double entry = fabs(phi_u[e]);

            if (entry > sizes->reach[g->row[e]])
                sizes->reach[g->row[e]] = entry;
        }
}

void kkt_sizes_measure(KktSizes *sizes, const double *phi_u, const int *rows, int m)
{
    const Pattern *g = sizes->rows;
    const double least = KKT_LEAST_REACH * vector_largest(sizes->reach, g->rows);

    for (int i = 0; i < g->rows; i++) {
        const double reach = sizes->reach[i] > least ? sizes->reach[i] : least;

        sizes->square[i] = reach * reach;
    }
    for (int k = 0; k < m; k++) {
        double norm = 0;

        for (int e = g->start[rows[k]]; e < g->start[rows[k] + 1]; e++)
            if (phi_u[e] != 0)
                norm += phi_u[e] * phi_u[e] / sizes->square[g->row[e]];
        if (norm > sizes->norm[rows[k]])
            sizes->norm[rows[k]] = norm;
    }
}

double kkt_sizes_store_most(KktSizes *sizes, const int *rows, int m, const double *size)
{
    double largest = 0;

    for (int k = 0; k < m; k++) {
        double *most = &sizes->most[rows[k]];

        if (size[k] > *most)
            *most = size[k];
        if (*most > largest)
            largest = *most;
    }
    return KKT_LEAST_NORM * KKT_LEAST_NORM * largest;
}

/* of `most`: the extremes, and whether all pivots so far are more than their part of it */
typedef struct Soundness {
    double largest, least;
    bool holds;
} Soundness;

/* Four by Four: the first where that is so; no function, which would hand Fours on in memory */
#define CHOOSE(is_first, first, second)                                                            \
    ((Four)(((FourTruths)(first) & (is_first)) | ((FourTruths)(second) & ~(is_first))))

/* The first of the rows that follow one another as they are stored, four at a time; how many. */
AS_WIDE_AS_CAN_BE static int see_fours(double *most, const double *pivot, const double *taken,
                                       const int *rows, int m, double part, Soundness *out)
{
    Four largest = {0}, least = {INFINITY, INFINITY, INFINITY, INFINITY};
    FourTruths holds = {-1, -1, -1, -1};
    int k = 0;

    for (; k + 4 <= m && rows[k] == k && rows[k + 1] == k + 1 && rows[k + 2] == k + 2 &&
           rows[k + 3] == k + 3;
         k += 4) {
        const Four now = *(const Four *)(taken + k), before = *(const Four *)(most + k);
        const Four own = CHOOSE(now > before, now, before);

        *(Four *)(most + k) = own;
        largest = CHOOSE(own > largest, own, largest);
        least = CHOOSE(own < least, own, least);
        holds &= *(const Four *)(pivot + k) > part * own;
    }
    for (int i = 0; i < 4; i++) {
        out->largest = fmax(out->largest, largest[i]);
        out->least = fmin(out->least, least[i]);
        out->holds = out->holds && holds[i];
    }
    return k;
}

bool kkt_sizes_are_sound(KktSizes *sizes, const double *pivot, const double *taken, const int *rows,
                         int m, double part)
{
    Soundness all = {.least = INFINITY, .holds = true};

    for (int k = see_fours(sizes->most, pivot, taken, rows, m, part, &all); k < m; k++) {
        double most = sizes->most[rows[k]];

        most = taken[k] > most ? taken[k] : most;
        sizes->most[rows[k]] = most;
        all.largest = most > all.largest ? most : all.largest;
        all.least = most < all.least ? most : all.least;
        all.holds = all.holds && pivot[k] > part * most;
    }
    return all.holds && all.least > KKT_LEAST_NORM * KKT_LEAST_NORM * all.largest;
}

void kkt_sizes_store(KktSizes *sizes, bool back)
{
    double *arrays[] = {sizes->reach, sizes->norm, sizes->most}, *kept = sizes->kept;

    for (int i = 0; i < COUNT(arrays); i++) {
        const int count = i == 0 ? sizes->rows->rows : sizes->rows->columns;

        memcpy(back ? arrays[i] : kept, back ? kept : arrays[i], (size_t)count * sizeof(double));
        kept += count;
    }
}

/* |G_kj| of each row, the largest */
static void find_largest(const KktPlaces *places, const int *place, const double *entries,
                         double *largest)
{
    memset(largest, 0, (size_t)places->m * sizeof(double));
    for (int e = places->mass_entries; e < places->entries; e++) {
        double *row = &largest[places->column[e] - places->nu];

        *row = fmax(*row, fabs(entries[place[e]]));
    }
}

/* Assign masses from neighbours to speeds that have at most `least`; returns whether more of them
 * have a mass now. An entry that is a rounding error of 0 makes no neighbour. */
static bool borrow_once(const KktPlaces *places, const int *place, const double *entries,
                        double least, const double *largest, double *room, double *mass)
{
    const int m = places->m, nu = places->nu;
    double *strongest = room, *borrowed = room + m; /* of G_kj^2 / M_j by rows; by speeds */
    bool more = false;

    memset(room, 0, (size_t)(m + nu) * sizeof(double));
    for (int e = places->mass_entries; e < places->entries; e++) {
        const int row = places->column[e] - nu;
        const double own = mass[places->row[e]], entry = entries[place[e]];

        if (own > 0 && fabs(entry) > KKT_ZERO_ENTRY * largest[row])
            strongest[row] = fmax(strongest[row], entry * entry / own);
    }
    for (int e = places->mass_entries; e < places->entries; e++) {
        const int row = places->column[e] - nu;
        const double entry = entries[place[e]];

        if (strongest[row] > 0 && fabs(entry) > KKT_ZERO_ENTRY * largest[row])
            borrowed[places->row[e]] =
                fmax(borrowed[places->row[e]], entry * entry / strongest[row]);
    }
    for (int i = 0; i < nu; i++)
        if (!(mass[i] > least) && borrowed[i] > mass[i]) {
            more = more || mass[i] == 0;
            mass[i] = borrowed[i];
        }
    return more;
}

void kkt_borrow_masses(const KktPlaces *places, const int *place, const double *entries,
                       double least, double *largest, double *room, double *mass)
{
    find_largest(places, place, entries, largest);
    /* rows between massless speeds propagate the masses assigned to these; further rounds don't
     * change speeds with a mass of their own */
    while (borrow_once(places, place, entries, least, largest, room, mass))
        least = 0;
}
