/* show.c: the topics of `show`, and their arguments */
#include "present/show.h"

#include "present/fortran_lines.h"
#include "present/info.h"

#include <stdlib.h>
#include <string.h>

/* clang-format off */
static const Topic topics[] = {
    {"graph",        "nodes and edges of the linear graph",                NEED_MODEL,  OPERANDS_NOTHING, AS_TEXT,     show_graph},
    {"nodes",        "frames and terminals",                               NEED_MODEL,  OPERANDS_NOTHING, AS_TEXT,     show_nodes},
    {"edges",        "edges, their ends, and where they stand in the trees", NEED_MODEL, OPERANDS_EDGES,  AS_TEXT,     show_edges},
    {"tree",         "branches and chords of each tree",                   NEED_MODEL,  OPERANDS_NOTHING, AS_TEXT,     show_tree},
    {"incidence",    "incidence matrix: +1 where an edge starts, -1 where it ends", NEED_MODEL, OPERANDS_EDGES, AS_TEXT,     show_incidence},
    {"circuits",     "fundamental circuits, one a chord",                  NEED_MODEL,  OPERANDS_EDGES,   AS_TEXT,     show_circuits},
    {"cutsets",      "fundamental cutsets, one a branch",                  NEED_MODEL,  OPERANDS_EDGES,   AS_TEXT,     show_cutsets},
    {"coordinates",  "coordinates and network unknowns, in their order",   NEED_SYSTEM, OPERANDS_NOTHING, AS_TEXT,     show_coordinates},
    {"constraints",  "constraint equations; velocity, acceleration: their rates", NEED_SYSTEM, OPERANDS_LEVEL, AS_FORMULAS, show_constraints},
    {"jacobian",     "derivatives of the constraints by the coordinates",  NEED_SYSTEM, OPERANDS_NUMBERS, AS_FORMULAS, show_jacobian},
    {"mass",         "mass matrix M",                                      NEED_SYSTEM, OPERANDS_NUMBERS, AS_FORMULAS, show_mass},
    {"forces",       "right side F of the motion equations",               NEED_SYSTEM, OPERANDS_NUMBERS, AS_FORMULAS, show_forces},
    {"partition",    "dependent and independent coordinates of the embedded form", NEED_SYSTEM, OPERANDS_NOTHING, AS_TEXT, show_partition},
    {"complement",   "J and G, with Phi_q G = 0, of the embedded form",    NEED_SYSTEM, OPERANDS_NUMBERS, AS_FORMULAS, show_complement},
    {"equations",    "all equations, row by row",                          NEED_SYSTEM, OPERANDS_NOTHING, AS_FORMULAS, show_equations},
    {"network",      "electrical equations, and those of other scalar domains", NEED_SYSTEM, OPERANDS_NOTHING, AS_FORMULAS, show_network},
    {"outputs",      "outputs and their expressions",                      NEED_MODEL,  OPERANDS_NOTHING, AS_FORMULAS, show_outputs},
    {"params",       "parameters and their values",                        NEED_MODEL,  OPERANDS_NOTHING, AS_TEXT,     show_params},
    {"structure",    "sizes, instances, where M and the jacobian are not zero",  NEED_RUNNING, OPERANDS_NOTHING, AS_TEXT,     show_structure},
    {"sides",        "what stuck and slipped in the last run, or at an instant", NEED_COURSE, OPERANDS_NOTHING, AS_TEXT,     show_sides},
    {"run",          "report of the last run",                             NEED_RUN,    OPERANDS_NOTHING, AS_TEXT,     show_run},
    {"runs",         "all runs: what ran, from when to when, in how many steps", NEED_MODEL, OPERANDS_NOTHING, AS_TEXT,     show_runs},
    {"sweep",        "runs of the last sweep: parameters, figures, reasons of failures", NEED_MODEL, OPERANDS_NOTHING, AS_TEXT, show_sweep},
    {"statistics",   "mean, deviation and quantiles over the last sweep",  NEED_MODEL,  OPERANDS_NOTHING, AS_TEXT,     show_statistics},
    {"fit",          "parameters of the last fit: values, errors, correlations", NEED_MODEL, OPERANDS_NOTHING, AS_TEXT, show_fit},
    {"optimum",      "parameters of the last optimisation, its figure and constraints", NEED_MODEL, OPERANDS_NOTHING, AS_TEXT, show_optimum},
    {"init",         "initial values and guesses that were given",         NEED_MODEL,  OPERANDS_NOTHING, AS_TEXT,     show_init},
    {"settings",     "how the session computes and prints",                NEED_MODEL,  OPERANDS_NOTHING, AS_TEXT,     show_settings},
    {"program",      "what a run evaluates, what is hoisted, kept, skipped", NEED_RUNNING, OPERANDS_NOTHING, AS_TEXT,     show_program},
    {"state",        "a linear network as x' = A x + B u",                 NEED_MODEL,  OPERANDS_NOTHING, AS_NUMBERS,  show_state},
    {"linear",       "matrices of the last linearisation",                 NEED_LINEAR, OPERANDS_NOTHING, AS_NUMBERS,  show_linear},
    {"transfer",     "transfer functions of the last linearisation",       NEED_LINEAR, OPERANDS_PAIR,    AS_NUMBERS,  show_transfer},
    {"thevenin",     "of a network or a mechanism: source and impedance", NEED_MODEL, OPERANDS_PORTS, AS_FORMULAS, show_thevenin},
    {"norton",       "the same: source and admittance or inertia",         NEED_MODEL,  OPERANDS_PORTS,   AS_FORMULAS, show_norton},
    {"derivation",   "how an equation came about, step by step",           NEED_SYSTEM, OPERANDS_ENTRY,   AS_NARRATIVE,    show_derivation},
    {"power",        "power of each edge, through times across, and their sums", NEED_INSTANT, OPERANDS_NOTHING, AS_TEXT, show_power},
    {"events",       "events, and when they happened in the last run",     NEED_MODEL,  OPERANDS_NOTHING, AS_TEXT,     show_events},
};
/* clang-format on */

/* `show transfer OUT IN`: of a linear network as it is */
static const Topic symbolic_transfer = {"transfer",     "",          NEED_MODEL,
                                        OPERANDS_ITEMS, AS_FORMULAS, show_symbolic_transfer};

/* `show leg`: a definition, or an instance, whose equations have what its ports are bound to */
static const Topic subsystem_topic = {
    "", "", NEED_MODEL, OPERANDS_PART, AS_FORMULAS, show_subsystem};
static const Topic instance_topic = {
    "", "", NEED_SYSTEM, OPERANDS_PART, AS_FORMULAS, show_subsystem};

const Topic *topic_find(const char *name)
{
    for (int i = 0; i < COUNT(topics); i++)
        if (strcmp(topics[i].name, name) == 0)
            return &topics[i];
    return NULL;
}

const Topic *topic_at(int i)
{
    return i >= 0 && i < COUNT(topics) ? &topics[i] : NULL;
}

const char *topic_notation(const Topic *topic, int i)
{
    const unsigned written = topic != NULL ? topic->written : AS_FORMULAS;

    for (Notation n = NOTATION_TEXT; n < NOTATIONS; n++)
        if (notation_row(n)->word != NULL && (written & 1U << n) != 0 && i-- == 0)
            return notation_row(n)->word;
    return NULL;
}

/* whether the last operand is that word */
static bool is_symbolic(const Statement *statement)
{
    const Syntax *last = statement->operands.at[statement->operands.count - 1].value;

    return last->kind == SYNTAX_VARIABLE && last->primes == 0 &&
           strcmp(last->text, "symbolic") == 0;
}

/* whether `show transfer OUT IN` names a pair of the last linearisation */
static bool was_linearized(const Linear *linear, const Statement *statement)
{
    bool has[2] = {false, false};

    for (int k = 0; linear != NULL && k < 2; k++) {
        char *name = view_name(statement->operands.at[1 + k].value);

        for (int i = 0; i < (k == 0 ? linear->outputs : linear->inputs); i++)
            has[k] = has[k] ||
                     strcmp(k == 0 ? linear->output_names[i] : linear->input_names[i], name) == 0;
        mem_free(name);
    }
    return has[0] && has[1];
}

/* Whether a transfer function is requested in the network's own symbols: by the word after it, or
 * because the last linearisation doesn't have its two names. */
static bool in_symbols(const Linear *linear, const Statement *statement)
{
    if (is_symbolic(statement))
        return true;
    for (int i = 1; i < statement->operands.count; i++)
        if (statement->operands.at[i].value->kind == SYNTAX_NUMBER)
            return false;
    return statement->operands.count == 3 && !was_linearized(linear, statement);
}

/* The topic's row, NULL where the first operand is a variable or an expression. */
static const Topic *find_topic(const View *view, const Statement *statement)
{
    const Syntax *first = statement->operands.count > 0 ? statement->operands.at[0].value : NULL;
    const Topic *topic;

    if (first == NULL || first->kind != SYNTAX_VARIABLE || first->primes > 0)
        return NULL;
    topic = topic_find(first->text);
    if (topic != NULL && topic->operands == OPERANDS_PAIR && in_symbols(view->linear, statement))
        return &symbolic_transfer;
    if (topic == NULL && model_find_use(view->model, first->text) != NULL)
        return &instance_topic;
    if (topic == NULL && model_find_subsystem(view->model, first->text) != NULL)
        return &subsystem_topic;
    return topic;
}

/* whether any of what is to be shown is a formula, which equations are needed for */
static bool has_formula(const Model *model, const Statement *statement)
{
    for (int i = 0; i < statement->operands.count; i++) {
        Expr e;
        Diag ignored = {0};

        if (model_expression(model, statement->operands.at[i].value, &e, &ignored) == OK)
            return true;
    }
    return false;
}

/* the word after `as`, one of the topic's; unchanged without `as` */
static Status read_notation(const Statement *statement, const Topic *topic, Notation *out,
                            Diag *diag)
{
    Notation notation;
    const char *word;
    Text words = {0};
    bool is_known;

    if (statement->as == NULL)
        return OK;
    is_known = notation_find(statement->as, &notation);
    if (is_known && (topic == NULL || (topic->written & 1U << notation) != 0)) {
        *out = notation;
        return OK;
    }
    for (int i = 0; (word = topic_notation(topic, i)) != NULL; i++)
        layout_item(&words, word);
    if (is_known) {
        diag_at(diag, E_NAME, statement->as_place, "'show %s' is not written as %s", topic->name,
                statement->as);
        diag_hint(diag, "only as %s", words.at);
    } else {
        diag_at(diag, E_NAME, statement->as_place, "no notation is called '%s'", statement->as);
        diag_hint(diag, "one of %s", words.at);
    }
    text_free(&words);
    return E_NAME;
}

/* what separates "show" from the topic, if that has a name */
static const char *space_before(const Topic *topic)
{
    return topic != NULL && topic->name[0] != '\0' ? " " : "";
}

/* the word `at` belongs to topics of values */
static Status check_at(const Statement *statement, const Topic *topic, Diag *diag)
{
    if (statement->at == NULL ||
        (topic != NULL && (topic->need == NEED_INSTANT || topic->need == NEED_COURSE ||
                           topic->operands == OPERANDS_PORTS)))
        return OK;
    (void)diag_at(diag, E_SYNTAX, statement->at->place, "'show%s%s' shows no values at an instant",
                  space_before(topic), topic != NULL ? topic->name : "");
    diag_hint(diag, "'show power', 'norton' and 'thevenin' do, and 'print' prints values: print "
                    "mass(1,1) at 2");
    return E_SYNTAX;
}

Status show_need(const View *view, const Statement *statement, Need *need, Diag *diag)
{
    const Topic *topic = find_topic(view, statement);
    Notation ignored;

    TRY(read_notation(statement, topic, &ignored, diag));
    if (statement->operands.count == 0) {
        diag_at(diag, E_SYNTAX, statement->verb_place, "'show' needs a topic");
        diag_hint(diag, "show graph, tree, coordinates, constraints, mass, forces, equations ...; "
                        "'help show' lists them");
        return E_SYNTAX;
    }
    TRY(check_at(statement, topic, diag));
    if (topic != NULL && topic->need == NEED_COURSE)
        *need = statement->at != NULL ? NEED_INSTANT : NEED_RUN;
    else if (topic != NULL)
        *need = topic->need;
    else
        *need = has_formula(view->model, statement) ? NEED_SYSTEM : NEED_MODEL;
    return OK;
}

static Status has_room(const Topic *topic, const Operand *operand, const Selection *selection,
                       Diag *diag)
{
    if (selection->number_count < COUNT(selection->numbers))
        return OK;
    return diag_at(diag, E_SYNTAX, operand->place,
                   topic->operands == OPERANDS_PAIR
                       ? "a transfer function has an output and an input only"
                       : "an entry has a row and a column only");
}

static Status take_number(const Topic *topic, const Operand *operand, Selection *selection,
                          Diag *diag)
{
    const Syntax *value = operand->value;
    char *end = NULL;
    const long number = strtol(value->text, &end, 10);

    if (topic->operands != OPERANDS_NUMBERS && topic->operands != OPERANDS_LEVEL &&
        topic->operands != OPERANDS_PAIR)
        return diag_at(diag, E_SYNTAX, operand->place, "'show %s' takes no numbers", topic->name);
    if (*end != '\0' || number < 1 || number > 1000000 || value->has_unit)
        return diag_at(diag, E_VALUE, operand->place, "rows and columns are counted 1, 2, 3 ...");
    TRY(has_room(topic, operand, selection, diag));
    selection->numbers[selection->number_count++] = (int)number;
    return OK;
}

/* the output, then the input of that name */
static Status take_output_or_input(const View *view, const Topic *topic, const Operand *operand,
                                   Selection *selection, Diag *diag)
{
    const Linear *linear = view->linear;
    const bool is_output = selection->number_count == 0;
    const char *what = is_output ? "output" : "input";
    char *const *names;
    char *name = view_name(operand->value);
    Suggest suggest = suggest_for(name);
    int found = 0;
    Status status = OK;

    CHECK(linear_check_pairs(linear, diag));
    CHECK(has_room(topic, operand, selection, diag));
    names = is_output ? linear->output_names : linear->input_names;
    for (int i = 0; i < (is_output ? linear->outputs : linear->inputs); i++) {
        suggest_offer(&suggest, names[i]);
        if (strcmp(names[i], name) == 0)
            found = i + 1;
    }
    if (found == 0) {
        status = diag_at(diag, E_NAME, operand->place, "%s is no %s of the last linearisation",
                         name, what);
        suggest_or_hint(&suggest, diag,
                        "'show transfer' takes an output, then an input: show transfer %s %s",
                        linear->output_names[0], linear->input_names[0]);
        goto done;
    }
    selection->numbers[selection->number_count++] = found;
done:
    mem_free(name);
    return status;
}

/* one of two; the word `symbolic` after them has selected the topic */
static Status take_item(const Topic *topic, const Statement *statement, int operand,
                        Selection *selection, Diag *diag)
{
    const int at = operand - 1;

    if (topic == &symbolic_transfer && operand == statement->operands.count - 1 &&
        is_symbolic(statement))
        return OK;
    if (at >= COUNT(selection->items))
        return diag_at(diag, E_SYNTAX, statement->operands.at[operand].place,
                       "'show %s' takes two names", topic->name);
    selection->items[at] = statement->operands.at[operand].value;
    return OK;
}

/* frames or terminals, then those of the part after `of` */
static void take_port(const Operand *operand, const Syntax **items, Selection *selection)
{
    const Syntax *value = operand->value;
    const int at = selection->port_count + selection->of_count;

    if (!selection->has_of && selection->port_count > 0 && value->kind == SYNTAX_VARIABLE &&
        value->primes == 0 && strcmp(value->text, "of") == 0) {
        selection->has_of = true;
        selection->of = items + at;
        return;
    }
    items[at] = value;
    *(selection->has_of ? &selection->of_count : &selection->port_count) += 1;
}

/* internal or ports, of a subsystem `name` */
static Status take_part(const char *name, const Operand *operand, Selection *selection, Diag *diag)
{
    const Syntax *value = operand->value;

    if (selection->part == NULL && value->kind == SYNTAX_VARIABLE && value->primes == 0 &&
        (strcmp(value->text, "internal") == 0 || strcmp(value->text, "ports") == 0)) {
        selection->part = value->text;
        return OK;
    }
    return diag_at(diag, E_SYNTAX, operand->place, "'show %s' may be followed by internal or ports",
                   name);
}

/* networks=kept|eliminated, of what has ports */
static Status read_keys(const Topic *topic, const Statement *statement, Selection *selection,
                        Diag *diag)
{
    for (int i = 0; i < statement->pairs.count; i++) {
        const Pair *pair = &statement->pairs.at[i];
        const char *word = pair->value->kind == SYNTAX_VARIABLE ? pair->value->text : "";

        if (topic == NULL || topic->operands != OPERANDS_PORTS) {
            (void)diag_at(diag, E_SYNTAX, pair->name_place, "'show%s%s' takes no keys",
                          space_before(topic), topic != NULL ? topic->name : "");
            diag_hint(diag, "'%s=' goes with 'show norton' and 'show thevenin'", pair->name);
            return E_SYNTAX;
        }
        if (strcmp(word, "kept") != 0 && strcmp(word, "eliminated") != 0) {
            (void)diag_at(diag, E_VALUE, pair->value->place, "networks are kept or eliminated");
            diag_hint(diag, "networks=kept leaves their unknowns in F0");
            return E_VALUE;
        }
        selection->networks = word[0] == 'k' ? NETWORKS_KEPT : NETWORKS_ELIMINATED;
    }
    selection->at = statement->at;
    return OK;
}

static Status take_name(const View *view, const Topic *topic, const Operand *operand,
                        Selection *selection, const char **names, Diag *diag)
{
    const char *name = operand->value->text;
    Suggest suggest = suggest_for(name);

    if (topic->operands == OPERANDS_LEVEL && selection->level == NULL &&
        (strcmp(name, "velocity") == 0 || strcmp(name, "acceleration") == 0)) {
        selection->level = name;
        return OK;
    }
    if (topic->operands == OPERANDS_LEVEL)
        return diag_at(diag, E_SYNTAX, operand->place,
                       "'show constraints' may be followed by velocity or acceleration and a row");
    if (topic->operands != OPERANDS_EDGES)
        return diag_at(diag, E_SYNTAX, operand->place, "'show %s' takes no names", topic->name);
    if (strcmp(name, "open") == 0) {
        selection->is_open = true;
        return OK;
    }
    if (graph_find_edge(model_graph(view->model), name) < 0) {
        for (int i = 0; i < graph_edge_count(model_graph(view->model)); i++)
            suggest_offer(&suggest, graph_edge(model_graph(view->model), i)->name);
        diag_at(diag, E_NAME, operand->place, "no edge is called '%s'", name);
        suggest_or_hint(&suggest, diag, "'show edges' lists them");
        return E_NAME;
    }
    names[selection->name_count++] = name;
    return OK;
}

/* `derivation mass 2 3` means `derivation mass(2,3)`: the numbers become arguments */
static bool take_argument(const Operand *operand, Syntax *entry)
{
    if (operand->value->kind != SYNTAX_NUMBER || entry->args == NULL || entry->primes > 0 ||
        entry->has_unit || entry->kind == SYNTAX_NUMBER)
        return false;
    entry->kind = SYNTAX_CALL;
    entry->args[entry->count++] = operand->value;
    return true;
}

static Status show_topic(const View *view, const Topic *topic, const Statement *statement,
                         Text *out, Diag *diag)
{
    const char **names = NEW_ARRAY(const char *, statement->operands.count);
    Syntax **args = NEW_ARRAY(Syntax *, statement->operands.count);
    Syntax entry = {.kind = SYNTAX_NUMBER};
    const Syntax **ports = NEW_ARRAY(const Syntax *, statement->operands.count);
    Selection selection = {.names = names, .ports = ports};
    Status status = OK;

    CHECK(read_keys(topic, statement, &selection, diag));
    if (topic->operands == OPERANDS_PART)
        selection.item = statement->operands.at[0].value;
    for (int i = 1; i < statement->operands.count; i++) {
        const Operand *operand = statement->operands.at + i;

        if (topic->operands == OPERANDS_PART) {
            CHECK(take_part(statement->operands.at[0].value->text, operand, &selection, diag));
        } else if (topic->operands == OPERANDS_ENTRY && selection.item == NULL) {
            selection.item = operand->value;
            entry = *operand->value;
            entry.args = entry.count == 0 ? args : NULL;
        } else if (topic->operands == OPERANDS_ENTRY && take_argument(operand, &entry)) {
            selection.item = &entry;
        } else if (topic->operands == OPERANDS_ENTRY) {
            status = diag_at(diag, E_SYNTAX, operand->place,
                             "'show %s' shows one name, row or entry at a time", topic->name);
            goto done;
        } else if (topic->operands == OPERANDS_PORTS) {
            take_port(operand, ports, &selection);
        } else if (topic->operands == OPERANDS_ITEMS) {
            CHECK(take_item(topic, statement, i, &selection, diag));
        } else if (operand->value->kind == SYNTAX_NUMBER) {
            CHECK(take_number(topic, operand, &selection, diag));
        } else if (topic->operands == OPERANDS_PAIR) {
            CHECK(take_output_or_input(view, topic, operand, &selection, diag));
        } else if (operand->value->kind == SYNTAX_VARIABLE && operand->value->primes == 0) {
            CHECK(take_name(view, topic, operand, &selection, names, diag));
        } else {
            status = diag_at(diag, E_SYNTAX, operand->place, "expected a %s behind '%s'",
                             topic->operands == OPERANDS_EDGES ? "name" : "number", topic->name);
            goto done;
        }
    }
    status = topic->show(view, &selection, out, diag);
    if (status != OK && diag->place.line == 0)
        diag->place = statement->at != NULL && topic->need == NEED_INSTANT
                          ? statement->at->place
                          : statement->operands.at[statement->operands.count > 1 ? 1 : 0].place;
done:
    MEM_FREE(names, args, ports);
    return status;
}

/* a word that is neither topic nor variable was probably meant as a topic */
static Status unknown_topic(const Operand *operand, Status status, Diag *diag)
{
    Suggest suggest = suggest_for(operand->value->text);

    for (int i = 0; i < COUNT(topics); i++)
        suggest_offer(&suggest, topics[i].name);
    if (status == E_NAME && suggest.best != NULL && operand->value->kind == SYNTAX_VARIABLE) {
        diag_at(diag, E_NAME, operand->place, "nothing to show is called '%s'",
                operand->value->text);
        diag_hint(diag, "did you mean 'show %s'?", suggest.best);
    }
    return status;
}

/* A name without a formula, or whose formula is itself: a part, a frame, a parameter, an
 * independent coordinate. */
static bool is_mere_name(const View *view, const Syntax *syntax)
{
    Expr user, e;
    Diag ignored = {0};

    if (syntax->kind != SYNTAX_VARIABLE || syntax->primes > 0)
        return false;
    return model_expression(view->model, syntax, &user, &ignored) != OK ||
           (system_resolve(view->system, user, &e, &ignored) == OK && expr_kind(e) == EXPR_SYMBOL &&
            strcmp(expr_name(e), syntax->text) == 0);
}

static Status show_item(const View *view, const Statement *statement, int item, Text *out,
                        Diag *diag)
{
    const Operand *operand = statement->operands.at + item;
    const int number = statement->operands.count > 1 ? item + 1 : 0;
    Diag ignored = {0};

    if (statement->as == NULL && is_mere_name(view, operand->value) &&
        info_print(view, operand->value->text, operand->place, out, &ignored) == OK)
        return OK;
    return show_expression(view, operand->value, number, out, diag);
}

static Status show_operands(const View *view, const Topic *topic, const Statement *statement,
                            Text *out, Diag *diag)
{
    Status status = OK;

    Selection none = {.at = NULL};

    if (topic != NULL)
        return show_topic(view, topic, statement, out, diag);
    TRY(read_keys(NULL, statement, &none, diag));
    for (int i = 0; status == OK && i < statement->operands.count; i++) {
        const Operand *operand = statement->operands.at + i;

        status = show_item(view, statement, i, out, diag);
        if (status != OK && diag->place.line == 0)
            diag->place = operand->place;
        if (status != OK && i == 0)
            status = unknown_topic(operand, status, diag);
    }
    return status;
}

Status show(const View *view, const Statement *statement, Text *out, Diag *diag)
{
    View in_notation = *view;
    const Topic *topic = find_topic(view, statement);
    const size_t from = out->length;

    TRY(read_notation(statement, topic, &in_notation.page.notation, diag));
    TRY(show_operands(&in_notation, topic, statement, out, diag));
    if (in_notation.page.notation == NOTATION_FORTRAN)
        fortran_wrap(out, from);
    return OK;
}
