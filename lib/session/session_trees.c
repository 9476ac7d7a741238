/* session_trees.c: `tree best`, the search for the trees of cheapest equations
 *
 * A candidate is a pair of mechanical trees, as the statements that choose it. It is
 * priced by formulating it in a model of its own (system_price). From each start (the
 * trees as they are, those of joints, those of bodies) the search goes to the cheapest
 * neighbour as long as one is cheaper; neighbours exchange one branch for one chord of
 * whose circuit it is part, in one tree or both. Virtual joints between frames that turn
 * about one axis stand among the edges, chords until an exchange takes them in. */
#include "session/session_impl.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_SYSTEMS = 200, MOST_ROWS = 8 };
#define PATIENCE 10.0 /* s */

static const char as_it_was[] = "as it was";

typedef struct Candidate {
    bool *branch[2];    /* of translation and rotation, one an edge */
    char *text;         /* statements that choose it */
    const char *called; /* "as it was"; NULL */
    char *trees;        /* as the table shows them; NULL: it is refused, or not priced */
    int n, m;
    int coordinates; /* of its branches */
    int proposed;    /* branches that the model doesn't have yet */
    int bodies;      /* branches that are bodies */
    OpCount count;
    double price;
} Candidate;

typedef struct Search {
    ct_session *session;
    char *base;   /* statements of the model and of the joints proposed */
    Model *model; /* of these */
    int edges;    /* of its graph */
    int own;      /* those that the session's model has */
    LIST(char *) proposals;
    LIST(Candidate *) seen;
    int formulated;
    bool is_stopped; /* by the user */
    bool is_late;
    double began;
    Watch watch; /* that stops at either */
} Search;

static double seconds(void)
{
    struct timespec now;

    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool stop(void *context)
{
    Search *search = context;

    search->is_stopped = search->is_stopped || poll(&search->session->watch) != OK;
    search->is_late = search->is_late || seconds() - search->began > PATIENCE;
    return search->is_stopped || search->is_late;
}

static bool is_over(const Search *search)
{
    return search->is_stopped || search->is_late || search->formulated >= MOST_SYSTEMS;
}

/* --- statements --- */

/* apply every statement of a text; the model is as far as it came */
static Status apply_text(Model *model, const char *text, int *count, Diag *diag)
{
    const size_t length = strlen(text);
    Statement *statement = NULL;
    size_t next = 0;
    Status status = OK;

    while (next < length) {
        CHECK(statement_parse(text, 1, (SyntaxOptions){false}, &next, &statement, diag));
        if (statement->kind != STATEMENT_EMPTY) {
            CHECK(model_apply(model, statement, diag));
            *count += 1;
        }
        statement_free(statement);
        statement = NULL;
    }
done:
    statement_free(statement);
    return status;
}

Status session_model_copy(const ct_session *session, const char *base, const char *more,
                          Model **out, Diag *diag)
{
    Model *model = model_new();
    int count = 0;
    Status status;

    assert(base != NULL && more != NULL);
    model_share_data(model, session->model);
    CHECK(apply_text(model, base, &count, diag));
    CHECK(apply_text(model, more, &count, diag));
    *out = model;
    model = NULL;
done:
    model_free(model);
    return status;
}

/* a name of an edge where words of the verb would win over it */
static void add_edge(Text *text, const char *name)
{
    Verb verb = {.words = NULL};
    bool is_word = false;

    (void)verb_find("tree", &verb);
    for (int i = 0; verb.words != NULL && verb.words[i] != NULL; i++)
        is_word = is_word || strcmp(verb.words[i], name) == 0;
    text_addf(text, is_word ? " (%s)" : " %s", name);
}

/* the statements that choose a candidate, joints proposed first */
static char *statements_of(const Search *search, const Candidate *c, bool with_joints)
{
    const Graph *graph = model_graph(search->model);
    Text text = {0};

    for (int e = search->own; with_joints && e < search->edges; e++)
        if (c->branch[0][e] || c->branch[1][e])
            text_addf(&text, "%s\n", search->proposals.at[e - search->own]);
    for (int half = 0; half < 2; half++) {
        text_addf(&text, "tree %s", tree_kind_name((TreeKind)half));
        for (int e = 0; e < search->edges; e++)
            if (c->branch[half][e] && graph_branching(graph, e, (TreeKind)half) != BRANCH_ALWAYS)
                add_edge(&text, graph_edge(graph, e)->name);
        text_char(&text, '\n');
    }
    return text_done(&text);
}

/* --- candidates --- */

static void candidate_free(Candidate *c)
{
    if (c == NULL)
        return;
    mem_free(c->branch[0]);
    mem_free(c->branch[1]);
    mem_free(c->text);
    mem_free(c->trees);
    mem_free(c);
}

static Candidate *candidate_new(const Search *search)
{
    Candidate *c = NEW(Candidate);

    c->branch[0] = NEW_ARRAY(bool, search->edges);
    c->branch[1] = NEW_ARRAY(bool, search->edges);
    return c;
}

/* tell what it is; NULL, and it is freed, where it was seen before */
static Candidate *candidate_enter(Search *search, Candidate *c)
{
    c->text = statements_of(search, c, false);
    for (int i = 0; i < search->seen.count; i++)
        if (strcmp(search->seen.at[i]->text, c->text) == 0) {
            candidate_free(c);
            return NULL;
        }
    for (int e = 0; e < search->edges; e++) {
        const Instance *owner = model_edge_owner(search->model, e);

        c->proposed += e >= search->own && (c->branch[0][e] || c->branch[1][e]);
        if (owner->row->family == FAMILY_BODY)
            c->bodies += c->branch[0][e] + c->branch[1][e];
        for (int k = 0; owner->edge == e && k < owner->coord_count; k++)
            c->coordinates += c->branch[owner->coord_rotation[k] ? 1 : 0][e];
    }
    LIST_PUSH(search->seen, c);
    return c;
}

/* formulate it and take its price; a pair of trees that is refused has none */
static void candidate_price(Search *search, Candidate *c)
{
    const Tree *trees[TREE_KINDS] = {NULL};
    Model *model = NULL;
    System *system = NULL;
    Diag ignored;

    if (is_over(search))
        return;
    report(&search->session->watch, "trees", (double)search->formulated / MOST_SYSTEMS);
    search->formulated++;
    if (session_model_copy(search->session, search->base, c->text, &model, &ignored) == OK &&
        model_trees(model, trees, &ignored) == OK &&
        system_new(model, &search->watch, &system, &ignored) == OK) {
        c->trees = tree_brief(model, trees);
        c->n = system_n(system);
        c->m = system_m(system);
        c->count = system_program_count(system);
        c->price = system_price(system);
    }
    system_free(system);
    model_free(model);
}

/* cheaper first; at one price fewer new joints, then fewer coordinates, then joints not bodies */
static bool is_better(const Candidate *a, const Candidate *b)
{
    if (a->trees == NULL || b->trees == NULL)
        return b->trees == NULL && a->trees != NULL;
    if (a->price != b->price)
        return a->price < b->price;
    if (a->proposed != b->proposed)
        return a->proposed < b->proposed;
    return a->n != b->n ? a->n < b->n : a->bodies < b->bodies;
}

/* --- neighbours --- */

static bool can_enter(const Search *search, int edge, int half)
{
    const Branching branching = graph_branching(model_graph(search->model), edge, (TreeKind)half);

    return branching == BRANCH_MAY || branching == BRANCH_UNCHOSEN;
}

/* the candidate's tree; NULL: it is none */
static Tree *tree_of(const Search *search, const Candidate *c, int half)
{
    LIST(int) branches = {0};
    TreeChoice choice = {0};
    Tree *tree = NULL;

    for (int e = 0; e < search->edges; e++)
        if (c->branch[half][e])
            LIST_PUSH(branches, e);
    choice.branches = branches.at;
    choice.branch_count = branches.count;
    if (tree_complete(model_graph(search->model), (TreeKind)half, &choice, true, &tree, NULL) != OK)
        tree = NULL;
    LIST_FREE(branches);
    return tree;
}

/* in `halves` (bits) one branch goes and one chord comes */
static void exchange(Search *search, const Candidate *c, int halves, int goes, int comes)
{
    Candidate *next = candidate_new(search);

    for (int half = 0; half < 2; half++) {
        memcpy(next->branch[half], c->branch[half], (size_t)search->edges * sizeof(bool));
        if ((halves & 1 << half) == 0)
            continue;
        next->branch[half][goes] = false;
        next->branch[half][comes] = true;
    }
    (void)candidate_enter(search, next);
}

/* bits of the trees in which `branch` is on the circuit of the chord: on[branch] */
static void mark_circuit(const Search *search, Tree *const trees[2], int chord, unsigned char *on)
{
    const Edge *edge = graph_edge(model_graph(search->model), chord);
    /* a way up from each end */
    int *path = NEW_ARRAY(int, 2 * search->edges);
    int *signs = NEW_ARRAY(int, 2 * search->edges);

    memset(on, 0, (size_t)search->edges);
    for (int half = 0; half < 2; half++) {
        int count;

        if (tree_has(trees[half], chord) || !can_enter(search, chord, half))
            continue;
        count = tree_path(trees[half], edge->tail, edge->head, path, signs);
        for (int i = 0; i < count; i++)
            if (can_enter(search, path[i], half))
                on[path[i]] |= (unsigned char)(1U << half);
    }
    mem_free(path);
    mem_free(signs);
}

static int fewer_coordinates(const void *a, const void *b)
{
    const Candidate *x = *(Candidate *const *)a;
    const Candidate *y = *(Candidate *const *)b;

    if (x->coordinates != y->coordinates)
        return x->coordinates - y->coordinates;
    return strcmp(x->text, y->text);
}

/* all neighbours not met before, those of few coordinates first; returns where they start */
static int find_neighbours(Search *search, const Candidate *c)
{
    const Graph *graph = model_graph(search->model);
    const int first = search->seen.count;
    Tree *const trees[2] = {tree_of(search, c, 0), tree_of(search, c, 1)};
    unsigned char *on = NEW_ARRAY(unsigned char, search->edges);

    for (int chord = 0; trees[0] != NULL && trees[1] != NULL && chord < search->edges; chord++) {
        if (graph_edge(graph, chord)->domain != DOMAIN_MECHANICAL)
            continue;
        mark_circuit(search, trees, chord, on);
        for (int e = 0; e < search->edges; e++)
            for (int halves = 1; halves <= 3; halves++)
                if ((on[e] & halves) == halves)
                    exchange(search, c, halves, e, chord);
    }
    mem_free(on);
    tree_free(trees[0]);
    tree_free(trees[1]);
    if (search->seen.count > first)
        qsort(search->seen.at + first, (size_t)(search->seen.count - first),
              sizeof *search->seen.at, fewer_coordinates);
    return first;
}

static void descend(Search *search, const Candidate *start)
{
    const Candidate *here = start;

    while (here->trees != NULL && !is_over(search)) {
        const Candidate *best = here;

        for (int i = find_neighbours(search, here); i < search->seen.count; i++) {
            candidate_price(search, search->seen.at[i]);
            if (is_better(search->seen.at[i], best))
                best = search->seen.at[i];
        }
        if (best == here)
            return;
        here = best;
    }
}

/* --- joints to propose --- */

static const char *fresh_name(const Search *search, const char *of, Text *name)
{
    for (int i = 0; i == 0 || model_find(search->model, name->at) != NULL; i++) {
        text_free(name);
        text_addf(name, i == 0 ? "v%s" : "v%s_%d", of, i);
    }
    return name->at;
}

/* "virtual revolute vm3 r6 m3 axis=[0, 0, 1]" for frames of the joints' trees that turn about one
 * axis */
static Status find_proposals(Search *search, Diag *diag)
{
    const Graph *graph = model_graph(search->model);
    System *system = NULL;
    CommonTurn *turns = NULL;
    Text name = {0};
    int count = 0;
    Status status;

    CHECK(system_new(search->model, &search->watch, &system, diag));
    turns = system_common_turns(system, &count);
    for (int i = 0; i < count; i++) {
        const char *head = graph_node(graph, turns[i].head)->name;
        Text text = {0};

        text_addf(&text, "virtual revolute %s %s %s axis=[", fresh_name(search, head, &name),
                  graph_node(graph, turns[i].tail)->name, head);
        for (int k = 0; k < 3; k++) {
            char *entry = expr_text(turns[i].axis[k]);

            text_addf(&text, k > 0 ? ", %s" : "%s", entry);
            mem_free(entry);
        }
        text_char(&text, ']');
        LIST_PUSH(search->proposals, text_done(&text));
    }
done:
    text_free(&name);
    mem_free(turns);
    system_free(system);
    return status;
}

/* the model with the joints proposed among its edges; those that it doesn't take are left out */
static Status add_proposals(Search *search, Diag *diag)
{
    Text base = {0};
    Model *with = NULL;
    int kept = 0;
    Diag ignored;
    Status status;

    CHECK(session_model_copy(search->session, search->base, "", &with, diag));
    text_add(&base, search->base);
    for (int i = 0; i < search->proposals.count; i++) {
        int count = 0;

        if (apply_text(with, search->proposals.at[i], &count, &ignored) != OK) {
            mem_free(search->proposals.at[i]);
            continue;
        }
        text_addf(&base, "%s\n", search->proposals.at[i]);
        search->proposals.at[kept++] = search->proposals.at[i];
    }
    search->proposals.count = kept;
    mem_free(search->base);
    search->base = text_done(&base);
    model_free(search->model);
    search->model = with;
    search->edges = graph_edge_count(model_graph(with));
done:
    return status;
}

/* --- the search --- */

/* one of the starts; NULL: the trees are as another start's */
static Candidate *add_start(Search *search, const char *text, const char *called)
{
    const Tree *trees[TREE_KINDS] = {NULL};
    Candidate *c = NULL;
    Model *model = NULL;
    Diag ignored;

    if (session_model_copy(search->session, search->base, text, &model, &ignored) == OK &&
        model_trees(model, trees, &ignored) == OK) {
        c = candidate_new(search);
        for (int half = 0; half < 2; half++)
            for (int e = 0; e < search->edges; e++)
                c->branch[half][e] = graph_edge_in(model_graph(model), e, (TreeKind)half) &&
                                     tree_has(trees[half], e);
        c = candidate_enter(search, c);
    }
    model_free(model);
    if (c == NULL)
        return NULL;
    c->called = called;
    candidate_price(search, c);
    return c;
}

static Status open_search(Search *search, Diag *diag)
{
    const Tree *trees[TREE_KINDS] = {NULL};
    Status status;

    search->began = seconds();
    search->watch = (Watch){.context = search, .stop = stop};
    CHECK(model_trees(search->session->model, trees, diag));
    if (trees[TREE_TRANSLATION] == NULL) {
        status = diag_set(diag, E_MODEL, "there are no bodies and joints whose trees to compare");
        goto done;
    }
    search->base = model_save(search->session->model);
    search->own = graph_edge_count(model_graph(search->session->model));
    CHECK(session_model_copy(search->session, search->base, "tree joint\n", &search->model, diag));
    CHECK(find_proposals(search, diag));
    CHECK(add_proposals(search, diag));
done:
    return status;
}

static void run_search(Search *search)
{
    static const struct {
        const char *text, *called;
    } presets[] = {
        {"", as_it_was}, {"tree joint\n", "tree joint"}, {"tree absolute\n", "tree absolute"}};
    Candidate *starts[COUNT(presets)];
    int from[COUNT(presets)] = {0};

    for (int i = 0; i < COUNT(presets); i++)
        starts[i] = add_start(search, presets[i].text, presets[i].called);
    /* from the cheapest start first: the bound on systems may leave the others out */
    for (int done = 0; done < COUNT(presets); done++) {
        int next = -1;

        for (int i = 0; i < COUNT(presets); i++)
            if (from[i] == 0 && starts[i] != NULL &&
                (next < 0 || is_better(starts[i], starts[next])))
                next = i;
        if (next < 0)
            return;
        from[next] = 1;
        descend(search, starts[next]);
    }
}

static void close_search(Search *search)
{
    for (int i = 0; i < search->seen.count; i++)
        candidate_free(search->seen.at[i]);
    LIST_FREE(search->seen);
    for (int i = 0; i < search->proposals.count; i++)
        mem_free(search->proposals.at[i]);
    LIST_FREE(search->proposals);
    mem_free(search->base);
    model_free(search->model);
}

/* --- what it found --- */

static int cheaper(const void *a, const void *b)
{
    const Candidate *x = *(Candidate *const *)a;
    const Candidate *y = *(Candidate *const *)b;

    return is_better(x, y) ? -1 : is_better(y, x) ? 1 : strcmp(x->text, y->text);
}

static void add_row(Table *table, int number, const Candidate *c)
{
    table_cellf(table, "%d", number);
    table_cellf(table, "%d", c->n);
    table_cellf(table, "%d", c->m);
    table_cellf(table, "%lld", (long long)c->count.add);
    table_cellf(table, "%lld", (long long)c->count.mul);
    table_cellf(table, "%lld", (long long)c->count.fun);
    table_cellf(table, "%.0f", c->price);
}

/* the cheapest ones and the starts, cheapest first */
static void print_table(const Search *search, Text *out)
{
    static const char *const heads[] = {"", "n", "m", "add", "mul", "fun", "price"};
    Table table = table_for("rrrrrrr");
    Text trees = {0};
    int compared = 0, number = 0;

    for (int i = 0; i < COUNT(heads); i++)
        table_cell(&table, heads[i]);
    for (int i = 0; i < search->seen.count; i++) {
        const Candidate *c = search->seen.at[i];
        char lead[16];
        Text line = {0};

        if (c->trees == NULL)
            continue;
        compared++;
        if (compared > MOST_ROWS && c->called == NULL)
            continue;
        add_row(&table, ++number, c);
        (void)snprintf(lead, sizeof lead, "%d: ", number);
        text_addf(&line, "%s%s%s%s", c->trees, c->called != NULL ? " (" : "",
                  c->called != NULL ? c->called : "", c->called != NULL ? ")" : "");
        layout_words(&trees, search->session->hooks.columns, lead, line.at);
        text_free(&line);
    }
    text_addf(out, "%d choices of trees compared", compared);
    text_addf(out, "%s\n", number < compared ? ", the cheapest and the starts:" : ":");
    table_print(out, &table, 0);
    text_add(out, trees.at != NULL ? trees.at : "");
    text_free(&trees);
    table_free(&table);
}

/* The best trees to the session's model, with the joints that they need, as one step to undo. */
static Status choose(Search *search, const Candidate *best, Diag *diag)
{
    ct_session *session = search->session;
    char *text = statements_of(search, best, true);
    int count = 0;
    Status status = apply_text(session->model, text, &count, diag);

    if (count > 0)
        model_join(session->model, count, "tree best");
    if (status != OK && count > 0 && model_undo(session->model, NULL) != OK)
        return status;
    for (int e = search->own; status == OK && e < search->edges; e++)
        if (best->branch[0][e] || best->branch[1][e])
            text_addf(&session->remarks, "added: %s\n", search->proposals.at[e - search->own]);
    if (status == OK)
        text_addf(&session->remarks, "chosen: %s\n", best->trees);
    mem_free(text);
    return status;
}

Status session_best_trees(ct_session *session, Diag *diag)
{
    Search search = {.session = session};
    const Candidate *best;
    System *system;
    Text table = {0};
    Status status;

    CHECK(open_search(&search, diag));
    run_search(&search);
    if (search.seen.count > 0)
        qsort(search.seen.at, (size_t)search.seen.count, sizeof *search.seen.at, cheaper);
    best = search.seen.count > 0 ? search.seen.at[0] : NULL;
    if (best == NULL || best->trees == NULL) {
        /* why not is what the trees as they are have to say */
        status = search.is_stopped
                     ? diag_set(diag, E_STOPPED, "stopped before any trees were compared")
                     : session_system(session, &system, diag);
        goto done;
    }
    print_table(&search, &table);
    session_remark(session, table.at);
    if (search.is_late || search.formulated >= MOST_SYSTEMS)
        text_addf(&session->remarks,
                  "the search ended at %d choices or %g s: there may be cheaper ones\n",
                  MOST_SYSTEMS, PATIENCE);
    if (best->called != as_it_was)
        CHECK(choose(&search, best, diag));
    else
        session_remark(session, "the trees stay as they are: none are cheaper");
    if (search.is_stopped)
        status = diag_set(diag, E_STOPPED, "stopped: the best trees so far are chosen");
done:
    text_free(&table);
    close_search(&search);
    return status;
}
