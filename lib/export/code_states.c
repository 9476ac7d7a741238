/* code_states.c: states near the initial state, and their values by the session's own equations
 *
 * Reference solutions are computed by the equations of a run (simulate/equations/motion.h), which
 * share no elimination with the exported code. Sums over the entries of each function are computed
 * by a separate program. */
#include "export/code.h"

#include "algebra/kkt.h"
#include "algebra/rank.h"
#include "base/random.h"
#include "simulate/run/phase.h"

#include <math.h>
#include <string.h>

enum { TRIES = 60, MOST_NUMBERS = 6000, WEIGHTS = 7 };
#define TURN      0.4   /* rad: how far angles lie from the start at most */
#define SHARE     0.2   /* how far lengths and states do, of the largest of their kind */
#define SPEED     1.0   /* 1/s times the former: speeds */
#define NEARER    0.8   /* after a state that the equations have no solution at */
#define ONE_RANK  1e-9  /* rows of Phi_u closer than that to others repeat them */
#define MARGIN    2e-3  /* of a loss, over ALLOWED: some ten roundings an entry */
#define ALLOWED   1e-12 /* relative to sizes: tolerance of a check */
#define TOLERANCE 1e-13

typedef struct CodeStates {
    Code *code;
    Parameters parameters;
    Phase *phase;
    Probe *probe; /* of all roots */
    Kkt *kkt;     /* of the rows in use */
    double *start, *y, *off;
    int *rows;
    int row_count;
    uint64_t seed;
} CodeStates;

static double parameter_value(void *context, Expr symbol)
{
    const Code *code = context;

    for (int i = 0; i < code->parameters.count; i++)
        if (code->parameters.at[i] == symbol)
            return code->values[i];
    return NAN;
}

/* A symbol of the whole as a user's variable, which has a value in every mode. */
static Expr by_name(const Code *code, Expr symbol)
{
    return expr_symbol(code->arena, expr_name(symbol), SYMBOL_VARIABLE);
}

/* parameters and y, as the start has them */
static Status read_start(CodeStates *st, const Exported *what, Diag *diag)
{
    Code *code = st->code;
    const VariableIndex *l = code->layout;
    const int first = code->parameters.count, signs = code->live.sides.count;
    const int sizes[] = {l->n, l->nu, l->nx, l->multi_turns};
    const int firsts[] = {l->q, l->u, l->x, l->references};
    Expr *items = NEW_ARRAY(Expr, first + code->ny);
    double *values = pool_alloc(code->texts, (size_t)(first + code->ny + 1) * sizeof(double));
    int at = first;
    Status status = OK;

    for (int i = 0; i < first - signs; i++)
        items[i] = code->parameters.at[i];
    for (int i = first - signs; i < first; i++)
        items[i] = expr_int(code->arena, 1);
    for (int part = 0; part < COUNT(sizes); part++)
        for (int i = 0; i < sizes[part]; i++)
            items[at++] = firsts[part] == l->x && code_has_modes(code)
                              ? by_name(code, l->symbols[l->x + i])
                              : l->symbols[firsts[part] + i];
    for (int k = 0; k < code->modes.ideals.count; k++)
        items[code->modes.first + k] =
            expr_int(code->arena, result_reader_side(what->start, code->modes.ideals.at[k].place));
    /* what drivers do at the start */
    for (int k = 0; code->inverse != NULL && k < MOTIONS * code->inverse->motions.count; k++) {
        const InverseMotion *motion = &code->inverse->motions.at[k % code->inverse->motions.count];
        const int order = k / code->inverse->motions.count;

        for (int i = 0; i < first; i++)
            if (items[i] == motion->symbol[order])
                items[i] = motion->law[order];
    }
    CHECK(result_reader_values_at(what->start, items, at, 0, values, diag));
    code->values = values;
    st->start = values + first;
done:
    mem_free(items);
    return status;
}

static Status open_phase(CodeStates *st, Diag *diag)
{
    Code *code = st->code;
    const VariableIndex *l = code->layout;
    int *order = NEW_ARRAY(int, l->m);
    double *phi_u = NULL;
    const Equations *eq;
    MotionOptions options = {.tolerance = TOLERANCE};
    Status status = OK;

    CHECK(phase_new(l->system, &st->parameters, NULL, 0, &st->phase, diag));
    eq = compiled_equations(st->phase->numbers);
    if (eq->take_references != NULL)
        eq->take_references(eq->context, st->start + variable_index_references(l));
    eq->position(eq->context, 0, st->start);
    phi_u = pattern_spread(eq->rows, eq->phi_u);
    CHECK(rank_rows(phi_u, l->m, l->nu, ONE_RANK, code->view->watch, &st->row_count, order));
    code->is_redundant = st->row_count < l->m;
    st->rows = order;
    order = NULL;
    options.rows = st->rows;
    options.row_count = st->row_count;
    CHECK(phase_open(st->phase, &st->parameters, &options, NULL, diag));
    eq = compiled_equations(st->phase->numbers);
    st->kkt = kkt_new(eq->masses, eq->rows, st->rows, st->row_count);
    CHECK(probe_new(l, &st->parameters, code->roots.at, code->roots.count, &st->probe, diag));
done:
    MEM_FREE(order, phi_u);
    return status;
}

static double largest(const double *values, int count)
{
    double most = 0;

    for (int i = 0; i < count; i++)
        most = fmax(most, fabs(values[i]));
    return most;
}

/* `near`: 1; less for states closer to the initial state */
static void write_at_random(CodeStates *st, double near)
{
    const VariableIndex *l = st->code->layout;
    const double length = largest(st->start, l->n),
                 state = largest(st->start + l->n + l->nu, l->nx);

    memcpy(st->y, st->start, (size_t)st->code->ny * sizeof(double));
    for (int i = 0; i < l->n; i++)
        st->y[i] += near * random_unit(&st->seed) *
                    (system_q(l->system, i)->is_angle ? TURN
                     : st->start[i] != 0              ? SHARE * fabs(st->start[i])
                                                      : SHARE * SHARE * length);
    for (int i = 0; i < l->nu; i++)
        st->y[l->n + i] += random_unit(&st->seed) * SPEED;
    for (int i = 0; i < l->nx; i++)
        st->y[l->n + l->nu + i] += random_unit(&st->seed) * SHARE * (state > 0 ? state : 1);
}

static bool all_finite(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

/* What rounding leaves in the sum of a row's terms, an elimination hands on to u' and lambda. The
 * answer to right sides as large as those sums, of signs at random, shows how much of it. */
static void measure_loss(CodeStates *st, const double *acceleration, const double *multipliers)
{
    Code *code = st->code;
    const Equations *eq = compiled_equations(st->phase->numbers);
    const int nu = eq->nu, m = st->row_count;
    const double *mass = equations_mass(eq);
    double *full_mass, *phi_u, *top, *bottom, *lambda;

    if (!kkt_factor(st->kkt, mass, eq->phi_u, st->rows))
        return;
    full_mass = pattern_spread(eq->masses, mass);
    phi_u = pattern_spread(eq->rows, eq->phi_u);
    top = NEW_ARRAY(double, nu);
    bottom = NEW_ARRAY(double, m);
    lambda = NEW_ARRAY(double, m);
    for (int i = 0; i < nu; i++)
        for (int j = 0; j < nu; j++)
            top[i] += fabs(full_mass[(size_t)i * nu + j] * acceleration[j]);
    for (int k = 0; k < m; k++)
        for (int j = 0; j < nu; j++) {
            const double entry = fabs(phi_u[(size_t)st->rows[k] * nu + j]);

            top[j] += entry * fabs(multipliers[st->rows[k]]);
            bottom[k] += entry * fabs(acceleration[j]);
        }
    for (int i = 0; i < nu; i++)
        top[i] = copysign(top[i], random_unit(&st->seed));
    for (int k = 0; k < m; k++)
        bottom[k] = copysign(bottom[k], random_unit(&st->seed));
    kkt_solve(st->kkt, top, bottom, top, lambda);
    code->loss[0] = fmax(code->loss[0], MARGIN * largest(top, nu));
    code->loss[1] = fmax(code->loss[1], MARGIN * largest(lambda, m));
    MEM_FREE(full_mass, phi_u, top, bottom, lambda);
}

/* Add a state with its solution; false: some of it has no value. `row` has all its values.
 * Functions are evaluated away from it, where they aren't 0. */
static bool take_state(CodeStates *st, double t, RowValues row)
{
    Code *code = st->code;
    const VariableIndex *l = code->layout;
    CodeState state = {.t = t};
    const double *roots;
    double *s = NEW_ARRAY(double, code->ns), *errors, *off = st->off;

    memcpy(s, row.rates, (size_t)l->nx * sizeof(double));
    memcpy(s + l->nx, row.z, (size_t)l->nz * sizeof(double));
    memcpy(s + l->nx + l->nz, row.acceleration, (size_t)l->nu * sizeof(double));
    memcpy(s + l->nx + l->nz + l->nu, row.multipliers, (size_t)l->m * sizeof(double));
    /* functions are evaluated away from the constraint manifold, on which constraints are 0 */
    for (int i = 0; i < code->ny; i++)
        off[i] = code_off(i, st->y[i]);
    row.q = off;
    row.u = off + l->n;
    row.x = off + l->n + l->nu;
    row.references = off + variable_index_references(l);
    roots = probe_values(st->probe, &row);
    if (!all_finite(s, code->ns) || !all_finite(roots, code->roots.count)) {
        mem_free(s);
        return false;
    }
    if (code_has_modes(code))
        code_modes_store(code, roots);
    errors = NEW_ARRAY(double, code->roots.count);
    probe_errors(st->probe, &(RowValues){0}, errors);
    state.s = s;
    state.y = NEW_ARRAY(double, code->ny);
    memcpy(state.y, st->y, (size_t)code->ny * sizeof(double));
    state.sums = NEW_ARRAY(double, code->functions.count);
    state.size = NEW_ARRAY(double, code->functions.count);
    for (int f = 0; f < code->functions.count; f++) {
        const CodeFunction *function = &code->functions.at[f];
        double lost = 0; /* here and there: terms of an entry may cancel */

        for (int i = 0; i < function->rows * function->columns; i++) {
            const double term = (1 + i % WEIGHTS) * roots[function->first + i];

            state.sums[f] += term;
            state.size[f] += fabs(term);
            lost += 2 * (1 + i % WEIGHTS) * errors[function->first + i];
        }
        if (isfinite(lost))
            state.size[f] = fmax(state.size[f], lost / ALLOWED);
    }
    mem_free(errors);
    LIST_PUSH(code->states, state);
    return true;
}

/* the state that y is, unless equations have no solution there */
static bool add_state(CodeStates *st, double t)
{
    const VariableIndex *l = st->code->layout;
    const double *s;
    Solved solved;

    if (!motion_project(st->phase->motion, t, st->y))
        return false;
    if (l->multi_turns > 0)
        equations_turn(compiled_equations(st->phase->numbers), t, st->y,
                       st->y + variable_index_references(l));
    if (!motion_solve(st->phase->motion, t, st->y, &solved) ||
        !take_state(st, t, row_of_solved(l, t, st->y, &solved)))
        return false;
    s = st->code->states.at[st->code->states.count - 1].s;
    measure_loss(st, s + l->nx + l->nz, s + l->nx + l->nz + l->nu);
    return true;
}

/* The initial state, from the session's different equations in its mode; entries of s without a
 * name there are 0. */
static Status add_start_in_mode(CodeStates *st, const Exported *what, Diag *diag)
{
    Code *code = st->code;
    const VariableIndex *l = code->layout;
    double *s = NEW_ARRAY(double, code->ns + 1);
    Status status = OK;

    for (int i = 0; i < code->ns; i++) {
        const Expr item = by_name(code, l->symbols[l->rates + i]);

        CHECK(monitor_poll(code->view->watch));
        CHECK(result_reader_values_at(what->start, &item, 1, 0, &s[i], diag));
    }
    CHECK(probe_new(l, &st->parameters, code->roots.at, code->roots.count, &st->probe, diag));
    (void)take_state(st, 0,
                     (RowValues){.rates = s,
                                 .z = s + l->nx,
                                 .acceleration = s + l->nx + l->nz,
                                 .multipliers = s + l->nx + l->nz + l->nu});
done:
    mem_free(s);
    return status;
}

void code_sizes(const Code *code, double sizes[CODE_PARTS])
{
    const VariableIndex *l = code->layout;
    const int counts[CODE_PARTS] = {l->nx, l->nz, l->nu, l->m};

    for (int part = 0, at = 0; part < CODE_PARTS; at += counts[part++]) {
        sizes[part] = 0;
        for (int k = 0; k < code->states.count; k++)
            sizes[part] = fmax(sizes[part], largest(code->states.at[k].s + at, counts[part]));
    }
    for (int k = 0; k < COUNT(code->loss); k++)
        sizes[CODE_PARTS - COUNT(code->loss) + k] =
            fmax(sizes[CODE_PARTS - COUNT(code->loss) + k], code->loss[k]);
}

Status code_add_states(Code *code, const Exported *what, int most, Diag *diag)
{
    CodeStates st = {.code = code, .seed = 1};
    const int numbers = code->ny + code->ns + 2 * code->functions.count + 1;
    const int room = 1 + MOST_NUMBERS / numbers;
    double near = 1;
    Status status = OK;

    most = most < room ? most : room;
    st.parameters = (Parameters){.value = parameter_value, .context = code};
    CHECK(read_start(&st, what, diag));
    if (code->live.is_wanted) /* it finds the rest itself */
        goto done;
    for (int i = 0; i < code->parameters.count; i++)
        parameters_set(&st.parameters, code->parameters.at[i], code->values[i]);
    if (code->inverse != NULL)
        parameters_set(&st.parameters, code->inverse->now, 0);
    st.y = NEW_ARRAY(double, code->ny + 1); /* and work */
    st.off = NEW_ARRAY(double, code->ny);
    memcpy(st.y, st.start, (size_t)code->ny * sizeof(double));
    if (code_has_modes(code)) {
        status = add_start_in_mode(&st, what, diag);
        goto done;
    }
    CHECK(open_phase(&st, diag));
    (void)add_state(&st, 0);
    for (int i = 0; i < TRIES && code->states.count < most; i++) {
        CHECK(monitor_poll(code->view->watch));
        write_at_random(&st, near);
        /* drivers are known at one instant only */
        if (!add_state(&st, code->inverse != NULL ? 0 : near * fabs(random_unit(&st.seed))))
            near *= NEARER;
    }
done:
    kkt_free(st.kkt);
    probe_free(st.probe);
    phase_free(st.phase);
    parameters_free(&st.parameters);
    MEM_FREE(st.y, st.off, st.rows);
    return status;
}
