/* range.c: interval arithmetic over a list of nodes, operands first
 *
 * Bounds are rounded to nearest, not outward: a bound may miss the true one by some units in the
 * last place, which doesn't matter here. */
#include "expr/range.h"

#include "expr/expr_impl.h"

#include <math.h>
#include <string.h>

#define POINTS 8 /* where functions without a rule are looked at in an interval */

typedef struct RangeNode {
    ExprKind kind;
    Op op;
    int first, count;   /* of its operands in `operands` */
    bool moves;         /* with the symbol */
    double value;       /* of a number or another symbol, or an exponent */
    const Curve *curve; /* of a table */
    int order;          /* of its derivative */
} RangeNode;

struct Ranges {
    RangeNode *nodes;
    int *operands;
    Range *at; /* of the nodes: those that the symbol doesn't move have theirs once and for all */
    int symbol;
    int *moving; /* the others */
    int moving_count;
    int *roots;
    Range *out;
    int count;
    int **below; /* of each root: moving nodes that it needs, operands first; NULL: not found */
    int *below_count;
    Range over;      /* where the symbol is, and */
    int64_t *age;    /* for which interval each moving node has its range: */
    int64_t current; /* this one */
    int64_t visits;
};

static const Range everything = {-INFINITY, INFINITY};

static Range hull(Range a, Range b)
{
    return (Range){fmin(a.low, b.low), fmax(a.high, b.high)};
}

static Range point(double x)
{
    return isnan(x) ? everything : (Range){x, x};
}

/* 0 times what is without bound is 0: it is the bound of something finite */
static double times(double a, double b)
{
    return a == 0 || b == 0 ? 0 : a * b;
}

static Range product(Range a, Range b)
{
    if (a.low == a.high) {
        const double low = times(a.low, b.low), high = times(a.low, b.high);

        return low <= high ? (Range){low, high} : (Range){high, low};
    }
    if (b.low == b.high)
        return product(b, a);

    Range one = {times(a.low, b.low), times(a.low, b.high)};
    Range two = {times(a.high, b.low), times(a.high, b.high)};

    return (Range){fmin(fmin(one.low, one.high), fmin(two.low, two.high)),
                   fmax(fmax(one.low, one.high), fmax(two.low, two.high))};
}

static Range power(Range a, double p)
{
    bool is_whole = p == floor(p);
    bool is_even = is_whole && fmod(p, 2) == 0;
    double low = pow(a.low, p), high = pow(a.high, p);
    bool crosses = a.low < 0 && a.high > 0;

    if (!is_whole && a.low < 0)
        return a.high < 0 ? everything : (Range){0, p > 0 ? pow(a.high, p) : INFINITY};
    if (p < 0 && a.low <= 0 && a.high >= 0)
        return is_even ? (Range){fmin(low, high), INFINITY} : everything;
    if (is_even && crosses)
        return (Range){0, fmax(low, high)};
    return (Range){fmin(low, high), fmax(low, high)};
}

/* of cos: where it has its tops and bottoms between */
static Range cosine(Range a)
{
    const double turn = 2 * acos(-1.0), first = cos(a.low);
    const double last = a.low == a.high ? first : cos(a.high);
    Range out = {fmin(first, last), fmax(first, last)};

    if (a.low == a.high)
        return point(first);
    if (!(a.high - a.low < turn))
        return (Range){-1, 1};
    if (floor(a.high / turn) > floor(a.low / turn) || floor(a.low / turn) * turn == a.low)
        out.high = 1;
    if (floor(a.high / turn - 0.5) > floor(a.low / turn - 0.5))
        out.low = -1;
    return out;
}

static Range rising(Op op, Range a)
{
    Range out = {op_value(op, &a.low), op_value(op, &a.high)};

    if (isnan(out.low))
        out.low = -INFINITY;
    if (isnan(out.high))
        out.high = INFINITY;
    return out;
}

static Range tangent(Range a)
{
    double half = acos(-1.0);

    if (!(a.high - a.low < half) || floor(a.high / half - 0.5) > floor(a.low / half - 0.5))
        return everything;
    return (Range){tan(a.low), tan(a.high)};
}

/* a condition: 1 where it must be true, 0 where it can't */
static Range claim(bool must, bool can)
{
    return (Range){must, can};
}

static Range compared(Op op, Range a, Range b)
{
    bool apart = a.high < b.low || b.high < a.low;
    bool same = a.low == a.high && b.low == b.high && a.low == b.low;

    switch (op) {
    case OP_LT:
        return claim(a.high < b.low, a.low < b.high);
    case OP_LE:
        return claim(a.high <= b.low, a.low <= b.high);
    case OP_EQ:
        return claim(same, !apart);
    default:
        return claim(apart, !same);
    }
}

static bool is_true(Range a)
{
    return a.low > 0 || a.high < 0;
}

static bool can_be_true(Range a)
{
    return a.low != 0 || a.high != 0;
}

/* by some points, and half of what these differ by beyond them */
static Range by_points(const RangeNode *node, const Range *args, const int *operands)
{
    Range out = {INFINITY, -INFINITY};
    double spread;

    if (node->count > 2 && node->curve == NULL)
        return everything;
    for (int i = 0; i <= POINTS; i++)
        for (int k = 0; k <= (node->count == 2 ? POINTS : 0); k++) {
            Range a = args[operands[node->curve != NULL ? 1 : 0]];
            Range b = node->count == 2 ? args[operands[1]] : a;
            double x[2] = {a.low + (a.high - a.low) * i / POINTS,
                           b.low + (b.high - b.low) * k / POINTS};
            double y = node->curve != NULL ? curve_value(node->curve, x[0], node->order)
                                           : op_value(node->op, x);

            if (!isfinite(y))
                return everything;
            out = hull(out, point(y));
        }
    spread = (out.high - out.low) / 2;
    return (Range){out.low - spread, out.high + spread};
}

static Range call(const RangeNode *node, const Range *all, const int *operands)
{
    Range a = all[operands[0]];
    Range b = node->count > 1 ? all[operands[1]] : a;

    switch (node->op) {
    case OP_SIN:
        return cosine((Range){a.low - acos(0.0), a.high - acos(0.0)});
    case OP_COS:
        return cosine(a);
    case OP_TAN:
        return tangent(a);
    case OP_COSH:
        return a.low < 0 && a.high > 0 ? (Range){1, cosh(fmax(-a.low, a.high))}
                                       : (Range){cosh(fmin(fabs(a.low), fabs(a.high))),
                                                 cosh(fmax(fabs(a.low), fabs(a.high)))};
    case OP_ABS:
        return a.low < 0 && a.high > 0
                   ? (Range){0, fmax(-a.low, a.high)}
                   : (Range){fmin(fabs(a.low), fabs(a.high)), fmax(fabs(a.low), fabs(a.high))};
    case OP_ACOS:
        return (Range){acos(fmin(1, a.high)), acos(fmax(-1, a.low))};
    case OP_ASIN:
    case OP_ATAN:
    case OP_SINH:
    case OP_TANH:
    case OP_EXP:
    case OP_LOG:
    case OP_SQRT:
    case OP_SIGN:
    case OP_STICK:
    case OP_STEP:
    case OP_RAMP:
    case OP_FLOOR:
    case OP_HOLD:
        return node->op == OP_HOLD ? a : rising(node->op, a);
    case OP_HYPOT:
        return (Range){0, hypot(fmax(fabs(a.low), fabs(a.high)), fmax(fabs(b.low), fabs(b.high)))};
    case OP_DIRECTION:
        return (Range){-1, 1};
    case OP_COULOMB:
        return (Range){-INFINITY, INFINITY};
    case OP_UNILATERAL:
        return (Range){0, a.high < 0 ? 0 : INFINITY};
    case OP_MIN:
        return (Range){fmin(a.low, b.low), fmin(a.high, b.high)};
    case OP_MAX:
        return (Range){fmax(a.low, b.low), fmax(a.high, b.high)};
    case OP_LT:
    case OP_LE:
    case OP_EQ:
    case OP_NE:
        return compared(node->op, a, b);
    case OP_AND:
        return claim(is_true(a) && is_true(b), can_be_true(a) && can_be_true(b));
    case OP_OR:
        return claim(is_true(a) || is_true(b), can_be_true(a) || can_be_true(b));
    case OP_NOT:
        return claim(!can_be_true(a), !is_true(a));
    case OP_IF:
        if (is_true(a))
            return b;
        return can_be_true(a) ? hull(b, all[operands[2]]) : all[operands[2]];
    default:
        return by_points(node, all, operands);
    }
}

static Range range_of(const Ranges *r, const RangeNode *node)
{
    const int *operands = r->operands + node->first;
    Range out;

    switch (node->kind) {
    case EXPR_SUM:
        out = r->at[operands[0]];
        for (int i = 1; i < node->count; i++) {
            out.low += r->at[operands[i]].low;
            out.high += r->at[operands[i]].high;
        }
        return out;
    case EXPR_PRODUCT:
        out = r->at[operands[0]];
        for (int i = 1; i < node->count; i++)
            out = product(out, r->at[operands[i]]);
        return out;
    case EXPR_POWER:
        out = r->at[operands[1]];
        if (out.low == out.high)
            return power(r->at[operands[0]], out.low);
        if (r->at[operands[0]].low > 0) /* a^b = exp(b log a) */
            return rising(OP_EXP, product(out, rising(OP_LOG, r->at[operands[0]])));
        return everything;
    case EXPR_CALL:
        return call(node, r->at, operands);
    default:
        return point(node->value);
    }
}

static void find(Ranges *r, int i)
{
    r->at[i] = range_of(r, &r->nodes[i]);
    if (isnan(r->at[i].low) || isnan(r->at[i].high))
        r->at[i] = everything;
}

Ranges *ranges_new(const Expr *roots, int count, Expr symbol, SymbolValue value, void *context)
{
    Ranges *r = NEW(Ranges);
    Walk walk = {0};
    int operands = 0;

    walk_roots(&walk, roots, count);
    for (int i = 0; i < walk.count; i++)
        operands += walk.nodes[i]->count;
    r->nodes = NEW_ARRAY(RangeNode, walk.count);
    r->operands = NEW_ARRAY(int, operands);
    r->at = NEW_ARRAY(Range, walk.count);
    r->moving = NEW_ARRAY(int, walk.count);
    r->roots = NEW_ARRAY(int, count);
    r->out = NEW_ARRAY(Range, count);
    r->below = NEW_ARRAY(int *, count);
    r->below_count = NEW_ARRAY(int, count);
    r->over = (Range){NAN, NAN};
    r->age = NEW_ARRAY(int64_t, walk.count);
    r->count = count;
    r->symbol = walk_find(&walk, symbol);
    operands = 0;
    for (int i = 0; i < walk.count; i++) {
        Expr e = walk.nodes[i];
        RangeNode *node = &r->nodes[i];

        *node = (RangeNode){
            .kind = expr_kind(e), .first = operands, .count = e->count, .moves = e == symbol};
        for (int k = 0; k < e->count; k++) {
            const int operand = walk_find(&walk, expr_arg(e, k));

            r->operands[operands++] = operand;
            node->moves = node->moves || r->nodes[operand].moves;
        }
        if (node->kind == EXPR_CALL) {
            node->op = expr_op(e);
            if (node->op == OP_TABLE) {
                node->curve = expr_data(expr_arg(e, 0));
                node->order = (int)expr_value(expr_arg(e, 2));
            }
        } else if (node->kind == EXPR_SYMBOL) {
            node->value = e == symbol || expr_data(e) != NULL ? 0 : value(context, e);
        } else if (e->count == 0) {
            node->value = expr_value(e);
        }
        if (node->moves)
            r->moving[r->moving_count++] = i;
        else
            find(r, i);
    }
    for (int i = 0; i < count; i++)
        r->roots[i] = walk_find(&walk, roots[i]);
    walk_free(&walk);
    return r;
}

void ranges_free(Ranges *r)
{
    if (r == NULL)
        return;
    for (int i = 0; i < r->count; i++)
        mem_free(r->below[i]);
    MEM_FREE(r->nodes, r->operands, r->at, r->moving, r->roots, r->out);
    MEM_FREE(r->below, r->below_count, r->age, r);
}

/* From here on the symbol is in `over`: ranges found for another interval are stale. */
static void set_interval(Ranges *r, Range over)
{
    if (over.low == r->over.low && over.high == r->over.high)
        return;
    r->over = over;
    r->current++;
}

/* Find the range of a moving node, whose operands have theirs, once an interval. */
static void visit(Ranges *r, int i)
{
    if (r->age[i] == r->current)
        return;
    r->age[i] = r->current;
    r->visits++;
    if (i == r->symbol)
        r->at[i] = r->over;
    else
        find(r, i);
}

/* the moving nodes that a root needs, in the order of all nodes: operands first */
static void find_below(Ranges *r, int root)
{
    bool *needed = NEW_ARRAY(bool, r->roots[root] + 1);
    int count = 0;

    needed[r->roots[root]] = true;
    for (int i = r->roots[root]; i >= 0; i--) {
        needed[i] = needed[i] && r->nodes[i].moves;
        count += needed[i];
        for (int k = 0; needed[i] && k < r->nodes[i].count; k++)
            needed[r->operands[r->nodes[i].first + k]] = true;
    }
    r->below[root] = NEW_ARRAY(int, count);
    for (int i = 0; i <= r->roots[root]; i++)
        if (needed[i])
            r->below[root][r->below_count[root]++] = i;
    mem_free(needed);
}

const Range *ranges_over(Ranges *r, Range over)
{
    set_interval(r, over);
    for (int i = 0; i < r->moving_count; i++)
        visit(r, r->moving[i]);
    for (int i = 0; i < r->count; i++)
        r->out[i] = r->at[r->roots[i]];
    return r->out;
}

Range ranges_root_over(Ranges *r, int root, Range over)
{
    if (r->below[root] == NULL)
        find_below(r, root);
    set_interval(r, over);
    for (int i = 0; i < r->below_count[root]; i++)
        visit(r, r->below[root][i]);
    return r->at[r->roots[root]];
}

int64_t ranges_visits(const Ranges *r)
{
    return r != NULL ? r->visits : 0;
}
