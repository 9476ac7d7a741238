/* family_falls.c: what attracts as k/r^p is fallen into after a finite time, and a run ends there
 *
 * From rest at r, with the reduced mass m of both, that is
 *
 *     sqrt(m r^(p+1)/k) sqrt((p-1)/2) B(1/2 + 1/(p-1), 1/2)/(p-1)
 *
 * (energy, and the integral of dr/r' as Euler's first). Nothing goes on behind it, whatever a
 * method's formulas say. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#include <math.h>

#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

static double draw(Member *member, double low, double high)
{
    return test_uniform(&member->random, low, high);
}

static const char *one_of(Member *member, const char *const *words, int count)
{
    return words[test_random(&member->random) % (uint64_t)count];
}

typedef struct Fall {
    double r, k, mass; /* mass: reduced */
    int p;
} Fall;

static double time_of(const Fall *f)
{
    const double n = f->p - 1, a = 0.5 + 1 / n;

    return sqrt(f->mass * pow(f->r, n + 2) / f->k) * sqrt(n / 2) / n *
           exp(lgamma(a) + lgamma(0.5) - lgamma(a + 0.5));
}

static void write_joint_force(Member *member, Script *s, Fall *f)
{
    f->mass = draw(member, 0.5, 2);
    write_line(s, "body a mass=%.17g inertia=1\nprismatic s ground a axis=x\ninit s = %.17g",
               f->mass, f->r);
    write_line(s, "actuator pull s force=-%.17g/s^%d", f->k, f->p);
}

static void write_force(Member *member, Script *s, Fall *f)
{
    f->mass = draw(member, 0.5, 2);
    write_line(s, "body a mass=%.17g inertia=1\nprismatic s ground a axis=y\ninit s = %.17g",
               f->mass, f->r);
    write_line(s, "force F a [0, -%.17g/s^%d]", f->k, f->p);
}

static void write_frames(Member *member, Script *s, Fall *f)
{
    const double one = draw(member, 0.5, 2), two = draw(member, 0.5, 2);
    const double angle = draw(member, -3, 3), x = f->r * cos(angle), y = f->r * sin(angle);

    f->mass = one * two / (one + two);
    write_line(s, "body a mass=%.17g inertia=1; body b mass=%.17g inertia=1", one, two);
    write_line(s, "free f ground a; free g ground b");
    write_line(s, "init f.x = %.17g, f.y = %.17g, g.x = 0, g.y = 0", x, y);
    write_line(s, "actuator pull a b force=-%.17g/sqrt((f.x-g.x)^2 + (f.y-g.y)^2)^%d", f->k, f->p);
}

static Verdict a_fall_ends_a_run(Member *member)
{
    static const char *const methods[] = {"dop853", "radau", "bdf", "adams", "ida", "ida"};
    static const char *const trees[] = {"", "tree absolute"}, *const forms[] = {"",
                                                                                "form embedded"};
    static void (*const write[])(Member *, Script *, Fall *) = {write_joint_force, write_force,
                                                                write_frames};
    Fall f = {.r = pow(10, draw(member, -1, 1)),
              .k = pow(10, draw(member, -3, 3)),
              .p = 2 + (int)(test_random(&member->random) % 3)};
    const double rtol = pow(10, draw(member, -9, -4));
    static Script script;
    Kit kit = kit_new();
    double falls, t = NAN;
    ct_status status;

    script.length = 0;
    write_line(&script, "scene planar\ngravity [0, 0]");
    write[test_random(&member->random) % COUNT(write)](member, &script, &f);
    falls = time_of(&f);
    write_line(&script, "%s\n%s", one_of(member, trees, 2), one_of(member, forms, 2));
    /* absolute tolerances are about speeds as they are here */
    write_line(&script, "simulate %.17g rtol=%.3g atol=%.3g method=%s",
               falls * draw(member, 1.2, 8), rtol, rtol * fmin(1, f.r / falls),
               one_of(member, methods, COUNT(methods)));
    status = kit_do(&kit, script.text);
    tell(member, "%sfalls for %.12g s: %s\n", script.text, falls,
         status == CT_OK ? "went on" : kit.error.message);
    if (status != CT_OK)
        (void)sscanf(kit.error.message, "at t = %lf", &t);
    kit_free(&kit);
    return fabs(t - falls) <= fmax(1e3 * rtol, 1e-6) * falls ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"a_fall_ends_a_run", 60, 0, 0, a_fall_ends_a_run},
    };

    return family_main(families, COUNT(families), argc, argv);
}
