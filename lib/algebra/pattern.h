/* pattern.h: positions of the entries of a sparse matrix, by columns */
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
Pattern pattern_full(int rows, int columns); /* of a matrix of which any entry may not be 0 */
void pattern_free(Pattern *pattern);         /* its arrays */

/* With the values of all places: column c times v; */
double pattern_dot(const Pattern *pattern, const double *values, int c, const double *v);
/* out += factor times column c; */
void pattern_add(const Pattern *pattern, const double *values, int c, double factor, double *out);
/* its entry of largest size, and one of them; */
double pattern_largest(const Pattern *pattern, const double *values, int c);
double pattern_at(const Pattern *pattern, const double *values, int row, int c);
/* column after column in full, and a new array of that. */
void pattern_fill(const Pattern *pattern, const double *values, double *out);
double *pattern_spread(const Pattern *pattern, const double *values);

#endif
