/* tree_search.c: candidates, their neighbours, and the local search */
#include "formulate/system_build/tree_search.h"

#include "base/text.h"

#include <stdlib.h>
#include <string.h>

/* of one pair of trees that are listed: a chain of 300 bodies has 100 000, of which
 * TREE_SEARCH_MOST are formed */
enum { MOST_EXCHANGES = 5 * TREE_SEARCH_MOST };

static int edge_count(const TreeSearch *search)
{
    return graph_edge_count(search->scene.graph);
}

static bool is_over(const TreeSearch *search)
{
    return search->formed >= TREE_SEARCH_MOST || monitor_poll(search->watch) != OK;
}

/* --- candidates --- */

static void pair_free(TreePair *pair)
{
    if (pair == NULL)
        return;
    MEM_FREE(pair->branch[0], pair->branch[1], pair->key, pair);
}

static TreePair *pair_new(const TreeSearch *search)
{
    TreePair *pair = NEW(TreePair);

    pair->branch[0] = NEW_ARRAY(bool, edge_count(search));
    pair->branch[1] = NEW_ARRAY(bool, edge_count(search));
    return pair;
}

static char *key_of(const TreeSearch *search, const TreePair *pair)
{
    Text text = {0};

    for (int half = 0; half < 2; half++) {
        for (int e = 0; e < edge_count(search); e++)
            if (pair->branch[half][e])
                text_addf(&text, " %s", graph_edge(search->scene.graph, e)->name);
        text_char(&text, '\n');
    }
    return text_done(&text);
}

/* coordinates that an edge has as a branch of that tree */
static int coordinates_of(const TreeSearch *search, int e, int half)
{
    const Instance *owner = search->scene.instances[search->owner[e]];
    int count = 0;

    for (int k = 0; owner->edge == e && k < owner->coord_count; k++)
        count += (owner->coord_rotation[k] ? 1 : 0) == half;
    return count;
}

/* computes the key of a pair; NULL, and the pair is freed, where it was seen before */
static TreePair *enter(TreeSearch *search, TreePair *pair)
{
    pair->key = key_of(search, pair);
    for (int i = 0; i < search->seen.count; i++)
        if (strcmp(search->seen.at[i]->key, pair->key) == 0) {
            pair_free(pair);
            return NULL;
        }
    for (int e = 0; e < edge_count(search); e++) {
        const Instance *owner = search->scene.instances[search->owner[e]];

        pair->proposed += e >= search->own && (pair->branch[0][e] || pair->branch[1][e]);
        if (owner->row->family == FAMILY_BODY)
            pair->bodies += pair->branch[0][e] + pair->branch[1][e];
        for (int half = 0; half < 2; half++)
            if (pair->branch[half][e])
                pair->coordinates += coordinates_of(search, e, half);
    }
    LIST_PUSH(search->seen, pair);
    return pair;
}

bool tree_search_trees(const TreeSearch *search, const TreePair *pair, Tree *out[2])
{
    out[0] = out[1] = NULL;
    for (int half = 0; half < 2; half++) {
        LIST(int) branches = {0};
        TreeChoice choice = {0};
        Status status;

        for (int e = 0; e < edge_count(search); e++)
            if (pair->branch[half][e])
                LIST_PUSH(branches, e);
        choice.branches = branches.at;
        choice.branch_count = branches.count;
        status =
            tree_complete(search->scene.graph, (TreeKind)half, &choice, true, &out[half], NULL);
        LIST_FREE(branches);
        if (status != OK) {
            tree_free(out[0]);
            out[0] = out[1] = NULL;
            return false;
        }
    }
    return true;
}

/* cost of a pair of trees; a refused pair has none */
static void price(TreeSearch *search, TreePair *pair)
{
    const SystemOptions options = {.form = search->scene.network_form, .watch = search->watch};
    Scene scene = search->scene;
    ArenaMark *mark;
    const System *system = NULL;
    Tree *trees[2];
    Diag ignored;

    if (is_over(search) || !tree_search_trees(search, pair, trees))
        return;
    monitor_report(search->watch, "trees", (double)search->formed / TREE_SEARCH_MOST);
    search->formed++;
    scene.trees[TREE_TRANSLATION] = trees[0];
    scene.trees[TREE_ROTATION] = trees[1];
    mark = arena_mark(scene.arena);
    if (system_new(&scene, &options, &system, &ignored) == OK) {
        pair->is_priced = system_price(system, search->watch, &pair->count, &pair->price) == OK;
        pair->n = system_n(system);
        pair->m = system_m(system);
    }
    system_free(system);
    arena_release(scene.arena, mark);
    tree_free(trees[0]);
    tree_free(trees[1]);
}

/* cheaper first; at equal cost fewer new joints, then fewer coordinates, then joints before
 * bodies */
static bool is_better(const TreePair *a, const TreePair *b)
{
    if (!a->is_priced || !b->is_priced)
        return !b->is_priced && a->is_priced;
    if (a->price != b->price)
        return a->price < b->price;
    if (a->proposed != b->proposed)
        return a->proposed < b->proposed;
    return a->n != b->n ? a->n < b->n : a->bodies < b->bodies;
}

/* --- neighbours --- */

static bool can_enter(const TreeSearch *search, int edge, int half)
{
    const Branching branching = graph_branching(search->scene.graph, edge, (TreeKind)half);

    return branching == BRANCH_MAY || branching == BRANCH_UNCHOSEN;
}

/* replaces one branch by one chord, in the trees of `halves` (bits) */
typedef struct Exchange {
    int halves, goes, comes;
    int more; /* coordinates that it adds */
} Exchange;
typedef LIST(Exchange) Exchanges;

static void exchange(TreeSearch *search, const TreePair *pair, const Exchange *by)
{
    TreePair *next = pair_new(search);

    for (int half = 0; half < 2; half++) {
        memcpy(next->branch[half], pair->branch[half], (size_t)edge_count(search) * sizeof(bool));
        if ((by->halves & 1 << half) == 0)
            continue;
        next->branch[half][by->goes] = false;
        next->branch[half][by->comes] = true;
    }
    (void)enter(search, next);
}

static void add_exchange(const TreeSearch *search, Exchanges *out, int halves, int goes, int comes)
{
    Exchange by = {.halves = halves, .goes = goes, .comes = comes};

    for (int half = 0; half < 2; half++)
        if ((halves & 1 << half) != 0)
            by.more += coordinates_of(search, comes, half) - coordinates_of(search, goes, half);
    LIST_PUSH(*out, by);
}

static int brings_fewer(const void *a, const void *b)
{
    const Exchange *x = a, *y = b;

    if (x->more != y->more)
        return x->more - y->more;
    if (x->comes != y->comes)
        return x->comes - y->comes;
    return x->goes != y->goes ? x->goes - y->goes : x->halves - y->halves;
}

/* bits of the trees in which `branch` is on the circuit of the chord: on[branch] */
static void mark_circuit(const TreeSearch *search, Tree *const trees[2], int chord,
                         unsigned char *on)
{
    const int edges = edge_count(search);
    const Edge *edge = graph_edge(search->scene.graph, chord);
    /* a way up from each end */
    int *path = NEW_ARRAY(int, 2 * edges);
    int *signs = NEW_ARRAY(int, 2 * edges);

    memset(on, 0, (size_t)edges);
    for (int half = 0; half < 2; half++) {
        int count;

        if (tree_has(trees[half], chord) || !can_enter(search, chord, half))
            continue;
        count = tree_path(trees[half], edge->tail, edge->head, path, signs);
        for (int i = 0; i < count; i++)
            if (can_enter(search, path[i], half))
                on[path[i]] |= (unsigned char)(1U << half);
    }
    MEM_FREE(path, signs);
}

static int fewer_coordinates(const void *a, const void *b)
{
    const TreePair *x = *(TreePair *const *)a;
    const TreePair *y = *(TreePair *const *)b;

    if (x->coordinates != y->coordinates)
        return x->coordinates - y->coordinates;
    return strcmp(x->key, y->key);
}

/* new neighbours, those of few coordinates first. Of very many only as many are listed as the limit
 * of systems can never exhaust. Returns the index where they start. */
static int find_neighbours(TreeSearch *search, const TreePair *pair)
{
    const Graph *graph = search->scene.graph;
    const int first = search->seen.count;
    Exchanges exchanges = {0};
    unsigned char *on;
    Tree *trees[2];

    if (!tree_search_trees(search, pair, trees))
        return first;
    on = NEW_ARRAY(unsigned char, edge_count(search));
    for (int chord = 0; chord < edge_count(search) && monitor_poll(search->watch) == OK; chord++) {
        if (graph_edge(graph, chord)->domain != DOMAIN_MECHANICAL)
            continue;
        mark_circuit(search, trees, chord, on);
        for (int e = 0; e < edge_count(search); e++)
            for (int halves = 1; halves <= 3; halves++)
                if ((on[e] & halves) == halves)
                    add_exchange(search, &exchanges, halves, e, chord);
    }
    mem_free(on);
    if (exchanges.count > MOST_EXCHANGES) {
        qsort(exchanges.at, (size_t)exchanges.count, sizeof *exchanges.at, brings_fewer);
        exchanges.count = MOST_EXCHANGES;
    }
    for (int i = 0; i < exchanges.count && monitor_poll(search->watch) == OK; i++)
        exchange(search, pair, &exchanges.at[i]);
    LIST_FREE(exchanges);
    tree_free(trees[0]);
    tree_free(trees[1]);
    if (search->seen.count > first)
        qsort(search->seen.at + first, (size_t)(search->seen.count - first),
              sizeof *search->seen.at, fewer_coordinates);
    return first;
}

static void descend(TreeSearch *search, const TreePair *start)
{
    const TreePair *here = start;

    while (here->is_priced && !is_over(search)) {
        const TreePair *best = here;

        for (int i = find_neighbours(search, here); i < search->seen.count; i++) {
            price(search, search->seen.at[i]);
            if (is_better(search->seen.at[i], best))
                best = search->seen.at[i];
        }
        if (best == here)
            return;
        here = best;
    }
}

/* --- the search --- */

TreeSearch tree_search_open(const Scene *scene, int own, const CallMonitor *watch)
{
    TreeSearch search = {.scene = *scene, .own = own, .watch = watch};

    search.owner = NEW_ARRAY(int, graph_edge_count(scene->graph));
    for (int i = 0; i < scene->instance_count; i++) {
        const Instance *instance = scene->instances[i];

        if (instance->edge >= 0)
            search.owner[instance->edge] = i;
        for (int k = 0; k < instance->scalar_count; k++)
            search.owner[instance->scalar_edges[k]] = i;
    }
    return search;
}

void tree_search_close(TreeSearch *search)
{
    for (int i = 0; i < search->seen.count; i++)
        pair_free(search->seen.at[i]);
    LIST_FREE(search->seen);
    mem_free(search->owner);
}

void tree_search_start(TreeSearch *search, const Tree *const halves[2], const char *called)
{
    TreePair *pair = pair_new(search);

    for (int half = 0; half < 2; half++)
        for (int e = 0; e < edge_count(search); e++)
            pair->branch[half][e] =
                graph_edge_in(search->scene.graph, e, (TreeKind)half) && tree_has(halves[half], e);
    pair = enter(search, pair);
    if (pair == NULL)
        return;
    pair->called = called;
    price(search, pair);
}

static int cheaper(const void *a, const void *b)
{
    const TreePair *x = *(TreePair *const *)a;
    const TreePair *y = *(TreePair *const *)b;

    return is_better(x, y) ? -1 : is_better(y, x) ? 1 : strcmp(x->key, y->key);
}

void tree_search_run(TreeSearch *search)
{
    const int starts = search->seen.count;
    bool *done = NEW_ARRAY(bool, starts);

    /* from the cheapest start first: the limit of systems may exclude the others */
    for (int round = 0; round < starts; round++) {
        int next = -1;

        for (int i = 0; i < starts; i++)
            if (!done[i] && (next < 0 || is_better(search->seen.at[i], search->seen.at[next])))
                next = i;
        done[next] = true;
        descend(search, search->seen.at[next]);
    }
    mem_free(done);
    if (search->seen.count > 0)
        qsort(search->seen.at, (size_t)search->seen.count, sizeof *search->seen.at, cheaper);
}
