/* compiled_compile.c: which expressions a program of the equations computes, and the index of each
 * block */
#include "simulate/equations/compiled_equations_impl.h"

#include <string.h>

/* multi-turn angles, then their rates */
static Status push_multi_turns(CompiledRoots *roots, System *system, Diag *diag)
{
    Status status = OK;

    for (int i = 0; i < system_multi_turn_count(system); i++)
        LIST_PUSH(*roots, system_multi_turn(system, i)->angle);
    for (int i = 0; i < system_multi_turn_count(system); i++) {
        Expr rate;

        CHECK(system_multi_turn_rate(system, i, &rate, diag));
        LIST_PUSH(*roots, rate);
    }
done:
    return status;
}

/* append a block; returns its first index */
static int block(CompiledRoots *roots, const Expr *entries, int count)
{
    int first = roots->count;

    if (count == 0)
        return first;
    LIST_ROOM(*roots, count);
    memcpy(roots->at + first, entries, (size_t)count * sizeof(Expr));
    roots->count += count;
    return first;
}

/* the same, on the layout's sides of its surfaces */
static int block_on(const VariableIndex *l, CompiledRoots *roots, const Expr *entries, int count)
{
    int first = roots->count;

    for (int i = 0; i < count; i++)
        LIST_PUSH(*roots, variable_index_on_surfaces(l, entries[i]));
    return first;
}

/* positions of the entries of A, and the latest stage of what the network's equations contain */
static Stage network_shape(CompiledEquations *nb)
{
    const EquationForm *r = system_run(nb->layout->system);
    Stage stage = STAGE_PARAMETER;

    mem_free(nb->network_places);
    nb->network_places = NEW_ARRAY(int, 2 * r->network_entries);
    nb->eq.network_entries = r->network_entries;
    nb->eq.network_row = nb->network_places;
    nb->eq.network_column = nb->network_places + r->network_entries;
    nb->eq.network_is_constant = true;
    for (int i = 0; i < r->network_entries; i++) {
        nb->network_places[i] = r->network[i].row;
        nb->network_places[r->network_entries + i] = r->network[i].column;
        if (stage_of(variable_index_on_surfaces(nb->layout, r->network[i].value)) > STAGE_PARAMETER)
            nb->eq.network_is_constant = false;
        if (stage_of(r->network[i].value) > stage)
            stage = stage_of(r->network[i].value);
    }
    for (int i = 0; i < nb->layout->nx + nb->layout->nz; i++)
        if (stage_of(r->network_rhs[i]) > stage)
            stage = stage_of(r->network_rhs[i]);
    return stage;
}

static int network_block(const VariableIndex *l, CompiledRoots *roots)
{
    const EquationForm *r = system_run(l->system);
    int first = roots->count;

    for (int i = 0; i < r->network_entries; i++)
        LIST_PUSH(*roots, variable_index_on_surfaces(l, r->network[i].value));
    return first;
}

/* equations that are solved by iteration have a program of their own */
static Status compile_network(CompiledEquations *nb, Diag *diag)
{
    const VariableIndex *l = nb->layout;
    const EquationForm *r = system_run(l->system);
    CompiledRoots roots = {0};
    int network = network_block(l, &roots);
    int residual = block_on(l, &roots, r->network_residual, l->nx + l->nz);
    Status status = OK;

    CHECK(compiled_compile(l, nb->parameters, &roots, &nb->network, diag));
    nb->eq.network = workspace_roots(nb->network->workspace) + network;
    nb->eq.network_residual = workspace_roots(nb->network->workspace) + residual;
    compiled_connect_network(nb);
done:
    LIST_FREE(roots);
    return status;
}

/* Append the entries that aren't 0, row by row. Records their positions in the transpose. */
static int stored_block(CompiledRoots *roots, const Expr *entries, int rows, int columns,
                        Pattern *out)
{
    int first = roots->count, count = 0, *place;
    int *row, *column;

    pattern_free(out);
    for (int i = 0; i < rows * columns; i++)
        if (!expr_is_zero(entries[i]))
            LIST_PUSH(*roots, entries[i]);
    count = roots->count - first;
    place = NEW_ARRAY(int, 3 * count);
    row = place + count;
    column = row + count;
    for (int i = 0, k = 0; i < rows * columns; i++)
        if (!expr_is_zero(entries[i])) {
            row[k] = i / columns;
            column[k++] = i % columns;
        }
    *out = pattern_of(columns, rows, count, column, row, place);
    mem_free(place);
    return first;
}

/* Append the entries of N that may not be 0, row by row, speeds ascending, which is their storage
 * order. */
static void map_block(CompiledEquations *nb, CompiledRoots *roots)
{
    const VariableIndex *l = nb->layout;
    LIST(int) rows = {0};
    LIST(int) columns = {0};
    int *place;

    for (int i = 0; i < l->n; i++) {
        const int *speed;
        const Expr *entry;
        const int count = system_n_row(l->system, i, &speed, &entry);

        for (int k = 0; k < count; k++) {
            LIST_PUSH(*roots, entry[k]);
            LIST_PUSH(rows, speed[k]);
            LIST_PUSH(columns, i);
        }
    }
    place = NEW_ARRAY(int, rows.count);
    pattern_free(&nb->maps); /* of equations that were compiled before */
    nb->maps = pattern_of(l->nu, l->n, rows.count, rows.at, columns.at, place);
    LIST_FREE(rows);
    LIST_FREE(columns);
    mem_free(place);
}

/* whether the entries are known in that stage */
static bool are_known_by(Stage stage, const Expr *entries, int count)
{
    for (int i = 0; i < count; i++)
        if (stage_of(entries[i]) > stage)
            return false;
    return true;
}

/* M, or the expressions that it is computed from */
static int mass_block(CompiledEquations *nb, CompiledRoots *roots)
{
    const int nu = nb->layout->nu;
    int count;
    const Expr *needs;

    if (nb->mass == NULL) {
        nb->is_mass_constant =
            are_known_by(STAGE_PARAMETER, system_run(nb->layout->system)->mass, nu * nu);
        return stored_block(roots, system_run(nb->layout->system)->mass, nu, nu, &nb->masses);
    }
    needs = nb->articulated != NULL ? articulated_needs(nb->articulated, &count)
                                    : mass_matrix_needs(nb->mass, &count);
    nb->is_mass_constant = are_known_by(STAGE_PARAMETER, needs, count);
    return block(roots, needs, count);
}

Status compiled_compile_mass(CompiledEquations *nb, Diag *diag)
{
    const VariableIndex *l = nb->layout;
    CompiledRoots roots = {0};
    const Expr *needs;
    int count, force;
    Status status = OK;

    if (nb->articulated == NULL && !compiled_need_no_mass(nb))
        return OK;
    if (nb->mass != NULL) {
        needs = mass_matrix_needs(nb->mass, &count);
        (void)block(&roots, needs, count);
        nb->is_mass_constant = are_known_by(STAGE_PARAMETER, needs, count);
    } else {
        (void)mass_block(nb, &roots);
    }
    force =
        block_on(l, &roots, system_run(l->system)->force, compiled_need_no_mass(nb) ? l->nu : 0);
    CHECK(compiled_compile(l, nb->parameters, &roots, &nb->massing, diag));
    if (compiled_need_no_mass(nb))
        nb->eq.force = workspace_roots(nb->massing->workspace) + force;
    if (nb->mass == NULL)
        nb->eq.mass = workspace_roots(nb->massing->workspace);
    compiled_connect_mass(nb);
done:
    LIST_FREE(roots);
    return status;
}

/* first index of each block among the roots of the main program */
typedef struct CompiledBlocks {
    int phi, phi_u, mass, nu_rate, gamma, q_rate, network, rhs, force, eliminated_symbols, work,
        angles;
    int map; /* -1: none, as where q' = u */
} CompiledBlocks;

/* `iterates`: the network's equations have a program of their own */
static Status push_equations(CompiledEquations *nb, bool iterates, const Expr *eliminated_symbols,
                             int eliminated_count, CompiledRoots *roots, CompiledBlocks *p,
                             Diag *diag)
{
    const VariableIndex *l = nb->layout;
    const EquationForm *r = system_run(l->system);
    Expr power = system_power(l->system);

    p->phi = block(roots, r->phi, l->m);
    p->phi_u = stored_block(roots, r->phi_u, l->m, l->nu, &nb->rows);
    p->mass = compiled_need_no_mass(nb) ? 0 : mass_block(nb, roots);
    p->nu_rate = block(roots, r->nu, l->m);
    p->gamma = block_on(l, roots, r->gamma, l->m);
    p->q_rate = block(roots, r->q_rate, l->n);
    p->network = iterates ? 0 : network_block(l, roots);
    p->rhs = block_on(l, roots, r->network_rhs, iterates ? 0 : l->nx + l->nz);
    p->force = block_on(l, roots, r->force, compiled_need_no_mass(nb) ? 0 : l->nu);
    p->eliminated_symbols = block(roots, eliminated_symbols, eliminated_count);
    p->work = block_on(l, roots, &power, 1);
    p->angles = roots->count;
    TRY(push_multi_turns(roots, l->system, diag));
    p->map = roots->count;
    if (!compiled_speeds_are_rates(l->system))
        map_block(nb, roots);
    if (p->map == roots->count)
        p->map = -1;
    return OK;
}

/* Point the equations to the values that the main program computes. */
static void place_equations(CompiledEquations *nb, bool iterates, const CompiledBlocks *p)
{
    const VariableIndex *l = nb->layout;
    const double *at = workspace_roots(nb->main->workspace);
    Equations *eq = &nb->eq;

    eq->phi = at + p->phi;
    eq->phi_u = at + p->phi_u;
    eq->rows = &nb->rows;
    nb->mass_needs = p->mass;
    eq->masses = nb->mass != NULL ? mass_matrix_places(nb->mass) : &nb->masses;
    if (nb->mass != NULL)
        eq->mass = mass_matrix_at(nb->mass);
    else if (!compiled_need_no_mass(nb))
        eq->mass = at + p->mass;
    eq->nu_rate = at + p->nu_rate;
    eq->has_nu_early = are_known_by(STAGE_POSITION, system_run(l->system)->nu, l->m);
    eq->gamma = at + p->gamma;
    eq->q_rate = at + p->q_rate;
    if (!iterates) {
        eq->network = at + p->network;
        eq->network_rhs = at + p->rhs;
    }
    if (!compiled_need_no_mass(nb))
        eq->force = at + p->force;
    nb->eliminated_accelerations = at + p->eliminated_symbols;
    eq->power = at + p->work;
    eq->multi_turn = at + p->angles;
    eq->multi_turn_rate = at + p->angles + l->multi_turns;
    eq->map = p->map >= 0 ? at + p->map : NULL;
    eq->maps = &nb->maps;
}

Status compiled_compile_equations(CompiledEquations *nb, const Expr *eliminated_symbols,
                                  int eliminated_count, Diag *diag)
{
    const Stage stage = network_shape(nb);
    const bool iterates =
        system_run(nb->layout->system)->network_nonlinear || stage > STAGE_VELOCITY;
    CompiledRoots roots = {0};
    CompiledBlocks blocks;
    Status status = OK;

    CHECK(
        push_equations(nb, iterates, eliminated_symbols, eliminated_count, &roots, &blocks, diag));
    CHECK(compiled_compile(nb->layout, nb->parameters, &roots, &nb->main, diag));
    place_equations(nb, iterates, &blocks);
    compiled_connect_equations(nb, stage, stage_of(system_power(nb->layout->system)));
    if (iterates && nb->network == NULL)
        CHECK(compile_network(nb, diag));
done:
    LIST_FREE(roots);
    return status;
}
