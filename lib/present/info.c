/* info.c: everything about one name */
#include "present/info.h"

#include "base/names.h"
#include "component/equation_block.h"
#include "present/show.h"

#include <string.h>

static const char of_joints[] = "a positive coordinate moves or turns the tip against the tail; fx "
                                "... act on the tip, reversed on the tail";

/* which way things count positive, by family */
static const char *const conventions[] = {
    [FAMILY_BODY] = "position and angle of the body against ground",
    [FAMILY_ARM] = "fixed in the body of its tail; x y theta are against ground",
    [FAMILY_JOINT] = of_joints,
    [FAMILY_DRIVER] = "the effort acts along the coordinate, on the tip",
    [FAMILY_COUPLER] = "the effort acts along the coordinate, on the tip",
    [FAMILY_CONTACT] = "fx ... act on the tip at the point of contact, reversed on the tail",
    [FAMILY_FORCE] = "acts on the tip, reversed on the tail; pulling together is negative",
};

/* of a part between terminals, in the terms of its domain */
static void add_convention(Text *out, const View *view, const Component *row)
{
    Text line = {0};

    if (row->domain == DOMAIN_LOAD)
        text_addf(&line, "%s presses the joint; %s", domain_across(row->domain),
                  conventions[FAMILY_COUPLER]);
    else if (row->family == FAMILY_SCALAR || row->family == FAMILY_TRANSDUCER)
        text_addf(&line, "%s is plus against minus; %s goes from plus to minus inside%s",
                  domain_across(row->domain), domain_through(row->domain),
                  row->family == FAMILY_TRANSDUCER ? "; its force or torque acts on the joint's tip"
                                                   : "");
    else
        text_add(&line, conventions[row->family]);
    layout_words(out, view->page.columns, "sign: ", line.at);
    text_free(&line);
}

/* in which trees the edge is a branch; its own name in front where a part has several */
static void add_standing(Table *table, const View *view, int edge, bool several)
{
    const Graph *graph = model_graph(view->model);
    const Tree *trees[TREE_KINDS] = {NULL};
    Diag ignored;

    /* the rest is reported even if a tree is incomplete */
    if (edge < 0 || model_trees(view->model, trees, &ignored) != OK)
        return;
    for (int k = 0; k < TREE_KINDS; k++) {
        if (trees[k] == NULL || !graph_edge_in(graph, edge, (TreeKind)k))
            continue;
        if (several)
            table_cell(table, graph_edge(graph, edge)->name);
        else
            table_cell(table, tree_kind_name((TreeKind)k));
        table_cells(table, "%s%s", tree_has(trees[k], edge) ? "branch (tree)" : "chord (cotree)",
                    tree_has(trees[k], edge) && tree_was_completed(trees[k], edge) ? ", completed"
                                                                                   : "");
    }
}

static void add_ends(Table *table, const View *view, const Instance *instance)
{
    const Graph *graph = model_graph(view->model);

    for (int i = -1; i < instance->scalar_count; i++) {
        const int number = i < 0 ? instance->edge : instance->scalar_edges[i];
        const Edge *edge = number >= 0 ? graph_edge(graph, number) : NULL;

        if (edge == NULL)
            continue;
        table_cells(table, "%s\t%s -> %s", domain_name(edge->domain),
                    graph_node(graph, edge->tail)->name, graph_node(graph, edge->head)->name);
    }
    if (instance->joint >= 0)
        table_cells(table, "acts on\t%s", model_instance(view->model, instance->joint)->name);
    if (instance->parts[0] >= 0)
        table_cells(table, "couples\t%s %s", model_instance(view->model, instance->parts[0])->name,
                    model_instance(view->model, instance->parts[1])->name);
    if (instance_is_unknown(instance)) {
        char *text = expr_text(instance->given->equation);

        table_cells(table, "0 =\t%s", text);
        mem_free(text);
    }
    if (instance->sensed != NULL) {
        char *text = expr_text(instance->sensed);

        table_cells(table, "of\t%s", text);
        mem_free(text);
    }
}

/* "[0, 0, 1]", "2 kg", "L4 m": numbers in the units of the page, formulas in SI */
static void add_value(Text *out, const View *view, const Value *value, const char *si)
{
    Text unit = {0}, entries = {0};
    bool is_numbers = true;
    double size = 1;

    for (int k = 0; k < value->count; k++)
        is_numbers = is_numbers && expr_is_number(value->at[k]);
    if (si != NULL && is_numbers)
        size = view_unit(view, si, &unit);
    else if (si != NULL)
        text_add(&unit, si);
    for (int k = 0; k < value->count; k++) {
        Text number = {0};
        char *entry = size == 1 ? expr_text(value->at[k]) : NULL;

        if (entry == NULL)
            text_number(&number, expr_value(value->at[k]) / size, 10);
        layout_item(&entries, entry != NULL ? entry : number.at);
        mem_free(entry);
        text_free(&number);
    }
    if (entries.length > 0)
        text_addf(out, value->count > 1 ? "[%s]" : "%s", entries.at);
    if (value->word != NULL)
        text_add(out, value->word);
    if (unit.length > 0 && strcmp(unit.at, "1") != 0)
        text_addf(out, " %s", unit.at);
    text_free(&entries);
    text_free(&unit);
}

static void add_values(Table *table, const View *view, const Instance *instance)
{
    for (int i = 0; i < instance->row->param_count; i++) {
        const Param *param = &instance->row->params[i];
        const int force = instance_in_force(instance, i);
        const Value *value = &instance->values[force];
        char *unit = param_unit(param, instance_takes_angle(instance, param));
        Text text = {0};

        /* long default values are not shown: no rotation, no further moments */
        if (value->word != NULL || (value->count > 0 && (value->given || value->count <= 3))) {
            add_value(&text, view, value, unit);
            table_cell(table, param->name);
            if (force == i)
                table_cells(table, "%s%s", text.at, value->given ? "" : "  (not said)");
            else
                table_cells(table, "%s  (as %s)", text.at, instance->row->params[force].name);
        }
        text_free(&text);
        mem_free(unit);
    }
}

static const char *coordinate_unit(CoordinateKind kind)
{
    return kind == COORDINATE_LENGTH ? "m" : kind == COORDINATE_PARAMETER ? "1" : "rad";
}

static void add_variable(Text *out, const View *view, const char *name, const char *si)
{
    Text item = {0}, unit = {0};

    text_add(&item, name);
    if (si != NULL)
        (void)view_unit(view, si, &unit);
    if (unit.length > 0 && strcmp(unit.at, "1") != 0)
        text_addf(&item, " [%s]", unit.at);
    layout_item(out, item.at);
    text_free(&item);
    text_free(&unit);
}

static bool is_own_coordinate(const Instance *instance, const char *name)
{
    for (int c = 0; c < instance->coord_count; c++)
        if (strcmp(instance->coord[c], name) == 0)
            return true;
    return false;
}

/* of a beam: how far it bends at a place, and what it carries there */
static void add_places(Text *items, const View *view, const Instance *instance)
{
    static const char *const names[] = {"u",       "v",        "w",        "phi",
                                        "axial",   "shear",    "sheary",   "shearz",
                                        "bending", "bendingy", "bendingz", "torsion"};

    for (int i = 0; i < COUNT(names); i++) {
        Text name = {0};
        const char *unit;

        text_addf(&name, "%s.%s", instance->name, names[i]);
        unit = model_place_unit(view->model, name.at);
        text_add(&name, "(x)");
        if (unit != NULL)
            add_variable(items, view, name.at, unit);
        text_free(&name);
    }
}

static void add_variables(Text *out, const View *view, const Instance *instance)
{
    Text items = {0};
    const Member *member;

    for (int c = 0; c < instance->coord_count; c++) {
        const char *unit = coordinate_unit(instance->coord_kind[c]);
        Text rate = {0}, rate_unit = {0};

        text_addf(&rate, "%s'", instance->coord[c]);
        text_addf(&rate_unit, "%s/s", unit);
        add_variable(&items, view, instance->coord[c], unit);
        add_variable(&items, view, rate.at, rate_unit.at);
        text_free(&rate);
        text_free(&rate_unit);
    }
    for (int i = 0;
         (member = component_member(instance->row, model_is_planar(view->model), i)) != NULL; i++) {
        Text name = {0};

        text_addf(&name, "%s.%s", instance->name, member->name);
        if (!is_own_coordinate(instance, name.at))
            add_variable(&items, view, name.at,
                         model_member_unit(view->model, instance, member->name));
        text_free(&name);
    }
    add_places(&items, view, instance);
    if (items.length > 0)
        layout_items(out, view->page.columns, "can be asked for: ", items.at);
    text_free(&items);
}

/* a variant of a row has that of the row */
static const char *brief_of(const Component *row)
{
    return row->brief != NULL ? row->brief : component_find(row->name)->brief;
}

static void print_instance(Text *out, const View *view, const Instance *instance)
{
    Table table = table_for("ll");
    Text coordinates = {0};

    text_addf(out, "%s: %s%s, %s\n", instance->name, instance->is_virtual ? "virtual " : "",
              instance->row->name, brief_of(instance->row));
    add_ends(&table, view, instance);
    add_standing(&table, view, instance->edge, false);
    for (int k = 0; k < instance->scalar_count; k++)
        add_standing(&table, view, instance->scalar_edges[k], instance->scalar_count > 1);
    for (int c = 0; c < instance->coord_count; c++)
        layout_item(&coordinates, instance->coord[c]);
    if (coordinates.length > 0)
        table_cells(&table, "%s\t%s", instance->coord_count == 1 ? "coordinate" : "coordinates",
                    coordinates.at);
    text_free(&coordinates);
    add_values(&table, view, instance);
    table_finish(out, &table, 2);
    add_convention(out, view, instance->row);
    add_variables(out, view, instance);
    if (instance->text != NULL)
        text_addf(out, "made by: %s\n", instance->text);
}

static bool print_parameter(Text *out, const View *view, const char *name)
{
    for (int i = 0; i < model_parameter_count(view->model); i++) {
        Expr definition;
        const Expr symbol = model_parameter(view->model, i, &definition);

        if (strcmp(expr_name(symbol), name) != 0)
            continue;
        text_addf(out, "%s: parameter, %s = ", name, name);
        if (!expr_is_number(definition)) {
            expr_print(out, definition, NOTATION_TEXT);
            text_add(out, " = ");
        }
        view_quantity(view, name, model_parameter_value(view->model, symbol), 10, out);
        text_char(out, '\n');
        return true;
    }
    return false;
}

static bool print_law(Text *out, const View *view, const char *name)
{
    const Expr *arguments;
    int count;
    const Expr body = model_law(view->model, name, &arguments, &count);

    if (body == NULL)
        return false;
    text_addf(out, "%s: law, %s(", name, name);
    for (int i = 0; i < count; i++)
        text_addf(out, "%s%s", i > 0 ? ", " : "", expr_name(arguments[i]));
    text_add(out, ") = ");
    expr_print(out, body, NOTATION_TEXT);
    text_char(out, '\n');
    return true;
}

static bool print_output(Text *out, const View *view, const char *name)
{
    for (int i = 0; i < model_output_count(view->model); i++) {
        const char *output;
        const Expr e = model_output(view->model, i, &output);

        if (strcmp(output, name) != 0)
            continue;
        text_addf(out, "%s: output, %s = ", name, name);
        expr_print(out, e, NOTATION_TEXT);
        text_char(out, '\n');
        return true;
    }
    return false;
}

static bool print_event(Text *out, const View *view, const char *name)
{
    for (int i = 0; i < model_event_count(view->model); i++) {
        const Event *event = model_event(view->model, i);
        Text action = {0};

        if (strcmp(event->name, name) != 0)
            continue;
        event_print(&action, event);
        text_addf(out, "%s: event, when %s: %s\nmade by: %s\n", name, event->condition, action.at,
                  event->text);
        text_free(&action);
        return true;
    }
    return false;
}

static bool print_node(Text *out, const View *view, const char *name)
{
    const Graph *graph = model_graph(view->model);
    const int node = graph_find_node(graph, name);
    const int *edges;
    Text names = {0};
    int count;

    if (node < 0)
        return false;
    count = graph_edges_at(graph, node, &edges);
    for (int i = 0; i < count; i++) {
        const Edge *edge = graph_edge(graph, edges[i]);

        text_addf(&names, "%s%s (%s)", i > 0 ? ", " : "", edge->name,
                  edge->tail == node ? "starts here" : "ends here");
    }
    text_addf(out, "%s: %s %s%s\n", name, domain_name(graph_node(graph, node)->domain),
              graph_node(graph, node)->domain == DOMAIN_MECHANICAL ? "frame" : "terminal",
              graph_node(graph, node)->datum ? ", the datum" : "");
    layout_words(out, view->page.columns, "  edges: ", names.at != NULL ? names.at : "none");
    text_free(&names);
    return true;
}

/* leg1: its ports, and what it is called inside */
static bool print_use(Text *out, const View *view, const char *name)
{
    const Use *use = model_find_use(view->model, name);
    const size_t length = strlen(name);
    Names *listed; /* a part and a parameter of one name once */
    Text inside = {0};
    const char *own;

    if (use == NULL)
        return false;
    text_addf(out, "%s: an instance of %s\n", name, use->subsystem->name);
    for (int i = 0; i < use->subsystem->port_count; i++) {
        const Port *port = &use->subsystem->ports[i];

        text_addf(out, "  %s %s ", port->is_frame ? "frame" : "terminal", port->name);
        if (use->bound[i] != NULL)
            text_addf(out, "is %s, given from outside\n", use->bound[i]);
        else
            text_addf(out, "is reached as %s.%s\n", name, port->name);
    }
    listed = names_new();
    for (int i = 0; (own = model_name(view->model, i)) != NULL; i++)
        if (strncmp(own, name, length) == 0 && own[length] == '.' && names_find(listed, own) < 0) {
            (void)names_add(listed, own);
            text_addf(&inside, "%s%s", inside.length > 0 ? " " : "", own);
        }
    names_free(listed);
    layout_words(out, view->page.columns, "  inside: ", inside.at != NULL ? inside.at : "nothing");
    text_free(&inside);
    return true;
}

static bool print_subsystem(Text *out, const View *view, const char *name)
{
    const Subsystem *subsystem = model_find_subsystem(view->model, name);
    int count = 0;

    if (subsystem == NULL)
        return false;
    for (int i = 0; i < model_use_count(view->model); i++)
        count += model_use(view->model, i)->subsystem == subsystem;
    text_addf(out, "%s: subsystem, ", name);
    layout_count(out, count, "instance", "instances");
    text_char(out, '\n');
    for (int i = 0; i < subsystem->port_count; i++)
        text_addf(out, "  %s %s, %s\n", subsystem->ports[i].is_frame ? "frame" : "terminal",
                  subsystem->ports[i].name,
                  subsystem->ports[i].is_through ? "which it gives itself" : "given in 'use'");
    for (int i = 0; i < subsystem->parameter_count; i++)
        text_addf(out, "%s%s%s", i == 0 ? "  parameters: " : " ", subsystem->parameters[i],
                  i == subsystem->parameter_count - 1 ? "\n" : "");
    text_addf(out, "its lines:\n%s", subsystem->body.text);
    return true;
}

/* h9.fx: what it means and in which unit; a coordinate: whose it is */
static bool print_variable(Text *out, const View *view, const char *name)
{
    const Instance *owner;
    const Member *member;
    const char *wanted;
    const char *unit;
    int index;

    if (model_coordinate(view->model, name, &owner, &index)) {
        text_addf(out, "%s: coordinate of %s, in ", name, owner->name);
        (void)view_unit(view, coordinate_unit(owner->coord_kind[index]), out);
        text_char(out, '\n');
        return true;
    }
    owner = model_owner(view->model, name, &wanted);
    member = owner != NULL ? component_find_member(owner->row, model_is_planar(view->model), wanted)
                           : NULL;
    if (member == NULL)
        return false;
    unit = model_member_unit(view->model, owner, wanted);
    text_addf(out, "%s: of %s, %s%s", name, owner->name, member->meaning,
              unit != NULL ? "; in " : "");
    if (unit != NULL)
        (void)view_unit(view, unit, out);
    text_char(out, '\n');
    return true;
}

Status info_print(const View *view, const char *name, Place place, Text *out, Diag *diag)
{
    const Instance *instance = model_find(view->model, name);
    Suggest suggest = suggest_for(name);
    const char *candidate;

    if (instance != NULL) {
        print_instance(out, view, instance);
        (void)print_parameter(out, view, name);
        return OK;
    }
    if (print_parameter(out, view, name) || print_law(out, view, name) ||
        print_output(out, view, name) || print_event(out, view, name) ||
        print_variable(out, view, name) || print_node(out, view, name) ||
        print_use(out, view, name) || print_subsystem(out, view, name))
        return OK;
    for (int i = 0; (candidate = model_name(view->model, i)) != NULL; i++)
        suggest_offer(&suggest, candidate);
    diag_at(diag, E_NAME, place, "nothing is called '%s'", name);
    suggest_or_hint(&suggest, diag,
                    "'show graph' and 'show params' list the names of the model, 'help %s' may "
                    "know the word",
                    name);
    return E_NAME;
}

/* --- check --- */

static bool is_used(const Model *model, Expr symbol)
{
    for (int i = 0; i < model_count(model); i++) {
        const Instance *instance = model_instance(model, i);

        if (equation_block_depends(instance->given, symbol))
            return true;
        for (int p = 0; p < instance->row->param_count; p++)
            for (int k = 0; k < instance->values[p].count; k++)
                if (expr_depends(instance->values[p].at[k], symbol))
                    return true;
    }
    for (int i = 0; i < model_parameter_count(model); i++) {
        Expr definition;

        if (model_parameter(model, i, &definition) != symbol && expr_depends(definition, symbol))
            return true;
    }
    for (int i = 0; i < model_output_count(model); i++) {
        const char *name;

        if (expr_depends(model_output(model, i, &name), symbol))
            return true;
    }
    for (int i = 0; i < model_event_count(model); i++) {
        const Event *event = model_event(model, i);

        if (expr_depends(event->when, symbol))
            return true;
        for (int k = 0; k < event->value_count; k++)
            if (expr_depends(event->values[k].value, symbol))
                return true;
    }
    for (int i = 0; i < 3; i++)
        if (expr_depends(model_gravity(model)[i], symbol))
            return true;
    for (int i = 0; i < model_start_count(model); i++)
        if (expr_depends(model_start(model, i)->value, symbol))
            return true;
    return false;
}

/* whether it is the port of an instance, or an unknown's own */
static bool is_taken(const Model *model, const char *node, const int *edges, int count)
{
    if (count > 0 && model_edge_owner(model, edges[0])->given != NULL)
        return true;
    for (int u = 0; u < model_use_count(model); u++) {
        const Use *use = model_use(model, u);

        for (int p = 0; p < use->subsystem->port_count; p++)
            if (use->bound[p] != NULL && strcmp(use->bound[p], node) == 0)
                return true;
    }
    return false;
}

static void add_unused(const View *view, Text *out)
{
    const Graph *graph = model_graph(view->model);
    Text frames = {0}, parameters = {0};

    for (int n = 0; n < graph_node_count(graph); n++) {
        const int *edges;
        const int count = graph_edges_at(graph, n, &edges);
        const Node *node = graph_node(graph, n);

        if (count < 2 && !node->datum && !is_taken(view->model, node->name, edges, count))
            layout_item(&frames, node->name);
    }
    for (int i = 0; i < model_parameter_count(view->model); i++) {
        Expr definition;
        const Expr symbol = model_parameter(view->model, i, &definition);

        if (!is_used(view->model, symbol))
            layout_item(&parameters, expr_name(symbol));
    }
    if (frames.length > 0)
        layout_words(out, view->page.columns, "ends that nothing is tied to: ", frames.at);
    if (parameters.length > 0)
        layout_words(out, view->page.columns, "parameters that nothing uses: ", parameters.at);
    text_free(&frames);
    text_free(&parameters);
}

/* remarks on the initial state */
static void add_remarks(const View *view, const Result *start, Text *out)
{
    Text lines = {0};

    if (start != NULL)
        remarks_write(result_remarks(start), &lines);
    if (lines.at != NULL)
        layout_words(out, view->page.columns, "", lines.at);
    text_free(&lines);
}

void check_print(const View *view, const Result *start, const char *why, Text *out)
{
    const System *system = view->system;
    const char *line;

    if (view_is_mechanical(view)) {
        layout_count(out, system_n(system), "coordinate", "coordinates");
        text_add(out, ", ");
        layout_count(out, system_m(system), "constraint", "constraints");
        text_add(out, ": ");
        view_freedoms(out, system, start != NULL ? result_freedoms(start) : -1);
        text_char(out, '\n');
    }
    if (graph_edge_count(model_graph(view->model)) == 0) {
        text_add(out, "no parts yet\n");
    } else if (system_nx(system) + system_nz(system) > 0 || !view_is_mechanical(view)) {
        text_add(out, "network: ");
        view_network(out, system);
        text_char(out, '\n');
    }
    for (int i = 0; (line = system_dropped(system, i)) != NULL; i++)
        layout_words(out, view->page.columns, "vanished: ", line);
    for (int i = 0; (line = system_remark(system, i)) != NULL; i++)
        layout_words(out, view->page.columns, "", line);
    add_unused(view, out);
    add_remarks(view, start, out);
    text_add(out, start != NULL ? "the start can be assembled\n" : "the start can't be assembled");
    if (start == NULL)
        text_addf(out, ": %s\n", why);
}
