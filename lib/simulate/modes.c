/* modes.c: eigenvalues of a linear system, and which parts move
 *
 * Eigenvalues by the Francis method on the balanced matrix (GSL). What stands for itself and its
 * conjugate is one mode. The eigenvector moves every coordinate, dependent ones too. */
#include "simulate/linearize.h"

#include "base/memory.h"
#include "simulate/eigen.h"

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAME 1e-6 /* sizes of parts that count as equal */

typedef struct Eigen {
    gsl_vector_complex *values;
    gsl_matrix_complex *vectors;
} Eigen;

static bool solve(const Linear *linear, Eigen *out)
{
    size_t n = (size_t)linear->states;
    gsl_matrix *a = gsl_matrix_alloc(n, n);
    gsl_eigen_nonsymmv_workspace *work = gsl_eigen_nonsymmv_alloc(n);
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    int code;

    linear_clean(linear, a->data);
    out->values = gsl_vector_complex_alloc(n);
    out->vectors = gsl_matrix_complex_alloc(n, n);
    gsl_eigen_nonsymmv_params(1, work);
    code = gsl_eigen_nonsymmv(a, out->values, out->vectors, work);
    (void)gsl_set_error_handler(handler);
    linear_clean(linear, a->data);
    eigen_set_zeros(a->data, linear->states, out->values);
    gsl_matrix_free(a);
    gsl_eigen_nonsymmv_free(work);
    return code == GSL_SUCCESS;
}

/* what rounding can make of a 0 among eigenvalues of this size */
static double rounding(const Linear *linear, const Eigen *eigen)
{
    double largest = 0;

    for (size_t i = 0; i < (size_t)linear->states; i++)
        largest = fmax(largest, gsl_complex_abs(gsl_vector_complex_get(eigen->values, i)));
    return 4 * linear->states * 2.220446049250313e-16 * largest;
}

/* amplitudes and phases over the largest part, the first of those that are as large */
static void scale_shape(Mode *mode, int parts)
{
    double largest = 0, turn = 0;

    for (int p = 0; p < parts; p++)
        largest = fmax(largest, mode->amplitude[p]);
    for (int p = parts - 1; p >= 0; p--)
        if (mode->amplitude[p] >= (1 - SAME) * largest)
            turn = mode->phase[p];
    for (int p = 0; p < parts && largest > 0; p++) {
        mode->amplitude[p] /= largest;
        mode->phase[p] = remainder(mode->phase[p] - turn, 2 * M_PI);
        /* just above or just below half a turn is half a turn */
        if (mode->phase[p] < -M_PI + SAME || mode->amplitude[p] == 0)
            mode->phase[p] = mode->amplitude[p] == 0 ? 0 : M_PI;
    }
}

static void fill_mode(const Linear *linear, const Eigen *eigen, size_t which, double noise,
                      Mode *mode)
{
    gsl_complex value = gsl_vector_complex_get(eigen->values, which);

    mode->real = fabs(GSL_REAL(value)) > noise ? GSL_REAL(value) : 0;
    mode->imaginary = GSL_IMAG(value);
    mode->omega = hypot(mode->real, mode->imaginary);
    mode->damping = mode->omega > 0 ? -mode->real / mode->omega + 0.0 : 0;
    mode->amplitude = NEW_ARRAY(double, linear->parts);
    mode->phase = NEW_ARRAY(double, linear->parts);
    for (int p = 0; p < linear->parts; p++) {
        gsl_complex sum = gsl_complex_rect(0, 0);

        for (int s = 0; s < linear->states; s++)
            sum = gsl_complex_add(
                sum, gsl_complex_mul_real(gsl_matrix_complex_get(eigen->vectors, (size_t)s, which),
                                          linear->motion[p * linear->states + s]));
        mode->amplitude[p] = gsl_complex_abs(sum);
        mode->phase[p] = mode->amplitude[p] > 0 ? gsl_complex_arg(sum) : 0;
    }
    scale_shape(mode, linear->parts);
}

static int by_omega(const void *a, const void *b)
{
    const Mode *x = a, *y = b;

    if (fabs(x->omega - y->omega) > 1e-9 * (x->omega + y->omega))
        return x->omega < y->omega ? -1 : 1;
    if (fabs(x->damping - y->damping) > 1e-9)
        return x->damping < y->damping ? -1 : 1;
    return 0;
}

/* by insertion, which leaves what is equal in its order */
static void sort(Modes *modes)
{
    for (int i = 1; i < modes->count; i++) {
        Mode kept = modes->at[i];
        int k = i;

        for (; k > 0 && by_omega(&modes->at[k - 1], &kept) > 0; k--)
            modes->at[k] = modes->at[k - 1];
        modes->at[k] = kept;
    }
}

Status modes_find(const Linear *linear, Modes **out, Diag *diag)
{
    Eigen eigen = {NULL, NULL};
    Modes *modes = NEW(Modes);
    double noise;
    Status status = OK;

    modes->parts = linear->parts;
    modes->at = NEW_ARRAY(Mode, linear->states);
    modes->part_names = NEW_ARRAY(char *, linear->parts);
    for (int p = 0; p < linear->parts; p++)
        modes->part_names[p] = mem_text(linear->part_names[p], strlen(linear->part_names[p]));
    if (linear->states > 0) {
        if (!solve(linear, &eigen))
            CHECK(diag_set(diag, E_SOLVER, "the eigenvalues can't be found"));
        noise = rounding(linear, &eigen);
        for (size_t i = 0; i < (size_t)linear->states; i++)
            if (GSL_IMAG(gsl_vector_complex_get(eigen.values, i)) >= 0)
                fill_mode(linear, &eigen, i, noise, &modes->at[modes->count++]);
        sort(modes);
    }
    *out = modes;
    modes = NULL;
done:
    modes_free(modes);
    gsl_vector_complex_free(eigen.values);
    gsl_matrix_complex_free(eigen.vectors);
    return status;
}

void modes_free(Modes *modes)
{
    if (modes == NULL)
        return;
    for (int i = 0; i < modes->count; i++) {
        mem_free(modes->at[i].amplitude);
        mem_free(modes->at[i].phase);
    }
    for (int p = 0; p < modes->parts; p++)
        mem_free(modes->part_names[p]);
    mem_free(modes->at);
    mem_free(modes->part_names);
    mem_free(modes);
}
