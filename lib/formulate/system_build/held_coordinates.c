/* held_coordinates.c: coordinates that do not change when an event sets positions */
#include "formulate/system_build/held_coordinates.h"

#include "base/text.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/edges.h"
#include "formulate/system/resolve.h"
#include "formulate/system/system_impl.h"

#include <string.h>

typedef struct HeldSearch {
    LIST(HeldCoordinate) all;
    int attitudes;
} HeldSearch;

/* functions of positions, and of their rates */
static bool is_motion(Expr value, Expr rate)
{
    const unsigned of_position =
        1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER | 1U << SYMBOL_COORDINATE | 1U << SYMBOL_TURN;

    return (expr_kinds(value) & ~of_position) == 0 &&
           (expr_kinds(value) & 1U << SYMBOL_COORDINATE) != 0 &&
           (expr_kinds(rate) & ~(of_position | 1U << SYMBOL_SPEED)) == 0;
}

/* Adds a coordinate with a name, if it exists; callers that need it use an equivalent one. False:
 * there is none. */
static bool add_named(System *system, const char *name, HeldCoordinate held, HeldSearch *out)
{
    Diag unasked = {0};

    if (system_variable(system, name, 0, &held.value, &unasked) != OK ||
        system_variable(system, name, 1, &held.rate, &unasked) != OK ||
        !is_motion(held.value, held.rate))
        return false;
    held.name = mem_text(name, strlen(name));
    LIST_PUSH(out->all, held);
    return true;
}

/* three angles of a chord have no names: the Euler parameters of the head against the tail replace
 * them */
static void add_attitude(System *system, const Instance *joint, HeldSearch *out)
{
    Expr p[4];

    relative_parameters(system, joint->tail, joint->head, p);
    for (int i = 0; i < 4; i++) {
        HeldCoordinate held = {
            .part = joint->name, .value = p[i], .node = -1, .attitude = out->attitudes};
        Diag unasked = {0};

        if (system_rate_of(system, p[i], &held.rate, &unasked) == OK &&
            is_motion(held.value, held.rate))
            LIST_PUSH(out->all, held);
    }
    out->attitudes++;
}

static void add_joints(System *system, HeldSearch *out)
{
    for (int i = 0; i < system_instance_count(system); i++) {
        const Instance *part = system_instance(system, i);
        const bool is_joint = part->row->family == FAMILY_JOINT;
        bool has_all = true;

        if (part->is_virtual)
            continue;
        for (int c = is_joint ? 0 : part->pose_count; c < part->coord_count; c++) {
            const bool is_parameter = part->coord_kind[c] == COORDINATE_PARAMETER;
            const HeldCoordinate held = {
                .part = part->name, .node = -1, .attitude = is_parameter ? out->attitudes : -1};

            if (!add_named(system, part->coord[c], held, out))
                has_all = has_all && system_coordinate(system, part, c) >= 0;
        }
        out->attitudes++;
        if (is_joint && !has_all && !system_is_planar(system))
            add_attitude(system, part, out);
    }
}

static int root_of(int *above, int node)
{
    while (above[node] != node)
        node = above[node] = above[above[node]];
    return node;
}

/* For each node, whether neither joints nor arms lead from ground to it; new. */
static bool *find_floating(const System *system)
{
    const Graph *graph = system_graph(system);
    const int count = graph_node_count(graph);
    int *above = NEW_ARRAY(int, count);
    bool *floats = NEW_ARRAY(bool, count);
    int datum = -1;

    for (int i = 0; i < count; i++) {
        above[i] = i;
        if (graph_node(graph, i)->domain == DOMAIN_MECHANICAL && graph_node(graph, i)->datum)
            datum = i;
    }
    for (int i = 0; i < system_instance_count(system); i++) {
        const Instance *part = system_instance(system, i);
        const bool holds = part->row->family == FAMILY_ARM ||
                           (part->row->family == FAMILY_JOINT && !part->is_virtual);

        if (holds && part->tail >= 0 && part->head >= 0)
            above[root_of(above, part->tail)] = root_of(above, part->head);
    }
    for (int i = 0; i < count; i++)
        floats[i] = datum >= 0 && graph_node(graph, i)->domain == DOMAIN_MECHANICAL &&
                    root_of(above, i) != root_of(above, datum);
    mem_free(above);
    return floats;
}

static void add_frame(System *system, int node, bool is_body, HeldSearch *out)
{
    static const char *const planar[] = {"x", "y", "theta", NULL};
    static const char *const spatial[] = {"x", "y", "z", "q0", "q1", "q2", "q3", NULL};
    const char *const *members = system_is_planar(system) ? planar : spatial;
    const char *frame = graph_node(system_graph(system), node)->name;

    for (int i = 0; members[i] != NULL; i++) {
        Text name = {0};

        text_addf(&name, "%s.%s", frame, members[i]);
        (void)add_named(system, name.at,
                        (HeldCoordinate){.part = frame,
                                         .node = node,
                                         .is_body = is_body,
                                         .attitude = members[i][0] == 'q' ? out->attitudes : -1},
                        out);
        text_free(&name);
    }
    out->attitudes++;
}

static int node_of(const VariableReferent *stand)
{
    switch (stand->kind) {
    case REFERENT_POSITION:
    case REFERENT_ANGLE:
    case REFERENT_PARAMETER:
        return stand->node;
    case REFERENT_COORDINATE:
        return stand->instance->row->family == FAMILY_BODY ? stand->instance->head : -1;
    case REFERENT_NONE:
    case REFERENT_SHIFT:
        break;
    }
    return -1;
}

/* derivative of a function of positions and speeds; NULL: the name is none, or there is no such
 * rate */
static Expr find_rate(System *system, const char *name, int primes)
{
    const unsigned unknown = ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER |
                               1U << SYMBOL_COORDINATE | 1U << SYMBOL_SPEED | 1U << SYMBOL_TURN);
    Diag unasked = {0};
    Expr rate;

    if (system_variable(system, name, primes, &rate, &unasked) != OK ||
        (expr_kinds(rate) & unknown) != 0)
        return NULL;
    return rate;
}

void system_named(System *system, const char *name, Named *out)
{
    const VariableReferent stand = system_referent(system, name);
    const bool of_joint = stand.kind == REFERENT_COORDINATE &&
                          stand.instance->coord_kind[stand.which] == COORDINATE_PARAMETER;
    int first = 0;

    *out = (Named){.node = node_of(&stand), .attitude = -1, .rate = find_rate(system, name, 1)};
    if (of_joint)
        while (stand.instance->coord_kind[first] != COORDINATE_PARAMETER)
            first++;
    if (of_joint || stand.kind == REFERENT_PARAMETER) {
        const char *owner =
            of_joint ? stand.instance->name : graph_node(system_graph(system), stand.node)->name;
        const int axis = stand.which - first;
        Text turning = {0};

        out->attitude = of_joint ? 2 * stand.instance->number + 1 : 2 * stand.node;
        text_addf(&turning, "%s.W%c", owner, 'x' + axis);
        if (axis < 3)
            out->turning = find_rate(system, turning.at, 0);
        text_free(&turning);
    }
}

static void add_frames(System *system, const char *const *named, int count, HeldSearch *out)
{
    bool *floats = find_floating(system);

    for (int i = 0; i < system_instance_count(system); i++) {
        const Instance *part = system_instance(system, i);

        if (part->row->family != FAMILY_BODY || part->head < 0 || !floats[part->head])
            continue;
        floats[part->head] = false;
        add_frame(system, part->head, true, out);
    }
    for (int i = 0; i < count; i++) {
        const VariableReferent stand = system_referent(system, named[i]);
        const int node = node_of(&stand);

        if (node < 0 || !floats[node])
            continue;
        floats[node] = false;
        add_frame(system, node, false, out);
    }
    mem_free(floats);
}

int system_held_coordinates(System *system, const char *const *named, int count,
                            HeldCoordinate **out)
{
    HeldSearch held = {0};

    add_joints(system, &held);
    add_frames(system, named, count, &held);
    *out = held.all.at;
    return held.all.count;
}

void held_coordinates_free(HeldCoordinate *held, int count)
{
    for (int i = 0; i < count; i++)
        mem_free(held[i].name);
    mem_free(held);
}
