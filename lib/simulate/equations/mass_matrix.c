/* mass_matrix.c: forces and moments passed on towards the datum, column by column
 *
 * f, t: force and moment on a place, in its axes; r its step from its parent, R the rotation to the
 * axes of that. What a place passes on is R f and R (t + r x f). */
#include "simulate/equations/mass_matrix.h"

#include "base/memory.h"

#include <string.h>

typedef struct Share {
    int at;     /* in M */
    int number; /* which of the needs */
} Share;

struct MassMatrix {
    const CompositeMass *mass;
    LIST(Share) shares;
    LIST(Expr) needs;
    double *at; /* M */
};

MassMatrix *mass_matrix_new(const System *system)
{
    const CompositeMass *mass = system_composite_mass(system);
    MassMatrix *matrix;
    const Entry *share;

    if (mass == NULL)
        return NULL;
    matrix = NEW(MassMatrix);
    matrix->mass = mass;
    for (int i = 0; i < mass->needs.count; i++)
        LIST_PUSH(matrix->needs, mass->needs.at[i]);
    for (int i = 0; (share = system_mass_share(system, i)) != NULL; i++) {
        LIST_PUSH(matrix->shares,
                  (Share){share->row * mass->speed_count + share->column, matrix->needs.count});
        LIST_PUSH(matrix->needs, share->value);
    }
    matrix->at = NEW_ARRAY(double, (size_t)mass->speed_count *(size_t)mass->speed_count);
    return matrix;
}

void mass_matrix_free(MassMatrix *matrix)
{
    if (matrix == NULL)
        return;
    LIST_FREE(matrix->shares);
    LIST_FREE(matrix->needs);
    mem_free(matrix->at);
    mem_free(matrix);
}

const Expr *mass_matrix_needs(const MassMatrix *matrix, int *count)
{
    *count = matrix->needs.count;
    return matrix->needs.at;
}

/* --- in numbers --- */

static inline double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void add_cross(double *sum, const double *a, const double *b)
{
    sum[0] += a[1] * b[2] - a[2] * b[1];
    sum[1] += a[2] * b[0] - a[0] * b[2];
    sum[2] += a[0] * b[1] - a[1] * b[0];
}

static inline void turn(const double *R, double *v)
{
    const double x = v[0], y = v[1], z = v[2];

    for (int i = 0; i < 3; i++)
        v[i] = R[3 * i] * x + R[3 * i + 1] * y + R[3 * i + 2] * z;
}

static inline void put_pair(MassMatrix *matrix, int j, int k, double value)
{
    const int n = matrix->mass->speed_count;

    matrix->at[j * n + k] = matrix->at[k * n + j] = value;
}

static void column(MassMatrix *matrix, const double *numbers, int k)
{
    const CompositeMass *mass = matrix->mass;
    const MassSpeed *own = &mass->speeds[k];
    double f[3], t[3];

    memcpy(f, numbers + own->force, sizeof f);
    memcpy(t, numbers + own->torque, sizeof t);
    for (int p = own->place; p >= 0; p = mass->places[p].parent) {
        const MassPlace *place = &mass->places[p];

        if (place->has_step && place->is_inner)
            add_cross(t, numbers + place->step, f);
        for (int i = place->first; i < place->first + place->count; i++) {
            const int j = mass->speed_at[i];

            /* those of one place stand in the column of the later one */
            if (p != own->place || j <= k)
                put_pair(matrix, j, k,
                         dot(numbers + mass->speeds[j].turn, t) +
                             dot(numbers + mass->speeds[j].slide, f));
        }
        if (place->has_step && !place->is_inner)
            add_cross(t, numbers + place->step, f);
        if (place->is_turned) {
            turn(numbers + place->rotation, f);
            turn(numbers + place->rotation, t);
        }
    }
}

/* all axes are those of the datum: the force stays, and the moment is about z */
static void planar_column(MassMatrix *matrix, const double *numbers, int k)
{
    const CompositeMass *mass = matrix->mass;
    const MassSpeed *own = &mass->speeds[k];
    const double *f = numbers + own->force;
    double t = numbers[own->torque + 2];

    for (int p = own->place; p >= 0; p = mass->places[p].parent) {
        const MassPlace *place = &mass->places[p];
        const double *r = numbers + place->step;
        const double moment = place->has_step ? r[0] * f[1] - r[1] * f[0] : 0;

        t += place->is_inner ? moment : 0;
        for (int i = place->first; i < place->first + place->count; i++) {
            const int j = mass->speed_at[i];
            const double *slide = numbers + mass->speeds[j].slide;

            if (p != own->place || j <= k)
                put_pair(matrix, j, k,
                         numbers[mass->speeds[j].turn + 2] * t + slide[0] * f[0] + slide[1] * f[1]);
        }
        t += place->is_inner ? 0 : moment;
    }
}

void mass_matrix_put(MassMatrix *matrix, const double *numbers)
{
    /* pairs that no place passes on are and stay 0, but for shares */
    for (int i = 0; i < matrix->shares.count; i++)
        matrix->at[matrix->shares.at[i].at] = 0;
    for (int k = 0; k < matrix->mass->speed_count; k++)
        if (matrix->mass->planar)
            planar_column(matrix, numbers, k);
        else
            column(matrix, numbers, k);
    for (int i = 0; i < matrix->shares.count; i++)
        matrix->at[matrix->shares.at[i].at] += numbers[matrix->shares.at[i].number];
}

const double *mass_matrix_at(const MassMatrix *matrix)
{
    return matrix->at;
}
