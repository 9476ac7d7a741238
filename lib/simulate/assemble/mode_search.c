/* mode_search.c: sides of ideal switches behind an instant */
#include "simulate/assemble/mode_search_impl.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

#define NOISE      1e-12 /* of the largest current or voltage: too small to tell a side from, */
#define MOST_NOISE 1e-8  /* or where that leads in circles, up to this */
#define LARGER     30    /* times the leak of closed switches that rounding swallows, */
#define LARGEST    1e4   /* up to so many */
#define ROUNDING   1e-15 /* of the largest voltage, in that of a closed one with a resistance */
#define FORGET     0.5   /* of the largest current or voltage from instant to instant: surges end */
#define PIECES     8     /* of a jump, along which laws are integrated */
#define ROUNDS     8     /* in which conditions and diodes may set each other off */

/* --- equations --- */

RowValues mode_search_row(const ModeSearch *s, const double *w)
{
    return (RowValues){.t = s->at->t + s->step,
                       .references = s->at->references,
                       .q = s->at->q,
                       .u = s->at->u,
                       .x = s->x,
                       .rates = w,
                       .z = w + s->l->nx,
                       .acceleration = s->at->acceleration,
                       .multipliers = s->at->multipliers};
}

static bool is_in_force(const ModeSearch *s, const ResidualRow *row)
{
    return row->when == ALWAYS || s->closed[row->ideal] == (row->when == CLOSED);
}

static void take_step(ModeSearch *s, const double *w)
{
    for (int i = 0; i < s->l->nx; i++)
        s->x[i] = s->from[i] + s->step * w[i];
}

/* Rows and entries from what the probe has found; `averaged` or all, and these then by so much. By
 * state is times h: x = x0 + h x'. */
static void bring_rows(ModeSearch *s, const double *values, bool averaged, double weight,
                       double along)
{
    int count;
    const Slope *slopes = residual_slopes(probe_residual(s->equations), &count);

    for (int k = 0; k < s->rows.count; k++) {
        const ResidualRow *row = &s->rows.at[k];

        if (row->averaged >= averaged && is_in_force(s, row))
            s->residual[row->row] += weight * values[k];
    }
    for (int k = 0; k < count; k++) {
        const ResidualRow *row = &s->rows.at[slopes[k].row];

        if (row->averaged >= averaged && is_in_force(s, row))
            s->network[s->place[k]] += weight *
                                       (slopes[k].unknown < s->l->nx ? along * s->step : 1) *
                                       values[s->rows.count + k];
    }
}

/* Rows that hold rates as their mean along the straight line from x0 to x: so what is stored
 * changes by what flows, however far. By Gauss's rule. */
static void bring_means(ModeSearch *s, const double *w)
{
    static const double place[] = {0.5, 0.5 - 0.26923465505284155, 0.5 + 0.26923465505284155,
                                   0.5 - 0.45308992296933193, 0.5 + 0.45308992296933193};
    static const double weight[] = {0.28444444444444444, 0.23931433524968324, 0.23931433524968324,
                                    0.11846344252809454, 0.11846344252809454};

    for (int k = 0; k < COUNT(place) * PIECES; k++) {
        const int piece = k / COUNT(place);
        const double along = (place[k % COUNT(place)] + piece) / PIECES;
        RowValues row;

        for (int i = 0; i < s->l->nx; i++)
            s->x[i] = s->from[i] + along * s->step * w[i];
        row = mode_search_row(s, w);
        bring_rows(s, probe_values(s->equations, &row), true, weight[k % COUNT(place)] / PIECES,
                   along);
    }
    take_step(s, w);
}

static void clear_means(ModeSearch *s)
{
    int count;
    const Slope *slopes = residual_slopes(probe_residual(s->equations), &count);

    for (int k = 0; k < s->rows.count; k++)
        if (s->rows.at[k].averaged)
            s->residual[s->rows.at[k].row] = 0;
    for (int k = 0; k < count; k++)
        if (s->rows.at[slopes[k].row].averaged)
            s->network[s->place[k]] = 0;
}

static void network_at(void *context, const double *w)
{
    ModeSearch *s = context;
    RowValues row;

    take_step(s, w);
    row = mode_search_row(s, w);
    memset(s->network, 0, (size_t)s->pattern.count * sizeof(double));
    memset(s->residual, 0, (size_t)s->n * sizeof(double));
    bring_rows(s, probe_values(s->equations, &row), false, 1, 1);
    if (s->averages) {
        clear_means(s);
        bring_means(s, w);
    }
}

/* a linear network is solved at once: A w = r, r = -G at w = 0 */
static void bring_linear(ModeSearch *s)
{
    network_at(s, s->zeros);
    for (int i = 0; i < s->n; i++)
        s->rhs[i] = -s->residual[i];
}

/* --- making --- */

typedef LIST(Expr) ModeSearchRoots;

/* one row, or one side of it */
static void add_row(ModeSearch *s, ModeSearchRoots *roots, int row, Expr residual, int ideal,
                    When when)
{
    const bool averaged = (expr_kinds(residual) & 1U << SYMBOL_STATE_RATE) != 0;

    LIST_PUSH(s->rows,
              (ResidualRow){.row = row, .ideal = ideal, .when = when, .averaged = averaged});
    LIST_PUSH(*roots, variable_index_on_surfaces(s->l, residual));
}

/* closed: v - least = on i; open: i = v/off, or 0; and a leak beside each */
static void add_sides(ModeSearch *s, ModeSearchRoots *roots, int k, const IdealSwitch *ideal)
{
    Arena *arena = system_arena(s->l->system);
    Expr v = expr_add(arena, ideal->across, ideal->least);
    Expr closed =
        expr_sub(arena, ideal->across,
                 expr_mul(arena, expr_add(arena, ideal->on, s->closed_leak), ideal->through));
    Expr open = ideal->off != NULL
                    ? expr_sub(arena, v, expr_mul(arena, ideal->off, ideal->through))
                    : expr_sub(arena, ideal->through, expr_mul(arena, s->open_leak, ideal->across));

    add_row(s, roots, ideal->row, closed, k, CLOSED);
    add_row(s, roots, ideal->row, open, k, OPEN);
}

static Status refuse_form(const ModeSearch *s, const char *name, Diag *diag)
{
    (void)diag_set(diag, E_MODEL, "%s is ideal, and each side of it makes another tree", name);
    diag_hint(diag, system_network_form(s->l->system) == NETWORK_TREE
                        ? "'set network state' runs it; the form of the user's tree wants Ron= and "
                          "Roff="
                        : "this network has no state form: give it Ron= and Roff=");
    return E_MODEL;
}

/* both sides of a switch share their places, and x and x' theirs */
static Status compile_rows(ModeSearch *s, Parameters *parameters, const ModeSearchRoots *roots,
                           Diag *diag)
{
    const unsigned solved = 1U << SYMBOL_STATE | 1U << SYMBOL_STATE_RATE | 1U << SYMBOL_ALGEBRAIC;
    Expr *unknowns = variable_index_network(s->l);
    const ProbeOrder order = {.roots = roots->at,
                              .root_count = roots->count,
                              .row_count = roots->count,
                              .unknowns = unknowns,
                              .unknown_count = 2 * s->l->nx + s->l->nz};
    int *row = NULL, *column = NULL, count;
    const Slope *slopes;
    Status status = OK;

    CHECK(probe_make(s->l, parameters, &order, &s->equations, diag));
    slopes = residual_slopes(probe_residual(s->equations), &count);
    row = NEW_ARRAY(int, count);
    column = NEW_ARRAY(int, count);
    for (int k = 0; k < count; k++) {
        const int by = slopes[k].unknown;

        row[k] = s->rows.at[slopes[k].row].row;
        column[k] = by < s->l->nx ? by : by - s->l->nx;
        s->is_linear = s->is_linear && (slopes[k].kinds & solved) == 0;
    }
    s->place = NEW_ARRAY(int, count);
    s->pattern = pattern_of(s->n, s->n, count, row, column, s->place);
done:
    MEM_FREE(unknowns, row, column);
    return status;
}

static Status compile(ModeSearch *s, Parameters *parameters, Diag *diag)
{
    const EquationForm *run = system_run(s->l->system);
    Arena *arena = system_arena(s->l->system);
    bool *taken = NEW_ARRAY(bool, s->n);
    ModeSearchRoots roots = {0};
    LIST(Expr) looks = {0};
    ScalarPair edge;
    const bool of_tree =
        system_network_form(s->l->system) == NETWORK_TREE && !system_tree_is_normal(s->l->system);
    Status status = OK;

    for (int k = 0; k < s->count; k++) {
        IdealSwitch ideal;

        CHECK(system_ideal(s->l->system, k, &ideal, diag));
        if (ideal.closed == NULL && (ideal.row < 0 || of_tree)) {
            status = refuse_form(s, ideal.name, diag);
            goto done;
        }
        if (ideal.closed == NULL) {
            taken[ideal.row] = true;
            add_sides(s, &roots, k, &ideal);
        }
        s->has_when[k] = ideal.when != NULL;
        s->domain[k] = ideal.domain;
        LIST_PUSH(looks, ideal.through);
        LIST_PUSH(looks, ideal.across);
        LIST_PUSH(looks, ideal.when != NULL ? ideal.when : expr_int(arena, 0));
        LIST_PUSH(looks, ideal.on);
    }
    for (int i = 0; i < s->n; i++)
        if (!taken[i])
            add_row(s, &roots, i, run->network_residual[i], 0, ALWAYS);
    for (int i = 0; i < s->edges; i++) {
        CHECK(system_scalar(s->l->system, i, &edge, diag));
        s->domain[s->count + i] = edge.domain;
        s->gives[i] = !edge.stores && !edge.switches;
        s->source[2 * i] = edge.gives_across ? edge.name : NULL;
        s->source[2 * i + 1] = edge.gives_through ? edge.name : NULL;
        LIST_PUSH(looks, edge.across);
        LIST_PUSH(looks, edge.through);
    }
    for (int i = 0; i < looks.count; i++)
        looks.at[i] = variable_index_on_surfaces(s->l, looks.at[i]);
    CHECK(compile_rows(s, parameters, &roots, diag));
    CHECK(probe_new(s->l, parameters, looks.at, looks.count, &s->looks, diag));
done:
    LIST_FREE(roots);
    LIST_FREE(looks);
    mem_free(taken);
    return status;
}

/* A layout on which nothing unilateral holds: its effort has no value beyond the surface, where a
 * step may lead that takes no part in holding it. */
static VariableIndex *open_unilateral(System *system)
{
    LIST(OnSurface) on = {0};
    SystemSurface surface;
    VariableIndex *out;

    for (int i = 0; system_surface(system, i, &surface); i++)
        if (surface.law.is_unilateral)
            LIST_PUSH(on, (OnSurface){.surface = i, .side = -1});
    out = variable_index_new_on(system, on.at, on.count);
    LIST_FREE(on);
    return out;
}

Status mode_search_new(System *system, Parameters *parameters, ModeSearch **out, Diag *diag)
{
    ModeSearch *s = NEW(ModeSearch);
    Status status = OK;

    s->l = open_unilateral(system);
    s->n = s->l->nx + s->l->nz;
    s->is_linear = true;
    s->count = system_ideal_count(system);
    s->has_when = NEW_ARRAY(bool, s->count);
    s->x = NEW_ARRAY(double, s->l->nx);
    s->through = NEW_ARRAY(double, s->count);
    s->across = NEW_ARRAY(double, s->count);
    s->on = NEW_ARRAY(double, s->count);
    s->edges = system_scalar_count(system);
    s->domain = NEW_ARRAY(Domain, s->count + s->edges);
    s->source = NEW_ARRAY(const char *, 2 * s->edges);
    s->gives = NEW_ARRAY(bool, s->edges);
    s->closed_leak = expr_symbol(system_arena(system), "#closed leak", SYMBOL_PARAMETER);
    s->open_leak = expr_symbol(system_arena(system), "#open leak", SYMBOL_PARAMETER);
    parameters_set(parameters, s->closed_leak, CLOSED_LEAK);
    parameters_set(parameters, s->open_leak, OPEN_LEAK);
    CHECK(compile(s, parameters, diag));
    s->network = NEW_ARRAY(double, s->pattern.count);
    s->residual = NEW_ARRAY(double, s->n);
    s->rhs = NEW_ARRAY(double, s->n);
    s->zeros = NEW_ARRAY(double, s->n);
    s->eq = (Equations){.nx = s->l->nx,
                        .nz = s->l->nz,
                        .context = s,
                        .network_at = s->is_linear ? NULL : network_at,
                        .network_entries = s->pattern.count,
                        .network_row = s->pattern.row,
                        .network_column = s->pattern.column,
                        .network = s->network,
                        .network_rhs = s->rhs,
                        .network_residual = s->residual};
    s->solve = netsolve_new(&s->eq);
    *out = s;
    s = NULL;
done:
    mode_search_free(s);
    return status;
}

void mode_search_free(ModeSearch *s)
{
    if (s == NULL)
        return;
    netsolve_free(s->solve);
    probe_free(s->equations);
    probe_free(s->looks);
    LIST_FREE(s->rows);
    pattern_free(&s->pattern);
    MEM_FREE(s->place, s->network, s->residual, s->rhs, s->zeros, s->has_when, s->x, s->through,
             s->across, s->on, s->domain, s->source, s->gives);
    variable_index_free(s->l);
    mem_free(s);
}

double mode_search_largest(const ModeSearch *s, Domain domain, bool through)
{
    return s->known[domain][through];
}

/* --- sides --- */

static const char *name_of(const ModeSearch *s, int k)
{
    IdealSwitch ideal;

    return system_ideal(s->l->system, k, &ideal, NULL) == OK ? ideal.name : "";
}

bool mode_search_solve(ModeSearch *s)
{
    double *w = netsolve_values(s->solve);
    RowValues row;
    const double *values;

    variable_index_set_sides(s->l, s->closed);
    if (s->is_linear)
        bring_linear(s);
    if (!netsolve_find(s->solve))
        return false;
    if (s->is_linear && s->n > 0) {
        network_at(s, w);
        netsolve_refine(s->solve);
    }
    take_step(s, w);
    row = mode_search_row(s, w);
    values = probe_values(s->looks, &row);
    for (int k = 0; k < s->count; k++) {
        s->through[k] = values[LOOKS * k + THROUGH];
        s->across[k] = values[LOOKS * k + ACROSS];
        s->on[k] = values[LOOKS * k + ON];
    }
    memset(s->largest, 0, sizeof s->largest);
    for (int i = 0; i < s->edges; i++)
        for (int side = 0; side < 2; side++) {
            double *largest = &s->largest[s->domain[s->count + i]][side];

            *largest = fmax(*largest, fabs(values[LOOKS * s->count + 2 * i + side]));
        }
    return true;
}

static bool is_wrong(const ModeSearch *s, int k)
{
    Domain domain = s->domain[k];
    int side = s->closed[k];
    double least = s->noise * fmax(s->largest[domain][side], s->known[domain][side]);

    if (s->closed[k] &&
        s->on[k] > 0) /* the current is a small difference over a small resistance */
        least = fmax(least, s->noise / NOISE * ROUNDING * s->largest[domain][0] / s->on[k]);
    return !s->has_when[k] && (s->closed[k] ? s->through[k] < -least : s->across[k] > least);
}

/* Diodes go over until none is wrong: all that are at a time, and where that goes in circles the
 * first of them alone, which ends wherever the network is passive. */
static bool settle_with(ModeSearch *s, int together, int most)
{
    for (int turn = 0; turn < most; turn++) {
        bool right = true;

        if (!mode_search_solve(s))
            return false;
        for (int k = 0; k < s->count && (right || turn < together); k++)
            if (is_wrong(s, k)) {
                s->closed[k] = !s->closed[k];
                right = false;
            }
        if (right)
            return true;
    }
    return false;
}

void mode_search_leak(ModeSearch *s, double closed, double open)
{
    (void)probe_turn(s->equations, s->closed_leak, closed * CLOSED_LEAK);
    (void)probe_turn(s->equations, s->open_leak, open * OPEN_LEAK);
}

/* Where circles are so small that rounding may be what makes them, that is taken for nothing. */
static bool settle_diodes(ModeSearch *s)
{
    int together = 2 * s->count + 8;
    int most = 1 << (s->count < 12 ? s->count : 12);

    for (s->noise = NOISE; s->noise < MOST_NOISE; s->noise *= 10)
        if (settle_with(s, together, 2 * together))
            return true;
    return settle_with(s, together, together + most);
}

/* What closed switches in parallel share is told by their leaks alone. Beside large resistances
 * rounding swallows these, and larger ones tell it. */
static bool settle_shares(ModeSearch *s)
{
    bool settled = settle_diodes(s);

    for (double leak = LARGER; !settled && leak <= LARGEST; leak *= LARGER) {
        mode_search_leak(s, leak, 1);
        settled = settle_diodes(s);
    }
    mode_search_leak(s, 1, 1);
    return settled;
}

/* Sides of switches with a condition, from states as they go on and what else is known. True:
 * one of them goes over, *which. */
static bool follow_conditions(ModeSearch *s, int *which)
{
    const double *w = netsolve_values(s->solve);
    RowValues row = mode_search_row(s, w);
    const double *values;
    bool changed = false;

    row.x = s->at->x_behind;
    row.t = s->at->when;
    values = probe_values(s->looks, &row);
    for (int k = 0; k < s->count; k++) {
        bool wanted = values[LOOKS * k + WHEN] != 0;

        if (!s->has_when[k] || s->closed[k] == wanted)
            continue;
        s->closed[k] = wanted;
        *which = k;
        changed = true;
    }
    return changed;
}

static Status report_none(const ModeSearch *s, Diag *diag)
{
    Text names = {0};

    for (int k = 0; k < s->count && k < 8; k++)
        text_addf(&names, "%s%s", k > 0 ? ", " : "", name_of(s, k));
    (void)diag_set(diag, E_SOLVER,
                   "at t = %.9g s the network has no solution, whichever of %s%s are closed",
                   s->at->t, names.at, s->count > 8 ? " ..." : "");
    diag_hint(diag, "give a switch or diode where sources or currents meet it Ron= and Roff=, "
                    "such as Ron=1 mohm Roff=1 Mohm");
    text_free(&names);
    return E_SOLVER;
}

Status mode_search_find(ModeSearch *s, const ModeSearchAt *at, bool *closed, Diag *diag)
{
    size_t bytes = (size_t)s->count * sizeof(bool);
    bool *before = NEW_ARRAY(bool, s->count);
    int which = 0;
    Status status = OK;

    s->at = at;
    s->from = at->x;
    s->step = at->step;
    s->closed = closed;
    memcpy(before, closed, bytes);
    memset(netsolve_values(s->solve), 0, (size_t)s->l->nx * sizeof(double));
    for (int round = 0;; round++) {
        if (!settle_shares(s)) {
            status = report_none(s, diag);
            goto done;
        }
        if (!follow_conditions(s, &which))
            break;
        if (round == ROUNDS) {
            status = diag_set(diag, E_SOLVER,
                              "at t = %.9g s %s is neither closed nor open: what it does makes its "
                              "condition say the contrary",
                              at->t, name_of(s, which));
            diag_hint(diag, "let the condition read states, or leave a gap between two conditions");
            goto done;
        }
    }
    for (int i = 0; i < DOMAIN_COUNT; i++)
        for (int side = 0; side < 2; side++)
            s->known[i][side] = fmax(FORGET * s->known[i][side], s->largest[i][side]);
done:
    if (status != OK)
        memcpy(closed, before, bytes);
    mem_free(before);
    return status;
}
