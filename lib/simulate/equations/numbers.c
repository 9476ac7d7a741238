/* numbers.c: the recursive form in numbers, compiled in stages, and once more with constraints
 * eliminated */
#include "simulate/equations/numbers_impl.h"

#include <math.h>
#include <string.h>

/* of the entries of y; NULL: all 1 */
static double *units_of(const Layout *layout)
{
    const int states = layout->n + layout->nu, count = layout_references(layout);
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

/* of the entries of y: angles count to 1 in errors, however far they turn; new */
static double *caps_of(const Layout *layout)
{
    const int states = layout_references(layout), count = states + layout->multi_turns;
    double *cap = NEW_ARRAY(double, count);

    for (int i = 0; i < count; i++) {
        const bool is_angle =
            i >= states || (i < layout->n && system_q(layout->system, i)->is_angle);

        cap[i] = is_angle ? 1 : INFINITY;
    }
    return cap;
}

static void find_quaternions(Numbers *nb)
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

/* Where this fails the equations are as they were, but for what they may have eliminated before. */
static Status compile_constrained(Numbers *nb, const Constrained *solved, const int *rows,
                                  int row_count, Diag *diag)
{
    Probe *before = nb->main;
    const Told told_before = nb->told_by;
    Status status;

    mem_free(nb->told_rows);
    nb->told_rows = NEW_ARRAY(int, row_count);
    memcpy(nb->told_rows, rows, (size_t)row_count * sizeof(int));
    nb->told_by = TOLD_CONSTRAINED;
    nb->eliminated = (Eliminated){
        .rows = nb->told_rows, .row_count = row_count, .left_count = solved->left_count};
    nb->told_places = solved->places;
    nb->eq.eliminated = NULL;
    numbers_end_rates(nb);
    status = nb->massing == NULL ? numbers_compile_mass(nb, diag) : OK;
    if (status == OK)
        status = numbers_compile_equations(nb, solved->acceleration, solved->places.count, diag);
    if (status == OK) {
        probe_free(before);
        workspace_foresee(nb->main->workspace, MOTION_FACTORS_PAID);
        status = numbers_rates(nb, solved, diag);
    } else {
        nb->told_by = told_before;
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
    Numbers *nb = context;
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
    status = status == E_STOPPED ? E_STOPPED : OK; /* factors serve as they did */
    constrained_free(solved);
    (void)mem_scratch(before);
    return status;
}

Status numbers_new(const Layout *layout, Parameters *parameters, Numbers **out, Diag *diag)
{
    Numbers *nb = NEW(Numbers);
    Expr *accelerations = NULL;
    Status status = OK;

    nb->layout = layout;
    nb->parameters = parameters;
    nb->eq = (Equations){.n = layout->n,
                         .nu = layout->nu,
                         .m = layout->m,
                         .nx = layout->nx,
                         .nz = layout->nz,
                         .multi_turn_count = layout->multi_turns,
                         .sides = &layout->sides};
    numbers_connect(nb);
    find_quaternions(nb);
    nb->eq.cap = nb->cap = caps_of(layout);
    nb->eq.unit = nb->unit = units_of(layout);
    parameters_begin_turns(parameters, layout->system);
    nb->mass = mass_matrix_new(layout->system);
    CHECK(elimination_choose(layout, &nb->told_by, &accelerations, diag));
    if (layout->m == 0 && nb->mass != NULL && nb->told_by == TOLD_NOT)
        nb->articulated = articulated_new(layout->system);
    if (layout->m > 0 && nb->told_by == TOLD_NOT)
        nb->eq.eliminate = eliminate;
    CHECK(numbers_compile_equations(nb, accelerations, nb->told_by != TOLD_NOT ? 2 * layout->nu : 0,
                                    diag));
    CHECK(numbers_compile_mass(nb, diag));
    CHECK(numbers_watch(nb, parameters, diag));
    CHECK(numbers_slide(nb, parameters, diag));
    *out = nb;
    nb = NULL;
done:
    mem_free(accelerations);
    numbers_free(nb);
    return status;
}

void numbers_free(Numbers *nb)
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
    MEM_FREE(nb->cap, nb->unit);
    probe_free(nb->slip);
    MEM_FREE(nb->guards, nb->told, nb->told_rows, nb);
}

const Program *numbers_program(const Numbers *nb, NumbersPart part)
{
    const Probe *const parts[] = {nb->main, nb->network, nb->switching,
                                  nb->slip, nb->massing, nb->rates};

    return parts[part] != NULL ? residual_program(probe_residual(parts[part])) : NULL;
}

void numbers_set(Numbers *nb, Expr parameter, double value)
{
    Probe *const probes[] = {nb->main, nb->switching, nb->network,
                             nb->slip, nb->massing,   nb->rates};

    for (int i = 0; i < COUNT(probes); i++)
        if (probes[i] != NULL)
            (void)probe_turn(probes[i], parameter, value);
    nb->is_mass_kept = false;
}

const Equations *numbers_equations(const Numbers *nb)
{
    return &nb->eq;
}
