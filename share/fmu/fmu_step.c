/* fmu_step.c: co-simulation: a stiff integrator that stops at events
 *
 * RODAS of Hairer and Wanner (1996, IV.7), of order 4 with an error estimate of order 3 and dense
 * output: L-stable, so that stiff networks cost no more than others, with exact derivatives. Each
 * step ends on the constraints. If an event function changes its sign within a step, the step is
 * repeated up to that instant. */
#include "fmu.h"

#include <string.h>

enum { STAGES = 6, TRIES = 40, MOST_STEPS = 2000000 };
#define GAMMA  0.25
#define STRICT 0.1  /* of the tolerance: error of a step, so that a whole run meets it */
#define SMALL  0.01 /* of the tolerance: what counts for states near 0 */
#define SAFETY 0.9
#define SHRINK 0.2
#define GROW   5.0
#define LEAST  1e-13 /* of 1 + |t|: the shortest step */
#define SAME   1e-9  /* of 1 + |t|: times of an importer that can't be distinguished */
#define PLACES 4     /* in a step that are looked at for what changes its sign */

/* clang-format off */
static const double a[STAGES][STAGES] = {
    {0},
    {1.544},
    {0.9466785280815826, 0.2557011698983284},
    {3.314825187068521, 2.896124015972201, 0.9986419139977817},
    {1.221224509226641, 6.019134481288629, 12.53708333932087, -0.6878860361058950},
    {1.221224509226641, 6.019134481288629, 12.53708333932087, -0.6878860361058950, 1}};
static const double c[STAGES][STAGES] = {
    {0},
    {-5.6688},
    {-2.430093356833875, -0.2063599157091915},
    {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
    {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
    {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054}};
static const double alpha[STAGES] = {0, 0.386, 0.21, 0.63, 1, 1};
static const double delta[STAGES] = {0.25, -0.1043, 0.1035, -0.0362, 0, 0};
static const double dense[2][STAGES - 1] = {
    {10.12623508344586, -7.487995877610167, -34.80091861555747, -7.992771707568823, 1.025137723295662},
    {-0.6762803392801253, 6.087714651680015, 16.43084320892478, 24.76722511418386, -6.594389125716872}};
/* clang-format on */

/* a step from (t, y0), whose derivatives are `jacobian` and `by_time` */
typedef struct Step {
    double t;
    double *y0, *y1, *first, *by_time, *jacobian, *matrix, *u[STAGES], *bend[2], *error;
} Step;

static double larger(double x, double y)
{
    return x > y ? x : y;
}

static Step step_in(Fmu *fmu)
{
    double *at = fmu->space;
    Step step;
    int i;

    step.t = fmu->now.t;
    step.jacobian = at;
    step.matrix = at += FMU_STATES * FMU_STATES;
    at += FMU_STATES * FMU_STATES;
    step.y0 = at, at += FMU_STATES;
    step.y1 = at, at += FMU_STATES;
    step.first = at, at += FMU_STATES;
    step.by_time = at, at += FMU_STATES;
    step.error = at, at += FMU_STATES;
    for (i = 0; i < 2; i++, at += FMU_STATES)
        step.bend[i] = at;
    for (i = 0; i < STAGES; i++, at += FMU_STATES)
        step.u[i] = at;
    memcpy(step.y0, fmu->now.y, FMU_STATES * sizeof(double));
    return step;
}

static void put(Fmu *fmu, double t, const double *y)
{
    fmu_set_time(fmu, t);
    fmu_set_states(fmu, y);
}

/* rates and derivatives at its start */
static FmuStatus begin(Fmu *fmu, const Step *step)
{
    double dy[FMU_STATES + 1], out[MODEL_Y + 1];
    FmuStatus status = fmu_rates(fmu, step->first);
    int i, j;

    for (j = -1; status == FMU_OK && j < FMU_STATES; j++) {
        memset(dy, 0, sizeof dy);
        if (j >= 0)
            dy[j] = 1;
        status = fmu_direction(fmu, j < 0 ? 1 : 0, dy);
        if (status != FMU_OK)
            break;
        model_tangent_derivative(fmu->now.p, fmu->now.t, fmu->now.y, fmu->now.s, out);
        for (i = 0; i < FMU_STATES; i++)
            *(j < 0 ? &step->by_time[i] : &step->jacobian[i * FMU_STATES + j]) = out[i];
    }
    return status;
}

/* L U = 1/(h gamma) - J, rows exchanged */
static int factor(const Step *step, double h, int *rows)
{
    double *m = step->matrix;
    int i, j, k;

    for (i = 0; i < FMU_STATES * FMU_STATES; i++)
        m[i] = -step->jacobian[i];
    for (i = 0; i < FMU_STATES; i++)
        m[i * FMU_STATES + i] += 1 / (h * GAMMA);
    for (k = 0; k < FMU_STATES; k++) {
        int pivot = k;

        for (i = k + 1; i < FMU_STATES; i++)
            if (fabs(m[i * FMU_STATES + k]) > fabs(m[pivot * FMU_STATES + k]))
                pivot = i;
        rows[k] = pivot;
        if (!(fabs(m[pivot * FMU_STATES + k]) > 0))
            return 0;
        for (j = 0; pivot != k && j < FMU_STATES; j++) {
            const double v = m[k * FMU_STATES + j];

            m[k * FMU_STATES + j] = m[pivot * FMU_STATES + j];
            m[pivot * FMU_STATES + j] = v;
        }
        for (i = k + 1; i < FMU_STATES; i++) {
            const double v = m[i * FMU_STATES + k] /= m[k * FMU_STATES + k];

            for (j = k + 1; (v > 0 || v < 0) && j < FMU_STATES; j++)
                m[i * FMU_STATES + j] -= v * m[k * FMU_STATES + j];
        }
    }
    return 1;
}

static void substitute(const Step *step, const int *rows, double *x)
{
    const double *m = step->matrix;
    int i, j;

    for (i = 0; i < FMU_STATES; i++) {
        const double v = x[rows[i]];

        x[rows[i]] = x[i];
        x[i] = v;
    }
    for (i = 0; i < FMU_STATES; i++)
        for (j = 0; j < i; j++)
            x[i] -= m[i * FMU_STATES + j] * x[j];
    for (i = FMU_STATES - 1; i >= 0; i--) {
        for (j = i + 1; j < FMU_STATES; j++)
            x[i] -= m[i * FMU_STATES + j] * x[j];
        x[i] /= m[i * FMU_STATES + i];
    }
}

/* y1, what lies between and the error; 0: there is no such step */
static int take(Fmu *fmu, const Step *step, double h)
{
    int rows[FMU_STATES + 1];
    double rates[FMU_STATES + 1];
    int i, j, stage;

    if (!factor(step, h, rows))
        return 0;
    for (stage = 0; stage < STAGES; stage++) {
        double *u = step->u[stage];

        memcpy(step->y1, step->y0, FMU_STATES * sizeof(double));
        for (j = 0; j < stage; j++)
            for (i = 0; i < FMU_STATES; i++)
                step->y1[i] += a[stage][j] * step->u[j][i];
        if (stage == 0)
            memcpy(rates, step->first, FMU_STATES * sizeof(double));
        else {
            put(fmu, step->t + alpha[stage] * h, step->y1);
            if (fmu_rates(fmu, rates) != FMU_OK)
                return 0;
        }
        for (i = 0; i < FMU_STATES; i++) {
            u[i] = rates[i] + h * delta[stage] * step->by_time[i];
            for (j = 0; j < stage; j++)
                u[i] += c[stage][j] * step->u[j][i] / h;
        }
        substitute(step, rows, u);
    }
    for (i = 0; i < FMU_STATES; i++) {
        step->error[i] = step->u[STAGES - 1][i];
        step->y1[i] += step->error[i];
        for (j = 0; j < 2; j++) {
            step->bend[j][i] = 0;
            for (stage = 0; stage < STAGES - 1; stage++)
                step->bend[j][i] += dense[j][stage] * step->u[stage][i];
        }
    }
    return 1;
}

/* of the states between, at a part of the step */
static void between(const Step *step, double part, double *y)
{
    int i;

    for (i = 0; i < FMU_STATES; i++)
        y[i] = (1 - part) * step->y0[i] +
               part * (step->y1[i] + (1 - part) * (step->bend[0][i] + part * step->bend[1][i]));
}

/* in tolerances */
static double error_of(const Fmu *fmu, const Step *step)
{
    const double tolerance = fmu->now.tolerance * STRICT;
    double sum = 0;
    int i;

    for (i = 0; i < FMU_STATES; i++) {
        const double size = larger(fabs(step->y0[i]), fabs(step->y1[i])) + SMALL;
        const double part = step->error[i] / (tolerance * size);

        sum += part * part;
    }
    return FMU_STATES > 0 ? sqrt(sum / FMU_STATES) : 0;
}

/* --- what changes its sign --- */

/* the first whose sign differs from the stored one; -1: none; -2: not known */
static int crossed(Fmu *fmu, double t, const double *y)
{
    double at[FMU_INDICATORS + 1];
    int i;

    put(fmu, t, y);
    if (FMU_INDICATORS > 0 && fmu_indicators(fmu, at) != FMU_OK)
        return -2;
    for (i = 0; i < FMU_INDICATORS; i++)
        if (at[i] * fmu_sense(&fmu->now, FMU_TIMED + i) < 0)
            return i;
    return -1;
}

/* whether something does within the step; then about when, as a part of it */
static int find_crossing(Fmu *fmu, const Step *step, double h, double *part)
{
    double y[FMU_STATES + 1];
    double low = 0, high = 0;
    int place, found = -1, tries;

    for (place = 1; FMU_INDICATORS > 0 && found == -1 && place <= PLACES; place++) {
        low = high;
        high = place / (double)PLACES;
        between(step, high, y);
        found = crossed(fmu, step->t + high * h, place == PLACES ? step->y1 : y);
    }
    if (found < 0)
        return 0;
    for (tries = 0; tries < 60 && high - low > 1e-15; tries++) {
        const double middle = (low + high) / 2;

        between(step, middle, y);
        if (crossed(fmu, step->t + middle * h, y) >= 0)
            high = middle;
        else
            low = middle;
    }
    *part = high;
    return 1;
}

/* The step again, to where the first thing changes its sign: what lies between is less exact than
 * its end. */
static int end_at_crossing(Fmu *fmu, const Step *step, double *h, double part)
{
    const double instant = LEAST * (1 + fabs(step->t));
    double at[FMU_INDICATORS + 1], low = 0, high = *h;
    int tries, k;

    between(step, part, fmu->work);
    memcpy(step->error, fmu->work, FMU_STATES * sizeof(double));
    k = crossed(fmu, step->t + part * *h, step->error);
    *h *= part;
    for (tries = 0; tries < TRIES; tries++) {
        double v, slope, aim;
        double dy[MODEL_Y + 1], rates[FMU_MEASURES + 1];

        if (*h < instant)
            *h = instant;
        if (!take(fmu, step, *h))
            return 0;
        put(fmu, step->t + *h, step->y1);
        if (k < 0 || fmu_indicators(fmu, at) != FMU_OK)
            return k < 0;
        v = at[k] * fmu_sense(&fmu->now, FMU_TIMED + k);
        *(v < 0 ? &high : &low) = *h;
        model_derivative(fmu->now.p, fmu->now.t, fmu->now.y, fmu->now.s, dy);
        if (fmu_direction(fmu, 1, dy) != FMU_OK)
            return 0;
        fmu_indicator_rates(fmu, rates);
        slope = rates[FMU_TIMED + k] * fmu_sense(&fmu->now, FMU_TIMED + k);
        if (high - low <= instant || fabs(v) <= instant * fabs(slope)) {
            put(fmu, step->t + *h, step->y1);
            return 1;
        }
        aim = slope < 0 ? *h - v / slope : (low + high) / 2;
        *h = aim > low && aim < high ? aim : (low + high) / 2;
    }
    put(fmu, step->t + *h, step->y1);
    return 1;
}

/* --- the run --- */

static double first_step(const Fmu *fmu, const Step *step, double most)
{
    double state = SMALL, rate = 0;
    int i;

    for (i = 0; i < FMU_STATES; i++) {
        state = larger(state, fabs(step->y0[i]));
        rate = larger(rate, fabs(step->first[i]));
    }
    rate = rate > 0 ? sqrt(sqrt(fmu->now.tolerance)) * 0.1 * state / rate : most;
    return rate < most ? rate : most;
}

/* One step, at most to `end`. */
static FmuStatus step_on(Fmu *fmu, double end, int *moved)
{
    FmuNumbers *now = &fmu->now;
    const Step step = step_in(fmu);
    const double least = LEAST * (1 + fabs(now->t));
    double h, part, error;
    int tries;
    FmuStatus status = begin(fmu, &step);

    if (status != FMU_OK)
        return FMU_ERROR;
    h = now->step > 0 ? now->step : first_step(fmu, &step, end - now->t);
    for (tries = 0;; tries++) {
        const double left = end - step.t;
        const int is_last = h >= left * (1 - 1e-12);
        double used = is_last ? left : h > left / 2 ? left / 2 : h;

        put(fmu, step.t, step.y0);
        error = take(fmu, &step, used) ? error_of(fmu, &step) : HUGE_VAL;
        if (!(error <= 1)) {
            h = used * (error < HUGE_VAL ? larger(SHRINK, SAFETY / sqrt(sqrt(error))) : SHRINK);
            if (h < least || tries > TRIES)
                return fmu_fail(fmu, FMU_ERROR, "steps get too short", h);
            continue;
        }
        part = SAFETY / larger(sqrt(sqrt(error)), SAFETY / GROW);
        if (!is_last || used * part < h)
            h = used * part;
        now->step = h;
        if (find_crossing(fmu, &step, used, &part)) {
            if (!end_at_crossing(fmu, &step, &used, part))
                return fmu_fail(fmu, FMU_ERROR, "an event can't be located", used);
            *moved = 1;
        } else
            put(fmu, is_last ? end : step.t + used, step.y1);
        return FMU_OK;
    }
}

FmuStatus fmu_advance(Fmu *fmu, double end)
{
    FmuNumbers *now = &fmu->now;
    int steps, moved = 0, still = 0;
    FmuStatus status = now->is_changed ? fmu_events(fmu, &moved) : FMU_OK;

    for (steps = 0; status == FMU_OK && now->t < end && !now->is_stopped; steps++) {
        const double before = now->t;
        const double to = now->next < end ? now->next : end;
        int crossing = 0;

        if (steps == MOST_STEPS)
            return fmu_fail(fmu, FMU_ERROR, "too many steps", now->step);
        status = step_on(fmu, to, &crossing);
        if (status != FMU_OK)
            break;
        still = now->t - before <= LEAST * (1 + fabs(now->t)) * 10 ? still + 1 : 0;
        if (still > TRIES)
            return fmu_fail(fmu, FMU_ERROR, "events happen without end", now->y[0]);
        moved = 0;
        if (crossing || now->t >= now->next)
            status = fmu_events(fmu, &moved);
        else if (MODEL_M > 0 || FMU_QUATERNIONS > 0 || MODEL_A > 0 || FMU_SWITCHES > 0 ||
                 FMU_SLIDES > 0)
            status = fmu_restore(fmu);
    }
    return status == FMU_OK || status == FMU_FATAL ? status : FMU_ERROR;
}

FmuStatus fmu_do_step(Fmu *fmu, double from, double step)
{
    if (!(step >= 0))
        return fmu_fail(fmu, FMU_ERROR, "a step is not negative", step);
    if (fabs(from - fmu->now.t) > SAME * (1 + fabs(from)) && !fmu->now.is_stopped)
        return fmu_fail(fmu, FMU_ERROR, "a step begins where the last one ended", from);
    return fmu->now.is_stopped ? FMU_OK : fmu_advance(fmu, from + step);
}

/* --- values after an event of what is set between steps --- */

FmuStatus fmu_look_behind(Fmu *fmu, int *looks)
{
    const int is_logging = fmu->is_logging;
    int moved = 0;
    FmuStatus status;

    *looks = fmu->now.mode == FMU_STEPPING && fmu->now.is_changed;
    if (!*looks)
        return FMU_OK;
    fmu->kept = fmu->now;
    fmu->is_logging = 0; /* the step reports it */
    status = fmu_events(fmu, &moved);
    fmu->is_logging = is_logging;
    if (status == FMU_OK)
        return FMU_OK;
    fmu_look_back(fmu, 1);
    *looks = 0;
    return status == FMU_FATAL ? FMU_FATAL : FMU_DISCARD; /* that step will fail */
}

void fmu_look_back(Fmu *fmu, int looks)
{
    if (looks)
        fmu->now = fmu->kept;
}

FmuStatus fmu_output_rates(Fmu *fmu, const unsigned *references, size_t count, const int *orders,
                           double *values)
{
    double seed[FMU_STATES + 1];
    unsigned knowns[FMU_STATES + 1];
    FmuStatus status;
    int looks;
    unsigned k;
    size_t i;

    for (i = 0; i < count; i++)
        if (orders[i] != 1)
            return fmu_fail(fmu, FMU_ERROR, "outputs have first derivatives alone", orders[i]);
    status = fmu_look_behind(fmu, &looks);
    if (status == FMU_OK)
        status = fmu_rates(fmu, seed + 1);
    seed[0] = 1;
    knowns[0] = 0;
    for (k = 0; k < FMU_STATES; k++)
        knowns[k + 1] = FMU_FIRST_STATE + k;
    if (status == FMU_OK)
        status = fmu_derivatives(fmu, references, count, knowns, FMU_STATES + 1, seed, values);
    fmu_look_back(fmu, looks);
    return status;
}
