/* numbers.c: the recursive form, compiled in stages */
#include "simulate/equations/numbers_impl.h"

#include <math.h>
#include <string.h>

static void take_references(void *context, const double *references)
{
    Numbers *nb = context;

    inputs_put(probe_inputs(nb->main), nb->layout->references, references, nb->layout->multi_turns);
}

static void position(void *context, double t, const double *q)
{
    Numbers *nb = context;
    double *inputs = probe_inputs(nb->main);

    inputs[nb->layout->t] = t;
    inputs_put(inputs, nb->layout->q, q, nb->layout->n);
    workspace_run(nb->main->workspace, STAGE_TIME, STAGE_POSITION);
    nb->is_mass_old = true;
    if (nb->articulated != NULL)
        nb->is_articulated = articulated_factor(
            nb->articulated, workspace_roots(nb->main->workspace) + nb->mass_needs);
    else if (nb->mass != NULL && nb->massing == NULL && !nb->is_mass_kept) {
        mass_matrix_put(nb->mass, workspace_roots(nb->main->workspace) + nb->mass_needs);
        nb->is_mass_kept = nb->is_mass_constant;
    }
}

static bool articulate(void *context, double *acceleration)
{
    Numbers *nb = context;

    if (nb->is_articulated)
        articulated_solve(nb->articulated, nb->eq.force, acceleration);
    return nb->is_articulated;
}

/* what the program has eliminated itself */
static bool tell_accelerations(void *context, double *acceleration)
{
    const Numbers *nb = context;

    if (!numbers_have_pivots(nb->told_accelerations + nb->layout->nu, nb->layout->nu))
        return false;
    memcpy(acceleration, nb->told_accelerations, (size_t)nb->layout->nu * sizeof(double));
    return true;
}

/* q and u stand one behind the other, in y as in the inputs */
static bool outright(void *context, double t, const double *y, double *out)
{
    Numbers *nb = context;
    const Layout *l = nb->layout;
    double *inputs = probe_inputs(nb->main);

    inputs[l->t] = t;
    memcpy(inputs + l->q, y, (size_t)(l->n + l->nu) * sizeof(double));
    workspace_run_joined(nb->main->workspace);
    memcpy(out, nb->eq.q_rate, (size_t)l->n * sizeof(double));
    out[l->n + l->nu] = *nb->eq.power;
    return tell_accelerations(nb, out + l->n);
}

/* M and F are brought from a program of their own when somebody asks for them */
static bool needs_no_mass(const Numbers *nb)
{
    return nb->told_by == TOLD_ALONG || nb->told_by == TOLD_CONSTRAINED ||
           nb->told_by == TOLD_PRESCRIBED;
}

static bool may_be_outright(const Numbers *nb)
{
    const Layout *l = nb->layout;

    return nb->eq.without_mass == tell_accelerations && (nb->mass == NULL || needs_no_mass(nb)) &&
           l->nx + l->nz == 0 && l->multi_turns == 0 && nb->eq.accelerated == NULL;
}

/* likewise where all is prescribed */
static void tell_prescribed(void *context, double *acceleration, double *multiplier)
{
    const Numbers *nb = context;
    const size_t size = (size_t)nb->layout->nu * sizeof(double);

    memcpy(acceleration, nb->told_accelerations, size);
    memcpy(multiplier, nb->told_accelerations + nb->layout->nu, size);
}

/* likewise with multipliers of rows in use */
static bool constrained_has_pivots(void *context)
{
    const Numbers *nb = context;

    return numbers_have_pivots(nb->told_excess, nb->layout->nu);
}

static void constrained_step(void *context, const double *bottom, double *du)
{
    Numbers *nb = context;
    double *asked = probe_inputs(nb->main) + nb->layout->multipliers;

    for (int k = 0; k < nb->eliminated.row_count; k++)
        asked[nb->eliminated.rows[k]] = bottom[k];
    workspace_run(nb->main->workspace, STAGE_ACCELERATION, STAGE_ACCELERATION);
    memcpy(du, nb->told_step, (size_t)nb->layout->nu * sizeof(double));
}

static void bring_mass(void *context)
{
    Numbers *nb = context;

    if (!nb->is_mass_old || nb->is_mass_kept)
        return;
    memcpy(probe_inputs(nb->massing), probe_inputs(nb->main),
           (size_t)nb->layout->count * sizeof(double));
    workspace_run(nb->massing->workspace, STAGE_TIME, STAGE_POSITION);
    if (nb->mass != NULL)
        mass_matrix_put(nb->mass, workspace_roots(nb->massing->workspace));
    nb->is_mass_old = false;
    nb->is_mass_kept = nb->is_mass_constant;
}

static void bring_force(void *context)
{
    Numbers *nb = context;

    memcpy(probe_inputs(nb->massing), probe_inputs(nb->main),
           (size_t)nb->layout->count * sizeof(double));
    workspace_run(nb->massing->workspace, STAGE_TIME, STAGE_NETWORK);
}

static void velocity(void *context, const double *u, const double *x)
{
    Numbers *nb = context;
    double *inputs = probe_inputs(nb->main);

    inputs_put(inputs, nb->layout->u, u, nb->layout->nu);
    inputs_put(inputs, nb->layout->x, x, nb->layout->nx);
    workspace_run(nb->main->workspace, STAGE_VELOCITY, STAGE_VELOCITY);
    nb->is_network_new = true;
}

static void copy_inputs(Numbers *nb, int first, int count)
{
    memcpy(probe_inputs(nb->network) + first, probe_inputs(nb->main) + first,
           (size_t)count * sizeof(double));
}

static void network_at(void *context, const double *w)
{
    Numbers *nb = context;
    const Layout *l = nb->layout;
    double *inputs = probe_inputs(nb->network);

    inputs_put(inputs, l->rates, w, l->nx);
    inputs_put(inputs, l->z, w + l->nx, l->nz);
    if (nb->is_network_new)
        copy_inputs(nb, l->t, l->rates - l->t);
    workspace_run(nb->network->workspace, nb->is_network_new ? STAGE_TIME : STAGE_NETWORK,
                  STAGE_ACCELERATION);
    nb->is_network_new = false;
}

static void network_rounding(void *context, double *out)
{
    Numbers *nb = context;
    const int first = (int)(nb->eq.network_residual - workspace_roots(nb->network->workspace));
    const int count = nb->layout->nx + nb->layout->nz;
    double *errors = NEW_ARRAY(double, first + count);

    probe_errors(nb->network, &(RowValues){0}, errors);
    memcpy(out, errors + first, (size_t)count * sizeof(double));
    mem_free(errors);
}

static void network_reads(void *context, const double *acceleration, const double *multipliers)
{
    Numbers *nb = context;
    double *inputs = probe_inputs(nb->network);

    inputs_put(inputs, nb->layout->acceleration, acceleration, nb->layout->nu);
    inputs_put(inputs, nb->layout->multipliers, multipliers, nb->layout->m);
}

static void network_solved(void *context, const double *solved)
{
    Numbers *nb = context;
    double *inputs = probe_inputs(nb->main);

    inputs_put(inputs, nb->layout->rates, solved, nb->layout->nx);
    inputs_put(inputs, nb->layout->z, solved + nb->layout->nx, nb->layout->nz);
}

static void loads(void *context)
{
    Numbers *nb = context;

    workspace_run(nb->main->workspace, STAGE_NETWORK, STAGE_NETWORK);
}

static void accelerated(void *context, const double *acceleration, const double *multipliers)
{
    Numbers *nb = context;
    double *inputs = probe_inputs(nb->main);

    inputs_put(inputs, nb->layout->acceleration, acceleration, nb->layout->nu);
    inputs_put(inputs, nb->layout->multipliers, multipliers, nb->layout->m);
    workspace_run(nb->main->workspace, STAGE_ACCELERATION, STAGE_ACCELERATION);
}

/* angles that count turns, then their rates */
static Status push_multi_turns(Roots *roots, System *system, Diag *diag)
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

/* append a block; its first place */
static int block(Roots *roots, const Expr *entries, int count)
{
    int first = roots->count;

    if (count == 0)
        return first;
    LIST_ROOM(*roots, count);
    memcpy(roots->at + first, entries, (size_t)count * sizeof(Expr));
    roots->count += count;
    return first;
}

/* the same on the sides of the layout's surfaces */
static int block_on(const Layout *l, Roots *roots, const Expr *entries, int count)
{
    int first = roots->count;

    for (int i = 0; i < count; i++)
        LIST_PUSH(*roots, layout_on_surfaces(l, entries[i]));
    return first;
}

/* places of the entries of A, and the latest stage of what the network's equations hold */
static Stage network_shape(Numbers *nb)
{
    const Reading *r = system_run(nb->layout->system);
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
        if (stage_of(layout_on_surfaces(nb->layout, r->network[i].value)) > STAGE_PARAMETER)
            nb->eq.network_is_constant = false;
        if (stage_of(r->network[i].value) > stage)
            stage = stage_of(r->network[i].value);
    }
    for (int i = 0; i < nb->layout->nx + nb->layout->nz; i++)
        if (stage_of(r->network_rhs[i]) > stage)
            stage = stage_of(r->network_rhs[i]);
    return stage;
}

static int network_block(const Layout *l, Roots *roots)
{
    const Reading *r = system_run(l->system);
    int first = roots->count;

    for (int i = 0; i < r->network_entries; i++)
        LIST_PUSH(*roots, layout_on_surfaces(l, r->network[i].value));
    return first;
}

/* equations that are solved by iteration have a program of their own */
static Status compile_network(Numbers *nb, Parameters *parameters, Diag *diag)
{
    const Layout *l = nb->layout;
    const Reading *r = system_run(l->system);
    Roots roots = {0};
    int network = network_block(l, &roots);
    int residual = block_on(l, &roots, r->network_residual, l->nx + l->nz);
    Status status = OK;

    CHECK(numbers_compile(l, parameters, &roots, &nb->network, diag));
    nb->eq.network = workspace_roots(nb->network->workspace) + network;
    nb->eq.network_residual = workspace_roots(nb->network->workspace) + residual;
    nb->eq.network_at = network_at;
    nb->eq.network_rounding = network_rounding;
done:
    LIST_FREE(roots);
    return status;
}

/* append the entries that aren't 0, row by row; where they stand in the transpose */
static int stored_block(Roots *roots, const Expr *entries, int rows, int columns, Pattern *out)
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

/* append the entries of N that may not be 0, row by row and by rising speeds, as they are placed */
static void map_block(Numbers *nb, Roots *roots)
{
    const Layout *l = nb->layout;
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

/* whether they are known in that stage */
static bool are_known_by(Stage stage, const Expr *entries, int count)
{
    for (int i = 0; i < count; i++)
        if (stage_of(entries[i]) > stage)
            return false;
    return true;
}

/* M, or what it is made from */
static int mass_block(Numbers *nb, Roots *roots)
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

/* M and F, where elimination does without them */
static Status compile_mass(Numbers *nb, Parameters *parameters, Diag *diag)
{
    const Layout *l = nb->layout;
    Roots roots = {0};
    const Expr *needs;
    int count, force;
    Status status = OK;

    if (nb->articulated == NULL && !needs_no_mass(nb))
        return OK;
    if (nb->mass != NULL) {
        needs = mass_matrix_needs(nb->mass, &count);
        (void)block(&roots, needs, count);
        nb->is_mass_constant = are_known_by(STAGE_PARAMETER, needs, count);
    } else {
        (void)mass_block(nb, &roots);
    }
    force = block_on(l, &roots, system_run(l->system)->force, needs_no_mass(nb) ? l->nu : 0);
    CHECK(numbers_compile(l, parameters, &roots, &nb->massing, diag));
    if (needs_no_mass(nb)) {
        nb->eq.force = workspace_roots(nb->massing->workspace) + force;
        nb->eq.bring_force = bring_force;
    }
    if (nb->mass == NULL)
        nb->eq.mass = workspace_roots(nb->massing->workspace);
    nb->eq.bring_mass = bring_mass;
done:
    LIST_FREE(roots);
    return status;
}

static void place_eliminated(Numbers *nb)
{
    Eliminated *own = &nb->eliminated;
    const ConstrainedPlaces p = nb->told_places;
    const double *at = nb->told_accelerations;

    own->acceleration = at;
    own->multiplier = at + p.multiplier;
    own->pivot = p.taken > p.pivot ? at + p.pivot : NULL;
    own->taken = p.taken > p.pivot ? at + p.taken : NULL;
    nb->told_excess = at + p.excess;
    own->left = at + p.left;
    nb->told_step = at + p.step;
    own->has_pivots = constrained_has_pivots;
    own->step = constrained_step;
    nb->eq.eliminated = own;
}

/* `told` is what they tell of accelerations themselves, if they do */
static Status compile_equations(Numbers *nb, Parameters *parameters, const Expr *told,
                                int told_count, Diag *diag)
{
    const Layout *l = nb->layout;
    const Reading *r = system_run(l->system);
    Expr power = system_power(l->system);
    Stage stage = network_shape(nb);
    bool iterates = r->network_nonlinear || stage > STAGE_VELOCITY;
    Roots roots = {0};
    int phi = block(&roots, r->phi, l->m);
    int phi_u = stored_block(&roots, r->phi_u, l->m, l->nu, &nb->rows);
    int mass = needs_no_mass(nb) ? 0 : mass_block(nb, &roots);
    int nu_rate = block(&roots, r->nu, l->m);
    int gamma = block_on(l, &roots, r->gamma, l->m);
    int q_rate = block(&roots, r->q_rate, l->n);
    int network = iterates ? 0 : network_block(l, &roots);
    int rhs = block_on(l, &roots, r->network_rhs, iterates ? 0 : l->nx + l->nz);
    int force = block_on(l, &roots, r->force, needs_no_mass(nb) ? 0 : l->nu);
    int accelerations = block(&roots, told, told_count);
    int work = block_on(l, &roots, &power, 1);
    int angles = roots.count;
    int map = roots.count + 2 * l->multi_turns;
    const double *at;
    Status status = OK;

    CHECK(push_multi_turns(&roots, l->system, diag));
    if (!numbers_speeds_are_rates(l->system))
        map_block(nb, &roots);
    CHECK(numbers_compile(l, parameters, &roots, &nb->main, diag));
    at = workspace_roots(nb->main->workspace);
    nb->eq.phi = at + phi;
    nb->eq.phi_u = at + phi_u;
    nb->mass_needs = mass;
    nb->eq.rows = &nb->rows;
    nb->eq.masses = nb->mass != NULL ? mass_matrix_places(nb->mass) : &nb->masses;
    if (nb->mass != NULL)
        nb->eq.mass = mass_matrix_at(nb->mass);
    else if (!needs_no_mass(nb))
        nb->eq.mass = at + mass;
    nb->eq.nu_rate = at + nu_rate;
    nb->eq.has_nu_early = are_known_by(STAGE_POSITION, r->nu, l->m);
    nb->eq.gamma = at + gamma;
    nb->eq.q_rate = at + q_rate;
    if (!iterates) {
        nb->eq.network = at + network;
        nb->eq.network_rhs = at + rhs;
    }
    if (!needs_no_mass(nb))
        nb->eq.force = at + force;
    nb->told_accelerations = at + accelerations;
    if (nb->told_by == TOLD_PRESCRIBED)
        nb->eq.prescribed = tell_prescribed;
    else if (nb->told_by == TOLD_CONSTRAINED)
        place_eliminated(nb);
    else if (nb->told_by != TOLD_NOT)
        nb->eq.without_mass = tell_accelerations;
    else if (nb->articulated != NULL)
        nb->eq.without_mass = articulate;
    nb->eq.power = at + work;
    nb->eq.multi_turn = at + angles;
    nb->eq.multi_turn_rate = at + angles + l->multi_turns;
    nb->eq.map = map < roots.count ? at + map : NULL;
    nb->eq.maps = &nb->maps;
    nb->eq.accelerated = stage_of(power) == STAGE_ACCELERATION ? accelerated : NULL;
    if (may_be_outright(nb))
        nb->eq.outright = outright;
    nb->eq.network_reads = stage == STAGE_ACCELERATION ? network_reads : NULL;
    if (iterates && nb->network == NULL)
        CHECK(compile_network(nb, parameters, diag));
done:
    LIST_FREE(roots);
    return status;
}

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
    status = nb->massing == NULL ? compile_mass(nb, nb->parameters, diag) : OK;
    if (status == OK)
        status =
            compile_equations(nb, nb->parameters, solved->acceleration, solved->places.count, diag);
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
    int count = 0;
    Status status = OK;

    nb->layout = layout;
    nb->parameters = parameters;
    nb->eq = (Equations){.n = layout->n,
                         .nu = layout->nu,
                         .m = layout->m,
                         .nx = layout->nx,
                         .nz = layout->nz,
                         .multi_turn_count = layout->multi_turns,
                         .sides = &layout->sides,
                         .context = nb,
                         .take_references = take_references,
                         .position = position,
                         .velocity = velocity,
                         .network_solved = network_solved,
                         .loads = loads};
    while (system_quaternion(layout->system, count) >= 0)
        count++;
    nb->quaternions = NEW_ARRAY(int, count);
    for (int i = 0; i < count; i++)
        nb->quaternions[i] = system_quaternion(layout->system, i);
    nb->cap = NEW_ARRAY(double, layout_references(layout) + layout->multi_turns);
    for (int i = 0; i < layout_references(layout) + layout->multi_turns; i++)
        nb->cap[i] = i >= layout_references(layout) ||
                             (i < layout->n && system_q(layout->system, i)->is_angle)
                         ? 1
                         : INFINITY;
    nb->eq.cap = nb->cap;
    nb->unit = units_of(layout);
    nb->eq.unit = nb->unit;
    nb->eq.quaternions = nb->quaternions;
    nb->eq.quaternion_count = count;
    parameters_begin_turns(parameters, layout->system);
    nb->mass = mass_matrix_new(layout->system);
    CHECK(elimination_choose(layout, &nb->told_by, &accelerations, diag));
    if (layout->m == 0 && nb->mass != NULL && nb->told_by == TOLD_NOT)
        nb->articulated = articulated_new(layout->system);
    if (layout->m > 0 && nb->told_by == TOLD_NOT)
        nb->eq.eliminate = eliminate;
    CHECK(compile_equations(nb, parameters, accelerations,
                            nb->told_by != TOLD_NOT ? 2 * layout->nu : 0, diag));
    CHECK(compile_mass(nb, parameters, diag));
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
    const Probe *const parts[] = {nb->main, nb->network, nb->switching, nb->slip, nb->massing};

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
