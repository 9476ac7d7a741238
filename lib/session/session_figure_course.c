/* session_figure_course.c: pieces of a run, and the formula at and between its rows
 *
 * f_i are the values at rows with the distance h, D2 f_i = f_{i-1} - 2 f_i + f_{i+1}. A smooth f
 * leaves the range of f_i and f_{i+1} by |D2 f|/8 at most; the bound is the largest |D2 f| about
 * the piece, which also covers a kink. It holds where D4 f is smaller than D2 f, so that rows
 * resolve f, and where the integrator took no more than a step from row to row. */
#include "session/session_figure_course.h"

#include "session/session_limits.h"

#include <math.h>
#include <stdlib.h>

enum {
    MOST = 40000, /* pieces */
    NODES = 400   /* of an expression: a larger one isn't looked through */
};

const double course_nodes[POINTS] = {
    -0.9491079123427585, -0.7415311855993945, -0.4058451513773972, 0,
    0.4058451513773972,  0.7415311855993945,  0.9491079123427585};
const double course_weights[POINTS] = {0.1294849661688697, 0.2797053914892766, 0.3818300505051189,
                                       0.4179591836734694, 0.3818300505051189, 0.2797053914892766,
                                       0.1294849661688697};

void course_free(FigureCourse *course)
{
    LIST_FREE(course->pieces);
    LIST_FREE(course->times);
    LIST_FREE(course->values);
    mem_free(course->rows);
}

Status course_at(const FigureCourse *course, const double *times, int count, double *out,
                 Diag *diag)
{
    return formula_rows(course->session, course->formula, 1, course->grid, course->source, times,
                        count, out, 1, 0, diag);
}

/* --- pieces --- */

static void add_pieces(FigureCourse *course, double from, double to, int row, int parts)
{
    for (int k = 1; k <= parts; k++) {
        const double a = from + (to - from) * (k - 1) / parts;
        const double b = k < parts ? from + (to - from) * k / parts : to;
        const FigurePiece piece = {a, b, parts == 1 ? row : -1, INFINITY};

        LIST_PUSH(course->pieces, piece);
    }
}

/* from row to row and corner to corner, no longer than half the mean step */
static void cut_pieces(FigureCourse *course)
{
    const Result *result = course->grid->result;
    const double *rows = result_times(result), *corners = result_corner_times(result);
    const int row_count = result_rows(result), corner_count = result_corner_count(result);
    const double span = rows[row_count - 1] - rows[0];
    const double most = fmin(2.0 * (double)result_report(result)->steps, MOST);
    double last = rows[0];
    int corner = 0;

    for (int i = 1; i <= row_count - 1 && span > 0;) {
        double next = rows[i];

        while (corner < corner_count && corners[corner] <= last)
            corner++;
        if (corner < corner_count && corners[corner] < next)
            next = corners[corner];
        if (next > last) {
            const bool is_whole = last == rows[i - 1] && next == rows[i];

            add_pieces(course, last, next, is_whole ? i - 1 : -1,
                       1 + (int)((next - last) / span * most));
            last = next;
        }
        if (next == rows[i])
            i++;
    }
}

/* --- bounds --- */

/* whether an expression has derivatives everywhere; false for one that is too large to look at */
static bool is_smooth(Expr e, int *left)
{
    if (--*left < 0)
        return false;
    if (expr_kind(e) == EXPR_CALL &&
        (expr_op(e) == OP_TABLE || expr_op(e) == OP_ATAN2 || expr_op(e) == OP_UNWRAP ||
         (expr_op(e) >= OP_ABS && expr_op(e) <= OP_HOLD)))
        return false;
    for (int i = 0; i < expr_arg_count(e); i++)
        if (!is_smooth(expr_arg(e, i), left))
            return false;
    return true;
}

/* of variables of this run alone, whose rows it then shares */
static bool formula_is_smooth(const FigureCourse *course)
{
    const Formula *formula = course->formula;
    const int number = (int)(course->grid - course->session->runs.at);
    int left = NODES;

    for (int i = 0; i < formula->leaves.count; i++) {
        const Leaf *leaf = &formula->leaves.at[i];

        if (leaf->kind == LEAF_CONSTANT)
            continue;
        if (!is_smooth(leaf->expr, &left) ||
            (leaf->run >= 0 ? leaf->run != number : course->grid != course->source))
            return false;
    }
    return is_smooth(formula->whole, &left);
}

/* whether the rows from `first` to `last` are evenly spaced, with a step at most between two */
static bool is_even(const FigureCourse *course, int first, int last)
{
    const Result *result = course->grid->result;
    const double *t = result_times(result);
    const int *steps = result_steps(result);
    const double h = t[first + 1] - t[first];

    for (int i = first; i < last; i++)
        if (!(fabs(t[i + 1] - t[i] - h) <= FIGURES_EVEN * h) || steps[i + 1] < steps[i] ||
            steps[i + 1] > steps[i] + 1)
            return false;
    return true;
}

/* whether a piece and the `around` pieces on both sides are between rows */
static bool is_between_rows(const FigureCourse *course, int k, int around)
{
    const int row = course->pieces.at[k].row;

    if (row < 0 || k < around || k + around >= course->pieces.count ||
        course->pieces.at[k - around].row != row - around ||
        course->pieces.at[k + around].row != row + around)
        return false;
    for (int i = k - around; i < k + around; i++)
        if (course->pieces.at[i].row < 0 || course->pieces.at[i].b != course->pieces.at[i + 1].a)
            return false;
    return is_even(course, row - around, row + 1 + around);
}

static void find_bound(FigureCourse *course, int k)
{
    double second[4], most = 0, fourth = 0;
    const double *f;

    if (!is_between_rows(course, k, 2))
        return;
    f = course->rows + course->pieces.at[k].row - 1;
    for (int i = 0; i < 4; i++) {
        second[i] = f[i - 1] - 2 * f[i] + f[i + 1];
        most = fmax(most, fabs(second[i]));
    }
    for (int i = 1; i < 3; i++)
        fourth = fmax(fourth, fabs(second[i - 1] - 2 * second[i] + second[i + 1]));
    if (isfinite(second[0] + second[1] + second[2] + second[3]) &&
        (fourth <= FIGURES_RESOLVED * most || fourth <= course->tolerance * course->scale))
        course->pieces.at[k].bound = most;
}

Status course_open(FigureCourse *course, Diag *diag)
{
    const Result *result = course->grid->result;
    const int rows = result_rows(result);

    cut_pieces(course);
    course->rows = NEW_ARRAY(double, rows);
    TRY(formula_rows(course->session, course->formula, 1, course->grid, course->source, NULL, rows,
                     course->rows, 1, 0, diag));
    course->tolerance = result_report(result)->rtol;
    for (int i = 0; i < rows; i++)
        course->scale = fmax(course->scale, fabs(course->rows[i]));
    if (result_kind(result) == RUN_SIMULATE && formula_is_smooth(course))
        for (int k = 0; k < course->pieces.count; k++)
            find_bound(course, k);
    return OK;
}

/* --- samples --- */

static void add_times(FigureCourse *course, const FigurePiece *piece)
{
    const double a = piece->a, b = piece->b;

    LIST_PUSH(course->times, a);
    for (int k = 0; k < POINTS; k++)
        LIST_PUSH(course->times, (a + b) / 2 + (b - a) / 2 * course_nodes[k]);
    LIST_PUSH(course->times, b - FIGURES_END * (b - a));
}

Status course_sample(FigureCourse *course, int first, int end, CourseNeeds *needs, double level,
                     double band, Diag *diag)
{
    LIST(int) rows = {0}; /* of each time; -1: is evaluated */
    double *values = NULL;
    int count = 0;
    Status status = OK;

    course->times.count = course->values.count = 0;
    for (int k = first; k < end; k++) {
        const FigurePiece *piece = &course->pieces.at[k];
        const bool is_known = piece->bound < INFINITY && !needs(course, piece, level, band);

        if (is_known)
            LIST_PUSH(course->times, piece->a);
        else
            add_times(course, piece);
        while (rows.count < course->times.count)
            LIST_PUSH(rows, is_known ? piece->row : -1);
    }
    LIST_PUSH(course->times,
              end > first ? course->pieces.at[end - 1].b : result_times(course->grid->result)[0]);
    LIST_PUSH(rows, -1);
    LIST_ROOM(course->values, course->times.count);
    for (int i = 0; i < course->times.count; i++)
        if (rows.at[i] < 0)
            course->values.at[count++] = course->times.at[i];
    values = NEW_ARRAY(double, count);
    CHECK(course_at(course, course->values.at, count, values, diag));
    course->values.count = course->times.count;
    for (int i = count = 0; i < course->times.count; i++)
        course->values.at[i] = rows.at[i] < 0 ? values[count++] : course->rows[rows.at[i]];
done:
    LIST_FREE(rows);
    mem_free(values);
    return status;
}

/* --- integrals --- */

/* The integrals over the middle interval of the polynomials through 4, 6 and 8 rows; their
 * differences fall by about the same factor, so that the error of the last follows from both. */
bool course_integral(const FigureCourse *course, const FigurePiece *piece, int power,
                     double tolerance, double *out)
{
    static const double weights[3][4] = {
        {13.0 / 24, -1.0 / 24, 0, 0},
        {802.0 / 1440, -93.0 / 1440, 11.0 / 1440, 0},
        {68323.0 / 120960, -9531.0 / 120960, 1879.0 / 120960, -191.0 / 120960}};
    const int k = (int)(piece - course->pieces.at), row = piece->row;
    double sums[3] = {0}, wider, last;

    if (!(piece->bound < INFINITY) || !is_between_rows(course, k, 3))
        return false;
    for (int i = 0; i < 4; i++) {
        const double before = course->rows[row - i], after = course->rows[row + 1 + i];
        const double both = power == 2 ? before * before + after * after : before + after;

        for (int n = 0; n < 3; n++)
            sums[n] += weights[n][i] * both * (piece->b - piece->a);
    }
    wider = fabs(sums[1] - sums[0]);
    last = fabs(sums[2] - sums[1]);
    *out = sums[2];
    return last * (last < wider ? last / wider : 1) <= tolerance;
}
