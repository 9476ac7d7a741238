/* mode_switch.c: which sides ideal switches go over to at an instant, and the phase that goes on
 *
 * Sides are those of a short step on: what holds there, looked at from further where nothing is
 * seen, and from nearer where what is seen doesn't hold at the instant yet. */
#include "simulate/run/mode_switch.h"

#include "base/memory.h"
#include "simulate/run/mode_entry.h"
#include "simulate/run/mode_margins.h"
#include "simulate/run/mode_phases.h"

#include <math.h>
#include <string.h>

#define ROUNDS   8    /* in which what is shared may set off more */
#define LOOK     1e-4 /* of the last step: how far to look ahead for the sides, */
#define NEAREST  1e-9 /* but not less than this of the run, */
#define FURTHEST 1e-6 /* and no more than this, */
#define FURTHER  10   /* times as far, where a margin has ended and no side is seen to change, */
#define STUCK    1e-4 /* or this, where the sides stay and all the same their margins end */
#define NEARER   6    /* times that it is looked nearer, each a tenth as far */

void mode_switching_free(ModeSwitching *c)
{
    mem_free(c->y);
    c->y = NULL;
}

/* y a step on, as the phase goes */
static void go_ahead(const Phase *phase, double t, double step, const double *y, double *out)
{
    const Ode *ode = motion_ode(phase->motion);
    double *rate = NEW_ARRAY(double, phase->length);
    bool sound = ode->rate(ode->context, t, y, rate);

    for (int i = 0; i < phase->length; i++)
        out[i] = y[i] + (sound ? step * rate[i] : 0);
    mem_free(rate);
}

/* The phase that a run goes over to at t. Where there is none the run ends there, and keeps what it
 * has. */
static Status next_phase(const ModeSwitching *c, double t, const bool *closed, Phase **out,
                         Diag *diag)
{
    Diag why = {0};
    Status status = mode_phases_get(c->run, c->setting, closed, out, &why);

    if (status == OK)
        return OK;
    if (status != E_MODEL) {
        (void)diag_set(diag, status, "%s", why.message);
    } else {
        status = E_SOLVER;
        (void)diag_set(diag, status, "at t = %.9g s %s", t, why.message);
    }
    diag_hint(diag, "%s", why.hint);
    return status;
}

/* How far to look ahead, as numbers tell times apart. */
static double step_near(const ModeSwitching *c, double t, double last)
{
    const double step =
        fmin(fmax(LOOK * last, NEAREST * c->control.span), FURTHEST * c->control.span);
    const volatile double ahead = t + step;

    return ahead - t;
}

/* Where nothing changed at t when it was looked at last, all the same it is asked again: so what
 * changes is too slow to be seen. What was seen from further is not to be undone by a look so near
 * that it sees nothing. Where it is known how far to look, a place is the same only as near as
 * that: elsewhere what is to be seen near may be over further on. */
static double step_from(ModeSwitching *c, double t, Nearness near)
{
    const double step = step_near(c, t, near.last);
    const bool is_told = near.ahead > 0;

    if (!(fabs(t - c->stuck) <= (is_told ? 1 : c->again) * step))
        c->again = c->told = 1;
    else if (!c->changed && is_told)
        c->told *= FURTHER;
    else if (!c->changed)
        c->again *= FURTHER;
    return fmin(c->again * step, STUCK * c->control.span);
}

/* an instant at which sides are looked for: its phase, and y there */
typedef struct Looking {
    Phase *now;
    double t;
    const double *y;
    ModeSearchAt at;
    double *x, *x_behind, *ahead; /* what `at` reads; ahead: y a step on */
    bool *closed;                 /* the sides that were found */
} Looking;

static Looking looking_new(const ModeSwitching *c, Phase *now, double t, double behind,
                           const double *y)
{
    const VariableIndex *whole = phases_whole(c->run->phases)->layout;
    Looking look = {.now = now,
                    .t = t,
                    .y = y,
                    .x = NEW_ARRAY(double, whole->nx),
                    .x_behind = NEW_ARRAY(double, whole->nx),
                    .ahead = NEW_ARRAY(double, now->length),
                    .closed = NEW_ARRAY(bool, system_ideal_count(c->run->system))};

    look.at = (ModeSearchAt){.t = behind,
                             .q = look.ahead,
                             .u = look.ahead + whole->n,
                             .references = look.ahead + variable_index_references(now->layout),
                             .x = look.x,
                             .x_behind = look.x_behind};
    return look;
}

static void looking_free(Looking *look)
{
    MEM_FREE(look->x, look->x_behind, look->ahead, look->closed);
}

/* Sides as they are a step on, where all goes on from (t, y) as it did; *changed: they are others
 * than now. */
static Status look_ahead(const ModeSwitching *c, Looking *look, bool *changed, Diag *diag)
{
    const int nx = phases_whole(c->run->phases)->layout->nx;
    const size_t bytes = (size_t)system_ideal_count(c->run->system) * sizeof(bool);
    RowValues row = {.t = look->t};
    ModeSearchAt *at = &look->at;

    memcpy(look->closed, look->now->closed, bytes);
    phase_enter(look->now);
    at->when = at->t + at->step;
    go_ahead(look->now, look->t, at->step, look->y, look->ahead);
    if (!phase_states(look->now, look->t + at->step, look->ahead, nx, &row, look->x_behind))
        memcpy(look->x_behind, look->x, (size_t)nx * sizeof(double));
    at->acceleration = row.acceleration;
    at->multipliers = row.multipliers;
    TRY(mode_search_find(c->run->mode_search, at, look->closed, diag));
    *changed = memcmp(look->closed, look->now->closed, bytes) != 0;
    return OK;
}

/* Whether the sides that were found may hold at the instant itself, without a state that jumps. */
static bool holds_at_once(const ModeSwitching *c, const Looking *look, bool changed)
{
    ActiveRun *r = c->run;
    Phase *next = look->now;
    double *entered;
    bool holds;

    if (changed && mode_phases_get(r, c->setting, look->closed, &next, NULL) != OK)
        return true;
    entered = NEW_ARRAY(double, next->length);
    mode_entry(next, look->y, look->x, look->y + variable_index_references(look->now->layout),
               look->y[look->now->length - 1], entered);
    holds = mode_margins_off(next, look->t, look->at.t, look->at.step, entered, &c->control) <= 1 &&
            !mode_entry_jumps(r, next, look->t, entered, look->x);
    mem_free(entered);
    return holds;
}

/* Diodes that are seen to go over a step ahead may still be on their sides at the instant itself:
 * from nearer to it they are. What is meant is a step that vanishes, but that tells no side from
 * the other where one begins at 0, least where it was seen before that margins end although none
 * goes over. Where no step shows what holds, the first one is believed: then states jump, and what
 * to is for others to tell. */
static Status look_nearer(const ModeSwitching *c, Looking *look, double nearest, bool *changed,
                          Diag *diag)
{
    const double first = look->at.step;
    const bool is_stuck = fmax(c->again, c->told) > 1;

    if (first <= nearest)
        return OK;
    for (int k = 0; k <= NEARER && look->at.step > nearest; k++) {
        if (holds_at_once(c, look, *changed))
            return OK;
        look->at.step /= FURTHER;
        if (look_ahead(c, look, changed, NULL) != OK || (is_stuck && !*changed))
            break;
    }
    look->at.step = first;
    return look_ahead(c, look, changed, diag);
}

/* Enter the phase of the sides that were found from y of another one. Behind what is shared at once
 * diodes may be the wrong way round, and conditions may read something else: sides are looked for
 * again. */
static Status go_over(ModeSwitching *c, double t, Looking *look, const Phase *from, const double *y,
                      Phase **out, Diag *diag)
{
    ActiveRun *r = c->run;
    const size_t bytes = (size_t)system_ideal_count(r->system) * sizeof(bool);

    for (int round = 0; round < ROUNDS; round++) {
        Entering entry = {.t = t, .step = look->at.step, .before = from->closed, .may_share = true};
        double *entered;

        TRY(next_phase(c, t, look->closed, out, diag));
        entered = NEW_ARRAY(double, (*out)->length);
        mode_entry(*out, y, look->x, y + variable_index_references(from->layout),
                   y[from->length - 1], entered);
        mode_switching_free(c);
        c->y = entered;
        TRY(mode_entry_check(r, *out, &entry, c->y, look->x, diag));
        if (!entry.shared)
            return OK;
        mode_search_calm(r->mode_search);
        memcpy(look->x_behind, look->x,
               (size_t)phases_whole(r->phases)->layout->nx * sizeof(double));
        TRY(mode_search_find(r->mode_search, &look->at, look->closed, diag));
        if (memcmp(look->closed, (*out)->closed, bytes) == 0)
            return OK;
        from = *out;
        y = c->y;
    }
    return solver_failure(diag, t, "what is shared makes ideal switches go over without end");
}

Status mode_switch(void *context, double t, double behind, Nearness near, const double *y,
                   Segment *segment, const double **out, Diag *diag)
{
    ModeSwitching *c = context;
    ActiveRun *r = c->run;
    Phase *now = r->phases->at[segment->phase], *next = NULL;
    Looking look = looking_new(c, now, t, behind, y);
    Events *events = segment->events;
    RowValues row = {.t = t};
    double furthest;
    Status status = OK;

    look.at.step = step_from(c, behind, near);
    furthest = fmin(c->told * near.ahead, STUCK * c->control.span);
    if (!phase_states(now, t, y, phases_whole(r->phases)->layout->nx, &row, look.x))
        CHECK(solver_failure(diag, t, "the network has no solution"));
    for (;; look.at.step = fmin(FURTHER * look.at.step, furthest)) {
        CHECK(look_ahead(c, &look, &c->changed, diag));
        if (c->changed || look.at.step >= furthest)
            break;
    }
    CHECK(look_nearer(c, &look, near.ahead, &c->changed, diag));
    c->stuck = behind;
    if (!c->changed)
        goto done;
    c->again = fmax(1, look.at.step / step_near(c, behind, near.last));
    CHECK(go_over(c, behind, &look, now, y, &next, diag));
    CHECK(mode_phases_events(r, now, next, c->setting, &events, diag));
    *segment = phases_segment(next, events);
    *out = c->y;
done:
    phase_enter(r->phases->at[segment->phase]);
    looking_free(&look);
    return status;
}
