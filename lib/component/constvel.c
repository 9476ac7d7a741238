/* constvel.c: constant-velocity coupling of two shafts
 *
 * The shafts lie along the unit vector e of both frames. With the turn R from axes of the head to
 * those of the tail, by theta about a, and Rodrigues' vector g = tan(theta/2) a
 * = vee(R - R^T)/(1 + tr R), the coupling holds
 *
 *     2 e.g = 0
 *
 * R is a spin by s about e and then a bend about an axis across e, and e.g = tan(s/2): no spin is
 * left. With the angular velocity w of the head against the tail the row has the rate n.w,
 * n = e + g x e + (e.g) g. In contact n is along the bisector of the two shafts, so that both turn
 * at one speed whatever the bend does. The moment acts along n. */
#include "component/component_rows.h"

/* clang-format off */
static const Param params[] = {
    {"axis", PARAM_AXIS, "1", "z", "of the shafts: in the axes of the tail, and in those of the tip", 0},
};

static const Member members[] = {
    {"tn", "N*m", "moment on the tip along the bisector of the shafts", 0},
};
/* clang-format on */

/* g, as named temporaries */
static void rodrigues_vector(Arena *arena, const Expr turn[9], Expr g[3])
{
    static const int row[3] = {2, 0, 1}, column[3] = {1, 2, 0};
    const Expr below = expr_sum(arena, (Expr[]){expr_int(arena, 1), turn[0], turn[4], turn[8]}, 4);

    for (int i = 0; i < 3; i++) {
        const Expr twice =
            expr_sub(arena, turn[3 * row[i] + column[i]], turn[3 * column[i] + row[i]]);

        g[i] = expr_name_temporary(arena, expr_div(arena, twice, below));
    }
}

static void contact(const Instance *instance, Arena *arena, bool planar, const FramesApart *apart,
                    Contact *out)
{
    const Expr *e = instance_value(instance, "axis")->at;
    const Expr zero = expr_int(arena, 0);
    Expr g[3], across[3], n[3], spin, size;

    (void)planar;
    rodrigues_vector(arena, apart->turn, g);
    spin = axis_dot(arena, e, g);
    axis_cross(arena, g, e, across);
    for (int i = 0; i < 3; i++)
        n[i] = expr_sum(arena, (Expr[]){e[i], across[i], expr_mul(arena, spin, g[i])}, 3);
    size = expr_name_temporary(arena, expr_sqrt(arena, axis_dot(arena, n, n)));
    *out = (Contact){.point = {zero, zero, zero}, .count = 1};
    out->row[0] = (ContactRow){
        .direction = "spin", .gap = expr_mul(arena, expr_int(arena, 2), spin), .turns = true};
    for (int i = 0; i < 3; i++) {
        out->row[0].along[i] = n[i];
        out->normal[i] = expr_div(arena, n[i], size);
    }
}

const Component component_constvel = {
    .name = "constvel",
    .family = FAMILY_CONTACT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .not_in_plane = "coupler",
    .brief = "constant-velocity coupling of two shafts, at any bend",
    .params = params,
    .param_count = COUNT(params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 95,
    .contact = contact,
    .turns = true,
    .members = members,
    .member_count = COUNT(members),
    .help =
        "Lets one shaft turn as fast as the other, at any bend below half a turn and also while "
        "the bend changes. It holds no positions: beside a spherical it is a joint with a fixed "
        "centre, alone one that plunges. Both shafts lie along axis= of their frames, and their "
        "angles agree: a frame that is turned about its shaft, by an arm with rotation=, shifts "
        "them. Two universals between three shafts do the same only where their bends are equal "
        "and in one plane.",
    .example = "arm seat ground [0, 0, 0] rotation=y(30 deg)\n"
               "body in mass=1 inertia=[0.02, 0.02, 0.01]\n"
               "body out mass=1 inertia=[0.02, 0.02, 0.01]\n"
               "revolute h1 ground in axis=z\nrevolute h2 seat out axis=z\n"
               "constvel c1 in out\ntorque T in [0, 0, 0.5]\nsimulate 1\n"
               "print h1', h2', c1.tn",
    .see = "universal spherical coupler",
};
