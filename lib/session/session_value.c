/* session_value.c: what a formula is worth: at an instant, or over the rows of a run */
#include "session/session_impl.h"

#include "session/session_limits.h"

#include <assert.h>
#include <float.h>
#include <math.h>

typedef struct LeafValues {
    const Formula *formula;
    const double *values; /* one a leaf */
} LeafValues;

static double leaf_value(void *context, Expr symbol)
{
    const LeafValues *values = context;

    for (int i = 0; i < values->formula->leaves.count; i++)
        if (values->formula->leaves.at[i].symbol == symbol)
            return values->values[i];
    return NAN;
}

static double join(const Formula *formula, const double *values)
{
    LeafValues leaves = {formula, values};

    if (formula->leaves.count == 1 && formula->whole == formula->leaves.at[0].symbol)
        return values[0] * formula->scale;
    return expr_evaluate(formula->whole, leaf_value, &leaves) * formula->scale;
}

static Run *leaf_run(ct_session *session, const Leaf *leaf, Run *source)
{
    return leaf->run >= 0 ? session->runs.at + leaf->run : source;
}

double session_row_time(const Result *result, double t)
{
    const double *times = result_times(result);
    int low = 0, high = result_rows(result) - 1;

    while (high - low > 1) {
        const int middle = (low + high) / 2;

        if (times[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    for (int i = low; i <= high; i++)
        if (fabs(times[i] - t) <= ROW_TIME * (times[high] - times[low]) + TIME_ROUNDING * fabs(t))
            return times[i];
    return t;
}

static double run_end(const Run *run)
{
    return result_times(run->result)[result_rows(run->result) - 1];
}

/* a leaf of parameters and numbers alone needs no run */
static bool needs_run(const Leaf *leaf)
{
    return leaf->kind == LEAF_SENSITIVITY ||
           (leaf->kind != LEAF_CONSTANT &&
            (expr_kinds(leaf->expr) & ~(1U << SYMBOL_PARAMETER)) != 0);
}

bool formula_needs_run(const Formula *formula)
{
    for (int i = 0; i < formula->leaves.count; i++)
        if (needs_run(formula->leaves.at + i) && formula->leaves.at[i].run < 0)
            return true;
    return false;
}

/* an instant of one run that another hasn't */
static Status refuse_instant(const Leaf *leaf, const Result *result, double at, Diag *diag)
{
    const double *times = result_times(result);
    const int rows = result_rows(result);

    (void)diag_set(diag, E_VALUE, "run%d has no value at t = %.6g s: it goes from %.6g to %.6g s",
                   leaf->run + 1, at, rows > 0 ? times[0] : 0, rows > 0 ? times[rows - 1] : 0);
    diag_hint(diag, "runs are compared at the instants of the last of them: make that the shorter "
                    "one, or ask 'at' an instant of both");
    diag_about(diag, "run%d.", leaf->run + 1);
    return E_VALUE;
}

/* If a formula uses the ends of several runs at different instants, add a remark. */
static void remark_ends(ct_session *session, const Formula *formula, Run *source)
{
    const Run *first = NULL;

    for (int i = 0; i < formula->leaves.count; i++) {
        const Leaf *leaf = formula->leaves.at + i;
        const Run *run = needs_run(leaf) ? leaf_run(session, leaf, source) : NULL;
        double end, other;
        Text line = {0};

        if (run == NULL)
            continue;
        first = first != NULL ? first : run;
        end = result_times(first->result)[result_rows(first->result) - 1];
        other = result_times(run->result)[result_rows(run->result) - 1];
        if (end == other)
            continue;
        text_addf(&line,
                  "each run is taken at its own end, %.6g s and %.6g s; 'at' takes one "
                  "instant of both",
                  end, other);
        session_remark(session, line.at);
        text_free(&line);
        return;
    }
}

/* values of a leaf that is no number, at ascending instants of its run */
static Status leaf_values(ct_session *session, const Leaf *leaf, Run *run, const double *times,
                          int rows, double *out, Diag *diag)
{
    switch (leaf->kind) {
    case LEAF_INTEGRAL:
        return result_reader_integrals(run->reader, &leaf->expr, 1, times, rows, &session->watch,
                                       out, diag);
    case LEAF_SENSITIVITY:
        return session_sensitivities(session, run, &leaf->expr, 1, &leaf->by, 1, times, rows, out,
                                     diag);
    default:
        return result_reader_values_along(run->reader, leaf->expr, times, rows, &session->watch,
                                          out, diag);
    }
}

/* the value of a leaf at an instant of its run, or at its end */
static Status evaluate_leaf(ct_session *session, const Leaf *leaf, Run *run, const double *at,
                            double *out, Diag *diag)
{
    const double *times;
    double instant;
    Status status;

    if (leaf->kind == LEAF_CONSTANT) {
        *out = leaf->value;
        return OK;
    }
    if (!needs_run(leaf)) {
        *out =
            leaf->run >= 0 ? run_number(run, leaf->expr) : model_number(session->model, leaf->expr);
        return OK;
    }
    times = result_times(run->result);
    instant = at != NULL ? session_row_time(run->result, *at) : times[result_rows(run->result) - 1];
    status = leaf->kind == LEAF_VARIABLE
                 ? result_reader_values_at(run->reader, &leaf->expr, 1, instant, out, diag)
                 : leaf_values(session, leaf, run, &instant, 1, out, diag);
    return status == E_VALUE && leaf->run >= 0 && at != NULL
               ? refuse_instant(leaf, run->result, *at, diag)
               : status;
}

Status formula_value(ct_session *session, const Formula *formula, Run *source, const double *at,
                     double *out, Diag *diag)
{
    double *values = NEW_ARRAY(double, formula->leaves.count);
    Status status = OK;

    if (at == NULL)
        remark_ends(session, formula, source);
    for (int i = 0; i < formula->leaves.count; i++) {
        const Leaf *leaf = formula->leaves.at + i;

        CHECK(evaluate_leaf(session, leaf, leaf_run(session, leaf, source), at, &values[i], diag));
    }
    *out = join(formula, values);
done:
    mem_free(values);
    return status;
}

/* --- noise --- */

/* numbers of a leaf's parameters, each a rounding larger or smaller */
typedef struct Shaken {
    ct_session *session;
    Run *run;
    bool up;
} Shaken;

static double shaken_number(void *context, Expr symbol)
{
    const Shaken *shaken = context;
    const double value = shaken->run != NULL ? run_number(shaken->run, symbol)
                                             : model_number(shaken->session->model, symbol);

    return value * (shaken->up == (expr_symbol_number(symbol) % 2 == 0) ? 1 + DBL_EPSILON
                                                                        : 1 - DBL_EPSILON);
}

/* how far rounding leaves a leaf open at an instant of its run */
static Status leaf_rounding(ct_session *session, const Leaf *leaf, Run *run, double at,
                            double value, double *out, Diag *diag)
{
    *out = DBL_EPSILON * fabs(value);
    if (leaf->kind == LEAF_CONSTANT || leaf->kind == LEAF_SENSITIVITY)
        return OK;
    if (needs_run(leaf)) {
        double open;

        assert(run != NULL);
        TRY(result_reader_rounding(run->reader, leaf->expr, &at, 1, &open, diag));
        if (leaf->kind == LEAF_INTEGRAL)
            open *= at - result_times(run->result)[0];
        *out = fmax(*out, open);
        return OK;
    }
    for (int up = 0; up < 2; up++) {
        Shaken shaken = {session, leaf->run >= 0 ? run : NULL, up != 0};

        *out = fmax(*out, fabs(expr_evaluate(leaf->expr, shaken_number, &shaken) - value));
    }
    return OK;
}

bool formula_may_be_rounding(const Syntax *item, double value)
{
    const bool is_shown_in = item->has_unit && item->kind != SYNTAX_NUMBER;

    return value != 0 && fabs(value) * (is_shown_in ? item->unit.factor : 1) <= NOISE_LARGEST;
}

Status formula_rounding(ct_session *session, const Formula *formula, Run *source, const double *at,
                        double *out, Diag *diag)
{
    const int count = formula->leaves.count;
    double *values = NEW_ARRAY(double, count), *open = NEW_ARRAY(double, count);
    double most = 0;
    Status status = OK;

    for (int i = 0; i < count; i++) {
        const Leaf *leaf = formula->leaves.at + i;
        Run *run = leaf_run(session, leaf, source);
        const double instant = at != NULL ? *at : run != NULL ? run_end(run) : 0;

        CHECK(evaluate_leaf(session, leaf, run, &instant, &values[i], diag));
        CHECK(leaf_rounding(session, leaf, run, instant, values[i], &open[i], diag));
    }
    /* each leaf by itself: they are off independently */
    for (int i = 0; i < count; i++) {
        const double here = join(formula, values), held = values[i];

        values[i] = held + open[i];
        most += fabs(join(formula, values) - here);
        values[i] = held;
    }
    *out = most;
done:
    MEM_FREE(values, open);
    return status;
}

Status formula_round(ct_session *session, const Formula *formula, Run *source, const double *at,
                     double *value, Diag *diag)
{
    double open;

    TRY(formula_rounding(session, formula, source, at, &open, diag));
    if (fabs(*value) <= NOISE_ROUNDINGS * open)
        *value = 0;
    return OK;
}

Run *formula_grid(ct_session *session, const Formula *formulas, int count, Run *source)
{
    Run *grid = NULL;

    for (int f = 0; f < count; f++)
        for (int i = 0; i < formulas[f].leaves.count; i++) {
            const Leaf *leaf = formulas[f].leaves.at + i;
            Run *run = leaf_run(session, leaf, source);

            if (!needs_run(leaf))
                continue;
            /* names without a run decide; with runs of several lists the first one is used */
            if (grid == NULL || run == source)
                grid = run;
        }
    return grid != NULL ? grid : source;
}

/* columns of the leaves of one run on its own rows, all in one pass */
static Status own_rows(const Formula *formulas, int count, Run *run, ct_session *session,
                       Run *source, double **columns, int rows, Diag *diag)
{
    LIST(Expr) items = {0};
    LIST(int) places = {0};
    double *values = NULL;
    Status status = OK;
    int place = 0;

    for (int f = 0; f < count; f++)
        for (int i = 0; i < formulas[f].leaves.count; i++, place++) {
            const Leaf *leaf = formulas[f].leaves.at + i;

            if (leaf->kind == LEAF_VARIABLE && leaf_run(session, leaf, source) == run) {
                LIST_PUSH(items, leaf->expr);
                LIST_PUSH(places, place);
            }
        }
    if (items.count > 0) {
        values = mem_array((size_t)rows * (size_t)items.count, sizeof *values);
        CHECK(result_reader_values(run->reader, items.at, items.count, values, diag));
        for (int r = 0; r < rows; r++)
            for (int i = 0; i < items.count; i++)
                columns[places.at[i]][r] = values[(size_t)r * (size_t)items.count + (size_t)i];
    }
done:
    LIST_FREE(items);
    LIST_FREE(places);
    mem_free(values);
    return status;
}

/* a leaf of a run along given times; an instant outside the run fails */
static Status leaf_along(ct_session *session, const Leaf *leaf, Run *run, const double *times,
                         int rows, double *out, Diag *diag)
{
    double *snapped = NEW_ARRAY(double, rows);
    Status status;

    for (int r = 0; r < rows; r++)
        snapped[r] = session_row_time(run->result, times[r]);
    status = leaf_values(session, leaf, run, snapped, rows, out, diag);
    mem_free(snapped);
    for (int r = 0; status == E_VALUE && r < rows; r++)
        TRY(evaluate_leaf(session, leaf, run, &times[r], &out[r], diag));
    return status;
}

/* the place of an expression in a list, which it joins */
static int place_among(Expr *list, int *count, Expr e)
{
    for (int i = 0; i < *count; i++)
        if (list[i] == e)
            return i;
    list[*count] = e;
    return (*count)++;
}

/* columns of the sensitivities of one run: all items by all parameters, in one pass */
static Status sensitivity_rows(ct_session *session, const Formula *formulas, int count, Run *run,
                               Run *source, const double *times, double **columns, int rows,
                               Diag *diag)
{
    LIST(int) places = {0};
    LIST(int) pairs = {0}; /* number of the item, then of the parameter */
    Expr *items, *parameters;
    double *snapped = NEW_ARRAY(double, rows), *values = NULL;
    int leaves = 0, item_count = 0, parameter_count = 0, place = 0;
    Status status = OK;

    for (int f = 0; f < count; f++)
        leaves += formulas[f].leaves.count;
    items = NEW_ARRAY(Expr, leaves);
    parameters = NEW_ARRAY(Expr, leaves);
    for (int f = 0; f < count; f++)
        for (int i = 0; i < formulas[f].leaves.count; i++, place++) {
            const Leaf *leaf = formulas[f].leaves.at + i;

            if (leaf->kind != LEAF_SENSITIVITY || leaf_run(session, leaf, source) != run)
                continue;
            LIST_PUSH(places, place);
            LIST_PUSH(pairs, place_among(items, &item_count, leaf->expr));
            LIST_PUSH(pairs, place_among(parameters, &parameter_count, leaf->by));
        }
    for (int r = 0; r < rows; r++)
        snapped[r] = session_row_time(run->result, times[r]);
    values = mem_array((size_t)rows * (size_t)item_count * (size_t)parameter_count, sizeof *values);
    CHECK(session_sensitivities(session, run, items, item_count, parameters, parameter_count,
                                snapped, rows, values, diag));
    for (int k = 0; k < places.count; k++)
        for (int r = 0; r < rows; r++)
            columns[places.at[k]][r] =
                values[((ptrdiff_t)r * item_count + pairs.at[2 * k]) * parameter_count +
                       pairs.at[2 * k + 1]];
done:
    LIST_FREE(places);
    LIST_FREE(pairs);
    MEM_FREE(items, parameters, snapped, values);
    return status;
}

/* columns of the other leaves, at given times */
static Status other_rows(ct_session *session, const Formula *formulas, int count, const Run *own,
                         Run *source, const double *times, double **columns, int rows, Diag *diag)
{
    const Run *prepared = NULL, *differentiated = NULL;
    int place = 0;

    for (int f = 0; f < count; f++)
        for (int i = 0; i < formulas[f].leaves.count; i++, place++) {
            const Leaf *leaf = formulas[f].leaves.at + i;
            Run *run = leaf_run(session, leaf, source);

            if (leaf->kind == LEAF_VARIABLE && run == own)
                continue;
            if (leaf->kind == LEAF_SENSITIVITY) {
                if (run != differentiated)
                    TRY(sensitivity_rows(session, formulas, count, run, source, times, columns,
                                         rows, diag));
                differentiated = run;
                continue;
            }
            if (leaf->kind == LEAF_INTEGRAL) {
                TRY(leaf_along(session, leaf, run, times, rows, columns[place], diag));
                prepared = NULL; /* its own instants were prepared */
                continue;
            }
            if (leaf->kind == LEAF_VARIABLE && needs_run(leaf) && run != prepared) {
                TRY(result_reader_prepare(run->reader, times, rows, &session->watch, diag));
                prepared = run;
            }
            if (leaf->kind == LEAF_VARIABLE && needs_run(leaf)) {
                TRY(leaf_along(session, leaf, run, times, rows, columns[place], diag));
                continue;
            }
            for (int r = 0; r < rows; r++) {
                TRY(monitor_poll(&session->watch));
                TRY(evaluate_leaf(session, leaf, run, &times[r], &columns[place][r], diag));
            }
        }
    return OK;
}

static void join_rows(const Formula *formulas, int count, double **columns, int rows, double *out,
                      int stride, int first)
{
    int place = 0;

    for (int f = 0; f < count; f++) {
        const int leaves = formulas[f].leaves.count;
        double *values = NEW_ARRAY(double, leaves);

        for (int r = 0; r < rows; r++) {
            for (int i = 0; i < leaves; i++)
                values[i] = columns[place + i][r];
            out[(size_t)r * (size_t)stride + (size_t)(first + f)] = join(&formulas[f], values);
        }
        place += leaves;
        mem_free(values);
    }
}

Status formula_rows(ct_session *session, const Formula *formulas, int count, Run *grid, Run *source,
                    const double *times, int rows, double *out, int stride, int first, Diag *diag)
{
    int leaves = 0;
    double **columns;
    Status status = OK;

    for (int f = 0; f < count; f++)
        leaves += formulas[f].leaves.count;
    columns = NEW_ARRAY(double *, leaves);
    for (int i = 0; i < leaves; i++)
        columns[i] = NEW_ARRAY(double, rows);
    if (times == NULL)
        CHECK(own_rows(formulas, count, grid, session, source, columns, rows, diag));
    CHECK(other_rows(session, formulas, count, times == NULL ? grid : NULL, source,
                     times == NULL ? result_times(grid->result) : times, columns, rows, diag));
    join_rows(formulas, count, columns, rows, out, stride, first);
done:
    for (int i = 0; i < leaves; i++)
        mem_free(columns[i]);
    mem_free(columns);
    return status;
}
