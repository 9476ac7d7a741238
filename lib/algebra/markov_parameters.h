/* markov_parameters.h: c b, c A b, c A^2 b ... of doubles, exact
 *
 * Doubles are integers times a power of 2. The remainder of a sum modulo a power of 2 determines it
 * if that power exceeds the range of the sum, whatever cancels in it. */
#ifndef COTREE_ALGEBRA_MARKOV_PARAMETERS_H
#define COTREE_ALGEBRA_MARKOV_PARAMETERS_H

typedef struct MarkovParameters MarkovParameters;

/* New; borrows a (n x n, row by row), b and c, all finite; up to c A^(count - 1) b. NULL where
 * there are too many digits. Free with markov_parameters_free(). */
MarkovParameters *markov_parameters_new(const double *a, const double *b, const double *c, int n,
                                        int count);
void markov_parameters_free(MarkovParameters *parameters); /* NULL is fine */
/* c A^k b is what this returns, to the rounding of a double, times 2^exponent; 0 where it is 0. k
 * isn't less than it was before. O(n^2) a word and step. */
double markov_parameters_value(MarkovParameters *parameters, int k, int *exponent);

#endif
