/* count.c: what equations cost, by the counting rule of the manual (help count) */
#include "present/count.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

const char *count_block_name(int i)
{
    return i < 0 || i > BLOCK_COUNT ? NULL : i < BLOCK_COUNT ? block_name((Block)i) : "total";
}

static void add_counts(OpCount *sum, OpCount more)
{
    *sum = op_count_plus(*sum, more);
}

/* M and F, or what the embedded form has instead of them */
static bool is_of(Form form, Block block)
{
    switch (block) {
    case BLOCK_MASS:
    case BLOCK_FORCES:
        return form == FORM_AUGMENTED;
    case BLOCK_EMBEDDED_MASS:
    case BLOCK_EMBEDDED_FORCES:
        return form == FORM_EMBEDDED;
    case BLOCK_DEPENDENT_RATES:
    case BLOCK_COMPLEMENT: /* the embedded blocks contain them */
        return false;
    default:
        return true;
    }
}

static Form form_of(const View *view)
{
    const char *const *independent;
    int count;

    return model_form(view->model, &independent, &count);
}

const char form_too_long[] =
    "of the augmented form: the embedded one has too many constraints to be written out";

Form form_written(System *system, Form form)
{
    int rows, columns;
    Diag ignored;
    Expr e;

    system_block_size(system, BLOCK_EMBEDDED_FORCES, &rows, &columns);
    return form == FORM_EMBEDDED && rows > 0 &&
                   system_show(system, BLOCK_EMBEDDED_FORCES, 0, 0, &e, &ignored) == OK
               ? FORM_EMBEDDED
               : FORM_AUGMENTED;
}

static Status count_total(System *system, Form form, bool shared, OpCount *out, Diag *diag)
{
    const Form written = form_written(system, form);
    OpCount sum = {0, 0, 0};

    for (int b = 0; b < BLOCK_COUNT; b++) {
        OpCount count;

        if (!is_of(written, (Block)b))
            continue;
        TRY(system_count(system, (Block)b, shared, &count, diag));
        add_counts(&sum, count);
    }
    *out = sum;
    return OK;
}

Status count_block(System *system, Form form, const char *name, bool shared, OpCount *out,
                   Diag *diag)
{
    Suggest suggest = suggest_for(name);

    for (int b = 0; b < BLOCK_COUNT; b++)
        if (strcmp(block_name((Block)b), name) == 0)
            return system_count(system, (Block)b, shared, out, diag);
    if (strcmp(name, "total") == 0)
        return count_total(system, form, shared, out, diag);
    for (int i = 0; count_block_name(i) != NULL; i++)
        suggest_offer(&suggest, count_block_name(i));
    diag_set(diag, E_NAME, "no block of equations is called '%s'", name);
    suggest_or_hint(&suggest, diag,
                    "one of mass forces constraints jacobian velocity acceleration network "
                    "network_rhs total");
    return E_NAME;
}

/* --- the table of blocks --- */

/* of a count that would take too long, only the size is reported */
static void count_cell(Table *table, int64_t count)
{
    const int64_t exact = 1000000000;

    if (count < exact)
        table_cells(table, "%" PRId64, count);
    else
        table_cells(table, count < (int64_t)1 << 62 ? "%.1e" : ">%.1e", (double)count);
}

static void count_cells(Table *table, OpCount count)
{
    count_cell(table, count.add);
    count_cell(table, count.mul);
    count_cell(table, count.fun);
}

static void heading(Table *table)
{
    for (int twice = 0; twice < 2; twice++)
        table_cells(table, "add\tmul\tfun");
}

static Status block_row(Table *table, const View *view, const char *name, Diag *diag)
{
    OpCount written, shared;

    TRY(count_block(view->system, form_of(view), name, false, &written, diag));
    TRY(count_block(view->system, form_of(view), name, true, &shared, diag));
    table_cell(table, name);
    count_cells(table, written);
    count_cells(table, shared);
    return OK;
}

static bool is_empty(const View *view, Block block)
{
    int rows, columns;

    system_block_size(view->system, block, &rows, &columns);
    return rows * columns == 0;
}

static Status print_blocks(const View *view, const Statement *statement, Text *out, Diag *diag)
{
    Table table = table_for("lrrrrrr");
    Status status = OK;

    table_cell(&table, "");
    heading(&table);
    for (int i = 0; i < statement->operands.count; i++) {
        status = block_row(&table, view, statement->operands.at[i].value->text, diag);
        if (status != OK)
            diag->place = statement->operands.at[i].place;
        if (status != OK)
            goto done;
    }
    if (statement->operands.count == 0) {
        const Form form = form_written(view->system, form_of(view));

        for (int b = 0; b < BLOCK_COUNT; b++)
            if (is_of(form, (Block)b) && !is_empty(view, (Block)b))
                CHECK(block_row(&table, view, block_name((Block)b), diag));
        CHECK(block_row(&table, view, "total", diag));
    }
    text_add(out, "operations as written, and after common subexpressions are shared\n");
    if (form_of(view) != form_written(view->system, form_of(view)))
        text_addf(out, "(%s)\n", form_too_long);
    table_print(out, &table, 0);
done:
    table_free(&table);
    return status;
}

/* --- trees side by side --- */

/* a branch that the user can choose */
static bool is_chosen(const Graph *graph, const Tree *tree, int e)
{
    return graph_edge_in(graph, e, tree_kind(tree)) && tree_has(tree, e) &&
           graph_branching(graph, e, tree_kind(tree)) != BRANCH_ALWAYS;
}

static char *list_choice(const Model *model, const Tree *tree)
{
    const Graph *graph = model_graph(model);
    Text text = {0};

    for (int e = 0; e < graph_edge_count(graph); e++)
        if (is_chosen(graph, tree, e))
            text_addf(&text, "%s%s", text.length > 0 ? " " : "", graph_edge(graph, e)->name);
    return text_done(&text);
}

char *tree_brief(const Model *model, const Tree *const trees[TREE_KINDS])
{
    char *names[TREE_KINDS] = {NULL};
    Text text = {0};
    bool same;

    for (int k = 0; k < TREE_KINDS; k++)
        names[k] = trees[k] != NULL ? list_choice(model, trees[k]) : NULL;
    same = names[TREE_TRANSLATION] != NULL && names[TREE_ROTATION] != NULL &&
           strcmp(names[TREE_TRANSLATION], names[TREE_ROTATION]) == 0;
    for (int k = 0; k < TREE_KINDS; k++) {
        if (names[k] == NULL || names[k][0] == '\0' || (same && k == TREE_ROTATION))
            continue;
        text_addf(&text, "%s%s%s%s", text.length > 0 ? "; " : "",
                  same && k == TREE_TRANSLATION ? "" : tree_kind_name((TreeKind)k),
                  same && k == TREE_TRANSLATION ? "" : " ", names[k]);
    }
    for (int k = 0; k < TREE_KINDS; k++)
        mem_free(names[k]);
    return text_done(&text);
}

/* in brackets, as a word of the verb could be a name */
static char *tree_statements(const Model *model, const Tree *const trees[TREE_KINDS])
{
    const Graph *graph = model_graph(model);
    Text text = {0};

    for (int k = 0; k < TREE_KINDS; k++) {
        bool any = false;

        for (int e = 0; trees[k] != NULL && e < graph_edge_count(graph); e++)
            if (is_chosen(graph, trees[k], e)) {
                if (!any)
                    text_addf(&text, "tree %s", tree_kind_name((TreeKind)k));
                text_addf(&text, " (%s)", graph_edge(graph, e)->name);
                any = true;
            }
        text_add(&text, any ? "\n" : "");
    }
    return text_done(&text);
}

Status tree_cost(const View *view, TreeCost *out, Diag *diag)
{
    const Tree *trees[TREE_KINDS] = {NULL};

    TRY(model_trees(view->model, trees, diag));
    *out = (TreeCost){.n = system_n(view->system),
                      .m = system_m(view->system),
                      .trees = tree_brief(view->model, trees),
                      .statements = tree_statements(view->model, trees)};
    return OK;
}

Status tree_cost_count(const View *view, TreeCost *cost, Diag *diag)
{
    TRY(count_total(view->system, form_of(view), false, &cost->written, diag));
    TRY(count_total(view->system, form_of(view), true, &cost->shared, diag));
    cost->is_counted = true;
    return OK;
}

/* each entry needs some 30 us */
bool tree_cost_is_slight(const System *system)
{
    enum { MOST_ENTRIES = 1000 };
    const int n = system_n(system), m = system_m(system);

    return n <= MOST_ENTRIES && m <= MOST_ENTRIES &&
           n * (n + 1) / 2 + m * n + n + m <= MOST_ENTRIES;
}

static void tree_cost_free(TreeCost *cost)
{
    MEM_FREE(cost->trees, cost->statements);
}

int tree_costs_add(TreeCosts *costs, TreeCost *cost)
{
    for (int i = 0; i < costs->count; i++)
        if (strcmp(costs->at[i].trees, cost->trees) == 0) {
            mem_keep(costs->at);
            tree_cost_free(&costs->at[i]);
            costs->at[i] = *cost;
            return i;
        }
    LIST_PUSH(*costs, *cost);
    return costs->count - 1;
}

void tree_costs_free(TreeCosts *costs)
{
    for (int i = 0; i < costs->count; i++)
        tree_cost_free(&costs->at[i]);
    LIST_FREE(*costs);
}

static void print_costs(const View *view, const TreeCosts *costs, Text *out)
{
    const bool moves = view_is_mechanical(view);
    Table table = table_for(moves ? "rrrrrrrrr" : "rrrrrrr");
    Text what = {0};
    char lead[16];

    table_cell(&table, "");
    if (moves)
        table_cells(&table, "n\tm");
    heading(&table);
    for (int i = 0; i < costs->count; i++) {
        const TreeCost *cost = costs->at + i;

        table_cells(&table, "%d", i + 1);
        if (moves)
            table_cells(&table, "%d\t%d", cost->n, cost->m);
        count_cells(&table, cost->written);
        count_cells(&table, cost->shared);
    }
    text_addf(&what,
              "trees so far: %soperations of all blocks as written and after common "
              "subexpressions are shared",
              moves ? "n coordinates, m constraints, " : "");
    layout_words(out, view->page.columns, "", what.at);
    text_free(&what);
    table_print(out, &table, 0);
    for (int i = 0; i < costs->count; i++) {
        (void)snprintf(lead, sizeof lead, "%d: ", i + 1);
        layout_words(out, view->page.columns, lead, costs->at[i].trees);
    }
    table_free(&table);
}

bool count_is_for_trees(const Statement *statement)
{
    return statement->operands.count == 1 &&
           strcmp(statement->operands.at[0].value->text, "trees") == 0;
}

Status count_print(const View *view, const Statement *statement, const TreeCosts *costs, Text *out,
                   Diag *diag)
{
    if (count_is_for_trees(statement)) {
        print_costs(view, costs, out);
        return OK;
    }
    return print_blocks(view, statement, out, diag);
}
