/* family_stays.c: what an event leaves that sets a position, in whatever trees
 *
 * Random scenes of scenes.h, with loops or without, move slowly when an event sets a coordinate of
 * a joint. By the rates of all joints that loops allow, from differences of jointed.h, that decides
 * on all positions if the others, but those in proportion to it, have one freedom less without it:
 * then they stay. If not, the event is refused, in all trees. Rates stay likewise. Planar chains
 * that float go as a rigid body does. */
#include "moving.h"

#define BEFORE 1e-6 /* s: in which a scene moves by about as much, */
#define STILL  1e-4 /* so that this tells whether something has stayed */
#define ALIKE  1e-6 /* m, rad, m/s, rad/s: two trees */
#define STEP   1e-5 /* of differences */

enum { RATES = JOINTS * MOST_COORDINATES, ROWS = 6 * LOOPS + RATES, TREE_CHOICES = 3 };

/* --- what loops allow --- */

/* one rate: that of a coordinate, or a component of an angular speed */
typedef struct Rate {
    int joint, coordinate; /* -1: of what is loose, about axis */
    int axis;
} Rate;

static int list_rates(const Scene *s, Rate *rates)
{
    int count = 0;

    for (int i = 0; i < s->joints; i++) {
        const Joint *j = &s->joint[i];
        bool loose = false;

        for (int k = 0; k < j->count; k++)
            if (is_lifted(j, k))
                loose = true;
            else
                rates[count++] = (Rate){i, k, 0};
        for (int axis = 0; axis < 3 && loose; axis++)
            rates[count++] = (Rate){i, -1, axis};
    }
    return count;
}

/* How far each loop is open, 3 shifts and 3 turns, after a rate has gone on for a moment. */
static void open_loops(const Scene *s, const Rate *rate, double moment, double *out)
{
    Speeds speeds[JOINTS] = {0};
    Pose bodies[BODIES] = {0};

    if (rate->coordinate >= 0)
        speeds[rate->joint].rate[rate->coordinate] = 1;
    else
        speeds[rate->joint].W[rate->axis] = 1;
    go_on(s, speeds, moment, bodies);
    for (int i = s->bodies; i < s->joints; i++) {
        const Joint *j = &s->joint[i];
        const Pose tail = compose(j->tail_body < 0 ? here : bodies[j->tail_body], j->tail);
        const Pose head = compose(j->head_body < 0 ? here : bodies[j->head_body], j->head);
        const double *W = speeds[i].W, size = sqrt(W[0] * W[0] + W[1] * W[1] + W[2] * W[2]);
        double c[MOST_COORDINATES] = {0};
        Pose way, off;

        for (int k = 0; k < j->count; k++)
            c[k] = j->c[k] + moment * speeds[i].rate[k];
        way = joint_pose(j, c);
        if (size > 0)
            way = compose(way,
                          turned((double[]){W[0] / size, W[1] / size, W[2] / size}, moment * size));
        off = compose(inverse(way), compose(inverse(tail), head));
        for (int k = 0; k < 3; k++) {
            *out++ = tells_place(j) ? off.r[k] : 0;
            *out++ = 2 * off.q[k + 1] * (off.q[0] < 0 ? -1 : 1);
        }
    }
}

/* Rank by Gaussian elimination with full pivoting of rows of size 1; -1: it can't be determined. */
static int rank_of(const double (*rows)[RATES], int count, int columns)
{
    static double a[ROWS][RATES];
    int rank = 0;

    for (int r = 0; r < count; r++) {
        double size = 0;

        for (int c = 0; c < columns; c++)
            size += rows[r][c] * rows[r][c];
        for (int c = 0; c < columns; c++)
            a[r][c] = size > 1e-12 ? rows[r][c] / sqrt(size) : 0;
    }
    for (; rank < count && rank < columns; rank++) {
        double most = 0;
        int row = rank, column = rank;

        for (int r = rank; r < count; r++)
            for (int c = rank; c < columns; c++)
                if (fabs(a[r][c]) > most) {
                    most = fabs(a[r][c]);
                    row = r;
                    column = c;
                }
        if (most < 1e-3)
            return most < 1e-7 ? rank : -1;
        for (int c = 0; c < columns; c++) {
            const double swapped = a[row][c];

            a[row][c] = a[rank][c];
            a[rank][c] = swapped;
        }
        for (int r = 0; r < count; r++) {
            const double swapped = a[r][column];

            a[r][column] = a[r][rank];
            a[r][rank] = swapped;
        }
        for (int r = rank + 1; r < count; r++) {
            const double factor = a[r][rank] / a[rank][rank];

            for (int c = rank; c < columns; c++)
                a[r][c] -= factor * a[rank][c];
        }
    }
    return rank;
}

typedef struct Freedom {
    Rate rates[RATES];
    int count, loops;
    double rows[ROWS][RATES]; /* of the loops first */
} Freedom;

static void find_freedom(const Scene *s, Freedom *f)
{
    f->count = list_rates(s, f->rates);
    f->loops = 6 * (s->joints - s->bodies);
    for (int c = 0; c < f->count; c++) {
        double low[6 * LOOPS], high[6 * LOOPS];

        open_loops(s, &f->rates[c], -STEP, low);
        open_loops(s, &f->rates[c], STEP, high);
        for (int r = 0; r < f->loops; r++)
            f->rows[r][c] = (high[r] - low[r]) / (2 * STEP);
    }
}

/* Rank of the loops and of those rates that are taken. */
static int rank_with(Freedom *f, const bool *taken)
{
    int count = f->loops;

    for (int i = 0; i < f->count; i++)
        if (taken[i]) {
            memset(f->rows[count], 0, sizeof f->rows[count]);
            f->rows[count++][i] = 1;
        }
    return rank_of((const double(*)[RATES])f->rows, count, f->count);
}

typedef enum Foretold { DECIDES, IS_REFUSED, UNSURE } Foretold;

/* Whether rate number `set` decides; goes: those that go in proportion to it, a loose attitude as a
 * whole. */
static Foretold foretell(Freedom *f, int set, bool *goes)
{
    bool taken[RATES] = {false}, rest[RATES] = {false};
    const int held = rank_with(f, taken);
    int with, all, others;
    bool sure = held >= 0;

    taken[set] = true;
    with = rank_with(f, taken);
    for (int i = 0; i < f->count; i++) {
        int both, alone;

        taken[i] = true;
        both = rank_with(f, taken);
        taken[i] = i == set;
        taken[set] = false;
        taken[i] = true;
        alone = rank_with(f, taken);
        taken[i] = false;
        taken[set] = true;
        goes[i] = both == with && alone > held;
        rest[i] = !goes[i];
        sure = sure && both >= 0 && alone >= 0;
    }
    /* what doesn't move at all, about an axis of what is loose, goes with the other two */
    for (int i = 0; i < f->count; i++)
        for (int k = 0; k < f->count && f->rates[i].coordinate < 0; k++)
            if (f->rates[k].joint == f->rates[i].joint && f->rates[k].coordinate < 0 && !goes[k]) {
                bool alone[RATES] = {false};

                alone[k] = true;
                rest[i] = rest[i] || rank_with(f, alone) > held;
            }
    for (int i = 0; i < f->count; i++)
        goes[i] = goes[i] && !rest[i];
    others = rank_with(f, rest);
    for (int i = 0; i < f->count; i++)
        rest[i] = true;
    all = rank_with(f, rest);
    if (!sure || with < 0 || others < 0 || all < 0)
        return UNSURE;
    return with > held && others == all - 1 ? DECIDES : IS_REFUSED;
}

/* --- cotree --- */

typedef struct Behind { /* the event */
    bool sound, is_open;
    Pose bodies[BODIES];
    double speeds[BODIES][6];
} Behind;

static bool run(Member *m, const Scene *s, int choice, const Speeds *speeds, const char *event,
                Behind *out)
{
    static Scene text;
    Kit kit = kit_new();

    memset(out, 0, sizeof *out);
    text.length = 0;
    write(&text, "%s", s->text);
    write_trees(m, s, choice, &text);
    report_poses(s, &text);
    for (int i = 0; i < s->joints; i++)
        if (speeds[i].told)
            report_speeds(&s->joint[i], i, &speeds[i], &text);
    if (kit_do(&kit, text.text) != CT_OK || kit_do(&kit, "assemble") != CT_OK) {
        kit_free(&kit);
        return false;
    }
    text.length = 0;
    write(&text, "%s\nsimulate %.17g every=%.17g rtol=1e-10 atol=1e-12\n", event, 2 * BEFORE,
          BEFORE);
    out->sound = kit_do(&kit, text.text) == CT_OK;
    if (!out->sound) {
        tell(m, "%s\n", kit.error.message);
        out->is_open = strstr(kit.error.message, "doesn't determine where") != NULL;
    }
    for (int i = 0; i < s->bodies && out->sound; i++) {
        out->bodies[i] = read_body(&kit, s, i);
        read_speeds(&kit, s, i, out->speeds[i]);
    }
    kit_free(&kit);
    return true;
}

static double difference(const Scene *s, const Behind *a, const Behind *b)
{
    double off = 0;

    for (int i = 0; i < s->bodies; i++) {
        off = worst(off, place_off(a->bodies[i].r, b->bodies[i].r));
        off = worst(off, attitude_off(a->bodies[i].q, b->bodies[i].q));
        for (int k = 0; k < 6; k++)
            off = worst(off, fabs(a->speeds[i][k] - b->speeds[i][k]));
    }
    return off;
}

/* --- joints --- */

/* How far a joint is from where its coordinates have it, of which number `set` alone may be other
 * than before (-1: none). */
static double joint_off(const Scene *s, int number, const Behind *behind, const double *c)
{
    const Joint *j = &s->joint[number];
    const Pose tail = compose(j->tail_body < 0 ? here : behind->bodies[j->tail_body], j->tail);
    const Pose head = compose(j->head_body < 0 ? here : behind->bodies[j->head_body], j->head);
    const Pose is = compose(inverse(tail), head), belongs = joint_pose(j, c);

    return worst(tells_place(j) ? place_off(is.r, belongs.r) : 0, attitude_off(is.q, belongs.q));
}

/* Joints none of whose coordinates go have stayed, and the one that was set is where it was put. */
static bool has_stayed(Member *m, const Scene *s, const Freedom *f, const bool *goes, int set,
                       double value, const Behind *behind)
{
    bool all = true;

    for (int i = 0; i < s->joints; i++) {
        double c[MOST_COORDINATES], off;
        bool stays = true, knows = true;

        memcpy(c, s->joint[i].c, sizeof c);
        for (int k = 0; k < f->count; k++)
            if (f->rates[k].joint == i && goes[k]) {
                stays = false;
                knows = knows && k == set;
                if (k == set)
                    c[f->rates[k].coordinate] = value;
            }
        if (!stays && !knows)
            continue;
        off = joint_off(s, i, behind, c);
        if (!(off < STILL))
            tell(m, "j%d is off by %.3g\n", i, off);
        all = all && off < STILL;
    }
    return all;
}

static Verdict joints(Member *m, int extent)
{
    static Scene s;
    static Freedom f;
    bool goes[RATES] = {false};
    Speeds speeds[JOINTS] = {0};
    Behind first, other;
    Foretold foretold;
    char event[120];
    double value;
    int set, told;
    const Joint *j;

    make_scene(m, &s, extent);
    find_freedom(&s, &f);
    set = pick(m, f.count > 0 ? f.count : 1);
    if (f.count == 0 || f.rates[set].coordinate < 0)
        return REFUSED;
    told = pick(m, s.joints);
    draw_speeds(m, &s.joint[told], &speeds[told]);
    j = &s.joint[f.rates[set].joint];
    value = j->c[f.rates[set].coordinate] + between(m, -0.2, 0.2);
    (void)snprintf(event, sizeof event, "event e when=t>%.17g j%d%s=%.17g", BEFORE,
                   f.rates[set].joint, coordinate_name(j, f.rates[set].coordinate), value);
    tell(m, "%s%s\n", s.text, event);
    foretold = foretell(&f, set, goes);
    if (!run(m, &s, 0, speeds, event, &first) || foretold == UNSURE)
        return REFUSED;
    if (foretold == IS_REFUSED && first.sound)
        return tell(m, "not refused\n"), DISAGREES;
    if (foretold == DECIDES && first.is_open)
        return tell(m, "refused as open\n"), DISAGREES;
    if (first.sound && !has_stayed(m, &s, &f, goes, set, value, &first))
        return DISAGREES;
    for (int choice = 1; choice < TREE_CHOICES; choice++) {
        double off;

        if (!run(m, &s, choice, speeds, event, &other))
            return REFUSED;
        off = first.sound && other.sound ? difference(&s, &first, &other) : 0;
        if (first.sound != other.sound || first.is_open != other.is_open || !(off < ALIKE))
            return tell(m, "tree %d is other by %.3g\n", choice, off), DISAGREES;
    }
    return first.sound || foretold == IS_REFUSED ? AGREES : REFUSED;
}

static Verdict open_member(Member *m)
{
    return joints(m, TREES);
}

static Verdict loops_member(Member *m)
{
    return joints(m, WITH_LOOPS);
}

/* --- chains that float, in a plane --- */

enum { LINKS = 5 };

typedef struct Floating {
    int bodies;
    double tail[LINKS][2], head[LINKS][2]; /* of joint i, in body i and in body i + 1 */
    double angle[LINKS], rate[LINKS];      /* of joint i */
} Floating;

typedef struct Flat { /* x, y, theta, and their rates */
    double at[3], rate[3];
} Flat;

/* from a body to the next one (by 1) or the one before it (by -1) */
static Flat next_body(const Floating *f, int body, int by, const Flat *from)
{
    const int joint = by > 0 ? body : body - 1;
    const double *near = by > 0 ? f->tail[joint] : f->head[joint];
    const double *far = by > 0 ? f->head[joint] : f->tail[joint];
    Flat to = *from;
    double arm[2];

    to.at[2] += by * f->angle[joint];
    to.rate[2] += by * f->rate[joint];
    for (int end = 0; end < 2; end++) {
        const Flat *turns = end == 0 ? from : &to;
        const double *p = end == 0 ? near : far;
        const double c = cos(turns->at[2]), sine = sin(turns->at[2]), sign = end == 0 ? 1 : -1;

        arm[0] = sign * (c * p[0] - sine * p[1]);
        arm[1] = sign * (sine * p[0] + c * p[1]);
        to.at[0] += arm[0];
        to.at[1] += arm[1];
        to.rate[0] -= turns->rate[2] * arm[1];
        to.rate[1] += turns->rate[2] * arm[0];
    }
    return to;
}

static void place_floating(const Floating *f, int known, const Flat *from, Flat *out)
{
    out[known] = *from;
    for (int i = known; i + 1 < f->bodies; i++)
        out[i + 1] = next_body(f, i, 1, &out[i]);
    for (int i = known; i > 0; i--)
        out[i - 1] = next_body(f, i, -1, &out[i]);
}

static void write_floating(Member *m, const Floating *f, const Flat *bodies, Scene *out)
{
    write(out, "scene planar\n");
    for (int i = 0; i < f->bodies; i++)
        write(out, "body b%d mass=%.3g inertia=%.3g\n", i, between(m, 1, 3), between(m, 0.1, 1));
    for (int i = 0; i + 1 < f->bodies; i++)
        write(out,
              "arm t%d b%d [%.17g, %.17g]\narm h%d b%d [%.17g, %.17g]\nrevolute j%d t%d h%d\n"
              "init j%d = %.17g, j%d' = %.17g\n",
              i, i, f->tail[i][0], f->tail[i][1], i, i + 1, f->head[i][0], f->head[i][1], i, i, i,
              i, f->angle[i], i, f->rate[i]);
    write(out, "init b0.x = %.17g, b0.y = %.17g, b0.theta = %.17g\n", bodies[0].at[0],
          bodies[0].at[1], bodies[0].at[2]);
    write(out, "init b0.x' = %.17g, b0.y' = %.17g, b0.theta' = %.17g\n", bodies[0].rate[0],
          bodies[0].rate[1], bodies[0].rate[2]);
}

/* along the joints from any body, or of bodies, each half of its own */
static void write_floating_trees(Member *m, const Floating *f, Scene *out)
{
    for (int half = 0; half < 2; half++) {
        const int base = pick(m, f->bodies), alone = pick(m, 2);

        write(out, "tree %s b%d", half == 0 ? "translation" : "rotation", base);
        for (int i = 0; i < f->bodies; i++)
            if (i != base)
                write(out, alone ? " b%d" : " j%d", alone ? i : i > base ? i - 1 : i);
        write(out, "\n");
    }
}

/* Sets a body's place, its angle or both, or a joint, alone or with a body that stays; whether that
 * decides on all. */
static bool write_floating_event(Member *m, Floating *f, int named, Flat *from, Scene *out)
{
    const int kind = pick(m, 4), joint = pick(m, f->bodies - 1);

    write(out, "event e when=t>%.17g", BEFORE);
    for (int k = 0; k < 2 && kind < 2; k++)
        if (kind == 0 || pick(m, 2)) {
            from->at[k] = between(m, -3, 3);
            write(out, " b%d.%c=%.17g", named, 'x' + k, from->at[k]);
        }
    if (kind == 1) {
        from->at[2] += between(m, -4, 4);
        write(out, " b%d.theta=%.17g", named, from->at[2]);
    }
    if (kind < 2)
        return true;
    f->angle[joint] += between(m, -2, 2);
    write(out, " j%d=%.17g", joint, f->angle[joint]);
    if (kind == 3)
        write(out, " b%d.x=b%d.x b%d.y=b%d.y b%d.theta=b%d.theta", named, named, named, named,
              named, named);
    return kind == 3;
}

static Verdict floating_member(Member *m)
{
    static const char *const members[] = {"x", "y", "theta"};
    static Scene out;
    Floating f = {.bodies = 2 + pick(m, LINKS - 1)};
    Flat bodies[LINKS], from = {{0}, {0}};
    Kit kit = kit_new();
    bool decides, sound;
    double off = 0;
    const int named = pick(m, f.bodies);

    for (int i = 0; i + 1 < f.bodies; i++) {
        for (int k = 0; k < 2; k++) {
            f.tail[i][k] = between(m, -1, 1);
            f.head[i][k] = between(m, -1, 1);
        }
        f.angle[i] = between(m, -3, 3);
        f.rate[i] = between(m, -1, 1);
    }
    for (int k = 0; k < 3; k++) {
        from.at[k] = between(m, -1, 1);
        from.rate[k] = between(m, -1, 1);
    }
    place_floating(&f, 0, &from, bodies);
    out.length = 0;
    write_floating(m, &f, bodies, &out);
    write_floating_trees(m, &f, &out);
    from = bodies[named];
    decides = write_floating_event(m, &f, named, &from, &out);
    place_floating(&f, named, &from, bodies);
    write(&out, "\nsimulate %.17g every=%.17g\n", 2 * BEFORE, BEFORE);
    tell(m, "%s", out.text);
    sound = kit_do(&kit, out.text) == CT_OK;
    tell(m, "%s\n", sound ? "" : kit.error.message);
    if (!sound)
        decides = decides || strstr(kit.error.message, "doesn't determine where") == NULL;
    for (int i = 0; i < f.bodies && sound; i++)
        for (int k = 0; k < 3; k++) {
            char name[40];
            double turns;

            (void)snprintf(name, sizeof name, "b%d.%s", i, members[k]);
            off = kit_value(&kit, name) - bodies[i].at[k];
            turns = k == 2 ? 2 * M_PI * round(off / (2 * M_PI)) : 0;
            decides = decides && keeps(m, name, fabs(off - turns), STILL);
            (void)snprintf(name, sizeof name, "b%d.%s'", i, members[k]);
            off = kit_value(&kit, name) - bodies[i].rate[k];
            decides = decides && keeps(m, name, fabs(off), STILL);
        }
    kit_free(&kit);
    return sound == decides ? AGREES : DISAGREES;
}

static const Family families[] = {
    {"an_event_moves_floating_chains_as_a_whole", 60, 0, 0, floating_member},
    {"an_event_leaves_joints_of_open_chains_as_they_are", 30, 0.5, 0, open_member},
    {"an_event_moves_of_loops_what_it_decides_on_or_is_refused", 60, 0.7, 0, loops_member},
};

int main(int argc, char **argv)
{
    (void)test_faults;
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
