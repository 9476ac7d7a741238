/* kkt_sizes.h: largest sizes so far of the columns and rows of G
 *
 * Columns and rows are measured against their largest sizes so far, so that one that vanishes at a
 * singular position is recognised as small. Speeds along lengths and angles become comparable by
 * the motion that a unit of the speed causes. */
#ifndef COTREE_ALGEBRA_KKT_SIZES_H
#define COTREE_ALGEBRA_KKT_SIZES_H

#include "algebra/kkt_border.h"
#include "algebra/pattern.h"

#include <stdbool.h>

/* Of all rows, those that aren't in use too. */
typedef struct KktSizes {
    const Pattern *rows; /* positions of the entries of G, one column for each row; borrowed */
    double *reach;       /* of speeds: the largest entry so far */
    double *square;      /* that, or the least that counts, squared: R^2; 0: not measured */
    double *norm;        /* of rows: the largest norm squared so far, columns over R */
    double *most;        /* of rows: the largest p so far (kkt.c) */
    double *kept;
} KktSizes;

KktSizes kkt_sizes_new(const Pattern *rows); /* all 0; kkt_sizes_free() */
void kkt_sizes_free(KktSizes *sizes);        /* its arrays */
/* Entries of these m rows count from now on; */
void kkt_sizes_see(KktSizes *sizes, const double *phi_u, const int *rows, int m);
/* and norms of the rows, once they do. */
void kkt_sizes_measure(KktSizes *sizes, const double *phi_u, const int *rows, int m);
/* Update the largest p so far of each row in use by size[] (one number for each of them). Returns
 * the least p that counts as other than 0. */
double kkt_sizes_store_most(KktSizes *sizes, const int *rows, int m, const double *size);
/* that or the least of p, for a row */
static inline double kkt_sizes_reference(const KktSizes *sizes, int row, double least)
{
    return sizes->most[row] > least ? sizes->most[row] : least;
}
/* whether each of the pivots exceeds this fraction of its row's largest p so far, `taken` included,
 * and no p is below the least size that counts */
bool kkt_sizes_are_sound(KktSizes *sizes, const double *pivot, const double *taken, const int *rows,
                         int m, double part);
/* Save the present sizes; restore the saved ones. */
void kkt_sizes_store(KktSizes *sizes, bool back);

/* A speed without mass of its own is assigned the mass that gives it the same weight in its
 * constraints as the neighbour with the largest effective mass has: M_i = max_k G_ki^2 / max_j
 * (G_kj^2 / M_j). mass[]: of speeds (nu); those that are at most `least` change, through rows
 * between such speeds too. Entry e of G is entries[place[e]]; room is for m and for m + nu
 * numbers. */
void kkt_borrow_masses(const KktPlaces *places, const int *place, const double *entries,
                       double least, double *largest, double *room, double *mass);

#endif
