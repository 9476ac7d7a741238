/* lifted_constants.c: which numbers become parameters, and whether a scene differs in these alone
 *
 * These are not lifted: zeros, whose terms vanish; ones of lengths and axes; axes that several
 * joints have, whose turns add up; lengths and axes of circuits of joints alone, as they determine
 * which of their equations are redundant; gains, ratios and voltages of a network, which may
 * cancel. A circuit through a body's own freedoms excludes nothing. */
#include "formulate/system_build/lifted_constants.h"

#include "component/equation_block.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

#include <stdlib.h>
#include <string.h>

/* sizes from which forming equations takes longer than a person notices */
enum { MANY_BODIES = 17, MANY_ELEMENTS = 100 };

typedef struct LiftedConstants {
    Arena *arena;
    bool weights, geometry;  /* masses and inertias; lengths and axes */
    bool elements;           /* resistances and the like */
    LIST(const Expr *) axes; /* of joints, equal ones next to each other */
} LiftedConstants;

/* --- which numbers --- */

static bool moves(const Instance *instance, ParamKind kind)
{
    return (instance->row->family == FAMILY_ARM && kind == PARAM_VECTOR) ||
           (instance->row->family == FAMILY_JOINT && kind == PARAM_AXIS);
}

static bool weighs(const Instance *instance, ParamKind kind)
{
    return instance->row->inertia != NULL && (kind == PARAM_SCALAR || kind == PARAM_INERTIA);
}

/* a resistance, capacitance, inductance or similar */
static bool conducts(const Instance *instance, const Param *param)
{
    return instance->row->family == FAMILY_SCALAR && instance->row->param_count == 1 &&
           instance->row->scalar_edges == NULL && instance->row->terminal_count == 0 &&
           (param->kind == PARAM_SCALAR || param->kind == PARAM_LAW) && (param->use & GIVES) == 0;
}

static int by_entries(const void *a, const void *b)
{
    const Expr *const *one = a, *const *other = b;

    return memcmp(*one, *other, 3 * sizeof(Expr));
}

static void list_axes(LiftedConstants *lifted, const Scene *scene)
{
    for (int i = 0; i < scene->instance_count; i++) {
        const Instance *instance = scene->instances[i];

        for (int k = 0; k < instance->row->param_count; k++)
            if (instance->row->params[k].kind == PARAM_AXIS && moves(instance, PARAM_AXIS))
                LIST_PUSH(lifted->axes, instance->values[k].at);
    }
    if (lifted->axes.count > 1)
        qsort(lifted->axes.at, (size_t)lifted->axes.count, sizeof *lifted->axes.at, by_entries);
}

static bool is_alone(const LiftedConstants *lifted, const Expr *axis)
{
    const Expr *const *at = bsearch(&axis, lifted->axes.at, (size_t)lifted->axes.count,
                                    sizeof *lifted->axes.at, by_entries);
    const Expr *const *end = lifted->axes.at + lifted->axes.count;

    return (at == lifted->axes.at || by_entries(at - 1, at) != 0) &&
           (at + 1 == end || by_entries(at, at + 1) != 0);
}

/* whether the circuit of a joint that is a chord runs through a body's own freedoms */
static bool is_lifted(const Scene *scene, const Tree *tree, int chord, int *edges, int *signs)
{
    const Edge *edge = graph_edge(scene->graph, chord);
    const int count = tree_path(tree, edge->tail, edge->head, edges, signs);

    for (int k = 0; k < count; k++)
        if (scene->instances[graph_edge(scene->graph, edges[k])->component]->row->family ==
            FAMILY_BODY)
            return true;
    return false;
}

static bool all_lifted(const Scene *scene)
{
    const int most = graph_node_count(scene->graph);
    int *edges = NEW_ARRAY(int, 2 * most), *signs = NEW_ARRAY(int, 2 * most);
    bool loose = true;

    for (TreeKind kind = TREE_TRANSLATION; kind <= TREE_ROTATION; kind++)
        for (int i = 0; loose && i < tree_chord_count(scene->trees[kind]); i++) {
            const int chord = tree_chords(scene->trees[kind])[i];
            const int owner = graph_edge(scene->graph, chord)->component;

            loose = scene->instances[owner]->row->family != FAMILY_JOINT ||
                    is_lifted(scene, scene->trees[kind], chord, edges, signs);
        }
    mem_free(edges);
    mem_free(signs);
    return loose;
}

/* its axes are freed by LIST_FREE() */
static LiftedConstants choose(const Scene *scene)
{
    LiftedConstants lifted = {.arena = scene->arena};
    int bodies = 0, elements = 0;

    for (int i = 0; i < scene->instance_count; i++) {
        bodies += scene->instances[i]->row->inertia != NULL;
        elements += scene->instances[i]->row->family == FAMILY_SCALAR;
    }
    lifted.elements = elements >= MANY_ELEMENTS;
    lifted.weights = bodies >= MANY_BODIES;
    lifted.geometry = lifted.weights && all_lifted(scene);
    if (lifted.geometry)
        list_axes(&lifted, scene);
    return lifted;
}

/* expression in the equations for an entry of a value: itself, or the symbol that replaces it */
static Expr lifted_expression(const LiftedConstants *lifted, const Instance *instance, int param,
                              int entry)
{
    const ParamKind kind = instance->row->params[param].kind;
    const Expr e = instance->values[param].at[entry];

    /* a unit vector is stored exactly, with roots */
    if (expr_kinds(e) != 0 || expr_is_zero(e))
        return e;
    if ((lifted->weights && weighs(instance, kind)) ||
        (lifted->elements && conducts(instance, &instance->row->params[param])))
        return instance_lifted_constant(instance, lifted->arena, param, entry);
    if (!lifted->geometry || !moves(instance, kind) || expr_is(e, 1) || expr_is(e, -1) ||
        (kind == PARAM_AXIS && !is_alone(lifted, instance->values[param].at)))
        return e;
    return instance_lifted_constant(instance, lifted->arena, param, entry);
}

void lifted_constants_set(System *system, const Scene *scene)
{
    Origin *origin = system->origin;
    LiftedConstants lifted = choose(scene);

    origin->is_small = !lifted.weights && !lifted.elements;
    for (int i = 0; origin->wants_lifted && i < origin->instance_count; i++) {
        const Instance *from = scene->instances[i];

        for (int k = 0; k < from->row->param_count; k++)
            for (int c = 0; c < from->values[k].count; c++) {
                const Expr e = lifted_expression(&lifted, from, k, c);

                if (e == from->values[k].at[c])
                    continue;
                origin->instances[i].values[k].at[c] = e;
                origin->lifted_count++;
                LIST_PUSH(origin->parameters,
                          (GivenParameter){e, expr_evaluate(from->values[k].at[c], NULL, NULL)});
            }
    }
    LIST_FREE(lifted.axes);
}

/* --- whether two scenes differ in these alone --- */

static bool same_text(const char *a, const char *b)
{
    return a == b || (a != NULL && b != NULL && strcmp(a, b) == 0);
}

static bool same_texts(const char *const *a, const char *const *b, int count)
{
    for (int i = 0; i < count; i++)
        if (!same_text(a[i], b[i]))
            return false;
    return true;
}

static bool same_bytes(const void *a, const void *b, int count, size_t size)
{
    return count == 0 || memcmp(a, b, (size_t)count * size) == 0;
}

static bool same_values(const LiftedConstants *lifted, const Instance *own, const Instance *from)
{
    for (int k = 0; k < from->row->param_count; k++) {
        const Value *value = &own->values[k];

        if (value->count != from->values[k].count || value->given != from->values[k].given ||
            !same_text(value->word, from->values[k].word))
            return false;
        for (int c = 0; c < value->count; c++)
            if (value->at[c] != lifted_expression(lifted, from, k, c))
                return false;
    }
    return true;
}

static bool same_instance(const LiftedConstants *lifted, const Instance *own, const Instance *from)
{
    return own->row == from->row && strcmp(own->name, from->name) == 0 &&
           own->is_virtual == from->is_virtual && own->tail == from->tail &&
           own->head == from->head && own->edge == from->edge &&
           own->terminal_count == from->terminal_count &&
           same_bytes(own->terminals, from->terminals, from->terminal_count,
                      sizeof *own->terminals) &&
           same_texts(own->terminal_names, from->terminal_names, from->terminal_count) &&
           own->scalar_count == from->scalar_count &&
           same_bytes(own->scalar_edges, from->scalar_edges, from->scalar_count,
                      sizeof *own->scalar_edges) &&
           same_bytes(own->parts, from->parts, COUNT(own->parts), sizeof *own->parts) &&
           own->sensed == from->sensed && equation_block_same(own->given, from->given) &&
           own->joint == from->joint && own->joint_coordinate == from->joint_coordinate &&
           same_text(own->coordinate, from->coordinate) && own->on_angle == from->on_angle &&
           own->coord_count == from->coord_count &&
           same_texts(own->coord, from->coord, from->coord_count) && own->by == from->by &&
           own->by_coordinate == from->by_coordinate && same_values(lifted, own, from);
}

static bool same_graph(const Graph *own, const Graph *from)
{
    bool same = graph_node_count(own) == graph_node_count(from) &&
                graph_edge_count(own) == graph_edge_count(from);

    for (int i = 0; same && i < graph_node_count(from); i++) {
        const Node *a = graph_node(own, i), *b = graph_node(from, i);

        same = a->domain == b->domain && a->datum == b->datum && strcmp(a->name, b->name) == 0;
    }
    for (int i = 0; same && i < graph_edge_count(from); i++) {
        const Edge *a = graph_edge(own, i), *b = graph_edge(from, i);

        same = a->tail == b->tail && a->head == b->head && a->domain == b->domain &&
               a->component == b->component && strcmp(a->name, b->name) == 0;
    }
    return same;
}

static bool same_trees(const Tree *const *own, const Tree *const *from)
{
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        if ((own[kind] == NULL) != (from[kind] == NULL) ||
            (from[kind] != NULL && (tree_branch_count(own[kind]) != tree_branch_count(from[kind]) ||
                                    !same_bytes(tree_branches(own[kind]), tree_branches(from[kind]),
                                                tree_branch_count(from[kind]), sizeof(int)))))
            return false;
    return true;
}

static bool same_instances(const Origin *own, const Scene *from)
{
    LiftedConstants lifted = choose(from);
    bool same = true;

    for (int i = 0; same && i < from->instance_count; i++)
        same = same_instance(&lifted, &own->instances[i], from->instances[i]);
    LIST_FREE(lifted.axes);
    return same;
}

static bool same_scene(const Origin *own, const Scene *from)
{
    bool same =
        own->planar == from->planar && own->form == from->form &&
        same_bytes(own->gravity.at, from->gravity, 3, sizeof(Expr)) &&
        own->independent_count == from->independent_count &&
        same_texts(own->independent, from->independent, from->independent_count) &&
        own->instance_count == from->instance_count && own->output_count == from->outputs.count &&
        own->parameters.count >= from->parameters.count && same_graph(own->graph, from->graph) &&
        same_trees((const Tree *const *)own->trees, from->trees);

    for (int i = 0; same && i < from->outputs.count; i++)
        same = own->outputs[i] == from->outputs.at[i].body &&
               strcmp(own->output_names[i], from->outputs.at[i].name) == 0;
    for (int i = 0; same && i < from->parameters.count; i++)
        same = own->parameters.at[i].symbol == from->parameters.at[i].symbol;
    if (same && own->parameters.count > from->parameters.count)
        same = expr_name(own->parameters.at[from->parameters.count].symbol)[0] == '#';
    return same && same_instances(own, from);
}

static void follow(Origin *origin, const Scene *scene)
{
    mem_keep(origin);
    mem_keep(origin->parameters.at);
    origin->revision = scene->revision;
    for (int i = 0; i < origin->parameters.count; i++)
        origin->parameters.at[i].value =
            scene->number(scene->context, origin->parameters.at[i].symbol);
}

bool system_follows(System *view, const Scene *scene)
{
    /* redundant rows were found with the old lengths */
    if (view->origin->lifted_count == 0 || view->constraints->redundant_rows.count > 0 ||
        !same_scene(view->origin, scene))
        return false;
    follow(view->origin, scene);
    for (int i = 0; i < view->modes.count; i++)
        follow(view->modes.at[i]->origin, scene);
    if (view->sided != NULL && view->sided != view)
        follow(view->sided->origin, scene);
    return true;
}

bool system_serves(const System *system, const SystemOptions *options)
{
    const Origin *origin = system->origin;

    if (origin->rest_count != options->rest_count)
        return false;
    for (int i = 0; i < origin->rest_count; i++)
        if (origin->rests[i] != options->rests[i])
            return false;
    return options->has_lifted ? origin->wants_lifted || origin->is_small
                               : origin->lifted_count == 0;
}

Expr system_lifted_constant(const System *system, int i)
{
    const Origin *origin = system->origin;

    return i < origin->lifted_count
               ? origin->parameters.at[origin->parameters.count - origin->lifted_count + i].symbol
               : NULL;
}
