/* model_value.c: converts a user's expression
 *
 * Numbers are exact where their decimals and units are; a unit converts its number to SI.
 * Parameters remain symbols, laws and outputs are substituted, variables become symbols of their
 * own names. A Scope defines what may occur. */
#include "language/functions.h"
#include "model/model_impl.h"

#include <math.h>
#include <string.h>

/* what each kind of value permits, and the message otherwise */
static const struct {
    bool time;
    bool variables;
    bool asks;        /* permits the model's own figures, and other runs */
    const char *what; /* "a parameter" can't depend on ... */
    const char *way_out;
} scopes[] = {
    [SCOPE_PARAMETER] = {false, false, false, "a parameter",
                         "what changes in time is a law, f(t) = ...; what needs variables is an "
                         "output, output NAME = ..."},
    [SCOPE_LAW] = {false, false, false, "a law",
                   "make it an argument: f(t) = ... or f(x) = ..., and give it where it is called"},
    [SCOPE_NUMBER] = {false, false, false, "this value",
                      "only numbers and parameters can stand here"},
    [SCOPE_EFFORT] = {true, true, false, "this value", ""},
    [SCOPE_DRIVE] = {true, false, false, "a prescribed motion",
                     "only t, parameters and laws can stand here"},
    [SCOPE_START] = {false, false, false, "an initial value",
                     "only numbers and parameters can stand here"},
    [SCOPE_OUTPUT] = {true, true, true, "an output", ""},
    [SCOPE_EVENT] = {true, true, true, "an event", ""},
    [SCOPE_ASK] = {true, true, true, "this", ""},
};

static bool scope_has_variables(const Scope *scope)
{
    return scopes[scope->kind].variables;
}

static Status not_here(const Scope *scope, const char *name, Place place, Diag *diag)
{
    (void)diag_at(diag, E_NAME, place, "%s can't depend on %s", scopes[scope->kind].what, name);
    diag_hint(diag, "%s", scopes[scope->kind].way_out);
    return E_NAME;
}

/* --- numbers and units --- */

static Expr unit_factor(Arena *arena, const Unit *unit)
{
    Expr factor = unit->den != 0 ? expr_rational(arena, unit->num, unit->den)
                                 : expr_real(arena, unit->factor);

    if (unit->den != 0 && unit->pi_power != 0)
        factor = expr_mul(arena, factor, expr_pi(arena, unit->pi_power));
    return factor;
}

static Expr number(Arena *arena, const Syntax *syntax)
{
    Expr value = expr_decimal(arena, syntax->text);

    return syntax->has_unit ? expr_mul(arena, value, unit_factor(arena, &syntax->unit)) : value;
}

/* --- derivatives in time --- */

/* d/dt along the primed names of variables; and of values at a position, b1.v(0.5), where they have
 * one */
static Status time_derivative(const State *state, Expr e, int primes, Place place, Expr *out,
                              Diag *diag)
{
    enum { HIGHEST = 4 }; /* each one makes the expression larger */
    Arena *arena = state->arena;

    if (primes > HIGHEST)
        return diag_at(diag, E_VALUE, place, "a derivative of order %d is too high", primes);
    for (; primes > 0; primes--) {
        Expr *symbols = NULL;
        int count = expr_symbols(&e, 1, &symbols);
        Expr *rates = NEW_ARRAY(Expr, count);

        for (int i = 0; i < count; i++) {
            const char *name = expr_name(symbols[i]);
            SymbolKind kind = expr_symbol_kind(symbols[i]);
            Text primed = {0};

            rates[i] = expr_int(arena, kind == SYMBOL_TIME);
            if (kind != SYMBOL_VARIABLE && kind != SYMBOL_ARGUMENT)
                continue;
            if (kind == SYMBOL_ARGUMENT ||
                (strchr(name, ')') != NULL && !place_has_rate(state, name))) {
                (void)diag_at(diag, E_NAME, place, "the rate of %s isn't known here", name);
                MEM_FREE(symbols, rates);
                return E_NAME;
            }
            text_addf(&primed, "%s'", name);
            rates[i] = expr_symbol(arena, primed.at, SYMBOL_VARIABLE);
            text_free(&primed);
        }
        e = expr_diff_along(arena, e, symbols, rates, count);
        MEM_FREE(symbols, rates);
    }
    *out = e;
    return OK;
}

/* --- names --- */

static int find_argument(const Scope *scope, const char *name)
{
    for (int i = 0; i < scope->argument_count; i++)
        if (strcmp(scope->arguments[i], name) == 0)
            return i;
    return -1;
}

static Status no_rate(const Syntax *syntax, const char *what, Diag *diag)
{
    return diag_at(diag, E_NAME, syntax->place, "%s is %s: it has no derivative in time",
                   syntax->text, what);
}

static Status definition_name(Scope *scope, const Syntax *syntax, int index, Expr *out, Diag *diag)
{
    const Definition *d = &scope->state->definitions.at[index];

    switch (d->kind) {
    case DEFINES_PARAMETER:
        if (syntax->primes > 0)
            return no_rate(syntax, "a parameter", diag);
        *out = d->symbol;
        break;
    case DEFINES_LAW:
        (void)diag_at(diag, E_NAME, syntax->place, "%s is a law", d->name);
        diag_hint(diag, "it is called with its argument%s, as in %s(%s)",
                  d->argument_count > 1 ? "s" : "", d->name, expr_name(d->arguments[0]));
        return E_NAME;
    case DEFINES_OUTPUT:
        if (!scope_has_variables(scope))
            return not_here(scope, d->name, syntax->place, diag);
        if (time_derivative(scope->state, d->body, syntax->primes, syntax->place, out, diag) != OK)
            return E_NAME;
        break;
    case DEFINES_SUBSYSTEM:
        return diag_at(diag, E_NAME, syntax->place, "%s is a subsystem, no variable", d->name);
    case DEFINES_EVENT:
        return diag_at(diag, E_NAME, syntax->place, "%s is an event, no variable", d->name);
    }
    scope_use(scope, index);
    return OK;
}

static Status variable(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag)
{
    bool asks = scopes[scope->kind].asks;
    unsigned allow = (asks ? ALLOW_MODEL : 0U) | (scope->kind == SCOPE_ASK ? ALLOW_RUNS : 0U);
    Text name = {0};
    Status status = OK;

    CHECK(variable_resolve(scope->state, scope->own, syntax->text, syntax->primes, allow,
                           syntax->place, &name, diag));
    if (!scope_has_variables(scope)) {
        status = not_here(scope, syntax->text, syntax->place, diag);
        goto done;
    }
    for (int i = 0; i < syntax->primes; i++)
        text_char(&name, '\'');
    *out = expr_symbol(scope->state->arena, name.at, SYMBOL_VARIABLE);
done:
    text_free(&name);
    return status;
}

/* an output of another run: its variables are those of that run */
static Status output_of_run(Scope *scope, const Syntax *syntax, const Definition *output,
                            size_t prefix, Expr *out, Diag *diag)
{
    Arena *arena = scope->state->arena;
    Expr *symbols = NULL;
    Expr *values = NULL;
    Expr body = NULL;
    int count = 0;
    Status status = OK;

    CHECK(time_derivative(scope->state, output->body, syntax->primes, syntax->place, &body, diag));
    count = expr_symbols(&body, 1, &symbols);
    values = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++) {
        Text name = {0};

        values[i] = symbols[i];
        if (expr_symbol_kind(symbols[i]) != SYMBOL_VARIABLE)
            continue;
        text_add_n(&name, syntax->text, prefix);
        text_add(&name, expr_name(symbols[i]));
        values[i] = expr_symbol(arena, name.at, SYMBOL_VARIABLE);
        text_free(&name);
    }
    *out = expr_substitute(arena, body, symbols, values, count);
done:
    MEM_FREE(symbols, values);
    return status;
}

static const Definition *find_output(const State *state, const char *name)
{
    const Thing *thing = state_thing(state, name);
    const Definition *d = thing != NULL && thing->kind == THING_DEFINITION
                              ? &state->definitions.at[thing->index]
                              : NULL;

    return d != NULL && d->kind == DEFINES_OUTPUT ? d : NULL;
}

static Status name_value(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag)
{
    const State *state = scope->state;
    const char *name = syntax->text;
    const char *dot = strchr(name, '.');
    const Thing *thing;

    if (find_argument(scope, name) >= 0) {
        if (syntax->primes > 0)
            return no_rate(syntax, "an argument", diag);
        *out = expr_symbol(state->arena, name, SYMBOL_ARGUMENT);
        return OK;
    }
    if (strcmp(name, "t") == 0) {
        if (syntax->primes > 0)
            return no_rate(syntax, "time itself", diag);
        if (!scopes[scope->kind].time)
            return not_here(scope, "t", syntax->place, diag);
        *out = expr_symbol(state->arena, "t", SYMBOL_TIME);
        return OK;
    }
    if (strcmp(name, "pi") == 0) {
        if (syntax->primes > 0)
            return no_rate(syntax, "a number", diag);
        *out = expr_pi(state->arena, 1);
        return OK;
    }
    thing = state_value_thing(state, name);
    if (thing != NULL && thing->kind == THING_DEFINITION)
        return definition_name(scope, syntax, thing->index, out, diag);
    if (scope->kind == SCOPE_ASK && dot != NULL &&
        (strncmp(name, "run", 3) == 0 || strncmp(name, "last.", 5) == 0) &&
        find_output(state, dot + 1) != NULL)
        return output_of_run(scope, syntax, find_output(state, dot + 1), (size_t)(dot - name) + 1,
                             out, diag);
    return variable(scope, syntax, out, diag);
}

/* --- operators --- */

Expr model_operation(Arena *arena, const char *sign, Expr a, Expr b)
{
    static const struct {
        const char *sign;
        Expr (*build)(Arena *arena, Expr a, Expr b);
    } arithmetic[] = {
        {"+", expr_add}, {"-", expr_sub}, {"*", expr_mul}, {"/", expr_div}, {"^", expr_pow}};
    static const struct {
        const char *sign;
        Op op;
        bool swapped;
    } comparisons[] = {{"<", OP_LT, false},   {">", OP_LT, true},   {"<=", OP_LE, false},
                       {">=", OP_LE, true},   {"==", OP_EQ, false}, {"!=", OP_NE, false},
                       {"&&", OP_AND, false}, {"||", OP_OR, false}};

    if (b == NULL)
        return sign[0] == '-'   ? expr_neg(arena, a)
               : sign[0] == '!' ? expr_call1(arena, OP_NOT, a)
                                : a;
    for (int i = 0; i < COUNT(arithmetic); i++)
        if (strcmp(arithmetic[i].sign, sign) == 0)
            return arithmetic[i].build(arena, a, b);
    for (int i = 0; i < COUNT(comparisons); i++)
        if (strcmp(comparisons[i].sign, sign) == 0)
            return expr_call2(arena, comparisons[i].op, comparisons[i].swapped ? b : a,
                              comparisons[i].swapped ? a : b);
    return NULL;
}

static Status convert(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag);

static Status call(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag)
{
    Expr *args = NEW_ARRAY(Expr, syntax->count);
    Status status = OK;

    for (int i = 0; i < syntax->count; i++)
        if (syntax->args[i]->kind != SYNTAX_STRING || !function_takes_text(syntax->text))
            CHECK(convert(scope, syntax->args[i], &args[i], diag));
    CHECK(function_call(scope, syntax, args, out, diag));
    CHECK(time_derivative(scope->state, *out, syntax->primes, syntax->place, out, diag));
done:
    mem_free(args);
    return status;
}

static Status convert_node(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag)
{
    Arena *arena = scope->state->arena;
    Expr a = NULL;
    Expr b = NULL;

    switch (syntax->kind) {
    case SYNTAX_NUMBER:
        *out = number(arena, syntax);
        break;
    case SYNTAX_STRING:
        return diag_at(diag, E_VALUE, syntax->place, "a number is expected here, not a text");
    case SYNTAX_VECTOR:
        return diag_at(diag, E_VALUE, syntax->place, "one number is expected here, not a vector");
    case SYNTAX_VARIABLE:
        return name_value(scope, syntax, out, diag);
    case SYNTAX_CALL:
        return call(scope, syntax, out, diag);
    case SYNTAX_GROUP:
        TRY(convert(scope, syntax->args[0], &a, diag));
        return time_derivative(scope->state, a, syntax->primes, syntax->place, out, diag);
    case SYNTAX_UNARY:
        TRY(convert(scope, syntax->args[0], &a, diag));
        *out = model_operation(arena, syntax->text, a, NULL);
        break;
    case SYNTAX_BINARY:
        TRY(convert(scope, syntax->args[0], &a, diag));
        TRY(convert(scope, syntax->args[1], &b, diag));
        *out = model_operation(arena, syntax->text, a, b);
        break;
    }
    return OK;
}

/* as convert_node(); if the arena refuses the result, reports that at this position */
static Status convert(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag)
{
    Arena *arena = scope->state->arena;
    Status status = convert_node(scope, syntax, out, diag);

    if (status != OK || arena_status(arena) == OK)
        return status;
    status = diag_at(diag, arena_status(arena),
                     syntax->kind == SYNTAX_BINARY ? syntax->op_place : syntax->place, "%s",
                     arena_failure(arena));
    arena_reset(arena);
    return status;
}

/* New nodes permitted for one expression: far above what anybody writes. A law that calls another
 * twice, which calls another twice, and so on, doubles with each. */
enum { MOST_NODES = 1 << 18 };

static Status convert_bounded(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag)
{
    Arena *arena = scope->state->arena;
    const int64_t limit = arena_limit(arena, arena_nodes(arena) + MOST_NODES);
    ArenaMark *mark = arena_mark(arena);
    Status status;

    arena_reset(arena); /* a failure of earlier expressions is no fault of this text */
    status = convert(scope, syntax, out, diag);
    (void)arena_limit(arena, limit);
    if (status == OK) {
        arena_retain(arena, mark);
        return OK;
    }
    arena_release(arena, mark);
    if (status == E_MEMORY)
        diag_hint(diag, "a law that calls another twice doubles it");
    return status;
}

Status scope_expression(Scope *scope, const Syntax *syntax, Expr *out, Diag *diag)
{
    Expr e = NULL;
    Measure measure;
    Status status = convert_bounded(scope, syntax, &e, diag);

    if (status == OK)
        status = measure_of(scope, syntax, &measure, diag);
    if (status == OK)
        *out = e;
    return status;
}

/* --- vectors: literals, and their sums and multiples --- */

static bool is_vector(const Syntax *syntax)
{
    switch (syntax->kind) {
    case SYNTAX_VECTOR:
        return true;
    case SYNTAX_GROUP:
    case SYNTAX_UNARY:
        return is_vector(syntax->args[0]);
    case SYNTAX_BINARY:
        return is_vector(syntax->args[0]) || is_vector(syntax->args[1]);
    default:
        return false;
    }
}

static Status vector_literal(Scope *scope, const Syntax *syntax, Expr **out, int *count, Diag *diag)
{
    Arena *arena = scope->state->arena;
    const int room = syntax->count > 3 ? syntax->count : 3;
    Expr *u = pool_alloc(scope->state->pool, (size_t)room * sizeof *u);

    for (int i = 0; i < syntax->count; i++) {
        TRY(convert(scope, syntax->args[i], &u[i], diag));
        if (syntax->has_unit)
            u[i] = expr_mul(arena, u[i], unit_factor(arena, &syntax->unit));
    }
    *out = u;
    *count = syntax->count;
    return OK;
}

static Status convert_vector(Scope *scope, const Syntax *syntax, Expr **out, int *count,
                             Diag *diag);

static Status vector_binary(Scope *scope, const Syntax *syntax, Expr **out, int *count, Diag *diag)
{
    Arena *arena = scope->state->arena;
    const Syntax *left = syntax->args[0];
    const Syntax *right = syntax->args[1];
    char op = syntax->text[0];
    bool both = is_vector(left) && is_vector(right);
    Expr *u, *other = NULL;
    Expr factor = NULL;
    int n = 0;

    if (both ? op != '+' && op != '-' : op != '*' && (op != '/' || is_vector(right)))
        return diag_at(diag, E_VALUE, syntax->op_place, "'%s' is not between %s", syntax->text,
                       both ? "two vectors" : "a vector and a number in this order");
    TRY(convert_vector(scope, is_vector(left) ? left : right, &u, count, diag));
    if (both) {
        TRY(convert_vector(scope, right, &other, &n, diag));
        if (n != *count)
            return diag_at(diag, E_VALUE, syntax->op_place, "vectors of %d and %d entries", *count,
                           n);
    } else
        TRY(convert(scope, is_vector(left) ? right : left, &factor, diag));
    for (int i = 0; i < *count; i++)
        u[i] = both        ? model_operation(arena, syntax->text, u[i], other[i])
               : op == '*' ? expr_mul(arena, factor, u[i])
                           : expr_div(arena, u[i], factor);
    *out = u;
    return OK;
}

static Status convert_vector(Scope *scope, const Syntax *syntax, Expr **out, int *count, Diag *diag)
{
    Arena *arena = scope->state->arena;

    if (!is_vector(syntax))
        return diag_at(diag, E_VALUE, syntax->place, "a vector is expected here, as in [1, 2, 3]");
    switch (syntax->kind) {
    case SYNTAX_VECTOR:
        return vector_literal(scope, syntax, out, count, diag);
    case SYNTAX_BINARY:
        return vector_binary(scope, syntax, out, count, diag);
    default:
        if (syntax->primes > 0 || strcmp(syntax->text, "!") == 0)
            return diag_at(diag, E_VALUE, syntax->place, "this can't be done with a vector");
        TRY(convert_vector(scope, syntax->args[0], out, count, diag));
        if (syntax->kind == SYNTAX_UNARY && syntax->text[0] == '-')
            for (int i = 0; i < *count; i++)
                (*out)[i] = expr_neg(arena, (*out)[i]);
    }
    return OK;
}

Status scope_vector(Scope *scope, const Syntax *syntax, Expr **out, int *count, Diag *diag)
{
    Measure measure;

    TRY(convert_vector(scope, syntax, out, count, diag));
    return measure_of(scope, syntax, &measure, diag);
}
