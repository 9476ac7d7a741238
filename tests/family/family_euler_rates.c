/* family_euler_rates.c: Euler parameters and their rates that are given are a motion, in any tree
 *
 * A body turns in a joint with Euler parameters, in the ground or on another such body. Random unit
 * quaternions q, of either sign, and angular velocities w are given as q and q' = 1/2 q (0, W), W
 * in axes of the tip (Hamilton's product), by init or guess, before or after trees are chosen, in a
 * subsystem, saved, undone, or by an event. The oracle multiplies quaternions by itself: attitude
 * and angular velocity of each body, and the rates printed beside the parameters, have to be those.
 * A body whose moments of inertia are equal, held at its centre, goes on turning as it did. */
#include "family.h"

#include "../unit/session_kit.h"

#include "base/memory.h"
#include "base/text.h"

typedef struct Quaternion {
    double at[4]; /* scalar first */
} Quaternion;

static Quaternion product(Quaternion a, Quaternion b)
{
    const double *p = a.at, *q = b.at;

    return (Quaternion){{p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
                         p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
                         p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
                         p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]}};
}

static Quaternion conjugate(Quaternion q)
{
    return (Quaternion){{q.at[0], -q.at[1], -q.at[2], -q.at[3]}};
}

static Quaternion turn_about(int axis, double angle)
{
    Quaternion q = {{cos(angle / 2), 0, 0, 0}};

    q.at[1 + axis] = sin(angle / 2);
    return q;
}

/* v to the axes in which q has its tail */
static void turned(Quaternion q, const double v[3], double out[3])
{
    const Quaternion w = product(product(q, (Quaternion){{0, v[0], v[1], v[2]}}), conjugate(q));

    for (int k = 0; k < 3; k++)
        out[k] = w.at[1 + k];
}

/* of a body: in its joint, and in the ground */
typedef struct Turning {
    Quaternion arm, back; /* rotations of the arms that the joint ties, tail and tip */
    Quaternion q, rate;   /* given of the joint */
    double own[3];        /* rad/s, of the tip against the tail, axes of the tip's arm */
    Quaternion attitude;  /* of the body, against the ground */
    double w[3];          /* rad/s, against the ground, its axes */
} Turning;

typedef struct Machine {
    Member *member;
    Turning bodies[2];
    int count;
    bool is_held_at_centre, is_in_use;
    const char *given[2]; /* init or guess, of attitudes */
    int tree;
} Machine;

static Quaternion any_quaternion(Member *member)
{
    Quaternion q;
    double square = 0;

    for (int k = 0; k < 4; k++) {
        q.at[k] = member_between(member, -1, 1);
        square += q.at[k] * q.at[k];
    }
    if (square < 0.01)
        q = (Quaternion){{square = 1, 0, 0, 0}};
    for (int k = 0; k < 4; k++)
        q.at[k] /= sqrt(square);
    return q;
}

/* a motion in the joint, and what it makes of the body on a tail that turns so */
static void draw_motion(Member *member, Turning *t, Quaternion tail, const double tail_w[3])
{
    const Quaternion at_tip = t->q = any_quaternion(member);
    double w[3], back[3];

    for (int k = 0; k < 3; k++)
        t->own[k] = member_between(member, -2, 2);
    t->rate = product(t->q, (Quaternion){{0, t->own[0], t->own[1], t->own[2]}});
    for (int k = 0; k < 4; k++)
        t->rate.at[k] /= 2;
    t->attitude = product(product(product(tail, t->arm), at_tip), conjugate(t->back));
    turned(product(product(tail, t->arm), at_tip), t->own, w);
    turned(tail, tail_w, back);
    for (int k = 0; k < 3; k++)
        w[k] += back[k];
    turned(conjugate(t->attitude), w, t->w);
}

static void draw_motions(Machine *m)
{
    Quaternion tail = {{1, 0, 0, 0}};
    double w[3] = {0};

    for (int i = 0; i < m->count; i++) {
        draw_motion(m->member, &m->bodies[i], tail, w);
        tail = m->bodies[i].attitude;
        memcpy(w, m->bodies[i].w, sizeof w);
    }
}

static Quaternion add_arm(Machine *m, Text *text, const char *name, const char *on, bool at_centre)
{
    static const char letters[] = "xyz";
    const int first = member_one_of(m->member, 3), second = (first + 1) % 3;
    const double a = member_between(m->member, -3, 3), b = member_between(m->member, -3, 3);
    double p[3];

    for (int k = 0; k < 3; k++)
        p[k] = at_centre ? 0 : member_between(m->member, -0.5, 0.5);
    text_addf(text, "arm %s %s [%.17g, %.17g, %.17g] rotation=%c(%.17g)*%c(%.17g)\n", name, on,
              p[0], p[1], p[2], letters[first], a, letters[second], b);
    return product(turn_about(first, a), turn_about(second, b));
}

static const char *prefix(const Machine *m)
{
    return m->is_in_use ? "u." : "";
}

static void add_parts(Machine *m, Text *text)
{
    m->count = 1 + member_one_of(m->member, 2);
    m->is_held_at_centre = m->count == 1 && member_one_of(m->member, 2) == 0;
    m->is_in_use = member_one_of(m->member, 3) == 0;
    if (m->is_in_use)
        text_add(text, "subsystem s\n");
    for (int i = 0; i < m->count; i++) {
        char tail[16], name[16];

        text_addf(text, "body m%d mass=1 inertia=%s\n", i,
                  m->is_held_at_centre ? "[0.4, 0.4, 0.4]" : "[0.3, 0.4, 0.5]");
        (void)snprintf(tail, sizeof tail, i == 0 ? "ground" : "m%d", i - 1);
        (void)snprintf(name, sizeof name, "a%d", i);
        m->bodies[i].arm = add_arm(m, text, name, tail, false);
        (void)snprintf(tail, sizeof tail, "m%d", i);
        (void)snprintf(name, sizeof name, "b%d", i);
        m->bodies[i].back = add_arm(m, text, name, tail, m->is_held_at_centre);
        text_addf(text, "%s j%d a%d b%d\n",
                  !m->is_held_at_centre && member_one_of(m->member, 3) == 0 ? "free" : "spherical",
                  i, i, i);
    }
    if (m->is_in_use)
        text_add(text, "end\nuse s u\n");
}

static void add_tree(const Machine *m, Text *text, int tree)
{
    const char *kinds[2] = {"rotation", "translation"};

    if (tree < 2) {
        text_addf(text, "tree %s\n", tree == 0 ? "joint" : "absolute");
        return;
    }
    for (int k = 0; k < 2; k++) {
        text_addf(text, "tree %s", kinds[k]);
        for (int i = 0; i < m->count; i++)
            text_addf(text, " %s%c%d", prefix(m), (tree + k) % 2 == 0 ? 'j' : 'm', i);
        text_char(text, '\n');
    }
}

static void add_values(const Machine *m, Text *text, bool rates)
{
    for (int i = 0; i < m->count; i++)
        for (int k = 0; k < 4; k++)
            text_addf(text, "%s%sj%d.q%d%s = %.17g", i + k > 0 ? ", " : "", prefix(m), i, k,
                      rates ? "'" : "", rates ? m->bodies[i].rate.at[k] : m->bodies[i].q.at[k]);
}

static void add_start(Machine *m, Text *text)
{
    const bool guesses = member_one_of(m->member, 3) == 0;

    text_add(text, guesses ? "guess " : "init ");
    add_values(m, text, false);
    text_add(text, "\ninit ");
    add_values(m, text, true);
    text_char(text, '\n');
}

static double value_of(const Machine *m, Kit *kit, int body, const char *what, const char *at)
{
    Text name = {0};
    double value;

    text_addf(&name, "%s%s%s%s", prefix(m),
              what[0] == 'q' ? "j0."
              : body == 0    ? "m0."
                             : "m1.",
              what, at);
    if (what[0] == 'q' && body == 1)
        name.at[strlen(prefix(m)) + 1] = '1';
    value = kit_value(kit, name.at);
    text_free(&name);
    return value;
}

/* parameters and rates of a joint are one motion, whatever their sign; so are attitude and speed */
static bool is_as_drawn(const Machine *m, Kit *kit, const char *at, double bound)
{
    static const char *const q_names[] = {"q0", "q1", "q2", "q3"};
    static const char *const rate_names[] = {"q0'", "q1'", "q2'", "q3'"};
    static const char *const w_names[] = {"Wx", "Wy", "Wz"};
    bool agrees = true;

    for (int i = 0; i < m->count; i++) {
        const Turning *t = &m->bodies[i];
        Quaternion q, rate, own;
        double along = 0, off = 0;

        for (int k = 0; k < 4; k++) {
            q.at[k] = value_of(m, kit, i, q_names[k], at);
            rate.at[k] = value_of(m, kit, i, rate_names[k], at);
            along += q.at[k] * t->q.at[k];
        }
        own = product(conjugate(q), rate);
        for (int k = 0; k < 3; k++) {
            off = fmax(off, fabs(value_of(m, kit, i, w_names[k], at) - t->w[k]));
            off = fmax(off, fabs(2 * own.at[1 + k] - t->own[k]));
        }
        agrees = keeps(m->member, "attitude", fabs(fabs(along) - 1), bound) && agrees;
        agrees = keeps(m->member, "angular velocity", isnan(off) ? INFINITY : off, bound) && agrees;
    }
    return agrees;
}

static bool do_all(const Machine *m, Kit *kit, const char *text)
{
    tell(m->member, "%s", text);
    if (kit_do(kit, text) == CT_OK)
        return true;
    tell(m->member, "%s\n", kit->error.message);
    return false;
}

/* what must not matter */
static bool go_around(Machine *m, Kit *kit)
{
    Text text = {0};
    bool done = true;

    switch (member_one_of(m->member, 4)) {
    case 0: {
        char *saved = ct_save(kit->session);

        kit_free(kit);
        *kit = kit_new();
        done = do_all(m, kit, saved);
        ct_free(saved);
        break;
    }
    case 1:
        text_addf(&text, "init %sm0.vx = 3\nundo\nundo\nredo\n", prefix(m));
        done = do_all(m, kit, text.at);
        break;
    case 2:
        add_tree(m, &text, member_one_of(m->member, 4));
        text_add(&text, "assemble\n");
        add_tree(m, &text, member_one_of(m->member, 4));
        done = do_all(m, kit, text.at);
        break;
    default:
        break;
    }
    text_free(&text);
    return done;
}

static Verdict given_motions_start(Member *member)
{
    Machine m = {.member = member, .tree = member_one_of(member, 4)};
    const bool trees_first = member_one_of(member, 2) == 0;
    Kit kit = kit_new();
    Text text = {0};
    bool agrees;

    add_parts(&m, &text);
    draw_motions(&m);
    if (trees_first)
        add_tree(&m, &text, m.tree);
    add_start(&m, &text);
    if (!trees_first)
        add_tree(&m, &text, m.tree);
    agrees = do_all(&m, &kit, text.at) && go_around(&m, &kit) && is_as_drawn(&m, &kit, "", 1e-8);
    if (agrees && m.is_held_at_centre)
        agrees = do_all(&m, &kit, "simulate 1 rtol=1e-10 atol=1e-12\n") &&
                 is_as_drawn(&m, &kit, " at 0", 1e-8);
    for (int k = 0; agrees && m.is_held_at_centre && k < 3; k++) {
        static const char *const names[] = {"Wx", "Wy", "Wz"};

        agrees = keeps(member, "later",
                       fabs(value_of(&m, &kit, 0, names[k], " at 1") - m.bodies[0].w[k]), 1e-6);
    }
    text_free(&text);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

/* the same motion set in the middle of a run */
static Verdict events_set_motions(Member *member)
{
    Machine m = {.member = member, .tree = member_one_of(member, 4)};
    Kit kit = kit_new();
    Text text = {0};
    bool agrees;

    do {
        text_free(&text);
        add_parts(&m, &text);
    } while (!m.is_held_at_centre);
    draw_motions(&m);
    add_tree(&m, &text, m.tree);
    add_start(&m, &text);
    draw_motions(&m);
    text_add(&text, "event e when=t > 0.5 ");
    add_values(&m, &text, false);
    text_add(&text, ", ");
    add_values(&m, &text, true);
    text_add(&text, "\nsimulate 0.5 every=0.5 rtol=1e-10 atol=1e-12\nresume 1e-6\n");
    agrees = do_all(&m, &kit, text.at) && is_as_drawn(&m, &kit, "", 1e-4);
    text_free(&text);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

static const Family families[] = {
    {"Euler parameters and rates that are given start that motion", 24, 0, 0, given_motions_start},
    {"Euler parameters and rates that an event sets start that motion", 8, 0, 0,
     events_set_motions},
};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
