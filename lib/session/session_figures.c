/* session_figures.c: functions of a whole run: max(h8), mean, rms, final, first, settling, period
 *
 * All are of the motion: the course of the argument is read between rows from the dense output, in
 * pieces as short as the integrator's steps and never across an event, where its rows leave a
 * figure open (session_figure_course.h). Means are quadratures, halved until halves agree; extremes
 * are searched about the largest samples and rows; instants are closed in on.
 */
#include "session/session_figure_course.h"

#include "session/session_limits.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    HALVINGS = 10, /* of a piece; a kink within is then some 1e-3 of it, */
    SHORT = 5,     /* these pieces are short, and what kinks and jumps within add up to is less */
    CLOSER = 16,   /* rounds of SAMPLES instants for an instant, each a tenth as long */
    CHUNK = 8,  /* pieces that are sampled at once in a search for an instant, then twice as many */
    PEAKS = 8,  /* that an extreme is searched in, */
    PASSES = 4, /* so often, */
    PEAKS_LAST = 2,  /* and that many after the first two passes */
    PEAK_MARGIN = 4, /* times the parabola above its samples: how far an extreme may be above */
    ABOUT = 16 /* with so many instants each, evenly spaced, and those of a parabola's top and a
                  corner */
};

/* --- means --- */

typedef struct SessionFiguresPiece {
    double a, b, sum; /* the integral over it */
} SessionFiguresPiece;
typedef LIST(SessionFiguresPiece) SessionFiguresPieces;

static double sum_up(const SessionFiguresPiece *piece, const double *values, int power)
{
    double sum = 0;

    for (int k = 0; k < POINTS; k++)
        sum += course_weights[k] * (power == 2 ? values[k] * values[k] : values[k]);
    return sum * (piece->b - piece->a) / 2;
}

/* the integrals over both halves of each piece */
static Status halve(const FigureCourse *course, const SessionFiguresPieces *pieces, int power,
                    SessionFiguresPieces *halves, Diag *diag)
{
    const int count = 2 * pieces->count;
    double *times = NEW_ARRAY(double, POINTS *count), *values = NEW_ARRAY(double, POINTS *count);
    Status status = OK;

    for (int i = 0; i < count; i++) {
        const SessionFiguresPiece *whole = &pieces->at[i / 2];
        const double middle = (whole->a + whole->b) / 2;
        const SessionFiguresPiece half = {i % 2 == 0 ? whole->a : middle,
                                          i % 2 == 0 ? middle : whole->b, 0};

        LIST_PUSH(*halves, half);
        for (int k = 0; k < POINTS; k++)
            times[i * POINTS + k] = (half.a + half.b) / 2 + (half.b - half.a) / 2 * course_nodes[k];
    }
    CHECK(course_at(course, times, POINTS * count, values, diag));
    for (int i = 0; i < count; i++)
        halves->at[i].sum = sum_up(&halves->at[i], values + (size_t)i * POINTS, power);
done:
    MEM_FREE(times, values);
    return status;
}

/* about a pole no pieces are short enough */
static Status refuse_pole(const FigureCourse *course, const SessionFiguresPieces *halves,
                          Diag *diag)
{
    const SessionFiguresPiece *most = &halves->at[0];

    for (int i = 1; i < halves->count; i++)
        if (fabs(halves->at[i].sum) > fabs(most->sum))
            most = &halves->at[i];
    (void)diag_at(diag, E_VALUE, course->call->place,
                  "near t = %.6g s it grows without bound, and has no mean",
                  (most->a + most->b) / 2);
    diag_hint(diag, "if(.., .., ..) leaves an instant out");
    return E_VALUE;
}

/* The integrals over pieces between rows that these determine are added to *sum, and the others are
 * opened; *size adds up their sizes. */
static Status first_integrals(const FigureCourse *course, int power, SessionFiguresPieces *open,
                              double *sum, double *size, Diag *diag)
{
    const int count = course->pieces.count;
    const double span = course->pieces.at[count - 1].b - course->pieces.at[0].a;
    double *times = NULL, *values = NULL, of_rows = 0;
    Status status = OK;

    for (int k = 0; k < count; k++)
        if (course->pieces.at[k].row >= 0)
            of_rows += pow(fabs(course->rows[course->pieces.at[k].row]), power) *
                       (course->pieces.at[k].b - course->pieces.at[k].a);
    for (int k = 0; k < count; k++) {
        const FigurePiece *from = &course->pieces.at[k];
        SessionFiguresPiece piece = {from->a, from->b, 0};
        const double share = fmax((piece.b - piece.a) / span, 1e-3);

        if (course_integral(course, from, power, course->tolerance * of_rows * share, &piece.sum)) {
            *sum += piece.sum;
            *size += fabs(piece.sum);
        } else {
            LIST_PUSH(*open, piece);
        }
    }
    times = NEW_ARRAY(double, POINTS * open->count);
    values = NEW_ARRAY(double, POINTS * open->count);
    for (int i = 0; i < open->count; i++)
        for (int k = 0; k < POINTS; k++)
            times[i * POINTS + k] = (open->at[i].a + open->at[i].b) / 2 +
                                    (open->at[i].b - open->at[i].a) / 2 * course_nodes[k];
    CHECK(course_at(course, times, POINTS * open->count, values, diag));
    for (int i = 0; i < open->count; i++) {
        open->at[i].sum = sum_up(&open->at[i], values + (size_t)i * POINTS, power);
        *size += fabs(open->at[i].sum);
    }
done:
    MEM_FREE(times, values);
    return status;
}

/* the mean of a power; pieces are halved where the halves give a different integral */
static Status mean_of(const FigureCourse *course, int power, double *out, Diag *diag)
{
    const int count = course->pieces.count;
    const double span = count > 0 ? course->pieces.at[count - 1].b - course->pieces.at[0].a : 0;
    SessionFiguresPieces open = {0}, halves = {0};
    double sum = 0, size = 0, least = INFINITY, last_width = 0;
    Status status = OK;

    *out = pow(course->rows[0], power);
    if (!(span > 0))
        return OK;
    CHECK(first_integrals(course, power, &open, &sum, &size, diag));
    for (int k = 0; open.count > 0; k++) {
        const bool is_noise = k > SHORT && last_width > FIGURES_NOISE * span;
        double rough = 0, width = 0; /* what the rough pieces add up to, of the course and of t */
        int left = 0;

        halves.count = 0;
        CHECK(halve(course, &open, power, &halves, diag));
        assert(halves.at != NULL);
        for (int i = 0; i < open.count; i++) {
            const double both = halves.at[2 * i].sum + halves.at[2 * i + 1].sum;
            const double bound =
                FIGURES_AGREE * size * fmax((open.at[i].b - open.at[i].a) / span, 1e-3);

            const double own = fabs(halves.at[2 * i].sum) + fabs(halves.at[2 * i + 1].sum);
            const bool is_rough = fabs(both - open.at[i].sum) > FIGURES_ROUGH * own;

            rough += is_rough ? own : 0;
            width += is_rough ? open.at[i].b - open.at[i].a : 0;
            if (k < HALVINGS && !is_noise && fabs(both - open.at[i].sum) > bound) {
                halves.at[left++] = halves.at[2 * i];
                halves.at[left++] = halves.at[2 * i + 1];
            } else {
                sum += both;
            }
        }
        if (k <= SHORT)
            least = fmin(least, rough);
        else if (k == HALVINGS && rough > fmax(FIGURES_POLE * least, FIGURES_POLE_SIZE * size) &&
                 width <= FIGURES_POLE_SPAN * span)
            CHECK(refuse_pole(course, &halves, diag));
        halves.count = left;
        last_width = width;

        const SessionFiguresPieces swap = open;

        open = halves;
        halves = swap;
    }
    *out = sum / span;
done:
    LIST_FREE(open);
    LIST_FREE(halves);
    return status;
}

static Status figure_mean(FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band;
    return mean_of(course, 1, out, diag);
}

static Status figure_rms(FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band;
    TRY(mean_of(course, 2, out, diag));
    *out = sqrt(*out);
    return OK;
}

/* --- extremes --- */

/* f(t) of a peak at three instants, the middle one the largest; f has the sign for which the
 * extreme is the largest. `reach` is the top of the parabola through them, which is at `top`. */
typedef struct Peak {
    double t[3], f[3];
    double top, reach;
    double corner; /* where lines from both sides meet; t[1]: unknown */
    bool grows;    /* in every pass so far, as towards a pole */
} Peak;

typedef struct Peaks { /* those that reach highest, falling */
    Peak at[PEAKS];
    int count;
} Peaks;

/* From t_1, with d_k = t_k - t_1 and s_k = (f_k - f_1)/d_k, k = 0, 2: f = f_1 + b x + c x^2 with
 * c = (s_2 - s_0)/(d_2 - d_0) and b = s_0 - c d_0; at the top x = -b/(2 c), f - f_1 = -b^2/(4 c).
 */
static void peak_fit(Peak *peak)
{
    const double before = peak->t[0] - peak->t[1], after = peak->t[2] - peak->t[1];
    const double rise = (peak->f[0] - peak->f[1]) / before;
    const double fall = (peak->f[2] - peak->f[1]) / after;
    const double c = (fall - rise) / (after - before), b = rise - c * before;

    peak->top = peak->corner = peak->t[1];
    peak->reach = peak->f[1];
    if (before < 0 && after > 0 && c < 0) {
        peak->top = fmin(fmax(peak->t[1] - b / (2 * c), peak->t[0]), peak->t[2]);
        peak->reach -= b * b / (4 * c);
    }
}

static void peaks_add(Peaks *peaks, const Peak *peak)
{
    int k = peaks->count;

    for (; k > 0 && peaks->at[k - 1].reach < peak->reach; k--)
        if (k < PEAKS)
            peaks->at[k] = peaks->at[k - 1];
    if (k < PEAKS)
        peaks->at[k] = *peak;
    peaks->count = peaks->count < PEAKS ? peaks->count + 1 : PEAKS;
}

/* f about f_k, no less than its neighbours; of two instants at a corner the further one counts */
static void peak_about(const double *t, const double *f, int count, int k, Peak *peak)
{
    int before = k > 0 ? k - 1 : k, after = k < count - 1 ? k + 1 : k;

    if (before > 0 && t[k] - t[before] < FIGURES_CORNER * (t[before] - t[before - 1]) &&
        f[before - 1] <= f[k])
        before--;
    if (after < count - 1 && t[after] - t[k] < FIGURES_CORNER * (t[after + 1] - t[after]) &&
        f[after + 1] <= f[k])
        after++;
    *peak = (Peak){
        .t = {t[before], t[k], t[after]}, .f = {f[before], f[k], f[after]}, .grows = peak->grows};
    peak_fit(peak);
}

/* where the lines through f_{k-2}, f_{k-1} and through f_{k+1}, f_{k+2} meet between those */
static void peak_find_corner(Peak *peak, const double *t, const double *f, int count, int k)
{
    double rise, fall, corner;

    if (k < 2 || k + 2 >= count)
        return;
    rise = (f[k - 1] - f[k - 2]) / (t[k - 1] - t[k - 2]);
    fall = (f[k + 2] - f[k + 1]) / (t[k + 2] - t[k + 1]);
    corner = t[k - 1] + (f[k + 1] - f[k - 1] - fall * (t[k + 1] - t[k - 1])) / (rise - fall);
    if (corner > peak->t[0] && corner < peak->t[2])
        peak->corner = corner;
}

static int compare_times(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;

    return (one > other) - (one < other);
}

/* rising instants within all peaks; how many */
static int peaks_times(const Peaks *peaks, double *times)
{
    int count = 0, kept = 0;

    for (int k = 0; k < peaks->count; k++) {
        const Peak *peak = &peaks->at[k];

        for (int i = 1; i <= ABOUT; i++)
            times[count++] = peak->t[0] + (peak->t[2] - peak->t[0]) * i / (ABOUT + 1);
        times[count++] = peak->top;
        times[count++] = peak->corner;
    }
    qsort(times, (size_t)count, sizeof *times, compare_times);
    for (int i = 0; i < count; i++)
        if (kept == 0 || times[i] > times[kept - 1])
            times[kept++] = times[i];
    return kept;
}

/* A peak, about its largest value among those at `times`. */
static void peak_narrow(Peak *peak, const double *times, const double *values, int count)
{
    double t[PEAKS * (ABOUT + 2) + 3], f[PEAKS * (ABOUT + 2) + 3];
    int length = 0, k = 0;

    t[length] = peak->t[0];
    f[length++] = peak->f[0];
    for (int i = 0; i < count; i++)
        if (times[i] > peak->t[0] && times[i] < peak->t[2]) {
            t[length] = times[i];
            f[length++] = values[i];
        }
    t[length] = peak->t[2];
    f[length++] = peak->f[2];
    for (int i = 0; i < length; i++)
        k = f[i] > f[k] ? i : k;
    if (f[k] >= peak->f[1]) {
        peak_about(t, f, length, k, peak);
        peak_find_corner(peak, t, f, length, k);
    }
}

/* one pass over the course within all peaks */
static Status peaks_search(const FigureCourse *course, double sign, Peaks *peaks, Diag *diag)
{
    double times[PEAKS * (ABOUT + 2)], values[PEAKS * (ABOUT + 2)];
    const int count = peaks_times(peaks, times);

    TRY(course_at(course, times, count, values, diag));
    for (int i = 0; i < count; i++)
        values[i] *= sign;
    for (int k = 0; k < peaks->count; k++)
        peak_narrow(&peaks->at[k], times, values, count);
    return OK;
}

static bool may_exceed(const FigureCourse *course, const FigurePiece *piece, double level,
                       double sign)
{
    const double *f = course->rows + piece->row;

    return fmax(sign * f[0], sign * f[1]) + piece->bound >= level;
}

/* The largest of sign * value among the rows, which hold both sides of an event, and the samples;
 * and where the samples have peaks. NAN where a row or a sample has no value. */
static Status sampled_extreme(FigureCourse *course, double sign, double *best, Peaks *peaks,
                              Diag *diag)
{
    double *f = NULL;
    int count;
    Status status = OK;

    *best = -INFINITY;
    for (int i = 0; i < result_rows(course->grid->result) && !isnan(*best); i++)
        *best = isnan(course->rows[i]) ? NAN : fmax(*best, sign * course->rows[i]);
    CHECK(course_sample(course, 0, course->pieces.count, may_exceed, *best, sign, diag));
    count = course->values.count;
    f = NEW_ARRAY(double, count);
    for (int i = 0; i < count && !isnan(*best); i++) {
        f[i] = sign * course->values.at[i];
        *best = isnan(f[i]) ? NAN : fmax(*best, f[i]);
    }
    for (int i = 0; i < count && !isnan(*best); i++) {
        Peak peak = {.grows = true};

        if ((i > 0 && f[i - 1] >= f[i]) || (i < count - 1 && f[i + 1] > f[i]))
            continue;
        peak_about(course->times.at, f, count, i, &peak);
        if (peak.f[0] < peak.f[1] || peak.f[2] < peak.f[1])
            peaks_add(peaks, &peak);
    }
done:
    mem_free(f);
    return status;
}

static Status refuse_growth(const FigureCourse *course, double t, Diag *diag)
{
    (void)diag_at(diag, E_VALUE, course->call->place,
                  "near t = %.6g s it grows without bound, and has no extreme", t);
    diag_hint(diag, "if(.., .., ..) leaves an instant out");
    return E_VALUE;
}

/* Without peaks that are found, or that others exceed by more than their parabolas are open; later
 * the highest two stand for all that are as high. */
static void peaks_leave(Peaks *peaks, const Peaks *before, double best, double found, int pass)
{
    const Peaks all = *peaks;

    peaks->count = 0;
    for (int k = 0; k < all.count; k++) {
        const Peak *peak = &all.at[k];
        const double open = fabs(peak->reach - peak->f[1]);

        if (peak->grows || (fabs(peak->f[1] - before->at[k].reach) > found &&
                            peak->f[1] + PEAK_MARGIN * open >= best))
            peaks_add(peaks, peak);
    }
    if (pass > 0 && peaks->count > PEAKS_LAST)
        peaks->count = PEAKS_LAST;
}

/* the largest of sign * value, times sign; NAN where a row or a sample has no value */
static Status extreme(FigureCourse *course, double sign, double *out, Diag *diag)
{
    Peaks peaks = {0};
    double best;

    TRY(sampled_extreme(course, sign, &best, &peaks, diag));
    for (int pass = 0; pass < PASSES && peaks.count > 0 && isfinite(best); pass++) {
        const Peaks before = peaks;
        double top = best;

        TRY(peaks_search(course, sign, &peaks, diag));
        for (int k = 0; k < peaks.count; k++) {
            Peak *peak = &peaks.at[k];

            peak->grows = before.at[k].grows && before.at[k].f[1] > 0 &&
                          peak->f[1] > FIGURES_GROWTH * before.at[k].f[1];
            if (pass == PASSES - 1 && peak->grows && peak->f[1] > best)
                return refuse_growth(course, peak->t[1], diag);
            top = fmax(top, peak->f[1]);
        }
        best = top;
        peaks_leave(&peaks, &before, best, FIGURES_FOUND * course->tolerance * course->scale, pass);
    }
    *out = sign * best;
    return OK;
}

static Status figure_max(FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band;
    return extreme(course, 1, out, diag);
}

static Status figure_min(FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band;
    return extreme(course, -1, out, diag);
}

static Status figure_final(FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band, (void)diag;
    *out = course->rows[result_rows(course->grid->result) - 1];
    return OK;
}

/* --- instants --- */

typedef bool Holds(double value, double level, double band);

static bool is_true(double value, double level, double band)
{
    (void)level, (void)band;
    return value != 0;
}

static bool is_above(double value, double level, double band)
{
    (void)band;
    return value >= level;
}

static bool is_within(double value, double level, double band)
{
    return fabs(value - level) <= band;
}

/* the instant at which the condition becomes true, between samples k - 1 and k */
static Status instant(const FigureCourse *course, int k, Holds *holds, double level, double band,
                      double *out, Diag *diag)
{
    const double *rows = result_times(course->grid->result);
    const double span = rows[result_rows(course->grid->result) - 1] - rows[0];
    double a = course->times.at[k - 1], b = course->times.at[k];

    for (int round = 0; round < CLOSER && b - a > FIGURES_INSTANT * span; round++) {
        double times[SAMPLES], values[SAMPLES];
        int first = 0;

        for (int i = 0; i < SAMPLES; i++)
            times[i] = a + (b - a) * (i + 1) / (SAMPLES + 1);
        TRY(course_at(course, times, SAMPLES, values, diag));
        while (first < SAMPLES && !holds(values[first], level, band))
            first++;
        a = first > 0 ? times[first - 1] : a;
        b = first < SAMPLES ? times[first] : b;
    }
    *out = b;
    return OK;
}

static bool is_needed(const FigureCourse *course, const FigurePiece *piece, double level,
                      double band)
{
    (void)course, (void)piece, (void)level, (void)band;
    return true;
}

static Status figure_first(FigureCourse *course, double band, double *out, Diag *diag)
{
    const int count = course->pieces.count;
    int k = 0;

    (void)band;
    for (int from = 0, chunk = CHUNK; from == 0 || from < count; from += chunk / 2) {
        TRY(course_sample(course, from, count - from < chunk ? count : from + chunk, is_needed, 0,
                          0, diag));
        for (k = 0; k < course->values.count && !is_true(course->values.at[k], 0, 0);)
            k++;
        *out = k < course->values.count ? course->times.at[k] : NAN;
        if (k < course->values.count)
            return k == 0 ? OK : instant(course, k, is_true, 0, 0, out, diag);
        chunk *= 2;
        if (count == 0)
            break;
    }
    (void)diag_at(diag, E_VALUE, course->call->args[0]->place,
                  "this holds at no instant of the run");
    diag_hint(diag, "'max' and 'min' show how far it came");
    return E_VALUE;
}

static bool may_leave(const FigureCourse *course, const FigurePiece *piece, double level,
                      double band)
{
    const double *f = course->rows + piece->row;

    return !(fmax(fabs(f[0] - level), fabs(f[1] - level)) + piece->bound <= band);
}

static Status figure_settling(FigureCourse *course, double band, double *out, Diag *diag)
{
    const double begin = result_times(course->grid->result)[0];
    const double level = course->rows[result_rows(course->grid->result) - 1];

    *out = 0;
    if (!(band > 0))
        return diag_at(diag, E_VALUE, course->call->args[1]->place,
                       "the band has to be above 0, not %g", band);
    for (int end = course->pieces.count, chunk = CHUNK; end > 0; end -= chunk / 2) {
        int k;

        TRY(course_sample(course, end > chunk ? end - chunk : 0, end, may_leave, level, band,
                          diag));
        k = course->values.count;
        while (k > 0 && is_within(course->values.at[k - 1], level, band))
            k--;
        if (k > 0 && k < course->values.count)
            TRY(instant(course, k, is_within, level, band, out, diag));
        else if (k > 0)
            *out = course->times.at[k - 1];
        if (k > 0) {
            *out -= begin;
            return OK;
        }
        chunk *= 2;
    }
    return OK;
}

/* whether it may cross the level other than once, from one end to the other */
static bool may_cross(const FigureCourse *course, const FigurePiece *piece, double level,
                      double band)
{
    const double *f = course->rows + piece->row;
    const double nearest = fmin(fabs(f[0] - level), fabs(f[1] - level));

    (void)band;
    return (f[0] < level) == (f[1] < level) ? nearest <= piece->bound
                                            : fabs(f[1] - f[0]) <= piece->bound;
}

static Status figure_period(FigureCourse *course, double band, double *out, Diag *diag)
{
    double mean, from, to, least = INFINITY, most = 0;
    int first = -1, last = -1, crossings = 0;

    (void)band;
    TRY(mean_of(course, 1, &mean, diag));
    TRY(course_sample(course, 0, course->pieces.count, may_cross, mean, 0, diag));
    for (int k = 1; k < course->values.count; k++) {
        if (!(course->values.at[k - 1] < mean && course->values.at[k] >= mean))
            continue;
        if (last >= 0) {
            least = fmin(least, course->times.at[k] - course->times.at[last]);
            most = fmax(most, course->times.at[k] - course->times.at[last]);
        }
        first = first < 0 ? k : first;
        last = k;
        crossings++;
    }
    if (crossings < 2) {
        (void)diag_at(diag, E_VALUE, course->call->place,
                      "it %s through its mean in the run, so no period can be told",
                      crossings == 0 ? "never rises" : "rises once");
        diag_hint(diag, "a longer run shows more of it");
        return E_VALUE;
    }
    TRY(instant(course, first, is_above, mean, 0, &from, diag));
    TRY(instant(course, last, is_above, mean, 0, &to, diag));
    *out = (to - from) / (crossings - 1);
    if (most - least > FIGURES_IRREGULAR * *out && crossings > 2) {
        (void)diag_at(diag, E_VALUE, course->call->place,
                      "it isn't periodic: it rises through its mean after %.3g to %.3g s", least,
                      most);
        return E_VALUE;
    }
    return OK;
}

/* --- the table --- */

typedef struct Figure {
    const char *name;
    int args;
    Status (*value)(FigureCourse *course, double band, double *out, Diag *diag);
} Figure;

static const Figure figures[] = {
    {"min", 1, figure_min},       {"max", 1, figure_max},           {"mean", 1, figure_mean},
    {"rms", 1, figure_rms},       {"final", 1, figure_final},       {"first", 1, figure_first},
    {"period", 1, figure_period}, {"settling", 2, figure_settling},
};

static const Figure *find_figure(const Syntax *syntax)
{
    for (int i = 0; syntax->kind == SYNTAX_CALL && i < COUNT(figures); i++)
        if (figures[i].args == syntax->count && strcmp(figures[i].name, syntax->text) == 0)
            return &figures[i];
    return NULL;
}

bool figure_is_called(const Syntax *syntax)
{
    return find_figure(syntax) != NULL;
}

Status figure_value(ct_session *session, const Syntax *call, const Formula *argument, double band,
                    double *out, Diag *diag)
{
    const Figure *figure = find_figure(call);
    FigureCourse course = {.session = session, .call = call, .formula = argument};
    Status status = OK;

    course.source = session->runs.at + session->runs.count - 1;
    course.grid = formula_grid(session, argument, 1, course.source);
    *out = NAN;
    if (result_rows(course.grid->result) == 0)
        return OK;
    CHECK(course_open(&course, diag));
    CHECK(figure->value(&course, band, out, diag));
done:
    course_free(&course);
    return status;
}
