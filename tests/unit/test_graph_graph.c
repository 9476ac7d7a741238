/* test_graph_graph.c: nodes, edges, domains and parts */
#include "graph/graph.h"

#include "test.h"

static int add(Graph *graph, const char *name, int tail, int head)
{
    Edge edge = {.name = name,
                 .tail = tail,
                 .head = head,
                 .domain = graph_node(graph, tail)->domain,
                 .branching = {BRANCH_MAY, BRANCH_UNCHOSEN}};

    return graph_add_edge(graph, &edge);
}

/* ground - a - b and, apart, c; 0 - 1 electrical */
static Graph *make_pieces(void)
{
    Graph *graph = graph_new();
    int ground = graph_add_node(graph, "ground", DOMAIN_MECHANICAL, true);
    int a = graph_add_node(graph, "a", DOMAIN_MECHANICAL, false);
    int zero = graph_add_node(graph, "0", DOMAIN_ELECTRICAL, true);
    int b = graph_add_node(graph, "b", DOMAIN_MECHANICAL, false);
    int one = graph_add_node(graph, "1", DOMAIN_ELECTRICAL, false);

    (void)graph_add_node(graph, "c", DOMAIN_MECHANICAL, false);
    (void)add(graph, "h1", ground, a);
    (void)add(graph, "R1", zero, one);
    (void)add(graph, "h2", b, a);
    (void)add(graph, "R1", one, zero);
    return graph;
}

static void names_are_found_and_copied(void)
{
    Graph *graph = graph_new();
    char name[] = "frame";
    int node = graph_add_node(graph, name, DOMAIN_MECHANICAL, false);
    int edge = add(graph, name, node, node);

    name[0] = 'F';
    EXPECT_TEXT(graph_node(graph, node)->name, "frame");
    EXPECT_TEXT(graph_edge(graph, edge)->name, "frame");
    EXPECT(graph_find_node(graph, "frame") == node);
    EXPECT(graph_find_edge(graph, "frame") == edge);
    EXPECT(graph_find_node(graph, "Frame") == -1);
    EXPECT(graph_find_edge(graph, "Frame") == -1);
    graph_free(graph);
}

static void first_of_a_name_is_found(void)
{
    Graph *graph = make_pieces();

    EXPECT(graph_find_edge(graph, "R1") == 1);
    EXPECT(graph_find_edge(graph, "h2") == 2);
    EXPECT(graph_edge_count(graph) == 4);
    EXPECT(graph_node_count(graph) == 6);
    graph_free(graph);
}

static void edges_at_a_node_stand_in_order_of_making(void)
{
    Graph *graph = make_pieces();
    const int *edges;

    EXPECT(graph_edges_at(graph, graph_find_node(graph, "a"), &edges) == 2);
    EXPECT(edges[0] == 0 && edges[1] == 2);
    EXPECT(graph_edges_at(graph, graph_find_node(graph, "c"), &edges) == 0);

    /* one that ends where it begins is there once */
    int loop = add(graph, "loop", 5, 5);
    EXPECT(graph_edges_at(graph, 5, &edges) == 1 && edges[0] == loop);
    graph_free(graph);
}

static void branching_depends_on_the_tree(void)
{
    Graph *graph = make_pieces();

    EXPECT(graph_branching(graph, 0, TREE_TRANSLATION) == BRANCH_MAY);
    EXPECT(graph_branching(graph, 0, TREE_ROTATION) == BRANCH_UNCHOSEN);
    EXPECT(graph_branching(graph, 0, TREE_ELECTRICAL) == BRANCH_NEVER);
    EXPECT(graph_branching(graph, 1, TREE_ELECTRICAL) == BRANCH_MAY);
    EXPECT(graph_branching(graph, 1, TREE_ROTATION) == BRANCH_NEVER);
    EXPECT(graph_edge_in(graph, 1, TREE_ELECTRICAL));
    EXPECT(!graph_edge_in(graph, 1, TREE_TRANSLATION));
    graph_free(graph);
}

static void kinds_and_domains_have_names(void)
{
    static const char *const kinds[] = {"translation", "rotation", "electrical", "hydraulic",
                                        "shaft",       "slide",    "thermal",    "load"};

    for (int k = 0; k < TREE_KINDS; k++) {
        EXPECT_TEXT(tree_kind_name((TreeKind)k), kinds[k]);
        if (k > TREE_ROTATION)
            EXPECT_TEXT(domain_name(tree_kind_domain((TreeKind)k)), kinds[k]);
    }
    EXPECT(tree_kind_domain(TREE_TRANSLATION) == DOMAIN_MECHANICAL);
    EXPECT(tree_kind_domain(TREE_ROTATION) == DOMAIN_MECHANICAL);
    EXPECT_TEXT(domain_name(DOMAIN_MECHANICAL), "mechanical");
}

static void parts_are_counted_by_domain(void)
{
    Graph *graph = make_pieces();
    int part[6];

    EXPECT(graph_parts(graph, DOMAIN_MECHANICAL, part) == 2);
    EXPECT(part[0] == 0 && part[1] == 0 && part[3] == 0 && part[5] == 1);
    EXPECT(part[2] == -1 && part[4] == -1);
    EXPECT(graph_parts(graph, DOMAIN_ELECTRICAL, part) == 1);
    EXPECT(part[2] == 0 && part[4] == 0 && part[0] == -1);
    EXPECT(graph_parts(graph, DOMAIN_THERMAL, part) == 0);
    graph_free(graph);
}

static void freeing_nothing_is_fine(void)
{
    graph_free(NULL);
}

int main(void)
{
    RUN(names_are_found_and_copied);
    RUN(first_of_a_name_is_found);
    RUN(edges_at_a_node_stand_in_order_of_making);
    RUN(branching_depends_on_the_tree);
    RUN(kinds_and_domains_have_names);
    RUN(parts_are_counted_by_domain);
    RUN(freeing_nothing_is_fine);
    return test_end();
}
