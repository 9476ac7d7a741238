/* phase.c: equations of a part of a run */
#include "simulate/run/phase.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "base/random.h"

#include <string.h>

#define UNSOLVED     3    /* times that a value has to be the same */
#define FAR          1e3  /* what isn't known is taken up to this, of either sign */
#define FEW          100  /* unknowns up to which radau's dense factors beat bdf's */
#define OPEN         10   /* exponents that tolerances move by more than this could be anything, */
#define UNDETERMINED 1e3  /* and by this, so could states that such exponents act on, */
#define HISTORY      1e2  /* or by this in methods with a history, which see less of a short way: */
#define STIFFER      1e2  /* times by which these change more than where all elements conduct */
#define BLOCKED      1e-6 /* slope of an element that blocks, */
#define CONDUCTS     1e15 /* and of one that conducts */

static bool *copy_sides(const bool *closed, int count)
{
    bool *copy = NEW_ARRAY(bool, count);

    memcpy(copy, closed, (size_t)count * sizeof(bool));
    return copy;
}

static OnSurface *copy_on(const OnSurface *on, int count)
{
    OnSurface *copy = NEW_ARRAY(OnSurface, count);

    for (int i = 0; i < count; i++)
        copy[i] = on[i];
    return copy;
}

Status phase_new(System *system, Parameters *parameters, const bool *closed, int count, Phase **out,
                 Diag *diag)
{
    return phase_new_on(system, parameters, closed, count, NULL, 0, out, diag);
}

Status phase_new_on(System *system, Parameters *parameters, const bool *closed, int count,
                    const OnSurface *on, int on_count, Phase **out, Diag *diag)
{
    Phase *phase = NEW(Phase);
    const bool before = mem_scratch(true);
    Status status = OK;

    phase->system = system;
    phase->layout = variable_index_new_on(system, on, on_count);
    phase->like = phase;
    if (closed != NULL)
        phase->closed = copy_sides(closed, count);
    phase->on = copy_on(on, on_count);
    phase->on_count = on_count;
    phase_enter(phase);
    CHECK(compiled_new(phase->layout, parameters, &phase->numbers, diag));
    *out = phase;
    phase = NULL;
done:
    (void)mem_scratch(before);
    phase_free(phase);
    return status;
}

Phase *phase_new_like(Phase *other, const bool *closed, int count, const OnSurface *on)
{
    Phase *phase = NEW(Phase);

    *phase = *other->like;
    phase->closed = closed != NULL ? copy_sides(closed, count) : NULL;
    phase->on = copy_on(on, phase->on_count);
    return phase;
}

void phase_enter(const Phase *phase)
{
    if (phase->closed != NULL)
        variable_index_set_sides(phase->layout, phase->closed);
    if (variable_index_is_on(phase->layout, phase->on))
        return;
    variable_index_set_on(phase->layout, phase->on);
    compiled_enter_mode(phase->numbers);
    motion_enter_mode(phase->motion);
}

/* exact derivatives of the rates and of the implicit equations, for implicit methods */
static void offer_jacobians(Phase *phase, Parameters *parameters)
{
    phase->jacobian = rate_jacobian_new(phase->layout, parameters, phase->motion);
    motion_offer_jacobian(phase->motion, (OdeJacobian){phase->jacobian, rate_jacobian_at});
    phase->implicit = implicit_jacobian_new(phase->layout, parameters, phase->motion);
    motion_offer_implicit(
        phase->motion,
        (ImplicitJacobian){phase->implicit, implicit_jacobian_pattern, implicit_jacobian_at});
}

Status phase_open(Phase *phase, Parameters *parameters, const MotionOptions *options, Host *host,
                  Diag *diag)
{
    const bool before = mem_scratch(true);
    Status status = OK;

    phase->motion = motion_new(compiled_equations(phase->numbers), options);
    phase->length = motion_length(phase->motion);
    if (phase->on_count == 0)
        phase->network = netdae_new(phase->layout, parameters, phase->motion);
    if (phase->network != NULL)
        ode_set_jacobian(phase->motion, netdae_equations(phase->network));
    else
        offer_jacobians(phase, parameters);
    CHECK(samples_new(phase->layout, parameters, phase->motion, host, &phase->samples, diag));
    CHECK(stiff_elements_new(phase->layout, parameters, phase->motion,
                             compiled_equations(phase->numbers), &phase->stiff_elements, diag));
    phase->onset = onset_new(phase->stiff_elements, motion_ode(phase->motion));
done:
    (void)mem_scratch(before);
    return status;
}

void phase_free(Phase *phase)
{
    if (phase == NULL)
        return;
    MEM_FREE(phase->closed, phase->on);
    if (phase->like != phase) {
        mem_free(phase);
        return;
    }
    events_free(phase->events);
    samples_free(phase->samples);
    onset_free(phase->onset);
    stiff_elements_free(phase->stiff_elements);
    probe_free(phase->seen);
    probe_free(phase->states);
    mem_free(phase->among_whole);
    netdae_free(phase->network);
    rate_jacobian_free(phase->jacobian);
    implicit_jacobian_free(phase->implicit);
    motion_free(phase->motion);
    compiled_free(phase->numbers);
    variable_index_free(phase->layout);
    mem_free(phase);
}

const Method *phase_stiff_method(const Phase *phase)
{
    const bool is_network = phase->network != NULL;
    /* with switches a method of many steps would always begin anew */
    const bool one_step =
        phase->length + phase->layout->nz <= FEW || (phase->closed != NULL && is_network);

    return method_for(
        (MethodNeed){.stiff = true, .history = !one_step, .dae = !one_step && is_network});
}

const Method *phase_coupled_method(const Phase *phase)
{
    return phase->network != NULL && phase->layout->nz > 0
               ? method_for((MethodNeed){.stiff = true, .history = true, .dae = true})
               : NULL;
}

/* what the tolerances of states leave open */
typedef struct Openness {
    double most; /* what they move an element's argument by, while none conducts, at most; */
    int element; /* which one; */
    int state;   /* one whose rate that moves much more than while all conduct; -1: none */
} Openness;

/* Parts of the tolerances don't cancel: each counts more than the one before. */
static void take_tolerances(const VariableIndex *l, const double *y, const Control *control,
                            double *off)
{
    for (int i = 0; i < l->nx; i++)
        off[l->n + l->nu + i] =
            (control->atol + control->rtol * fabs(y[l->n + l->nu + i])) * (1 + (double)i / l->nx);
}

static int largest_at(const double *v, int count)
{
    int most = 0;

    for (int i = 1; i < count; i++)
        if (fabs(v[i]) > fabs(v[most]))
            most = i;
    return most;
}

static Openness find_openness(const Phase *phase, double t, const double *y, const Control *control)
{
    const VariableIndex *l = phase->layout;
    const int elements = stiff_elements_element_count(phase->stiff_elements);
    double *off = NEW_ARRAY(double, phase->length), *own = off + l->n + l->nu;
    double *moved = NEW_ARRAY(double, elements), *there = NEW_ARRAY(double, elements);
    double *blocked = NEW_ARRAY(double, l->nx), *conducting = NEW_ARRAY(double, l->nx);
    double most = STIFFER;
    Openness out = {.most = INFINITY, .state = -1};

    take_tolerances(l, y, control, off);
    if (stiff_elements_answers(phase->stiff_elements, t, y, off, BLOCKED, moved, blocked)) {
        out.element = largest_at(moved, elements);
        out.most = fabs(moved[out.element]);
        if (!stiff_elements_answers(phase->stiff_elements, t, y, off, CONDUCTS, there, conducting))
            most = INFINITY;
        for (int i = 0; i < l->nx; i++) {
            const double slow = fabs(conducting[i]) + own[i] / control->span;

            if (fabs(blocked[i]) > most * slow) {
                most = fabs(blocked[i]) / slow;
                out.state = i;
            }
        }
    }
    MEM_FREE(off, moved, there, blocked, conducting);
    return out;
}

static Status refuse_undetermined(const Phase *phase, double t, const Openness *open,
                                  const Method *method, Diag *diag)
{
    const Method *coupled = phase_coupled_method(phase);
    const char *variable = stiff_elements_variable(phase->stiff_elements, open->element);
    const int part = (int)strcspn(variable, ".");

    (void)diag_set(diag, E_SOLVER,
                   "at t = %.9g s: %s takes %s from %s, whose tolerance leaves it open", t,
                   method->name, variable, system_x(phase->system, open->state)->name);
    if (coupled != NULL)
        diag_hint(diag,
                  "method=%s solves for both together; or a resistor across %.*s, or a finer "
                  "atol=, determines it",
                  coupled->name, part, variable);
    else
        diag_hint(diag, "a resistor across %.*s, or a finer atol=, determines it", part, variable);
    return E_SOLVER;
}

Status phase_choose_method(const Phase *phase, double t, const double *y, const Control *control,
                           const Method **method, Diag *diag)
{
    const Method *coupled = phase_coupled_method(phase);
    Openness open;

    if (phase->stiff_elements == NULL || stiff_elements_element_count(phase->stiff_elements) == 0 ||
        phase->layout->nx == 0)
        return OK;
    open = find_openness(phase, t, y, control);
    onset_leave_open(phase->onset, coupled != NULL && open.most > OPEN);
    if (*method == NULL && open.most > OPEN)
        *method = coupled;
    if (open.most > (*method != NULL && (*method)->has_history ? HISTORY : UNDETERMINED) &&
        open.state >= 0 && (coupled == NULL || *method != coupled))
        return refuse_undetermined(phase, t, &open,
                                   *method != NULL ? *method : method_for((MethodNeed){0}), diag);
    return OK;
}

bool phase_row(Phase *phase, double t, const double *y, RowValues *out)
{
    phase_enter(phase);
    return row_solve(phase->layout, phase->motion, t, y, out);
}

bool phase_states(Phase *phase, double t, const double *y, int count, RowValues *row, double *out)
{
    if (!phase_row(phase, t, y, row))
        return false;
    memcpy(out, probe_values(phase->states, row), (size_t)count * sizeof(double));
    return true;
}

/* The same at a row of a driven run, where x', z, u', lambda and efforts are known: its block, or
 * NULL to solve. */
static bool driven_row(Phase *phase, double t, const double *y, const double *driven,
                       RowValues *out)
{
    const VariableIndex *l = phase->layout;

    if (driven == NULL)
        return phase_row(phase, t, y, out);
    phase_enter(phase);
    *out = row_of_state(l, t, y);
    out->rates = driven;
    out->z = driven + l->nx;
    out->acceleration = driven + l->nx + l->nz;
    out->multipliers = out->acceleration + l->nu;
    out->efforts = out->multipliers + l->m;
    return true;
}

/* Where the equations have no solution what they would solve for may be anything: values that
 * don't change with it, as those of coordinates, are known all the same. */
static void probe_unsolved(const Phase *phase, Probe *probe, double t, const double *y, int count,
                           double *out)
{
    const VariableIndex *l = phase->layout;
    double *any = NEW_ARRAY(double, l->count);
    RowValues row = row_of_state(l, t, y);
    uint64_t seed = 1;

    row.signs = row.rates = row.z = row.acceleration = row.multipliers = row.efforts = row.jerk =
        any;
    for (int turn = 0; turn < UNSOLVED; turn++) {
        const double *values;

        for (int i = 0; i < l->count; i++)
            any[i] = FAR * random_unit(&seed);
        values = probe_values(probe, &row);
        for (int k = 0; k < count; k++)
            out[k] = turn == 0 || out[k] == values[k] ? values[k] : NAN;
    }
    mem_free(any);
}

void phase_probe_at(Phase *phase, Probe *probe, double t, const double *y, const double *driven,
                    int count, double *out)
{
    RowValues row;

    phase_enter(phase);
    if (probe_reads_state(probe)) {
        row = row_of_state(phase->layout, t, y);
        memcpy(out, probe_values(probe, &row), (size_t)count * sizeof(double));
    } else if (driven_row(phase, t, y, driven, &row))
        memcpy(out, probe_values(probe, &row), (size_t)count * sizeof(double));
    else
        probe_unsolved(phase, probe, t, y, count, out);
}

Status phase_refuse_open(const Phase *phase, Diag *diag)
{
    const Expr open = system_open_potential(phase->system, 0);

    if (open == NULL)
        return OK;
    (void)diag_set(diag, E_MODEL, "%s is not known: nothing stands on that terminal",
                   expr_name(open));
    diag_hint(diag, "connect a part to it, such as a source");
    diag_about(diag, "%s", expr_name(open));
    return E_MODEL;
}

Status phase_refuse_by(const Phase *phase, Diag *diag)
{
    const VariableIndex *l = phase->layout;

    if (l->ne == 0)
        return OK;
    TRY(phase_refuse_open(phase, diag));
    (void)diag_set(diag, E_MODEL, "a driver with by= is for inverse runs: %s is not known here",
                   expr_name(l->symbols[l->efforts]));
    diag_hint(diag, "use `inverse`, or leave by= out");
    return E_MODEL;
}
