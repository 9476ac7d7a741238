/* equilibrium.c: where everything rests
 *
 *     F(q, 0, x, z) - Phi_u^T lambda = 0,   Phi(q) = 0,   A [0; z] = r(q, 0, x)
 *
 * for v = (q, x, lambda, z), with sources and drivers as they are at t = 0, from the assembled
 * start. A network alone is searched sparse (operating.c). Damped Newton first; then gravity,
 * forces and sources grow from nothing in steps; then everything creeps, masses and storage
 * elements its resistance, until it rests.
 *
 * The equations are those of a system of its own, in whose components t is 0 and the loads
 * are multiplied by a parameter, so that derivatives of sources vanish too. */
#include "simulate/result.h"

#include "base/memory.h"
#include "simulate/linear.h"
#include "simulate/operating.h"
#include "simulate/rows.h"

#include <math.h>
#include <string.h>

#define NEWTON_STEPS 60
#define CREEP_STEPS  500
#define LONGEST      1.0  /* rad or m in a step of Newton's */
#define CREEP        0.3  /* the same, of creeping */
#define ENOUGH       1e-9 /* residual over the terms of its row */
#define LEAST_SHARE  1e-3 /* of the loads, in a step */
#define MOST_FULL    300  /* unknowns of a network for full matrices */

typedef struct Statics {
    System *system;
    Layout *l;
    Result *start; /* on the system of the user */
    const Watch *watch;
    Parameters parameters;
    Expr load_symbol, leak_symbol;
    Knobs knobs;         /* of gravity, forces and sources; of parts of a network */
    Gradients gradients; /* balance, Phi and network rows by q, x, lambda, z */
    Probe *resistance;   /* N, M, A */
    int rows, columns;   /* nu + m + nx + nz; as many */
    int length;          /* of v */
    double *v, *trial;
    double *residual, *jacobian, *step; /* by columns: steps of s, x, lambda, z */
    double *size, *weight;              /* of rows: of their terms; for measuring */
    int rank;
    int singular; /* of a network: an unknown that nothing determines at rest; -1 */
} Statics;

/* --- the system at rest --- */

typedef struct Vary {
    Arena *arena;
    Expr time, zero, load;
} Vary;

static bool is_load(const Instance *instance, int param)
{
    static const char *const names[] = {"value", "force", "torque"};

    for (int i = 0; i < COUNT(names) && instance->row->family != FAMILY_DRIVER; i++)
        if (strcmp(instance->row->params[param].name, names[i]) == 0)
            return true;
    return false;
}

static Expr vary(void *context, const Instance *instance, int param, Expr value)
{
    const Vary *v = context;
    Expr still = expr_substitute(v->arena, value, &v->time, &v->zero, 1);

    return instance == NULL || is_load(instance, param) ? expr_mul(v->arena, v->load, still)
                                                        : still;
}

static double parameter(void *context, Expr symbol)
{
    Statics *s = context;

    return symbol == s->load_symbol   ? s->knobs.load
           : symbol == s->leak_symbol ? s->knobs.leak
                                      : parameters_value(&s->start->parameters, symbol);
}

static Status compile(Statics *s, Diag *diag)
{
    const Layout *l = s->l;
    const Reading *run = system_run(l->system);
    LIST(Expr) rows = {0}, resistance = {0};
    Status status = OK;

    gradients_free(&s->gradients);
    probe_free(s->resistance);
    s->resistance = NULL;
    parameters_free(&s->parameters);
    s->parameters = (Parameters){.value = parameter, .context = s};
    for (int j = 0; j < l->nu; j++)
        LIST_PUSH(rows, row_balance(l, j));
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(rows, run->phi[k]);
    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(rows, row_network(l, i));
    {
        int count = l->n + l->nx + l->m + l->nz, k = 0;
        Expr *symbols = NEW_ARRAY(Expr, count);
        const int parts[][2] = {{l->q, l->n}, {l->x, l->nx}, {l->multipliers, l->m}, {l->z, l->nz}};

        for (int p = 0; p < COUNT(parts); p++)
            for (int i = 0; i < parts[p][1]; i++)
                symbols[k++] = l->symbols[parts[p][0] + i];
        status = gradients_open(l, &s->parameters, rows.at, rows.count, symbols, count,
                                &s->gradients, diag);
        mem_free(symbols);
    }
    CHECK(status);
    for (int i = 0; i < l->n; i++)
        for (int j = 0; j < l->nu; j++)
            LIST_PUSH(resistance, system_n_entry(l->system, i, j));
    for (int i = 0; i < l->nu * l->nu; i++)
        LIST_PUSH(resistance, run->mass[i]);
    for (int i = 0; i < run->network_entries; i++)
        LIST_PUSH(resistance, run->network[i].value);
    CHECK(probe_new(l, &s->parameters, resistance.at, resistance.count, &s->resistance, diag));
done:
    LIST_FREE(rows);
    LIST_FREE(resistance);
    return status;
}

static Status statics_open(Statics *s, const Model *model, Result *start, const Watch *watch,
                           Diag *diag)
{
    Arena *arena = model_arena(model);
    Vary of = {.arena = arena,
               .time = expr_symbol(arena, "t", SYMBOL_TIME),
               .zero = expr_int(arena, 0),
               .load = expr_symbol(arena, "#load", SYMBOL_PARAMETER)};
    Expr leak = expr_symbol(arena, "#leak", SYMBOL_PARAMETER);
    const Layout *theirs = start->layout;
    Status status = OK;

    *s = (Statics){.start = start,
                   .watch = watch,
                   .load_symbol = of.load,
                   .leak_symbol = leak,
                   .knobs = {.load = 1}};
    CHECK(system_new_leaking(model, vary, &of, leak, watch, &s->system, diag));
    s->l = layout_new(s->system);
    s->rows = s->columns = s->l->nu + s->l->m + s->l->nx + s->l->nz;
    s->length = s->l->n + s->l->m + s->l->nx + s->l->nz;
    s->v = NEW_ARRAY(double, s->length);
    if (s->l->n != theirs->n || s->l->nx != theirs->nx || s->l->m != theirs->m)
        CHECK(diag_set(diag, E_MODEL, "at rest this model has other unknowns than in motion"));
    memcpy(s->v, start->start.y, (size_t)theirs->n * sizeof(double));
    memcpy(s->v + theirs->n, start->start.y + theirs->n + theirs->nu,
           (size_t)theirs->nx * sizeof(double));
done:
    return status;
}

/* full matrices, for what only they can do */
static Status open_full(Statics *s, Diag *diag)
{
    s->trial = NEW_ARRAY(double, s->length);
    s->residual = NEW_ARRAY(double, s->rows);
    s->jacobian = NEW_ARRAY(double, (ptrdiff_t)s->rows * s->columns);
    s->step = NEW_ARRAY(double, s->columns);
    s->size = NEW_ARRAY(double, s->rows);
    s->weight = NEW_ARRAY(double, s->rows);
    return compile(s, diag);
}

static void statics_close(Statics *s)
{
    gradients_free(&s->gradients);
    probe_free(s->resistance);
    parameters_free(&s->parameters);
    layout_free(s->l);
    system_free(s->system);
    mem_free(s->v);
    mem_free(s->trial);
    mem_free(s->residual);
    mem_free(s->jacobian);
    mem_free(s->step);
    mem_free(s->size);
    mem_free(s->weight);
}

/* --- numbers --- */

static RowValues row_of(const Statics *s, const double *v)
{
    const Layout *l = s->l;

    return (RowValues){
        .q = v, .x = v + l->n, .multipliers = v + l->n + l->nx, .z = v + l->n + l->nx + l->m};
}

/* gradients by q become those by turns and shifts: what stands behind q moves up */
static void reduce_columns(const Statics *s, const double *gradient, const double *map, double *out)
{
    const Layout *l = s->l;

    for (int j = 0; j < l->nu; j++) {
        out[j] = 0;
        for (int i = 0; i < l->n; i++)
            out[j] += gradient[i] * map[i * l->nu + j];
    }
    for (int k = l->nu; k < s->columns; k++)
        out[k] = gradient[k - l->nu + l->n];
}

/* residual, jacobian, and the size of each row's terms */
static void evaluate(Statics *s, const double *v, bool with_jacobian)
{
    RowValues row = row_of(s, v);
    const double *values = gradients_at(&s->gradients, &row);
    const double *map;

    memcpy(s->residual, values, (size_t)s->rows * sizeof(double));
    if (!with_jacobian)
        return;
    map = probe_values(s->resistance, &row);
    for (int i = 0; i < s->rows; i++) {
        double *out = s->jacobian + (ptrdiff_t)i * s->columns;

        reduce_columns(s, values + s->rows + (ptrdiff_t)i * s->gradients.columns, map, out);
        s->size[i] = 0;
        for (int k = 0; k < s->columns; k++) {
            double place = k < s->l->nu ? 1 : v[k - s->l->nu + s->l->n];

            s->size[i] += fabs(out[k]) * fmax(fabs(place), k < s->l->nu + s->l->nx ? 1 : 0);
        }
        s->size[i] = fmax(s->size[i], 1e-12);
    }
}

static double measure(const Statics *s)
{
    double sum = 0;

    for (int i = 0; i < s->rows; i++)
        sum += (s->residual[i] / s->weight[i]) * (s->residual[i] / s->weight[i]);
    return sqrt(sum);
}

static bool is_met(const Statics *s)
{
    for (int i = 0; i < s->rows; i++)
        if (!(fabs(s->residual[i]) <= ENOUGH * s->size[i]))
            return false;
    return true;
}

static void normalise(const Statics *s, double *q)
{
    for (int i = 0; system_quaternion(s->system, i) >= 0; i++) {
        double *p = q + system_quaternion(s->system, i);
        double norm = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);

        for (int j = 0; j < 4 && norm > 0; j++)
            p[j] /= norm;
    }
}

/* trial = v moved by a share of the step; N is that of the last evaluation with a jacobian */
static void move(Statics *s, double share)
{
    const Layout *l = s->l;
    RowValues row = row_of(s, s->v);
    const double *map = probe_values(s->resistance, &row);

    for (int i = 0; i < l->n; i++) {
        s->trial[i] = s->v[i];
        for (int j = 0; j < l->nu; j++)
            s->trial[i] += share * map[i * l->nu + j] * s->step[j];
    }
    for (int k = l->n; k < s->length; k++)
        s->trial[k] = s->v[k] + share * s->step[k - l->n + l->nu];
    normalise(s, s->trial);
}

static void accept(Statics *s)
{
    memcpy(s->v, s->trial, (size_t)s->length * sizeof(double));
}

/* the share of a step that moves no part further than `longest` */
static double share_of(const Statics *s, double longest)
{
    double furthest = vector_largest(s->step, s->l->nu);

    return furthest > longest ? longest / furthest : 1;
}

static bool find_step(Statics *s)
{
    for (int i = 0; i < s->rows; i++)
        s->residual[i] = -s->residual[i];
    s->rank = rows_solve(s->jacobian, s->rows, s->columns, s->residual, s->step);
    for (int i = 0; i < s->rows; i++)
        s->residual[i] = -s->residual[i];
    return s->rank >= 0;
}

/* --- three ways --- */

/* Damped Newton; the residual that is left stays in s->residual. */
static bool newton(Statics *s)
{
    for (int i = 0; i < NEWTON_STEPS; i++) {
        double before, share;
        bool better = false;

        evaluate(s, s->v, true);
        memcpy(s->weight, s->size, (size_t)s->rows * sizeof(double));
        before = measure(s);
        if (!isfinite(before) || !find_step(s))
            return false;
        if (before == 0)
            return true;
        share = share_of(s, LONGEST);
        for (; share > 1e-4 && !better; share = better ? share : share / 2) {
            move(s, share);
            evaluate(s, s->trial, false);
            better = measure(s) < before;
        }
        if (!better) { /* rounding, or a minimum that is no solution */
            evaluate(s, s->v, true);
            return is_met(s);
        }
        accept(s);
    }
    evaluate(s, s->v, true);
    return is_met(s);
}

/* Loads grow from nothing, in steps as long as Newton follows. */
static Status grow(Statics *s, bool *found, Diag *diag)
{
    double *kept = NEW_ARRAY(double, s->length);
    double reached = 0, share = 0.25;
    Status status = OK;

    *found = false;
    s->knobs.load = 0;
    CHECK(compile(s, diag));
    if (!newton(s))
        goto done;
    while (reached < 1 && share > LEAST_SHARE) {
        CHECK(poll(s->watch));
        report(s->watch, "equilibrium: loads", reached);
        memcpy(kept, s->v, (size_t)s->length * sizeof(double));
        s->knobs.load = fmin(1, reached + share);
        CHECK(compile(s, diag));
        if (newton(s)) {
            reached = s->knobs.load;
            share *= 2;
        } else {
            memcpy(s->v, kept, (size_t)s->length * sizeof(double));
            share /= 4;
        }
    }
    *found = reached >= 1;
done:
    mem_free(kept);
    s->knobs.load = 1;
    return status;
}

/* (resistance * M) s' = forces, (resistance * A) x' = r - A z, a step backward Euler */
static void resist(Statics *s, double resistance)
{
    const Layout *l = s->l;
    RowValues row = row_of(s, s->v);
    const double *mass = probe_values(s->resistance, &row) + l->n * l->nu;
    const double *network = mass + l->nu * l->nu;
    const Reading *run = system_run(s->system);

    for (int i = 0; i < l->nu; i++)
        for (int j = 0; j < l->nu; j++)
            s->jacobian[i * s->columns + j] += resistance * mass[i * l->nu + j];
    for (int i = 0; i < run->network_entries; i++) {
        const Entry *at = &run->network[i];

        if (at->column < l->nx)
            s->jacobian[(l->nu + l->m + at->row) * s->columns + l->nu + at->column] +=
                resistance * network[i];
    }
}

static Status creep(Statics *s, bool *found, Diag *diag)
{
    double resistance = 1e4;
    Status status = OK;

    *found = false;
    CHECK(compile(s, diag));
    for (int i = 0; i < CREEP_STEPS && resistance > 1e-10; i++) {
        CHECK(poll(s->watch));
        report(s->watch, "equilibrium: creeping", -1);
        evaluate(s, s->v, true);
        resist(s, resistance);
        if (!find_step(s) || share_of(s, CREEP) < 1) {
            resistance *= 4;
            if (resistance > 1e12)
                break;
            continue;
        }
        move(s, 1);
        accept(s);
        resistance *= 0.5;
    }
    *found = newton(s);
done:
    return status;
}

/* --- messages --- */

static void name_row(const Statics *s, int i, Text *text)
{
    const Layout *l = s->l;

    if (i < l->nu) {
        int q = speed_coordinate(s->system, i);

        text_addf(text, "the forces on %s by %.3g",
                  q >= 0 ? system_q(s->system, q)->name : system_u(s->system, i)->name,
                  fabs(s->residual[i]));
    } else if (i < l->nu + l->m) {
        const ConstraintRow *row = system_constraint(s->system, i - l->nu);

        text_addf(text, "%s (%s) by %.3g", system_instance_name(s->system, row->instance),
                  row->direction, fabs(s->residual[i]));
    } else {
        int k = i - l->nu - l->m;

        text_addf(text, "the equation of %s by %.3g",
                  k < l->nx ? system_x(s->system, k)->name : system_z(s->system, k - l->nx)->name,
                  fabs(s->residual[i]));
    }
}

static Status tell_failure(Statics *s, Diag *diag)
{
    Text text = {0};
    int shown = 0;

    evaluate(s, s->v, true);
    for (int i = 0; i < s->rows && shown < 6; i++)
        if (!(fabs(s->residual[i]) <= ENOUGH * s->size[i])) {
            text_add(&text, shown++ > 0 ? ", " : "");
            name_row(s, i, &text);
        }
    (void)diag_set(diag, E_SOLVER, "no equilibrium was found; missed: %s",
                   text.at != NULL ? text.at : "nothing, but it is undefined there");
    diag_hint(diag, "there is none where something keeps moving; else 'init' and 'guess' choose "
                    "where the search starts");
    text_free(&text);
    return E_SOLVER;
}

static bool is_network(const Statics *s)
{
    return s->l->n == 0 && s->l->nu == 0 && s->l->m == 0;
}

static const char *network_unknown(const Statics *s, int i)
{
    return i < s->l->nx ? system_x(s->system, i)->name : system_z(s->system, i - s->l->nx)->name;
}

static void remark_freedom(const Statics *s, Result *r)
{
    int left = s->columns - s->rank - (s->l->m - r->start.row_count);

    if (left > 0 && s->singular >= 0) {
        text_addf(&r->remarks,
                  "at rest nothing determines %s: it stays as near to its start as "
                  "may be\n",
                  network_unknown(s, s->singular));
        return;
    }
    if (left > 0)
        text_addf(&r->remarks,
                  "the equilibrium is one of many: %d direction%s in which nothing pushes back\n",
                  left, left == 1 ? "" : "s");
}

/* --- the result --- */

/* A network alone: sparse. What is left of it, where it isn't too large, is for full matrices. */
static Status rest_network(Statics *s, bool *found, Diag *diag)
{
    Operating o = {.l = s->l, .parameters = &s->parameters, .knobs = &s->knobs, .watch = s->watch};
    Status status = OK;

    *found = false;
    s->singular = -1;
    if (!is_network(s))
        return OK;
    s->parameters = (Parameters){.value = parameter, .context = s};
    o.v = s->v;
    CHECK(operating_find(&o, found, diag));
    s->rank = s->columns;
    s->singular = o.singular;
    if (*found || s->columns <= MOST_FULL)
        goto done;
    if (s->singular >= 0) {
        (void)diag_set(diag, E_SINGULAR, "at rest nothing determines %s",
                       network_unknown(s, s->singular));
        diag_hint(diag, "lead a resistor, as large as you like, past the capacitors there, or put "
                        "one into the circuit of inductors");
    } else {
        (void)diag_set(diag, E_SOLVER, "no operating point was found");
        diag_hint(diag, "'init' of capacitors and inductors chooses where the search starts");
    }
    status = s->singular >= 0 ? E_SINGULAR : E_SOLVER;
done:
    return status;
}

static Status solve(Statics *s, Diag *diag)
{
    double *begun = NEW_ARRAY(double, s->length);
    bool found;
    Status status = OK;

    memcpy(begun, s->v, (size_t)s->length * sizeof(double));
    CHECK(rest_network(s, &found, diag));
    if (found)
        goto done;
    CHECK(open_full(s, diag));
    found = newton(s);
    if (!found && !is_network(s)) {
        memcpy(s->v, begun, (size_t)s->length * sizeof(double));
        CHECK(grow(s, &found, diag));
    }
    if (!found) {
        memcpy(s->v, begun, (size_t)s->length * sizeof(double));
        CHECK(creep(s, &found, diag));
    }
    if (!found)
        CHECK(tell_failure(s, diag));
done:
    if (status == E_STOPPED)
        (void)diag_set(diag, E_STOPPED, "stopped while looking for an equilibrium");
    mem_free(begun);
    return status;
}

/* what was found is where a search for z begins */
static void guess_network(const Statics *s, Result *r)
{
    const Layout *l = r->layout;

    if (s->l->nz != l->nz)
        return;
    memset(r->start.network, 0, (size_t)l->nx * sizeof(double));
    memcpy(r->start.network + l->nx, s->v + s->l->n + s->l->nx + s->l->m,
           (size_t)l->nz * sizeof(double));
    motion_guess(r->motion, r->start.network);
}

Status run_equilibrium(System *system, const Model *model, const Setting *setting, Result **out,
                       Diag *diag)
{
    Result *r = NULL;
    Statics s = {0};
    const Layout *l;
    double position = 0, velocity = 0;
    Status status = OK;

    CHECK(result_open(RUN_START, system, setting, &r, diag));
    CHECK(result_refuse_by(r, diag));
    CHECK(statics_open(&s, model, r, setting->watch, diag));
    CHECK(solve(&s, diag));
    l = r->layout;
    memset(r->start.y, 0, (size_t)r->grid.length * sizeof(double));
    for (int i = 0; i < l->n; i++) /* less than rounding of 1 rad or 1 m is nothing */
        r->start.y[i] = fabs(s.v[i]) < 1e-15 ? 0 : s.v[i];
    memcpy(r->start.y + l->n + l->nu, s.v + l->n, (size_t)l->nx * sizeof(double));
    guess_network(&s, r);
    if (!motion_project(r->motion, 0, r->start.y))
        CHECK(diag_set(diag, E_SINGULAR, "the equilibrium is a singular position"));
    remark_freedom(&s, r);
    if (vector_largest(r->start.y + l->n, l->nu) > 0)
        text_add(&r->remarks, "drivers move at t = 0: runs start from here with their speeds\n");
    grid_add(&r->grid, 0, r->start.y);
    motion_residuals(r->motion, 0, r->start.y, &position, &velocity);
    r->report.position_residual = position;
    r->report.velocity_residual = velocity;
    *out = r;
    r = NULL;
done:
    statics_close(&s);
    result_free(r);
    return status;
}
