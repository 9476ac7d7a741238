/* show_subsystem.c: a subsystem as a black box: internal equations, and what its ports give
 *
 * Of a definition, or of an instance, a part is made by itself, in which the frames that `use`
 * binds are massless bodies and terminals have sources. With w the efforts that the subsystem
 * exerts at its ports, its equations (port.h) are
 *
 *     M u' + Phi_u^T lambda = F - J^T w
 *
 * Rows of internal speeds are the internal equations; those of the massless bodies give w at the
 * frames that are bound (McPhee, Schmitke and Redmond 2004, figure 12). An instance's equations are
 * those of the part with what it is bound to in place of the inputs. */
#include "formulate/reduced/port.h"
#include "formulate/reduced/symbolic_solve.h"
#include "present/show.h"

#include <string.h>

/* a member of a frame: an acceleration, the effort dual to it */
static const struct {
    const char *acceleration, *effort;
    bool is_planar;
} components[] = {
    {"ax", "fx", true},      {"ay", "fy", true},      {"az", "fz", false},
    {"alphax", "tx", false}, {"alphay", "ty", false}, {"alphaz", "tz", true},
};

static const char *const planar_motion[] = {"x", "y", "theta"};
static const char *const spatial_motion[] = {"x", "y", "z", "q0", "q1", "q2", "q3"};

typedef LIST(const char *) Words;

typedef struct PortedSubsystem {
    const View *view;
    const Subsystem *subsystem;
    const Use *use; /* NULL: of the definition */
    bool
        is_definition; /* the part is made of the definition: also for an instance inside another */
    const char *prefix; /* of names in the part */
    Pool *pool;
    Model *part;
    ExtractedEnds ends;
    Scene scene;
    System *system;
    Words accelerations, efforts;
    LIST(int) component_ports; /* by component, its port */
    PortEquations *port;
} PortedSubsystem;

static const char *joined(const PortedSubsystem *b, const char *frame, const char *member)
{
    Text text = {0};
    const char *out;

    text_addf(&text, "%s.%s", frame, member);
    out = pool_text(b->pool, text.at, text.length);
    text_free(&text);
    return out;
}

static const char *port_name(PortedSubsystem *b, int port)
{
    return joined(b, b->prefix, b->subsystem->ports[port].name);
}

/* --- what is shown in place of the part's symbols --- */

/* the name without the prefix that a definition's part has; of an instance inside another its name
 * in the model */
static const char *plain_name(const PortedSubsystem *b, const char *name)
{
    const size_t length = strlen(b->prefix);

    if (!b->is_definition || strncmp(name, b->prefix, length) != 0 || name[length] != '.')
        return name;
    return b->use == NULL ? name + length + 1 : joined(b, b->use->name, name + length + 1);
}

/* The member of a port that `use` binds, with its primes: "x'" of "leg1.A.x'"; NULL: it is none. */
static const char *bound_member(const PortedSubsystem *b, const char *name, int *port)
{
    const size_t length = strlen(b->prefix);

    if (b->use == NULL || strncmp(name, b->prefix, length) != 0 || name[length] != '.')
        return NULL;
    name += length + 1;
    for (int i = 0; i < b->subsystem->port_count; i++) {
        const char *own = b->subsystem->ports[i].name;

        if (!b->subsystem->ports[i].is_through && strncmp(name, own, strlen(own)) == 0 &&
            name[strlen(own)] == '.') {
            *port = i;
            return name + strlen(own) + 1;
        }
    }
    return NULL;
}

/* whether a port is bound to what has no motion or voltage */
static bool is_bound_to_datum(const PortedSubsystem *b, int port)
{
    const Graph *graph = model_graph(b->view->model);
    const int node = graph_find_node(graph, b->use->bound[port]);

    return node >= 0 && graph_node(graph, node)->datum;
}

/* what a member of a bound port is outside: a formula, or its name where the model doesn't
 * determine it; NULL: it is no such member */
static Expr bound_value(PortedSubsystem *b, const char *name)
{
    System *outer = b->view->system;
    Arena *arena = model_arena(b->view->model);
    int port = 0;
    const char *member = bound_member(b, name, &port), *path;
    size_t length;
    Diag ignored = {0};
    Expr e;

    if (member == NULL)
        return NULL;
    if (is_bound_to_datum(b, port))
        return expr_int(arena, strcmp(member, "q0") == 0);
    length = strcspn(member, "'");
    path = joined(b, b->use->bound[port], pool_text(b->pool, member, length));
    if (system_variable(outer, path, (int)strlen(member + length), &e, &ignored) != OK)
        return expr_symbol(arena, joined(b, b->use->bound[port], member), SYMBOL_VARIABLE);
    return system_written(outer, system_plain(outer, e));
}

/* the current into a port, where it is an unknown of the network: minus that of its source */
static Expr source_current(PortedSubsystem *b, const char *name)
{
    Arena *arena = model_arena(b->view->model);

    for (int i = 0; i < b->ends.terminals.count; i++) {
        const ExtractedTerminal *terminal = &b->ends.terminals.at[i];
        const char *through = domain_through(terminal->domain);
        Text source = {0};
        bool is_it;

        text_addf(&source, EXTRACT_SOURCE ".%s", i, through);
        is_it = strcmp(source.at, name) == 0;
        text_free(&source);
        if (is_it)
            return expr_neg(arena,
                            expr_symbol(arena, plain_name(b, joined(b, terminal->node, through)),
                                        SYMBOL_VARIABLE));
    }
    return NULL;
}

static const char *constraint_name(const System *system, const Model *model, int k)
{
    const ConstraintRow *row = system_constraint(system, k);

    return row->edge >= 0 ? graph_edge(model_graph(model), row->edge)->name
                          : system_instance_name(system, row->instance);
}

/* the multiplier of the same constraint of the whole model; NULL: it is none, or has none there */
static Expr outer_multiplier(const PortedSubsystem *b, Expr symbol)
{
    const System *outer = b->view->system;
    int k = 0;

    if (b->use == NULL || expr_symbol_kind(symbol) != SYMBOL_MULTIPLIER)
        return NULL;
    while (k < system_m(b->system) && system_multiplier(b->system, k) != symbol)
        k++;
    for (int i = 0; k < system_m(b->system) && i < system_m(outer); i++)
        if (strcmp(system_constraint(outer, i)->direction,
                   system_constraint(b->system, k)->direction) == 0 &&
            strcmp(constraint_name(outer, b->view->model, i),
                   plain_name(b, constraint_name(b->system, b->part, k))) == 0)
            return system_multiplier(outer, i);
    return NULL;
}

static Expr shown_symbol(PortedSubsystem *b, Expr symbol)
{
    const char *name = expr_name(symbol);
    Expr value = bound_value(b, name);

    if (value == NULL)
        value = outer_multiplier(b, symbol);
    if (value == NULL)
        value = source_current(b, name);
    if (value == NULL && plain_name(b, name) != name)
        value =
            expr_symbol(model_arena(b->view->model), plain_name(b, name), expr_symbol_kind(symbol));
    return value != NULL ? value : symbol;
}

static Expr shown(PortedSubsystem *b, Expr e)
{
    Arena *arena = model_arena(b->view->model);
    Expr *symbols = NULL, *values;
    int count;

    e = model_extracted(arena, &b->ends, system_plain(b->system, e));
    count = expr_symbols(&e, 1, &symbols);
    values = NEW_ARRAY(Expr, count + 1);
    for (int i = 0; i < count; i++)
        values[i] = shown_symbol(b, symbols[i]);
    e = expr_substitute(arena, e, symbols, values, count);
    MEM_FREE(symbols, values);
    return e;
}

/* a variable of the user's, by its name in the part */
static Expr variable(PortedSubsystem *b, const char *name)
{
    return expr_symbol(model_arena(b->view->model), name, SYMBOL_VARIABLE);
}

/* --- equations --- */

static void push_term(PortedSubsystem *b, ShownEquation *equation, bool is_left, Expr coefficient,
                      Expr symbol)
{
    Arena *arena = model_arena(b->view->model);
    ViewTerm term = {shown(b, coefficient), NULL};

    if (expr_is_zero(term.coefficient))
        return;
    if (symbol != NULL) {
        term.symbol = shown(b, symbol);
        /* an input that is bound */
        if (expr_kind(term.symbol) != EXPR_SYMBOL)
            term = (ViewTerm){expr_mul(arena, term.coefficient, term.symbol), NULL};
        if (expr_is_zero(term.coefficient))
            return;
    }
    if (is_left)
        LIST_PUSH(equation->left, term);
    else
        LIST_PUSH(equation->right, term);
}

static char *lead_of(PortedSubsystem *b, const char *name)
{
    Text lead = {0};

    text_addf(&lead, "%s:  ", plain_name(b, name));
    return text_done(&lead);
}

/* whether an instance is a massless body in the place of a bound frame */
static bool is_massless(const PortedSubsystem *b, const char *name)
{
    for (int i = 0; i < b->ends.frames.count; i++)
        if (strcmp(b->ends.frames.at[i], name) == 0)
            return true;
    return false;
}

static bool is_bound_frame(const PortedSubsystem *b, const Variable *v)
{
    return is_massless(b, system_instance_name(b->system, v->instance));
}

static bool is_through(const PortedSubsystem *b, int component)
{
    return b->subsystem->ports[b->component_ports.at[component]].is_through;
}

/* row i of the motion, of an internal speed */
static void push_motion(PortedSubsystem *b, EquationList *equations, int i)
{
    const PortEquations *p = b->port;
    const Variable *speed = system_u(b->system, i);
    ShownEquation equation = {.lead = NULL, .name = NULL, .left = {0}, .right = {0}};
    char *of;

    for (int j = 0; j < p->nu; j++)
        push_term(b, &equation, true, p->mass[i * p->nu + j], system_acceleration(b->system, j));
    for (int k = 0; k < p->m; k++)
        push_term(b, &equation, true, p->phi_u[k * p->nu + i], system_multiplier(b->system, k));
    push_term(b, &equation, false, p->force[i], NULL);
    for (int k = 0; k < p->options.count; k++)
        if (is_through(b, k))
            push_term(b, &equation, false, expr_neg(p->arena, p->slope[k * p->nu + i]),
                      variable(b, b->efforts.at[k]));
    of = mem_text(speed->name, strcspn(speed->name, "'"));
    equation.lead = lead_of(b, of);
    mem_free(of);
    LIST_PUSH(*equations, equation);
}

/* a row of a scalar domain */
static void push_network(PortedSubsystem *b, EquationList *equations, int i)
{
    const int edge = system_network_edge(b->system, i);
    ShownEquation equation = {.lead = NULL, .name = NULL, .left = {0}, .right = {0}};
    Expr left, right;

    system_network_equation(b->system, i, &left, &right);
    push_term(b, &equation, true, left, NULL);
    push_term(b, &equation, false, right, NULL);
    equation.lead = lead_of(b, graph_edge(model_graph(b->part), edge)->name);
    LIST_PUSH(*equations, equation);
}

static Status push_constraint(PortedSubsystem *b, EquationList *equations, int k, Diag *diag)
{
    ShownEquation equation = {.lead = NULL, .name = NULL, .left = {0}, .right = {0}};
    Expr e;

    if (system_constraint(b->system, k)->is_rate) {
        for (int j = 0; j < b->port->nu; j++)
            push_term(b, &equation, true, b->port->phi_u[k * b->port->nu + j],
                      system_u(b->system, j)->symbol);
        TRY(system_show(b->system, BLOCK_VELOCITY, k, 0, &e, diag));
        push_term(b, &equation, false, e, NULL);
    } else {
        TRY(system_show(b->system, BLOCK_CONSTRAINTS, k, 0, &e, diag));
        push_term(b, &equation, true, e, NULL);
    }
    equation.lead = lead_of(b, constraint_name(b->system, b->part, k));
    LIST_PUSH(*equations, equation);
    return OK;
}

static Status push_internal(PortedSubsystem *b, EquationList *equations, Diag *diag)
{
    for (int i = 0; i < b->port->nu; i++)
        if (!is_bound_frame(b, system_u(b->system, i)))
            push_motion(b, equations, i);
    for (int k = 0; k < b->port->m; k++)
        TRY(push_constraint(b, equations, k, diag));
    for (int i = 0; i < system_network_count(b->system); i++)
        push_network(b, equations, i);
    return OK;
}

/* --- ports --- */

/* "name = " in the notation */
static char *left_side(PortedSubsystem *b, const char *name)
{
    return view_expression(b->view, variable(b, plain_name(b, name)));
}

static Status push_variable(PortedSubsystem *b, EquationList *equations, const char *name,
                            const char *shown_as, bool negative, Diag *diag)
{
    Arena *arena = model_arena(b->view->model);
    Expr e;

    TRY(system_variable(b->system, name, 0, &e, diag));
    e = system_written(b->system, e);
    view_value(equations, left_side(b, shown_as), shown(b, negative ? expr_neg(arena, e) : e));
    return OK;
}

/* The sum over rows of a bound frame of `of` times what a unit of speed moves at component k: their
 * speeds are those of the frame along orthonormal axes, so that this solves the rows for w. */
static Expr along(const PortedSubsystem *b, int k, const Expr *of, int step)
{
    const PortEquations *p = b->port;
    Expr sum = expr_int(p->arena, 0);

    for (int i = 0; i < p->nu; i++)
        if (is_bound_frame(b, system_u(b->system, i)))
            sum =
                expr_add(p->arena, sum, expr_mul(p->arena, p->slope[k * p->nu + i], of[i * step]));
    port_fold_units(p, &sum, 1);
    return system_written(b->system, sum);
}

/* component k of the effort on what a frame is bound to */
static void push_effort(PortedSubsystem *b, EquationList *equations, int k)
{
    const PortEquations *p = b->port;
    ShownEquation equation = {.lead = NULL, .left = {0}, .right = {0}};

    equation.name = left_side(b, b->efforts.at[k]);
    push_term(b, &equation, false, along(b, k, p->force, 1), NULL);
    for (int j = 0; j < p->nu; j++)
        push_term(b, &equation, false, expr_neg(p->arena, along(b, k, p->mass + j, p->nu)),
                  system_acceleration(b->system, j));
    for (int j = 0; j < p->m; j++)
        push_term(b, &equation, false,
                  expr_neg(p->arena, along(b, k, p->phi_u + (size_t)j * (size_t)p->nu, 1)),
                  system_multiplier(b->system, j));
    for (int j = 0; j < p->options.count; j++)
        if (is_through(b, j))
            push_term(b, &equation, false,
                      expr_neg(p->arena, along(b, k, p->slope + (size_t)j * (size_t)p->nu, 1)),
                      variable(b, b->efforts.at[j]));
    LIST_PUSH(*equations, equation);
}

static Status push_frame(PortedSubsystem *b, EquationList *equations, int port, Diag *diag)
{
    const bool is_planar = model_is_planar(b->part);
    const char *const *members = is_planar ? planar_motion : spatial_motion;
    const int count = is_planar ? COUNT(planar_motion) : COUNT(spatial_motion);

    if (b->subsystem->ports[port].is_through) {
        for (int i = 0; i < count; i++) {
            const char *name = joined(b, port_name(b, port), members[i]);

            TRY(push_variable(b, equations, name, name, false, diag));
        }
        return OK;
    }
    for (int k = 0; k < b->efforts.count; k++)
        if (b->component_ports.at[k] == port)
            push_effort(b, equations, k);
    return OK;
}

static Status push_terminal(PortedSubsystem *b, EquationList *equations, int terminal, Diag *diag)
{
    const ExtractedTerminal *t = &b->ends.terminals.at[terminal];
    const char *through = domain_through(t->domain);
    Text source = {0};
    Status status = OK;

    if (!t->is_across) {
        const char *name = joined(b, t->node, domain_across(t->domain));

        return push_variable(b, equations, name, name, false, diag);
    }
    text_addf(&source, EXTRACT_SOURCE ".%s", terminal, through);
    status = push_variable(b, equations, source.at, joined(b, t->node, through), true, diag);
    text_free(&source);
    return status;
}

static Status push_ports(PortedSubsystem *b, EquationList *equations, Diag *diag)
{
    int terminal = 0;

    for (int i = 0; i < b->subsystem->port_count; i++)
        if (b->subsystem->ports[i].is_frame)
            TRY(push_frame(b, equations, i, diag));
        else
            TRY(push_terminal(b, equations, terminal++, diag));
    return OK;
}

/* --- the part by itself --- */

static void add_components(PortedSubsystem *b)
{
    const bool is_planar = model_is_planar(b->view->model);

    for (int i = 0; i < b->subsystem->port_count; i++)
        for (int k = 0; k < COUNT(components); k++) {
            if (!b->subsystem->ports[i].is_frame || (is_planar && !components[k].is_planar))
                continue;
            LIST_PUSH(b->accelerations, joined(b, port_name(b, i), components[k].acceleration));
            LIST_PUSH(b->efforts, joined(b, port_name(b, i), components[k].effort));
            LIST_PUSH(b->component_ports, i);
        }
}

/* an expression of the part with the model's names */
static Expr in_model(const PortedSubsystem *b, Expr e)
{
    Arena *arena = model_arena(b->view->model);
    Expr *symbols = NULL, *values;
    const int count = expr_symbols(&e, 1, &symbols);

    values = NEW_ARRAY(Expr, count + 1);
    for (int i = 0; i < count; i++)
        values[i] =
            expr_symbol(arena, plain_name(b, expr_name(symbols[i])), expr_symbol_kind(symbols[i]));
    e = expr_substitute(arena, e, symbols, values, count);
    MEM_FREE(symbols, values);
    return e;
}

static bool same_numbers(const PortedSubsystem *b, const Instance *part, const Instance *own)
{
    if (part->row != own->row)
        return false;
    for (int k = 0; k < part->row->param_count; k++) {
        if (part->values[k].count != own->values[k].count)
            return false;
        for (int c = 0; c < part->values[k].count; c++)
            if (in_model(b, part->values[k].at[c]) != own->values[k].at[c])
                return false;
    }
    return true;
}

/* An instance inside another is shown by its definition, unless a number of its parts was set. */
static Status check_set_numbers(const PortedSubsystem *b, Diag *diag)
{
    for (int i = 0; b->use != NULL && b->is_definition && i < model_count(b->part); i++) {
        const Instance *part = model_instance(b->part, i), *own;
        const char *name = plain_name(b, part->name);

        if (name == part->name || is_massless(b, part->name)) /* a source or a body at a port */
            continue;
        own = model_find(b->view->model, name);
        if (own != NULL && same_numbers(b, part, own))
            continue;
        (void)diag_set(diag, E_MODEL, "%s isn't as the definition has it: numbers of it were set",
                       name);
        diag_hint(diag, "'show %s' shows the definition", b->subsystem->name);
        return E_MODEL;
    }
    return OK;
}

static Status make_part(PortedSubsystem *b, const char *name, Diag *diag)
{
    SystemOptions options = {.watch = b->view->watch};
    PortOptions ports = {.keeps_networks = true, .watch = b->view->watch};

    TRY(model_isolate(b->view->model, b->is_definition ? b->subsystem->name : name, &b->part,
                      &b->ends, diag));
    TRY(check_set_numbers(b, diag));
    options.form = (NetworkForm)model_setting_value(b->part, SETTING_NETWORK);
    TRY(model_scene(b->part, &b->scene, diag));
    TRY(system_new_view(&b->scene, &options, &b->system, diag));
    add_components(b);
    ports.components = b->accelerations.at;
    ports.count = b->accelerations.count;
    TRY(port_new(b->system, &ports, &b->port, diag));
    port_fold_units(b->port, b->port->slope, b->port->ends * b->port->nu);
    return OK;
}

static void black_box_free(PortedSubsystem *b)
{
    port_free(b->port);
    system_free(b->system);
    scene_free(&b->scene);
    model_free(b->part);
    LIST_FREE(b->accelerations);
    LIST_FREE(b->efforts);
    LIST_FREE(b->component_ports);
    LIST_FREE(b->ends.frames);
    LIST_FREE(b->ends.terminals);
    pool_free(b->pool);
}

/* --- output --- */

/* a member of a port as an input: of what it is bound to, if that moves */
static void add_input(PortedSubsystem *b, int port, const char *member, Text *out)
{
    const bool is_bound = b->use != NULL && !b->subsystem->ports[port].is_through;

    if (!is_bound)
        layout_item(out, plain_name(b, joined(b, port_name(b, port), member)));
    else if (!is_bound_to_datum(b, port))
        layout_item(out, joined(b, b->use->bound[port], member));
}

/* what the outside gives: motions and voltages that are bound, efforts and currents elsewhere */
static void print_inputs(PortedSubsystem *b, Text *out)
{
    const bool is_planar = model_is_planar(b->view->model);
    const char *const *members = is_planar ? planar_motion : spatial_motion;
    const int count = is_planar ? COUNT(planar_motion) : COUNT(spatial_motion);
    Text line = {0}, list = {0};
    int terminal = 0;

    for (int i = 0; i < b->subsystem->port_count; i++) {
        const Port *port = &b->subsystem->ports[i];

        if (!port->is_frame) {
            const ExtractedTerminal *t = &b->ends.terminals.at[terminal++];

            add_input(b, i, t->is_across ? domain_across(t->domain) : domain_through(t->domain),
                      &list);
        } else if (port->is_through) {
            for (int k = 0; k < COUNT(components); k++)
                if (!is_planar || components[k].is_planar)
                    add_input(b, i, components[k].effort, &list);
        } else {
            for (int k = 0; k < count; k++)
                add_input(b, i, members[k], &list);
        }
    }
    text_addf(&line, "inputs: %s", list.at != NULL ? list.at : "none");
    view_comment(out, b->view, line.at);
    text_free(&line);
    text_free(&list);
}

/* which constraint each multiplier belongs to */
static void print_multipliers(PortedSubsystem *b, Text *out)
{
    Text item = {0};

    for (int k = 0; k < system_m(b->system); k++) {
        text_addf(&item, "%s is of %s, %s", expr_name(shown(b, system_multiplier(b->system, k))),
                  plain_name(b, constraint_name(b->system, b->part, k)),
                  system_constraint(b->system, k)->direction);
        view_comment(out, b->view, item.at);
        text_free(&item);
    }
}

static void print_part(const PortedSubsystem *b, const char *words, EquationList *equations,
                       Text *out)
{
    view_comment(out, b->view, words);
    view_block(out, b->view, equations);
}

static bool wants(const Selection *selection, const char *word)
{
    return selection->part == NULL || strcmp(selection->part, word) == 0;
}

Status show_subsystem(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const char *name = selection->item->text;
    PortedSubsystem b = {.view = view,
                         .use = model_find_use(view->model, name),
                         .subsystem = model_find_subsystem(view->model, name),
                         .prefix = name,
                         .pool = pool_new(0)};
    EquationList internal = {0}, ports = {0};
    Status status = OK;

    if (b.use != NULL)
        b.subsystem = b.use->subsystem;
    b.is_definition = b.use == NULL || b.use->outer >= 0;
    if (b.is_definition)
        b.prefix = EXTRACT_INSTANCE;
    CHECK(make_part(&b, name, diag));
    CHECK(push_internal(&b, &internal, diag));
    CHECK(push_ports(&b, &ports, diag));
    print_inputs(&b, out);
    print_multipliers(&b, out);
    if (wants(selection, "internal"))
        print_part(&b, "internal equations", &internal, out);
    if (wants(selection, "ports"))
        print_part(&b, "constitutive equations of the ports", &ports, out);
done:
    equations_free(&internal);
    equations_free(&ports);
    black_box_free(&b);
    return status;
}
