/* mode_start.c: the mode that a run of ideal switches starts in
 *
 * Where what is closed from the start are wires, initial values that weren't given follow from
 * those that were, by least squares. */
#include "simulate/run/mode_start.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/run/charge_sharing.h"
#include "simulate/run/mode_entry.h"
#include "simulate/run/mode_phases.h"

#include <math.h>
#include <string.h>

#define FITS       4    /* of states at a start to those that were given */
#define FOLLOWS    1e-8 /* the weight of one that wasn't */
#define START_STEP 1e-9 /* s: for the sides at a start, where no run says what is short */

/* whether an initial value was given for a state of the whole, or for what follows from it */
static bool is_given(const ActiveRun *r, const SimulationInput *setting, int state)
{
    System *system = phases_whole(r->phases)->system;
    const Expr symbol = system_x(system, state)->symbol;
    bool found = false;

    for (int i = 0; setting->start != NULL && i < setting->start->count && !found; i++) {
        const StartValue *value = &setting->start->at[i];
        Expr e;

        found = !value->is_guess &&
                system_variable(system, value->name, value->primes, &e, NULL) == OK &&
                expr_depends(e, symbol);
    }
    return found;
}

/* How a phase's own states move those of the whole: nx x own, by a difference of this size. */
static bool find_moves(Phase *phase, double t, double *y, double size, int count, double *out)
{
    const VariableIndex *l = phase->layout;
    double *moved = NEW_ARRAY(double, count);
    double *base = NEW_ARRAY(double, count);
    RowValues row;
    bool sound = phase_states(phase, t, y, count, &row, base);

    for (int j = 0; j < l->nx && sound; j++) {
        double *own = &y[l->n + l->nu + j];
        const double was = *own;

        *own += size;
        sound = phase_states(phase, t, y, count, &row, moved);
        *own = was;
        for (int i = 0; i < count; i++)
            out[i * l->nx + j] = (moved[i] - base[i]) / size;
    }
    MEM_FREE(moved, base);
    return sound;
}

/* own += (P^T W P)^-1 P^T W (wanted - now) */
static bool move_nearer(const double *moves, const double *weight, const double *off, int nx,
                        int own, double *at)
{
    Lu *lu = lu_new(own);
    double *move = NEW_ARRAY(double, own);
    bool sound;

    for (int j = 0; j < own; j++)
        for (int k = 0; k < nx; k++) {
            const double part = moves[k * own + j] * weight[k];

            move[j] += part * off[k];
            for (int i = 0; i < own; i++)
                lu_matrix(lu)[j * own + i] += part * moves[k * own + i];
        }
    sound = lu_factor(lu);
    if (sound)
        lu_solve(lu, move);
    for (int j = 0; j < own && sound; j++)
        at[j] += move[j];
    lu_free(lu);
    mem_free(move);
    return sound;
}

/* States of the whole as the phase can have them: those that were given as they are, others as near
 * as they may be. `x` becomes that; false: it has no solution. */
static bool fit_states(ActiveRun *r, Phase *phase, const bool *given, double *y, double *x)
{
    const int nx = phases_whole(r->phases)->layout->nx, own = phase->layout->nx;
    double *moves = NEW_ARRAY(double, nx *own);
    double *weight = NEW_ARRAY(double, nx), *wanted = NEW_ARRAY(double, nx);
    double *off = NEW_ARRAY(double, nx), *now = NEW_ARRAY(double, nx);
    double *at = y + phase->layout->n + phase->layout->nu;
    RowValues row;
    bool sound = find_moves(phase, 0, y, fmax(1, vector_largest(x, nx)), nx, moves) &&
                 phase_states(phase, 0, y, nx, &row, now);

    memcpy(wanted, x, (size_t)nx * sizeof(double));
    for (int turn = 0; turn < FITS && sound; turn++) {
        for (int i = 0; i < nx; i++) {
            weight[i] = given[i] ? 1 : FOLLOWS;
            off[i] = wanted[i] - now[i];
        }
        sound = move_nearer(moves, weight, off, nx, own, at) &&
                phase_states(phase, 0, y, nx, &row, now);
        for (int i = 0; i < nx; i++) /* what others still pull it off */
            wanted[i] += given[i] ? x[i] - now[i] : 0;
    }
    if (sound)
        memcpy(x, now, (size_t)nx * sizeof(double));
    MEM_FREE(moves, weight, wanted, off, now);
    return sound;
}

static Status refuse_given(const ActiveRun *r, const bool *closed, const double *given_x,
                           const bool *given, const double *x, Diag *diag)
{
    const VariableIndex *whole = phases_whole(r->phases)->layout;
    Text what = {0}, values = {0};

    for (int k = 0; k < system_ideal_count(r->system); k++) {
        IdealSwitch ideal;

        if (closed[k] && system_is_ideal(r->system, k) &&
            system_ideal(r->system, k, &ideal, NULL) == OK)
            text_addf(&what, "%s%s", what.length > 0 ? ", " : "", ideal.name);
    }
    for (int i = 0; i < whole->nx; i++)
        if (given[i] && share_is_jump(r, i, given_x[i], x[i]))
            text_addf(&values, "%s%s = %.6g", values.length > 0 ? ", " : "",
                      system_x(whole->system, i)->name, given_x[i]);
    (void)diag_set(diag, E_ASSEMBLE,
                   "the network's initial values contradict with %s closed from the start: %s",
                   what.at, values.at != NULL ? values.at : "");
    diag_hint(diag, "leave one of them out; or let the switch close after the start, as 'when=t > "
                    "0' does: then they share what they store");
    text_free(&what);
    text_free(&values);
    return E_ASSEMBLE;
}

/* Switches that are closed from the start are wires: initial values that weren't given follow from
 * those that were, as they do where parts are joined for good. Diodes are none. */
static Status follow_wires(ActiveRun *r, const SimulationInput *setting, const bool *closed,
                           double *x, Diag *diag)
{
    const VariableIndex *whole = phases_whole(r->phases)->layout;
    const int count = system_ideal_count(r->system);
    bool *wires = NEW_ARRAY(bool, count), *given = NEW_ARRAY(bool, whole->nx);
    double *was = NEW_ARRAY(double, whole->nx), *y = NULL;
    bool any = false;
    Phase *phase;
    Status status = OK;

    for (int k = 0; k < count; k++) {
        IdealSwitch ideal;

        CHECK(system_ideal(r->system, k, &ideal, diag));
        wires[k] = closed[k] && (ideal.when != NULL || !system_is_ideal(r->system, k));
        any = any || (wires[k] && system_is_ideal(r->system, k));
    }
    if (!any || mode_phases_get(r, setting, wires, &phase, NULL) != OK)
        goto done; /* the sides as they are have messages of their own */
    y = NEW_ARRAY(double, phase->length);
    mode_entry(phase, r->result->start.y, x, r->result->start.y + variable_index_references(whole),
               0, y);
    memcpy(was, x, (size_t)whole->nx * sizeof(double));
    for (int i = 0; i < whole->nx; i++)
        given[i] = is_given(r, setting, i);
    if (!fit_states(r, phase, given, y, x)) {
        memcpy(x, was, (size_t)whole->nx * sizeof(double));
        goto done;
    }
    for (int i = 0; i < whole->nx && status == OK; i++)
        if (given[i] && share_is_jump(r, i, was[i], x[i]))
            status = refuse_given(r, wires, was, given, x, diag);
done:
    MEM_FREE(wires, given, was, y);
    return status;
}

static Status begin_phase(ActiveRun *r, const SimulationInput *setting, const ModeSearchAt *at,
                          bool *closed, Diag *diag)
{
    Phase *phase;

    TRY(mode_search_find(r->mode_search, at, closed, diag));
    TRY(mode_phases_get(r, setting, closed, &phase, diag));
    r->phase = phase;
    mem_free(r->begin);
    r->begin = NEW_ARRAY(double, phase->length);
    mode_entry(phase, r->result->start.y, at->x, at->references, 0, r->begin);
    return OK;
}

Status mode_start(ActiveRun *r, const SimulationInput *setting, Diag *diag)
{
    mem_keep(r);
    const VariableIndex *whole = phases_whole(r->phases)->layout;
    double *x = r->result->start.y + whole->n + whole->nu;
    ModeSearchAt at = {.t = 0,
                       .step = START_STEP,
                       .q = r->result->start.y,
                       .u = r->result->start.y + whole->n,
                       .references = r->result->start.y + variable_index_references(whole),
                       .x = x,
                       .x_behind = x};
    bool *closed = NEW_ARRAY(bool, system_ideal_count(r->system));
    bool *none = NEW_ARRAY(bool, system_ideal_count(r->system));
    Status status = OK;

    CHECK(begin_phase(r, setting, &at, closed, diag));
    if (mode_entry_jumps(r, r->phase, 0, r->begin, x)) {
        CHECK(follow_wires(r, setting, closed, x, diag));
        CHECK(begin_phase(r, setting, &at, closed, diag));
    }
    CHECK(mode_entry_check(r, r->phase, &(Entering){.step = at.step, .before = none}, r->begin, x,
                           diag));
    CHECK(initial_solve(r->phase->layout, r->phase->numbers, r->begin, NULL, NULL, diag));
done:
    MEM_FREE(closed, none);
    return status;
}
