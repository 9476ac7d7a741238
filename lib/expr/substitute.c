/* substitute.c: replacing symbols, dissolving holds, finding symbols
 *
 * As with derivatives: one pass upward, each node rebuilt from its rebuilt arguments. */
#include "expr/expr_impl.h"

#include <stdlib.h>
#include <string.h>

Expr expr_rebuild(Arena *arena, Expr e, const Expr *args)
{
    switch (e->kind) {
    case EXPR_SUM:
        return expr_sum(arena, args, e->count);
    case EXPR_PRODUCT:
        return expr_product(arena, args, e->count);
    case EXPR_POWER:
        return expr_pow(arena, args[0], args[1]);
    case EXPR_CALL:
        return expr_call(arena, e->op, args);
    default:
        return e;
    }
}

/* what becomes of the nodes walked, by their places */
typedef struct Images {
    Walk walk;
    LIST(Expr) of;
} Images;

static Expr image_of(const Images *images, Expr e)
{
    int place = walk_find(&images->walk, e);

    return place >= 0 ? images->of.at[place] : e;
}

/* Rebuild what was walked and has no image yet, each node then by way of `change`. */
static void rebuild_all(Arena *arena, Images *images, NodeChange change, void *context)
{
    LIST(Expr) args = {0};

    for (int i = images->of.count; i < images->walk.count; i++) {
        Expr e = images->walk.nodes[i];
        bool changed = false;

        args.count = 0;
        for (int j = 0; j < e->count; j++) {
            LIST_PUSH(args, image_of(images, node_args(e)[j]));
            changed = changed || args.at[j] != node_args(e)[j];
        }
        if (changed)
            e = expr_rebuild(arena, e, args.at);
        LIST_PUSH(images->of, change != NULL ? change(arena, e, context) : e);
    }
    LIST_FREE(args);
}

static Expr finish(Images *images, Expr e)
{
    Expr image = image_of(images, e);

    walk_free(&images->walk);
    LIST_FREE(images->of);
    return image;
}

Expr expr_substitute(Arena *arena, Expr e, const Expr *symbols, const Expr *values, int count)
{
    Images images = {0};
    unsigned mask = 0;

    for (int i = 0; i < count; i++)
        mask |= symbols[i]->kinds;
    if ((e->kinds & mask) == 0)
        return e;
    for (int i = 0; i < count; i++) {
        if (walk_add(&images.walk, symbols[i]) == images.of.count)
            LIST_PUSH(images.of, values != NULL ? values[i] : arena_zero(arena));
    }
    walk_below(&images.walk, e, mask, NULL, NULL);
    rebuild_all(arena, &images, NULL, NULL);
    return finish(&images, e);
}

void expr_replace(Arena *arena, Expr *roots, int root_count, const Expr *from, const Expr *to,
                  int count)
{
    Images images = {0};

    for (int i = 0; i < count; i++) {
        if (walk_add(&images.walk, from[i]) == images.of.count)
            LIST_PUSH(images.of, to[i]);
    }
    walk_roots(&images.walk, roots, root_count); /* what is replaced is found there */
    rebuild_all(arena, &images, NULL, NULL);
    for (int i = 0; i < root_count; i++)
        roots[i] = image_of(&images, roots[i]);
    walk_free(&images.walk);
    LIST_FREE(images.of);
}

Expr expr_change(Arena *arena, Expr e, NodeChange change, void *context)
{
    Images images = {0};

    walk_below(&images.walk, e, 0, NULL, NULL);
    rebuild_all(arena, &images, change, context);
    return finish(&images, e);
}

/* a hold whose operand has become negative is -1 times a hold */
static Expr without_hold(Arena *arena, Expr e, void *context)
{
    (void)context;
    if (expr_kind(e) == EXPR_PRODUCT && expr_arg_count(e) == 2 && expr_is(expr_arg(e, 0), -1))
        return expr_neg(arena, held(expr_arg(e, 1)));
    return held(e);
}

/* rows of a network are opened again and again */
Expr expr_open(Arena *arena, Expr e)
{
    const Expr mark = arena_zero(arena); /* nothing is differentiated by it */
    Expr opened = e->kind <= EXPR_SYMBOL ? e : arena_recall(arena, e, mark);

    if (opened == NULL) {
        opened = expr_change(arena, e, without_hold, NULL);
        arena_remember(arena, e, mark, opened);
    }
    return opened;
}

/* --- queries --- */

int expr_find(const Expr *roots, int count, NodeWanted wanted, void *context, Expr **out)
{
    Walk walk = {0};
    LIST(Expr) found = {0};

    walk_roots(&walk, roots, count);
    for (int i = 0; i < walk.count; i++)
        if (wanted(walk.nodes[i], context))
            LIST_PUSH(found, walk.nodes[i]);
    walk_free(&walk);
    *out = found.at;
    return found.count;
}

bool expr_depends(Expr e, Expr symbol)
{
    Walk walk = {0};
    bool depends;

    if ((e->kinds & symbol->kinds) == 0)
        return false;
    walk_below(&walk, e, symbol->kinds, NULL, NULL);
    depends = walk_find(&walk, symbol) >= 0;
    walk_free(&walk);
    return depends;
}

unsigned expr_kinds(Expr e)
{
    return e->kinds;
}

static int by_number(const void *a, const void *b)
{
    return expr_symbol_number(*(const Expr *)a) - expr_symbol_number(*(const Expr *)b);
}

int expr_symbols(const Expr *roots, int count, Expr **symbols)
{
    Walk walk = {0};
    LIST(Expr) found = {0};

    if (count == 1 && roots[0]->kind == EXPR_SYMBOL && roots[0]->kinds != 0) {
        LIST_PUSH(found, roots[0]);
        *symbols = found.at;
        return 1;
    }
    for (int i = 0; i < count; i++)
        walk_below(&walk, roots[i], ~0U, NULL, NULL);
    for (int i = 0; i < walk.count; i++)
        if (walk.nodes[i]->kind == EXPR_SYMBOL)
            LIST_PUSH(found, walk.nodes[i]);
    walk_free(&walk);
    if (found.count > 0)
        qsort(found.at, (size_t)found.count, sizeof(Expr), by_number);
    *symbols = found.at;
    return found.count;
}

static bool has_data(Expr e, void *context)
{
    (void)context;
    return expr_data(e) != NULL;
}

int expr_tables(const Expr *roots, int count, Expr **symbols)
{
    return expr_find(roots, count, has_data, NULL, symbols);
}

unsigned expr_table_orders(const Expr *roots, int count, Expr symbol)
{
    Walk walk = {0};
    unsigned orders = 0;

    walk_roots(&walk, roots, count);
    for (int i = 0; i < walk.count; i++) {
        Expr e = walk.nodes[i];

        if (e->kind == EXPR_CALL && e->op == OP_TABLE && node_args(e)[0] == symbol)
            orders |= 1U << (unsigned)expr_value(node_args(e)[2]);
    }
    walk_free(&walk);
    return orders;
}

/* --- looking --- */

ExprKind expr_kind(Expr e)
{
    return (ExprKind)e->kind;
}

Op expr_op(Expr e)
{
    return (Op)e->op;
}

int expr_arg_count(Expr e)
{
    return e->count;
}

Expr expr_arg(Expr e, int i)
{
    return node_args(e)[i];
}

const char *expr_name(Expr symbol)
{
    return node_symbol(symbol)->name;
}

SymbolKind expr_symbol_kind(Expr symbol)
{
    return node_symbol(symbol)->kind;
}

int expr_symbol_number(Expr symbol)
{
    return node_symbol(symbol)->number;
}

uint32_t expr_number(Expr e)
{
    return e->number;
}
