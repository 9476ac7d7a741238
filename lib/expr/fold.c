/* fold.c: sines and cosines folded back into fewer
 *
 *   X sin^2 A + X cos^2 A         =  X
 *   X - X sin^2 A                 =  X cos^2 A, and the other way round
 *   a X sin^2 A + b X cos^2 A      =  a X + (b - a) X cos^2 A, a and b numbers
 *   X cos A cos B -+ X sin A sin B =  X cos(A +- B)
 *   X sin A cos B +- X cos A sin B =  X sin(A +- B)
 *
 * A term has a fingerprint: the sum over its factors of exponent times a hash of the base. So
 * adding and subtracting hashes gives the fingerprint of the partner that a term needs, and the
 * partner is found in a hash table. Every fold replaces two terms by one, which may fold again, or
 * by two with one square of a sine less. */
#include "expr/expr_impl.h"

#include <assert.h>
#include <string.h>

typedef struct FoldTerm {
    Expr e;
    uint64_t print; /* fingerprint, without the coefficient */
    bool gone;
} FoldTerm;

typedef struct Fold {
    Arena *arena;
    LIST(FoldTerm) terms;
    int *slots; /* hash table of terms by fingerprint: index + 1, 0 where empty */
    uint32_t size;
} Fold;

static uint64_t scramble(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

static uint64_t base_print(Expr base)
{
    return scramble(base->number + 0x9E3779B97F4A7C15U);
}

/* of sin(angle) or cos(angle), whether there is such a node or not */
static uint64_t trig_print(Op op, Expr angle)
{
    return scramble(((uint64_t)op << 40) + angle->number + 0xD1B54A32D192ED03U);
}

static bool is_trig(Expr e)
{
    return is_call(e, OP_SIN) || is_call(e, OP_COS);
}

static uint64_t term_print(Expr term)
{
    ProductFactors factors = term_factors(&term);
    uint64_t print = 0;

    for (int i = 0; i < factors.count; i++) {
        Expr base = factors.at[i];
        int64_t k = 1;

        if (base->kind == EXPR_POWER && expr_integer(node_args(base)[1], &k))
            base = node_args(base)[0];
        print += (uint64_t)k *
                 (is_trig(base) ? trig_print((Op)base->op, node_args(base)[0]) : base_print(base));
    }
    return print;
}

/* --- the table of terms --- */

static uint32_t slot_of(const Fold *fold, uint64_t print)
{
    return (uint32_t)scramble(print) & (fold->size - 1);
}

/* The living term of that fingerprint, or -1. */
static int find_term(const Fold *fold, uint64_t print)
{
    for (uint32_t i = slot_of(fold, print); fold->slots[i] != 0; i = (i + 1) & (fold->size - 1)) {
        const FoldTerm *term = &fold->terms.at[fold->slots[i] - 1];

        assert(fold->terms.at != NULL);
        if (!term->gone && term->print == print)
            return fold->slots[i] - 1;
    }
    return -1;
}

static void list_term(Fold *fold, int index)
{
    assert(fold->terms.at != NULL);

    uint32_t i = slot_of(fold, fold->terms.at[index].print);

    while (fold->slots[i] != 0)
        i = (i + 1) & (fold->size - 1);
    fold->slots[i] = index + 1;
}

/* Add a term to those that are there, to its like where there is one. */
static void add_term(Fold *fold, Expr e)
{
    uint64_t print = is_number(e) ? 0 : term_print(e);
    int like = expr_is_zero(e) ? -1 : find_term(fold, print);

    if (like >= 0) {
        Expr sum = expr_add(fold->arena, fold->terms.at[like].e, e);

        /* unlike terms of one fingerprint are chance; a sum of them is no term */
        if (sum->kind != EXPR_SUM) {
            fold->terms.at[like].gone = true;
            add_term(fold, sum);
            return;
        }
    }
    LIST_PUSH(fold->terms, (FoldTerm){e, print, expr_is_zero(e)});
    list_term(fold, fold->terms.count - 1);
}

/* --- folding two terms --- */

/* Whether e is `like` (sign 1) or its negative (sign -1). */
static bool is_plus_minus(Expr e, Expr like, int *sign)
{
    Number a = is_number(e) ? number_of(e) : term_coefficient(e);
    Number b = is_number(like) ? number_of(like) : term_coefficient(like);

    if (is_number(e) != is_number(like) || (!is_number(e) && order_terms(e, like) != 0))
        return false;
    *sign = number_same(a, b) ? 1 : number_same(a, number_neg(b)) ? -1 : 0;
    return *sign != 0;
}

static Expr trig(Fold *fold, Op op, Expr angle)
{
    return expr_call1(fold->arena, op, angle);
}

static Op other(Op op)
{
    return op == OP_SIN ? OP_COS : OP_SIN;
}

/* The living term other than `self` that is +-wanted; -1 where there is none. */
static int find_partner(Fold *fold, int self, uint64_t print, Expr wanted, int *sign)
{
    int partner = find_term(fold, print);

    if (partner < 0 || partner == self || !is_plus_minus(fold->terms.at[partner].e, wanted, sign))
        return -1;
    return partner;
}

static void replace(Fold *fold, int a, int b, Expr e)
{
    fold->terms.at[a].gone = true;
    fold->terms.at[b].gone = true;
    add_term(fold, e);
}

/* X f(A)^2 with f sin or cos: with X g(A)^2, or with -X */
static bool fold_square(Fold *fold, int self, Expr factor)
{
    const FoldTerm term = fold->terms.at[self];
    Expr angle = node_args(factor)[0];
    Expr square = expr_square(fold->arena, factor);
    Expr rest;
    Expr wanted;
    uint64_t print = term.print - 2 * trig_print((Op)factor->op, angle);
    uint64_t twin = print + 2 * trig_print(other((Op)factor->op), angle);
    int partner;
    int sign;

    if (find_term(fold, print) < 0 && find_term(fold, twin) < 0)
        return false;
    rest = expr_div(fold->arena, term.e, square);
    wanted = expr_mul(fold->arena, rest,
                      expr_square(fold->arena, trig(fold, other((Op)factor->op), angle)));
    partner = find_partner(fold, self, twin, wanted, &sign);
    if (partner >= 0 && sign > 0) {
        replace(fold, self, partner, rest);
        return true;
    }
    partner = find_partner(fold, self, print, rest, &sign);
    if (partner >= 0 && sign < 0) {
        replace(fold, self, partner, expr_neg(fold->arena, wanted));
        return true;
    }
    return false;
}

/* a X sin^2 A with b X cos^2 A, a and b different */
static bool merge_squares(Fold *fold, int self, Expr sine)
{
    const FoldTerm term = fold->terms.at[self];
    Arena *arena = fold->arena;
    Expr angle = node_args(sine)[0];
    int partner =
        find_term(fold, term.print - 2 * trig_print(OP_SIN, angle) + 2 * trig_print(OP_COS, angle));
    Expr rest;
    Expr alike;
    Expr left;

    if (sine->op != OP_SIN || partner < 0)
        return false;
    rest = expr_div(arena, term.e, expr_square(arena, sine));
    alike = expr_mul(arena, rest, expr_square(arena, trig(fold, OP_COS, angle)));
    if (order_terms(fold->terms.at[partner].e, alike) != 0)
        return false;
    left = expr_sub(arena, fold->terms.at[partner].e, alike);
    replace(fold, self, partner, rest);
    add_term(fold, left);
    return true;
}

/* X f(A) g(B) with X f'(A) g'(B), where ' is the other of sin and cos */
static bool fold_pair(Fold *fold, int self, Expr f, Expr g)
{
    const FoldTerm term = fold->terms.at[self];
    Arena *arena = fold->arena;
    Expr a = node_args(f)[0];
    Expr b = node_args(g)[0];
    bool alike = f->op == g->op; /* else sin A cos B or cos A sin B */
    Expr rest;
    Expr wanted;
    Expr angle;
    uint64_t print = term.print - trig_print((Op)f->op, a) - trig_print((Op)g->op, b) +
                     trig_print(other((Op)f->op), a) + trig_print(other((Op)g->op), b);
    int sign;
    int partner;

    if (find_term(fold, print) < 0)
        return false;
    rest = expr_div(arena, term.e, expr_mul(arena, f, g));
    wanted = expr_product(
        arena, (Expr[]){rest, trig(fold, other((Op)f->op), a), trig(fold, other((Op)g->op), b)}, 3);
    partner = find_partner(fold, self, print, wanted, &sign);
    if (partner < 0)
        return false;
    if (alike) {
        /* cc -+ ss = cos(A +- B); started from ss, the sign is that of ss */
        angle = sign < 0 ? expr_add(arena, a, b) : expr_sub(arena, a, b);
        if (f->op == OP_SIN && sign < 0)
            rest = expr_neg(arena, rest);
        replace(fold, self, partner, expr_mul(arena, rest, trig(fold, OP_COS, angle)));
        return true;
    }
    /* sc +- cs = sin(A +- B); started from cs it is sin(B +- A) */
    if (f->op == OP_COS) {
        Expr swap = a;

        a = b;
        b = swap;
    }
    angle = sign > 0 ? expr_add(arena, a, b) : expr_sub(arena, a, b);
    replace(fold, self, partner, expr_mul(arena, rest, trig(fold, OP_SIN, angle)));
    return true;
}

/* A sine or cosine that the factor is, or is a whole positive power of; else NULL. */
static Expr trig_factor(Expr factor, int64_t *k)
{
    *k = 1;
    if (factor->kind == EXPR_POWER) {
        if (!expr_integer(node_args(factor)[1], k) || *k < 1)
            return NULL;
        factor = node_args(factor)[0];
    }
    return is_trig(factor) ? factor : NULL;
}

/* Fold one term with some other; whether that was possible. */
static bool fold_term(Fold *fold, int self)
{
    Expr e = fold->terms.at[self].e;
    ProductFactors factors = term_factors(&e);

    for (int i = 0; i < factors.count; i++) {
        int64_t k;
        int64_t l;
        Expr f = trig_factor(factors.at[i], &k);

        if (f == NULL)
            continue;
        if (k >= 2 && (fold_square(fold, self, f) || fold_pair(fold, self, f, f) ||
                       merge_squares(fold, self, f)))
            return true;
        for (int j = i + 1; j < factors.count; j++) {
            Expr g = trig_factor(factors.at[j], &l);

            /* sin A cos A is its own partner */
            if (g != NULL && node_args(f)[0] != node_args(g)[0] && fold_pair(fold, self, f, g))
                return true;
        }
    }
    return false;
}

/* Whether it has a square of a sine or cosine, or two sines or cosines: candidates for folding. */
static bool may_fold(Expr term)
{
    ProductFactors factors = term_factors(&term);
    int count = 0;

    for (int i = 0; i < factors.count; i++) {
        int64_t k;

        if (trig_factor(factors.at[i], &k) != NULL)
            count += k >= 2 ? 2 : 1;
    }
    return count >= 2;
}

static Expr fold_sum(Arena *arena, Expr sum)
{
    Fold fold = {.arena = arena, .size = 16};
    LIST(Expr) left = {0};
    bool folded = false;
    Expr result;
    int i = 0;

    while (i < sum->count && !may_fold(node_args(sum)[i]))
        i++;
    if (i == sum->count)
        return sum;
    /* every fold adds one term and removes two, or adds two and removes two with a square of a
     * sine */
    while (fold.size < 8 * (uint32_t)sum->count)
        fold.size *= 2;
    fold.slots = NEW_ARRAY(int, fold.size);
    for (i = 0; i < sum->count; i++)
        add_term(&fold, node_args(sum)[i]);
    for (i = 0; i < fold.terms.count; i++) {
        if (!fold.terms.at[i].gone && fold_term(&fold, i))
            folded = true;
    }
    for (i = 0; i < fold.terms.count; i++) {
        if (!fold.terms.at[i].gone)
            LIST_PUSH(left, fold.terms.at[i].e);
    }
    result = folded ? expr_sum(arena, left.at, left.count) : sum;
    LIST_FREE(left);
    LIST_FREE(fold.terms);
    mem_free(fold.slots);
    return result;
}

static Expr fold_node(Arena *arena, Expr e, void *context)
{
    Expr before = NULL;

    (void)context;
    /* what was folded late may be what an earlier term needed */
    while (e->kind == EXPR_SUM && e != before) {
        before = e;
        e = fold_sum(arena, e);
    }
    return e;
}

Expr expr_fold(Arena *arena, Expr e)
{
    Expr folded = expr_change(arena, e, fold_node, NULL);

    if (folded == e)
        return e;
    return op_count_total(expr_count(&folded, 1)) <= op_count_total(expr_count(&e, 1)) ? folded : e;
}
