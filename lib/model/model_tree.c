/* model_tree.c: the user's choice of edges for each tree, and the resulting trees
 *
 * Choices are stored by name, so that they remain valid after edits of the graph. A tree is
 * completed from them on request. A tree statement is checked at once, as far as the graph is
 * connected already. */
#include "model/model_impl.h"

#include <string.h>

static const TreeKind mechanical_kinds = TREE_ELECTRICAL; /* the kinds before it */

/* --- choices to trees --- */

/* The part and the scalar edge that an edge's name names ("T1.s"); *which -1: the name is the
 * part's own. NULL: none. */
static const Instance *edge_part(const State *state, const char *name, int *which)
{
    const char *member = "";
    const Instance *part = state_owner(state, name, &member);
    const ScalarEdge *edges;
    int count;

    *which = -1;
    if (part == NULL || member[0] == '\0')
        return part;
    edges = component_scalar_edges(part->row, &count);
    for (int k = 0; k < count; k++)
        if (strcmp(edges[k].suffix, member) == 0)
            *which = k;
    return *which >= 0 ? part : NULL;
}

/* the edge of that name that a tree of this kind may span; -1: none */
static int edge_in(const State *state, const char *name, TreeKind kind)
{
    int which;
    const Instance *part = edge_part(state, name, &which);
    int scalar;

    if (part == NULL)
        return -1;
    scalar = which >= 0 ? which : 0;
    if (scalar < part->scalar_count && (which >= 0 || part->scalar_count == 1) &&
        graph_edge_in(state->graph, part->scalar_edges[scalar], kind))
        return part->scalar_edges[scalar];
    return which < 0 && part->edge >= 0 && graph_edge_in(state->graph, part->edge, kind)
               ? part->edge
               : -1;
}

static bool has_kind(const State *state, TreeKind kind)
{
    for (int e = 0; e < graph_edge_count(state->graph); e++)
        if (graph_edge_in(state->graph, e, kind))
            return true;
    return false;
}

typedef struct Chosen { /* a Choice as edges of the graph */
    NumberList branches;
    bool *excluded;
    int *preference;
} Chosen;

static void chosen_free(Chosen *chosen)
{
    LIST_FREE(chosen->branches);
    MEM_FREE(chosen->excluded, chosen->preference);
}

/* A definition's own choice applies in each instance of which the model names no edge. */
static void add_inside_choice(const State *state, TreeKind kind, const Choice *choice,
                              const InsideChoice *inside, Chosen *chosen)
{
    const char *use = state->uses.at[inside->use].name;
    const int edge = inside->kind == (int)kind ? edge_in(state, inside->name, kind) : -1;
    bool named = edge < 0;

    for (int i = 0; !named && i < choice->chosen.count; i++)
        named = name_is_inside(choice->chosen.at[i], use);
    for (int i = 0; !named && i < choice->excluded.count; i++)
        named = name_is_inside(choice->excluded.at[i], use);
    if (named)
        return;
    if (inside->excluded)
        chosen->excluded[edge] = true;
    else
        LIST_PUSH(chosen->branches, edge);
}

static Chosen resolve_choice(const State *state, TreeKind kind, const Choice *choice)
{
    int count = graph_edge_count(state->graph);
    int half = kind == TREE_ROTATION ? 1 : 0;
    Chosen chosen = {{0}, NEW_ARRAY(bool, count), NEW_ARRAY(int, count)};

    for (int e = 0; e < count; e++) {
        const Instance *part = state->parts.at[state->edge_owner.at[e]];
        bool first = choice->absolute && part->row->family == FAMILY_BODY;

        chosen.preference[e] = first ? 0 : graph_edge(state->graph, e)->preference[half];
    }
    for (int i = 0; i < choice->chosen.count; i++)
        LIST_PUSH(chosen.branches, edge_in(state, choice->chosen.at[i], kind));
    for (int i = 0; i < choice->excluded.count; i++) {
        int edge = edge_in(state, choice->excluded.at[i], kind);

        if (edge >= 0)
            chosen.excluded[edge] = true;
    }
    for (int i = 0; i < state->inside_choices.count && !choice->absolute; i++)
        add_inside_choice(state, kind, choice, &state->inside_choices.at[i], &chosen);
    return chosen;
}

static Status complete(const State *state, TreeKind kind, const Choice *choice, Tree **out,
                       Diag *diag)
{
    Chosen chosen = resolve_choice(state, kind, choice);
    TreeChoice edges = {chosen.branches.at, chosen.branches.count, chosen.excluded,
                        chosen.preference};
    Status status = tree_complete(state->graph, kind, &edges, false, out, diag);

    chosen_free(&chosen);
    return status;
}

Status state_trees(State *state, const Tree *trees[TREE_KINDS], Diag *diag)
{
    Status status = OK;

    if (!state->has_trees) {
        mem_keep(state);
        for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
            if (has_kind(state, kind))
                CHECK(complete(state, kind, &state->choices[kind], &state->trees[kind], diag));
        state->has_trees = true;
    }
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        trees[kind] = state->trees[kind];
done:
    if (status != OK)
        state_forget_trees(state);
    return status;
}

Status state_preset_trees(const State *state, bool absolute, Tree *out[2], Diag *diag)
{
    const Choice choice = {.absolute = absolute};
    Status status = OK;

    out[0] = out[1] = NULL;
    for (TreeKind kind = 0; kind < mechanical_kinds; kind++)
        if (has_kind(state, kind))
            CHECK(complete(state, kind, &choice, &out[kind], diag));
done:
    if (status != OK) {
        tree_free(out[0]);
        out[0] = NULL;
    }
    return status;
}

/* --- reading a statement --- */

typedef struct Request {
    State *state;
    const Statement *statement;
    int kind;     /* the one tree that is named; -1: each edge's own domain */
    NameList add; /* or, without signs, the complete set */
    NameList drop;
    bool has_signs;
    const Operand *first; /* edge, for its position */
    Choice choices[TREE_KINDS];
    bool touched[TREE_KINDS];
    Outcome *outcome;
    Diag *diag;
} Request;

static bool named(const NameList *list, const char *name)
{
    for (int i = 0; i < list->count; i++)
        if (strcmp(list->at[i], name) == 0)
            return true;
    return false;
}

static void list_copy(NameList *to, const NameList *from)
{
    to->count = 0;
    for (int i = 0; i < from->count; i++)
        LIST_PUSH(*to, from->at[i]);
}

static void list_remove(NameList *list, const NameList *gone)
{
    int kept = 0;

    for (int i = 0; i < list->count; i++)
        if (!named(gone, list->at[i]))
            list->at[kept++] = list->at[i];
    list->count = kept;
}

/* the tree kind with that word; -1: none */
static int kind_named(const char *word)
{
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        if (strcmp(tree_kind_name(kind), word) == 0)
            return (int)kind;
    return -1;
}

static Status edge_unknown(const Request *request, const char *name, Place place)
{
    const Graph *graph = request->state->graph;
    Suggest suggest = suggest_for(name);

    for (int e = 0; e < graph_edge_count(graph); e++)
        suggest_offer(&suggest, graph_edge(graph, e)->name);
    (void)diag_at(request->diag, E_NAME, place, "unknown edge '%s'", name);
    suggest_hint(&suggest, request->diag);
    return E_NAME;
}

/* T1 alone, where it has two edges */
static Status which_edge(const Request *request, const Instance *part, Place place)
{
    int count;
    const ScalarEdge *edges = component_scalar_edges(part->row, &count);

    (void)diag_at(request->diag, E_NAME, place, "%s has two edges", part->name);
    diag_hint(request->diag, "they are %s.%s and %s.%s", part->name, edges[0].suffix, part->name,
              edges[1].suffix);
    return E_NAME;
}

/* the joint with that coordinate, as in "tree theta1"; NULL: none */
static const Instance *joint_of_coordinate(const State *state, const char *name, Place place)
{
    int owner;
    int coordinate;

    if (coordinate_resolve(state, name, place, &owner, &coordinate, NULL) != OK ||
        state->parts.at[owner]->coord_count != 1)
        return NULL;
    return state->parts.at[owner];
}

static Status read_edge(Request *request, const Operand *operand)
{
    const State *state = request->state;
    const char *name = syntax_name(operand->value);
    const Instance *part;
    int which;

    if (name == NULL)
        return diag_at(request->diag, E_NAME, operand->place, "a tree is made of names of edges");
    part = edge_part(state, name, &which);
    if (part == NULL)
        part = joint_of_coordinate(state, name, operand->place);
    if (part == NULL || (part->edge < 0 && part->scalar_count == 0))
        return edge_unknown(request, name, operand->place);
    if (which < 0 && part->scalar_count > 1)
        return which_edge(request, part, operand->place);
    name = which < 0 ? part->name : graph_edge(state->graph, part->scalar_edges[which])->name;
    if (request->kind >= 0 && edge_in(state, name, (TreeKind)request->kind) < 0)
        return diag_at(request->diag, E_BRANCH, operand->place, "%s has no edge in the %s graph",
                       syntax_name(operand->value), tree_kind_name((TreeKind)request->kind));
    if (named(&request->add, name) || named(&request->drop, name))
        return diag_at(request->diag, E_NAME, operand->place, "%s is named twice", name);
    if (operand->sign == '-')
        LIST_PUSH(request->drop, name);
    else
        LIST_PUSH(request->add, name);
    return OK;
}

static Status read_edges(Request *request, int first)
{
    const Statement *statement = request->statement;
    Status status = OK;

    for (int i = first; i < statement->operands.count; i++) {
        const Operand *operand = &statement->operands.at[i];
        bool is_signed = operand->sign != 0;

        if (i > first && is_signed != request->has_signs) {
            status = diag_at(request->diag, E_SYNTAX, operand->place,
                             "with signs, every name has its own");
            diag_hint(request->diag, "tree a b sets a tree, tree + a - b changes it");
            goto done;
        }
        request->has_signs = is_signed;
        CHECK(read_edge(request, operand));
    }
    request->first = &statement->operands.at[first];
done:
    return status;
}

/* --- changing choices --- */

static bool in_play(const Request *request, TreeKind kind)
{
    return request->kind < 0 || (int)kind == request->kind;
}

static bool can_enter(const Request *request, const char *name, TreeKind kind)
{
    const State *state = request->state;
    int edge = edge_in(state, name, kind);

    return edge >= 0 && graph_branching(state->graph, edge, kind) != BRANCH_NEVER;
}

/* The names of a list that a tree of this kind may contain: no virtual joint without freedom in it,
 * and a motor only in the electrical tree. */
static NameList of_kind(const Request *request, const NameList *list, TreeKind kind)
{
    NameList out = {0};

    for (int i = 0; i < list->count; i++)
        if (can_enter(request, list->at[i], kind))
            LIST_PUSH(out, list->at[i]);
    return out;
}

/* `tree a b`: these become the branches of every tree whose domain is named. */
static void set_tree(Request *request, TreeKind kind)
{
    Choice *choice = &request->choices[kind];
    NameList mine = of_kind(request, &request->add, kind);

    if (mine.count > 0) {
        request->touched[kind] = true;
        choice->absolute = false;
        list_copy(&choice->chosen, &mine);
        list_remove(&choice->excluded, &mine);
    }
    LIST_FREE(mine);
}

/* the current branches of the tree, without arms; the chosen ones where there is no tree yet */
static NameList current_branches(const Request *request, TreeKind kind)
{
    const State *state = request->state;
    NameList out = {0};
    Tree *tree = NULL;

    if (complete(state, kind, &state->choices[kind], &tree, NULL) != OK) {
        list_copy(&out, &state->choices[kind].chosen);
        return out;
    }
    for (int e = 0; e < graph_edge_count(state->graph); e++)
        if (graph_edge_in(state->graph, e, kind) && tree_has(tree, e) &&
            graph_branching(state->graph, e, kind) != BRANCH_ALWAYS)
            LIST_PUSH(out, graph_edge(state->graph, e)->name);
    tree_free(tree);
    return out;
}

/* `tree - h9`: removes it, and completes the tree anew */
static void drop_from(Request *request, TreeKind kind)
{
    Choice *choice = &request->choices[kind];
    NameList mine = of_kind(request, &request->drop, kind);

    if (mine.count > 0)
        request->touched[kind] = true;
    list_remove(&choice->chosen, &mine);
    for (int i = 0; i < mine.count; i++)
        name_list_add(&choice->excluded, mine.at[i]);
    LIST_FREE(mine);
}

/* `tree + a - b`: removes an edge only from trees that another one enters; the rest is unchanged */
static void change_tree(Request *request, TreeKind kind)
{
    Choice *choice = &request->choices[kind];
    NameList current = {0};
    NameList enter = {0};

    if (request->add.count == 0) {
        drop_from(request, kind);
        return;
    }
    current = current_branches(request, kind);
    for (int i = 0; i < request->add.count; i++)
        if (can_enter(request, request->add.at[i], kind) && !named(&current, request->add.at[i]))
            LIST_PUSH(enter, request->add.at[i]);
    if (enter.count > 0) {
        choice->absolute = false;
        list_copy(&choice->chosen, &current);
        drop_from(request, kind);
        request->touched[kind] = true;
        for (int i = 0; i < enter.count; i++)
            LIST_PUSH(choice->chosen, enter.at[i]);
        list_remove(&choice->excluded, &enter);
    }
    LIST_FREE(current);
    LIST_FREE(enter);
}

/* Every edge that enters must be a possible branch of some of the trees concerned. */
static Status check_entering(const Request *request)
{
    for (int i = 0; i < request->add.count; i++) {
        const char *name = request->add.at[i];
        int which;
        const Instance *part = edge_part(request->state, name, &which);
        bool can = false;

        for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
            can = can || (in_play(request, kind) && can_enter(request, name, kind));
        if (can)
            continue;
        (void)diag_at(request->diag, E_BRANCH, request->first[i].place,
                      part->is_virtual ? "%s has no freedom there: it can't be a branch"
                                       : "edge %s has no across relation: it can't be a branch",
                      name);
        diag_hint(request->diag, part->is_virtual
                                     ? "a virtual joint is a branch of the trees in which it moves "
                                       "its tip: a revolute of rotation, a prismatic of translation"
                                     : "only bodies, joints, arms and components between terminals "
                                       "can be branches");
        return E_BRANCH;
    }
    return OK;
}

static Status check_dropped(const Request *request)
{
    for (int i = 0; i < request->drop.count; i++) {
        int which;
        const Instance *part = edge_part(request->state, request->drop.at[i], &which);

        if (part->row->translation != BRANCH_ALWAYS || part->edge < 0)
            continue;
        (void)diag_at(request->diag, E_BRANCH, request->first->place,
                      "arm %s can't be a chord: arms are branches of every tree", part->name);
        diag_hint(request->diag, "a weld may be one");
        return E_BRANCH;
    }
    return OK;
}

/* --- checks and commit --- */

/* some nodes have no connection to the datum yet: then the tree can't be checked */
static bool hangs_together(const State *state, TreeKind kind)
{
    int *part = NEW_ARRAY(int, graph_node_count(state->graph));
    int parts = graph_parts(state->graph, tree_kind_domain(kind), part);

    mem_free(part);
    return parts <= 1;
}

static void remark_completed(Request *request, Tree *const trees[TREE_KINDS])
{
    const Graph *graph = request->state->graph;
    Text *remarks = &request->outcome->remarks;
    int said = 0;

    for (int e = 0; e < graph_edge_count(graph); e++) {
        int kinds = 0;

        for (TreeKind kind = 0; kind < TREE_KINDS; kind++) {
            if (trees[kind] == NULL || !graph_edge_in(graph, e, kind) ||
                !tree_has(trees[kind], e) || !tree_was_completed(trees[kind], e))
                continue;
            if (kinds++ == 0)
                text_addf(remarks, "%s%s (", said++ == 0 ? "completed with " : ", ",
                          graph_edge(graph, e)->name);
            else
                text_add(remarks, ", ");
            text_add(remarks, tree_kind_name(kind));
        }
        if (kinds > 0)
            text_char(remarks, ')');
    }
    if (said > 0)
        text_char(remarks, '\n');
}

static Status check_choices(Request *request)
{
    Tree *trees[TREE_KINDS] = {NULL};
    Status status = OK;

    for (TreeKind kind = 0; kind < TREE_KINDS; kind++) {
        if (!request->touched[kind])
            continue;
        status =
            complete(request->state, kind, &request->choices[kind], &trees[kind], request->diag);
        if (status == E_UNREACHED && !hangs_together(request->state, kind)) {
            text_addf(&request->outcome->remarks,
                      "the %s tree is completed when the graph hangs together\n",
                      tree_kind_name(kind));
            status = OK;
        }
        CHECK(status);
    }
    remark_completed(request, trees);
done:
    if (status != OK && request->diag != NULL && request->diag->place.line == 0 &&
        request->first != NULL)
        request->diag->place = request->first->place;
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        tree_free(trees[kind]);
    return status;
}

static void request_commit(Request *request)
{
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++) {
        Choice *choice = &request->state->choices[kind];
        Choice before = *choice;

        if (!request->touched[kind])
            continue;
        state_retain_choice(request->state, kind);
        *choice = request->choices[kind];
        request->choices[kind] = before;
    }
    request->outcome->changes_equations = true;
    state_forget_trees(request->state);
}

static Request request_start(State *state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    Request request = {
        .state = state, .statement = statement, .kind = -1, .outcome = outcome, .diag = diag};

    for (TreeKind kind = 0; kind < TREE_KINDS; kind++) {
        const Choice *from = &state->choices[kind];

        request.choices[kind].absolute = from->absolute;
        list_copy(&request.choices[kind].chosen, &from->chosen);
        list_copy(&request.choices[kind].excluded, &from->excluded);
    }
    return request;
}

static void request_free(Request *request)
{
    LIST_FREE(request->add);
    LIST_FREE(request->drop);
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++) {
        LIST_FREE(request->choices[kind].chosen);
        LIST_FREE(request->choices[kind].excluded);
    }
}

/* --- statements --- */

/* `tree joint`, `tree absolute`: removes the choices for the mechanical trees */
static void preset(Request *request, bool absolute)
{
    for (TreeKind kind = 0; kind < mechanical_kinds; kind++) {
        if (!in_play(request, kind))
            continue;
        request->touched[kind] = true;
        request->choices[kind].absolute = absolute;
        request->choices[kind].chosen.count = 0;
        request->choices[kind].excluded.count = 0;
    }
}

/* `rotation`, then `joint` or `absolute`, or edges; `first` is the index where those start */
static Status read_words(Request *request, int *first, const char **word)
{
    const Statement *statement = request->statement;
    int at = 0;

    for (; at < statement->operands.count; at++) {
        const Operand *operand = &statement->operands.at[at];
        const char *name = operand->value->kind == SYNTAX_VARIABLE ? operand->value->text : "";

        if (operand->sign != 0)
            break;
        if (at == 0 && kind_named(name) >= 0) {
            request->kind = kind_named(name);
            continue;
        }
        if (strcmp(name, "joint") != 0 && strcmp(name, "absolute") != 0 &&
            strcmp(name, "best") != 0)
            break;
        *word = name;
        at++;
        break;
    }
    *first = at;
    if (*word != NULL && at < statement->operands.count)
        return diag_at(request->diag, E_SYNTAX, statement->operands.at[at].place,
                       "'%s' stands alone", *word);
    if (*word == NULL && at == statement->operands.count)
        return diag_at(request->diag, E_SYNTAX, statement->place, "no edge is named");
    return OK;
}

Status apply_tree(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    Request request = request_start(*state, statement, outcome, diag);
    const char *word = NULL;
    int first = 0;
    Status status = OK;

    CHECK(read_words(&request, &first, &word));
    if (word != NULL && strcmp(word, "best") == 0) {
        /* a search compares equations, which only a session has */
        status = diag_at(diag, E_SYNTAX, statement->operands.at[first - 1].place,
                         "'best' searches both mechanical trees together");
        diag_hint(diag, "tree best");
        goto done;
    }
    if (word != NULL)
        preset(&request, strcmp(word, "absolute") == 0);
    else {
        CHECK(read_edges(&request, first));
        CHECK(check_entering(&request));
        CHECK(check_dropped(&request));
        for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
            if (in_play(&request, kind) && request.has_signs)
                change_tree(&request, kind);
            else if (in_play(&request, kind))
                set_tree(&request, kind);
    }
    CHECK(check_choices(&request));
    request_commit(&request);
done:
    request_free(&request);
    return status;
}

Status apply_cotree(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    Request request = request_start(*state, statement, outcome, diag);
    Status status = OK;

    for (int i = 0; i < statement->operands.count; i++) {
        Operand operand = statement->operands.at[i];

        operand.sign = '-';
        CHECK(read_edge(&request, &operand));
    }
    request.first = &statement->operands.at[0];
    CHECK(check_dropped(&request));
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        drop_from(&request, kind);
    CHECK(check_choices(&request));
    request_commit(&request);
done:
    request_free(&request);
    return status;
}

/* --- in a definition --- */

/* replaces the names of one kind from an earlier line */
static void keep_inside(const Request *request, TreeKind kind, bool excluded)
{
    State *state = request->state;
    NameList mine = of_kind(request, excluded ? &request->drop : &request->add, kind);

    for (int i = 0; i < mine.count; i++)
        LIST_PUSH(state->inside_choices, (InsideChoice){.use = state->inside,
                                                        .kind = (int)kind,
                                                        .excluded = excluded,
                                                        .name = mine.at[i]});
    LIST_FREE(mine);
}

Status apply_tree_inside(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    const bool excluded = strcmp(statement->verb, "cotree") == 0;
    Outcome unsaid = {0}; /* how it would be completed if these were all edges */
    Request request = request_start(*state, statement, &unsaid, diag);
    const char *word = NULL;
    int first = 0;
    Status status = OK;

    outcome->changes_equations = true;
    if (!excluded)
        CHECK(read_words(&request, &first, &word));
    if (word != NULL || statement->operands.at[first].sign != 0) {
        status = diag_at(diag, E_SYNTAX, statement->operands.at[first - (word != NULL)].place,
                         "in a definition a tree is named edge by edge");
        diag_hint(diag, "as in tree h1 h2, or tree rotation h1; cotree h3 keeps an edge out");
        goto done;
    }
    CHECK(read_edges(&request, first));
    if (excluded) {
        list_copy(&request.drop, &request.add);
        request.add.count = 0;
    }
    CHECK(check_entering(&request));
    CHECK(check_dropped(&request));
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        if (in_play(&request, kind)) {
            keep_inside(&request, kind, excluded);
            request.touched[kind] = has_kind(*state, kind);
        }
    CHECK(check_choices(&request));
    state_forget_trees(*state);
done:
    text_free(&unsaid.remarks);
    request_free(&request);
    return status;
}

/* --- copying and saving --- */

/* `gone`: the names of edges that no longer exist, each once */
static void copy_names(State *to, NameList *list, const NameList *from, NameList *gone)
{
    for (int i = 0; i < from->count; i++) {
        int which;
        bool is_listed = false;

        if (edge_part(to, from->at[i], &which) != NULL) {
            LIST_PUSH(*list, state_text(to, from->at[i]));
            continue;
        }
        for (int k = 0; k < gone->count; k++)
            is_listed = is_listed || strcmp(gone->at[k], from->at[i]) == 0;
        if (!is_listed)
            LIST_PUSH(*gone, from->at[i]);
    }
}

void choices_copy(State *to, const State *from, Text *remarks)
{
    NameList gone = {0};

    for (TreeKind kind = 0; kind < TREE_KINDS; kind++) {
        to->choices[kind].absolute = from->choices[kind].absolute;
        copy_names(to, &to->choices[kind].chosen, &from->choices[kind].chosen, &gone);
        copy_names(to, &to->choices[kind].excluded, &from->choices[kind].excluded, &gone);
    }
    for (int i = 0; i < gone.count && remarks != NULL; i++)
        text_addf(remarks, "%s is no longer among the edges chosen for trees\n", gone.at[i]);
    LIST_FREE(gone);
}

static void save_names(Text *text, TreeKind kind, const char *sign, const NameList *names)
{
    if (names->count == 0)
        return;
    text_addf(text, "tree %s", tree_kind_name(kind));
    for (int i = 0; i < names->count; i++)
        text_addf(text, " %s%s", sign, names->at[i]);
    text_char(text, '\n');
}

/* Presets first, then excluded edges, then chosen ones: this order restores each choice. */
void choices_save(const State *state, Text *text)
{
    const Choice *choices = state->choices;
    bool absolute = choices[TREE_TRANSLATION].absolute || choices[TREE_ROTATION].absolute;

    if (absolute)
        text_add(text, "tree absolute\n");
    for (TreeKind kind = 0; absolute && kind < mechanical_kinds; kind++)
        if (!choices[kind].absolute && choices[kind].chosen.count == 0)
            text_addf(text, "tree %s joint\n", tree_kind_name(kind));
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        save_names(text, kind, "- ", &choices[kind].excluded);
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        save_names(text, kind, "", &choices[kind].chosen);
}
