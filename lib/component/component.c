/* component.c: finds values and members of a row; helpers for joint primitives */
#include "component/component_rows.h"

#include <assert.h>
#include <math.h>
#include <string.h>

int component_param(const Component *row, const char *name)
{
    for (int i = 0; i < row->param_count; i++)
        if (strcmp(row->params[i].name, name) == 0)
            return i;
    return -1;
}

char *param_unit(const Param *param, bool on_angle)
{
    const char *unit = param->unit;
    const char *bar = unit != NULL ? strchr(unit, '|') : NULL;

    if (unit == NULL)
        return NULL;
    if (bar != NULL && on_angle)
        return mem_text(bar + 1, strlen(bar + 1));
    return mem_text(unit, bar != NULL ? (size_t)(bar - unit) : strlen(unit));
}

bool instance_is_rigid(const Instance *instance)
{
    return instance->row->is_rigid != NULL && instance->row->is_rigid(instance);
}

bool instance_sticks(const Instance *instance)
{
    return instance->row->sticks || instance_is_rigid(instance);
}

bool instance_takes_angle(const Instance *instance, const Param *param)
{
    return instance->on_angle || (instance->is_geared && (param->use & GEARS) == 0);
}

int instance_in_force(const Instance *instance, int param)
{
    const Component *row = instance->row;

    if ((row->params[param].use & PAIRED) == 0 || instance->values[param].given)
        return param;
    for (int i = 0; i < row->param_count; i++)
        if (i != param && (row->params[i].use & PAIRED) != 0)
            return i;
    return param;
}

int component_source(const Component *row)
{
    for (int i = 0; i < row->param_count; i++)
        if ((row->params[i].use & GIVES_SOURCE) != 0 && row->params[i].fallback == NULL)
            return i;
    return -1;
}

int instance_input(const Instance *instance)
{
    for (int i = 0; i < instance->row->param_count; i++) {
        const Value *value = &instance->values[i];
        const int use = instance->row->params[i].use;

        if ((use & GIVES) != 0 && value->count == 1 && value->at[0] != NULL &&
            (value->given || (use & POSITIONAL) != 0))
            return i;
    }
    return -1;
}

const CoordinateRow *instance_coords(const Instance *instance, bool planar, int *count)
{
    const Component *row = instance->row;

    if (planar && row->coords_planar != NULL) {
        *count = row->coord_count_planar;
        return row->coords_planar;
    }
    if (row->coords_of != NULL)
        return row->coords_of(instance, count);
    *count = row->coord_count;
    return row->coords;
}

bool instance_bends(const Instance *instance)
{
    return instance->row->deforming != NULL && instance->row->deforming->section != NULL;
}

int instance_coord_count(const Instance *instance, bool planar)
{
    const Deforming *deforming = instance->row->deforming;
    int count;

    (void)instance_coords(instance, planar, &count);
    return count + (deforming != NULL ? deforming->count(instance, planar) : 0);
}

CoordinateRow instance_coord(const Instance *instance, bool planar, int i)
{
    int count;
    const CoordinateRow *pose = instance_coords(instance, planar, &count);

    return i < count ? pose[i] : instance->row->deforming->coordinate(instance, planar, i - count);
}

const Value *instance_value(const Instance *instance, const char *name)
{
    int i = component_param(instance->row, name);

    assert(i >= 0);
    return &instance->values[i];
}

bool instance_has(const Instance *instance, const char *name)
{
    return component_param(instance->row, name) >= 0 && instance_value(instance, name)->given;
}

Expr instance_scalar(const Instance *instance, const char *name)
{
    const Value *value = instance_value(instance, name);

    return value->count > 0 ? value->at[0] : NULL;
}

Value *values_copy(Pool *pool, const Value *values, int count)
{
    Value *copy = pool_alloc(pool, (size_t)count * sizeof *copy);

    for (int i = 0; i < count; i++) {
        const size_t size = (size_t)values[i].count * sizeof(Expr);

        copy[i] = values[i];
        copy[i].at = pool_alloc(pool, size);
        if (size > 0)
            memcpy(copy[i].at, values[i].at, size);
        if (values[i].word != NULL)
            copy[i].word = pool_text(pool, values[i].word, strlen(values[i].word));
    }
    return copy;
}

Expr instance_lifted_constant(const Instance *instance, Arena *arena, int param, int entry)
{
    const char *const part = instance->name, *const value = instance->row->params[param].name;
    const size_t size = strlen(part) + strlen(value) + sizeof "#.[99]";
    char usual[128], *const name = size <= sizeof usual ? usual : mem_new(size);
    char *at = name;
    Expr symbol;

    assert(entry < 100); /* no value has as many entries */
    *at++ = '#';
    at = stpcpy(at, part);
    *at++ = '.';
    at = stpcpy(at, value);
    *at++ = '[';
    if (entry >= 10)
        *at++ = (char)('0' + entry / 10);
    *at++ = (char)('0' + entry % 10);
    *at++ = ']';
    *at = '\0';
    symbol = expr_symbol(arena, name, SYMBOL_PARAMETER);
    if (name != usual)
        mem_free(name);
    return symbol;
}

static Status check_number(const Instance *instance, const char *param, bool zero, Diag *diag)
{
    Expr value = instance_scalar(instance, param);

    if (!expr_is_number(value) || expr_value(value) > 0.0 || (zero && expr_value(value) == 0.0))
        return OK;
    if (expr_value(value) == 0.0)
        (void)diag_set(diag, E_VALUE, "%s of %s is zero", param, instance->name);
    else
        (void)diag_set(diag, E_VALUE, "%s of %s is negative: %g", param, instance->name,
                       expr_value(value));
    diag_hint(diag, zero ? "it is zero or positive" : "it has to be positive");
    diag_about(diag, "%s", param);
    return E_VALUE;
}

Status check_positive(const Instance *instance, const char *param, Diag *diag)
{
    return check_number(instance, param, false, diag);
}

Status check_not_negative(const Instance *instance, const char *param, Diag *diag)
{
    return check_number(instance, param, true, diag);
}

Status instance_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    const Component *row = instance->row;

    if (row->positive != NULL)
        TRY(check_positive(instance, row->positive, diag));
    return row->check != NULL ? row->check(instance, arena, planar, diag) : OK;
}

/* --- scalar edges --- */

const char *domain_across(Domain domain)
{
    static const char *const names[] = {"", "v", "p", "w", "v", "T", "load"};

    return names[domain];
}

const char *domain_through(Domain domain)
{
    static const char *const names[] = {"", "i", "flow", "torque", "force", "heat", ""};

    return names[domain];
}

const char *domain_across_unit(Domain domain)
{
    static const char *const units[] = {"", "V", "Pa", "rad/s", "m/s", "K", "N"};

    return units[domain];
}

const ScalarEdge *component_scalar_edges(const Component *row, int *count)
{
    static const ScalarEdge one = {"", 0, 1, BRANCH_MAY, 0};

    *count = 0;
    if (row->scalar_edges == NULL && row->places != PLACES_TERMINALS &&
        row->places != PLACES_TRANSDUCER && row->places != PLACES_SENSED)
        return NULL;
    *count = row->scalar_edges != NULL ? row->scalar_edge_count : 1;
    return row->scalar_edges != NULL ? row->scalar_edges : &one;
}

int component_terminals(const Component *row)
{
    return row->terminal_count > 0 ? row->terminal_count : 2;
}

static Expr variable(Arena *arena, const char *owner, const char *member, int primes)
{
    Text name = {0};
    Expr symbol;

    /* for each name of a network; a mode needs them all, so it is joined without a format */
    text_add(&name, owner);
    if (member[0] != '\0') {
        text_char(&name, '.');
        text_add(&name, member);
    }
    text_fill(&name, '\'', primes);
    symbol = expr_symbol(arena, name.at, SYMBOL_VARIABLE);
    text_free(&name);
    return symbol;
}

Expr instance_variable(const Instance *instance, Arena *arena, const char *member)
{
    return variable(arena, instance->name, member, 0);
}

Expr instance_coordinate(const Instance *instance, const Instance *joint, Arena *arena, int primes)
{
    return variable(arena, joint->coord[instance->joint_coordinate], "", primes);
}

Expr instance_potential(const Instance *instance, Arena *arena, int terminal)
{
    const char *name = instance->terminal_names[terminal];

    if (strcmp(name, "0") == 0)
        return expr_int(arena, 0);
    return variable(arena, name, domain_across(instance->row->domain), 0);
}

Expr instance_joint_coordinate(const Instance *instance, Arena *arena)
{
    return variable(arena, instance->coordinate, "", 0);
}

/* "i", or for an edge with a suffix "s.i" */
static Expr edge_variable(const Instance *instance, Arena *arena, int which, const char *member)
{
    int count;
    const ScalarEdge *edge = &component_scalar_edges(instance->row, &count)[which];
    Text name = {0};
    Expr symbol;

    if (edge->suffix[0] == '\0')
        return instance_variable(instance, arena, member);
    text_add(&name, edge->suffix);
    text_char(&name, '.');
    text_add(&name, member);
    symbol = instance_variable(instance, arena, name.at);
    text_free(&name);
    return symbol;
}

Expr instance_across(const Instance *instance, Arena *arena, int which)
{
    return edge_variable(instance, arena, which, domain_across(instance->row->domain));
}

Expr instance_through(const Instance *instance, Arena *arena, int which)
{
    return edge_variable(instance, arena, which, domain_through(instance->row->domain));
}

/* the rate of a symbol that a value depends on: 1 for time, the primed name of a variable */
static Expr symbol_rate(Arena *arena, Expr symbol)
{
    if (expr_symbol_kind(symbol) == SYMBOL_TIME)
        return expr_int(arena, 1);
    if (expr_symbol_kind(symbol) != SYMBOL_VARIABLE)
        return expr_int(arena, 0);
    return variable(arena, expr_name(symbol), "", 1);
}

Expr system_user_rate(Arena *arena, Expr e)
{
    Expr *symbols;
    int count = expr_symbols(&e, 1, &symbols);
    Expr rate = expr_int(arena, 0);

    for (int i = 0; i < count; i++)
        rate = expr_add(
            arena, rate,
            expr_mul(arena, expr_diff(arena, e, symbols[i]), symbol_rate(arena, symbols[i])));
    mem_free(symbols);
    return rate;
}

/* --- members of a whole family --- */

/* clang-format off */
static const Member frame_planar[] = {
    {"x",      "m",       "position in ground axes", 2},
    {"y",      "m",       "position in ground axes", 2},
    {"theta",  "rad",     "angle against ground, about z", 2},
    {"vx",     "m/s",     "velocity in ground axes", 1},
    {"vy",     "m/s",     "velocity in ground axes", 1},
    {"wz",     "rad/s",   "angular velocity", 1},
    {"ax",     "m/s^2",   "acceleration in ground axes", 0},
    {"ay",     "m/s^2",   "acceleration in ground axes", 0},
    {"alphaz", "rad/s^2", "angular acceleration", 0},
};

static const Member frame_spatial[] = {
    {"x",      "m",       "position in ground axes", 2},
    {"y",      "m",       "position in ground axes", 2},
    {"z",      "m",       "position in ground axes", 2},
    {"vx",     "m/s",     "velocity in ground axes", 1},
    {"vy",     "m/s",     "velocity in ground axes", 1},
    {"vz",     "m/s",     "velocity in ground axes", 1},
    {"ax",     "m/s^2",   "acceleration in ground axes", 0},
    {"ay",     "m/s^2",   "acceleration in ground axes", 0},
    {"az",     "m/s^2",   "acceleration in ground axes", 0},
    {"wx",     "rad/s",   "angular velocity in ground axes", 1},
    {"wy",     "rad/s",   "angular velocity in ground axes", 1},
    {"wz",     "rad/s",   "angular velocity in ground axes", 1},
    {"Wx",     "rad/s",   "angular velocity in the frame's own axes", 1},
    {"Wy",     "rad/s",   "angular velocity in the frame's own axes", 1},
    {"Wz",     "rad/s",   "angular velocity in the frame's own axes", 1},
    {"alphax", "rad/s^2", "angular acceleration in ground axes", 0},
    {"alphay", "rad/s^2", "angular acceleration in ground axes", 0},
    {"alphaz", "rad/s^2", "angular acceleration in ground axes", 0},
    {"q0",     "1",       "Euler parameter, scalar part, frame to ground", 2},
    {"q1",     "1",       "Euler parameter, frame to ground", 2},
    {"q2",     "1",       "Euler parameter, frame to ground", 2},
    {"q3",     "1",       "Euler parameter, frame to ground", 2},
};

enum { JOINT_LOADS_PLANAR = 6, JOINT_LOADS = 12 }; /* they come first */

static const Member joint_planar[] = {
    {"fx",     "N",   "force on the tip, ground axes", 0},
    {"fy",     "N",   "force on the tip, ground axes", 0},
    {"tz",     "N*m", "moment on the tip about its origin", 0},
    {"Fx",     "N",   "force on the tip, axes of the tail", 0},
    {"Fy",     "N",   "force on the tip, axes of the tail", 0},
    {"Tz",     "N*m", "moment on the tip about its origin", 0},
    {"effort", NULL,  "force or moment along the coordinate: of what acts on the joint", 0},
};

static const Member joint_spatial[] = {
    {"fx",     "N",   "force on the tip, ground axes", 0},
    {"fy",     "N",   "force on the tip, ground axes", 0},
    {"fz",     "N",   "force on the tip, ground axes", 0},
    {"tx",     "N*m", "moment on the tip about its origin, ground axes", 0},
    {"ty",     "N*m", "moment on the tip about its origin, ground axes", 0},
    {"tz",     "N*m", "moment on the tip about its origin, ground axes", 0},
    {"Fx",     "N",   "force on the tip, axes of the tail", 0},
    {"Fy",     "N",   "force on the tip, axes of the tail", 0},
    {"Fz",     "N",   "force on the tip, axes of the tail", 0},
    {"Tx",     "N*m", "moment on the tip about its origin, axes of the tail", 0},
    {"Ty",     "N*m", "moment on the tip about its origin, axes of the tail", 0},
    {"Tz",     "N*m", "moment on the tip about its origin, axes of the tail", 0},
    {"Wx",     "rad/s", "angular velocity against the tail, axes of the tip", 1},
    {"Wy",     "rad/s", "angular velocity against the tail, axes of the tip", 1},
    {"Wz",     "rad/s", "angular velocity against the tail, axes of the tip", 1},
    {"effort", NULL,  "force or moment along the coordinate: of what acts on the joint", 0},
};

static const Member contact_planar[] = {
    {"fx", "N", "force on the tip at the contact, ground axes", 0},
    {"fy", "N", "force on the tip at the contact, ground axes", 0},
    {"x",  "m", "of the point of contact, ground axes", 1},
    {"y",  "m", "of the point of contact, ground axes", 1},
};

static const Member contact_spatial[] = {
    {"fx", "N", "force on the tip at the contact, ground axes", 0},
    {"fy", "N", "force on the tip at the contact, ground axes", 0},
    {"fz", "N", "force on the tip at the contact, ground axes", 0},
    {"x",  "m", "of the point of contact, ground axes", 1},
    {"y",  "m", "of the point of contact, ground axes", 1},
    {"z",  "m", "of the point of contact, ground axes", 1},
};

static const Member coupling_spatial[] = {
    {"tx", "N*m", "moment on the tip, ground axes", 0},
    {"ty", "N*m", "moment on the tip, ground axes", 0},
    {"tz", "N*m", "moment on the tip, ground axes", 0},
};

static const Member electrical[] = {
    {"v",     "V", "voltage, plus against minus", 2},
    {"i",     "A", "current, from plus to minus inside", 2},
    {"power", "W", "power taken, v*i", 0},
};

static const Member hydraulic[] = {
    {"p",     "Pa",    "pressure, plus against minus", 2},
    {"flow",  "m^3/s", "volume flow, from plus to minus inside", 2},
    {"power", "W",     "power taken, p*flow", 0},
};

static const Member shaft[] = {
    {"w",      "rad/s", "rate, plus against minus", 2},
    {"torque", "N*m",   "torque, from plus to minus inside", 2},
    {"power",  "W",     "power taken, w*torque", 0},
};

static const Member slide[] = {
    {"v",     "m/s", "velocity, plus against minus", 2},
    {"force", "N",   "force, from plus to minus inside", 2},
    {"power", "W",   "power taken, v*force", 0},
};

static const Member thermal[] = {
    {"T",    "K", "temperature, plus against minus", 2},
    {"heat", "W", "heat flow, from plus to minus inside", 2},
};

static const Member load[] = {
    {"load", "N", "what presses the surfaces of the joint together", 1},
};
/* clang-format on */

/* of an edge between frames, in addition to the others */
static const Member power = {"power", "W", "power given to its frames: F.v + T.w", 0};

bool component_acts_on_frames(const Component *row)
{
    return row->family != FAMILY_SCALAR && row->family != FAMILY_TRANSDUCER;
}

/* of a part with one scalar edge; parts with more edges list theirs in their rows */
static const Member *scalar_members(const Component *row, int *count)
{
    int edges;

    (void)component_scalar_edges(row, &edges);
    *count = 0;
    if (edges != 1)
        return NULL;
    switch (row->domain) {
    case DOMAIN_HYDRAULIC:
        *count = COUNT(hydraulic);
        return hydraulic;
    case DOMAIN_SHAFT:
        *count = COUNT(shaft);
        return shaft;
    case DOMAIN_SLIDE:
        *count = COUNT(slide);
        return slide;
    case DOMAIN_THERMAL:
        *count = COUNT(thermal);
        return thermal;
    case DOMAIN_LOAD:
        *count = COUNT(load);
        return load;
    default:
        *count = COUNT(electrical);
        return electrical;
    }
}

static const Member *family_members(const Component *row, bool planar, int *count)
{
    if (row->turns) {
        *count = COUNT(coupling_spatial);
        return coupling_spatial;
    }
    if (row->contact != NULL) {
        *count = planar ? COUNT(contact_planar) : COUNT(contact_spatial);
        return planar ? contact_planar : contact_spatial;
    }
    switch (row->family) {
    case FAMILY_BODY:
    case FAMILY_ARM:
        *count = planar ? COUNT(frame_planar) : COUNT(frame_spatial);
        return planar ? frame_planar : frame_spatial;
    case FAMILY_JOINT:
        *count = planar ? COUNT(joint_planar) : COUNT(joint_spatial);
        return planar ? joint_planar : joint_spatial;
    case FAMILY_SCALAR:
    case FAMILY_TRANSDUCER:
        return scalar_members(row, count);
    case FAMILY_FORCE:
        if (row->restore == NULL)
            break;
        *count = planar ? JOINT_LOADS_PLANAR : JOINT_LOADS;
        return planar ? joint_planar : joint_spatial;
    case FAMILY_CONTACT:
    case FAMILY_DRIVER:
    case FAMILY_COUPLER:
        break;
    }
    *count = 0;
    return NULL;
}

const Member *component_member(const Component *row, bool planar, int i)
{
    int count;
    const Member *members = family_members(row, planar, &count);

    if (i < count)
        return &members[i];
    i -= count;
    if (i < row->member_count)
        return &row->members[i];
    return i == row->member_count && component_acts_on_frames(row) ? &power : NULL;
}

/* whether a name consists of the stem of its own states and a number from 1 */
static bool is_numbered_state(const Component *row, const char *name)
{
    const size_t stem = row->state_stem != NULL ? strlen(row->state_stem) : 0;

    return stem > 0 && strncmp(name, row->state_stem, stem) == 0 && name[stem] >= '1' &&
           name[stem] <= '9' && name[stem + strspn(name + stem, "0123456789")] == '\0';
}

const Member *component_find_member(const Component *row, bool planar, const char *name)
{
    const bool numbered = is_numbered_state(row, name);
    const Member *member;

    for (int i = 0; (member = component_member(row, planar, i)) != NULL; i++)
        if (strcmp(member->name, name) == 0 || (numbered && is_numbered_state(row, member->name)))
            return member;
    return NULL;
}

/* --- joint primitives --- */

void steps_none(Arena *arena, Steps *out)
{
    const Expr zero = expr_int(arena, 0), one = expr_int(arena, 1);

    *out = (Steps){0};
    for (int i = 0; i < 3; i++)
        out->constant[i] = zero;
    for (int i = 0; i < 9; i++)
        out->rotation[i] = i % 4 == 0 ? one : zero;
}

static Step step(Arena *arena, const Expr axis[3], int coordinate)
{
    return (Step){{axis[0], axis[1], axis[2]}, coordinate, expr_int(arena, 1)};
}

void steps_shift(Arena *arena, Steps *out, const Expr axis[3], int coordinate)
{
    assert(out->shift_count < COUNT(out->shift));
    out->shift[out->shift_count++] = step(arena, axis, coordinate);
}

void steps_turn(Arena *arena, Steps *out, const Expr axis[3], int coordinate)
{
    assert(out->turn_count < COUNT(out->turn));
    out->turn[out->turn_count++] = step(arena, axis, coordinate);
}

void steps_freedom(const Steps *steps, int freedom[2])
{
    freedom[0] = steps->shift_count;
    freedom[1] = steps->turn_count + (steps->quaternion ? 3 : 0);
}

Expr axis_dot(Arena *arena, const Expr a[3], const Expr b[3])
{
    return expr_sum(arena,
                    (Expr[]){expr_mul(arena, a[0], b[0]), expr_mul(arena, a[1], b[1]),
                             expr_mul(arena, a[2], b[2])},
                    3);
}

void axis_cross(Arena *arena, const Expr a[3], const Expr b[3], Expr out[3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;

        out[i] = expr_sub(arena, expr_mul(arena, a[j], b[k]), expr_mul(arena, a[k], b[j]));
    }
}

/* size of an entry when an axis is chosen; an entry with symbols counts as large */
static double size_of(Expr e)
{
    return expr_kinds(e) == 0 ? fabs(expr_evaluate(e, NULL, NULL)) : 1.0;
}

void axis_complement(Arena *arena, const Expr u[3], Expr n1[3], Expr n2[3])
{
    Expr e[3];
    Expr length;
    int least = 0;

    for (int i = 0; i < 3; i++)
        e[i] = expr_int(arena, 0);
    for (int i = 0; i < 3; i++) {
        if (!expr_is(u[i], 1) && !expr_is(u[i], -1))
            continue;
        /* along an axis of the frame: the cyclically next one of x y z */
        for (int j = 0; j < 3; j++)
            n1[j] = e[j];
        n1[(i + 1) % 3] = expr_int(arena, 1);
        axis_cross(arena, u, n1, n2);
        return;
    }
    for (int i = 1; i < 3; i++)
        if (size_of(u[i]) < size_of(u[least]))
            least = i;
    e[least] = expr_int(arena, 1);
    axis_cross(arena, e, u, n1);
    length = expr_sqrt(
        arena, expr_add(arena, expr_square(arena, n1[0]),
                        expr_add(arena, expr_square(arena, n1[1]), expr_square(arena, n1[2]))));
    for (int i = 0; i < 3; i++)
        n1[i] = expr_div(arena, n1[i], length);
    axis_cross(arena, u, n1, n2);
}
