/* roots.h: eigenvalues, poles and zeros with error bounds */
#ifndef COTREE_ALGEBRA_ROOTS_H
#define COTREE_ALGEBRA_ROOTS_H

#include <complex.h>
#include <stdbool.h>

/* errors: m equal roots split to pi of them, and no farther */
#define ROOTS_WITHIN 4

/* an eigenvalue, a pole or a zero, 1/s */
typedef struct Root {
    double real, imaginary;
    double error;    /* the true one lies within */
    bool is_on_axis; /* the real part is 0 whatever the errors: undamped */
} Root;

/* the sign of the real part can't be determined, which is 0 then; so is a root that may be 0
 * altogether
 */
bool root_is_doubtful(const Root *root);

/* `value` within `error` as a root. A part that can't be distinguished from 0 becomes 0, and its
 * size is added to the error */
Root root_make(double complex value, double error);

/* Mean of those that can't be distinguished: count roots with their errors, of which `value` holds
 * all conjugate ones. `error_of` returns the common error of some of them. */
typedef double GroupError(void *context, const int *members, int count, double complex mean);
void roots_join(const double complex *value, const double *error, int count, GroupError *error_of,
                void *context, Root *out);

/* A root that errors of the data move by `error`, found with a method whose rounding is `noise`:
 * the error is their sum. A root other than 0 changes in proportion to the data. One that doesn't
 * change, and is of the size of the method's rounding, is structurally 0, without error. */
double complex root_with_noise(double complex value, double noise, double *error);

/* a number in (-1, 1) that is always the same at a place, for disturbances */
double disturbance(int i, int j);

#endif
