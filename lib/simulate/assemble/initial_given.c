/* initial_given.c: reads values that were given or guessed, and the variables that they belong
 * to */
#include "simulate/assemble/assemble_limits.h"
#include "simulate/assemble/initial_impl.h"
#include "simulate/equations/probe.h"
#include "simulate/equations/rows.h"

#include <math.h>
#include <string.h>

static int place_of(const Assembly *a, Expr e, StateLevel level)
{
    const VariableIndex *l = a->l;
    int first = level == LEVEL_POSITION ? l->q : level == LEVEL_VELOCITY ? l->u : l->x;
    int count = level == LEVEL_POSITION ? l->n : level == LEVEL_VELOCITY ? l->nu : l->nx;

    for (int i = 0; i < count; i++)
        if (l->symbols[first + i] == e)
            return i;
    return -1;
}

/* The column of a coordinate that is held: positions are corrected in speeds, so it is that of the
 * coordinate's own speed; -1: it has none. */
static int column_of(const Assembly *a, int place, StateLevel level)
{
    Expr rate;

    if (place < 0 || level != LEVEL_POSITION || a->eq->map == NULL)
        return place;
    rate = system_q_rate(a->l->system, place);
    for (int j = 0; j < a->l->nu; j++)
        if (system_u(a->l->system, j)->symbol == rate)
            return j;
    return -1;
}

Status initial_classify(Assembly *a, GivenValue *given, Diag *diag)
{
    const unsigned dynamic = 1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER |
                             1U << SYMBOL_EFFORT | 1U << SYMBOL_JERK;
    const unsigned network = 1U << SYMBOL_STATE | 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE;
    unsigned kinds = expr_kinds(given->expr);
    const char *name = given->value->name;

    if ((kinds & dynamic) != 0) {
        (void)diag_set(diag, E_ASSEMBLE, "%s%.*s follows from forces and can't be an initial value",
                       name, given->value->primes, "''''");
        diag_hint(diag, "give positions, speeds, currents and voltages of storage elements");
        return E_ASSEMBLE;
    }
    given->level = (kinds & network) != 0              ? LEVEL_NETWORK
                   : (kinds & 1U << SYMBOL_SPEED) != 0 ? LEVEL_VELOCITY
                                                       : LEVEL_POSITION;
    given->place = place_of(a, given->expr, given->level);
    given->column = column_of(a, given->place, given->level);
    given->target = given->value->value;
    given->group = -1;
    return OK;
}

/* whether it is one of three angles of an attitude */
static bool is_of_three_angles(const VariableReferent *referent)
{
    int angles = 0;

    if (referent->kind != REFERENT_COORDINATE ||
        referent->instance->coord_kind[referent->which] != COORDINATE_ANGLE)
        return false;
    for (int i = 0; i < referent->instance->coord_count; i++)
        angles += referent->instance->coord_kind[i] == COORDINATE_ANGLE;
    return angles == 3;
}

/* coordinate number of the middle one of three angles */
static int middle_angle(const Instance *instance)
{
    int first = 0;

    while (instance->coord_kind[first] != COORDINATE_ANGLE)
        first++;
    return first + 1;
}

/* Whether the given middle angle is outside the range of a chord's expression: -90 to 90 degrees,
 * or 0 to 180 degrees where first and last axis are the same. */
static bool is_other_set(const Assembly *a, const Instance *instance)
{
    const StartValues *start = a->setting->start;
    const char *axes = instance_value(instance, "euler")->word;
    const char *middle = instance->coord[middle_angle(instance)];

    for (int i = 0; start != NULL && i < start->count; i++)
        if (start->at[i].primes == 0 && strcmp(start->at[i].name, middle) == 0)
            return (axes[0] == axes[2] ? sin(start->at[i].value) : cos(start->at[i].value)) < 0;
    return false;
}

/* The three given angles of a chord place frames without an expression. An expression yields one of
 * the two triples of angles of an attitude: in the other one the middle angle decreases where this
 * one increases. */
static void read_three_angles(const Assembly *a, const VariableReferent *referent,
                              GivenValue *given)
{
    if (given->value->primes == 0)
        given->expr = NULL;
    else if (referent->which == middle_angle(referent->instance) &&
             is_other_set(a, referent->instance))
        given->expr = expr_neg(system_arena(a->l->system), given->expr);
}

static Status read_one(Assembly *a, GivenValue *given, Diag *diag)
{
    const StartValue *value = given->value;
    const VariableReferent referent = system_referent(a->l->system, value->name);
    Status status = OK;

    CHECK(system_variable(a->l->system, value->name, value->primes, &given->expr, diag));
    CHECK(initial_classify(a, given, diag));
    if (is_of_three_angles(&referent) && given->place < 0)
        read_three_angles(a, &referent, given);
    if (value->primes == 0 && given->level == LEVEL_POSITION)
        given->referent = referent;
    else if (given->level == LEVEL_VELOCITY && value->primes == 1)
        given->rate_of = referent;
done:
    return status;
}

/* initial values of the system itself, which are 0 */
static void add_own(Assembly *a, StartValue value, GivenValue given)
{
    StartValue *own = &a->own[a->given_count];

    *own = value;
    given.value = own;
    given.is_own = true;
    given.group = -1;
    a->given[a->given_count++] = given;
}

/* Flexible parts deform at speed 0, unless something requires another one: joints, not shapes,
 * absorb what a given joint speed leaves open, whatever the polynomials of the shapes are. */
static void rest_shapes(Assembly *a)
{
    const VariableIndex *l = a->l;

    for (int j = 0; j < l->nu; j++) {
        const Variable *speed = system_u(l->system, j);

        if (speed->is_shape)
            add_own(a, (StartValue){.name = speed->name, .is_guess = true},
                    (GivenValue){
                        .expr = speed->symbol, .level = LEVEL_VELOCITY, .place = j, .column = j});
    }
}

static int shapes_of(const VariableIndex *l)
{
    int count = 0;

    for (int j = 0; j < l->nu; j++)
        count += system_u(l->system, j)->is_shape;
    return count;
}

/* whether the user gives or guesses the speed itself */
static bool is_said(const Assembly *a, int own)
{
    for (int i = 0; i < a->given_count; i++)
        if (!a->given[i].is_own && a->given[i].level == LEVEL_VELOCITY &&
            a->given[i].place == a->given[own].place)
            return true;
    return false;
}

Status initial_read_given(Assembly *a, Diag *diag)
{
    const StartValues *start = a->setting->start;
    const int shapes = shapes_of(a->l);
    int angles = 0, kept = 0;

    while (system_angle_off(a->l->system, angles) != NULL)
        angles++;
    a->given = NEW_ARRAY(GivenValue, (start != NULL ? start->count : 0) + angles + shapes);
    a->own = NEW_ARRAY(StartValue, angles + shapes);
    for (int i = 0; i < angles; i++) {
        const AngleOff *angle = system_angle_off(a->l->system, i);

        add_own(a, (StartValue){.name = angle->name},
                (GivenValue){.expr = angle->off, .place = -1, .column = -1});
    }
    rest_shapes(a);
    if (start == NULL)
        return OK;
    for (int i = 0; i < start->count; i++) {
        GivenValue *given = &a->given[a->given_count];

        given->value = &start->at[i];
        TRY(read_one(a, given, diag));
        a->given_count++;
    }
    for (int i = 0; i < a->given_count; i++)
        if (!a->given[i].is_own || a->given[i].level != LEVEL_VELOCITY || !is_said(a, i))
            a->given[kept++] = a->given[i];
    a->given_count = kept;
    initial_group(a);
    return OK;
}

/* --- Euler parameters --- */

void initial_unit(double p[4])
{
    double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);

    for (int i = 0; i < 4 && length > 0; i++)
        p[i] /= length;
}

/* which of the four it is, 0 to 3; -1: none */
static int parameter_of(const VariableReferent *referent)
{
    const Instance *owner = referent->instance;
    int first = 0;

    if (referent->kind == REFERENT_PARAMETER)
        return referent->which;
    if (referent->kind != REFERENT_COORDINATE ||
        owner->coord_kind[referent->which] != COORDINATE_PARAMETER)
        return -1;
    while (owner->coord_kind[first] != COORDINATE_PARAMETER)
        first++;
    return referent->which - first;
}

/* whether two Euler parameters belong to one attitude */
static bool is_one_attitude(const VariableReferent *a, const VariableReferent *b)
{
    return a->kind == b->kind && a->instance == b->instance && a->node == b->node;
}

static bool are_together(const GivenValue *a, const GivenValue *b)
{
    return is_one_attitude(&a->referent, &b->referent) && a->value->is_guess == b->value->is_guess;
}

/* Scale a group of all four to unit length; likewise fewer whose length leaves 0 for the others. */
static void finish_group(Assembly *a, int group)
{
    GivenValue *members[4] = {NULL};
    double p[4] = {0}, length = 0;
    int count = 0;

    for (int i = 0; i < a->given_count; i++)
        if (a->given[i].group == group)
            members[parameter_of(&a->given[i].referent)] = &a->given[i];
    for (int i = 0; i < 4; i++)
        if (members[i] != NULL) {
            p[i] = members[i]->target;
            length = hypot(length, p[i]);
            count++;
        }
    if (!(fabs(length - 1) < (count == 4 ? EULER_PARAMETERS_OFF : EULER_PARAMETERS_OTHERS)))
        return; /* errors are reported with the values as given */
    initial_unit(p);
    for (int i = 0; i < 4; i++)
        if (members[i] != NULL)
            members[i]->target = p[i];
}

void initial_group(Assembly *a)
{
    for (int i = 0; i < a->given_count; i++) {
        GivenValue *given = &a->given[i];

        if (given->is_own || parameter_of(&given->referent) < 0)
            continue;
        for (int j = 0; j < i && given->group < 0; j++)
            if (a->given[j].group >= 0 && are_together(given, &a->given[j]))
                given->group = a->given[j].group;
        if (given->group < 0)
            given->group = a->group_count++;
    }
    for (int group = 0; group < a->group_count; group++)
        finish_group(a, group);
}

void initial_align(Problem *p)
{
    const Assembly *a = p->a;
    double *along = NEW_ARRAY(double, a->group_count);
    double *residual = NEW_ARRAY(double, p->system_rows + p->count);
    Rows rows = initial_rows(p);

    rows.evaluate(rows.context, a->y, residual, NULL);
    for (int pass = 0; pass < 2 && a->group_count > 0; pass++)
        for (int i = 0; i < p->count; i++) {
            GivenValue *given = (GivenValue *)p->picked[i];

            if (given->group < 0)
                continue;
            if (pass == 0)
                along[given->group] +=
                    (residual[p->system_rows + i] + given->target) * given->target;
            else if (along[given->group] < 0)
                given->target = -given->target;
        }
    MEM_FREE(along, residual);
}

/* sum of q_i p_i: q at y, p as given (or guessed) for the attitude that the rate belongs to */
static Status find_sense(const Assembly *a, const VariableReferent *rate_of, bool guesses,
                         double *out, Diag *diag)
{
    const RowValues row = row_of_state(a->l, a->t, a->y);

    *out = 0;
    for (int i = 0; i < a->given_count; i++) {
        const GivenValue *given = &a->given[i];
        double q;

        if (given->group < 0 || given->value->is_guess != guesses ||
            !is_one_attitude(&given->referent, rate_of))
            continue;
        TRY(probe_at(a->l, a->parameters, given->expr, &row, &q, diag));
        *out += q * given->value->value;
    }
    return OK;
}

Status initial_align_rates(Assembly *a, Diag *diag)
{
    for (int i = 0; i < a->given_count; i++) {
        GivenValue *given = &a->given[i];
        double sense;

        if (parameter_of(&given->rate_of) < 0)
            continue;
        TRY(find_sense(a, &given->rate_of, false, &sense, diag));
        if (sense == 0)
            TRY(find_sense(a, &given->rate_of, true, &sense, diag));
        given->target = sense < 0 ? -given->value->value : given->value->value;
    }
    return OK;
}
