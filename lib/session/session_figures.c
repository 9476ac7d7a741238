/* session_figures.c: functions of a whole run: max(h8), mean, rms, final, first, settling, period
 *
 * All are of the motion: the course of the argument is read between rows from the dense output, in
 * pieces as short as the integrator's steps and never across an event. Means are quadratures,
 * halved until halves agree; extremes are searched about the largest samples and rows; instants are
 * closed in on.
 */
#include "session/session_impl.h"

#include "session/session_limits.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    POINTS = 7,    /* of a piece, by Gauss and Legendre: exact to degree 13 */
    SAMPLES = 9,   /* of a piece: these, and its ends from inside */
    MOST = 40000,  /* pieces */
    HALVINGS = 10, /* of a piece; a kink within is then some 1e-3 of it, */
    SHORT = 5,     /* these pieces are short, and what kinks and jumps within add up to is less */
    CLOSER = 16,   /* rounds of SAMPLES instants for an instant, each a tenth as long */
    PEAKS = 8,     /* that an extreme is searched in, */
    PASSES = 4,    /* so often, */
    ABOUT = 16     /* with so many instants each, evenly spaced, and those of a parabola's top and a
                      corner */
};

static const double nodes[POINTS] = {
    -0.9491079123427585, -0.7415311855993945, -0.4058451513773972, 0,
    0.4058451513773972,  0.7415311855993945,  0.9491079123427585};
static const double weights[POINTS] = {0.1294849661688697, 0.2797053914892766, 0.3818300505051189,
                                       0.4179591836734694, 0.3818300505051189, 0.2797053914892766,
                                       0.1294849661688697};

typedef struct FigureCourse { /* of one formula over one run */
    ct_session *session;
    const Syntax *call;
    const Formula *formula; /* of its argument */
    Run *source, *grid;
    LIST(double) ends;   /* of pieces, rising */
    LIST(double) times;  /* samples, SAMPLES a piece, */
    LIST(double) values; /* and the formula there */
} FigureCourse;

static void course_free(FigureCourse *course)
{
    LIST_FREE(course->ends);
    LIST_FREE(course->times);
    LIST_FREE(course->values);
}

static Status course_at(const FigureCourse *course, const double *times, int count, double *out,
                        Diag *diag)
{
    return formula_rows(course->session, course->formula, 1, course->grid, course->source, times,
                        count, out, 1, 0, diag);
}

/* --- pieces --- */

static void add_piece(FigureCourse *course, double to, int parts)
{
    const double from = course->ends.at[course->ends.count - 1];

    for (int k = 1; k < parts; k++)
        LIST_PUSH(course->ends, from + (to - from) * k / parts);
    LIST_PUSH(course->ends, to);
}

/* from row to row and corner to corner, no longer than half the mean step */
static void cut_pieces(FigureCourse *course)
{
    const Result *result = course->grid->result;
    const double *rows = result_times(result), *corners = result_corner_times(result);
    const int row_count = result_rows(result), corner_count = result_corner_count(result);
    const double span = rows[row_count - 1] - rows[0];
    const double most = fmin(2.0 * (double)result_report(result)->steps, MOST);
    int corner = 0;

    LIST_PUSH(course->ends, rows[0]);
    for (int i = 1; i <= row_count - 1 && span > 0;) {
        const double last = course->ends.at[course->ends.count - 1];
        double next = rows[i];

        while (corner < corner_count && corners[corner] <= last)
            corner++;
        if (corner < corner_count && corners[corner] < next)
            next = corners[corner];
        if (next > last)
            add_piece(course, next, 1 + (int)((next - last) / span * most));
        if (next == rows[i])
            i++;
    }
}

static Status course_sample(FigureCourse *course, Diag *diag)
{
    cut_pieces(course);
    for (int i = 1; i < course->ends.count; i++) {
        const double a = course->ends.at[i - 1], b = course->ends.at[i];

        LIST_PUSH(course->times, a);
        for (int k = 0; k < POINTS; k++)
            LIST_PUSH(course->times, (a + b) / 2 + (b - a) / 2 * nodes[k]);
        LIST_PUSH(course->times, b - FIGURES_END * (b - a));
    }
    LIST_PUSH(course->times, course->ends.at[course->ends.count - 1]);
    LIST_ROOM(course->values, course->times.count);
    course->values.count = course->times.count;
    return course_at(course, course->times.at, course->times.count, course->values.at, diag);
}

/* --- means --- */

typedef struct SessionFiguresPiece {
    double a, b, sum; /* the integral over it */
} SessionFiguresPiece;
typedef LIST(SessionFiguresPiece) SessionFiguresPieces;

static double sum_up(const SessionFiguresPiece *piece, const double *values, int power)
{
    double sum = 0;

    for (int k = 0; k < POINTS; k++)
        sum += weights[k] * (power == 2 ? values[k] * values[k] : values[k]);
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
            times[i * POINTS + k] = (half.a + half.b) / 2 + (half.b - half.a) / 2 * nodes[k];
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

/* the mean of a power; pieces are halved where the halves give a different integral */
static Status mean_of(const FigureCourse *course, int power, double *out, Diag *diag)
{
    const double span = course->ends.at[course->ends.count - 1] - course->ends.at[0];
    SessionFiguresPieces open = {0}, halves = {0};
    double sum = 0, size = 0, least = INFINITY, last_width = 0;
    Status status = OK;

    *out = power == 2 ? course->values.at[0] * course->values.at[0] : course->values.at[0];
    if (!(span > 0))
        return OK;
    for (int i = 1; i < course->ends.count; i++) {
        SessionFiguresPiece piece = {course->ends.at[i - 1], course->ends.at[i], 0};

        piece.sum = sum_up(&piece, course->values.at + (size_t)(i - 1) * SAMPLES + 1, power);
        size += fabs(piece.sum);
        LIST_PUSH(open, piece);
    }
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

static Status figure_mean(const FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band;
    return mean_of(course, 1, out, diag);
}

static Status figure_rms(const FigureCourse *course, double band, double *out, Diag *diag)
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
    *peak = (Peak){.t = {t[before], t[k], t[after]}, .f = {f[before], f[k], f[after]}};
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

/* The largest of sign * value among the rows, which hold both sides of an event, and the samples;
 * and where the samples have peaks. NAN where a row or a sample has no value. */
static Status sampled_extreme(const FigureCourse *course, double sign, double *best, Peaks *peaks,
                              Diag *diag)
{
    const int rows = result_rows(course->grid->result), count = course->values.count;
    double *values = NEW_ARRAY(double, rows), *f = NEW_ARRAY(double, count);
    Status status;

    *best = -INFINITY;
    CHECK(formula_rows(course->session, course->formula, 1, course->grid, course->source, NULL,
                       rows, values, 1, 0, diag));
    for (int i = 0; i < rows && !isnan(*best); i++)
        *best = isnan(values[i]) ? NAN : fmax(*best, sign * values[i]);
    for (int i = 0; i < count && !isnan(*best); i++) {
        f[i] = sign * course->values.at[i];
        *best = isnan(f[i]) ? NAN : fmax(*best, f[i]);
    }
    for (int i = 0; i < count && !isnan(*best); i++) {
        Peak peak;

        if ((i > 0 && f[i - 1] >= f[i]) || (i < count - 1 && f[i + 1] > f[i]))
            continue;
        peak_about(course->times.at, f, count, i, &peak);
        if (peak.f[0] < peak.f[1] || peak.f[2] < peak.f[1])
            peaks_add(peaks, &peak);
    }
done:
    MEM_FREE(values, f);
    return status;
}

static Status refuse_growth(const FigureCourse *course, double t, Diag *diag)
{
    (void)diag_at(diag, E_VALUE, course->call->place,
                  "near t = %.6g s it grows without bound, and has no extreme", t);
    diag_hint(diag, "if(.., .., ..) leaves an instant out");
    return E_VALUE;
}

/* the largest of sign * value, times sign; NAN where a row or a sample has no value */
static Status extreme(const FigureCourse *course, double sign, double *out, Diag *diag)
{
    Peaks peaks = {0};
    bool grows[PEAKS];
    double best;

    TRY(sampled_extreme(course, sign, &best, &peaks, diag));
    memset(grows, true, sizeof grows);
    for (int pass = 0; pass < PASSES && peaks.count > 0 && isfinite(best); pass++) {
        const Peaks before = peaks;

        TRY(peaks_search(course, sign, &peaks, diag));
        for (int k = 0; k < peaks.count; k++)
            grows[k] = grows[k] && before.at[k].f[1] > 0 &&
                       peaks.at[k].f[1] > FIGURES_GROWTH * before.at[k].f[1];
    }
    for (int k = 0; k < peaks.count && isfinite(best); k++) {
        if (grows[k] && peaks.at[k].f[1] > best)
            return refuse_growth(course, peaks.at[k].t[1], diag);
        best = fmax(best, peaks.at[k].f[1]);
    }
    *out = sign * best;
    return OK;
}

static Status figure_max(const FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band;
    return extreme(course, 1, out, diag);
}

static Status figure_min(const FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band;
    return extreme(course, -1, out, diag);
}

static Status figure_final(const FigureCourse *course, double band, double *out, Diag *diag)
{
    (void)band, (void)diag;
    *out = course->values.at[course->values.count - 1];
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
    double a = course->times.at[k - 1], b = course->times.at[k];

    for (int round = 0; round < CLOSER; round++) {
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

static Status figure_first(const FigureCourse *course, double band, double *out, Diag *diag)
{
    int k = 0;

    (void)band;
    while (k < course->values.count && !is_true(course->values.at[k], 0, 0))
        k++;
    if (k == course->values.count) {
        (void)diag_at(diag, E_VALUE, course->call->args[0]->place,
                      "this holds at no instant of the run");
        diag_hint(diag, "'max' and 'min' show how far it came");
        return E_VALUE;
    }
    *out = course->times.at[k];
    return k == 0 ? OK : instant(course, k, is_true, 0, 0, out, diag);
}

static Status figure_settling(const FigureCourse *course, double band, double *out, Diag *diag)
{
    const double level = course->values.at[course->values.count - 1];
    int k = course->values.count - 1;

    if (!(band > 0))
        return diag_at(diag, E_VALUE, course->call->args[1]->place,
                       "the band has to be above 0, not %g", band);
    while (k > 0 && is_within(course->values.at[k - 1], level, band))
        k--;
    *out = course->times.at[0];
    if (k > 0)
        TRY(instant(course, k, is_within, level, band, out, diag));
    *out -= course->times.at[0];
    return OK;
}

/* from the first to the last time that it rises through its mean */
static Status figure_period(const FigureCourse *course, double band, double *out, Diag *diag)
{
    double mean, from, to, least = INFINITY, most = 0;
    int first = -1, last = -1, crossings = 0;

    (void)band;
    TRY(mean_of(course, 1, &mean, diag));
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
    Status (*value)(const FigureCourse *course, double band, double *out, Diag *diag);
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
    CHECK(course_sample(&course, diag));
    CHECK(figure->value(&course, band, out, diag));
done:
    course_free(&course);
    return status;
}
