/* ratio.h: ratios of polynomials in s, whose coefficients are expressions, in factors */
#ifndef COTREE_FORMULATE_REDUCED_RATIO_H
#define COTREE_FORMULATE_REDUCED_RATIO_H

#include "algebra/multinomial.h"
#include "expr/expr.h"

typedef struct Factor { /* a polynomial in s; of degree 0 what holds no s */
    int degree;
    int times; /* how often it stands there */
    Expr *at;  /* degree + 1, of the highest power first */
} Factor;

typedef struct Product {
    LIST(Factor) factors; /* none: 1; those without s, as one, first */
} Product;

typedef struct PolynomialRatio {
    Product over, under;
} PolynomialRatio;

/* over/under without what they have in common, in factors where these are shorter; over NULL: 0.
 * `atoms` are what their variables are, s the first. Fill what is zeroed; ratio_free(). It is left
 * half made where their ring fails. */
void ratio_write(Arena *arena, const Expr *atoms, int count, const Multinomial *over,
                 const Multinomial *under, PolynomialRatio *out);
void ratio_negate(Arena *arena, PolynomialRatio *ratio);
void ratio_free(PolynomialRatio *ratio); /* what it holds */

#endif
