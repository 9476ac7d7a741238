/* redundant.c: which joints a dependent constraint row repeats
 *
 * A dependent row of Phi_u is a linear combination of the independent ones; it repeats the joints
 * of those with a share in it. Rows are scaled to unit size first. */
#include "simulate/equations/redundant.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "simulate/equations/equations_limits.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>

static double size_of(const double *row, int nu)
{
    double size = 0;

    for (int j = 0; j < nu; j++)
        size = hypot(size, row[j]);
    return size;
}

/* Shares of the independent rows in the others: (m - rank) x rank. */
static void find_shares(const double *phi_u, int m, int nu, const int *order, int rank,
                        double *shares)
{
    gsl_matrix *rows = dense_matrix((size_t)nu, (size_t)rank);
    gsl_vector *tau = dense_vector((size_t)rank);
    gsl_vector *row = dense_vector((size_t)nu);
    gsl_vector *residual = dense_vector((size_t)nu);

    for (int i = 0; i < rank; i++) {
        const double *from = phi_u + (ptrdiff_t)order[i] * nu;
        double size = size_of(from, nu);

        for (int j = 0; j < nu; j++)
            gsl_matrix_set(rows, (size_t)j, (size_t)i, from[j] / size);
    }
    (void)gsl_linalg_QR_decomp(rows, tau);
    for (int k = rank; k < m; k++) {
        const double *from = phi_u + (ptrdiff_t)order[k] * nu;
        double size = size_of(from, nu);
        gsl_vector_view share =
            gsl_vector_view_array(shares + (ptrdiff_t)(k - rank) * rank, (size_t)rank);

        for (int j = 0; j < nu; j++)
            gsl_vector_set(row, (size_t)j, size > 0 ? from[j] / size : 0);
        (void)gsl_linalg_QR_lssolve(rows, tau, row, &share.vector, residual);
    }
    MEM_FREE(rows, tau, row, residual);
}

/* the joints that the rows of one joint repeat, each once */
static void name_repeated(const System *system, const int *order, int rank, const double *shares,
                          int joint, Text *out)
{
    const int m = system_m(system);
    bool *named = NEW_ARRAY(bool, m);
    int count = 0;

    for (int i = 0; i < rank; i++) {
        const int other = system_constraint(system, order[i])->instance;
        bool takes_part = false;

        for (int k = rank; k < m; k++)
            takes_part = takes_part || (system_constraint(system, order[k])->instance == joint &&
                                        fabs(shares[(k - rank) * rank + i]) > REDUNDANT_PART);
        for (int before = 0; before < i; before++)
            takes_part =
                takes_part &&
                !(named[before] && system_constraint(system, order[before])->instance == other);
        if (!takes_part || other == joint)
            continue;
        named[i] = true;
        text_addf(out, count++ > 0 ? ", %s" : "%s", system_instance_name(system, other));
    }
    mem_free(named);
}

void redundant_remark(const System *system, const double *phi_u, const int *order, int rank,
                      Remarks *out)
{
    const int m = system_m(system), nu = system_nu(system);
    double *shares = NEW_ARRAY(double, (m - rank) * rank);
    bool *is_merged = NEW_ARRAY(bool, m);

    if (rank > 0)
        find_shares(phi_u, m, nu, order, rank, shares);
    for (int k = rank; k < m; k++) {
        const int joint = system_constraint(system, order[k])->instance;
        Text directions = {0}, repeated = {0};

        if (is_merged[k])
            continue;
        for (int same = k; same < m; same++) {
            const ConstraintRow *row = system_constraint(system, order[same]);

            if (row->instance != joint)
                continue;
            is_merged[same] = true;
            text_addf(&directions, same > k ? ", %s" : "%s", row->direction);
        }
        name_repeated(system, order, rank, shares, joint, &repeated);
        remarks_add(out, (Remark){.kind = REMARK_REDUNDANT,
                                  .what = system_instance_name(system, joint),
                                  .more = directions.at,
                                  .others = repeated.at});
        text_free(&directions);
        text_free(&repeated);
    }
    remarks_add(out, (Remark){.kind = REMARK_UNDETERMINED, .count = nu - rank});
    MEM_FREE(is_merged, shares);
}
