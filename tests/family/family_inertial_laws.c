/* family_inertial_laws.c: a law that pushes against an acceleration moves as the mass that it
 * stands for
 *
 * Newton: a point pushed with f - c a moves as if a mass c without weight sat there, pushed with f;
 * a body in the plane with M - J theta'' as if its inertia were larger by J. So each machine is run
 * twice, once with laws and once with masses, and has to move and to load its joints alike, in
 * whatever trees each of the two is written. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

enum { MOST_BODIES = 20, LAWS = 2 };

typedef struct Law {
    int body;
    double mass, inertia, push[3];
} Law;

typedef struct Machine {
    bool planar;
    int bodies;
    Law laws[LAWS];
    char joints[MOST_BODIES * 120]; /* a chain: what both have in common */
} Machine;

static void draw(Member *member, Machine *m)
{
    size_t length = 0;

    m->planar = member_one_of(member, 2) != 0;
    m->bodies = 1 + member_one_of(member, member_one_of(member, 8) == 0 ? MOST_BODIES : 3);
    for (int i = 0; i < m->bodies; i++) {
        char axis[80] = "";
        const bool slides = member_one_of(member, 4) == 0;

        if (!m->planar)
            (void)snprintf(axis, sizeof axis, "axis=[%.3f, %.3f, 1]", member_between(member, -1, 1),
                           member_between(member, -1, 1));
        else if (slides)
            (void)snprintf(axis, sizeof axis, "axis=[1, %.3f]", member_between(member, -1, 1));
        length += (size_t)snprintf(m->joints + length, sizeof m->joints - length,
                                   "%s j%d %s%.0d b%d %s\n", slides ? "prismatic" : "revolute",
                                   i + 1, i == 0 ? "ground" : "tip", i, i + 1, axis);
    }
    for (int i = 0; i < LAWS; i++) {
        m->laws[i] = (Law){.body = 1 + member_one_of(member, m->bodies),
                           .mass = member_decades(member, 0.1, 10),
                           .inertia = member_decades(member, 0.1, 10)};
        for (int k = 0; k < 3; k++)
            m->laws[i].push[k] = member_between(member, -3, 3);
    }
}

static void write_frame(Script *text, const Machine *m, const char *name, int body, double x)
{
    write_line(text, m->planar ? "arm %s b%d [%.3f, 0.1]" : "arm %s b%d [%.3f, 0.1, -0.2]", name,
               body, x);
}

static void write_law(Member *member, Script *text, const Machine *m, int i)
{
    const Law *law = &m->laws[i];
    char at[16];

    (void)snprintf(at, sizeof at, "p%d", i + 1);
    /* through an output, or in the law itself */
    if (member_one_of(member, 2))
        write_line(text, "output a%d = -%.17g*%s.x''\nforce F%d %s [a%d + (%.17g), -%.17g*%s.y''",
                   i, law->mass, at, i, at, i, law->push[0], law->mass, at);
    else
        write_line(text, "force F%d %s [(%.17g) - %.17g*%s.x'', -%.17g*%s.y''", i, at, law->push[0],
                   law->mass, at, law->mass, at);
    text->length--;
    if (m->planar)
        write_line(text, " + (%.17g)]\ntorque T%d b%d %.17g - %.17g*b%d.theta''", law->push[1], i,
                   law->body, law->push[2], law->inertia, law->body);
    else
        write_line(text, " + (%.17g), (%.17g) - %.17g*%s.z'']", law->push[1], law->push[2],
                   law->mass, at);
}

static void write_mass(Script *text, const Machine *m, int i)
{
    const Law *law = &m->laws[i];

    if (m->planar)
        write_line(text,
                   "body e%d mass=%.17g inertia=0\nweld w%d p%d e%d\n"
                   "force F%d p%d [%.17g, %.17g]\ntorque T%d b%d %.17g",
                   i, law->mass, i, i + 1, i, i, i + 1, law->push[0], law->push[1], i, law->body,
                   law->push[2]);
    else
        write_line(text,
                   "body e%d mass=%.17g inertia=[0, 0, 0]\nweld w%d p%d e%d\n"
                   "force F%d p%d [%.17g, %.17g, %.17g]",
                   i, law->mass, i, i + 1, i, i, i + 1, law->push[0], law->push[1], law->push[2]);
}

/* false: refused, as the member's story tells */
static bool run(Member *member, const Machine *m, bool laws, Kit *kit)
{
    static const char *const trees[] = {"joint", "absolute", "translation j1\ntree rotation b1"};
    static const char *const methods[] = {"auto", "dop853", "radau", "ida"};
    static Script text;
    const int tree = m->bodies > 3 ? 0 : member_one_of(member, 3);

    text.length = 0;
    write_line(&text, m->planar ? "scene planar" : "scene spatial");
    for (int i = 1; i <= m->bodies; i++) {
        double inertia = 0.2 + 0.1 * i;

        for (int k = 0; k < LAWS && m->planar && !laws; k++)
            inertia += m->laws[k].body == i ? m->laws[k].inertia : 0;
        write_line(&text,
                   m->planar ? "body b%d mass=%.3f inertia=%.17g"
                             : "body b%d mass=%.3f inertia=[%.17g, 0.4, 0.5]",
                   i, 1 + 0.1 * i, m->planar ? inertia : 0.3);
        char tip[16];

        (void)snprintf(tip, sizeof tip, "tip%d", i);
        write_frame(&text, m, tip, i, 0.5);
    }
    write_line(&text, "%s", m->joints);
    for (int i = 0; i < LAWS; i++) {
        char at[16];

        (void)snprintf(at, sizeof at, "p%d", i + 1);
        write_frame(&text, m, at, m->laws[i].body, 0.3 - 0.4 * i);
        if (laws)
            write_law(member, &text, m, i);
        else
            write_mass(&text, m, i);
    }
    write_line(&text, "tree %s", trees[tree]);
    write_line(&text, "init j1' = 0.5\nsimulate 0.3 rtol=1e-9 atol=1e-11 method=%s",
               methods[member_one_of(member, 4)]);
    tell(member, "%s", text.text);
    if (kit_do(kit, text.text) == CT_OK)
        return true;
    tell(member, "%s\n", kit->error.message);
    return false;
}

static Verdict laws_move_as_masses(Member *member)
{
    static const char *const asked[] = {"b%d.x", "b%d.vy", "b%d.ax", "j%d.fx", "j%d.fy", "j%d.tz"};
    Machine m = {0};
    Kit kits[2] = {kit_new(), kit_new()};
    bool same = true;

    draw(member, &m);
    same = run(member, &m, true, &kits[0]) && run(member, &m, false, &kits[1]);
    for (int i = 1; i <= m.bodies && same; i++)
        for (int k = 0; k < (int)(sizeof asked / sizeof *asked); k++) {
            char name[32];
            double a, b;

            (void)snprintf(name, sizeof name, asked[k], i);
            a = kit_value(&kits[0], name);
            b = kit_value(&kits[1], name);
            same = keeps(member, name, fabs(a - b), 1e-5 * (1 + fabs(b))) && same;
        }
    kit_free(&kits[0]);
    kit_free(&kits[1]);
    return same ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"laws_that_push_against_accelerations_move_as_masses", 24, 0, 0, laws_move_as_masses},
    };

    return family_main(families, 1, argc, argv);
}
