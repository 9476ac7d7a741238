/* fmu_values.c: new values of events, then the constraints again, as in a run
 *
 * Joint coordinates that the given values don't affect are constant (row_closure.h), and so are the
 * rates of constant and given ones, whatever the coordinates. Speeds change as by an impulse along
 * the given ones. */
#define FMU_TABLES
#include "fmu.h"
#include "row_closure.h"

#include <stdio.h>
#include <string.h>

enum { MOST_STAGES = 500 }; /* to new positions */
#define STILL     1e-9      /* what counts no more of a Newton step to new values */
#define MET       1e-9      /* how near new values and constraints are, of what they compare */
#define DEPENDENT 1e-8      /* of a row: what is left where it follows from others */
#define STAGE     0.2       /* m or rad: so far positions go at a time */

/* Residuals of constraints, first, and of the targets of a level; returns the largest, relative to
 * 1 and the compared values. */
static double find_lacks(Fmu *fmu, int level, const int *target, const double *values, int count,
                         double *lack)
{
    FmuNumbers *now = &fmu->now;
    const int held = level == FMU_STATE ? 0 : MODEL_M;
    double is[FMU_TARGETS + 1], most = 0, size = 1;
    double *entries = fmu->work + MODEL_WORK;
    int i, j, k;

    if (level == FMU_COORDINATE && held > 0) {
        model_constraints(now->p, now->t, now->y, now->s, lack);
        for (i = 0; i < held; i++)
            lack[i] = -lack[i];
    } else if (held > 0) {
        model_velocity(now->p, now->t, now->y, now->s, lack);
        model_jacobian(now->p, now->t, now->y, now->s, entries);
        for (i = 0; i < held; i++)
            for (j = 0; j < MODEL_U; j++)
                lack[i] -= entries[i * MODEL_U + j] * now->y[MODEL_Q + j];
    }
    for (j = 0; level == FMU_SPEED && j < MODEL_U; j++)
        size = fmu_larger(size, fabs(now->y[MODEL_Q + j]));
    for (i = 0; i < held; i++)
        most = fmu_larger(most, fabs(lack[i]) / size);
    model_targets(now->p, now->t, now->y, now->s, is);
    for (k = 0; k < count; k++) {
        const double v = values[target[k]] - is[target[k]];

        lack[held + k] = v;
        most = fmu_larger(most, fabs(v) / fmu_larger(size, fabs(is[target[k]])));
        if (!(fabs(v) < HUGE_VAL))
            most = HUGE_VAL;
    }
    return most;
}

/* how unknown j of a level moves each target */
static void find_slopes(Fmu *fmu, int level, int j, double *slopes)
{
    FmuNumbers *now = &fmu->now;
    double *seed = now->s + MODEL_S, *map = fmu->work + MODEL_WORK;
    int i;

    memset(seed, 0, FMU_SEEDS * sizeof(double));
    if (level == FMU_COORDINATE) {
        model_map(now->p, now->t, now->y, now->s, map);
        for (i = 0; i < MODEL_Q; i++)
            seed[1 + i] = map[i * MODEL_U + j];
    } else
        seed[1 + (level == FMU_STATE ? MODEL_Q + MODEL_U : MODEL_Q) + j] = 1;
    model_tangent_targets(now->p, now->t, now->y, now->s, slopes);
}

/* Rows [W C^T; C 0 | 0; c] of the least change dv with C dv = c: those of the constraints, then of
 * the `count` targets of that level. `by_mass`: least in the mass metric. */
static void least_change(Fmu *fmu, int level, int by_mass, const int *target, const double *lack,
                         int count, double *a)
{
    FmuNumbers *now = &fmu->now;
    const int is_state = level == FMU_STATE, unknowns = is_state ? MODEL_X : MODEL_U;
    const int held = is_state ? 0 : MODEL_M, n = unknowns + held + count, w = n + 1;
    double tangents[FMU_TARGETS + 1];
    double *entries = fmu->work + MODEL_WORK;
    int i, j, k;

    for (i = 0; i < n * w; i++)
        a[i] = 0;
    for (i = 0; i < unknowns; i++)
        a[i * w + i] = 1;
    if (by_mass) {
        model_mass(now->p, now->t, now->y, now->s, entries);
        for (i = 0; i < unknowns; i++)
            for (j = 0; j < unknowns; j++)
                a[i * w + j] = entries[i * unknowns + j];
    }
    if (held > 0) {
        model_jacobian(now->p, now->t, now->y, now->s, entries);
        for (i = 0; i < held; i++)
            for (j = 0; j < unknowns; j++)
                a[j * w + unknowns + i] = a[(unknowns + i) * w + j] = entries[i * unknowns + j];
    }
    for (j = 0; j < unknowns; j++) {
        find_slopes(fmu, level, j, tangents);
        for (k = 0; k < count; k++)
            a[j * w + unknowns + held + k] = a[(unknowns + held + k) * w + j] = tangents[target[k]];
    }
    for (k = 0; k < held + count; k++)
        a[(unknowns + k) * w + n] = lack[k];
}

/* Leave out rows of C, and their columns, that follow from those before them. How many rows are
 * left in all. `base`: unknowns^2 numbers. */
static int keep_independent(double *a, int n, int unknowns, double *base)
{
    const int w = n + 1;
    int keep[FMU_ROWS + 2], count = 0, found = 0;
    int i, j, k, again;

    for (i = 0; i < n; i++) {
        double *row = base + found * unknowns, before = 0, after = 0;

        for (j = 0; i >= unknowns && found < unknowns && j < unknowns; j++) {
            row[j] = a[i * w + j];
            before += row[j] * row[j];
        }
        for (again = 0; before > 0 && again < 2; again++)
            for (k = 0; k < found; k++) {
                double dot = 0;

                for (j = 0; j < unknowns; j++)
                    dot += base[k * unknowns + j] * row[j];
                for (j = 0; j < unknowns; j++)
                    row[j] -= dot * base[k * unknowns + j];
            }
        for (j = 0; before > 0 && j < unknowns; j++)
            after += row[j] * row[j];
        if (i >= unknowns && !(after > DEPENDENT * DEPENDENT * before))
            continue;
        for (j = 0; i >= unknowns && j < unknowns; j++)
            row[j] /= sqrt(after);
        found += i >= unknowns;
        keep[count++] = i;
    }
    keep[count] = n;
    for (i = 0; i < count; i++)
        for (j = 0; j <= count; j++)
            a[i * (count + 1) + j] = a[keep[i] * w + keep[j]];
    return count;
}

static void normalise(Fmu *fmu)
{
    int i, k;

    for (k = 0; k < FMU_QUATERNIONS; k++) {
        double *at = fmu->now.y + fmu_quaternion[k], sum = 0;

        for (i = 0; i < 4; i++)
            sum += at[i] * at[i];
        for (i = 0; sum > 0 && i < 4; i++)
            at[i] /= sqrt(sum);
    }
}

/* Of four Euler parameters that are chosen, whether it is the largest one, which follows best from
 * the others. */
static int follows(const int *chosen, const double *values, int k)
{
    int i, count = 0, is_largest = 1;

    for (i = 0; i < FMU_TARGETS && fmu_attitude[k] >= 0; i++) {
        const int is_same = chosen[i] && fmu_level[i] == FMU_COORDINATE &&
                            fmu_attitude[i] == fmu_attitude[k] &&
                            (i < FMU_GIVEN) == (k < FMU_GIVEN);

        count += is_same;
        if (is_same &&
            (i < k ? fabs(values[i]) >= fabs(values[k]) : fabs(values[i]) > fabs(values[k])))
            is_largest = 0;
    }
    return fmu_level[k] == FMU_COORDINATE && count == 4 && is_largest;
}

/* Set targets of a level to their values: target states directly, then the least change of other
 * states that is needed. Speeds change together; `by_mass`: as by an impulse along the targets.
 * Returns whether all are met. */
static int put_level(Fmu *fmu, int level, int by_mass, const int *chosen, const double *values)
{
    FmuNumbers *now = &fmu->now;
    const int unknowns = level == FMU_STATE ? MODEL_X : MODEL_U;
    double *a = fmu->space, *x = a + FMU_ROWS * (FMU_ROWS + 1), *rest = x + FMU_ROWS + 1;
    double lack[FMU_TARGETS + MODEL_M + 1], furthest = HUGE_VAL;
    int target[FMU_TARGETS + 1];
    int i, j, k, sweep, count = 0;

    for (k = 0; k < 2 * FMU_TARGETS; k++) { /* the last ones follow from others */
        const int at = k < FMU_TARGETS ? k : k - FMU_TARGETS;

        if (!chosen[at] || fmu_level[at] != level || follows(chosen, values, at) != (k != at))
            continue;
        target[count++] = at;
        if (fmu_place[at] >= 0 && level != FMU_SPEED)
            now->y[fmu_place[at]] = values[at];
    }
    for (sweep = 0; furthest > STILL && sweep < (level == FMU_COORDINATE ? 20 : 2); sweep++) {
        const int n = unknowns + (level == FMU_STATE ? 0 : MODEL_M) + count;

        if (level == FMU_COORDINATE)
            normalise(fmu);
        (void)find_lacks(fmu, level, target, values, count, lack);
        least_change(fmu, level, by_mass, target, lack, count, a);
        if (model_solve_rows(a, keep_independent(a, n, unknowns, x), x, rest) != MODEL_OK)
            return 0;
        furthest = 0;
        for (i = 0; i < unknowns; i++)
            furthest = fmu_larger(furthest, fabs(x[i]));
        if (level == FMU_COORDINATE) {
            model_map(now->p, now->t, now->y, now->s, fmu->work);
            for (i = 0; i < MODEL_Q; i++)
                for (j = 0; j < MODEL_U; j++)
                    now->y[i] += fmu->work[i * MODEL_U + j] * x[j];
            normalise(fmu);
        } else
            for (i = 0; i < unknowns; i++)
                now->y[(level == FMU_STATE ? MODEL_Q + MODEL_U : MODEL_Q) + i] += x[i];
    }
    return find_lacks(fmu, level, target, values, count, lack) <= MET;
}

/* --- held coordinates --- */

enum { OF_JOINTS = ROW_CLASS_FIRST, OF_NAMED, OF_BODIES, ROWS_MOST = MODEL_M + FMU_TARGETS + 1 };

typedef struct Decision {
    int keeps[FMU_TARGETS + 1];   /* it is given and not redundant, or held */
    double size[FMU_TARGETS + 1]; /* how much unknowns move it */
    int is_near[MODEL_U + 1];     /* unknowns that may move */
    int rank, open;
    char names[200]; /* of what is open */
} Decision;

typedef struct Gathered { /* rows of constraints, and of the selected targets */
    int count, target[ROWS_MOST], of[ROWS_MOST], fate[ROWS_MOST], place[ROWS_MOST], set[ROWS_MOST];
} Gathered;

/* Rows at the position as it is, of targets of a class, into a; of: by target. */
static void gather(Fmu *fmu, const int *of, Gathered *g, double *a)
{
    FmuNumbers *now = &fmu->now;
    double position[FMU_TARGETS + 1], speed[FMU_TARGETS + 1], *entries = fmu->work + MODEL_WORK;
    int i, j, k;

    g->count = 0;
    for (i = 0; i < MODEL_M; i++) {
        g->of[g->count] = ROW_CLASS_CONSTRAINT;
        g->target[g->count++] = -1;
    }
    for (k = 0; k < FMU_TARGETS; k++)
        if (of[k] != ROW_CLASS_UNASKED) {
            g->of[g->count] = of[k];
            g->target[g->count++] = k;
        }
    if (MODEL_M > 0)
        model_jacobian(now->p, now->t, now->y, now->s, entries);
    for (i = 0; i < MODEL_M; i++)
        for (j = 0; j < MODEL_U; j++)
            a[j * g->count + i] = entries[i * MODEL_U + j];
    for (j = 0; j < MODEL_U; j++) {
        find_slopes(fmu, FMU_COORDINATE, j, position);
        find_slopes(fmu, FMU_SPEED, j, speed);
        for (i = MODEL_M; i < g->count; i++)
            a[j * g->count + i] =
                fmu_level[g->target[i]] == FMU_SPEED ? speed[g->target[i]] : position[g->target[i]];
    }
}

/* Unknowns that no row couples to given ones aren't changed by these. */
static void find_near(const Gathered *g, const double *a, int *is_near)
{
    int i, r, more = 1;

    for (i = 0; i < MODEL_U; i++)
        is_near[i] = 0;
    while (more) {
        more = 0;
        for (r = 0; r < g->count; r++) {
            int any = g->of[r] == ROW_CLASS_GIVEN;

            for (i = 0; i < MODEL_U; i++)
                any |= is_near[i] && fabs(a[i * g->count + r]) > 0;
            for (i = 0; any && i < MODEL_U; i++)
                if (!is_near[i] && fabs(a[i * g->count + r]) > 0)
                    more = is_near[i] = 1;
        }
    }
}

static void forget_far(const Gathered *g, const int *is_near, double *a)
{
    int i, r;

    for (i = 0; i < MODEL_U; i++)
        for (r = 0; !is_near[i] && r < g->count; r++)
            a[i * g->count + r] = 0;
}

static double size_of(const Gathered *g, const double *a, int row)
{
    double sum = 0;
    int i;

    for (i = 0; i < MODEL_U; i++)
        sum += a[i * g->count + row] * a[i * g->count + row];
    return sqrt(sum);
}

static void find_classes(const int *chosen, int *of)
{
    int i, k;

    for (k = 0; k < FMU_TARGETS; k++) {
        int is_named = 0;

        of[k] = ROW_CLASS_UNASKED;
        if (fmu_level[k] != FMU_COORDINATE)
            continue;
        for (i = 0; i < FMU_GIVEN; i++)
            is_named |= chosen[i] && fmu_level[i] == FMU_COORDINATE && fmu_node[k] >= 0 &&
                        fmu_node[i] == fmu_node[k];
        if (k < FMU_GIVEN)
            of[k] = chosen[k] ? ROW_CLASS_GIVEN : ROW_CLASS_UNASKED;
        else if (fmu_held_kind[k] == FMU_JOINT)
            of[k] = OF_JOINTS;
        else if (is_named)
            of[k] = OF_NAMED;
        else if (fmu_held_kind[k] == FMU_BODY)
            of[k] = OF_BODIES;
    }
}

/* If three Euler parameters are held, so is the fourth: it follows from them except for its
 * sign. */
static void keep_attitudes(const int *of, int *keeps)
{
    int i, k;

    for (k = FMU_GIVEN; k < FMU_TARGETS; k++) {
        int others = 0;

        if (of[k] == ROW_CLASS_UNASKED || fmu_attitude[k] < 0)
            continue;
        for (i = FMU_GIVEN; i < FMU_TARGETS; i++)
            others += i != k && keeps[i] && fmu_attitude[i] == fmu_attitude[k];
        keeps[k] |= others >= 3;
    }
}

/* Held and undetermined coordinates, by the motions that constraints allow here. */
static void decide(Fmu *fmu, const int *chosen, Decision *out)
{
    int of[FMU_TARGETS + 1], r;
    size_t length = 0;
    double *a = fmu->space;
    Gathered g;

    memset(out, 0, sizeof *out);
    find_classes(chosen, of);
    gather(fmu, of, &g, a);
    find_near(&g, a, out->is_near);
    forget_far(&g, out->is_near, a);
    for (r = MODEL_M; r < g.count; r++)
        out->size[g.target[r]] = size_of(&g, a, r);
    out->open = row_closure_find(a, MODEL_U, g.count, g.of, FOLLOW_LEAST, g.fate, g.place, g.set);
    out->rank = row_closure_rank(g.fate, g.count);
    for (r = MODEL_M; r < g.count; r++) {
        const char *name = fmu_target_name[g.target[r]];

        out->keeps[g.target[r]] = g.fate[r] == ROW_DETERMINES || g.fate[r] == ROW_HOLDS;
        if (g.fate[r] == ROW_IS_OPEN && length + strlen(name) + 3 < sizeof out->names)
            length += (size_t)snprintf(out->names + length, sizeof out->names - length, "%s%s",
                                       length > 0 ? ", " : "", name);
    }
    keep_attitudes(of, out->keeps);
}

/* The target that is the rate of target k: for a completely given attitude its angular velocity, in
 * its own axes. */
static int rate_of(const int *chosen, int k)
{
    int i, count = 0;

    for (i = 0; i < FMU_GIVEN && k < FMU_GIVEN && fmu_attitude[k] >= 0; i++)
        count += chosen[i] && fmu_attitude[i] == fmu_attitude[k];
    return count == 4 ? fmu_turning[k] : fmu_rate[k];
}

/* The former rates of given and held coordinates, as far as they are independent here; 0: they
 * don't determine all speeds. */
static int keep_rates(Fmu *fmu, const Decision *decision, const int *chosen, const double *values,
                      const double *before)
{
    int of[FMU_TARGETS + 1], take[FMU_TARGETS + 1] = {0}, k, r;
    double to[FMU_TARGETS + 1], *a = fmu->space;
    Gathered g;

    for (k = 0; k < FMU_TARGETS; k++) {
        const int is_set = k < FMU_GIVEN && fmu_level[k] == FMU_SPEED && chosen[k];

        of[k] = is_set ? ROW_CLASS_FIRST + 1 : ROW_CLASS_UNASKED;
        to[k] = is_set ? values[k] : before[k];
    }
    for (k = 0; k < FMU_TARGETS; k++) {
        const int rate = rate_of(chosen, k), is_given = k < FMU_GIVEN && chosen[k];

        if (rate >= 0 && (is_given || decision->keeps[k]))
            of[rate] = is_given ? ROW_CLASS_GIVEN : ROW_CLASS_FIRST;
    }
    gather(fmu, of, &g, a);
    forget_far(&g, decision->is_near, a);
    for (k = 0; k < FMU_TARGETS; k++) /* at the end of its way */
        for (r = MODEL_M; fmu_rate[k] >= 0 && decision->size[k] > 0 && r < g.count; r++)
            if (g.target[r] == fmu_rate[k] &&
                size_of(&g, a, r) < ROW_CLOSURE_LEAST_SOLVED * decision->size[k])
                g.of[r] = ROW_CLASS_UNASKED;
    (void)row_closure_find(a, MODEL_U, g.count, g.of, ROW_CLOSURE_LEAST_SOLVED, g.fate, g.place,
                           g.set);
    for (r = MODEL_M; r < g.count; r++)
        take[g.target[r]] = g.fate[r] != ROW_FOLLOWS;
    return row_closure_rank(g.fate, g.count) >= decision->rank &&
           put_level(fmu, FMU_SPEED, 0, take, to);
}

/* --- new values --- */

/* Either sign of Euler parameters is the same attitude: the new values get that of `from`. */
static void align(const int *chosen, const double *from, const double *values, double *to)
{
    int i, k;

    for (k = 0; k < FMU_GIVEN; k++) {
        double along = 0;

        for (i = 0; i < FMU_GIVEN && fmu_attitude[k] >= 0; i++)
            if (chosen[i] && fmu_attitude[i] == fmu_attitude[k])
                along += from[i] * values[i];
        to[k] = along < 0 ? -values[k] : values[k];
    }
}

/* Between two attitudes lie others: all four parameters that are chosen of one, to size 1. */
static void even(const int *chosen, const double *way, double *stage)
{
    int i, k;

    for (k = 0; k < FMU_TARGETS; k++) {
        double square = 0;
        int count = 0;

        for (i = 0; i < FMU_GIVEN && k < FMU_GIVEN && fmu_attitude[k] >= 0; i++)
            if (chosen[i] && fmu_attitude[i] == fmu_attitude[k]) {
                square += way[i] * way[i];
                count++;
            }
        stage[k] = count == 4 && square > 0 ? way[k] / sqrt(square) : way[k];
    }
}

/* positions, by a way on which each is near the one before */
static int go_by_stages(Fmu *fmu, const int *chosen, const double *from, const double *values)
{
    double way[FMU_TARGETS + 1], stage[FMU_TARGETS + 1], far = 0;
    int i, k, met = 1, count;

    for (k = 0; k < FMU_TARGETS; k++)
        if (chosen[k] && fmu_level[k] == FMU_COORDINATE)
            far = fmu_larger(far, fabs(values[k] - from[k]));
    count = far < STAGE * MOST_STAGES ? 1 + (int)(far / STAGE) : MOST_STAGES;
    for (i = 1; i <= count && met; i++) {
        for (k = 0; k < FMU_TARGETS; k++)
            way[k] = from[k] + (values[k] - from[k]) * i / count;
        even(chosen, way, stage);
        met = put_level(fmu, FMU_COORDINATE, 0, chosen, i == count ? values : stage);
        fmu_set_references(fmu);
    }
    return met;
}

/* a message, extended by the undetermined coordinates */
static FmuStatus refuse(Fmu *fmu, const char *text, const char *names, const char *rest)
{
    char line[280];

    (void)snprintf(line, sizeof line, "%s%.150s%s", text, names, rest);
    return fmu_fail(fmu, FMU_ERROR, line, fmu->now.y[0]);
}

static FmuStatus put_positions(Fmu *fmu, const int *chosen, const double *values)
{
    FmuNumbers *now = &fmu->now;
    double begun[MODEL_Y + 1], from[FMU_TARGETS + 1], to[FMU_TARGETS + 1];
    int stay[FMU_TARGETS + 1], k;
    Decision decision;

    memcpy(begun, now->y, MODEL_Y * sizeof(double));
    model_targets(now->p, now->t, now->y, now->s, from);
    decide(fmu, chosen, &decision);
    if (decision.open > 0)
        return refuse(fmu, "an event doesn't determine where to go: ", decision.names,
                      "; what it sets moves more than follows from it");
    memcpy(to, from, FMU_TARGETS * sizeof(double));
    align(chosen, from, values, to);
    for (k = 0; k < FMU_TARGETS; k++)
        stay[k] = k < FMU_GIVEN ? chosen[k] : decision.keeps[k] && fmu_level[k] == FMU_COORDINATE;
    if (!go_by_stages(fmu, stay, from, to)) {
        memcpy(now->y, begun, MODEL_Y * sizeof(double));
        if (!put_level(fmu, FMU_COORDINATE, 0, stay, to))
            return refuse(fmu, "an event's new values contradict the constraints", "", "");
        fmu_set_references(fmu);
    }
    if (!keep_rates(fmu, &decision, chosen, values, from))
        return refuse(fmu,
                      "an event sets a singular position, where the rates of before don't set all "
                      "rates",
                      "", "");
    return FMU_OK;
}

FmuStatus fmu_set_values(Fmu *fmu, const int *chosen, const double *values)
{
    int k, any[FMU_STATE + 1] = {0}, met = 1;

    for (k = 0; k < FMU_GIVEN; k++)
        any[fmu_level[k]] |= chosen[k];
    if (any[FMU_COORDINATE] && put_positions(fmu, chosen, values) != FMU_OK)
        return FMU_ERROR;
    if (any[FMU_SPEED] || (any[FMU_COORDINATE] && MODEL_M > 0))
        met = put_level(fmu, FMU_SPEED, 1, chosen, values);
    if (met && any[FMU_STATE])
        met = put_level(fmu, FMU_STATE, 0, chosen, values);
    fmu->now.is_solved = 0;
    return met ? FMU_OK : refuse(fmu, "an event's new values contradict the constraints", "", "");
}
