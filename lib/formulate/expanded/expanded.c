/* expanded.c: the expanded form, entry by entry
 *
 * The same equations written as by hand: per body, partial velocities as sums over frames,
 * dot products of those (theory 4), then trigonometric folding and collecting of common
 * factors. v_j and w_j are the velocity and angular velocity of a body per unit of u_j. */
#include "formulate/expanded/expanded.h"
#include "formulate/dynamics/bushings.h"
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/rests.h"
#include "formulate/dynamics/rubbing.h"
#include "formulate/dynamics/shapes.h"
#include "formulate/expanded/derivation.h"
#include "formulate/expanded/derivation_impl.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/framesum.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <string.h>

/* --- entries --- */

/* `e` folded and collected, where that is shorter than `best` */
static Expr shorter(Arena *arena, Expr best, Expr e)
{
    e = expr_collect(arena, expr_fold(arena, e));
    return op_count_total(expr_count(&e, 1)) < op_count_total(expr_count(&best, 1)) ? e : best;
}

/* as built, or multiplied out first where folding then gives less, all of it or with sums of
 * constants kept together; products of long sums are not multiplied out */
Expr expanded_tidy(System *system, Expr e)
{
    enum { MOST_TERMS = 200 };
    Arena *arena = system->arena;
    Expr open = expr_open(arena, e);
    bool kept = false;
    Expr varying = expr_expand_over(arena, open, ~(1U << SYMBOL_PARAMETER), MOST_TERMS, &kept);
    Expr whole = kept ? expr_expand(arena, open, MOST_TERMS) : varying;
    Expr best = expr_collect(arena, expr_fold(arena, open));

    if (whole != open)
        best = shorter(arena, best, whole);
    if (varying != whole && varying != open)
        best = shorter(arena, best, varying);
    return best;
}

Expr system_written(System *system, Expr e)
{
    enum { MOST_OPERATIONS = 1000 }; /* shared; a longer one is written over named subexpressions */

    return op_count_total(expr_count_shared(&e, 1)) <= MOST_OPERATIONS
               ? expanded_tidy(system, e)
               : expr_fold(system->arena, e);
}

/* the coordinate that a rotor turns with, as an expression; NULL where the part has no rotor */
static Status rotor_of(System *system, const Instance *instance, Expr *inertia, Expr *s, Diag *diag)
{
    *s = NULL;
    if (instance->row->rotor == NULL || instance->joint < 0)
        return OK;
    *inertia = instance->row->rotor(instance, system->arena);
    if (expr_is_zero(*inertia))
        return OK;
    return coordinate_value(system, &system->origin->instances[instance->joint],
                            instance->joint_coordinate, 0, s, diag);
}

static void push_term(Terms *terms, TermKind kind, int instance, Expr value)
{
    LIST_PUSH(*terms, (Term){.kind = kind, .edge = -1, .instance = instance, .value = value});
}

/* distance of two frames, as shown to the user */
static Expr length_shown(const System *system, const Instance *instance)
{
    FrameSum way = framesum_way(system, instance->tail, instance->head);

    return expr_sqrt(system->arena, expr_fold(system->arena, framesum_dot(system, way, way)));
}

static Status push_effort(System *system, const Instance *instance, int j, int take, Terms *terms,
                          Diag *diag)
{
    Arena *arena = system->arena;
    Effort effort;

    TRY(effort_of(system, instance, &effort, diag));
    if (effort.is_line) {
        Expr length = length_shown(system, instance);
        Motion1 motion = {length, NULL, expr_int(arena, 0), expr_int(arena, 0)};

        TRY(system_rate_of(system, length, &motion.rate, diag));
        effort.value = instance->row->effort(instance, arena, &motion);
        TRY(law_read(system, instance, effort.value, &effort.value, diag));
        effort.displacement = length;
    }
    TRY(law_add(system, instance, take, &effort.value, diag));
    push_term(terms, TERM_EFFORT, instance->number,
              expr_mul(arena, effort.value, speed_partial(system, effort.displacement, j)));
    return OK;
}

static Status push_wrench(System *system, const Instance *instance, int j, int take, Terms *terms,
                          Diag *diag)
{
    int own = system->kinematics->frames[instance->head].chain;
    Vec force;
    Vec torque;
    int chain;

    TRY(wrench_of(system, instance, take, &force, &torque, &chain, diag));
    push_term(terms, TERM_FORCE, instance->number,
              framesum_dot(system, framesum_of(system, chain, force),
                           partial_velocity(system, instance->head, j)));
    push_term(terms, TERM_TORQUE, instance->number,
              framesum_dot(system, framesum_of(system, chain, torque),
                           framesum_of(system, own, partial_turn(system, own, j))));
    return OK;
}

/* efforts times what speed j adds to their rates, which are linear in speeds */
static Status push_rubbing(System *system, const Instance *instance, int j, int take, Terms *terms,
                           Diag *diag)
{
    Arena *arena = system->arena;
    FrictionLoad rubbing;

    TRY(rubbing_of(system, instance, take, &rubbing, diag));
    for (int k = 0; k < rubbing.count; k++)
        push_term(terms, TERM_EFFORT, instance->number,
                  expr_mul(arena, rubbing.effort[k],
                           expr_diff(arena, expr_open(arena, rubbing.rate[k]),
                                     system->kinematics->u.at[j].symbol)));
    return OK;
}

/* likewise of a bushing's force and moment */
static Status push_bushing(System *system, const Instance *instance, int j, Terms *terms,
                           Diag *diag)
{
    Arena *arena = system->arena;
    const Expr speed = system->kinematics->u.at[j].symbol;
    Expr term[MOST_RELATIVE];
    BushingLoad b;

    TRY(bushing_of(system, instance, &b, diag));
    for (int i = 0; i < 3; i++) {
        term[i] = expr_mul(arena, b.force.at[i],
                           expr_diff(arena, expr_open(arena, b.motion.at[i]), speed));
        term[3 + i] = expr_mul(arena, b.torque.at[i],
                               expr_diff(arena, expr_open(arena, b.turning.at[i]), speed));
    }
    push_term(terms, TERM_EFFORT, instance->number, expr_sum(arena, term, MOST_RELATIVE));
    terms->at[terms->count - 1].is_long = !system->origin->planar; /* of a rotation vector */
    return OK;
}

/* what a law that contains u' adds to M */
static Status push_inertia_of(System *system, const Instance *instance, int j, int k, Terms *terms,
                              Diag *diag)
{
    const int first = terms->count;

    if (!system->dynamics->has_inertial_laws)
        return OK;
    if (instance->row->effort != NULL)
        TRY(push_effort(system, instance, j, k, terms, diag));
    if (instance->row->wrench != NULL)
        TRY(push_wrench(system, instance, j, k, terms, diag));
    if (instance->row->rub != NULL)
        TRY(push_rubbing(system, instance, j, k, terms, diag));
    for (int i = first; i < terms->count; i++)
        terms->at[i] = (Term){.kind = TERM_ROTOR,
                              .edge = -1,
                              .instance = instance->number,
                              .value = expr_neg(system->arena, terms->at[i].value)};
    return OK;
}

/* what a flexible part adds, in one term */
static void push_shapes(System *system, const Elastic *elastic, Summands *summands, Terms *terms)
{
    push_term(terms, TERM_SHAPES, elastic->instance,
              expr_sum(system->arena, summands->at, summands->count));
    LIST_FREE(*summands);
}

/* what the load of a beam adds to M where its law contains u' */
static Status push_inertial_load(System *system, const Elastic *elastic, int j, int k,
                                 Summands *terms, Diag *diag)
{
    const int first = terms->count;
    const Status status = elastic_load_terms(system, elastic, j, k, terms, diag);

    for (int i = first; i < terms->count; i++)
        terms->at[i] = expr_neg(system->arena, terms->at[i]);
    return status;
}

static Status mass_terms(System *system, int j, int k, Terms *terms, Diag *diag)
{
    Arena *arena = system->arena;

    for (int i = 0; i < system->dynamics->masses.count; i++) {
        const Mass *mass = &system->dynamics->masses.at[i];
        int chain = system->kinematics->frames[mass->node].chain;
        FrameSum v_j = partial_velocity(system, mass->node, j);
        FrameSum v_k = j == k ? v_j : partial_velocity(system, mass->node, k);

        push_term(terms, TERM_MASS, mass->instance,
                  expr_mul(arena, mass->mass, framesum_dot(system, v_j, v_k)));
        if (mass->has_inertia)
            push_term(
                terms, TERM_INERTIA, mass->instance,
                vec_dot(arena, partial_turn(system, chain, j),
                        rotation_apply(arena, &mass->inertia, partial_turn(system, chain, k))));
    }
    for (int i = 0; i < system->dynamics->elastics.count; i++) {
        const Elastic *elastic = &system->dynamics->elastics.at[i];
        Summands summands = {0};

        elastic_mass_terms(system, elastic, j, k, &summands);
        if (system->dynamics->has_inertial_laws)
            TRY(push_inertial_load(system, elastic, j, k, &summands, diag));
        push_shapes(system, elastic, &summands, terms);
    }
    for (int i = 0; i < system->origin->instance_count; i++) {
        Expr inertia;
        Expr s;

        TRY(rotor_of(system, &system->origin->instances[i], &inertia, &s, diag));
        if (s != NULL)
            push_term(terms, TERM_ROTOR, i,
                      expr_product(arena,
                                   (Expr[]){inertia, speed_partial(system, s, j),
                                            speed_partial(system, s, k)},
                                   3));
        TRY(push_inertia_of(system, &system->origin->instances[i], j, k, terms, diag));
    }
    return OK;
}

/* weight and velocity products of the masses, in one term or separately (`apart`) */
static void push_inertia(const System *system, int j, bool apart, Terms *terms)
{
    Arena *arena = system->arena;

    for (int i = 0; i < system->dynamics->masses.count; i++) {
        const Mass *mass = &system->dynamics->masses.at[i];
        int chain = system->kinematics->frames[mass->node].chain;
        FrameSum v_j = partial_velocity(system, mass->node, j);
        FrameSum weight = framesum_of(system, 0, system->origin->gravity);
        FrameSum rest = rest_acceleration(system, mass->node);

        if (apart)
            push_term(terms, TERM_WEIGHT, mass->instance,
                      expr_mul(arena, mass->mass, framesum_dot(system, v_j, weight)));
        rest =
            framesum_add(system, apart ? (FrameSum){NULL, 0} : weight, expr_int(arena, -1), rest);
        push_term(terms, TERM_MASS, mass->instance,
                  expr_mul(arena, mass->mass, framesum_dot(system, v_j, rest)));
        if (mass->has_inertia) {
            Vec w;
            Vec alpha;
            Vec torque;

            orientation_motion(system, chain, &w, &alpha);
            torque = vec_add(arena, rotation_apply(arena, &mass->inertia, alpha),
                             vec_cross(arena, w, rotation_apply(arena, &mass->inertia, w)));
            push_term(terms, TERM_INERTIA, mass->instance,
                      expr_neg(arena, vec_dot(arena, partial_turn(system, chain, j), torque)));
        }
    }
}

/* the second rate of `e` at u' = 0 */
static Status second_rate_at_rest(System *system, Expr e, Expr *out, Diag *diag)
{
    TRY(system_rate_of(system, e, out, diag));
    TRY(system_rate_of(system, *out, out, diag));
    *out = expr_substitute(system->arena, *out, system->kinematics->accelerations, NULL,
                           system->kinematics->u.count);
    return OK;
}

static Status push_rotor(System *system, const Instance *instance, int j, Terms *terms, Diag *diag)
{
    Arena *arena = system->arena;
    Expr inertia;
    Expr s;
    Expr second;

    TRY(rotor_of(system, instance, &inertia, &s, diag));
    if (s == NULL)
        return OK;
    TRY(second_rate_at_rest(system, s, &second, diag));
    second = expr_product(arena, (Expr[]){inertia, second, speed_partial(system, s, j)}, 3);
    push_term(terms, TERM_ROTOR, instance->number, expr_neg(arena, second));
    return OK;
}

static Status push_elastic(System *system, const Elastic *elastic, int j, Terms *terms, Diag *diag)
{
    Summands summands = {0};
    Status status;

    elastic_force_terms(system, elastic, j, &summands);
    status = elastic_load_terms(system, elastic, j, TAKE_AT_REST, &summands, diag);
    push_shapes(system, elastic, &summands, terms);
    return status;
}

static Status push_forces(System *system, int j, bool apart, Terms *terms, Diag *diag)
{
    push_inertia(system, j, apart, terms);
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];

        if (instance->row->wrench != NULL)
            TRY(push_wrench(system, instance, j, TAKE_AT_REST, terms, diag));
        if (instance->row->effort != NULL)
            TRY(push_effort(system, instance, j, TAKE_AT_REST, terms, diag));
        if (instance->row->rub != NULL)
            TRY(push_rubbing(system, instance, j, TAKE_AT_REST, terms, diag));
        if (instance->row->restore != NULL)
            TRY(push_bushing(system, instance, j, terms, diag));
        TRY(push_rotor(system, instance, j, terms, diag));
    }
    for (int i = 0; i < system->dynamics->elastics.count; i++)
        TRY(push_elastic(system, &system->dynamics->elastics.at[i], j, terms, diag));
    for (int i = 0; i < system->constraints->drives.count; i++) {
        Expr s;

        TRY(drive_coordinate(system, i, &s, diag));
        if (s != NULL)
            push_term(terms, TERM_DRIVE, system->constraints->drives.at[i].instance,
                      expr_mul(system->arena, system->constraints->drives.at[i].effort,
                               speed_partial(system, s, j)));
    }
    for (int i = 0; i < system->origin->rest_count; i++) {
        Expr guard, effort;

        TRY(rest_effort(system, i, &guard, &effort, diag));
        if (guard != NULL)
            push_term(terms, TERM_EFFORT, -1,
                      expr_mul(system->arena, effort, speed_partial(system, guard, j)));
    }
    return OK;
}

static Status force_terms(System *system, int j, int column, Terms *terms, Diag *diag)
{
    (void)column;
    return push_forces(system, j, true, terms, diag);
}

static Status forces_together(System *system, int j, int column, Terms *terms, Diag *diag)
{
    (void)column;
    return push_forces(system, j, false, terms, diag);
}

/* the shown form of an entry that is a sum of terms */
static Status show_sum(System *system, TermsFunction *terms_of, int row, int column, Expr *out,
                       Diag *diag)
{
    Summands values = {0}, rest = {0};
    Terms terms = {0};
    Status status = OK;

    CHECK(terms_of(system, row, column, &terms, diag));
    for (int i = 0; i < terms.count; i++)
        if (terms.at[i].is_long)
            LIST_PUSH(rest, expr_open(system->arena, terms.at[i].value));
        else
            LIST_PUSH(values, terms.at[i].value);
    LIST_PUSH(rest, expanded_tidy(system, expr_sum(system->arena, values.at, values.count)));
    *out = expr_sum(system->arena, rest.at, rest.count);
done:
    LIST_FREE(values);
    LIST_FREE(rest);
    LIST_FREE(terms);
    return status;
}

static Status show_mass(System *system, int j, int k, Expr *out, Diag *diag)
{
    return show_sum(system, mass_terms, j, k, out, diag);
}

static Status show_force(System *system, int j, int column, Expr *out, Diag *diag)
{
    return show_sum(system, forces_together, j, column, out, diag);
}

static Status show_constraint(System *system, int k, int column, Expr *out, Diag *diag)
{
    const Row *row = &system->constraints->rows.at[k];

    (void)column;
    (void)diag;
    *out = row->reported.is_rate ? expanded_tidy(system, row->rate) : row->phi;
    return OK;
}

static Status show_jacobian(System *system, int k, int j, Expr *out, Diag *diag)
{
    const Row *row = &system->constraints->rows.at[k];

    (void)diag;
    *out = expanded_tidy(
        system, row->rate == NULL ? speed_partial(system, row->phi, j)
                                  : system->definitions.phi_u[k * system->kinematics->u.count + j]);
    return OK;
}

static Status show_velocity(System *system, int k, int column, Expr *out, Diag *diag)
{
    const Row *row = &system->constraints->rows.at[k];

    (void)column;
    (void)diag;
    *out = expanded_tidy(
        system,
        row->rate != NULL
            ? system->definitions.nu[k]
            : expr_neg(system->arena, expr_diff(system->arena, row->phi,
                                                expr_symbol(system->arena, "t", SYMBOL_TIME))));
    return OK;
}

static Status show_acceleration(System *system, int k, int column, Expr *out, Diag *diag)
{
    const Row *row = &system->constraints->rows.at[k];
    Expr second;

    (void)column;
    if (row->rate != NULL) {
        *out = expanded_tidy(system, system->definitions.gamma[k]);
        return OK;
    }
    TRY(second_rate_at_rest(system, row->phi, &second, diag));
    *out = expanded_tidy(system, expr_neg(system->arena, second));
    return OK;
}

static Status show_network(System *system, int row, int column, Expr *out, Diag *diag)
{
    (void)diag;
    *out = expanded_tidy(system, system_network_entry(system, row, column));
    return OK;
}

static Status show_network_rhs(System *system, int row, int column, Expr *out, Diag *diag)
{
    (void)column;
    (void)diag;
    *out = expanded_tidy(system, system->run.network_rhs[row]);
    return OK;
}

/* --- the table of blocks --- */

typedef struct BlockRow {
    const char *name;
    EntryFunction *show;  /* NULL: projected (embedded.c) */
    TermsFunction *terms; /* the terms that the entry is the sum of; NULL: none that have a name */
} BlockRow;

static const BlockRow blocks[BLOCK_COUNT] = {
    [BLOCK_MASS] = {"mass", show_mass, mass_terms},
    [BLOCK_FORCES] = {"forces", show_force, force_terms},
    [BLOCK_CONSTRAINTS] = {"constraints", show_constraint, constraint_terms},
    [BLOCK_JACOBIAN] = {"jacobian", show_jacobian, jacobian_terms},
    [BLOCK_VELOCITY] = {"velocity", show_velocity, NULL},
    [BLOCK_ACCELERATION] = {"acceleration", show_acceleration, NULL},
    [BLOCK_NETWORK] = {"network", show_network, NULL},
    [BLOCK_NETWORK_RHS] = {"network_rhs", show_network_rhs, NULL},
    [BLOCK_EMBEDDED_MASS] = {"embedded_mass", NULL, NULL},
    [BLOCK_EMBEDDED_FORCES] = {"embedded_forces", NULL, NULL},
    [BLOCK_DEPENDENT_RATES] = {"dependent_rates", NULL, NULL},
    [BLOCK_COMPLEMENT] = {"complement", NULL, NULL},
};

const char *block_name(Block block)
{
    return blocks[block].name;
}

int embedded_rows(const System *system)
{
    int rows = system->kinematics->u.count;

    for (int k = 0; k < system->constraints->rows.count; k++)
        rows -= system->constraints->rows.at[k].kind != ROW_DRIVER;
    return rows > 0 ? rows : 0;
}

void system_block_size(const System *system, Block block, int *rows, int *columns)
{
    int n = system->kinematics->u.count;
    int m = system->constraints->rows.count;
    int w = system->network->x.count + system->network->z.count;
    int f = embedded_rows(system);
    const int sizes[BLOCK_COUNT][2] = {
        [BLOCK_MASS] = {n, n},
        [BLOCK_FORCES] = {n, 1},
        [BLOCK_CONSTRAINTS] = {m, 1},
        [BLOCK_JACOBIAN] = {m, n},
        [BLOCK_VELOCITY] = {m, 1},
        [BLOCK_ACCELERATION] = {m, 1},
        [BLOCK_NETWORK] = {w, w},
        [BLOCK_NETWORK_RHS] = {w, 1},
        [BLOCK_EMBEDDED_MASS] = {f, n},
        [BLOCK_EMBEDDED_FORCES] = {f, 1},
        [BLOCK_DEPENDENT_RATES] = {n - f, f},
        [BLOCK_COMPLEMENT] = {n, f},
    };

    *rows = sizes[block][0];
    *columns = sizes[block][1];
}

/* --- the budget --- */

/* counts the orientation classes whose turns move a mass on its path from ground, and the remaining
 * turns between them */
static void way_size(const System *system, int node, int *parts, int *turns)
{
    Turns between = {0};
    int last = -1;

    *parts = 1;
    turns_between(system, 0, system->kinematics->frames[node].chain, &between);
    *turns = between.count;
    LIST_FREE(between);
    for (; system->kinematics->frames[node].parent >= 0;
         node = system->kinematics->frames[node].parent) {
        const Frame *frame = &system->kinematics->frames[node];

        if (!vec_is_zero(frame->shift) && frame->step_chain != last) {
            last = frame->step_chain;
            ++*parts;
        }
    }
}

/* Whether entries of M and F can be expanded. Estimates the number of their terms before any is
 * built: each pair of parts of two velocities is rotated into common axes, and a turn about another
 * axis makes three terms of one. */
bool expanded_fits(const System *system)
{
    enum { MOST_TERMS = 6000, MOST_TURNS = 8 };
    int64_t terms = 1;

    for (int i = 0; i < system->dynamics->masses.count && terms <= MOST_TERMS; i++) {
        int parts;
        int turns;
        int64_t turned = 1;

        way_size(system, system->dynamics->masses.at[i].node, &parts, &turns);
        for (int k = 0; k < turns && k < MOST_TURNS; k++)
            turned *= 3;
        terms += turned * parts * parts;
    }
    return terms <= MOST_TERMS;
}

/* the definitions of a block whose entries can be long; NULL: it is always expanded */
static const Expr *defined_block(const System *system, Block block)
{
    switch (block) {
    case BLOCK_MASS:
        return system->definitions.mass;
    case BLOCK_FORCES:
        return system->definitions.force;
    case BLOCK_JACOBIAN:
        return system->definitions.phi_u;
    case BLOCK_ACCELERATION:
        return system->definitions.gamma;
    default:
        return NULL;
    }
}

/* entries of a block formed so far; a view starts with those that building the System needed */
static Expr *entries_of(System *system, Block block, int count)
{
    Expr **entries = &system->shown->entries[block];
    const System *formed = system->formed;

    mem_keep(*entries);
    if (*entries != NULL)
        return *entries;
    *entries = NEW_ARRAY(Expr, count);
    if (formed != NULL && formed->shown->entries[block] != NULL)
        memcpy(*entries, formed->shown->entries[block], (size_t)count * sizeof(Expr));
    return *entries;
}

Status entry_formed(System *system, Block block, EntryFunction *form, int row, int column,
                    Expr *out, Diag *diag)
{
    int rows;
    int columns;
    Expr *entry;
    Expr shown;

    system_block_size(system, block, &rows, &columns);
    /* the other half of a symmetric matrix is the same */
    if (block == BLOCK_MASS && column < row) {
        int swap = row;

        row = column;
        column = swap;
    }
    entry = &entries_of(system, block, rows * columns)[row * columns + column];
    if (*entry == NULL && block == BLOCK_MASS && !system->dynamics->writes_out)
        TRY(system_form_mass(system, diag));
    if (*entry == NULL && defined_block(system, block) != NULL && !system->dynamics->writes_out)
        *entry = defined_block(system, block)[row * columns + column];
    if (*entry == NULL) {
        TRY(form(system, row, column, &shown, diag));
        TRY(monitor_poll(system->watch));
        *entry = shown;
    }
    *out = *entry;
    return OK;
}

Status expanded_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag)
{
    return entry_formed(system, block, blocks[block].show, row, column, out, diag);
}

Status system_terms(System *system, Block block, int row, int column, Terms *out, Diag *diag)
{
    Status status = OK;

    system_touch(system);
    if (blocks[block].terms == NULL ||
        (!system->dynamics->writes_out && (block == BLOCK_MASS || block == BLOCK_FORCES)))
        return OK;
    CHECK(blocks[block].terms(system, row, column, out, diag));
    for (int i = 0; i < out->count; i++) {
        out->at[i].value = system_plain(system, expanded_tidy(system, out->at[i].value));
        CHECK(monitor_poll(system->watch));
    }
done:
    if (status != OK)
        LIST_FREE(*out);
    return status;
}
