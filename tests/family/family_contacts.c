/* family_contacts.c: a body in the plane that falls, bounces, slides, sticks and tips on planes
 *
 * The oracle integrates m r'' = m g + sum P, I w' = sum rho x P by Runge and Kutta's method. Where
 * contacts change it tries all their sides: open, sticking, slipping one or the other way; those
 * that meet their inequalities have to agree in the accelerations. Impacts likewise: Poisson's two
 * phases with Coulomb's law in both. It ends before what it can't tell: impacts that follow each
 * other closely, and sides with several motions. How much errors grow is seen from a second start
 * next to the first. */
#include "../unit/session_kit.h"
#include "base/memory.h"
#include "base/text.h"
#include "family.h"

#include <math.h>

enum {
    POINTS = 3,
    PLANES = 2,
    MOST = POINTS * PLANES,
    ROWS = 3 + 2 * MOST,
    IMPACTS = 6,
    CHANGES = 40
};

/* sides of a contact: its normal effort is the least one, or its point goes along the plane; and
 * then it sticks, or slips to the right or left */
enum { STICKS, RIGHT, LEFT, CLOSED, SIDES = 2 * CLOSED };

#define STEP     1e-3
#define TURN     3e-3 /* rad: of a step */
#define TOUCHES  1e-9 /* m */
#define STILL    1e-8 /* m/s */
#define SOUND    1e-9 /* of forces and accelerations */
#define SLOW     0.03 /* m/s: an impact so slow may end a series */
#define TOGETHER 2e-3 /* s */
#define NEAR     1e-9 /* the second start is away */

typedef struct Touch {
    int point, plane;
    double mu, ratio, e;
} Touch;

typedef struct Scene {
    double mass, inertia, gravity[2];
    int points, planes, count;
    double at[POINTS][2], radius[POINTS];
    double angle[PLANES], offset[PLANES]; /* of the line: n = (-sin, cos), n.r = offset */
    Touch touch[MOST];
} Scene;

/* q: x, y, theta; v: their rates */
typedef struct Course {
    double t, q[3], v[3];
    int side[MOST], impacts, changes;
    double last;
    bool ends;
} Course;

/* of a contact at q: the gap, rows for its normal and tangential velocity, and what w adds to the
 * accelerations */
typedef struct Spot {
    double gap, n[3], t[3], bias_n, bias_t;
} Spot;

static void find_spot(const Scene *s, const Course *c, int k, Spot *out)
{
    const Touch *touch = &s->touch[k];
    const double *at = s->at[touch->point], r = s->radius[touch->point];
    const double a = s->angle[touch->plane], n[2] = {-sin(a), cos(a)}, t[2] = {cos(a), sin(a)};
    const double rho[2] = {cos(c->q[2]) * at[0] - sin(c->q[2]) * at[1],
                           sin(c->q[2]) * at[0] + cos(c->q[2]) * at[1]};
    const double low[2] = {rho[0] - r * n[0], rho[1] - r * n[1]};
    const double square = c->v[2] * c->v[2];

    out->gap = n[0] * (c->q[0] + rho[0]) + n[1] * (c->q[1] + rho[1]) - r - s->offset[touch->plane];
    for (int i = 0; i < 2; i++) {
        out->n[i] = n[i];
        out->t[i] = t[i];
    }
    out->n[2] = rho[0] * n[1] - rho[1] * n[0];
    out->t[2] = low[0] * t[1] - low[1] * t[0];
    out->bias_n = -square * (n[0] * rho[0] + n[1] * rho[1]);
    out->bias_t = -square * (t[0] * rho[0] + t[1] * rho[1]);
}

static double along(const double *row, const double *v)
{
    return row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
}

/* A x = b by elimination with row exchanges; false: singular */
static bool eliminate(int n, double a[ROWS][ROWS + 1], double *x)
{
    for (int k = 0; k < n; k++) {
        int best = k;

        for (int i = k + 1; i < n; i++)
            if (fabs(a[i][k]) > fabs(a[best][k]))
                best = i;
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

/* What contacts do on these sides: the change x of v (accelerations, or jumps of speeds), normal
 * and tangential efforts. start: x without them; wanted_n, wanted_t: of each contact what x has to
 * change its velocity by; least: the normal effort of one that isn't closed. */
static bool respond(const Scene *s, const Spot *spots, const int *side, const double *start,
                    const double *wanted_n, const double *wanted_t, const double *least, double *x,
                    double *fn, double *ft)
{
    const double mass[3] = {s->mass, s->mass, s->inertia};
    double a[ROWS][ROWS + 1] = {{0}}, all[ROWS];
    const int n = 3 + 2 * s->count;

    for (int i = 0; i < 3; i++) {
        a[i][i] = 1;
        a[i][n] = start[i];
    }
    for (int k = 0; k < s->count; k++) {
        const int row_n = 3 + 2 * k, row_t = row_n + 1, tangent = side[k] % CLOSED;
        const bool closed = side[k] >= CLOSED;

        for (int i = 0; i < 3; i++) {
            a[i][row_n] = -spots[k].n[i] / mass[i];
            a[i][row_t] = -spots[k].t[i] / mass[i];
            a[row_n][i] = closed ? spots[k].n[i] : 0;
            a[row_t][i] = tangent == STICKS ? spots[k].t[i] : 0;
        }
        a[row_n][row_n] = !closed;
        a[row_n][n] = closed ? wanted_n[k] : least[k];
        a[row_t][row_t] = tangent != STICKS;
        a[row_t][row_n] = tangent == RIGHT ? s->touch[k].mu : tangent == LEFT ? -s->touch[k].mu : 0;
        a[row_t][n] = tangent == STICKS ? wanted_t[k] : 0;
    }
    if (!eliminate(n, a, all))
        return false;
    memcpy(x, all, 3 * sizeof(double));
    for (int k = 0; k < s->count; k++) {
        fn[k] = all[3 + 2 * k];
        ft[k] = all[4 + 2 * k];
    }
    return true;
}

static bool next_sides(int count, const bool *takes_part, int *side)
{
    for (int k = 0; k < count; k++) {
        if (!takes_part[k])
            continue;
        if (++side[k] < SIDES)
            return true;
        side[k] = RIGHT;
    }
    return false;
}

/* whether a side holds: what remains of the normal and tangential velocity or acceleration, and
 * efforts over the mass */
static bool holds(const Touch *touch, int side, double rate_n, double rate_t, double fn, double ft,
                  double least, double ratio, double small)
{
    const int tangent = side % CLOSED;

    if (side < CLOSED && rate_n < -small)
        return false;
    if (side >= CLOSED && fn < least - small)
        return false;
    if (tangent == STICKS)
        return fabs(ft) <= ratio * touch->mu * fn + small;
    return fn <= small || touch->mu == 0 || (tangent == RIGHT ? rate_t : -rate_t) >= -small;
}

static void begin_sides(const Scene *s, int *side)
{
    for (int k = 0; k < s->count; k++)
        side[k] = RIGHT;
}

static bool accelerate(const Scene *s, const Course *c, const int *side, double *a, double *fn,
                       double *ft)
{
    const double start[3] = {s->gravity[0], s->gravity[1], 0}, none[MOST] = {0};
    double n[MOST], t[MOST];
    Spot spots[MOST];

    for (int k = 0; k < s->count; k++) {
        find_spot(s, c, k, &spots[k]);
        n[k] = -spots[k].bias_n;
        t[k] = -spots[k].bias_t;
    }
    return respond(s, spots, side, start, n, t, none, a, fn, ft);
}

static bool is_other(const double *a, const double *b, double small)
{
    return fabs(a[0] - b[0]) + fabs(a[1] - b[1]) + fabs(a[2] - b[2]) > small;
}

/* the sides that go on from here; false: none, or several motions */
static bool choose(const Scene *s, Course *c)
{
    bool closed[MOST];
    int side[MOST], best = -1;
    double first[3] = {0};
    Spot spots[MOST];

    for (int k = 0; k < s->count; k++) {
        find_spot(s, c, k, &spots[k]);
        closed[k] = spots[k].gap <= TOUCHES && along(spots[k].n, c->v) <= STILL;
    }
    begin_sides(s, side);
    do {
        double a[3], fn[MOST], ft[MOST], size;
        bool sound = true;
        int sticks = 0;

        for (int k = 0; k < s->count && sound; k++) {
            const double slip = along(spots[k].t, c->v);

            sticks += side[k] < CLOSED ? 0 : side[k] % CLOSED == STICKS ? 2 : 1;
            sound = side[k] == RIGHT ||
                    (closed[k] && side[k] >= CLOSED &&
                     (fabs(slip) <= STILL || side[k] == CLOSED + (slip > 0 ? RIGHT : LEFT)));
        }
        if (!sound || !accelerate(s, c, side, a, fn, ft))
            continue;
        size = 1 + hypot(s->gravity[0], s->gravity[1]) + fabs(a[0]) + fabs(a[1]) + fabs(a[2]);
        for (int k = 0; k < s->count && sound; k++)
            sound = !closed[k] ||
                    holds(&s->touch[k], side[k], along(spots[k].n, a) + spots[k].bias_n,
                          fabs(along(spots[k].t, c->v)) > STILL
                              ? (side[k] % CLOSED == RIGHT ? 1 : -1)
                              : along(spots[k].t, a) + spots[k].bias_t,
                          fn[k] / s->mass, ft[k] / s->mass, 0, s->touch[k].ratio, SOUND * size);
        if (!sound)
            continue;
        if (best >= 0 && is_other(a, first, 1e-6 * size))
            return false;
        memcpy(first, a, sizeof first);
        if (sticks > best)
            memcpy(c->side, side, sizeof side);
        best = sticks > best ? sticks : best;
    } while (next_sides(s->count, closed, side));
    return best >= 0;
}

/* One phase of an impact: v after it, with normal impulses of at least `least`. False: none, or
 * several. */
static bool strike(const Scene *s, const Spot *spots, const bool *closed, const double *least,
                   double *v, double *impulse)
{
    const double none[3] = {0};
    double after[3] = {0}, kept[MOST] = {0};
    int side[MOST];
    bool found = false;

    begin_sides(s, side);
    do {
        double n[MOST], t[MOST], low[MOST], now[3], fn[MOST], ft[MOST];
        bool sound = true;

        for (int k = 0; k < s->count; k++) {
            n[k] = -along(spots[k].n, v);
            t[k] = -along(spots[k].t, v);
            low[k] = closed[k] ? least[k] : 0;
        }
        if (!respond(s, spots, side, none, n, t, low, now, fn, ft))
            continue;
        for (int i = 0; i < 3; i++)
            now[i] += v[i];
        for (int k = 0; k < s->count && sound; k++)
            sound = !closed[k] ||
                    holds(&s->touch[k], side[k], along(spots[k].n, now), along(spots[k].t, now),
                          fn[k] / s->mass, ft[k] / s->mass, low[k] / s->mass, 1, SOUND);
        if (!sound)
            continue;
        if (found && is_other(now, after, 1e-7))
            return false;
        memcpy(after, now, sizeof after);
        memcpy(kept, fn, sizeof kept);
        found = true;
    } while (next_sides(s->count, closed, side));
    memcpy(v, after, sizeof after);
    memcpy(impulse, kept, sizeof kept);
    return found;
}

/* All contacts that are closed take part. False: the oracle doesn't know. */
static bool take_impact(const Scene *s, Course *c)
{
    double least[MOST] = {0}, compression[MOST], impulse[MOST], approach = 0;
    bool closed[MOST], bounces = false;
    Spot spots[MOST];

    for (int k = 0; k < s->count; k++) {
        find_spot(s, c, k, &spots[k]);
        closed[k] = spots[k].gap <= TOUCHES;
        if (closed[k])
            approach = fmax(approach, -along(spots[k].n, c->v));
    }
    if (approach <= STILL)
        return true;
    for (int k = 0; k < s->count; k++)
        bounces = bounces || (closed[k] && s->touch[k].e > 0);
    if (bounces && (approach < SLOW || c->t - c->last < TOGETHER))
        return false;
    if (c->impacts++ == IMPACTS || !strike(s, spots, closed, least, c->v, compression))
        return false;
    c->last = c->t;
    for (int k = 0; k < s->count; k++)
        least[k] = s->touch[k].e * compression[k];
    return strike(s, spots, closed, least, c->v, impulse);
}

/* --- between --- */

static bool slope(const Scene *s, const Course *c, double *out)
{
    double fn[MOST], ft[MOST];

    memcpy(out, c->v, sizeof c->v);
    return accelerate(s, c, c->side, out + 3, fn, ft);
}

static Course moved(const Course *c, double h, const double *rate)
{
    Course out = *c;

    out.t += h;
    for (int i = 0; i < 3; i++) {
        out.q[i] += h * rate[i];
        out.v[i] += h * rate[3 + i];
    }
    return out;
}

/* a step of Runge and Kutta's on the same sides */
static bool step(const Scene *s, const Course *c, double h, Course *out)
{
    double k[4][6], mean[6];
    Course at = *c;

    for (int i = 0; i < 4; i++) {
        if (i > 0)
            at = moved(c, i == 3 ? h : h / 2, k[i - 1]);
        if (!slope(s, &at, k[i]))
            return false;
    }
    for (int i = 0; i < 6; i++)
        mean[i] = (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]) / 6;
    *out = moved(c, h, mean);
    return true;
}

/* whether the sides still hold there */
static bool still_holds(const Scene *s, const Course *c)
{
    double a[3], fn[MOST], ft[MOST];

    if (!accelerate(s, c, c->side, a, fn, ft))
        return false;
    for (int k = 0; k < s->count; k++) {
        const int tangent = c->side[k] % CLOSED;
        Spot spot;
        double slip;

        find_spot(s, c, k, &spot);
        slip = along(spot.t, c->v);
        if (c->side[k] < CLOSED) {
            if (spot.gap < 0 && along(spot.n, c->v) < 0)
                return false;
        } else if (fn[k] < -SOUND * s->mass ||
                   (tangent == STICKS &&
                    fabs(ft[k]) > s->touch[k].ratio * s->touch[k].mu * fn[k] + SOUND * s->mass) ||
                   (tangent != STICKS && (tangent == RIGHT ? slip : -slip) < -STILL / 10))
            return false;
    }
    return true;
}

/* to `end`, or to where the oracle tells no more, which becomes its end */
static void follow(const Scene *s, Course *c, double end)
{
    while (c->t < end && !c->ends) {
        const double most = fmin(fmin(STEP, TURN / fabs(c->v[2])), end - c->t);
        Course next, before = *c;

        if (!take_impact(s, c) || !choose(s, c) || !step(s, c, most, &next)) {
            *c = before;
            c->ends = true;
            break;
        }
        if (!still_holds(s, &next)) {
            double low = 0, high = most;

            for (int i = 0; i < 60 && high - low > 1e-14; i++) {
                const double middle = (low + high) / 2;

                if (step(s, c, middle, &next) && still_holds(s, &next))
                    low = middle;
                else
                    high = middle;
            }
            (void)step(s, c, high, &next); /* just beyond */
        }
        c->changes += next.t - c->t < 0.999 * most;
        next.changes = c->changes;
        *c = next;
        c->ends = c->changes > CHANGES;
    }
}

/* --- a member --- */

static bool one_in(Member *member, int count)
{
    return member_one_of(member, count) == 0;
}

static void draw_shape(Member *member, Scene *s)
{
    s->points = 1 + member_one_of(member, POINTS);
    s->mass = member_decades(member, 0.05, 20);
    s->inertia = s->mass * member_between(member, 0.02, 0.2);
    s->gravity[0] = one_in(member, 3) ? member_between(member, -3, 3) : 0;
    s->gravity[1] = -member_between(member, 4, 12);
    for (int i = 0; i < s->points; i++) {
        const double angle = member_between(member, -3.1, 3.1);
        const double r = one_in(member, 4) ? 0 : member_between(member, 0.05, 0.5);

        s->at[i][0] = r * cos(angle);
        s->at[i][1] = r * sin(angle);
        s->radius[i] = one_in(member, 2) ? member_between(member, 0.05, 0.3) : 0;
    }
    s->planes = 1 + one_in(member, 3);
    s->angle[0] = one_in(member, 2) ? 0 : member_between(member, -0.5, 0.5);
    s->angle[1] = s->angle[0] + (one_in(member, 2) ? 1.2 : -1.2);
}

static void draw_touches(Member *member, Scene *s)
{
    const double e = one_in(member, 2) ? 0 : member_between(member, 0.1, 0.9);
    const double mu = one_in(member, 4) ? 0 : member_between(member, 0.05, 0.8);

    for (int i = 0; i < s->points; i++)
        for (int p = 0; p < s->planes; p++)
            s->touch[s->count++] = (Touch){.point = i,
                                           .plane = p,
                                           .mu = one_in(member, 4) ? mu / 2 : mu,
                                           .ratio = one_in(member, 2) ? 1.2 : 1,
                                           .e = e};
}

/* All points above the planes: the lowest one above the first by `high`, or on it. */
static void draw_start(Member *member, Scene *s, Course *c)
{
    const double high = one_in(member, 3) ? 0 : member_between(member, 0.01, 0.5);

    c->q[2] = member_between(member, -3, 3);
    for (int i = 0; i < 3; i++)
        c->v[i] = member_between(member, -2, 2) * (i == 2 ? 2 : 1);
    for (int p = 0; p < s->planes; p++) {
        double least = INFINITY;

        for (int k = 0; k < s->count; k++) {
            Spot spot;

            find_spot(s, c, k, &spot);
            if (s->touch[k].plane == p)
                least = fmin(least, spot.gap);
        }
        s->offset[p] += least - (p == 0 ? high : member_between(member, 0.05, 0.5));
    }
    if (high == 0) { /* in contact, without an impact at the start */
        Spot spot;
        double rate;

        for (int k = 0; k < s->count; k++) {
            find_spot(s, c, k, &spot);
            if (s->touch[k].plane != 0 || spot.gap > TOUCHES)
                continue;
            rate = along(spot.n, c->v);
            c->v[0] -= rate * spot.n[0];
            c->v[1] -= rate * spot.n[1];
        }
    }
}

static void write_scene(Member *member, const Scene *s, const Course *c, Text *out)
{
    text_addf(out, "scene planar; gravity [%.17g, %.17g]\nbody b mass=%.17g inertia=%.17g\n",
              s->gravity[0], s->gravity[1], s->mass, s->inertia);
    for (int i = 0; i < s->points; i++)
        text_addf(out, "arm p%d b [%.17g, %.17g]\n", i, s->at[i][0], s->at[i][1]);
    for (int p = 0; p < s->planes; p++)
        text_addf(out, "arm f%d ground [%.17g, %.17g] rotation=z(%.17g)\n", p,
                  -sin(s->angle[p]) * s->offset[p], cos(s->angle[p]) * s->offset[p], s->angle[p]);
    for (int k = 0; k < s->count; k++) {
        const Touch *touch = &s->touch[k];

        text_addf(out, "contact c%d f%d p%d e=%.17g", k, touch->plane, touch->point, touch->e);
        if (s->radius[touch->point] > 0)
            text_addf(out, " radius=%.17g", s->radius[touch->point]);
        if (touch->mu > 0)
            text_addf(out, " mu=%.17g static=%.17g", touch->mu, touch->ratio);
        text_char(out, '\n');
    }
    if (one_in(member, 2))
        text_add(out, "tree absolute\n");
    if (one_in(member, 3))
        text_add(out, "form embedded\n");
    text_addf(out,
              "init b.x = %.17g, b.y = %.17g, b.theta = %.17g\n"
              "init b.x' = %.17g, b.y' = %.17g, b.theta' = %.17g\n",
              c->q[0], c->q[1], c->q[2], c->v[0], c->v[1], c->v[2]);
}

static Verdict compare(Member *member, Kit *kit, const Course *c, const Course *other)
{
    static const char *const names[] = {"b.x", "b.y", "b.theta", "b.x'", "b.y'", "b.theta'"};
    Verdict verdict = AGREES;

    for (int i = 0; i < 6; i++) {
        const double is = i < 3 ? c->q[i] : c->v[i - 3];
        const double near = i < 3 ? other->q[i] : other->v[i - 3];
        const double bound = 2e-7 * (1 + c->impacts) + 1000 * fabs(is - near);

        if (!keeps(member, names[i], fabs(kit_value(kit, names[i]) - is), bound))
            verdict = DISAGREES;
    }
    return verdict;
}

static Verdict bodies_on_planes(Member *member)
{
    static const char *const methods[] = {"dop853", "radau", "bdf", "auto"};
    const double wanted = member_between(member, 0.1, 1.5);
    Scene s = {0};
    Course start = {.last = -1}, c, other;
    Text text = {0};
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    draw_shape(member, &s);
    draw_touches(member, &s);
    draw_start(member, &s, &start);
    write_scene(member, &s, &start, &text);
    c = other = start;
    follow(&s, &c, wanted);
    if (c.ends) { /* well before what it can't tell */
        const double end = c.t - 2 * STEP;

        c = start;
        follow(&s, &c, end);
    }
    other.v[0] += NEAR;
    follow(&s, &other, c.t);
    text_addf(&text, "simulate %.17g rtol=1e-10 atol=1e-12 method=%s\n", c.t,
              methods[member_one_of(member, COUNT(methods))]);
    tell(member, "%s%d impacts\n", text.at, c.impacts);
    if (!(c.t > 0.02) || c.impacts != other.impacts || other.ends || fabs(c.t - other.t) > 1e-12) {
        verdict = REFUSED;
    } else if (kit_do(&kit, text.at) != CT_OK) {
        tell(member, "refused: %s\n", kit.error.message);
        verdict = DISAGREES;
    } else {
        verdict = compare(member, &kit, &c, &other);
    }
    text_free(&text);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {{"bodies_on_planes", 60, 0.4, 0, bodies_on_planes}};

    return family_main(families, COUNT(families), argc, argv);
}
