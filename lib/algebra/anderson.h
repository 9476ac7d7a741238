/* anderson.h: a fixed point x = F(x), where iterating F alone may be slow or diverge
 *
 * Anderson (1965), as Walker and Ni (2011) have it: with residuals g_j = F(x_j) - x_j,
 *
 *     x_{k+1} = F(x_k) - sum_j c_j (F(x_{j+1}) - F(x_j)),   c: least |g_k - sum_j c_j (g_{j+1} -
 * g_j)|
 *
 * in components divided by their sizes. Where F is affine and its linear part has rank r, x_{r+2}
 * is the fixed point, whatever the eigenvalues of F. */
#ifndef COTREE_ALGEBRA_ANDERSON_H
#define COTREE_ALGEBRA_ANDERSON_H

typedef struct Anderson Anderson;

Anderson *anderson_new(int n);             /* new; free with anderson_free() */
void anderson_free(Anderson *anderson);    /* NULL is fine */
void anderson_restart(Anderson *anderson); /* another F */
/* The next x (n x 1, in place) from x and F(x). size (n x 1): what a component is measured by,
 * above 0. O(n k^2) after k steps; the oldest of many are forgotten. */
void anderson_step(Anderson *anderson, double *x, const double *image, const double *size);

#endif
