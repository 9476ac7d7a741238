/* circuits.c: constraint rows n.d and a_t.b_h, in the shown and in the recursive form */
#include "formulate/kinematics/circuits.h"

#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/framesum.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/kinematics/section_frames.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

Expr circuit_shown(const System *system, const Row *row)
{
    const Frame *frames = system->kinematics->frames;
    const int tail = frames[row->tail].chain, head = frames[row->head].chain;
    const FrameSum n = framesum_of(system, row->kind == ROW_DATUM ? 0 : tail, row->n);

    const FrameSum to = row->kind == ROW_DOT ? framesum_of(system, head, row->b)
                                             : framesum_way(system, row->tail, row->head);

    return expr_fold(system->arena, expr_open(system->arena, framesum_dot(system, n, to)));
}

/* adds to `sum`, from the far end, the part of the vector from `ancestor` to a node that `chain`
 * turns (-1: all of it): shared parts are one definition */
static Vec add_way(const System *system, int node, int ancestor, int chain, int axes, Vec sum)
{
    for (; node != ancestor; node = system->kinematics->frames[node].parent) {
        const Frame *frame = &system->kinematics->frames[node];
        int resolved = system->kinematics->chains.at[frame->chain].resolve;

        if (chain >= 0 && !orientation_is_beyond(system, frame->step_chain, chain))
            continue;
        sum = vec_add(system->arena, sum, vec_express(system, frame->step, resolved, axes));
        sum = vec_hold(system->arena, sum);
    }
    return sum;
}

/* Inside an instance that follows another, the path is renamed from the first. False: it is not, or
 * not all of it is passed; otherwise *node is the node that the instance hangs from. */
static bool way_alike(const System *system, int *node, int ancestor, int chain, int axes, Vec *out)
{
    int first, around;
    const Follower *follower = isomorphic_node(system, *node, &first);
    FirstWay way = {.node = first};

    if (follower == NULL || isomorphic_node(system, ancestor, &around) == follower ||
        !isomorphic_chain_for(system, follower, axes, &way.axes) ||
        !isomorphic_chain_for(system, follower, chain, &way.chain))
        return false;
    for (; isomorphic_node(system, *node, &around) == follower; first = around) {
        if (*node == ancestor)
            return false;
        *node = system->kinematics->frames[*node].parent;
    }
    if (!isomorphic_find_way(follower, &way)) {
        way.sum = add_way(system, way.node, system->kinematics->frames[first].parent, way.chain,
                          way.axes, vec_zero(system->arena));
        isomorphic_keep_way(follower, &way);
    }
    *out = isomorphic_vec(follower, way.sum);
    return true;
}

static Vec way_turned(const System *system, int node, int ancestor, int chain, int axes)
{
    Vec sum = vec_zero(system->arena);

    (void)way_alike(system, &node, ancestor, chain, axes, &sum);
    return add_way(system, node, ancestor, chain, axes, sum);
}

int circuit_parting(const System *system, int a, int b)
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
    int ancestor = circuit_parting(system, row->tail, row->head);
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

/* rows n.d: the axes that they are computed in, and n in those axes */
static int row_axes(const System *system, const Row *row, Vec *n)
{
    int tail = system->kinematics->frames[row->tail].chain;
    int from = row->kind == ROW_DATUM ? 0 : tail;
    int axes = row->kind == ROW_DATUM ? 0 : system->kinematics->chains.at[tail].resolve;

    *n = vec_express(system, row->n, from, axes);
    return axes;
}

/* --- which speeds a row can move --- */

/* speeds that turn or slide something on a circuit; all of them are in low .. high */
typedef struct MarkedSpeeds {
    bool *turns, *slides;
    int low, high;
} MarkedSpeeds;

static void mark(MarkedSpeeds *marked, bool *of, int speed)
{
    of[speed] = true;
    marked->low = speed < marked->low ? speed : marked->low;
    marked->high = speed > marked->high ? speed : marked->high;
}

/* marks the turns of an orientation class and of all classes inward of it */
static void mark_turns(const System *system, int chain, MarkedSpeeds *marked)
{
    for (; chain > 0; chain = system->kinematics->chains.at[chain].parent) {
        const OrientationClass *own = &system->kinematics->chains.at[chain];

        if (marked->turns[own->speed])
            return; /* all classes further inward are marked */
        for (int j = own->speed; j < own->speed + own->speed_count; j++)
            mark(marked, marked->turns, j);
    }
}

static void mark_way(const System *system, int node, int ancestor, MarkedSpeeds *marked)
{
    for (; node != ancestor; node = system->kinematics->frames[node].parent) {
        const Frame *frame = &system->kinematics->frames[node];

        mark_turns(system, frame->step_chain, marked);
        for (int i = 0; i < frame->slide_count; i++)
            mark(marked, marked->slides, frame->slide[i].speed);
    }
}

int circuit_speeds(const System *system, const Row *row, int *speeds)
{
    const int all = system->kinematics->speed_count;
    MarkedSpeeds marked = {NEW_ARRAY(bool, all), NEW_ARRAY(bool, all), all, -1};
    int count = 0;

    if (row->kind != ROW_DOT) {
        int ancestor = circuit_parting(system, row->tail, row->head);

        mark_way(system, row->head, ancestor, &marked);
        mark_way(system, row->tail, ancestor, &marked);
    }
    if (row->kind != ROW_DATUM)
        mark_turns(system, system->kinematics->frames[row->tail].chain, &marked);
    if (row->kind == ROW_DOT)
        mark_turns(system, system->kinematics->frames[row->head].chain, &marked);
    for (int j = marked.low; j <= marked.high; j++)
        if (marked.turns[j] || marked.slides[j])
            speeds[count++] = j;
    MEM_FREE(marked.turns, marked.slides);
    return count;
}

/* adds to an entry of Phi_u; for a dependent speed, to the entries of the shapes that it follows
 * from */
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
    value = expr_name_temporary(arena, value);
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
    int seen = -1; /* orientation class whose part of the path is D */
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
            if (turns_with_tail && orientation_is_beyond(system, tail, turned))
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
        int sense = (int)orientation_is_beyond(system, head, turned) -
                    (int)orientation_is_beyond(system, tail, turned);

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

void circuit_run(const System *system, const Row *row, int k, const int *speeds, int count)
{
    if (row->kind == ROW_DOT)
        run_dot(system, row, k, speeds, count);
    else
        run_way(system, row, k, speeds, count);
}
