/* show_derivation.c: `show derivation`: which rows and entries are requested
 *
 * A constraint: the circuit of its chord in edges, the branches' vectors, the directions of
 * projection. A row of the equations of motion: the cutset of its branch, the motion per unit of
 * its speed, and the terms of each entry. A row of a network: the laws, circuits and cutsets
 * used. */
#include "present/derive.h"

#include <stdlib.h>
#include <string.h>

static Status report_all(Narrative *story, Diag *diag)
{
    const System *system = story->view->system;

    for (int k = 0; k < system_m(system); k++)
        TRY(derive_constraint(story, k, !derive_goes_on(story->view, k), diag));
    derive_dropped(story, NULL);
    for (int i = 0; i < system_nu(system); i++)
        TRY(derive_motion(story, i, diag));
    for (int i = 0; i < system_network_count(system); i++)
        derive_network(story, i);
    if (story->out->length == 0)
        view_comment(story->out, story->view, "no equations: the model has no unknowns");
    return OK;
}

/* a row of `show equations` */
static Status report_row(Narrative *story, const Syntax *item, Diag *diag)
{
    const System *system = story->view->system;
    const int nu = system_nu(system), m = system_m(system);
    const int rows = nu + m + system_network_count(system);
    char *end = NULL;
    const long row = strtol(item->text, &end, 10) - 1;

    if (*end != '\0' || row < 0 || row >= rows || item->has_unit) {
        (void)diag_at(diag, E_VALUE, item->place, "the equations have %d row%s", rows,
                      rows == 1 ? "" : "s");
        diag_hint(diag, "rows are counted 1, 2, 3 ... in the order of 'show equations'");
        return E_VALUE;
    }
    if (row < nu)
        return derive_motion(story, (int)row, diag);
    if (row < nu + m)
        return derive_constraint(story, (int)row - nu, true, diag);
    derive_network(story, (int)row - nu - m);
    return OK;
}

static Status read_entry(const View *view, const Syntax *item, Block block, int at[2], Diag *diag)
{
    int size[2];

    system_block_size(view->system, block, &size[0], &size[1]);
    if (item->count != (block == BLOCK_MASS || block == BLOCK_JACOBIAN ? 2 : 1))
        return diag_at(diag, E_SYNTAX, item->place, "%s is asked for as %s", item->text,
                       block == BLOCK_MASS || block == BLOCK_JACOBIAN
                           ? "a row and a column: mass(2,3)"
                           : "a row: forces(1)");
    for (int i = 0; i < item->count; i++) {
        char *end = NULL;
        const Syntax *arg = item->args[i];
        const long number = strtol(arg->text, &end, 10);

        if (arg->kind != SYNTAX_NUMBER || *end != '\0' || number < 1 || number > size[i])
            return diag_at(diag, E_VALUE, arg->place, "%s has the %s 1 to %d", item->text,
                           i == 0 ? "rows" : "columns", size[i]);
        at[i] = (int)number - 1;
    }
    return OK;
}

static Status report_entry(Narrative *story, const Syntax *item, Diag *diag)
{
    static const Block known[] = {BLOCK_MASS, BLOCK_FORCES, BLOCK_CONSTRAINTS, BLOCK_JACOBIAN};
    int at[2] = {0, 0};

    for (int i = 0; i < COUNT(known); i++) {
        if (strcmp(block_name(known[i]), item->text) != 0)
            continue;
        TRY(read_entry(story->view, item, known[i], at, diag));
        switch (known[i]) {
        case BLOCK_MASS:
            return derive_mass(story, at[0], at[1], diag);
        case BLOCK_FORCES:
            return derive_force(story, at[0], diag);
        case BLOCK_JACOBIAN:
            return derive_jacobian(story, at[0], at[1], diag);
        default:
            return derive_constraint(story, at[0], true, diag);
        }
    }
    (void)diag_at(diag, E_NAME, item->place, "'%s' is no block whose entries are derived",
                  item->text);
    diag_hint(diag, "mass(2,3), forces(1), constraints(1) and jacobian(1,2) are");
    return E_NAME;
}

static bool is_of(const View *view, int edge, int instance, const char *name)
{
    return (edge >= 0 && strcmp(narrative_edge(view, edge), name) == 0) ||
           strcmp(system_instance_name(view->system, instance), name) == 0;
}

/* the equations of an edge, a part or a coordinate */
static Status report_equations_of(Narrative *story, const char *name, bool *any, Diag *diag)
{
    const View *view = story->view;
    const System *system = view->system;
    const char *chord = NULL;

    for (int k = 0; k < system_m(system); k++) {
        const ConstraintRow *row = system_constraint(system, k);

        if (!is_of(view, row->edge, row->instance, name))
            continue;
        TRY(derive_constraint(story, k, chord == NULL || !derive_goes_on(view, k), diag));
        chord = system_instance_name(system, row->instance);
        *any = true;
    }
    for (int i = 0; i < system_nu(system); i++) {
        const Variable *u = system_u(system, i);
        const size_t length = strlen(name);
        const bool is_rate = strncmp(u->name, name, length) == 0 &&
                             (u->name[length] == '\0' || strcmp(u->name + length, "'") == 0);

        if (!is_rate && !is_of(view, u->edge, u->instance, name))
            continue;
        TRY(derive_motion(story, i, diag));
        *any = true;
    }
    for (int i = 0; i < system_network_count(system); i++)
        if (strcmp(narrative_edge(view, system_network_edge(system, i)), name) == 0) {
            derive_network(story, i);
            *any = true;
        }
    if (*any)
        derive_dropped(story, name);
    return OK;
}

/* an edge without an equation of its own, or whose variable was requested: its role in the graph */
static void report_edge(Narrative *story, int edge)
{
    const View *view = story->view;
    const Tree *trees[TREE_KINDS];
    const Edge *at = graph_edge(model_graph(view->model), edge);
    Diag ignored = {0};

    if (at->domain != DOMAIN_MECHANICAL || model_trees(view->model, trees, &ignored) != OK)
        return;
    if (tree_has(trees[TREE_TRANSLATION], edge)) {
        derive_cutset(story, edge, TREE_TRANSLATION);
    } else {
        derive_way(story->out, view, edge);
    }
    if (tree_has(trees[TREE_ROTATION], edge))
        derive_cutset(story, edge, TREE_ROTATION);
    else
        derive_turns(story->out, view, edge);
    derive_dropped(story, at->name);
}

/* a variable: the edge it is of, and the formula it is computed by */
/* an expression that is the bare name of one */
static bool is_parameter(Expr e)
{
    return expr_kind(e) == EXPR_SYMBOL && expr_symbol_kind(e) == SYMBOL_PARAMETER;
}

static Status report_variable(Narrative *story, const Syntax *item, Diag *diag)
{
    const View *view = story->view;
    const Graph *graph = model_graph(view->model);
    const char *dot = strrchr(item->text, '.');
    char *name =
        mem_text(item->text, dot != NULL ? (size_t)(dot - item->text) : strlen(item->text));
    int edge = graph_find_edge(graph, item->text);
    Expr user, e;
    Text title = {0};
    Status status = OK;

    if (edge < 0)
        edge = graph_find_edge(graph, name);
    if (edge < 0) /* a coordinate of another name */
        for (int i = 0; i < model_count(view->model); i++) {
            const Instance *instance = model_instance(view->model, i);

            for (int k = 0; k < instance->coord_count; k++)
                edge = strcmp(instance->coord[k], item->text) == 0 ? instance->edge : edge;
        }
    status = model_expression(view->model, item, &user, diag);
    if (status == OK)
        status = system_resolve(view->system, user, &e, diag);
    if (status != OK && (edge < 0 || item->primes > 0 || dot != NULL))
        goto done;
    narrative_add_word(&title, view, item->text);
    narrative_title(story, &title);
    if (edge >= 0)
        report_edge(story, edge);
    if (status == OK && (edge < 0 || !is_parameter(user))) {
        narrative_add(story->out, view, "formula", "");
        status = show_expression(view, item, 0, story->out, diag);
    } else {
        narrative_add(story->out, view, "equation", "none: it brings no unknown of its own");
        *diag = (Diag){0};
        status = OK;
    }
done:
    mem_free(name);
    return status;
}

Status show_derivation(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Syntax *item = selection->item;
    Narrative story = {.view = view, .out = out};
    bool any = false;

    if (item == NULL)
        return report_all(&story, diag);
    if (item->kind == SYNTAX_NUMBER)
        return report_row(&story, item, diag);
    if (item->kind == SYNTAX_CALL && item->primes == 0)
        return report_entry(&story, item, diag);
    if (item->kind != SYNTAX_VARIABLE)
        return diag_at(diag, E_SYNTAX, item->place,
                       "'show derivation' takes a name, a row or an entry");
    if (item->primes == 0)
        TRY(report_equations_of(&story, item->text, &any, diag));
    return any ? OK : report_variable(&story, item, diag);
}
