/* compiled_guards.c: conditions that a run monitors, and surfaces that it slides along */
#include "simulate/equations/compiled_equations_impl.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static void slide(void *context, const double *signs)
{
    CompiledEquations *nb = context;
    const VariableIndex *l = nb->layout;

    for (int k = 0; k < l->slides; k++)
        l->sign_values[l->slid[k]] = signs[k];
    inputs_set(probe_inputs(nb->main), l->signs, l->sign_values, l->sign_count);
}

static void slip(void *context, double t, const double *y, const Solved *solved, double *slip,
                 double *off, double *bounds)
{
    const CompiledEquations *nb = context;
    const VariableIndex *l = nb->layout;
    const RowValues row = row_of_solved(l, t, y, solved);
    const double *values = probe_values(nb->slip, &row);

    for (int k = 0; k < l->slides; k++) {
        slip[k] = values[l->slid[k]];
        off[k] = values[l->sign_count + l->slid[k]];
        bounds[2 * k] = values[2 * l->sign_count + l->slid[k]];
        bounds[2 * k + 1] = values[3 * l->sign_count + l->slid[k]];
    }
}

static double norm_of(const double *v, int count)
{
    double norm = 0;

    for (int i = 0; i < count; i++)
        norm = hypot(norm, v[i]);
    return norm;
}

/* 1 - s/b in parts of b + s; 1 where there is no effort at all */
static double share_left(double bound, double effort, double size)
{
    const double sum = fabs(bound) + size;

    return sum > 0 ? (bound - effort) / sum : 1;
}

/* how far efforts are from a bound that is an expression, b at rest */
static void put_bounded(const VariableIndex *l, const SignRange *range, int k, double b,
                        double *both)
{
    const double *effort = l->sign_values + l->slid[k];

    if (range->cone == 0) {
        both[0] = share_left(b, *effort, fabs(*effort));
        both[1] = share_left(b, -*effort, fabs(*effort));
    } else if (range->cone > 0) {
        const double size = norm_of(effort, range->cone);

        both[0] = share_left(b, size, size);
        both[1] = 1;
    }
}

/* how far the signs of surfaces that the motion slides along are from their bounds */
static void put_sign_conditions(const CompiledEquations *nb, double *out)
{
    const VariableIndex *l = nb->layout;

    for (int k = 0; k < l->slides; k++) {
        const int i = l->slid_surface[k];
        const double sign = l->sign_values[l->slid[k]];
        const SignRange *range = &nb->sign_ranges[k];
        double *both = out + nb->of_surface[i].first;

        if (range->has_bound)
            put_bounded(l, range, k, both[1], both);
        else if (range->cone == 0) {
            both[0] = isfinite(range->high) ? range->high - sign : 1;
            both[1] = sign - range->low;
        } else if (range->cone > 0)
            both[0] = range->norm - norm_of(l->sign_values + l->slid[k], range->cone);
    }
}

static void switches(void *context, double t, const double *q, const double *u, const double *x,
                     double *out)
{
    CompiledEquations *nb = context;
    const VariableIndex *l = nb->layout;
    double *inputs = probe_inputs(nb->switching);

    inputs[l->t] = t;
    inputs_set(inputs, l->references, probe_inputs(nb->main) + l->references, l->multi_turns);
    inputs_set(inputs, l->q, q, l->n);
    inputs_set(inputs, l->u, u, l->nu);
    inputs_set(inputs, l->x, x, l->nx);
    inputs_set(inputs, l->signs, l->sign_values, l->sign_count);
    if (nb->eq.switches_read_network)
        memcpy(inputs + l->rates, probe_inputs(nb->main) + l->rates,
               (size_t)(l->nx + l->nz) * sizeof(double));
    workspace_run(nb->switching->workspace, STAGE_TIME, STAGE_NETWORK);
    memcpy(out, workspace_roots(nb->switching->workspace),
           (size_t)nb->eq.switch_count * sizeof(double));
    put_sign_conditions(nb, out);
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
        nb->guards_read_network = nb->guards_read_network || stage == STAGE_NETWORK;
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
    nb->guards_read_network = nb->guards_read_network || stage == STAGE_NETWORK;
    guard.solved = guard.surface >= 0 && stage == STAGE_NETWORK;
    LIST_PUSH(c->roots, condition);
    LIST_PUSH(c->shown_guards, surface.condition);
    LIST_PUSH(c->guards, guard);
}

static bool is_measured(SurfaceGuards own)
{
    return own.stage != STAGE_PARAMETER && own.stage <= STAGE_NETWORK;
}

/* Two conditions of a surface whose sign is an input: on a side of it its measure, and none; where
 * it is slid along, how far the sign is from either bound. Which ones hold is set with the mode. */
static void push_surface(CompiledEquations *nb, Conditions *c, int i)
{
    const Surface *surface = &nb->layout->surfaces[i];
    const SurfaceGuards own = {.first = c->roots.count, .stage = stage_of(surface->measure)};
    Arena *arena = system_arena(nb->layout->system);
    const Expr one = expr_int(arena, 1);

    nb->guards_read_network = nb->guards_read_network || own.stage == STAGE_NETWORK;
    nb->of_surface[i] = own;
    for (int k = 0; k < 2; k++) {
        LIST_PUSH(c->roots, k == 0 && is_measured(own)        ? surface->measure
                            : k == 1 && surface->hold != NULL ? surface->hold
                                                              : one);
        LIST_PUSH(c->shown_guards, surface->condition);
        LIST_PUSH(c->guards, (Guard){.surface = surface->number});
    }
}

/* the layout's surface of a switch; -1: none */
static int find_surface(const VariableIndex *l, const Switch *entry)
{
    int way;
    Expr surface =
        l->surface_count > 0 ? surface_of(system_arena(l->system), entry->condition, &way) : NULL;

    for (int i = 0; i < l->surface_count; i++)
        if (entry->surface >= 0 ? l->surfaces[i].number == entry->surface
                                : l->surfaces[i].condition == surface)
            return i;
    return -1;
}

static bool is_watched(const Conditions *c, int surface)
{
    for (int i = 0; i < c->guards.count; i++)
        if (surface >= 0 && c->guards.at[i].surface == surface)
            return true;
    return false;
}

/* of a surface whose sign is no input: none is slid along, and what has a load has none */
static Guard guard_of(int number, const SystemSurface *surface)
{
    const bool waits = surface->load >= 0;

    return (Guard){.surface = number,
                   .is_unilateral = surface->law.is_unilateral,
                   .is_of_event = surface_rests(surface->law.ratio),
                   .is_norm = surface->law.is_norm,
                   .is_idle = waits,
                   .waits = waits,
                   .load = surface->load + 1};
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
        const int on = i < time_only ? -1 : find_surface(l, &switches[i]);
        const int before = c->roots.count;
        SystemSurface surface;

        if (is_watched(c, number))
            continue;
        if (number >= 0 && on >= 0)
            push_surface(nb, c, on);
        else if (number >= 0 && system_surface(l->system, number, &surface))
            push_condition(nb, c, variable_index_on_surfaces(l, surface.condition),
                           guard_of(number, &surface));
        else if (on < 0) /* else a surface monitors its kink */
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
    nb->of_surface = NEW_ARRAY(SurfaceGuards, nb->layout->surface_count);
    push_conditions(nb, &c);
    CHECK(add_margins(nb, &c.roots, diag));
    while (c.guards.count < c.roots.count)
        LIST_PUSH(c.guards, (Guard){.surface = -1});
    while (c.shown_guards.count < c.roots.count)
        LIST_PUSH(c.shown_guards, NULL);
    nb->eq.switch_count = c.roots.count;
    nb->guards_follow_time =
        c.roots.at != NULL && variable_index_follows_time(nb->layout, c.roots.at + nb->eq.time_only,
                                                          c.roots.count - nb->eq.time_only);
    if (c.roots.count > 0)
        CHECK(compiled_compile(nb->layout, parameters, &c.roots, &nb->switching, diag));
    nb->eq.guards = nb->guards = c.guards.at;
    c.guards.at = NULL;
    nb->shown_guards = c.shown_guards.at;
    c.shown_guards.at = NULL;
    compiled_enter_mode(nb);
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

/* the expressions that remain 0 while the motion slides along surface i: h, or the components of a
 * vector; how many */
static int measures_of(const VariableIndex *l, int i, Expr out[SURFACE_PARTS])
{
    const Surface *surface = &l->surfaces[i];

    out[0] = surface->measure;
    for (int k = 0; k < surface->part_count && surface->law.is_norm; k++)
        out[k] = variable_index_on_surfaces(l, surface->part[k]);
    return surface->law.is_norm ? surface->part_count : 1;
}

Status compiled_slip(const VariableIndex *l, int k, Expr *out, Diag *diag)
{
    const int i = l->slid_surface[k];
    Expr measures[SURFACE_PARTS], off;

    (void)measures_of(l, i, measures);
    return slip_of(l, measures[l->surfaces[i].part_count > 0 ? l->slid[k] - l->first_part[i] : 0],
                   out, &off, diag);
}

Expr compiled_bound(const VariableIndex *l, int k, int end)
{
    Arena *arena = system_arena(l->system);
    const Surface *surface = &l->surfaces[l->slid_surface[k]];
    const Expr sign = l->symbols[l->signs + l->slid[k]];
    const Expr ratio = surface->law.ratio != NULL ? surface->law.ratio : expr_int(arena, 1);
    const Expr bound = surface->hold != NULL ? surface->hold : ratio;

    if (surface->law.is_norm || (surface->law.is_unilateral && end > 0))
        return NULL;
    if (surface->law.is_unilateral)
        return sign;
    return end > 0 ? expr_sub(arena, bound, sign) : expr_add(arena, bound, sign);
}

static Status push_slip(const VariableIndex *l, Expr measure, CompiledRoots *slip,
                        CompiledRoots *off, Diag *diag)
{
    const Expr zero = expr_int(system_arena(l->system), 0);
    Expr both[2] = {zero, zero};
    const Status status = slip_of(l, measure, &both[0], &both[1], NULL);

    if (status != OK && status != E_MISSING)
        return diag_set(diag, status, "the slip of a surface can't be formed");
    LIST_PUSH(*slip, status == OK ? both[0] : zero);
    LIST_PUSH(*off, status == OK ? both[1] : zero);
    return OK;
}

/* the bound of what is slid along, per unit of its load where it has one; 0: it has none */
static Expr share_of(const VariableIndex *l, int i, bool at_rest)
{
    const Surface *surface = &l->surfaces[i];
    const Expr bound = at_rest ? surface->hold : surface->bound;
    const Expr one = expr_int(system_arena(l->system), 1);

    if (bound == NULL)
        return expr_int(system_arena(l->system), 0);
    return surface->load < 0 ? bound
                             : expr_substitute(system_arena(l->system), bound,
                                               &l->surfaces[surface->load].sign, &one, 1);
}

/* pushes a share for each sign, those of components after all others */
static void push_shares(const VariableIndex *l, bool at_rest, CompiledRoots *out)
{
    for (int i = 0; i < l->surface_count; i++)
        LIST_PUSH(*out, share_of(l, i, at_rest));
    for (int i = 0; i < l->surface_count; i++)
        for (int k = 0; k < l->surfaces[i].part_count; k++)
            LIST_PUSH(*out, share_of(l, i, at_rest));
}

/* slip at each sign, then `off` at each, 0 where slip can't be determined; then the kinetic share
 * of each and that at rest */
static Status compile_slip(CompiledEquations *nb, Diag *diag)
{
    const VariableIndex *l = nb->layout;
    const Expr zero = expr_int(system_arena(l->system), 0);
    CompiledRoots roots = {0};
    CompiledRoots off = {0};
    Status status = OK;

    for (int i = 0; i < l->surface_count; i++)
        CHECK(push_slip(l, l->surfaces[i].part_count > 0 ? zero : l->surfaces[i].measure, &roots,
                        &off, diag));
    for (int i = 0; i < l->surface_count; i++) {
        Expr measures[SURFACE_PARTS];
        const int count = measures_of(l, i, measures);

        for (int k = 0; k < count && l->surfaces[i].part_count > 0; k++)
            CHECK(push_slip(l, measures[k], &roots, &off, diag));
    }
    for (int i = 0; i < off.count; i++)
        LIST_PUSH(roots, off.at[i]);
    push_shares(l, false, &roots);
    push_shares(l, true, &roots);
    CHECK(probe_new(l, nb->parameters, roots.at, roots.count, &nb->slip, diag));
done:
    LIST_FREE(roots);
    LIST_FREE(off);
    return status;
}

Status compiled_slide(CompiledEquations *nb, const OnSurface *on, Diag *diag)
{
    const VariableIndex *l = nb->layout;
    bool any = false, before;
    Status status;

    for (int i = 0; i < l->surface_count; i++) {
        Expr slip, off, measures[SURFACE_PARTS];
        const int count = measures_of(l, i, measures);

        if (on[i].side != 0)
            continue;
        for (int k = 0; k < count; k++)
            TRY(slip_of(l, measures[k], &slip, &off, diag));
        any = true;
    }
    if (!any || nb->slip != NULL)
        return OK;
    mem_keep(nb);
    before = mem_scratch(true);
    status = compile_slip(nb, diag);
    (void)mem_scratch(before);
    return status;
}

/* the two conditions of a surface that is on that side, or slid along */
static void set_guards(Guard *both, const VariableIndex *l, int i, SurfaceGuards own)
{
    const OnSurface *on = &l->on[i];
    const Surface *surface = &l->surfaces[i];
    const Guard none = {.surface = on->surface, .is_idle = true};
    const bool is_norm = surface->law.is_norm;
    const bool has_load = surface->load >= 0;

    both[0] = both[1] = none;
    if (has_load && l->on[surface->load].side != 0) {
        both[0].waits = true;
        both[0].is_norm = is_norm;
        both[0].load = l->surfaces[surface->load].number + 1;
        return;
    }
    if (on->side == 0) {
        both[0] = (Guard){.surface = on->surface, .end = 1, .is_norm = is_norm};
        if (!is_norm)
            both[1] = (Guard){.surface = on->surface, .end = -1};
        return;
    }
    both[0] = is_measured(own) ? (Guard){.surface = on->surface,
                                         .side = on->side,
                                         .held = on->held,
                                         .solved = own.stage == STAGE_NETWORK,
                                         .is_unilateral = surface->law.is_unilateral,
                                         .is_of_event = surface_rests(surface->law.ratio),
                                         .is_norm = is_norm}
                               : none;
    both[1] = none;
    if (has_load)
        both[0].load = l->surfaces[surface->load].number + 1;
}

/* Sign: -1 to 1. Stick: -r to r, with 1 where it slips. Unilateral: 0 and above. Of a vector the
 * signs of components have a bound on their norm alone. */
static SignRange range_of(const CompiledEquations *nb, int slid)
{
    const int i = nb->layout->slid_surface[slid];
    const Surface *surface = &nb->layout->surfaces[i];
    const double ratio =
        surface->law.ratio != NULL
            ? expr_evaluate(surface->law.ratio, parameters_value_in, nb->parameters)
            : 1;
    SignRange range = {.low = -INFINITY, .high = INFINITY, .load = -1, .norm = ratio};

    if (surface->law.is_unilateral)
        return (SignRange){
            .high = INFINITY, .is_unilateral = true, .restitution = ratio, .load = -1};
    range.has_bound = surface->bound != NULL;
    if (!range.has_bound && !surface->law.is_norm)
        return (SignRange){.low = -ratio, .high = ratio, .below = -1, .above = 1, .load = -1};
    for (int k = 0; k < nb->layout->slides && range.has_bound; k++)
        if (nb->layout->slid_surface[k] == surface->load)
            range.load = k;
    if (surface->law.is_norm)
        range.cone = nb->layout->slid[slid] == nb->layout->first_part[i] ? surface->part_count : -1;
    return range;
}

void compiled_enter_mode(CompiledEquations *nb)
{
    const VariableIndex *l = nb->layout;
    const bool slides = l->slides > 0;

    nb->eq.sign_count = l->sign_count;
    nb->eq.slide_count = l->slides;
    nb->eq.slide = slide;
    nb->eq.slip = slip;
    if (nb->sign_ranges == NULL)
        nb->eq.sign_ranges = nb->sign_ranges = NEW_ARRAY(SignRange, l->sign_count);
    for (int k = 0; k < l->slides; k++)
        nb->sign_ranges[k] = range_of(nb, k);
    for (int i = 0; i < l->surface_count && nb->guards != NULL; i++)
        set_guards(nb->guards + nb->of_surface[i].first, l, i, nb->of_surface[i]);
    nb->eq.switches_read_network = nb->guards_read_network || slides;
    nb->eq.switches_follow_time =
        nb->guards_follow_time || (slides && variable_index_signs_follow_time(l));
}

Expr compiled_condition(const CompiledEquations *nb, int i)
{
    return nb->shown_guards[i];
}

int compiled_margin(const CompiledEquations *nb, int i)
{
    return nb->margins.at[i - (nb->eq.switch_count - nb->eq.margin_count)];
}
