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
    int place;      /* unknown that it is, alone; -1 */
    int column;     /* unknown that is held with it; -1: it is an equation */
    int multi_turn; /* angle of turns that it is; -1 */
    int row;        /* among the expressions of its level */
    Stand stand;    /* what it says of frames, if it does */
} Target;

struct Reinit {
    ReinitPlan plan;
    LIST(Target) targets;
    int given;         /* of them, the first; the others are of joints, which may stay */
    Storage *storages; /* whose charge or flux stays */
    int storage_count;
    Skeleton *skeleton; /* NULL: nothing is mechanical, or no positions were set yet */
    LevelRows *levels[LEVEL_COUNT];
    LevelRows *kept; /* charges and fluxes */
    Probe *probe;    /* these, kinetic and potential energy, targets */
    /* of the call under way */
    double t;
    double *values; /* of the targets */
    double *y;
};

Reinit *reinit_new(const ReinitPlan *plan)
{
    Reinit *reinit = NEW(Reinit);

    reinit->plan = *plan;
    return reinit;
}

void reinit_free(Reinit *reinit)
{
    if (reinit == NULL)
        return;
    LIST_FREE(reinit->targets);
    mem_free(reinit->storages);
    skeleton_free(reinit->skeleton);
    for (int level = 0; level < LEVEL_COUNT; level++)
        level_rows_free(reinit->levels[level]);
    level_rows_free(reinit->kept);
    probe_free(reinit->probe);
    mem_free(reinit);
}

/* --- what can be set --- */

/* Positions are corrected in speeds: by that of a coordinate which has one of its own. */
static int column_of(const Reinit *reinit, const Target *target)
{
    const Layout *l = reinit->plan.layout;
    Expr rate;

    if (target->place < 0 || target->level != LEVEL_POSITION || reinit->plan.equations->map == NULL)
        return target->place;
    rate = system_q_rate(l->system, target->place);
    for (int j = 0; j < l->nu; j++)
        if (l->symbols[l->u + j] == rate)
            return j;
    return -1;
}

static Status classify(const Reinit *reinit, Target *target, const char *name, int primes,
                       Diag *diag)
{
    const unsigned known = 1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER | 1U << SYMBOL_COORDINATE |
                           1U << SYMBOL_SPEED | 1U << SYMBOL_STATE | 1U << SYMBOL_TURN;
    const unsigned kinds = expr_kinds(target->expr);
    const Layout *l = reinit->plan.layout;

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
    target->column = column_of(reinit, target);
    target->multi_turn = -1;
    for (int k = 0; k < l->multi_turns; k++)
        if (system_multi_turn(l->system, k)->angle == target->expr)
            target->multi_turn = k;
    return OK;
}

Status reinit_add(Reinit *reinit, const char *name, int primes, Diag *diag)
{
    Target target = {0};

    TRY(system_variable(reinit->plan.layout->system, name, primes, &target.expr, diag));
    TRY(classify(reinit, &target, name, primes, diag));
    if (target.level == LEVEL_POSITION && primes == 0)
        target.stand = system_stand(reinit->plan.layout->system, name);
    LIST_PUSH(reinit->targets, target);
    return OK;
}

/* Where positions may be set, the coordinates of all joints that are there, and their rates: what
 * isn't set of them stays where it can. Nobody may ask for one; then it follows from the rest. */
static void add_joints(Reinit *reinit)
{
    System *system = reinit->plan.layout->system;
    bool any = false;

    reinit->given = reinit->targets.count;
    for (int k = 0; k < reinit->given; k++)
        any = any || reinit->targets.at[k].level == LEVEL_POSITION;
    for (int i = 0; i < system_instance_count(system) && any; i++) {
        const Instance *joint = system_instance(system, i);

        if (joint->row->family != FAMILY_JOINT || joint->is_virtual)
            continue;
        for (int c = 0; c < joint->coord_count; c++)
            for (int primes = 0; primes <= 1; primes++)
                if (reinit_add(reinit, joint->coord[c], primes, NULL) != OK)
                    break;
    }
}

/* what is set of one level */
static Status compile_level(Reinit *reinit, StateLevel level, Diag *diag)
{
    LIST(Expr) wanted = {0};
    Status status;

    for (int k = 0; k < reinit->targets.count; k++)
        if (reinit->targets.at[k].level == level) {
            reinit->targets.at[k].row = wanted.count;
            LIST_PUSH(wanted, reinit->targets.at[k].expr);
        }
    status =
        level_rows_new(level, reinit->plan.layout, reinit->plan.equations, reinit->plan.parameters,
                       wanted.at, wanted.count, &reinit->levels[level], diag);
    LIST_FREE(wanted);
    return status;
}

Status reinit_compile(Reinit *reinit, Diag *diag)
{
    const Layout *l = reinit->plan.layout;
    const int count = reinit->storage_count = system_storages(l->system, &reinit->storages);
    LIST(Expr) roots = {0};
    Status status = OK;

    add_joints(reinit);
    for (int k = 0; k < count; k++)
        LIST_PUSH(roots, reinit->storages[k].content);
    LIST_PUSH(roots, system_kinetic(l->system));
    LIST_PUSH(roots, system_potential(l->system));
    for (int k = 0; k < reinit->targets.count; k++)
        LIST_PUSH(roots, reinit->targets.at[k].expr);
    CHECK(probe_new(l, reinit->plan.parameters, roots.at, roots.count, &reinit->probe, diag));
    CHECK(level_rows_new(LEVEL_STATES, l, reinit->plan.equations, reinit->plan.parameters, roots.at,
                         count, &reinit->kept, diag));
    CHECK(compile_level(reinit, LEVEL_POSITION, diag));
    CHECK(compile_level(reinit, LEVEL_VELOCITY, diag));
    CHECK(compile_level(reinit, LEVEL_STATES, diag));
done:
    LIST_FREE(roots);
    return status;
}

/* --- evaluation --- */

static const double *probe_here(const Reinit *reinit)
{
    const RowValues row = row_of_state(reinit->plan.layout, reinit->t, reinit->y);

    return probe_values(reinit->probe, &row);
}

static double energy(const Reinit *reinit)
{
    const double *values = probe_here(reinit) + reinit->storage_count;

    return values[0] + values[1];
}

/* what may be set, as it is */
static const double *targets_here(const Reinit *reinit)
{
    return probe_here(reinit) + reinit->storage_count + 2;
}

static bool is_chosen(const Reinit *reinit, int k, StateLevel level)
{
    return reinit->targets.at[k].level == level && !isnan(reinit->values[k]);
}

/* Put the unknowns in place that are set by themselves, and hold them. */
static void put_direct(Reinit *reinit, StateLevel level, bool *held)
{
    double *first = reinit->y + level_first(reinit->plan.layout, level);

    for (int k = 0; k < reinit->targets.count; k++) {
        const Target *target = &reinit->targets.at[k];

        if (!is_chosen(reinit, k, level))
            continue;
        if (target->place >= 0)
            first[target->place] = reinit->values[k];
        if (target->column >= 0)
            held[target->column] = true;
    }
}

/* What is chosen of a level, here; `direct`: with what is set by itself. */
static Rows rows_here(const Reinit *reinit, StateLevel level, bool direct)
{
    LevelRows *rows = reinit->levels[level];

    rows->t = reinit->t;
    rows->y = reinit->y;
    for (int k = 0; k < reinit->targets.count; k++) {
        const Target *target = &reinit->targets.at[k];
        const bool is_row = is_chosen(reinit, k, level) && (direct || target->column < 0);

        if (target->level == level)
            rows->target[target->row] = is_row ? reinit->values[k] : NAN;
    }
    return level_rows(rows, NULL);
}

/* --- positions and states: least squares --- */

static bool any_chosen(const Reinit *reinit, StateLevel level)
{
    for (int k = 0; k < reinit->targets.count; k++)
        if (is_chosen(reinit, k, level))
            return true;
    return false;
}

/* Unknowns of a level from where they are to where its rows are met, but for those held. */
static bool meet(const Reinit *reinit, StateLevel level, const Rows *rows, const bool *held)
{
    const size_t bytes = (size_t)rows->length * sizeof(double);
    double *first = reinit->y + level_first(reinit->plan.layout, level);
    double *v = NEW_ARRAY(double, rows->length);
    bool met = true;

    memcpy(v, first, bytes);
    if (rows->rows > 0)
        met = levenberg_marquardt_solve(rows, held, NULL, TOLERANCE, v, NULL);
    memcpy(first, v, bytes);
    mem_free(v);
    return met;
}

static bool solve_least_squares(Reinit *reinit, StateLevel level)
{
    const Rows rows = rows_here(reinit, level, false);
    bool *held = NEW_ARRAY(bool, rows.columns);
    bool met;

    put_direct(reinit, level, held);
    if (level == LEVEL_POSITION)
        equations_normalise(reinit->plan.equations, reinit->y);
    met = meet(reinit, level, &rows, held);
    mem_free(held);
    return met;
}

static Skeleton *skeleton_of(Reinit *reinit)
{
    if (reinit->skeleton == NULL)
        reinit->skeleton = skeleton_new(reinit->plan.layout, reinit->plan.parameters);
    return reinit->skeleton;
}

/* angles are looked for in the turn that is asked for */
static void begin_turns(const Reinit *reinit)
{
    double *near = reinit->y + layout_references(reinit->plan.layout);

    for (int k = 0; k < reinit->targets.count; k++)
        if (reinit->targets.at[k].multi_turn >= 0 && is_chosen(reinit, k, LEVEL_POSITION))
            near[reinit->targets.at[k].multi_turn] = reinit->values[k];
}

/* Frames stand with what is set put in place along the joints: in coordinates of bodies that may be
 * far, where it is near in the joints'. */
static bool place_along_joints(Reinit *reinit)
{
    NewPlaces places = {.layout = reinit->plan.layout,
                        .parameters = reinit->plan.parameters,
                        .equations = reinit->plan.equations,
                        .skeleton = skeleton_of(reinit),
                        .t = reinit->t};
    Stand *stands;
    double *values;
    Diag diag = {0};
    bool sound;

    if (places.skeleton == NULL)
        return false;
    places.stands = stands = NEW_ARRAY(Stand, reinit->targets.count);
    places.values = values = NEW_ARRAY(double, reinit->targets.count);
    for (int k = 0; k < reinit->targets.count; k++)
        if (is_chosen(reinit, k, LEVEL_POSITION)) {
            stands[places.count] = reinit->targets.at[k].stand;
            values[places.count++] = reinit->values[k];
        }
    sound = initial_place_again(&places, reinit->y, &diag) == OK;
    MEM_FREE(stands, values);
    return sound;
}

/* Positions in stages, from the present values of what is set to the new ones. */
static bool go_by_stages(Reinit *reinit)
{
    double *last = reinit->values;
    double *values = NEW_ARRAY(double, reinit->targets.count);
    double *from = NEW_ARRAY(double, reinit->targets.count);
    bool met = true;

    memcpy(from, targets_here(reinit), (size_t)reinit->targets.count * sizeof(double));
    reinit->values = values;
    for (int stage = 1; stage <= STAGES && met; stage++) {
        for (int k = 0; k < reinit->targets.count; k++)
            values[k] = from[k] + (last[k] - from[k]) * stage / STAGES;
        begin_turns(reinit);
        met = solve_least_squares(reinit, LEVEL_POSITION);
    }
    reinit->values = last;
    MEM_FREE(values, from);
    return met;
}

/* Whether all holds; where a joint lies the wrong way round, which equations alone don't tell,
 * `reversal` says so. */
static bool is_closed(Reinit *reinit, bool met, Reversal *reversal)
{
    if (met)
        *reversal = skeleton_reversal(skeleton_of(reinit), reinit->y);
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
static void align(const Reinit *reinit, double *values)
{
    const double *present = targets_here(reinit);
    const Target *targets = reinit->targets.at;

    for (int k = 0; k < reinit->targets.count; k++) {
        double along = 0;

        if (!is_chosen(reinit, k, LEVEL_POSITION) || !is_parameter(&targets[k].stand))
            continue;
        for (int i = 0; i < reinit->targets.count; i++)
            if (is_chosen(reinit, i, LEVEL_POSITION) && is_parameter(&targets[i].stand) &&
                targets[i].stand.kind == targets[k].stand.kind &&
                targets[i].stand.instance == targets[k].stand.instance &&
                targets[i].stand.node == targets[k].stand.node)
                along += present[i] * reinit->values[i];
        values[k] = along < 0 ? -reinit->values[k] : reinit->values[k];
    }
}

/* by least squares from where y is */
static bool close_positions(Reinit *reinit, bool by_stages, Reversal *reversal)
{
    double *given = reinit->values;
    double *aligned = NEW_ARRAY(double, reinit->targets.count);
    bool met;

    memcpy(aligned, given, (size_t)reinit->targets.count * sizeof(double));
    align(reinit, aligned);
    reinit->values = aligned;
    begin_turns(reinit);
    met = by_stages ? go_by_stages(reinit) : solve_least_squares(reinit, LEVEL_POSITION);
    met = is_closed(reinit, met, reversal);
    reinit->values = given;
    mem_free(aligned);
    return met;
}

/* Whether joints that aren't set stay, as far as anything but their constraints knows. */
static void hold_joints(const Reinit *reinit, bool stay)
{
    const double *present = targets_here(reinit);
    const Target *targets = reinit->targets.at;

    for (int k = reinit->given; k < reinit->targets.count; k++) {
        bool is_set = false;

        for (int i = 0; i < reinit->given; i++)
            is_set = is_set ||
                     (is_chosen(reinit, i, LEVEL_POSITION) && targets[i].expr == targets[k].expr);
        reinit->values[k] = stay && !is_set ? present[k] : NAN;
    }
}

/* Positions at once; where that leads nowhere, or to an axis that lies the wrong way round, from
 * where the joints lead; then in stages, if that may take so long. */
static bool try_positions(Reinit *reinit, bool by_stages, const double *begun, size_t bytes,
                          Reversal *reversal)
{
    bool met;

    met = close_positions(reinit, false, reversal);
    if (!met) {
        memcpy(reinit->y, begun, bytes);
        begin_turns(reinit);
        met = place_along_joints(reinit) && close_positions(reinit, false, reversal);
    }
    if (!met) {
        memcpy(reinit->y, begun, bytes);
        met = by_stages && close_positions(reinit, true, reversal);
    }
    return met;
}

/* With all joints as they were but for what is set, whatever the tree; where constraints, or what
 * is set, ask others to move, by the least move of the tree's coordinates. */
static bool solve_positions(Reinit *reinit, bool *stay, Text *why)
{
    const Layout *l = reinit->plan.layout;
    const int length = layout_references(l) + l->multi_turns;
    const size_t bytes = (size_t)length * sizeof(double);
    double *begun = mem_array((size_t)length, sizeof(double));
    Reversal reversal = {.link = NULL};
    bool met;

    memcpy(begun, reinit->y, bytes);
    hold_joints(reinit, true);
    met = *stay = try_positions(reinit, false, begun, bytes, &reversal);
    if (!met) {
        hold_joints(reinit, false);
        memcpy(reinit->y, begun, bytes);
        reversal.link = NULL;
        met = try_positions(reinit, true, begun, bytes, &reversal);
    }
    if (!met && reversal.link != NULL) {
        text_addf(why, "%s would close with ", reversal.link->instance->name);
        reversal_tell(reinit->skeleton, &reversal, why);
    }
    mem_free(begun);
    return met;
}

/* --- speeds: the least change in the mass metric --- */

static bool velocity_sweep(const Reinit *reinit, Kkt *kkt, const double *matrix, const int *rows,
                           int count, const double *missing)
{
    const Equations *eq = reinit->plan.equations;
    double *bottom = NEW_ARRAY(double, count);
    double *lambda = NEW_ARRAY(double, count);
    double *du = NEW_ARRAY(double, eq->nu);
    bool sound = kkt_factor(kkt, equations_mass(eq), matrix, rows);

    for (int k = 0; k < count; k++)
        bottom[k] = -missing[rows[k]];
    if (sound) {
        kkt_solve(kkt, NULL, bottom, du, lambda);
        for (int j = 0; j < eq->nu; j++)
            reinit->y[eq->n + j] += du[j];
    }
    MEM_FREE(bottom, lambda, du);
    return sound;
}

static bool is_met(const Reinit *reinit, const double *missing, int count)
{
    const Equations *eq = reinit->plan.equations;
    double size = 1;

    for (int j = 0; j < eq->nu; j++)
        size = fmax(size, fabs(reinit->y[eq->n + j]));
    for (int k = 0; k < count; k++)
        if (!(fabs(missing[k]) <= 100 * TOLERANCE * size))
            return false;
    return true;
}

static bool solve_speeds(Reinit *reinit)
{
    const Equations *eq = reinit->plan.equations;
    int room = eq->m + reinit->targets.count;
    double *matrix, *missing = NEW_ARRAY(double, room);
    int *rows = NEW_ARRAY(int, room);
    int count = reinit->plan.row_count;
    int all = eq->m;
    bool sound = true;
    const Rows velocity = rows_here(reinit, LEVEL_VELOCITY, true);
    Kkt *kkt;

    matrix = NEW_ARRAY(double, velocity.pattern->count);
    eq->position(eq->context, reinit->t, reinit->y);
    /* those of the start may be dependent here, where others are not */
    if (count < eq->m) {
        double *phi_u = pattern_spread(eq->rows, eq->phi_u);

        (void)rank_choose(phi_u, eq->m, eq->nu, count, rows);
        mem_free(phi_u);
    } else {
        memcpy(rows, reinit->plan.rows, (size_t)count * sizeof(int));
    }
    for (int k = 0; k < reinit->targets.count; k++)
        if (is_chosen(reinit, k, LEVEL_VELOCITY))
            rows[count++] = all++;
    kkt = kkt_new(eq->masses, velocity.pattern, rows, count);
    for (int sweep = 0; sweep <= SWEEPS && sound; sweep++) {
        velocity.evaluate(velocity.context, reinit->y + eq->n, missing, matrix);
        if (is_met(reinit, missing, all) || sweep == SWEEPS)
            break;
        sound = velocity_sweep(reinit, kkt, matrix, rows, count, missing);
    }
    sound = sound && is_met(reinit, missing, all);
    kkt_free(kkt);
    MEM_FREE(matrix, missing, rows);
    return sound;
}

/* Where joints have stayed their rates do, too: speeds of bodies become those that go with them. */
static void hold_rates(Reinit *reinit, const double *before)
{
    const Equations *eq = reinit->plan.equations;
    double *u = NEW_ARRAY(double, eq->nu);
    Rows rows;

    memcpy(u, reinit->y + eq->n, (size_t)eq->nu * sizeof(double));
    for (int k = 0; k < reinit->targets.count; k++)
        reinit->values[k] =
            k >= reinit->given && reinit->targets.at[k].level == LEVEL_VELOCITY ? before[k] : NAN;
    eq->position(eq->context, reinit->t, reinit->y);
    rows = rows_here(reinit, LEVEL_VELOCITY, true);
    if (!meet(reinit, LEVEL_VELOCITY, &rows, NULL))
        memcpy(reinit->y + eq->n, u, (size_t)eq->nu * sizeof(double));
    mem_free(u);
}

static void choose_given(const Reinit *reinit, const double *values)
{
    for (int k = 0; k < reinit->targets.count; k++)
        reinit->values[k] = k < reinit->given ? values[k] : NAN;
}

/* --- charges and fluxes --- */

static bool is_set(const Reinit *reinit, int state)
{
    for (int k = 0; k < reinit->targets.count; k++)
        if (is_chosen(reinit, k, LEVEL_STATES) && reinit->targets.at[k].place == state)
            return true;
    return false;
}

/* What moves changes voltages and currents, and leaves charges and fluxes as they were, but for
 * those that were given. */
static bool keep_stored(const Reinit *reinit, const double *before)
{
    const int nx = reinit->plan.equations->nx;
    LevelRows *kept = reinit->kept;
    bool *held = NEW_ARRAY(bool, nx);
    Rows rows;
    bool met;

    for (int i = 0; i < nx; i++)
        held[i] = true;
    for (int k = 0; k < reinit->storage_count; k++) {
        const int state = reinit->storages[k].state;

        held[state] = is_set(reinit, state);
        kept->target[k] = held[state] ? NAN : before[k];
    }
    kept->t = reinit->t;
    kept->y = reinit->y;
    rows = level_rows(kept, NULL);
    met = meet(reinit, LEVEL_STATES, &rows, held);
    mem_free(held);
    return met;
}

bool reinit_apply(Reinit *reinit, double t, const double *values, double *y, Text *why)
{
    const Equations *eq = reinit->plan.equations;
    int references = layout_references(reinit->plan.layout);
    int length = references + eq->multi_turn_count + 1;
    double *stored = NEW_ARRAY(double, reinit->storage_count);
    double *present = NEW_ARRAY(double, reinit->targets.count);
    double before;
    double after;
    bool met = true, stay = false;

    reinit->t = t;
    reinit->values = NEW_ARRAY(double, reinit->targets.count);
    choose_given(reinit, values);
    reinit->y = NEW_ARRAY(double, length);
    memcpy(reinit->y, y, (size_t)length * sizeof(double));
    before = energy(reinit);
    if (reinit->storage_count > 0)
        memcpy(stored, probe_here(reinit), (size_t)reinit->storage_count * sizeof(double));
    memcpy(present, targets_here(reinit), (size_t)reinit->targets.count * sizeof(double));
    if (any_chosen(reinit, LEVEL_POSITION))
        met = solve_positions(reinit, &stay, why);
    if (stay)
        hold_rates(reinit, present);
    choose_given(reinit, values);
    if (met && any_chosen(reinit, LEVEL_STATES))
        met = solve_least_squares(reinit, LEVEL_STATES);
    met = met && keep_stored(reinit, stored);
    if (met && (any_chosen(reinit, LEVEL_POSITION) || any_chosen(reinit, LEVEL_VELOCITY)))
        met = solve_speeds(reinit);
    if (met) {
        equations_turn(eq, t, reinit->y, reinit->y + references);
        after = energy(reinit);
        if (isfinite(after - before))
            reinit->y[length - 1] += after - before;
        memcpy(y, reinit->y, (size_t)length * sizeof(double));
    }
    MEM_FREE(stored, present, reinit->y, reinit->values);
    reinit->y = NULL;
    reinit->values = NULL;
    return met;
}
