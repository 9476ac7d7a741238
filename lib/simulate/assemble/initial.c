/* initial.c: assembly: consistent positions and speeds, and independent constraints
 *
 * Phi(q, 0) = 0 (m), then Phi_u u = nu (m) in u (nu), each with the given values, by
 * Levenberg-Marquardt; then the rank of Phi_u (m x nu). */
#include "simulate/assemble/initial_impl.h"

#include "algebra/linear.h"
#include "algebra/rank.h"
#include "base/random.h"
#include "simulate/assemble/assemble_limits.h"
#include "simulate/equations/redundant.h"
#include "simulate/equations/rows.h"

#include <math.h>
#include <string.h>

/* --- position --- */

/* Include guesses with the weight of equations first, where a guess isn't of frames alone:
 * otherwise the search may end on a branch on which such guesses are far off. */
static Status pull(Assembly *a, Diag *diag)
{
    Problem p = {0};
    bool needed = false;
    Rows rows;
    Status status = OK;

    for (int i = 0; i < a->given_count; i++)
        needed = needed || (a->given[i].level == LEVEL_POSITION && a->given[i].value->is_guess &&
                            a->given[i].referent.kind == REFERENT_NONE);
    if (!needed)
        return OK;
    CHECK(initial_open_problem(&p, a, LEVEL_POSITION, true, diag));
    initial_align(&p);
    rows = initial_rows(&p);
    (void)levenberg_marquardt_solve(&rows, NULL, NULL, ALIGN_TOLERANCE, a->y, NULL);
done:
    initial_close_problem(&p);
    return status;
}

/* whether a coordinate may have several values where the others are known: some row is not linear
 * in it. The angle of a wheel that rolls along a line has one. */
static bool has_branches(const VariableIndex *l, int coordinate)
{
    const Expr q = system_q(l->system, coordinate)->symbol;
    bool branches = false;

    for (int k = 0; k < l->position_rows && !branches; k++) {
        const Expr slope = expr_diff(system_arena(l->system), system_run(l->system)->phi[k], q);

        branches = (expr_kinds(slope) & 1U << SYMBOL_COORDINATE) != 0;
    }
    return branches;
}

static void remark_moved(Assembly *a, const double *begun)
{
    const VariableIndex *l = a->l;
    int furthest = 0;

    for (int i = 1; i < l->n; i++)
        if (fabs(a->y[i] - begun[i]) > fabs(a->y[furthest] - begun[furthest]))
            furthest = i;
    if (l->n > 0 && has_branches(l, furthest) &&
        fabs(a->y[furthest] - begun[furthest]) > COORDINATES_FAR)
        remarks_add(&a->out->remarks, (Remark){.kind = REMARK_ASSEMBLED_FAR,
                                               .what = system_q(l->system, furthest)->name,
                                               .size = begun[furthest],
                                               .to = a->y[furthest]});
}

/* Further initial guesses about the first one, at increasing distance; of those at the smallest
 * distance that converge the nearest solution is used. */
static bool try_around(Problem *p, const Rows *rows, const bool *held, const double *begun)
{
    Assembly *a = p->a;
    uint64_t seed = 1;

    for (int k = 0; k < COORDINATES_TRIES && monitor_poll(rows->watch) == OK; k++) {
        double size = k < COORDINATES_TRIES / 3 ? 0.1 : k < 2 * COORDINATES_TRIES / 3 ? 0.5 : 1.5;

        for (int i = 0; i < a->l->n; i++)
            a->y[i] = begun[i] + (held[i] ? 0 : size * random_unit(&seed));
        if (initial_meet(rows, held, a->y, NULL) &&
            kinematic_tree_reversal(a->kinematic_tree, a->y).link == NULL) {
            remarks_add(&a->out->remarks, (Remark){.kind = REMARK_ASSEMBLED_AROUND, .size = size});
            return true;
        }
    }
    return false;
}

/* E_ASSEMBLE: all equations are satisfied, but a joint is assembled with a reversed direction. */
static Status refuse_reversed(const Assembly *a, const Reversal *reversal, Diag *diag)
{
    Text text = {0};

    reversal_report(a->kinematic_tree, reversal, &text);
    (void)diag_set(diag, E_ASSEMBLE, "%s closes only with %s wherever everything else holds",
                   reversal->link->instance->name, text.at);
    diag_hint(diag, "turn one of its frames by half a turn (rotation= of an arm), or guess a start "
                    "from which it closes as it is meant");
    text_free(&text);
    return E_ASSEMBLE;
}

/* Check coordinates without an expression: they still have their given values after positions
 * moved. */
static Status check_given_values(Assembly *a, Diag *diag)
{
    Status status = OK;

    for (int i = 0; i < a->given_count && status == OK; i++) {
        const GivenValue *given = &a->given[i];
        double near[POSE_COORDS] = {0}, value;

        if (given->expr != NULL || given->value->is_guess)
            continue;
        for (int j = 0; j < a->given_count; j++)
            if (a->given[j].expr == NULL &&
                a->given[j].referent.instance == given->referent.instance)
                near[a->given[j].referent.which] = a->given[j].target;
        value = kinematic_tree_value(a->kinematic_tree, a->y, given->referent.instance,
                                     given->referent.which, near);
        if (!(fabs(value - given->target) < 1e-9)) {
            status = diag_set(diag, E_ASSEMBLE,
                              "the parts can't be put together; missed: %s = %.6g by %.3g",
                              given->value->name, given->target, fabs(value - given->target));
            diag_hint(diag, "leave one of the given values out, or make it a guess");
        }
    }
    return status;
}

/* Solve with shapes held, as given or guessed or else undeformed, where joints can close the loops.
 * False: they can't, and nothing has moved. */
static bool meet_with_shapes_held(const Rows *rows, Assembly *a, const bool *held)
{
    const int n = a->l->n, nu = a->l->nu;
    double *begun = NEW_ARRAY(double, n);
    bool *is_held = NEW_ARRAY(bool, nu + n);
    bool met = false, any = false;

    memcpy(begun, a->y, (size_t)n * sizeof(double));
    memcpy(is_held, held, (size_t)(nu + n) * sizeof(bool));
    for (int j = 0; j < nu; j++)
        if (system_u(a->l->system, j)->is_shape)
            is_held[j] = any = true;
    if (any)
        met = initial_meet(rows, is_held, a->y, NULL);
    if (any && !met)
        memcpy(a->y, begun, (size_t)n * sizeof(double));
    MEM_FREE(begun, is_held);
    return met;
}

/* Solve what placing the frames left: given values that aren't of frames, or loops that it couldn't
 * close. */
static Status correct(Problem *p, const bool *held, const double *begun, bool closed, Diag *diag)
{
    Assembly *a = p->a;
    Rows rows = initial_rows(p);
    double *residual = NEW_ARRAY(double, rows.rows);
    double *missed = NEW_ARRAY(double, rows.rows);
    Reversal reversed = {.link = NULL};
    bool met = true;
    Status status = OK;

    rows.evaluate(rows.context, a->y, residual, NULL);
    for (int i = 0; i < rows.rows; i++)
        met = met && !initial_misses(residual[i]);
    if (met && closed)
        goto done;
    met = meet_with_shapes_held(&rows, a, held) || initial_meet(&rows, held, a->y, missed);
    if (met)
        reversed = kinematic_tree_reversal(a->kinematic_tree, a->y);
    if ((!met || reversed.link != NULL) && !try_around(p, &rows, held, begun))
        CHECK(reversed.link != NULL
                  ? refuse_reversed(a, &reversed, diag)
                  : initial_conflict(p, missed, "the parts can't be put together", diag));
    CHECK(check_given_values(a, diag));
    remark_moved(a, begun);
done:
    MEM_FREE(residual, missed);
    return status;
}

/* The rates of three angles are undefined where the first and the last axis are parallel. */
static Status check_angles(const Assembly *a, Diag *diag)
{
    const RowValues row = row_of_state(a->l, 0, a->y);
    Critical critical;
    Status status = OK;

    for (int i = 0; status == OK && system_critical(a->l->system, i, &critical); i++) {
        double measure;

        status = probe_at(a->l, a->parameters, critical.measure, &row, &measure, diag);
        if (status == OK && fabs(measure) < CRITICAL_ANGLES) {
            status =
                diag_set(diag, E_ASSEMBLE, "%s starts at a critical angle: %s where %s is %s",
                         critical.instance, critical.effect, critical.coordinate, critical.angles);
            diag_hint(diag, "give %s another value by init or guess; %s", critical.coordinate,
                      critical.remedy);
        }
    }
    return status;
}

/* Set coordinates that are given or guessed and place no frame. */
static void begin_others(Assembly *a)
{
    for (int i = 0; i < a->given_count; i++) {
        const GivenValue *given = &a->given[i];

        if (given->level == LEVEL_POSITION && given->place >= 0 && !given->is_own &&
            given->referent.kind == REFERENT_NONE)
            a->y[given->place] = given->target;
    }
}

static Status find_position(Assembly *a, bool closed, Diag *diag)
{
    const VariableIndex *l = a->l;
    Problem p = {0};
    double *begun = NEW_ARRAY(double, l->n);
    bool *held = NEW_ARRAY(bool, l->nu + l->n);
    Status status = OK;

    CHECK(initial_open_problem(&p, a, LEVEL_POSITION, false, diag));
    for (int i = 0; i < p.count; i++)
        if (p.picked[i]->column >= 0)
            held[p.picked[i]->column] = true;
    begin_others(a);
    memcpy(begun, a->y, (size_t)l->n * sizeof(double));
    CHECK(pull(a, diag));
    for (int i = 0; i < p.count; i++)
        if (p.picked[i]->column >= 0)
            a->y[p.picked[i]->place] = p.picked[i]->target;
    initial_align(&p);
    CHECK(correct(&p, held, begun, closed, diag));
    CHECK(check_angles(a, diag));
done:
    initial_close_problem(&p);
    MEM_FREE(begun, held);
    return status;
}

/* --- velocity --- */

static Status find_velocity(Assembly *a, Diag *diag)
{
    const VariableIndex *l = a->l;
    Problem p = {0};
    bool *held = NEW_ARRAY(bool, l->nu);
    double *residual = NULL;
    Rows rows;
    Status status = OK;

    a->eq->position(a->eq->context, 0, a->y);
    CHECK(initial_align_rates(a, diag));
    CHECK(initial_speeds(a, diag));
    for (int i = 0; i < a->given_count; i++) {
        const GivenValue *given = &a->given[i];

        if (given->level == LEVEL_VELOCITY && given->column >= 0 && !given->value->is_guess) {
            a->y[l->n + given->column] = given->target;
            held[given->column] = true;
        }
    }
    CHECK(initial_open_problem(&p, a, LEVEL_VELOCITY, false, diag));
    rows = initial_rows(&p);
    residual = NEW_ARRAY(double, rows.rows);
    if (!levenberg_marquardt_solve(&rows, held, NULL, 1e-11, a->y + l->n, residual))
        CHECK(initial_conflict(&p, residual, "no speeds satisfy the constraints", diag));
done:
    initial_close_problem(&p);
    MEM_FREE(held, residual);
    return status;
}

/* --- rank --- */

/* Phi_u at a nearby position that satisfies the constraints; false when none was found */
static bool nearby(Assembly *a, LevelRows *level, uint64_t *seed, double *q, double *residual)
{
    const Rows rows = level_rows(level, a->setting->watch);
    bool met;

    for (int i = 0; i < a->l->n; i++)
        q[i] = a->y[i] + 1e-2 * random_unit(seed);
    met = initial_meet(&rows, NULL, q, residual);
    if (met)
        a->eq->position(a->eq->context, 0, q);
    return met;
}

/* rank of the rows at the current position */
static Status rank_here(const Assembly *a, double threshold, int *rank, int *order)
{
    return rank_columns(a->eq->rows, a->eq->phi_u, threshold, a->setting->watch, rank, order);
}

/* Independent rows, from the assembled position and two near it: a rank that is lower at one
 * position only is a singularity, not a redundancy. */
static Status find_rank(Assembly *a, Diag *diag)
{
    const VariableIndex *l = a->l;
    int *order = NEW_ARRAY(int, l->m);
    double *q = NEW_ARRAY(double, l->n);
    double *residual = NEW_ARRAY(double, l->m);
    LevelRows *level = NULL;
    uint64_t seed = 7;
    int here, best;
    Status status = OK;

    a->eq->position(a->eq->context, 0, a->y);
    CHECK(rank_here(a, ASSEMBLED_RANK, &here, a->out->rows));
    best = here;
    if (best < l->m)
        CHECK(level_rows_new(LEVEL_POSITION, l, a->eq, a->parameters, NULL, 0, &level, diag));
    for (int k = 0; k < 2 && best < l->m; k++) {
        int rank;

        level->y = a->y;
        if (!nearby(a, level, &seed, q, residual))
            continue;
        CHECK(rank_here(a, 1e-7, &rank, order));
        if (rank > best) {
            best = rank;
            memcpy(a->out->rows, order, (size_t)l->m * sizeof(int));
        }
    }
    a->out->row_count = best;
    if (here < best)
        remarks_add(&a->out->remarks,
                    (Remark){.kind = REMARK_START_SINGULAR, .count = here, .of = best});
    if (best < l->m) {
        double *phi_u;

        /* at a singular initial position, the rank nearby counts */
        if (here == best)
            a->eq->position(a->eq->context, 0, a->y);
        phi_u = pattern_spread(a->eq->rows, a->eq->phi_u);
        redundant_remark(l->system, phi_u, a->out->rows, best, &a->out->remarks);
        mem_free(phi_u);
    }
done:
    level_rows_free(level);
    MEM_FREE(order, q, residual);
    return status;
}

Status initial_find(const VariableIndex *layout, Parameters *parameters, CompiledEquations *numbers,
                    const SimulationInput *setting, bool has_modes, Assembled *out, Diag *diag)
{
    Assembly a = {.l = layout,
                  .parameters = parameters,
                  .numbers = numbers,
                  .eq = compiled_equations(numbers),
                  .setting = setting,
                  .has_modes = has_modes,
                  .out = out};
    bool closed;
    Status status = OK;

    monitor_report(setting->watch, "assembling", -1);
    *out = (Assembled){
        .y = NEW_ARRAY(double, variable_index_references(layout) + layout->multi_turns + 1),
        .network = NEW_ARRAY(double, layout->nx + layout->nz),
        .guess = NEW_ARRAY(double, layout->nz),
        .rows = NEW_ARRAY(int, layout->m)};
    a.y = out->y;
    a.kinematic_tree = kinematic_tree_new(layout, parameters);
    CHECK(initial_read_given(&a, diag));
    CHECK(initial_place(&a, &closed, diag));
    CHECK(find_position(&a, closed, diag));
    equations_turn(a.eq, 0, a.y, a.y + variable_index_references(layout));
    CHECK(find_rank(&a, diag));
    CHECK(find_velocity(&a, diag));
    CHECK(initial_find_network(&a, diag));
done:
    /* a search that was cancelled fails with various errors */
    if (monitor_poll(setting->watch) != OK)
        status = diag_set(diag, E_STOPPED, "stopped while the start was looked for");
    kinematic_tree_free(a.kinematic_tree);
    MEM_FREE(a.given, a.own);
    return status;
}

void initial_free(Assembled *start)
{
    MEM_FREE(start->y, start->network, start->guess, start->rows);
    remarks_free(&start->remarks);
    *start = (Assembled){0};
}
