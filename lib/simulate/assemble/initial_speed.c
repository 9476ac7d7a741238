/* initial_speed.c: speeds begin along the joints
 *
 * Speeds that neither constraints nor given values determine are those of the least rates, summed
 * by squares, of the joints along which frames are placed: edges whose rates are given, then joints
 * before bodies (initial_place.c), and of what shapes move. So the same bodies move the same in any
 * trees of the user's.
 *
 * The rates are A u. Among all u with C u = d, which are Phi_u u = nu and what was given, the least
 * |A u| is wanted. Let L L^T = A^T A + P^T P with P the rows of Phi_u, each of length 1: |P u| is
 * the same for all of them, and it is the least |L^T u|. */
#include "simulate/assemble/initial_place_impl.h"

#include "algebra/linear.h"
#include "algebra/matrix3.h"
#include "algebra/rank.h"

#include <math.h>
#include <string.h>

#define STEP       1e-5    /* m, rad: the error of a central difference is about its square */
#define GRID       0x1p-30 /* of rates, above the error of differences: 0 and 1 are exact */
#define TOLERANCE  1e-11
#define RANK_RATIO 1e-9

/* --- what is known --- */

static void know(Placing *p, int link, int k, bool is_guess)
{
    Knowledge *known = &p->known[place_at(link, k)];
    const Knowledge now = is_guess ? KNOWN_GUESSED : KNOWN_GIVEN;

    *known = now > *known ? now : *known;
}

/* The link whose speeds are told under that name: a joint or a body; -1. */
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
static void count_component(Placing *p, int *told, const char *name, bool is_guess)
{
    const char *dot = strrchr(name, '.');
    const bool is_component = dot != NULL && strlen(dot) == 3 && strchr("vwW", dot[1]) != NULL &&
                              dot[2] >= 'x' && dot[2] <= 'z';
    const int link = is_component ? link_named(p, name, (size_t)(dot - name)) : -1;
    const int half = is_component && dot[1] != 'v';

    if (link >= 0 && ++told[2 * link + half] == p->s->frame.shift_count)
        know_half(p, link, half == 1, is_guess);
}

static void mark_rates(Placing *p)
{
    const Assembly *a = p->a;
    int *told = NEW_ARRAY(int, 2 * p->s->link_count);

    for (int i = 0; i < a->given_count; i++) {
        const StartValue *value = a->given[i].value;
        Stand stand = {.kind = STANDS_NOT};

        if (a->given[i].is_own)
            continue;
        if (value->primes == 1)
            stand = system_stand(a->l->system, value->name);
        if (stand.kind == STANDS_COORDINATE || stand.kind == STANDS_SHIFT)
            know(p, p->s->link_at[stand.instance->edge], stand.which, value->is_guess);
        else if (value->primes == 0)
            count_component(p, told, value->name, value->is_guess);
    }
    mem_free(told);
}

/* --- rates of joints by speeds --- */

/* poses and coordinates a little to one side along speed j */
static Pose *poses_beside(const Placing *p, int j, double by)
{
    const Equations *eq = p->a->eq;
    double *q = NEW_ARRAY(double, eq->n);
    Pose *poses;

    memcpy(q, p->a->y, (size_t)eq->n * sizeof(double));
    for (int i = 0; i < eq->n; i++)
        q[i] += by * (eq->map != NULL ? eq->map[i * eq->nu + j] : i == j);
    poses = skeleton_poses_at(p->s, q);
    mem_free(q);
    return poses;
}

static void read_at(const Link *link, const Pose *poses, double *c, Pose *relative)
{
    pose_between(&poses[link->tail], &poses[link->head], relative);
    link_read(link, relative, c);
}

/* How fast a column goes: a turn in any direction by its components in axes of the head, which all
 * have the same length. */
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
        return (after[k] - before[k]) / (2 * STEP);
    matrix3_transpose(first.R, R);
    matrix3_times(R, last.R, R);
    matrix3_log(R, turn);
    return turn[column->k] / (2 * STEP);
}

/* A: columns x nu, row by row; new */
static double *find_rates(const Placing *p)
{
    const int nu = p->a->eq->nu;
    double *rates = NEW_ARRAY(double, (size_t)p->columns.count *(size_t)nu);

    for (int j = 0; j < nu; j++) {
        Pose *low = poses_beside(p, j, -STEP), *high = poses_beside(p, j, STEP);

        for (int i = 0; i < p->columns.count; i++)
            rates[(ptrdiff_t)i * nu + j] =
                GRID * round(column_rate(p, &p->columns.at[i], low, high) / GRID);
        MEM_FREE(low, high);
    }
    return rates;
}

/* --- the least of them --- */

typedef struct Weighed { /* rows in w = L^T u */
    Rows rows;
    const double *factor; /* L, in its lower half */
    double *jacobian;     /* of the rows, which are linear; NULL: not asked for yet */
} Weighed;

/* sum += scale row^T row, its lower half */
static void add_square(double *sum, int n, const double *row, double scale)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i && row[i] != 0; j++)
            sum[i * n + j] += scale * row[i] * row[j];
}

/* L; NULL: these speeds leave some motion without a rate, which trees don't */
static double *weigh(const Assembly *a, const double *rates, int count)
{
    const int nu = a->eq->nu;
    double *square = NEW_ARRAY(double, nu *nu);
    double *phi_u = pattern_spread(a->eq->rows, a->eq->phi_u);

    for (int i = 0; i < count; i++)
        add_square(square, nu, rates + (ptrdiff_t)i * nu, 1);
    for (int j = 0; j < nu; j++) {
        const Variable *speed = system_u(a->l->system, j);

        if (speed->is_shape)
            square[j * nu + j] += 1 / (speed->unit * speed->unit);
    }
    for (int i = 0; i < a->eq->m; i++) {
        const double *row = phi_u + (ptrdiff_t)i * nu;
        double size = 0;

        for (int j = 0; j < nu; j++)
            size += row[j] * row[j];
        if (size > 0)
            add_square(square, nu, row, 1 / size);
    }
    mem_free(phi_u);
    if (!(cholesky_factor(square, nu) > 0)) {
        mem_free(square);
        square = NULL;
    }
    return square;
}

static void evaluate(void *context, const double *v, double *residual, double *jacobian)
{
    Weighed *w = context;
    const size_t nu = (size_t)w->rows.columns, size = (size_t)w->rows.rows * nu;
    const bool first = jacobian != NULL && w->jacobian == NULL;

    w->rows.evaluate(w->rows.context, v, residual, first ? jacobian : NULL);
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
    rows.evaluate = evaluate;
    rows.move = move;
    /* what can't be met is told by who looks at it next */
    (void)levenberg_marquardt_solve(&rows, NULL, NULL, TOLERANCE, a->y + a->l->n, NULL);
done:
    initial_close_problem(&p);
    mem_free(w.jacobian);
    return status;
}

/* shapes that rest but for what iterations left */
static void rest(Assembly *a)
{
    for (int i = 0; i < a->given_count; i++) {
        const GivenValue *given = &a->given[i];

        if (given->is_own && given->level == LEVEL_VELOCITY &&
            fabs(a->y[a->l->n + given->place]) < TOLERANCE)
            a->y[a->l->n + given->place] = 0;
    }
}

/* --- whether it matters --- */

static bool any_guess(const Assembly *a, bool own)
{
    for (int i = 0; i < a->given_count; i++)
        if (a->given[i].level == LEVEL_VELOCITY && a->given[i].value->is_guess &&
            (own || !a->given[i].is_own))
            return true;
    return false;
}

/* Anything moves at all, and constraints and given values leave speeds open. */
static Status is_open(Assembly *a, bool *open, Diag *diag)
{
    Problem p = {0};
    Rows rows;
    double *residual = NULL, *jacobian = NULL;
    int *order = NULL;
    bool moves = any_guess(a, false);
    int rank = 0;
    Status status = OK;

    CHECK(initial_open_problem(&p, a, LEVEL_VELOCITY, false, diag));
    rows = initial_rows(&p);
    residual = NEW_ARRAY(double, rows.rows);
    jacobian = NEW_ARRAY(double, (size_t)rows.rows *(size_t)rows.columns);
    order = NEW_ARRAY(int, rows.rows);
    rows.evaluate(rows.context, a->y + a->l->n, residual, jacobian);
    for (int i = 0; i < rows.rows; i++)
        moves = moves || residual[i] != 0;
    if (moves)
        CHECK(rank_rows(jacobian, rows.rows, rows.columns, RANK_RATIO, a->setting->watch, &rank,
                        order));
    *open = moves && rank < rows.columns;
done:
    initial_close_problem(&p);
    MEM_FREE(residual, jacobian, order);
    return status;
}

Status initial_speeds(Assembly *a, Diag *diag)
{
    Placing p = {.a = a, .s = a->skeleton};
    double *rates = NULL;
    double *factor = NULL;
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
    rates = find_rates(&p);
    factor = weigh(a, rates, p.columns.count);
    if (factor != NULL) {
        if (any_guess(a, true))
            CHECK(solve(a, factor, true, diag));
        CHECK(solve(a, factor, false, diag));
        rest(a);
    }
done:
    MEM_FREE(factor, rates);
    placing_free(&p);
    return status;
}
