/* mass_matrix.c: M (nu x nu) column by column, from forces and moments passed on towards the datum
 *
 * m, S, J: mass (kg), first moment (kg m) and inertia (kg m^2) of all beyond a place, about it and
 * in its axes. A unit of a speed that turns by w and slides by v needs the force f = m v + w x S
 * and the moment t = S x v + J w there. s is the displacement of a place, R the rotation to the
 * axes of its parent, r the vector from the parent's origin. A place passes on the force R f and
 * the moment R (t + s x f) + r x R f. */
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
    int *pair;    /* positions of entries of pairs in the order of the pass, and transposed */
    int next;     /* the next of those in a pass */
    double *at;   /* M */
    double *body; /* of each place with all beyond it: m, S and J row by row, as in CompositeMass */
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
    matrix->body = NEW_ARRAY(double, BODY_NEEDS *(size_t)mass->place_count);
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
    MEM_FREE(matrix->pair, matrix->at, matrix->body, matrix);
}

const Expr *mass_matrix_needs(const MassMatrix *matrix, int *count)
{
    *count = matrix->needs.count;
    return matrix->needs.at;
}

/* --- in numbers --- */

/* Moves m, S, J to a point from which r leads to the present one: S' = S + m r, J' = J + (r.S +
 * r.S') 1 - r S^T - S' r^T. */
static void move_body(const double *r, double *body)
{
    double *S = body + 1, *J = body + 4, before[3], round;

    memcpy(before, S, sizeof before);
    for (int i = 0; i < 3; i++)
        S[i] += body[0] * r[i];
    round = dot(r, before) + dot(r, S);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            J[3 * i + k] -= r[i] * before[k] + S[i] * r[k];
        J[4 * i] += round;
    }
}

/* S and J in the axes of the place's parent */
static void turn_body(const MassPlace *place, const double *R, double *body)
{
    double *J = body + 4;

    turn_onto(place, R, body + 1);
    turn_tensor(place, R, J);
}

static void pass_body(const MassPlace *place, const double *numbers, double *body)
{
    if (place->has_step)
        move_body(numbers + place->step, body);
    if (place->is_turned)
        turn_body(place, numbers + place->rotation, body);
    if (place->has_way)
        move_body(numbers + place->way, body);
}

static void pass_planar_body(const MassPlace *place, const double *numbers, double *body)
{
    const double *r = numbers + place->way;
    const double x = body[1], y = body[2];

    if (!place->has_way)
        return;
    body[1] += body[0] * r[0];
    body[2] += body[0] * r[1];
    body[12] += r[0] * (x + body[1]) + r[1] * (y + body[2]);
}

/* what moves with each place alone, and inward all beyond it: places are listed outward */
static void gather_bodies(MassMatrix *matrix, const double *numbers)
{
    const CompositeMass *mass = matrix->mass;

    memcpy(matrix->body, numbers + mass->first_body,
           BODY_NEEDS * (size_t)mass->place_count * sizeof(double));
    for (int p = mass->place_count - 1; p >= 0; p--) {
        const MassPlace *place = &mass->places[p];
        double body[BODY_NEEDS], *onto;

        if (place->parent < 0)
            continue;
        memcpy(body, matrix->body + BODY_NEEDS * (ptrdiff_t)p, sizeof body);
        if (mass->planar)
            pass_planar_body(place, numbers, body);
        else
            pass_body(place, numbers, body);
        onto = matrix->body + BODY_NEEDS * (ptrdiff_t)place->parent;
        for (int i = 0; i < BODY_NEEDS; i++)
            onto[i] += body[i];
    }
}

static inline void put_pair(MassMatrix *matrix, double value)
{
    matrix->at[matrix->pair[matrix->next++]] = value;
    matrix->at[matrix->pair[matrix->next++]] = value;
}

static void column(MassMatrix *matrix, const double *numbers, int k)
{
    const CompositeMass *mass = matrix->mass;
    const MassSpeed *own = &mass->speeds[k];
    const double *body = matrix->body + BODY_NEEDS * (ptrdiff_t)own->place, *S = body + 1;
    const double *turn = numbers + own->turn, *slide = numbers + own->slide;
    double f[3] = {0}, t[3] = {0};

    if (own->turns) {
        add_cross(f, turn, S);
        add_product(body + 4, turn, t);
    }
    if (own->slides) {
        add_cross(t, S, slide);
        for (int i = 0; i < 3; i++)
            f[i] += body[0] * slide[i];
    }
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
    const double *body = matrix->body + BODY_NEEDS * (ptrdiff_t)own->place;
    const double turn = own->turns ? numbers[own->turn + 2] : 0;
    const double *slid = numbers + own->slide; /* zeros where it doesn't slide */
    const double x = body[0] * slid[0] - turn * body[2], y = body[0] * slid[1] + turn * body[1];
    double t = body[12] * turn + body[1] * slid[1] - body[2] * slid[0];

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
    gather_bodies(matrix, numbers);
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
