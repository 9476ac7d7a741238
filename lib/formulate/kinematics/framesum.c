/* framesum.c: vectors as sums over orientation classes, for the expanded form
 *
 * A dot product of two parts contains only the turns between their classes. So the printed
 * expression is as short as one written by hand. */
#include "formulate/kinematics/framesum.h"
#include "formulate/kinematics/frames.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

FrameSum framesum_of(const System *system, int chain, Vec v)
{
    FrameSum sum = {NULL, 0};

    if (vec_is_zero(v))
        return sum;
    sum.parts = pool_alloc(system->pool, sizeof *sum.parts);
    sum.parts[0] = (Part){chain, v};
    sum.count = 1;
    return sum;
}

FrameSum framesum_add(const System *system, FrameSum a, Expr scale, FrameSum b)
{
    FrameSum sum;
    int i = 0;
    int j = 0;

    if (b.count == 0)
        return a;
    sum.parts = pool_alloc(system->pool, (size_t)(a.count + b.count) * sizeof *sum.parts);
    sum.count = 0;
    while (i < a.count || j < b.count) {
        Part part;

        if (j == b.count || (i < a.count && a.parts[i].chain < b.parts[j].chain)) {
            part = a.parts[i++];
        } else {
            part = (Part){b.parts[j].chain, vec_scale(system->arena, scale, b.parts[j].v)};
            j++;
            if (i < a.count && a.parts[i].chain == part.chain)
                part.v = vec_add(system->arena, a.parts[i++].v, part.v);
        }
        if (!vec_is_zero(part.v))
            sum.parts[sum.count++] = part;
    }
    return sum;
}

FrameSum framesum_cross(const System *system, Vec axis, int chain, FrameSum b)
{
    FrameSum sum = {NULL, 0};

    for (int i = 0; i < b.count; i++) {
        Vec there = vec_express(system, axis, chain, b.parts[i].chain);
        Vec v = vec_cross(system->arena, there, b.parts[i].v);

        sum = framesum_add(system, sum, expr_int(system->arena, 1),
                           framesum_of(system, b.parts[i].chain, v));
    }
    return sum;
}

Expr framesum_dot(const System *system, FrameSum a, FrameSum b)
{
    LIST(Expr) terms = {0};
    Expr dot;

    for (int i = 0; i < a.count; i++)
        for (int j = 0; j < b.count; j++) {
            Vec there = vec_express(system, b.parts[j].v, b.parts[j].chain, a.parts[i].chain);

            LIST_PUSH(terms, vec_dot(system->arena, a.parts[i].v, there));
        }
    dot = expr_sum(system->arena, terms.at, terms.count);
    LIST_FREE(terms);
    return dot;
}

FrameSum framesum_way(const System *system, int from, int to)
{
    const Tree *tree = system->origin->trees[TREE_TRANSLATION];
    Expr one = expr_int(system->arena, 1);
    Expr minus = expr_int(system->arena, -1);
    FrameSum way = {NULL, 0};

    while (from != to) {
        bool deeper = tree_depth(tree, from) > tree_depth(tree, to);
        int node = deeper ? from : to;
        const Frame *frame = &system->kinematics->frames[node];
        FrameSum step = framesum_of(system, frame->step_chain, frame->shift);

        way = framesum_add(system, way, deeper ? minus : one, step);
        if (deeper)
            from = frame->parent;
        else
            to = frame->parent;
    }
    return way;
}
