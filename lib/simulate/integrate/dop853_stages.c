/* dop853_stages.c: stages of dop853, and weighted sums of them, eight entries at a time and more
 *
 * Most of the cost of a step besides the evaluations. */
#include "simulate/integrate/dop853_impl.h"

#include "base/four.h"

#include <math.h>
#include <string.h>

enum { MOST_FOURS = 8 }; /* that are summed together, where there are so many entries */

/* For `fours` Fours from `first` on: the weighted sums of stages, in the order of their terms,
 * independent of neighbouring entries. The Fours share the overhead of a term besides its
 * products. */
static inline __attribute__((always_inline)) void
weigh_fours(const Dop853 *d, const TableauTerms *terms, int first, int fours, double *sums)
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

AS_WIDE_AS_CAN_BE const double *dop853_weigh(const Dop853 *d, int row, double *sums)
{
    const TableauTerms *terms = &dop853_rows[row];
    int first = 0;

    for (; first + 4 * MOST_FOURS <= d->room; first += 4 * MOST_FOURS)
        weigh_fours(d, terms, first, MOST_FOURS, sums);
    for (; first < d->room; first += TOGETHER)
        weigh_fours(d, terms, first, TOGETHER / 4, sums);
    return sums;
}

AS_WIDE_AS_CAN_BE void dop853_move(const double *old, double h, const double *sum, int count,
                                   double *out)
{
    int i = 0;

    for (; i + 4 <= count; i += 4)
        *(Four *)(out + i) = *(const Four *)(old + i) + h * *(const Four *)(sum + i);
    for (; i < count; i++)
        out[i] = old[i] + h * sum[i];
}

void dop853_note_rounding(Dop853 *d)
{
    d->rounded = fmax(d->rounded, stepper_rounding(&d->base));
}

bool dop853_set_stage(Dop853 *d, int stage, double h, double *point)
{
    bool is_defined;

    dop853_move(d->old, h, dop853_weigh(d, stage, d->sums[0]), d->all, point);
    is_defined =
        stepper_rate(&d->base, d->base.before + dop853_nodes[stage] * h, point, d->k[stage]);
    d->rounding[stage] = stepper_rounding(&d->base);
    d->rounded = fmax(d->rounded, d->rounding[stage]);
    return is_defined;
}

bool dop853_set_stages(Dop853 *d, double h)
{
    dop853_note_rounding(d);
    memset(d->rounding, 0, sizeof d->rounding);
    for (int stage = 1; stage < ROW_END; stage++)
        if (!dop853_set_stage(d, stage, h, d->stage_point))
            return false;
    return true;
}
