/* initial_network.c: assembly: states of the network, and the initial guess of the other unknowns
 * of its equations */
#include "simulate/assemble/initial_impl.h"

#include "simulate/equations/failure_diagnosis.h"
#include "simulate/equations/netsolve.h"

#include <math.h>
#include <string.h>

void network_hint(System *system, Diag *diag)
{
    IdealSwitch ideal;
    int i = 0;

    while (i < system_ideal_count(system) && !system_is_ideal(system, i))
        i++;
    if (diag != NULL && diag->hint[0] == '\0' && i < system_ideal_count(system) &&
        system_ideal(system, i, &ideal, NULL) == OK)
        diag_hint(diag,
                  "%s is ideal: where the network can't be on either side of it, give it Ron= and "
                  "Roff=, such as Ron=1 mohm Roff=1 Mohm",
                  ideal.name);
}

Status initial_solve(const VariableIndex *l, const CompiledEquations *numbers, const double *y,
                     const double *guess, double *out, Diag *diag)
{
    const Equations *eq = compiled_equations(numbers);
    NetSolve *solve;
    int lost;
    Status status = OK;

    if (l->nx + l->nz == 0 || eq->network_reads != NULL)
        return OK; /* the network is then solved later, once the motion is known */
    solve = netsolve_new(eq);
    if (guess != NULL)
        memcpy(netsolve_values(solve), guess, (size_t)(l->nx + l->nz) * sizeof(double));
    if (l->multi_turns > 0)
        eq->take_references(eq->context, y + variable_index_references(l));
    eq->position(eq->context, 0, y);
    eq->velocity(eq->context, y + l->n, y + l->n + l->nu);
    if (netsolve_find(solve)) {
        if (out != NULL)
            memcpy(out, netsolve_values(solve), (size_t)(l->nx + l->nz) * sizeof(double));
        goto done;
    }
    lost = netsolve_undetermined(solve);
    if (lost >= 0)
        status = diag_set(diag, E_SINGULAR, "no equation of the network determines %s",
                          expr_name(l->symbols[l->rates + lost]));
    else
        status =
            diag_set(diag, E_SINGULAR, "the network's equations have no solution at the start");
    if (system_ideal_count(l->system) > 0)
        network_hint(l->system, diag);
    else
        diag_hint(diag, lost >= 0 ? "a source or an ideal part fixes the same thing twice: put a "
                                    "resistance or a capacitance there"
                                  : "other initial values, or a resistance beside the part that is "
                                    "steep, may help");
done:
    netsolve_free(solve);
    return status;
}

/* v at rest: states of the state form are 0 */
static Status rest_network(Assembly *a, double *v, Diag *diag)
{
    const VariableIndex *l = a->l;
    Assembly rest = *a;
    Problem p = {0};
    StartValue *values = NULL;
    Rows rows;
    int count = 0;
    Status status = OK;

    while (system_at_rest(l->system, count) != NULL)
        count++;
    values = NEW_ARRAY(StartValue, count);
    rest.given = NEW_ARRAY(GivenValue, count);
    rest.given_count = count;
    for (int i = 0; i < count; i++) {
        values[i].name = system_at_rest(l->system, i);
        rest.given[i].value = &values[i];
        CHECK(system_variable(l->system, values[i].name, 0, &rest.given[i].expr, diag));
        CHECK(initial_classify(&rest, &rest.given[i], diag));
    }
    CHECK(initial_open_problem(&p, &rest, LEVEL_NETWORK, false, diag));
    rows = initial_rows(&p);
    (void)levenberg_marquardt_solve(&rows, NULL, NULL, 1e-11, v, NULL);
done:
    initial_close_problem(&p);
    MEM_FREE(rest.given, values);
    return status;
}

/* index in z of a user's guess; -1: it belongs to another variable */
static int guessed_place(const VariableIndex *l, const GivenValue *given)
{
    for (int i = 0; i < l->nz && given->value->is_guess; i++)
        if (l->symbols[l->z + i] == given->expr)
            return i;
    return -1;
}

Status initial_find_network(Assembly *a, Diag *diag)
{
    const VariableIndex *l = a->l;
    Problem p = {0};
    double *v = NEW_ARRAY(double, 2 * l->nx + l->nz);
    double *residual = NULL;
    bool *held = NEW_ARRAY(bool, 2 * l->nx + l->nz);
    bool needed = system_invariant(l->system, 0) != NULL; /* states have to be solved for, */
    bool solves = false;                                  /* and whether algebraic unknowns too */
    Rows rows;
    Status status = OK;

    if (system_at_rest(l->system, 0) != NULL)
        CHECK(rest_network(a, v, diag));
    for (int i = 0; system_sample(l->system, i) != NULL; i++) {
        const OwnSample *own = system_sample(l->system, i);

        v[own->state] = parameters_evaluate(a->parameters, own->initial);
    }
    for (int i = 0; i < a->given_count; i++) {
        const GivenValue *given = &a->given[i];
        int guessed = guessed_place(l, given);

        if (given->level != LEVEL_NETWORK)
            continue;
        if (guessed >= 0)
            a->out->guess[guessed] = v[2 * l->nx + guessed] = given->value->value;
        /* two names of one state have different values */
        needed = needed || (given->column >= 0 && held[given->column] && !given->value->is_guess &&
                            v[given->column] != given->value->value);
        if (given->column >= 0 && (!held[given->column] || !given->value->is_guess)) {
            v[given->column] = given->value->value;
            held[given->column] = !given->value->is_guess;
        }
        if (given->column < 0 && !given->value->is_guess) {
            needed = true;
            solves = solves || !initial_is_of_states(given);
        }
    }
    if (needed) {
        CHECK(initial_open_problem(&p, a, solves ? LEVEL_NETWORK : LEVEL_STATES, false, diag));
        rows = initial_rows(&p);
        residual = NEW_ARRAY(double, rows.rows);
        if (!levenberg_marquardt_solve(&rows, held, NULL, 1e-11, v, residual))
            CHECK(initial_conflict(&p, residual, "the network's initial values contradict", diag));
    }
    memcpy(a->y + l->n + l->nu, v, (size_t)l->nx * sizeof(double));
    memcpy(a->out->network, v + l->nx, (size_t)(l->nx + l->nz) * sizeof(double));
    /* until the switch states are determined there may be no solution */
    if (!a->has_modes &&
        initial_solve(l, a->numbers, a->y, a->out->network, a->out->network, diag) != OK) {
        (void)failure_beyond(l, a->parameters, 0, a->y, "the network has no solution at the start",
                             diag);
        CHECK(E_SINGULAR);
    }
done:
    initial_close_problem(&p);
    MEM_FREE(v, held, residual);
    return status;
}
