/* coordinate.c: values of coordinates, also of chords; derivatives along the motion */
#include "formulate/system_impl.h"

Expr partial(System *system, Expr e, int speed)
{
    Arena *arena = system->arena;
    Expr sum = expr_int(arena, 0);

    for (int i = 0; i < system->q.count; i++) {
        const CoordinateRate *rate = &system->coordinate_rates[i];

        for (int k = 0; k < rate->count; k++)
            if (rate->speed[k] == speed) {
                Expr slope = expr_diff(arena, e, system->q.at[i].symbol);

                sum = expr_add(arena, sum, expr_mul(arena, slope, rate->entry[k]));
            }
    }
    return sum;
}

Status rate_of(System *system, Expr e, Expr *out, Diag *diag)
{
    const unsigned late = 1U << SYMBOL_ACCELERATION | 1U << SYMBOL_STATE_RATE |
                          1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_MULTIPLIER | 1U << SYMBOL_EFFORT;
    LIST(Expr) symbols = {0};
    LIST(Expr) rates = {0};

    if ((expr_kinds(e) & late) != 0)
        return diag_set(diag, E_MISSING,
                        "this derivative needs one of an acceleration, a "
                        "multiplier or an algebraic variable");
    for (int i = 0; i < system->q.count; i++) {
        LIST_PUSH(symbols, system->q.at[i].symbol);
        LIST_PUSH(rates, system_q_rate(system, i));
    }
    for (int i = 0; i < system->u.count; i++) {
        LIST_PUSH(symbols, system->u.at[i].symbol);
        LIST_PUSH(rates, system->accelerations[i]);
    }
    for (int i = 0; i < system->x.count; i++) {
        LIST_PUSH(symbols, system->x.at[i].symbol);
        LIST_PUSH(rates, system->rates.at[i]);
    }
    LIST_PUSH(symbols, expr_symbol(system->arena, "t", SYMBOL_TIME));
    LIST_PUSH(rates, expr_int(system->arena, 1));
    *out = expr_diff_along(system->arena, e, symbols.at, rates.at, symbols.count);
    LIST_FREE(symbols);
    LIST_FREE(rates);
    return OK;
}

/* a slide of a chord: the way from tail to head along the axis */
static Expr slide_value(System *system, const Instance *owner, const Step *slide)
{
    Vec axis =
        frame_vector(system, owner->tail, (Vec){{slide->axis[0], slide->axis[1], slide->axis[2]}});
    FrameSum along = framesum_of(system, system->frames[owner->tail].chain, axis);

    return framesum_dot(system, along, framesum_way(system, owner->tail, owner->head));
}

Rotation chord_constant(const System *system, const Instance *joint, const Steps *steps)
{
    Rotation constant;
    Rotation back = rotation_transpose(&system->frames[joint->tail].zero);

    for (int i = 0; i < 9; i++)
        constant.at[i] = steps->rotation[i];
    constant = rotation_transpose(&constant);
    constant = rotation_product(system->arena, &system->frames[joint->head].zero, &constant);
    return rotation_product(system->arena, &constant, &back);
}

/* the turn of a chord: the sum of turns about its axis where they merge, else an arc tangent */
static Expr turn_value(System *system, const Instance *owner, const Steps *steps, const Step *turn)
{
    Arena *arena = system->arena;
    const Frame *tail = &system->frames[owner->tail];
    const Frame *head = &system->frames[owner->head];
    Vec axis =
        frame_vector(system, owner->tail, (Vec){{turn->axis[0], turn->axis[1], turn->axis[2]}});
    Rotation constant = chord_constant(system, owner, steps);
    Turns turns = {0};
    Expr value = NULL;

    turns_between(system, tail->chain, head->chain, &turns);
    if (turns.count == 0)
        value = rotation_angle(arena, &constant, axis);
    else if (turns.count == 1 && vec_same(turns.at[0].axis, axis))
        value = expr_add(arena, turns.at[0].angle, rotation_angle(arena, &constant, axis));
    else if (turns.count == 1 && vec_same(turns.at[0].axis, vec_neg(arena, axis)))
        value = expr_sub(arena, rotation_angle(arena, &constant, axis), turns.at[0].angle);
    LIST_FREE(turns);
    if (value == NULL) {
        Vec n1;
        Vec n2;
        Vec turned;

        axis_complement(arena, turn->axis, n1.at, n2.at);
        turned = rotation_apply(arena, &constant, frame_vector(system, owner->tail, n1));
        turned = vec_express(system, turned, head->chain, tail->chain);
        value = expr_call2(arena, OP_ATAN2,
                           vec_dot(arena, frame_vector(system, owner->tail, n2), turned),
                           vec_dot(arena, frame_vector(system, owner->tail, n1), turned));
    }
    return value;
}

static Status chord_value(System *system, const Instance *owner, int coordinate, Expr *out,
                          Diag *diag)
{
    Steps steps;

    instance_steps(system, owner, &steps);
    for (int k = 0; k < steps.shift_count; k++)
        if (steps.shift[k].coordinate == coordinate) {
            *out = slide_value(system, owner, &steps.shift[k]);
            return OK;
        }
    if (steps.turn_count == 1 && steps.turn[0].coordinate == coordinate) {
        *out = turn_value(system, owner, &steps, &steps.turn[0]);
        return OK;
    }
    (void)diag_set(diag, E_MISSING, "%s: can't be told while %s is a chord of the rotation tree",
                   owner->coord[coordinate], owner->name);
    diag_hint(diag, "tree rotation + %s - EDGE makes it a branch", owner->name);
    return E_MISSING;
}

Status coordinate_value(System *system, const Instance *owner, int coordinate, int primes,
                        Expr *out, Diag *diag)
{
    int place = system->coordinate[owner->number][coordinate];
    Status status = OK;

    if (primes > 2)
        return diag_set(diag, E_MISSING, "%s: no more than two derivatives",
                        owner->coord[coordinate]);
    if (place >= 0) {
        int speed = system->speed[owner->number][coordinate];

        *out = primes == 0 ? system->q.at[place].symbol : system_q_rate(system, place);
        if (primes == 2 && speed >= 0 && system->coordinate_rates[place].count == 1)
            *out = system->accelerations[speed];
        else if (primes == 2)
            return rate_of(system, *out, out, diag);
        return OK;
    }
    CHECK(chord_value(system, owner, coordinate, out, diag));
    for (; primes > 0; primes--)
        CHECK(rate_of(system, *out, out, diag));
done:
    return status;
}
