/* rename.c: symbols of one prefix replaced by those of another
 *
 * Expressions that are renamed repeatedly are visited once: an Original lists their nodes, each
 * with the indices of its arguments, and a Renaming lists the images by these indices. Only built
 * nodes are hashed. As long as the new symbols have the order of the old ones, sorted operands
 * remain sorted. The image is then a node of the same kind over the images, built without
 * inspection or simplification. */
#include "expr/expr_impl.h"

#include "base/names.h"
#include "base/text.h"

#include <string.h>

enum {
    PLACE_WORK = 16, /* of a look at one, for transaction_worked() */
    NUMBER = -1      /* marks an argument that is unchanged */
};

typedef struct Listed {
    int begin;         /* index in `args` of the first argument's index */
    int before, after; /* of a symbol: its neighbours in order when it was added; -1: none */
    int root;          /* the first that was listed together with it */
    bool lasts;        /* the order of arguments follows from that of their symbols */
    bool is_hole;      /* it may be replaced by another node */
    bool has_hole;     /* it, or what is below */
} Listed;

struct Original {
    Arena *arena;
    const char *prefix;
    Walk walk;
    LIST(Listed) places;
    LIST(int) args;
    LIST(int) symbols; /* their places, in order */
    char *kept;        /* the prefix, if the arena stores it, */
    int usual;         /* and its number of nodes after its first use; 0 before */
};

typedef struct Image {
    Expr e;     /* NULL: not yet */
    bool alike; /* built as what it became of, but for the names of symbols */
} Image;

struct Renaming {
    Original *original;
    const char *to;
    bool disorders;    /* symbols don't have the order of the original ones */
    LIST(Image) of;    /* by places */
    LIST(int) waiting; /* indices whose arguments are built first */
    LIST(Expr) args;
    LIST(int) filled; /* indices whose image was replaced */
    char *kept;       /* `to`, if the arena stores it, */
    bool is_used;     /* and that was used since the last check */
};

struct Renamings { /* stored by an arena */
    Names *names;  /* "from to" */
    LIST(Renaming *) list;
    Names *prefixes;
    LIST(Original *) originals;
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
    LIST_FREE(original->places);
    LIST_FREE(original->args);
    LIST_FREE(original->symbols);
    mem_free(original->kept);
    mem_free(original);
}

static Expr base_of(Expr factor)
{
    if (factor->kind == EXPR_POWER)
        factor = node_args(factor)[0];
    return is_call(factor, OP_SQRT) ? node_args(factor)[0] : factor;
}

static bool args_last(Expr e)
{
    const Expr *args = node_args(e);

    if (e->kind == EXPR_CALL && e->count == 2)
        return order_lasts(args[0], args[1], expr_compare);
    for (int i = 1; i < e->count && (e->kind == EXPR_SUM || e->kind == EXPR_PRODUCT); i++) {
        if (is_number(args[i - 1]) || is_number(args[i]))
            continue;
        if (e->kind == EXPR_SUM ? !order_lasts(args[i - 1], args[i], order_terms)
                                : !order_lasts(base_of(args[i - 1]), base_of(args[i]), order_bases))
            return false;
    }
    return true;
}

/* insert it in order among the symbols before it */
static void enter_symbol(Original *original, int place)
{
    const Expr symbol = original->walk.nodes[place];
    int at;

    LIST_PUSH(original->symbols, place);
    for (at = original->symbols.count - 1; at > 0; at--) {
        const int other = original->symbols.at[at - 1];

        if (order_symbols(original->walk.nodes[other], symbol) < 0)
            break;
        original->symbols.at[at] = other;
    }
    original->symbols.at[at] = place;
    if (at > 0)
        original->places.at[place].before = original->symbols.at[at - 1];
    if (at + 1 < original->symbols.count)
        original->places.at[place].after = original->symbols.at[at + 1];
}

static void enter(Original *original, int place, int root)
{
    const Expr own = original->walk.nodes[place];
    Listed entry = {.begin = original->args.count, .before = -1, .after = -1, .root = root};

    for (int k = 0; k < own->count; k++) {
        const Expr arg = node_args(own)[k];
        const int at = arg->kinds == 0 ? NUMBER : walk_find(&original->walk, arg);

        entry.has_hole = entry.has_hole || (at >= 0 && original->places.at[at].has_hole);
        LIST_PUSH(original->args, at);
    }
    entry.lasts = args_last(own);
    LIST_PUSH(original->places, entry);
    if (own->kind == EXPR_SYMBOL)
        enter_symbol(original, place);
}

/* of an expression with symbols; what is below it has one then, too */
static int place_of(Original *original, Expr e)
{
    Walk *walk = &original->walk;
    const int known = walk_find(walk, e), root = walk->count;

    if (known >= 0)
        return known;
    walk_below(walk, e, ~0U, NULL, NULL);
    for (int i = root; i < walk->count; i++)
        enter(original, i, root);
    return walk->count - 1;
}

static void make_hole(Original *original, int place)
{
    Listed *const places = original->places.at;

    if (places[place].is_hole)
        return;
    places[place].is_hole = places[place].has_hole = true;
    for (int i = place + 1; i < original->places.count; i++)
        for (int k = 0; k < original->walk.nodes[i]->count && !places[i].has_hole; k++) {
            const int arg = original->args.at[places[i].begin + k];

            places[i].has_hole = arg >= 0 && places[arg].has_hole;
        }
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
    LIST_FREE(renaming->filled);
    mem_free(renaming->kept);
    mem_free(renaming);
}

/* the slot of the image of an expression */
static int image_place(Renaming *renaming, Expr e)
{
    const int place = place_of(renaming->original, e), count = renaming->original->walk.count;

    if (renaming->of.count == count)
        return place;
    LIST_ROOM(renaming->of, count - renaming->of.count);
    while (renaming->of.count < count)
        renaming->of.at[renaming->of.count++] = (Image){0};
    return place;
}

static bool begins_with(const char *name, const char *prefix)
{
    return strncmp(name, prefix, strlen(prefix)) == 0;
}

/* a symbol that already has the other prefix may then occur twice */
static Expr renamed(const Renaming *renaming, Expr symbol, bool *alike)
{
    const char *name = expr_name(symbol);
    const bool is_marked = name[0] == '#';
    const size_t length = strlen(renaming->to), kept = strlen(renaming->original->prefix);
    char *other, *at;

    *alike = expr_data(symbol) != NULL || !begins_with(name + is_marked, renaming->to);
    if (expr_data(symbol) != NULL || !begins_with(name + is_marked, renaming->original->prefix))
        return symbol;
    at = other = mem_new(strlen(name) + length + 1);
    if (is_marked)
        *at++ = '#';
    memcpy(at, renaming->to, length);
    memcpy(at + length, name + is_marked + kept, strlen(name + is_marked + kept));
    symbol = expr_symbol(renaming->original->arena, other, expr_symbol_kind(symbol));
    mem_free(other);
    return symbol;
}

/* The image of a symbol that isn't replaced. Each lies between the images of the neighbours that
 * the original had when added, so that all are in order. */
static void build_symbol(Renaming *renaming, int place)
{
    const Listed *own = &renaming->original->places.at[place];
    Image *const of = renaming->of.at;

    if (of[place].e != NULL)
        return;
    of[place].e = renamed(renaming, renaming->original->walk.nodes[place], &of[place].alike);
    for (int side = 0; side < 2; side++) {
        const int next = side == 0 ? own->before : own->after;
        int order;

        if (next < 0)
            continue;
        /* the image of a replaced symbol doesn't bound those beyond it */
        if (renaming->original->places.at[next].is_hole) {
            renaming->disorders = true;
            continue;
        }
        build_symbol(renaming, next); /* added earlier: depth <= number of symbols */
        order = order_symbols(of[next].e, of[place].e);
        if (side == 0 ? order >= 0 : order <= 0)
            renaming->disorders = true;
    }
}

/* whether the images of e's arguments are in order too, without duplicates */
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

/* A node of the same structure needs no simplification if its operands have the same order. False:
 * an argument has no image yet. */
static bool rebuild(Renaming *renaming, int place)
{
    const Original *original = renaming->original;
    const Listed *own = &original->places.at[place];
    const Expr e = original->walk.nodes[place], *const from = node_args(e);
    const int *const places = original->args.at + own->begin;
    const int count = e->count;
    bool changed = false, alike = true;
    Expr *args, built = e;

    if (renaming->args.room < count)
        LIST_ROOM(renaming->args, count);
    args = renaming->args.at;
    for (int k = 0; k < count; k++) {
        const Image arg = places[k] == NUMBER ? (Image){from[k], true} : renaming->of.at[places[k]];

        if (arg.e == NULL)
            return false;
        args[k] = arg.e;
        alike = alike && arg.alike;
        changed = changed || arg.e != from[k];
    }
    alike =
        alike && ((own->lasts && !own->has_hole && !renaming->disorders) || are_ordered(e, args));
    if (changed)
        built = alike ? node_intern(original->arena, (ExprKind)e->kind, (Op)e->op, args, count)
                      : expr_rebuild(original->arena, e, args);
    renaming->of.at[place] = (Image){built, alike};
    return true;
}

/* push the arguments that have no image yet, the first of them last */
static void wait_for_args(Renaming *renaming, int place)
{
    const Original *original = renaming->original;
    const int *const places = original->args.at + original->places.at[place].begin;

    for (int k = original->walk.nodes[place]->count - 1; k >= 0; k--)
        if (places[k] != NUMBER && renaming->of.at[places[k]].e == NULL)
            LIST_PUSH(renaming->waiting, places[k]);
}

static void build(Renaming *renaming, int root)
{
    LIST_PUSH(renaming->waiting, root);
    while (renaming->waiting.count > 0) {
        const int place = renaming->waiting.at[renaming->waiting.count - 1];

        transaction_worked(PLACE_WORK);
        if (renaming->of.at[place].e == NULL) { /* else two waited for it */
            if (renaming->original->walk.nodes[place]->kind == EXPR_SYMBOL)
                build_symbol(renaming, place);
            else if (!rebuild(renaming, place)) {
                wait_for_args(renaming, place);
                continue;
            }
        }
        renaming->waiting.count--;
    }
}

/* Nodes listed together with this one precede it, arguments first, so most are below. Nodes with a
 * hole may be requested before it is filled. */
static void build_listed(Renaming *renaming, int place)
{
    const Listed *const places = renaming->original->places.at;

    arena_touch_renamings(renaming->original->arena);
    for (int i = places[place].root; i < place; i++)
        if (renaming->of.at[i].e == NULL && !places[i].has_hole) {
            if (renaming->original->walk.nodes[i]->kind == EXPR_SYMBOL)
                build_symbol(renaming, i);
            else
                (void)rebuild(renaming, i); /* or as part of what waits for it */
        }
    build(renaming, place);
}

bool renaming_pair(Renaming *renaming, Expr from, Expr to)
{
    Image *image;
    int place;

    if (expr_is_number(from))
        return from == to;
    /* a sign merges into the products and sums around it */
    if (from->kind == EXPR_PRODUCT && from->count == 2 && expr_is(node_args(from)[0], -1)) {
        from = node_args(from)[1];
        to = expr_neg(renaming->original->arena, to);
    }
    if (from->kind != EXPR_SYMBOL && held(from) == from)
        return false;
    place = image_place(renaming, from);
    image = &renaming->of.at[place];
    if (image->e == NULL && from->kind == EXPR_SYMBOL && to == from &&
        renamed(renaming, from, &image->alike) == to)
        build_symbol(renaming, place);
    /* no node that contains it inspects either */
    if (image->e == NULL) {
        make_hole(renaming->original, place);
        LIST_PUSH(renaming->filled, place);
        *image = (Image){to, to->kind == EXPR_SYMBOL || held(to) != to};
    }
    return image->e == to;
}

Expr renaming_of(Renaming *renaming, Expr e)
{
    int place;

    if (e->kinds == 0)
        return e;
    place = image_place(renaming, e);
    if (renaming->of.at[place].e == NULL)
        build_listed(renaming, place);
    return renaming->of.at[place].e;
}

/* --- renamings that an arena stores --- */

static void renamings_free(Renamings *renamings)
{
    for (int i = 0; i < renamings->list.count; i++)
        renaming_free(renamings->list.at[i]);
    for (int i = 0; i < renamings->originals.count; i++)
        original_free(renamings->originals.at[i]);
    LIST_FREE(renamings->list);
    LIST_FREE(renamings->originals);
    names_free(renamings->names);
    names_free(renamings->prefixes);
    mem_free(renamings);
}

static Renamings *renamings_of(Arena *arena)
{
    Renamings *renamings = arena_renamings(arena);

    mem_keep(renamings);
    if (renamings != NULL)
        return renamings;
    renamings = NEW(Renamings);
    renamings->names = names_new();
    renamings->prefixes = names_new();
    arena_add_renamings(arena, renamings, renamings_free);
    return renamings;
}

/* Before what an earlier call made of it is changed in place. */
static void announce(Renaming *renaming)
{
    Original *original = renaming->original;

    mem_keep(original);
    mem_keep(original->walk.nodes);
    mem_keep(original->walk.keys);
    mem_keep(original->walk.places);
    mem_keep(original->places.at);
    mem_keep(original->symbols.at);
    LIST_FREE(original->walk.stack);
    mem_keep(renaming);
    mem_keep(renaming->of.at);
    LIST_FREE(renaming->waiting);
    LIST_FREE(renaming->args);
}

/* nodes above replaced ones have to be rebuilt */
static void open_again(Renaming *renaming)
{
    const Original *original = renaming->original;
    bool *is_open;

    if (renaming->filled.count == 0)
        return;
    is_open = NEW_ARRAY(bool, renaming->of.count);
    for (int i = 0; i < renaming->filled.count; i++)
        is_open[renaming->filled.at[i]] = true;
    for (int i = 0; i < renaming->of.count; i++) {
        const int *const args = original->args.at + original->places.at[i].begin;

        for (int k = 0; k < original->walk.nodes[i]->count && !is_open[i]; k++)
            is_open[i] = args[k] != NUMBER && is_open[args[k]];
        if (is_open[i])
            renaming->of.at[i] = (Image){0};
    }
    LIST_FREE(renaming->filled);
    mem_free(is_open);
}

static Original *original_kept(Renamings *renamings, Arena *arena, const char *prefix)
{
    const int number = names_add(renamings->prefixes, prefix);
    Original *original;

    if (number < renamings->originals.count)
        return renamings->originals.at[number];
    original = original_new(arena, NULL);
    original->prefix = original->kept = mem_text(prefix, strlen(prefix));
    LIST_PUSH(renamings->originals, original);
    return original;
}

Renaming *renaming_kept(Arena *arena, const char *prefix, const char *to, bool *is_new)
{
    Renamings *renamings = renamings_of(arena);
    Renaming *renaming;
    Text name = {0};
    int number;

    text_add(&name, prefix);
    text_char(&name, ' ');
    text_add(&name, to);
    number = names_add(renamings->names, name.at);
    text_free(&name);
    *is_new = number == renamings->list.count;
    if (*is_new) {
        renaming = renaming_new(original_kept(renamings, arena, prefix), NULL);
        renaming->to = renaming->kept = mem_text(to, strlen(to));
        LIST_PUSH(renamings->list, renaming);
        arena_touch_renamings(arena);
    }
    renaming = renamings->list.at[number];
    announce(renaming);
    open_again(renaming);
    renaming->is_used = true;
    return renaming;
}

void renaming_forget(Arena *arena)
{
    Renamings *renamings = renamings_of(arena);
    Renaming *last = renamings->list.at[--renamings->list.count];

    names_trim(renamings->names, renamings->list.count);
    renaming_free(last);
}

/* Repeated edits leave unused images: then all are rebuilt. */
void renamings_end(Arena *arena)
{
    Renamings *renamings = arena_renamings(arena);
    int used = 0;
    bool is_stale = false;

    for (int i = 0; renamings != NULL && i < renamings->originals.count; i++) {
        Original *original = renamings->originals.at[i];

        mem_keep(original);
        if (original->usual == 0)
            original->usual = original->walk.count;
        is_stale = is_stale || original->walk.count > 4 * original->usual + 1000;
    }
    for (int i = 0; renamings != NULL && i < renamings->list.count; i++) {
        mem_keep(renamings->list.at[i]);
        used += renamings->list.at[i]->is_used;
        renamings->list.at[i]->is_used = false;
    }
    if (renamings == NULL || (!is_stale && renamings->list.count <= 2 * used + 16))
        return;
    renamings_free(renamings);
    arena_add_renamings(arena, NULL, NULL);
}
