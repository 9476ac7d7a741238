/* touching.c: what rolls without slipping, and contacts that open, with friction
 *
 * What rolls has the rows of its shape (contacts.c).
 *
 * Of a contact g is the gap and v the velocity of the point of contact along the surface
 * (contacts.c). On the tip act, with h = -g,
 *
 *     normal force   P = unilateral(h, e)                 where it is rigid, or
 *                    P = k h^n (1 + c h')                 where h > 0 and that is positive
 *     friction       T = -coulomb(v, |v|, mu P)           where it is rigid: mu P v/|v|, and at
 *                                                         rest up to r mu P, or
 *                    T = -mu P stick(v, r)                likewise
 *
 * In space v has two components and direction() is in the place of stick().
 *
 * Source of the compliant law: Hunt and Crossley, J. Appl. Mech. 42 (1975), 440. */
#include "component/component_rows.h"
#include "component/contacts.h"

/* clang-format off */
static const Param contact_params[] = {
    SHAPE_PARAMS, FRICTION_PARAMS,
    {"e", PARAM_SCALAR, "1", "0", "coefficient of restitution, 0 to 1, where it is rigid", 0},
    {"k", PARAM_SCALAR, "N/m", "0", "stiffness; without it the contact is rigid", 0},
    {"exponent", PARAM_SCALAR, "1", "1", "with k=, of the way: 1.5 of balls (Hertz); k in N/m^exponent", 0},
    {"damping", PARAM_SCALAR, "s/m", "0", "with k=: force over that of the spring, per velocity", 0},
};
static const Param roll_params[] = {ROLL_PARAMS};

static const Member roll_members[] = {
    {"fn", "N", "force on the tip along the normal", 0},
    {"ft", "N", "magnitude of the force along the plane", 0},
};

static const Member touch_members[] = {
    {"fn",   "N",   "normal force on the tip", 0},
    {"ft",   "N",   "friction on the tip; in space its magnitude", 0},
    {"gap",  "m",   "distance of the two", 1},
    {"slip", "m/s", "velocity of the point of contact along the surface; in space its magnitude", 0},
    {"bound", "N",  "the most that its friction is at the present slip", 0},
    {"hold", "N",   "the most that it holds at rest", 0},
    {"loss", "W",   "power lost in friction", 0},
    {"lost", "J",   "energy lost in friction since the run began", 0},
};
/* clang-format on */

static bool is_compliant(const Instance *instance)
{
    return instance_has(instance, "k");
}

static bool touch_is_rigid(const Instance *instance)
{
    return !is_compliant(instance);
}

static Expr touch_press(const Instance *instance, Arena *arena, Expr gap, Expr rate)
{
    const Expr h = expr_neg(arena, gap), one = expr_int(arena, 1);
    Expr way, damping;

    if (!is_compliant(instance))
        return expr_call2(arena, OP_UNILATERAL, h,
                          component_param(instance->row, "e") >= 0 ? instance_scalar(instance, "e")
                                                                   : expr_int(arena, 0));
    way = expr_pow(arena, expr_call1(arena, OP_RAMP, h), instance_scalar(instance, "exponent"));
    way = expr_mul(arena, instance_scalar(instance, "k"), way);
    if (!instance_has(instance, "damping"))
        return way;
    damping = expr_mul(arena, instance_scalar(instance, "damping"), rate);
    return expr_mul(arena, way, expr_call1(arena, OP_RAMP, expr_sub(arena, one, damping)));
}

static Expr kinetic_bound(const Instance *instance, Arena *arena, Expr load)
{
    return expr_mul(arena, friction_positive(arena, instance_scalar(instance, "mu")), load);
}

static Expr touch_bound(const Instance *instance, Arena *arena, Expr rate, Expr load, bool at_rest)
{
    const Expr bound = kinetic_bound(instance, arena, load);

    (void)rate;
    return at_rest ? expr_mul(arena, instance_scalar(instance, "static"), bound) : bound;
}

static Expr touch_rub(const Instance *instance, Arena *arena, Expr rate, Expr speed, Expr load)
{
    const Expr kinetic = kinetic_bound(instance, arena, load);
    const Expr at_rest = touch_bound(instance, arena, rate, load, true);
    const Expr ratio = instance_scalar(instance, "static"), zero = expr_int(arena, 0);
    const Expr n = speed != NULL ? speed : rate;
    Expr bound, side;

    if (!is_compliant(instance)) {
        bound = expr_if(arena, expr_call2(arena, OP_EQ, n, zero), at_rest, kinetic);
        return expr_neg(arena, expr_call(arena, OP_COULOMB, (Expr[]){rate, n, bound}));
    }
    side = speed != NULL ? expr_call(arena, OP_DIRECTION, (Expr[]){rate, n, ratio})
                         : expr_call2(arena, OP_STICK, rate, ratio);
    return expr_neg(arena, expr_mul(arena, kinetic, side));
}

/* --- checks --- */

static Status check_coefficients(const Instance *instance, Diag *diag)
{
    TRY(check_not_negative(instance, "mu", diag));
    if (instance_has(instance, "static") && !instance_has(instance, "mu"))
        return contact_refuse(diag, "static", "static= has no effect without mu=",
                              "mu= is the coefficient of friction");
    return check_static_ratio(instance, "coefficient", diag);
}

/* a bowl's tangents are not those of its rows */
static Status check_tangents(const Instance *instance, bool planar, Diag *diag)
{
    const char *name = instance_has(instance, "bowl") ? "bowl" : "dome";

    if (planar || !instance_has(instance, "mu") ||
        (!instance_has(instance, "bowl") && !instance_has(instance, "dome")))
        return OK;
    return contact_refuse(diag, name, "mu= is of planes in a spatial scene",
                          "in a bowl or on a dome a ball rolls without slipping: roll without mu=");
}

static Status roll_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    TRY(check_shape(instance, planar, false, diag));
    if (instance_has(instance, "static"))
        return contact_refuse(diag, "static", "static= has no effect without mu=",
                              "mu= lets it slip; without it nothing bounds the friction");
    if (instance_has(instance, "offset") && !planar)
        return contact_refuse(diag, "offset", "offset= belongs to rolling in a planar scene",
                              "in space an initial position may be any: init");
    return OK;
}

static Status roll_slip_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    TRY(check_shape(instance, planar, false, diag));
    TRY(check_coefficients(instance, diag));
    TRY(check_tangents(instance, planar, diag));
    if (instance_has(instance, "offset"))
        return contact_refuse(diag, "offset", "offset= and mu= exclude each other",
                              "what may slip isn't tied to its angle");
    return OK;
}

static Status contact_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    static const char *const of_k[] = {"damping", "exponent", NULL};

    (void)arena;
    TRY(check_shape(instance, planar, true, diag));
    TRY(check_coefficients(instance, diag));
    TRY(check_tangents(instance, planar, diag));
    TRY(check_limit_law(instance, of_k, diag));
    return is_compliant(instance) ? check_positive(instance, "exponent", diag) : OK;
}

/* --- rows --- */

static const Component roll_that_slips = {
    .name = "roll",
    .sticks = true,
    .is_rigid = touch_is_rigid,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .params = roll_params,
    .param_count = COUNT(roll_params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .contact = roll_contact,
    .press = touch_press,
    .rub = touch_rub,
    .bound = touch_bound,
    .rings = roll_rings,
    .members = touch_members,
    .member_count = COUNT(touch_members),
    .check = roll_slip_check,
};

static const Component *const roll_variants[] = {&roll_that_slips, NULL};

const Component component_roll = {
    .name = "roll",
    .variants = roll_variants,
    .family = FAMILY_CONTACT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "a wheel, ball or ellipsoid that rolls on a plane, or a ball in a bowl",
    .params = roll_params,
    .param_count = COUNT(roll_params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 95,
    .contact = roll_contact,
    .rings = roll_rings,
    .members = roll_members,
    .member_count = COUNT(roll_members),
    .check = roll_check,
    .help =
        "The tip rolls on the tail without slipping and without leaving it. The plane goes through "
        "the tail's origin. A wheel turns about axle=, its contact point is the lowest of its rim; "
        "without axle= a ball rolls, with semiaxes= an ellipsoid. bowl= and dome= make the tail a "
        "sphere. In space the velocity along the surface is 0, which takes freedoms of motion but "
        "not of place. In a planar scene the way is tied to the angle: t.c + radius*theta = "
        "offset. With mu= it may slip and leave the surface: it is then a contact with that "
        "coefficient of friction and no restitution.",
    .example = "gravity [0, 0, -9.81]\n"
               "body coin mass=0.02 inertia=[1.25e-6, 1.25e-6, 2.5e-6] euler=zxz\n"
               "roll r1 ground coin axle=z radius=16 mm\n"
               "init coin.x = 0, coin.y = 0, coin.a1 = 0, coin.a2 = 60 deg, coin.a3 = 0\n"
               "init coin.a1' = 0, coin.a2' = 0, coin.a3' = 20\n"
               "simulate 1\nprint coin.x, coin.y, r1.fn",
    .see = "knife coupler contact",
};

const Component component_contact = {
    .name = "contact",
    .sticks = true,
    .is_rigid = touch_is_rigid,
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "a point, wheel or ball that may touch a plane, with friction",
    .params = contact_params,
    .param_count = COUNT(contact_params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .contact = roll_contact,
    .press = touch_press,
    .rub = touch_rub,
    .bound = touch_bound,
    .rings = roll_rings,
    .members = touch_members,
    .member_count = COUNT(touch_members),
    .check = contact_check,
    .help =
        "The tip can't go through a plane of the tail, and may leave it. Its shape is a point at "
        "its origin, or with radius=, axle=, semiaxes= that of 'roll'; bowl= and dome= make the "
        "tail a sphere. Without k= it is rigid: what meets it has an impact with the coefficient "
        "of restitution e= (Poisson), in which friction takes part. With k= it is a spring that "
        "never pulls. mu= is the coefficient of friction, static= over the one at rest: it sticks "
        "while less is needed, and slips otherwise.",
    .example = "scene planar; gravity [0, -9.81]\nbody ball mass=0.6 inertia=1e-3\n"
               "contact c1 ground ball radius=0.1 e=0.6 mu=0.3\n"
               "init ball.x = 0, ball.y = 1, ball.theta = 0\n"
               "init ball.x' = 1, ball.y' = 0, ball.theta' = 20\n"
               "simulate 2\nprint ball.x, ball.y, c1.fn, c1.slip",
    .see = "roll stop friction",
};
