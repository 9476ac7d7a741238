/* linear_network.c: coefficients of a linear network's equations */
#include "formulate/reduced/linear_network.h"

#include <string.h>

static const unsigned constant_kinds = 1U << SYMBOL_PARAMETER | 1U << SYMBOL_TIME;

/* --- sources as symbols --- */

/* the value of a source that depends on nothing else */
static bool is_source(const Instance *instance, int param)
{
    return param == instance_input(instance) &&
           (instance->row->params[param].use & GIVES_SOURCE) != 0 &&
           (expr_kinds(instance->values[param].at[0]) & ~constant_kinds) == 0;
}

static bool is_parameter(const Scene *scene, const char *name)
{
    for (int i = 0; i < scene->parameters.count; i++)
        if (strcmp(expr_name(scene->parameters.at[i].symbol), name) == 0)
            return true;
    return false;
}

static void find_sources(LinearNetwork *s)
{
    for (int i = 0; i < s->scene->instance_count; i++) {
        const Instance *instance = s->scene->instances[i];

        for (int p = 0; p < instance->row->param_count; p++) {
            Text name = {0};

            if (!is_source(instance, p))
                continue;
            LIST_PUSH(s->sources, instance);
            text_add(&name, instance->name);
            /* a parameter may have the name, and need not be the source's value */
            if (is_parameter(s->scene, instance->name))
                text_addf(&name, ".%s", instance->row->params[p].name);
            for (int order = 0; order < INPUT_ORDERS; order++) {
                LIST_PUSH(s->symbols, expr_symbol(s->arena, name.at, SYMBOL_PARAMETER));
                text_char(&name, '\'');
            }
            text_free(&name);
            break;
        }
    }
}

/* --- numbers as symbols --- */

Expr linear_network_number(const LinearNetwork *s, Expr symbol)
{
    for (int i = 0; i < s->parameters.count; i++)
        if (s->parameters.at[i] == symbol)
            return s->values.at[i];
    return NULL;
}

/* Terms of 0 vanish, and so do factors of 1: these remain numbers. */
static Expr name_number(LinearNetwork *s, const Instance *instance, Expr value)
{
    Text name = {0};
    Expr symbol;

    if (!s->names_numbers || (instance->scalar_count == 0 && instance->row->couple == NULL) ||
        !expr_is_number(value) || expr_is(value, 0) || expr_is(value, 1) || expr_is(value, -1))
        return value;
    text_char(&name, '#');
    expr_print(&name, value, NOTATION_TEXT);
    symbol = expr_symbol(s->arena, name.at, SYMBOL_PARAMETER);
    text_free(&name);
    if (linear_network_number(s, symbol) == NULL) {
        LIST_PUSH(s->parameters, symbol);
        LIST_PUSH(s->values, value);
    }
    return symbol;
}

/* u + (t - start) u' + (t - start)^2/2 u'': has the value and derivatives of any source at
 * `start` */
static Expr vary(void *context, const Instance *instance, int param, Expr value)
{
    LinearNetwork *s = context;
    Arena *arena = s->arena;

    for (int i = 0; instance != NULL && i < s->sources.count; i++) {
        const Expr *u = s->symbols.at + (ptrdiff_t)INPUT_ORDERS * i;
        const Expr late = expr_sub(arena, s->t, s->start);

        if (strcmp(s->sources.at[i]->name, instance->name) != 0 || !is_source(instance, param))
            continue;
        return expr_sum(
            arena,
            (Expr[]){u[0], expr_mul(arena, late, u[1]),
                     expr_product(
                         arena,
                         (Expr[]){expr_rational(arena, 1, 2), expr_square(arena, late), u[2]}, 3)},
            3);
    }
    return instance != NULL ? name_number(s, instance, value) : value;
}

/* --- the equations --- */

/* neither unknown nor state nor source */
static bool is_constant(const LinearNetwork *s, Expr e)
{
    bool is = (expr_kinds(e) & ~constant_kinds) == 0;
    Expr *symbols = NULL;
    const int count = is ? expr_symbols(&e, 1, &symbols) : 0;

    for (int i = 0; is && i < count; i++)
        for (int k = 0; is && k < s->symbols.count; k++)
            is = symbols[i] != s->symbols.at[k];
    mem_free(symbols);
    return is;
}

const char *linear_network_part(const LinearNetwork *s, int row)
{
    const int nx = system_nx(s->system);
    const Variable *variable = row < nx ? system_x(s->system, row) : system_z(s->system, row - nx);

    return system_instance_name(s->system, variable->instance);
}

static Status not_linear(const char *about, unsigned kinds, Diag *diag)
{
    const unsigned motion = 1U << SYMBOL_COORDINATE | 1U << SYMBOL_SPEED |
                            1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER |
                            1U << SYMBOL_EFFORT;

    if ((kinds & motion) != 0)
        (void)diag_set(diag, E_MODEL, "the equation of %s holds motion of the mechanism", about);
    else
        (void)diag_set(diag, E_MODEL, "the network is not linear: see the equation of %s", about);
    diag_hint(diag, "'linearize' gives the linear equations of both about a point; 'show network' "
                    "shows them as they are");
    return E_MODEL;
}

/* column of the coefficient of a symbol: x' and z, then x, then sources by order; -1 */
static int column_of(const LinearNetwork *s, Expr symbol)
{
    const int nx = system_nx(s->system), n = nx + system_nz(s->system);
    const SymbolKind kind = expr_symbol_kind(symbol);

    for (int j = 0; (kind == SYMBOL_STATE || kind == SYMBOL_STATE_RATE) && j < nx; j++) {
        if (system_x(s->system, j)->symbol == symbol)
            return n + j;
        if (system_state_rate(s->system, j) == symbol)
            return j;
    }
    for (int j = 0; kind == SYMBOL_ALGEBRAIC && j < n - nx; j++)
        if (system_z(s->system, j)->symbol == symbol)
            return nx + j;
    for (int k = 0; kind == SYMBOL_PARAMETER && k < s->symbols.count; k++)
        if (s->symbols.at[k] == symbol)
            return n + nx + k;
    return -1;
}

Status linear_network_slopes(const LinearNetwork *s, Expr e, const char *about, Expr *out,
                             Diag *diag)
{
    Arena *arena = s->arena;
    const Expr zero = expr_int(arena, 0);
    Expr *symbols = NULL;
    Expr rest;
    int count;
    Status status = OK;

    e = expr_open(arena, expr_substitute(arena, e, &s->start, &s->t, 1));
    rest = e;
    for (int c = 0; c < s->n + s->columns; c++)
        out[c] = zero;
    count = expr_symbols(&e, 1, &symbols);
    for (int i = 0; i < count; i++) {
        const int column = column_of(s, symbols[i]);

        if (column < 0)
            continue;
        out[column] = expr_open(arena, expr_diff(arena, e, symbols[i]));
        if (!is_constant(s, out[column]))
            CHECK(not_linear(about, expr_kinds(e), diag));
        rest = expr_substitute(arena, rest, &symbols[i], &zero, 1);
    }
    /* the remainder without all these must be 0 */
    if ((expr_kinds(rest) & ~constant_kinds) != 0 ||
        !expr_is_zero(expr_expand(arena, rest, LINEAR_TERMS)))
        CHECK(not_linear(about, expr_kinds(e), diag));
done:
    mem_free(symbols);
    return status;
}

static Status read_row(LinearNetwork *s, int row, Expr *slopes, Diag *diag)
{
    const char *about = linear_network_part(s, row);

    TRY(linear_network_slopes(s, system_run(s->system)->network_rhs[row], about, slopes, diag));
    for (int c = 0; c < s->n; c++)
        if (!expr_is_zero(slopes[c]))
            return not_linear(about, expr_kinds(slopes[c]), diag);
    memcpy(s->right + (ptrdiff_t)row * s->columns, slopes + s->n,
           (size_t)s->columns * sizeof *slopes);
    return OK;
}

/* reads the entries of A row by row; their own order differs */
static Status read_entries(LinearNetwork *s, Diag *diag)
{
    const EquationForm *run = system_run(s->system);
    const int count = run->network_entries;
    int *next;

    s->row_start = NEW_ARRAY(int, s->n + 1);
    s->entry = NEW_ARRAY(Entry, count);
    for (int k = 0; k < count; k++)
        s->row_start[run->network[k].row + 1]++;
    for (int r = 0; r < s->n; r++)
        s->row_start[r + 1] += s->row_start[r];
    next = NEW_ARRAY(int, s->n);
    for (int k = 0; k < count; k++) {
        const int row = run->network[k].row;
        Entry *entry = &s->entry[s->row_start[row] + next[row]++];

        *entry = run->network[k];
        entry->value =
            expr_open(s->arena, expr_substitute(s->arena, entry->value, &s->start, &s->t, 1));
    }
    mem_free(next);
    for (int k = 0; k < count; k++)
        if (run->network_nonlinear || !is_constant(s, s->entry[k].value))
            return not_linear(linear_network_part(s, s->entry[k].row),
                              expr_kinds(s->entry[k].value), diag);
    return OK;
}

Status linear_network_read(LinearNetwork *s, Diag *diag)
{
    Expr *slopes = NEW_ARRAY(Expr, s->n + s->columns);
    Status status;

    s->right = mem_array((size_t)s->n * (size_t)s->columns, sizeof(Expr));
    CHECK(read_entries(s, diag));
    for (int r = 0; r < s->n; r++) {
        CHECK(read_row(s, r, slopes, diag));
        CHECK(monitor_poll(s->watch));
    }
done:
    mem_free(slopes);
    return status;
}

/* --- forming --- */

static Status check_samples(const LinearNetwork *s, Diag *diag)
{
    const OwnSample *sample;

    for (int i = 0; (sample = system_sample(s->system, i)) != NULL; i++)
        if (sample->period != NULL)
            return diag_set(
                diag, E_MODEL, "%s is sampled: its state has no rate",
                system_instance_name(s->system, system_x(s->system, sample->state)->instance));
    return OK;
}

Status linear_network_form(const Scene *scene, bool names_numbers, const CallMonitor *watch,
                           LinearNetwork *out, Diag *diag)
{
    const SystemOptions options = {.vary = vary, .context = out, .watch = watch};

    *out = (LinearNetwork){
        .scene = scene, .watch = watch, .arena = scene->arena, .names_numbers = names_numbers};
    out->t = expr_symbol(out->arena, "t", SYMBOL_TIME);
    out->start = expr_symbol(out->arena, "#start", SYMBOL_PARAMETER);
    find_sources(out);
    TRY(system_new(scene, &options, &out->system, diag));
    out->n = system_nx(out->system) + system_nz(out->system);
    out->columns = system_nx(out->system) + out->symbols.count;
    return check_samples(out, diag);
}

void linear_network_free(LinearNetwork *s)
{
    system_free(s->system);
    LIST_FREE(s->sources);
    LIST_FREE(s->symbols);
    LIST_FREE(s->parameters);
    LIST_FREE(s->values);
    MEM_FREE(s->right, s->row_start, s->entry);
}
