/* reinitialise.c: new values for some variables, then the constraints again */
#include "simulate/assemble/reinitialise.h"

#include "algebra/kkt.h"
#include "algebra/rank.h"
#include "base/memory.h"
#include "simulate/assemble/initial.h"
#include "simulate/assemble/level_rows.h"
#include "simulate/assemble/skeleton.h"

#include <math.h>
#include <string.h>

#define TOLERANCE 1e-11 /* of what is set and of the constraints, as assembly has it */
#define SWEEPS    3     /* of a problem that is linear but for rounding */
#define STAGES    16    /* of a way from the present values to those that are set */

typedef struct Target {
    Expr expr;
    StateLevel level;
    int place;   /* unknown that it is, alone; -1 */
    int column;  /* unknown that is held with it; -1: it is an equation */
    int turned;  /* angle of turns that it is; -1 */
    int row;     /* among the expressions of its level */
    Stand stand; /* what it says of frames, if it does */
} Target;

struct Reinit {
    ReinitPlan plan;
    LIST(Target) targets;
    Storage *storages; /* whose charge or flux stays */
    int storage_count;
    Skeleton *skeleton; /* NULL: nothing is mechanical, or no positions were set yet */
    LevelRows *levels[LEVEL_COUNT];
    LevelRows *kept; /* charges and fluxes */
    Probe *probe;    /* these, kinetic and potential energy, targets */
    /* of the call under way */
    double t;
    const double *values;
    double *y;
};

Reinit *reinit_new(const ReinitPlan *plan)
{
    Reinit *reset = NEW(Reinit);

    reset->plan = *plan;
    return reset;
}

void reinit_free(Reinit *reset)
{
    if (reset == NULL)
        return;
    LIST_FREE(reset->targets);
    mem_free(reset->storages);
    skeleton_free(reset->skeleton);
    for (int level = 0; level < LEVEL_COUNT; level++)
        level_rows_free(reset->levels[level]);
    level_rows_free(reset->kept);
    probe_free(reset->probe);
    mem_free(reset);
}

/* --- what can be set --- */

/* Positions are corrected in speeds: by that of a coordinate which has one of its own. */
static int column_of(const Reinit *reset, const Target *target)
{
    const Layout *l = reset->plan.layout;
    Expr rate;

    if (target->place < 0 || target->level != LEVEL_POSITION || reset->plan.equations->map == NULL)
        return target->place;
    rate = system_q_rate(l->system, target->place);
    for (int j = 0; j < l->nu; j++)
        if (l->symbols[l->u + j] == rate)
            return j;
    return -1;
}

static Status classify(const Reinit *reset, Target *target, const char *name, int primes,
                       Diag *diag)
{
    const unsigned known = 1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER | 1U << SYMBOL_COORDINATE |
                           1U << SYMBOL_SPEED | 1U << SYMBOL_STATE | 1U << SYMBOL_TURN;
    const unsigned kinds = expr_kinds(target->expr);
    const Layout *l = reset->plan.layout;

    if ((kinds & ~known) != 0 ||
        (kinds & (1U << SYMBOL_COORDINATE | 1U << SYMBOL_SPEED | 1U << SYMBOL_STATE)) == 0) {
        (void)diag_set(diag, E_VALUE, "%s%.*s follows from the rest and can't be set", name, primes,
                       "''''");
        diag_hint(diag, "coordinates and their rates can, and voltages and currents of storage "
                        "elements that are states");
        return E_VALUE;
    }
    target->level = (kinds & 1U << SYMBOL_STATE) != 0   ? LEVEL_STATES
                    : (kinds & 1U << SYMBOL_SPEED) != 0 ? LEVEL_VELOCITY
                                                        : LEVEL_POSITION;
    target->place = -1;
    for (int i = 0; i < level_count(l, target->level); i++)
        if (l->symbols[l->q + level_first(l, target->level) + i] == target->expr)
            target->place = i;
    target->column = column_of(reset, target);
    target->turned = -1;
    for (int k = 0; k < l->turned; k++)
        if (system_multi_turn(l->system, k)->angle == target->expr)
            target->turned = k;
    return OK;
}

Status reinit_add(Reinit *reset, const char *name, int primes, Diag *diag)
{
    Target target = {0};
    Status status = OK;

    CHECK(system_variable(reset->plan.layout->system, name, primes, &target.expr, diag));
    CHECK(classify(reset, &target, name, primes, diag));
    if (target.level == LEVEL_POSITION && primes == 0)
        target.stand = system_stand(reset->plan.layout->system, name);
    LIST_PUSH(reset->targets, target);
done:
    return status;
}

/* what is set of one level */
static Status compile_level(Reinit *reset, StateLevel level, Diag *diag)
{
    LIST(Expr) wanted = {0};
    Status status;

    for (int k = 0; k < reset->targets.count; k++)
        if (reset->targets.at[k].level == level) {
            reset->targets.at[k].row = wanted.count;
            LIST_PUSH(wanted, reset->targets.at[k].expr);
        }
    status =
        level_rows_new(level, reset->plan.layout, reset->plan.equations, reset->plan.parameters,
                       wanted.at, wanted.count, &reset->levels[level], diag);
    LIST_FREE(wanted);
    return status;
}

Status reinit_compile(Reinit *reset, Diag *diag)
{
    const Layout *l = reset->plan.layout;
    const int count = reset->storage_count = system_storages(l->system, &reset->storages);
    LIST(Expr) roots = {0};
    Status status = OK;

    for (int k = 0; k < count; k++)
        LIST_PUSH(roots, reset->storages[k].content);
    LIST_PUSH(roots, system_kinetic(l->system));
    LIST_PUSH(roots, system_potential(l->system));
    for (int k = 0; k < reset->targets.count; k++)
        LIST_PUSH(roots, reset->targets.at[k].expr);
    CHECK(probe_new(l, reset->plan.parameters, roots.at, roots.count, &reset->probe, diag));
    CHECK(level_rows_new(LEVEL_STATES, l, reset->plan.equations, reset->plan.parameters, roots.at,
                         count, &reset->kept, diag));
    CHECK(compile_level(reset, LEVEL_POSITION, diag));
    CHECK(compile_level(reset, LEVEL_VELOCITY, diag));
    CHECK(compile_level(reset, LEVEL_STATES, diag));
done:
    LIST_FREE(roots);
    return status;
}

/* --- evaluation --- */

static const double *probe_here(const Reinit *reset)
{
    const RowValues row = row_of_state(reset->plan.layout, reset->t, reset->y);

    return probe_values(reset->probe, &row);
}

static double energy(const Reinit *reset)
{
    const double *values = probe_here(reset) + reset->storage_count;

    return values[0] + values[1];
}

/* what may be set, as it is */
static const double *targets_here(const Reinit *reset)
{
    return probe_here(reset) + reset->storage_count + 2;
}

static bool is_chosen(const Reinit *reset, int k, StateLevel level)
{
    return reset->targets.at[k].level == level && !isnan(reset->values[k]);
}

/* Put the unknowns in place that are set by themselves, and hold them. */
static void put_direct(Reinit *reset, StateLevel level, bool *held)
{
    double *first = reset->y + level_first(reset->plan.layout, level);

    for (int k = 0; k < reset->targets.count; k++) {
        const Target *target = &reset->targets.at[k];

        if (!is_chosen(reset, k, level))
            continue;
        if (target->place >= 0)
            first[target->place] = reset->values[k];
        if (target->column >= 0)
            held[target->column] = true;
    }
}

/* What is chosen of a level, here; `direct`: with what is set by itself. */
static Rows rows_here(const Reinit *reset, StateLevel level, bool direct)
{
    LevelRows *rows = reset->levels[level];

    rows->t = reset->t;
    rows->y = reset->y;
    for (int k = 0; k < reset->targets.count; k++) {
        const Target *target = &reset->targets.at[k];
        const bool is_row = is_chosen(reset, k, level) && (direct || target->column < 0);

        if (target->level == level)
            rows->target[target->row] = is_row ? reset->values[k] : NAN;
    }
    return level_rows(rows, NULL);
}

/* --- positions and states: least squares --- */

static bool any_chosen(const Reinit *reset, StateLevel level)
{
    for (int k = 0; k < reset->targets.count; k++)
        if (is_chosen(reset, k, level))
            return true;
    return false;
}

/* Unknowns of a level from where they are to where its rows are met, but for those held. */
static bool meet(const Reinit *reset, StateLevel level, const Rows *rows, const bool *held)
{
    const size_t bytes = (size_t)rows->length * sizeof(double);
    double *first = reset->y + level_first(reset->plan.layout, level);
    double *v = NEW_ARRAY(double, rows->length);
    bool met = true;

    memcpy(v, first, bytes);
    if (rows->rows > 0)
        met = levenberg_marquardt_solve(rows, held, NULL, TOLERANCE, v, NULL);
    memcpy(first, v, bytes);
    mem_free(v);
    return met;
}

static bool solve_least_squares(Reinit *reset, StateLevel level)
{
    const Rows rows = rows_here(reset, level, false);
    bool *held = NEW_ARRAY(bool, rows.columns);
    bool met;

    put_direct(reset, level, held);
    if (level == LEVEL_POSITION)
        equations_normalise(reset->plan.equations, reset->y);
    met = meet(reset, level, &rows, held);
    mem_free(held);
    return met;
}

static Skeleton *skeleton_of(Reinit *reset)
{
    if (reset->skeleton == NULL)
        reset->skeleton = skeleton_new(reset->plan.layout, reset->plan.parameters);
    return reset->skeleton;
}

/* angles are looked for in the turn that is asked for */
static void begin_turns(const Reinit *reset)
{
    double *near = reset->y + layout_turned(reset->plan.layout);

    for (int k = 0; k < reset->targets.count; k++)
        if (reset->targets.at[k].turned >= 0 && is_chosen(reset, k, LEVEL_POSITION))
            near[reset->targets.at[k].turned] = reset->values[k];
}

/* Frames stand with what is set put in place along the joints: in coordinates of bodies that may be
 * far, where it is near in the joints'. */
static bool place_along_joints(Reinit *reset)
{
    NewPlaces places = {.layout = reset->plan.layout,
                        .parameters = reset->plan.parameters,
                        .equations = reset->plan.equations,
                        .skeleton = skeleton_of(reset),
                        .t = reset->t};
    Stand *stands;
    double *values;
    Diag diag = {0};
    bool sound;

    if (places.skeleton == NULL)
        return false;
    places.stands = stands = NEW_ARRAY(Stand, reset->targets.count);
    places.values = values = NEW_ARRAY(double, reset->targets.count);
    for (int k = 0; k < reset->targets.count; k++)
        if (is_chosen(reset, k, LEVEL_POSITION)) {
            stands[places.count] = reset->targets.at[k].stand;
            values[places.count++] = reset->values[k];
        }
    sound = initial_place_again(&places, reset->y, &diag) == OK;
    mem_free(stands);
    mem_free(values);
    return sound;
}

/* Positions in stages, from the present values of what is set to the new ones. */
static bool go_by_stages(Reinit *reset)
{
    const double *last = reset->values;
    double *values = NEW_ARRAY(double, reset->targets.count);
    double *from = NEW_ARRAY(double, reset->targets.count);
    bool met = true;

    memcpy(from, targets_here(reset), (size_t)reset->targets.count * sizeof(double));
    reset->values = values;
    for (int stage = 1; stage <= STAGES && met; stage++) {
        for (int k = 0; k < reset->targets.count; k++)
            values[k] = from[k] + (last[k] - from[k]) * stage / STAGES;
        begin_turns(reset);
        met = solve_least_squares(reset, LEVEL_POSITION);
    }
    reset->values = last;
    mem_free(values);
    mem_free(from);
    return met;
}

/* Whether all holds; where a joint lies the wrong way round, which equations alone don't tell,
 * `reversal` says so. */
static bool is_closed(Reinit *reset, bool met, Reversal *reversal)
{
    if (met)
        *reversal = skeleton_reversal(skeleton_of(reset), reset->y);
    return met && reversal->link == NULL;
}

static bool is_parameter(const Stand *stand)
{
    return stand->kind == STANDS_PARAMETER ||
           (stand->kind == STANDS_COORDINATE &&
            stand->instance->coord_kind[stand->which] == COORDINATE_PARAMETER);
}

/* Either sign of Euler parameters is the same attitude: the new values get that of the present
 * ones.
 */
static void align(const Reinit *reset, double *values)
{
    const double *present = targets_here(reset);
    const Target *targets = reset->targets.at;

    for (int k = 0; k < reset->targets.count; k++) {
        double along = 0;

        if (!is_chosen(reset, k, LEVEL_POSITION) || !is_parameter(&targets[k].stand))
            continue;
        for (int i = 0; i < reset->targets.count; i++)
            if (is_chosen(reset, i, LEVEL_POSITION) && is_parameter(&targets[i].stand) &&
                targets[i].stand.kind == targets[k].stand.kind &&
                targets[i].stand.instance == targets[k].stand.instance &&
                targets[i].stand.node == targets[k].stand.node)
                along += present[i] * reset->values[i];
        values[k] = along < 0 ? -reset->values[k] : reset->values[k];
    }
}

/* by least squares from where y is */
static bool close_positions(Reinit *reset, bool by_stages, Reversal *reversal)
{
    const double *given = reset->values;
    double *aligned = NEW_ARRAY(double, reset->targets.count);
    bool met;

    memcpy(aligned, given, (size_t)reset->targets.count * sizeof(double));
    align(reset, aligned);
    reset->values = aligned;
    begin_turns(reset);
    met = by_stages ? go_by_stages(reset) : solve_least_squares(reset, LEVEL_POSITION);
    met = is_closed(reset, met, reversal);
    reset->values = given;
    mem_free(aligned);
    return met;
}

/* Positions at once; where that leads nowhere, or to an axis that lies the wrong way round, from
 * where the joints lead; then in stages. */
static bool solve_positions(Reinit *reset, Text *why)
{
    const Layout *l = reset->plan.layout;
    const int length = layout_turned(l) + l->turned;
    const size_t bytes = (size_t)length * sizeof(double);
    double *begun = mem_array((size_t)length, sizeof(double));
    Reversal reversal = {.link = NULL};
    bool met;

    memcpy(begun, reset->y, bytes);
    met = close_positions(reset, false, &reversal);
    if (!met) {
        memcpy(reset->y, begun, bytes);
        begin_turns(reset);
        met = place_along_joints(reset) && close_positions(reset, false, &reversal);
    }
    if (!met) {
        memcpy(reset->y, begun, bytes);
        met = close_positions(reset, true, &reversal);
    }
    if (!met && reversal.link != NULL) {
        text_addf(why, "%s would close with ", reversal.link->instance->name);
        reversal_tell(reset->skeleton, &reversal, why);
    }
    mem_free(begun);
    return met;
}

/* --- speeds: the least change in the mass metric --- */

static bool velocity_sweep(const Reinit *reset, Kkt *kkt, const double *matrix, const int *rows,
                           int count, const double *missing)
{
    const Equations *eq = reset->plan.equations;
    double *bottom = NEW_ARRAY(double, count);
    double *lambda = NEW_ARRAY(double, count);
    double *du = NEW_ARRAY(double, eq->nu);
    bool sound = kkt_factor(kkt, eq->mass, matrix, rows);

    for (int k = 0; k < count; k++)
        bottom[k] = -missing[rows[k]];
    if (sound) {
        kkt_solve(kkt, NULL, bottom, du, lambda);
        for (int j = 0; j < eq->nu; j++)
            reset->y[eq->n + j] += du[j];
    }
    mem_free(bottom);
    mem_free(lambda);
    mem_free(du);
    return sound;
}

static bool is_met(const Reinit *reset, const double *missing, int count)
{
    const Equations *eq = reset->plan.equations;
    double size = 1;

    for (int j = 0; j < eq->nu; j++)
        size = fmax(size, fabs(reset->y[eq->n + j]));
    for (int k = 0; k < count; k++)
        if (!(fabs(missing[k]) <= 100 * TOLERANCE * size))
            return false;
    return true;
}

static bool solve_speeds(Reinit *reset)
{
    const Equations *eq = reset->plan.equations;
    int room = eq->m + reset->targets.count;
    double *matrix = NEW_ARRAY(double, room * eq->nu);
    double *missing = NEW_ARRAY(double, room);
    int *rows = NEW_ARRAY(int, room);
    bool *held = NEW_ARRAY(bool, eq->nu);
    int count = reset->plan.row_count;
    int all = eq->m;
    bool sound = true;
    Rows velocity;
    Kkt *kkt;

    put_direct(reset, LEVEL_VELOCITY, held);
    velocity = rows_here(reset, LEVEL_VELOCITY, true);
    eq->position(eq->context, reset->t, reset->y);
    /* those of the start may be dependent here, where others are not */
    if (count < eq->m)
        (void)rank_choose(eq->phi_u, eq->m, eq->nu, count, rows);
    else
        memcpy(rows, reset->plan.rows, (size_t)count * sizeof(int));
    for (int k = 0; k < reset->targets.count; k++)
        if (is_chosen(reset, k, LEVEL_VELOCITY))
            rows[count++] = all++;
    kkt = kkt_new(eq->nu, count, room);
    for (int sweep = 0; sweep <= SWEEPS && sound; sweep++) {
        velocity.evaluate(velocity.context, reset->y + eq->n, missing, matrix);
        if (is_met(reset, missing, all) || sweep == SWEEPS)
            break;
        sound = velocity_sweep(reset, kkt, matrix, rows, count, missing);
    }
    sound = sound && is_met(reset, missing, all);
    kkt_free(kkt);
    mem_free(matrix);
    mem_free(missing);
    mem_free(rows);
    mem_free(held);
    return sound;
}

/* --- charges and fluxes --- */

static bool is_set(const Reinit *reset, int state)
{
    for (int k = 0; k < reset->targets.count; k++)
        if (is_chosen(reset, k, LEVEL_STATES) && reset->targets.at[k].place == state)
            return true;
    return false;
}

/* What moves changes voltages and currents, and leaves charges and fluxes as they were, but for
 * those that were given. */
static bool keep_stored(const Reinit *reset, const double *before)
{
    const int nx = reset->plan.equations->nx;
    LevelRows *kept = reset->kept;
    bool *held = NEW_ARRAY(bool, nx);
    Rows rows;
    bool met;

    for (int i = 0; i < nx; i++)
        held[i] = true;
    for (int k = 0; k < reset->storage_count; k++) {
        const int state = reset->storages[k].state;

        held[state] = is_set(reset, state);
        kept->target[k] = held[state] ? NAN : before[k];
    }
    kept->t = reset->t;
    kept->y = reset->y;
    rows = level_rows(kept, NULL);
    met = meet(reset, LEVEL_STATES, &rows, held);
    mem_free(held);
    return met;
}

bool reinit_apply(Reinit *reset, double t, const double *values, double *y, Text *why)
{
    const Equations *eq = reset->plan.equations;
    int turned = layout_turned(reset->plan.layout);
    int length = turned + eq->multi_turn_count + 1;
    double *stored = NEW_ARRAY(double, reset->storage_count);
    double before;
    double after;
    bool met = true;

    reset->t = t;
    reset->values = values;
    reset->y = NEW_ARRAY(double, length);
    memcpy(reset->y, y, (size_t)length * sizeof(double));
    before = energy(reset);
    if (reset->storage_count > 0)
        memcpy(stored, probe_here(reset), (size_t)reset->storage_count * sizeof(double));
    if (any_chosen(reset, LEVEL_POSITION))
        met = solve_positions(reset, why);
    if (met && any_chosen(reset, LEVEL_STATES))
        met = solve_least_squares(reset, LEVEL_STATES);
    met = met && keep_stored(reset, stored);
    if (met && (any_chosen(reset, LEVEL_POSITION) || any_chosen(reset, LEVEL_VELOCITY)))
        met = solve_speeds(reset);
    if (met) {
        equations_turn(eq, t, reset->y, reset->y + turned);
        after = energy(reset);
        if (isfinite(after - before))
            reset->y[length - 1] += after - before;
        memcpy(y, reset->y, (size_t)length * sizeof(double));
    }
    mem_free(stored);
    mem_free(reset->y);
    reset->y = NULL;
    return met;
}
