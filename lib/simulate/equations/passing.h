/* passing.h: vectors and tensors of one place in the axes of another */
#ifndef COTREE_SIMULATE_EQUATIONS_PASSING_H
#define COTREE_SIMULATE_EQUATIONS_PASSING_H

#include "formulate/dynamics/composite_mass.h"

#include <string.h>

static inline double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void add_cross(double *sum, const double *a, const double *b)
{
    sum[0] += a[1] * b[2] - a[2] * b[1];
    sum[1] += a[2] * b[0] - a[0] * b[2];
    sum[2] += a[0] * b[1] - a[1] * b[0];
}

/* sum += A v */
static inline void add_product(const double *A, const double *v, double *sum)
{
    for (int i = 0; i < 3; i++)
        sum[i] += dot(A + 3 * i, v);
}

static inline void turn_by(const double *R, double *v)
{
    const double x = v[0], y = v[1], z = v[2];

    for (int i = 0; i < 3; i++)
        v[i] = R[3 * i] * x + R[3 * i + 1] * y + R[3 * i + 2] * z;
}

/* rotation by a cosine and a sine in the plane of two axes */
static inline void turn_in(int j, int k, const double *R, double *v)
{
    const double y = v[j], z = v[k];

    v[j] = R[0] * y - R[1] * z;
    v[k] = R[1] * y + R[0] * z;
}

/* v in the axes of the place's parent; R: its rotation, as stored among the needs */
static inline void turn_onto(const MassPlace *place, const double *R, double *v)
{
    if (place->axis == AXIS_ANY)
        turn_by(R, v);
    else
        turn_in((place->axis + 1) % 3, (place->axis + 2) % 3, R, v);
}

/* the inverse of that */
static inline void turn_back(const MassPlace *place, const double *R, double *v)
{
    const double across[2] = {R[0], -R[1]};
    const double x = v[0], y = v[1], z = v[2];

    if (place->axis != AXIS_ANY)
        turn_in((place->axis + 1) % 3, (place->axis + 2) % 3, across, v);
    else
        for (int i = 0; i < 3; i++)
            v[i] = R[i] * x + R[3 + i] * y + R[6 + i] * z;
}

/* R A R^T */
static inline void turn_tensor(const MassPlace *place, const double *R, double *A)
{
    for (int pass = 0; pass < 2; pass++) {
        double across[9];

        for (int i = 0; i < 3; i++) {
            turn_onto(place, R, A + 3 * i);
            for (int k = 0; k < 3; k++)
                across[3 * k + i] = A[3 * i + k];
        }
        memcpy(A, across, sizeof across);
    }
}

#endif
