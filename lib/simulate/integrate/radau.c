/* radau.c: implicit Runge-Kutta of order 5 for stiff equations, three Radau IIA stages
 *
 * Hairer and Wanner (1996), Solving ODE II, IV.8: with stages y + z_i at c_i h, z = h (A x 1) f(y +
 * z), solved by simplified Newton with J = df/dy, kept while the iteration contracts well. A^-1 = T
 * diag(g, [a b; -b a]) T^-1 splits its linear system into a real one and a complex one. Where stiff
 * forces change direction during the motion, as those of a knife edge with damping D, this
 * contracts only while D turn^2 h^3 is below 1. Beyond that Newton's method uses J at each stage,
 * (A^-1/h x 1 - diag(J_1, J_2, J_3)) delta = f - A^-1/h z. The error is that of their embedded
 * formula of order 3, filtered by (g/h - J)^-1 so that stiff components don't dominate it. Between
 * its ends a step is interpolated by the collocation polynomial and an estimate of its error, which
 * the step control bounds as well. */
#include "simulate/integrate/shifted.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/integrate/integrate_limits.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* of s (s - c1) (s - c2) (s - 1): slopes at 0 and 1, and largest value between */
#define BEGINS  0.1
#define ENDS    0.3
#define BETWEEN 0.0183

#define ROOT6 2.44948974278317809820

/* clang-format off */
static const double nodes[3] = {(4 - ROOT6) / 10, (4 + ROOT6) / 10, 1};
static const double weights[3][3] = {
    {(88 - 7 * ROOT6) / 360,     (296 - 169 * ROOT6) / 1800, (-2 + 3 * ROOT6) / 225},
    {(296 + 169 * ROOT6) / 1800, (88 + 7 * ROOT6) / 360,     (-2 - 3 * ROOT6) / 225},
    {(16 - ROOT6) / 36,          (16 + ROOT6) / 36,          1.0 / 9},
};
/* factors of z in the error formula (IV.8.19), with the real eigenvalue g of A^-1 */
static const double embedded[3] = {(-13 - 7 * ROOT6) / 3, (-13 + 7 * ROOT6) / 3, -1.0 / 3};
static const double inverse[3][3] = { /* A^-1 */
    {(3.2247448713915890491),  (1.1678400846904054949),  (-0.25319726474218082619)},
    {(-3.5678400846904054949), (0.7752551286084109510),  (1.0531972647421808262)},
    {(5.5319726474218082619),  (-7.5319726474218082619), (5)},
};
static const double split[3][3] = { /* T^-1 */
    {4.1787185915519047273,  0.32768282076106238708,  0.52337644549944954804},
    {-4.1787185915519047273, -0.32768282076106238708, 0.47662355450055045196},
    {0.50287263494578687595, -2.5719269498556054292,  0.59603920482822492497},
};
static const double joined[3][3] = { /* T */
    {0.094438762488975241487, -0.14125529502095420843, 0.030029194105147424492},
    {0.25021312296533331138,  0.204129352293799932,    -0.38294211275726193780},
    {1, 1, 0},
};
/* clang-format on */
#define EIGENVALUE 3.6378342527444957322 /* g = 30 / (6 + 81^(1/3) - 9^(1/3)) */
#define PAIR_REAL  2.6810828736277521339 /* a */
#define PAIR_TURN  3.0504301992474105694 /* b */

typedef struct Radau {
    Stepper base;
    int n, all; /* entries in the error test; with quadratures */
    double *old, *old_rate, *rate, *scale;
    double *z, *f, *delta; /* 3 x all, 3 x all, 3 x n */
    double *point, *error, *column;
    double *part; /* 3 x n: of the split system */
    Shifted *shifted;
    double factored; /* step of the factors; 0: none */
    bool fresh;      /* the Jacobian is that at `old` */
    bool is_linear;  /* the equations are linear: it remains valid until a restart */
    double step;     /* of the last step */
    double *slope;   /* n: of its cubic, at its end */
    double *fourth;  /* n: y(4)/24 in it, estimated; 0 after a start */
    double contraction;
    bool was_rejected;
    /* for Newton's method with a Jacobian at each stage; NULL until that is needed */
    Lu *whole, *end;   /* 3n x 3n; n x n: g/h - J_3 */
    double *jacobians; /* 3 x all x n: rows of y' by n */
    bool is_turning;   /* the simplified method failed: this one is tried first */
} Radau;

typedef enum StepOutcome { CONVERGED, DIVERGED, UNDEFINED } StepOutcome;

static Stepper *create(const Ode *ode, const Control *control)
{
    Radau *r = NEW(Radau);
    int n = ode->n, all = ode->n + ode->quadratures;

    stepper_init(&r->base, &method_radau, ode, control);
    r->n = n;
    r->all = all;
    r->old = stepper_numbers(&r->base, all);
    r->old_rate = stepper_numbers(&r->base, all);
    r->rate = stepper_numbers(&r->base, all);
    r->scale = stepper_numbers(&r->base, n);
    r->z = stepper_numbers(&r->base, 3 * all);
    r->f = stepper_numbers(&r->base, 3 * all);
    r->delta = stepper_numbers(&r->base, 3 * n);
    r->point = stepper_numbers(&r->base, all);
    r->error = stepper_numbers(&r->base, all);
    r->column = stepper_numbers(&r->base, all);
    r->part = stepper_numbers(&r->base, 3 * n);
    r->slope = stepper_numbers(&r->base, n);
    r->fourth = stepper_numbers(&r->base, n);
    r->shifted = shifted_new(ode, &r->base.counts);
    return &r->base;
}

static void destroy(Stepper *stepper)
{
    if (stepper != NULL) {
        shifted_free(((Radau *)stepper)->shifted);
        lu_free(((Radau *)stepper)->whole);
        lu_free(((Radau *)stepper)->end);
    }
    stepper_free(stepper);
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Radau *r = (Radau *)stepper;

    r->factored = 0;
    r->fresh = r->is_linear = false;
    r->contraction = 1;
    r->was_rejected = r->is_turning = false;
    r->step = 0;
    return stepper_start(stepper, t, y, r->rate, diag);
}

/* --- pieces of a step --- */

static void choose_scale(Radau *r)
{
    const double *error_floor = r->base.ode->error_floor;

    for (int i = 0; i < r->n; i++) {
        r->scale[i] = stepper_tolerance(&r->base, i, fabs(r->old[i]));
        if (error_floor != NULL)
            r->scale[i] = fmax(r->scale[i], error_floor[i]);
    }
}

static double scaled_norm(const Radau *r, const double *v, int count)
{
    double sum = 0;

    for (int k = 0; k < count; k++)
        for (int i = 0; i < r->n; i++) {
            double part = v[k * r->n + i] / r->scale[i];

            sum += part * part;
        }
    return sqrt(sum / (r->n > 0 ? count * r->n : 1));
}

/* df/dy at `old` */
static bool find_jacobian(Radau *r)
{
    if (!shifted_differentiate(r->shifted, r->base.before, r->old, r->old_rate))
        return false;
    r->fresh = true;
    r->is_linear = shifted_is_linear(r->shifted);
    r->factored = 0;
    return true;
}

/* g/h - J, and (a - ib)/h - J */
static bool factor(Radau *r, double h)
{
    r->factored = shifted_factor(r->shifted, EIGENVALUE / h, PAIR_REAL / h, PAIR_TURN / h) ? h : 0;
    return r->factored > 0;
}

/* sums of three vectors by the rows of a matrix */
static void combine(int n, const double matrix[3][3], const double *from, double *out)
{
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            out[k * n + i] = matrix[k][0] * from[i] + matrix[k][1] * from[n + i] +
                             matrix[k][2] * from[2 * n + i];
}

/* Residual of the stages, into delta: f - (A^-1/h x 1) z (3 x n) */
static void find_residual(Radau *r, double h)
{
    const int n = r->n, all = r->all;

    for (int k = 0; k < 3; k++)
        for (int i = 0; i < n; i++)
            r->delta[k * n + i] =
                r->f[k * all + i] - (inverse[k][0] * r->z[i] + inverse[k][1] * r->z[all + i] +
                                     inverse[k][2] * r->z[2 * all + i]) /
                                        h;
}

/* A step of Newton's: (A^-1/h x 1 - 1 x J) delta = f - A^-1/h z */
static void correct_stages(Radau *r, double h)
{
    const int n = r->n;

    find_residual(r, h);
    combine(n, split, r->delta, r->part);
    shifted_solve(r->shifted, r->part);
    shifted_solve_pair(r->shifted, r->part + n, r->part + 2 * n);
    combine(n, joined, r->part, r->delta);
}

/* initial guess of the stages: extrapolation of the last step's polynomial */
static void guess_stages(Radau *r, double h, bool extrapolate)
{
    if (!extrapolate || r->step == 0) {
        memset(r->z, 0, (size_t)(3 * r->all) * sizeof(double));
        return;
    }
    for (int k = 0; k < 3; k++)
        r->base.method->at(&r->base, r->base.t + nodes[k] * h, r->f + k * r->all);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < r->all; i++)
            r->z[k * r->all + i] = r->f[k * r->all + i] - r->base.y[i];
}

static bool evaluate_stages(Radau *r, double h)
{
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < r->all; i++)
            r->point[i] = r->old[i] + r->z[k * r->all + i];
        if (!stepper_rate(&r->base, r->base.before + nodes[k] * h, r->point, r->f + k * r->all))
            return false;
    }
    return true;
}

/* Simplified Newton for the stages; *used becomes the number of iterations. */
static StepOutcome solve_stages(Radau *r, double h, int *used)
{
    int n = r->n, all = r->all;
    double enough =
        fmax(10 * DBL_EPSILON / r->base.control.rtol, fmin(0.01, sqrt(r->base.control.rtol)));
    double before = 0;

    for (int it = 1; it <= RADAU_ITERATIONS; it++) {
        double size, eta = 1;

        if (!evaluate_stages(r, h))
            return UNDEFINED;
        correct_stages(r, h);
        size = scaled_norm(r, r->delta, 3);
        if (!isfinite(size))
            return UNDEFINED;
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < n; i++)
                r->z[k * all + i] += r->delta[k * n + i];
        *used = it;
        if (r->is_linear) { /* one iteration solves linear equations */
            r->contraction = 0;
            return CONVERGED;
        }
        if (it > 1) {
            r->contraction = size / before;
            if (r->contraction >= 0.99)
                return size < 1e-3 * enough ? CONVERGED : DIVERGED;
            eta = r->contraction / (1 - r->contraction);
        }
        if (eta * size <= enough || size == 0)
            return CONVERGED;
        before = size;
    }
    return DIVERGED;
}

/* A^-1/h x 1 - diag(J_1, J_2, J_3), factored, at the current stages */
static bool factor_whole(Radau *r, double h)
{
    const int n = r->n, all = r->all, size = 3 * n;
    double *a = lu_matrix(r->whole);

    for (int k = 0; k < 3; k++) {
        const double *jacobian = r->jacobians + (ptrdiff_t)k * all * n;

        for (int i = 0; i < all; i++)
            r->point[i] = r->old[i] + r->z[k * all + i];
        if (!shifted_jacobian(r->shifted, r->base.before + nodes[k] * h, r->point, r->f + k * all,
                              r->jacobians + (ptrdiff_t)k * all * n))
            return false;
        for (int i = 0; i < n; i++)
            for (int l = 0; l < 3; l++)
                for (int j = 0; j < n; j++)
                    a[(ptrdiff_t)(k * n + i) * size + l * n + j] =
                        (i == j ? inverse[k][l] / h : 0) - (k == l ? jacobian[i * n + j] : 0);
    }
    return lu_factor(r->whole);
}

/* Newton's method for all stages at once, with J at each of them. The unknowns are few, and J is
 * dense. O(27 n^3) a factorisation. */
static StepOutcome solve_stages_whole(Radau *r, double h, int *used)
{
    const int n = r->n, all = r->all;
    const double enough = fmax(10 * DBL_EPSILON / r->base.control.rtol, 1e-3);
    double before = 0;
    bool factored = false;

    if (r->whole == NULL) {
        r->whole = lu_new(3 * n);
        r->end = lu_new(n);
        r->jacobians = stepper_numbers(&r->base, 3 * all * n);
    }
    for (int it = 1; it <= RADAU_ITERATIONS; it++) {
        double size, eta = 1;

        if (!evaluate_stages(r, h))
            return UNDEFINED;
        if (!factored && !factor_whole(r, h))
            return UNDEFINED;
        find_residual(r, h);
        lu_solve(r->whole, r->delta);
        size = scaled_norm(r, r->delta, 3);
        if (!isfinite(size))
            return UNDEFINED;
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < n; i++)
                r->z[k * all + i] += r->delta[k * n + i];
        *used = it;
        if (it > 1) {
            r->contraction = size / before;
            if (r->contraction >= 2)
                return DIVERGED;
            eta = fmin(1, r->contraction);
        }
        if (eta * size <= enough || size == 0)
            return CONVERGED;
        factored = it > 1 && r->contraction < RADAU_REFRESH;
        before = size;
    }
    return DIVERGED;
}

/* Solve for the stages, by the cheaper method that converges. */
static StepOutcome find_stages(Radau *r, double h, int *used)
{
    const bool is_small = r->n > 0 && r->n <= RADAU_FULL && !r->is_linear && r->step > 0;
    StepOutcome outcome = DIVERGED;

    if (!is_small || !r->is_turning)
        outcome = solve_stages(r, h, used);
    if (outcome != DIVERGED || !is_small)
        return outcome;
    if (!r->is_turning)
        guess_stages(r, h, false);
    outcome = solve_stages_whole(r, h, used);
    r->is_turning = true;
    return outcome;
}

/* A first step may start on the very edge of a stiff region, as where a contact ends. Then a
 * Jacobian from the other side makes Newton's corrections small whatever the residual of the
 * stages, and the error too. So the stages have to converge with the Jacobian at the step's end. */
static StepOutcome confirm_stages(Radau *r, double h, int *used)
{
    const double end = r->base.before + h;
    StepOutcome outcome = CONVERGED;

    for (int round = 0; round < 2 && outcome == CONVERGED; round++) {
        const double *rate = r->f + 2 * r->all; /* of the last stage, which is the step's end */

        if (!evaluate_stages(r, h))
            return UNDEFINED;
        memcpy(r->column, rate, (size_t)r->all * sizeof(double));
        if (!shifted_differentiate(r->shifted, end, r->point, r->column) || !factor(r, h))
            return UNDEFINED;
        correct_stages(r, h);
        if (scaled_norm(r, r->delta, 3) <= 1)
            return CONVERGED;
        guess_stages(r, h, false);
        outcome = solve_stages(r, h, used);
    }
    return outcome == CONVERGED ? DIVERGED : outcome;
}

/* Residual of the embedded formula, into error (n): rate + (1/h) sum_k e_k z_k. rate (n): a value
 * of y' where the step starts. Units of y'. */
static void compare_embedded(Radau *r, const double *rate, double h)
{
    for (int i = 0; i < r->n; i++) {
        double sum = 0;

        for (int k = 0; k < 3; k++)
            sum += embedded[k] * r->z[k * r->all + i];
        r->error[i] = rate[i] + sum / h;
    }
}

/* error of the embedded formula, in units of the tolerance */
static double step_error(Radau *r, double h)
{
    double size;

    for (int pass = 0; pass < 2; pass++) {
        /* A second estimate where the first is too large at a start and the step is almost 0: fast
         * transients that have not decayed, or rounding error. It assumes that all stiff components
         * decay, which a mass in a hard wall doesn't, so longer steps are shortened instead. */
        const double *rate = pass == 0 ? r->old_rate : r->column;

        compare_embedded(r, rate, h);
        shifted_solve(r->shifted, r->error);
        size = scaled_norm(r, r->error, 1);
        if (size < 1 || !(r->was_rejected || r->step == 0) || pass == 1 ||
            h > RADAU_UNRESOLVED * r->base.control.span)
            break;
        memcpy(r->point, r->old, (size_t)r->all * sizeof(double));
        for (int i = 0; i < r->n; i++)
            r->point[i] += r->error[i];
        if (!stepper_rate(&r->base, r->base.before, r->point, r->column))
            break;
    }
    return fmax(size / stepper_rounding_error(&r->base), 1e-10);
}

/* The same with J_3: where stiff forces change direction, J at the start filters out components
 * that aren't stiff at the end. */
static double error_at_end(Radau *r, double h)
{
    const int n = r->n;
    double *a;

    if (!r->is_turning)
        return 0;
    a = lu_matrix(r->end);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            a[i * n + j] = (i == j ? EIGENVALUE / h : 0) -
                           r->jacobians[(ptrdiff_t)2 * r->all * n + (ptrdiff_t)i * n + j];
    if (!lu_factor(r->end))
        return HUGE_VAL;
    compare_embedded(r, r->old_rate, h);
    lu_solve(r->end, r->error);
    return scaled_norm(r, r->error, 1) / stepper_rounding_error(&r->base);
}

/* Error of the cubic through the start of the step and its stages, in units of the tolerance. The
 * embedded formula hardly detects stiff components, which are accurate at the stages for any step.
 * Between these the error of the cubic is y(4)/24 s (s - c1) (s - c2) (s - 1) h^4, and y(4) is the
 * difference of the slopes of two cubics where they meet. */
static double reading_error(Radau *r, double h)
{
    const double meet = ENDS * r->step * r->step * r->step + BEGINS * h * h * h;

    if (r->step == 0) {
        memset(r->fourth, 0, (size_t)r->n * sizeof(double));
        return 0;
    }
    compare_embedded(r, r->slope, h);
    for (int i = 0; i < r->n; i++) {
        r->fourth[i] = -r->error[i] / meet;
        r->error[i] = r->fourth[i] * BETWEEN * h * h * h * h;
    }
    return scaled_norm(r, r->error, 1) / stepper_rounding_error(&r->base);
}

/* slope of the cubic at the step's end */
static void find_slope(Radau *r, double h)
{
    for (int i = 0; i < r->n; i++) {
        double sum = 0;

        for (int k = 0; k < 3; k++)
            sum += inverse[2][k] * r->z[k * r->all + i];
        r->slope[i] = sum / h;
    }
}

/* project the new point at t, and evaluate its rate */
static bool settle(Radau *r, double t, double h)
{
    const Ode *ode = r->base.ode;

    /* quadratures need the rates at the converged stages */
    if (r->is_linear && r->all > r->n && !evaluate_stages(r, h))
        return false;
    for (int i = 0; i < r->all; i++)
        r->point[i] = r->old[i] + r->z[2 * r->all + i];
    for (int i = r->n; i < r->all; i++) { /* quadratures, by the weights of the last stage */
        double sum = 0;

        for (int k = 0; k < 3; k++)
            sum += weights[2][k] * r->f[k * r->all + i];
        r->point[i] = r->old[i] + h * sum;
    }
    if (ode->project != NULL && !ode->project(ode->context, t, r->point))
        return false;
    if (!stepper_rate(&r->base, t, r->point, r->rate))
        return false;
    memcpy(r->base.y, r->point, (size_t)r->all * sizeof(double));
    r->base.t = t;
    r->step = h;
    find_slope(r, h);
    return true;
}

/* --- steps --- */

static double first_step(const Radau *r, double span)
{
    double slope = scaled_norm(r, r->rate, 1), size = scaled_norm(r, r->old, 1);
    double h = slope > 1e-5 && size > 1e-5 ? 1e-2 * fmax(size, 1) / slope : 1e-6;

    return fmin(h, span);
}

static double trim(const Radau *r, double h, double end)
{
    double left = end - r->base.before;

    h = stepper_allowed(&r->base, fmin(h, control_largest(&r->base.control)));
    if (h >= left || left - h < 1e-10 * h)
        return left;
    return h > 0.5 * left ? 0.5 * left : h;
}

/* One trial step; false: continue with the shorter step *h. */
static bool try_step(Radau *r, double *h, double end, int *failures)
{
    double tried = trim(r, *h, end);
    double t = tried == end - r->base.before ? end : r->base.before + tried;
    double error, factor_of;
    int used = 0;
    StepOutcome outcome = UNDEFINED;

    stepper_begin(&r->base, r->base.before, r->old, tried);
    if ((r->fresh || find_jacobian(r)) && (r->factored == tried || factor(r, tried)))
        outcome = find_stages(r, tried, &used);
    if (outcome == CONVERGED && r->step == 0 && !r->is_linear)
        outcome = confirm_stages(r, tried, &used);
    if (outcome != CONVERGED) {
        r->fresh = r->fresh && (r->step > 0 || r->is_linear);
        *failures += outcome == UNDEFINED;
        *h = (outcome == UNDEFINED ? RETREAT : 0.5) * tried;
        return false;
    }
    error = fmax(fmax(step_error(r, tried), error_at_end(r, tried)),
                 reading_error(r, tried) / RADAU_DENSE);
    factor_of = RADAU_SAFETY * (2.0 * RADAU_ITERATIONS + 1) / (2.0 * RADAU_ITERATIONS + used) *
                pow(error, -0.25);
    factor_of = fmin(r->was_rejected ? 1 : RADAU_GROW, fmax(RADAU_SHRINK, factor_of));
    if (!(error < 1)) {
        *h = tried * fmin(0.9, factor_of);
        return false;
    }
    if (!settle(r, t, tried)) {
        *failures += 1;
        *h = RETREAT * tried;
        return false;
    }
    /* factors are reused where the step hardly changes */
    if (factor_of > 1 && factor_of < 1.2)
        factor_of = 1;
    r->base.next = tried * factor_of;
    if (tried < *h)
        r->base.next = fmax(r->base.next, fmin(*h, tried * RADAU_GROW));
    return true;
}

static Status step(Stepper *stepper, double end, Diag *diag)
{
    Radau *r = (Radau *)stepper;
    int failures = 0;
    double h = r->base.next;
    bool keep = r->is_linear || (r->factored > 0 && r->contraction < RADAU_REUSE);

    if (r->base.next > 0)
        guess_stages(r, trim(r, h, end + r->base.before - r->base.t), true);
    memcpy(r->old, r->base.y, (size_t)r->all * sizeof(double));
    memcpy(r->old_rate, r->rate, (size_t)r->all * sizeof(double));
    r->base.before = r->base.t;
    choose_scale(r);
    if (!(h > 0)) {
        h = first_step(r, end - r->base.t);
        guess_stages(r, h, false);
    }
    r->fresh = keep;
    while (!try_step(r, &h, end, &failures)) {
        r->base.counts.rejected++;
        r->was_rejected = true;
        if (keep && !r->is_linear) /* perhaps the old Jacobian was the cause */
            r->fresh = keep = false;
        if (failures >= MAX_REJECTIONS)
            return solver_failure(diag, r->base.before,
                                  "the equations have no solution just behind this instant (ten "
                                  "ever shorter steps failed)");
        if (!(h > 4e-16 * fabs(r->base.before)))
            return solver_failure(diag, r->base.before, "the step became too small");
        guess_stages(r, h, false);
    }
    r->was_rejected = false;
    r->base.counts.steps++;
    return OK;
}

/* the cubic through the start of the step and its three stages, the last of them projected, and its
 * error by y(4) */
static void at(Stepper *stepper, double t, double *y)
{
    Radau *r = (Radau *)stepper;
    double s = r->step > 0 ? (t - r->base.before) / r->step : 1;
    double basis[3], quartic;

    if (r->step == 0 || t == r->base.t) {
        memcpy(y, r->base.y, (size_t)r->all * sizeof(double));
        return;
    }
    for (int k = 0; k < 3; k++) {
        basis[k] = s / nodes[k];
        for (int l = 0; l < 3; l++)
            if (l != k)
                basis[k] *= (s - nodes[l]) / (nodes[k] - nodes[l]);
    }
    quartic = s * (s - nodes[0]) * (s - nodes[1]) * (s - 1) * pow(r->step, 4);
    for (int i = 0; i < r->n; i++)
        y[i] = r->old[i] + basis[0] * r->z[i] + basis[1] * r->z[r->all + i] +
               basis[2] * (r->base.y[i] - r->old[i]) + quartic * r->fourth[i];
    for (int i = r->n; i < r->all; i++) { /* quadratures have no stages */
        double dy = r->base.y[i] - r->old[i], h = r->step;

        y[i] = r->old[i] + s * dy +
               s * (s - 1) * ((1 - 2 * s) * dy + (s - 1) * h * r->old_rate[i] + s * h * r->rate[i]);
    }
}

/* initial guess of the stages of a step h in place of the last one, by its polynomial */
static void guess_shorter(Radau *r, double h)
{
    for (int k = 0; k < 3; k++)
        r->base.method->at(&r->base, r->base.before + nodes[k] * h, r->f + k * r->all);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < r->all; i++)
            r->z[k * r->all + i] = r->f[k * r->all + i] - r->old[i];
}

static Status shorten(Stepper *stepper, double t, Diag *diag)
{
    Radau *r = (Radau *)stepper;
    size_t bytes = (size_t)r->all * sizeof(double);
    double h = t - r->base.before;
    double *stages, *rate;
    int used;
    Status status = OK;

    if (h <= 0) { /* return to the start of the step */
        r->base.t = r->base.before;
        memcpy(r->base.y, r->old, (size_t)r->all * sizeof(double));
        memcpy(r->rate, r->old_rate, (size_t)r->all * sizeof(double));
        r->step = 0;
        return OK;
    }
    stages = NEW_ARRAY(double, 3 * r->all);
    rate = NEW_ARRAY(double, r->all);
    memcpy(stages, r->z, 3 * bytes);
    memcpy(rate, r->rate, bytes);
    guess_shorter(r, h);
    stepper_begin(&r->base, r->base.before, r->old, h);
    if (!(stepper_rate(&r->base, r->base.before, r->old, r->rate) &&
          (r->is_linear || find_jacobian(r)) && factor(r, h) &&
          solve_stages(r, h, &used) == CONVERGED && settle(r, t, h))) {
        status = solver_failure(diag, t, "the equations have no solution at a switch");
        memcpy(r->z, stages, 3 * bytes);
        memcpy(r->rate, rate, bytes);
    }
    MEM_FREE(stages, rate);
    return status;
}

static bool slope(Stepper *stepper, double *rate)
{
    const Radau *r = (const Radau *)stepper;

    memcpy(rate, r->rate, (size_t)r->all * sizeof(double));
    return true;
}

const Method method_radau = {
    .name = "radau",
    .brief =
        "implicit Runge-Kutta of order 5 (Radau IIA), for stiff equations; projects after each "
        "step",
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .at = at,
    .shorten = shorten,
    .slope = slope,
    .nodes = nodes,
    .node_count = COUNT(nodes),
    .sees_little = true,
    .pulse_steps = 16,
    .suits_stiff = true,
    .is_a_stable = true,
};
