/* family_assembly.c: the start is the one described, whatever the trees and however it is told
 *
 * cotree is told of where the bodies of a random scene stand by joint coordinates, by body
 * coordinates, or by some of each, as initial values or as guesses, in trees of all kinds; then its
 * trees are changed, and what was told is forgotten, so that it begins as if nothing had been told.
 * The poses come from scenes.h. */
#include "standing.h"

#include "base/memory.h"
#include "base/text.h"

/* --- telling --- */

typedef struct Told {
    int way;             /* joints, bodies, some of each */
    int verbs;           /* init, guess, some of each */
    bool guessed;        /* anything */
    bool joint[JOINTS];  /* all its coordinates, as they are */
    bool angles[JOINTS]; /* its angles are those nearest to it */
    bool body[BODIES];
} Told;

static const char *verb_of(Member *m, const Told *told)
{
    return told->verbs == 0 || (told->verbs == 2 && pick(m, 2) == 0) ? "init" : "guess";
}

/* Four parameters or those that leave no choice. q and -q are one attitude. */
static void report_attitude(Member *m, const char *verb, const char *name, const double *q,
                            Scene *out)
{
    const int zeros = (q[1] == 0) + (q[2] == 0) + (q[3] == 0);
    double sign = pick(m, 2) ? 1 : -1;
    const bool without_zeros = zeros > 1 && pick(m, 2) == 0;
    /* with the first left out it is not negative */
    const bool without_first =
        !without_zeros && verb[0] == 'i' && fabs(q[0]) > 0.3 && pick(m, 6) == 0;

    if (without_first)
        sign = q[0] < 0 ? -1 : 1;
    for (int i = 0; i < 4; i++)
        if (!(without_zeros && q[i] == 0) && !(without_first && i == 0))
            write(out, "%s %s.q%d = %.17g\n", verb, name, i, sign * q[i]);
}

static void report_joint(Member *m, const Scene *s, int number, const Told *told, Scene *out)
{
    const Joint *j = &s->joint[number];
    const char *verb = verb_of(m, told);
    char name[16];

    snprintf(name, sizeof name, "j%d", number);
    for (int k = 0; k < j->count; k++)
        if (!is_parameter(j, k))
            write(out, "%s %s%s = %.17g\n", verb, name, coordinate_name(j, k), j->c[k]);
    if (first_parameter(j) >= 0)
        report_attitude(m, verb, name, j->c + first_parameter(j), out);
}

static void report_body(Member *m, const Scene *s, int body, const Told *told, Scene *out)
{
    const Pose *p = &s->body[body];
    const char *verb = verb_of(m, told);
    char name[16];

    snprintf(name, sizeof name, "b%d", body);
    for (int i = 0; i < (s->planar ? 2 : 3); i++)
        write(out, "%s %s.%c = %.17g\n", verb, name, 'x' + i, p->r[i]);
    if (s->planar)
        write(out, "%s %s.theta = %.17g\n", verb, name,
              2 * atan2(p->q[3], p->q[0]) + 2 * M_PI * (pick(m, 3) - 1));
    else
        report_attitude(m, verb, name, p->q, out);
}

/* guesses of angles that follow from the rest: they choose the turn */
static void guess_turns(Member *m, const Scene *s, Told *told, Scene *out)
{
    for (int i = 0; i < s->all; i++) {
        const Joint *j = &s->joint[i];

        /* three angles of one another have no nearest turn each */
        if (told->joint[i] || j->kind == SPHERICAL_ANGLES || pick(m, 2) == 0)
            continue;
        told->angles[i] = told->guessed = true;
        for (int k = 0; k < j->count; k++)
            if (is_angle(j, k))
                write(out, "guess j%d%s = %.17g\n", i, coordinate_name(j, k),
                      j->c[k] + between(m, -0.5, 0.5));
    }
}

/* Each body once, now and then the same again by what follows. */
static void report_start(Member *m, const Scene *s, Told *told, Scene *out)
{
    *told = (Told){.way = pick(m, 3), .verbs = pick(m, 3)};
    for (int i = 0; i < s->bodies; i++) {
        told->joint[i] = told->way == 0 || (told->way == 2 && pick(m, 2) == 0);
        told->body[i] = !told->joint[i];
        if (told->joint[i])
            report_joint(m, s, i, told, out);
        else
            report_body(m, s, i, told, out);
    }
    for (int i = s->bodies; i < s->all; i++) {
        told->joint[i] = pick(m, 5) == 0;
        if (told->joint[i])
            report_joint(m, s, i, told, out);
    }
    /* beside others guesses are met as far as they can be, all alike */
    if (told->verbs == 0)
        guess_turns(m, s, told, out);
}

/* --- comparing --- */

/* Angles that were told or guessed as they were, others within half a turn of 0. */
static double off_angles(Member *m, Kit *kit, const Scene *s, const Told *told)
{
    double off = 0;

    for (int i = 0; i < s->all; i++) {
        const Joint *j = &s->joint[i];
        double c[MOST_COORDINATES];

        read_joint(kit, s, i, c);
        for (int k = 0; k < j->count; k++) {
            double wrong = c[k] - j->c[k];

            if (is_parameter(j, k) || (j->kind == SPHERICAL_ANGLES && isnan(c[k])))
                continue;
            if (is_angle(j, k) && !told->joint[i] && !told->angles[i])
                wrong = fabs(c[k]) > M_PI + 1e-9 ? c[k] : remainder(wrong, 2 * M_PI);
            if (j->kind == SPHERICAL_ANGLES && !told->joint[i])
                continue; /* the other set of the two will do */
            if (!(fabs(wrong) < NEAR))
                tell(m, "j%d%s is %.12g, not %.12g\n", i, coordinate_name(j, k), c[k], j->c[k]);
            off = worst(off, fabs(wrong));
        }
    }
    return off;
}

/* assemble, and hold all that is reported against the scene */
static bool agrees(Member *m, Kit *kit, const Scene *s, const Told *told, double near,
                   const char *text)
{
    Pose bodies[BODIES];
    double off;

    if (kit_do(kit, text) != CT_OK) {
        tell(m, "%s\n%s", kit->error.message, text);
        return false;
    }
    for (int i = 0; i < s->bodies; i++)
        bodies[i] = read_body(kit, s, i);
    off = off_bodies(m, s, bodies, s->body);
    off = worst(off, off_consistent(m, kit, s, bodies));
    off = worst(off, off_angles(m, kit, s, told));
    if (!(off < near) || m->told)
        tell(m, "%s", text);
    return off < near;
}

/* --- starts that are told --- */

/* whether bodies stand where they do in a session that was never told of a start, or neither finds
 * one */
static bool begins_anew(Member *m, Kit *kit, const Scene *s, const char *text)
{
    static const char *const members[] = {"x", "y", "z", "q0", "q1", "q2", "q3", "a1", "a2", "a3"};
    Kit fresh = kit_new();
    double most = 0;
    const bool was_set = kit_do(&fresh, s->text) == CT_OK;
    const bool stands = kit_do(kit, text) == CT_OK;
    const bool alike = was_set && (kit_do(&fresh, text) == CT_OK) == stands;

    for (int i = 0; i < s->bodies && alike && stands; i++)
        for (int k = 0; k < COUNT(members); k++) {
            char item[40];
            double told, untold;

            (void)snprintf(item, sizeof item, "b%d.%s", i, members[k]);
            told = kit_value(kit, item);
            untold = kit_value(&fresh, item);
            /* a body has parameters or angles */
            if (!isnan(told) || !isnan(untold))
                most = worst(most, fabs(told - untold));
        }
    kit_free(&fresh);
    if (!(alike && most < NEAR))
        tell(m, "%safter init none bodies are %g from where they begin\n", text, most);
    return alike && most < NEAR;
}

/* one way of telling, in trees that are changed twice */
static bool start_agrees(Member *m, const Scene *s, int choice)
{
    static Scene out;
    Told told;
    Kit kit = kit_new();
    bool right;

    out.length = 0;
    write(&out, "%s", s->text);
    write_trees(m, s, choice, &out);
    report_start(m, s, &told, &out);
    write(&out, "assemble\n");
    right = agrees(m, &kit, s, &told, NEAR, out.text);
    out.length = 0;
    write_trees(m, s, pick(m, 4), &out);
    write(&out, "assemble\n");
    right = right && agrees(m, &kit, s, &told, NEAR, out.text);
    out.length = 0;
    write(&out, "init none\n");
    write_trees(m, s, pick(m, 4), &out);
    write(&out, "assemble\n");
    right = right && (told.verbs > 0 || told.guessed || begins_anew(m, &kit, s, out.text));
    kit_free(&kit);
    return right;
}

static Verdict told_member(Member *m)
{
    static Scene s;
    bool right = true;

    make_scene(m, &s, WITH_LOOPS | WITH_VIRTUALS);
    for (int choice = 0; choice < 3 && right; choice++)
        right = start_agrees(m, &s, choice);
    return right ? AGREES : DISAGREES;
}

/* --- starts that are told in part --- */

/* some bodies of those that the scene hangs up, and turns of loops */
static void report_part(Member *m, const Scene *s, Scene *out)
{
    Told told = {.verbs = pick(m, 3)};

    for (int i = 0; i < s->bodies; i++) {
        /* three angles that nobody told begin where they have no rates */
        const int how = s->joint[i].kind == SPHERICAL_ANGLES ? 1 : pick(m, 4);

        if (how == 0)
            report_body(m, s, i, &told, out);
        else if (how == 1)
            report_joint(m, s, i, &told, out);
    }
}

/* Where the bodies stand is the same in all trees, and as their joints allow. */
static Verdict part_member(Member *m)
{
    static Scene s, start, out;
    Pose first[BODIES], bodies[BODIES];
    int sound = 0;

    make_scene(m, &s, WITH_LOOPS);
    start.length = 0;
    start.text[0] = '\0';
    report_part(m, &s, &start);
    tell(m, "%s%s", m->told ? s.text : "", start.text);
    for (int choice = 0; choice < 3; choice++) {
        Kit kit = kit_new();
        double off = 0;

        out.length = 0;
        write(&out, "%s", s.text);
        write_trees(m, &s, choice, &out);
        tell(m, "%s", strstr(out.text, "tree "));
        write(&out, "%sassemble\n", start.text);
        if (kit_do(&kit, out.text) == CT_OK) {
            for (int i = 0; i < s.bodies; i++)
                bodies[i] = read_body(&kit, &s, i);
            off = off_consistent(m, &kit, &s, bodies);
            if (sound++ == 0)
                memcpy(first, bodies, sizeof bodies);
            off = worst(off, off_bodies(m, &s, bodies, first));
        } else {
            tell(m, "%s\n", kit.error.message);
        }
        kit_free(&kit);
        if (!(off < NEAR))
            return DISAGREES;
    }
    return sound == 3 ? AGREES : sound == 0 ? REFUSED : DISAGREES;
}

/* --- counted --- */

/* One joint in any attitude, or a chain of four hinges, by bodies alone: kinds take turns. */
static Verdict counted_member(Member *m)
{
    static const Kind kinds[] = {WELD, PRISMATIC, SCREW, CYLINDRICAL, PLANARJOINT, REVOLUTE};
    static Scene s, out;
    const Told told = {.joint = {true, true, true, true}};
    const Kind kind = kinds[m->number % 6];
    Kit kit = kit_new();
    bool right;

    make_chain(m, &s, kind, kind == REVOLUTE ? 4 : 1);
    out.length = 0;
    write(&out, "%stree absolute\n", s.text);
    for (int i = 0; i < s.bodies; i++)
        report_joint(m, &s, i, &told, &out);
    write(&out, "assemble\n");
    right = agrees(m, &kit, &s, &told, NEAR, out.text);
    kit_free(&kit);
    return right ? AGREES : DISAGREES;
}

/* --- loops that close the wrong way round --- */

static bool names_open_joint(const char *message)
{
    static const char *const words[] = {" closes only with its ", "can't be assembled",
                                        "can't be put together"};
    bool found = false;

    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        found = found || strstr(message, words[i]) != NULL;
    return found && strchr(message, 'j') != NULL;
}

static Verdict reversed_member(Member *m)
{
    static Scene s, out;
    bool right = true;

    make_reversed(m, &s);
    for (int choice = 0; choice < 3 && right; choice++) {
        Kit kit = kit_new();
        Told told;

        out.length = 0;
        write(&out, "%s", s.text);
        write_trees(m, &s, choice, &out);
        report_start(m, &s, &told, &out);
        write(&out, "assemble\n");
        /* as reversed, or as open in trees that have the last joint as a branch */
        right = kit_do(&kit, out.text) != CT_OK && names_open_joint(kit.error.message);
        if (!right || m->told)
            tell(m, "%s\n%s", kit.error.message, out.text);
        kit_free(&kit);
    }
    return right ? AGREES : DISAGREES;
}

/* A four-bar on either branch, of which a guess tells as much as decides it: it stands there. */
static Verdict guessed_four_bar(Member *m)
{
    static const char *const ways[] = {"guess h1, h2, h3, h4", "init h1, guess h2",
                                       "init h1, guess h3",    "init h1, guess h4",
                                       "guess h1, h3",         "guess h1, h2"};
    const int way = member_one_of(m, (int)(sizeof ways / sizeof *ways));
    const double A = member_between(m, 0.3, 1.2), B = member_between(m, 0.3, 1.2);
    const double C = member_between(m, 0.3, 1.2), h1 = member_between(m, -3, 3);
    /* the coupler's other end is that of the rocker, whose hinge is where that puts it */
    const double coupler = member_between(m, -3, 3), rocker = member_between(m, -3, 3);
    const double at[2] = {A * cos(h1) + B * cos(coupler) - C * cos(rocker),
                          A * sin(h1) + B * sin(coupler) - C * sin(rocker)};
    const double h[4] = {h1, remainder(coupler - h1, 2 * M_PI), rocker,
                         remainder(rocker - coupler, 2 * M_PI)};
    char text[2048];
    int length, told = 0;
    Kit kit = kit_new();
    bool agrees;

    length = snprintf(text, sizeof text,
                      "scene planar\nbody a mass=1 inertia=1\nbody b mass=1 inertia=1\n"
                      "body c mass=1 inertia=1\narm a1 a [%.17g, 0]\narm b1 b [%.17g, 0]\n"
                      "arm c1 c [%.17g, 0]\narm g ground [%.17g, %.17g]\nrevolute h1 ground a\n"
                      "revolute h2 a1 b\nrevolute h3 g c\nrevolute h4 b1 c1\n%s\n",
                      A, B, C, at[0], at[1], member_one_of(m, 2) ? "tree joint" : "tree absolute");
    for (int i = 0; i < 4; i++) {
        const bool is_told = strstr(ways[way], (const char[]){'h', (char)('1' + i), '\0'}) != NULL;
        const bool given = i == 0 && ways[way][0] == 'i';

        told += is_told;
        if (is_told)
            length += snprintf(text + length, sizeof text - (size_t)length, "%s h%d = %.17g\n",
                               given ? "init" : "guess", i + 1, h[i]);
    }
    (void)snprintf(text + length, sizeof text - (size_t)length, "assemble\n");
    agrees = told > 1 && kit_do(&kit, text) == CT_OK;
    for (int i = 0; i < 4 && agrees; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "h%d", i + 1);
        agrees = keeps(m, name, fabs(remainder(kit_value(&kit, name) - h[i], 2 * M_PI)), 1e-6);
    }
    if (!agrees || m->told)
        tell(m, "%s\n%s: %s\n", text, ways[way], kit.error.message);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

/* Rods in a row in absolute coordinates, of which some joints' rates are told and the angles of
 * all: the others are at rest, so that a rod turns as fast as all joints before it together. Some
 * bodies' speeds are told once more, which is nothing new, or in one of them is off. */
static Verdict long_chain(Member *m)
{
    const int n = 20 + member_one_of(m, 60), wrong = member_one_of(m, 4) == 0 ? n - 1 : -1;
    double angle = 0, turn = 0, speed[2] = {0}, rate[80], at[80][2];
    Text text = {0};
    Kit kit = kit_new();
    bool agrees;

    text_add(&text, "scene planar\n");
    for (int i = 0; i < n; i++) {
        const double by = member_between(m, -0.5, 0.5);

        text_addf(&text, "body b%d mass=1 inertia=1\narm s%d b%d [-0.5, 0]\narm e%d b%d [0.5, 0]\n",
                  i, i, i, i, i);
        if (i == 0)
            text_add(&text, "revolute h0 ground s0\n");
        else
            text_addf(&text, "revolute h%d e%d s%d\n", i, i - 1, i);
        text_addf(&text, "init h%d = %.17g\n", i, by);
        angle += by;
        if (i == 0 || i == wrong || i + 1 == wrong || member_one_of(m, 3) == 0) {
            const double told = member_between(m, -2, 2);

            text_addf(&text, "init h%d' = %.17g\n", i, told);
            turn += told;
        }
        rate[i] = turn;
        for (int k = 0; k < 2; k++) {
            const double way = k == 0 ? -sin(angle) : cos(angle);

            at[i][k] = speed[k] + 0.5 * turn * way;
            speed[k] += turn * way;
        }
        if (i == wrong || i + 1 == wrong || member_one_of(m, 10) == 0)
            text_addf(&text, "init b%d.theta' = %.17g\n", i, turn + (i == wrong ? 0.1 : 0));
    }
    text_add(&text, "tree absolute\nassemble\n");
    agrees = (kit_do(&kit, text.at) == CT_OK) == (wrong < 0);
    for (int i = 0; i < n && agrees && wrong < 0; i++) {
        char name[32];

        (void)snprintf(name, sizeof name, "b%d.theta'", i);
        agrees = keeps(m, name, fabs(kit_value(&kit, name) - rate[i]), 1e-9);
        for (int k = 0; k < 2 && agrees; k++) {
            (void)snprintf(name, sizeof name, "b%d.%c'", i, 'x' + k);
            agrees = keeps(m, name, fabs(kit_value(&kit, name) - at[i][k]), 1e-8);
        }
    }
    if (!agrees || m->told)
        tell(m, "%s\n%s\n", text.at, kit.error.message);
    text_free(&text);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

static const Family families[] = {
    {"four_bars_stand_where_they_are_guessed", 60, 0, 0, guessed_four_bar},
    {"starts_are_the_ones_described", 36, 0, 0, told_member},
    {"starts_told_in_part_are_the_same_in_all_trees", 20, 0.5, 0, part_member},
    {"joints_in_any_attitude_stand_as_told_in_absolute_coordinates", 6 * 25, 0, 0, counted_member},
    {"speeds_of_long_chains_are_those_told", 12, 0, 0, long_chain},
    {"loops_that_close_with_an_axis_reversed_are_refused", 3, 0, 0, reversed_member},
};

int main(int argc, char **argv)
{
    (void)test_faults;
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
