/* hydraulic.c: pipe, tank, inertance, valve, pump; cylinder
 *
 * p (Pa) is the pressure of plus against minus, q (m^3/s) the volume flow from plus to minus
 * inside. A cylinder on a slide's coordinate s: q = A s', force on the head F = A p, so that p q =
 * F s'. */
#include "component/component_rows.h"

/* clang-format off */
static const Param pipe_params[] = {
    {"R", PARAM_LAW,    "Pa*s/m^3",   "0", "pressure per flow, of laminar flow", 0},
    {"k", PARAM_LAW,    "Pa*s^2/m^6", "0", "pressure per flow squared, of turbulent flow: k*q*|q|", 0},
};
static const Param valve_params[] = {
    {"R",    PARAM_LAW,    "Pa*s/m^3",   "0",  "pressure per flow while it is open, of laminar flow", 0},
    {"k",    PARAM_LAW,    "Pa*s^2/m^6", "0",  "pressure per flow squared while it is open: k*q*|q|", 0},
    {"when", PARAM_LAW,    NULL,         NULL, "condition under which it is open", 0},
    {"Roff", PARAM_SCALAR, "Pa*s/m^3",   "0", "pressure per flow of the leakage while it is closed; 0: no leakage", 0},
};
static const Param tank_params[] = {
    {"A",   PARAM_SCALAR, "m^2",    "0",    "area of the surface; C = A/(rho*g)", 0},
    {"rho", PARAM_SCALAR, "kg/m^3", "1000", "density of the liquid, with A=", 0},
    {"g",   PARAM_SCALAR, "m/s^2",  "9.81", "acceleration of free fall, with A=", 0},
    {"C",   PARAM_SCALAR, "m^3/Pa", "0",    "volume per pressure, instead of A=", 0},
};
static const Param inertance_params[] = {
    {"I", PARAM_SCALAR, "Pa*s^2/m^3", NULL, "pressure per rate of flow: density*length/area of a pipe", 0},
};
static const Param pump_params[] = {
    {"pressure", PARAM_LAW, "Pa",    "0", "of plus against minus, whatever the flow", GIVES_SOURCE},
    {"flow",     PARAM_LAW, "m^3/s", "0", "given to plus, taken from minus, whatever the pressure", GIVES_SOURCE},
};
static const Param cylinder_params[] = {
    {"area", PARAM_SCALAR, "m^2", NULL, "of the piston", 0},
};

static const Member tank_members[] = {
    {"volume", "m^3", "volume that its pressure holds, C*p", 2},
};
static const Member inertance_members[] = {
    {"impulse", "Pa*s", "of the liquid, I*flow", 2},
};
static const Member cylinder_members[] = {
    {"force", "N", "on the tip of the slide, along its coordinate", 0},
};
/* clang-format on */

static Expr resistance(const Instance *instance, Arena *arena, Expr flow)
{
    return expr_add(
        arena, instance_scalar(instance, "R"),
        expr_mul(arena, instance_scalar(instance, "k"), expr_call1(arena, OP_ABS, flow)));
}

/* q from p = R q + k q |q|, for either sign: 2 p/(R + sqrt(R^2 + 4 k |p|)) */
static Expr flow_of(const Instance *instance, Arena *arena, Expr p)
{
    Expr R = instance_scalar(instance, "R");
    Expr k = instance_scalar(instance, "k");
    Expr size = expr_call1(arena, OP_ABS, p);
    Expr root;

    if (expr_is_zero(k))
        return expr_div(arena, p, R);
    if (expr_is_zero(R))
        return expr_mul(arena, expr_call1(arena, OP_SIGN, p),
                        expr_sqrt(arena, expr_div(arena, size, k)));
    root = expr_product(arena, (Expr[]){expr_int(arena, 4), k, size}, 3);
    root = expr_sqrt(arena, expr_add(arena, expr_square(arena, R), root));
    return expr_div(arena, expr_mul(arena, expr_int(arena, 2), p), expr_add(arena, R, root));
}

static Status check_resistance(const Instance *instance, Diag *diag)
{
    TRY(check_not_negative(instance, "R", diag));
    TRY(check_not_negative(instance, "k", diag));
    if (!expr_is_zero(instance_scalar(instance, "R")) ||
        !expr_is_zero(instance_scalar(instance, "k")))
        return OK;
    (void)diag_set(diag, E_VALUE, "%s %s needs R= or k=", instance->row->name, instance->name);
    diag_hint(diag, "R is pressure per flow, k pressure per flow squared");
    return E_VALUE;
}

static void pipe_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    bool is_linear = expr_is_zero(instance_scalar(instance, "k"));
    Expr R = instance_scalar(instance, "R");

    (void)which;
    *out = (Relation){.kind = RELATION_RESISTIVE,
                      .value = resistance(instance, arena, motion->through),
                      .rest = expr_int(arena, 0)};
    if (!is_linear && expr_is_zero(expr_diff(arena, R, motion->through)) &&
        expr_is_zero(expr_diff(arena, instance_scalar(instance, "k"), motion->through)))
        out->inverse = flow_of(instance, arena, motion->across);
}

static Status pipe_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return check_resistance(instance, diag);
}

const Component component_pipe = {
    .name = "pipe",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_HYDRAULIC,
    .places = PLACES_TERMINALS,
    .brief = "hydraulic resistance: p = R*q + k*q*|q|",
    .params = pipe_params,
    .param_count = COUNT(pipe_params),
    .translation = BRANCH_MAY,
    .preference = 30,
    .relation = pipe_relation,
    .check = pipe_check,
    .help = "A pipe or an orifice between two terminals: p = R*q for laminar flow, k*q*|q| for "
            "turbulent flow, or the sum of both. An orifice of area a has k = density/2/(c*a)^2 "
            "with c about 0.6. With k alone the slope is zero where the flow reverses; a small "
            "R in addition removes that. R and k may be expressions of t and of variables, also "
            "of its own.",
    .example = "tank T1 a 0 A=0.5\npipe P1 a 0 k=5e8\ninit T1.p = 10 kPa\nsimulate 60\n"
               "print T1.p, P1.flow",
    .see = "tank valve inertance pump",
};

static Expr capacity(const Instance *instance, Arena *arena)
{
    if (instance_value(instance, "C")->given)
        return instance_scalar(instance, "C");
    return expr_div(
        arena, instance_scalar(instance, "A"),
        expr_mul(arena, instance_scalar(instance, "rho"), instance_scalar(instance, "g")));
}

static void tank_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)which;
    scalar_storage(RELATION_CAPACITIVE, capacity(instance, arena), motion->across, arena, out);
}

static Status tank_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    static const char *const with_area[] = {"A", "rho", "g"};
    bool area = instance_value(instance, "A")->given;
    Status status = OK;

    (void)arena;
    (void)planar;
    if (area == instance_value(instance, "C")->given) {
        status =
            diag_set(diag, E_VALUE,
                     area ? "tank %s has A= and C=" : "tank %s needs A= or C=", instance->name);
        diag_hint(diag, "A is the area of its surface; C = A/(rho*g) is volume per pressure");
        goto done;
    }
    if (!area)
        return check_positive(instance, "C", diag);
    for (int i = 0; i < COUNT(with_area); i++)
        CHECK(check_positive(instance, with_area[i], diag));
done:
    return status;
}

const Component component_tank = {
    .name = "tank",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_HYDRAULIC,
    .places = PLACES_TERMINALS,
    .brief = "open tank, or any volume that depends on pressure: q = C*p'",
    .params = tank_params,
    .param_count = COUNT(tank_params),
    .translation = BRANCH_MAY,
    .preference = 20,
    .relation = tank_relation,
    .members = tank_members,
    .member_count = COUNT(tank_members),
    .check = tank_check,
    .help = "Liquid with a free surface of area A. Its pressure at the bottom is rho*g times "
            "the level, so that q = C*p' with C = A/(rho*g); the defaults are water and 9.81 "
            "m/s^2. C= sets the volume per pressure directly, as for a gas spring or the "
            "liquid's own compressibility (volume/bulk modulus). The second terminal is 0. Its "
            "pressure is a state; init may set it.",
    .example = "pump U1 a 0 flow=1e-3\ntank T1 a 0 A=0.5\npipe P1 a 0 R=1e7\ninit T1.p = 0\n"
               "simulate 300\nprint T1.p, T1.volume, P1.flow",
    .see = "pipe pump inertance init",
};

static void inertance_relation(const Instance *instance, Arena *arena, int which,
                               const Motion1 *motion, Relation *out)
{
    (void)which;
    scalar_storage(RELATION_INDUCTIVE, instance_scalar(instance, "I"), motion->through, arena, out);
}

const Component component_inertance = {
    .name = "inertance",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_HYDRAULIC,
    .places = PLACES_TERMINALS,
    .brief = "inertia of the liquid in a pipe: p = I*q'",
    .params = inertance_params,
    .param_count = COUNT(inertance_params),
    .translation = BRANCH_MAY,
    .preference = 40,
    .relation = inertance_relation,
    .members = inertance_members,
    .member_count = COUNT(inertance_members),
    .positive = "I",
    .help = "The inertia of the liquid in a pipe: p = I*q' with I = density*length/area. Its "
            "flow is a state; init may set it.",
    .example = "tank T1 a 0 A=0.01\ninertance I1 a b I=1e7\npipe P1 b 0 R=2e6\n"
               "init T1.p = 10 kPa, I1.flow = 0\nsimulate 5\nprint I1.flow, T1.p",
    .see = "pipe tank init",
};

static void valve_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    Expr off = instance_scalar(instance, "Roff");
    Expr closed = expr_is_zero(off) ? expr_int(arena, 0) : expr_div(arena, motion->across, off);

    (void)which;
    *out = (Relation){.kind = RELATION_CONDUCTIVE,
                      .value = expr_if(arena, instance_scalar(instance, "when"),
                                       flow_of(instance, arena, motion->across), closed)};
}

static Status valve_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    TRY(check_resistance(instance, diag));
    if (instance_value(instance, "Roff")->given)
        TRY(check_positive(instance, "Roff", diag));
    return OK;
}

const Component component_valve = {
    .name = "valve",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_HYDRAULIC,
    .places = PLACES_TERMINALS,
    .brief = "pipe that a condition opens",
    .params = valve_params,
    .param_count = COUNT(valve_params),
    .translation = BRANCH_MAY,
    .preference = 30,
    .relation = valve_relation,
    .check = valve_check,
    .help = "A pipe while the condition when= holds, with R, k or both as for pipe. Otherwise "
            "nothing flows, or with Roff= the leakage. R and k may be expressions of t and of "
            "variables. The condition compares time, parameters and variables; a run locates "
            "the instants at which it changes. when=V1.p > 0 makes valve V1 a check valve.",
    .example = "pump U1 a 0 pressure=2e5\nvalve V1 a b R=1e8 when=t > 1\ntank T1 b 0 C=1e-8\n"
               "init T1.p = 0\nsimulate 5\nprint V1.flow, T1.p",
    .see = "pipe pump tank",
};

static void pump_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)which;
    (void)motion;
    if (instance_value(instance, "pressure")->given)
        *out = (Relation){.kind = RELATION_ACROSS, .value = instance_scalar(instance, "pressure")};
    else
        *out = (Relation){.kind = RELATION_THROUGH,
                          .value = expr_neg(arena, instance_scalar(instance, "flow"))};
}

static Status pump_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    bool pressure = instance_value(instance, "pressure")->given;
    Status status;

    (void)arena;
    (void)planar;
    if (pressure != instance_value(instance, "flow")->given)
        return OK;
    status =
        diag_set(diag, E_VALUE,
                 pressure ? "pump %s has pressure= and flow=" : "pump %s needs pressure= or flow=",
                 instance->name);
    diag_hint(diag, "it holds one of the two, and the other follows from the circuit");
    return status;
}

const Component component_pump = {
    .name = "pump",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_HYDRAULIC,
    .places = PLACES_TERMINALS,
    .brief = "source of pressure or of flow",
    .params = pump_params,
    .param_count = COUNT(pump_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = pump_relation,
    .check = pump_check,
    .help = "With pressure= it sets the pressure of its first terminal relative to the second, "
            "whatever the flow. With flow= it supplies that flow to the first terminal and "
            "takes it from the second, whatever the pressure; as flow is positive from plus to "
            "minus inside, U1.flow is then minus the value. Both may be any expression of t, "
            "parameters and other variables.",
    .example = "pump U1 a 0 flow=1e-4*(1 + sin(10*t))\npipe P1 a b R=1e9\ntank T1 b 0 C=1e-9\n"
               "pipe P2 b 0 R=5e9\ninit T1.p = 0\nsimulate 10\nprint U1.p, U1.flow, T1.p",
    .see = "pipe tank valve cylinder",
};

static void cylinder_relation(const Instance *instance, Arena *arena, int which,
                              const Motion1 *motion, Relation *out)
{
    (void)which;
    *out = (Relation){.kind = RELATION_THROUGH,
                      .value = expr_mul(arena, instance_scalar(instance, "area"), motion->rate)};
}

static Expr cylinder_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    return expr_mul(arena, instance_scalar(instance, "area"), motion->across);
}

static Status cylinder_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    TRY(scalar_check_hinge(instance, false,
                           "a cylinder on a hinge: put it between two bodies as a prismatic "
                           "joint of its own",
                           diag));
    return check_positive(instance, "area", diag);
}

const Component component_cylinder = {
    .name = "cylinder",
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_HYDRAULIC,
    .places = PLACES_TRANSDUCER,
    .brief = "hydraulic cylinder on a slide",
    .params = cylinder_params,
    .param_count = COUNT(cylinder_params),
    .translation = BRANCH_MAY,
    .preference = 50,
    .effort = cylinder_effort,
    .relation = cylinder_relation,
    .members = cylinder_members,
    .member_count = COUNT(cylinder_members),
    .check = cylinder_check,
    .help = "A piston on the coordinate s of a slide. It takes the flow area*s' at its first "
            "terminal. The pressure of this terminal relative to the second pushes the tip with "
            "area*p along the coordinate. A double-acting piston is two cylinders: the second "
            "acts on the same slide, with its terminals exchanged.",
    .example = "scene planar\ngravity [0, -9.81]\nbody load mass=500 inertia=1\n"
               "prismatic s1 ground load axis=y\npump U1 a 0 pressure=20e5\npipe P1 a b R=1e10\n"
               "cylinder Y1 s1 b 0 area=30e-4\ninit s1 = 0, s1' = 0\nsimulate 1\n"
               "print s1', Y1.p, Y1.force",
    .see = "pump pipe prismatic rodend",
};
