/* machine_whole.h: machines drawn whole, as statements and for the oracle; what is told of them
 * held against it */
#ifndef COTREE_TESTS_MACHINE_WHOLE_H
#define COTREE_TESTS_MACHINE_WHOLE_H

#include "../unit/session_kit.h"
#include "machine_networks.h"

/* --- the start --- */

static inline void quaternion(const Turn *R, Real q[4])
{
    const double trace = R->at[0][0] + R->at[1][1] + R->at[2][2];
    int big = -1;
    double best = trace;

    for (int k = 0; k < 3; k++)
        if (R->at[k][k] > best) {
            best = R->at[k][k];
            big = k;
        }
    if (big < 0) {
        q[0] = sqrt(1 + trace) / 2;
        for (int k = 0; k < 3; k++) {
            const int i = (k + 1) % 3, j = (k + 2) % 3;

            q[1 + k] = (R->at[j][i] - R->at[i][j]) / (4 * q[0]);
        }
        return;
    }
    const int i = (big + 1) % 3, j = (big + 2) % 3;

    q[1 + big] = sqrt(1 + R->at[big][big] - R->at[i][i] - R->at[j][j]) / 2;
    q[0] = (R->at[j][i] - R->at[i][j]) / (4 * q[1 + big]);
    q[1 + i] = (R->at[big][i] + R->at[i][big]) / (4 * q[1 + big]);
    q[1 + j] = (R->at[big][j] + R->at[j][big]) / (4 * q[1 + big]);
}

static inline void write_start(Drawn *d)
{
    const Machine *m = &d->m;
    static Instant now;
    Real *y = d->y, states[2 * ELEMENTS] = {0};

    for (int i = 0; i < m->states; i++)
        states[i] = d->y[13 * BODIES + TURNS + i];
    set_out(d, &now);
    for (int b = 0; b < m->bodies; b++) {
        quaternion(&now.R[b], y + 13 * b + 3);
        for (int k = 0; k < 3; k++) {
            y[13 * b + k] = now.p[b].at[k];
            y[13 * b + 7 + k] = now.v[b].at[k];
            y[13 * b + 10 + k] = now.w[b].at[k];
        }
    }
    y += 13 * m->bodies;
    for (int i = 0; i < m->coordinates; i++) {
        const Coordinate *c = &m->coordinate[i];
        const Hinge *j = &m->hinge[c->hinge];
        const int k = i - j->coordinate;

        *y++ = d->q[c->hinge][k];
        if (!driven)
            write_line(&d->script, "init %s = %.17g, %s' = %.17g", c->name, d->q[c->hinge][k],
                       c->name, d->rate[c->hinge][k]);
    }
    for (int j = 0; j < m->bodies; j++)
        if (m->hinge[j].kind == SPHERICAL) {
            for (int k = 0; k < 4; k++)
                write_line(&d->script, "init j%d.q%d = %.17g", j, k, d->q[j][k]);
            write_line(&d->script, "init j%d.Wx = %.17g, j%d.Wy = %.17g, j%d.Wz = %.17g", j,
                       d->rate[j][0], j, d->rate[j][1], j, d->rate[j][2]);
        }
    for (int i = 0; i < m->states; i++)
        *y++ = states[i];
    *y = 0;
}

/* --- what is asked --- */

typedef struct Ask {
    char text[48];
    double wanted, scale;
} Ask;

typedef struct Asks {
    int count;
    Ask ask[400];
} Asks;

__attribute__((format(printf, 4, 5))) static void ask(Asks *asks, double wanted, double scale,
                                                      const char *format, ...)
{
    va_list arguments;
    Ask *a = &asks->ask[asks->count++];

    va_start(arguments, format);
    (void)vsnprintf(a->text, sizeof a->text, format, arguments);
    va_end(arguments);
    a->wanted = wanted;
    a->scale = scale;
}

static inline void ask_bodies(const Machine *m, const Instant *now, Asks *asks)
{
    double most = 1, speed = 1;

    for (int b = 0; b < m->bodies; b++) {
        most = fmax(most,
                    fmax(sqrt(dot(now->a[b], now->a[b])), sqrt(dot(now->alpha[b], now->alpha[b]))));
        speed = fmax(speed, fmax(sqrt(dot(now->v[b], now->v[b])), sqrt(dot(now->w[b], now->w[b]))));
    }
    for (int i = 0; i < m->coordinates; i++) {
        most = fmax(most, fabs((double)now->second[i]));
        speed = fmax(speed, fabs((double)now->rate[i]));
    }
    for (int b = 0; b < m->bodies; b++)
        for (int k = 0; k < 3; k++) {
            const char axis = "xyz"[k];

            if (!m->planar || k < 2) {
                ask(asks, now->p[b].at[k], 1, "b%d.%c", b, axis);
                ask(asks, now->v[b].at[k], speed, "b%d.v%c", b, axis);
                ask(asks, now->a[b].at[k], most, "b%d.a%c", b, axis);
            }
            if (!m->planar || k == 2) {
                ask(asks, now->w[b].at[k], speed, "b%d.w%c", b, axis);
                ask(asks, now->alpha[b].at[k], most, "b%d.alpha%c", b, axis);
            }
            if (!m->planar)
                ask(asks, turn_back(&now->R[b], now->w[b]).at[k], speed, "b%d.W%c", b, axis);
        }
    for (int i = 0; i < m->coordinates; i++) {
        ask(asks, now->q[i], 1, "%s", m->coordinate[i].name);
        ask(asks, now->rate[i], speed, "%s'", m->coordinate[i].name);
        ask(asks, now->second[i], most, "%s''", m->coordinate[i].name);
    }
}

static inline void ask_joints(const Machine *m, const Instant *now, Asks *asks)
{
    double most = 1;

    for (int j = 0; j < m->hinges; j++)
        most = fmax(most, fmax(sqrt(dot(now->force[j], now->force[j])),
                               sqrt(dot(now->moment[j], now->moment[j]))));
    for (int j = 0; j < m->hinges; j++) {
        const Stand t = stand(m, now, m->hinge[j].tail);
        const Vector F = turn_back(&t.R, now->force[j]), T = turn_back(&t.R, now->moment[j]);

        for (int k = 0; k < 3; k++) {
            if (!m->planar || k < 2) {
                ask(asks, now->force[j].at[k], most, "j%d.f%c", j, "xyz"[k]);
                ask(asks, F.at[k], most, "j%d.F%c", j, "xyz"[k]);
            }
            if (!m->planar || k == 2) {
                ask(asks, now->moment[j].at[k], most, "j%d.t%c", j, "xyz"[k]);
                ask(asks, T.at[k], most, "j%d.T%c", j, "xyz"[k]);
            }
        }
    }
    for (int l = 0; l < m->loads; l++)
        if (m->load[l].kind == LINE || m->load[l].kind == ALONG)
            ask(asks, now->load[l], fmax(1, fabs(now->load[l])), "%s.effort", m->load[l].name);
}

static inline void ask_networks(const Machine *m, const Instant *now, Asks *asks)
{
    static const char *const across[] = {"v", "w", "v", "p"};
    static const char *const through[] = {"i", "torque", "force", "flow"};
    static const double v_scale[] = {1, 1, 1, 1e4}, i_scale[] = {1, 1, 1, 1e-3};

    for (int i = 1; i < m->nodes; i++)
        ask(asks, now->potential[i], v_scale[m->node_domain[i]] + fabs(now->potential[i]), "%s.%s",
            m->node[i], across[m->node_domain[i]]);
    for (int i = 0; i < m->elements; i++) {
        const Element *e = &m->element[i];
        const int domain = m->node_domain[e->p];
        const bool two = e->kind == WINDINGS || e->kind == GYRATOR;
        const double i_most = i_scale[domain] + fabs(now->current[i]),
                     v = (e->p > 0 ? now->potential[e->p] : 0) -
                         (e->m > 0 ? now->potential[e->m] : 0);

        ask(asks, now->current[i], i_most, "%s%s.%s", e->name, two ? ".p" : "", through[domain]);
        /* a product: as exact as its factors */
        ask(asks, now->current[i] * v, i_most * (v_scale[domain] + fabs(v)), "%s%s.power", e->name,
            two ? ".p" : "");
    }
}

static inline Verdict compare(Member *member, Kit *kit, const Asks *asks, double at, double bound)
{
    for (int i = 0; i < asks->count; i++) {
        const Ask *a = &asks->ask[i];
        char text[100];
        double got, error;

        (void)snprintf(text, sizeof text, "%s at %.17g", a->text, at);
        got = kit_value(kit, text);
        error = fabs(got - a->wanted) / a->scale;
        if (!(error <= bound)) {
            keeps(member, a->text, error, bound);
            tell(member, "%s is %.12g, wanted %.12g %s\n", text, got, a->wanted,
                 isnan(got) ? kit->error.message : "");
            return DISAGREES;
        }
        member->figure = fmax(member->figure, error / bound);
    }
    return AGREES;
}

static inline void ask_all(const Machine *m, const Instant *now, Asks *asks)
{
    asks->count = 0;
    ask_bodies(m, now, asks);
    ask_joints(m, now, asks);
    ask_networks(m, now, asks);
}

/* --- members --- */

static inline bool holds_spheres(const Machine *m)
{
    bool found = false;

    for (int j = 0; j < m->hinges; j++)
        found = found || m->hinge[j].kind == SPHERICAL;
    return found;
}

static inline void draw_springs(Member *member, Drawn *d)
{
    Machine *m = &d->m;

    for (int c = 0; c < m->coordinates && m->loads < LOADS; c++) {
        Load *load = &m->load[m->loads];

        *load = (Load){.kind = ALONG,
                       .place = c,
                       .k = member_decades(member, 20, 200),
                       .rest = some(member, 0.5),
                       .d = member_between(member, 0, 2)};
        (void)snprintf(load->name, sizeof load->name, "f%d", m->loads++);
        write_line(&d->script, "spring %s %s k=%.17g rest=%.17g d=%.17g", load->name,
                   m->coordinate[c].name, load->k, load->rest, load->d);
    }
}

static inline bool draw_machine(Member *member, Drawn *d)
{
    Machine *m = &d->m;
    const int bodies = 1 + member_one_of(member, 3);

    memset(d, 0, sizeof *d);
    m->nodes = 1;
    m->planar = chance(member, 0.5);
    if (m->planar)
        write_line(&d->script, "scene planar");
    m->gravity = vec(some(member, 3), -9.81, m->planar ? 0 : some(member, 5));
    if (m->planar)
        write_line(&d->script, "gravity [%.17g, %.17g]", m->gravity.at[0], m->gravity.at[1]);
    else
        write_line(&d->script, "gravity [%.17g, %.17g, %.17g]", m->gravity.at[0], m->gravity.at[1],
                   m->gravity.at[2]);
    for (int b = 0; b < bodies; b++) {
        draw_body(member, d);
        draw_hinge(member, d, b);
    }
    if (!driven && chance(member, 0.4) && !draw_loop(member, d))
        return false;
    if (still)
        draw_springs(member, d);
    for (int k = member_one_of(member, 4); k > 0; k--)
        draw_load(member, d);
    if (!driven && chance(member, 0.7))
        draw_circuit(member, d);
    if (!driven && chance(member, 0.4))
        draw_line(member, d);
    if (!driven && chance(member, 0.4))
        draw_hydraulics(member, d);
    if (driven && holds_spheres(m))
        return false;
    write_start(d);
    return true;
}

static inline bool oracle_runs(const Drawn *d, Real from, Real to, Real *y)
{
    const Extrapolation by = {machine_rates, &d->m, machine_size(&d->m), 1e-11L};
    Real at = from, step = 0.02L;

    for (int tries = 0; at < to; tries++) {
        at += extrapolated_step(&by, to - at, &step, y);
        if (tries > 4000 || !(step > 1e-9L))
            return false;
    }
    return true;
}

/* a tree of some kind, a form and a method */
static inline void draw_tree(Member *member, Drawn *d, int kind)
{
    const Machine *m = &d->m;

    write_line(&d->script, "%s", kind == 1 ? "tree absolute" : "tree joint");
    for (int j = 0; kind == 2 && j < m->bodies; j++)
        if (chance(member, 0.5))
            write_line(&d->script, "cotree j%d", j);
}

static inline const char *draw_method(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams"};

    return methods[member_one_of(member, 5)];
}

/* the oracle's answer at `to`, from that at `from` */
static inline Verdict oracle_answers(const Drawn *d, double from, double to, Real *y, Asks *asks)
{
    static Instant now;

    if (to > from && !oracle_runs(d, from, to, y))
        return REFUSED;
    unpack(&d->m, y, &now);
    if (!instant_solve(&d->m, &now))
        return REFUSED;
    ask_all(&d->m, &now, asks);
    return AGREES;
}

static inline ct_status do_told(Member *member, Kit *kit, const char *text)
{
    const ct_status status = kit_do(kit, text);

    tell(member, "%s", text);
    if (status != CT_OK)
        tell(member, "%d: %s\n", kit->error.line, kit->error.message);
    return status;
}

#endif
