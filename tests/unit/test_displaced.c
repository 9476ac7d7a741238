/* test_displaced.c: a joint that a virtual branch took the place of carries what it carries in
 * joint coordinates, and so do all others
 *
 * The same values of the joints' own coordinates start every choice of trees. */
#include "session_kit.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

static const char *const members[] = {"fx", "fy", "fz", "tx", "ty", "tz"};

enum { MEMBERS = sizeof members / sizeof members[0], MOST_JOINTS = 12 };

typedef struct Reactions {
    double at[MOST_JOINTS * MEMBERS];
    int count;
    double largest;
} Reactions;

/* of joints h1, h2 ... */
static Reactions reactions_of(Kit *kit, int first, int joints)
{
    Reactions out = {.largest = 1e-3};

    for (int j = 0; j < joints; j++)
        for (int k = 0; k < MEMBERS; k++) {
            char name[32];
            double value;

            (void)snprintf(name, sizeof name, "h%d.%s", first + j, members[k]);
            value = kit_value(kit, name);
            if (isnan(value)) {
                test_faults++;
                printf("%s: %s\n", name, kit->error.message);
            }
            out.largest = fmax(out.largest, fabs(value));
            out.at[out.count++] = value;
        }
    return out;
}

static void expect_alike(const Reactions *got, const Reactions *wanted)
{
    for (int i = 0; i < wanted->count; i++)
        EXPECT_NEAR(got->at[i] / wanted->largest, wanted->at[i] / wanted->largest, 1e-9);
}

/* assembled at `start` in the trees of `joint` and of `other` */
static void compare_trees(const char *scene, int first, int joints, const char *start,
                          const char *joint, const char *other)
{
    Kit kit = kit_new();
    Reactions wanted, got;
    int faults = test_faults;

    EXPECT_DONE(&kit, scene);
    EXPECT_DONE(&kit, joint);
    EXPECT_DONE(&kit, start);
    EXPECT_DONE(&kit, "assemble\n");
    wanted = reactions_of(&kit, first, joints);
    EXPECT_DONE(&kit, other);
    EXPECT_DONE(&kit, start);
    EXPECT_DONE(&kit, "assemble\n");
    got = reactions_of(&kit, first, joints);
    expect_alike(&got, &wanted);
    if (test_faults > faults)
        printf("%s%s%s", scene, start, other);
    kit_free(&kit);
}

/* `init h1 = ..., h1' = ...` of some joints */
static void random_start(uint64_t *random, int first, int joints, const char *prefix, Text *text)
{
    for (int j = first; j < first + joints; j++)
        text_addf(text, "init %s%d = %.4f, %s%d' = %.4f\n", prefix, j,
                  test_uniform(random, -3.0, 3.0), prefix, j, test_uniform(random, -3.0, 3.0));
}

/* scripts/paper/2_serial_indirect */
#define SERIAL                                                                                     \
    "gravity [0, 0, -9.81]\n"                                                                      \
    "L6 = 0.15 m; L7 = 0.25 m; L8 = 0.20 m; L9 = 0.22 m\n"                                         \
    "body m1 mass=4 inertia=[0.05, 0.05, 0.05]\n"                                                  \
    "body m2 mass=3 inertia=[0.004, 0.05, 0.052]\n"                                                \
    "body m3 mass=2 inertia=[0.003, 0.03, 0.031]\n"                                                \
    "arm r6 m1 [L6, 0, 0] rotation=x(90 deg)\n"                                                    \
    "arm r7 m2 [-L7, 0, 0]\narm r8 m2 [L8, 0, 0]\narm r9 m3 [-L9, 0, 0]\n"                         \
    "revolute h12 ground m1 axis=z coord=beta12\n"                                                 \
    "revolute h13 r6 r7 axis=z coord=beta13\n"                                                     \
    "revolute h14 r8 r9 axis=z coord=beta14\n"                                                     \
    "virtual revolute vh16 r6 m3 axis=z coord=beta16\n"

static void joints_of_the_serial_manipulator_carry_the_same(void)
{
    uint64_t random = 16;

    for (int i = 0; i < 6; i++) {
        Text start = {0};

        random_start(&random, 12, 3, "beta", &start);
        compare_trees(SERIAL, 12, 3, start.at, "tree joint\n", "tree + vh16 - h14\n");
        text_free(&start);
    }
}

/* elbow and wrist of an arm that leans and turns, both displaced, with springs, a motor's torque
 * and a load; the circuits of the two virtual joints share the elbow */
#define LEANING                                                                                    \
    "gravity [0.3, 0, -9.81]\n"                                                                    \
    "body b1 mass=4 inertia=[0.05, 0.06, 0.07, 0.01, 0, 0.02]\n"                                   \
    "body b2 mass=3 inertia=[0.02, 0.05, 0.052]\n"                                                 \
    "body b3 mass=2 inertia=[0.03, 0.03, 0.031, 0, 0.01, 0]\n"                                     \
    "body b4 mass=1 inertia=[0.01, 0.03, 0.021]\n"                                                 \
    "arm g ground [0.1, 0.2, 0.3] rotation=y(0.4)\narm p1 b1 [0, 0, -0.3]\n"                       \
    "arm q1 b1 [0.2, 0, 0.1] rotation=x(1.2)\narm p2 b2 [-0.3, 0.1, 0.05]\n"                       \
    "arm q2 b2 [0.3, 0, 0.1]\narm p3 b3 [-0.2, 0, 0]\narm q3 b3 [0.2, 0.1, 0]\n"                   \
    "arm p4 b4 [-0.2, 0, 0.1]\narm tip b4 [0.2, 0, 0]\n"                                           \
    "revolute h1 g p1 axis=z\nrevolute h2 q1 p2 axis=z\nrevolute h3 q2 p3 axis=z\n"                \
    "revolute h4 q3 p4 axis=z\n"                                                                   \
    "virtual revolute v13 q1 b3 axis=z\nvirtual revolute v14 q1 b4 axis=z\n"                       \
    "spring k2 h2 k=3 rest=0.2\nforce F tip [5, sin(h1), -3]\n"

static void two_displaced_joints_carry_the_same(void)
{
    static const char *const others[] = {"tree + v13 - h3 + v14 - h4\n",
                                         "tree + v13 - h2 + v14 - h4\n"};
    uint64_t random = 4;

    for (int i = 0; i < 2; i++) {
        Text start = {0};

        random_start(&random, 1, 4, "h", &start);
        compare_trees(LEANING, 1, 4, start.at, "tree joint\n", others[i]);
        text_free(&start);
    }
}

/* a driver at a displaced joint works as at a branch */
static void a_driven_displaced_joint_carries_the_same(void)
{
    static const char start[] = "init h1 = 0.3, h2 = 0.4, h4 = -0.3, h1' = 1, h2' = 2, h4' = -1\n";

    compare_trees(LEANING "driver d3 h3 = 0.2 + 2*t - t^2\n", 1, 4, start, "tree joint\n",
                  "tree + v13 - h3\n");
}

/* --- chains with parallel axes, with virtual hinges across them --- */

typedef struct OrientationClass {
    int bodies;
    Text scene;
    int between[MOST_JOINTS][2]; /* frames of virtual joints, bodies by number, -1 ground */
} OrientationClass;

static void body_frame(int body, char name[16])
{
    if (body < 0)
        (void)snprintf(name, 16, "ground");
    else
        (void)snprintf(name, 16, "b%d", body);
}

static void build_chain(OrientationClass *chain, uint64_t *random)
{
    static const char *const kinds[] = {"revolute", "revolute", "cylindrical", "screw"};
    Text *text = &chain->scene;
    char axis[64];

    chain->bodies = 3 + (int)(test_random(random) % 5);
    (void)snprintf(axis, sizeof axis, "[%.2f, %.2f, 0.8]", test_uniform(random, -1.0, 1.0),
                   test_uniform(random, -1.0, 1.0));
    text_add(text, "gravity [1, 2, -9.81]\n");
    for (int i = 0; i < chain->bodies; i++) {
        char tail[16];
        const char *kind = kinds[test_random(random) % 4];

        (void)snprintf(tail, sizeof tail, "q%d", i - 1);
        text_addf(text, "body b%d mass=%.3f inertia=[0.3, 0.4, 0.5, 0.01, 0.02, 0.03]\n", i,
                  test_uniform(random, 0.5, 2.0));
        text_addf(text, "arm p%d b%d [%.3f, 0.2, -0.1]\narm q%d b%d [0.1, %.3f, 0.3]\n", i, i,
                  test_uniform(random, -0.5, 0.5), i, i, test_uniform(random, -0.5, 0.5));
        text_addf(text, "%s h%d %s p%d axis=%s", kind, i, i > 0 ? tail : "ground", i, axis);
        if (strcmp(kind, "cylindrical") == 0)
            text_addf(text, " coords=[s%d, a%d]\n", i, i);
        else
            text_addf(text, " coord=a%d%s\n", i, strcmp(kind, "screw") == 0 ? " pitch=0.2" : "");
    }
    /* from a frame to one further out, two joints and more away */
    for (int i = 1; i < chain->bodies; i++) {
        int from = (int)(test_random(random) % (uint64_t)i) - 1;
        char tail[16], head[16];

        body_frame(from, tail);
        body_frame(i, head);
        text_addf(text, "virtual revolute v%d %s %s axis=%s\n", i, tail, head, axis);
    }
}

/* v3 in the place of h3, now and then: each leads to the body that the other led to */
static void displace(const OrientationClass *chain, uint64_t *random, Text *text)
{
    for (int i = 1; i < chain->bodies; i++) {
        char screw[24];

        (void)snprintf(screw, sizeof screw, "screw h%d ", i);
        if (strstr(chain->scene.at, screw) == NULL && test_random(random) % 3 > 0)
            text_addf(text, "%s + v%d - h%d", text->length > 0 ? "" : "tree rotation", i, i);
    }
}

static void joints_of_parallel_chains_carry_the_same(void)
{
    uint64_t random = 77;

    for (int i = 0; i < 6 && test_faults == 0; i++) {
        OrientationClass chain = {0};
        Text start = {0}, trees = {0};

        build_chain(&chain, &random);
        random_start(&random, 0, chain.bodies, "a", &start);
        displace(&chain, &random, &trees);
        text_char(&trees, '\n');
        compare_trees(chain.scene.at, 0, chain.bodies, start.at, "tree joint\n", trees.at);
        text_free(&chain.scene);
        text_free(&start);
        text_free(&trees);
    }
}

/* --- what no trees determine --- */

/* three hinges about z in a closed loop in space: what acts out of its plane has no one answer */
#define PLANE_LOOP                                                                                 \
    "body c mass=1 inertia=[0.1, 0.1, 0.1]\nbody r mass=2 inertia=[0.1, 0.3, 0.3]\n"               \
    "body o mass=1 inertia=[0.1, 0.1, 0.1]\ngravity [0, -9.81, 0]\n"                               \
    "arm ca c [0.5, 0, 0]\narm ra r [1.5, 0, 0]\narm oa o [1, 0, 0]\narm g ground [1.2, 0, 0]\n"   \
    "revolute h1 ground c axis=z\nrevolute h2 ca r axis=z\nrevolute h3 g o axis=z\n"               \
    "revolute h4 ra oa axis=z\nvirtual revolute v ground r axis=z\n"                               \
    "init h1 = 1, h1' = 2\nguess h2 = -0.7, h3 = 1.4, v = 0.3\n"

static void only_what_is_redundant_is_refused(void)
{
    static const char *const told[] = {"fx", "fy", "tz"};
    static const char *const refused[] = {"fz", "tx", "ty"};
    Kit plane = kit_new(), kit = kit_new();

    EXPECT_DONE(&plane, "scene planar\ngravity [0, -9.81]\nbody c mass=1 inertia=0.1\n"
                        "body r mass=2 inertia=0.3\nbody o mass=1 inertia=0.1\n"
                        "arm ca c [0.5, 0]\narm ra r [1.5, 0]\narm oa o [1, 0]\n"
                        "arm g ground [1.2, 0]\nrevolute h1 ground c\nrevolute h2 ca r\n"
                        "revolute h3 g o\nrevolute h4 ra oa\ntree joint\n"
                        "init h1 = 1, h1' = 2\nguess h2 = -0.7, h3 = 1.4\nassemble\n");
    EXPECT_DONE(&kit, PLANE_LOOP "tree h1 h2 h3\ntree rotation + v - h2\nassemble\n");
    for (int j = 1; j <= 4; j++)
        for (int k = 0; k < 3; k++) {
            char name[16];

            (void)snprintf(name, sizeof name, "h%d.%s", j, told[k]);
            EXPECT_NEAR(kit_value(&kit, name), kit_value(&plane, name), 1e-8);
            (void)snprintf(name, sizeof name, "h%d.%s", j, refused[k]);
            EXPECT(isnan(kit_value(&kit, name)));
            EXPECT_HOLDS(kit.error.message, "isn't determined");
            EXPECT_HOLDS(kit.error.hint, "tree absolute");
        }
    kit_free(&plane);
    kit_free(&kit);
}

int main(void)
{
    RUN(joints_of_the_serial_manipulator_carry_the_same);
    RUN(two_displaced_joints_carry_the_same);
    RUN(a_driven_displaced_joint_carries_the_same);
    RUN(joints_of_parallel_chains_carry_the_same);
    RUN(only_what_is_redundant_is_refused);
    return test_end();
}
