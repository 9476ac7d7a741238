/* transfer.c: poles, zeros and gain of one output against one input; frequency response
 *
 * States through which no way leads from the input to the output are left out first, by the
 * entries of A, B, C that aren't 0. Poles are eigenvalues. Zeros: where D is 0 the output is turned
 * into one state (Householder), which is 0 then, and whose rate takes the place of the output; that
 * takes a state away each time until the input is seen. Zeros are the eigenvalues of
 * A - B D^-1 C that is left, and none of them is at infinity (Emami-Naeini and Van Dooren 1982).
 * The response is solved for, frequency by frequency, with A as a Hessenberg matrix (Laub 1981);
 * roots only tell the turns of its phase. */
#include "simulate/transfer.h"

#include "base/memory.h"

#include <complex.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EPSILON  2.220446049250313e-16
#define SAME     1e-7 /* of a pole and a zero that count as equal, relative */
#define ABSOLUTE 64   /* units in the last place of the largest root */

/* x' = A x + b u, y = c x + d u */
typedef struct Single {
    int n;
    double *a, *b, *c; /* n x n row by row, n, n */
    double d;
} Single;

static void single_free(Single *s)
{
    mem_free(s->a);
    mem_free(s->b);
    mem_free(s->c);
}

/* --- states between input and output --- */

/* Mark what is reached from marked states; `back`: what reaches them. */
static void follow(const double *a, int n, bool back, bool *marked)
{
    int *queue = NEW_ARRAY(int, n);
    int count = 0;

    for (int i = 0; i < n; i++)
        if (marked[i])
            queue[count++] = i;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < n; i++)
            if (!marked[i] && (back ? a[queue[k] * n + i] : a[i * n + queue[k]]) != 0) {
                marked[i] = true;
                queue[count++] = i;
            }
    mem_free(queue);
}

/* the states that matter, of like size (GSL's balancing) */
static Single single_new(const Linear *linear, int output, int input)
{
    const int n = linear->states;
    double *a = NEW_ARRAY(double, n *n), *b = NEW_ARRAY(double, n), *c = NEW_ARRAY(double, n);
    bool *moved = NEW_ARRAY(bool, n), *seen = NEW_ARRAY(bool, n);
    int *kept = NEW_ARRAY(int, n);
    Single s = {.d = linear->d[output * linear->inputs + input]};

    linear_clean(linear, a);
    linear_clean_vector(linear, linear->b + input, linear->inputs, b);
    linear_clean_vector(linear, linear->c + (ptrdiff_t)output * n, 1, c);
    for (int i = 0; i < n; i++) {
        moved[i] = b[i] != 0;
        seen[i] = c[i] != 0;
    }
    follow(a, n, false, moved);
    follow(a, n, true, seen);
    for (int i = 0; i < n; i++)
        if (moved[i] && seen[i])
            kept[s.n++] = i;
    s.a = NEW_ARRAY(double, s.n *s.n);
    s.b = NEW_ARRAY(double, s.n);
    s.c = NEW_ARRAY(double, s.n);
    for (int i = 0; i < s.n; i++) {
        s.b[i] = b[kept[i]];
        s.c[i] = c[kept[i]];
        for (int j = 0; j < s.n; j++)
            s.a[i * s.n + j] = a[kept[i] * n + kept[j]];
    }
    if (s.n > 0) {
        gsl_matrix_view view = gsl_matrix_view_array(s.a, (size_t)s.n, (size_t)s.n);
        gsl_vector *scale = gsl_vector_alloc((size_t)s.n);

        (void)gsl_linalg_balance_matrix(&view.matrix, scale);
        for (int i = 0; i < s.n; i++) {
            s.b[i] /= gsl_vector_get(scale, (size_t)i);
            s.c[i] *= gsl_vector_get(scale, (size_t)i);
        }
        gsl_vector_free(scale);
    }
    mem_free(a);
    mem_free(b);
    mem_free(c);
    mem_free(moved);
    mem_free(seen);
    mem_free(kept);
    return s;
}

static Single single_copy(const Single *s)
{
    Single copy = {s->n, NEW_ARRAY(double, s->n * s->n), NEW_ARRAY(double, s->n),
                   NEW_ARRAY(double, s->n), s->d};

    for (int i = 0; i < s->n; i++) {
        copy.b[i] = s->b[i];
        copy.c[i] = s->c[i];
    }
    for (int k = 0; k < s->n * s->n; k++)
        copy.a[k] = s->a[k];
    return copy;
}

static double norm(const double *v, int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++)
        sum = hypot(sum, v[i]);
    return sum;
}

/* --- zeros --- */

/* the input reaches the output at once, beyond rounding */
static bool is_direct(const Single *s)
{
    double rate = norm(s->a, s->n * s->n);
    double reach = norm(s->c, s->n) * norm(s->b, s->n);

    return s->d != 0 && (rate == 0 || fabs(s->d) * rate > ABSOLUTE * EPSILON * reach);
}

static void swap(double *x, double *y)
{
    double kept = *x;

    *x = *y;
    *y = kept;
}

/* I - v v^T on rows or columns; v of length sqrt(2) */
static void reflect(double *at, int n, int stride, const double *v)
{
    double along = 0;

    for (int i = 0; i < n; i++)
        along += v[i] * at[(ptrdiff_t)i * stride];
    for (int i = 0; i < n; i++)
        at[(ptrdiff_t)i * stride] -= along * v[i];
}

/* Turn the states so that c = [0 .. 0 r]; an output that is one state already is put last, which
 * rounds nothing. Its r. */
static double turn_output(Single *s)
{
    const int n = s->n;
    double r = norm(s->c, n), size;
    double *v = NEW_ARRAY(double, n);
    int single = -1, count = 0;

    for (int i = 0; i < n; i++)
        if (s->c[i] != 0) {
            single = i;
            count++;
        }
    if (count == 1) {
        r = s->c[single];
        swap(&s->c[single], &s->c[n - 1]);
        swap(&s->b[single], &s->b[n - 1]);
        for (int i = 0; i < n; i++)
            swap(&s->a[i * n + single], &s->a[i * n + n - 1]);
        for (int j = 0; j < n; j++)
            swap(&s->a[single * n + j], &s->a[(n - 1) * n + j]);
    } else if (count > 1) {
        r = s->c[n - 1] > 0 ? -r : r;
        for (int i = 0; i < n; i++)
            v[i] = s->c[i] - (i == n - 1 ? r : 0);
        size = norm(v, n) / sqrt(2);
        for (int i = 0; i < n; i++)
            v[i] /= size;
        for (int i = 0; i < n; i++)
            reflect(s->a + (ptrdiff_t)i * n, n, 1, v);
        for (int j = 0; j < n; j++)
            reflect(s->a + j, n, n, v);
        reflect(s->b, n, 1, v);
    }
    mem_free(v);
    return r;
}

/* the last state is 0, its rate the new output */
static void drop_last(Single *s)
{
    const int n = s->n - 1;

    s->d = s->b[n];
    for (int j = 0; j < n; j++)
        s->c[j] = s->a[n * s->n + j];
    for (int i = 1; i < n; i++)
        memmove(s->a + (ptrdiff_t)i * n, s->a + (ptrdiff_t)i * s->n, (size_t)n * sizeof(double));
    s->n = n;
}

/* 0 where nothing but rounding is left */
static double difference(double x, double y)
{
    return fabs(x - y) > 4 * EPSILON * fmax(fabs(x), fabs(y)) ? x - y : 0;
}

/* zeros, and the gain of H in zeros and poles; false where they can't be found */
static bool find_zeros(const Single *from, Root *zero, int *count, double *gain)
{
    Single s = single_copy(from);
    bool sound = true;

    *gain = 1;
    *count = 0;
    while (s.n > 0 && !is_direct(&s) && *gain != 0) {
        *gain *= turn_output(&s);
        drop_last(&s);
    }
    *gain *= is_direct(&s) ? s.d : 0;
    if (*gain != 0) {
        for (int i = 0; i < s.n; i++)
            for (int j = 0; j < s.n; j++)
                s.a[i * s.n + j] = difference(s.a[i * s.n + j], s.b[i] * s.c[j] / s.d);
        *count = s.n;
        sound = eigen_values(s.a, s.n, zero);
    }
    single_free(&s);
    return sound;
}

/* --- roots --- */

static double size_of(Root root)
{
    return hypot(root.real, root.imaginary);
}

static double largest_of(const Root *roots, int count)
{
    double largest = 0;

    for (int i = 0; i < count; i++)
        largest = fmax(largest, size_of(roots[i]));
    return largest;
}

static int by_size(const void *a, const void *b)
{
    const Root *x = a, *y = b;
    if (size_of(*x) != size_of(*y))
        return size_of(*x) < size_of(*y) ? -1 : 1;
    if (x->real != y->real)
        return x->real > y->real ? -1 : 1;
    return (x->imaginary < y->imaginary) - (x->imaginary > y->imaginary);
}

/* parts that are rounding against the whole root or the largest one as 0 */
static void round_roots(Root *roots, int count)
{
    double noise = ABSOLUTE * EPSILON * largest_of(roots, count);

    for (int i = 0; i < count; i++) {
        double least = fmax(fmin(noise, 1e-6 * size_of(roots[i])), 4 * EPSILON * size_of(roots[i]));

        if (fabs(roots[i].real) <= least)
            roots[i].real = 0;
        roots[i].real += 0.0; /* never -0 */
    }
    if (count > 0)
        qsort(roots, (size_t)count, sizeof *roots, by_size);
}

static void remove_root(Root *roots, int *count, int which)
{
    for (int i = which; i + 1 < *count; i++)
        roots[i] = roots[i + 1];
    (*count)--;
}

/* the pair of a pole and a zero that are closest, of those above or on the real axis */
static double closest(const Transfer *t, int *pole, int *zero)
{
    double best = INFINITY;

    for (int p = 0; p < t->poles; p++)
        for (int z = 0; z < t->zeros; z++) {
            double apart = hypot(t->pole[p].real - t->zero[z].real,
                                 t->pole[p].imaginary - t->zero[z].imaginary);

            if (t->pole[p].imaginary < 0 || t->zero[z].imaginary < 0 ||
                (t->pole[p].imaginary > 0) != (t->zero[z].imaginary > 0) || apart >= best)
                continue;
            best = apart;
            *pole = p;
            *zero = z;
        }
    return best;
}

static void drop_pair(Root *roots, int *count, int which)
{
    Root root = roots[which];

    remove_root(roots, count, which);
    for (int i = 0; root.imaginary > 0 && i < *count; i++)
        if (roots[i].real == root.real && roots[i].imaginary == -root.imaginary) {
            remove_root(roots, count, i);
            break;
        }
}

/* Leave out poles and zeros that are equal to rounding. */
static void cancel(Transfer *t)
{
    const double noise =
        ABSOLUTE * EPSILON * fmax(largest_of(t->pole, t->poles), largest_of(t->zero, t->zeros));
    const int before = t->poles;
    int pole = 0, zero = 0;

    for (;;) {
        double apart = closest(t, &pole, &zero);

        if (!isfinite(apart) || apart > SAME * size_of(t->pole[pole]) + noise)
            break;
        drop_pair(t->pole, &t->poles, pole);
        drop_pair(t->zero, &t->zeros, zero);
    }
    t->cancelled = before - t->poles;
}

/* --- polynomials --- */

/* gain times the product of (s - root), falling powers: new, count + 1 */
static double *expand(const Root *roots, int count, double gain)
{
    double *out = NEW_ARRAY(double, count + 1);
    int degree = 0;

    out[0] = gain;
    for (int i = 0; i < count; i++) {
        double linear = roots[i].imaginary > 0 ? -2 * roots[i].real : -roots[i].real;
        double constant = roots[i].imaginary > 0 ? size_of(roots[i]) * size_of(roots[i]) : 0;

        if (roots[i].imaginary < 0)
            continue;
        degree += roots[i].imaginary > 0 ? 2 : 1;
        for (int k = degree; k > 0; k--) /* behind the old degree all are 0 */
            out[k] += linear * out[k - 1] + (k > 1 ? constant * out[k - 2] : 0);
    }
    for (int k = 0; k <= count; k++)
        out[k] += 0.0; /* never -0 */
    return out;
}

void transfer_free(Transfer *transfer)
{
    if (transfer == NULL)
        return;
    mem_free(transfer->zero);
    mem_free(transfer->pole);
    mem_free(transfer->numerator);
    mem_free(transfer->denominator);
    mem_free(transfer);
}

Status transfer_new(const Linear *linear, int output, int input, Transfer **out, Diag *diag)
{
    Single s = single_new(linear, output, input);
    Transfer *t = NEW(Transfer);
    Status status = OK;

    t->pole = NEW_ARRAY(Root, s.n);
    t->zero = NEW_ARRAY(Root, s.n);
    t->idle = linear->states - s.n;
    if (!find_zeros(&s, t->zero, &t->zeros, &t->gain) ||
        (t->gain != 0 && !eigen_values(s.a, s.n, t->pole)))
        CHECK(diag_set(diag, E_SOLVER, "the poles and zeros of %s against %s can't be found",
                       linear->output_names[output], linear->input_names[input]));
    t->poles = t->gain != 0 ? s.n : 0;
    round_roots(t->pole, t->poles);
    round_roots(t->zero, t->zeros);
    cancel(t);
    t->numerator = expand(t->zero, t->zeros, t->gain);
    t->denominator = expand(t->pole, t->poles, 1);
    *out = t;
    t = NULL;
done:
    transfer_free(t);
    single_free(&s);
    return status;
}

/* --- frequency response --- */

/* argument of the product of (j omega - root), continuous in omega; `halves` counts what are half
 * turns at its start */
static double turns_of(const Root *roots, int count, double omega, int *halves)
{
    double sum = 0;

    for (int i = 0; i < count; i++) {
        const double turn = atan2(omega - roots[i].imaginary, fabs(roots[i].real));

        sum += roots[i].real > 0 ? -turn : turn;
        *halves += roots[i].real > 0 && roots[i].imaginary == 0;
    }
    return sum;
}

/* the phase as the roots tell it; at its start, where nothing integrates, 0 or half a turn */
static double phase_by_roots(const Transfer *t, double omega)
{
    int above = t->gain < 0, below = 0;
    double phase = turns_of(t->zero, t->zeros, omega, &above);

    phase -= turns_of(t->pole, t->poles, omega, &below);
    if ((above + below) % 2 != 0)
        phase += below % 2 != 0 ? -M_PI : M_PI;
    return phase;
}

static void make_hessenberg(Single *s)
{
    const size_t n = (size_t)s->n;
    gsl_matrix_view a = gsl_matrix_view_array(s->a, n, n);
    gsl_vector *tau = gsl_vector_alloc(n), *turned = gsl_vector_alloc(n);
    gsl_matrix *u = gsl_matrix_alloc(n, n);
    gsl_vector_view b = gsl_vector_view_array(s->b, n), c = gsl_vector_view_array(s->c, n);

    (void)gsl_linalg_hessenberg_decomp(&a.matrix, tau);
    (void)gsl_linalg_hessenberg_unpack(&a.matrix, tau, u);
    (void)gsl_linalg_hessenberg_set_zero(&a.matrix);
    for (int k = 0; k < 2; k++) { /* b and c are turned alike: u^T b, c u */
        gsl_vector *v = k == 0 ? &b.vector : &c.vector;

        for (size_t j = 0; j < n; j++) {
            double sum = 0;

            for (size_t i = 0; i < n; i++)
                sum += gsl_matrix_get(u, i, j) * gsl_vector_get(v, i);
            gsl_vector_set(turned, j, sum);
        }
        (void)gsl_vector_memcpy(v, turned);
    }
    gsl_vector_free(tau);
    gsl_vector_free(turned);
    gsl_matrix_free(u);
}

/* d + c (s - A)^-1 b of a Hessenberg matrix, by Gauss with exchange of neighbours; `room` holds
 * n (n + 1) numbers. INFINITY at a pole. */
static double complex respond(const Single *h, double complex at, double complex *room)
{
    const int n = h->n;
    double complex *x = room + (ptrdiff_t)n * n, sum = h->d;

    for (int i = 0; i < n; i++) {
        x[i] = h->b[i];
        for (int j = 0; j < n; j++)
            room[i * n + j] = (i == j ? at : 0) - h->a[i * n + j];
    }
    for (int k = 0; k + 1 < n; k++) {
        double complex *row = room + (ptrdiff_t)k * n, *next = row + n, factor, kept;

        if (cabs(next[k]) > cabs(row[k])) {
            for (int j = k; j < n; j++) {
                kept = row[j];
                row[j] = next[j];
                next[j] = kept;
            }
            kept = x[k];
            x[k] = x[k + 1];
            x[k + 1] = kept;
        }
        if (next[k] == 0)
            continue;
        factor = next[k] / row[k];
        for (int j = k + 1; j < n; j++)
            next[j] -= factor * row[j];
        x[k + 1] -= factor * x[k];
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++)
            x[k] -= room[k * n + j] * x[j];
        if (room[k * n + k] == 0)
            return INFINITY;
        x[k] /= room[k * n + k];
        sum += h->c[k] * x[k];
    }
    return sum;
}

void transfer_response(const Linear *linear, int output, int input, const Transfer *transfer,
                       const double *omega, int count, double *gain, double *phase)
{
    Single s = single_new(linear, output, input);
    double complex *room = mem_array((size_t)s.n * (size_t)(s.n + 1), sizeof *room);

    if (s.n > 0)
        make_hessenberg(&s);
    for (int i = 0; i < count; i++) {
        double complex h = respond(&s, I * omega[i], room);
        double turns = phase_by_roots(transfer, omega[i]);

        gain[i] = 20 * log10(cabs(h));
        /* the response is as exact as A; the roots tell which turn it is on */
        if (transfer->gain == 0)
            phase[i] = 0;
        else if (h == 0 || !isfinite(cabs(h)))
            phase[i] = turns * 180 / M_PI;
        else
            phase[i] =
                (carg(h) + 2 * M_PI * nearbyint((turns - carg(h)) / (2 * M_PI))) * 180 / M_PI;
    }
    mem_free(room);
    single_free(&s);
}
