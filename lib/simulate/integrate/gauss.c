/* gauss.c: collocation at three Gauss points with fixed steps, order 6
 *
 * Y_i = y + h sum_j a_ij f(Y_j), y_new = y + h sum_i b_i f(Y_i). A step is symmetric in time and
 * conserves quadratic invariants (unit Euler parameters): the energy of a conservative motion
 * remains bounded for long, where it drifts with a method that isn't symmetric. In coordinates and
 * their rates the method is symplectic where masses don't depend on coordinates, and symmetric
 * everywhere. Symmetry requires exact stages, so they are solved to rounding, and the rounding
 * error of y is carried to the next step (compensated summation).
 *
 * Constraints are satisfied by symmetric projection (Hairer, BIT 40, 2000), since a projection
 * after each step would not be symmetric: the same displacement v leads off the manifold before the
 * step and back onto it after. Between its ends a step is interpolated by the polynomial with the
 * slopes at both ends and at the stages. Hairer, Lubich, Wanner: Geometric Numerical Integration,
 * II.1.3, V.4.1, VIII.5, 6. */
#include "simulate/integrate/fixed.h"

#include "base/memory.h"
#include "simulate/integrate/integrate_limits.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    STAGES = 3,
    SLOPES = STAGES + 2,   /* known slopes of a step: at its start, its stages, its end */
    MOST_SWEEPS = 60,      /* iterations over the stages */
    MOST_PUSHES = 12,      /* iterations of v */
    BEND = 2 * STAGES + 1, /* slopes from which the sixth derivative is estimated */
};
/* The quadrature's error is h^7/2016000 of the sixth derivative of y'; that is 720/2016000 of the
 * sixth divided difference over points in units of steps. */
#define BEND_PART (1.0 / 2800)

#define ROOT15 3.8729833462074168852
static const double node[STAGES] = {0.5 - ROOT15 / 10, 0.5, 0.5 + ROOT15 / 10};
static const double weight[STAGES] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
static const double part[STAGES][STAGES] = {
    {5.0 / 36, 2.0 / 9 - ROOT15 / 15, 5.0 / 36 - ROOT15 / 30},
    {5.0 / 36 + ROOT15 / 24, 2.0 / 9, 5.0 / 36 - ROOT15 / 24},
    {5.0 / 36 + ROOT15 / 30, 2.0 / 9 + ROOT15 / 15, 5.0 / 36},
};
/* positions of the SLOPES in a step */
static const double place[SLOPES] = {0, 0.5 - ROOT15 / 10, 0.5, 0.5 + ROOT15 / 10, 1};

typedef struct Gauss {
    FixedStepper fixed;
    double *k[STAGES], *before[STAGES]; /* slopes at the stages, and at those of the step before */
    double *point, *from;               /* from: start of the step, off the manifold by v */
    double *push;                       /* v */
    double h;                           /* of the last step, which a difference of times has not */
    double *carry;                      /* rounding error of y at the start of the step */
    double bend[BEND];                  /* divided difference of before, old_rate and k */
} Gauss;

/* the integral from 0 to x of the Lagrange polynomial that is 1 at position i and 0 at the others:
 * by Gauss' rule, exact for its degree */
static double share(int i, double x)
{
    double sum = 0;

    for (int s = 0; s < STAGES; s++) {
        double product = weight[s];

        for (int j = 0; j < SLOPES; j++)
            if (j != i)
                product *= (x * node[s] - place[j]) / (place[i] - place[j]);
        sum += product;
    }
    return x * sum;
}

static void bend_weights(double *out)
{
    double at[BEND];

    for (int s = 0; s < STAGES; s++) {
        at[s] = node[s] - 1;
        at[STAGES + 1 + s] = node[s];
    }
    at[STAGES] = 0;
    for (int i = 0; i < BEND; i++) {
        out[i] = 1;
        for (int j = 0; j < BEND; j++)
            if (j != i)
                out[i] /= at[i] - at[j];
    }
}

/* initial guess of the slopes at the stages: extrapolation of the step before */
static void guess(Gauss *g, double h)
{
    const FixedStepper *f = &g->fixed;
    const bool is_known = f->step_before > 0;

    for (int s = 0; s < STAGES; s++) {
        double l[STAGES + 1], x = is_known ? h / f->step_before * node[s] : 0;

        /* through the slopes at the last stages and at the start, in units of the step before */
        for (int i = 0; is_known && i <= STAGES; i++) {
            double at = i < STAGES ? node[i] - 1 : 0;

            l[i] = 1;
            for (int j = 0; j <= STAGES; j++) {
                double other = j < STAGES ? node[j] - 1 : 0;

                if (j != i)
                    l[i] *= (x - other) / (at - other);
            }
        }
        for (int i = 0; i < f->all; i++)
            g->k[s][i] = is_known ? l[0] * g->before[0][i] + l[1] * g->before[1][i] +
                                        l[2] * g->before[2][i] + l[3] * f->old_rate[i]
                                  : f->old_rate[i];
    }
}

/* The new slope of stage s into g->k; *moved becomes its change, in rounding errors of y. */
static bool sweep_stage(Gauss *g, int s, double h, double *moved)
{
    FixedStepper *f = &g->fixed;
    const Control *control = &f->base.control;
    double *rate = f->rate;

    for (int i = 0; i < f->all; i++)
        g->point[i] = g->from[i] + h * (part[s][0] * g->k[0][i] + part[s][1] * g->k[1][i] +
                                        part[s][2] * g->k[2][i]);
    if (!stepper_rate(&f->base, f->base.before + node[s] * h, g->point, rate))
        return false;
    for (int i = 0; i < f->base.ode->n; i++)
        *moved = fmax(*moved, h * fabs(rate[i] - g->k[s][i]) /
                                  (fabs(g->point[i]) + control->atol / control->rtol));
    memcpy(g->k[s], rate, (size_t)f->all * sizeof(double));
    return true;
}

/* Solve for the stages of a step from g->from, starting with the slopes in g->k; false: they don't
 * converge, or are undefined. */
static bool solve_stages(Gauss *g, double h)
{
    double before = HUGE_VAL;

    for (int i = 0; i < MOST_SWEEPS; i++) {
        double moved = 0;

        for (int s = 0; s < STAGES; s++)
            if (!sweep_stage(g, s, h, &moved))
                return false;
        moved /= DBL_EPSILON;
        /* the next iteration would change by `moved / before` of it */
        if (moved <= 1 || (i > 0 && moved * (moved / before) <= 1))
            return true;
        if (moved >= before && before * DBL_EPSILON <= GAUSS_STALLED * g->fixed.base.control.rtol)
            return true;
        if (moved >= before && i > STAGES)
            break;
        before = moved;
    }
    g->fixed.reason =
        "the stages of steps don't settle, which are too long for what swings or decays "
        "here";
    return false;
}

/* the step's displacement of y_i, with the carried rounding error */
static double way_of(const Gauss *g, double h, int i)
{
    return h * (weight[0] * g->k[0][i] + weight[1] * g->k[1][i] + weight[2] * g->k[2][i]) +
           g->carry[i];
}

/* norm of a displacement, relative to y */
static double size_of(const Gauss *g, const double *way)
{
    const Stepper *s = &g->fixed.base;
    double size = 0;

    for (int i = 0; i < s->ode->n; i++)
        size = fmax(size, fabs(way[i]) / (fabs(s->y[i]) + s->control.atol / s->control.rtol));
    return size;
}

/* Project v onto the normal space of the manifold half way between both ends of the step, which is
 * symmetric in time. */
static bool make_normal(Gauss *g, double t)
{
    FixedStepper *f = &g->fixed;
    const Ode *ode = f->base.ode;
    const double look = GAUSS_PROJECTION / size_of(g, g->push);

    if (!isfinite(look))
        return true;
    for (int i = 0; i < f->all; i++) {
        const double half = (f->old[i] + f->base.y[i]) / 2;

        g->point[i] = half + look * g->push[i];
        g->from[i] = half - look * g->push[i];
    }
    if (!ode->project(ode->context, t, g->point) || !ode->project(ode->context, t, g->from))
        return false;
    for (int i = 0; i < ode->n; i++)
        g->push[i] -= (g->point[i] - g->from[i]) / (2 * look);
    return true;
}

/* Iterate v until the step from old + v, displaced by v again at its end, ends on the manifold. */
static bool meet_constraints(Gauss *g, double h, double end)
{
    FixedStepper *f = &g->fixed;
    const Ode *ode = f->base.ode;
    double off_before = HUGE_VAL, off;

    memset(g->push, 0, (size_t)f->all * sizeof(double));
    for (int j = 0; j < MOST_PUSHES; j++) {
        for (int i = 0; i < f->all; i++)
            g->from[i] = f->old[i] + g->push[i];
        if (!solve_stages(g, h))
            return false;
        for (int i = 0; i < f->all; i++)
            f->base.y[i] = g->point[i] = f->old[i] + (way_of(g, h, i) + 2 * g->push[i]);
        if (!ode->project(ode->context, end, f->base.y))
            return false;
        for (int i = 0; i < f->all; i++)
            g->point[i] = f->base.y[i] - g->point[i];
        off = size_of(g, g->point);
        if (off <= 4 * DBL_EPSILON || off >= off_before)
            break;
        off_before = off;
        for (int i = 0; i < ode->n; i++)
            g->push[i] += g->point[i] / 2;
        if (!make_normal(g, f->base.before + h / 2))
            return false;
    }
    return true;
}

static bool advance(FixedStepper *f, double h, double end)
{
    Gauss *g = (Gauss *)f;

    g->h = h;
    stepper_begin(&f->base, f->base.before, f->old, h);
    guess(g, h);
    if (f->base.ode->project != NULL) {
        if (!meet_constraints(g, h, end))
            return false;
    } else {
        memcpy(g->from, f->old, (size_t)f->all * sizeof(double));
        if (!solve_stages(g, h))
            return false;
        for (int i = 0; i < f->all; i++)
            f->base.y[i] = f->old[i] + way_of(g, h, i);
    }
    f->base.t = end;
    return stepper_rate(&f->base, end, f->base.y, f->rate);
}

static double error_of(const FixedStepper *f, double h, int i)
{
    const Gauss *g = (const Gauss *)f;
    double sum = g->bend[STAGES] * f->old_rate[i];

    if (!(fabs(h - f->step_before) <= 1e-9 * h))
        return 0;
    for (int s = 0; s < STAGES; s++)
        sum += g->bend[s] * g->before[s][i] + g->bend[STAGES + 1 + s] * g->k[s][i];
    return h * fabs(sum) * BEND_PART;
}

static void keep(FixedStepper *f)
{
    const Gauss *g = (const Gauss *)f;

    for (int s = 0; s < STAGES; s++)
        memcpy(g->before[s], g->k[s], (size_t)f->all * sizeof(double));
    for (int i = 0; f->base.ode->project == NULL && i < f->all; i++)
        g->carry[i] = way_of(g, g->h, i) - (f->base.y[i] - f->old[i]);
}

static Stepper *create(const Ode *ode, const Control *control)
{
    Gauss *g = NEW(Gauss);
    Stepper *base = &g->fixed.base;
    const int all = (fixed_init(&g->fixed, &method_gauss, ode, control), g->fixed.all);

    g->fixed.advance = advance;
    g->fixed.error = error_of;
    g->fixed.keep = keep;
    for (int s = 0; s < STAGES; s++) {
        g->k[s] = stepper_numbers(base, all);
        g->before[s] = stepper_numbers(base, all);
    }
    g->point = stepper_numbers(base, all);
    g->from = stepper_numbers(base, all);
    g->push = stepper_numbers(base, all);
    g->carry = stepper_numbers(base, all);
    bend_weights(g->bend);
    return base;
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Gauss *g = (Gauss *)stepper;

    memset(g->carry, 0, (size_t)g->fixed.all * sizeof(double));
    return fixed_start(stepper, t, y, diag);
}

static void at(Stepper *stepper, double t, double *y)
{
    const Gauss *g = (const Gauss *)stepper;
    const FixedStepper *f = &g->fixed;
    const double h = f->base.t - f->base.before, x = h > 0 ? (t - f->base.before) / h : 1;
    double c[SLOPES], left[SLOPES];

    for (int j = 0; j < SLOPES; j++) {
        c[j] = h * share(j, x);
        left[j] = x * h * share(j, 1);
    }
    /* through y at the end, which was projected */
    for (int i = 0; i < f->all; i++) {
        const double slope[SLOPES] = {f->old_rate[i], g->k[0][i], g->k[1][i], g->k[2][i],
                                      f->rate[i]};
        double sum = x * (f->base.y[i] - f->old[i]);

        for (int j = 0; j < SLOPES; j++)
            sum += (c[j] - left[j]) * slope[j];
        y[i] = f->old[i] + sum;
    }
}

static const double nodes[] = {0.5 - ROOT15 / 10, 0.5, 0.5 + ROOT15 / 10, 1};

const Method method_gauss = {
    .name = "symplectic",
    .brief = "Gauss collocation of order 6, fixed steps (step=, else one per row), "
             "time-reversible: the energy of long conservative runs doesn't drift; controls no "
             "error, and reports that",
    .create = create,
    .destroy = stepper_free,
    .start = start,
    .step = fixed_step,
    .at = at,
    .shorten = fixed_shorten,
    .slope = fixed_slope,
    .nodes = nodes,
    .node_count = COUNT(nodes),
    .sees_little = true,
    .pulse_steps = 12,
    .has_fixed_step = true,
};
