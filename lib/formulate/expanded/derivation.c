/* derivation.c: terms of constraints, paths, directions and motions, for a reader
 *
 * The equations are formed in the axes of orientation classes at the zero position. A reader thinks
 * in the axes of frames, so vectors are returned in those. */
#include "formulate/expanded/derivation.h"
#include "formulate/expanded/derivation_impl.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/framesum.h"
#include "formulate/kinematics/multi_turn.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

static int datum_of(const System *system)
{
    int count;

    return tree_nodes(system->origin->trees[TREE_TRANSLATION], &count)[0];
}

/* zero-position components in the axes of a node's frame */
static NarrativeVector reported(const System *system, int node, Vec v)
{
    Rotation back = rotation_transpose(&system->kinematics->frames[node].zero);
    Vec own = rotation_apply(system->arena, &back, v);
    NarrativeVector out = {.node = node};

    for (int i = 0; i < 3; i++)
        out.at[i] =
            system_plain(system, expr_fold(system->arena, expr_open(system->arena, own.at[i])));
    return out;
}

/* the first frame with these axes: it represents the orientation class */
static int orientation_node(const System *system, int chain)
{
    const Graph *graph = system->origin->graph;

    for (int n = 0; chain > 0 && n < graph_node_count(graph); n++)
        if (graph_node(graph, n)->domain == DOMAIN_MECHANICAL &&
            system->kinematics->frames[n].chain == chain)
            return n;
    return datum_of(system);
}

/* from tail to head of the branch that leads to a node */
static Vec branch_shift(const System *system, int node)
{
    const Frame *frame = &system->kinematics->frames[node];

    return tree_is_forward(system->origin->trees[TREE_TRANSLATION], node)
               ? frame->shift
               : vec_neg(system->arena, frame->shift);
}

/* the branches between two nodes: a new list of `*count` edges, followed by their signs */
static int *path_between(const System *system, int tail, int head, int *count)
{
    const Tree *tree = system->origin->trees[TREE_TRANSLATION];
    const int room = tree_depth(tree, tail) + tree_depth(tree, head);
    int *edges = NEW_ARRAY(int, 2 * room + 1);

    *count = tree_path(tree, tail, head, edges, edges + room);
    for (int i = 0; i < *count; i++)
        edges[*count + i] = edges[room + i];
    return edges;
}

void system_way(const System *view, int chord, Way *out)
{
    const Edge *edge = graph_edge(view->origin->graph, chord);
    const Tree *tree = view->origin->trees[TREE_TRANSLATION];
    int count;
    int *path = path_between(view, edge->tail, edge->head, &count);

    for (int i = 0; i < count; i++) {
        const int node = tree_far_node(tree, path[i]);

        LIST_PUSH(*out, (WayStep){path[i], path[count + i],
                                  reported(view, view->kinematics->frames[node].base,
                                           branch_shift(view, node))});
    }
    mem_free(path);
}

void system_angles(const System *view, int node, Angles *out)
{
    Turns turns = {0};

    turns_between(view, 0, view->kinematics->frames[node].chain, &turns);
    for (int i = 0; i < turns.count; i++)
        LIST_PUSH(*out, turns.at[i].matrix != NULL ? NULL : turns.at[i].angle);
    LIST_FREE(turns);
}

/* --- terms of constraints --- */

static void push_shifts(System *system, const Row *row, Terms *terms)
{
    const Tree *tree = system->origin->trees[TREE_TRANSLATION];
    const int along = row->kind == ROW_DATUM ? 0 : system->kinematics->frames[row->tail].chain;
    const FrameSum n = framesum_of(system, along, row->n);
    int count;
    int *path = path_between(system, row->tail, row->head, &count);

    for (int i = 0; i < count; i++) {
        const int node = tree_far_node(tree, path[i]);
        const int sign = path[count + i];
        const FrameSum shift = framesum_of(system, system->kinematics->frames[node].step_chain,
                                           branch_shift(system, node));
        const Expr part = framesum_dot(system, n, shift);

        LIST_PUSH(*terms, (Term){.kind = TERM_SHIFT,
                                 .edge = path[i],
                                 .sign = sign,
                                 .instance = -1,
                                 .value = sign > 0 ? part : expr_neg(system->arena, part)});
    }
    mem_free(path);
}

/* turns about the row's axis, from the tail down to the last common orientation class and up to the
 * head */
static void push_turns(System *system, const Row *row, Terms *terms)
{
    const OrientationClass *chains = system->kinematics->chains.at;
    const Tree *tree = system->origin->trees[TREE_ROTATION];
    int from = system->kinematics->frames[row->tail].chain;
    int to = system->kinematics->frames[row->head].chain;
    Expr rest = row->phi;

    while (from != to) {
        const bool back = chains[from].depth > chains[to].depth;
        int *deeper = back ? &from : &to;
        const OrientationClass *chain = &chains[*deeper];
        const int node = system->kinematics->speeds[chain->speed].turn_node;
        const bool against = !vec_same(chain->axis, row->n);
        const Expr angle = back != against ? expr_neg(system->arena, chain->angle) : chain->angle;

        LIST_PUSH(*terms, (Term){.kind = TERM_TURN,
                                 .edge = tree_parent_edge(tree, node),
                                 .sign = back == tree_is_forward(tree, node) ? -1 : 1,
                                 .instance = -1,
                                 .value = angle});
        rest = expr_sub(system->arena, rest, angle);
        *deeper = chain->parent;
    }
    if (!expr_is_zero(rest))
        LIST_PUSH(*terms, (Term){.kind = TERM_WHOLE,
                                 .edge = -1,
                                 .instance = row->reported.instance,
                                 .value = rest});
}

/* whether a driver's or coupler's row is a coordinate less its prescribed value */
static bool is_difference(const System *system, const Row *row)
{
    return row->kind == ROW_COUPLER ||
           (row->kind == ROW_DRIVER &&
            (system->kinematics->coordinate[row->owner][row->coordinate] >= 0 ||
             multi_turn_angle(system, row->owner, row->coordinate) == NULL));
}

Status constraint_terms(System *system, int k, int column, Terms *out, Diag *diag)
{
    const Row *row = &system->constraints->rows.at[k];
    const Term whole = {
        .kind = TERM_WHOLE, .edge = -1, .instance = row->reported.instance, .value = row->phi};

    (void)column;
    (void)diag;
    if (row->kind == ROW_DATUM || row->kind == ROW_TAIL) {
        push_shifts(system, row, out);
    } else if (row->kind == ROW_ANGLE) {
        push_turns(system, row, out);
    } else if (row->reported.is_rate) {
        LIST_PUSH(*out, whole);
        out->at[out->count - 1].value = row->rate;
    } else if (is_difference(system, row)) {
        LIST_PUSH(*out, whole);
        out->at[out->count - 1].value = expr_add(system->arena, row->phi, row->prescribed);
        LIST_PUSH(*out, whole);
        out->at[out->count - 1].kind = TERM_ASKED;
        out->at[out->count - 1].value = expr_neg(system->arena, row->prescribed);
    } else {
        LIST_PUSH(*out, whole);
    }
    return OK;
}

Status jacobian_terms(System *system, int k, int j, Terms *out, Diag *diag)
{
    TRY(constraint_terms(system, k, 0, out, diag));
    for (int i = 0; i < out->count; i++)
        out->at[i].value = system->constraints->rows.at[k].rate != NULL
                               ? system->definitions.phi_u[k * system->kinematics->u.count + j]
                               : speed_partial(system, out->at[i].value, j);
    return OK;
}

Projection system_projection(const System *view, int row)
{
    const Row *at = &view->constraints->rows.at[row];
    Projection out = {.a = reported(view, at->tail, at->n), .b = reported(view, at->head, at->n)};

    switch (at->kind) {
    case ROW_DATUM:
        out.along = ALONG_AXIS;
        out.a = reported(view, datum_of(view), at->n);
        break;
    case ROW_TAIL:
        out.along = ALONG_AXIS;
        break;
    case ROW_DOT:
        out.along = ALONG_SQUARE;
        out.b = reported(view, at->head, at->b);
        break;
    case ROW_ANGLE:
        out.along = ALONG_TURN;
        break;
    case ROW_TIE:
        out.along = ALONG_TIE;
        break;
    case ROW_DRIVER:
        out.along = ALONG_DRIVEN;
        break;
    case ROW_COUPLER:
        out.along = ALONG_COUPLED;
        break;
    case ROW_CONTACT:
        out.along = at->reported.rotation ? ALONG_SPIN : ALONG_CONTACT;
        break;
    }
    return out;
}

/* --- motions --- */

void system_unit_motions(const System *view, int speed, UnitMotions *out)
{
    for (int i = 0; i < view->dynamics->masses.count; i++) {
        const Mass *mass = &view->dynamics->masses.at[i];
        const FrameSum v = partial_velocity(view, mass->node, speed);
        const int chain = view->kinematics->frames[mass->node].chain;
        UnitMotion motion = {.instance = mass->instance,
                             .v = {0},
                             .w = reported(view, mass->node, partial_turn(view, chain, speed))};

        for (int k = 0; k < v.count; k++)
            LIST_PUSH(motion.v,
                      reported(view, orientation_node(view, v.parts[k].chain), v.parts[k].v));
        LIST_PUSH(*out, motion);
    }
}

void unit_motions_free(UnitMotions *motions)
{
    for (int i = 0; i < motions->count; i++)
        LIST_FREE(motions->at[i].v);
    LIST_FREE(*motions);
}

void system_speed_edges(const System *view, int speed, int edges[2])
{
    const Speed *own = &view->kinematics->speeds[speed];

    edges[0] = own->slide_node < 0
                   ? -1
                   : tree_parent_edge(view->origin->trees[TREE_TRANSLATION], own->slide_node);
    edges[1] =
        own->chain < 0 ? -1 : tree_parent_edge(view->origin->trees[TREE_ROTATION], own->turn_node);
}
