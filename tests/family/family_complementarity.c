/* family_complementarity.c: complementarity problems with bounds, of dry friction
 *
 * M = W W^T/mass of random rows W, of which there may be more than motions; w of such a problem is
 * unique. Oracles: projected Gauss-Seidel sweeps in long double, and for few unknowns of a matrix
 * that isn't symmetric a search over all sides by Cramer's rule. Each answer is held against its
 * inequalities too, and rows of unknowns BETWEEN against being independent. */
#include "algebra/complementarity.h"

#include "family.h"

enum { MOST = 60, FEW_UNKNOWNS = 4, SWEEPS = 40000 };

typedef struct Problem {
    int n, motions;
    double matrix[MOST * MOST], q[MOST], low[MOST], high[MOST];
    double z[MOST], w[MOST];
    int side[MOST];
} Problem;

static Problem problem;

/* --- problems --- */

static void draw_rows(Member *member, Problem *p, int motions)
{
    double rows[MOST][MOST] = {{0}}, mass[MOST] = {0};

    p->motions = motions;
    for (int j = 0; j < motions; j++)
        mass[j] = pow(10, member_between(member, -3, 3));
    for (int i = 0; i < p->n; i++)
        for (int j = 0; j < motions; j++)
            rows[i][j] = member_between(member, 0, 1) < 0.5 ? 0 : member_between(member, -1, 1);
    for (int i = 0; i < p->n; i++) {
        rows[i][i % motions] += 1;
        for (int k = 0; k <= i; k++) {
            double sum = 0;

            for (int j = 0; j < motions; j++)
                sum += rows[i][j] * rows[k][j] / mass[j];
            p->matrix[i * p->n + k] = p->matrix[k * p->n + i] = sum;
        }
    }
    for (int i = 0; i < p->n; i++) { /* the rates that loads alone give lie where rows lead */
        p->q[i] = 0;
        for (int j = 0; j < motions; j++)
            p->q[i] += rows[i][j] * member_between(member, -1, 1) / mass[j];
    }
}

static void draw_bounds(Member *member, Problem *p)
{
    const double size = pow(10, member_between(member, -3, 1));

    for (int i = 0; i < p->n; i++) {
        p->high[i] = size * member_between(member, 0.1, 1);
        p->low[i] = member_between(member, 0, 1) < 0.2 ? 0 : -p->high[i];
        p->side[i] = (int)floor(member_between(member, 0, 3)) - 1;
    }
}

/* --- the answer --- */

static bool solve(Problem *p)
{
    const Complementarity c = {p->n, p->matrix, p->q, p->low, p->high};
    double *room = malloc((size_t)COMPLEMENTARITY_ROOM(p->n) * sizeof(double));
    const bool found = complementarity_solve(&c, p->side, p->z, room);

    free(room);
    for (int i = 0; i < p->n && found; i++) {
        p->w[i] = p->q[i];
        for (int k = 0; k < p->n; k++)
            p->w[i] += p->matrix[i * p->n + k] * p->z[k];
    }
    return found;
}

/* the size of row i's terms, for its rounding */
static double size_of(const Problem *p, int i)
{
    double sum = fabs(p->q[i]);

    for (int k = 0; k < p->n; k++)
        sum += fabs(p->matrix[i * p->n + k]) * fmax(fabs(p->low[k]), fabs(p->high[k]));
    return sum;
}

/* how far the answer is from each of its inequalities, in parts of its size */
static double error_of(const Problem *p)
{
    double worst = 0;

    for (int i = 0; i < p->n; i++) {
        const double w = p->w[i] / size_of(p, i), width = p->high[i] - p->low[i];

        worst = fmax(worst, fmax(p->low[i] - p->z[i], p->z[i] - p->high[i]) / width);
        if (p->side[i] == BETWEEN)
            worst = fmax(worst, fabs(w));
        else
            worst =
                fmax(worst,
                     fmax(p->side[i] * w,
                          fabs(p->z[i] - (p->side[i] == AT_LOW ? p->low[i] : p->high[i])) / width));
    }
    return worst;
}

static int count_between(const Problem *p)
{
    int count = 0;

    for (int i = 0; i < p->n; i++)
        count += p->side[i] == BETWEEN;
    return count;
}

/* --- sweeps --- */

/* w by projected Gauss-Seidel sweeps; whether they converged */
static bool sweep(const Problem *p, double *w)
{
    long double z[MOST] = {0}, moved = 1;

    for (int turn = 0; turn < SWEEPS && moved > 1e-16L; turn++) {
        moved = 0;
        for (int i = 0; i < p->n; i++) {
            long double sum = p->q[i], before = z[i];

            for (int k = 0; k < p->n; k++)
                sum += p->matrix[i * p->n + k] * z[k];
            z[i] -= sum / p->matrix[i * p->n + i];
            z[i] = z[i] < p->low[i] ? p->low[i] : z[i] > p->high[i] ? p->high[i] : z[i];
            moved = fmaxl(moved, fabsl(z[i] - before) / (p->high[i] - p->low[i]));
        }
    }
    for (int i = 0; i < p->n; i++) {
        long double sum = p->q[i];

        for (int k = 0; k < p->n; k++)
            sum += p->matrix[i * p->n + k] * z[k];
        w[i] = (double)sum;
    }
    return moved <= 1e-16L;
}

static Verdict friction_has_one_motion(Member *member)
{
    Problem *p = &problem;
    double w[MOST] = {0}, off = 0;

    p->n = 2 + (int)member_between(member, 0, member_between(member, 0, 1) < 0.7 ? 8 : MOST - 2);
    draw_rows(member, p, 1 + (int)member_between(member, 0, p->n + 3 < MOST ? p->n + 3 : MOST - 1));
    draw_bounds(member, p);
    if (!solve(p)) {
        tell(member, "no solution of %d unknowns, %d motions\n", p->n, p->motions);
        return DISAGREES;
    }
    if (!keeps(member, "inequalities", error_of(p), 1e-8))
        return DISAGREES;
    if (count_between(p) > p->motions) {
        tell(member, "%d rows between on %d motions\n", count_between(p), p->motions);
        return DISAGREES;
    }
    if (!sweep(p, w))
        return AGREES;
    for (int i = 0; i < p->n; i++)
        off = fmax(off, fabs(w[i] - p->w[i]) / size_of(p, i));
    return keeps(member, "w of sweeps", off, 1e-7) ? AGREES : DISAGREES;
}

/* --- all sides --- */

static double determinant(int n, double a[][FEW_UNKNOWNS])
{
    double sum = 0;

    if (n == 0)
        return 1;
    for (int j = 0; j < n; j++) {
        double minor[FEW_UNKNOWNS][FEW_UNKNOWNS];

        for (int i = 1; i < n; i++)
            for (int k = 0, at = 0; k < n; k++)
                if (k != j)
                    minor[i - 1][at++] = a[i][k];
        sum += (j % 2 == 0 ? 1 : -1) * a[0][j] * determinant(n - 1, minor);
    }
    return sum;
}

/* whether the sides give a solution, by Cramer's rule, with room to spare */
static bool is_solution(const Problem *p, const int *side)
{
    double z[FEW_UNKNOWNS], a[FEW_UNKNOWNS][FEW_UNKNOWNS], b[FEW_UNKNOWNS];
    int between[FEW_UNKNOWNS], count = 0;

    for (int i = 0; i < p->n; i++) {
        z[i] = side[i] == AT_LOW ? p->low[i] : side[i] == AT_HIGH ? p->high[i] : 0;
        if (side[i] == BETWEEN)
            between[count++] = i;
    }
    for (int i = 0; i < count; i++) {
        b[i] = -p->q[between[i]];
        for (int k = 0; k < p->n; k++)
            b[i] -= p->matrix[between[i] * p->n + k] * z[k];
        for (int k = 0; k < count; k++)
            a[i][k] = p->matrix[between[i] * p->n + between[k]];
    }
    for (int j = 0; j < count; j++) {
        double put[FEW_UNKNOWNS][FEW_UNKNOWNS];

        for (int i = 0; i < count; i++)
            for (int k = 0; k < count; k++)
                put[i][k] = k == j ? b[i] : a[i][k];
        z[between[j]] = determinant(count, put) / determinant(count, a);
    }
    for (int i = 0; i < p->n; i++) {
        double w = p->q[i];

        for (int k = 0; k < p->n; k++)
            w += p->matrix[i * p->n + k] * z[k];
        if (side[i] == BETWEEN ? !(z[i] > p->low[i] && z[i] < p->high[i]) : !(side[i] * w < 0))
            return false;
    }
    return true;
}

static bool has_solution(const Problem *p)
{
    int side[FEW_UNKNOWNS];
    int sets = 1;

    for (int i = 0; i < p->n; i++)
        sets *= 3;
    for (int k = 0; k < sets; k++) {
        for (int i = 0, rest = k; i < p->n; i++, rest /= 3)
            side[i] = rest % 3 - 1;
        if (is_solution(p, side))
            return true;
    }
    return false;
}

static Verdict a_solution_is_found_where_there_is_one(Member *member)
{
    Problem *p = &problem;
    bool exists;

    p->n = 1 + (int)member_between(member, 0, FEW_UNKNOWNS);
    for (int i = 0; i < p->n; i++) {
        p->q[i] = member_between(member, -1, 1);
        for (int k = 0; k < p->n; k++)
            p->matrix[i * p->n + k] = member_between(member, -1, 1);
        p->matrix[i * p->n + i] = member_between(member, 0.1, 1);
    }
    draw_bounds(member, p);
    exists = has_solution(p);
    if (!solve(p)) {
        tell(member, "no solution of %d unknowns found\n", p->n);
        return exists ? DISAGREES : AGREES;
    }
    return keeps(member, "inequalities", error_of(p), 1e-8) ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"friction has one motion", 600, 0, 0, friction_has_one_motion},
        {"a solution is found where there is one", 3000, 0, 0,
         a_solution_is_found_where_there_is_one},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
