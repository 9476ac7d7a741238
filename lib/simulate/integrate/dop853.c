/* dop853.c: explicit Runge-Kutta of order 8 with error control and dense output of order 7
 *
 * Dormand and Prince's pair as given by Hairer, Norsett and Wanner (1993), II.5 and II.10. A
 * projection after each accepted step comes before the first stage of the next, so it costs no
 * evaluation; the dense output ends at the projected point. Where something decays fast, a step at
 * the bound of stability may end well and have a dense output that is far off in between; whether
 * it is so is asked of its slope, and then it is made of several shorter ones. The stiffness
 * indicator is theirs too (Solving ODE II, IV.2): h |f(a) - f(b)| / |a - b| over the two points at
 * the end of a step stays above 6.1 when stability, not accuracy, limits the steps. Whether what
 * limits them decays or swings is asked of the Jacobian: backward differentiation is no help
 * against swinging. */
#include "simulate/integrate/dop853_table.h"
#include "simulate/integrate/ode.h"

#include "base/four.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define STAGES         16
#define FIRST_SEEN     5 /* stage with a weight in the result: those before, but 0, have none */
#define AIM            0.1 /* of the tolerance, a step: some hundred of them then add up to about it */
#define SAFETY         0.9
#define LUCK           60.0 /* times the root of the tolerance; estimates of order 3: 1 to 60 of it */
#define STEEP_LUCK     2.0 /* the same where an element may cease to conduct within the step */
#define SHRINK         (1 / 3.0)
#define GROW           6.0
#define STIFF_BOUNDARY 6.1
#define STIFF_COUNT    15
#define CALM_COUNT     6
#define DIFFERENCE     1e-7  /* of y, for a derivative */
#define DENSE_NEAR     10.0  /* from a stage to the dense output, in errors that a step aims at, */
#define DENSE_DEFECT   100.0 /* h times what its slope is off: its error is some 15 times less */
#define DENSE_LOOK     0.71  /* where in a step that is */
#define PARTS_AGREE    30.0  /* errors that a step aims at, from its end to that of its parts */

enum {
    TOGETHER = 8,    /* entries that are summed together: two Fours; */
    MOST_FOURS = 8,  /* or so many where there are */
    DENSE_PARTS = 16 /* at most, of a step whose dense output is made of several */
};

/* y over a part of a step, along a polynomial */
typedef struct DensePart {
    double from, length; /* s */
    double *old;
    double *terms[7];
} DensePart;

typedef struct Dop853 {
    Stepper base;
    int n, all; /* in the error test; with quadratures */
    int room; /* of k, sums, old and dense output: all, and what fills a multiple of TOGETHER, which
               * is 0
               */
    double *k[STAGES], *sums[3];
    double *old, *new, *stage_point, *scale;
    DensePart dense[DENSE_PARTS]; /* room for each is taken when it is first needed */
    double *spare[3];             /* where a part begins, its rate there and at its end */
    int parts;                    /* of the last step; 0: dense output isn't there yet */
    double parted;                /* errors that it aims at, from its end to that of its parts */
    double step;                  /* of the last step, */
    double blur;                  /* and what rounding makes of its tolerance */
    bool was_rejected;
    int stiff, calm; /* steps above and below the boundary */
} Dop853;

typedef struct Terms {
    const TableauEntry *at;
    int count;
} Terms;

/* clang-format off */
static const Terms stages[STAGES] = {
    {NULL, 0},
#define STAGE(i) {stage##i, COUNT(stage##i)}
    STAGE(1), STAGE(2), STAGE(3), STAGE(4), STAGE(5), STAGE(6), STAGE(7), STAGE(8),
    STAGE(9), STAGE(10), STAGE(11), STAGE(12), STAGE(13), STAGE(14), STAGE(15),
#undef STAGE
};
static const Terms dense_rows[4] = {
    {dense3, COUNT(dense3)}, {dense4, COUNT(dense4)}, {dense5, COUNT(dense5)},
    {dense6, COUNT(dense6)},
};
/* clang-format on */

/* Of `fours` Fours from `first` on: the weighted sums of stages, in the order of their terms
 * whatever stands beside. What a term takes beside its products, all of them share. */
static inline __attribute__((always_inline)) void weigh_fours(const Dop853 *d, const Terms *terms,
                                                              int first, int fours, double *sums)
{
    Four sum[MOST_FOURS] = {{0}};

    for (int j = 0; j < terms->count; j++) {
        const double weight = terms->at[j].weight;
        const Four *k = (const Four *)(d->k[terms->at[j].stage] + first);

#pragma GCC unroll 8
        for (int i = 0; i < fours; i++)
            sum[i] += weight * k[i];
    }
#pragma GCC unroll 8
    for (int i = 0; i < fours; i++)
        *(Four *)(sums + first + 4 * (ptrdiff_t)i) = sum[i];
}

AS_WIDE_AS_CAN_BE static const double *weigh(const Dop853 *d, const Terms *terms, double *sums)
{
    int first = 0;

    for (; first + 4 * MOST_FOURS <= d->room; first += 4 * MOST_FOURS)
        weigh_fours(d, terms, first, MOST_FOURS, sums);
    for (; first < d->room; first += TOGETHER)
        weigh_fours(d, terms, first, TOGETHER / 4, sums);
    return sums;
}

/* out = old + h sum */
AS_WIDE_AS_CAN_BE static void move(const double *old, double h, const double *sum, int count,
                                   double *out)
{
    int i = 0;

    for (; i + 4 <= count; i += 4)
        *(Four *)(out + i) = *(const Four *)(old + i) + h * *(const Four *)(sum + i);
    for (; i < count; i++)
        out[i] = old[i] + h * sum[i];
}

/* k[stage] from the stages before it; false where f is undefined */
static bool take_stage(Dop853 *d, int stage, double h, double *point)
{
    move(d->old, h, weigh(d, &stages[stage], d->sums[0]), d->all, point);
    return stepper_rate(&d->base, d->base.before + nodes[stage] * h, point, d->k[stage]);
}

static double scaled_norm(const Dop853 *d, const double *v)
{
    double sum = 0;

    for (int i = 0; i < d->n; i++)
        sum += v[i] / d->scale[i] * (v[i] / d->scale[i]);
    return sqrt(sum / (d->n > 0 ? d->n : 1));
}

/* The same for the first entries, four at a time, where units are 1 and caps are there; how many.
 */
AS_WIDE_AS_CAN_BE static int choose_many_scales(Dop853 *d, const double *a, const double *b)
{
    const FourTruths size = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX}; /* all but the sign */
    const double *cap = d->base.ode->cap;
    int i = 0;

    for (; i + 4 <= d->n; i += 4) {
        const FourTruths one = (FourTruths)(*(const Four *)(a + i)) & size;
        const FourTruths other = (FourTruths)(*(const Four *)(b + i)) & size;
        const Four most = *(const Four *)(cap + i);
        const FourTruths second = (Four)other > (Four)one;
        const Four larger = (Four)((other & second) | (one & ~second));
        const FourTruths within = larger < most;
        const Four capped = (Four)(((FourTruths)larger & within) | ((FourTruths)most & ~within));

        *(Four *)(d->scale + i) = AIM * (d->base.control.atol + d->base.control.rtol * capped);
    }
    return i;
}

static void choose_scale(Dop853 *d, const double *a, const double *b)
{
    const Ode *ode = d->base.ode;
    const double *slack = ode->slack;
    const bool is_plain = slack == NULL && ode->unit == NULL && ode->cap != NULL;

    for (int i = is_plain ? choose_many_scales(d, a, b) : 0; i < d->n; i++) {
        d->scale[i] = AIM * stepper_tolerance(&d->base, i, fmax(fabs(a[i]), fabs(b[i])));
        if (slack != NULL)
            d->scale[i] = fmax(d->scale[i], slack[i]);
    }
}

/* the same on every machine, as roots are and powers are not */
static double eighth_root(double x)
{
    return sqrt(sqrt(sqrt(x)));
}

/* A first step: the one whose explicit Euler result, compared with f there, promises an error
 * of a hundredth (Hairer, Norsett, Wanner 1993, II.4). */
static double first_step(Dop853 *d, double t, double span)
{
    double size, slope, bend, h, h2;

    choose_scale(d, d->base.y, d->base.y);
    size = scaled_norm(d, d->base.y);
    slope = scaled_norm(d, d->k[0]);
    /* what is next to nothing needn't stay so: within the tolerance it may change at once */
    h = size < 1e-5 || slope < 1e-5 ? 1e-6 : 0.01 * fmax(size, 1) / slope;
    h = fmin(h, span);
    for (int i = 0; i < d->all; i++)
        d->stage_point[i] = d->base.y[i] + h * d->k[0][i];
    if (!stepper_rate(&d->base, t + h, d->stage_point, d->k[1]))
        return 1e-3 * h;
    for (int i = 0; i < d->n; i++)
        d->k[2][i] = d->k[1][i] - d->k[0][i];
    bend = scaled_norm(d, d->k[2]) / h;
    h2 = fmax(slope, bend) <= 1e-15 ? fmax(1e-6, h * 1e-3) : eighth_root(0.01 / fmax(slope, bend));
    return fmin(fmin(100 * h, h2), span);
}

/* Error of the step just tried, in units of the tolerance (their equation II.10.17). The estimate
 * of order 5 may vanish by chance where a pulse falls between the stages. Where steps resolve what
 * they cross, the estimate of order 3 falls like the root of the tolerance. */
static double step_error(Dop853 *d, double h)
{
    static const Terms five = {error5, COUNT(error5)}, three = {third, COUNT(third)};
    const double *fifth = weigh(d, &five, d->sums[0]), *eighth = d->sums[1]; /* of try_step() */
    const double *of_third = weigh(d, &three, d->sums[2]);
    double sum5 = 0, sum3 = 0, under, third_order;

    choose_scale(d, d->old, d->new);
    for (int i = 0; i < d->n; i++) {
        double e5 = fifth[i] / d->scale[i];
        double e3 = (eighth[i] - of_third[i]) / d->scale[i];

        sum5 += e5 * e5;
        sum3 += e3 * e3;
    }
    under = sum5 + 0.01 * sum3;
    if (!(under > 0))
        return under;
    h = fabs(h);
    third_order =
        h * sqrt(sum3 / d->n * d->base.control.rtol) / (d->base.may_bend ? STEEP_LUCK : LUCK);
    d->blur = stepper_blur(&d->base);
    return fmax(h * sum5 / sqrt(under * d->n) / d->blur, third_order * third_order);
}

/* J w by a difference along w, J the Jacobian at the new point */
static bool apply_jacobian(Dop853 *d, const double *w, double *out)
{
    double size = scaled_norm(d, w);
    double step = fmax(1, DIFFERENCE / (AIM * d->base.control.rtol)) / size;

    if (!(size > 0) || !isfinite(step))
        return false;
    for (int i = 0; i < d->all; i++)
        d->stage_point[i] = d->base.y[i] + (i < d->n ? step * w[i] : 0);
    if (!stepper_rate(&d->base, d->base.t, d->stage_point, out))
        return false;
    for (int i = 0; i < d->n; i++)
        out[i] = (out[i] - d->k[12][i]) / step;
    return true;
}

static double scaled_product(const Dop853 *d, const double *v, const double *w)
{
    double sum = 0;

    for (int i = 0; i < d->n; i++)
        sum += v[i] / d->scale[i] * (w[i] / d->scale[i]);
    return sum;
}

/* Whether the fastest part of the motion swings, rather than decays: J^(k+2) w = a J^(k+1) w + b
 * J^k w for k = 0, 1 by least squares, w what is left of a difference after two products with J.
 * The roots of x^2 = a x + b are its eigenvalues; swinging ones are further from the real axis than
 * from the imaginary one. */
static bool swings(Dop853 *d)
{
    /* free until asked for */
    double **terms = d->dense[0].terms, *w[] = {terms[0], terms[1], terms[2], terms[3]};
    double p[4][4], power[4] = {1};
    double rate, a, b, d11, d12, d22, r1, r2, det;

    for (int i = 0; i < d->n; i++)
        w[0][i] = d->base.y[i] - d->stage_point[i];
    if (!apply_jacobian(d, w[0], w[1]) || !apply_jacobian(d, w[1], w[0]))
        return false;
    for (int k = 0; k < 3; k++)
        if (!apply_jacobian(d, w[k], w[k + 1]))
            return false;
    rate = scaled_norm(d, w[1]) / scaled_norm(d, w[0]);
    for (int k = 1; k < 4; k++)
        power[k] = power[k - 1] * rate;
    for (int j = 0; j < 4; j++)
        for (int k = 0; k < 4; k++)
            p[j][k] = scaled_product(d, w[j], w[k]) / (power[j] * power[k]);
    /* a trace more on the diagonal: w may be a multiple of J w */
    d12 = p[0][1] + p[1][2];
    d11 = (p[1][1] + p[2][2]) * (1 + 1e-6);
    d22 = (p[0][0] + p[1][1]) * (1 + 1e-6);
    r1 = p[1][2] + p[2][3];
    r2 = p[0][2] + p[1][3];
    det = d11 * d22 - d12 * d12;
    a = (r1 * d22 - r2 * d12) / det;
    b = (d11 * r2 - d12 * r1) / det;
    return 0.25 * a * a + b < 0 && a * a < -2 * b;
}

static void watch_stiffness(Dop853 *d, double h)
{
    double rates = 0, points = 0;

    for (int i = 0; i < d->n; i++) {
        double dk = d->k[12][i] - d->k[11][i];
        double dy = d->base.y[i] - d->stage_point[i];

        rates += dk * dk;
        points += dy * dy;
    }
    if (points > 0 && h * sqrt(rates / points) > STIFF_BOUNDARY) {
        d->calm = 0;
        if (++d->stiff >= STIFF_COUNT) {
            d->base.is_stiff = true;
            d->base.swings = swings(d);
            d->stiff = 0;
        }
    } else if (++d->calm >= CALM_COUNT) {
        d->stiff = 0;
    }
}

/* Stages 1 to 11 and the new point, from d->old at base.before. `stage_point` keeps that of stage
 * 11. */
static bool try_step(Dop853 *d, double h)
{
    stepper_begin(&d->base, d->base.before, d->old, h);
    for (int stage = 1; stage < 12; stage++)
        if (!take_stage(d, stage, h, d->stage_point))
            return false;
    move(d->old, h, weigh(d, &stages[12], d->sums[1]), d->all, d->new);
    return true;
}

/* the new point at t: on the manifold, with its rate in k[12] */
static bool settle(Dop853 *d, double t, double h)
{
    const Ode *ode = d->base.ode;

    if (ode->project != NULL && !ode->project(ode->context, t, d->new))
        return false;
    if (!stepper_rate(&d->base, t, d->new, d->k[12]))
        return false;
    d->base.t = t;
    d->step = h;
    d->parts = 0;
    memcpy(d->base.y, d->new, (size_t)d->all * sizeof(double));
    return true;
}

static void take_room(Dop853 *d, DensePart *part)
{
    if (part->old != NULL)
        return;
    part->old = stepper_numbers(&d->base, d->room);
    for (int i = 0; i < COUNT(part->terms); i++)
        part->terms[i] = stepper_numbers(&d->base, d->room);
}

static Stepper *create(const Ode *ode, const Control *control)
{
    Dop853 *d = NEW(Dop853);

    stepper_init(&d->base, &method_dop853, ode, control);
    d->n = ode->n;
    d->all = stepper_length(&d->base);
    d->room = (d->all + TOGETHER - 1) / TOGETHER * TOGETHER;
    for (int i = 0; i < STAGES; i++)
        d->k[i] = stepper_numbers(&d->base, d->room);
    for (int i = 0; i < COUNT(d->sums); i++)
        d->sums[i] = stepper_numbers(&d->base, d->room);
    for (int i = 0; i < COUNT(d->spare); i++)
        d->spare[i] = stepper_numbers(&d->base, d->room);
    take_room(d, &d->dense[0]);
    d->blur = 1;
    d->old = stepper_numbers(&d->base, d->room);
    d->new = stepper_numbers(&d->base, d->all);
    d->stage_point = stepper_numbers(&d->base, d->all);
    d->scale = stepper_numbers(&d->base, d->all);
    return &d->base;
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Dop853 *d = (Dop853 *)stepper;

    d->was_rejected = false;
    d->parts = 0;
    d->step = 0;
    return stepper_start(stepper, t, y, d->k[12], diag);
}

/* the step to try next, trimmed so that `end` is met and no sliver is left before it */
static double trim(const Dop853 *d, double h, double end)
{
    double left = end - d->base.before;

    h = stepper_allowed(&d->base, fmin(h, control_asked(&d->base.control)));
    if (h >= left || left - h < 1e-10 * h)
        return left;
    return h > 0.5 * left ? 0.5 * left : h;
}

/* The interpolant of a step of h from d->old, at base.before, to `new` (II.6.20 and the appendix),
 * with rates in k[0] and k[12]: three more stages, of which stage_point keeps the last one's. */
static void make_part(Dop853 *d, double h, const double *new, DensePart *out)
{
    take_room(d, out);
    for (int stage = 13; stage < STAGES; stage++)
        (void)take_stage(d, stage, h, d->stage_point); /* NaN there shows in what is read */
    out->from = d->base.before;
    out->length = h;
    memcpy(out->old, d->old, (size_t)d->all * sizeof(double));
    for (int i = 0; i < d->all; i++) {
        double dy = new[i] - d->old[i];

        out->terms[0][i] = dy;
        out->terms[1][i] = h * d->k[0][i] - dy;
        out->terms[2][i] = dy - h * d->k[12][i] - out->terms[1][i];
    }
    for (int j = 0; j < 4; j++) {
        const double *sum = weigh(d, &dense_rows[j], d->sums[0]);

        for (int i = 0; i < d->all; i++)
            out->terms[3 + j][i] = h * sum[i];
    }
}

/* at this part of a part of the last step */
AS_WIDE_AS_CAN_BE static void interpolate(const DensePart *part, double s, int room, double *out)
{
    const double left = 1 - s;

    for (int first = 0; first < room; first += 4) {
        Four sum = *(const Four *)(part->terms[6] + first) * s;

        for (int j = 5; j >= 0; j--)
            sum = (sum + *(const Four *)(part->terms[j] + first)) * (j % 2 == 0 ? s : left);
        *(Four *)(out + first) = *(const Four *)(part->old + first) + sum;
    }
}

/* length times the slope there, of one entry */
static double interpolated_slope(const DensePart *part, double s, int i)
{
    double sum = part->terms[6][i] * s, slope = part->terms[6][i];

    for (int j = 5; j >= 0; j--) {
        sum += part->terms[j][i];
        slope = j % 2 == 0 ? slope * s + sum : slope * (1 - s) - sum;
        sum *= j % 2 == 0 ? s : 1 - s;
    }
    return slope;
}

/* How far from y' the slope of a part just made is, times its length, in errors that a step aims
 * at; 0 where its last stage is near it already, which costs no evaluation to see. */
static double part_defect(Dop853 *d, const DensePart *part)
{
    double *y = d->sums[0], *off = d->sums[1];

    interpolate(part, nodes[STAGES - 1], d->room, y);
    for (int i = 0; i < d->n; i++)
        off[i] = y[i] - d->stage_point[i];
    if (scaled_norm(d, off) <= DENSE_NEAR * d->blur)
        return 0;
    interpolate(part, DENSE_LOOK, d->room, y);
    if (!stepper_rate(&d->base, part->from + DENSE_LOOK * part->length, y, off))
        return NAN;
    for (int i = 0; i < d->n; i++)
        off[i] = interpolated_slope(part, DENSE_LOOK, i) - part->length * off[i];
    return scaled_norm(d, off);
}

/* how far from the last step's end its last part ends, of h and with its stages as they are */
static double end_of_part(Dop853 *d, double h)
{
    double *off = d->sums[1];

    move(d->old, h, weigh(d, &stages[12], d->sums[0]), d->n, off);
    for (int i = 0; i < d->n; i++)
        off[i] -= d->base.y[i];
    return scaled_norm(d, off);
}

/* The last step's dense output from its beginning on, where old and k[0] tell of it, in so many
 * parts; the largest defect among them, NaN where y' has no value on the way. */
static double divide(Dop853 *d, int parts)
{
    const double before = d->base.before;
    double *new = d->sums[2], worst = 0;

    for (int p = 0; p < parts; p++) {
        const double h = (p + 1) * d->step / parts - p * d->step / parts;
        const bool is_last = p == parts - 1;
        double defect;

        d->base.before = before + p * d->step / parts;
        for (int stage = 1; stage < 12; stage++)
            if (!take_stage(d, stage, h, d->stage_point))
                return NAN;
        if (is_last) {
            memcpy(new, d->base.y, (size_t)d->all * sizeof(double));
            memcpy(d->k[12], d->spare[2], (size_t)d->all * sizeof(double));
            d->parted = end_of_part(d, h);
        } else {
            move(d->old, h, weigh(d, &stages[12], d->sums[0]), d->all, new);
            if (!stepper_rate(&d->base, d->base.before + h, new, d->k[12]))
                return NAN;
        }
        make_part(d, h, new, &d->dense[p]);
        defect = part_defect(d, &d->dense[p]);
        if (!(defect <= worst))
            worst = defect;
        memcpy(d->old, new, (size_t)d->all * sizeof(double));
        memcpy(d->k[0], d->k[12], (size_t)d->all * sizeof(double));
    }
    return worst;
}

/* The same, with all that tells of the step as it was before. */
static double divide_step(Dop853 *d, int parts)
{
    const size_t size = (size_t)d->all * sizeof(double);
    const double before = d->base.before;
    double worst;

    memcpy(d->spare[0], d->old, size);
    memcpy(d->spare[1], d->k[0], size);
    memcpy(d->spare[2], d->k[12], size);
    worst = divide(d, parts);
    memcpy(d->old, d->spare[0], size);
    memcpy(d->k[0], d->spare[1], size);
    memcpy(d->k[12], d->spare[2], size);
    d->base.before = before;
    return worst;
}

/* the last step's in one part, from the stages as it was taken */
static void take_whole(Dop853 *d)
{
    d->parts = 1;
    d->parted = 0;
    for (int stage = 1; stage < 12; stage++)
        (void)take_stage(d, stage, d->step, d->stage_point);
    make_part(d, d->step, d->base.y, &d->dense[0]);
}

/* Dense output of the last step, on demand. Shorter parts may be worse: their ends are on no
 * constraint, and where one comes near a singular position, y' there is of no use. Then it is made
 * of as many as did best. */
static void make_dense(Dop853 *d)
{
    double worst, last = HUGE_VAL;

    d->parts = 1;
    d->parted = 0;
    make_part(d, d->step, d->base.y, &d->dense[0]);
    worst = part_defect(d, &d->dense[0]);
    /* shorter parts are no better where rounding is what is seen */
    while (worst > DENSE_DEFECT * d->blur && worst < 0.5 * last && d->parts < DENSE_PARTS) {
        last = worst;
        d->parts *= 2;
        worst = divide_step(d, d->parts);
    }
    if (worst <= last || d->parts == 1)
        return;
    d->parts /= 2;
    if (d->parts == 1 || isnan(divide_step(d, d->parts)))
        take_whole(d);
}

/* back to where the last step began */
static void take_back(Dop853 *d)
{
    d->base.t = d->base.before;
    memcpy(d->base.y, d->old, (size_t)d->all * sizeof(double));
    memcpy(d->k[12], d->k[0], (size_t)d->all * sizeof(double));
    d->step = 0;
}

/* Whether the step just taken is what its parts are, where it is read anyway. One that passes over
 * a corner, as a wall that is met and left within it, has an estimate of its error that means
 * nothing and may be small by chance: taken in parts it ends elsewhere. */
static bool parts_agree(Dop853 *d)
{
    const int stiff = d->stiff, calm = d->calm;
    const bool is_stiff = d->base.is_stiff;

    watch_stiffness(d, d->step);
    if (!d->base.is_read)
        return true;
    make_dense(d);
    if (!(d->parted > PARTS_AGREE * d->blur))
        return true;
    d->stiff = stiff;
    d->calm = calm;
    d->base.is_stiff = is_stiff;
    take_back(d);
    return false;
}

static Status step(Stepper *stepper, double end, Diag *diag)
{
    Dop853 *d = (Dop853 *)stepper;
    int failures = 0;
    double h;

    memcpy(d->old, d->base.y, (size_t)d->all * sizeof(double));
    memcpy(d->k[0], d->k[12], (size_t)d->all * sizeof(double));
    d->base.before = d->base.t;
    h = d->base.next > 0 ? d->base.next : first_step(d, d->base.t, end - d->base.t);
    for (;;) {
        double tried = trim(d, h, end);
        double t = tried == end - d->base.before ? end : d->base.before + tried;
        bool sound, accepted = false;
        double error = NAN;

        if (!(tried > 4e-16 * fabs(t)))
            return solver_failure(diag, d->base.before, "the step became too small");
        sound = try_step(d, tried);
        if (sound)
            error = step_error(d, tried);
        sound = sound && isfinite(error);
        if (sound && error <= 1) {
            accepted = settle(d, t, tried);
            sound = accepted;
        }
        if (accepted && !parts_agree(d)) {
            accepted = false;
            error = HUGE_VAL;
        }
        if (accepted) {
            double factor = error > 0 ? SAFETY / eighth_root(error) : GROW;

            factor = fmin(d->was_rejected ? 1 : GROW, fmax(SHRINK, factor));
            /* a step cut to meet `end` says nothing against the longer one */
            d->base.next =
                fmax(tried * factor, tried < h && error <= 1 ? fmin(h, tried * GROW) : 0);
            d->was_rejected = false;
            d->base.counts.steps++;
            return OK;
        }
        d->base.counts.rejected++;
        d->was_rejected = true;
        if (!sound && ++failures >= MAX_REJECTIONS)
            return solver_failure(diag, d->base.before,
                                  "the equations have no solution just behind this instant (ten "
                                  "ever shorter steps failed)");
        h = sound ? tried * fmax(SHRINK, SAFETY / eighth_root(error)) : RETREAT * tried;
    }
}

static void at(Stepper *stepper, double t, double *y)
{
    Dop853 *d = (Dop853 *)stepper;
    const DensePart *part;
    int p;

    if (d->step == 0 || t == d->base.t) {
        memcpy(y, d->base.y, (size_t)d->all * sizeof(double));
        return;
    }
    if (d->parts == 0)
        make_dense(d);
    p = (int)((t - d->base.before) / d->step * d->parts);
    part = &d->dense[p < 0 ? 0 : p >= d->parts ? d->parts - 1 : p];
    interpolate(part, (t - part->from) / part->length, d->room, d->sums[0]);
    memcpy(y, d->sums[0], (size_t)d->all * sizeof(double));
}

static Status shorten(Stepper *stepper, double t, Diag *diag)
{
    Dop853 *d = (Dop853 *)stepper;
    double h = t - d->base.before;

    if (h <= 0) {
        take_back(d);
        return OK;
    }
    if (d->step != 0 && d->parts == 0)
        make_dense(d); /* while there are its stages */
    if (!try_step(d, h) || !settle(d, t, h))
        return solver_failure(diag, t, "the equations have no solution at a switch");
    d->base.next = h;
    return OK;
}

static bool slope(Stepper *stepper, double *rate)
{
    const Dop853 *d = (const Dop853 *)stepper;

    memcpy(rate, d->k[12], (size_t)d->all * sizeof(double));
    return true;
}

const Method method_dop853 = {
    .name = "dop853",
    .brief = "explicit Runge-Kutta 8(5,3), Dormand and Prince; projects after each step",
    .create = create,
    .destroy = stepper_free,
    .start = start,
    .step = step,
    .at = at,
    .shorten = shorten,
    .slope = slope,
    .nodes = nodes + FIRST_SEEN,
    .node_count = 12 - FIRST_SEEN,
    .pulse_steps = 3,
};
