/* machine_slopes.h: how a machine deviates from an instant: differences of the oracle's answers
 *
 * States are told by names, as `linearize` does. Joints are moved until what the names say deviates
 * by a little and loops are closed, by Newton's method; speeds after them. */
#ifndef COTREE_TESTS_MACHINE_SLOPES_H
#define COTREE_TESTS_MACHINE_SLOPES_H

#include "machine_whole.h"

enum { MOVES = 3 * HINGES, INPUTS = 4, OUTPUTS = 8, COLUMNS = STATES + INPUTS };

/* what a name says: of a position, or of a speed */
typedef enum StateKind {
    OF_COORDINATE,
    OF_PLACE,
    OF_BODY_TURN,
    OF_JOINT_TURN,
    OF_PIN,
    OF_STORE
} StateKind;

typedef struct StateName {
    StateKind kind;
    int of, axis;
    bool is_speed;
    char name[32];
} StateName;

typedef struct SlopeInput {
    double *number; /* of the machine */
    double sign, step;
    char name[16];
} SlopeInput;

typedef struct Slopes {
    Drawn *d;
    double t, z[2 * ELEMENTS];
    Instant base;
    int states, freedoms, inputs, outputs;
    StateName state[STATES];
    SlopeInput input[INPUTS];
    int output[OUTPUTS]; /* of those that ask_all() asks */
    double step[COLUMNS], base_rate[STATES];
    /* rates of the states, then outputs: by states, then inputs; gap: how far differences of two
     * orders are apart; size: what is differentiated */
    double by[STATES + OUTPUTS][COLUMNS], gap[STATES + OUTPUTS][COLUMNS], size[STATES + OUTPUTS];
} Slopes;

/* --- what a name says --- */

/* the small turn that R is */
static inline Vector turn_vector(const Turn *R)
{
    const Vector s = vec((R->at[2][1] - R->at[1][2]) / 2, (R->at[0][2] - R->at[2][0]) / 2,
                         (R->at[1][0] - R->at[0][1]) / 2);
    const double sine = sqrt(dot(s, s));

    return sine < 1e-9 ? s : add(vec(0, 0, 0), asin(sine) / sine, s);
}

static inline Turn joint_attitude(const Machine *m, const Instant *now, int hinge)
{
    const Stand t = stand(m, now, m->hinge[hinge].tail), h = stand(m, now, m->hinge[hinge].tip);
    const Turn back = transposed(&t.R);

    return turns(&back, &h.R);
}

static inline Vector turned(const Turn *from, const Turn *to)
{
    const Turn back = transposed(from), R = turns(&back, to);

    return turn_vector(&R);
}

static inline double position_of(const Slopes *s, const StateName *n, const Instant *now)
{
    const Machine *m = &s->d->m;
    Turn from, to;

    switch (n->kind) {
    case OF_COORDINATE:
        return now->q[n->of] - s->base.q[n->of];
    case OF_PLACE:
        return now->p[n->of].at[n->axis] - s->base.p[n->of].at[n->axis];
    case OF_BODY_TURN:
        return turned(&s->base.R[n->of], &now->R[n->of]).at[n->axis];
    default:
        from = joint_attitude(m, &s->base, n->of);
        to = joint_attitude(m, now, n->of);
        if (n->kind == OF_PIN)
            return dot(m->hinge[n->of].axis[0], turned(&from, &to));
        return turned(&from, &to).at[n->axis];
    }
}

/* order 1: the speed; 2: its rate, of an instant that is solved */
static inline double rate_of(const Machine *m, const StateName *n, const Instant *now, int order)
{
    const bool second = order == 2;

    switch (n->kind) {
    case OF_COORDINATE:
        return second ? now->second[n->of] : coordinate_row(m, now, n->of).rate;
    case OF_PLACE:
        return (second ? now->a : now->v)[n->of].at[n->axis];
    case OF_BODY_TURN:
        return turn_back(&now->R[n->of], (second ? now->alpha : now->w)[n->of]).at[n->axis];
    default: {
        const Hinge *j = &m->hinge[n->of];
        const Stand t = stand(m, now, j->tail), h = stand(m, now, j->tip);
        const Vector none = vec(0, 0, 0);
        const Vector at = t.body >= 0 ? now->alpha[t.body] : none;
        const Vector ah = h.body >= 0 ? now->alpha[h.body] : none;
        const Vector w = second ? add(add(ah, -1, at), 1, cross(h.w, t.w)) : add(h.w, -1, t.w);
        const Vector own = turn_back(&h.R, w);

        return n->kind == OF_PIN ? dot(j->axis[0], own) : own.at[n->axis];
    }
    }
}

/* --- states by their names --- */

static inline bool store_name(const Machine *m, int element, bool more, char name[32])
{
    static const char *const effort[] = {"v", "w", "v", "p"};
    static const char *const flow[] = {"i", "torque", "force", "flow"};
    const Element *e = &m->element[element];
    const int domain = m->node_domain[e->p];
    const char *member = flow[domain];

    if (more ? e->more < 0 : e->state < 0)
        return false;
    if (more)
        member = "filtered";
    else if (e->kind == LAG)
        member = "x";
    else if (e->kind == PID)
        member = "integral";
    else if (e->kind == SPRING_DAMPER)
        member = domain == SLIDE ? "deflection" : "twist";
    else if (e->kind == CAPACITY || e->kind == PLATE || e->kind == PIEZO)
        member = effort[domain];
    (void)snprintf(name, 32, "%s.%s", e->name, member);
    return true;
}

static inline bool is_store(const Machine *m, StateName *n)
{
    char name[32];

    for (int i = 0; i < m->elements; i++)
        for (int more = 0; more < 2; more++)
            if (store_name(m, i, more, name) && strcmp(name, n->name) == 0) {
                n->kind = OF_STORE;
                n->of = more ? m->element[i].more : m->element[i].state;
                return true;
            }
    return false;
}

static inline bool is_mechanical(const Machine *m, StateName *n)
{
    char bare[32], what[32];
    size_t length;
    int number;

    (void)snprintf(bare, sizeof bare, "%s", n->name);
    length = strlen(bare);
    n->is_speed = length > 0 && bare[length - 1] == '\'';
    if (n->is_speed)
        bare[length - 1] = '\0';
    for (int c = 0; c < m->coordinates; c++)
        if (strcmp(m->coordinate[c].name, bare) == 0) {
            n->kind = OF_COORDINATE;
            n->of = c;
            return true;
        }
    if (sscanf(bare, "j%d%31s", &number, what) == 1) {
        n->kind = OF_PIN;
        n->of = number;
        return number < m->hinges;
    }
    n->of = number;
    if (sscanf(bare, "b%d.%31s", &n->of, what) != 2 && sscanf(bare, "j%d.%31s", &n->of, what) != 2)
        return false;
    n->kind = bare[0] == 'b' ? OF_BODY_TURN : OF_JOINT_TURN;
    length = strlen(what);
    n->axis = what[length - 1] == 'a' ? 2 : what[length - 1] - (what[length - 1] < 'a' ? 'X' : 'x');
    if (strcmp(what, "theta") == 0 || strncmp(what, "turn", 4) == 0)
        return true;
    if (what[0] == 'W' && length == 2) {
        n->is_speed = true;
        return true;
    }
    n->kind = OF_PLACE;
    return bare[0] == 'b' && length == 1;
}

/* --- a point beside the base --- */

/* solves n equations; the right sides in column n */
static inline bool eliminate(int n, double a[MOVES][MOVES + 1])
{
    for (int c = 0; c < n; c++) {
        int best = c;

        for (int r = c + 1; r < n; r++)
            best = fabs(a[r][c]) > fabs(a[best][c]) ? r : best;
        if (fabs(a[best][c]) < 1e-9)
            return false;
        for (int k = 0; k <= n; k++) {
            const double held = a[c][k];

            a[c][k] = a[best][k];
            a[best][k] = held;
        }
        for (int r = 0; r < n; r++)
            for (int k = n; k >= c && r != c; k--)
                a[r][k] -= a[r][c] / a[c][c] * a[c][k];
    }
    for (int r = 0; r < n; r++)
        a[r][n] /= a[r][r];
    return true;
}

static inline int all_moves(const Machine *m)
{
    int count = 0;

    for (int j = 0; j < m->bodies; j++)
        count += rates_of(&m->hinge[j]);
    return count;
}

static inline void move_joint(Drawn *d, int move, double by)
{
    for (int j = 0; j < d->m.bodies; move -= rates_of(&d->m.hinge[j++])) {
        double *q = d->q[j];

        if (move >= rates_of(&d->m.hinge[j]))
            continue;
        if (d->m.hinge[j].kind != SPHERICAL) {
            q[move] += by;
        } else {
            const double c = cos(by / 2), s = sin(by / 2), a = q[0], v[3] = {q[1], q[2], q[3]};
            const int i = (move + 1) % 3, k = (move + 2) % 3;

            q[0] = c * a - s * v[move];
            q[1 + move] = c * v[move] + s * a;
            q[1 + i] = c * v[i] + s * v[k];
            q[1 + k] = c * v[k] - s * v[i];
        }
        return;
    }
}

static inline double *joint_rate(Drawn *d, int move)
{
    int j = 0;

    for (; move >= rates_of(&d->m.hinge[j]); j++)
        move -= rates_of(&d->m.hinge[j]);
    return &d->rate[j][move];
}

static inline void stand_there(Drawn *d, Instant *now)
{
    const Machine *m = &d->m;

    set_out(d, now);
    for (int c = 0; c < m->coordinates; c++)
        now->q[c] = d->q[m->coordinate[c].hinge][c - m->hinge[m->coordinate[c].hinge].coordinate];
}

/* what is wanted of positions, less what there is, and how far loops are open; order 1: of speeds.
 * How many there are. */
static inline int misses(const Slopes *s, const Instant *now, const double *wanted, int order,
                         double *miss)
{
    const Machine *m = &s->d->m;
    int n = 0;

    for (int i = 0; i < s->states; i++)
        if (s->state[i].kind != OF_STORE && s->state[i].is_speed == (order == 1))
            miss[n++] = wanted[i] - (order == 1 ? rate_of(m, &s->state[i], now, 1)
                                                : position_of(s, &s->state[i], now));
    for (int j = m->bodies; j < m->hinges; j++) {
        const Stand t = stand(m, now, m->hinge[j].tail), h = stand(m, now, m->hinge[j].tip);
        const Vector way = order == 1 ? add(t.v, -1, h.v) : add(t.p, -1, h.p);

        for (int k = 0; k < (m->planar ? 2 : 3); k++)
            miss[n++] = way.at[k];
    }
    return n;
}

/* joints so that states are as wanted; false: they don't determine where things are */
static inline bool join(Slopes *s, const double *wanted, Instant *now)
{
    const int n = all_moves(&s->d->m);
    double miss[MOVES + STATES], moved[MOVES + STATES], a[MOVES][MOVES + 1];

    for (int sweep = 0; sweep < 7; sweep++) {
        stand_there(s->d, now);
        if (misses(s, now, wanted, 0, miss) != n)
            return false;
        for (int c = 0; c < n; c++) {
            const double little = 1e-6;

            move_joint(s->d, c, little);
            stand_there(s->d, now);
            (void)misses(s, now, wanted, 0, moved);
            move_joint(s->d, c, -little);
            for (int r = 0; r < n; r++)
                a[r][c] = (miss[r] - moved[r]) / little;
        }
        for (int r = 0; r < n; r++)
            a[r][n] = miss[r];
        if (!eliminate(n, a))
            return false;
        for (int c = 0; c < n; c++)
            move_joint(s->d, c, a[c][n]);
    }
    for (int c = 0; c < n; c++)
        *joint_rate(s->d, c) = 0;
    stand_there(s->d, now);
    (void)misses(s, now, wanted, 1, miss);
    for (int c = 0; c < n; c++) {
        *joint_rate(s->d, c) = 1;
        stand_there(s->d, now);
        (void)misses(s, now, wanted, 1, moved);
        *joint_rate(s->d, c) = 0;
        for (int r = 0; r < n; r++)
            a[r][c] = miss[r] - moved[r];
    }
    for (int r = 0; r < n; r++)
        a[r][n] = miss[r];
    if (!eliminate(n, a))
        return false;
    for (int c = 0; c < n; c++)
        *joint_rate(s->d, c) = a[c][n];
    stand_there(s->d, now);
    return true;
}

/* how fast a position deviates: a turn phi about the axes of W goes by dW - W x phi */
static inline double deviation_rate(const Slopes *s, int state, const Instant *now)
{
    const Machine *m = &s->d->m;
    const StateName *n = &s->state[state];
    double rate = rate_of(m, n, now, 1) - s->base_rate[state];

    for (int k = 1; k < 3 && (n->kind == OF_BODY_TURN || n->kind == OF_JOINT_TURN); k++) {
        StateName turn = *n, speed = *n;

        turn.axis = (n->axis + 3 - k) % 3;
        speed.axis = (n->axis + k) % 3;
        rate -= (k == 1 ? 1 : -1) * rate_of(m, &speed, &s->base, 1) * position_of(s, &turn, now);
    }
    return rate;
}

/* rates of the states and outputs where states and inputs deviate by x */
static inline bool answers(Slopes *s, const double *x, double *out)
{
    Machine *m = &s->d->m;
    static Instant now;
    static Asks asks;
    double wanted[STATES], held[INPUTS] = {0};
    const Drawn *d = s->d;
    double q[HINGES][4], rate[HINGES][3];
    bool is_solved;

    memcpy(q, d->q, sizeof q);
    memcpy(rate, d->rate, sizeof rate);
    now.t = s->t;
    memcpy(now.z, s->z, sizeof now.z);
    for (int i = 0; i < s->states; i++) {
        const StateName *n = &s->state[i];

        wanted[i] = x[i] + (n->is_speed ? s->base_rate[i] : 0);
        if (n->kind == OF_STORE)
            now.z[n->of] += x[i];
    }
    for (int i = 0; i < s->inputs; i++) {
        held[i] = *s->input[i].number;
        *s->input[i].number += s->input[i].sign * x[s->states + i];
    }
    is_solved = join(s, wanted, &now) && instant_solve(m, &now);
    for (int i = 0; is_solved && i < s->states; i++) {
        const StateName *n = &s->state[i];

        out[i] = n->kind == OF_STORE ? now.dz[n->of]
                 : n->is_speed       ? rate_of(m, n, &now, 2)
                                     : deviation_rate(s, i, &now);
    }
    asks.count = 0;
    if (is_solved)
        ask_all(m, &now, &asks);
    for (int i = 0; is_solved && i < s->outputs; i++)
        out[s->states + i] = asks.ask[s->output[i]].wanted;
    for (int i = 0; i < s->inputs; i++)
        *s->input[i].number = held[i];
    memcpy(s->d->q, q, sizeof q);
    memcpy(s->d->rate, rate, sizeof rate);
    return is_solved;
}

/* all slopes about the base; false: the oracle doesn't tell */
static inline bool slopes_find(Slopes *s)
{
    static double out[5][STATES + OUTPUTS];
    double x[COLUMNS] = {0};
    const int rows = s->states + s->outputs;

    memset(s->by, 0, sizeof s->by);
    memset(s->gap, 0, sizeof s->gap);
    for (int i = 0; i < s->states; i++)
        s->base_rate[i] =
            s->state[i].kind == OF_STORE ? 0 : rate_of(&s->d->m, &s->state[i], &s->base, 1);
    if (!answers(s, x, s->size))
        return false;
    for (int c = 0; c < s->states + s->inputs; c++) {
        const double h = s->step[c];

        for (int k = -2; k <= 2; k++) {
            x[c] = k * h;
            if (k != 0 && !answers(s, x, out[k + 2]))
                return false;
        }
        x[c] = 0;
        for (int r = 0; r < rows; r++) {
            const double near = (out[3][r] - out[1][r]) / (2 * h),
                         far = (out[4][r] - out[0][r]) / (4 * h);

            s->by[r][c] = (4 * near - far) / 3;
            s->gap[r][c] = fabs(near - far);
        }
    }
    return true;
}

#endif
