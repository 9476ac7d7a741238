/* family_norm_bounds.c: complementarity problems with bounds on norms, of dry friction in one, two
 * and three directions
 *
 * M = W W^T/mass with random rows W, of which there may be more than motions, its columns scaled by
 * each bound. Such a problem minimises a convex function, so that what meets its equations and
 * inequalities solves it: each answer is held against them. Oracle of w besides, which is unique:
 * accelerated steps along the gradient, projected onto the bounds. */
#include "algebra/norm_complementarity.h"

#include "family.h"

#include <string.h>

enum { MOST = 60, STEPS = 100000 };

typedef struct Problem {
    int n, motions;
    double matrix[MOST * MOST]; /* symmetric */
    double scaled[MOST * MOST]; /* its columns times bounds */
    double q[MOST], bound[MOST], low[MOST], high[MOST];
    double z[MOST], w[MOST];
    int rows[MOST], side[MOST], slips[MOST];
} Problem;

static Problem problem;

static void draw_cones(Member *member, Problem *p, int most)
{
    p->n = 0;
    for (int left = 1 + (int)member_between(member, 0, most); left > 0; left--) {
        const int rows = 1 + (int)member_between(member, 0, 3);
        const double bound = pow(10, member_between(member, -2, 1));

        for (int k = 0; k < rows; k++) {
            p->rows[p->n + k] = k == 0 ? rows : 0;
            p->bound[p->n + k] = bound;
            p->high[p->n + k] = 1;
            p->low[p->n + k] = -1;
        }
        p->n += rows;
    }
}

static void draw_matrix(Member *member, Problem *p, double range)
{
    double rows[MOST][MOST] = {{0}}, mass[MOST] = {0};

    for (int j = 0; j < p->motions; j++)
        mass[j] = pow(10, member_between(member, -range, range));
    for (int i = 0; i < p->n; i++) {
        for (int j = 0; j < p->motions; j++)
            rows[i][j] = member_between(member, 0, 1) < 0.5 ? 0 : member_between(member, -1, 1);
        rows[i][i % p->motions] += 1;
        p->q[i] = 0;
        for (int j = 0; j < p->motions; j++)
            p->q[i] += rows[i][j] * member_between(member, -1, 1) / mass[j];
        for (int k = 0; k <= i; k++) {
            double sum = 0;

            for (int j = 0; j < p->motions; j++)
                sum += rows[i][j] * rows[k][j] / mass[j];
            p->matrix[i * p->n + k] = p->matrix[k * p->n + i] = sum;
        }
    }
    for (int i = 0; i < p->n; i++)
        for (int k = 0; k < p->n; k++)
            p->scaled[i * p->n + k] = p->matrix[i * p->n + k] * p->bound[k];
}

static bool solve(Problem *p)
{
    const NormComplementarity c = {
        .box = {p->n, p->scaled, p->q, p->low, p->high}, .rows = p->rows, .slips = p->slips};
    static double room[NORM_COMPLEMENTARITY_ROOM(MOST)];
    bool found;

    memset(p->z, 0, sizeof p->z);
    found = norm_complementarity_solve(&c, p->side, p->z, room);
    for (int i = 0; i < p->n && found; i++) {
        p->w[i] = p->q[i];
        for (int k = 0; k < p->n; k++)
            p->w[i] += p->scaled[i * p->n + k] * p->z[k];
    }
    return found;
}

static double size_of(const Problem *p, int i)
{
    double sum = fabs(p->q[i]);

    for (int k = 0; k < p->n; k++)
        sum += fabs(p->scaled[i * p->n + k]);
    return sum;
}

/* how far the answer is from its equations and inequalities, in parts of their terms */
static double error_of(const Problem *p)
{
    double worst = 0;

    for (int i = 0; i < p->n; i += p->rows[i]) {
        double norm = 0, along = 0;

        for (int k = i; k < i + p->rows[i]; k++) {
            norm += p->z[k] * p->z[k];
            along += p->w[k] * p->z[k];
        }
        norm = sqrt(norm);
        worst = fmax(worst, norm - 1);
        if (p->side[i] != BETWEEN)
            worst = fmax(worst, fabs(norm - 1));
        for (int k = i; k < i + p->rows[i]; k++) {
            const double across = p->side[i] == BETWEEN ? 0 : fmin(0, along) * p->z[k];

            worst = fmax(worst, fabs(p->w[k] - across) / size_of(p, k));
        }
    }
    return worst;
}

/* bounds onto z, in the symmetric form, whose unknowns are efforts */
static void project(const Problem *p, double *effort)
{
    for (int i = 0; i < p->n; i += p->rows[i]) {
        double norm = 0;

        for (int k = i; k < i + p->rows[i]; k++)
            norm += effort[k] * effort[k];
        norm = sqrt(norm);
        for (int k = i; k < i + p->rows[i] && norm > p->bound[i]; k++)
            effort[k] *= p->bound[i] / norm;
    }
}

/* w by accelerated gradient steps, begun anew where they turn back; false: they didn't converge */
static bool descend(const Problem *p, double *w)
{
    double x[MOST] = {0}, y[MOST] = {0}, before[MOST] = {0}, largest = 0, moved = 1, share = 1;

    for (int i = 0; i < p->n; i++) {
        double sum = 0;

        for (int k = 0; k < p->n; k++)
            sum += fabs(p->matrix[i * p->n + k]);
        largest = fmax(largest, sum);
    }
    for (int turn = 0; turn < STEPS && moved > 1e-15; turn++) {
        const double next = (1 + sqrt(1 + 4 * share * share)) / 2;
        double back = 0;

        memcpy(before, x, sizeof x);
        for (int i = 0; i < p->n; i++) {
            double sum = p->q[i];

            for (int k = 0; k < p->n; k++)
                sum += p->matrix[i * p->n + k] * y[k];
            x[i] = y[i] - sum / largest;
        }
        project(p, x);
        moved = 0;
        for (int i = 0; i < p->n; i++) {
            moved = fmax(moved, fabs(x[i] - before[i]) / p->bound[i]);
            back += (y[i] - x[i]) * (x[i] - before[i]);
        }
        for (int i = 0; i < p->n; i++)
            y[i] = back > 0 ? x[i] : x[i] + (share - 1) / next * (x[i] - before[i]);
        share = back > 0 ? 1 : next;
    }
    for (int i = 0; i < p->n; i++) {
        w[i] = p->q[i];
        for (int k = 0; k < p->n; k++)
            w[i] += p->matrix[i * p->n + k] * x[k];
    }
    return moved <= 1e-15;
}

static Verdict answers_meet_their_inequalities(Member *member)
{
    Problem *p = &problem;

    draw_cones(member, p, member_between(member, 0, 1) < 0.8 ? 6 : MOST / 3);
    p->motions = 1 + (int)member_between(member, 0, fmin(p->n + 3, MOST - 1));
    draw_matrix(member, p, 3);
    if (!solve(p)) {
        tell(member, "no solution of %d unknowns, %d motions\n", p->n, p->motions);
        return DISAGREES;
    }
    return keeps(member, "inequalities", error_of(p), 1e-9) ? AGREES : DISAGREES;
}

static Verdict gradients_lead_to_the_same_motion(Member *member)
{
    Problem *p = &problem;
    double w[MOST] = {0}, off = 0;

    draw_cones(member, p, 5);
    p->motions = 1 + (int)member_between(member, 0, p->n + 3);
    draw_matrix(member, p, 0.3);
    if (!solve(p)) {
        tell(member, "no solution of %d unknowns, %d motions\n", p->n, p->motions);
        return DISAGREES;
    }
    if (!keeps(member, "inequalities", error_of(p), 1e-9))
        return DISAGREES;
    if (!descend(p, w))
        return REFUSED;
    for (int i = 0; i < p->n; i++)
        off = fmax(off, fabs(w[i] - p->w[i]) / size_of(p, i));
    return keeps(member, "w of gradients", off, 1e-8) ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"answers meet their inequalities", 600, 0, 0, answers_meet_their_inequalities},
        {"gradients lead to the same motion", 200, 20, 0, gradients_lead_to_the_same_motion},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
