/* edges.c: queries for the mechanical edges of a system */
#include "formulate/kinematics/edges.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include <string.h>

const Graph *system_graph(const System *system)
{
    return system->origin->graph;
}

const Tree *system_tree(const System *system, TreeKind kind)
{
    return system->origin->trees[kind];
}

bool system_is_planar(const System *system)
{
    return system->origin->planar;
}

int system_instance_count(const System *system)
{
    return system->origin->instance_count;
}

const Instance *system_instance(const System *system, int i)
{
    return &system->origin->instances[i];
}

void system_steps(const System *system, const Instance *instance, Steps *out)
{
    instance_steps(system, instance, out);
}

int system_coordinate(const System *system, const Instance *instance, int coordinate)
{
    return system->kinematics->coordinate[instance->number][coordinate];
}

/* a member of the frame that the first part of the name names */
static VariableReferent frame_referent(const System *system, int node, const char *member)
{
    VariableReferent referent = {.node = node};

    if (strlen(member) == 1 && member[0] >= 'x' && member[0] <= 'z') {
        referent.kind = REFERENT_POSITION;
        referent.which = member[0] - 'x';
    } else if (strcmp(member, "theta") == 0 && system->origin->planar) {
        referent.kind = REFERENT_ANGLE;
    } else if (strlen(member) == 2 && member[0] == 'q' && member[1] >= '0' && member[1] <= '3') {
        referent.kind = REFERENT_PARAMETER;
        referent.which = member[1] - '0';
    }
    return referent;
}

VariableReferent system_referent(const System *system, const char *name)
{
    const char *dot = strrchr(name, '.');
    int number = names_find(system->origin->coordinate_names, name);
    VariableReferent referent = {0};
    char *head;
    int node;

    if (number >= 0) {
        const CoordinateOwner *owner = &system->origin->coordinate_owners.at[number];

        if (owner->coordinate >= system->origin->instances[owner->instance].pose_count)
            return referent; /* of a shape: it determines no frame by itself */

        return (VariableReferent){.kind = REFERENT_COORDINATE,
                                  .instance = &system->origin->instances[owner->instance],
                                  .which = owner->coordinate};
    }
    if (dot == NULL)
        return referent;
    head = mem_text(name, (size_t)(dot - name));
    node = graph_find_node(system->origin->graph, head);
    number = names_find(system->origin->instance_names, head);
    if (node >= 0 && graph_node(system->origin->graph, node)->domain == DOMAIN_MECHANICAL) {
        referent = frame_referent(system, node, dot + 1);
    } else if (number >= 0 && strcmp(dot + 1, "s") == 0 &&
               system->origin->instances[number].row->family == FAMILY_JOINT) {
        Steps steps;

        instance_steps(system, &system->origin->instances[number], &steps);
        if (steps_are_tied(&steps))
            referent = (VariableReferent){.kind = REFERENT_SHIFT,
                                          .instance = &system->origin->instances[number]};
    }
    mem_free(head);
    return referent;
}

Expr system_driven(const System *system, int row, const Instance **owner, int *coordinate)
{
    const Row *driver = &system->constraints->rows.at[row];

    if (driver->kind != ROW_DRIVER)
        return NULL;
    *owner = &system->origin->instances[driver->owner];
    *coordinate = driver->coordinate;
    return driver->prescribed;
}
