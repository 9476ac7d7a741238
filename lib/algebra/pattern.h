/* pattern.h: where the entries of a sparse matrix stand, by columns */
#ifndef COTREE_ALGEBRA_PATTERN_H
#define COTREE_ALGEBRA_PATTERN_H

/* places 0 up to count: those of column c from start[c] up to start[c + 1], rows rising */
typedef struct Pattern {
    int rows, columns, count;
    int *start;        /* columns + 1 */
    int *row, *column; /* of a place */
} Pattern;

/* The places of `count` terms at row[k], column[k], of which several may share one, in any order;
 * place[k] becomes that of term k. New; pattern_free(). O(count + rows + columns). */
Pattern pattern_of(int rows, int columns, int count, const int *row, const int *column, int *place);
void pattern_free(Pattern *pattern); /* what it holds */

#endif
