/* fmu_slide.c: motions along surfaces on which the equations jump, as of what sticks
 *
 * The sign of such a surface h = 0 is between its bounds, and such that slip, h' or h itself,
 * remains 0. Signs are parameters of the equations, which are linear in them where friction is
 * constant: Newton's method, by exact derivatives, takes one step then. Which surfaces are slid
 * along after an instant is found by surface_sides.c, as in a run of cotree. */
#define FMU_TABLES
#include "fmu.h"

#include <stdio.h>
#include <string.h>

enum { TURNS = 40 };    /* of Newton's method */
#define ROUNDING  1e-13 /* of the signs: moves that can't be distinguished */
#define CONVERGED 1e-9  /* and those that rounding may leave */
#define SLOW      0.1   /* contraction by slopes of an earlier state: below that they are kept */
#define SINGULAR  1e-13 /* of the largest slope */
#define STILL     1e-12 /* of 1 + the largest state: on a surface */
#define AHEAD     1e-7  /* of 1 + |t|: where several signs end, sides are looked for so soon */

static int slid(const FmuNumbers *now, int *at)
{
    int k, count = 0;

    for (k = 0; k < FMU_SLIDES; k++)
        if (now->side[fmu_slide[k]] == 0)
            at[count++] = k;
    return count;
}

int fmu_slides(const FmuNumbers *now)
{
    int at[FMU_SLIDES + 1] = {0};

    return slid(now, at);
}

static double state_size(const double *y)
{
    double most = 1;
    int i;

    for (i = 0; i < FMU_STATES; i++)
        most = fmu_larger(most, fabs(y[i]));
    return most;
}

/* --- signs --- */

/* Derivatives of slips by sign k alone, where s is solved for, in `column`. */
static int slope_of(FmuNumbers *now, int k, double *column, double *work)
{
    double *seed = now->s + MODEL_S;
    int i, status;

    memset(seed, 0, FMU_SEEDS * sizeof(double));
    seed[FMU_SEEDS - FMU_SLIDES + k] = 1;
    status = model_tangent(now->p, now->t, now->y, now->s, work);
    if (status != MODEL_OK)
        return status;
    model_tangent_slides(now->p, now->t, now->y, now->s, column);
    model_tangent_p_slides(now->p, now->t, now->y, now->s, work);
    for (i = 0; i < FMU_SLIDES; i++)
        column[i] += work[i];
    return MODEL_OK;
}

/* inverse of a matrix (n x n) in its place; 0: it is singular */
static int invert(double *a, int n)
{
    int rows[FMU_SLIDES + 1], i, j, k;
    double least = 0;

    for (i = 0; i < n * n; i++)
        least = fmu_larger(least, fabs(a[i]) * SINGULAR);
    for (k = 0; k < n; k++) {
        int pivot = k;
        double v;

        for (i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[pivot * n + k]))
                pivot = i;
        rows[k] = pivot;
        if (!(fabs(a[pivot * n + k]) > least))
            return 0;
        for (j = 0; pivot != k && j < n; j++) {
            v = a[k * n + j];
            a[k * n + j] = a[pivot * n + j];
            a[pivot * n + j] = v;
        }
        v = 1 / a[k * n + k];
        a[k * n + k] = 1;
        for (j = 0; j < n; j++)
            a[k * n + j] *= v;
        for (i = 0; i < n; i++) {
            if (i == k)
                continue;
            v = a[i * n + k];
            a[i * n + k] = 0;
            for (j = 0; j < n; j++)
                a[i * n + j] -= v * a[k * n + j];
        }
    }
    for (k = n - 1; k >= 0; k--) /* columns, as rows were exchanged */
        for (i = 0; rows[k] != k && i < n; i++) {
            const double v = a[i * n + k];

            a[i * n + k] = a[i * n + rows[k]];
            a[i * n + rows[k]] = v;
        }
    return 1;
}

/* where s is solved for with the signs as they are */
static int find_slopes(FmuNumbers *now, const int *at, int n, double *work)
{
    double column[3 * FMU_SLIDES + 1];
    int i, k, status;

    for (k = 0; k < n; k++) {
        status = slope_of(now, at[k], column, work);
        if (status != MODEL_OK)
            return status;
        for (i = 0; i < n; i++)
            now->slopes[i * n + k] = column[at[i]];
    }
    if (!invert(now->slopes, n))
        return MODEL_SINGULAR;
    now->has_slopes = 2;
    return MODEL_OK;
}

/* x: changes of signs that change slips by -`slip`, of those slid along; the largest */
static double moves_of(const FmuNumbers *now, const int *at, int n, const double *slip, double *x)
{
    double most = 0;
    int i, j;

    for (i = 0; i < n; i++) {
        x[i] = 0;
        for (j = 0; j < n; j++)
            x[i] -= now->slopes[i * n + j] * slip[at[j]];
        if (!(fabs(x[i]) <= most))
            most = fabs(x[i]);
    }
    return most;
}

int fmu_slide_solve(Fmu *fmu)
{
    FmuNumbers *now = &fmu->now;
    int at[FMU_SLIDES + 1] = {0}, i, turn, status, is_slow = 0;
    const int n = slid(now, at);
    double before = HUGE_VAL;

    if (n == 0)
        return model_solve(now->p, now->t, now->y, now->s, fmu->work);
    for (turn = 0; turn < TURNS; turn++) {
        double slides[3 * FMU_SLIDES + 1], x[FMU_SLIDES + 1], moved, size = 1;

        for (i = 0; i < n; i++) {
            size = fmu_larger(size, fabs(now->sign[at[i]]));
            now->p[FMU_FIRST_SIDE + fmu_slide[at[i]]] = now->sign[at[i]];
        }
        model_prepare(now->p);
        status = model_solve(now->p, now->t, now->y, now->s, fmu->work);
        if (status != MODEL_OK)
            return status;
        model_slides(now->p, now->t, now->y, now->s, slides);
        now->has_slopes = now->has_slopes > 0 && !is_slow ? 1 : 0;
        if (now->has_slopes == 0) {
            status = find_slopes(now, at, n, fmu->work);
            if (status != MODEL_OK)
                return status;
        }
        moved = moves_of(now, at, n, slides, x);
        if (!(moved < HUGE_VAL))
            return MODEL_NO_SOLUTION;
        if (moved <= ROUNDING * size || (moved > SLOW * before && moved <= CONVERGED * size))
            return MODEL_OK;
        if (moved > SLOW * before && !is_slow) {
            is_slow = 1; /* slopes of here from now on */
            before = HUGE_VAL;
            continue;
        }
        before = moved;
        for (i = 0; i < n; i++)
            now->sign[at[i]] += x[i];
    }
    return MODEL_NO_SOLUTION;
}

int fmu_slide_direction(Fmu *fmu)
{
    FmuNumbers *now = &fmu->now;
    double seeds[FMU_SEEDS + 1], slip[3 * FMU_SLIDES + 1], x[FMU_SLIDES + 1];
    double *seed = now->s + MODEL_S;
    int at[FMU_SLIDES + 1] = {0}, i, status;
    const int n = slid(now, at);

    if (n > 0 && now->has_slopes != 2) {
        memcpy(seeds, seed, FMU_SEEDS * sizeof(double));
        status = find_slopes(now, at, n, fmu->work);
        if (status != MODEL_OK)
            return status;
        memcpy(seed, seeds, FMU_SEEDS * sizeof(double));
    }
    status = model_tangent(now->p, now->t, now->y, now->s, fmu->work);
    if (status != MODEL_OK || n == 0)
        return status;
    model_tangent_slides(now->p, now->t, now->y, now->s, slip);
    model_tangent_p_slides(now->p, now->t, now->y, now->s, fmu->work);
    for (i = 0; i < FMU_SLIDES; i++)
        slip[i] += fmu->work[i];
    (void)moves_of(now, at, n, slip, x);
    for (i = 0; i < n; i++)
        seed[FMU_SEEDS - FMU_SLIDES + at[i]] = x[i];
    return model_tangent(now->p, now->t, now->y, now->s, fmu->work);
}

/* --- onto the surfaces --- */

double fmu_slide_drift(Fmu *fmu)
{
    const FmuNumbers *now = &fmu->now;
    double slides[3 * FMU_SLIDES + 1], most = 0;
    int at[FMU_SLIDES + 1] = {0}, i;
    const int n = slid(now, at);

    if (n == 0)
        return 0;
    model_slides(now->p, now->t, now->y, now->s, slides);
    for (i = 0; i < n; i++)
        most = fmu_larger(most, fabs(slides[FMU_SLIDES + at[i]]));
    return most / state_size(now->y);
}

/* One move along the effect of signs on the rates, as an impulse of what sticks would make it:
 * distances are linear in speeds and network states. */
FmuStatus fmu_slide_project(Fmu *fmu, int *moved)
{
    FmuNumbers *now = &fmu->now;
    double slides[3 * FMU_SLIDES + 1], column[3 * FMU_SLIDES + 1], x[FMU_SLIDES + 1] = {0};
    double way[FMU_STATES + 1], rates[MODEL_Y + 1];
    int at[FMU_SLIDES + 1] = {0}, i, k;
    const int n = slid(now, at);

    if (n == 0 || fmu_slide_drift(fmu) <= STILL / 10)
        return FMU_OK;
    now->has_slopes = 0;
    if (fmu_slide_solve(fmu) != MODEL_OK || find_slopes(now, at, n, fmu->work) != MODEL_OK)
        return fmu_fail(fmu, FMU_ERROR, "what sticks can't be kept at rest", now->y[0]);
    model_slides(now->p, now->t, now->y, now->s, slides);
    (void)moves_of(now, at, n, slides + FMU_SLIDES, x);
    memset(way, 0, sizeof way);
    for (k = 0; k < n; k++) {
        if (slope_of(now, at[k], column, fmu->work) != MODEL_OK)
            return FMU_ERROR;
        model_tangent_derivative(now->p, now->t, now->y, now->s, rates);
        model_tangent_p_derivative(now->p, now->t, now->y, now->s, fmu->work);
        for (i = 0; i < FMU_STATES; i++)
            way[i] += x[k] * (rates[i] + fmu->work[i]);
    }
    for (i = 0; i < FMU_STATES; i++)
        now->y[i] += way[i];
    now->is_solved = 0;
    *moved = 1;
    return FMU_OK;
}

/* --- sides --- */

/* what the motion stands on, and where its slip is taken */
typedef struct Standing {
    Fmu *fmu;
    int n, who[FMU_SLIDES + 1];
    SurfaceSide side[FMU_SLIDES + 1];
    double t, y[MODEL_Y + 1], p[MODEL_P + 1], s[MODEL_S + FMU_SEEDS + 1];
} Standing;

static bool slip_at(void *context, const double *signs, double *slip)
{
    Standing *c = context;
    double slides[3 * FMU_SLIDES + 1];
    int i;

    for (i = 0; i < c->n; i++)
        c->p[FMU_FIRST_SIDE + fmu_slide[c->who[i]]] = signs[i];
    model_prepare(c->p);
    if (model_solve(c->p, c->t, c->y, c->s, c->fmu->work) != MODEL_OK)
        return false;
    model_slides(c->p, c->t, c->y, c->s, slides);
    for (i = 0; i < c->n; i++)
        slip[i] = slides[c->who[i]];
    return true;
}

/* Whether the motion stands on surface k, h = `at` there with that rate; *stirs: not known before,
 * or its sign ends. A side that it only passes to is set. */
static int stands(Fmu *fmu, int k, double at, double rate, double close, SurfaceSide *side,
                  int *stirs, int *changes)
{
    FmuNumbers *now = &fmu->now;
    const int i = fmu_slide[k], is = at > 0 ? 1 : at < 0 ? -1 : now->side[i];
    const int goes = rate > 0 ? 1 : rate < 0 ? -1 : is;
    const double still = STILL * state_size(now->y);
    const int is_near = fabs(at) <= close * fabs(rate) || fabs(at) <= still;
    const int is_new = !now->has_start || fmu->has_new_values;

    side->settles = true;
    side->side = 0;
    side->ends = false;
    if (now->side[i] == 0) {
        const double left = now->bound[k] - fabs(now->sign[k]);
        const double moved = now->s[MODEL_S + FMU_SEEDS - FMU_SLIDES + k]; /* by find_rates() */

        if (fmu->has_new_values && fabs(side->off) > still) {
            side->side = side->off > 0 ? 1 : -1;
            *stirs = 1;
        } else if (fmu->is_decided[k])
            return 1;
        else if (left < 0 || (left <= close * fabs(moved) && moved * now->sign[k] > 0)) {
            side->side = now->sign[k] > 0 ? 1 : -1;
            side->ends = true;
            *stirs = 1;
        }
        return 1;
    }
    if (now->held[k])
        return 1;
    if (fmu->is_decided[k] && is_near)
        return 0;
    if (is_new && is_near) {
        *stirs = 1;
        return 1;
    }
    if ((is_near ? goes : is) == now->side[i])
        return 0;
    if (!is_new) {
        *stirs = 1;
        return 1;
    }
    now->side[i] = is;
    *changes = 1;
    return 0;
}

static void begin_search(Standing *c)
{
    const FmuNumbers *now = &c->fmu->now;

    c->t = now->t;
    memcpy(c->y, now->y, sizeof now->y);
    memcpy(c->p, now->p, sizeof now->p);
    memcpy(c->s, now->s, sizeof now->s);
}

static bool search(Standing *c, bool insists)
{
    double room[SURFACE_SIDES_ROOM(FMU_SLIDES) + 1];
    int integers[SURFACE_SIDES_INTEGERS(FMU_SLIDES) + 1];

    return surface_sides_find(c->side, c->n, slip_at, c, insists, state_size(c->fmu->now.y), room,
                              integers);
}

static bool is_as_before(const Standing *c)
{
    int i;

    for (i = 0; i < c->n; i++)
        if (c->side[i].side != c->fmu->now.side[fmu_slide[c->who[i]]])
            return false;
    return true;
}

/* Where one of several signs ends, others may end there too: what each has to hold a little later
 * tells which ones leave. */
static bool find(Standing *c)
{
    SurfaceSide given[FMU_SLIDES + 1];
    double rates[FMU_STATES + 1];
    const double ahead = AHEAD * (1 + fabs(c->fmu->now.t));
    bool ends = false;
    int i;

    memcpy(given, c->side, sizeof given);
    for (i = 0; i < c->n; i++)
        ends = ends || c->side[i].ends;
    if (ends && c->n > 1 && fmu_rates(c->fmu, rates) == FMU_OK) {
        begin_search(c);
        c->t += ahead;
        for (i = 0; i < MODEL_Q; i++)
            c->y[i] += ahead * rates[i];
        if (search(c, false) && !is_as_before(c))
            return true;
        memcpy(c->side, given, sizeof given); /* nothing is seen to change so soon */
    }
    begin_search(c);
    return search(c, true);
}

static FmuStatus refuse(const Standing *c)
{
    char line[240];

    (void)snprintf(line, sizeof line, "no motion leads on from where %.80s%s stick",
                   fmu_slide_name[c->who[0]], c->n > 1 ? " and others" : "");
    return fmu_fail(c->fmu, FMU_ERROR, line, c->fmu->now.y[0]);
}

FmuStatus fmu_slide_sides(Fmu *fmu, const double *at, const double *rate, double close,
                          int *changes, int *moved)
{
    FmuNumbers *now = &fmu->now;
    Standing c;
    double slides[3 * FMU_SLIDES + 1];
    int k, i, stirs = now->is_changed;

    c.fmu = fmu;
    c.n = 0;
    model_slides(now->p, now->t, now->y, now->s, slides);
    memcpy(now->bound, slides + (ptrdiff_t)2 * FMU_SLIDES, FMU_SLIDES * sizeof(double));
    for (k = 0; k < FMU_SLIDES; k++) {
        SurfaceSide *side = &c.side[c.n];

        i = fmu_slide[k];
        side->bound = now->bound[k];
        side->is_unilateral = false; /* what is rigid is refused by the export, */
        side->cone = 0;              /* and what has several directions */
        side->left = 1;
        side->load = -1;
        side->off = slides[FMU_SLIDES + k];
        if (stands(fmu, k, at[i], rate[i], close, side, &stirs, changes))
            c.who[c.n++] = k;
    }
    if (*changes) {
        fmu_prepare(fmu);
        return FMU_OK;
    }
    if (c.n == 0 || !stirs)
        return FMU_OK;
    if (!find(&c))
        return refuse(&c);
    for (k = 0; k < c.n; k++) {
        const SurfaceSide *side = &c.side[k];

        i = fmu_slide[c.who[k]];
        *changes |= now->side[i] != side->side || now->held[c.who[k]] != side->held;
        now->side[i] = side->side;
        now->held[c.who[k]] = side->held;
        now->sign[c.who[k]] = side->sign;
        fmu->is_decided[c.who[k]] = 1;
    }
    now->has_slopes = 0;
    fmu_prepare(fmu);
    return fmu_slide_project(fmu, moved);
}
