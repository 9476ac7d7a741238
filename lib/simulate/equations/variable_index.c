/* variable_index.c: the order of inputs of all programs over one system */
#include "simulate/equations/variable_index.h"

#include "base/memory.h"
#include "base/names.h"

#include <string.h>

static int append(VariableIndex *layout, int *room, Expr symbol)
{
    if (layout->count == *room) {
        *room = *room < 32 ? 64 : 2 * *room;
        layout->symbols = mem_grow(layout->symbols, (size_t)*room, sizeof(Expr));
    }
    layout->symbols[layout->count] = symbol;
    return layout->count++;
}

static Expr jerk_symbol(System *system, int i)
{
    Text name = {0};
    Expr symbol;

    text_addf(&name, "%s'", expr_name(system_acceleration(system, i)));
    symbol = expr_symbol(system_arena(system), name.at, SYMBOL_JERK);
    text_free(&name);
    return symbol;
}

/* Whether a condition jumps on surfaces itself, which then are inner ones. */
static bool is_nested(System *system, Expr condition)
{
    return switch_jumps_over(system_arena(system), condition, ~0U);
}

/* The measure of a surface contains the signs of inner ones: as often as they are nested. */
static void find_measures(VariableIndex *l)
{
    Arena *arena = system_arena(l->system);
    bool changed = true;

    for (int turn = 0; turn < l->surface_count && changed; turn++) {
        changed = false;
        for (int i = 0; i < l->surface_count; i++) {
            Surface *surface = &l->surfaces[i];
            int way;
            Expr measure;

            if (!is_nested(l->system, surface->condition) || surface->law.is_norm)
                continue;
            measure = surface_of(
                arena,
                surfaces_substitute(arena, surface->condition, l->surfaces, l->surface_count),
                &way);
            changed = changed || measure != surface->measure;
            surface->measure = measure;
        }
    }
}

static Expr with_signs(const VariableIndex *l, Expr e)
{
    Arena *arena = system_arena(l->system);

    return expr_open(arena, surfaces_substitute(arena, e, l->surfaces, l->surface_count));
}

/* The bound of a surface with signs of others in it, and which of these is its load. */
static void find_bounds(VariableIndex *l)
{
    for (int i = 0; i < l->surface_count; i++) {
        Surface *surface = &l->surfaces[i];
        SystemSurface known = {.load = -1};

        if (surface->law.bound == NULL)
            continue;
        surface->bound = with_signs(l, surface->law.bound);
        surface->hold = with_signs(l, surface->law.hold);
        (void)system_surface(l->system, surface->number, &known);
        for (int k = 0; k < l->surface_count; k++)
            if (l->surfaces[k].number == known.load)
                surface->load = k;
    }
}

/* the components of a vector, each with a sign */
static void place_parts(VariableIndex *l, int i, const SystemSurface *known)
{
    Surface *surface = &l->surfaces[i];

    surface->part_count = known->part_count;
    l->first_part[i] = l->sign_count;
    l->sign_count += known->part_count;
    for (int k = 0; k < known->part_count; k++) {
        Text name = {0};

        text_addf(&name, "#sign %d.%d", surface->number + 1, k + 1);
        surface->part[k] = known->part[k];
        surface->part_sign[k] = expr_symbol(system_arena(l->system), name.at, SYMBOL_STATE);
        text_free(&name);
    }
}

static void place_surfaces(VariableIndex *l, const OnSurface *on, int count)
{
    const int most = count * (1 + SURFACE_PARTS);

    l->surfaces = NEW_ARRAY(Surface, count);
    l->on = NEW_ARRAY(OnSurface, count);
    l->first_part = NEW_ARRAY(int, count);
    l->slid = NEW_ARRAY(int, most);
    l->slid_surface = NEW_ARRAY(int, most);
    l->sign_values = NEW_ARRAY(double, most);
    l->sign_count = count;
    for (int i = 0; i < count; i++) {
        Surface *surface = &l->surfaces[i];
        SystemSurface known = {0};
        Text name = {0};

        (void)system_surface(l->system, on[i].surface, &known);
        text_addf(&name, "#sign %d", on[i].surface + 1);
        *surface = (Surface){.number = on[i].surface,
                             .condition = known.condition,
                             .law = known.law,
                             .bound = known.law.bound,
                             .hold = known.law.hold,
                             .load = -1,
                             .may_slide = true,
                             .sign = expr_symbol(system_arena(l->system), name.at, SYMBOL_STATE),
                             .measure = known.condition};
        place_parts(l, i, &known);
        text_free(&name);
    }
    l->surface_count = count;
    find_measures(l);
    find_bounds(l);
    variable_index_set_on(l, on);
}

bool variable_index_has_surfaces(const VariableIndex *l, const OnSurface *on, int count)
{
    bool same = l->surface_count == count;

    for (int i = 0; i < count && same; i++)
        same = l->surfaces[i].number == on[i].surface;
    return same;
}

bool variable_index_is_on(const VariableIndex *l, const OnSurface *on)
{
    bool same = true;

    for (int i = 0; i < l->surface_count && same; i++)
        same = on_surface_is(&l->on[i], &on[i]);
    return same;
}

/* The sign of the surface is unknown, or those of its components are. */
static void slide_along(VariableIndex *l, int i)
{
    const int count = l->surfaces[i].part_count;

    for (int k = 0; k < (count > 0 ? count : 1); k++) {
        const int sign = count > 0 ? l->first_part[i] + k : i;

        l->slid_surface[l->slides] = i;
        l->slid[l->slides++] = sign;
        l->sign_values[sign] = 0;
    }
}

void variable_index_set_on(VariableIndex *l, const OnSurface *on)
{
    l->slides = 0;
    for (int i = l->surface_count; i < l->sign_count; i++)
        l->sign_values[i] = 0; /* those of components act on their surface alone */
    for (int i = 0; i < l->surface_count; i++) {
        l->on[i] = on[i];
        l->sign_values[i] = l->surfaces[i].law.is_unilateral ? 0
                            : on[i].held                     ? on[i].side * on[i].most
                                                             : on[i].side;
        if (on[i].side == 0)
            slide_along(l, i);
    }
    l->sides++;
}

static void find_sides(VariableIndex *l)
{
    int count = system_ideal_count(l->system);
    bool any = false;

    l->side = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++) {
        l->side[i] = system_side(l->system, i);
        any = any || l->side[i] != NULL;
    }
    l->closed = NEW_ARRAY(bool, count);
    l->switches = any ? count : 0;
}

void variable_index_set_sides(VariableIndex *l, const bool *closed)
{
    bool changed = false;

    for (int i = 0; i < l->switches; i++) {
        changed = changed || (l->side[i] != NULL && l->closed[i] != closed[i]);
        l->closed[i] = closed[i];
    }
    l->sides += changed;
}

VariableIndex *variable_index_new(System *system)
{
    return variable_index_new_on(system, NULL, 0);
}

VariableIndex *variable_index_new_on(System *system, const OnSurface *on, int count)
{
    VariableIndex *l = NEW(VariableIndex);
    int room = 0;

    l->system = system;
    if (on != NULL)
        place_surfaces(l, on, count);
    l->n = system_n(system);
    l->nu = system_nu(system);
    l->m = system_m(system);
    l->position_rows = system_position_rows(system);
    l->nx = system_nx(system);
    l->nz = system_nz(system);
    l->t = append(l, &room, expr_symbol(system_arena(system), "t", SYMBOL_TIME));
    l->multi_turns = system_multi_turn_count(system);
    l->references = l->count;
    for (int i = 0; i < l->multi_turns; i++)
        (void)append(l, &room, system_multi_turn(system, i)->reference);
    l->q = l->count;
    for (int i = 0; i < l->n; i++)
        (void)append(l, &room, system_q(system, i)->symbol);
    l->u = l->count;
    for (int i = 0; i < l->nu; i++)
        (void)append(l, &room, system_u(system, i)->symbol);
    l->x = l->count;
    for (int i = 0; i < l->nx; i++)
        (void)append(l, &room, system_x(system, i)->symbol);
    l->signs = l->count;
    for (int i = 0; i < l->surface_count; i++)
        (void)append(l, &room, l->surfaces[i].sign);
    for (int i = 0; i < l->surface_count; i++)
        for (int k = 0; k < l->surfaces[i].part_count; k++)
            (void)append(l, &room, l->surfaces[i].part_sign[k]);
    l->rates = l->count;
    for (int i = 0; i < l->nx; i++)
        (void)append(l, &room, system_state_rate(system, i));
    l->z = l->count;
    for (int i = 0; i < l->nz; i++)
        (void)append(l, &room, system_z(system, i)->symbol);
    l->acceleration = l->count;
    for (int i = 0; i < l->nu; i++)
        (void)append(l, &room, system_acceleration(system, i));
    l->multipliers = l->count;
    for (int k = 0; k < l->m; k++)
        (void)append(l, &room, system_multiplier(system, k));
    l->efforts = l->count;
    for (int k = 0; k < system_drive_count(system); k++) {
        Expr effort = system_drive(system, k)->effort;

        /* a driver's own effort is minus its multiplier, and not a further unknown */
        if (expr_kind(effort) == EXPR_SYMBOL && expr_symbol_kind(effort) == SYMBOL_EFFORT)
            (void)append(l, &room, effort);
    }
    for (int k = 0; system_open_potential(system, k) != NULL; k++)
        (void)append(l, &room, system_open_potential(system, k));
    l->ne = l->count - l->efforts;
    find_sides(l);
    l->jerk = l->count;
    for (int i = 0; i < l->nu; i++)
        (void)append(l, &room, jerk_symbol(system, i));
    return l;
}

Expr *variable_index_network(const VariableIndex *l)
{
    Expr *out = NEW_ARRAY(Expr, 2 * l->nx + l->nz);

    memcpy(out, l->symbols + l->x, (size_t)l->nx * sizeof(Expr));
    memcpy(out + l->nx, l->symbols + l->rates, (size_t)(l->nx + l->nz) * sizeof(Expr));
    return out;
}

int *variable_index_blocks(const VariableIndex *l)
{
    Names *names = names_borrowing();
    int *blocks = NEW_ARRAY(int, l->count);
    const Instanced *one;

    for (int i = 0; (one = system_instanced(l->system, i)) != NULL; i++)
        if (one->outer < 0)
            (void)names_add(names, one->name);
    for (int i = 0; i < l->count; i++) {
        const char *name = expr_name(l->symbols[i]), *dot = strchr(name, '.');

        blocks[i] = dot != NULL ? names_find_part(names, name, (size_t)(dot - name)) + 1 : 0;
    }
    names_free(names);
    return blocks;
}

int variable_index_side_of(const VariableIndex *layout, Expr symbol)
{
    for (int i = 0; i < layout->switches; i++)
        if (layout->side[i] == symbol)
            return i;
    return -1;
}

void variable_index_free(VariableIndex *layout)
{
    if (layout == NULL)
        return;
    MEM_FREE(layout->symbols, layout->side, layout->closed, layout->surfaces, layout->on,
             layout->slid, layout->slid_surface, layout->first_part, layout->sign_values, layout);
}

static unsigned network_kinds(const VariableIndex *l)
{
    const EquationForm *run = system_run(l->system);
    unsigned kinds = 0;

    for (int i = 0; i < l->nx + l->nz; i++)
        kinds |= expr_kinds(run->network_residual[i]);
    return kinds;
}

bool variable_index_follows_time(const VariableIndex *l, const Expr *roots, int count)
{
    const unsigned solved = 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE;
    unsigned kinds = 0;

    for (int i = 0; i < count; i++)
        kinds |= expr_kinds(roots[i]);
    if ((kinds & solved) != 0)
        kinds |= network_kinds(l);
    return (kinds & 1U << SYMBOL_TIME) != 0;
}

bool variable_index_signs_follow_time(const VariableIndex *l)
{
    unsigned kinds = network_kinds(l);

    for (int i = 0; i < l->nu; i++)
        kinds |= expr_kinds(system_run(l->system)->force[i]);
    return (kinds & 1U << SYMBOL_TIME) != 0;
}

Expr variable_index_on_surfaces(const VariableIndex *l, Expr e)
{
    return surfaces_substitute(system_arena(l->system), e, l->surfaces, l->surface_count);
}
