/* collect.c: factors common terms out of sums
 *
 * Of the factors that several terms share, the one that saves most operations is factored out
 * first, together with all other common factors of those terms. The remaining sums, and the new
 * terms, are collected in the same way.
 *
 * A heap orders factors by savings. A factor whose terms were used by another one in the meantime
 * is moved down when it reaches the top. */
#include "expr/expr_impl.h"

/* how often the inner sums, and the result, are collected again */
enum { MOST_LEVELS = 40, MOST_ROUNDS = 6 };

typedef struct Shared {
    LIST(int) terms; /* that have it as a factor */
    int living;      /* of these */
    int64_t own;     /* operations in the factor itself */
} Shared;

typedef struct Collect {
    Arena *arena;
    const Expr *terms;
    bool *gone;
    Walk factors; /* places are indices into shared */
    LIST(Shared) shared;
    Heap heap;
} Collect;

static int64_t operations(Expr e)
{
    return e->count == 0 ? 0 : op_count_total(expr_count(&e, 1));
}

/* A factor's base, and its exponent where that is a whole positive number; else NULL. */
static Expr whole_base(Expr factor, int64_t *k)
{
    *k = 1;
    if (factor->kind != EXPR_POWER)
        return is_number(factor) ? NULL : factor;
    return expr_integer(node_args(factor)[1], k) && *k > 0 ? node_args(factor)[0] : NULL;
}

/* --- groups of terms --- */

static int64_t saving_of(const Shared *shared)
{
    return (shared->living - 1) * (1 + shared->own);
}

static void list_factors(Collect *collect, int count)
{
    for (int i = 0; i < count; i++) {
        ProductFactors factors = term_factors(&collect->terms[i]);

        for (int j = 0; j < factors.count && !is_number(collect->terms[i]); j++) {
            int64_t k;
            Expr base = whole_base(factors.at[j], &k);
            int place = base != NULL ? walk_add(&collect->factors, base) : -1;

            if (place < 0)
                continue;
            if (place == collect->shared.count)
                LIST_PUSH(collect->shared, (Shared){.own = operations(base)});
            LIST_PUSH(collect->shared.at[place].terms, i);
            collect->shared.at[place].living++;
        }
    }
    for (int i = 0; i < collect->shared.count; i++) {
        if (collect->shared.at[i].living > 1)
            heap_push(&collect->heap, (Rank){saving_of(&collect->shared.at[i]), 0, i});
    }
}

/* The whole power of `base` in a term, 0 where it isn't a factor. */
static int64_t power_in(Expr term, Expr base)
{
    ProductFactors factors = term_factors(&term);
    int64_t k;

    for (int i = 0; i < factors.count; i++) {
        if (whole_base(factors.at[i], &k) == base)
            return k;
    }
    return 0;
}

/* What all terms have in common: the least powers of the first one's factors, and the
 * coefficient where it is the same but for signs. */
static Expr common_factor(Arena *arena, const Expr *terms, int count)
{
    ProductFactors factors = term_factors(&terms[0]);
    Number number = term_coefficient(terms[0]);
    Expr common;

    if (number_sign(number) < 0)
        number = number_neg(number);
    for (int i = 1; i < count; i++) {
        Number same = term_coefficient(terms[i]);

        if (!number_same(number, number_sign(same) < 0 ? number_neg(same) : same))
            number = number_int(1);
    }
    common = number_node(arena, number);
    for (int i = 0; i < factors.count; i++) {
        int64_t least;
        Expr base = whole_base(factors.at[i], &least);

        for (int j = 1; j < count && base != NULL && least > 0; j++) {
            int64_t k = power_in(terms[j], base);

            least = k < least ? k : least;
        }
        if (base != NULL && least > 0)
            common = expr_mul(arena, common, expr_pow(arena, base, expr_int(arena, least)));
    }
    return common;
}

static Expr collect_sum(Arena *arena, Expr sum, int level);

/* The terms with their common factor factored out; their plain sum if that saves nothing. */
static Expr take_out(Arena *arena, const Expr *terms, int count, int level)
{
    Expr common = common_factor(arena, terms, count);
    Expr plain = expr_sum(arena, terms, count);
    Expr *inside = NEW_ARRAY(Expr, count);
    Expr taken;

    for (int i = 0; i < count; i++)
        inside[i] = expr_div(arena, terms[i], common);
    taken = expr_sum(arena, inside, count);
    taken = expr_mul(arena, common, collect_sum(arena, taken, level + 1));
    mem_free(inside);
    return operations(taken) < operations(plain) ? taken : plain;
}

/* Factor it out of the terms that still have it; the result is *out. */
static void take_group(Collect *collect, int factor, int level, Expr *out)
{
    const Shared *shared = &collect->shared.at[factor];
    LIST(Expr) terms = {0};

    for (int i = 0; i < shared->terms.count; i++) {
        if (!collect->gone[shared->terms.at[i]])
            LIST_PUSH(terms, collect->terms[shared->terms.at[i]]);
    }
    *out = take_out(collect->arena, terms.at, terms.count, level);
    LIST_FREE(terms);
    if ((*out)->kind == EXPR_SUM) {
        *out = NULL; /* nothing saved: the terms remain available to other factors */
        return;
    }
    for (int i = 0; i < shared->terms.count; i++) {
        int term = shared->terms.at[i];
        ProductFactors factors = term_factors(&collect->terms[term]);

        if (collect->gone[term])
            continue;
        collect->gone[term] = true;
        for (int j = 0; j < factors.count; j++) {
            int64_t k;
            Expr base = whole_base(factors.at[j], &k);

            if (base != NULL)
                collect->shared.at[walk_find(&collect->factors, base)].living--;
        }
    }
}

/* One round over the terms of a sum. */
static Expr collect_round(Arena *arena, Expr sum, int level)
{
    Collect collect = {.arena = arena, .terms = node_args(sum)};
    LIST(Expr) terms = {0};
    Expr collected;

    collect.gone = NEW_ARRAY(bool, sum->count);
    list_factors(&collect, sum->count);
    while (collect.heap.count > 0) {
        Rank rank = heap_pop(&collect.heap);
        int64_t saving = saving_of(&collect.shared.at[rank.which]);
        Expr group = NULL;

        if (saving <= 0)
            continue;
        if (saving < rank.saving) {
            heap_push(&collect.heap, (Rank){saving, 0, rank.which});
            continue;
        }
        take_group(&collect, rank.which, level, &group);
        if (group != NULL)
            LIST_PUSH(terms, group);
    }
    for (int i = 0; i < sum->count; i++) {
        if (!collect.gone[i])
            LIST_PUSH(terms, node_args(sum)[i]);
    }
    collected = terms.count < sum->count ? expr_sum(arena, terms.at, terms.count) : sum;
    for (int i = 0; i < collect.shared.count; i++)
        LIST_FREE(collect.shared.at[i].terms);
    LIST_FREE(collect.shared);
    LIST_FREE(collect.heap);
    LIST_FREE(terms);
    walk_free(&collect.factors);
    mem_free(collect.gone);
    return collected;
}

static Expr collect_sum(Arena *arena, Expr sum, int level)
{
    Expr e = sum;

    for (int i = 0; i < MOST_ROUNDS && level < MOST_LEVELS && e->kind == EXPR_SUM; i++) {
        Expr next = collect_round(arena, e, level);

        if (next == e || operations(next) > operations(e))
            break;
        e = next;
    }
    return e;
}

static Expr collect_node(Arena *arena, Expr e, void *context)
{
    (void)context;
    return e->kind == EXPR_SUM ? collect_sum(arena, e, 0) : e;
}

Expr expr_collect(Arena *arena, Expr e)
{
    Expr collected = expr_change(arena, e, collect_node, NULL);

    return operations(collected) <= operations(e) ? collected : e;
}
