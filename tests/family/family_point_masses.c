/* family_point_masses.c: what has no rotational inertia runs in all trees as what it is welded to
 *
 * Links hang on each other by joints; point masses and bodies without any mass are welded to them,
 * or are links of their own. The same machine is written a second time, each link with what is
 * welded to it as one body: its mass, mass centre and moments of inertia by the parallel axis
 * theorem, here. Both move alike. A rod without inertia between two ball joints has a spin that
 * nothing determines: it is refused by its name. */
#include "family.h"

#include "../unit/session_kit.h"
#include "base/memory.h"
#include "base/text.h"

#include <string.h>

#define NEARLY 1e-6 /* rad or m after half a second; rtol is 1e-9 */

enum { MOST_LINKS = 3, MOST_MASSES = 3 };

typedef struct Point { /* a mass welded to a link; 0: a body without any */
    double mass, at[3];
    bool is_turned; /* its axes against the link's */
} Point;

typedef struct Link {
    double mass, J[3];      /* kg, kg m^2; all 0: its masses are all there is */
    double near[3], far[3]; /* m: its joints in its own axes, from its mass centre */
    const char *joint;
    Point point[MOST_MASSES];
    int points;
} Link;

static void draw(Member *m, double least, double most, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = member_between(m, least, most);
}

static void draw_link(Member *m, bool is_first, Link *link)
{
    static const char *const joints[] = {"revolute j%d %s n%d axis=x", "revolute j%d %s n%d axis=y",
                                         "revolute j%d %s n%d axis=[1, 2, 0.5]",
                                         "universal j%d %s n%d axes=[x, y]",
                                         "prismatic j%d %s n%d axis=[1, 1, -0.4]"};
    const bool is_massless = !is_first && member_one_of(m, 3) == 0;

    *link = (Link){.joint = joints[member_one_of(m, is_massless ? 3 : 5)]};
    if (!is_massless) {
        link->mass = member_decades(m, 0.1, 10);
        /* a box has moments that a body can have */
        draw(m, 0.05, 0.5, link->J);
        const double a = link->J[0] * link->J[0], b = link->J[1] * link->J[1],
                     c = link->J[2] * link->J[2];

        link->J[0] = link->mass * (b + c) / 3;
        link->J[1] = link->mass * (a + c) / 3;
        link->J[2] = link->mass * (a + b) / 3;
    }
    draw(m, -0.5, 0.5, link->near);
    draw(m, -0.5, 0.5, link->far);
    link->points = member_one_of(m, MOST_MASSES + 1);
    if (is_massless && link->points < 2)
        link->points = 2;
    for (int i = 0; i < link->points; i++) {
        Point *p = &link->point[i];

        p->mass = !is_massless && member_one_of(m, 4) == 0 ? 0 : member_decades(m, 0.1, 5);
        p->is_turned = member_one_of(m, 2) == 0;
        draw(m, -0.6, 0.6, p->at);
    }
}

/* m, c and J (xx, yy, zz, xy, xz, yz as a body has them) of a link and its points */
static void merge(const Link *link, double *mass, double c[3], double J[3][3])
{
    *mass = link->mass;
    memset(c, 0, 3 * sizeof(double));
    memset(J, 0, 9 * sizeof(double));
    for (int i = 0; i < link->points; i++) {
        *mass += link->point[i].mass;
        for (int k = 0; k < 3; k++)
            c[k] += link->point[i].mass * link->point[i].at[k];
    }
    for (int k = 0; k < 3; k++)
        c[k] /= *mass;
    for (int i = -1; i < link->points; i++) {
        const double own = i < 0 ? link->mass : link->point[i].mass;
        double d[3], square = 0;

        for (int k = 0; k < 3; k++) {
            d[k] = (i < 0 ? 0 : link->point[i].at[k]) - c[k];
            square += d[k] * d[k];
        }
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                J[a][b] += own * ((a == b ? square : 0) - d[a] * d[b]) +
                           (i < 0 && a == b ? link->J[a] : 0);
    }
}

static void add_vector(Text *text, const double v[3], const double less[3])
{
    text_addf(text, "[%.17g, %.17g, %.17g]", v[0] - less[0], v[1] - less[1], v[2] - less[2]);
}

/* link `i`; its mass centre stands at `c` from that of the link alone */
static void write_link(const Link *link, int i, const double c[3], Text *text)
{
    char frame[16];

    (void)snprintf(frame, sizeof frame, i == 0 ? "ground" : "f%d", i - 1);
    text_addf(text, "arm n%d b%d ", i, i);
    add_vector(text, link->near, c);
    text_addf(text, "\narm f%d b%d ", i, i);
    add_vector(text, link->far, c);
    text_add(text, "\n");
    text_addf(text, link->joint, i, frame, i);
    text_add(text, "\n");
}

static void write_merged(const Link *links, int count, Text *text)
{
    text_add(text, "gravity [1, -2, -9.81]\n");
    for (int i = 0; i < count; i++) {
        double mass, c[3], J[3][3];

        merge(&links[i], &mass, c, J);
        text_addf(text, "body b%d mass=%.17g inertia=[%.17g, %.17g, %.17g, %.17g, %.17g, %.17g]\n",
                  i, mass, J[0][0], J[1][1], J[2][2], J[0][1], J[0][2], J[1][2]);
        write_link(&links[i], i, c, text);
    }
}

static void write_apart(const Link *links, int count, Text *text)
{
    static const double none[3];

    text_add(text, "gravity [1, -2, -9.81]\n");
    for (int i = 0; i < count; i++) {
        const Link *l = &links[i];

        text_addf(text, "body b%d mass=%.17g inertia=[%.17g, %.17g, %.17g]\n", i, l->mass, l->J[0],
                  l->J[1], l->J[2]);
        write_link(l, i, none, text);
        for (int k = 0; k < l->points; k++) {
            text_addf(text, "body p%d%d mass=%.17g inertia=[0, 0, 0]\narm a%d%d b%d ", i, k,
                      l->point[k].mass, i, k, i);
            add_vector(text, l->point[k].at, none);
            text_addf(text, "%s\nweld w%d%d a%d%d p%d%d\n",
                      l->point[k].is_turned ? " rotation=z(0.7)*y(-1.2)" : "", i, k, i, k, i, k);
        }
    }
}

/* joint, absolute, a mix, or two that differ */
static void write_tree(Member *m, const Link *links, int count, int which, Text *text)
{
    if (which < 2) {
        text_add(text, which == 0 ? "tree absolute\n" : "tree joint\n");
        return;
    }
    for (int half = 0; half < (which == 2 ? 1 : 2); half++) {
        text_add(text, which == 2 ? "tree" : half == 0 ? "tree translation" : "tree rotation");
        for (int i = 0; i < count; i++) {
            text_addf(text, " %c%d", member_one_of(m, 2) ? 'b' : 'j', i);
            for (int k = 0; k < links[i].points; k++)
                text_addf(text, " %c%d%d", member_one_of(m, 2) ? 'p' : 'w', i, k);
        }
        text_add(text, "\n");
    }
}

static void write_run(const Link *links, int count, const char *method, Text *text)
{
    for (int i = 0; i < count; i++)
        if (links[i].joint[0] == 'u')
            text_addf(text, "init j%d.a1 = 0.3, j%d.a2 = -0.4, j%d.a1' = 1, j%d.a2' = -0.5\n", i, i,
                      i, i);
        else
            text_addf(text, "init j%d = 0.2, j%d' = 0.7\n", i, i);
    text_addf(text, "simulate 0.5 rtol=1e-9%s\n", method);
}

/* largest difference of the joints' coordinates */
static double difference(Kit *a, Kit *b, const Link *links, int count)
{
    double most = 0;

    for (int i = 0; i < count; i++)
        for (int k = 0; k < (links[i].joint[0] == 'u' ? 2 : 1); k++) {
            char name[16];
            double off;

            (void)snprintf(name, sizeof name,
                           links[i].joint[0] == 'u' ? k == 0 ? "j%d.a1" : "j%d.a2" : "j%d", i);
            off = fabs(kit_value(a, name) - kit_value(b, name));
            most = off <= most ? most : off;
        }
    return most;
}

static Verdict merged_member(Member *m)
{
    static const char *const methods[] = {"", " method=dop853", " method=radau"};
    const int count = 1 + member_one_of(m, MOST_LINKS);
    const char *method = methods[member_one_of(m, 3)];
    Link links[MOST_LINKS];
    Kit merged = kit_new();
    Text text = {0};
    bool right;

    for (int i = 0; i < count; i++)
        draw_link(m, i == 0, &links[i]);
    write_merged(links, count, &text);
    text_add(&text, "tree joint\n");
    write_run(links, count, "", &text);
    right = kit_do(&merged, text.at) == CT_OK;
    if (!right)
        tell(m, "%s\n%s", merged.error.message, text.at);
    for (int which = 0; which < 4 && right; which++) {
        Kit apart = kit_new();

        text_free(&text);
        text = (Text){0};
        write_apart(links, count, &text);
        write_tree(m, links, count, which, &text);
        write_run(links, count, method, &text);
        right = kit_do(&apart, text.at) == CT_OK &&
                keeps(m, "joints", difference(&apart, &merged, links, count), NEARLY);
        if (!right)
            tell(m, "%s\n%s", apart.error.message, text.at);
        kit_free(&apart);
    }
    text_free(&text);
    kit_free(&merged);
    return right ? AGREES : DISAGREES;
}

/* A coupler without mass between two cranks carries a point mass, or is that mass itself: in trees
 * of joints, of bodies and of some of each both move alike. */
static Verdict coupler_member(Member *m)
{
    static const char *const trees[] = {"tree joint",    "tree absolute", "tree h1 h2 q c",
                                        "tree h1 r q c", "tree a r w h4", "tree a h2 q h4"};
    const double at[3] = {member_between(m, -0.3, 0.3), member_between(m, -0.2, 0.2),
                          member_between(m, 0.05, 0.3)};
    const double mass = member_decades(m, 0.3, 5), half = member_between(m, 0.5, 0.65);
    const double span = member_between(m, 1, 1.25), speed = member_between(m, -1, 1);
    double merged = 0;
    bool right = true;

    for (int which = -1; which < COUNT(trees) && right; which++) {
        const double *c = which < 0 ? at : (const double[3]){0};
        Kit kit = kit_new();
        Text text = {0};

        text_add(&text, "gravity [0, 0, -9.81]\nbody a mass=1 inertia=[0.1, 0.1, 0.1]\n"
                        "arm a0 a [-0.5, 0, 0]\narm a1 a [0.5, 0, 0]\n"
                        "body c mass=1.5 inertia=[0.1, 0.1, 0.1]\n"
                        "arm c0 c [-0.5, 0, 0]\narm c1 c [0.5, 0, 0]\n");
        text_addf(&text,
                  "body r mass=%.17g inertia=[0, 0, 0]\narm r0 r [%.17g, %.17g, %.17g]\n"
                  "arm r1 r [%.17g, %.17g, %.17g]\narm g ground [%.17g, 0, 0]\n",
                  which < 0 ? mass : 0, -half - c[0], -c[1], -c[2], half - c[0], -c[1], -c[2],
                  span);
        if (which >= 0)
            text_addf(&text,
                      "body q mass=%.17g inertia=[0, 0, 0]\narm rq r [%.17g, %.17g, %.17g]\n"
                      "weld w rq q\n",
                      mass, at[0], at[1], at[2]);
        text_addf(&text,
                  "revolute h1 ground a0 axis=y\nuniversal h2 a1 r0 axes=[y, z]\n"
                  "spherical h3 r1 c1\nrevolute h4 g c0 axis=y\nguess h1 = 1, h4 = 1\n"
                  "init h1' = %.17g\n%s\nsimulate 0.3 rtol=1e-9\n",
                  speed, trees[which < 0 ? 0 : which]);
        right = kit_do(&kit, text.at) == CT_OK;
        if (which < 0)
            merged = kit_value(&kit, "h1");
        right = right && keeps(m, "h1", fabs(kit_value(&kit, "h1") - merged), NEARLY);
        if (!right || m->told)
            tell(m, "%s\n%s", kit.error.message, text.at);
        text_free(&text);
        kit_free(&kit);
    }
    return right ? AGREES : DISAGREES;
}

/* a rod without inertia between two ball joints, or a point mass on one */
static Verdict spin_member(Member *m)
{
    const bool is_rod = member_one_of(m, 2) == 0;
    Kit kit = kit_new();
    Text text = {0};
    bool right;

    text_addf(&text,
              "body b mass=1 inertia=[0.1, 0.2, 0.2]\narm n b [-0.5, 0, 0]\narm f b [0.5, 0, 0]\n"
              "revolute h ground n axis=y\nbody rod mass=%.17g inertia=[0, 0, 0]\n",
              is_rod ? 0 : member_between(m, 0.5, 2));
    if (is_rod)
        text_addf(&text,
                  "arm r0 rod [%.17g, %.17g, 0]\narm r1 rod [0.4, %.17g, 0.3]\n"
                  "spherical s f r0\nbody p mass=2 inertia=[0, 0, 0]\nweld w r1 p\n",
                  member_between(m, -0.5, -0.1), member_between(m, -0.2, 0.2),
                  member_between(m, -0.2, 0.2));
    else
        text_add(&text, "spherical s f rod\n");
    text_addf(&text, "tree %s\nsimulate 1\n", member_one_of(m, 2) ? "joint" : "absolute");
    right =
        kit_do(&kit, text.at) != CT_OK && strstr(kit.error.message, "no mass or inertia") != NULL &&
        (strstr(kit.error.message, "rod.W") != NULL || strstr(kit.error.message, "s.W") != NULL);
    if (!right || m->told)
        tell(m, "%s\n%s", kit.error.message, text.at);
    text_free(&text);
    kit_free(&kit);
    return right ? AGREES : DISAGREES;
}

static const Family families[] = {
    {"point_masses_move_with_what_they_are_welded_to", 4, 0, 0, merged_member},
    {"point_masses_on_couplers_move_alike_in_all_trees", 3, 0, 0, coupler_member},
    {"spins_that_nothing_determines_are_refused_by_name", 10, 0, 0, spin_member},
};

int main(int argc, char **argv)
{
    (void)test_faults;
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
