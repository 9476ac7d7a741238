/* test_graph_fault.c: trees that are none, and what is said about them */
#include "graph/tree.h"

#include "test.h"

typedef struct Case {
    Graph *graph;
    int chosen[40];
    int count;
    bool excluded[40];
    int preference[40];
} Case;

static int add(Case *c, const char *name, int tail, int head, Branching branching)
{
    Edge edge = {.name = name,
                 .tail = tail,
                 .head = head,
                 .domain = graph_node(c->graph, tail)->domain,
                 .branching = {branching, branching}};

    return graph_add_edge(c->graph, &edge);
}

static void choose(Case *c, const char *name)
{
    c->chosen[c->count++] = graph_find_edge(c->graph, name);
}

/* a four-bar: ground -h1- a -r1- b -h2- c -r2- d -h3- ground, a spring across, a way to e by h4
 * alone, and a circuit of terminals beside */
static Case make_four_bar(void)
{
    static const char *const nodes[] = {"ground", "a", "b", "c", "d", "e"};
    Case c = {.graph = graph_new()};

    for (int i = 0; i < COUNT(nodes); i++)
        (void)graph_add_node(c.graph, nodes[i], DOMAIN_MECHANICAL, i == 0);
    (void)graph_add_node(c.graph, "0", DOMAIN_ELECTRICAL, true);
    (void)graph_add_node(c.graph, "v1", DOMAIN_ELECTRICAL, false);
    (void)add(&c, "h1", 0, 1, BRANCH_MAY);
    (void)add(&c, "r1", 1, 2, BRANCH_ALWAYS);
    (void)add(&c, "h2", 2, 3, BRANCH_MAY);
    (void)add(&c, "r2", 4, 3, BRANCH_ALWAYS);
    (void)add(&c, "h3", 0, 4, BRANCH_MAY);
    (void)add(&c, "k1", 1, 4, BRANCH_NEVER);
    (void)add(&c, "h4", 4, 5, BRANCH_MAY);
    (void)add(&c, "v04", 0, 5, BRANCH_UNCHOSEN);
    (void)add(&c, "R1", 6, 7, BRANCH_MAY);
    return c;
}

/* tries, expects a failure that leaves `out` alone, and frees the graph */
static Diag fail(Case *c, TreeKind kind, bool exact, Status wanted)
{
    TreeChoice choice = {.branches = c->chosen,
                         .branch_count = c->count,
                         .excluded = c->excluded,
                         .preference = c->preference};
    Diag diag = {0};
    Tree *tree = NULL;

    EXPECT(tree_complete(c->graph, kind, &choice, exact, &tree, &diag) == wanted);
    EXPECT(diag.status == wanted);
    EXPECT(tree == NULL);
    /* and without a Diag */
    EXPECT(tree_complete(c->graph, kind, &choice, exact, &tree, NULL) == wanted);
    EXPECT(tree == NULL);
    graph_free(c->graph);
    return diag;
}

static void circuit_is_named_in_its_order(void)
{
    Case c = make_four_bar();

    choose(&c, "h1");
    choose(&c, "h2");
    choose(&c, "h3");
    Diag diag = fail(&c, TREE_ROTATION, false, E_CIRCUIT);
    EXPECT_TEXT(diag.message, "the rotation tree contains the circuit h3 r2 h2 r1 h1");
    EXPECT_TEXT(diag.hint, "drop h3, or another that is no arm: h2, h1");
}

static void edge_of_highest_preference_is_to_be_dropped(void)
{
    Case c = make_four_bar();

    c.preference[graph_find_edge(c.graph, "h2")] = 3;
    choose(&c, "h1");
    choose(&c, "h2");
    choose(&c, "h3");
    EXPECT_TEXT(fail(&c, TREE_TRANSLATION, true, E_CIRCUIT).hint,
                "drop h2, or another that is no arm: h3, h1");
}

static void circuit_with_arms_names_the_one_edge_to_drop(void)
{
    Case c = make_four_bar();

    (void)add(&c, "h9", 2, 1, BRANCH_MAY);
    choose(&c, "h9");
    Diag diag = fail(&c, TREE_TRANSLATION, false, E_CIRCUIT);
    EXPECT_TEXT(diag.message, "the translation tree contains the circuit h9 r1");
    EXPECT_TEXT(diag.hint, "drop h9: the others are arms, which are always branches");
}

static void edge_onto_its_own_node_is_a_circuit(void)
{
    Case c = make_four_bar();

    (void)add(&c, "h9", 2, 2, BRANCH_MAY);
    choose(&c, "h9");
    Diag diag = fail(&c, TREE_TRANSLATION, false, E_CIRCUIT);
    EXPECT_TEXT(diag.message, "the translation tree contains the circuit h9");
    EXPECT_TEXT(diag.hint, "drop h9: it begins and ends in one node");
}

static void loop_of_arms_is_a_redundant_weld(void)
{
    Case c = make_four_bar();

    (void)add(&c, "r3", 2, 4, BRANCH_ALWAYS);
    (void)add(&c, "r4", 3, 1, BRANCH_ALWAYS);
    Diag diag = fail(&c, TREE_ROTATION, false, E_CIRCUIT);
    EXPECT_TEXT(diag.message,
                "arms r4, r1, r3, r2 form a closed loop; one is a weld that is redundant");
    EXPECT_TEXT(diag.hint, "delete one of these arms, or put a joint in its place");
}

static void force_edge_cannot_be_a_branch(void)
{
    Case c = make_four_bar();

    choose(&c, "k1");
    Diag diag = fail(&c, TREE_TRANSLATION, false, E_BRANCH);
    EXPECT_TEXT(diag.message, "edge k1 has no across relation; only bodies, joints, arms, virtual "
                              "joints and drivers can be branches");
    EXPECT_TEXT(diag.hint, "leave k1 in the cotree");
}

static void scalar_edge_may_be_bound_to_the_cotree(void)
{
    Case c = make_four_bar();

    (void)add(&c, "I1", 6, 7, BRANCH_NEVER);
    choose(&c, "I1");
    Diag diag = fail(&c, TREE_ELECTRICAL, false, E_BRANCH);
    EXPECT_TEXT(diag.message, "edge I1 can only be a chord of the electrical tree");
    EXPECT_TEXT(diag.hint, "leave I1 in the cotree");
}

static void edge_of_another_domain_cannot_be_a_branch(void)
{
    Case c = make_four_bar();

    choose(&c, "R1");
    Diag diag = fail(&c, TREE_ROTATION, false, E_BRANCH);
    EXPECT_TEXT(diag.message, "edge R1 is electrical and no part of the rotation tree");
    EXPECT_TEXT(diag.hint, "name mechanical edges only");
}

static void arm_cannot_be_kept_out(void)
{
    Case c = make_four_bar();

    c.excluded[graph_find_edge(c.graph, "r2")] = true;
    Diag diag = fail(&c, TREE_ROTATION, false, E_BRANCH);
    EXPECT_TEXT(diag.message, "arm r2 cannot be kept out of the rotation tree");
    EXPECT_TEXT(diag.hint, "arms are branches of every tree; keep out a joint or a body");
}

static void one_missing_branch_is_offered_with_its_rivals(void)
{
    Case c = make_four_bar();

    choose(&c, "h1");
    choose(&c, "h4");
    Diag diag = fail(&c, TREE_ROTATION, true, E_UNREACHED);
    EXPECT_TEXT(diag.message,
                "the rotation tree does not span: nodes c, d, e cannot be reached from ground");
    EXPECT_TEXT(diag.hint, "add one of h2, h3, v04 to the tree");
}

static void many_missing_branches_are_offered_as_one_set(void)
{
    Case c = make_four_bar();
    Diag diag = fail(&c, TREE_ROTATION, true, E_UNREACHED);

    EXPECT_TEXT(diag.message, "the rotation tree does not span: nodes a, b, c, d, e cannot be "
                              "reached from ground");
    EXPECT_TEXT(diag.hint, "add h1, h2, h4 to the tree");
}

static void excluded_edge_is_what_would_connect(void)
{
    Case c = make_four_bar();

    c.excluded[graph_find_edge(c.graph, "h1")] = true;
    c.excluded[graph_find_edge(c.graph, "h3")] = true;
    c.excluded[graph_find_edge(c.graph, "h4")] = true;
    choose(&c, "v04");
    Diag diag = fail(&c, TREE_ROTATION, false, E_UNREACHED);
    EXPECT_TEXT(diag.message,
                "the rotation tree does not span: nodes a, b, c, d cannot be reached from ground");
    EXPECT_TEXT(diag.hint, "add one of h1, h3, h4 to the tree");
}

static void the_only_way_is_offered_alone(void)
{
    Case c = make_four_bar();

    c.excluded[graph_find_edge(c.graph, "R1")] = true;
    Diag diag = fail(&c, TREE_ELECTRICAL, false, E_UNREACHED);
    EXPECT_TEXT(diag.message,
                "the electrical tree does not span: node v1 cannot be reached from 0");
    EXPECT_TEXT(diag.hint, "add R1 to the tree");
}

static void node_that_no_branch_can_reach_wants_a_component(void)
{
    Case c = make_four_bar();
    int frame = graph_add_node(c.graph, "f", DOMAIN_MECHANICAL, false);

    (void)add(&c, "k2", 0, frame, BRANCH_NEVER);
    Diag diag = fail(&c, TREE_TRANSLATION, false, E_UNREACHED);
    EXPECT_TEXT(diag.message,
                "the translation tree does not span: node f cannot be reached from ground");
    EXPECT_TEXT(diag.hint,
                "no edge that can be a branch leads to f: add a body, a joint or an arm");
}

static void floating_terminals_want_a_component(void)
{
    Case c = make_four_bar();
    int two = graph_add_node(c.graph, "v2", DOMAIN_ELECTRICAL, false);
    int three = graph_add_node(c.graph, "v3", DOMAIN_ELECTRICAL, false);

    (void)add(&c, "R2", two, three, BRANCH_MAY);
    Diag diag = fail(&c, TREE_ELECTRICAL, false, E_UNREACHED);
    EXPECT_TEXT(diag.message,
                "the electrical tree does not span: nodes v2, v3 cannot be reached from 0");
    EXPECT_TEXT(diag.hint, "no edge that can be a branch leads to v2, v3: connect them to 0");
}

static void domain_without_datum_is_told_so(void)
{
    Case c = make_four_bar();
    int hot = graph_add_node(c.graph, "hot", DOMAIN_THERMAL, false);
    int cold = graph_add_node(c.graph, "cold", DOMAIN_THERMAL, false);

    (void)add(&c, "W1", hot, cold, BRANCH_MAY);
    Diag diag = fail(&c, TREE_THERMAL, false, E_UNREACHED);
    EXPECT_TEXT(diag.message, "the thermal tree does not span: nodes hot, cold cannot be reached, "
                              "there is no datum");
    EXPECT_TEXT(diag.hint, "connect one of them to 0");

    c = (Case){.graph = graph_new()};
    (void)graph_add_node(c.graph, "a", DOMAIN_MECHANICAL, false);
    diag = fail(&c, TREE_ROTATION, false, E_UNREACHED);
    EXPECT_TEXT(diag.message, "the rotation tree does not span: node a cannot be reached, there is "
                              "no datum");
    EXPECT_TEXT(diag.hint, "connect it to ground");
}

static void long_lists_are_cut_short(void)
{
    Case c = {.graph = graph_new()};
    char name[80];

    (void)graph_add_node(c.graph, "ground", DOMAIN_MECHANICAL, true);
    for (int i = 1; i <= 20; i++) {
        (void)snprintf(name, sizeof name, "n%d", i);
        (void)graph_add_node(c.graph, name, DOMAIN_MECHANICAL, false);
    }
    EXPECT_TEXT(fail(&c, TREE_ROTATION, true, E_UNREACHED).message,
                "the rotation tree does not span: nodes n1, n2, n3, n4, n5, n6, n7, n8 and 12 more "
                "cannot be reached from ground");

    /* names as long as this page is wide */
    c = (Case){.graph = graph_new()};
    (void)graph_add_node(c.graph, "ground", DOMAIN_MECHANICAL, true);
    for (int i = 1; i <= 5; i++) {
        memset(name, 'a' + i, sizeof name);
        name[sizeof name - 1] = '\0';
        (void)graph_add_node(c.graph, name, DOMAIN_MECHANICAL, false);
    }
    Diag diag = fail(&c, TREE_ROTATION, true, E_UNREACHED);
    EXPECT(strstr(diag.message, " and 3 more cannot be reached from ground") != NULL);
}

int main(void)
{
    RUN(circuit_is_named_in_its_order);
    RUN(edge_of_highest_preference_is_to_be_dropped);
    RUN(circuit_with_arms_names_the_one_edge_to_drop);
    RUN(edge_onto_its_own_node_is_a_circuit);
    RUN(loop_of_arms_is_a_redundant_weld);
    RUN(force_edge_cannot_be_a_branch);
    RUN(scalar_edge_may_be_bound_to_the_cotree);
    RUN(edge_of_another_domain_cannot_be_a_branch);
    RUN(arm_cannot_be_kept_out);
    RUN(one_missing_branch_is_offered_with_its_rivals);
    RUN(many_missing_branches_are_offered_as_one_set);
    RUN(excluded_edge_is_what_would_connect);
    RUN(the_only_way_is_offered_alone);
    RUN(node_that_no_branch_can_reach_wants_a_component);
    RUN(floating_terminals_want_a_component);
    RUN(domain_without_datum_is_told_so);
    RUN(long_lists_are_cut_short);
    return test_end();
}
