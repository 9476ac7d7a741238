/* mode_switch.c: which phase of a result goes on
 *
 * What is carried over an instant are coordinates, speeds, and the states of the whole: every mode
 * tells those, and its own states are some of them. */
#include "simulate/run/mode_switch.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/run/charge_sharing.h"
#include "simulate/run/mode_margins.h"

#include <math.h>
#include <string.h>

#define JUMP       1e-6 /* of the largest state, more than location may change it, */
#define ERRORS     100  /* and of the tolerance: what errors may */
#define ROUNDS     8    /* in which what is shared may set off more */
#define FITS       4    /* of states at a start to those that were given */
#define FOLLOWS    1e-8 /* the weight of one that wasn't */
#define START_STEP 1e-9 /* s: for the sides at a start, where no run says what is short */
#define LOOK       1e-4 /* of the last step: how far to look ahead for the sides, */
#define NEAREST    1e-9 /* but not less than this of the run, */
#define FURTHEST   1e-6 /* and no more than this, */
#define FURTHER    10   /* times as far, where a margin has ended and no side is seen to change, */
#define STUCK      1e-4 /* or this, where the sides stay and all the same their margins end */
#define NEARER     6    /* times that it is looked nearer, each a tenth as far */

/* --- states of the whole --- */

/* which states of the whole the phase's own are, by name */
static Status find_states(const ActiveRun *r, Phase *phase, Diag *diag)
{
    const Layout *l = phase->layout, *whole = phases_whole(r->phases)->layout;

    phase->among_whole = NEW_ARRAY(int, l->nx);
    /* both are in the order of the parts: where one is, the next is not far */
    for (int i = 0, k = 0; i < l->nx; i++) {
        const char *name = system_x(l->system, i)->name;
        int looked = 0;

        while (looked < whole->nx && strcmp(system_x(whole->system, k)->name, name) != 0) {
            k = (k + 1) % whole->nx;
            looked++;
        }
        if (looked == whole->nx)
            return diag_set(diag, E_MODEL, "%s is no state on the other side of an ideal switch",
                            name);
        phase->among_whole[i] = k;
    }
    return OK;
}

static Status compile_states(ActiveRun *r, Phase *phase, Diag *diag)
{
    const Layout *whole = phases_whole(r->phases)->layout;
    LIST(Expr) roots = {0};
    Status status = OK;

    for (int i = 0; i < whole->nx; i++) {
        Expr state;

        CHECK(system_variable(phase->system, system_x(whole->system, i)->name, 0, &state, diag));
        LIST_PUSH(roots, state);
    }
    for (int i = 0; system_invariant(phase->system, i) != NULL; i++)
        LIST_PUSH(roots, system_invariant(phase->system, i));
    CHECK(probe_new(phase->layout, &r->phases->parameters, roots.at, roots.count, &phase->states,
                    diag));
done:
    LIST_FREE(roots);
    return status;
}

/* y of a phase from (q, u), states of the whole, and references of angles */
static void enter(const Phase *phase, const double *y, const double *x, const double *near,
                  double work, double *out)
{
    const Layout *l = phase->layout;

    memcpy(out, y, (size_t)(l->n + l->nu) * sizeof(double));
    for (int i = 0; i < l->nx; i++)
        out[l->n + l->nu + i] = x[phase->among_whole[i]];
    memcpy(out + layout_references(l), near, (size_t)l->multi_turns * sizeof(double));
    out[phase->length - 1] = work;
}

/* --- impulses --- */

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

/* where a phase is entered, as its sides were found */
typedef struct Entering {
    double t, step;
    const bool *before; /* the sides that were */
    bool may_share;     /* else no state may jump: nothing was stored before */
    bool shared;        /* and that was done */
} Entering;

/* What the states of the whole have to be in the phase that begins at (t, y), against x, what they
 * were: none may jump but those that share what they store, which y and x are set to. */
static Status check_impulse(ActiveRun *r, Phase *phase, Entering *entry, double *y, double *x,
                            Diag *diag)
{
    const Layout *whole = phases_whole(r->phases)->layout;
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
        status = check_impulse(r, phase, &shared, y, x, diag);
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

/* --- phases --- */

/* Takes a new phase, opened and with its states found among those of the whole; freed where that
 * fails. */
static Status add_phase(ActiveRun *r, const Setting *setting, Phase *phase, Phase **out, Diag *diag)
{
    Status status = OK;

    CHECK(active_run_open_phase(r, phase, setting, diag));
    if (phase->closed != NULL) {
        CHECK(find_states(r, phase, diag));
        CHECK(compile_states(r, phase, diag));
    }
    phases_add(r->phases, phase);
    *out = phase;
    phase = NULL;
done:
    phase_free(phase);
    return status;
}

Status mode_switch_phase(ActiveRun *r, const Setting *setting, const bool *closed, Phase **out,
                         Diag *diag)
{
    mem_keep(r);
    int count = system_ideal_count(r->system);
    Phase *phase = NULL;
    System *system;

    *out = phases_find(r->phases, closed, count);
    if (*out != NULL)
        return OK;
    TRY(system_mode(r->system, setting->scene, closed, setting->watch, &system, diag));
    for (int i = 1; i < r->phases->count; i++)
        if (r->phases->at[i]->system == system && r->phases->at[i]->on_count == 0) {
            *out = phase_new_like(r->phases->at[i], closed, count);
            phases_add(r->phases, *out);
            return OK;
        }
    TRY(phase_new(system, &r->phases->parameters, closed, count, &phase, diag));
    return add_phase(r, setting, phase, out, diag);
}

/* whether a phase stays on these sides of surfaces */
static bool is_on(const Phase *phase, const OnSurface *on, int count)
{
    if (phase->on_count != count)
        return false;
    for (int i = 0; i < count; i++)
        if (phase->on[i].surface != on[i].surface || phase->on[i].side != on[i].side)
            return false;
    return true;
}

/* The phase of the same system on these sides of surfaces: with switches on the same sides, or
 * NULL; *shared: any, or NULL. */
static Phase *find_on(const ActiveRun *r, const System *system, const bool *closed,
                      const OnSurface *on, int count, Phase **shared)
{
    size_t bytes = (size_t)system_ideal_count(r->system) * sizeof(bool);

    *shared = NULL;
    for (int i = 0; i < r->phases->count; i++) {
        Phase *phase = r->phases->at[i];

        if (phase->motion == NULL || phase->system != system || !is_on(phase, on, count) ||
            (phase->closed == NULL) != (closed == NULL))
            continue;
        *shared = phase;
        if (closed == NULL || memcmp(phase->closed, closed, bytes) == 0)
            return phase;
    }
    return NULL;
}

Status mode_switch_phase_on(ActiveRun *r, const Setting *setting, System *system,
                            const bool *closed, const OnSurface *on, int count, Phase **out,
                            Diag *diag)
{
    mem_keep(r);
    int ideals = system_ideal_count(r->system);
    Phase *shared, *phase = NULL;

    *out = find_on(r, system, closed, on, count, &shared);
    if (*out != NULL)
        return OK;
    if (shared != NULL) {
        *out = phase_new_like(shared, closed, ideals);
        phases_add(r->phases, *out);
        return OK;
    }
    TRY(phase_new_on(system, &r->phases->parameters, closed, ideals, on, count, &phase, diag));
    return add_phase(r, setting, phase, out, diag);
}

/* --- the start --- */

/* whether an initial value was given for a state of the whole, or for what follows from it */
static bool is_given(const ActiveRun *r, const Setting *setting, int state)
{
    System *system = phases_whole(r->phases)->system;
    const Expr symbol = system_x(system, state)->symbol;
    bool found = false;

    for (int i = 0; setting->start != NULL && i < setting->start->count && !found; i++) {
        const StartValue *value = &setting->start->at[i];
        Expr e;

        found = !value->is_guess &&
                system_variable(system, value->name, value->primes, &e, NULL) == OK &&
                expr_depends(e, symbol);
    }
    return found;
}

/* How a phase's own states move those of the whole: nx x own, by a difference of this size. */
static bool find_moves(Phase *phase, double t, double *y, double size, int count, double *out)
{
    const Layout *l = phase->layout;
    double *moved = NEW_ARRAY(double, count);
    double *base = NEW_ARRAY(double, count);
    RowValues row;
    bool sound = phase_states(phase, t, y, count, &row, base);

    for (int j = 0; j < l->nx && sound; j++) {
        double *own = &y[l->n + l->nu + j];
        const double was = *own;

        *own += size;
        sound = phase_states(phase, t, y, count, &row, moved);
        *own = was;
        for (int i = 0; i < count; i++)
            out[i * l->nx + j] = (moved[i] - base[i]) / size;
    }
    MEM_FREE(moved, base);
    return sound;
}

/* own += (P^T W P)^-1 P^T W (wanted - now) */
static bool move_nearer(const double *moves, const double *weight, const double *off, int nx,
                        int own, double *at)
{
    Lu *lu = lu_new(own);
    double *move = NEW_ARRAY(double, own);
    bool sound;

    for (int j = 0; j < own; j++)
        for (int k = 0; k < nx; k++) {
            const double part = moves[k * own + j] * weight[k];

            move[j] += part * off[k];
            for (int i = 0; i < own; i++)
                lu_matrix(lu)[j * own + i] += part * moves[k * own + i];
        }
    sound = lu_factor(lu);
    if (sound)
        lu_solve(lu, move);
    for (int j = 0; j < own && sound; j++)
        at[j] += move[j];
    lu_free(lu);
    mem_free(move);
    return sound;
}

/* States of the whole as the phase can have them: those that were given as they are, others as near
 * as they may be. `x` becomes that; false: it has no solution. */
static bool fit_states(ActiveRun *r, Phase *phase, const bool *given, double *y, double *x)
{
    const int nx = phases_whole(r->phases)->layout->nx, own = phase->layout->nx;
    double *moves = NEW_ARRAY(double, nx *own);
    double *weight = NEW_ARRAY(double, nx), *wanted = NEW_ARRAY(double, nx);
    double *off = NEW_ARRAY(double, nx), *now = NEW_ARRAY(double, nx);
    double *at = y + phase->layout->n + phase->layout->nu;
    RowValues row;
    bool sound = find_moves(phase, 0, y, fmax(1, vector_largest(x, nx)), nx, moves) &&
                 phase_states(phase, 0, y, nx, &row, now);

    memcpy(wanted, x, (size_t)nx * sizeof(double));
    for (int turn = 0; turn < FITS && sound; turn++) {
        for (int i = 0; i < nx; i++) {
            weight[i] = given[i] ? 1 : FOLLOWS;
            off[i] = wanted[i] - now[i];
        }
        sound = move_nearer(moves, weight, off, nx, own, at) &&
                phase_states(phase, 0, y, nx, &row, now);
        for (int i = 0; i < nx; i++) /* what others still pull it off */
            wanted[i] += given[i] ? x[i] - now[i] : 0;
    }
    if (sound)
        memcpy(x, now, (size_t)nx * sizeof(double));
    MEM_FREE(moves, weight, wanted, off, now);
    return sound;
}

static Status refuse_given(const ActiveRun *r, const bool *closed, const double *given_x,
                           const bool *given, const double *x, Diag *diag)
{
    const Layout *whole = phases_whole(r->phases)->layout;
    Text what = {0}, values = {0};

    for (int k = 0; k < system_ideal_count(r->system); k++) {
        IdealSwitch ideal;

        if (closed[k] && system_is_ideal(r->system, k) &&
            system_ideal(r->system, k, &ideal, NULL) == OK)
            text_addf(&what, "%s%s", what.length > 0 ? ", " : "", ideal.name);
    }
    for (int i = 0; i < whole->nx; i++)
        if (given[i] && share_is_jump(r, i, given_x[i], x[i]))
            text_addf(&values, "%s%s = %.6g", values.length > 0 ? ", " : "",
                      system_x(whole->system, i)->name, given_x[i]);
    (void)diag_set(diag, E_ASSEMBLE,
                   "the network's initial values contradict with %s closed from the start: %s",
                   what.at, values.at != NULL ? values.at : "");
    diag_hint(diag, "leave one of them out; or let the switch close after the start, as 'when=t > "
                    "0' does: then they share what they store");
    text_free(&what);
    text_free(&values);
    return E_ASSEMBLE;
}

/* Switches that are closed from the start are wires: initial values that weren't given follow from
 * those that were, as they do where parts are joined for good. Diodes are none. */
static Status follow_wires(ActiveRun *r, const Setting *setting, const bool *closed, double *x,
                           Diag *diag)
{
    const Layout *whole = phases_whole(r->phases)->layout;
    const int count = system_ideal_count(r->system);
    bool *wires = NEW_ARRAY(bool, count), *given = NEW_ARRAY(bool, whole->nx);
    double *was = NEW_ARRAY(double, whole->nx), *y = NULL;
    bool any = false;
    Phase *phase;
    Status status = OK;

    for (int k = 0; k < count; k++) {
        IdealSwitch ideal;

        CHECK(system_ideal(r->system, k, &ideal, diag));
        wires[k] = closed[k] && (ideal.when != NULL || !system_is_ideal(r->system, k));
        any = any || (wires[k] && system_is_ideal(r->system, k));
    }
    if (!any || mode_switch_phase(r, setting, wires, &phase, NULL) != OK)
        goto done; /* the sides as they are have messages of their own */
    y = NEW_ARRAY(double, phase->length);
    enter(phase, r->result->start.y, x, r->result->start.y + layout_references(whole), 0, y);
    memcpy(was, x, (size_t)whole->nx * sizeof(double));
    for (int i = 0; i < whole->nx; i++)
        given[i] = is_given(r, setting, i);
    if (!fit_states(r, phase, given, y, x)) {
        memcpy(x, was, (size_t)whole->nx * sizeof(double));
        goto done;
    }
    for (int i = 0; i < whole->nx && status == OK; i++)
        if (given[i] && share_is_jump(r, i, was[i], x[i]))
            status = refuse_given(r, wires, was, given, x, diag);
done:
    MEM_FREE(wires, given, was, y);
    return status;
}

/* whether the phase can't have these states of the whole */
static bool would_jump(const ActiveRun *r, Phase *phase, double t, double *y, const double *x)
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

static Status begin_phase(ActiveRun *r, const Setting *setting, const ModeSearchAt *at,
                          bool *closed, Diag *diag)
{
    Phase *phase;

    TRY(mode_search_find(r->mode_search, at, closed, diag));
    TRY(mode_switch_phase(r, setting, closed, &phase, diag));
    r->phase = phase;
    mem_free(r->begin);
    r->begin = NEW_ARRAY(double, phase->length);
    enter(phase, r->result->start.y, at->x, at->references, 0, r->begin);
    return OK;
}

Status mode_switch_begin(ActiveRun *r, const Setting *setting, Diag *diag)
{
    mem_keep(r);
    const Layout *whole = phases_whole(r->phases)->layout;
    double *x = r->result->start.y + whole->n + whole->nu;
    ModeSearchAt at = {.t = 0,
                       .step = START_STEP,
                       .q = r->result->start.y,
                       .u = r->result->start.y + whole->n,
                       .references = r->result->start.y + layout_references(whole),
                       .x = x,
                       .x_behind = x};
    bool *closed = NEW_ARRAY(bool, system_ideal_count(r->system));
    bool *none = NEW_ARRAY(bool, system_ideal_count(r->system));
    Status status = OK;

    CHECK(begin_phase(r, setting, &at, closed, diag));
    if (would_jump(r, r->phase, 0, r->begin, x)) {
        CHECK(follow_wires(r, setting, closed, x, diag));
        CHECK(begin_phase(r, setting, &at, closed, diag));
    }
    CHECK(check_impulse(r, r->phase, &(Entering){.step = at.step, .before = none}, r->begin, x,
                        diag));
    CHECK(initial_solve(r->phase->layout, r->phase->numbers, r->begin, NULL, NULL, diag));
done:
    MEM_FREE(closed, none);
    return status;
}

/* --- in a run --- */

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

Status mode_switch_events(ActiveRun *r, const Phase *now, const Phase *next, const Setting *setting,
                          Events **events, Diag *diag)
{
    mem_keep(r);
    Events **theirs = &next->like->events;

    if (*events == NULL || next->like == now->like)
        return OK;
    if (*theirs == NULL)
        TRY(active_run_events(r, next, NULL, 0, setting, theirs, diag));
    if (*theirs != *events)
        events_hand_over(*theirs, *events);
    *events = *theirs;
    return OK;
}

/* The phase that a run goes over to at t. Where there is none the run ends there, and keeps what it
 * has. */
static Status next_phase(const ModeSwitching *c, double t, const bool *closed, Phase **out,
                         Diag *diag)
{
    Diag why = {0};
    Status status = mode_switch_phase(c->run, c->setting, closed, out, &why);

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
    const Layout *whole = phases_whole(c->run->phases)->layout;
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
                             .references = look.ahead + layout_references(now->layout),
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

/* Whether the sides that were found may hold at the instant itself. Where states jump, what they
 * jump to is for others to tell. */
static bool holds_at_once(const ModeSwitching *c, const Looking *look, bool changed)
{
    ActiveRun *r = c->run;
    Phase *next = look->now;
    double *entered;
    bool holds;

    if (changed && mode_switch_phase(r, c->setting, look->closed, &next, NULL) != OK)
        return true;
    entered = NEW_ARRAY(double, next->length);
    enter(next, look->y, look->x, look->y + layout_references(look->now->layout),
          look->y[look->now->length - 1], entered);
    holds = mode_margins_off(next, look->t, look->at.t, look->at.step, entered, &c->control) <= 1 ||
            would_jump(r, next, look->t, entered, look->x);
    mem_free(entered);
    return holds;
}

/* Diodes that are seen to go over a step ahead may still be on their sides at the instant itself:
 * from nearer to it they are. What is meant is a step that vanishes, but that tells no side from
 * the other where one begins at 0, least where it was seen before that margins end although none
 * goes over. Where no step shows what holds, the first one is believed. */
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
        enter(*out, y, look->x, y + layout_references(from->layout), y[from->length - 1], entered);
        mode_switching_free(c);
        c->y = entered;
        TRY(check_impulse(r, *out, &entry, c->y, look->x, diag));
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
    CHECK(mode_switch_events(r, now, next, c->setting, &events, diag));
    *segment = phases_segment(next, events);
    *out = c->y;
done:
    phase_enter(r->phases->at[segment->phase]);
    looking_free(&look);
    return status;
}
