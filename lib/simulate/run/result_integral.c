/* result_integral.c: integrals of variables over a run
 *
 * Where rows are close, and no corner is between them, the course between two rows is that of the
 * polynomial of degree 5 through the nearest six, if the polynomial of degree 3 gives nearly the
 * same. The rest is cut into pieces that end at rows and corners and are no longer than half the
 * mean step. All items are energies: differences that are small against those of the run are
 * rounding. Gauss and Legendre's points are all inside, so that each piece has one mode. Pieces
 * are halved until their halves give the same. */
#include "simulate/run/result_reader_impl.h"

#include "base/memory.h"
#include "simulate/run/run_limits.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    POINTS = 7,   /* of a piece: exact to degree 13 */
    MOST = 40000, /* pieces, before they are halved */
    HALVINGS = 6, /* of a piece */
};

static const double nodes[POINTS] = {
    -0.9491079123427585, -0.7415311855993945, -0.4058451513773972, 0,
    0.4058451513773972,  0.7415311855993945,  0.9491079123427585};
static const double weights[POINTS] = {0.1294849661688697, 0.2797053914892766, 0.3818300505051189,
                                       0.4179591836734694, 0.3818300505051189, 0.2797053914892766,
                                       0.1294849661688697};

typedef struct IntegralPiece {
    double from, to;
    int end; /* of the interval that it is a part of: place in Integral.ends */
} IntegralPiece;
typedef LIST(IntegralPiece) IntegralPieces;

typedef struct Integral {
    ResultReader *reader;
    const Expr *items;
    int count;
    const CallMonitor *watch;
    LIST(double) ends; /* of intervals, ascending; the first is the start of the run */
    double *sums;      /* ends x count: over the interval up to each */
    double *size;      /* of each item */
    double rounding;   /* of the integral over a piece, J */
    bool *done;        /* an interval is integrated from rows: by its end */
} Integral;

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* rows, corners and the requested times, each once */
static void find_ends(Integral *g, const double *times, int count)
{
    const Grid *grid = &g->reader->result->grid, *corners = &g->reader->result->corners;
    double last = grid->times[0];
    int kept = 0;

    for (int i = 0; i < count; i++)
        last = fmax(last, fmin(times[i], grid->times[grid->count - 1]));
    for (int i = 0; i < grid->count; i++)
        LIST_PUSH(g->ends, grid->times[i]);
    for (int i = 0; i < corners->count; i++)
        LIST_PUSH(g->ends, corners->times[i]);
    for (int i = 0; i < count; i++)
        LIST_PUSH(g->ends, times[i]);
    assert(g->ends.at != NULL); /* the run has a row */
    qsort(g->ends.at, (size_t)g->ends.count, sizeof *g->ends.at, by_size);
    for (int i = 0; i < g->ends.count; i++) {
        const double t = g->ends.at[i];

        if (t >= grid->times[0] && t <= last && (kept == 0 || t > g->ends.at[kept - 1]))
            g->ends.at[kept++] = t;
    }
    g->ends.count = kept;
}

/* --- from rows --- */

/* the integral from a to b of the polynomial through `count` values, `stride` apart */
static double integrate_polynomial(const double *times, const double *values, int stride, int count,
                                   double a, double b)
{
    double sum = 0;

    for (int p = 0; p < POINTS; p++) {
        const double t = (a + b) / 2 + (b - a) / 2 * nodes[p];
        double value = 0;

        for (int i = 0; i < count; i++) {
            double share = values[(ptrdiff_t)i * stride];

            for (int k = 0; k < count; k++)
                share *= k != i ? (t - times[k]) / (times[i] - times[k]) : 1;
            value += share;
        }
        sum += weights[p] * value;
    }
    return sum * (b - a) / 2;
}

/* the place of an end; -1: it is none */
static ptrdiff_t find_end(const Integral *g, double t)
{
    const double *end = bsearch(&t, g->ends.at, (size_t)g->ends.count, sizeof *end, by_size);

    return end != NULL ? end - g->ends.at : -1;
}

/* from one row to the next, by the rows first ... last about them */
static void add_between_rows(Integral *g, const double *values, int row, int first, int last)
{
    const double *times = g->reader->result->grid.times;
    const double a = times[row], b = times[row + 1];
    const ptrdiff_t end = find_end(g, b);
    const int wide = row - 2 < first ? first : row - 2 > last - 5 ? last - 5 : row - 2;
    const int near = row - 1 < first ? first : row - 1 > last - 3 ? last - 3 : row - 1;
    double *sums;

    if (end < 1 || g->ends.at[end - 1] != a) /* an instant between them is requested */
        return;
    sums = &g->sums[end * g->count];
    g->done[end] = true;
    for (int k = 0; k < g->count; k++) {
        const double *of = values + k;

        sums[k] =
            integrate_polynomial(times + wide, of + (ptrdiff_t)wide * g->count, g->count, 6, a, b);
        if (!(fabs(sums[k] - integrate_polynomial(times + near, of + (ptrdiff_t)near * g->count,
                                                  g->count, 4, a, b)) <=
              INTEGRAL_SMOOTH * g->size[k] + g->rounding))
            g->done[end] = false;
    }
    for (int k = 0; k < g->count && !g->done[end]; k++)
        sums[k] = 0;
}

/* the last row from this one on before a corner or an end of a phase */
static int smooth_rows(const Result *r, int row, int *corner)
{
    const Grid *grid = &r->grid, *corners = &r->corners;
    int last = row;

    while (*corner < corners->count && corners->times[*corner] < grid->times[row])
        ++*corner;
    if (*corner < corners->count && corners->times[*corner] == grid->times[row])
        return row;
    while (last + 1 < grid->count && grid->times[last + 1] > grid->times[last] &&
           grid->phase[last + 1] == grid->phase[row] &&
           (*corner == corners->count || grid->times[last + 1] < corners->times[*corner]))
        last++;
    return last;
}

static Status integrate_rows(Integral *g, Diag *diag)
{
    const Grid *grid = &g->reader->result->grid;
    double *values = NEW_ARRAY(double, grid->count * g->count);
    int corner = 0;
    Status status = OK;

    CHECK(result_reader_values(g->reader, g->items, g->count, values, diag));
    for (int i = 0; i < (grid->count - 1) * g->count; i++)
        if (isfinite(values[i]))
            g->size[i % g->count] +=
                fabs(values[i]) * (grid->times[i / g->count + 1] - grid->times[i / g->count]);
    for (int row = 0, last; row < grid->count; row = last + 1) {
        last = smooth_rows(g->reader->result, row, &corner);
        for (int i = row; i < last && last - row >= 5; i++)
            add_between_rows(g, values, i, row, last);
    }
done:
    mem_free(values);
    return status;
}

/* --- by pieces --- */

static void cut_pieces(const Integral *g, IntegralPieces *out)
{
    const double span = g->ends.at[g->ends.count - 1] - g->ends.at[0];
    const double most = fmin(2.0 * (double)g->reader->result->monitor_report.steps, MOST);

    for (int i = 1; i < g->ends.count; i++) {
        const double from = g->ends.at[i - 1], width = g->ends.at[i] - from;
        const int parts = g->done[i] ? 0 : 1 + (int)(width / span * most);

        for (int k = 0; k < parts; k++)
            LIST_PUSH(*out,
                      (IntegralPiece){from + width * k / parts, from + width * (k + 1) / parts, i});
    }
}

/* the integral of each item over each piece: pieces x items */
static Status sum_pieces(const Integral *g, const IntegralPieces *pieces, double *sums, Diag *diag)
{
    const int all = pieces->count * POINTS;
    double *times = NEW_ARRAY(double, all), *values = NEW_ARRAY(double, all);
    Status status = OK;

    for (int i = 0; i < all; i++) {
        const IntegralPiece *piece = &pieces->at[i / POINTS];

        times[i] =
            (piece->from + piece->to) / 2 + (piece->to - piece->from) / 2 * nodes[i % POINTS];
    }
    CHECK(result_reader_prepare(g->reader, times, all, g->watch, diag));
    for (int k = 0; k < g->count; k++) {
        CHECK(
            result_reader_values_along(g->reader, g->items[k], times, all, g->watch, values, diag));
        for (int i = 0; i < pieces->count; i++) {
            double *sum = &sums[i * g->count + k];

            *sum = 0;
            for (int p = 0; p < POINTS; p++)
                *sum += weights[p] * values[i * POINTS + p];
            *sum *= (pieces->at[i].to - pieces->at[i].from) / 2;
        }
    }
done:
    MEM_FREE(times, values);
    return status;
}

/* Whether both halves of a piece give what the whole did, within a part of the run's tolerance. */
static bool agrees(const Integral *g, const double *whole, const double *halves)
{
    const double within =
        fmax(INTEGRAL_AGREES, INTEGRAL_TOLERANCE * g->reader->result->monitor_report.rtol);

    for (int k = 0; k < g->count; k++)
        if (fabs(halves[k] + halves[g->count + k] - whole[k]) > within * g->size[k] + g->rounding)
            return false;
    return true;
}

/* Halves the pieces that are open, and adds those that agree, or at the last turn all. */
static Status halve(Integral *g, IntegralPieces *open, double **sums, bool is_last, Diag *diag)
{
    IntegralPieces halves = {0};
    double *parts = NULL;
    int left = 0;
    Status status = OK;

    for (int i = 0; i < open->count; i++) {
        const IntegralPiece whole = open->at[i];
        const double middle = (whole.from + whole.to) / 2;

        LIST_PUSH(halves, (IntegralPiece){whole.from, middle, whole.end});
        LIST_PUSH(halves, (IntegralPiece){middle, whole.to, whole.end});
    }
    parts = NEW_ARRAY(double, halves.count * g->count);
    CHECK(sum_pieces(g, &halves, parts, diag));
    for (int i = 0; i < open->count; i++) {
        const double *both = parts + (ptrdiff_t)2 * i * g->count;

        if (!is_last && !agrees(g, *sums + (ptrdiff_t)i * g->count, both)) {
            memmove(parts + (ptrdiff_t)left * g->count, both,
                    2 * (size_t)g->count * sizeof(double));
            halves.at[left++] = halves.at[2 * i];
            halves.at[left++] = halves.at[2 * i + 1];
            continue;
        }
        for (int k = 0; k < g->count; k++)
            g->sums[open->at[i].end * g->count + k] += both[k] + both[g->count + k];
    }
    halves.count = left;
done:
    if (status == OK) {
        const IntegralPieces kept = *open;
        double *kept_sums = *sums;

        *open = halves;
        *sums = parts;
        halves = kept;
        parts = kept_sums;
    }
    LIST_FREE(halves);
    mem_free(parts);
    return status;
}

static Status integrate_pieces(Integral *g, Diag *diag)
{
    IntegralPieces open = {0};
    double *sums = NULL;
    Status status = OK;

    CHECK(integrate_rows(g, diag));
    cut_pieces(g, &open);
    sums = NEW_ARRAY(double, open.count * g->count);
    CHECK(sum_pieces(g, &open, sums, diag));
    for (int i = 0; i < open.count * g->count; i++)
        g->size[i % g->count] += fabs(sums[i]);
    for (int turn = 1; open.count > 0; turn++)
        CHECK(halve(g, &open, &sums, turn == HALVINGS, diag));
    for (int i = g->count; i < g->ends.count * g->count; i++)
        g->sums[i] += g->sums[i - g->count];
done:
    LIST_FREE(open);
    mem_free(sums);
    return status;
}

/* an instant outside the run is refused as a value there is */
static Status check_inside(ResultReader *reader, const double *times, int count, Diag *diag)
{
    for (int i = 0; i < count; i++) {
        const Grid *grid = &reader->result->grid;
        Phase *phase;
        const double *y, *driven;

        if (grid->count == 0 || times[i] < grid->times[0] ||
            times[i] > grid->times[grid->count - 1])
            TRY(result_reader_at(reader, times[i], &phase, &y, &driven, diag));
    }
    return OK;
}

Status result_reader_integrals(ResultReader *reader, const Expr *items, int count,
                               const double *times, int time_count, const CallMonitor *watch,
                               double *out, Diag *diag)
{
    mem_keep(reader);
    Integral g = {.reader = reader, .items = items, .count = count, .watch = watch};
    Status status = OK;

    assert(reader != NULL);
    TRY(check_inside(reader, times, time_count, diag));
    find_ends(&g, times, time_count);
    if (isfinite(reader->result->monitor_report.energy_scale))
        g.rounding = INTEGRAL_ROUNDING * reader->result->monitor_report.energy_scale;
    g.sums = NEW_ARRAY(double, g.ends.count *count);
    g.size = NEW_ARRAY(double, count);
    g.done = NEW_ARRAY(bool, g.ends.count);
    if (g.ends.count > 1)
        CHECK(integrate_pieces(&g, diag));
    for (int i = 0; i < time_count; i++) {
        const ptrdiff_t end = find_end(&g, times[i]);
        const ptrdiff_t place = end >= 0 ? end : times[i] > g.ends.at[0] ? g.ends.count - 1 : 0;

        memcpy(out + (ptrdiff_t)i * count, g.sums + place * count, (size_t)count * sizeof(double));
    }
done:
    LIST_FREE(g.ends);
    MEM_FREE(g.sums, g.size, g.done);
    return status;
}
