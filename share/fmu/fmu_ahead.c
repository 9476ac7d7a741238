/* fmu_ahead.c: search for events that time causes, as by sources
 *
 * States may change slowly while sources oscillate, and an importer chooses steps by the states
 * alone. So the next time event is set before event functions bend much, and within the first short
 * interval in which one of them changes its sign for constant states. */
#include "fmu.h"

enum { LOOKS = 60, LOOKED = 64, PIECES = 16 }; /* of a look ahead: halvings, nearer, places */
#define UNSEEN   1e-9 /* of the largest of them: what of an indicator rounding may be */
#define BENT     0.05 /* of what changes: how far it may bend between places */
#define SHORTEST 1e-9 /* of 1 + |t| */
#define LONGEST  1e3  /* likewise: without any function of time a step could double for ever */

/* indicators later on, states as they are */
static int indicators_ahead(Fmu *fmu, double t, double ahead, double *out)
{
    fmu_set_time(fmu, t + ahead);
    return FMU_INDICATORS > 0 && fmu_indicators(fmu, out) == FMU_OK;
}

/* whether steps of that length resolve the curvature of indicators, by fourth differences */
static int is_shown(Fmu *fmu, double t, double step)
{
    static const double weight[] = {1, -4, 6, -4, 1};
    double at[FMU_INDICATORS + 1], sum[FMU_INDICATORS + 1] = {0};
    double least[FMU_INDICATORS + 1], most[FMU_INDICATORS + 1], largest = 0;
    int i, k;

    for (k = 0; k < 5; k++) {
        if (!indicators_ahead(fmu, t, k * step, at))
            return 0;
        for (i = 0; i < FMU_INDICATORS; i++) {
            sum[i] += weight[k] * at[i];
            least[i] = k == 0 || at[i] < least[i] ? at[i] : least[i];
            most[i] = k == 0 || at[i] > most[i] ? at[i] : most[i];
            largest = fmax(largest, fabs(at[i]));
        }
    }
    for (i = 0; i < FMU_INDICATORS; i++)
        if (fabs(sum[i]) > BENT * (most[i] - least[i]) + UNSEEN * largest)
            return 0;
    return 1;
}

/* How far one of them is on its side at the least; below 0: beyond, by more than rounding. */
static double nearest_side(Fmu *fmu, double t, double ahead)
{
    double at[FMU_INDICATORS + 1], least = HUGE_VAL, largest = 0;
    int i;

    if (!indicators_ahead(fmu, t, ahead, at))
        return HUGE_VAL;
    for (i = 0; i < FMU_INDICATORS; i++) {
        const double v = at[i] * fmu_sense(&fmu->now, FMU_TIMED + i);

        least = v < least ? v : least;
        largest = fmax(largest, fabs(v));
    }
    return least + UNSEEN * largest;
}

void fmu_look_ahead(Fmu *fmu, int is_new)
{
    FmuNumbers *now = &fmu->now;
    const double t = now->t;
    const double shortest = SHORTEST * (1 + fabs(t)), longest = LONGEST * (1 + fabs(t));
    double step = !is_new && now->rhythm > 0 ? now->rhythm / LOOKED : shortest;
    double low, least = HUGE_VAL;
    int i, k, best = 0;

    while (step >= shortest && !is_shown(fmu, t, step))
        step /= 2;
    for (k = 0; k < LOOKS && step >= shortest && 2 * step <= longest && is_shown(fmu, t, 2 * step);
         k++)
        step *= 2;
    now->rhythm = step;
    if (step < shortest) /* too short to decide */
        goto done;
    now->next = now->next < t + 4 * step ? now->next : t + 4 * step;
    for (i = 1; i <= PIECES; i++) {
        const double v = nearest_side(fmu, t, (now->next - t) * i / PIECES);

        if (v < least) {
            least = v;
            best = i;
        }
        if (v < 0)
            break;
    }
    if (best > 0 && best < PIECES) { /* a golden section about the nearest */
        const double unit = (now->next - t) / PIECES;
        double high = (best + 1) * unit, a, b, at_a, at_b;

        low = (best - 1) * unit;
        for (k = 0; k < 30 && least >= 0; k++) {
            a = high - 0.6180339887498949 * (high - low);
            b = low + 0.6180339887498949 * (high - low);
            at_a = nearest_side(fmu, t, a);
            at_b = nearest_side(fmu, t, b);
            least = at_a < at_b ? at_a : at_b;
            if (at_a < at_b)
                high = b;
            else
                low = a;
        }
        if (least < 0)
            now->next = t + fmax(unit, k > 0 ? (low + high) / 2 : best * unit);
    }
done:
    fmu_set_time(fmu, t);
    now->is_solved = 0;
}
