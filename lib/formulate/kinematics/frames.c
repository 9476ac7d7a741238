/* frames.c: orientation classes along the rotation tree, joint primitives along the translation
 * tree */
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/identity.h"
#include "formulate/kinematics/section_frames.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <string.h>

void instance_steps(const System *system, const Instance *instance, Steps *steps)
{
    instance->row->steps(instance, system->arena, system->origin->planar, steps);
}

Vec frame_vector(const System *system, int node, Vec in_frame)
{
    return rotation_apply(system->arena, &system->kinematics->frames[node].zero, in_frame);
}

/* --- orientation classes --- */

/* an orientation class beyond `parent`; its speeds are set later */
static int add_chain(System *system, int parent, int speed)
{
    OrientationClass chain = {.parent = parent,
                              .depth = system->kinematics->chains.at[parent].depth + 1,
                              .run = system->kinematics->chains.count,
                              .speed = speed,
                              .speed_count = 1};

    /* in a plane every turn is about one axis, and ground's axes serve all classes */
    chain.resolve = system->origin->planar ? 0 : system->kinematics->chains.count;
    LIST_PUSH(system->kinematics->chains, chain);
    return system->kinematics->chains.count - 1;
}

/* 1 for the same axis, -1 for the opposite one, otherwise 0 */
static int axis_sense(Arena *arena, Vec a, Vec b)
{
    if (vec_same(a, b))
        return 1;
    return vec_same(a, vec_neg(arena, b)) ? -1 : 0;
}

/* a named temporary, so that the angles of successive classes share their sums */
static Expr turn_further(Arena *arena, Expr angle, int sense, Expr by)
{
    angle = expr_name_temporary(arena, angle);
    return sense > 0 ? expr_add(arena, angle, by) : expr_sub(arena, angle, by);
}

/* joins a coaxial group: the turn of an orientation class continues that before it, about the same
 * line */
static void join_run(const System *system, OrientationClass *chain)
{
    const OrientationClass *chains = system->kinematics->chains.at,
                           *before = &chains[chain->parent];
    const int sense = before->parent >= 0 && !before->is_free
                          ? axis_sense(system->arena, chains[before->run].axis, chain->axis)
                          : 0;

    chain->turned = chain->angle;
    if (sense == 0)
        return;
    chain->run = before->run;
    chain->turned = turn_further(system->arena, before->turned, sense, chain->angle);
}

static Vec unit_axis(Arena *arena, int k)
{
    Vec axis = vec_zero(arena);

    axis.at[k] = expr_int(arena, 1);
    return axis;
}

static Vec turn_vector(Arena *arena, const Turn *turn, Vec b);

/* for a turn about an oblique axis: one matrix serves all vectors that pass it */
static void add_matrix(Arena *arena, OrientationClass *chain)
{
    const Turn turn = {chain->axis, chain->angle, NULL, false};
    int others = 0;

    for (int i = 0; i < 3; i++)
        others += expr_is_zero(chain->axis.at[i]);
    chain->is_askew = others < 2;
    for (int j = 0; chain->is_askew && j < 3; j++) {
        const Vec column = vec_hold(arena, turn_vector(arena, &turn, unit_axis(arena, j)));

        for (int i = 0; i < 3; i++)
            chain->matrix.at[3 * i + j] = column.at[i];
    }
}

static int add_turn(System *system, int parent, Vec axis, Expr angle, int speed, bool forward)
{
    Arena *arena = system->arena;
    int number = add_chain(system, parent, speed);
    OrientationClass *chain = &system->kinematics->chains.at[number];

    chain->axis = axis;
    chain->angle = forward ? angle : expr_neg(arena, angle);
    join_run(system, chain);
    add_matrix(arena, chain);
    system->kinematics->speeds[speed].chain = number;
    system->kinematics->speeds[speed].axis = forward ? axis : vec_neg(arena, axis);
    system->kinematics->speeds[speed].axis_chain = number;
    return number;
}

/* (e0^2 - e.e) 1 + 2 e e^T + 2 e0 S(e) */
static Rotation parameter_matrix(Arena *arena, const Expr p[4])
{
    Expr square[4];
    Rotation R;

    for (int i = 0; i < 4; i++)
        square[i] = expr_square(arena, p[i]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int k = 3 - i - j;
            bool ahead = j == (i + 1) % 3;
            Expr mixed = expr_mul(arena, p[1 + i], p[1 + j]);
            Expr turned;

            if (i == j) {
                Expr sum = expr_add(arena, square[0], square[1 + i]);

                sum = expr_sub(arena, sum, square[1 + (i + 1) % 3]);
                R.at[4 * i] =
                    expr_name_temporary(arena, expr_sub(arena, sum, square[1 + (i + 2) % 3]));
                continue;
            }
            turned = expr_mul(arena, p[0], p[1 + k]);
            mixed = ahead ? expr_sub(arena, mixed, turned) : expr_add(arena, mixed, turned);
            R.at[3 * i + j] =
                expr_name_temporary(arena, expr_mul(arena, expr_int(arena, 2), mixed));
        }
    return R;
}

/* a free rotation: R(p), or its transpose where the branch is passed backwards, between the
 * constant rotations Z and Z^T; its speeds are components in the head's axes */
static int add_free(System *system, int parent, const Rotation *zero, int coordinate, int speed,
                    bool forward)
{
    Arena *arena = system->arena;
    int number = add_chain(system, parent, speed);
    OrientationClass *chain = &system->kinematics->chains.at[number];
    Rotation back = rotation_transpose(zero);
    Expr p[4];
    Vec e;

    for (int i = 0; i < 4; i++)
        p[i] = system->kinematics->q.at[coordinate + i].symbol;
    e = rotation_apply(arena, zero, (Vec){{p[1], p[2], p[3]}});
    chain->parameter[0] = p[0];
    for (int i = 0; i < 3; i++)
        chain->parameter[1 + i] = forward ? e.at[i] : expr_neg(arena, e.at[i]);
    chain->is_free = true;
    chain->speed_count = 3;
    chain->matrix = parameter_matrix(arena, p);
    if (!forward)
        chain->matrix = rotation_transpose(&chain->matrix);
    chain->matrix = rotation_product(arena, zero, &chain->matrix);
    chain->matrix = rotation_product(arena, &chain->matrix, &back);
    for (int i = 0; i < 3; i++) {
        Speed *own = &system->kinematics->speeds[speed + i];
        Vec axis = vec_zero(arena);

        axis.at[i] = expr_int(arena, forward ? 1 : -1);
        own->chain = number;
        own->axis = rotation_apply(arena, zero, axis);
        own->axis_chain = forward ? number : parent;
    }
    return number;
}

/* a section frame turns about z, then the new y, then the newest x */
static int turn_section_frame(System *system, const SectionFrame *station, int first, int chain,
                              const Rotation *zero, int node, bool forward)
{
    const int turns = system->origin->planar ? 1 : 3;

    for (int k = 0; k < turns; k++) {
        const int which = forward ? k : turns - 1 - k, speed = first + 3 + which;
        const Vec axis = rotation_apply(system->arena, zero, unit_axis(system->arena, 2 - which));

        system->kinematics->speeds[speed].turn_node = node;
        if (expr_is_zero(station->angle[which]))
            continue;
        chain = add_turn(system, chain, axis, station->angle[which], speed, forward);
    }
    return chain;
}

/* the turns of one rotation branch, passed from the parent to the node beyond */
static void turn_branch(System *system, int node)
{
    Arena *arena = system->arena;
    const Tree *tree = system->origin->trees[TREE_ROTATION];
    const Edge *edge = graph_edge(system->origin->graph, tree_parent_edge(tree, node));
    const Instance *instance = &system->origin->instances[edge->component];
    const Frame *parent = &system->kinematics->frames[tree_parent(tree, node)];
    bool forward = tree_is_forward(tree, node);
    int chain = parent->chain;
    Rotation zero = parent->zero;
    Rotation constant;
    int first;
    const SectionFrame *station = section_frame_of(system, instance, &first);
    Steps steps;

    instance_steps(system, instance, &steps);
    for (int i = 0; i < 9; i++)
        constant.at[i] = steps.rotation[i];
    if (!forward) {
        Rotation back = rotation_transpose(&constant);

        zero = rotation_product(arena, &zero, &back);
    }
    if (steps.quaternion) {
        int place = system->kinematics->coordinate[instance->number][steps.first_parameter];
        int speed = system->kinematics->speed[instance->number][steps.first_parameter];

        chain = add_free(system, chain, &zero, place, speed, forward);
        for (int i = 0; i < 3; i++)
            system->kinematics->speeds[speed + i].turn_node = node;
    }
    if (station != NULL)
        chain = turn_section_frame(system, station, first, chain, &zero, node, forward);
    for (int k = 0; k < steps.turn_count; k++) {
        const Step *turn = &steps.turn[forward ? k : steps.turn_count - 1 - k];
        int place = system->kinematics->coordinate[instance->number][turn->coordinate];
        int speed = system->kinematics->speed[instance->number][turn->coordinate];
        Vec axis = {{turn->axis[0], turn->axis[1], turn->axis[2]}};

        axis = rotation_apply(arena, &zero, axis);
        chain =
            add_turn(system, chain, axis, system->kinematics->q.at[place].symbol, speed, forward);
        system->kinematics->speeds[speed].turn_node = node;
    }
    if (forward)
        zero = rotation_product(arena, &zero, &constant);
    system->kinematics->frames[node].chain = chain;
    system->kinematics->frames[node].zero = zero;
}

/* --- steps --- */

static void step_branch(System *system, int node)
{
    Arena *arena = system->arena;
    const Tree *tree = system->origin->trees[TREE_TRANSLATION];
    const Edge *edge = graph_edge(system->origin->graph, tree_parent_edge(tree, node));
    const Instance *instance = &system->origin->instances[edge->component];
    Frame *frame = &system->kinematics->frames[node];
    bool forward = tree_is_forward(tree, node);
    int first;
    const SectionFrame *station = section_frame_of(system, instance, &first);
    const int slides = station != NULL ? 3 : 0;
    Steps steps;
    Vec shift;

    instance_steps(system, instance, &steps);
    if (station != NULL)
        memcpy(steps.constant, station->position, sizeof steps.constant);
    frame->parent = tree_parent(tree, node);
    frame->base = edge->tail;
    frame->step_chain = system->kinematics->frames[edge->tail].chain;
    shift = frame_vector(system, edge->tail,
                         (Vec){{steps.constant[0], steps.constant[1], steps.constant[2]}});
    frame->slide =
        pool_alloc(system->pool, (size_t)(steps.shift_count + slides) * sizeof *frame->slide);
    for (int k = 0; k < slides; k++) {
        Vec axis = frame_vector(system, edge->tail, unit_axis(arena, k));

        system->kinematics->speeds[first + k].slide_node = node;
        frame->slide[frame->slide_count++] =
            (Slide){first + k, forward ? axis : vec_neg(arena, axis)};
    }
    for (int k = 0; k < steps.shift_count; k++) {
        const Step *slide = &steps.shift[k];
        int place = system->kinematics->coordinate[instance->number][slide->coordinate];
        int speed = system->kinematics->speed[instance->number][slide->coordinate];
        Vec axis = frame_vector(system, edge->tail,
                                (Vec){{slide->axis[0], slide->axis[1], slide->axis[2]}});

        axis = vec_scale(arena, slide->scale, axis);
        system->kinematics->speeds[speed].slide_node = node;
        shift =
            vec_add(arena, shift, vec_scale(arena, system->kinematics->q.at[place].symbol, axis));
        frame->slide[frame->slide_count++] = (Slide){speed, forward ? axis : vec_neg(arena, axis)};
    }
    frame->shift = forward ? shift : vec_neg(arena, shift);
}

/* numbers the orientation classes so that all beyond one have the numbers first..last */
static void number_chains(System *system)
{
    OrientationClass *chains = system->kinematics->chains.at;
    int count = system->kinematics->chains.count;
    int *beyond = NEW_ARRAY(int, count);
    int *next = NEW_ARRAY(int, count);

    for (int c = count - 1; c > 0; c--)
        beyond[chains[c].parent] += beyond[c] + 1;
    chains[0].first = 0;
    chains[0].last = beyond[0];
    /* parents come before children: the next free number of each parent */
    for (int c = 0; c < count; c++) {
        if (c > 0) {
            chains[c].first = next[chains[c].parent];
            chains[c].last = chains[c].first + beyond[c];
            next[chains[c].parent] = chains[c].last + 1;
        }
        next[c] = chains[c].first + 1;
    }
    MEM_FREE(beyond, next);
}

/* --- masses --- */

static void add_masses(System *system)
{
    Arena *arena = system->arena;

    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        Mass mass = {.instance = i, .node = instance->head};
        Expr tensor[6];

        if (instance->row->inertia == NULL)
            continue;
        instance->row->inertia(instance, arena, system->origin->planar, &mass.mass, tensor);
        for (int k = 0; k < 6; k++)
            mass.has_inertia = mass.has_inertia || !expr_is_zero(tensor[k]);
        mass.inertia = inertia_turned(arena, &system->kinematics->frames[mass.node].zero, tensor);
        LIST_PUSH(system->dynamics->masses, mass);
    }
}

void frames_build(System *system)
{
    Arena *arena = system->arena;
    int count = graph_node_count(system->origin->graph);
    int nodes;
    const int *order;

    system->kinematics->frames =
        pool_alloc(system->pool, (size_t)count * sizeof *system->kinematics->frames);
    LIST_PUSH(
        system->kinematics->chains,
        (OrientationClass){.parent = -1, .axis = vec_zero(arena), .angle = expr_int(arena, 0)});
    if (system->origin->trees[TREE_ROTATION] == NULL)
        return;
    section_frames_build(system);
    order = tree_nodes(system->origin->trees[TREE_ROTATION], &nodes);
    for (int i = 0; i < nodes; i++) {
        Frame *frame = &system->kinematics->frames[order[i]];

        *frame = (Frame){.zero = rotation_one(arena), .parent = -1, .shift = vec_zero(arena)};
        if (tree_parent(system->origin->trees[TREE_ROTATION], order[i]) >= 0)
            turn_branch(system, order[i]);
    }
    number_chains(system);
    order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    for (int i = 0; i < nodes; i++)
        if (tree_parent(system->origin->trees[TREE_TRANSLATION], order[i]) >= 0)
            step_branch(system, order[i]);
    add_masses(system);
}

/* --- turns between orientation classes --- */

bool orientation_is_beyond(const System *system, int chain, int turn)
{
    const OrientationClass *chains = system->kinematics->chains.at;

    return chains[chain].first >= chains[turn].first && chains[chain].first <= chains[turn].last;
}

/* the next orientation class on the path from one to another; a whole coaxial group is skipped
 * where the path passes all of it */
static int class_towards(const System *system, int chain, int other)
{
    const OrientationClass *chains = system->kinematics->chains.at;
    const int run = chains[chain].run;

    return chains[orientation_is_beyond(system, other, run) ? chain : run].parent;
}

/* adds the turn from `start` to an orientation class, or back: of a whole coaxial group, or of the
 * class alone */
static void append_turn(const System *system, Turns *turns, int start, int number, bool back)
{
    Arena *arena = system->arena;
    const OrientationClass *chains = system->kinematics->chains.at, *chain = &chains[number];
    const bool whole = chains[chain->run].parent == start;
    const Vec axis = whole ? chains[chain->run].axis : chain->axis;
    Expr angle = whole ? chain->turned : chain->angle;
    Turn *last = turns->count > 0 ? &turns->at[turns->count - 1] : NULL;
    int sense = last != NULL && last->matrix == NULL && !chain->is_free
                    ? axis_sense(arena, last->axis, axis)
                    : 0;

    if (!chain->is_free && expr_is_zero(angle))
        return;
    if (back && !chain->is_free)
        angle = expr_neg(arena, angle);
    if (sense == 0) {
        LIST_PUSH(*turns, (Turn){axis, angle, chain->is_free ? &chain->matrix : NULL, back});
        return;
    }
    last->angle = turn_further(arena, last->angle, sense, angle);
    if (expr_is_zero(last->angle))
        turns->count--;
}

void turns_between(const System *system, int from, int to, Turns *turns)
{
    const OrientationClass *chains = system->kinematics->chains.at;
    LIST(int) down = {0};

    turns->count = 0;
    /* up to the common orientation class, and down again */
    while (from != to) {
        if (chains[from].depth >= chains[to].depth) {
            const int next = class_towards(system, from, to);

            append_turn(system, turns, next, from, true);
            from = next;
        } else {
            LIST_PUSH(down, to);
            to = class_towards(system, to, from);
        }
    }
    for (int k = down.count - 1; k >= 0; k--) {
        append_turn(system, turns, from, down.at[k], false);
        from = down.at[k];
    }
    LIST_FREE(down);
}

/* R b; exp(k a) b by the part of b along k, the part across and k x b (Rodrigues 1840) */
static Vec turn_vector(Arena *arena, const Turn *turn, Vec b)
{
    Vec along;
    Vec across;
    Vec side;

    if (turn->matrix != NULL) {
        Rotation back = rotation_transpose(turn->matrix);

        return rotation_apply(arena, turn->back ? &back : turn->matrix, b);
    }
    along = vec_scale(arena, vec_dot(arena, turn->axis, b), turn->axis);
    across = vec_sub(arena, b, along);
    if (vec_is_zero(across))
        return b;
    side = vec_scale(arena, expr_sin(arena, turn->angle), vec_cross(arena, turn->axis, b));
    across = vec_scale(arena, expr_cos(arena, turn->angle), across);
    return vec_add(arena, along, vec_add(arena, across, side));
}

/* v is parallel to an axis of the frame */
static bool is_along(Vec axis, Vec v)
{
    int others = 0;

    for (int i = 0; i < 3; i++) {
        if (expr_is_zero(axis.at[i]) && !expr_is_zero(v.at[i]))
            return false;
        others += expr_is_zero(axis.at[i]);
    }
    return others == 2;
}

/* all turns on the path are about the line of v */
static bool is_carried_unchanged(const System *system, Vec v, int from, int to)
{
    const OrientationClass *chains = system->kinematics->chains.at;

    while (from != to) {
        const bool climbs = chains[from].depth >= chains[to].depth;
        int *deeper = climbs ? &from : &to;

        if (chains[*deeper].is_free || (!is_along(chains[*deeper].axis, v) &&
                                        axis_sense(system->arena, v, chains[*deeper].axis) == 0))
            return false;
        *deeper = class_towards(system, *deeper, climbs ? to : from);
    }
    return true;
}

Vec vec_express(const System *system, Vec v, int from, int to)
{
    Turns turns = {0};

    if (from == to || vec_is_zero(v) || is_carried_unchanged(system, v, from, to))
        return v;
    turns_between(system, to, from, &turns);
    for (int k = turns.count - 1; k >= 0; k--)
        v = turn_vector(system->arena, &turns.at[k], v);
    LIST_FREE(turns);
    return v;
}

void vec_express_outward(const System *system, Vec v, Vec *out)
{
    const OrientationClass *chains = system->kinematics->chains.at;

    out[0] = v;
    for (int c = 1; c < system->kinematics->chains.count; c++) {
        const int start = chains[chains[c].run].parent;

        out[c] = chains[c].resolve == c ? vec_express(system, out[start], start, c) : v;
    }
}

Outward outward_new(const System *system, Vec v)
{
    const int chains = system->kinematics->chains.count;
    Outward outward = {NEW_ARRAY(Vec, chains), NEW_ARRAY(bool, chains)};

    outward.at[0] = v;
    outward.is_known[0] = true;
    return outward;
}

void outward_free(Outward *outward)
{
    MEM_FREE(outward->at, outward->is_known);
}

Vec outward_at(const System *system, Outward *outward, int chain)
{
    const OrientationClass *chains = system->kinematics->chains.at;

    /* outward from the last known one: most callers go outward as well */
    while (!outward->is_known[chain]) {
        int next = chain;

        while (!outward->is_known[chains[chains[next].run].parent])
            next = chains[chains[next].run].parent;
        outward->at[next] = chains[next].resolve == next
                                ? vec_express(system, outward->at[chains[chains[next].run].parent],
                                              chains[chains[next].run].parent, next)
                                : outward->at[0];
        outward->is_known[next] = true;
    }
    return outward->at[chain];
}

Vec vec_carry(const System *system, Vec v, int from, int to)
{
    const OrientationClass *chains = system->kinematics->chains.at;
    const bool back = chains[to].parent == from;
    const OrientationClass *turn = back ? &chains[to] : &chains[from];
    Rotation matrix;

    if ((!back && turn->parent != to) || !turn->is_askew ||
        is_carried_unchanged(system, v, from, to))
        return vec_express(system, v, from, to);
    matrix = back ? rotation_transpose(&turn->matrix) : turn->matrix;
    return rotation_apply(system->arena, &matrix, v);
}

Vec vec_carry_held(const System *system, Vec v, int from, int to)
{
    return vec_hold(system->arena, vec_carry(system, v, from, to));
}

int node_axes(const System *system, int node)
{
    return system->kinematics->chains.at[system->kinematics->frames[node].chain].resolve;
}

/* The vector is a named temporary, found again by its key: several sums contain it, also those of
 * other Systems in the arena. */
Vec speed_axis(const System *system, int speed, int axes)
{
    const OrientationClass *chains = system->kinematics->chains.at;
    const int from = system->kinematics->speeds[speed].axis_chain;
    Vec axis = system->kinematics->speeds[speed].axis;
    Key key;
    Expr reported;

    if (from < 0 || from == axes || vec_is_zero(axis) ||
        is_carried_unchanged(system, axis, from, axes))
        return axis;
    key = key_of(chains[from].identity);
    key_add(&key, &chains[axes].identity, sizeof(Expr));
    key_add(&key, &axis, sizeof axis);
    reported = key_end(system, &key);
    if (derived_recall(system, reported, DERIVED_AXIS, &axis, sizeof axis))
        return axis;
    axis = vec_express(system, axis, from, axes);
    derived_store(system, reported, DERIVED_AXIS, &axis, sizeof axis);
    return axis;
}

Vec speed_slide(const System *system, int speed, int axes)
{
    int node = system->kinematics->speeds[speed].slide_node;

    for (int k = 0; node >= 0 && k < system->kinematics->frames[node].slide_count; k++) {
        const Frame *frame = &system->kinematics->frames[node];

        if (frame->slide[k].speed == speed)
            return vec_express(system, frame->slide[k].axis, frame->step_chain, axes);
    }
    return vec_zero(system->arena);
}

int speed_node(const System *system, int speed)
{
    const Speed *own = &system->kinematics->speeds[speed];

    if (own->chain < 0 && own->slide_node < 0)
        return own->shape_node;
    return own->chain >= 0 ? own->turn_node : own->slide_node;
}

Expr rotation_angle(Arena *arena, const Rotation *rotation, Vec axis)
{
    const Expr *R = rotation->at;
    Expr half = expr_rational(arena, 1, 2);
    Vec twice;
    Expr sine;
    Expr cosine;

    if (rotation_is_one(rotation))
        return expr_int(arena, 0);
    twice = (Vec){
        {expr_sub(arena, R[7], R[5]), expr_sub(arena, R[2], R[6]), expr_sub(arena, R[3], R[1])}};
    sine = expr_mul(arena, half, vec_dot(arena, axis, twice));
    cosine = expr_sum(arena, (Expr[]){R[0], R[4], R[8], expr_int(arena, -1)}, 4);
    return expr_call2(arena, OP_ATAN2, sine, expr_mul(arena, half, cosine));
}

bool *frames_moving(const System *system)
{
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    bool *moves = NEW_ARRAY(bool, graph_node_count(system->origin->graph));

    for (int i = 1; i < nodes; i++) {
        const Frame *frame = &system->kinematics->frames[order[i]];

        moves[order[i]] = moves[frame->parent] || frame->slide_count > 0 || frame->chain != 0 ||
                          frame->step_chain != 0;
    }
    return moves;
}
