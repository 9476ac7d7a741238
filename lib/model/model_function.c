/* model_function.c: calls: functions of the table, pulses and polygons, laws, entries that `show`
 * prints, and figures of a run */
#include "base/decimal.h"
#include "language/foreign_syntax.h"
#include "language/functions.h"
#include "model/model_impl.h"

#include <assert.h>
#include <string.h>

typedef Status Build(Scope *scope, const Syntax *syntax, const Expr *args, Expr *out, Diag *diag);

static Build build_pulse, build_polygon, build_table;

/* builders of the pulse shapes in the table of functions */
static const struct {
    const char *name;
    Build *build;
} builders[] = {{"pulse", build_pulse}, {"pwl", build_polygon}, {"table", build_table}};

/* entries that `show` prints; without a unit here if each has a unit of its own */
static const struct {
    const char *name;
    int args;
    const char *unit;
} entries[] = {
    {"lambda", 1, NULL},          {"mass", 2, NULL},
    {"forces", 1, NULL},          {"constraints", 1, NULL},
    {"jacobian", 2, NULL},        {"velocity", 1, NULL},
    {"acceleration", 1, NULL},    {"modes.omega", 1, "rad/s"},
    {"modes.damping", 1, "1"},    {"linear.A", 2, NULL},
    {"linear.B", 2, NULL},        {"linear.C", 2, NULL},
    {"linear.D", 2, NULL},        {"complement", 2, NULL},
    {"dependent_rates", 2, NULL}, {"embedded_mass", 2, NULL},
    {"embedded_forces", 1, NULL},
};

const char *entry_unit(const char *name)
{
    for (int i = 0; i < COUNT(entries); i++)
        if (strcmp(entries[i].name, name) == 0)
            return entries[i].unit;
    return NULL;
}

static Status wrong_count(const Syntax *syntax, const char *usage, Diag *diag)
{
    (void)diag_at(diag, E_VALUE, syntax->place, "%s does not take %d argument%s", syntax->text,
                  syntax->count, syntax->count == 1 ? "" : "s");
    diag_hint(diag, "it is written %s", usage);
    return E_VALUE;
}

/* --- pulses, from two edges, and polygons --- */

/* From 0 at x = 0 to 1 at x = width, with exactly these values before and after, so that a pulse
 * ends at exactly 0. For width 0 it is a step. */
static Expr edge(Arena *arena, Expr x, Expr width)
{
    if (expr_is_zero(width))
        return expr_call1(arena, OP_STEP, x);
    return expr_call1(arena, OP_RAMP,
                      expr_call2(arena, OP_MIN, expr_int(arena, 1), expr_div(arena, x, width)));
}

static Status build_pulse(Scope *scope, const Syntax *syntax, const Expr *args, Expr *out,
                          Diag *diag)
{
    Arena *arena = scope->state->arena;
    Expr x = expr_sub(arena, args[0], args[3]);
    Expr low = args[1];
    Expr top;
    Expr shape;
    Expr wave;

    for (int i = 3; i < syntax->count; i++)
        if (expr_is_number(args[i]) && expr_value(args[i]) < 0.0)
            return diag_at(diag, E_VALUE, syntax->args[i]->place,
                           "times of a pulse aren't negative");
    if (syntax->count == 8) {
        if (expr_is_zero(args[7]))
            return diag_at(diag, E_VALUE, syntax->args[7]->place, "the period is zero");
        x = expr_sub(
            arena, x,
            expr_mul(arena, args[7], expr_call1(arena, OP_FLOOR, expr_div(arena, x, args[7]))));
    }
    top = expr_add(arena, args[4], args[6]);
    shape = expr_sub(arena, edge(arena, x, args[4]), edge(arena, expr_sub(arena, x, top), args[5]));
    wave = expr_add(arena, low, expr_mul(arena, expr_sub(arena, args[2], low), shape));
    *out = expr_if(arena, expr_call2(arena, OP_LT, args[0], args[3]), low, wave);
    return OK;
}

/* The polygon through points from..to, by bisection: as deep as the logarithm of their number. */
static Expr polygon(Arena *arena, Expr t, const Expr *points, int from, int to)
{
    int middle = (from + to) / 2;
    Expr t0 = points[2 * from];
    Expr v0 = points[2 * from + 1];

    if (to - from > 1)
        return expr_if(arena, expr_call2(arena, OP_LT, t, points[2 * middle]),
                       polygon(arena, t, points, from, middle),
                       polygon(arena, t, points, middle, to));
    if (points[2 * to] == t0)
        return points[2 * to + 1];
    return expr_add(arena, v0,
                    expr_mul(arena, expr_sub(arena, t, t0),
                             expr_div(arena, expr_sub(arena, points[2 * to + 1], v0),
                                      expr_sub(arena, points[2 * to], t0))));
}

static Status build_polygon(Scope *scope, const Syntax *syntax, const Expr *args, Expr *out,
                            Diag *diag)
{
    Arena *arena = scope->state->arena;
    const Expr *points = args + 1;
    int count = (syntax->count - 1) / 2;
    int last = 2 * (count - 1);
    Expr inside;

    if (syntax->count % 2 == 0)
        return wrong_count(syntax, "pwl(t, t0, v0, t1, v1, ...)", diag);
    for (int j = 2; j < 2 * count; j += 2)
        if (expr_is_number(points[j]) && expr_is_number(points[j - 2]) &&
            expr_value(points[j]) < expr_value(points[j - 2]))
            return diag_at(diag, E_VALUE, syntax->args[j + 1]->place,
                           "the times of pwl have to grow");
    if (count == 1) {
        *out = points[1];
        return OK;
    }
    inside = polygon(arena, args[0], points, 0, count - 1);
    inside =
        expr_if(arena, expr_call2(arena, OP_LT, args[0], points[last]), inside, points[last + 1]);
    *out = expr_if(arena, expr_call2(arena, OP_LT, args[0], points[0]), points[1], inside);
    return OK;
}

/* the order of a derivative must be a permitted whole number */
static bool is_order(Expr e)
{
    int64_t num, den;

    return expr_rational_parts(e, &num, &den) && den == 1 && num >= 0 && num < CURVE_ORDERS;
}

static Status build_table(Scope *scope, const Syntax *syntax, const Expr *args, Expr *out,
                          Diag *diag)
{
    Arena *arena = scope->state->arena;
    const Syntax *column = syntax->count > 2 ? syntax->args[2] : NULL;
    Expr data;

    if (syntax->args[0]->kind != SYNTAX_STRING || args[1] == NULL)
        return wrong_count(syntax, "table(\"file.csv\", x, column)", diag);
    if (column != NULL && column->kind != SYNTAX_STRING && column->kind != SYNTAX_NUMBER)
        return diag_at(diag, E_VALUE, column->place,
                       "a column is a number from 1 or a name in quotes");
    if (syntax->count > 3 && (args[3] == NULL || !is_order(args[3])))
        return diag_at(diag, E_VALUE, syntax->args[3]->place,
                       "a curve has derivatives of order 1, 2 and 3");
    data = arena_find_table(arena, syntax->args[0]->text, data_column(syntax));
    if (data == NULL)
        return diag_at(diag, E_MISSING, syntax->args[0]->place, "'%s' hasn't been read",
                       syntax->args[0]->text);
    *out = expr_table(arena, data, args[1], syntax->count > 3 ? (int)expr_value(args[3]) : 0);
    return OK;
}

/* --- other calls --- */

static Status call_function(Scope *scope, const Syntax *syntax, const Function *row,
                            const Expr *args, Expr *out, Diag *diag)
{
    Arena *arena = scope->state->arena;
    bool folds = row->most > row->least;

    if (syntax->count < row->least || syntax->count > row->most) {
        (void)diag_at(diag, E_VALUE, syntax->place, "%s takes %d argument%s%s, got %d",
                      syntax->text, row->least, row->least == 1 ? "" : "s", folds ? " or more" : "",
                      syntax->count);
        return E_VALUE;
    }
    *out = expr_call(arena, row->op, args);
    for (int i = row->least; i < syntax->count; i++)
        *out = expr_call2(arena, row->op, *out, args[i]);
    return OK;
}

/* each of its points is evaluated in each step */
static Status too_long(const Syntax *syntax, Diag *diag)
{
    (void)diag_at(diag, E_VALUE, syntax->place, "%s with %d points is too long", syntax->text,
                  syntax->count / 2);
    diag_hint(diag, "table(\"data.csv\", t) makes a curve through the points of a file");
    return E_VALUE;
}

/* the body of a law that is called by name, or a derivative of it, at its argument */
static Expr open_call(Arena *arena, Expr e, void *context)
{
    const State *state = context;
    const Curve *curve =
        expr_kind(e) == EXPR_CALL && expr_op(e) == OP_TABLE ? expr_data(expr_arg(e, 0)) : NULL;
    const Definition *law;
    Expr body, at;

    if (curve == NULL || !curve_is_law(curve))
        return e;
    law = definition_find((State *)state, curve->file, DEFINES_LAW);
    body = law->body;
    at = expr_arg(e, 1);
    for (int order = (int)expr_value(expr_arg(e, 2)); order > 0; order--)
        body = expr_diff(arena, body, law->arguments[0]);
    return expr_substitute(arena, body, law->arguments, &at, 1);
}

/* without calls by name, also of laws that laws call */
static Expr open_laws(const State *state, Expr e)
{
    for (Expr before = NULL; e != before;) {
        before = e;
        e = expr_change(state->arena, e, open_call, (void *)state);
    }
    return e;
}

/* Numbers, initial values and conditions need the law itself. */
static bool is_called_by_name(const Scope *scope, const Definition *law)
{
    return scope->state->has_named_laws && law->argument_count == 1 &&
           (scope->kind == SCOPE_EFFORT || scope->kind == SCOPE_DRIVE || scope->kind == SCOPE_LAW ||
            scope->kind == SCOPE_OUTPUT || scope->kind == SCOPE_ASK);
}

static Status call_law(Scope *scope, const Syntax *syntax, int index, const Expr *args, Expr *out,
                       Diag *diag)
{
    Arena *arena = scope->state->arena;
    const Definition *law = &scope->state->definitions.at[index];

    if (law->kind != DEFINES_LAW) {
        (void)diag_at(diag, E_NAME, syntax->place, "%s is no law and no function", law->name);
        diag_hint(diag, "a product is written %s*(...)", law->name);
        return E_NAME;
    }
    if (syntax->count != law->argument_count)
        return diag_at(diag, E_VALUE, syntax->place, "%s takes %d argument%s, got %d", law->name,
                       law->argument_count, law->argument_count == 1 ? "" : "s", syntax->count);
    scope_use(scope, index);
    if (is_called_by_name(scope, law)) {
        *out = expr_table(arena, arena_add_law(arena, law->name, expr_name(law->arguments[0])),
                          args[0], 0);
        return OK;
    }
    *out = expr_substitute(arena, law->body, law->arguments, args, syntax->count);
    if (scope->state->has_named_laws && scope->kind != SCOPE_LAW)
        *out = open_laws(scope->state, *out);
    return OK;
}

/* mass(2,2): a variable with that name, its numbers without blanks */
static Status call_entry(Scope *scope, const Syntax *syntax, int wanted, const Expr *args,
                         Expr *out, Diag *diag)
{
    Text name = {0};
    Status status = OK;

    if (scope->kind != SCOPE_ASK && scope->kind != SCOPE_OUTPUT && scope->kind != SCOPE_EVENT)
        return diag_at(diag, E_NAME, syntax->place,
                       "%s can be printed, but nothing can depend on it", syntax->text);
    if (syntax->count != wanted)
        return diag_at(diag, E_VALUE, syntax->place, "%s takes %d number%s, got %d", syntax->text,
                       wanted, wanted == 1 ? "" : "s", syntax->count);
    text_add(&name, syntax->text);
    for (int i = 0; i < wanted; i++) {
        int64_t num;
        int64_t den;

        if (!expr_rational_parts(args[i], &num, &den) || den != 1 || num < 1) {
            status = diag_at(diag, E_VALUE, syntax->args[i]->place,
                             "an entry of %s is picked by whole numbers from 1", syntax->text);
            goto done;
        }
        text_addf(&name, "%c%lld", i == 0 ? '(' : ',', (long long)num);
    }
    text_char(&name, ')');
    *out = expr_symbol(scope->state->arena, name.at, SYMBOL_VARIABLE);
done:
    text_free(&name);
    return status;
}

/* b1.v(L/2): a variable with that name, and the position as its current number */
static Status call_deflection(Scope *scope, const Syntax *syntax, const Instance *part,
                              const char *member, const Expr *args, Expr *out, Diag *diag)
{
    const double length = state_number_now(scope->state, instance_scalar(part, "length"));
    char place[DECIMAL_SIZE];
    Text name = {0};
    double at;

    if (scope->kind != SCOPE_ASK && scope->kind != SCOPE_OUTPUT && scope->kind != SCOPE_EVENT) {
        (void)diag_at(diag, E_NAME, syntax->place,
                      "%s can be printed, but nothing can depend on it", syntax->text);
        diag_hint(diag,
                  "a frame there can be watched: arm a %s at=..., then a.y, or the coordinate of a "
                  "virtual joint to it",
                  part->name);
        return E_NAME;
    }
    if (syntax->count != 1 || (expr_kinds(args[0]) & ~(1U << SYMBOL_PARAMETER)) != 0) {
        (void)diag_at(diag, E_VALUE, syntax->place, "%s takes one place along the beam",
                      syntax->text);
        diag_hint(diag, "a number or an expression of parameters, such as %s(%g)", syntax->text,
                  length / 2);
        return E_VALUE;
    }
    at = state_number_now(scope->state, args[0]);
    if (!(at >= 0 && at <= length * (1 + 1e-12))) {
        (void)diag_at(diag, E_VALUE, syntax->args[0]->place, "%g is off %s, which is %g long", at,
                      part->name, length);
        diag_hint(diag, "places go from 0, the root, to the length");
        return E_VALUE;
    }
    (void)decimal_print(place, at, DECIMAL_EXACT);
    text_addf(&name, "%s.%s(%s)", part->name, member, place);
    *out = expr_symbol(scope->state->arena, name.at, SYMBOL_VARIABLE);
    text_free(&name);
    return OK;
}

/* max(h8): a variable with that name, its argument as printed */
static Status call_figure(Scope *scope, const Syntax *syntax, const Expr *args, Expr *out,
                          Diag *diag)
{
    Text name = {0};

    if (scope->kind != SCOPE_ASK)
        return diag_at(diag, E_NAME, syntax->place,
                       "%s%s is taken over a run: nothing can depend on it", syntax->text,
                       syntax->count == 1 ? " of one argument" : "");
    if (syntax->count != (strcmp(syntax->text, "settling") == 0 ? 2 : 1))
        return wrong_count(syntax, "mean(x), settling(x, band): over the last run", diag);
    text_addf(&name, "%s(", syntax->text);
    for (int i = 0; i < syntax->count; i++) {
        text_add(&name, i > 0 ? ", " : "");
        expr_print(&name, args[i], NOTATION_TEXT);
    }
    text_char(&name, ')');
    *out = expr_symbol(scope->state->arena, name.at, SYMBOL_VARIABLE);
    text_free(&name);
    return OK;
}

static Status call_unknown(const State *state, const Syntax *syntax, Diag *diag)
{
    Suggest suggest = suggest_for(syntax->text);
    const Thing *thing = state_thing(state, syntax->text);
    const char *member;
    const Instance *owner = state_owner(state, syntax->text, &member);
    const Instance *bent = owner != NULL && instance_bends(owner) ? owner : NULL;
    Function row;
    Text what = {0};

    if (thing != NULL) {
        name_describe(state, thing, &what);
        (void)diag_at(diag, E_NAME, syntax->place, "%s is %s, not a law or function", syntax->text,
                      what.at);
        diag_hint(diag, "a product is written %s*(...)", syntax->text);
        text_free(&what);
        return E_NAME;
    }
    for (int i = 0; function_at(i, &row); i++)
        if (row.kind != FUNCTION_FIGURE)
            suggest_offer(&suggest, row.name);
    for (int i = 0; i < state->definitions.count; i++)
        if (state->definitions.at[i].kind == DEFINES_LAW)
            suggest_offer(&suggest, state->definitions.at[i].name);
    (void)diag_at(diag, E_NAME, syntax->place, "unknown function '%s'", syntax->text);
    if (bent != NULL)
        diag_hint(diag,
                  "of a place along %s there are u, v%s, and what its sections carry: 'info "
                  "%s' lists them",
                  bent->name, state->setup.planar ? "" : ", w, phi", bent->name);
    else if (foreign_syntax_hint(FOREIGN_FUNCTION, syntax->text) != NULL)
        diag_hint(diag, "%s", foreign_syntax_hint(FOREIGN_FUNCTION, syntax->text));
    else if (suggest.best != NULL)
        diag_hint(diag, "did you mean '%s'?", suggest.best);
    else
        diag_hint(diag, "'help functions' lists them");
    return E_NAME;
}

static Status call_shape(Scope *scope, const Syntax *syntax, const Function *row, const Expr *args,
                         Expr *out, Diag *diag)
{
    Build *build = NULL;

    for (int i = 0; i < COUNT(builders); i++)
        if (strcmp(builders[i].name, row->name) == 0)
            build = builders[i].build;
    assert(build != NULL);
    if (syntax->count > row->most && build == build_polygon)
        return too_long(syntax, diag);
    if (syntax->count < row->least || syntax->count > row->most)
        return wrong_count(syntax, row->usage, diag);
    return build(scope, syntax, args, out, diag);
}

Status function_call(Scope *scope, const Syntax *syntax, const Expr *args, Expr *out, Diag *diag)
{
    const Thing *thing = state_thing(scope->state, syntax->text);
    const Instance *bent;
    const char *member;
    bool is_known;
    Function row;

    is_known = function_find(syntax->text, &row);
    if (function_is_figure(syntax->text) && (!is_known || syntax->count == 1))
        return call_figure(scope, syntax, args, out, diag);
    if (is_known && row.kind == FUNCTION_OPERATION)
        return call_function(scope, syntax, &row, args, out, diag);
    if (is_known)
        return call_shape(scope, syntax, &row, args, out, diag);
    if (thing != NULL && thing->kind == THING_DEFINITION)
        return call_law(scope, syntax, thing->index, args, out, diag);
    for (int i = 0; i < COUNT(entries); i++)
        if (strcmp(entries[i].name, syntax->text) == 0)
            return call_entry(scope, syntax, entries[i].args, args, out, diag);
    bent = part_along(scope->state, syntax->text, &member);
    if (bent != NULL)
        return call_deflection(scope, syntax, bent, member, args, out, diag);
    return call_unknown(scope->state, syntax, diag);
}

bool model_call_takes_text(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_CALL && function_takes_text(syntax->text);
}
