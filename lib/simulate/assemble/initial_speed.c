/* initial_speed.c: initial guess of speeds, along the joints
 *
 * Speeds that neither constraints nor given values determine are those with the least sum of
 * squares of rates: rates of the joints along which frames are placed, that is of edges whose rates
 * are given, then joints before bodies (initial_place.c); and rates of shapes. So equal bodies get
 * equal motions with any trees of the user's.
 *
 * The rates are A u. Among all u (nu) with C u = d, which are Phi_u u = nu and the given values,
 * the one with the least |A u| is wanted. Let L L^T = A^T A + P^T P with P the rows of Phi_u scaled
 * to length 1: |P u| is the same for all of them, so that it is the one with the least |L^T u|. */
#include "simulate/assemble/assemble_limits.h"
#include "simulate/assemble/initial_place_impl.h"
#include "simulate/assemble/perturbed_points.h"

#include "algebra/kkt.h"
#include "algebra/linear.h"
#include "algebra/matrix3.h"
#include "algebra/rank.h"

#include <math.h>
#include <string.h>

enum {
    MANY = 64,
    SWEEPS = 3 /* rows from which on sparse factors are tried first; refinements */
};

/* --- what is known --- */

static void know(Placing *p, int link, int k, bool is_guess)
{
    Knowledge *known = &p->known[place_at(link, k)];
    const Knowledge now = is_guess ? KNOWN_GUESSED : KNOWN_GIVEN;

    *known = now > *known ? now : *known;
}

/* The link with that name, a joint or a body, whose speeds are given; -1. */
static int link_named(const Placing *p, const char *name, size_t length)
{
    for (int i = 0; i < p->s->link_count; i++) {
        const char *own = p->s->links[i].instance->name;

        if (strlen(own) == length && strncmp(own, name, length) == 0)
            return i;
    }
    return -1;
}

/* all coordinates of a half */
static void know_half(Placing *p, int link, bool rotation, bool is_guess)
{
    const Instance *instance = p->s->links[link].instance;

    for (int k = 0; k < instance->pose_count; k++)
        if (instance->coord_rotation[k] == rotation)
            know(p, link, k, is_guess);
}

/* vx, wx, Wx and so on: a half is known once all of its components are */
static void count_component(Placing *p, int *wanted, const char *name, bool is_guess)
{
    const char *dot = strrchr(name, '.');
    const bool is_component = dot != NULL && strlen(dot) == 3 && strchr("vwW", dot[1]) != NULL &&
                              dot[2] >= 'x' && dot[2] <= 'z';
    const int link = is_component ? link_named(p, name, (size_t)(dot - name)) : -1;
    const int half = is_component && dot[1] != 'v';

    if (link >= 0 && ++wanted[2 * link + half] == p->s->frame.shift_count)
        know_half(p, link, half == 1, is_guess);
}

static void mark_rates(Placing *p)
{
    const Assembly *a = p->a;
    int *wanted = NEW_ARRAY(int, 2 * p->s->link_count);

    for (int i = 0; i < a->given_count; i++) {
        const StartValue *value = a->given[i].value;
        VariableReferent referent = {.kind = REFERENT_NONE};

        if (a->given[i].is_own)
            continue;
        if (value->primes == 1)
            referent = system_referent(a->l->system, value->name);
        if (referent.kind == REFERENT_COORDINATE || referent.kind == REFERENT_SHIFT)
            know(p, p->s->link_at[referent.instance->edge], referent.which, value->is_guess);
        else if (value->primes == 0)
            count_component(p, wanted, value->name, value->is_guess);
    }
    mem_free(wanted);
}

/* --- rates of joints from speeds --- */

static void read_at(const Link *link, const Pose *poses, double *c, Pose *relative)
{
    pose_between(&poses[link->tail], &poses[link->head], relative);
    link_read(link, relative, c);
}

/* The rate of a column: of a free rotation by its components in axes of the head, which all have
 * the same scale. */
static double column_rate(const Placing *p, const PlaceColumn *column, const Pose *low,
                          const Pose *high)
{
    const Link *link = &p->s->links[column->link];
    const int k = column->kind == COLUMN_SLIDE ? link->shift[column->k].coordinate
                                               : link->turn[column->k].coordinate;
    double before[POSE_COORDS] = {0}, after[POSE_COORDS];
    double R[9], turn[3];
    Pose first, last;

    read_at(link, low, before, &first);
    memcpy(after, before, sizeof after);
    read_at(link, high, after, &last);
    if (column->kind != COLUMN_FREE)
        return (after[k] - before[k]) / (2 * SPEED_DIFFERENCE);
    matrix3_transpose(first.R, R);
    matrix3_times(R, last.R, R);
    matrix3_log(R, turn);
    return turn[column->k] / (2 * SPEED_DIFFERENCE);
}

/* terms of a matrix, several of which may have one position */
typedef struct InitialSpeedTerms {
    LIST(int) row, column;
    LIST(double) value;
} InitialSpeedTerms;

static void push_term(InitialSpeedTerms *terms, int row, int column, double value)
{
    LIST_PUSH(terms->row, row);
    LIST_PUSH(terms->column, column);
    LIST_PUSH(terms->value, value);
}

/* Their sums, new, in the order of *pattern, which is new too. The terms are freed. */
static double *sum_terms(InitialSpeedTerms *terms, int rows, int columns, Pattern *pattern)
{
    const int count = terms->value.count;
    int *place = NEW_ARRAY(int, count);
    double *out;

    *pattern = pattern_of(rows, columns, count, terms->row.at, terms->column.at, place);
    out = NEW_ARRAY(double, pattern->count);
    for (int k = 0; k < count; k++)
        out[place[k]] += terms->value.at[k];
    LIST_FREE(terms->row);
    LIST_FREE(terms->column);
    LIST_FREE(terms->value);
    mem_free(place);
    return out;
}

/* A (rates x nu), by rows, each a column of *pattern; new */
static double *find_rates(const Placing *p, Pattern *pattern)
{
    const int nu = p->a->eq->nu;
    PerturbedPoints *sides = perturbed_points_new(p->s, p->a->eq, p->a->y, SPEED_DIFFERENCE);
    InitialSpeedTerms terms = {0};

    for (int j = 0; j < nu; j++) {
        perturbed_points_find(sides, j);
        for (int i = 0; i < p->columns.count; i++) {
            const PlaceColumn *column = &p->columns.at[i];
            double rate;

            if (perturbed_points_stores(sides, column->link))
                continue;
            rate =
                column_rate(p, column, perturbed_points_low(sides), perturbed_points_high(sides));
            rate = SPEED_RATE_GRID * round(rate / SPEED_RATE_GRID);
            if (rate != 0)
                push_term(&terms, j, i, rate);
        }
    }
    perturbed_points_free(sides);
    return sum_terms(&terms, nu, p->columns.count, pattern);
}

/* --- the least rates --- */

typedef struct Weighed { /* rows as functions of w = L^T u */
    Rows rows;
    const double *factor; /* L, in its lower half */
    double *jacobian;     /* of the rows, which are linear; NULL: not computed yet */
} Weighed;

/* += scale row^T row */
static void add_square(InitialSpeedTerms *sum, const Pattern *rows, const double *values, int row,
                       double scale)
{
    for (int i = rows->start[row]; i < rows->start[row + 1]; i++)
        for (int j = rows->start[row]; j < rows->start[row + 1]; j++)
            push_term(sum, rows->row[i], rows->row[j], scale * values[i] * values[j]);
}

/* L L^T, new, in the order of *square, which is new too */
static double *weigh(const Assembly *a, const Pattern *rates, const double *values, Pattern *square)
{
    const Equations *eq = a->eq;
    InitialSpeedTerms sum = {0};

    for (int i = 0; i < rates->columns; i++)
        add_square(&sum, rates, values, i, 1);
    for (int j = 0; j < eq->nu; j++) {
        const Variable *speed = system_u(a->l->system, j);

        if (speed->is_shape)
            push_term(&sum, j, j, 1 / (speed->unit * speed->unit));
    }
    for (int i = 0; i < eq->m; i++) {
        double size = 0;

        for (int k = eq->rows->start[i]; k < eq->rows->start[i + 1]; k++)
            size += eq->phi_u[k] * eq->phi_u[k];
        if (size > 0)
            add_square(&sum, eq->rows, eq->phi_u, i, 1 / size);
    }
    return sum_terms(&sum, eq->nu, eq->nu, square);
}

/* L; NULL: some motion has no rate, which can't happen with trees */
static double *factor_of(const Pattern *square, const double *weight)
{
    double *factor = pattern_spread(square, weight);

    if (!(cholesky_factor(factor, square->rows) > 0)) {
        mem_free(factor);
        factor = NULL;
    }
    return factor;
}

static void evaluate(void *context, const double *v, double *residual, double *jacobian)
{
    Weighed *w = context;
    const size_t nu = (size_t)w->rows.columns, size = (size_t)w->rows.rows * nu;
    const bool first = jacobian != NULL && w->jacobian == NULL;

    if (first)
        rows_evaluate_full(&w->rows, v, residual, jacobian);
    else
        w->rows.evaluate(w->rows.context, v, residual, NULL);
    if (first) {
        w->jacobian = NEW_ARRAY(double, size);
        for (size_t i = 0; i < (size_t)w->rows.rows; i++)
            cholesky_forward(w->factor, (int)nu, jacobian + i * nu);
        memcpy(w->jacobian, jacobian, size * sizeof(double));
    } else if (jacobian != NULL) {
        memcpy(jacobian, w->jacobian, size * sizeof(double));
    }
}

static void move(void *context, double *v, const double *step)
{
    const Weighed *w = context;
    const int nu = w->rows.columns;
    double *du = NEW_ARRAY(double, nu);

    memcpy(du, step, (size_t)nu * sizeof(double));
    cholesky_backward(w->factor, nu, du);
    for (int j = 0; j < nu; j++)
        v[j] += du[j];
    mem_free(du);
}

static Status solve(Assembly *a, const double *factor, bool guesses, Diag *diag)
{
    Problem p = {0};
    Weighed w = {.factor = factor};
    Rows rows;
    Status status = OK;

    CHECK(initial_open_problem(&p, a, LEVEL_VELOCITY, guesses, diag));
    w.rows = rows = initial_rows(&p);
    rows.context = &w;
    rows.pattern = NULL;
    rows.evaluate = evaluate;
    rows.move = move;
    /* equations that can't be satisfied are reported later */
    (void)levenberg_marquardt_solve(&rows, NULL, NULL, SPEED_TOLERANCE, a->y + a->l->n, NULL);
done:
    initial_close_problem(&p);
    mem_free(w.jacobian);
    return status;
}

/* whether no residual is more than a fraction of its row's size */
static bool are_met(const Pattern *rows, const double *values, const double *residual)
{
    for (int i = 0; i < rows->columns; i++)
        if (!(fabs(residual[i]) <= SPEED_TOLERANCE * pattern_largest(rows, values, i)))
            return false;
    return true;
}

/* The same as solve() by sparse factors, where given values are consistent: [L L^T C^T; C 0] with
 * independent rows. False, with speeds unchanged, where they aren't or the factors fail. */
static Status solve_sparse(Assembly *a, const Pattern *square, const double *weight, bool *solved,
                           Diag *diag)
{
    const int nu = a->eq->nu;
    double *u = a->y + a->l->n, *before = NEW_ARRAY(double, nu), *du = NEW_ARRAY(double, nu);
    double *residual = NULL, *values = NULL, *bottom = NULL, *lambda = NULL;
    Problem p = {0};
    Kkt *kkt = NULL;
    Rows rows;
    int *order = NULL, rank = 0;
    bool sound;
    Status status = OK;

    *solved = false;
    memcpy(before, u, (size_t)nu * sizeof *u);
    CHECK(initial_open_problem(&p, a, LEVEL_VELOCITY, false, diag));
    rows = initial_rows(&p);
    residual = NEW_ARRAY(double, rows.rows);
    if (rows.rows < MANY)
        goto done;
    values = NEW_ARRAY(double, rows.pattern->count);
    order = NEW_ARRAY(int, rows.rows);
    bottom = NEW_ARRAY(double, rows.rows);
    lambda = NEW_ARRAY(double, rows.rows);
    rows.evaluate(rows.context, u, residual, values);
    CHECK(rank_columns(rows.pattern, values, SPEED_RANK, a->setting->watch, &rank, order));
    kkt = kkt_new(square, rows.pattern, order, rank);
    kkt_set_watch(kkt, a->setting->watch);
    sound = kkt_factor(kkt, weight, values, order) && !kkt_is_regularised(kkt);
    for (int i = 0; i < SWEEPS && sound; i++) {
        for (int k = 0; k < rank; k++)
            bottom[k] = -residual[order[k]];
        kkt_solve(kkt, NULL, bottom, du, lambda);
        for (int j = 0; j < nu; j++)
            u[j] += du[j];
        rows.evaluate(rows.context, u, residual, NULL);
    }
    CHECK(monitor_poll(a->setting->watch));
    *solved = sound && vector_is_finite(u, nu) && are_met(rows.pattern, values, residual);
done:
    if (!*solved)
        memcpy(u, before, (size_t)nu * sizeof *u);
    kkt_free(kkt);
    initial_close_problem(&p);
    MEM_FREE(before, du, residual, values, bottom, lambda, order);
    return status;
}

/* set speeds of shapes to 0 that are 0 within the error of iterations */
static void rest(Assembly *a)
{
    for (int i = 0; i < a->given_count; i++) {
        const GivenValue *given = &a->given[i];

        if (given->is_own && given->level == LEVEL_VELOCITY &&
            fabs(a->y[a->l->n + given->place]) < SPEED_TOLERANCE)
            a->y[a->l->n + given->place] = 0;
    }
}

/* with the weights of `weight`: first with guesses, if there are any, then with given values
 * alone */
static Status solve_all(Assembly *a, const Pattern *square, const double *weight, bool guesses,
                        Diag *diag)
{
    double *factor = NULL;
    bool solved = false;
    Status status = OK;

    if (!guesses)
        CHECK(solve_sparse(a, square, weight, &solved, diag));
    if (solved)
        goto done;
    factor = factor_of(square, weight);
    if (factor == NULL)
        goto done;
    if (guesses)
        CHECK(solve(a, factor, true, diag));
    CHECK(solve(a, factor, false, diag));
    solved = true;
done:
    if (status == OK && solved)
        rest(a);
    mem_free(factor);
    return status;
}

/* --- whether speeds are open --- */

static bool any_guess(const Assembly *a, bool own)
{
    for (int i = 0; i < a->given_count; i++)
        if (a->given[i].level == LEVEL_VELOCITY && a->given[i].value->is_guess &&
            (own || !a->given[i].is_own))
            return true;
    return false;
}

/* Whether there is mechanics, and constraints and given values leave speeds undetermined. */
static Status is_open(Assembly *a, bool *open, Diag *diag)
{
    Problem p = {0};
    Rows rows;
    double *residual = NULL, *values = NULL;
    int *order = NULL;
    bool moves = any_guess(a, false);
    int rank = 0;
    Status status = OK;

    CHECK(initial_open_problem(&p, a, LEVEL_VELOCITY, false, diag));
    rows = initial_rows(&p);
    residual = NEW_ARRAY(double, rows.rows);
    values = NEW_ARRAY(double, rows.pattern->count);
    order = NEW_ARRAY(int, rows.rows);
    rows.evaluate(rows.context, a->y + a->l->n, residual, values);
    for (int i = 0; i < rows.rows; i++)
        moves = moves || residual[i] != 0;
    if (moves)
        CHECK(rank_columns(rows.pattern, values, SPEED_RANK, a->setting->watch, &rank, order));
    *open = moves && rank < rows.columns;
done:
    initial_close_problem(&p);
    MEM_FREE(residual, values, order);
    return status;
}

Status initial_speeds(Assembly *a, Diag *diag)
{
    Placing p = {.a = a, .s = a->kinematic_tree};
    Pattern of_rates = {0}, square = {0};
    double *rates = NULL, *weight = NULL;
    bool open = false;
    Status status = OK;

    if (p.s != NULL)
        CHECK(is_open(a, &open, diag));
    if (!open)
        return OK;
    p.known = NEW_ARRAY(Knowledge, p.s->link_count * POSE_COORDS);
    mark_rates(&p);
    CHECK(place_choose_trees(&p, diag));
    memset(p.known, 0, (size_t)(p.s->link_count * POSE_COORDS) * sizeof *p.known);
    place_columns(&p);
    rates = find_rates(&p, &of_rates);
    weight = weigh(a, &of_rates, rates, &square);
    CHECK(solve_all(a, &square, weight, any_guess(a, true), diag));
done:
    pattern_free(&of_rates);
    pattern_free(&square);
    MEM_FREE(rates, weight);
    placing_free(&p);
    return status;
}
