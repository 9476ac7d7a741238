/* family_sections.c: what sections of a beam in the plane carry, against the balance between two
 *
 * The forces and moments at two cuts differ by weight, inertia and load of what is between them and
 * by a force there: an integral by Gauss's rule over accelerations of frames, in ground axes. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#include <gsl/gsl_integration.h>
#include <math.h>

enum { POINTS = 10 };

typedef struct Bar {
    double L, rho, thins, J, load[2], grows, gravity[2], push[2]; /* density rho (1 + thins x) */
    double cut[2], pushed;
} Bar;

static double figure(Kit *kit, const char *format, double at)
{
    char ask[64];

    (void)snprintf(ask, sizeof ask, format, at);
    return kit_value(kit, ask);
}

static double member_of(Kit *kit, const char *frame, int i, const char *what)
{
    char ask[64];

    (void)snprintf(ask, sizeof ask, "%s%d.%s", frame, i, what);
    return kit_value(kit, ask);
}

static void write_scene(Member *m, Bar *bar, Script *script)
{
    static const char *const trees[] = {"tree joint", "tree absolute"};
    static const char *const bases[] = {"legendre", "taylor", "chebyshev"};
    static const char *const stiffenings[] = {"full", "full", "off"};
    const bool hangs = test_random(&m->random) % 2 == 0;
    gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(POINTS);

    script->length = 0;
    write_line(script, "scene planar\ngravity [%.17g, %.17g]\nL = %.17g", bar->gravity[0],
               bar->gravity[1], bar->L);
    write_line(script,
               "beam b length=%s mass_per_length=%.17g*(1 + %.17g*x) EA=300 EIz=%.17g "
               "modes=[%d, %d] inertia_per_length=%.17g load=[%.17g, %.17g + %.17g*x] basis=%s "
               "stiffening=%s damping=[0, 0.001]",
               test_random(&m->random) % 2 == 0 ? "L" : "(L + 0)", bar->rho, bar->thins,
               member_between(m, 5, 50), (int)(test_random(&m->random) % 2),
               1 + (int)(test_random(&m->random) % 3), bar->J, bar->load[0], bar->load[1],
               bar->grows, bases[test_random(&m->random) % 3],
               stiffenings[test_random(&m->random) % 3]);
    for (int i = 0; i < 2; i++)
        write_line(script, "arm cut%d b at=%.17g", i, bar->cut[i]);
    for (int i = 0; i < POINTS; i++) {
        double x, weight;

        (void)gsl_integration_glfixed_point(bar->cut[0], bar->cut[1], (size_t)i, &x, &weight, rule);
        write_line(script, "arm p%d b at=%.17g", i, x);
    }
    gsl_integration_glfixed_table_free(rule);
    write_line(script,
               "arm tip b at=L\narm mid b at=%.17g\nforce F1 mid [%.17g, %.17g]\n"
               "revolute h ground %s\nbody m mass=%.17g inertia=0.1\nrevolute j %s m",
               bar->pushed, bar->push[0], bar->push[1], hangs ? "tip" : "b",
               member_between(m, 0.1, 1), hangs ? "b" : "tip");
    write_line(script, "arm post ground [0.3, 1.4]\nspring k1 tip post k=20 d=0.1\n%s",
               trees[test_random(&m->random) % 2]);
    write_line(script,
               "init h = %.17g, h' = %.17g, b.v1 = %.17g, b.v1' = %.17g\n"
               "simulate 0.05 rtol=1e-8",
               member_between(m, -2, 2), member_between(m, -3, 3), member_between(m, -0.1, 0.1),
               member_between(m, -1, 1));
}

/* force x, y and moment about the place of cut 0, on what is before a cut */
static void carried(Kit *kit, const Bar *bar, int i, double out[3])
{
    const double turned = member_of(kit, "cut", i, "theta"), x = bar->cut[i];
    const double axial = figure(kit, "b.axial(%.17g)", x), shear = figure(kit, "b.shear(%.17g)", x);
    const double way[2] = {member_of(kit, "cut", i, "x") - member_of(kit, "cut", 0, "x"),
                           member_of(kit, "cut", i, "y") - member_of(kit, "cut", 0, "y")};

    out[0] = cos(turned) * axial - sin(turned) * shear;
    out[1] = sin(turned) * axial + cos(turned) * shear;
    out[2] = figure(kit, "b.bending(%.17g)", x) + way[0] * out[1] - way[1] * out[0];
}

static void add(Kit *kit, const char *frame, int i, const double force[2], double out[3])
{
    const double way[2] = {member_of(kit, frame, i, "x") - member_of(kit, "cut", 0, "x"),
                           member_of(kit, frame, i, "y") - member_of(kit, "cut", 0, "y")};

    out[0] += force[0];
    out[1] += force[1];
    out[2] += way[0] * force[1] - way[1] * force[0];
}

static void between(Kit *kit, const Bar *bar, double out[3])
{
    gsl_integration_glfixed_table *rule = gsl_integration_glfixed_table_alloc(POINTS);

    for (int i = 0; i < POINTS; i++) {
        double x, weight, rho, force[2];

        (void)gsl_integration_glfixed_point(bar->cut[0], bar->cut[1], (size_t)i, &x, &weight, rule);
        rho = bar->rho * (1 + bar->thins * x);
        for (int k = 0; k < 2; k++)
            force[k] =
                weight * (bar->load[k] + (k == 1 ? bar->grows * x : 0) +
                          rho * (bar->gravity[k] - member_of(kit, "p", i, k == 0 ? "ax" : "ay")));
        add(kit, "p", i, force, out);
        out[2] -= weight * bar->J * member_of(kit, "p", i, "alphaz");
    }
    gsl_integration_glfixed_table_free(rule);
}

static Verdict balance(Member *m)
{
    static const char *const told[3] = {"force along x", "force along y", "moment"};
    static Script script;
    Bar bar;
    Kit kit = kit_new();
    double first[3], second[3], loads[3] = {0}, size = 1;
    bool agrees;

    bar.L = member_between(m, 0.5, 2);
    bar.rho = member_between(m, 0.5, 3);
    bar.thins = test_random(&m->random) % 2 == 0 ? 0 : member_between(m, -0.4, 1);
    bar.J = member_between(m, 0, 0.05);
    bar.grows = test_random(&m->random) % 2 == 0 ? 0 : member_between(m, -3, 3);
    for (int k = 0; k < 2; k++) {
        bar.load[k] = member_between(m, -3, 3);
        bar.gravity[k] = member_between(m, -10, 10);
        bar.push[k] = member_between(m, -3, 3);
    }
    bar.cut[0] = bar.L * member_between(m, 0, 0.5);
    bar.cut[1] = bar.L * member_between(m, 0.55, 1);
    bar.pushed = bar.L * member_between(m, 0.01, 0.99);
    write_scene(m, &bar, &script);
    agrees = kit_do(&kit, script.text) == CT_OK;
    if (!agrees)
        tell(m, "%s\n", kit.error.message);
    if (agrees) {
        carried(&kit, &bar, 0, first);
        carried(&kit, &bar, 1, second);
        between(&kit, &bar, loads);
        if (bar.pushed >= bar.cut[0] && bar.pushed < bar.cut[1]) {
            const double way[2] = {kit_value(&kit, "mid.x") - kit_value(&kit, "cut0.x"),
                                   kit_value(&kit, "mid.y") - kit_value(&kit, "cut0.y")};

            loads[0] += bar.push[0];
            loads[1] += bar.push[1];
            loads[2] += way[0] * bar.push[1] - way[1] * bar.push[0];
        }
        for (int k = 0; k < 3; k++)
            size = fmax(size, fabs(first[k]));
        for (int k = 0; k < 3; k++)
            agrees =
                keeps(m, told[k], fabs(first[k] - second[k] - loads[k]) / size, 1e-9) && agrees;
    }
    if (!agrees || m->told)
        tell(m, "%s", script.text);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

static const Family families[] = {
    {"the forces of two sections differ by what is between them", 6, 0, 0, balance},
};

int main(int argc, char **argv)
{
    return family_main(families, (int)(sizeof families / sizeof *families), argc, argv);
}
