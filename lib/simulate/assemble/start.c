/* start.c: assembly: positions, speeds, independent constraints */
#include "simulate/assemble/start_impl.h"

#include "algebra/linear.h"
#include "algebra/rank.h"
#include "base/random.h"
#include "simulate/equations/redundant.h"
#include "simulate/equations/rows.h"

#include <math.h>
#include <string.h>

#define TOLERANCE  1e-12 /* of scaled residuals */
#define CLOSED     1e-13 /* m, rad: what rounding leaves of residuals */
#define TRIES      24    /* other starts, when the first leads nowhere */
#define FAR        2.0   /* rad or m: a dependent coordinate that moved further is spoken of */
#define RANK_RATIO 1e-9
#define CRITICAL   1e-12 /* of the sine that rates of three angles are divided by */

/* --- one problem --- */

static RowValues row_values(const Problem *p, const double *y)
{
    const Layout *l = p->a->l;
    const double *tail = p->row + l->n + l->nu + l->nx;

    return (RowValues){.q = y,
                       .u = y + l->n,
                       .x = y + l->n + l->nu,
                       .rates = tail,
                       .z = tail + l->nx,
                       .near = p->a->y + layout_turned(l)};
}

/* symbols of the unknowns of a level, one run of the layout's but for the network's */
static void level_symbols(const Problem *p, Expr *out)
{
    const Layout *l = p->a->l;
    int k = 0;

    if (p->level == LEVEL_POSITION)
        for (int i = 0; i < l->n; i++)
            out[k++] = l->symbols[l->q + i];
    if (p->level == LEVEL_VELOCITY)
        for (int i = 0; i < l->nu; i++)
            out[k++] = l->symbols[l->u + i];
    for (int i = 0; p->level >= LEVEL_NETWORK && i < p->symbols; i++)
        out[k++] = l->symbols[l->x + i]; /* x, x', z stand together */
}

bool start_is_of_states(const Given *given)
{
    const unsigned solved = 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE;

    return given->level == LEVEL_NETWORK && (expr_kinds(given->expr) & solved) == 0;
}

static bool is_of_level(const Given *given, Level level)
{
    return level == LEVEL_STATES ? start_is_of_states(given) : given->level == level;
}

/* what states have to satisfy by themselves */
static int invariants_of(const Layout *l)
{
    int count = 0;

    while (system_invariant(l->system, count) != NULL)
        count++;
    return count;
}

Status start_open_problem(Problem *p, Assembly *a, Level level, bool guesses, Diag *diag)
{
    const Layout *l = a->l;
    Arena *arena = system_arena(l->system);
    int equations = level == LEVEL_NETWORK ? l->nx + l->nz : 0;
    int extra = level >= LEVEL_NETWORK ? equations + invariants_of(l) : 0;
    LIST(Expr) roots = {0};
    Expr *symbols;
    Status status;

    *p = (Problem){.a = a, .level = level, .system_rows = level >= LEVEL_NETWORK ? extra : l->m};
    p->symbols = level == LEVEL_POSITION   ? l->n
                 : level == LEVEL_VELOCITY ? l->nu
                 : level == LEVEL_STATES   ? l->nx
                                           : 2 * l->nx + l->nz;
    p->columns = level == LEVEL_POSITION ? l->nu : p->symbols;
    p->picked = NEW_ARRAY(const Given *, a->given_count);
    p->row = NEW_ARRAY(double, l->n + l->nu + 2 * l->nx + l->nz);
    for (int i = 0; i < a->given_count; i++)
        if (is_of_level(&a->given[i], level) && a->given[i].expr != NULL &&
            (guesses || !a->given[i].value->is_guess))
            p->picked[p->count++] = &a->given[i];
    symbols = NEW_ARRAY(Expr, p->symbols);
    level_symbols(p, symbols);
    for (int i = 0; i < extra; i++)
        LIST_PUSH(roots,
                  i < equations ? row_network(l, i) : system_invariant(l->system, i - equations));
    for (int i = 0; i < p->count; i++)
        LIST_PUSH(roots, p->picked[i]->expr);
    for (int i = 0; i < extra + p->count; i++)
        for (int j = 0; j < p->symbols; j++)
            LIST_PUSH(roots, expr_diff(arena, roots.at[i], symbols[j]));
    status = probe_new(l, a->parameters, roots.at, roots.count, &p->probe, diag);
    LIST_FREE(roots);
    mem_free(symbols);
    return status;
}

void start_close_problem(Problem *p)
{
    probe_free(p->probe);
    mem_free(p->picked);
    mem_free(p->row);
}

/* gradient by coordinates to gradient by speeds */
static void along_speeds(const Problem *p, const double *gradient, double *out)
{
    const Equations *eq = p->a->eq;

    for (int j = 0; j < eq->nu; j++) {
        out[j] = eq->map == NULL ? gradient[j] : 0;
        for (int i = 0; eq->map != NULL && i < eq->n; i++)
            out[j] += gradient[i] * eq->map[i * eq->nu + j];
    }
}

/* the probed rows, which follow `first` rows of the system */
static void evaluate_probe(const Problem *p, const double *y, int first, double *residual,
                           double *jacobian)
{
    RowValues row = row_values(p, y);
    int extra = p->level >= LEVEL_NETWORK ? p->system_rows : 0;
    const double *values, *gradients;

    if (extra + p->count == 0)
        return;
    values = probe_values(p->probe, &row);
    gradients = values + extra + p->count;
    for (int i = 0; i < extra + p->count; i++) {
        const double *gradient = gradients + (ptrdiff_t)i * p->symbols;

        residual[first + i] = values[i];
        if (i >= extra)
            residual[first + i] -= p->picked[i - extra]->target;
        if (jacobian != NULL && p->level == LEVEL_POSITION)
            along_speeds(p, gradient, jacobian + (ptrdiff_t)(first + i) * p->columns);
        else if (jacobian != NULL)
            memcpy(jacobian + (ptrdiff_t)(first + i) * p->columns, gradient,
                   (size_t)p->columns * sizeof(double));
    }
}

static void evaluate_position(void *context, const double *v, double *residual, double *jacobian)
{
    const Problem *p = context;
    const Equations *eq = p->a->eq;

    eq->position(eq->context, 0, v);
    memcpy(residual, eq->phi, (size_t)eq->m * sizeof(double));
    if (jacobian != NULL)
        memcpy(jacobian, eq->phi_u, (size_t)(eq->m * eq->nu) * sizeof(double));
    memcpy(p->row, v, (size_t)eq->n * sizeof(double));
    evaluate_probe(p, p->row, eq->m, residual, jacobian);
}

static void move_position(void *context, double *v, const double *step)
{
    const Problem *p = context;
    const Equations *eq = p->a->eq;

    for (int i = 0; i < eq->n; i++) {
        v[i] += eq->map == NULL ? step[i] : 0;
        for (int j = 0; eq->map != NULL && j < eq->nu; j++)
            v[i] += eq->map[i * eq->nu + j] * step[j];
    }
    equations_normalise(eq, v);
}

static void evaluate_velocity(void *context, const double *v, double *residual, double *jacobian)
{
    const Problem *p = context;
    const Equations *eq = p->a->eq;

    eq->velocity(eq->context, v, p->a->y + eq->n + eq->nu);
    for (int k = 0; k < eq->m; k++) {
        residual[k] = -eq->nu_rate[k];
        for (int j = 0; j < eq->nu; j++)
            residual[k] += eq->phi_u[k * eq->nu + j] * v[j];
    }
    if (jacobian != NULL)
        memcpy(jacobian, eq->phi_u, (size_t)(eq->m * eq->nu) * sizeof(double));
    memcpy(p->row, p->a->y, (size_t)(eq->n + eq->nu + eq->nx) * sizeof(double));
    memcpy(p->row + eq->n, v, (size_t)eq->nu * sizeof(double));
    evaluate_probe(p, p->row, eq->m, residual, jacobian);
}

static void evaluate_network(void *context, const double *v, double *residual, double *jacobian)
{
    const Problem *p = context;
    const Equations *eq = p->a->eq;

    memcpy(p->row, p->a->y, (size_t)(eq->n + eq->nu) * sizeof(double));
    memcpy(p->row + eq->n + eq->nu, v, (size_t)p->columns * sizeof(double));
    evaluate_probe(p, p->row, 0, residual, jacobian);
}

Rows start_rows(Problem *p)
{
    Rows rows = {
        .columns = p->columns, .length = p->symbols, .context = p, .watch = p->a->setting->watch};

    rows.rows = p->system_rows + p->count;
    rows.evaluate = p->level == LEVEL_POSITION   ? evaluate_position
                    : p->level == LEVEL_VELOCITY ? evaluate_velocity
                                                 : evaluate_network;
    rows.move = p->level == LEVEL_POSITION ? move_position : NULL;
    return rows;
}

/* --- messages --- */

static void name_given(Text *text, const StartValue *value)
{
    text_addf(text, "%s%.*s = %.6g", value->name, value->primes, "''''", value->value);
}

static void name_row(Text *text, const Layout *l, int k)
{
    const ConstraintRow *row = system_constraint(l->system, k);

    text_addf(text, "%s (%s)", system_instance_name(l->system, row->instance), row->direction);
}

/* "h9 (x) is missed by 0.03; ..." with the values that were given */
Status start_conflict(const Problem *p, const double *residual, const char *what, Diag *diag)
{
    Text text = {0}, values = {0};
    int shown = 0;

    for (int k = 0; k < p->system_rows + p->count; k++) {
        if (fabs(residual[k]) <= 1e-9)
            continue;
        if (shown++ == 6) {
            text_add(&text, ", ...");
            break;
        }
        if (shown > 1)
            text_add(&text, ", ");
        if (k >= p->system_rows && p->picked[k - p->system_rows]->is_own)
            text_add(&text, p->picked[k - p->system_rows]->value->name);
        else if (k >= p->system_rows)
            name_given(&text, p->picked[k - p->system_rows]->value);
        else if (p->level >= LEVEL_NETWORK)
            text_addf(&text, "the network's equation %d", k + 1);
        else
            name_row(&text, p->a->l, k);
        if (isfinite(residual[k]))
            text_addf(&text, " by %.3g", fabs(residual[k]));
        else
            text_add(&text, ", undefined there");
    }
    for (int i = 0; i < p->a->given_count; i++)
        if (!p->a->given[i].value->is_guess && p->a->given[i].level <= p->level &&
            !p->a->given[i].is_own) {
            if (values.length > 0)
                text_add(&values, ", ");
            name_given(&values, p->a->given[i].value);
        }
    (void)diag_set(diag, E_ASSEMBLE, "%s; missed: %s%s%s", what,
                   text.at != NULL ? text.at : "nothing, but it is undefined there",
                   values.length > 0 ? "; given: " : "", values.length > 0 ? values.at : "");
    if (values.length > 0)
        diag_hint(diag, "leave one of the given values out, or make it a guess");
    else
        diag_hint(diag, "check the lengths of the loop, or give guesses nearer to a solution");
    text_free(&text);
    text_free(&values);
    return E_ASSEMBLE;
}

/* --- position --- */

/* Guesses of what says nothing of frames alone weigh as much as equations first: a branch on which
 * they are far off is no place to end. */
static Status pull(Assembly *a, Diag *diag)
{
    Problem p = {0};
    bool needed = false;
    Rows rows;
    Status status = OK;

    for (int i = 0; i < a->given_count; i++)
        needed = needed || (a->given[i].level == LEVEL_POSITION && a->given[i].value->is_guess &&
                            a->given[i].stand.kind == STANDS_NOT);
    if (!needed)
        return OK;
    CHECK(start_open_problem(&p, a, LEVEL_POSITION, true, diag));
    start_align(&p);
    rows = start_rows(&p);
    (void)least_solve(&rows, NULL, NULL, TOLERANCE, a->y, NULL);
done:
    start_close_problem(&p);
    return status;
}

static void remark_moved(Assembly *a, const double *begun)
{
    const Layout *l = a->l;
    int furthest = 0;

    for (int i = 1; i < l->n; i++)
        if (fabs(a->y[i] - begun[i]) > fabs(a->y[furthest] - begun[furthest]))
            furthest = i;
    if (l->n > 0 && fabs(a->y[furthest] - begun[furthest]) > FAR)
        text_addf(&a->out->remarks,
                  "warning: assembled far from where it began: %s went from %.4g to %.4g; a guess "
                  "chooses another assembly\n",
                  system_q(l->system, furthest)->name, begun[furthest], a->y[furthest]);
}

/* other starts about the first one; the nearest solution wins at the smallest disturbance */
static bool try_around(Problem *p, const Rows *rows, const bool *held, const double *begun)
{
    Assembly *a = p->a;
    uint64_t seed = 1;

    for (int k = 0; k < TRIES && poll(rows->watch) == OK; k++) {
        double size = k < TRIES / 3 ? 0.1 : k < 2 * TRIES / 3 ? 0.5 : 1.5;

        for (int i = 0; i < a->l->n; i++)
            a->y[i] = begun[i] + (held[i] ? 0 : size * random_unit(&seed));
        if (least_solve(rows, held, NULL, TOLERANCE, a->y, NULL) &&
            skeleton_reversal(a->skeleton, a->y).link == NULL) {
            text_addf(&a->out->remarks,
                      "warning: assembled from a start moved by up to %g; guesses make sure that "
                      "it is the assembly meant\n",
                      size);
            return true;
        }
    }
    return false;
}

/* E_ASSEMBLE: all equations hold, but a joint stands the wrong way round */
static Status refuse_reversed(const Assembly *a, const Reversal *reversal, Diag *diag)
{
    Text text = {0};

    reversal_tell(a->skeleton, reversal, &text);
    (void)diag_set(diag, E_ASSEMBLE, "%s closes only with %s wherever everything else holds",
                   reversal->link->instance->name, text.at);
    diag_hint(diag, "turn one of its frames by half a turn (rotation= of an arm), or guess a start "
                    "from which it closes as it is meant");
    text_free(&text);
    return E_ASSEMBLE;
}

/* Coordinates that have no expression are where they were given, also once positions moved. */
static Status check_told(Assembly *a, Diag *diag)
{
    Status status = OK;

    for (int i = 0; i < a->given_count && status == OK; i++) {
        const Given *given = &a->given[i];
        double near[MAX_COORDS] = {0}, value;

        if (given->expr != NULL || given->value->is_guess)
            continue;
        for (int j = 0; j < a->given_count; j++)
            if (a->given[j].expr == NULL && a->given[j].stand.instance == given->stand.instance)
                near[a->given[j].stand.which] = a->given[j].target;
        value = skeleton_value(a->skeleton, a->y, given->stand.instance, given->stand.which, near);
        if (!(fabs(value - given->target) < 1e-9)) {
            status = diag_set(diag, E_ASSEMBLE,
                              "the parts can't be put together; missed: %s = %.6g by %.3g",
                              given->value->name, given->target, fabs(value - given->target));
            diag_hint(diag, "leave one of the given values out, or make it a guess");
        }
    }
    return status;
}

/* Meet what the placing left: given values that aren't of frames, or loops that it couldn't close.
 */
static Status correct(Problem *p, const bool *held, const double *begun, bool closed, Diag *diag)
{
    Assembly *a = p->a;
    Rows rows = start_rows(p);
    double *residual = NEW_ARRAY(double, rows.rows);
    double *missed = NEW_ARRAY(double, rows.rows);
    Reversal reversed = {.link = NULL};
    bool met = true;
    Status status = OK;

    rows.evaluate(rows.context, a->y, residual, NULL);
    for (int i = 0; i < rows.rows; i++)
        met = met && fabs(residual[i]) <= CLOSED;
    if (met && closed)
        goto done;
    met = least_solve(&rows, held, NULL, TOLERANCE, a->y, missed);
    if (met)
        reversed = skeleton_reversal(a->skeleton, a->y);
    if ((!met || reversed.link != NULL) && !try_around(p, &rows, held, begun))
        CHECK(reversed.link != NULL
                  ? refuse_reversed(a, &reversed, diag)
                  : start_conflict(p, missed, "the parts can't be put together", diag));
    CHECK(check_told(a, diag));
    remark_moved(a, begun);
done:
    mem_free(residual);
    mem_free(missed);
    return status;
}

/* Three angles have no rates where the first and the last axis lie on one line. */
static Status check_angles(const Assembly *a, Diag *diag)
{
    const RowValues row = row_of_state(a->l, 0, a->y);
    Critical critical;
    Status status = OK;

    for (int i = 0; status == OK && system_critical(a->l->system, i, &critical); i++) {
        Probe *probe = NULL;

        status = probe_new(a->l, a->parameters, &critical.measure, 1, &probe, diag);
        if (status == OK && fabs(probe_values(probe, &row)[0]) < CRITICAL) {
            status =
                diag_set(diag, E_ASSEMBLE,
                         "%s starts at a critical angle: three angles have no rates where %s is "
                         "%s",
                         critical.instance, critical.coordinate, critical.angles);
            diag_hint(diag,
                      "give %s another value by init or guess, choose other angles, or leave "
                      "euler= out",
                      critical.coordinate);
        }
        probe_free(probe);
    }
    return status;
}

static Status find_position(Assembly *a, bool closed, Diag *diag)
{
    const Layout *l = a->l;
    Problem p = {0};
    double *begun = NEW_ARRAY(double, l->n);
    bool *held = NEW_ARRAY(bool, l->nu + l->n);
    Status status = OK;

    CHECK(start_open_problem(&p, a, LEVEL_POSITION, false, diag));
    for (int i = 0; i < p.count; i++)
        if (p.picked[i]->column >= 0)
            held[p.picked[i]->column] = true;
    memcpy(begun, a->y, (size_t)l->n * sizeof(double));
    CHECK(pull(a, diag));
    for (int i = 0; i < p.count; i++)
        if (p.picked[i]->column >= 0)
            a->y[p.picked[i]->place] = p.picked[i]->target;
    start_align(&p);
    CHECK(correct(&p, held, begun, closed, diag));
    CHECK(check_angles(a, diag));
done:
    start_close_problem(&p);
    mem_free(begun);
    mem_free(held);
    return status;
}

/* --- velocity --- */

static Status find_velocity(Assembly *a, Diag *diag)
{
    const Layout *l = a->l;
    Problem p = {0};
    bool *held = NEW_ARRAY(bool, l->nu);
    double *residual = NULL;
    Rows rows;
    Status status = OK;

    a->eq->position(a->eq->context, 0, a->y);
    CHECK(start_speeds(a, diag));
    for (int i = 0; i < a->given_count; i++) {
        const Given *given = &a->given[i];

        if (given->level == LEVEL_VELOCITY && given->column >= 0 && !given->value->is_guess) {
            a->y[l->n + given->column] = given->value->value;
            held[given->column] = true;
        }
    }
    CHECK(start_open_problem(&p, a, LEVEL_VELOCITY, false, diag));
    rows = start_rows(&p);
    residual = NEW_ARRAY(double, rows.rows);
    if (!least_solve(&rows, held, NULL, 1e-11, a->y + l->n, residual))
        CHECK(start_conflict(&p, residual, "no speeds satisfy the constraints", diag));
done:
    start_close_problem(&p);
    mem_free(held);
    mem_free(residual);
    return status;
}

/* --- rank --- */

/* Phi_u at a position nearby that meets the constraints; false when none was found */
static bool nearby(Assembly *a, uint64_t *seed, double *q, double *residual)
{
    const Layout *l = a->l;
    Problem p = {
        .a = a, .level = LEVEL_POSITION, .system_rows = l->m, .columns = l->nu, .symbols = l->n};
    Rows rows;
    bool met;

    p.row = NEW_ARRAY(double, l->n);
    for (int i = 0; i < l->n; i++)
        q[i] = a->y[i] + 1e-2 * random_unit(seed);
    rows = start_rows(&p);
    met = least_solve(&rows, NULL, NULL, TOLERANCE, q, residual);
    if (met)
        a->eq->position(a->eq->context, 0, q);
    mem_free(p.row);
    return met;
}

/* Independent rows, from the assembled position and two near it: a rank that falls at one place
 * only is a singularity, not a redundancy. */
static Status find_rank(Assembly *a)
{
    const Layout *l = a->l;
    const Watch *watch = a->setting->watch;
    int *order = NEW_ARRAY(int, l->m);
    double *q = NEW_ARRAY(double, l->n);
    double *residual = NEW_ARRAY(double, l->m);
    uint64_t seed = 7;
    int here, best;
    Status status = OK;

    a->eq->position(a->eq->context, 0, a->y);
    CHECK(rank_rows(a->eq->phi_u, l->m, l->nu, RANK_RATIO, watch, &here, a->out->rows));
    best = here;
    for (int k = 0; k < 2 && best < l->m; k++) {
        int rank;

        if (!nearby(a, &seed, q, residual))
            continue;
        CHECK(rank_rows(a->eq->phi_u, l->m, l->nu, 1e-7, watch, &rank, order));
        if (rank > best) {
            best = rank;
            memcpy(a->out->rows, order, (size_t)l->m * sizeof(int));
        }
    }
    a->out->row_count = best;
    if (here < best)
        text_addf(&a->out->remarks,
                  "the start is a singular position: %d of %d constraints hold there\n", here,
                  best);
    if (best < l->m) {
        /* at a singular start, what was found nearby tells more */
        if (here == best)
            a->eq->position(a->eq->context, 0, a->y);
        redundant_tell(l->system, a->eq->phi_u, a->out->rows, best, &a->out->remarks);
    }
done:
    mem_free(order);
    mem_free(q);
    mem_free(residual);
    return status;
}

Status start_find(const Layout *layout, Parameters *parameters, Numbers *numbers,
                  const Setting *setting, bool has_modes, WarmValue warm, void *warm_context,
                  Assembled *out, Diag *diag)
{
    Assembly a = {.l = layout,
                  .parameters = parameters,
                  .numbers = numbers,
                  .eq = numbers_equations(numbers),
                  .setting = setting,
                  .has_modes = has_modes,
                  .out = out};
    bool closed;
    Status status = OK;

    *out = (Assembled){.y = NEW_ARRAY(double, layout_turned(layout) + layout->turned + 1),
                       .network = NEW_ARRAY(double, layout->nx + layout->nz),
                       .guess = NEW_ARRAY(double, layout->nz),
                       .rows = NEW_ARRAY(int, layout->m)};
    a.y = out->y;
    a.skeleton = skeleton_new(layout, parameters);
    CHECK(start_read_given(&a, diag));
    CHECK(start_place(&a, warm, warm_context, &closed, diag));
    CHECK(find_position(&a, closed, diag));
    equations_turn(a.eq, 0, a.y, a.y + layout_turned(layout));
    CHECK(find_rank(&a));
    CHECK(find_velocity(&a, diag));
    CHECK(start_find_network(&a, setting->from != NULL ? warm : NULL, warm_context, diag));
done:
    /* what was stopped has found nothing, and says so in many ways */
    if (poll(setting->watch) != OK)
        status = diag_set(diag, E_STOPPED, "stopped while the start was looked for");
    skeleton_free(a.skeleton);
    mem_free(a.given);
    mem_free(a.own);
    return status;
}

void start_free(Assembled *start)
{
    mem_free(start->y);
    mem_free(start->network);
    mem_free(start->guess);
    mem_free(start->rows);
    text_free(&start->remarks);
    *start = (Assembled){0};
}
