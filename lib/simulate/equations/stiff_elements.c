/* stiff_elements.c: equations with inputs in place of stiff functions and sources
 *
 * An element N(a) becomes n + s (a - a0) with inputs n, s and a0: the slope s is almost 0 where the
 * element doesn't conduct. A source becomes an input. The rest is solved for w as a linear system.
 * Its sensitivities to inputs are found by differences, which are exact where it is affine. */
#include "simulate/equations/stiff_elements_impl.h"

#include "algebra/elementary.h"
#include "algebra/linear.h"
#include "base/memory.h"
#include "simulate/equations/equations_limits.h"

#include <math.h>
#include <string.h>

#define SOLVED (1U << SYMBOL_STATE_RATE | 1U << SYMBOL_ALGEBRAIC)
#define MOVING                                                                                     \
    (SOLVED | 1U << SYMBOL_COORDINATE | 1U << SYMBOL_SPEED | 1U << SYMBOL_STATE | 1U << SYMBOL_TURN)
#define AFTER                                                                                      \
    (1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER | 1U << SYMBOL_EFFORT | 1U << SYMBOL_JERK)

/* --- elements and sources of the equations --- */

/* of t and parameters, none of which is the side of a switch */
static bool is_of_time(const VariableIndex *l, Expr e)
{
    const unsigned kinds = expr_kinds(e);

    if ((kinds & 1U << SYMBOL_TIME) == 0 ||
        (kinds & ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER)) != 0)
        return false;
    for (int i = 0; i < l->switches; i++)
        if (l->side[i] != NULL && expr_depends(e, l->side[i]))
            return false;
    return true;
}

static bool is_stiff_op(Op op)
{
    return op == OP_EXP || op == OP_TANH || op == OP_SINH || op == OP_COSH;
}

static bool is_stiff_power(Expr e)
{
    return expr_kind(e) == EXPR_POWER && expr_is_number(expr_arg(e, 1)) &&
           fabs(expr_value(expr_arg(e, 1))) >= STIFF_LEAST_POWER;
}

static bool is_element(Expr e)
{
    return ((expr_kind(e) == EXPR_CALL && is_stiff_op(expr_op(e))) || is_stiff_power(e)) &&
           (expr_kinds(e) & MOVING) != 0 && (expr_kinds(e) & AFTER) == 0;
}

static void add_source(StiffElements *s, Expr e)
{
    for (int i = 0; i < s->sources.count; i++)
        if (s->sources.at[i].function == e)
            return;
    LIST_PUSH(s->sources,
              (Source){.function = e, .is_continuous = stiff_elements_add_corners(NULL, e) == 0});
}

/* exp(min(c, x)) equals exp(x) for x < c */
static Expr without_magnitude_bound(Expr argument)
{
    if (expr_kind(argument) == EXPR_CALL && expr_op(argument) == OP_MIN &&
        expr_is_number(expr_arg(argument, 0)))
        return expr_arg(argument, 1);
    return argument;
}

static bool is_bent(Arena *arena, Expr argument)
{
    Expr *symbols;
    int count = expr_symbols(&argument, 1, &symbols);
    bool bent = false;

    for (int i = 0; i < count && !bent; i++)
        if ((expr_kinds(symbols[i]) & MOVING) != 0)
            bent = (expr_kinds(expr_diff(arena, argument, symbols[i])) & MOVING) != 0;
    mem_free(symbols);
    return bent;
}

/* subexpressions of e that depend on time alone, where e depends on more */
static void add_sources_of(StiffElements *s, Expr e)
{
    for (int i = 0; i < expr_arg_count(e); i++)
        if (is_of_time(s->l, expr_arg(e, i)))
            add_source(s, expr_arg(e, i));
}

static bool holds_time_or_is_element(Expr e, void *context)
{
    return is_element(e) || ((expr_kinds(e) & 1U << SYMBOL_TIME) != 0 && !is_of_time(context, e));
}

static void find_all(StiffElements *s, const Expr *roots, int count)
{
    Expr *nodes;
    int found = expr_find(roots, count, holds_time_or_is_element, (void *)s->l, &nodes);

    for (int i = 0; i < count; i++)
        if (is_of_time(s->l, roots[i]))
            add_source(s, roots[i]);
    for (int i = 0; i < found; i++) {
        if (is_element(nodes[i])) {
            const bool is_power = expr_kind(nodes[i]) == EXPR_POWER;
            Expr argument = without_magnitude_bound(expr_arg(nodes[i], 0));

            LIST_PUSH(s->elements,
                      (StiffElement){.call = nodes[i],
                                     .argument = argument,
                                     .is_bent = is_bent(system_arena(s->l->system), argument),
                                     .op = is_power ? OP_HOLD : expr_op(nodes[i]),
                                     .exponent = is_power ? expr_value(expr_arg(nodes[i], 1)) : 0});
        }
        add_sources_of(s, nodes[i]);
    }
    mem_free(nodes);
}

/* the roots G, F and gamma */
static StiffElementRoots equations_of(const VariableIndex *l)
{
    const EquationForm *r = system_run(l->system);
    StiffElementRoots roots = {0};

    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(roots, r->network_residual[i]);
    for (int i = 0; i < l->nu; i++)
        LIST_PUSH(roots, r->force[i]);
    for (int i = 0; i < l->m; i++)
        LIST_PUSH(roots, r->gamma[i]);
    return roots;
}

static bool holds_time(Expr e, void *context)
{
    return (expr_kinds(e) & 1U << SYMBOL_TIME) != 0 && !is_of_time(context, e);
}

/* Sources in an expression that affects more than rates. */
static void find_sources(StiffElements *s, Expr e)
{
    Expr *nodes;
    int found = expr_find(&e, 1, holds_time, (void *)s->l, &nodes);

    if (is_of_time(s->l, e))
        add_source(s, e);
    for (int i = 0; i < found; i++)
        add_sources_of(s, nodes[i]);
    mem_free(nodes);
}

/* sources in conditions of switches that depend on more than time: they may switch without an
 * effect on rates */
static Status find_sources_of_switches(StiffElements *s, Diag *diag)
{
    System *system = s->l->system;
    const Switch *switches;
    int time_only = 0;
    int count = system_switches(system, &switches, &time_only);
    Status status = OK;

    for (int i = time_only; i < count; i++)
        find_sources(s, switches[i].condition);
    for (int i = 0; i < system_ideal_count(system); i++) {
        IdealSwitch ideal;

        CHECK(system_ideal(system, i, &ideal, diag));
        if (ideal.margin != NULL)
            find_sources(s, ideal.margin);
    }
done:
    return status;
}

Status stiff_elements_new(const VariableIndex *l, Parameters *parameters, Motion *motion,
                          const Equations *eq, StiffElements **out, Diag *diag)
{
    StiffElements *s = NEW(StiffElements);
    StiffElementRoots roots = equations_of(l);
    Status status = OK;

    *out = NULL;
    *s = (StiffElements){.l = l, .parameters = parameters, .motion = motion, .eq = eq};
    find_all(s, roots.at, roots.count);
    CHECK(find_sources_of_switches(s, diag));
    if (s->elements.count == 0 && s->sources.count == 0)
        goto done;
    stiff_elements_find_ranges(s);
    if (arena_status(system_arena(l->system)) != OK)
        CHECK(diag_set(diag, arena_status(system_arena(l->system)), "%s",
                       arena_failure(system_arena(l->system))));
    *out = s;
    s = NULL;
done:
    LIST_FREE(roots);
    stiff_elements_free(s);
    return status;
}

void stiff_elements_free(StiffElements *s)
{
    if (s == NULL)
        return;
    LIST_FREE(s->elements);
    LIST_FREE(s->sources);
    ranges_free(s->values);
    ranges_free(s->slopes);
    ranges_free(s->bends);
    ranges_free(s->corners);
    MEM_FREE(s->closer, s->bent, s->reach);
    probe_free(s->probe);
    sparse_free(s->network);
    MEM_FREE(s->inputs.symbols, s->here, s->w, s->moved, s->answer, s->y, s);
}

int stiff_elements_element_count(const StiffElements *s)
{
    return s->elements.count;
}

int stiff_elements_source_count(const StiffElements *s)
{
    return s->sources.count;
}

const char *stiff_elements_variable(const StiffElements *s, int k)
{
    const Expr argument = s->elements.at[k].argument;
    const char *name = "";
    Expr *symbols;
    const int count = expr_symbols(&argument, 1, &symbols);

    for (int i = count - 1; i >= 0; i--)
        if ((expr_kinds(symbols[i]) & MOVING) != 0)
            name = expr_name(symbols[i]);
    mem_free(symbols);
    return name;
}

Range stiff_elements_size(const StiffElements *s, int k, Range a)
{
    const StiffElement *element = &s->elements.at[k];
    Range size = {a.low <= 0 && a.high >= 0 ? 0 : fmin(fabs(a.low), fabs(a.high)),
                  fmax(fabs(a.low), fabs(a.high))};

    switch (element->op) {
    case OP_EXP:
        return a;
    case OP_TANH: /* the difference to 1 */
        return (Range){-2 * size.high, -2 * size.low};
    case OP_HOLD:
        size = (Range){element->exponent * elementary_log(size.low),
                       element->exponent * elementary_log(size.high)};
        return size.low <= size.high ? size : (Range){size.high, size.low};
    default:
        return size;
    }
}

/* --- the equations over inputs --- */

static int new_input(StiffElements *s, const char *name)
{
    Text text = {0};
    int place = s->inputs.count++;

    text_addf(&text, "%s %d", name, place);
    s->inputs.symbols = mem_grow(s->inputs.symbols, (size_t)s->inputs.count, sizeof(Expr));
    s->inputs.symbols[place] = expr_symbol(system_arena(s->l->system), text.at, SYMBOL_EFFORT);
    text_free(&text);
    return place;
}

static void make_inputs(StiffElements *s)
{
    s->inputs = *s->l;
    s->inputs.symbols = NEW_ARRAY(Expr, s->l->count);
    memcpy(s->inputs.symbols, s->l->symbols, (size_t)s->l->count * sizeof(Expr));
    for (int i = 0; i < s->sources.count; i++)
        s->sources.at[i].input = new_input(s, "source");
    for (int k = 0; k < s->elements.count; k++) {
        s->elements.at[k].inputs = new_input(s, "value");
        (void)new_input(s, "slope");
        (void)new_input(s, "argument");
    }
}

/* replace sources and elements of the roots by inputs, then those in arguments of elements */
static void put_inputs(const StiffElements *s, StiffElementRoots *roots)
{
    Arena *arena = system_arena(s->l->system);
    StiffElementRoots from = {0}, to = {0};
    StiffElementRoots arguments = {0};

    for (int i = 0; i < s->sources.count; i++) {
        LIST_PUSH(from, s->sources.at[i].function);
        LIST_PUSH(to, s->inputs.symbols[s->sources.at[i].input]);
    }
    for (int k = 0; k < s->elements.count; k++)
        LIST_PUSH(arguments, s->elements.at[k].argument);
    expr_replace(arena, arguments.at, arguments.count, from.at, to.at, from.count);
    for (int k = 0; k < s->elements.count; k++) {
        const Expr *own = s->inputs.symbols + s->elements.at[k].inputs;
        Expr moved = expr_sub(arena, arguments.at[k], own[2]);
        Expr capped = expr_arg(s->elements.at[k].call, 0);

        if (capped != s->elements.at[k].argument) { /* and beyond the cap, as a diode goes on */
            Expr beyond = expr_sub(arena, s->elements.at[k].argument, expr_arg(capped, 0));

            LIST_PUSH(from, expr_call2(arena, OP_MAX, expr_int(arena, 0), beyond));
            LIST_PUSH(to, expr_int(arena, 0));
        }
        LIST_PUSH(from, s->elements.at[k].call);
        LIST_PUSH(to, expr_add(arena, own[0], expr_mul(arena, own[1], moved)));
    }
    expr_replace(arena, roots->at, roots->count, from.at, to.at, from.count);
    for (int k = 0; k < arguments.count; k++)
        LIST_PUSH(*roots, arguments.at[k]);
    LIST_FREE(from);
    LIST_FREE(to);
    LIST_FREE(arguments);
}

/* derivatives of the network's equations by x' and z */
static Sparse *open_network(const Probe *probe, int n)
{
    int count;
    const Slope *slopes = residual_slopes(probe_residual(probe), &count);
    int *row = NEW_ARRAY(int, count), *column = NEW_ARRAY(int, count);
    Sparse *network;

    for (int k = 0; k < count; k++) {
        row[k] = slopes[k].row;
        column[k] = slopes[k].unknown;
    }
    network = sparse_new(n, count, row, column);
    MEM_FREE(row, column);
    return network;
}

static void compile(StiffElements *s)
{
    const VariableIndex *l = s->l;
    const int n = l->nx + l->nz;
    StiffElementRoots roots = equations_of(l);
    ProbeOrder order = {.row_count = n, .unknowns = l->symbols + l->rates, .unknown_count = n};

    make_inputs(s);
    s->force = n;
    s->gamma = n + l->nu;
    s->argument = roots.count;
    put_inputs(s, &roots);
    s->matrix = order.root_count = roots.count;
    order.roots = roots.at;
    s->has_failed = probe_make(&s->inputs, s->parameters, &order, &s->probe, NULL) != OK;
    if (!s->has_failed) {
        s->root_count = program_root_count(residual_program(probe_residual(s->probe)));
        s->network = open_network(s->probe, n);
    }
    s->here = NEW_ARRAY(double, s->root_count);
    s->w = NEW_ARRAY(double, n);
    s->moved = NEW_ARRAY(double, n);
    s->answer = NEW_ARRAY(double, n + l->nu);
    s->y = NEW_ARRAY(double, motion_length(s->motion));
    LIST_FREE(roots);
}

static bool is_ready(StiffElements *s)
{
    if (s->probe == NULL && !s->has_failed) {
        const bool before = mem_scratch(true); /* numbers that each query computes anew */

        compile(s);
        (void)mem_scratch(before);
    }
    return !s->has_failed;
}

/* --- about a point --- */

static const double *roots_at(StiffElements *s, const double *y, const double *w)
{
    RowValues row;

    s->inputs.sides = s->l->sides;
    row = row_of_state(s->l, s->t, y);
    row.rates = w;
    row.z = w + s->l->nx;
    return probe_values(s->probe, &row);
}

static void set_sources(StiffElements *s, double t)
{
    const Range *at = stiff_elements_sources_over(s, (Range){t, t});

    for (int i = 0; i < s->sources.count; i++)
        *probe_input(s->probe, s->sources.at[i].input) = (at[i].low + at[i].high) / 2;
}

static void set_element(StiffElements *s, int k, double n, double slope, double a)
{
    double *inputs = probe_input(s->probe, s->elements.at[k].inputs);

    inputs[0] = n;
    inputs[1] = slope;
    inputs[2] = a;
}

/* set w, sources and time at (t, y) */
static bool go_to(StiffElements *s, double t, const double *y)
{
    const double *w;

    if (!is_ready(s))
        return false;
    w = motion_network(s->motion, t, y);
    if (w == NULL)
        return false;
    memcpy(s->w, w, (size_t)(s->l->nx + s->l->nz) * sizeof(double));
    s->t = motion_clock(s->motion, t);
    set_sources(s, s->t);
    return true;
}

bool stiff_elements_arguments(StiffElements *s, double t, const double *y, double *a)
{
    if (!go_to(s, t, y))
        return false;
    memcpy(a, roots_at(s, y, s->w) + s->argument, (size_t)s->elements.count * sizeof(double));
    return vector_is_finite(a, s->elements.count);
}

/* N and its derivative at a */
static void value_of(const StiffElement *element, double a, double *n, double *slope)
{
    switch (element->op) {
    case OP_EXP:
        *n = *slope = exp(a);
        return;
    case OP_TANH:
        *n = tanh(a);
        *slope = 1 - *n * *n;
        return;
    case OP_SINH:
        *n = sinh(a);
        *slope = cosh(a);
        return;
    case OP_COSH:
        *n = cosh(a);
        *slope = sinh(a);
        return;
    default:
        *n = pow(a, element->exponent);
        *slope = element->exponent * pow(a, element->exponent - 1);
    }
}

/* Linearise about (t, y): the roots are stored in `here`, and the network is factored. */
static bool settle(StiffElements *s, const double *y, const double *leaks, const double *a)
{
    for (int k = 0; k < s->elements.count; k++) {
        double n, slope;

        value_of(&s->elements.at[k], a[k], &n, &slope);
        set_element(s, k, n, isnan(leaks[k]) ? slope : leaks[k], a[k]);
    }
    memcpy(s->y, y, (size_t)motion_length(s->motion) * sizeof(double));
    memcpy(s->here, roots_at(s, y, s->w), (size_t)s->root_count * sizeof(double));
    return s->l->nx + s->l->nz == 0 || sparse_factor(s->network, s->here + s->matrix);
}

/* The derivative of w when the roots have changed by this, over `by`; into s->answer. */
static void answer(StiffElements *s, const double *roots, double by)
{
    int n = s->l->nx + s->l->nz;

    for (int i = 0; i < n; i++)
        s->answer[i] = -(roots[i] - s->here[i]) / by;
    if (n > 0)
        sparse_solve(s->network, s->answer);
}

/* The derivatives of arguments likewise, with w; y is the perturbed state. */
static void arguments_answer(StiffElements *s, const double *y, double by, double *out, int stride)
{
    const double *roots;
    int n = s->l->nx + s->l->nz;

    answer(s, roots_at(s, y, s->w), by);
    for (int i = 0; i < n; i++)
        s->moved[i] = s->w[i] + by * s->answer[i];
    roots = roots_at(s, y, s->moved);
    for (int k = 0; k < s->elements.count; k++)
        out[k * stride] = (roots[s->argument + k] - s->here[s->argument + k]) / by;
}

/* Fit a = rate (x - t) + bend (x - t)^2 to the values at the end of the interval and half way;
 * `rate` contains the slope so far. */
static void find_bends(StiffElements *s, const double *y, const double *slope, double by,
                       double *moved, Affine *out)
{
    bool any = false;

    memset(out->bend, 0, (size_t)s->elements.count * sizeof(double));
    for (int k = 0; k < s->elements.count; k++)
        any = any || s->elements.at[k].is_bent;
    if (!any)
        return;
    for (int i = 0; i < motion_length(s->motion); i++)
        moved[i] = y[i] + by / 2 * slope[i];
    arguments_answer(s, moved, by / 2, out->bend, 1);
    for (int k = 0; k < s->elements.count; k++) {
        double bend = s->elements.at[k].is_bent ? 2 * (out->rate[k] - out->bend[k]) / by : 0;

        out->bend[k] = bend;
        out->rate[k] -= bend * by;
    }
}

/* The time along y' that is evaluated, s: a step, but no further than y is large. Differences are
 * over such distances since rounding error may be 1e12 times larger where leakage alone determines
 * a value. */
static double way_along(const double *y, const double *slope, int length, double h)
{
    for (int i = 0; i < length; i++)
        if (h * fabs(slope[i]) > fabs(y[i]) + 1)
            h = (fabs(y[i]) + 1) / fabs(slope[i]);
    return h;
}

static double way_of_source(const StiffElements *s, int j)
{
    return s->sources.at[j].size > 0 ? s->sources.at[j].size : 1;
}

bool stiff_elements_linearise(StiffElements *s, double t, const double *y, const double *slope,
                              double h, const double *leaks, Affine *out)
{
    int length = motion_length(s->motion);
    double by = way_along(y, slope, length - 1, h);
    double *moved;

    if (!stiff_elements_arguments(s, t, y, out->a) || !settle(s, y, leaks, out->a))
        return false;
    moved = NEW_ARRAY(double, length);
    for (int i = 0; i < length; i++)
        moved[i] = y[i] + by * slope[i];
    arguments_answer(s, moved, by, out->rate, 1);
    find_bends(s, y, slope, by, moved, out);
    for (int j = 0; j < s->sources.count; j++) {
        double *input = probe_input(s->probe, s->sources.at[j].input);
        double kept = *input;

        by = way_of_source(s, j);
        *input = kept + by;
        arguments_answer(s, y, by, out->by_source + j, s->sources.count);
        *input = kept;
    }
    mem_free(moved);
    return vector_is_finite(out->rate, s->elements.count) &&
           vector_is_finite(out->by_source, s->elements.count * s->sources.count);
}

bool stiff_elements_answers(StiffElements *s, double t, const double *y, const double *off,
                            double leak, double *arguments, double *rates)
{
    const int length = motion_length(s->motion);
    double *leaks = NEW_ARRAY(double, s->elements.count), *moved = NEW_ARRAY(double, length);
    bool sound = stiff_elements_arguments(s, t, y, arguments);

    for (int k = 0; k < s->elements.count; k++)
        leaks[k] = s->elements.at[k].op == OP_SINH ? fmax(leak, 1) : leak;
    for (int i = 0; i < length; i++)
        moved[i] = y[i] + off[i];
    sound = sound && settle(s, y, leaks, arguments);
    if (sound) {
        arguments_answer(s, moved, 1, arguments, 1);
        memcpy(rates, s->answer, (size_t)s->l->nx * sizeof(double));
        sound = vector_is_finite(arguments, s->elements.count) && vector_is_finite(rates, s->l->nx);
    }
    MEM_FREE(leaks, moved);
    return sound;
}

/* the largest rate that changes, over its scale: of states, and of speeds as if each body moved
 * alone */
static double effect(StiffElements *s, double by, const double *scale)
{
    const VariableIndex *l = s->l;
    int n = l->nx + l->nz;
    const double *roots = roots_at(s, s->y, s->w), *mass_matrix;
    double largest = 0;

    answer(s, roots, by);
    for (int i = 0; i < n; i++)
        s->moved[i] = s->w[i] + by * s->answer[i];
    if (l->nu > 0)
        roots = roots_at(s, s->y, s->moved);
    for (int i = 0; i < l->nx; i++)
        largest = fmax(largest, fabs(s->answer[i]) / scale[l->n + l->nu + i]);
    mass_matrix = l->nu > 0 ? equations_mass(s->eq) : NULL;
    for (int j = 0; j < l->nu; j++) {
        double force = (roots[s->force + j] - s->here[s->force + j]) / by;
        double mass = pattern_at(s->eq->masses, mass_matrix, j, j);

        if (mass > 0)
            largest = fmax(largest, fabs(force / mass) / scale[l->n + j]);
    }
    for (int k = 0; k < l->m; k++) {
        double gamma = fabs(roots[s->gamma + k] - s->here[s->gamma + k]) / by;
        double size = pattern_largest(s->eq->rows, s->eq->phi_u, k);

        for (int e = s->eq->rows->start[k]; e < s->eq->rows->start[k + 1] && size > 0; e++)
            if (s->eq->phi_u[e] != 0)
                largest = fmax(largest, gamma / size / scale[l->n + s->eq->rows->row[e]]);
    }
    return largest;
}

double stiff_elements_effect_of_element(StiffElements *s, int k, const double *scale)
{
    double *input = probe_input(s->probe, s->elements.at[k].inputs);
    double kept = *input, out;

    *input = kept + STIFF_PERTURBATION;
    out = effect(s, STIFF_PERTURBATION, scale);
    *input = kept;
    return out;
}

double stiff_elements_effect_of_source(StiffElements *s, int k, double t, const double *y,
                                       const double *scale)
{
    double *input, kept, out, by;
    double *a = NEW_ARRAY(double, s->elements.count);
    double *leaks = NEW_ARRAY(double, s->elements.count);
    bool sound = stiff_elements_arguments(s, t, y, a);

    for (int i = 0; i < s->elements.count; i++)
        leaks[i] = NAN;
    sound = sound && settle(s, y, leaks, a);
    MEM_FREE(a, leaks);
    if (!sound)
        return INFINITY;
    input = probe_input(s->probe, s->sources.at[k].input);
    by = way_of_source(s, k);
    kept = *input;
    *input = kept + by;
    out = effect(s, by, scale);
    *input = kept;
    return out;
}
