/* linearize_settle.c: decides which entries of the linear equations are 0
 *
 * Bounds add up every error at its worst, independently of the others: far from rest those of a
 * long chain are huge, and most entries are 0 within them. For such entries the equations are
 * evaluated again at perturbed points. */
#include "simulate/analyse/linearize_impl.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/analyse/analyse_limits.h"

/* a matrix of a Linear, row by row, with its bounds */
typedef struct Entries {
    double *at, *error;
    int rows, columns;
} Entries;

enum { MATRICES = 4, SAMPLES = 4 };

static void list_entries(const Linear *linear, Entries out[MATRICES])
{
    const int n = linear->states, p = linear->inputs, q = linear->outputs;

    out[0] = (Entries){linear->a, linear->a_error, n, n};
    out[1] = (Entries){linear->b, linear->b_error, n, p};
    out[2] = (Entries){linear->c, linear->c_error, q, n};
    out[3] = (Entries){linear->d, linear->d_error, q, p};
}

/* whether an entry is 0 within its bound, but larger than rounding error of its row */
static bool is_doubtful(const Entries *m, int row, int k)
{
    const double *at = m->at + (ptrdiff_t)row * m->columns;
    double largest = 0;

    if (!linear_is_undetermined(at[k], m->error[(ptrdiff_t)row * m->columns + k]))
        return false;
    for (int i = 0; i < m->columns; i++)
        largest = fmax(largest, fabs(at[i]));
    return fabs(at[k]) > LINEAR_ROUNDED * largest;
}

static bool has_doubtful(const Linear *linear)
{
    Entries m[MATRICES];

    list_entries(linear, m);
    for (int i = 0; i < MATRICES; i++)
        for (int row = 0; row < m[i].rows; row++)
            for (int k = 0; k < m[i].columns; k++)
                if (is_doubtful(&m[i], row, k))
                    return true;
    return false;
}

/* A true entry is nearly the same when all numbers and all coefficients are perturbed in their last
 * places; a rounding error is not. Entries that remain doubtful are 0. */
static void settle(Linear *linear, Linear *const *samples, int count)
{
    Entries m[MATRICES], sampled[SAMPLES][MATRICES];

    list_entries(linear, m);
    for (int s = 0; s < count; s++)
        list_entries(samples[s], sampled[s]);
    for (int i = 0; i < MATRICES; i++)
        for (ptrdiff_t at = 0; at < (ptrdiff_t)m[i].rows * m[i].columns; at++) {
            const double value = m[i].at[at];
            bool is_constant = count == SAMPLES && is_doubtful(&m[i], (int)(at / m[i].columns),
                                                               (int)(at % m[i].columns));

            for (int s = 0; s < count && is_constant; s++)
                is_constant = fabs(sampled[s][i].at[at] - value) <= LINEAR_ALIKE * fabs(value);
            if (linear_is_undetermined(value, m[i].error[at]) && !is_constant) {
                m[i].error[at] += fabs(value);
                m[i].at[at] = 0;
            }
        }
}

/* the same at a perturbed point: *out is new, NULL where it can't be evaluated there */
static Status sample(Work *w, uint64_t seed, Linear **out, Diag *diag)
{
    Linear *linear;
    Status status = OK;

    *out = NULL;
    w->perturbation = seed;
    if (linear_perturbed(w)) {
        linear = linear_new(w);
        status = linear_columns(w, linear, diag);
        if (status == OK)
            *out = linear;
        else
            linear_free(linear);
    }
    w->perturbation = 0;
    return status;
}

static Status settle_all(Work *w, Linear *linear, Diag *diag)
{
    Linear *samples[SAMPLES] = {NULL};
    int count = 0;
    Status status = OK;

    if (has_doubtful(linear))
        for (; count < SAMPLES; count++) {
            CHECK(sample(w, 1 + (uint64_t)count, &samples[count], diag));
            if (samples[count] == NULL)
                break;
        }
    settle(linear, samples, count);
done:
    for (int s = 0; s < SAMPLES; s++)
        linear_free(samples[s]);
    return status;
}

Status linear_settled(Work *w, Linear **out, Diag *diag)
{
    Linear *linear = linear_new(w);
    Status status;

    CHECK(linear_columns(w, linear, diag));
    if (!vector_is_finite(linear->a, linear->states * linear->states)) {
        (void)diag_set(diag, E_SINGULAR, "the equations have no derivatives there");
        diag_hint(diag, "a distance of 0 or an angle at its limit has none: take another point");
        CHECK(E_SINGULAR);
    }
    CHECK(settle_all(w, linear, diag));
    *out = linear;
    linear = NULL;
done:
    linear_free(linear);
    return status;
}
