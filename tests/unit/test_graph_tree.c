/* test_graph_tree.c: laws of trees and of their matrices, on random connected multigraphs */
#include "graph/tree.h"

#include "test.h"

enum { SIZES = 4 };
static const int sizes[SIZES][2] = {{1, 0}, {2, 5}, {60, 150}, {4000, 10000}}; /* nodes, edges */

static int add(Graph *graph, const char *name, int tail, int head, Branching branching,
               int preference)
{
    Edge edge = {.name = name,
                 .tail = tail,
                 .head = head,
                 .domain = graph_node(graph, tail)->domain,
                 .branching = {branching, branching},
                 .preference = {preference, -preference}};

    return graph_add_edge(graph, &edge);
}

/* A mechanical piece that hangs together by edges which may be branches; some are springs, one in
 * fifty begins where it ends, and terminals of another domain stand between. */
static Graph *make_random(int nodes, int edges, uint64_t *seed)
{
    Graph *graph = graph_new();
    int *frames = NEW_ARRAY(int, nodes);
    char name[20];

    for (int i = 0; i < nodes; i++) {
        (void)snprintf(name, sizeof name, "n%d", i);
        frames[i] = graph_add_node(graph, name, DOMAIN_MECHANICAL, i == 0);
        if (i % 7 == 3)
            (void)graph_add_node(graph, "terminal", DOMAIN_ELECTRICAL, i == 3);
    }
    for (int e = 0; e < edges; e++) {
        bool needed = e < nodes - 1;
        int a = needed ? e + 1 : (int)(test_random(seed) % (uint64_t)nodes);
        int b = (int)(test_random(seed) % (uint64_t)(needed ? e + 1 : nodes));
        bool spring = !needed && test_random(seed) % 4 == 0;
        int preference = (int)(test_random(seed) % 10);

        if (!needed && test_random(seed) % 50 == 0)
            b = a;
        if (test_random(seed) % 2 == 0) {
            int swap = a;

            a = b;
            b = swap;
        }
        (void)snprintf(name, sizeof name, "e%d", e);
        (void)add(graph, name, frames[a], frames[b], spring ? BRANCH_NEVER : BRANCH_MAY,
                  preference);
        if (e == 11)
            (void)add(graph, "R1", graph_find_node(graph, "terminal"),
                      graph_find_node(graph, "terminal"), BRANCH_MAY, 0);
    }
    mem_free(frames);
    return graph;
}

static Tree *make_tree(const Graph *graph, TreeKind kind, const TreeChoice *choice)
{
    Tree *tree = NULL;
    Diag diag = {0};

    EXPECT(tree_complete(graph, kind, choice, false, &tree, &diag) == OK);
    EXPECT_TEXT(diag.message, "");
    return tree;
}

/* run a claim on trees of all sizes */
static void for_all_sizes(void (*claim)(const Graph *, const Tree *, uint64_t))
{
    uint64_t seed = 20240607;

    for (int s = 0; s < SIZES; s++) {
        Graph *graph = make_random(sizes[s][0], sizes[s][1], &seed);

        for (int kind = TREE_TRANSLATION; kind <= TREE_ROTATION; kind++) {
            Tree *tree = make_tree(graph, (TreeKind)kind, NULL);

            if (tree != NULL)
                claim(graph, tree, seed);
            tree_free(tree);
        }
        graph_free(graph);
    }
}

static SignMatrix *transpose(const SignMatrix *m)
{
    SignMatrix *t = NEW(SignMatrix);
    int *at = NEW_ARRAY(int, m->columns + 1);

    *t = (SignMatrix){.rows = m->columns, .columns = m->rows};
    t->start = NEW_ARRAY(int, m->columns + 1);
    t->column = NEW_ARRAY(int, m->start[m->rows]);
    t->entry = NEW_ARRAY(signed char, m->start[m->rows]);
    for (int i = 0; i < m->start[m->rows]; i++)
        t->start[m->column[i] + 1]++;
    for (int c = 0; c < m->columns; c++)
        at[c + 1] = t->start[c + 1] += t->start[c];
    for (int r = 0; r < m->rows; r++) {
        for (int i = m->start[r]; i < m->start[r + 1]; i++) {
            t->column[at[m->column[i]]] = r;
            t->entry[at[m->column[i]]++] = m->entry[i];
        }
    }
    mem_free(at);
    return t;
}

/* a * b^T */
static bool is_orthogonal(const SignMatrix *a, const SignMatrix *b)
{
    SignMatrix *columns = transpose(a);
    int *sum = NEW_ARRAY(int, a->rows);
    bool good = a->columns == b->columns;

    for (int r = 0; r < b->rows; r++) {
        for (int i = b->start[r]; i < b->start[r + 1]; i++) {
            int c = b->column[i];

            for (int k = columns->start[c]; k < columns->start[c + 1]; k++)
                sum[columns->column[k]] += columns->entry[k] * b->entry[i];
        }
        for (int i = b->start[r]; i < b->start[r + 1]; i++) {
            int c = b->column[i];

            for (int k = columns->start[c]; k < columns->start[c + 1]; k++)
                good = good && sum[columns->column[k]] == 0;
        }
        if (!good)
            break;
    }
    mem_free(sum);
    sign_matrix_free(columns);
    return good;
}

static int entry_at(const SignMatrix *m, int row, int column)
{
    for (int i = m->start[row]; i < m->start[row + 1]; i++) {
        if (m->column[i] == column)
            return m->entry[i];
    }
    return 0;
}

static bool is_ascending(const SignMatrix *m)
{
    for (int r = 0; r < m->rows; r++) {
        for (int i = m->start[r] + 1; i < m->start[r + 1]; i++) {
            if (m->column[i - 1] >= m->column[i])
                return false;
        }
    }
    return true;
}

static void check_products(const Graph *graph, const Tree *tree, uint64_t seed)
{
    SignMatrix *incidence = graph_incidence(graph, DOMAIN_MECHANICAL, true);
    SignMatrix *whole = graph_incidence(graph, DOMAIN_MECHANICAL, false);
    SignMatrix *circuits = tree_circuits(tree);
    SignMatrix *cutsets = tree_cutsets(tree);

    (void)seed;
    EXPECT(whole->rows == incidence->rows + 1);
    EXPECT(cutsets->rows == incidence->rows);
    EXPECT(is_orthogonal(incidence, circuits));
    EXPECT(is_orthogonal(whole, circuits));
    EXPECT(is_orthogonal(cutsets, circuits));
    EXPECT(is_ascending(incidence) && is_ascending(circuits) && is_ascending(cutsets));
    sign_matrix_free(incidence);
    sign_matrix_free(whole);
    sign_matrix_free(circuits);
    sign_matrix_free(cutsets);
}

static void incidence_and_cutsets_are_orthogonal_to_circuits(void)
{
    for_all_sizes(check_products);
}

/* B = [-D^T 1], Q = [1 D] */
static void check_structure(const Graph *graph, const Tree *tree, uint64_t seed)
{
    SignMatrix *circuits = tree_circuits(tree);
    SignMatrix *cutsets = tree_cutsets(tree);
    const int *branches = tree_branches(tree);
    const int *chords = tree_chords(tree);

    (void)seed;
    EXPECT(circuits->columns == graph_edge_count(graph));
    for (int r = 0; r < circuits->rows; r++) {
        for (int i = circuits->start[r]; i < circuits->start[r + 1]; i++) {
            if (!tree_has(tree, circuits->column[i]))
                EXPECT(circuits->column[i] == chords[r] && circuits->entry[i] == 1);
        }
        EXPECT(entry_at(circuits, r, chords[r]) == 1);
    }
    for (int r = 0; r < cutsets->rows; r++) {
        for (int i = cutsets->start[r]; i < cutsets->start[r + 1]; i++) {
            if (tree_has(tree, cutsets->column[i]))
                EXPECT(cutsets->column[i] == branches[r] && cutsets->entry[i] == 1);
        }
        EXPECT(entry_at(cutsets, r, branches[r]) == 1);
    }
    sign_matrix_free(circuits);
    sign_matrix_free(cutsets);
}

static void circuits_end_in_one_and_cutsets_begin_with_one(void)
{
    for_all_sizes(check_structure);
}

/* an edge's across variable as a difference of potentials sums up along every path */
static void check_paths(const Graph *graph, const Tree *tree, uint64_t seed)
{
    int node_count;
    const int *nodes = tree_nodes(tree, &node_count);
    int *potential = NEW_ARRAY(int, graph_node_count(graph));
    int *edges = NEW_ARRAY(int, 2 * node_count);
    int *signs = NEW_ARRAY(int, 2 * node_count);

    for (int i = 0; i < graph_node_count(graph); i++)
        potential[i] = (int)(test_random(&seed) % 1000);
    for (int k = 0; k < 500; k++) {
        int from = nodes[test_random(&seed) % (uint64_t)node_count];
        int to = nodes[test_random(&seed) % (uint64_t)node_count];
        int count = tree_path(tree, from, to, edges, signs);
        int at = from;
        int sum = 0;

        for (int i = 0; i < count; i++) {
            const Edge *edge = graph_edge(graph, edges[i]);

            EXPECT(tree_has(tree, edges[i]));
            EXPECT(at == (signs[i] > 0 ? edge->tail : edge->head));
            at = signs[i] > 0 ? edge->head : edge->tail;
            sum += signs[i] * (potential[edge->head] - potential[edge->tail]);
        }
        EXPECT(at == to);
        EXPECT(sum == potential[to] - potential[from]);
        EXPECT(count <= tree_depth(tree, from) + tree_depth(tree, to));
    }
    mem_free(potential);
    mem_free(edges);
    mem_free(signs);
}

static void across_variables_sum_along_paths(void)
{
    for_all_sizes(check_paths);
}

static void check_beyond(const Graph *graph, const Tree *tree, uint64_t seed)
{
    const int *branches = tree_branches(tree);
    int node_count;
    const int *nodes = tree_nodes(tree, &node_count);
    int checks = node_count < 100 ? node_count : 100;

    (void)graph;
    for (int b = 0; b < checks - 1; b++) {
        int branch = node_count < 100 ? branches[b]
                                      : branches[test_random(&seed) % (uint64_t)(node_count - 1)];

        for (int i = 0; i < node_count; i++) {
            int climber = nodes[i];

            while (climber >= 0 && tree_parent_edge(tree, climber) != branch)
                climber = tree_parent(tree, climber);
            EXPECT(tree_is_beyond(tree, branch, nodes[i]) == (climber >= 0));
            if (climber >= 0)
                EXPECT(climber == tree_far_node(tree, branch));
        }
    }
}

static void beyond_is_found_by_climbing(void)
{
    for_all_sizes(check_beyond);
}

static void check_order(const Graph *graph, const Tree *tree, uint64_t seed)
{
    int node_count;
    const int *nodes = tree_nodes(tree, &node_count);
    int *place = NEW_ARRAY(int, graph_node_count(graph));
    int frames = 0;

    (void)seed;
    for (int i = 0; i < graph_node_count(graph); i++)
        frames += graph_node(graph, i)->domain == DOMAIN_MECHANICAL;
    EXPECT(node_count == frames);
    EXPECT(tree_branch_count(tree) == frames - 1);
    EXPECT(graph_node(graph, nodes[0])->datum);
    EXPECT(tree_parent(tree, nodes[0]) == -1 && tree_parent_edge(tree, nodes[0]) == -1);
    EXPECT(tree_depth(tree, nodes[0]) == 0);
    for (int i = 0; i < node_count; i++)
        place[nodes[i]] = i;
    for (int i = 1; i < node_count; i++) {
        int parent = tree_parent(tree, nodes[i]);
        const Edge *edge = graph_edge(graph, tree_parent_edge(tree, nodes[i]));

        EXPECT(place[parent] < i);
        EXPECT(tree_branches(tree)[i - 1] == tree_parent_edge(tree, nodes[i]));
        EXPECT(tree_far_node(tree, tree_parent_edge(tree, nodes[i])) == nodes[i]);
        EXPECT(tree_depth(tree, nodes[i]) == tree_depth(tree, parent) + 1);
        EXPECT(edge->tail == (tree_is_forward(tree, nodes[i]) ? parent : nodes[i]));
        EXPECT(edge->head == (tree_is_forward(tree, nodes[i]) ? nodes[i] : parent));
    }
    mem_free(place);
}

static void parents_stand_before_children(void)
{
    for_all_sizes(check_order);
}

/* a tree is of least weight when no chord is lighter than a branch of its circuit */
static void check_preference(const Graph *graph, const Tree *tree, uint64_t seed)
{
    SignMatrix *circuits = tree_circuits(tree);
    int p = tree_kind(tree) == TREE_ROTATION;

    (void)seed;
    EXPECT(tree_graph(tree) == graph);
    for (int r = 0; r < circuits->rows; r++) {
        int chord = tree_chords(tree)[r];

        if (graph_branching(graph, chord, tree_kind(tree)) == BRANCH_NEVER)
            continue;
        for (int i = circuits->start[r]; i < circuits->start[r + 1]; i++) {
            const Edge *branch = graph_edge(graph, circuits->column[i]);

            EXPECT(branch->preference[p] <= graph_edge(graph, chord)->preference[p]);
        }
    }
    for (int i = 0; i < tree_branch_count(tree); i++)
        EXPECT(tree_was_completed(tree, tree_branches(tree)[i]));
    sign_matrix_free(circuits);
}

static void completion_takes_edges_by_preference(void)
{
    for_all_sizes(check_preference);
}

/* a square ground-a-b-c with a diagonal arm ground-b, and a virtual joint between a and c */
static Graph *make_square(void)
{
    Graph *graph = graph_new();

    for (int i = 0; i < 4; i++)
        (void)graph_add_node(graph, (const char *[]){"ground", "a", "b", "c"}[i], DOMAIN_MECHANICAL,
                             i == 0);
    (void)add(graph, "h0", 0, 1, BRANCH_MAY, 1);
    (void)add(graph, "h1", 1, 2, BRANCH_MAY, 1);
    (void)add(graph, "h2", 2, 3, BRANCH_MAY, 1);
    (void)add(graph, "h3", 3, 0, BRANCH_MAY, 1);
    (void)add(graph, "arm", 0, 2, BRANCH_ALWAYS, 9);
    (void)add(graph, "v13", 1, 3, BRANCH_UNCHOSEN, 0);
    (void)add(graph, "spring", 1, 3, BRANCH_NEVER, 0);
    return graph;
}

static void arms_enter_unasked_and_virtual_joints_when_asked(void)
{
    Graph *graph = make_square();
    Tree *tree = make_tree(graph, TREE_TRANSLATION, NULL);

    EXPECT(tree_has(tree, 4) && !tree_was_completed(tree, 4));
    EXPECT(tree_has(tree, 0) && tree_was_completed(tree, 0) && tree_has(tree, 2));
    EXPECT(!tree_has(tree, 1) && !tree_has(tree, 3) && !tree_has(tree, 5) && !tree_has(tree, 6));
    tree_free(tree);

    /* an arm and an edge named twice are no faults */
    int chosen[] = {5, 4, 5, 1};
    TreeChoice choice = {.branches = chosen, .branch_count = 4};
    tree = make_tree(graph, TREE_TRANSLATION, &choice);
    EXPECT(tree_has(tree, 5) && tree_has(tree, 1) && tree_has(tree, 4));
    EXPECT(!tree_was_completed(tree, 5) && !tree_was_completed(tree, 1));
    EXPECT(tree_chord_count(tree) == 4);
    tree_free(tree);
    graph_free(graph);
}

static void excluded_edges_stay_out_unless_chosen(void)
{
    Graph *graph = make_square();
    bool excluded[7] = {[0] = true, [2] = true};
    int chosen[] = {2};
    TreeChoice choice = {.branches = chosen, .branch_count = 1, .excluded = excluded};
    Tree *tree = make_tree(graph, TREE_ROTATION, &choice);

    EXPECT(!tree_has(tree, 0) && tree_has(tree, 1) && tree_has(tree, 2));
    tree_free(tree);
    graph_free(graph);
}

static void preference_of_the_choice_goes_before_that_of_the_edges(void)
{
    Graph *graph = make_square();
    int preference[7] = {2, 1, 2, 1, 0, 0, 0};
    TreeChoice choice = {.preference = preference};
    Tree *tree = make_tree(graph, TREE_TRANSLATION, &choice);

    EXPECT(!tree_has(tree, 0) && tree_has(tree, 1) && !tree_has(tree, 2) && tree_has(tree, 3));
    tree_free(tree);
    graph_free(graph);
}

/* a series resistor and one to the datum in each section, the series one made first */
static void circuits_of_a_long_ladder_are_short(void)
{
    enum { SECTIONS = 200 };
    Graph *graph = graph_new();
    int last = graph_add_node(graph, "0", DOMAIN_ELECTRICAL, true);
    Edge edge = {.domain = DOMAIN_ELECTRICAL, .branching = {BRANCH_MAY, BRANCH_NEVER}};
    Tree *tree;
    SignMatrix *circuits;

    for (int k = 0; k < SECTIONS; k++) {
        char name[16];
        int next;

        (void)snprintf(name, sizeof name, "n%d", k);
        next = graph_add_node(graph, name, DOMAIN_ELECTRICAL, false);
        edge.name = "R";
        edge.tail = last;
        edge.head = next;
        (void)graph_add_edge(graph, &edge);
        edge.name = "G";
        edge.head = 0;
        edge.tail = next;
        (void)graph_add_edge(graph, &edge);
        last = next;
    }
    tree = make_tree(graph, TREE_ELECTRICAL, NULL);
    circuits = tree_circuits(tree);
    for (int r = 0; r < circuits->rows; r++)
        EXPECT(circuits->start[r + 1] - circuits->start[r] <= 3);
    sign_matrix_free(circuits);
    tree_free(tree);
    graph_free(graph);
}

static void exact_choice_is_taken_as_it_is(void)
{
    Graph *graph = make_square();
    int chosen[] = {1, 5};
    TreeChoice choice = {.branches = chosen, .branch_count = 2};
    Tree *tree = NULL;

    EXPECT(tree_complete(graph, TREE_ROTATION, &choice, true, &tree, NULL) == OK);
    EXPECT(tree != NULL && tree_has(tree, 1) && tree_has(tree, 5) && tree_has(tree, 4));
    tree_free(tree);
    graph_free(graph);
}

static void domain_without_nodes_has_an_empty_tree(void)
{
    Graph *graph = make_square();
    Tree *tree = make_tree(graph, TREE_HYDRAULIC, NULL);
    SignMatrix *circuits = tree_circuits(tree);
    SignMatrix *cutsets = tree_cutsets(tree);
    int nodes;

    (void)tree_nodes(tree, &nodes);
    EXPECT(nodes == 0 && tree_branch_count(tree) == 0 && tree_chord_count(tree) == 0);
    EXPECT(circuits->rows == 0 && cutsets->rows == 0);
    EXPECT(tree_depth(tree, 0) == -1 && !tree_is_forward(tree, 0));
    sign_matrix_free(circuits);
    sign_matrix_free(cutsets);
    tree_free(tree);
    graph_free(graph);
}

static void freeing_nothing_is_fine(void)
{
    tree_free(NULL);
    sign_matrix_free(NULL);
}

int main(void)
{
    RUN(incidence_and_cutsets_are_orthogonal_to_circuits);
    RUN(circuits_end_in_one_and_cutsets_begin_with_one);
    RUN(across_variables_sum_along_paths);
    RUN(beyond_is_found_by_climbing);
    RUN(parents_stand_before_children);
    RUN(completion_takes_edges_by_preference);
    RUN(arms_enter_unasked_and_virtual_joints_when_asked);
    RUN(excluded_edges_stay_out_unless_chosen);
    RUN(preference_of_the_choice_goes_before_that_of_the_edges);
    RUN(circuits_of_a_long_ladder_are_short);
    RUN(exact_choice_is_taken_as_it_is);
    RUN(domain_without_nodes_has_an_empty_tree);
    RUN(freeing_nothing_is_fine);
    return test_end();
}
