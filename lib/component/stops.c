/* stops.c: limits of a coordinate: stop, backlash; rigid, or compliant
 *
 * x is the joint's coordinate, the first joint's less the second's, or the distance of two frames;
 * g = x - high and g = low - x are beyond 0 where a limit is passed. On the tip acts
 *
 *     rigid       -unilateral(x - high, e) + unilateral(low - x, e)
 *     compliant   -(k g + d g') where g > 0 and that is positive, likewise for low
 *
 * What meets a rigid limit has an impact there (simulate/run/impact.c). A compliant limit never
 * pulls. */
#include "component/component_rows.h"

/* clang-format off */
#define LAW                                                                                         \
    {"e", PARAM_SCALAR, "1", "0", "coefficient of restitution, 0 to 1, where it is rigid", 0},      \
    {"k", PARAM_SCALAR, "N/m|N*m", "0", "stiffness beyond the limit; without it, it is rigid", 0},  \
    {"d", PARAM_SCALAR, "N*s/m|N*m*s", "0", "damping beyond the limit, with k=", 0}
/* clang-format on */

static const Param stop_params[] = {
    {"low", PARAM_SCALAR, "m|rad", "0", "least value; without it there is none", 0},
    {"high", PARAM_SCALAR, "m|rad", "0", "largest value; without it there is none", 0},
    LAW,
};
static const Param backlash_params[] = {
    {"gap", PARAM_SCALAR, "m|rad", NULL, "way between both limits, half of it on either side of 0",
     0},
    LAW,
};

static const Member effort_members[] = {
    {"effort", NULL, "force or torque on the tip, or on the first of two joints", 0},
};

static bool is_rigid(const Instance *instance)
{
    return !instance_has(instance, "k");
}

/* the effort against g > 0; rate: g' */
static Expr limit_effort(const Instance *instance, Arena *arena, Expr g, Expr rate)
{
    const Expr zero = expr_int(arena, 0);
    Expr push;

    if (is_rigid(instance))
        return expr_call2(arena, OP_UNILATERAL, g, instance_scalar(instance, "e"));
    push = expr_mul(arena, instance_scalar(instance, "k"), g);
    if (!instance_has(instance, "d"))
        return expr_call1(arena, OP_RAMP, push);
    push = expr_add(arena, push, expr_mul(arena, instance_scalar(instance, "d"), rate));
    return expr_if(arena, expr_call2(arena, OP_LT, zero, g), expr_call1(arena, OP_RAMP, push),
                   zero);
}

static Expr above(const Instance *instance, Arena *arena, const Motion1 *motion, Expr high)
{
    return limit_effort(instance, arena, expr_sub(arena, motion->displacement, high), motion->rate);
}

static Expr below(const Instance *instance, Arena *arena, const Motion1 *motion, Expr low)
{
    return limit_effort(instance, arena, expr_sub(arena, low, motion->displacement),
                        expr_neg(arena, motion->rate));
}

static Expr stop_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    Expr effort = expr_int(arena, 0);

    if (instance_has(instance, "high"))
        effort = expr_sub(arena, effort,
                          above(instance, arena, motion, instance_scalar(instance, "high")));
    if (instance_has(instance, "low"))
        effort = expr_add(arena, effort,
                          below(instance, arena, motion, instance_scalar(instance, "low")));
    return effort;
}

static Expr backlash_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    const Expr half = expr_mul(arena, expr_rational(arena, 1, 2), instance_scalar(instance, "gap"));

    return expr_sub(arena, below(instance, arena, motion, expr_neg(arena, half)),
                    above(instance, arena, motion, half));
}

/* --- checks --- */

Status check_limit_law(const Instance *instance, const char *const *of_k, Diag *diag)
{
    const Expr e = instance_scalar(instance, "e");
    const bool is_compliant = !is_rigid(instance);
    Status status;

    if (is_compliant && instance_has(instance, "e")) {
        status = diag_set(diag, E_VALUE, "%s takes e= or k=, not both", instance->name);
        diag_hint(diag, "e= belongs to a rigid limit; %s= damps a compliant one", of_k[0]);
        diag_about(diag, "e");
        return status;
    }
    for (int i = 0; of_k[i] != NULL; i++)
        if (!is_compliant && instance_has(instance, of_k[i])) {
            status = diag_set(diag, E_VALUE, "%s= has no effect without k=", of_k[i]);
            diag_hint(diag, "a rigid limit takes e=, the coefficient of restitution");
            diag_about(diag, "%s", of_k[i]);
            return status;
        }
    if (is_compliant) {
        TRY(check_positive(instance, "k", diag));
        return check_not_negative(instance, of_k[0], diag);
    }
    if (!expr_is_number(e) || (expr_value(e) >= 0 && expr_value(e) <= 1))
        return OK;
    status = diag_set(diag, E_VALUE, "e=%.6g is not between 0 and 1", expr_value(e));
    diag_hint(diag, "0: it stays; 1: it bounces without a loss");
    diag_about(diag, "e");
    return status;
}

static const char *const of_k[] = {"d", NULL};

static Status stop_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    const Expr low = instance_scalar(instance, "low"), high = instance_scalar(instance, "high");
    Status status;

    (void)arena;
    (void)planar;
    TRY(check_limit_law(instance, of_k, diag));
    if (!instance_has(instance, "low") && !instance_has(instance, "high")) {
        status = diag_set(diag, E_VALUE, "%s has no limit", instance->name);
        diag_hint(diag, "low=, high= or both");
        return status;
    }
    if (!instance_has(instance, "low") || !instance_has(instance, "high") || !expr_is_number(low) ||
        !expr_is_number(high) || expr_value(low) < expr_value(high))
        return OK;
    status = diag_set(diag, E_VALUE, "low= is not below high=");
    diag_hint(diag, "a weld or a driver holds a coordinate at one value");
    diag_about(diag, "low");
    return status;
}

static Status backlash_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    TRY(check_positive(instance, "gap", diag));
    return check_limit_law(instance, of_k, diag);
}

/* --- rows --- */

const Component component_stop = {
    .name = "stop",
    .is_rigid = is_rigid,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_LINK,
    .brief = "limits of a joint's coordinate, or of the distance of two frames",
    .params = stop_params,
    .param_count = COUNT(stop_params),
    .effort = stop_effort,
    .members = effort_members,
    .member_count = COUNT(effort_members),
    .check = stop_check,
    .help =
        "A coordinate is kept between low= and high=. Without k= the limits are rigid: what meets "
        "one has an impact with the coefficient of restitution e=, and bounces that become ever "
        "shorter end at rest. With k= a limit is a spring, with d= and a damper, that pushes and "
        "never "
        "pulls. Between two frames the limits are those of their distance: high= alone is a rope.",
    .example = "scene planar; gravity [0, -9.81]\nbody m mass=1 inertia=0.1\n"
               "prismatic s ground m axis=y\nstop floor s low=0 e=0.5\n"
               "init s = 1, s' = 0\nsimulate 2\nprint s, s', floor.effort",
    .see = "backlash friction",
};

const Component component_backlash = {
    .name = "backlash",
    .is_rigid = is_rigid,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_JOINTS,
    .terminal_usage = " JOINT JOINT",
    .brief = "play between the coordinates of two joints",
    .params = backlash_params,
    .param_count = COUNT(backlash_params),
    .effort = backlash_effort,
    .members = effort_members,
    .member_count = COUNT(effort_members),
    .check = backlash_check,
    .help = "The first joint's coordinate less the second's is kept within half the gap on either "
            "side of 0. The limits are rigid, with the coefficient of restitution e=, or compliant "
            "with k= and d=, as those of a stop.",
    .example = "scene planar\nbody a mass=1 inertia=0.1\nbody b mass=1 inertia=0.2\n"
               "revolute h1 ground a\nrevolute h2 ground b\nbacklash g h1 h2 gap=2 deg e=0.3\n"
               "init h1 = 0, h2 = 0, h1' = 1, h2' = 0\nsimulate 1\nprint h1', h2'",
    .see = "stop coupler clutch",
};
