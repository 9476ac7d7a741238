/* reactions.c: forces and moments of joints, forces of contacts (theory 5, 14)
 *
 * If the joint is a chord they follow from lambda; if it is a branch, from the loads beyond it.
 * Redundant rows have multipliers too (redundancy.c). Where some of these are undetermined, so is
 * every component of a reaction that depends on them, and no other. */
#include "formulate/dynamics/reactions.h"
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/loads.h"
#include "formulate/dynamics/rubbing.h"
#include "formulate/kinematics/contact_rows.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/sample.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <assert.h>

#include <math.h>
#include <string.h>

Status rotor_add(System *system, const Instance *instance, Loads *loads, Diag *diag)
{
    const Instance *joint;
    Expr inertia;
    Expr second;

    if (instance->row->rotor == NULL || instance->joint < 0)
        return OK;
    inertia = instance->row->rotor(instance, system->arena);
    joint = &system->origin->instances[instance->joint];
    TRY(coordinate_value(system, joint, instance->joint_coordinate, 2, &second, diag));
    loads_add_effort(system, loads, joint, instance->joint_coordinate,
                     expr_neg(system->arena, expr_mul(system->arena, inertia, second)));
    return OK;
}

void drive_add(System *system, const Drive *drive, Loads *loads)
{
    const Instance *driver = &system->origin->instances[drive->instance];

    if (driver->by >= 0 && driver->by_coordinate >= 0)
        loads_add_effort(system, loads, &system->origin->instances[driver->by],
                         driver->by_coordinate, drive->effort);
}

Status actual_build(System *system, Diag *diag)
{
    Loads loads;

    TRY(system_wait_for_motion(system, diag));
    if (system->shown->actual_a == NULL) {
        size_t chains = (size_t)system->kinematics->chains.count;

        system->shown->actual_alpha = pool_alloc(system->pool, chains * sizeof(Vec));
        system->shown->actual_a =
            pool_alloc(system->pool, (size_t)graph_node_count(system->origin->graph) * sizeof(Vec));
        accelerations_build(system, system->kinematics->accelerations, system->shown->actual_alpha,
                            system->shown->actual_a);
    }
    if (system->shown->actual != NULL)
        return OK;
    loads = loads_new(system);
    loads_add_inertia(system, &loads, system->shown->actual_alpha, system->shown->actual_a,
                      system->kinematics->accelerations);
    TRY(efforts_add(system, &loads, TAKE_ALL, diag));
    for (int i = 0; i < system->origin->instance_count; i++)
        TRY(rotor_add(system, &system->origin->instances[i], &loads, diag));
    for (int k = 0; k < system->constraints->rows.count; k++)
        loads_add_row(system, &loads, &system->constraints->rows.at[k],
                      system->constraints->multipliers[k]);
    for (int i = 0; i < system->constraints->drives.count; i++)
        drive_add(system, &system->constraints->drives.at[i], &loads);
    if (system->constraints->redundant_rows.count > 0)
        recovery_build(system, &loads);
    for (int k = 0; k < system->constraints->redundant_rows.count; k++)
        loads_add_row(system, &loads, &system->constraints->redundant_rows.at[k],
                      system->shown->recovery->multipliers[k]);
    system->shown->actual = loads_sum(system, &loads, SUMS_FOR_JOINTS);
    return OK;
}

/* load of a row on the head of its chord per unit of -lambda: force or moment, ground axes */
static Vec row_reaction(const System *system, const Row *row, bool rotation)
{
    Arena *arena = system->arena;
    int tail = system->kinematics->frames[row->tail].chain;
    Vec along = row->n;

    if (row->reported.rotation != rotation && row->kind != ROW_TIE)
        return vec_zero(arena);
    if (row->kind == ROW_TIE && rotation)
        along = vec_scale(arena, expr_neg(arena, row->pitch), along);
    if (row->kind == ROW_DOT)
        along = vec_cross(
            arena, vec_express(system, row->b, system->kinematics->frames[row->head].chain, tail),
            along);
    return vec_express(system, along, row->kind == ROW_DATUM ? 0 : tail, 0);
}

/* Load that a screw's tie carries in addition to its row. The motion rows replace a torque on the
 * screw by the force on the shift that does the same work, so their multiplier lacks that force. It
 * is added here, with the moment that makes the wrench do no work. */
static Vec tied_reaction(System *system, const Instance *joint, bool rotation)
{
    Arena *arena = system->arena;
    const Expr *tied = system->shown->actual->tied;
    Steps steps;
    Vec axis;
    int chain;

    if (tied == NULL || expr_is_zero(tied[joint->number]))
        return vec_zero(arena);
    instance_steps(system, joint, &steps);
    axis = joint_axis(system, joint, &steps, 0, &chain);
    axis = vec_express(system, axis, chain, 0);
    return vec_scale(arena,
                     rotation ? expr_neg(arena, tied[joint->number])
                              : expr_div(arena, tied[joint->number], steps.shift[0].scale),
                     axis);
}

/* the sum over a chord's rows */
static Vec chord_reaction(System *system, const Instance *joint, bool rotation)
{
    Arena *arena = system->arena;
    Vec sum = tied_reaction(system, joint, rotation);

    for (int k = 0; k < system->constraints->rows.count + system->constraints->redundant_rows.count;
         k++) {
        int v = k - system->constraints->rows.count;
        const Row *row =
            v < 0 ? &system->constraints->rows.at[k] : &system->constraints->redundant_rows.at[v];
        Expr lambda =
            v < 0 ? system->constraints->multipliers[k] : system->shown->recovery->multipliers[v];

        assert(row != NULL);
        if (row->reported.instance == joint->number)
            sum = vec_add(
                arena, sum,
                vec_scale(arena, expr_neg(arena, lambda), row_reaction(system, row, rotation)));
    }
    return sum;
}

/* The force, or the moment with `rotation`, that a branch carries from its tail to its head. It
 * balances all loads and inertia beyond the branch, whose sums are known at its far node. */
Vec branch_reaction(const System *system, const Instance *instance, const Sums *sums, bool rotation,
                    int *chain)
{
    const Tree *tree = system->origin->trees[rotation ? TREE_ROTATION : TREE_TRANSLATION];
    int node = tree_far_node(tree, instance->edge);
    Vec reaction = (rotation ? sums->torque : sums->force)[node];

    *chain = system->kinematics->chains.at[system->kinematics->frames[node].chain].resolve;
    return tree_is_forward(tree, node) ? vec_neg(system->arena, reaction) : reaction;
}

/* the wanted component of a vector in the axes of an orientation class */
static Expr component(const System *system, const Instance *joint, ReactionPart part, Vec vector,
                      int chain)
{
    const Frame *tail = &system->kinematics->frames[joint->tail];
    Rotation back = rotation_transpose(&tail->zero);

    vector = vec_express(system, vector, chain, part.own ? tail->chain : 0);
    if (part.own)
        vector = rotation_apply(system->arena, &back, vector);
    return vector.at[part.axis];
}

/* the component per unit of the multiplier of a redundant row */
static Expr share_of(System *system, const Instance *joint, const void *wanted, int redundant)
{
    const ReactionPart part = *(const ReactionPart *)wanted;
    const Tree *tree = system->origin->trees[part.moment ? TREE_ROTATION : TREE_TRANSLATION];
    const Row *row = &system->constraints->redundant_rows.at[redundant];
    Vec vector = vec_zero(system->arena);
    int chain = 0;

    if (tree_has(tree, joint->edge))
        vector = branch_reaction(system, joint, system->shown->recovery->sums[redundant],
                                 part.moment, &chain);
    else if (row->reported.instance == joint->number)
        vector = vec_neg(system->arena, row_reaction(system, row, part.moment));
    return component(system, joint, part, vector, chain);
}

/* A row whose multiplier is undetermined and on which the sum of shares[k] by multiplier k depends;
 * NULL: none. */
static const Row *open_row(const System *system, const double *shares, int instance)
{
    enum { DIGITS = 7 };
    const Recovery *recovery = system->shown->recovery;
    const int rows = system->constraints->redundant_rows.count;
    const Row *found = NULL;

    for (int j = 0; j < recovery->open_count && found == NULL; j++) {
        double sum = 0;
        double size = 1;

        for (int k = 0; k < rows; k++) {
            double term = shares[k] * recovery->open[k * recovery->open_count + j];

            sum += term;
            if (fabs(term) > size)
                size = fabs(term);
            /* the row of another part is more useful to the user */
            if (term != 0 && (found == NULL || found->reported.instance == instance))
                found = &system->constraints->redundant_rows.at[k];
        }
        if (fabs(sum) < size * pow(10, -DIGITS))
            found = NULL;
    }
    return found;
}

const Row *reaction_open_row(System *system, const Instance *part, RowShare *share,
                             const void *wanted)
{
    const Recovery *recovery = system->shown->recovery;
    const int rows = system->constraints->redundant_rows.count;
    const Row *found;
    double *shares;

    if (recovery == NULL || recovery->open_count == 0)
        return NULL;
    shares = NEW_ARRAY(double, rows);
    for (int k = 0; k < rows; k++)
        shares[k] = sample_number(recovery->sample, share(system, part, wanted, k));
    found = open_row(system, shares, part->number);
    mem_free(shares);
    return found;
}

Vec rigid_reaction(System *system, const Instance *joint, bool rotation, int *chain)
{
    const Tree *tree = system->origin->trees[rotation ? TREE_ROTATION : TREE_TRANSLATION];

    *chain = 0;
    return tree_has(tree, joint->edge)
               ? branch_reaction(system, joint, system->shown->actual, rotation, chain)
               : chord_reaction(system, joint, rotation);
}

Status joint_reaction(System *system, const Instance *joint, ReactionPart part, Expr *out,
                      Diag *diag)
{
    const Row *open;
    Vec vector;
    int chain;

    TRY(actual_build(system, diag));
    if (joint->is_virtual) {
        *out = expr_int(system->arena, 0);
        return OK;
    }
    open = reaction_open_row(system, joint, share_of, &part);
    if (open != NULL) {
        const char *chord = system->origin->instances[open->reported.instance].name;

        (void)diag_set(diag, E_MISSING, "the %s of %s %s %c isn't determined",
                       part.moment ? "moment" : "force", joint->name,
                       part.moment ? "about" : "along", "xyz"[part.axis]);
        diag_hint(diag,
                  "an equation of %s repeats others in every position, so how they share the load "
                  "is open; 'tree absolute' finds the least reactions that balance",
                  chord);
        return E_MISSING;
    }
    vector = rigid_reaction(system, joint, part.moment, &chain);
    *out = component(system, joint, part, vector, chain);
    return OK;
}

/* the norm of a vector whose entries along known axes are 0; |x| where one is left */
static Expr norm_of(Arena *arena, Vec vector)
{
    Expr left = NULL;
    int count = 0;

    for (int i = 0; i < 3; i++)
        if (!expr_is_zero(vector.at[i])) {
            left = vector.at[i];
            count++;
        }
    if (count == 0)
        return expr_int(arena, 0);
    return count == 1 ? expr_call1(arena, OP_ABS, left)
                      : expr_sqrt(arena, vec_dot(arena, vector, vector));
}

Status joint_load(System *system, const Instance *part, bool moment, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    const Instance *joint = &system->origin->instances[part->joint];
    const bool planar = system->origin->planar;
    Vec load = vec_zero(arena);
    Steps steps;
    Diag why = {0};

    instance_steps(system, joint, &steps);
    for (int i = 0; i < 3; i++) {
        const ReactionPart wanted = {moment, true, i};
        Status status;

        if (planar && (i == 2) != moment)
            continue;
        status = joint_reaction(system, joint, wanted, &load.at[i], &why);
        if (status == OK)
            continue;
        (void)diag_set(diag, status, "the load of %s can't be determined: %s", part->name,
                       why.message);
        if (why.hint[0] != '\0')
            diag_hint(diag, "%s", why.hint);
        return status;
    }
    if (!moment && steps.shift_count > 0) {
        const Vec axis = {{steps.shift[0].axis[0], steps.shift[0].axis[1], steps.shift[0].axis[2]}};

        load = vec_cross(arena, axis, load);
    }
    for (int i = 0; i < 3; i++)
        load.at[i] = expr_name_temporary(arena, load.at[i]);
    *out = norm_of(arena, load);
    return OK;
}

/* --- contacts --- */

/* of rows, by their multipliers; in the axes of the tail's chain */
static Status rows_force(System *system, const Instance *part, const char *member, Vec *out,
                         Diag *diag)
{
    Arena *arena = system->arena;

    *out = vec_zero(arena);
    if (system_wait_for_motion(system, diag) != OK)
        return E_MISSING;
    for (int k = 0; k < system->constraints->redundant_rows.count; k++)
        if (system->constraints->redundant_rows.at[k].reported.instance == part->number) {
            (void)diag_set(diag, E_MISSING, "%s.%s isn't determined", part->name, member);
            diag_hint(diag,
                      "a row of %s holds in every position, so that others may carry its "
                      "load; 'tree absolute' finds the least loads that balance",
                      part->name);
            return E_MISSING;
        }
    for (int k = 0; k < system->constraints->rows.count; k++) {
        const Row *row = &system->constraints->rows.at[k];

        if (row->reported.instance == part->number)
            *out =
                vec_sub(arena, *out, vec_scale(arena, system->constraints->multipliers[k], row->n));
    }
    return OK;
}

/* likewise of a contact that opens */
static Status law_force(System *system, const Instance *part, const FrictionLoad *touch, Vec *out)
{
    Arena *arena = system->arena;

    *out = vec_zero(arena);
    for (int k = 0; k < touch->count; k++)
        *out = vec_add(
            arena, *out,
            vec_scale(arena, touch->effort[k], frame_vector(system, part->tail, touch->axis[k])));
    return OK;
}

Status contact_variable(System *system, const Instance *part, const char *member, Expr *out,
                        Diag *diag)
{
    Arena *arena = system->arena;
    const int tail = system->kinematics->frames[part->tail].chain;
    const bool opens = part->row->press != NULL;
    FrictionLoad touch;
    Vec force, normal;
    Expr along;
    Contact contact;

    if (strlen(member) == 1 && member[0] >= 'x' && member[0] <= 'z') {
        *out = contact_point(system, part).at[member[0] - 'x'];
        return OK;
    }
    if (opens)
        TRY(rubbing_of(system, part, TAKE_ALL, &touch, diag));
    if (opens && (strcmp(member, "gap") == 0 || strcmp(member, "slip") == 0)) {
        *out = member[0] == 'g' ? touch.gap : touch.count == 2 ? touch.rate[1] : touch.speed;
        return OK;
    }
    TRY(opens ? law_force(system, part, &touch, &force)
              : rows_force(system, part, member, &force, diag));
    if (member[1] >= 'x') {
        *out = vec_express(system, force, tail, 0).at[member[1] - 'x'];
        return OK;
    }
    if (opens) {
        *out = member[1] == 'n' ? touch.effort[0] : touch.count == 2 ? touch.effort[1] : touch.norm;
        return OK;
    }
    contact_of(system, part, &contact);
    normal = frame_vector(system, part->tail,
                          (Vec){{contact.normal[0], contact.normal[1], contact.normal[2]}});
    along = vec_dot(arena, force, normal);
    force = vec_sub(arena, force, vec_scale(arena, along, normal));
    *out = member[1] == 'n' ? along : expr_sqrt(arena, vec_dot(arena, force, force));
    return OK;
}
