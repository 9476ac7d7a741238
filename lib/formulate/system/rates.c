/* rates.c: derivatives along the motion, and the network's unknowns, whose rates may be unknowns
 *
 * The rate of a coordinate follows from speeds, and the rate of a speed is an acceleration. The
 * rate of a network's unknown is a symbol, or follows from its differentiated equation. */
#include "formulate/system/rates.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/resolve.h"
#include "formulate/system/system_impl.h"

#include <string.h>

/* --- unknowns of the network --- */

void network_know(System *system, Expr symbol, int unknown, int order)
{
    int number = expr_symbol_number(symbol);

    while (system->network->unknown_of.count <= number) {
        LIST_PUSH(system->network->unknown_of, 0);
        LIST_PUSH(system->network->rate_of, 0);
    }
    system->network->unknown_of.at[number] = 1 + unknown;
    system->network->rate_of.at[number] = order;
}

static bool is_of_network(const System *system, Expr symbol)
{
    int number = expr_symbol_number(symbol);

    return number < system->network->unknown_of.count && system->network->unknown_of.at[number] > 0;
}

int network_new_unknown(System *system, Unknown unknown, const char *name, SymbolKind kind)
{
    unknown.symbol = expr_symbol(system->arena, name, kind);
    LIST_PUSH(system->network->unknowns, unknown);
    network_know(system, unknown.symbol, system->network->unknowns.count - 1, 0);
    return system->network->unknowns.count - 1;
}

/* a rate that is an expression does not change the order */
static void push_rate(System *system, Unknown *y, Expr rate, bool is_expression)
{
    Expr *rates = pool_alloc(system->pool, (size_t)(y->known + 1) * sizeof(Expr));

    if (y->known > 0)
        memcpy(rates, y->rates, (size_t)y->known * sizeof(Expr));
    rates[y->known++] = rate;
    y->rates = rates;
    if (!is_expression)
        y->order = y->known;
}

/* adds one more rate of an unknown, as a symbol */
Expr network_add_rate(System *system, int unknown, SymbolKind kind)
{
    Unknown *y = &system->network->unknowns.at[unknown];
    const char *last = expr_name(y->order > 0 ? y->rates[y->order - 1] : y->symbol);
    Expr rate = expr_symbol(system->arena, system_join(system, last, "'"), kind);

    push_rate(system, y, rate, false);
    network_know(system, rate, unknown, y->order);
    return rate;
}

/* how often the unknown's equation has been differentiated */
static int derivations(const System *system, int unknown)
{
    int count = 0;

    for (; system->network->unknowns.at[unknown].derives >= 0; count++)
        unknown = system->network->unknowns.at[unknown].derives;
    return count;
}

/* the next rate of a network symbol; E_MISSING where it can't be determined */
static Status network_rate(System *system, Expr symbol, Expr *out, Diag *diag)
{
    int number = expr_symbol_number(symbol);
    int k = system->network->unknown_of.at[number] - 1;
    int order = system->network->rate_of.at[number];
    Unknown *y = &system->network->unknowns.at[k];

    if (order < y->known) {
        *out = y->rates[order];
        return OK;
    }
    if (!system->network->is_open)
        return diag_set(diag, E_MISSING,
                        "the derivative of %s is not among the network's equations",
                        expr_name(symbol));
    if (order + derivations(system, k) >=
        (system->network->form == NETWORK_TREE ? NETWORK_ORDER : 3)) {
        system->network->has_no_states = system->network->form == NETWORK_STATE;
        (void)diag_set(diag, E_MODEL, "the network's equations need ever more derivatives of %s",
                       expr_name(y->symbol));
        diag_hint(diag, "a source controlled by it stands among inductors or capacitors alone: "
                        "put a resistance there");
        return E_MODEL;
    }
    if (y->order < y->known) {
        TRY(system_rate_of(system, y->rates[y->known - 1], out, diag));
        push_rate(system, &system->network->unknowns.at[k], *out, true);
    } else if (system->network->form == NETWORK_TREE) {
        *out = network_add_rate(system, k, SYMBOL_STATE);
    } else {
        /* algebraic, or the rate of a state: its differentiated equation determines it */
        Unknown more = {.branchlike = -1, .own = -1, .instance = y->instance, .derives = k};
        const char *name = system_retain(system, "%s'", expr_name(symbol));
        int added = network_new_unknown(system, more, name, SYMBOL_ALGEBRAIC);

        *out = system->network->unknowns.at[added].symbol;
        push_rate(system, &system->network->unknowns.at[k], *out, false);
    }
    return OK;
}

/* --- derivatives along the motion --- */

/* whether `symbol` is one of these, which are in the order of making */
static bool occurs(const Expr *symbols, int count, Expr symbol)
{
    int low = 0;

    for (int high = count; low < high;) {
        const int middle = low + (high - low) / 2;

        if (expr_symbol_number(symbols[middle]) < expr_symbol_number(symbol))
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && symbols[low] == symbol;
}

static bool is_open(const System *system, Expr symbol)
{
    for (int i = 0; i < system->network->open.count; i++)
        if (system->network->open.at[i] == symbol)
            return true;
    return false;
}

Expr network_open(System *system, const char *name)
{
    const Expr symbol = expr_symbol(system->arena, name, SYMBOL_EFFORT);

    if (is_open(system, symbol))
        return symbol;
    mem_keep(system->network);
    LIST_PUSH(system->network->open, symbol);
    return symbol;
}

static Status late_rate(Diag *diag)
{
    return diag_set(diag, E_MISSING,
                    "this derivative needs one of an acceleration or of a multiplier");
}

static Status effort_rate(System *system, Expr symbol, Expr *out, Diag *diag)
{
    if (!is_open(system, symbol))
        return late_rate(diag);
    *out = network_open(system, system_retain(system, "%s'", expr_name(symbol)));
    return OK;
}

Status system_rate_of(System *system, Expr e, Expr *out, Diag *diag)
{
    const unsigned late = 1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER;
    const bool moves = (expr_kinds(e) & (1U << SYMBOL_COORDINATE | 1U << SYMBOL_SPEED)) != 0;
    Expr *symbols = NULL;
    LIST(Expr) moved = {0};
    LIST(Expr) rates = {0};
    int count = 0;
    Status status = OK;

    if ((expr_kinds(e) & late) != 0)
        CHECK(late_rate(diag));
    count = expr_symbols(&e, 1, &symbols);
    for (int i = 0; moves && i < system->kinematics->q.count; i++)
        if (occurs(symbols, count, system->kinematics->q.at[i].symbol)) {
            LIST_PUSH(moved, system->kinematics->q.at[i].symbol);
            LIST_PUSH(rates, system_q_rate(system, i));
        }
    for (int i = 0; moves && i < system->kinematics->u.count; i++)
        if (occurs(symbols, count, system->kinematics->u.at[i].symbol)) {
            LIST_PUSH(moved, system->kinematics->u.at[i].symbol);
            LIST_PUSH(rates, system->kinematics->accelerations[i]);
        }
    for (int i = 0; i < count; i++) {
        Expr rate = NULL;

        if (expr_symbol_kind(symbols[i]) == SYMBOL_EFFORT)
            CHECK(effort_rate(system, symbols[i], &rate, diag));
        else if (is_of_network(system, symbols[i]))
            CHECK(network_rate(system, symbols[i], &rate, diag));
        else
            continue;
        LIST_PUSH(moved, symbols[i]);
        LIST_PUSH(rates, rate);
    }
    LIST_PUSH(moved, expr_symbol(system->arena, "t", SYMBOL_TIME));
    LIST_PUSH(rates, expr_int(system->arena, 1));
    *out = expr_diff_along(system->arena, e, moved.at, rates.at, moved.count);
done:
    mem_free(symbols);
    LIST_FREE(moved);
    LIST_FREE(rates);
    return status;
}

Status system_rate(System *system, Expr e, Expr *out, Diag *diag)
{
    system_touch(system);
    return system_rate_of(system, e, out, diag);
}
