/* view.c: equations in every notation, and long ones over named subexpressions */
#include "present/view.h"

#include "present/abbreviate.h"
#include "present/latex_lines.h"
#include "present/named_laws.h"
#include "present/tables.h"

#include <ctype.h>
#include <string.h>

const Graph *view_graph(const View *view)
{
    return view->terminal != NULL ? view->terminal->graph : model_graph(view->model);
}

Status view_trees(const View *view, const Tree *trees[TREE_KINDS], Diag *diag)
{
    if (view->terminal == NULL)
        return model_trees(view->model, trees, diag);
    for (int k = 0; k < TREE_KINDS; k++)
        trees[k] = view->terminal->trees[k];
    return OK;
}

const char *view_edge_type(const View *view, int edge)
{
    const int of = view->terminal != NULL ? view->terminal->of.at[edge] : edge;
    const Instance *owner = of >= 0 ? model_edge_owner(view->model, of) : NULL;

    if (of < 0)
        return model_use(view->model, -1 - of)->subsystem->name;
    return owner != NULL ? owner->row->name : "edge";
}

void view_add(Text *out, const View *view, Expr e)
{
    expr_print(out, view->system != NULL ? system_plain(view->system, e) : e, view->page.notation);
}

char *view_expression(const View *view, Expr e)
{
    Text text = {0};

    view_add(&text, view, e);
    return text_done(&text);
}

bool view_is_mechanical(const View *view)
{
    const Graph *graph = model_graph(view->model);

    for (int i = 0; i < graph_edge_count(graph); i++)
        if (graph_edge(graph, i)->domain == DOMAIN_MECHANICAL)
            return true;
    return false;
}

void view_network(Text *out, const System *system)
{
    const int states = system_nx(system), others = system_nz(system);

    if (states > 0)
        layout_count(out, states, "state", "states");
    text_add(out, states > 0 && others > 0 ? ", " : "");
    if (others > 0)
        layout_count(out, others, "algebraic unknown", "algebraic unknowns");
    text_add(out, states + others == 0 ? "no unknowns" : "");
}

void view_freedoms(Text *out, const System *system, int freedoms)
{
    const int nu = system_nu(system), m = system_m(system);
    const int rates = m - system_position_rows(system);

    if (freedoms >= 0 && rates > 0) {
        text_addf(out, "%d degree%s of freedom of motion", freedoms, freedoms == 1 ? "" : "s");
        if (freedoms + m == nu) /* rows are independent: velocity rows take none of place */
            text_addf(out, ", %d of place", freedoms + rates);
    } else if (freedoms >= 0 || m == 0)
        layout_count(out, freedoms >= 0 ? freedoms : nu, "degree of freedom", "degrees of freedom");
    else
        text_addf(out, "n - m = %d", nu - m);
}

char *view_name(const Syntax *syntax)
{
    Text printed = {0}, name = {0};

    syntax_print(&printed, syntax);
    for (const char *c = printed.at; *c != '\0'; c++)
        if (*c != ' ' || c == printed.at || c[-1] != ',')
            text_char(&name, *c);
    text_free(&printed);
    return text_done(&name);
}

/* In digits: the width from which on a left side has a line of its own, and the room of an article
 * after one. All lines of a block start after its widest left side. */
enum { LATEX_LEFT = 10, LATEX_LINE = 55 };

/* a long left side has lines of its own, and the relation starts a new one */
static void add_latex(Text *out, const char *left, const char *relation, const char *right)
{
    const double width = latex_width(left);

    text_add(out, "  ");
    if (relation == NULL) {
        text_add(out, "& ");
        latex_wrap(out, left, LATEX_LINE);
    } else if (width > LATEX_LEFT) {
        text_add(out, "& ");
        latex_wrap(out, left, LATEX_LINE);
        if (width + latex_width(right) > LATEX_LINE)
            text_add(out, " \\\\\n  &\\quad");
        text_add(out, relation);
        latex_wrap(out, right, LATEX_LINE);
    } else {
        text_addf(out, "%s &%s", left, relation);
        latex_wrap(out, right, LATEX_LINE);
    }
    text_add(out, " \\\\\n");
}

enum { SHORT_LEFT = 24 }; /* columns */

/* `left relation right` as a line of the notation, after `lead` in text. LaTeX gets an alignment
 * mark before the relation. */
static void add_line(Text *out, const View *view, const char *lead, const char *left,
                     const char *relation, const char *right)
{
    Text body = {0};
    Page page = view->page;

    switch (view_kind(view)) {
    case NOTATION_TYPESET:
        add_latex(out, left, relation, right);
        return;
    case NOTATION_SOURCE:
        text_addf(out, "%s%s%s;\n", left, relation != NULL ? relation : "",
                  relation != NULL ? right : "");
        return;
    case NOTATION_OUTLINE:
        text_addf(out, "%s%s%s\n%s%s", lead, left, relation != NULL ? relation : "",
                  relation != NULL ? right : "", relation != NULL ? "\n" : "");
        return;
    case NOTATION_READ:
        /* continuation lines are below the right side if the left one is short */
        if (relation != NULL && text_width(lead) + text_width(left) <= SHORT_LEFT) {
            text_addf(&body, "%s%s%s", lead, left, relation);
            layout_formula(out, &page, body.at, right);
        } else {
            text_addf(&body, "%s%s%s", left, relation != NULL ? relation : "",
                      relation != NULL ? right : "");
            layout_formula(out, &page, lead, body.at);
        }
        text_free(&body);
    }
}

void view_open(Text *out, const View *view)
{
    if (view_kind(view) == NOTATION_TYPESET)
        text_add(out, "\\begin{align*}\n");
}

void view_close(Text *out, const View *view)
{
    if (view_kind(view) != NOTATION_TYPESET)
        return;
    /* the last line ends without \\ */
    if (out->length > 4 && strcmp(out->at + out->length - 4, " \\\\\n") == 0) {
        out->length -= 4;
        out->at[out->length] = '\0';
        text_char(out, '\n');
    }
    text_add(out, "\\end{align*}\n");
}

void view_comment(Text *out, const View *view, const char *words)
{
    const NotationRow *row = notation_row(view->page.notation);

    if (row->open != NULL)
        text_addf(out, "%s%s%s\n", row->open, words, row->close);
    else
        layout_words(out, view->page.columns, "", words);
}

char *view_entry_name(const View *view, const char *text, const char *letter, int row, int column)
{
    const int first = notation_row(view->page.notation)->first;
    const bool is_typeset = view_kind(view) == NOTATION_TYPESET;
    const char *open = is_typeset ? "_{" : first == 0 ? "[" : "(";
    const char *close = is_typeset ? "}" : first == 0 ? "]" : ")";
    Text name = {0};

    text_addf(&name, "%s%s%d", is_typeset ? letter : text, open, row + first);
    if (column >= 0)
        text_addf(&name, "%s%d", !is_typeset && first == 0 ? "][" : ",", column + first);
    text_add(&name, close);
    return text_done(&name);
}

/* a prefix with which no name of the user starts, followed by digits */
static const char *free_prefix(const Model *model)
{
    static const char *const prefixes[] = {"w", "v", "z", "w_"};

    for (int p = 0; p + 1 < COUNT(prefixes); p++) {
        const size_t length = strlen(prefixes[p]);
        bool taken = false;
        const char *name;

        for (int i = 0; !taken && (name = model_name(model, i)) != NULL; i++)
            taken = strncmp(name, prefixes[p], length) == 0 && isdigit((unsigned char)name[length]);
        if (!taken)
            return prefixes[p];
    }
    return prefixes[COUNT(prefixes) - 1];
}

void view_bracket(Text *out, const View *view, const char *inside)
{
    text_addf(out, view_kind(view) == NOTATION_TYPESET ? "\\left(%s\\right)" : "(%s)", inside);
}

/* "(a + b)*x", or the coefficient or symbol alone */
static char *write_term(const View *view, const ViewTerm *term)
{
    const Expr c = term->coefficient;
    Text text = {0};
    char *coefficient = view_expression(view, c);

    if (term->symbol != NULL && expr_kind(c) == EXPR_SUM)
        view_bracket(&text, view, coefficient);
    else if (term->symbol == NULL || !(expr_is(c, 1) || expr_is(c, -1)))
        text_add(&text, coefficient);
    else
        text_add(&text, expr_is(c, -1) ? "-" : "");
    if (term->symbol != NULL) {
        if (!(expr_is(c, 1) || expr_is(c, -1)))
            text_add(&text, notation_row(view->page.notation)->times);
        view_add(&text, view, term->symbol);
    }
    mem_free(coefficient);
    return text_done(&text);
}

/* a term's own sign becomes the sum's */
void view_add_sum(Text *out, const View *view, const ViewTerm *terms, int count)
{
    bool any = false;

    for (int i = 0; i < count; i++) {
        char *term;

        if (expr_is_zero(terms[i].coefficient))
            continue;
        term = write_term(view, &terms[i]);
        if (!any)
            text_add(out, term);
        else if (term[0] == '-')
            text_addf(out, " - %s", term + 1 + (term[1] == ' '));
        else
            text_addf(out, " + %s", term);
        any = true;
        mem_free(term);
    }
    text_add(out, any ? "" : "0");
}

static void print_equation(Text *out, const View *view, const ShownEquation *equation)
{
    Text left = {0}, right = {0};

    if (equation->name != NULL)
        text_add(&left, equation->name);
    else
        view_add_sum(&left, view, equation->left.at, equation->left.count);
    view_add_sum(&right, view, equation->right.at, equation->right.count);
    add_line(out, view, equation->lead != NULL ? equation->lead : "", left.at, " = ", right.at);
    text_free(&left);
    text_free(&right);
}

/* left - right = 0 under a name */
static void make_residual(const View *view, ShownEquation *equation, int number)
{
    Arena *arena = model_arena(view->model);
    LIST(ViewTerm) terms = {0};

    if (equation->name != NULL)
        return;
    equation->name = view_entry_name(view, "residual", "r", number, -1);
    for (int i = 0; i < equation->left.count; i++)
        LIST_PUSH(terms, equation->left.at[i]);
    for (int i = 0; i < equation->right.count; i++)
        LIST_PUSH(terms, (ViewTerm){expr_neg(arena, equation->right.at[i].coefficient),
                                    equation->right.at[i].symbol});
    equation->left.count = equation->right.count = 0;
    for (int i = 0; i < terms.count; i++)
        LIST_PUSH(equation->right, terms.at[i]);
    LIST_FREE(terms);
}

static void print_definitions(Text *out, const View *view, const Abbreviation *names)
{
    for (int i = 0; i < names->definitions.count; i++) {
        const Abbreviated *definition = names->definitions.at + i;
        char *right = view_expression(view, definition->value);
        Text left = {0};

        text_add(&left, notation_row(view->page.notation)->fresh);
        view_add(&left, view, definition->symbol);
        add_line(out, view, i == 0 ? "where " : "      ", left.at, " = ", right);
        text_free(&left);
        mem_free(right);
    }
}

static void print_laws(Text *out, const View *view, const LawDefinitions *laws, bool first)
{
    for (int i = 0; i < laws->count; i++) {
        char *right = view_expression(view, laws->at[i].value);

        add_line(out, view, first && i == 0 ? "where " : "      ", laws->at[i].name, " = ", right);
        mem_free(right);
    }
}

/* the selection of the turn of an angle, if terms contain one */
static void print_turns(Text *out, const View *view, const Expr *terms, int count)
{
    Text names = {0}, words = {0};

    for (int i = 0; i < system_multi_turn_count(view->system); i++) {
        const Expr near = system_multi_turn(view->system, i)->reference;
        bool used = false;

        for (int k = 0; !used && k < count; k++)
            used = expr_depends(terms[k], near);
        if (!used)
            continue;
        text_add(&names, names.length > 0 ? ", " : "");
        expr_print(&names, near, view->page.notation);
    }
    if (names.length == 0)
        return;
    if (view_kind(view) == NOTATION_TYPESET)
        text_addf(
            &words,
            "\\text{unwrap}(y, x, a)\\colon\\text{ the angle of }(x, y)\\text{ that is nearest "
            "to }a;\\ %s\\text{: kept less than half a turn from it}",
            names.at);
    else if (view_kind(view) == NOTATION_SOURCE)
        text_addf(&words, "%s: any value less than half a turn from the angle picks its turn",
                  names.at);
    else
        text_addf(&words,
                  "unwrap(y, x, a) is the angle of (x, y) that is nearest to a; runs keep %s less "
                  "than half a turn from the angle",
                  names.at);
    if (view_kind(view) == NOTATION_TYPESET)
        add_line(out, view, "", words.at, NULL, "");
    else
        view_comment(out, view, words.at);
    text_free(&names);
    text_free(&words);
}

/* every term of every equation, in order: what abbreviate() works on */
static int gather(EquationList *equations, Expr **terms, bool *is_long)
{
    LIST(Expr) all = {0};

    *is_long = false;
    for (int i = 0; i < equations->count; i++) {
        ShownEquation *equation = equations->at + i;
        const int from = all.count;

        for (int k = 0; k < equation->left.count; k++)
            LIST_PUSH(all, equation->left.at[k].coefficient);
        for (int k = 0; k < equation->right.count; k++)
            LIST_PUSH(all, equation->right.at[k].coefficient);
        if (!*is_long && all.count > from &&
            op_count_total(expr_count(all.at + from, all.count - from)) > VIEW_BUDGET)
            *is_long = true;
    }
    *terms = all.at;
    return all.count;
}

static void scatter(EquationList *equations, const Expr *terms)
{
    for (int i = 0; i < equations->count; i++) {
        ShownEquation *equation = equations->at + i;

        for (int k = 0; k < equation->left.count; k++)
            equation->left.at[k].coefficient = *terms++;
        for (int k = 0; k < equation->right.count; k++)
            equation->right.at[k].coefficient = *terms++;
    }
}

static void name_laws(const View *view, EquationList *equations, LawDefinitions *laws)
{
    Expr *terms;
    bool ignored;
    const int count = gather(equations, &terms, &ignored);
    const LawView of = {view->model, view->system, view->page.notation, view->defined};

    named_laws(&of, terms, count, laws);
    scatter(equations, terms);
    mem_free(terms);
}

void equations_free(EquationList *equations)
{
    for (int i = 0; i < equations->count; i++) {
        MEM_FREE(equations->at[i].lead, equations->at[i].name);
        LIST_FREE(equations->at[i].left);
        LIST_FREE(equations->at[i].right);
    }
    LIST_FREE(*equations);
}

void view_equations(Text *out, const View *view, EquationList *equations)
{
    const Naming naming = {free_prefix(view->model), 4, 24};
    const bool is_read = view_kind(view) == NOTATION_READ || view_kind(view) == NOTATION_TYPESET;
    Abbreviation names = {0};
    LawDefinitions laws = {0};
    Expr *terms = NULL;
    Text notes = {0};
    bool is_long;
    int count;

    for (int i = 0; view_kind(view) == NOTATION_SOURCE && i < equations->count; i++)
        make_residual(view, equations->at + i, i);
    if (is_read)
        name_laws(view, equations, &laws);
    count = gather(equations, &terms, &is_long);
    for (int i = 0; view->system != NULL && i < count; i++)
        terms[i] = system_plain(view->system, terms[i]);
    scatter(equations, terms);
    if (view->system != NULL)
        print_turns(view_kind(view) == NOTATION_SOURCE ? out : &notes, view, terms, count);
    if (is_long) {
        names = abbreviate(model_arena(view->model), terms, count, &naming);
        scatter(equations, names.roots);
    }
    /* programs need data and names before their use, readers names afterwards */
    tables_print(out, view->page.notation, "", terms, count);
    if (view_kind(view) == NOTATION_SOURCE)
        print_definitions(out, view, &names);
    for (int i = 0; i < equations->count; i++)
        print_equation(out, view, equations->at + i);
    if (view_kind(view) != NOTATION_SOURCE)
        print_definitions(out, view, &names);
    print_laws(out, view, &laws, names.definitions.count == 0);
    text_add(out, notes.at != NULL ? notes.at : "");
    text_free(&notes);
    abbreviation_free(&names);
    named_laws_free(&laws);
    mem_free(terms);
    equations_free(equations);
}

void view_block(Text *out, const View *view, EquationList *equations)
{
    view_open(out, view);
    view_equations(out, view, equations);
    view_close(out, view);
}

double view_unit(const View *view, const char *si, Text *out)
{
    Text chosen = {0};
    Unit unit;
    size_t fault;
    double size = 1;

    if (view->page.units != NULL && unit_parse(si, strlen(si), &unit, &fault))
        size =
            dimension_print_in(&chosen, dimension_without_angle(unit.dimension), view->page.units);
    text_add(out, size == 1 ? si : chosen.at);
    text_free(&chosen);
    return size;
}

void view_quantity(const View *view, const char *name, double value, int digits, Text *out)
{
    static const Dimension none;
    Dimension dimension;
    Text unit = {0};
    double size = 1;

    if (model_text_dimension(view->model, name, &dimension) &&
        memcmp(&dimension, &none, sizeof none) != 0)
        size = dimension_print_in(&unit, dimension_without_angle(dimension),
                                  view->page.units != NULL ? view->page.units : "");
    text_number(out, value / size, digits);
    text_addf(out, unit.length > 0 ? " %s" : "%s", unit.length > 0 ? unit.at : "");
    text_free(&unit);
}

void view_value(EquationList *equations, char *name, Expr e)
{
    ShownEquation equation = {.lead = NULL, .left = {0}, .right = {0}};

    equation.name = name;
    LIST_PUSH(equation.right, (ViewTerm){e, NULL});
    LIST_PUSH(*equations, equation);
}
