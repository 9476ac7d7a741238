/* family_loads.c: complementarity problems with bounds that are unknowns: contacts with friction
 *
 * A = W M^-1 W^T with random rows of one to three contacts, a normal and a tangent each, in any
 * order and of either sign; a free body has 3 motions, so that up to two contacts may have
 * independent rows. The oracle tries all sides of all contacts, open, sticking, slipping one or the
 * other way, by an elimination of its own. Where it has a solution there has to be one, which is
 * held against the inequalities; where there is none there must be none. */
#include "algebra/complementarity.h"

#include "family.h"

#include <string.h>

enum { CONTACTS = 3, MOST = 2 * CONTACTS, SIDES = 4 };

#define SOUND 1e-8 /* of the largest w */

typedef struct Problem {
    int contacts, n, motions;
    int normal[CONTACTS], tangent[CONTACTS]; /* rows */
    double matrix[MOST * MOST], q[MOST], low[MOST], high[MOST], share[MOST];
    int load[MOST];
    double largest;
} Problem;

static void draw(Member *member, Problem *p)
{
    double rows[MOST][MOST] = {{0}}, mass[MOST] = {0};
    int order[MOST] = {0};

    *p = (Problem){.contacts = 1 + member_one_of(member, CONTACTS)};
    p->n = 2 * p->contacts;
    p->motions = 2 + member_one_of(member, p->n);
    for (int i = 0; i < p->n; i++)
        order[i] = i;
    for (int i = p->n - 1; i > 0; i--) {
        const int k = member_one_of(member, i + 1), kept = order[i];

        order[i] = order[k];
        order[k] = kept;
    }
    for (int j = 0; j < p->motions; j++)
        mass[j] = member_decades(member, 0.1, 10);
    for (int i = 0; i < p->n; i++) {
        p->high[i] = INFINITY;
        p->load[i] = -1;
        p->q[i] = member_between(member, -1, 1);
        for (int j = 0; j < p->motions; j++)
            rows[i][j] = member_between(member, -1, 1);
    }
    for (int i = 0; i < p->n; i++)
        for (int k = 0; k < p->n; k++)
            for (int j = 0; j < p->motions; j++)
                p->matrix[i * p->n + k] += rows[i][j] * rows[k][j] / mass[j];
    for (int c = 0; c < p->contacts; c++) {
        p->normal[c] = order[2 * c];
        p->tangent[c] = order[2 * c + 1];
        p->load[p->tangent[c]] = p->normal[c];
        p->share[p->tangent[c]] = member_between(member, 0, 1);
    }
}

/* A x = b; false: singular */
static bool eliminate(int n, double a[MOST][MOST + 1], double *x)
{
    for (int k = 0; k < n; k++) {
        int best = k;

        for (int i = k; i < n; i++)
            best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
        if (!(fabs(a[best][k]) > 1e-9))
            return false;
        for (int j = 0; j <= n; j++) {
            const double kept = a[k][j];

            a[k][j] = a[best][j];
            a[best][j] = kept;
        }
        for (int i = 0; i < n; i++) {
            const double part = i == k ? 0 : a[i][k] / a[k][k];

            for (int j = k; j <= n && part != 0; j++)
                a[i][j] -= part * a[k][j];
        }
    }
    for (int i = 0; i < n; i++)
        x[i] = a[i][n] / a[i][i];
    return true;
}

static double row_of(const Problem *p, int i, const double *z)
{
    double w = p->q[i];

    for (int k = 0; k < p->n; k++)
        w += p->matrix[i * p->n + k] * z[k];
    return w;
}

/* how far z is from a solution, over the size of w; below `strict` it is one with room */
static double error_of(const Problem *p, const double *z)
{
    double worst = 0, size = 1, effort = 1;

    for (int i = 0; i < p->n; i++) {
        effort = fmax(effort, fabs(z[i]));
        for (int k = 0; k < p->n; k++)
            size = fmax(size, fabs(p->matrix[i * p->n + k] * z[k]));
    }
    for (int c = 0; c < p->contacts; c++) {
        const int n = p->normal[c], t = p->tangent[c];
        const double w_n = row_of(p, n, z) / size, w_t = row_of(p, t, z) / size;
        const double bound = p->share[t] * z[n], room = (bound - fabs(z[t])) / effort;

        worst = fmax(worst, fmax(-w_n, -z[n] / effort));
        worst = fmax(worst, fmin(fabs(w_n), z[n] / effort));
        worst = fmax(worst, -room);
        /* slips only at its bound, and against the effort */
        worst = fmax(worst, fmin(fabs(w_t), room));
        if (fabs(z[t]) > SOUND * effort)
            worst = fmax(worst, fmin(w_t * (z[t] > 0 ? 1 : -1), 1));
    }
    return worst;
}

/* a solution on some sides; false: there is none */
static bool try_all_sides(const Problem *p, double *z)
{
    int all = 1;

    for (int c = 0; c < p->contacts; c++)
        all *= SIDES;
    for (int sides = 0; sides < all; sides++) {
        double a[MOST][MOST + 1] = {{0}};

        for (int c = 0, left = sides; c < p->contacts; c++, left /= SIDES) {
            const int n = p->normal[c], t = p->tangent[c], side = left % SIDES;

            for (int k = 0; k < p->n; k++) {
                a[n][k] = side == 0 ? k == n : p->matrix[n * p->n + k];
                a[t][k] = side != 1 ? k == t : p->matrix[t * p->n + k];
            }
            a[n][p->n] = side == 0 ? 0 : -p->q[n];
            a[t][p->n] = side == 1 ? -p->q[t] : 0;
            if (side > 1)
                a[t][n] = side == 2 ? -p->share[t] : p->share[t];
        }
        if (eliminate(p->n, a, z) && error_of(p, z) <= SOUND / 100)
            return true;
    }
    return false;
}

static Verdict friction_follows_its_load(Member *member)
{
    Problem p;
    double z[MOST], expected[MOST], room[LOAD_COMPLEMENTARITY_ROOM(MOST)];
    int side[MOST] = {0}, integers[LOAD_COMPLEMENTARITY_INTEGERS(MOST)];
    LoadComplementarity problem;
    bool found, is_there;

    draw(member, &p);
    problem = (LoadComplementarity){
        .box = {p.n, p.matrix, p.q, p.low, p.high}, .load = p.load, .share = p.share};
    found = load_complementarity_solve(&problem, side, z, room, integers);
    is_there = try_all_sides(&p, expected);
    tell(member, "%d contacts, %d motions: %s, by all sides %s\n", p.contacts, p.motions,
         found ? "found" : "none", is_there ? "there is one" : "none");
    if (found)
        return keeps(member, "inequalities", error_of(&p, z), SOUND) ? AGREES : DISAGREES;
    if (!is_there)
        return AGREES;
    /* of three contacts all sides are tried last, with pivots that may be too small */
    return p.contacts > 2 ? REFUSED : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"friction_follows_its_load", 2000, 0.02, 0, friction_follows_its_load}};

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
