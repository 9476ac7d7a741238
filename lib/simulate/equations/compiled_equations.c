/* compiled_equations.c: the recursive form compiled to numbers, in stages; compiled once more when
 * constraints are eliminated */
#include "simulate/equations/compiled_equations_impl.h"

#include <math.h>
#include <string.h>

/* nominal values of the entries of y; NULL: all 1 */
static double *units_of(const VariableIndex *layout)
{
    const int states = layout->n + layout->nu, count = variable_index_references(layout);
    double *unit = NULL;

    for (int i = 0; i < states; i++) {
        const double own = i < layout->n ? system_q(layout->system, i)->unit
                                         : system_u(layout->system, i - layout->n)->unit;

        if (own == 1)
            continue;
        if (unit == NULL) {
            unit = NEW_ARRAY(double, count + layout->multi_turns);
            for (int k = 0; k < count + layout->multi_turns; k++)
                unit[k] = 1;
        }
        unit[i] = own;
    }
    return unit;
}

/* Magnitude bounds of the entries of y: an angle counts as at most 1 in errors, however far it
 * turns. New. */
static double *magnitude_bounds_of(const VariableIndex *layout)
{
    const int states = variable_index_references(layout), count = states + layout->multi_turns;
    double *magnitude_bound = NEW_ARRAY(double, count);

    for (int i = 0; i < count; i++) {
        const bool is_angle =
            i >= states || (i < layout->n && system_q(layout->system, i)->is_angle);

        magnitude_bound[i] = is_angle ? 1 : INFINITY;
    }
    return magnitude_bound;
}

static void find_quaternions(CompiledEquations *nb)
{
    System *system = nb->layout->system;
    int count = 0;

    while (system_quaternion(system, count) >= 0)
        count++;
    nb->quaternions = NEW_ARRAY(int, count);
    for (int i = 0; i < count; i++)
        nb->quaternions[i] = system_quaternion(system, i);
    nb->eq.quaternions = nb->quaternions;
    nb->eq.quaternion_count = count;
}

/* Where this fails the equations are unchanged, except for what they may have eliminated before. */
static Status compile_constrained(CompiledEquations *nb, const Constrained *solved, const int *rows,
                                  int row_count, Diag *diag)
{
    Probe *before = nb->main;
    const EliminatedBy eliminated_by_before = nb->eliminated_by;
    Status status;

    mem_free(nb->eliminated_rows);
    nb->eliminated_rows = NEW_ARRAY(int, row_count);
    memcpy(nb->eliminated_rows, rows, (size_t)row_count * sizeof(int));
    nb->eliminated_by = ELIMINATED_CONSTRAINED;
    nb->eliminated = (Eliminated){
        .rows = nb->eliminated_rows, .row_count = row_count, .left_count = solved->left_count};
    nb->eliminated_places = solved->places;
    nb->eq.eliminated = NULL;
    compiled_end_rates(nb);
    status = nb->massing == NULL ? compiled_compile_mass(nb, diag) : OK;
    if (status == OK)
        status = compiled_compile_equations(nb, solved->acceleration, solved->places.count, diag);
    if (status == OK) {
        probe_free(before);
        workspace_foresee(nb->main->workspace, MOTION_FACTORS_PAID);
        status = compiled_rates(nb, solved, diag);
    } else {
        nb->eliminated_by = eliminated_by_before;
    }
    return status;
}

static bool is_of_rows(const Eliminated *own, const int *rows, int row_count)
{
    return own->row_count == row_count &&
           memcmp(own->rows, rows, (size_t)row_count * sizeof(int)) == 0;
}

static Status eliminate(void *context, const int *rows, int row_count, double most, Diag *diag)
{
    CompiledEquations *nb = context;
    Constrained *solved;
    bool before;
    Diag why = {0};
    Status status = OK;

    if (nb->eq.eliminated != NULL && is_of_rows(nb->eq.eliminated, rows, row_count))
        return OK;
    mem_keep(nb);
    before = mem_scratch(true);
    solved = elimination_of_rows(nb->layout, rows, row_count, most);
    if (solved != NULL)
        status = compile_constrained(nb, solved, rows, row_count, &why);
    if (solved == NULL || status != OK)
        nb->eq.eliminate = NULL;
    if (status == E_STOPPED && diag != NULL)
        *diag = why;
    status = status == E_STOPPED ? E_STOPPED : OK; /* the factorisation remains in use */
    constrained_free(solved);
    (void)mem_scratch(before);
    return status;
}

Status compiled_new(const VariableIndex *layout, Parameters *parameters, CompiledEquations **out,
                    Diag *diag)
{
    CompiledEquations *nb = NEW(CompiledEquations);
    Expr *accelerations = NULL;
    Status status = OK;

    nb->layout = layout;
    nb->parameters = parameters;
    nb->eq = (Equations){.n = layout->n,
                         .nu = layout->nu,
                         .m = layout->m,
                         .position_rows = layout->position_rows,
                         .nx = layout->nx,
                         .nz = layout->nz,
                         .multi_turn_count = layout->multi_turns,
                         .sides = &layout->sides};
    compiled_connect(nb);
    find_quaternions(nb);
    nb->eq.magnitude_bound = nb->magnitude_bound = magnitude_bounds_of(layout);
    nb->eq.unit = nb->unit = units_of(layout);
    parameters_begin_turns(parameters, layout->system);
    nb->mass = mass_matrix_new(layout->system);
    CHECK(elimination_choose(layout, &nb->eliminated_by, &accelerations, diag));
    if (layout->m == 0 && nb->mass != NULL && nb->eliminated_by == ELIMINATED_NOT)
        nb->articulated = articulated_new(layout->system);
    if (layout->m > 0 && nb->eliminated_by == ELIMINATED_NOT)
        nb->eq.eliminate = eliminate;
    CHECK(compiled_compile_equations(
        nb, accelerations, nb->eliminated_by != ELIMINATED_NOT ? 2 * layout->nu : 0, diag));
    CHECK(compiled_compile_mass(nb, diag));
    CHECK(compiled_watch(nb, parameters, diag));
    *out = nb;
    nb = NULL;
done:
    mem_free(accelerations);
    compiled_free(nb);
    return status;
}

void compiled_free(CompiledEquations *nb)
{
    if (nb == NULL)
        return;
    probe_free(nb->main);
    probe_free(nb->network);
    probe_free(nb->switching);
    probe_free(nb->massing);
    probe_free(nb->rates);
    mass_matrix_free(nb->mass);
    articulated_free(nb->articulated);
    pattern_free(&nb->rows);
    pattern_free(&nb->masses);
    pattern_free(&nb->maps);
    LIST_FREE(nb->margins);
    mem_free(nb->quaternions);
    mem_free(nb->network_places);
    MEM_FREE(nb->magnitude_bound, nb->unit);
    probe_free(nb->slip);
    MEM_FREE(nb->guards, nb->shown_guards, nb->of_surface, nb->sign_ranges, nb->eliminated_rows,
             nb);
}

const Program *compiled_program(const CompiledEquations *nb, CompiledPart part)
{
    const Probe *const parts[] = {nb->main, nb->network, nb->switching,
                                  nb->slip, nb->massing, nb->rates};

    return parts[part] != NULL ? residual_program(probe_residual(parts[part])) : NULL;
}

void compiled_set(CompiledEquations *nb, Expr parameter, double value)
{
    Probe *const probes[] = {nb->main, nb->switching, nb->network,
                             nb->slip, nb->massing,   nb->rates};

    for (int i = 0; i < COUNT(probes); i++)
        if (probes[i] != NULL)
            (void)probe_turn(probes[i], parameter, value);
    nb->is_mass_kept = false;
}

const Equations *compiled_equations(const CompiledEquations *nb)
{
    return &nb->eq;
}
