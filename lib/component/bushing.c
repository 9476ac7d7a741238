/* bushing.c: stiffness and damping between two frames, in every direction
 *
 * x holds the coordinates of the head in axes of the tail: x, y, z (m) and the components of the
 * rotation vector (rad), in the plane x, y and the angle. The efforts along x are -K x - D x', the
 * energy stored is x . K x/2. Their moment follows from the rotation vector; see bushings.c of
 * formulate. Values are the diagonal, or the matrix row by row. */
#include "component/component_rows.h"

#include <math.h>

/* clang-format off */
static const Param params[] = {
    {"k", PARAM_LIST, NULL, "", "stiffness along x, y, z (N/m) and about them (N*m/rad), planar [kx, ky, kaz]; or the matrix, row by row", 0},
    {"d", PARAM_LIST, NULL, "", "damping likewise, per rate", 0},
};
/* clang-format on */

/* entry i, j of the matrix that a value gives; 0 where there is none */
static Expr entry(const Value *value, Arena *arena, int count, int i, int j)
{
    if (value->count == count * count)
        return value->at[i * count + j];
    return i == j && value->count == count ? value->at[i] : expr_int(arena, 0);
}

/* row i of the matrix times a vector */
static Expr row_times(const Value *value, Arena *arena, int count, int i, const Expr *vector)
{
    Expr term[MOST_RELATIVE];

    for (int j = 0; j < count; j++)
        term[j] = expr_mul(arena, entry(value, arena, count, i, j), vector[j]);
    return expr_sum(arena, term, count);
}

static Expr restore(const Instance *instance, Arena *arena, int count, const Expr *x,
                    const Expr *rate, Expr *effort, Expr *lost)
{
    const Value *k = instance_value(instance, "k"), *d = instance_value(instance, "d");
    Expr stored[MOST_RELATIVE];

    for (int i = 0; i < count; i++) {
        const Expr pull = row_times(k, arena, count, i, x);

        lost[i] = expr_neg(arena, row_times(d, arena, count, i, rate));
        effort[i] = expr_sub(arena, lost[i], pull);
        stored[i] = expr_mul(arena, x[i], pull);
    }
    return expr_mul(arena, expr_rational(arena, 1, 2), expr_sum(arena, stored, count));
}

static Status refuse(Diag *diag, const char *param, const char *message, const char *hint)
{
    const Status status = diag_set(diag, E_VALUE, "%s= %s", param, message);

    diag_hint(diag, "%s", hint);
    diag_about(diag, "%s", param);
    return status;
}

static bool are_numbers(const Value *value)
{
    for (int i = 0; i < value->count; i++)
        if (!expr_is_number(value->at[i]))
            return false;
    return true;
}

static Status check_symmetry(const char *param, int count, double m[MOST_RELATIVE][MOST_RELATIVE],
                             Diag *diag)
{
    for (int i = 0; i < count; i++)
        for (int j = 0; j < i; j++)
            if (m[i][j] != m[j][i]) {
                const Status status =
                    diag_set(diag, E_VALUE,
                             "%s= isn't symmetric: entries %d,%d and %d,%d are %g "
                             "and %g",
                             param, i + 1, j + 1, j + 1, i + 1, m[i][j], m[j][i]);

                diag_hint(diag, "a matrix that isn't would make energy of motion to and fro");
                diag_about(diag, "%s", param);
                return status;
            }
    return OK;
}

/* Pivots of a symmetric elimination: none is below 0, and the row of a 0 has zeros alone. */
static bool is_semidefinite(int count, double m[MOST_RELATIVE][MOST_RELATIVE])
{
    const double rounding = 1e-12;
    double whole[MOST_RELATIVE];

    for (int i = 0; i < count; i++)
        whole[i] = m[i][i];
    for (int p = 0; p < count; p++) {
        const bool is_zero = fabs(m[p][p]) <= rounding * fabs(whole[p]);

        if (!is_zero && m[p][p] < 0)
            return false;
        for (int i = p + 1; i < count; i++) {
            if (is_zero && fabs(m[i][p]) > rounding * sqrt(fabs(whole[i] * whole[p])))
                return false;
            for (int j = p + 1; j < count && !is_zero; j++)
                m[i][j] -= m[i][p] * m[p][j] / m[p][p];
        }
    }
    return true;
}

static Status check_matrix(const Instance *instance, Arena *arena, const char *param, int count,
                           Diag *diag)
{
    const Value *value = instance_value(instance, param);
    double m[MOST_RELATIVE][MOST_RELATIVE];

    if (!value->given)
        return OK;
    if (value->count != count && value->count != count * count)
        return refuse(diag, param,
                      count == MOST_RELATIVE ? "has 6 values, or a matrix of 36"
                                             : "has 3 values in a planar scene, or a matrix of 9",
                      count == MOST_RELATIVE
                          ? "[kx, ky, kz, kax, kay, kaz]: along and about the axes of the tail"
                          : "[kx, ky, kaz]: along the axes of the tail, and about z");
    if (!are_numbers(value))
        return OK;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++)
            m[i][j] = expr_value(entry(value, arena, count, i, j));
    TRY(check_symmetry(param, count, m, diag));
    if (param[0] == 'd' && !is_semidefinite(count, m))
        return refuse(diag, param, "would feed energy into some motion",
                      "the matrix of a damper has no eigenvalue below 0");
    return OK;
}

static Status check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    const int count = planar ? 3 : MOST_RELATIVE;

    if (!instance_value(instance, "k")->given && !instance_value(instance, "d")->given)
        return refuse(diag, "k", "or d= is missing",
                      planar ? "k=[kx, ky, kaz]" : "k=[kx, ky, kz, kax, kay, kaz]");
    TRY(check_matrix(instance, arena, "k", count, diag));
    return check_matrix(instance, arena, "d", count, diag);
}

const Component component_bushing = {
    .name = "bushing",
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "springs and dampers along and about all axes between two frames",
    .params = params,
    .param_count = COUNT(params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 95,
    .restore = restore,
    .check = check,
    .help =
        "Resists every motion of the tip against the tail; it is relaxed where the two frames "
        "coincide. The coordinates are the position of the tip in axes of the tail, and the "
        "rotation vector: the angle of the turn times its axis. The effort along each is -(k*x + "
        "d*x'), the energy stored k*x^2/2. The rotation vector is smooth below half a turn. There "
        "it jumps to the opposite turn, and the moment with it: a run that comes near is reported. "
        "In a planar scene the angle is any number of turns. A matrix, row by row, couples the "
        "directions; it is symmetric.",
    .example = "gravity [0, 0, -9.81]\nbody m1 mass=2 inertia=[0.01, 0.02, 0.02]\n"
               "bushing b1 ground m1 k=[5e3, 5e3, 2e3, 10, 10, 4] d=[20, 20, 10, 0.1, 0.1, 0]\n"
               "init m1.y = 5 mm\nsimulate 0.5\nprint m1.z, b1.Fz, b1.Tx\n"
               "equilibrium\nprint m1.z, b1.fz",
    .see = "spring damper weld",
};
