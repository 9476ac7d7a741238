/* decimal.h: the shortest decimal that reads back to a number */
#ifndef COTREE_BASE_DECIMAL_H
#define COTREE_BASE_DECIMAL_H

#include <stddef.h>

enum { DECIMAL_SIZE = 40, DECIMAL_EXACT = 17 };

/* %.{n}g of the value, by the smallest n from 15 on that strtod() reads back to it, of at most
 * `most` digits (DECIMAL_EXACT always do), or of `most` where that is less. Uses integer products,
 * and printf() only near ties, because tables of results consist of such numbers. Returns the
 * length. */
size_t decimal_print(char text[DECIMAL_SIZE], double value, int most);

#endif
