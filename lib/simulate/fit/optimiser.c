/* optimiser.c: NLopt's methods, with evaluations in the caller's thread
 *
 * Evaluations may leave the call (transaction.h), and NLopt frees its memory only when it returns.
 * So it has a thread of its own, in which nothing else is executed: its callbacks ask for the
 * values at a point and wait. The caller answers, or ends the search. Of the two threads one alone
 * is running at any time.
 *
 * Unknowns are u = (x - start)/size. Values are divided by their scales. */
#include "simulate/fit/optimiser.h"

#include "base/memory.h"

#include <math.h>
#include <nlopt.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>

/* changes that end a search: of all u; of the value that is minimised, relative and in its scale */
static const double least_change = 1e-9, least_decrease = 1e-11, least_value = 1e-13;
/* the first step of COBYLA, in u: from the start, and after the other method */
static const double first_step = 0.1, next_step = 0.01;

typedef enum Turn { TURN_SOLVER, TURN_CALLER, TURN_OVER } Turn;

/* What the two threads share; `lock` guards `turn`, and whose turn it is owns the rest. */
typedef struct SolverThread {
    pthread_t thread;
    bool is_started;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    Turn turn;
    nlopt_opt solver;
    nlopt_result result;
    bool ends;           /* the caller wants it to return */
    double *u;           /* asked for */
    bool wants_gradient; /* there */
    double *values;      /* answer: scaled; 1 + constraints */
    double *jacobian;    /* scaled, by u */
    Cleanup cleanup;
} SolverThread;

/* callbacks of NLopt: the value to be minimised, or some of the constraints */
typedef struct SolverFunction {
    struct Optimiser *optimiser;
    bool wants_equalities;
} SolverFunction;

typedef struct Optimiser {
    const OptimiserProblem *problem;
    OptimiserSolution *best;
    double *size, *low, *high; /* of u */
    double *x;                 /* a point */
    double *most;              /* of the scaled values so far */
    double *at, *at_values,
        *at_jacobian; /* last u that was evaluated; `has`: what is known there */
    double *at_raw;
    bool has_values, has_gradient;
    SolverFunction inequalities, equalities;
    SolverThread solver;
    int equality_count;
} Optimiser;

const char *optimiser_name(OptimiserMethod method)
{
    static const char *const names[OPTIMISER_METHODS] = {
        [OPTIMISER_BOTH] = "both", [OPTIMISER_SLSQP] = "slsqp", [OPTIMISER_COBYLA] = "cobyla"};

    return names[method];
}

/* --- in the thread of the solver --- */

static void give_turn(SolverThread *s, Turn turn)
{
    (void)pthread_mutex_lock(&s->lock);
    s->turn = turn;
    (void)pthread_cond_broadcast(&s->changed);
    (void)pthread_mutex_unlock(&s->lock);
}

static void await_turn(SolverThread *s, Turn turn)
{
    (void)pthread_mutex_lock(&s->lock);
    while (s->turn != turn && s->turn != TURN_OVER)
        (void)pthread_cond_wait(&s->changed, &s->lock);
    (void)pthread_mutex_unlock(&s->lock);
}

/* values, and derivatives if wanted, at u; false: it is to return */
static bool ask(Optimiser *o, const double *u, bool wants_gradient)
{
    SolverThread *s = &o->solver;

    if (!s->ends) {
        memcpy(s->u, u, (size_t)o->problem->unknowns * sizeof *u);
        s->wants_gradient = wants_gradient;
        give_turn(s, TURN_CALLER);
        await_turn(s, TURN_SOLVER);
    }
    if (s->ends)
        (void)nlopt_force_stop(s->solver);
    return !s->ends;
}

static double minimised(unsigned n, const double *u, double *gradient, void *data)
{
    Optimiser *o = data;

    if (!ask(o, u, gradient != NULL))
        return HUGE_VAL;
    if (gradient != NULL)
        memcpy(gradient, o->solver.jacobian, n * sizeof *gradient);
    return o->solver.values[0];
}

static void constrained(unsigned m, double *result, unsigned n, const double *u, double *gradient,
                        void *data)
{
    const SolverFunction *function = data;
    Optimiser *o = function->optimiser;
    const bool is_there = ask(o, u, gradient != NULL);
    unsigned next = 0;

    for (int i = 0; i < o->problem->constraints && next < m; i++) {
        if (o->problem->is_equality[i] != function->wants_equalities)
            continue;
        result[next] = is_there ? o->solver.values[1 + i] : HUGE_VAL;
        if (gradient != NULL && is_there)
            memcpy(gradient + (size_t)next * n, o->solver.jacobian + (size_t)(1 + i) * n,
                   n * sizeof *gradient);
        next++;
    }
}

static void *solve(void *context)
{
    Optimiser *o = context;
    SolverThread *s = &o->solver;
    double value;

    await_turn(s, TURN_SOLVER);
    s->result = nlopt_optimize(s->solver, s->u, &value);
    give_turn(s, TURN_OVER);
    return NULL;
}

/* --- in the caller's thread --- */

static void close_solver(void *object)
{
    SolverThread *s = object;

    if (s->is_started) {
        s->ends = true;
        if (s->turn == TURN_CALLER)
            give_turn(s, TURN_SOLVER);
        (void)pthread_join(s->thread, NULL);
        (void)pthread_mutex_destroy(&s->lock);
        (void)pthread_cond_destroy(&s->changed);
    }
    s->is_started = false;
    nlopt_destroy(s->solver);
    s->solver = NULL;
    cleanup_close(&s->cleanup);
}

static bool start_thread(Optimiser *o)
{
    SolverThread *s = &o->solver;
    sigset_t all, before;

    (void)pthread_mutex_init(&s->lock, NULL);
    (void)pthread_cond_init(&s->changed, NULL);
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    s->turn = TURN_SOLVER;
    s->is_started = pthread_create(&s->thread, NULL, solve, o) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return s->is_started;
}

static void set_constraints(Optimiser *o, unsigned count, SolverFunction *function,
                            nlopt_result (*add)(nlopt_opt, unsigned, nlopt_mfunc, void *,
                                                const double *))
{
    double *tolerances = NEW_ARRAY(double, count);

    for (unsigned i = 0; i < count; i++)
        tolerances[i] = o->problem->tolerance;
    if (count > 0 && add(o->solver.solver, count, constrained, function, tolerances) < 0)
        (void)mem_given(NULL);
    mem_free(tolerances);
}

/* of a method, from the best point */
static bool open_solver(Optimiser *o, nlopt_algorithm algorithm, double step)
{
    const OptimiserProblem *problem = o->problem;
    SolverThread *s = &o->solver;

    cleanup_open(&s->cleanup, close_solver, s);
    s->solver = MEM_GIVEN(nlopt_create(algorithm, (unsigned)problem->unknowns));
    s->ends = false;
    (void)nlopt_set_lower_bounds(s->solver, o->low);
    (void)nlopt_set_upper_bounds(s->solver, o->high);
    (void)nlopt_set_min_objective(s->solver, minimised, o);
    set_constraints(o, (unsigned)(problem->constraints - o->equality_count), &o->inequalities,
                    nlopt_add_inequality_mconstraint);
    set_constraints(o, (unsigned)o->equality_count, &o->equalities, nlopt_add_equality_mconstraint);
    (void)nlopt_set_xtol_abs1(s->solver, least_change);
    (void)nlopt_set_ftol_rel(s->solver, least_decrease);
    (void)nlopt_set_ftol_abs(s->solver, least_value);
    (void)nlopt_set_initial_step1(s->solver, step);
    for (int i = 0; i < problem->unknowns; i++)
        s->u[i] =
            fmin(fmax((o->best->x[i] - problem->start[i]) / o->size[i], o->low[i]), o->high[i]);
    return start_thread(o);
}

/* the largest violation of constraints, and which */
static double violation_of(const OptimiserProblem *problem, const double *values, int *worst)
{
    double most = 0;

    *worst = -1;
    for (int i = 0; i < problem->constraints; i++) {
        const double scaled = values[1 + i] / problem->scales[1 + i];
        const double off = problem->is_equality[i] ? fabs(scaled) : scaled;

        if (off > most) {
            most = off;
            *worst = i;
        }
    }
    return most;
}

static bool is_better(const Optimiser *o, double violation, const double *values)
{
    const OptimiserSolution *best = o->best;
    const double tolerance = o->problem->tolerance;

    if (violation <= tolerance && best->violation <= tolerance)
        return values[0] < best->values[0];
    return violation < best->violation;
}

static void note_best(Optimiser *o)
{
    const OptimiserProblem *problem = o->problem;
    int worst;
    const double violation = violation_of(problem, o->at_raw, &worst);

    if (!is_better(o, violation, o->at_raw))
        return;
    o->best->violation = violation;
    o->best->worst = worst;
    memcpy(o->best->x, o->x, (size_t)problem->unknowns * sizeof *o->x);
    memcpy(o->best->values, o->at_raw, (size_t)(1 + problem->constraints) * sizeof *o->at_raw);
}

static void set_point(Optimiser *o, const double *u)
{
    const OptimiserProblem *problem = o->problem;

    for (int i = 0; i < problem->unknowns; i++)
        o->x[i] = u[i] <= o->low[i]    ? problem->low[i]
                  : u[i] >= o->high[i] ? problem->high[i]
                                       : problem->start[i] + o->size[i] * u[i];
}

/* Values at u. Where there are none, they are worse than all before by more than their range. */
static Status find_values(Optimiser *o, const double *u, bool is_slsqp, Diag *diag)
{
    const OptimiserProblem *problem = o->problem;
    const int m = 1 + problem->constraints;

    memcpy(o->at, u, (size_t)problem->unknowns * sizeof *u);
    o->has_values = o->has_gradient = false;
    set_point(o, u);
    o->best->evaluations++;
    TRY(problem->function(problem->context, 1, o->x, o->at_raw, diag));
    o->has_values = true;
    for (int i = 0; i < m; i++)
        o->has_values = o->has_values && isfinite(o->at_raw[i]);
    for (int i = 0; i < m; i++) {
        o->at_values[i] = o->at_raw[i] / problem->scales[i];
        if (o->has_values)
            o->most[i] = fmax(o->most[i], fabs(o->at_values[i]));
        else
            o->at_values[i] = is_slsqp ? HUGE_VAL : 10 * (1 + o->most[i]);
    }
    if (o->has_values)
        note_best(o);
    return OK;
}

static Status find_gradient(Optimiser *o, Diag *diag)
{
    const OptimiserProblem *problem = o->problem;
    const int n = problem->unknowns, m = 1 + problem->constraints;
    double *steps = NEW_ARRAY(double, n);
    const Differences differences = {.unknowns = n,
                                     .values = m,
                                     .low = problem->low,
                                     .high = problem->high,
                                     .steps = steps,
                                     .function = problem->function,
                                     .context = problem->context};
    Status status;

    for (int i = 0; i < n; i++)
        steps[i] = fmin(problem->step * o->size[i], (problem->high[i] - problem->low[i]) / 2);
    set_point(o, o->at);
    CHECK(differences_find(&differences, o->x, o->at_raw, o->at_jacobian, &o->best->evaluations,
                           diag));
    for (int i = 0; i < m; i++)
        for (int k = 0; k < n; k++)
            o->at_jacobian[(ptrdiff_t)i * n + k] *= o->size[k] / problem->scales[i];
    o->has_gradient = true;
done:
    mem_free(steps);
    return status;
}

/* what the solver asks for; E_SOLVER ends this method alone */
static Status answer(Optimiser *o, bool is_slsqp, Diag *diag)
{
    const OptimiserProblem *problem = o->problem;
    const size_t n = (size_t)problem->unknowns, m = (size_t)problem->constraints + 1;
    SolverThread *s = &o->solver;

    if (o->best->evaluations >= problem->most_evaluations)
        return diag_set(diag, E_SOLVER, "there are too many runs");
    if (memcmp(o->at, s->u, n * sizeof *s->u) != 0)
        TRY(find_values(o, s->u, is_slsqp, diag));
    if (s->wants_gradient && o->has_values && !o->has_gradient)
        TRY(find_gradient(o, diag));
    memcpy(s->values, o->at_values, m * sizeof *s->values);
    memcpy(s->jacobian, o->at_jacobian, m * n * sizeof *s->jacobian);
    return OK;
}

/* one method from the best point until it returns */
static Status use_method(Optimiser *o, nlopt_algorithm algorithm, double step, Diag *diag)
{
    SolverThread *s = &o->solver;
    Status status = OK;

    if (!open_solver(o, algorithm, step)) {
        close_solver(s);
        return diag_set(diag, E_SOLVER, "the system refuses a thread");
    }
    for (;;) {
        await_turn(s, TURN_CALLER);
        if (s->turn == TURN_OVER)
            break;
        status = answer(o, algorithm == NLOPT_LD_SLSQP, diag);
        s->ends = status != OK;
        give_turn(s, TURN_SOLVER);
    }
    close_solver(s);
    if (s->result == NLOPT_OUT_OF_MEMORY)
        (void)mem_given(NULL);
    o->best->is_converged = status == OK && s->result > 0 && s->result != NLOPT_MAXEVAL_REACHED &&
                            o->best->violation <= o->problem->tolerance;
    return status;
}

static Status use_methods(Optimiser *o, Diag *diag)
{
    const OptimiserMethod method = o->problem->method;
    Status status = OK;

    if (method != OPTIMISER_COBYLA)
        status = use_method(o, NLOPT_LD_SLSQP, first_step, diag);
    if (method != OPTIMISER_SLSQP && !o->best->is_converged && (status == OK || status == E_SOLVER))
        status = use_method(o, NLOPT_LN_COBYLA, method == OPTIMISER_COBYLA ? first_step : next_step,
                            diag);
    return status == E_SOLVER ? OK : status;
}

/* --- the solution --- */

static OptimiserSolution *solution_new(const OptimiserProblem *problem)
{
    OptimiserSolution *out = NEW(OptimiserSolution);

    out->x = NEW_ARRAY(double, problem->unknowns);
    out->values = NEW_ARRAY(double, 1 + problem->constraints);
    out->violation = INFINITY;
    out->worst = -1;
    return out;
}

void optimiser_solution_free(OptimiserSolution *solution)
{
    if (solution == NULL)
        return;
    MEM_FREE(solution->x, solution->values, solution);
}

static void open_unknown(Optimiser *o, int i)
{
    const OptimiserProblem *problem = o->problem;
    const double start = problem->start[i], span = problem->high[i] - problem->low[i];
    const double typical = start != 0 ? fabs(start) : isfinite(span) ? 0.1 * span : 1;

    o->size[i] = fmin(typical, span);
    o->low[i] = (problem->low[i] - start) / o->size[i];
    o->high[i] = (problem->high[i] - start) / o->size[i];
    o->best->x[i] = start;
}

static Optimiser *optimiser_new(const OptimiserProblem *problem)
{
    const int n = problem->unknowns, m = 1 + problem->constraints;
    Optimiser *o = NEW(Optimiser);

    o->problem = problem;
    o->best = solution_new(problem);
    o->size = NEW_ARRAY(double, n);
    o->low = NEW_ARRAY(double, n);
    o->high = NEW_ARRAY(double, n);
    o->x = NEW_ARRAY(double, n);
    o->at = NEW_ARRAY(double, n);
    o->solver.u = NEW_ARRAY(double, n);
    o->most = NEW_ARRAY(double, m);
    o->at_raw = NEW_ARRAY(double, m);
    o->at_values = NEW_ARRAY(double, m);
    o->solver.values = NEW_ARRAY(double, m);
    o->at_jacobian = mem_array((size_t)m * (size_t)n, sizeof(double));
    o->solver.jacobian = mem_array((size_t)m * (size_t)n, sizeof(double));
    o->inequalities = (SolverFunction){o, false};
    o->equalities = (SolverFunction){o, true};
    for (int i = 0; i < n; i++)
        open_unknown(o, i);
    for (int i = 0; i < problem->constraints; i++)
        o->equality_count += problem->is_equality[i];
    return o;
}

static void optimiser_free(Optimiser *o)
{
    optimiser_solution_free(o->best);
    MEM_FREE(o->size, o->low, o->high, o->x, o->at, o->solver.u, o->most, o->at_raw, o->at_values,
             o->solver.values, o->at_jacobian, o->solver.jacobian, o);
}

Status optimiser_solve(const OptimiserProblem *problem, OptimiserSolution **out, Diag *diag)
{
    Optimiser *o = optimiser_new(problem);
    Status status;

    *out = NULL;
    CHECK(find_values(o, o->at, false, diag));
    if (!o->has_values) {
        status = diag_set(diag, E_SOLVER, "the model has no values at the start");
        goto done;
    }
    status = use_methods(o, diag);
    *out = o->best;
    o->best = NULL;
done:
    optimiser_free(o);
    return status;
}
