/* show_graph.c: nodes, edges, trees and their matrices, in the user's names */
#include "present/show.h"

#include <stdio.h>
#include <string.h>

/* the type of an edge by its statement: "revolute", "virtual revolute" */
static void edge_type(char *out, size_t size, const Model *model, int edge)
{
    const Instance *owner = model_edge_owner(model, edge);

    (void)snprintf(out, size, "%s%s", owner != NULL && owner->is_virtual ? "virtual " : "",
                   owner != NULL ? owner->row->name : "edge");
}

static const char *standing(const Tree *tree, const Graph *graph, int edge, TreeKind kind)
{
    if (!graph_edge_in(graph, edge, kind) || tree == NULL)
        return "";
    return !tree_has(tree, edge) ? "cotree" : tree_was_completed(tree, edge) ? "tree *" : "tree";
}

/* a table contains all rows, or those of the requested `names` */
static bool is_selected(const Selection *selection, const char *name)
{
    for (int i = 0; i < selection->name_count; i++)
        if (strcmp(selection->names[i], name) == 0)
            return true;
    return selection->name_count == 0;
}

Status show_nodes(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Graph *graph = model_graph(view->model);
    Table table = table_for("lll");

    (void)selection, (void)diag;
    table_cells(&table, "node\tdomain\tedges");
    for (int n = 0; n < graph_node_count(graph); n++) {
        const Node *node = graph_node(graph, n);
        const int *edges;
        const int count = graph_edges_at(graph, n, &edges);
        Text names = {0};

        if (count == 0 && node->datum)
            continue;
        for (int i = 0; i < count; i++)
            text_addf(&names, "%s%s", i > 0 ? " " : "", graph_edge(graph, edges[i])->name);
        table_cells(&table, "%s%s\t%s\t%s", node->name, node->datum ? " (datum)" : "",
                    domain_name(node->domain), names.at != NULL ? names.at : "");
        text_free(&names);
    }
    table_finish(out, &table, 0);
    return OK;
}

Status show_edges(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Graph *graph = model_graph(view->model);
    const Tree *trees[TREE_KINDS] = {NULL};
    Table table = table_for("lllll");
    Diag ignored;
    bool completed = false;

    (void)diag;
    /* edges can be looked at before they make a tree */
    if (model_trees(view->model, trees, &ignored) != OK)
        memset(trees, 0, sizeof trees);
    table_cells(&table, "edge\ttype\ttail -> head\ttranslation\trotation");
    for (int e = 0; e < graph_edge_count(graph); e++) {
        const Edge *edge = graph_edge(graph, e);
        char type[64];

        if (!is_selected(selection, edge->name))
            continue;
        edge_type(type, sizeof type, view->model, e);
        table_cells(&table, "%s\t%s\t%s -> %s", edge->name, type,
                    graph_node(graph, edge->tail)->name, graph_node(graph, edge->head)->name);
        for (int half = 0; half < 2; half++) {
            const TreeKind kind =
                edge->domain == DOMAIN_MECHANICAL
                    ? (half == 0 ? TREE_TRANSLATION : TREE_ROTATION)
                    : (TreeKind)(TREE_ELECTRICAL + (int)edge->domain - (int)DOMAIN_ELECTRICAL);
            const char *where = standing(trees[kind], graph, e, kind);

            if (half == 1 && edge->domain != DOMAIN_MECHANICAL)
                where = "";
            completed = completed || strchr(where, '*') != NULL;
            if (half == 0 && edge->domain != DOMAIN_MECHANICAL && where[0] != '\0')
                table_cells(&table, "%s (%s)", where, domain_name(edge->domain));
            else
                table_cell(&table, where);
        }
    }
    table_print(out, &table, 0);
    if (completed)
        text_add(out, "* completed, not chosen\n");
    table_free(&table);
    return OK;
}

Status show_graph(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Graph *graph = model_graph(view->model);

    layout_count(out, graph_node_count(graph), "node", "nodes");
    text_add(out, ", ");
    layout_count(out, graph_edge_count(graph), "edge", "edges");
    text_add(out, "\n\n");
    if (graph_edge_count(graph) == 0)
        return OK;
    TRY(show_nodes(view, selection, out, diag));
    text_char(out, '\n');
    return show_edges(view, selection, out, diag);
}

static void list_edges(Text *out, const View *view, const Tree *tree, const char *title,
                       bool branches)
{
    const Graph *graph = model_graph(view->model);
    Text names = {0};
    char lead[64];
    bool any = false;

    for (int e = 0; e < graph_edge_count(graph); e++) {
        if (!graph_edge_in(graph, e, tree_kind(tree)) || tree_has(tree, e) != branches)
            continue;
        text_addf(&names, "%s%s%s", any ? " " : "", graph_edge(graph, e)->name,
                  branches && tree_was_completed(tree, e) ? "*" : "");
        any = true;
    }
    (void)snprintf(lead, sizeof lead, "  %-9s ", title);
    layout_words(out, view->page.columns, lead, any ? names.at : "none");
    text_free(&names);
}

Status show_tree(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Tree *trees[TREE_KINDS] = {NULL};
    const Graph *graph = model_graph(view->model);
    bool completed = false, any = false;

    (void)selection;
    TRY(model_trees(view->model, trees, diag));
    for (int k = 0; k < TREE_KINDS; k++) {
        if (trees[k] == NULL)
            continue;
        any = true;
        text_addf(out, "%s\n", tree_kind_name((TreeKind)k));
        list_edges(out, view, trees[k], "branches", true);
        list_edges(out, view, trees[k], "chords", false);
        for (int e = 0; e < graph_edge_count(graph); e++)
            completed = completed || (tree_has(trees[k], e) && tree_was_completed(trees[k], e));
    }
    if (!any)
        text_add(out, "no edges yet\n");
    if (completed)
        text_add(out, "* completed, not chosen\n");
    return OK;
}

/* --- matrices --- */

typedef struct SignTable { /* a sign matrix and how its rows and columns are called */
    const SignMatrix *matrix;
    const Graph *graph;
    const int *columns; /* edges in the order to print */
    int column_count;
} SignTable;

static int entry(const SignMatrix *matrix, int row, int column)
{
    for (int i = matrix->start[row]; i < matrix->start[row + 1]; i++)
        if (matrix->column[i] == column)
            return matrix->entry[i];
    return 0;
}

static void add_sign_table(Text *out, const SignTable *signs, const char *const *rows,
                           const bool *chosen, int columns)
{
    Table table = table_of_columns(signs->column_count + 1);

    table_cell(&table, "");
    for (int c = 0; c < signs->column_count; c++)
        table_cell(&table, graph_edge(signs->graph, signs->columns[c])->name);
    for (int r = 0; r < signs->matrix->rows; r++) {
        if (!chosen[r])
            continue;
        table_cell(&table, rows[r]);
        for (int c = 0; c < signs->column_count; c++) {
            const int sign = entry(signs->matrix, r, signs->columns[c]);

            table_cell(&table, sign > 0 ? "1" : sign < 0 ? "-1" : ".");
        }
    }
    if (columns == 0 || table_width(&table) + 2 <= columns)
        table_finish(out, &table, 2);
}

/* the row as signed names: "h9 + r5 - r6 = 0" is clearer than a wide matrix */
static void add_sign_lists(Text *out, const View *view, const SignTable *signs,
                           const char *const *rows, const bool *chosen)
{
    int width = 0;

    for (int r = 0; r < signs->matrix->rows; r++)
        if (chosen[r] && text_width(rows[r]) > width)
            width = text_width(rows[r]);
    for (int r = 0; r < signs->matrix->rows; r++) {
        Text body = {0}, lead = {0};

        if (!chosen[r])
            continue;
        text_addf(&lead, "  %-*s  ", width, rows[r]);
        for (int c = 0; c < signs->column_count; c++) {
            const int sign = entry(signs->matrix, r, signs->columns[c]);

            if (sign != 0)
                text_addf(&body, "%s%s",
                          body.length == 0 ? (sign < 0 ? "-" : "") : (sign < 0 ? " - " : " + "),
                          graph_edge(signs->graph, signs->columns[c])->name);
        }
        layout_formula(out, &view->page, lead.at, body.at != NULL ? body.at : "nothing");
        text_free(&body);
        text_free(&lead);
    }
}

static void add_signs(Text *out, const View *view, const SignTable *signs, const char *const *rows,
                      const Selection *selection)
{
    bool *chosen = NEW_ARRAY(bool, signs->matrix->rows);
    const size_t before = out->length;

    for (int r = 0; r < signs->matrix->rows; r++)
        chosen[r] = is_selected(selection, rows[r]);
    if (selection->name_count == 0)
        add_sign_table(out, signs, rows, chosen, view->page.columns);
    if (out->length == before)
        add_sign_lists(out, view, signs, rows, chosen);
    mem_free(chosen);
}

Status show_incidence(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Graph *graph = model_graph(view->model);

    (void)diag;
    for (int d = 0; d < DOMAIN_COUNT; d++) {
        SignMatrix *matrix = graph_incidence(graph, (Domain)d, false);
        SignTable signs = {matrix, graph, NULL, 0};
        int *columns = NEW_ARRAY(int, graph_edge_count(graph));
        const char **rows = NEW_ARRAY(const char *, matrix->rows);
        const Selection all = {.name_count = 0};
        int row = 0;

        for (int e = 0; e < graph_edge_count(graph); e++)
            if (graph_edge(graph, e)->domain == (Domain)d &&
                is_selected(selection, graph_edge(graph, e)->name))
                columns[signs.column_count++] = e;
        for (int n = 0; n < graph_node_count(graph) && row < matrix->rows; n++)
            if (graph_node(graph, n)->domain == (Domain)d)
                rows[row++] = graph_node(graph, n)->name;
        signs.columns = columns;
        if (signs.column_count > 0) {
            text_addf(out, "%s: 1 where an edge starts, -1 where it ends\n",
                      domain_name((Domain)d));
            add_signs(out, view, &signs, rows, &all);
        }
        MEM_FREE(rows, columns);
        sign_matrix_free(matrix);
    }
    return OK;
}

/* circuits and cutsets of every tree; branches first */
static Status show_signs(const View *view, const Selection *selection, bool circuits, Text *out,
                         Diag *diag)
{
    const Graph *graph = view_graph(view);
    const Tree *trees[TREE_KINDS] = {NULL};
    const size_t before = out->length;

    TRY(view_trees(view, trees, diag));
    for (int k = 0; k < TREE_KINDS; k++) {
        const Tree *tree = trees[k];
        SignMatrix *matrix;
        SignTable signs = {NULL, graph, NULL, 0};
        int *columns;
        const char **rows;
        bool any = false;

        if (tree == NULL)
            continue;
        matrix = circuits ? tree_circuits(tree) : tree_cutsets(tree);
        signs.matrix = matrix;
        columns = NEW_ARRAY(int, graph_edge_count(graph));
        rows = NEW_ARRAY(const char *, matrix->rows);
        for (int half = 0; half < 2; half++)
            for (int e = 0; e < graph_edge_count(graph); e++)
                if (graph_edge_in(graph, e, (TreeKind)k) && tree_has(tree, e) == (half == 0))
                    columns[signs.column_count++] = e;
        signs.columns = columns;
        for (int r = 0; r < matrix->rows; r++) {
            rows[r] =
                graph_edge(graph, (circuits ? tree_chords(tree) : tree_branches(tree))[r])->name;
            any = any || is_selected(selection, rows[r]);
        }
        if (any) {
            text_addf(out, "%s: a row a %s; what is listed adds to zero\n",
                      tree_kind_name((TreeKind)k), circuits ? "chord" : "branch");
            add_signs(out, view, &signs, rows, selection);
        }
        MEM_FREE(rows, columns);
        sign_matrix_free(matrix);
    }
    if (out->length == before && selection->name_count > 0) {
        diag_set(diag, E_NAME, "'%s' is no %s of any tree", selection->names[0],
                 circuits ? "chord" : "branch");
        diag_hint(diag,
                  circuits ? "fundamental circuits belong to chords; 'show cutsets %s' may "
                             "have what you look for"
                           : "fundamental cutsets belong to branches; 'show circuits %s' may "
                             "have what you look for",
                  selection->names[0]);
        return E_NAME;
    } else if (out->length == before) {
        text_addf(out, "no %s\n", circuits ? "chords, so no circuits" : "branches, so no cutsets");
    }
    return OK;
}

/* whether a text contains a name, separated by blanks */
static bool holds_name(const char *text, const char *name)
{
    const size_t length = strlen(name);

    for (const char *at = text; (at = strstr(at, name)) != NULL; at += length)
        if ((at == text || strchr(" -", at[-1]) != NULL) &&
            (at[length] == ' ' || at[length] == '\n'))
            return true;
    return false;
}

/* which edges of what was printed are ports, and of what */
static void report_ports(const View *view, Text *out, size_t from)
{
    const Graph *graph = view_graph(view);
    Text seen = {0};

    text_add(&seen, out->at + from);
    for (int e = 0; e < graph_edge_count(graph); e++) {
        const Edge *edge = graph_edge(graph, e);

        if (view->terminal->of.at[e] < 0 && holds_name(seen.at, edge->name))
            text_addf(out, "%s is a port of a %s, %s -> %s\n", edge->name, view_edge_type(view, e),
                      graph_node(graph, edge->tail)->name, graph_node(graph, edge->head)->name);
    }
    text_free(&seen);
}

/* Rows of edges outside all subsystems; ports represent the edges inside. */
static Status show_rows(const View *view, const Selection *selection, bool circuits, Text *out,
                        Diag *diag)
{
    bool is_outside =
        selection->name_count > 0 && !selection->is_open && model_use_count(view->model) > 0;
    const size_t from = out->length;
    TerminalGraph terminal = {.graph = NULL};
    View seen = *view;
    Status status = OK;

    for (int i = 0; i < selection->name_count; i++)
        is_outside = is_outside && model_use_around(view->model, selection->names[i]) < 0;
    if (!is_outside)
        return show_signs(view, selection, circuits, out, diag);
    CHECK(terminal_graph_make(view->model, &terminal, diag));
    seen.terminal = &terminal;
    CHECK(show_signs(&seen, selection, circuits, out, diag));
    report_ports(&seen, out, from);
done:
    terminal_graph_free(&terminal);
    return status;
}

Status show_circuits(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    return show_rows(view, selection, true, out, diag);
}

Status show_cutsets(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    return show_rows(view, selection, false, out, diag);
}
