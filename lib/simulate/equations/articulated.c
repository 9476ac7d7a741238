/* articulated.c: M u' = F by articulated-body inertias, leaves first (Featherstone 1983)
 *
 * The bodies beyond a place resist the motion of its origin, in its axes: an angular acceleration
 * alpha and an acceleration a need a moment t = J alpha + H a and a force f = H^T alpha + M a.
 * Elimination of a speed with motion (k, s): U = (J k + H s, H^T k + M s), the speed's inertia is D
 * = k . U_t + s . U_f, and J, H, M lose U U^T / D. In a plane alpha, t and J are scalars. */
#include "simulate/equations/articulated.h"

#include "base/memory.h"
#include "simulate/equations/equations_limits.h"
#include "simulate/equations/passing.h"

#include <math.h>
#include <string.h>

/* articulated-body inertia of a place */
typedef struct ArticulatedInertia {
    double J[9], H[9], M[9];
} ArticulatedInertia;

typedef struct SpatialVector { /* a motion (angular, linear) or a load (moment, force) */
    double turn[3], shift[3];
} SpatialVector;

typedef struct ArticulatedShare { /* inertia that belongs to one speed alone */
    int speed, number;            /* number: index into `needs` */
} ArticulatedShare;

struct Articulated {
    const CompositeMass *mass;
    LIST(Expr) needs;
    LIST(ArticulatedShare) shares;
    const double *numbers;
    ArticulatedInertia *blocks; /* one per place */
    SpatialVector
        *passed; /* one per place: first the load that is passed on, then the place's motion */
    SpatialVector *yield; /* U, one per speed */
    /* one per speed: */
    double *own;     /* inertia that belongs to it alone, */
    double *lost;    /* and what earlier eliminations removed of it */
    double *inverse; /* 1/D */
    double *rest;    /* (force - load)/D */
};

Articulated *articulated_new(const System *system)
{
    const CompositeMass *mass = system_composite_mass(system);
    Articulated *ar;
    const Entry *share;

    for (int i = 0; mass != NULL && (share = system_mass_share(system, i)) != NULL; i++)
        if (share->row != share->column)
            return NULL;
    if (mass == NULL)
        return NULL;
    ar = NEW(Articulated);
    ar->mass = mass;
    for (int i = 0; i < mass->needs.count; i++)
        LIST_PUSH(ar->needs, mass->needs.at[i]);
    for (int i = 0; (share = system_mass_share(system, i)) != NULL; i++) {
        LIST_PUSH(ar->shares, (ArticulatedShare){share->row, ar->needs.count});
        LIST_PUSH(ar->needs, share->value);
    }
    ar->blocks = NEW_ARRAY(ArticulatedInertia, mass->place_count);
    ar->passed = NEW_ARRAY(SpatialVector, mass->place_count);
    ar->yield = NEW_ARRAY(SpatialVector, mass->speed_count);
    ar->own = NEW_ARRAY(double, mass->speed_count);
    ar->inverse = NEW_ARRAY(double, mass->speed_count);
    ar->rest = NEW_ARRAY(double, mass->speed_count);
    ar->lost = NEW_ARRAY(double, mass->speed_count);
    return ar;
}

void articulated_free(Articulated *ar)
{
    if (ar == NULL)
        return;
    LIST_FREE(ar->needs);
    LIST_FREE(ar->shares);
    MEM_FREE(ar->blocks, ar->passed, ar->yield, ar->own, ar->inverse, ar->rest, ar->lost);
    mem_free(ar);
}

const Expr *articulated_needs(const Articulated *ar, int *count)
{
    *count = ar->needs.count;
    return ar->needs.at;
}

/* --- common to both cases: work of a load in a speed, loads and motions along the tree --- */

static inline double work(const Articulated *ar, int speed, const SpatialVector *load)
{
    const MassSpeed *own = &ar->mass->speeds[speed];
    const double *turn = ar->numbers + own->turn, *slide = ar->numbers + own->slide;

    if (ar->mass->planar)
        return turn[2] * load->turn[2] + slide[0] * load->shift[0] + slide[1] * load->shift[1];
    return (own->turns ? dot(turn, load->turn) : 0) + (own->slides ? dot(slide, load->shift) : 0);
}

static inline void add_times(SpatialVector *sum, double factor, const SpatialVector *load)
{
    for (int i = 0; i < 3; i++) {
        sum->turn[i] += factor * load->turn[i];
        sum->shift[i] += factor * load->shift[i];
    }
}

/* transfers a load to the parent */
static inline void pass_on(const Articulated *ar, const MassPlace *place, SpatialVector *load)
{
    const double *way = ar->numbers + place->way;

    if (place->has_step)
        add_cross(load->turn, ar->numbers + place->step, load->shift);
    if (place->is_turned) {
        turn_onto(place, ar->numbers + place->rotation, load->turn);
        turn_onto(place, ar->numbers + place->rotation, load->shift);
    }
    if (place->has_way && ar->mass->planar)
        load->turn[2] += way[0] * load->shift[1] - way[1] * load->shift[0];
    else if (place->has_way)
        add_cross(load->turn, way, load->shift);
}

/* transfers the parent's motion to the place */
static inline void carry(const Articulated *ar, const MassPlace *place, SpatialVector *motion)
{
    const double *way = ar->numbers + place->way;

    if (place->has_way)
        add_cross(motion->shift, motion->turn, way);
    if (place->is_turned) {
        turn_back(place, ar->numbers + place->rotation, motion->turn);
        turn_back(place, ar->numbers + place->rotation, motion->shift);
    }
    if (place->has_step)
        add_cross(motion->shift, motion->turn, ar->numbers + place->step);
}

/* --- in a plane: J of the block is J[0], H its H[0] and H[1], M its M[0], M[1], M[2] --- */

static void begin_planar(const double *body, ArticulatedInertia *b)
{
    b->J[0] = body[12];
    b->H[0] = -body[2];
    b->H[1] = body[1];
    b->M[0] = b->M[2] = body[0];
    b->M[1] = 0;
}

static void yield_planar(const ArticulatedInertia *b, const double *turn, const double *slide,
                         SpatialVector *out)
{
    out->turn[2] = b->J[0] * turn[2] + b->H[0] * slide[0] + b->H[1] * slide[1];
    out->shift[0] = b->H[0] * turn[2] + b->M[0] * slide[0] + b->M[1] * slide[1];
    out->shift[1] = b->H[1] * turn[2] + b->M[1] * slide[0] + b->M[2] * slide[1];
}

static void take_off_planar(ArticulatedInertia *b, double inverse, const SpatialVector *u)
{
    const double t = u->turn[2] * inverse, x = u->shift[0] * inverse, y = u->shift[1] * inverse;

    b->J[0] -= u->turn[2] * t;
    b->H[0] -= u->shift[0] * t;
    b->H[1] -= u->shift[1] * t;
    b->M[0] -= u->shift[0] * x;
    b->M[1] -= u->shift[0] * y;
    b->M[2] -= u->shift[1] * y;
}

/* e = (-y, x) of the vector between the origins: H += M e, J += e . (H before and after) */
static void hand_on_planar(const Articulated *ar, const MassPlace *place, ArticulatedInertia *b,
                           ArticulatedInertia *onto)
{
    const double *way = ar->numbers + place->way;

    if (place->has_way) {
        const double x = b->H[0], y = b->H[1];

        b->H[0] += b->M[1] * way[0] - b->M[0] * way[1];
        b->H[1] += b->M[2] * way[0] - b->M[1] * way[1];
        b->J[0] += way[0] * (y + b->H[1]) - way[1] * (x + b->H[0]);
    }
    onto->J[0] += b->J[0];
    for (int i = 0; i < 2; i++)
        onto->H[i] += b->H[i];
    for (int i = 0; i < 3; i++)
        onto->M[i] += b->M[i];
}

/* --- in space --- */

static void begin_spatial(const double *body, ArticulatedInertia *b)
{
    const double *S = body + 1;
    const double H[9] = {0, -S[2], S[1], S[2], 0, -S[0], -S[1], S[0], 0};

    memcpy(b->J, body + 4, sizeof b->J);
    memcpy(b->H, H, sizeof H);
    for (int i = 0; i < 9; i++)
        b->M[i] = i % 4 == 0 ? body[0] : 0;
}

static inline void add_across(const double *A, const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out[k] += A[3 * i + k] * v[i];
}

static void yield_spatial(const ArticulatedInertia *b, const MassSpeed *speed, const double *turn,
                          const double *slide, SpatialVector *out)
{
    memset(out, 0, sizeof *out);
    if (speed->turns) {
        add_product(b->J, turn, out->turn);
        add_across(b->H, turn, out->shift);
    }
    if (speed->slides) {
        add_product(b->H, slide, out->turn);
        add_product(b->M, slide, out->shift);
    }
}

static void take_off_spatial(ArticulatedInertia *b, double inverse, const SpatialVector *u)
{
    for (int i = 0; i < 3; i++) {
        const double t = u->turn[i] * inverse, f = u->shift[i] * inverse;

        for (int k = 0; k < 3; k++) {
            b->J[3 * i + k] -= t * u->turn[k];
            b->H[3 * i + k] -= t * u->shift[k];
            b->M[3 * i + k] -= f * u->shift[k];
        }
    }
}

/* Move to a point from which r leads to this one: H += r x M, J += r x H^T after, minus H r
 * before. */
static void move_block(const double *r, ArticulatedInertia *b)
{
    for (int k = 0; k < 3; k++) { /* H before times the matrix of r x: its rows times */
        double row[3] = {0};

        add_cross(row, b->H + 3 * k, r);
        for (int i = 0; i < 3; i++)
            b->J[3 * k + i] -= row[i];
    }
    for (int k = 0; k < 3; k++) {
        double column[3] = {0}, of_M[3] = {b->M[k], b->M[3 + k], b->M[6 + k]};

        add_cross(column, r, of_M);
        for (int i = 0; i < 3; i++)
            b->H[3 * i + k] += column[i];
    }
    for (int k = 0; k < 3; k++) {
        double column[3] = {0};

        add_cross(column, r, b->H + 3 * k);
        for (int i = 0; i < 3; i++)
            b->J[3 * i + k] += column[i];
    }
}

static void hand_on_spatial(const Articulated *ar, const MassPlace *place, ArticulatedInertia *b,
                            ArticulatedInertia *onto)
{
    if (place->has_step)
        move_block(ar->numbers + place->step, b);
    if (place->is_turned) {
        turn_tensor(place, ar->numbers + place->rotation, b->J);
        turn_tensor(place, ar->numbers + place->rotation, b->H);
        turn_tensor(place, ar->numbers + place->rotation, b->M);
    }
    if (place->has_way)
        move_block(ar->numbers + place->way, b);
    for (int i = 0; i < 9; i++) {
        onto->J[i] += b->J[i];
        onto->H[i] += b->H[i];
        onto->M[i] += b->M[i];
    }
}

/* --- elimination --- */

/* what the other speeds of this place would remove from the inertia of a later speed; `load` is U
 * of the one that is eliminated */
static void note_lost(Articulated *ar, const MassPlace *at, int from, const SpatialVector *load,
                      double inverse)
{
    for (int i = from; i < at->first + at->count; i++) {
        const double part = work(ar, ar->mass->speed_at[i], load);

        ar->lost[ar->mass->speed_at[i]] += part * part * inverse;
    }
}

static bool take_off(Articulated *ar, const MassPlace *place, ArticulatedInertia *b, int i)
{
    const int j = ar->mass->speed_at[i];
    const MassSpeed *speed = &ar->mass->speeds[j];
    const double *turn = ar->numbers + speed->turn, *slide = ar->numbers + speed->slide;
    SpatialVector *u = &ar->yield[j];
    double D;

    if (ar->mass->planar)
        yield_planar(b, turn, slide, u);
    else
        yield_spatial(b, speed, turn, slide, u);
    D = work(ar, j, u) + ar->own[j];
    if (!(D * ARTICULATED_MOST_EXCESS > D + ar->lost[j]))
        return false;
    ar->inverse[j] = 1 / D;
    if (ar->mass->planar)
        take_off_planar(b, ar->inverse[j], u);
    else
        take_off_spatial(b, ar->inverse[j], u);
    note_lost(ar, place, i + 1, u, ar->inverse[j]);
    return true;
}

static void hand_on(Articulated *ar, int p)
{
    const MassPlace *place = &ar->mass->places[p];
    ArticulatedInertia *onto = &ar->blocks[place->parent];

    if (ar->mass->planar)
        hand_on_planar(ar, place, &ar->blocks[p], onto);
    else
        hand_on_spatial(ar, place, &ar->blocks[p], onto);
    for (int i = place->first; i < place->first + place->count; i++) {
        SpatialVector load = ar->yield[ar->mass->speed_at[i]];
        const MassPlace *parent = &ar->mass->places[place->parent];

        pass_on(ar, place, &load);
        note_lost(ar, parent, parent->first, &load, ar->inverse[ar->mass->speed_at[i]]);
    }
}

bool articulated_factor(Articulated *ar, const double *numbers)
{
    const CompositeMass *mass = ar->mass;

    ar->numbers = numbers;
    memset(ar->lost, 0, (size_t)mass->speed_count * sizeof(double));
    memset(ar->own, 0, (size_t)mass->speed_count * sizeof(double));
    for (int i = 0; i < ar->shares.count; i++)
        ar->own[ar->shares.at[i].speed] += numbers[ar->shares.at[i].number];
    for (int p = 0; p < mass->place_count; p++) {
        const double *body = numbers + mass->first_body + BODY_NEEDS * (ptrdiff_t)p;

        if (mass->planar)
            begin_planar(body, &ar->blocks[p]);
        else
            begin_spatial(body, &ar->blocks[p]);
    }
    for (int p = mass->place_count - 1; p >= 0; p--) {
        const MassPlace *place = &mass->places[p];

        for (int i = place->first; i < place->first + place->count; i++)
            if (!take_off(ar, place, &ar->blocks[p], i))
                return false;
        if (place->parent >= 0)
            hand_on(ar, p);
    }
    return true;
}

void articulated_solve(Articulated *ar, const double *force, double *du)
{
    const CompositeMass *mass = ar->mass;

    memset(ar->passed, 0, (size_t)mass->place_count * sizeof *ar->passed);
    for (int p = mass->place_count - 1; p >= 0; p--) {
        const MassPlace *place = &mass->places[p];
        SpatialVector *load = &ar->passed[p];

        for (int i = place->first; i < place->first + place->count; i++) {
            const int j = mass->speed_at[i];

            ar->rest[j] = (force[j] - work(ar, j, load)) * ar->inverse[j];
            add_times(load, ar->rest[j], &ar->yield[j]);
        }
        if (place->parent < 0)
            continue;
        pass_on(ar, place, load);
        add_times(&ar->passed[place->parent], 1, load);
    }
    for (int p = 0; p < mass->place_count; p++) {
        const MassPlace *place = &mass->places[p];
        SpatialVector *motion = &ar->passed[p];

        *motion = place->parent >= 0 ? ar->passed[place->parent] : (SpatialVector){0};
        if (place->parent >= 0)
            carry(ar, place, motion);
        for (int i = place->first + place->count - 1; i >= place->first; i--) {
            const int j = mass->speed_at[i];
            const MassSpeed *speed = &mass->speeds[j];
            const SpatialVector *u = &ar->yield[j];
            SpatialVector own;

            du[j] = ar->rest[j] -
                    ar->inverse[j] * (dot(u->turn, motion->turn) + dot(u->shift, motion->shift));
            memcpy(own.turn, ar->numbers + speed->turn, sizeof own.turn);
            memcpy(own.shift, ar->numbers + speed->slide, sizeof own.shift);
            add_times(motion, du[j], &own);
        }
    }
}
