/* motion.c: accelerations, multipliers and network rates from the equations; projection
 *
 * Solves [M Phi_u^T; Phi_u 0] [u'; lambda] = [F; gamma] (nu + rows in use). The last factorisation
 * is kept with the t and q that it belongs to: after a projection that ends at q, the first
 * evaluation there uses it. */
#include "simulate/equations/motion_impl.h"

#include "algebra/linear.h"
#include "algebra/rank.h"
#include "base/memory.h"
#include "simulate/equations/equations_limits.h"

#include <math.h>
#include <string.h>

#define REFERENCE_ERROR_FLOOR                                                                      \
    0.03 /* rad: largest difference of an angle and its reference after a step */

static bool rate(void *context, double t, const double *y, double *out);
static bool project(void *context, double t, double *y);
static void begin(void *context, double t, const double *y, double h);
static double rounding_error(void *context);

static void open_projection(Motion *mo)
{
    const int nu = mo->eq->nu;
    int *place = NEW_ARRAY(int, nu);

    mo->unit = NEW_ARRAY(double, nu);
    for (int i = 0; i < nu; i++) {
        place[i] = i;
        mo->unit[i] = 1;
    }
    mo->unit_places = pattern_of(nu, nu, nu, place, place, place);
    mo->nearest_kkt = kkt_new(&mo->unit_places, mo->eq->rows, mo->rows, mo->used);
    mem_free(place);
}

static void set_projection(Motion *mo)
{
    const Equations *eq = mo->eq;
    const bool projects =
        mo->used > 0 || eq->quaternion_count > 0 || eq->multi_turn_count > 0 || eq->slide_count > 0;

    mo->ode.project = projects ? project : NULL;
}

/* A direction turns the faster the smaller its vector is. */
static bool has_norms(const Equations *eq)
{
    for (int i = 0; i < eq->switch_count; i++) {
        const Guard guard = equations_guard(eq, i);

        if (guard.is_norm && guard.end == 0 && !guard.is_idle)
            return true;
    }
    return false;
}

void motion_enter_mode(Motion *mo)
{
    set_projection(mo);
    mo->ode.stiffness_falls = has_norms(mo->eq);
    if (mo->eq->slide_count > 0)
        signs_begin(mo->signs, mo->eq->slide_count, mo->eq->sign_ranges);
}

static void describe_ode(Motion *mo)
{
    const Equations *eq = mo->eq;

    mo->ode = (Ode){.n = multi_turn_place(eq) + eq->multi_turn_count,
                    .is_network = eq->n == 0 && eq->nu == 0,
                    .quadratures = 1,
                    .context = mo,
                    .rate = rate,
                    .begin = mo->used > 0 ? begin : NULL,
                    .rounding_error = mo->used > 0 ? rounding_error : NULL,
                    .magnitude_bound = eq->magnitude_bound,
                    .unit = eq->unit};
    set_projection(mo);
    mo->error_floor = NEW_ARRAY(double, mo->ode.n);
    for (int k = 0; k < eq->multi_turn_count; k++)
        mo->error_floor[multi_turn_place(eq) + k] = REFERENCE_ERROR_FLOOR;
    if (eq->multi_turn_count > 0)
        mo->ode.error_floor = mo->error_floor;
    motion_open_implicit(mo);
}

Motion *motion_new(const Equations *eq, const MotionOptions *options)
{
    Motion *mo = NEW(Motion);

    mo->eq = eq;
    mo->options = *options;
    mo->used = options->row_count;
    mo->rows = NEW_ARRAY(int, mo->used);
    for (int k = 0; k < mo->used; k++)
        mo->rows[k] = options->rows[k];
    mo->wanted = NEW_ARRAY(int, options->independent_count);
    for (int k = 0; k < options->independent_count; k++)
        mo->wanted[k] = options->independent[k];
    mo->options.rows = mo->rows;
    mo->options.independent = mo->wanted;
    mo->low = -INFINITY;
    mo->high = INFINITY;
    mo->kkt = kkt_new(eq->masses, eq->rows, mo->rows, mo->used);
    kkt_set_watch(mo->kkt, options->watch);
    if (options->embedded) {
        mo->partitioning = partitioning_new(eq->nu, mo->used);
        mo->full_mass = NEW_ARRAY(double, eq->nu * eq->nu);
        mo->full_phi_u = NEW_ARRAY(double, eq->m * eq->nu);
    }
    mo->network = netsolve_new(eq);
    mo->solved = netsolve_values(mo->network);
    mo->solved_before = NEW_ARRAY(double, eq->nx + eq->nz);
    if (eq->network_reads != NULL) {
        mo->together = anderson_new(eq->nx + eq->nz);
        mo->solved_size = NEW_ARRAY(double, eq->nx + eq->nz);
        mo->turn_size = NEW_ARRAY(double, eq->nx + eq->nz);
    }
    mo->q = NEW_ARRAY(double, eq->n);
    mo->references = NEW_ARRAY(double, eq->multi_turn_count);
    mo->top = NEW_ARRAY(double, eq->nu);
    mo->bottom = NEW_ARRAY(double, mo->used);
    mo->du = NEW_ARRAY(double, eq->nu);
    mo->kept = NEW_ARRAY(double, eq->nu);
    mo->lambda = NEW_ARRAY(double, mo->used);
    mo->nearest = NEW_ARRAY(double, motion_length(mo));
    mo->lambda_all = NEW_ARRAY(double, eq->m);
    mo->row_size = NEW_ARRAY(double, eq->m);
    mo->row_part = NEW_ARRAY(double, eq->m);
    mo->counts.singular_time = NAN;
    mo->began = NAN;
    mo->by_groups = mo->by_all = (Trend){.at = NAN, .before_at = NAN};
    if (mo->used > 0)
        open_projection(mo);
    if (eq->sign_count > 0)
        motion_open_surfaces(mo);
    describe_ode(mo);
    motion_enter_mode(mo);
    return mo;
}

void motion_free(Motion *mo)
{
    if (mo == NULL)
        return;
    MEM_FREE(mo->rows, mo->wanted);
    kkt_free(mo->kkt);
    kkt_free(mo->nearest_kkt);
    pattern_free(&mo->unit_places);
    mem_free(mo->unit);
    partitioning_free(mo->partitioning);
    MEM_FREE(mo->full_mass, mo->full_phi_u);
    netsolve_free(mo->network);
    anderson_free(mo->together);
    signs_free(mo->signs);
    MEM_FREE(mo->slip, mo->off, mo->way, mo->bounds, mo->solved_before, mo->solved_size,
             mo->turn_size, mo->q, mo->references, mo->error_floor, mo->top, mo->bottom, mo->du,
             mo->kept, mo->lambda, mo->nearest, mo->lambda_all, mo->row_size, mo->row_part,
             mo->dae_weight, mo->is_tested, mo->slopes, mo);
}

const Ode *motion_ode(const Motion *mo)
{
    return &mo->ode;
}

void motion_window(Motion *mo, double low, double high)
{
    mo->low = low;
    mo->high = high;
}

const int *motion_rows(const Motion *mo, int *count)
{
    *count = mo->used;
    return mo->rows;
}

void motion_rows_in_use(const Motion *mo, bool *out)
{
    memset(out, 0, (size_t)mo->eq->m * sizeof *out);
    for (int k = 0; k < mo->used; k++)
        out[mo->rows[k]] = true;
}

void motion_guess(Motion *mo, const double *network)
{
    if (mo->eq->nx + mo->eq->nz > 0)
        memcpy(netsolve_values(mo->network), network,
               (size_t)(mo->eq->nx + mo->eq->nz) * sizeof(double));
}

void motion_offer_jacobian(Motion *mo, OdeJacobian jacobian)
{
    mo->ode.jacobian = jacobian;
}

void motion_tolerance(Motion *mo, double tolerance)
{
    mo->options.tolerance = tolerance;
}

void motion_set_drifting(Motion *mo, bool drifts)
{
    mo->drifts = drifts;
}

MotionCounts motion_counts(const Motion *mo)
{
    return mo->counts;
}

const double *motion_network(Motion *mo, double t, const double *y)
{
    bool is_there = mo->is_evaluated && mo->t == motion_clock(mo, t) &&
                    vector_is_finite(mo->solved, mo->eq->nx + mo->eq->nz);

    return is_there || motion_evaluate_all(mo, t, y) ? mo->solved : NULL;
}

void motion_switches(Motion *mo, double t, const double *y, double *out)
{
    const Equations *eq = mo->eq;

    if (eq->switches_read_network &&
        !(eq->slide_count > 0 ? motion_find_signs(mo, t, y) : motion_find_network(mo, t, y))) {
        for (int i = 0; i < eq->switch_count; i++)
            out[i] = NAN;
        return;
    }
    if (eq->multi_turn_count > 0)
        eq->take_references(eq->context, y + multi_turn_place(eq));
    eq->switches(eq->context, t, y, y + eq->n, y + eq->n + eq->nu, out);
}

/* Residuals are measured as distances: a row over the largest entry that it has had in Phi_u at
 * starts of steps. */
static void measure_rows(Motion *mo)
{
    for (int k = 0; k < mo->eq->m; k++) {
        const double largest = pattern_largest(mo->eq->rows, mo->eq->phi_u, k);

        mo->row_size[k] = fmax(mo->row_size[k], fmax(largest, MOTION_LEAST_ROW));
        mo->row_part[k] = 1 / mo->row_size[k];
    }
}

/* The next step starts at another time than the last one. */
static void close_trend(Trend *trend)
{
    trend->before = trend->now;
    trend->before_at = trend->at;
    trend->at = NAN;
}

/* The least independence up to t + h, extrapolated linearly from the step before. Where it was not
 * computed there, the fraction `part` that another measure predicts is used (NAN: not known). */
static double follow_trend(Trend *trend, double t, double h, double now, double part)
{
    trend->now = now;
    trend->at = t;
    if (trend->before_at < t)
        return fmin(now, now + h * (now - trend->before) / (t - trend->before_at));
    return part < 1 ? part * now : now;
}

/* Rows that are always independent need no check of their independence. Their sizes are measured
 * where the state is projected. */
static void start_determined(Motion *mo, double t, double h)
{
    mo->began = t;
    mo->ends = t + h;
    mo->is_far = true;
    mo->is_projecting = false;
}

/* Off the manifold the constraints are slightly inconsistent, and near a singular position the
 * accelerations that satisfy them grow without bound. There the accelerations are those of the
 * nearest state on the manifold. The two vector fields agree only on the manifold: a step that took
 * some stages from one and some from the other would have no order. So the choice is made at the
 * start of a step, by the independence of the rows there and by its extrapolation to the end of the
 * step. */
static void begin(void *context, double t, const double *y, double h)
{
    Motion *mo = context;
    double by_groups, by_all = 0;

    if (motion_rows_are_fixed(mo)) {
        start_determined(mo, t, h);
        return;
    }
    if (t != mo->began) {
        close_trend(&mo->by_groups);
        close_trend(&mo->by_all);
        kkt_store_sizes(mo->kkt);
    } else {
        kkt_return_sizes(mo->kkt);
    }
    mo->began = t;
    mo->ends = t + h;
    mo->is_far = false;
    motion_at_position(mo, motion_clock(mo, t), y);
    measure_rows(mo);
    by_groups = follow_trend(&mo->by_groups, t, h,
                             kkt_independence_of_groups(mo->kkt, mo->eq->phi_u, mo->rows), NAN);
    if (by_groups < MOTION_NEAR)
        by_all = follow_trend(&mo->by_all, t, h, kkt_independence(mo->kkt, mo->eq->phi_u, mo->rows),
                              by_groups / mo->by_groups.now);
    mo->is_projecting = fmax(by_groups, by_all) < MOTION_NEAR;
    if (mo->is_projecting) /* no factors may be used then */
        mo->rounding_error = fmax(mo->rounding_error, kkt_rounding_error_at(mo->by_all.now));
    mo->is_far = fmax(by_groups, by_all) > MOTION_FAR;
}

static bool solve_on_manifold(Motion *mo, double t, const double *y)
{
    if (mo->is_projecting) {
        memcpy(mo->nearest, y, (size_t)motion_length(mo) * sizeof(double));
        if (!motion_project(mo, t, mo->nearest))
            return false;
        y = mo->nearest;
    }
    return motion_evaluate_all(mo, t, y) && motion_solve_rates(mo);
}

/* Small models spend most evaluations here; anything else would be overhead. */
static bool rate_outright(Motion *mo, double t, const double *y, double *out)
{
    const Equations *eq = mo->eq;

    if (eq->outright == NULL || eq->slide_count > 0 || mo->partitioning != NULL ||
        (mo->used > 0 && !motion_rows_are_fixed(mo)))
        return false;
    mo->is_evaluated = mo->is_evaluated && eq->is_outright_apart;
    if (!eq->outright(eq->context, motion_clock(mo, t), y, out))
        return false;
    mo->counts.factorisations++;
    return true;
}

static bool rate(void *context, double t, const double *y, double *out)
{
    Motion *mo = context;

    if (rate_outright(mo, t, y, out))
        return vector_is_finite(out, mo->ode.n);
    if (!solve_on_manifold(mo, t, y))
        return false;
    motion_bring_power(mo, mo->du);
    motion_write_rates(mo, out);
    return vector_is_finite(out, mo->ode.n);
}

/* from rows that are independent at y */
static bool solve_row(Motion *mo, double t, const double *y)
{
    int *kept;
    bool sound;

    motion_at_position(mo, motion_clock(mo, t), y);
    kept = motion_set_rows(mo);
    sound = motion_evaluate_all(mo, t, y) && motion_solve_plain(mo);
    if (sound)
        motion_spread_multipliers(mo);
    motion_return_rows(mo, kept);
    return sound;
}

bool motion_solve(Motion *mo, double t, const double *y, Solved *out)
{
    if (!solve_row(mo, t, y))
        return false;
    return motion_report(mo, out);
}

/* --- projection --- */

static double distance(const Motion *mo)
{
    const double *phi = mo->eq->phi, *part = mo->row_part;
    const int *rows = mo->rows;
    double largest = 0;

    for (int k = 0; k < mo->used; k++) {
        const double size = fabs(phi[rows[k]]) * part[rows[k]];

        if (!(size <= largest))
            largest = size;
    }
    return largest;
}

void equations_turn(const Equations *eq, double t, const double *q, double *a)
{
    if (eq->multi_turn_count == 0)
        return;
    eq->take_references(eq->context, a);
    eq->position(eq->context, t, q);
    memcpy(a, eq->multi_turn, (size_t)eq->multi_turn_count * sizeof(double));
}

void equations_normalise(const Equations *eq, double *q)
{
    for (int i = 0; i < eq->quaternion_count; i++) {
        double *p = q + eq->quaternions[i];
        double norm = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);

        for (int j = 0; j < 4 && norm > 0; j++)
            p[j] /= norm;
    }
}

static void move(Motion *mo, const double *du, double *q)
{
    const Equations *eq = mo->eq;

    for (int i = 0; i < eq->n; i++)
        q[i] += eq->map == NULL ? du[i] : pattern_dot(eq->maps, eq->map, i, du);
    equations_normalise(eq, q);
}

/* Phi_u du = bottom where Phi_u is a permutation except for signs: prescribed speeds */
static void take_prescribed(Motion *mo)
{
    memset(mo->du, 0, (size_t)mo->eq->nu * sizeof(double));
    for (int k = 0; k < mo->used; k++)
        pattern_add(mo->eq->rows, mo->eq->phi_u, mo->rows[k], mo->bottom[k], mo->du);
}

/* The residual of a row with a single speed, as of a driver, corrects that speed alone. A
 * correction weighted by masses would spread it over other speeds, although the drift of a
 * prescribed speed has nothing to do with them. Returns whether there are such rows. */
static bool take_single_rows(Motion *mo)
{
    const Pattern *rows = mo->eq->rows;
    bool found = false;

    memset(mo->du, 0, (size_t)mo->eq->nu * sizeof(double));
    for (int k = 0; k < mo->used; k++) {
        const int place = rows->start[mo->rows[k]];

        if (rows->start[mo->rows[k] + 1] != place + 1 || mo->bottom[k] == 0)
            continue;
        mo->du[rows->row[place]] = mo->bottom[k] / mo->eq->phi_u[place];
        found = true;
    }
    return found;
}

static void take_missed_positions(Motion *mo)
{
    for (int k = 0; k < mo->used; k++)
        mo->bottom[k] = -mo->eq->phi[mo->rows[k]];
}

/* Whether a position is projected with the eliminated equations, which lead to the nearest position
 * in the norm of M. Where elimination is sound no singular position is near (kkt_is_sound()), and
 * for the residual of one step this norm is as good. Drift over many steps is as large as the error
 * test allows, and is projected in the norm of the error test: in the norm of M, which depends on
 * units, a rotating pendulum had two to four times the error. All stages of a projected step use
 * one norm. */
static bool moves_by_masses(Motion *mo)
{
    return !mo->is_projecting && !mo->drifts && motion_is_eliminated(mo);
}

/* Phi_u du = -Phi. */
static void find_move(Motion *mo, bool by_masses)
{
    take_missed_positions(mo);
    if (motion_is_prescribed(mo))
        take_prescribed(mo);
    else if (by_masses)
        mo->eq->eliminated->step(mo->eq->context, mo->bottom, mo->du);
    else
        kkt_correct(mo->nearest_kkt, mo->bottom, mo->du);
}

/* Near a singular position the nearest position is that in the norm of the error test, not of M:
 * when the residual is rounding error, a light crank at its dead centre would move far to spare a
 * heavy rocker some 1e-16 rad.
 *
 * Simplified Newton: one factorisation serves all sweeps. They continue to the limit of rounding,
 * and near a singular position to the last bit, because a residual there turns the motion off its
 * branch. Where the sweeps don't get there, at most a hundredth of the run's tolerance may
 * remain. */
static bool project_position(Motion *mo, double t, double *y)
{
    bool by_masses;
    double size = fmax(1, vector_largest(y, mo->eq->n));
    double enough = fmax(1e-13 * size, fmin(1e-2 * mo->options.tolerance, 1e-9));
    double left, before = INFINITY;

    equations_normalise(mo->eq, y);
    motion_at_position(mo, t, y);
    if (!motion_is_in_step(mo) || motion_rows_are_fixed(mo))
        measure_rows(mo);
    left = distance(mo);
    if (left <= 1e-16 * size)
        return true;
    by_masses = !motion_is_prescribed(mo) && moves_by_masses(mo);
    if (!motion_is_prescribed(mo) && !by_masses &&
        !motion_factor_with(mo, mo->nearest_kkt, mo->unit))
        return false;
    take_missed_positions(mo);
    if (by_masses && take_single_rows(mo)) {
        move(mo, mo->du, y);
        motion_at_position(mo, t, y);
        left = distance(mo);
    }
    for (int sweep = 0; sweep < PROJECTION_SWEEPS && left > (by_masses ? 1e-15 : 1e-16) * size;
         sweep++) {
        if (left <= 1e-13 * size && left > 0.5 * before)
            break; /* rounding error */
        before = left;
        find_move(mo, by_masses);
        move(mo, mo->du, y);
        motion_at_position(mo, t, y); /* the factors remain those of the first sweep */
        left = distance(mo);
        if (!isfinite(left))
            break;
    }
    return left <= enough;
}

static void take_missed_speeds(Motion *mo, const double *u)
{
    const Equations *eq = mo->eq;

    for (int k = 0; k < mo->used; k++)
        mo->bottom[k] = eq->nu_rate[mo->rows[k]] - pattern_dot(eq->rows, eq->phi_u, mo->rows[k], u);
}

static void add_speeds(const Motion *mo, double *u)
{
    for (int j = 0; j < mo->eq->nu; j++)
        u[j] += mo->du[j];
}

/* bring nu up to date; positions already are */
static void bring_nu(const Equations *eq, const double *u, const double *x)
{
    if (!eq->has_nu_early)
        eq->velocity(eq->context, u, x);
}

static bool project_velocity(Motion *mo, double t, const double *y, double *u, const double *x)
{
    const Equations *eq = mo->eq;
    bool has_own;

    motion_at_position(mo, t, y);
    has_own = motion_is_prescribed(mo) || motion_is_eliminated(mo);
    if (!has_own && !motion_factor(mo))
        return false;
    bring_nu(eq, u, x);
    take_missed_speeds(mo, u);
    if (motion_is_eliminated(mo) && take_single_rows(mo)) {
        add_speeds(mo, u);
        take_missed_speeds(mo, u);
    }
    if (motion_is_prescribed(mo))
        take_prescribed(mo);
    else if (has_own)
        eq->eliminated->step(eq->context, mo->bottom, mo->du);
    else
        kkt_correct(mo->kkt, mo->bottom, mo->du);
    add_speeds(mo, u);
    return vector_is_finite(u, eq->nu);
}

/* Rows in use may have become dependent at the end of a step: the rows that replace them constrain
 * y too. */
static bool project_both(Motion *mo, double t, double *y)
{
    const Equations *eq = mo->eq;
    int *kept;
    bool sound;

    if (!project_position(mo, t, y))
        return false;
    motion_at_position(mo, t, y);
    kept = motion_set_rows(mo);
    sound = (mo->used == eq->m || project_position(mo, t, y)) &&
            project_velocity(mo, t, y, y + eq->n, y + eq->n + eq->nu);
    motion_return_rows(mo, kept);
    return sound;
}

bool motion_project(Motion *mo, double t, double *y)
{
    const Equations *eq = mo->eq;

    if (mo->ode.project == NULL)
        return true;
    t = fmin(fmax(t, mo->low), mo->high);
    if (mo->used == 0 && eq->quaternion_count == 0)
        motion_at_position(mo, t, y);
    else if (!project_both(mo, t, y))
        return false;
    if (eq->slide_count > 0 && !motion_project_surfaces(mo, t, y))
        return false;
    if (eq->multi_turn_count > 0)
        memcpy(y + multi_turn_place(eq), eq->multi_turn,
               (size_t)eq->multi_turn_count * sizeof(double));
    return true;
}

static double rounding_error(void *context)
{
    Motion *mo = context;
    const double largest = mo->rounding_error;

    mo->rounding_error = 0;
    return largest;
}

static bool project(void *context, double t, double *y)
{
    return motion_project(context, t, y);
}

void motion_residuals(Motion *mo, double t, const double *y, double *position, double *velocity)
{
    const Equations *eq = mo->eq;

    *position = *velocity = 0;
    if (eq->m == 0)
        return;
    motion_at_position(mo, t, y);
    bring_nu(eq, y + eq->n, y + eq->n + eq->nu);
    *position = vector_largest(eq->phi, eq->m);
    for (int k = 0; k < eq->m; k++) {
        double left = fabs(pattern_dot(eq->rows, eq->phi_u, k, y + eq->n) - eq->nu_rate[k]);

        if (!(left <= *velocity))
            *velocity = left;
    }
}
