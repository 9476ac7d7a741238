/* sensitivity_values.c: S+ through the new values of an event, y+ = R(t*, y-, p)
 *
 * R sets values of expressions and meets the constraints again (assemble/reinitialise.h). Along
 * each parameter it is evaluated at two points,
 *
 *     d/dp R = (R(t* + e dt*, y- + e (S- + f- dt*), p + e) - R(t* - e dt*, ..)) / (2 e) */
#include "simulate/sensitivity/sensitivity_impl.h"

#include "base/memory.h"
#include "simulate/assemble/reinitialise.h"

#include <math.h>
#include <string.h>

#define STEP      0x1p-17 /* e, of the parameter's size: errors of e^2, and of rounding over e */
#define SAME      1e-12   /* of the run: an event at an instant */
#define AS_IN_RUN 1e-6    /* of y: how far R may be from what the run has */

/* a variable and its new value */
typedef struct SetValue {
    const NewValue *value;
    Expr resolved;
} SetValue;

/* what happens at a crossing */
typedef struct NewValues {
    SensitivityPass *pass;
    Phase *phase;
    LIST(SetValue) list;
} NewValues;

/* --- which values --- */

static bool happened(const Result *result, const char *name, double t, double span)
{
    for (int i = 0; i < result->events.count; i++) {
        const EventRecord *record = &result->events.at[i];

        if (strcmp(record->name, name) != 0)
            continue;
        for (int k = 0; k < record->count; k++)
            if (fabs(record->times[k] - t) <= SAME * span)
                return true;
    }
    return false;
}

static Status find_values(NewValues *values, double t, Diag *diag)
{
    const Result *result = values->pass->reader->result;
    const SensitivityOrder *order = values->pass->order;
    const double span = result->grid.times[result->grid.count - 1] - result->grid.times[0];

    for (int i = 0; i < order->event_count; i++) {
        const Event *event = order->events[i];

        if (!happened(result, event->name, t, span))
            continue;
        for (int k = 0; k < event->value_count; k++) {
            SetValue set = {.value = &event->values[k]};

            TRY(system_resolve(values->phase->system, set.value->value, &set.resolved, diag));
            LIST_PUSH(values->list, set);
        }
    }
    return OK;
}

/* --- the map --- */

/* set the parameters of the equations that one moves, `by` of its size */
static void set_parameters(const NewValues *values, Parameters *parameters, int parameter,
                           double by)
{
    const SensitivityParameters *of = &values->pass->order->by;

    for (int i = 0; i < of->symbol_count; i++) {
        const double weight = of->weights[i * of->count + parameter];
        const double value =
            parameters_value(&values->pass->reader->phases->parameters, of->symbols[i]) +
            by * weight * of->sizes[parameter];

        if (weight == 0)
            continue;
        parameters_set(parameters, of->symbols[i], value);
        compiled_set(values->phase->numbers, of->symbols[i], value);
    }
}

/* R with the parameters as they are set; y is changed */
static Status apply(const NewValues *values, Parameters *parameters, double t, double *y,
                    Diag *diag)
{
    Phase *phase = values->phase;
    const VariableIndex *l = phase->layout;
    const int count = values->list.count;
    ReinitPlan plan = {l, parameters, compiled_equations(phase->numbers), NULL, 0};
    Expr *roots = NEW_ARRAY(Expr, count);
    double *targets = NEW_ARRAY(double, count);
    Reinit *reinit = NULL;
    Probe *probe = NULL;
    RowValues row;
    Status status = OK;

    plan.rows = motion_rows(phase->motion, &plan.row_count);
    reinit = reinit_new(&plan);
    for (int i = 0; i < count; i++) {
        const SetValue *set = &values->list.at[i];

        CHECK(reinit_add(reinit, set->value->name, set->value->primes, diag));
        roots[i] = set->resolved;
    }
    CHECK(reinit_compile(reinit, diag));
    CHECK(probe_new(l, parameters, roots, count, &probe, diag));
    row = row_of_state(l, t, y);
    if (!probe_reads_state(probe) && !row_solve(l, phase->motion, t, y, &row))
        CHECK(solver_failure(diag, t, "the equations have no solution"));
    memcpy(targets, probe_values(probe, &row), (size_t)count * sizeof(double));
    CHECK(reinit_apply(reinit, t, targets, "an event", y, diag));
done:
    probe_free(probe);
    reinit_free(reinit);
    MEM_FREE(roots, targets);
    return status;
}

/* R at a point off the crossing, `by` times the parameter's size: column of n */
static Status apply_perturbed(const NewValues *values, const CrossingPoint *at, int parameter,
                              double by, double *out, Diag *diag)
{
    const int n = at->n;
    const double *column = at->unknowns + (ptrdiff_t)(parameter + 1) * n;
    Parameters parameters = parameters_like(&values->pass->reader->phases->parameters);
    double *y = NEW_ARRAY(double, n + 1);
    Status status;

    for (int i = 0; i < n; i++)
        y[i] = at->unknowns[i] + by * (column[i] + at->rate[i] * at->instants[parameter]);
    set_parameters(values, &parameters, parameter, by);
    status = apply(values, &parameters, at->t + by * at->instants[parameter], y, diag);
    set_parameters(values, &parameters, parameter, 0);
    memcpy(out, y, (size_t)n * sizeof(double));
    parameters_free(&parameters);
    mem_free(y);
    return status;
}

/* whether R is what the run has done there: not if events set each other off */
static Status check_values(const NewValues *values, const CrossingPoint *at, const double *after,
                           Diag *diag)
{
    double *y = NEW_ARRAY(double, at->n);
    Status status = apply_perturbed(values, at, 0, 0, y, diag);
    double off = 0, size = 1;

    for (int i = 0; i < at->n && status == OK; i++) {
        off = fmax(off, fabs(y[i] - after[i]));
        size = fmax(size, fabs(after[i]));
    }
    if (status == OK && !(off <= AS_IN_RUN * size))
        status = diag_set(diag, E_MODEL,
                          "at t = %.6g s: events set each other off, or an impact follows: there "
                          "are no sensitivities through these",
                          at->t);
    mem_free(y);
    return status;
}

Status sensitivity_new_values(SensitivityPass *pass, const CrossingPoint *at, const double *after,
                              double *out, Diag *diag)
{
    const int count = pass->order->by.count, n = at->n;
    NewValues values = {.pass = pass, .phase = pass->phase};
    double *low = NEW_ARRAY(double, n);
    Status status = OK;

    CHECK(find_values(&values, at->t, diag));
    CHECK(check_values(&values, at, after, diag));
    for (int p = 0; p < count; p++) {
        double *high = out + (ptrdiff_t)p * n;

        CHECK(apply_perturbed(&values, at, p, -STEP, low, diag));
        CHECK(apply_perturbed(&values, at, p, STEP, high, diag));
        for (int i = 0; i < n; i++)
            high[i] = (high[i] - low[i]) / (2 * STEP);
    }
done:
    LIST_FREE(values.list);
    mem_free(low);
    return status;
}
