/* machine_hybrid.h: machines with switches, diodes, sampled control and events, for an oracle that
 * goes from one instant at which something jumps to the next
 *
 * The tableau of machine_tableau.h is integrated with switches as they are. Where a condition has
 * changed at a step's end, its instant is enclosed from the step's start (Illinois), and what jumps
 * there jumps: a switch, a diode, speeds by the impulses that joints carry, what a block holds. */
#ifndef COTREE_TESTS_MACHINE_HYBRID_H
#define COTREE_TESTS_MACHINE_HYBRID_H

#include "machine_whole.h"

enum { WATCHES = 8, BLOCKS = 3 };

/* what a condition reads: sign (x - level) > 0 */
typedef enum SignalKind {
    SIGNAL_WAVE,
    SIGNAL_PLACE,
    SIGNAL_RATE,
    SIGNAL_BODY,
    SIGNAL_STATE
} SignalKind;
typedef struct Signal {
    SignalKind kind;
    int index, axis;
    double sign, level, after; /* after: and t > after; 0: at any time */
    Wave wave;
    char text[320];
} Signal;

typedef enum WatchKind { WATCH_SWITCH, WATCH_DIODE, WATCH_EVENT } WatchKind;
typedef struct CallMonitor {
    WatchKind kind;
    Signal signal;
    int element;        /* the switch or the diode */
    bool holds;         /* the condition, as it was last */
    int target;         /* of an event: the coordinate whose rate changes; -1: it marks */
    int state;          /* or a network's state; -1 */
    double factor, add; /* the new value: factor times the old one, and this */
    bool stops;
} CallMonitor;

typedef enum BlockKind {
    BLOCK_PD,
    BLOCK_PID,
    BLOCK_GAIN,
    BLOCK_INTEGRATOR,
    BLOCK_LAG,
    BLOCK_TRANSFER
} BlockKind;
typedef struct Block {
    BlockKind kind;
    int element, of; /* the coordinate; or, below 0, minus the node */
    double period, next, x, memory;
    double Kp, Ki, Kd, T, a[2], b[3], xx[2]; /* transfer: num b, den 1, a */
    bool limited;
    double low, high;
    Wave ref;
} Block;

typedef struct Hybrid {
    Drawn d;
    int watches, blocks;
    CallMonitor watch[WATCHES];
    Block block[BLOCKS];
    bool unsure; /* a condition was touched, or sides are not plain */
    bool stopped;
    int happened;
    double last; /* when something jumped last */
} Hybrid;

/* --- conditions --- */

static inline double signal_value(const Machine *m, const Instant *now, const Signal *s)
{
    double x = 0;

    switch (s->kind) {
    case SIGNAL_WAVE:
        x = wave(&s->wave, now->t);
        break;
    case SIGNAL_PLACE:
        x = now->q[s->index];
        break;
    case SIGNAL_RATE:
        x = coordinate_row(m, now, s->index).rate;
        break;
    case SIGNAL_BODY:
        x = now->p[s->index].at[s->axis];
        break;
    case SIGNAL_STATE:
        x = now->z[m->element[s->index].state];
        break;
    }
    x = s->sign * (x - s->level);
    return now->t < s->after - 1e-13 ? -1 : x;
}

/* above 0 where the condition holds */
static inline double watched(const Machine *m, const Instant *now, const CallMonitor *w)
{
    const Element *e;
    double v;

    if (w->kind != WATCH_DIODE)
        return signal_value(m, now, &w->signal);
    e = &m->element[w->element];
    v = (e->p > 0 ? now->potential[e->p] : 0) - (e->m > 0 ? now->potential[e->m] : 0) - e->rest;
    return e->on && e->low == 0 ? now->current[w->element] : v;
}

static inline bool look(Hybrid *h, const Real *y, Instant *now)
{
    unpack(&h->d.m, y, now);
    return instant_solve(&h->d.m, now);
}

/* sides of diodes that agree with what they make of the network; those they have come first */
static inline bool settle(Hybrid *h, const Real *y)
{
    static Instant now;
    int diode[WATCHES], count = 0, was = 0;

    for (int i = 0; i < h->watches; i++)
        if (h->watch[i].kind == WATCH_DIODE) {
            was |= h->d.m.element[h->watch[i].element].on ? 1 << count : 0;
            diode[count++] = i;
        }
    for (int sides = 0; sides < 1 << count; sides++) {
        bool agrees = true;

        for (int k = 0; k < count; k++)
            h->d.m.element[h->watch[diode[k]].element].on = ((sides ^ was) >> k) & 1;
        if (!look(h, y, &now))
            continue;
        for (int k = 0; k < count && agrees; k++) {
            CallMonitor *w = &h->watch[diode[k]];
            const double g = watched(&h->d.m, &now, w);

            w->holds = h->d.m.element[w->element].on;
            if (fabs(g) < 1e-7 && sides != 0)
                h->unsure = true;
            agrees = w->holds ? g >= -1e-9 : g <= 1e-9;
        }
        if (agrees)
            return true;
    }
    return false;
}

/* --- blows --- */

/* speeds behind a blow along a coordinate, which goes at `rate` from then on */
static inline bool blow(const Machine *m, Instant *now, int coordinate, double rate)
{
    static Tableau T;
    static Held held;
    Row row = coordinate_row(m, now, coordinate);
    const double change = rate - row.rate;
    int r = 6 * m->bodies;

    find_held(m, now, &held);
    T.n = r + held.all + 1;
    for (int i = 0; i < T.n; i++)
        memset(T.at[i], 0, (size_t)(T.n + 1) * sizeof(double));
    add_bodies(m, now, &T);
    for (int i = 0; i < m->elements; i++) {
        const Element *e = &m->element[i];
        const double inertia = e->kind == MOTOR          ? e->ratio * e->ratio * e->J
                               : e->kind == WHEEL_ON_END ? e->J
                                                         : 0;
        const Row own = coordinate_row(m, now, e->coordinate);

        if (inertia > 0)
            add_rotor(&T, &own, inertia);
    }
    for (int i = 0; i < T.n; i++)
        T.at[i][T.n] = 0;
    for (int j = 0; j < m->hinges; j++)
        for (int k = 0; k < held.count[j]; k++, r++) {
            held.row[j][k].bias = 0;
            act(&T, &held.row[j][k], r, 1);
            differentiate(&T, &held.row[j][k], r, 1);
        }
    row.bias = 0;
    act(&T, &row, r, 1);
    differentiate(&T, &row, r, 1);
    T.at[r][T.n] = change;
    if (!tableau_solve(&T))
        return false;
    for (int b = 0; b < m->bodies; b++)
        for (int k = 0; k < 3; k++) {
            now->v[b].at[k] += T.at[6 * b + k][T.n];
            now->w[b].at[k] += T.at[6 * b + 3 + k][T.n];
        }
    return true;
}

static inline bool happen(Hybrid *h, CallMonitor *w, Real *y)
{
    static Instant now;
    Machine *m = &h->d.m;

    h->happened++;
    if (!look(h, y, &now))
        return false;
    if (w->kind == WATCH_SWITCH)
        m->element[w->element].on = w->holds;
    if (w->kind == WATCH_DIODE)
        m->element[w->element].on = w->holds;
    if (w->kind == WATCH_EVENT && w->holds) {
        h->stopped = h->stopped || w->stops;
        if (w->target >= 0) {
            if (!blow(m, &now, w->target, w->factor * now.rate[w->target] + w->add))
                return false;
            for (int b = 0; b < m->bodies; b++)
                for (int k = 0; k < 3; k++) {
                    y[13 * b + 7 + k] = now.v[b].at[k];
                    y[13 * b + 10 + k] = now.w[b].at[k];
                }
        }
        if (w->state >= 0)
            y[13 * m->bodies + m->coordinates + w->state] = w->factor * now.z[w->state] + w->add;
    }
    /* its own value may be far behind where it happened, and it can come again */
    if (w->kind == WATCH_EVENT && w->holds && look(h, y, &now) && watched(m, &now, w) < -1e-6)
        w->holds = false;
    /* one that reads a speed or a state that has just jumped */
    if (w->kind == WATCH_EVENT && look(h, y, &now))
        for (int i = 0; i < h->watches; i++)
            if (h->watch[i].kind != WATCH_DIODE && &h->watch[i] != w) {
                const bool holds = watched(m, &now, &h->watch[i]) > 0;

                if (holds != h->watch[i].holds) {
                    h->watch[i].holds = holds;
                    h->unsure = h->unsure || h->watch[i].kind == WATCH_EVENT;
                    if (h->watch[i].kind == WATCH_SWITCH)
                        m->element[h->watch[i].element].on = holds;
                }
            }
    return settle(h, y);
}

/* --- samples --- */

static inline double clipped(const Block *b, double u)
{
    return b->limited ? fmin(fmax(u, b->low), b->high) : u;
}

/* what a block holds from now on, of what was just before */
static inline double sampled(Block *b, const Instant *now)
{
    const double of = b->of >= 0 ? now->q[b->of] : now->potential[-b->of];
    const double h = b->period;
    double e, u, y, part[2];

    switch (b->kind) {
    case BLOCK_GAIN:
        return clipped(b, b->Kp * of);
    case BLOCK_INTEGRATOR:
        y = clipped(b, b->x);
        b->x = clipped(b, b->x + h * b->Kp * of);
        return y;
    case BLOCK_LAG:
        y = clipped(b, b->x);
        b->x += (b->Kp * of - b->x) * (1 - exp(-h / b->T));
        return y;
    case BLOCK_TRANSFER: /* x' = A x + B of, of held, (1 - h/2 A) x+ = (1 + h/2 A) x + h B of */
        y = b->b[0] * of + (b->b[1] - b->b[0] * b->a[0]) * b->xx[1] +
            (b->b[2] - b->b[0] * b->a[1]) * b->xx[0];
        part[0] = b->xx[0] + h / 2 * b->xx[1];
        part[1] = b->xx[1] + h / 2 * (-b->a[1] * b->xx[0] - b->a[0] * b->xx[1]) + h * of;
        b->xx[1] =
            (part[1] - h / 2 * b->a[1] * part[0]) / (1 + h / 2 * b->a[0] + h * h / 4 * b->a[1]);
        b->xx[0] = part[0] + h / 2 * b->xx[1];
        return clipped(b, y);
    default:
        e = wave(&b->ref, now->t) - of;
        u = b->Kp * e + b->Ki * b->x;
        if (b->Kd != 0)
            u += b->Kd * (e - b->memory) / (b->T > 0 ? b->T + h : h);
        y = clipped(b, u);
        b->x += h * (e + (y - u) / b->Kp);
        b->memory = b->T > 0 ? b->memory + (e - b->memory) * h / (b->T + h) : e;
        return y;
    }
}

/* --- on through time --- */

/* what conditions were at the last instants, the newest last */
typedef struct Past {
    int count;
    double when[3], g[3][WATCHES];
} Past;

static inline bool past_begin(Past *past, Hybrid *h, double at, const Real *y)
{
    static Instant now;

    if (!look(h, y, &now))
        return false;
    for (int i = 0; i < h->watches; i++)
        past->g[0][i] = watched(&h->d.m, &now, &h->watch[i]);
    past->when[0] = at;
    past->count = 1;
    return true;
}

static inline void past_add(Past *past, double at)
{
    if (past->count == 2) {
        memcpy(past->g[0], past->g[1], sizeof past->g[0]);
        memcpy(past->g[1], past->g[2], sizeof past->g[0]);
        past->when[0] = past->when[1];
        past->when[1] = at;
    } else {
        past->when[past->count++] = at;
    }
}

/* whether a parabola through a condition's last values may have gone over and back */
static inline bool may_return(const Past *past, int i, double gone)
{
    const double *when = past->when, before = past->g[0][i], here = past->g[1][i],
                 later = past->g[past->count][i];
    double a, first, second, curve, slope, least;

    if (past->count < 2 || fabs(here) < 1e-9)
        return false;
    a = when[1] - when[0];
    first = (here - before) / a;
    second = (later - here) / gone;
    curve = 2 * (second - first) / (a + gone);
    slope = (first * gone + second * a) / (a + gone);
    least = -slope / curve;
    return least > -a && least < gone &&
           (here + slope * least / 2) * (later > 0 ? 1 : -1) <
               0.05 * fabs(curve) * fmax(a, gone) * fmax(a, gone);
}

/* when a condition changes within a step that leads on to the newest of `past`; INFINITY: it can't
 * be told */
static inline double enclose(Hybrid *h, const Extrapolation *by, const Real *before, double high,
                             const Past *past, int i)
{
    static Instant then;
    const CallMonitor *w = &h->watch[i];
    double low = 0, last = 0, at_low = past->g[past->count - 1][i],
           at_high = past->g[past->count][i];
    Real tried[MOST_STATES];

    if ((at_low > 0) != w->holds || fabs(at_low) < 1e-9)
        return INFINITY;
    for (int k = 0; k < 100 && high - low > 1e-13; k++) {
        const double middle =
            k % 3 == 2 ? (low + high) / 2 : (low * at_high - high * at_low) / (at_high - at_low);
        double there;

        memcpy(tried, before, sizeof tried);
        if (!(extrapolate(by, middle, tried) < 1e-9L) || !look(h, tried, &then))
            return INFINITY;
        there = watched(&h->d.m, &then, w);
        if ((there > 0) == w->holds) {
            at_high /= last < 0 ? 2 : 1;
            low = middle;
            at_low = there;
            last = -1;
        } else {
            at_low /= last > 0 ? 2 : 1;
            high = middle;
            at_high = there;
            last = 1;
        }
    }
    return high;
}

/* Which condition changes first within a step, *soonest after its start; -1: none does; unsure
 * where that can't be determined. An event's that ceases to hold only makes it ready again. */
static inline int first_change(Hybrid *h, const Extrapolation *by, const Real *before, double gone,
                               const Past *past, double *soonest)
{
    int first = -1;

    *soonest = INFINITY;
    for (int i = 0; i < h->watches; i++) {
        const CallMonitor *w = &h->watch[i];
        double when;

        if ((past->g[past->count][i] > 0) == w->holds) {
            h->unsure = h->unsure || may_return(past, i, gone);
            continue;
        }
        if (w->kind == WATCH_EVENT && w->holds)
            continue;
        when = enclose(h, by, before, gone, past, i);
        h->unsure = h->unsure || isinf(when) || fabs(when - *soonest) < 1e-7;
        if (when < *soonest) {
            *soonest = when;
            first = i;
        }
    }
    return first;
}

/* from *at to `to`, where nothing but what is watched jumps; false: it can't be determined */
static inline bool smooth_part(Hybrid *h, double *at, double to, Real *y)
{
    const Extrapolation by = {machine_rates, &h->d.m, machine_size(&h->d.m), 1e-11L};
    static Instant now;
    Real step = 0.01L, before[MOST_STATES];
    Past past = {0};

    for (int tries = 0; *at < to && !h->stopped; tries++) {
        double soonest, gone;
        int first;

        if (tries > 4000 || !(step > 1e-10L))
            return false;
        step = fminl(step, 0.01L);
        memcpy(before, y, sizeof before);
        if (past.count == 0 && !past_begin(&past, h, *at, y))
            return false;
        gone = (double)extrapolated_step(&by, to - *at, &step, y);
        if (gone == 0)
            continue;
        if (!look(h, y, &now))
            return false;
        for (int i = 0; i < h->watches; i++)
            past.g[past.count][i] = watched(&h->d.m, &now, &h->watch[i]);
        first = first_change(h, &by, before, gone, &past, &soonest);
        if (h->unsure)
            return false;
        if (first >= 0) {
            h->unsure = to - *at - soonest < 1e-7;
            memcpy(y, before, sizeof before);
            (void)extrapolate(&by, soonest, y);
            *at += soonest;
            h->last = *at;
            h->watch[first].holds = !h->watch[first].holds;
            if (!happen(h, &h->watch[first], y))
                return false;
            past.count = 0;
            continue;
        }
        *at += gone;
        for (int i = 0; i < h->watches; i++)
            if (h->watch[i].kind == WATCH_EVENT)
                h->watch[i].holds = past.g[past.count][i] > 0;
        past_add(&past, *at);
    }
    return true;
}

/* sets all blocks that are due at an instant */
static inline bool sample_now(Hybrid *h, double at, Real *y)
{
    static Instant now;
    double value[BLOCKS] = {0};
    bool due = false;

    if (!look(h, y, &now))
        return false;
    for (int i = 0; i < h->blocks; i++)
        if (h->block[i].next <= at + 1e-12) {
            value[i] = sampled(&h->block[i], &now);
            due = true;
        }
    for (int i = 0; i < h->blocks; i++)
        if (h->block[i].next <= at + 1e-12) {
            h->d.m.element[h->block[i].element].value = value[i];
            h->block[i].next = h->block[i].period * floor(at / h->block[i].period + 1.5);
        }
    return !due || settle(h, y);
}

/* conditions that are asked from this instant on */
static inline bool begin_asking(Hybrid *h, double at, Real *y)
{
    static Instant now;

    for (int i = 0; i < h->watches; i++) {
        CallMonitor *w = &h->watch[i];

        if (w->kind == WATCH_DIODE || w->signal.after != at)
            continue;
        if (!look(h, y, &now))
            return false;
        now.t = at;
        h->unsure = h->unsure || fabs(watched(&h->d.m, &now, w)) < 1e-7;
        if (watched(&h->d.m, &now, w) > 0) {
            w->holds = true;
            h->last = at;
            if (!happen(h, w, y))
                return false;
        }
    }
    return true;
}

static inline bool hybrid_runs(Hybrid *h, double *at, double to, Real *y)
{
    while (*at < to && !h->stopped) {
        double next = to;

        for (int i = 0; i < h->blocks; i++)
            next = fmin(next, h->block[i].next);
        for (int i = 0; i < h->watches; i++)
            if (h->watch[i].signal.after > *at)
                next = fmin(next, h->watch[i].signal.after);
        if (next > *at && !smooth_part(h, at, next, y))
            return false;
        if (h->stopped)
            return true;
        *at = next;
        if (!begin_asking(h, *at, y))
            return false;
        for (int i = 0; i < h->blocks && !h->stopped; i++)
            if (h->block[i].next <= *at + 1e-12 && !sample_now(h, *at, y))
                return false;
    }
    return true;
}

/* at the start: conditions as they are, the first samples */
static inline bool hybrid_starts(Hybrid *h, Real *y)
{
    static Instant now;

    if (!look(h, y, &now))
        return false;
    for (int i = 0; i < h->watches; i++) {
        CallMonitor *w = &h->watch[i];

        if (w->kind == WATCH_DIODE)
            continue;
        w->holds = watched(&h->d.m, &now, w) > 0;
        if (fabs(watched(&h->d.m, &now, w)) < 1e-4)
            h->unsure = true;
        if (w->kind == WATCH_SWITCH)
            h->d.m.element[w->element].on = w->holds;
        h->stopped = h->stopped || (w->holds && w->stops);
    }
    if (!settle(h, y))
        return false;
    return sample_now(h, 0, y);
}

typedef enum HybridAnswer { HYBRID_ANSWERS, HYBRID_JUMPS, HYBRID_IS_UNSURE } HybridAnswer;

/* All values at `to`, no sooner than *at, where the machine is in state y; both move there.
 * HYBRID_JUMPS: something jumps just before. */
static inline HybridAnswer hybrid_asks(Hybrid *h, double *at, double to, Real *y, Asks *asks)
{
    static Instant now;

    if (to > *at && (!hybrid_runs(h, at, to, y) || h->unsure))
        return HYBRID_IS_UNSURE;
    if (to > 0 && *at - h->last < 1e-5)
        return HYBRID_JUMPS;
    unpack(&h->d.m, y, &now);
    if (!instant_solve(&h->d.m, &now))
        return HYBRID_IS_UNSURE;
    ask_all(&h->d.m, &now, asks);
    return HYBRID_ANSWERS;
}

#endif
