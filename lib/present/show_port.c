/* show_port.c: Norton and Thevenin equivalents of mechanisms at frames
 *
 * A part of the model is made a model by itself, whose equations are solved for the forces and
 * moments at its frames, or for their accelerations. */
#include "formulate/reduced/port.h"
#include "present/show.h"

#include <math.h>
#include <string.h>

enum { SHOWN_DIGITS = 6 };

/* components of a frame: an acceleration, and its force */
static const struct {
    const char *acceleration, *force, *direction;
    bool is_rotation, is_planar;
} components[] = {
    {"ax", "fx", "x", false, true},
    {"ay", "fy", "y", false, true},
    {"az", "fz", "z", false, false},
    {"alphax", "tx", "turning about x", true, false},
    {"alphay", "ty", "turning about y", true, false},
    {"alphaz", "tz", "turning about z", true, true},
};

typedef LIST(const char *) Words;

typedef struct PortRequest {
    const View *view;
    bool is_norton;
    Words frames; /* each once, in order */
    LIST(Place) frame_places;
    bool is_whole_frames; /* otherwise single components are named */
    const char *kind;     /* translation, rotation; NULL: both */
    Words accelerations;  /* "leg1.B.ax" */
    Words forces;         /* "leg1.B.fx" */
    Words of;
    LIST(Place) of_places;
    Pool *pool;
    Model *part; /* the part by itself, or a fork of the whole */
    bool is_whole;
    ExtractedEnds ends;
    Words given; /* accelerations of frames that move with the rest */
    Scene scene;
    System *system;
} PortRequest;

static const char *word_of(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_VARIABLE && syntax->primes == 0 && !syntax->has_unit
               ? syntax->text
               : NULL;
}

static const char *verb_of(const PortRequest *r)
{
    return r->is_norton ? "norton" : "thevenin";
}

static const char *dual_of(const PortRequest *r)
{
    return r->is_norton ? "thevenin" : "norton";
}

static const char *joined(PortRequest *r, const char *frame, const char *member)
{
    Text text = {0};
    const char *out;

    text_addf(&text, "%s.%s", frame, member);
    out = pool_text(r->pool, text.at, text.length);
    text_free(&text);
    return out;
}

static int frame_node(const View *view, const char *name)
{
    const int node = graph_find_node(model_graph(view->model), name);

    return node >= 0 && graph_node(model_graph(view->model), node)->domain == DOMAIN_MECHANICAL
               ? node
               : -1;
}

bool port_is_frame(const View *view, const Syntax *syntax)
{
    const char *name = word_of(syntax), *dot;
    char *frame;
    bool is_frame;

    if (name == NULL)
        return false;
    if (frame_node(view, name) >= 0)
        return true;
    dot = strrchr(name, '.');
    if (dot == NULL)
        return false;
    frame = mem_text(name, (size_t)(dot - name));
    is_frame = frame_node(view, frame) >= 0;
    mem_free(frame);
    return is_frame;
}

/* --- what is requested --- */

static Status unknown_frame(const View *view, const Syntax *item, Diag *diag)
{
    const Graph *graph = model_graph(view->model);
    const char *name = word_of(item);
    Suggest suggest = suggest_for(name != NULL ? name : "");

    for (int i = 0; i < graph_node_count(graph); i++)
        if (graph_node(graph, i)->domain == DOMAIN_MECHANICAL)
            suggest_offer(&suggest, graph_node(graph, i)->name);
    (void)diag_at(diag, E_NAME, item->place, "no frame is called '%s'",
                  name != NULL ? name : "...");
    suggest_or_hint(&suggest, diag, "'show nodes' lists frames");
    return E_NAME;
}

static Status add_component(PortRequest *r, const char *frame, int component, Place place,
                            Diag *diag)
{
    const char *acceleration = joined(r, frame, components[component].acceleration);

    for (int i = 0; i < r->accelerations.count; i++)
        if (strcmp(r->accelerations.at[i], acceleration) == 0)
            return diag_at(diag, E_SYNTAX, place, "'%s' is named twice", acceleration);
    LIST_PUSH(r->accelerations, acceleration);
    LIST_PUSH(r->forces, joined(r, frame, components[component].force));
    return OK;
}

static Status add_frame(PortRequest *r, const char *frame, Place place, Diag *diag)
{
    const int node = frame_node(r->view, frame);

    if (graph_node(model_graph(r->view->model), node)->datum) {
        (void)diag_at(diag, E_MODEL, place, "%s doesn't move: no force follows from its motion",
                      frame);
        diag_hint(diag, "name a frame of a body; the force on ground is that of a joint, such as "
                        "'show h.fx'");
        return E_MODEL;
    }
    for (int i = 0; i < r->frames.count; i++)
        if (strcmp(r->frames.at[i], frame) == 0)
            return OK;
    LIST_PUSH(r->frames, frame);
    LIST_PUSH(r->frame_places, place);
    return OK;
}

/* a member of a frame: "leg1.B.ax" */
static Status add_member(PortRequest *r, const Syntax *item, const char *dot, Diag *diag)
{
    const bool is_planar = model_is_planar(r->view->model);
    const char *frame = pool_text(r->pool, item->text, (size_t)(dot - item->text));
    Text list = {0};

    TRY(add_frame(r, frame, item->place, diag));
    for (int k = 0; k < COUNT(components); k++) {
        if (is_planar && !components[k].is_planar)
            continue;
        if (strcmp(dot + 1, components[k].acceleration) == 0)
            return add_component(r, frame, k, item->place, diag);
    }
    for (int k = 0; k < COUNT(components); k++)
        if (!is_planar || components[k].is_planar)
            layout_item(&list, components[k].acceleration);
    (void)diag_at(diag, E_NAME, item->place, "'%s' is no acceleration of frame %s", dot + 1, frame);
    diag_hint(diag, "a frame alone has all components; single ones are %s", list.at);
    text_free(&list);
    return E_NAME;
}

/* all components of frames, or those of one kind: `translation`, `rotation` */
static Status add_components(PortRequest *r, const char *kind, Diag *diag)
{
    const bool is_planar = model_is_planar(r->view->model);

    for (int i = 0; i < r->frames.count; i++)
        for (int k = 0; k < COUNT(components); k++) {
            if ((is_planar && !components[k].is_planar) ||
                (kind != NULL && components[k].is_rotation != (kind[0] == 'r')))
                continue;
            TRY(add_component(r, r->frames.at[i], k, r->frame_places.at[i], diag));
        }
    return OK;
}

static bool is_kind(const char *word)
{
    return word != NULL && (strcmp(word, "translation") == 0 || strcmp(word, "rotation") == 0);
}

static Status read_items(PortRequest *r, const Selection *selection, Diag *diag)
{
    const Syntax *kind = NULL;
    bool has_whole = false;

    for (int i = 0; i < selection->port_count; i++) {
        const Syntax *item = selection->ports[i];
        const char *name = word_of(item);

        if (is_kind(name) && frame_node(r->view, name) < 0) {
            if (kind != NULL)
                return diag_at(diag, E_SYNTAX, item->place,
                               "translation or rotation stands once; both are meant without it");
            kind = item;
            continue;
        }
        if (name == NULL || !port_is_frame(r->view, item))
            return unknown_frame(r->view, item, diag);
        if (frame_node(r->view, name) >= 0) {
            TRY(add_frame(r, name, item->place, diag));
            has_whole = true;
        } else {
            TRY(add_member(r, item, strrchr(name, '.'), diag));
        }
    }
    if (has_whole && r->accelerations.count > 0) {
        (void)diag_at(diag, E_SYNTAX, selection->ports[0]->place,
                      "frames and single components of frames don't go together");
        diag_hint(diag, "name each component: %s", r->accelerations.at[0]);
        return E_SYNTAX;
    }
    if (kind != NULL && !has_whole)
        return diag_at(diag, E_SYNTAX, kind->place, "'%s' stands behind frames", kind->text);
    if (r->frames.at == NULL) {
        (void)diag_set(diag, E_SYNTAX, "no frame is named");
        return E_SYNTAX;
    }
    r->is_whole_frames = has_whole;
    r->kind = kind != NULL ? kind->text : NULL;
    return has_whole ? add_components(r, r->kind, diag) : OK;
}

/* the outermost instance that contains a frame; NULL: none */
static const Use *instance_around(const View *view, const char *frame)
{
    const int use = model_use_around(view->model, frame);

    return use >= 0 ? model_use(view->model, use) : NULL;
}

static Status read_of(PortRequest *r, const Selection *selection, Diag *diag)
{
    if (selection->has_of && selection->of_count == 0) {
        (void)diag_set(diag, E_SYNTAX, "'of' is followed by components and instances");
        diag_hint(diag, "show %s %s of NAME, NAME", verb_of(r), r->frames.at[0]);
        return E_SYNTAX;
    }
    for (int i = 0; i < selection->of_count; i++) {
        const char *name = word_of(selection->of[i]);

        if (name == NULL)
            return diag_at(diag, E_SYNTAX, selection->of[i]->place,
                           "'of' is followed by names of components and instances");
        LIST_PUSH(r->of, name);
        LIST_PUSH(r->of_places, selection->of[i]->place);
    }
    /* a port of an instance: of that instance */
    for (int i = 0; r->of_places.count == 0 && i < r->frames.count; i++) {
        const Use *use = instance_around(r->view, r->frames.at[i]);

        if (use == NULL || (r->of.count > 0 && strcmp(r->of.at[0], use->name) != 0)) {
            r->of.count = 0;
            break;
        }
        if (r->of.count == 0)
            LIST_PUSH(r->of, use->name);
    }
    while (r->of_places.count < r->of.count)
        LIST_PUSH(r->of_places, r->frame_places.at[0]);
    return OK;
}

/* --- the part by itself --- */

static Status make_part(PortRequest *r, Diag *diag)
{
    const Extract extract = {.names = r->of.at,
                             .places = r->of_places.at,
                             .count = r->of.count,
                             .frames = r->frames.at,
                             .frame_places = r->frame_places.at,
                             .frame_count = r->frames.count};
    SystemOptions options = {.form = NETWORK_STATE, .watch = r->view->watch};

    r->is_whole = r->of.count == 0;
    if (r->is_whole)
        TRY(model_fork(r->view->model, &r->part, diag));
    else
        TRY(model_extract(r->view->model, &extract, &r->part, &r->ends, diag));
    options.form = (NetworkForm)model_setting_value(r->part, SETTING_NETWORK);
    TRY(model_scene(r->part, &r->scene, diag));
    return system_new_view(&r->scene, &options, &r->system, diag);
}

/* the body that carries a frame of the part */
static const char *carrier(const Model *part, const char *frame)
{
    const Graph *graph = model_graph(part);
    int node = graph_find_node(graph, frame);

    for (int i = model_count(part) - 1; i >= 0 && node >= 0; i--) {
        const Instance *arm = model_instance(part, i);

        if (arm->row->family == FAMILY_ARM && arm->head == node) {
            node = arm->tail;
            i = model_count(part);
        }
    }
    return node >= 0 ? graph_node(graph, node)->name : frame;
}

/* those components of a frame that are not asked for */
static void add_given(PortRequest *r, const char *frame)
{
    const bool is_planar = model_is_planar(r->view->model);

    for (int k = 0; k < COUNT(components); k++) {
        const char *name = joined(r, frame, components[k].acceleration);
        bool is_asked = is_planar && !components[k].is_planar;

        for (int i = 0; i < r->accelerations.count; i++)
            is_asked = is_asked || strcmp(r->accelerations.at[i], name) == 0;
        if (!is_asked)
            LIST_PUSH(r->given, name);
    }
}

/* Frames at which the rest moves the part: of each body one frame, and if possible one that is
 * asked for. */
static void find_given(PortRequest *r)
{
    for (int i = 0; i < r->ends.frames.count; i++) {
        const char *body = r->ends.frames.at[i], *frame = body;

        for (int k = r->frames.count - 1; k >= 0; k--)
            if (strcmp(carrier(r->part, r->frames.at[k]), body) == 0)
                frame = r->frames.at[k];
        add_given(r, frame);
    }
}

static Status refuse_sides(const PortRequest *r, Diag *diag)
{
    for (int i = 0; i < model_count(r->part); i++)
        if (model_instance(r->part, i)->row->sticks) {
            (void)diag_set(diag, E_MODEL,
                           "%s sticks or slips: forces and accelerations at a frame are in no "
                           "linear relation",
                           model_instance(r->part, i)->name);
            diag_hint(diag,
                      r->is_whole ? "name after 'of' what the part consists of, without %s"
                                  : "leave %s out of what is named after 'of'",
                      model_instance(r->part, i)->name);
            return E_MODEL;
        }
    return OK;
}

/* --- refusal --- */

static void add_names(Text *out, const Words *names)
{
    for (int i = 0; i < names->count; i++)
        layout_item(out, names->at[i]);
}

/* what follows the topic */
static void add_request(Text *out, const PortRequest *r, bool with_of)
{
    const Words *items = r->kind != NULL || r->is_whole_frames ? &r->frames : &r->accelerations;

    for (int i = 0; i < items->count; i++)
        text_addf(out, "%s%s", i > 0 ? " " : "", items->at[i]);
    if (r->kind != NULL)
        text_addf(out, " %s", r->kind);
    for (int i = 0; with_of && i < r->of.count; i++)
        text_addf(out, "%s%s", i == 0 ? " of " : ", ", r->of.at[i]);
}

/* there is no such relation; `has_dual`: but the other one */
static Status no_port(const PortRequest *r, const PortFault *fault, bool has_dual, Diag *diag)
{
    const bool names_parts = r->of.count > 0 && instance_around(r->view, r->frames.at[0]) == NULL;
    Text frames = {0}, request = {0}, unknown = {0};
    bool has_rotation = false, has_translation = false;

    if (fault->unknown != NULL)
        text_add_n(&unknown, fault->unknown, strcspn(fault->unknown, "'"));
    add_names(&frames, &r->frames);
    add_request(&request, r, names_parts);
    for (int i = 0; i < r->accelerations.count; i++) {
        const bool turns = strstr(r->accelerations.at[i], ".alpha") != NULL;

        has_rotation = has_rotation || turns;
        has_translation = has_translation || !turns;
    }
    if (!r->is_norton || !has_dual)
        (void)diag_set(diag, E_MODEL,
                       "no inertia opposes a force or moment at %s%s%s: there is no %s "
                       "equivalent",
                       frames.at, fault->unknown != NULL ? ", along " : "",
                       unknown.at != NULL ? unknown.at : "", r->is_norton ? "Norton" : "Thevenin");
    else if (fault->driver != NULL)
        (void)diag_set(diag, E_MODEL,
                       "%s prescribes a motion, so that the acceleration of %s can't be chosen: "
                       "there is no Norton equivalent",
                       fault->driver, frames.at);
    else
        (void)diag_set(diag, E_MODEL,
                       "the %d components of the acceleration of %s depend on each other: there is "
                       "no Norton equivalent",
                       r->accelerations.count, frames.at);
    if (has_dual && r->is_norton && has_rotation && has_translation)
        diag_hint(diag,
                  "'show thevenin %s' shows the other one; with 'translation' behind the frame "
                  "there are forces without moments",
                  request.at);
    else if (has_dual)
        diag_hint(diag, "'show %s %s' shows the other one", dual_of(r), request.at);
    else if (has_rotation && has_translation)
        diag_hint(diag, "with 'translation' behind the frames there are forces without moments");
    text_free(&frames);
    text_free(&request);
    text_free(&unknown);
    return E_MODEL;
}

/* --- output --- */

/* "lead a, b, c" as a comment */
static void print_names(const PortRequest *r, const char *lead, const Words *names, Text *out)
{
    Text line = {0}, list = {0};

    add_names(&list, names);
    text_addf(&line, "%s%s", lead, list.at != NULL ? list.at : "");
    view_comment(out, r->view, line.at);
    text_free(&list);
    text_free(&line);
}

static void print_head(const PortRequest *r, Text *out)
{
    Text line = {0}, part = {0}, frames = {0};

    add_names(&part, &r->of);
    add_names(&frames, &r->frames);
    text_addf(&line,
              r->is_norton ? "F = F0 - L a: F acts from %s on what is attached at %s"
                           : "a = a0 + Y F: F acts on %s at %s",
              r->is_whole ? "the mechanism" : part.at, frames.at);
    view_comment(out, r->view, line.at);
    print_names(r, "F: ", &r->forces, out);
    print_names(r, "a: ", &r->accelerations, out);
    text_free(&line);
    text_free(&part);
    text_free(&frames);
}

/* what F0 or a0 contains of the motion and the voltages of the rest */
static void print_given(const PortRequest *r, const Expr *roots, int count, Text *out)
{
    Words names = {0};
    Expr *symbols = NULL;
    const int all = expr_symbols(roots, count, &symbols);

    for (int i = 0; i < all; i++)
        if (expr_symbol_kind(symbols[i]) == SYMBOL_VARIABLE)
            LIST_PUSH(names, expr_name(symbols[i]));
    if (names.count > 0)
        print_names(r, "given by the rest of the model: ", &names, out);
    LIST_FREE(names);
    mem_free(symbols);
}

static void print_count(const PortRequest *r, const Expr *roots, int count, Text *out)
{
    const OpCount ops = expr_count(roots, count), shared = expr_count_shared(roots, count);
    Text line = {0};

    text_addf(&line,
              "%lld additions, %lld multiplications, %lld functions; after sharing %lld, %lld, "
              "%lld",
              (long long)ops.add, (long long)ops.mul, (long long)ops.fun, (long long)shared.add,
              (long long)shared.mul, (long long)shared.fun);
    view_comment(out, r->view, line.at);
    text_free(&line);
}

/* entries of the vector, then of the matrix */
static void print_entries(const PortRequest *r, const Expr *constant, const Expr *matrix, Text *out)
{
    const int count = r->accelerations.count;
    EquationList equations = {0};

    for (int i = 0; i < count; i++)
        view_value(&equations,
                   view_entry_name(r->view, r->is_norton ? "F0" : "a0",
                                   r->is_norton ? "F^0" : "a^0", i, -1),
                   constant[i]);
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++)
            if (!expr_is_zero(matrix[i * count + j]) || count == 1)
                view_value(&equations,
                           view_entry_name(r->view, r->is_norton ? "L" : "Y",
                                           r->is_norton ? "L" : "Y", i, j),
                           matrix[i * count + j]);
    view_block(out, r->view, &equations);
}

static Status print_symbols(PortRequest *r, const Selection *selection, PortEquations *port,
                            Text *out, Diag *diag)
{
    const int count = r->accelerations.count;
    Expr *all = NEW_ARRAY(Expr, count + count * count);
    PortFault fault = {.unknown = NULL};
    Text line = {0};
    Status status;

    if (port->nonlinear != NULL && selection->networks == NETWORKS_ELIMINATED) {
        status =
            diag_set(diag, E_MODEL, "the law of %s isn't linear: its network can't be eliminated",
                     port->nonlinear);
        diag_hint(diag, "'networks=kept' leaves the network's unknowns in F0");
        goto done;
    }
    status = port_symbols(port, all, all + count, &fault);
    if (status == E_SINGULAR) {
        PortEquations dual = *port;
        PortFault ignored;

        dual.options.is_norton = !dual.options.is_norton;
        status = no_port(r, &fault, port_symbols(&dual, all, all + count, &ignored) == OK, diag);
    }
    CHECK(status);
    for (int i = 0; i < count + count * count; i++)
        all[i] =
            system_plain(r->system, model_extracted(model_arena(r->view->model), &r->ends, all[i]));
    print_head(r, out);
    print_given(r, all, count + count * count, out);
    if (port->nonlinear != NULL) {
        text_addf(&line, "the law of %s isn't linear: unknowns of its network remain",
                  port->nonlinear);
        view_comment(out, r->view, line.at);
    }
    print_entries(r, all, all + count, out);
    print_count(r, all, count + count * count, out);
done:
    text_free(&line);
    mem_free(all);
    return status;
}

/* --- numbers --- */

typedef struct PortValues {
    Expr *symbols;
    double *values;
    int count;
} PortValues;

static double known_value(void *context, Expr symbol)
{
    const PortValues *known = context;

    for (int i = 0; i < known->count; i++)
        if (known->symbols[i] == symbol)
            return known->values[i];
    return 0;
}

/* the number i of a source's parameter, and which of its rates; false: it is none */
static bool source_parameter(const char *name, int *terminal, int *rate)
{
    static const char start[] = "port__value";
    const char *at = name + sizeof start - 1;

    if (strncmp(name, start, sizeof start - 1) != 0)
        return false;
    *terminal = *rate = 0;
    for (; *at >= '0' && *at <= '9'; at++)
        *terminal = 10 * *terminal + (*at - '0');
    *rate = at[0] == '_' ? at[1] - '0' : 0;
    return true;
}

/* a variable of the model at the instant */
static Status read_variable(const PortRequest *r, const char *name, double *out, Diag *diag)
{
    const ViewInstant *instant = r->view->instant;
    const Expr item = expr_symbol(model_arena(r->view->model), name, SYMBOL_VARIABLE);

    return instant->read(instant->context, &item, 1, out, diag);
}

static Status read_value(const PortRequest *r, Expr symbol, double *out, Diag *diag)
{
    const char *name = expr_name(symbol);
    int terminal, rate;

    if (source_parameter(name, &terminal, &rate)) {
        const ExtractedTerminal *t = &r->ends.terminals.at[terminal];
        Text text = {0};
        Status status;

        /* its rates are needed only where a capacitor is parallel to it */
        text_addf(&text, "%s.%s%.*s", t->node, domain_across(t->domain), rate, "''");
        status = read_variable(r, text.at, out, diag);
        text_free(&text);
        return status;
    }
    if (expr_symbol_kind(symbol) == SYMBOL_TIME || strcmp(name, EXTRACT_TIME) == 0) {
        *out = r->view->instant->time;
        return OK;
    }
    if (expr_symbol_kind(symbol) == SYMBOL_PARAMETER) {
        *out = model_parameter_value(r->view->model, symbol);
        return OK;
    }
    return read_variable(r, name, out, diag);
}

static Expr number_shown(const PortRequest *r, double value)
{
    Arena *arena = model_arena(r->view->model);
    Text text = {0};
    Expr e;

    if (view_kind(r->view) != NOTATION_READ && view_kind(r->view) != NOTATION_TYPESET)
        return expr_real(arena, value);
    text_addf(&text, "%.*g", SHOWN_DIGITS, fabs(value));
    e = expr_decimal(arena, text.at);
    text_free(&text);
    return value < 0 ? expr_neg(arena, e) : e;
}

/* An entry without what rounding leaves of 0; terms of the vector have a size of about 1. */
static double cleaned(double value, double most, bool is_constant)
{
    static const double roundings = 1e-13;

    return fabs(value) <= roundings * (is_constant ? fmax(most, 1) : most) ? 0 : value;
}

static Status print_numbers(PortRequest *r, PortEquations *port, Text *out, Diag *diag)
{
    const int count = r->accelerations.count, all = count + count * count;
    double *numbers = NEW_ARRAY(double, all);
    Expr *shown = NEW_ARRAY(Expr, all);
    PortValues known = {.count = 0};
    PortFault fault = {.unknown = NULL};
    double most[2] = {0, 0};
    Status status = OK;

    known.count = port_symbols_of(port, &known.symbols);
    known.values = NEW_ARRAY(double, known.count + 1);
    for (int i = 0; i < known.count; i++)
        CHECK(read_value(r, known.symbols[i], &known.values[i], diag));
    status = port_numbers(port, known_value, &known, numbers, numbers + count, &fault);
    if (status == E_VALUE)
        (void)diag_set(diag, E_VALUE, "the equations of the part have no finite numbers there");
    if (status == E_SINGULAR) {
        PortEquations dual = *port;
        PortFault ignored;

        dual.options.is_norton = !dual.options.is_norton;
        status = no_port(
            r, &fault,
            port_numbers(&dual, known_value, &known, numbers, numbers + count, &ignored) == OK,
            diag);
    }
    CHECK(status);
    for (int i = 0; i < all; i++)
        most[i >= count] = fmax(most[i >= count], fabs(numbers[i]));
    for (int i = 0; i < all; i++)
        shown[i] = number_shown(r, cleaned(numbers[i], most[i >= count], i < count));
    print_head(r, out);
    print_entries(r, shown, shown + count, out);
done:
    MEM_FREE(known.symbols, known.values, numbers, shown);
    return status;
}

/* --- the topics --- */

static void request_free(PortRequest *r)
{
    system_free(r->system);
    scene_free(&r->scene);
    model_free(r->part);
    LIST_FREE(r->frames);
    LIST_FREE(r->frame_places);
    LIST_FREE(r->accelerations);
    LIST_FREE(r->forces);
    LIST_FREE(r->of);
    LIST_FREE(r->of_places);
    LIST_FREE(r->given);
    LIST_FREE(r->ends.frames);
    LIST_FREE(r->ends.terminals);
    pool_free(r->pool);
}

Status show_port(const View *view, const Selection *selection, bool is_norton, Text *out,
                 Diag *diag)
{
    PortRequest r = {.view = view, .is_norton = is_norton, .pool = pool_new(0)};
    PortEquations *port = NULL;
    PortOptions options;
    Status status = OK;

    CHECK(read_items(&r, selection, diag));
    CHECK(read_of(&r, selection, diag));
    CHECK(make_part(&r, diag));
    CHECK(refuse_sides(&r, diag));
    find_given(&r);
    options = (PortOptions){.components = r.accelerations.at,
                            .count = r.accelerations.count,
                            .given = r.given.at,
                            .given_count = r.given.count,
                            .is_norton = is_norton,
                            .is_numeric = selection->at != NULL,
                            .keeps_networks = selection->networks == NETWORKS_KEPT,
                            .watch = view->watch};
    CHECK(port_new(r.system, &options, &port, diag));
    status = selection->at != NULL ? print_numbers(&r, port, out, diag)
                                   : print_symbols(&r, selection, port, out, diag);
done:
    port_free(port);
    request_free(&r);
    return status;
}
