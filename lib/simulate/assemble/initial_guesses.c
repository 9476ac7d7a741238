/* initial_guesses.c: the assembly that is nearest to the guesses
 *
 * Distance of an assembly c from the guesses g: d(c)^2 = sum_i w_i^2 (c_i - g_i)^2. w_i is 1 for an
 * angle (rad, to the nearest whole turn) and for an Euler parameter, 1 / L for a length, where L is
 * the distance (m) of the furthest frame from the datum at the first initial point.
 *
 * From each initial point a search finds a local minimum of loops and guesses together; then loops
 * are closed from there. The first initial point has 0 where there is no guess; the others have
 * random values there. Their number is bounded, and they depend on the model alone. */
#include "simulate/assemble/initial_place_impl.h"

#include "base/random.h"
#include "simulate/assemble/assemble_limits.h"

#include <math.h>
#include <string.h>

/* a search for the nearest assembly */
typedef struct Nearest {
    PlaceSearch s;
    double size;          /* L, m */
    double *scale;        /* rows */
    double *residual;     /* rows */
    bool *is_guessed;     /* columns with a guess, which start there */
    bool *is_concerned;   /* columns that guesses determine, through loops too */
    double *begun, *best; /* coordinates at the first start; of the best assembly */
    double distance;      /* of the best assembly; infinite: there is none */
} Nearest;

static bool is_column_guessed(const Placing *p, const PlaceColumn *column)
{
    const Link *l = &p->s->links[column->link];
    const int k = column->kind == COLUMN_SLIDE  ? l->shift[column->k].coordinate
                  : column->kind == COLUMN_TURN ? l->turn[column->k].coordinate
                  : l->has_parameters           ? l->first_parameter
                                                : l->turn[0].coordinate;

    return p->known[place_at(column->link, k)] == KNOWN_GUESSED;
}

static bool is_guess_row(const PlaceSearch *s, int row)
{
    return row >= s->rows.rows - s->p->guess_count;
}

/* minimise |loops|^2 + weight^2 d^2 from the current point */
static void minimise(Nearest *n, double weight, const bool *held)
{
    place_row_scales(&n->s, n->size, weight, n->scale);
    (void)levenberg_marquardt_solve(&n->s.rows, held, n->scale, PLACE_APPROACHED, n->s.p->c, NULL);
}

static bool are_met(Nearest *n, const Rows *rows)
{
    bool met = true;

    rows->evaluate(rows->context, n->s.p->c, n->residual, NULL);
    for (int i = 0; i < rows->rows; i++)
        met = met && !initial_misses(n->residual[i]);
    return met;
}

/* Close the loops from the current point, without guesses; false: they don't close. */
static bool close_loops(Nearest *n)
{
    Placing *p = n->s.p;
    Rows loops = n->s.rows;
    bool met;

    loops.rows -= p->guess_count;
    p->asks.count -= p->guess_count;
    met = are_met(n, &loops) || initial_meet(&loops, NULL, p->c, NULL);
    p->asks.count += p->guess_count;
    return met;
}

/* d at the current point; infinite: loops don't close */
static double find_distance(Nearest *n)
{
    double sum = 0;

    if (!close_loops(n))
        return INFINITY;
    n->s.rows.evaluate(n->s.rows.context, n->s.p->c, n->residual, NULL);
    place_row_scales(&n->s, n->size, 1, n->scale);
    for (int i = 0; i < n->s.rows.rows; i++)
        if (is_guess_row(&n->s, i))
            sum += pow(n->scale[i] * n->residual[i], 2);
    return sqrt(sum);
}

static void keep_nearer(Nearest *n, double distance)
{
    if (!(distance < n->distance - (isfinite(n->distance) ? GUESSES_NEARER : 0)))
        return;
    n->distance = distance;
    memcpy(n->best, n->s.p->c, (size_t)n->s.rows.length * sizeof(double));
}

/* Columns that guesses determine: those that move a guess, or a loop that such a column moves. */
static void find_concerned(Nearest *n, double *step)
{
    const Rows *rows = &n->s.rows;
    double *jacobian = NEW_ARRAY(double, (size_t)rows->rows *(size_t)rows->columns);
    bool *row = NEW_ARRAY(bool, rows->rows), more = true;
    uint64_t seed = 3;

    for (int j = 0; j < rows->columns; j++)
        step[j] = GUESS_PROBE * random_unit(&seed);
    rows->move(rows->context, n->s.p->c, step);
    rows->evaluate(rows->context, n->s.p->c, n->residual, jacobian);
    for (int i = 0; i < rows->rows; i++)
        row[i] = is_guess_row(&n->s, i);
    while (more) {
        more = false;
        for (int i = 0; i < rows->rows; i++)
            for (int j = 0; j < rows->columns; j++)
                if (jacobian[(ptrdiff_t)i * rows->columns + j] != 0 && row[i] != n->is_concerned[j])
                    row[i] = n->is_concerned[j] = more = true;
    }
    MEM_FREE(jacobian, row);
}

/* A random initial point: anywhere without a guess, close to it with one. */
static void begin_anywhere(Nearest *n, double off, uint64_t *seed, double *step)
{
    const Placing *p = n->s.p;

    for (int j = 0; j < n->s.rows.columns; j++) {
        const double size = p->columns.at[j].kind == COLUMN_SLIDE ? n->size : M_PI;

        step[j] = random_unit(seed) * (n->is_guessed[j] ? off * size / M_PI : size);
        if (!n->is_concerned[j])
            step[j] = 0;
    }
    memcpy(n->s.p->c, n->begun, (size_t)n->s.rows.length * sizeof(double));
    n->s.rows.move(n->s.rows.context, n->s.p->c, step);
}

static int count_starts(const Nearest *n)
{
    const double columns = n->s.rows.columns;
    int count = GUESS_POINTS;

    for (int j = 0; j < n->s.rows.columns && count < GUESS_MOST_POINTS; j++)
        count += n->is_concerned[j] && !n->is_guessed[j] ? GUESS_POINTS_PER_COLUMN : 0;
    return (int)fmax(
        1, fmin(fmin(count, GUESS_MOST_POINTS), GUESS_WORK / (columns * columns * columns)));
}

/* Search from the first initial point, then from the others. */
static void search_starts(Nearest *n)
{
    const size_t bytes = (size_t)n->s.rows.length * sizeof(double);
    double *step = NEW_ARRAY(double, n->s.rows.columns);
    uint64_t seed = 1;
    int count;

    minimise(n, 1, NULL);
    keep_nearer(n, find_distance(n));
    memcpy(n->s.p->c, n->begun, bytes);
    find_concerned(n, step);
    count = count_starts(n);
    for (int k = 1; k < count && n->distance > GUESSES_MET && monitor_poll(n->s.rows.watch) == OK;
         k++) {
        begin_anywhere(n, k % 4 < 2 ? GUESS_SPREAD : GUESS_WIDE_SPREAD, &seed, step);
        /* move columns without a guess first, towards the guesses */
        minimise(n, 1, n->is_guessed);
        /* from the minimum of loops and guesses together it may be impossible to close the loops */
        if (k % 2 == 0)
            minimise(n, 1, NULL);
        keep_nearer(n, find_distance(n));
    }
    mem_free(step);
}

/* From the best assembly to the least distance near it: the weight of loops increases. */
static void descend_along_loops(Nearest *n)
{
    const size_t bytes = (size_t)n->s.rows.length * sizeof(double);

    memcpy(n->s.p->c, n->best, bytes);
    double weight = 1;

    while (weight > 1.5 * GUESS_LEAST_WEIGHT) {
        weight *= GUESS_WEIGHT_FACTOR;
        minimise(n, weight, NULL);
    }
    /* at a minimum of the sum the loops may be open */
    if (!(find_distance(n) <= n->distance))
        memcpy(n->s.p->c, n->best, bytes);
}

static void open_nearest(Nearest *n, Placing *p)
{
    *n = (Nearest){.distance = INFINITY};
    place_open_search(&n->s, p, true);
    n->s.rows.context = &n->s;
    n->scale = NEW_ARRAY(double, n->s.rows.rows);
    n->residual = NEW_ARRAY(double, n->s.rows.rows);
    n->is_guessed = NEW_ARRAY(bool, n->s.rows.columns);
    n->is_concerned = NEW_ARRAY(bool, n->s.rows.columns);
    n->begun = NEW_ARRAY(double, n->s.rows.length);
    n->best = NEW_ARRAY(double, n->s.rows.length);
    for (int j = 0; j < n->s.rows.columns; j++)
        n->is_guessed[j] = is_column_guessed(p, &p->columns.at[j]);
    memcpy(n->begun, p->c, (size_t)n->s.rows.length * sizeof(double));
}

static void close_nearest(Nearest *n)
{
    place_close_search(&n->s);
    MEM_FREE(n->scale, n->residual, n->is_guessed, n->is_concerned, n->begun, n->best);
}

/* whether all rows hold, or are satisfied from the first initial point */
static bool meet_all(Nearest *n)
{
    const Rows *rows = &n->s.rows;
    bool met = are_met(n, rows);

    n->size = place_size(n->s.p);
    met = met || initial_meet(rows, NULL, n->s.p->c, NULL);
    if (!met)
        memcpy(n->s.p->c, n->begun, (size_t)rows->length * sizeof(double));
    return met;
}

void place_by_guesses(Placing *p)
{
    bool is_any = false;
    Nearest n;

    for (int i = 0; i < p->guess_list.count; i++)
        is_any = is_any || p->guess_list.at[i].is_guess;
    if (!is_any || p->columns.count == 0)
        return;
    open_nearest(&n, p);
    if (!meet_all(&n)) {
        search_starts(&n);
        if (isfinite(n.distance)) {
            descend_along_loops(&n);
        } else {
            memcpy(p->c, n.begun, (size_t)n.s.rows.length * sizeof(double));
            minimise(&n, 1, NULL);
        }
    }
    close_nearest(&n);
}

void place_remark_guesses(Placing *p)
{
    const double size = place_size(p);

    for (int i = 0; i < p->guess_list.count; i++) {
        const InitialGuess *wish = &p->guess_list.at[i];
        bool is_length;
        double off;

        if (!wish->is_guess)
            continue;
        off = place_missed(p, i, &is_length);
        if (fabs(off) > GUESS_FAR * (is_length ? size : 1))
            remarks_add(&p->a->out->remarks, (Remark){.kind = REMARK_GUESS_MISSED,
                                                      .what = wish->name,
                                                      .size = wish->value,
                                                      .to = wish->value + off});
    }
}
