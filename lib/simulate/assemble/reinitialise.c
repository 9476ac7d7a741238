/* reinitialise.c: new values for some variables, then the constraints again */
#include "simulate/assemble/reinitialise_impl.h"

#include "algebra/kkt.h"
#include "algebra/rank.h"
#include "simulate/assemble/initial.h"

#include <math.h>
#include <string.h>

#define TOLERANCE 1e-11 /* of what is set and of the constraints, as assembly has it */
#define SWEEPS    3     /* of a problem that is linear but for rounding */
#define STAGE     0.2   /* m or rad: so far positions go at a time, */
#define STAGES    500   /* in so many stages at most */

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
    LIST_FREE(reinit->named);
    held_coordinates_free(reinit->stays, reinit->held_count);
    mem_free(reinit->storages);
    kinematic_tree_free(reinit->kinematic_tree);
    for (int level = 0; level < LEVEL_COUNT; level++)
        level_rows_free(reinit->levels[level]);
    level_rows_free(reinit->kept);
    probe_free(reinit->probe);
    mem_free(reinit);
}

/* --- what can be set --- */

static Status classify(const Reinit *reinit, Target *target, const char *name, int primes,
                       Diag *diag)
{
    const unsigned known = 1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER | 1U << SYMBOL_COORDINATE |
                           1U << SYMBOL_SPEED | 1U << SYMBOL_STATE | 1U << SYMBOL_TURN;
    const unsigned kinds = expr_kinds(target->expr);

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
    reinit_locate(reinit, target);
    return OK;
}

Status reinit_add(Reinit *reinit, const char *name, int primes, Diag *diag)
{
    System *system = reinit->plan.layout->system;
    Target target = {.node = -1, .rate = -1, .attitude = -1, .turning = -1, .held_index = -1};

    TRY(system_variable(system, name, primes, &target.expr, diag));
    TRY(classify(reinit, &target, name, primes, diag));
    if (target.level == LEVEL_POSITION || (target.level == LEVEL_VELOCITY && primes == 1))
        target.referent = system_referent(system, name);
    if (target.level == LEVEL_POSITION)
        LIST_PUSH(reinit->named, name);
    LIST_PUSH(reinit->targets, target);
    return OK;
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
    const VariableIndex *l = reinit->plan.layout;
    const int count = reinit->storage_count = system_storages(l->system, &reinit->storages);
    LIST(Expr) roots = {0};
    Status status = OK;

    reinit_add_stays(reinit);
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

/* Put the unknowns in place that are set by themselves, and hold them. */
static void put_direct(Reinit *reinit, StateLevel level, bool *held)
{
    double *first = reinit->y + level_first(reinit->plan.layout, level);

    for (int k = 0; k < reinit->targets.count; k++) {
        const Target *target = &reinit->targets.at[k];

        if (!reinit_is_chosen(reinit, k, level))
            continue;
        if (target->place >= 0)
            first[target->place] = reinit->values[k];
        if (target->column >= 0)
            held[target->column] = true;
    }
}

/* --- positions and states: least squares --- */

static bool any_chosen(const Reinit *reinit, StateLevel level)
{
    for (int k = 0; k < reinit->targets.count; k++)
        if (reinit_is_chosen(reinit, k, level))
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
    const Rows rows = reinit_rows(reinit, level, false);
    bool *held = NEW_ARRAY(bool, rows.columns);
    bool met;

    put_direct(reinit, level, held);
    if (level == LEVEL_POSITION)
        equations_normalise(reinit->plan.equations, reinit->y);
    met = meet(reinit, level, &rows, held);
    mem_free(held);
    return met;
}

static KinematicTree *kinematic_tree_of(Reinit *reinit)
{
    if (reinit->kinematic_tree == NULL)
        reinit->kinematic_tree = kinematic_tree_new(reinit->plan.layout, reinit->plan.parameters);
    return reinit->kinematic_tree;
}

/* angles are looked for in the turn that is asked for */
static void begin_turns(const Reinit *reinit)
{
    double *near = reinit->y + variable_index_references(reinit->plan.layout);

    for (int k = 0; k < reinit->targets.count; k++)
        if (reinit->targets.at[k].multi_turn >= 0 && reinit_is_chosen(reinit, k, LEVEL_POSITION))
            near[reinit->targets.at[k].multi_turn] = reinit->values[k];
}

/* Frames stand with what is set put in place along the joints: in coordinates of bodies that may be
 * far, where it is near in the joints'. */
static bool place_along_joints(Reinit *reinit)
{
    NewPlaces places = {.layout = reinit->plan.layout,
                        .parameters = reinit->plan.parameters,
                        .equations = reinit->plan.equations,
                        .kinematic_tree = kinematic_tree_of(reinit),
                        .t = reinit->t};
    VariableReferent *referents;
    double *values;
    Diag diag = {0};
    bool sound;

    if (places.kinematic_tree == NULL)
        return false;
    places.referents = referents = NEW_ARRAY(VariableReferent, reinit->targets.count);
    places.values = values = NEW_ARRAY(double, reinit->targets.count);
    for (int k = 0; k < reinit->targets.count; k++)
        if (reinit_is_chosen(reinit, k, LEVEL_POSITION)) {
            referents[places.count] = reinit->targets.at[k].referent;
            values[places.count++] = reinit->values[k];
        }
    sound = initial_place_again(&places, reinit->y, &diag) == OK;
    MEM_FREE(referents, values);
    return sound;
}

static bool is_parameter(const VariableReferent *referent)
{
    return referent->kind == REFERENT_PARAMETER ||
           (referent->kind == REFERENT_COORDINATE &&
            referent->instance->coord_kind[referent->which] == COORDINATE_PARAMETER);
}

/* whether two are Euler parameters of one attitude, or rates of such */
static bool is_one_attitude(const VariableReferent *a, const VariableReferent *b)
{
    return is_parameter(a) && is_parameter(b) && a->kind == b->kind && a->instance == b->instance &&
           a->node == b->node;
}

/* of two that are chosen, whether they are Euler parameters of one attitude */
static bool is_same_attitude(const Reinit *reinit, int i, int k)
{
    return reinit_is_chosen(reinit, i, LEVEL_POSITION) &&
           reinit_is_chosen(reinit, k, LEVEL_POSITION) &&
           is_one_attitude(&reinit->targets.at[i].referent, &reinit->targets.at[k].referent);
}

/* Either sign of Euler parameters is the same attitude: the new values get that of the present
 * ones. */
static void align(const Reinit *reinit, double *values)
{
    const double *present = targets_here(reinit);

    for (int k = 0; k < reinit->targets.count; k++) {
        double along = 0;

        for (int i = 0; i < reinit->targets.count && is_parameter(&reinit->targets.at[k].referent);
             i++)
            along += is_same_attitude(reinit, i, k) ? present[i] * reinit->values[i] : 0;
        values[k] = along < 0 ? -reinit->values[k] : reinit->values[k];
    }
}

/* Between two attitudes lie others: all four parameters that are chosen of one are brought to size
 * 1 together. */
static void normalise(const Reinit *reinit, const double *values, double *out)
{
    for (int k = 0; k < reinit->targets.count; k++) {
        double square = 0;
        int count = 0;

        for (int i = 0; i < reinit->targets.count && is_parameter(&reinit->targets.at[k].referent);
             i++)
            if (is_same_attitude(reinit, i, k)) {
                square += values[i] * values[i];
                count++;
            }
        out[k] = count == 4 ? values[k] / sqrt(square) : values[k];
    }
}

/* Positions in stages, from the present values of what is set to the new ones. */
static bool go_by_stages(Reinit *reinit)
{
    const int count = reinit->targets.count;
    double *last = reinit->values, *from = NEW_ARRAY(double, count);
    double *way = NEW_ARRAY(double, count), *values = NEW_ARRAY(double, count), far = 0;
    bool met = true;
    int stages;

    memcpy(from, targets_here(reinit), (size_t)count * sizeof(double));
    for (int k = 0; k < count; k++)
        far = fmax(far, reinit_is_chosen(reinit, k, LEVEL_POSITION) ? fabs(last[k] - from[k]) : 0);
    stages = far < STAGE * STAGES ? 1 + (int)(far / STAGE) : STAGES;
    for (int stage = 1; stage <= stages && met; stage++) {
        for (int k = 0; k < count; k++)
            way[k] = from[k] + (last[k] - from[k]) * stage / stages;
        normalise(reinit, way, values);
        reinit->values = stage < stages ? values : last;
        begin_turns(reinit);
        met = solve_least_squares(reinit, LEVEL_POSITION);
        reinit->values = last;
    }
    MEM_FREE(values, way, from);
    return met;
}

/* Whether all holds; where a joint lies the wrong way round, which equations alone don't tell,
 * `reversal` says so. */
static bool is_closed(Reinit *reinit, bool met, Reversal *reversal)
{
    if (met)
        *reversal = kinematic_tree_reversal(kinematic_tree_of(reinit), reinit->y);
    return met && reversal->link == NULL;
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

/* What isn't given stays, as was decided; the rest follows. */
static void fix_held_coordinates(const Reinit *reinit, const Decision *decision)
{
    const double *present = targets_here(reinit);

    for (int k = reinit->given; k < reinit->targets.count; k++)
        reinit->values[k] =
            decision->keeps[k] && reinit->targets.at[k].level == LEVEL_POSITION ? present[k] : NAN;
}

/* In stages, on which positions near those before are found, the same in any tree; where these lead
 * nowhere, or to an axis that lies the wrong way round, from where the joints lead; then at once.
 */
static bool solve_positions(Reinit *reinit, const Decision *decision, Text *why)
{
    const VariableIndex *l = reinit->plan.layout;
    const int length = variable_index_references(l) + l->multi_turns;
    const size_t bytes = (size_t)length * sizeof(double);
    double *begun = mem_array((size_t)length, sizeof(double));
    Reversal reversal = {.link = NULL};
    bool met;

    memcpy(begun, reinit->y, bytes);
    fix_held_coordinates(reinit, decision);
    met = close_positions(reinit, true, &reversal);
    if (!met) {
        memcpy(reinit->y, begun, bytes);
        begin_turns(reinit);
        met = place_along_joints(reinit) && close_positions(reinit, false, &reversal);
    }
    if (!met) {
        memcpy(reinit->y, begun, bytes);
        met = close_positions(reinit, false, &reversal);
    }
    if (!met && reversal.link != NULL) {
        text_addf(why, "%s would close with ", reversal.link->instance->name);
        reversal_report(reinit->kinematic_tree, &reversal, why);
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
    const Rows velocity = reinit_rows(reinit, LEVEL_VELOCITY, true);
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
        if (reinit_is_chosen(reinit, k, LEVEL_VELOCITY))
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

/* Speeds become those that go with the rates that stay. */
static bool keep_rates(Reinit *reinit, const Decision *decision, const double *values,
                       const double *before)
{
    Rows rows;

    if (!reinit_choose_rates(reinit, decision, values, before))
        return false;
    rows = reinit_rows(reinit, LEVEL_VELOCITY, true);
    return meet(reinit, LEVEL_VELOCITY, &rows, NULL);
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
        if (reinit_is_chosen(reinit, k, LEVEL_STATES) && reinit->targets.at[k].place == state)
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

/* --- all of it --- */

static Status refuse(const Reinit *reinit, const char *events, const char *why, Diag *diag)
{
    (void)diag_set(diag, E_SOLVER, "at t = %.9g s: the new values of event %s can't be met%s%s",
                   reinit->t, events, why != NULL ? ": " : "", why != NULL ? why : "");
    diag_hint(diag, "what the constraints tie together can't be set apart");
    return E_SOLVER;
}

static Status refuse_open(const Reinit *reinit, const char *events, const Decision *decision,
                          Diag *diag)
{
    (void)diag_set(
        diag, E_SOLVER,
        "at t = %.9g s: event %s doesn't determine where %s go%s: what it sets moves more than "
        "follows from it",
        reinit->t, events, decision->names.at, decision->open == 1 ? "es" : "");
    if (decision->example != NULL)
        diag_hint(diag,
                  "give the event so many values more, of these or of others that move with them; "
                  "%s=%s stays",
                  decision->example, decision->example);
    return E_SOLVER;
}

static Status refuse_rates(const Reinit *reinit, const char *events, Diag *diag)
{
    (void)diag_set(
        diag, E_SOLVER,
        "at t = %.9g s: event %s sets a singular position, where the rates of before don't "
        "set all rates",
        reinit->t, events);
    diag_hint(diag, "a position beside it will do, or rates that the event gives, too: h1'=0");
    return E_SOLVER;
}

/* (q, q') and (-q, -q') are the same motion: where the attitude that was given as q stands as -q,
 * the rates that were given with it change their sign, too. */
static void align_rates(const Reinit *reinit, double *values)
{
    const double *present = targets_here(reinit);

    for (int k = 0; k < reinit->given; k++) {
        const Target *rate = &reinit->targets.at[k];
        double along = 0;

        if (rate->level != LEVEL_VELOCITY || isnan(values[k]))
            continue;
        for (int i = 0; i < reinit->given; i++)
            if (reinit->targets.at[i].level == LEVEL_POSITION && !isnan(values[i]) &&
                is_one_attitude(&reinit->targets.at[i].referent, &rate->referent))
                along += present[i] * values[i];
        if (along < 0)
            values[k] = -values[k];
    }
}

/* rates among `values` get the sense in which their attitudes stand */
static Status put_positions(Reinit *reinit, const char *events, double *values,
                            const double *present, Diag *diag)
{
    Decision decision;
    Text why = {0};
    Status status = OK;

    reinit_decide(reinit, &decision);
    if (decision.open > 0)
        status = refuse_open(reinit, events, &decision, diag);
    else if (!solve_positions(reinit, &decision, &why))
        status = refuse(reinit, events, why.at, diag);
    else {
        align_rates(reinit, values);
        if (!keep_rates(reinit, &decision, values, present))
            status = refuse_rates(reinit, events, diag);
    }
    decision_free(&decision);
    text_free(&why);
    choose_given(reinit, values);
    return status;
}

/* all levels, in place */
static Status put_values(Reinit *reinit, const char *events, double *values, const double *present,
                         const double *stored, Diag *diag)
{
    const bool has_positions = any_chosen(reinit, LEVEL_POSITION);
    const bool has_speeds = any_chosen(reinit, LEVEL_VELOCITY);
    bool met = true;

    if (has_positions)
        TRY(put_positions(reinit, events, values, present, diag));
    if (any_chosen(reinit, LEVEL_STATES))
        met = solve_least_squares(reinit, LEVEL_STATES);
    met = met && keep_stored(reinit, stored);
    if (met && (has_positions || has_speeds))
        met = solve_speeds(reinit);
    return met ? OK : refuse(reinit, events, NULL, diag);
}

Status reinit_apply(Reinit *reinit, double t, const double *values, const char *events, double *y,
                    Diag *diag)
{
    const Equations *eq = reinit->plan.equations;
    int references = variable_index_references(reinit->plan.layout);
    int length = references + eq->multi_turn_count + 1;
    double *stored = NEW_ARRAY(double, reinit->storage_count);
    double *present = NEW_ARRAY(double, reinit->targets.count);
    double *wanted = NEW_ARRAY(double, reinit->targets.count);
    double before;
    Status status;

    memcpy(wanted, values, (size_t)reinit->given * sizeof(double));
    reinit->t = t;
    reinit->values = NEW_ARRAY(double, reinit->targets.count);
    choose_given(reinit, values);
    reinit->y = NEW_ARRAY(double, length);
    memcpy(reinit->y, y, (size_t)length * sizeof(double));
    before = energy(reinit);
    if (reinit->storage_count > 0)
        memcpy(stored, probe_here(reinit), (size_t)reinit->storage_count * sizeof(double));
    memcpy(present, targets_here(reinit), (size_t)reinit->targets.count * sizeof(double));
    status = put_values(reinit, events, wanted, present, stored, diag);
    if (status == OK) {
        double after;

        equations_turn(eq, t, reinit->y, reinit->y + references);
        after = energy(reinit);
        if (isfinite(after - before))
            reinit->y[length - 1] += after - before;
        memcpy(y, reinit->y, (size_t)length * sizeof(double));
    }
    MEM_FREE(stored, present, wanted, reinit->y, reinit->values);
    reinit->y = NULL;
    reinit->values = NULL;
    return status;
}
