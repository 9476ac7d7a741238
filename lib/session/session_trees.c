/* session_trees.c: `tree best`, the search for the trees of cheapest equations
 *
 * The search itself is in formulate (tree_search.h). This file proposes virtual joints, as edges of
 * a fork of the model, between frames that rotate about one axis. It reports the result and adds it
 * to the model as statements. */
#include "session/session_impl.h"

#include "base/clock.h"
#include "formulate/system_build/tree_search.h"
#include "language/verbs.h"
#include "session/session_limits.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 8 };

static const char as_it_was[] = "as it was";

typedef struct TreesSought {
    ct_session *session;
    ArenaMark *mark; /* what is formed on the way is forgotten */
    Model *fork;     /* the model with the joints proposed; NULL: there are none */
    Scene scene;     /* of the fork, or of the session's model */
    int own;         /* edges that the session's model has */
    LIST(char *) proposals;
    TreeSearch pairs;
    bool is_stopped; /* by the user */
    bool is_late;
    double began;
    CallMonitor watch; /* that stops at either */
} TreesSought;

static bool stop(void *context)
{
    TreesSought *search = context;

    search->is_stopped = search->is_stopped || monitor_poll(&search->session->watch) != OK;
    search->is_late = search->is_late || clock_now() - search->began > TREE_SEARCH_TIME;
    return search->is_stopped || search->is_late;
}

static void progress(void *context, const char *phase, double fraction)
{
    const TreesSought *search = context;

    /* how far the search is, and not each of its systems */
    if (fraction >= 0)
        monitor_report(&search->session->watch, phase, fraction);
}

static const Model *model_of(const TreesSought *search)
{
    return search->fork != NULL ? search->fork : search->session->model;
}

/* --- statements --- */

Status session_apply_text(Model *model, const char *text, int *count, Diag *diag)
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

/* a name of an edge where words of the verb would win over it */
static void add_edge(Text *text, const char *name)
{
    text_addf(text, words_hold(verb_row(VERB_tree).words, name) ? " (%s)" : " %s", name);
}

/* the statements that choose a pair, joints proposed first */
static char *statements_of(const TreesSought *search, const TreePair *pair)
{
    const Graph *graph = search->scene.graph;
    const int edges = graph_edge_count(graph);
    Text text = {0};

    for (int e = search->own; e < edges; e++)
        if (pair->branch[0][e] || pair->branch[1][e])
            text_addf(&text, "%s\n", search->proposals.at[e - search->own]);
    for (int half = 0; half < 2; half++) {
        text_addf(&text, "tree %s", tree_kind_name((TreeKind)half));
        for (int e = 0; e < edges; e++)
            if (pair->branch[half][e] && graph_branching(graph, e, (TreeKind)half) != BRANCH_ALWAYS)
                add_edge(&text, graph_edge(graph, e)->name);
        text_char(&text, '\n');
    }
    return text_done(&text);
}

/* as the table shows it; new */
static char *brief_of(const TreesSought *search, const TreePair *pair)
{
    const Tree *trees[TREE_KINDS];
    Tree *halves[2];
    char *brief;

    if (!tree_search_trees(&search->pairs, pair, halves))
        return mem_text("", 0);
    memcpy(trees, search->scene.trees, sizeof trees);
    trees[TREE_TRANSLATION] = halves[0];
    trees[TREE_ROTATION] = halves[1];
    brief = tree_brief(model_of(search), trees);
    tree_free(halves[0]);
    tree_free(halves[1]);
    return brief;
}

/* --- joints to propose --- */

static const char *fresh_name(const TreesSought *search, const char *of, Text *name)
{
    for (int i = 0; i == 0 || model_find(search->session->model, name->at) != NULL; i++) {
        text_free(name);
        text_addf(name, i == 0 ? "v%s" : "v%s_%d", of, i);
    }
    return name->at;
}

/* "virtual revolute vm3 r6 m3 axis=[0, 0, 1]" for frames of the joints' trees that turn about one
 * axis */
static Status find_proposals(TreesSought *search, Diag *diag)
{
    const SystemOptions options = {.form = search->scene.network_form, .watch = &search->watch};
    const Graph *graph = search->scene.graph;
    Scene scene = search->scene;
    const System *system = NULL;
    CommonTurn *turns = NULL;
    Tree *halves[2];
    Text name = {0};
    int count = 0;
    Status status;

    CHECK(model_preset_trees(search->session->model, false, halves, diag));
    scene.trees[TREE_TRANSLATION] = halves[0];
    scene.trees[TREE_ROTATION] = halves[1];
    status = system_new(&scene, &options, &system, diag);
    tree_free(halves[0]);
    tree_free(halves[1]);
    CHECK(status);
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

/* a model with the proposed joints among its edges; those that it doesn't accept are omitted */
static Status add_proposals(TreesSought *search, Diag *diag)
{
    int kept = 0;
    Diag ignored;

    if (search->proposals.count == 0)
        return OK;
    TRY(model_fork(search->session->model, &search->fork, diag));
    for (int i = 0; i < search->proposals.count; i++) {
        int count = 0;

        if (session_apply_text(search->fork, search->proposals.at[i], &count, &ignored) != OK) {
            mem_free(search->proposals.at[i]);
            continue;
        }
        search->proposals.at[kept++] = search->proposals.at[i];
    }
    search->proposals.count = kept;
    scene_free(&search->scene);
    search->scene = (Scene){0};
    return model_scene(search->fork, &search->scene, diag);
}

/* --- the search --- */

static Status open_search(TreesSought *search, Diag *diag)
{
    Model *model = search->session->model;

    search->began = clock_now();
    search->watch = (CallMonitor){.context = search, .stop = stop, .progress = progress};
    search->mark = arena_mark(model_arena(model));
    TRY(model_scene(model, &search->scene, diag));
    if (search->scene.trees[TREE_TRANSLATION] == NULL)
        return diag_set(diag, E_MODEL, "there are no bodies and joints whose trees to compare");
    search->own = graph_edge_count(search->scene.graph);
    TRY(find_proposals(search, diag));
    TRY(add_proposals(search, diag));
    search->pairs = tree_search_open(&search->scene, search->own, &search->watch);
    return OK;
}

static void close_search(TreesSought *search)
{
    if (search->mark == NULL)
        return;
    tree_search_close(&search->pairs);
    for (int i = 0; i < search->proposals.count; i++)
        mem_free(search->proposals.at[i]);
    LIST_FREE(search->proposals);
    scene_free(&search->scene);
    model_free(search->fork);
    arena_release(model_arena(search->session->model), search->mark);
    search->mark = NULL;
}

static void run_search(TreesSought *search)
{
    static const char *const called[] = {"tree joint", "tree absolute"};

    tree_search_start(&search->pairs, search->scene.trees, as_it_was);
    for (int i = 0; i < COUNT(called); i++) {
        Tree *halves[2];

        if (model_preset_trees(model_of(search), i > 0, halves, NULL) != OK)
            continue;
        tree_search_start(&search->pairs, (const Tree *const *)halves, called[i]);
        tree_free(halves[0]);
        tree_free(halves[1]);
    }
    transaction_stop_asking(); /* there are best ones so far */
    tree_search_run(&search->pairs);
}

/* --- what it found --- */

static void add_row(Table *table, int number, const TreePair *c)
{
    table_cells(table, "%d\t%d\t%d\t%lld\t%lld\t%lld\t%.0f", number, c->n, c->m,
                (long long)c->count.add, (long long)c->count.mul, (long long)c->count.fun,
                c->price);
}

/* the cheapest ones and the starts, cheapest first */
static void print_table(const TreesSought *search, Text *out)
{
    Table table = table_for("rrrrrrr");
    Text trees = {0};
    int compared = 0, number = 0;

    table_cells(&table, "\tn\tm\tadd\tmul\tfun\tprice");
    for (int i = 0; i < search->pairs.seen.count; i++) {
        const TreePair *c = search->pairs.seen.at[i];
        char lead[16];
        char *brief;
        Text line = {0};

        if (!c->is_priced)
            continue;
        compared++;
        if (compared > MOST_ROWS && c->called == NULL)
            continue;
        add_row(&table, ++number, c);
        (void)snprintf(lead, sizeof lead, "%d: ", number);
        brief = brief_of(search, c);
        text_addf(&line, "%s%s%s%s", brief, c->called != NULL ? " (" : "",
                  c->called != NULL ? c->called : "", c->called != NULL ? ")" : "");
        layout_words(&trees, search->session->hooks.columns, lead, line.at);
        mem_free(brief);
        text_free(&line);
    }
    text_addf(out, "%d choices of trees compared", compared);
    text_addf(out, "%s\n", number < compared ? ", the cheapest and the starts:" : ":");
    table_print(out, &table, 0);
    text_add(out, trees.at != NULL ? trees.at : "");
    text_free(&trees);
    table_free(&table);
}

/* The best trees to the session's model, with the joints that they need, as one step to undo; the
 * search is closed. */
static Status choose(TreesSought *search, const TreePair *best, Diag *diag)
{
    ct_session *session = search->session;
    char *text = statements_of(search, best);
    char *brief = brief_of(search, best);
    Text added = {0};
    int count = 0;
    Status status;

    for (int e = search->own; e < graph_edge_count(search->scene.graph); e++)
        if (best->branch[0][e] || best->branch[1][e])
            text_addf(&added, "added: %s\n", search->proposals.at[e - search->own]);
    close_search(search);
    status = session_apply_text(session->model, text, &count, diag);
    if (count > 0)
        model_join(session->model, count, "tree best");
    if (status != OK && count > 0 && model_undo(session->model, NULL) != OK)
        goto done;
    if (status == OK)
        text_addf(&session->remarks, "%schosen: %s\n", added.at != NULL ? added.at : "", brief);
done:
    text_free(&added);
    MEM_FREE(brief, text);
    return status;
}

Status session_best_trees(ct_session *session, Diag *diag)
{
    TreesSought search = {.session = session};
    const TreePair *best;
    System *system;
    Text table = {0};
    bool is_short;
    Status status;

    CHECK(open_search(&search, diag));
    run_search(&search);
    best = search.pairs.seen.count > 0 ? search.pairs.seen.at[0] : NULL;
    if (best == NULL || !best->is_priced) {
        /* the reason is the error of the present trees */
        close_search(&search);
        status = search.is_stopped
                     ? diag_set(diag, E_STOPPED, "stopped before any trees were compared")
                     : session_system(session, &system, diag);
        goto done;
    }
    print_table(&search, &table);
    session_remark(session, table.at);
    is_short = search.is_late || search.pairs.formed >= TREE_SEARCH_MOST;
    if (is_short)
        text_addf(&session->remarks,
                  "the search ended at %d choices or %g s: there may be cheaper ones\n",
                  TREE_SEARCH_MOST, TREE_SEARCH_TIME);
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
