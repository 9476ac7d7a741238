/* between.c: results between their rows, by interpolation and projection */
#include "simulate/run/result.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

#define TURNED 0.25 /* rad: parts of what lies between two rows, for counting turns */

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

/* what is known at one end of an interval in which one phase goes on */
typedef struct End {
    double t;
    Phase *phase;
    const double *y, *driven;
    double *rate; /* of y */
} End;

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

static End row_end(const Result *r, int row)
{
    return (End){.t = r->grid.times[row],
                 .phase = result_phase(r, row),
                 .y = grid_row(&r->grid, row),
                 .driven = result_driven(r, row)};
}

static End corner_end(const Result *r, int corner)
{
    return (End){.t = r->corners.times[corner],
                 .phase = r->phases.at[r->corners.phase[corner]],
                 .y = grid_row(&r->corners, corner)};
}

/* The nearest ends around t, the same one twice where it is at t or behind the last row; false
 * outside the run. */
static bool find_ends(const Result *r, double t, End ends[2])
{
    const Grid *grid = &r->grid;
    int row = last_row(grid, t), corner = last_row(&r->corners, t);

    if (grid->count == 0 || !(t >= grid->times[0] - 1e-9 * fabs(grid->times[0])) ||
        !(t <= grid->times[grid->count - 1] + 1e-9 * fabs(grid->times[grid->count - 1])))
        return false;
    row = row < 0 ? 0 : row;
    ends[0] = ends[1] = row_end(r, row);
    if (row == grid->count - 1 || ends[0].t == t)
        return true;
    ends[1] = row_end(r, row + 1);
    if (corner >= 0 && r->corners.times[corner] >= ends[0].t)
        ends[0] = corner_end(r, corner);
    if (corner + 1 < r->corners.count && r->corners.times[corner + 1] <= ends[1].t)
        ends[1] = corner_end(r, corner + 1);
    if (ends[0].t == t)
        ends[1] = ends[0];
    return true;
}

static bool find_rate(End *end)
{
    const Layout *l = end->phase->layout;
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

static void interpolate(const End *a, const End *b, double t, double *y)
{
    const Layout *l = a->phase->layout;
    double h = b->t - a->t;
    double s = (t - a->t) / h;

    for (int i = 0; i < a->phase->length; i++)
        y[i] = cubic(a->y[i], a->rate[i], b->y[i], b->rate[i], h, s);
    if (numbers_equations(a->phase->numbers)->map != NULL)
        return;
    for (int i = 0; i < l->n; i++) { /* q'' is u' */
        const double at_ends[2][3] = {{a->y[i], a->y[l->n + i], a->rate[l->n + i]},
                                      {b->y[i], b->y[l->n + i], b->rate[l->n + i]}};

        y[i] = quintic(at_ends[0], at_ends[1], h, s, &y[l->n + i]);
    }
}

/* References of angles at t, from those of the end before it: in parts that no angle turns far in.
 * y, from its interpolation, keeps what else it has. */
static void follow_turns(const End *a, const End *b, double t, double *y)
{
    enum { MOST_PARTS = 1000000 };
    const Layout *l = a->phase->layout;
    double *there = NEW_ARRAY(double, a->phase->length);
    int first = layout_turned(l), parts;
    const double *kept = a->y + first;
    double fastest = 0;

    for (int k = first; k < first + l->turned; k++)
        fastest = fmax(fastest, fmax(fabs(a->rate[k]), fabs(b->rate[k])));
    parts = (int)fmin(MOST_PARTS, ceil(fastest * (t - a->t) / TURNED));
    for (int i = 1; i <= parts; i++) {
        double at = a->t + (t - a->t) * i / parts;

        interpolate(a, b, at, there);
        memcpy(there + first, kept, (size_t)l->turned * sizeof(double));
        equations_turn(numbers_equations(a->phase->numbers), at, there, there + first);
        memcpy(y + first, there + first, (size_t)l->turned * sizeof(double));
        kept = y + first;
    }
    mem_free(there);
}

/* y at t, of the phase of the ends */
static bool find_between(End ends[2], double t, double *y)
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
    if (sound) {
        interpolate(&ends[0], &ends[1], t, y);
        if (ends[0].phase->layout->turned > 0)
            follow_turns(&ends[0], &ends[1], t, y);
        sound = motion_project(ends[0].phase->motion, t, y);
    }
    mem_free(rates);
    return sound;
}

bool result_between(Result *r, double t, Phase **phase, double **y)
{
    End ends[2];

    if (!find_ends(r, t, ends))
        return false;
    *phase = ends[0].phase;
    *y = NEW_ARRAY(double, ends[0].phase->length);
    if (find_between(ends, t, *y))
        return true;
    mem_free(*y);
    *y = NULL;
    return false;
}

/* efforts of a driven run, straight between rows; new, NULL where it is none */
static double *driven_between(const Result *r, double t)
{
    int row = last_row(&r->grid, t), next;
    double *driven, h, s;

    if (r->driven.values == NULL)
        return NULL;
    row = row < 0 ? 0 : row;
    next = row < r->grid.count - 1 ? row + 1 : row;
    h = r->grid.times[next] - r->grid.times[row];
    s = h > 0 ? (t - r->grid.times[row]) / h : 0;
    driven = NEW_ARRAY(double, r->driven.length);
    for (int i = 0; i < r->driven.length; i++)
        driven[i] = (1 - s) * result_driven(r, row)[i] + s * result_driven(r, next)[i];
    return driven;
}

Status result_values_at(Result *r, const Expr *items, int count, double at, double *out, Diag *diag)
{
    int rows = r->grid.count;
    Phase *phase = r->phase;
    double *y = NULL, *driven = NULL;
    Probe *probe = NULL;
    bool found = result_between(r, at, &phase, &y);
    Status status = OK;

    CHECK(result_probe(r, phase, items, count, &probe, diag));
    if (!found)
        CHECK(diag_set(diag, E_VALUE,
                       "t = %.6g s is outside the run, which goes from %.6g to "
                       "%.6g s",
                       at, rows > 0 ? r->grid.times[0] : 0,
                       rows > 0 ? r->grid.times[rows - 1] : 0));
    driven = driven_between(r, at);
    result_probe_at(phase, probe, at, y, driven, count, out);
done:
    probe_free(probe);
    mem_free(driven);
    mem_free(y);
    return status;
}
