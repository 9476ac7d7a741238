/* numbers.c: programs over a system's variables */
#include "simulate/equations/numbers.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* --- machines --- */

/* an input of a program that is a side of a switch */
typedef struct SideInput {
    int input, side;
} SideInput;

/* the parameters that roots hold, from now on as they are */
static void keep_parameters(const Layout *l, Parameters *p, const Expr *roots, int count)
{
    Expr *symbols;
    int found = expr_symbols(roots, count, &symbols);

    for (int i = 0; i < found; i++)
        if (expr_symbol_kind(symbols[i]) == SYMBOL_PARAMETER && layout_side_of(l, symbols[i]) < 0)
            (void)parameters_value(p, symbols[i]);
    mem_free(symbols);
}

/* A program over the layout and whatever parameters its roots hold, and its workspace. */
typedef struct Machine {
    const Layout *layout;
    Program *program;
    Workspace *workspace;
    Expr *own; /* these parameters, in the order of inputs behind the layout's, ended by NULL */
    LIST(SideInput) sides; /* those of them that are sides of switches, */
    uint64_t seen;         /* as they were then */
} Machine;

static void machine_close(Machine *machine)
{
    workspace_free(machine->workspace);
    program_free(machine->program);
    mem_free(machine->own);
    LIST_FREE(machine->sides);
}

/* Its inputs. Where switches have gone over since the last call, with what follows from that. */
static double *machine_inputs(Machine *machine)
{
    double *inputs = workspace_inputs(machine->workspace);

    if (machine->seen == machine->layout->sides)
        return inputs;
    machine->seen = machine->layout->sides;
    for (int i = 0; i < machine->sides.count; i++)
        inputs[machine->sides.at[i].input] = machine->layout->closed[machine->sides.at[i].side];
    if (machine->sides.count > 0)
        workspace_run(machine->workspace, STAGE_PARAMETER, STAGE_PARAMETER);
    return inputs;
}

/* Its workspace has the parameters set, and what depends on them alone computed. */
static Status compile(const Layout *layout, Parameters *parameters, const Expr *roots, int count,
                      Machine *out, Diag *diag)
{
    Expr *symbols;
    int found = expr_symbols(roots, count, &symbols);
    Expr *inputs = NEW_ARRAY(Expr, layout->count + found + 1);
    int input_count = layout->count;
    Status status;

    out->layout = layout;
    memcpy(inputs, layout->symbols, (size_t)layout->count * sizeof(Expr));
    for (int i = 0; i < found; i++)
        if (expr_symbol_kind(symbols[i]) == SYMBOL_PARAMETER)
            inputs[input_count++] = symbols[i];
    status = program_new(roots, count, inputs, input_count, &out->program, diag);
    if (status == OK) {
        out->workspace = workspace_new(out->program);
        for (int i = layout->count; i < input_count; i++) {
            int side = layout_side_of(layout, inputs[i]);

            if (side >= 0)
                LIST_PUSH(out->sides, (SideInput){i, side});
            else
                workspace_inputs(out->workspace)[i] = parameters_value(parameters, inputs[i]);
        }
        out->own = NEW_ARRAY(Expr, input_count - layout->count + 1);
        memcpy(out->own, inputs + layout->count,
               (size_t)(input_count - layout->count) * sizeof(Expr));
        out->seen = layout->sides + 1; /* none: */
        (void)machine_inputs(out);
        if (out->sides.count == 0)
            workspace_run(out->workspace, STAGE_PARAMETER, STAGE_PARAMETER);
    }
    mem_free(symbols);
    mem_free(inputs);
    return status;
}

/* --- probes --- */

struct Probe {
    const Layout *layout;
    Machine machine;
};

Status probe_new(const Layout *layout, Parameters *parameters, const Expr *roots, int count,
                 Probe **out, Diag *diag)
{
    Probe *probe = NEW(Probe);
    Expr *put = NEW_ARRAY(Expr, count);
    Status status;

    for (int i = 0; i < count; i++)
        put[i] = layout_on_surfaces(layout, roots[i]);
    probe->layout = layout;
    status = compile(layout, parameters, put, count, &probe->machine, diag);
    mem_free(put);
    if (status == OK)
        *out = probe;
    else
        probe_free(probe);
    return status;
}

void probe_free(Probe *probe)
{
    if (probe == NULL)
        return;
    machine_close(&probe->machine);
    mem_free(probe);
}

/* another value of one of a machine's parameters; false: it holds none such */
static bool machine_set(const Machine *machine, Expr parameter, double value)
{
    int i = 0;

    while (machine->own != NULL && machine->own[i] != NULL && machine->own[i] != parameter)
        i++;
    if (machine->own == NULL || machine->own[i] == NULL)
        return false;
    workspace_inputs(machine->workspace)[machine->layout->count + i] = value;
    workspace_run(machine->workspace, STAGE_PARAMETER, STAGE_PARAMETER);
    return true;
}

bool probe_turn(Probe *probe, Expr parameter, double value)
{
    return machine_set(&probe->machine, parameter, value);
}

double *probe_input(Probe *probe, int place)
{
    return workspace_inputs(probe->machine.workspace) + place;
}

static void put(double *inputs, int first, const double *values, int count)
{
    if (values != NULL)
        memcpy(inputs + first, values, (size_t)count * sizeof(double));
    else
        memset(inputs + first, 0, (size_t)count * sizeof(double));
}

RowValues row_of_state(const Layout *l, double t, const double *y)
{
    return (RowValues){
        .t = t, .q = y, .u = y + l->n, .x = y + l->n + l->nu, .near = y + layout_turned(l)};
}

bool row_solve(const Layout *l, Motion *motion, double t, const double *y, RowValues *out)
{
    Solved solved;

    *out = row_of_state(l, t, y);
    if (!motion_solve(motion, t, y, &solved))
        return false;
    out->rates = solved.rates;
    out->z = solved.algebraic;
    out->acceleration = solved.acceleration;
    out->multipliers = solved.multipliers;
    out->signs = solved.signs;
    return true;
}

static void put_row(const Layout *l, const RowValues *row, double *inputs)
{
    inputs[l->t] = row->t;
    put(inputs, l->near, row->near, l->turned);
    put(inputs, l->q, row->q, l->n);
    put(inputs, l->u, row->u, l->nu);
    put(inputs, l->x, row->x, l->nx);
    put(inputs, l->signs, row->signs, l->slides);
    put(inputs, l->rates, row->rates, l->nx);
    put(inputs, l->z, row->z, l->nz);
    put(inputs, l->acceleration, row->acceleration, l->nu);
    put(inputs, l->multipliers, row->multipliers, l->m);
    put(inputs, l->efforts, row->efforts, l->ne);
    put(inputs, l->jerk, row->jerk, l->nu);
}

const double *probe_values(Probe *probe, const RowValues *row)
{
    put_row(probe->layout, row, machine_inputs(&probe->machine));
    workspace_run(probe->machine.workspace, STAGE_TIME, STAGE_ACCELERATION);
    return workspace_roots(probe->machine.workspace);
}

void probe_errors(const Probe *probe, const RowValues *errors, double *out)
{
    const Layout *l = probe->machine.layout;
    const Workspace *workspace = probe->machine.workspace;
    const int count = program_input_count(probe->machine.program);
    double *inputs = NEW_ARRAY(double, count);

    put_row(l, errors, inputs);
    for (int i = l->count; i < count; i++)
        inputs[i] = number_error(workspace_inputs(probe->machine.workspace)[i]);
    workspace_errors(workspace, inputs, out);
    mem_free(inputs);
}

/* --- equations --- */

struct Numbers {
    Equations eq;
    const Layout *layout;
    Machine main, switching, network;
    Probe *slip;   /* of surfaces that are slid along: h', or what of it they reach, and h */
    Guard *guards; /* of the conditions, */
    Expr *told;    /* which are these for a user; NULL: margins */
    int *quaternions, *network_places;
    LIST(int) margins;   /* whose they are, of the switches */
    bool is_network_new; /* network_workspace has seen t, q, u, x as they are */
    double *cap;
};

static void turned(void *context, const double *references)
{
    Numbers *nb = context;

    put(machine_inputs(&nb->main), nb->layout->near, references, nb->layout->turned);
}

static void position(void *context, double t, const double *q)
{
    Numbers *nb = context;
    double *inputs = machine_inputs(&nb->main);

    inputs[nb->layout->t] = t;
    put(inputs, nb->layout->q, q, nb->layout->n);
    workspace_run(nb->main.workspace, STAGE_TIME, STAGE_POSITION);
}

static void velocity(void *context, const double *u, const double *x)
{
    Numbers *nb = context;
    double *inputs = machine_inputs(&nb->main);

    put(inputs, nb->layout->u, u, nb->layout->nu);
    put(inputs, nb->layout->x, x, nb->layout->nx);
    workspace_run(nb->main.workspace, STAGE_VELOCITY, STAGE_VELOCITY);
    nb->is_network_new = true;
}

static void slide(void *context, const double *signs)
{
    Numbers *nb = context;

    put(machine_inputs(&nb->main), nb->layout->signs, signs, nb->layout->slides);
}

static void slip(void *context, double t, const double *y, const Solved *solved, double *slip,
                 double *off)
{
    const Numbers *nb = context;
    const Layout *l = nb->layout;
    RowValues row = row_of_state(l, t, y);
    const double *values;

    row.signs = solved->signs;
    row.rates = solved->rates;
    row.z = solved->algebraic;
    row.acceleration = solved->acceleration;
    row.multipliers = solved->multipliers;
    values = probe_values(nb->slip, &row);
    memcpy(slip, values, (size_t)l->slides * sizeof(double));
    memcpy(off, values + l->slides, (size_t)l->slides * sizeof(double));
}

static void copy_inputs(Numbers *nb, int first, int count)
{
    memcpy(machine_inputs(&nb->network) + first, machine_inputs(&nb->main) + first,
           (size_t)count * sizeof(double));
}

static void network_at(void *context, const double *w)
{
    Numbers *nb = context;
    const Layout *l = nb->layout;
    double *inputs = machine_inputs(&nb->network);

    put(inputs, l->rates, w, l->nx);
    put(inputs, l->z, w + l->nx, l->nz);
    if (nb->is_network_new)
        copy_inputs(nb, l->t, l->rates - l->t);
    workspace_run(nb->network.workspace, nb->is_network_new ? STAGE_TIME : STAGE_NETWORK,
                  STAGE_ACCELERATION);
    nb->is_network_new = false;
}

static void network_reads(void *context, const double *acceleration, const double *multipliers)
{
    Numbers *nb = context;
    double *inputs = machine_inputs(&nb->network);

    put(inputs, nb->layout->acceleration, acceleration, nb->layout->nu);
    put(inputs, nb->layout->multipliers, multipliers, nb->layout->m);
}

static void network_solved(void *context, const double *solved)
{
    Numbers *nb = context;
    double *inputs = machine_inputs(&nb->main);

    put(inputs, nb->layout->rates, solved, nb->layout->nx);
    put(inputs, nb->layout->z, solved + nb->layout->nx, nb->layout->nz);
    workspace_run(nb->main.workspace, STAGE_NETWORK, STAGE_NETWORK);
}

static void accelerated(void *context, const double *acceleration, const double *multipliers)
{
    Numbers *nb = context;
    double *inputs = machine_inputs(&nb->main);

    put(inputs, nb->layout->acceleration, acceleration, nb->layout->nu);
    put(inputs, nb->layout->multipliers, multipliers, nb->layout->m);
    workspace_run(nb->main.workspace, STAGE_ACCELERATION, STAGE_ACCELERATION);
}

static void switches(void *context, double t, const double *q, const double *u, const double *x,
                     double *out)
{
    Numbers *nb = context;
    double *inputs = machine_inputs(&nb->switching);

    inputs[nb->layout->t] = t;
    put(inputs, nb->layout->near, machine_inputs(&nb->main) + nb->layout->near, nb->layout->turned);
    put(inputs, nb->layout->q, q, nb->layout->n);
    put(inputs, nb->layout->u, u, nb->layout->nu);
    put(inputs, nb->layout->x, x, nb->layout->nx);
    put(inputs, nb->layout->signs, machine_inputs(&nb->main) + nb->layout->signs,
        nb->layout->slides);
    if (nb->eq.switches_read_network)
        memcpy(inputs + nb->layout->rates, machine_inputs(&nb->main) + nb->layout->rates,
               (size_t)(nb->layout->nx + nb->layout->nz) * sizeof(double));
    workspace_run(nb->switching.workspace, STAGE_TIME, STAGE_NETWORK);
    memcpy(out, workspace_roots(nb->switching.workspace),
           (size_t)nb->eq.switch_count * sizeof(double));
}

static bool margin_is_steep(void *context, int k)
{
    const Numbers *nb = context;
    int i = nb->margins.at[k];

    return nb->layout->side[i] != NULL && nb->layout->closed[i];
}

typedef LIST(Expr) Roots;

/* angles that count turns, then their rates */
static Status push_turned(Roots *roots, System *system, Diag *diag)
{
    Status status = OK;

    for (int i = 0; i < system_turned_count(system); i++)
        LIST_PUSH(*roots, system_turned(system, i)->angle);
    for (int i = 0; i < system_turned_count(system); i++) {
        Expr rate;

        CHECK(system_turned_rate(system, i, &rate, diag));
        LIST_PUSH(*roots, rate);
    }
done:
    return status;
}

/* append a block; its first place */
static int block(Roots *roots, const Expr *entries, int count)
{
    int first = roots->count;

    for (int i = 0; i < count; i++)
        LIST_PUSH(*roots, entries[i]);
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

static bool is_identity(System *system)
{
    int n = system_n(system), nu = system_nu(system);

    for (int i = 0; i < n && n == nu; i++)
        for (int j = 0; j < nu; j++)
            if (!expr_is(system_n_entry(system, i, j), i == j))
                return false;
    return n == nu;
}

/* places of the entries of A, and the latest stage of what the network's equations hold */
static Stage network_shape(Numbers *nb)
{
    const Reading *r = system_run(nb->layout->system);
    Stage stage = STAGE_PARAMETER;

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

    keep_parameters(l, parameters, roots.at, roots.count);
    CHECK(compile(l, parameters, roots.at, roots.count, &nb->network, diag));
    nb->eq.network = workspace_roots(nb->network.workspace) + network;
    nb->eq.network_residual = workspace_roots(nb->network.workspace) + residual;
    nb->eq.network_at = network_at;
done:
    LIST_FREE(roots);
    return status;
}

static Status compile_equations(Numbers *nb, Parameters *parameters, Diag *diag)
{
    const Layout *l = nb->layout;
    const Reading *r = system_run(l->system);
    Expr power = system_power(l->system);
    Stage stage = network_shape(nb);
    bool iterates = r->network_nonlinear || stage > STAGE_VELOCITY;
    bool mapped = !is_identity(l->system);
    Roots roots = {0};
    int phi = block(&roots, r->phi, l->m);
    int phi_u = block(&roots, r->phi_u, l->m * l->nu);
    int mass = block(&roots, r->mass, l->nu * l->nu);
    int nu_rate = block(&roots, r->nu, l->m);
    int gamma = block_on(l, &roots, r->gamma, l->m);
    int q_rate = block(&roots, r->q_rate, l->n);
    int network = iterates ? 0 : network_block(l, &roots);
    int rhs = block_on(l, &roots, r->network_rhs, iterates ? 0 : l->nx + l->nz);
    int force = block_on(l, &roots, r->force, l->nu);
    int work = block_on(l, &roots, &power, 1);
    int angles = roots.count;
    int map = roots.count + 2 * l->turned;
    const double *at;
    Status status = OK;

    CHECK(push_turned(&roots, l->system, diag));
    for (int i = 0; i < l->n && mapped; i++)
        for (int j = 0; j < l->nu; j++)
            LIST_PUSH(roots, system_n_entry(l->system, i, j));
    keep_parameters(l, parameters, roots.at, roots.count);
    CHECK(compile(l, parameters, roots.at, roots.count, &nb->main, diag));
    at = workspace_roots(nb->main.workspace);
    nb->eq.phi = at + phi;
    nb->eq.phi_u = at + phi_u;
    nb->eq.mass = at + mass;
    nb->eq.nu_rate = at + nu_rate;
    nb->eq.gamma = at + gamma;
    nb->eq.q_rate = at + q_rate;
    nb->eq.network = at + network;
    nb->eq.network_rhs = at + rhs;
    nb->eq.force = at + force;
    nb->eq.power = at + work;
    nb->eq.turned = at + angles;
    nb->eq.turned_rate = at + angles + l->turned;
    nb->eq.map = map < roots.count ? at + map : NULL;
    nb->eq.accelerated = stage_of(power) == STAGE_ACCELERATION ? accelerated : NULL;
    nb->eq.network_reads = stage == STAGE_ACCELERATION ? network_reads : NULL;
    if (iterates)
        CHECK(compile_network(nb, parameters, diag));
done:
    LIST_FREE(roots);
    return status;
}

/* what tells whether ideal switches stay on their sides */
static Status add_margins(Numbers *nb, Roots *roots, Diag *diag)
{
    System *system = nb->layout->system;
    Status status = OK;

    for (int i = 0; i < system_ideal_count(system); i++) {
        IdealSwitch ideal;
        Stage stage;

        CHECK(system_ideal(system, i, &ideal, diag));
        stage = ideal.margin != NULL ? stage_of(ideal.margin) : STAGE_PARAMETER;
        if (stage == STAGE_PARAMETER || stage > STAGE_NETWORK)
            continue;
        nb->eq.switches_read_network = nb->eq.switches_read_network || stage == STAGE_NETWORK;
        LIST_PUSH(*roots, layout_on_surfaces(nb->layout, ideal.margin));
        LIST_PUSH(nb->margins, i);
        nb->eq.margin_count++;
    }
done:
    return status;
}

typedef struct Conditions {
    Roots roots;
    Roots told;
    LIST(Guard) guards;
} Conditions;

static void push_condition(Numbers *nb, Conditions *c, Expr condition, Guard guard)
{
    Stage stage = stage_of(condition);

    if (stage == STAGE_PARAMETER || stage > STAGE_NETWORK)
        return;
    nb->eq.switches_read_network = nb->eq.switches_read_network || stage == STAGE_NETWORK;
    guard.solved = guard.surface >= 0 && stage == STAGE_NETWORK;
    LIST_PUSH(c->roots, condition);
    LIST_PUSH(c->told,
              guard.surface >= 0 ? system_surface(nb->layout->system, guard.surface) : condition);
    LIST_PUSH(c->guards, guard);
}

/* what watches a surface that the equations stay on: whether its sign leaves -1 .. 1; or its side
 */
static void push_surface(Numbers *nb, Conditions *c, int number, const Surface *surface)
{
    Arena *arena = system_arena(nb->layout->system);

    if (surface->side != 0) {
        push_condition(nb, c, surface->measure, (Guard){number, .side = surface->side});
        return;
    }
    nb->eq.switches_read_network = true; /* with which signs are found */
    push_condition(nb, c, expr_sub(arena, expr_int(arena, 1), surface->sign),
                   (Guard){number, .end = 1});
    push_condition(nb, c, expr_add(arena, expr_int(arena, 1), surface->sign),
                   (Guard){number, .end = -1});
}

/* the entry of the layout's surfaces; NULL: it is none of them */
static const Surface *find_surface(const Layout *l, Expr condition)
{
    int way;
    Expr surface =
        l->surface_count > 0 ? surface_of(system_arena(l->system), condition, &way) : NULL;

    for (int i = 0; i < l->surface_count; i++)
        if (l->surfaces[i].condition == surface)
            return &l->surfaces[i];
    return NULL;
}

static bool is_watched(const Conditions *c, int surface)
{
    for (int i = 0; i < c->guards.count; i++)
        if (surface >= 0 && c->guards.at[i].surface == surface)
            return true;
    return false;
}

/* conditions that can be looked at before the accelerations are known */
static void push_conditions(Numbers *nb, Conditions *c)
{
    const Layout *l = nb->layout;
    const Switch *switches;
    int time_only = 0;
    int count = system_switches(l->system, &switches, &time_only);

    for (int i = 0; i < count; i++) {
        int number = switches[i].surface;
        const Surface *on = i < time_only ? NULL : find_surface(l, switches[i].condition);
        int before = c->roots.count;

        if (is_watched(c, number))
            continue;
        if (number >= 0 && on != NULL)
            push_surface(nb, c, number, on);
        else if (number >= 0)
            push_condition(nb, c, layout_on_surfaces(l, system_surface(l->system, number)),
                           (Guard){.surface = number});
        else if (on == NULL) /* else its bend lies on a surface that is watched */
            push_condition(nb, c, layout_on_surfaces(l, switches[i].condition),
                           (Guard){.surface = -1});
        nb->eq.time_only += i < time_only ? c->roots.count - before : 0;
    }
}

static Status compile_switches(Numbers *nb, Parameters *parameters, Diag *diag)
{
    Conditions c = {0};
    Status status = OK;

    push_conditions(nb, &c);
    CHECK(add_margins(nb, &c.roots, diag));
    while (c.guards.count < c.roots.count)
        LIST_PUSH(c.guards, (Guard){.surface = -1});
    while (c.told.count < c.roots.count)
        LIST_PUSH(c.told, NULL);
    nb->eq.switch_count = c.roots.count;
    nb->eq.switches_follow_time =
        c.roots.at != NULL && layout_follows_time(nb->layout, c.roots.at + nb->eq.time_only,
                                                  c.roots.count - nb->eq.time_only);
    if (c.roots.count > 0)
        CHECK(compile(nb->layout, parameters, c.roots.at, c.roots.count, &nb->switching, diag));
    nb->eq.guards = nb->guards = c.guards.at;
    c.guards.at = NULL;
    nb->told = c.told.at;
    c.told.at = NULL;
done:
    LIST_FREE(c.told);
    LIST_FREE(c.roots);
    LIST_FREE(c.guards);
    return status;
}

/* How a surface is left: by h where signs reach that, else h', else h''; and what has to be 0
 * beside it. */
static Status slip_of(const Layout *l, Expr h, Expr *slip, Expr *off, Diag *diag)
{
    const unsigned solved = 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE;
    const unsigned reached = solved | 1U << SYMBOL_ACCELERATION;
    Status status = OK;

    *slip = h;
    *off = expr_int(system_arena(l->system), 0);
    if ((expr_kinds(h) & solved) != 0)
        return OK;
    *off = h;
    CHECK(system_rate(l->system, h, slip, diag));
    if ((expr_kinds(*slip) & reached) != 0)
        return OK;
    *off = *slip;
    CHECK(system_rate(l->system, *off, slip, diag));
done:
    return status;
}

static Status compile_slip(Numbers *nb, Parameters *parameters, Diag *diag)
{
    const Layout *l = nb->layout;
    Roots roots = {0};
    Roots off = {0};
    Status status = OK;

    nb->eq.slide_count = l->slides;
    if (l->slides == 0)
        return OK;
    nb->eq.slide = slide;
    nb->eq.slip = slip;
    for (int i = 0; i < l->slides; i++) {
        Expr both[2];

        CHECK(slip_of(l, l->surfaces[i].measure, &both[0], &both[1], diag));
        LIST_PUSH(roots, both[0]);
        LIST_PUSH(off, both[1]);
    }
    (void)block(&roots, off.at, off.count);
    CHECK(probe_new(l, parameters, roots.at, roots.count, &nb->slip, diag));
done:
    LIST_FREE(roots);
    LIST_FREE(off);
    return status;
}

Status numbers_new(const Layout *layout, Parameters *parameters, Numbers **out, Diag *diag)
{
    Numbers *nb = NEW(Numbers);
    int count = 0;
    Status status = OK;

    nb->layout = layout;
    nb->eq = (Equations){.n = layout->n,
                         .nu = layout->nu,
                         .m = layout->m,
                         .nx = layout->nx,
                         .nz = layout->nz,
                         .turned_count = layout->turned,
                         .sides = &layout->sides,
                         .context = nb,
                         .near = turned,
                         .position = position,
                         .velocity = velocity,
                         .network_solved = network_solved,
                         .switches = switches,
                         .margin_is_steep = margin_is_steep};
    while (system_quaternion(layout->system, count) >= 0)
        count++;
    nb->quaternions = NEW_ARRAY(int, count);
    for (int i = 0; i < count; i++)
        nb->quaternions[i] = system_quaternion(layout->system, i);
    nb->cap = NEW_ARRAY(double, layout_turned(layout) + layout->turned);
    for (int i = 0; i < layout_turned(layout) + layout->turned; i++)
        nb->cap[i] =
            i >= layout_turned(layout) || (i < layout->n && system_q(layout->system, i)->is_angle)
                ? 1
                : INFINITY;
    nb->eq.cap = nb->cap;
    nb->eq.quaternions = nb->quaternions;
    nb->eq.quaternion_count = count;
    parameters_begin_turns(parameters, layout->system);
    CHECK(compile_equations(nb, parameters, diag));
    CHECK(compile_switches(nb, parameters, diag));
    CHECK(compile_slip(nb, parameters, diag));
    *out = nb;
    nb = NULL;
done:
    numbers_free(nb);
    return status;
}

void numbers_free(Numbers *nb)
{
    if (nb == NULL)
        return;
    machine_close(&nb->main);
    machine_close(&nb->network);
    machine_close(&nb->switching);
    LIST_FREE(nb->margins);
    mem_free(nb->quaternions);
    mem_free(nb->network_places);
    mem_free(nb->cap);
    probe_free(nb->slip);
    mem_free(nb->guards);
    mem_free(nb->told);
    mem_free(nb);
}

void numbers_set(Numbers *nb, Expr parameter, double value)
{
    const Machine *const machines[] = {&nb->main, &nb->switching, &nb->network,
                                       nb->slip != NULL ? &nb->slip->machine : &nb->main};

    for (int i = 0; i < COUNT(machines); i++)
        (void)machine_set(machines[i], parameter, value);
}

const Equations *numbers_equations(const Numbers *nb)
{
    return &nb->eq;
}

Expr numbers_condition(const Numbers *nb, int i)
{
    return nb->told[i];
}

int numbers_margin(const Numbers *nb, int i)
{
    return nb->margins.at[i - (nb->eq.switch_count - nb->eq.margin_count)];
}
