/* dop853_dense.c: dense output of dop853, of order 7 (Hairer, Norsett and Wanner 1993, II.6)
 *
 * Where a component decays fast, a step at the stability limit may have an accurate end and a dense
 * output that is far off in between. The defect of its slope, P'(t) - f(t, P(t)), detects that, and
 * the dense output is then composed of several shorter ones. Next to a singular position a single
 * stage may be inaccurate, and is computed from the slope. */
#include "simulate/integrate/dop853_impl.h"

#include "algebra/linear.h"
#include "base/four.h"
#include "base/memory.h"
#include "simulate/integrate/integrate_limits.h"

#include <math.h>
#include <string.h>

void dop853_reserve_room(Dop853 *d, DensePart *part)
{
    if (part->old != NULL)
        return;
    part->old = stepper_numbers(&d->base, d->room);
    for (int i = 0; i < COUNT(part->terms); i++)
        part->terms[i] = stepper_numbers(&d->base, d->room);
}

/* the stages of dense output; stage_point is the point of the last one */
static void take_extra_stages(Dop853 *d, double h)
{
    dop853_note_rounding(d);
    for (int stage = ROW_EXTRA; stage < STAGES; stage++)
        (void)dop853_set_stage(d, stage, h, d->stage_point); /* a NaN there shows in the output */
}

/* The interpolant of a step h from d->old, at base.before, to `new` (II.6.20 and the appendix),
 * with rates in k[0] and k[ROW_END], from the current stages. */
static void fill_part(Dop853 *d, double h, const double *new, DensePart *out)
{
    out->from = d->base.before;
    out->length = h;
    memcpy(out->old, d->old, (size_t)d->all * sizeof(double));
    for (int i = 0; i < d->all; i++) {
        double dy = new[i] - d->old[i];

        out->terms[0][i] = dy;
        out->terms[1][i] = h * d->k[0][i] - dy;
        out->terms[2][i] = dy - h * d->k[ROW_END][i] - out->terms[1][i];
    }
    for (int j = 0; j < DENSE_ROWS; j++) {
        const double *sum = dop853_weigh(d, ROW_DENSE + j, d->sums[0]);

        for (int i = 0; i < d->all; i++)
            out->terms[3 + j][i] = h * sum[i];
    }
}

/* the same after computing three more stages */
static void make_part(Dop853 *d, double h, const double *new, DensePart *out)
{
    dop853_reserve_room(d, out);
    take_extra_stages(d, h);
    fill_part(d, h, new, out);
}

/* y at position s (0 to 1) of this part of the last step */
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
static double interpolated_slope(const double *const terms[DENSE_TERMS], double s, int i)
{
    double sum = terms[6][i] * s, slope = terms[6][i];

    for (int j = 5; j >= 0; j--) {
        sum += terms[j][i];
        slope = j % 2 == 0 ? slope * s + sum : slope * (1 - s) - sum;
        sum *= j % 2 == 0 ? s : 1 - s;
    }
    return slope;
}

/* Defect of a part's slope from y' there, times its length: into sums[1], and returned in
 * tolerances of a step. */
static double slope_defect(Dop853 *d, const DensePart *part, double s)
{
    double *y = d->sums[0], *off = d->sums[1];

    interpolate(part, s, d->room, y);
    if (!stepper_rate(&d->base, part->from + s * part->length, y, off))
        return NAN;
    for (int i = 0; i < d->all; i++)
        off[i] =
            interpolated_slope((const double *const *)part->terms, s, i) - part->length * off[i];
    return dop853_norm(d, off);
}

/* The same for a part just computed; 0 where its last stage is close to it already, which takes no
 * evaluation. */
static double part_defect(Dop853 *d, const DensePart *part)
{
    double *y = d->sums[0], *off = d->sums[1];

    interpolate(part, dop853_nodes[STAGES - 1], d->room, y);
    for (int i = 0; i < d->n; i++)
        off[i] = y[i] - d->stage_point[i];
    if (dop853_norm(d, off) <= DENSE_NEAR * d->rounding_error)
        return 0;
    return slope_defect(d, part, DENSE_LOOK);
}

/* derivative of the slope there by the rate of a stage */
static double slope_by_stage(int stage, double s)
{
    double weight[DENSE_TERMS] = {0};
    const double *terms[DENSE_TERMS];

    for (int j = 0; j < DENSE_ROWS; j++) {
        const TableauTerms *row = &dop853_rows[ROW_DENSE + j];

        for (int k = 0; k < row->count; k++)
            if (row->at[k].stage == stage)
                weight[3 + j] = row->at[k].weight;
    }
    for (int j = 0; j < DENSE_TERMS; j++)
        terms[j] = &weight[j];
    return interpolated_slope(terms, s, 0);
}

/* Solve for the rates at the last `count` stages such that the slope is y' at as many other
 * positions; false where y' is undefined there. */
static bool set_stages(Dop853 *d, DensePart *part, int count)
{
    /* the residual there is 0.15 h J times the previous one, 0.03 for one stage */
    static const double places[STAGES - ROW_EXTRA] = {0.96, 0.57, 0.39};
    Lu *slopes = lu_new(count);
    double missed[STAGES - ROW_EXTRA] = {0};
    bool sound = true;

    for (int i = 0; i < count && sound; i++) {
        for (int j = 0; j < count; j++)
            lu_matrix(slopes)[i * count + j] = slope_by_stage(STAGES - count + j, places[i]);
        sound = isfinite(slope_defect(d, part, places[i]));
        memcpy(d->spare[i], d->sums[1], (size_t)d->all * sizeof(double));
    }
    sound = sound && lu_factor(slopes);
    for (int k = 0; k < d->all && sound; k++) {
        for (int i = 0; i < count; i++)
            missed[i] = d->spare[i][k] / part->length;
        lu_solve(slopes, missed);
        for (int i = 0; i < count; i++)
            d->k[STAGES - count + i][k] -= missed[i];
    }
    lu_free(slopes);
    if (sound)
        fill_part(d, part->length, d->base.y, part);
    return sound;
}

/* Where a stage of the dense output is next to a singular position, its distance from the
 * constraints makes its rate arbitrary, and the interpolant is inaccurate throughout. That rate and
 * those of the stages after it, which depend on it, are then computed from the slope elsewhere; one
 * further evaluation checks the result. Returns the new defect; where that is still too large the
 * part and its defect are restored. */
static double mend_stages(Dop853 *d, DensePart *part, double defect)
{
    double last = INFINITY, now = defect;
    int stage = ROW_EXTRA;

    for (int i = ROW_EXTRA; i < STAGES; i++)
        if (d->rounding[i] > d->rounding[stage])
            stage = i;
    if (!(d->rounding[stage] > DENSE_INACCURATE_STAGE))
        return defect;
    while (now > DENSE_NEAR * d->rounding_error && now < 0.5 * last &&
           set_stages(d, part, STAGES - stage)) {
        last = now;
        /* not next to that stage */
        now = slope_defect(d, part, stage < STAGES - 1 ? DENSE_LOOK : 1 - DENSE_LOOK);
    }
    if (now <= DENSE_DEFECT * d->rounding_error)
        return now;
    make_part(d, part->length, d->base.y, part);
    return defect;
}

/* distance of the end of the last part, of length h and with its current stages, from the end of
 * the step */
static double end_of_part(Dop853 *d, double h)
{
    double *off = d->sums[1];

    dop853_move(d->old, h, dop853_weigh(d, ROW_END, d->sums[0]), d->n, off);
    for (int i = 0; i < d->n; i++)
        off[i] -= d->base.y[i];
    return dop853_norm(d, off);
}

/* The last step's dense output in so many parts, from `old` and k[0] at its start. Returns the
 * largest defect among them, NaN where y' is undefined. */
static double divide(Dop853 *d, int parts)
{
    const double before = d->base.before;
    double *new = d->sums[2], worst = 0;

    for (int p = 0; p < parts; p++) {
        const double h = (p + 1) * d->step / parts - p * d->step / parts;
        const bool is_last = p == parts - 1;
        double defect;

        d->base.before = before + p * d->step / parts;
        if (!dop853_set_stages(d, h))
            return NAN;
        if (is_last) {
            memcpy(new, d->base.y, (size_t)d->all * sizeof(double));
            memcpy(d->k[ROW_END], d->spare[2], (size_t)d->all * sizeof(double));
            d->parted = end_of_part(d, h);
        } else {
            dop853_move(d->old, h, dop853_weigh(d, ROW_END, d->sums[0]), d->all, new);
            if (!stepper_rate(&d->base, d->base.before + h, new, d->k[ROW_END]))
                return NAN;
        }
        make_part(d, h, new, &d->dense[p]);
        defect = part_defect(d, &d->dense[p]);
        if (!(defect <= worst))
            worst = defect;
        memcpy(d->old, new, (size_t)d->all * sizeof(double));
        memcpy(d->k[0], d->k[ROW_END], (size_t)d->all * sizeof(double));
    }
    return worst;
}

/* The same; the data of the step are restored. */
static double divide_step(Dop853 *d, int parts)
{
    const size_t size = (size_t)d->all * sizeof(double);
    const double before = d->base.before;
    double worst;

    memcpy(d->spare[0], d->old, size);
    memcpy(d->spare[1], d->k[0], size);
    memcpy(d->spare[2], d->k[ROW_END], size);
    worst = divide(d, parts);
    memcpy(d->old, d->spare[0], size);
    memcpy(d->k[0], d->spare[1], size);
    memcpy(d->k[ROW_END], d->spare[2], size);
    d->base.before = before;
    return worst;
}

/* the last step's dense output in one part, from its own stages */
static void take_whole(Dop853 *d)
{
    d->parts = 1;
    d->parted = 0;
    (void)dop853_set_stages(d, d->step); /* as in the step */
    make_part(d, d->step, d->base.y, &d->dense[0]);
}

/* Shorter parts may be worse: their ends are not projected, and where one comes near a singular
 * position, y' there is useless. They are no better where the defect is rounding error; but where
 * half a step is still far beyond the stability limit, only the next division is better. The number
 * of parts with the least defect is used. */
void dop853_make_dense(Dop853 *d)
{
    double least;
    int best = 1, missed = 0;

    d->parts = 1;
    d->parted = 0;
    make_part(d, d->step, d->base.y, &d->dense[0]);
    least = part_defect(d, &d->dense[0]);
    if (least > DENSE_DEFECT * d->rounding_error)
        least = mend_stages(d, &d->dense[0], least);
    while (least > DENSE_DEFECT * d->rounding_error && missed < DENSE_MISSED &&
           d->parts < DENSE_PARTS) {
        double worst;

        d->parts *= 2;
        worst = divide_step(d, d->parts);
        missed = worst < 0.5 * least ? 0 : missed + 1;
        if (worst < least) {
            least = worst;
            best = d->parts;
        }
    }
    if (d->parts == best)
        return;
    d->parts = best;
    if (best == 1 || isnan(divide_step(d, best)))
        take_whole(d);
}

void dop853_interpolate(const Dop853 *d, double t, double *y)
{
    const int p = (int)((t - d->base.before) / d->step * d->parts);
    const DensePart *part = &d->dense[p < 0 ? 0 : p >= d->parts ? d->parts - 1 : p];

    interpolate(part, (t - part->from) / part->length, d->room, d->sums[0]);
    memcpy(y, d->sums[0], (size_t)d->all * sizeof(double));
}
