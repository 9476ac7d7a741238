/* dense_output.c: results between their rows
 *
 * Rows may be far apart, and interpolation doesn't know what happened between them. So that part of
 * the run is integrated again, from the row or corner before to the one after, and its steps are
 * interpolated at the requested times. A result that was not integrated is interpolated: positions
 * are projected onto constraints and drivers, which determine all the rest. */
#include "simulate/run/result_reader_impl.h"

#include "base/memory.h"
#include "simulate/run/inverse.h"
#include "simulate/run/run_limits.h"

#include <math.h>
#include <string.h>

/* Hermite polynomial of degree 5 through value, rate and second rate at both ends (s in 0..1),
 * and its rate */
static double quintic(const double a[3], const double b[3], double h, double s, double *rate)
{
    double d = b[0] - a[0] - h * a[1] - h * h / 2 * a[2];
    double e = h * (b[1] - a[1]) - h * h * a[2];
    double f = h * h * (b[2] - a[2]);
    double c3 = 10 * d - 4 * e + f / 2, c4 = -15 * d + 7 * e - f, c5 = 6 * d - 3 * e + f / 2;

    *rate = a[1] + s * h * a[2] + s * s * (3 * c3 + s * (4 * c4 + s * 5 * c5)) / h;
    return a[0] + s * h * (a[1] + s * h / 2 * a[2]) + s * s * s * (c3 + s * (c4 + s * c5));
}

static double cubic(double a, double a_rate, double b, double b_rate, double h, double s)
{
    double d = b - a;

    return a + s * d + s * (s - 1) * ((1 - 2 * s) * d + (s - 1) * h * a_rate + s * h * b_rate);
}

/* what is known at one end of an interval in which one phase holds */
typedef struct StepEnd {
    double t;
    Phase *phase;
    const double *y, *driven;
    bool is_sampled; /* samples that are due are taken, as in a row only at the start */
    double *rate;    /* of y */
} StepEnd;

/* the last row up to t; -1: there is none */
static int last_row(const Grid *grid, double t)
{
    int low = -1, high = grid->count;

    while (high - low > 1) {
        int middle = low + (high - low) / 2;

        if (grid->times[middle] <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static StepEnd row_end(const ResultReader *reader, int row)
{
    const Result *r = reader->result;

    return (StepEnd){.t = r->grid.times[row],
                     .phase = reader->phases->at[r->grid.phase[row]],
                     .y = grid_row(&r->grid, row),
                     .is_sampled = row == 0,
                     .driven = driven_row(&r->driven, row)};
}

static StepEnd corner_end(const ResultReader *reader, int corner)
{
    const Grid *corners = &reader->result->corners;

    return (StepEnd){.t = corners->times[corner],
                     .phase = reader->phases->at[corners->phase[corner]],
                     .y = grid_row(corners, corner),
                     .is_sampled = true};
}

/* The nearest ends around t, twice the same where one is at t or t is after the last row; false
 * outside the run. */
static bool find_ends(const ResultReader *reader, double t, StepEnd ends[2])
{
    const Grid *grid = &reader->result->grid, *corners = &reader->result->corners;
    int row = last_row(grid, t), corner = last_row(corners, t);

    if (grid->count == 0 || !(t >= grid->times[0] - 1e-9 * fabs(grid->times[0])) ||
        !(t <= grid->times[grid->count - 1] + 1e-9 * fabs(grid->times[grid->count - 1])))
        return false;
    row = row < 0 ? 0 : row;
    ends[0] = ends[1] = row_end(reader, row);
    if (row == grid->count - 1 || ends[0].t == t)
        return true;
    ends[1] = row_end(reader, row + 1);
    if (corner >= 0 && corners->times[corner] >= ends[0].t)
        ends[0] = corner_end(reader, corner);
    if (corner + 1 < corners->count && corners->times[corner + 1] <= ends[1].t)
        ends[1] = corner_end(reader, corner + 1);
    if (ends[0].t == t)
        ends[1] = ends[0];
    return true;
}

static bool find_rate(StepEnd *end)
{
    const VariableIndex *l = end->phase->layout;
    const Ode *ode = motion_ode(end->phase->motion);

    phase_enter(end->phase);
    if (!ode->rate(ode->context, end->t, end->y, end->rate))
        return false;
    if (end->driven != NULL) {
        memcpy(end->rate + l->n, end->driven + l->nx + l->nz, (size_t)l->nu * sizeof(double));
        memcpy(end->rate + l->n + l->nu, end->driven, (size_t)l->nx * sizeof(double));
    }
    return true;
}

/* cubic()'s rate */
static double cubic_rate(double a, double a_rate, double b, double b_rate, double h, double s)
{
    return 6 * s * (1 - s) * (b - a) / h + (1 - s) * (1 - 3 * s) * a_rate +
           s * (3 * s - 2) * b_rate;
}

/* Where the accelerations at an end mean nothing, as at a singular position, positions and speeds
 * alone are interpolated. */
static void interpolate(const StepEnd *a, const StepEnd *b, bool with_accelerations, double t,
                        double *y)
{
    const VariableIndex *l = a->phase->layout;
    double h = b->t - a->t;
    double s = (t - a->t) / h;

    for (int i = 0; i < a->phase->length; i++)
        y[i] = cubic(a->y[i], a->rate[i], b->y[i], b->rate[i], h, s);
    if (compiled_equations(a->phase->numbers)->map != NULL)
        return;
    for (int i = 0; i < l->n; i++) { /* q'' is u' */
        const double at_ends[2][3] = {{a->y[i], a->y[l->n + i], a->rate[l->n + i]},
                                      {b->y[i], b->y[l->n + i], b->rate[l->n + i]}};

        if (with_accelerations)
            y[i] = quintic(at_ends[0], at_ends[1], h, s, &y[l->n + i]);
        else
            y[l->n + i] = cubic_rate(a->y[i], a->rate[i], b->y[i], b->rate[i], h, s);
    }
}

/* References of angles at t from those of the end before it, in parts over which no angle turns
 * far. y contains the interpolated values of everything else. */
static void follow_turns(const StepEnd *a, const StepEnd *b, bool with_accelerations, double t,
                         double *y)
{
    enum { MOST_PARTS = 1000000 };
    const VariableIndex *l = a->phase->layout;
    double *there = NEW_ARRAY(double, a->phase->length);
    int first = variable_index_references(l), parts;
    const double *kept = a->y + first;
    double fastest = 0;

    for (int k = first; k < first + l->multi_turns; k++)
        fastest = fmax(fastest, fmax(fabs(a->rate[k]), fabs(b->rate[k])));
    parts = (int)fmin(MOST_PARTS, ceil(fastest * (t - a->t) / DENSE_TURN));
    for (int i = 1; i <= parts; i++) {
        double at = a->t + (t - a->t) * i / parts;

        interpolate(a, b, with_accelerations, at, there);
        memcpy(there + first, kept, (size_t)l->multi_turns * sizeof(double));
        equations_turn(compiled_equations(a->phase->numbers), at, there, there + first);
        memcpy(y + first, there + first, (size_t)l->multi_turns * sizeof(double));
        kept = y + first;
    }
    mem_free(there);
}

/* Project y. Near a singular position Newton's method with one factorisation converges slowly: it
 * begins anew where it got to, unless that is far away, perhaps on another branch. */
static bool project_between(const Phase *phase, double t, double *y)
{
    const size_t bytes = (size_t)phase->length * sizeof(double);
    double *first = NEW_ARRAY(double, phase->length), moved = 0;
    bool sound;

    memcpy(first, y, bytes);
    phase_enter(phase);
    sound = motion_project(phase->motion, t, y);
    for (int again = 0; again < DENSE_PROJECTIONS && !sound && moved < DENSE_MISSED_BRANCH;
         again++) {
        sound = motion_project(phase->motion, t, y);
        for (int i = 0; i < phase->layout->n; i++)
            if (!(fabs(y[i] - first[i]) <= moved))
                moved = fabs(y[i] - first[i]);
    }
    mem_free(first);
    return sound && moved < DENSE_MISSED_BRANCH;
}

static bool place_between(const StepEnd ends[2], bool with_accelerations, double t, double *y)
{
    interpolate(&ends[0], &ends[1], with_accelerations, t, y);
    if (ends[0].phase->layout->multi_turns > 0)
        follow_turns(&ends[0], &ends[1], with_accelerations, t, y);
    return project_between(ends[0].phase, t, y);
}

/* y at t, for the phase of the ends */
static bool find_between(StepEnd ends[2], double t, double *y)
{
    int length = ends[0].phase->length;
    double *rates;
    bool sound;

    if (ends[0].y == ends[1].y) {
        memcpy(y, ends[0].y, (size_t)length * sizeof(double));
        return true;
    }
    rates = NEW_ARRAY(double, 2 * length);
    ends[0].rate = rates;
    ends[1].rate = rates + length;
    sound = ends[0].phase == ends[1].phase && find_rate(&ends[0]) && find_rate(&ends[1]);
    if (sound)
        sound = place_between(ends, true, t, y) || place_between(ends, false, t, y);
    mem_free(rates);
    return sound;
}

/* --- repeated integration --- */

static bool is_integrated(const Result *r)
{
    return r->kind != RUN_START && r->monitor_report.method != NULL &&
           method_find(r->monitor_report.method) != NULL;
}

/* from one end to the other with the method of the run and the steps that it would have taken */
static Status go_again(ResultReader *reader, const StepEnd ends[2], const double *times, int count,
                       const CallMonitor *watch, Diag *diag)
{
    const Result *r = reader->result;
    const Grid *grid = &r->grid;
    IntegrationPlan plan = {.segment = phases_segment(ends[0].phase, NULL),
                            .method = method_find(r->monitor_report.method),
                            .control = {.rtol = r->monitor_report.rtol,
                                        .atol = r->monitor_report.atol,
                                        .step = r->monitor_report.step,
                                        .most = r->monitor_report.most},
                            .from = ends[0].t,
                            .to = ends[1].t,
                            .every = r->monitor_report.every,
                            .times = times,
                            .time_count = count,
                            .jumps = &r->jumps,
                            .span = grid->times[grid->count - 1] - grid->times[0],
                            .skip_first = true,
                            .is_sampled = ends[0].is_sampled,
                            .watch = watch};
    IntegrationReport monitor_report;
    const Status status = integrate(&plan, ends[0].y, &reader->asked, &monitor_report, diag);

    remarks_free(&monitor_report.remarks);
    LIST_FREE(monitor_report.jumps);
    return status;
}

/* Rows at times between two ends. */
static Status fill_between(ResultReader *reader, StepEnd ends[2], const double *times, int count,
                           const CallMonitor *watch, Diag *diag)
{
    double *y;
    Status status = OK;

    /* a mode that ends at a row is followed by the next mode there: an interval before it starts
     * after it */
    if (is_integrated(reader->result))
        return go_again(reader, ends, times, count, watch, diag);
    if (ends[0].phase != ends[1].phase)
        return OK;
    y = NEW_ARRAY(double, ends[0].phase->length);
    for (int i = 0; i < count; i++) {
        if (!find_between(ends, times[i], y))
            CHECK(solver_failure(diag, times[i], "the constraints can't be met"));
        grid_add(&reader->asked, times[i], ends[0].phase->number, y, ends[0].phase->length);
    }
done:
    mem_free(y);
    return status;
}

/* The number of ascending times before `end`; the first counts in any case. */
static int count_until(const double *times, int count, double end)
{
    int i = 1;

    while (i < count && times[i] > times[i - 1] && times[i] < end)
        i++;
    return i;
}

static Status fill(ResultReader *reader, const double *times, int count, const CallMonitor *watch,
                   Diag *diag)
{
    const double end = count > 0 ? times[count - 1] : 0;

    grid_free(&reader->asked);
    for (int i = 0, group; i < count; i += group) {
        const Grid *asked = &reader->asked;
        const double last = asked->count > 0 ? asked->times[asked->count - 1] : -INFINITY;
        StepEnd ends[2];

        group = 1;
        TRY(monitor_poll(watch));
        monitor_report(watch, "between rows", end > 0 ? times[i] / end : 0);
        if (!(times[i] > last) || !find_ends(reader, times[i], ends) || ends[0].y == ends[1].y)
            continue;
        group = count_until(times + i, count - i, ends[1].t);
        TRY(fill_between(reader, ends, times + i, group, watch, diag));
    }
    if (reader->result->driven.values != NULL && reader->asked.count > 0)
        TRY(inverse_solve(reader->phases, &reader->result->start, &reader->asked, NULL,
                          &reader->asked_driven, diag));
    return OK;
}

Status result_reader_prepare(ResultReader *reader, const double *times, int count,
                             const CallMonitor *watch, Diag *diag)
{
    mem_keep(reader);
    Diag ignored = {0};
    const Status status = fill(reader, times, count, watch, &ignored);

    return status == E_STOPPED ? diag_set(diag, status, "%s", ignored.message) : OK;
}

/* the stored row at t; -1: none */
static int asked_row(const ResultReader *reader, double t)
{
    const int row = last_row(&reader->asked, t);

    return row >= 0 &&
                   t - reader->asked.times[row] <= SAME_TIME * reader->result->monitor_report.every
               ? row
               : -1;
}

Status result_reader_at(ResultReader *reader, double t, Phase **phase, const double **y,
                        const double **driven, Diag *diag)
{
    mem_keep(reader);
    mem_keep(reader->phases);
    const Grid *grid = &reader->result->grid;
    StepEnd ends[2];
    int row;

    if (!find_ends(reader, t, ends) && reader->result->grid.count < 2) {
        (void)diag_set(diag, E_VALUE, "there is no run yet that goes to t = %.6g s", t);
        diag_hint(diag, "'simulate 10' makes one; without 'at' it is asked of the start");
        return E_VALUE;
    }
    if (!find_ends(reader, t, ends))
        return diag_set(diag, E_VALUE,
                        "t = %.6g s is outside the run, which goes from %.6g to %.6g s", t,
                        grid->count > 0 ? grid->times[0] : 0,
                        grid->count > 0 ? grid->times[grid->count - 1] : 0);
    *phase = ends[0].phase;
    *y = ends[0].y;
    *driven = ends[0].driven;
    if (ends[0].y == ends[1].y)
        return OK;
    if (asked_row(reader, t) < 0)
        TRY(fill(reader, &t, 1, NULL, diag));
    row = asked_row(reader, t);
    if (row < 0)
        TRY(solver_failure(diag, t, "the run has no value between two of its rows"));
    *phase = reader->phases->at[reader->asked.phase[row]];
    *y = grid_row(&reader->asked, row);
    *driven = driven_row(&reader->asked_driven, row);
    return OK;
}
