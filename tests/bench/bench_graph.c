/* bench_graph.c: trees and their matrices of random graphs, twice as many edges as nodes */
#include "graph/tree.h"

#include "../random.h"
#include "bench.h"

static Graph *make_random(int edges)
{
    Graph *graph = graph_new();
    int nodes = edges / 2;
    uint64_t seed = 1;
    char name[20];

    for (int i = 0; i < nodes; i++) {
        (void)snprintf(name, sizeof name, "n%d", i);
        (void)graph_add_node(graph, name, DOMAIN_MECHANICAL, i == 0);
    }
    for (int e = 0; e < edges; e++) {
        bool needed = e < nodes - 1;
        Edge edge = {.name = name, .domain = DOMAIN_MECHANICAL};

        (void)snprintf(name, sizeof name, "e%d", e);
        edge.tail = needed ? e + 1 : (int)(test_random(&seed) % (uint64_t)nodes);
        edge.head = (int)(test_random(&seed) % (uint64_t)(needed ? e + 1 : nodes));
        edge.branching[0] = edge.branching[1] = BRANCH_MAY;
        edge.preference[0] = edge.preference[1] = (int)(test_random(&seed) % 10);
        (void)graph_add_edge(graph, &edge);
    }
    return graph;
}

static Tree *complete(const Graph *graph)
{
    Tree *tree = NULL;
    Status status = tree_complete(graph, TREE_TRANSLATION, NULL, false, &tree, NULL);

    return status == OK ? tree : NULL;
}

static void measure(int edges, const char *size)
{
    Graph *graph = make_random(edges);
    Tree *tree = complete(graph);
    double seconds;
    char name[40];

    BENCH_LEAST(5, seconds, tree_free(complete(graph)));
    (void)snprintf(name, sizeof name, "graph.complete_%s", size);
    bench_line(name, 1e6 * seconds, "us");

    BENCH_LEAST(5, seconds, sign_matrix_free(tree_circuits(tree)));
    (void)snprintf(name, sizeof name, "graph.circuits_%s", size);
    bench_line(name, 1e6 * seconds, "us");

    BENCH_LEAST(5, seconds, sign_matrix_free(tree_cutsets(tree)));
    (void)snprintf(name, sizeof name, "graph.cutsets_%s", size);
    bench_line(name, 1e6 * seconds, "us");

    tree_free(tree);
    graph_free(graph);
}

int main(void)
{
    measure(1000, "1e3");
    measure(10000, "1e4");
    measure(100000, "1e5");
    return 0;
}
