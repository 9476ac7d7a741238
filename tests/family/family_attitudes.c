/* family_attitudes.c: three angles of a spherical joint that is a chord or a branch
 *
 * Between turned frames of ground and of a body, R = G R1(a1) R2(a2) R3(a3) P^T is the body's
 * attitude. Products of elementary rotations formed here are held against the body's Euler
 * parameters, and R^T R' by differences against its angular velocity: of angles and rates as given,
 * and of those that are read. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

static const char *const sequences[] = {"zxz", "zyz", "xyx", "xzx", "yxy", "yzy",
                                        "xyz", "xzy", "yxz", "yzx", "zxy", "zyx"};

typedef struct Attitude {
    const char *axes;
    char arm[2];     /* axes about which the frames are turned, */
    double angle[2]; /* and how far, rad */
} Attitude;

static void turn(char axis, double angle, double R[9])
{
    const int i = axis - 'x', j = (i + 1) % 3, k = (i + 2) % 3;

    memset(R, 0, 9 * sizeof *R);
    R[4 * i] = 1;
    R[4 * j] = R[4 * k] = cos(angle);
    R[3 * k + j] = sin(angle);
    R[3 * j + k] = -sin(angle);
}

/* R = R S, or R S^T */
static void then(double R[9], const double S[9], bool transposed)
{
    double out[9] = {0};

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                out[3 * i + j] += R[3 * i + k] * (transposed ? S[3 * j + k] : S[3 * k + j]);
    memcpy(R, out, sizeof out);
}

static void attitude(const Attitude *of, const double a[3], double R[9])
{
    double S[9];

    turn(of->arm[0], of->angle[0], R);
    for (int i = 0; i < 3; i++) {
        turn(of->axes[i], a[i], S);
        then(R, S, false);
    }
    turn(of->arm[1], of->angle[1], S);
    then(R, S, true);
}

/* w of R^T R' = w x, by differences along the rates */
static void velocity(const Attitude *of, const double a[3], const double rate[3], double w[3])
{
    const double h = 1e-5;
    double R[9], S[9] = {0}, ahead[3], behind[3], Ra[9], Rb[9];

    for (int i = 0; i < 3; i++) {
        ahead[i] = a[i] + h * rate[i];
        behind[i] = a[i] - h * rate[i];
    }
    attitude(of, a, R);
    attitude(of, ahead, Ra);
    attitude(of, behind, Rb);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                S[3 * i + j] += R[3 * k + i] * (Ra[3 * k + j] - Rb[3 * k + j]) / (2 * h);
    w[0] = S[7];
    w[1] = S[2];
    w[2] = S[3];
}

static double parameters_off(const double R[9], const double p[4])
{
    const double S[9] = {1 - 2 * (p[2] * p[2] + p[3] * p[3]), 2 * (p[1] * p[2] - p[0] * p[3]),
                         2 * (p[1] * p[3] + p[0] * p[2]),     2 * (p[1] * p[2] + p[0] * p[3]),
                         1 - 2 * (p[1] * p[1] + p[3] * p[3]), 2 * (p[2] * p[3] - p[0] * p[1]),
                         2 * (p[1] * p[3] - p[0] * p[2]),     2 * (p[2] * p[3] + p[0] * p[1]),
                         1 - 2 * (p[1] * p[1] + p[2] * p[2])};
    double off = 0;

    for (int i = 0; i < 9; i++)
        off = fabs(R[i] - S[i]) <= off ? off : fabs(R[i] - S[i]);
    return off;
}

static void read_three(Kit *kit, const char *const names[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = kit_value(kit, names[i]);
}

static double velocity_off(const double a[3], const double b[3])
{
    double off = 0;

    for (int i = 0; i < 3; i++)
        off = fabs(a[i] - b[i]) <= off ? off : fabs(a[i] - b[i]);
    return off;
}

static bool agree(Member *m, Kit *kit, const Attitude *of, const double a[3], const double rate[3],
                  const char *what)
{
    static const char *const parameters[] = {"m1.q0", "m1.q1", "m1.q2", "m1.q3"};
    static const char *const speeds[] = {"m1.Wx", "m1.Wy", "m1.Wz"};
    double R[9], p[4], w[3], wanted[3];

    for (int i = 0; i < 4; i++)
        p[i] = kit_value(kit, parameters[i]);
    read_three(kit, speeds, w);
    attitude(of, a, R);
    velocity(of, a, rate, wanted);
    tell(m, "%s\n", what);
    return keeps(m, "attitude", parameters_off(R, p), 1e-8) &&
           keeps(m, "angular velocity", velocity_off(w, wanted), 1e-6);
}

static Verdict angles_are_read_and_given(Member *m)
{
    static const char *const angles[] = {"h1.a1", "h1.a2", "h1.a3"};
    static const char *const rates[] = {"h1.a1'", "h1.a2'", "h1.a3'"};
    Attitude of = {.axes = sequences[member_one_of(m, 12)]};
    double a[3], rate[3], got[3], got_rate[3], measure;
    Script s = {.length = 0};
    Verdict verdict = DISAGREES;
    Kit kit;

    for (int i = 0; i < 3; i++) {
        a[i] = member_between(m, -3, 3);
        rate[i] = member_between(m, -2, 2);
    }
    measure = fabs(of.axes[0] == of.axes[2] ? sin(a[1]) : cos(a[1]));
    if (measure < 0.05)
        a[1] = 0.7;
    for (int i = 0; i < 2; i++) {
        of.arm[i] = "xyz"[member_one_of(m, 3)];
        of.angle[i] = member_between(m, -3, 3);
    }
    write_line(&s, "body m1 mass=1 inertia=[0.1, 0.2, 0.25]");
    write_line(&s, "arm g ground [0, 0, 0] rotation=%c(%.17g)", of.arm[0], of.angle[0]);
    write_line(&s, "arm p m1 [0.1, 0, 0] rotation=%c(%.17g)", of.arm[1], of.angle[1]);
    write_line(&s, "spherical h1 g p euler=%s", of.axes);
    write_line(&s, member_one_of(m, 3) == 0 ? "tree joint" : "tree absolute");
    for (int i = 0; i < 3; i++)
        write_line(&s, "init h1.a%d = %.17g, h1.a%d' = %.17g", i + 1, a[i], i + 1, rate[i]);
    tell(m, "%s", s.text);
    kit = kit_new();
    if (kit_do(&kit, s.text) != CT_OK)
        goto done;
    read_three(&kit, angles, got);
    read_three(&kit, rates, got_rate);
    if (!agree(m, &kit, &of, a, rate, "as given") || !agree(m, &kit, &of, got, got_rate, "as read"))
        goto done;
    if (kit_do(&kit, "simulate 0.3 rtol=1e-9 atol=1e-11\n") != CT_OK) {
        /* a branch that came to a critical angle */
        verdict = REFUSED;
        goto done;
    }
    read_three(&kit, angles, got);
    read_three(&kit, rates, got_rate);
    measure = fabs(of.axes[0] == of.axes[2] ? sin(got[1]) : cos(got[1]));
    if (measure > 0.02 && !agree(m, &kit, &of, got, got_rate, "at the end"))
        goto done;
    verdict = AGREES;
done:
    if (verdict != AGREES)
        tell(m, "%s\n", kit.error.message);
    kit_free(&kit);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"three angles of a chord are read and given", 120, 0.1, 0, angles_are_read_and_given}};

    return family_main(families, sizeof families / sizeof *families, argc, argv);
}
