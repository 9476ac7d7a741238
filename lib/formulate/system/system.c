/* system.c: queries of a System: sizes, variables, entries */
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *system_join(const System *system, const char *one, const char *other)
{
    char *text = pool_alloc(system->pool, strlen(one) + strlen(other) + 1);

    (void)stpcpy(stpcpy(text, one), other);
    return text;
}

const char *system_retain(const System *system, const char *format, ...)
{
    char text[600];
    va_list args;

    va_start(args, format);
    (void)vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return pool_text(system->pool, text, strlen(text));
}

void system_set_watch(System *system, const CallMonitor *watch)
{
    system->watch = watch;
}

uint64_t system_revision(const System *system)
{
    return system->origin->revision;
}

const char *system_instance_name(const System *system, int instance)
{
    return system->origin->instances[instance].name;
}

Arena *system_arena(const System *system)
{
    return system->arena;
}

int system_n(const System *system)
{
    return system->kinematics->q.count;
}

int system_nu(const System *system)
{
    return system->kinematics->u.count;
}

int system_m(const System *system)
{
    return system->constraints->rows.count;
}

int system_position_rows(const System *system)
{
    int count = system->constraints->rows.count;

    while (count > 0 && system->constraints->rows.at[count - 1].reported.is_rate)
        count--;
    return count;
}

int system_nx(const System *system)
{
    return system->network->x.count;
}

int system_nz(const System *system)
{
    return system->network->z.count;
}

const Variable *system_q(const System *system, int i)
{
    return &system->kinematics->q.at[i];
}

const Variable *system_u(const System *system, int i)
{
    return &system->kinematics->u.at[i];
}

const Variable *system_x(const System *system, int i)
{
    return &system->network->x.at[i];
}

const Variable *system_z(const System *system, int i)
{
    return &system->network->z.at[i];
}

Expr system_acceleration(const System *system, int i)
{
    return system->kinematics->accelerations[i];
}

Expr system_multiplier(const System *system, int k)
{
    return system->constraints->multipliers[k];
}

Expr system_state_rate(const System *system, int i)
{
    return system->network->rates.at[i];
}

int system_n_row(const System *system, int i, const int **speeds, const Expr **entries)
{
    const CoordinateRate *rate = &system->kinematics->coordinate_rates[i];

    *speeds = rate->speed;
    *entries = rate->entry;
    return rate->count;
}

Expr system_q_rate(const System *system, int i)
{
    return system->run.q_rate[i];
}

Expr system_n_entry(const System *system, int i, int j)
{
    const CoordinateRate *rate = &system->kinematics->coordinate_rates[i];

    for (int k = 0; k < rate->count; k++)
        if (rate->speed[k] == j)
            return rate->entry[k];
    return expr_int(system->arena, 0);
}

int system_quaternion(const System *system, int i)
{
    return i < system->kinematics->quaternions.count ? system->kinematics->quaternions.at[i] : -1;
}

const Instanced *system_instanced(const System *system, int i)
{
    return i < system->origin->use_count ? &system->origin->uses[i] : NULL;
}

const ConstraintRow *system_constraint(const System *system, int k)
{
    return &system->constraints->rows.at[k].reported;
}

const char *system_dropped(const System *system, int i)
{
    return i < system->constraints->dropped.count ? system->constraints->dropped.at[i] : NULL;
}

const char *system_remark(const System *system, int i)
{
    return i < system->remarks.count ? system->remarks.at[i] : NULL;
}

const EquationForm *system_definitions(const System *system)
{
    return &system->definitions;
}

const EquationForm *system_run(const System *system)
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
    int count = system->network->x.count + system->network->z.count;
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
    return !system->network->leaves_trees;
}

NetworkForm system_network_form(const System *system)
{
    return system->network->asked_form;
}

const char *system_at_rest(const System *system, int i)
{
    return i < system->network->at_rest.count ? system->network->at_rest.at[i] : NULL;
}

Expr system_invariant(const System *system, int i)
{
    return i < system->network->invariants.count ? system->network->invariants.at[i] : NULL;
}

const OwnSample *system_sample(const System *system, int i)
{
    return i < system->network->samples.count ? &system->network->samples.at[i] : NULL;
}

int system_network_count(const System *system)
{
    return system->network->equations.count;
}

void system_network_equation(const System *system, int i, Expr *left, Expr *right)
{
    *left = system->network->equations.at[i].left;
    *right = system->network->equations.at[i].right;
}

int system_network_edge(const System *system, int i)
{
    return system->network->equations.at[i].edge;
}

Expr system_open_potential(const System *system, int i)
{
    return i < system->network->open.count ? system->network->open.at[i] : NULL;
}

int system_drive_count(const System *system)
{
    return system->constraints->drives.count;
}

const Drive *system_drive(const System *system, int i)
{
    return &system->constraints->drives.at[i];
}
