/* differences.c: difference quotients between bounds
 *
 * (f(h) - f(-h))/2h; (4 f(h) - f(2h) - 3 f(0))/2h where the other side has no values, or
 * (f(h) - f(0))/h where f(2h) isn't there either. */
#include "simulate/fit/differences.h"

#include "base/memory.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { SHIFTS = 4 };

/* in steps; those of two are evaluated where one side has no values */
static const double shifts[SHIFTS] = {1, -1, 2, -2};

typedef struct DifferencePoint {
    int unknown, shift;
} DifferencePoint;

typedef struct DifferenceWork {
    const Differences *differences;
    const double *x, *at;
    double *out;
    bool (*has)[SHIFTS]; /* of each unknown */
    LIST(DifferencePoint) wanted;
    int *evaluations;
} DifferenceWork;

/* a point, unless it is beyond a bound */
static void want(DifferenceWork *work, int i, int shift)
{
    const Differences *d = work->differences;
    const double value = work->x[i] + shifts[shift] * d->steps[i];
    const DifferencePoint point = {i, shift};

    if (value >= d->low[i] && value <= d->high[i])
        LIST_PUSH(work->wanted, point);
}

/* the difference of a point to the quotient of its unknown, with its factor */
static void add_point(const DifferenceWork *work, const DifferencePoint *point, const double *z)
{
    const Differences *d = work->differences;
    const bool is_far = point->shift >= 2;
    const double factor = (is_far ? -0.5 : 0.5) * (shifts[point->shift] > 0 ? 1 : -1);
    double *change = work->out + point->unknown;

    for (int r = 0; r < d->values; r++, change += d->unknowns)
        *change = (is_far ? 4 * *change : *change) + factor * (z[r] - work->at[r]);
}

static Status evaluate(DifferenceWork *work, Diag *diag)
{
    const Differences *d = work->differences;
    const int count = work->wanted.count;
    double *points, *values;
    Status status;

    if (count == 0)
        return OK;
    points = mem_array((size_t)count * (size_t)d->unknowns, sizeof *points);
    values = mem_array((size_t)count * (size_t)d->values, sizeof *values);
    for (int p = 0; p < count; p++) {
        const DifferencePoint *point = &work->wanted.at[p];
        double *x = points + (ptrdiff_t)p * d->unknowns;

        memcpy(x, work->x, (size_t)d->unknowns * sizeof *x);
        x[point->unknown] += shifts[point->shift] * d->steps[point->unknown];
    }
    *work->evaluations += count;
    CHECK(d->function(d->context, count, points, values, diag));
    for (int p = 0; p < count; p++) {
        const DifferencePoint *point = &work->wanted.at[p];
        const double *z = values + (ptrdiff_t)p * d->values;
        bool has = true;

        for (int r = 0; r < d->values; r++)
            has = has && isfinite(z[r]);
        work->has[point->unknown][point->shift] = has;
        if (has)
            add_point(work, point, z);
    }
done:
    MEM_FREE(points, values);
    work->wanted.count = 0;
    return status;
}

static Status divide(const DifferenceWork *work, int i, Diag *diag)
{
    const Differences *d = work->differences;
    const bool *has = work->has[i];
    const int sides = has[0] + has[1];
    const double factor = sides == 1 && !has[2] && !has[3] ? 2 : 1;

    if (sides == 0)
        return diag_set(diag, E_SOLVER, "the model has no values near the point");
    for (int r = 0; r < d->values; r++) {
        double *change = work->out + (ptrdiff_t)r * d->unknowns + i;

        *change = *change / d->steps[i] * factor;
    }
    return OK;
}

Status differences_find(const Differences *differences, const double *x, const double *at,
                        double *out, int *evaluations, Diag *diag)
{
    const int n = differences->unknowns;
    DifferenceWork work = {.differences = differences,
                           .x = x,
                           .at = at,
                           .out = out,
                           .has = mem_array((size_t)n, sizeof *work.has)};
    Status status;

    work.evaluations = evaluations;
    memset(out, 0, (size_t)n * (size_t)differences->values * sizeof *out);
    for (int i = 0; i < n; i++)
        for (int shift = 0; shift < 2; shift++)
            want(&work, i, shift);
    CHECK(evaluate(&work, diag));
    for (int i = 0; i < n; i++)
        for (int shift = 0; shift < 2; shift++)
            if (work.has[i][shift] && !work.has[i][1 - shift])
                want(&work, i, shift + 2);
    CHECK(evaluate(&work, diag));
    for (int i = 0; i < n; i++)
        CHECK(divide(&work, i, diag));
done:
    LIST_FREE(work.wanted);
    mem_free(work.has);
    return status;
}
