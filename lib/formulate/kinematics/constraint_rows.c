/* constraint_rows.c: circuits of chords projected on their reaction spaces
 *
 * A row n.d = 0: the vector d (m, 3 x 1) from the tail of a chord to its head has no component
 * along n. A row a_t.b_h = 0: two axes remain orthogonal. A row of angles: turns about one axis
 * cancel. Symbols as in system/kinematics.h; D_j is the part of d that speed j turns. So the rate
 * of d is the sum of k_j x D_j u_j and the slides. */
#include "formulate/kinematics/constraint_rows.h"
#include "formulate/formulate_limits.h"
#include "formulate/kinematics/circuits.h"
#include "formulate/kinematics/contact_rows.h"
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/framesum.h"
#include "formulate/kinematics/identity.h"
#include "formulate/kinematics/multi_turn.h"
#include "formulate/kinematics/row_patterns.h"
#include "formulate/kinematics/section_frames.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/sample.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

#include <math.h>
#include <string.h>

enum { SAMPLES = 3 }; /* positions at which a row is evaluated to test whether it vanishes */

/* --- which rows --- */

static void push_row(System *system, const Instance *joint, RowKind kind, Vec n, Vec b,
                     const char *direction)
{
    Row row = {.kind = kind, .tail = joint->tail, .head = joint->head, .n = n, .b = b};

    row.reported = (ConstraintRow){.edge = joint->edge,
                                   .instance = joint->number,
                                   .rotation = kind == ROW_DOT || kind == ROW_ANGLE};
    (void)strncpy(row.reported.direction, direction, sizeof row.reported.direction - 1);
    LIST_PUSH(system->constraints->rows, row);
}

static Vec unit(Arena *arena, int i)
{
    Vec v = vec_zero(arena);

    v.at[i] = expr_int(arena, 1);
    return v;
}

static Vec step_axis(const System *system, const Instance *joint, const Step *step)
{
    return frame_vector(system, joint->tail, (Vec){{step->axis[0], step->axis[1], step->axis[2]}});
}

/* forces that a joint transmits: all except those along its slides */
static void force_rows(System *system, const Instance *joint, const Steps *steps)
{
    static const char *const names[] = {"x", "y", "z"};
    Arena *arena = system->arena;
    Vec none = vec_zero(arena);
    Vec n1 = none;
    Vec n2 = none;

    if (steps->shift_count == 0) {
        for (int i = 0; i < (system->origin->planar ? 2 : 3); i++)
            push_row(system, joint, ROW_DATUM, unit(arena, i), none, names[i]);
    } else if (steps->shift_count == 1) {
        Vec axis = step_axis(system, joint, &steps->shift[0]);

        if (system->origin->planar) {
            push_row(system, joint, ROW_TAIL, vec_cross(arena, unit(arena, 2), axis), none, "n");
            return;
        }
        axis_complement(arena, axis.at, n1.at, n2.at);
        push_row(system, joint, ROW_TAIL, n1, none, "n1");
        push_row(system, joint, ROW_TAIL, n2, none, "n2");
    } else if (steps->shift_count == 2 && !system->origin->planar) {
        n1 = vec_cross(arena, step_axis(system, joint, &steps->shift[0]),
                       step_axis(system, joint, &steps->shift[1]));
        push_row(system, joint, ROW_TAIL, n1, none, "n");
    }
}

/* moments that a joint transmits: all except those about its turns (theory 2, orientation
 * constraints) */
static void moment_rows(System *system, const Instance *joint, const Steps *steps)
{
    Arena *arena = system->arena;
    Rotation constant = chord_constant(system, joint, steps);
    Rotation ahead;
    Vec axes[3];
    Vec far[3];
    Turns turns = {0};

    if (steps->quaternion || steps->turn_count > 2 ||
        (system->origin->planar && steps->turn_count > 0))
        return;
    /* axes of the tail, and those of the head after the constant turn is undone, zero position */
    axes[0] = steps->turn_count > 0 ? step_axis(system, joint, &steps->turn[0])
                                    : frame_vector(system, joint->tail, unit(arena, 0));
    axis_complement(arena, axes[0].at, axes[1].at, axes[2].at);
    ahead = constant;
    for (int i = 0; i < 3; i++)
        far[i] = rotation_apply(arena, &ahead, axes[i]);
    if (steps->turn_count == 2) {
        Vec second = rotation_apply(arena, &ahead, step_axis(system, joint, &steps->turn[1]));

        push_row(system, joint, ROW_DOT, axes[0], second, "cross");
    } else if (steps->turn_count == 1) {
        push_row(system, joint, ROW_DOT, axes[1], far[0], "n1");
        push_row(system, joint, ROW_DOT, axes[2], far[0], "n2");
    } else {
        turns_between(system, system->kinematics->frames[joint->tail].chain,
                      system->kinematics->frames[joint->head].chain, &turns);
        if (system->origin->planar) {
            push_row(system, joint, ROW_ANGLE, unit(arena, 2), vec_zero(arena), "turn");
        } else if (turns.count == 1 && turns.at[0].matrix == NULL && rotation_is_one(&constant)) {
            Vec axis = turns.at[0].axis;

            /* the axis does not move: those rows vanish, but not the loads that they carry */
            push_row(system, joint, ROW_ANGLE, axis, vec_zero(arena), "turn");
            axis_complement(arena, axis.at, axes[1].at, axes[2].at);
            push_row(system, joint, ROW_DOT, axis, axes[1], "n1");
            push_row(system, joint, ROW_DOT, axis, axes[2], "n2");
        } else {
            push_row(system, joint, ROW_DOT, axes[1], far[2], "u");
            push_row(system, joint, ROW_DOT, axes[2], far[0], "n1");
            push_row(system, joint, ROW_DOT, axes[0], far[1], "n2");
        }
        LIST_FREE(turns);
    }
}

/* a screw's shift is proportional to its turn */
static void tie_row(System *system, const Instance *joint, const Steps *steps)
{
    Vec axis = step_axis(system, joint, &steps->shift[0]);

    push_row(system, joint, ROW_TIE, axis, vec_zero(system->arena), "u");
    system->constraints->rows.at[system->constraints->rows.count - 1].pitch = steps->shift[0].scale;
}

/* of a driver or a coupler */
static void driver_row(System *system, const Instance *driver)
{
    const bool couples = driver->row->family == FAMILY_COUPLER;
    const Instance *owner = &system->origin->instances[driver->joint];
    Vec none = vec_zero(system->arena);

    push_row(system, owner, couples ? ROW_COUPLER : ROW_DRIVER, none, none, driver->row->name);

    Row *row = &system->constraints->rows.at[system->constraints->rows.count - 1];

    row->owner = driver->joint;
    row->coordinate = driver->joint_coordinate;
    row->reported.is_driver = !couples;
    row->reported.is_coupler = couples;
    row->reported.is_rate = driver->row->is_of_rates;
    row->reported.instance = driver->number;
    row->reported.edge = driver->edge;
}

/* --- rows to show --- */

/* sin(f - angle) of a chord's angle that is given by sine and cosine. It is 0 where the angle is f,
 * plus any number of full turns. */
static Expr angle_missed(System *system, const ChordTurn *turn, Expr f)
{
    Arena *arena = system->arena;

    return expr_sub(arena, expr_mul(arena, expr_sin(arena, f), turn->cosine),
                    expr_mul(arena, expr_cos(arena, f), turn->sine));
}

/* for position solvers: sine and cosine together also detect half a turn */
static void compare_angle(System *system, const char *name, const ChordTurn *turn, Expr f)
{
    Arena *arena = system->arena;
    Expr along = expr_add(arena, expr_mul(arena, expr_cos(arena, f), turn->cosine),
                          expr_mul(arena, expr_sin(arena, f), turn->sine));
    AngleOff compared = {
        name, expr_call2(arena, OP_ATAN2, expr_neg(arena, angle_missed(system, turn, f)), along)};

    LIST_PUSH(system->constraints->angles_off, compared);
}

static Expr tie_shown(System *system, const Row *row)
{
    Arena *arena = system->arena;
    const Instance *joint = &system->origin->instances[row->reported.instance];
    Steps steps;
    ChordTurn turn;
    Expr s;

    instance_steps(system, joint, &steps);
    s = slide_value(system, joint, &steps.shift[0]);
    chord_turn(system, joint, &steps, 0, &turn);
    if (turn.angle != NULL)
        return expr_sub(
            arena, s,
            expr_mul(arena, row->pitch,
                     expr_add(arena, turn.angle,
                              multi_turn_whole(system, joint->number, steps.turn[0].coordinate))));
    s = expr_div(arena, s, row->pitch);
    compare_angle(system, joint->coord[steps.turn[0].coordinate], &turn, s);
    return expr_mul(arena, row->pitch, angle_missed(system, &turn, s));
}

/* a driven coordinate minus its prescribed value */
static Status driver_shown(System *system, Row *row, Diag *diag)
{
    Arena *arena = system->arena;
    const Instance *driver = &system->origin->instances[row->reported.instance];
    const Instance *owner = &system->origin->instances[row->owner];
    bool chord = system->kinematics->coordinate[row->owner][row->coordinate] < 0;
    Expr value;
    Steps steps;

    TRY(variables_resolve(system, driver->row->prescribed(driver, arena), &row->prescribed, diag));
    instance_steps(system, owner, &steps);
    for (int k = 0; chord && k < steps.turn_count && steps.turn_count < 3; k++) {
        ChordTurn turn;

        if (steps.turn[k].coordinate != row->coordinate)
            continue;
        if (multi_turn_angle(system, row->owner, row->coordinate) == NULL)
            continue; /* the coordinate is a sum, or determined by a shift */
        chord_turn(system, owner, &steps, k, &turn);
        multi_turn_drive(system, row->owner, row->coordinate, row->prescribed);
        compare_angle(system, owner->coord[row->coordinate], &turn, row->prescribed);
        row->phi = expr_neg(arena, angle_missed(system, &turn, row->prescribed));
        return OK;
    }
    TRY(coordinate_value(system, owner, row->coordinate, 0, &value, diag));
    row->phi = expr_sub(arena, value, row->prescribed);
    return OK;
}

/* the coordinate whose rate that symbol is, or which it is, as the coupler follows */
static int coupled_number(const System *system, const Instance *coupler, const char *name)
{
    const size_t length = strlen(name);

    if (!coupler->row->is_of_rates)
        return names_find(system->origin->coordinate_names, name);
    if (length < 2 || name[length - 1] != '\'')
        return -1;
    return names_find(system->origin->coordinate_names,
                      system_retain(system, "%.*s", (int)length - 1, name));
}

/* the coordinate that a coupler determines, or its rate, minus its prescribed value */
static Status coupler_shown(System *system, Row *row, Diag *diag)
{
    Arena *arena = system->arena;
    const Instance *coupler = &system->origin->instances[row->reported.instance];
    const Expr law = coupler->row->prescribed(coupler, arena);
    Expr *symbols = NULL;
    const int count = expr_symbols(&law, 1, &symbols);
    Expr value;
    Status status = OK;

    row->coupled = pool_alloc(system->pool, (size_t)count * sizeof *row->coupled);
    for (int i = 0; i < count; i++) {
        const int number = coupled_number(system, coupler, expr_name(symbols[i]));
        Coupled *coupled = &row->coupled[row->coupled_count];

        if (expr_symbol_kind(symbols[i]) == SYMBOL_PARAMETER || number < 0)
            continue;
        coupled->owner = system->origin->coordinate_owners.at[number].instance;
        coupled->coordinate = system->origin->coordinate_owners.at[number].coordinate;
        CHECK(variables_resolve(system, expr_diff(arena, law, symbols[i]), &coupled->slope, diag));
        row->coupled_count++;
    }
    CHECK(variables_resolve(system, law, &row->prescribed, diag));
    CHECK(coordinate_value(system, &system->origin->instances[row->owner], row->coordinate,
                           coupler->row->is_of_rates, &value, diag));
    value = expr_sub(arena, value, row->prescribed);
    row->phi = coupler->row->is_of_rates ? expr_int(arena, 0) : value;
    row->rate = coupler->row->is_of_rates ? value : NULL;
done:
    mem_free(symbols);
    return status;
}

/* identity of a circuit's row; NULL: unknown identity */
static Expr circuit_key(const System *system, const Row *row)
{
    const Expr kind = expr_int(system->arena, row->kind);
    Key key = key_of(system->kinematics->frames[row->tail].identity);

    key_add(&key, &system->kinematics->frames[row->head].identity, sizeof(Expr));
    key_add(&key, &kind, sizeof kind);
    key_add(&key, &row->n, sizeof row->n);
    key_add(&key, &row->b, sizeof row->b);
    return key_end(system, &key);
}

static void circuit_find_shown(const System *system, RowPatterns *patterns, Row *row)
{
    row->key = circuit_key(system, row);
    if (derived_recall(system, row->key, DERIVED_ROW_SHOWN, &row->phi, sizeof row->phi))
        return;
    if (patterns == NULL || !row_pattern_show(patterns, row, &row->phi))
        row->phi = circuit_shown(system, row);
    derived_store(system, row->key, DERIVED_ROW_SHOWN, &row->phi, sizeof row->phi);
}

static Status row_shown(System *system, RowPatterns *patterns, Row *row, Diag *diag)
{
    Arena *arena = system->arena;
    Turns turns = {0};

    switch (row->kind) {
    case ROW_DATUM:
    case ROW_TAIL:
    case ROW_DOT:
        circuit_find_shown(system, patterns, row);
        return OK;
    case ROW_ANGLE: {
        const Instance *joint = &system->origin->instances[row->reported.instance];
        Rotation constant;
        Steps steps;

        instance_steps(system, joint, &steps);
        constant = chord_constant(system, joint, &steps);
        row->phi = rotation_angle(arena, &constant, row->n);
        turns_between(system, system->kinematics->frames[row->tail].chain,
                      system->kinematics->frames[row->head].chain, &turns);
        for (int i = 0; i < turns.count; i++) {
            Expr angle = turns.at[i].angle;

            /* the axis of the row, or its opposite: axes are unit vectors here */
            if (!vec_same(turns.at[i].axis, row->n))
                angle = expr_neg(arena, angle);
            row->phi = expr_add(arena, row->phi, angle);
        }
        LIST_FREE(turns);
        break;
    }
    case ROW_TIE:
        row->phi = tie_shown(system, row);
        break;
    case ROW_DRIVER:
        TRY(driver_shown(system, row, diag));
        break;
    case ROW_COUPLER:
        TRY(coupler_shown(system, row, diag));
        break;
    case ROW_CONTACT:
        break;
    }
    row->phi = expr_fold(arena, expr_open(arena, row->phi));
    return OK;
}

/* size of the terms of a sum, without cancellation; at least a unit length */
static double size_of_terms(Sample *sample, Expr e)
{
    double size = 1;

    for (int i = 0; expr_kind(e) == EXPR_SUM && i < expr_arg_count(e); i++)
        size += fabs(sample_number(sample, expr_arg(e, i)));
    return size;
}

/* the row has the same value in every position, though rounding may hide that in symbols. A number
 * computed from parameters counts as constant; other expressions of parameters may change with
 * them. */
static bool row_is_constant(const System *system, const Row *row, Sample *const *samples,
                            double *value)
{
    const double rounding = 1e-13;
    unsigned kinds = expr_kinds(row->phi);
    Expr moved;

    if ((kinds & (1U << SYMBOL_COORDINATE | 1U << SYMBOL_TIME)) == 0) {
        *value = system->scene->number(system->scene->context, row->phi);
        return true;
    }
    if ((kinds & 1U << SYMBOL_TIME) != 0 ||
        derived_recall(system, row->key, DERIVED_ROW_VARIES, &moved, sizeof moved))
        return false;
    *value = sample_number(samples[0], row->phi);
    for (int i = 1; i < SAMPLES; i++) {
        double off = fabs(sample_number(samples[i], row->phi) - *value);

        if (off <= rounding || off <= rounding * size_of_terms(samples[i], row->phi))
            continue;
        /* for any parameters: those of the samples are not special values */
        if (isfinite(off))
            derived_store(system, row->key, DERIVED_ROW_VARIES, &row->phi, sizeof row->phi);
        return false;
    }
    return true;
}

/* true: the row holds identically; an error when it never can */
static Status row_vanishes(System *system, const Row *row, Sample *const *samples, bool *vanishes,
                           Diag *diag)
{
    const char *joint = system->origin->instances[row->reported.instance].name;
    double value;

    *vanishes = false;
    if (row->reported.is_rate || !row_is_constant(system, row, samples, &value))
        return OK;
    if (row->kind == ROW_ANGLE)
        value = remainder(value, 2 * M_PI); /* full turns count as 0 */
    if (fabs(value) > CONSTRAINT_MISFIT) {
        (void)diag_set(diag, E_ASSEMBLE,
                       "%s can't be assembled: its equation along %s is %.6g = 0 in every position",
                       joint, row->reported.direction, value);
        diag_hint(diag, "lengths or axes on its circuit don't fit");
        return E_ASSEMBLE;
    }
    *vanishes = true;
    LIST_PUSH(system->constraints->redundant_rows, *row);
    LIST_PUSH(system->constraints->dropped,
              system_retain(system, "%s: %s %s holds in every position", joint,
                            row->reported.rotation ? "turning about" : "position along",
                            row->reported.direction));
    return OK;
}

bool system_holds(const System *system, uint64_t revision,
                  double (*number)(const void *context, Expr e), const void *context)
{
    bool holds = system->origin->revision == revision;

    for (int k = 0; holds && k < system->constraints->redundant_rows.count; k++) {
        Expr phi = system->constraints->redundant_rows.at[k].phi;

        if (expr_kinds(phi) == 1U << SYMBOL_PARAMETER)
            holds = fabs(number(context, phi)) <= CONSTRAINT_MISFIT;
    }
    return holds;
}

/* --- rows of the recursive form --- */

/* V = d rate/d u */
static void run_partials(System *system, Expr rate, int k)
{
    const int count = system->kinematics->u.count;
    Expr *symbols = NULL, *of_u = system->run.phi_u + (ptrdiff_t)k * count;
    const int listed = expr_symbols(&rate, 1, &symbols);

    for (int i = 0; i < listed; i++)
        for (int j = 0; expr_symbol_kind(symbols[i]) == SYMBOL_SPEED && j < count; j++)
            if (symbols[i] == system->kinematics->u.at[j].symbol)
                of_u[j] = expr_diff(system->arena, rate, symbols[i]);
    mem_free(symbols);
}

/* rows whose expression is short: angles, drivers, couplers and contacts */
static Status run_plain(System *system, const Row *row, int k, Diag *diag)
{
    Arena *arena = system->arena;
    int count = system->kinematics->u.count;
    Expr *speeds = NEW_ARRAY(Expr, count);
    Expr rate = row->rate;
    Expr second;
    Status status = OK;

    for (int j = 0; j < count; j++) {
        speeds[j] = system->kinematics->u.at[j].symbol;
        if (rate == NULL)
            system->run.phi_u[k * count + j] = speed_partial(system, row->phi, j);
    }
    if (rate == NULL)
        CHECK(system_rate_of(system, row->phi, &rate, diag));
    else
        run_partials(system, rate, k);
    CHECK(system_rate_of(system, rate, &second, diag));
    system->run.phi[k] = row->phi;
    system->run.nu[k] = expr_neg(arena, expr_substitute(arena, rate, speeds, NULL, count));
    system->run.gamma[k] = expr_neg(
        arena, expr_substitute(arena, second, system->kinematics->accelerations, NULL, count));
done:
    mem_free(speeds);
    return status;
}

/* the speeds of a row are part of what the row patterns store; no other speed moves the row */
static void run_circuit(const System *system, RowPatterns *patterns, const Row *row, int k,
                        int *speeds)
{
    const int count = circuit_speeds(system, row, speeds);
    const size_t size = (size_t)(count + 2) * sizeof(Expr);
    Expr *of_u = system->run.phi_u + (ptrdiff_t)k * system->kinematics->u.count;
    Expr *entries = NEW_ARRAY(Expr, count + 2), key;

    entries[0] = row->key;
    for (int i = 0; row->key != NULL && i < count; i++)
        entries[1 + i] = system->kinematics->u.at[speeds[i]].symbol;
    key = row->key != NULL ? expr_tuple(system->arena, entries, count + 1) : NULL;
    if (derived_recall(system, key, DERIVED_ROW_RUN, entries, size)) {
        for (int i = 0; i < count; i++)
            of_u[speeds[i]] = entries[i];
        system->run.phi[k] = entries[count];
        system->run.gamma[k] = entries[count + 1];
    } else {
        if (patterns == NULL || !row_pattern_run(patterns, row, k, speeds, count))
            circuit_run(system, row, k, speeds, count);
        for (int i = 0; key != NULL && i < count; i++)
            entries[i] = of_u[speeds[i]];
        entries[count] = system->run.phi[k];
        entries[count + 1] = system->run.gamma[k];
        derived_store(system, key, DERIVED_ROW_RUN, entries, size);
    }
    mem_free(entries);
}

static Status run_rows(System *system, RowPatterns *patterns, Diag *diag)
{
    int m = system->constraints->rows.count, count = system->kinematics->u.count;
    size_t size = (size_t)m * sizeof(Expr);
    int *speeds = NEW_ARRAY(int, system->kinematics->speed_count);
    const Expr zero = expr_int(system->arena, 0);
    Status status = OK;

    system->run.phi = pool_alloc(system->pool, size);
    system->run.nu = pool_alloc(system->pool, size);
    system->run.gamma = pool_alloc(system->pool, size);
    system->run.phi_u = pool_room(system->pool, size * (size_t)count);
    for (int i = 0; i < m * count; i++)
        system->run.phi_u[i] = zero;
    for (int k = 0; k < m; k++) {
        const Row *row = &system->constraints->rows.at[k];

        system->run.nu[k] = expr_int(system->arena, 0);
        if (row->kind == ROW_DATUM || row->kind == ROW_TAIL || row->kind == ROW_DOT)
            run_circuit(system, patterns, row, k, speeds);
        else
            CHECK(run_plain(system, row, k, diag));
        CHECK(monitor_poll(system->watch));
    }
done:
    mem_free(speeds);
    return status;
}

/* those of positions first, otherwise in order */
static void order_rows(System *system)
{
    Constraints *constraints = system->constraints;
    const int count = constraints->rows.count;
    Row *rates = NEW_ARRAY(Row, count);
    int positions = 0, moved = 0;

    for (int k = 0; k < count; k++) {
        const Row row = constraints->rows.at[k];

        if (row.reported.is_rate)
            rates[moved++] = row;
        else
            constraints->rows.at[positions++] = row;
    }
    for (int k = 0; k < moved; k++)
        constraints->rows.at[positions + k] = rates[k];
    mem_free(rates);
}

static Status all_rows(System *system, Diag *diag)
{
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];
        Steps steps;
        bool slides;
        bool turns;

        if (instance->row->family == FAMILY_CONTACT)
            TRY(contact_rows_push(system, instance, diag));
        if (instance->row->family == FAMILY_DRIVER || instance->row->family == FAMILY_COUPLER)
            driver_row(system, instance);
        if (instance->row->family != FAMILY_JOINT || instance->is_virtual)
            continue;
        instance_steps(system, instance, &steps);
        slides = !tree_has(system->origin->trees[TREE_TRANSLATION], instance->edge);
        turns = !tree_has(system->origin->trees[TREE_ROTATION], instance->edge);
        if (steps_are_tied(&steps) && slides != turns) {
            (void)diag_set(diag, E_BRANCH,
                           "%s ties a shift to a turn: it is a branch of both trees or of none",
                           instance->name);
            diag_hint(diag, "tree + %s puts it into both", instance->name);
            return E_BRANCH;
        }
        if (slides)
            force_rows(system, instance, &steps);
        if (turns)
            moment_rows(system, instance, &steps);
        if (slides && steps_are_tied(&steps))
            tie_row(system, instance, &steps);
    }
    order_rows(system);
    return OK;
}

Status constraints_build(System *system, Diag *diag)
{
    RowPatterns *patterns = system->alike != NULL ? row_patterns_new(system) : NULL;
    Sample *samples[SAMPLES];
    int kept = 0;
    Status status = OK;

    for (int i = 0; i < SAMPLES; i++) {
        samples[i] = sample_new(system, (uint64_t)i, true);
        sample_remember(samples[i]);
    }
    CHECK(all_rows(system, diag));
    for (int k = 0; k < system->constraints->rows.count; k++) {
        Row *row = &system->constraints->rows.at[k];
        bool vanishes;

        CHECK(row_shown(system, patterns, row, diag));
        CHECK(row_vanishes(system, row, samples, &vanishes, diag));
        if (!vanishes)
            system->constraints->rows.at[kept++] = *row;
    }
    system->constraints->rows.count = kept;
    CHECK(run_rows(system, patterns, diag));
done:
    for (int i = 0; i < SAMPLES; i++)
        sample_forget(samples[i]);
    row_patterns_free(patterns);
    return status;
}
