/* family_complement.c: the complement of the Jacobian, and the embedded equations
 *
 * Closed chains of three to five bodies of random data, in the plane by a revolute, in space by a
 * spherical joint, with springs and weights. At states of runs Phi_q G = 0, J maps the independent
 * speeds to the dependent ones, and the accelerations of the augmented equations satisfy G^T M q''
 * = G^T F. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof *(array)))

enum { MOST = 6 };

typedef struct Chain {
    bool planar;
    int bodies, count, constraints; /* count: of coordinates */
    char coordinate[2 * MOST][16];
} Chain;

static void write_point(Script *s, const Chain *c, const double *at)
{
    write_piece(s, c->planar ? "[%.17g, %.17g]" : "[%.17g, %.17g, %.17g]", at[0], at[1], at[2]);
}

static void write_arm(Script *s, const Chain *c, const char *name, const char *from,
                      const double *to, const double *at)
{
    const double way[3] = {to[0] - at[0], to[1] - at[1], to[2] - at[2]};

    write_piece(s, "arm %s %s ", name, from);
    write_point(s, c, way);
    write_line(s, "%s", "");
}

static void draw_point(Member *member, const Chain *c, double at[3])
{
    for (int k = 0; k < 3; k++)
        at[k] = c->planar && k == 2 ? 0 : member_between(member, -1, 1);
}

static void add_coordinate(Chain *c, const char *name, const char *suffix)
{
    (void)snprintf(c->coordinate[c->count++], sizeof c->coordinate[0], "%s%s", name, suffix);
}

static void write_joint(Member *member, Script *s, Chain *c, int number)
{
    static const char *const types[] = {"revolute", "revolute", "cylindrical", "universal"};
    const int kind = c->planar ? 0 : member_one_of(member, COUNT(types));
    char name[16];

    (void)snprintf(name, sizeof name, "h%d", number);
    write_piece(s, "%s %s p%d q%d", types[kind], name, number, number);
    if (c->planar)
        write_line(s, "%s", "");
    else if (kind == 3)
        write_line(s, " axes=[x, y]");
    else
        write_line(s, " axis=%c", "xyz"[(number + member_one_of(member, 2)) % 3]);
    if (kind < 2)
        add_coordinate(c, name, "");
    else if (kind == 2) {
        add_coordinate(c, name, ".s");
        add_coordinate(c, name, ".theta");
    } else {
        add_coordinate(c, name, ".a1");
        add_coordinate(c, name, ".a2");
    }
}

static void write_chain(Member *member, Script *s, Chain *c)
{
    double at[MOST][3], point[3];

    *c = (Chain){.planar = member_one_of(member, 2) == 0};
    c->bodies = 3 + member_one_of(member, 2) + !c->planar;
    c->constraints = c->planar ? 2 : 3;
    s->length = 0;
    write_line(s, c->planar ? "scene planar; gravity [0, -9.81]" : "gravity [0, 0, -9.81]");
    for (int i = 0; i < c->bodies; i++) {
        const double from[3] = {0};
        char name[16], joined[16], body[16], last[16];

        (void)snprintf(body, sizeof body, "m%d", i);
        (void)snprintf(last, sizeof last, i > 0 ? "m%d" : "ground", i - 1);
        (void)snprintf(name, sizeof name, "p%d", i);
        (void)snprintf(joined, sizeof joined, "q%d", i);
        draw_point(member, c, at[i]);
        draw_point(member, c, point);
        if (c->planar)
            write_line(s, "body %s mass=%.17g inertia=%.17g", body, member_between(member, 0.5, 2),
                       member_between(member, 0.1, 0.5));
        else
            write_line(s, "body %s mass=%.17g inertia=[%.17g, 0.25, 0.3]", body,
                       member_between(member, 0.5, 2), member_between(member, 0.2, 0.3));
        write_arm(s, c, name, last, point, i > 0 ? at[i - 1] : from);
        write_arm(s, c, joined, body, point, at[i]);
        write_joint(member, s, c, i);
    }
    draw_point(member, c, point);
    write_arm(s, c, "g", "ground", point, (const double[3]){0});
    write_arm(s, c, "e",
              c->planar        ? (c->bodies == 3 ? "m2" : "m3")
              : c->bodies == 4 ? "m3"
                               : "m4",
              point, at[c->bodies - 1]);
    write_line(s, "%s hc g e", c->planar ? "revolute" : "spherical");
    write_line(s, "spring k0 ground m1 k=%.17g length=0.3", member_between(member, 1, 20));
    write_piece(s, "tree");
    for (int i = 0; i < c->bodies; i++)
        write_piece(s, " h%d", i);
    write_line(s, "\nform embedded");
    for (int i = 0; i < 2; i++)
        write_line(s, "guess %s' = %.17g", c->coordinate[i], member_between(member, -1, 1));
}

static double entry(Kit *kit, const char *block, int row, int column)
{
    char text[64];

    (void)snprintf(text, sizeof text, column > 0 ? "%s(%d,%d)" : "%s(%d)", block, row, column);
    return kit_value(kit, text);
}

static double rate(Kit *kit, const Chain *c, int j, const char *primes)
{
    char text[32];

    (void)snprintf(text, sizeof text, "%s%s", c->coordinate[j], primes);
    return kit_value(kit, text);
}

/* the place of each row of G among the coordinates, as `show partition` lists them */
static bool read_partition(Kit *kit, const Chain *c, int *place)
{
    const char *at;
    int found = 0;

    if (kit_do(kit, "show partition\n") != CT_OK || kit->text == NULL)
        return false;
    for (at = kit->text; *at != '\0' && found < c->count;) {
        const size_t length = strcspn(at, " ,\n");

        for (int j = 0; j < c->count; j++)
            if (strlen(c->coordinate[j]) == length && strncmp(c->coordinate[j], at, length) == 0)
                place[found++] = j;
        at += length > 0 ? length : 1;
    }
    return found == c->count;
}

static Verdict compare(Member *member, Kit *kit, const Chain *c)
{
    const int f = c->count - c->constraints;
    int place[2 * MOST] = {0};
    double G[2 * MOST][2 * MOST] = {{0}};

    if (!read_partition(kit, c, place)) {
        tell(member, "%s", kit->text != NULL ? kit->text : kit->error.message);
        return DISAGREES;
    }
    for (int r = 0; r < c->count; r++) {
        double sum = 0, size = 1;

        for (int i = 0; i < f; i++) {
            G[r][i] = entry(kit, "complement", r + 1, i + 1);
            sum += G[r][i] * rate(kit, c, place[c->constraints + i], "'");
            size += fabs(G[r][i]);
        }
        if (!keeps(member, "q' = G q_i'", fabs(sum - rate(kit, c, place[r], "'")), 1e-7 * size))
            return DISAGREES;
    }
    for (int k = 1; k <= c->constraints; k++)
        for (int i = 0; i < f; i++) {
            double sum = 0, size = 0;

            for (int r = 0; r < c->count; r++) {
                const double term = entry(kit, "jacobian", k, place[r] + 1) * G[r][i];

                sum += term;
                size += fabs(term);
            }
            if (!keeps(member, "Phi_q G", fabs(sum), 1e-11 * (1 + size)))
                return DISAGREES;
        }
    for (int i = 1; i <= f; i++) {
        double sum = -entry(kit, "embedded_forces", i, 0), size = fabs(sum);

        for (int j = 0; j < c->count; j++) {
            const double term = entry(kit, "embedded_mass", i, j + 1) * rate(kit, c, j, "''");

            sum += term;
            size += fabs(term);
        }
        if (!keeps(member, "G^T M q'' - G^T F", fabs(sum), 1e-8 * (1 + size)))
            return DISAGREES;
    }
    if (kit_do(kit, "show complement\n") != CT_OK || kit->text == NULL ||
        strstr(kit->text, "Phi_q G = 0 at numbers") == NULL) {
        tell(member, "%s", kit->text != NULL ? kit->text : kit->error.message);
        return DISAGREES;
    }
    return AGREES;
}

/* the run is of augmented equations, what is shown of embedded ones */
static Verdict complement_member(Member *member)
{
    static Script script;
    Chain c;
    Kit kit = kit_new();
    Verdict verdict = REFUSED;

    write_chain(member, &script, &c);
    if (kit_do(&kit, script.text) == CT_OK &&
        kit_do(&kit, "form augmented\nsimulate 0.05 every=0.05 rtol=1e-10 atol=1e-12\n") == CT_OK)
        verdict = compare(member, &kit, &c);
    if (verdict != AGREES || member->told)
        tell(member, "%s%s\n", script.text, kit.error.message);
    kit_free(&kit);
    return verdict;
}

static const Family families[] = {
    {"G is the complement of the Jacobian, and accelerations satisfy the embedded equations", 24,
     0.2, 0, complement_member}};

int main(int argc, char **argv)
{
    return family_main(families, COUNT(families), argc, argv);
}
