/* initial_turns.c: initial values of driven coordinates, and whole turns of sums of angles */
#include "simulate/assemble/initial_impl.h"

#include <math.h>

Status initial_driven(const Assembly *a, Expr prescribed, double *out, Diag *diag)
{
    const RowValues row = {.t = a->t};

    return probe_at(a->l, a->parameters, prescribed, &row, out, diag);
}

static double whole(double angle)
{
    return 2 * M_PI * round(angle / (2 * M_PI));
}

Status initial_whole_turns(Assembly *a, const double *angles, Diag *diag)
{
    const VariableIndex *l = a->l;
    const int count = system_whole_turns_count(l->system);
    Expr *sums = NEW_ARRAY(Expr, count);
    double *turns = NEW_ARRAY(double, count);
    const RowValues row = row_of_state(l, 0, a->y);
    const double *values;
    Probe *probe = NULL;
    Status status = OK;

    for (int i = 0; i < count; i++) {
        const WholeTurns *of = system_whole_turns(l->system, i);

        sums[i] = of->sum;
        parameters_set(a->parameters, of->symbol, 0);
    }
    if (count == 0)
        goto done;
    CHECK(probe_new(l, a->parameters, sums, count, &probe, diag));
    values = probe_values(probe, &row);
    for (int i = 0; i < count; i++) {
        const WholeTurns *of = system_whole_turns(l->system, i);

        turns[i] = whole(of->name != NULL ? angles[i] - values[i] : -values[i]);
        parameters_set(a->parameters, of->symbol, turns[i]);
        compiled_set(a->numbers, of->symbol, turns[i]);
    }
done:
    probe_free(probe);
    MEM_FREE(sums, turns);
    return status;
}
