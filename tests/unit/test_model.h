/* test_model.h: models built from text, for unit tests */
#ifndef COTREE_TESTS_TEST_MODEL_H
#define COTREE_TESTS_TEST_MODEL_H

#include "base/text.h"
#include "model/model.h"
#include "test.h"

/* Apply every statement that builds, in order; others (show, simulate) are passed over. Stops at
 * the first failure. Each statement is read from its own start, or reading would count the lines
 * before it again and again. */
__attribute__((unused)) static Status apply_text(Model *model, const char *text, Diag *diag)
{
    int line = 1;
    Status status = OK;

    while (status == OK && text[0] != '\0') {
        Statement *statement = NULL;
        size_t next = 0;

        status = statement_parse(text, line, (SyntaxOptions){false}, &next, &statement, diag);
        if (status == OK && statement->kind != STATEMENT_EMPTY &&
            (statement->kind != STATEMENT_VERB || statement->row.room == ROOM_MODEL))
            status = model_apply(model, statement, diag);
        statement_free(statement);
        for (; next > 0; next--)
            line += *text++ == '\n';
    }
    return status;
}

/* a new model of that text; a failure is a fault of the test */
__attribute__((unused)) static Model *model_of(const char *text)
{
    Model *model = model_new();
    Diag diag = {0};

    if (apply_text(model, text, &diag) != OK) {
        test_faults++;
        printf("%d:%d: %s (%s)\n", diag.place.line, diag.place.column, diag.message, diag.hint);
    }
    return model;
}

/* names of the branches of a tree in order of the edges' making, with blanks between; new */
__attribute__((unused)) static char *branches(const Model *model, TreeKind kind)
{
    const Tree *trees[TREE_KINDS];
    const Graph *graph = model_graph(model);
    Diag diag = {0};
    Text text = {0};

    if (model_trees(model, trees, &diag) != OK)
        text_addf(&text, "%s", diag.message);
    else
        for (int e = 0; e < graph_edge_count(graph); e++)
            if (trees[kind] != NULL && graph_edge_in(graph, e, kind) && tree_has(trees[kind], e) &&
                graph_branching(graph, e, kind) != BRANCH_ALWAYS)
                text_addf(&text, "%s%s", text.length > 0 ? " " : "", graph_edge(graph, e)->name);
    return text_done(&text);
}

#define EXPECT_BRANCHES(model, kind, wanted)                                                       \
    do {                                                                                           \
        char *branches_ = branches(model, kind);                                                   \
        EXPECT_TEXT(branches_, wanted);                                                            \
        mem_free(branches_);                                                                       \
    } while (0)

/* the value of an expression of parameters, or the text of any expression; new */
__attribute__((unused)) static char *expression_text(const Model *model, const char *text)
{
    Pool *pool = pool_new(0);
    Syntax *syntax = NULL;
    Expr e = NULL;
    Diag diag = {0};
    char *out;

    if (syntax_parse_expression(text, pool, &syntax, &diag) == OK &&
        model_expression(model, syntax, &e, &diag) == OK)
        out = expr_text(e);
    else
        out = mem_text(diag.message, strlen(diag.message));
    pool_free(pool);
    return out;
}

#define EXPECT_EXPRESSION(model, text, wanted)                                                     \
    do {                                                                                           \
        char *expression_ = expression_text(model, text);                                          \
        EXPECT_TEXT(expression_, wanted);                                                          \
        mem_free(expression_);                                                                     \
    } while (0)

/* everything that the graph is, as text; new */
__attribute__((unused)) static char *graph_text(const Model *model)
{
    const Graph *graph = model_graph(model);
    Text text = {0};

    for (int n = 0; n < graph_node_count(graph); n++)
        text_addf(&text, "%s/%d ", graph_node(graph, n)->name, (int)graph_node(graph, n)->domain);
    for (int e = 0; e < graph_edge_count(graph); e++) {
        const Edge *edge = graph_edge(graph, e);

        text_addf(&text, "%s:%s>%s/%d/%d%d ", edge->name, graph_node(graph, edge->tail)->name,
                  graph_node(graph, edge->head)->name, edge->component, (int)edge->branching[0],
                  (int)edge->branching[1]);
    }
    return text_done(&text);
}

#endif
