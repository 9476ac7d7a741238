/* sliding.c: signs on the surfaces that a run stands on
 *
 *     slip = a + B s,  -r <= s <= r
 *
 * slip: how each surface is left, h' or what of it signs affect. s = r: it is left to h > 0, slip
 * >= 0; s = -r: to h < 0, slip <= 0; otherwise the motion slides along it, slip = 0. With M = -B
 * and q = -a that is a complementarity problem with bounds (algebra/complementarity.h). M is
 * positive semidefinite where what jumps pushes back, as dry friction does. Where B_ii > 0 what
 * jumps pushes away, and nothing slides there.
 *
 * r is above 1 where static friction is larger than kinetic: a surface that is left then has the
 * sign +-1, and the others are solved for again. At most as many rounds as surfaces. */
#include "simulate/run/sliding.h"

#include "algebra/complementarity.h"
#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/equations/signs.h"
#include "simulate/run/mode_phases.h"

#include <math.h>
#include <string.h>

#define FLAT      1e-12 /* of the largest entry: no influence at all */
#define WRONG     1e-9  /* of the largest: a slip that leads back, and not by rounding */
#define AHEAD     1e-7  /* of the run: so soon */
#define DEPENDENT 1e-9  /* of B_ii: what is left of a row that depends on others */
#define REFINED   8     /* where slip isn't linear in the signs */
#define STILL     1e-8  /* of y: what is 0 on a surface and so is its rate, where slip is h'' */

typedef struct Slides {
    int count;
    const Meeting *at;
    Phase *phase;    /* that slides along all of them */
    double t;        /* of the instant, and y there: */
    const double *y; /* `off` is what it is there */
    double soon;    /* slip is taken then, with y there: where a sign reaches its bound, those of */
    double *y_soon; /* others that reach it next tell nothing yet at the instant itself */
    double *signs;  /* of which slip is taken */
    double *slip, *off, *a, *b;
    const double *bounds; /* r */
    int *side;            /* 0: it is slid along */
    bool *fixed;          /* the side is known beforehand */
    bool *held;   /* at an end of its interval, while those that stick keep it on its surface */
    bool *loose;  /* no sign changes how it is left: its side is left to the equations */
    bool insists; /* a sign that has reached its bound leaves there, whatever is solved for */
    double largest;
} Slides;

static void slides_free(Slides *s)
{
    MEM_FREE(s->y_soon, s->signs, s->slip, s->off, s->a, s->b, s->side, s->fixed, s->held,
             s->loose);
}

static void slides_make_room(Slides *s)
{
    const int n = s->count;

    s->signs = NEW_ARRAY(double, n);
    s->slip = NEW_ARRAY(double, n);
    s->off = NEW_ARRAY(double, n);
    s->a = NEW_ARRAY(double, n);
    s->b = NEW_ARRAY(double, n *n);
    s->side = NEW_ARRAY(int, n);
    s->fixed = NEW_ARRAY(bool, n);
    s->held = NEW_ARRAY(bool, n);
    s->loose = NEW_ARRAY(bool, n);
    s->bounds = compiled_equations(s->phase->numbers)->sign_bounds;
}

/* --- slip in numbers --- */

static bool slip_at(Slides *s, double *out)
{
    return motion_drift(s->phase->motion, s->soon, s->y_soon, s->signs, out, s->off);
}

/* a and B around the signs as they are; over the whole interval where there is but one sign */
static bool find_slopes(Slides *s)
{
    int n = s->count;
    double *up = NEW_ARRAY(double, n);
    bool sound = slip_at(s, s->slip);

    s->largest = vector_largest(s->slip, n);
    for (int k = 0; k < n && sound; k++) {
        double kept = s->signs[k];
        const double end = s->bounds[k];
        double low = n == 1 ? -end : kept - (kept > 0 ? 0.5 : 0), high = n == 1 ? end : low + 0.5;

        s->signs[k] = low;
        sound = slip_at(s, s->slip);
        s->signs[k] = high;
        sound = sound && slip_at(s, up);
        s->signs[k] = kept;
        for (int i = 0; i < n; i++)
            s->b[i * n + k] = (up[i] - s->slip[i]) / (high - low);
        if (n == 1)
            s->a[0] = (up[0] + s->slip[0]) / 2;
    }
    if (n > 1) {
        sound = sound && slip_at(s, s->slip);
        for (int i = 0; i < n; i++) {
            s->a[i] = s->slip[i];
            for (int k = 0; k < n; k++)
                s->a[i] -= s->b[i * n + k] * s->signs[k];
        }
    }
    for (int i = 0; i < n * n; i++)
        s->largest = fmax(s->largest, fabs(s->b[i]));
    mem_free(up);
    return sound;
}

/* --- sides --- */

/* the sides and signs of those that aren't fixed, with the others as they are; false: none */
static bool solve_sides(Slides *s)
{
    const int n = s->count;
    double *matrix = NEW_ARRAY(double, n *n), *q = NEW_ARRAY(double, n);
    double *low = NEW_ARRAY(double, n), *z = NEW_ARRAY(double, n), *high = NEW_ARRAY(double, n);
    int *place = NEW_ARRAY(int, n), *side = NEW_ARRAY(int, n);
    Complementarity problem = {.matrix = matrix, .q = q, .low = low, .high = high};
    double *room;
    bool found;

    for (int i = 0; i < n; i++)
        if (!s->fixed[i])
            place[problem.n++] = i;
        else
            s->signs[i] = s->side[i];
    for (int i = 0; i < problem.n; i++) {
        const double *row = s->b + (ptrdiff_t)place[i] * n;

        high[i] = s->bounds[place[i]];
        low[i] = -high[i];
        side[i] = s->side[place[i]];
        q[i] = -s->a[place[i]];
        for (int k = 0; k < n; k++)
            q[i] -= s->fixed[k] ? row[k] * s->signs[k] : 0;
        for (int k = 0; k < problem.n; k++)
            matrix[i * problem.n + k] = -row[place[k]];
    }
    room = NEW_ARRAY(double, complementarity_room(problem.n));
    found = complementarity_solve(&problem, side, z, room);
    for (int i = 0; i < problem.n && found; i++) {
        s->side[place[i]] = side[i];
        s->signs[place[i]] = z[i];
    }
    MEM_FREE(matrix, q, low, high, z, place, side, room);
    return found;
}

/* Surfaces that are left have their kinetic sign. Whether any had another one. */
static bool leave(Slides *s)
{
    bool any = false;

    for (int i = 0; i < s->count; i++) {
        if (s->fixed[i] || s->side[i] == 0 || s->bounds[i] == 1)
            continue;
        s->fixed[i] = any = true;
        s->signs[i] = s->side[i];
    }
    return any;
}

static bool solve_problem(Slides *s)
{
    bool *fixed = NEW_ARRAY(bool, s->count);
    bool found;

    memcpy(fixed, s->fixed, (size_t)s->count * sizeof(bool));
    do
        found = solve_sides(s);
    while (found && leave(s));
    memcpy(s->fixed, fixed, (size_t)s->count * sizeof(bool));
    mem_free(fixed);
    return found;
}

/* what is known before: which sides, and where no sign matters */
static void begin_sides(Slides *s)
{
    int n = s->count;
    double size = fmax(1, vector_largest(s->y, s->phase->length - 1));

    (void)motion_drift(s->phase->motion, s->t, s->y, s->signs, s->slip, s->off);
    for (int i = 0; i < n; i++) {
        double own = s->b[i * n + i];

        s->side[i] = s->at[i].side;
        s->fixed[i] = s->side[i] != 0 && (s->insists || !s->at[i].ends);
        s->loose[i] = false;
        if (s->fixed[i])
            continue;
        if (fabs(s->off[i]) > STILL * size && !s->at[i].settles) { /* it is on its way through */
            s->side[i] = s->off[i] > 0 ? 1 : -1;
            s->fixed[i] = true;
        } else if (fabs(own) <= FLAT * s->largest) {
            double slip = s->a[i];

            s->fixed[i] = true;
            s->side[i] = slip < 0 ? -1 : 1;
            s->loose[i] = fabs(slip) <= WRONG * s->largest;
        } else if (own > 0) {
            s->side[i] = s->a[i] < 0 ? -1 : 1;
        }
    }
}

/* Whether surface i can't be left while the motion slides along all surfaces of side 0: B_ii less
 * what these take of it, B_iS B_SS^-1 B_Si, is 0. */
static bool is_held(const Slides *s, int i)
{
    const int n = s->count;
    double *matrix = NEW_ARRAY(double, n *n), *x = NEW_ARRAY(double, n);
    double left = s->b[i * n + i];
    int between = 0;

    for (int k = 0; k < n; k++) {
        if (s->side[k] != 0)
            continue;
        x[between++] = s->b[k * n + i];
    }
    for (int k = 0, at = 0; k < n; k++)
        for (int j = 0; j < n && s->side[k] == 0; j++)
            if (s->side[j] == 0)
                matrix[at++] = s->b[k * n + j];
    if (between == 0 || !signs_least(matrix, between, x))
        left = INFINITY;
    for (int k = 0, at = 0; k < n && between > 0; k++)
        if (s->side[k] == 0)
            left -= s->b[i * n + k] * x[at++];
    MEM_FREE(matrix, x);
    return fabs(left) <= DEPENDENT * fabs(s->b[i * n + i]);
}

static void find_held(Slides *s)
{
    const double size = fmax(1, vector_largest(s->y, s->phase->length - 1));

    for (int i = 0; i < s->count; i++)
        s->held[i] = s->side[i] != 0 && s->b[i * s->count + i] < 0 &&
                     fabs(s->off[i]) <= STILL * size && is_held(s, i);
}

/* Sides by the linear reading, which is then taken anew around the signs, until they stay. */
static bool find_sides(Slides *s)
{
    int n = s->count;
    int *before = NEW_ARRAY(int, n);
    bool stays = false;

    for (int turn = 0; turn < REFINED && !stays; turn++) {
        if (!find_slopes(s))
            break;
        if (turn == 0)
            begin_sides(s);
        memcpy(before, s->side, (size_t)n * sizeof(int));
        if (!solve_problem(s))
            break;
        stays = n == 1 || (turn > 0 && memcmp(before, s->side, (size_t)n * sizeof(int)) == 0);
    }
    mem_free(before);
    return stays;
}

/* --- phases --- */

static Status no_side(const Phase *now, double t, const Meeting *at, int count, Diag *diag)
{
    Text what = {0};

    for (int i = 0; i < count; i++) {
        SystemSurface surface = {0};
        const bool is_known = system_surface(now->system, at[i].surface, &surface);
        const char *part = is_known ? system_jumping_part(now->system, surface.condition) : NULL;
        char *h = expr_text(system_plain(now->system, surface.condition));

        text_addf(&what, "%s%s", i > 0 ? ", " : "", h);
        if (part != NULL)
            text_addf(&what, " (%s)", part);
        mem_free(h);
    }
    (void)diag_set(diag, E_SOLVER,
                   "at t = %.9g s: no motion leads on from where %s %s 0: neither to a side nor "
                   "between",
                   t, what.at, count > 1 ? "are" : "is");
    if (!system_hint_locking(now->system, diag))
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

/* The phase on the sides of the surfaces that are met (s->side; NULL: it slides along all) and on
 * the far sides of the others. */
static Status phase_on(const ModeSwitching *c, const Phase *now, const Meeting *all, int count,
                       const Slides *s, Phase **out, Diag *diag)
{
    OnSurface *on = NEW_ARRAY(OnSurface, count);
    int length = 0, near = 0;
    Status status;

    for (int i = 0; i < count; i++) {
        int k = all[i].far ? -1 : near++;

        if (k < 0)
            on[length++] = (OnSurface){all[i].surface, all[i].side, false};
        else if (s == NULL)
            on[length++] = (OnSurface){all[i].surface, 0, false};
        else if (!s->loose[k])
            on[length++] = (OnSurface){all[i].surface, s->side[k], s->held[k]};
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
    if (find_sides(s))
        find_held(s);
    else
        status = no_side(now, s->t, s->at, s->count, diag);
    motion_window(s->phase->motion, -INFINITY, INFINITY);
    return status;
}

/* Where one of several signs has reached its bound, others may reach theirs there too, and what
 * each has to hold a little later tells which ones leave. Coordinates are moved as they go. False:
 * there is but one. */
static bool look_ahead(const ModeSwitching *c, const Phase *now, Slides *s)
{
    const Ode *ode = motion_ode(now->motion);
    double *rate = NEW_ARRAY(double, now->length);
    bool ends = false;

    for (int i = 0; i < s->count; i++)
        ends = ends || s->at[i].ends;
    ends = ends && s->count > 1 && ode->rate(ode->context, s->t, s->y, rate);
    if (ends) {
        s->soon += AHEAD * c->control.span;
        for (int i = 0; i < now->layout->n; i++)
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

Status slide_choose(void *context, double t, double low, double high, const double *y,
                    const Meeting *at, int count, Segment *segment, bool *entered, Diag *diag)
{
    const ModeSwitching *c = context;
    Phase *now = c->run->phases->at[segment->phase], *next = NULL;
    Meeting *all = NEW_ARRAY(Meeting, count), *near = NEW_ARRAY(Meeting, count);
    Slides s = {.at = near, .t = t, .soon = t, .y = y};
    Events *events = segment->events;
    Status status = OK;

    *entered = false;
    for (int i = 0; i < count; i++)
        all[i] = at[i];
    sort_meetings(all, count);
    for (int i = 0; i < count; i++)
        if (!all[i].far)
            near[s.count++] = all[i];
    if (s.count > 0) {
        CHECK(slide_all(c, now, all, count, &s.phase, diag));
        if (s.phase == NULL)
            goto done;
        phase_enter(s.phase);
        slides_make_room(&s);
        motion_partition(s.phase->motion, t, y);
        CHECK(choose_phase(c, now, all, count, &s, low, high, &next, diag));
    } else {
        CHECK(phase_on(c, now, all, count, NULL, &next, diag));
    }
    if (next == now)
        goto done;
    CHECK(mode_phases_events(c->run, now, next, c->setting, &events, diag));
    *segment = phases_segment(next, events);
    *entered = true;
done:
    phase_enter(c->run->phases->at[segment->phase]);
    slides_free(&s);
    mem_free(all);
    mem_free(near);
    return status;
}

void sliding_report(void *context, const Segment *segment, int condition, Text *out)
{
    const ModeSwitching *c = context;
    System *system = c->run->phases->at[segment->phase]->system;
    const CompiledEquations *numbers = c->run->phases->at[segment->phase]->numbers;
    Expr h = compiled_condition(numbers, condition);
    const char *part = h != NULL ? system_jumping_part(system, h) : NULL;
    char *text = h != NULL ? expr_text(system_plain(system, h)) : NULL;
    IdealSwitch diode;

    if (text != NULL)
        text_addf(out, "the sign of %s", text);
    else if (system_ideal(system, compiled_margin(numbers, condition), &diode, NULL) == OK)
        text_add(out, diode.name);
    if (part != NULL)
        text_addf(out, " (%s)", part);
    mem_free(text);
}
