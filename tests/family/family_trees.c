/* family_trees.c: accelerations of random trees of joints, by every way along the trees that a
 * program may take, against point masses
 *
 * The other side knows no rigid bodies, recursion or mass matrix: six points stand for each body,
 * their places are differentiated by differences in 64 digits of binary, and the equations are
 * those of d'Alembert for points. */
#include "family.h"
#include "trees.h"

#include "base/memory.h"
#include "base/text.h"

enum { MOST_BODIES = 7, MOST_SPEEDS = 2 * MOST_BODIES, POINTS = 6 };

typedef enum Kind { REVOLUTE, PRISMATIC, CYLINDRICAL, UNIVERSAL, SCREW, KINDS } Kind;
typedef long double Real;

typedef struct Joint {
    Kind kind;
    int parent;                          /* -1: ground */
    bool back;                           /* the body is the tail */
    double axis[2][3], place[3], own[3]; /* on the parent, on the body */
    double pitch, stiffness, damping;
    int first; /* coordinate */
} Joint;

typedef struct Body {
    Joint joint;
    double mass, inertia[3], push[3];
} Body;

typedef struct TreeCase {
    int bodies, n;
    Body body[MOST_BODIES];
    double g[3], q[MOST_SPEEDS], u[MOST_SPEEDS];
    char name[MOST_SPEEDS][16];
    bool is_planar;
    int rotor_on; /* the body whose angle against ground turns a motor's rotor; -1: none */
    double rotor;
} TreeCase;

/* --- drawn --- */

static double round_to(double x)
{
    return round(x * 1000) / 1000;
}

static void draw_axis(Member *member, const TreeCase *c, double axis[3])
{
    const int k = c->is_planar ? 2 : member_one_of(member, 3);

    memset(axis, 0, 3 * sizeof *axis);
    axis[k] = c->is_planar || member_one_of(member, 2) == 0 ? 1 : -1;
    if (!c->is_planar && member_one_of(member, 4) == 0) { /* askew: 3, 4, 5 or 1, 2, 2, 3 */
        static const double askew[][3] = {{0.6, 0.8, 0}, {0, -0.6, 0.8}, {0.28, 0, 0.96}};

        memcpy(axis, askew[member_one_of(member, COUNT(askew))], 3 * sizeof *axis);
    }
}

static void draw_place(Member *member, const TreeCase *c, double place[3])
{
    for (int i = 0; i < 3; i++)
        place[i] = member_one_of(member, 2) == 0 || (c->is_planar && i == 2)
                       ? 0
                       : round_to(member_between(member, -1, 1));
}

static void draw_joint(Member *member, TreeCase *c, int i)
{
    Joint *joint = &c->body[i].joint;
    const bool follows = i > 0 && member_one_of(member, 2) == 0;
    static const char *const ends[KINDS][2] = {
        [CYLINDRICAL] = {".s", ".theta"}, [UNIVERSAL] = {".a1", ".a2"}, [SCREW] = {".theta"}};

    joint->kind = (Kind)(member_one_of(member, 3) > 0 ? REVOLUTE : member_one_of(member, KINDS));
    if (c->is_planar && joint->kind > PRISMATIC)
        joint->kind = REVOLUTE;
    joint->parent = i == 0 || member_one_of(member, 4) > 0 ? i - 1 : member_one_of(member, i) - 1;
    joint->back = member_one_of(member, 4) == 0;
    draw_axis(member, c, joint->axis[0]);
    if (follows) /* parallel to the one before */
        memcpy(joint->axis[0], c->body[i - 1].joint.axis[0], sizeof joint->axis[0]);
    if (c->is_planar && joint->kind == PRISMATIC) {
        joint->axis[0][0] = 0.6, joint->axis[0][1] = 0.8, joint->axis[0][2] = 0;
        if (member_one_of(member, 2) == 0)
            joint->axis[0][0] = 1, joint->axis[0][1] = 0;
    }
    if (c->is_planar && joint->kind == REVOLUTE)
        joint->axis[0][0] = joint->axis[0][1] = 0, joint->axis[0][2] = 1;
    if (joint->kind == UNIVERSAL) {
        const int k = member_one_of(member, 3);

        memset(joint->axis, 0, sizeof joint->axis);
        joint->axis[0][k] = joint->axis[1][(k + 1) % 3] = 1;
    }
    draw_place(member, c, joint->place);
    draw_place(member, c, joint->own);
    joint->pitch = 0.3;
    joint->stiffness = member_one_of(member, 4) == 0 ? round_to(member_between(member, 1, 9)) : 0;
    joint->damping = joint->stiffness > 0 ? 0.25 : 0;
    joint->first = c->n;
    for (int k = 0; k < 1 + (joint->kind == CYLINDRICAL || joint->kind == UNIVERSAL); k++) {
        const char *end = ends[joint->kind][k];

        (void)snprintf(c->name[c->n], sizeof c->name[0], "j%d%s", i, end == NULL ? "" : end);
        c->q[c->n] = round_to(member_between(member, -1.5, 1.5));
        c->u[c->n++] = round_to(member_between(member, -2, 2));
    }
}

static void draw(Member *member, TreeCase *c)
{
    *c = (TreeCase){.is_planar = member_one_of(member, 3) == 0};
    c->bodies = 1 + member_one_of(member, MOST_BODIES);
    for (int i = 0; i < c->bodies; i++) {
        Body *body = &c->body[i];
        const double across = round_to(member_between(member, 0.2, 0.4));

        draw_joint(member, c, i);
        body->mass = round_to(member_decades(member, 0.3, 10));
        for (int k = 0; k < 3; k++)
            body->inertia[k] = round_to(member_between(member, 0.25, 0.45));
        if (member_one_of(member, 3) == 0)
            body->inertia[0] = body->inertia[1] = across;
        if (i + 1 < c->bodies && member_one_of(member, 6) == 0) /* its joints move the next one */
            body->mass = body->inertia[0] = body->inertia[1] = body->inertia[2] = 0;
        for (int k = 0; k < (c->is_planar ? 2 : 3) && member_one_of(member, 3) == 0; k++)
            body->push[k] = round_to(member_between(member, -5, 5));
    }
    /* and there is one: nothing else hangs on the last body of a branch */
    for (int i = 0; i < c->bodies; i++) {
        bool is_last = true;

        for (int k = i + 1; k < c->bodies; k++)
            is_last = is_last && c->body[k].joint.parent != i;
        if (is_last && c->body[i].mass == 0) {
            c->body[i].mass = 1;
            c->body[i].inertia[0] = c->body[i].inertia[1] = c->body[i].inertia[2] = 0.3;
        }
    }
    c->rotor_on =
        c->is_planar && member_one_of(member, 3) == 0 ? member_one_of(member, c->bodies) : -1;
    c->rotor = round_to(member_between(member, 0.1, 2));
    c->g[c->is_planar ? 1 : 2] = -9.81;
    c->g[0] = member_one_of(member, 2) == 0 ? 0 : 1.5;
}

/* --- as points --- */

typedef struct Pose {
    Real p[3], R[9];
} Pose;

static void times(const Real *R, const Real *v, Real *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = R[3 * i] * v[0] + R[3 * i + 1] * v[1] + R[3 * i + 2] * v[2];
}

static void multiply(const Real *A, const Real *B, bool transposed, Real *out)
{
    Real C[9];

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            C[3 * i + j] = 0;
            for (int k = 0; k < 3; k++)
                C[3 * i + j] += A[3 * i + k] * (transposed ? B[3 * j + k] : B[3 * k + j]);
        }
    memcpy(out, C, sizeof C);
}

static void turned(const double *axis, Real angle, Real *R)
{
    const Real s = sinl(angle), v = 1 - cosl(angle);
    const Real x = axis[0], y = axis[1], z = axis[2];
    const Real K[9] = {0, -z, y, z, 0, -x, -y, x, 0};
    Real K2[9];

    multiply(K, K, false, K2);
    for (int i = 0; i < 9; i++)
        R[i] = (i % 4 == 0) + s * K[i] + v * K2[i];
}

/* of all bodies */
static void poses(const TreeCase *c, const Real *q, Pose *out)
{
    static const Pose ground = {{0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};

    for (int i = 0; i < c->bodies; i++) {
        const Joint *joint = &c->body[i].joint;
        const Pose *parent = joint->parent < 0 ? &ground : &out[joint->parent];
        Pose *own = &out[i];
        Real turn[9], second[9], slide[3], at[3], shift[3], arm[3], place[3], back[3];
        const bool turns = joint->kind != PRISMATIC;
        const Real first = q[joint->first],
                   angle = joint->kind == CYLINDRICAL ? q[joint->first + 1] : first,
                   along = joint->kind == SCREW ? joint->pitch * first / (2 * acosl(-1))
                           : joint->kind == PRISMATIC || joint->kind == CYLINDRICAL ? first
                                                                                    : 0;

        turned(joint->axis[0], turns ? angle : 0, turn);
        if (joint->kind == UNIVERSAL) {
            turned(joint->axis[1], q[joint->first + 1], second);
            multiply(turn, second, false, turn);
        }
        multiply(parent->R, turn, joint->back, own->R);
        for (int k = 0; k < 3; k++) {
            slide[k] = along * joint->axis[0][k];
            at[k] = joint->place[k];
            arm[k] = joint->own[k];
        }
        times(joint->back ? own->R : parent->R, slide, shift);
        times(parent->R, at, place);
        times(own->R, arm, back);
        for (int k = 0; k < 3; k++)
            own->p[k] = parent->p[k] + place[k] + (joint->back ? -shift[k] : shift[k]) - back[k];
    }
}

/* places of all points, six a body, where they give it its inertia; and the bodies themselves */
static void places(const TreeCase *c, const Real *q, Real (*out)[3], Real (*centre)[3])
{
    Pose pose[MOST_BODIES] = {0};

    poses(c, q, pose);
    for (int i = 0; i < c->bodies; i++) {
        const double *I = c->body[i].inertia;
        const Real m = c->body[i].mass > 0 ? c->body[i].mass / POINTS : 1;

        memcpy(centre[i], pose[i].p, sizeof pose[i].p);
        for (int k = 0; k < POINTS; k++) {
            const int axis = k / 2;
            const Real second = (I[(axis + 1) % 3] + I[(axis + 2) % 3] - I[axis]) / 2;
            Real d[3] = {0}, way[3];

            d[axis] = (k % 2 == 0 ? 1 : -1) * sqrtl(second / (2 * m));
            times(pose[i].R, d, way);
            for (int x = 0; x < 3; x++)
                out[POINTS * i + k][x] = pose[i].p[x] + way[x];
        }
    }
}

enum { MOST_POINTS = POINTS * MOST_BODIES, SIDES = 4 };
#define STEP 0.02L
static const Real slope[SIDES] = {4.0L / 5, -1.0L / 5, 4.0L / 105, -1.0L / 280};
static const Real bend[SIDES] = {8.0L / 5, -1.0L / 5, 8.0L / 315, -1.0L / 560};

/* q + x along a direction */
static void at_step(const TreeCase *c, int only, Real x, Real (*out)[3], Real (*centre)[3])
{
    Real q[MOST_SPEEDS];

    for (int j = 0; j < c->n; j++)
        q[j] = c->q[j] + (only < 0 ? x * c->u[j] : only == j ? x : 0);
    places(c, q, out, centre);
}

typedef Real Points[MOST_POINTS][3];
typedef Real Centres[MOST_BODIES][3];

#define SINGULAR 1e-6L /* what a pivot may be the rest of */

typedef Real Balance[MOST_SPEEDS][MOST_SPEEDS + 1];

/* how a rate turns the rotor */
static void turn_rotor(const TreeCase *c, Real *rate)
{
    for (int i = c->rotor_on; i >= 0; i = c->body[i].joint.parent)
        if (c->body[i].joint.kind == REVOLUTE)
            rate[c->body[i].joint.first] = c->body[i].joint.back ? -1 : 1;
}

/* d'Alembert: sum over points of (m a - f) . dp/dq_j = Q_j, as M and what stands right of it */
static void balance(const TreeCase *c, Balance M)
{
    Real rotor[MOST_SPEEDS] = {0};
    static Points slopes[MOST_SPEEDS], ahead, behind, bends, here;
    static Centres lead[MOST_SPEEDS], off, off2;

    turn_rotor(c, rotor);
    memset(M, 0, sizeof(Balance));
    memset(slopes, 0, sizeof slopes);
    memset(bends, 0, sizeof bends);
    memset(lead, 0, sizeof lead);
    at_step(c, -1, 0, here, off);
    for (int side = 0; side < SIDES; side++)
        for (int j = -1; j < c->n; j++) {
            const Real h = (side + 1) * STEP;

            at_step(c, j, h, ahead, off);
            at_step(c, j, -h, behind, off2);
            for (int p = 0; p < POINTS * c->bodies; p++)
                for (int x = 0; x < 3; x++)
                    if (j < 0)
                        bends[p][x] += bend[side] * (ahead[p][x] - 2 * here[p][x] + behind[p][x]) /
                                       (STEP * STEP);
                    else
                        slopes[j][p][x] += slope[side] * (ahead[p][x] - behind[p][x]) / STEP;
            for (int i = 0; i < c->bodies && j >= 0; i++)
                for (int x = 0; x < 3; x++)
                    lead[j][i][x] += slope[side] * (off[i][x] - off2[i][x]) / STEP;
        }
    for (int j = 0; j < c->n; j++) {
        for (int p = 0; p < POINTS * c->bodies; p++)
            for (int x = 0; x < 3; x++) {
                const Real m = c->body[p / POINTS].mass / POINTS;

                for (int k = 0; k < c->n; k++)
                    M[j][k] += m * slopes[j][p][x] * slopes[k][p][x];
                M[j][c->n] += m * slopes[j][p][x] * (c->g[x] - bends[p][x]);
            }
        for (int i = 0; i < c->bodies; i++) {
            const Joint *joint = &c->body[i].joint;

            for (int x = 0; x < 3; x++)
                M[j][c->n] += c->body[i].push[x] * lead[j][i][x];
            if (joint->first == j)
                M[j][c->n] -= joint->stiffness * c->q[j] + joint->damping * c->u[j];
        }
        for (int k = 0; k < c->n; k++)
            M[j][k] += (Real)c->rotor * rotor[j] * rotor[k];
    }
}

/* False: a speed has next to no inertia of its own. */
static bool by_points(const TreeCase *c, double *out)
{
    static Balance M;
    Real size[MOST_SPEEDS];

    balance(c, M);
    for (int k = 0; k < c->n; k++)
        size[k] = M[k][k];
    for (int k = 0; k < c->n; k++) {
        if (!(M[k][k] > SINGULAR * size[k]))
            return false;
        for (int i = 0; i < c->n; i++) {
            const Real f = i == k ? 0 : M[i][k] / M[k][k];

            for (int j = k; j <= c->n && f != 0; j++)
                M[i][j] -= f * M[k][j];
        }
    }
    for (int k = 0; k < c->n; k++)
        out[k] = (double)(M[k][c->n] / M[k][k]);
    return true;
}

/* what joints take so that these are the accelerations */
static void torques_by_points(const TreeCase *c, const double *acceleration, double *out)
{
    static Balance M;

    balance(c, M);
    for (int j = 0; j < c->n; j++) {
        Real sum = -M[j][c->n];

        for (int k = 0; k < c->n; k++)
            sum += M[j][k] * acceleration[k];
        out[j] = (double)sum;
    }
}

/* --- as cotree has it --- */

static void vector_text(Text *text, const double *v, bool is_planar)
{
    text_addf(text, is_planar ? "[%.17g, %.17g]" : "[%.17g, %.17g, %.17g]", v[0], v[1], v[2]);
}

static char *text_of(const TreeCase *c)
{
    static const char *const words[] = {"revolute", "prismatic", "cylindrical", "universal",
                                        "screw"};
    Text text = {0};

    text_addf(&text, "%sgravity ", c->is_planar ? "scene planar\n" : "");
    vector_text(&text, c->g, c->is_planar);
    text_add(&text, "\n");
    for (int i = 0; i < c->bodies; i++) {
        const Body *body = &c->body[i];
        const Joint *joint = &body->joint;
        char parent[16] = "ground";

        if (joint->parent >= 0)
            (void)snprintf(parent, sizeof parent, "b%d", joint->parent);
        text_addf(&text, "m%d = %.17g\nbody b%d mass=m%d inertia=", i, body->mass, i, i);
        if (c->is_planar)
            text_addf(&text, "%.17g", body->inertia[2]);
        else
            vector_text(&text, body->inertia, false);
        text_addf(&text, "\narm t%d %s ", i, parent);
        vector_text(&text, joint->place, c->is_planar);
        text_addf(&text, "\narm s%d b%d ", i, i);
        vector_text(&text, joint->own, c->is_planar);
        text_addf(&text, "\n%s j%d %c%d %c%d", words[joint->kind], i, joint->back ? 's' : 't', i,
                  joint->back ? 't' : 's', i);
        if (joint->kind == UNIVERSAL) {
            static const char letters[] = "xyz";
            const double *one = joint->axis[0], *two = joint->axis[1];

            text_addf(&text, " axes=[%c, %c]",
                      letters[one[0] != 0   ? 0
                              : one[1] != 0 ? 1
                                            : 2],
                      letters[two[0] != 0   ? 0
                              : two[1] != 0 ? 1
                                            : 2]);
        } else if (!c->is_planar || joint->kind == PRISMATIC) {
            text_add(&text, " axis=");
            vector_text(&text, joint->axis[0], c->is_planar);
        }
        text_addf(&text, joint->kind == SCREW ? " pitch=%.17g\n" : "\n", joint->pitch);
        if (joint->stiffness > 0)
            text_addf(&text, "spring k%d %s k=%.17g d=%.17g\n", i, c->name[joint->first],
                      joint->stiffness, joint->damping);
        if (body->push[0] != 0 || body->push[1] != 0 || body->push[2] != 0) {
            text_addf(&text, "force f%d b%d ", i, i);
            vector_text(&text, body->push, c->is_planar);
            text_add(&text, "\n");
        }
    }
    if (c->rotor_on >= 0)
        text_addf(&text,
                  "virtual revolute v ground b%d\nvsource V a 0 0\n"
                  "motor M v a 0 R=1 Kt=0 J=%.17g\n",
                  c->rotor_on, c->rotor);
    text_add(&text, "tree joint\n");
    return text_done(&text);
}

static bool alike(Member *member, const TreeCase *c, const char *what, const double *found,
                  const double *right)
{
    double largest = 1, error = 0;

    for (int j = 0; j < c->n; j++)
        largest = fmax(largest, fabs(right[j]));
    for (int j = 0; j < c->n; j++) {
        const double off = fabs(found[j] - right[j]);

        error = off <= error ? error : off;
    }
    for (int j = 0; j < c->n && member->told; j++)
        tell(member, "%s: %.12g, %.12g\n", c->name[j], found[j], right[j]);
    return keeps(member, what, error / largest, 1e-9);
}

static bool compare(Member *member, const TreeCase *c, TreesModel *model, bool by_run,
                    const double *right)
{
    double found[MOST_SPEEDS] = {0};
    char what[80];
    bool good = true;

    for (int way = 0; way < (by_run ? 1 : TREES_WAYS); way++) {
        const TreesAnswer answer =
            by_run ? trees_run(model, c->name, c->q, c->u, c->n, found)
                   : trees_way(model, way, c->name, c->q, c->u, c->n, found, what, sizeof what);

        if (answer == TREES_HAVE_NONE)
            return good;
        good = answer == TREES_FOUND && alike(member, c, by_run ? "a run" : what, found, right) &&
               good;
    }
    return good;
}

static Verdict accelerations(Member *member, bool by_run)
{
    TreeCase c;
    double right[MOST_SPEEDS] = {0};
    char *text, message[200] = "";
    TreesModel *model;
    bool good;

    do
        draw(member, &c);
    while (!by_points(&c, right));
    text = text_of(&c);
    tell(member, "%s", text);
    for (int j = 0; j < c.n; j++)
        tell(member, "init %s = %.17g, %s' = %.17g\n", c.name[j], c.q[j], c.name[j], c.u[j]);
    model = trees_open(text, message, sizeof message);
    tell(member, "%s\n", message);
    good = model != NULL && compare(member, &c, model, by_run, right);
    trees_close(model);
    mem_free(text);
    return good ? AGREES : DISAGREES;
}

static Verdict each_way(Member *member)
{
    return accelerations(member, false);
}

static Verdict run(Member *member)
{
    return accelerations(member, true);
}

/* torques of accelerations that are asked for, each way; and of drivers in a run */
static Verdict torques(Member *member)
{
    TreeCase c;
    double asked[MOST_SPEEDS], right[MOST_SPEEDS] = {0}, found[MOST_SPEEDS] = {0};
    char what[80], message[200] = "", *text;
    Text driven = {0};
    TreesModel *model;
    TreesAnswer answer = TREES_FOUND;
    bool good = true;

    do {
        draw(member, &c);
        for (int j = 0; j < c.n; j++)
            asked[j] = round_to(member_between(member, -5, 5));
        torques_by_points(&c, asked, right);
    } while (!isfinite(right[0])); /* no points have such moments of inertia */
    text = text_of(&c);
    text_add(&driven, text);
    for (int j = 0; j < c.n; j++)
        text_addf(&driven, "driver D%d %s = %.17g + %.17g*t + %.17g*t^2/2\n", j, c.name[j], c.q[j],
                  c.u[j], asked[j]);
    tell(member, "%s", driven.at);
    model = trees_open(text, message, sizeof message);
    for (int way = 0; model != NULL && good && way < TREES_TORQUES; way++) {
        answer = trees_torques(model, way, c.name, c.q, c.u, asked, c.n, found, what, sizeof what);
        good = answer == TREES_HAVE_NONE ||
               (answer == TREES_FOUND && alike(member, &c, what, found, right));
    }
    good = good && model != NULL;
    trees_close(model);
    model = good ? trees_open(driven.at, message, sizeof message) : NULL;
    good = model != NULL && trees_driven(model, c.name, c.q, c.u, c.n, found) == TREES_FOUND &&
           alike(member, &c, "drivers", found, right);
    tell(member, "%s\n", message);
    trees_close(model);
    text_free(&driven);
    mem_free(text);
    return good ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"trees: every way along the trees tells the accelerations of points", 60, 0, 0, each_way},
        {"trees: a run finds the accelerations of points", 100, 0, 0, run},
        {"trees: torques of a motion are those of points", 60, 0, 0, torques},
    };

    return family_main(families, COUNT(families), argc, argv);
}
