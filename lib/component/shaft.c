/* shaft.c: rotation along a line: flywheel, compliant shaft, gear, sources, end on a joint
 *
 * w (rad/s) is the angular velocity of plus against minus, and the torque (N m) passes from plus to
 * minus inside: torque*w is the power into a part. */
#include "component/component_rows.h"

/* clang-format off */
static const Param flywheel_params[] = {
    {"J", PARAM_SCALAR, "kg*m^2", NULL, "moment of inertia", 0},
};
static const Param shaft_params[] = {
    {"k", PARAM_SCALAR, "N*m/rad",   "0", "torque per twist; 0: a damper alone", 0},
    {"d", PARAM_SCALAR, "N*m*s/rad", "0", "torque per rate, in parallel with the spring", 0},
};
static const Param gear_params[] = {
    {"ratio", PARAM_SCALAR, "1", NULL, "turns of the first shaft for one of the second", 0},
};
static const Param torquesource_params[] = {
    {"value", PARAM_LAW, "N*m", NULL, "torque on the first terminal, of t, parameters and variables", POSITIONAL | GIVES_SOURCE},
};
static const Param speedsource_params[] = {
    {"value", PARAM_LAW, "rad/s", NULL, "rate of the first terminal relative to the second", POSITIONAL | GIVES_SOURCE},
};

static const Member flywheel_members[] = {
    {"momentum", "N*m*s", "angular momentum, J*w", 2},
};
static const Member shaft_members[] = {
    {"twist", "rad", "twist of plus relative to minus, from the relaxed position", 2},
};
/* clang-format on */

static void flywheel_relation(const Instance *instance, Arena *arena, int which,
                              const Motion1 *motion, Relation *out)
{
    (void)which;
    scalar_storage(RELATION_CAPACITIVE, instance_scalar(instance, "J"), motion->across, arena, out);
}

const Component component_flywheel = {
    .name = "flywheel",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SHAFT,
    .places = PLACES_TERMINALS,
    .brief = "inertia on a shaft: torque = J*w'",
    .params = flywheel_params,
    .param_count = COUNT(flywheel_params),
    .translation = BRANCH_MAY,
    .preference = 20,
    .relation = flywheel_relation,
    .members = flywheel_members,
    .member_count = COUNT(flywheel_members),
    .positive = "J",
    .help = "An inertia that turns with its first terminal; the second is 0. Its rate is a "
            "state; init may set it. On the terminal of a shaftend it adds to the inertia of "
            "the joint.",
    .example = "torquesource T1 a 0 2\nflywheel J1 a 0 J=0.5\nshaft d1 a 0 d=0.1\n"
               "init J1.w = 0\nsimulate 10\nprint J1.w, J1.momentum",
    .see = "shaft gear shaftend init",
};

static void shaft_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    (void)which;
    scalar_spring(instance, "twist", arena, motion, out);
}

static void shaft_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    (void)k;
    scalar_spring_state(instance, "twist", arena, out);
}

const Component component_shaft = {
    .name = "shaft",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SHAFT,
    .places = PLACES_TERMINALS,
    .brief = "compliant shaft: torque = k*twist + d*w",
    .params = shaft_params,
    .param_count = COUNT(shaft_params),
    .translation = BRANCH_MAY,
    .preference = 40,
    .relation = shaft_relation,
    .own_state_count = scalar_spring_states,
    .own_state = shaft_state,
    .members = shaft_members,
    .member_count = COUNT(shaft_members),
    .check = scalar_check_spring,
    .help = "A torsion spring k with a parallel damper d between two terminals; without k it is "
            "a damper or a viscous bearing. Its state is the torque if there is no damping, "
            "else the twist; init may set either.",
    .example = "flywheel J1 a 0 J=0.1\nshaft k1 a b k=100 d=0.05\nflywheel J2 b 0 J=0.2\n"
               "init J1.w = 10, J2.w = 0, k1.twist = 0\nsimulate 1\nprint J1.w, J2.w, k1.torque",
    .see = "flywheel gear rod",
};

/* w1 = N w2, torque2 = -N torque1: no power is lost */
static void gear_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)motion;
    scalar_converter(instance, arena, which, instance_scalar(instance, "ratio"), out);
}

static Status gear_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    Status status;

    (void)arena;
    (void)planar;
    if (!expr_is_zero(instance_scalar(instance, "ratio")))
        return OK;
    status = diag_set(diag, E_VALUE, "the ratio of %s is zero", instance->name);
    diag_hint(diag, "a negative one turns the second shaft the other way");
    diag_about(diag, "ratio");
    return status;
}

static const ScalarEdge gear_edges[] = {
    {"p", 0, 1, BRANCH_MAY, 15},
    {"s", 2, 3, BRANCH_MAY, 16},
};

/* clang-format off */
static const Member gear_members[] = {
    {"p.w",      "rad/s", "rate of the first shaft", 2},
    {"p.torque", "N*m",   "torque that it takes from the first shaft", 2},
    {"p.power",  "W",     "power that it takes from the first shaft", 0},
    {"s.w",      "rad/s", "rate of the second shaft", 2},
    {"s.torque", "N*m",   "torque that it takes from the second shaft, -ratio*p.torque", 2},
    {"s.power",  "W",     "power that it takes from the second shaft", 0},
};
/* clang-format on */

const Component component_gear = {
    .name = "gear",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SHAFT,
    .places = PLACES_TERMINALS,
    .brief = "gear between two shafts",
    .params = gear_params,
    .param_count = COUNT(gear_params),
    .translation = BRANCH_MAY,
    .preference = 25,
    .terminal_count = 4,
    .terminal_usage = " A B C D",
    .scalar_edges = gear_edges,
    .scalar_edge_count = COUNT(gear_edges),
    .relation = gear_relation,
    .members = gear_members,
    .member_count = COUNT(gear_members),
    .check = gear_check,
    .help = "The rate of A relative to B is ratio times that of C relative to D, and torque is "
            "transmitted without loss. B and D are the housing, usually 0. Its edges are g1.p "
            "and g1.s, with p.w = ratio*s.w and s.torque = -ratio*p.torque. An inertia J on the "
            "second shaft acts as J/ratio^2 on the first.",
    .example = "torquesource T1 a 0 1\nflywheel J1 a 0 J=0.01\ngear g1 a 0 b 0 ratio=5\n"
               "flywheel J2 b 0 J=1\ninit J1.w = 0\nsimulate 1\nprint J1.w, J2.w, g1.s.torque",
    .see = "flywheel shaft shaftend",
};

const Component component_torquesource = {
    .name = "torquesource",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SHAFT,
    .places = PLACES_TERMINALS,
    .brief = "torque on a shaft",
    .params = torquesource_params,
    .param_count = COUNT(torquesource_params),
    .translation = BRANCH_MAY,
    .preference = 50,
    .relation = scalar_through_source,
    .help = "Supplies the torque to its first terminal and takes it from the second, whatever "
            "the rate: any expression of t, parameters and other variables. As torque is "
            "positive from plus to minus inside, T1.torque is minus the value.",
    .example = "torquesource T1 a 0 3*sin(2*t)\nflywheel J1 a 0 J=0.2\ninit J1.w = 0\n"
               "simulate 3\nprint J1.w, T1.power",
    .see = "speedsource flywheel",
};

const Component component_speedsource = {
    .name = "speedsource",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_SHAFT,
    .places = PLACES_TERMINALS,
    .brief = "rate of a shaft",
    .params = speedsource_params,
    .param_count = COUNT(speedsource_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = scalar_across_source,
    .help = "Turns its first terminal relative to the second at a given rate, whatever the "
            "torque: any expression of t, parameters and other variables.",
    .example = "speedsource W1 a 0 100 rpm\nshaft k1 a b k=50\nflywheel J1 b 0 J=0.2\n"
               "init J1.w = 0, k1.torque = 0\nsimulate 1\nprint J1.w, W1.torque",
    .see = "torquesource shaft",
};

static Status shaftend_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return scalar_check_hinge(instance, true, "on a slide: rodend", diag);
}

const Component component_shaftend = {
    .name = "shaftend",
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_SHAFT,
    .places = PLACES_TRANSDUCER,
    .brief = "couples a shaft to the angle of a joint",
    .translation = BRANCH_MAY,
    .preference = 10,
    .effort = scalar_through_on_joint,
    .relation = scalar_rate_of_joint,
    .check = shaftend_check,
    .help = "The rate of its first terminal relative to the second is that of the joint's "
            "angle. The torque that the shaft supplies acts on the tip of the joint, and the "
            "opposite torque on the tail.",
    .example = "scene planar\nbody arm1 mass=1 inertia=0.2\nrevolute h1 ground arm1\n"
               "shaftend Z1 h1 a 0\ngear g1 b 0 a 0 ratio=10\nflywheel J1 b 0 J=0.001\n"
               "torquesource T1 b 0 0.5\ninit h1 = 0, h1' = 0\nsimulate 1\n"
               "print h1', Z1.torque",
    .see = "flywheel gear rodend motor",
};
