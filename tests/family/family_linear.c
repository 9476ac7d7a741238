/* family_linear.c: poles, zeros and responses of linear systems whose parts differ by many decades
 *
 * Matrices are made from eigenvalues that are small whole numbers, by whole numbers and powers of 2
 * alone, so that they are exact; chains of two neighbours each are counted through by Sturm's
 * sequence in numbers of more digits; circuits and chains of masses have closed forms. Pairs of
 * matrices L L^T and L D L^T of whole numbers have the eigenvalues D, to the last digit. What is
 * reported must lie within the error that is reported with it, one for one, a stable pole must not
 * be on the wrong side without a mark, and the errors must be of use. */
#include "../unit/session_kit.h"
#include "family.h"

#include "algebra/modal.h"
#include "algebra/spectrum.h"
#include "base/text.h"
#include "simulate/analyse/transfer.h"

#include <math.h>

enum { MOST = 12, MOST_ROOTS = 128 };

#define VAGUE 0.01 /* errors from here on, relative, are of little use */

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Real;
#else
typedef long double Real;
#endif

static int whole(Member *member, int low, int high)
{
    return low + (int)(test_random(&member->random) % (uint64_t)(high - low + 1));
}

/* a power of 10 within some decades about 1 */
static double decades(Member *member, double span)
{
    return pow(10, test_uniform(&member->random, -span, span));
}

static double power_of_2(Member *member, int span)
{
    return ldexp(1, whole(member, -span, span));
}

/* --- verdicts --- */

typedef struct Known {
    double real, imaginary;
} Known;

static double apart(const Root *root, const Known *known)
{
    return hypot(root->real - known->real, root->imaginary - known->imaginary);
}

/* Each known one has a root within whose error it is: by augmenting paths. */
static bool give(const Root *root, const Known *known, int n, int k, int *owner, bool *tried)
{
    for (int i = 0; i < n; i++) {
        if (tried[i] || !(apart(&root[i], &known[k]) <=
                          root[i].error * 1.01 + 4e-16 * hypot(known[k].real, known[k].imaginary)))
            continue;
        tried[i] = true;
        if (owner[i] < 0 || give(root, known, n, owner[i], owner, tried)) {
            owner[i] = k;
            return true;
        }
    }
    return false;
}

static bool match(const Root *root, const Known *known, int n)
{
    int owner[MOST_ROOTS];

    for (int i = 0; i < n; i++)
        owner[i] = -1;
    for (int k = 0; k < n; k++) {
        bool tried[MOST_ROOTS] = {false};

        if (!give(root, known, n, k, owner, tried))
            return false;
    }
    return true;
}

static void report_roots(Member *member, const char *what, const Root *root, const Known *known,
                         int n)
{
    tell(member, "%s\n", what);
    for (int i = 0; i < n; i++)
        tell(member, "  %.17g %+.17gi, error %.3g%s    known %.17g %+.17gi\n", root[i].real,
             root[i].imaginary, root[i].error, root_is_doubtful(&root[i]) ? " ?" : "",
             known[i].real, known[i].imaginary);
}

/* a mark where no real part is 0, or an error that tells little */
static bool is_undecided(const Root *root, const Known *known, int n)
{
    int marks = 0;
    bool is_vague = false;

    for (int i = 0; i < n; i++) {
        marks += root_is_doubtful(&root[i]) - (known[i].real == 0);
        is_vague = is_vague || (!root_is_doubtful(&root[i]) &&
                                root[i].error > VAGUE * hypot(root[i].real, root[i].imaginary));
    }
    return marks > 0 || is_vague;
}

/* none on the other side than any is, marked ones apart */
static bool sides_hold(const Root *root, const Known *known, int n)
{
    int right = 0, left = 0, claimed_right = 0, claimed_left = 0;

    for (int i = 0; i < n; i++) {
        right += known[i].real > 0;
        left += known[i].real < 0;
        claimed_right += root[i].real > 0;
        claimed_left += root[i].real < 0;
    }
    return claimed_right <= right && claimed_left <= left;
}

static Verdict judge(Member *member, const char *what, const Root *root, const Known *known, int n)
{
    report_roots(member, what, root, known, n);
    if (!match(root, known, n) || !sides_hold(root, known, n))
        return DISAGREES;
    return is_undecided(root, known, n) ? REFUSED : AGREES;
}

static Verdict judge_matrix(Member *member, const double *a, const double *error,
                            const Known *known, int n)
{
    Spectrum *spectrum = spectrum_new(a, error, n);
    Verdict verdict;

    if (spectrum == NULL) {
        tell(member, "not found\n");
        return DISAGREES;
    }
    verdict = judge(member, "eigenvalues", spectrum_roots(spectrum), known, n);
    spectrum_free(spectrum);
    return verdict;
}

/* --- whole numbers --- */

static void shuffle(Member *member, int *order, int n)
{
    for (int i = 0; i < n; i++)
        order[i] = i;
    for (int i = n - 1; i > 0; i--) {
        const int k = whole(member, 0, i), kept = order[i];

        order[i] = order[k];
        order[k] = kept;
    }
}

/* a := T a T^-1, b := T b, c := c T^-1 with T = 1 + f e_i e_j^T; whole numbers stay whole */
static void shear(double *a, double *b, double *c, int n, int i, int j, double f)
{
    for (int k = 0; k < n; k++)
        a[i * n + k] += f * a[j * n + k];
    for (int k = 0; k < n; k++)
        a[k * n + j] -= f * a[k * n + i];
    if (b != NULL) {
        b[i] += f * b[j];
        c[j] -= f * c[i];
    }
}

/* rows and columns in another order and other units */
static void rescale(Member *member, double *a, double *b, double *c, int n, int span)
{
    double scale[MOST], old[MOST * MOST], old_b[MOST], old_c[MOST];
    int order[MOST];

    shuffle(member, order, n);
    for (int i = 0; i < n; i++)
        scale[i] = power_of_2(member, span);
    memcpy(old, a, (size_t)(n * n) * sizeof *a);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            a[i * n + j] = old[order[i] * n + order[j]] * scale[i] / scale[j];
    if (b == NULL)
        return;
    memcpy(old_b, b, (size_t)n * sizeof *b);
    memcpy(old_c, c, (size_t)n * sizeof *c);
    for (int i = 0; i < n; i++) {
        b[i] = old_b[order[i]] * scale[i];
        c[i] = old_c[order[i]] / scale[i];
    }
}

/* Eigenvalues: whole numbers, pairs, and ones that come several times with one vector. */
static void make_blocks(Member *member, double *a, Known *known, int n)
{
    for (int i = 0; i < n;) {
        const int kind = whole(member, 0, 3);

        if (kind == 0 && i + 1 < n) {
            const int re = whole(member, -6, 2), im = whole(member, 1, 6);

            a[i * n + i] = a[(i + 1) * n + i + 1] = re;
            a[i * n + i + 1] = im;
            a[(i + 1) * n + i] = -im;
            known[i] = (Known){re, im};
            known[i + 1] = (Known){re, -im};
            i += 2;
        } else {
            const int times = kind == 1 ? whole(member, 2, 4) : 1, value = whole(member, -9, 3);

            for (int k = 0; k < times && i < n; k++, i++) {
                a[i * n + i] = value;
                known[i] = (Known){value, 0};
                if (k > 0)
                    a[(i - 1) * n + i] = whole(member, 1, 3);
            }
        }
    }
}

static Verdict whole_numbers_in_any_units(Member *member)
{
    double a[MOST * MOST] = {0}, error[MOST * MOST] = {0};
    Known known[MOST];
    const int n = whole(member, 2, 8), shears = whole(member, 0, 2 * n);

    make_blocks(member, a, known, n);
    for (int k = 0; k < shears; k++) {
        const int i = whole(member, 0, n - 1), j = (i + whole(member, 1, n - 1)) % n;

        shear(a, NULL, NULL, n, i, j, whole(member, 0, 1) * 2 - 1);
    }
    rescale(member, a, NULL, NULL, n, 33);
    return judge_matrix(member, a, error, known, n);
}

/* --- triangles --- */

/* entries over twenty decades, some poles alike */
static Verdict triangles_in_any_order(Member *member)
{
    double a[MOST * MOST] = {0}, error[MOST * MOST] = {0};
    Known known[MOST];
    const int n = whole(member, 1, MOST);

    for (int i = 0; i < n; i++) {
        known[i] = i > 0 && whole(member, 0, 2) == 0
                       ? known[whole(member, 0, i - 1)]
                       : (Known){whole(member, 0, 9) == 0 ? 0 : -decades(member, 10), 0};
        a[i * n + i] = known[i].real;
        for (int j = 0; j < i; j++)
            a[i * n + j] = whole(member, 0, 1) * decades(member, 20);
    }
    rescale(member, a, NULL, NULL, n, 10);
    return judge_matrix(member, a, error, known, n);
}

/* --- chains of neighbours --- */

/* eigenvalues below x of the matrix with this diagonal and products b_i c_i > 0 beside it: signs of
 * Sturm's sequence (Givens 1954) */
static int count_below(const Real *diagonal, const Real *beside, int n, Real x)
{
    Real d = 1;
    int count = 0;

    for (int i = 0; i < n; i++) {
        d = diagonal[i] - x - (i > 0 ? beside[i - 1] / d : 0);
        if (d == 0)
            d = -(Real)1e-300;
        count += d < 0;
    }
    return count;
}

/* the k-th of n eigenvalues, all negative, by halving between powers of 10 */
static double kth(const Real *diagonal, const Real *beside, int n, int k)
{
    double low = -60, high = 60; /* decades of -x */
    Real least, most;

    for (int step = 0; step < 20; step++) {
        const double middle = (low + high) / 2;

        if (count_below(diagonal, beside, n, -(Real)pow(10, middle)) > k)
            low = middle;
        else
            high = middle;
    }
    least = (Real)pow(10, low) * (Real)0.999;
    most = (Real)pow(10, high) * (Real)1.001;
    for (int step = 0; step < 70; step++) {
        const Real middle = (least + most) / 2;

        if (count_below(diagonal, beside, n, -middle) > k)
            least = middle;
        else
            most = middle;
    }
    return -(double)least;
}

/* of conductances and capacitances: x_i' = (g_i (x_i-1 - x_i) - g_i+1 (x_i - x_i+1))/c_i */
static void make_chain(const double *g, const double *c, int n, Real *diagonal, Real *beside)
{
    for (int i = 0; i < n; i++) {
        const Real next = i + 1 < n ? (Real)g[i + 1] : 0;

        diagonal[i] = -((Real)g[i] + next) / (Real)c[i];
        if (i > 0)
            beside[i - 1] = (Real)g[i] * (Real)g[i] / ((Real)c[i] * (Real)c[i - 1]);
    }
}

/* The matrix's own eigenvalues, as it is in doubles. */
static Verdict chains_of_neighbours(Member *member)
{
    double a[MOST * MOST] = {0}, error[MOST * MOST] = {0};
    Real diagonal[MOST], beside[MOST];
    Known known[MOST];
    const int n = whole(member, 2, MOST);
    const double span = test_uniform(&member->random, 0, 10);

    for (int i = 0; i < n; i++) {
        if (i > 0) {
            const double left = a[i * n + i - 1] = decades(member, span);
            a[(i - 1) * n + i] = decades(member, span);
            beside[i - 1] = (Real)left * (Real)a[(i - 1) * n + i];
        }
    }
    /* dominant by columns: all are negative */
    for (int i = 0; i < n; i++) {
        double sum = decades(member, span);

        for (int j = 0; j < n; j++)
            sum += j != i ? a[j * n + i] : 0;
        a[i * n + i] = -sum;
        diagonal[i] = -(Real)sum;
    }
    for (int k = 0; k < n; k++)
        known[k] = (Known){kth(diagonal, beside, n, k), 0};
    return judge_matrix(member, a, error, known, n);
}

/* --- transfer functions --- */

static double complex product(const Known *roots, int count, double complex s)
{
    double complex out = 1;

    for (int i = 0; i < count; i++)
        out *= s - (roots[i].real + I * roots[i].imaginary);
    return out;
}

/* whole roots, no zero at a pole */
static void make_roots(Member *member, Known *pole, int poles, Known *zero, int zeros)
{
    for (int i = 0; i < poles; i++)
        pole[i] = (Known){-2 * whole(member, 0, 4), 0};
    for (int i = 0; i < zeros; i++)
        zero[i] = (Known){2 * whole(member, -3, 3) + 1, 0};
}

static void expand(const Known *roots, int count, double *falling)
{
    memset(falling, 0, (size_t)(count + 1) * sizeof *falling);
    falling[0] = 1;
    for (int i = 0; i < count; i++)
        for (int k = i + 1; k > 0; k--)
            falling[k] -= roots[i].real * falling[k - 1];
}

/* the response at some frequencies, and its digits */
static bool responds(Member *member, const Linear *linear, const Transfer *t, const Known *pole,
                     int poles, const Known *zero, int zeros, double gain)
{
    for (int i = 0; i < 4; i++) {
        const double omega = decades(member, 3);
        const double complex h =
            gain * product(zero, zeros, I * omega) / product(pole, poles, I * omega);
        double db, degrees;

        transfer_response(linear, 0, 0, t, &omega, 1, &db, &degrees);
        if (!(fabs(db - 20 * log10(cabs(h))) < 1e-9) ||
            !(fabs(remainder(degrees - carg(h) * 180 / M_PI, 360)) < 1e-8)) {
            tell(member, "at %g rad/s: %.17g dB, %.17g deg, known %.17g, %.17g\n", omega, db,
                 degrees, 20 * log10(cabs(h)), carg(h) * 180 / M_PI);
            return false;
        }
    }
    return true;
}

/* half a unit in the last place of a double */
static void round_off(const double *from, int count, double *error)
{
    for (int i = 0; i < count; i++)
        error[i] = 0x1p-53 * fabs(from[i]);
}

/* Entries exact, or known to their rounding: then the answer may be refused, or 0 with a mark. */
static Verdict responses(Member *member, bool is_exact)
{
    const int n = whole(member, 1, 6), zeros = whole(member, 0, n);
    double a[MOST * MOST] = {0}, b[MOST] = {0}, c[MOST] = {0};
    double a_error[MOST * MOST] = {0}, b_error[MOST] = {0}, c_error[MOST] = {0}, d_error = 0;
    double numerator[MOST] = {0}, denominator[MOST];
    const double gain = whole(member, 0, 1) == 0 ? -whole(member, 1, 5) : whole(member, 1, 5);
    Known pole[MOST], zero[MOST];
    char name[] = "u", *names[] = {name};
    double d = 0;
    Linear linear = {.states = n,
                     .inputs = 1,
                     .outputs = 1,
                     .a = a,
                     .b = b,
                     .c = c,
                     .d = &d,
                     .a_error = a_error,
                     .b_error = b_error,
                     .c_error = c_error,
                     .d_error = &d_error,
                     .input_names = names,
                     .output_names = names};
    Transfer *t = NULL;
    Diag diag = {0};
    Verdict verdict = DISAGREES, poles;

    make_roots(member, pole, n, zero, zeros);
    expand(pole, n, denominator);
    expand(zero, zeros, numerator + n - zeros);
    /* x_i' = x_i+1, the last -a_0 x_0 - a_1 x_1 ... + u */
    d = zeros == n ? gain : 0;
    for (int i = 0; i < n; i++) {
        if (i + 1 < n)
            a[i * n + i + 1] = 1;
        a[(n - 1) * n + i] -= denominator[n - i];
        c[i] = gain * numerator[n - i] - d * denominator[n - i];
    }
    b[n - 1] = 1;
    for (int k = 0; k < n && n > 1; k++) {
        const int i = whole(member, 0, n - 1), j = (i + whole(member, 1, n - 1)) % n;

        shear(a, b, c, n, i, j, whole(member, 0, 1) * 2 - 1);
    }
    rescale(member, a, b, c, n, 30);
    if (!is_exact) {
        round_off(a, n * n, a_error);
        round_off(b, n, b_error);
        round_off(c, n, c_error);
    }
    if (transfer_new(&linear, 0, 0, &t, &diag) != OK && !is_exact) {
        tell(member, "%s\n", diag.message);
        verdict = REFUSED;
    } else if (t != NULL && t->within > 0) {
        tell(member, "0 within %g\n", t->within);
        verdict = is_exact ? DISAGREES : REFUSED;
    } else if (t == NULL || t->poles != n || t->zeros != zeros ||
               fabs(t->gain - gain) > 1e-12 * fabs(gain)) {
        tell(member, "%s: %d poles of %d, %d zeros of %d, gain %.17g of %.17g\n", diag.message,
             t != NULL ? t->poles : -1, n, t != NULL ? t->zeros : -1, zeros,
             t != NULL ? t->gain : NAN, gain);
    } else {
        poles = judge(member, "poles", t->pole, pole, n);
        verdict = judge(member, "zeros", t->zero, zero, zeros);
        verdict = poles > verdict ? poles : verdict;
        if (!responds(member, &linear, t, pole, n, zero, zeros, gain))
            verdict = DISAGREES;
    }
    transfer_free(t);
    return verdict;
}

static Verdict responses_of_whole_numbers(Member *member)
{
    return responses(member, true);
}

static Verdict responses_of_rounded_numbers(Member *member)
{
    return responses(member, false);
}

/* --- through the shell --- */

/* the roots of `export csv modes`, a pair as both; the count. Where no mode is marked, those on the
 * axis are there for certain. */
static int read_modes(const char *csv, bool is_marked, Root *root, int most)
{
    int count = 0;

    for (const char *line = strchr(csv, '\n'); line != NULL && line[1] != '\0' && count + 1 < most;
         line = strchr(line + 1, '\n')) {
        double real, imaginary, error;

        if (sscanf(line + 1, "%*d,%lg,%lg,%*g,%*g,%*g,%lg", &real, &imaginary, &error) != 3)
            break;
        for (int sign = 1; sign >= (imaginary > 0 ? -1 : 1); sign -= 2)
            root[count++] = (Root){real, sign * imaginary, error, !is_marked && real == 0};
    }
    return count;
}

static Verdict judge_model(Member *member, const char *script, const Known *known, int n)
{
    Kit kit = kit_new();
    Root root[MOST_ROOTS];
    Verdict verdict = DISAGREES;
    bool is_marked;
    int count;

    tell(member, "%s", script);
    if (kit_do(&kit, script) != CT_OK || kit_do(&kit, "modes\n") != CT_OK) {
        tell(member, "%s\n", kit.error.message);
    } else {
        is_marked = kit.text != NULL && strchr(kit.text, '?') != NULL;
        (void)kit_do(&kit, "export csv modes\n");
        count = kit.text != NULL ? read_modes(kit.text, is_marked, root, MOST_ROOTS) : 0;
        tell(member, "%d modes of %d\n", count, n);
        if (count == n)
            verdict = judge(member, "modes", root, known, n);
    }
    kit_free(&kit);
    return verdict;
}

/* R and C by turns, or L and R: both have the chain's poles */
static Verdict ladders_of_any_parts(Member *member)
{
    double g[MOST], c[MOST];
    Real diagonal[MOST], beside[MOST];
    Known known[MOST];
    char script[4096];
    const int n = whole(member, 1, 8);
    const bool of_coils = whole(member, 0, 1) == 1;
    const double span = test_uniform(&member->random, 0, 5);
    int at = snprintf(script, sizeof script, of_coils ? "resistor G0 0 n0 1\n" : "");

    for (int i = 0; i < n; i++) {
        const double r = decades(member, span);

        g[i] = of_coils ? r : 1 / r;
        c[i] = decades(member, span);
        /* a chain of coils to ground behind one another: i_k through L_k, R_k between them */
        if (of_coils)
            at += snprintf(script + at, sizeof script - (size_t)at,
                           "resistor R%d n%d 0 %.17g\ninductor L%d n%d n%d %.17g\n", i, i, r, i, i,
                           i + 1, c[i]);
        else
            at += snprintf(script + at, sizeof script - (size_t)at,
                           "resistor R%d n%d n%d %.17g\ncapacitor C%d n%d 0 %.17g\n", i, i, i + 1,
                           r, i, i + 1, c[i]);
    }
    (void)snprintf(script + at, sizeof script - (size_t)at,
                   of_coils ? "resistor S n%d 0 1e-3\n" : "vsource V n0 0 0\n", n);
    if (of_coils) {
        /* first resistor is 1 beside R0; behind the last there is 1e-3 */
        g[0] = 1 / (1 + 1 / g[0]);
        for (int i = 0; i < n; i++) {
            const Real next = i + 1 < n ? (Real)g[i + 1] : (Real)1e-3;

            diagonal[i] = -((Real)g[i] + next) / (Real)c[i];
            if (i > 0)
                beside[i - 1] = (Real)g[i] * (Real)g[i] / ((Real)c[i] * (Real)c[i - 1]);
        }
    } else {
        make_chain(g, c, n, diagonal, beside);
    }
    for (int k = 0; k < n; k++)
        known[k] = (Known){kth(diagonal, beside, n, k), 0};
    return judge_model(member, script, known, n);
}

/* stages that don't load each other, of poles far apart or alike */
static Verdict stages_behind_each_other(Member *member)
{
    Known known[MOST];
    char script[4096];
    const int n = whole(member, 1, 7);
    const bool alike = whole(member, 0, 2) == 0;
    double r = decades(member, 6), c = decades(member, 6);
    int at = snprintf(script, sizeof script, "isource I n1 0 0\n");

    for (int i = 1; i <= n; i++) {
        if (!alike || i == 1) {
            r = ldexp(1, whole(member, -20, 20));
            c = ldexp(1, whole(member, -20, 20));
        }
        if (i > 1)
            at += snprintf(script + at, sizeof script - (size_t)at,
                           "vccs G%d n%d 0 n%d 0 gain=%.17g\n", i, i, i - 1, decades(member, 5));
        at += snprintf(script + at, sizeof script - (size_t)at,
                       whole(member, 0, 1) == 0
                           ? "resistor R%d n%d 0 %.17g\ncapacitor C%d n%d 0 %.17g\n"
                           : "resistor R%d n%d 0 %.17g\ninductor L%d n%d 0 %.17g\n",
                       i, i, r, i, i, c);
        known[i - 1].imaginary = 0;
        known[i - 1].real = strstr(script, "inductor") != NULL ? NAN : 0;
        /* which of both it became */
        {
            char line[16];

            (void)snprintf(line, sizeof line, "\ninductor L%d ", i);
            known[i - 1].real = strstr(script, line) != NULL ? -r / c : -1 / (r * c);
        }
    }
    return judge_model(member, script, known, n);
}

/* equal masses between equal springs from wall to wall: 2 sqrt(k/m) sin(j pi/(2 (n + 1))) */
static Verdict chains_of_masses(Member *member)
{
    Known known[2 * MOST];
    char script[4096];
    const int n = whole(member, 1, 6);
    const double k = decades(member, 8), m = decades(member, 8);
    int at = snprintf(script, sizeof script, "scene planar\n");

    for (int i = 1; i <= n; i++)
        at += snprintf(script + at, sizeof script - (size_t)at,
                       "body m%d mass=%.17g inertia=1\nprismatic s%d ground m%d axis=x\n", i, m, i,
                       i);
    /* forces by the coordinates themselves, which are 0 */
    for (int i = 1; i <= n; i++) {
        at += snprintf(script + at, sizeof script - (size_t)at,
                       "actuator f%d s%d force=-%.17g*(2*s%d", i, i, k, i);
        if (i > 1)
            at += snprintf(script + at, sizeof script - (size_t)at, " - s%d", i - 1);
        if (i < n)
            at += snprintf(script + at, sizeof script - (size_t)at, " - s%d", i + 1);
        at += snprintf(script + at, sizeof script - (size_t)at, ")\n");
        known[2 * i - 2] = (Known){0, 2 * sqrt(k / m) * sin(i * M_PI / (2 * (n + 1)))};
        known[2 * i - 1] = (Known){0, -known[2 * i - 2].imaginary};
    }
    return judge_model(member, script, known, 2 * n);
}

/* shafts in a row from the ground on, their angles against each other as coordinates, which makes M
 * far worse than K: s^2 + d/k w^2 s + w^2 = 0, w = 2 sqrt(k/J) sin((2 j - 1) pi/(4 n + 2)) */
static Verdict shafts_in_a_row(Member *member)
{
    Known known[MOST_ROOTS];
    Text script = {0};
    const bool is_absolute = whole(member, 0, 1) == 1;
    const int n = whole(member, 1, is_absolute ? 20 : MOST_ROOTS / 2 - 2);
    const double k = decades(member, 4), inertia = decades(member, 4);
    const bool is_damped = whole(member, 0, 1) == 1;
    /* the fastest one fades within a tenth of what would keep it from swinging, at most */
    const double d =
        is_damped ? k * 0.1 * sqrt(inertia / k) * test_uniform(&member->random, 0, 1) : 0;
    Verdict verdict;

    text_add(&script, "scene planar\n");
    for (int i = 0; i < n; i++) {
        text_addf(&script, "body b%d mass=1 inertia=%.17g\n", i, inertia);
        if (i == 0)
            text_add(&script, "revolute h0 ground b0\n");
        else
            text_addf(&script, "revolute h%d b%d b%d\n", i, i - 1, i);
        text_addf(&script, "spring k%d h%d k=%.17g d=%.17g\n", i, i, k, d);
    }
    text_add(&script, is_absolute ? "tree absolute\n" : "tree joint\n");
    for (int j = 0; j < n; j++) {
        const double w = 2 * sqrt(k / inertia) * sin((2 * j + 1) * M_PI / (4 * n + 2));
        const double real = -d / k * w * w / 2 + 0.0;

        known[2 * j] = (Known){real, sqrt(w * w - real * real)};
        known[2 * j + 1] = (Known){real, -known[2 * j].imaginary};
    }
    verdict = judge_model(member, script.at, known, 2 * n);
    text_free(&script);
    return verdict;
}

/* --- pairs of matrices --- */

/* M = L L^T and K = L D L^T of whole numbers that doubles hold: eigenvalues D, of which some are
 * alike or 0, coordinates in any units */
static Verdict pairs_of_whole_numbers(Member *member)
{
    enum { PAIR = 24 };
    const int n = whole(member, 1, PAIR), still = whole(member, 0, 3);
    double l[PAIR * PAIR] = {0}, m[PAIR * PAIR], k[PAIR * PAIR], none[PAIR * PAIR] = {0};
    double d[PAIR], unit[PAIR], mean[PAIR], error[PAIR], worst = 0;
    int group[PAIR];
    bool sound = true;
    Modal *modal;

    for (int i = 0; i < n; i++) {
        /* where the first ones are 0 so are the last rows of K, whose L is 1 alone */
        d[i] = i >= n - still ? 0 : whole(member, -4, 12);
        unit[i] = power_of_2(member, 20);
        l[i * n + i] = 1;
        for (int j = 0; j < i; j++)
            l[i * n + j] = whole(member, 0, 3) == 0 && i < n - still ? whole(member, -1, 1) : 0;
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            m[i * n + j] = k[i * n + j] = 0;
            for (int p = 0; p < n; p++) {
                m[i * n + j] += l[i * n + p] * l[j * n + p] * unit[i] * unit[j];
                k[i * n + j] += l[i * n + p] * d[p] * l[j * n + p] * unit[i] * unit[j];
            }
        }
    modal = modal_new((BoundedMatrix){m, none}, (BoundedMatrix){k, none}, NULL, n);
    if (modal == NULL || !modal_groups(modal, group, mean, error))
        sound = false;
    /* as many within a group's disc as it has members */
    for (int g = 0; g < n && sound; g++) {
        int members = 0, within = 0;

        for (int i = 0; i < n; i++) {
            members += group[i] == group[g];
            within += fabs(d[i] - mean[g]) <= error[g];
        }
        tell(member, "%d about %.17g, error %.3g: %d known\n", members, mean[g], error[g], within);
        /* zeros that are certain stand apart from others that come near */
        sound = fabs(mean[g]) <= error[g] ? within >= members : within == members;
        worst = fmax(worst, error[g]);
    }
    modal_free(modal);
    if (!sound)
        return DISAGREES;
    return worst > 1e-6 ? REFUSED : AGREES;
}

/* --- long chains that are known badly --- */

/* Equal parts in a row, each entry off by as much as its error says at most: one matrix within the
 * errors of what is given has eigenvalues a + 2 b cos(k pi/(n + 1)), most of which can't be
 * determined apart. */
static Verdict long_chains_known_badly(Member *member)
{
    enum { MOST_PARTS = 60 };
    static double a[MOST_PARTS * MOST_PARTS], error[MOST_PARTS * MOST_PARTS];
    const int n = whole(member, 20, MOST_PARTS);
    const double middle = test_uniform(&member->random, -3, 1), beside = decades(member, 1);
    const double off = beside * pow(10, test_uniform(&member->random, -6, -0.5));
    Known known[MOST_PARTS];
    Spectrum *spectrum;
    bool sound;

    for (int i = 0; i < n * n; i++)
        a[i] = error[i] = 0;
    for (int i = 0; i < n; i++)
        for (int j = i > 0 ? i - 1 : 0; j < n && j <= i + 1; j++) {
            a[i * n + j] = (i == j ? middle : beside) + off * test_uniform(&member->random, -1, 1);
            error[i * n + j] = off;
        }
    for (int k = 0; k < n; k++)
        known[k] = (Known){middle + 2 * beside * cos((k + 1) * M_PI / (n + 1)), 0};
    spectrum = spectrum_new(a, error, n);
    if (spectrum == NULL)
        return DISAGREES;
    report_roots(member, "eigenvalues", spectrum_roots(spectrum), known, n);
    sound = match(spectrum_roots(spectrum), known, n);
    spectrum_free(spectrum);
    return sound ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"whole numbers in any units", 300, 0.01, 0, whole_numbers_in_any_units},
        {"triangles in any order", 300, 0, 0, triangles_in_any_order},
        {"chains of neighbours", 300, 0.01, 0, chains_of_neighbours},
        {"responses of whole numbers", 300, 0.05, 0, responses_of_whole_numbers},
        {"responses of rounded numbers", 300, 0.05, 0, responses_of_rounded_numbers},
        {"ladders of any parts", 60, 0, 0, ladders_of_any_parts},
        {"stages behind each other", 60, 0, 0, stages_behind_each_other},
        {"chains of masses", 40, 0, 0, chains_of_masses},
        {"shafts in a row", 12, 0, 0, shafts_in_a_row},
        {"pairs of whole numbers", 300, 0.05, 0, pairs_of_whole_numbers},
        {"long chains known badly", 20, 0, 0, long_chains_known_badly},
    };

    (void)test_faults; /* verdicts count here */
    return family_main(families, sizeof families / sizeof families[0], argc, argv);
}
