/* netsolve.c: solves the network's equations G(w) = 0, w = [x'; z], numerically
 *
 *     linear      A w = r
 *     Newton      dG/dw dw = -G, w += s dw; scaled norm |dw|^2 = 1/n sum (dw_i / size_i)^2
 *     damping     s is halved until the next correction with the same factors is at most
 *                 (1 - s/4) |dw| (natural monotonicity test, Deuflhard 1974), or else until the
 *                 weighted residual decreases as much
 *     continuation  G(w) = (1 - s) G(0) from w = 0: sources rise by factors, s = 1e-16 to 1 */
#include "simulate/equations/netsolve.h"

#include "algebra/linear.h"
#include "algebra/sparse.h"
#include "base/memory.h"
#include "base/random.h"
#include "simulate/equations/equations_limits.h"

#include <float.h>
#include <math.h>
#include <string.h>

struct NetSolve {
    const Equations *eq;
    Sparse *matrix;
    bool is_factored; /* valid until switches change */
    uint64_t sides;   /* counter of switch changes when it was factored */
    double *kept; /* right-hand sides with these factors and their solutions, 2 x NETSOLVE_RETAINED
                     x n */
    int kept_count; /* since the factorisation; the newest are kept */
    int n;
    double *w, *step, *trial, *next, *size;
    double *noise;  /* rounding error of the residuals */
    double *weight; /* of the equations, where their residuals are compared */
};

NetSolve *netsolve_new(const Equations *eq)
{
    NetSolve *s = NEW(NetSolve);

    s->eq = eq;
    s->n = eq->nx + eq->nz;
    s->matrix = sparse_new(s->n, eq->network_entries, eq->network_row, eq->network_column);
    s->w = NEW_ARRAY(double, s->n);
    s->step = NEW_ARRAY(double, s->n);
    s->trial = NEW_ARRAY(double, s->n);
    s->next = NEW_ARRAY(double, s->n);
    s->size = NEW_ARRAY(double, s->n);
    s->noise = NEW_ARRAY(double, s->n);
    if (eq->network_is_constant)
        s->kept = NEW_ARRAY(double, 2 * NETSOLVE_RETAINED * s->n);
    s->weight = NEW_ARRAY(double, s->n);
    return s;
}

void netsolve_free(NetSolve *s)
{
    if (s == NULL)
        return;
    sparse_free(s->matrix);
    MEM_FREE(s->kept, s->w, s->step, s->trial, s->next, s->size, s->noise, s->weight, s);
}

double *netsolve_values(NetSolve *s)
{
    return s->w;
}

int netsolve_undetermined(const NetSolve *s)
{
    return sparse_singular(s->matrix);
}

static bool factor_linear(NetSolve *s)
{
    uint64_t sides = s->eq->sides != NULL ? *s->eq->sides : 0;

    if (s->is_factored && s->sides == sides)
        return true;
    s->is_factored = false;
    if (!sparse_factor(s->matrix, s->eq->network))
        return false;
    s->is_factored = s->eq->network_is_constant;
    s->sides = sides;
    s->kept_count = 0;
    return true;
}

static bool solve_linear(NetSolve *s)
{
    const size_t bytes = (size_t)s->n * sizeof(double);
    double *kept;

    if (!factor_linear(s))
        return false;
    for (int k = 0; k < NETSOLVE_RETAINED && k < s->kept_count && s->is_factored; k++) {
        kept = s->kept + (ptrdiff_t)2 * k * s->n;
        if (memcmp(kept, s->eq->network_rhs, bytes) == 0) {
            memcpy(s->w, kept + s->n, bytes);
            return true;
        }
    }
    memcpy(s->w, s->eq->network_rhs, bytes);
    sparse_solve(s->matrix, s->w);
    if (s->is_factored) {
        kept = s->kept + (ptrdiff_t)2 * (s->kept_count++ % NETSOLVE_RETAINED) * s->n;
        memcpy(kept, s->eq->network_rhs, bytes);
        memcpy(kept + s->n, s->w, bytes);
    }
    return true;
}

void netsolve_refine(NetSolve *s)
{
    memcpy(s->step, s->eq->network_residual, (size_t)s->n * sizeof(double));
    sparse_solve(s->matrix, s->step);
    for (int i = 0; i < s->n; i++)
        s->w[i] -= s->step[i];
}

/* --- Newton --- */

/* A^-1 G at w, with the current factors */
static bool correction(NetSolve *s, double *out)
{
    memcpy(out, s->eq->network_residual, (size_t)s->n * sizeof(double));
    if (!vector_is_finite(out, s->n))
        return false;
    sparse_solve(s->matrix, out);
    return vector_is_finite(out, s->n);
}

static double norm(const NetSolve *s, const double *v)
{
    double sum = 0;

    for (int i = 0; i < s->n; i++)
        sum += (v[i] / s->size[i]) * (v[i] / s->size[i]);
    return sqrt(sum / s->n);
}

/* whether every component is at most `share` of the unknown */
static bool is_small(const NetSolve *s, const double *step, double share)
{
    for (int i = 0; i < s->n; i++)
        if (!(fabs(step[i]) <= share * fabs(s->w[i]) + 1e-3 * share * s->size[i] + 1e-14))
            return false;
    return true;
}

/* The scale of an unknown is the largest value that it had on the way. Where the search began far
 * off, as from a trial step's state, which nothing bounds, all later values are small compared to
 * it. Then the scale becomes the value now. Returns whether a scale has changed. */
static bool measure_anew(NetSolve *s)
{
    bool changed = false;

    for (int i = 0; i < s->n; i++) {
        const double size = fmax(fabs(s->w[i]), NETSOLVE_LEAST_SCALE);

        if (s->size[i] > NETSOLVE_STALE_SCALE * size) {
            s->size[i] = size;
            changed = true;
        }
    }
    return changed;
}

/* Whether every residual is 0 within rounding: it changes as much when w moves by its last digits,
 * or the rounding of states and sources is as large. This ends the search for unknowns that hardly
 * any equation determines, such as the potential of a node that diodes isolate, or what remains of
 * large currents that cancel at a small capacitor. */
static bool is_met(NetSolve *s)
{
    const Equations *eq = s->eq;
    uint64_t seed = 1;
    bool met = true;

    eq->network_at(eq->context, s->w);
    memcpy(s->next, eq->network_residual, (size_t)s->n * sizeof(double));
    memset(s->noise, 0, (size_t)s->n * sizeof(double));
    if (eq->network_rounding != NULL)
        eq->network_rounding(eq->context, s->noise);
    for (int i = 0; i < s->n; i++)
        if (!isfinite(s->noise[i]))
            s->noise[i] = 0; /* there is no bound: moves estimate it */
    for (int turn = 0; turn < NETSOLVE_PERTURBATIONS; turn++) {
        for (int i = 0; i < s->n; i++)
            s->trial[i] = s->w[i] * (1 + NETSOLVE_ULPS * DBL_EPSILON * random_unit(&seed));
        eq->network_at(eq->context, s->trial);
        for (int i = 0; i < s->n; i++)
            s->noise[i] = fmax(s->noise[i], fabs(eq->network_residual[i] - s->next[i]));
    }
    for (int i = 0; i < s->n; i++)
        met = met && isfinite(s->noise[i]) && fabs(s->next[i]) <= s->noise[i];
    eq->network_at(eq->context, s->w);
    return met;
}

/* The correction at w - share * step, with the current factors; NAN where there is none. */
static double correction_at(NetSolve *s, double share)
{
    for (int i = 0; i < s->n; i++)
        s->trial[i] = s->w[i] - share * s->step[i];
    s->eq->network_at(s->eq->context, s->trial);
    return correction(s, s->next) ? norm(s, s->next) : (double)NAN;
}

/* More than a full step: along an exponential, as of a diode, each Newton step is as long as the
 * last. */
static double furthest(NetSolve *s, double full)
{
    double share = 1;

    while (share < NETSOLVE_MOST_STRETCH) {
        double next = correction_at(s, 2 * share);

        if (!(next <= full / 2))
            break;
        full = next;
        share *= 2;
    }
    return share;
}

/* One damped step; false where even its smallest share gives no decrease. */
static bool advance(NetSolve *s, double before)
{
    double share = 1;

    while (share >= NETSOLVE_LEAST_DAMPING) {
        double next = correction_at(s, share);

        if (!(next <= (1 - share / 4) * before)) {
            share /= 2;
            continue;
        }
        if (share == 1 && next > before / 4)
            share = furthest(s, next);
        for (int i = 0; i < s->n; i++)
            s->w[i] -= share * s->step[i];
        return true;
    }
    return false;
}

/* weighted norm of the residuals */
static double misfit(const NetSolve *s)
{
    double sum = 0;

    for (int i = 0; i < s->n; i++)
        sum += (s->eq->network_residual[i] * s->weight[i]) *
               (s->eq->network_residual[i] * s->weight[i]);
    return sqrt(sum);
}

/* weight of each equation, from its largest term at the start */
static void weigh(NetSolve *s)
{
    const Equations *eq = s->eq;

    memset(s->weight, 0, (size_t)s->n * sizeof(double));
    for (int k = 0; k < eq->network_entries; k++) {
        double *weight = &s->weight[eq->network_row[k]];

        *weight = fmax(*weight, fabs(eq->network[k]) * s->size[eq->network_column[k]]);
    }
    for (int i = 0; i < s->n; i++)
        s->weight[i] = s->weight[i] > 0 ? 1 / s->weight[i] : 1;
}

/* The same by the norm of the residuals. After a kink, as of a diode, derivatives differ by many
 * orders of magnitude. Corrections with the derivatives before it are useless there, but the
 * residual still decreases. */
static bool descend(NetSolve *s)
{
    const Equations *eq = s->eq;
    double before = misfit(s);
    double share = 1;

    while (share >= NETSOLVE_LEAST_SHARE) {
        for (int i = 0; i < s->n; i++)
            s->trial[i] = s->w[i] - share * s->step[i];
        eq->network_at(eq->context, s->trial);
        if (vector_is_finite(eq->network_residual, s->n) && misfit(s) <= (1 - share / 4) * before) {
            memcpy(s->w, s->trial, (size_t)s->n * sizeof(double));
            return true;
        }
        share /= 2;
    }
    return false;
}

/* Step control of Newton's method: damped so that corrections decrease; damped so that residuals
 * decrease; or undamped from one linear piece to the next, as of piecewise linear diodes. */
typedef enum Way { BY_CORRECTION, BY_MISFIT, BY_PIECES, WAYS } Way;

static bool take_step(NetSolve *s, Way way, int turn)
{
    double share =
        turn < NETSOLVE_UNDAMPED ? 1 : 1 - fmod(turn * 0.381966011, 1); /* leaves cycles */

    if (way == BY_CORRECTION)
        return advance(s, norm(s, s->step));
    if (way == BY_MISFIT)
        return descend(s);
    for (int i = 0; i < s->n; i++)
        s->w[i] -= share * s->step[i];
    return true;
}

static bool has_endless_slope(const NetSolve *s)
{
    return !vector_is_finite(s->eq->network, s->eq->network_entries);
}

/* Unknowns in which a derivative is infinite are moved a little, each by a share of its own so that
 * differences move too: a law such as sign(v)*sqrt(abs(v)) can't be solved from exactly 0. */
static void step_perturbed(NetSolve *s)
{
    const Equations *eq = s->eq;

    memset(s->step, 0, (size_t)s->n * sizeof(double));
    for (int k = 0; k < eq->network_entries; k++) {
        const int column = eq->network_column[k];

        if (!isfinite(eq->network[k]))
            s->step[column] =
                NETSOLVE_PERTURBATION * s->size[column] * (1 + fmod(column * 0.618033989, 1));
    }
    for (int i = 0; i < s->n; i++)
        s->w[i] += s->step[i];
}

static bool solve_newton(NetSolve *s, Way way)
{
    const Equations *eq = s->eq;
    double before = INFINITY;

    for (int i = 0; i < s->n; i++)
        s->size[i] = fmax(fabs(s->w[i]), NETSOLVE_LEAST_SCALE);
    for (int k = 0; k < NETSOLVE_ITERATIONS; k++) {
        eq->network_at(eq->context, s->w);
        if (has_endless_slope(s)) {
            if (vector_largest(eq->network_residual, s->n) == 0)
                return true; /* no derivative is needed */
            step_perturbed(s);
            continue;
        }
        if (!sparse_factor(s->matrix, eq->network) || !correction(s, s->step))
            return false;
        for (int i = 0; i < s->n; i++)
            s->size[i] = fmax(s->size[i], fabs(s->w[i]));
        if (k == 0)
            weigh(s);
        if (is_small(s, s->step, NETSOLVE_CONVERGED)) {
            for (int i = 0; i < s->n; i++)
                s->w[i] -= s->step[i];
            if (!measure_anew(s))
                return true;
            continue;
        }
        if (k >= NETSOLVE_PATIENCE && norm(s, s->step) > before / 2 && is_met(s))
            return true;
        before = norm(s, s->step);
        if (!take_step(s, way, k)) {
            (void)measure_anew(s);
            return is_small(s, s->step, NETSOLVE_ROUNDING) || is_met(s);
        }
    }
    return false;
}

/* Undamped steps to G(w) = left G(0), `origin` = G(0), close enough to continue from. */
static bool solve_near(NetSolve *s, const double *origin, double left)
{
    const Equations *eq = s->eq;

    for (int k = 0; k < NETSOLVE_CONTINUATION_STEPS; k++) {
        eq->network_at(eq->context, s->w);
        for (int i = 0; i < s->n; i++)
            s->step[i] = eq->network_residual[i] - left * origin[i];
        if (!sparse_factor(s->matrix, eq->network))
            return false;
        sparse_solve(s->matrix, s->step);
        if (!vector_is_finite(s->step, s->n))
            return false;
        for (int i = 0; i < s->n; i++) {
            s->w[i] -= s->step[i];
            s->size[i] = fmax(s->size[i], fabs(s->w[i]));
        }
        if (is_small(s, s->step, NETSOLVE_CONTINUATION))
            return true;
    }
    return false;
}

/* Source stepping from w = 0 along G(w) = (1 - share) G(0): the sources rise from 0 through the
 * decades that an exponential covers, and each solution is the initial guess of the next. */
static bool solve_rising(NetSolve *s)
{
    double *origin = NEW_ARRAY(double, s->n), *last = NEW_ARRAY(double, s->n);
    double share = SOURCES_FIRST, factor = SOURCES_FACTOR;
    bool arrived = false;

    memset(s->w, 0, (size_t)s->n * sizeof(double));
    for (int i = 0; i < s->n; i++)
        s->size[i] = NETSOLVE_LEAST_SCALE;
    s->eq->network_at(s->eq->context, s->w);
    memcpy(origin, s->eq->network_residual, (size_t)s->n * sizeof(double));
    while (!arrived && factor > SOURCES_LEAST_FACTOR) {
        const double next = fmin(1, share * factor);

        if (solve_near(s, origin, 1 - next)) {
            memcpy(last, s->w, (size_t)s->n * sizeof(double));
            share = next;
            arrived = share == 1;
            factor = fmin(SOURCES_FACTOR, factor * factor);
        } else {
            memcpy(s->w, last, (size_t)s->n * sizeof(double));
            factor = sqrt(factor);
        }
    }
    MEM_FREE(origin, last);
    return arrived && solve_newton(s, BY_CORRECTION);
}

/* from the last solution, then from 0, since the last one may belong to another branch */
static bool find_by_iteration(NetSolve *s)
{
    double *kept;
    bool found = false;

    if (!vector_is_finite(s->w, s->n))
        memset(s->w, 0, (size_t)s->n * sizeof(double));
    kept = NEW_ARRAY(double, s->n);
    memcpy(kept, s->w, (size_t)s->n * sizeof(double));
    for (int k = 0; k < 2 * WAYS && !found; k++) {
        if (k >= WAYS)
            memset(s->w, 0, (size_t)s->n * sizeof(double));
        else
            memcpy(s->w, kept, (size_t)s->n * sizeof(double));
        found = solve_newton(s, k % WAYS);
    }
    found = found || solve_rising(s);
    if (!found)
        memcpy(s->w, kept, (size_t)s->n * sizeof(double));
    mem_free(kept);
    return found;
}

bool netsolve_find(NetSolve *s)
{
    if (s->n == 0)
        return true;
    if (s->eq->network_at == NULL)
        return solve_linear(s) && vector_is_finite(s->w, s->n);
    return find_by_iteration(s);
}
