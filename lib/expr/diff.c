/* diff.c: derivatives
 *
 * One pass upward over the nodes in which a symbol of the right kind occurs; the
 * derivative of each follows from those of its arguments. */
#include "expr/expr_impl.h"

/* a pass: derivatives of the nodes walked, by their places */
typedef struct Pass {
    Arena *arena;
    Walk walk;
    LIST(Expr) rates; /* NULL where not known yet */
    unsigned mask;
    Expr symbol; /* of a partial derivative, else NULL */
} Pass;

static Expr rate_of(const Pass *pass, Expr e)
{
    int place = (e->kinds & pass->mask) != 0 ? walk_find(&pass->walk, e) : -1;

    return place >= 0 ? pass->rates.at[place] : arena_zero(pass->arena);
}

static void set_rate(Pass *pass, Expr e, Expr rate)
{
    int place = walk_add(&pass->walk, e);

    while (pass->rates.count <= place)
        LIST_PUSH(pass->rates, (Expr)NULL);
    pass->rates.at[place] = rate;
}

static Expr product_rate(const Pass *pass, Expr e)
{
    const Expr *args = node_args(e);
    Expr *terms = NEW_ARRAY(Expr, e->count);
    Expr *factors = NEW_ARRAY(Expr, e->count);
    int count = 0;
    Expr rate;

    for (int i = 0; i < e->count; i++) {
        Expr inner = rate_of(pass, args[i]);

        if (expr_is_zero(inner))
            continue;
        for (int j = 0; j < e->count; j++)
            factors[j] = j == i ? inner : args[j];
        terms[count++] = expr_product(pass->arena, factors, e->count);
    }
    rate = expr_sum(pass->arena, terms, count);
    MEM_FREE(terms, factors);
    return rate;
}

static Expr sum_rate(const Pass *pass, Expr e)
{
    Expr *terms = NEW_ARRAY(Expr, e->count);
    int count = 0;
    Expr rate;

    for (int i = 0; i < e->count; i++) {
        terms[count] = rate_of(pass, node_args(e)[i]);
        count += !expr_is_zero(terms[count]);
    }
    rate = expr_sum(pass->arena, terms, count);
    mem_free(terms);
    return rate;
}

/* b^n: n*b^(n-1)*b' + b^n*log(b)*n' */
static Expr power_rate(const Pass *pass, Expr e)
{
    Arena *arena = pass->arena;
    Expr base = node_args(e)[0];
    Expr exponent = node_args(e)[1];
    Expr base_rate = rate_of(pass, base);
    Expr exponent_rate = rate_of(pass, exponent);
    Expr rate = arena_zero(arena);

    if (!expr_is_zero(base_rate)) {
        Expr lower = expr_pow(arena, base, expr_sub(arena, exponent, arena_one(arena)));

        rate = expr_product(arena, (Expr[]){exponent, lower, base_rate}, 3);
    }
    if (!expr_is_zero(exponent_rate)) {
        Expr grows =
            expr_product(arena, (Expr[]){e, expr_call1(arena, OP_LOG, base), exponent_rate}, 3);

        rate = expr_add(arena, rate, grows);
    }
    return rate;
}

static Expr call_rate(const Pass *pass, Expr e)
{
    Expr rates[3];
    bool moves = false;

    for (int i = 0; i < e->count; i++) {
        rates[i] = rate_of(pass, node_args(e)[i]);
        moves = moves || !expr_is_zero(rates[i]);
    }
    return moves ? op_derivative(pass->arena, e, rates) : arena_zero(pass->arena);
}

static Expr node_rate(const Pass *pass, Expr e)
{
    switch (e->kind) {
    case EXPR_SUM:
        return sum_rate(pass, e);
    case EXPR_PRODUCT:
        return product_rate(pass, e);
    case EXPR_POWER:
        return power_rate(pass, e);
    case EXPR_CALL:
        return call_rate(pass, e);
    default: /* a constant symbol */
        return arena_zero(pass->arena);
    }
}

/* stops at what is known from before */
static bool unknown(void *context, Expr e)
{
    const Pass *pass = context;

    return e->count == 0 || arena_recall(pass->arena, e, pass->symbol) == NULL;
}

/* Find the derivative of everything below `e`. */
static Expr run_pass(Pass *pass, Expr e)
{
    walk_below(&pass->walk, e, pass->mask, pass->symbol != NULL ? unknown : NULL, pass);
    while (pass->rates.count < pass->walk.count)
        LIST_PUSH(pass->rates, (Expr)NULL);
    for (int i = 0; i < pass->walk.count; i++) {
        Expr node = pass->walk.nodes[i];

        if (pass->rates.at[i] != NULL)
            continue;
        if (pass->symbol != NULL && node->count > 0)
            pass->rates.at[i] = arena_recall(pass->arena, node, pass->symbol);
        if (pass->rates.at[i] != NULL)
            continue;
        pass->rates.at[i] = node_rate(pass, node);
        if (pass->symbol != NULL && node->count > 0)
            arena_remember(pass->arena, node, pass->symbol, pass->rates.at[i]);
    }
    return rate_of(pass, e);
}

static void end_pass(Pass *pass)
{
    walk_free(&pass->walk);
    LIST_FREE(pass->rates);
}

Expr expr_diff(Arena *arena, Expr e, Expr symbol)
{
    Pass pass = {.arena = arena, .symbol = symbol, .mask = symbol->kinds};
    Expr rate;

    if (e == symbol)
        return arena_one(arena);
    if ((e->kinds & symbol->kinds) == 0 || e->count == 0)
        return arena_zero(arena);
    rate = arena_recall(arena, e, symbol);
    if (rate != NULL)
        return rate;
    set_rate(&pass, symbol, arena_one(arena));
    rate = run_pass(&pass, e);
    end_pass(&pass);
    return rate;
}

Expr expr_diff_along(Arena *arena, Expr e, const Expr *symbols, const Expr *rates, int count)
{
    Pass pass = {.arena = arena};
    Expr rate;

    for (int i = 0; i < count; i++) {
        pass.mask |= symbols[i]->kinds;
        set_rate(&pass, symbols[i], rates[i]);
    }
    if ((e->kinds & pass.mask) == 0)
        rate = arena_zero(arena);
    else
        rate = run_pass(&pass, e);
    end_pass(&pass);
    return rate;
}
