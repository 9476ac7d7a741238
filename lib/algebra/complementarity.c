/* complementarity.c: exchange of blocks, Lemke's method, all sides
 *
 * Solved in scaled unknowns: D M D with |diagonal| 1, D q, z/D. */
#include "algebra/complementarity.h"

#include <math.h>
#include <string.h>

#define RIGHT     1e-9  /* of the largest w: an inequality holds within this, */
#define INSIDE    1e-9  /* of z's interval, or of 1: and so does a bound */
#define REGULAR   1e-10 /* least pivot over the largest entry of its column */
#define PIVOT     1e-11 /* least pivot in Lemke's tableau, over its largest column entry */
#define ROUNDS    10    /* exchanges of blocks without progress */
#define EXCHANGES 50    /* and with it, and 20 an unknown */
#define PIVOTS    50    /* of Lemke's method, an unknown */
#define FEW       9     /* unknowns whose sides are all tried: three contacts with friction */

typedef struct Scaled {
    int n;
    double *matrix, *q, *low, *high, *scale; /* of the scaled problem */
    double *z, *w;
    double *factor;  /* n x n */
    double *tableau; /* of Lemke's method */
    double largest;  /* of w where z is at a bound or 0 */
} Scaled;

static double *take(double **room, size_t count)
{
    double *out = *room;

    *room += count;
    return out;
}

static double finite_bound(double bound)
{
    return isfinite(bound) ? fabs(bound) : 0;
}

static Scaled scale_problem(const Complementarity *p, double *room)
{
    const int n = p->n;
    const size_t count = (size_t)n;
    Scaled s = {.n = n};

    s.matrix = take(&room, count * count);
    s.factor = take(&room, count * count);
    s.q = take(&room, count);
    s.low = take(&room, count);
    s.high = take(&room, count);
    s.scale = take(&room, count);
    s.z = take(&room, count);
    s.w = take(&room, count);
    s.tableau = take(&room, 0);
    for (int i = 0; i < n; i++) {
        const double diagonal = fabs(p->matrix[i * n + i]);

        s.scale[i] = diagonal > 0 ? 1 / sqrt(diagonal) : 1;
    }
    for (int i = 0; i < n; i++) {
        double sum;

        s.q[i] = p->q[i] * s.scale[i];
        s.low[i] = p->low[i] / s.scale[i];
        s.high[i] = p->high[i] / s.scale[i];
        sum = fabs(s.q[i]);
        for (int k = 0; k < n; k++) {
            s.matrix[i * n + k] = p->matrix[i * n + k] * s.scale[i] * s.scale[k];
            sum += fabs(s.matrix[i * n + k]) *
                   fmax(finite_bound(p->low[k]), finite_bound(p->high[k])) / s.scale[k];
        }
        s.largest = fmax(s.largest, sum);
    }
    return s;
}

static double bound_on(const Scaled *s, int i, int side)
{
    return side == AT_LOW ? s->low[i] : s->high[i];
}

bool complementarity_eliminate(double *a, int n, double *b, double regular, double least)
{
    for (int k = 0; k < n; k++) {
        int best = k;
        double size = least;

        for (int i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[best * n + k]))
                best = i;
        for (int i = 0; i < n; i++)
            size = fmax(size, fabs(a[i * n + k]));
        if (!(fabs(a[best * n + k]) > regular * size))
            return false;
        for (int j = 0; j < n && best != k; j++) {
            const double kept = a[k * n + j];

            a[k * n + j] = a[best * n + j];
            a[best * n + j] = kept;
        }
        if (best != k) {
            const double kept = b[k];

            b[k] = b[best];
            b[best] = kept;
        }
        for (int i = k + 1; i < n; i++) {
            const double factor = a[i * n + k] / a[k * n + k];

            for (int j = k + 1; j < n && factor != 0; j++)
                a[i * n + j] -= factor * a[k * n + j];
            b[i] -= factor * b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++)
            b[i] -= a[i * n + j] * b[j];
        b[i] /= a[i * n + i];
    }
    return true;
}

/* z and w with the unknowns on these sides. False: rows of those BETWEEN are dependent. */
static bool solve_sides(const Scaled *s, const int *side)
{
    const int n = s->n;
    int between = 0;

    for (int i = 0; i < n; i++)
        s->z[i] = side[i] != BETWEEN ? bound_on(s, i, side[i]) : 0;
    for (int i = 0; i < n; i++) {
        int column = 0;

        if (side[i] != BETWEEN)
            continue;
        s->w[between] = -s->q[i];
        for (int k = 0; k < n; k++)
            s->w[between] -= s->matrix[i * n + k] * s->z[k];
        for (int k = 0; k < n; k++)
            column += side[k] == BETWEEN;
        for (int k = 0, at = 0; k < n; k++)
            if (side[k] == BETWEEN)
                s->factor[between * column + at++] = s->matrix[i * n + k];
        between++;
    }
    if (between > 0 && !complementarity_eliminate(s->factor, between, s->w, REGULAR, 1))
        return false;
    for (int i = 0, at = 0; i < n; i++)
        if (side[i] == BETWEEN)
            s->z[i] = s->w[at++];
    for (int i = 0; i < n; i++) {
        s->w[i] = s->q[i];
        for (int k = 0; k < n; k++)
            s->w[i] += s->matrix[i * n + k] * s->z[k];
    }
    return true;
}

/* Whether unknown i is right on its side; if not, *better is the side that it has to go to. */
static bool is_right(const Scaled *s, const int *side, int i, int *better)
{
    const bool may_stay = !(s->matrix[i * s->n + i] < 0);
    const double width = s->high[i] - s->low[i];
    const double allowance = INSIDE * (isfinite(width) ? fmax(width, 1e-300) : 1);

    if (side[i] == BETWEEN) {
        *better = s->z[i] < s->low[i] ? AT_LOW : AT_HIGH;
        return s->z[i] >= s->low[i] - allowance && s->z[i] <= s->high[i] + allowance && may_stay;
    }
    *better = may_stay ? BETWEEN : -side[i];
    return side[i] == AT_LOW ? s->w[i] >= -RIGHT * s->largest : s->w[i] <= RIGHT * s->largest;
}

static bool is_solution(const Scaled *s, const int *side)
{
    int better;

    for (int i = 0; i < s->n; i++)
        if (!is_right(s, side, i, &better))
            return false;
    return true;
}

/* All that are wrong go over together; after ROUNDS without progress only the last of them, which
 * ends where M is a P-matrix (Murty). */
static bool exchange_blocks(const Scaled *s, int *side)
{
    int fewest = s->n + 1, rounds = ROUNDS;

    for (int turn = 0; turn < EXCHANGES + 20 * s->n; turn++) {
        int wrong = 0, last = -1, better;

        if (!solve_sides(s, side))
            return false;
        for (int i = 0; i < s->n; i++)
            if (!is_right(s, side, i, &better)) {
                wrong++;
                last = i;
            }
        if (wrong == 0)
            return true;
        if (wrong < fewest) {
            fewest = wrong;
            rounds = ROUNDS;
        } else {
            rounds--;
        }
        for (int i = 0; i < s->n; i++)
            if ((rounds > 0 || i == last) && !is_right(s, side, i, &better))
                side[i] = better;
    }
    return false;
}

/* --- Lemke's method ---
 *
 * With x = z - l >= 0 and y >= 0 the multiplier of x <= u - l:
 *
 *     w1 = M x + y + (q + M l) >= 0  complementary to x
 *     w2 = (u - l) - x         >= 0  complementary to y, where u is finite
 *
 * The tableau has a column for each of w = (w1, w2), v = (x, y), z0, and the right side. */

typedef struct Lemke {
    int n, rows, width;
    double *at; /* rows x width */
    int *basis; /* by row: the variable that is basic, by its column */
} Lemke;

static double *row_of(const Lemke *t, int i)
{
    return t->at + (ptrdiff_t)i * t->width;
}

/* Whether row a has a smaller ratio than row b for the entering column, and by the columns of w
 * where they are equal: then no basis comes twice. */
static bool is_less(const Lemke *t, int a, int b, int column)
{
    const double *first = row_of(t, a), *second = row_of(t, b);
    const double p = first[column], r = second[column];

    for (int k = -1; k < t->rows; k++) {
        const int at = k < 0 ? t->width - 1 : k;
        const double left = first[at] / p, right = second[at] / r;

        if (fabs(left - right) > 1e-13 * fmax(fabs(left), fabs(right)))
            return left < right;
    }
    return a < b;
}

static void pivot(Lemke *t, int row, int column)
{
    double *pivoted = row_of(t, row);
    const double by = 1 / pivoted[column];

    for (int j = 0; j < t->width; j++)
        pivoted[j] *= by;
    pivoted[column] = 1;
    for (int i = 0; i < t->rows; i++) {
        double *other = row_of(t, i);
        const double factor = other[column];

        if (i == row || factor == 0)
            continue;
        for (int j = 0; j < t->width; j++)
            other[j] -= factor * pivoted[j];
        other[column] = 0;
    }
    t->basis[row] = column;
}

/* the row that leaves as that column enters; -1: none, a ray */
static int leaving_row(const Lemke *t, int column)
{
    const int artificial = 2 * t->rows;
    double largest = 0;
    int found = -1;

    for (int i = 0; i < t->rows; i++)
        largest = fmax(largest, fabs(row_of(t, i)[column]));
    for (int i = 0; i < t->rows; i++) {
        if (!(row_of(t, i)[column] > PIVOT * fmax(largest, 1)))
            continue;
        if (found < 0 || is_less(t, i, found, column))
            found = i;
    }
    /* the artificial variable leaves where it may: that ends the search */
    for (int i = 0; i < t->rows && found >= 0; i++)
        if (t->basis[i] == artificial && row_of(t, i)[column] > PIVOT * fmax(largest, 1)) {
            const double own = row_of(t, i)[t->width - 1] / row_of(t, i)[column];
            const double least = row_of(t, found)[t->width - 1] / row_of(t, found)[column];

            if (own <= least * (1 + 1e-13))
                return i;
        }
    return found;
}

static void fill_tableau(const Scaled *s, Lemke *t)
{
    const int n = s->n;

    memset(t->at, 0, (size_t)t->rows * (size_t)t->width * sizeof(double));
    for (int i = 0; i < n; i++) {
        double *first = row_of(t, i), *second = row_of(t, n + i);
        double right = s->q[i];

        for (int k = 0; k < n; k++) {
            first[t->rows + k] = -s->matrix[i * n + k];
            right += s->matrix[i * n + k] * s->low[k];
        }
        first[i] = second[n + i] = 1;
        first[t->width - 1] = right;
        first[2 * t->rows] = -1;
        if (isfinite(s->high[i])) {
            first[t->rows + n + i] = -1;
            second[t->rows + i] = 1;
            second[t->width - 1] = s->high[i] - s->low[i];
        }
        t->basis[i] = i;
        t->basis[n + i] = n + i;
    }
}

/* the row with the least right side, the first to leave for z0; -1: none is below 0 */
static int first_row(const Lemke *t)
{
    int found = -1;

    for (int i = 0; i < t->n; i++) {
        const double right = row_of(t, i)[t->width - 1];

        if (right < 0 && (found < 0 || right < row_of(t, found)[t->width - 1]))
            found = i;
    }
    return found;
}

static bool run_lemke(Lemke *t)
{
    const int artificial = 2 * t->rows;
    int row = first_row(t), entering = artificial;

    if (row < 0)
        return true;
    for (int turn = 0; turn < PIVOTS * t->n; turn++) {
        const int left = t->basis[row];

        pivot(t, row, entering);
        if (left == artificial)
            return true;
        entering = left < t->rows ? left + t->rows : left - t->rows;
        row = leaving_row(t, entering);
        if (row < 0)
            return false;
    }
    return false;
}

static bool solve_by_lemke(const Scaled *s, int *side)
{
    const int n = s->n;
    Lemke t = {.n = n, .rows = 2 * n, .width = 4 * n + 2, .at = s->tableau};

    t.basis = (int *)(void *)(s->tableau + (size_t)t.rows * (size_t)t.width);
    fill_tableau(s, &t);
    if (!run_lemke(&t))
        return false;
    for (int i = 0; i < n; i++)
        side[i] = AT_LOW;
    for (int i = 0; i < t.rows; i++) {
        const int basic = t.basis[i] - t.rows;

        if (basic >= 0 && basic < n && side[basic] == AT_LOW)
            side[basic] = BETWEEN;
        else if (basic >= n && basic < 2 * n)
            side[basic - n] = AT_HIGH;
    }
    return solve_sides(s, side) && is_solution(s, side);
}

/* --- all sides --- */

/* the next set of sides; false: all have been tried */
static bool next_sides(int n, int *side)
{
    for (int i = 0; i < n; i++) {
        if (side[i] < AT_HIGH) {
            side[i]++;
            return true;
        }
        side[i] = AT_LOW;
    }
    return false;
}

static bool try_all_sides(const Scaled *s, const int *guess, int *side)
{
    int trial[FEW], nearest = 2 * FEW + 1;

    for (int i = 0; i < s->n; i++)
        trial[i] = AT_LOW;
    do {
        int away = 0;
        bool is_bound = true;

        for (int i = 0; i < s->n; i++) {
            away += trial[i] != guess[i];
            is_bound = is_bound && (trial[i] != AT_HIGH || isfinite(s->high[i]));
        }
        if (is_bound && away < nearest && solve_sides(s, trial) && is_solution(s, trial)) {
            nearest = away;
            memcpy(side, trial, (size_t)s->n * sizeof(int));
        }
    } while (next_sides(s->n, trial));
    return nearest <= 2 * FEW && solve_sides(s, side);
}

/* Of a solution, those at a bound with w = 0 whose rows don't depend on others BETWEEN are BETWEEN
 * too: z stays as it is. */
static void keep_between(const Scaled *s, int *side)
{
    for (int i = 0; i < s->n; i++) {
        const int bound = side[i];

        if (bound == BETWEEN || s->matrix[i * s->n + i] <= 0 ||
            !(fabs(s->w[i]) <= RIGHT * s->largest))
            continue;
        side[i] = BETWEEN;
        if (solve_sides(s, side) && is_solution(s, side))
            continue;
        side[i] = bound;
        (void)solve_sides(s, side);
    }
}

static bool has_unstable(const Scaled *s)
{
    for (int i = 0; i < s->n; i++)
        if (s->matrix[i * s->n + i] < 0)
            return true;
    return false;
}

/* NOLINTNEXTLINE(readability-non-const-parameter): z and room are written to */
bool complementarity_solve(const Complementarity *problem, int *side, double *z, double *room)
{
    const Scaled s = scale_problem(problem, room);
    int guess[FEW];
    bool found;

    if (s.n <= FEW)
        memcpy(guess, side, (size_t)s.n * sizeof(int));
    found = exchange_blocks(&s, side) || (!has_unstable(&s) && solve_by_lemke(&s, side)) ||
            (s.n <= FEW && try_all_sides(&s, guess, side));
    if (found)
        keep_between(&s, side);
    for (int i = 0; i < s.n && found; i++)
        z[i] = s.z[i] * s.scale[i];
    return found;
}

/* --- with loads --- */

/* With y = z + c z_k and w = w+ - w-, both parts >= 0:
 *
 *     w+      = M z + q + w-     y  >= 0, w+ >= 0, one of them 0
 *     c z_k - z = 2 c z_k - y    w- >= 0, and that >= 0, one of them 0
 *
 * where z and w have the sign with M_ki <= 0: so the diagonal of the load, M_kk - c M_ki, doesn't
 * become negative. w- is scaled by the root of M_ii as w is. */
typedef struct Loaded {
    const LoadComplementarity *p;
    int n, size; /* of the problem with the doubled rows */
    int *extra;  /* n: the row of w- of each; -1: it has no load */
    int *side;   /* size */
    double *matrix, *q, *low, *high, *z;
    double *sign; /* n: that of z and w, 1 without a load */
} Loaded;

static double own_root(const Loaded *l, int i)
{
    const double own = l->p->box.matrix[i * l->n + i];

    return own > 0 ? sqrt(own) : 1;
}

static void place_extra(Loaded *l)
{
    l->size = l->n;
    for (int i = 0; i < l->n; i++)
        l->extra[i] = l->p->load[i] >= 0 ? l->size++ : -1;
}

static void choose_signs(const Loaded *l)
{
    for (int i = 0; i < l->n; i++)
        l->sign[i] = l->extra[i] >= 0 && l->p->box.matrix[l->p->load[i] * l->n + i] > 0 ? -1 : 1;
}

/* of the problem in these signs */
static double entry_of(const Loaded *l, int i, int k)
{
    return l->sign[i] * l->sign[k] * l->p->box.matrix[i * l->n + k];
}

static void fill_row(const Loaded *l, int i)
{
    const LoadComplementarity *p = l->p;
    double *row = l->matrix + (ptrdiff_t)i * l->size;

    l->q[i] = l->sign[i] * p->box.q[i];
    l->low[i] = l->extra[i] >= 0 ? 0 : p->box.low[i];
    l->high[i] = l->extra[i] >= 0 ? INFINITY : p->box.high[i];
    for (int k = 0; k < l->n; k++)
        row[k] = entry_of(l, i, k);
    for (int k = 0; k < l->n; k++)
        if (l->extra[k] >= 0)
            row[p->load[k]] -= p->share[k] * entry_of(l, i, k);
}

static void fill_extra(const Loaded *l, int i)
{
    const LoadComplementarity *p = l->p;
    const int at = l->extra[i];
    const double root = own_root(l, i);
    double *row = l->matrix + (ptrdiff_t)at * l->size;

    l->matrix[(ptrdiff_t)i * l->size + at] = root;
    row[p->load[i]] = 2 * p->share[i] * root;
    row[i] = -root;
    l->q[at] = l->low[at] = 0;
    l->high[at] = INFINITY;
}

/* first guesses */
static void guess_sides(const Loaded *l, const int *side)
{
    for (int i = 0; i < l->n; i++) {
        const int own = l->sign[i] > 0 ? side[i] : -side[i];

        l->side[i] = l->extra[i] >= 0 && own == AT_HIGH ? BETWEEN : own;
        if (l->extra[i] >= 0)
            l->side[l->extra[i]] = own == AT_HIGH ? BETWEEN : AT_LOW;
    }
}

static void read_loaded(const Loaded *l, int *side, double *z)
{
    for (int i = 0; i < l->n; i++) {
        const int extra = l->extra[i];

        z[i] = l->z[i];
        side[i] = l->side[i];
        if (extra >= 0) {
            z[i] = l->sign[i] * (z[i] - l->p->share[i] * l->z[l->p->load[i]]);
            side[i] = l->side[i] == AT_LOW ? AT_LOW : l->side[extra] == AT_LOW ? BETWEEN : AT_HIGH;
            side[i] = l->sign[i] > 0 ? side[i] : -side[i];
        }
    }
}

bool load_complementarity_solve(const LoadComplementarity *problem, int *side, double *z,
                                double *room, int *integers)
{
    Loaded l = {.p = problem, .n = problem->box.n, .extra = integers};
    Complementarity box;

    place_extra(&l);
    l.side = integers + l.n;
    l.matrix = take(&room, (size_t)l.size * (size_t)l.size);
    l.q = take(&room, (size_t)l.size);
    l.low = take(&room, (size_t)l.size);
    l.high = take(&room, (size_t)l.size);
    l.z = take(&room, (size_t)l.size);
    l.sign = take(&room, (size_t)l.n);
    for (int i = 0; i < l.size * l.size; i++)
        l.matrix[i] = 0;
    choose_signs(&l);
    for (int i = 0; i < l.n; i++)
        fill_row(&l, i);
    for (int i = 0; i < l.n; i++)
        if (l.extra[i] >= 0)
            fill_extra(&l, i);
    guess_sides(&l, side);
    box = (Complementarity){l.size, l.matrix, l.q, l.low, l.high};
    if (!complementarity_solve(&box, l.side, l.z, room))
        return false;
    read_loaded(&l, side, z);
    return true;
}
