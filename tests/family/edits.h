/* edits.h: random models and the edits that a user makes of them: chains and trees of bodies, and
 * robots whose legs come and go */
#ifndef COTREE_TESTS_EDITS_H
#define COTREE_TESTS_EDITS_H

#include "family.h"

#include "base/memory.h"
#include "base/text.h"

enum { MOST_BODIES = 20, EDITS = 6 };

typedef struct Draft {
    Member *member;
    bool planar;
    int bodies, springs;
    bool is_large;
    bool is_reordered; /* a joint was made anew */
    bool is_named;     /* numbers are parameters of the user's, */
    Text parameters;   /* which these lines make */
    int named;
} Draft;

static int below(Draft *draft, int count)
{
    const int chosen = (int)test_uniform(&draft->member->random, 0, count);

    return chosen < count ? chosen : count - 1;
}

static double any(Draft *draft, double low, double high)
{
    return test_uniform(&draft->member->random, low, high);
}

/* tenths, so that zeros and equal numbers occur */
static void add_number(Draft *draft, Text *text, double low, double high)
{
    const double number = any(draft, low, high);

    if (draft->is_named) {
        text_addf(&draft->parameters, "p%d = %.1f\n", ++draft->named, number);
        text_addf(text, "p%d", draft->named);
    } else {
        text_addf(text, "%.1f", number);
    }
}

static void add_vector(Draft *draft, Text *text)
{
    for (int i = 0; i < (draft->planar ? 2 : 3); i++) {
        text_add(text, i == 0 ? "[" : ", ");
        add_number(draft, text, -0.4, 0.4);
    }
    text_add(text, "]");
}

static void add_axis(Draft *draft, Text *text)
{
    static const char *const axes[] = {"x", "y", "[1, 2, 2]", "[0.6, 0, 0.8]", "z"};

    text_add(text, axes[below(draft, draft->planar ? 2 : COUNT(axes))]);
}

static void add_joint(Draft *draft, Text *text, int i, int before)
{
    static const char *const types[] = {"revolute", "prismatic", "cylindrical", "revolute"};
    const char *type = types[below(draft, draft->planar ? 2 : COUNT(types))];
    char tail[20];

    (void)snprintf(tail, sizeof tail, before < 0 ? "ground" : "t%d", i);
    /* now and then the branch is passed from its head */
    if (below(draft, 4) == 0 && strcmp(type, "revolute") == 0)
        text_addf(text, "%s j%d h%d %s", type, i, i, tail);
    else
        text_addf(text, "%s j%d %s h%d", type, i, tail, i);
    if (!draft->planar || strcmp(type, "revolute") != 0) {
        text_add(text, " axis=");
        add_axis(draft, text);
    }
    text_char(text, '\n');
}

static void add_inertia(Draft *draft, Text *text)
{
    for (int i = 0; i < (draft->planar ? 1 : 3); i++) {
        text_add(text, draft->planar ? "" : i == 0 ? "[" : ", ");
        add_number(draft, text, 0.5, 0.8);
    }
    text_add(text, draft->planar ? "" : "]");
}

static void add_body(Draft *draft, Text *text, int i)
{
    const int before = below(draft, 5) == 0 ? below(draft, i + 1) - 1 : i - 1;

    text_addf(text, "body b%d mass=", i);
    add_number(draft, text, 0.5, 2);
    text_add(text, " inertia=");
    add_inertia(draft, text);
    text_addf(text, "\narm h%d b%d ", i, i);
    add_vector(draft, text);
    if (before >= 0) {
        text_addf(text, "\narm t%d b%d ", i, before);
        add_vector(draft, text);
    }
    text_char(text, '\n');
    add_joint(draft, text, i, before);
}

static void add_model(Draft *draft, Text *text)
{
    draft->planar = below(draft, 2) == 0;
    draft->bodies = below(draft, 2) == 0 || draft->is_large ? 17 + below(draft, MOST_BODIES - 16)
                                                            : 1 + below(draft, 4);
    text_add(text,
             draft->planar ? "scene planar\ngravity [0, -9.81]\n" : "gravity [0, 1, -9.81]\n");
    for (int i = 0; i < draft->bodies; i++)
        add_body(draft, text, i);
    text_add(text, "tree joint\n");
}

static void add_edit(Draft *draft, Text *text)
{
    const int i = below(draft, draft->bodies);

    /* joints are made anew in every other member */
    switch (below(draft, draft->member->number % 2 == 0 ? 8 : 9)) {
    case 0:
        text_addf(text, "set b%d.mass = %.1f\n", i, any(draft, 0.5, 2));
        break;
    case 1:
        text_addf(text, "set b%d.inertia = ", i);
        add_inertia(draft, text);
        text_char(text, '\n');
        break;
    case 2:
        text_addf(text, "set h%d.position = ", i);
        add_vector(draft, text);
        text_char(text, '\n');
        break;
    case 3:
        text_addf(text, "set j%d.axis = ", i);
        add_axis(draft, text);
        text_char(text, '\n');
        break;
    case 4:
        text_add(text, "undo\n");
        break;
    case 5:
        text_add(text, below(draft, 2) == 0 ? "tree absolute\n" : "tree joint\n");
        draft->is_reordered = true; /* other coordinates */
        break;
    case 6:
        text_addf(text, "gravity [0, %.1f]\n", any(draft, -9, 9));
        break;
    case 8:
        text_addf(text, "delete j%d\n", i);
        /* on the same frames: the first body's joint, and those whose tail is an arm */
        add_joint(draft, text, i, i - 1);
        text_add(text, "tree joint\n");
        draft->is_reordered = true;
        break;
    default:
        text_addf(text, "spring k%d j%d k=%.1f\n", draft->springs++, i, any(draft, 1, 3));
        break;
    }
}

/* --- instances that come and go --- */

enum { SLOTS = 12, CHANGES = 8 };

typedef struct Robot {
    Member *member;
    bool planar;
    int slots; /* places for legs */
} Robot;

static int one_of(const Robot *robot, int count)
{
    return member_one_of(robot->member, count);
}

/* a position, of three numbers in space */
static void add_place(const Robot *robot, Text *text, double x, double y)
{
    text_addf(text, robot->planar ? "[%.3f, %.3f]" : "[%.3f, %.3f, 0.05]", x, y);
}

static void add_link_parts(const Robot *robot, Text *text, const char *name, const char *length)
{
    const char *z = robot->planar ? "" : ", 0";

    text_addf(text, "body %s mass=%s inertia=%s\n", name, "2*shared",
              robot->planar ? "0.1" : "[0.05, 0.1, 0.12]");
    text_addf(text, "arm %sr %s [-%s/2, 0%s]\narm %se %s [%s/2, 0%s]\n", name, name, length, z,
              name, name, length, z);
}

/* a leg of two links, and a hip that holds two of them */
static void add_definitions(const Robot *robot, Text *text)
{
    const char *z = robot->planar ? "" : ", 0";

    text_add(text, "subsystem leg frames=[A, B]\nL = 0.6\n");
    add_link_parts(robot, text, "l1", "L");
    add_link_parts(robot, text, "l2", "L");
    text_addf(text, "arm B l2 [L/2, 0%s]\n", z);
    text_addf(text, "%s h A l1r%s\n", robot->planar ? "revolute" : "universal",
              robot->planar ? "" : " axes=[y, z]");
    if (one_of(robot, 2) == 0)
        text_add(text, "prismatic k l1e l2r axis=x\nspring sp k k=90 rest=0.1\n");
    else
        text_add(text, "revolute k l1e l2r\nspring sp k k=9\n");
    if (one_of(robot, 2) == 0)
        text_add(text, "motor M k u 0 R=1 L=1 Kt=1 Kv=1\nresistor R u 0 5\n");
    text_add(text, "end\nsubsystem hip frames=[A, B]\n");
    add_link_parts(robot, text, "pelvis", "0.2");
    text_addf(text, "arm B pelvis [0, 0.1%s]\nrevolute turn A pelvis\n", z);
    text_add(text, "use leg left A=pelvisr\nuse leg right A=pelvise\nend\n");
}

static void add_instance(const Robot *robot, Text *text, int slot)
{
    const char *held = robot->planar ? "revolute" : "spherical";

    switch (one_of(robot, 4)) {
    case 0: /* nested, and open */
        text_addf(text, "use hip leg%d A=g%d\n", slot, slot);
        break;
    case 1: /* open */
        text_addf(text, "use leg leg%d A=g%d\n", slot, slot);
        break;
    default:
        text_addf(text, "use leg leg%d A=g%d\n%s h%d leg%d.B p%d\n", slot, slot, held, slot, slot,
                  slot);
        break;
    }
}

static void add_robot(Robot *robot, Text *text)
{
    robot->planar = one_of(robot, 2) == 0;
    robot->slots = one_of(robot, 2) == 0 ? SLOTS : 3;
    text_add(text,
             robot->planar ? "scene planar\ngravity [0, -9.81]\n" : "gravity [0, 1, -9.81]\n");
    text_addf(text, "shared = 1.5\nbody m mass=8 inertia=%s\n",
              robot->planar ? "0.08" : "[0.1, 0.2, 0.3]");
    add_definitions(robot, text);
    for (int i = 0; i < robot->slots; i++) {
        const double at = 2 * M_PI * i / robot->slots;

        text_addf(text, "arm g%d ground ", i);
        add_place(robot, text, 0.5 * cos(at), 0.5 * sin(at));
        text_addf(text, "\narm p%d m ", i);
        add_place(robot, text, 0.2 * cos(at), 0.2 * sin(at));
        text_char(text, '\n');
    }
    for (int i = 0; i < robot->slots; i++)
        if (i == 0 || one_of(robot, 4) > 0)
            add_instance(robot, text, i);
    text_add(text, one_of(robot, 2) == 0 ? "tree absolute\n" : "tree joint\n");
}

/* what can't be done of it is refused in both sessions alike */
static void add_change(const Robot *robot, Text *text)
{
    const int slot = one_of(robot, robot->slots);

    switch (one_of(robot, 10)) {
    case 0:
        text_addf(text, "delete h%d\ndelete leg%d\n", slot, slot);
        break;
    case 1:
        text_addf(text, "delete leg%d\n", slot);
        break;
    case 2:
    case 3:
        add_instance(robot, text, slot);
        break;
    case 4:
        text_addf(text, "set leg%d.l1.mass = %.2f\n", slot, member_between(robot->member, 1, 3));
        break;
    case 5:
        text_addf(text, "set leg%d.L = %.3f\n", slot, member_between(robot->member, 0.5, 0.7));
        break;
    case 6:
        text_addf(text, "shared = %.2f\n", member_between(robot->member, 1, 2));
        break;
    case 7:
        text_add(text, "undo\n");
        break;
    case 8:
        text_add(text, "redo\n");
        break;
    default: /* a part of the model's own beside them */
        text_addf(text, "body f%d mass=1 inertia=%s\nrevolute r%d g%d f%d\n", slot,
                  robot->planar ? "1" : "[1, 1, 1]", slot, slot, slot);
        break;
    }
}

#endif
