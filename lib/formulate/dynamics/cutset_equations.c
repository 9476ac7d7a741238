/* cutset_equations.c: M and F of the recursive form: cutsets projected on motion spaces
 *
 *     M u' + Phi_u^T lambda = F,   M nu x nu, F nu x 1
 *
 * F: inertia forces at u' = 0 and all applied loads, summed inward over both trees. M: column k is
 * the sum of inertia forces, with reversed signs, for u'_k = 1 and everything else at rest. Entry
 * (j, k) is taken from the column of the speed that moves fewer bodies; if both move equally many,
 * from that of the speed further out. */
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/dynamics/composite.h"
#include "formulate/dynamics/composite_mass.h"
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/loads.h"
#include "formulate/dynamics/rests.h"
#include "formulate/dynamics/shapes.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/identity.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/sample.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <math.h>
#include <string.h>

/* Limits for the number of speeds. A mass matrix that is written out is dense, with some 100 bytes
 * for each entry. Where M is computed numerically (composite_mass.h), the largest table holds what
 * the constraints and coordinates derive for each speed: a few numbers an entry. */
enum { MOST_SPEEDS_WRITTEN = 4000, MOST_SPEEDS = 7000 };

/* the row of a speed: its cutset projected on its motion space */
static Expr sums_project(const System *system, const Sums *sums, int speed)
{
    const Speed *own = &system->kinematics->speeds[speed];
    Expr row = expr_int(system->arena, 0);

    if (own->chain >= 0 && !vec_is_zero(sums->torque[own->turn_node]))
        row = vec_dot(system->arena, own->turn, sums->torque[own->turn_node]);
    if (own->slide_node >= 0 && !vec_is_zero(sums->force[own->slide_node]))
        row = expr_add(system->arena, row,
                       vec_dot(system->arena, own->slide, sums->force[own->slide_node]));
    if (speed < system->kinematics->u.count)
        row = expr_add(system->arena, row, sums->own[speed]);
    return row;
}

/* the directions of each speed, in the axes of its nodes */
static void speed_directions(const System *system)
{
    for (int j = 0; j < system->kinematics->speed_count; j++) {
        Speed *own = &system->kinematics->speeds[j];

        if (own->chain >= 0)
            own->turn = speed_axis(system, j, node_axes(system, own->turn_node));
        if (own->slide_node >= 0)
            own->slide = speed_slide(system, j, node_axes(system, own->slide_node));
    }
}

/* velocities of all nodes per unit of one speed */
static Status unit_motion(const System *system, int speed, Vec *v)
{
    Arena *arena = system->arena;
    int turned = system->kinematics->speeds[speed].chain;
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);

    v[order[0]] = vec_zero(arena);
    for (int i = 1; i < nodes; i++) {
        int n = order[i];
        const Frame *frame = &system->kinematics->frames[n];
        int axes = node_axes(system, n);

        TRY(monitor_poll(system->watch));
        v[n] = vec_express(system, v[frame->parent], node_axes(system, frame->parent), axes);
        if (turned >= 0 && orientation_is_beyond(system, frame->step_chain, turned))
            v[n] = vec_add(arena, v[n],
                           vec_cross(arena, speed_axis(system, speed, axes), frame->step));
        if (n == system->kinematics->speeds[speed].slide_node)
            v[n] = vec_add(arena, v[n], speed_slide(system, speed, axes));
        v[n] = vec_hold(arena, v[n]);
    }
    return OK;
}

static void unit_elastic(const System *system, const Elastic *elastic, int speed, const Vec *v,
                         Loads *loads)
{
    Arena *arena = system->arena;
    const int chain = system->kinematics->frames[elastic->node].chain;
    const int turned = system->kinematics->speeds[speed].chain;
    const int count = system->kinematics->u.count;
    const bool turns = turned >= 0 && orientation_is_beyond(system, chain, turned);
    Expr *rates = NEW_ARRAY(Expr, count);
    const Vec w =
        turns ? speed_axis(system, speed, node_axes(system, elastic->node)) : vec_zero(arena);

    for (int j = 0; j < count; j++)
        rates[j] = expr_int(arena, j == speed);
    elastic_add_motion(system, elastic, loads, v[elastic->node], w, rates, 1);
    mem_free(rates);
}

/* inertia forces of that motion, with reversed signs */
static Status unit_loads(const System *system, int speed, const Vec *v, Loads *loads)
{
    Arena *arena = system->arena;
    int turned = system->kinematics->speeds[speed].chain;

    for (int i = 0; i < system->dynamics->masses.count; i++) {
        const Mass *mass = &system->dynamics->masses.at[i];
        int chain = system->kinematics->frames[mass->node].chain;
        bool turns =
            turned >= 0 && mass->has_inertia && orientation_is_beyond(system, chain, turned);

        TRY(monitor_poll(system->watch));
        if (turns) {
            Vec w = speed_axis(system, speed, chain);

            loads_add_torque(system, loads, mass->node, rotation_apply(arena, &mass->inertia, w),
                             chain);
        }
        loads->force[mass->node] =
            vec_add(arena, loads->force[mass->node], vec_scale(arena, mass->mass, v[mass->node]));
    }
    for (int i = 0; i < system->dynamics->elastics.count; i++)
        unit_elastic(system, &system->dynamics->elastics.at[i], speed, v, loads);
    return OK;
}

/* the number of bodies that a speed moves: it turns them, or turns or lengthens the vector to them;
 * `moves` has room for every node */
static int bodies_moved(const System *system, int speed, bool *moves)
{
    int turned = system->kinematics->speeds[speed].chain;
    int nodes;
    const int *order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    int moved = 0;

    moves[order[0]] = false;
    for (int i = 1; i < nodes; i++) {
        const Frame *frame = &system->kinematics->frames[order[i]];

        moves[order[i]] = moves[frame->parent] ||
                          order[i] == system->kinematics->speeds[speed].slide_node ||
                          (turned >= 0 && orientation_is_beyond(system, frame->step_chain, turned));
    }
    for (int i = 0; i < system->dynamics->masses.count; i++) {
        int node = system->dynamics->masses.at[i].node;

        moved += moves[node] ||
                 (turned >= 0 &&
                  orientation_is_beyond(system, system->kinematics->frames[node].chain, turned));
    }
    for (int i = 0; i < system->dynamics->elastics.count; i++) {
        int node = system->dynamics->elastics.at[i].node;

        moved += moves[node] || node == system->kinematics->speeds[speed].shape_node ||
                 (turned >= 0 &&
                  orientation_is_beyond(system, system->kinematics->frames[node].chain, turned));
    }
    return moved;
}

/* whether the pair (j, k) is taken from column k */
static bool column_serves(const System *system, const int *moved, int j, int k)
{
    const Tree *tree = system->origin->trees[TREE_TRANSLATION];
    int depth_j = tree_depth(tree, speed_node(system, j));
    int depth_k = tree_depth(tree, speed_node(system, k));

    if (moved[k] != moved[j])
        return moved[k] < moved[j];
    return depth_k != depth_j ? depth_k > depth_j : k >= j;
}

/* Rows of dependent speeds hold loads on the shapes that they follow from: the nu x nu entries of
 * F' C F, from C of all n speeds. */
static Expr *of_own_speeds(const System *system, const Expr *all, int n)
{
    Arena *arena = system->arena;
    const int nu = system->kinematics->u.count;
    Expr *half = NEW_ARRAY(Expr, (size_t)nu * (size_t)n);
    Expr *mass = pool_alloc(system->pool, (size_t)nu * (size_t)nu * sizeof(Expr));

    for (int j = 0; j < nu; j++)
        memcpy(half + (ptrdiff_t)j * n, all + (ptrdiff_t)j * n, (size_t)n * sizeof(Expr));
    for (int j = nu; j < n; j++) {
        const Dependent *own = &system->kinematics->dependents.at[j - nu];

        for (int i = 0; i < own->count; i++)
            for (int k = 0; k < n; k++) {
                Expr *entry = &half[(own->first + i) * n + k];

                *entry = expr_add(arena, *entry, expr_mul(arena, own->factor[i], all[j * n + k]));
            }
    }
    for (int j = 0; j < nu; j++)
        for (int k = 0; k < n; k++)
            half[j * n + k] = expr_name_temporary(arena, half[j * n + k]);
    for (int j = 0; j < nu; j++)
        memcpy(mass + (ptrdiff_t)j * nu, half + (ptrdiff_t)j * n, (size_t)nu * sizeof(Expr));
    for (int k = nu; k < n; k++) {
        const Dependent *own = &system->kinematics->dependents.at[k - nu];

        for (int i = 0; i < own->count; i++)
            for (int j = 0; j < nu; j++) {
                Expr *entry = &mass[j * nu + own->first + i];

                *entry = expr_add(arena, *entry, expr_mul(arena, own->factor[i], half[j * n + k]));
            }
    }
    for (int j = 0; j < nu; j++)
        for (int k = j; k < nu; k++)
            mass[j * nu + k] = mass[k * nu + j] = expr_name_temporary(arena, mass[j * nu + k]);
    mem_free(half);
    return mass;
}

static Status mass_matrix(System *system)
{
    int n = system->kinematics->speed_count;
    int *moved = NEW_ARRAY(int, n);
    bool *moves = NEW_ARRAY(bool, graph_node_count(system->origin->graph));
    Expr *columns = NEW_ARRAY(Expr, (size_t)n * (size_t)n);
    Expr *mass = pool_alloc(system->pool, (size_t)n * (size_t)n * sizeof(Expr));
    Vec *v = NEW_ARRAY(Vec, graph_node_count(system->origin->graph));
    const Composites composites = composites_new(system, NULL);
    Status status = OK;

    for (int k = 0; k < n; k++) {
        const PoolMark mark = pool_mark(system->pool);
        Loads loads = loads_new(system);
        Sums *sums;

        moved[k] = bodies_moved(system, k, moves);
        if (speed_moves_as_one(system, k)) {
            composite_loads(system, composite_at(system, &composites, speed_node(system, k)), k,
                            &loads);
        } else {
            CHECK(unit_motion(system, k, v));
            CHECK(unit_loads(system, k, v, &loads));
        }
        sums = loads_sum(system, &loads, SUMS_FOR_SPEEDS);
        for (int j = 0; j < n; j++)
            columns[(size_t)k * (size_t)n + (size_t)j] = sums_project(system, sums, j);
        pool_release(system->pool, mark);
        CHECK(monitor_poll(system->watch));
    }
    for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++) {
            bool by_k = column_serves(system, moved, j, k);

            mass[j * n + k] =
                expr_name_temporary(system->arena, by_k ? columns[k * n + j] : columns[j * n + k]);
        }
    system->run.mass = n > system->kinematics->u.count ? of_own_speeds(system, mass, n) : mass;
done:
    MEM_FREE(moved, moves, columns, v);
    return status;
}

typedef struct Inertia {
    Vec force, torque;
} Inertia;

static Inertia inertia_of(const System *system, const Mass *mass, Outward *gravity,
                          const Vec *alpha, const Vec *a)
{
    Arena *arena = system->arena;
    const Vec g = outward_at(system, gravity, node_axes(system, mass->node));
    const int chain = system->kinematics->frames[mass->node].chain;
    Inertia inertia = {vec_scale(arena, mass->mass, vec_sub(arena, g, a[mass->node])),
                       vec_zero(arena)};
    Vec w, spin, torque;

    if (!mass->has_inertia)
        return inertia;
    w = system->kinematics->motions[chain].w;
    spin = vec_hold(arena, rotation_apply(arena, &mass->inertia, w));
    torque = vec_add(arena, rotation_apply(arena, &mass->inertia, alpha[chain]),
                     vec_cross(arena, w, spin));
    inertia.torque = vec_neg(arena, torque);
    return inertia;
}

/* Inertia load of a mass at rest accelerations. For a follower all load on its node is this load so
 * far, as inertia is added before other loads. */
static Inertia find_inertia(const System *system, const Loads *loads, const Mass *mass,
                            const Follower *follower, int first, Outward *gravity)
{
    const Kinematics *kinematics = system->kinematics;
    const bool takes = follower != NULL && isomorphic_moves(follower);
    const Expr identity = takes ? NULL : key_of_inertia(system, mass);
    Inertia inertia;

    if (takes)
        return (Inertia){isomorphic_vec(follower, loads->force[first]),
                         isomorphic_vec(follower, loads->torque[first])};
    if (derived_recall(system, identity, DERIVED_INERTIA, &inertia, sizeof inertia))
        return inertia;
    inertia = inertia_of(system, mass, gravity, kinematics->alpha0, kinematics->a0);
    derived_store(system, identity, DERIVED_INERTIA, &inertia, sizeof inertia);
    return inertia;
}

void loads_add_inertia(const System *system, Loads *loads, const Vec *alpha, const Vec *a,
                       const Expr *accelerations)
{
    Outward gravity = outward_new(system, system->origin->gravity);

    /* first those that others take over */
    for (int level = 0, done = 0; done < system->dynamics->masses.count; level++)
        for (int i = 0; i < system->dynamics->masses.count; i++) {
            const Mass *mass = &system->dynamics->masses.at[i];
            int first;
            const Follower *follower =
                accelerations == NULL ? isomorphic_node(system, mass->node, &first) : NULL;
            Inertia inertia;

            if ((accelerations == NULL ? isomorphic_level(system, mass->node) : 0) != level)
                continue;
            inertia = accelerations == NULL
                          ? find_inertia(system, loads, mass, follower, first, &gravity)
                          : inertia_of(system, mass, &gravity, alpha, a);
            loads->force[mass->node] =
                vec_add(system->arena, loads->force[mass->node], inertia.force);
            loads->torque[mass->node] =
                vec_add(system->arena, loads->torque[mass->node], inertia.torque);
            done++;
        }
    for (int i = 0; i < system->dynamics->elastics.count; i++)
        elastic_add_inertia(system, &system->dynamics->elastics.at[i], loads, alpha, a,
                            accelerations);
    outward_free(&gravity);
}

void loads_add_mass(const System *system, Loads *loads, const Mass *mass, const Vec *alpha,
                    const Vec *a)
{
    Outward gravity = outward_new(system, system->origin->gravity);
    const Inertia inertia = inertia_of(system, mass, &gravity, alpha, a);
    const int axes = node_axes(system, mass->node);

    loads_add_force(system, loads, mass->node, inertia.force, axes);
    loads_add_torque(system, loads, mass->node, inertia.torque, axes);
    outward_free(&gravity);
}

static bool is_one_of(Expr symbol, const Expr *symbols, int count)
{
    for (int i = 0; i < count; i++)
        if (symbols[i] == symbol)
            return true;
    return false;
}

/* an effort on a coordinate acts on the speeds that the coordinate depends on */
static void add_on_coordinate(const System *system, Expr coordinate, Expr effort)
{
    Arena *arena = system->arena;
    Expr *symbols;
    const int count = expr_symbols(&coordinate, 1, &symbols);

    effort = expr_name_temporary(arena, effort);
    for (int i = 0; i < system->kinematics->q.count; i++) {
        const CoordinateRate *rate = &system->kinematics->coordinate_rates[i];
        const Expr symbol = system->kinematics->q.at[i].symbol;

        for (int k = 0; is_one_of(symbol, symbols, count) && k < rate->count; k++) {
            Expr *force = &system->run.force[rate->speed[k]];
            Expr *push = &system->dynamics->pushes[rate->speed[k]];
            const Expr share = expr_product(
                arena, (Expr[]){expr_diff(arena, coordinate, symbol), rate->entry[k], effort}, 3);

            *force = expr_add(arena, *force, share);
            *push = expr_add(arena, *push, share);
        }
    }
    mem_free(symbols);
}

/* adds a part's share to an entry of M */
static void add_share(System *system, int row, int column, Expr share)
{
    if (!expr_is_zero(share))
        LIST_PUSH(system->dynamics->shares, (Entry){row, column, share});
}

/* an inertia J on a coordinate s: J s_j s_k in M, -J s_j (s'' at u' = 0) in F */
static Status add_rotor(System *system, const Instance *instance, Diag *diag)
{
    Arena *arena = system->arena;
    int n = system->kinematics->u.count;
    const Instance *joint = &system->origin->instances[instance->joint];
    Expr inertia = instance->row->rotor(instance, arena);
    Expr s;
    Expr second;
    Expr *zeros = NEW_ARRAY(Expr, n);
    Expr *moved = NEW_ARRAY(Expr, n);
    Status status = OK;

    if (expr_is_zero(inertia))
        goto done;
    CHECK(coordinate_value(system, joint, instance->joint_coordinate, 0, &s, diag));
    CHECK(coordinate_value(system, joint, instance->joint_coordinate, 2, &second, diag));
    for (int j = 0; j < n; j++)
        zeros[j] = expr_int(arena, 0);
    second = expr_substitute(arena, second, system->kinematics->accelerations, zeros, n);
    add_on_coordinate(system, s, expr_neg(arena, expr_mul(arena, inertia, second)));
    for (int j = 0; j < n; j++)
        moved[j] = speed_partial(system, s, j);
    for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++)
            add_share(system, j, k, expr_product(arena, (Expr[]){inertia, moved[j], moved[k]}, 3));
done:
    MEM_FREE(moved, zeros);
    return status;
}

static Status add_inertia(System *system, const Effort *effort, Diag *diag)
{
    Arena *arena = system->arena;
    int n = system->kinematics->u.count;

    for (int k = 0; law_is_inertial(effort->value) && k < n; k++) {
        Expr slope = effort->value;

        TRY(law_add(system, effort->instance, k, &slope, diag));
        for (int j = 0; j < n && !expr_is_zero(slope); j++)
            add_share(
                system, j, k,
                expr_neg(arena,
                         expr_mul(arena, speed_partial(system, effort->displacement, j), slope)));
    }
    return OK;
}

enum { MOST_SAMPLES = 8, ENOUGH_SAMPLES = 2 }; /* laws may be undefined at some */

/* whether M(j, k) equals M(k, j) within the rounding error of what the two speeds move */
static bool is_symmetric(const System *system, Sample *const *samples, int j, int k)
{
    const Expr *mass = system->run.mass;
    const int n = system->kinematics->u.count;
    const Expr a = mass[j * n + k], b = mass[k * n + j];
    int identity = a == b ? ENOUGH_SAMPLES : 0;

    for (int i = 0; i < MOST_SAMPLES && identity < ENOUGH_SAMPLES; i++) {
        const double off = sample_number(samples[i], a) - sample_number(samples[i], b);
        const double size =
            sample_number(samples[i], mass[j * n + j]) * sample_number(samples[i], mass[k * n + k]);

        if (fabs(off) > 1e-9 * sqrt(fabs(size)))
            return false;
        identity += !isnan(off) && !isnan(size);
    }
    return identity >= ENOUGH_SAMPLES;
}

/* a part whose law contains one of the two entries of u' */
static const char *pusher_that_reads(System *system, int j, int k)
{
    const Expr *u_dot = system->kinematics->accelerations;
    Pusher pusher;

    for (int next = 0; system_pusher(system, &next, &pusher);)
        for (int i = 0; i < pusher.count; i++)
            if (!expr_is_zero(expr_diff(system->arena, pusher.value[i], u_dot[j])) ||
                !expr_is_zero(expr_diff(system->arena, pusher.value[i], u_dot[k])))
                return pusher.name;
    return "a load";
}

/* E_MODEL where M is not symmetric at random points: a force reads an acceleration without acting
 * along it. */
static Status check_symmetry(System *system, Diag *diag)
{
    int n = system->kinematics->u.count;
    Sample *samples[MOST_SAMPLES];

    for (int i = 0; i < MOST_SAMPLES; i++) {
        samples[i] = sample_new(system, 3 + (uint64_t)i, true);
        sample_keep_data(samples[i]);
        samples[i]->others = 1 + (uint32_t)i;
    }
    for (int j = 0; j < n; j++)
        for (int k = 0; k < j; k++)
            if (!is_symmetric(system, samples, j, k)) {
                (void)diag_set(diag, E_MODEL,
                               "%s passes the acceleration of one of %s and %s on to the other one "
                               "way only",
                               pusher_that_reads(system, j, k), system->kinematics->u.at[k].name,
                               system->kinematics->u.at[j].name);
                diag_hint(
                    diag,
                    "as inertia the law has to push along what it reads, which trees of "
                    "joints see best ('tree joint'); else put a compliance between, as a shaft "
                    "with k=, or let it read the acceleration of a body b through a network: "
                    "vsource S a 0 b.ax, resistor R a 0 1 and R.i");
                return E_MODEL;
            }
    return OK;
}

static void take_shares(System *system)
{
    for (int i = 0; i < system->dynamics->shares.count; i++) {
        const Entry *share = &system->dynamics->shares.at[i];
        Expr *entry = &system->run.mass[share->row * system->kinematics->u.count + share->column];

        *entry = expr_name_temporary(system->arena, expr_add(system->arena, *entry, share->value));
    }
}

Status drive_coordinate(System *system, int drive, Expr *out, Diag *diag)
{
    const Origin *origin = system->origin;
    const Instance *driver = &origin->instances[system->constraints->drives.at[drive].instance];

    if (driver->by >= 0 && driver->by_coordinate >= 0)
        return coordinate_value(system, &origin->instances[driver->by], driver->by_coordinate, 0,
                                out, diag);
    *out = NULL;
    return OK;
}

static Status joint_efforts(System *system, Diag *diag)
{
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        Effort effort;

        if (instance->joint < 0 || instance->row->family == FAMILY_DRIVER ||
            instance->row->family == FAMILY_COUPLER)
            continue;
        if (instance->row->effort != NULL) {
            TRY(effort_of(system, instance, &effort, diag));
            TRY(add_inertia(system, &effort, diag));
            TRY(law_add(system, instance, TAKE_AT_REST, &effort.value, diag));
            add_on_coordinate(system, effort.displacement, effort.value);
        }
        if (instance->row->rotor != NULL)
            TRY(add_rotor(system, instance, diag));
    }
    /* an effort that an inverse run computes at another coordinate */
    for (int i = 0; i < system->constraints->drives.count; i++) {
        Expr s;

        TRY(drive_coordinate(system, i, &s, diag));
        if (s != NULL)
            add_on_coordinate(system, s, system->constraints->drives.at[i].effort);
    }
    for (int i = 0; i < system->origin->rest_count; i++) {
        Expr guard, effort;

        TRY(rest_effort(system, i, &guard, &effort, diag));
        if (guard != NULL)
            add_on_coordinate(system, guard, effort);
    }
    if (system->dynamics->has_inertial_laws && system->run.mass == NULL)
        TRY(mass_matrix(system));
    if (system->run.mass != NULL)
        take_shares(system);
    if (system->dynamics->has_inertial_laws)
        TRY(check_symmetry(system, diag));
    return OK;
}

/* the rows: loads beyond each speed; loads on section frames act on shapes */
static void project(System *system, const Sums *sums, Expr *rows)
{
    Arena *arena = system->arena;
    const int nu = system->kinematics->u.count;

    for (int j = 0; j < nu; j++)
        rows[j] = sums_project(system, sums, j);
    for (int j = nu; j < system->kinematics->speed_count; j++) {
        const Dependent *own = &system->kinematics->dependents.at[j - nu];
        const Expr row = expr_name_temporary(arena, sums_project(system, sums, j));

        for (int i = 0; i < own->count; i++) {
            Expr *at = &rows[own->first + i];

            *at = expr_add(arena, *at, expr_mul(arena, own->factor[i], row));
        }
    }
    for (int j = 0; j < nu; j++)
        rows[j] = expr_name_temporary(arena, rows[j]);
}

/* adds the parts of laws between frames that contain u' */
static Status take_inertial_laws(System *system, Diag *diag)
{
    const int n = system->kinematics->u.count;
    Expr *rows = NEW_ARRAY(Expr, n);
    Status status = OK;

    for (int k = 0; k < n && system->dynamics->has_inertial_laws; k++) {
        const PoolMark mark = pool_mark(system->pool);
        Loads loads = loads_new(system);

        CHECK(efforts_add(system, &loads, k, diag));
        project(system, loads_sum(system, &loads, SUMS_FOR_SPEEDS), rows);
        pool_release(system->pool, mark);
        for (int j = 0; j < n; j++)
            add_share(system, j, k, expr_neg(system->arena, rows[j]));
        CHECK(monitor_poll(system->watch));
    }
done:
    mem_free(rows);
    return status;
}

static Status check_size(const System *system, int most, Diag *diag)
{
    if (system->kinematics->u.count <= most)
        return OK;
    (void)diag_set(diag, E_MODEL, "the mechanism has %d speeds; %d are the most here",
                   system->kinematics->u.count, most);
    diag_hint(diag,
              "a joint in place of a free body takes speeds away, and so does a planar scene");
    return E_MODEL;
}

Status dynamics_build(System *system, Diag *diag)
{
    int n = system->kinematics->u.count;
    Loads loads;

    TRY(check_size(system, MOST_SPEEDS, diag));
    system->run.force = pool_alloc(system->pool, (size_t)n * sizeof(Expr));
    system->dynamics->pushes = pool_alloc(system->pool, (size_t)n * sizeof(Expr));
    if (n == 0)
        return OK;
    for (int j = 0; j < n; j++)
        system->dynamics->pushes[j] = expr_int(system->arena, 0);
    speed_directions(system);
    if (!composite_mass_build(system)) {
        TRY(check_size(system, MOST_SPEEDS_WRITTEN, diag));
        TRY(mass_matrix(system));
    }
    loads = loads_new(system);
    loads_add_inertia(system, &loads, system->kinematics->alpha0, system->kinematics->a0, NULL);
    TRY(efforts_add(system, &loads, TAKE_AT_REST, diag));
    project(system, loads_sum(system, &loads, SUMS_FOR_SPEEDS), system->run.force);
    TRY(take_inertial_laws(system, diag));
    return joint_efforts(system, diag);
}

Status system_pushes(System *system, Expr *out, Diag *diag)
{
    const int nodes = graph_node_count(system->origin->graph);
    bool none = true;
    PoolMark mark;
    Loads loads;

    system_touch(system);
    mark = pool_mark(system->pool);
    loads = loads_new(system);
    TRY(efforts_add(system, &loads, TAKE_AT_REST, diag));
    for (int i = 0; i < nodes && none; i++)
        none = vec_is_zero(loads.force[i]) && vec_is_zero(loads.torque[i]);
    for (int j = 0; j < system->kinematics->u.count; j++)
        out[j] = expr_add(system->arena, loads.own[j], system->dynamics->pushes[j]);
    if (!none) {
        const Sums *sums = loads_sum(system, &loads, SUMS_FOR_SPEEDS);

        for (int j = 0; j < system->kinematics->u.count; j++)
            out[j] = expr_name_temporary(system->arena,
                                         expr_add(system->arena, system->dynamics->pushes[j],
                                                  sums_project(system, sums, j)));
    }
    pool_release(system->pool, mark);
    return OK;
}

/* what parts add to M, times u' */
static Expr shares_times(const System *system, int speed, const Expr *acceleration)
{
    Expr sum = expr_int(system->arena, 0);

    for (int i = 0; i < system->dynamics->shares.count; i++) {
        const Entry *share = &system->dynamics->shares.at[i];

        if (share->row == speed)
            sum = expr_add(system->arena, sum,
                           expr_mul(system->arena, share->value, acceleration[share->column]));
    }
    return sum;
}

bool dynamics_lack(System *system, const Expr *acceleration, Expr *out)
{
    const int nu = system->kinematics->u.count;
    Vec *alpha, *a;
    PoolMark mark;
    Loads loads;
    bool is_determined = false;

    if (system->kinematics->speed_count > nu)
        return false;
    system_touch(system);
    mark = pool_mark(system->pool);
    alpha = NEW_ARRAY(Vec, system->kinematics->chains.count);
    a = NEW_ARRAY(Vec, graph_node_count(system->origin->graph));
    accelerations_build(system, acceleration, alpha, a);
    loads = loads_new(system);
    loads_add_inertia(system, &loads, alpha, a, acceleration);
    if (efforts_add(system, &loads, TAKE_AT_REST, NULL) == OK) {
        const Sums *sums = loads_sum(system, &loads, SUMS_FOR_SPEEDS);

        for (int j = 0; j < nu; j++) {
            const Expr there =
                expr_add(system->arena, sums_project(system, sums, j), system->dynamics->pushes[j]);

            out[j] = expr_name_temporary(
                system->arena,
                expr_sub(system->arena, shares_times(system, j, acceleration), there));
        }
        is_determined = true;
    }
    MEM_FREE(alpha, a);
    pool_release(system->pool, mark);
    return is_determined;
}

Status system_form_mass(System *system, Diag *diag)
{
    Status status = OK;

    if (system->run.mass != NULL || system->kinematics->u.count == 0)
        return OK;
    system_touch(system);
    CHECK(mass_matrix(system));
    take_shares(system);
    if (arena_status(system->arena) != OK) {
        system->run.mass = NULL;
        status = diag_set(diag, arena_status(system->arena), "the mass matrix is too large: %s",
                          arena_failure(system->arena));
        arena_reset(system->arena);
    }
    system->definitions.mass = system->run.mass;
done:
    return status;
}
