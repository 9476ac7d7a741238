/* equilibrium.c: static equilibrium
 *
 * Newton's method (search.c) from the assembled initial state, or from the state in which the
 * network has settled while the mechanics is held. Where that fails a condition is relaxed and
 * restored step by step, as long as Newton's method converges: first source stepping, where
 * gravity, forces and sources grow from 0; then gmin stepping, where a conductance in parallel with
 * every part whose current is an expression of its voltage shrinks to 0. Last comes
 * pseudo-transient continuation (Kelley and Keyes 1998): (J + r I) dw = -F(w), where masses and
 * storage elements I resist the motion, until everything is at rest. */
#include "simulate/run/run.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/analyse/analyse_limits.h"
#include "simulate/analyse/search.h"
#include "simulate/equations/factors.h"
#include "simulate/equations/failure_diagnosis.h"
#include "simulate/equations/rows.h"
#include "simulate/run/begin.h"
#include "simulate/run/sliding.h"

#include <math.h>
#include <string.h>

typedef struct Quest {
    EquilibriumResidual *equations;
    EquilibriumSearch *search;
    const CallMonitor *watch;
    const VariableIndex *l;
    int n;         /* of equations */
    double *begun; /* base */
    double *kept;  /* the same, saved during a trial */
    Bound *bounds; /* ends of validity of parts' laws, */
    int bound_count;
    Probe *measures; /* the expressions that are 0 at these ends, */
    double *sides;   /* and their values at the start of the search */
    int beyond;      /* bound that the last solution violates; -1: none */
} Quest;

static void begin_again(Quest *e)
{
    memcpy(equilibrium_base(e->equations), e->begun,
           (size_t)equilibrium_length(e->equations) * sizeof(double));
    equilibrium_rebase(e->equations);
}

static const double *measures_here(const Quest *e)
{
    const double *v = equilibrium_base(e->equations);
    const RowValues row = {.q = v,
                           .x = v + e->l->n,
                           .references = v + equilibrium_length(e->equations) - e->l->multi_turns};

    return probe_values(e->measures, &row);
}

/* A solution outside the range of a part's law, as a plate beyond its electrode, is not
 * accepted. */
static bool is_within(Quest *e)
{
    const double *values = e->bound_count > 0 ? measures_here(e) : NULL;

    for (int i = 0; i < e->bound_count; i++)
        if (values[i] * e->sides[i] < 0) {
            e->beyond = i;
            return false;
        }
    return true;
}

static bool run_within(Quest *e)
{
    const size_t bytes = (size_t)equilibrium_length(e->equations) * sizeof(double);
    double *base = equilibrium_base(e->equations);
    double *before = NEW_ARRAY(double, equilibrium_length(e->equations));
    bool found;

    memcpy(before, base, bytes);
    found = search_run(e->search);
    if (found && !is_within(e)) {
        found = false;
        memcpy(base, before, bytes);
        equilibrium_rebase(e->equations);
    }
    mem_free(before);
    return found;
}

/* Newton's method, at once or after the network has settled while the mechanics is held */
static bool seek(Quest *e)
{
    const size_t bytes = (size_t)equilibrium_length(e->equations) * sizeof(double);
    double *base = equilibrium_base(e->equations);

    if (run_within(e))
        return true;
    if (e->l->nu == 0 || e->l->nx + e->l->nz == 0)
        return false;
    memcpy(e->kept, base, bytes);
    if (search_settle(e->search) && run_within(e))
        return true;
    memcpy(base, e->kept, bytes);
    equilibrium_rebase(e->equations);
    return false;
}

/* --- continuation paths --- */

/* a path from an easier problem at 0 to the original one at 1; `turn` sets the position on it, and
 * returns false where that changes nothing */
typedef struct Path {
    const char *phase;
    double first; /* step */
    bool (*turn)(EquilibriumResidual *equations, double reached);
} Path;

static bool step_sources(EquilibriumResidual *equations, double reached)
{
    return equilibrium_step_sources(equations, reached);
}

static bool step_gmin(EquilibriumResidual *equations, double reached)
{
    return equilibrium_step_gmin(equations,
                                 reached < 1 ? GMIN * pow(LEAST_GMIN / GMIN, reached) : 0);
}

static const Path paths[] = {
    {"equilibrium: source stepping", 0.25, step_sources},
    {"equilibrium: gmin stepping", 1.0 / 13, step_gmin},
};

static Status follow(Quest *e, const Path *path, bool *found)
{
    double reached = 0, share = path->first;
    Status status = OK;

    begin_again(e);
    *found = path->turn(e->equations, 0) && seek(e);
    while (*found && reached < 1 && share > LEAST_SHARE) {
        const double next = fmin(1, reached + share);

        CHECK(monitor_poll(e->watch));
        monitor_report(e->watch, path->phase, reached);
        (void)path->turn(e->equations, next);
        if (seek(e)) {
            reached = next;
            share *= 2;
        } else {
            share /= 4;
        }
    }
    CHECK(monitor_poll(e->watch));
    *found = reached >= 1;
done:
    (void)path->turn(e->equations, 1);
    return status;
}

/* --- pseudo-transient continuation --- */

typedef struct Creep {
    Factors *factors;
    double *w, *step, *right, *jacobian;
} Creep;

static void creep_close(Creep *c)
{
    factors_free(c->factors);
    MEM_FREE(c->w, c->step, c->right, c->jacobian);
}

/* (J + resistance * inertia) dw = -residual: a step of backward Euler. False: there is none, or it
 * is too long. */
static bool creep_step(Quest *e, Creep *c, double resistance)
{
    const double *values, *missed;
    const int *start, *row;

    equilibrium_pattern(e->equations, &start, &row);
    equilibrium_begin(e->equations, c->w);
    values = equilibrium_jacobian(e->equations, c->w);
    missed = equilibrium_residual(e->equations, c->w);
    memcpy(c->jacobian, values, (size_t)start[e->n] * sizeof(double));
    for (int i = 0; i < e->n; i++)
        c->right[i] = -missed[i];
    equilibrium_add_inertia(e->equations, c->w, resistance, c->jacobian);
    return factors_make(c->factors, c->jacobian) &&
           factors_solve(c->factors, c->right, c->step) >= 0 &&
           vector_largest(c->step, e->l->nu) <= CREEP_STEP;
}

/* make the step, or a part of it for which residuals are defined; returns the growth of the
 * residuals */
static double creep_on(Quest *e, Creep *c)
{
    const double before = search_growth(e->search, c->w);
    double growth = before > 0 ? INFINITY : 0;

    for (double share = 1; growth > CREEP_GROWTH && share > LEAST_SHARE; share /= 4) {
        for (int k = 0; k < e->n; k++)
            c->right[k] = c->w[k] + share * c->step[k];
        growth = search_growth(e->search, c->right) / before;
    }
    if (isfinite(growth) && before > 0) {
        equilibrium_place(e->equations, c->right, equilibrium_base(e->equations));
        equilibrium_rebase(e->equations);
    }
    return growth;
}

static Status creep(Quest *e, bool *found)
{
    const int *start, *row;
    Creep c;
    double resistance = 1e4;
    Status status = OK;

    equilibrium_pattern(e->equations, &start, &row);
    c = (Creep){.factors = factors_new(e->n, start, row, search_may_be_full(e->search)),
                .w = NEW_ARRAY(double, e->n),
                .step = NEW_ARRAY(double, e->n),
                .right = NEW_ARRAY(double, e->n),
                .jacobian = NEW_ARRAY(double, start[e->n])};
    begin_again(e);
    for (int i = 0; i < CREEP_STEPS && resistance > 1e-10 && resistance < 1e12; i++) {
        double growth;

        CHECK(monitor_poll(e->watch));
        monitor_report(e->watch, "equilibrium: creeping", -1);
        if (!creep_step(e, &c, resistance)) {
            resistance *= 4;
            continue;
        }
        growth = creep_on(e, &c);
        resistance *= fmin(4, fmax(0.3, 0.7 * growth));
    }
    *found = seek(e);
    CHECK(monitor_poll(e->watch));
done:
    creep_close(&c);
    return status;
}

/* --- messages --- */

/* name of a state or an algebraic unknown, by its number in (x, z) */
static const char *network_unknown(const Quest *e, int i)
{
    const System *system = e->l->system;

    return i < e->l->nx ? system_x(system, i)->name : system_z(system, i - e->l->nx)->name;
}

/* the same by index in w; NULL: an unknown of the mechanics */
static const char *network_place(const Quest *e, int i)
{
    const VariableIndex *l = e->l;

    if (i < l->nu || (i >= l->nu + l->nx && i < l->nu + l->nx + l->m))
        return NULL;
    return network_unknown(e, i < l->nu + l->nx ? i - l->nu : i - l->nu - l->m);
}

/* " by 3.2", the residual */
static void report_missed(double missed, Text *text)
{
    if (isfinite(missed))
        text_addf(text, " by %.3g", fabs(missed));
    else
        text_add(text, ", undefined where the search ended");
}

static void name_row(const Quest *e, int i, double missed, Text *text)
{
    const VariableIndex *l = e->l;

    if (i < l->nu) {
        int q = speed_coordinate(l->system, i);

        text_addf(text, "the forces on %s",
                  q >= 0 ? system_q(l->system, q)->name : system_u(l->system, i)->name);
    } else if (i < l->nu + l->m) {
        const ConstraintRow *row = system_constraint(l->system, i - l->nu);

        text_addf(text, "%s (%s)", system_instance_name(l->system, row->instance), row->direction);
    } else {
        text_addf(text, "the equation of %s", network_unknown(e, i - l->nu - l->m));
    }
    report_missed(missed, text);
}

static Status report_beyond(const Quest *e, Diag *diag)
{
    const Bound *bound = &e->bounds[e->beyond];
    char *measure = expr_text(bound->measure);

    (void)diag_set(
        diag, E_SOLVER,
        "no equilibrium was found on this side of where %s = 0, where the law of %s ends", measure,
        bound->instance);
    diag_hint(diag, bound->is_gap ? "a field that pulls stronger than what holds against it closes "
                                    "the gap: a smaller voltage or current, or a stop"
                                  : "'init' and 'guess' choose where the search starts");
    mem_free(measure);
    return E_SOLVER;
}

static Status report_failure(Quest *e, Diag *diag)
{
    Text text = {0};
    int shown = 0;

    if (e->beyond >= 0)
        return report_beyond(e, diag);

    for (int i = 0; i < e->n && shown < 6; i++) {
        double missed;

        if (search_holds(e->search, i, &missed))
            continue;
        text_add(&text, shown++ > 0 ? ", " : "");
        name_row(e, i, missed, &text);
    }
    (void)diag_set(diag, E_SOLVER, "no equilibrium was found; missed: %s",
                   text.at != NULL ? text.at : "nothing, but it is undefined there");
    diag_hint(diag, "there is none where something keeps moving; else 'init' and 'guess' choose "
                    "where the search starts");
    text_free(&text);
    return E_SOLVER;
}

/* report a singular network that is too large for full matrices */
static Status refuse_singular(Quest *e, Diag *diag)
{
    const int singular = search_may_be_full(e->search) ? -1 : search_undetermined(e->search);

    if (singular < 0)
        return OK;
    (void)diag_set(diag, E_SINGULAR, "at rest nothing determines %s", network_place(e, singular));
    diag_hint(diag, "lead a resistor, as large as you like, past the capacitors there, or put "
                    "one into the circuit of inductors");
    return E_SINGULAR;
}

static void remark_freedom(const Quest *e, ActiveRun *r)
{
    const int rank = search_rank(e->search);
    const int left = rank < 0 ? 0 : e->n - rank - (e->l->m - r->result->start.row_count);
    const int loose = left == 1 && e->n - rank == 1 ? search_undetermined(e->search) : -1;
    const char *name = loose >= 0 ? network_place(e, loose) : NULL;

    if (left <= 0)
        return;
    if (name != NULL)
        remarks_add(&r->result->remarks, (Remark){.kind = REMARK_REST_OPEN, .what = name});
    else
        remarks_add(&r->result->remarks, (Remark){.kind = REMARK_REST_MANY, .count = left});
}

/* --- the result --- */

/* the efforts that keep unilateral surfaces where they are met, from an equilibrium in which they
 * give a little */
static Status find_efforts(Quest *e, bool *found)
{
    int rounds = 0;
    Status status = OK;

    while (*found && equilibrium_renew_efforts(e->equations) && rounds++ < EFFORT_ROUNDS) {
        CHECK(monitor_poll(e->watch));
        *found = seek(e);
    }
    *found = *found && rounds <= EFFORT_ROUNDS;
done:
    return status;
}

static Status solve(Quest *e, Diag *diag)
{
    bool found;
    Status status = OK;

    equilibrium_begin_efforts(e->equations);
    found = seek(e);
    CHECK(monitor_poll(e->watch));
    for (int i = 0; i < COUNT(paths) && !found; i++)
        CHECK(follow(e, &paths[i], &found));
    if (!found) {
        begin_again(e);
        CHECK(refuse_singular(e, diag));
        CHECK(creep(e, &found));
    }
    CHECK(find_efforts(e, &found));
    if (!found)
        CHECK(report_failure(e, diag));
done:
    if (status == E_STOPPED)
        (void)diag_set(diag, E_STOPPED, "stopped while looking for an equilibrium");
    return status;
}

static Status open_bounds(Quest *e, ActiveRun *start, Diag *diag)
{
    Expr *measures = NULL;
    Status status = OK;

    e->bound_count = system_bounds(e->l->system, &e->bounds);
    if (e->bound_count == 0)
        return OK;
    measures = NEW_ARRAY(Expr, e->bound_count);
    for (int i = 0; i < e->bound_count; i++)
        CHECK(system_resolve(e->l->system, e->bounds[i].measure, &measures[i], diag));
    CHECK(
        probe_new(e->l, &start->phases->parameters, measures, e->bound_count, &e->measures, diag));
    e->sides = NEW_ARRAY(double, e->bound_count);
    memcpy(e->sides, measures_here(e), (size_t)e->bound_count * sizeof(double));
done:
    mem_free(measures);
    return status;
}

static Status quest_open(Quest *e, const SimulationInput *setting, ActiveRun *start, Diag *diag)
{
    const CallMonitor *watch = setting->watch;
    Scene scene = {0};
    size_t bytes;
    Status status = OK;

    *e = (Quest){.watch = watch, .beyond = -1};
    CHECK(setting->scene.make(setting->scene.context, &scene, diag));
    CHECK(equilibrium_new(&scene, start, watch, setting->keeps_rates, setting->at, &e->equations,
                          diag));
    e->l = equilibrium_layout(e->equations);
    e->n = equilibrium_count(e->equations);
    bytes = (size_t)equilibrium_length(e->equations) * sizeof(double);
    e->begun = NEW_ARRAY(double, equilibrium_length(e->equations));
    e->kept = NEW_ARRAY(double, equilibrium_length(e->equations));
    memcpy(e->begun, equilibrium_base(e->equations), bytes);
    CHECK(open_bounds(e, start, diag));
    e->search = search_new(e->equations, watch);
    if (e->search == NULL)
        CHECK(diag_set(diag, E_SOLVER, "SUNDIALS could not be started"));
done:
    scene_free(&scene);
    return status;
}

static void quest_close(Quest *e)
{
    search_free(e->search);
    probe_free(e->measures);
    MEM_FREE(e->bounds, e->sides);
    equilibrium_free(e->equations);
    MEM_FREE(e->begun, e->kept);
}

/* the solution is the initial guess of z */
static void guess_network(const Quest *e, ActiveRun *r)
{
    const VariableIndex *l = phases_whole(r->phases)->layout;

    if (e->l->nz != l->nz)
        return;
    memset(r->result->start.network, 0, (size_t)l->nx * sizeof(double));
    memcpy(r->result->start.network + l->nx, equilibrium_base(e->equations) + l->n + l->nx + l->m,
           (size_t)l->nz * sizeof(double));
}

Status run_equilibrium(System *system, const SimulationInput *setting, Result **out,
                       ResultReader **reader, Diag *diag)
{
    ActiveRun *r = NULL;
    Quest e = {0};
    const VariableIndex *l;
    const double *v;
    double position = 0, velocity = 0;
    Status status = OK;

    CHECK(run_open(RUN_START, system, setting, &r, diag));
    CHECK(phase_refuse_by(r->phase, diag));
    CHECK(quest_open(&e, setting, r, diag));
    l = phases_whole(r->phases)->layout;
    status = solve(&e, diag);
    if (status == E_SOLVER && failure_meeting(l, &r->phases->parameters, 0, r->result->start.y,
                                              "no equilibrium can be found from there", diag))
        status = E_SINGULAR;
    CHECK(status);
    v = equilibrium_base(e.equations);
    memset(r->result->start.y, 0, (size_t)(l->n + l->nu + l->nx) * sizeof(double));
    for (int i = 0; i < l->n; i++) /* differences below the rounding of 1 rad or 1 m are dropped */
        r->result->start.y[i] = fabs(v[i]) < 1e-15 ? 0 : v[i];
    memcpy(r->result->start.y + l->n + l->nu, v + l->n, (size_t)l->nx * sizeof(double));
    memcpy(r->result->start.y + variable_index_references(l),
           v + equilibrium_length(e.equations) - l->multi_turns,
           (size_t)l->multi_turns * sizeof(double));
    guess_network(&e, r);
    if (setting->keeps_rates)
        memcpy(r->result->start.y + l->n, equilibrium_speeds(e.equations),
               (size_t)l->nu * sizeof(double));
    CHECK(run_begin(r, setting, diag));
    if (!motion_project(r->phase->motion, setting->at, r->begin))
        CHECK(diag_set(diag, E_SINGULAR, "the equilibrium is a singular position"));
    remark_freedom(&e, r);
    if (!setting->keeps_rates && vector_largest(r->begin + l->n, l->nu) > 0)
        remarks_add(&r->result->remarks, (Remark){.kind = REMARK_REST_DRIVEN});
    CHECK(slide_begin(r, setting, setting->at, r->begin, diag));
    active_run_add_row(r, setting->at, r->begin);
    motion_residuals(r->phase->motion, setting->at, r->begin, &position, &velocity);
    r->result->monitor_report.position_residual = position;
    r->result->monitor_report.velocity_residual = velocity;
    active_run_finish(r, out, reader);
    r = NULL;
done:
    quest_close(&e);
    active_run_free(r);
    return status;
}
