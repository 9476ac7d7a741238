/* friction.c: dry friction: in a joint, a brake, a clutch, a one-way clutch
 *
 * v is the rate of the joint's coordinate, of the first joint against the second, or the across
 * variable of a shaft or slide edge. With the kinetic bound T and the static ratio r
 *
 *     effort = -T*stick(v, r) - d*v               or, with a Stribeck rate s,
 *     effort = -T*(1 + (r - 1)*exp(-(v/s)^2))*sign(v) - d*v
 *
 * on the tip or, of joints, on the first coordinate. In a run v stays at 0 while no more than r*T
 * is needed for that (formulate/system/surfaces.h). */
#include "component/component_rows.h"

/* Of friction with mu=, T is mu times a load: of a turn, T = mu*radius*N with N the norm of the
 * joint's reaction force; of a shift, T = mu*N with N the norm of that force across the axis plus
 * the norm of the reaction moment over the span. The reaction depends on T itself. So N is an
 * unknown of the equations, the potential of a node that no other part has, and its equation
 * stands beside theirs. */

/* clang-format off */
#define BOUNDS                                                                                      \
    {"torque", PARAM_LAW, "N*m", "0", "kinetic bound on an angle or a shaft", GIVES_LOAD},          \
    {"force",  PARAM_LAW, "N",   "0", "kinetic bound on a length or a slide", GIVES_LOAD}
#define STATIC {"static", PARAM_SCALAR, "1", "1", "static over kinetic bound", 0}
/* clang-format on */

static const Param friction_params[] = {
    BOUNDS,
    STATIC,
    {"stribeck", PARAM_SCALAR, "m/s|rad/s", "0",
     "rate at which the static bound has fallen to the kinetic one; 0: at once", 0},
    {"viscous", PARAM_SCALAR, "N*s/m|N*m*s", "0", "viscous friction per rate, beside it", 0},
    {"mu", PARAM_LAW, "1", "0", "kinetic bound over the load of the joint, in place of the bound",
     0},
    {"radius", PARAM_SCALAR, "m", "0", "with mu=, of a revolute: lever of the friction", 0},
    {"span", PARAM_SCALAR, "m", "0",
     "with mu=, of a prismatic: length over which it carries moments; 0: they press nothing", 0},
    {"normal", PARAM_AXIS, "1", "z", "between frames: of the plane, in the axes of the tail", 0},
};
static const Param brake_params[] = {BOUNDS, STATIC};
static const Param oneway_params[] = {BOUNDS};

/* clang-format off */
#define FRICTION_MEMBERS                                                                            \
    {"bound", "N|N*m", "the most that its dry friction is at the present rate", 0},                 \
    {"hold",  "N|N*m", "the most that it holds at rest", 0},                                        \
    {"loss",  "W",     "power lost in it", 0},                                                      \
    {"lost",  "J",     "energy lost in it since the run began", 0}
/* clang-format on */

static const Member terminal_members[] = {FRICTION_MEMBERS};
static const Member joint_members[] = {
    {"effort", NULL, "force or torque on the tip, or on the first of two joints", 0},
    FRICTION_MEMBERS,
};

static bool has_param(const Instance *instance, const char *name)
{
    return component_param(instance->row, name) >= 0;
}

/* its bound follows from the reaction of its joint */
static bool is_by_load(const Instance *instance)
{
    return instance->row->domain == DOMAIN_LOAD;
}

static const char *bound_name(const Instance *instance)
{
    return instance->on_angle ? "torque" : "force";
}

/* whether e is known to be 0 or above: of parameters the check asks for that, and t begins at 0 */
static bool is_never_negative(Expr e)
{
    const int count = expr_arg_count(e);
    const bool is_if = expr_kind(e) == EXPR_CALL && expr_op(e) == OP_IF;

    if (expr_is_number(e))
        return expr_value(e) >= 0;
    if (expr_kind(e) == EXPR_SYMBOL)
        return expr_symbol_kind(e) == SYMBOL_PARAMETER || expr_symbol_kind(e) == SYMBOL_TIME;
    if (expr_kind(e) == EXPR_CALL && expr_op(e) == OP_ABS)
        return true;
    if (expr_kind(e) == EXPR_CALL && !is_if && expr_op(e) != OP_MIN && expr_op(e) != OP_MAX)
        return false;
    if (expr_kind(e) == EXPR_POWER)
        return is_never_negative(expr_arg(e, 0));
    for (int i = is_if; i < count; i++)
        if (!is_never_negative(expr_arg(e, i)))
            return false;
    return true;
}

/* A brake whose law falls below 0 is open. */
Expr friction_positive(Arena *arena, Expr bound)
{
    return is_never_negative(bound) ? bound : expr_call1(arena, OP_RAMP, bound);
}

static Expr bound_of(const Instance *instance, Arena *arena)
{
    Expr bound = instance_scalar(instance, is_by_load(instance) ? "mu" : bound_name(instance));

    if (is_by_load(instance)) {
        if (instance->on_angle)
            bound = expr_mul(arena, bound, instance_scalar(instance, "radius"));
        return expr_mul(arena, friction_positive(arena, bound),
                        instance_across(instance, arena, 0));
    }
    return friction_positive(arena, bound);
}

static bool has_stribeck(const Instance *instance)
{
    return has_param(instance, "stribeck") && !expr_is_zero(instance_scalar(instance, "stribeck"));
}

/* Stribeck's curve: 1 + (r - 1) exp(-(v/s)^2) */
static Expr stribeck_curve(const Instance *instance, Arena *arena, Expr v)
{
    const Expr one = expr_int(arena, 1), ratio = instance_scalar(instance, "static");
    const Expr part = expr_div(arena, v, instance_scalar(instance, "stribeck"));
    const Expr fall = expr_call1(arena, OP_EXP, expr_neg(arena, expr_mul(arena, part, part)));

    return expr_add(arena, one, expr_mul(arena, expr_sub(arena, ratio, one), fall));
}

static Expr friction_bound(const Instance *instance, Arena *arena, Expr rate, Expr load,
                           bool at_rest)
{
    const Expr bound = bound_of(instance, arena);

    (void)load;
    if (at_rest)
        return has_param(instance, "static")
                   ? expr_mul(arena, bound, instance_scalar(instance, "static"))
                   : bound;
    return has_stribeck(instance) ? expr_mul(arena, bound, stribeck_curve(instance, arena, rate))
                                  : bound;
}

/* the sign of v, or where a speed is given the direction of v in it */
static Expr direction_of(Arena *arena, Expr v, Expr speed, Expr ratio)
{
    return speed == NULL ? expr_call2(arena, OP_STICK, v, ratio)
                         : expr_call(arena, OP_DIRECTION, (Expr[]){v, speed, ratio});
}

/* What acts against the rate v, as far as it is positive; speed: the norm of what v is a component
 * of, or NULL. */
static Expr resistance(const Instance *instance, Arena *arena, Expr v, Expr speed)
{
    const Expr ratio = instance_scalar(instance, "static"), one = expr_int(arena, 1);
    Expr dry;

    if (has_stribeck(instance))
        dry = expr_product(arena,
                           (Expr[]){bound_of(instance, arena),
                                    stribeck_curve(instance, arena, speed != NULL ? speed : v),
                                    direction_of(arena, v, speed, one)},
                           3);
    else
        dry = expr_mul(arena, bound_of(instance, arena), direction_of(arena, v, speed, ratio));
    if (!has_param(instance, "viscous"))
        return dry;
    return expr_add(arena, dry, expr_mul(arena, instance_scalar(instance, "viscous"), v));
}

static Expr friction_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    return expr_neg(arena, resistance(instance, arena, motion->rate, NULL));
}

static Expr friction_rub(const Instance *instance, Arena *arena, Expr rate, Expr speed, Expr load)
{
    (void)load;
    return expr_neg(arena, resistance(instance, arena, rate, speed));
}

static void friction_relation(const Instance *instance, Arena *arena, int which,
                              const Motion1 *motion, Relation *out)
{
    (void)which;
    *out = (Relation){.kind = RELATION_CONDUCTIVE,
                      .value = resistance(instance, arena, motion->across, NULL)};
}

/* N - its value = 0, over the joint's reaction in the names that formulate/ gives to it */
static void load_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    Expr load = instance_variable(instance, arena, "reaction");

    (void)which, (void)motion;
    if (!instance->on_angle && instance_value(instance, "span")->given)
        load = expr_add(arena, load,
                        expr_div(arena, instance_variable(instance, arena, "moment"),
                                 instance_scalar(instance, "span")));
    *out = (Relation){.kind = RELATION_FREE,
                      .value = expr_sub(arena, instance_across(instance, arena, 0), load)};
}

static bool oneway_is_rigid(const Instance *instance)
{
    return !instance_value(instance, bound_name(instance))->given;
}

/* v > 0 is driven along, with at most T, or with as much as it takes; v < 0 runs free */
static Expr carried(const Instance *instance, Arena *arena, Expr v)
{
    const Expr half = expr_rational(arena, 1, 2), one = expr_int(arena, 1);
    const Expr share = expr_mul(arena, half, expr_add(arena, one, expr_call1(arena, OP_SIGN, v)));

    if (oneway_is_rigid(instance))
        return expr_call2(arena, OP_UNILATERAL, v, expr_int(arena, 0));
    return expr_mul(arena, bound_of(instance, arena), share);
}

static Expr oneway_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    return expr_neg(arena, carried(instance, arena, motion->rate));
}

static void oneway_relation(const Instance *instance, Arena *arena, int which,
                            const Motion1 *motion, Relation *out)
{
    (void)which;
    *out =
        (Relation){.kind = RELATION_CONDUCTIVE, .value = carried(instance, arena, motion->across)};
}

/* --- checks --- */

/* the bound that doesn't belong to its coordinate */
static Status check_unit(const Instance *instance, Diag *diag)
{
    const char *wrong = instance->on_angle ? "force" : "torque";
    Status status;

    if (!instance_value(instance, wrong)->given)
        return OK;
    status = diag_set(diag, E_VALUE, "%s= does not fit: %s acts on %s", wrong, instance->name,
                      instance->on_angle ? "an angle" : "a length");
    diag_hint(diag, "use %s=", bound_name(instance));
    diag_about(diag, "%s", wrong);
    return status;
}

static Status check_bound(const Instance *instance, Diag *diag)
{
    const char *right = bound_name(instance);
    Status status;

    TRY(check_unit(instance, diag));
    if (instance_value(instance, right)->given)
        return check_not_negative(instance, right, diag);
    if (has_param(instance, "viscous") && instance_value(instance, "viscous")->given)
        return OK;
    status = diag_set(diag, E_VALUE, "%s needs %s=, the most that it holds while it slips",
                      instance->name, right);
    diag_hint(diag, "a number, or an expression of t, parameters and variables: %s=2", right);
    return status;
}

/* mu= with what belongs to it, and nothing of it without mu= */
static Status check_load(const Instance *instance, Diag *diag)
{
    static const char *const own[] = {"radius", "span"};
    const char *lacks = instance->on_angle ? "span" : "radius";
    Status status;

    for (int i = 0; i < COUNT(own); i++)
        if (!is_by_load(instance) && instance_value(instance, own[i])->given) {
            status = diag_set(diag, E_VALUE, "%s= has no effect without mu=", own[i]);
            diag_hint(diag, "mu=0.1 %s=... bounds %s by the load of its joint", own[i],
                      instance->name);
            diag_about(diag, "%s", own[i]);
            return status;
        }
    if (!is_by_load(instance)) {
        if (!instance_value(instance, "mu")->given)
            return OK;
        status = diag_set(diag, E_VALUE, "mu= needs a joint: terminals carry no load across");
        diag_hint(diag, "on terminals give the bound: %s=mu*n", bound_name(instance));
        diag_about(diag, "mu");
        return status;
    }
    TRY(check_not_negative(instance, "mu", diag));
    if (instance_value(instance, bound_name(instance))->given ||
        instance_value(instance, instance->on_angle ? "force" : "torque")->given) {
        const char *bound = instance_value(instance, "torque")->given ? "torque" : "force";

        status = diag_set(diag, E_VALUE, "%s takes mu= or %s=, not both", instance->name, bound);
        diag_hint(diag, "a second friction on the same joint adds a constant bound");
        diag_about(diag, "%s", bound);
        return status;
    }
    if (instance_value(instance, lacks)->given) {
        status = diag_set(diag, E_VALUE, "%s= does not fit: %s acts on %s", lacks, instance->name,
                          instance->on_angle ? "an angle" : "a length");
        diag_hint(diag, "use %s=", instance->on_angle ? "radius" : "span");
        diag_about(diag, "%s", lacks);
        return status;
    }
    if (instance->on_angle && !instance_value(instance, "radius")->given) {
        status =
            diag_set(diag, E_VALUE, "mu= on an angle needs radius=, the lever of the friction");
        diag_hint(diag, "mu=0.1 radius=20 mm");
        diag_about(diag, "mu");
        return status;
    }
    if (instance->on_angle)
        return check_not_negative(instance, "radius", diag);
    return instance_value(instance, "span")->given ? check_positive(instance, "span", diag) : OK;
}

Status check_static_ratio(const Instance *instance, const char *what, Diag *diag)
{
    const Expr ratio = instance_scalar(instance, "static");
    Status status;

    if (!expr_is_number(ratio) || expr_value(ratio) >= 1)
        return OK;
    status = diag_set(diag, E_VALUE, "static=%.6g: the static %s is not below the kinetic one",
                      expr_value(ratio), what);
    diag_hint(diag, "static= is their ratio, 1 or more");
    diag_about(diag, "static");
    return status;
}

static Status refuse_normal(const Instance *instance, Diag *diag)
{
    (void)diag_set(diag, E_VALUE, "normal= does not fit: %s acts in no plane between two frames",
                   instance->name);
    diag_hint(diag, "friction %s FRAME FRAME %s=... normal=z", instance->name,
              instance->on_angle ? "force" : bound_name(instance));
    diag_about(diag, "normal");
    return E_VALUE;
}

static Status friction_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    Status status;

    (void)arena;
    (void)planar;
    if (has_param(instance, "mu") && instance->row->rub == NULL)
        TRY(check_load(instance, diag));
    if (!is_by_load(instance))
        TRY(check_bound(instance, diag));
    TRY(check_static_ratio(instance, "bound", diag));
    if (!has_param(instance, "stribeck"))
        return OK;
    TRY(check_not_negative(instance, "stribeck", diag));
    TRY(check_not_negative(instance, "viscous", diag));
    if (!instance_value(instance, "stribeck")->given || instance_value(instance, "static")->given)
        return OK;
    status = diag_set(diag, E_VALUE, "stribeck= has no effect without static=");
    diag_hint(diag, "static=1.5 stribeck=%s falls from 1.5 times the bound at rest",
              instance->on_angle ? "0.1" : "0.01");
    diag_about(diag, "stribeck");
    return status;
}

static Status check_friction(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    if (instance_value(instance, "normal")->given)
        return refuse_normal(instance, diag);
    return friction_check(instance, arena, planar, diag);
}

/* of several directions */
static Status rub_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    static const char *const by_load[] = {"mu", "radius", "span"};

    for (int i = 0; i < COUNT(by_load); i++)
        if (instance_value(instance, by_load[i])->given) {
            (void)diag_set(diag, E_VALUE,
                           "%s= does not fit: %s acts in several directions, and follows no load",
                           by_load[i], instance->name);
            diag_hint(diag, "give the bound: %s=mu*n", bound_name(instance));
            diag_about(diag, "%s", by_load[i]);
            return E_VALUE;
        }
    if (instance->rubbed >= 0 && instance_value(instance, "normal")->given)
        return refuse_normal(instance, diag);
    return friction_check(instance, arena, planar, diag);
}

static Status oneway_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    TRY(check_unit(instance, diag));
    return instance_value(instance, bound_name(instance))->given
               ? check_not_negative(instance, bound_name(instance), diag)
               : OK;
}

/* --- rows --- */

/* a part on terminals of a shaft or slide */
#define ON_TERMINALS(row, domain_of, law, check_of, rigid)                                         \
    {                                                                                              \
        .name = #row, .sticks = true, .is_rigid = rigid, .family = FAMILY_SCALAR,                  \
        .domain = domain_of, .places = PLACES_TERMINALS, .params = row##_params,                   \
        .param_count = COUNT(row##_params), .translation = BRANCH_MAY, .preference = 30,           \
        .relation = law, .bound = friction_bound, .members = terminal_members,                     \
        .member_count = COUNT(terminal_members), .check = check_of                                 \
    }
#define ROWS(row, law, check_of, rigid)                                                            \
    static const Component row##_shaft = ON_TERMINALS(row, DOMAIN_SHAFT, law, check_of, rigid);    \
    static const Component row##_slide = ON_TERMINALS(row, DOMAIN_SLIDE, law, check_of, rigid);
#define VARIANTS(row, law, check_of, rigid)                                                        \
    ROWS(row, law, check_of, rigid)                                                                \
    static const Component *const row##_variants[] = {&row##_shaft, &row##_slide, NULL};

/* on a joint, by its load */
static const Component friction_by_load = {
    .name = "friction",
    .sticks = true,
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_LOAD,
    .places = PLACES_JOINT,
    .params = friction_params,
    .param_count = COUNT(friction_params),
    .preference = 30,
    .terminal_count = 1,
    .scalar_edges = (const ScalarEdge[]){{"", 0, -1, BRANCH_ALWAYS, 10}},
    .scalar_edge_count = 1,
    .effort = friction_effort,
    .bound = friction_bound,
    .relation = load_relation,
    .members = joint_members,
    .member_count = COUNT(joint_members),
    .check = check_friction,
};

/* between two frames, or in a joint of several coordinates */
static const Component friction_in_directions = {
    .name = "friction",
    .sticks = true,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_LINK,
    .params = friction_params,
    .param_count = COUNT(friction_params),
    .rub = friction_rub,
    .bound = friction_bound,
    .members = joint_members,
    .member_count = COUNT(joint_members),
    .check = rub_check,
};

#define clutch_params brake_params
ROWS(friction, friction_relation, check_friction, NULL)
static const Component *const friction_variants[] = {
    &friction_shaft, &friction_slide, &friction_by_load, &friction_in_directions, NULL};
VARIANTS(brake, friction_relation, friction_check, NULL)
VARIANTS(clutch, friction_relation, friction_check, NULL)
VARIANTS(oneway, oneway_relation, oneway_check, oneway_is_rigid)

const Component component_friction = {
    .name = "friction",
    .sticks = true,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_JOINT,
    .variants = friction_variants,
    .brief = "dry and viscous friction in a joint, a shaft or a slide",
    .params = friction_params,
    .param_count = COUNT(friction_params),
    .effort = friction_effort,
    .bound = friction_bound,
    .members = joint_members,
    .member_count = COUNT(joint_members),
    .check = check_friction,
    .help =
        "Dry friction on a joint's coordinate, or between two terminals of a shaft or slide: "
        "torque= on an angle, force= on a length, against the motion. At rest it holds up to "
        "static= times as much, and a run keeps it exactly at rest. With stribeck= the bound falls "
        "from the static to the kinetic one as T*(1 + (static - 1)*exp(-(rate/stribeck)^2)). "
        "viscous= adds a damper. The bound may be any expression of t, parameters and variables. "
        "With mu= the bound follows from the joint's reaction, NAME.load: of a revolute it is "
        "mu*radius times the norm of its force, in space with the component along the axis; of a "
        "prismatic it is mu times the norm of the force across its axis, plus that of its moment "
        "over span=.\n"
        "On a planarjoint the bound is on the norm of the force in its plane, on a spherical or "
        "another "
        "joint of three turns on that of the torque: it slips against its motion, in any "
        "direction. "
        "Between two frames force= acts at the second one, against its sliding along the plane of "
        "the first one that has the axis normal=. f.effort is the norm.",
    .example = "scene planar; gravity [0, -9.81]\nbody m mass=1\nprismatic s ground m axis=x\n"
               "friction f s force=5 static=1.2\nactuator l s force=2*t\n"
               "body b mass=2\narm top b [0, 0.5]\nrevolute h ground top\n"
               "friction g h mu=0.3 radius=20 mm\n"
               "init s = 0, s' = 0, h = 60 deg\nsimulate 4\n"
               "print s, s', f.effort, h [deg], g.load, g.effort",
    .see = "brake clutch oneway damper",
};

const Component component_brake = {
    .name = "brake",
    .sticks = true,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_JOINT,
    .variants = brake_variants,
    .brief = "brake on a joint, a shaft or a slide",
    .params = brake_params,
    .param_count = COUNT(brake_params),
    .effort = friction_effort,
    .bound = friction_bound,
    .members = joint_members,
    .member_count = COUNT(joint_members),
    .check = friction_check,
    .help = "Dry friction whose bound is applied: torque= or force= is an expression of t, "
            "parameters and variables, 0 while the brake is open. At rest it holds up to static= "
            "times as much.",
    .example = "flywheel J1 a 0 J=0.5\nbrake b1 a 0 torque=if(t > 1, 20, 0)\n"
               "init J1.w = 50\nsimulate 3\nprint J1.w",
    .see = "clutch friction",
};

const Component component_clutch = {
    .name = "clutch",
    .sticks = true,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_JOINTS,
    .variants = clutch_variants,
    .brief = "friction clutch between two joints, two shafts or two slides",
    .params = clutch_params,
    .param_count = COUNT(clutch_params),
    .effort = friction_effort,
    .bound = friction_bound,
    .members = joint_members,
    .member_count = COUNT(joint_members),
    .check = friction_check,
    .help = "Dry friction between the coordinates of two joints, or between two terminals of a "
            "shaft or slide. torque= or force= is the kinetic bound, an expression of t, "
            "parameters and variables; it sticks with up to static= times as much.",
    .example = "flywheel J1 a 0 J=0.5\nflywheel J2 b 0 J=1\n"
               "clutch c1 a b torque=20*min(t, 1) static=1.1\n"
               "init J1.w = 50, J2.w = 0\nsimulate 3\nprint J1.w, J2.w, c1.torque",
    .see = "brake oneway friction",
};

const Component component_oneway = {
    .name = "oneway",
    .sticks = true,
    .is_rigid = oneway_is_rigid,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_JOINTS,
    .variants = oneway_variants,
    .brief = "one-way clutch between two joints, two shafts or two slides",
    .params = oneway_params,
    .param_count = COUNT(oneway_params),
    .effort = oneway_effort,
    .bound = friction_bound,
    .members = joint_members,
    .member_count = COUNT(joint_members),
    .check = oneway_check,
    .help = "The first of two joints, shafts or slides drives the second along and never runs "
            "ahead of it; the second may run ahead freely. It is rigid; with torque= or force= it "
            "slips where it would carry more.",
    .example = "flywheel J1 a 0 J=0.5\nflywheel J2 b 0 J=1\ntorquesource T1 a 0 10*sin(t)\n"
               "shaft d1 b 0 d=0.3\noneway o1 a b torque=1000\n"
               "init J1.w = 0, J2.w = 0\nsimulate 10\nprint J1.w, J2.w, o1.torque",
    .see = "clutch brake",
};
