/* family_walls.c: a mass between two hard walls leaves each as fast as it came
 *
 * A wall is a spring that pushes only: half a swing, or with a weight along the way a little more
 * or less, ends it. Both are known in formulas, and so is what lies between. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#define PI     3.14159265358979323846
#define MISSES 100 /* tolerances by which a run may be off */

/* mass between walls at 0 and `width`; x, v: at t, outside of both */
typedef struct Mass {
    double mass, stiffness, width, pull; /* pull: acceleration along x */
    double x, v, t;
} Mass;

/* the time until it meets a wall, and at which: there is one, since it moves */
static double meets(const Mass *m, bool *at_far)
{
    double first = INFINITY;

    for (int far = 0; far < 2; far++) {
        const double way = (far ? m->width : 0) - m->x;
        /* way = v t + pull t^2/2, by the root that loses nothing */
        const double inner = m->v * m->v + 2 * m->pull * way;
        const double sum = inner >= 0 ? m->v + copysign(sqrt(inner), m->v) : NAN;
        const double roots[2] = {2 * way / sum, m->pull != 0 ? sum / m->pull : NAN};

        for (int k = 0; k < 2; k++)
            if (roots[k] > 1e-9 * m->width && roots[k] < first) {
                const double rate = m->v + m->pull * roots[k];

                if (far ? rate > 0 : rate < 0) {
                    first = roots[k];
                    *at_far = far;
                }
            }
    }
    return first;
}

static double in_wall(const Mass *m, double into, double speed)
{
    const double w = sqrt(m->stiffness / m->mass);

    return 2 * (PI - atan2(speed * w, into)) / w;
}

static void move_free(Mass *m, double time)
{
    m->x += (m->v + m->pull * time / 2) * time;
    m->v += m->pull * time;
    m->t += time;
}

static void bounce(Mass *m)
{
    bool far = false;

    move_free(m, meets(m, &far));
    m->x = far ? m->width : 0;
    m->t += in_wall(m, far ? m->pull : -m->pull, fabs(m->v));
    m->v = -m->v;
}

static void write_law(Member *member, Script *text, const Mass *m)
{
    const double k = m->stiffness, w = m->width;

    write_piece(text, "actuator w s force=");
    switch (member_one_of(member, 3)) {
    case 0:
        write_line(text, "%.17g*(ramp(-s) - ramp(s - %.17g))", k, w);
        break;
    case 1:
        write_line(text, "%.17g*(max(-s, 0) + min(%.17g - s, 0))", k, w);
        break;
    default:
        write_line(text, "if(s < 0, -%.17g*s, if(s > %.17g, %.17g*(%.17g - s), 0))", k, w, k, w);
    }
}

static Verdict masses_leave_walls_as_they_came(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "bdf", "adams", "ida"};
    const double rtol = pow(10, -member_between(member, 2, 9));
    const char *const method = methods[member_one_of(member, 6)];
    Mass m = {.mass = member_decades(member, 0.1, 10),
              .stiffness = member_decades(member, 1e4, 1e12),
              .width = member_between(member, 0.3, 3),
              .v = member_decades(member, 0.3, 30) * (member_one_of(member, 2) ? 1 : -1)};
    const int bounces = 1 + member_one_of(member, 5);
    double off, until, unit, way;
    Mass got;
    bool far;
    Script text = {0};
    Kit kit = kit_new();

    m.x = m.width * member_between(member, 0.05, 0.95);
    if (member_one_of(member, 2)) /* not so much that it turns on the way: walls are met fast */
        m.pull = m.v * m.v / m.width * member_between(member, -0.2, 0.2);
    write_line(&text, "scene planar\ngravity [%.17g, 0]\nbody b mass=%.17g inertia=1", m.pull,
               m.mass);
    write_line(&text, "prismatic s ground b axis=x");
    write_law(member, &text, &m);
    write_line(&text, "init s = %.17g, s' = %.17g", m.x, m.v);
    for (int i = 0; i < bounces; i++)
        bounce(&m);
    until = m.t + meets(&m, &far) * member_between(member, 0.1, 0.9);
    move_free(&m, until - m.t);
    write_line(&text, "simulate %.17g rtol=%.3g method=%s", until, rtol, method);
    tell(member, "%s", text.text);
    if (kit_do(&kit, text.text) != CT_OK) {
        tell(member, "%s\n", kit.error.message);
        kit_free(&kit);
        return REFUSED;
    }
    /* an error of the speed goes on as one of the place; just before a bounce, or behind it, the
     * way leads through the wall */
    unit = rtol * (1 + fabs(m.v));
    got = (Mass){.x = kit_value(&kit, "s"), .v = kit_value(&kit, "s'")};
    way = fabs(got.x - m.x);
    if (got.v * m.v < 0)
        way = fmin(got.x + m.x, 2 * m.width - got.x - m.x);
    off = fmax(fabs(fabs(got.v) - fabs(m.v)) / unit, way / (unit * (1 + until)));
    tell(member, "off by %.3g tolerances: s' = %.12g for %.12g, s = %.12g for %.12g\n", off, got.v,
         m.v, got.x, m.x);
    kit_free(&kit);
    return off <= MISSES ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        /* errors of methods with a history add up */
        {"masses_leave_walls_as_they_came", 100, 0.001, 0.001, masses_leave_walls_as_they_came},
    };

    return family_main(families, 1, argc, argv);
}
