/* mode_entry.c: whether a phase can begin with what the one before it stored */
#include "simulate/run/mode_entry.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/run/charge_sharing.h"

#include <math.h>
#include <string.h>

#define JUMP   1e-6 /* of the largest state, more than location may change it, */
#define ERRORS 100  /* and of the tolerance: what errors may */

void mode_entry(const Phase *phase, const double *y, const double *x, const double *near,
                double work, double *out)
{
    const VariableIndex *l = phase->layout;

    memcpy(out, y, (size_t)(l->n + l->nu) * sizeof(double));
    for (int i = 0; i < l->nx; i++)
        out[l->n + l->nu + i] = x[phase->among_whole[i]];
    memcpy(out + variable_index_references(l), near, (size_t)l->multi_turns * sizeof(double));
    out[phase->length - 1] = work;
}

static void name_sides(const ActiveRun *r, const bool *before, const bool *closed, Text *out)
{
    for (int k = 0; k < system_ideal_count(r->system); k++) {
        IdealSwitch ideal;

        if (closed[k] == before[k] || system_ideal(r->system, k, &ideal, NULL) != OK)
            continue;
        text_addf(out, "%s%s %s", out->length > 0 ? ", " : "", ideal.name,
                  closed[k] ? "closes" : "opens");
    }
    if (out->length == 0)
        text_add(out, "sources jump");
}

/* An impulse of one kind would be given by a source of the other alone, where there is one. */
static Status refuse_jump(const ActiveRun *r, const char *sides, double t, double step,
                          const char *state, double from, double to, Diag *diag)
{
    const char *source = mode_search_source(r->mode_search, step);
    Text who = {0};

    if (source != NULL)
        text_addf(&who, ": %s alone would have to give the impulse", source);
    (void)diag_set(diag, E_SOLVER, "%s at t = %.9g s, and %s would jump from %.6g to %.6g%s", sides,
                   t, state, from, to, who.at != NULL ? who.at : "");
    text_free(&who);
    return E_SOLVER;
}

Status mode_entry_check(ActiveRun *r, Phase *phase, Entering *entry, double *y, double *x,
                        Diag *diag)
{
    const VariableIndex *whole = phases_whole(r->phases)->layout;
    double largest = vector_largest(x, whole->nx);
    const double *now;
    Text sides = {0};
    RowValues row;
    Status status = OK;
    int jumping = 0, broken = 0;
    double from, to;

    if (!phase_row(phase, entry->t, y, &row))
        return OK; /* that has its own message */
    now = probe_values(phase->states, &row);
    largest = fmax(largest, vector_largest(now, whole->nx));
    while (jumping < whole->nx && !share_is_jump(r, jumping, x[jumping], now[jumping]))
        jumping++;
    while (system_invariant(phase->system, broken) != NULL &&
           !(fabs(now[whole->nx + broken]) > JUMP * largest + ERRORS * r->phases->tolerance))
        broken++;
    if (jumping == whole->nx && system_invariant(phase->system, broken) == NULL)
        return OK;
    from = jumping < whole->nx ? x[jumping] : 0;
    to = jumping < whole->nx ? now[jumping] : 0;
    name_sides(r, entry->before, phase->closed, &sides);
    if (entry->may_share && share_stored(r, phase, entry->t, entry->before, sides.at, y, x)) {
        Entering shared = {.t = entry->t, .step = entry->step, .before = entry->before};

        entry->shared = true;
        status = mode_entry_check(r, phase, &shared, y, x, diag);
        goto done;
    }
    if (jumping < whole->nx)
        status = refuse_jump(r, sides.at, entry->t, entry->step,
                             system_x(whole->system, jumping)->name, from, to, diag);
    else
        status = diag_set(diag, E_SOLVER, "%s at t = %.9g s, and what is stored would jump",
                          sides.at, entry->t);
    diag_hint(diag, "a resistance in that circuit, a diode for the current, or Ron= and Roff= "
                    "of the switch, make it a fast change");
done:
    text_free(&sides);
    return status;
}

bool mode_entry_jumps(const ActiveRun *r, Phase *phase, double t, double *y, const double *x)
{
    const int nx = phases_whole(r->phases)->layout->nx;
    double *now = NEW_ARRAY(double, nx);
    RowValues row;
    bool found = false;

    if (phase_states(phase, t, y, nx, &row, now))
        for (int i = 0; i < nx; i++)
            found = found || share_is_jump(r, i, x[i], now[i]);
    mem_free(now);
    return found;
}
