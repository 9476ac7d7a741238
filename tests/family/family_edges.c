/* family_edges.c: sleighs on an edge that a hard lateral damper makes, by stiff methods
 *
 * Chaplygin's sleigh of mass m, inertia J, its edge a behind the mass centre. With v along the edge
 * and w its turn, an edge that doesn't slip obeys
 *
 *     v' = a w^2,   w' = -m a v w/(J + m a^2)
 *
 * from what is left of the first velocity after the edge has taken its lateral part, by an impulse
 * P = (a w - vl)/(1/m + a^2/J) on it. This is integrated here in long double. With damping D the
 * edge slips by the lateral force over D, which the bound allows. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

typedef long double Real;

typedef struct Sleigh {
    double m, J, a, D, span;
    double v[2], theta, w; /* at first, ground axes */
} Sleigh;

/* v and w at the end, by the classical Runge-Kutta method */
static void slide(const Sleigh *s, Real *v, Real *w)
{
    enum { STEPS = 20000 };
    const Real h = (Real)s->span / STEPS, a = s->a, q = s->m * a / (s->J + s->m * a * a);

    for (int k = 0; k < STEPS; k++) {
        Real kv[4], kw[4], pv = *v, pw = *w;

        for (int i = 0; i < 4; i++) {
            const Real part = i < 2 ? h / 2 : h;

            kv[i] = a * pw * pw;
            kw[i] = -q * pv * pw;
            pv = *v + part * kv[i];
            pw = *w + part * kw[i];
        }
        *v += h / 6 * (kv[0] + 2 * kv[1] + 2 * kv[2] + kv[3]);
        *w += h / 6 * (kw[0] + 2 * kw[1] + 2 * kw[2] + kw[3]);
    }
}

static Verdict edge_member(Member *m)
{
    static const char *const methods[] = {"auto", "radau"};
    static Script script;
    Sleigh s = {.m = member_decades(m, 0.3, 10),
                .a = member_between(m, 0.1, 0.6),
                .span = member_between(m, 0.5, 3),
                .D = member_decades(m, 1e7, 1e10),
                .theta = member_between(m, -7, 7),
                .v = {member_between(m, -1, 1), member_between(m, -1, 1)},
                .w = member_between(m, -3, 3)};
    const double rtol = member_decades(m, 1e-9, 1e-5), c = cos(s.theta), sine = sin(s.theta);
    const char *method = methods[member_one_of(m, COUNT(methods))];
    const bool turned = member_one_of(m, 2) == 1;
    Real v, w, lateral, impulse;
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    double slip, now;

    s.J = s.m * member_between(m, 0.02, 0.3);
    script = (Script){0};
    write_line(&script, "scene planar\nD = %.17g; a = %.17g", s.D, s.a);
    write_line(&script, "body b mass=%.17g inertia=%.17g\nfree f ground b\narm k b [-a, 0]", s.m,
               s.J);
    write_line(&script, "output n = -k.vx*sin(b.theta) + k.vy*cos(b.theta)");
    write_line(&script, "force F k [D*n*sin(b.theta), -D*n*cos(b.theta)]");
    write_line(&script, "tree %s", turned ? "joint" : "absolute");
    write_line(&script, "init b.theta = %.17g, b.vx = %.17g, b.vy = %.17g, b.theta' = %.17g",
               s.theta, s.v[0], s.v[1], s.w);
    write_line(&script, "simulate %.17g rtol=%.3g atol=%.3g method=%s", s.span, rtol, rtol, method);
    tell(m, "%s", script.text);

    v = s.v[0] * c + s.v[1] * sine;
    lateral = -s.v[0] * sine + s.v[1] * c;
    impulse = (s.a * s.w - lateral) / (1 / (Real)s.m + s.a * s.a / (Real)s.J);
    w = s.w - s.a * impulse / s.J;
    slide(&s, &v, &w);
    /* lateral force: of the size m v w; how fast it is taken over: D/m */
    slip = 100 * (1 + s.m) * 10 / s.D;
    if (kit_do(&kit, script.text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        verdict = DISAGREES;
    } else {
        now = kit_value(&kit, "b.theta'");
        if (!keeps(m, "turn", fabs(now - (double)w), 10 * rtol + slip))
            verdict = DISAGREES;
        now = kit_value(&kit, "b.vx*cos(b.theta) + b.vy*sin(b.theta)");
        if (!keeps(m, "speed", fabs(now - (double)v), 10 * rtol + slip))
            verdict = DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    {"sleighs on hard edges move as on ideal ones", 40, 0, 0, edge_member},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
