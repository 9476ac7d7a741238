/* linearize_columns.c: the columns of A, B, C, D: deviations of everything by one state or input */
#include "simulate/analyse/linearize_impl.h"

#include "base/memory.h"

#include <string.h>

/* --- deviations --- */

typedef struct Deviation {
    LinearNumber *s, *u, *q; /* nu, nu, n */
    LinearNumber *follow;    /* of the unknowns e */
    LinearNumber *right;     /* right-hand side: as many, or `used` */
    LinearNumber *turn;      /* n: N s' */
    LinearNumber *outputs;
    int input; /* that has a deviation of 1, or -1 */
    int state; /* network state that has one, or -1 */
    int column;
} Deviation;

static const LinearNumber one = {1, 0}, none = {0, 0};

static void deviation_open(const Work *w, Deviation *d)
{
    *d = (Deviation){.s = NEW_ARRAY(LinearNumber, w->l->nu),
                     .u = NEW_ARRAY(LinearNumber, w->l->nu),
                     .q = NEW_ARRAY(LinearNumber, w->l->n),
                     .follow = NEW_ARRAY(LinearNumber, w->unknowns),
                     .right = NEW_ARRAY(LinearNumber, w->unknowns),
                     .turn = NEW_ARRAY(LinearNumber, w->l->n),
                     .outputs = NEW_ARRAY(LinearNumber, w->order->output_count),
                     .input = -1,
                     .state = -1};
}

static void deviation_close(Deviation *d)
{
    MEM_FREE(d->s, d->u, d->q, d->follow, d->right, d->turn, d->outputs);
}

/* number_add() with a quick exit where a factor is 0 */
static inline void add_product(LinearNumber *sum, LinearNumber a, LinearNumber b)
{
    if ((a.value != 0 || a.error != 0) && (b.value != 0 || b.error != 0))
        number_add(sum, a, b);
}

static void by_map(const Work *w, Deviation *d)
{
    for (int i = 0; i < w->l->n; i++) {
        d->q[i] = none;
        for (int j = 0; j < w->l->nu; j++)
            add_product(&d->q[i], w->map[i * w->l->nu + j], d->s[j]);
    }
}

/* Derivatives of all rows along deviations, one batch lane each: by the input, by coordinates and
 * states, by speeds, by the unknowns e. */
typedef enum Parts { BY_INPUT, BY_POSITION, BY_SPEED, BY_ALL } Parts;

static void move(const Work *w, const Deviation *d, int count, Parts parts)
{
    tangents_clear(w->along);
    for (int lane = 0; lane < count; lane++, d++) {
        if (d->input >= 0)
            linear_move(w, lane, w->at.inputs + d->input, one);
        if (parts >= BY_POSITION && d->state >= 0)
            linear_move(w, lane, w->at.x + d->state, one);
        for (int i = 0; i < w->l->n && parts >= BY_POSITION; i++)
            linear_move(w, lane, w->at.q + i, d->q[i]);
        for (int j = 0; j < w->l->nu && parts >= BY_SPEED; j++)
            linear_move(w, lane, w->at.u + j, d->u[j]);
        for (int k = 0; k < w->unknowns && parts == BY_ALL; k++)
            linear_move(w, lane, linear_unknown(w, k), d->follow[k]);
    }
    tangents_run(w->along);
}

/* E_e follow = -right */
static void solve(const Work *w, Deviation *d)
{
    const int n = w->unknowns;
    double *b = NEW_ARRAY(double, n), *error = NEW_ARRAY(double, n);
    double *found = NEW_ARRAY(double, n), *off = NEW_ARRAY(double, n);

    for (int r = 0; r < n; r++) {
        b[r] = -d->right[r].value;
        error[r] = d->right[r].error;
    }
    verified_solve_solution(w->equations, b, error, found, off);
    for (int k = 0; k < n; k++)
        d->follow[k] = (LinearNumber){found[k], off[k]};
    MEM_FREE(b, error, found, off);
}

/* copy the derivatives of constraint rows to the right-hand side */
static void take_rows(const Work *w, const Dependence *on, Deviation *d, int count, int first)
{
    for (int lane = 0; lane < count; lane++)
        for (int r = 0; r < on->used; r++)
            d[lane].right[r] = linear_slope(w, first + on->rows[r], lane);
}

/* N s' = (N u)_q dq + N du - N' s */
static void take_turn(const Work *w, Deviation *d, int lane)
{
    for (int i = 0; i < w->l->n; i++) {
        d->turn[i] = linear_slope(w, w->rows.q_rate + i, lane);
        for (int k = 0; k < w->l->nu; k++)
            add_product(&d->turn[i], w->map_rate[i * w->l->nu + k],
                        (LinearNumber){-d->s[k].value, d->s[k].error});
    }
}

/* dependent ones: speeds separately, since the velocity rows have a deviation by position first */
static void complete(const Work *w, Deviation *d, int count)
{
    move(w, d, count, BY_INPUT);
    take_rows(w, w->places, d, count, w->rows.phi);
    for (int lane = 0; lane < count; lane++) {
        linear_complete(w, w->places, d[lane].right, d[lane].s);
        by_map(w, &d[lane]);
    }
    move(w, d, count, BY_POSITION);
    take_rows(w, &w->speeds, d, count, w->rows.velocity);
    for (int lane = 0; lane < count; lane++)
        linear_complete(w, &w->speeds, d[lane].right, d[lane].u);
}

/* the deviations of everything, from those of independent coordinates and speeds, a state or an
 * input */
static void spread(const Work *w, Deviation *d, int count)
{
    if (w->speeds.used > 0)
        complete(w, d, count);
    for (int lane = 0; lane < count && w->speeds.used == 0; lane++)
        by_map(w, &d[lane]);
    move(w, d, count, BY_SPEED);
    for (int lane = 0; lane < count; lane++) {
        for (int r = 0; r < w->unknowns; r++) {
            d[lane].right[r] = linear_slope(w, linear_equation(w, r), lane);
            d[lane].right[r].value =
                linear_moved(w, r, -1 - d[lane].column, d[lane].right[r].value);
        }
        take_turn(w, &d[lane], lane);
        solve(w, &d[lane]);
    }
    if (w->order->output_count == 0)
        return;
    move(w, d, count, BY_ALL);
    for (int lane = 0; lane < count; lane++)
        for (int o = 0; o < w->order->output_count; o++)
            d[lane].outputs[o] = linear_slope(w, w->rows.outputs + o, lane);
}

/* rate of the deviation s_j; columns of N are orthogonal */
static LinearNumber turn_rate(const Work *w, const Deviation *d, int j)
{
    const int n = w->l->n, nu = w->l->nu;
    LinearNumber sum = none, norm = none, out;

    for (int i = 0; i < n; i++) {
        const LinearNumber entry = w->map[i * nu + j];

        if (entry.value == 0 && entry.error == 0)
            continue;
        number_add(&sum, entry, d->turn[i]);
        number_add(&norm, entry, entry);
    }
    out.value = sum.value / norm.value;
    out.error = (sum.error + fabs(out.value) * norm.error) / norm.value +
                fabs(fma(out.value, norm.value, -sum.value)) / norm.value;
    return out;
}

/* --- columns of A and C, of B and D --- */

/* one column of rates, or of outputs */
typedef struct LinearColumn {
    double *at, *error;
    int stride;
} LinearColumn;

static LinearColumn column_of(double *at, double *error, int column, int stride)
{
    return (LinearColumn){at + column, error + column, stride};
}

static void put(const LinearColumn *column, int row, LinearNumber number)
{
    column->at[(ptrdiff_t)row * column->stride] = number.value;
    column->error[(ptrdiff_t)row * column->stride] = number.error;
}

/* set entries to 0 that are 0 within their errors */
static void drop(const LinearColumn *column, int count)
{
    for (int i = 0; i < count; i++)
        if (linear_is_undetermined(column->at[(ptrdiff_t)i * column->stride],
                                   column->error[(ptrdiff_t)i * column->stride]))
            column->at[(ptrdiff_t)i * column->stride] = 0;
}

static LinearNumber get(const LinearColumn *column, int row)
{
    return (LinearNumber){column->at[(ptrdiff_t)row * column->stride],
                          column->error[(ptrdiff_t)row * column->stride]};
}

static void write_column(const Work *w, const Deviation *d, const LinearColumn *rates,
                         const LinearColumn *outputs)
{
    const VariableIndex *l = w->l;
    const int places = w->places->free, f = w->speeds.free;
    const int *independent = partitioning_independent(w->speeds.partitioning);
    const int *placed = partitioning_independent(w->places->partitioning);

    for (int i = 0; i < places; i++)
        put(rates, i, turn_rate(w, d, placed[i]));
    for (int i = 0; i < f; i++)
        put(rates, places + i, d->follow[independent[i]]);
    for (int i = 0; i < l->nx; i++)
        put(rates, places + f + i, d->follow[l->nu + w->speeds.used + i]);
    for (int o = 0; o < w->order->output_count; o++)
        put(outputs, o, d->outputs[o]);
}

/* Rates of an input in the equations, x' = A x + B u + B1 u', as where a source closes a loop of
 * capacitors: equations of x~ = x - B1 u contain none, x~' = A x~ + (B + A B1) u. */
static Status take_rate(const Work *w, Deviation *d, int input, Linear *out, Diag *diag)
{
    double *b1 = NEW_ARRAY(double, 2 * out->states), *d1 = NEW_ARRAY(double, 2 * out->outputs);
    const LinearColumn rates = {b1, b1 + out->states, 1}, direct = {d1, d1 + out->outputs, 1};
    const LinearColumn b = column_of(out->b, out->b_error, input, out->inputs);
    const LinearColumn through = column_of(out->d, out->d_error, input, out->inputs);
    Status status = OK;

    for (int j = 0; j < w->l->nu; j++)
        d->s[j] = d->u[j] = none;
    d->state = -1;
    d->input = out->inputs + input;
    d->column = out->states + d->input;
    spread(w, d, 1);
    write_column(w, d, &rates, &direct);
    drop(&rates, out->states);
    drop(&direct, out->outputs);
    for (int o = 0; o < out->outputs; o++)
        if (d1[o] != 0 && w->perturbation == 0) {
            (void)diag_set(diag, E_MODEL, "%s follows the rate of %s, which is no linear output",
                           out->output_names[o], out->input_names[input]);
            diag_hint(diag, "a resistance in the circuit of capacitors and source makes it one");
            CHECK(E_MODEL);
        }
    for (int i = 0; i < out->states; i++)
        out->is_shifted = out->is_shifted || b1[i] != 0;
    for (int k = 0; k < out->states; k++) {
        LinearNumber sum = get(&b, k);

        for (int i = 0; i < out->states; i++) {
            const LinearColumn a = column_of(out->a, out->a_error, i, out->states);

            number_add(&sum, get(&a, k), get(&rates, i));
        }
        put(&b, k, sum);
    }
    for (int o = 0; o < out->outputs; o++) {
        LinearNumber sum = get(&through, o);

        for (int i = 0; i < out->states; i++) {
            const LinearColumn c = column_of(out->c, out->c_error, i, out->states);

            number_add(&sum, get(&c, o), get(&rates, i));
        }
        put(&through, o, sum);
    }
done:
    MEM_FREE(b1, d1);
    return status;
}

/* the deviation of a column: of a state, or after these of an input */
static void begin(const Work *w, const Linear *out, int c, Deviation *d)
{
    const int places = w->places->free, above = places + w->speeds.free;

    for (int j = 0; j < w->l->nu; j++)
        d->s[j] = d->u[j] = none;
    if (c < places)
        d->s[partitioning_independent(w->places->partitioning)[c]] = one;
    else if (c < above)
        d->u[partitioning_independent(w->speeds.partitioning)[c - places]] = one;
    d->state = c >= above && c < out->states ? c - above : -1;
    d->input = c >= out->states ? c - out->states : -1;
    d->column = c;
}

/* --- M s'' + K s + C s' = 0 --- */

/* T, the derivative of all speeds by the independent ones, and the balances projected onto it */
typedef struct ColumnBalance {
    LinearNumber *along;  /* T, nu x freedoms */
    LinearNumber *moment; /* nu: workspace */
} ColumnBalance;

static LinearNumber mass_entry(const Work *w, int i, int j)
{
    return (LinearNumber){w->matrix[i * w->unknowns + j], w->matrix_error[i * w->unknowns + j]};
}

/* whether balances contain no unknowns but accelerations and multipliers */
static bool is_mechanical(const Work *w)
{
    for (int i = 0; i < w->l->nu; i++)
        for (int k = w->l->nu + w->speeds.used; k < w->unknowns; k++) {
            const LinearNumber entry = mass_entry(w, i, k);

            if (entry.value != 0 || entry.error != 0)
                return false;
        }
    return true;
}

/* project a load on all speeds onto the independent ones */
static void put_along(const Work *w, const ColumnBalance *b, double sign, double *at, double *error,
                      int stride)
{
    for (int i = 0; i < w->speeds.free; i++) {
        LinearNumber sum = none;

        for (int j = 0; j < w->l->nu; j++)
            add_product(&sum, b->along[j * w->speeds.free + i], b->moment[j]);
        at[(ptrdiff_t)i * stride] = sign * sum.value;
        error[(ptrdiff_t)i * stride] = sum.error;
    }
}

static void add_mass(const Work *w, const LinearNumber *acceleration, LinearNumber *moment)
{
    for (int i = 0; i < w->l->nu; i++)
        for (int j = 0; j < w->l->nu; j++)
            add_product(&moment[i], mass_entry(w, i, j), acceleration[j]);
}

/* T, and the mass matrix of independent coordinates, T^T M T */
static void open_balance(const Work *w, ColumnBalance *b, Linear *out)
{
    const int nu = w->l->nu, f = w->speeds.free;
    LinearNumber *v = NEW_ARRAY(LinearNumber, nu), *still = NEW_ARRAY(LinearNumber, w->speeds.used);

    b->along = NEW_ARRAY(LinearNumber, nu * f);
    b->moment = NEW_ARRAY(LinearNumber, nu);
    out->mass = NEW_ARRAY(double, f *f);
    out->mass_error = NEW_ARRAY(double, f *f);
    out->force = NEW_ARRAY(double, f * out->states);
    out->force_error = NEW_ARRAY(double, f * out->states);
    for (int k = 0; k < f; k++) {
        memset(v, 0, (size_t)nu * sizeof *v);
        v[partitioning_independent(w->speeds.partitioning)[k]] = one;
        if (w->speeds.used > 0)
            linear_complete(w, &w->speeds, still, v);
        for (int j = 0; j < nu; j++)
            b->along[j * f + k] = v[j];
    }
    for (int k = 0; k < f; k++) {
        for (int j = 0; j < nu; j++)
            v[j] = b->along[j * f + k];
        memset(b->moment, 0, (size_t)nu * sizeof *b->moment);
        add_mass(w, v, b->moment);
        put_along(w, b, 1, out->mass + k, out->mass_error + k, f);
    }
    MEM_FREE(v, still);
}

static void close_balance(const ColumnBalance *b)
{
    MEM_FREE(b->along, b->moment);
}

/* -T^T (residual of the balances + M u'), where u' is what constraints determine of dependent
 * speeds alone */
static void write_force(const Work *w, const ColumnBalance *b, const Deviation *d, int column,
                        Linear *out)
{
    const int nu = w->l->nu;
    LinearNumber *v = NEW_ARRAY(LinearNumber, nu);

    for (int i = 0; i < nu; i++)
        b->moment[i] = d->right[i];
    if (w->speeds.used > 0) {
        linear_complete(w, &w->speeds, d->right + nu, v);
        add_mass(w, v, b->moment);
    }
    put_along(w, b, -1, out->force + column, out->force_error + column, out->states);
    mem_free(v);
}

static void forget_balance(Linear *out)
{
    MEM_FREE(out->mass, out->mass_error, out->force, out->force_error);
    out->mass = out->mass_error = out->force = out->force_error = NULL;
}

/* whether s' are the speeds, and s depends on nothing else */
static bool speeds_are_rates(const Linear *out)
{
    if (out->places != out->freedoms)
        return false;
    for (int i = 0; i < out->freedoms; i++)
        for (int k = 0; k < out->states; k++) {
            const double speed = k == out->freedoms + i ? 1 : 0;

            if (out->a[i * out->states + k] != speed || out->a_error[i * out->states + k] != 0)
                return false;
        }
    return true;
}

/* --- all columns --- */

static void write_deviation(const Work *w, const Deviation *d, int c, Linear *out)
{
    const bool is_input = c >= out->states;
    const int column = is_input ? c - out->states : c;
    const int stride = is_input ? out->inputs : out->states;
    const LinearColumn rates = is_input ? column_of(out->b, out->b_error, column, stride)
                                        : column_of(out->a, out->a_error, column, stride);
    const LinearColumn outputs = is_input ? column_of(out->d, out->d_error, column, stride)
                                          : column_of(out->c, out->c_error, column, stride);

    write_column(w, d, &rates, &outputs);
    for (int j = 0; j < w->l->nu && !is_input; j++)
        out->motion[j * out->states + c] = d->s[j].value;
    for (int i = 0; i < w->l->nx && !is_input; i++)
        out->motion[(w->l->nu + i) * out->states + c] = d->state == i;
}

Status linear_columns(const Work *w, Linear *out, Diag *diag)
{
    const int columns = out->states + out->inputs;
    const bool is_whole = w->perturbation == 0 && is_mechanical(w);
    ColumnBalance balance = {0};
    Deviation d[TANGENT_BATCH];
    Status status = OK;

    for (int lane = 0; lane < TANGENT_BATCH; lane++)
        deviation_open(w, &d[lane]);
    if (is_whole)
        open_balance(w, &balance, out);
    for (int first = 0; first < columns; first += TANGENT_BATCH) {
        const int count = columns - first < TANGENT_BATCH ? columns - first : TANGENT_BATCH;

        monitor_report(w->order->watch, "linearizing", (double)first / columns);
        CHECK(monitor_poll(w->order->watch));
        for (int lane = 0; lane < count; lane++)
            begin(w, out, first + lane, &d[lane]);
        spread(w, d, count);
        for (int lane = 0; lane < count; lane++) {
            write_deviation(w, &d[lane], first + lane, out);
            if (is_whole && first + lane < out->states)
                write_force(w, &balance, &d[lane], first + lane, out);
        }
    }
    if (!speeds_are_rates(out))
        forget_balance(out);
    for (int i = 0; i < out->inputs; i++)
        CHECK(take_rate(w, &d[0], i, out, diag));
done:
    for (int lane = 0; lane < TANGENT_BATCH; lane++)
        deviation_close(&d[lane]);
    close_balance(&balance);
    return status;
}
