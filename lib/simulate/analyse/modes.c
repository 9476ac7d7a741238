/* modes.c: eigenvalues of a linear system, and which parts move
 *
 * What stands for itself and its conjugate is one mode. The eigenvector moves every coordinate,
 * dependent ones too. */
#include "simulate/analyse/linearize.h"

#include "algebra/spectrum.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define SAME 1e-6 /* sizes of parts that count as equal */

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

static void fill_mode(const Linear *linear, const Root *root, const double complex *vector,
                      Mode *mode)
{
    mode->real = root->real;
    mode->imaginary = root->imaginary;
    mode->omega = hypot(mode->real, mode->imaginary);
    mode->damping = mode->omega > 0 ? -mode->real / mode->omega + 0.0 : 0;
    mode->error = root->error;
    mode->is_doubtful = root_is_doubtful(root);
    mode->amplitude = NEW_ARRAY(double, linear->parts);
    mode->phase = NEW_ARRAY(double, linear->parts);
    for (int p = 0; p < linear->parts; p++) {
        double complex sum = 0;

        for (int s = 0; s < linear->states; s++)
            sum += vector[s] * linear->motion[p * linear->states + s];
        mode->amplitude[p] = cabs(sum);
        mode->phase[p] = mode->amplitude[p] > 0 ? carg(sum) : 0;
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
    Spectrum *spectrum = spectrum_new(linear->a, linear->a_error, linear->states);
    double complex *vector = mem_array((size_t)linear->states, sizeof *vector);
    Modes *modes = NEW(Modes);
    Status status = OK;

    modes->parts = linear->parts;
    modes->at = NEW_ARRAY(Mode, linear->states);
    modes->part_names = NEW_ARRAY(char *, linear->parts);
    for (int p = 0; p < linear->parts; p++)
        modes->part_names[p] = mem_text(linear->part_names[p], strlen(linear->part_names[p]));
    if (spectrum == NULL)
        CHECK(diag_set(diag, E_SOLVER, "the eigenvalues can't be found"));
    for (int k = 0; k < linear->states; k++) {
        const Root *root = &spectrum_roots(spectrum)[k];

        if (root->imaginary < 0)
            continue;
        spectrum_vector(spectrum, k, vector);
        fill_mode(linear, root, vector, &modes->at[modes->count++]);
    }
    sort(modes);
    *out = modes;
    modes = NULL;
done:
    modes_free(modes);
    spectrum_free(spectrum);
    mem_free(vector);
    return status;
}

void modes_free(Modes *modes)
{
    if (modes == NULL)
        return;
    for (int i = 0; i < modes->count; i++) {
        MEM_FREE(modes->at[i].amplitude, modes->at[i].phase);
    }
    for (int p = 0; p < modes->parts; p++)
        mem_free(modes->part_names[p]);
    MEM_FREE(modes->at, modes->part_names, modes);
}
