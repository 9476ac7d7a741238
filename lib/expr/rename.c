/* rename.c: symbols of one prefix replaced by those of another
 *
 * What is renamed again and again is walked once: an Original lists its nodes, each with the places
 * of its arguments, and a Renaming is a list of images by these places. Nothing is hashed on the
 * way but what is built. */
#include "expr/expr_impl.h"

#include <string.h>

enum {
    PLACE_WORK = 16, /* of a look at one, for transaction_worked() */
    NUMBER = -1      /* in the place of an argument that stays as it is */
};

struct Original {
    Arena *arena;
    const char *prefix;
    Walk walk;
    LIST(int) begin; /* a node each: where the places of its arguments begin, */
    LIST(int) args;  /* in these */
};

typedef struct Image {
    Expr e;     /* NULL: not yet */
    bool alike; /* built as what it became of, but for the names of symbols */
} Image;

struct Renaming {
    Original *original;
    const char *to;
    LIST(Image) of;    /* by places */
    LIST(int) waiting; /* places whose arguments come first */
    LIST(Expr) args;
};

/* --- what is renamed --- */

Original *original_new(Arena *arena, const char *prefix)
{
    Original *original = NEW(Original);

    original->arena = arena;
    original->prefix = prefix;
    return original;
}

void original_free(Original *original)
{
    if (original == NULL)
        return;
    walk_free(&original->walk);
    LIST_FREE(original->begin);
    LIST_FREE(original->args);
    mem_free(original);
}

/* of an expression with symbols; what is below it has one then, too */
static int place_of(Original *original, Expr e)
{
    Walk *walk = &original->walk;
    const int known = walk_find(walk, e);

    if (known >= 0)
        return known;
    walk_below(walk, e, ~0U, NULL, NULL);
    for (int i = original->begin.count; i < walk->count; i++) {
        const Expr own = walk->nodes[i];

        LIST_PUSH(original->begin, original->args.count);
        for (int k = 0; k < own->count; k++)
            LIST_PUSH(original->args,
                      node_args(own)[k]->kinds == 0 ? NUMBER : walk_find(walk, node_args(own)[k]));
    }
    return walk->count - 1;
}

/* --- what becomes of it --- */

Renaming *renaming_new(Original *original, const char *to)
{
    Renaming *renaming = NEW(Renaming);

    renaming->original = original;
    renaming->to = to;
    return renaming;
}

void renaming_free(Renaming *renaming)
{
    if (renaming == NULL)
        return;
    LIST_FREE(renaming->of);
    LIST_FREE(renaming->waiting);
    LIST_FREE(renaming->args);
    mem_free(renaming);
}

/* where the image of an expression is, or is to be put */
static int image_place(Renaming *renaming, Expr e)
{
    const int place = place_of(renaming->original, e), count = renaming->original->walk.count;

    LIST_ROOM(renaming->of, count - renaming->of.count);
    while (renaming->of.count < count)
        renaming->of.at[renaming->of.count++] = (Image){0};
    return place;
}

static bool begins_with(const char *name, const char *prefix)
{
    return strncmp(name, prefix, strlen(prefix)) == 0;
}

/* one that has the other prefix already may come twice then */
static Expr renamed(const Renaming *renaming, Expr symbol, bool *alike)
{
    const char *name = expr_name(symbol);
    const bool is_marked = name[0] == '#';
    Text other = {0};

    *alike = expr_data(symbol) != NULL || !begins_with(name + is_marked, renaming->to);
    if (expr_data(symbol) != NULL || !begins_with(name + is_marked, renaming->original->prefix))
        return symbol;
    if (is_marked)
        text_char(&other, '#');
    text_add(&other, renaming->to);
    text_add(&other, name + is_marked + strlen(renaming->original->prefix));
    symbol = expr_symbol(renaming->original->arena, other.at, expr_symbol_kind(symbol));
    text_free(&other);
    return symbol;
}

static Expr base_of(Expr factor)
{
    if (factor->kind == EXPR_POWER)
        factor = node_args(factor)[0];
    return is_call(factor, OP_SQRT) ? node_args(factor)[0] : factor;
}

/* whether arguments that are built as those of e stand in order, too, and none twice */
static bool are_ordered(Expr e, const Expr *args)
{
    const bool is_sum = e->kind == EXPR_SUM;

    for (int i = 1; e->kind == EXPR_CALL && i < e->count; i++)
        for (int j = 0; j < i; j++)
            if (args[i] == args[j] && node_args(e)[i] != node_args(e)[j])
                return false;
    if (e->kind == EXPR_CALL && e->count == 2)
        return (expr_compare(args[0], args[1]) < 0) ==
               (expr_compare(node_args(e)[0], node_args(e)[1]) < 0);
    if (!is_sum && e->kind != EXPR_PRODUCT)
        return true;
    for (int i = 1; i < e->count; i++) {
        if (is_number(args[i - 1]) || is_number(args[i]))
            continue;
        if ((is_sum ? order_terms(args[i - 1], args[i])
                    : order_bases(base_of(args[i - 1]), base_of(args[i]))) >= 0)
            return false;
    }
    return true;
}

/* What is built alike needs no simplifying where its parts stand in the same order. */
static Image rebuilt(Renaming *renaming, int place)
{
    const Original *original = renaming->original;
    const Expr e = original->walk.nodes[place];
    const int *const places = original->args.at + original->begin.at[place];
    bool changed = false, alike = true;

    renaming->args.count = 0;
    LIST_ROOM(renaming->args, e->count);
    for (int k = 0; k < e->count; k++) {
        const Image own =
            places[k] == NUMBER ? (Image){node_args(e)[k], true} : renaming->of.at[places[k]];

        renaming->args.at[k] = own.e;
        changed = changed || own.e != node_args(e)[k];
        alike = alike && own.alike;
    }
    alike = alike && are_ordered(e, renaming->args.at);
    if (!changed)
        return (Image){e, alike};
    return (Image){alike ? node_intern(original->arena, (ExprKind)e->kind, (Op)e->op,
                                       renaming->args.at, e->count)
                         : expr_rebuild(original->arena, e, renaming->args.at),
                   alike};
}

/* the arguments that have no image yet, the first of them on top; false: all have one */
static bool wait_for_args(Renaming *renaming, int place)
{
    const Original *original = renaming->original;
    const int *const places = original->args.at + original->begin.at[place];
    const int before = renaming->waiting.count;

    for (int k = original->walk.nodes[place]->count - 1; k >= 0; k--)
        if (places[k] != NUMBER && renaming->of.at[places[k]].e == NULL)
            LIST_PUSH(renaming->waiting, places[k]);
    return renaming->waiting.count > before;
}

static void build(Renaming *renaming, int root)
{
    LIST_PUSH(renaming->waiting, root);
    while (renaming->waiting.count > 0) {
        const int place = renaming->waiting.at[renaming->waiting.count - 1];
        const Expr e = renaming->original->walk.nodes[place];
        Image *image = &renaming->of.at[place];

        transaction_worked(PLACE_WORK);
        if (image->e == NULL && wait_for_args(renaming, place))
            continue;
        renaming->waiting.count--;
        if (image->e != NULL)
            continue; /* two waited for it */
        if (e->kind == EXPR_SYMBOL)
            image->e = renamed(renaming, e, &image->alike);
        else
            *image = rebuilt(renaming, place);
    }
}

bool renaming_pair(Renaming *renaming, Expr from, Expr to)
{
    Image *image;
    int place;

    if (expr_is_number(from))
        return from == to;
    /* a sign goes into the products and sums around it */
    if (from->kind == EXPR_PRODUCT && from->count == 2 && expr_is(node_args(from)[0], -1)) {
        from = node_args(from)[1];
        to = expr_neg(renaming->original->arena, to);
    }
    if (from->kind != EXPR_SYMBOL && held(from) == from)
        return false;
    place = image_place(renaming, from);
    image = &renaming->of.at[place];
    /* nothing that it stands in looks into the one or the other */
    if (image->e == NULL)
        *image = (Image){to, to->kind == EXPR_SYMBOL || held(to) != to};
    return image->e == to;
}

Expr renaming_of(Renaming *renaming, Expr e)
{
    int place;

    if (e->kinds == 0)
        return e;
    place = image_place(renaming, e);
    if (renaming->of.at[place].e == NULL)
        build(renaming, place);
    return renaming->of.at[place].e;
}
