/* session_parameter_search.c: unknown parameters, and runs with values of them */
#include "session/session_parameter_search.h"

#include "base/clock.h"
#include "base/worker_processes.h"
#include "language/verbs.h"
#include "session/session_limits.h"

#include <math.h>

/* of the runs, where the statement has no rtol= */
#define SEARCH_RTOL 1e-10

const Syntax *statement_key(const Statement *statement, const char *name)
{
    for (int i = 0; i < statement->pairs.count; i++)
        if (strcmp(statement->pairs.at[i].name, name) == 0)
            return statement->pairs.at[i].value;
    return NULL;
}

int syntax_list_count(const Syntax *list)
{
    return list == NULL ? 0 : list->kind == SYNTAX_VECTOR ? list->count : 1;
}

const Syntax *syntax_list_item(const Syntax *list, int i)
{
    return list->kind == SYNTAX_VECTOR ? list->args[i] : list;
}

Status parameter_search_read(ParameterSearch *out, ct_session *session, const Statement *statement,
                             const char *purpose, const char *hint, Diag *diag)
{
    const Statement *rest = statement->rest;

    *out = (ParameterSearch){.session = session,
                             .statement = statement,
                             .hint = hint,
                             .overrides = model_override_count(session->model),
                             .runs = session->runs.count};
    if (sweep_analysis(rest) == NULL) {
        (void)diag_at(diag, E_VALUE, rest->place, "'%s' computes nothing that could %s",
                      rest->verb != NULL ? rest->verb : rest->text, purpose);
        diag_hint(diag, "simulate, kinematics, inverse, assemble, equilibrium, op, linearize and "
                        "modes may stand after the colon");
        return E_VALUE;
    }
    return sweep_jobs(session, statement, &out->jobs, &out->has_jobs, diag);
}

void parameter_search_free(ParameterSearch *search)
{
    LIST_FREE(search->unknowns);
}

/* --- unknowns --- */

static Status refuse_unknown(const ParameterSearch *search, const char *name, int primes,
                             Place place, Diag *diag)
{
    const Model *model = search->session->model;
    Suggest suggest = suggest_for(name);

    for (int i = 0; i < model_parameter_count(model); i++) {
        Expr definition;

        suggest_offer(&suggest, expr_name(model_parameter(model, i, &definition)));
    }
    for (int i = 0; verb_key(&search->statement->row, i) != NULL; i++)
        suggest_offer(&suggest, verb_key(&search->statement->row, i));
    (void)diag_at(diag, E_NAME, place, "there is no parameter '%s%.*s'", name,
                  primes < 9 ? primes : 9, "'''''''''");
    suggest_or_hint(&suggest, diag,
                    "a value of a part or an initial value is one by a name: P = 1, then 'set' or "
                    "'init' with P");
    return E_NAME;
}

static Status check_unknown(const ParameterSearch *search, const char *name, int primes,
                            Place place, Diag *diag)
{
    const Model *model = search->session->model;

    if (primes > 0 || !model_has_parameter(model, name))
        return refuse_unknown(search, name, primes, place, diag);
    for (int i = 0; i < model_override_count(model); i++)
        if (strcmp(model_override_name(model, i), name) == 0)
            return diag_at(diag, E_VALUE, place, "%s is set by -D", name);
    for (int i = 0; i < search->unknowns.count; i++)
        if (strcmp(search->unknowns.at[i].name, name) == 0)
            return diag_at(diag, E_NAME, place, "%s is there twice", name);
    return OK;
}

static double value_now(const ct_session *session, const char *name)
{
    const Model *model = session->model;

    for (int i = 0; i < model_parameter_count(model); i++) {
        Expr definition;
        const Expr symbol = model_parameter(model, i, &definition);

        if (strcmp(expr_name(symbol), name) == 0)
            return model_parameter_value(model, symbol);
    }
    return NAN;
}

static Status add_unknown(ParameterSearch *search, const char *name, int primes, Place place,
                          Diag *diag)
{
    SearchUnknown unknown = {.name = name, .place = place, .low = -INFINITY, .high = INFINITY};

    TRY(check_unknown(search, name, primes, place, diag));
    unknown.start = value_now(search->session, name);
    if (!isfinite(unknown.start))
        return diag_at(diag, E_VALUE, place, "%s has no value to start from", name);
    LIST_PUSH(search->unknowns, unknown);
    return OK;
}

/* k=[LOW, HIGH] */
static Status add_bounded(ParameterSearch *search, const Pair *pair, Diag *diag)
{
    const Syntax *value = pair->value;
    double bounds[2];
    SearchUnknown *unknown;

    TRY(add_unknown(search, pair->name, pair->primes, pair->name_place, diag));
    unknown = &search->unknowns.at[search->unknowns.count - 1];
    if (value->kind != SYNTAX_VECTOR || value->count != 2 || value->has_unit) {
        (void)diag_at(diag, E_VALUE, value->place, "%s= takes two bounds", pair->name);
        diag_hint(diag, "%s=[LOW, HIGH]; without bounds: %s %s ..", pair->name,
                  search->statement->verb, pair->name);
        return E_VALUE;
    }
    for (int i = 0; i < 2; i++) {
        TRY(sweep_number(search->session, pair->name, value->args[i], &bounds[i], diag));
        if (isnan(bounds[i]))
            return diag_at(diag, E_VALUE, value->args[i]->place, "this bound of %s has no value",
                           pair->name);
    }
    if (!(bounds[0] < bounds[1]))
        return diag_at(diag, E_VALUE, value->place,
                       "the lower bound of %s, %g, is not below the upper one, %g", pair->name,
                       bounds[0], bounds[1]);
    unknown->low = bounds[0];
    unknown->high = bounds[1];
    unknown->start = fmin(fmax(unknown->start, unknown->low), unknown->high);
    return OK;
}

static bool is_key(const Statement *statement, const char *name)
{
    for (int i = 0; verb_key(&statement->row, i) != NULL; i++)
        if (strcmp(verb_key(&statement->row, i), name) == 0)
            return true;
    return false;
}

Status parameter_search_read_unknowns(ParameterSearch *search, Diag *diag)
{
    const Statement *s = search->statement;

    for (int i = 0; i < s->operands.count; i++) {
        const Syntax *operand = s->operands.at[i].value;

        if (operand->kind != SYNTAX_VARIABLE || operand->has_unit)
            return diag_at(diag, E_NAME, operand->place, "this is no parameter");
        TRY(add_unknown(search, operand->text, operand->primes, operand->place, diag));
    }
    for (int i = 0; i < s->pairs.count; i++)
        if (!is_key(s, s->pairs.at[i].name))
            TRY(add_bounded(search, &s->pairs.at[i], diag));
    if (search->unknowns.count > 0)
        return OK;
    (void)diag_at(diag, E_MISSING, s->verb_place, "no parameter is to be found");
    diag_hint(diag, "%s", search->hint);
    return E_MISSING;
}

/* --- one run --- */

void parameter_search_begin(ParameterSearch *search)
{
    ct_session *session = search->session;

    focus_put_aside(session, &search->focus);
    search->progress = session->watch.progress;
    session->watch.progress = NULL; /* the phases of each run are of no interest */
    session->is_sweeping = true;
    session->run_rtol = SEARCH_RTOL;
}

void parameter_search_end(ParameterSearch *search)
{
    ct_session *session = search->session;

    focus_clear(session, search->runs);
    session->is_sweeping = false;
    session->run_rtol = 0;
    session->watch.progress = search->progress;
    focus_restore(session, &search->focus);
}

static Status set_unknowns(const ParameterSearch *search, const double *x, Diag *diag)
{
    Model *model = search->session->model;

    for (int i = 0; i < search->unknowns.count; i++)
        model_override(model, search->unknowns.at[i].name, x[i]);
    for (int i = 0; i < search->unknowns.count; i++)
        TRY(model_check_parameter(model, search->unknowns.at[i].name, diag));
    return OK;
}

Status parameter_search_run(ParameterSearch *search, const double *x, Diag *diag)
{
    ct_session *session = search->session;

    focus_clear(session, search->runs);
    TRY(monitor_poll(&session->watch));
    TRY(set_unknowns(search, x, diag));
    return sweep_analysis(search->statement->rest)(session, search->statement->rest, diag);
}

void parameter_search_forget(const ParameterSearch *search)
{
    model_drop_overrides(search->session->model, search->overrides);
}

/* --- runs at several points --- */

typedef struct PointRuns {
    ParameterSearch *search;
    const double *points;
    double *out;
    bool *is_made;
    Diag *whys; /* of each: status OK where it has values */
    int made, count;
    bool is_stopped;
} PointRuns;

static const double *point_at(const PointRuns *runs, int which)
{
    return runs->points + (ptrdiff_t)which * runs->search->unknowns.count;
}

static double *values_at(const PointRuns *runs, int which)
{
    return runs->out + (ptrdiff_t)which * runs->search->values;
}

static Status run_point(ParameterSearch *search, const double *x, double *out, Diag *diag)
{
    Diag why = {0};
    Status status;

    CHECK(parameter_search_run(search, x, &why));
    CHECK(search->read(search, out, &why));
done:
    parameter_search_forget(search);
    *diag = why;
    diag->status = status;
    return status;
}

/* whether there may be another one */
static bool take_values(PointRuns *runs, int which, const Diag *why)
{
    runs->whys[which] = *why;
    runs->is_made[which] = true;
    runs->made++;
    if (why->status != OK)
        values_at(runs, which)[0] = NAN;
    return why->status == OK || sweep_is_of_one_run(why->status);
}

static void work_on_point(void *context, int which, void *result)
{
    PointRuns *runs = context;
    Diag *why = result;
    double *values = NEW_ARRAY(double, runs->search->values);

    runs->search->session->watch.stop = NULL;
    (void)run_point(runs->search, point_at(runs, which), values, why);
    memcpy((char *)result + sizeof *why, values, (size_t)runs->search->values * sizeof *values);
    mem_free(values);
}

static void take_point(void *context, int which, const void *result)
{
    PointRuns *runs = context;
    Diag why;

    memcpy(&why, result, sizeof why);
    memcpy(values_at(runs, which), (const char *)result + sizeof why,
           (size_t)runs->search->values * sizeof(double));
    (void)take_values(runs, which, &why);
}

static void lose_point(void *context, int which, const char *text)
{
    Diag why = {0};

    (void)diag_set(&why, E_SOLVER, "%s", text);
    (void)take_values(context, which, &why);
}

static bool has_to_stop(void *context)
{
    PointRuns *runs = context;

    runs->is_stopped = monitor_poll(&runs->search->session->watch) != OK;
    return runs->is_stopped;
}

/* whether the time that workers save is longer than it takes to start them */
static bool is_worth_workers(const ParameterSearch *search, int count)
{
#ifdef COTREE_FAULTS
    return false;
#endif
    return search->jobs > 1 && count > 1 && search->evaluations > 0 &&
           (search->has_jobs || search->run_time * (count - 1) > SWEEP_WORKERS);
}

static void run_in_workers(PointRuns *runs)
{
    const ParameterSearch *search = runs->search;
    const WorkPlan plan = {.end = runs->count,
                           .workers = search->jobs < runs->count ? search->jobs : runs->count,
                           .size = sizeof(Diag) + (size_t)search->values * sizeof(double),
                           .piece = work_on_point,
                           .take = take_point,
                           .lose = lose_point,
                           .stop = has_to_stop,
                           .context = runs};

    worker_processes_do(&plan);
}

static Status run_here(PointRuns *runs)
{
    ParameterSearch *search = runs->search;

    for (int i = 0; i < runs->count; i++) {
        const double began = clock_now();
        Diag why = {0};

        if (runs->is_made[i])
            continue;
        (void)run_point(search, point_at(runs, i), values_at(runs, i), &why);
        search->run_time = clock_now() - began;
        if (why.status == E_STOPPED)
            return why.status;
        transaction_stop_asking(); /* there is something to lose */
        if (!take_values(runs, i, &why))
            return OK;
    }
    return OK;
}

/* the first of them that ends the search; *diag is its message */
static Status first_failure(PointRuns *runs, Diag *diag)
{
    ParameterSearch *search = runs->search;

    for (int i = 0; i < runs->count; i++) {
        const Diag *why = &runs->whys[i];

        if (why->status == OK)
            continue;
        if (!sweep_is_of_one_run(why->status)) {
            *diag = *why;
            return why->status;
        }
        if (search->why.status == OK)
            search->why = *why;
    }
    return OK;
}

Status parameter_search_evaluate(void *context, int count, const double *points, double *out,
                                 Diag *diag)
{
    ParameterSearch *search = context;
    const ct_hooks *hooks = &search->session->hooks;
    PointRuns runs = {.search = search,
                      .points = points,
                      .count = count,
                      .is_made = NEW_ARRAY(bool, count),
                      .whys = NEW_ARRAY(Diag, count)};
    Status status;

    runs.out = out;
    if (is_worth_workers(search, count))
        run_in_workers(&runs);
    status = runs.is_stopped ? E_STOPPED : run_here(&runs);
    search->evaluations += runs.made;
    if (hooks->progress != NULL)
        hooks->progress(hooks->context, search->statement->verb, -1);
    if (status == OK)
        status = first_failure(&runs, diag);
    MEM_FREE(runs.is_made, runs.whys);
    return status;
}

/* --- what is found --- */

Status parameter_search_define(const ParameterSearch *search, const double *x, Diag *diag)
{
    ct_session *session = search->session;
    const Statement *s = search->statement;
    const uint64_t revision = model_revision(session->model);
    const int group = model_begin_group(session->model);
    Text text = {0};
    int count;
    Status status;

    for (int i = 0; i < search->unknowns.count; i++) {
        const char *name = search->unknowns.at[i].name;
        Text unit = {0};

        session_unit(session, name, &unit);
        text_addf(&text, "%s = %.17g", name, x[i]);
        if (unit.length > 0)
            text_addf(&text, " [%s]", unit.at);
        text_char(&text, '\n');
        text_free(&unit);
    }
    status = session_apply_text(session->model, text.at, &count, diag);
    session_end_group(session, group, s->verb, revision, status == OK);
    if (status != OK)
        diag->place = s->verb_place;
    text_free(&text);
    return status;
}

Status parameter_search_run_last(const ParameterSearch *search, Diag *diag)
{
    const Statement *rest = search->statement->rest;

    return sweep_analysis(rest)(search->session, rest, diag);
}

Status parameter_search_stopped(const ParameterSearch *search, Diag *diag)
{
    return diag_set(diag, E_STOPPED, "stopped in run %d: the best values so far are kept",
                    search->evaluations);
}
