/* family_couplers.c: coordinates that follow others, against Lagrange's equations by hand
 *
 * Slides and hinges on the ground and the hinges of a chain of rods in a plane have a matrix M(q)
 * and forces h(q, u) that are written down here. The first of them are free, each other follows one
 * or two before it: q = f(a, b). With J = dq/d(free) the motion is J^T M J w' = J^T (h - M J' w),
 * and the effort on each that follows is what is missing in its own row, less what those that
 * follow it push back. */
#include "family.h"

#include "../unit/session_kit.h"

enum { MOST = 6, FREE = 3 };
#define GRAVITY 9.81

typedef enum Kind { HINGE, SLIDE, CHAIN } Kind;
typedef enum Law { LINE, SINE, SQUARE } Law;

typedef struct Joint {
    Kind kind;
    int link; /* of the chain */
    double mass, inertia[3], axis[3], arm[3], length;
    double stiffness, rest, effort;
    /* what it follows: c + r1*law(q[first]) + r2*q[second] */
    int first, second; /* -1: none */
    Law law;
    double c, r1, r2;
} Joint;

typedef struct Model {
    bool planar;
    int count, free;
    Joint at[MOST];
    double q[MOST], u[MOST]; /* of the free ones, and what follows */
} Model;

/* --- by hand --- */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* v turned by an angle about a unit vector: Rodrigues */
static void turn(const double n[3], double angle, const double v[3], double out[3])
{
    double square[3];

    cross(n, v, square);
    for (int i = 0; i < 3; i++)
        out[i] = cos(angle) * v[i] + sin(angle) * square[i] + (1 - cos(angle)) * dot(n, v) * n[i];
}

/* of the chain's rods: their rows of M and h */
static void add_chain(const Model *m, const double *q, const double *u, double M[MOST][MOST],
                      double *h)
{
    int rod[MOST], rods = 0;
    double angle[MOST], rate[MOST];

    for (int i = 0; i < m->count; i++)
        if (m->at[i].kind == CHAIN)
            rod[rods++] = i;
    for (int k = 0; k < rods; k++) {
        angle[k] = q[rod[k]] + (k > 0 ? angle[k - 1] : 0);
        rate[k] = u[rod[k]] + (k > 0 ? rate[k - 1] : 0);
    }
    for (int k = 0; k < rods; k++) { /* the mass of rod k, in its middle */
        const Joint *joint = &m->at[rod[k]];
        double part[MOST][2] = {{0}}, bias[2] = {0, 0};

        for (int i = 0; i <= k; i++) {
            const double far = m->at[rod[i]].length / (i == k ? 2 : 1);

            for (int j = 0; j <= i; j++) {
                part[j][0] -= far * sin(angle[i]);
                part[j][1] += far * cos(angle[i]);
            }
            bias[0] -= far * rate[i] * rate[i] * cos(angle[i]);
            bias[1] -= far * rate[i] * rate[i] * sin(angle[i]);
        }
        for (int j = 0; j <= k; j++) {
            for (int l = 0; l <= k; l++)
                M[rod[j]][rod[l]] += joint->inertia[2] + joint->mass * (part[j][0] * part[l][0] +
                                                                        part[j][1] * part[l][1]);
            h[rod[j]] -= joint->mass * (part[j][0] * bias[0] + part[j][1] * (bias[1] + GRAVITY));
        }
    }
}

static void find_rows(const Model *m, const double *q, const double *u, double M[MOST][MOST],
                      double *h)
{
    static const double weight[3] = {0, -GRAVITY, 0};

    memset(M, 0, sizeof(double) * MOST * MOST);
    for (int i = 0; i < m->count; i++) {
        const Joint *joint = &m->at[i];
        double at[3], push[3];

        h[i] = joint->effort - joint->stiffness * (q[i] - joint->rest);
        if (joint->kind == SLIDE) {
            M[i][i] = joint->mass;
            h[i] += joint->mass * dot(weight, joint->axis);
        } else if (joint->kind == HINGE) {
            const double along = dot(joint->axis, joint->arm);

            turn(joint->axis, q[i], joint->arm, at);
            cross(joint->axis, at, push);
            M[i][i] = joint->mass * (dot(joint->arm, joint->arm) - along * along);
            for (int k = 0; k < 3; k++)
                M[i][i] += joint->inertia[k] * joint->axis[k] * joint->axis[k];
            h[i] += joint->mass * dot(weight, push);
        }
    }
    add_chain(m, q, u, M, h);
}

/* q, J, what is left of q'' at w' = 0, and the slopes of each that follows, from the free ones */
typedef struct Motion {
    double q[MOST], u[MOST], J[MOST][FREE], bend[MOST], slope[MOST][MOST];
} Motion;

static void follow(const Model *m, const double *free, const double *w, Motion *out)
{
    memset(out, 0, sizeof *out);
    for (int i = 0; i < m->count; i++) {
        const Joint *joint = &m->at[i];
        const int a = joint->first, b = joint->second;

        if (i < m->free) {
            out->q[i] = free[i];
            out->J[i][i] = 1;
        } else {
            const double x = out->q[a];
            const double value[] = {x, sin(x), x * x}, slope[] = {1, cos(x), 2 * x},
                         second[] = {0, -sin(x), 2};

            out->q[i] = joint->c + joint->r1 * value[joint->law];
            out->slope[i][a] += joint->r1 * slope[joint->law];
            out->bend[i] = joint->r1 * (slope[joint->law] * out->bend[a] +
                                        second[joint->law] * out->u[a] * out->u[a]);
            if (b >= 0) {
                out->q[i] += joint->r2 * out->q[b];
                out->slope[i][b] += joint->r2;
                out->bend[i] += joint->r2 * out->bend[b];
            }
            for (int k = 0; k < m->free; k++)
                for (int j = 0; j < i; j++)
                    out->J[i][k] += out->slope[i][j] * out->J[j][k];
        }
        for (int k = 0; k < m->free; k++)
            out->u[i] += out->J[i][k] * w[k];
    }
}

/* by elimination: the matrix is positive definite */
static void solve(double a[FREE][FREE], double *b, int n)
{
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++) {
            const double factor = a[i][k] / a[k][k];

            for (int j = k; j < n; j++)
                a[i][j] -= factor * a[k][j];
            b[i] -= factor * b[k];
        }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++)
            b[i] -= a[i][j] * b[j];
        b[i] /= a[i][i];
    }
}

/* w', all q'', and the efforts */
static void accelerate(const Model *m, const double *free, const double *w, double *rate,
                       double *second, double *effort)
{
    double M[MOST][MOST] = {{0}}, h[MOST] = {0}, a[FREE][FREE] = {{0}}, left[MOST];
    Motion motion;

    follow(m, free, w, &motion);
    find_rows(m, motion.q, motion.u, M, h);
    for (int k = 0; k < m->free; k++)
        rate[k] = 0;
    for (int i = 0; i < m->count; i++) {
        left[i] = h[i];
        for (int j = 0; j < m->count; j++)
            left[i] -= M[i][j] * motion.bend[j];
        for (int k = 0; k < m->free; k++) {
            rate[k] += motion.J[i][k] * left[i];
            for (int j = 0; j < m->count; j++)
                for (int l = 0; l < m->free; l++)
                    a[k][l] += motion.J[i][k] * M[i][j] * motion.J[j][l];
        }
    }
    solve(a, rate, m->free);
    for (int i = 0; i < m->count; i++) {
        second[i] = motion.bend[i];
        for (int k = 0; k < m->free; k++)
            second[i] += motion.J[i][k] * rate[k];
    }
    for (int i = m->count - 1; i >= 0; i--) {
        effort[i] = -h[i];
        for (int j = 0; j < m->count; j++)
            effort[i] += M[i][j] * second[j];
        for (int k = i + 1; k < m->count; k++)
            effort[i] += effort[k] * motion.slope[k][i];
    }
}

/* the free ones after a time: Runge and Kutta's steps, small ones */
static void go(const Model *m, double time, double *free, double *w)
{
    enum { STEPS = 2000 };
    const double h = time / STEPS, part[4] = {0, h / 2, h / 2, h};
    double unused[MOST], also[MOST];

    for (int s = 0; s < STEPS; s++) {
        double dq[4][FREE] = {{0}}, dw[4][FREE] = {{0}}, q[FREE] = {0}, v[FREE] = {0};

        for (int k = 0; k < 4; k++) {
            for (int i = 0; i < m->free; i++) {
                q[i] = free[i] + (k > 0 ? part[k] * dq[k - 1][i] : 0);
                v[i] = w[i] + (k > 0 ? part[k] * dw[k - 1][i] : 0);
                dq[k][i] = v[i];
            }
            accelerate(m, q, v, dw[k], unused, also);
        }
        for (int i = 0; i < m->free; i++) {
            free[i] += h / 6 * (dq[0][i] + 2 * dq[1][i] + 2 * dq[2][i] + dq[3][i]);
            w[i] += h / 6 * (dw[0][i] + 2 * dw[1][i] + 2 * dw[2][i] + dw[3][i]);
        }
    }
}

/* --- drawn --- */

static void draw_axis(Member *member, const Model *m, Joint *joint)
{
    double length;

    do {
        for (int k = 0; k < 3; k++)
            joint->axis[k] = member_between(member, -1, 1);
        if (m->planar && joint->kind == SLIDE)
            joint->axis[2] = 0;
        if (m->planar && joint->kind == HINGE)
            joint->axis[0] = joint->axis[1] = 0;
        length = sqrt(dot(joint->axis, joint->axis));
    } while (length < 0.1);
    if (m->planar && joint->kind == HINGE)
        length = joint->axis[2]; /* about z */
    for (int k = 0; k < 3; k++)
        joint->axis[k] /= length;
}

static void draw_law(Member *member, const Model *m, int i, Joint *joint)
{
    joint->first = member_one_of(member, i);
    joint->second = i > 1 && member_one_of(member, 3) == 0 ? member_one_of(member, i) : -1;
    if (joint->second == joint->first)
        joint->second = -1;
    joint->law = member_one_of(member, 2) == 0 ? (Law)member_one_of(member, 3) : LINE;
    /* a square of a square grows too large to be of use */
    if (joint->law == SQUARE && joint->first >= m->free)
        joint->law = LINE;
    joint->c = member_one_of(member, 2) == 0 ? member_between(member, -1, 1) : 0;
    joint->r1 = member_between(member, -2, 2);
    joint->r2 = member_between(member, -1, 1);
}

static void draw(Member *member, Model *m)
{
    int links = 0;

    *m = (Model){.planar = member_one_of(member, 2) == 0};
    m->count = 2 + member_one_of(member, MOST - 1);
    m->free = 1 + member_one_of(member, m->count - 1 < FREE ? m->count - 1 : FREE);
    for (int i = 0; i < m->count; i++) {
        Joint *joint = &m->at[i];

        *joint = (Joint){.kind = (Kind)member_one_of(member, 3), .first = -1, .second = -1};
        joint->mass = member_decades(member, 0.2, 5);
        joint->length = member_between(member, 0.2, 1);
        for (int k = 0; k < 3; k++) {
            joint->inertia[k] = member_between(member, 0.5, 0.9); /* of a body that there can be */
            joint->arm[k] = m->planar && k == 2 ? 0 : member_between(member, -0.5, 0.5);
        }
        joint->effort = member_between(member, -5, 5);
        if (member_one_of(member, 3) == 0) {
            joint->stiffness = member_decades(member, 1, 100);
            joint->rest = member_between(member, -1, 1);
        }
        if (joint->kind == CHAIN)
            joint->link = links++;
        else
            draw_axis(member, m, joint);
        if (i >= m->free)
            draw_law(member, m, i, joint);
        m->q[i] = member_between(member, -2, 2);
        m->u[i] = member_between(member, -2, 2);
    }
}

/* --- told --- */

typedef struct Script {
    char text[8192];
    size_t length;
} Script;

__attribute__((format(printf, 2, 3))) static void say(Script *script, const char *format, ...)
{
    const size_t room = sizeof script->text - script->length;
    va_list arguments;

    va_start(arguments, format);
    const int more = vsnprintf(script->text + script->length, room, format, arguments);
    va_end(arguments);
    if (more > 0)
        script->length += (size_t)more < room ? (size_t)more : room - 1;
}

static void say_vector(Script *script, const Model *m, const double v[3], double sign)
{
    say(script, "[%.17g, %.17g", sign * v[0], sign * v[1]);
    if (!m->planar)
        say(script, ", %.17g", sign * v[2]);
    say(script, "]");
}

static void say_joint(Script *script, const Model *m, int i)
{
    const Joint *joint = &m->at[i];
    const double half[3] = {joint->length / 2, 0, 0};

    if (m->planar)
        say(script, "body b%d mass=%.17g inertia=%.17g\n", i, joint->mass, joint->inertia[2]);
    else
        say(script, "body b%d mass=%.17g inertia=[%.17g, %.17g, %.17g]\n", i, joint->mass,
            joint->inertia[0], joint->inertia[1], joint->inertia[2]);
    if (joint->kind == SLIDE) {
        say(script, "prismatic h%d ground b%d axis=", i, i);
        say_vector(script, m, joint->axis, 1);
    } else if (joint->kind == HINGE) {
        say(script, "arm r%d b%d ", i, i);
        say_vector(script, m, joint->arm, -1);
        say(script, "\nrevolute h%d ground r%d axis=", i, i);
        if (m->planar)
            say(script, "z");
        else
            say_vector(script, m, joint->axis, 1);
    } else {
        say(script, "arm near%d b%d ", joint->link, i);
        say_vector(script, m, half, -1);
        say(script, "; arm far%d b%d ", joint->link, i);
        say_vector(script, m, half, 1);
        if (joint->link > 0)
            say(script, "\nrevolute h%d far%d near%d", i, joint->link - 1, joint->link);
        else
            say(script, "\nrevolute h%d ground near%d", i, joint->link);
    }
    say(script, "\nactuator a%d h%d %s=%.17g\n", i, i, joint->kind == SLIDE ? "force" : "torque",
        joint->effort);
    if (joint->stiffness > 0)
        say(script, "spring k%d h%d k=%.17g rest=%.17g\n", i, i, joint->stiffness, joint->rest);
}

static void say_law(Script *script, const Model *m, int i)
{
    static const char *const ahead[] = {"", "sin(", "("};
    static const char *const behind[] = {"", ")", ")^2"};
    const Joint *joint = &m->at[i];

    say(script, "coupler C%d h%d = %.17g + %.17g*%sh%d%s", i, i, joint->c, joint->r1,
        ahead[joint->law], joint->first, behind[joint->law]);
    if (joint->second >= 0)
        say(script, " + %.17g*h%d", joint->r2, joint->second);
    say(script, "\n");
}

/* --- held against each other --- */

static bool near(Member *member, Kit *kit, const char *what, int i, double wanted, double bound)
{
    char name[32], claim[128];
    const double got = ((void)snprintf(name, sizeof name, what, i), kit_value(kit, name));

    (void)snprintf(claim, sizeof claim, "%s is %.12g, wanted %.12g", name, got, wanted);
    return keeps(member, claim, fabs(got - wanted), bound);
}

static bool start_is_right(Member *member, Kit *kit, const Model *m)
{
    double rate[FREE], second[MOST], effort[MOST], size = 1;
    Motion motion;
    bool holds = true;

    follow(m, m->q, m->u, &motion);
    accelerate(m, m->q, m->u, rate, second, effort);
    for (int i = 0; i < m->count; i++)
        size = fmax(size, fmax(fabs(second[i]), fabs(effort[i])));
    for (int i = 0; i < m->count; i++) {
        holds = near(member, kit, "h%d", i, motion.q[i], 1e-9 * size) && holds;
        holds = near(member, kit, "h%d'", i, motion.u[i], 1e-9 * size) && holds;
        holds = near(member, kit, "h%d''", i, second[i], 1e-8 * size) && holds;
        if (i >= m->free)
            holds = near(member, kit, "C%d.effort", i, effort[i], 1e-8 * size) && holds;
        /* a bearing takes no moment about its axis, whatever couples it */
        if (m->planar && m->at[i].kind != SLIDE)
            holds = near(member, kit, "h%d.Tz", i, 0, 1e-8 * size) && holds;
    }
    return holds;
}

static bool end_is_right(Member *member, Kit *kit, const Model *m, double time)
{
    double free[FREE], w[FREE], size = 1;
    Motion motion;
    bool holds = true;

    memcpy(free, m->q, sizeof free);
    memcpy(w, m->u, sizeof w);
    go(m, time, free, w);
    follow(m, free, w, &motion);
    for (int i = 0; i < m->count; i++)
        size = fmax(size, fmax(fabs(motion.q[i]), fabs(motion.u[i])));
    for (int i = 0; i < m->count; i++)
        holds = near(member, kit, "h%d", i, motion.q[i], 1e-6 * size) && holds;
    return holds;
}

static Verdict coupled_joints_move_as_by_hand(Member *member)
{
    static const char *const trees[] = {"", "tree joint\n", "tree absolute\n"};
    Script script = {.length = 0};
    Kit kit = kit_new();
    Model m;
    bool tells_all, holds;
    Motion motion;

    draw(member, &m);
    follow(&m, m.q, m.u, &motion);
    tells_all = member_one_of(member, 2) == 0;
    say(&script, "scene %s; gravity [0, %g%s]\n", m.planar ? "planar" : "spatial", -GRAVITY,
        m.planar ? "" : ", 0");
    for (int i = 0; i < m.count; i++)
        say_joint(&script, &m, i);
    for (int i = m.free; i < m.count; i++)
        say_law(&script, &m, i);
    for (int i = 0; i < (tells_all ? m.count : m.free); i++)
        say(&script, "init h%d = %.17g\n", i, motion.q[i]);
    for (int i = 0; i < m.free; i++)
        say(&script, "init h%d' = %.17g\n", i, motion.u[i]);
    say(&script, "%s", trees[member_one_of(member, 3)]);
    if (member_one_of(member, 4) == 0)
        say(&script, "form embedded\n");
    tell(member, "%s", script.text);
    if (kit_do(&kit, script.text) != CT_OK || kit_do(&kit, "assemble\n") != CT_OK) {
        tell(member, "%s (%s)\n", kit.error.message, kit.error.hint);
        kit_free(&kit);
        return REFUSED;
    }
    holds = start_is_right(member, &kit, &m);
    if (holds && member_one_of(member, 3) == 0) {
        if (kit_do(&kit, "simulate 0.3 every=0.1\n") != CT_OK) {
            tell(member, "%s (%s)\n", kit.error.message, kit.error.hint);
            kit_free(&kit);
            return REFUSED;
        }
        holds = end_is_right(member, &kit, &m, 0.3);
    }
    kit_free(&kit);
    return holds ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        /* in absolute coordinates an angle is known up to whole turns where a start is searched
         * for: some aren't found, and are said not to be */
        {"coupled_joints_move_as_by_hand", 60, 0.03, 0, coupled_joints_move_as_by_hand},
    };

    return family_main(families, (int)(sizeof families / sizeof *families), argc, argv);
}
