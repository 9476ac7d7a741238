/* row_patterns.c: patterns of rows, and the rows made from them */
#include "formulate/kinematics/row_patterns.h"

#include "formulate/kinematics/circuits.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/origin.h"

#include <string.h>

/* An instance that closes circuits in more ways than this gets no more patterns. */
enum { MOST = 16 };

typedef struct Hole { /* a symbol that replaces a number */
    int node, component;
    Expr symbol;
} Hole;

typedef struct PatternRow {
    Row row;
    Expr shown;
    Expr *phi_u; /* NULL: its recursive form is not built yet */
    Expr phi, gamma;
} PatternRow;

typedef struct RowPattern {
    System shadow; /* the System with the holes */
    Kinematics kinematics;
    int tail, head;
    LIST(Hole) holes;
    LIST(PatternRow) rows;
} RowPattern;

struct RowPatterns {
    System *system;
    LIST(RowPattern *) list;
    /* the last result: a chord has several rows */
    int tail, head;
    RowPattern *pattern;
    const Follower *follower;
};

RowPatterns *row_patterns_new(System *system)
{
    RowPatterns *patterns = NEW(RowPatterns);

    patterns->system = system;
    patterns->tail = patterns->head = -1;
    return patterns;
}

void row_patterns_free(RowPatterns *patterns)
{
    if (patterns == NULL)
        return;
    for (int i = 0; i < patterns->list.count; i++) {
        LIST_FREE(patterns->list.at[i]->holes);
        LIST_FREE(patterns->list.at[i]->rows);
        mem_free(patterns->list.at[i]);
    }
    LIST_FREE(patterns->list);
    mem_free(patterns);
}

/* --- making a pattern --- */

/* a number, or an expression of parameters, including lifted constants */
static bool is_constant(Expr e)
{
    return (expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) == 0;
}

/* Its number may differ: nothing moves with it except the chord's own end. */
static bool may_differ(const System *system, const RowPattern *pattern, int node)
{
    const Frame *frame = &system->kinematics->frames[node];

    return isomorphic_is_outside(system, node) && frame->slide_count == 0 &&
           (node == pattern->tail || node == pattern->head ||
            (vec_is_zero(frame->v) && vec_is_zero(system->kinematics->a0[node])));
}

/* Adds holes where its shift or that of the instance isn't 0; outward, since the frames that move
 * with one also move with those before it. */
static void add_holes(const RowPatterns *patterns, RowPattern *pattern, int node, int own,
                      int ancestor)
{
    const System *system = patterns->system;
    const Frame *frames = system->kinematics->frames;
    LIST(int) way = {0}, own_way = {0};

    for (; node != ancestor && own >= 0; node = frames[node].parent, own = frames[own].parent) {
        LIST_PUSH(way, node);
        LIST_PUSH(own_way, own);
    }
    for (int i = way.count - 1; i >= 0; i--) {
        const int at = way.at[i], before = pattern->holes.count;
        Vec *shift = &pattern->kinematics.frames[at].shift;

        for (int c = 0; c < 3 && may_differ(system, pattern, at); c++) {
            const Expr other = frames[own_way.at[i]].shift.at[c];
            Hole hole = {.node = at, .component = c};

            if (!is_constant(shift->at[c]) || (expr_is_zero(shift->at[c]) && expr_is_zero(other)))
                continue;
            hole.symbol = expr_symbol(
                system->arena,
                system_retain(system, "#hole%d_%d", patterns->list.count, pattern->holes.count),
                SYMBOL_PARAMETER);
            shift->at[c] = hole.symbol;
            LIST_PUSH(pattern->holes, hole);
        }
        if (pattern->holes.count > before)
            node_moved(&pattern->shadow, at);
    }
    LIST_FREE(way);
    LIST_FREE(own_way);
}

static void *copied(const System *system, const void *from, size_t size)
{
    return memcpy(pool_alloc(system->pool, size), from, size);
}

/* through the first of an instance, to the frame where the chord of another one leads */
static RowPattern *add_pattern(RowPatterns *patterns, int tail, int head)
{
    const System *system = patterns->system;
    const size_t nodes = (size_t)graph_node_count(system->origin->graph);
    RowPattern *pattern = NEW(RowPattern);
    int ancestor;

    pattern->shadow = *system;
    pattern->kinematics = *system->kinematics;
    pattern->shadow.kinematics = &pattern->kinematics;
    pattern->kinematics.frames = copied(system, system->kinematics->frames, nodes * sizeof(Frame));
    pattern->kinematics.a0 = copied(system, system->kinematics->a0, nodes * sizeof(Vec));
    if (isomorphic_node(system, tail, &pattern->tail) == NULL)
        pattern->tail = tail;
    if (isomorphic_node(system, head, &pattern->head) == NULL)
        pattern->head = head;
    ancestor = circuit_parting(system, pattern->tail, pattern->head);
    add_holes(patterns, pattern, pattern->tail, tail, ancestor);
    add_holes(patterns, pattern, pattern->head, head, ancestor);
    LIST_PUSH(patterns->list, pattern);
    return pattern;
}

/* --- finding a pattern --- */

static Expr hole_at(const RowPattern *pattern, int node, int component)
{
    for (int i = 0; i < pattern->holes.count; i++)
        if (pattern->holes.at[i].node == node && pattern->holes.at[i].component == component)
            return pattern->holes.at[i].symbol;
    return NULL;
}

/* whether an instance outside has the pattern's position, except for the numbers of holes */
static bool is_same_pattern(const System *system, const RowPattern *pattern,
                            const Follower *follower, int node, int own)
{
    const Frame *a = &pattern->kinematics.frames[node], *b = &system->kinematics->frames[own];

    if (a->chain != b->chain || a->step_chain != b->step_chain ||
        (node != own && (a->slide_count > 0 || b->slide_count > 0)))
        return false;
    for (int c = 0; c < 3; c++) {
        const Expr hole = hole_at(pattern, node, c);

        if (hole == NULL
                ? a->shift.at[c] != b->shift.at[c]
                : !is_constant(b->shift.at[c]) || !isomorphic_fill(follower, hole, b->shift.at[c]))
            return false;
    }
    return true;
}

static bool same_way(const System *system, const RowPattern *pattern, const Follower *follower,
                     int node, int own, int parting, int own_parting)
{
    const Frame *frames = system->kinematics->frames;
    int first;

    for (; node != parting && own != own_parting;
         node = frames[node].parent, own = frames[own].parent) {
        const bool inside = isomorphic_node(system, own, &first) == follower;

        if (inside ? first != node
                   : isomorphic_is_first(system, follower, node) ||
                         !is_same_pattern(system, pattern, follower, node, own))
            return false;
    }
    if (node != parting || own != own_parting)
        return false;
    return isomorphic_node(system, own, &first) == follower ? first == node : own == node;
}

static bool matches(const RowPatterns *patterns, const RowPattern *pattern,
                    const Follower *follower, int tail, int head)
{
    const System *system = patterns->system;
    const int parting = circuit_parting(system, pattern->tail, pattern->head),
              own = circuit_parting(system, tail, head);

    return same_way(system, pattern, follower, pattern->tail, tail, parting, own) &&
           same_way(system, pattern, follower, pattern->head, head, parting, own);
}

static RowPattern *find(RowPatterns *patterns, const Row *row)
{
    const System *system = patterns->system;
    int first;
    const Follower *at_tail = isomorphic_node(system, row->tail, &first),
                   *at_head = isomorphic_node(system, row->head, &first);

    if (row->tail == patterns->tail && row->head == patterns->head)
        return patterns->pattern;
    patterns->tail = row->tail;
    patterns->head = row->head;
    patterns->pattern = NULL;
    patterns->follower = at_tail != NULL ? at_tail : at_head;
    if (patterns->follower == NULL || !isomorphic_moves(patterns->follower) ||
        (at_tail != NULL && at_head != NULL && at_tail != at_head))
        return NULL;
    for (int i = 0; i < MOST && patterns->pattern == NULL; i++) {
        const bool is_new = i == patterns->list.count;
        RowPattern *pattern =
            is_new ? add_pattern(patterns, row->tail, row->head) : patterns->list.at[i];

        if (matches(patterns, pattern, patterns->follower, row->tail, row->head))
            patterns->pattern = pattern;
        if (is_new)
            break;
    }
    return patterns->pattern;
}

/* the corresponding row of the pattern; NULL: it has none */
static PatternRow *find_row(RowPatterns *patterns, const Row *row)
{
    RowPattern *pattern = find(patterns, row);
    PatternRow other = {.row = *row};

    if (pattern == NULL)
        return NULL;
    for (int i = 0; i < pattern->rows.count; i++) {
        const Row *own = &pattern->rows.at[i].row;

        if (own->kind == row->kind &&
            vec_same(isomorphic_vec(patterns->follower, own->n), row->n) &&
            vec_same(isomorphic_vec(patterns->follower, own->b), row->b))
            return &pattern->rows.at[i];
    }
    other.row.tail = pattern->tail;
    other.row.head = pattern->head;
    /* directions are numbers, or the pattern's own ones aren't known */
    if (!vec_same(isomorphic_vec(patterns->follower, row->n), row->n) ||
        !vec_same(isomorphic_vec(patterns->follower, row->b), row->b))
        return NULL;
    other.shown = circuit_shown(&pattern->shadow, &other.row);
    LIST_PUSH(pattern->rows, other);
    return &pattern->rows.at[pattern->rows.count - 1];
}

bool row_pattern_show(RowPatterns *patterns, const Row *row, Expr *phi)
{
    const PatternRow *pattern = find_row(patterns, row);

    if (pattern != NULL)
        *phi = isomorphic_take(patterns->follower, pattern->shown);
    return pattern != NULL;
}

static void run(RowPattern *pattern, PatternRow *row)
{
    System *shadow = &pattern->shadow;
    const int all = shadow->kinematics->u.count;
    int *speeds = NEW_ARRAY(int, shadow->kinematics->speed_count);

    shadow->run.phi = &row->phi;
    shadow->run.gamma = &row->gamma;
    shadow->run.phi_u = pool_alloc(shadow->pool, (size_t)all * sizeof(Expr));
    for (int j = 0; j < all; j++)
        shadow->run.phi_u[j] = expr_int(shadow->arena, 0);
    circuit_run(shadow, &row->row, 0, speeds, circuit_speeds(shadow, &row->row, speeds));
    row->phi_u = shadow->run.phi_u;
    mem_free(speeds);
}

bool row_pattern_run(RowPatterns *patterns, const Row *row, int k, const int *speeds, int count)
{
    const System *system = patterns->system;
    PatternRow *pattern = find_row(patterns, row);
    const Follower *follower = patterns->follower;

    if (pattern == NULL)
        return false;
    if (pattern->phi_u == NULL)
        run(patterns->pattern, pattern);
    system->run.phi[k] = isomorphic_take(follower, pattern->phi);
    system->run.gamma[k] = isomorphic_take(follower, pattern->gamma);
    for (int i = 0; i < count; i++) {
        int j = speeds[i];

        if (isomorphic_speed(system, speeds[i], &j) != follower)
            j = speeds[i];
        system->run.phi_u[k * system->kinematics->u.count + speeds[i]] =
            isomorphic_take(follower, pattern->phi_u[j]);
    }
    return true;
}
