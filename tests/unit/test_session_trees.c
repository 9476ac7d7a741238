/* test_session_trees.c: `tree best` finds what papers found by hand, and can be stopped */
#include "base/text.h"
#include "session_kit.h"

#include <math.h>
#include <string.h>

/* the open chain of McPhee, Schmitke and Redmond (2004): its cheapest coordinates are the angle of
 * m3 against m1 beside those of the first two joints */
#define MANIPULATOR                                                                                \
    "gravity [0, 0, -9.81]\n"                                                                      \
    "L6 = 0.15; L7 = 0.25; L8 = 0.20; L9 = 0.22\n"                                                 \
    "body m1 mass=4 inertia=[0.05, 0.05, 0.05]\n"                                                  \
    "body m2 mass=3 inertia=[0.004, 0.05, 0.052]\n"                                                \
    "body m3 mass=2 inertia=[0.003, 0.03, 0.031]\n"                                                \
    "arm r6 m1 [L6, 0, 0] rotation=x(90 deg)\n"                                                    \
    "arm r7 m2 [-L7, 0, 0]\n"                                                                      \
    "arm r8 m2 [L8, 0, 0]\n"                                                                       \
    "arm r9 m3 [-L9, 0, 0]\n"                                                                      \
    "revolute h12 ground m1 axis=z\n"                                                              \
    "revolute h13 r6 r7 axis=z\n"                                                                  \
    "revolute h14 r8 r9 axis=z\n"                                                                  \
    "tree joint\n"

#define ROTATING "init h12 = 0.2, h13 = 0.6, h14 = -0.9, h12' = 1.5, h13' = 0, h14' = 0.5\n"

static bool stop_at_last(void *context)
{
    int *left = context;

    return --*left < 0;
}

static ct_status stopped_after(Kit *kit, const char *model, int polls)
{
    int left = 1 << 30;
    const ct_hooks hooks = {.context = &left, .stop = stop_at_last, .columns = 80};
    ct_status status;

    ct_session_hooks(kit->session, &hooks);
    EXPECT_DONE(kit, model);
    left = polls;
    status = kit_do(kit, "tree best\n");
    ct_session_hooks(kit->session, NULL);
    return status;
}

static void the_search_finds_the_two_trees_of_the_slider_crank(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK "tree best\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "chosen: translation h8 h9 h10; rotation h8 h10 s11\n"
                                          "2 coordinates, 1 constraint, 1 degree of freedom");
    EXPECT_HOLDS(ct_remarks(kit.session), "h8 h10 s11\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "(tree absolute)");
    EXPECT_DONE(&kit, "expect model.n == 2\nexpect model.m == 1\n");
    kit_free(&kit);
}

/* from trees that are far from them, too */
static void the_search_leaves_poor_trees(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDER_CRANK "tree absolute\ntree best\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "chosen: translation h8 h9 h10; rotation h8 h10 s11\n");
    EXPECT_DONE(&kit, "tree best");
    EXPECT_HOLDS(ct_remarks(kit.session), "the trees stay as they are: none are cheaper");
    kit_free(&kit);
}

static void the_search_finds_indirect_coordinates(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MANIPULATOR "tree best\n");
    EXPECT_HOLDS(ct_remarks(kit.session), "added: virtual revolute vm3 r6 m3 axis=[0, 0, 1]\n");
    EXPECT_HOLDS(ct_remarks(kit.session),
                 "chosen: translation h12 h13 h14; rotation h12 h13 vm3\n");
    EXPECT_DONE(&kit, "expect model.n == 3\nexpect model.m == 0\n");
    kit_free(&kit);
}

static void the_trees_found_move_alike(void)
{
    Kit kit = kit_new();
    double before;

    EXPECT_DONE(&kit, MANIPULATOR ROTATING "simulate 1 rtol=1e-11 atol=1e-12\n");
    before = kit_value(&kit, "h14");
    EXPECT_DONE(&kit, "tree best\nsimulate 1 rtol=1e-11 atol=1e-12\n");
    EXPECT(fabs(kit_value(&kit, "h14") - before) < 1e-7);
    EXPECT(fabs(kit_value(&kit, "vm3 - h13") - before) < 1e-7);
    kit_free(&kit);
}

/* a virtual joint that is there already is not proposed again */
static void a_joint_of_the_users_is_taken(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, MANIPULATOR "virtual revolute vh16 r6 m3 axis=z\ntree best\n");
    EXPECT(strstr(ct_remarks(kit.session), "added") == NULL);
    EXPECT_HOLDS(ct_remarks(kit.session),
                 "chosen: translation h12 h13 h14; rotation h12 h13 vh16\n");
    kit_free(&kit);
}

/* both ends of a chord further out than the graph has edges, taken together */
static void a_long_chain_is_searched(void)
{
    Kit kit = kit_new();
    char line[300];

    EXPECT_DONE(&kit, "scene planar\nbody b0 mass=1 inertia=1\nrevolute h0 ground b0\n");
    for (int i = 1; i < 6; i++) {
        (void)snprintf(line, sizeof line,
                       "body b%d mass=1 inertia=1\narm c%d b%d [1, 0]\narm a%d b%d [-1, 0]\n"
                       "revolute h%d c%d a%d\n",
                       i, i, i - 1, i, i, i, i, i);
        EXPECT_DONE(&kit, line);
    }
    EXPECT(stopped_after(&kit, "virtual revolute v c5 a5\n", 4000) != CT_FAILED);
    EXPECT_HOLDS(ct_remarks(kit.session), "compared");
    kit_free(&kit);
}

static void undo_takes_back_trees_and_joints_at_once(void)
{
    Kit kit = kit_new();
    char *before, *after, *found;

    EXPECT_DONE(&kit, MANIPULATOR);
    before = ct_save(kit.session);
    EXPECT_DONE(&kit, "tree best\n");
    found = ct_save(kit.session);
    EXPECT_HOLDS(found, "virtual revolute vm3");
    EXPECT_DONE(&kit, "undo");
    EXPECT_HOLDS(ct_remarks(kit.session), "undone: tree best");
    after = ct_save(kit.session);
    EXPECT(strcmp(before, after) == 0);
    ct_free(after);
    EXPECT_DONE(&kit, "redo");
    EXPECT_HOLDS(ct_remarks(kit.session), "done again: tree best");
    after = ct_save(kit.session);
    EXPECT(strcmp(found, after) == 0);
    EXPECT_DONE(&kit, "undo\nundo\nredo\nredo");
    ct_free(after);
    after = ct_save(kit.session);
    EXPECT(strcmp(found, after) == 0);
    ct_free(before);
    ct_free(found);
    ct_free(after);
    kit_free(&kit);
}

/* --- stopping --- */

static void a_search_stopped_at_once_changes_nothing(void)
{
    Kit kit = kit_new();
    char *saved;

    EXPECT(stopped_after(&kit, MANIPULATOR, 0) == CT_STOPPED);
    saved = ct_save(kit.session);
    EXPECT(strstr(saved, "virtual") == NULL);
    ct_free(saved);
    EXPECT_DONE(&kit, "expect model.n == 3\n");
    kit_free(&kit);
}

static void a_search_that_is_stopped_leaves_the_best_so_far(void)
{
    /* enough for the starts, not for all neighbours */
    for (int polls = 40; polls < 4000; polls *= 3) {
        Kit kit = kit_new();
        ct_status status = stopped_after(&kit, SLIDER_CRANK CRANK_START, polls);

        EXPECT(status == CT_STOPPED || status == CT_OK);
        if (status == CT_STOPPED && strstr(ct_remarks(kit.session), "compared") != NULL)
            EXPECT_HOLDS(kit.error.message, "the best trees so far are chosen");
        EXPECT_DONE(&kit, "simulate 0.1\nexpect model.n - model.m == 1\n");
        kit_free(&kit);
    }
}

/* The first pair of trees has some 5000 neighbours, far more than the bound on systems lets be
 * formed: those that can't matter aren't written out, which took gigabytes for 300 bodies. */
static void a_long_chain_can_be_searched_and_stopped(void)
{
    Kit kit = kit_new();
    Text model = {0};
    ct_status status;

    text_add(&model, "scene planar\n");
    for (int i = 0; i < 60; i++) {
        text_addf(&model, "body b%d mass=1 inertia=1\narm s%d b%d [-0.5, 0]\n", i, i, i);
        text_addf(&model, "arm e%d b%d [0.5, 0]\n", i, i);
        if (i == 0)
            text_add(&model, "revolute h0 ground s0\n");
        else
            text_addf(&model, "revolute h%d e%d s%d\n", i, i - 1, i);
    }
    status = stopped_after(&kit, model.at, 1500);
    EXPECT(status == CT_STOPPED || status == CT_OK);
    EXPECT_DONE(&kit, "expect model.dof == 60\n");
    text_free(&model);
    kit_free(&kit);
}

/* --- refusals --- */

static void a_circuit_has_no_mechanical_trees_to_compare(void)
{
    Kit kit = kit_new();

    EXPECT(kit_do(&kit, "tree best") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "no bodies and joints");
    EXPECT(kit_do(&kit, "resistor R1 a 0 10\nvsource V1 a 0 5\ntree best") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "no bodies and joints");
    kit_free(&kit);
}

static void one_tree_alone_is_not_searched(void)
{
    Kit kit = kit_new();

    EXPECT(kit_do(&kit, SLIDER_CRANK "tree rotation best") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "both mechanical trees");
    kit_free(&kit);
}

int main(void)
{
    RUN(the_search_finds_the_two_trees_of_the_slider_crank);
    RUN(the_search_leaves_poor_trees);
    RUN(the_search_finds_indirect_coordinates);
    RUN(the_trees_found_move_alike);
    RUN(a_joint_of_the_users_is_taken);
    RUN(a_long_chain_is_searched);
    RUN(undo_takes_back_trees_and_joints_at_once);
    RUN(a_search_stopped_at_once_changes_nothing);
    RUN(a_search_that_is_stopped_leaves_the_best_so_far);
    RUN(a_long_chain_can_be_searched_and_stopped);
    RUN(a_circuit_has_no_mechanical_trees_to_compare);
    RUN(one_tree_alone_is_not_searched);
    return test_end();
}
