/* family_power.c: powers of the edges of random models of all domains, at random states
 *
 * Bodies hang on joints of all types at q = 0 with parallel axes, so that arms to one point close
 * loops there. The powers of all edges of a domain add up to 0 (Tellegen's theorem). Those of a
 * joint, a body, a force or a spring are computed otherwise: from reactions, accelerations and
 * laws, times the velocities of its frames. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { BODIES = 5, EDGES = 60 };

typedef enum Kind { ARM, BODY, JOINT, PUSH, LINE } Kind;

typedef struct EdgeOf {
    Kind kind;
    char name[16], tail[16], head[16];
    double mass, inertia[3], push[6], law[3]; /* law: k, length, d */
} EdgeOf;

typedef struct Powered {
    Script *script;
    EdgeOf edge[EDGES];
    int edges, frames;
    bool planar;
    double at[BODIES][3]; /* positions at q = 0 */
    bool has_networks;
} Powered;

static EdgeOf *add_edge(Powered *p, Kind kind, const char *name, const char *tail, const char *head)
{
    EdgeOf *edge = &p->edge[p->edges++];

    *edge = (EdgeOf){.kind = kind};
    (void)snprintf(edge->name, sizeof edge->name, "%s", name);
    (void)snprintf(edge->tail, sizeof edge->tail, "%s", tail);
    (void)snprintf(edge->head, sizeof edge->head, "%s", head);
    return edge;
}

static const char *vector_text(const Powered *p, const double *at, char out[96])
{
    if (p->planar)
        (void)snprintf(out, 96, "[%.6f, %.6f]", at[0], at[1]);
    else
        (void)snprintf(out, 96, "[%.6f, %.6f, %.6f]", at[0], at[1], at[2]);
    return out;
}

/* an arm to a point, from body `body` or ground (-1); its name */
static void write_arm(Powered *p, int body, const double point[3], char name[16])
{
    char text[96], from[16];
    double way[3];

    (void)snprintf(name, 16, "f%d", p->frames++);
    (void)snprintf(from, sizeof from, body < 0 ? "ground" : "m%d", body);
    for (int k = 0; k < 3; k++)
        way[k] = point[k] - (body < 0 ? 0 : p->at[body][k]);
    write_line(p->script, "arm %s %s %s", name, from, vector_text(p, way, text));
    (void)add_edge(p, ARM, name, from, name);
}

static void draw_point(Member *member, const Powered *p, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = p->planar && k == 2 ? 0 : member_between(member, -1, 1);
}

static void write_body(Member *member, Powered *p, int number)
{
    char name[16];
    EdgeOf *edge;

    (void)snprintf(name, sizeof name, "m%d", number);
    edge = add_edge(p, BODY, name, "ground", name);
    edge->mass = member_between(member, 0.5, 2);
    for (int k = 0; k < 3; k++)
        edge->inertia[k] = member_between(member, 0.2, 0.3);
    if (p->planar)
        write_line(p->script, "body %s mass=%.17g inertia=%.17g", name, edge->mass,
                   edge->inertia[2]);
    else
        write_line(p->script, "body %s mass=%.17g inertia=[%.17g, %.17g, %.17g]", name, edge->mass,
                   edge->inertia[0], edge->inertia[1], edge->inertia[2]);
}

static void write_joint(Powered *p, const char *type, int from, int to, const double *point)
{
    char tail[16], head[16], name[16];
    int keys;

    write_arm(p, from, point, tail);
    write_arm(p, to, point, head);
    (void)snprintf(name, sizeof name, "h%d", p->edges);
    keys = (int)strcspn(type, " ");
    write_line(p->script, "%.*s %s %s %s%s", keys, type, name, tail, head, type + keys);
    (void)add_edge(p, JOINT, name, tail, head);
}

/* in a loop: types of which four close it with freedoms left */
static const char *joint_type(Member *member, const Powered *p, bool in_loop)
{
    static const char *const planar[] = {"revolute", "prismatic axis=x", "prismatic axis=y"};
    static const char *const spatial[] = {"spherical",   "universal",       "cylindrical",
                                          "revolute",    "prismatic",       "revolute axis=x",
                                          "planarjoint", "screw pitch=0.3", "prismatic axis=y"};

    return p->planar ? planar[in_loop ? 0 : member_one_of(member, COUNT(planar))]
                     : spatial[member_one_of(member, in_loop ? 3 : COUNT(spatial))];
}

static void write_loads(Member *member, Powered *p, int bodies)
{
    const int body = member_one_of(member, bodies), other = member_one_of(member, bodies);
    double point[3];
    char tail[16], head[16];
    EdgeOf *edge;

    draw_point(member, p, point);
    write_arm(p, body, point, head);
    edge = add_edge(p, PUSH, "F", "ground", head);
    for (int k = 0; k < 3; k++)
        edge->push[k] = p->planar && k == 2 ? 0 : member_between(member, -9, 9);
    write_piece(p->script, "force F %s [%.17g, %.17g", head, edge->push[0], edge->push[1]);
    if (!p->planar)
        write_piece(p->script, ", %.17g", edge->push[2]);
    write_line(p->script, "]");
    draw_point(member, p, point);
    write_arm(p, -1, point, tail);
    draw_point(member, p, point);
    write_arm(p, other, point, head);
    edge = add_edge(p, LINE, "k", tail, head);
    edge->law[0] = member_between(member, 1, 30);
    edge->law[1] = member_between(member, 0.1, 1);
    write_line(p->script, "spring k %s %s k=%.17g length=%.17g", tail, head, edge->law[0],
               edge->law[1]);
    edge = add_edge(p, LINE, "d", tail, head);
    edge->law[2] = member_between(member, 0.1, 3);
    write_line(p->script, "damper d %s %s d=%.17g", tail, head, edge->law[2]);
}

/* a motor on a crank of its own, with a circuit, a shaft and a pipe */
static void write_networks(Member *member, Powered *p)
{
    char head[16];

    p->has_networks = true;
    write_body(member, p, BODIES);
    (void)snprintf(head, sizeof head, "m%d", BODIES);
    write_line(p->script, "revolute hm ground %s", head);
    (void)add_edge(p, JOINT, "hm", "ground", head);
    write_line(p->script, "motor M hm a 0 R=%.3f L=0.1 Kt=0.5 Kv=0.5 J=0.02",
               member_between(member, 0.5, 2));
    write_line(p->script, "vsource E n 0 3*cos(2*t)\nresistor R n a %.3f\ncapacitor C a 0 0.1",
               member_between(member, 0.5, 2));
    write_line(p->script, "shaftend Z hm s 0\nflywheel W r 0 J=0.1\nshaft K s r k=%.3f d=0.2",
               member_between(member, 1, 9));
    write_line(p->script, "tank T q 0 A=0.1\npump P q 0 pressure=3\npipe L q w R=2\ntank T2 w 0 "
                          "A=0.3");
}

static void write_model(Member *member, Powered *p)
{
    const bool in_loop = member_one_of(member, 2) == 0;
    const int bodies = in_loop ? BODIES - 1 : 2 + member_one_of(member, BODIES - 2);
    double point[3];

    p->script->length = 0;
    p->planar = member_one_of(member, 3) == 0;
    write_line(p->script, p->planar ? "scene planar; gravity [0, -9.81]" : "gravity [0, 0, -9.81]");
    for (int i = 0; i < bodies; i++) {
        draw_point(member, p, p->at[i]);
        write_body(member, p, i);
    }
    for (int i = 0; i < bodies; i++) {
        draw_point(member, p, point);
        write_joint(p, joint_type(member, p, in_loop),
                    in_loop ? i - 1 : member_one_of(member, i + 1) - 1, i, point);
    }
    if (in_loop) {
        draw_point(member, p, point);
        write_joint(p, p->planar ? "revolute" : "spherical", -1, bodies - 1, point);
    }
    write_loads(member, p, bodies);
    if (member_one_of(member, 2) == 0)
        write_networks(member, p);
    for (int i = 0; i < bodies; i++)
        write_line(p->script, "guess m%d.vx = %.3f, m%d.vy = %.3f, m%d.wz = %.3f", i,
                   member_between(member, -1, 1), i, member_between(member, -1, 1), i,
                   member_between(member, -3, 3));
    if (member_one_of(member, 3) == 0)
        write_line(p->script, "tree absolute");
}

/* --- the other way --- */

static double value_of(Kit *kit, const char *owner, const char *member)
{
    char text[64];

    if (strcmp(owner, "ground") == 0)
        return 0;
    (void)snprintf(text, sizeof text, "%s.%s", owner, member);
    return kit_value(kit, text);
}

/* three components; in the plane those that a planar scene has */
static void vector_of(Kit *kit, const Powered *p, const char *owner, const char *stem,
                      double out[3])
{
    for (int k = 0; k < 3; k++) {
        char member[16];
        const bool is_turn = stem[0] == 'w' || stem[0] == 't' || strcmp(stem, "alpha") == 0;

        (void)snprintf(member, sizeof member, "%s%c", stem, "xyz"[k]);
        out[k] = p->planar && (k == 2) != is_turn ? 0 : value_of(kit, owner, member);
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

typedef struct Moving {
    double r[3], v[3], w[3];
} Moving;

static Moving moving_of(Kit *kit, const Powered *p, const char *frame)
{
    Moving out = {0};

    vector_of(kit, p, frame, "", out.r);
    vector_of(kit, p, frame, "v", out.v);
    vector_of(kit, p, frame, "w", out.w);
    return out;
}

/* d/dt of kinetic energy and height, with the tensor in the body's own axes */
static double power_of_body(Kit *kit, const Powered *p, const EdgeOf *edge, const Moving *m)
{
    double a[3], alpha[3], own_w[3], spin[3], torque = 0;
    const double g[3] = {0, p->planar ? -9.81 : 0, p->planar ? 0 : -9.81};

    vector_of(kit, p, edge->head, "a", a);
    vector_of(kit, p, edge->head, "alpha", alpha);
    if (p->planar) {
        torque = edge->inertia[2] * alpha[2] * m->w[2];
    } else {
        /* w . I alpha in own axes, from the rotation by Euler parameters */
        double q[4], R[3][3];

        for (int k = 0; k < 4; k++) {
            char name[4] = {'q', (char)('0' + k), '\0'};

            q[k] = value_of(kit, edge->head, name);
        }
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                R[i][j] = 2 * q[1 + i] * q[1 + j] + (i == j ? 2 * q[0] * q[0] - 1 : 0);
        for (int i = 0; i < 3; i++) {
            R[i][(i + 1) % 3] -= 2 * q[0] * q[1 + (i + 2) % 3];
            R[(i + 1) % 3][i] += 2 * q[0] * q[1 + (i + 2) % 3];
        }
        for (int j = 0; j < 3; j++) {
            own_w[j] = spin[j] = 0;
            for (int i = 0; i < 3; i++) {
                own_w[j] += R[i][j] * m->w[i];
                spin[j] += R[i][j] * alpha[i];
            }
            torque += edge->inertia[j] * own_w[j] * spin[j];
        }
    }
    return edge->mass * (dot(g, m->v) - dot(a, m->v)) - torque;
}

static double power_of_line(const EdgeOf *edge, const Moving *tail, const Moving *head)
{
    double way[3], rate[3], length, stretch;

    for (int k = 0; k < 3; k++) {
        way[k] = head->r[k] - tail->r[k];
        rate[k] = head->v[k] - tail->v[k];
    }
    length = sqrt(dot(way, way));
    stretch = dot(way, rate) / length;
    return -(edge->law[0] * (length - edge->law[1]) + edge->law[2] * stretch) * stretch;
}

/* F.(v - v_tail - w_tail x r) + T.(w - w_tail), from the reaction */
static double power_of_joint(Kit *kit, const Powered *p, const EdgeOf *edge, const Moving *tail,
                             const Moving *head, double *size)
{
    double force[3], torque[3], way[3], carried[3], v[3], w[3];

    vector_of(kit, p, edge->name, "f", force);
    vector_of(kit, p, edge->name, "t", torque);
    for (int k = 0; k < 3; k++)
        way[k] = head->r[k] - tail->r[k];
    cross(tail->w, way, carried);
    for (int k = 0; k < 3; k++) {
        v[k] = head->v[k] - tail->v[k] - carried[k];
        w[k] = head->w[k] - tail->w[k];
    }
    *size = sqrt(dot(force, force) * dot(v, v)) + sqrt(dot(torque, torque) * dot(w, w)) +
            sqrt(dot(force, force) * dot(head->v, head->v));
    return dot(force, v) + dot(torque, w);
}

/* *scale grows by the forces times velocities whose difference is a power */
static bool edge_agrees(Member *member, Kit *kit, const Powered *p, const EdgeOf *edge, double got,
                        double *scale)
{
    const Moving tail = moving_of(kit, p, edge->tail), head = moving_of(kit, p, edge->head);
    double wanted = 0, size = 0;

    switch (edge->kind) {
    case ARM:
        break;
    case BODY:
        wanted = power_of_body(kit, p, edge, &head);
        break;
    case JOINT:
        wanted = power_of_joint(kit, p, edge, &tail, &head, &size);
        break;
    case PUSH:
        wanted = dot(edge->push, head.v);
        break;
    case LINE:
        wanted = power_of_line(edge, &tail, &head);
        break;
    }
    if (isnan(wanted) && edge->kind == JOINT) /* its reaction isn't determined */
        wanted = size = 0;
    *scale += size;
    if (keeps(member, edge->name, fabs(got - wanted), 1e-9 * *scale))
        return true;
    tell(member, "%s.power is %.12g, wanted %.12g\n", edge->name, got, wanted);
    return false;
}

/* every sum that is printed is 0 */
static bool sums_are_zero(Member *member, Kit *kit)
{
    const char *line;

    if (kit_do(kit, "show power\n") != CT_OK || kit->text == NULL) {
        tell(member, "show power: %s\n", kit->error.message);
        return false;
    }
    for (line = kit->text; (line = strstr(line, "\nsum ")) != NULL;) {
        for (line += 5; *line != '\n'; line++)
            if (*line != ' ' && *line != '0') {
                tell(member, "%s", kit->text);
                return false;
            }
    }
    return true;
}

static Verdict compare(Member *member, Kit *kit, const Powered *p)
{
    double power[EDGES], sum = 0, scale = 1;

    for (int i = 0; i < p->edges; i++) {
        power[i] = value_of(kit, p->edge[i].name, "power");
        sum += power[i];
        scale += fabs(power[i]);
        if (isnan(power[i])) {
            tell(member, "%s.power: %s\n", p->edge[i].name, kit->error.message);
            return DISAGREES;
        }
    }
    /* mechanical edges of transducers: torque times rate, and their rotor */
    if (p->has_networks) {
        sum += kit_value(kit, "(M.torque - 0.02*hm'')*hm' + Z.w*Z.torque");
        if (kit_value(kit, "abs(E.v*E.i + R.v*R.i + C.v*C.i + M.v*M.i)") > 1e-9 ||
            kit_value(kit, "abs(Z.w*Z.torque + W.w*W.torque + K.w*K.torque)") > 1e-9) {
            tell(member, "networks don't balance\n");
            return DISAGREES;
        }
    }
    for (int i = 0; i < p->edges; i++)
        if (!edge_agrees(member, kit, p, &p->edge[i], power[i], &scale))
            return DISAGREES;
    if (!keeps(member, "sum", fabs(sum), 1e-9 * scale))
        return DISAGREES;
    return sums_are_zero(member, kit) ? AGREES : DISAGREES;
}

static Verdict powers_add_up_to_zero(Member *member)
{
    static Script script;
    static Powered p;
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    memset(&p, 0, sizeof p);
    p.script = &script;
    write_model(member, &p);
    if (kit_do(&kit, script.text) == CT_OK && kit_do(&kit, "simulate 0.05 every=0.05\n") == CT_OK)
        verdict = compare(member, &kit, &p);
    if (verdict != AGREES || member->told)
        tell(member, "%s%s\n", script.text, kit.error.message);
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    {"powers of all edges of a domain add up to 0, and are force times velocity", 24, 0.3, 0,
     powers_add_up_to_zero}};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
