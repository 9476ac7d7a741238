/* impact.c: impacts on unilateral surfaces
 *
 * Unilateral surfaces h_i <= 0 that are met take part in an impact where one of them has h_i' > 0
 * (of a surface on speeds, h_i > 0). L_i is the impulse of the effort on surface i, w_i = d(u',
 * x')/d s_i what a unit of that effort adds to the rates, and M_ij = -d h_i''/d s_j. Forces of
 * finite size have no part in it.
 *
 *     compression    -h_c' = -h' + M C  >= 0,   C >= 0,     one of the two 0 in each row
 *     expansion      -h_+' = -h_c' + M E >= 0,  E >= e C,   likewise
 *     (u, x) += sum of w_i (C_i + E_i)
 *
 * Friction with such an effort as its load takes part: in both phases |C_f| <= mu C_i, and its slip
 * v ends as 0 or against an impulse of that size.
 *
 * That is Poisson's hypothesis (Glocker and Pfeiffer, Nonlinear Dynamics 7 (1995)); of one surface
 * it is Newton's, h_+' = -e h'.
 *
 * Flights between impacts on one surface shorten with e: the rest of them, of h'' = a, takes
 * 2 h_+'/(a (1 - e)) together. Where that is next to nothing they are left out. The impacts of a
 * surface that an event has are the event's, until it settles there (events_series.c). */
#include "simulate/run/impact.h"

#include "algebra/complementarity.h"
#include "algebra/linear.h"
#include "algebra/norm_complementarity.h"
#include "base/memory.h"
#include "simulate/run/series.h"

#include <math.h>
#include <string.h>

#define STILL     1e-8  /* of y: an approach that is none */
#define SOON      1e-10 /* of the run: flights as short as that in all are left out */
#define MOST_PULL 1e3   /* times the impulse that stops what leaves one surface */
#define LOW       1e-13 /* of y: or as low as that */

typedef struct Impact {
    const ImpactAt *here;
    int count;            /* surfaces that take part */
    int *place;           /* of each among those that are met */
    double *signs;        /* of those that are met */
    double *slip, *off;   /* of those that are met, at y */
    double *way, *effect; /* count x length, count x met */
    double *power;        /* of a unit of each effort */
    double *approach, *impulse, *matrix, *restitution;
    int *load;     /* of what is bounded by another one of these: its place here; -1: none */
    double *share; /* the kinetic bound, per unit of that */
    int *rows;     /* at the first component of a vector their number, 0 at its others, 1 of none */
    bool has_vectors;
} Impact;

static void impact_free(Impact *m)
{
    MEM_FREE(m->place, m->signs, m->slip, m->off, m->way, m->effect, m->power, m->approach,
             m->impulse, m->matrix, m->restitution, m->load, m->share, m->rows);
}

/* where the sign with that number is among those that take part; -1: it isn't */
static int place_among(const Impact *m, int sign)
{
    for (int k = 0; k < m->count; k++)
        if (m->place[k] == sign)
            return k;
    return -1;
}

static void place_load(Impact *m, int k, const SignRange *range)
{
    m->load[k] = place_among(m, range->load);
    m->rows[k] = range->cone == 0 ? 1 : range->cone > 0 ? range->cone : 0;
    m->has_vectors = m->has_vectors || range->cone != 0;
}

static Impact impact_new(const ImpactAt *here)
{
    const Equations *eq = compiled_equations(here->phase->numbers);
    const int met = here->count, length = here->phase->length;
    Impact m = {.here = here, .place = NEW_ARRAY(int, met)};

    for (int i = 0; i < met; i++)
        if (eq->sign_ranges[i].is_unilateral || eq->sign_ranges[i].load >= 0)
            m.place[m.count++] = i;
    m.signs = NEW_ARRAY(double, met);
    m.slip = NEW_ARRAY(double, met);
    m.off = NEW_ARRAY(double, met);
    m.way = NEW_ARRAY(double, m.count *length);
    m.effect = NEW_ARRAY(double, m.count *met);
    m.power = NEW_ARRAY(double, m.count);
    m.approach = NEW_ARRAY(double, m.count);
    m.impulse = NEW_ARRAY(double, m.count);
    m.matrix = NEW_ARRAY(double, m.count *m.count);
    m.restitution = NEW_ARRAY(double, m.count);
    for (int k = 0; k < m.count; k++)
        m.restitution[k] =
            here->at[m.place[k]].settles ? 0 : eq->sign_ranges[m.place[k]].restitution;
    m.load = NEW_ARRAY(int, m.count);
    m.share = NEW_ARRAY(double, m.count);
    m.rows = NEW_ARRAY(int, m.count);
    for (int k = 0; k < m.count; k++)
        place_load(&m, k, &eq->sign_ranges[m.place[k]]);
    return m;
}

/* The effect of each effort at y, by a difference about as large as what acts there. */
static bool find_effects(Impact *m, const double *y)
{
    const ImpactAt *here = m->here;
    const int met = here->count, length = here->phase->length;
    const double largest = fmax(1, vector_largest(m->slip, met));

    for (int k = 0; k < m->count; k++) {
        const int i = m->place[k];
        SignEffect effect = {.way = m->way + (ptrdiff_t)k * length,
                             .slip = m->effect + (ptrdiff_t)k * met};
        double own;

        if (!motion_sign_effect(here->phase->motion, here->t, y, m->signs, i, 1, &effect))
            return false;
        own = fabs(effect.slip[i]);
        if (own > 0 && !motion_sign_effect(here->phase->motion, here->t, y, m->signs, i,
                                           largest / own, &effect))
            return false;
        m->power[k] = effect.power;
        for (int j = 0; j < m->count; j++)
            m->matrix[j * m->count + k] = -effect.slip[m->place[j]];
    }
    return true;
}

/* block by block and by Newton's method */
static bool solve_by_sweeps(const Impact *m, const Complementarity *box, int *side, double *x)
{
    int *slips = NEW_ARRAY(int, box->n);
    double *room = NEW_ARRAY(double, NORM_COMPLEMENTARITY_ROOM(box->n));
    const NormComplementarity problem = {*box, m->rows, m->load, m->share, slips};
    bool found;

    memset(x, 0, (size_t)box->n * sizeof(double));
    found = norm_complementarity_solve(&problem, side, x, room);
    MEM_FREE(slips, room);
    return found;
}

/* x >= low and M x + q >= 0, one of the two 0 in each row; what has a load is within its bound */
static bool solve(const Impact *m, const double *q, const double *low, double *x)
{
    const int n = m->count;
    double *high = NEW_ARRAY(double, n), *room = NEW_ARRAY(double, LOAD_COMPLEMENTARITY_ROOM(n));
    int *side = NEW_ARRAY(int, n), *integers = NEW_ARRAY(int, LOAD_COMPLEMENTARITY_INTEGERS(n));
    const LoadComplementarity problem = {
        .box = {.n = n, .matrix = m->matrix, .q = q, .low = low, .high = high},
        .load = m->load,
        .share = m->share};
    bool found;

    for (int k = 0; k < n; k++)
        high[k] = INFINITY;
    /* with friction Lemke's method may end in a ray where there is a solution */
    found = (!m->has_vectors && load_complementarity_solve(&problem, side, x, room, integers)) ||
            solve_by_sweeps(m, &problem.box, side, x);
    MEM_FREE(high, room, side, integers);
    return found;
}

/* out = -approach + M x */
static void departures(const Impact *m, const double *approach, const double *x, double *out)
{
    for (int k = 0; k < m->count; k++) {
        out[k] = -approach[k];
        for (int j = 0; j < m->count; j++)
            out[k] += m->matrix[k * m->count + j] * x[j];
    }
}

/* 0; where the motion settles it may pull what leaves already, by far more than a surface alone
 * takes */
static double least_impulse(const Impact *m, int k)
{
    const double own = m->matrix[k * m->count + k];

    return m->here->at[m->place[k]].settles && m->approach[k] < 0 && own > 0
               ? MOST_PULL * m->approach[k] / own
               : 0;
}

/* both phases; false: there is no impulse */
static bool find_impulses(Impact *m)
{
    const int n = m->count;
    double *q = NEW_ARRAY(double, n), *low = NEW_ARRAY(double, n);
    double *compression = NEW_ARRAY(double, n);
    bool found;

    departures(m, m->approach, low, q);
    for (int k = 0; k < n; k++)
        low[k] = least_impulse(m, k);
    found = solve(m, q, low, compression);
    if (found) {
        departures(m, m->approach, compression, q);
        for (int k = 0; k < n; k++)
            low[k] = m->load[k] < 0 ? m->restitution[k] * compression[k] : 0;
        found = solve(m, q, low, m->impulse);
    }
    for (int k = 0; k < n && found; k++)
        m->impulse[k] += compression[k];
    MEM_FREE(q, low, compression);
    return found;
}

static void add_impulses(const Impact *m, const double *y, double share, double *out)
{
    const int length = m->here->phase->length;

    memcpy(out, y, (size_t)length * sizeof(double));
    for (int k = 0; k < m->count; k++)
        for (int i = 0; i < length; i++)
            out[i] += share * m->impulse[k] * m->way[(ptrdiff_t)k * length + i];
}

/* What the impulses take from the energy: the power of each effort at the mean of speeds before and
 * after. NAN: it can't be evaluated. */
static double energy_lost(Impact *m, const double *y)
{
    double *middle = NEW_ARRAY(double, m->here->phase->length);
    double lost = 0;

    add_impulses(m, y, 0.5, middle);
    if (!find_effects(m, middle))
        lost = NAN;
    for (int k = 0; k < m->count; k++)
        lost -= m->power[k] * m->impulse[k];
    mem_free(middle);
    return lost;
}

static bool read_slip(Impact *m, const double *y)
{
    return motion_drift(m->here->phase->motion, m->here->t, y, m->signs, m->slip, m->off);
}

/* Whether flights that follow on surface k are next to nothing, by what is after the impact;
 * *rest: how long they take in all. */
static bool is_next_to_nothing(const Impact *m, int k, double size, double *rest)
{
    const double e = m->restitution[k], speed = -m->off[m->place[k]];
    const double back = m->slip[m->place[k]];

    *rest = 0;
    if (!(e > 0) || !(e < 1) || !(speed > 0) || !(back > 0))
        return false;
    *rest = series_left(2 * speed / back, e);
    return *rest <= SOON * m->here->span || speed * speed / back <= LOW * size ||
           speed <= STILL * size;
}

static ImpactTally *tally_of(ImpactTallies *tallies, const ImpactAt *here, int i)
{
    SystemSurface surface = {0};
    const bool is_known = system_surface(here->phase->system, here->at[i].surface, &surface);
    const char *part =
        is_known ? system_jumping_part(here->phase->system, surface.condition) : NULL;

    if (part == NULL)
        part = "unilateral()";
    for (int k = 0; k < tallies->count; k++)
        if (strcmp(tallies->at[k].part, part) == 0)
            return &tallies->at[k];
    LIST_PUSH(*tallies, ((ImpactTally){.part = mem_text(part, strlen(part)), .rests = NAN}));
    return &tallies->at[tallies->count - 1];
}

static bool is_of_event(const Impact *m, int k)
{
    const CompiledEquations *numbers = m->here->phase->numbers;

    return compiled_equations(numbers)->sign_ranges[m->place[k]].restitution < 0;
}

static bool is_struck(const Impact *m, int k)
{
    return m->load[k] < 0 && m->impulse[k] > 0;
}

static void count_impact(const Impact *m, double lost, ImpactTallies *tallies)
{
    int taking_part = 0;

    for (int k = 0; k < m->count; k++)
        taking_part += is_struck(m, k);
    for (int k = 0; k < m->count; k++)
        if (is_struck(m, k) && !is_of_event(m, k)) {
            ImpactTally *tally = tally_of(tallies, m->here, m->place[k]);

            tally->count++;
            tally->together += taking_part > 1;
            tally->lost += lost;
        }
}

static Status no_impulse(const ImpactAt *here, const Impact *m, Diag *diag)
{
    Text names = {0};

    for (int k = 0; k < m->count; k++) {
        SystemSurface surface = {0};
        const char *part = NULL;

        if (system_surface(here->phase->system, here->at[m->place[k]].surface, &surface))
            part = system_jumping_part(here->phase->system, surface.condition);
        if (part != NULL)
            text_addf(&names, "%s%s", names.length > 0 ? ", " : "", part);
    }
    (void)diag_set(diag, E_SOLVER, "at t = %.9g s: no impulse of %s stops what meets it", here->t,
                   names.at != NULL ? names.at : "unilateral()");
    diag_hint(diag,
              "it needs inertia on both sides that no driver moves; k= makes a stop compliant");
    text_free(&names);
    return E_SOLVER;
}

static bool is_met(const Impact *m, double size)
{
    const double *bounds = motion_bounds(m->here->phase->motion);
    bool met = false;

    for (int k = 0; k < m->count; k++) {
        const double approach = m->approach[k] = m->off[m->place[k]];

        m->share[k] = bounds[2 * m->place[k]];
        met = met ||
              (m->load[k] < 0 && (approach > STILL * size ||
                                  (m->here->at[m->place[k]].settles && approach < -STILL * size)));
    }
    return met;
}

/* one impact; after it y, `slip` and `off` */
static bool strike(Impact *m, double *y, double *lost)
{
    double *after = NEW_ARRAY(double, m->here->phase->length);
    bool sound = find_effects(m, y) && find_impulses(m);

    if (sound) {
        add_impulses(m, y, 1, after);
        sound = vector_is_finite(after, m->here->phase->length) && read_slip(m, after);
    }
    if (sound) {
        *lost = energy_lost(m, y);
        memcpy(y, after, (size_t)m->here->phase->length * sizeof(double));
    }
    mem_free(after);
    return sound;
}

Status impact_take(const ImpactAt *here, double *y, ImpactTallies *tallies, bool *any, Diag *diag)
{
    const int length = here->phase->length;
    const double size = fmax(1, vector_largest(y, length - 1));
    Impact m = impact_new(here);
    double *before = NEW_ARRAY(double, length);
    double lost = 0;
    Status status = OK;

    *any = false;
    if (m.count == 0 || !read_slip(&m, y) || !is_met(&m, size))
        goto done;
    memcpy(before, y, (size_t)length * sizeof(double));
    if (!strike(&m, y, &lost))
        CHECK(no_impulse(here, &m, diag));
    for (int k = 0; k < m.count; k++) {
        double rest;

        if (is_struck(&m, k) && is_next_to_nothing(&m, k, size, &rest)) {
            tally_of(tallies, here, m.place[k])->rests = here->t + rest;
            m.restitution[k] = 0;
            *any = true;
        }
    }
    if (*any) { /* again, without what would bounce */
        memcpy(y, before, (size_t)length * sizeof(double));
        (void)read_slip(&m, y);
        (void)is_met(&m, size);
        if (!strike(&m, y, &lost))
            CHECK(no_impulse(here, &m, diag));
    }
    *any = true;
    if (isfinite(lost))
        y[length - 1] -= lost; /* the last entry is the work done */
    count_impact(&m, lost, tallies);
done:
    mem_free(before);
    impact_free(&m);
    return status;
}

void impact_tallies_report(const ImpactTallies *tallies, Remarks *out)
{
    for (int k = 0; k < tallies->count; k++)
        remarks_add(out, (Remark){.kind = REMARK_IMPACTS,
                                  .what = tallies->at[k].part,
                                  .count = tallies->at[k].count,
                                  .of = tallies->at[k].together,
                                  .size = tallies->at[k].lost,
                                  .t = tallies->at[k].rests});
}

void impact_tallies_free(ImpactTallies *tallies)
{
    for (int k = 0; k < tallies->count; k++)
        mem_free(tallies->at[k].part);
    LIST_FREE(*tallies);
}
