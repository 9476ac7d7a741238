/* abbreviate.c: a walk over shared nodes, children first; a node that earns a name becomes
 * a symbol in all that is built above it */
#include "present/abbreviate.h"

#include <stdio.h>

typedef struct Seen {
    Expr node;
    Expr written; /* over names */
    int uses;
} Seen;

typedef struct AbbreviateWalk {
    Arena *arena;
    LIST(Seen) seen; /* children first */
    int *slot;       /* hash of addresses to 1 + place in `seen`; open addressing */
    int slots;       /* a power of two */
} AbbreviateWalk;

static unsigned hash(Expr e)
{
    return (unsigned)(((uintptr_t)e >> 4) * 2654435761U);
}

static int *place(const AbbreviateWalk *walk, Expr e)
{
    int i = (int)(hash(e) & (unsigned)(walk->slots - 1));

    while (walk->slot[i] != 0 && walk->seen.at[walk->slot[i] - 1].node != e)
        i = (i + 1) & (walk->slots - 1);
    return walk->slot + i;
}

static Seen *find(const AbbreviateWalk *walk, Expr e)
{
    const int at = *place(walk, e);

    return at == 0 ? NULL : walk->seen.at + at - 1;
}

static void insert(AbbreviateWalk *walk, Expr e)
{
    if (2 * (walk->seen.count + 1) > walk->slots) {
        mem_free(walk->slot);
        walk->slots *= 2;
        walk->slot = NEW_ARRAY(int, walk->slots);
        for (int i = 0; i < walk->seen.count; i++)
            *place(walk, walk->seen.at[i].node) = i + 1;
    }
    *place(walk, e) = walk->seen.count + 1;
    LIST_PUSH(walk->seen, (Seen){.node = e, .written = NULL, .uses = 0});
}

static bool is_leaf(Expr e)
{
    return expr_is_number(e) || expr_kind(e) == EXPR_SYMBOL;
}

/* every node below `root` that isn't seen yet, children first, without recursion */
static void visit(AbbreviateWalk *walk, Expr root)
{
    typedef struct Frame {
        Expr node;
        int next;
    } Frame;
    LIST(Frame) stack = {0};

    if (find(walk, root) == NULL)
        LIST_PUSH(stack, (Frame){root, 0});
    while (stack.count > 0) {
        Frame *top = stack.at + stack.count - 1;

        if (!is_leaf(top->node) && top->next < expr_arg_count(top->node)) {
            const Expr child = expr_arg(top->node, top->next++);

            if (find(walk, child) == NULL)
                LIST_PUSH(stack, (Frame){child, 0});
            continue;
        }
        if (find(walk, top->node) == NULL) {
            const Expr node = top->node;

            insert(walk, node);
            for (int i = 0; !is_leaf(node) && i < expr_arg_count(node); i++)
                find(walk, expr_arg(node, i))->uses++;
        }
        stack.count--;
    }
    LIST_FREE(stack);
    find(walk, root)->uses++;
}

static Expr rebuild(const AbbreviateWalk *walk, Expr e)
{
    const int count = expr_arg_count(e);
    Expr *args = NEW_ARRAY(Expr, count);
    Expr out = e;

    for (int i = 0; i < count; i++)
        args[i] = find(walk, expr_arg(e, i))->written;
    switch (expr_kind(e)) {
    case EXPR_POWER:
        out = expr_pow(walk->arena, args[0], args[1]);
        break;
    case EXPR_PRODUCT:
        out = expr_product(walk->arena, args, count);
        break;
    case EXPR_SUM:
        out = expr_sum(walk->arena, args, count);
        break;
    case EXPR_CALL:
        out = expr_op(e) == OP_HOLD ? args[0] : expr_call(walk->arena, expr_op(e), args);
        break;
    case EXPR_RATIONAL:
    case EXPR_REAL:
    case EXPR_SYMBOL:
    case EXPR_TUPLE:
        break;
    }
    mem_free(args);
    return out;
}

static bool is_condition(Expr e)
{
    return expr_kind(e) == EXPR_CALL && expr_op(e) >= OP_LT && expr_op(e) <= OP_NOT;
}

static bool earns_a_name(const Seen *seen, const Naming *naming)
{
    int64_t operations;

    if (is_leaf(seen->written) || is_condition(seen->node))
        return false;
    if (seen->uses < 2 && naming->most == 0)
        return false;
    operations = op_count_total(expr_count(&seen->written, 1));
    return (seen->uses > 1 && operations >= naming->least) ||
           (naming->most > 0 && operations > naming->most);
}

static bool is_root(Expr e, const Expr *roots, int count)
{
    for (int i = 0; i < count; i++)
        if (roots[i] == e)
            return true;
    return false;
}

Abbreviation abbreviate(Arena *arena, const Expr *roots, int count, const Naming *naming)
{
    Abbreviation out = {.roots = NEW_ARRAY(Expr, count), .definitions = {0}};
    enum { SLOTS = 256 }; /* at first */
    AbbreviateWalk walk = {.arena = arena, .slot = NEW_ARRAY(int, SLOTS), .slots = SLOTS};

    for (int i = 0; i < count; i++)
        visit(&walk, roots[i]);
    for (int i = 0; i < walk.seen.count; i++) {
        Seen *seen = walk.seen.at + i;

        seen->written = is_leaf(seen->node) ? seen->node : rebuild(&walk, seen->node);
        if (earns_a_name(seen, naming) && !(seen->uses == 1 && is_root(seen->node, roots, count))) {
            char name[64];

            (void)snprintf(name, sizeof name, "%s%d", naming->prefix, out.definitions.count + 1);
            LIST_PUSH(out.definitions,
                      (Abbreviated){expr_symbol(arena, name, SYMBOL_ARGUMENT), seen->written});
            seen->written = out.definitions.at[out.definitions.count - 1].symbol;
        }
    }
    for (int i = 0; i < count; i++)
        out.roots[i] = find(&walk, roots[i])->written;
    LIST_FREE(walk.seen);
    mem_free(walk.slot);
    return out;
}

void abbreviation_free(Abbreviation *abbreviation)
{
    mem_free(abbreviation->roots);
    LIST_FREE(abbreviation->definitions);
    abbreviation->roots = NULL;
}
