/* named_laws.c: laws that equations call by name
 *
 * Equations are sums in which a law can't be recognised: its terms are mixed with others, or merged
 * with like terms. A sum that contains a multiple of the law's longest term, c T, becomes sum - c
 * law + c name, if that is shorter. */
#include "present/named_laws.h"

#include <string.h>

typedef struct Call {
    Expr law, longest; /* of the values that the equations are written in; the longest of its terms
                        */
    Expr symbol;       /* its replacement: D1.law(D1.v) */
} Call;

static char *written(const LawView *view, Expr e)
{
    Text text = {0};

    expr_print(&text, e, view->notation);
    return text_done(&text);
}

static int64_t length_of(Expr e)
{
    return op_count_total(expr_count(&e, 1));
}

static Expr longest_term(Expr law)
{
    Expr longest = law;

    for (int i = 0; expr_kind(law) == EXPR_SUM && i < expr_arg_count(law); i++)
        if (longest == law || length_of(expr_arg(law, i)) > length_of(longest))
            longest = expr_arg(law, i);
    return longest;
}

/* the replacement of e, with replaced arguments */
static Expr call_by_name(Arena *arena, Expr e, void *context)
{
    const Call *call = context;

    for (int i = 0; expr_kind(e) == EXPR_SUM && i < expr_arg_count(e); i++) {
        const Expr ratio = expr_div(arena, expr_arg(e, i), call->longest);
        Expr rest;

        if (!expr_is_number(ratio))
            continue;
        rest = expr_add(arena, e, expr_mul(arena, ratio, expr_sub(arena, call->symbol, call->law)));
        if (length_of(rest) < length_of(e))
            return rest;
    }
    return e == call->law ? call->symbol : e;
}

/* the same in the equations' variables; NULL: they have none for it */
static Expr resolved(const LawView *view, Expr user)
{
    Diag ignored = {0};
    Expr e;

    return system_resolve(view->system, user, &e, &ignored) == OK
               ? expr_open(model_arena(view->model), system_plain(view->system, e))
               : NULL;
}

static Expr named_symbol(const LawView *view, const char *part, const char *argument)
{
    Text name = {0};
    Expr symbol;

    text_addf(&name, "%s.law(%s)", part, argument);
    symbol = expr_symbol(model_arena(view->model), name.at, SYMBOL_ARGUMENT);
    text_free(&name);
    return symbol;
}

/* "D1.law(v)", and below it what v is where equations have an expression for it */
static void define(const LawView *view, const char *part, Expr value, LawDefinitions *out)
{
    char *name = written(view, named_symbol(view, part, "v"));

    for (int i = 0; i < out->count; i++)
        if (out->at[i].value == value) {
            Text names = {0};

            text_addf(&names, "%s = %s", out->at[i].name, name);
            MEM_FREE(out->at[i].name, name);
            out->at[i].name = text_done(&names);
            return;
        }
    LIST_PUSH(*out, (LawDefinition){name, value});
}

/* the law of that edge, where it is in the roots; `across` is the part's own variable */
static void name_law(const LawView *view, const Instance *instance, Expr across, Expr value,
                     Expr *roots, int count, LawDefinitions *out)
{
    Arena *arena = model_arena(view->model);
    const Expr v = resolved(view, across), argument = expr_symbol(arena, "v", SYMBOL_ARGUMENT);
    const bool is_short = v != NULL && expr_kind(v) == EXPR_SYMBOL;
    Call call = {.law = resolved(view, value)};
    bool any = false;

    if (v == NULL || call.law == NULL)
        return;
    call.longest = longest_term(call.law);
    call.symbol = named_symbol(view, instance->name, expr_name(is_short ? v : across));
    for (int i = 0; i < count; i++) {
        const Expr before = roots[i];

        roots[i] = expr_change(arena, expr_open(arena, before), call_by_name, &call);
        if (expr_depends(roots[i], call.symbol))
            any = true;
        else
            roots[i] = before;
    }
    if (!any)
        return;
    define(view, instance->name, expr_substitute(arena, value, &across, &argument, 1), out);
    if (!is_short)
        LIST_PUSH(*out, (LawDefinition){written(view, across), v});
}

static bool is_defined(const DefinedLaws *defined, Expr call)
{
    for (int i = 0; i < defined->count; i++)
        if (defined->at[i] == call)
            return true;
    return false;
}

/* "C2(s)" and "C2'", where they have no definition yet, up to the highest order in `orders` */
static void define_orders(const LawView *view, Expr symbol, unsigned orders, LawDefinitions *out)
{
    Arena *arena = model_arena(view->model);
    const Expr *arguments;
    int count;
    Expr value = model_law(view->model, expr_data(symbol)->file, &arguments, &count);

    for (int order = 0; value != NULL && orders >> (unsigned)order != 0; order++) {
        const Expr call = expr_table(arena, symbol, arguments[0], order);

        if (order > 0)
            value = expr_diff(arena, value, arguments[0]);
        if ((order > 0 && (orders >> (unsigned)order & 1) == 0) || is_defined(view->defined, call))
            continue;
        LIST_PUSH(*view->defined, call);
        LIST_PUSH(*out, (LawDefinition){written(view, call), expr_collect(arena, value)});
    }
}

/* the user's laws that these expressions call */
static void define_called(const LawView *view, const Expr *roots, int count, LawDefinitions *out)
{
    Expr *symbols;
    const int found = expr_tables(roots, count, &symbols);

    for (int k = 0; k < found; k++)
        if (curve_is_law(expr_data(symbols[k])))
            define_orders(view, symbols[k], expr_table_orders(roots, count, symbols[k]), out);
    mem_free(symbols);
}

void named_laws(const LawView *view, Expr *roots, int count, LawDefinitions *out)
{
    Arena *arena = model_arena(view->model);

    for (int i = 0; view->system != NULL && i < model_count(view->model); i++) {
        const Instance *instance = model_instance(view->model, i);
        const Expr zero = expr_int(arena, 0);

        if (!instance->row->has_named_law)
            continue;
        for (int k = 0; k < instance->scalar_count; k++) {
            const Expr across = instance_across(instance, arena, k);
            const Motion1 motion = {zero, zero, across, instance_through(instance, arena, k)};
            Relation relation = {.kind = RELATION_FREE};

            instance->row->relation(instance, arena, k, &motion, &relation);
            if (relation.kind == RELATION_CONDUCTIVE)
                name_law(view, instance, across, relation.value, roots, count, out);
        }
    }
    if (view->defined == NULL)
        return;
    define_called(view, roots, count, out);
    for (int i = 0; i < out->count; i++) /* and those that definitions call */
        define_called(view, &out->at[i].value, 1, out);
}

void named_laws_free(LawDefinitions *laws)
{
    for (int i = 0; i < laws->count; i++)
        mem_free(laws->at[i].name);
    LIST_FREE(*laws);
}
