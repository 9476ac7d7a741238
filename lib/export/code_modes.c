/* code_modes.c: ideal switches in exported code: one set of equations, with the switch states as
 * parameters
 *
 * A run has a System for each mode, with a tree, and so states, of its own. Code has the equations
 * of the whole, each ideal switch with a row
 *
 *     closed (v - least - on i) + (1 - closed) (i - v/off) = 0
 *
 * and its solver determines the rank numerically (share/code/modes.c): the states are those of the
 * whole in every mode, and the conditions of a mode on them are constraints. theory 8. */
#include "export/code.h"

#include "algebra/rank.h"

#include <math.h>
#include <string.h>

static Expr other(Arena *arena, Expr closed)
{
    return expr_sub(arena, expr_int(arena, 1), closed);
}

static Status refuse_form(const Code *code, const char *name, Diag *diag)
{
    (void)diag_set(diag, E_MODEL, "%s is ideal, and the equations of this form have no row for it",
                   name);
    diag_hint(diag, system_network_form(code->layout->system) == NETWORK_TREE
                        ? "'set network state', or give it Ron= and Roff="
                        : "give it Ron= and Roff=");
    return E_MODEL;
}

Status code_find_modes(Code *code, Diag *diag)
{
    System *system = code->layout->system;
    const bool of_tree =
        system_network_form(system) == NETWORK_TREE && !system_tree_is_normal(system);

    for (int k = 0; k < system_ideal_count(system); k++) {
        CodeIdeal found = {.place = k};
        Text name = {0};

        if (!system_is_ideal(system, k))
            continue;
        TRY(system_ideal(system, k, &found.ideal, diag));
        if (found.ideal.row < 0 || of_tree)
            return refuse_form(code, found.ideal.name, diag);
        text_addf(&name, "%s.closed", found.ideal.name);
        found.closed = expr_symbol(code->arena, pool_text(code->texts, name.at, name.length),
                                   SYMBOL_PARAMETER);
        text_free(&name);
        LIST_PUSH(code->modes.ideals, found);
    }
    return OK;
}

bool code_has_modes(const Code *code)
{
    return code->modes.ideals.count > 0;
}

/* its row of the residual */
static Expr sided(Arena *arena, const CodeIdeal *found)
{
    const IdealSwitch *ideal = &found->ideal;
    Expr closed = expr_sub(arena, ideal->across, expr_mul(arena, ideal->on, ideal->through));
    Expr open = ideal->through;

    if (ideal->off != NULL)
        open = expr_sub(
            arena, expr_div(arena, expr_add(arena, ideal->across, ideal->least), ideal->off), open);
    return expr_add(arena, expr_mul(arena, found->closed, closed),
                    expr_mul(arena, other(arena, found->closed), open));
}

void code_sided_rows(const Code *code, Expr *rows)
{
    for (int k = 0; k < code->modes.ideals.count; k++) {
        const CodeIdeal *found = &code->modes.ideals.at[k];

        rows[found->ideal.row] = sided(code->arena, found);
    }
}

/* what a circuit of closed ones shares, or a cutset of open ones: currents, voltages */
static Expr shared(Arena *arena, const CodeIdeal *found)
{
    return expr_add(arena, expr_mul(arena, found->closed, found->ideal.through),
                    expr_mul(arena, other(arena, found->closed),
                             expr_add(arena, found->ideal.across, found->ideal.least)));
}

typedef struct Sought {
    Expr call;
} Sought;

static bool is_sought(Expr e, void *context)
{
    return e == ((const Sought *)context)->call;
}

bool code_is_side(const Code *code, Expr call)
{
    const EquationForm *r = system_run(code->layout->system);
    Sought sought = {call};
    bool is = false;

    for (int k = 0; k < code->modes.ideals.count && !is; k++) {
        const IdealSwitch *ideal = &code->modes.ideals.at[k].ideal;
        Expr *found = NULL;

        if (ideal->when != NULL)
            continue;
        is = expr_find(&r->network_residual[ideal->row], 1, is_sought, &sought, &found) > 0;
        mem_free(found);
    }
    return is;
}

void code_margins(const Code *code, Expr *out)
{
    for (int k = 0; k < code->modes.ideals.count; k++) {
        const CodeIdeal *found = &code->modes.ideals.at[k];

        out[k] =
            found->ideal.when != NULL
                ? expr_int(code->arena, 0)
                : expr_add(code->arena, expr_mul(code->arena, found->closed, found->ideal.through),
                           expr_mul(code->arena, other(code->arena, found->closed),
                                    found->ideal.across));
    }
}

/* the rate of a row of networks along the motion, s as it is */
static Expr rate_of(const Code *code, Expr row)
{
    const VariableIndex *l = code->layout;
    const int room = 1 + l->n + l->nu + l->nx;
    Expr *symbols = NEW_ARRAY(Expr, room), *rates = NEW_ARRAY(Expr, room);
    int count = 0;

    symbols[count] = l->symbols[l->t];
    rates[count++] = expr_int(code->arena, 1);
    for (int i = 0; i < l->n; i++) {
        symbols[count] = l->symbols[l->q + i];
        rates[count++] = system_run(l->system)->q_rate[i];
    }
    for (int i = 0; i < l->nu; i++) {
        symbols[count] = l->symbols[l->u + i];
        rates[count++] = l->symbols[l->acceleration + i];
    }
    for (int i = 0; i < l->nx; i++) {
        symbols[count] = l->symbols[l->x + i];
        rates[count++] = l->symbols[l->rates + i];
    }
    row = expr_diff_along(code->arena, row, symbols, rates, count);
    MEM_FREE(symbols, rates);
    return row;
}

static Status add_looks(Code *code, Diag *diag)
{
    System *system = code->layout->system;
    const int count = code->modes.ideals.count, edges = system_scalar_count(system);
    Expr *looks = NEW_ARRAY(Expr, 4 * count), *pairs = NEW_ARRAY(Expr, 2 * edges);
    Status status = OK;

    for (int k = 0; k < count; k++) {
        const IdealSwitch *ideal = &code->modes.ideals.at[k].ideal;

        looks[4 * k] = ideal->through;
        looks[4 * k + 1] = ideal->across;
        looks[4 * k + 2] = ideal->when != NULL ? ideal->when : expr_int(code->arena, -1);
        looks[4 * k + 3] = ideal->on;
    }
    for (int i = 0; i < edges; i++) {
        ScalarPair pair;

        CHECK(system_scalar(system, i, &pair, diag));
        pairs[2 * i] = pair.through;
        pairs[2 * i + 1] = pair.across;
        LIST_PUSH(code->modes.gives, pair.gives_across);
        LIST_PUSH(code->modes.gives, pair.gives_through);
    }
    code_add_function(code, "looks",
                      "of each ideal switch: through, across, condition (-1: a diode), resistance",
                      looks, count, 4);
    code_add_function(code, "edges", "through and across variable of each scalar edge", pairs,
                      edges, 2);
done:
    MEM_FREE(looks, pairs);
    return status;
}

Status code_add_modes(Code *code, const Expr *rows, int count, Diag *diag)
{
    const int networks = code->layout->nx + code->layout->nz;
    Expr *rates = NEW_ARRAY(Expr, count), *shares = NEW_ARRAY(Expr, count);

    for (int i = 0; i < count; i++) {
        rates[i] = i < networks ? rate_of(code, rows[i]) : expr_int(code->arena, 0);
        shares[i] = expr_int(code->arena, 0);
    }
    for (int k = 0; k < code->modes.ideals.count; k++)
        shares[code->modes.ideals.at[k].ideal.row] = shared(code->arena, &code->modes.ideals.at[k]);
    code_add_newton(code, rows, count, "modes");
    code->modes.group = code->group_count - 1;
    code->modes.functions[0] =
        code_newton_rows(code, rates, 0, count, "mode_rates", "the same of the rows' rates");
    code->modes.functions[1] = code_newton_rows(code, shares, 0, count, "mode_shares",
                                                "the same of what ideal switches share");
    MEM_FREE(rates, shares);
    return add_looks(code, diag);
}

/* Whether the equations are linear in the solution, so that one Newton step solves them */
static bool is_linear(const Code *code)
{
    const unsigned solved = 1U << SYMBOL_STATE_RATE | 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE |
                            1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER;
    const CodeGroup *group = &code->groups[code->modes.group];
    const CodeFunction *f = &code->functions.at[group->function];

    for (int i = 0; i < group->count; i++)
        for (int j = 0; j < group->count; j++)
            if ((expr_kinds(code->roots.at[f->first + i * f->columns + j]) & solved) != 0)
                return false;
    return true;
}

void code_modes_begin(const Code *code, Text *out)
{
    const CodeGroup *group = &code->groups[code->modes.group];

    text_addf(out,
              "\n#define MODEL_HAS_MODES\n#define MODEL_LEAK 1e-9 /* ohm: where closed ones alone "
              "should carry what they can't */\n"
              "enum { /* ideal switches */\n    MODEL_SWITCHES = %d,\n"
              "    MODEL_CLOSED = %d, /* in p: 1 or 0 each */\n    MODEL_EDGES = %d,\n"
              "    MODEL_MODES_FIRST = %d, /* of s */\n    MODEL_MODES_N = %d,\n"
              "    MODEL_IS_LINEAR = %d\n};\n",
              code->modes.ideals.count, code->modes.first, code->modes.gives.count / 2,
              group->first, group->count, is_linear(code));
}

void code_modes_store(Code *code, const double *roots)
{
    const CodeGroup *group = &code->groups[code->modes.group];
    const CodeFunction *f = &code->functions.at[group->function];
    const int n = group->count;

    mem_free(code->modes.rows);
    code->modes.rows = mem_array((size_t)n * (size_t)n, sizeof *code->modes.rows);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            code->modes.rows[(size_t)i * n + j] = roots[f->first + i * f->columns + j];
}

/* Unknowns are in units of their own, from MV to nA. */
static void scale_columns(double *rows, int n)
{
    for (int j = 0; j < n; j++) {
        double most = 0;

        for (int i = 0; i < n; i++)
            most = fmax(most, fabs(rows[(size_t)i * n + j]));
        for (int i = 0; most > 0 && i < n; i++)
            rows[(size_t)i * n + j] /= most;
    }
}

/* The ideal switch whose row has the largest coefficient in a zero combination of rows: the
 * remainder of arbitrary multipliers minus the least ones. */
static const CodeIdeal *find_dependent(const Code *code, int n)
{
    double *left = NEW_ARRAY(double, n), *least = NEW_ARRAY(double, n);
    const CodeIdeal *found = &code->modes.ideals.at[0];

    for (int i = 0; i < n; i++)
        left[i] = least[i] = 1 + fmod(i * 0.6180339887498949, 1); /* all different */
    rank_least_multipliers(code->modes.rows, n, n, least);
    for (int i = 0; i < n; i++)
        left[i] = fabs(left[i] - least[i]);
    for (int k = 1; k < code->modes.ideals.count; k++)
        if (left[code->modes.ideals.at[k].ideal.row] > left[found->ideal.row])
            found = &code->modes.ideals.at[k];
    MEM_FREE(left, least);
    return found;
}

Status code_modes_check(const Code *code, const char *language, Diag *diag)
{
    static const double NOTHING = 1e-10; /* relative to a row: the same as in exported C */
    const int n = code->groups[code->modes.group].count;
    int *order = NULL, rank = n;
    const CodeIdeal *found;
    Status status = OK;

    if (code->modes.rows == NULL)
        return OK;
    order = NEW_ARRAY(int, n);
    scale_columns(code->modes.rows, n);
    CHECK(rank_rows(code->modes.rows, n, n, NOTHING, code->view->watch, &rank, order));
    if (rank == n)
        goto done;
    found = find_dependent(code, n);
    status = diag_set(
        diag, E_MODEL,
        "%s is ideal and %s at the start, where that constrains states or other ideal parts, "
        "which code in %s can't solve",
        found->ideal.name,
        code->values[code->modes.first + (found - code->modes.ideals.at)] > 0.5 ? "closed" : "open",
        language);
    diag_hint(diag, "'export c' differentiates such conditions; or give %s Ron= and Roff=",
              found->ideal.name);
done:
    mem_free(order);
    return status;
}

void code_modes_free(CodeModes *modes)
{
    mem_free(modes->rows);
    LIST_FREE(modes->ideals);
    LIST_FREE(modes->gives);
}
