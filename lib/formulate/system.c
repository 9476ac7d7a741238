/* system.c: what a System is told of: sizes, variables, entries; and its end */
#include "formulate/system_impl.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *system_keep(System *system, const char *format, ...)
{
    char text[600];
    va_list args;

    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return pool_text(system->pool, text, strlen(text));
}

static void system_free_later(void *object)
{
    system_free(object);
}

void system_free(System *system)
{
    if (system == NULL || mem_frees_later(system, system_free_later))
        return;
    if (system->sided != NULL && system->sided != system && system->sided->closed == NULL)
        system_free(system->sided); /* else it is one of the modes */
    for (int i = 0; i < system->modes.count; i++)
        system_free(system->modes.at[i]);
    LIST_FREE(system->modes);
    LIST_FREE(system->ideals);
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++) {
        tree_free(system->trees[kind]);
        sign_matrix_free(system->cutsets[kind]);
    }
    graph_free(system->graph);
    names_free(system->instance_names);
    names_free(system->coordinate_names);
    LIST_FREE(system->coordinate_owners);
    LIST_FREE(system->q);
    LIST_FREE(system->u);
    LIST_FREE(system->x);
    LIST_FREE(system->z);
    LIST_FREE(system->rates);
    LIST_FREE(system->quaternions);
    LIST_FREE(system->chains);
    LIST_FREE(system->masses);
    LIST_FREE(system->turned);
    LIST_FREE(system->counted);
    LIST_FREE(system->angles_off);
    LIST_FREE(system->rows);
    LIST_FREE(system->vanished);
    LIST_FREE(system->parameters);
    LIST_FREE(system->dropped);
    LIST_FREE(system->remarks);
    LIST_FREE(system->branches);
    LIST_FREE(system->unknowns);
    LIST_FREE(system->unknown_of);
    LIST_FREE(system->rate_of);
    LIST_FREE(system->samples);
    LIST_FREE(system->at_rest);
    LIST_FREE(system->invariants);
    LIST_FREE(system->network_shown);
    LIST_FREE(system->drives);
    LIST_FREE(system->switches);
    LIST_FREE(system->surfaces);
    pool_free(system->pool);
    mem_free(system);
}

/* --- looking --- */

uint64_t system_revision(const System *system)
{
    return system->revision;
}

const char *system_instance_name(const System *system, int instance)
{
    return system->instances[instance].name;
}

Arena *system_arena(const System *system)
{
    return system->arena;
}

int system_n(const System *system)
{
    return system->q.count;
}

int system_nu(const System *system)
{
    return system->u.count;
}

int system_m(const System *system)
{
    return system->rows.count;
}

int system_nx(const System *system)
{
    return system->x.count;
}

int system_nz(const System *system)
{
    return system->z.count;
}

const Variable *system_q(const System *system, int i)
{
    return &system->q.at[i];
}

const Variable *system_u(const System *system, int i)
{
    return &system->u.at[i];
}

const Variable *system_x(const System *system, int i)
{
    return &system->x.at[i];
}

const Variable *system_z(const System *system, int i)
{
    return &system->z.at[i];
}

Expr system_acceleration(const System *system, int i)
{
    return system->accelerations[i];
}

Expr system_multiplier(const System *system, int k)
{
    return system->multipliers[k];
}

Expr system_state_rate(const System *system, int i)
{
    return system->rates.at[i];
}

Expr system_q_rate(const System *system, int i)
{
    return system->run.q_rate[i];
}

Expr system_n_entry(const System *system, int i, int j)
{
    const CoordinateRate *rate = &system->coordinate_rates[i];

    for (int k = 0; k < rate->count; k++)
        if (rate->speed[k] == j)
            return rate->entry[k];
    return expr_int(system->arena, 0);
}

int system_quaternion(const System *system, int i)
{
    return i < system->quaternions.count ? system->quaternions.at[i] : -1;
}

const ConstraintRow *system_constraint(const System *system, int k)
{
    return &system->rows.at[k].told;
}

const char *system_dropped(const System *system, int i)
{
    return i < system->dropped.count ? system->dropped.at[i] : NULL;
}

const char *system_remark(const System *system, int i)
{
    return i < system->remarks.count ? system->remarks.at[i] : NULL;
}

const Reading *system_definitions(const System *system)
{
    return &system->definitions;
}

const Reading *system_run(const System *system)
{
    return &system->run;
}

Expr system_network_entry(const System *system, int row, int column)
{
    for (int i = 0; i < system->run.network_entries; i++)
        if (system->run.network[i].row == row && system->run.network[i].column == column)
            return system->run.network[i].value;
    return expr_int(system->arena, 0);
}

Expr *system_network_matrix(const System *system)
{
    int count = system->x.count + system->z.count;
    Expr *dense = NEW_ARRAY(Expr, count * count);

    for (int i = 0; i < count * count; i++)
        dense[i] = expr_int(system->arena, 0);
    for (int i = 0; i < system->run.network_entries; i++)
        dense[system->run.network[i].row * count + system->run.network[i].column] =
            system->run.network[i].value;
    return dense;
}

bool system_tree_is_normal(const System *system)
{
    return !system->leaves_trees;
}

NetworkForm system_network_form(const System *system)
{
    return system->asked_form;
}

const char *system_at_rest(const System *system, int i)
{
    return i < system->at_rest.count ? system->at_rest.at[i] : NULL;
}

Expr system_invariant(const System *system, int i)
{
    return i < system->invariants.count ? system->invariants.at[i] : NULL;
}

const OwnSample *system_sample(const System *system, int i)
{
    return i < system->samples.count ? &system->samples.at[i] : NULL;
}

int system_network_count(const System *system)
{
    return system->network_shown.count;
}

void system_network_equation(System *system, int i, Expr *left, Expr *right)
{
    mem_keep(system);
    *left = system->network_shown.at[i].left;
    *right = system->network_shown.at[i].right;
}

int system_network_edge(const System *system, int i)
{
    return system->network_shown.at[i].edge;
}

int system_drive_count(const System *system)
{
    return system->drives.count;
}

const Drive *system_drive(const System *system, int i)
{
    return &system->drives.at[i];
}
