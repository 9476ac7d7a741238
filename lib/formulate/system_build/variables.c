/* variables.c: quantities that a user can name, as expressions of the system's variables
 *
 * A name is a coordinate, an entry (lambda(1), mass(2,2)), an output, or a member of a part: the
 * tables below list the members of each family and the function that returns them. */
#include "component/equation_block.h"
#include "formulate/dynamics/bushings.h"
#include "formulate/dynamics/edge_power.h"
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/losses.h"
#include "formulate/dynamics/reactions.h"
#include "formulate/dynamics/rubbing.h"
#include "formulate/dynamics/sections.h"
#include "formulate/expanded/block_entry.h"
#include "formulate/expanded/embedded.h"
#include "formulate/expanded/expanded.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/kinematics/section_frames.h"
#include "formulate/network/network_impl.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/rates.h"
#include "formulate/system/resolve.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* --- frames --- */

typedef enum Quantity {
    POSITION,
    VELOCITY,
    ACCELERATION,
    RATE,
    OWN_RATE,
    TURNING,
    ANGLE,
    PARAMETER
} Quantity;

typedef struct FrameMember {
    const char *name;
    Quantity quantity;
    int axis;
} FrameMember;

static const FrameMember frame_members[] = {
    {"x", POSITION, 0},      {"y", POSITION, 1},      {"z", POSITION, 2},
    {"vx", VELOCITY, 0},     {"vy", VELOCITY, 1},     {"vz", VELOCITY, 2},
    {"ax", ACCELERATION, 0}, {"ay", ACCELERATION, 1}, {"az", ACCELERATION, 2},
    {"wx", RATE, 0},         {"wy", RATE, 1},         {"wz", RATE, 2},
    {"Wx", OWN_RATE, 0},     {"Wy", OWN_RATE, 1},     {"Wz", OWN_RATE, 2},
    {"alphax", TURNING, 0},  {"alphay", TURNING, 1},  {"alphaz", TURNING, 2},
    {"theta", ANGLE, 2},     {"q0", PARAMETER, 0},    {"q1", PARAMETER, 1},
    {"q2", PARAMETER, 2},    {"q3", PARAMETER, 3},
};

/* the angle of a frame against ground, if all turns are about one axis */
static Status frame_angle(const System *system, int node, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    const Frame *frame = &system->kinematics->frames[node];
    Vec z = vec_zero(arena);
    Turns turns = {0};
    Status status = OK;

    z.at[2] = expr_int(arena, 1);
    turns_between(system, 0, frame->chain, &turns);
    *out = rotation_angle(arena, &frame->zero, z);
    if (turns.count > 1 || !system->origin->planar)
        status = diag_set(diag, E_MISSING, "theta is for planar scenes");
    else if (turns.count == 1)
        *out = expr_add(arena, *out,
                        vec_same(turns.at[0].axis, z) ? turns.at[0].angle
                                                      : expr_neg(arena, turns.at[0].angle));
    LIST_FREE(turns);
    return status;
}

static Status frame_vector_of(System *system, int node, Quantity quantity, Vec *out, Diag *diag)
{
    const Frame *frame = &system->kinematics->frames[node];
    int axes = system->kinematics->chains.at[frame->chain].resolve;

    switch (quantity) {
    case POSITION:
    case ANGLE:
    case PARAMETER:
        *out = node_position(system, node);
        break;
    case VELOCITY:
        *out = vec_express(system, frame->v, axes, 0);
        break;
    case RATE:
        *out = vec_express(system, system->kinematics->motions[frame->chain].w, axes, 0);
        break;
    case OWN_RATE: {
        Rotation back = rotation_transpose(&frame->zero);

        *out = vec_express(system, system->kinematics->motions[frame->chain].w, axes, frame->chain);
        *out = rotation_apply(system->arena, &back, *out);
        break;
    }
    case ACCELERATION:
    case TURNING:
        TRY(actual_build(system, diag));
        *out = quantity == TURNING ? system->shown->actual_alpha[frame->chain]
                                   : system->shown->actual_a[node];
        *out = vec_express(system, *out, axes, 0);
        break;
    }
    return OK;
}

static Status frame_variable(System *system, int node, const char *member, Expr *out, Diag *diag)
{
    for (int i = 0; i < COUNT(frame_members); i++) {
        const FrameMember *row = &frame_members[i];
        Vec vector;
        Status status;

        if (strcmp(row->name, member) != 0)
            continue;
        if (row->quantity == ANGLE)
            return frame_angle(system, node, out, diag);
        if (row->quantity == PARAMETER) {
            Expr p[4];

            frame_parameters(system, node, p);
            *out = p[row->axis];
            return OK;
        }
        status = frame_vector_of(system, node, row->quantity, &vector, diag);
        if (status == OK)
            *out = vector.at[row->axis];
        return status;
    }
    return diag_set(diag, E_MISSING, "%s.%s can't be determined",
                    graph_node(system->origin->graph, node)->name, member);
}

/* --- joints --- */

/* efforts that act on a coordinate of the joint: springs, motors, drivers */
static Status joint_effort(System *system, const Instance *joint, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    Expr sum = expr_int(arena, 0);

    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        Effort effort;

        if ((instance->joint != joint->number && instance->second_joint != joint->number) ||
            instance->row->effort == NULL)
            continue;
        TRY(effort_of(system, instance, &effort, diag));
        if (instance->joint == joint->number)
            sum = expr_add(arena, sum, effort.value);
        if (instance->second_joint == joint->number)
            sum = expr_sub(arena, sum, effort.value);
    }
    for (int k = 0; k < system->constraints->rows.count; k++) {
        const Row *row = &system->constraints->rows.at[k];
        const Expr lambda = system->constraints->multipliers[k];

        if (row->kind != ROW_DRIVER && row->kind != ROW_COUPLER)
            continue;
        if (row->owner == joint->number)
            sum = expr_sub(arena, sum, lambda);
        for (int i = 0; i < row->coupled_count; i++)
            if (row->coupled[i].owner == joint->number)
                sum = expr_add(arena, sum, expr_mul(arena, lambda, row->coupled[i].slope));
    }
    *out = sum;
    return OK;
}

/* the shift of a screw, from its turn */
static Status tied_shift(System *system, const Instance *joint, Expr *out, Diag *diag)
{
    Steps steps;
    Expr turn;

    instance_steps(system, joint, &steps);
    if (!steps_are_tied(&steps))
        return diag_set(diag, E_MISSING, "%s.s can't be determined", joint->name);
    TRY(coordinate_value(system, joint, steps.turn[0].coordinate, 0, &turn, diag));
    *out = expr_mul(system->arena, steps.shift[0].scale, turn);
    return OK;
}

/* angular velocity of the head against the tail in the axes of the head, with the constant turn
 * undone: for a joint with Euler parameters that is a branch these are its speeds */
static Expr relative_rate(const System *system, const Instance *joint, int axis)
{
    Arena *arena = system->arena;
    const Frame *head = &system->kinematics->frames[joint->head];
    int tail = system->kinematics->frames[joint->tail].chain;
    Rotation back = rotation_transpose(&head->zero);
    Rotation constant;
    Steps steps;
    Vec w;

    instance_steps(system, joint, &steps);
    if (steps.quaternion && system->kinematics->speed[joint->number][steps.first_parameter] >= 0)
        return system->kinematics->u
            .at[system->kinematics->speed[joint->number][steps.first_parameter] + axis]
            .symbol;
    for (int i = 0; i < 9; i++)
        constant.at[i] = steps.rotation[i];
    w = vec_sub(arena,
                vec_express(system, system->kinematics->motions[head->chain].w,
                            system->kinematics->chains.at[head->chain].resolve, head->chain),
                vec_express(system, system->kinematics->motions[tail].w,
                            system->kinematics->chains.at[tail].resolve, head->chain));
    return rotation_apply(arena, &constant, rotation_apply(arena, &back, w)).at[axis];
}

static Status joint_variable(System *system, const Instance *joint, const char *member, Expr *out,
                             Diag *diag)
{
    static const char letters[] = "xyz";
    const char *axis = strlen(member) == 2 ? strchr(letters, member[1]) : NULL;
    bool moment = member[0] == 't' || member[0] == 'T';
    bool own = member[0] == 'F' || member[0] == 'T';

    if (strcmp(member, "effort") == 0)
        return system_wait_for_motion(system, diag) == OK ? joint_effort(system, joint, out, diag)
                                                          : E_MISSING;
    if (strcmp(member, "s") == 0)
        return tied_shift(system, joint, out, diag);
    if (axis == NULL)
        return diag_set(diag, E_MISSING, "%s.%s can't be determined", joint->name, member);
    if (member[0] == 'W') {
        *out = relative_rate(system, joint, (int)(axis - letters));
        return OK;
    }
    return joint_reaction(system, joint, (ReactionPart){moment, own, (int)(axis - letters)}, out,
                          diag);
}

/* --- efforts, and networks --- */

static Status effort_variable(System *system, const Instance *instance, const char *member,
                              Expr *out, Diag *diag)
{
    Effort effort;

    (void)member;
    TRY(effort_of(system, instance, &effort, diag));
    *out = effort.value;
    return OK;
}

static Status rubbing_variable(System *system, const Instance *instance, Expr *out, Diag *diag)
{
    FrictionLoad rubbing;

    TRY(rubbing_of(system, instance, TAKE_ALL, &rubbing, diag));
    *out = rubbing.norm;
    return OK;
}

static Status driver_variable(System *system, const Instance *driver, const char *member, Expr *out,
                              Diag *diag)
{
    const Drive *drive = NULL;

    for (int i = 0; i < system->constraints->drives.count; i++)
        if (system->constraints->drives.at[i].instance == driver->number)
            drive = &system->constraints->drives.at[i];
    if (drive == NULL || strcmp(member, "effort") != 0)
        return diag_set(diag, E_MISSING, "%s.%s can't be determined", driver->name, member);
    if (system_wait_for_motion(system, diag) != OK)
        return E_MISSING;
    /* in the embedded form one driver of one freedom has an explicit effort, where it can be
     * written */
    if (system->origin->form == FORM_EMBEDDED && driver->by < 0 &&
        system->constraints->drives.count == 1 && drive->constraint >= 0 &&
        embedded_rows(system) == 1 &&
        embedded_effort(system, &system->constraints->rows.at[drive->constraint], out, NULL) == OK)
        return OK;
    *out =
        driver->by >= 0 && driver->by_coordinate < 0 ? expr_int(system->arena, 0) : drive->effort;
    return OK;
}

static Status coupler_variable(const System *system, const Instance *coupler, const char *member,
                               Expr *out, Diag *diag)
{
    for (int k = 0; strcmp(member, "effort") == 0 && k < system->constraints->rows.count; k++)
        if (system->constraints->rows.at[k].reported.instance == coupler->number) {
            *out = expr_neg(system->arena, system->constraints->multipliers[k]);
            return OK;
        }
    return diag_set(diag, E_MISSING, "%s.%s can't be determined", coupler->name, member);
}

/* a state of the part's own, and its rate */
static bool own_state(const System *system, const Instance *instance, const char *member, Expr *out)
{
    if (instance->row->own_state_count == NULL || instance->row->own_state_count(instance) == 0)
        return false;
    for (int k = 0; k < system->network->unknowns.count; k++) {
        const Unknown *y = &system->network->unknowns.at[k];
        const char *own;

        if (y->own < 0 || y->instance != instance->number)
            continue;
        own = expr_name(y->symbol) + strlen(instance->name);
        if (strcmp(own + (*own == '.'), member) != 0)
            continue;
        *out = y->symbol;
        return true;
    }
    return false;
}

/* which variable of a scalar edge a member denotes; "s.i": of its edge s */
static Status scalar_variable(System *system, const Instance *instance, const char *member,
                              Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    int count;
    const ScalarEdge *edges = component_scalar_edges(instance->row, &count);
    Domain domain = instance->row->domain;
    Branchlike *branch;
    const char *name = member;
    int which = 0;
    Expr v;
    Expr i;

    if (own_state(system, instance, member, out))
        return OK;
    if (instance->row->family == FAMILY_TRANSDUCER && instance->row->effort != NULL &&
        (strcmp(member, "torque") == 0 || strcmp(member, "force") == 0) &&
        strcmp(member, domain_through(domain)) != 0)
        return effort_variable(system, instance, member, out, diag);
    for (int k = 0; k < count; k++) {
        size_t length = strlen(edges[k].suffix);

        if (length > 0 && strncmp(member, edges[k].suffix, length) == 0 && member[length] == '.') {
            which = k;
            name = member + length + 1;
        }
    }
    if (count == 0)
        return diag_set(diag, E_MISSING, "%s.%s can't be determined", instance->name, member);
    if (domain == DOMAIN_LOAD && strcmp(member, "effort") == 0)
        return effort_variable(system, instance, member, out, diag);
    if (domain == DOMAIN_LOAD && strcmp(member, domain_across(domain)) != 0)
        return joint_load(system, instance, strcmp(member, "moment") == 0, out, diag);
    branch = scalar_branch(system, instance, which);
    if (name[0] == '\0' || strcmp(name, domain_across(domain)) == 0)
        return network_across(system, branch, out, diag);
    if (strcmp(name, domain_through(domain)) == 0)
        return network_through(system, branch, out, diag);
    if (strcmp(name, "power") == 0) {
        TRY(network_across(system, branch, &v, diag));
        TRY(network_through(system, branch, &i, diag));
        *out = expr_mul(arena, v, i);
    } else if (branch->relation.content != NULL) {
        return variables_resolve(system, branch->relation.content, out, diag);
    } else {
        return diag_set(diag, E_MISSING, "%s.%s can't be determined", instance->name, member);
    }
    return OK;
}

/* The owner of the longest prefix of a path, "leg1.T1" of "leg1.T1.s.i": a part (or NULL), a node
 * (or -1). Returns the end of the prefix. */
static const char *path_owner(const System *system, const char *path, const Instance **instance,
                              int *node)
{
    size_t length = strlen(path);

    *instance = NULL;
    *node = -1;
    for (; length > 0; length--) {
        char *head;
        int number;

        if (path[length] != '.' && path[length] != '\0')
            continue;
        head = mem_text(path, length);
        number = names_find(system->origin->instance_names, head);
        *instance = number >= 0 ? &system->origin->instances[number] : NULL;
        *node = graph_find_node(system->origin->graph, head);
        mem_free(head);
        if (*instance != NULL || *node >= 0)
            break;
    }
    return path + length;
}

/* The scalar edge whose own stored variable a path names, "C1.v", "T1.s.i"; NULL. */
static const Branchlike *storage_named(System *system, const char *path)
{
    const char *dot = strrchr(path, '.');
    const Instance *instance;
    int node;

    (void)path_owner(system, path, &instance, &node);
    for (int k = 0; instance != NULL && dot != NULL && k < instance->scalar_count; k++) {
        const Branchlike *branch = scalar_branch(system, instance, k);
        RelationKind kind = branch->relation.kind;
        const char *edge = graph_edge(system->origin->graph, branch->edge)->name;
        Domain domain = instance->row->domain;

        if (strlen(edge) == (size_t)(dot - path) &&
            strncmp(edge, path, (size_t)(dot - path)) == 0 &&
            ((kind == RELATION_CAPACITIVE && strcmp(dot + 1, domain_across(domain)) == 0) ||
             (kind == RELATION_INDUCTIVE && strcmp(dot + 1, domain_through(domain)) == 0)))
            return branch;
    }
    return NULL;
}

/* v' of a capacitor from its current, i' of an inductor from its voltage: i = content' + rest */
static Status storage_rate(System *system, const char *path, Expr *out, Diag *diag)
{
    const Branchlike *branch = storage_named(system, path);
    Arena *arena = system->arena;
    const Instance *instance;
    Expr own;
    Expr own_rate;
    Expr other;
    Expr rest;
    Expr zero = expr_int(arena, 0);

    if (branch == NULL)
        return E_MISSING; /* the message of system_rate_of() remains */
    instance = &system->origin->instances[branch->instance];
    own = instance_across(instance, arena, branch->which);
    other = instance_through(instance, arena, branch->which);
    if (branch->relation.kind == RELATION_INDUCTIVE) {
        Expr kept = own;

        own = other;
        other = kept;
    }
    own_rate = system_user_rate(arena, own);
    rest =
        expr_add(arena, branch->relation.rest, system_user_rate(arena, branch->relation.content));
    rest = expr_substitute(arena, rest, &own_rate, &zero, 1);
    return variables_resolve(system,
                             expr_div(arena, expr_sub(arena, other, rest),
                                      expr_diff(arena, branch->relation.content, own)),
                             out, diag);
}

/* Of a terminal to which nothing is connected yet: an input that must be set before a run. */
static Expr open_potential(System *system, int node)
{
    const Node *terminal = graph_node(system->origin->graph, node);

    return network_open(
        system, system_retain(system, "%s.%s", terminal->name, domain_across(terminal->domain)));
}

/* potential of a terminal against its datum: along the tree path */
static Status terminal_variable(System *system, int node, Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    TreeKind kind = TREE_ELECTRICAL;
    const Tree *tree;

    while (tree_kind_domain(kind) != graph_node(system->origin->graph, node)->domain)
        kind++;
    tree = system->origin->trees[kind];
    *out = expr_int(arena, 0);
    if (!graph_node(system->origin->graph, node)->datum &&
        (tree == NULL || tree_parent(tree, node) < 0)) {
        *out = open_potential(system, node);
        return OK;
    }
    for (; tree_parent(tree, node) >= 0; node = tree_parent(tree, node)) {
        Expr v;

        TRY(network_across(system,
                           &system->network->branches
                                .at[system->network->scalar_of_edge[tree_parent_edge(tree, node)]],
                           &v, diag));
        /* an across variable is the tail's minus the head's */
        *out = tree_is_forward(tree, node) ? expr_sub(arena, *out, v) : expr_add(arena, *out, v);
    }
    return OK;
}

/* --- the whole model --- */

static Expr largest_residual(const System *system)
{
    Arena *arena = system->arena;
    Expr largest = expr_int(arena, 0);

    for (int k = 0; k < system->constraints->rows.count; k++)
        largest = expr_call2(arena, OP_MAX, largest, expr_call1(arena, OP_ABS, system->run.phi[k]));
    return largest;
}

/* power lost in all parts with dry friction */
static Status power_lost(System *system, Expr *out, Diag *diag)
{
    *out = expr_int(system->arena, 0);
    for (int i = 0; i < system->origin->instance_count; i++) {
        bool found;
        Expr loss;

        TRY(loss_variable(system, &system->origin->instances[i], "loss", &found, &loss, diag));
        if (found)
            *out = expr_add(system->arena, *out, loss);
    }
    return OK;
}

static bool model_variable(System *system, const char *path, Expr *out)
{
    Arena *arena = system->arena;

    if (strcmp(path, "energy.kinetic") == 0)
        *out = system_kinetic(system);
    else if (strcmp(path, "energy.potential") == 0)
        *out = system_potential(system);
    else if (strcmp(path, "energy.total") == 0)
        *out = expr_add(arena, system_kinetic(system), system_potential(system));
    else if (strcmp(path, "constraint.error") == 0)
        *out = largest_residual(system);
    else if (strcmp(path, "model.n") == 0)
        *out = expr_int(arena, system->kinematics->q.count);
    else if (strcmp(path, "model.m") == 0)
        *out = expr_int(arena, system->constraints->rows.count);
    else
        return false;
    return true;
}

/* The degrees of freedom as a formula. E_MISSING where there are constraints: some may be
 * redundant, which depends on the initial position. */
static Status free_speeds(const System *system, Expr *out, Diag *diag)
{
    if (system->constraints->rows.count > 0) {
        (void)diag_set(diag, E_MISSING,
                       "model.dof counts what the constraints leave free at the start, and is no "
                       "formula");
        diag_hint(diag, "'print model.dof' and 'check' show it");
        return E_MISSING;
    }
    *out = expr_int(system->arena, system->kinematics->u.count);
    return OK;
}

/* a row or column number; one that is too large remains too large */
static int entry_number(const char *text, char **rest)
{
    long number = strtol(text, rest, 10);

    return number < 0 || number > INT_MAX ? INT_MAX : (int)number;
}

/* lambda(1), mass(2,2), forces(1), constraints(1), jacobian(1,2) */
static Status entry_variable(System *system, const char *path, bool *found, Expr *out, Diag *diag)
{
    const char *bracket = strchr(path, '(');
    size_t length = bracket != NULL ? (size_t)(bracket - path) : 0;
    char *rest;
    int row;
    int column = 1;

    *found = false;
    if (bracket == NULL)
        return OK;
    row = entry_number(bracket + 1, &rest);
    if (*rest == ',')
        column = entry_number(rest + 1, &rest);
    if (*rest != ')' || rest[1] != '\0')
        return OK;
    if (length == 6 && strncmp(path, "lambda", 6) == 0) {
        *found = true;
        if (system_wait_for_motion(system, diag) != OK)
            return E_MISSING;
        if (row < 1 || row > system->constraints->rows.count)
            return diag_set(diag, E_VALUE, "%s: there are %d multipliers", path,
                            system->constraints->rows.count);
        *out = system->constraints->multipliers[row - 1];
        return OK;
    }
    for (Block block = 0; block < BLOCK_COUNT; block++) {
        int rows;
        int columns;

        if (strncmp(block_name(block), path, length) != 0 || block_name(block)[length] != '\0')
            continue;
        *found = true;
        if (system_wait_for_motion(system, diag) != OK)
            return E_MISSING;
        system_block_size(system, block, &rows, &columns);
        if (row < 1 || column < 1 || row > rows || column > columns)
            return diag_set(diag, E_VALUE, "%s: %s is %d x %d", path, block_name(block), rows,
                            columns);
        return show_entry(system, block, row - 1, column - 1, out, diag);
    }
    return OK;
}

/* --- names --- */

/* v(0.5): displacement of the point there along y of the root; bending(0.5): the load of its
 * section; in pictures, y(0.5): its position along y of ground */
static Status deflection_variable(System *system, const Instance *part, const char *member,
                                  Expr *out, Diag *diag)
{
    Arena *arena = system->arena;
    const Expr at = expr_real(arena, strtod(strchr(member, '(') + 1, NULL));
    const SectionPart *section = part->row->deforming->section(system->origin->planar, member);
    const SectionFrame *station;
    Expr point[3];

    if (member[0] >= 'x' && system_axis_point(system, part, at, point)) {
        *out = point[member[0] - 'x'];
        return OK;
    }
    if (section != NULL)
        return section_force(system, part, section, at, out, diag);
    station = shapes_point(system, part, at);
    *out = member[0] == 'p'   ? station->angle[2]
           : member[0] == 'u' ? expr_sub(arena, station->position[0], at)
                              : station->position[member[0] == 'v' ? 1 : 2];
    return OK;
}

static Status member_variable(System *system, const char *path, Expr *out, Diag *diag)
{
    const Instance *instance;
    int node;
    const char *end = path_owner(system, path, &instance, &node);
    const char *member = *end == '.' ? end + 1 : "";
    bool found;

    /* the model knows the name, so these equations are out of date */
    if (instance == NULL && node < 0) {
        (void)diag_set(diag, E_NAME, "'%s' came after the run, which has no values of it", path);
        diag_hint(diag, "what comes later is in the next run: simulate 1");
        return E_NAME;
    }
    if (node >= 0 && graph_node(system->origin->graph, node)->domain != DOMAIN_MECHANICAL &&
        (instance == NULL || instance->scalar_count == 0))
        return terminal_variable(system, node, out, diag);
    if (instance == NULL)
        return frame_variable(system, node, member, out, diag);
    if (edge_power_is_named(instance, member))
        return edge_power(system, instance, member, out, diag);
    TRY(loss_variable(system, instance, member, &found, out, diag));
    if (found)
        return OK;
    if (instance->row->deforming != NULL && strchr(member, '(') != NULL)
        return deflection_variable(system, instance, member, out, diag);
    if (instance->row->contact != NULL)
        return contact_variable(system, instance, member, out, diag);
    switch (instance->row->family) {
    case FAMILY_BODY:
    case FAMILY_ARM:
        return frame_variable(system, instance->head, member, out, diag);
    case FAMILY_JOINT:
        return joint_variable(system, instance, member, out, diag);
    case FAMILY_DRIVER:
        return driver_variable(system, instance, member, out, diag);
    case FAMILY_CONTACT:
        break;
    case FAMILY_COUPLER:
        return coupler_variable(system, instance, member, out, diag);
    case FAMILY_FORCE:
        if (instance->row->rub != NULL && strcmp(member, "effort") == 0)
            return rubbing_variable(system, instance, out, diag);
        if (instance->row->restore != NULL)
            return bushing_variable(system, instance, member, out, diag);
        if (instance->row->effort != NULL)
            return effort_variable(system, instance, member, out, diag);
        break;
    case FAMILY_SCALAR:
    case FAMILY_TRANSDUCER:
        return scalar_variable(system, instance, member, out, diag);
    }
    return diag_set(diag, E_MISSING, "%s can't be determined", path);
}

static bool find_coordinate(const System *system, const char *path, const Instance **owner,
                            int *which)
{
    int number = names_find(system->origin->coordinate_names, path);

    if (number < 0)
        return false;
    *owner = &system->origin->instances[system->origin->coordinate_owners.at[number].instance];
    *which = system->origin->coordinate_owners.at[number].coordinate;
    return true;
}

/* the highest derivative of an unknown whose equation is given: the variable that its edge solves
 * for */
static const Instance *solved_for(const System *system, const char *path, int primes)
{
    const int number = names_find(system->origin->instance_names, path);
    const Instance *part = number >= 0 ? &system->origin->instances[number] : NULL;

    return part != NULL && instance_is_unknown(part) && primes > 0 && primes == part->given->order
               ? part
               : NULL;
}

Status system_variable(System *system, const char *path, int primes, Expr *out, Diag *diag)
{
    system_touch(system);
    const Instance *owner;
    int which;
    bool found = false;
    Status status = OK;

    if (find_coordinate(system, path, &owner, &which))
        return coordinate_shown(system, owner, which, primes, out, diag);
    owner = solved_for(system, path, primes);
    if (owner != NULL)
        return network_across(system, scalar_branch(system, owner, 0), out, diag);
    CHECK(entry_variable(system, path, &found, out, diag));
    if (!found && strcmp(path, "model.dof") == 0) {
        CHECK(free_speeds(system, out, diag));
        found = true;
    }
    if (!found && strcmp(path, "energy.loss") == 0) {
        CHECK(power_lost(system, out, diag));
        found = true;
    }
    if (!found && strcmp(path, "energy.lost") == 0)
        CHECK(loss_refuse_formula(path, diag));
    found = found || model_variable(system, path, out);
    for (int i = 0; i < system->origin->output_count && !found; i++)
        if (strcmp(system->origin->output_names[i], path) == 0) {
            CHECK(variables_resolve(system, system->origin->outputs[i], out, diag));
            found = true;
        }
    if (!found)
        CHECK(member_variable(system, path, out, diag));
    for (int k = 0; k < primes; k++) {
        status = system_rate_of(system, *out, out, diag);
        if (k == 0 && status == E_MISSING && !system->network->is_open)
            status = storage_rate(system, path, out, diag);
        if (status == E_MISSING) /* reported for an unknown that it depends on, of any other part */
            (void)diag_set(diag, status,
                           "the derivative of %s%.*s is not among the network's equations", path, k,
                           "''''''''");
        CHECK(status);
    }
done:
    return status;
}
