/* freedoms.c: compares the admissible motions for two trees
 *
 * The columns of the null space of Phi_u (m x nu) are the admissible speeds. The angular velocities
 * of one frame relative to another along them span its possible rotations. A rotation with the real
 * joints that is outside the span of those with the virtual joints is lost. */
#include "simulate/analyse/freedoms.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/text.h"
#include "simulate/analyse/analyse_limits.h"
#include "simulate/run/result_reader_impl.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct Turning {
    double at[3]; /* axes of the datum */
} Turning;
typedef LIST(Turning) Turnings;

/* admissible speeds in the initial state: freedoms x nu, row by row; new */
static double *find_motions(ResultReader *reader)
{
    const Equations *eq = compiled_equations(result_reader_first(reader)->numbers);
    const Assembled *start = &reader->result->start;
    const int nu = eq->nu, m = eq->m, rank = start->row_count;
    double *motions = NEW_ARRAY(double, (nu - rank) * nu);
    gsl_matrix *rows;
    gsl_vector *tau;
    double *phi_u;

    for (int i = 0; i < nu - rank; i++)
        motions[i * nu + rank + i] = 1;
    if (rank == 0)
        return motions;
    eq->position(eq->context, 0, start->y);
    phi_u = pattern_spread(eq->rows, eq->phi_u);
    rows = dense_matrix((size_t)nu, (size_t)rank);
    tau = dense_vector((size_t)rank);
    for (int k = 0; k < rank && k < m; k++)
        for (int j = 0; j < nu; j++)
            gsl_matrix_set(rows, (size_t)j, (size_t)k, phi_u[start->rows[k] * nu + j]);
    mem_free(phi_u);
    (void)gsl_linalg_QR_decomp(rows, tau);
    for (int i = 0; i < nu - rank; i++) {
        gsl_vector_view motion = gsl_vector_view_array(motions + (ptrdiff_t)i * nu, (size_t)nu);

        (void)gsl_linalg_QR_Qvec(rows, tau, &motion.vector);
    }
    MEM_FREE(rows, tau);
    return motions;
}

/* the components of angular velocity of a frame, axes of the datum; 0 where a frame has none */
static void angular_velocity(ResultReader *reader, const char *frame, Expr out[3])
{
    static const char *const members[] = {"wx", "wy", "wz"};
    Diag ignored;

    for (int i = 0; i < 3; i++) {
        char name[300];

        (void)snprintf(name, sizeof name, "%s.%s", frame, members[i]);
        /* ground has none, and in a plane only the last exists */
        if (strcmp(frame, "ground") == 0 ||
            system_variable(reader->result->system, name, 0, &out[i], &ignored) != OK)
            out[i] = expr_int(system_arena(reader->result->system), 0);
    }
}

/* angular velocity of the head relative to the tail along each admissible motion */
static Status find_turnings(ResultReader *reader, const char *tail, const char *head, Turnings *out,
                            Diag *diag)
{
    const VariableIndex *l = result_reader_first(reader)->layout;
    double *motions = find_motions(reader);
    Probe *probe = NULL;
    Expr roots[3], of_tail[3];
    Status status;

    angular_velocity(reader, head, roots);
    angular_velocity(reader, tail, of_tail);
    for (int i = 0; i < 3; i++)
        roots[i] = expr_sub(system_arena(reader->result->system), roots[i], of_tail[i]);
    CHECK(probe_new(l, &reader->phases->parameters, roots, 3, &probe, diag));
    for (int i = 0; i < result_freedoms(reader->result); i++) {
        const RowValues row = {.q = reader->result->start.y, .u = motions + (ptrdiff_t)i * l->nu};
        const double *values = probe_values(probe, &row);

        LIST_PUSH(*out, (Turning){{values[0], values[1], values[2]}});
    }
done:
    probe_free(probe);
    mem_free(motions);
    return status;
}

/* subtract from a its components along an orthonormal basis; returns the norm of the rest */
static double reduce(double a[3], const Turning *basis, int count)
{
    for (int b = 0; b < count; b++) {
        double along = 0;

        for (int i = 0; i < 3; i++)
            along += a[i] * basis[b].at[i];
        for (int i = 0; i < 3; i++)
            a[i] -= along * basis[b].at[i];
    }
    return hypot(hypot(a[0], a[1]), a[2]);
}

/* the rotation that is possible in `real` and not in `with`, of unit size; false: there is none */
static bool find_lost(const Turnings *real, const Turnings *with, double out[3])
{
    Turning basis[3];
    int count = 0;
    double largest = FREEDOM_LOST;

    for (int i = 0; i < with->count && count < 3; i++) {
        Turning t = with->at[i];
        double size = reduce(t.at, basis, count);

        if (size < FREEDOM_LOST)
            continue;
        for (int k = 0; k < 3; k++)
            t.at[k] /= size;
        basis[count++] = t;
    }
    for (int i = 0; i < real->count; i++) {
        Turning t = real->at[i];
        double size = reduce(t.at, basis, count);

        for (int k = 0; size > largest && k < 3; k++)
            out[k] = t.at[k] / size;
        largest = fmax(largest, size);
    }
    return largest > FREEDOM_LOST;
}

/* "x", or "[0, 0.6, 0.8]" */
static void name_axis(const double axis[3], Text *out)
{
    for (int i = 0; i < 3; i++)
        if (fabs(axis[i]) > 1 - 1e-9) {
            text_char(out, "xyz"[i]);
            return;
        }
    text_addf(out, "[%.3g, %.3g, %.3g]", axis[0] + 0.0, axis[1] + 0.0, axis[2] + 0.0);
}

Status freedoms_compare(ResultReader *real, ResultReader *with, const Instance *const *joints,
                        const char *const (*frames)[2], int count, Diag *diag)
{
    const int lost = result_freedoms(real->result) - result_freedoms(with->result);
    Text axis = {0};
    Status status = OK;

    if (lost <= 0)
        return OK;
    for (int j = 0; j < count; j++) {
        Turnings before = {0}, after = {0};
        double turn[3] = {0};
        bool found = find_turnings(real, frames[j][0], frames[j][1], &before, diag) == OK &&
                     find_turnings(with, frames[j][0], frames[j][1], &after, diag) == OK &&
                     find_lost(&before, &after, turn);

        LIST_FREE(before);
        LIST_FREE(after);
        if (!found)
            continue;
        name_axis(turn, &axis);
        status = diag_set(diag, E_BRANCH,
                          "%s can also turn about %s (ground axes) against %s; %s does not cover "
                          "that",
                          frames[j][1], axis.at, frames[j][0], joints[j]->name);
        diag_hint(diag, "a virtual joint with that freedom does; tree - %s makes it a chord",
                  joints[j]->name);
        text_free(&axis);
        return status;
    }
    status = diag_set(diag, E_BRANCH, "%s takes away %d of %d freedoms", joints[0]->name, lost,
                      result_freedoms(real->result));
    diag_hint(diag, "tree - %s makes it a chord", joints[0]->name);
    return status;
}
