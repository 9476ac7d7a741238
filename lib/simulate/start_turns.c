/* start_turns.c: the turns in which a start looks for angles */
#include "simulate/start.h"

#include <math.h>
#include <string.h>

/* where a driver has an angle at t = 0 */
static Status find_driven(const Layout *layout, Parameters *parameters, Expr prescribed,
                          double *out, Diag *diag)
{
    const RowValues row = {.t = 0};
    Probe *probe = NULL;
    Status status = OK;

    CHECK(probe_new(layout, parameters, &prescribed, 1, &probe, diag));
    *out = probe_values(probe, &row)[0];
done:
    probe_free(probe);
    return status;
}

/* the value of that name, or a guess of it where there is none; NAN */
static double given_value(const Setting *setting, const char *name)
{
    double value = NAN;
    bool is_guess = true;

    for (int i = 0; setting->start != NULL && i < setting->start->count; i++) {
        const StartValue *given = &setting->start->at[i];

        if (given->primes == 0 && strcmp(given->name, name) == 0 &&
            (is_guess || !given->is_guess)) {
            value = given->value;
            is_guess = given->is_guess;
        }
    }
    return value;
}

Status start_turns(const Layout *layout, Parameters *parameters, const Setting *setting,
                   WarmValue warm, void *warm_context, double *near, Diag *diag)
{
    Status status = OK;

    for (int k = 0; k < layout->turned; k++) {
        const Turned *turned = system_turned(layout->system, k);
        double value = given_value(setting, turned->name);

        if (turned->prescribed != NULL)
            CHECK(find_driven(layout, parameters, turned->prescribed, &value, diag));
        else if (isnan(value) && warm != NULL)
            value = warm(warm_context, turned->name);
        near[k] = isfinite(value) ? value : 0;
    }
done:
    return status;
}
