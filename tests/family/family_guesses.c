/* family_guesses.c: the assembly that guesses mean is the one that is found
 *
 * Loops in the plane and in space are closed where coordinates drawn at random put them (scenes.h).
 * Some or all of their joints and bodies are guessed within a tenth of that, in trees of all kinds.
 * What is found has to be an assembly, and no further from the guesses than the one drawn:
 * d^2 = sum of squares of angles (rad), of Euler parameters, and of lengths over L. L is that of
 * the mechanism; as one extreme of L or the other does, what is accepted doesn't depend on it. */
#include "standing.h"

#include "base/memory.h"

#define OFF     0.1  /* rad, m: how far guesses are from where they belong */
#define SHORT   0.3  /* m: no L is less, */
#define LONG    10.0 /* m: none more */
#define ROUNDED 1e-5 /* of a distance that is a minimum */

enum { MOST_GUESSES = 128 };

typedef struct Guess {
    char name[24];
    double guessed, drawn;
    bool is_angle, is_length;
    int group; /* of Euler parameters, in order; -1 */
} Guess;

typedef struct Guesses {
    Guess at[MOST_GUESSES];
    int count, groups;
} Guesses;

static Kind kind_of_loop(Member *m, bool planar)
{
    static const Kind plane[] = {REVOLUTE, REVOLUTE, REVOLUTE, PRISMATIC};
    static const Kind space[] = {REVOLUTE,    REVOLUTE,  REVOLUTE, PRISMATIC,
                                 CYLINDRICAL, UNIVERSAL, SPHERICAL};

    return planar ? plane[pick(m, COUNT(plane))] : space[pick(m, COUNT(space))];
}

static int freedoms_of(Kind kind)
{
    return kind == SPHERICAL ? 3 : kind == CYLINDRICAL || kind == UNIVERSAL ? 2 : 1;
}

/* a chain from ground, then joints that close loops as long as freedoms are left */
static void make_loops(Member *m, Scene *s)
{
    int freedoms = 0;
    const int asked = 1 + pick(m, 2);

    memset(s, 0, sizeof *s);
    s->planar = pick(m, 2) == 0;
    s->is_chain = true;
    s->bodies = s->planar ? 3 + pick(m, 3) : 4 + pick(m, 3);
    for (int i = 0; i < s->bodies; i++) {
        s->only = kind_of_loop(m, s->planar);
        freedoms += freedoms_of(s->only);
        hang(m, s, i);
    }
    s->is_chain = false;
    s->joints = s->bodies;
    for (int loops = 0; loops < asked; loops++) {
        s->only = kind_of_loop(m, s->planar);
        freedoms -= (s->planar ? 3 : 6) - freedoms_of(s->only);
        if (freedoms < 0 && loops > 0)
            break;
        hang(m, s, s->joints++);
    }
    s->all = s->joints;
    write_bodies(m, s);
    for (int i = 0; i < s->all; i++)
        write_joint(s, i);
}

static void add(Guesses *g, const Guess *guess, Scene *out)
{
    g->at[g->count++] = *guess;
    write(out, "guess %s = %.17g\n", guess->name, guess->guessed);
}

/* four Euler parameters, turned a little from q, of either sign */
static void guess_attitude(Member *m, const char *name, const double *q, Guesses *g, Scene *out)
{
    const double sign = pick(m, 2) ? 1 : -1;
    double axis[3], size = 0, near[4];

    for (int i = 0; i < 3; i++) {
        axis[i] = between(m, -1, 1);
        size = hypot(size, axis[i]);
    }
    for (int i = 0; i < 3; i++)
        axis[i] /= size;
    multiply(q, turned(axis, between(m, -OFF, OFF)).q, near);
    for (int i = 0; i < 4; i++) {
        Guess guess = {.guessed = sign * near[i], .drawn = sign * q[i], .group = g->groups};

        (void)snprintf(guess.name, sizeof guess.name, "%s.q%d", name, i);
        add(g, &guess, out);
    }
    g->groups++;
}

static void guess_joint(Member *m, const Scene *s, int number, Guesses *g, Scene *out)
{
    const Joint *j = &s->joint[number];
    char name[16];

    (void)snprintf(name, sizeof name, "j%d", number);
    for (int k = 0; k < j->count; k++) {
        Guess guess = {.drawn = j->c[k],
                       .guessed = j->c[k] + between(m, -OFF, OFF),
                       .is_angle = is_angle(j, k),
                       .is_length = !is_angle(j, k),
                       .group = -1};

        if (is_parameter(j, k))
            continue;
        (void)snprintf(guess.name, sizeof guess.name, "%s%s", name, coordinate_name(j, k));
        add(g, &guess, out);
    }
    if (first_parameter(j) >= 0)
        guess_attitude(m, name, j->c + first_parameter(j), g, out);
}

static void guess_body(Member *m, const Scene *s, int body, Guesses *g, Scene *out)
{
    const Pose *p = &s->body[body];
    const bool attitude = pick(m, 2) == 0;
    char name[16];

    (void)snprintf(name, sizeof name, "b%d", body);
    for (int i = 0; i < (s->planar ? 2 : 3); i++) {
        Guess guess = {.drawn = p->r[i],
                       .guessed = p->r[i] + between(m, -OFF, OFF),
                       .is_length = true,
                       .group = -1};

        if (pick(m, 4) == 0)
            continue;
        (void)snprintf(guess.name, sizeof guess.name, "%s.%c", name, "xyz"[i]);
        add(g, &guess, out);
    }
    if (!attitude)
        return;
    if (s->planar) {
        Guess guess = {.drawn = 2 * atan2(p->q[3], p->q[0]), .is_angle = true, .group = -1};

        guess.guessed = guess.drawn + between(m, -OFF, OFF);
        (void)snprintf(guess.name, sizeof guess.name, "%s.theta", name);
        add(g, &guess, out);
    } else {
        guess_attitude(m, name, p->q, g, out);
    }
}

/* all joints; or each with some chance, bodies too */
static void guess_some(Member *m, const Scene *s, bool whole, Guesses *g, Scene *out)
{
    *g = (Guesses){.count = 0};
    while (g->count == 0) {
        for (int i = 0; i < s->all; i++)
            if (whole || pick(m, 3) > 0)
                guess_joint(m, s, i, g, out);
        for (int i = 0; i < s->bodies; i++)
            if (!whole && pick(m, 4) == 0)
                guess_body(m, s, i, g, out);
    }
}

/* squares of what is missed: angles and parameters; lengths */
static void add_missed(const Guesses *g, const double *values, double *angles, double *lengths)
{
    *angles = *lengths = 0;
    for (int i = 0; i < g->count; i++) {
        const Guess *guess = &g->at[i];
        double off = values[i] - guess->guessed;

        if (guess->group >= 0)
            continue;
        if (guess->is_angle)
            off = remainder(off, 2 * M_PI);
        *(guess->is_length ? lengths : angles) += off * off;
    }
    for (int group = 0; group < g->groups; group++) {
        double plus = 0, minus = 0;

        for (int i = 0; i < g->count; i++)
            if (g->at[i].group == group) {
                plus += pow(values[i] - g->at[i].guessed, 2);
                minus += pow(-values[i] - g->at[i].guessed, 2);
            }
        *angles += fmin(plus, minus);
    }
}

static bool is_nearest(Member *m, Kit *kit, const Guesses *g)
{
    double found[MOST_GUESSES], drawn[MOST_GUESSES], a, b, c, d;

    for (int i = 0; i < g->count; i++) {
        found[i] = kit_value(kit, g->at[i].name);
        drawn[i] = g->at[i].drawn;
    }
    add_missed(g, found, &a, &b);
    add_missed(g, drawn, &c, &d);
    if (m->told || !(a + b / (SHORT * SHORT) <= c + d / (SHORT * SHORT) + ROUNDED))
        tell(m, "distances: %g rad, %g m, of the one drawn %g rad, %g m\n", sqrt(a), sqrt(b),
             sqrt(c), sqrt(d));
    return a + b / (SHORT * SHORT) <= c + d / (SHORT * SHORT) + ROUNDED ||
           a + b / (LONG * LONG) <= c + d / (LONG * LONG) + ROUNDED;
}

static Verdict stands_as_guessed(Member *m, bool whole)
{
    static Scene s, out;
    static Guesses g;
    Pose bodies[BODIES];
    Kit kit = kit_new();
    bool right;

    make_loops(m, &s);
    out.length = 0;
    write(&out, "%s", s.text);
    write_trees(m, &s, pick(m, 3), &out);
    guess_some(m, &s, whole, &g, &out);
    write(&out, "assemble\n");
    right = kit_do(&kit, out.text) == CT_OK;
    for (int i = 0; i < s.bodies && right; i++)
        bodies[i] = read_body(&kit, &s, i);
    right = right && off_consistent(m, &kit, &s, bodies) < NEAR && is_nearest(m, &kit, &g);
    if (!right || m->told)
        tell(m, "%s\n%s", kit.error.message, out.text);
    kit_free(&kit);
    return right ? AGREES : DISAGREES;
}

static Verdict whole_member(Member *m)
{
    return stands_as_guessed(m, true);
}

static Verdict part_member(Member *m)
{
    return stands_as_guessed(m, false);
}

static const Family families[] = {
    {"loops_stand_where_all_joints_are_guessed", 25, 0, 0, whole_member},
    {"loops_stand_where_some_parts_are_guessed", 25, 0, 0, part_member},
};

int main(int argc, char **argv)
{
    (void)test_faults;
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
