/* stiff_elements_ranges.c: ranges of sources and of their second derivatives over an interval, and
 * sizes of sources in a run */
#include "simulate/equations/stiff_elements_impl.h"

#include "simulate/equations/equations_limits.h"

#include <math.h>
#include <string.h>

/* --- what there is --- */

/* a jump has a derivative of 0, and tables have a range that only some points determine */
static bool may_jump(Expr e, void *context)
{
    const Op op = expr_kind(e) == EXPR_CALL ? expr_op(e) : OP_SIN;

    (void)context;
    return op == OP_SIGN || op == OP_STICK || op == OP_UNILATERAL || op == OP_DIRECTION ||
           op == OP_COULOMB || op == OP_STEP || op == OP_FLOOR || op == OP_IF || op == OP_TABLE ||
           op == OP_ATAN2 || op == OP_UNWRAP || (op >= OP_LT && op <= OP_NOT);
}

int stiff_elements_add_corners(StiffElementRoots *corners, Expr e)
{
    Expr *jumps;
    const int count = expr_find(&e, 1, may_jump, NULL, &jumps);

    for (int i = 0; i < count && corners != NULL; i++)
        LIST_PUSH(*corners, expr_op(jumps[i]) == OP_IF ? expr_arg(jumps[i], 0) : jumps[i]);
    mem_free(jumps);
    return count;
}

void stiff_elements_find_ranges(StiffElements *s)
{
    Arena *arena = system_arena(s->l->system);
    Expr time = s->l->symbols[s->l->t];
    Expr *functions = NEW_ARRAY(Expr, s->sources.count);
    StiffElementRoots corners = {0};

    for (int i = 0; i < s->sources.count; i++)
        functions[i] = s->sources.at[i].function;
    s->values = ranges_new(functions, s->sources.count, time, parameters_value_in, s->parameters);
    for (int i = 0; i < s->sources.count; i++) {
        functions[i] = expr_diff(arena, functions[i], time);
        s->sources.at[i].corner = corners.count;
        s->sources.at[i].corners = stiff_elements_add_corners(&corners, functions[i]);
    }
    s->slopes = ranges_new(functions, s->sources.count, time, parameters_value_in, s->parameters);
    for (int i = 0; i < s->sources.count; i++)
        functions[i] = expr_diff(arena, functions[i], time);
    s->bends = ranges_new(functions, s->sources.count, time, parameters_value_in, s->parameters);
    if (corners.count > 0)
        s->corners =
            ranges_new(corners.at, corners.count, time, parameters_value_in, s->parameters);
    s->closer = NEW_ARRAY(Range, s->sources.count);
    s->bent = NEW_ARRAY(Range, s->sources.count);
    s->reach = NEW_ARRAY(double, s->sources.count);
    LIST_FREE(corners);
    mem_free(functions);
}

/* --- over an interval --- */

const Range *stiff_elements_sources_over(StiffElements *s, Range over)
{
    over = (Range){motion_clock(s->motion, over.low), motion_clock(s->motion, over.high)};
    return ranges_over(s->values, over);
}

/* The second derivative is unbounded at a corner, which its expression doesn't show. */
const Range *stiff_elements_bends_over(StiffElements *s, Range over)
{
    const Range *corners;

    over = (Range){motion_clock(s->motion, over.low), motion_clock(s->motion, over.high)};
    if (s->corners == NULL)
        return ranges_over(s->bends, over);
    memcpy(s->bent, ranges_over(s->bends, over), (size_t)s->sources.count * sizeof(Range));
    corners = ranges_over(s->corners, over);
    for (int j = 0; j < s->sources.count; j++)
        for (int i = s->sources.at[j].corner;
             i < s->sources.at[j].corner + s->sources.at[j].corners; i++)
            if (corners[i].low < corners[i].high)
                s->bent[j] = (Range){-INFINITY, INFINITY};
    return s->bent;
}

/* the part of a within `reach` of b's middle, where that is an interval */
static Range narrowed(Range a, Range b, double reach)
{
    const double middle = (b.low + b.high) / 2, half = (b.high - b.low) / 2 + reach;
    const Range out = {fmax(a.low, middle - half), fmin(a.high, middle + half)};

    return out.low <= out.high ? out : a;
}

Range stiff_elements_source_over(StiffElements *s, int j, Range over)
{
    over = (Range){motion_clock(s->motion, over.low), motion_clock(s->motion, over.high)};
    return ranges_root_over(s->values, j, over);
}

Range stiff_elements_source_close(StiffElements *s, int j, Range over)
{
    const double low = motion_clock(s->motion, over.low), high = motion_clock(s->motion, over.high);
    const double middle = low + (high - low) / 2;
    const Range wide = ranges_root_over(s->values, j, (Range){low, high});
    Range slope;
    double reach;

    if (!s->sources.at[j].is_continuous)
        return wide;
    slope = ranges_root_over(s->slopes, j, (Range){low, high});
    reach = fmax(fabs(slope.low), fabs(slope.high)) * (high - low) / 2;
    if (!isfinite(reach))
        return wide;
    return narrowed(wide, ranges_root_over(s->values, j, (Range){middle, middle}), reach);
}

const Range *stiff_elements_sources_close(StiffElements *s, Range over)
{
    const double low = motion_clock(s->motion, over.low), high = motion_clock(s->motion, over.high);
    const double middle = low + (high - low) / 2;
    const Range *at;

    at = ranges_over(s->slopes, (Range){low, high});
    for (int j = 0; j < s->sources.count; j++)
        s->reach[j] = fmax(fabs(at[j].low), fabs(at[j].high)) * (high - low) / 2;
    memcpy(s->closer, ranges_over(s->values, (Range){low, high}),
           (size_t)s->sources.count * sizeof(Range));
    at = ranges_over(s->values, (Range){middle, middle});
    for (int j = 0; j < s->sources.count; j++)
        if (s->sources.at[j].is_continuous && isfinite(s->reach[j]))
            s->closer[j] = narrowed(s->closer[j], at[j], s->reach[j]);
    return s->closer;
}

int64_t stiff_elements_visits(const StiffElements *s)
{
    return ranges_visits(s->values) + ranges_visits(s->slopes) + ranges_visits(s->bends) +
           ranges_visits(s->corners);
}

void stiff_elements_span(StiffElements *s, double from, double to)
{
    double piece = (to - from) / STIFF_SUBINTERVALS;
    Range *all = NEW_ARRAY(Range, s->sources.count);

    for (int p = 0; p < STIFF_SUBINTERVALS; p++) {
        const Range *over =
            stiff_elements_sources_over(s, (Range){from + p * piece, from + (p + 1) * piece});

        for (int j = 0; j < s->sources.count; j++) {
            all[j].low = p == 0 ? over[j].low : fmin(all[j].low, over[j].low);
            all[j].high = p == 0 ? over[j].high : fmax(all[j].high, over[j].high);
        }
    }
    for (int j = 0; j < s->sources.count; j++) {
        double size = all[j].high - all[j].low;

        s->sources.at[j].size = isfinite(size) ? size : 0;
    }
    mem_free(all);
}

double stiff_elements_source_size(const StiffElements *s, int j)
{
    return s->sources.at[j].size;
}
