/* machine_tableau.h: what a machine does at an instant: one linear system for all of it, and the
 * rates of a state */
#ifndef COTREE_TESTS_MACHINE_TABLEAU_H
#define COTREE_TESTS_MACHINE_TABLEAU_H

#include "machine.h"

/* --- the linear system of an instant --- */

typedef struct Tableau {
    int n;
    double at[UNKNOWNS][UNKNOWNS + 1];
} Tableau;

/* by elimination with row pivots of rows that are scaled; the solution into the last column */
static inline bool tableau_solve(Tableau *T)
{
    const int n = T->n;
    double scale[UNKNOWNS];

    for (int r = 0; r < n; r++) {
        scale[r] = 0;
        for (int k = 0; k < n; k++)
            scale[r] = fmax(scale[r], fabs(T->at[r][k]));
    }
    for (int c = 0; c < n; c++) {
        int best = c;

        for (int r = c + 1; r < n; r++)
            if (fabs(T->at[r][c]) * scale[best] > fabs(T->at[best][c]) * scale[r])
                best = r;
        if (T->at[best][c] == 0)
            return false;
        if (best != c) {
            const double held = scale[c];

            scale[c] = scale[best];
            scale[best] = held;
            for (int k = c; k <= n; k++) {
                const double number = T->at[c][k];

                T->at[c][k] = T->at[best][k];
                T->at[best][k] = number;
            }
        }
        for (int r = c + 1; r < n; r++) {
            const double factor = T->at[r][c] / T->at[c][c];

            for (int k = c; k <= n && factor != 0; k++)
                T->at[r][k] -= factor * T->at[c][k];
        }
    }
    for (int r = n - 1; r >= 0; r--) {
        for (int k = r + 1; k < n; k++)
            T->at[r][n] -= T->at[r][k] * T->at[k][n];
        T->at[r][n] /= T->at[r][r];
    }
    return true;
}

/* what a row's effort does to both bodies: into column c, the last for a number that is known */
static inline void act(Tableau *T, const Row *row, int c, double factor)
{
    const double sign = c == T->n ? 1 : -1;

    for (int b = 0; b < 2; b++)
        for (int k = 0; k < 3 && row->body[b] >= 0; k++) {
            T->at[6 * row->body[b] + k][c] += sign * factor * row->linear[b].at[k];
            T->at[6 * row->body[b] + 3 + k][c] += sign * factor * row->angular[b].at[k];
        }
}

/* the second derivative of a row into equation r, times a factor */
static inline void differentiate(Tableau *T, const Row *row, int r, double factor)
{
    for (int b = 0; b < 2; b++)
        for (int k = 0; k < 3 && row->body[b] >= 0; k++) {
            T->at[r][6 * row->body[b] + k] += factor * row->linear[b].at[k];
            T->at[r][6 * row->body[b] + 3 + k] += factor * row->angular[b].at[k];
        }
    T->at[r][T->n] -= factor * row->bias;
}

/* an inertia c along a coordinate */
static inline void add_rotor(Tableau *T, const Row *row, double c)
{
    for (int b = 0; b < 2; b++)
        for (int k = 0; k < 6 && row->body[b] >= 0; k++) {
            const double mine = k < 3 ? row->linear[b].at[k] : row->angular[b].at[k - 3];

            if (mine != 0)
                differentiate(T, row, 6 * row->body[b] + k, c * mine);
        }
}

static inline void add_bodies(const Machine *m, const Instant *now, Tableau *T)
{
    for (int b = 0; b < m->bodies; b++) {
        const double *I = m->inertia[b];
        const Turn own = {{{I[0], I[3], I[4]}, {I[3], I[1], I[5]}, {I[4], I[5], I[2]}}};
        const Turn back = transposed(&now->R[b]), half = turns(&now->R[b], &own),
                   whole = turns(&half, &back);
        const Vector bias = cross(now->w[b], turn(&whole, now->w[b]));

        for (int k = 0; k < 3; k++) {
            const bool shift_held = m->planar && k == 2, turn_held = m->planar && k != 2;

            T->at[6 * b + k][6 * b + k] = shift_held ? 1 : m->mass[b];
            T->at[6 * b + k][T->n] = shift_held ? 0 : m->mass[b] * m->gravity.at[k];
            for (int i = 0; i < 3; i++)
                T->at[6 * b + 3 + k][6 * b + 3 + i] =
                    m->planar ? (i == k ? turn_held ? 1 : I[2] : 0) : whole.at[k][i];
            T->at[6 * b + 3 + k][T->n] = m->planar ? 0 : -bias.at[k];
        }
    }
}

static inline Row line_row(const Machine *m, const Instant *now, const Load *load, double *length)
{
    const Stand t = stand(m, now, load->other), h = stand(m, now, load->place);
    Vector d = add(h.p, -1, t.p);

    *length = sqrt(dot(d, d));
    d = add(vec(0, 0, 0), 1 / *length, d);
    return way_row(&t, &h, d, vec(0, 0, 0));
}

static inline void add_loads(const Machine *m, Instant *now, Tableau *T)
{
    for (int l = 0; l < m->loads; l++) {
        const Load *load = &m->load[l];
        double length;
        Row row;

        if (load->kind == LINE) {
            row = line_row(m, now, load, &length);
            now->load[l] = -load->k * (length - load->rest) - load->d * row.rate +
                           wave(&load->wave[0], now->t);
        } else if (load->kind == ALONG) {
            row = coordinate_row(m, now, load->place);
            now->load[l] = -load->k * (now->q[load->place] - load->rest) - load->d * row.rate +
                           wave(&load->wave[0], now->t);
        } else {
            const Stand at = stand(m, now, load->place);
            Vector f;

            for (int k = 0; k < 3; k++)
                f.at[k] = wave(&load->wave[k], now->t);
            if (load->own_axes)
                f = turn(&at.R, f);
            f = add(f, -load->drag, at.v);
            row = (Row){.body = {-1, at.body}};
            if (load->kind == PUSH) {
                row.linear[1] = f;
                row.angular[1] = cross(at.rho, f);
            } else {
                row.angular[1] = f;
            }
            now->load[l] = 1;
        }
        act(T, &row, T->n, now->load[l]);
    }
}

/* --- networks --- */

/* columns of the tableau: twists' rates, multipliers, potentials, currents, other currents, rates
 * of states */
typedef struct Columns {
    int potential, current, other, dz;
} Columns;

/* factor times the voltage between two nodes, into equation r */
static inline void voltage(Tableau *T, const Columns *c, int r, int p, int m, double factor)
{
    if (p > 0)
        T->at[r][c->potential + p - 1] += factor;
    if (m > 0)
        T->at[r][c->potential + m - 1] -= factor;
}

static inline void kirchhoff(Tableau *T, const Columns *c, int p, int m, int column)
{
    if (p > 0)
        T->at[c->potential + p - 1][column] += 1;
    if (m > 0)
        T->at[c->potential + m - 1][column] -= 1;
}

/* the law of capacity or inductance at a coordinate, and its slope */
static inline double law(const Element *e, double s, double *slope)
{
    *slope = e->value * e->bend * e->pace * cos(e->pace * s);
    return e->value * (1 + e->bend * sin(e->pace * s));
}

/* what a controller gives, and the rates of its states into dz */
static inline double controlled(const Element *e, Instant *now, Tableau *T, const Columns *c, int r)
{
    const double error = wave(&e->wave, now->t) - now->q[e->coordinate];
    const double error_rate = wave_rate(&e->wave, now->t) - now->rate[e->coordinate];
    const int n = T->n;
    double y, u, rate = error_rate;
    int next = r + 1;

    if (e->kind == LAG) {
        T->at[next][c->dz + e->state] = 1;
        T->at[next][n] = (e->K * now->q[e->coordinate] - now->z[e->state]) / e->T;
        u = now->z[e->state];
        return e->limited ? fmin(fmax(u, e->low), e->high) : u;
    }
    if (e->T > 0) {
        rate = (error - now->z[e->more]) / e->T;
        T->at[next][c->dz + e->more] = 1;
        T->at[next++][n] = rate;
    }
    u = e->Kp * error + e->Kd * rate + (e->kind == PID ? e->Ki * now->z[e->state] : 0);
    y = e->limited ? fmin(fmax(u, e->low), e->high) : u;
    if (e->kind == PID) {
        T->at[next][c->dz + e->state] = 1;
        T->at[next][n] = error + (y - u) / e->Kp;
    }
    return y;
}

/* how many equations an element brings */
static inline int element_rows(const Element *e)
{
    const bool two = e->kind == WINDINGS || e->kind == GYRATOR;

    return 1 + (two ? 1 : 0) + (e->state >= 0 && e->first ? 1 : 0) + (e->more >= 0 ? 1 : 0);
}

static inline void add_transducer(const Machine *m, Instant *now, const Element *e, int number,
                                  Tableau *T, const Columns *c, int r)
{
    const Row row = coordinate_row(m, now, e->coordinate);
    const double s = now->q[e->coordinate], z = e->state >= 0 ? now->z[e->state] : 0;
    const int i = c->current + number, n = T->n;
    double slope = 0, value;

    switch (e->kind) {
    case MOTOR:
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][i] -= e->R;
        T->at[r][n] += e->Kv * e->ratio * row.rate;
        if (e->state >= 0) {
            T->at[r][c->dz + e->state] -= e->L;
            T->at[r + 1][i] = 1;
            T->at[r + 1][n] = z;
        }
        act(T, &row, i, e->ratio * e->K);
        act(T, &row, n, -e->ratio * e->ratio * e->B * row.rate);
        add_rotor(T, &row, e->ratio * e->ratio * e->J);
        break;
    case COIL:
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][i] -= e->R;
        value = e->K * (1 + e->bend * sin(e->pace * s));
        T->at[r][n] += value * row.rate;
        if (e->state >= 0) {
            T->at[r][c->dz + e->state] -= e->L;
            T->at[r + 1][i] = 1;
            T->at[r + 1][n] = z;
        }
        act(T, &row, i, value);
        break;
    case PISTON:
        T->at[r][i] = 1;
        T->at[r][n] = e->K * row.rate;
        for (int side = 0; side < 2; side++) {
            const int node = side == 0 ? e->p : e->m;

            if (node > 0)
                act(T, &row, c->potential + node - 1, side == 0 ? e->K : -e->K);
        }
        break;
    case PLATE:
    case PIEZO:
        value = e->kind == PIEZO ? e->value : law(e, s, &slope);
        T->at[r][i] = 1;
        T->at[r][c->dz + e->state] = -value;
        T->at[r][n] = (e->kind == PIEZO ? e->d * e->k : slope * z) * row.rate;
        act(T, &row, n, e->kind == PIEZO ? e->k * (e->d * z - (s - e->rest)) : slope * z * z / 2);
        if (e->first) {
            voltage(T, c, r + 1, e->p, e->m, 1);
            T->at[r + 1][n] = z;
        }
        break;
    case WHEEL_ON_END:
        T->at[r][i] = 1;
        differentiate(T, &row, r, -e->J);
        break;
    default: /* a solenoid */
        value = law(e, s, &slope);
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][i] -= e->R;
        T->at[r][c->dz + e->state] -= value;
        T->at[r][n] = slope * z * row.rate;
        T->at[r + 1][i] = 1;
        T->at[r + 1][n] = z;
        act(T, &row, n, slope * z * z / 2);
        break;
    }
}

/* the law of a switch or a diode, on the side that it is on */
static inline void add_valve(const Element *e, Tableau *T, const Columns *c, int r, int i)
{
    if (!e->on && e->high == 0) {
        T->at[r][i] = 1;
        return;
    }
    voltage(T, c, r, e->p, e->m, 1);
    T->at[r][i] = e->on ? -e->low : -e->high;
    if (e->on)
        T->at[r][T->n] = e->rest - (e->high > 0 ? e->low * e->rest / e->high : 0);
}

static inline void add_element(const Machine *m, Instant *now, int number, Tableau *T,
                               const Columns *c, int r)
{
    const Element *e = &m->element[number];
    const int i = c->current + number, j = c->other + number, n = T->n;

    kirchhoff(T, c, e->p, e->m, i);
    switch (e->kind) {
    case RESISTANCE:
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][i] = -e->value;
        break;
    case CAPACITY:
        T->at[r][i] = 1;
        T->at[r][c->dz + e->state] = -e->value;
        if (e->first) {
            voltage(T, c, r + 1, e->p, e->m, 1);
            T->at[r + 1][n] = now->z[e->state];
        }
        break;
    case INERTANCE:
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][c->dz + e->state] = -e->value;
        T->at[r + 1][i] = 1;
        T->at[r + 1][n] = now->z[e->state];
        break;
    case SPRING_DAMPER:
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][c->dz + e->state] = -1;
        T->at[r + 1][i] = 1;
        voltage(T, c, r + 1, e->p, e->m, -e->d);
        T->at[r + 1][n] = e->k * now->z[e->state];
        break;
    case ACROSS:
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][n] = wave(&e->wave, now->t);
        break;
    case THROUGH:
        T->at[r][i] = 1;
        T->at[r][n] = wave(&e->wave, now->t);
        break;
    case PD:
    case PID:
    case LAG:
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][n] = controlled(e, now, T, c, r);
        break;
    case HELD:
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][n] = e->value;
        break;
    case SWITCH:
    case DIODE:
        add_valve(e, T, c, r, i);
        break;
    case AMPLIFIER:
        voltage(T, c, r, e->p, e->m, 1);
        voltage(T, c, r, e->c, 0, -e->K);
        break;
    case WINDINGS:
        kirchhoff(T, c, e->c, e->e, j);
        voltage(T, c, r, e->p, e->m, 1);
        voltage(T, c, r, e->c, e->e, -e->K);
        T->at[r + 1][j] = 1;
        T->at[r + 1][i] = e->K;
        break;
    case GYRATOR: /* v1 = r i2, v2 = -r i1 */
        kirchhoff(T, c, e->c, e->e, j);
        voltage(T, c, r, e->p, e->m, 1);
        T->at[r][j] = -e->K;
        voltage(T, c, r + 1, e->c, e->e, 1);
        T->at[r + 1][i] = e->K;
        break;
    default:
        add_transducer(m, now, e, number, T, c, r);
        break;
    }
}

/* --- an instant --- */

static inline void unpack(const Machine *m, const Real *y, Instant *now)
{
    for (int b = 0; b < m->bodies; b++) {
        const Real *at = y + 13 * b;
        double q[4], length = 0;

        for (int k = 0; k < 4; k++)
            length += (double)(at[3 + k] * at[3 + k]);
        for (int k = 0; k < 4; k++)
            q[k] = (double)at[3 + k] / sqrt(length);
        for (int k = 0; k < 3; k++) {
            now->p[b].at[k] = (double)at[k];
            now->v[b].at[k] = (double)at[7 + k];
            now->w[b].at[k] = (double)at[10 + k];
        }
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;

            now->R[b].at[i][i] = 1 - 2 * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k]);
            now->R[b].at[i][j] = 2 * (q[1 + i] * q[1 + j] - q[0] * q[1 + k]);
            now->R[b].at[j][i] = 2 * (q[1 + i] * q[1 + j] + q[0] * q[1 + k]);
        }
    }
    y += 13 * m->bodies;
    for (int i = 0; i < m->coordinates; i++)
        now->q[i] = (double)y[i];
    y += m->coordinates;
    for (int i = 0; i < m->states; i++)
        now->z[i] = (double)y[i];
    now->t = (double)y[m->states];
}

/* the rows that joints hold at an instant */
typedef struct Held {
    Row row[HINGES][6];
    int count[HINGES], ways[HINGES], all;
} Held;

static inline void find_held(const Machine *m, const Instant *now, Held *held)
{
    held->all = 0;
    for (int j = 0; j < m->hinges; j++) {
        held->count[j] = hinge_rows(m, now, &m->hinge[j], held->row[j], &held->ways[j]);
        held->all += held->count[j];
    }
}

/* false: there are not as many equations as unknowns */
static inline bool assemble(const Machine *m, Instant *now, const Held *held, const Columns *c,
                            Tableau *T)
{
    int r = 6 * m->bodies;

    for (int i = 0; i < T->n; i++)
        memset(T->at[i], 0, (size_t)(T->n + 1) * sizeof(double));
    add_bodies(m, now, T);
    add_loads(m, now, T);
    for (int j = 0; j < m->hinges; j++)
        for (int k = 0; k < held->count[j]; k++, r++) {
            act(T, &held->row[j][k], r, 1);
            differentiate(T, &held->row[j][k], r, 1);
        }
    r = c->current;
    for (int i = 0; i < m->elements; i++) {
        const Element *e = &m->element[i];

        add_element(m, now, i, T, c, r);
        r += element_rows(e);
        if (e->kind != WINDINGS && e->kind != GYRATOR)
            T->at[r++][c->other + i] = 1;
    }
    return r == T->n;
}

/* on the tip, from the multipliers */
static inline void take_reactions(const Machine *m, Instant *now, const Held *held,
                                  const Tableau *T)
{
    int r = 6 * m->bodies;

    for (int j = 0; j < m->hinges; j++) {
        const double tie = -m->hinge[j].pitch / (2 * acos(-1));

        now->force[j] = now->moment[j] = vec(0, 0, 0);
        for (int k = 0; k < held->count[j]; k++, r++) {
            const Row *row = &held->row[j][k];
            const double lambda = T->at[r][T->n];

            now->force[j] = add(now->force[j], lambda, row->linear[1]);
            if (k >= held->ways[j])
                now->moment[j] = add(now->moment[j], lambda, row->angular[1]);
            else if (m->hinge[j].kind == SCREW && k == held->ways[j] - 1)
                now->moment[j] = add(now->moment[j], lambda * tie, row->linear[1]);
        }
    }
}

static inline void take_solution(const Machine *m, Instant *now, const Columns *c, const Tableau *T)
{
    for (int b = 0; b < m->bodies; b++)
        for (int k = 0; k < 3; k++) {
            now->a[b].at[k] = T->at[6 * b + k][T->n];
            now->alpha[b].at[k] = T->at[6 * b + 3 + k][T->n];
        }
    for (int i = 1; i < m->nodes; i++)
        now->potential[i] = T->at[c->potential + i - 1][T->n];
    for (int i = 0; i < m->elements; i++) {
        now->current[i] = T->at[c->current + i][T->n];
        now->other[i] = T->at[c->other + i][T->n];
    }
    for (int i = 0; i < m->states; i++)
        now->dz[i] = T->at[c->dz + i][T->n];
    for (int i = 0; i < m->coordinates; i++) {
        const Row row = coordinate_row(m, now, i);

        now->second[i] = row.bias;
        for (int b = 0; b < 2; b++)
            if (row.body[b] >= 0)
                now->second[i] += dot(row.linear[b], now->a[row.body[b]]) +
                                  dot(row.angular[b], now->alpha[row.body[b]]);
    }
}

/* accelerations, multipliers, potentials, currents of an instant whose state is in `now` */
static inline bool instant_solve(const Machine *m, Instant *now)
{
    static Tableau T;
    static Held held;
    Columns c;

    find_held(m, now, &held);
    c.potential = 6 * m->bodies + held.all;
    c.current = c.potential + m->nodes - 1;
    c.other = c.current + m->elements;
    c.dz = c.other + m->elements;
    T.n = c.dz + m->states;
    for (int i = 0; i < m->coordinates; i++)
        now->rate[i] = coordinate_row(m, now, i).rate;
    if (!assemble(m, now, &held, &c, &T) || !tableau_solve(&T))
        return false;
    take_reactions(m, now, &held, &T);
    take_solution(m, now, &c, &T);
    return true;
}

static inline int machine_size(const Machine *m)
{
    return 13 * m->bodies + m->coordinates + m->states + 1;
}

static inline void machine_rates(const void *context, const Real *y, Real *rates)
{
    const Machine *m = context;
    static Instant now;

    unpack(m, y, &now);
    if (!instant_solve(m, &now)) {
        for (int i = 0; i < machine_size(m); i++)
            rates[i] = NAN;
        return;
    }
    for (int b = 0; b < m->bodies; b++) {
        const Real *q = y + 13 * b + 3;
        const double *w = now.w[b].at;
        Real *out = rates + 13 * b;

        for (int k = 0; k < 3; k++) {
            out[k] = y[13 * b + 7 + k];
            out[7 + k] = now.a[b].at[k];
            out[10 + k] = now.alpha[b].at[k];
        }
        /* w in ground axes: q' = 1/2 (0, w) q */
        out[3] = -(w[0] * q[1] + w[1] * q[2] + w[2] * q[3]) / 2;
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;

            out[4 + k] = (w[k] * q[0] + w[i] * q[1 + j] - w[j] * q[1 + i]) / 2;
        }
    }
    rates += 13 * m->bodies;
    for (int i = 0; i < m->coordinates; i++)
        *rates++ = now.rate[i];
    for (int i = 0; i < m->states; i++)
        *rates++ = now.dz[i];
    *rates = 1;
}

#endif
