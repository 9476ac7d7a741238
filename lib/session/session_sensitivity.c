/* session_sensitivity.c: d(h)/d(L): derivatives along a run by parameters of the model
 *
 * The equations read parameters of the model, of which some are defined by others:
 *
 *     d s / d p = sum over j of (d definition of s / d s_j) d s_j / d p
 *
 * The start is assembled again with other values of each parameter, and extrapolated from central
 * difference quotients of three steps; what constraints determine of it follows exactly
 * (simulate/sensitivity). */
#include "session/session_impl.h"

#include "session/session_limits.h"
#include "simulate/sensitivity/sensitivity.h"

#include <math.h>
#include <string.h>

/* --- syntax --- */

static bool is_differential(const ct_session *session, const Syntax *syntax)
{
    int arguments;
    const Expr *names;

    return syntax->kind == SYNTAX_CALL && strcmp(syntax->text, "d") == 0 && syntax->primes == 0 &&
           model_law(session->model, "d", &names, &arguments) == NULL;
}

/* the numerator in a*d(h), -d(h), d(h); NULL: there is none */
static const Syntax *numerator_of(const ct_session *session, const Syntax *syntax)
{
    while (syntax->kind == SYNTAX_UNARY ||
           (syntax->kind == SYNTAX_BINARY && strcmp(syntax->text, "*") == 0))
        syntax = syntax->args[syntax->count - 1];
    return is_differential(session, syntax) ? syntax : NULL;
}

bool sensitivity_is_called(const ct_session *session, const Syntax *syntax)
{
    return is_differential(session, syntax) ||
           (syntax->kind == SYNTAX_BINARY && strcmp(syntax->text, "/") == 0 &&
            is_differential(session, syntax->args[1]) &&
            numerator_of(session, syntax->args[0]) != NULL);
}

static Status refuse_alone(const Syntax *syntax, Diag *diag)
{
    (void)diag_at(diag, E_SYNTAX, syntax->place, "d(..) stands in a derivative, d(h)/d(L)");
    diag_hint(diag, "d(h)/d(L) of a variable h of a run by a parameter L of the model");
    return E_SYNTAX;
}

Expr session_parameter(const ct_session *session, const char *name)
{
    const Model *model = session->model;
    Expr definition, symbol = NULL;

    for (int i = 0; i < model_parameter_count(model); i++) {
        symbol = model_parameter(model, i, &definition);
        if (strcmp(expr_name(symbol), name) == 0)
            return symbol;
    }
    return NULL;
}

Status sensitivity_read(ct_session *session, const Syntax *syntax, const Syntax **item,
                        const Syntax **numerator, Expr *parameter, Diag *diag)
{
    const Syntax *by;

    if (syntax->kind == SYNTAX_CALL || syntax->args[1]->count != 1)
        return refuse_alone(syntax, diag);
    *numerator = syntax->args[0];
    *item = numerator_of(session, syntax->args[0]);
    if ((*item)->count != 1)
        return refuse_alone(*item, diag);
    *item = (*item)->args[0];
    by = syntax->args[1]->args[0];
    *parameter = by->kind == SYNTAX_VARIABLE && by->primes == 0
                     ? session_parameter(session, by->text)
                     : NULL;
    if (*parameter != NULL)
        return OK;
    (void)diag_at(diag, E_NAME, by->place, "a derivative is by a parameter, which this is not");
    diag_hint(diag, "an initial value or a value of a part is one by a name: A = 30 deg, "
                    "init h = A, then d(h)/d(A)");
    return E_NAME;
}

/* --- parameters --- */

/* the parameters of a model, and their derivatives by some of them */
typedef struct ParameterSlopes {
    int count;       /* of parameters of the model */
    Expr *symbols;   /* of each */
    double *weights; /* count x parameters */
} ParameterSlopes;

static double number_of(void *context, Expr symbol)
{
    return model_parameter_value(context, symbol);
}

/* the derivative of a definition by what it is made of, for one parameter */
static double slope_of(const Model *model, Expr definition, const ParameterSlopes *slopes,
                       const double *weights, int stride)
{
    Arena *arena = model_arena(model);
    Expr *symbols = NULL;
    const int count = expr_symbols(&definition, 1, &symbols);
    double sum = 0;

    for (int i = 0; i < count; i++)
        for (int k = 0; k < slopes->count; k++)
            if (slopes->symbols[k] == symbols[i] && weights[(ptrdiff_t)k * stride] != 0)
                sum += weights[(ptrdiff_t)k * stride] *
                       expr_evaluate(expr_diff(arena, definition, symbols[i]), number_of,
                                     (void *)model);
    mem_free(symbols);
    return sum;
}

/* Definitions contain earlier ones at most as deep as there are parameters: passes until nothing
 * changes. */
static void find_weights(const Model *model, Expr parameter, const ParameterSlopes *slopes,
                         double *weights, int stride)
{
    bool changes = true;

    for (int i = 0; i < slopes->count; i++)
        weights[(ptrdiff_t)i * stride] = slopes->symbols[i] == parameter;
    for (int pass = 0; pass < slopes->count && changes; pass++) {
        changes = false;
        for (int i = 0; i < slopes->count; i++) {
            Expr definition;
            double slope;

            if (model_parameter(model, i, &definition) == parameter || expr_is_number(definition))
                continue;
            slope = slope_of(model, definition, slopes, weights, stride);
            changes = changes || slope != weights[(ptrdiff_t)i * stride];
            weights[(ptrdiff_t)i * stride] = slope;
        }
    }
}

static void slopes_open(const Model *model, const Expr *parameters, int count, ParameterSlopes *out)
{
    out->count = model_parameter_count(model);
    out->symbols = NEW_ARRAY(Expr, out->count);
    out->weights = NEW_ARRAY(double, out->count *count);
    for (int i = 0; i < out->count; i++) {
        Expr definition;

        out->symbols[i] = model_parameter(model, i, &definition);
    }
    for (int p = 0; p < count; p++)
        find_weights(model, parameters[p], out, out->weights + p, count);
}

/* only those that move */
static void slopes_shorten(ParameterSlopes *slopes, int count)
{
    int used = 0;

    for (int i = 0; i < slopes->count; i++) {
        bool moves = false;

        for (int p = 0; p < count; p++)
            moves = moves || slopes->weights[i * count + p] != 0;
        if (!moves)
            continue;
        slopes->symbols[used] = slopes->symbols[i];
        memmove(slopes->weights + (ptrdiff_t)used * count, slopes->weights + (ptrdiff_t)i * count,
                (size_t)count * sizeof(double));
        used++;
    }
    slopes->count = used;
}

/* --- the start --- */

/* (q, u, x, references) at the start where a parameter has another value; name NULL: none has */
static Status start_at(ct_session *session, const Run *run, const char *name, double value,
                       int length, double *out, Diag *diag)
{
    System *system = result_system(run->result);
    const int overrides = model_override_count(session->model);
    RunInput input = {0};
    Result *result = NULL;
    ResultReader *reader = NULL;
    const double *y;
    Status status;

    if (name != NULL)
        model_override(session->model, name, value);
    run_input_make(session, system, &input);
    CHECK(run_assemble(system, &input.setting, &result, &reader, diag));
    if (result_reader_start(reader, &y) == length)
        memcpy(out, y, (size_t)length * sizeof(double));
    else
        status = diag_set(diag, E_ASSEMBLE, "the start has other states");
done:
    model_drop_overrides(session->model, overrides);
    result_reader_free(reader);
    result_free(result);
    run_input_free(&input);
    return status;
}

static Status start_quotient(ct_session *session, const Run *run, const char *name, double value,
                             double step, int length, double *out, Diag *diag)
{
    double *low = NEW_ARRAY(double, length);
    Status status;

    CHECK(start_at(session, run, name, value - step, length, low, diag));
    CHECK(start_at(session, run, name, value + step, length, out, diag));
    for (int i = 0; i < length; i++)
        out[i] = (out[i] - low[i]) / (2 * step);
done:
    mem_free(low);
    return status;
}

/* Derivatives of the start by one parameter, times its size: 0 where it doesn't move, else
 * quotients with steps h, h/2, h/4, extrapolated to 0 (their errors are series in h^2). */
static Status start_slope(ct_session *session, const Run *run, const char *name, double value,
                          double size, int length, double *out, Diag *diag)
{
    enum { LEVELS = 3 };
    double *table = NEW_ARRAY(double, LEVELS *length);
    double step = SENSITIVITY_STEP * size;
    const double *start;
    Diag why = {0};
    Status status = OK;

    (void)result_reader_start(run->reader, &start);
    if (start_at(session, run, name, value + step, length, table, &why) == OK &&
        memcmp(table, start, (size_t)length * sizeof(double)) == 0) {
        memset(out, 0, (size_t)length * sizeof(double));
        goto done;
    }
    for (int level = 0; level < LEVELS; level++, step /= 2) {
        double *row = table + (ptrdiff_t)level * length;

        status = start_quotient(session, run, name, value, step, length, row, &why);
        if (status == E_STOPPED)
            CHECK(diag_set(diag, status, "%s", why.message));
        if (status != OK)
            CHECK(diag_set(diag, E_ASSEMBLE,
                           "the start can't be assembled where %s is a little larger or smaller: "
                           "%s",
                           name, why.message));
    }
    for (int level = 1; level < LEVELS; level++)
        for (int k = LEVELS - 1; k >= level; k--)
            for (int i = 0; i < length; i++) {
                const double finer = table[k * length + i], coarser = table[(k - 1) * length + i];

                table[k * length + i] = finer + (finer - coarser) / (pow(4, level) - 1);
            }
    for (int i = 0; i < length; i++)
        out[i] = table[(LEVELS - 1) * length + i] * size;
done:
    mem_free(table);
    return status;
}

/* --- derivatives --- */

/* whether the parameters have the values of the run, and the model its equations and its start */
static Status is_current(ct_session *session, const Run *run, bool *out, Diag *diag)
{
    const Model *model = session->model;
    System *system;
    double *now = NULL;
    const double *then;
    int length;
    Status status = OK;

    *out = false;
    CHECK(session_running(session, &system, diag));
    if (system != result_system(run->result))
        goto done;
    for (int i = 0; i < model_parameter_count(model); i++) {
        Expr definition;
        const Expr symbol = model_parameter(model, i, &definition);

        if (run_number(run, symbol) != model_parameter_value(model, symbol))
            goto done;
    }
    length = result_reader_start(run->reader, &then);
    now = NEW_ARRAY(double, length);
    if (start_at(session, run, NULL, 0, length, now, diag) == OK)
        *out = memcmp(now, then, (size_t)length * sizeof(double)) == 0;
    else if (diag->status == E_STOPPED)
        status = E_STOPPED;
done:
    mem_free(now);
    return status;
}

/* A run needs the model that it was made of, also for what is assembled anew. */
static Status refuse_old(ct_session *session, const Run *run, Diag *diag)
{
    const bool is_last =
        session->runs.count > 0 && run == &session->runs.at[session->runs.count - 1];
    bool current = run == &session->start || (is_last && !session->changed);

    if (!current && model_event_count(session->model) == 0)
        TRY(is_current(session, run, &current, diag));
    if (current)
        return OK;
    (void)diag_set(diag, E_MISSING, "sensitivities are of the last run of the model as it is");
    diag_hint(diag, is_last ? "the model has changed: 'simulate' once more"
                            : "'simulate' makes that run the last one");
    return E_MISSING;
}

Status session_sensitivities(ct_session *session, Run *run, const Expr *items, int item_count,
                             const Expr *parameters, int count, const double *times, int rows,
                             double *out, Diag *diag)
{
    ParameterSlopes slopes = {0};
    RunInput input = {0};
    SensitivityOrder order = {.watch = &session->watch};
    double *sizes = NEW_ARRAY(double, count), *start = NULL;
    const double *y;
    int length;
    Status status = OK;

    CHECK(refuse_old(session, run, diag));
    slopes_open(session->model, parameters, count, &slopes);
    slopes_shorten(&slopes, count);
    run_input_make(session, result_system(run->result), &input);
    length = result_reader_start(run->reader, &y);
    start = NEW_ARRAY(double, length *count);
    for (int p = 0; p < count; p++) {
        const double value = model_parameter_value(session->model, parameters[p]);

        sizes[p] = value != 0 ? fabs(value) : 1;
        CHECK(start_slope(session, run, expr_name(parameters[p]), value, sizes[p], length,
                          start + (ptrdiff_t)p * length, diag));
    }
    order.by = (SensitivityParameters){.count = count,
                                       .sizes = sizes,
                                       .symbol_count = slopes.count,
                                       .symbols = slopes.symbols,
                                       .weights = slopes.weights};
    order.start = start;
    order.events = input.events;
    order.event_count = input.setting.event_count;
    CHECK(sensitivity_find(run->reader, &order, items, item_count, times, rows, out, diag));
done:
    MEM_FREE(slopes.symbols, slopes.weights, sizes, start);
    run_input_free(&input);
    return status;
}
