/* family_rounding.c: mass matrices of spatial chains with turned arms, of all scales
 *
 * Bodies hang on hinges between frames turned by decimal angles. M_ij = sum over bodies of m
 * Jv_i.Jv_j
 * + Jw_i.I Jw_j, with Jw_i the axis and Jv_i = axis x (way from the hinge to the mass centre), is
 * formed here in numbers and held against entries that are printed: relative to sqrt(M_ii M_jj), so
 * that what a body of 1e-15 kg at the end of a chain of 1 kg adds is there. Of chains of one scale
 * no decimal of a formula may be rounding of 0. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

enum { BODIES = 3, TURNS = 2 };

typedef struct Frame {
    double p[3], R[9];
} Frame;

typedef struct Arm {
    double at[3];
    char axis[TURNS];
    double angle[TURNS];
    int turns;
} Arm;

typedef struct OrientationClass {
    int count;
    double mass[BODIES], inertia[BODIES][3], q[BODIES];
    double axis[BODIES][3];
    Arm near[BODIES], far[BODIES];
} OrientationClass;

/* --- in numbers --- */

static void turn_about(const double u[3], double angle, double R[9])
{
    const double size = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    const double n[3] = {u[0] / size, u[1] / size, u[2] / size}, c = cos(angle), s = sin(angle);
    const double K[9] = {0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0};

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            R[3 * i + j] = (i == j ? c : 0) + (1 - c) * n[i] * n[j] + s * K[3 * i + j];
}

static void times(double R[9], const double S[9], bool transposed)
{
    double out[9] = {0};

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                out[3 * i + j] += R[3 * i + k] * (transposed ? S[3 * j + k] : S[3 * k + j]);
    memcpy(R, out, sizeof out);
}

static void apply(const double R[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = R[3 * i] * v[0] + R[3 * i + 1] * v[1] + R[3 * i + 2] * v[2];
}

static void arm_rotation(const Arm *arm, double R[9])
{
    double S[9], u[3];

    turn_about((double[]){1, 0, 0}, 0, R);
    for (int k = 0; k < arm->turns; k++) {
        for (int i = 0; i < 3; i++)
            u[i] = arm->axis[k] == "xyz"[i];
        turn_about(u, arm->angle[k], S);
        times(R, S, false);
    }
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void mass_matrix(const OrientationClass *chain, double M[BODIES][BODIES])
{
    Frame frame = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    double axis[BODIES][3], hinge[BODIES][3], S[9], way[3];

    memset(M, 0, sizeof(double) * BODIES * BODIES);
    for (int b = 0; b < chain->count; b++) {
        double x[3], size = 0, jv[BODIES][3], jw[BODIES][3];

        apply(frame.R, chain->axis[b], axis[b]);
        for (int i = 0; i < 3; i++)
            size += axis[b][i] * axis[b][i];
        for (int i = 0; i < 3; i++)
            axis[b][i] /= sqrt(size);
        memcpy(hinge[b], frame.p, sizeof hinge[b]);
        turn_about(chain->axis[b], chain->q[b], S);
        times(frame.R, S, false);
        arm_rotation(&chain->near[b], S);
        times(frame.R, S, true);
        apply(frame.R, chain->near[b].at, way);
        for (int i = 0; i < 3; i++)
            x[i] = frame.p[i] - way[i];
        for (int j = 0; j <= b; j++) {
            for (int i = 0; i < 3; i++)
                way[i] = x[i] - hinge[j][i];
            cross(axis[j], way, jv[j]);
            for (int i = 0; i < 3; i++) /* in the body's axes */
                jw[j][i] = frame.R[i] * axis[j][0] + frame.R[3 + i] * axis[j][1] +
                           frame.R[6 + i] * axis[j][2];
        }
        for (int j = 0; j <= b; j++)
            for (int k = 0; k <= b; k++)
                for (int i = 0; i < 3; i++)
                    M[j][k] += chain->mass[b] * jv[j][i] * jv[k][i] +
                               chain->inertia[b][i] * jw[j][i] * jw[k][i];
        apply(frame.R, chain->far[b].at, way);
        for (int i = 0; i < 3; i++)
            frame.p[i] = x[i] + way[i];
        arm_rotation(&chain->far[b], S);
        times(frame.R, S, false);
    }
}

/* --- a member --- */

static double rounded(double value, int digits)
{
    char text[40];

    (void)snprintf(text, sizeof text, "%.*g", digits, value);
    return strtod(text, NULL);
}

static Arm draw_arm(Member *m, double length)
{
    Arm arm = {.turns = member_one_of(m, TURNS + 1)};

    for (int i = 0; i < 3; i++)
        arm.at[i] = member_one_of(m, 3) == 0 ? 0 : rounded(length * member_between(m, -1, 1), 2);
    for (int k = 0; k < arm.turns; k++) {
        arm.axis[k] = "xyz"[member_one_of(m, 3)];
        arm.angle[k] = rounded(member_between(m, -3, 3), 3);
    }
    return arm;
}

static OrientationClass draw(Member *m, bool scaled)
{
    static const double axes[][3] = {{0, 0, 1}, {1, 0, 0},     {0, 1, 0},
                                     {1, 1, 0}, {0, 0.6, 0.8}, {1, 2, 3}};
    OrientationClass chain = {.count = 1 + member_one_of(m, BODIES)};

    for (int b = 0; b < chain.count; b++) {
        const double length = scaled ? member_decades(m, 1e-6, 10) : 1;
        const bool is_round = member_one_of(m, 2) == 0;

        chain.mass[b] =
            rounded(scaled ? member_decades(m, 1e-15, 1e3) : member_between(m, 0.5, 2), 2);
        for (int i = 0; i < 3; i++)
            chain.inertia[b][i] =
                i > 0 && is_round
                    ? chain.inertia[b][0]
                    : rounded(chain.mass[b] * length * length * member_between(m, 0.3, 0.5), 2);
        memcpy(chain.axis[b], axes[member_one_of(m, 6)], sizeof chain.axis[b]);
        chain.near[b] = draw_arm(m, length);
        chain.far[b] = draw_arm(m, length);
        chain.q[b] = rounded(member_between(m, -3, 3), 3);
    }
    return chain;
}

static void write_arm(Script *s, const char *name, int body, const Arm *arm)
{
    write_piece(s, "arm %s%d b%d [%.10g, %.10g, %.10g]", name, body, body, arm->at[0], arm->at[1],
                arm->at[2]);
    for (int k = 0; k < arm->turns; k++)
        write_piece(s, "%s%c(%.10g)", k == 0 ? " rotation=" : "*", arm->axis[k], arm->angle[k]);
    write_line(s, "%s", "");
}

static void write_chain(const OrientationClass *chain, Script *s)
{
    for (int b = 0; b < chain->count; b++) {
        write_line(s, "body b%d mass=%.10g inertia=[%.10g, %.10g, %.10g]", b, chain->mass[b],
                   chain->inertia[b][0], chain->inertia[b][1], chain->inertia[b][2]);
        write_arm(s, "n", b, &chain->near[b]);
        write_arm(s, "f", b, &chain->far[b]);
        write_piece(s, "revolute h%d ", b);
        if (b == 0)
            write_piece(s, "ground");
        else
            write_piece(s, "f%d", b - 1);
        write_line(s, " n%d axis=[%g, %g, %g]", b, chain->axis[b][0], chain->axis[b][1],
                   chain->axis[b][2]);
        write_line(s, "init h%d = %.10g", b, chain->q[b]);
    }
    write_line(s, "tree joint");
}

static bool entries_agree(Member *m, Kit *kit, const OrientationClass *chain)
{
    double M[BODIES][BODIES], off = 0;
    char name[40];

    mass_matrix(chain, M);
    for (int i = 0; i < chain->count; i++)
        for (int j = 0; j < chain->count; j++) {
            double missed;

            (void)snprintf(name, sizeof name, "mass(%d,%d)", i + 1, j + 1);
            missed = fabs(kit_value(kit, name) - M[i][j]) / sqrt(M[i][i] * M[j][j]);
            off = missed <= off ? off : missed;
        }
    return keeps(m, "M", off, 1e-8); /* ways are differences of positions here */
}

static Verdict small_terms_stay(Member *m)
{
    const OrientationClass chain = draw(m, true);
    Script s = {.length = 0};
    Kit kit = kit_new();
    bool agrees;

    write_chain(&chain, &s);
    tell(m, "%s", s.text);
    agrees = kit_do(&kit, s.text) == CT_OK && entries_agree(m, &kit, &chain);
    kit_free(&kit);
    return agrees ? AGREES : DISAGREES;
}

/* decimals in a text, and those that are far below all that a chain of one scale has */
static void count_decimals(const char *text, int *all, int *tiny)
{
    while (*text != '\0') {
        char *end;
        double value;

        if (*text < '0' || *text > '9') {
            text++;
            continue;
        }
        value = strtod(text, &end);
        *all += value != floor(value);
        *tiny += value != 0 && fabs(value) < 1e-14;
        text = end;
    }
}

static Verdict rounding_vanishes(Member *m)
{
    const OrientationClass chain = draw(m, false);
    Script s = {.length = 0};
    Kit kit = kit_new();
    Verdict verdict = DISAGREES;
    int all = 0, tiny = 0;

    write_chain(&chain, &s);
    tell(m, "%s", s.text);
    if (kit_do(&kit, s.text) == CT_OK && entries_agree(m, &kit, &chain) &&
        kit_do(&kit, "show mass\n") == CT_OK) {
        count_decimals(kit.text, &all, &tiny);
        if (tiny > 0)
            tell(m, "%d of %d decimals\n%.4000s\n", tiny, all, kit.text);
        verdict = tiny == 0 ? AGREES : DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"what is small in a mass matrix stays", 60, 0, 0, small_terms_stay},
        /* sums that were formed of sums don't know how large their parts were */
        {"rounding in a mass matrix vanishes", 60, 0, 0.05, rounding_vanishes}};

    return family_main(families, sizeof families / sizeof *families, argc, argv);
}
