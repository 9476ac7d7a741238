/* signs.c: signs on surfaces that a motion slides along
 *
 * Newton's method for slip(s) = 0, s (count) the values that replace sign() of each surface, with
 * difference quotients A = d slip/d s. The factors of A are kept from one search to the next, as
 * long as steps with them converge quickly: of a linear slip they always do. Where A is singular
 * the step is the least-squares solution of least norm, (A^T A + d) x = A^T b with small d and
 * refinement. |s_k| > 1: the motion leaves surface k. */
#include "simulate/equations/signs.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/equations/equations_limits.h"

#include <math.h>
#include <string.h>

struct Signs {
    int count;
    SignRange *ranges;
    double *values, *slip, *matrix, *move, *kept;
    Lu *factors; /* of the matrix, */
    bool is_factored;
};

Signs *signs_new(int room)
{
    Signs *s = NEW(Signs);

    s->values = NEW_ARRAY(double, room);
    s->ranges = NEW_ARRAY(SignRange, room);
    s->slip = NEW_ARRAY(double, room);
    s->move = NEW_ARRAY(double, room);
    s->kept = NEW_ARRAY(double, room);
    s->matrix = NEW_ARRAY(double, room *room);
    s->factors = lu_new(room);
    return s;
}

void signs_begin(Signs *s, int count, const SignRange *ranges)
{
    lu_resize(s->factors, count);
    s->count = count;
    s->is_factored = false;
    memset(s->values, 0, (size_t)count * sizeof(double));
    memcpy(s->ranges, ranges, (size_t)count * sizeof(SignRange));
}

void signs_free(Signs *s)
{
    if (s == NULL)
        return;
    lu_free(s->factors);
    MEM_FREE(s->values, s->ranges, s->slip, s->move, s->kept, s->matrix, s);
}

double *signs_values(Signs *s)
{
    return s->values;
}

bool signs_slopes(Signs *s, SignsTrial trial, void *context, double *slip)
{
    s->is_factored = false;
    if (!trial(context, s->values, slip))
        return false;
    for (int k = 0; k < s->count; k++) {
        double kept = s->values[k];
        const double size = SIGNS_DIFFERENCE * fmax(1, fabs(kept));
        double step = kept > 0 ? -size : size;
        bool sound;

        s->values[k] = kept + step;
        sound = trial(context, s->values, s->move);
        s->values[k] = kept;
        if (!sound)
            return false;
        for (int i = 0; i < s->count; i++)
            s->matrix[i * s->count + k] = (s->move[i] - slip[i]) / step;
    }
    return true;
}

/* (A^T A + d) x = A^T b with so small a d that a few iterations of refinement find the x of least
 * norm: 0 where A is 0, as of sign(x)*sqrt(abs(x)) at x = 0. */
static bool least(const double *a, int n, double *b)
{
    Lu *lu = lu_new(n);
    double *x = NEW_ARRAY(double, n);
    double *move = NEW_ARRAY(double, n);
    double small = SIGNS_DAMPING * vector_largest(a, n * n) * vector_largest(a, n * n);
    bool sound;

    for (int i = 0; i < n && small == 0; i++)
        lu_matrix(lu)[i * n + i] = 1;
    for (int i = 0; i < n && small > 0; i++)
        for (int j = 0; j < n; j++) {
            double sum = i == j ? small : 0;

            for (int k = 0; k < n; k++)
                sum += a[k * n + i] * a[k * n + j];
            lu_matrix(lu)[i * n + j] = sum;
        }
    sound = lu_factor(lu);
    for (int turn = 0; turn < SIGNS_REFINEMENTS && sound; turn++) {
        for (int i = 0; i < n; i++) {
            move[i] = 0;
            for (int k = 0; k < n; k++)
                move[i] += a[k * n + i] * b[k];
        }
        lu_solve(lu, move);
        for (int k = 0; k < n; k++) {
            x[k] += move[k];
            for (int i = 0; i < n; i++)
                b[k] -= a[k * n + i] * move[i];
        }
    }
    memcpy(b, x, (size_t)n * sizeof(double));
    MEM_FREE(x, move);
    lu_free(lu);
    return sound;
}

static bool factor(Lu *lu, const double *matrix, int n)
{
    memcpy(lu_matrix(lu), matrix, (size_t)(n * n) * sizeof(double));
    return lu_factor(lu) && lu_pivot_ratio(lu) > SIGNS_SINGULAR;
}

bool signs_solve(Signs *s, double *slip)
{
    for (int i = 0; i < s->count; i++)
        slip[i] = -slip[i];
    s->is_factored = s->is_factored || factor(s->factors, s->matrix, s->count);
    if (!s->is_factored)
        return least(s->matrix, s->count, slip) && vector_is_finite(slip, s->count);
    lu_solve(s->factors, slip);
    return vector_is_finite(slip, s->count);
}

/* With the factors of an earlier search. False: they are none, or converge too slowly; the values
 * are as before. */
static bool iterate_with_factors(Signs *s, SignsTrial trial, void *context)
{
    const size_t bytes = (size_t)s->count * sizeof(double);
    double before = INFINITY;

    if (!s->is_factored)
        return false;
    memcpy(s->kept, s->values, bytes);
    for (int turn = 0; turn < SIGNS_ITERATIONS && trial(context, s->values, s->slip); turn++) {
        const double size = fmax(1, vector_largest(s->values, s->count));
        double moved;

        if (!signs_solve(s, s->slip))
            break;
        moved = vector_largest(s->slip, s->count);
        if (moved <= SIGNS_ROUNDING * size)
            return true;
        if (!(moved <= SIGNS_CONTRACTION * before)) {
            if (moved <= SIGNS_CONVERGED * size)
                return true; /* as close as rounding allows */
            break;
        }
        before = moved;
        for (int i = 0; i < s->count; i++)
            s->values[i] += s->slip[i];
    }
    memcpy(s->values, s->kept, bytes);
    return false;
}

/* the largest move of those whose ranges are finite */
static double largest_in_ranges(const Signs *s, const double *move)
{
    double largest = 0;

    for (int k = 0; k < s->count; k++)
        if (isfinite(s->ranges[k].high))
            largest = fmax(largest, fabs(move[k]));
    return largest;
}

static bool newton(Signs *s, SignsTrial trial, void *context)
{
    double before = INFINITY;

    for (int turn = 0; turn < SIGNS_ITERATIONS; turn++) {
        double moved;

        if (!signs_slopes(s, trial, context, s->slip) || !signs_solve(s, s->slip))
            return false;
        moved = vector_largest(s->slip, s->count);
        for (int i = 0; i < s->count; i++)
            s->values[i] += s->slip[i];
        /* as close as rounding allows */
        if (moved <= SIGNS_CONVERGED * fmax(1, vector_largest(s->values, s->count)) ||
            (turn > 2 && moved > 0.5 * before && moved < 1e-6))
            return trial(context, s->values, s->move);
        before = moved;
        if (!isfinite(moved) || !(largest_in_ranges(s, s->slip) < SIGNS_FAR))
            return false;
    }
    return false;
}

/* Sign k alone within its interval, by bisection. False and *sound where slip has one sign
 * there. */
static bool bisect(Signs *s, int k, SignsTrial trial, void *context, bool *sound)
{
    double ends[2] = {s->ranges[k].low, s->ranges[k].high}, slip[2];

    *sound = true;
    if (!isfinite(ends[1]))
        return false;
    for (int i = 0; i < 2 && *sound; i++) {
        s->values[k] = ends[i];
        *sound = trial(context, s->values, s->slip);
        slip[i] = s->slip[k];
    }
    if (!*sound || slip[0] * slip[1] > 0)
        return false;
    for (int turn = 0; turn < SIGNS_BISECTIONS && *sound; turn++) {
        s->values[k] = (ends[0] + ends[1]) / 2;
        *sound = trial(context, s->values, s->slip);
        ends[s->slip[k] * slip[0] > 0 ? 0 : 1] = s->values[k];
    }
    return *sound;
}

/* outside its range, by more than rounding; never where that has no end */
static bool is_outside(const Signs *s, int k)
{
    const SignRange *range = &s->ranges[k];
    const double more = SIGNS_OUTSIDE * range->high;

    return isfinite(range->high) &&
           (s->values[k] > range->high + more || s->values[k] < range->low - more);
}

/* Look for signs within their intervals when some are outside, which is where the motion leaves. */
static bool look_between(Signs *s, SignsTrial trial, void *context)
{
    double *kept = NEW_ARRAY(double, s->count);
    bool moved = false, sound = true;

    memcpy(kept, s->values, (size_t)s->count * sizeof(double));
    for (int k = 0; k < s->count && sound; k++)
        if (is_outside(s, k)) {
            if (bisect(s, k, trial, context, &sound))
                moved = true;
            else
                s->values[k] = kept[k];
        }
    if (!moved || !sound || !newton(s, trial, context)) {
        memcpy(s->values, kept, (size_t)s->count * sizeof(double));
        sound = trial(context, s->values, s->move);
    }
    mem_free(kept);
    return sound;
}

static bool is_beyond(const Signs *s)
{
    for (int i = 0; i < s->count; i++)
        if (is_outside(s, i))
            return true;
    return false;
}

/* Where the one sign hardly affects slip, as of sign(x)*sqrt(abs(x)) next to x = 0, Newton's method
 * diverges. Slip then has one sign over the whole interval, and the motion has left the surface on
 * that side: the sign is outside the interval there. False: this is not the case. */
static bool lies_beyond(Signs *s, SignsTrial trial, void *context)
{
    bool sound;

    if (s->count != 1 || !isfinite(s->ranges[0].high) || bisect(s, 0, trial, context, &sound) ||
        !sound || s->slip[0] == 0)
        return false;
    s->values[0] = (s->slip[0] > 0 ? SIGNS_LEFT : -SIGNS_LEFT) * s->ranges[0].high;
    return trial(context, s->values, s->move);
}

bool signs_find(Signs *s, SignsTrial trial, void *context)
{
    bool found = iterate_with_factors(s, trial, context) || newton(s, trial, context);

    /* where slip is strongly nonlinear, one by one, as initial guess of Newton's method */
    for (int round = 0; round < SIGNS_ROUNDS && !found; round++) {
        for (int k = 0; k < s->count; k++) {
            bool sound, between = bisect(s, k, trial, context, &sound);

            if (!sound)
                return false;
            if (!between)
                s->values[k] = 0;
        }
        found = newton(s, trial, context);
    }
    if (!found)
        return lies_beyond(s, trial, context);
    return !is_beyond(s) || look_between(s, trial, context);
}
