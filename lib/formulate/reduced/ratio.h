/* ratio.h: ratios of polynomials in s, whose coefficients are expressions, in factors */
#ifndef COTREE_FORMULATE_REDUCED_RATIO_H
#define COTREE_FORMULATE_REDUCED_RATIO_H

#include "algebra/multinomial.h"
#include "expr/expr.h"

typedef struct Factor { /* a polynomial in s; of degree 0: a factor without s */
    int degree;
    int times; /* its multiplicity */
    Expr *at;  /* degree + 1, of the highest power first */
} Factor;

typedef struct Product {
    LIST(Factor) factors; /* none: 1; those without s come first, as one factor */
} Product;

typedef struct PolynomialRatio {
    Product over, under;
} PolynomialRatio;

/* over/under without common factors, in factors where these are shorter; over NULL: 0. `atoms` are
 * the expressions of their variables, the first is s. `out` must be zeroed; ratio_free(). It is
 * left incomplete where their ring fails. */
void ratio_write(Arena *arena, const Expr *atoms, int count, const Multinomial *over,
                 const Multinomial *under, PolynomialRatio *out);
void ratio_negate(Arena *arena, PolynomialRatio *ratio);
void ratio_free(PolynomialRatio *ratio); /* its contents */

#endif
