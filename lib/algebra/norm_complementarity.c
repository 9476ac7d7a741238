/* norm_complementarity.c: sweeps block by block, then Newton's method
 *
 * Row i has the step s_i = 1/M_ii, of a cone k over the trace of its block: P(z - s w) = z. */
#include "algebra/norm_complementarity.h"

#include <math.h>
#include <string.h>

#define SWEEPS   20    /* before the first try of Newton's method, */
#define MOST     82000 /* and before the last */
#define NEWTON   30    /* steps of it */
#define SOLVED   1e-11 /* of z: what is left of z - P(z - s w), */
#define ROUNDING 1e-15 /* and where no step improves it */
#define REGULAR  1e-13 /* least pivot over the largest entry */
#define DAMPING  1e-9  /* added to the diagonal where rows are dependent */
#define HALVINGS 100   /* of the interval of c */

typedef struct Cones {
    const NormComplementarity *p;
    int n;
    double *z;
    double *step;   /* s; 0: M has nothing there */
    double *left;   /* z - P(z - s w) */
    double *point;  /* z - s w */
    double *kept;   /* z of before, */
    double *rest;   /* and `left` */
    double *matrix; /* n x n */
} Cones;

static double norm_of(const double *v, int count)
{
    double sum = 0;

    for (int i = 0; i < count; i++)
        sum += v[i] * v[i];
    return sqrt(sum);
}

static bool has_load(const Cones *c, int first)
{
    return c->p->load != NULL && c->p->load[first] >= 0;
}

/* r of a cone, or the upper bound of a row */
static double bound_of(const Cones *c, int first)
{
    return has_load(c, first) ? fmax(0, c->p->share[first] * c->z[c->p->load[first]])
                              : c->p->box.high[first];
}

static double low_of(const Cones *c, int i)
{
    return has_load(c, i) ? -bound_of(c, i) : c->p->box.low[i];
}

/* w_i at z */
static double row_of(const Cones *c, int i)
{
    double sum = c->p->box.q[i];

    for (int k = 0; k < c->n; k++)
        sum += c->p->box.matrix[i * c->n + k] * c->z[k];
    return sum;
}

/* (A + shift) x = -b of a block; false: singular. */
static bool solve_block(const Cones *c, int first, int rows, const double *b, double shift,
                        double *x)
{
    double a[CONE_ROWS * CONE_ROWS];

    for (int i = 0; i < rows; i++) {
        for (int k = 0; k < rows; k++)
            a[i * rows + k] =
                c->p->box.matrix[(first + i) * c->n + first + k] + (i == k ? shift : 0);
        x[i] = -b[i];
    }
    return complementarity_eliminate(a, rows, x, REGULAR, 0);
}

/* x where |x| = r, by halving the interval of c: |x| falls as c grows. */
static void meet_bound(const Cones *c, int first, int rows, const double *b, double *x)
{
    const double r = bound_of(c, first);
    double low = 0, high = norm_of(b, rows) / r, size;

    for (int turn = 0; turn < HALVINGS; turn++) {
        const double middle = (low + high) / 2;

        if (!(middle > low) || !(middle < high))
            break;
        if (solve_block(c, first, rows, b, middle, x) && norm_of(x, rows) <= r)
            high = middle;
        else
            low = middle;
    }
    (void)solve_block(c, first, rows, b, high, x);
    size = norm_of(x, rows);
    for (int i = 0; i < rows && size > 0; i++)
        x[i] *= r / size;
}

/* z of a cone alone, with the others as they are: A z = -b, or (A + c) z = -b with |z| = r */
static void sweep_cone(const Cones *c, int first, int rows)
{
    const double r = bound_of(c, first);
    double b[CONE_ROWS], x[CONE_ROWS] = {0};
    double size;

    for (int i = 0; i < rows; i++) {
        b[i] = row_of(c, first + i);
        for (int k = 0; k < rows; k++)
            b[i] -= c->p->box.matrix[(first + i) * c->n + first + k] * c->z[first + k];
    }
    if (r > 0 && (!solve_block(c, first, rows, b, 0, x) || norm_of(x, rows) > r)) {
        if (!(norm_of(b, rows) > 0))
            return;
        meet_bound(c, first, rows, b, x);
    }
    size = norm_of(x, rows);
    for (int i = 0; i < rows; i++)
        c->z[first + i] = r == 0 ? 0 : c->p->slips[first] && size > 0 ? x[i] * r / size : x[i];
}

static void sweep_row(const Cones *c, int i)
{
    const double low = low_of(c, i), high = bound_of(c, i);
    const double own = c->p->box.matrix[i * c->n + i];
    const double w = row_of(c, i);

    if (own > 0)
        c->z[i] = fmax(low, fmin(high, c->z[i] - w / own));
    else
        c->z[i] = w > 0 || !isfinite(high) ? low : high;
}

static void sweep(const Cones *c)
{
    for (int i = 0; i < c->n; i++) {
        if (c->p->rows[i] == 1)
            sweep_row(c, i);
        else if (c->p->rows[i] > 1)
            sweep_cone(c, i, c->p->rows[i]);
    }
}

/* the first row of the cone that row i belongs to */
static int first_of(const Cones *c, int i)
{
    while (c->p->rows[i] == 0)
        i--;
    return i;
}

static void find_steps(const Cones *c)
{
    for (int i = 0; i < c->n; i++) {
        const int first = first_of(c, i), rows = c->p->rows[first];
        double trace = 0;

        for (int k = first; k < first + rows; k++)
            trace += c->p->box.matrix[k * c->n + k];
        c->step[i] = trace > 0 ? rows / trace : 1;
    }
}

/* what is left of the equations at z, the largest of it over the size of z */
static double find_left(const Cones *c)
{
    double largest = 0, size = 0;

    for (int i = 0; i < c->n; i++) {
        c->point[i] = c->z[i] - c->step[i] * row_of(c, i);
        size = fmax(size, fabs(c->z[i]));
    }
    for (int i = 0; i < c->n; i++) {
        const int first = first_of(c, i), rows = c->p->rows[first];
        double at = c->point[i];

        if (rows == 1)
            at = fmax(low_of(c, i), fmin(bound_of(c, i), at));
        else {
            const double norm = norm_of(c->point + first, rows), r = bound_of(c, first);

            if (norm > r || (c->p->slips[first] && norm > 0))
                at *= r / norm;
        }
        c->left[i] = c->z[i] - at;
        largest = fmax(largest, fabs(c->left[i]));
    }
    return largest / fmax(size, 1e-300);
}

/* row i of the derivative of z - P(z - s w) */
static void derive_row(const Cones *c, int i)
{
    const int n = c->n, first = first_of(c, i), rows = c->p->rows[first];
    const double norm = norm_of(c->point + first, rows);
    const double r = bound_of(c, first);
    double *row = c->matrix + (ptrdiff_t)i * n;
    bool is_at_bound;

    if (rows == 1)
        is_at_bound = c->point[i] < low_of(c, i) || c->point[i] > r;
    else
        is_at_bound = norm > r || c->p->slips[first];
    for (int k = 0; k < n; k++)
        row[k] = is_at_bound ? 0 : c->step[i] * c->p->box.matrix[i * n + k];
    if (!is_at_bound)
        return;
    row[i] = 1;
    for (int j = first; j < first + rows && rows > 1 && norm > 0; j++) {
        const double share =
            r / norm * ((i == j) - c->point[i] * c->point[j] / (norm * norm)); /* dP_i/dp_j */

        row[j] -= share;
        for (int k = 0; k < n; k++)
            row[k] += share * c->step[j] * c->p->box.matrix[j * n + k];
    }
    if (has_load(c, first) && norm > 0 && r > 0)
        row[c->p->load[first]] -= c->p->share[first] * c->point[i] / norm; /* dP_i/dr dr/dz */
}

/* The step, in place of `left`. Where rows are dependent it is nearly the shortest one. */
static bool find_move(const Cones *c)
{
    const size_t bytes = (size_t)c->n * sizeof(double);

    memcpy(c->rest, c->left, bytes);
    for (int turn = 0; turn < 2; turn++) {
        for (int i = 0; i < c->n; i++) {
            derive_row(c, i);
            c->matrix[i * c->n + i] += turn == 0 ? 0 : DAMPING;
        }
        if (complementarity_eliminate(c->matrix, c->n, c->left, REGULAR, 0))
            return true;
        memcpy(c->left, c->rest, bytes);
    }
    return false;
}

/* False: it didn't converge; z is as before. */
static bool newton(const Cones *c)
{
    const size_t bytes = (size_t)c->n * sizeof(double);
    double left = find_left(c);

    memcpy(c->kept, c->z, bytes);
    for (int turn = 0; turn < NEWTON && left > ROUNDING; turn++) {
        double before = left;

        if (!find_move(c))
            break;
        for (int i = 0; i < c->n; i++)
            c->z[i] -= c->left[i];
        left = find_left(c);
        if (left <= SOLVED && left >= 0.5 * before)
            break;
    }
    if (left <= SOLVED)
        return true;
    memcpy(c->z, c->kept, bytes);
    return false;
}

static void read_sides(const Cones *c, int *side)
{
    (void)find_left(c);
    for (int i = 0; i < c->n; i++) {
        const int first = first_of(c, i), rows = c->p->rows[first];

        if (rows == 1)
            side[i] = c->point[i] < low_of(c, i)     ? AT_LOW
                      : c->point[i] > bound_of(c, i) ? AT_HIGH
                                                     : BETWEEN;
        else
            side[i] = c->p->slips[first] || norm_of(c->point + first, rows) > bound_of(c, first)
                          ? AT_HIGH
                          : BETWEEN;
    }
}

bool norm_complementarity_solve(const NormComplementarity *problem, int *side, double *z,
                                double *room)
{
    const int n = problem->box.n;
    Cones c = {.p = problem, .n = n};
    int swept = 0;
    bool found = false;

    c.z = z;
    c.step = room;
    c.left = room + n;
    c.point = room + (ptrdiff_t)2 * n;
    c.kept = room + (ptrdiff_t)3 * n;
    c.rest = room + (ptrdiff_t)4 * n;
    c.matrix = room + (ptrdiff_t)5 * n;
    find_steps(&c);
    for (int most = SWEEPS; most <= MOST && !found; most *= 4) {
        for (; swept < most; swept++)
            sweep(&c);
        found = newton(&c) || find_left(&c) <= SOLVED;
    }
    if (found)
        read_sides(&c, side);
    return found;
}
