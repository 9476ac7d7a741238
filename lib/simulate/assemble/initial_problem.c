/* initial_problem.c: the equations of one level of assembly: those of the system, then what was
 * given
 */
#include "simulate/assemble/initial_impl.h"

#include "simulate/equations/rows.h"

#include <math.h>
#include <string.h>

static RowValues row_values(const Problem *p, const double *y)
{
    const Layout *l = p->a->l;
    const double *tail = p->row + l->n + l->nu + l->nx;

    return (RowValues){.q = y,
                       .u = y + l->n,
                       .x = y + l->n + l->nu,
                       .rates = tail,
                       .z = tail + l->nx,
                       .near = p->a->y + layout_turned(l)};
}

/* symbols of the unknowns of a level, one run of the layout's but for the network's */
static void level_symbols(const Problem *p, Expr *out)
{
    const Layout *l = p->a->l;
    int k = 0;

    if (p->level == LEVEL_POSITION)
        for (int i = 0; i < l->n; i++)
            out[k++] = l->symbols[l->q + i];
    if (p->level == LEVEL_VELOCITY)
        for (int i = 0; i < l->nu; i++)
            out[k++] = l->symbols[l->u + i];
    for (int i = 0; p->level >= LEVEL_NETWORK && i < p->symbols; i++)
        out[k++] = l->symbols[l->x + i]; /* x, x', z stand together */
}

bool initial_is_of_states(const GivenValue *given)
{
    const unsigned solved = 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE;

    return given->level == LEVEL_NETWORK && (expr_kinds(given->expr) & solved) == 0;
}

static bool is_of_level(const GivenValue *given, InitialLevel level)
{
    return level == LEVEL_STATES ? initial_is_of_states(given) : given->level == level;
}

/* what states have to satisfy by themselves */
static int invariants_of(const Layout *l)
{
    int count = 0;

    while (system_invariant(l->system, count) != NULL)
        count++;
    return count;
}

Status initial_open_problem(Problem *p, Assembly *a, InitialLevel level, bool guesses, Diag *diag)
{
    const Layout *l = a->l;
    Arena *arena = system_arena(l->system);
    int equations = level == LEVEL_NETWORK ? l->nx + l->nz : 0;
    int extra = level >= LEVEL_NETWORK ? equations + invariants_of(l) : 0;
    LIST(Expr) roots = {0};
    Expr *symbols;
    Status status;

    *p = (Problem){.a = a, .level = level, .system_rows = level >= LEVEL_NETWORK ? extra : l->m};
    p->symbols = level == LEVEL_POSITION   ? l->n
                 : level == LEVEL_VELOCITY ? l->nu
                 : level == LEVEL_STATES   ? l->nx
                                           : 2 * l->nx + l->nz;
    p->columns = level == LEVEL_POSITION ? l->nu : p->symbols;
    p->picked = NEW_ARRAY(const GivenValue *, a->given_count);
    p->row = NEW_ARRAY(double, l->n + l->nu + 2 * l->nx + l->nz);
    for (int i = 0; i < a->given_count; i++)
        if (is_of_level(&a->given[i], level) && a->given[i].expr != NULL &&
            (guesses || !a->given[i].value->is_guess))
            p->picked[p->count++] = &a->given[i];
    symbols = NEW_ARRAY(Expr, p->symbols);
    level_symbols(p, symbols);
    for (int i = 0; i < extra; i++)
        LIST_PUSH(roots,
                  i < equations ? row_network(l, i) : system_invariant(l->system, i - equations));
    for (int i = 0; i < p->count; i++)
        LIST_PUSH(roots, p->picked[i]->expr);
    for (int i = 0; i < extra + p->count; i++)
        for (int j = 0; j < p->symbols; j++)
            LIST_PUSH(roots, expr_diff(arena, roots.at[i], symbols[j]));
    status = probe_new(l, a->parameters, roots.at, roots.count, &p->probe, diag);
    LIST_FREE(roots);
    mem_free(symbols);
    return status;
}

void initial_close_problem(Problem *p)
{
    probe_free(p->probe);
    mem_free(p->picked);
    mem_free(p->row);
}

/* gradient by coordinates to gradient by speeds */
static void along_speeds(const Problem *p, const double *gradient, double *out)
{
    const Equations *eq = p->a->eq;

    for (int j = 0; j < eq->nu; j++) {
        out[j] = eq->map == NULL ? gradient[j] : 0;
        for (int i = 0; eq->map != NULL && i < eq->n; i++)
            out[j] += gradient[i] * eq->map[i * eq->nu + j];
    }
}

/* the probed rows, which follow `first` rows of the system */
static void evaluate_probe(const Problem *p, const double *y, int first, double *residual,
                           double *jacobian)
{
    RowValues row = row_values(p, y);
    int extra = p->level >= LEVEL_NETWORK ? p->system_rows : 0;
    const double *values, *gradients;

    if (extra + p->count == 0)
        return;
    values = probe_values(p->probe, &row);
    gradients = values + extra + p->count;
    for (int i = 0; i < extra + p->count; i++) {
        const double *gradient = gradients + (ptrdiff_t)i * p->symbols;

        residual[first + i] = values[i];
        if (i >= extra)
            residual[first + i] -= p->picked[i - extra]->target;
        if (jacobian != NULL && p->level == LEVEL_POSITION)
            along_speeds(p, gradient, jacobian + (ptrdiff_t)(first + i) * p->columns);
        else if (jacobian != NULL)
            memcpy(jacobian + (ptrdiff_t)(first + i) * p->columns, gradient,
                   (size_t)p->columns * sizeof(double));
    }
}

static void evaluate_position(void *context, const double *v, double *residual, double *jacobian)
{
    const Problem *p = context;
    const Equations *eq = p->a->eq;

    eq->position(eq->context, 0, v);
    memcpy(residual, eq->phi, (size_t)eq->m * sizeof(double));
    if (jacobian != NULL)
        memcpy(jacobian, eq->phi_u, (size_t)(eq->m * eq->nu) * sizeof(double));
    memcpy(p->row, v, (size_t)eq->n * sizeof(double));
    evaluate_probe(p, p->row, eq->m, residual, jacobian);
}

static void move_position(void *context, double *v, const double *step)
{
    const Problem *p = context;
    const Equations *eq = p->a->eq;

    for (int i = 0; i < eq->n; i++) {
        v[i] += eq->map == NULL ? step[i] : 0;
        for (int j = 0; eq->map != NULL && j < eq->nu; j++)
            v[i] += eq->map[i * eq->nu + j] * step[j];
    }
    equations_normalise(eq, v);
}

static void evaluate_velocity(void *context, const double *v, double *residual, double *jacobian)
{
    const Problem *p = context;
    const Equations *eq = p->a->eq;

    eq->velocity(eq->context, v, p->a->y + eq->n + eq->nu);
    for (int k = 0; k < eq->m; k++) {
        residual[k] = -eq->nu_rate[k];
        for (int j = 0; j < eq->nu; j++)
            residual[k] += eq->phi_u[k * eq->nu + j] * v[j];
    }
    if (jacobian != NULL)
        memcpy(jacobian, eq->phi_u, (size_t)(eq->m * eq->nu) * sizeof(double));
    memcpy(p->row, p->a->y, (size_t)(eq->n + eq->nu + eq->nx) * sizeof(double));
    memcpy(p->row + eq->n, v, (size_t)eq->nu * sizeof(double));
    evaluate_probe(p, p->row, eq->m, residual, jacobian);
}

static void evaluate_network(void *context, const double *v, double *residual, double *jacobian)
{
    const Problem *p = context;
    const Equations *eq = p->a->eq;

    memcpy(p->row, p->a->y, (size_t)(eq->n + eq->nu) * sizeof(double));
    memcpy(p->row + eq->n + eq->nu, v, (size_t)p->columns * sizeof(double));
    evaluate_probe(p, p->row, 0, residual, jacobian);
}

Rows initial_rows(Problem *p)
{
    Rows rows = {
        .columns = p->columns, .length = p->symbols, .context = p, .watch = p->a->setting->watch};

    rows.rows = p->system_rows + p->count;
    rows.evaluate = p->level == LEVEL_POSITION   ? evaluate_position
                    : p->level == LEVEL_VELOCITY ? evaluate_velocity
                                                 : evaluate_network;
    rows.move = p->level == LEVEL_POSITION ? move_position : NULL;
    return rows;
}

/* --- messages --- */

static void name_given(Text *text, const StartValue *value)
{
    text_addf(text, "%s%.*s = %.6g", value->name, value->primes, "''''", value->value);
}

static void name_row(Text *text, const Layout *l, int k)
{
    const ConstraintRow *row = system_constraint(l->system, k);

    text_addf(text, "%s (%s)", system_instance_name(l->system, row->instance), row->direction);
}

/* "h9 (x) is missed by 0.03; ..." with the values that were given */
Status initial_conflict(const Problem *p, const double *residual, const char *what, Diag *diag)
{
    Text text = {0}, values = {0};
    int shown = 0;

    for (int k = 0; k < p->system_rows + p->count; k++) {
        if (fabs(residual[k]) <= 1e-9)
            continue;
        if (shown++ == 6) {
            text_add(&text, ", ...");
            break;
        }
        if (shown > 1)
            text_add(&text, ", ");
        if (k >= p->system_rows && p->picked[k - p->system_rows]->is_own)
            text_add(&text, p->picked[k - p->system_rows]->value->name);
        else if (k >= p->system_rows)
            name_given(&text, p->picked[k - p->system_rows]->value);
        else if (p->level >= LEVEL_NETWORK)
            text_addf(&text, "the network's equation %d", k + 1);
        else
            name_row(&text, p->a->l, k);
        if (isfinite(residual[k]))
            text_addf(&text, " by %.3g", fabs(residual[k]));
        else
            text_add(&text, ", undefined there");
    }
    for (int i = 0; i < p->a->given_count; i++)
        if (!p->a->given[i].value->is_guess && p->a->given[i].level <= p->level &&
            !p->a->given[i].is_own) {
            if (values.length > 0)
                text_add(&values, ", ");
            name_given(&values, p->a->given[i].value);
        }
    (void)diag_set(diag, E_ASSEMBLE, "%s; missed: %s%s%s", what,
                   text.at != NULL ? text.at : "nothing, but it is undefined there",
                   values.length > 0 ? "; given: " : "", values.length > 0 ? values.at : "");
    if (values.length > 0)
        diag_hint(diag, "leave one of the given values out, or make it a guess");
    else
        diag_hint(diag, "check the lengths of the loop, or give guesses nearer to a solution");
    text_free(&text);
    text_free(&values);
    return E_ASSEMBLE;
}
