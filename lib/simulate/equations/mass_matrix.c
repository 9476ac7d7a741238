/* mass_matrix.c: M (nu x nu) column by column, from forces and moments passed on towards the datum
 *
 * f, t: force and moment on a place, in its axes; s its displacement, R the rotation to the axes of
 * its parent, r the vector from the parent's origin. A place passes on the force R f and the moment
 * R (t + s x f) + r x R f. */
#include "simulate/equations/mass_matrix.h"

#include "base/memory.h"
#include "simulate/equations/passing.h"

#include <string.h>

typedef struct MassMatrixShare {
    int at;     /* index into M */
    int number; /* index into the needs */
} MassMatrixShare;

struct MassMatrix {
    const CompositeMass *mass;
    LIST(MassMatrixShare) shares;
    LIST(Expr) needs;
    Pattern places;
    int *pair;  /* positions of entries of pairs in the order of the pass, and transposed */
    int next;   /* the next of those in a pass */
    double *at; /* M */
};

/* Pairs of speeds that meet on the paths towards the datum; two speeds of one place are in the
 * column of the later one. Shares follow. */
static void find_pairs(MassMatrix *matrix)
{
    const CompositeMass *mass = matrix->mass;
    LIST(int) row = {0};
    LIST(int) column = {0};

    for (int k = 0; k < mass->speed_count; k++)
        for (int p = mass->speeds[k].place; p >= 0; p = mass->places[p].parent)
            for (int i = mass->places[p].first, n = mass->places[p].count; n > 0; i++, n--) {
                const int j = mass->speed_at[i];

                if (j > k && p == mass->speeds[k].place)
                    continue;
                LIST_PUSH(row, j);
                LIST_PUSH(row, k);
                LIST_PUSH(column, k);
                LIST_PUSH(column, j);
            }
    for (int i = 0; i < matrix->shares.count; i++) {
        LIST_PUSH(row, matrix->shares.at[i].at % mass->speed_count);
        LIST_PUSH(column, matrix->shares.at[i].at / mass->speed_count);
    }
    matrix->pair = NEW_ARRAY(int, row.count);
    matrix->places = pattern_of(mass->speed_count, mass->speed_count, row.count, row.at, column.at,
                                matrix->pair);
    for (int i = 0; i < matrix->shares.count; i++)
        matrix->shares.at[i].at = matrix->pair[row.count - matrix->shares.count + i];
    matrix->at = NEW_ARRAY(double, matrix->places.count);
    LIST_FREE(row);
    LIST_FREE(column);
}

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
        LIST_PUSH(matrix->shares, (MassMatrixShare){share->row * mass->speed_count + share->column,
                                                    matrix->needs.count});
        LIST_PUSH(matrix->needs, share->value);
    }
    find_pairs(matrix);
    return matrix;
}

void mass_matrix_free(MassMatrix *matrix)
{
    if (matrix == NULL)
        return;
    LIST_FREE(matrix->shares);
    LIST_FREE(matrix->needs);
    pattern_free(&matrix->places);
    MEM_FREE(matrix->pair, matrix->at, matrix);
}

const Expr *mass_matrix_needs(const MassMatrix *matrix, int *count)
{
    *count = matrix->needs.count;
    return matrix->needs.at;
}

/* --- in numbers --- */

static inline void put_pair(MassMatrix *matrix, double value)
{
    matrix->at[matrix->pair[matrix->next++]] = value;
    matrix->at[matrix->pair[matrix->next++]] = value;
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

        for (int i = place->first; i < place->first + place->count; i++) {
            const int j = mass->speed_at[i];
            const MassSpeed *met = &mass->speeds[j];

            /* two speeds of one place are in the column of the later one */
            if (p != own->place || j <= k)
                put_pair(matrix, (met->turns ? dot(numbers + met->turn, t) : 0) +
                                     (met->slides ? dot(numbers + met->slide, f) : 0));
        }
        if (place->has_step)
            add_cross(t, numbers + place->step, f);
        if (place->is_turned) {
            turn_onto(place, numbers + place->rotation, f);
            turn_onto(place, numbers + place->rotation, t);
        }
        if (place->has_way)
            add_cross(t, numbers + place->way, f);
    }
}

/* all axes are parallel to those of the datum: the force is unchanged, and the moment is about z */
static void planar_column(MassMatrix *matrix, const double *numbers, int k)
{
    const CompositeMass *mass = matrix->mass;
    const MassSpeed *own = &mass->speeds[k];
    const double x = numbers[own->force], y = numbers[own->force + 1];
    double t = numbers[own->torque + 2];

    for (int p = own->place; p >= 0; p = mass->places[p].parent) {
        const MassPlace *place = &mass->places[p];

        for (int i = place->first; i < place->first + place->count; i++) {
            const int j = mass->speed_at[i];
            const MassSpeed *met = &mass->speeds[j];
            const double *slide = numbers + met->slide;

            if (p != own->place || j <= k)
                put_pair(matrix, (met->turns ? numbers[met->turn + 2] * t : 0) +
                                     (met->slides ? slide[0] * x + slide[1] * y : 0));
        }
        if (place->has_way)
            t += numbers[place->way] * y - numbers[place->way + 1] * x;
    }
}

void mass_matrix_set(MassMatrix *matrix, const double *numbers)
{
    /* pairs that no place passes on are 0 throughout, except for shares */
    for (int i = 0; i < matrix->shares.count; i++)
        matrix->at[matrix->shares.at[i].at] = 0;
    matrix->next = 0;
    for (int k = 0; k < matrix->mass->speed_count; k++)
        if (matrix->mass->planar)
            planar_column(matrix, numbers, k);
        else
            column(matrix, numbers, k);
    for (int i = 0; i < matrix->shares.count; i++)
        matrix->at[matrix->shares.at[i].at] += numbers[matrix->shares.at[i].number];
}

const Pattern *mass_matrix_places(const MassMatrix *matrix)
{
    return &matrix->places;
}

const double *mass_matrix_at(const MassMatrix *matrix)
{
    return matrix->at;
}
