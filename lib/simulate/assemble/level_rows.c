/* level_rows.c: rows of the system, then of expressions, and the motion of unknowns */
#include "simulate/assemble/level_rows.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

int level_first(const VariableIndex *l, StateLevel level)
{
    return level == LEVEL_POSITION ? 0 : level == LEVEL_VELOCITY ? l->n : l->n + l->nu;
}

int level_count(const VariableIndex *l, StateLevel level)
{
    const int counts[LEVEL_COUNT] = {[LEVEL_POSITION] = l->n,
                                     [LEVEL_VELOCITY] = l->nu,
                                     [LEVEL_NETWORK] = 2 * l->nx + l->nz,
                                     [LEVEL_STATES] = l->nx};

    return counts[level];
}

/* new */
static Expr *unknowns_of(const VariableIndex *l, StateLevel level)
{
    const int count = level_count(l, level);
    const int first = level == LEVEL_POSITION ? l->q : level == LEVEL_VELOCITY ? l->u : l->x;
    Expr *out;

    if (level == LEVEL_NETWORK)
        return variable_index_network(l);
    out = NEW_ARRAY(Expr, count);
    memcpy(out, l->symbols + first, (size_t)count * sizeof(Expr));
    return out;
}

/* whether a speed moves a coordinate */
static bool maps(const LevelRows *rows, int coordinate, int speed)
{
    return !expr_is(system_n_entry(rows->l->system, coordinate, speed), 0);
}

static void list_entries(LevelRows *rows)
{
    const bool is_mapped = rows->level == LEVEL_POSITION && rows->eq->map != NULL;
    typedef LIST(int) CompiledEquations;
    CompiledEquations slope = {0}, by = {0}, speed = {0};
    int count;
    const Slope *slopes = residual_slopes(probe_residual(rows->probe), &count);

    for (int k = 0; k < count; k++)
        for (int j = 0; j < (is_mapped ? rows->l->nu : 1); j++) {
            if (is_mapped && !maps(rows, slopes[k].unknown, j))
                continue;
            LIST_PUSH(slope, k);
            LIST_PUSH(by, is_mapped ? slopes[k].unknown : -1);
            LIST_PUSH(speed, is_mapped ? j : slopes[k].unknown);
        }
    rows->entries = slope.count;
    rows->slope = slope.at;
    rows->by = by.at;
    rows->speed = speed.at;
    rows->at = NEW_ARRAY(int, rows->entries);
    rows->is_row = NEW_ARRAY(bool, rows->count);
}

Status level_rows_new(StateLevel level, const VariableIndex *l, const Equations *eq,
                      Parameters *parameters, const Expr *wanted, int count, LevelRows **out,
                      Diag *diag)
{
    LevelRows *rows = NEW(LevelRows);
    Expr *unknowns = unknowns_of(l, level);
    const ProbeOrder order = {.roots = wanted,
                              .root_count = count,
                              .row_count = count,
                              .unknowns = unknowns,
                              .unknown_count = level_count(l, level)};
    Status status = OK;

    rows->l = l;
    rows->eq = eq;
    rows->level = level;
    rows->system_rows = level == LEVEL_POSITION   ? l->position_rows
                        : level == LEVEL_VELOCITY ? l->m
                                                  : 0;
    rows->count = count;
    rows->target = NEW_ARRAY(double, count);
    rows->place = NEW_ARRAY(double, l->n + l->nu + 2 * l->nx + l->nz);
    CHECK(probe_make(l, parameters, &order, &rows->probe, diag));
    list_entries(rows);
    *out = rows;
    rows = NULL;
done:
    level_rows_free(rows);
    mem_free(unknowns);
    return status;
}

void level_rows_free(LevelRows *rows)
{
    if (rows == NULL)
        return;
    probe_free(rows->probe);
    pattern_free(&rows->pattern);
    MEM_FREE(rows->target, rows->place, rows->slope, rows->by, rows->speed, rows->is_row, rows->at,
             rows);
}

/* --- evaluation --- */

static void evaluate_system(const LevelRows *rows, double *residual, double *jacobian)
{
    const Equations *eq = rows->eq;
    const double *u = rows->place + eq->n;

    if (rows->level == LEVEL_POSITION) {
        eq->position(eq->context, rows->t, rows->place);
        memcpy(residual, eq->phi, (size_t)rows->system_rows * sizeof(double));
    } else {
        eq->velocity(eq->context, u, u + eq->nu);
        for (int k = 0; k < eq->m; k++)
            residual[k] = pattern_dot(eq->rows, eq->phi_u, k, u) - eq->nu_rate[k];
    }
    if (jacobian != NULL)
        memcpy(jacobian, eq->phi_u, (size_t)eq->rows->start[rows->system_rows] * sizeof(double));
}

/* in the order of the pattern */
static void put_slopes(const LevelRows *rows, const double *slopes, double *jacobian)
{
    const Equations *eq = rows->eq;

    for (int k = 0; k < rows->entries; k++) {
        const int by = rows->by[k];

        if (rows->at[k] >= 0)
            jacobian[rows->at[k]] +=
                slopes[rows->slope[k]] *
                (by >= 0 ? pattern_at(eq->maps, eq->map, rows->speed[k], by) : 1);
    }
}

static void evaluate_expressions(const LevelRows *rows, double *residual, double *jacobian)
{
    const VariableIndex *l = rows->l;
    const double *tail = rows->place + l->n + l->nu + l->nx;
    RowValues at = row_of_state(l, rows->t, rows->place);
    const double *values;

    at.references = rows->y + variable_index_references(l);
    at.rates = tail;
    at.z = tail + l->nx;
    values = probe_values(rows->probe, &at);
    for (int i = 0; i < rows->count; i++)
        if (!isnan(rows->target[i]))
            *residual++ = values[i] - rows->target[i];
    if (jacobian != NULL)
        put_slopes(rows, values + rows->count, jacobian);
}

static int columns_of(const LevelRows *rows)
{
    return rows->level == LEVEL_POSITION ? rows->l->nu : level_count(rows->l, rows->level);
}

static void evaluate(void *context, const double *v, double *residual, double *jacobian)
{
    const LevelRows *rows = context;
    const VariableIndex *l = rows->l;

    memcpy(rows->place, rows->y, (size_t)(l->n + l->nu + l->nx) * sizeof(double));
    memcpy(rows->place + level_first(l, rows->level), v,
           (size_t)level_count(l, rows->level) * sizeof(double));
    if (jacobian != NULL)
        memset(jacobian, 0, (size_t)rows->pattern.count * sizeof(double));
    if (rows->level <= LEVEL_VELOCITY)
        evaluate_system(rows, residual, jacobian);
    if (rows->count > 0)
        evaluate_expressions(rows, residual + rows->system_rows, jacobian);
}

static void move_position(void *context, double *v, const double *step)
{
    const Equations *eq = ((const LevelRows *)context)->eq;

    for (int i = 0; i < eq->n; i++)
        v[i] += eq->map == NULL ? step[i] : pattern_dot(eq->maps, eq->map, i, step);
    equations_normalise(eq, v);
}

/* Rows of the system come first, with the pattern of Phi_u, so that its entries are copied. */
static void find_pattern(LevelRows *rows, int count)
{
    const Pattern *system = rows->system_rows > 0 ? rows->eq->rows : NULL;
    const int of_system = system != NULL ? system->start[rows->system_rows] : 0;
    const int most = of_system + rows->entries;
    int *row = NEW_ARRAY(int, 3 * most), *column = row + most, *place = column + most;
    int *number = NEW_ARRAY(int, rows->count), next = rows->system_rows, terms = of_system;
    int listed = 0;
    const Slope *slopes = residual_slopes(probe_residual(rows->probe), &listed);

    for (int i = 0; i < rows->count; i++) {
        rows->is_row[i] = !isnan(rows->target[i]);
        number[i] = rows->is_row[i] ? next++ : -1;
    }
    for (int k = 0; k < of_system; k++) {
        row[k] = system->row[k];
        column[k] = system->column[k];
    }
    for (int k = 0; k < rows->entries; k++) {
        const int own = number[slopes[rows->slope[k]].row];

        rows->at[k] = own >= 0 ? terms : -1;
        if (own < 0)
            continue;
        row[terms] = rows->speed[k];
        column[terms++] = own;
    }
    pattern_free(&rows->pattern);
    rows->pattern = pattern_of(columns_of(rows), count, terms, row, column, place);
    for (int k = 0; k < rows->entries; k++)
        rows->at[k] = rows->at[k] >= 0 ? place[rows->at[k]] : -1;
    MEM_FREE(row, number);
}

/* whether the pattern is that of the current targets */
static bool has_pattern(const LevelRows *rows)
{
    bool same = rows->pattern.start != NULL;

    for (int i = 0; i < rows->count && same; i++)
        same = rows->is_row[i] == !isnan(rows->target[i]);
    return same;
}

Rows level_rows(LevelRows *rows, const CallMonitor *watch)
{
    Rows out = {.rows = rows->system_rows,
                .columns = columns_of(rows),
                .length = level_count(rows->l, rows->level),
                .context = rows,
                .pattern = &rows->pattern,
                .evaluate = evaluate,
                .move = rows->level == LEVEL_POSITION ? move_position : NULL,
                .watch = watch};

    for (int i = 0; i < rows->count; i++)
        out.rows += !isnan(rows->target[i]);
    if (!has_pattern(rows)) {
        mem_keep(rows);
        mem_keep(rows->at);
        mem_keep(rows->is_row);
        find_pattern(rows, out.rows);
    }
    return out;
}
