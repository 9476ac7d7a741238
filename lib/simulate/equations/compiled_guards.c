/* compiled_guards.c: conditions that a run monitors, and surfaces that it slides along */
#include "simulate/equations/compiled_equations_impl.h"

#include "base/memory.h"

#include <string.h>

static void slide(void *context, const double *signs)
{
    CompiledEquations *nb = context;

    inputs_set(probe_inputs(nb->main), nb->layout->signs, signs, nb->layout->slides);
}

static void slip(void *context, double t, const double *y, const Solved *solved, double *slip,
                 double *off)
{
    const CompiledEquations *nb = context;
    const VariableIndex *l = nb->layout;
    const RowValues row = row_of_solved(l, t, y, solved);
    const double *values = probe_values(nb->slip, &row);

    memcpy(slip, values, (size_t)l->slides * sizeof(double));
    memcpy(off, values + l->slides, (size_t)l->slides * sizeof(double));
}

static void switches(void *context, double t, const double *q, const double *u, const double *x,
                     double *out)
{
    CompiledEquations *nb = context;
    double *inputs = probe_inputs(nb->switching);

    inputs[nb->layout->t] = t;
    inputs_set(inputs, nb->layout->references, probe_inputs(nb->main) + nb->layout->references,
               nb->layout->multi_turns);
    inputs_set(inputs, nb->layout->q, q, nb->layout->n);
    inputs_set(inputs, nb->layout->u, u, nb->layout->nu);
    inputs_set(inputs, nb->layout->x, x, nb->layout->nx);
    inputs_set(inputs, nb->layout->signs, probe_inputs(nb->main) + nb->layout->signs,
               nb->layout->slides);
    if (nb->eq.switches_read_network)
        memcpy(inputs + nb->layout->rates, probe_inputs(nb->main) + nb->layout->rates,
               (size_t)(nb->layout->nx + nb->layout->nz) * sizeof(double));
    workspace_run(nb->switching->workspace, STAGE_TIME, STAGE_NETWORK);
    memcpy(out, workspace_roots(nb->switching->workspace),
           (size_t)nb->eq.switch_count * sizeof(double));
}

static bool guard_is_of_stiff_element(void *context, int k)
{
    const CompiledEquations *nb = context;
    int i = nb->margins.at[k];

    return nb->layout->side[i] != NULL && nb->layout->closed[i] &&
           !system_is_ideal(nb->layout->system, i);
}

/* the conditions that hold as long as ideal switches keep their states */
static Status add_margins(CompiledEquations *nb, CompiledRoots *roots, Diag *diag)
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
        LIST_PUSH(*roots, variable_index_on_surfaces(nb->layout, ideal.margin));
        LIST_PUSH(nb->margins, i);
        nb->eq.margin_count++;
    }
done:
    return status;
}

typedef struct Conditions {
    CompiledRoots roots;
    CompiledRoots shown_guards;
    LIST(Guard) guards;
} Conditions;

static void push_condition(CompiledEquations *nb, Conditions *c, Expr condition, Guard guard)
{
    Stage stage = stage_of(condition);
    SystemSurface surface = {.condition = condition};

    if (stage == STAGE_PARAMETER || stage > STAGE_NETWORK)
        return;
    if (guard.surface >= 0)
        (void)system_surface(nb->layout->system, guard.surface, &surface);
    nb->eq.switches_read_network = nb->eq.switches_read_network || stage == STAGE_NETWORK;
    guard.solved = guard.surface >= 0 && stage == STAGE_NETWORK;
    LIST_PUSH(c->roots, condition);
    LIST_PUSH(c->shown_guards, surface.condition);
    LIST_PUSH(c->guards, guard);
}

/* The condition of a surface that the equations stay on: whether its sign leaves -r .. r, or its
 * side changes. */
static void push_surface(CompiledEquations *nb, Conditions *c, int number, const Surface *surface)
{
    Arena *arena = system_arena(nb->layout->system);
    const Expr ratio = surface->ratio != NULL ? surface->ratio : expr_int(arena, 1);

    if (surface->side != 0) {
        push_condition(nb, c, surface->measure,
                       (Guard){number, .side = surface->side, .held = surface->held});
        return;
    }
    nb->eq.switches_read_network = true; /* signs follow from it */
    push_condition(nb, c, expr_sub(arena, ratio, surface->sign), (Guard){number, .end = 1});
    push_condition(nb, c, expr_add(arena, ratio, surface->sign), (Guard){number, .end = -1});
}

/* the entry of the layout's surfaces for a switch; NULL: none */
static const Surface *find_surface(const VariableIndex *l, const Switch *entry)
{
    int way;
    Expr surface =
        l->surface_count > 0 ? surface_of(system_arena(l->system), entry->condition, &way) : NULL;

    for (int i = 0; i < l->surface_count; i++)
        if (entry->surface >= 0 ? l->surfaces[i].number == entry->surface
                                : l->surfaces[i].condition == surface)
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

/* conditions that can be evaluated before the accelerations are known */
static void push_conditions(CompiledEquations *nb, Conditions *c)
{
    const VariableIndex *l = nb->layout;
    const Switch *switches;
    int time_only = 0;
    int count = system_switches(l->system, &switches, &time_only);

    for (int i = 0; i < count; i++) {
        int number = switches[i].surface;
        const Surface *on = i < time_only ? NULL : find_surface(l, &switches[i]);
        int before = c->roots.count;

        SystemSurface surface;

        if (is_watched(c, number))
            continue;
        if (number >= 0 && on != NULL)
            push_surface(nb, c, number, on);
        else if (number >= 0 && system_surface(l->system, number, &surface))
            push_condition(nb, c, variable_index_on_surfaces(l, surface.condition),
                           (Guard){.surface = number});
        else if (on == NULL) /* else a surface monitors its kink */
            push_condition(nb, c, variable_index_on_surfaces(l, switches[i].condition),
                           (Guard){.surface = -1});
        nb->eq.time_only += i < time_only ? c->roots.count - before : 0;
    }
}

Status compiled_watch(CompiledEquations *nb, Parameters *parameters, Diag *diag)
{
    Conditions c = {0};
    Status status = OK;

    nb->eq.switches = switches;
    nb->eq.guard_is_of_stiff_element = guard_is_of_stiff_element;
    push_conditions(nb, &c);
    CHECK(add_margins(nb, &c.roots, diag));
    while (c.guards.count < c.roots.count)
        LIST_PUSH(c.guards, (Guard){.surface = -1});
    while (c.shown_guards.count < c.roots.count)
        LIST_PUSH(c.shown_guards, NULL);
    nb->eq.switch_count = c.roots.count;
    nb->eq.switches_follow_time =
        c.roots.at != NULL && variable_index_follows_time(nb->layout, c.roots.at + nb->eq.time_only,
                                                          c.roots.count - nb->eq.time_only);
    if (c.roots.count > 0)
        CHECK(compiled_compile(nb->layout, parameters, &c.roots, &nb->switching, diag));
    nb->eq.guards = nb->guards = c.guards.at;
    c.guards.at = NULL;
    nb->shown_guards = c.shown_guards.at;
    c.shown_guards.at = NULL;
done:
    LIST_FREE(c.shown_guards);
    LIST_FREE(c.roots);
    LIST_FREE(c.guards);
    return status;
}

/* The lowest time derivative of h that signs affect, h, h' or h'': slip, which is 0 while the
 * motion slides along the surface. `off`, which has to be 0 besides, is the derivative below it, 0
 * for h itself. */
static Status slip_of(const VariableIndex *l, Expr h, Expr *slip, Expr *off, Diag *diag)
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

Status compiled_slide(CompiledEquations *nb, Parameters *parameters, Diag *diag)
{
    const VariableIndex *l = nb->layout;
    CompiledRoots roots = {0};
    CompiledRoots off = {0};
    Status status = OK;

    nb->eq.slide_count = l->slides;
    if (l->slides == 0)
        return OK;
    nb->eq.slide = slide;
    nb->eq.slip = slip;
    nb->eq.sign_bounds = nb->sign_bounds = NEW_ARRAY(double, l->slides);
    for (int i = 0; i < l->slides; i++) {
        const Expr ratio = l->surfaces[i].ratio;
        Expr both[2];

        nb->sign_bounds[i] =
            ratio != NULL ? expr_evaluate(ratio, parameters_value_in, parameters) : 1;
        CHECK(slip_of(l, l->surfaces[i].measure, &both[0], &both[1], diag));
        LIST_PUSH(roots, both[0]);
        LIST_PUSH(off, both[1]);
    }
    for (int i = 0; i < off.count; i++)
        LIST_PUSH(roots, off.at[i]);
    CHECK(probe_new(l, parameters, roots.at, roots.count, &nb->slip, diag));
done:
    LIST_FREE(roots);
    LIST_FREE(off);
    return status;
}

Expr compiled_condition(const CompiledEquations *nb, int i)
{
    return nb->shown_guards[i];
}

int compiled_margin(const CompiledEquations *nb, int i)
{
    return nb->margins.at[i - (nb->eq.switch_count - nb->eq.margin_count)];
}
