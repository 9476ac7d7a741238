/* response.c: a linear network solved in symbols, over polynomials in s
 *
 * Rows are multiplied by their denominators. Pivots of 1 and -1 come first, as they lengthen no
 * entry. Then each step divides by the pivot before it, which leaves determinants of the network
 * (Bareiss 1968). An expression that is no number, sum, product or integer power is a variable of
 * the polynomials. */
#include "formulate/reduced/response.h"

#include "base/flint_library.h"
#include "formulate/formulate_limits.h"

#include <math.h>
#include <string.h>

enum {
    MOST_TERMS = 20000, /* of a polynomial: far more than anybody reads */
    MOST_POWER = 127,   /* of a variable or a sum, as it is written */
    DEEPEST = 60,       /* of nested sums and products that are multiplied out */
    SAMPLES = 2         /* points at which a pivot with functions is evaluated */
};

typedef struct ResponseSolver {
    LinearNetwork net;
    System *view;
    Ring *ring;
    Expr s;
    LIST(Expr) atoms; /* variables of the ring; 0: s */
    bool has_functions;
    double *sample;   /* of the atoms, SAMPLES each */
    int unknowns;     /* of the network, followed by the output */
    int inputs;       /* right sides */
    int first_source; /* the first of them, or the only one */
    int columns;      /* unknowns, the output, right sides */
    Multinomial **at; /* (unknowns + 1) x columns; NULL: 0 */
    bool *row_used, *column_used;
    Multinomial *before; /* the last pivot */
} ResponseSolver;

/* --- expressions as fractions of polynomials --- */

typedef struct ResponseFraction {
    Multinomial *over, *under;
} ResponseFraction;

static void fraction_free(ResponseFraction *f)
{
    multinomial_free(f->over);
    multinomial_free(f->under);
}

/* result from operands, which are freed */
static Multinomial *product_of(Multinomial *a, Multinomial *b)
{
    Multinomial *out = multinomial_times(a, b);

    multinomial_free(a);
    multinomial_free(b);
    return out;
}

/* the integer power of a fraction's base that is multiplied out; 0: it is none */
static int whole_power(Expr e)
{
    int64_t num, den;

    return expr_kind(e) == EXPR_POWER && expr_rational_parts(expr_arg(e, 1), &num, &den) &&
                   den == 1 && num >= -MOST_POWER && num <= MOST_POWER
               ? (int)num
               : 0;
}

static bool is_atom(Expr e, int depth)
{
    const ExprKind kind = expr_kind(e);

    return !expr_is_number(e) &&
           (depth > DEEPEST || (kind != EXPR_SUM && kind != EXPR_PRODUCT && whole_power(e) == 0));
}

static void find_atoms(ResponseSolver *s, Expr e, int depth)
{
    if (is_atom(e, depth)) {
        if (linear_network_number(&s->net, e) != NULL)
            return;
        for (int i = 0; i < s->atoms.count; i++)
            if (s->atoms.at[i] == e)
                return;
        s->has_functions = s->has_functions || expr_kind(e) != EXPR_SYMBOL;
        LIST_PUSH(s->atoms, e);
    } else if (expr_kind(e) == EXPR_POWER) {
        find_atoms(s, expr_arg(e, 0), depth + 1);
    } else {
        for (int i = 0; !expr_is_number(e) && i < expr_arg_count(e); i++)
            find_atoms(s, expr_arg(e, i), depth + 1);
    }
}

/* Numbers of parts have symbols, so that polynomials are exact. A variable that is a function of
 * such symbols contains the numbers: the root of coupled coils' L1 L2. */
static Expr with_numbers_in_atoms(const ResponseSolver *s, Expr e, int depth)
{
    const LinearNetwork *net = &s->net;
    Expr *args, out;
    int count;

    if (expr_is_number(e) || expr_kind(e) == EXPR_SYMBOL || net->parameters.count == 0)
        return e;
    if (is_atom(e, depth))
        return expr_substitute(net->arena, e, net->parameters.at, net->values.at,
                               net->parameters.count);
    count = expr_arg_count(e);
    args = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++)
        args[i] = with_numbers_in_atoms(s, expr_arg(e, i), depth + 1);
    switch (expr_kind(e)) {
    case EXPR_SUM:
        out = expr_sum(net->arena, args, count);
        break;
    case EXPR_PRODUCT:
        out = expr_product(net->arena, args, count);
        break;
    default:
        out = expr_pow(net->arena, args[0], args[1]);
    }
    mem_free(args);
    return out;
}

static ResponseFraction fraction_of_number(const ResponseSolver *s, Expr e)
{
    int64_t num, den;
    ResponseFraction out;
    mpq_t value;

    mpq_init(value);
    if (expr_rational_parts(e, &num, &den)) {
        mpz_set_si(mpq_numref(value), num);
        mpz_set_si(mpq_denref(value), den);
    } else {
        mpq_set_d(value, expr_value(e));
    }
    out.over = multinomial_integer(s->ring, mpq_numref(value));
    out.under = multinomial_integer(s->ring, mpq_denref(value));
    mpq_clear(value);
    return out;
}

/* a + b; both are freed */
static ResponseFraction fraction_sum(ResponseFraction a, ResponseFraction b)
{
    Multinomial *common = multinomial_gcd(a.under, b.under);
    Multinomial *more = multinomial_exact(b.under, common);
    Multinomial *less = multinomial_exact(a.under, common);
    ResponseFraction out;

    a.over = product_of(a.over, more);
    b.over = product_of(b.over, less);
    more = multinomial_exact(b.under, common);
    out.over = multinomial_sum(a.over, b.over, 1);
    out.under = multinomial_times(a.under, more);
    multinomial_free(common);
    multinomial_free(more);
    fraction_free(&a);
    fraction_free(&b);
    return out;
}

static ResponseFraction fraction_of(const ResponseSolver *s, Expr e, int depth);

static ResponseFraction fraction_power(const ResponseSolver *s, Expr e, int depth)
{
    const int power = whole_power(e);
    ResponseFraction base = fraction_of(s, expr_arg(e, 0), depth + 1), out;

    out.over = multinomial_small(s->ring, 1);
    out.under = multinomial_small(s->ring, 1);
    if (power < 0) {
        Multinomial *over = base.over;

        base.over = base.under;
        base.under = over;
    }
    for (int i = 0; i < (power < 0 ? -power : power); i++) {
        ResponseFraction next = {multinomial_times(out.over, base.over),
                                 multinomial_times(out.under, base.under)};

        fraction_free(&out);
        out = next;
    }
    fraction_free(&base);
    return out;
}

static ResponseFraction fraction_of(const ResponseSolver *s, Expr e, int depth)
{
    const bool is_sum = expr_kind(e) == EXPR_SUM;
    ResponseFraction out = {NULL, NULL};

    if (expr_is_number(e))
        return fraction_of_number(s, e);
    if (is_atom(e, depth)) {
        const Expr number = linear_network_number(&s->net, e);
        int v = 0;

        if (number != NULL)
            return fraction_of_number(s, number);

        while (s->atoms.at[v] != e)
            v++;
        return (ResponseFraction){multinomial_variable(s->ring, v), multinomial_small(s->ring, 1)};
    }
    if (expr_kind(e) == EXPR_POWER)
        return fraction_power(s, e, depth);
    for (int i = 0; i < expr_arg_count(e); i++) {
        const ResponseFraction next = fraction_of(s, expr_arg(e, i), depth + 1);

        if (i == 0)
            out = next;
        else if (is_sum)
            out = fraction_sum(out, next);
        else
            out = (ResponseFraction){product_of(out.over, next.over),
                                     product_of(out.under, next.under)};
    }
    return out;
}

/* --- the matrix --- */

static Multinomial **entry_of(const ResponseSolver *s, int row, int column)
{
    return &s->at[(ptrdiff_t)row * s->columns + column];
}

/* coefficients of one equation: of w, then those of its right side */
static void laplace_row(const ResponseSolver *s, const Expr *slopes, Expr *row)
{
    Arena *arena = s->net.arena;
    const int nx = system_nx(s->net.system);
    const Expr *right = slopes + s->net.n;

    for (int k = 0; k < s->net.n; k++)
        row[k] = k < nx ? expr_sub(arena, expr_mul(arena, slopes[k], s->s), right[k]) : slopes[k];
    for (int i = 0; i < s->inputs; i++) {
        const Expr *u = right + nx + (ptrdiff_t)INPUT_ORDERS * (s->first_source + i);

        row[s->unknowns + 1 + i] = u[0];
        for (int order = 1; order < INPUT_ORDERS; order++)
            row[s->unknowns + 1 + i] =
                expr_add(arena, row[s->unknowns + 1 + i],
                         expr_mul(arena, u[order], expr_pow(arena, s->s, expr_int(arena, order))));
    }
}

/* the user's expressions may contain t where nothing else distinguishes it from a parameter */
static Status check_steady(const ResponseSolver *s, const Expr *row, const char *about, Diag *diag)
{
    for (int c = 0; c < s->columns; c++)
        if ((expr_kinds(row[c]) & 1U << SYMBOL_TIME) != 0) {
            (void)diag_set(diag, E_MODEL, "the equation of %s varies with time by itself", about);
            diag_hint(diag, "'linearize at=' holds it at an instant");
            return E_MODEL;
        }
    return OK;
}

/* an equation's polynomials, without denominators and common integer factors */
static void clear_row(const ResponseSolver *s, int row, const Expr *from)
{
    ResponseFraction *fractions = NEW_ARRAY(ResponseFraction, s->columns);
    Multinomial *under = multinomial_small(s->ring, 1);

    for (int c = 0; c < s->columns; c++) {
        Multinomial *common, *more;

        if (expr_is_zero(from[c]))
            continue;
        fractions[c] = fraction_of(s, from[c], 0);
        common = multinomial_gcd(under, fractions[c].under);
        more = multinomial_exact(fractions[c].under, common);
        under = product_of(under, more);
        multinomial_free(common);
    }
    for (int c = 0; c < s->columns; c++)
        if (fractions[c].over != NULL) {
            Multinomial *factor = multinomial_exact(under, fractions[c].under);
            Multinomial *entry = product_of(fractions[c].over, factor);

            multinomial_free(fractions[c].under);
            *entry_of(s, row, c) = entry;
            if (multinomial_is_zero(entry)) {
                multinomial_free(entry);
                *entry_of(s, row, c) = NULL;
            }
        }
    multinomial_free(under);
    mem_free(fractions);
}

/* leaves out rows that the output doesn't depend on */
static void leave_out_others(ResponseSolver *s)
{
    const int rows = s->unknowns + 1;
    bool goes_on = true;

    for (int r = 0; r < rows; r++)
        s->row_used[r] = r < s->unknowns;
    for (int c = 0; c < rows; c++)
        s->column_used[c] = c < s->unknowns;
    while (goes_on) {
        goes_on = false;
        for (int r = 0; r < rows; r++)
            for (int c = 0; c < rows; c++) {
                if (*entry_of(s, r, c) == NULL || s->row_used[r] == s->column_used[c])
                    continue;
                s->row_used[r] = s->column_used[c] = false;
                goes_on = true;
            }
    }
}

static Status make_matrix(ResponseSolver *s, Expr output, const char *about, Diag *diag)
{
    const LinearNetwork *net = &s->net;
    const int rows = s->unknowns + 1;
    Arena *arena = net->arena;
    Expr *all = NEW_ARRAY(Expr, rows * s->columns);
    Expr *slopes = NEW_ARRAY(Expr, net->n + net->columns);
    Expr resolved;
    Status status = OK;

    for (int k = 0; k < rows * s->columns; k++)
        all[k] = expr_int(arena, 0);
    for (int r = 0; r < net->n; r++) {
        for (int k = 0; k < net->n; k++)
            slopes[k] = expr_int(arena, 0);
        for (int k = net->row_start[r]; k < net->row_start[r + 1]; k++)
            slopes[net->entry[k].column] = net->entry[k].value;
        memcpy(slopes + net->n, net->right + (ptrdiff_t)r * net->columns,
               (size_t)net->columns * sizeof *slopes);
        laplace_row(s, slopes, all + (ptrdiff_t)r * s->columns);
        CHECK(check_steady(s, all + (ptrdiff_t)r * s->columns, linear_network_part(net, r), diag));
    }
    CHECK(system_resolve(s->view, output, &resolved, diag));
    CHECK(linear_network_slopes(net, resolved, about, slopes, diag));
    /* y minus its part in w = its part in sources; coefficients of states are on the right */
    for (int k = 0; k < net->n; k++)
        slopes[k] = expr_neg(arena, slopes[k]);
    laplace_row(s, slopes, all + (ptrdiff_t)s->unknowns * s->columns);
    all[s->unknowns * s->columns + s->unknowns] = expr_int(arena, 1);
    CHECK(check_steady(s, all + (ptrdiff_t)s->unknowns * s->columns, about, diag));
    for (int k = 0; k < rows * s->columns; k++) {
        all[k] = with_numbers_in_atoms(s, all[k], 0);
        find_atoms(s, all[k], 0);
    }
    CHECK(flint_load(diag));
    s->ring = ring_new(s->atoms.count, MOST_TERMS, net->watch);
    for (int r = 0; r < rows && ring_status(s->ring) == OK; r++)
        clear_row(s, r, all + (ptrdiff_t)r * s->columns);
    leave_out_others(s);
done:
    MEM_FREE(all, slopes);
    return status;
}

/* --- pivots --- */

/* p at a sample of the atoms, and the sum of the sizes of its terms */
static double sampled(const ResponseSolver *s, const Multinomial *p, int sample, double *size)
{
    double sum = 0;

    *size = 0;
    for (int i = 0; i < multinomial_terms(p); i++) {
        double term = mpz_get_d(*multinomial_factor(p, i));

        for (int v = 0; v < s->atoms.count; v++)
            term *= pow(s->sample[v * SAMPLES + sample], multinomial_power(p, i, v));
        sum += term;
        *size += fabs(term);
    }
    return sum;
}

/* Functions of parameters may satisfy an identity that polynomials don't represent. */
static bool may_be_zero(const ResponseSolver *s, const Multinomial *p)
{
    bool may = s->has_functions && !multinomial_is_number(p);

    for (int k = 0; may && k < SAMPLES; k++) {
        double size;
        const double value = sampled(s, p, k, &size);

        may = !(fabs(value) > RESPONSE_ZERO * size);
    }
    return may;
}

static double symbol_sample(void *context, Expr symbol)
{
    const int sample = *(const int *)context;

    return 0.6 + 0.7 * fmod(expr_symbol_number(symbol) * 0.6180339887498949 + 0.37 * sample, 1);
}

static void take_samples(ResponseSolver *s)
{
    s->sample = NEW_ARRAY(double, s->atoms.count *SAMPLES);
    for (int v = 0; v < s->atoms.count; v++)
        for (int k = 0; k < SAMPLES; k++)
            s->sample[v * SAMPLES + k] = expr_evaluate(s->atoms.at[v], symbol_sample, &k);
}

static int row_length(const ResponseSolver *s, int row)
{
    int length = 0;

    for (int c = 0; c < s->columns; c++)
        length += (c >= s->unknowns || !s->column_used[c]) && *entry_of(s, row, c) != NULL;
    return length;
}

static int column_length(const ResponseSolver *s, int column)
{
    int length = 0;

    for (int r = 0; r <= s->unknowns; r++)
        length += !s->row_used[r] && *entry_of(s, r, column) != NULL;
    return length;
}

/* the entry with the least fill-in, after Markowitz (1957), times its terms; false: there is
 * none */
static bool choose_pivot(const ResponseSolver *s, bool units, int *row, int *column)
{
    int *lengths = NEW_ARRAY(int, s->unknowns);
    double best = 0;
    bool found = false;

    for (int c = 0; c < s->unknowns; c++)
        lengths[c] = column_length(s, c);
    for (int r = 0; r < s->unknowns; r++) {
        const int length = s->row_used[r] ? 0 : row_length(s, r);

        for (int c = 0; !s->row_used[r] && c < s->unknowns; c++) {
            const Multinomial *p = *entry_of(s, r, c);
            double cost;

            if (s->column_used[c] || p == NULL ||
                (units && !multinomial_is(p, 1) && !multinomial_is(p, -1)) || may_be_zero(s, p))
                continue;
            cost = (double)(length - 1) * (lengths[c] - 1) + 0.5;
            cost *= multinomial_terms(p);
            if (!found || cost < best) {
                found = true;
                best = cost;
                *row = r;
                *column = c;
            }
        }
    }
    mem_free(lengths);
    return found;
}

/* --- elimination --- */

/* (pivot a - b c)/before */
static Multinomial *crossed(const ResponseSolver *s, const Multinomial *pivot, const Multinomial *a,
                            const Multinomial *b, const Multinomial *c)
{
    Multinomial *zero = multinomial_small(s->ring, 0);
    Multinomial *kept = a != NULL ? multinomial_times(pivot, a) : multinomial_small(s->ring, 0);
    Multinomial *taken = b != NULL && c != NULL ? multinomial_times(b, c) : zero;
    Multinomial *sum = multinomial_sum(kept, taken, -1), *out = sum;

    if (s->before != NULL && !multinomial_is_zero(sum)) {
        out = multinomial_exact(sum, s->before);
        multinomial_free(sum);
    }
    multinomial_free(kept);
    if (taken != zero)
        multinomial_free(taken);
    multinomial_free(zero);
    if (!multinomial_is_zero(out))
        return out;
    multinomial_free(out);
    return NULL;
}

/* eliminates an unknown from the other rows; from those without it too where the pivot lengthens
 * them */
static void eliminate(ResponseSolver *s, int row, int column, bool by_unit)
{
    Multinomial *const pivot = *entry_of(s, row, column);

    s->row_used[row] = s->column_used[column] = true;
    for (int r = 0; r <= s->unknowns; r++) {
        Multinomial *head = *entry_of(s, r, column);

        if (s->row_used[r] || (by_unit && head == NULL))
            continue;
        for (int c = 0; c < s->columns && ring_status(s->ring) == OK; c++) {
            Multinomial **entry = entry_of(s, r, c);
            Multinomial *old = *entry;

            if ((c < s->unknowns && s->column_used[c]) ||
                (old == NULL && (head == NULL || *entry_of(s, row, c) == NULL)))
                continue;
            *entry = crossed(s, pivot, old, head, *entry_of(s, row, c));
            multinomial_free(old);
        }
    }
    s->before = by_unit ? NULL : pivot;
}

static Status ring_failure(const ResponseSolver *s, const char *about, Diag *diag)
{
    if (ring_status(s->ring) != E_MEMORY)
        return ring_status(s->ring);
    (void)diag_set(diag, E_VALUE, "%s has more than %d terms in symbols", about, MOST_TERMS);
    diag_hint(diag, "give parts numbers in the place of parameters; 'linearize' and 'show "
                    "transfer' solve it in numbers");
    return E_VALUE;
}

static Status solve(ResponseSolver *s, const char *about, Diag *diag)
{
    int row = 0, column = 0;

    if (s->has_functions)
        take_samples(s);
    for (bool units = true; ring_status(s->ring) == OK;) {
        if (choose_pivot(s, units, &row, &column))
            eliminate(s, row, column, units);
        else if (units)
            units = false;
        else
            break;
        monitor_report(s->net.watch, "eliminating", -1);
    }
    if (ring_status(s->ring) != OK)
        return ring_failure(s, about, diag);
    for (int c = 0; c < s->unknowns; c++)
        if (!s->column_used[c] && column_length(s, c) > 0)
            return diag_set(diag, E_SINGULAR, "the equations of the network leave %s open",
                            c < system_nx(s->net.system)
                                ? system_x(s->net.system, c)->name
                                : system_z(s->net.system, c - system_nx(s->net.system))->name);
    if (*entry_of(s, s->unknowns, s->unknowns) == NULL)
        return diag_set(diag, E_SINGULAR, "the equations of the network leave %s open", about);
    return OK;
}

/* --- result --- */

static Status write_response(const ResponseSolver *s, const char *about, Response *out, Diag *diag)
{
    const LinearNetwork *net = &s->net;

    out->s = s->s;
    out->count = s->inputs;
    out->source = NEW_ARRAY(Expr, s->inputs);
    out->ratio = NEW_ARRAY(PolynomialRatio, s->inputs);
    for (int i = 0; i < s->inputs; i++) {
        out->source[i] = net->symbols.at[(ptrdiff_t)INPUT_ORDERS * (s->first_source + i)];
        ratio_write(net->arena, s->atoms.at, s->atoms.count,
                    *entry_of(s, s->unknowns, s->unknowns + 1 + i),
                    *entry_of(s, s->unknowns, s->unknowns), &out->ratio[i]);
    }
    return ring_status(s->ring) == OK ? arena_status(net->arena) : ring_failure(s, about, diag);
}

void response_free(Response *response)
{
    if (response == NULL)
        return;
    for (int i = 0; i < response->count; i++)
        ratio_free(&response->ratio[i]);
    MEM_FREE(response->source, response->ratio, response);
}

/* --- the complete response --- */

static Status find_source(ResponseSolver *s, const char *name, Diag *diag)
{
    const LinearNetwork *net = &s->net;

    s->inputs = net->sources.count;
    for (int i = 0; name != NULL && i < net->sources.count; i++)
        if (strcmp(net->sources.at[i]->name, name) == 0) {
            s->first_source = i;
            s->inputs = 1;
            return OK;
        }
    if (name == NULL)
        return OK;
    (void)diag_set(diag, E_NAME, "%s is no independent source", name);
    if (net->sources.count > 0)
        diag_hint(diag, "what it answers to is a source whose value nothing else decides, as %s",
                  net->sources.at[0]->name);
    return E_NAME;
}

/* s, or a name that no parameter has */
static Expr laplace_symbol(const Scene *scene)
{
    static const char *const names[] = {"s", "p", "laplace_s"};
    int k = 0;

    for (int i = 0; i < scene->parameters.count && k + 1 < COUNT(names); i++)
        if (strcmp(expr_name(scene->parameters.at[i].symbol), names[k]) == 0) {
            k++;
            i = -1;
        }
    return expr_symbol(scene->arena, names[k], SYMBOL_ARGUMENT);
}

static void solver_free(ResponseSolver *s)
{
    ring_free(s->ring);
    system_free(s->view);
    linear_network_free(&s->net);
    LIST_FREE(s->atoms);
    MEM_FREE(s->sample, s->at, s->row_used, s->column_used);
}

Status response_new(const Scene *scene, Expr output, const char *about, const char *source,
                    const CallMonitor *watch, Response **out, Diag *diag)
{
    ResponseSolver s = {.view = NULL};
    Response *response = NULL;
    Status status;

    CHECK(linear_network_form(scene, true, watch, &s.net, diag));
    CHECK(find_source(&s, source, diag));
    CHECK(linear_network_read(&s.net, diag));
    s.view = system_view(s.net.system);
    s.s = laplace_symbol(scene);
    LIST_PUSH(s.atoms, s.s);
    s.unknowns = s.net.n;
    s.columns = s.unknowns + 1 + s.inputs;
    s.at = mem_array((size_t)(s.unknowns + 1) * (size_t)s.columns, sizeof *s.at);
    s.row_used = NEW_ARRAY(bool, s.unknowns + 1);
    s.column_used = NEW_ARRAY(bool, s.unknowns + 1);
    CHECK(make_matrix(&s, output, about, diag));
    CHECK(solve(&s, about, diag));
    response = NEW(Response);
    CHECK(write_response(&s, about, response, diag));
    *out = response;
    response = NULL;
done:
    response_free(response);
    solver_free(&s);
    return status;
}
