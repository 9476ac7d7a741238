/* system_end.c: views on a System, and freeing both */
#include "formulate/dynamics/composite_mass.h"
#include "formulate/dynamics/shapes.h"
#include "formulate/kinematics/section_frames.h"
#include "formulate/network/network_isomorphic.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

System *system_view(const System *formed)
{
    System *view = NEW(System);

    *view = *formed;
    view->formed = formed;
    view->pool = pool_new(0);
    view->shown = NEW(Shown);
    return view;
}

static void origin_free(Origin *origin)
{
    if (origin == NULL)
        return;
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        tree_free(origin->trees[kind]);
    graph_free(origin->graph);
    names_free(origin->instance_names);
    names_free(origin->coordinate_names);
    LIST_FREE(origin->coordinate_owners);
    LIST_FREE(origin->parameters);
    mem_free(origin);
}

static void kinematics_free(Kinematics *kinematics)
{
    if (kinematics == NULL)
        return;
    LIST_FREE(kinematics->q);
    LIST_FREE(kinematics->u);
    LIST_FREE(kinematics->quaternions);
    LIST_FREE(kinematics->chains);
    LIST_FREE(kinematics->dependents);
    mem_free(kinematics);
}

static void constraints_free(Constraints *constraints)
{
    if (constraints == NULL)
        return;
    LIST_FREE(constraints->rows);
    LIST_FREE(constraints->redundant_rows);
    LIST_FREE(constraints->dropped);
    LIST_FREE(constraints->multi_turns);
    LIST_FREE(constraints->counted);
    LIST_FREE(constraints->angles_off);
    LIST_FREE(constraints->drives);
    mem_free(constraints);
}

static void dynamics_free(Dynamics *dynamics)
{
    if (dynamics == NULL)
        return;
    LIST_FREE(dynamics->masses);
    LIST_FREE(dynamics->elastics);
    LIST_FREE(dynamics->shares);
    composite_mass_free(dynamics->composite_mass);
    mem_free(dynamics);
}

static void network_free(Network *network)
{
    if (network == NULL)
        return;
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        sign_matrix_free(network->cutsets[kind]);
    LIST_FREE(network->x);
    LIST_FREE(network->z);
    LIST_FREE(network->rates);
    LIST_FREE(network->ideals);
    LIST_FREE(network->branches);
    LIST_FREE(network->unknowns);
    LIST_FREE(network->unknown_of);
    LIST_FREE(network->rate_of);
    LIST_FREE(network->equations);
    LIST_FREE(network->samples);
    LIST_FREE(network->at_rest);
    LIST_FREE(network->invariants);
    LIST_FREE(network->open);
    network_isomorphic_free(network->alike);
    mem_free(network);
}

static void shown_free(Shown *shown)
{
    if (shown == NULL)
        return;
    for (int b = 0; b < BLOCK_COUNT; b++)
        mem_free(shown->entries[b]);
    MEM_FREE(shown->positions, shown->datum_axes, shown->turn_rates, shown->full_turns,
             shown->eliminated);
    LIST_FREE(shown->switches);
    LIST_FREE(shown->surfaces);
    mem_free(shown);
}

static void free_view(System *view)
{
    if (view->sided != NULL && view->sided != view && view->sided->network->closed == NULL)
        system_free(view->sided); /* otherwise it is one of the modes */
    for (int i = 0; i < view->modes.count; i++)
        system_free(view->modes.at[i]);
    system_free(view->numbered);
    LIST_FREE(view->modes);
    if (view->owns_formed)
        system_free(view->formed);
}

static void free_parts(System *system)
{
    LIST_FREE(system->remarks);
    network_free(system->network);
    dynamics_free(system->dynamics);
    constraints_free(system->constraints);
    kinematics_free(system->kinematics);
    origin_free(system->origin);
}

static void system_free_later(void *object)
{
    system_free(object);
}

void system_free(const System *system)
{
    System *own = (System *)system;

    if (system == NULL || mem_frees_later(own, system_free_later))
        return;
    if (system->formed != NULL)
        free_view(own);
    else
        free_parts(own);
    shown_free(own->shown);
    pool_free(own->pool);
    mem_free(own);
}
