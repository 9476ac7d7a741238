/* family_rolling.c: balls, wheels and ellipsoids on inclined planes, against Newton and Euler
 *
 * A body with any inertia, on which the round shape sits anywhere and at any attitude, rolls on a
 * plane. The oracle writes the moments about the centre of mass,
 *
 *     J w' + w x J w = rho x F,   F = m (v' - g),   v = -w x rho
 *
 * with rho from the centre of mass to the point of contact, which follows from the attitude by the
 * shape alone, and rho' by differences of that. Every second plane turns evenly about an axis
 * through its origin o, with its point of contact: v = W x (c + rho - o) - w x rho. It takes fixed
 * steps of Runge and Kutta, once and twice as many. */
#include "../unit/session_kit.h"
#include "base/text.h"
#include "family.h"
#include "vectors.h"

#include <math.h>

typedef enum Shape { BALL, WHEEL, RIM, ELLIPSOID, SHAPES } Shape;

typedef struct Rolling {
    Shape shape;
    double mass, inertia[3], radius, rim, semiaxes[3];
    V hub, gravity, plane; /* of the shape on the body; of the plane's origin */
    M own, tilt;           /* attitude of the shape on the body; of the plane */
    double hub_turn[2], plane_turn[2];
    V spin; /* W */
    double end;
} Rolling;

typedef struct Pose {
    double q[4]; /* Euler parameters */
    V c, w;
} Pose;

static V normal_of(const Rolling *r, double t)
{
    static const double none[4] = {1, 0, 0, 0};
    double q[4];
    M turned_by;

    turn(none, plus((V){{0}}, t, r->spin), q);
    turned_by = matrix_of(q);
    return apply(&turned_by, apply(&r->tilt, (V){{0, 0, 1}}));
}

/* from the centre of mass to the point of contact; *upright: 0 where a wheel lies flat */
static V contact_from(const Rolling *r, double t, const double q[4], double *upright)
{
    const M body = matrix_of(q);
    const V n = normal_of(r, t), hub = apply(&body, r->hub);
    V d, m;
    double size = 0;

    *upright = 1;
    switch (r->shape) {
    case BALL:
        return plus(hub, -r->radius, n);
    case WHEEL:
    case RIM:
        d = apply(&body, apply(&r->own, (V){{0, 1, 0}}));
        d = plus(n, -dot(n, d), d);
        *upright = sqrt(dot(d, d));
        return plus(plus(hub, -r->radius / *upright, d), -r->rim, n);
    default:
        m = apply_back(&r->own, apply_back(&body, n));
        for (int i = 0; i < 3; i++) {
            size += pow(r->semiaxes[i] * m.at[i], 2);
            m.at[i] *= r->semiaxes[i] * r->semiaxes[i];
        }
        return plus(hub, -1 / sqrt(size), apply(&body, apply(&r->own, m)));
    }
}

static V contact_rate(const Rolling *r, double t, const double q[4], V w)
{
    const double h = 1e-3 / (1 + sqrt(dot(w, w)));
    static const double weight[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
    static const double at[4] = {-2, -1, 1, 2};
    V sum = {{0}};

    for (int k = 0; k < 4; k++) {
        double moved[4], ignored;

        turn(q, plus((V){{0}}, at[k] * h, w), moved);
        sum = plus(sum, weight[k] / h, contact_from(r, t + at[k] * h, moved, &ignored));
    }
    return sum;
}

/* a x = b by Cramer's rule */
static V solve(const M *a, V b)
{
    const V c[3] = {{{a->at[0][0], a->at[1][0], a->at[2][0]}},
                    {{a->at[0][1], a->at[1][1], a->at[2][1]}},
                    {{a->at[0][2], a->at[1][2], a->at[2][2]}}};
    const double whole = dot(c[0], cross(c[1], c[2]));

    return (V){{dot(b, cross(c[1], c[2])) / whole, dot(c[0], cross(b, c[2])) / whole,
                dot(c[0], cross(c[1], b)) / whole}};
}

static void rates(const Rolling *r, double t, const Pose *p, Pose *out, double *push,
                  double *upright)
{
    const M body = matrix_of(p->q);
    const V rho = contact_from(r, t, p->q, upright), rho_rate = contact_rate(r, t, p->q, p->w);
    const V from_origin = plus(plus(p->c, 1, rho), -1, r->plane);
    const V own = apply_back(&body, p->w);
    const double square = dot(rho, rho);
    V momentum, force, right;
    M whole;

    for (int i = 0; i < 3; i++)
        momentum.at[i] = r->inertia[i] * own.at[i];
    momentum = apply(&body, momentum);
    out->c = plus(cross(r->spin, from_origin), -1, cross(p->w, rho));
    /* at w' = 0, by mass */
    force = plus(cross(r->spin, plus(out->c, 1, rho_rate)), -1, cross(p->w, rho_rate));
    force = plus(force, -1, r->gravity);
    right = plus(plus((V){{0}}, r->mass, cross(rho, force)), -1, cross(p->w, momentum));
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            whole.at[i][k] = r->mass * ((i == k) * square - rho.at[i] * rho.at[k]);
            for (int j = 0; j < 3; j++)
                whole.at[i][k] += body.at[i][j] * r->inertia[j] * body.at[k][j];
        }
    out->w = solve(&whole, right);
    force = plus(force, -1, cross(out->w, rho));
    *push = r->mass * dot(force, normal_of(r, t));
    out->q[0] = (-p->q[1] * p->w.at[0] - p->q[2] * p->w.at[1] - p->q[3] * p->w.at[2]) / 2;
    out->q[1] = (p->q[0] * p->w.at[0] - p->q[2] * p->w.at[2] + p->q[3] * p->w.at[1]) / 2;
    out->q[2] = (p->q[0] * p->w.at[1] + p->q[1] * p->w.at[2] - p->q[3] * p->w.at[0]) / 2;
    out->q[3] = (p->q[0] * p->w.at[2] - p->q[1] * p->w.at[1] + p->q[2] * p->w.at[0]) / 2;
}

static void step_by(Pose *p, double h, const Pose *rate)
{
    for (int i = 0; i < 4; i++)
        p->q[i] += h * rate->q[i];
    p->c = plus(p->c, h, rate->c);
    p->w = plus(p->w, h, rate->w);
}

/* the force along the normal at the end; *lowest: how flat a wheel has lain */
static double follow(const Rolling *r, Pose *p, int steps, double *lowest)
{
    const double h = r->end / steps, part[4] = {0, h / 2, h / 2, h};
    const double weight[4] = {h / 6, h / 3, h / 3, h / 6};
    double push, upright;
    Pose rate;

    *lowest = 1;
    for (int i = 0; i < steps; i++) {
        Pose sum = *p;
        double norm = 0;

        for (int k = 0; k < 4; k++) {
            Pose trial = *p;

            if (k > 0)
                step_by(&trial, part[k], &rate);
            rates(r, i * h + part[k], &trial, &rate, &push, &upright);
            step_by(&sum, weight[k], &rate);
        }
        *lowest = fmin(*lowest, upright);
        *p = sum;
        for (int k = 0; k < 4; k++)
            norm += p->q[k] * p->q[k];
        for (int k = 0; k < 4; k++)
            p->q[k] /= sqrt(norm);
    }
    rates(r, r->end, p, &rate, &push, &upright);
    return push;
}

static void draw(Member *member, Rolling *r, Pose *p)
{
    double size = 0, upright;
    V n, rho;

    *r = (Rolling){.shape = (Shape)(member_one_of(member, SHAPES)),
                   .mass = member_between(member, 0.5, 3),
                   .radius = member_between(member, 0.2, 0.5),
                   .end = member_between(member, 0.3, 1.5)};
    r->rim = r->shape == RIM ? member_between(member, 0.02, 0.1) : 0;
    for (int i = 0; i < 3; i++) {
        r->inertia[i] = member_between(member, 0.1, 0.19);
        r->semiaxes[i] = member_between(member, 0.2, 0.5);
        r->hub.at[i] = member_one_of(member, 2) == 0 ? member_between(member, -0.1, 0.1) : 0;
        r->plane.at[i] = member_between(member, -1, 1);
        r->gravity.at[i] = member_between(member, -3, 3) - (i == 2 ? 9 : 0);
        p->w.at[i] = member_between(member, -4, 4);
    }
    for (int i = 0; i < 2; i++) {
        r->hub_turn[i] = member_between(member, -3, 3);
        r->plane_turn[i] = member_between(member, -1, 1);
    }
    for (int i = 0; i < 3; i++)
        r->spin.at[i] = member->number % 2 == 0 ? member_between(member, -2, 2) : 0;
    r->own = turned(r->hub_turn);
    r->tilt = turned(r->plane_turn);
    for (int i = 0; i < 4; i++) {
        p->q[i] = member_between(member, i == 0 ? 0.1 : -1, 1);
        size += p->q[i] * p->q[i];
    }
    for (int i = 0; i < 4; i++)
        p->q[i] /= sqrt(size);
    n = normal_of(r, 0);
    rho = contact_from(r, 0, p->q, &upright);
    p->c = plus(r->plane, member_between(member, -1, 1), apply(&r->tilt, (V){{1, 0, 0}}));
    p->c = plus(p->c, -dot(rho, n), n);
}

static void write(Member *member, const Rolling *r, const Pose *p, Text *out)
{
    const double rate = sqrt(dot(r->spin, r->spin));

    text_addf(out, "gravity [%.17g, %.17g, %.17g]\n", r->gravity.at[0], r->gravity.at[1],
              r->gravity.at[2]);
    text_addf(out, "arm base ground [%.17g, %.17g, %.17g]\n", r->plane.at[0], r->plane.at[1],
              r->plane.at[2]);
    if (rate > 0)
        text_addf(out,
                  "body plate mass=1 inertia=[1, 2, 3]\nrevolute h base plate axis=[%.17g, %.17g, "
                  "%.17g]\ndriver D h = %.17g*t\n",
                  r->spin.at[0], r->spin.at[1], r->spin.at[2], rate);
    text_addf(out, "arm plane %s [0, 0, 0] rotation=x(%.17g)*y(%.17g)\n",
              rate > 0 ? "plate" : "base", r->plane_turn[0], r->plane_turn[1]);
    text_addf(out, "body b mass=%.17g inertia=[%.17g, %.17g, %.17g]\n", r->mass, r->inertia[0],
              r->inertia[1], r->inertia[2]);
    text_addf(out, "arm hub b [%.17g, %.17g, %.17g] rotation=x(%.17g)*y(%.17g)\n", r->hub.at[0],
              r->hub.at[1], r->hub.at[2], r->hub_turn[0], r->hub_turn[1]);
    text_add(out, "roll c plane hub");
    if (r->shape == ELLIPSOID)
        text_addf(out, " semiaxes=[%.17g, %.17g, %.17g]\n", r->semiaxes[0], r->semiaxes[1],
                  r->semiaxes[2]);
    else
        text_addf(out, " radius=%.17g%s", r->radius, r->shape == BALL ? "\n" : " axle=y");
    if (r->shape == WHEEL || r->shape == RIM)
        text_addf(out, r->rim > 0 ? " rim=%.17g\n" : "\n", r->rim);
    if (member_one_of(member, 3) == 0)
        text_add(out, "form embedded\n");
    text_addf(out, "init b.x = %.17g, b.y = %.17g, b.z = %.17g\n", p->c.at[0], p->c.at[1],
              p->c.at[2]);
    text_addf(out, "init b.q1 = %.17g, b.q2 = %.17g, b.q3 = %.17g\n", p->q[1], p->q[2], p->q[3]);
    text_addf(out, "init b.wx = %.17g, b.wy = %.17g, b.wz = %.17g\n", p->w.at[0], p->w.at[1],
              p->w.at[2]);
}

static Verdict bodies_roll(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "ida", "bdf", "adams"};
    static const char *const names[] = {"b.x", "b.y", "b.z", "b.wx", "b.wy", "b.wz"};
    Rolling r;
    Pose start = {.w = {{0}}}, coarse, fine;
    Text text = {0};
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    double lowest, push, bound, off = 0;

    draw(member, &r, &start);
    write(member, &r, &start, &text);
    coarse = fine = start;
    (void)follow(&r, &coarse, 1000, &lowest);
    push = follow(&r, &fine, 2000, &lowest);
    for (int i = 0; i < 3; i++)
        off = fmax(off,
                   fmax(fabs(coarse.c.at[i] - fine.c.at[i]), fabs(coarse.w.at[i] - fine.w.at[i])));
    text_addf(&text, "simulate %.17g rtol=1e-10 atol=1e-12 method=%s\n", r.end,
              methods[member_one_of(member, 6)]);
    tell(member, "%s", text.at);
    bound = 1e-6 + 10 * off;
    if (lowest < 0.2 || !(off < 1e-7)) { /* the oracle's steps are too long for it */
        verdict = REFUSED;
    } else if (kit_do(&kit, text.at) != CT_OK) {
        tell(member, "refused: %s\n", kit.error.message);
        verdict = DISAGREES;
    }
    for (int i = 0; i < 6 && verdict == AGREES; i++) {
        const double wanted = i < 3 ? fine.c.at[i] : fine.w.at[i - 3];

        if (!keeps(member, names[i], fabs(kit_value(&kit, names[i]) - wanted),
                   bound * (1 + fabs(wanted))))
            verdict = DISAGREES;
    }
    if (verdict == AGREES &&
        !keeps(member, "c.fn", fabs(kit_value(&kit, "c.fn") - push), 10 * bound * (1 + fabs(push))))
        verdict = DISAGREES;
    text_free(&text);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {{"bodies_roll", 60, 0.45, 0, bodies_roll}};

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
