/* test_counts.c: what the equations of an open chain cost, against figures from outside
 *
 * The three bodies of the manipulator of McPhee, Schmitke and Redmond (2004). The bounds after
 * sharing are what a general-purpose routine leaves of the same equations when they are
 * simplified, expanded and searched for common subexpressions. */
#include "scene.h"

#define BODIES                                                                                     \
    "L6 = 0.15 m; L7 = 0.25 m; L8 = 0.2 m; L9 = 0.22 m\n"                                          \
    "body m1 mass=4 inertia=[0.05, 0.05, 0.05]\n"                                                  \
    "body m2 mass=3 inertia=[0.004, 0.05, 0.052]\n"                                                \
    "body m3 mass=2 inertia=[0.003, 0.03, 0.031]\n"
#define SYMBOLS                                                                                    \
    "L6 = 0.15 m; L7 = 0.25 m; L8 = 0.2 m; L9 = 0.22 m\n"                                          \
    "M1 = 4 kg; M2 = 3 kg; M3 = 2 kg\n"                                                            \
    "I1 = 0.05; I2x = 0.004; I2y = 0.05; I2z = 0.052; I3x = 0.003; I3y = 0.03; I3z = 0.031\n"      \
    "body m1 mass=M1 inertia=[I1, I1, I1]\n"                                                       \
    "body m2 mass=M2 inertia=[I2x, I2y, I2z]\n"                                                    \
    "body m3 mass=M3 inertia=[I3x, I3y, I3z]\n"
#define CHAIN(first)                                                                               \
    "gravity [0, 0, -9.81]\n"                                                                      \
    "arm r6 m1 [" first ", 0, 0] rotation=x(90 deg)\n"                                             \
    "arm r7 m2 [-L7, 0, 0]\narm r8 m2 [L8, 0, 0]\narm r9 m3 [-L9, 0, 0]\n"                         \
    "revolute h12 ground m1 axis=z\nrevolute h13 r6 r7 axis=z\nrevolute h14 r8 r9 axis=z\n"        \
    "virtual revolute vh16 r6 m3 axis=z\n"
#define JOINT    "tree joint\n"
#define INDIRECT "tree translation h12 h13 h14\ntree rotation h12 h13 vh16\n"

static void expect_at_most(const char *scene, Block block, bool shared, OpCount most)
{
    Model *model = scene_new(scene);
    System *system = scene_system(model);
    OpCount count = {0};
    Diag diag;

    EXPECT(system_count(system, block, shared, &count, &diag) == OK);
    EXPECT(count.add <= most.add && count.mul <= most.mul && count.fun <= most.fun);
    if (count.add > most.add || count.mul > most.mul || count.fun > most.fun)
        printf("    %s %d %d %d\n", block_name(block), (int)count.add, (int)count.mul,
               (int)count.fun);
    system_free(system);
    model_free(model);
}

static void sharing_leaves_no_more_than_a_general_routine(void)
{
    static const char joint[] = BODIES CHAIN("L6") JOINT;
    static const char indirect[] = BODIES CHAIN("L6") INDIRECT;

    expect_at_most(joint, BLOCK_MASS, true, (OpCount){20, 35, 5});
    expect_at_most(joint, BLOCK_FORCES, true, (OpCount){36, 88, 8});
    expect_at_most(indirect, BLOCK_MASS, true, (OpCount){17, 34, 5});
    expect_at_most(indirect, BLOCK_FORCES, true, (OpCount){32, 72, 8});
}

/* Table 1 of the paper, also where the length of m2 is a sum */
static void entries_are_as_short_as_in_the_paper(void)
{
    static const char joint[] = SYMBOLS CHAIN("0") JOINT;
    static const char indirect[] = SYMBOLS CHAIN("0") INDIRECT;

    expect_at_most(joint, BLOCK_MASS, false, (OpCount){27, 53, 12});
    expect_at_most(joint, BLOCK_FORCES, false, (OpCount){62, 149, 59});
    expect_at_most(indirect, BLOCK_MASS, false, (OpCount){20, 43, 11});
    expect_at_most(indirect, BLOCK_FORCES, false, (OpCount){60, 138, 57});
}

/* every figure of the indirect set against that of the joint set */
static void indirect_coordinates_cost_no_more(void)
{
    static const char *const scenes[][2] = {
        {BODIES CHAIN("L6") JOINT, BODIES CHAIN("L6") INDIRECT},
        {SYMBOLS CHAIN("L6") JOINT, SYMBOLS CHAIN("L6") INDIRECT},
        {SYMBOLS CHAIN("0") JOINT, SYMBOLS CHAIN("0") INDIRECT},
    };

    for (int i = 0; i < COUNT(scenes); i++) {
        Model *model = scene_new(scenes[i][0]);
        System *system = scene_system(model);
        Diag diag;

        for (int shared = 0; shared < 2; shared++)
            for (int block = BLOCK_MASS; block <= BLOCK_FORCES; block++) {
                OpCount count = {0};

                EXPECT(system_count(system, (Block)block, shared, &count, &diag) == OK);
                expect_at_most(scenes[i][1], (Block)block, shared, count);
            }
        system_free(system);
        model_free(model);
    }
}

int main(void)
{
    RUN(sharing_leaves_no_more_than_a_general_routine);
    RUN(entries_are_as_short_as_in_the_paper);
    RUN(indirect_coordinates_cost_no_more);
    return test_end();
}
