/* fmu_open.c: outputs that depend on undetermined directions
 *
 * Their derivatives are marked. */
#define FMU_TABLES
#include "fmu.h"

#include <stdio.h>
#include <string.h>

#define OPEN 1e-7 /* of the change of an output: a smaller undetermined part counts as 0 */

/* Directions that the equations don't determine are shared out by a rule, to the least or to equal
 * values. Outputs that depend on them have no derivatives: NAN, and a warning. */
FmuStatus fmu_mark_open(Fmu *fmu, const unsigned *unknowns, size_t count, double *outputs)
{
    FmuNumbers *now = &fmu->now;
    double along[MODEL_OUTPUTS + 1], uneven[MODEL_OUTPUTS + 1];
    double *seed = now->s + MODEL_S, *ds = seed + 1 + MODEL_Y;
    FmuStatus status = FMU_OK;
    size_t i;
    int k, any = 0;

    for (i = 0; i < count; i++)
        any |= unknowns[i] >= FMU_FIRST_OUTPUT && unknowns[i] < FMU_FIRST_INDICATOR;
    if (!any)
        return FMU_OK;
    memset(seed, 0, FMU_SEEDS * sizeof(double));
    if (model_open(now->p, now->t, now->y, now->s, fmu->work) != MODEL_OK)
        return fmu_fail(fmu, FMU_DISCARD, "the equations are singular", now->y[0]);
    model_tangent_outputs(now->p, now->t, now->y, now->s, along);
    for (k = 0; k < MODEL_S; k++)
        ds[k] *= 1 + fmod(k * 0.6180339887498949, 1); /* all different: nothing cancels */
    model_tangent_outputs(now->p, now->t, now->y, now->s, uneven);
    for (i = 0; i < count; i++) {
        char line[160];

        k = (int)unknowns[i] - FMU_FIRST_OUTPUT;
        if (k < 0 || k >= MODEL_OUTPUTS || !(fabs(along[k]) > OPEN * fabs(uneven[k])))
            continue;
        outputs[k] = NAN;
        (void)snprintf(line, sizeof line,
                       "%.80s is shared by what nothing determines: NaN is its derivative",
                       fmu_output_name[k]);
        status = fmu_fail(fmu, FMU_WARNING, line, now->y[0]);
    }
    return status;
}
