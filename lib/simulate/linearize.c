/* linearize.c: derivatives of the equations along the constraints
 *
 * With w = (q, u, x) and what follows from it, e = (u', lambda, x', z), all equations are
 * E(w, e, inputs) = 0, and a deviation of w gives E_e de = -E_w dw. A deviation of one state moves
 * the dependent coordinates and speeds along: Phi_u ds = 0, (Phi_u u - nu)_q dq + Phi_u du = 0, dq
 * = N ds. */
#include "simulate/linearize.h"

#include "base/memory.h"
#include "simulate/embed.h"
#include "simulate/linear.h"
#include "simulate/result.h"
#include "simulate/rows.h"

#include <math.h>
#include <string.h>

/* places of the symbols by which everything is differentiated */
typedef struct Columns {
    int q, u, x, acceleration, multipliers, rates, z, inputs, count;
    Expr *symbols;
} Columns;

/* and of the rows that are */
typedef struct RowPlaces {
    int balance, acceleration, network, velocity, phi, q_rate, outputs, count;
} RowPlaces;

typedef struct Work {
    const LinearOrder *order;
    Phase *phase;   /* of the result, at the point */
    System *varied; /* NULL: the result's own will do */
    System *system;
    Layout *l;
    Parameters parameters;
    Expr *inputs; /* symbols, then of their rates */
    Columns at;
    RowPlaces rows;
    Gradients gradients;
    Probe *geometry; /* Phi_u, N, N' */
    double *y;
    double *follow; /* u', lambda, x', z */
    double *values; /* of rows, then gradients, at the point */
    double *phi_u, *map, *map_rate;
    double *matrix; /* E_e over the rows in use */
    Embed *embed;
    int used, freedoms, unknowns; /* unknowns: nu + used + nx + nz */
} Work;

/* --- the equations, with symbols for inputs --- */

typedef struct Vary {
    const LinearOrder *order;
    const Expr *symbols;
    Arena *arena;
    Expr since; /* time from the point on */
} Vary;

/* the value that an input adds to: of a source, of an actuator */
static bool is_input(const Instance *instance, int param)
{
    static const char *const names[] = {"value", "force", "torque", "pressure", "flow"};
    const Param *row = &instance->row->params[param];

    for (int i = 0; i < COUNT(names); i++)
        if (strcmp(row->name, names[i]) == 0 && instance->values[param].count == 1)
            return row->positional || instance->values[param].given;
    return false;
}

static Expr vary(void *context, const Instance *instance, int param, Expr value)
{
    const Vary *v = context;

    for (int i = 0; instance != NULL && i < v->order->input_count; i++) {
        const char *source = v->order->inputs[i].source;

        if (source != NULL && strcmp(source, instance->name) == 0 && is_input(instance, param))
            value = expr_sum(
                v->arena,
                (Expr[]){value, v->symbols[i],
                         expr_mul(v->arena, v->symbols[v->order->input_count + i], v->since)},
                3);
    }
    return value;
}

static double parameter(void *context, Expr symbol)
{
    const Work *w = context;

    for (int i = 0; i < 2 * w->order->input_count; i++)
        if (w->inputs[i] == symbol && w->order->inputs[i % w->order->input_count].source != NULL)
            return 0;
    return parameters_value(&w->order->about->parameters, symbol);
}

static Status check_input(const LinearOrder *order, int i, Diag *diag)
{
    const char *name = order->inputs[i].source;
    const Instance *instance = name != NULL ? model_find(order->model, name) : NULL;

    if (name == NULL)
        return OK;
    for (int k = 0; instance != NULL && instance->row->family != FAMILY_DRIVER &&
                    k < instance->row->param_count;
         k++)
        if (is_input(instance, k))
            return OK;
    (void)diag_set(diag, E_NAME, "%s has no value that an input could be", name);
    diag_hint(diag, "inputs are sources, actuators, and parameters: F = 0 N; force "
                    "F1 m1 [F, 0]; linearize inputs=[F]");
    return E_NAME;
}

static Status find_point(Work *w, Diag *diag)
{
    const Result *about = w->order->about;
    int rows = about->grid.count;

    if (result_between(w->order->about, w->order->at, &w->phase, &w->y))
        return OK;
    return diag_set(diag, E_VALUE, "t = %.6g s is outside the run, which goes from %.6g to %.6g s",
                    w->order->at, rows > 0 ? about->grid.times[0] : 0,
                    rows > 0 ? about->grid.times[rows - 1] : 0);
}

static Status open_system(Work *w, Diag *diag)
{
    const LinearOrder *order = w->order;
    Arena *arena = system_arena(order->about->system);
    Vary of = {order, NULL, arena,
               expr_sub(arena, expr_symbol(arena, "t", SYMBOL_TIME), expr_real(arena, order->at))};
    bool needed = false;
    Status status = OK;

    w->inputs = NEW_ARRAY(Expr, 2 * order->input_count);
    of.symbols = w->inputs;
    for (int i = 0; i < order->input_count; i++) {
        Text name = {0};

        CHECK(check_input(order, i, diag));
        text_addf(&name, order->inputs[i].source != NULL ? "#%s" : "%s", order->inputs[i].name);
        w->inputs[i] = expr_symbol(arena, name.at, SYMBOL_PARAMETER);
        text_addf(&name, "#rate");
        w->inputs[order->input_count + i] = expr_symbol(arena, name.at, SYMBOL_PARAMETER);
        text_free(&name);
        needed = needed || order->inputs[i].source != NULL;
    }
    CHECK(find_point(w, diag));
    w->system = w->phase->system;
    if (needed && system_revision(w->system) != model_revision(order->model)) {
        (void)diag_set(diag, E_MODEL,
                       "the model has changed since the run, so its sources are no "
                       "inputs there");
        diag_hint(diag, "run it again, or linearize about the start");
        CHECK(E_MODEL);
    }
    if (needed) {
        CHECK(system_new_like(w->system, order->model, vary, &of, order->watch, &w->varied, diag));
        w->system = w->varied;
    }
    w->l = layout_new(w->system);
    if (w->phase->closed != NULL)
        layout_take_sides(w->l, w->phase->closed);
    w->parameters = (Parameters){.value = parameter, .context = w};
done:
    return status;
}

/* --- programs --- */

static void place_columns(Work *w)
{
    const Layout *l = w->l;
    Columns *at = &w->at;
    const struct {
        int *place;
        const Expr *symbols;
        int count;
    } parts[] = {{&at->q, l->symbols + l->q, l->n},
                 {&at->u, l->symbols + l->u, l->nu},
                 {&at->x, l->symbols + l->x, l->nx},
                 {&at->acceleration, l->symbols + l->acceleration, l->nu},
                 {&at->multipliers, l->symbols + l->multipliers, l->m},
                 {&at->rates, l->symbols + l->rates, l->nx},
                 {&at->z, l->symbols + l->z, l->nz},
                 {&at->inputs, w->inputs, 2 * w->order->input_count}};

    at->symbols = NEW_ARRAY(Expr, l->count + 2 * w->order->input_count);
    for (int p = 0; p < COUNT(parts); p++) {
        *parts[p].place = at->count;
        for (int i = 0; i < parts[p].count; i++)
            at->symbols[at->count++] = parts[p].symbols[i];
    }
}

typedef LIST(Expr) Roots;

static Status push_rows(Work *w, Roots *roots, Diag *diag)
{
    const Layout *l = w->l;
    const Reading *run = system_run(l->system);
    Status status = OK;

    w->rows.balance = roots->count;
    for (int j = 0; j < l->nu; j++)
        LIST_PUSH(*roots, row_balance(l, j));
    w->rows.acceleration = roots->count;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, row_acceleration(l, k));
    w->rows.network = roots->count;
    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(*roots, row_network(l, i));
    w->rows.velocity = roots->count;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, row_velocity(l, k));
    w->rows.phi = roots->count;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, run->phi[k]);
    w->rows.q_rate = roots->count;
    for (int i = 0; i < l->n; i++)
        LIST_PUSH(*roots, run->q_rate[i]);
    w->rows.outputs = roots->count;
    for (int i = 0; i < w->order->output_count; i++) {
        Expr e;

        CHECK(system_resolve(l->system, w->order->outputs[i], &e, diag));
        LIST_PUSH(*roots, e);
    }
    w->rows.count = roots->count;
done:
    return status;
}

static Status compile(Work *w, Diag *diag)
{
    const Layout *l = w->l;
    const Reading *run = system_run(l->system);
    Roots rows = {0}, geometry = {0};
    Status status = OK;

    place_columns(w);
    CHECK(push_rows(w, &rows, diag));
    CHECK(gradients_open(l, &w->parameters, rows.at, rows.count, w->at.symbols, w->at.count,
                         &w->gradients, diag));
    for (int i = 0; i < l->m * l->nu; i++)
        LIST_PUSH(geometry, run->phi_u[i]);
    for (int i = 0; i < l->n; i++)
        for (int j = 0; j < l->nu; j++)
            LIST_PUSH(geometry, system_n_entry(l->system, i, j));
    for (int i = 0; i < l->n; i++)
        for (int j = 0; j < l->nu; j++)
            LIST_PUSH(geometry,
                      expr_diff_along(system_arena(l->system), system_n_entry(l->system, i, j),
                                      l->symbols + l->q, run->q_rate, l->n));
    CHECK(probe_new(l, &w->parameters, geometry.at, geometry.count, &w->geometry, diag));
done:
    LIST_FREE(rows);
    LIST_FREE(geometry);
    return status;
}

/* --- the point --- */

static double gradient(const Work *w, int row, int column)
{
    return w->values[w->rows.count + row * w->at.count + column];
}

/* the r-th of the equations in use: balance, acceleration, network */
static int equation(const Work *w, int r)
{
    const Layout *l = w->l;

    if (r < l->nu)
        return w->rows.balance + r;
    if (r < l->nu + w->used)
        return w->rows.acceleration + w->order->about->start.rows[r - l->nu];
    return w->rows.network + r - l->nu - w->used;
}

/* the column of the k-th of what follows: u', lambda in use, x', z */
static int unknown(const Work *w, int k)
{
    const Layout *l = w->l;

    if (k < l->nu)
        return w->at.acceleration + k;
    if (k < l->nu + w->used)
        return w->at.multipliers + w->order->about->start.rows[k - l->nu];
    k -= l->nu + w->used;
    return k < l->nx ? w->at.rates + k : w->at.z + k - l->nx;
}

static void evaluate(Work *w)
{
    const Layout *l = w->l;
    RowValues row = row_of_state(l, w->order->at, w->y);
    const double *values;

    row.acceleration = w->follow;
    row.multipliers = w->follow + l->nu;
    row.rates = w->follow + l->nu + l->m;
    row.z = w->follow + l->nu + l->m + l->nx;
    values = gradients_at(&w->gradients, &row);

    memcpy(w->values, values, (size_t)(w->rows.count * (1 + w->at.count)) * sizeof(double));
    for (int r = 0; r < w->unknowns; r++)
        for (int k = 0; k < w->unknowns; k++)
            w->matrix[r * w->unknowns + k] = gradient(w, equation(w, r), unknown(w, k));
}

/* deviations of what follows: E_e out = right; false when the equations are dependent */
static bool solve(const Work *w, const double *right, double *out)
{
    return rows_solve(w->matrix, w->unknowns, w->unknowns, right, out) == w->unknowns;
}

/* u', lambda, x', z at the point, by Newton; linear equations but for F in x' and z */
static bool find_rates(Work *w)
{
    double *right = NEW_ARRAY(double, w->unknowns), *step = NEW_ARRAY(double, w->unknowns);
    bool sound = true;

    for (int i = 0; i < 6 && sound; i++) {
        evaluate(w);
        for (int r = 0; r < w->unknowns; r++)
            right[r] = -w->values[equation(w, r)];
        sound = solve(w, right, step);
        for (int k = 0; k < w->unknowns && sound; k++)
            w->follow[unknown(w, k) - w->at.acceleration] += step[k];
    }
    if (sound)
        evaluate(w);
    mem_free(right);
    mem_free(step);
    return sound;
}

static Status fix_point(Work *w, Diag *diag)
{
    const LinearOrder *order = w->order;
    const Layout *l = w->l, *theirs = w->phase->layout;
    const double *geometry;
    RowValues row;

    if (l->n != theirs->n || l->nu != theirs->nu || l->m != theirs->m || l->nx != theirs->nx)
        return diag_set(diag, E_MODEL, "with these inputs the model has other unknowns");
    w->used = order->about->start.row_count;
    w->freedoms = l->nu - w->used;
    w->unknowns = l->nu + w->used + l->nx + l->nz;
    w->follow = NEW_ARRAY(double, l->nu + l->m + l->nx + l->nz);
    w->values = NEW_ARRAY(double, w->rows.count *(1 + w->at.count));
    w->matrix = NEW_ARRAY(double, w->unknowns * w->unknowns);
    if (!find_rates(w)) {
        (void)diag_set(diag, E_SINGULAR,
                       "the equations are dependent there: nothing linear tells how "
                       "it moves");
        diag_hint(diag, "take another instant, or another start");
        return E_SINGULAR;
    }
    row = row_of_state(l, order->at, w->y);
    geometry = probe_values(w->geometry, &row);
    w->phi_u = NEW_ARRAY(double, l->m * l->nu);
    w->map = NEW_ARRAY(double, 2 * l->n * l->nu);
    w->map_rate = w->map + l->n * l->nu;
    if (l->m > 0)
        memcpy(w->phi_u, geometry, (size_t)(l->m * l->nu) * sizeof(double));
    if (l->n > 0)
        memcpy(w->map, geometry + l->m * l->nu, (size_t)(2 * l->n * l->nu) * sizeof(double));
    return OK;
}

/* --- independent coordinates --- */

/* "h8"; for an angular velocity m1.Wx "m1.turnX", a small turn about that axis */
static char *part_name(const Work *w, int speed)
{
    int i = speed_coordinate(w->system, speed);
    const char *name = system_u(w->system, speed)->name;
    const char *axis = strrchr(name, '.');
    Text text = {0};

    if (i >= 0)
        text_add(&text, system_q(w->system, i)->name);
    else if (axis != NULL)
        text_addf(&text, "%.*s.turn%c", (int)(axis - name), name,
                  axis[1] != '\0' ? axis[strlen(axis) - 1] - 'a' + 'A' : ' ');
    else
        text_addf(&text, "turn %s", name);
    return text_done(&text);
}

static Status choose_independent(Work *w, Diag *diag)
{
    const LinearOrder *order = w->order;
    int *wanted = NEW_ARRAY(int, order->independent_count);
    int count = 0;
    Status status = OK;

    for (int k = 0; k < order->independent_count; k++)
        for (int j = 0; j < w->l->nu; j++) {
            int i = speed_coordinate(w->system, j);

            if (i >= 0 && strcmp(system_q(w->system, i)->name, order->independent[k]) == 0)
                wanted[count++] = j;
        }
    w->embed = embed_new(w->l->nu, w->used);
    if (!embed_choose(w->embed, w->phi_u, order->about->start.rows, wanted, count))
        status =
            diag_set(diag, E_SINGULAR,
                     "a singular position: no choice of coordinates describes the motion there");
    mem_free(wanted);
    return status;
}

/* --- columns --- */

typedef struct Deviation {
    double *s, *u, *q; /* nu, nu, n */
    double *follow;    /* unknowns */
    double *right;     /* the same, or used */
    int input;         /* that deviates by 1, or -1 */
    int state;         /* network state that does, or -1 */
} Deviation;

static bool is_independent(const Work *w, int speed)
{
    for (int i = 0; i < w->freedoms; i++)
        if (embed_independent(w->embed)[i] == speed)
            return true;
    return false;
}

/* Complete v, whose independent entries are set: Phi_u v + right = 0 in the dependent ones. */
static bool complete(const Work *w, const double *right, double *v)
{
    const int nu = w->l->nu, m = w->used;
    const int *rows = w->order->about->start.rows;
    double *matrix = NEW_ARRAY(double, m *m), *b = NEW_ARRAY(double, m);
    double *found = NEW_ARRAY(double, m);
    bool sound;

    for (int r = 0; r < m; r++) {
        int column = 0;

        b[r] = -right[r];
        for (int j = 0; j < nu; j++) {
            double entry = w->phi_u[rows[r] * nu + j];

            if (is_independent(w, j))
                b[r] -= entry * v[j];
            else
                matrix[r * m + column++] = entry;
        }
    }
    sound = rows_solve(matrix, m, m, b, found) == m;
    for (int j = 0, column = 0; j < nu && sound; j++)
        if (!is_independent(w, j))
            v[j] = found[column++];
    mem_free(matrix);
    mem_free(b);
    mem_free(found);
    return sound;
}

static void by_map(const Work *w, const double *s, double *q)
{
    for (int i = 0; i < w->l->n; i++) {
        q[i] = 0;
        for (int j = 0; j < w->l->nu; j++)
            q[i] += w->map[i * w->l->nu + j] * s[j];
    }
}

/* derivative of a row along all that deviates but what follows */
static double along(const Work *w, const Deviation *d, int row)
{
    double sum = d->input >= 0 ? gradient(w, row, w->at.inputs + d->input) : 0;

    if (d->state >= 0)
        sum += gradient(w, row, w->at.x + d->state);
    for (int i = 0; i < w->l->n; i++)
        sum += gradient(w, row, w->at.q + i) * d->q[i];
    for (int j = 0; j < w->l->nu; j++)
        sum += gradient(w, row, w->at.u + j) * d->u[j];
    return sum;
}

/* everything that a deviation of independent ones, a state or an input brings with it */
static bool spread(const Work *w, Deviation *d)
{
    const int *rows = w->order->about->start.rows;
    double *moving = NEW_ARRAY(double, w->l->nu);
    bool sound;

    /* speeds apart: the velocity rows deviate with position first */
    for (int r = 0; r < w->used; r++)
        d->right[r] =
            d->input >= 0 ? gradient(w, w->rows.phi + rows[r], w->at.inputs + d->input) : 0;
    sound = complete(w, d->right, d->s);
    by_map(w, d->s, d->q);
    if (w->l->nu > 0) {
        memcpy(moving, d->u, (size_t)w->l->nu * sizeof(double));
        memset(d->u, 0, (size_t)w->l->nu * sizeof(double));
    }
    for (int r = 0; r < w->used; r++)
        d->right[r] = along(w, d, w->rows.velocity + rows[r]);
    if (w->l->nu > 0)
        memcpy(d->u, moving, (size_t)w->l->nu * sizeof(double));
    sound = sound && complete(w, d->right, d->u);
    for (int r = 0; r < w->unknowns; r++)
        d->right[r] = -along(w, d, equation(w, r));
    sound = sound && solve(w, d->right, d->follow);
    mem_free(moving);
    return sound;
}

/* rate of the deviation s_j: N s' = (N u)_q dq + N du - N' s; columns of N are orthogonal */
static double turn_rate(const Work *w, const Deviation *d, int j)
{
    const int n = w->l->n, nu = w->l->nu;
    double sum = 0, norm = 0;

    for (int i = 0; i < n; i++) {
        double rate = 0, entry = w->map[i * nu + j];

        if (entry == 0)
            continue;
        for (int k = 0; k < n; k++)
            rate += gradient(w, w->rows.q_rate + i, w->at.q + k) * d->q[k];
        for (int k = 0; k < nu; k++)
            rate += w->map[i * nu + k] * d->u[k] - w->map_rate[i * nu + k] * d->s[k];
        sum += entry * rate;
        norm += entry * entry;
    }
    return sum / norm + 0.0; /* never -0 */
}

/* write the column of A and C, or of B and D */
static void write_column(const Work *w, const Deviation *d, double *rates, double *outputs,
                         int stride)
{
    const Layout *l = w->l;
    const int *independent = embed_independent(w->embed);
    int f = w->freedoms;

    for (int i = 0; i < f; i++) {
        rates[i * stride] = turn_rate(w, d, independent[i]);
        rates[(f + i) * stride] = d->follow[independent[i]] + 0.0;
    }
    for (int i = 0; i < l->nx; i++)
        rates[(2 * f + i) * stride] = d->follow[l->nu + w->used + i] + 0.0;
    for (int o = 0; o < w->order->output_count; o++) {
        outputs[o * stride] = along(w, d, w->rows.outputs + o);
        for (int k = 0; k < w->unknowns; k++)
            outputs[o * stride] += gradient(w, w->rows.outputs + o, unknown(w, k)) * d->follow[k];
    }
}

/* Rates of an input that the equations hold, x' = A x + B u + B1 u', as where a source closes a
 * circuit of capacitors: of x - B1 u the equations hold none, x~' = A x~ + (B + A B1) u. */
static Status take_rate(const Work *w, Deviation *d, int input, Linear *out, Diag *diag)
{
    double *b1 = NEW_ARRAY(double, out->states);
    double *d1 = NEW_ARRAY(double, out->outputs);
    Status status = OK;

    memset(d->s, 0, (size_t)w->l->nu * sizeof(double));
    memset(d->u, 0, (size_t)w->l->nu * sizeof(double));
    d->state = -1;
    d->input = out->inputs + input;
    if (!spread(w, d))
        CHECK(diag_set(diag, E_SINGULAR, "the equations are dependent there"));
    write_column(w, d, b1, d1, 1);
    for (int o = 0; o < out->outputs; o++)
        if (fabs(d1[o]) > 1e-12 * vector_largest(d->follow, w->unknowns)) {
            (void)diag_set(diag, E_MODEL, "%s follows the rate of %s, which is no linear output",
                           out->output_names[o], out->input_names[input]);
            diag_hint(diag, "a resistance in the circuit of capacitors and source makes it one");
            CHECK(E_MODEL);
        }
    for (int i = 0; i < out->states; i++) {
        out->is_shifted = out->is_shifted || b1[i] != 0;
        for (int k = 0; k < out->states && b1[i] != 0; k++)
            out->b[k * out->inputs + input] += out->a[k * out->states + i] * b1[i];
        for (int o = 0; o < out->outputs && b1[i] != 0; o++)
            out->d[o * out->inputs + input] += out->c[o * out->states + i] * b1[i];
    }
done:
    mem_free(b1);
    mem_free(d1);
    return status;
}

static Status write_columns(const Work *w, Linear *out, Diag *diag)
{
    const Layout *l = w->l;
    int f = w->freedoms;
    Deviation d = {.s = NEW_ARRAY(double, l->nu),
                   .u = NEW_ARRAY(double, l->nu),
                   .q = NEW_ARRAY(double, l->n),
                   .follow = NEW_ARRAY(double, w->unknowns),
                   .right = NEW_ARRAY(double, w->unknowns)};
    Status status = OK;

    for (int c = 0; c < out->states + out->inputs; c++) {
        for (int j = 0; j < l->nu; j++) {
            d.s[j] = c < f && embed_independent(w->embed)[c] == j;
            d.u[j] = c >= f && c < 2 * f && embed_independent(w->embed)[c - f] == j;
        }
        d.state = c >= 2 * f && c < out->states ? c - 2 * f : -1;
        d.input = c >= out->states ? c - out->states : -1;
        CHECK(poll(w->order->watch));
        if (!spread(w, &d))
            CHECK(diag_set(diag, E_SINGULAR, "the equations are dependent there"));
        if (c >= out->states) {
            write_column(w, &d, out->b + c - out->states, out->d + c - out->states, out->inputs);
            continue;
        }
        write_column(w, &d, out->a + c, out->c + c, out->states);
        for (int j = 0; j < l->nu; j++)
            out->motion[j * out->states + c] = d.s[j];
        for (int i = 0; i < l->nx; i++)
            out->motion[(l->nu + i) * out->states + c] = d.state == i;
    }
    for (int i = 0; i < out->inputs; i++)
        CHECK(take_rate(w, &d, i, out, diag));
done:
    mem_free(d.s);
    mem_free(d.u);
    mem_free(d.q);
    mem_free(d.follow);
    mem_free(d.right);
    return status;
}

/* --- the result --- */

static char *copy(const char *text)
{
    return mem_text(text, strlen(text));
}

static Linear *linear_new(const Work *w)
{
    const LinearOrder *order = w->order;
    const Layout *l = w->l;
    Linear *out = NEW(Linear);
    int f = w->freedoms;

    out->at = order->at;
    out->freedoms = f;
    out->states = 2 * f + l->nx;
    out->inputs = order->input_count;
    out->outputs = order->output_count;
    out->parts = l->nu + l->nx;
    out->a = NEW_ARRAY(double, out->states * out->states);
    out->b = NEW_ARRAY(double, out->states * out->inputs);
    out->c = NEW_ARRAY(double, out->outputs * out->states);
    out->d = NEW_ARRAY(double, out->outputs * out->inputs);
    out->motion = NEW_ARRAY(double, out->parts * out->states);
    out->state_names = NEW_ARRAY(char *, out->states);
    out->input_names = NEW_ARRAY(char *, out->inputs);
    out->output_names = NEW_ARRAY(char *, out->outputs);
    out->part_names = NEW_ARRAY(char *, out->parts);
    for (int j = 0; j < l->nu; j++)
        out->part_names[j] = part_name(w, j);
    for (int i = 0; i < f; i++) {
        int j = embed_independent(w->embed)[i];

        out->state_names[i] = copy(out->part_names[j]);
        out->state_names[f + i] = copy(system_u(w->system, j)->name);
    }
    for (int i = 0; i < l->nx; i++) {
        out->state_names[2 * f + i] = copy(system_x(w->system, i)->name);
        out->part_names[l->nu + i] = copy(system_x(w->system, i)->name);
    }
    for (int i = 0; i < out->inputs; i++)
        out->input_names[i] = copy(order->inputs[i].name);
    for (int i = 0; i < out->outputs; i++)
        out->output_names[i] = copy(order->output_names[i]);
    return out;
}

static void free_names(char **names, int count)
{
    for (int i = 0; i < count; i++)
        mem_free(names[i]);
    mem_free(names);
}

void linear_free(Linear *linear)
{
    if (linear == NULL)
        return;
    mem_free(linear->a);
    mem_free(linear->b);
    mem_free(linear->c);
    mem_free(linear->d);
    mem_free(linear->motion);
    free_names(linear->state_names, linear->states);
    free_names(linear->input_names, linear->inputs);
    free_names(linear->output_names, linear->outputs);
    free_names(linear->part_names, linear->parts);
    mem_free(linear);
}

static void work_free(Work *w)
{
    gradients_free(&w->gradients);
    probe_free(w->geometry);
    parameters_free(&w->parameters);
    layout_free(w->l);
    system_free(w->varied);
    embed_free(w->embed);
    mem_free(w->inputs);
    mem_free(w->at.symbols);
    mem_free(w->y);
    mem_free(w->follow);
    mem_free(w->values);
    mem_free(w->phi_u);
    mem_free(w->map);
    mem_free(w->matrix);
}

Status linearize(const LinearOrder *order, Linear **out, Diag *diag)
{
    Work w = {.order = order};
    Linear *linear = NULL;
    Status status = OK;

    report(order->watch, "linearizing", -1);
    CHECK(result_refuse_by(order->about, diag));
    CHECK(open_system(&w, diag));
    CHECK(compile(&w, diag));
    CHECK(fix_point(&w, diag));
    CHECK(choose_independent(&w, diag));
    linear = linear_new(&w);
    CHECK(write_columns(&w, linear, diag));
    if (!vector_is_finite(linear->a, linear->states * linear->states)) {
        (void)diag_set(diag, E_SINGULAR, "the equations have no derivatives there");
        diag_hint(diag, "a distance of 0 or an angle at its limit has none: take another point");
        CHECK(E_SINGULAR);
    }
    *out = linear;
    linear = NULL;
done:
    linear_free(linear);
    work_free(&w);
    return status;
}
