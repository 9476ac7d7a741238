/* level_rows.c: rows of the system, then of expressions, and how unknowns move */
#include "simulate/assemble/level_rows.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

int level_first(const Layout *l, StateLevel level)
{
    return level == LEVEL_POSITION ? 0 : level == LEVEL_VELOCITY ? l->n : l->n + l->nu;
}

int level_count(const Layout *l, StateLevel level)
{
    const int counts[LEVEL_COUNT] = {[LEVEL_POSITION] = l->n,
                                     [LEVEL_VELOCITY] = l->nu,
                                     [LEVEL_NETWORK] = 2 * l->nx + l->nz,
                                     [LEVEL_STATES] = l->nx};

    return counts[level];
}

/* new */
static Expr *unknowns_of(const Layout *l, StateLevel level)
{
    const int count = level_count(l, level);
    const int first = level == LEVEL_POSITION ? l->q : level == LEVEL_VELOCITY ? l->u : l->x;
    Expr *out;

    if (level == LEVEL_NETWORK)
        return layout_network(l);
    out = NEW_ARRAY(Expr, count);
    memcpy(out, l->symbols + first, (size_t)count * sizeof(Expr));
    return out;
}

Status level_rows_new(StateLevel level, const Layout *l, const Equations *eq,
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
    rows->system_rows = level <= LEVEL_VELOCITY ? l->m : 0;
    rows->count = count;
    rows->target = NEW_ARRAY(double, count);
    rows->place = NEW_ARRAY(double, l->n + l->nu + 2 * l->nx + l->nz);
    CHECK(probe_make(l, parameters, &order, &rows->probe, diag));
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
    MEM_FREE(rows->target, rows->place, rows);
}

/* --- evaluation --- */

static void evaluate_system(const LevelRows *rows, double *residual, double *jacobian)
{
    const Equations *eq = rows->eq;
    const double *u = rows->place + eq->n;

    if (rows->level == LEVEL_POSITION) {
        eq->position(eq->context, rows->t, rows->place);
        memcpy(residual, eq->phi, (size_t)eq->m * sizeof(double));
    } else {
        eq->velocity(eq->context, u, u + eq->nu);
        for (int k = 0; k < eq->m; k++)
            residual[k] = pattern_dot(eq->rows, eq->phi_u, k, u) - eq->nu_rate[k];
    }
    if (jacobian != NULL)
        pattern_fill(eq->rows, eq->phi_u, jacobian);
}

/* a derivative by an unknown as those by the directions of motion, added to a row */
static void add_slope(const LevelRows *rows, int unknown, double slope, double *row)
{
    const Equations *eq = rows->eq;

    if (rows->level != LEVEL_POSITION || eq->map == NULL)
        row[unknown] += slope;
    else
        for (int j = 0; j < eq->nu; j++)
            row[j] += slope * eq->map[unknown * eq->nu + j];
}

static void evaluate_expressions(const LevelRows *rows, int columns, double *residual,
                                 double *jacobian)
{
    const Layout *l = rows->l;
    const double *tail = rows->place + l->n + l->nu + l->nx;
    RowValues at = row_of_state(l, rows->t, rows->place);
    const double *values;
    int count, k = 0;
    const Slope *slopes = residual_slopes(probe_residual(rows->probe), &count);

    at.references = rows->y + layout_references(l);
    at.rates = tail;
    at.z = tail + l->nx;
    values = probe_values(rows->probe, &at);
    for (int i = 0; i < rows->count; i++) {
        const bool is_row = !isnan(rows->target[i]);

        if (is_row)
            *residual++ = values[i] - rows->target[i];
        if (is_row && jacobian != NULL)
            memset(jacobian, 0, (size_t)columns * sizeof(double));
        for (; k < count && slopes[k].row == i; k++)
            if (is_row && jacobian != NULL)
                add_slope(rows, slopes[k].unknown, values[rows->count + k], jacobian);
        if (is_row && jacobian != NULL)
            jacobian += columns;
    }
}

static int columns_of(const LevelRows *rows)
{
    return rows->level == LEVEL_POSITION ? rows->l->nu : level_count(rows->l, rows->level);
}

static void evaluate(void *context, const double *v, double *residual, double *jacobian)
{
    const LevelRows *rows = context;
    const Layout *l = rows->l;
    const int columns = columns_of(rows);

    memcpy(rows->place, rows->y, (size_t)(l->n + l->nu + l->nx) * sizeof(double));
    memcpy(rows->place + level_first(l, rows->level), v,
           (size_t)level_count(l, rows->level) * sizeof(double));
    if (rows->level <= LEVEL_VELOCITY)
        evaluate_system(rows, residual, jacobian);
    if (rows->count > 0)
        evaluate_expressions(rows, columns, residual + rows->system_rows,
                             jacobian != NULL ? jacobian + rows->system_rows * columns : NULL);
}

static void move_position(void *context, double *v, const double *step)
{
    const Equations *eq = ((const LevelRows *)context)->eq;

    for (int i = 0; i < eq->n; i++) {
        v[i] += eq->map == NULL ? step[i] : 0;
        for (int j = 0; eq->map != NULL && j < eq->nu; j++)
            v[i] += eq->map[i * eq->nu + j] * step[j];
    }
    equations_normalise(eq, v);
}

Rows level_rows(LevelRows *rows, const Watch *watch)
{
    Rows out = {.rows = rows->system_rows,
                .columns = columns_of(rows),
                .length = level_count(rows->l, rows->level),
                .context = rows,
                .evaluate = evaluate,
                .move = rows->level == LEVEL_POSITION ? move_position : NULL,
                .watch = watch};

    for (int i = 0; i < rows->count; i++)
        out.rows += !isnan(rows->target[i]);
    return out;
}
