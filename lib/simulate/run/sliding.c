/* sliding.c: signs on the surfaces that a run stands on
 *
 * slip = a + B s: how each surface is left, h' or what of it signs reach. B is minus a positive
 * definite matrix where what jumps pushes back, as dry friction does: then there is one solution,
 * and Murty's exchanges (1974) end at it. Where B_ii > 0 what jumps pushes away, and nothing slides
 * there. */
#include "simulate/run/sliding.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/equations/signs.h"
#include "simulate/run/mode_phases.h"

#include <math.h>
#include <string.h>

#define FLAT      1e-12 /* of the largest entry: no influence at all */
#define WRONG     1e-9  /* of the largest: a slip that leads back, and not by rounding */
#define BEYOND    1e-10 /* of a sign, likewise */
#define EXCHANGES 200   /* a surface */
#define REFINED   8     /* where slip isn't linear in the signs */
#define STILL     1e-8  /* of y: what is 0 on a surface and so is its rate, where slip is h'' */

typedef struct Slides {
    int count;
    const Meeting *at;
    Phase *phase; /* that slides along all of them */
    double t;
    const double *y;
    double *signs; /* of which slip is taken */
    double *slip, *off, *a, *b;
    int *side;   /* 0: it is slid along */
    bool *fixed; /* the side is known beforehand */
    bool *loose; /* no sign changes how it is left: its side is left to the equations */
    double largest;
} Slides;

static void slides_free(Slides *s)
{
    mem_free(s->signs);
    mem_free(s->slip);
    mem_free(s->off);
    mem_free(s->a);
    mem_free(s->b);
    mem_free(s->side);
    mem_free(s->fixed);
    mem_free(s->loose);
}

/* --- slip in numbers --- */

static bool slip_at(Slides *s, double *out)
{
    return motion_drift(s->phase->motion, s->t, s->y, s->signs, out, s->off);
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
        double low = n == 1 ? -1 : kept - (kept > 0 ? 0.5 : 0), high = n == 1 ? 1 : low + 0.5;

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

/* slip by the linear reading */
static double linear_slip(const Slides *s, int i)
{
    double sum = s->a[i];

    for (int k = 0; k < s->count; k++)
        sum += s->b[i * s->count + k] * s->signs[k];
    return sum;
}

/* the signs of those that are slid along, others at the ends that they are on */
static bool solve_signs(Slides *s)
{
    int *place = NEW_ARRAY(int, s->count);
    int n = 0;
    bool sound = true;

    for (int i = 0; i < s->count; i++) {
        if (s->side[i] == 0)
            place[n++] = i;
        s->signs[i] = s->side[i];
    }
    if (n > 0) {
        double *matrix = NEW_ARRAY(double, n *n);
        double *move = NEW_ARRAY(double, n);

        for (int i = 0; i < n; i++) {
            move[i] = -linear_slip(s, place[i]);
            for (int k = 0; k < n; k++)
                matrix[i * n + k] = s->b[place[i] * s->count + place[k]];
        }
        sound = signs_least(matrix, n, move);
        for (int i = 0; i < n && sound; i++)
            s->signs[place[i]] = move[i];
        mem_free(matrix);
        mem_free(move);
    }
    mem_free(place);
    return sound;
}

/* Whether entry i is right as it stands; if not, *side is what it becomes. */
static bool is_right(const Slides *s, int i, int *side)
{
    double slip;

    if (s->fixed[i])
        return true;
    if (s->side[i] == 0) {
        *side = s->signs[i] > 0 ? 1 : -1;
        return fabs(s->signs[i]) <= 1 + BEYOND;
    }
    slip = linear_slip(s, i);
    *side = s->b[i * s->count + i] < 0 ? 0 : -s->side[i];
    return slip * s->side[i] >= -WRONG * s->largest;
}

static bool exchange(Slides *s)
{
    for (int turn = 0; turn < EXCHANGES * s->count; turn++) {
        int i = 0, side = 0;

        if (!solve_signs(s))
            return false;
        while (i < s->count && is_right(s, i, &side))
            i++;
        if (i == s->count)
            return true;
        s->side[i] = side;
    }
    return false;
}

/* what is known before: which sides, and where no sign matters */
static void begin_sides(Slides *s)
{
    int n = s->count;
    double size = fmax(1, vector_largest(s->y, s->phase->length - 1));

    (void)slip_at(s, s->slip);
    for (int i = 0; i < n; i++) {
        double own = s->b[i * n + i];

        s->side[i] = s->at[i].side;
        s->fixed[i] = s->side[i] != 0;
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
        if (!exchange(s))
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
        Expr surface = system_surface(now->system, at[i].surface);
        const char *part = system_jumping_part(now->system, surface);
        char *h = expr_text(system_plain(now->system, surface));

        text_addf(&what, "%s%s", i > 0 ? ", " : "", h);
        if (part != NULL)
            text_addf(&what, " (%s)", part);
        mem_free(h);
    }
    (void)diag_set(diag, E_SOLVER,
                   "at t = %.9g s: no motion leads on from where %s %s 0: neither to a side nor "
                   "between",
                   t, what.at, count > 1 ? "are" : "is");
    diag_hint(diag,
              "a steep but continuous law, such as tanh(x/0.001) in the place of sign(x), has "
              "a motion there");
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

/* The phase on these sides of the surfaces that are met (`side`, one each; 0: it slides along) and
 * on the far sides of the others. */
static Status phase_on(const ModeSwitching *c, const Phase *now, const Meeting *all, int count,
                       const int *side, const bool *loose, Phase **out, Diag *diag)
{
    OnSurface *on = NEW_ARRAY(OnSurface, count);
    int length = 0, near = 0;
    Status status;

    for (int i = 0; i < count; i++) {
        int k = all[i].far ? -1 : near++;

        if (k < 0)
            on[length++] = (OnSurface){all[i].surface, all[i].side};
        else if (loose == NULL || !loose[k])
            on[length++] = (OnSurface){all[i].surface, side != NULL ? side[k] : 0};
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
    Status status = phase_on(c, now, all, count, NULL, NULL, out, &why);

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
    int n = s->count;
    Status status = OK;

    s->signs = NEW_ARRAY(double, n);
    s->slip = NEW_ARRAY(double, n);
    s->off = NEW_ARRAY(double, n);
    s->a = NEW_ARRAY(double, n);
    s->b = NEW_ARRAY(double, n *n);
    s->side = NEW_ARRAY(int, n);
    s->fixed = NEW_ARRAY(bool, n);
    s->loose = NEW_ARRAY(bool, n);
    motion_window(s->phase->motion, low, high);
    if (!find_sides(s))
        status = no_side(now, s->t, s->at, n, diag);
    motion_window(s->phase->motion, -INFINITY, INFINITY);
    return status;
}

Status slide_choose(void *context, double t, double low, double high, const double *y,
                    const Meeting *at, int count, Segment *segment, bool *entered, Diag *diag)
{
    const ModeSwitching *c = context;
    Phase *now = c->run->phases->at[segment->phase], *next = NULL;
    Meeting *all = NEW_ARRAY(Meeting, count), *near = NEW_ARRAY(Meeting, count);
    Slides s = {.at = near, .t = t, .y = y};
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
        CHECK(find_side(now, &s, low, high, diag));
    }
    CHECK(phase_on(c, now, all, count, s.side, s.loose, &next, diag));
    if (next == now)
        goto done;
    CHECK(mode_phases_events(c->run, now, next, c->setting, &events, diag));
    *segment = phases_segment(next, events);
    *entered = true;
done:
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
