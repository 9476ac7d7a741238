/* modes.c: eigenvalues of linear equations, and the motion of all parts in each mode
 *
 * Where M, K and C are known, in modal coordinates: without damping and gyroscopic terms the
 * eigenvalues are +-i sqrt of those of M^-1 K; otherwise they are those of a matrix that is nearly
 * decoupled. A conjugate pair is one mode. The eigenvector moves every coordinate, dependent ones
 * too. */
#include "simulate/analyse/linearize.h"

#include "algebra/modal.h"
#include "algebra/spectrum.h"
#include "base/memory.h"
#include "simulate/analyse/analyse_limits.h"

#include <math.h>
#include <string.h>

/* amplitudes and phases relative to the largest part, the first of equal ones */
static void scale_shape(Mode *mode, int parts)
{
    double largest = 0, turn = 0;

    for (int p = 0; p < parts; p++)
        largest = fmax(largest, mode->amplitude[p]);
    for (int p = parts - 1; p >= 0; p--)
        if (mode->amplitude[p] >= (1 - MODE_SAME) * largest)
            turn = mode->phase[p];
    for (int p = 0; p < parts && largest > 0; p++) {
        mode->amplitude[p] /= largest;
        mode->phase[p] = remainder(mode->phase[p] - turn, 2 * M_PI);
        /* slightly more or less than half a turn counts as half a turn */
        if (mode->phase[p] < -M_PI + MODE_SAME || mode->amplitude[p] == 0)
            mode->phase[p] = mode->amplitude[p] == 0 ? 0 : M_PI;
    }
}

static void fill_mode(const Linear *linear, const Root *root, const double complex *vector,
                      Mode *mode)
{
    mode->real = root->real;
    mode->imaginary = root->imaginary;
    mode->omega = hypot(mode->real, mode->imaginary);
    mode->damping = mode->omega > 0 ? -mode->real / mode->omega + 0.0 : 0;
    mode->error = root->error;
    mode->is_doubtful = root_is_doubtful(root);
    mode->amplitude = NEW_ARRAY(double, linear->parts);
    mode->phase = NEW_ARRAY(double, linear->parts);
    for (int p = 0; p < linear->parts; p++) {
        double complex sum = 0;

        for (int s = 0; s < linear->states; s++)
            sum += vector[s] * linear->motion[p * linear->states + s];
        mode->amplitude[p] = cabs(sum);
        mode->phase[p] = mode->amplitude[p] > 0 ? carg(sum) : 0;
    }
    scale_shape(mode, linear->parts);
}

static int by_omega(const void *a, const void *b)
{
    const Mode *x = a, *y = b;

    if (fabs(x->omega - y->omega) > 1e-9 * (x->omega + y->omega))
        return x->omega < y->omega ? -1 : 1;
    if (fabs(x->damping - y->damping) > 1e-9)
        return x->damping < y->damping ? -1 : 1;
    return 0;
}

/* by insertion, which is stable */
static void sort(Modes *modes)
{
    for (int i = 1; i < modes->count; i++) {
        Mode kept = modes->at[i];
        int k = i;

        for (; k > 0 && by_omega(&modes->at[k - 1], &kept) > 0; k--)
            modes->at[k] = modes->at[k - 1];
        modes->at[k] = kept;
    }
}

/* --- in modal coordinates --- */

/* a block of a matrix with rows `stride` apart, times `sign`; new */
static BoundedMatrix take_block(const double *at, const double *error, int stride, int rows,
                                int columns, double sign)
{
    double *out = NEW_ARRAY(double, rows *columns), *out_error = NEW_ARRAY(double, rows *columns);

    for (int i = 0; i < rows; i++)
        for (int k = 0; k < columns; k++) {
            out[i * columns + k] = sign * at[i * stride + k];
            out_error[i * columns + k] = error[i * stride + k];
        }
    return (BoundedMatrix){out, out_error};
}

/* columns of the rows before solving with M, times `sign` */
static BoundedMatrix take_columns(const Linear *linear, int first, int count, double sign)
{
    return take_block(linear->force + first, linear->force_error + first, linear->states,
                      linear->freedoms, count, sign);
}

/* columns of the networks' rows of A */
static BoundedMatrix network_columns(const Linear *linear, int first, int count)
{
    const int above = 2 * linear->freedoms, at = above * linear->states + first;

    return take_block(linear->a + at, linear->a_error + at, linear->states, linear->states - above,
                      count, 1);
}

static void free_matrix(BoundedMatrix m)
{
    mem_free((void *)m.at);
    mem_free((void *)m.error);
}

static Modal *modal_of(const Linear *linear, BoundedMatrix stiffness)
{
    const int f = linear->freedoms;
    const BoundedMatrix damping = take_columns(linear, f, f, -1);
    Modal *modal =
        modal_new((BoundedMatrix){linear->mass, linear->mass_error}, stiffness, &damping, f);

    free_matrix(damping);
    return modal;
}

/* whether the equations are M s'' + K s = 0 with a symmetric K, within errors of entries */
static bool is_conservative(const Linear *linear, BoundedMatrix stiffness)
{
    const int f = linear->freedoms;

    if (linear->states != 2 * f)
        return false;
    for (int i = 0; i < f; i++)
        for (int k = 0; k < f; k++) {
            const int at = i * f + k, across = k * f + i;

            if (linear->force[i * linear->states + f + k] != 0 ||
                linear->force_error[i * linear->states + f + k] != 0 ||
                !(fabs(stiffness.at[at] - stiffness.at[across]) <=
                  stiffness.error[at] + stiffness.error[across]))
                return false;
        }
    return true;
}

/* A root of s^2 = -square, which is known to `error`; `count` roots are within each other's
 * errors. */
static Root root_of_square(double square, double error, int count)
{
    const double size = fabs(square);
    Root root = {0};

    if (size <= error) {
        root.error = sqrt(size + error);
        root.is_on_axis = root.error == 0;
        return root;
    }
    if (square > 0)
        root.imaginary = sqrt(square);
    else
        root.real = sqrt(-square);
    /* sqrt(size) - sqrt(size - error), and its rounding */
    root.error = error / (sqrt(size) + sqrt(size - error)) + 0x1p-52 * sqrt(size);
    /* a single one is real, as is its square: its conjugate would be in its disc too */
    root.is_on_axis = square > 0 && count == 1;
    return root;
}

/* both roots of each eigenvalue of M^-1 K; false where they are not finite */
static bool push_conservative(const Linear *linear, const Modal *modal, Modes *modes)
{
    const int f = linear->freedoms;
    int *group = NEW_ARRAY(int, f), *count = NEW_ARRAY(int, f);
    double *mean = NEW_ARRAY(double, f), *error = NEW_ARRAY(double, f);
    double complex *vector = mem_array((size_t)linear->states, sizeof *vector);
    const bool sound = modal_groups(modal, group, mean, error);

    for (int k = 0; k < f; k++)
        count[group[k]]++;
    for (int k = 0; k < f && sound; k++) {
        Root root = root_of_square(mean[k], error[k], count[group[k]]);

        /* without stiffness a coordinate is a mode by itself */
        for (int i = 0; i < f; i++)
            vector[i] = modal->is_still[k] ? i == k : modal->vector[i * f + k];
        fill_mode(linear, &root, vector, &modes->at[modes->count++]);
        if (root.imaginary != 0)
            continue;
        root.real = -root.real + 0.0;
        fill_mode(linear, &root, vector, &modes->at[modes->count++]);
    }
    MEM_FREE(group, count, mean, error, vector);
    return sound;
}

/* a matrix of all states, with bounds of its entries' errors */
typedef struct StateMatrix {
    int n;
    double *at, *error;
} StateMatrix;

static void put_block(const StateMatrix *m, int row, int column, int rows, int columns,
                      const double *at, const double *error)
{
    for (int i = 0; i < rows; i++)
        for (int k = 0; k < columns; k++) {
            m->at[(row + i) * m->n + column + k] = at[i * columns + k];
            m->error[(row + i) * m->n + column + k] = error[i * columns + k];
        }
}

/* rows x f times X, stored at its position */
static void put_moved(const StateMatrix *m, const Modal *modal, BoundedMatrix b, int rows, int row,
                      int column)
{
    double *at = NEW_ARRAY(double, rows * modal->n), *error = NEW_ARRAY(double, rows * modal->n);

    modal_move(modal, b, rows, at, error);
    put_block(m, row, column, rows, modal->n, at, error);
    MEM_FREE(at, error);
}

/* A for s = X times modal coordinates */
static StateMatrix modal_matrix(const Linear *linear, const Modal *modal)
{
    const int f = linear->freedoms, n = linear->states, nets = n - 2 * f;
    const StateMatrix m = {n, NEW_ARRAY(double, n *n), NEW_ARRAY(double, n *n)};
    const BoundedMatrix damping = take_columns(linear, f, f, 1);
    const BoundedMatrix effort = take_columns(linear, 2 * f, nets, 1);
    const BoundedMatrix own = network_columns(linear, 2 * f, nets);
    const int most = f > nets ? f : nets;
    double *moved = NEW_ARRAY(double, f *f), *moved_error = NEW_ARRAY(double, f *f);
    double *at = NEW_ARRAY(double, f *most), *error = NEW_ARRAY(double, f *most);

    for (int i = 0; i < f; i++) {
        m.at[i * n + f + i] = 1;
        for (int k = 0; k < f; k++) {
            m.at[(f + i) * n + k] = i == k ? -modal->square[i] : -modal->off[i * f + k];
            m.error[(f + i) * n + k] = modal->error[i * f + k];
        }
    }
    modal_move(modal, damping, f, moved, moved_error);
    modal_transform(modal, (BoundedMatrix){moved, moved_error}, f, at, error);
    put_block(&m, f, f, f, f, at, error);
    modal_transform(modal, effort, nets, at, error);
    put_block(&m, f, 2 * f, f, nets, at, error);
    free_matrix(damping);
    free_matrix(effort);
    for (int part = 0; part < 2; part++) {
        const BoundedMatrix b = network_columns(linear, part * f, f);

        put_moved(&m, modal, b, nets, 2 * f, part * f);
        free_matrix(b);
    }
    put_block(&m, 2 * f, 2 * f, nets, nets, own.at, own.error);
    free_matrix(own);
    MEM_FREE(moved, moved_error, at, error);
    return m;
}

/* coordinates and speeds from modal ones */
static void leave_modal(const Modal *modal, double complex *vector)
{
    const int f = modal->n;
    double complex *out = mem_array(2 * (size_t)f, sizeof *out);

    for (int part = 0; part < 2; part++)
        for (int i = 0; i < f; i++)
            for (int k = 0; k < f; k++)
                out[part * f + i] += modal->vector[i * f + k] * vector[part * f + k];
    memcpy(vector, out, 2 * (size_t)f * sizeof *out);
    mem_free(out);
}

/* eigenvalues of a matrix of all states, in modal coordinates or (NULL) in those of `linear`;
 * false: they can't be found */
static bool push_spectrum(const Linear *linear, const Modal *modal, const double *a,
                          const double *error, Modes *modes)
{
    Spectrum *spectrum = spectrum_new(a, error, linear->states);
    double complex *vector = mem_array((size_t)linear->states, sizeof *vector);
    const bool sound = spectrum != NULL;

    for (int k = 0; k < linear->states && sound; k++) {
        const Root *root = &spectrum_roots(spectrum)[k];

        if (root->imaginary < 0)
            continue;
        spectrum_vector(spectrum, k, vector);
        if (modal != NULL)
            leave_modal(modal, vector);
        fill_mode(linear, root, vector, &modes->at[modes->count++]);
    }
    spectrum_free(spectrum);
    mem_free(vector);
    return sound;
}

static bool push_modal(const Linear *linear, const Modal *modal, Modes *modes)
{
    const StateMatrix m = modal_matrix(linear, modal);
    const bool sound = push_spectrum(linear, modal, m.at, m.error, modes);

    MEM_FREE(m.at, m.error);
    return sound;
}

/* --- modes --- */

static bool push_all(const Linear *linear, Modes *modes)
{
    BoundedMatrix stiffness;
    Modal *modal;
    bool sound;

    if (linear->mass == NULL || linear->freedoms == 0)
        return push_spectrum(linear, NULL, linear->a, linear->a_error, modes);
    stiffness = take_columns(linear, 0, linear->freedoms, -1);
    modal = modal_of(linear, stiffness);
    if (modal == NULL)
        sound = push_spectrum(linear, NULL, linear->a, linear->a_error, modes);
    else if (is_conservative(linear, stiffness))
        sound = push_conservative(linear, modal, modes);
    else
        sound = push_modal(linear, modal, modes);
    modal_free(modal);
    free_matrix(stiffness);
    return sound;
}

Status modes_find(const Linear *linear, Modes **out, Diag *diag)
{
    Modes *modes = NEW(Modes);
    Status status = OK;

    modes->parts = linear->parts;
    modes->at = NEW_ARRAY(Mode, linear->states);
    modes->part_names = NEW_ARRAY(char *, linear->parts);
    for (int p = 0; p < linear->parts; p++)
        modes->part_names[p] = mem_text(linear->part_names[p], strlen(linear->part_names[p]));
    if (!push_all(linear, modes))
        CHECK(diag_set(diag, E_SOLVER, "the eigenvalues can't be found"));
    sort(modes);
    *out = modes;
    modes = NULL;
done:
    modes_free(modes);
    return status;
}

void modes_free(Modes *modes)
{
    if (modes == NULL)
        return;
    for (int i = 0; i < modes->count; i++) {
        MEM_FREE(modes->at[i].amplitude, modes->at[i].phase);
    }
    for (int p = 0; p < modes->parts; p++)
        mem_free(modes->part_names[p]);
    MEM_FREE(modes->at, modes->part_names, modes);
}
