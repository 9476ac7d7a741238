/* session_optimise.c: `optimise`
 *
 * A run has 1 + constraints values: the figure, with its sign reversed if it is to be maximised,
 * and of each constraint the difference of its sides, which is to be 0 at most, or 0. */
#include "session/session_parameter_search.h"

#include "base/clock.h"
#include "simulate/fit/optimiser.h"

#include <math.h>

static const char hint[] = "optimise k=[0, 20] minimise=max(h) subject=[period(h) <= 2] : "
                           "simulate 5";
/* of constraints, relative to the sizes of their sides at the start */
static const double tolerance = 1e-7;
/* runs, unless the statement says otherwise; the most */
enum { RUNS = 5000 };
static const double most_runs = 1e7;

typedef struct OptimiseConstraint {
    const Syntax *syntax; /* a comparison */
    double sign;          /* of left - right in what is to be 0 at most */
    bool is_equality;
} OptimiseConstraint;

typedef struct OptimiseWork {
    ParameterSearch search;
    const Syntax *figure;
    bool is_maximum;
    LIST(OptimiseConstraint) constraints;
    OptimiserMethod method;
    int most_runs;
    double *scales; /* 1 + constraints */
    double start;   /* the figure there */
} OptimiseWork;

static const OptimiseWork *work_of(const ParameterSearch *search)
{
    return (const OptimiseWork *)search;
}

/* --- what is asked for --- */

static Status read_figure(OptimiseWork *work, Diag *diag)
{
    const Statement *s = work->search.statement;
    const Syntax *least = statement_key(s, "minimise"), *most = statement_key(s, "maximise");

    if ((least == NULL) == (most == NULL)) {
        (void)diag_at(diag, E_MISSING, least == NULL ? s->verb_place : least->place,
                      least == NULL ? "minimise= or maximise= is missing: a figure of the run"
                                    : "either minimise= or maximise= can be met, not both");
        diag_hint(diag, "%s", hint);
        return E_MISSING;
    }
    work->is_maximum = most != NULL;
    work->figure = most != NULL ? most : least;
    if (work->figure->kind == SYNTAX_VECTOR)
        return diag_at(diag, E_VALUE, work->figure->place, "one figure is optimised, not a list");
    return OK;
}

static Status read_constraint(OptimiseWork *work, const Syntax *syntax, Diag *diag)
{
    static const char *const signs[] = {"<", "<=", ">", ">=", "=="};
    OptimiseConstraint constraint = {.syntax = syntax};

    for (int i = 0; syntax->kind == SYNTAX_BINARY && i < COUNT(signs); i++)
        if (strcmp(syntax->text, signs[i]) == 0) {
            constraint.sign = syntax->text[0] == '>' ? -1 : 1;
            constraint.is_equality = syntax->text[0] == '=';
        }
    if (constraint.sign == 0) {
        (void)diag_at(diag, E_VALUE, syntax->place, "a constraint compares two figures");
        diag_hint(diag, "subject=[max(h) <= 0.5, period(h) == 2 s]");
        return E_VALUE;
    }
    TRY(model_check_alike(work->search.session->model, syntax->args[0], syntax->args[1], diag));
    LIST_PUSH(work->constraints, constraint);
    return OK;
}

static Status read_method(OptimiseWork *work, Diag *diag)
{
    const Syntax *value = statement_key(work->search.statement, "method");
    const char *word = value != NULL && value->kind == SYNTAX_VARIABLE ? value->text : "";

    if (value == NULL)
        return OK;
    for (OptimiserMethod i = 0; i < OPTIMISER_METHODS; i++)
        if (strcmp(word, optimiser_name(i)) == 0) {
            work->method = i;
            return OK;
        }
    return diag_at(diag, E_VALUE, value->place, "method= is one of both, slsqp, cobyla");
}

static Status read_runs(OptimiseWork *work, Diag *diag)
{
    const Syntax *value = statement_key(work->search.statement, "runs");
    double number;

    work->most_runs = RUNS;
    if (value == NULL)
        return OK;
    TRY(session_number(work->search.session, value, &number, diag));
    if (!(number >= 1 && number <= most_runs) || number != floor(number))
        return diag_at(diag, E_VALUE, value->place, "runs is a whole number from 1 to %.0f, not %g",
                       most_runs, number);
    work->most_runs = (int)number;
    return OK;
}

static Status read_statement(OptimiseWork *work, ct_session *session, const Statement *s,
                             Diag *diag)
{
    const Syntax *subject = statement_key(s, "subject");

    TRY(parameter_search_read(&work->search, session, s, "be optimised", hint, diag));
    TRY(parameter_search_read_unknowns(&work->search, diag));
    TRY(read_figure(work, diag));
    for (int i = 0; i < syntax_list_count(subject); i++)
        TRY(read_constraint(work, syntax_list_item(subject, i), diag));
    TRY(read_method(work, diag));
    return read_runs(work, diag);
}

/* --- values of a run --- */

static Status read_sides(const OptimiseWork *work, int i, double sides[2], Diag *diag)
{
    for (int k = 0; k < 2; k++)
        TRY(session_value_at(work->search.session, work->constraints.at[i].syntax->args[k], NULL,
                             &sides[k], diag));
    return OK;
}

static Status read_values(const ParameterSearch *search, double *out, Diag *diag)
{
    const OptimiseWork *work = work_of(search);

    TRY(session_value_at(search->session, work->figure, NULL, &out[0], diag));
    out[0] *= work->is_maximum ? -1 : 1;
    for (int i = 0; i < work->constraints.count; i++) {
        double sides[2];

        TRY(read_sides(work, i, sides, diag));
        out[1 + i] = work->constraints.at[i].sign * (sides[0] - sides[1]);
    }
    return OK;
}

static double scale_of(double value)
{
    return value != 0 ? fabs(value) : 1;
}

/* The first run fails where the user can see why. The sizes of its values are their scales. */
static Status read_start(OptimiseWork *work, Diag *diag)
{
    const Syntax *wrong = NULL;

    TRY(session_value_at(work->search.session, work->figure, NULL, &work->start, diag));
    work->scales[0] = scale_of(work->start);
    if (!isfinite(work->start))
        wrong = work->figure;
    for (int i = 0; i < work->constraints.count && wrong == NULL; i++) {
        double sides[2];

        TRY(read_sides(work, i, sides, diag));
        work->scales[1 + i] = scale_of(fmax(fabs(sides[0]), fabs(sides[1])));
        if (!isfinite(sides[0]) || !isfinite(sides[1]))
            wrong = work->constraints.at[i].syntax->args[isfinite(sides[0])];
    }
    if (wrong != NULL)
        return diag_at(diag, E_VALUE, wrong->place,
                       "this has no value in the first run, from which the search starts");
    return OK;
}

static Status first_run(OptimiseWork *work, const double *x, Diag *diag)
{
    Status status;

    CHECK(parameter_search_run(&work->search, x, diag));
    CHECK(read_start(work, diag));
done:
    parameter_search_forget(&work->search);
    return status;
}

static Status search_from(OptimiseWork *work, OptimiserSolution **out, Diag *diag)
{
    const int n = work->search.unknowns.count, m = work->constraints.count;
    double *numbers = NEW_ARRAY(double, 3 * n);
    bool *is_equality = NEW_ARRAY(bool, m + 1);
    const OptimiserProblem problem = {.unknowns = n,
                                      .constraints = m,
                                      .start = numbers,
                                      .low = numbers + n,
                                      .high = numbers + (ptrdiff_t)2 * n,
                                      .is_equality = is_equality,
                                      .scales = work->scales,
                                      .step = SEARCH_STEP,
                                      .tolerance = tolerance,
                                      .most_evaluations = work->most_runs,
                                      .method = work->method,
                                      .function = parameter_search_evaluate,
                                      .context = &work->search};
    Status status;

    for (int i = 0; i < n; i++) {
        numbers[i] = work->search.unknowns.at[i].start;
        numbers[n + i] = work->search.unknowns.at[i].low;
        numbers[2 * n + i] = work->search.unknowns.at[i].high;
    }
    for (int i = 0; i < m; i++)
        is_equality[i] = work->constraints.at[i].is_equality;
    work->search.values = 1 + m;
    work->search.read = read_values;
    parameter_search_begin(&work->search);
    CHECK(first_run(work, numbers, diag));
    CHECK(optimiser_solve(&problem, out, diag));
done:
    parameter_search_end(&work->search);
    MEM_FREE(numbers, is_equality);
    return status;
}

/* --- the result --- */

static char *text_of(const Syntax *syntax)
{
    Text text = {0};

    syntax_print(&text, syntax);
    return text_done(&text);
}

static char *unit_of(const OptimiseWork *work, const Syntax *syntax)
{
    Text unit = {0};

    (void)session_shown_unit(work->search.session, syntax, "", &unit);
    text_add(&unit, "");
    return text_done(&unit);
}

static void add_parameters(const OptimiseWork *work, const double *x, Optimum *out)
{
    for (int i = 0; i < work->search.unknowns.count; i++) {
        const SearchUnknown *unknown = &work->search.unknowns.at[i];
        OptimumParameter parameter = {.name = mem_text(unknown->name, strlen(unknown->name)),
                                      .start = unknown->start,
                                      .value = x[i],
                                      .low = unknown->low,
                                      .high = unknown->high};
        Text unit = {0};

        session_unit(work->search.session, unknown->name, &unit);
        text_add(&unit, "");
        parameter.unit = text_done(&unit);
        LIST_PUSH(out->parameters, parameter);
    }
}

/* of the last run; sides are as the user will see them */
static void add_constraints(const OptimiseWork *work, const double *values, Optimum *out)
{
    for (int i = 0; i < work->constraints.count; i++) {
        const OptimiseConstraint *from = &work->constraints.at[i];
        double sides[2] = {NAN, NAN};
        Diag unused;
        OptimumConstraint constraint = {.text = text_of(from->syntax),
                                        .unit = unit_of(work, from->syntax->args[0]),
                                        .is_active =
                                            fabs(values[1 + i]) <= tolerance * work->scales[1 + i]};

        if (constraint.unit[0] == '\0') {
            mem_free(constraint.unit);
            constraint.unit = unit_of(work, from->syntax->args[1]);
        }
        if (read_sides(work, i, sides, &unused) == OK) {
            constraint.left = sides[0];
            constraint.right = sides[1];
        } else {
            constraint.left = constraint.right = NAN;
        }
        LIST_PUSH(out->constraints, constraint);
    }
}

static Optimum *optimum_of(const OptimiseWork *work, const OptimiserSolution *solution,
                           bool is_stopped)
{
    Optimum *out = optimum_new();

    out->figure = text_of(work->figure);
    out->unit = unit_of(work, work->figure);
    out->is_maximum = work->is_maximum;
    out->start = work->start;
    out->value = solution->values[0] * (work->is_maximum ? -1 : 1);
    out->runs = work->search.evaluations + 1;
    out->is_feasible = solution->violation <= tolerance;
    out->is_converged = solution->is_converged;
    out->is_stopped = is_stopped;
    add_parameters(work, solution->x, out);
    return out;
}

/* No point meets all constraints: the worst one is named, with how near the search came. */
static Status refuse_infeasible(const OptimiseWork *work, const OptimiserSolution *solution,
                                Diag *diag)
{
    const OptimiseConstraint *worst = &work->constraints.at[solution->worst];
    Text values = {0};

    for (int i = 0; i < work->search.unknowns.count; i++)
        text_addf(&values, "%s%s = %.6g", i > 0 ? ", " : "", work->search.unknowns.at[i].name,
                  solution->x[i]);
    (void)diag_at(diag, E_SOLVER, worst->syntax->place,
                  "no values are found that meet this: it fails by %.4g at the nearest, %.300s",
                  fabs(solution->values[1 + solution->worst]), values.at);
    diag_hint(diag, "other initial values or wider bounds may help; the parameters are unchanged");
    text_free(&values);
    return E_SOLVER;
}

static void report_optimum(const ct_session *session, Text *out)
{
    const View view = session_view(session);

    optimum_print(&view, session->optimum, out);
}

static void remark_end(ct_session *session, const OptimiseWork *work, const Optimum *optimum)
{
    Text text = {0};

    if (optimum->is_converged)
        return;
    text_add(&text, "warning: the optimisation did not converge");
    if (work->search.evaluations >= work->most_runs)
        text_addf(&text, " in %d runs (runs=)", work->most_runs);
    session_remark(session, text.at);
    text_free(&text);
}

static Status finish(OptimiseWork *work, const OptimiserSolution *solution, Optimum *optimum,
                     Diag *diag)
{
    TRY(parameter_search_define(&work->search, solution->x, diag));
    if (!optimum->is_stopped) {
        TRY(parameter_search_run_last(&work->search, diag));
        remark_end(work->search.session, work, optimum);
    }
    add_constraints(work, solution->values, optimum);
    return OK;
}

Status session_optimise(ct_session *session, const Statement *s, Diag *diag)
{
    OptimiseWork work = {0};
    const double began = clock_now();
    OptimiserSolution *solution = NULL;
    Optimum *optimum = NULL;
    Status status, stopped = OK;

    CHECK(read_statement(&work, session, s, diag));
    work.scales = NEW_ARRAY(double, 1 + work.constraints.count);
    status = search_from(&work, &solution, diag);
    if (solution == NULL)
        goto done;
    if (status == E_STOPPED)
        stopped = parameter_search_stopped(&work.search, diag);
    else if (status != OK)
        goto done;
    if (stopped == OK && solution->violation > tolerance) {
        status = refuse_infeasible(&work, solution, diag);
        goto done;
    }
    optimum = optimum_of(&work, solution, stopped != OK);
    CHECK(finish(&work, solution, optimum, diag));
    optimum->wall = clock_now() - began;
    optimum_free(session->optimum);
    session->optimum = optimum;
    session->reporter = report_optimum;
    optimum = NULL;
    status = stopped;
done:
    optimum_free(optimum);
    optimiser_solution_free(solution);
    mem_free(work.scales);
    LIST_FREE(work.constraints);
    parameter_search_free(&work.search);
    return status;
}
