/* kkt.c: KKT solver in L D L^T, speeds before multipliers, with quasi-definite regularisation
 *
 * In that order the pivot d of a multiplier is the remainder of p, its diagonal entry of G M^-1
 * G^T. d / p is the squared sine of the angle, in the metric of M, between its row and the rows
 * before. Light bodies between heavy ones make d / p small too; with unit masses only the geometry
 * does (Schur complements of [R^2 G^T; G 0] are those of G R^-2 G^T). Where M has no usable pivots
 * (massless bodies), or they cancel all digits of the answer, rows are exchanged instead. */
#include "algebra/kkt.h"

#include "algebra/algebra_limits.h"
#include "algebra/kkt_border.h"
#include "algebra/kkt_sizes.h"
#include "algebra/ldl.h"
#include "algebra/linear.h"
#include "algebra/sparse.h"
#include "algebra/triangular.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define SINGULAR LDL_SMALL /* and here epsilon is needed */

struct Kkt {
    const Pattern *mass, *constraints;
    int nu, m, size;
    int *rows;
    /* Stored entry from[k] (entries of M first) is at place[k] of the factors. Unknowns are
     * numbered as they are eliminated: u_i is place_of[i], lambda_k place_of[nu + k]; */
    int *from, *place, *place_of;
    int *row, *column; /* here they are not */
    int entries, mass_entries;
    int border; /* see kkt_border() */
    int *class; /* of u_i, then of lambda_k */
    bool *late; /* of the rows in use: their own speeds don't determine them */
    bool is_factored;
    LdlOrder *order;
    Ldl *factors, *geometry;
    const CallMonitor *watch;
    KktSizes sizes;
    bool is_measured;                  /* with these rows */
    Triangular *groups;                /* of the rows in use; NULL: there are none, or a border */
    double *norm, *reference;          /* by place, of multipliers: those squared, and of `most` */
    double *right, *answer, *residual; /* by place */
    double *weight;                    /* by place: of squares of unknowns, to compare them */
    double angle;                      /* least d / p; of rows exchanged, least over largest */
    double pivot;                      /* of the last configuration: how independent its rows are */
    bool regularised;
    bool is_independent_by_groups; /* that pivot */
    Sparse *exchanging;            /* rows exchanged; NULL: not needed yet */
    bool is_exchanging;            /* the last factors are those */
    double *scale;                 /* unknown = scale * its unknown */
    double *values;                /* its entries, then the transposed ones */
};

/* --- the order --- */

static void push_entry(Kkt *kkt, int from, int i, int j)
{
    kkt->from[kkt->entries] = from;
    kkt->row[kkt->entries] = i;
    kkt->column[kkt->entries++] = j;
}

static void close_order(Kkt *kkt)
{
    ldl_free(kkt->factors);
    ldl_free(kkt->geometry);
    ldl_order_free(kkt->order);
    sparse_free(kkt->exchanging);
    kkt->factors = kkt->geometry = NULL;
    kkt->order = NULL;
    kkt->exchanging = NULL;
    mem_free(kkt->values);
    kkt->values = NULL;
}

static KktPlaces places_of(const Kkt *kkt)
{
    return (KktPlaces){.nu = kkt->nu,
                       .m = kkt->m,
                       .mass_entries = kkt->mass_entries,
                       .entries = kkt->entries,
                       .row = kkt->row,
                       .column = kkt->column};
}

/* An order found in a call that fails is discarded. The previous order is restored, without
 * factors. */
static void keep_order(Kkt *kkt)
{
    void *const pieces[] = {kkt,        kkt->rows,     kkt->from,  kkt->row, kkt->column,
                            kkt->place, kkt->place_of, kkt->class, kkt->late};

    kkt->is_factored = false;
    for (int i = 0; i < COUNT(pieces); i++)
        mem_keep(pieces[i]);
}

static void open_order(Kkt *kkt)
{
    const KktPlaces places = places_of(kkt);

    close_order(kkt);
    kkt_classes(&places, kkt->border, kkt->late, kkt->class);
    kkt->order = ldl_order_new(kkt->size, kkt->class, kkt->entries, kkt->row, kkt->column,
                               kkt->place, kkt->place_of);
    kkt->factors = ldl_new(kkt->order);
    if (kkt->m > 0)
        kkt->geometry = ldl_new(kkt->order);
}

/* Elimination for these rows. */
static void take_rows(Kkt *kkt, const int *rows)
{
    const Pattern *mass = kkt->mass, *g = kkt->constraints;
    KktPlaces places;

    keep_order(kkt);
    kkt->entries = 0;
    for (int e = 0; e < mass->count; e++)
        if (mass->row[e] <= mass->column[e])
            push_entry(kkt, e, mass->row[e], mass->column[e]);
    kkt->mass_entries = kkt->entries;
    for (int k = 0; k < kkt->m; k++) {
        kkt->rows[k] = rows[k];
        kkt->late[k] = false;
        for (int e = g->start[rows[k]]; e < g->start[rows[k] + 1]; e++)
            push_entry(kkt, e, g->row[e], kkt->nu + k);
    }
    places = places_of(kkt);
    kkt->border = kkt_border(&places);
    open_order(kkt);
    kkt->is_measured = false;
    triangular_free(kkt->groups);
    kkt->groups =
        kkt->border == NO_BORDER && kkt->m > 0 ? triangular_new(g, kkt->rows, kkt->m) : NULL;
}

Kkt *kkt_new(const Pattern *mass, const Pattern *constraints, const int *rows, int m)
{
    Kkt *kkt = NEW(Kkt);
    const int nu = mass->columns, size = nu + m, most = mass->count + constraints->count;

    kkt->mass = mass;
    kkt->constraints = constraints;
    kkt->nu = nu;
    kkt->m = m;
    kkt->size = size;
    kkt->rows = NEW_ARRAY(int, m);
    kkt->from = NEW_ARRAY(int, most);
    kkt->row = NEW_ARRAY(int, most);
    kkt->column = NEW_ARRAY(int, most);
    kkt->place = NEW_ARRAY(int, most);
    kkt->place_of = NEW_ARRAY(int, size);
    kkt->class = NEW_ARRAY(int, size);
    kkt->late = NEW_ARRAY(bool, m);
    kkt->sizes = kkt_sizes_new(constraints);
    kkt->norm = NEW_ARRAY(double, size);
    kkt->reference = NEW_ARRAY(double, size);
    kkt->right = NEW_ARRAY(double, size);
    kkt->answer = NEW_ARRAY(double, size);
    kkt->residual = NEW_ARRAY(double, size);
    kkt->weight = NEW_ARRAY(double, size);
    kkt->scale = NEW_ARRAY(double, size);
    take_rows(kkt, rows);
    return kkt;
}

void kkt_set_watch(Kkt *kkt, const CallMonitor *watch)
{
    kkt->watch = watch;
}

void kkt_free(Kkt *kkt)
{
    if (kkt == NULL)
        return;
    close_order(kkt);
    triangular_free(kkt->groups);
    kkt_sizes_free(&kkt->sizes);
    MEM_FREE(kkt->rows, kkt->from, kkt->row, kkt->column, kkt->place, kkt->place_of, kkt->class,
             kkt->late, kkt->norm, kkt->reference, kkt->right, kkt->answer, kkt->residual,
             kkt->weight, kkt->scale, kkt);
}

static void keep_rows(Kkt *kkt, const int *rows)
{
    if (kkt->m > 0 && memcmp(kkt->rows, rows, (size_t)kkt->m * sizeof(int)) != 0)
        take_rows(kkt, rows);
}

static void put_entries(const Kkt *kkt, const double *mass, const double *phi_u)
{
    double *entries = ldl_entries(kkt->factors);

    for (int e = 0; e < kkt->mass_entries; e++)
        entries[kkt->place[e]] = mass[kkt->from[e]];
    for (int e = kkt->mass_entries; e < kkt->entries; e++)
        entries[kkt->place[e]] = phi_u[kkt->from[e]];
}

/* --- the geometry --- */

static void measure(Kkt *kkt, const double *phi_u)
{
    kkt_sizes_measure(&kkt->sizes, phi_u, kkt->rows, kkt->m);
    kkt->is_measured = true;
}

/* factors of [R^2 G^T; G 0], and norms of its rows by place */
static void factor_geometry(Kkt *kkt, const double *phi_u)
{
    double *entries = ldl_entries(kkt->geometry);

    for (int i = 0; i < kkt->nu; i++)
        entries[kkt->place_of[i]] = kkt->sizes.square[i];
    for (int e = kkt->mass_entries; e < kkt->entries; e++)
        entries[kkt->place[e]] = phi_u[kkt->from[e]];
    for (int k = 0; k < kkt->m; k++)
        kkt->norm[kkt->place_of[kkt->nu + k]] = kkt->sizes.norm[kkt->rows[k]];
    (void)ldl_factor(kkt->geometry, kkt->norm, NULL);
}

static double rest_of_group(const Kkt *kkt, int group, const double *phi_u)
{
    return triangular_rest(kkt->groups, group, phi_u, kkt->sizes.square, kkt->sizes.norm);
}

/* remainder of rows by the columns of their groups alone, 1 at most; 0: there are no groups */
static double rest_of_groups(const Kkt *kkt, const double *phi_u)
{
    double least = 1;

    if (kkt->groups == NULL)
        return 0;
    for (int i = 0; i < triangular_groups(kkt->groups); i++) {
        const double rest = rest_of_group(kkt, i, phi_u);

        if (!(rest >= least))
            least = rest;
    }
    return least;
}

/* the relative remainder of the k-th row in use after those before are eliminated, 1 at most */
static double rest_of_row(const Kkt *kkt, int k)
{
    const int place = kkt->place_of[kkt->nu + k];

    return -ldl_pivots(kkt->geometry)[place] / kkt->norm[place];
}

/* whether its own speeds determine this row, before those of the border */
static bool is_early(const Kkt *kkt, int k)
{
    return kkt->border != NO_BORDER && kkt->class[kkt->nu + k] == CLASS_EARLY;
}

/* Rows with a smaller remainder are ordered last; false when there are none. */
static bool put_off_rows(Kkt *kkt, double least)
{
    bool found = false;

    for (int k = 0; k < kkt->m; k++)
        if (is_early(kkt, k) && !(rest_of_row(kkt, k) >= least))
            kkt->late[k] = found = true;
    return found;
}

/* When a row is no longer determined by its own speeds, all rows are tested again. Without that row
 * the remainders of the others grow, so that the second order is final. */
static void renew_order(Kkt *kkt, const double *phi_u)
{
    keep_order(kkt);
    memset(kkt->late, 0, (size_t)kkt->m * sizeof(bool));
    open_order(kkt);
    factor_geometry(kkt, phi_u);
    if (!put_off_rows(kkt, KKT_FIRMLY_DETERMINED))
        return;
    open_order(kkt);
    factor_geometry(kkt, phi_u);
}

static bool has_lost_rows(const Kkt *kkt)
{
    for (int k = 0; k < kkt->m; k++)
        if (is_early(kkt, k) && !(rest_of_row(kkt, k) >= KKT_DETERMINED))
            return true;
    return false;
}

/* Among rows that are nearly dependent, the pivot of the last one is a poor measure if its own
 * coefficient is small. The coefficients are in the column of row k of the inverse. Returns the
 * remainder of the row with the largest coefficient after eliminating all others, `pivot` at
 * most. */
static double as_last(const Kkt *kkt, int k, double pivot)
{
    const int place = kkt->place_of[kkt->nu + k];
    const double size = sqrt(kkt->norm[place]);
    double *x = kkt->residual, largest = 0, own;

    memset(x, 0, (size_t)kkt->size * sizeof(double));
    x[place] = size;
    ldl_solve(kkt->geometry, x);
    own = fabs(x[place]) * size;
    for (int j = kkt->nu; j < kkt->size; j++)
        largest = fmax(largest, fabs(x[kkt->place_of[j]]) * sqrt(kkt->norm[kkt->place_of[j]]));
    return own > 0 && largest > own ? fmin(pivot, 1 / own) * (own / largest) * (own / largest)
                                    : pivot;
}

/* The least pivot of G R^-2 G^T over the largest norm that its row has had. Rows in the middle of
 * the order exceed the remainder by their own speeds, which is more than KKT_NEAR. After the border
 * the pivots are those of G R^-2 G^T. */
static double least_pivot(Kkt *kkt, const double *phi_u)
{
    double found = 1;
    int least = -1;

    measure(kkt, phi_u);
    factor_geometry(kkt, phi_u);
    if (has_lost_rows(kkt))
        renew_order(kkt, phi_u);
    for (int k = 0; k < kkt->m; k++) {
        const double rest = is_early(kkt, k) ? 1 : rest_of_row(kkt, k);

        if (!(rest >= found)) {
            found = fmax(0, rest); /* a row that always was 0: fmax() passes NaN over */
            least = k;
        }
    }
    return kkt->border != NO_BORDER && least >= 0 ? as_last(kkt, least, found) : found;
}

/* The pivots of rows in groups are at least their remainders in the groups' own columns, in the
 * order from the last group to the first. Where these bounds don't suffice, d / p decides as long
 * as it isn't small. */
static double least_pivot_at_most(Kkt *kkt, const double *phi_u)
{
    if (kkt->groups != NULL) {
        double rest;

        measure(kkt, phi_u);
        rest = rest_of_groups(kkt, phi_u);
        kkt->is_independent_by_groups = rest > KKT_NEAR;
        if (kkt->is_independent_by_groups)
            return rest;
    }
    return !kkt->is_exchanging && kkt->angle > KKT_REGULAR ? kkt->angle : least_pivot(kkt, phi_u);
}

double kkt_independence(Kkt *kkt, const double *phi_u, const int *rows)
{
    keep_rows(kkt, rows);
    kkt_sizes_see(&kkt->sizes, phi_u, kkt->rows, kkt->m);
    return sqrt(least_pivot(kkt, phi_u));
}

double kkt_independence_of_groups(Kkt *kkt, const double *phi_u, const int *rows)
{
    keep_rows(kkt, rows);
    kkt_sizes_see(&kkt->sizes, phi_u, kkt->rows, kkt->m);
    measure(kkt, phi_u);
    return sqrt(rest_of_groups(kkt, phi_u));
}

void kkt_store_sizes(Kkt *kkt)
{
    kkt_sizes_store(&kkt->sizes, false);
}

void kkt_return_sizes(Kkt *kkt)
{
    kkt_sizes_store(&kkt->sizes, true);
}

/* --- rows exchanged --- */

static void open_exchanging(Kkt *kkt)
{
    const bool before = mem_scratch(true); /* numbers that each call computes anew */
    int *row = NEW_ARRAY(int, 2 * kkt->entries + kkt->m);
    int *column = NEW_ARRAY(int, 2 * kkt->entries + kkt->m), count = 0;

    for (int across = 0; across < 2; across++)
        for (int e = 0; e < kkt->entries; e++)
            if (!across || kkt->row[e] != kkt->column[e]) {
                row[count] = kkt->place_of[across ? kkt->column[e] : kkt->row[e]];
                column[count++] = kkt->place_of[across ? kkt->row[e] : kkt->column[e]];
            }
    for (int k = 0; k < kkt->m; k++)
        row[count + k] = column[count + k] = kkt->place_of[kkt->nu + k];
    kkt->exchanging = sparse_new(kkt->size, count + kkt->m, row, column);
    kkt->values = NEW_ARRAY(double, count + kkt->m);
    MEM_FREE(row, column);
    (void)mem_scratch(before);
}

/* Unknowns are scaled to unit mass, rows of G to unit mass-norm at its largest so far. */
static void choose_scale(Kkt *kkt)
{
    const double *entries = ldl_entries(kkt->factors);
    double *size = kkt->weight; /* mass, and norm squared */
    const KktPlaces places = places_of(kkt);
    double heaviest = 0, least;

    memset(size, 0, (size_t)kkt->size * sizeof(double));
    for (int i = 0; i < kkt->nu; i++) {
        size[i] = entries[kkt->place_of[i]];
        heaviest = fmax(heaviest, size[i]);
    }
    kkt_borrow_masses(&places, kkt->place, entries, KKT_LEAST_MASS * heaviest, kkt->answer,
                      kkt->residual, size);
    for (int i = 0; i < kkt->nu; i++) /* a mass borrowed over a lever near 0 is no scale */
        if (size[i] > 0)
            size[i] = fmax(size[i], KKT_LEAST_MASS * heaviest);
    for (int e = kkt->mass_entries; e < kkt->entries; e++) {
        const double entry = entries[kkt->place[e]], mass = size[kkt->row[e]];

        size[kkt->column[e]] += entry * entry / (mass > 0 ? mass : 1);
    }
    least = kkt_sizes_store_most(&kkt->sizes, kkt->rows, kkt->m, size + kkt->nu);
    for (int k = 0; k < kkt->m; k++)
        size[kkt->nu + k] = kkt_sizes_reference(&kkt->sizes, kkt->rows[k], least);
    for (int i = 0; i < kkt->size; i++)
        kkt->scale[kkt->place_of[i]] = size[i] > 0 ? 1 / sqrt(size[i]) : 1;
}

static bool factor_exchanging(Kkt *kkt)
{
    const double *entries = ldl_entries(kkt->factors);
    const double *pivots = kkt->m > 0 ? ldl_pivots(kkt->geometry) : NULL;
    int count = 0;

    if (kkt->exchanging == NULL) {
        keep_order(kkt);
        open_exchanging(kkt);
    }
    choose_scale(kkt);
    for (int across = 0; across < 2; across++)
        for (int e = 0; e < kkt->entries; e++)
            if (!across || kkt->row[e] != kkt->column[e])
                kkt->values[count++] = entries[kkt->place[e]] *
                                       kkt->scale[kkt->place_of[kkt->row[e]]] *
                                       kkt->scale[kkt->place_of[kkt->column[e]]];
    for (int k = 0; k < kkt->m; k++) {
        const int place = kkt->place_of[kkt->nu + k];
        const bool held = kkt->regularised && fabs(pivots[place]) < LDL_SMALL * kkt->norm[place];

        kkt->values[count + k] = held ? -LDL_HOLD : 0;
    }
    if (!sparse_factor(kkt->exchanging, kkt->values))
        return false;
    kkt->angle = sparse_condition(kkt->exchanging);
    return kkt->regularised || kkt->angle > KKT_UNSOLVABLE;
}

static void solve_exchanging(const Kkt *kkt, double *x)
{
    for (int i = 0; i < kkt->size; i++)
        x[i] *= kkt->scale[i];
    sparse_solve(kkt->exchanging, x);
    for (int i = 0; i < kkt->size; i++)
        x[i] *= kkt->scale[i];
}

/* --- factors --- */

/* ratio of p to its largest value so far for each row; the diagonal shows what the border adds to p
 * of an earlier row */
static void measure_rows(Kkt *kkt)
{
    const double *taken = ldl_taken(kkt->factors), *entries = ldl_entries(kkt->factors);
    double *size = kkt->weight, least;

    for (int k = 0; k < kkt->m; k++)
        size[kkt->nu + k] = taken[kkt->place_of[kkt->nu + k]];
    for (int e = kkt->mass_entries; e < kkt->entries && kkt->border != NO_BORDER; e++)
        if (kkt->class[kkt->row[e]] == CLASS_BORDER)
            size[kkt->column[e]] += entries[kkt->place[e]] * entries[kkt->place[e]] /
                                    entries[kkt->place_of[kkt->row[e]]];
    least = kkt_sizes_store_most(&kkt->sizes, kkt->rows, kkt->m, size + kkt->nu);
    for (int k = 0; k < kkt->m; k++)
        kkt->reference[kkt->place_of[kkt->nu + k]] =
            kkt_sizes_reference(&kkt->sizes, kkt->rows[k], least);
}

/* whether M has pivots of its own */
static bool mass_is_regular(const Kkt *kkt)
{
    const double *pivots = ldl_pivots(kkt->factors), *diagonal = ldl_entries(kkt->factors);
    bool regular = true;

    for (int i = 0; i < kkt->nu && regular; i++)
        regular = pivots[kkt->place_of[i]] > KKT_NO_MASS * diagonal[kkt->place_of[i]];
    return regular;
}

/* The least d / p, 1 at most; NAN counts as 0. For a speed of the border, to which earlier rows
 * have added: the remainder of its pivot. */
static double least_angle(const Kkt *kkt)
{
    const double *pivots = ldl_pivots(kkt->factors), *taken = ldl_taken(kkt->factors);
    double least = 1;

    for (int i = 0; i < kkt->nu && kkt->border != NO_BORDER; i++)
        if (kkt->class[i] == CLASS_BORDER) {
            const double pivot = pivots[kkt->place_of[i]];

            least = fmin(least, pivot / (pivot + taken[kkt->place_of[i]]));
        }
    for (int k = 0; k < kkt->m; k++) {
        const int place = kkt->place_of[kkt->nu + k];
        const double angle = -pivots[place] / kkt->reference[place];

        if (!(angle >= least))
            least = fmax(0, angle);
    }
    return least;
}

/* only rows that are singular by geometry are regularised */
static bool factor_held(Kkt *kkt)
{
    const double *pivots = ldl_pivots(kkt->geometry);
    double *reference = kkt->residual;

    for (int i = 0; i < kkt->size; i++)
        reference[i] = fabs(pivots[i]) < LDL_SMALL * kkt->norm[i] ? kkt->reference[i] : 0;
    return ldl_factor(kkt->factors, reference, kkt->watch);
}

/* whether a speed has no mass at all, such as a rotation of a point mass */
static bool lacks_mass(const Kkt *kkt)
{
    const double *diagonal = ldl_entries(kkt->factors);

    for (int i = 0; i < kkt->nu; i++)
        if (diagonal[kkt->place_of[i]] == 0)
            return true;
    return false;
}

/* Rows are exchanged from the beginning: their pivots show first whether a singular configuration
 * may be near. */
static bool factor_massless(Kkt *kkt, const double *phi_u)
{
    bool sound;

    kkt->is_exchanging = true;
    kkt->regularised = false;
    sound = factor_exchanging(kkt);
    if (kkt->border == NO_BORDER) {
        kkt->pivot = 1;
        if (kkt->m == 0 || (sound && kkt->angle > KKT_EXCHANGED))
            return sound;
        kkt->pivot = least_pivot_at_most(kkt, phi_u);
    }
    kkt->regularised = !(kkt->pivot > SINGULAR);
    return kkt->regularised ? factor_exchanging(kkt) : sound;
}

/* Pivots with masses indicate a singular configuration when all speeds precede all rows. Otherwise
 * the geometry is factored at once, which determines the order too. */
static bool factor(Kkt *kkt, const double *mass, const double *phi_u)
{
    bool regular;

    if (kkt->border != NO_BORDER)
        kkt->pivot = least_pivot(kkt, phi_u);
    put_entries(kkt, mass, phi_u);
    if (lacks_mass(kkt))
        return factor_massless(kkt, phi_u);
    if (!ldl_factor(kkt->factors, NULL, kkt->watch))
        return false;
    regular = mass_is_regular(kkt);
    kkt->is_independent_by_groups = kkt->is_exchanging = false;
    kkt->angle = 0;
    if (regular) {
        measure_rows(kkt);
        kkt->angle = least_angle(kkt);
    }
    if (kkt->border == NO_BORDER)
        kkt->pivot = kkt->m == 0 || kkt->angle > KKT_SUSPECT ? 1 : least_pivot_at_most(kkt, phi_u);
    kkt->regularised = !(kkt->pivot > SINGULAR);
    if (kkt->regularised && regular && !factor_held(kkt))
        return false;
    kkt->is_exchanging = !regular || (!kkt->regularised && kkt->angle < KKT_LOST);
    return !kkt->is_exchanging || factor_exchanging(kkt);
}

bool kkt_factor(Kkt *kkt, const double *mass, const double *phi_u, const int *rows)
{
    keep_rows(kkt, rows);
    kkt_sizes_see(&kkt->sizes, phi_u, kkt->rows, kkt->m);
    return kkt->is_factored = factor(kkt, mass, phi_u);
}

bool kkt_is_factored(const Kkt *kkt)
{
    return kkt->is_factored;
}

double kkt_products(const Kkt *kkt)
{
    return kkt_order_products(kkt->order, kkt->border);
}

bool kkt_is_plain(const Kkt *kkt)
{
    return kkt->m > 0 && !kkt->is_exchanging &&
           kkt->angle > (kkt->is_independent_by_groups ? KKT_INDEPENDENT : KKT_SUSPECT);
}

/* Whether all groups are independent in their own columns, by sizes measured at the start of the
 * step. A dependent group may show at a row of another group. */
static bool are_groups_sound(Kkt *kkt, const double *phi_u, const int *rows)
{
    keep_rows(kkt, rows);
    return kkt->is_measured && rest_of_groups(kkt, phi_u) > KKT_NEAR;
}

bool kkt_is_sound(Kkt *kkt, const double *pivot, const double *taken, const double *phi_u,
                  const int *rows, const double *left, int left_count, bool is_known)
{
    const double enough = is_known ? KKT_INDEPENDENT : KKT_SUSPECT;
    bool is_asked = is_known;
    double least;

    for (int i = 0; i < left_count; i++)
        if (!(left[i] > KKT_SUSPECT))
            return false;
    if (kkt_sizes_are_sound(&kkt->sizes, pivot, taken, rows, kkt->m, enough))
        return true;
    least = kkt_sizes_store_most(&kkt->sizes, rows, kkt->m, taken);
    for (int k = 0; k < kkt->m; k++) {
        const double reference = kkt_sizes_reference(&kkt->sizes, rows[k], least);

        if (pivot[k] > enough * reference)
            continue;
        if (!(pivot[k] > KKT_INDEPENDENT * reference) ||
            !(is_asked || are_groups_sound(kkt, phi_u, rows)))
            return false;
        is_asked = true;
    }
    return true;
}

static double rounding_error_of(double pivot)
{
    return pivot < KKT_NEAR ? fmin(KKT_MOST_ROUNDING, KKT_ROUNDING / (pivot + 1e-300)) : 0;
}

double kkt_rounding_error(const Kkt *kkt)
{
    return rounding_error_of(kkt->pivot);
}

double kkt_rounding_error_at(double independence)
{
    return rounding_error_of(independence * independence);
}

bool kkt_is_regularised(const Kkt *kkt)
{
    return kkt->regularised;
}

/* --- solution --- */

static void solve(Kkt *kkt, double *x)
{
    if (kkt->is_exchanging)
        solve_exchanging(kkt, x);
    else
        ldl_solve(kkt->factors, x);
}

/* by place: weights that make the squares of unknowns comparable */
static void weigh(Kkt *kkt)
{
    const double *diagonal = ldl_entries(kkt->factors);

    for (int i = 0; i < kkt->size; i++)
        kkt->weight[i] = kkt->is_exchanging ? 1 / (kkt->scale[i] * kkt->scale[i])
                         : diagonal[i] > 0  ? diagonal[i]
                                            : kkt->reference[i];
}

static double size_of(const Kkt *kkt, const double *x)
{
    double largest = 0;

    for (int i = 0; i < kkt->size; i++)
        largest = fmax(largest, x[i] * x[i] * kkt->weight[i]);
    return sqrt(largest);
}

/* the size of the correction. One sweep makes the solution as exact as the rows determine it,
 * whatever their scaling (Skeel 1980), even with masses that differ by many decades. */
static double refine_once(Kkt *kkt)
{
    ldl_residual(kkt->factors, kkt->right, kkt->answer, kkt->residual);
    solve(kkt, kkt->residual);
    for (int i = 0; i < kkt->size; i++)
        kkt->answer[i] += kkt->residual[i];
    return size_of(kkt, kkt->residual);
}

static void refine(Kkt *kkt, int least, double enough)
{
    const bool is_driven = kkt->m == kkt->nu;
    const double contraction = is_driven ? KKT_DRIVEN_CONTRACTION : KKT_CONTRACTION;
    double before = INFINITY;

    weigh(kkt);
    for (int sweep = 0; sweep < (is_driven ? KKT_DRIVEN_SWEEPS : KKT_MOST_SWEEPS); sweep++) {
        const double size = refine_once(kkt);

        if (size <= enough * size_of(kkt, kkt->answer) ||
            (sweep + 1 >= least && !(size < contraction * before)))
            break;
        before = size;
    }
}

/* the solution by place, from the factors alone */
static void begin_solution(Kkt *kkt, const double *top, const double *bottom)
{
    for (int i = 0; i < kkt->nu; i++)
        kkt->right[kkt->place_of[i]] = top != NULL ? top[i] : 0;
    for (int k = 0; k < kkt->m; k++)
        kkt->right[kkt->place_of[kkt->nu + k]] = bottom[k];
    memcpy(kkt->answer, kkt->right, (size_t)kkt->size * sizeof(double));
    solve(kkt, kkt->answer);
    if (kkt->regularised)
        refine(kkt, KKT_SWEEPS, KKT_CONVERGED);
}

void kkt_solve(Kkt *kkt, const double *top, const double *bottom, double *du, double *lambda)
{
    begin_solution(kkt, top, bottom);
    if (!kkt->regularised && kkt->angle < KKT_INEXACT)
        refine(kkt, 1, KKT_SETTLED);
    for (int i = 0; i < kkt->nu; i++)
        du[i] = kkt->answer[kkt->place_of[i]];
    for (int k = 0; k < kkt->m; k++)
        lambda[k] = kkt->answer[kkt->place_of[kkt->nu + k]];
}

void kkt_correct(Kkt *kkt, const double *bottom, double *du)
{
    begin_solution(kkt, NULL, bottom);
    if (!kkt->regularised && kkt->is_exchanging && kkt->angle < KKT_INEXACT)
        refine(kkt, 1, KKT_SETTLED);
    for (int i = 0; i < kkt->nu; i++)
        du[i] = kkt->answer[kkt->place_of[i]];
}
