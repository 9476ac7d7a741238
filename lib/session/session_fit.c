/* session_fit.c: `fit`
 *
 * The statement is executed once more with the values found, so that its run is the last one. */
#include "session/session_fit.h"

#include "base/clock.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>

static const char hint[] = "fit k d to=table(\"data.csv\", t, \"h\") by=h : simulate 5";

/* the least standard deviation of a signal among several, in its spread */
static const double least_sigma = 1e-6;
/* relative changes of two unknowns that count as equal */
static const double equal_changes = 0.01;

typedef struct FitWork {
    ParameterSearch search;
    FitPlan plan;
    int left;
    bool has_no_sensitivities; /* the signals have none: not tried again */
} FitWork;

static const FitWork *work_of(const ParameterSearch *search)
{
    return (const FitWork *)search;
}

/* --- one run --- */

/* what the run has in the place of the data */
static Status read_signal(const FitWork *work, const FitTarget *target, double *out, Diag *diag)
{
    ct_session *session = work->search.session;
    Formula formula = {0};
    Run *run;
    Status status;

    if (target->curve == NULL)
        return session_value_at(session, target->by, NULL, out, diag);
    run = &session->runs.at[session->runs.count - 1];
    CHECK(formula_new(session, target->by, &formula, diag));
    CHECK(formula_rows(session, &formula, 1, run, run, target->times, target->count, out, 1, 0,
                       diag));
done:
    formula_free(&formula);
    return status;
}

static double sigma_of(const FitTarget *target)
{
    return target->sigma > 0 ? target->sigma : target->spread;
}

static Status read_residuals(const ParameterSearch *search, double *out, Diag *diag)
{
    const FitWork *work = work_of(search);
    int first = 0;

    for (int i = 0; i < work->plan.targets.count; i++) {
        const FitTarget *target = &work->plan.targets.at[i];

        TRY(read_signal(work, target, out + first, diag));
        for (int k = 0; k < target->count; k++)
            out[first + k] = (out[first + k] - target->data[k]) / sigma_of(target);
        first += target->count;
    }
    return OK;
}

/* --- derivatives --- */

/* of a signal, along its instants: count x unknowns; E_MODEL where it is no plain variable */
static Status signal_slopes(const FitWork *work, const FitTarget *target, double *out, Diag *diag)
{
    ct_session *session = work->search.session;
    const int n = work->search.unknowns.count;
    Expr *parameters = NEW_ARRAY(Expr, n);
    Formula formula = {0};
    Run *run = &session->runs.at[session->runs.count - 1];
    const Leaf *leaf;
    Status status;

    for (int i = 0; i < n; i++)
        parameters[i] = session_parameter(session, work->search.unknowns.at[i].name);
    CHECK(formula_new(session, target->by, &formula, diag));
    leaf = formula.leaves.count == 1 ? formula.leaves.at : NULL;
    if (leaf == NULL || leaf->kind != LEAF_VARIABLE || leaf->run >= 0 ||
        formula.whole != leaf->symbol)
        CHECK(E_MODEL);
    CHECK(session_sensitivities(session, run, &leaf->expr, 1, parameters, n, target->times,
                                target->count, out, diag));
    for (int k = 0; k < target->count * n; k++)
        out[k] *= formula.scale / sigma_of(target);
done:
    formula_free(&formula);
    mem_free(parameters);
    return status;
}

/* the DerivativesFunction of a fit: of one run, by its sensitivities */
static Status find_derivatives(void *context, const double *x, double *out, bool *has, Diag *diag)
{
    FitWork *work = context;
    ParameterSearch *search = &work->search;
    const int n = search->unknowns.count;
    Diag why = {0};
    Status status = OK;

    *has = false;
    for (int i = 0; i < work->plan.targets.count; i++)
        if (work->plan.targets.at[i].curve == NULL)
            work->has_no_sensitivities = true;
    if (work->has_no_sensitivities)
        return OK;
    CHECK(parameter_search_run(search, x, &why));
    for (int i = 0; i < work->plan.targets.count; i++) {
        const FitTarget *target = &work->plan.targets.at[i];

        CHECK(signal_slopes(work, target, out, &why));
        out += (ptrdiff_t)target->count * n;
    }
    search->evaluations++;
    *has = true;
done:
    parameter_search_forget(search);
    work->has_no_sensitivities = status != OK;
    return status == E_STOPPED ? diag_set(diag, status, "%s", why.message) : OK;
}

/* --- the search --- */

static FitProblem problem_of(FitWork *work, double *numbers)
{
    const int n = work->search.unknowns.count;
    FitProblem problem = {.unknowns = n,
                          .start = numbers,
                          .low = numbers + n,
                          .high = numbers + (ptrdiff_t)2 * n,
                          .loss = work->plan.loss,
                          .sigma_is_known = work->plan.has_sigma,
                          .step = SEARCH_STEP,
                          .function = parameter_search_evaluate,
                          .derivatives = find_derivatives,
                          .context = &work->search};

    for (int i = 0; i < n; i++) {
        numbers[i] = work->search.unknowns.at[i].start;
        numbers[n + i] = work->search.unknowns.at[i].low;
        numbers[2 * n + i] = work->search.unknowns.at[i].high;
    }
    for (int i = 0; i < work->plan.targets.count; i++) {
        const FitTarget *target = &work->plan.targets.at[i];

        problem.residuals += target->count;
        problem.noise = fmax(problem.noise, SEARCH_NOISE * target->spread / sigma_of(target));
    }
    return problem;
}

/* Signals in the same units count equally; others by how well they are matched. Returns whether
 * there are such. */
static bool weigh_signals(FitPlan *plan, const FitSolution *solution)
{
    int signals = 0, first = 0;

    for (int i = 0; i < plan->targets.count; i++)
        signals += plan->targets.at[i].curve != NULL;
    if (plan->has_sigma || signals < 2)
        return false;
    for (int i = 0; i < plan->targets.count; i++) {
        FitTarget *target = &plan->targets.at[i];
        double squares = 0;

        for (int k = 0; k < target->count; k++)
            squares += pow(solution->z[first + k], 2) / target->count;
        first += target->count;
        if (target->curve != NULL)
            target->sigma = sigma_of(target) * fmax(sqrt(squares), least_sigma);
    }
    return true;
}

/* from the values of the last solution, if there is one */
static Status search(FitWork *work, FitSolution **solution, Diag *diag)
{
    const int n = work->search.unknowns.count;
    double *numbers = NEW_ARRAY(double, 3 * n);
    const FitProblem problem = problem_of(work, numbers);
    FitSolution *found = NULL;
    Status status;

    work->search.values = problem.residuals;
    for (int i = 0; *solution != NULL && i < n; i++)
        numbers[i] = (*solution)->x[i];
    status = fit_solve(&problem, &found, diag);
    if (found != NULL) {
        found->iterations += *solution != NULL ? (*solution)->iterations : 0;
        fit_solution_free(*solution);
        *solution = found;
    }
    mem_free(numbers);
    return status;
}

/* the first run fails where the user can see why; it shows which data are used */
static Status first_run(FitWork *work, Diag *diag)
{
    const int n = work->search.unknowns.count;
    double *x = NEW_ARRAY(double, n);
    Status status;

    for (int i = 0; i < n; i++)
        x[i] = work->search.unknowns.at[i].start;
    CHECK(parameter_search_run(&work->search, x, diag));
    CHECK(fit_plan_data(work->search.session, &work->plan, &work->left, diag));
    for (int i = 0; i < work->plan.targets.count; i++) {
        const FitTarget *target = &work->plan.targets.at[i];
        double *values = NEW_ARRAY(double, target->count);

        status = read_signal(work, target, values, diag);
        mem_free(values);
        CHECK(status);
    }
done:
    parameter_search_forget(&work->search);
    mem_free(x);
    return status;
}

static Status search_all(FitWork *work, FitSolution **solution, Diag *diag)
{
    Status status;

    parameter_search_begin(&work->search);
    CHECK(first_run(work, diag));
    CHECK(search(work, solution, diag));
    if (*solution != NULL && weigh_signals(&work->plan, *solution))
        CHECK(search(work, solution, diag));
done:
    parameter_search_end(&work->search);
    if (status == E_SOLVER && *solution == NULL && work->search.why.status != OK)
        *diag = work->search.why;
    return status;
}

/* --- the result --- */

static char *text_of(const Syntax *syntax)
{
    Text text = {0};

    syntax_print(&text, syntax);
    return text_done(&text);
}

static void add_parameters(const FitWork *work, const FitSolution *solution, FitResult *out)
{
    const int n = solution->unknowns, freedoms = solution->residuals - n;
    const double quantile = freedoms > 0 ? gsl_cdf_tdist_Pinv(0.975, freedoms) : NAN;

    out->correlations = NEW_ARRAY(double, n *n);
    for (int i = 0; i < n; i++) {
        const SearchUnknown *unknown = &work->search.unknowns.at[i];
        FitParameter parameter = {.name = mem_text(unknown->name, strlen(unknown->name)),
                                  .start = unknown->start,
                                  .value = solution->x[i],
                                  .error = solution->errors[i],
                                  .half = quantile * solution->errors[i],
                                  .is_at_bound = solution->is_held[i]};
        Text unit = {0};

        session_unit(work->search.session, unknown->name, &unit);
        text_add(&unit, "");
        parameter.unit = text_done(&unit);
        LIST_PUSH(out->parameters, parameter);
        for (int k = 0; k < n; k++)
            out->correlations[i * n + k] =
                solution->covariance[i * n + k] / solution->errors[i] / solution->errors[k];
    }
}

static void add_signals(const FitWork *work, const FitSolution *solution, FitResult *out)
{
    int first = 0;

    for (int i = 0; i < work->plan.targets.count; i++) {
        const FitTarget *target = &work->plan.targets.at[i];
        const size_t size = (size_t)target->count * sizeof(double);
        FitSignal signal = {.name = text_of(target->by),
                            .data = text_of(target->to),
                            .is_number = target->curve == NULL,
                            .count = target->count,
                            .times = mem_new(size),
                            .measured = mem_new(size),
                            .model = mem_new(size),
                            .sigma = target->sigma > 0 ? target->sigma : NAN};
        Text unit = {0};

        (void)session_shown_unit(work->search.session, target->by, "", &unit);
        text_add(&unit, "");
        signal.unit = text_done(&unit);
        for (int k = 0; k < target->count; k++) {
            const double off = solution->z[first + k] * sigma_of(target);

            signal.times[k] = target->times[k];
            signal.measured[k] = target->data[k];
            signal.model[k] = target->data[k] + off;
            signal.rms += off * off / target->count;
        }
        signal.rms = sqrt(signal.rms);
        first += target->count;
        LIST_PUSH(out->signals, signal);
    }
}

static void note(FitResult *result, Text *text)
{
    LIST_PUSH(result->notes, text_done(text));
}

/* "the data determine k/m only", or which changes together change nothing */
static void note_undetermined(FitResult *result, const double *changes)
{
    int taking[2] = {0}, count = 0;
    Text text = {0};

    for (int i = 0; i < result->parameters.count; i++)
        if (changes[i] != 0 && count++ < 2)
            taking[count - 1] = i;
    if (count == 1) {
        text_addf(&text, "the data don't depend on %s", result->parameters.at[taking[0]].name);
    } else if (count == 2 &&
               fabs(fabs(changes[taking[0]]) - fabs(changes[taking[1]])) <= equal_changes) {
        text_addf(&text, "the data determine %s%c%s only, not both",
                  result->parameters.at[taking[0]].name,
                  changes[taking[0]] * changes[taking[1]] > 0 ? '/' : '*',
                  result->parameters.at[taking[1]].name);
    } else {
        text_add(&text, "the data don't determine");
        for (int i = 0, named = 0; i < result->parameters.count; i++)
            if (changes[i] != 0)
                text_addf(&text, "%s %s", named++ > 0 ? "," : "", result->parameters.at[i].name);
        text_add(&text, ": relative changes of");
        for (int i = 0, named = 0; i < result->parameters.count; i++)
            if (changes[i] != 0)
                text_addf(&text, "%s %.3g", named++ > 0 ? "," : "", changes[i]);
        text_add(&text, " together change nothing");
    }
    note(result, &text);
}

static void add_notes(const FitWork *work, const FitSolution *solution, FitResult *out)
{
    for (int i = 0; i < solution->undetermined_count; i++)
        note_undetermined(out, solution->undetermined + (ptrdiff_t)i * solution->unknowns);
    for (int i = 0; i < solution->unknowns; i++)
        if (solution->is_held[i]) {
            Text text = {0};

            text_addf(&text, "%s is at its bound", out->parameters.at[i].name);
            note(out, &text);
        }
    if (work->left > 0) {
        Text text = {0};

        text_addf(&text, "%d of the data lie outside the run and are left out", work->left);
        note(out, &text);
    }
    if (out->points <= solution->unknowns) {
        Text text = {0};

        text_addf(&text, "no more data than parameters: there are no standard errors");
        note(out, &text);
    }
    if (!solution->is_converged && !out->is_stopped) {
        Text text = {0};

        text_addf(&text, "no better values are found, although the residuals still depend on the "
                         "parameters; other initial values may help");
        note(out, &text);
    }
}

static FitResult *result_of(const FitWork *work, const FitSolution *solution, bool is_stopped)
{
    FitResult *out = fit_result_new();

    add_parameters(work, solution, out);
    add_signals(work, solution, out);
    out->loss = work->plan.loss;
    out->points = solution->residuals;
    out->residual = sqrt(solution->squares / solution->residuals);
    out->iterations = solution->iterations;
    out->runs = work->search.evaluations + 1;
    out->is_converged = solution->is_converged;
    out->is_stopped = is_stopped;
    add_notes(work, solution, out);
    return out;
}

static void report_fit(const ct_session *session, Text *out)
{
    const View view = session_view(session);

    fit_print(&view, session->fit, out);
}

Status session_fit(ct_session *session, const Statement *s, Diag *diag)
{
    FitWork work = {0};
    const double began = clock_now();
    FitSolution *solution = NULL;
    FitResult *result = NULL;
    Status status, stopped = OK;

    CHECK(parameter_search_read(&work.search, session, s, "match data", hint, diag));
    CHECK(parameter_search_read_unknowns(&work.search, diag));
    CHECK(fit_plan(session, s, &work.plan, diag));
    work.search.read = read_residuals;
    status = search_all(&work, &solution, diag);
    if (solution == NULL)
        goto done;
    if (status == E_STOPPED)
        stopped = parameter_search_stopped(&work.search, diag);
    else if (status != OK)
        goto done;
    result = result_of(&work, solution, stopped != OK);
    CHECK(parameter_search_define(&work.search, solution->x, diag));
    if (stopped == OK)
        status = parameter_search_run_last(&work.search, diag);
    if (status == OK && !result->is_converged && stopped == OK)
        session_remark(session, "warning: the fit did not converge");
    result->wall = clock_now() - began;
    fit_result_free(session->fit);
    session->fit = result;
    session->reporter = report_fit;
    result = NULL;
    status = stopped != OK ? stopped : status;
done:
    fit_result_free(result);
    fit_solution_free(solution);
    fit_plan_free(&work.plan);
    parameter_search_free(&work.search);
    return status;
}

/* items that are more than a variable or a call stand in brackets */
static void add_item(Text *text, const char *lead, const char *item)
{
    const bool is_sum = strpbrk(item, " +-*/^<>=&|?!") != NULL && strncmp(item, "table(", 6) != 0;

    text_addf(text, is_sum ? "%s(%s)" : "%s%s", lead, item);
}

char *ct_fit_plot(ct_session *session, ct_error *error)
{
    SESSION_CALL(session, NULL);

    const FitResult *fit = session->fit;
    Diag diag = {0};
    Text text = {0};

    for (int i = 0; fit != NULL && i < fit->signals.count; i++) {
        const FitSignal *signal = &fit->signals.at[i];

        if (signal->is_number)
            continue;
        add_item(&text, text.length == 0 ? "plot " : " | ", signal->data);
        add_item(&text, " ", signal->name);
        add_item(&text, " | (", signal->name);
        text_addf(&text, " - (%s))", signal->data);
    }
    if (text.length > 0)
        return text_done(&text);
    (void)session_report(
        diag_set(&diag, E_MISSING, "%s",
                 fit == NULL ? "there is no fit yet" : "the fit has no data over the time"),
        &diag, error);
    return NULL;
}
