/* dop853_dense.c: dense output of dop853, of order 7 (Hairer, Norsett and Wanner 1993, II.6)
 *
 * Where something decays fast, a step at the bound of stability may end well and have a dense
 * output that is far off in between; whether it is so is asked of its slope, and then it is made of
 * several shorter ones. */
#include "simulate/integrate/dop853_impl.h"

#include "base/four.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define DENSE_NEAR   10.0  /* from a stage to the dense output, in errors that a step aims at, */
#define DENSE_DEFECT 100.0 /* h times what its slope is off: its error is some 15 times less */
#define DENSE_LOOK   0.71  /* where in a step that is */

void dop853_take_room(Dop853 *d, DensePart *part)
{
    if (part->old != NULL)
        return;
    part->old = stepper_numbers(&d->base, d->room);
    for (int i = 0; i < COUNT(part->terms); i++)
        part->terms[i] = stepper_numbers(&d->base, d->room);
}

/* The interpolant of a step of h from d->old, at base.before, to `new` (II.6.20 and the appendix),
 * with rates in k[0] and k[ROW_END]: three more stages, of which stage_point keeps the last one's.
 */
static void make_part(Dop853 *d, double h, const double *new, DensePart *out)
{
    dop853_take_room(d, out);
    for (int stage = ROW_END + 1; stage < STAGES; stage++)
        (void)dop853_take_stage(d, stage, h, d->stage_point); /* NaN there shows in what is read */
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

    interpolate(part, dop853_nodes[STAGES - 1], d->room, y);
    for (int i = 0; i < d->n; i++)
        off[i] = y[i] - d->stage_point[i];
    if (dop853_norm(d, off) <= DENSE_NEAR * d->blur)
        return 0;
    interpolate(part, DENSE_LOOK, d->room, y);
    if (!stepper_rate(&d->base, part->from + DENSE_LOOK * part->length, y, off))
        return NAN;
    for (int i = 0; i < d->n; i++)
        off[i] = interpolated_slope(part, DENSE_LOOK, i) - part->length * off[i];
    return dop853_norm(d, off);
}

/* how far from the last step's end its last part ends, of h and with its stages as they are */
static double end_of_part(Dop853 *d, double h)
{
    double *off = d->sums[1];

    dop853_move(d->old, h, dop853_weigh(d, ROW_END, d->sums[0]), d->n, off);
    for (int i = 0; i < d->n; i++)
        off[i] -= d->base.y[i];
    return dop853_norm(d, off);
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
        if (!dop853_take_stages(d, h))
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

/* The same, with all that tells of the step as it was before. */
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

/* the last step's in one part, from the stages as it was taken */
static void take_whole(Dop853 *d)
{
    d->parts = 1;
    d->parted = 0;
    (void)dop853_take_stages(d, d->step); /* as they were */
    make_part(d, d->step, d->base.y, &d->dense[0]);
}

/* Dense output of the last step, on demand. Shorter parts may be worse: their ends are on no
 * constraint, and where one comes near a singular position, y' there is of no use. Then it is made
 * of as many as did best. */
void dop853_make_dense(Dop853 *d)
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

void dop853_interpolate(const Dop853 *d, double t, double *y)
{
    const int p = (int)((t - d->base.before) / d->step * d->parts);
    const DensePart *part = &d->dense[p < 0 ? 0 : p >= d->parts ? d->parts - 1 : p];

    interpolate(part, (t - part->from) / part->length, d->room, d->sums[0]);
    memcpy(y, d->sums[0], (size_t)d->all * sizeof(double));
}
