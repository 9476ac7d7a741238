/* walk.c: the nodes below some roots, each once, children first
 *
 * Depth first with a stack of its own: expressions may be a hundred thousand levels
 * deep. The table of places is as large as what was met, however large the arena. */
#include "expr/expr_impl.h"

enum { WALK_WORK = 32 }; /* of a look, for transaction_worked() */

static uint32_t slot_of(const Walk *walk, uint32_t key)
{
    uint32_t i = key * 2654435769U >> 7 & (walk->size - 1);

    while (walk->keys[i] != 0 && walk->keys[i] != key)
        i = (i + 1) & (walk->size - 1);
    return i;
}

int walk_find(const Walk *walk, Expr e)
{
    uint32_t i;

    transaction_worked(WALK_WORK);
    if (walk->size == 0)
        return -1;
    i = slot_of(walk, e->number + 1);
    return walk->keys[i] != 0 ? walk->places[i] : -1;
}

static void make_room(Walk *walk)
{
    if ((uint32_t)walk->count < walk->size / 2)
        return;
    MEM_FREE(walk->keys, walk->places);
    walk->size = walk->size == 0 ? 64 : 4 * walk->size;
    walk->keys = NEW_ARRAY(uint32_t, walk->size);
    walk->places = NEW_ARRAY(int, walk->size);
    walk->nodes = list_room(walk->nodes, walk->count, (int)walk->size / 2 - walk->count,
                            &walk->room, sizeof(Expr));
    for (int place = 0; place < walk->count; place++) {
        transaction_worked(WALK_WORK);

        uint32_t i = slot_of(walk, walk->nodes[place]->number + 1);

        walk->keys[i] = walk->nodes[place]->number + 1;
        walk->places[i] = place;
    }
}

int walk_add(Walk *walk, Expr e)
{
    uint32_t i;

    make_room(walk);
    i = slot_of(walk, e->number + 1);
    if (walk->keys[i] != 0)
        return walk->places[i];
    walk->keys[i] = e->number + 1;
    walk->places[i] = walk->count;
    walk->nodes[walk->count] = e;
    return walk->count++;
}

static inline void push_level(Walk *walk, Expr e, WalkInto into, void *context)
{
    if (walk->stack.count == walk->stack.room)
        LIST_ROOM(walk->stack, 1);
    walk->stack.at[walk->stack.count++] =
        (WalkLevel){e, into == NULL || into(context, e) ? 0 : e->count};
}

void walk_below(Walk *walk, Expr root, unsigned mask, WalkInto into, void *context)
{
    if ((mask != 0 && (root->kinds & mask) == 0) || walk_find(walk, root) >= 0)
        return;
    push_level(walk, root, into, context);
    while (walk->stack.count > 0) {
        WalkLevel *level = &walk->stack.at[walk->stack.count - 1];
        Expr child;

        if (level->next == level->e->count) {
            (void)walk_add(walk, level->e);
            walk->stack.count--;
            continue;
        }
        child = node_args(level->e)[level->next++];
        if ((mask == 0 || (child->kinds & mask) != 0) && walk_find(walk, child) < 0)
            push_level(walk, child, into, context);
    }
}

void walk_roots(Walk *walk, const Expr *roots, int count)
{
    for (int i = 0; i < count; i++)
        walk_below(walk, roots[i], 0, NULL, NULL);
}

void walk_free(Walk *walk)
{
    MEM_FREE(walk->nodes, walk->keys, walk->places, walk->stack.at);
    *walk = (Walk){0};
}
