/* show_state.c: state equations of a linear network, in symbols */
#include "formulate/reduced/state_space.h"
#include "present/show.h"

#include <string.h>

/* A matrix of symbols: its name in text and in LaTeX, and the labels at its sides. */
typedef struct Matrix {
    const char *name, *latex;
    const Expr *at;
    int rows, columns, order; /* order: derivatives of its columns' symbols */
    const Expr *row_symbols, *column_symbols;
} Matrix;

enum { MATRICES = 1 + INPUT_ORDERS };

/* those that are there: A, and what isn't 0 of the others; B always where there are inputs */
static int matrices_of(const StateSpace *space, Matrix out[MATRICES])
{
    static const char *const names[] = {"B", "B1", "B2"};
    static const char *const latex[] = {"B", "B_1", "B_2"};
    int count = 0;

    out[count++] =
        (Matrix){"A", "A", space->a, space->states, space->states, 0, space->state, space->state};
    for (int order = 0; order < INPUT_ORDERS; order++)
        if (space->has[order] || (order == 0 && space->inputs > 0))
            out[count++] = (Matrix){names[order],  latex[order], space->b[order], space->states,
                                    space->inputs, order,        space->state,    space->input};
    return count;
}

/* "E1''" */
static void add_symbol(Text *out, const View *view, Expr symbol, int primes)
{
    view_add(out, view, symbol);
    text_fill(out, '\'', primes);
}

static void symbol_cell(Table *table, const View *view, Expr symbol, int primes)
{
    Text text = {0};

    add_symbol(&text, view, symbol, primes);
    table_cell(table, text.at);
    text_free(&text);
}

static void name_symbols(Table *table, const View *view, const char *title, const Expr *symbols,
                         int count)
{
    Text text = {0};

    for (int i = 0; i < count; i++) {
        text_add(&text, i > 0 ? ", " : "");
        view_add(&text, view, symbols[i]);
    }
    if (count > 0)
        table_cells(table, "%s\t%s", title, text.at);
    text_free(&text);
}

static Table make_table(const View *view, const Matrix *m)
{
    Table table = table_of_columns(m->columns + 1);

    table_cell(&table, m->name);
    for (int j = 0; j < m->columns; j++)
        symbol_cell(&table, view, m->column_symbols[j], m->order);
    for (int i = 0; i < m->rows; i++) {
        symbol_cell(&table, view, m->row_symbols[i], 0);
        for (int j = 0; j < m->columns; j++)
            symbol_cell(&table, view, m->at[i * m->columns + j], 0);
    }
    return table;
}

/* entries that aren't 0, one a line */
static void list_entries(Text *out, const View *view, const Matrix *m)
{
    EquationList equations = {0};

    for (int i = 0; i < m->rows; i++)
        for (int j = 0; j < m->columns; j++)
            if (!expr_is_zero(m->at[i * m->columns + j]))
                view_value(&equations, view_entry_name(view, m->name, m->latex, i, j),
                           m->at[i * m->columns + j]);
    view_equations(out, view, &equations);
}

enum {
    MOST_COLUMNS = 40, /* of a table */
    USUAL_WIDTH = 100, /* where the page has none */
    SHORT = 12         /* width of an entry of which several fit in a line of any page */
};

/* As a table where that is no wider than the page, in blocks of columns where it has short entries
 * only, else entry by entry. */
static void print_matrix(Text *out, const View *view, const Matrix *m)
{
    const int room = view->page.columns > 0 ? view->page.columns : USUAL_WIDTH;
    Table table = {0};

    if (m->columns <= MOST_COLUMNS)
        table = make_table(view, m);
    if (m->columns <= MOST_COLUMNS &&
        (table_width(&table) <= room || table_widest_cell(&table) <= SHORT))
        table_blocks(out, &table, 0, room);
    else
        list_entries(out, view, m);
    table_free(&table);
}

static void print_text(Text *out, const View *view, const StateSpace *space)
{
    static const char *const terms[] = {"x' = A x", " + B u", " + B1 u'", " + B2 u''"};
    Matrix matrices[MATRICES];
    const int count = matrices_of(space, matrices);
    Table table = table_for("ll");

    text_add(out, terms[0]);
    for (int k = 1; k < count; k++)
        text_add(out, terms[1 + matrices[k].order]);
    text_char(out, '\n');
    name_symbols(&table, view, "x", space->state, space->states);
    name_symbols(&table, view, "u", space->input, space->inputs);
    table_wrap(out, &table, 0, view->page.columns);
    table_free(&table);
    for (int k = 0; k < count; k++)
        print_matrix(out, view, &matrices[k]);
}

/* --- other notations --- */

static void add_column(Text *out, const View *view, const Expr *symbols, int count, int primes)
{
    text_add(out, "\\begin{bmatrix} ");
    for (int i = 0; i < count; i++) {
        text_add(out, i > 0 ? " \\\\ " : "");
        add_symbol(out, view, symbols[i], primes);
    }
    text_add(out, " \\end{bmatrix}");
}

static void print_latex(Text *out, const View *view, const StateSpace *space)
{
    Matrix matrices[MATRICES];
    const int count = matrices_of(space, matrices);

    view_open(out, view);
    text_add(out, "\\frac{d}{dt}");
    add_column(out, view, space->state, space->states, 0);
    for (int k = 0; k < count; k++) {
        const Matrix *m = &matrices[k];

        text_add(out, k == 0 ? " &= \\begin{bmatrix} " : " \\\\\n  &\\quad + \\begin{bmatrix} ");
        for (int i = 0; i < m->rows * m->columns; i++) {
            text_add(out, i == 0 ? "" : i % m->columns == 0 ? " \\\\ " : " & ");
            view_add(out, view, m->at[i]);
        }
        text_add(out, " \\end{bmatrix} ");
        add_column(out, view, m->column_symbols, m->columns, m->order);
    }
    text_add(out, " \\\\\n");
    view_close(out, view);
}

/* "states: C1.v, L1.i" */
static void comment_symbols(Text *out, const View *view, const char *title, const Expr *symbols,
                            int count)
{
    Text line = {0}, names = {0};

    for (int i = 0; i < count; i++)
        layout_item(&names, expr_name(symbols[i]));
    text_addf(&line, "%s: %s", title, names.at != NULL ? names.at : "none");
    view_comment(out, view, line.at);
    text_free(&line);
    text_free(&names);
}

static void print_code(Text *out, const View *view, const StateSpace *space)
{
    Matrix matrices[MATRICES];
    const int count = matrices_of(space, matrices);

    comment_symbols(out, view, "x", space->state, space->states);
    comment_symbols(out, view, "u", space->input, space->inputs);
    for (int k = 0; k < count; k++) {
        const Matrix *m = &matrices[k];

        if (view->page.notation == NOTATION_C)
            text_addf(out, "double %s[%d][%d] = {{0}};\n", m->name, m->rows, m->columns);
        else
            text_addf(out, "%s = zeros(%d, %d);\n", m->name, m->rows, m->columns);
        list_entries(out, view, m);
    }
}

Status show_state(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    StateSpace *space = NULL;
    Scene scene = {0};
    Status status;

    (void)selection;
    CHECK(model_scene(view->model, &scene, diag));
    CHECK(state_space_new(&scene, view->watch, &space, diag));
    if (view_kind(view) == NOTATION_TYPESET)
        print_latex(out, view, space);
    else if (view_kind(view) == NOTATION_SOURCE)
        print_code(out, view, space);
    else
        print_text(out, view, space);
done:
    scene_free(&scene);
    state_space_free(space);
    return status;
}
