/* termination.c: causes that end a run: frames that coincide, drivers beyond their range, angles
 * that lose a freedom, undefined forces, rounding, growth without bound */
#include "simulate/run/termination.h"

#include "algebra/linear.h"
#include "base/memory.h"

#include "simulate/equations/failure_diagnosis.h"
#include "simulate/integrate/stagnation.h"
#include "simulate/run/run_limits.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* the state of a run at its end, and its extrapolation */
typedef struct RunEnd {
    ActiveRun *run;
    Phase *phase;
    double t, span;
    double *y, *rate, *ahead; /* ahead: y extrapolated */
    double *at_start;         /* speeds and coordinates */
    double soon;              /* s: time of linear extrapolation */
} RunEnd;

static void look_ahead(const RunEnd *e, double time)
{
    for (int i = 0; i < e->phase->length; i++)
        e->ahead[i] = e->y[i] + time * e->rate[i];
}

/* the shortest time in which anything large doubles */
static double quickest(const RunEnd *e, int *which)
{
    const VariableIndex *l = e->phase->layout;
    double least = INFINITY;

    *which = -1;
    for (int i = 0; i < l->n + l->nu + l->nx; i++) {
        const double begin = i < l->n + l->nu ? fabs(e->at_start[i]) : 0;
        const double time = fabs(e->y[i]) / fabs(e->rate[i]);

        if (fabs(e->y[i]) > TERMINATION_BOUNDLESS * fmax(1, begin) && time < least) {
            least = time;
            *which = i;
        }
    }
    return least;
}

static const char *name_of(const RunEnd *e, int i)
{
    const VariableIndex *l = e->phase->layout;

    if (i < l->n)
        return system_q(e->phase->system, i)->name;
    if (i < l->n + l->nu)
        return system_u(e->phase->system, i - l->n)->name;
    return system_x(e->phase->system, i - l->n - l->nu)->name;
}

/* the force of a part at a later time */
static double largest_push(const RunEnd *e, Probe *probe, int count, double time, bool *is_number)
{
    RowValues row;
    const double *values;
    double largest = 0;

    look_ahead(e, time);
    row = row_of_state(e->phase->layout, e->t + time, e->ahead);
    values = probe_values(probe, &row);
    *is_number = true;
    for (int k = 0; k < count; k++) {
        *is_number = *is_number && isfinite(values[k]);
        largest = fmax(largest, fabs(values[k]));
    }
    return largest;
}

/* The part that becomes undefined first, or the one with the largest force; both NULL where there
 * is none. */
typedef struct Pushing {
    const char *without, *hardest;
    double when, most;
} Pushing;

static void look_at_pusher(RunEnd *e, const Pusher *pusher, Pushing *out)
{
    Probe *probe = NULL;
    Diag ignored = {0};
    bool is_number;
    double push;

    if (probe_new(e->phase->layout, &e->run->phases->parameters, pusher->value, pusher->count,
                  &probe, &ignored) != OK)
        return;
    push = largest_push(e, probe, pusher->count, 0, &is_number);
    if (is_number && push > out->most) {
        out->most = push;
        out->hardest = pusher->name;
    }
    for (double time = TERMINATION_FIRST * e->span;
         is_number && time <= e->soon && time < out->when; time *= 2) {
        (void)largest_push(e, probe, pusher->count, time, &is_number);
        if (!is_number) {
            out->when = time;
            out->without = pusher->name;
        }
    }
    probe_free(probe);
}

static Pushing look_at_pushers(RunEnd *e)
{
    Pushing out = {.when = INFINITY};
    Pusher pusher;

    for (int next = 0; system_pusher(e->phase->system, &next, &pusher);)
        look_at_pusher(e, &pusher, &out);
    return out;
}

/* "at t = 1 s: the step became too small" and the cause */
static void add_cause(Diag *diag, const char *join, const char *name, const char *does)
{
    char before[sizeof diag->message];

    memcpy(before, diag->message, sizeof before);
    (void)diag_set(diag, E_SOLVER, "%s%s%s %s", before, join, name, does);
}

static bool report_meeting(RunEnd *e, Diag *diag)
{
    char before[sizeof diag->message];

    memcpy(before, diag->message, sizeof before);
    return failure_closing(e->phase->layout, &e->run->phases->parameters, e->t, e->y, e->rate,
                           TERMINATION_IMMINENT * e->span, before, diag);
}

/* The first driver whose row has lost the independent part that it had at the start; -1: none. */
static int driver_at_end(RunEnd *e, const Ode *ode)
{
    const VariableIndex *l = e->phase->layout;
    const Equations *eq = compiled_equations(e->phase->numbers);
    double *begun = NEW_ARRAY(double, l->m);
    double *rate = NEW_ARRAY(double, e->phase->length);
    int found = -1;

    look_ahead(e, 0);
    memcpy(e->ahead, e->at_start, (size_t)(l->n + l->nu) * sizeof(double));
    /* rows are known where rates aren't */
    (void)ode->rate(ode->context, e->t, e->ahead, rate);
    for (int k = 0; k < l->m; k++)
        begun[k] = system_constraint(l->system, k)->is_driver ? failure_own_part(l, eq, k) : 0;
    (void)ode->rate(ode->context, e->t, e->y, rate);
    for (int k = 0; k < l->m && found < 0; k++)
        if (begun[k] > 0 && failure_own_part(l, eq, k) < TERMINATION_DRIVER * begun[k])
            found = k;
    mem_free(begun);
    mem_free(rate);
    return found;
}

static bool has_driver(const RunEnd *e)
{
    const VariableIndex *l = e->phase->layout;
    bool found = false;

    for (int k = 0; k < l->m; k++)
        found = found || system_constraint(l->system, k)->is_driver;
    return found;
}

static bool report_leading(RunEnd *e, const Ode *ode, Diag *diag)
{
    const int driver = has_driver(e) ? driver_at_end(e, ode) : -1;
    char before[sizeof diag->message];

    if (driver < 0)
        return false;
    memcpy(before, diag->message, sizeof before);
    failure_leading(e->phase->layout, compiled_equations(e->phase->numbers), driver, before, diag);
    return true;
}

/* Turns are singular here, and their rates or moments unbounded. */
static bool report_critical(RunEnd *e, Diag *diag)
{
    const VariableIndex *l = e->phase->layout;
    const RowValues row = row_of_state(l, e->t, e->y);
    Critical critical;
    Diag ignored = {0};

    for (int i = 0; system_critical(l->system, i, &critical); i++) {
        double measure;

        if (probe_at(l, &e->run->phases->parameters, critical.measure, &row, &measure, &ignored) !=
                OK ||
            !(fabs(measure) < CRITICAL_NEAR))
            continue;
        add_cause(diag, ": ", critical.instance, "turns through a critical angle there");
        diag_hint(diag, "%s where %s is %s: %s", critical.effect, critical.coordinate,
                  critical.angles, critical.remedy);
        return true;
    }
    return false;
}

/* way = J way over its size; returns the size of the result, < 0: rates are undefined */
static double along(const RunEnd *e, const Ode *ode, const double *from, double *way, int *most)
{
    const int n = e->phase->length - 1; /* work is last, and nothing depends on it */
    const double size = vector_largest(way, n);
    const double aside = TERMINATION_DIFFERENCE * fmax(1, vector_largest(from, n)) / size;
    double *there = NEW_ARRAY(double, n + 1), *here = NEW_ARRAY(double, n + 1);
    bool sound = ode->rate(ode->context, e->t, from, here);

    memcpy(e->ahead, from, (size_t)(n + 1) * sizeof(double));
    for (int i = 0; i < n; i++)
        e->ahead[i] += aside * way[i];
    sound = ode->rate(ode->context, e->t, e->ahead, there) && sound;
    *most = 0;
    for (int i = 0; i < n; i++) {
        way[i] = (there[i] - here[i]) / (aside * size);
        *most = fabs(way[i]) > fabs(way[*most]) ? i : *most;
    }
    MEM_FREE(there, here);
    return sound ? fabs(way[*most]) : -1;
}

/* The rate, 1/s, at which the fastest component oscillates or decays near a state, by two steps of
 * the power method: the derivative of rates along themselves, twice. 0 where it grows, or nothing
 * is known. */
static double fastest(const RunEnd *e, const Ode *ode, const double *from)
{
    const int n = e->phase->length;
    double *way = NEW_ARRAY(double, n), *rate = NEW_ARRAY(double, n);
    double found = 0;

    if (ode->rate(ode->context, e->t, from, rate)) {
        int first, second;
        double once, twice;
        bool decays;

        memcpy(way, rate, (size_t)n * sizeof(double));
        once = along(e, ode, from, way, &first);
        decays = way[first] * copysign(1, rate[first]) < 0;
        twice = along(e, ode, from, way, &second);
        if (once > 0 && twice > 0 && (decays || way[second] * copysign(1, rate[second]) < 0))
            found = sqrt(once) * sqrt(twice);
    }
    MEM_FREE(way, rate);
    return isfinite(found) ? found : 0;
}

/* Fixed steps that are too long for the fastest decay or oscillation make the solution grow without
 * bound. */
static bool report_unstable(RunEnd *e, const Stepper *stepper, Diag *diag)
{
    const double step = control_asked(&stepper->control);
    const int speeds = e->phase->layout->n + e->phase->layout->nu;
    double *begun, rate;

    if (!stepper->method->has_fixed_step ||
        !(vector_largest(e->y, e->phase->length - 1) >
          TERMINATION_UNSTABLE * fmax(1, vector_largest(e->at_start, speeds))))
        return false;
    begun = NEW_ARRAY(double, e->phase->length);
    memcpy(begun, e->y, (size_t)e->phase->length * sizeof(double));
    memcpy(begun, e->at_start, (size_t)speeds * sizeof(double));
    rate = fastest(e, stepper->ode, begun);
    mem_free(begun);
    /* after strong growth the state may have rates that the motion never had */
    if (!(step * rate > TERMINATION_STABLE))
        rate = fastest(e, stepper->ode, e->y);
    if (!(step * rate > TERMINATION_STABLE))
        return false;
    (void)diag_set(diag, E_SOLVER,
                   "at t = %.9g s: steps of %.3g s are too long for %s: something decays or swings "
                   "in %.2g s, and numbers grow without bound",
                   e->t, step, stepper->method->name, 1 / rate);
    diag_hint(diag, "step=%.1g or less; or method=%s, whose steps that doesn't limit",
              0.5 * TERMINATION_STABLE / rate, method_for((MethodNeed){.stiff = true})->name);
    return true;
}

/* The equation that limits the step: y'(t + h, y + h y') - y'(t, y) is 2/h times the error of an
 * Euler step h, which is compared with the tolerance of each entry. -1: no rate changes, or rates
 * there are undefined. */
static int find_limiting(RunEnd *e, Stepper *stepper, double h)
{
    const VariableIndex *l = e->phase->layout;
    double *later = NEW_ARRAY(double, e->phase->length), most = 0;
    int found = -1;

    look_ahead(e, h);
    if (stepper_rate(stepper, e->t + h, e->ahead, later))
        for (int i = 0; i < l->n + l->nu + l->nx; i++) {
            const double part =
                fabs(later[i] - e->rate[i]) / stepper_tolerance(stepper, i, fabs(e->y[i]));

            if (part > most) {
                most = part;
                found = i;
            }
        }
    mem_free(later);
    return found;
}

/* The current of a coil limits the step, and at one of its ends only nonlinear laws take that
 * current. */
static bool report_uncharged(RunEnd *e, int which, Diag *diag)
{
    const VariableIndex *l = e->phase->layout;
    const int state = which - l->n - l->nu;
    const Node *node = state >= 0 ? system_uncharged_node(l->system, state) : NULL;

    if (node == NULL || node->domain != DOMAIN_ELECTRICAL)
        return false;
    add_cause(diag, "; node ", node->name, "has no charge, so that its voltage may jump");
    diag_hint(diag,
              "only nonlinear parts take %s there: a capacitor from %s to 0 (a few pF) lets the "
              "voltage change in finite time",
              name_of(e, which), node->name);
    return true;
}

/* The cause is unknown: report the equation whose error limits the step, the part with the largest
 * force, and possible remedies. */
static void add_limiting(RunEnd *e, Stepper *stepper, const char *hardest, Diag *diag)
{
    const double last = e->t - stepper->before;
    const double h = fmax(last, fmax(TERMINATION_FIRST * e->span, 4 * DBL_EPSILON * fabs(e->t)));
    const int which = find_limiting(e, stepper, h);
    const Method *alternative = method_for((MethodNeed){.stiff = true});
    char other[80] = "";

    if (which < 0)
        add_cause(diag, "; ", "the equations", "have no value from there on");
    else
        add_cause(diag, "; the error of ", name_of(e, which), "limits it");
    if (which >= 0 && report_uncharged(e, which, diag))
        return;
    if (hardest != NULL)
        add_cause(diag, ", ", hardest, "pushes hardest");
    /* a load that grows without bound limits steps before it has no value */
    if (diag->hint[0] != '\0' || system_hint_locking(e->phase->system, diag))
        return;
    if (stepper->method->has_fixed_step)
        (void)snprintf(other, sizeof other, "a shorter step= or ");
    else if (stepper->method != alternative)
        (void)snprintf(other, sizeof other, "method=%s or ", alternative->name);
    diag_hint(diag,
              "%sa larger rtol= may get further; else look at what acts on %s: a law that jumps or "
              "grows without bound, or a part with hardly any mass or inertia; an event with "
              "do=stop ends a run before",
              other, which >= 0 ? name_of(e, which) : "the parts there");
}

static void report(RunEnd *e, Stepper *stepper, bool *is_rounding, Diag *diag)
{
    int growing;
    const double time = quickest(e, &growing), step = stepper->control.step;
    const double last = fmax(e->t - stepper->before, 4 * DBL_EPSILON * fabs(e->t));
    Pushing pushing;

    e->soon = fmax(TERMINATION_AHEAD * fmin(e->span, time), fmin(2 * step, time));
    if (report_unstable(e, stepper, diag) || report_leading(e, stepper->ode, diag) ||
        report_meeting(e, diag) || report_critical(e, diag)) {
        *is_rounding = false;
        return;
    }
    pushing = look_at_pushers(e);
    if (pushing.without != NULL) {
        *is_rounding = false;
        add_cause(diag, ": ", pushing.without, "has no value from there on");
        diag_hint(diag, "limit what its law takes a root, a logarithm or a quotient of, as by "
                        "max(..., 0), or end the run before with an event and do=stop");
    } else if (*is_rounding || stagnation_is_rounding(
                                   stepper, growing >= 0 ? TERMINATION_STEP * time : last, diag)) {
        *is_rounding = true;
    } else if (time < TERMINATION_IMMINENT * e->span) {
        *is_rounding = false;
        add_cause(diag, ": ", name_of(e, growing), "grows without bound there");
        if (pushing.hardest != NULL)
            add_cause(diag, ", ", pushing.hardest, "pushes hardest");
        diag_hint(diag, "a law may push the wrong way, or grow too fast with what it reads; an "
                        "event with do=stop ends a run before");
    } else {
        add_limiting(e, stepper, pushing.hardest, diag);
    }
}

/* Rates are undefined at the current state. */
static void report_undefined(const RunEnd *e, Diag *diag)
{
    char before[sizeof diag->message];

    memcpy(before, diag->message, sizeof before);
    (void)failure_diagnose(e->phase->layout, &e->run->phases->parameters, e->t, e->y, before, diag);
}

void termination_diagnose(void *context, const Segment *segment, Stepper *stepper,
                          bool *is_rounding, Diag *diag)
{
    const ModeSwitching *c = context;
    Phase *phase = c->run->phases->at[segment->phase];
    const Ode *ode = stepper->ode;
    RunEnd end = {.run = c->run, .phase = phase, .t = stepper->t, .span = c->control.span};

    end.rate = NEW_ARRAY(double, phase->length);
    end.ahead = NEW_ARRAY(double, phase->length);
    end.y = stepper->y;
    end.at_start = c->run->begin;
    if (ode->rate(ode->context, end.t, end.y, end.rate))
        report(&end, stepper, is_rounding, diag);
    else
        report_undefined(&end, diag);
    if (diag->hint[0] == '\0')
        (void)system_hint_locking(phase->system, diag);
    mem_free(end.rate);
    mem_free(end.ahead);
}
