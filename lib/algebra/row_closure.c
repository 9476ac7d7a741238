/* row_closure.c: matroid closure of rows in the order of their classes, by elimination
 *
 * Gauss-Jordan elimination of the transposed rows leaves each row that depends on those before it
 * as a sum of these. Which rows of a basis such sums need connects them into sets. */
#include "algebra/row_closure.h"

#include <math.h>

#define NOTHING 1e-11 /* of a row, in m or rad by unknown: it doesn't move */
enum { SWEEPS = 2 };  /* of scaling */
#define UNNEEDED 1e-8 /* coefficients below this in a row's sum are rounding errors */

/* Unknowns brought to units in which they move rows by like sizes, rows to size 1 last. */
static void scale(double *a, int unknowns, int count)
{
    int i, r, sweep;

    for (r = 0; r < count; r++) {
        double size = 0;

        for (i = 0; i < unknowns; i++)
            size += a[i * count + r] * a[i * count + r];
        for (i = 0; i < unknowns && !(sqrt(size) > NOTHING); i++)
            a[i * count + r] = 0;
    }
    for (sweep = 0; sweep < SWEEPS; sweep++) {
        for (i = 0; i < unknowns; i++) {
            double most = 0;

            for (r = 0; r < count; r++)
                most = fabs(a[i * count + r]) > most ? fabs(a[i * count + r]) : most;
            for (r = 0; r < count && most > 0; r++)
                a[i * count + r] /= most;
        }
        for (r = 0; r < count; r++) {
            double size = 0;

            for (i = 0; i < unknowns; i++)
                size += a[i * count + r] * a[i * count + r];
            for (i = 0; i < unknowns && size > 0; i++)
                a[i * count + r] /= sqrt(size);
        }
    }
}

/* the unknown with the largest coefficient in the remainder of row r after the rows before it; -1:
 * it follows from these */
static int pivot_of(const double *a, int unknowns, int count, int r, int rank, double least)
{
    double most = least;
    int i, found = -1;

    for (i = rank; i < unknowns; i++)
        if (fabs(a[i * count + r]) > most) {
            most = fabs(a[i * count + r]);
            found = i;
        }
    return found;
}

/* Unknowns are changed so that row r moves with number `rank` alone, which i becomes. */
static void eliminate(double *a, int unknowns, int count, int r, int i, int rank)
{
    double *pivot = a + rank * count;
    const double size = a[i * count + r];
    int k, c;

    for (c = 0; c < count; c++) {
        const double moved = a[i * count + c];

        a[i * count + c] = pivot[c];
        pivot[c] = moved / size;
    }
    for (k = 0; k < unknowns; k++) {
        const double factor = a[k * count + r];

        for (c = 0; k != rank && fabs(factor) > 0 && c < count; c++)
            a[k * count + c] -= factor * pivot[c];
    }
}

/* place: of a row that doesn't follow, the unknown that is its own; -1 */
static void find_basis(double *a, int unknowns, int count, const int *of, double least, int *place)
{
    int last = ROW_CLASS_GIVEN, kind, r, i, rank = 0;

    for (r = 0; r < count; r++) {
        place[r] = -1;
        last = of[r] > last ? of[r] : last;
    }
    for (kind = ROW_CLASS_CONSTRAINT; kind <= last; kind++)
        for (r = 0; r < count && rank < unknowns; r++) {
            i = of[r] == kind ? pivot_of(a, unknowns, count, r, rank, least) : -1;
            if (i < 0)
                continue;
            eliminate(a, unknowns, count, r, i, rank);
            place[r] = rank++;
        }
}

static int root_of(int *set, int r)
{
    while (set[r] != r)
        r = set[r] = set[set[r]];
    return r;
}

/* Rows of a class and given rows that depend on each other become one set. */
static void join(const double *a, int count, const int *of, int kind, const int *place, int *set)
{
    int r, p;

    for (r = 0; r < count; r++)
        set[r] = r;
    for (r = 0; r < count; r++)
        for (p = 0; of[r] == kind && place[r] < 0 && p < count; p++)
            if (place[p] >= 0 && (of[p] == kind || of[p] == ROW_CLASS_GIVEN) &&
                fabs(a[place[p] * count + r]) > UNNEEDED)
                set[root_of(set, p)] = root_of(set, r);
    for (r = 0; r < count; r++)
        set[r] = root_of(set, r);
}

/* How many of the class are open. */
static int decide(int count, const int *of, int kind, const int *place, const int *set, int *fate)
{
    int r, p, open = 0;

    for (r = 0; r < count; r++) {
        int is_given = 0;

        if (of[r] != kind || place[r] < 0)
            continue;
        for (p = 0; p < count; p++)
            is_given |= of[p] == ROW_CLASS_GIVEN && place[p] >= 0 && set[p] == set[r];
        fate[r] = is_given ? ROW_IS_OPEN : ROW_HOLDS;
        open += is_given;
    }
    return open;
}

int row_closure_find(double *a, int unknowns, int count, const int *of, double least, int *fate,
                     int *place, int *set)
{
    int r, kind, last = ROW_CLASS_GIVEN, open = 0;

    scale(a, unknowns, count);
    find_basis(a, unknowns, count, of, least, place);
    for (r = 0; r < count; r++) {
        fate[r] = place[r] >= 0 ? ROW_DETERMINES : ROW_FOLLOWS;
        last = of[r] > last ? of[r] : last;
    }
    for (kind = ROW_CLASS_FIRST; kind <= last && open == 0; kind++) {
        join(a, count, of, kind, place, set);
        open = decide(count, of, kind, place, set, fate);
    }
    return open;
}

int row_closure_rank(const int *fate, int count)
{
    int r, rank = 0;

    for (r = 0; r < count; r++)
        rank += fate[r] != ROW_FOLLOWS;
    return rank;
}
