/* show_response.c: transfer functions and equivalents of linear networks, in symbols */
#include "formulate/reduced/response.h"
#include "present/show.h"

#include <string.h>

/* --- a product of polynomials in s --- */

static bool is_typeset(const View *view)
{
    return view_kind(view) == NOTATION_TYPESET;
}

/* "R*C*s^2 + (R + 1)*s + 1" */
static void add_polynomial(Text *out, const View *view, const Factor *factor, Expr s)
{
    Arena *arena = model_arena(view->model);
    LIST(ViewTerm) terms = {0};

    for (int k = 0; k <= factor->degree; k++) {
        const int power = factor->degree - k;

        LIST_PUSH(terms, (ViewTerm){factor->at[k],
                                    power > 0 ? expr_pow(arena, s, expr_int(arena, power)) : NULL});
    }
    view_add_sum(out, view, terms.at, terms.count);
    LIST_FREE(terms);
}

static int terms_of(const Factor *factor)
{
    int terms = 0;

    for (int k = 0; k <= factor->degree; k++)
        terms += !expr_is_zero(factor->at[k]);
    return terms;
}

static bool is_sum(const Factor *factor)
{
    return terms_of(factor) > 1 || (factor->degree == 0 && expr_kind(factor->at[0]) == EXPR_SUM);
}

/* *is_single: no operator in it binds less than a power's base needs */
static void add_product(Text *out, const View *view, const Product *product, Expr s,
                        bool *is_single)
{
    const char *times = notation_row(view->page.notation)->times;
    const int count = product->factors.count;
    bool any = false;

    *is_single = count == 0;
    for (int i = 0; i < count; i++) {
        const Factor *factor = &product->factors.at[i];
        const bool brackets = is_sum(factor) && (count > 1 || factor->times > 1);
        Text text = {0};

        if (factor->degree == 0 && expr_is(factor->at[0], 1) && count > 1)
            continue;
        if (factor->degree == 0 && expr_is(factor->at[0], -1) && count > 1) {
            text_char(out, '-');
            continue;
        }
        add_polynomial(&text, view, factor, s);
        text_add(out, any ? times : "");
        if (brackets)
            view_bracket(out, view, text.at);
        else
            text_add(out, text.at);
        if (factor->times > 1)
            text_addf(out, is_typeset(view) ? "^{%d}" : "^%d", factor->times);
        *is_single =
            count == 1 &&
            (brackets || (strpbrk(text.at, "+-/ ") == NULL && strstr(text.at, times) == NULL));
        any = true;
        text_free(&text);
    }
    if (!any)
        text_char(out, '1');
}

static bool is_one(const Product *product)
{
    return product->factors.count == 0 ||
           (product->factors.count == 1 && product->factors.at[0].degree == 0 &&
            expr_is(product->factors.at[0].at[0], 1));
}

static bool is_zero(const PolynomialRatio *ratio)
{
    const Product *over = &ratio->over;

    return over->factors.count > 0 && over->factors.at[0].degree == 0 &&
           expr_is_zero(over->factors.at[0].at[0]);
}

static void add_ratio(Text *out, const View *view, const PolynomialRatio *ratio, Expr s)
{
    Text over = {0}, under = {0};
    bool over_is_single, under_is_single;

    add_product(&over, view, &ratio->over, s, &over_is_single);
    add_product(&under, view, &ratio->under, s, &under_is_single);
    if (is_one(&ratio->under) || is_zero(ratio)) {
        text_add(out, over.at);
    } else if (is_typeset(view)) {
        text_addf(out, "\\frac{%s}{%s}", over.at, under.at);
    } else {
        const bool brackets = ratio->over.factors.count == 1 && is_sum(&ratio->over.factors.at[0]);

        text_addf(out, brackets ? "(%s)/" : "%s/", over.at);
        text_addf(out, under_is_single ? "%s" : "(%s)", under.at);
    }
    text_free(&over);
    text_free(&under);
}

/* the same as an expression, for what computes it */
static Expr product_expression(Arena *arena, const Product *product, Expr s)
{
    Expr out = expr_int(arena, 1);

    for (int i = 0; i < product->factors.count; i++) {
        const Factor *factor = &product->factors.at[i];
        Expr sum = expr_int(arena, 0);

        for (int k = 0; k <= factor->degree; k++)
            sum = expr_add(arena, sum,
                           expr_mul(arena, factor->at[k],
                                    expr_pow(arena, s, expr_int(arena, factor->degree - k))));
        out = expr_mul(arena, out, expr_pow(arena, sum, expr_int(arena, factor->times)));
    }
    return out;
}

/* --- what is printed of a response --- */

/* "left/source = ratio", or where it is over a current or voltage at a port "left = -ratio" */
static void print_ratio(Text *out, const View *view, const char *left, const char *source,
                        const char *code, const Response *response, int i)
{
    const PolynomialRatio *ratio = &response->ratio[i];
    Text name = {0}, body = {0};

    if (view_kind(view) == NOTATION_SOURCE || view_kind(view) == NOTATION_OUTLINE) {
        Arena *arena = model_arena(view->model);
        EquationList equations = {0};

        text_add(&name, code);
        if (source != NULL && response->count > 1)
            text_addf(&name, "_%s", source);
        view_value(&equations, text_done(&name),
                   expr_div(arena, product_expression(arena, &ratio->over, response->s),
                            product_expression(arena, &ratio->under, response->s)));
        view_equations(out, view, &equations);
        return;
    }
    add_ratio(&body, view, ratio, response->s);
    if (is_typeset(view)) {
        text_addf(out, source != NULL ? "\\frac{%s}{%s}" : "%s%s", left,
                  source != NULL ? source : "");
        text_addf(out, " &= %s \\\\\n", body.at);
    } else {
        text_add(&name, left);
        if (source != NULL)
            text_addf(&name, "/%s", source);
        text_add(&name, " = ");
        layout_formula(out, &view->page, name.at, body.at);
    }
    text_free(&name);
    text_free(&body);
}

static char *source_name(const View *view, Expr source)
{
    return view_kind(view) == NOTATION_TYPESET
               ? view_expression(view, source)
               : mem_text(expr_name(source), strlen(expr_name(source)));
}

/* --- one transfer function --- */

static Status print_transfer(const View *view, const Syntax *output, const Syntax *input, Text *out,
                             Diag *diag)
{
    Response *response = NULL;
    Scene scene = {0};
    char *name = view_name(output), *left = NULL, *source = NULL;
    Expr user;
    Status status;

    diag->place = output->place;
    CHECK(model_expression(view->model, output, &user, diag));
    CHECK(model_scene(view->model, &scene, diag));
    status = response_new(&scene, user, name, input->text, view->watch, &response, diag);
    if (status == E_NAME && diag->place.line == 0)
        diag->place = strstr(diag->message, input->text) != NULL ? input->place : output->place;
    CHECK(status);
    left = is_typeset(view) ? view_expression(view, user) : mem_text(name, strlen(name));
    source = source_name(view, response->source[0]);
    view_open(out, view);
    print_ratio(out, view, left, source, "H", response, 0);
    view_close(out, view);
done:
    response_free(response);
    scene_free(&scene);
    MEM_FREE(name, left, source);
    return status;
}

Status show_symbolic_transfer(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Syntax *const *items = selection->items;

    if (items[1] == NULL) {
        (void)diag_set(diag, E_SYNTAX, "a transfer function in symbols has an output and an input");
        diag_hint(diag, "show transfer C1.v V1");
        return E_SYNTAX;
    }
    if (items[1]->kind != SYNTAX_VARIABLE || items[1]->primes > 0)
        return diag_at(diag, E_SYNTAX, items[1]->place, "an input is a source's name");
    return print_transfer(view, items[0], items[1], out, diag);
}

/* --- equivalents of what is seen between two terminals --- */

#define TEST_SOURCE "port__source"

typedef struct TestPort {
    const char *plus, *minus;
    Domain domain;
    bool is_norton;
} TestPort;

static bool is_datum(const char *name)
{
    return strcmp(name, "0") == 0 || strcmp(name, "gnd") == 0;
}

static Status find_terminal(const View *view, const Syntax *syntax, Domain *domain, Diag *diag)
{
    const Graph *graph = model_graph(view->model);
    const bool is_name = (syntax->kind == SYNTAX_VARIABLE && syntax->primes == 0) ||
                         (syntax->kind == SYNTAX_NUMBER && is_datum(syntax->text));
    const int node = is_name ? graph_find_node(graph, syntax->text) : -1;
    Suggest suggest = suggest_for(is_name ? syntax->text : "");

    if (is_name && is_datum(syntax->text))
        return OK;
    if (node >= 0 && graph_node(graph, node)->domain != DOMAIN_MECHANICAL) {
        if (*domain != DOMAIN_MECHANICAL && *domain != graph_node(graph, node)->domain)
            return diag_at(diag, E_MODEL, syntax->place, "'%s' is a terminal of another domain",
                           syntax->text);
        *domain = graph_node(graph, node)->domain;
        return OK;
    }
    for (int i = 0; i < graph_node_count(graph); i++)
        if (graph_node(graph, i)->domain != DOMAIN_MECHANICAL)
            suggest_offer(&suggest, graph_node(graph, i)->name);
    diag_at(diag, E_NAME, syntax->place,
            node >= 0 ? "'%s' is a frame, not a terminal" : "no terminal is called '%s'",
            is_name ? syntax->text : "...");
    suggest_or_hint(&suggest, diag, "'show nodes' lists them");
    return E_NAME;
}

static Status read_port(const View *view, const Selection *selection, TestPort *port, Diag *diag)
{
    const Syntax *const *items = selection->ports;

    port->domain = DOMAIN_MECHANICAL;
    if (selection->port_count != 2 || selection->has_of || selection->at != NULL ||
        selection->networks != NETWORKS_AS_POSSIBLE) {
        (void)diag_set(diag, E_SYNTAX,
                       selection->port_count != 2
                           ? "an equivalent is that of two terminals, or of frames"
                           : "'of', 'at' and 'networks' go with frames; these are terminals");
        diag_hint(diag, "show %s out 0; of a mechanism, show %s FRAME",
                  port->is_norton ? "norton" : "thevenin", port->is_norton ? "norton" : "thevenin");
        return E_SYNTAX;
    }
    for (int i = 0; i < 2; i++)
        TRY(find_terminal(view, items[i], &port->domain, diag));
    port->plus = items[0]->text;
    port->minus = items[1]->text;
    if (strcmp(port->plus, port->minus) == 0 || (is_datum(port->plus) && is_datum(port->minus)))
        return diag_at(diag, E_MODEL, items[1]->place, "an equivalent is that of two terminals");
    return OK;
}

/* a model that has the test source too */
static Status write_source(const View *view, const TestPort *port, Model **fork, Diag *diag)
{
    Statement *statement = NULL;
    Text text = {0};
    Status status;

    text_addf(&text, model_source_statement(port->domain, port->is_norton), TEST_SOURCE, port->plus,
              port->minus, "0");
    CHECK(model_fork(view->model, fork, diag));
    model_open_insides(*fork);
    CHECK(statement_parse(text.at, 1, (SyntaxOptions){false}, NULL, &statement, diag));
    CHECK(model_apply(*fork, statement, diag));
done:
    diag->place = (Place){0};
    statement_free(statement);
    text_free(&text);
    return status;
}

/* A source that fits no tree, or that the equations don't determine: the other equivalent
 * exists. */
static Status no_equivalent(const TestPort *port, Status status, Diag *diag)
{
    if (status != E_SINGULAR && strstr(diag->message, TEST_SOURCE) == NULL)
        return status;
    (void)diag_set(diag, E_MODEL,
                   port->is_norton
                       ? "the %s between %s and %s is given, whatever flows: there is no Norton "
                         "equivalent"
                       : "nothing lets the %s between %s and %s follow: there is no Thevenin "
                         "equivalent",
                   port->is_norton ? domain_across(port->domain) : domain_through(port->domain),
                   port->plus, port->minus);
    diag_hint(diag, "'show %s %s %s' shows the other one", port->is_norton ? "thevenin" : "norton",
              port->plus, port->minus);
    return E_MODEL;
}

static void print_equivalent(const View *view, const TestPort *port, Response *response, Text *out)
{
    const char *const across = domain_across(port->domain), *through = domain_through(port->domain);
    const char *const open = port->is_norton ? "J" : "E", *inner = port->is_norton ? "Y" : "Z";
    Arena *arena = model_arena(view->model);
    Text line = {0};
    bool any = false;

    text_addf(&line, "%s = %s - %s %s, %s from %s to %s, %s out of the network at %s",
              port->is_norton ? through : across, open, inner, port->is_norton ? across : through,
              across, port->plus, port->minus, through, port->plus);
    if (view_kind(view) == NOTATION_READ)
        text_addf(out, "%s\n", line.at);
    else
        view_comment(out, view, line.at);
    view_open(out, view);
    for (int i = 0; i < response->count; i++) {
        PolynomialRatio *ratio = &response->ratio[i];
        const bool is_test = strcmp(expr_name(response->source[i]), TEST_SOURCE) == 0;
        char *source = source_name(view, response->source[i]);

        /* v = E - Z i; but of isource, a source's value flows out of its first terminal */
        if (is_test && !is_zero(ratio) && (port->is_norton || port->domain == DOMAIN_ELECTRICAL))
            ratio_negate(arena, ratio);
        if (is_test || !is_zero(ratio))
            print_ratio(out, view, is_test ? inner : open, is_test ? NULL : source,
                        is_test ? inner : open, response, i);
        any = any || (!is_test && !is_zero(ratio));
        mem_free(source);
    }
    if (!any && view_kind(view) == NOTATION_READ)
        text_addf(out, "%s = 0\n", open);
    view_close(out, view);
    text_free(&line);
}

static Status show_equivalent(const View *view, const Selection *selection, bool is_norton,
                              Text *out, Diag *diag)
{
    TestPort port = {.is_norton = is_norton};
    ArenaMark *mark = arena_mark(model_arena(view->model));
    Arena *arena = model_arena(view->model);
    Response *response = NULL;
    Model *fork = NULL;
    Scene scene = {0};
    Text output = {0};
    Status status;

    CHECK(read_port(view, selection, &port, diag));
    CHECK(write_source(view, &port, &fork, diag));
    CHECK(model_scene(fork, &scene, diag));
    text_addf(&output, TEST_SOURCE ".%s",
              is_norton ? domain_through(port.domain) : domain_across(port.domain));
    status = response_new(&scene, expr_symbol(arena, output.at, SYMBOL_VARIABLE), output.at, NULL,
                          view->watch, &response, diag);
    CHECK(status == OK ? OK : no_equivalent(&port, status, diag));
    print_equivalent(view, &port, response, out);
done:
    text_free(&output);
    response_free(response);
    scene_free(&scene);
    model_free(fork);
    arena_release(arena, mark);
    return status;
}

static bool has_frames(const Graph *graph)
{
    for (int i = 0; i < graph_node_count(graph); i++)
        if (graph_node(graph, i)->domain == DOMAIN_MECHANICAL && !graph_node(graph, i)->datum)
            return true;
    return false;
}

/* Whether frames are meant: one is named, or no terminal is where there are frames. */
static bool is_mechanical_port(const View *view, const Selection *selection)
{
    const Graph *graph = model_graph(view->model);
    bool has_terminal = selection->port_count == 0;

    for (int i = 0; i < selection->port_count; i++) {
        const char *name = selection->ports[i]->text;
        const int node = graph_find_node(graph, name);

        if (port_is_frame(view, selection->ports[i]))
            return true;
        has_terminal = has_terminal || is_datum(name) || node >= 0;
    }
    return !has_terminal && has_frames(graph);
}

Status show_thevenin(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    if (is_mechanical_port(view, selection))
        return show_port(view, selection, false, out, diag);
    return show_equivalent(view, selection, false, out, diag);
}

Status show_norton(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    if (is_mechanical_port(view, selection))
        return show_port(view, selection, true, out, diag);
    return show_equivalent(view, selection, true, out, diag);
}
