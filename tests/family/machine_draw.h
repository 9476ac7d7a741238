/* machine_draw.h: random mechanisms with loads, as statements and for the oracle of machine.h */
#ifndef COTREE_TESTS_MACHINE_DRAW_H
#define COTREE_TESTS_MACHINE_DRAW_H

#include "family.h"
#include "machine_tableau.h"
#include "script.h"

/* what is drawn: with sources that stand still and springs on all coordinates; without networks,
 * for all coordinates are driven */
static bool still, driven;

typedef struct Drawn {
    Machine m;
    double q[HINGES][4], rate[HINGES][3]; /* at the start; of a spherical one Euler parameters, W */
    Real y[MOST_STATES];
    Script script;
} Drawn;

static double some(Member *member, double size)
{
    return member_between(member, -size, size);
}

static bool chance(Member *member, double part)
{
    return member_between(member, 0, 1) < part;
}

static Wave draw_wave(Member *member, double size)
{
    return (Wave){.low = chance(member, 0.5) ? some(member, size) : 0,
                  .size = still ? 0 : some(member, size),
                  .pace = member_between(member, 1, 12),
                  .phase = some(member, 3)};
}

static const char *wave_text(const Wave *w, double factor, char out[160])
{
    (void)snprintf(out, 160, "%.17g + %.17g*sin(%.17g*t + %.17g)", factor * w->low,
                   factor * w->size, w->pace, w->phase);
    return out;
}

/* --- mechanisms --- */

static int draw_place(Member *member, Drawn *d, int body, char kind, int number)
{
    Machine *m = &d->m;
    Place *f = &m->place[m->places];
    double a[3];

    f->body = body;
    for (int k = 0; k < 3; k++) {
        f->r.at[k] = m->planar && k == 2 ? 0 : some(member, 0.6);
        a[k] = chance(member, 0.5) ? some(member, 1.5) : 0;
    }
    (void)snprintf(f->name, sizeof f->name, "%c%d", kind, number);
    if (m->planar)
        a[1] = a[2] = 0;
    {
        const Turn z = turn_about(vec(0, 0, 1), a[0]), y = turn_about(vec(0, 1, 0), a[1]),
                   x = turn_about(vec(1, 0, 0), a[2]), zy = turns(&z, &y);

        f->R = turns(&zy, &x);
    }
    {
        char from[16];

        (void)snprintf(from, sizeof from, body < 0 ? "ground" : "b%d", body);
        if (m->planar)
            write_line(&d->script, "arm %s %s [%.17g, %.17g] rotation=z(%.17g)", f->name, from,
                       f->r.at[0], f->r.at[1], a[0]);
        else
            write_line(&d->script,
                       "arm %s %s [%.17g, %.17g, %.17g] rotation=z(%.17g)*y(%.17g)*x(%.17g)",
                       f->name, from, f->r.at[0], f->r.at[1], f->r.at[2], a[0], a[1], a[2]);
    }
    return m->places++;
}

static void draw_body(Member *member, Drawn *d)
{
    Machine *m = &d->m;
    const int b = m->bodies++;
    double *I = m->inertia[b];
    Vector size;

    m->mass[b] = member_decades(member, 0.2, 4);
    /* a box that is turned: a tensor that bodies can have */
    for (int k = 0; k < 3; k++)
        size.at[k] = member_between(member, 0.01, 0.09);
    for (int k = 0; k < 3; k++)
        I[k] = m->mass[b] * (size.at[(k + 1) % 3] + size.at[(k + 2) % 3]);
    if (m->planar) {
        write_line(&d->script, "body b%d mass=%.17g inertia=%.17g", b, m->mass[b], I[2]);
        return;
    }
    if (chance(member, 0.5)) {
        const Turn R = turn_about(vec(0.6, 0, 0.8), some(member, 2)), back = transposed(&R);
        const Turn diagonal = {{{I[0], 0, 0}, {0, I[1], 0}, {0, 0, I[2]}}};
        const Turn half = turns(&R, &diagonal), whole = turns(&half, &back);

        for (int k = 0; k < 3; k++)
            I[k] = whole.at[k][k];
        I[3] = whole.at[0][1];
        I[4] = whole.at[0][2];
        I[5] = whole.at[1][2];
    }
    write_line(&d->script, "body b%d mass=%.17g inertia=[%.17g, %.17g, %.17g, %.17g, %.17g, %.17g]",
               b, m->mass[b], I[0], I[1], I[2], I[3], I[4], I[5]);
}

static void add_coordinate(Drawn *d, int hinge, int axis, bool shift, const char *member_name)
{
    Machine *m = &d->m;
    Coordinate *c = &m->coordinate[m->coordinates++];

    *c = (Coordinate){.hinge = hinge, .axis = axis, .shift = shift};
    (void)snprintf(c->name, sizeof c->name, "j%d%s", hinge, member_name);
}

static void name_coordinates(Drawn *d, int number)
{
    Hinge *j = &d->m.hinge[number];

    j->coordinate = d->m.coordinates;
    switch (j->kind) {
    case REVOLUTE:
        add_coordinate(d, number, 0, false, "");
        break;
    case SCREW:
        add_coordinate(d, number, 0, false, ".theta");
        break;
    case PRISMATIC:
        add_coordinate(d, number, 0, true, "");
        break;
    case CYLINDRICAL:
        add_coordinate(d, number, 0, true, ".s");
        add_coordinate(d, number, 0, false, ".theta");
        break;
    case UNIVERSAL:
        add_coordinate(d, number, 0, false, ".a1");
        add_coordinate(d, number, 1, false, ".a2");
        break;
    case PLANE_ON_PLANE:
        add_coordinate(d, number, 1, true, ".s1");
        add_coordinate(d, number, 2, true, ".s2");
        add_coordinate(d, number, 0, false, ".theta");
        break;
    default:
        break;
    }
    j->coordinates = d->m.coordinates - j->coordinate;
}

/* u and two across it, in circle; text: how it is written */
static void draw_axis(Member *member, const Machine *m, Hinge *j, char *text, size_t room)
{
    static const char *const words[] = {"x", "y", "z"};
    const bool in_plane = j->kind == PRISMATIC;
    int k = m->planar ? (in_plane ? member_one_of(member, 2) : 2) : member_one_of(member, 3);
    const int sign = j->kind != PLANE_ON_PLANE && chance(member, 0.3) ? -1 : 1;
    const bool skew = chance(member, 0.4) && (in_plane || !m->planar) && j->kind != UNIVERSAL &&
                      j->kind != PLANE_ON_PLANE;

    memset(j->axis, 0, sizeof j->axis);
    if (skew) {
        Vector u = vec(some(member, 1), some(member, 1) + 1.2, m->planar ? 0 : some(member, 1));

        (void)snprintf(text, room, m->planar ? "[%.17g, %.17g]" : "[%.17g, %.17g, %.17g]", u.at[0],
                       u.at[1], u.at[2]);
        u = add(vec(0, 0, 0), 1 / sqrt(dot(u, u)), u);
        j->axis[0] = u;
        j->axis[1] = cross(u, m->planar ? vec(0, 0, 1) : vec(u.at[1], -u.at[2], u.at[0]));
        j->axis[1] = add(vec(0, 0, 0), 1 / sqrt(dot(j->axis[1], j->axis[1])), j->axis[1]);
        j->axis[2] = cross(u, j->axis[1]);
        return;
    }
    j->axis[0].at[k] = sign;
    j->axis[1].at[(k + 1) % 3] = 1;
    j->axis[2].at[(k + 2) % 3] = 1;
    if (j->kind == UNIVERSAL)
        (void)snprintf(text, room, "[%s%s, %s]", sign < 0 ? "-" : "", words[k], words[(k + 1) % 3]);
    else
        (void)snprintf(text, room, "%s%s", sign < 0 ? "-" : "", words[k]);
}

static void write_hinge(Member *member, Drawn *d, int number)
{
    static const char *const words[] = {"revolute",  "prismatic", "cylindrical", "universal",
                                        "spherical", "screw",     "planarjoint", "weld"};
    static const char *const keys[] = {"axis", "axis", "axis", "axes", "", "axis", "normal", ""};
    Hinge *j = &d->m.hinge[number];
    char axis[100] = "";

    (void)snprintf(j->name, sizeof j->name, "j%d", number);
    draw_axis(member, &d->m, j, axis, sizeof axis);
    write_piece(&d->script, "%s j%d %s %s", words[j->kind], number, d->m.place[j->tail].name,
                d->m.place[j->tip].name);
    if (keys[j->kind][0] != '\0')
        write_piece(&d->script, " %s=%s", keys[j->kind], axis);
    if (j->kind == SCREW)
        write_piece(&d->script, " pitch=%.17g",
                    j->pitch = (chance(member, 0.5) ? 1 : -1) * member_between(member, 0.1, 1));
    write_line(&d->script, "%s", "");
}

static void draw_hinge(Member *member, Drawn *d, int body)
{
    static const HingeKind planar[] = {REVOLUTE, REVOLUTE, REVOLUTE, PRISMATIC, PLANE_ON_PLANE};
    static const HingeKind spatial[] = {REVOLUTE,  REVOLUTE,  REVOLUTE, PRISMATIC,     CYLINDRICAL,
                                        UNIVERSAL, SPHERICAL, SCREW,    PLANE_ON_PLANE};
    Machine *m = &d->m;
    const int number = m->hinges++, parent = body == 0 ? -1 : member_one_of(member, body + 1) - 1;
    Hinge *j = &m->hinge[number];

    j->kind = m->planar ? planar[member_one_of(member, 5)] : spatial[member_one_of(member, 9)];
    j->tail = draw_place(member, d, parent, 't', number);
    j->tip = draw_place(member, d, body, 'h', number);
    write_hinge(member, d, number);
    name_coordinates(d, number);
    for (int k = 0; k < 4; k++)
        d->q[number][k] = some(member, 0.9);
    for (int k = 0; k < 3; k++)
        d->rate[number][k] = chance(member, 0.7) ? some(member, 2) : 0;
    if (j->kind == SPHERICAL) {
        double length = 0;

        d->q[number][0] = 1;
        for (int k = 0; k < 4; k++)
            length += d->q[number][k] * d->q[number][k];
        for (int k = 0; k < 4; k++)
            d->q[number][k] /= sqrt(length);
    }
}

static Turn turn_of(const double *q)
{
    Turn R;

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        R.at[i][i] = 1 - 2 * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k]);
        R.at[i][j] = 2 * (q[1 + i] * q[1 + j] - q[0] * q[1 + k]);
        R.at[j][i] = 2 * (q[1 + i] * q[1 + j] + q[0] * q[1 + k]);
    }
    return R;
}

/* where the tip of a joint stands and how it goes, from its tail */
static void follow(const Drawn *d, int number, const Stand *t, Stand *h)
{
    const Hinge *j = &d->m.hinge[number];
    const double *q = d->q[number], *rate = d->rate[number];
    Vector shift = vec(0, 0, 0), going = shift, w = shift;
    Turn R = turn_about(vec(0, 0, 1), 0);

    switch (j->kind) {
    case REVOLUTE:
    case SCREW:
        R = turn_about(j->axis[0], q[0]);
        w = add(w, rate[0], j->axis[0]);
        shift = add(shift, j->pitch / (2 * acos(-1)) * q[0], j->axis[0]);
        going = add(going, j->pitch / (2 * acos(-1)) * rate[0], j->axis[0]);
        break;
    case PRISMATIC:
        shift = add(shift, q[0], j->axis[0]);
        going = add(going, rate[0], j->axis[0]);
        break;
    case CYLINDRICAL:
        shift = add(shift, q[0], j->axis[0]);
        going = add(going, rate[0], j->axis[0]);
        R = turn_about(j->axis[0], q[1]);
        w = add(w, rate[1], j->axis[0]);
        break;
    case UNIVERSAL: {
        const Turn first = turn_about(j->axis[0], q[0]), second = turn_about(j->axis[1], q[1]);

        R = turns(&first, &second);
        w = add(add(w, rate[0], j->axis[0]), rate[1], turn(&first, j->axis[1]));
        break;
    }
    case SPHERICAL:
        R = turn_of(q);
        w = turn(&R, vec(rate[0], rate[1], rate[2]));
        break;
    case PLANE_ON_PLANE:
        for (int k = 0; k < 2; k++) {
            shift = add(shift, q[k], j->axis[1 + k]);
            going = add(going, rate[k], j->axis[1 + k]);
        }
        R = turn_about(j->axis[0], q[2]);
        w = add(w, rate[2], j->axis[0]);
        break;
    default:
        break;
    }
    shift = turn(&t->R, shift);
    h->p = add(t->p, 1, shift);
    h->v = add(add(t->v, 1, cross(t->w, shift)), 1, turn(&t->R, going));
    h->R = turns(&t->R, &R);
    h->w = add(t->w, 1, turn(&t->R, w));
}

/* bodies from their joints, in the order in which they were made */
static void set_out(const Drawn *d, Instant *now)
{
    const Machine *m = &d->m;

    for (int b = 0; b < m->bodies; b++) {
        const Hinge *j = &m->hinge[b];
        const Place *tip = &m->place[j->tip];
        const Stand t = stand(m, now, j->tail);
        const Turn back = transposed(&tip->R);
        Stand h = {.body = b};
        Vector rho;

        follow(d, b, &t, &h);
        now->R[b] = turns(&h.R, &back);
        now->w[b] = h.w;
        rho = turn(&now->R[b], tip->r);
        now->p[b] = add(h.p, -1, rho);
        now->v[b] = add(h.v, -1, cross(h.w, rho));
    }
}

static int rates_of(const Hinge *j)
{
    static const int count[] = {1, 1, 2, 2, 3, 1, 3, 0};

    return count[j->kind];
}

/* speeds that keep a loop closed: those that were drawn, less what opens it; false: its rows
 * depend on each other, and what it carries is not determined */
static bool close_speeds(Drawn *d, int loop)
{
    Machine *m = &d->m;
    double *rate[3 * HINGES], keep[3 * HINGES], rows[6][3 * HINGES];
    static Instant now;
    Row row[6];
    int count = 0, ways, n = 0;
    bool independent = true;

    for (int j = 0; j < m->bodies; j++)
        for (int k = 0; k < rates_of(&m->hinge[j]); k++) {
            rate[count] = &d->rate[j][k];
            keep[count++] = d->rate[j][k];
        }
    for (int c = 0; c < count; c++) {
        for (int i = 0; i < count; i++)
            *rate[i] = i == c;
        set_out(d, &now);
        n = hinge_rows(m, &now, &m->hinge[loop], row, &ways);
        for (int r = 0; r < n; r++)
            rows[r][c] = row[r].rate;
    }
    for (int turn_of_it = 0; turn_of_it < 2; turn_of_it++)
        for (int r = 0; r < n; r++) {
            double length = 0;

            for (int before = 0; before < r; before++) {
                double both = 0;

                for (int c = 0; c < count; c++)
                    both += rows[r][c] * rows[before][c];
                for (int c = 0; c < count; c++)
                    rows[r][c] -= both * rows[before][c];
            }
            for (int c = 0; c < count; c++)
                length += rows[r][c] * rows[r][c];
            independent = independent && length > 1e-3;
            for (int c = 0; c < count; c++)
                rows[r][c] /= sqrt(length);
        }
    for (int r = 0; r < n; r++) {
        double along = 0;

        for (int c = 0; c < count; c++)
            along += rows[r][c] * keep[c];
        for (int c = 0; c < count; c++)
            keep[c] -= along * rows[r][c];
    }
    for (int c = 0; c < count; c++)
        *rate[c] = keep[c];
    return independent;
}

/* a joint more between two bodies, whose frames meet where bodies stand now */
static bool draw_loop(Member *member, Drawn *d)
{
    Machine *m = &d->m;
    static Instant now;
    int freedoms = 0, number;
    const int one = member_one_of(member, m->bodies);
    const int other = member_one_of(member, m->bodies + 1) - 1;
    Vector at;

    for (int j = 0; j < m->hinges; j++)
        freedoms += rates_of(&m->hinge[j]);
    if (one == other || freedoms <= (m->planar ? 2 : 3))
        return true;
    set_out(d, &now);
    at = now.p[one];
    for (int k = 0; k < (m->planar ? 2 : 3); k++)
        at.at[k] += some(member, 0.5);
    number = m->hinges++;
    Hinge *j = &m->hinge[number];

    j->kind = m->planar ? REVOLUTE : SPHERICAL;
    for (int side = 0; side < 2; side++) {
        const int body = side == 0 ? other : one;
        Place *f = &m->place[m->places];
        char from[16];

        f->body = body;
        f->R = turn_about(vec(0, 0, 1), 0);
        f->r = body < 0 ? at : turn_back(&now.R[body], add(at, -1, now.p[body]));
        (void)snprintf(f->name, sizeof f->name, "%c%d", side == 0 ? 't' : 'h', number);
        (void)snprintf(from, sizeof from, body < 0 ? "ground" : "b%d", body);
        if (m->planar)
            write_line(&d->script, "arm %s %s [%.17g, %.17g]", f->name, from, f->r.at[0],
                       f->r.at[1]);
        else
            write_line(&d->script, "arm %s %s [%.17g, %.17g, %.17g]", f->name, from, f->r.at[0],
                       f->r.at[1], f->r.at[2]);
        *(side == 0 ? &j->tail : &j->tip) = m->places++;
    }
    write_hinge(member, d, number);
    j->coordinate = m->coordinates;
    return close_speeds(d, number);
}

/* --- loads --- */

static int any_place(Member *member, const Machine *m)
{
    return member_one_of(member, m->places);
}

static void write_push(Drawn *d, const Load *load)
{
    const Machine *m = &d->m;
    const char *name = m->place[load->place].name;
    const int count = load->kind == TWIST && m->planar ? 1 : m->planar ? 2 : 3;
    char text[160];

    write_piece(&d->script, "%s %s %s ", load->kind == PUSH ? "force" : "torque", load->name, name);
    if (count > 1)
        write_piece(&d->script, "[");
    for (int k = 0; k < count; k++) {
        const Wave *w = &load->wave[count == 1 ? 2 : k];

        write_piece(&d->script, "%s(%s)", k > 0 ? ", " : "", wave_text(w, 1, text));
        if (load->drag > 0)
            write_piece(&d->script, " - %.17g*%s.v%c", load->drag, name, "xyz"[k]);
    }
    write_line(&d->script, "%s%s", count > 1 ? "]" : "", load->own_axes ? " in=body" : "");
}

static void draw_load(Member *member, Drawn *d)
{
    Machine *m = &d->m;
    Load *load = &m->load[m->loads];
    static Instant now;
    char text[160];
    double length;

    *load = (Load){.kind = (LoadKind)member_one_of(member, 4)};
    (void)snprintf(load->name, sizeof load->name, "f%d", m->loads);
    load->place = any_place(member, m);
    switch (load->kind) {
    case PUSH:
    case TWIST:
        if (m->place[load->place].body < 0)
            return;
        for (int k = 0; k < 3; k++)
            if (!m->planar || (k == 2) == (load->kind == TWIST))
                load->wave[k] = draw_wave(member, 4);
        load->own_axes = chance(member, 0.5);
        load->drag = load->kind == PUSH && !load->own_axes && chance(member, 0.5) ? 0.7 : 0;
        write_push(d, load);
        break;
    case LINE:
        load->other = any_place(member, m);
        if (m->place[load->place].body == m->place[load->other].body)
            return;
        set_out(d, &now);
        (void)line_row(m, &now, load, &length);
        if (length < 0.3)
            return;
        load->k = member_decades(member, 1, 60);
        load->rest = length * member_between(member, 0.6, 1.3);
        load->d = chance(member, 0.5) ? member_between(member, 0, 2) : 0;
        write_line(&d->script, "spring %s %s %s k=%.17g length=%.17g d=%.17g", load->name,
                   m->place[load->other].name, m->place[load->place].name, load->k, load->rest,
                   load->d);
        break;
    case ALONG:
        load->place = m->coordinates > 0 ? member_one_of(member, m->coordinates) : 0;
        if (m->coordinates == 0)
            return;
        if (chance(member, 0.5)) {
            load->k = member_decades(member, 1, 60);
            load->rest = some(member, 0.5);
            load->d = member_between(member, 0, 2);
            write_line(&d->script, "spring %s %s k=%.17g rest=%.17g d=%.17g", load->name,
                       m->coordinate[load->place].name, load->k, load->rest, load->d);
        } else {
            load->wave[0] = draw_wave(member, 4);
            write_line(&d->script, "actuator %s %s %s=%s", load->name,
                       m->coordinate[load->place].name,
                       m->coordinate[load->place].shift ? "force" : "torque",
                       wave_text(&load->wave[0], 1, text));
        }
        break;
    }
    m->loads++;
}

#endif
