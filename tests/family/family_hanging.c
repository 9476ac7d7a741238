/* family_hanging.c: rods that hang from each other's ends, in runs that are long enough to
 * eliminate their accelerations in symbols, against Lagrange's equations in angles
 *
 * The middle of rod k is at sum c_ki (cos a_i, sin a_i), c_ki = l_i for those it hangs from, l_k/2
 * for itself. With A_ij = sum_k m_k c_ki c_kj the equations are
 *
 *     J_i a_i'' + sum_j A_ij (cos(a_i - a_j) a_j'' + sin(a_i - a_j) a_j'^2) = -g cos a_i sum_k m_k
 * c_ki
 *
 * solved by Cholesky, and integrated by the classical Runge-Kutta method in steps that are halved.
 */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#include <math.h>

#define GRAVITY 9.81

/* steps by hand, of few rods */
enum { MOST_RODS = 70, FEW = 8, FIRST_STEPS = 256, MOST_STEPS = 1 << 14 };

typedef struct Rods {
    int count, parent[MOST_RODS];
    double length[MOST_RODS], mass[MOST_RODS], inertia[MOST_RODS], start[MOST_RODS];
    double joined[MOST_RODS][MOST_RODS], weight[MOST_RODS]; /* A; g sum m c */
} Rods;

static double draw(Member *member, double low, double high)
{
    return test_uniform(&member->random, low, high);
}

static int one_of(Member *member, int count)
{
    return (int)(test_random(&member->random) % (uint64_t)count);
}

/* what rod k adds to the equations of those that it hangs from */
static void join(Rods *r, int k)
{
    double arm[MOST_RODS] = {0};

    for (int i = k; i >= 0; i = r->parent[i])
        arm[i] = i == k ? r->length[i] / 2 : r->length[i];
    for (int i = k; i >= 0; i = r->parent[i]) {
        r->weight[i] += GRAVITY * r->mass[k] * arm[i];
        for (int j = k; j >= 0; j = r->parent[j])
            r->joined[i][j] += r->mass[k] * arm[i] * arm[j];
    }
}

/* few, or so many that pivots of a chain's constraints become small; chains and trees */
static void draw_rods(Member *member, Rods *r)
{
    const bool many = one_of(member, 3) == 0, is_tree = one_of(member, 2) == 0;
    const double spread = one_of(member, 2) == 0 ? 1 : 10;

    *r = (Rods){.count = many ? 40 + one_of(member, MOST_RODS - 40) : 1 + one_of(member, FEW)};
    for (int i = 0; i < r->count; i++) {
        r->parent[i] = is_tree && i > 0 ? (i - 1) / 2 : i - 1;
        r->length[i] = draw(member, 0.3, 1);
        r->mass[i] = pow(spread, draw(member, -0.5, 0.5));
        r->inertia[i] = r->mass[i] * r->length[i] * r->length[i] * draw(member, 0.05, 0.1);
        r->start[i] = -1.57 + draw(member, -0.4, 0.4);
    }
    for (int k = 0; k < r->count; k++)
        join(r, k);
}

/* --- by hand --- */

/* x becomes the solution of a x = x, a positive definite; its factor is left in a */
static void solve(int n, double a[MOST_RODS][MOST_RODS], double *x)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double sum = a[i][j];

            for (int k = 0; k < j; k++)
                sum -= a[i][k] * a[j][k];
            a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
        }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            x[i] -= a[k][i] * x[k];
        x[i] /= a[i][i];
    }
}

/* y: angles, then their rates */
static void rate(const Rods *r, const double *y, double *out)
{
    static double a[MOST_RODS][MOST_RODS];
    const double *speed = y + r->count;
    double *bend = out + r->count, c[MOST_RODS], s[MOST_RODS];

    for (int i = 0; i < r->count; i++) {
        c[i] = cos(y[i]);
        s[i] = sin(y[i]);
    }
    for (int i = 0; i < r->count; i++) {
        out[i] = speed[i];
        bend[i] = -r->weight[i] * c[i];
        for (int j = 0; j < r->count; j++) {
            a[i][j] = r->joined[i][j] * (c[i] * c[j] + s[i] * s[j]);
            bend[i] -= r->joined[i][j] * (s[i] * c[j] - c[i] * s[j]) * speed[j] * speed[j];
        }
        a[i][i] += r->inertia[i];
    }
    solve(r->count, a, bend);
}

static void integrate(const Rods *r, double span, int steps, double *y)
{
    static const double part[] = {0, 0.5, 0.5, 1}, weight[] = {1, 2, 2, 1};
    const int n = 2 * r->count;
    const double h = span / steps;
    double k[4][2 * MOST_RODS], point[2 * MOST_RODS];

    for (int i = 0; i < n; i++)
        y[i] = i < r->count ? r->start[i] : 0;
    for (int step = 0; step < steps; step++) {
        for (int s = 0; s < 4; s++) {
            for (int i = 0; i < n; i++)
                point[i] = y[i] + (s > 0 ? part[s] * h * k[s - 1][i] : 0);
            rate(r, point, k[s]);
        }
        for (int s = 0; s < 4; s++)
            for (int i = 0; i < n; i++)
                y[i] += h / 6 * weight[s] * k[s][i];
    }
}

/* the largest difference of angles */
static double difference(const Rods *r, const double *a, const double *b)
{
    double most = 0;

    for (int i = 0; i < r->count; i++)
        most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

/* by how much errors on the way may have grown up to the end */
static double growth(const Rods *r, double span)
{
    const double off = 1e-6;
    static Rods beside;
    double here[2 * MOST_RODS], there[2 * MOST_RODS];

    beside = *r;
    for (int i = 0; i < r->count; i++)
        beside.start[i] += i % 2 == 0 ? off : -off;
    integrate(r, span, FIRST_STEPS, here);
    integrate(&beside, span, FIRST_STEPS, there);
    return fmax(1, difference(r, here, there) / off);
}

/* the angles at the end; false: steps that the time allows don't tell them to `exact` */
static bool by_hand(const Rods *r, double span, double exact, double *out)
{
    double coarse[2 * MOST_RODS];

    integrate(r, span, FIRST_STEPS, coarse);
    for (int steps = 2 * FIRST_STEPS; steps <= MOST_STEPS / (r->count > FEW ? 4 : 1); steps *= 2) {
        integrate(r, span, steps, out);
        if (difference(r, out, coarse) < exact)
            return true;
        memcpy(coarse, out, sizeof coarse);
    }
    return false;
}

/* --- ours --- */

static void write_rods(Script *script, const Rods *r)
{
    script->length = 0;
    write_line(script, "scene planar\ngravity [0, -%g]", GRAVITY);
    for (int i = 0; i < r->count; i++) {
        write_line(script, "body b%d mass=%.17g inertia=%.17g", i, r->mass[i], r->inertia[i]);
        write_line(script, "arm a%d b%d [-%.17g, 0]\narm e%d b%d [%.17g, 0]", i, i,
                   r->length[i] / 2, i, i, r->length[i] / 2);
        if (r->parent[i] < 0)
            write_line(script, "revolute h%d ground a%d", i, i);
        else
            write_line(script, "revolute h%d e%d a%d", i, r->parent[i], i);
    }
    for (int i = 0; i < r->count; i++)
        write_line(script, "init h%d = %.17g, h%d' = 0", i,
                   r->start[i] - (r->parent[i] < 0 ? 0 : r->start[r->parent[i]]), i);
}

static Verdict rods_end_where_lagrange_has_them(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "dop853", "radau"};
    static Rods r;
    static Script script;
    Kit kit = kit_new();
    double end[2 * MOST_RODS], span, rtol, bound, worst = 0;
    int every;
    ct_status status;

    draw_rods(member, &r);
    span = r.count > FEW ? draw(member, 0.3, 0.6) : draw(member, 0.5, 2);
    rtol = pow(10, draw(member, -8, -5));
    every = 1 + one_of(member, 200);
    write_rods(&script, &r);
    write_line(&script, "tree %s", one_of(member, 4) == 0 ? "joint" : "absolute");
    write_line(&script, "simulate %.17g every=%.17g rtol=%.3g atol=%.3g method=%s", span,
               span / every, rtol, rtol, r.count > FEW ? "dop853" : methods[one_of(member, 4)]);
    status = kit_do(&kit, script.text);
    tell(member, "%s%s\n", script.text, status == CT_OK ? "went on" : kit.error.message);
    bound = rtol * growth(&r, span);
    if (status != CT_OK || !by_hand(&r, span, 0.1 * bound, end)) {
        kit_free(&kit);
        return status != CT_OK ? DISAGREES : REFUSED;
    }
    for (int i = 0; i < r.count; i++) {
        char item[24];
        double angle;

        (void)snprintf(item, sizeof item, "b%d.theta", i);
        angle = kit_value(&kit, item);
        tell(member, "%s: %.12g, by hand %.12g, bound %.3g\n", item, angle, end[i], bound);
        worst = isnan(angle) ? INFINITY : fmax(worst, fabs(angle - end[i]));
    }
    kit_free(&kit);
    member->figure = worst / bound;
    return worst <= bound ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"rods_end_where_lagrange_has_them", 3, 0.3, 0, rods_end_where_lagrange_has_them},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
