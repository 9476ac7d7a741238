/* complete.c: what could stand at a place of a half-typed line
 *
 * The verb's row says how its operands are read; the words before the cursor say how far
 * the line has come. What is offered comes from the tables and from the model's names. */
#include "language/functions.h"
#include "present/count.h"
#include "present/help.h"
#include "present/show.h"
#include "simulate/run/run.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

typedef struct TypedLine {
    const KnownName *known;
    const char *text;    /* of the statement, to the cursor */
    size_t word;         /* where the word to be completed starts */
    char prefix[128];    /* that word */
    LIST(char *) before; /* words before it */
    Words *out;
} TypedLine;

static void offer(TypedLine *line, const char *word)
{
    if (strncmp(word, line->prefix, strlen(line->prefix)) != 0)
        return;
    for (int i = 0; i < line->out->count; i++)
        if (strcmp(line->out->at[i], word) == 0)
            return;
    LIST_PUSH(*line->out, mem_text(word, strlen(word)));
}

static void offer_key(TypedLine *line, const char *key)
{
    char word[128];

    (void)snprintf(word, sizeof word, "%s=", key);
    for (int i = 0; i < line->before.count; i++)
        if (strncmp(line->before.at[i], word, strlen(word)) == 0)
            return;
    offer(line, word);
}

/* words between bars */
static void offer_alternatives(TypedLine *line, const char *words)
{
    while (*words != '\0') {
        const size_t length = strcspn(words, "|");
        char *word = mem_text(words, length);

        offer(line, word);
        mem_free(word);
        words += length + (words[length] == '|');
    }
}

/* --- sources of words --- */

static void offer_verbs(TypedLine *line)
{
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++)
        if (verb.room != ROOM_LATER)
            offer(line, verb.name);
}

static void offer_joints_types(TypedLine *line)
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

static void offer_coordinates(TypedLine *line)
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

/* what has a name of its own, and can go; what an instance holds goes with it */
static void offer_removable(TypedLine *line)
{
    const Model *model = line->known->model;
    const char *name;

    for (int i = 0; (name = model_name(model, i)) != NULL; i++)
        if (strchr(name, '.') == NULL && model_can_go(model, name))
            offer(line, name);
}

/* behind `use`: what there is; then what it is given */
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

static bool is_event(const Model *model, const char *name)
{
    for (int i = 0; i < model_event_count(model); i++)
        if (strcmp(model_event(model, i)->name, name) == 0)
            return true;
    return false;
}

/* what may stand in an expression */
static void offer_names(TypedLine *line)
{
    const Model *model = line->known->model;
    const char *name;

    for (int i = 0; (name = model_name(model, i)) != NULL; i++)
        if (!is_event(model, name))
            offer(line, name);
    offer_coordinates(line);
}

/* what there is something to tell about */
static void offer_told(TypedLine *line)
{
    offer_names(line);
    offer_events(line);
}

/* behind `event`: one that is there can be given another condition; then what may get new values */
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
    /* spectra stand where columns of rows do */
    const bool spectra = verb_find(line->before.at[0], &verb) && strchr("iI", verb.pattern[0]);

    for (int i = 0; function_at(i, &row); i++) {
        (void)snprintf(call, sizeof call, "%s(", row.name);
        if (spectra || strcmp(row.name, "spectrum") != 0)
            offer(line, call);
    }
}

static void offer_values(TypedLine *line)
{
    static const char *const words[] = {"t", "pi", "energy", "model", "count", "constraint"};

    offer_names(line);
    /* functions and the rest only once a letter says that one is meant */
    if (line->prefix[0] == '\0')
        return;
    for (int i = 0; i < COUNT(words); i++)
        offer(line, words[i]);
    offer_runs(line);
    offer_functions(line);
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

static void offer_show(TypedLine *line)
{
    const Topic *topic = line->before.count > 1 ? topic_find(line->before.at[1]) : NULL;

    if (topic != NULL) {
        switch (topic->behind) {
        case BEHIND_EDGES:
            offer_edges(line);
            break;
        case BEHIND_ENTRY:
            offer_told(line);
            if (line->prefix[0] != '\0')
                offer_alternatives(line, "mass(|forces(|constraints(|jacobian(");
            break;
        case BEHIND_LEVEL:
            offer(line, "velocity");
            offer(line, "acceleration");
            break;
        case BEHIND_PAIR:
            if (line->before.count == 2)
                offer_linear_outputs(line);
            else if (line->before.count == 3)
                offer_linear_inputs(line);
            break;
        default:
            break;
        }
        return;
    }
    if (line->before.count == 1)
        offer_topics(line);
    if (line->before.count > 1 || line->prefix[0] != '\0')
        offer_told(line);
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
static bool offer_setting(TypedLine *line, const char *name)
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

static void offer_help_words(TypedLine *line)
{
    const char *word;

    for (int i = 0; help_word(i, &word); i++)
        offer(line, word);
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

static void offer_notations(TypedLine *line)
{
    for (Notation i = NOTATION_TEXT; i < NOTATIONS; i++)
        if (notation_row(i)->word != NULL)
            offer(line, notation_row(i)->word);
}

/* --- operands --- */

/* words that stand in other tables than the row, or are names of one kind */
static const struct {
    void (*offer)(TypedLine *line);
    bool alone; /* instead of the row's words, not besides them */
    bool once;  /* behind the verb itself, not behind more */
} sources[] = {
    [OFFERS_TOPICS] = {offer_show, true},
    [OFFERS_HELP] = {offer_help_words, true},
    [OFFERS_BLOCKS] = {offer_blocks, true},
    [OFFERS_EDGES] = {offer_edges, false},
    [OFFERS_LIT] = {offer_lit, false},
    [OFFERS_REMOVABLE] = {offer_removable, false},
    [OFFERS_TOLD] = {offer_told, false},
    [OFFERS_SETTABLE] = {offer_set, false},
    [OFFERS_COORDINATES] = {offer_coordinates, false},
    [OFFERS_OUTPUTS] = {offer_linear_outputs, true},
    [OFFERS_EVENTS] = {offer_event, false},
    [OFFERS_RUNS] = {offer_runs, true, true},
    [OFFERS_METHODS] = {offer_methods, true},
    [OFFERS_SUBSYSTEMS] = {offer_subsystems, false},
};

/* the place-th place of a component */
static void offer_place(TypedLine *line, const Component *row, int place)
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

/* the row's words stand at its first operand only */
static void offer_row_words(TypedLine *line, const Verb *verb)
{
    const bool words =
        line->before.count == 1 && verb->words != NULL && !sources[verb->offers].alone;

    if (sources[verb->offers].offer != NULL &&
        (line->before.count == 1 || !sources[verb->offers].once))
        sources[verb->offers].offer(line);
    for (int i = 0; words && verb->words[i] != NULL; i++)
        offer(line, verb->words[i]);
}

/* a component has values behind its places only where a param may stand there */
static bool takes_value(const Verb *verb)
{
    bool takes = verb->component == NULL;

    for (int i = 0; !takes && i < verb->component->param_count; i++)
        takes = (verb->component->params[i].use & POSITIONAL) != 0;
    return takes;
}

static void offer_letter(TypedLine *line, const Verb *verb, char letter, int place)
{
    const bool has_source = verb->words != NULL || sources[verb->offers].offer != NULL;
    const bool is_alone = sources[verb->offers].alone; /* no other values than the source's */

    switch (letter) {
    case 'p':
    case 'P':
        if (verb->component != NULL)
            offer_place(line, verb->component, place);
        else if (!has_source)
            offer_names(line);
        break;
    case 'V':
        if (takes_value(verb))
            offer_values(line);
        break;
    case 'v':
    case 'e':
    case 'i':
    case 'I':
    case 'C':
        if (!is_alone)
            offer_values(line);
        break;
    case '=':
        if (verb->component != NULL && verb->component->places == PLACES_COORDINATE)
            offer_coordinates(line);
        else if (!has_source)
            offer_names(line);
        break;
    default:
        break;
    }
    if (strchr("wWotxlp=niI", letter) != NULL)
        offer_row_words(line, verb);
}

static void offer_keys(TypedLine *line, const Verb *verb)
{
    for (int i = 0; verb_key(verb, i) != NULL; i++)
        offer_key(line, verb_key(verb, i));
}

static void offer_operand(TypedLine *line, const Verb *verb, int first)
{
    const char *pattern = verb->pattern;
    const char *word = first < line->before.count ? line->before.at[first] : "";
    const bool has_options = verb->optioned == NULL || strcmp(word, verb->optioned) == 0;
    int operand = first, place = 0, at = 0;

    while (operand < line->before.count && pattern[at] != '\0' &&
           strchr("nwWpPvVso", pattern[at]) != NULL && pattern[at + 1] != '*') {
        place += pattern[at] == 'p' || pattern[at] == 'P';
        at++;
        operand++;
    }
    if (pattern[at] != '\0' && pattern[at] != 'k')
        offer_letter(line, verb, pattern[at], place);
    /* what may follow once nothing is missing; V and P may be skipped */
    while (pattern[at] != '\0' && strchr("PVWIiext*", pattern[at]) != NULL)
        at++;
    for (; has_options && pattern[at] != '\0'; at++) {
        if (pattern[at] == 'k' || (pattern[at] == '=' && verb->component == NULL))
            offer_keys(line, verb);
        else if (pattern[at] == '@' && operand > first)
            offer(line, "at");
        else if (pattern[at] == 'y' && operand > first)
            offer(line, "vs");
        else if (pattern[at] == 'a' && operand > first)
            offer(line, "as");
        else if (strchr(">:*", pattern[at]) == NULL)
            break;
    }
}

/* --- values of keys, members --- */

/* the row's param that a key stands for: behind `set` that of a part, "m1.euler"; NULL: none */
static const Param *find_param(const TypedLine *line, const Verb *verb, const char *key)
{
    const Component *row = verb->component;
    const char *member = key;
    int i;

    if (verb->offers == OFFERS_SETTABLE) {
        const Instance *instance = model_owner(line->known->model, key, &member);

        row = instance != NULL ? instance->row : NULL;
    }
    i = row != NULL ? component_param(row, member) : -1;
    return i >= 0 ? &row->params[i] : NULL;
}

static void offer_key_value(TypedLine *line, const Verb *verb, const char *key)
{
    const Param *param = find_param(line, verb, key);
    const VerbKey *row = verb->keys;

    while (row != NULL && (row->name == NULL || strcmp(row->name, key) != 0))
        row = row->name != NULL ? row + 1 : NULL;
    if (verb->offers == OFFERS_SETTABLE && offer_setting(line, key))
        return;
    if (param != NULL && param->kind == PARAM_WORD)
        offer_alternatives(line, param->fallback);
    else if (param != NULL && (param->kind == PARAM_AXIS || param->kind == PARAM_AXES))
        offer_alternatives(line, "x|y|z|-x|-y|-z");
    else if (row != NULL && row->words != NULL)
        offer_alternatives(line, row->words);
    else if (row != NULL && sources[row->offers].offer != NULL)
        sources[row->offers].offer(line);
    else
        offer_values(line);
}

static void offer_member(TypedLine *line, const char *base, const char *member)
{
    char word[256];

    (void)snprintf(word, sizeof word, "%s.%s", base, member);
    offer(line, word);
}

/* members of groups that aren't components */
static const struct {
    const char *base;
    const char *members[4];
} groups[] = {
    {"energy", {"kinetic", "potential", "total", NULL}},
    {"model", {"n", "m", "dof", NULL}},
    {"constraint", {"error", NULL}},
};

static void offer_members(TypedLine *line, const Verb *verb)
{
    char base[128];
    const char *dot = strrchr(line->prefix, '.');
    const Graph *graph = model_graph(line->known->model);
    const Instance *instance;
    const Member *member;
    const char *begun;
    int node;

    (void)snprintf(base, sizeof base, "%.*s", (int)(dot - line->prefix), line->prefix);
    for (int g = 0; g < COUNT(groups); g++)
        for (int i = 0; strcmp(groups[g].base, base) == 0 && groups[g].members[i] != NULL; i++)
            offer_member(line, base, groups[g].members[i]);
    for (int i = 0; strcmp(base, "count") == 0 && count_block_name(i) != NULL; i++)
        offer_member(line, base, count_block_name(i));
    instance = model_owner(line->known->model, line->prefix, &begun);
    if (instance == NULL && model_use_around(line->known->model, line->prefix, -1) >= 0)
        offer_names(line); /* what an instance has of its own */
    if (instance == NULL) {
        node = graph_find_node(graph, base);
        if (node >= 0)
            offer_member(line, base, domain_across(graph_node(graph, node)->domain));
        return;
    }
    if (verb != NULL && verb->offers == OFFERS_SETTABLE) {
        for (int i = 0; i < instance->row->param_count; i++)
            offer_member(line, instance->name, instance->row->params[i].name);
        return;
    }
    for (int c = 0; c < instance->coord_count; c++)
        offer(line, instance->coord[c]);
    for (int i = 0;
         (member = component_member(instance->row, model_is_planar(line->known->model), i)) != NULL;
         i++)
        offer_member(line, instance->name, member->name);
}

static bool is_number(const char *word)
{
    return isdigit((unsigned char)word[0]) ||
           ((word[0] == '.' || word[0] == '-') && isdigit((unsigned char)word[1]));
}

/* the number that the word stands behind, also that of key=5 */
static bool follows_number(const TypedLine *line)
{
    const char *last = line->before.count > 0 ? line->before.at[line->before.count - 1] : "";
    const char *equals = strrchr(last, '=');

    return is_number(equals != NULL ? equals + 1 : last);
}

static void offer_units(TypedLine *line)
{
    static const char *const prefixes[] = {"", "k", "m", "u", "n", "p", "c", "M", "G"};
    const char *name;

    for (int p = 0; p < COUNT(prefixes); p++)
        for (int i = 0; (name = unit_name(i)) != NULL; i++) {
            char word[40];
            Unit unit;

            (void)snprintf(word, sizeof word, "%s%s", prefixes[p], name);
            if (unit_find(word, &unit))
                offer(line, word);
        }
}

/* --- the line --- */

static bool is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_' || c == '.';
}

/* offset of the statement that the cursor stands in; false inside a string or comment */
static bool find_statement(const char *text, size_t cursor, size_t *start)
{
    bool quoted = false;

    *start = 0;
    for (size_t i = 0; i < cursor; i++) {
        if (text[i] == '"')
            quoted = !quoted;
        else if (!quoted && text[i] == '#')
            return false;
        else if (!quoted && (text[i] == ';' || text[i] == ':'))
            *start = i + 1;
    }
    while (*start < cursor && isspace((unsigned char)text[*start]))
        ++*start;
    return !quoted;
}

static void split(TypedLine *line)
{
    size_t i = 0;

    while (i < line->word) {
        const size_t from = i;

        while (i < line->word && !isspace((unsigned char)line->text[i]) && line->text[i] != ',')
            i++;
        if (i > from)
            LIST_PUSH(line->before, mem_text(line->text + from, i - from));
        i++;
    }
}

/* the key of `key=` where the cursor stands in its value; false: it doesn't */
static bool find_key(const TypedLine *line, char *key, size_t size)
{
    size_t from = line->word, equals;

    while (from > 0 && !isspace((unsigned char)line->text[from - 1]))
        from--;
    equals = from + strcspn(line->text + from, "=");
    if (equals >= line->word) {
        /* blanks around = are free */
        size_t end = line->word;

        while (end > 0 && isspace((unsigned char)line->text[end - 1]))
            end--;
        if (end == 0 || line->text[end - 1] != '=')
            return false;
        from = end - 1;
        while (from > 0 && isspace((unsigned char)line->text[from - 1]))
            from--;
        equals = from;
        while (from > 0 && is_word(line->text[from - 1]))
            from--;
    }
    (void)snprintf(key, size, "%.*s", (int)(equals - from), line->text + from);
    return true;
}

static bool has_pair(const TypedLine *line)
{
    for (int i = 0; i < line->before.count; i++)
        if (strchr(line->before.at[i], '=') != NULL)
            return true;
    return false;
}

static void offer_behind_verb(TypedLine *line)
{
    const char *last = line->before.at[line->before.count - 1];
    Verb verb;
    char key[128];
    bool known = verb_find(line->before.at[0], &verb);
    const bool is_virtual = known && verb.room == ROOM_LANGUAGE;

    if (is_virtual)
        known = line->before.count > 1 && verb_find(line->before.at[1], &verb);

    if (line->prefix[0] != '\0' && strchr(line->prefix, '.') == NULL && follows_number(line))
        offer_units(line);
    if (line->before.at[0][0] == '?')
        offer_help_words(line);
    else if (strchr(line->prefix, '.') != NULL)
        offer_members(line, known ? &verb : NULL);
    else if (is_virtual && line->before.count == 1)
        offer_joints_types(line);
    else if (!known)
        offer_values(line);
    else if (find_key(line, key, sizeof key))
        offer_key_value(line, &verb, key);
    else if (strcmp(last, "as") == 0)
        offer_notations(line);
    else if (strcmp(last, "at") == 0)
        offer(line, "t");
    else if (strchr(verb.pattern, 'T') != NULL)
        offer_verbs(line);
    else if (has_pair(line) && strchr(verb.pattern, 'k') != NULL)
        offer_keys(line, &verb);
    else
        offer_operand(line, &verb, is_virtual ? 2 : 1);
}

void complete_line(const KnownName *known, const char *text, size_t cursor, size_t *start,
                   Words *out)
{
    TypedLine line = {.known = known, .before = {0}, .out = out};
    char *copy;
    size_t statement;

    if (cursor > strlen(text))
        cursor = strlen(text);
    *start = cursor;
    if (!find_statement(text, cursor, &statement))
        return;
    copy = mem_text(text + statement, cursor - statement);
    line.text = copy;
    line.word = strlen(copy);
    while (line.word > 0 && is_word(copy[line.word - 1]))
        line.word--;
    *start = statement + line.word;
    if (strlen(copy + line.word) < sizeof line.prefix) {
        (void)snprintf(line.prefix, sizeof line.prefix, "%s", copy + line.word);
        split(&line);
        if (line.before.count == 0 && copy[0] == '?')
            offer_help_words(&line);
        else if (line.before.count == 0)
            offer_verbs(&line);
        else
            offer_behind_verb(&line);
    }
    for (int i = 0; i < line.before.count; i++)
        mem_free(line.before.at[i]);
    LIST_FREE(line.before);
    mem_free(copy);
}
