/* network_rows.c: equations of the network's unknowns, G([x'; z], ...) = 0, and their Jacobian */
#include "formulate/network/ideal_sides.h"
#include "formulate/network/network_build.h"
#include "formulate/network/network_impl.h"
#include "formulate/network/network_isomorphic.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/smooth.h"
#include "formulate/system/surfaces.h"
#include "formulate/system/system_impl.h"

#include <assert.h>
#include <string.h>

static const unsigned solved_kinds = 1U << SYMBOL_STATE_RATE | 1U << SYMBOL_ALGEBRAIC;

/* --- one equation --- */

/* moves terms of the left side without rates to the right, where a reader expects them */
static void sort_sides(System *system, Unknown *y)
{
    Arena *arena = system->arena;
    Expr left = expr_open(arena, y->left);
    LIST(Expr) dependent = {0};
    LIST(Expr) move = {0};

    if (expr_kind(left) == EXPR_SUM) {
        for (int i = 0; i < expr_arg_count(left); i++) {
            Expr term = expr_arg(left, i);
            Expr own = y->order > 0 ? y->rates[0] : y->symbol;

            if (expr_is_zero(expr_diff(arena, term, own)))
                LIST_PUSH(move, term);
            else
                LIST_PUSH(dependent, term);
        }
        if (dependent.count > 0 && move.count > 0) {
            y->left = expr_sum(arena, dependent.at, dependent.count);
            y->right =
                expr_sub(arena, expr_open(arena, y->right), expr_sum(arena, move.at, move.count));
        }
    }
    LIST_FREE(dependent);
    LIST_FREE(move);
}

/* each term has a minus sign */
static bool is_negative(Expr e)
{
    bool all = expr_kind(e) == EXPR_SUM;

    if (expr_kind(e) == EXPR_PRODUCT)
        return expr_is_number(expr_arg(e, 0)) && expr_value(expr_arg(e, 0)) < 0;
    for (int i = 0; i < expr_arg_count(e) && all; i++)
        all = is_negative(expr_arg(e, i));
    return all;
}

static void choose_sign(System *system, Unknown *y)
{
    if (!is_negative(expr_open(system->arena, y->left)))
        return;
    y->left = expr_neg(system->arena, expr_open(system->arena, y->left));
    y->right = expr_neg(system->arena, expr_open(system->arena, y->right));
}

/* the one of a port's two equations that belongs to this edge: v = value, or i = inverse */
static Status port_row(System *system, Branchlike *branch, Unknown *y, Diag *diag)
{
    bool by_across = branch->branch == port_gives_own(system, branch);

    y->left = by_across ? branch->v : branch->i;
    return variables_resolve(system, by_across ? branch->relation.value : branch->relation.inverse,
                             &y->right, diag);
}

/* left = right by the relation of an edge */
static Status relation_row(System *system, Unknown *y, Diag *diag)
{
    Arena *arena = system->arena;
    Branchlike *branch = &system->network->branches.at[y->branchlike];
    const Relation *relation = &branch->relation;
    Expr v;
    Expr i;
    Expr value = NULL;
    Expr rest = NULL;
    Expr content = NULL;
    bool shared = false;

    TRY(network_across(system, branch, &v, diag));
    TRY(network_through(system, branch, &i, diag));
    if (branch->is_balanced)
        TRY(network_nodes_balance(system, branch, &i, diag));
    if (relation->value != NULL)
        TRY(variables_resolve(system, relation->value, &value, diag));
    if (relation->rest != NULL)
        TRY(variables_resolve(system, relation->rest, &rest, diag));
    if (relation->content != NULL) {
        TRY(variables_resolve(system, relation->content, &content, diag));
        TRY(system_need_smooth(system, graph_edge(system->origin->graph, branch->edge)->name,
                               content, diag));
        TRY(system_rate_of(system, content, &content, diag));
    }
    switch (relation->kind) {
    case RELATION_ACROSS:
        y->left = v;
        y->right = value;
        break;
    case RELATION_THROUGH:
    case RELATION_CONDUCTIVE:
        y->left = branch->is_stiff ? v : i;
        y->right = value;
        if (branch->is_stiff)
            TRY(circuit_across(system, branch, &y->right, diag));
        break;
    case RELATION_RESISTIVE:
        y->left = branch->branch ? v : expr_mul(arena, value, i);
        y->right = branch->branch ? expr_add(arena, expr_mul(arena, value, i), rest)
                                  : expr_sub(arena, v, rest);
        break;
    case RELATION_CAPACITIVE:
        y->left = content;
        y->right = expr_sub(arena, i, rest);
        break;
    case RELATION_INDUCTIVE:
        y->left = content;
        y->right = expr_sub(arena, v, rest);
        break;
    case RELATION_PORT:
        TRY(port_row(system, branch, y, diag));
        break;
    case RELATION_FREE:
    case RELATION_IMPLICIT:
    case RELATION_IDEAL:
        y->left = value;
        y->right = expr_int(arena, 0);
        break;
    }
    if (branch->ideal >= 0)
        TRY(ideal_share(system, branch, &shared, &value, diag));
    if (shared) {
        y->left = value;
        y->right = expr_int(arena, 0);
    }
    return OK;
}

static Status own_row(System *system, Unknown *y, Diag *diag)
{
    const Instance *instance = &system->origin->instances[y->instance];
    OwnState own;

    instance->row->own_state(instance, system->arena, y->own, &own);
    TRY(system_rate_of(system, y->symbol, &y->left, diag));
    return variables_resolve(system, own.rate, &y->right, diag);
}

Status network_row(System *system, int unknown, Diag *diag)
{
    Arena *arena = system->arena;
    Unknown y = system->network->unknowns.at[unknown]; /* the list may move meanwhile */
    bool is_known;

    if (y.has_row)
        return OK;
    TRY(network_isomorphic_find(system, unknown, &y, &is_known, diag));
    if (is_known) {
        y.has_row = true;
        system->network->unknowns.at[unknown] = y;
        return OK;
    }
    if (y.derives >= 0) {
        TRY(network_row(system, y.derives, diag));
        y.left = expr_open(arena, system->network->unknowns.at[y.derives].left);
        y.right = expr_open(arena, system->network->unknowns.at[y.derives].right);
        TRY(system_need_smooth(system, system->origin->instances[y.instance].name,
                               expr_sub(arena, y.left, y.right), diag));
        TRY(system_rate_of(system, y.left, &y.left, diag));
        TRY(system_rate_of(system, y.right, &y.right, diag));
    } else if (y.branchlike >= 0) {
        TRY(relation_row(system, &y, diag));
    } else if (y.law != NODE_NONE) {
        TRY(network_nodes_row(system, &y, diag));
    } else {
        TRY(own_row(system, &y, diag));
    }
    y.order = system->network->unknowns.at[unknown].order;
    y.known = system->network->unknowns.at[unknown].known;
    y.rates = system->network->unknowns.at[unknown].rates;
    sort_sides(system, &y);
    choose_sign(system, &y);
    y.right = expr_fold(arena, expr_open(arena, y.right));
    y.lack = expr_sub(arena, expr_open(arena, y.left), expr_open(arena, y.right));
    y.has_row = true;
    system->network->unknowns.at[unknown] = y;
    network_isomorphic_keep(system, unknown, &y);
    return OK;
}

/* --- lists --- */

/* the edge that an unknown belongs to; for a state of a part's own, the part's first edge */
static int unknown_edge(const System *system, const Unknown *y)
{
    return y->branchlike >= 0 ? system->network->branches.at[y->branchlike].edge
                              : system->origin->instances[y->instance].scalar_edges[0];
}

/* inserts in the order in which the edges were made */
static void show_equation(System *system, NetworkEquation equation)
{
    int at = system->network->equations.count;

    LIST_PUSH(system->network->equations, equation);
    for (; at > 0 && system->network->equations.at[at - 1].edge > equation.edge; at--)
        system->network->equations.at[at] = system->network->equations.at[at - 1];
    system->network->equations.at[at] = equation;
}

void network_list(System *system)
{
    for (; system->network->listed < system->network->unknowns.count; system->network->listed++) {
        const Unknown *y = &system->network->unknowns.at[system->network->listed];
        Expr symbol = y->symbol;

        for (int k = 0; k <= y->order; k++) {
            Variable variable = {.name = expr_name(symbol),
                                 .symbol = symbol,
                                 .edge = unknown_edge(system, y),
                                 .instance = y->instance};

            if (expr_symbol_kind(symbol) == SYMBOL_STATE_RATE)
                break; /* solved for */
            if (expr_symbol_kind(symbol) == SYMBOL_ALGEBRAIC) {
                if (k == 0)
                    LIST_PUSH(system->network->z, variable);
                break;
            }
            LIST_PUSH(system->network->x, variable);
            LIST_PUSH(system->network->rates,
                      expr_symbol(system->arena, system_join(system, variable.name, "'"),
                                  SYMBOL_STATE_RATE));
            symbol = k < y->order ? y->rates[k] : NULL;
            if (symbol == NULL)
                break;
        }
    }
}

/* --- Jacobian --- */

typedef struct NetworkRows {
    System *system;
    int count;        /* number of equations, and of unknowns */
    LIST(int) column; /* by expr_symbol_number(): 1 + index in [x'; z]; 0: none */
    LIST(Entry) entries;
    NetworkSlopes slopes; /* of a row */
} NetworkRows;

static void place(NetworkRows *rows, Expr symbol, int column)
{
    while (rows->column.count <= expr_symbol_number(symbol))
        LIST_PUSH(rows->column, 0);
    assert(rows->column.at != NULL);
    rows->column.at[expr_symbol_number(symbol)] = 1 + column;
}

/* reports an equation that none of the unknowns can satisfy */
static Status cant_be_met(System *system, const Unknown *y, Diag *diag)
{
    const Branchlike *branch =
        y->branchlike >= 0 ? &system->network->branches.at[y->branchlike] : NULL;
    RelationKind kind = branch != NULL ? branch->relation.kind : RELATION_FREE;
    bool ideal = branch != NULL && branch->ideal >= 0;

    if (kind == RELATION_ACROSS && !branch->branch) {
        (void)diag_set(diag, E_MODEL,
                       ideal ? "%s form a circuit without resistance"
                             : "the sources %s form a circuit",
                       network_company(system, branch));
        diag_hint(diag, "put a resistance into it, or leave one of them out");
    } else if (kind == RELATION_THROUGH && branch->branch) {
        (void)diag_set(diag, E_MODEL,
                       ideal ? "%s leave a current no way"
                             : "nothing but sources joins two parts of the network: %s",
                       network_company(system, branch));
        diag_hint(diag, "put a resistance across one of them");
    } else {
        (void)diag_set(diag, E_MODEL, "nothing in the network can satisfy the equation of %s",
                       system->origin->instances[y->instance].name);
        diag_hint(diag, "what it asks for is fixed by states and sources already: put a resistor "
                        "or a capacitor between");
    }
    return E_MODEL;
}

static void find_slopes(Arena *arena, Expr residual, NetworkSlopes *slopes)
{
    Expr *symbols;
    const int count = expr_symbols(&residual, 1, &symbols);
    int used = 0;

    slopes->symbols.count = slopes->values.count = 0;
    slopes->is_nonlinear = switch_jumps_over(arena, residual, solved_kinds);
    for (int i = 0; i < count; i++) {
        Expr slope;

        if ((expr_kinds(symbols[i]) & solved_kinds) == 0)
            continue;
        symbols[used++] = symbols[i];
        slope = expr_diff(arena, residual, symbols[i]);
        if (expr_is_zero(slope))
            continue;
        slopes->is_nonlinear = slopes->is_nonlinear || (expr_kinds(slope) & solved_kinds) != 0;
        LIST_PUSH(slopes->symbols, symbols[i]);
        LIST_PUSH(slopes->values, slope);
    }
    slopes->rest = expr_neg(arena, expr_substitute(arena, residual, symbols, NULL, used));
    mem_free(symbols);
}

/* `unknown`: the unknown whose left - right it is; -1: it is another expression */
static Status add_row(NetworkRows *rows, int row, Expr residual, int unknown, const Unknown *y,
                      Diag *diag)
{
    System *system = rows->system;
    EquationForm *run = &system->run;
    NetworkSlopes *slopes = &rows->slopes;

    if (unknown < 0 || !network_isomorphic_slopes(system, unknown, slopes)) {
        find_slopes(system->arena, residual, slopes);
        if (unknown >= 0)
            network_isomorphic_keep_slopes(system, unknown, slopes);
    }
    if (slopes->symbols.count == 0)
        return cant_be_met(system, y, diag);
    for (int i = 0; i < slopes->symbols.count; i++) {
        const int column = rows->column.at[expr_symbol_number(slopes->symbols.at[i])] - 1;

        LIST_PUSH(rows->entries, (Entry){row, column, slopes->values.at[i]});
    }
    run->network_nonlinear = run->network_nonlinear || slopes->is_nonlinear;
    run->network_residual[row] = residual;
    run->network_rhs[row] = slopes->rest;
    return OK;
}

/* moves rates of other states from the right to the left: capacitors in a circuit, coupled
 * inductors */
static void gather_rates(NetworkRows *rows, int first, Expr *left, Expr *right)
{
    System *system = rows->system;
    Arena *arena = system->arena;
    LIST(Expr) terms = {0};
    LIST(Expr) symbols = {0};

    for (int i = first; i < rows->entries.count; i++) {
        const Entry *entry = &rows->entries.at[i];

        if (entry->column >= system->network->x.count)
            continue;
        LIST_PUSH(symbols, system->network->rates.at[entry->column]);
        LIST_PUSH(terms, expr_mul(arena, expr_fold(arena, entry->value),
                                  system->network->rates.at[entry->column]));
    }
    *right = expr_sub(arena, expr_substitute(arena, *right, symbols.at, NULL, symbols.count),
                      expr_substitute(arena, *left, symbols.at, NULL, symbols.count));
    *right = expr_fold(arena, expr_open(arena, *right));
    *left = expr_sum(arena, terms.at, terms.count);
    LIST_FREE(terms);
    LIST_FREE(symbols);
}

/* rows in the order of [x'; z] */
static Status add_rows(NetworkRows *rows, Diag *diag)
{
    System *system = rows->system;
    Arena *arena = system->arena;
    int state = 0;
    int algebraic = system->network->x.count;

    for (int k = 0; k < system->network->unknowns.count; k++) {
        const Unknown *y = &system->network->unknowns.at[k];
        const Expr residual = y->residual != NULL ? y->residual : y->lack;
        bool is_state = expr_symbol_kind(y->symbol) == SYMBOL_STATE;
        int first = rows->entries.count;
        Expr left = y->left;
        Expr right = y->right;

        /* rates that are states themselves */
        for (int l = 0;
             is_state && l < y->order - 1 && expr_symbol_kind(y->rates[l]) == SYMBOL_STATE;
             l++, state++)
            TRY(add_row(rows, state,
                        expr_sub(arena, system->network->rates.at[state],
                                 system->network->x.at[state + 1].symbol),
                        -1, y, diag));
        TRY(add_row(rows, is_state ? state++ : algebraic++, residual, y->residual != NULL ? -1 : k,
                    y, diag));
        if (system->network->form == NETWORK_STATE && is_state &&
            (expr_kinds(right) & 1U << SYMBOL_STATE_RATE) != 0 && !system->run.network_nonlinear)
            gather_rates(rows, first, &left, &right);
        show_equation(system, (NetworkEquation){left, right, unknown_edge(system, y)});
        TRY(monitor_poll(system->watch));
    }
    return OK;
}

static void find_samples(System *system)
{
    for (int k = 0; k < system->network->unknowns.count; k++) {
        const Unknown *y = &system->network->unknowns.at[k];
        OwnSample sample = {.next = NULL};
        OwnState own;

        if (y->own < 0)
            continue;
        system->origin->instances[y->instance].row->own_state(
            &system->origin->instances[y->instance], system->arena, y->own, &own);
        for (int i = 0; i < system->network->x.count; i++)
            if (system->network->x.at[i].symbol == y->symbol)
                sample.state = i;
        sample.initial = own.initial;
        sample.period = own.period;
        sample.next = own.next;
        sample.is_input = own.is_input;
        LIST_PUSH(system->network->samples, sample);
    }
}

/* An equation of states and sources alone, as where an op-amp determines a capacitor's voltage:
 * differentiated once it determines a rate. theory 8. */
static Status differentiate_fixed(System *system, int unknown, Diag *diag)
{
    const unsigned moves = 1U << SYMBOL_STATE;
    const Unknown *y = &system->network->unknowns.at[unknown];
    const Expr residual = y->lack;
    Expr rate;

    if (y->residual != NULL || (expr_kinds(residual) & solved_kinds) != 0 ||
        (expr_kinds(residual) & moves) == 0)
        return OK;
    TRY(system_need_smooth(system, system->origin->instances[y->instance].name, residual, diag));
    TRY(system_rate_of(system, residual, &rate, diag));
    LIST_PUSH(system->network->invariants, residual);
    system->network->unknowns.at[unknown].residual = rate;
    return OK;
}

Status network_rows(System *system, Diag *diag)
{
    EquationForm *run = &system->run;
    NetworkRows rows = {.system = system};
    size_t bytes;
    Status status = OK;

    for (int k = 0; k < system->network->unknowns.count; k++)
        CHECK(network_row(system, k, diag)); /* may add unknowns */
    for (int k = 0; k < system->network->unknowns.count && system->network->form == NETWORK_STATE;
         k++)
        CHECK(differentiate_fixed(system, k, diag));
    network_list(system);
    system->network->is_open = false;
    rows.count = system->network->x.count + system->network->z.count;
    bytes = (size_t)rows.count * sizeof(Expr);
    run->network_residual = pool_alloc(system->pool, bytes);
    run->network_rhs = pool_alloc(system->pool, bytes);
    for (int k = 0; k < system->network->x.count; k++)
        place(&rows, system->network->rates.at[k], k);
    for (int k = 0; k < system->network->z.count; k++)
        place(&rows, system->network->z.at[k].symbol, system->network->x.count + k);
    CHECK(add_rows(&rows, diag));
    run->network_entries = rows.entries.count;
    run->network = pool_alloc(system->pool, (size_t)rows.entries.count * sizeof(Entry));
    if (rows.entries.count > 0)
        memcpy(run->network, rows.entries.at, (size_t)rows.entries.count * sizeof(Entry));
    find_samples(system);
done:
    LIST_FREE(rows.column);
    LIST_FREE(rows.entries);
    LIST_FREE(rows.slopes.symbols);
    LIST_FREE(rows.slopes.values);
    network_isomorphic_free(system->network->alike);
    system->network->alike = NULL;
    return status;
}
