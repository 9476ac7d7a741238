/* slide.c: translation along a line: slug, compliant rod, sources, end on a joint
 *
 * v (m/s) is the velocity of plus against minus, and the force (N) passes from plus to minus
 * inside: force*v is the power into a part. */
#include "component/component_rows.h"

/* clang-format off */
static const Param slug_params[] = {
    {"m", PARAM_SCALAR, "kg", NULL, "mass", 0},
};
static const Param rod_params[] = {
    {"k", PARAM_SCALAR, "N/m",   "0", "force per deflection; 0: a damper alone", 0},
    {"d", PARAM_SCALAR, "N*s/m", "0", "force per velocity, in parallel with the spring", 0},
};
static const Param forcesource_params[] = {
    {"value", PARAM_LAW, "N", NULL, "force on the first terminal, of t, parameters and variables", POSITIONAL | GIVES_SOURCE},
};
static const Param velocitysource_params[] = {
    {"value", PARAM_LAW, "m/s", NULL, "velocity of the first terminal relative to the second", POSITIONAL | GIVES_SOURCE},
};

static const Member slug_members[] = {
    {"momentum", "N*s", "momentum, m*v", 2},
};
static const Member rod_members[] = {
    {"deflection", "m", "displacement of plus relative to minus, from the relaxed position", 2},
};
/* clang-format on */

static void slug_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)which;
    scalar_storage(RELATION_CAPACITIVE, instance_scalar(instance, "m"), motion->across, arena, out);
}

const Component component_slug = {
    .name = "slug",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SLIDE,
    .places = PLACES_TERMINALS,
    .brief = "mass on a line: force = m*v'",
    .params = slug_params,
    .param_count = COUNT(slug_params),
    .translation = BRANCH_MAY,
    .preference = 20,
    .relation = slug_relation,
    .members = slug_members,
    .member_count = COUNT(slug_members),
    .positive = "m",
    .help = "A mass that moves with its first terminal; the second is 0. Its velocity is a "
            "state; init may set it. On the terminal of a rodend it adds to the mass of the "
            "joint's coordinate.",
    .example = "slug m1 a 0 m=2\nrod k1 a 0 k=200\ninit m1.v = 0, k1.deflection = 0.1\n"
               "simulate 1\nprint m1.v, k1.force",
    .see = "rod forcesource rodend init",
};

static void rod_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                         Relation *out)
{
    (void)which;
    scalar_spring(instance, "deflection", arena, motion, out);
}

static void rod_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    (void)k;
    scalar_spring_state(instance, "deflection", arena, out);
}

const Component component_rod = {
    .name = "rod",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SLIDE,
    .places = PLACES_TERMINALS,
    .brief = "compliant rod: force = k*deflection + d*v",
    .params = rod_params,
    .param_count = COUNT(rod_params),
    .translation = BRANCH_MAY,
    .preference = 40,
    .relation = rod_relation,
    .own_state_count = scalar_spring_states,
    .own_state = rod_state,
    .members = rod_members,
    .member_count = COUNT(rod_members),
    .check = scalar_check_spring,
    .help = "A spring k with a parallel damper d between two terminals; without k it is a "
            "damper. Its state is the force if there is no damping, else the deflection; init "
            "may set either.",
    .example = "slug m1 a 0 m=1\nrod k1 a b k=400 d=2\nslug m2 b 0 m=3\n"
               "init m1.v = 1, m2.v = 0, k1.deflection = 0\nsimulate 2\n"
               "print m1.v, m2.v, k1.deflection",
    .see = "slug shaft spring",
};

const Component component_forcesource = {
    .name = "forcesource",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SLIDE,
    .places = PLACES_TERMINALS,
    .brief = "force on a line",
    .params = forcesource_params,
    .param_count = COUNT(forcesource_params),
    .translation = BRANCH_MAY,
    .preference = 50,
    .relation = scalar_through_source,
    .help = "Supplies the force to its first terminal and takes it from the second, whatever "
            "the velocity: any expression of t, parameters and other variables. As force is "
            "positive from plus to minus inside, F1.force is minus the value.",
    .example = "forcesource F1 a 0 10\nslug m1 a 0 m=2\nrod d1 a 0 d=4\ninit m1.v = 0\n"
               "simulate 3\nprint m1.v, F1.power",
    .see = "velocitysource slug",
};

const Component component_velocitysource = {
    .name = "velocitysource",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SLIDE,
    .places = PLACES_TERMINALS,
    .brief = "velocity on a line",
    .params = velocitysource_params,
    .param_count = COUNT(velocitysource_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = scalar_across_source,
    .help = "Moves its first terminal relative to the second with a given velocity, whatever "
            "the force: any expression of t, parameters and other variables.",
    .example = "velocitysource V1 a 0 0.2*cos(5*t)\nrod k1 a b k=100 d=1\nslug m1 b 0 m=1\n"
               "init m1.v = 0, k1.deflection = 0\nsimulate 4\nprint m1.v, V1.force",
    .see = "forcesource rod",
};

static Status rodend_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return scalar_check_hinge(instance, false, "on a hinge: shaftend", diag);
}

const Component component_rodend = {
    .name = "rodend",
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_SLIDE,
    .places = PLACES_TRANSDUCER,
    .brief = "couples a line to the slide of a joint",
    .translation = BRANCH_MAY,
    .preference = 10,
    .effort = scalar_through_on_joint,
    .relation = scalar_rate_of_joint,
    .check = rodend_check,
    .help = "The velocity of its first terminal relative to the second is that of the joint's "
            "coordinate. The force that the line supplies acts on the tip of the joint, and the "
            "opposite force on the tail.",
    .example = "scene planar\nbody cart mass=5 inertia=1\nprismatic s1 ground cart axis=x\n"
               "rodend Z1 s1 a 0\nrod k1 b a k=1000 d=10\nvelocitysource V1 b 0 0.1\n"
               "init s1 = 0, s1' = 0, k1.deflection = 0\nsimulate 3\nprint s1', Z1.force",
    .see = "slug rod shaftend cylinder",
};
