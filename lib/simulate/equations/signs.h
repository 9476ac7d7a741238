/* signs.h: signs on the surfaces that a motion slides along, by Newton's method
 *
 * slip(signs) = 0. Forces and networks are mostly linear in signs: then one step suffices. */
#ifndef COTREE_SIMULATE_EQUATIONS_SIGNS_H
#define COTREE_SIMULATE_EQUATIONS_SIGNS_H

#include <stdbool.h>

typedef struct Signs Signs;

/* What replaces a jump on its surface h = 0: a sign, or of what is unilateral the effort. */
typedef struct SignRange {
    double low, high;    /* between them the motion stays on the surface; high may be INFINITY */
    double below, above; /* its value where h < 0 and where h > 0 */
    bool is_unilateral;  /* h > 0 can't be: there is an impact on h = 0, with this coefficient: */
    double restitution;
    bool has_bound; /* its bound is another expression, which may contain efforts */
    int load;       /* the sign that is the effort in it; -1: none */
    int cone;    /* at the first sign of a vector's components their number; -1: at its others; 0 */
    double norm; /* of a vector: the bound on the norm of their signs */
} SignRange;

/* slip at these signs; false: it can't be evaluated there */
typedef bool (*SignsTrial)(void *context, const double *signs, double *slip);

/* New, with room for so many; free with signs_free(). */
Signs *signs_new(int room);
/* Begin with `count` signs, all 0. The ranges are copied. */
void signs_begin(Signs *signs, int count, const SignRange *ranges);
void signs_free(Signs *signs);      /* NULL is fine */
double *signs_values(Signs *signs); /* of the last search; the next one starts there */
/* The matrix d slip_i / d sign_k at the values; slip there is stored in `slip`. */
bool signs_slopes(Signs *signs, SignsTrial trial, void *context, double *slip);
/* After signs_slopes(): the moves of signs that change slip by -`slip`, in its place. */
bool signs_solve(Signs *signs, double *slip);
/* False: no signs were found. The last trial was at the values. */
bool signs_find(Signs *signs, SignsTrial trial, void *context);

#endif
