/* fmu.c: an instance: its variables, its events, its states onto the constraints */
#define FMU_TABLES
#include "fmu.h"

#include <stdio.h>
#include <string.h>

enum { ROUNDS = 100 };  /* in which one event may set off others */
#define INSTANT   1e-12 /* of time, in units of 1 + |t|: instants that can't be distinguished */
#define LATE      10.0  /* times the delay with which an importer detected an event: uncertain */
#define LATEST    1e-3  /* s: later than that nothing was found there */
#define SAME      1e-9  /* of a period: sampling instants that can't be distinguished */
#define DRIFT     10.0  /* of the tolerance: how far a state may leave the constraints */
#define PROJECTED 1e-12 /* accuracy of the projection */
#define NEAR      1e-9  /* of 1 + |t|: how far ahead sides of ideal switches are looked for, */
#define FURTHEST  1e-5  /* and where they don't change, though a margin has ended */
#define ROUNDING                                                                                   \
    1e-11 /* of the largest current or voltage: margins that can't be distinguished from 0 */

FmuStatus fmu_fail(Fmu *fmu, FmuStatus status, const char *text, double value)
{
    char line[300];

    (void)snprintf(line, sizeof line, "%s at t = %.9g s (%.6g)", text, fmu->now.t, value);
    fmu_log(fmu, status, line);
    if (status >= FMU_ERROR)
        fmu->now.mode = FMU_FAILED;
    return status;
}

/* --- numbers --- */

static void changed(Fmu *fmu)
{
    fmu->now.is_solved = 0;
    fmu->now.is_changed = 1;
}

void fmu_prepare(Fmu *fmu)
{
    FmuNumbers *now = &fmu->now;
    int i;

    for (i = 0; i < FMU_SIDES; i++)
        now->p[FMU_FIRST_SIDE + i] = now->side[i] != 0 ? now->side[i] : now->sign[fmu_slide_of[i]];
    if (FMU_PARAMETERS > 0) {
        model_relations(now->p, now->t, now->y, now->s, fmu->work);
        memcpy(now->p, fmu->work, FMU_PARAMETERS * sizeof(double));
    }
    model_prepare(now->p);
    now->is_solved = 0;
}

void fmu_reset(Fmu *fmu)
{
    FmuNumbers *now = &fmu->now;
    int i;

    memset(now, 0, sizeof *now);
    now->mode = FMU_INSTANTIATED;
    now->next = HUGE_VAL;
    now->sampled = -HUGE_VAL;
    now->tolerance = FMU_TOLERANCE;
    model_parameters(now->p);
    model_start(now->y, now->s);
    for (i = 0; i < FMU_SIDES; i++)
        now->side[i] = 1;
#ifdef MODEL_HAS_MODES
    for (i = 0; i < FMU_SWITCHES; i++)
        now->side[FMU_SIDES + i] = now->p[MODEL_CLOSED + i] > 0.5 ? 1 : -1;
#endif
    fmu_prepare(fmu);
}

/* s at the time and state of now */
static FmuStatus solve(Fmu *fmu)
{
    FmuNumbers *now = &fmu->now;
    double was[MODEL_S + 1];
    int status;

    if (now->is_solved)
        return FMU_OK;
    memcpy(was, now->s, MODEL_S * sizeof(double));
#ifdef FMU_HAS_SLIDES
    status = fmu_slide_solve(fmu);
#else
    status = model_solve(now->p, now->t, now->y, now->s, fmu->work);
#endif
    if (status != MODEL_OK)
        memcpy(now->s, was, MODEL_S * sizeof(double));
    if (status != MODEL_OK)
        return fmu_fail(fmu, FMU_DISCARD,
                        status == MODEL_SINGULAR ? "the equations are singular"
                                                 : "the equations have no solution",
                        now->y[0]);
    now->is_solved = 1;
    return FMU_OK;
}

FmuStatus fmu_get(Fmu *fmu, unsigned reference, double *value)
{
    FmuNumbers *now = &fmu->now;
    const int at = (int)reference;
    FmuStatus status;

    if (reference >= FMU_VARIABLES)
        return fmu_fail(fmu, FMU_ERROR, "no variable has that value reference", reference);
    if (at == 0)
        *value = now->t;
    else if (at < FMU_FIRST_STATE)
        *value = now->p[at - FMU_FIRST_PARAMETER];
    else if (at < FMU_FIRST_RATE)
        *value = now->y[at - FMU_FIRST_STATE];
    else {
        status = solve(fmu);
        if (status != FMU_OK)
            return status;
        if (at < FMU_FIRST_OUTPUT) {
            model_derivative(now->p, now->t, now->y, now->s, fmu->work);
            *value = fmu->work[at - FMU_FIRST_RATE];
        } else if (at < FMU_FIRST_INDICATOR) {
            model_outputs(now->p, now->t, now->y, now->s, fmu->work);
            *value = fmu->work[at - FMU_FIRST_OUTPUT];
        } else {
            double all[FMU_INDICATORS + 1];

            status = fmu_indicators(fmu, all);
            *value = all[at - FMU_FIRST_INDICATOR];
            return status;
        }
    }
    return FMU_OK;
}

FmuStatus fmu_set(Fmu *fmu, unsigned reference, double value)
{
    FmuNumbers *now = &fmu->now;
    const int at = (int)reference;
    const int is_parameter = at >= FMU_FIRST_PARAMETER && at < FMU_FIRST_STATE;
    const int is_state = at >= FMU_FIRST_STATE && at < FMU_FIRST_RATE;
    const int is_input = is_state && fmu_is_input[at - FMU_FIRST_STATE];

    if (reference >= FMU_VARIABLES)
        return fmu_fail(fmu, FMU_ERROR, "no variable has that value reference", reference);
    if (is_input && now->mode == FMU_CONTINUOUS) {
        now->y[at - FMU_FIRST_STATE] = value; /* no event before event mode */
        now->is_solved = 0;
        return FMU_OK;
    }
    if (is_parameter && now->mode != FMU_CONTINUOUS && !fmu_depends[at - FMU_FIRST_PARAMETER]) {
        now->p[at - FMU_FIRST_PARAMETER] = value;
        fmu_prepare(fmu);
    } else if (is_input || (is_state && (now->mode & (FMU_INSTANTIATED | FMU_INITIALISING)) != 0))
        now->y[at - FMU_FIRST_STATE] = value;
    else
        return fmu_fail(fmu, FMU_ERROR, "this variable can't be set here", reference);
    changed(fmu);
    return FMU_OK;
}

void fmu_set_time(Fmu *fmu, double t)
{
    if (t > fmu->now.t || t < fmu->now.t)
        fmu->now.is_solved = 0;
    fmu->now.t = t;
}

void fmu_set_states(Fmu *fmu, const double *y)
{
    memcpy(fmu->now.y, y, FMU_STATES * sizeof(double));
    fmu->now.is_solved = 0;
}

FmuStatus fmu_rates(Fmu *fmu, double *rates)
{
    const FmuStatus status = solve(fmu);

    if (status == FMU_OK) {
        model_derivative(fmu->now.p, fmu->now.t, fmu->now.y, fmu->now.s, fmu->work);
        memcpy(rates, fmu->work, FMU_STATES * sizeof(double));
    }
    return status;
}

void fmu_set_continuous(Fmu *fmu, const double *x)
{
    int i;

    for (i = 0; i < FMU_STATES; i++)
        if (!fmu_is_input[i])
            fmu->now.y[i] = *x++;
    fmu->now.is_solved = 0;
}

static void take_continuous(const double *all, double *x)
{
    int i;

    for (i = 0; i < FMU_STATES; i++)
        if (!fmu_is_input[i])
            *x++ = all[i];
}

void fmu_continuous(const Fmu *fmu, double *x)
{
    take_continuous(fmu->now.y, x);
}

FmuStatus fmu_continuous_rates(Fmu *fmu, double *rates)
{
    double all[FMU_STATES + 1];
    const FmuStatus status = fmu_rates(fmu, all);

    if (status == FMU_OK)
        take_continuous(all, rates);
    return status;
}

/* all of them, those of time first */
static FmuStatus measures(Fmu *fmu, double *out)
{
    const FmuStatus status = solve(fmu);

    if (status == FMU_OK)
        model_indicators(fmu->now.p, fmu->now.t, fmu->now.y, fmu->now.s, out);
    return status;
}

int fmu_sense(const FmuNumbers *now, int i)
{
    return now->side[i] != 0 ? now->side[i] : 1;
}

/* a measure; or how far its sign is within bounds, while it is slid along */
static double until_its_end(const FmuNumbers *now, int i, double v)
{
    const int k = i < FMU_SIDES ? fmu_slide_of[i] : -1;

    if (k < 0)
        return v;
    if (now->side[i] == 0)
        return (now->bound[k] - now->sign[k]) * (now->bound[k] + now->sign[k]);
    return now->held[k] ? now->side[i] : v;
}

FmuStatus fmu_indicators(Fmu *fmu, double *out)
{
    double all[FMU_MEASURES + 1];
    const FmuStatus status = measures(fmu, all);
    int i;

    for (i = 0; status == FMU_OK && i < FMU_INDICATORS; i++) {
        const int at = FMU_TIMED + i;
        double v = all[at];

        if (at >= FMU_SIDES)
            v += fmu->now.side[at] * fmu->now.error_floor[at - FMU_SIDES];
        v = until_its_end(&fmu->now, at, v);
        /* exactly at a zero the sign is that of the side where the indicator remains */
        out[i] = v > 0 || v < 0 ? v : fmu_sense(&fmu->now, at) * 1e-300;
    }
    return status;
}

void fmu_indicator_rates(Fmu *fmu, double *rates)
{
    FmuNumbers *now = &fmu->now;
    int i;

    model_tangent_indicators(now->p, now->t, now->y, now->s, rates);
    for (i = 0; i < FMU_SIDES; i++)
        if (now->side[i] == 0)
            rates[i] = -2 * now->sign[fmu_slide_of[i]] *
                       now->s[MODEL_S + FMU_SEEDS - FMU_SLIDES + fmu_slide_of[i]];
}

/* the same along parameters, too, of which those follow that do; NULL: none moves */
static FmuStatus direction(Fmu *fmu, double dt, const double *dy, const double *dp)
{
    FmuNumbers *now = &fmu->now;
    double *seed = now->s + MODEL_S, *last = seed + 1 + MODEL_Y + MODEL_S;
    const FmuStatus status = solve(fmu);

    if (status != FMU_OK)
        return status;
    memset(seed, 0, FMU_SEEDS * sizeof(double));
    seed[0] = dt;
    memcpy(seed + 1, dy, FMU_STATES * sizeof(double));
    if (dp != NULL) {
        memcpy(last, dp, FMU_PARAMETERS * sizeof(double));
        model_tangent_relations(now->p, now->t, now->y, now->s, fmu->work);
        memcpy(last, fmu->work, FMU_PARAMETERS * sizeof(double));
    }
#ifdef FMU_HAS_SLIDES
    if (fmu_slide_direction(fmu) != MODEL_OK)
#else
    if (model_tangent(now->p, now->t, now->y, now->s, fmu->work) != MODEL_OK)
#endif
        return fmu_fail(fmu, FMU_DISCARD, "the equations are singular", now->y[0]);
    return FMU_OK;
}

FmuStatus fmu_direction(Fmu *fmu, double dt, const double *dy)
{
    return direction(fmu, dt, dy, NULL);
}

static FmuStatus derivatives(Fmu *fmu, const unsigned *unknowns, size_t unknown_count,
                             const unsigned *knowns, size_t known_count, const double *seed,
                             double *out)
{
    FmuNumbers *now = &fmu->now;
    double dy[FMU_STATES + 1], rates[MODEL_Y + 1], outputs[MODEL_OUTPUTS + 1];
    double dt = 0, dp[FMU_PARAMETERS + 1];
    int k, moves = 0;
    FmuStatus status;
    size_t i;

    memset(dy, 0, sizeof dy);
    memset(dp, 0, sizeof dp);
    for (i = 0; i < known_count; i++) {
        if (knowns[i] == 0)
            dt += seed[i];
        else if (knowns[i] >= FMU_FIRST_STATE && knowns[i] < FMU_FIRST_RATE)
            dy[knowns[i] - FMU_FIRST_STATE] += seed[i];
        else if (knowns[i] < FMU_FIRST_STATE && !fmu_depends[knowns[i] - FMU_FIRST_PARAMETER]) {
            dp[knowns[i] - FMU_FIRST_PARAMETER] += seed[i];
            moves = 1;
        } else
            return fmu_fail(
                fmu, FMU_ERROR,
                "derivatives are by time, states, inputs and parameters that can be set",
                knowns[i]);
    }
    status = direction(fmu, dt, dy, moves ? dp : NULL);
    if (status != FMU_OK)
        return status;
    model_tangent_derivative(now->p, now->t, now->y, now->s, rates);
    model_tangent_outputs(now->p, now->t, now->y, now->s, outputs);
    if (moves || FMU_SLIDES > 0) {
        model_tangent_p_derivative(now->p, now->t, now->y, now->s, fmu->work);
        for (k = 0; k < FMU_STATES; k++)
            rates[k] += fmu->work[k];
        model_tangent_p_outputs(now->p, now->t, now->y, now->s, fmu->work);
        for (k = 0; k < MODEL_OUTPUTS; k++)
            outputs[k] += fmu->work[k];
    }
    if (FMU_MAY_SHARE)
        status = fmu_mark_open(fmu, unknowns, unknown_count, outputs);
    for (i = 0; i < unknown_count; i++) {
        if (unknowns[i] >= FMU_FIRST_RATE && unknowns[i] < FMU_FIRST_OUTPUT)
            out[i] = rates[unknowns[i] - FMU_FIRST_RATE];
        else if (unknowns[i] >= FMU_FIRST_OUTPUT && unknowns[i] < FMU_FIRST_INDICATOR)
            out[i] = outputs[unknowns[i] - FMU_FIRST_OUTPUT];
        else if (unknowns[i] >= FMU_FIRST_STATE && unknowns[i] < FMU_FIRST_RATE)
            out[i] = dy[unknowns[i] - FMU_FIRST_STATE];
        else
            return fmu_fail(fmu, FMU_ERROR, "derivatives are of rates and outputs", unknowns[i]);
    }
    return status;
}

FmuStatus fmu_derivatives(Fmu *fmu, const unsigned *unknowns, size_t unknown_count,
                          const unsigned *knowns, size_t known_count, const double *seed,
                          double *out)
{
    int looks;
    FmuStatus status = fmu_look_behind(fmu, &looks);

    if (status == FMU_OK)
        status = derivatives(fmu, unknowns, unknown_count, knowns, known_count, seed, out);
    fmu_look_back(fmu, looks);
    return status;
}

/* --- constraints --- */

double fmu_larger(double a, double b)
{
    return a > b ? a : b;
}

/* how far a state is off the constraints, against what they compare */
static double drift(Fmu *fmu)
{
    const FmuNumbers *now = &fmu->now;
    double *rows = fmu->work, *jacobian = rows + MODEL_M + 1;
    double most = 0;
    int i, j, k;

    for (k = 0; k < FMU_QUATERNIONS; k++) {
        double sum = 0;

        for (i = 0; i < 4; i++)
            sum += now->y[fmu_quaternion[k] + i] * now->y[fmu_quaternion[k] + i];
        most = fmu_larger(most, fabs(sum - 1));
    }
#ifdef MODEL_HAS_MODES
    {
        double y[MODEL_Y + 1], far;

        memcpy(y, now->y, MODEL_Y * sizeof(double));
        (void)model_meet(now->p, now->t, y, fmu->work, &far);
        most = fmu_larger(most, far);
    }
#endif
#ifdef FMU_HAS_SLIDES
    most = fmu_larger(most, fmu_slide_drift(fmu));
#endif
    if (MODEL_M == 0)
        return most;
    model_constraints(now->p, now->t, now->y, now->s, rows);
    for (i = 0; i < MODEL_M; i++)
        most = fmu_larger(most, fabs(rows[i]));
    model_velocity(now->p, now->t, now->y, now->s, rows);
    model_jacobian(now->p, now->t, now->y, now->s, jacobian);
    for (i = 0; i < MODEL_M; i++) {
        double size = 1 + fabs(rows[i]);

        for (j = 0; j < MODEL_U; j++) {
            const double term = jacobian[i * MODEL_U + j] * now->y[MODEL_Q + j];

            rows[i] -= term;
            size += fabs(term);
        }
        most = fmu_larger(most, fabs(rows[i]) / size);
    }
    return most;
}

void fmu_set_references(Fmu *fmu)
{
    FmuNumbers *now = &fmu->now;

    if (MODEL_A > 0) {
        model_angles(now->p, now->t, now->y, now->s, fmu->work);
        memcpy(now->y + FMU_STATES, fmu->work, MODEL_A * sizeof(double));
        now->is_solved = 0;
    }
}

static FmuStatus project(Fmu *fmu, int *moved)
{
    FmuNumbers *now = &fmu->now;
    int status;

    if (drift(fmu) <= PROJECTED)
        return FMU_OK;
    status = model_project(now->p, now->t, now->y, fmu->work);
    if (status != MODEL_OK)
        return fmu_fail(fmu, FMU_ERROR, "the constraints can't be met", drift(fmu));
    now->is_solved = 0;
    *moved = 1;
#ifdef FMU_HAS_SLIDES
    if (fmu_slide_project(fmu, moved) != FMU_OK)
        return FMU_ERROR;
#endif
    if (drift(fmu) > 1e-6)
        return fmu_fail(fmu, FMU_ERROR, "the constraints can't be met, which are off", drift(fmu));
    return FMU_OK;
}

int fmu_has_drifted(Fmu *fmu)
{
    fmu_set_references(fmu);
    return drift(fmu) > DRIFT * fmu->now.tolerance;
}

FmuStatus fmu_restore(Fmu *fmu)
{
    int moved = 0;

    fmu_set_references(fmu);
    return project(fmu, &moved);
}

/* those that became true, in the order of their making */
static FmuStatus happen(Fmu *fmu, const int *happens, int *moved)
{
    FmuNumbers *now = &fmu->now;
    double values[FMU_TARGETS + 1];
    int chosen[FMU_TARGETS + 1] = {0};
    int i, k, any = 0;

    model_values(now->p, now->t, now->y, now->s, values);
    for (i = 0; i < FMU_EVENTS_COUNT; i++) {
        if (!happens[i])
            continue;
        if (fmu->is_logging) {
            char line[200];

            (void)snprintf(line, sizeof line, "event %.80s at t = %.17g s", fmu_event_name[i],
                           now->t);
            fmu_log(fmu, FMU_OK, line);
        }
        now->is_stopped |= fmu_action[i] == FMU_STOPS;
        for (k = 0; fmu_action[i] == FMU_SETS && k < fmu_event_count[i]; k++)
            any = chosen[fmu_event_first[i] + k] = 1;
    }
    if (!any)
        return FMU_OK;
    *moved = 1;
    fmu->has_new_values = 1;
    memset(fmu->is_decided, 0, sizeof fmu->is_decided);
    return fmu_set_values(fmu, chosen, values);
}

/* --- events --- */

/* How each measure changes along the motion; zeros where that isn't known. */
static void find_rates(Fmu *fmu, double *rates)
{
    FmuNumbers *now = &fmu->now;
    double dy[MODEL_Y + 1];
    int i;

    for (i = 0; i < FMU_MEASURES; i++)
        rates[i] = 0;
    model_derivative(now->p, now->t, now->y, now->s, dy);
    if (fmu_direction(fmu, 1, dy) == FMU_OK)
        fmu_indicator_rates(fmu, rates);
}

/* The signs after this instant. *late: the delay with which a change was detected. */
static FmuStatus find_sides(Fmu *fmu, double *late, int *changes, int *moved)
{
    FmuNumbers *now = &fmu->now;
    double at[FMU_MEASURES + 1], rate[FMU_MEASURES + 1];
    const double close = fmu_larger(INSTANT * (1 + fabs(now->t)), LATE * *late);
    FmuStatus status;
    int i;

    *changes = 0;
    if (FMU_SIDES == 0)
        return FMU_OK;
    status = measures(fmu, at);
    if (status != FMU_OK)
        return status;
    find_rates(fmu, rate);
    for (i = 0; i < FMU_SIDES; i++) {
        const int is = at[i] > 0 ? 1 : at[i] < 0 ? -1 : now->side[i];
        const int goes = rate[i] > 0 ? 1 : rate[i] < 0 ? -1 : is;
        const int side = fabs(at[i]) <= close * fabs(rate[i]) ? goes : is;
        const double ago = fabs(at[i]) / fmu_larger(fabs(rate[i]), 1e-300);

        if (side == now->side[i] || now->side[i] == 0)
            continue;
        if (now->has_start && is == goes && ago < LATEST)
            *late = fmu_larger(*late, ago);
        if (fmu_slide_of[i] >= 0)
            continue;
        now->side[i] = side;
        *changes = 1;
    }
    if (*changes) {
        memset(fmu->is_decided, 0, sizeof fmu->is_decided);
        fmu_prepare(fmu);
        return FMU_OK; /* what is slid along, by the equations that there are now */
    }
#ifdef FMU_HAS_SLIDES
    return fmu_slide_sides(fmu, at, rate, fmu_larger(close, LATE * *late), changes, moved);
#else
    (void)moved;
    return FMU_OK;
#endif
}

/* --- ideal switches --- */

#ifdef MODEL_HAS_MODES

/* Margins of diodes; *ended: one has, by more than rounding. */
static FmuStatus margins(Fmu *fmu, double *margin, int *ended)
{
    const FmuNumbers *now = &fmu->now;
    double all[FMU_MEASURES + 1], largest[2] = {0, 0};
    const FmuStatus status = measures(fmu, all);
    int i, k;

    *ended = 0;
    if (status != FMU_OK)
        return status;
    model_edges(now->p, now->t, now->y, now->s, fmu->work);
    for (i = 0; i < 2 * MODEL_EDGES; i++)
        largest[i % 2] = fmu_larger(largest[i % 2], fabs(fmu->work[i]));
    for (k = 0; k < FMU_SWITCHES; k++) {
        const int side = now->side[FMU_SIDES + k];

        margin[k] = side * all[FMU_SIDES + k];
        *ended |= margin[k] < -ROUNDING * largest[side < 0];
    }
    return status;
}

static void put_sides(Fmu *fmu)
{
    int k;

    for (k = 0; k < FMU_SWITCHES; k++)
        fmu->now.p[MODEL_CLOSED + k] = fmu->now.side[FMU_SIDES + k] > 0;
    model_prepare(fmu->now.p);
}

/* the largest change of a network state; which */
static double jump_of(const FmuNumbers *now, const double *was, int *which)
{
    double most = 0;
    int i;

    for (i = 0; i < MODEL_X; i++) {
        const double jump = fabs(now->y[MODEL_Q + MODEL_U + i] - was[MODEL_Q + MODEL_U + i]);

        if (jump > most) {
            most = jump;
            *which = i;
        }
    }
    return most;
}

/* Make the states consistent with the mode. Fails if that needs an impulse that no element can
 * supply, except for the amount by which late detected diodes have passed 0. */
static FmuStatus meet(Fmu *fmu, double beyond, int *moved)
{
    FmuNumbers *now = &fmu->now;
    double was[MODEL_Y + 1], far;
    char line[240];
    int status, which = 0;

    memcpy(was, now->y, MODEL_Y * sizeof(double));
    status = model_meet(now->p, now->t, now->y, fmu->work, &far);
    *moved |= far > PROJECTED;
    if (status == MODEL_SINGULAR)
        return fmu_fail(fmu, FMU_ERROR, "the equations are singular", now->y[0]);
    if (status == MODEL_OK || !now->has_start || jump_of(now, was, &which) <= LATE * beyond)
        return FMU_OK;
    (void)snprintf(
        line, sizeof line,
        "%.80s would jump from %.6g to %.6g, which %s (Ron= and Roff= make it a fast change)",
        fmu_state_name[which], was[MODEL_Q + MODEL_U + which], now->y[MODEL_Q + MODEL_U + which],
        status == MODEL_IMPULSE ? "takes an impulse of a source" : "nothing takes over");
    return fmu_fail(fmu, FMU_ERROR, line, far);
}

/* whether a switch that has a condition is to be on its other side */
static int switch_goes_over(Fmu *fmu)
{
    const FmuNumbers *now = &fmu->now;
    int k, any = 0;

    model_looks(now->p, now->t, now->y, now->s, fmu->work);
    for (k = 0; k < FMU_SWITCHES; k++)
        any |= fmu->work[4 * k + 2] >= 0 &&
               (now->p[MODEL_CLOSED + k] > 0.5 ? 1 : -1) != now->side[FMU_SIDES + k];
    return any;
}

/* Determine which switches are closed from here on, and make states consistent with these. */
static FmuStatus exchange(Fmu *fmu, int *changes, int *moved)
{
    FmuNumbers *now = &fmu->now;
    const double unit = 1 + fabs(now->t);
    double margin[FMU_SWITCHES + 1] = {0}, h, beyond = 0;
    int k, ended = 0, any = 0, status = MODEL_OK;

    if (now->has_start && !*changes && margins(fmu, margin, &ended) != FMU_OK)
        return FMU_DISCARD;
    for (k = 0; k < FMU_SWITCHES; k++)
        beyond = fmu_larger(beyond, -margin[k]);
    for (h = NEAR * unit; status == MODEL_OK && !any; h *= 10) {
        status = model_exchange(now->p, now->t, now->y, now->s, h, fmu->work);
        for (k = 0; k < FMU_SWITCHES; k++)
            if ((now->p[MODEL_CLOSED + k] > 0.5 ? 1 : -1) != now->side[FMU_SIDES + k])
                any |= h <= NEAR * unit || margin[k] < 0;
        if (h > NEAR * unit && switch_goes_over(fmu))
            any = 0; /* with diodes that it turns */
        if (!any)
            put_sides(fmu); /* what changes later is another event */
        if (!ended || h > FURTHEST * unit)
            break;
    }
    now->is_solved = 0;
    if (status != MODEL_OK)
        return fmu_fail(fmu, FMU_ERROR, "there is no solution, whichever ideal switches are closed",
                        now->y[0]);
    for (k = 0; k < FMU_SWITCHES; k++)
        now->side[FMU_SIDES + k] = now->p[MODEL_CLOSED + k] > 0.5 ? 1 : -1;
    if (meet(fmu, beyond, moved) != FMU_OK)
        return FMU_ERROR;
    *changes |= any;
    if (margins(fmu, margin, &ended) != FMU_OK)
        return FMU_DISCARD;
    for (k = 0; k < FMU_SWITCHES; k++)
        now->error_floor[k] = margin[k] < 0 ? -2 * margin[k] : 0;
    return FMU_OK;
}
#endif

/* sampled states, once an instant */
static FmuStatus take_samples(Fmu *fmu, int *moved)
{
    FmuNumbers *now = &fmu->now;
    double periods[FMU_SAMPLES + 1], values[FMU_SAMPLES + 1];
    FmuStatus status;
    int i, due[FMU_SAMPLES + 1] = {0}, any = 0;

    if (FMU_SAMPLES == 0)
        return FMU_OK;
    model_periods(now->p, now->t, now->y, now->s, periods);
    for (i = 0; i < FMU_SAMPLES; i++) {
        const double count = now->t / periods[i], near = SAME * periods[i];

        /* an event just before an instant is at that instant */
        due[i] = fabs(count - floor(count + 0.5)) <= SAME && !(now->sampled >= now->t - 2 * near);
        any |= due[i];
    }
    if (!any)
        return FMU_OK;
    status = solve(fmu);
    if (status != FMU_OK)
        return status;
    model_samples(now->p, now->t, now->y, now->s, values);
    for (i = 0; i < FMU_SAMPLES; i++)
        if (due[i])
            now->y[MODEL_Q + MODEL_U + fmu_sample[i]] = values[i];
    now->sampled = now->t;
    now->is_solved = 0;
    *moved = 1;
    return FMU_OK;
}

static void find_next(Fmu *fmu)
{
    FmuNumbers *now = &fmu->now;
    double timers[2 * FMU_TIMED + 1], periods[FMU_SAMPLES + 1];
    const double t = now->t, least = t + INSTANT * (1 + fabs(t));
    int i;

    now->next = HUGE_VAL;
    model_timers(now->p, t, now->y, now->s, timers);
    for (i = 0; i < FMU_TIMED; i++) {
        const double at = timers[2 * i], rate = timers[2 * i + 1];
        double aim = 0;

        if (!(fabs(rate) > 0))
            continue;
        if (fmu_is_floor[i])
            aim = rate > 0 ? floor(at + SAME) + 1 : ceil(at - SAME) - 1;
        if (t + (aim - at) / rate > least && t + (aim - at) / rate < now->next)
            now->next = t + (aim - at) / rate;
    }
    model_periods(now->p, t, now->y, now->s, periods);
    for (i = 0; i < FMU_SAMPLES; i++) {
        const double next = periods[i] * (floor(t / periods[i] + SAME) + 1);

        if (next < now->next)
            now->next = next;
    }
}

FmuStatus fmu_events(Fmu *fmu, int *moved)
{
    FmuNumbers *now = &fmu->now;
    double late = 0;
    int rounds, changes = 1, any = 1, is_new = !now->has_start, i;
    FmuStatus status = project(fmu, moved);

    fmu->has_new_values = 0;
    memset(fmu->is_decided, 0, sizeof fmu->is_decided);
    if (status == FMU_OK)
        status = take_samples(fmu, moved);
    for (rounds = 0; status == FMU_OK && (changes || any); rounds++) {
        double truths[FMU_EVENTS_COUNT + 1];
        int happens[FMU_EVENTS_COUNT + 1];

        if (rounds == ROUNDS)
            return fmu_fail(fmu, FMU_ERROR, "events or signs change without end", now->y[0]);
        status = find_sides(fmu, &late, &changes, moved);
#ifdef MODEL_HAS_MODES
        if (status == FMU_OK)
            status = exchange(fmu, &changes, moved);
#endif
        if (status == FMU_OK)
            status = solve(fmu);
        if (status != FMU_OK)
            break;
        is_new |= changes;
        model_events(now->p, now->t, now->y, now->s, truths);
        any = 0;
        for (i = 0; i < FMU_EVENTS_COUNT; i++) {
            const int holds = truths[i] > 0.5;

            any |= happens[i] = now->has_start && holds && !now->holds[i];
            now->holds[i] = holds;
        }
        if (any)
            status = happen(fmu, happens, moved);
    }
    if (status == FMU_OK) {
        now->has_start = 1;
        now->is_changed = 0;
        find_next(fmu);
        if (FMU_FOLLOWS_TIME)
            fmu_look_ahead(fmu, is_new);
        if (*moved)
            now->step = 0;
    }
    return status;
}

FmuStatus fmu_initialise(Fmu *fmu)
{
    int moved = 0;

    fmu->now.t = fmu->now.start;
    fmu->now.is_solved = 0;
    fmu_set_references(fmu);
    return fmu_events(fmu, &moved);
}
