/* spectrum.c: eigenvalues block by block, with an error bound for each
 *
 * A matrix is permuted to block triangular form (block_triangular.h) and each block is balanced.
 * Eigenvalues are computed in doubles (enclosure.h) if these separate them, with errors far below
 * those of the matrix entries. Otherwise they and their vectors are computed in numbers of twice
 * the digits. In that case the matrix is first perturbed by the error bounds of its entries, so
 * that multiple eigenvalues split as far as they would under errors, and no farther. The first
 * order of that perturbation is subtracted from the eigenvalues at the end.
 *
 * With A = sum lambda_k x_k y_k^T an eigenvalue is off by |y|^T |dA| |x| (Stewart and Sun 1990).
 * Of a group c about mu, which can't be distinguished, none is farther from mu than r where the sum
 * over j of theta_j/r^(j+1) is 1, theta_j being the spectral radius of |N_j| |dA|, N_j the sum over
 * c of (lambda_k - mu)^j x_k y_k^T: the resolvent's principal part (Kato 1995, I.5). */
#include "algebra/spectrum.h"

#include "algebra/algebra_limits.h"
#include "algebra/block_triangular.h"
#include "algebra/enclosure.h"
#include "algebra/linear.h"
#include "algebra/perron.h"
#include "algebra/schur.h"
#include "base/memory.h"

#include <string.h>

/* of one block: right vectors as columns, left ones as rows */
typedef struct SpectrumPart {
    int size;
    const int *state;
    DoubleDoubleComplex *right, *left;
    double *error; /* size x size */
    int first;     /* its first root */
} SpectrumPart;

struct Spectrum {
    int n;
    double *a;
    BlockTriangular blocks;
    SpectrumPart *part;
    Root *root;
    double complex *value; /* of each root before groups were joined */
    int *column;           /* of its part's vectors */
    int *part_of;          /* by root */
};

/* --- one block --- */

/* some roots of a part, which may be one */
typedef struct Grouping {
    const SpectrumPart *part;
    const double complex *value; /* as disturbed */
    const int *members;
    int count;
    double complex mean; /* of these, as disturbed, */
    double spread;       /* from which none is farther */
    int power;           /* j: the following fields are for N_j */
    double *size; /* |N_j| (size x size); NULL: only the sum of |lambda_k - mu|^j |x_k| |y_k^T|
                   * that bounds it */
    const double *open; /* how far off x_k y_k^T may be, in balanced states; NULL: nowhere */
    const double *scale;
} Grouping;

static double size_of(DoubleDoubleComplex a)
{
    return cabs(dd_to(a));
}

/* out = sum of |lambda_k - mu|^j |x_k| |y_k^T| v */
static void apply_terms(const Grouping *g, const double *v, double *out)
{
    const SpectrumPart *part = g->part;
    const int n = part->size;

    memset(out, 0, (size_t)n * sizeof(double));
    for (int k = 0; k < g->count; k++) {
        const int m = g->members[k];
        double along = 0;

        for (int i = 0; i < n; i++)
            along += size_of(part->left[m * n + i]) * v[i];
        along *= pow(cabs(g->value[m] - g->mean), g->power);
        for (int i = 0; i < n; i++)
            out[i] += size_of(part->right[i * n + m]) * along;
    }
}

/* and its error by those of the vectors */
static void add_open(const Grouping *g, const double *v, double *out)
{
    const int n = g->part->size;
    double along = 0, open = 0;

    for (int k = 0; k < g->count && g->open != NULL; k++)
        open += g->open[g->members[k]] * pow(cabs(g->value[g->members[k]] - g->mean), g->power);
    if (open == 0)
        return;
    for (int i = 0; i < n; i++)
        along += g->scale[i] * v[i];
    for (int i = 0; i < n; i++)
        out[i] += open * along / g->scale[i];
}

static void apply_group(const void *context, const double *v, double *out)
{
    const Grouping *g = context;
    const int n = g->part->size;
    double *moved = NEW_ARRAY(double, n);

    matrix_times(g->part->error, n, n, v, moved);
    if (g->size != NULL)
        matrix_times(g->size, n, n, moved, out);
    else
        apply_terms(g, moved, out);
    add_open(g, moved, out);
    mem_free(moved);
}

/* |N_j|, which may be far less than its terms */
static void find_sum(const Grouping *g)
{
    const SpectrumPart *part = g->part;
    const int n = part->size;
    DoubleDoubleComplex *by = NEW_ARRAY(DoubleDoubleComplex, g->count); /* (lambda_k - mu)^j */

    for (int k = 0; k < g->count; k++) {
        by[k] = dd_real(dd_of(1));
        for (int p = 0; p < g->power; p++)
            by[k] = dd_cmul(by[k], dd_from(g->value[g->members[k]] - g->mean));
    }
    for (int i = 0; i < n; i++) {
        DoubleDoubleComplex *sum = NEW_ARRAY(DoubleDoubleComplex, n);

        for (int k = 0; k < g->count; k++) {
            const int m = g->members[k];
            const DoubleDoubleComplex x = dd_cmul(part->right[i * n + m], by[k]);

            for (int j = 0; j < n; j++)
                sum[j] = dd_cadd(sum[j], dd_cmul(x, part->left[m * n + j]));
        }
        for (int j = 0; j < n; j++)
            g->size[i * n + j] = size_of(sum[j]);
        mem_free(sum);
    }
    mem_free(by);
}

/* theta_j of the terms, an upper bound; of the sum */
static double theta_of_terms(Grouping *g, int power)
{
    g->power = power;
    return perron_bound(apply_group, g, g->part->size);
}

static double theta(Grouping *g, int power)
{
    double radius;

    g->power = power;
    g->size = NEW_ARRAY(double, g->part->size * g->part->size);
    find_sum(g);
    radius = perron_bound(apply_group, g, g->part->size);
    mem_free(g->size);
    g->size = NULL;
    return radius;
}

/* r = max (m theta_j)^(1/(j+1)) has a sum of 1 at most. With terms in the place of sums theta_j is
 * theta_0 spread^j at most, so that r = spread + theta_0 has too; powers beyond one of which m
 * theta_j is r^(j+1) at most, or spread^(j+1), add nothing. */
static double radius_of(Grouping *g)
{
    const double all = theta_of_terms(g, 0);
    double radius = g->spread;

    if (all <= SPECTRUM_NEGLIGIBLE * g->spread)
        return g->spread + all;
    for (int power = 0; power < g->count; power++) {
        if (g->count * theta_of_terms(g, power) <= pow(radius, power + 1))
            break;
        radius = fmax(radius, pow(g->count * theta(g, power), 1.0 / (power + 1)));
    }
    return fmin(radius, g->spread + all);
}

static double group_error(void *context, const int *members, int count, double complex mean)
{
    Grouping g = *(const Grouping *)context;

    (void)mean;
    g.members = members;
    g.count = count;
    for (int k = 0; k < count; k++)
        g.mean += g.value[members[k]] / count;
    for (int k = 0; k < count; k++)
        g.spread = fmax(g.spread, cabs(g.value[members[k]] - g.mean));
    return radius_of(&g);
}

/* |y|^T |dA| |x| */
static double single_error(const SpectrumPart *part, int k)
{
    const int n = part->size;
    double sum = 0;

    for (int i = 0; i < n; i++) {
        double size = 0;

        for (int j = 0; j < n; j++)
            if (part->error[i * n + j] > 0)
                size += part->error[i * n + j] * cabs(dd_to(part->right[j * n + k]));
        sum += cabs(dd_to(part->left[k * n + i])) * size;
    }
    return sum;
}

/* y^T d x: how far the disturbance d moves a value */
static double complex moved_by(const SpectrumPart *part, int k, const double *disturbed)
{
    const int n = part->size;
    double complex moved = 0;

    for (int i = 0; i < n; i++) {
        double complex row = 0;

        for (int j = 0; j < n; j++)
            row += disturbed[i * n + j] * dd_to(part->right[j * n + k]);
        moved += dd_to(part->left[k * n + i]) * row;
    }
    return moved;
}

/* rounding error of the method, relative to the scaled matrix as a whole */
static double method_error(const SpectrumPart *part, const double *block, const double *scale,
                           int k)
{
    const int n = part->size;
    double norm = 0, x = 0, y = 0;

    for (int i = 0; i < n; i++) {
        double row = 0;

        for (int j = 0; j < n; j++)
            row += fabs(block[i * n + j]) * scale[i] / scale[j];
        norm = fmax(norm, row);
        x = fmax(x, scale[i] * cabs(dd_to(part->right[i * n + k])));
        y += cabs(dd_to(part->left[k * n + i])) / scale[i];
    }
    return n * DOUBLE_DOUBLE_ROUNDING * norm * x * y;
}

/* eigenvalues and vectors of the block as it is scaled and disturbed */
static bool decompose(const SpectrumPart *part, const double *block, const double *disturbed,
                      const double *scale, double complex *value)
{
    const int n = part->size;
    DoubleDouble *a = NEW_ARRAY(DoubleDouble, n * n);
    DoubleDoubleComplex *t = NEW_ARRAY(DoubleDoubleComplex, n * n),
                        *z = NEW_ARRAY(DoubleDoubleComplex, n * n);
    bool sound;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            a[i * n + j] =
                dd_times(dd_sum(block[i * n + j], disturbed[i * n + j]), scale[i] / scale[j]);
    sound = schur(a, n, t, z);
    if (sound)
        schur_vectors(t, z, n, part->right, part->left);
    for (int i = 0; i < n && sound; i++) {
        value[i] = dd_to(t[i * n + i]);
        sound = isfinite(cabs(value[i]));
        for (int k = 0; k < n; k++) {
            part->right[i * n + k] = dd_ctimes(part->right[i * n + k], dd_of(1 / scale[i]));
            part->left[k * n + i] = dd_ctimes(part->left[k * n + i], dd_of(scale[i]));
        }
    }
    MEM_FREE(a, t, z);
    return sound;
}

/* the largest entry of each right vector about 1 */
static void normalise(const SpectrumPart *part)
{
    const int n = part->size;

    for (int k = 0; k < n; k++) {
        double largest = 0, scale;

        for (int i = 0; i < n; i++)
            largest = fmax(largest, dd_size(part->right[i * n + k]));
        if (!(largest > 0 && isfinite(largest)))
            continue;
        scale = ldexp(1, -ilogb(largest));
        for (int i = 0; i < n; i++) {
            part->right[i * n + k] = dd_ctimes(part->right[i * n + k], dd_of(scale));
            part->left[k * n + i] = dd_ctimes(part->left[k * n + i], dd_of(1 / scale));
        }
    }
}

static void place_on_axis(const SpectrumPart *part, const double *block, Root *root)
{
    const int n = part->size;
    bool *pattern = NEW_ARRAY(bool, n *n);
    int near = 0;

    for (int i = 0; i < n * n; i++)
        pattern[i] = block[i] != 0 || part->error[i] != 0;
    if (block_triangular_alternate(pattern, n))
        for (int k = 0; k < n; k++) {
            /* mirrored about the axis it would be another within its error */
            near = 0;
            for (int j = 0; j < n; j++)
                near += hypot(root[j].real + root[k].real, root[j].imaginary - root[k].imaginary) <=
                        root[j].error + root[k].error;
            root[k].is_on_axis = root[k].real == 0 && near == 1;
            if (root[k].is_on_axis && root[k].imaginary == 0)
                root[k].error = 0;
        }
    mem_free(pattern);
}

/* What doubles leave open in balanced states, dA being `moved`: of |y_k|^T |dA| |x_k|, from what
 * other vectors they may have in them, into out; of any entry of x_k y_k^T into `open`. */
static void open_errors(const Enclosure *e, const double *moved, double *out, double *open)
{
    const int n = e->n;
    double *x = NEW_ARRAY(double, n *n), *y = NEW_ARRAY(double, n *n);
    double *across = NEW_ARRAY(double, n *n), *by = NEW_ARRAY(double, n *n);
    double left = 0;

    for (int i = 0; i < n * n; i++) {
        x[i] = cabs(e->right[i]);
        y[i] = cabs(e->left[i]);
        left = fmax(left, y[i]);
    }
    matrices_times(moved, x, n, across);
    matrices_times(y, across, n, by);
    for (int k = 0; k < n; k++) {
        double turned = 0;

        out[k] = e->error[k];
        for (int j = 0; j < n; j++) {
            out[k] += 2 * (e->turn_right[j * n + k] * by[k * n + j] +
                           e->turn_left[k * n + j] * by[j * n + k]);
            turned += e->turn_right[j * n + k] + e->turn_left[k * n + j];
        }
        open[k] = 2 * turned * left;
    }
    MEM_FREE(x, y, across, by);
}

static void take_vectors(const SpectrumPart *part, const Enclosure *e, const double *scale)
{
    const int n = part->size;

    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            part->right[i * n + k] = dd_from(e->right[i * n + k] / scale[i]);
            part->left[k * n + i] = dd_from(e->left[k * n + i] * scale[i]);
        }
}

static bool are_apart(const double complex *value, const double *error, int n)
{
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            if (!(cabs(value[i] - value[j]) > ROOTS_WITHIN * (error[i] + error[j])))
                return false;
    return true;
}

/* Eigenvalues by doubles; false where these don't separate them, or have larger errors than the
 * entries cause. */
static bool solve_in_doubles(const SpectrumPart *part, const double *block, const double *scale,
                             double complex *value, Root *root)
{
    const int n = part->size;
    DoubleDouble *a = NEW_ARRAY(DoubleDouble, n * n);
    double *error = NEW_ARRAY(double, n), *open = NEW_ARRAY(double, n);
    double *left_open = NEW_ARRAY(double, n), *moved = NEW_ARRAY(double, n *n);
    Grouping grouping = {.part = part, .value = value, .open = open, .scale = scale};
    Enclosure e;
    bool sound;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            a[i * n + j] = dd_of(block[i * n + j] * (scale[i] / scale[j]));
            moved[i * n + j] = part->error[i * n + j] * scale[i] / scale[j];
        }
    sound = enclosure_find(a, n, &e);
    if (sound) {
        take_vectors(part, &e, scale);
        normalise(part);
        open_errors(&e, moved, left_open, open);
    }
    for (int k = 0; k < n && sound; k++) {
        error[k] = single_error(part, k);
        sound = left_open[k] <= SPECTRUM_NEGLIGIBLE * error[k];
        error[k] += left_open[k];
        value[k] = e.value[k];
    }
    if (sound && are_apart(value, error, n))
        for (int k = 0; k < n; k++)
            root[k] = root_make(value[k], ROOT_SECOND_ORDER * error[k]);
    else if (sound)
        roots_join(value, error, n, group_error, &grouping, root);
    enclosure_free(&e);
    MEM_FREE(a, error, open, left_open, moved);
    return sound;
}

static bool solve_in_more_digits(const SpectrumPart *part, const double *block, const double *scale,
                                 double complex *value, Root *root)
{
    const int n = part->size;
    double *disturbed = NEW_ARRAY(double, n *n), *error = NEW_ARRAY(double, n);
    double complex *taken_back = mem_array((size_t)n, sizeof *taken_back);
    Grouping grouping = {.part = part, .value = value};
    bool sound;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            disturbed[i * n + j] = disturbance(i, j) * part->error[i * n + j];
    sound = decompose(part, block, disturbed, scale, value);
    if (sound)
        normalise(part);
    for (int k = 0; k < n && sound; k++) {
        error[k] = single_error(part, k);
        taken_back[k] = root_with_noise(value[k] - moved_by(part, k, disturbed),
                                        method_error(part, block, scale, k), &error[k]);
    }
    if (sound)
        roots_join(taken_back, error, n, group_error, &grouping, root);
    MEM_FREE(disturbed, error, taken_back);
    return sound;
}

static bool solve_part(const SpectrumPart *part, const double *block, double complex *value,
                       Root *root)
{
    const int n = part->size;
    double *scale = NEW_ARRAY(double, n), *size = NEW_ARRAY(double, n *n);
    bool sound;

    for (int k = 0; k < n * n; k++) {
        part->error[k] = fmax(part->error[k], UNIT_ROUNDOFF * fabs(block[k]));
        size[k] = fabs(block[k]) + part->error[k];
    }
    matrix_balance(size, n, scale);
    sound = solve_in_doubles(part, block, scale, value, root) ||
            solve_in_more_digits(part, block, scale, value, root);
    if (sound)
        place_on_axis(part, block, root);
    MEM_FREE(scale, size);
    return sound;
}

/* --- all blocks --- */

static bool fill_part(Spectrum *s, const double *error, int b, int first)
{
    const int size = s->blocks.start[b + 1] - s->blocks.start[b];
    SpectrumPart *part = &s->part[b];
    double *block = NEW_ARRAY(double, size *size);
    bool sound = true;

    *part = (SpectrumPart){size,
                           s->blocks.order + s->blocks.start[b],
                           NEW_ARRAY(DoubleDoubleComplex, size * size),
                           NEW_ARRAY(DoubleDoubleComplex, size * size),
                           NEW_ARRAY(double, size *size),
                           first};
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            block[i * size + j] = s->a[part->state[i] * s->n + part->state[j]];
            part->error[i * size + j] = error[part->state[i] * s->n + part->state[j]];
        }
    if (size == 1) {
        s->value[first] = block[0];
        s->root[first] = root_make(block[0], part->error[0]);
        part->right[0] = part->left[0] = dd_real(dd_of(1));
    } else {
        sound = solve_part(part, block, s->value + first, s->root + first);
    }
    for (int k = 0; k < size; k++) {
        s->part_of[first + k] = b;
        s->column[first + k] = k;
    }
    mem_free(block);
    return sound;
}

/* of a pair the one above the axis first: roots of a part in order */
static int by_place(const void *a, const void *b)
{
    const Root *x = a, *y = b;

    if (x->real != y->real)
        return x->real > y->real ? -1 : 1;
    if (fabs(x->imaginary) != fabs(y->imaginary))
        return fabs(x->imaginary) < fabs(y->imaginary) ? -1 : 1;
    return (x->imaginary < y->imaginary) - (x->imaginary > y->imaginary);
}

static void sort_part(Spectrum *s, const SpectrumPart *part)
{
    for (int i = part->first + 1; i < part->first + part->size; i++)
        for (int k = i; k > part->first && by_place(&s->root[k - 1], &s->root[k]) > 0; k--) {
            const Root root = s->root[k];
            const double complex value = s->value[k];
            const int column = s->column[k];

            s->root[k] = s->root[k - 1];
            s->value[k] = s->value[k - 1];
            s->column[k] = s->column[k - 1];
            s->root[k - 1] = root;
            s->value[k - 1] = value;
            s->column[k - 1] = column;
        }
}

Spectrum *spectrum_new(const double *a, const double *error, int n)
{
    Spectrum *s = NEW(Spectrum);
    bool *pattern = NEW_ARRAY(bool, n *n);
    bool sound = true;

    s->n = n;
    s->a = NEW_ARRAY(double, n *n);
    s->root = NEW_ARRAY(Root, n);
    s->value = mem_array((size_t)n, sizeof *s->value);
    s->column = NEW_ARRAY(int, n);
    s->part_of = NEW_ARRAY(int, n);
    for (int i = 0; i < n * n; i++) {
        s->a[i] = a[i];
        pattern[i] = a[i] != 0 || error[i] != 0;
        sound = sound && isfinite(a[i]) && isfinite(error[i]);
    }
    s->blocks = block_triangular_find(pattern, n);
    s->part = NEW_ARRAY(SpectrumPart, s->blocks.count);
    for (int b = 0; b < s->blocks.count && sound; b++) {
        sound = fill_part(s, error, b, s->blocks.start[b]);
        if (sound)
            sort_part(s, &s->part[b]);
    }
    mem_free(pattern);
    if (sound)
        return s;
    spectrum_free(s);
    return NULL;
}

void spectrum_free(Spectrum *spectrum)
{
    if (spectrum == NULL)
        return;
    for (int b = 0; b < spectrum->blocks.count; b++) {
        MEM_FREE(spectrum->part[b].right, spectrum->part[b].left, spectrum->part[b].error);
    }
    block_triangular_free(&spectrum->blocks);
    MEM_FREE(spectrum->part, spectrum->a, spectrum->root, spectrum->value, spectrum->column,
             spectrum->part_of, spectrum);
}

const Root *spectrum_roots(const Spectrum *spectrum)
{
    return spectrum->root;
}

/* --- vectors --- */

static void shrink(DoubleDoubleComplex *x, int n)
{
    double largest = 0;

    for (int i = 0; i < n; i++)
        largest = fmax(largest, dd_size(x[i]));
    if (largest > 0 && isfinite(largest))
        for (int i = 0; i < n; i++)
            x[i] = dd_ctimes(x[i], dd_of(ldexp(1, -ilogb(largest))));
}

/* Extend x to a block on which that of root k acts: (lambda - A) x = the coupling terms. */
static void carry_on(const Spectrum *s, const SpectrumPart *part, int k, DoubleDoubleComplex *x)
{
    const int m = part->size;
    DoubleDoubleComplex *force = NEW_ARRAY(DoubleDoubleComplex, m);
    bool moves = false;

    for (int i = 0; i < m; i++)
        for (int j = 0; j < s->n; j++)
            if (dd_size(x[j]) > 0 && s->a[part->state[i] * s->n + j] != 0) {
                force[i] =
                    dd_cadd(force[i], dd_ctimes(x[j], dd_of(s->a[part->state[i] * s->n + j])));
                moves = true;
            }
    for (int r = 0; r < m && moves; r++) {
        const int other = part->first + r, column = s->column[other];
        const double least = fmax(fmax(s->root[k].error + s->root[other].error, 1e-100),
                                  UNIT_ROUNDOFF * cabs(s->value[k]));
        const double complex off = s->value[k] - s->value[other];
        DoubleDoubleComplex share = dd_real(dd_of(0));

        for (int i = 0; i < m; i++)
            share = dd_cadd(share, dd_cmul(part->left[column * m + i], force[i]));
        share = dd_cdiv(share, dd_from(cabs(off) > least ? off : least));
        for (int i = 0; i < m; i++)
            x[part->state[i]] =
                dd_cadd(x[part->state[i]], dd_cmul(part->right[i * m + column], share));
    }
    if (moves)
        shrink(x, s->n);
    mem_free(force);
}

void spectrum_vector(const Spectrum *s, int k, double complex *out)
{
    const SpectrumPart *own = &s->part[s->part_of[k]];
    DoubleDoubleComplex *x = NEW_ARRAY(DoubleDoubleComplex, s->n);

    for (int i = 0; i < own->size; i++)
        x[own->state[i]] = own->right[i * own->size + s->column[k]];
    for (int b = s->part_of[k] + 1; b < s->blocks.count; b++)
        carry_on(s, &s->part[b], k, x);
    for (int i = 0; i < s->n; i++)
        out[i] = dd_to(x[i]);
    mem_free(x);
}
