/* angles.c: sines and cosines of sums of angles, from those of the parts
 *
 *   sin(A + B) = sin A cos B + cos A sin B,  cos(A + B) = cos A cos B - sin A sin B
 *
 * where the four are computed anyway: three operations instead of a function. Folding for the
 * reader made such angles (fold.c); a run undoes it. A is one of the terms of the sum, or one
 * multiple of it, so that partners are looked up and not searched. */
#include "expr/expr_impl.h"

#include <stdlib.h>

typedef struct Trig {
    Expr e;
    double size; /* of its angle: of its terms' coefficients */
} Trig;

typedef struct AngleSharing {
    Arena *arena;
    Walk calls;            /* sines and cosines that are computed */
    LIST(unsigned) groups; /* that need them, bit by bit */
    LIST(Expr) images;     /* NULL: not decided yet */
} AngleSharing;

static bool is_trig(Expr e)
{
    return is_call(e, OP_SIN) || is_call(e, OP_COS);
}

static void list_calls(AngleSharing *angles, const Expr *roots, int count, unsigned group)
{
    Walk walk = {0};

    walk_roots(&walk, roots, count);
    for (int i = 0; i < walk.count; i++) {
        int place;

        if (!is_trig(walk.nodes[i]))
            continue;
        place = walk_add(&angles->calls, walk.nodes[i]);
        if (place == angles->groups.count) {
            LIST_PUSH(angles->groups, 0);
            LIST_PUSH(angles->images, NULL);
        }
        angles->groups.at[place] |= group;
    }
    walk_free(&walk);
}

/* The terms of an angle. */
static int terms_of(const Expr *angle, const Expr **terms)
{
    bool sum = (*angle)->kind == EXPR_SUM;

    *terms = sum ? node_args(*angle) : angle;
    return sum ? (*angle)->count : 1;
}

static double angle_size(Expr angle)
{
    const Expr *terms;
    int count = terms_of(&angle, &terms);
    double size = 0;

    for (int i = 0; i < count; i++) {
        double c = is_number(terms[i]) ? 1 : number_value(term_coefficient(terms[i]));

        size += c < 0 ? -c : c;
    }
    return size;
}

static int by_size(const void *a, const void *b)
{
    const Trig *x = a;
    const Trig *y = b;

    if (x->size != y->size)
        return x->size < y->size ? -1 : 1;
    return x->e->number < y->e->number ? -1 : x->e->number > y->e->number;
}

/* The image of a sine or cosine where every one of the groups computes it; else NULL. */
static Expr available(const AngleSharing *angles, Op op, Expr angle, unsigned groups)
{
    Expr call = expr_call1(angles->arena, op, angle);
    bool negative = is_negative(call);
    int place;

    if (negative)
        call = expr_neg(angles->arena, call);
    place = walk_find(&angles->calls, call);
    if (place < 0 || angles->images.at[place] == NULL || (groups & ~angles->groups.at[place]) != 0)
        return NULL;
    return negative ? expr_neg(angles->arena, angles->images.at[place]) : angles->images.at[place];
}

/* sin or cos of a + b; NULL where an operand is missing */
static Expr added(const AngleSharing *angles, Op op, Expr a, Expr b, unsigned groups)
{
    Arena *arena = angles->arena;
    Expr sin_a = available(angles, OP_SIN, a, groups);
    Expr cos_a = available(angles, OP_COS, a, groups);
    Expr sin_b = available(angles, OP_SIN, b, groups);
    Expr cos_b = available(angles, OP_COS, b, groups);

    if (sin_a == NULL || cos_a == NULL || sin_b == NULL || cos_b == NULL)
        return NULL;
    if (op == OP_SIN)
        return expr_add(arena, expr_mul(arena, sin_a, cos_b), expr_mul(arena, cos_a, sin_b));
    return expr_sub(arena, expr_mul(arena, cos_a, cos_b), expr_mul(arena, sin_a, sin_b));
}

/* One multiple of a term: b of 3*b, -b of -3*b; all of b/2. */
static Expr one_of(Arena *arena, Expr term)
{
    Number c = term_coefficient(term);

    if (is_number(term) || !number_is_whole(c))
        return term;
    return term_scale(arena, term, number_int(number_sign(c)));
}

static Expr image_of(const AngleSharing *angles, Expr call, unsigned groups)
{
    Expr angle = node_args(call)[0];
    const Expr *terms;
    int count = terms_of(&angle, &terms);

    for (int i = 0; i < count; i++) {
        Expr a = one_of(angles->arena, terms[i]);
        Expr image;

        if (a == angle)
            continue;
        image = added(angles, (Op)call->op, a, expr_sub(angles->arena, angle, a), groups);
        if (image != NULL)
            return image->kind == EXPR_SUM ? expr_name_temporary(angles->arena, image) : image;
    }
    return call;
}

/* simpler angles first: parts are decided on before what they are parts of */
static void sort_calls(const AngleSharing *angles, Trig *calls)
{
    int count = angles->calls.count;

    for (int i = 0; i < count; i++) {
        Expr e = angles->calls.nodes[i];

        calls[i] = (Trig){e, angle_size(node_args(e)[0])};
    }
    if (count > 0)
        qsort(calls, (size_t)count, sizeof *calls, by_size);
}

/* Decide for every call; `from` and `to` receive those that are replaced. */
static int find_images(AngleSharing *angles, Expr *from, Expr *to)
{
    int count = angles->calls.count;
    Trig *calls = NEW_ARRAY(Trig, count);
    int found = 0;

    sort_calls(angles, calls);
    for (int i = 0; i < count; i++) {
        Expr e = calls[i].e;
        int place = walk_find(&angles->calls, e);
        Expr image = image_of(angles, e, angles->groups.at[place]);

        angles->images.at[place] = image;
        from[found] = e;
        to[found] = image;
        found += image != e;
    }
    mem_free(calls);
    return found;
}

void expr_part_angles(Arena *arena, Expr *roots, const int *counts, int groups)
{
    AngleSharing angles = {.arena = arena};
    Expr *from;
    Expr *to;
    int total = 0;
    int found;

    for (int g = 0; g < groups; g++) {
        list_calls(&angles, roots + total, counts[g], 1U << g);
        total += counts[g];
    }
    from = NEW_ARRAY(Expr, angles.calls.count);
    to = NEW_ARRAY(Expr, angles.calls.count);
    found = find_images(&angles, from, to);
    for (int i = 0; i < total && found > 0; i++)
        roots[i] = expr_substitute(arena, roots[i], from, to, found);
    MEM_FREE(from, to);
    walk_free(&angles.calls);
    LIST_FREE(angles.groups);
    LIST_FREE(angles.images);
}
