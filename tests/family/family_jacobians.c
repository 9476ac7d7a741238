/* family_jacobians.c: derivatives of a mechanism's rates, and of its implicit equations, against
 * extrapolated differences of them
 *
 * Trees of joints, with and without Euler parameters, and four-bars in a plane and in space, where
 * rows are redundant, carry springs, dampers, motors and torques that bend; in both forms, in joint
 * and absolute coordinates. The state is off the manifold, as stages of a step are. Differences go
 * through the programs of a run alone, derivatives through none of them. */
#include "family.h"
#include "jacobians.h"

enum { MOST_TEXT = 8192 };

typedef struct ModelText {
    char text[MOST_TEXT];
    int length;
} ModelText;

__attribute__((format(printf, 2, 3))) static void add(ModelText *out, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    out->length += vsnprintf(out->text + out->length, sizeof out->text - (size_t)out->length,
                             format, arguments);
    va_end(arguments);
}

/* --- members --- */

/* what acts on a hinge or a slide */
static void add_effort(Member *m, ModelText *out, const char *joint, bool is_slide)
{
    switch (member_one_of(m, 4)) {
    case 0:
        add(out, "spring k%s %s k=%.17g d=%.17g\n", joint, joint, member_decades(m, 1, 2e4),
            member_decades(m, 1e-2, 10));
        break;
    case 1:
        add(out, "actuator k%s %s %s=-%.17g*%s^3 - sin(3*%s')\n", joint, joint,
            is_slide ? "force" : "torque", member_decades(m, 1, 1e3), joint, joint);
        break;
    case 2:
        if (is_slide)
            break;
        add(out, "vsource V%s p%s 0 12*cos(t)\nmotor M%s %s p%s 0 R=%.17g Kt=%.17g", joint, joint,
            joint, joint, joint, member_decades(m, 0.1, 10), member_decades(m, 0.01, 1));
        if (member_one_of(m, 2) == 0)
            add(out, " L=%.17g", member_decades(m, 1e-4, 1));
        add(out, " J=%.17g\n", member_decades(m, 1e-4, 1e-2));
        break;
    default:
        break;
    }
}

static void add_body(Member *m, ModelText *out, int i, bool is_spatial)
{
    const double mass = member_decades(m, 0.1, 10), at = member_between(m, 0.2, 1);

    if (is_spatial)
        add(out, "body b%d mass=%.17g inertia=[%.17g, %.17g, %.17g]\n", i, mass,
            member_between(m, 0.5, 1), member_between(m, 0.5, 1), member_between(m, 0.5, 1));
    else
        add(out, "body b%d mass=%.17g inertia=%.17g\n", i, mass, member_between(m, 0.1, 1));
    add(out, is_spatial ? "arm a%d b%d [%.17g, %.17g, 0]\n" : "arm a%d b%d [%.17g, %.17g]\n", i, i,
        at, member_between(m, -0.3, 0.3));
}

static const char *random_joint(Member *m, bool is_spatial)
{
    static const char *const planar[] = {"revolute", "revolute", "prismatic"};
    static const char *const spatial[] = {"revolute", "prismatic", "universal", "spherical",
                                          "cylindrical"};

    return is_spatial ? spatial[member_one_of(m, 5)] : planar[member_one_of(m, 3)];
}

/* every body hangs on one before it */
static void make_tree(Member *m, ModelText *out)
{
    const bool is_spatial = member_one_of(m, 2) == 0;
    const int bodies = 1 + member_one_of(m, is_spatial ? 4 : 8);

    add(out, is_spatial ? "gravity [0, 0, -9.81]\n" : "scene planar\ngravity [0, -9.81]\n");
    for (int i = 1; i <= bodies; i++) {
        const char *kind = random_joint(m, is_spatial);
        const bool is_slide = strcmp(kind, "prismatic") == 0;
        const int on = member_one_of(m, i);
        char name[16], tail[16];

        add_body(m, out, i, is_spatial);
        (void)snprintf(name, sizeof name, "h%d", i);
        if (on == 0)
            (void)snprintf(tail, sizeof tail, "ground");
        else
            (void)snprintf(tail, sizeof tail, "a%d", on);
        add(out, "%s %s %s b%d%s\n", kind, name, tail, i, is_slide ? " axis=x" : "");
        if (strcmp(kind, "revolute") == 0 || is_slide) {
            add_effort(m, out, name, is_slide);
            add(out, "init %s = %.17g, %s' = %.17g\n", name, member_between(m, -1, 1), name,
                member_between(m, -2, 2));
        }
    }
    if (bodies > 1 && member_one_of(m, 3) == 0)
        add(out, "spring between ground a%d k=%.17g length=0.3\n", bodies,
            member_decades(m, 1, 1e3));
}

static void make_four_bar(Member *m, ModelText *out)
{
    const bool is_spatial = member_one_of(m, 2) == 0;
    const double length[3] = {member_between(m, 0.3, 1.2), member_between(m, 0.3, 1.2),
                              member_between(m, 0.3, 1.2)};
    const double angle[3] = {member_between(m, -3, 3), member_between(m, -3, 3),
                             member_between(m, -3, 3)};
    const double x =
        length[0] * cos(angle[0]) + length[1] * cos(angle[1]) - length[2] * cos(angle[2]);
    const double y =
        length[0] * sin(angle[0]) + length[1] * sin(angle[1]) - length[2] * sin(angle[2]);

    add(out, is_spatial ? "gravity [0, -9.81, 0]\n" : "scene planar\ngravity [0, -9.81]\n");
    for (int i = 0; i < 3; i++)
        add(out, "body b%d mass=1 inertia=%s\narm a%d b%d [%.17g, 0%s]\n", i,
            is_spatial ? "[1, 1, 1]" : "1", i, i, length[i], is_spatial ? ", 0" : "");
    add(out, is_spatial ? "arm g ground [%.17g, %.17g, 0]\n" : "arm g ground [%.17g, %.17g]\n", x,
        y);
    add(out, "revolute h1 ground b0\nrevolute h2 a0 b1\nrevolute h3 g b2\nrevolute h4 a1 a2\n");
    add(out, "tree %s\nform %s\n", member_one_of(m, 2) ? "joint" : "absolute",
        member_one_of(m, 2) ? "augmented" : "embedded");
    add_effort(m, out, "h1", false);
    add_effort(m, out, "h3", false);
    add(out, "init h1 = %.17g, h1' = %.17g\nguess h2 = %.17g, h3 = %.17g\n", angle[0],
        member_between(m, -3, 3), remainder(angle[1] - angle[0], 2 * M_PI), angle[2]);
}

/* --- verdicts --- */

static Verdict run_member(Member *m, const ModelText *text)
{
    static const char *const methods[] = {"radau", "bdf", "dop853", "ida"};
    JacobianTrial trial = {.text = text->text,
                           .method = methods[member_one_of(m, 4)],
                           .at = 0.02,
                           .random = test_random(&m->random)};

    jacobian_try(&trial);
    if (!(fmax(trial.worst, trial.implicit) <= 1) || m->told)
        tell(m, "%s\n%s: %s\n", text->text, trial.method, trial.reason);
    if (isnan(trial.worst))
        return REFUSED;
    return keeps(m, "an entry", trial.worst, 1) &&
                   keeps(m, "an entry of the implicit equations", trial.implicit, 1)
               ? AGREES
               : DISAGREES;
}

static Verdict trees_have_exact_jacobians(Member *m)
{
    ModelText text = {.length = 0};

    make_tree(m, &text);
    add(&text, "simulate 0.02\n");
    return run_member(m, &text);
}

static Verdict four_bars_have_exact_jacobians(Member *m)
{
    ModelText text = {.length = 0};

    make_four_bar(m, &text);
    add(&text, "simulate 0.02\n");
    return run_member(m, &text);
}

static const Family families[] = {
    {"trees_have_exact_jacobians", 40, 0.1, 0, trees_have_exact_jacobians},
    {"four_bars_have_exact_jacobians", 40, 0.1, 0, four_bars_have_exact_jacobians},
};

int main(int argc, char **argv)
{
    return family_main(families, 2, argc, argv);
}
