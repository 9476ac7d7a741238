/* complete_names.c: words that completion offers, from the tables and from the model's names */
#include "language/functions.h"
#include "present/complete_impl.h"
#include "present/count.h"
#include "present/show.h"
#include "simulate/run/run.h"

#include <stdio.h>
#include <string.h>

void offer_verbs(TypedLine *line)
{
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++)
        offer(line, verb.name);
}

void offer_joint_types(TypedLine *line)
{
    for (int i = 0; component_at(i) != NULL; i++)
        if (component_at(i)->family == FAMILY_JOINT)
            offer(line, component_at(i)->name);
}

static void offer_nodes(TypedLine *line, bool mechanical)
{
    const Graph *graph = model_graph(line->known->model);

    for (int n = 0; n < graph_node_count(graph); n++)
        if ((graph_node(graph, n)->domain == DOMAIN_MECHANICAL) == mechanical)
            offer(line, graph_node(graph, n)->name);
    offer(line, mechanical ? "ground" : "0");
}

static void offer_frames(TypedLine *line)
{
    offer_nodes(line, true);
}

static void offer_terminals(TypedLine *line)
{
    offer_nodes(line, false);
}

static void offer_edges(TypedLine *line)
{
    const Graph *graph = model_graph(line->known->model);

    for (int e = 0; e < graph_edge_count(graph); e++)
        offer(line, graph_edge(graph, e)->name);
}

/* what `circuit` and `cutset` light */
static void offer_lit(TypedLine *line)
{
    if (line->before.count == 2 && strcmp(line->before.at[1], "mechanism") != 0)
        offer_edges(line);
}

static void offer_joints(TypedLine *line)
{
    for (int i = 0; i < model_count(line->known->model); i++)
        if (model_instance(line->known->model, i)->row->family == FAMILY_JOINT)
            offer(line, model_instance(line->known->model, i)->name);
}

void offer_coordinates(TypedLine *line)
{
    for (int i = 0; i < model_count(line->known->model); i++) {
        const Instance *instance = model_instance(line->known->model, i);

        for (int c = 0; c < instance->coord_count; c++)
            offer(line, instance->coord[c]);
    }
}

static void offer_instances(TypedLine *line)
{
    for (int i = 0; i < model_count(line->known->model); i++)
        offer(line, model_instance(line->known->model, i)->name);
}

static void offer_events(TypedLine *line)
{
    for (int i = 0; i < model_event_count(line->known->model); i++)
        offer(line, model_event(line->known->model, i)->name);
}

/* named elements that can be removed; the contents of an instance are removed with it */
static void offer_removable(TypedLine *line)
{
    const Model *model = line->known->model;
    const char *name;

    for (int i = 0; (name = model_name(model, i)) != NULL; i++)
        if (strchr(name, '.') == NULL && model_can_go(model, name))
            offer(line, name);
}

/* after `use`: the definitions; then the keys of one */
static void offer_subsystems(TypedLine *line)
{
    const Model *model = line->known->model;
    const char *key;

    for (int i = 0; line->before.count == 1 && i < model_subsystem_count(model); i++)
        offer(line, model_subsystem(model, i)->name);
    for (int i = 0; line->before.count > 2 &&
                    (key = model_subsystem_key(model, line->before.at[1], i)) != NULL;
         i++)
        offer_key(line, key);
}

/* after a format: its rows or kinds of code, in addition to the items */
static void offer_exported(TypedLine *line)
{
    static const struct {
        const char *format, *word;
    } all[] = {{"csv", "start"},      {"csv", "modes"},     {"csv", "sweep"},
               {"mat", "start"},      {"mat", "sweep"},     {"json", "start"},
               {"json", "sweep"},     {"c", "inverse"},     {"fortran", "inverse"},
               {"matlab", "inverse"}, {"python", "inverse"}};

    for (int i = 0; line->before.count == 2 && i < COUNT(all); i++)
        if (strcmp(line->before.at[1], all[i].format) == 0)
            offer(line, all[i].word);
}

static bool is_event(const Model *model, const char *name)
{
    for (int i = 0; i < model_event_count(model); i++)
        if (strcmp(model_event(model, i)->name, name) == 0)
            return true;
    return false;
}

/* names in an expression */
void offer_names(TypedLine *line)
{
    const Model *model = line->known->model;
    const char *name;

    for (int i = 0; (name = model_name(model, i)) != NULL; i++)
        if (!is_event(model, name))
            offer(line, name);
    offer_coordinates(line);
}

/* names and words with a text to show */
static void offer_showable(TypedLine *line)
{
    offer_names(line);
    offer_events(line);
}

/* after `event`: existing ones, whose condition can be changed; then variables that may get new
 * values */
static void offer_event(TypedLine *line)
{
    if (line->before.count == 1)
        offer_events(line);
    else
        offer_names(line);
}

static void offer_runs(TypedLine *line)
{
    char name[24];

    for (int i = 0; i < line->known->runs; i++) {
        (void)snprintf(name, sizeof name, "run%d", i + 1);
        offer(line, name);
    }
}

static void offer_functions(TypedLine *line)
{
    char call[40];
    Function row;
    Verb verb;
    /* spectra can be used as columns */
    const bool spectra = verb_find(line->before.at[0], &verb) && strchr("iI", verb.pattern[0]);

    for (int i = 0; function_at(i, &row); i++) {
        (void)snprintf(call, sizeof call, "%s(", row.name);
        if (spectra || strcmp(row.name, "spectrum") != 0)
            offer(line, call);
    }
}

void offer_variables(TypedLine *line)
{
    offer_names(line);
    for (int i = 0; line->prefix[0] != '\0' && whole_name(i) != NULL; i++)
        offer(line, whole_name(i));
}

void offer_values(TypedLine *line)
{
    offer_variables(line);
    /* functions and other words only after a first letter */
    if (line->prefix[0] == '\0')
        return;
    offer(line, "t");
    offer(line, "pi");
    offer_runs(line);
    offer_functions(line);
}

/* variables with initial values: coordinates, and variables whose rates a part has */
static void offer_starts(TypedLine *line)
{
    const Model *model = line->known->model;
    const Member *member;
    Diag ignored = {0};

    offer_coordinates(line);
    for (int i = 0; i < model_count(model); i++) {
        const Instance *instance = model_instance(model, i);

        for (int k = 0; instance->row->family >= FAMILY_SCALAR &&
                        (member = component_member(instance->row, false, k)) != NULL;
             k++) {
            Text name = {0};

            text_addf(&name, "%s.%s", instance->name, member->name);
            if (model_check_variable(model, name.at, 1, (Place){0}, &ignored) == OK)
                offer(line, name.at);
            text_free(&name);
        }
    }
}

static void offer_topics(TypedLine *line)
{
    for (int i = 0; topic_at(i) != NULL; i++)
        offer(line, topic_at(i)->name);
}

/* outputs of the last linearisation, before there is one what it may have as outputs */
static void offer_linear_outputs(TypedLine *line)
{
    const Linear *linear = line->known->linear;

    for (int i = 0; linear != NULL && i < linear->outputs; i++)
        offer(line, linear->output_names[i]);
    if (linear == NULL)
        offer_names(line);
}

static void offer_linear_inputs(TypedLine *line)
{
    const Linear *linear = line->known->linear;

    for (int i = 0; linear != NULL && i < linear->inputs; i++)
        offer(line, linear->input_names[i]);
}

/* frames or terminals; after `of` components and instances; `at`, `as` and keys come with any verb
 */
static void offer_ports(TypedLine *line)
{
    for (int i = 2; i < line->before.count; i++)
        if (strcmp(line->before.at[i], "of") == 0) {
            offer_showable(line);
            return;
        }
    offer_terminals(line);
    for (int i = 0; i < graph_node_count(model_graph(line->known->model)); i++)
        if (graph_node(model_graph(line->known->model), i)->domain == DOMAIN_MECHANICAL)
            offer(line, graph_node(model_graph(line->known->model), i)->name);
    if (line->before.count > 2)
        offer_alternatives(line, "translation|rotation|of");
}

/* whether `show` treats the word as a black box */
static bool names_subsystem(const TypedLine *line, const char *word)
{
    const Model *model = line->known->model;

    return model_find_use(model, word) != NULL || model_find_subsystem(model, word) != NULL;
}

static void offer_show(TypedLine *line)
{
    const Topic *topic = line->before.count > 1 ? topic_find(line->before.at[1]) : NULL;

    if (topic != NULL) {
        switch (topic->operands) {
        case OPERANDS_EDGES:
            offer_edges(line);
            break;
        case OPERANDS_ENTRY:
            offer_showable(line);
            if (line->prefix[0] != '\0')
                offer_alternatives(line, "mass(|forces(|constraints(|jacobian(");
            break;
        case OPERANDS_LEVEL:
            offer(line, "velocity");
            offer(line, "acceleration");
            break;
        case OPERANDS_PAIR:
            if (line->before.count == 2)
                offer_linear_outputs(line);
            else if (line->before.count == 3)
                offer_linear_inputs(line);
            else if (line->before.count == 4)
                offer(line, "symbolic");
            break;
        case OPERANDS_PORTS:
            offer_ports(line);
            break;
        case OPERANDS_ITEMS:
            if (line->before.count < 4)
                offer_terminals(line);
            break;
        default:
            break;
        }
        return;
    }
    if (line->before.count == 2 && names_subsystem(line, line->before.at[1])) {
        offer_alternatives(line, "internal|ports");
        return;
    }
    if (line->before.count == 1)
        offer_topics(line);
    if (line->before.count == 1)
        for (int i = 0; i < model_subsystem_count(line->known->model); i++)
            offer(line, model_subsystem(line->known->model, i)->name);
    if (line->before.count > 1 || line->prefix[0] != '\0')
        offer_showable(line);
}

/* the words of the i-th setting, the model's before the program's; NULL: no more */
static const char *const *setting_words(const TypedLine *line, int i)
{
    int own = 0;

    while (model_setting(own) != NULL)
        own++;
    if (i < own)
        return model_setting(i);
    return line->known->setting != NULL ? line->known->setting(line->known->context, i - own)
                                        : NULL;
}

/* what a setting of that name may be set to; false: there is none */
bool offer_setting(TypedLine *line, const char *name)
{
    const char *const *words;

    for (int i = 0; (words = setting_words(line, i)) != NULL; i++)
        if (strcmp(words[0], name) == 0) {
            for (int k = 1; words[k] != NULL; k++)
                offer(line, words[k]);
            return true;
        }
    return false;
}

static void offer_set(TypedLine *line)
{
    const char *const *words;

    if (line->before.count > 1 && offer_setting(line, line->before.at[1]))
        return;
    for (int i = 0; line->before.count == 1 && (words = setting_words(line, i)) != NULL; i++)
        offer(line, words[0]);
    offer_instances(line);
}

/* topics of help, then names of the model, and units after a first letter */
void offer_help_words(TypedLine *line)
{
    const char *word;
    Function row;

    for (int i = 0; help_word(i, &word); i++)
        offer(line, word);
    offer_showable(line);
    for (int i = 0; whole_name(i) != NULL; i++)
        offer(line, whole_name(i));
    if (line->prefix[0] == '\0')
        return;
    for (int i = 0; function_at(i, &row); i++)
        offer(line, row.name);
    offer_any_unit(line);
}

static void offer_blocks(TypedLine *line)
{
    for (int i = 0; count_block_name(i) != NULL; i++)
        offer(line, count_block_name(i));
    offer(line, "trees");
}

static void offer_methods(TypedLine *line)
{
    const char *name, *brief;

    for (int i = 0; (name = run_method(i, &brief)) != NULL; i++)
        offer(line, name);
}

void offer_notations(TypedLine *line)
{
    const Topic *topic = line->before.count > 1 ? topic_find(line->before.at[1]) : NULL;
    const char *word;

    for (int i = 0; (word = topic_notation(topic, i)) != NULL; i++)
        offer(line, word);
}

bool topic_takes_instant(const TypedLine *line)
{
    const Topic *topic = line->before.count > 1 ? topic_find(line->before.at[1]) : NULL;

    return topic != NULL && topic->need == NEED_INSTANT;
}

/* --- which of them --- */

/* words from tables other than the row, or names of one kind */
static const struct {
    void (*offer)(TypedLine *line);
    bool alone; /* instead of the row's words, not in addition */
    bool once;  /* only directly after the verb */
} sources[] = {
    [OFFERS_TOPICS] = {offer_show, true},
    [OFFERS_HELP] = {offer_help_words, true},
    [OFFERS_BLOCKS] = {offer_blocks, true},
    [OFFERS_EDGES] = {offer_edges, false},
    [OFFERS_LIT] = {offer_lit, false},
    [OFFERS_REMOVABLE] = {offer_removable, false},
    [OFFERS_SHOWABLE] = {offer_showable, false},
    [OFFERS_SETTABLE] = {offer_set, false},
    [OFFERS_COORDINATES] = {offer_coordinates, false},
    [OFFERS_STARTS] = {offer_starts, false},
    [OFFERS_OUTPUTS] = {offer_linear_outputs, true},
    [OFFERS_EVENTS] = {offer_event, false},
    [OFFERS_RUNS] = {offer_runs, true, true},
    [OFFERS_METHODS] = {offer_methods, true},
    [OFFERS_SUBSYSTEMS] = {offer_subsystems, false},
    [OFFERS_EXPORTED] = {offer_exported, false},
};

/* the place-th place of a component */
void offer_place(TypedLine *line, const Component *row, int place)
{
    switch (row->places) {
    case PLACES_NONE:
        break;
    case PLACES_FROM:
    case PLACES_FRAMES:
    case PLACES_ON:
        offer_frames(line);
        break;
    case PLACES_LINK:
        offer_frames(line);
        if (place == 0)
            offer_joints(line);
        break;
    case PLACES_JOINT:
    case PLACES_JOINTS:
        offer_joints(line);
        offer_terminals(line);
        break;
    case PLACES_COORDINATE:
        offer_coordinates(line);
        break;
    case PLACES_TERMINALS:
        offer_terminals(line);
        break;
    case PLACES_SENSED:
        if (place == 0)
            offer_coordinates(line);
        else
            offer_terminals(line);
        break;
    case PLACES_PARTS:
        offer_instances(line);
        break;
    case PLACES_TRANSDUCER:
        if (place == 0)
            offer_joints(line);
        else
            offer_terminals(line);
        break;
    }
}

bool offer_source(TypedLine *line, Offers offers)
{
    if (sources[offers].offer != NULL)
        sources[offers].offer(line);
    return sources[offers].offer != NULL;
}

bool source_is_alone(Offers offers)
{
    return sources[offers].alone;
}

bool source_is_once(Offers offers)
{
    return sources[offers].once;
}
