/* family_assembly.c: the start is the one described, whatever the trees and however it is told
 *
 * cotree is told of where the bodies of a random scene stand by joint coordinates, by body
 * coordinates, or by some of each, as initial values or as guesses, in trees of all kinds; then its
 * trees are changed, and what was told is forgotten. The poses come from scenes.h. */
#include "../unit/session_kit.h"
#include "scenes.h"

#define NEAR 1e-8 /* m, rad: numbers are written to the last digit */

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
static void tell_attitude(Member *m, const char *verb, const char *name, const double *q,
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

static void tell_joint(Member *m, const Scene *s, int number, const Told *told, Scene *out)
{
    const Joint *j = &s->joint[number];
    const char *verb = verb_of(m, told);
    char name[16];

    snprintf(name, sizeof name, "j%d", number);
    for (int k = 0; k < j->count; k++)
        if (!is_parameter(j, k))
            write(out, "%s %s%s = %.17g\n", verb, name, coordinate_name(j, k), j->c[k]);
    if (first_parameter(j) >= 0)
        tell_attitude(m, verb, name, j->c + first_parameter(j), out);
}

static void tell_body(Member *m, const Scene *s, int body, const Told *told, Scene *out)
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
        tell_attitude(m, verb, name, p->q, out);
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
static void tell_start(Member *m, const Scene *s, Told *told, Scene *out)
{
    *told = (Told){.way = pick(m, 3), .verbs = pick(m, 3)};
    for (int i = 0; i < s->bodies; i++) {
        told->joint[i] = told->way == 0 || (told->way == 2 && pick(m, 2) == 0);
        told->body[i] = !told->joint[i];
        if (told->joint[i])
            tell_joint(m, s, i, told, out);
        else
            tell_body(m, s, i, told, out);
    }
    for (int i = s->bodies; i < s->all; i++) {
        told->joint[i] = pick(m, 5) == 0;
        if (told->joint[i])
            tell_joint(m, s, i, told, out);
    }
    /* beside others guesses are met as far as they can be, all alike */
    if (told->verbs == 0)
        guess_turns(m, s, told, out);
}

/* --- comparing --- */

static double value(Kit *kit, const char *head, int number, const char *member)
{
    char name[40];

    snprintf(name, sizeof name, "%s%d%s", head, number, member);
    return kit_value(kit, name);
}

/* where a body stands; in a plane its angle stands for the parameters */
static Pose read_body(Kit *kit, const Scene *s, int body)
{
    static const char *const places[] = {".x", ".y", ".z"};
    static const char *const parameters[] = {".q0", ".q1", ".q2", ".q3"};
    static const double z[3] = {0, 0, 1};
    Pose p = here;

    if (s->planar)
        p = turned(z, value(kit, "b", body, ".theta"));
    for (int i = 0; i < 4 && !s->planar; i++)
        p.q[i] = value(kit, "b", body, parameters[i]);
    for (int i = 0; i < (s->planar ? 2 : 3); i++)
        p.r[i] = value(kit, "b", body, places[i]);
    return p;
}

static void read_joint(Kit *kit, const Scene *s, int number, double *c)
{
    for (int k = 0; k < s->joint[number].count; k++)
        c[k] = value(kit, "j", number, coordinate_name(&s->joint[number], k));
}

static double worst(double a, double b)
{
    return isnan(a) || isnan(b) ? NAN : fmax(a, b);
}

/* How far the coordinates that are reported are from those that follow from where the bodies
 * stand; three angles of a chord can't be told. */
static double off_consistent(Member *m, Kit *kit, const Scene *s, const Pose *bodies)
{
    static const double nothing[MOST_COORDINATES];
    double off = 0;

    for (int i = 0; i < s->all; i++) {
        const Joint *j = &s->joint[i];
        double c[MOST_COORDINATES], wrong;
        Pose stands, says;
        bool silent;

        read_joint(kit, s, i, c);
        stands = compose(inverse(compose(j->tail_body < 0 ? here : bodies[j->tail_body], j->tail)),
                         compose(j->head_body < 0 ? here : bodies[j->head_body], j->head));
        silent = j->kind == SPHERICAL_ANGLES && isnan(c[0]);
        says = joint_pose(j, silent ? nothing : c);
        wrong = tells_place(j) ? place_off(stands.r, says.r) : 0;
        if (!silent)
            wrong = worst(wrong, attitude_off(stands.q, says.q));
        if (!(wrong < NEAR))
            tell(m, "j%d is off by %.3g from where its bodies stand\n", i, wrong);
        off = worst(off, wrong);
    }
    return off;
}

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

static double off_bodies(Member *m, const Scene *s, const Pose *are, const Pose *belong)
{
    double off = 0;

    for (int i = 0; i < s->bodies; i++) {
        const double wrong =
            worst(place_off(are[i].r, belong[i].r), attitude_off(are[i].q, belong[i].q));

        if (!(wrong < NEAR))
            tell(m, "b%d is off by %.3g\n", i, wrong);
        off = worst(off, wrong);
    }
    return off;
}

/* assemble, and hold all that is reported against the scene */
static bool agrees(Member *m, Kit *kit, const Scene *s, const Told *told, const char *text)
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
    if (!(off < NEAR) || m->told)
        tell(m, "%s", text);
    return off < NEAR;
}

/* --- starts that are told --- */

/* one way of telling, in trees that are changed twice */
static bool start_agrees(Member *m, const Scene *s, int choice)
{
    static const Told nothing;
    static Scene out;
    Told told;
    Kit kit = kit_new();
    bool right;

    out.length = 0;
    write(&out, "%s", s->text);
    write_trees(m, s, choice, &out);
    tell_start(m, s, &told, &out);
    write(&out, "assemble\n");
    right = agrees(m, &kit, s, &told, out.text);
    out.length = 0;
    write_trees(m, s, pick(m, 4), &out);
    write(&out, "assemble\n");
    right = right && agrees(m, &kit, s, &told, out.text);
    out.length = 0;
    write(&out, "init none\n");
    write_trees(m, s, pick(m, 4), &out);
    write(&out, "assemble\n");
    right = right && (told.verbs > 0 || told.guessed || agrees(m, &kit, s, &nothing, out.text));
    kit_free(&kit);
    return right;
}

static Verdict told_member(Member *m)
{
    static Scene s;
    bool right = true;

    make_scene(m, &s, true, true);
    for (int choice = 0; choice < 3 && right; choice++)
        right = start_agrees(m, &s, choice);
    return right ? AGREES : DISAGREES;
}

static const Family families[] = {
    {"starts_are_the_ones_described", 60, 0, 0, told_member},
};

int main(int argc, char **argv)
{
    (void)test_faults;
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
