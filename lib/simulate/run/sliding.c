/* sliding.c: signs on the surfaces that a run stands on, by algebra/surface_sides.h */
#include "simulate/run/sliding.h"

#include "algebra/linear.h"
#include "algebra/surface_sides.h"
#include "base/memory.h"
#include "simulate/run/impact.h"
#include "simulate/run/mode_phases.h"

#include <math.h>
#include <string.h>

#define AHEAD 1e-7  /* of the run: so soon */
#define STILL 1e-8  /* of the state: a vector that is at rest */
#define MET   1e-10 /* of the state: a start is on a surface */
#define FROM  2     /* times the norm that counts as 0: a vector begins there */

typedef struct Slides {
    int count;       /* of signs: */
    Meeting *at;     /* the surface of each */
    Phase *phase;    /* that slides along all of them */
    double t;        /* of the instant, and y there: */
    const double *y; /* `off` is what it is there */
    double soon;    /* slip is taken then, with y there: where a sign reaches its bound, those of */
    double *y_soon; /* others that reach it next tell nothing yet at the instant itself */
    double *slip, *off;
    SurfaceSide *side;
    double *room;
    int *integers;
    bool insists; /* a sign that has reached its bound leaves there, whatever is solved for */
} Slides;

static void slides_free(Slides *s)
{
    MEM_FREE(s->at, s->y_soon, s->slip, s->off, s->side, s->room, s->integers);
}

/* for the signs of the phase, of `near` surfaces in their order */
static void slides_begin(Slides *s, const Meeting *near)
{
    const VariableIndex *l = s->phase->layout;
    const int n = l->slides;

    s->count = n;
    s->at = NEW_ARRAY(Meeting, n);
    for (int k = 0, i = 0; k < n; k++) {
        i += k > 0 && l->slid_surface[k] != l->slid_surface[k - 1];
        s->at[k] = near[i];
    }
    s->slip = NEW_ARRAY(double, n);
    s->off = NEW_ARRAY(double, n);
    s->side = NEW_ARRAY(SurfaceSide, n);
    s->room = NEW_ARRAY(double, SURFACE_SIDES_ROOM(n));
    s->integers = NEW_ARRAY(int, SURFACE_SIDES_INTEGERS(n));
}

static bool slip_at(void *context, const double *signs, double *out)
{
    Slides *s = context;

    return motion_drift(s->phase->motion, s->soon, s->y_soon, signs, out, s->off);
}

/* Sides from how the surfaces were met. */
static bool find_sides(Slides *s)
{
    const SignRange *ranges = compiled_equations(s->phase->numbers)->sign_ranges;
    const double *bounds = motion_bounds(s->phase->motion);
    const double size = fmax(1, vector_largest(s->y, s->phase->length - 1));

    memset(s->room, 0, (size_t)s->count * sizeof(double)); /* signs of 0 */
    (void)motion_drift(s->phase->motion, s->t, s->y, s->room, s->slip, s->off);
    for (int i = 0; i < s->count; i++) {
        const bool has_bound = ranges[i].has_bound;
        const double bound = ranges[i].cone != 0 ? ranges[i].norm : ranges[i].high;

        s->side[i] = (SurfaceSide){.bound = has_bound ? bounds[2 * i + 1] : bound,
                                   .left = has_bound ? bounds[2 * i] : 1,
                                   .load = ranges[i].load,
                                   .is_unilateral = ranges[i].is_unilateral,
                                   .cone = ranges[i].cone,
                                   .off = s->off[i],
                                   .side = s->at[i].side,
                                   .ends = s->at[i].ends,
                                   .settles = s->at[i].settles};
    }
    return surface_sides_find(s->side, s->count, slip_at, s, s->insists, size, s->room,
                              s->integers);
}

/* --- phases --- */

static Status no_side(const Phase *now, double t, const Meeting *at, int count, Diag *diag)
{
    Text what = {0};
    bool any_load = false;

    for (int i = 0; i < count; i++) {
        SystemSurface surface = {0};
        const bool is_known = system_surface(now->system, at[i].surface, &surface);
        const char *part = is_known ? system_jumping_part(now->system, surface.condition) : NULL;
        char *h;

        if (i > 0 && at[i].surface == at[i - 1].surface)
            continue;
        any_load = any_load || at[i].load > 0;
        h = expr_text(system_plain(now->system, surface.condition));
        text_addf(&what, "%s%s", i > 0 ? ", " : "", h);
        if (part != NULL)
            text_addf(&what, " (%s)", part);
        mem_free(h);
    }
    (void)diag_set(diag, E_SOLVER,
                   "at t = %.9g s: no motion leads on from where %s %s 0: neither to a side nor "
                   "between",
                   t, what.at != NULL ? what.at : "a condition", count > 1 ? "are" : "is");
    if (any_load)
        diag_hint(diag,
                  "with its friction a contact may jam, where no normal force keeps it on its "
                  "surface (Painleve); a smaller mu=, or k= of a compliant contact, has a "
                  "motion there");
    else if (!system_hint_locking(now->system, diag))
        diag_hint(diag, "a steep but continuous law, such as tanh(x/0.001) in the place of "
                        "sign(x), has a motion there");
    text_free(&what);
    return E_SOLVER;
}

/* meetings in the order of their surfaces, as phases are told apart by them */
static void sort_meetings(Meeting *at, int count)
{
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && at[k].surface < at[k - 1].surface; k--) {
            Meeting kept = at[k];

            at[k] = at[k - 1];
            at[k - 1] = kept;
        }
}

/* the first sign of a surface */
static int first_sign(const Slides *s, int surface)
{
    int k = 0;

    while (s->at[k].surface != surface)
        k++;
    return k;
}

static OnSurface on_side(int surface, const SurfaceSide *side)
{
    const bool is_static = side->held && side->cone == 0 && !side->is_unilateral && side->left > 0;

    return (OnSurface){.surface = surface,
                       .side = side->side,
                       .held = side->held,
                       .most = side->rests ? 0
                               : is_static ? side->bound / side->left
                                           : 1};
}

/* The phase on the sides of the surfaces that are met (s->side; NULL: it slides along all) and on
 * the far sides of the others. */
static Status phase_on(const ModeSwitching *c, const Phase *now, const Meeting *all, int count,
                       const Slides *s, Phase **out, Diag *diag)
{
    OnSurface *on = NEW_ARRAY(OnSurface, count);
    int length = 0;
    Status status;

    for (int i = 0; i < count; i++) {
        const int k = all[i].far ? -1 : s == NULL ? 0 : first_sign(s, all[i].surface);

        if (k < 0)
            on[length++] = (OnSurface){.surface = all[i].surface, .side = all[i].side};
        else if (s == NULL)
            on[length++] = (OnSurface){.surface = all[i].surface};
        else if (!s->side[k].is_unaffected)
            on[length++] = on_side(all[i].surface, &s->side[k]);
    }
    status =
        mode_phases_get_on(c->run, c->setting, now->system, now->closed, on, length, out, diag);
    mem_free(on);
    return status;
}

/* the phase that slides along all surfaces that are met; NULL: there is none */
static Status slide_all(const ModeSwitching *c, const Phase *now, const Meeting *all, int count,
                        Phase **out, Diag *diag)
{
    Diag why = {0};
    Status status = phase_on(c, now, all, count, NULL, out, &why);

    if (status == E_MISSING) { /* how it is left can't be determined */
        *out = NULL;
        return OK;
    }
    if (status != OK)
        (void)diag_set(diag, status, "%s", why.message);
    return status;
}

static Status find_side(const Phase *now, Slides *s, double low, double high, Diag *diag)
{
    Status status = OK;

    motion_window(s->phase->motion, low, high);
    if (!find_sides(s))
        status = no_side(now, s->t, s->at, s->count, diag);
    motion_window(s->phase->motion, -INFINITY, INFINITY);
    return status;
}

/* Where one of several signs has reached its bound, others may reach theirs there too, and what
 * each has to hold a little later tells which ones leave. Coordinates and states of networks are
 * moved as they go. False: there is but one. */
static bool look_ahead(const ModeSwitching *c, const Phase *now, Slides *s)
{
    const Ode *ode = motion_ode(now->motion);
    const VariableIndex *l = now->layout;
    double *rate = NEW_ARRAY(double, now->length);
    bool ends = false;

    for (int i = 0; i < s->count; i++)
        ends = ends || s->at[i].ends;
    ends = ends && s->count > 1 && ode->rate(ode->context, s->t, s->y, rate);
    if (ends) {
        s->soon += AHEAD * c->control.span;
        for (int i = 0; i < now->length - 1; i++) /* speeds remain on their surfaces */
            if (i < l->n || i >= l->n + l->nu)
                s->y_soon[i] += AHEAD * c->control.span * rate[i];
    }
    mem_free(rate);
    return ends;
}

/* The phase that goes on from where the run stands. */
static Status choose_phase(const ModeSwitching *c, Phase *now, const Meeting *all, int count,
                           Slides *s, double low, double high, Phase **out, Diag *diag)
{
    const size_t bytes = (size_t)now->length * sizeof(double);
    bool looks;

    s->y_soon = NEW_ARRAY(double, now->length);
    memcpy(s->y_soon, s->y, bytes);
    phase_enter(now);
    looks = look_ahead(c, now, s);
    phase_enter(s->phase);
    s->insists = !looks;
    TRY(find_side(now, s, low, high, diag));
    TRY(phase_on(c, now, all, count, s, out, diag));
    if (!looks || *out != now)
        return OK;
    s->insists = true; /* nothing is seen to change so soon */
    s->soon = s->t;
    memcpy(s->y_soon, s->y, bytes);
    TRY(find_side(now, s, low, high, diag));
    return phase_on(c, now, all, count, s, out, diag);
}

static Status take_impact(ModeSwitching *c, const Slides *s, double low, double high, double *y,
                          bool *any, Diag *diag)
{
    const ImpactAt here = {
        .phase = s->phase, .t = s->t, .span = c->control.span, .at = s->at, .count = s->count};
    Status status;

    motion_window(s->phase->motion, low, high);
    status = impact_take(&here, y, &c->impacts, any, diag);
    motion_window(s->phase->motion, -INFINITY, INFINITY);
    return status;
}

static bool leaves_vector(const SurfaceSide *side, double off, double still)
{
    return side->cone != 0 && side->side != 0 && !side->held && off <= still;
}

/* how far the motion is off the surface that the k-th sign is of */
static double norm_off(const Slides *s, int k)
{
    const int first = first_sign(s, s->at[k].surface);
    double norm = 0;

    for (int i = first; i < first + s->side[first].cone; i++)
        norm = hypot(norm, s->side[i].off);
    return norm;
}

/* What leaves the surface of a vector goes on from a short way off it, in the direction that was
 * found: on the surface there is none. False: it can't be moved there. */
static bool leave_vectors(const Slides *s, double low, double high, double *y, bool *moved)
{
    const double still = STILL * fmax(1, vector_largest(y, s->phase->length - 1));
    bool sound = true;

    phase_enter(s->phase);
    motion_window(s->phase->motion, low, high);
    memset(s->room, 0, (size_t)s->count * sizeof(double));
    for (int k = 0; k < s->count; k++)
        *moved = *moved || leaves_vector(&s->side[k], norm_off(s, k), still);
    if (*moved) {
        sound = motion_drift(s->phase->motion, s->t, y, s->room, s->slip, s->off);
        for (int k = 0; k < s->count; k++)
            if (leaves_vector(&s->side[k], norm_off(s, k), still))
                s->off[k] = FROM * s->at[k].rest * s->side[k].sign;
        sound = sound && motion_leave_surfaces(s->phase->motion, s->t, y, s->off);
    }
    motion_window(s->phase->motion, -INFINITY, INFINITY);
    return sound;
}

Status slide_choose(void *context, double t, double low, double high, double *y, const Meeting *at,
                    int count, Segment *segment, SurfaceChoice *chosen, Diag *diag)
{
    ModeSwitching *c = context;
    Phase *now = c->run->phases->at[segment->phase], *next = NULL;
    Meeting *all = NEW_ARRAY(Meeting, count), *near = NEW_ARRAY(Meeting, count);
    Slides s = {.t = t, .soon = t, .y = y};
    int near_count = 0;
    Events *events = segment->events;
    Status status = OK;

    *chosen = (SurfaceChoice){0};
    for (int i = 0; i < count; i++)
        all[i] = at[i];
    sort_meetings(all, count);
    for (int i = 0; i < count; i++)
        if (!all[i].far)
            near[near_count++] = all[i];
    if (near_count > 0) {
        CHECK(slide_all(c, now, all, count, &s.phase, diag));
        if (s.phase == NULL)
            goto done;
        phase_enter(s.phase);
        slides_begin(&s, near);
        motion_partition(s.phase->motion, t, y);
        CHECK(take_impact(c, &s, low, high, y, &chosen->jumps, diag));
        CHECK(choose_phase(c, now, all, count, &s, low, high, &next, diag));
        if (!leave_vectors(&s, low, high, y, &chosen->moved))
            CHECK(no_side(now, t, s.at, s.count, diag));
    } else {
        CHECK(phase_on(c, now, all, count, NULL, &next, diag));
    }
    if (next == now)
        goto done;
    CHECK(mode_phases_events(c->run, now, next, c->setting, &events, diag));
    *segment = phases_segment(next, events);
    chosen->entered = true;
done:
    phase_enter(c->run->phases->at[segment->phase]);
    slides_free(&s);
    mem_free(all);
    mem_free(near);
    return status;
}

/* The surfaces of the phase at (t, y), as find_meetings() of a run finds them. Returns their
 * number; *any: one is met. */
static int meet_at_start(const Phase *phase, double t, const double *y, Meeting *at, bool *any)
{
    const Equations *eq = compiled_equations(phase->numbers);
    const double size = fmax(1, vector_largest(y, phase->length - 1));
    double *h = NEW_ARRAY(double, eq->switch_count);
    int count = 0;

    *any = false;
    if (eq->switch_count > 0)
        motion_switches(phase->motion, t, y, h);
    for (int i = 0; i < eq->switch_count; i++) {
        const Guard guard = equations_guard(eq, i);
        bool is_met;

        if (guard.surface < 0 || guard.is_idle || guard.end != 0)
            continue;
        is_met = !guard.is_of_event &&
                 (guard.solved || (guard.is_unilateral ? -h[i] : fabs(h[i])) <= MET * size);
        at[count++] = (Meeting){guard.surface, .far = !is_met,
                                .side = is_met                           ? 0
                                        : h[i] > 0 && !guard.is_of_event ? 1
                                                                         : -1,
                                .rest = guard.is_norm ? MET * size : 0};
        *any = *any || is_met;
    }
    mem_free(h);
    return count;
}

Status slide_begin(ActiveRun *run, const SimulationInput *setting, double t, const double *y,
                   Diag *diag)
{
    Phase *phase = run->phase;
    const int conditions = compiled_equations(phase->numbers)->switch_count;
    ModeSwitching c = {.run = run, .setting = setting, .control = {.span = 1}};
    Meeting *at = NEW_ARRAY(Meeting, conditions);
    double *moved = NEW_ARRAY(double, phase->length);
    Segment segment = phases_segment(phase, NULL);
    SurfaceChoice chosen = {0};
    Status status = OK;
    bool any;
    const int count = meet_at_start(phase, t, y, at, &any);

    memcpy(moved, y, (size_t)phase->length * sizeof(double));
    if (any)
        status =
            slide_choose(&c, t, -INFINITY, INFINITY, moved, at, count, &segment, &chosen, diag);
    if (status == OK && !chosen.jumps && !chosen.moved)
        run->phase = run->phases->at[segment.phase];
    if (status == E_SOLVER) /* no motion leads on from there */
        status = OK;
    phase_enter(run->phase);
    mode_switching_free(&c);
    MEM_FREE(at, moved);
    return status;
}

void sliding_report(void *context, const Segment *segment, int condition, Text *out)
{
    const ModeSwitching *c = context;
    System *system = c->run->phases->at[segment->phase]->system;
    const CompiledEquations *numbers = c->run->phases->at[segment->phase]->numbers;
    Expr h = compiled_condition(numbers, condition);
    const bool is_norm = equations_guard(segment->equations, condition).is_norm;
    const char *part = h != NULL ? system_jumping_part(system, h) : NULL;
    char *text = h != NULL ? expr_text(system_plain(system, h)) : NULL;
    IdealSwitch diode;

    if (text != NULL)
        text_addf(out, "%s%s", is_norm ? "" : "the sign of ", text);
    else if (system_ideal(system, compiled_margin(numbers, condition), &diode, NULL) == OK)
        text_add(out, diode.name);
    if (part != NULL)
        text_addf(out, " (%s)", part);
    mem_free(text);
}
