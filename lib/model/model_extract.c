/* model_extract.c: a part of a model by itself
 *
 * The lines of the part are applied to an empty state. Frames of other bodies at which it is
 * attached become massless bodies, so that the part moves with them; terminals that it shares with
 * the rest become sources. */
#include "language/verbs.h"
#include "model/model_impl.h"

#include <stdio.h>
#include <string.h>

typedef struct Extraction {
    const State *old;
    const Extract *part;
    bool *keeps;      /* by part: its line belongs to the part of the model */
    bool *carries;    /* by part: a body of the rest to which frames of the part are fixed */
    int *made_by;     /* by node: the body or arm whose frame it is; -1 */
    int *line;        /* by part: the line that makes it; one inside an instance: -1 */
    bool *touches;    /* by node: an edge of the part is attached to it */
    NameList loose;   /* frames inside instances of the rest */
    bool is_isolated; /* state_isolate(): a kept instance gets ports of its own */
    ExtractedEnds *ends;
} Extraction;

static bool is_kept_use(const Extraction *x, const char *name)
{
    for (int i = 0; i < x->part->count; i++)
        if (strcmp(x->part->names[i], name) == 0)
            return true;
    return false;
}

static bool is_datum_node(const Extraction *x, int node)
{
    return graph_node(x->old->graph, node)->datum;
}

static bool is_arm(const Instance *part)
{
    return part->row->family == FAMILY_ARM;
}

/* a frame of a rigid body or arm that a line of its own makes */
static bool has_own_line(const Extraction *x, int part)
{
    return x->line[part] >= 0;
}

static void find_makers(Extraction *x)
{
    const State *old = x->old;

    for (int n = 0; n < graph_node_count(old->graph); n++)
        x->made_by[n] = -1;
    for (int p = 0; p < old->parts.count; p++) {
        const Instance *part = old->parts.at[p];

        x->line[p] = -1;
        if ((part->row->family == FAMILY_BODY || is_arm(part)) && part->head >= 0)
            x->made_by[part->head] = p;
    }
    for (int i = 0; i < old->lines.count; i++) {
        const Line *line = &old->lines.at[i];

        if (line->part >= 0 && line->key == NULL && line->inside < 0 && !line->is_gone)
            x->line[line->part] = i;
    }
}

/* the parts that are named, in named instances, and arms on these and on ground */
static void find_kept(Extraction *x)
{
    const State *old = x->old;

    for (int p = 0; p < old->parts.count; p++) {
        const Instance *part = old->parts.at[p];
        const int maker = is_arm(part) ? x->made_by[part->tail] : -1;

        for (int i = 0; i < x->part->count && !x->keeps[p]; i++)
            x->keeps[p] = strcmp(part->name, x->part->names[i]) == 0 ||
                          name_is_inside(part->name, x->part->names[i]);
        if (is_arm(part) && has_own_line(x, p))
            x->keeps[p] =
                x->keeps[p] || (maker >= 0 && x->keeps[maker]) || is_datum_node(x, part->tail);
    }
}

/* the frame of another body at which the part is attached: that body moves with it, without mass */
static void attach(Extraction *x, int node)
{
    int maker = x->made_by[node];

    if (is_datum_node(x, node) || maker < 0 || x->keeps[maker])
        return;
    while (is_arm(x->old->parts.at[maker]) && has_own_line(x, maker) &&
           x->made_by[x->old->parts.at[maker]->tail] >= 0)
        maker = x->made_by[x->old->parts.at[maker]->tail];
    if (!has_own_line(x, maker) || is_arm(x->old->parts.at[maker]) ||
        instance_bends(x->old->parts.at[maker])) {
        name_list_add(&x->loose, graph_node(x->old->graph, node)->name);
        return;
    }
    x->carries[maker] = true;
    for (int at = x->made_by[node]; at != maker; at = x->made_by[x->old->parts.at[at]->tail])
        x->keeps[at] = true;
}

static void find_frames(Extraction *x)
{
    const State *old = x->old;

    for (int p = 0; p < old->parts.count; p++) {
        const Instance *part = old->parts.at[p];
        const int ends[] = {part->tail, part->head};

        for (int k = 0; k < COUNT(ends) && x->keeps[p]; k++)
            if (ends[k] >= 0 && graph_node(old->graph, ends[k])->domain == DOMAIN_MECHANICAL)
                x->touches[ends[k]] = true;
    }
    for (int n = 0; n < graph_node_count(old->graph); n++)
        if (x->touches[n] && graph_node(old->graph, n)->domain == DOMAIN_MECHANICAL)
            attach(x, n);
}

/* --- names --- */

static Status check_names(const Extraction *x, Diag *diag)
{
    for (int i = 0; i < x->part->count; i++) {
        const char *name = x->part->names[i];
        const int around = state_use_around(x->old, name);

        if (state_use(x->old, name) != NULL && around < 0)
            continue;
        if (around >= 0) {
            int outer = around;

            while (x->old->uses.at[outer].outer >= 0)
                outer = x->old->uses.at[outer].outer;
            (void)diag_at(diag, E_MODEL, x->part->places[i],
                          "'%s' is inside %s, which belongs to a part of a model as a whole", name,
                          x->old->uses.at[outer].name);
            diag_hint(diag, "name %s", x->old->uses.at[outer].name);
            return E_MODEL;
        }
        if (state_part(x->old, name) == NULL)
            return name_unknown(x->old, "component or instance", name, x->part->places[i], diag);
    }
    return OK;
}

/* a requested frame has to be one of the part, or one to which it is attached */
static Status check_frames(const Extraction *x, Diag *diag)
{
    for (int i = 0; i < x->part->frame_count; i++) {
        const int node = graph_find_node(x->old->graph, x->part->frames[i]);
        const int maker = node >= 0 ? x->made_by[node] : -1;

        if (node >= 0 && (x->touches[node] || (maker >= 0 && x->keeps[maker])))
            continue;
        (void)diag_at(diag, E_MODEL, x->part->frame_places[i],
                      "nothing of the part that is named is attached to '%s'", x->part->frames[i]);
        diag_hint(diag, "name after 'of' what is attached there; 'info %s' shows its edges",
                  x->part->frames[i]);
        return E_MODEL;
    }
    return OK;
}

/* --- lines --- */

/* a body without mass; its name may be that of a frame inside an instance */
static Status add_massless(const Extraction *x, State **state, const char *name, Diag *diag)
{
    Statement *statement = NULL;
    Syntax named;
    Operand operand;
    Outcome outcome = {0};
    Status status = OK;

    CHECK(statement_parse(x->old->setup.planar ? "body port__body mass=0 inertia=0"
                                               : "body port__body mass=0 inertia=[0, 0, 0]",
                          1, (SyntaxOptions){false}, NULL, &statement, diag));
    named = *statement->operands.at[0].value;
    named.text = name;
    operand = statement->operands.at[0];
    operand.value = &named;
    statement->operands.at[0] = operand;
    (*state)->is_open = true;
    status = state_apply(state, statement, &outcome, diag);
done:
    text_free(&outcome.remarks);
    statement_free(statement);
    return status;
}

static Status apply_kept(State **state, const char *name, const char *text, Diag *diag)
{
    Diag inner = {0};
    const Status status = state_apply_text(state, text, &inner);

    if (status == OK || status == E_MEMORY || status == E_STOPPED) {
        if (status != OK)
            *diag = inner;
        return status;
    }
    (void)diag_set(diag, E_MODEL, "'%s' needs something outside of the part: %s", name,
                   inner.message);
    diag_hint(diag, "name after 'of' what it needs too");
    return E_MODEL;
}

/* --- sources --- */

const char *model_source_statement(Domain domain, bool is_across)
{
    static const struct {
        const char *through, *across;
    } sources[DOMAIN_COUNT] = {
        [DOMAIN_ELECTRICAL] = {"isource %s %s %s %s", "vsource %s %s %s %s"},
        [DOMAIN_HYDRAULIC] = {"pump %s %s %s flow=%s", "pump %s %s %s pressure=%s"},
        [DOMAIN_SHAFT] = {"torquesource %s %s %s %s", "speedsource %s %s %s %s"},
        [DOMAIN_SLIDE] = {"forcesource %s %s %s %s", "velocitysource %s %s %s %s"},
        [DOMAIN_THERMAL] = {"heatsource %s %s %s %s", "tempsource %s %s %s %s"},
    };

    return is_across ? sources[domain].across : sources[domain].through;
}

/* a source whose value and rates are parameters */
static Status add_source(State **state, ExtractedEnds *ends, const char *node, Domain domain,
                         bool is_across, Diag *diag)
{
    const int number = ends->terminals.count;
    char name[32], value[128];
    Text line = {0};
    Status status = OK;

    if (number == 0)
        TRY(state_apply_text(state, EXTRACT_TIME " = 0", diag));
    for (int k = 0; k < 3; k++) {
        text_addf(&line, EXTRACT_VALUE " = 1", number, k);
        CHECK(state_apply_text(state, line.at, diag));
        text_free(&line);
    }
    (void)snprintf(name, sizeof name, EXTRACT_SOURCE, number);
    (void)snprintf(value, sizeof value,
                   "(" EXTRACT_VALUE " + (t - " EXTRACT_TIME ")*" EXTRACT_VALUE
                   " + (t - " EXTRACT_TIME ")^2*" EXTRACT_VALUE "/2)",
                   number, 0, number, 1, number, 2);
    text_addf(&line, model_source_statement(domain, is_across), name, node, "0", value);
    (*state)->is_open = true;
    CHECK(state_apply_text(state, line.at, diag));
    LIST_PUSH(ends->terminals, ((ExtractedTerminal){node, domain, is_across}));
done:
    text_free(&line);
    return status;
}

/* --- an instance with ports of its own --- */

/* `use` without what it binds */
static void add_use(const Subsystem *subsystem, const char *name, const Statement *use, Text *out)
{
    text_addf(out, "use %s %s", subsystem->name, name);
    for (int i = 0; use != NULL && i < use->pairs.count; i++)
        if (subsystem_port(subsystem, use->pairs.at[i].name) < 0) {
            text_addf(out, " %s=", use->pairs.at[i].name);
            syntax_print(out, use->pairs.at[i].value);
        }
}

/* Motions and voltages that the outside determines are those of massless bodies and of sources,
 * named as the ports; currents are those of sources, too. */
static Status apply_isolated(const Extraction *x, State **state, const Subsystem *subsystem,
                             const char *name, const Statement *use, Diag *diag)
{
    const char **names = NEW_ARRAY(const char *, subsystem->port_count + 1);
    Text text = {0};
    Status status = OK;

    add_use(subsystem, name, use, &text);
    (*state)->is_open = true;
    for (int i = 0; i < subsystem->port_count; i++) {
        const Port *port = &subsystem->ports[i];
        Text full = {0};

        text_addf(&full, "%s.%s", name, port->name);
        names[i] = state_text(*state, full.at);
        text_free(&full);
        if (port->is_through)
            continue;
        text_addf(&text, " %s=%s", port->name, names[i]);
        if (port->is_frame) {
            CHECK(add_massless(x, state, names[i], diag));
            LIST_PUSH(x->ends->frames, names[i]);
        }
    }
    CHECK(apply_kept(state, name, text.at, diag));
    for (int i = 0; i < subsystem->port_count; i++) {
        const int node = graph_find_node((*state)->graph, names[i]);
        const Domain domain =
            node >= 0 ? graph_node((*state)->graph, node)->domain : DOMAIN_ELECTRICAL;

        if (!subsystem->ports[i].is_frame)
            CHECK(add_source(state, x->ends, names[i], domain, !subsystem->ports[i].is_through,
                             diag));
    }
done:
    text_free(&text);
    mem_free(names);
    return status;
}

static Status apply_use_line(const Extraction *x, State **state, const Line *line, Diag *diag)
{
    const Use *use = &x->old->uses.at[line->use];
    Statement *statement = NULL;
    Status status = OK;

    if (!is_kept_use(x, use->name))
        return OK;
    if (!x->is_isolated)
        return apply_kept(state, use->name, line->text, diag);
    CHECK(statement_parse(line->text, 1, (SyntaxOptions){false}, NULL, &statement, diag));
    CHECK(apply_isolated(x, state, use->subsystem, use->name, statement, diag));
done:
    statement_free(statement);
    return status;
}

static bool sets_in_rest(const Extraction *x, const Line *line)
{
    const int around = line->key != NULL ? state_use_around(x->old, line->key) : -1;
    int outer = around;

    while (outer >= 0 && x->old->uses.at[outer].outer >= 0)
        outer = x->old->uses.at[outer].outer;
    return outer >= 0 && !is_kept_use(x, x->old->uses.at[outer].name);
}

static Status apply_line(const Extraction *x, State **state, const Line *line, Diag *diag)
{
    const State *old = x->old;

    if (line->use >= 0)
        return apply_use_line(x, state, line, diag);
    if (line->part >= 0 && x->carries[line->part] && !x->keeps[line->part])
        return line->key == NULL ? add_massless(x, state, old->parts.at[line->part]->name, diag)
                                 : OK;
    if (line->part >= 0)
        return x->keeps[line->part]
                   ? apply_kept(state, old->parts.at[line->part]->name, line->text, diag)
                   : OK;
    if (sets_in_rest(x, line))
        return OK;
    if (line->definition >= 0) {
        const DefinitionKind kind = old->definitions.at[line->definition].kind;
        Diag ignored = {0};

        if (kind == DEFINES_EVENT)
            return OK;
        if (kind == DEFINES_OUTPUT || kind == DEFINES_LAW) {
            const Status status = state_apply_text(state, line->text, &ignored);

            return status == E_MEMORY || status == E_STOPPED ? status : OK;
        }
    }
    return state_apply_text(state, line->text, diag);
}

/* --- terminals --- */

/* Whether the node has edges of the part and of the rest. */
static bool is_shared(const Extraction *x, int node)
{
    bool inside = false, outside = false;

    for (int p = 0; p < x->old->parts.count; p++)
        for (int k = 0; k < x->old->parts.at[p]->terminal_count; k++)
            if (x->old->parts.at[p]->terminals[k] == node) {
                inside = inside || x->keeps[p];
                outside = outside || !x->keeps[p];
            }
    return inside && outside;
}

static Status add_sources(const Extraction *x, State **state, ExtractedEnds *ends, Diag *diag)
{
    for (int n = 0; n < graph_node_count(x->old->graph); n++) {
        const Node *node = graph_node(x->old->graph, n);

        if (node->domain == DOMAIN_MECHANICAL || node->datum || !is_shared(x, n))
            continue;
        TRY(add_source(state, ends, node->name, node->domain, true, diag));
    }
    return OK;
}

/* --- the whole --- */

/* Choices that leave no tree of the part are forgotten. */
static Status complete_trees(State *state, Diag *diag)
{
    const Tree *trees[TREE_KINDS];
    Diag ignored = {0};

    if (state_trees(state, trees, &ignored) == OK)
        return OK;
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++) {
        state->choices[kind].chosen.count = 0;
        state->choices[kind].excluded.count = 0;
    }
    state_forget_trees(state);
    return state_trees(state, trees, diag);
}

static Status apply_lines(Extraction *x, State **state, ExtractedEnds *ends, Diag *diag)
{
    int count = 0;
    int *order = lines_in_order(x->old, &count);
    bool has_loose = false;
    Status status = OK;

    for (int i = 0; i < count; i++) {
        const Line *line = &x->old->lines.at[order[i]];

        /* before the first part, but after the scene is chosen */
        for (int k = 0; k < x->loose.count && !has_loose && (line->part >= 0 || line->use >= 0);
             k++) {
            CHECK(add_massless(x, state, x->loose.at[k], diag));
            LIST_PUSH(ends->frames, x->loose.at[k]);
        }
        has_loose = has_loose || line->part >= 0 || line->use >= 0;
        CHECK(apply_line(x, state, line, diag));
    }
    for (int p = 0; p < x->old->parts.count; p++)
        if (x->carries[p] && !x->keeps[p])
            LIST_PUSH(ends->frames, x->old->parts.at[p]->name);
    CHECK(add_sources(x, state, ends, diag));
    choices_copy(*state, x->old, NULL);
    CHECK(complete_trees(*state, diag));
done:
    mem_free(order);
    return status;
}

static void extraction_alloc(Extraction *x)
{
    x->keeps = NEW_ARRAY(bool, x->old->parts.count + 1);
    x->carries = NEW_ARRAY(bool, x->old->parts.count + 1);
    x->line = NEW_ARRAY(int, x->old->parts.count + 1);
    x->made_by = NEW_ARRAY(int, graph_node_count(x->old->graph) + 1);
    x->touches = NEW_ARRAY(bool, graph_node_count(x->old->graph) + 1);
}

static void extraction_free(Extraction *x)
{
    LIST_FREE(x->loose);
    MEM_FREE(x->keeps, x->carries, x->line, x->made_by, x->touches);
}

Status state_extract(const State *old, const Extract *part, State **out, ExtractedEnds *ends,
                     Diag *diag)
{
    Extraction x = {.old = old, .part = part};
    State *state = state_new(old->arena, old->overrides, old->apply);
    Status status = OK;

    extraction_alloc(&x);
    CHECK(check_names(&x, diag));
    find_makers(&x);
    find_kept(&x);
    find_frames(&x);
    CHECK(check_frames(&x, diag));
    CHECK(apply_lines(&x, &state, ends, diag));
    state_forget_before(state, 0);
    *out = state;
    state = NULL;
done:
    extraction_free(&x);
    state_free(state);
    return status;
}

/* Edges of the ports are branches, if other choices leave room for that or not. */
static Status choose_ports(State *state, const ExtractedEnds *ends, Diag *diag)
{
    const Tree *trees[TREE_KINDS];
    Diag ignored = {0};

    for (int attempt = 0; attempt < 2; attempt++) {
        for (TreeKind kind = TREE_TRANSLATION; kind <= TREE_ROTATION; kind++) {
            Choice *choice = &state->choices[kind];

            if (attempt > 0)
                choice->chosen.count = choice->excluded.count = 0;
            for (int i = 0; i < ends->frames.count; i++)
                name_list_add(&choice->chosen, ends->frames.at[i]);
        }
        state_forget_trees(state);
        if (state_trees(state, trees, &ignored) == OK)
            return OK;
    }
    return complete_trees(state, diag);
}

Status state_isolate(const State *old, const char *name, State **out, ExtractedEnds *ends,
                     Diag *diag)
{
    const Use *use = state_use(old, name);
    const Subsystem *subsystem =
        use != NULL ? use->subsystem : state_subsystem(old, name, &(int){0});
    const Extract part = {.names = &name, .count = use != NULL};
    Extraction x = {.old = old, .part = &part, .is_isolated = true, .ends = ends};
    State *state = state_new(old->arena, old->overrides, old->apply);
    int count = 0;
    int *order = lines_in_order(old, &count);
    Status status = OK;

    extraction_alloc(&x);
    find_makers(&x);
    for (int i = 0; i < count; i++)
        CHECK(apply_line(&x, &state, &old->lines.at[order[i]], diag));
    if (use == NULL)
        CHECK(apply_isolated(&x, &state, subsystem, EXTRACT_INSTANCE, NULL, diag));
    else
        choices_copy(state, old, NULL);
    CHECK(choose_ports(state, ends, diag));
    state_forget_before(state, 0);
    *out = state;
    state = NULL;
done:
    mem_free(order);
    extraction_free(&x);
    state_free(state);
    return status;
}

Expr model_extracted(Arena *arena, const ExtractedEnds *ends, Expr e)
{
    for (int i = 0; i < ends->terminals.count; i++) {
        const ExtractedTerminal *terminal = &ends->terminals.at[i];
        const char *member = terminal->is_across ? domain_across(terminal->domain)
                                                 : domain_through(terminal->domain);

        for (int k = 0; k < 3; k++) {
            Text from = {0}, to = {0};
            Expr symbols[2], values[2];

            text_addf(&from, EXTRACT_VALUE, i, k);
            text_addf(&to, "%s.%s%.*s", terminal->node, member, k, "''");
            symbols[0] = expr_symbol(arena, from.at, SYMBOL_PARAMETER);
            values[0] = expr_symbol(arena, to.at, SYMBOL_VARIABLE);
            symbols[1] = expr_symbol(arena, EXTRACT_TIME, SYMBOL_PARAMETER);
            values[1] = expr_symbol(arena, "t", SYMBOL_TIME);
            e = expr_substitute(arena, e, symbols, values, COUNT(symbols));
            text_free(&from);
            text_free(&to);
        }
    }
    return e;
}
