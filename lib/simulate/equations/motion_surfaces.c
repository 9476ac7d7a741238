/* motion_surfaces.c: a motion that slides along surfaces on which its equations jump
 *
 * The jumping term is replaced by a sign between -1 and 1, which is solved for such that the motion
 * stays on the surface (Filippov 1988). A projection onto the surfaces moves along the effect of
 * signs on the rates. */
#include "simulate/equations/motion_impl.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/equations/equations_limits.h"

#include <math.h>
#include <string.h>

void motion_open_surfaces(Motion *mo)
{
    int count = mo->eq->sign_count;

    mo->signs = signs_new(count);
    mo->slip = NEW_ARRAY(double, count);
    mo->off = NEW_ARRAY(double, count);
    mo->bounds = NEW_ARRAY(double, 2 * count);
    mo->way = NEW_ARRAY(double, (count + 1) * motion_length(mo));
}

typedef struct Where {
    Motion *motion;
    double t;
    const double *y;
} Where;

/* slip and distance from the surfaces, with everything solved for these signs */
static bool try_signs(void *context, const double *signs, double *slip)
{
    const Where *at = context;
    Motion *mo = at->motion;
    Solved solved = {
        .acceleration = mo->du, .rates = mo->solved, .algebraic = mo->solved + mo->eq->nx};

    mo->eq->slide(mo->eq->context, signs);
    if (!motion_evaluate(mo, at->t, at->y) || !motion_solve_rates(mo))
        return false;
    mo->eq->slip(mo->eq->context, motion_clock(mo, at->t), at->y, &solved, slip, mo->off,
                 mo->bounds);
    return vector_is_finite(slip, mo->eq->slide_count);
}

bool motion_drift(Motion *mo, double t, const double *y, const double *signs, double *slip,
                  double *off)
{
    Where at = {mo, t, y};

    if (!try_signs(&at, signs, slip))
        return false;
    memcpy(off, mo->off, (size_t)mo->eq->slide_count * sizeof(double));
    return true;
}

const double *motion_bounds(const Motion *mo)
{
    return mo->bounds;
}

bool motion_find_signs(Motion *mo, double t, const double *y)
{
    Where at = {mo, t, y};

    return signs_find(mo->signs, try_signs, &at);
}

/* --- projection --- */

/* u' and x' of the last solution, at their indices in y; 0 elsewhere */
static void keep_way(const Motion *mo, double *way)
{
    const Equations *eq = mo->eq;

    memset(way, 0, (size_t)motion_length(mo) * sizeof(double));
    memcpy(way + eq->n, mo->du, (size_t)eq->nu * sizeof(double));
    memcpy(way + eq->n + eq->nu, mo->solved, (size_t)eq->nx * sizeof(double));
}

bool motion_sign_effect(Motion *mo, double t, const double *y, double *signs, int k,
                        double difference, SignEffect *out)
{
    const Where at = {mo, t, y};
    const double kept = signs[k];
    const int count = mo->eq->slide_count, length = motion_length(mo);
    double *base = mo->way;
    double power;

    if (!try_signs((void *)&at, signs, mo->slip))
        return false;
    keep_way(mo, base);
    motion_bring_power(mo, mo->du);
    power = mo->eq->power != NULL ? *mo->eq->power : 0;
    memcpy(out->slip, mo->slip, (size_t)count * sizeof(double));
    signs[k] = kept + difference;
    if (!try_signs((void *)&at, signs, mo->slip)) {
        signs[k] = kept;
        return false;
    }
    signs[k] = kept;
    keep_way(mo, out->way);
    motion_bring_power(mo, mo->du);
    out->power = mo->eq->power != NULL ? (*mo->eq->power - power) / difference : 0;
    for (int i = 0; i < length; i++)
        out->way[i] = (out->way[i] - base[i]) / difference;
    for (int i = 0; i < count; i++)
        out->slip[i] = (mo->slip[i] - out->slip[i]) / difference;
    return true;
}

/* One move along the effect of unit signs on the rates, which changes the distance from the
 * surfaces as the signs change slip. */
static bool sweep_surfaces(Motion *mo, const Where *at, const double *wanted, double *y)
{
    int count = mo->eq->slide_count, length = motion_length(mo);
    double *values = signs_values(mo->signs);
    double *base = mo->way + count * length;

    if (!signs_slopes(mo->signs, try_signs, (void *)at, mo->slip) ||
        !try_signs((void *)at, values, mo->slip))
        return false;
    keep_way(mo, base);
    for (int k = 0; k < count; k++)
        mo->slip[k] = mo->off[k] - (wanted != NULL ? wanted[k] : 0);
    for (int k = 0; k < count; k++) {
        /* a sign beyond its interval may have no solution, as of friction by a load that it makes
         */
        const double kept = values[k], move = kept > 0 ? -1 : 1;
        double *way = mo->way + k * length;

        values[k] += move;
        if (!try_signs((void *)at, values, mo->off))
            return false;
        values[k] = kept;
        keep_way(mo, way);
        for (int i = 0; i < length; i++)
            way[i] = (way[i] - base[i]) / move;
    }
    if (!signs_solve(mo->signs, mo->slip))
        return false;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < length; i++)
            y[i] += mo->slip[k] * mo->way[k * length + i];
    return true;
}

/* the largest distance from where y is wanted; NULL: on the surfaces */
static double largest_left(const Motion *mo, const double *wanted)
{
    double left = 0;

    for (int k = 0; k < mo->eq->slide_count; k++)
        left = fmax(left, fabs(mo->off[k] - (wanted != NULL ? wanted[k] : 0)));
    return left;
}

static bool move_to_surfaces(Motion *mo, double t, const double *wanted, double *y)
{
    Where at = {mo, t, y};
    double size = fmax(1, vector_largest(y, motion_length(mo) - 1));
    double before = INFINITY;

    for (int sweep = 0; sweep < SURFACE_SWEEPS; sweep++) {
        double left;

        if (!try_signs(&at, signs_values(mo->signs), mo->slip))
            return false;
        left = largest_left(mo, wanted);
        if (left <= 1e-15 * size || (left <= 1e-12 * size && left >= 0.5 * before))
            return true;
        before = left;
        if (!sweep_surfaces(mo, &at, wanted, y))
            return false;
    }
    return true;
}

bool motion_project_surfaces(Motion *mo, double t, double *y)
{
    return move_to_surfaces(mo, t, NULL, y);
}

bool motion_leave_surfaces(Motion *mo, double t, double *y, const double *off)
{
    return move_to_surfaces(mo, t, off, y);
}

bool motion_evaluate_all(Motion *mo, double t, const double *y)
{
    return mo->eq->slide_count > 0 ? motion_find_signs(mo, t, y) : motion_evaluate(mo, t, y);
}
