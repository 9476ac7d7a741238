/* initial_problem.c: the equations of one level of assembly: those of the system, then given
 * values */
#include "simulate/assemble/initial_impl.h"

#include "algebra/levenberg_marquardt.h"
#include "simulate/assemble/assemble_limits.h"
#include "simulate/equations/rows.h"

#include <math.h>
#include <string.h>

bool initial_is_of_states(const GivenValue *given)
{
    const unsigned solved = 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE;

    return given->level == LEVEL_NETWORK && (expr_kinds(given->expr) & solved) == 0;
}

static bool is_of_level(const GivenValue *given, StateLevel level)
{
    return level == LEVEL_STATES ? initial_is_of_states(given) : given->level == level;
}

/* number of equations between states alone */
static int invariants_of(const VariableIndex *l)
{
    int count = 0;

    while (system_invariant(l->system, count) != NULL)
        count++;
    return count;
}

Status initial_open_problem(Problem *p, Assembly *a, StateLevel level, bool guesses, Diag *diag)
{
    const VariableIndex *l = a->l;
    int equations = level == LEVEL_NETWORK ? l->nx + l->nz : 0;
    int extra = level >= LEVEL_NETWORK ? equations + invariants_of(l) : 0;
    LIST(Expr) wanted = {0};
    Status status = OK;

    *p = (Problem){.a = a};
    p->picked = NEW_ARRAY(const GivenValue *, a->given_count);
    for (int i = 0; i < a->given_count; i++)
        if (is_of_level(&a->given[i], level) && a->given[i].expr != NULL &&
            (guesses || !a->given[i].value->is_guess))
            p->picked[p->count++] = &a->given[i];
    for (int i = 0; i < extra; i++)
        LIST_PUSH(wanted,
                  i < equations ? row_network(l, i) : system_invariant(l->system, i - equations));
    for (int i = 0; i < p->count; i++)
        LIST_PUSH(wanted, p->picked[i]->expr);
    CHECK(level_rows_new(level, l, a->eq, a->parameters, wanted.at, wanted.count, &p->rows, diag));
    p->rows->y = a->y;
    p->system_rows = p->rows->system_rows + extra;
done:
    LIST_FREE(wanted);
    return status;
}

void initial_close_problem(Problem *p)
{
    level_rows_free(p->rows);
    mem_free(p->picked);
}

Rows initial_rows(Problem *p)
{
    double *target = p->rows->target + p->rows->count - p->count;

    for (int i = 0; i < p->count; i++)
        target[i] = p->picked[i]->target;
    return level_rows(p->rows, p->a->setting->watch);
}

bool initial_misses(double residual)
{
    return !(fabs(residual) <= INITIAL_CLOSED);
}

bool initial_meet(const Rows *rows, const bool *held, double *v, double *residual)
{
    double *left = NEW_ARRAY(double, rows->rows);
    bool met = levenberg_marquardt_solve(rows, held, NULL, INITIAL_TOLERANCE, v, left),
         missed = false;

    for (int i = 0; i < rows->rows && !met; i++)
        missed = missed || initial_misses(left[i]);
    if (residual != NULL)
        memcpy(residual, left, (size_t)rows->rows * sizeof(double));
    mem_free(left);
    return !missed;
}

/* --- messages --- */

static void name_given(Text *text, const StartValue *value)
{
    text_addf(text, "%s%.*s = %.6g", value->name, value->primes, "''''", value->value);
}

static void name_row(Text *text, const VariableIndex *l, int k)
{
    const ConstraintRow *row = system_constraint(l->system, k);

    text_addf(text, "%s (%s)", system_instance_name(l->system, row->instance), row->direction);
}

/* least residual that is reported: where all are small, those of about the largest */
static double least_reported(const double *residual, int count)
{
    double most = 0;

    for (int k = 0; k < count; k++)
        most = isfinite(residual[k]) ? fmax(most, fabs(residual[k])) : INFINITY;
    return fmin(INITIAL_LEAST_REPORTED, 0.1 * most);
}

/* "h9 (x) is missed by 0.03; ..." with the values that were given */
Status initial_conflict(const Problem *p, const double *residual, const char *what, Diag *diag)
{
    const double least = least_reported(residual, p->system_rows + p->count);
    Text text = {0}, values = {0};
    int shown = 0;

    for (int k = 0; k < p->system_rows + p->count; k++) {
        if (fabs(residual[k]) <= least)
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
        else if (p->rows->level >= LEVEL_NETWORK)
            text_addf(&text, "the network's equation %d", k + 1);
        else
            name_row(&text, p->a->l, k);
        if (isfinite(residual[k]))
            text_addf(&text, " by %.3g", fabs(residual[k]));
        else
            text_add(&text, ", undefined there");
    }
    for (int i = 0; i < p->a->given_count; i++)
        if (!p->a->given[i].value->is_guess && p->a->given[i].level <= p->rows->level &&
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
