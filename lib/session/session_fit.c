/* session_fit.c: `fit`
 *
 * Parameters of each run are overrides of the model's, as in a sweep. The values found become
 * definitions of the model, one step of its history, and the statement is executed once more with
 * them: its run is the last one. Runs have a finer tolerance than by default, for difference
 * quotients of them. */
#include "session/session_fit.h"

#include "base/clock.h"
#include "language/verbs.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>

/* of the runs, where the statement has no rtol= */
#define FIT_RTOL "1e-10"
/* relative steps of difference quotients: their error is then that of the square of 1e-4, and of
 * the runs' tolerance over 1e-4 */
static const double difference_step = 1e-4;
/* of residuals in the spread of their data */
static const double run_noise = 1e-9;
/* the least standard deviation of a signal among several, in its spread */
static const double least_sigma = 1e-6;
/* relative changes of two unknowns that count as equal */
static const double equal_changes = 0.01;

typedef struct FitWork {
    ct_session *session;
    const Statement *statement;
    Statement rest; /* with the tolerance of the runs */
    FitPlan plan;
    int overrides, runs; /* before */
    int evaluations, left;
    Diag why; /* of the first run that failed; status OK: none has */
} FitWork;

/* --- one run --- */

static Status set_unknowns(const FitWork *work, const double *x, Diag *diag)
{
    Model *model = work->session->model;

    for (int i = 0; i < work->plan.unknowns.count; i++)
        model_override(model, work->plan.unknowns.at[i].name, x[i]);
    for (int i = 0; i < work->plan.unknowns.count; i++)
        TRY(model_check_parameter(model, work->plan.unknowns.at[i].name, diag));
    return OK;
}

static Status run_with(FitWork *work, const double *x, Diag *diag)
{
    ct_session *session = work->session;

    focus_clear(session, work->runs);
    TRY(monitor_poll(&session->watch));
    TRY(set_unknowns(work, x, diag));
    return sweep_analysis(work->statement->rest)(session, &work->rest, diag);
}

/* what the run has in the place of the data */
static Status read_signal(const FitWork *work, const FitTarget *target, double *out, Diag *diag)
{
    ct_session *session = work->session;
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

static Status find_residuals(FitWork *work, const double *x, double *out, Diag *diag)
{
    int first = 0;

    TRY(run_with(work, x, diag));
    for (int i = 0; i < work->plan.targets.count; i++) {
        const FitTarget *target = &work->plan.targets.at[i];

        TRY(read_signal(work, target, out + first, diag));
        for (int k = 0; k < target->count; k++)
            out[first + k] = (out[first + k] - target->data[k]) / sigma_of(target);
        first += target->count;
    }
    return OK;
}

/* a run that fails has no residuals */
static Status residuals(void *context, const double *x, double *out, Diag *diag)
{
    FitWork *work = context;
    Diag why = {0};
    Status status = find_residuals(work, x, out, &why);

    model_drop_overrides(work->session->model, work->overrides);
    transaction_stop_asking(); /* there is something to lose */
    if (work->session->hooks.progress != NULL)
        work->session->hooks.progress(work->session->hooks.context, "fit", -1);
    work->evaluations++;
    if (sweep_is_of_one_run(status)) {
        if (work->why.status == OK)
            work->why = why;
        out[0] = NAN;
        return OK;
    }
    if (status != OK)
        *diag = why;
    return status;
}

/* --- the search --- */

static FitProblem problem_of(FitWork *work, double *numbers)
{
    const int n = work->plan.unknowns.count;
    FitProblem problem = {.unknowns = n,
                          .start = numbers,
                          .low = numbers + n,
                          .high = numbers + (ptrdiff_t)2 * n,
                          .loss = work->plan.loss,
                          .sigma_is_known = work->plan.has_sigma,
                          .step = difference_step,
                          .function = residuals,
                          .context = work};

    for (int i = 0; i < n; i++) {
        numbers[i] = work->plan.unknowns.at[i].start;
        numbers[n + i] = work->plan.unknowns.at[i].low;
        numbers[2 * n + i] = work->plan.unknowns.at[i].high;
    }
    for (int i = 0; i < work->plan.targets.count; i++) {
        const FitTarget *target = &work->plan.targets.at[i];

        problem.residuals += target->count;
        problem.noise = fmax(problem.noise, run_noise * target->spread / sigma_of(target));
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
    const int n = work->plan.unknowns.count;
    double *numbers = NEW_ARRAY(double, 3 * n);
    const FitProblem problem = problem_of(work, numbers);
    FitSolution *found = NULL;
    Status status;

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
    const int n = work->plan.unknowns.count;
    double *x = NEW_ARRAY(double, n);
    Status status;

    for (int i = 0; i < n; i++)
        x[i] = work->plan.unknowns.at[i].start;
    CHECK(run_with(work, x, diag));
    CHECK(fit_plan_data(work->session, &work->plan, &work->left, diag));
    for (int i = 0; i < work->plan.targets.count; i++) {
        const FitTarget *target = &work->plan.targets.at[i];
        double *values = NEW_ARRAY(double, target->count);

        status = read_signal(work, target, values, diag);
        mem_free(values);
        CHECK(status);
    }
done:
    model_drop_overrides(work->session->model, work->overrides);
    mem_free(x);
    return status;
}

static Status search_all(FitWork *work, FitSolution **solution, Diag *diag)
{
    ct_session *session = work->session;
    void (*progress)(void *, const char *, double) = session->watch.progress;
    Status status;

    session->watch.progress = NULL; /* the phases of each run are of no interest */
    session->is_sweeping = true;
    CHECK(first_run(work, diag));
    CHECK(search(work, solution, diag));
    if (*solution != NULL && weigh_signals(&work->plan, *solution))
        CHECK(search(work, solution, diag));
done:
    focus_clear(session, work->runs);
    session->is_sweeping = false;
    session->watch.progress = progress;
    if (status == E_SOLVER && *solution == NULL && work->why.status != OK)
        *diag = work->why;
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
        const FitUnknown *unknown = &work->plan.unknowns.at[i];
        FitParameter parameter = {.name = mem_text(unknown->name, strlen(unknown->name)),
                                  .start = unknown->start,
                                  .value = solution->x[i],
                                  .error = solution->errors[i],
                                  .half = quantile * solution->errors[i],
                                  .is_at_bound = solution->is_held[i]};
        Text unit = {0};

        session_unit(work->session, unknown->name, &unit);
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

        (void)session_shown_unit(work->session, target->by, "", &unit);
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
    out->runs = work->evaluations + 1;
    out->is_converged = solution->is_converged;
    out->is_stopped = is_stopped;
    add_notes(work, solution, out);
    return out;
}

/* "k = 0.25 [N/m]" of each: one step of the model's history */
static Status define_all(ct_session *session, const Statement *s, const FitResult *result,
                         Diag *diag)
{
    const uint64_t revision = model_revision(session->model);
    const int group = model_begin_group(session->model);
    Text text = {0};
    int count;
    Status status;

    for (int i = 0; i < result->parameters.count; i++) {
        const FitParameter *parameter = &result->parameters.at[i];

        text_addf(&text, "%s = %.17g", parameter->name, parameter->value);
        if (parameter->unit[0] != '\0')
            text_addf(&text, " [%s]", parameter->unit);
        text_char(&text, '\n');
    }
    status = session_apply_text(session->model, text.at, &count, diag);
    session_end_group(session, group, s->verb, revision, status == OK);
    if (status != OK)
        diag->place = s->verb_place;
    text_free(&text);
    return status;
}

static void report_fit(const ct_session *session, Text *out)
{
    const View view = session_view(session);

    fit_print(&view, session->fit, out);
}

static Status check_rest(const Statement *s, Diag *diag)
{
    if (sweep_analysis(s->rest) != NULL)
        return OK;
    (void)diag_at(diag, E_VALUE, s->rest->place, "'%s' computes nothing that could match data",
                  s->rest->verb != NULL ? s->rest->verb : s->rest->text);
    diag_hint(diag, "simulate, kinematics, inverse, assemble, equilibrium, op, linearize and modes "
                    "may stand behind the colon");
    return E_VALUE;
}

/* the statement of the runs: finer than by default where it says nothing of it */
static void make_rest(FitWork *work, Syntax *number)
{
    const Statement *rest = work->statement->rest;
    bool is_run = false, has_rtol = false;

    work->rest = *rest;
    work->rest.pairs.at = NULL;
    work->rest.pairs.count = work->rest.pairs.room = 0;
    for (int i = 0; i < rest->pairs.count; i++) {
        LIST_PUSH(work->rest.pairs, rest->pairs.at[i]);
        has_rtol = has_rtol || strcmp(rest->pairs.at[i].name, "rtol") == 0;
    }
    for (int i = 0; verb_key(&rest->row, i) != NULL; i++)
        is_run = is_run || strcmp(verb_key(&rest->row, i), "rtol") == 0;
    *number = (Syntax){.kind = SYNTAX_NUMBER,
                       .text = FIT_RTOL,
                       .unit_text = "",
                       .height = 1,
                       .place = rest->place};
    if (is_run && !has_rtol)
        LIST_PUSH(work->rest.pairs, (Pair){.name = "rtol", .value = number});
}

/* once more, with the values found, as if it had been typed */
static Status run_last(ct_session *session, const Statement *s, const FitResult *result, Diag *diag)
{
    const Status status = sweep_analysis(s->rest)(session, s->rest, diag);

    if (status != OK)
        return status;
    if (!result->is_converged)
        session_remark(session, "warning: the fit did not converge");
    return OK;
}

Status session_fit(ct_session *session, const Statement *s, Diag *diag)
{
    FitWork work = {.session = session,
                    .statement = s,
                    .overrides = model_override_count(session->model),
                    .runs = session->runs.count};
    const double began = clock_now();
    FitSolution *solution = NULL;
    FitResult *result = NULL;
    SessionFocus focus;
    Syntax number;
    Status status, stopped = OK;

    CHECK(check_rest(s, diag));
    CHECK(fit_plan(session, s, &work.plan, diag));
    make_rest(&work, &number);
    focus_put_aside(session, &focus);
    status = search_all(&work, &solution, diag);
    focus_restore(session, &focus);
    if (solution == NULL)
        goto done;
    if (status == E_STOPPED)
        stopped = diag_set(diag, status, "stopped in run %d: the best values so far are kept",
                           work.evaluations);
    else if (status != OK)
        goto done;
    result = result_of(&work, solution, stopped != OK);
    CHECK(define_all(session, s, result, diag));
    if (stopped == OK)
        status = run_last(session, s, result, diag);
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
    LIST_FREE(work.rest.pairs);
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
