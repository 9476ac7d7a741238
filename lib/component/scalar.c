/* scalar.c: shared by the rows of hydraulics, shafts, slides and heat
 *
 * Every domain has an across and a through variable; an edge that stores by its across variable
 * (tank, flywheel, slug, heat capacity), as a capacitor does; one that stores by its through
 * variable, as an inductor does; one with resistance; and sources of both variables (theory 8). */
#include "component/component_rows.h"

void scalar_storage(RelationKind kind, Expr value, Expr x, Arena *arena, Relation *out)
{
    *out = (Relation){
        .kind = kind,
        .content = expr_mul(arena, value, x),
        .rest = expr_int(arena, 0),
        .stored = expr_product(
            arena, (Expr[]){expr_rational(arena, 1, 2), value, expr_square(arena, x)}, 3)};
}

void scalar_converter(const Instance *instance, Arena *arena, int which, Expr ratio, Relation *out)
{
    Expr across = instance_across(instance, arena, 1 - which);
    Expr through = expr_neg(arena, instance_through(instance, arena, 1 - which));

    *out = (Relation){.kind = RELATION_PORT};
    out->value = which == 0 ? expr_mul(arena, ratio, across) : expr_div(arena, across, ratio);
    out->inverse = which == 0 ? expr_div(arena, through, ratio) : expr_mul(arena, ratio, through);
}

void scalar_across_source(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)arena;
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_ACROSS, .value = instance_scalar(instance, "value")};
}

void scalar_through_source(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_THROUGH,
                      .value = expr_neg(arena, instance_scalar(instance, "value"))};
}

void scalar_rate_of_joint(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)instance;
    (void)arena;
    (void)which;
    *out = (Relation){.kind = RELATION_ACROSS, .value = motion->rate};
}

Expr scalar_through_on_joint(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    (void)instance;
    (void)arena;
    return motion->through;
}

/* content: deflection = through / k where there is no damping */
void scalar_spring(const Instance *instance, const char *deflection, Arena *arena,
                   const Motion1 *motion, Relation *out)
{
    Expr k = instance_scalar(instance, "k");
    Expr d = instance_scalar(instance, "d");
    Expr one = expr_int(arena, 1);
    Expr half = expr_rational(arena, 1, 2);
    Expr turn;

    if (expr_is_zero(d)) {
        scalar_storage(RELATION_INDUCTIVE, expr_div(arena, one, k), motion->through, arena, out);
    } else if (expr_is_zero(k)) {
        *out = (Relation){.kind = RELATION_RESISTIVE,
                          .value = expr_div(arena, one, d),
                          .rest = expr_int(arena, 0)};
    } else {
        turn = instance_variable(instance, arena, deflection);
        *out = (Relation){
            .kind = RELATION_CONDUCTIVE,
            .value = expr_add(arena, expr_mul(arena, k, turn), expr_mul(arena, d, motion->across)),
            .stored = expr_product(arena, (Expr[]){half, k, expr_square(arena, turn)}, 3)};
    }
}

int scalar_spring_states(const Instance *instance)
{
    return !expr_is_zero(instance_scalar(instance, "k")) &&
           !expr_is_zero(instance_scalar(instance, "d"));
}

void scalar_spring_state(const Instance *instance, const char *deflection, Arena *arena,
                         OwnState *out)
{
    *out = (OwnState){.member = deflection,
                      .initial = expr_int(arena, 0),
                      .rate = instance_across(instance, arena, 0)};
}

Status scalar_check_spring(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    Status status = OK;

    (void)arena;
    (void)planar;
    CHECK(check_not_negative(instance, "k", diag));
    CHECK(check_not_negative(instance, "d", diag));
    if (expr_is_zero(instance_scalar(instance, "k")) &&
        expr_is_zero(instance_scalar(instance, "d"))) {
        status =
            diag_set(diag, E_VALUE, "%s %s needs k= or d=", instance->row->name, instance->name);
        diag_hint(diag, "k is a stiffness, d a damping beside it; one terminal in two places is "
                        "a rigid connection");
    }
done:
    return status;
}

Status scalar_check_hinge(const Instance *instance, bool hinge, const char *instead, Diag *diag)
{
    Status status;

    if (instance->on_angle == hinge)
        return OK;
    status = diag_set(diag, E_VALUE, "%s %s acts on %s", instance->row->name, instance->name,
                      hinge ? "an angle, and this coordinate is a length"
                            : "a length, and this coordinate is an angle");
    diag_hint(diag, "%s", instead);
    return status;
}
