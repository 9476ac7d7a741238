/* equilibrium_residual.c: a system at rest: its rows, their derivatives, and the map from steps to
 * coordinates */
#include "simulate/analyse/equilibrium_residual.h"

#include "algebra/linear.h"
#include "algebra/pattern.h"
#include "base/memory.h"
#include "base/text.h"
#include "compile/jacobian.h"
#include "simulate/analyse/analyse_limits.h"
#include "simulate/equations/rows.h"

#include <math.h>
#include <string.h>

/* dq/ds by coordinates: entries of coordinate i are start[i] up to before start[i + 1]. Those of
 * four Euler parameters have the same speeds in the same order. */
typedef struct Map {
    int *start, *speed;
    Probe *probe; /* computes N and multi-turn angles */
    double *base; /* N(q0) */
} Map;

/* derivatives of the rows by unknowns, or by their rates */
typedef struct EquilibriumResidualPart {
    Jacobian *jacobian;
    double *values;
    int *place; /* positions in the whole Jacobian */
} EquilibriumResidualPart;

/* A unilateral surface h <= 0. Its effort is max(0, known + stiffness h), and `known` becomes that
 * until h = 0 or the effort is 0 (augmented Lagrangian: Bertsekas, Constrained Optimization and
 * Lagrange Multiplier Methods, 1982). */
typedef struct UnilateralEffort {
    Expr guard, symbol; /* h, and of `known` */
    double known;
} UnilateralEffort;

struct EquilibriumResidual {
    System *system;
    VariableIndex *l;
    ActiveRun *start; /* of the user's system */
    Parameters parameters;
    Expr load, gmin;
    LIST(UnilateralEffort) efforts;
    Expr stiffness; /* of all of them */
    double stiffness_value, last_change;
    double at;                      /* s */
    double *speeds, *accelerations; /* of what is driven; NULL: everything is at rest */
    int n, length;
    int references; /* index in v of the references of angles, after the unknowns */
    double *v;      /* base */
    Probe *probe;   /* computes residuals, and multi-turn angles at each place */
    Map map;
    EquilibriumResidualPart slopes, inertia; /* inertia: M, and A by rates of storage elements */
    double *by; /* factors of the derivatives: those by coordinates first, as in dq/ds */
    Pattern pattern;
    double *jacobian;
    double *w, *place; /* of the last evaluation; v there */
    const double *values;
};

/* --- the system at rest --- */

typedef struct EquilibriumResidualVary {
    Arena *arena;
    Expr time, instant, load;
    bool keeps; /* with the rates of drivers */
} EquilibriumResidualVary;

static Expr vary(void *context, const Instance *instance, int param, Expr value)
{
    const EquilibriumResidualVary *v = context;
    const bool moves = v->keeps && instance != NULL && instance->row->family == FAMILY_DRIVER;
    Expr still = moves ? value : expr_substitute(v->arena, value, &v->time, &v->instant, 1);
    const bool acts = instance == NULL || (instance->row->params[param].use & GIVES) != 0;

    return acts ? expr_mul(v->arena, v->load, still) : still;
}

static double parameter(void *context, Expr symbol)
{
    EquilibriumResidual *s = context;

    for (int i = 0; i < s->efforts.count; i++)
        if (symbol == s->efforts.at[i].symbol)
            return s->efforts.at[i].known;
    if (symbol == s->stiffness)
        return s->stiffness_value;
    return symbol == s->load   ? 1
           : symbol == s->gmin ? 0
                               : parameters_value(&s->start->phases->parameters, symbol);
}

static Status make_system(EquilibriumResidual *s, const Scene *scene, const CallMonitor *watch,
                          bool keeps, Diag *diag)
{
    const VariableIndex *theirs = phases_whole(s->start->phases)->layout;
    Arena *arena = scene->arena;
    EquilibriumResidualVary of = {.arena = arena,
                                  .time = expr_symbol(arena, "t", SYMBOL_TIME),
                                  .instant = expr_real(arena, s->at),
                                  .load = expr_symbol(arena, "#load", SYMBOL_PARAMETER),
                                  .keeps = keeps};
    SystemOptions options = {.vary = vary, .context = &of, .watch = watch};

    s->load = of.load;
    s->gmin = options.gmin = expr_symbol(arena, "#gmin", SYMBOL_PARAMETER);
    s->parameters = (Parameters){
        .value = parameter, .context = s, .evaluator = s->start->phases->parameters.evaluator};
    TRY(system_new_view(scene, &options, &s->system, diag));
    s->l = variable_index_new(s->system);
    s->n = s->l->nu + s->l->nx + s->l->m + s->l->nz;
    s->references = s->l->n + s->l->nx + s->l->m + s->l->nz;
    s->length = s->references + s->l->multi_turns;
    if (s->l->n != theirs->n || s->l->nx != theirs->nx || s->l->m != theirs->m ||
        s->l->multi_turns != theirs->multi_turns)
        return diag_set(diag, E_MODEL, "at rest this model has other unknowns than in motion");
    return OK;
}

/* --- dq/ds --- */

typedef LIST(Expr) EquilibriumResidualRoots;

static bool is_euler(const System *system, int coordinate)
{
    for (int i = 0; system_quaternion(system, i) >= 0; i++)
        if (coordinate >= system_quaternion(system, i) &&
            coordinate < system_quaternion(system, i) + 4)
            return true;
    return false;
}

/* the entries of `count` coordinates for each speed that one of them depends on */
static void map_coordinates(EquilibriumResidual *s, int first, int count,
                            EquilibriumResidualRoots *roots)
{
    const VariableIndex *l = s->l;
    Map *map = &s->map;
    LIST(int) speeds = {0};

    for (int j = 0; j < l->nu; j++) {
        bool is_held = false;

        for (int i = first; i < first + count; i++)
            is_held = is_held || !expr_is_zero(system_n_entry(l->system, i, j));
        if (is_held)
            LIST_PUSH(speeds, j);
    }
    map->speed =
        mem_grow(map->speed, (size_t)(roots->count + count * speeds.count) + 1, sizeof(int));
    for (int i = first; i < first + count; i++) {
        for (int k = 0; k < speeds.count; k++) {
            map->speed[roots->count] = speeds.at[k];
            LIST_PUSH(*roots, system_n_entry(l->system, i, speeds.at[k]));
        }
        map->start[i + 1] = roots->count;
    }
    LIST_FREE(speeds);
}

static Status make_map(EquilibriumResidual *s, Diag *diag)
{
    Map *map = &s->map;
    EquilibriumResidualRoots roots = {0};
    Status status;

    map->start = NEW_ARRAY(int, s->l->n + 1);
    for (int i = 0; i < s->l->n;) {
        int count = is_euler(s->system, i) ? 4 : 1;

        map_coordinates(s, i, count, &roots);
        i += count;
    }
    map->base = NEW_ARRAY(double, roots.count);
    for (int k = 0; k < s->l->multi_turns; k++)
        LIST_PUSH(roots, system_multi_turn(s->system, k)->angle);
    status = probe_new(s->l, &s->parameters, roots.at, roots.count, &map->probe, diag);
    LIST_FREE(roots);
    return status;
}

/* q0 + N(q0) s; each four Euler parameters scaled to unit length; and dq/ds there */
static void place_coordinates(const EquilibriumResidual *s, const double *w, double *q,
                              double *slopes)
{
    const Map *map = &s->map;
    const int *start = map->start;

    for (int i = 0; i < s->l->n; i++) {
        q[i] = s->v[i];
        for (int k = start[i]; k < start[i + 1]; k++)
            q[i] += map->base[k] * w[map->speed[k]];
    }
    if (slopes != NULL)
        memcpy(slopes, map->base, (size_t)start[s->l->n] * sizeof(double));
    for (int b = 0; system_quaternion(s->system, b) >= 0; b++) {
        const int first = system_quaternion(s->system, b);
        double *p = q + first;
        const double norm = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);

        if (norm == 0)
            continue;
        for (int i = 0; i < 4; i++)
            p[i] /= norm;
        for (int k = 0; slopes != NULL && k < start[first + 1] - start[first]; k++) {
            double along = 0;

            for (int i = 0; i < 4; i++)
                along += p[i] * map->base[start[first + i] + k];
            for (int i = 0; i < 4; i++)
                slopes[start[first + i] + k] =
                    (map->base[start[first + i] + k] - p[i] * along) / norm;
        }
    }
}

/* --- rows and derivatives --- */

/* Sampled states have no rates: x' = 0 doesn't determine them. At rest the next sample leaves each
 * unchanged, and an input is at its initial value: x' = next - x replaces x' = 0. */
static Status hold_samples(const EquilibriumResidual *s, Expr *rows, Diag *diag)
{
    Arena *arena = system_arena(s->system);
    const VariableIndex *l = s->l;
    const OwnSample *own;

    for (int k = 0; (own = system_sample(s->system, k)) != NULL; k++) {
        const Expr rate = l->symbols[l->rates + own->state];
        Expr next;

        if (own->period == NULL)
            continue;
        TRY(system_resolve(s->system, own->is_input ? own->initial : own->next, &next, diag));
        next = expr_sub(arena, l->symbols[l->x + own->state], next);
        for (int i = 0; i < l->nx + l->nz; i++)
            if (expr_depends(rows[i], rate))
                rows[i] = expr_add(arena, rows[i],
                                   expr_mul(arena, expr_diff(arena, rows[i], rate), next));
    }
    return OK;
}

/* a call of unilateral() with its effort in its place */
static Expr put_effort(Arena *arena, Expr e, void *context)
{
    EquilibriumResidual *s = context;
    int i = 0;

    if (expr_kind(e) != EXPR_CALL || expr_op(e) != OP_UNILATERAL)
        return e;
    while (i < s->efforts.count && s->efforts.at[i].guard != expr_arg(e, 0))
        i++;
    if (i == s->efforts.count) {
        Text name = {0};

        text_addf(&name, "#effort %d", i + 1);
        LIST_PUSH(s->efforts,
                  ((UnilateralEffort){.guard = expr_arg(e, 0),
                                      .symbol = expr_symbol(arena, name.at, SYMBOL_PARAMETER)}));
        text_free(&name);
    }
    return expr_call1(
        arena, OP_RAMP,
        expr_add(arena, s->efforts.at[i].symbol, expr_mul(arena, s->stiffness, expr_arg(e, 0))));
}

static void put_efforts(EquilibriumResidual *s, EquilibriumResidualRoots *roots)
{
    Arena *arena = system_arena(s->system);

    s->stiffness = expr_symbol(arena, "#stiffness", SYMBOL_PARAMETER);
    for (int i = 0; i < roots->count; i++)
        roots->at[i] = expr_change(arena, roots->at[i], put_effort, s);
}

/* the rows, then multi-turn angles, then the guards of efforts */
static Status push_roots(EquilibriumResidual *s, EquilibriumResidualRoots *roots, Diag *diag)
{
    const VariableIndex *l = s->l;

    LIST_ROOM(*roots, l->nu);
    TRY(rows_balance(l, roots->at, diag));
    roots->count = l->nu;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, system_run(l->system)->phi[k]);
    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(*roots, row_network(l, i));
    TRY(hold_samples(s, roots->at + l->nu + l->m, diag));
    put_efforts(s, roots);
    for (int k = 0; k < l->multi_turns; k++)
        LIST_PUSH(*roots, system_multi_turn(s->system, k)->angle);
    for (int i = 0; i < s->efforts.count; i++)
        LIST_PUSH(*roots, s->efforts.at[i].guard);
    return OK;
}

static void make_part(EquilibriumResidual *s, ColumnMoves *moves, EquilibriumResidualPart *out)
{
    out->jacobian = jacobian_new(residual_program(probe_residual(s->probe)), s->n, s->n, moves->at,
                                 moves->count);
    out->values = NEW_ARRAY(double, jacobian_pattern(out->jacobian)->count);
    LIST_FREE(*moves);
}

static void free_part(EquilibriumResidualPart *part)
{
    jacobian_free(part->jacobian);
    MEM_FREE(part->values, part->place);
}

/* derivatives by steps, which move coordinates by dq/ds, and by the other unknowns */
static void make_slopes(EquilibriumResidual *s)
{
    const VariableIndex *l = s->l;
    ColumnMoves moves = {0};

    for (int i = 0; i < l->n; i++)
        for (int k = s->map.start[i]; k < s->map.start[i + 1]; k++)
            LIST_PUSH(moves, (ColumnMove){.column = s->map.speed[k], .input = l->q + i});
    moves_push(&moves, l->nu, l->x, l->nx);
    moves_push(&moves, l->nu + l->nx, l->multipliers, l->m);
    moves_push(&moves, l->nu + l->nx + l->m, l->z, l->nz);
    s->by = NEW_ARRAY(double, moves.count);
    for (int k = 0; k < moves.count; k++)
        s->by[k] = 1;
    make_part(s, &moves, &s->slopes);
}

/* by u' and x' */
static void make_inertia(EquilibriumResidual *s)
{
    const VariableIndex *l = s->l;
    ColumnMoves moves = {0};

    moves_push(&moves, 0, l->acceleration, l->nu);
    moves_push(&moves, l->nu, l->rates, l->nx);
    make_part(s, &moves, &s->inertia);
}

/* index in w of the unknown that belongs to a mechanical row: a step, or a multiplier */
static int own_column(const EquilibriumResidual *s, int row)
{
    return row < s->l->nu ? row : row + s->l->nx;
}

/* terms at positions in the Jacobian */
typedef struct EquilibriumResidualTerms {
    LIST(int) row;
    LIST(int) column;
} EquilibriumResidualTerms;

static void add_term(EquilibriumResidualTerms *terms, int row, int column)
{
    LIST_PUSH(terms->row, row);
    LIST_PUSH(terms->column, column);
}

static void add_part(EquilibriumResidualTerms *terms, const EquilibriumResidualPart *part)
{
    const Pattern *p = jacobian_pattern(part->jacobian);

    for (int k = 0; k < p->count; k++)
        add_term(terms, p->row[k], p->column[k]);
}

/* set where a part's entries are added, from positions of terms; returns how many there are */
static int take_places(EquilibriumResidualPart *part, const int *place)
{
    const int count = jacobian_pattern(part->jacobian)->count;

    part->place = NEW_ARRAY(int, count);
    if (count > 0)
        memcpy(part->place, place, (size_t)count * sizeof(int));
    return count;
}

/* the pattern of the Jacobian, with inertia and with the own entry of each mechanical unknown */
static void make_pattern(EquilibriumResidual *s)
{
    EquilibriumResidualTerms terms = {0};
    int *place, slopes;

    add_part(&terms, &s->slopes);
    add_part(&terms, &s->inertia);
    for (int i = 0; i < s->l->nu + s->l->m; i++)
        add_term(&terms, i, own_column(s, i));
    place = NEW_ARRAY(int, terms.row.count);
    s->pattern = pattern_of(s->n, s->n, terms.row.count, terms.row.at, terms.column.at, place);
    slopes = take_places(&s->slopes, place);
    (void)take_places(&s->inertia, place + slopes);
    s->jacobian = NEW_ARRAY(double, s->pattern.count);
    LIST_FREE(terms.row);
    LIST_FREE(terms.column);
    mem_free(place);
}

static Status make_rows(EquilibriumResidual *s, Diag *diag)
{
    EquilibriumResidualRoots roots = {0};
    Status status = OK;

    CHECK(push_roots(s, &roots, diag));
    CHECK(probe_new(s->l, &s->parameters, roots.at, roots.count, &s->probe, diag));
    make_slopes(s);
    make_inertia(s);
    make_pattern(s);
done:
    LIST_FREE(roots);
    return status;
}

/* --- what is driven --- */

static RowValues row_of(const EquilibriumResidual *s, const double *v);

/* the speed whose rate a driver's row alone determines; -1: not a driver's row, or several
 * speeds */
static int driven_speed(const VariableIndex *l, int row, const double *phi_u)
{
    int own = -1;

    for (int j = 0; j < l->nu && system_constraint(l->system, row)->is_driver; j++)
        if (phi_u[row * l->nu + j] != 0) {
            if (own >= 0)
                return -1;
            own = j;
        }
    return own;
}

/* Check that all other speeds are 0; otherwise nothing is at rest relative to what is driven. */
static Status check_driven(const EquilibriumResidual *s, const double *phi_u, const double *rates,
                           Diag *diag)
{
    const VariableIndex *l = s->l;
    const double most = vector_largest(rates, l->nu);

    for (int j = 0; j < l->nu; j++) {
        bool is_driven = fabs(rates[j]) <= 1e-9 * most;
        const int q = speed_coordinate(l->system, j);

        for (int k = 0; k < l->m && !is_driven; k++)
            is_driven = driven_speed(l, k, phi_u) == j;
        if (is_driven)
            continue;
        (void)diag_set(diag, E_MODEL, "%s has to move with what is driven at t = %g s",
                       q >= 0 ? system_q(l->system, q)->name : system_u(l->system, j)->name, s->at);
        diag_hint(diag,
                  "driven rates are kept where all other coordinates can rest: in coordinates "
                  "of joints (tree joint), and where no closed loop is driven");
        return E_MODEL;
    }
    return OK;
}

/* Solve rows of Phi_u for speeds or accelerations; a step with few nonzero entries. */
static Status rates_of(const EquilibriumResidual *s, Probe *probe, const double *u, double *out,
                       int right, Diag *diag)
{
    const VariableIndex *l = s->l;
    RowValues row = row_of(s, s->v);
    const double *values;

    row.u = u;
    row.acceleration = NULL;
    values = probe_values(probe, &row);
    if (rows_solve(values, l->m, l->nu, values + (ptrdiff_t)l->m * (l->nu + right), out) < 0)
        return diag_set(diag, E_SINGULAR, "the rates of what is driven are undefined at t = %g s",
                        s->at);
    return check_driven(s, values, out, diag);
}

/* Speeds of drivers, and their accelerations at these speeds. */
static Status drive(EquilibriumResidual *s, Diag *diag)
{
    const VariableIndex *l = s->l;
    const EquationForm *run = system_run(l->system);
    double *none = NEW_ARRAY(double, l->nu);
    Probe *probe = NULL;
    EquilibriumResidualRoots roots = {0};
    Status status = OK;

    s->speeds = NEW_ARRAY(double, l->nu);
    s->accelerations = NEW_ARRAY(double, l->nu);
    if (l->m == 0)
        goto done;
    for (int k = 0; k < l->m * l->nu; k++)
        LIST_PUSH(roots, run->phi_u[k]);
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(roots, run->nu[k]);
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(roots, run->gamma[k]);
    CHECK(probe_new(l, &s->parameters, roots.at, roots.count, &probe, diag));
    CHECK(rates_of(s, probe, none, s->speeds, 0, diag));
    CHECK(rates_of(s, probe, s->speeds, s->accelerations, 1, diag));
done:
    probe_free(probe);
    LIST_FREE(roots);
    mem_free(none);
    return status;
}

/* --- construction and destruction --- */

/* user's guesses as initial guess of the search */
static void guess_network(EquilibriumResidual *s, const VariableIndex *theirs)
{
    double *z = s->v + s->l->n + s->l->nx + s->l->m;

    for (int k = 0; k < theirs->nz; k++)
        for (int i = 0; i < s->l->nz && s->start->result->start.guess[k] != 0; i++)
            if (strcmp(system_z(s->system, i)->name, system_z(theirs->system, k)->name) == 0)
                z[i] = s->start->result->start.guess[k];
}

Status equilibrium_new(const Scene *scene, ActiveRun *start, const CallMonitor *watch, bool keeps,
                       double at, EquilibriumResidual **out, Diag *diag)
{
    EquilibriumResidual *s = NEW(EquilibriumResidual);
    const VariableIndex *theirs = phases_whole(start->phases)->layout;
    Status status = OK;

    s->start = start;
    s->at = at;
    CHECK(make_system(s, scene, watch, keeps, diag));
    CHECK(make_map(s, diag));
    CHECK(make_rows(s, diag));
    s->v = NEW_ARRAY(double, s->length);
    s->w = NEW_ARRAY(double, s->n);
    s->place = NEW_ARRAY(double, s->length);
    memcpy(s->v, start->result->start.y, (size_t)theirs->n * sizeof(double));
    memcpy(s->v + theirs->n, start->result->start.y + theirs->n + theirs->nu,
           (size_t)theirs->nx * sizeof(double));
    memcpy(s->v + s->references, start->result->start.y + variable_index_references(theirs),
           (size_t)theirs->multi_turns * sizeof(double));
    guess_network(s, theirs);
    equilibrium_rebase(s);
    if (keeps)
        CHECK(drive(s, diag));
    *out = s;
    s = NULL;
done:
    equilibrium_free(s);
    return status;
}

void equilibrium_free(EquilibriumResidual *s)
{
    if (s == NULL)
        return;
    probe_free(s->probe);
    probe_free(s->map.probe);
    MEM_FREE(s->map.start, s->map.speed, s->map.base);
    parameters_free(&s->parameters);
    free_part(&s->slopes);
    free_part(&s->inertia);
    pattern_free(&s->pattern);
    MEM_FREE(s->by, s->jacobian, s->v, s->w, s->place, s->speeds, s->accelerations);
    LIST_FREE(s->efforts);
    variable_index_free(s->l);
    system_free(s->system);
    mem_free(s);
}

const double *equilibrium_speeds(const EquilibriumResidual *s)
{
    return s->speeds;
}

const VariableIndex *equilibrium_layout(const EquilibriumResidual *s)
{
    return s->l;
}

int equilibrium_length(const EquilibriumResidual *s)
{
    return s->length;
}

int equilibrium_count(const EquilibriumResidual *s)
{
    return s->n;
}

bool equilibrium_is_network(const EquilibriumResidual *s)
{
    return s->l->n == 0 && s->l->nu == 0 && s->l->m == 0;
}

bool equilibrium_step_sources(EquilibriumResidual *s, double load)
{
    s->values = NULL;
    return probe_turn(s->probe, s->load, load);
}

bool equilibrium_step_gmin(EquilibriumResidual *s, double gmin)
{
    s->values = NULL;
    return probe_turn(s->probe, s->gmin, gmin);
}

static void set_stiffness(EquilibriumResidual *s, double stiffness)
{
    s->stiffness_value = stiffness;
    (void)probe_turn(s->probe, s->stiffness, stiffness);
}

void equilibrium_begin_efforts(EquilibriumResidual *s)
{
    double *w = NEW_ARRAY(double, s->n), largest = 0;
    const double *missed;

    if (s->efforts.count > 0) {
        equilibrium_begin(s, w);
        missed = equilibrium_residual(s, w);
        for (int j = 0; j < s->l->nu; j++)
            largest = isfinite(missed[j]) ? fmax(largest, fabs(missed[j])) : largest;
        set_stiffness(s, largest > 0 ? EFFORT_STIFFNESS * largest : EFFORT_STIFFNESS);
        s->values = NULL;
    }
    mem_free(w);
}

bool equilibrium_renew_efforts(EquilibriumResidual *s)
{
    double *w = NEW_ARRAY(double, s->n), largest = 0, change = 0;
    const double *guards;

    equilibrium_begin(s, w);
    guards = equilibrium_residual(s, w) + s->n + s->l->multi_turns;
    for (int i = 0; i < s->efforts.count; i++) {
        UnilateralEffort *effort = &s->efforts.at[i];
        const double next = fmax(0, effort->known + s->stiffness_value * guards[i]);

        change = fmax(change, fabs(next - effort->known));
        largest = fmax(largest, next);
        effort->known = next;
        (void)probe_turn(s->probe, effort->symbol, next);
    }
    if (change > EFFORT_SLOW * s->last_change && s->last_change > 0)
        set_stiffness(s, EFFORT_STIFFER * s->stiffness_value);
    s->last_change = change;
    s->values = NULL;
    mem_free(w);
    return change > EFFORT_CHANGE * largest;
}

/* --- base and states --- */

static RowValues row_of(const EquilibriumResidual *s, const double *v)
{
    const VariableIndex *l = s->l;

    return (RowValues){.t = s->at,
                       .references = v + s->references,
                       .u = s->speeds,
                       .acceleration = s->accelerations,
                       .q = v,
                       .x = v + l->n,
                       .multipliers = v + l->n + l->nx,
                       .z = v + l->n + l->nx + l->m};
}

double *equilibrium_base(EquilibriumResidual *s)
{
    return s->v;
}

void equilibrium_rebase(EquilibriumResidual *s)
{
    RowValues row = row_of(s, s->v);
    const double *map = probe_values(s->map.probe, &row);

    memcpy(s->map.base, map, (size_t)s->map.start[s->l->n] * sizeof(double));
    memcpy(s->v + s->references, map + s->map.start[s->l->n],
           (size_t)s->l->multi_turns * sizeof(double));
    memcpy(s->place + s->references, s->v + s->references,
           (size_t)s->l->multi_turns * sizeof(double));
    s->values = NULL;
}

void equilibrium_begin(const EquilibriumResidual *s, double *w)
{
    memset(w, 0, (size_t)s->l->nu * sizeof(double));
    memcpy(w + s->l->nu, s->v + s->l->n, (size_t)(s->n - s->l->nu) * sizeof(double));
}

void equilibrium_place(const EquilibriumResidual *s, const double *w, double *v)
{
    place_coordinates(s, w, v, NULL);
    memcpy(v + s->l->n, w + s->l->nu, (size_t)(s->n - s->l->nu) * sizeof(double));
    memmove(v + s->references, s->place + s->references,
            (size_t)s->l->multi_turns * sizeof(double));
}

/* --- values --- */

static void look(EquilibriumResidual *s, const double *w)
{
    RowValues row = row_of(s, s->place);

    if (s->values != NULL && memcmp(s->w, w, (size_t)s->n * sizeof(double)) == 0)
        return;
    memcpy(s->w, w, (size_t)s->n * sizeof(double));
    equilibrium_place(s, w, s->place);
    s->values = probe_values(s->probe, &row);
    memcpy(s->place + s->references, s->values + s->n, (size_t)s->l->multi_turns * sizeof(double));
}

const double *equilibrium_residual(EquilibriumResidual *s, const double *w)
{
    look(s, w);
    return s->values;
}

/* add a part's entries at the last evaluation; moves NULL: each is 1 */
static void add_entries(EquilibriumResidual *s, const EquilibriumResidualPart *part,
                        const double *by, double factor, double *jacobian)
{
    jacobian_at(part->jacobian, probe_inputs(s->probe), by, part->values);
    for (int k = 0; k < jacobian_pattern(part->jacobian)->count; k++)
        jacobian[part->place[k]] += factor * part->values[k];
}

const double *equilibrium_jacobian(EquilibriumResidual *s, const double *w)
{
    look(s, w);
    place_coordinates(s, w, s->place, s->by);
    memset(s->jacobian, 0, (size_t)s->pattern.count * sizeof(double));
    add_entries(s, &s->slopes, s->by, 1, s->jacobian);
    return s->jacobian;
}

void equilibrium_pattern(const EquilibriumResidual *s, const int **start, const int **row)
{
    *start = s->pattern.start;
    *row = s->pattern.row;
}

void equilibrium_sizes(const EquilibriumResidual *s, const double *w, double *size)
{
    memset(size, 0, (size_t)s->n * sizeof(double));
    for (int c = 0; c < s->n; c++) {
        const bool steps = c < s->l->nu, is_state = c < s->l->nu + s->l->nx;
        const double place = steps ? 1 : fmax(fabs(w[c]), is_state ? 1 : 0);

        for (int k = s->pattern.start[c]; k < s->pattern.start[c + 1]; k++)
            size[s->pattern.row[k]] += fabs(s->jacobian[k]) * place;
    }
}

void equilibrium_hold(const EquilibriumResidual *s, double *residual, double *jacobian)
{
    const VariableIndex *l = s->l;
    const int rows = l->nu + l->m;

    for (int i = 0; i < rows && residual != NULL; i++)
        residual[i] = 0;
    for (int c = 0; c < s->n && jacobian != NULL; c++) {
        const bool is_state = c >= l->nu && c < l->nu + l->nx;
        const bool is_own = !is_state && c < l->nu + l->nx + l->m;

        for (int k = s->pattern.start[c]; k < s->pattern.start[c + 1]; k++)
            if (is_own || s->pattern.row[k] < rows)
                jacobian[k] =
                    is_own && s->pattern.row[k] < rows && own_column(s, s->pattern.row[k]) == c;
    }
}

void equilibrium_add_inertia(EquilibriumResidual *s, const double *w, double share,
                             double *jacobian)
{
    look(s, w);
    add_entries(s, &s->inertia, NULL, share, jacobian);
}
