/* share.c: common subexpressions of several sums, or several products, as nodes of their own
 *
 * Equal nodes are shared already; here parts of nodes are shared too. Sums and products are lists
 * of operands, powers are repeated operands. The pair of operands that occurs in most lists becomes
 * one operand of all of them, then the next, as long as one saves an operation (Breuer 1969;
 * Hosangadi, Fallah and Kastner 2006). The roots together never cost more.
 *
 * Long lists are cut into pieces and pairs are formed within a piece, so that the work grows
 * linearly with the number of operands. The count of each pair is updated. A heap finds the best
 * pair; one whose count has dropped in the meantime is moved down. */
#include "expr/expr_impl.h"

enum {
    PIECE = 12,        /* operands, at most */
    HIGHEST_POWER = 8, /* that is looked into */
    DEEPEST = 64       /* pairs of pairs */
};

/* A thing, its negative, or its power. */
typedef struct SharedOperand {
    int thing;
    int power;
    bool negative;
} SharedOperand;

typedef struct SharedPiece {
    SharedOperand at[PIECE];
    int count;
    ExprKind kind; /* sum or product */
} SharedPiece;

/* A node without its sign and holds, or a pair. */
typedef struct SharedThing {
    Expr e;        /* NULL: a pair */
    Expr image;    /* NULL until made */
    Expr from;     /* +-e, whose arguments were walked */
    bool negative; /* it is -(what is listed) */
    bool used;
    int first_piece;
    int piece_count; /* 0: it isn't looked into */
    int depth;       /* of pairs */
    int pair;
} SharedThing;

typedef struct SharedPair {
    int a; /* things, a <= b */
    int b;
    ExprKind kind;
    bool opposite;    /* a - b */
    unsigned kinds;   /* of symbols below */
    int uses;         /* operations that it replaces */
    LIST(int) pieces; /* that have or had it */
} SharedPair;

typedef struct SubtermSharing {
    Arena *arena;
    Walk nodes;
    LIST(SharedOperand) operands; /* what each of the nodes is */
    Walk bases;                   /* of things: their places */
    LIST(SharedThing) things;
    LIST(SharedPiece) pieces;
    LIST(SharedPair) pairs;
    Heap heap;
    int *table; /* hash table of pairs: index + 1, 0 where empty */
    uint32_t table_size;
} SubtermSharing;

/* --- nodes and operands --- */

/* what a node is */
static SharedOperand operand_of(const SubtermSharing *share, Expr e)
{
    return share->operands.at[walk_find(&share->nodes, e)];
}

static SharedOperand negative_of(SharedOperand operand)
{
    operand.negative = !operand.negative;
    return operand;
}

/* The thing that the next node of the walk is, found or new. */
static SharedOperand find_thing(SubtermSharing *share, Expr e)
{
    bool negative =
        (e->kind == EXPR_SUM || e->kind == EXPR_PRODUCT || is_number(e)) && is_negative(e);
    Expr base = negative ? expr_neg(share->arena, e) : e;
    int place = negative ? walk_find(&share->nodes, base) : -1;
    SharedOperand operand = {.power = 1, .negative = negative};

    if (is_call(e, OP_HOLD))
        return operand_of(share, held(e));
    if (place >= 0 && place < share->operands.count)
        return negative_of(share->operands.at[place]);
    operand.thing = walk_add(&share->bases, base);
    if (operand.thing == share->things.count)
        LIST_PUSH(share->things, (SharedThing){.e = base, .from = e, .negative = negative});
    return operand;
}

/* Whether a power is a product that is looked into; `operand` is then its base. */
static bool is_repeated(const SubtermSharing *share, Expr e, SharedOperand *operand)
{
    int64_t k;

    if (e->kind != EXPR_POWER || !expr_integer(node_args(e)[1], &k) || k < 2 || k > HIGHEST_POWER)
        return false;
    *operand = operand_of(share, node_args(e)[0]);
    operand->power = (int)k;
    if (operand->negative && k % 2 != 0)
        return false;
    operand->negative = false;
    return true;
}

static int find_operand(const SharedPiece *piece, int thing)
{
    int i = 0;

    while (i < piece->count && piece->at[i].thing != thing)
        i++;
    return i;
}

/* Add an operand to the last piece of a thing, or to a new one. A piece has a thing once. */
static void push_operand(SubtermSharing *share, SharedThing *thing, ExprKind kind,
                         SharedOperand operand)
{
    SharedPiece *last = thing->piece_count > 0 ? &share->pieces.at[share->pieces.count - 1] : NULL;
    int like = last != NULL ? find_operand(last, operand.thing) : 0;

    if (last != NULL && like < last->count && kind == EXPR_PRODUCT) {
        last->at[like].power += operand.power;
        return;
    }
    if (last == NULL || like < last->count || last->count == PIECE) {
        if (thing->piece_count++ == 0)
            thing->first_piece = share->pieces.count;
        LIST_PUSH(share->pieces, (SharedPiece){.kind = kind});
        last = &share->pieces.at[share->pieces.count - 1];
    }
    last->at[last->count++] = operand;
}

static void list_operands(SubtermSharing *share, SharedThing *thing)
{
    Expr e = thing->from;
    SharedOperand operand;

    if (e->kind != EXPR_SUM && e->kind != EXPR_PRODUCT) {
        if (is_repeated(share, e, &operand))
            push_operand(share, thing, EXPR_PRODUCT, operand);
        return;
    }
    for (int i = 0; i < e->count; i++) {
        Expr arg = node_args(e)[i];

        if (e->kind == EXPR_SUM || !is_repeated(share, arg, &operand))
            operand = operand_of(share, arg);
        if (e->kind == EXPR_PRODUCT) {
            thing->negative = thing->negative != operand.negative;
            operand.negative = false;
        }
        if (e->kind == EXPR_SUM || !expr_is(share->things.at[operand.thing].e, 1))
            push_operand(share, thing, (ExprKind)e->kind, operand);
    }
}

/* Mark what a thing is made of. */
static void use_parts(SubtermSharing *share, const SharedThing *thing)
{
    for (int p = 0; p < thing->piece_count; p++) {
        const SharedPiece *piece = &share->pieces.at[thing->first_piece + p];

        for (int i = 0; i < piece->count; i++)
            share->things.at[piece->at[i].thing].used = true;
    }
    for (int i = 0; i < thing->from->count && thing->piece_count == 0; i++)
        share->things.at[operand_of(share, node_args(thing->from)[i]).thing].used = true;
}

static void list_things(SubtermSharing *share, const Expr *roots, int count)
{
    walk_roots(&share->nodes, roots, count);
    for (int i = 0; i < share->nodes.count; i++)
        LIST_PUSH(share->operands, find_thing(share, share->nodes.nodes[i]));
    for (int i = 0; i < count; i++)
        share->things.at[operand_of(share, roots[i]).thing].used = true;
    /* parts are older than what they are part of */
    for (int i = share->things.count - 1; i >= 0; i--) {
        SharedThing *thing = &share->things.at[i];

        if (!thing->used)
            continue;
        list_operands(share, thing);
        use_parts(share, thing);
    }
}

/* --- pairs --- */

static uint32_t pair_slot(const SubtermSharing *share, const SharedPair *wanted)
{
    uint32_t hash = (uint32_t)wanted->a * 0x9E3779B1U ^ (uint32_t)wanted->b * 0x85EBCA6BU;
    uint32_t i = (hash ^ hash >> 15) + 2 * (uint32_t)wanted->opposite + wanted->kind;

    for (i &= share->table_size - 1; share->table[i] != 0; i = (i + 1) & (share->table_size - 1)) {
        const SharedPair *pair = &share->pairs.at[share->table[i] - 1];

        if (pair->a == wanted->a && pair->b == wanted->b && pair->kind == wanted->kind &&
            pair->opposite == wanted->opposite)
            break;
    }
    return i;
}

static unsigned kinds_of(const SubtermSharing *share, int thing)
{
    const SharedThing *t = &share->things.at[thing];

    return t->e != NULL ? t->e->kinds : share->pairs.at[t->pair].kinds;
}

/* the pair of two operands, found or new */
static int pair_of(SubtermSharing *share, ExprKind kind, const SharedOperand *x,
                   const SharedOperand *y)
{
    SharedPair pair = {x->thing, y->thing, .kind = kind, .opposite = x->negative != y->negative};
    uint32_t slot;

    if (pair.a > pair.b) {
        pair.a = y->thing;
        pair.b = x->thing;
    }
    if (2 * (uint32_t)share->pairs.count >= share->table_size) {
        mem_free(share->table);
        share->table_size = share->table_size == 0 ? 256 : 4 * share->table_size;
        share->table = NEW_ARRAY(int, share->table_size);
        for (int i = 0; i < share->pairs.count; i++)
            share->table[pair_slot(share, &share->pairs.at[i])] = i + 1;
    }
    slot = pair_slot(share, &pair);
    if (share->table[slot] == 0) {
        pair.kinds = kinds_of(share, pair.a) | kinds_of(share, pair.b);
        LIST_PUSH(share->pairs, pair);
        share->table[slot] = share->pairs.count;
    }
    return share->table[slot] - 1;
}

static bool is_below(const SubtermSharing *share, const SharedOperand *operand)
{
    Expr e = share->things.at[operand->thing].e;

    return e != NULL && e->kind == EXPR_POWER && is_number(node_args(e)[1]) &&
           is_negative(node_args(e)[1]);
}

/* Number of operations of the pair of operands i and j in a piece. */
static int uses_in(const SubtermSharing *share, const SharedPiece *piece, int i, int j)
{
    const SharedOperand *x = &piece->at[i];
    const SharedOperand *y = &piece->at[j];

    if (share->things.at[x->thing].depth + share->things.at[y->thing].depth > DEEPEST)
        return 0;
    /* a division is one operation as a factor only */
    if (piece->kind == EXPR_PRODUCT && (is_below(share, x) || is_below(share, y)))
        return 0;
    if (i == j)
        return x->power / 2;
    return x->power < y->power ? x->power : y->power;
}

/* most uses first, of equals what depends on less */
static void rank_pair(SubtermSharing *share, int pair)
{
    const SharedPair *p = &share->pairs.at[pair];

    if (p->uses > 1)
        heap_push(&share->heap, (Rank){p->uses, p->kinds, pair});
}

/* Count (sign 1) the pairs that the first `changed` operands of a piece are in, or forget
 * them (sign -1). */
static void count_pairs(SubtermSharing *share, int number, int changed, int sign)
{
    const SharedPiece piece = share->pieces.at[number];

    for (int i = 0; i < changed; i++) {
        for (int j = i; j < piece.count; j++) {
            int uses = uses_in(share, &piece, i, j);
            int pair;

            if (uses == 0)
                continue;
            pair = pair_of(share, piece.kind, &piece.at[i], &piece.at[j]);
            share->pairs.at[pair].uses += sign * uses;
            if (sign < 0)
                continue;
            LIST_PUSH(share->pairs.at[pair].pieces, number);
            rank_pair(share, pair);
        }
    }
}

static void swap_operands(SharedPiece *piece, int i, int j)
{
    SharedOperand swap = piece->at[i];

    piece->at[i] = piece->at[j];
    piece->at[j] = swap;
}

/* The operands of a piece with a pair, as the thing `whole`, in place of the first two, or of the
 * first twice; how many of them changed. */
static int rewrite(SharedPiece *piece, bool twice, SharedOperand whole)
{
    SharedPiece next = {.kind = piece->kind};
    int changed = 1;

    next.at[next.count++] = whole;
    for (int k = 0; k < piece->count; k++) {
        SharedOperand left = piece->at[k];

        if (k == 0 || (k == 1 && !twice)) {
            left.power -= twice ? 2 * whole.power : whole.power;
            changed += left.power > 0;
        }
        if (left.power > 0)
            next.at[next.count++] = left;
    }
    *piece = next;
    return changed;
}

/* Replace the operands of a pair by the item `whole` if the piece still has them. */
static void replace_in(SubtermSharing *share, int number, SharedPair pair, int whole)
{
    SharedPiece *piece = &share->pieces.at[number];
    bool twice = pair.a == pair.b;
    int i = find_operand(piece, pair.a);
    int j = find_operand(piece, pair.b);
    SharedOperand operand = {.thing = whole};

    if (i == piece->count || j == piece->count)
        return;
    operand.power = uses_in(share, piece, i, j);
    operand.negative = piece->at[i].negative;
    if (operand.power == 0 || pair.opposite != (piece->at[i].negative != piece->at[j].negative))
        return;
    swap_operands(piece, 0, i);
    if (!twice)
        swap_operands(piece, 1, j == 0 ? i : j);
    count_pairs(share, number, twice ? 1 : 2, -1);
    count_pairs(share, number, rewrite(piece, twice, operand), 1);
}

static void take_pairs(SubtermSharing *share)
{
    for (int i = 0; i < share->pieces.count; i++)
        count_pairs(share, i, share->pieces.at[i].count, 1);
    while (share->heap.count > 0) {
        Rank rank = heap_pop(&share->heap);
        SharedPair pair = share->pairs.at[rank.which];
        SharedThing whole = {.pair = rank.which};

        if (pair.uses < rank.saving) {
            rank_pair(share, rank.which);
            continue;
        }
        whole.depth = share->things.at[pair.a].depth + share->things.at[pair.b].depth + 1;
        LIST_PUSH(share->things, whole);
        for (int i = 0; i < pair.pieces.count; i++)
            replace_in(share, pair.pieces.at[i], pair, share->things.count - 1);
    }
}

/* --- rebuilding --- */

static Expr image_of(SubtermSharing *share, int thing);

/* An operand as it is used among others. A list of its own is held: it isn't merged into theirs,
 * and a sum isn't computed with both signs. */
static Expr operand_image(SubtermSharing *share, SharedOperand operand)
{
    Expr e = image_of(share, operand.thing);

    if (share->things.at[operand.thing].piece_count > 0)
        e = expr_name_temporary(share->arena, e);
    if (operand.power > 1)
        e = expr_pow(share->arena, e, expr_int(share->arena, operand.power));
    return operand.negative ? expr_neg(share->arena, e) : e;
}

static Expr list_image(SubtermSharing *share, const SharedOperand *operands, int count,
                       ExprKind kind)
{
    LIST(Expr) images = {0};
    Expr image;

    for (int i = 0; i < count; i++)
        LIST_PUSH(images, operand_image(share, operands[i]));
    image = kind == EXPR_SUM ? expr_sum(share->arena, images.at, images.count)
                             : expr_product(share->arena, images.at, images.count);
    LIST_FREE(images);
    return image;
}

/* The image of an item, built if missing: pairs nest at most DEEPEST levels, and all other items
 * already have their images. */
static Expr image_of(SubtermSharing *share, int thing)
{
    if (share->things.at[thing].image == NULL) {
        const SharedPair *pair = &share->pairs.at[share->things.at[thing].pair];
        const bool twice = pair->a == pair->b;
        const SharedOperand operands[2] = {{pair->a, twice ? 2 : 1, false},
                                           {pair->b, 1, pair->opposite}};
        Expr image = list_image(share, operands, twice ? 1 : 2, pair->kind);

        share->things.at[thing].image = expr_name_temporary(share->arena, image);
    }
    return share->things.at[thing].image;
}

/* Make the image of a thing whose parts have theirs. */
static void make_image(SubtermSharing *share, SharedThing *thing)
{
    LIST(SharedOperand) operands = {0};
    LIST(Expr) args = {0};
    bool changed = false;

    thing->image = thing->e;
    for (int p = 0; p < thing->piece_count; p++) {
        const SharedPiece *piece = &share->pieces.at[thing->first_piece + p];

        for (int i = 0; i < piece->count; i++) {
            int part = piece->at[i].thing;

            LIST_PUSH(operands, piece->at[i]);
            changed = changed || image_of(share, part) != share->things.at[part].e;
        }
    }
    for (int i = 0; i < thing->from->count && thing->piece_count == 0; i++) {
        SharedOperand part = operand_of(share, node_args(thing->from)[i]);

        LIST_PUSH(args, operand_image(share, part));
        changed = changed || image_of(share, part.thing) != share->things.at[part.thing].e;
    }
    if (changed && operands.count > 0)
        thing->image = list_image(share, operands.at, operands.count,
                                  share->pieces.at[thing->first_piece].kind);
    else if (changed)
        thing->image = expr_rebuild(share->arena, thing->from, args.at);
    if (changed && thing->negative)
        thing->image = expr_neg(share->arena, thing->image);
    LIST_FREE(operands);
    LIST_FREE(args);
}

void expr_share(Arena *arena, Expr *roots, int count)
{
    SubtermSharing share = {.arena = arena};
    int things;

    list_things(&share, roots, count);
    things = share.things.count;
    take_pairs(&share);
    for (int i = 0; i < things && share.things.count > things; i++) {
        if (share.things.at[i].used)
            make_image(&share, &share.things.at[i]);
    }
    for (int i = 0; i < count && share.things.count > things; i++)
        roots[i] = operand_image(&share, operand_of(&share, roots[i]));

    for (int i = 0; i < share.pairs.count; i++)
        LIST_FREE(share.pairs.at[i].pieces);
    LIST_FREE(share.pairs);
    LIST_FREE(share.heap);
    LIST_FREE(share.pieces);
    LIST_FREE(share.things);
    LIST_FREE(share.operands);
    walk_free(&share.nodes);
    walk_free(&share.bases);
    mem_free(share.table);
}
