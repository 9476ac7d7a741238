/* family_ports.c: random mechanisms cut at a frame, one side replaced by its Norton or Thevenin
 * equivalent, against the mechanism as a whole
 *
 * Two sides A and B meet at frame P: trees and loops with springs, motors and circuits, planar and
 * spatial. With F = F0 - L a of A and a = a0 + Y F of B the acceleration of P follows. The oracle
 * is the solver of runs: it has the whole mechanism; B alone with the force F and moment at P as
 * numbers; and A alone on a body P that is pushed to the acceleration a. All accelerations have to
 * agree. Between two frames P and Q a link A is replaced, and the accelerations of both are
 * compared. Formulas are printed as text and evaluated again as expressions of the whole mechanism.
 */
#include "../unit/session_kit.h"
#include "family.h"

enum { MOST = 12, ROOM = 6000, PARTS = 40 };

typedef struct Side {
    char text[ROOM], init[ROOM], names[ROOM];
    size_t length, init_length, names_length;
    char letter;
    int joints;
    char watched[PARTS][24]; /* accelerations that are compared */
    int watched_count;
} Side;

typedef struct Cut {
    bool planar;
    int count; /* components: 3 or 6 of each frame */
    Side a, b;
    Side c; /* of cuts at two frames: carries the second one */
    char scene[300];
} Cut;

typedef struct Relation {
    double constant[MOST], matrix[MOST][MOST];
} Relation;

static const char *const planar_names[] = {"ax", "ay", "alphaz"};
static const char *const spatial_names[] = {"ax", "ay", "az", "alphax", "alphay", "alphaz"};

#define PUT(side, list, ...)                                                                       \
    ((side)->list##_length += (size_t)snprintf((side)->list + (side)->list##_length,               \
                                               ROOM - (side)->list##_length, __VA_ARGS__))
#define text_length length

/* --- drawing --- */

static double u(Member *member, double low, double high)
{
    return member_between(member, low, high);
}

static void name_part(Side *s, const char *name)
{
    PUT(s, names, "%s%s", s->names_length > 0 ? ", " : "", name);
}

static void draw_body(Member *member, const Cut *cut, Side *s, int i)
{
    char name[24];

    if (cut->planar)
        PUT(s, text, "body %c%d mass=%.6g inertia=%.6g\narm %ct%d %c%d [%.6g, %.6g]\n", s->letter,
            i, u(member, 0.5, 2), u(member, 0.05, 0.3), s->letter, i, s->letter, i,
            u(member, -0.5, -0.2), u(member, -0.1, 0.1));
    else
        PUT(s, text,
            "body %c%d mass=%.6g inertia=[%.6g, %.6g, %.6g]\n"
            "arm %ct%d %c%d [%.6g, %.6g, %.6g]\n",
            s->letter, i, u(member, 0.5, 2), u(member, 0.2, 0.3), u(member, 0.2, 0.3),
            u(member, 0.2, 0.3), s->letter, i, s->letter, i, u(member, -0.5, -0.2),
            u(member, -0.1, 0.1), u(member, -0.1, 0.1));
    if (cut->planar)
        PUT(s, text, "arm %ch%d %c%d [%.6g, 0.05]\n", s->letter, i, s->letter, i,
            u(member, 0.2, 0.5));
    else
        PUT(s, text, "arm %ch%d %c%d [%.6g, 0.05, -0.04] rotation=x(%.6g)\n", s->letter, i,
            s->letter, i, u(member, 0.2, 0.5), u(member, -1, 1));
    (void)snprintf(name, sizeof name, "%c%d", s->letter, i);
    name_part(s, name);
}

static void watch(Side *s, const char *name)
{
    if (s->watched_count < PARTS)
        (void)snprintf(s->watched[s->watched_count++], sizeof s->watched[0], "%s", name);
}

/* a joint from a frame to the tail arm of body i; its coordinates start anywhere */
static void draw_joint(Member *member, const Cut *cut, Side *s, const char *tail, int i)
{
    static const char *const planar[] = {"revolute", "revolute", "prismatic", "planarjoint"};
    static const char *const spatial[] = {"revolute",    "revolute",  "prismatic",  "universal",
                                          "cylindrical", "spherical", "planarjoint"};
    static const char *const axes[] = {"x", "y", "z"};
    const char *type =
        cut->planar ? planar[member_one_of(member, 4)] : spatial[member_one_of(member, 7)];
    char name[24], watched[40];

    (void)snprintf(name, sizeof name, "%cj%d", s->letter, i);
    name_part(s, name);
    PUT(s, text, "%s %s %s %ct%d", type, name, tail, s->letter, i);
    if (strcmp(type, "prismatic") == 0)
        PUT(s, text, " axis=%s", cut->planar ? "x" : axes[member_one_of(member, 3)]);
    else if (!cut->planar && (strcmp(type, "revolute") == 0 || strcmp(type, "cylindrical") == 0))
        PUT(s, text, " axis=%s", axes[member_one_of(member, 3)]);
    PUT(s, text, "\n");
    if (strcmp(type, "revolute") == 0 || strcmp(type, "prismatic") == 0) {
        PUT(s, init, "init %s = %.6g, %s' = %.6g\n", name, u(member, -1, 1), name,
            u(member, -1, 1));
        (void)snprintf(watched, sizeof watched, "%s''", name);
        watch(s, watched);
        s->joints++;
        if (member_one_of(member, 3) == 0) {
            PUT(s, text, "spring %ck%d %s k=%.6g rest=0.1\n", s->letter, i, name, u(member, 1, 10));
            (void)snprintf(watched, sizeof watched, "%ck%d", s->letter, i);
            name_part(s, watched);
        }
        if (strcmp(type, "revolute") == 0 && member_one_of(member, 3) == 0) {
            const char inductance = member_one_of(member, 2) == 0;

            PUT(s, text,
                "resistor %cR%d %s %cn%d 2\nmotor %cM%d %s %cn%d 0 R=1 L=%s Kt=0.5 Kv=0.5\n",
                s->letter, i, "supply", s->letter, i, s->letter, i, name, s->letter, i,
                inductance ? "0.1" : "0");
            if (inductance)
                PUT(s, init, "init %cM%d.i = %.6g\n", s->letter, i, u(member, -2, 2));
            (void)snprintf(watched, sizeof watched, "%cR%d", s->letter, i);
            name_part(s, watched);
            (void)snprintf(watched, sizeof watched, "%cM%d", s->letter, i);
            name_part(s, watched);
        }
    } else if (strcmp(type, "universal") == 0) {
        PUT(s, init, "init %s.a1 = %.6g, %s.a2 = %.6g, %s.a1' = %.6g\n", name, u(member, -1, 1),
            name, u(member, -1, 1), name, u(member, -1, 1));
    } else if (strcmp(type, "cylindrical") == 0) {
        PUT(s, init, "init %s.theta = %.6g, %s.s = %.6g, %s.theta' = %.6g\n", name,
            u(member, -1, 1), name, u(member, -0.3, 0.3), name, u(member, -1, 1));
    } else if (strcmp(type, "planarjoint") == 0) {
        PUT(s, init, "init %s.s1 = %.6g, %s.s2 = %.6g, %s.theta = %.6g, %s.theta' = %.6g\n", name,
            u(member, -0.3, 0.3), name, u(member, -0.3, 0.3), name, u(member, -1, 1), name,
            u(member, -1, 1));
    }
    (void)snprintf(watched, sizeof watched, "%c%d.ax", s->letter, i);
    watch(s, watched);
    (void)snprintf(watched, sizeof watched, "%c%d.alphaz", s->letter, i);
    watch(s, watched);
}

/* Bodies from a frame on, each hung on one before it; perhaps a loop, or a spring to ground. */
static void draw_side(Member *member, const Cut *cut, Side *s, char letter, const char *root,
                      int most)
{
    const int bodies = 1 + member_one_of(member, most);
    char tail[24];

    memset(s, 0, sizeof *s);
    s->letter = letter;
    for (int i = 0; i < bodies; i++) {
        draw_body(member, cut, s, i);
        if (i == 0)
            (void)snprintf(tail, sizeof tail, "%s", root);
        else
            (void)snprintf(tail, sizeof tail, "%ch%d", letter, member_one_of(member, i));
        draw_joint(member, cut, s, tail, i);
    }
    if (member_one_of(member, 3) == 0) {
        PUT(s, text, "spring %cS %ch%d %cg k=5 length=0.2\ndamper %cD %ch%d %cg d=0.5\n", letter,
            letter, bodies - 1, letter, letter, letter, bodies - 1, letter);
        (void)snprintf(tail, sizeof tail, "%cS, %cD", letter, letter);
        name_part(s, tail);
    }
    if (member_one_of(member, 3) == 0 && most > 1) { /* two bodies more lead to ground */
        const char *joint = cut->planar ? "revolute" : "spherical";

        if (cut->planar)
            PUT(s, text,
                "body %c8 mass=0.4 inertia=0.02\nbody %c9 mass=0.3 inertia=0.03\n"
                "arm %ct8 %c8 [-0.9, 0]\narm %ch8 %c8 [0.9, 0]\narm %ct9 %c9 [-1, 0]\n"
                "arm %ch9 %c9 [1, 0]\n",
                letter, letter, letter, letter, letter, letter, letter, letter, letter, letter);
        else
            PUT(s, text,
                "body %c8 mass=0.4 inertia=[0.02, 0.03, 0.03]\n"
                "body %c9 mass=0.3 inertia=[0.02, 0.03, 0.04]\n"
                "arm %ct8 %c8 [-0.9, 0, 0.01]\narm %ch8 %c8 [0.9, 0.02, 0]\n"
                "arm %ct9 %c9 [-1, 0, 0]\narm %ch9 %c9 [1, 0, 0]\n",
                letter, letter, letter, letter, letter, letter, letter, letter, letter, letter);
        PUT(s, text, "%s %cj7 %ch%d %ct8\n%s %cj8 %ch8 %ct9\n%s %cj9 %cg %ch9\n", joint, letter,
            letter, bodies - 1, letter, joint, letter, letter, letter, joint, letter, letter,
            letter);
        (void)snprintf(tail, sizeof tail, "%c8, %c9, %cj7", letter, letter, letter);
        name_part(s, tail);
        (void)snprintf(tail, sizeof tail, "%cj8, %cj9", letter, letter);
        name_part(s, tail);
        (void)snprintf(tail, sizeof tail, "%c8.ay", letter);
        watch(s, tail);
    }
}

/* `brief`: one whose formulas are short enough to be printed */
static void draw_cut(Member *member, Cut *cut, bool brief)
{
    int most;

    cut->planar = member_one_of(member, 2) == 0;
    cut->count = cut->planar ? 3 : 6;
    (void)snprintf(cut->scene, sizeof cut->scene, "%s\nvsource E supply 0 %.6g\n%s",
                   cut->planar ? "scene planar\ngravity [0.3, -9.81]"
                               : "scene spatial\ngravity [0.3, 0.2, -9.81]",
                   u(member, -9, 9),
                   cut->planar ? "arm Bg ground [0.5, 0.7]\narm Ag ground [1.1, -0.8]\n"
                               : "arm Bg ground [0.5, 0.7, 0.2]\narm Ag ground [1.1, -0.8, 0.1]\n");
    most = !brief ? 3 : cut->planar ? 2 : 1;
    draw_side(member, cut, &cut->b, 'B', "ground", most);
    draw_side(member, cut, &cut->a, 'A', "P", most);
}

/* the frame at which they meet */
static void write_frame(const Cut *cut, char *out, size_t room)
{
    (void)snprintf(out, room,
                   cut->planar ? "arm P B0 [0.2, 0.3]\n"
                               : "arm P B0 [0.2, 0.3, 0.1] rotation=y(0.4)\n");
}

/* --- what is printed --- */

/* "F0(1) = 2;" "L(1,2) = 3;" */
static void read_relation(const char *text, Relation *out)
{
    memset(out, 0, sizeof *out);
    for (const char *line = text; *line != '\0';
         line += strcspn(line, "\n"), line += *line == '\n') {
        int i, j;
        double value;

        if (sscanf(line, "%*[FLYa0](%d,%d) = %lf", &i, &j, &value) == 3 && i <= MOST && j <= MOST)
            out->matrix[i - 1][j - 1] = value;
        else if (sscanf(line, "%*[Fa]0(%d) = %lf", &i, &value) == 2 && i <= MOST)
            out->constant[i - 1] = value;
    }
}

static bool ask(Member *member, Kit *kit, const char *topic, const char *frames, const char *of,
                Relation *out)
{
    char line[ROOM];

    (void)snprintf(line, sizeof line, "show %s %s%s%s as matlab at 0", topic, frames,
                   of[0] != '\0' ? " of " : "", of);
    if (kit_do(kit, line) != CT_OK) {
        tell(member, "%s\n%s\n", line, kit->error.message);
        return false;
    }
    read_relation(kit->text, out);
    if (member->told)
        tell(member, "%s\n%s", line, kit->text);
    return true;
}

/* m x = b by elimination with row pivots; b becomes x */
static void solve(int n, double m[MOST][MOST], double *b)
{
    for (int k = 0; k < n; k++) {
        int p = k;

        for (int i = k + 1; i < n; i++)
            p = fabs(m[i][k]) > fabs(m[p][k]) ? i : p;
        for (int j = 0; j < n; j++) {
            const double swapped = m[k][j];

            m[k][j] = m[p][j];
            m[p][j] = swapped;
        }
        {
            const double swapped = b[k];

            b[k] = b[p];
            b[p] = swapped;
        }
        for (int i = k + 1; i < n; i++) {
            const double factor = m[i][k] / m[k][k];

            for (int j = k; j < n; j++)
                m[i][j] -= factor * m[k][j];
            b[i] -= factor * b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++)
            b[i] -= m[i][j] * b[j];
        b[i] /= m[i][i];
    }
}

/* a = a0 + Y (F0 - L a), and F */
static void join(const Cut *cut, const Relation *norton, const Relation *thevenin, double *a,
                 double *force)
{
    double m[MOST][MOST];
    const int n = cut->count;

    for (int i = 0; i < n; i++) {
        a[i] = thevenin->constant[i];
        for (int j = 0; j < n; j++) {
            a[i] += thevenin->matrix[i][j] * norton->constant[j];
            m[i][j] = i == j;
            for (int k = 0; k < n; k++)
                m[i][j] += thevenin->matrix[i][k] * norton->matrix[k][j];
        }
    }
    solve(n, m, a);
    for (int i = 0; i < n; i++) {
        force[i] = norton->constant[i];
        for (int j = 0; j < n; j++)
            force[i] -= norton->matrix[i][j] * a[j];
    }
}

static const char *member_name(const Cut *cut, int i)
{
    return cut->planar ? planar_names[i] : spatial_names[i];
}

/* the largest acceleration, for the scale of a comparison */
static double read_watched(Kit *kit, const Side *s, double *out)
{
    double most = 1;

    for (int i = 0; i < s->watched_count; i++) {
        out[i] = kit_value(kit, s->watched[i]);
        most = fmax(most, fabs(out[i]));
    }
    return most;
}

static bool same_watched(Member *member, Kit *kit, const Side *s, const double *expected,
                         double scale)
{
    bool same = true;

    for (int i = 0; i < s->watched_count; i++) {
        const double got = kit_value(kit, s->watched[i]);

        if (!keeps(member, s->watched[i], fabs(got - expected[i]) / scale, 1e-10)) {
            tell(member, "%s: %.15g, whole %.15g\n", s->watched[i], got, expected[i]);
            same = false;
        }
    }
    return same;
}

/* --- each side alone --- */

static Kit wide_kit(void)
{
    const ct_hooks hooks = {.columns = 0};

    return (Kit){.session = ct_session_new(&hooks)};
}

/* Positions and speeds of a side as the whole has them, where a loop makes them dependent. */
static void copy_state(Kit *whole, const Cut *cut, const Side *s, char *out, size_t room)
{
    static const char *const spatial[] = {"x",  "y",  "z",  "q0", "q1", "q2", "q3",
                                          "vx", "vy", "vz", "wx", "wy", "wz"};
    static const char *const planar[] = {"x", "y", "theta"};
    size_t length = 0;

    (void)s;
    out[0] = '\0';
    for (int k = 0; k < (cut->planar ? 3 : 7); k++) {
        char name[24];

        (void)snprintf(name, sizeof name, "P.%s", cut->planar ? planar[k] : spatial[k]);
        length += (size_t)snprintf(out + length, room - length, "%s%s = %.17g",
                                   k > 0 ? ", " : "init ", name, kit_value(whole, name));
    }
    length += (size_t)snprintf(out + length, room - length, "\n");
    if (cut->planar)
        (void)snprintf(
            out + length, room - length, "init P.x' = %.17g, P.y' = %.17g, P.theta' = %.17g\n",
            kit_value(whole, "P.vx"), kit_value(whole, "P.vy"), kit_value(whole, "P.theta'"));
    else
        (void)snprintf(out + length, room - length,
                       "init P.x' = %.17g, P.y' = %.17g, P.z' = %.17g, P.Wx = %.17g, P.Wy = %.17g, "
                       "P.Wz = %.17g\n",
                       kit_value(whole, "P.vx"), kit_value(whole, "P.vy"), kit_value(whole, "P.vz"),
                       kit_value(whole, "P.Wx"), kit_value(whole, "P.Wy"),
                       kit_value(whole, "P.Wz"));
}

/* B with the force and moment of A at P */
static Verdict replaced_a(Member *member, const Cut *cut, const double *force,
                          const double *expected, double scale)
{
    Kit kit = wide_kit();
    char frame[200], push[400];
    Verdict verdict;

    write_frame(cut, frame, sizeof frame);
    if (cut->planar)
        (void)snprintf(push, sizeof push, "force Q P [%.17g, %.17g]\ntorque U P %.17g\n", force[0],
                       force[1], force[2]);
    else
        (void)snprintf(push, sizeof push,
                       "force Q P [%.17g, %.17g, %.17g]\ntorque U P [%.17g, %.17g, %.17g]\n",
                       force[0], force[1], force[2], force[3], force[4], force[5]);
    if (kit_do(&kit, cut->scene) != CT_OK || kit_do(&kit, cut->b.text) != CT_OK ||
        kit_do(&kit, frame) != CT_OK || kit_do(&kit, push) != CT_OK ||
        kit_do(&kit, cut->b.init) != CT_OK || isnan(kit_value(&kit, cut->b.watched[0]))) {
        tell(member, "B alone: %s\n", kit.error.message);
        verdict = REFUSED;
    } else {
        verdict = same_watched(member, &kit, &cut->b, expected, scale) ? AGREES : DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

/* A on a body P of mass 1 that is pushed so that its acceleration is a */
static Verdict replaced_b(Member *member, const Cut *cut, Kit *whole, const double *a,
                          const double *force, const double *expected, double scale)
{
    static char init[ROOM];
    static const double planar_weight[MOST] = {0.3, -9.81},
                        spatial_weight[MOST] = {0.3, 0.2, -9.81};
    const double *weight = cut->planar ? planar_weight : spatial_weight;
    Kit kit = wide_kit();
    char push[400];
    double w[MOST] = {0};
    Verdict verdict;

    for (int i = 0; i < cut->count; i++)
        w[i] = a[i] - weight[i] - force[i];
    if (cut->planar)
        (void)snprintf(push, sizeof push,
                       "body P mass=1 inertia=1\nforce Q P [%.17g, %.17g]\ntorque U P %.17g\n",
                       w[0], w[1], w[2]);
    else
        (void)snprintf(push, sizeof push,
                       "body P mass=1 inertia=[1, 1, 1]\nforce Q P [%.17g, %.17g, %.17g]\n"
                       "torque U P [%.17g, %.17g, %.17g]\n",
                       w[0], w[1], w[2], w[3], w[4], w[5]);
    copy_state(whole, cut, &cut->a, init, sizeof init);
    if (kit_do(&kit, cut->scene) != CT_OK || kit_do(&kit, push) != CT_OK ||
        kit_do(&kit, cut->a.text) != CT_OK || kit_do(&kit, init) != CT_OK ||
        kit_do(&kit, cut->a.init) != CT_OK || isnan(kit_value(&kit, cut->a.watched[0]))) {
        tell(member, "A alone: %s\n", kit.error.message);
        verdict = REFUSED;
    } else {
        verdict = same_watched(member, &kit, &cut->a, expected, scale) ? AGREES : DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

/* --- the law --- */

static bool build_whole(Member *member, const Cut *cut, Kit *kit)
{
    char frame[200];

    write_frame(cut, frame, sizeof frame);
    if (kit_do(kit, cut->scene) == CT_OK && kit_do(kit, cut->b.text) == CT_OK &&
        kit_do(kit, frame) == CT_OK && kit_do(kit, cut->a.text) == CT_OK &&
        kit_do(kit, cut->b.init) == CT_OK && kit_do(kit, cut->a.init) == CT_OK &&
        !isnan(kit_value(kit, "P.ax")))
        return true;
    tell(member, "%s\n", kit->error.message);
    return false;
}

static bool has_loop(const Side *s)
{
    return strstr(s->names, "j9") != NULL;
}

static Verdict cuts_agree(Member *member)
{
    static Cut cut;
    Kit whole = wide_kit();
    Relation norton, thevenin, all;
    double a[MOST] = {0}, force[MOST] = {0}, at_a[PARTS], at_b[PARTS], scale;
    Verdict verdict = REFUSED, one;
    bool same = true;

    draw_cut(member, &cut, false);
    if (!build_whole(member, &cut, &whole) ||
        !ask(member, &whole, "norton", "P", cut.a.names, &norton) ||
        !ask(member, &whole, "thevenin", "P", cut.b.names, &thevenin) ||
        !ask(member, &whole, "thevenin", "P", "", &all))
        goto done;
    join(&cut, &norton, &thevenin, a, force);
    scale = fmax(read_watched(&whole, &cut.a, at_a), read_watched(&whole, &cut.b, at_b));
    for (int i = 0; i < cut.count; i++) {
        char name[24];
        double expected;

        (void)snprintf(name, sizeof name, "P.%s", member_name(&cut, i));
        expected = kit_value(&whole, name);
        same = keeps(member, name, fabs(a[i] - expected) / scale, 1e-10) &&
               keeps(member, "of the whole", fabs(all.constant[i] - expected) / scale, 1e-10) &&
               same;
    }
    verdict = same ? AGREES : DISAGREES;
    /* a loop is assembled otherwise by a side alone */
    if (verdict == AGREES && !has_loop(&cut.a) && !has_loop(&cut.b)) {
        one = replaced_a(member, &cut, force, at_b, scale);
        verdict = one == DISAGREES ? DISAGREES : verdict;
    }
    if (verdict == AGREES && !has_loop(&cut.a) && !has_loop(&cut.b)) {
        one = replaced_b(member, &cut, &whole, a, force, at_a, scale);
        verdict = one == DISAGREES ? DISAGREES : verdict;
    }
done:
    if (verdict != AGREES || member->told)
        tell(member, "%s%sarm P ...\n%s%s%s\nof %s | %s\n", cut.scene, cut.b.text, cut.a.text,
             cut.b.init, cut.a.init, cut.a.names, cut.b.names);
    kit_free(&whole);
    return verdict;
}

/* --- cuts at two frames --- */

/* B carries frame P, C frame Q; two bodies A8 and A9 join them, perhaps with a spring */
static void draw_link(Member *member, Cut *cut)
{
    Side *a = &cut->a;
    const char *joint;

    cut->planar = member_one_of(member, 2) == 0;
    cut->count = cut->planar ? 6 : 12;
    joint = cut->planar ? "revolute" : "spherical";
    (void)snprintf(cut->scene, sizeof cut->scene, "%s\nvsource E supply 0 %.6g\n%s",
                   cut->planar ? "scene planar\ngravity [0.3, -9.81]"
                               : "scene spatial\ngravity [0.3, 0.2, -9.81]",
                   u(member, -9, 9),
                   cut->planar ? "arm Bg ground [0.5, 0.7]\narm Cg ground [1.1, -0.8]\n"
                               : "arm Bg ground [0.5, 0.7, 0.2]\narm Cg ground [1.1, -0.8, 0.1]\n");
    draw_side(member, cut, &cut->b, 'B', "ground", 2);
    draw_side(member, cut, &cut->c, 'C', "Cg", 2);
    memset(a, 0, sizeof *a);
    a->letter = 'A';
    PUT(a, text, "arm P B0 %s\narm Q C0 %s\n",
        cut->planar ? "[0.2, 0.3]" : "[0.2, 0.3, 0.1] rotation=y(0.4)",
        cut->planar ? "[0.1, -0.2]" : "[0.1, -0.2, 0.1] rotation=x(0.3)");
    for (int i = 8; i <= 9; i++) {
        PUT(a, text, "body A%d mass=%.6g ", i, u(member, 0.2, 0.9));
        if (cut->planar)
            PUT(a, text, "inertia=%.6g\narm At%d A%d [-0.9, 0.05]\narm Ah%d A%d [1, 0]\n",
                u(member, 0.02, 0.05), i, i, i, i);
        else
            PUT(a, text,
                "inertia=[0.02, 0.03, %.6g]\narm At%d A%d [-0.9, 0.05, 0.1]\n"
                "arm Ah%d A%d [1, 0, 0.02]\n",
                u(member, 0.02, 0.04), i, i, i, i);
    }
    PUT(a, text, "%s Aj7 P At8\n%s Aj8 Ah8 At9\n%s Aj9 Q Ah9\n", joint, joint, joint);
    name_part(a, "A8, A9, Aj7, Aj8, Aj9");
    if (member_one_of(member, 2) == 0) {
        PUT(a, text, "spring AS P Ah8 k=5 length=0.2\ndamper AD P Q d=0.5\n");
        name_part(a, "AS, AD");
    }
    if (cut->planar && member_one_of(member, 2) == 0) {
        PUT(a, text, "resistor AR supply An 2\nmotor AM Aj7 An 0 R=1 L=0 Kt=0.5 Kv=0.5\n");
        name_part(a, "AR, AM");
    }
}

static Verdict links_agree(Member *member)
{
    static Cut cut;
    static char others[2 * ROOM + 8];
    Kit whole = wide_kit();
    Relation norton, thevenin, all;
    double a[MOST] = {0}, force[MOST] = {0}, expected[MOST], scale = 1;
    Verdict verdict = REFUSED;
    bool same = true;
    int half;

    draw_link(member, &cut);
    half = cut.planar ? 3 : 6;
    (void)snprintf(others, sizeof others, "%s, %s", cut.b.names, cut.c.names);
    if (kit_do(&whole, cut.scene) != CT_OK || kit_do(&whole, cut.b.text) != CT_OK ||
        kit_do(&whole, cut.c.text) != CT_OK || kit_do(&whole, cut.a.text) != CT_OK ||
        kit_do(&whole, cut.b.init) != CT_OK || kit_do(&whole, cut.c.init) != CT_OK ||
        isnan(kit_value(&whole, "P.ax")) ||
        !ask(member, &whole, "norton", "P Q", cut.a.names, &norton) ||
        !ask(member, &whole, "thevenin", "P Q", others, &thevenin) ||
        !ask(member, &whole, "thevenin", "P Q", "", &all)) {
        tell(member, "%s\n", whole.error.message);
        goto done;
    }
    join(&cut, &norton, &thevenin, a, force);
    for (int i = 0; i < cut.count; i++) {
        char name[40];

        (void)snprintf(name, sizeof name, "%c.%s", i < half ? 'P' : 'Q',
                       member_name(&cut, i % half));
        expected[i] = kit_value(&whole, name);
        scale = fmax(scale, fabs(expected[i]));
    }
    for (int i = 0; i < cut.count; i++) {
        same = keeps(member, "joined", fabs(a[i] - expected[i]) / scale, 1e-10) && same;
        same = keeps(member, "of the whole", fabs(all.constant[i] - expected[i]) / scale, 1e-10) &&
               same;
    }
    verdict = same ? AGREES : DISAGREES;
done:
    if (verdict != AGREES || member->told)
        tell(member, "%s%s%s%s%s%s\nof %s | %s\n", cut.scene, cut.b.text, cut.c.text, cut.a.text,
             cut.b.init, cut.c.init, cut.a.names, others);
    kit_free(&whole);
    return verdict;
}

/* each printed formula, evaluated as an expression of the whole mechanism */
static Verdict formulas_agree(Member *member, Kit *kit, const char *topic, const char *of)
{
    static char line[ROOM], formula[200000];
    Relation numbers;
    char *text;
    bool same = true;
    double scale = 1;

    if (!ask(member, kit, topic, "P", of, &numbers))
        return REFUSED;
    (void)snprintf(line, sizeof line, "show %s P%s%s", topic, of[0] != '\0' ? " of " : "", of);
    if (kit_do(kit, line) != CT_OK) {
        tell(member, "%s: %s\n", line, kit->error.message);
        return DISAGREES;
    }
    if (strstr(kit->text, "where ") != NULL)
        return REFUSED;
    for (int i = 0; i < MOST; i++) {
        scale = fmax(scale, fabs(numbers.constant[i]));
        for (int j = 0; j < MOST; j++)
            scale = fmax(scale, fabs(numbers.matrix[i][j]));
    }
    text = kit->text;
    kit->text = NULL;
    for (char *rest = NULL, *at = strtok_r(text, "\n", &rest); at != NULL && same;
         at = strtok_r(NULL, "\n", &rest)) {
        const char *right = strstr(at, " = ");
        int i, j;
        double expected, got;

        if (right == NULL || strchr(at, ':') != NULL)
            continue;
        if (sscanf(at, "%*[FLYa0](%d,%d) =", &i, &j) == 2)
            expected = numbers.matrix[i - 1][j - 1];
        else if (sscanf(at, "%*[Fa]0(%d) =", &i) == 1)
            expected = numbers.constant[i - 1];
        else
            continue;
        (void)snprintf(formula, sizeof formula, "%s", right + 3);
        got = kit_value(kit, formula);
        if (isnan(got))
            tell(member, "%s: %s\n", at, kit->error.message);
        same = keeps(member, "formula", fabs(got - expected) / scale, 1e-9);
        if (!same)
            tell(member, "%s\n%.15g, in numbers %.15g\n", at, got, expected);
    }
    ct_free(text);
    return same ? AGREES : DISAGREES;
}

static Verdict formulas_and_numbers_agree(Member *member)
{
    static Cut cut;
    Kit whole = wide_kit();
    Verdict verdict = REFUSED, dual;

    draw_cut(member, &cut, true);
    if (build_whole(member, &cut, &whole)) {
        verdict = formulas_agree(member, &whole, "norton", cut.a.names);
        dual = formulas_agree(member, &whole, "thevenin", cut.b.names);
        verdict = verdict == DISAGREES || dual == DISAGREES ? DISAGREES
                  : verdict == AGREES || dual == AGREES     ? AGREES
                                                            : REFUSED;
    }
    if (verdict != AGREES || member->told)
        tell(member, "%s%sarm P ...\n%s%s%s\nof %s | %s\n", cut.scene, cut.b.text, cut.a.text,
             cut.b.init, cut.a.init, cut.a.names, cut.b.names);
    kit_free(&whole);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"cuts_agree", 40, 0.1, 0, cuts_agree},
        {"links_agree", 15, 0.2, 0, links_agree},
        {"formulas_and_numbers_agree", 6, 0.1, 0, formulas_and_numbers_agree},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}
