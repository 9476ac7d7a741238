/* inverse.c: efforts, currents and sources from the motion, row by row
 *
 *     R = M u' + G^T lambda - F(w) = 0     in lambda and w
 *     R' = 0                               in lambda', w'
 *     A [x'; z] - r = 0                    in the rest of z and the efforts
 *
 * lambda: multipliers, except those of drivers whose effort is supplied elsewhere. w: entries of x
 * and z, and efforts, in F. R' contains u'', from (Phi_u u' - gamma)' = 0. Each is a least-squares
 * problem of full rank; where the rank is lower an effort can't produce the motion. */
#include "simulate/run/inverse.h"

#include "algebra/linear.h"
#include "algebra/rank.h"
#include "base/memory.h"
#include "simulate/equations/rows.h"
#include "simulate/run/inverse_steps.h"
#include "simulate/run/run_limits.h"

#include <math.h>
#include <string.h>

/* unknowns: index in the variable index, and symbol */
typedef LIST(int) Unknowns;

/* rows, and the unknowns that they are solved for */
typedef struct InverseProblem {
    Probe *probe;
    const Unknowns *unknowns;
    InverseSteps *steps;
} InverseProblem;

typedef struct InverseRun {
    Phases *phases;
    Phase *phase; /* the only one */
    const Assembled *start;
    const VariableIndex *l;
    Unknowns forces;  /* unknowns of R: multipliers first, then w */
    int multipliers;  /* number of these */
    Unknowns sources; /* unknowns of the network's equations */
    Unknowns jerks;   /* u'' */
    Unknowns none;
    bool by_source;
    InverseProblem balance; /* R, by `forces` */
    InverseProblem jerk;    /* (Phi_u u' - gamma)', by `jerks` */
    InverseProblem moving;  /* R' at constant `forces` */
    InverseProblem network; /* its rows, by `sources` */
    double *values;         /* a row, in the order of the variable index */
    bool *in_use;           /* m: constraints whose multipliers are solved for in this row */
} InverseRun;

static bool is_symbol(Expr e, SymbolKind kind)
{
    return expr_kind(e) == EXPR_SYMBOL && expr_symbol_kind(e) == kind;
}

bool inverse_finds_states(const System *system)
{
    for (int i = 0; i < system_drive_count(system); i++)
        if (system_drive(system, i)->by_source)
            return true;
    return false;
}

/* --- unknowns --- */

static bool is_supplied_elsewhere(const System *system, int constraint)
{
    for (int i = 0; i < system_drive_count(system); i++) {
        const Drive *drive = system_drive(system, i);

        if (drive->constraint == constraint && is_symbol(drive->effort, SYMBOL_EFFORT))
            return true;
    }
    return false;
}

static bool is_in_forces(const VariableIndex *l, Expr symbol)
{
    const EquationForm *run = system_run(l->system);

    for (int j = 0; j < l->nu; j++)
        if (expr_depends(run->force[j], symbol))
            return true;
    return false;
}

static Status sort_unknowns(InverseRun *in, Diag *diag)
{
    const VariableIndex *l = in->l;

    for (int k = 0; k < l->m; k++)
        if (!is_supplied_elsewhere(in->phases->system, k))
            LIST_PUSH(in->forces, l->multipliers + k);
    in->multipliers = in->forces.count;
    for (int i = 0; i < l->nx && in->by_source; i++) {
        if (!is_in_forces(l, l->symbols[l->x + i])) {
            (void)diag_set(diag, E_MODEL,
                           "%s does not follow from the motion, so the sources can't be found",
                           expr_name(l->symbols[l->x + i]));
            diag_hint(diag, "drive the motion by its joints, and read what the motors take");
            return E_MODEL;
        }
        LIST_PUSH(in->forces, l->x + i);
    }
    /* the rate of a current is one of a force, and needs u'' */
    if (in->by_source && l->nx > 0 && system_rough_driver(l->system) != NULL) {
        (void)diag_set(diag, E_MODEL,
                       "the sources need rates of currents, and the acceleration that %s asks for "
                       "jumps",
                       system_rough_driver(l->system));
        diag_hint(diag, "drive by a motion with a continuous second derivative");
        return E_MODEL;
    }
    for (int i = 0; i < l->nz && in->by_source; i++)
        if (is_in_forces(l, l->symbols[l->z + i]))
            LIST_PUSH(in->forces, l->z + i);
        else
            LIST_PUSH(in->sources, l->z + i);
    for (int i = 0; i < l->ne; i++)
        if (is_in_forces(l, l->symbols[l->efforts + i]))
            LIST_PUSH(in->forces, l->efforts + i);
        else
            LIST_PUSH(in->sources, l->efforts + i);
    for (int j = 0; j < l->nu; j++)
        LIST_PUSH(in->jerks, l->jerk + j);
    return OK;
}

/* --- programs --- */

typedef LIST(Expr) InverseRoots;

/* d/dt along the motion */
static Expr along(const InverseRun *in, Expr e)
{
    const VariableIndex *l = in->l;
    Arena *arena = system_arena(l->system);
    const EquationForm *run = system_run(l->system);
    int count = 1 + l->n + 2 * l->nu;
    Expr *symbols = NEW_ARRAY(Expr, count);
    Expr *rates = NEW_ARRAY(Expr, count);
    int k = 0;
    Expr out;

    symbols[k] = l->symbols[l->t];
    rates[k++] = expr_int(arena, 1);
    for (int i = 0; i < l->n; i++) {
        symbols[k] = l->symbols[l->q + i];
        rates[k++] = run->q_rate[i];
    }
    for (int i = 0; i < l->nu; i++) {
        symbols[k] = l->symbols[l->u + i];
        rates[k++] = l->symbols[l->acceleration + i];
    }
    for (int i = 0; i < l->nu; i++) {
        symbols[k] = l->symbols[l->acceleration + i];
        rates[k++] = l->symbols[l->jerk + i];
    }
    out = expr_diff_along(arena, e, symbols, rates, count);
    MEM_FREE(symbols, rates);
    return out;
}

/* compile rows and their derivatives by unknowns; frees the list of rows */
static Status open_problem(InverseRun *in, InverseRoots *rows, const Unknowns *unknowns,
                           InverseProblem *out, Diag *diag)
{
    Expr *symbols = NEW_ARRAY(Expr, unknowns->count);
    const ProbeOrder order = {.roots = rows->at,
                              .root_count = rows->count,
                              .row_count = rows->count,
                              .unknowns = symbols,
                              .unknown_count = unknowns->count};
    Status status;

    for (int k = 0; k < unknowns->count; k++)
        symbols[k] = in->l->symbols[unknowns->at[k]];
    status = probe_make(in->l, &in->phases->parameters, &order, &out->probe, diag);
    out->unknowns = unknowns;
    if (status == OK)
        out->steps = inverse_steps_new(probe_residual(out->probe), unknowns->count);
    LIST_FREE(*rows);
    mem_free(symbols);
    return status;
}

static Status compile(InverseRun *in, Diag *diag)
{
    const VariableIndex *l = in->l;
    InverseRoots rows = {0};

    TRY(system_form_mass(l->system, diag));
    for (int j = 0; j < l->nu; j++)
        LIST_PUSH(rows, row_balance(l, j));
    TRY(open_problem(in, &rows, &in->forces, &in->balance, diag));
    if (!in->by_source)
        return OK;

    for (int k = 0; k < l->m; k++)
        LIST_PUSH(rows, along(in, row_acceleration(l, k)));
    TRY(open_problem(in, &rows, &in->jerks, &in->jerk, diag));
    for (int j = 0; j < l->nu; j++)
        LIST_PUSH(rows, along(in, row_balance(l, j)));
    TRY(open_problem(in, &rows, &in->none, &in->moving, diag));
    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(rows, row_network(l, i));
    return open_problem(in, &rows, &in->sources, &in->network, diag);
}

/* --- solution --- */

static const double *values_of(const InverseRun *in, const InverseProblem *problem)
{
    const VariableIndex *l = in->l;
    const double *v = in->values;
    RowValues row = {.t = v[l->t],
                     .references = v + l->references,
                     .q = v + l->q,
                     .u = v + l->u,
                     .x = v + l->x,
                     .rates = v + l->rates,
                     .z = v + l->z,
                     .acceleration = v + l->acceleration,
                     .multipliers = v + l->multipliers,
                     .efforts = v + l->efforts,
                     .jerk = v + l->jerk};

    return probe_values(problem->probe, &row);
}

/* Choose among redundant constraints those that are least dependent at the current row; the
 * multipliers of others are 0. */
static void choose_rows(InverseRun *in)
{
    const Equations *eq = compiled_equations(in->phase->numbers);
    const int count = in->start->row_count;
    int *rows = NEW_ARRAY(int, count);
    double *phi_u = NULL;

    if (count < eq->m) {
        phi_u = pattern_spread(eq->rows, eq->phi_u);
        (void)rank_choose(phi_u, eq->m, eq->nu, count, rows);
    } else {
        memcpy(rows, in->start->rows, (size_t)count * sizeof(int));
    }
    mem_free(phi_u);
    memset(in->in_use, 0, (size_t)eq->m * sizeof(bool));
    for (int k = 0; k < count; k++)
        in->in_use[rows[k]] = true;
    mem_free(rows);
}

static bool is_solved_for(const InverseRun *in, int place)
{
    const int row = place - in->l->multipliers;

    return row < 0 || row >= in->l->m || in->in_use[row];
}

/* The step of the unknowns in use, 0 for the others, that minimises the distance of the rows, whose
 * values these are, from `right`. False: they are dependent. */
static bool solve_in_use(const InverseRun *in, const InverseProblem *problem, const double *values,
                         const double *right, double *out)
{
    const Unknowns *unknowns = problem->unknowns;
    bool *in_use = NEW_ARRAY(bool, unknowns->count), is_regular;

    for (int k = 0; k < unknowns->count; k++)
        in_use[k] = is_solved_for(in, unknowns->at[k]);
    is_regular = inverse_step(problem->steps, values, in_use, right, out);
    mem_free(in_use);
    return is_regular;
}

/* Multipliers of least norm that give the same forces, as in forward runs; those that are supplied
 * elsewhere have none. */
static void spread_multipliers(InverseRun *in)
{
    const Equations *eq = compiled_equations(in->phase->numbers);
    double *phi_u, *lambda;
    int count = 0;

    if (in->start->row_count == eq->m)
        return;
    phi_u = NEW_ARRAY(double, eq->m * eq->nu);
    lambda = NEW_ARRAY(double, eq->m);
    for (int k = 0; k < in->multipliers; k++) {
        const int row = in->forces.at[k] - in->l->multipliers;

        pattern_add(eq->rows, eq->phi_u, row, 1, phi_u + count * eq->nu);
        lambda[count++] = in->values[in->forces.at[k]];
    }
    rank_least_multipliers(phi_u, count, eq->nu, lambda);
    for (int k = 0; k < count; k++)
        in->values[in->forces.at[k]] = lambda[k];
    MEM_FREE(phi_u, lambda);
}

static Status cant_produce(const InverseRun *in, const Unknowns *unknowns, Diag *diag)
{
    Text names = {0};

    for (int k = 0; k < unknowns->count; k++)
        if (unknowns->at[k] < in->l->multipliers || unknowns->at[k] >= in->l->efforts)
            text_addf(&names, "%s%s", names.length > 0 ? ", " : "",
                      expr_name(in->l->symbols[unknowns->at[k]]));
    (void)diag_set(diag, E_SINGULAR, "at t = %.6g s no %s can produce the motion asked for",
                   in->values[in->l->t], names.length > 0 ? names.at : "effort");
    diag_hint(diag, "each driver takes an effort of its own, on a coordinate that it moves");
    text_free(&names);
    return E_SINGULAR;
}

/* Newton's method: linear rows take one step and a check. */
static Status solve_rows(InverseRun *in, const InverseProblem *problem, Diag *diag)
{
    const Unknowns *unknowns = problem->unknowns;
    const int rows = residual_row_count(probe_residual(problem->probe));
    double *step = NEW_ARRAY(double, unknowns->count);
    double size = INFINITY, scale = 1;
    Status status = OK;

    for (int i = 0; i < DRIVEN_ITERATIONS && size > 1e-14 * scale; i++) {
        const double *values = values_of(in, problem);

        if (!vector_is_finite(values, rows) || !solve_in_use(in, problem, values, values, step))
            CHECK(cant_produce(in, unknowns, diag));
        scale = 1;
        for (int k = 0; k < unknowns->count; k++) {
            in->values[unknowns->at[k]] -= step[k];
            scale = fmax(scale, fabs(in->values[unknowns->at[k]]));
        }
        size = vector_largest(step, unknowns->count);
    }
    if (rows > unknowns->count || size > 1e-8 * scale || in->start->row_count < in->l->m) {
        const double *values = values_of(in, problem);

        if (!(vector_largest(values, rows) <= 1e-7 * scale))
            CHECK(cant_produce(in, unknowns, diag));
    }
done:
    mem_free(step);
    return status;
}

/* rates of the unknowns of R, for those that are network states */
static Status find_rates(InverseRun *in, Diag *diag)
{
    const VariableIndex *l = in->l;
    double *rates = NEW_ARRAY(double, in->forces.count);
    double *jerk = in->values + l->jerk; /* still 0 */
    const double *values = values_of(in, &in->jerk);
    Status status = OK;

    if (!solve_in_use(in, &in->jerk, values, values, jerk))
        CHECK(cant_produce(in, &in->forces, diag));
    for (int i = 0; i < l->nu; i++)
        jerk[i] = -jerk[i];
    values = values_of(in, &in->balance);
    if (!solve_in_use(in, &in->balance, values, values_of(in, &in->moving), rates))
        CHECK(cant_produce(in, &in->forces, diag));
    for (int k = in->multipliers; k < in->forces.count; k++) {
        int place = in->forces.at[k];

        if (place >= l->x && place < l->x + l->nx)
            in->values[l->rates + place - l->x] = -rates[k];
    }
done:
    mem_free(rates);
    return status;
}

/* solve a row at (t, y), and find its states; its block goes into `out` */
static Status solve_row(InverseRun *in, double t, double *y, double *out, Diag *diag)
{
    const VariableIndex *l = in->l;
    Solved solved;

    if (!motion_solve(in->phase->motion, t, y, &solved))
        return ode_undefined(motion_ode(in->phase->motion), t, diag);
    choose_rows(in);
    memset(in->values, 0, (size_t)l->count * sizeof(double));
    in->values[l->t] = t;
    for (int k = 0; k < l->multi_turns; k++)
        in->values[l->references + k] = y[variable_index_references(l) + k];
    memcpy(in->values + l->q, y, (size_t)(l->n + l->nu + l->nx) * sizeof(double));
    memcpy(in->values + l->rates, solved.rates, (size_t)(l->nx + l->nz) * sizeof(double));
    memcpy(in->values + l->acceleration, solved.acceleration, (size_t)l->nu * sizeof(double));
    TRY(solve_rows(in, &in->balance, diag));
    if (in->by_source) {
        TRY(find_rates(in, diag));
        TRY(solve_rows(in, &in->network, diag));
    }
    spread_multipliers(in);
    memcpy(y + l->n + l->nu, in->values + l->x, (size_t)l->nx * sizeof(double));
    /* x', z, u', lambda, efforts have the same order in the variable index */
    memcpy(out, in->values + l->rates, (size_t)(l->jerk - l->rates) * sizeof(double));
    return OK;
}

static void close_problem(InverseProblem *problem)
{
    inverse_steps_free(problem->steps);
    probe_free(problem->probe);
}

Status inverse_solve(Phases *phases, const Assembled *start, Grid *rows, const CallMonitor *watch,
                     Driven *out, Diag *diag)
{
    mem_keep(phases);
    Phase *phase = phases_whole(phases);
    InverseRun in = {.phases = phases,
                     .phase = phase,
                     .start = start,
                     .l = phase->layout,
                     .by_source = inverse_finds_states(phases->system)};
    Status status = OK;

    if (in.l->ne == 0)
        return OK; /* every effort is a multiplier */
    in.values = NEW_ARRAY(double, in.l->count);
    in.in_use = NEW_ARRAY(bool, in.l->m);
    CHECK(sort_unknowns(&in, diag));
    CHECK(compile(&in, diag));
    out->length = in.l->jerk - in.l->rates;
    mem_free(out->values);
    out->values = NEW_ARRAY(double, rows->count * out->length);
    for (int row = 0; row < rows->count; row++) {
        monitor_report(watch, "inverse", (double)row / rows->count);
        if (monitor_poll(watch) != OK) {
            rows->count = row;
            CHECK(diag_set(diag, E_STOPPED, "stopped at t = %.6g s", rows->times[row]));
        }
        CHECK(solve_row(&in, rows->times[row], grid_row(rows, row),
                        out->values + (ptrdiff_t)row * out->length, diag));
    }
done:
    close_problem(&in.balance);
    close_problem(&in.jerk);
    close_problem(&in.moving);
    close_problem(&in.network);
    LIST_FREE(in.forces);
    LIST_FREE(in.sources);
    LIST_FREE(in.jerks);
    MEM_FREE(in.values, in.in_use);
    return status;
}
