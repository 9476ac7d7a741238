/* trees.c: programs of accelerations along the trees, chosen or not, and what a run takes */
#include "trees.h"

#include "../unit/form.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/reduced/along_trees.h"
#include "formulate/system/system_impl.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/motion.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct TreesModel {
    Model *model;
    System *system;
    VariableIndex *layout;
    Parameters parameters;
};

static double parameter(void *model, Expr symbol)
{
    return model_parameter_value(model, symbol);
}

static Status build(TreesModel *trees, const char *text, Diag *diag)
{
    size_t next = 0;

    trees->model = model_new();
    while (next < strlen(text)) {
        Statement *statement = NULL;
        Status status = statement_parse(text, 1, (SyntaxOptions){0}, &next, &statement, diag);

        if (status == OK)
            status = model_apply(trees->model, statement, diag);
        statement_free(statement);
        TRY(status);
    }
    return form_system(trees->model, &trees->system, diag);
}

TreesModel *trees_open(const char *text, char *message, size_t room)
{
    TreesModel *trees = NEW(TreesModel);
    Diag diag = {0};

    if (build(trees, text, &diag) != OK) {
        (void)snprintf(message, room, "%s", diag.message);
        trees_close(trees);
        return NULL;
    }
    trees->layout = variable_index_new(trees->system);
    trees->parameters = (Parameters){.value = parameter, .context = trees->model};
    return trees;
}

void trees_close(TreesModel *trees)
{
    if (trees == NULL)
        return;
    parameters_free(&trees->parameters);
    variable_index_free(trees->layout);
    system_free(trees->system);
    model_free(trees->model);
    mem_free(trees);
}

/* which coordinate of the system each name is */
static int *order_of(const TreesModel *trees, const char names[][TREES_NAME], int n)
{
    int *order = NEW_ARRAY(int, n);

    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            if (strcmp(system_q(trees->system, i)->name, names[j]) == 0)
                order[j] = i;
    return order;
}

static double *state(const int *order, const double *q, const double *u, int n)
{
    double *y = NEW_ARRAY(double, 2 * n + 1);

    for (int j = 0; j < n; j++) {
        y[order[j]] = q[j];
        y[n + order[j]] = u[j];
    }
    return y;
}

static TreesAnswer evaluate(TreesModel *trees, const Expr *told, const double *y, const int *order,
                            int n, double *out)
{
    const RowValues row = {.q = y, .u = y + n};
    Probe *probe = NULL;

    if (probe_new(trees->layout, &trees->parameters, told, n, &probe, NULL) != OK)
        return TREES_FAILED;
    for (int j = 0; j < n; j++)
        out[j] = probe_values(probe, &row)[order[j]];
    probe_free(probe);
    return TREES_FOUND;
}

TreesAnswer trees_way(TreesModel *trees, int number, const char names[][TREES_NAME],
                      const double *q, const double *u, int n, double *out, char *what, size_t room)
{
    const EliminationOrder way = {(Delay)(number / 4 % 3), number % 2 == 1, number % 4 > 1};
    const bool moves = number >= 12;
    Groups *groups = system_nu(trees->system) == n ? groups_new(trees->system) : NULL;
    Expr *told = NEW_ARRAY(Expr, 3 * n);
    int *order = order_of(trees, names, n);
    double *y = state(order, q, u, n);
    TreesAnswer answer = TREES_FAILED;

    (void)snprintf(what, room, "delay %d, merges %d, ends merged %d, inertia moved %d", way.delay,
                   way.merges, way.ends_merged, moves);
    if (groups != NULL && moves)
        groups_move_inertia(trees->system->arena, groups);
    if (groups == NULL)
        answer = TREES_HAVE_NONE;
    else if (system_pushes(trees->system, told + 2 * n, NULL) == OK &&
             accelerations_along(trees->system, groups, &way, told + 2 * n, told, told + n))
        answer = evaluate(trees, told, y, order, n, out);
    groups_free(groups);
    MEM_FREE(told, order, y);
    return answer;
}

/* whether an integrator is told the same accelerations, bit by bit, before and behind others */
static bool rate_is_same(Motion *motion, const System *system, const double *y,
                         const double *acceleration)
{
    const Ode *ode = motion_ode(motion);
    const int n = system_n(system), nu = system_nu(system);
    const size_t size = (size_t)(ode->n + ode->quadratures) * sizeof(double);
    double *rate = NEW_ARRAY(double, ode->n + ode->quadratures);
    double *away = NEW_ARRAY(double, ode->n + ode->quadratures);
    bool same = true;

    memcpy(away, y, size);
    away[0] += 0.25;
    for (int again = 0; again < 2; again++) {
        same = same && ode->rate(ode->context, 0, away, rate);
        same = same && ode->rate(ode->context, 0, y, rate) &&
               memcmp(rate + n, acceleration, (size_t)nu * sizeof(double)) == 0;
    }
    MEM_FREE(rate, away);
    return same;
}

/* What a run solves, where rows that may be dropped are kept for their multipliers: accelerations,
 * then multipliers. */
static TreesAnswer solve(TreesModel *trees, const int *rows, int row_count, const double *y,
                         double *out)
{
    const int n = system_nu(trees->system);
    CompiledEquations *numbers = NULL;
    Motion *motion = NULL;
    TreesAnswer answer = TREES_FAILED;
    Solved solved;

    if (compiled_new(trees->layout, &trees->parameters, &numbers, NULL) == OK) {
        motion =
            motion_new(compiled_equations(numbers),
                       &(MotionOptions){.rows = rows, .row_count = row_count, .tolerance = 1e-9});
        if (motion_solve(motion, 0, y, &solved)) {
            memcpy(out, solved.acceleration, (size_t)n * sizeof(double));
            if (row_count > 0)
                memcpy(out + n, solved.multipliers, (size_t)row_count * sizeof(double));
            if (row_count > 0 || rate_is_same(motion, trees->system, y, out))
                answer = TREES_FOUND;
        }
    }
    motion_free(motion);
    compiled_free(numbers);
    return answer;
}

TreesAnswer trees_run(TreesModel *trees, const char names[][TREES_NAME], const double *q,
                      const double *u, int n, double *out)
{
    int *order = order_of(trees, names, n);
    double *y = state(order, q, u, n), *found = NEW_ARRAY(double, n);
    const TreesAnswer answer = solve(trees, NULL, 0, y, found);

    for (int j = 0; j < n && answer == TREES_FOUND; j++)
        out[j] = found[order[j]];
    MEM_FREE(order, y, found);
    return answer;
}

TreesAnswer trees_torques(TreesModel *trees, int number, const char names[][TREES_NAME],
                          const double *q, const double *u, const double *acceleration, int n,
                          double *out, char *what, size_t room)
{
    const EliminationOrder way = {DELAY_NONE, number % 2 == 1, number % 4 > 1};
    const bool is_one_pass = number == TREES_TORQUES - 1, moves = number >= 4;
    Groups *groups =
        system_nu(trees->system) == n && !is_one_pass ? groups_new(trees->system) : NULL;
    Arena *arena = system_arena(trees->system);
    Expr *told = NEW_ARRAY(Expr, 3 * n), *pushes = told + n, *asked = told + 2 * n;
    int *order = order_of(trees, names, n);
    double *y = state(order, q, u, n);
    TreesAnswer answer = TREES_HAVE_NONE;

    (void)snprintf(what, room, "torques, %s, merges %d, ends merged %d, inertia moved %d",
                   is_one_pass ? "frame by frame" : "over groups", way.merges, way.ends_merged,
                   moves);
    for (int j = 0; j < n; j++)
        asked[order[j]] = expr_real(arena, acceleration[j]);
    if (is_one_pass && dynamics_lack(trees->system, asked, told))
        answer = evaluate(trees, told, y, order, n, out);
    if (groups != NULL && moves)
        groups_move_inertia(arena, groups);
    if (groups != NULL && system_pushes(trees->system, pushes, NULL) == OK) {
        efforts_along(trees->system, groups, &way, asked, told);
        for (int j = 0; j < n; j++)
            told[j] = expr_sub(arena, told[j], pushes[j]);
        answer = evaluate(trees, told, y, order, n, out);
    }
    groups_free(groups);
    MEM_FREE(told, order, y);
    return answer;
}

TreesAnswer trees_driven(TreesModel *trees, const char names[][TREES_NAME], const double *q,
                         const double *u, int n, double *out)
{
    int *order = order_of(trees, names, n), *rows = NEW_ARRAY(int, n);
    double *y = state(order, q, u, n), *found = NEW_ARRAY(double, 2 * n);
    TreesAnswer answer = TREES_FAILED;

    for (int k = 0; k < n; k++)
        rows[k] = k;
    if (system_m(trees->system) == n)
        answer = solve(trees, rows, n, y, found);
    for (int k = 0; k < n && answer == TREES_FOUND; k++) {
        const char *driver =
            system_instance_name(trees->system, system_constraint(trees->system, k)->instance);

        out[atoi(driver + 1)] = -found[n + k];
    }
    MEM_FREE(order, rows, y, found);
    return answer;
}
