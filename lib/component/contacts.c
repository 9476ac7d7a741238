/* contacts.c: what rolls without slipping, blades, rods, and points in a plane or on a line
 *
 * All in axes of the tail, whose plane goes through its origin with the normal z; c (m) is the way
 * to the head's origin, rho (m) that from there to the point of contact, and v + w x rho the
 * velocity of the head's point against the tail's. Rolling is v + w x rho = 0: its component along
 * the normal is the rate of the gap, the others are velocity rows.
 *
 *     ball         rho = -r z                  gap = z.c - r
 *     wheel        rho = -r d - s z            gap = z.c - r |z - (z.a) a| - s
 *                  d = z - (z.a) a, of length 1; a: its axle; s: radius of its round rim
 *     ellipsoid    rho = -R A^2 m/h            gap = z.c - h
 *                  m = R^T z, h = |A m|, A = diag(a, b, c), R: from axes of the head
 *     in a bowl    rho = r c/|c|               gap = R - r - |c|;    on a dome |c| - R - r
 *     in the plane t.c + r theta = offset, t = z x (out of the plane): a position row
 *
 * A rod of length L holds |c| = L, a point in the plane z.c = 0, one on a line n1.c = n2.c = 0.
 *
 * theory 14; P. Meijaard et al., Proc. R. Soc. A 463 (2007), 1955, have wheels with round rims. */
#include "component/contacts.h"

#include "component/component_rows.h"

/* clang-format off */
static const Param knife_params[] = {
    {"along",  PARAM_AXIS, "1", "x", "the direction in which the blade goes, in the axes of the tip", 0},
    {"normal", PARAM_AXIS, "1", "z", "of the plane that it goes on, in the axes of the tail", 0},
};

static const Param link_params[] = {
    {"length", PARAM_SCALAR, "m", NULL, "distance of the frames", POSITIONAL},
};

static const Param plane_params[] = {
    {"normal", PARAM_AXIS, "1", "z", "of the plane through the tail's origin, in the axes of the tail; planar: y", 0},
};

static const Param line_params[] = {
    {"axis", PARAM_AXIS, "1", "x", "of the line through the tail's origin, in the axes of the tail", 0},
};

static const Member link_members[] = {
    {"fn", "N", "force on the tip away from the tail: below 0 where the rod is pulled", 0},
};

static const Member plane_members[] = {
    {"fn", "N", "force on the tip along the normal", 0},
};

static const Member line_members[] = {
    {"fn", "N", "force on the tip across the line; in space along the first of two normals", 0},
};

static const Member knife_members[] = {
    {"fn", "N", "force on the tip across the blade", 0},
};
/* clang-format on */

/* --- vectors --- */

static Expr dot(Arena *arena, const Expr a[3], const Expr b[3])
{
    return axis_dot(arena, a, b);
}

/* out = a + s b; out may be either */
static void add_scaled(Arena *arena, const Expr a[3], Expr s, const Expr b[3], Expr out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = expr_add(arena, a[i], expr_mul(arena, s, b[i]));
}

static void scale(Arena *arena, Expr s, const Expr a[3], Expr out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = expr_mul(arena, s, a[i]);
}

/* from axes of the head to those of the tail; with `back` the other way */
static void turn(Arena *arena, const FramesApart *apart, bool back, const Expr a[3], Expr out[3])
{
    for (int i = 0; i < 3; i++) {
        const Expr row[3] = {apart->turn[back ? i : 3 * i], apart->turn[back ? 3 + i : 3 * i + 1],
                             apart->turn[back ? 6 + i : 3 * i + 2]};

        out[i] = dot(arena, row, a);
    }
}

static Expr held_length(Arena *arena, const Expr a[3])
{
    return expr_name_temporary(arena, expr_sqrt(arena, dot(arena, a, a)));
}

/* --- rows --- */

static void push(Contact *out, const char *direction, const Expr along[3], Expr gap)
{
    ContactRow *row = &out->row[out->count++];

    *row = (ContactRow){.direction = direction, .gap = gap};
    for (int i = 0; i < 3; i++)
        row->along[i] = along[i];
}

static void push_tangents(Arena *arena, const Expr normal[3], Contact *out)
{
    Expr n1[3], n2[3];

    axis_complement(arena, normal, n1, n2);
    push(out, "t1", n1, NULL);
    push(out, "t2", n2, NULL);
}

/* of a ball: the normal where it touches a bowl or a dome */
static Expr round_gap(const Instance *instance, Arena *arena, const FramesApart *apart,
                      Expr normal[3])
{
    const bool is_bowl = instance_has(instance, "bowl");
    const Expr far = held_length(arena, apart->way), r = instance_scalar(instance, "radius");
    const Expr sign = expr_int(arena, is_bowl ? -1 : 1);

    scale(arena, expr_div(arena, sign, far), apart->way, normal);
    return is_bowl ? expr_sub(arena, expr_sub(arena, instance_scalar(instance, "bowl"), r), far)
                   : expr_sub(arena, expr_sub(arena, far, instance_scalar(instance, "dome")), r);
}

/* rho of a wheel, and its gap */
static Expr wheel_gap(const Instance *instance, Arena *arena, const FramesApart *apart,
                      const Expr z[3], Expr point[3])
{
    const Expr r = instance_scalar(instance, "radius"), rim = instance_scalar(instance, "rim");
    Expr a[3], d[3], length;

    turn(arena, apart, false, instance_value(instance, "axle")->at, a);
    add_scaled(arena, z, expr_neg(arena, dot(arena, z, a)), a, d);
    length = held_length(arena, d);
    scale(arena, expr_neg(arena, expr_div(arena, r, length)), d, point);
    add_scaled(arena, point, expr_neg(arena, rim), z, point);
    return expr_sub(arena, expr_sub(arena, dot(arena, z, apart->way), expr_mul(arena, r, length)),
                    rim);
}

static Expr ellipsoid_gap(const Instance *instance, Arena *arena, const FramesApart *apart,
                          const Expr z[3], Expr point[3])
{
    const Value *axes = instance_value(instance, "semiaxes");
    Expr m[3], scaled[3], h;

    turn(arena, apart, true, z, m);
    for (int i = 0; i < 3; i++)
        scaled[i] = expr_mul(arena, axes->at[i], m[i]);
    h = held_length(arena, scaled);
    for (int i = 0; i < 3; i++)
        scaled[i] = expr_neg(arena, expr_div(arena, expr_mul(arena, axes->at[i], scaled[i]), h));
    turn(arena, apart, false, scaled, point);
    return expr_sub(arena, dot(arena, z, apart->way), h);
}

static void plane_normal(const Instance *instance, Arena *arena, bool planar, Expr out[3])
{
    const Value *normal = instance_value(instance, "normal");
    const bool is_default = planar && !normal->given;

    for (int i = 0; i < 3; i++)
        out[i] = is_default ? expr_int(arena, i == 1) : normal->at[i];
}

void roll_contact(const Instance *instance, Arena *arena, bool planar, const FramesApart *apart,
                  Contact *out)
{
    const Expr r = instance_scalar(instance, "radius");
    const Expr out_of_plane[3] = {expr_int(arena, 0), expr_int(arena, 0), expr_int(arena, 1)};
    Expr z[3], along[3], gap, travel;

    *out = (Contact){0};
    plane_normal(instance, arena, planar, z);
    if (instance_has(instance, "bowl") || instance_has(instance, "dome")) {
        gap = round_gap(instance, arena, apart, out->normal);
        scale(arena, expr_neg(arena, r), out->normal, out->point);
        push(out, "normal", out->normal, gap);
        if (planar) {
            axis_cross(arena, out->normal, out_of_plane, along);
            push(out, "t", along, NULL);
        } else {
            /* with the row along the normal any two other directions hold all of the velocity */
            push_tangents(arena, z, out);
        }
        return;
    }
    for (int i = 0; i < 3; i++)
        out->normal[i] = z[i];
    if (instance_has(instance, "semiaxes")) {
        gap = ellipsoid_gap(instance, arena, apart, z, out->point);
    } else if (!planar && instance_has(instance, "axle")) {
        gap = wheel_gap(instance, arena, apart, z, out->point);
    } else {
        scale(arena, expr_neg(arena, r), z, out->point);
        gap = expr_sub(arena, dot(arena, z, apart->way), r);
    }
    push(out, "normal", z, gap);
    if (!planar) {
        push_tangents(arena, z, out);
        return;
    }
    axis_cross(arena, z, out_of_plane, along);
    travel = expr_add(arena, dot(arena, along, apart->way), expr_mul(arena, r, apart->angle));
    if (component_param(instance->row, "offset") >= 0)
        travel = expr_sub(arena, travel, instance_scalar(instance, "offset"));
    push(out, "t", along, travel);
}

/* a wheel's rim, or the sections of a ball or an ellipsoid along its axes */
int roll_rings(const Instance *instance, Arena *arena, bool planar, ContactRing out[MOST_RINGS])
{
    const Value *semiaxes = instance_value(instance, "semiaxes");
    const Expr zero = expr_int(arena, 0), r = instance_scalar(instance, "radius");
    const bool is_wheel = planar || instance_has(instance, "axle");
    const Expr out_of_plane[3] = {zero, zero, expr_int(arena, 1)};

    if (is_wheel) {
        axis_complement(arena, planar ? out_of_plane : instance_value(instance, "axle")->at,
                        out[0].first, out[0].second);
        scale(arena, r, out[0].first, out[0].first);
        scale(arena, r, out[0].second, out[0].second);
        return 1;
    }
    for (int k = 0; k < MOST_RINGS; k++)
        for (int i = 0; i < 3; i++) {
            const Expr half = semiaxes->given ? semiaxes->at[i] : r;

            out[k].first[i] = i == k ? half : zero;
            out[k].second[i] = i == (k + 1) % 3 ? half : zero;
        }
    return MOST_RINGS;
}

static void knife_contact(const Instance *instance, Arena *arena, bool planar,
                          const FramesApart *apart, Contact *out)
{
    const Expr *z = instance_value(instance, "normal")->at;
    const Expr zero = expr_int(arena, 0), out_of_plane[3] = {zero, zero, expr_int(arena, 1)};
    Expr blade[3];

    *out = (Contact){.point = {zero, zero, zero}};
    turn(arena, apart, false, instance_value(instance, "along")->at, blade);
    axis_cross(arena, planar ? out_of_plane : z, blade, out->normal);
    if (!planar)
        scale(arena, expr_div(arena, expr_int(arena, 1), held_length(arena, out->normal)),
              out->normal, out->normal);
    push(out, "side", out->normal, NULL);
}

static void link_contact(const Instance *instance, Arena *arena, bool planar,
                         const FramesApart *apart, Contact *out)
{
    const Expr far = held_length(arena, apart->way), zero = expr_int(arena, 0);

    (void)planar;
    *out = (Contact){.point = {zero, zero, zero}};
    scale(arena, expr_div(arena, expr_int(arena, 1), far), apart->way, out->normal);
    push(out, "length", out->normal, expr_sub(arena, far, instance_scalar(instance, "length")));
}

static void plane_contact(const Instance *instance, Arena *arena, bool planar,
                          const FramesApart *apart, Contact *out)
{
    const Expr zero = expr_int(arena, 0);

    *out = (Contact){.point = {zero, zero, zero}};
    plane_normal(instance, arena, planar, out->normal);
    push(out, "normal", out->normal, dot(arena, out->normal, apart->way));
}

static void line_contact(const Instance *instance, Arena *arena, bool planar,
                         const FramesApart *apart, Contact *out)
{
    const Expr zero = expr_int(arena, 0), *axis = instance_value(instance, "axis")->at;
    const Expr out_of_plane[3] = {zero, zero, expr_int(arena, 1)};
    Expr n2[3];

    *out = (Contact){.point = {zero, zero, zero}};
    if (planar)
        axis_cross(arena, out_of_plane, axis, out->normal);
    else
        axis_complement(arena, axis, out->normal, n2);
    push(out, "n1", out->normal, dot(arena, out->normal, apart->way));
    if (!planar)
        push(out, "n2", n2, dot(arena, n2, apart->way));
}

/* --- checks --- */

Status contact_refuse(Diag *diag, const char *about, const char *message, const char *hint)
{
    const Status status = diag_set(diag, E_VALUE, "%s", message);

    diag_hint(diag, "%s", hint);
    diag_about(diag, "%s", about);
    return status;
}

/* In a planar scene a given direction is in the plane, or with `turns` the axis out of it. */
static Status check_direction(const Instance *instance, const char *name, bool turns, bool planar,
                              Diag *diag)
{
    const Value *value = instance_value(instance, name);
    const bool is_in_plane = expr_is_zero(value->at[2]);
    const bool is_out_of_it = expr_is_zero(value->at[0]) && expr_is_zero(value->at[1]);

    if (!planar || !value->given || (turns ? is_out_of_it : is_in_plane))
        return OK;
    return contact_refuse(diag, name,
                          turns ? "it turns about z in a planar scene" : "it leaves the plane",
                          turns ? "the scene is planar: z, or nothing"
                                : "the scene is planar: x, y, or a vector [a, b]");
}

/* refuses a key that has no effect together with another */
static Status check_alone(const Instance *instance, const char *with, const char *const *keys,
                          Diag *diag)
{
    for (; *keys != NULL; keys++) {
        Status status;

        if (!instance_has(instance, *keys))
            continue;
        status = diag_set(diag, E_VALUE, "%s= and %s= exclude each other", with, *keys);
        diag_hint(diag, "one shape rolls: a wheel or a ball with radius=, an ellipsoid with "
                        "semiaxes=, a ball in a bowl or on a dome");
        diag_about(diag, "%s", *keys);
        return status;
    }
    return OK;
}

static Status check_ellipsoid(const Instance *instance, bool planar, Diag *diag)
{
    static const char *const others[] = {"radius", "axle", "rim", "bowl", "dome", "offset", NULL};
    const Value *axes = instance_value(instance, "semiaxes");

    if (planar)
        return contact_refuse(diag, "semiaxes", "an ellipsoid rolls in a spatial scene",
                              "in the plane a circle rolls: radius=");
    if (axes->count != 3)
        return contact_refuse(diag, "semiaxes", "an ellipsoid has three semiaxes",
                              "they are written [a, b, c], along the axes of the tip");
    for (int i = 0; i < 3; i++)
        if (expr_is_number(axes->at[i]) && !(expr_value(axes->at[i]) > 0))
            return contact_refuse(diag, "semiaxes", "a semiaxis must be above 0", "in m");
    return check_alone(instance, "semiaxes", others, diag);
}

/* of a ball on one that isn't flat */
static Status check_round(const Instance *instance, Diag *diag)
{
    static const char *const others[] = {"dome", "offset", NULL};
    const bool is_bowl = instance_has(instance, "bowl");
    const char *name = is_bowl ? "bowl" : "dome";
    const Expr R = instance_scalar(instance, name), r = instance_scalar(instance, "radius");

    if (instance_has(instance, "axle"))
        return contact_refuse(diag, name, "in a bowl or on a dome only a ball rolls",
                              "wheels and ellipsoids roll on planes");
    TRY(check_alone(instance, name, is_bowl ? others : others + 1, diag));
    TRY(check_positive(instance, name, diag));
    if (is_bowl && expr_is_number(R) && expr_is_number(r) && expr_value(R) <= expr_value(r))
        return contact_refuse(diag, "bowl", "the ball does not fit into the bowl",
                              "bowl= must be above radius=");
    return OK;
}

Status check_shape(const Instance *instance, bool planar, bool may_be_point, Diag *diag)
{
    const bool is_round = instance_has(instance, "bowl") || instance_has(instance, "dome");
    const bool is_point = may_be_point && !instance_has(instance, "radius");

    if (instance_has(instance, "semiaxes"))
        return check_ellipsoid(instance, planar, diag);
    if (!instance_has(instance, "radius") && !may_be_point)
        return contact_refuse(diag, "radius", "a wheel or a ball needs its radius",
                              "radius=0.3 m; an ellipsoid has semiaxes=[a, b, c]");
    if (is_point && instance_has(instance, "axle"))
        return contact_refuse(diag, "axle", "axle= has no effect without radius=",
                              "a point touches; radius= and axle= make it a wheel");
    if (!is_point)
        TRY(check_positive(instance, "radius", diag));
    TRY(check_direction(instance, "axle", true, planar, diag));
    TRY(check_direction(instance, "normal", false, planar, diag));
    if (is_round)
        TRY(check_round(instance, diag));
    TRY(check_not_negative(instance, "rim", diag));
    if (instance_has(instance, "rim") && (planar || !instance_has(instance, "axle")))
        return contact_refuse(diag, "rim", "only a wheel has a rim", "axle= makes it a wheel");
    return OK;
}

static Status knife_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    TRY(check_direction(instance, "along", false, planar, diag));
    return check_direction(instance, "normal", true, planar, diag);
}

static Status plane_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    return check_direction(instance, "normal", false, planar, diag);
}

static Status line_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    return check_direction(instance, "axis", false, planar, diag);
}

static Status link_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return check_positive(instance, "length", diag);
}

/* --- table --- */

const Component component_knife = {
    .name = "knife",
    .family = FAMILY_CONTACT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "a blade or skate that goes along one direction only",
    .params = knife_params,
    .param_count = COUNT(knife_params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 95,
    .contact = knife_contact,
    .members = knife_members,
    .member_count = COUNT(knife_members),
    .check = knife_check,
    .help = "The origin of the tip has no velocity across the blade, against the tail. The blade "
            "goes along a direction fixed in the tip, on a plane with the normal of the tail. It "
            "takes a freedom of motion, but none of place.",
    .example = "scene planar\nbody sleigh mass=1 inertia=0.2\narm blade sleigh [-0.3, 0]\n"
               "knife k1 ground blade along=x\n"
               "init sleigh.x = 0, sleigh.y = 0, sleigh.theta = 0\n"
               "init sleigh.theta' = 1, sleigh.x' = 1\nsimulate 2\n"
               "print sleigh.x, sleigh.y, sleigh.theta, k1.fn",
    .see = "roll coupler",
};

const Component component_link = {
    .name = "link",
    .family = FAMILY_CONTACT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "a massless rod between two frames",
    .params = link_params,
    .param_count = COUNT(link_params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 95,
    .contact = link_contact,
    .joins = true,
    .members = link_members,
    .member_count = COUNT(link_members),
    .check = link_check,
    .help = "Holds the origins of two frames at a distance, as a rod without mass between two ball "
            "joints does. It pulls and pushes. A rope is 'stop NAME TAIL TIP high=..'.",
    .example = "scene planar; gravity [0, -9.81]\nbody m mass=2 inertia=0.1\n"
               "link L1 ground m length=0.5\ninit m.x = 0.5, m.y = 0, m.theta = 0\n"
               "init m.y' = 0, m.theta' = 0\nsimulate 0.3\nprint m.x, m.y, L1.fn",
    .see = "stop spring spherical",
};

const Component component_inplane = {
    .name = "inplane",
    .family = FAMILY_CONTACT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "a point of the tip remains in a plane of the tail",
    .params = plane_params,
    .param_count = COUNT(plane_params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 95,
    .contact = plane_contact,
    .members = plane_members,
    .member_count = COUNT(plane_members),
    .check = plane_check,
    .help = "Keeps the origin of the tip in the plane through the origin of the tail. It takes one "
            "freedom, without friction. In a planar scene the plane is a line.",
    .example = "gravity [0, 0, -9.81]\nbody b mass=1 inertia=[0.1, 0.1, 0.1]\n"
               "arm foot b [0.2, 0, -0.5]\ninplane P1 ground foot\n"
               "init b.x = 0, b.y = 0, b.q1 = 0.1, b.q2 = 0, b.q3 = 0\nsimulate 0.2\n"
               "print b.z, P1.fn",
    .see = "inline planarjoint roll",
};

const Component component_inline = {
    .name = "inline",
    .family = FAMILY_CONTACT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "a point of the tip remains on a line of the tail",
    .params = line_params,
    .param_count = COUNT(line_params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 95,
    .contact = line_contact,
    .members = line_members,
    .member_count = COUNT(line_members),
    .check = line_check,
    .help = "Keeps the origin of the tip on the line through the origin of the tail, whatever its "
            "attitude: a pin in a slot. It takes two freedoms in space and one in the plane.",
    .example = "scene planar; gravity [0, -9.81]\nbody rod1 mass=1 inertia=1/12\n"
               "arm a rod1 [-0.5, 0]; arm b rod1 [0.5, 0]\ninline S1 ground a axis=x\n"
               "inline S2 ground b axis=y\ninit rod1.theta = 2, rod1.theta' = 0\nsimulate 0.3\n"
               "print rod1.theta, S1.fn, S2.fn",
    .see = "inplane prismatic cylindrical",
};
