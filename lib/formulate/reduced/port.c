/* port.c: Norton and Thevenin equivalents of mechanisms
 *
 * With efforts g where a motion is given and w at the ports, in the order u', lambda, g, w:
 *
 *     M u' + Phi_u^T lambda - J_g^T g - J^T w = F
 *     Phi_u u' = gamma,   J_g u' = a_g - b_g,   J u' = a - b
 *
 * Norton's w is solved from all of it, with a on the right; Thevenin's u' without the last row,
 * with w on the right. */
#include "formulate/reduced/port.h"

#include "algebra/rank.h"
#include "base/memory.h"
#include "formulate/reduced/symbolic_solve.h"

#include <math.h>
#include <string.h>

enum { MOST_NETWORK = 40, MOST_UNKNOWNS = 400 };
static const double least_pivot = 1e-11;      /* of a matrix whose rows and columns have size 1 */
static const double least_independent = 1e-9; /* of rows of Phi_u (rank.h) */

/* --- equations --- */

static Status read_mechanism(PortEquations *p, Diag *diag)
{
    System *system = p->system;
    Arena *arena = p->arena;
    const int nu = p->nu;

    for (int i = 0; i < nu; i++) {
        for (int j = 0; j < nu; j++)
            TRY(system_show(system, BLOCK_MASS, i, j, &p->mass[i * nu + j], diag));
        TRY(system_show(system, BLOCK_FORCES, i, 0, &p->force[i], diag));
        TRY(monitor_poll(p->options.watch));
    }
    for (int k = 0; k < p->m; k++) {
        for (int j = 0; j < nu; j++)
            TRY(system_show(system, BLOCK_JACOBIAN, k, j, &p->phi_u[k * nu + j], diag));
        TRY(system_show(system, BLOCK_ACCELERATION, k, 0, &p->gamma[k], diag));
    }
    for (int i = 0; i < nu * nu; i++)
        p->mass[i] = expr_open(arena, p->mass[i]);
    for (int i = 0; i < nu; i++)
        p->force[i] = expr_open(arena, p->force[i]);
    for (int i = 0; i < nu * p->m; i++)
        p->phi_u[i] = expr_open(arena, p->phi_u[i]);
    for (int i = 0; i < p->m; i++)
        p->gamma[i] = expr_open(arena, p->gamma[i]);
    return OK;
}

static Status read_definitions(PortEquations *p, Diag *diag)
{
    const EquationForm *form;
    const size_t nu = (size_t)p->nu, m = (size_t)p->m;

    TRY(system_form_mass(p->system, diag));
    form = system_definitions(p->system);
    if (nu > 0) {
        memcpy(p->mass, form->mass, nu * nu * sizeof(Expr));
        memcpy(p->force, form->force, nu * sizeof(Expr));
    }
    if (m > 0) {
        memcpy(p->phi_u, form->phi_u, m * nu * sizeof(Expr));
        memcpy(p->gamma, form->gamma, m * sizeof(Expr));
    }
    return OK;
}

/* a = slope u' + rest */
static Status read_acceleration(PortEquations *p, int at, const char *name, bool is_given,
                                Diag *diag)
{
    Arena *arena = p->arena;
    Expr *symbols = NEW_ARRAY(Expr, p->nu);
    Expr a;
    Status status = OK;

    CHECK(system_variable(p->system, name, 0, &a, diag));
    if (!p->options.is_numeric)
        a = expr_open(arena, a);
    for (int j = 0; j < p->nu; j++) {
        symbols[j] = system_acceleration(p->system, j);
        p->slope[at * p->nu + j] = expr_diff(arena, a, symbols[j]);
        if (!p->options.is_numeric)
            p->slope[at * p->nu + j] = symbolic_tidy(arena, p->slope[at * p->nu + j]);
    }
    p->rest[at] = expr_substitute(arena, a, symbols, NULL, p->nu);
    if (!p->options.is_numeric)
        p->rest[at] = symbolic_tidy(arena, p->rest[at]);
    /* a - b is needed on the right */
    if (is_given)
        p->rest[at] = expr_sub(arena, p->rest[at], expr_symbol(arena, name, SYMBOL_VARIABLE));
done:
    mem_free(symbols);
    return status;
}

static Status read_ends(PortEquations *p, Diag *diag)
{
    for (int i = 0; i < p->options.count; i++)
        TRY(read_acceleration(p, i, p->options.components[i], false, diag));
    for (int i = 0; i < p->options.given_count; i++)
        TRY(read_acceleration(p, p->options.count + i, p->options.given[i], true, diag));
    return OK;
}

/* --- networks --- */

static bool reads_network(const PortEquations *p)
{
    for (int i = 0; i < p->nu; i++)
        if ((expr_kinds(p->force[i]) & (1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE)) != 0)
            return true;
    return false;
}

/* the unknowns of the network in the order of its rows: x', then z */
static Expr network_unknown(const System *system, int i)
{
    const int nx = system_nx(system);

    return i < nx ? system_state_rate(system, i) : system_z(system, i - nx)->symbol;
}

/* the part whose law isn't linear; NULL: all are */
static const char *nonlinear_part(const System *system)
{
    const int n = system_nx(system) + system_nz(system);
    const EquationForm *form = system_definitions(system);
    int rows = -1;

    if (!form->network_nonlinear)
        return NULL;
    for (int k = 0; k < form->network_entries && rows < 0; k++)
        for (int i = 0; i < n && rows < 0; i++)
            if (expr_depends(form->network[k].value, network_unknown(system, i)))
                rows = form->network[k].row;
    rows = rows < 0 ? 0 : rows;
    return system_instance_name(system, rows < system_nx(system)
                                            ? system_x(system, rows)->instance
                                            : system_z(system, rows - system_nx(system))->instance);
}

static Status solve_network(PortEquations *p, Diag *diag)
{
    const int n = system_nx(p->system) + system_nz(p->system);
    Expr *a = NEW_ARRAY(Expr, n * n), *b = NEW_ARRAY(Expr, n), *x = NEW_ARRAY(Expr, n),
         *symbols = NEW_ARRAY(Expr, n);
    int unknown;
    Status status = OK;

    for (int r = 0; r < n; r++) {
        for (int c = 0; c < n; c++)
            CHECK(system_show(p->system, BLOCK_NETWORK, r, c, &a[r * n + c], diag));
        CHECK(system_show(p->system, BLOCK_NETWORK_RHS, r, 0, &b[r], diag));
        symbols[r] = network_unknown(p->system, r);
    }
    for (int i = 0; i < n * n; i++)
        a[i] = expr_open(p->arena, a[i]);
    for (int i = 0; i < n; i++)
        b[i] = expr_open(p->arena, b[i]);
    status = symbolic_solve(p->arena, a, b, n, 1, NULL, 0, p->options.watch, x, &unknown);
    if (status == E_SINGULAR)
        status = diag_set(diag, E_SINGULAR, "the equations of the network have no single solution");
    CHECK(status);
    for (int i = 0; i < p->nu; i++)
        p->force[i] =
            symbolic_tidy(p->arena, expr_substitute(p->arena, p->force[i], symbols, x, n));
done:
    MEM_FREE(a, b, x, symbols);
    return status;
}

static Status eliminate_network(PortEquations *p, Diag *diag)
{
    if (p->options.is_numeric || p->options.keeps_networks || !reads_network(p))
        return OK;
    p->nonlinear = nonlinear_part(p->system);
    if (p->nonlinear != NULL || system_nx(p->system) + system_nz(p->system) > MOST_NETWORK)
        return OK;
    return solve_network(p, diag);
}

/* terms of F that contain u' belong to M */
static Status move_inertia(PortEquations *p, Diag *diag)
{
    const int nu = p->nu;
    Expr *symbols = NEW_ARRAY(Expr, nu);
    Status status = OK;

    for (int j = 0; j < nu; j++)
        symbols[j] = system_acceleration(p->system, j);
    for (int i = 0; i < nu; i++) {
        if ((expr_kinds(p->force[i]) & 1U << SYMBOL_ACCELERATION) == 0)
            continue;
        for (int j = 0; j < nu; j++) {
            const Expr slope = expr_diff(p->arena, p->force[i], symbols[j]);

            if ((expr_kinds(slope) & 1U << SYMBOL_ACCELERATION) != 0)
                CHECK(diag_set(diag, E_MODEL, "a force isn't linear in accelerations"));
            p->mass[i * nu + j] = expr_sub(p->arena, p->mass[i * nu + j], slope);
        }
        p->force[i] = expr_substitute(p->arena, p->force[i], symbols, NULL, nu);
    }
done:
    mem_free(symbols);
    return status;
}

static Status check_forces(const PortEquations *p, Diag *diag)
{
    for (int i = 0; i < p->nu; i++)
        if ((expr_kinds(p->force[i]) & 1U << SYMBOL_MULTIPLIER) != 0) {
            (void)diag_set(diag, E_MODEL,
                           "a force along %s depends on reactions: forces and accelerations at a "
                           "frame are in no linear relation",
                           system_u(p->system, i)->name);
            diag_hint(diag, "friction that depends on a joint's load does that");
            return E_MODEL;
        }
    return OK;
}

Status port_new(System *view, const PortOptions *options, PortEquations **out, Diag *diag)
{
    PortEquations *p = NEW(PortEquations);
    Status status = OK;

    p->arena = system_arena(view);
    p->system = view;
    p->options = *options;
    p->nu = system_nu(view);
    p->m = system_m(view);
    p->ends = options->count + options->given_count;
    p->mass = NEW_ARRAY(Expr, p->nu * p->nu + 1);
    p->phi_u = NEW_ARRAY(Expr, p->nu * p->m + 1);
    p->force = NEW_ARRAY(Expr, p->nu + 1);
    p->gamma = NEW_ARRAY(Expr, p->m + 1);
    p->slope = NEW_ARRAY(Expr, p->ends * p->nu + 1);
    p->rest = NEW_ARRAY(Expr, p->ends + 1);
    if (!options->is_numeric && p->nu + p->m + p->ends > MOST_UNKNOWNS) {
        status = diag_set(diag, E_VALUE, "%d accelerations and reactions are too many for symbols",
                          p->nu + p->m);
        diag_hint(diag, "numbers are shown with 'at' and an instant");
        goto done;
    }
    CHECK(options->is_numeric ? read_definitions(p, diag) : read_mechanism(p, diag));
    CHECK(read_ends(p, diag));
    CHECK(check_forces(p, diag));
    CHECK(eliminate_network(p, diag));
    CHECK(move_inertia(p, diag));
    *out = p;
    p = NULL;
done:
    port_free(p);
    return status;
}

void port_free(PortEquations *port)
{
    if (port == NULL)
        return;
    MEM_FREE(port->mass, port->phi_u, port->force, port->gamma, port->slope, port->rest, port);
}

int port_symbols_of(const PortEquations *p, Expr **out)
{
    const int nu = p->nu;
    LIST(Expr) roots = {0};
    int count;

    for (int i = 0; i < nu * nu; i++)
        LIST_PUSH(roots, p->mass[i]);
    for (int i = 0; i < nu * p->m; i++)
        LIST_PUSH(roots, p->phi_u[i]);
    for (int i = 0; i < nu * p->ends; i++)
        LIST_PUSH(roots, p->slope[i]);
    for (int i = 0; i < nu; i++)
        LIST_PUSH(roots, p->force[i]);
    for (int i = 0; i < p->m; i++)
        LIST_PUSH(roots, p->gamma[i]);
    for (int i = 0; i < p->ends; i++)
        LIST_PUSH(roots, p->rest[i]);
    count = expr_symbols(roots.at, roots.count, out);
    LIST_FREE(roots);
    return count;
}

/* --- the linear system --- */

/* where unknowns start; equations are in the same order */
typedef struct PortPlaces {
    int multiplier, given, port, count;
} PortPlaces;

static PortPlaces port_places(const PortEquations *p, int m)
{
    const PortPlaces at = {.multiplier = p->nu,
                           .given = p->nu + m,
                           .port = p->nu + m + p->options.given_count,
                           .count = p->nu + m + p->options.given_count +
                                    (p->options.is_norton ? p->options.count : 0)};

    return at;
}

static void set_fault(const PortEquations *p, int unknown, PortFault *fault)
{
    *fault = (PortFault){.unknown = NULL};
    if (unknown >= 0 && unknown < p->nu)
        fault->unknown = system_u(p->system, unknown)->name;
    for (int k = 0; k < p->m && fault->driver == NULL; k++)
        if (system_constraint(p->system, k)->is_driver)
            fault->driver =
                system_instance_name(p->system, system_constraint(p->system, k)->instance);
}

/* --- in symbols --- */

static void fill_symbols(const PortEquations *p, const PortPlaces *at, Expr *a, Expr *b)
{
    Arena *arena = p->arena;
    const Expr zero = expr_int(arena, 0), one = expr_int(arena, 1);
    const int nu = p->nu, count = p->options.count, columns = 1 + count, n = at->count;

    for (int i = 0; i < n * n; i++)
        a[i] = zero;
    for (int i = 0; i < n * columns; i++)
        b[i] = zero;
    for (int i = 0; i < nu; i++) {
        for (int j = 0; j < nu; j++)
            a[i * n + j] = p->mass[i * nu + j];
        b[i * columns] = p->force[i];
    }
    for (int k = 0; k < p->m; k++) {
        for (int j = 0; j < nu; j++)
            a[(at->multiplier + k) * n + j] = a[j * n + at->multiplier + k] = p->phi_u[k * nu + j];
        b[(at->multiplier + k) * columns] = p->gamma[k];
    }
    for (int i = 0; i < p->ends; i++) {
        const bool is_given = i >= count;
        const int row = is_given ? at->given + i - count : at->port + i;

        for (int j = 0; j < nu; j++) {
            const Expr slope = p->slope[i * nu + j];

            if (is_given || p->options.is_norton) {
                a[row * n + j] = slope;
                a[j * n + row] = expr_neg(arena, slope);
            } else {
                b[j * columns + 1 + i] = slope;
            }
        }
        if (!is_given && !p->options.is_norton)
            continue;
        b[row * columns] = expr_neg(arena, p->rest[i]);
        if (!is_given)
            b[row * columns + 1 + i] = one;
    }
}

/* a = b + J u' */
static Expr port_acceleration(const PortEquations *p, const Expr *x, int i, int column)
{
    Expr sum = column == 0 ? p->rest[i] : expr_int(p->arena, 0);

    for (int j = 0; j < p->nu; j++)
        sum = expr_add(
            p->arena, sum,
            expr_mul(p->arena, p->slope[i * p->nu + j], x[j * (1 + p->options.count) + column]));
    return symbolic_tidy(p->arena, sum);
}

typedef LIST(Expr) Units;

static Units port_units(const PortEquations *p)
{
    Units units = {0};

    for (int i = 0; system_quaternion(p->system, i) >= 0; i++)
        for (int k = 0; k < 4; k++)
            LIST_PUSH(units, system_q(p->system, system_quaternion(p->system, i) + k)->symbol);
    return units;
}

void port_fold_units(const PortEquations *p, Expr *e, int count)
{
    Units units = port_units(p);

    if (units.count > 0)
        symbolic_fold_units(p->arena, e, count, units.at, units.count / 4);
    LIST_FREE(units);
}

Status port_symbols(const PortEquations *p, Expr *constant, Expr *matrix, PortFault *fault)
{
    const PortPlaces at = port_places(p, p->m);
    const int n = at.count, count = p->options.count, columns = 1 + count;
    Expr *a = NEW_ARRAY(Expr, n * n + 1), *b = NEW_ARRAY(Expr, n * columns + 1),
         *x = NEW_ARRAY(Expr, n * columns + 1);
    Units units = port_units(p);
    int unknown = -1;
    Status status;

    fill_symbols(p, &at, a, b);
    status = symbolic_solve(p->arena, a, b, n, columns, units.at, units.count / 4, p->options.watch,
                            x, &unknown);
    if (status == E_SINGULAR)
        set_fault(p, unknown, fault);
    CHECK(status);
    for (int i = 0; i < count; i++)
        for (int c = 0; c < columns; c++) {
            Expr *to = c == 0 ? &constant[i] : &matrix[i * count + c - 1];

            CHECK(monitor_poll(p->options.watch));
            if (!p->options.is_norton)
                *to = port_acceleration(p, x, i, c);
            else if (c == 0)
                *to = expr_neg(p->arena, x[(at.port + i) * columns]);
            else
                *to = x[(at.port + i) * columns + c];
        }
done:
    LIST_FREE(units);
    MEM_FREE(a, b, x);
    return status;
}

/* --- in numbers --- */

typedef struct PortNumbers {
    double *mass, *phi_u, *force, *gamma, *slope, *rest;
    int m; /* constraints, without those that depend on others */
} PortNumbers;

static double *numbers_of(Evaluation *evaluation, const Expr *at, int count, bool *is_finite)
{
    double *out = NEW_ARRAY(double, count + 1);

    for (int i = 0; i < count; i++) {
        out[i] = evaluation_of(evaluation, at[i]);
        *is_finite = *is_finite && isfinite(out[i]);
    }
    return out;
}

static Status drop_dependent(const PortEquations *p, PortNumbers *n)
{
    int *order = NEW_ARRAY(int, p->m + 1);
    Status status = OK;

    n->m = p->m;
    if (p->m == 0 || p->nu == 0)
        goto done;
    CHECK(rank_rows(n->phi_u, p->m, p->nu, least_independent, p->options.watch, &n->m, order));
    for (int k = 0; k < n->m; k++) {
        memmove(n->phi_u + k * p->nu, n->phi_u + order[k] * p->nu, (size_t)p->nu * sizeof(double));
        n->gamma[k] = n->gamma[order[k]];
    }
done:
    mem_free(order);
    return status;
}

static void fill_numbers(const PortEquations *p, const PortNumbers *f, const PortPlaces *at,
                         double *a, double *b)
{
    const int nu = p->nu, count = p->options.count, columns = 1 + count, n = at->count;

    for (int i = 0; i < nu; i++) {
        for (int j = 0; j < nu; j++)
            a[i * n + j] = f->mass[i * nu + j];
        b[i * columns] = f->force[i];
    }
    for (int k = 0; k < f->m; k++) {
        for (int j = 0; j < nu; j++)
            a[(at->multiplier + k) * n + j] = a[j * n + at->multiplier + k] = f->phi_u[k * nu + j];
        b[(at->multiplier + k) * columns] = f->gamma[k];
    }
    for (int i = 0; i < p->ends; i++) {
        const bool is_row = i >= count || p->options.is_norton;
        const int row = i >= count ? at->given + i - count : at->port + i;

        for (int j = 0; j < nu; j++) {
            const double slope = f->slope[i * nu + j];

            if (is_row) {
                a[row * n + j] = slope;
                a[j * n + row] = -slope;
            } else {
                b[j * columns + 1 + i] = slope;
            }
        }
        if (is_row)
            b[row * columns] = -f->rest[i];
        if (is_row && i < count)
            b[row * columns + 1 + i] = 1;
    }
}

/* Scales rows and columns to size 1, by a few rounds (Ruiz 2001). */
static void equilibrate(double *a, int n, double *row, double *column)
{
    enum { ROUNDS = 8 };

    for (int i = 0; i < n; i++)
        row[i] = column[i] = 1;
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < n; i++) {
                double most = 0;

                for (int j = 0; j < n; j++)
                    most = fmax(most, fabs(k == 0 ? a[i * n + j] : a[j * n + i]));
                if (most == 0)
                    continue;
                most = 1 / sqrt(most);
                for (int j = 0; j < n; j++)
                    *(k == 0 ? &a[i * n + j] : &a[j * n + i]) *= most;
                *(k == 0 ? &row[i] : &column[i]) *= most;
            }
}

/* a x = b by elimination with complete pivoting; b becomes x. Returns the rank. */
static int solve_completely(double *a, double *b, int n, int columns, int *unknown)
{
    double *row = NEW_ARRAY(double, n + 1), *column = NEW_ARRAY(double, n + 1);
    int *place = NEW_ARRAY(int, n + 1);
    int rank = 0;

    equilibrate(a, n, row, column);
    for (int i = 0; i < n; i++) {
        place[i] = i;
        for (int c = 0; c < columns; c++)
            b[i * columns + c] *= row[i];
    }
    for (; rank < n; rank++) {
        int p = rank, q = rank;

        for (int i = rank; i < n; i++)
            for (int j = rank; j < n; j++)
                if (fabs(a[i * n + j]) > fabs(a[p * n + q])) {
                    p = i;
                    q = j;
                }
        if (fabs(a[p * n + q]) <= least_pivot)
            break;
        for (int j = 0; j < n; j++) {
            const double swapped = a[p * n + j];

            a[p * n + j] = a[rank * n + j];
            a[rank * n + j] = swapped;
        }
        for (int c = 0; c < columns; c++) {
            const double swapped = b[p * columns + c];

            b[p * columns + c] = b[rank * columns + c];
            b[rank * columns + c] = swapped;
        }
        for (int i = 0; i < n; i++) {
            const double swapped = a[i * n + q];

            a[i * n + q] = a[i * n + rank];
            a[i * n + rank] = swapped;
        }
        {
            const int swapped = place[q];

            place[q] = place[rank];
            place[rank] = swapped;
        }
        for (int i = rank + 1; i < n; i++) {
            const double factor = a[i * n + rank] / a[rank * n + rank];

            if (factor == 0)
                continue;
            for (int j = rank; j < n; j++)
                a[i * n + j] -= factor * a[rank * n + j];
            for (int c = 0; c < columns; c++)
                b[i * columns + c] -= factor * b[rank * columns + c];
        }
    }
    *unknown = rank < n ? place[n - 1] : -1;
    for (int c = 0; c < columns && rank == n; c++) {
        double *x = NEW_ARRAY(double, n + 1);

        for (int i = n - 1; i >= 0; i--) {
            double sum = b[i * columns + c];

            for (int j = i + 1; j < n; j++)
                sum -= a[i * n + j] * x[place[j]];
            x[place[i]] = sum / a[i * n + i];
        }
        for (int i = 0; i < n; i++)
            b[i * columns + c] = x[i] * column[i];
        mem_free(x);
    }
    MEM_FREE(row, column, place);
    return rank;
}

static void read_solution(const PortEquations *p, const PortNumbers *f, const PortPlaces *at,
                          const double *x, double *constant, double *matrix)
{
    const int count = p->options.count, columns = 1 + count;

    for (int i = 0; i < count; i++)
        for (int c = 0; c < columns; c++) {
            double value = c == 0 ? f->rest[i] : 0;

            if (p->options.is_norton)
                value = (c == 0 ? -1 : 1) * x[(at->port + i) * columns + c];
            for (int j = 0; j < p->nu && !p->options.is_norton; j++)
                value += f->slope[i * p->nu + j] * x[j * columns + c];
            *(c == 0 ? &constant[i] : &matrix[i * count + c - 1]) = value;
        }
}

Status port_numbers(const PortEquations *p, SymbolValue value, void *context, double *constant,
                    double *matrix, PortFault *fault)
{
    Evaluation *evaluation = evaluation_new(value, context);
    const int nu = p->nu;
    bool is_finite = true;
    PortNumbers f = {.mass = numbers_of(evaluation, p->mass, nu * nu, &is_finite),
                     .phi_u = numbers_of(evaluation, p->phi_u, nu * p->m, &is_finite),
                     .force = numbers_of(evaluation, p->force, nu, &is_finite),
                     .gamma = numbers_of(evaluation, p->gamma, p->m, &is_finite),
                     .slope = numbers_of(evaluation, p->slope, nu * p->ends, &is_finite),
                     .rest = numbers_of(evaluation, p->rest, p->ends, &is_finite)};
    double *a = NULL, *b = NULL;
    PortPlaces at;
    int unknown;
    Status status = OK;

    CHECK(is_finite ? OK : E_VALUE);
    CHECK(drop_dependent(p, &f));
    at = port_places(p, f.m);
    a = NEW_ARRAY(double, at.count *at.count + 1);
    b = NEW_ARRAY(double, at.count *(1 + p->options.count) + 1);
    fill_numbers(p, &f, &at, a, b);
    if (solve_completely(a, b, at.count, 1 + p->options.count, &unknown) < at.count) {
        set_fault(p, unknown, fault);
        status = E_SINGULAR;
        goto done;
    }
    read_solution(p, &f, &at, b, constant, matrix);
done:
    evaluation_free(evaluation);
    MEM_FREE(f.mass, f.phi_u, f.force, f.gamma, f.slope, f.rest, a, b);
    return status;
}
