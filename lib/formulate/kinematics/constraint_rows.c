/* constraint_rows.c: circuits of chords projected on their reaction spaces
 *
 * A row n.d says that the way d from the tail of a chord to its head has no part along
 * n; a row a_t.b_h that two axes stay square; a row of angles that turns about one
 * axis cancel. Symbols as in system_impl.h; D_j is the part of the way that speed j
 * turns, so that the rate of d is the sum of k_j x D_j u_j and the slides. */
#include "formulate/kinematics/constraint_rows.h"
#include "formulate/kinematics/alike.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/framesum.h"
#include "formulate/kinematics/multi_turn.h"
#include "formulate/kinematics/stations.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/sample.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <math.h>
#include <string.h>

#define MISFIT 1e-9 /* m or 1: parts that are off by less fit */

enum { SAMPLES = 3 }; /* positions at which a row that vanishes is looked at */

/* --- which rows --- */

static void push_row(System *system, const Instance *joint, RowKind kind, Vec n, Vec b,
                     const char *direction)
{
    Row row = {.kind = kind, .tail = joint->tail, .head = joint->head, .n = n, .b = b};

    row.told = (ConstraintRow){.edge = joint->edge,
                               .instance = joint->number,
                               .rotation = kind == ROW_DOT || kind == ROW_ANGLE};
    (void)strncpy(row.told.direction, direction, sizeof row.told.direction - 1);
    LIST_PUSH(system->constraints->rows, row);
}

static Vec unit(Arena *arena, int i)
{
    Vec v = vec_zero(arena);

    v.at[i] = expr_int(arena, 1);
    return v;
}

static Vec step_axis(const System *system, const Instance *joint, const Step *step)
{
    return frame_vector(system, joint->tail, (Vec){{step->axis[0], step->axis[1], step->axis[2]}});
}

/* forces that a joint transmits: all, less those along its slides */
static void force_rows(System *system, const Instance *joint, const Steps *steps)
{
    static const char *const names[] = {"x", "y", "z"};
    Arena *arena = system->arena;
    Vec none = vec_zero(arena);
    Vec n1 = none;
    Vec n2 = none;

    if (steps->shift_count == 0) {
        for (int i = 0; i < (system->origin->planar ? 2 : 3); i++)
            push_row(system, joint, ROW_DATUM, unit(arena, i), none, names[i]);
    } else if (steps->shift_count == 1) {
        Vec axis = step_axis(system, joint, &steps->shift[0]);

        if (system->origin->planar) {
            push_row(system, joint, ROW_TAIL, vec_cross(arena, unit(arena, 2), axis), none, "n");
            return;
        }
        axis_complement(arena, axis.at, n1.at, n2.at);
        push_row(system, joint, ROW_TAIL, n1, none, "n1");
        push_row(system, joint, ROW_TAIL, n2, none, "n2");
    } else if (steps->shift_count == 2 && !system->origin->planar) {
        n1 = vec_cross(arena, step_axis(system, joint, &steps->shift[0]),
                       step_axis(system, joint, &steps->shift[1]));
        push_row(system, joint, ROW_TAIL, n1, none, "n");
    }
}

/* moments that a joint transmits: all, less those about its turns (theory 2, orientation
 * constraints) */
static void moment_rows(System *system, const Instance *joint, const Steps *steps)
{
    Arena *arena = system->arena;
    Rotation constant = chord_constant(system, joint, steps);
    Rotation ahead;
    Vec axes[3];
    Vec far[3];
    Turns turns = {0};

    if (steps->quaternion || steps->turn_count > 2 ||
        (system->origin->planar && steps->turn_count > 0))
        return;
    /* axes of the tail, and those of the head after the constant turn is undone, zero position */
    axes[0] = steps->turn_count > 0 ? step_axis(system, joint, &steps->turn[0])
                                    : frame_vector(system, joint->tail, unit(arena, 0));
    axis_complement(arena, axes[0].at, axes[1].at, axes[2].at);
    ahead = constant;
    for (int i = 0; i < 3; i++)
        far[i] = rotation_apply(arena, &ahead, axes[i]);
    if (steps->turn_count == 2) {
        Vec second = rotation_apply(arena, &ahead, step_axis(system, joint, &steps->turn[1]));

        push_row(system, joint, ROW_DOT, axes[0], second, "cross");
    } else if (steps->turn_count == 1) {
        push_row(system, joint, ROW_DOT, axes[1], far[0], "n1");
        push_row(system, joint, ROW_DOT, axes[2], far[0], "n2");
    } else {
        turns_between(system, system->kinematics->frames[joint->tail].chain,
                      system->kinematics->frames[joint->head].chain, &turns);
        if (system->origin->planar) {
            push_row(system, joint, ROW_ANGLE, unit(arena, 2), vec_zero(arena), "turn");
        } else if (turns.count == 1 && turns.at[0].matrix == NULL && rotation_is_one(&constant)) {
            Vec axis = turns.at[0].axis;

            /* the axis stays where it is: those rows vanish, what they carry doesn't */
            push_row(system, joint, ROW_ANGLE, axis, vec_zero(arena), "turn");
            axis_complement(arena, axis.at, axes[1].at, axes[2].at);
            push_row(system, joint, ROW_DOT, axis, axes[1], "n1");
            push_row(system, joint, ROW_DOT, axis, axes[2], "n2");
        } else {
            push_row(system, joint, ROW_DOT, axes[1], far[2], "u");
            push_row(system, joint, ROW_DOT, axes[2], far[0], "n1");
            push_row(system, joint, ROW_DOT, axes[0], far[1], "n2");
        }
        LIST_FREE(turns);
    }
}

/* a screw's shift follows its turn */
static void tie_row(System *system, const Instance *joint, const Steps *steps)
{
    Vec axis = step_axis(system, joint, &steps->shift[0]);

    push_row(system, joint, ROW_TIE, axis, vec_zero(system->arena), "u");
    system->constraints->rows.at[system->constraints->rows.count - 1].pitch = steps->shift[0].scale;
}

/* of a driver or a coupler */
static void driver_row(System *system, const Instance *driver)
{
    const bool couples = driver->row->family == FAMILY_COUPLER;
    const Instance *owner = &system->origin->instances[driver->joint];
    Vec none = vec_zero(system->arena);

    push_row(system, owner, couples ? ROW_COUPLER : ROW_DRIVER, none, none, driver->row->name);

    Row *row = &system->constraints->rows.at[system->constraints->rows.count - 1];

    row->owner = driver->joint;
    row->coordinate = driver->joint_coordinate;
    row->told.is_driver = !couples;
    row->told.is_coupler = couples;
    row->told.instance = driver->number;
    row->told.edge = driver->edge;
}

/* --- rows to show --- */

/* sin(f - angle) of a chord's angle that is told by its sine and cosine, zero where it is f: any
 * number of turns are alike to it */
static Expr angle_missed(System *system, const ChordTurn *turn, Expr f)
{
    Arena *arena = system->arena;

    return expr_sub(arena, expr_mul(arena, expr_sin(arena, f), turn->cosine),
                    expr_mul(arena, expr_cos(arena, f), turn->sine));
}

/* for what looks for positions: sine and cosine together know half a turn */
static void compare_angle(System *system, const char *name, const ChordTurn *turn, Expr f)
{
    Arena *arena = system->arena;
    Expr along = expr_add(arena, expr_mul(arena, expr_cos(arena, f), turn->cosine),
                          expr_mul(arena, expr_sin(arena, f), turn->sine));
    AngleOff compared = {
        name, expr_call2(arena, OP_ATAN2, expr_neg(arena, angle_missed(system, turn, f)), along)};

    LIST_PUSH(system->constraints->angles_off, compared);
}

static Expr tie_shown(System *system, const Row *row)
{
    Arena *arena = system->arena;
    const Instance *joint = &system->origin->instances[row->told.instance];
    Steps steps;
    ChordTurn turn;
    Expr s;

    instance_steps(system, joint, &steps);
    s = slide_value(system, joint, &steps.shift[0]);
    chord_turn(system, joint, &steps, 0, &turn);
    if (turn.angle != NULL)
        return expr_sub(
            arena, s,
            expr_mul(arena, row->pitch,
                     expr_add(arena, turn.angle,
                              multi_turn_whole(system, joint->number, steps.turn[0].coordinate))));
    s = expr_div(arena, s, row->pitch);
    compare_angle(system, joint->coord[steps.turn[0].coordinate], &turn, s);
    return expr_mul(arena, row->pitch, angle_missed(system, &turn, s));
}

/* a driven coordinate less what it is to be */
static Status driver_shown(System *system, Row *row, Diag *diag)
{
    Arena *arena = system->arena;
    const Instance *driver = &system->origin->instances[row->told.instance];
    const Instance *owner = &system->origin->instances[row->owner];
    bool chord = system->kinematics->coordinate[row->owner][row->coordinate] < 0;
    Expr value;
    Steps steps;

    TRY(variables_resolve(system, driver->row->prescribed(driver, arena), &row->prescribed, diag));
    instance_steps(system, owner, &steps);
    for (int k = 0; chord && k < steps.turn_count && steps.turn_count < 3; k++) {
        ChordTurn turn;

        if (steps.turn[k].coordinate != row->coordinate)
            continue;
        if (multi_turn_angle(system, row->owner, row->coordinate) == NULL)
            continue; /* the coordinate is a sum, or told by a shift */
        chord_turn(system, owner, &steps, k, &turn);
        multi_turn_drive(system, row->owner, row->coordinate, row->prescribed);
        compare_angle(system, owner->coord[row->coordinate], &turn, row->prescribed);
        row->phi = expr_neg(arena, angle_missed(system, &turn, row->prescribed));
        return OK;
    }
    TRY(coordinate_value(system, owner, row->coordinate, 0, &value, diag));
    row->phi = expr_sub(arena, value, row->prescribed);
    return OK;
}

/* what a coupler follows, and a coordinate less that */
static Status coupler_shown(System *system, Row *row, Diag *diag)
{
    Arena *arena = system->arena;
    const Instance *coupler = &system->origin->instances[row->told.instance];
    const Expr law = coupler->row->prescribed(coupler, arena);
    Expr *symbols = NULL;
    const int count = expr_symbols(&law, 1, &symbols);
    Expr value;
    Status status = OK;

    row->coupled = pool_alloc(system->pool, (size_t)count * sizeof *row->coupled);
    for (int i = 0; i < count; i++) {
        const int number = names_find(system->origin->coordinate_names, expr_name(symbols[i]));
        Coupled *coupled = &row->coupled[row->coupled_count];

        if (expr_symbol_kind(symbols[i]) == SYMBOL_PARAMETER || number < 0)
            continue;
        coupled->owner = system->origin->coordinate_owners.at[number].instance;
        coupled->coordinate = system->origin->coordinate_owners.at[number].coordinate;
        CHECK(variables_resolve(system, expr_diff(arena, law, symbols[i]), &coupled->slope, diag));
        row->coupled_count++;
    }
    CHECK(variables_resolve(system, law, &row->prescribed, diag));
    CHECK(coordinate_value(system, &system->origin->instances[row->owner], row->coordinate, 0,
                           &value, diag));
    row->phi = expr_sub(arena, value, row->prescribed);
done:
    mem_free(symbols);
    return status;
}

static Status row_shown(System *system, Row *row, Diag *diag)
{
    Arena *arena = system->arena;
    int tail = system->kinematics->frames[row->tail].chain;
    int head = system->kinematics->frames[row->head].chain;
    FrameSum n = framesum_of(system, row->kind == ROW_DATUM ? 0 : tail, row->n);
    Turns turns = {0};

    switch (row->kind) {
    case ROW_DATUM:
    case ROW_TAIL:
        row->phi = framesum_dot(system, n, framesum_way(system, row->tail, row->head));
        break;
    case ROW_DOT:
        row->phi = framesum_dot(system, n, framesum_of(system, head, row->b));
        break;
    case ROW_ANGLE: {
        const Instance *joint = &system->origin->instances[row->told.instance];
        Rotation constant;
        Steps steps;

        instance_steps(system, joint, &steps);
        constant = chord_constant(system, joint, &steps);
        row->phi = rotation_angle(arena, &constant, row->n);
        turns_between(system, tail, head, &turns);
        for (int i = 0; i < turns.count; i++) {
            Expr angle = turns.at[i].angle;

            /* the axis of the row, or its opposite: axes are unit vectors here */
            if (!vec_same(turns.at[i].axis, row->n))
                angle = expr_neg(arena, angle);
            row->phi = expr_add(arena, row->phi, angle);
        }
        LIST_FREE(turns);
        break;
    }
    case ROW_TIE:
        row->phi = tie_shown(system, row);
        break;
    case ROW_DRIVER:
        TRY(driver_shown(system, row, diag));
        break;
    case ROW_COUPLER:
        TRY(coupler_shown(system, row, diag));
        break;
    }
    row->phi = expr_fold(arena, expr_open(arena, row->phi));
    return OK;
}

/* of the terms of a sum, without their cancelling; at least of a unit length */
static double size_of_terms(Sample *sample, Expr e)
{
    double size = 1;

    for (int i = 0; expr_kind(e) == EXPR_SUM && i < expr_arg_count(e); i++)
        size += fabs(sample_number(sample, expr_arg(e, i)));
    return size;
}

/* the same number in every position, though rounding may hide that in symbols; a number that
 * parameters make is taken as it is, but what else depends on them may change with them */
static bool row_is_constant(const System *system, const Row *row, Sample *const *samples,
                            double *value)
{
    const double rounding = 1e-13;
    unsigned kinds = expr_kinds(row->phi);

    if ((kinds & (1U << SYMBOL_COORDINATE | 1U << SYMBOL_TIME)) == 0) {
        *value = system->scene->number(system->scene->context, row->phi);
        return true;
    }
    if ((kinds & 1U << SYMBOL_TIME) != 0)
        return false;
    *value = sample_number(samples[0], row->phi);
    for (int i = 1; i < SAMPLES; i++) {
        double off = fabs(sample_number(samples[i], row->phi) - *value);

        if (!(off <= rounding || off <= rounding * size_of_terms(samples[i], row->phi)))
            return false;
    }
    return true;
}

/* true: the row holds identically; an error when it never can */
static Status row_vanishes(System *system, const Row *row, Sample *const *samples, bool *vanishes,
                           Diag *diag)
{
    const char *joint = system->origin->instances[row->told.instance].name;
    double value;

    *vanishes = false;
    if (!row_is_constant(system, row, samples, &value))
        return OK;
    if (row->kind == ROW_ANGLE)
        value = remainder(value, 2 * M_PI); /* whole turns are none */
    if (fabs(value) > MISFIT) {
        (void)diag_set(diag, E_ASSEMBLE,
                       "%s can't be assembled: its equation along %s is %.6g = 0 in every position",
                       joint, row->told.direction, value);
        diag_hint(diag, "lengths or axes on its circuit don't fit");
        return E_ASSEMBLE;
    }
    *vanishes = true;
    LIST_PUSH(system->constraints->redundant_rows, *row);
    LIST_PUSH(system->constraints->dropped,
              system_keep(system, "%s: %s %s holds in every position", joint,
                          row->told.rotation ? "turning about" : "position along",
                          row->told.direction));
    return OK;
}

bool system_holds(const System *system, uint64_t revision,
                  double (*number)(const void *context, Expr e), const void *context)
{
    bool holds = system->origin->revision == revision;

    for (int k = 0; holds && k < system->constraints->redundant_rows.count; k++) {
        Expr phi = system->constraints->redundant_rows.at[k].phi;

        if (expr_kinds(phi) == 1U << SYMBOL_PARAMETER)
            holds = fabs(number(context, phi)) <= MISFIT;
    }
    return holds;
}

/* --- rows to run --- */

/* the part of the way from `ancestor` to a node that `chain` turns (-1: all of it), added from the
 * far end to `sum`, so that what hangs together is one definition */
static Vec add_way(const System *system, int node, int ancestor, int chain, int axes, Vec sum)
{
    for (; node != ancestor; node = system->kinematics->frames[node].parent) {
        const Frame *frame = &system->kinematics->frames[node];
        int resolved = system->kinematics->chains.at[frame->chain].resolve;

        if (chain >= 0 && !chain_is_beyond(system, frame->step_chain, chain))
            continue;
        sum = vec_add(system->arena, sum, vec_express(system, frame->step, resolved, axes));
        sum = vec_hold(system->arena, sum);
    }
    return sum;
}

/* Inside an instance that follows another the way is that of the first. False: it isn't, or not all
 * of it is passed; else *node is where it hangs. */
static bool way_alike(const System *system, int *node, int ancestor, int chain, int axes, Vec *out)
{
    int first, around;
    const Follower *follower = alike_node(system, *node, &first);
    FirstWay way = {.node = first};

    if (follower == NULL || alike_node(system, ancestor, &around) == follower ||
        !alike_chain_for(system, follower, axes, &way.axes) ||
        !alike_chain_for(system, follower, chain, &way.chain))
        return false;
    for (; alike_node(system, *node, &around) == follower; first = around) {
        if (*node == ancestor)
            return false;
        *node = system->kinematics->frames[*node].parent;
    }
    if (!alike_find_way(follower, &way)) {
        way.sum = add_way(system, way.node, system->kinematics->frames[first].parent, way.chain,
                          way.axes, vec_zero(system->arena));
        alike_keep_way(follower, &way);
    }
    *out = alike_vec(follower, way.sum);
    return true;
}

static Vec way_turned(const System *system, int node, int ancestor, int chain, int axes)
{
    Vec sum = vec_zero(system->arena);

    (void)way_alike(system, &node, ancestor, chain, axes, &sum);
    return add_way(system, node, ancestor, chain, axes, sum);
}

static int common_node(const System *system, int a, int b)
{
    const Tree *tree = system->origin->trees[TREE_TRANSLATION];

    while (a != b) {
        if (tree_depth(tree, a) > tree_depth(tree, b))
            a = system->kinematics->frames[a].parent;
        else
            b = system->kinematics->frames[b].parent;
    }
    return a;
}

static Vec circuit_turned(const System *system, const Row *row, int chain, int axes)
{
    int ancestor = common_node(system, row->tail, row->head);
    Vec to_head = way_turned(system, row->head, ancestor, chain, axes);
    Vec to_tail = way_turned(system, row->tail, ancestor, chain, axes);

    return vec_hold(system->arena, vec_sub(system->arena, to_head, to_tail));
}

/* n . slide of speed j on the circuit, signs included */
static Expr circuit_slide(const System *system, const Row *row, Vec n, int speed, int axes)
{
    int node = system->kinematics->speeds[speed].slide_node;
    const Tree *tree = system->origin->trees[TREE_TRANSLATION];
    int sense = 0;

    if (node >= 0) {
        int branch = tree_parent_edge(tree, node);

        sense = (int)tree_is_beyond(tree, branch, row->head) -
                (int)tree_is_beyond(tree, branch, row->tail);
    }
    if (sense == 0)
        return expr_int(system->arena, 0);
    return expr_mul(system->arena, expr_int(system->arena, sense),
                    vec_dot(system->arena, n, speed_slide(system, speed, axes)));
}

/* rows n.d: the axes that they are computed in, n in those axes */
static int row_axes(const System *system, const Row *row, Vec *n)
{
    int tail = system->kinematics->frames[row->tail].chain;
    int from = row->kind == ROW_DATUM ? 0 : tail;
    int axes = row->kind == ROW_DATUM ? 0 : system->kinematics->chains.at[tail].resolve;

    *n = vec_express(system, row->n, from, axes);
    return axes;
}

/* --- which speeds a row can move --- */

/* the turns of a chain and of those that it hangs from */
static void mark_turns(const System *system, int chain, bool *moves)
{
    for (; chain > 0; chain = system->kinematics->chains.at[chain].parent) {
        const Chain *own = &system->kinematics->chains.at[chain];

        if (moves[own->speed])
            return; /* and all nearer ones are marked */
        for (int j = own->speed; j < own->speed + own->speed_count; j++)
            moves[j] = true;
    }
}

static void mark_way(const System *system, int node, int ancestor, bool *turns, bool *slides)
{
    for (; node != ancestor; node = system->kinematics->frames[node].parent) {
        const Frame *frame = &system->kinematics->frames[node];

        mark_turns(system, frame->step_chain, turns);
        for (int i = 0; i < frame->slide_count; i++)
            slides[frame->slide[i].speed] = true;
    }
}

/* Speeds that the row's derivative can hold, in order: of a long mechanism few. Room for all. */
static int speeds_of_row(const System *system, const Row *row, int *speeds)
{
    const int all = system->kinematics->speed_count;
    bool *turns = NEW_ARRAY(bool, all), *slides = NEW_ARRAY(bool, all);
    int count = 0;

    if (row->kind != ROW_DOT) {
        int ancestor = common_node(system, row->tail, row->head);

        mark_way(system, row->head, ancestor, turns, slides);
        mark_way(system, row->tail, ancestor, turns, slides);
    }
    if (row->kind != ROW_DATUM)
        mark_turns(system, system->kinematics->frames[row->tail].chain, turns);
    if (row->kind == ROW_DOT)
        mark_turns(system, system->kinematics->frames[row->head].chain, turns);
    for (int j = 0; j < all; j++)
        if (turns[j] || slides[j])
            speeds[count++] = j;
    MEM_FREE(turns, slides);
    return count;
}

/* adds to an entry of Phi_u; of a dependent speed to those of the shapes that it follows from */
static void put_entry(const System *system, int k, int speed, Expr value)
{
    Arena *arena = system->arena;
    const int nu = system->kinematics->u.count;
    Expr *row = system->run.phi_u + (ptrdiff_t)k * nu;
    const Dependent *own;

    if (speed < nu) {
        row[speed] = expr_add(arena, row[speed], value);
        return;
    }
    own = &system->kinematics->dependents.at[speed - nu];
    value = expr_hold(arena, value);
    for (int i = 0; i < own->count; i++)
        row[own->first + i] =
            expr_add(arena, row[own->first + i], expr_mul(arena, own->factor[i], value));
}

static void run_way(const System *system, const Row *row, int k, const int *speeds, int count)
{
    Arena *arena = system->arena;
    Vec n;
    int axes = row_axes(system, row, &n);
    int tail = system->kinematics->frames[row->tail].chain;
    int resolve_tail = system->kinematics->chains.at[tail].resolve;
    int resolve_head =
        system->kinematics->chains.at[system->kinematics->frames[row->head].chain].resolve;
    bool turns_with_tail = row->kind == ROW_TAIL;
    int seen = -1; /* chain whose part of the way is D */
    Vec D = vec_zero(arena);
    Vec d = circuit_turned(system, row, -1, axes);
    Vec rest =
        vec_sub(arena, vec_express(system, system->kinematics->a0[row->head], resolve_head, axes),
                vec_express(system, system->kinematics->a0[row->tail], resolve_tail, axes));

    system->run.phi[k] = vec_dot(arena, n, d);
    for (int i = 0; i < count; i++) {
        int j = speeds[i];
        int turned = system->kinematics->speeds[j].chain;

        put_entry(system, k, j, circuit_slide(system, row, n, j, axes));
        if (turned < 0)
            continue;
        if (turned != seen) {
            D = circuit_turned(system, row, turned, axes);
            if (turns_with_tail && chain_is_beyond(system, tail, turned))
                D = vec_sub(arena, D, d);
            seen = turned;
        }
        put_entry(system, k, j,
                  vec_dot(arena, n, vec_cross(arena, speed_axis(system, j, axes), D)));
    }
    if (turns_with_tail) {
        Vec w = vec_express(system, system->kinematics->motions[tail].w, resolve_tail, axes);
        Vec alpha0 = vec_express(system, system->kinematics->alpha0[tail], resolve_tail, axes);
        Vec v = vec_sub(
            arena, vec_express(system, system->kinematics->frames[row->head].v, resolve_head, axes),
            vec_express(system, system->kinematics->frames[row->tail].v, resolve_tail, axes));
        Vec carried = vec_cross(arena, w, d);

        rest = vec_sub(arena, rest, vec_cross(arena, alpha0, d));
        rest = vec_sub(arena, rest, vec_cross(arena, w, carried));
        rest = vec_sub(arena, rest,
                       vec_scale(arena, expr_int(arena, 2),
                                 vec_cross(arena, w, vec_hold(arena, vec_sub(arena, v, carried)))));
    }
    system->run.gamma[k] = expr_neg(arena, vec_dot(arena, n, rest));
}

static void run_dot(const System *system, const Row *row, int k, const int *speeds, int count)
{
    Arena *arena = system->arena;
    int tail = system->kinematics->frames[row->tail].chain;
    int head = system->kinematics->frames[row->head].chain;
    int axes = system->kinematics->chains.at[tail].resolve;
    int other = system->kinematics->chains.at[head].resolve;
    Vec a = vec_hold(arena, vec_express(system, row->n, tail, axes));
    Vec b = vec_hold(arena, vec_express(system, row->b, head, axes));
    Vec c = vec_hold(arena, vec_cross(arena, b, a));
    Vec w_t = system->kinematics->motions[tail].w;
    Vec w_h = vec_express(system, system->kinematics->motions[head].w, other, axes);
    Vec alpha = vec_sub(arena, vec_express(system, system->kinematics->alpha0[head], other, axes),
                        system->kinematics->alpha0[tail]);
    Vec c_rate = vec_add(arena, vec_cross(arena, vec_cross(arena, w_h, b), a),
                         vec_cross(arena, b, vec_cross(arena, w_t, a)));

    system->run.phi[k] = vec_dot(arena, a, b);
    for (int i = 0; i < count; i++) {
        int j = speeds[i], turned = system->kinematics->speeds[j].chain;
        int sense =
            (int)chain_is_beyond(system, head, turned) - (int)chain_is_beyond(system, tail, turned);

        if (sense == 0)
            continue;
        put_entry(system, k, j,
                  vec_dot(arena,
                          vec_scale(arena, expr_int(arena, sense), speed_axis(system, j, axes)),
                          c));
    }
    system->run.gamma[k] =
        expr_neg(arena, expr_add(arena, vec_dot(arena, alpha, c),
                                 vec_dot(arena, vec_sub(arena, w_h, w_t), c_rate)));
}

/* rows whose own expression is short: angles, drivers and couplers */
static Status run_plain(System *system, const Row *row, int k, Diag *diag)
{
    Arena *arena = system->arena;
    int count = system->kinematics->u.count;
    Expr *speeds = NEW_ARRAY(Expr, count);
    Expr rate;
    Expr second;
    Status status = OK;

    for (int j = 0; j < count; j++) {
        speeds[j] = system->kinematics->u.at[j].symbol;
        system->run.phi_u[k * count + j] = speed_partial(system, row->phi, j);
    }
    CHECK(system_rate_of(system, row->phi, &rate, diag));
    CHECK(system_rate_of(system, rate, &second, diag));
    system->run.phi[k] = row->phi;
    system->run.nu[k] = expr_neg(arena, expr_substitute(arena, rate, speeds, NULL, count));
    system->run.gamma[k] = expr_neg(
        arena, expr_substitute(arena, second, system->kinematics->accelerations, NULL, count));
done:
    mem_free(speeds);
    return status;
}

static Status run_rows(System *system, Diag *diag)
{
    int m = system->constraints->rows.count, count = system->kinematics->u.count;
    size_t size = (size_t)m * sizeof(Expr);
    int *speeds = NEW_ARRAY(int, system->kinematics->speed_count);
    const Expr zero = expr_int(system->arena, 0);
    Status status = OK;

    system->run.phi = pool_alloc(system->pool, size);
    system->run.nu = pool_alloc(system->pool, size);
    system->run.gamma = pool_alloc(system->pool, size);
    system->run.phi_u = pool_alloc(system->pool, size * (size_t)count);
    for (int i = 0; i < m * count; i++)
        system->run.phi_u[i] = zero;
    for (int k = 0; k < m; k++) {
        const Row *row = &system->constraints->rows.at[k];
        int moving = speeds_of_row(system, row, speeds);

        system->run.nu[k] = expr_int(system->arena, 0);
        if (row->kind == ROW_DATUM || row->kind == ROW_TAIL)
            run_way(system, row, k, speeds, moving);
        else if (row->kind == ROW_DOT)
            run_dot(system, row, k, speeds, moving);
        else
            CHECK(run_plain(system, row, k, diag));
        CHECK(poll(system->watch));
    }
done:
    mem_free(speeds);
    return status;
}

static Status all_rows(System *system, Diag *diag)
{
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        Steps steps;
        bool slides;
        bool turns;

        if (instance->row->family == FAMILY_DRIVER || instance->row->family == FAMILY_COUPLER)
            driver_row(system, instance);
        if (instance->row->family != FAMILY_JOINT || instance->is_virtual)
            continue;
        instance_steps(system, instance, &steps);
        slides = !tree_has(system->origin->trees[TREE_TRANSLATION], instance->edge);
        turns = !tree_has(system->origin->trees[TREE_ROTATION], instance->edge);
        if (steps_are_tied(&steps) && slides != turns) {
            (void)diag_set(diag, E_BRANCH,
                           "%s ties a shift to a turn: it is a branch of both trees or of none",
                           instance->name);
            diag_hint(diag, "tree + %s puts it into both", instance->name);
            return E_BRANCH;
        }
        if (slides)
            force_rows(system, instance, &steps);
        if (turns)
            moment_rows(system, instance, &steps);
        if (slides && steps_are_tied(&steps))
            tie_row(system, instance, &steps);
    }
    return OK;
}

Status constraints_build(System *system, Diag *diag)
{
    Sample *samples[SAMPLES];
    int kept = 0;

    for (int i = 0; i < SAMPLES; i++)
        samples[i] = sample_new(system, (uint64_t)i, true);
    TRY(all_rows(system, diag));
    for (int k = 0; k < system->constraints->rows.count; k++) {
        Row *row = &system->constraints->rows.at[k];
        bool vanishes;

        TRY(row_shown(system, row, diag));
        TRY(row_vanishes(system, row, samples, &vanishes, diag));
        if (!vanishes)
            system->constraints->rows.at[kept++] = *row;
    }
    system->constraints->rows.count = kept;
    return run_rows(system, diag);
}
