/* remainders.h: c b, c A b, c A^2 b ... of doubles, to the last digit
 *
 * Doubles are whole numbers times a power of 2. Remainders modulo so many primes that their product
 * exceeds all that the sums can be tell the sums, whatever cancels in them (Knuth, The Art of
 * Computer Programming 2, 4.3.2). */
#ifndef COTREE_ALGEBRA_REMAINDERS_H
#define COTREE_ALGEBRA_REMAINDERS_H

typedef struct Remainders Remainders;

/* New; borrows a (n x n, row by row), b and c, all finite; up to c A^(count - 1) b. NULL where
 * there are too many digits. Free with remainders_free(). */
Remainders *remainders_new(const double *a, const double *b, const double *c, int n, int count);
void remainders_free(Remainders *remainders); /* NULL is fine */
/* c A^k b is about what this returns, to the rounding of a double, times 2^exponent; 0 where it is
 * 0. k isn't less than it was before. O(n^2) a prime and step. */
double remainders_value(Remainders *remainders, int k, int *exponent);

#endif
