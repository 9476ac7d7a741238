/* row_closure.h: which rows of a motion follow from given rows and constraints
 *
 * A row is a linear function of the motion. It is a constraint, which is 0; or a given row, whose
 * change the caller prescribes; or one that is preferably constant. The latter belong to classes,
 * which are decided in rising order. Modulo the constraints, and the constant rows of earlier
 * classes, the given rows and those of a class form the smallest sets that don't depend on each
 * other (the components of their matroid, Oxley (2011), 4.1). The rows of a set without given rows
 * are constant. Where the given rows span their set, the rest of it follows. Any other set is
 * undetermined: the missing rank is the number of further rows to be given.
 *
 * The result doesn't depend on the choice of coordinates. The file is also part of FMUs. */
#ifndef COTREE_ALGEBRA_ROW_CLOSURE_H
#define COTREE_ALGEBRA_ROW_CLOSURE_H

enum {
    ROW_CLASS_UNASKED = -1,
    ROW_CLASS_CONSTRAINT,
    ROW_CLASS_GIVEN,
    ROW_CLASS_FIRST
}; /* classes */

#define FOLLOW_LEAST             1e-9
#define ROW_CLOSURE_LEAST_SOLVED 1e-4

typedef enum RowStatus {
    ROW_FOLLOWS,    /* from other rows */
    ROW_DETERMINES, /* a constraint or a given row, independent of those before it */
    ROW_HOLDS,      /* and those that follow from such rows with it */
    ROW_IS_OPEN     /* undetermined: it, or another row of its set, has to be given */
} RowStatus;

/* Rows are the columns of a: row r moves by a[i * count + r] with unknown i. a (unknowns x count)
 * is used up. of[r]: class of row r. least: what is left, of a row of size 1, where it doesn't
 * follow from others; FOLLOW_LEAST, or ROW_CLOSURE_LEAST_SOLVED at a position that was solved for,
 * which may be so far from a singular one that it should be at. fate (count) is filled; place
 * (count): work; set (count): of rows that are open, or move with such, where it is the same they
 * are of one set. Returns how many are open. O(unknowns count rank), less for entries that are 0.
 */
int row_closure_find(double *a, int unknowns, int count, const int *of, double least, int *fate,
                     int *place, int *set);
/* how many rows of the last row_closure_find() don't follow from others: the rank of all */
int row_closure_rank(const int *fate, int count);

#endif
