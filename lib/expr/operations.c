/* operations.c: operations, as written and after sharing
 *
 * The rule: a sum of n terms is n - 1 additions, a product of n factors n - 1
 * multiplications, x^k is k - 1 of them; a function is one function; a coefficient other
 * than 1 and -1 is a factor; minus is free; a division counts as a multiplication, and
 * needs something above the line: a*b^-1 is one, 1/b too. */
#include "expr/expr_impl.h"

/* counts saturate here */
#define MOST ((int64_t)1 << 62)

static int64_t plus(int64_t a, int64_t b)
{
    return a > MOST - b ? MOST : a + b;
}

OpCount op_count_plus(OpCount a, OpCount b)
{
    return (OpCount){plus(a.add, b.add), plus(a.mul, b.mul), plus(a.fun, b.fun)};
}

/* The operations of a power without those of its arguments, as a factor among others. */
static OpCount power_own(Expr e)
{
    int64_t k;

    if (!expr_integer(node_args(e)[1], &k))
        return (OpCount){.fun = 1};
    return (OpCount){.mul = (k < 0 ? -k : k) - 1};
}

static bool is_below(Expr factor)
{
    return factor->kind == EXPR_POWER && is_number(node_args(factor)[1]) &&
           is_negative(node_args(factor)[1]);
}

static OpCount product_own(Expr e)
{
    ProductFactors factors = term_factors(&e);
    Number number = term_coefficient(e);
    bool counts = !number_is(number, 1) && !number_is(number, -1);
    bool above = counts;

    for (int i = 0; i < factors.count; i++)
        above = above || !is_below(factors.at[i]);
    return (OpCount){.mul = factors.count - 1 + counts + !above};
}

static OpCount node_own(Expr e)
{
    OpCount own = {0};

    switch (e->kind) {
    case EXPR_SUM:
        own.add = e->count - 1;
        return own;
    case EXPR_PRODUCT:
        return product_own(e);
    case EXPR_POWER:
        return power_own(e);
    case EXPR_CALL:
        own.fun = e->op != OP_HOLD;
        return own;
    default:
        return own;
    }
}

/* 1/x on its own, not as a factor, needs one division more than its power */
static OpCount alone(Expr e, OpCount count)
{
    count.mul = plus(count.mul, is_below(held(e)));
    return count;
}

OpCount expr_count(const Expr *roots, int count)
{
    OpCount total = {0};
    OpCount *counts;
    Walk walk = {0};

    walk_roots(&walk, roots, count);
    counts = NEW_ARRAY(OpCount, walk.count);
    for (int i = 0; i < walk.count; i++) {
        Expr e = walk.nodes[i];

        counts[i] = node_own(e);
        for (int j = 0; j < e->count; j++) {
            Expr child = node_args(e)[j];
            OpCount inner = counts[walk_find(&walk, child)];

            if (e->kind != EXPR_PRODUCT && !is_call(e, OP_HOLD))
                inner = alone(child, inner);
            counts[i] = op_count_plus(counts[i], inner);
        }
    }
    for (int i = 0; i < count; i++)
        total = op_count_plus(total, alone(roots[i], counts[walk_find(&walk, roots[i])]));
    mem_free(counts);
    walk_free(&walk);
    return total;
}

/* --- after sharing --- */

/* products met, by their factors without the coefficient */
typedef struct Met {
    Expr *slots;
    uint32_t size;
} Met;

static uint32_t factors_hash(Expr e)
{
    ProductFactors factors = term_factors(&e);
    uint32_t hash = 0;

    for (int i = 0; i < factors.count; i++)
        hash = (hash ^ factors.at[i]->number) * 2654435769U;
    return hash >> 5;
}

static bool same_but_for_sign(Expr a, Expr b)
{
    Number number = term_coefficient(a);

    return order_terms(a, b) == 0 && (number_same(number, term_coefficient(b)) ||
                                      number_same(number_neg(number), term_coefficient(b)));
}

/* Whether a product or its negative was met before; now it was. `met` is large enough. */
static bool meet(Met *met, Expr e)
{
    uint32_t i = factors_hash(e) & (met->size - 1);

    while (met->slots[i] != NULL && !same_but_for_sign(met->slots[i], e))
        i = (i + 1) & (met->size - 1);
    if (met->slots[i] != NULL)
        return true;
    met->slots[i] = e;
    return false;
}

/* the monitor to poll for a stop, how often it was due, and whether it requested one */
typedef struct OperationQuery {
    const CallMonitor *watch;
    uint32_t looks;
    bool is_stopped;
} OperationQuery;

enum { BETWEEN_QUESTIONS = 4096 }; /* nodes: a millisecond or less */

static bool goes_on(void *context, Expr e)
{
    OperationQuery *asked = context;

    (void)e;
    if (++asked->looks % BETWEEN_QUESTIONS == 0)
        asked->is_stopped = asked->is_stopped || monitor_poll(asked->watch) != OK;
    return !asked->is_stopped;
}

/* what is counted doesn't matter once it is stopped */
static OpCount count_shared(const Expr *roots, int count, unsigned kinds, OperationQuery *asked)
{
    OpCount total = {0};
    Met met = {.size = 16};
    Walk walk = {0};
    bool *divides; /* whether 1/x is used on its own, not as a factor */

    for (int i = 0; i < count; i++)
        walk_below(&walk, roots[i], 0, goes_on, asked);
    while (met.size < 2 * (uint32_t)walk.count)
        met.size *= 2;
    met.slots = NEW_ARRAY(Expr, met.size);
    divides = NEW_ARRAY(bool, walk.count);
    for (int i = 0; i < walk.count && goes_on(asked, walk.nodes[i]); i++) {
        Expr e = walk.nodes[i];

        if (kinds != 0 && (expr_kinds(e) & ~kinds) == 0)
            continue;
        if (e->kind != EXPR_PRODUCT || !meet(&met, e))
            total = op_count_plus(total, node_own(e));
        for (int j = 0; j < e->count && e->kind != EXPR_PRODUCT; j++)
            divides[walk_find(&walk, node_args(e)[j])] = true;
    }
    for (int i = 0; i < count && !asked->is_stopped; i++)
        divides[walk_find(&walk, roots[i])] = true;
    for (int i = 0; i < walk.count; i++)
        total.mul = plus(total.mul, divides[i] && is_below(walk.nodes[i]));
    MEM_FREE(divides, met.slots);
    walk_free(&walk);
    return total;
}

OpCount expr_count_without(const Expr *roots, int count, unsigned kinds)
{
    OperationQuery nobody = {.watch = NULL};

    return count_shared(roots, count, kinds, &nobody);
}

OpCount expr_count_shared(const Expr *roots, int count)
{
    return expr_count_without(roots, count, 0);
}

Status expr_count_watched(const Expr *roots, int count, const CallMonitor *watch, OpCount *out)
{
    OperationQuery asked = {.watch = watch};
    const OpCount total = count_shared(roots, count, 0, &asked);

    if (asked.is_stopped)
        return E_STOPPED;
    *out = total;
    return OK;
}

int64_t op_count_total(OpCount count)
{
    return plus(plus(count.add, count.mul), count.fun);
}
