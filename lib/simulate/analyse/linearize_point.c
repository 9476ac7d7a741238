/* linearize_point.c: the point of linearisation, and bounds of the errors of its numbers
 *
 * Given coordinates are accurate to half a unit in their last place. The error of dependent ones,
 * and of the unknowns that all of them determine, is bounded by the residuals of their
 * equations. */
#include "simulate/analyse/linearize_impl.h"

#include "algebra/rank.h"
#include "base/memory.h"
#include "base/random.h"
#include "simulate/analyse/analyse_limits.h"
#include "simulate/equations/failure_diagnosis.h"

#include <string.h>

enum { MOST_STEPS = 8 }; /* of Newton's method; linear equations take two */

/* --- equations in use --- */

int linear_equation(const Work *w, int r)
{
    const VariableIndex *l = w->l;

    if (r < l->nu)
        return w->rows.balance + r;
    if (r < l->nu + w->speeds.used)
        return w->rows.acceleration + w->speeds.rows[r - l->nu];
    return w->rows.network + r - l->nu - w->speeds.used;
}

int linear_unknown(const Work *w, int k)
{
    const VariableIndex *l = w->l;

    if (k < l->nu)
        return w->at.acceleration + k;
    if (k < l->nu + w->speeds.used)
        return w->at.multipliers + w->speeds.rows[k - l->nu];
    k -= l->nu + w->speeds.used;
    return k < l->nx ? w->at.rates + k : w->at.z + k - l->nx;
}

static RowValues row_with(const Work *w, double t, const double *y, const double *follow)
{
    const VariableIndex *l = w->l;
    RowValues row = row_of_state(l, t, y);

    row.acceleration = follow;
    row.multipliers = follow + l->nu;
    row.rates = follow + l->nu + l->m;
    row.z = follow + l->nu + l->m + l->nx;
    return row;
}

double linear_moved(const Work *w, int r, int column, double value)
{
    uint64_t seed = w->perturbation + (uint64_t)r * 0xD1B54A32D192ED03U + (uint64_t)column;

    return w->perturbation == 0 || value == 0
               ? value
               : value * (1 + LINEAR_PERTURBATION * random_unit(&seed));
}

/* Copy E_e from the tangents. Returns whether it has changed. */
static bool fill_matrix(const Work *w)
{
    const int n = w->unknowns;
    bool is_new = false;

    for (int first = 0; first < n; first += TANGENT_BATCH) {
        const int count = n - first < TANGENT_BATCH ? n - first : TANGENT_BATCH;

        tangents_clear(w->along);
        for (int lane = 0; lane < count; lane++)
            linear_move(w, lane, linear_unknown(w, first + lane), (LinearNumber){1, 0});
        tangents_run(w->along);
        for (int r = 0; r < n; r++)
            for (int lane = 0; lane < count; lane++) {
                const LinearNumber entry = linear_slope(w, linear_equation(w, r), lane);
                const int at = r * n + first + lane;
                const double value =
                    linear_moved(w, r, linear_unknown(w, first + lane), entry.value);

                is_new = is_new || !(w->matrix[at] == value);
                w->matrix[at] = value;
                w->matrix_error[at] = entry.error;
            }
    }
    return is_new;
}

static void evaluate(Work *w, bool is_bounded)
{
    const RowValues row = row_with(w, w->order->at, w->y, w->follow);
    RowValues off = row_with(w, number_error(w->order->at), w->y_error, w->follow_error);

    off.references = NULL; /* the turn is known exactly */
    if (w->perturbation != 0)
        probe_tangents_perturbed(w->derived, &row, w->perturbation, w->along);
    else
        probe_tangents(w->derived, &row, is_bounded ? &off : NULL, w->along);
    for (int i = 0; i < w->rows.count; i++)
        w->values[i].value = tangents_value(w->along, i, &w->values[i].error);
}

/* --- the unknowns that the state determines --- */

static void factor(Work *w)
{
    verified_solve_free(w->equations);
    w->equations = verified_solve_new(w->matrix, w->matrix_error, w->unknowns);
}

static void residuals(const Work *w, double *right, double *error)
{
    for (int r = 0; r < w->unknowns; r++) {
        const LinearNumber value = w->values[linear_equation(w, r)];

        right[r] = -value.value;
        error[r] = value.error;
    }
}

/* u', lambda, x', z at the point by Newton's method; only F in x' and z may be nonlinear */
static bool find_rates(Work *w)
{
    double *right = NEW_ARRAY(double, w->unknowns), *error = NEW_ARRAY(double, w->unknowns);
    double *step = NEW_ARRAY(double, w->unknowns);
    bool sound = true, moves = true;

    evaluate(w, false);
    for (int i = 0; i < MOST_STEPS && sound && moves; i++) {
        if (fill_matrix(w) || w->equations == NULL)
            factor(w);
        residuals(w, right, error);
        sound = verified_solve_is_regular(w->equations);
        if (sound)
            verified_solve_solution(w->equations, right, NULL, step, NULL);
        moves = false;
        for (int k = 0; k < w->unknowns && sound; k++) {
            double *follow = &w->follow[linear_unknown(w, k) - w->at.acceleration];

            *follow += step[k];
            moves = moves || fabs(step[k]) > 4 * 0x1p-52 * fabs(*follow);
            sound = isfinite(*follow);
        }
        if (sound)
            evaluate(w, false);
    }
    MEM_FREE(right, error, step);
    return sound;
}

/* bound their errors by the residuals of these equations and their errors */
static bool bound_rates(Work *w)
{
    double *right = NEW_ARRAY(double, w->unknowns), *error = NEW_ARRAY(double, w->unknowns);
    double *step = NEW_ARRAY(double, w->unknowns), *off = NEW_ARRAY(double, w->unknowns);
    bool sound;

    factor(w);
    sound = verified_solve_is_regular(w->equations);
    residuals(w, right, error);
    if (sound)
        verified_solve_solution(w->equations, right, error, step, off);
    for (int k = 0; k < w->unknowns && sound; k++)
        w->follow_error[linear_unknown(w, k) - w->at.acceleration] = fabs(step[k]) + off[k];
    MEM_FREE(right, error, step, off);
    return sound;
}

/* --- geometry --- */

/* N' is the derivative of N along q' */
static void turn_map(Work *w)
{
    const VariableIndex *l = w->l;
    const int constraints = l->m * l->nu;

    for (int i = 0; i < l->n; i++) {
        const LinearNumber rate = w->values[w->rows.q_rate + i];

        tangents_move(w->turning, 0, l->q + i, rate.value, rate.error);
    }
    tangents_run(w->turning);
    for (int i = 0; i < l->n * l->nu; i++)
        w->map_rate[i].value = tangents_root(w->turning, constraints + i, 0, &w->map_rate[i].error);
}

/* call after evaluate() */
static void evaluate_geometry(Work *w)
{
    const VariableIndex *l = w->l;
    const int constraints = l->m * l->nu, map = l->n * l->nu;
    const RowValues row = row_of_state(l, w->order->at, w->y);
    RowValues off = row_of_state(l, number_error(w->order->at), w->y_error);

    off.references = NULL;
    if (w->perturbation != 0)
        probe_tangents_perturbed(w->geometry, &row, w->perturbation, w->turning);
    else
        probe_tangents(w->geometry, &row, &off, w->turning);
    for (int i = 0; i < constraints + map; i++) {
        LinearNumber *number = i < constraints ? &w->phi_u[i] : &w->map[i - constraints];

        number->value = tangents_value(w->turning, i, &number->error);
    }
    turn_map(w);
}

/* new: Phi_u without error bounds */
static double *plain_phi_u(const Work *w)
{
    double *phi_u = NEW_ARRAY(double, w->l->m * w->l->nu);

    for (int i = 0; i < w->l->m * w->l->nu; i++)
        phi_u[i] = w->phi_u[i].value;
    return phi_u;
}

/* Choose independent rows: those of the initial state may be dependent here. */
static void choose_rows(Work *w)
{
    const Assembled *start = &w->order->about->result->start;
    const int used = w->speeds.used;
    double *phi_u;

    w->speeds.rows = NEW_ARRAY(int, used);
    memcpy(w->speeds.rows, start->rows, (size_t)used * sizeof(int));
    if (used == w->l->m)
        return;
    evaluate_geometry(w);
    phi_u = plain_phi_u(w);
    (void)rank_choose(phi_u, w->l->m, w->l->nu, used, w->speeds.rows);
    mem_free(phi_u);
}

/* Independent rows of positions: among those in use a velocity row may stand for one of them. */
static Status choose_position_rows(Work *w, const double *phi_u)
{
    Dependence *places = &w->own_places;
    const int count = w->l->position_rows;
    int rank;

    w->places = &w->speeds;
    if (count == w->l->m)
        return OK;
    w->places = places;
    places->rows = NEW_ARRAY(int, count);
    TRY(rank_rows(phi_u, count, w->l->nu, LINEARIZE_RANK, w->order->watch, &rank, places->rows));
    for (int r = 0; r < w->speeds.used; r++)
        places->used += w->speeds.rows[r] < count;
    /* at a singular position the rank of those in use counts */
    if (rank >= places->used)
        places->used = rank;
    else
        (void)rank_choose(phi_u, count, w->l->nu, places->used, places->rows);
    return OK;
}

static bool partition(const Work *w, Dependence *d, const double *phi_u, const int *wanted,
                      int count)
{
    const int nu = w->l->nu;

    d->free = nu - d->used;
    d->is_independent = NEW_ARRAY(bool, nu);
    d->matrix = NEW_ARRAY(double, d->used * d->used);
    d->error = NEW_ARRAY(double, d->used * d->used);
    d->partitioning = partitioning_new(nu, d->used);
    if (!partitioning_choose(d->partitioning, phi_u, d->rows, wanted, count))
        return false;
    for (int i = 0; i < d->free; i++)
        d->is_independent[partitioning_independent(d->partitioning)[i]] = true;
    return true;
}

/* Independent speeds first: their coordinates are independent too, so that equations read alike. */
static Status choose_independent(Work *w, Diag *diag)
{
    const LinearOrder *order = w->order;
    int *wanted = NEW_ARRAY(int, order->independent_count + w->l->nu);
    double *phi_u = plain_phi_u(w);
    int count = 0;
    bool chosen;
    Status status = OK;

    for (int k = 0; k < order->independent_count; k++)
        for (int j = 0; j < w->l->nu; j++) {
            int i = speed_coordinate(w->system, j);

            if (i >= 0 && strcmp(system_q(w->system, i)->name, order->independent[k]) == 0)
                wanted[count++] = j;
        }
    CHECK(choose_position_rows(w, phi_u));
    chosen = partition(w, &w->speeds, phi_u, wanted, count);
    if (chosen && w->places != &w->speeds) {
        for (int i = 0; i < w->speeds.free; i++)
            wanted[count++] = partitioning_independent(w->speeds.partitioning)[i];
        chosen = partition(w, w->places, phi_u, wanted, count);
    }
    if (!chosen)
        status =
            diag_set(diag, E_SINGULAR,
                     "a singular position: no choice of coordinates describes the motion there");
done:
    MEM_FREE(wanted, phi_u);
    return status;
}

/* factor the dependent columns of Phi_u */
static bool factor_columns(const Work *w, Dependence *d)
{
    const int nu = w->l->nu, m = d->used;

    for (int r = 0; r < m; r++)
        for (int j = 0, column = 0; j < nu; j++) {
            const LinearNumber entry = w->phi_u[d->rows[r] * nu + j];

            if (d->is_independent[j])
                continue;
            d->matrix[r * m + column] = entry.value;
            d->error[r * m + column++] = entry.error;
        }
    verified_solve_free(d->held);
    d->held = verified_solve_new(d->matrix, d->error, m);
    return verified_solve_is_regular(d->held);
}

static bool factor_dependent(Work *w)
{
    return factor_columns(w, &w->speeds) &&
           (w->places == &w->speeds || factor_columns(w, w->places));
}

void linear_complete(const Work *w, const Dependence *d, const LinearNumber *right, LinearNumber *v)
{
    const int nu = w->l->nu, m = d->used;
    double *b = NEW_ARRAY(double, m), *error = NEW_ARRAY(double, m);
    double *found = NEW_ARRAY(double, m), *off = NEW_ARRAY(double, m);

    for (int r = 0; r < m; r++) {
        LinearNumber sum = right[r];

        for (int j = 0; j < nu; j++)
            if (d->is_independent[j])
                number_add(&sum, w->phi_u[d->rows[r] * nu + j], v[j]);
        b[r] = -sum.value;
        error[r] = sum.error;
    }
    verified_solve_solution(d->held, b, error, found, off);
    for (int j = 0, column = 0; j < nu; j++)
        if (!d->is_independent[j]) {
            v[j] = (LinearNumber){found[column], off[column]};
            column++;
        }
    MEM_FREE(b, error, found, off);
}

/* --- errors of the state --- */

/* deviations of dependent ones for the residuals of rows, `first` being the index of constraint
 * 0's */
static void miss(const Work *w, const Dependence *d, int first, LinearNumber *moves)
{
    LinearNumber *right = NEW_ARRAY(LinearNumber, d->used);

    for (int r = 0; r < d->used; r++) {
        const LinearNumber value = w->values[first + d->rows[r]];

        right[r] = (LinearNumber){value.value, value.error};
    }
    for (int j = 0; j < w->l->nu; j++)
        moves[j] = (LinearNumber){0, 0};
    linear_complete(w, d, right, moves);
    mem_free(right);
}

static void bound_state(Work *w)
{
    const VariableIndex *l = w->l;
    LinearNumber *moves = NEW_ARRAY(LinearNumber, l->nu);

    miss(w, w->places, w->rows.phi, moves);
    for (int i = 0; i < l->n; i++)
        for (int j = 0; j < l->nu; j++)
            w->y_error[i] +=
                fabs(w->map[i * l->nu + j].value) * (fabs(moves[j].value) + moves[j].error);
    evaluate(w, true);
    miss(w, &w->speeds, w->rows.velocity, moves);
    for (int j = 0; j < l->nu; j++)
        w->y_error[l->n + j] += fabs(moves[j].value) + moves[j].error;
    mem_free(moves);
}

/* --- the point --- */

static void open_room(Work *w)
{
    const VariableIndex *l = w->l;
    const int follow = l->nu + l->m + l->nx + l->nz;

    w->speeds.used = w->order->about->result->start.row_count;
    w->unknowns = l->nu + w->speeds.used + l->nx + l->nz;
    w->follow = NEW_ARRAY(double, follow);
    w->follow_error = NEW_ARRAY(double, follow);
    w->y_error = NEW_ARRAY(double, variable_index_references(l) + l->multi_turns);
    w->values = NEW_ARRAY(LinearNumber, w->rows.count);
    w->matrix = NEW_ARRAY(double, w->unknowns * w->unknowns);
    w->matrix_error = NEW_ARRAY(double, w->unknowns * w->unknowns);
    w->phi_u = NEW_ARRAY(LinearNumber, l->m * l->nu);
    w->map = NEW_ARRAY(LinearNumber, 2 * l->n * l->nu);
    w->map_rate = w->map + l->n * l->nu;
    for (int i = 0; i < variable_index_references(l); i++)
        w->y_error[i] = number_error(w->y[i]);
}

/* Newton's method starts from the network's state in the run: from 0 it doesn't converge past an
 * exponential. */
static void begin_at_network(Work *w)
{
    const VariableIndex *l = w->l;
    Motion *motion = w->phase->motion;
    const double *known = motion != NULL && l->nz == w->phase->layout->nz && l->nx + l->nz > 0
                              ? motion_network(motion, w->order->at, w->y)
                              : NULL;

    for (int k = 0; k < l->nx + l->nz && known != NULL; k++)
        w->follow[(k < l->nx ? w->at.rates + k : w->at.z + k - l->nx) - w->at.acceleration] =
            known[k];
}

static Status refuse_dependent(Work *w, Diag *diag)
{
    if (failure_diagnose(w->l, &w->parameters, w->order->at, w->y,
                         "nothing linear determines how it moves", diag))
        return E_SINGULAR;
    (void)diag_set(diag, E_SINGULAR,
                   "the equations are dependent there: nothing linear determines how "
                   "it moves");
    diag_hint(diag, "take another instant, or another start");
    return E_SINGULAR;
}

Status linear_point(Work *w, Diag *diag)
{
    const VariableIndex *l = w->l, *theirs = w->phase->layout;

    if (l->n != theirs->n || l->nu != theirs->nu || l->m != theirs->m || l->nx != theirs->nx)
        return diag_set(diag, E_MODEL, "with these inputs the model has other unknowns");
    open_room(w);
    choose_rows(w);
    begin_at_network(w);
    if (!find_rates(w))
        TRY(refuse_dependent(w, diag));
    evaluate_geometry(w);
    TRY(choose_independent(w, diag));
    if (!factor_dependent(w))
        TRY(refuse_dependent(w, diag));
    evaluate(w, true);
    bound_state(w);
    evaluate(w, true);
    (void)fill_matrix(w);
    evaluate_geometry(w);
    if (!factor_dependent(w) || !bound_rates(w))
        TRY(refuse_dependent(w, diag));
    evaluate(w, true);
    (void)fill_matrix(w);
    factor(w);
    if (!verified_solve_is_regular(w->equations))
        TRY(refuse_dependent(w, diag));
    return OK;
}

bool linear_perturbed(Work *w)
{
    if (!find_rates(w))
        return false;
    evaluate_geometry(w);
    if (!factor_dependent(w))
        return false;
    (void)fill_matrix(w);
    factor(w);
    return verified_solve_is_regular(w->equations);
}

/* --- along the motion --- */

/* approximate largest eigenvalue of the deviations of coordinates, 1/s */
static double quickness(const Linear *linear)
{
    const int places = linear->places, n = places + linear->freedoms;
    double stiffness = 0, damping = 0;

    for (int i = places; i < n; i++)
        for (int k = 0; k < n; k++) {
            double *most = k < places ? &stiffness : &damping;

            *most = fmax(*most, fabs(linear->a[i * linear->states + k]));
        }
    return sqrt(stiffness) + damping;
}

/* coordinates and speeds after a time, with the current rates */
static void move_on(const Work *w, double time, double *y)
{
    const VariableIndex *l = w->l;

    memcpy(y, w->y, (size_t)w->phase->length * sizeof(double));
    for (int i = 0; i < l->n; i++) {
        double bend = 0;

        for (int j = 0; j < l->nu; j++)
            bend += w->map[i * l->nu + j].value * w->follow[j] +
                    w->map_rate[i * l->nu + j].value * w->y[l->n + j];
        y[i] += time * (w->values[w->rows.q_rate + i].value + time * bend / 2);
    }
    for (int j = 0; j < l->nu; j++)
        y[l->n + j] += time * w->follow[j];
}

/* Whether coefficients of coordinates, speeds, accelerations and multipliers in a row have changed:
 * `here` at the point, `count` of each. */
static bool row_changes(const double *here, const double *there, int count)
{
    double largest = 0, change = 0;

    for (int k = 0; k < count; k++) {
        largest = fmax(largest, fabs(here[k]));
        change = fmax(change, fabs(there[k] - here[k]));
    }
    return !(change <= LINEAR_CONSTANT * largest);
}

/* these coefficients of balances and velocity rows in use, at the tangents' point; new */
static double *coefficients(const Work *w)
{
    const int nu = w->l->nu, count = w->at.rates;
    double *out = NEW_ARRAY(double, (nu + w->speeds.used) * count);

    for (int first = 0; first < count; first += TANGENT_BATCH) {
        const int lanes = count - first < TANGENT_BATCH ? count - first : TANGENT_BATCH;

        tangents_clear(w->along);
        for (int lane = 0; lane < lanes; lane++)
            if (first + lane < w->at.x || first + lane >= w->at.acceleration)
                linear_move(w, lane, first + lane, (LinearNumber){1, 0});
        tangents_run(w->along);
        for (int r = 0; r < nu + w->speeds.used; r++)
            for (int lane = 0; lane < lanes; lane++)
                out[r * count + first + lane] =
                    linear_slope(
                        w, r < nu ? w->rows.balance + r : w->rows.velocity + w->speeds.rows[r - nu],
                        lane)
                        .value;
    }
    return out;
}

bool linear_is_passing(Work *w, const Linear *linear)
{
    const double quick = quickness(linear), time = quick > 0 ? LINEAR_AHEAD / quick : LINEAR_AHEAD;
    const int count = w->at.rates;
    double *y = NEW_ARRAY(double, w->phase->length), *here, *there;
    bool passes = false;
    RowValues row;

    evaluate(w, false);
    here = coefficients(w);
    move_on(w, time, y);
    row = row_with(w, w->order->at + time, y, w->follow);
    probe_tangents(w->derived, &row, NULL, w->along);
    there = coefficients(w);
    for (int r = 0; r < w->l->nu + w->speeds.used && !passes; r++)
        passes = row_changes(here + (size_t)r * count, there + (size_t)r * count, count);
    MEM_FREE(y, here, there);
    return passes;
}
