/* family_sensitivities.c: d(x)/d(p) along a run against differences of runs with other values of p
 *
 * Runs at p + h, p - h with h, h/2, h/4, with the finest tolerance, are extrapolated (Richardson).
 * Where these don't agree among themselves, as where an event is met in one of them alone, a member
 * is undecided. Machines are chains and four-bars with springs, circuits that drive them, sources
 * that step at an instant, laws that change with the state, new values of an event, dry friction.
 */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

enum { MOST_NAMES = 24, LEVELS = 3 };

typedef struct Machine {
    Script script;
    const char *parameter[MOST_NAMES], *item[MOST_NAMES];
    double value[MOST_NAMES];
    char room[MOST_NAMES][24];
    int parameters, items;
} Machine;

/* a parameter with a random value, and its name */
static const char *parameter(Member *member, Machine *m, const char *word, double low, double high)
{
    char *name = m->room[m->parameters];

    (void)snprintf(name, sizeof m->room[0], "%s%d", word, m->parameters);
    m->parameter[m->parameters] = name;
    m->value[m->parameters] = member_between(member, low, high);
    write_line(&m->script, "%s = %.17g", name, m->value[m->parameters]);
    m->parameters++;
    return name;
}

/* a chain of links from the ground, hinged at their ends */
static void write_chain(Member *member, Machine *m, int links)
{
    static const char *const angle[] = {"h1", "h2", "h3"}, *const rate[] = {"h1'", "h2'", "h3'"};

    for (int i = 1; i <= links; i++) {
        const char *length = parameter(member, m, "L", 0.3, 1);
        const char *mass = parameter(member, m, "m", 0.5, 2);
        const char *start = parameter(member, m, "A", -1.2, 1.2);

        write_line(&m->script, "body b%d mass=%s inertia=%s*%s^2/12", i, mass, mass, length);
        write_line(&m->script, "arm p%d b%d [-%s/2, 0]; arm r%d b%d [%s/2, 0]", i, i, length, i, i,
                   length);
        if (i == 1)
            write_line(&m->script, "revolute h1 ground p1");
        else
            write_line(&m->script, "revolute h%d r%d p%d", i, i - 1, i);
        write_line(&m->script, "init h%d = %s", i, start);
        m->item[m->items++] = angle[i - 1];
        m->item[m->items++] = rate[i - 1];
    }
    m->item[m->items++] = "h1.Fx";
    m->item[m->items++] = "b1.y*h1''";
}

/* crank, coupler and rocker; the crank turns */
static void write_four_bar(Member *member, Machine *m)
{
    const char *crank = parameter(member, m, "a", 0.1, 0.2), *coupler;
    const char *rocker, *base, *rate;

    coupler = parameter(member, m, "b", 0.55, 0.65);
    rocker = parameter(member, m, "c", 0.45, 0.55);
    base = parameter(member, m, "d", 0.5, 0.6);
    rate = parameter(member, m, "w", 5, 12);
    write_line(&m->script, "body b1 mass=1 inertia=0.01; arm r1 b1 [%s, 0]", crank);
    write_line(&m->script, "body b2 mass=1.5 inertia=0.03; arm r2 b2 [%s, 0]", coupler);
    write_line(&m->script, "body b3 mass=2 inertia=0.02; arm r3 b3 [%s, 0]", rocker);
    write_line(&m->script, "arm g ground [%s, 0]", base);
    write_line(&m->script, "revolute h1 ground b1; revolute h2 r1 b2; revolute h3 r2 r3");
    write_line(&m->script, "revolute h4 g b3");
    write_line(&m->script, "init h1 = 0.6, h1' = %s\nguess h4 = 1.5", rate);
    m->item[m->items++] = "h1";
    m->item[m->items++] = "h4'";
    m->item[m->items++] = "h2.Fx";
    m->item[m->items++] = "b2.x";
}

/* what acts on the first hinge, and changes at instants that depend on parameters */
static void write_loads(Member *member, Machine *m)
{
    switch (member_one_of(member, 6)) {
    case 0: {
        const char *k = parameter(member, m, "k", 1, 6), *d = parameter(member, m, "c", 0.02, 0.3);

        write_line(&m->script, "spring S h1 k=%s; damper D h1 d=%s", k, d);
        break;
    }
    case 1: {
        const char *u = parameter(member, m, "u", 1, 4), *t = parameter(member, m, "T", 0.1, 0.5);

        write_line(&m->script, "actuator S h1 torque=if(t < %s, %s, -%s*(1 + t))", t, u, u);
        break;
    }
    case 2: {
        const char *u = parameter(member, m, "u", 1, 4), *q = parameter(member, m, "q", -0.4, 0.4);

        write_line(&m->script, "actuator S h1 torque=if(h1 < %s, %s, -%s/2 - h1')", q, u, u);
        break;
    }
    case 3: {
        const char *c = parameter(member, m, "f", 0.3, 2);

        write_line(&m->script, "friction S h1 torque=%s static=1.3", c);
        break;
    }
    case 4: {
        const char *q = parameter(member, m, "q", -0.4, 0.4),
                   *e = parameter(member, m, "e", 0.3, 0.9);

        write_line(&m->script, "event hit when=h1 < %s h1'=-%s*h1'", q, e);
        break;
    }
    default: {
        const char *r = parameter(member, m, "R", 0.5, 4), *v = parameter(member, m, "V", 2, 9);

        write_line(&m->script, "vsource E n1 0 %s*cos(3*t); resistor R1 n1 n2 %s", v, r);
        write_line(&m->script, "motor M n2 0 h1 R=1 L=0.05 Kt=0.3");
        m->item[m->items++] = "M.i";
    }
    }
}

static void write_machine(Member *member, Machine *m)
{
    static const char *const trees[] = {"", "", "tree absolute"};
    static const char *const forms[] = {"", "form embedded"};
    const char *g;
    const int links = 1 + member_one_of(member, 3);

    m->script.length = 0;
    m->parameters = m->items = 0;
    write_line(&m->script, "scene planar");
    g = parameter(member, m, "g", 3, 11);
    write_line(&m->script, "gravity [0, -%s]", g);
    if (member_one_of(member, 4) == 0)
        write_four_bar(member, m);
    else
        write_chain(member, m, links);
    write_loads(member, m);
    write_line(&m->script, "%s\n%s", trees[member_one_of(member, COUNT(trees))],
               forms[member_one_of(member, COUNT(forms))]);
}

/* --- the oracle --- */

static bool run_at(Kit *kit, const Machine *m, int which, double value, const char *run)
{
    char text[300];

    (void)snprintf(text, sizeof text, "%s = %.17g\n%s", m->parameter[which], value, run);
    return kit_do(kit, text) == CT_OK;
}

/* extrapolated differences of all items, and how far the last two columns are apart */
static bool find_differences(Kit *kit, const Machine *m, int which, const char *run, const char *at,
                             double *out, double *open)
{
    double table[MOST_NAMES][LEVELS], h = 1e-3 * fabs(m->value[which]);
    char text[100];

    for (int level = 0; level < LEVELS; level++, h /= 2)
        for (int side = -1; side <= 1; side += 2) {
            if (!run_at(kit, m, which, m->value[which] + side * h, run))
                return false;
            for (int i = 0; i < m->items; i++) {
                (void)snprintf(text, sizeof text, "%s%s", m->item[i], at);
                table[i][level] =
                    (side > 0 ? table[i][level] : 0) + side * kit_value(kit, text) / (2 * h);
            }
        }
    for (int i = 0; i < m->items; i++) {
        double *t = table[i];
        const double coarse = (4 * t[1] - t[0]) / 3, fine = (4 * t[2] - t[1]) / 3;

        out[i] = fine + (fine - coarse) / 15;
        open[i] = fabs(fine - coarse);
    }
    return true;
}

static Verdict sensitivities_are_differences(Member *member)
{
    static const char *const methods[] = {"", "", " method=radau", " method=bdf", " method=ida"};
    static Machine m;
    double differences[MOST_NAMES], open[MOST_NAMES];
    const double until = member_between(member, 0.3, 0.9);
    const int method = member_one_of(member, COUNT(methods));
    const double bound = method > 1 ? 2e-6 : 2e-7;
    char run[100], finest[100], at[40], text[200];
    Kit kit = kit_new();
    Verdict verdict = AGREES;
    int which, compared = 0;

    write_machine(member, &m);
    which = member_one_of(member, m.parameters);
    (void)snprintf(run, sizeof run, "simulate 1 rtol=1e-10%s", methods[method]);
    (void)snprintf(finest, sizeof finest, "simulate 1 rtol=1e-12");
    (void)snprintf(at, sizeof at, " at %.17g", until);
    tell(member, "%s%s; d()/d(%s)%s\n", m.script.text, run, m.parameter[which], at);
    if (kit_do(&kit, m.script.text) != CT_OK ||
        !find_differences(&kit, &m, which, finest, at, differences, open) ||
        !run_at(&kit, &m, which, m.value[which], run)) {
        tell(member, "%s\n", kit.error.message);
        verdict = REFUSED;
    }
    for (int i = 0; i < m.items && verdict == AGREES; i++) {
        const double size = 1 + fabs(differences[i]);
        double got;

        (void)snprintf(text, sizeof text, "d(%s)/d(%s)%s", m.item[i], m.parameter[which], at);
        got = kit_value(&kit, text);
        if (isnan(got)) {
            tell(member, "%s: %s\n", text, kit.error.message);
            verdict = REFUSED;
            break;
        }
        if (!(open[i] <= 0.1 * bound * size))
            continue;
        compared++;
        if (!keeps(member, text, fabs(got - differences[i]) / size, bound))
            verdict = DISAGREES;
    }
    kit_free(&kit);
    return verdict == AGREES && compared == 0 ? REFUSED : verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"sensitivities_are_differences", 24, 0.35, 0, sensitivities_are_differences},
    };

    return family_main(families, COUNT(families), argc, argv);
}
