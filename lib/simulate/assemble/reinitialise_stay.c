/* reinitialise_stay.c: what an event that sets positions leaves as it is
 *
 * A rule that knows no trees (algebra/row_closure.h): of the motions that constraints allow at the
 * event's instant, joints stay that what is given doesn't need; then, where chains float, the other
 * coordinates of frames that are named, then bodies. What is given, and what stays, keeps its rate.
 */
#include "algebra/row_closure.h"
#include "simulate/assemble/reinitialise_impl.h"

#include <math.h>
#include <string.h>

enum { OF_JOINTS = ROW_CLASS_FIRST, OF_NAMED, OF_BODIES };

/* --- targets --- */

static int add_hidden(Reinit *reinit, Expr expr, StateLevel level, int held_index)
{
    const VariableIndex *l = reinit->plan.layout;
    Target target = {.expr = expr,
                     .level = level,
                     .node = -1,
                     .rate = -1,
                     .attitude = -1,
                     .turning = -1,
                     .held_index = held_index};

    if (held_index >= 0 && level == LEVEL_POSITION && reinit->stays[held_index].name != NULL)
        target.referent = system_referent(l->system, reinit->stays[held_index].name);
    if (held_index >= 0)
        target.node = reinit->stays[held_index].node;
    reinit_locate(reinit, &target);
    LIST_PUSH(reinit->targets, target);
    return reinit->targets.count - 1;
}

void reinit_add_stays(Reinit *reinit)
{
    reinit->given = reinit->targets.count;
    if (reinit->named.count == 0)
        return;
    for (int k = 0, next = 0; k < reinit->given; k++) {
        Named named;
        int rate, turning;

        if (reinit->targets.at[k].level != LEVEL_POSITION)
            continue;
        system_named(reinit->plan.layout->system, reinit->named.at[next++], &named);
        rate = named.rate != NULL ? add_hidden(reinit, named.rate, LEVEL_VELOCITY, -1) : -1;
        turning =
            named.turning != NULL ? add_hidden(reinit, named.turning, LEVEL_VELOCITY, -1) : -1;
        reinit->targets.at[k].node = named.node;
        reinit->targets.at[k].attitude = named.attitude;
        reinit->targets.at[k].rate = rate;
        reinit->targets.at[k].turning = turning;
    }
    reinit->held_count = system_held_coordinates(reinit->plan.layout->system, reinit->named.at,
                                                 reinit->named.count, &reinit->stays);
    for (int i = 0; i < reinit->held_count; i++) {
        const int k = add_hidden(reinit, reinit->stays[i].value, LEVEL_POSITION, i);
        const int rate = add_hidden(reinit, reinit->stays[i].rate, LEVEL_VELOCITY, i);

        reinit->targets.at[k].rate = rate;
    }
}

/* --- rows --- */

typedef struct TargetRows { /* rows of constraints and of some targets, by unknowns that are near */
    int unknowns, count;
    int *target; /* of a row; -1: a constraint */
    int *of, *fate, *place, *set;
    double *a; /* unknowns x count */
} TargetRows;

static void gathered_free(TargetRows *g)
{
    MEM_FREE(g->target, g->of, g->fate, g->place, g->set, g->a);
}

static int root_of(int *above, int i)
{
    while (above[i] != i)
        i = above[i] = above[above[i]];
    return i;
}

/* Unknowns that no row ties to what is given can't be moved by it; new. given: by row */
static bool *find_near(const Rows *rows, const bool *given)
{
    const Pattern *p = rows->pattern;
    int *above = NEW_ARRAY(int, rows->columns);
    bool *is_root = NEW_ARRAY(bool, rows->columns), *near = NEW_ARRAY(bool, rows->columns);

    for (int i = 0; i < rows->columns; i++)
        above[i] = i;
    for (int r = 0; r < rows->rows; r++)
        for (int k = p->start[r] + 1; k < p->start[r + 1]; k++)
            above[root_of(above, p->row[k])] = root_of(above, p->row[p->start[r]]);
    for (int r = 0; r < rows->rows; r++)
        if (given[r] && p->start[r] < p->start[r + 1])
            is_root[root_of(above, p->row[p->start[r]])] = true;
    for (int i = 0; i < rows->columns; i++)
        near[i] = is_root[root_of(above, i)];
    MEM_FREE(above, is_root);
    return near;
}

/* Rows that move with what is near, as they are here; of_target: class of each. */
static void gather(const Rows *rows, const double *v, const int *target, const int *of_target,
                   const bool *near, TargetRows *out)
{
    const Pattern *p = rows->pattern;
    double *residual = NEW_ARRAY(double, rows->rows), *entries = NEW_ARRAY(double, p->count);
    int *number = NEW_ARRAY(int, rows->columns), *taken = NEW_ARRAY(int, rows->rows);

    *out = (TargetRows){.target = NEW_ARRAY(int, rows->rows), .of = NEW_ARRAY(int, rows->rows)};
    for (int i = 0; i < rows->columns; i++)
        number[i] = near[i] ? out->unknowns++ : -1;
    for (int r = 0; r < rows->rows; r++) {
        bool is_near = false;

        for (int k = p->start[r]; k < p->start[r + 1]; k++)
            is_near = is_near || near[p->row[k]];
        if (!is_near || (target[r] >= 0 && of_target[target[r]] == ROW_CLASS_UNASKED))
            continue;
        out->target[out->count] = target[r];
        out->of[out->count] = target[r] < 0 ? ROW_CLASS_CONSTRAINT : of_target[target[r]];
        taken[out->count++] = r;
    }
    rows->evaluate(rows->context, v, residual, entries);
    out->a = mem_array((size_t)out->unknowns * (size_t)out->count + 1, sizeof(double));
    for (int c = 0; c < out->count; c++)
        for (int k = p->start[taken[c]]; k < p->start[taken[c] + 1]; k++)
            if (number[p->row[k]] >= 0)
                out->a[(size_t)number[p->row[k]] * (size_t)out->count + (size_t)c] = entries[k];
    out->fate = NEW_ARRAY(int, out->count);
    out->place = NEW_ARRAY(int, out->count);
    out->set = NEW_ARRAY(int, out->count);
    MEM_FREE(residual, entries, number, taken);
}

/* by how much unknowns move a row */
static double size_of(const TargetRows *g, int row)
{
    double sum = 0;

    for (int i = 0; i < g->unknowns; i++)
        sum += g->a[(size_t)i * (size_t)g->count + (size_t)row] *
               g->a[(size_t)i * (size_t)g->count + (size_t)row];
    return sqrt(sum);
}

/* by row of a level: the target that it is of those chosen; -1: a constraint. New */
static int *targets_of(const Reinit *reinit, StateLevel level, int rows)
{
    int *target = NEW_ARRAY(int, rows);
    int next = reinit->levels[level]->system_rows;

    for (int r = 0; r < rows; r++)
        target[r] = -1;
    for (int k = 0; k < reinit->targets.count; k++) /* rows of a level are in the same order */
        if (reinit_is_chosen(reinit, k, level))
            target[next++] = k;
    return target;
}

/* --- positions --- */

/* the class of each target; new */
static int *classes_of(const Reinit *reinit)
{
    const Target *targets = reinit->targets.at;
    int *of = NEW_ARRAY(int, reinit->targets.count);

    for (int k = 0; k < reinit->targets.count; k++) {
        const Target *target = &targets[k];
        bool is_named = false;

        of[k] = k < reinit->given && reinit_is_chosen(reinit, k, LEVEL_POSITION)
                    ? ROW_CLASS_GIVEN
                    : ROW_CLASS_UNASKED;
        if (target->level != LEVEL_POSITION || target->held_index < 0)
            continue;
        for (int i = 0; i < reinit->given && target->node >= 0; i++)
            is_named = is_named || (reinit_is_chosen(reinit, i, LEVEL_POSITION) &&
                                    targets[i].node == target->node);
        of[k] = target->node < 0                            ? OF_JOINTS
                : is_named                                  ? OF_NAMED
                : reinit->stays[target->held_index].is_body ? OF_BODIES
                                                            : ROW_CLASS_UNASKED;
    }
    return of;
}

/* "h2 and h3" */
static void report_open(const Reinit *reinit, const TargetRows *g, Decision *out)
{
    int left = 0;

    for (int r = 0; r < g->count; r++)
        left += g->fate[r] == ROW_IS_OPEN;
    for (int r = 0; r < g->count; r++)
        if (g->fate[r] == ROW_IS_OPEN) {
            const HeldCoordinate *held_index =
                &reinit->stays[reinit->targets.at[g->target[r]].held_index];

            text_addf(&out->names, "%s%s", held_index->name != NULL ? "" : "the attitude of ",
                      held_index->name != NULL ? held_index->name : held_index->part);
            text_add(&out->names, --left > 1 ? ", " : left == 1 ? " and " : "");
            out->example = out->example != NULL ? out->example : held_index->name;
        }
}

/* Where three Euler parameters stay the fourth does, which follows from them but for its sign. */
static void keep_attitudes(const Reinit *reinit, const int *of, bool *keeps)
{
    const Target *targets = reinit->targets.at;

    for (int k = reinit->given; k < reinit->targets.count; k++) {
        const int held_index = targets[k].level == LEVEL_POSITION ? targets[k].held_index : -1;
        int others = 0;

        if (held_index < 0 || of[k] == ROW_CLASS_UNASKED || reinit->stays[held_index].attitude < 0)
            continue;
        for (int i = reinit->given; i < reinit->targets.count; i++)
            others +=
                i != k && keeps[i] && targets[i].held_index >= 0 &&
                reinit->stays[targets[i].held_index].attitude == reinit->stays[held_index].attitude;
        keeps[k] = keeps[k] || others >= 3;
    }
}

void reinit_decide(Reinit *reinit, Decision *out)
{
    const int count = reinit->targets.count;
    int *of = classes_of(reinit), *target;
    bool *given;
    double *own = reinit->values;
    TargetRows g;
    Rows rows;

    reinit->values = NEW_ARRAY(double, count);
    for (int k = 0; k < count; k++)
        reinit->values[k] = of[k] == ROW_CLASS_UNASKED ? NAN : 0;
    rows = reinit_rows(reinit, LEVEL_POSITION, true);
    target = targets_of(reinit, LEVEL_POSITION, rows.rows);
    given = NEW_ARRAY(bool, rows.rows);
    for (int r = 0; r < rows.rows; r++)
        given[r] = target[r] >= 0 && of[target[r]] == ROW_CLASS_GIVEN;
    *out = (Decision){.is_near = find_near(&rows, given),
                      .keeps = NEW_ARRAY(bool, count),
                      .size = NEW_ARRAY(double, count)};
    gather(&rows, reinit->y, target, of, out->is_near, &g);
    for (int r = 0; r < g.count; r++)
        if (g.target[r] >= 0)
            out->size[g.target[r]] = size_of(&g, r);
    out->open =
        row_closure_find(g.a, g.unknowns, g.count, g.of, FOLLOW_LEAST, g.fate, g.place, g.set);
    out->rank = row_closure_rank(g.fate, g.count);
    for (int r = 0; r < g.count; r++)
        if (g.target[r] >= 0)
            out->keeps[g.target[r]] = g.fate[r] == ROW_DETERMINES || g.fate[r] == ROW_HOLDS;
    keep_attitudes(reinit, of, out->keeps);
    report_open(reinit, &g, out);
    gathered_free(&g);
    MEM_FREE(of, target, given, reinit->values);
    reinit->values = own;
}

void decision_free(Decision *decision)
{
    MEM_FREE(decision->is_near, decision->keeps, decision->size);
    text_free(&decision->names);
}

/* --- rates --- */

/* whether a target that may stay is of Euler parameters, or their rates */
static bool is_attitude(const Reinit *reinit, int target)
{
    const int held_index = reinit->targets.at[target].held_index;

    return held_index >= 0 && reinit->stays[held_index].attitude >= 0;
}

/* The target that is the rate which target k keeps: of an attitude that is given as a whole its
 * angular velocity, in its own axes. */
static int rate_of(const Reinit *reinit, int k, const double *values)
{
    const Target *targets = reinit->targets.at;
    int count = 0;

    for (int i = 0; i < reinit->given && k < reinit->given && targets[k].attitude >= 0; i++)
        count += !isnan(values[i]) && targets[i].attitude == targets[k].attitude;
    return count == 4 ? targets[k].turning : targets[k].rate;
}

/* What hardly moves any more, against what it did, is at the end of its way. */
static void forget_still(const Reinit *reinit, const Decision *decision, TargetRows *g)
{
    for (int k = 0; k < reinit->targets.count; k++)
        for (int r = 0; r < g->count && decision->size[k] > 0; r++)
            if (g->target[r] >= 0 && g->target[r] == reinit->targets.at[k].rate &&
                size_of(g, r) < ROW_CLOSURE_LEAST_SOLVED * decision->size[k])
                g->of[r] = ROW_CLASS_UNASKED;
}

bool reinit_choose_rates(Reinit *reinit, const Decision *decision, const double *values,
                         const double *before)
{
    const Equations *eq = reinit->plan.equations;
    const int count = reinit->targets.count;
    int *of = NEW_ARRAY(int, count), *target, rank;
    TargetRows g;
    Rows rows;

    for (int k = 0; k < count; k++) {
        const bool is_set =
            k < reinit->given && reinit->targets.at[k].level == LEVEL_VELOCITY && !isnan(values[k]);

        of[k] = is_set ? ROW_CLASS_FIRST + 1 : ROW_CLASS_UNASKED;
        reinit->values[k] = is_set ? values[k] : NAN;
    }
    for (int k = 0; k < count; k++) {
        const int rate = rate_of(reinit, k, values);
        const bool is_given = k < reinit->given && !isnan(values[k]);

        if (rate < 0 || !(is_given || decision->keeps[k]))
            continue;
        of[rate] = is_given ? ROW_CLASS_GIVEN : ROW_CLASS_FIRST;
        reinit->values[rate] = before[rate];
    }
    eq->position(eq->context, reinit->t, reinit->y);
    rows = reinit_rows(reinit, LEVEL_VELOCITY, true);
    target = targets_of(reinit, LEVEL_VELOCITY, rows.rows);
    gather(&rows, reinit->y + eq->n, target, of, decision->is_near, &g);
    forget_still(reinit, decision, &g);
    (void)row_closure_find(g.a, g.unknowns, g.count, g.of, ROW_CLOSURE_LEAST_SOLVED, g.fate,
                           g.place, g.set);
    rank = row_closure_rank(g.fate, g.count);
    for (int k = 0; k < count; k++)
        reinit->values[k] = k < reinit->given ? NAN : reinit->values[k];
    for (int r = 0; r < g.count; r++) {
        const int k = g.target[r];

        if (k >= 0 && g.fate[r] != ROW_FOLLOWS)
            reinit->values[k] = k < reinit->given ? values[k] : before[k];
        else if (k >= 0 && !is_attitude(reinit, k))
            reinit->values[k] = NAN;
    }
    gathered_free(&g);
    MEM_FREE(of, target);
    return rank >= decision->rank;
}
