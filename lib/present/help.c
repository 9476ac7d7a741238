/* help.c: help on a word, from the tables */
#include "present/help.h"

#include "language/functions.h"
#include "language/verbs.h"
#include "present/layout.h"
#include "present/show.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { HELP_WIDTH = 78, WIDE = 20 /* for the default of a key */ };

/* --- pieces of a page --- */

bool component_key(const Component *row, int i, KeyText *out)
{
    if (i >= row->param_count)
        return false;
    *out = (KeyText){row->params[i].name, row->params[i].unit == NULL ? "any" : row->params[i].unit,
                     row->params[i].fallback == NULL ? "" : row->params[i].fallback,
                     row->params[i].meaning};
    return true;
}

static void add_keys(Text *out, const Component *row)
{
    Table table = table_for("llll");
    KeyText key;

    for (int i = 0; component_key(row, i, &key); i++) {
        /* "parameters|zxz|zyz": the first word is the default; all are listed after the meaning */
        const bool is_choice = strlen(key.fallback) > WIDE;
        const size_t first = is_choice ? strcspn(key.fallback, "|") : strlen(key.fallback);
        Text words = {0};

        for (const char *c = key.fallback; is_choice && *c != '\0'; c++)
            text_add_n(&words, *c == '|' ? ", " : c, *c == '|' ? 2 : 1);
        if (i == 0)
            table_cells(&table, "key\tunit\tdefault\tmeaning");
        table_cells(&table, "%s\t%s\t%.*s\t%s%s%s", key.name,
                    strcmp(key.unit, "1") == 0 ? "" : key.unit, (int)first, key.fallback,
                    key.meaning, is_choice ? ": " : "", is_choice ? words.at : "");
        text_free(&words);
    }
    if (table.cells.count > 0) {
        text_char(out, '\n');
        table_wrap(out, &table, 2, HELP_WIDTH);
    }
    table_free(&table);
}

static void add_members(Text *out, const Component *row)
{
    Table table = table_for("lll");
    const Member *member;

    for (int i = 0; (member = component_member(row, false, i)) != NULL; i++)
        table_cells(&table, "NAME.%s\t%s\t%s", member->name,
                    member->unit == NULL || strcmp(member->unit, "1") == 0 ? "" : member->unit,
                    member->meaning);
    if (table.cells.count > 0) {
        text_add(out, "\nVariables:\n");
        table_wrap(out, &table, 2, HELP_WIDTH);
    }
    table_free(&table);
}

static void add_indented(Text *out, const char *lines)
{
    while (*lines != '\0') {
        const size_t length = strcspn(lines, "\n");

        text_add(out, "    ");
        text_add_n(out, lines, length);
        text_char(out, '\n');
        lines += length + (lines[length] == '\n');
    }
}

/* "  do=stop    the run ends there": where the second column starts, else the first */
static size_t second_column(const char *line)
{
    const size_t first = strspn(line, " ");
    const char *gap = strstr(line + first, "  ");

    return gap != NULL ? (size_t)(gap - line) + strspn(gap, " ") : first;
}

/* lines that start with a blank are rows, and are unchanged if they fit */
static void add_paragraphs(Text *out, const char *lines)
{
    while (*lines != '\0') {
        const size_t length = strcspn(lines, "\n");
        char *line = mem_text(lines, length);

        if (line[0] != ' ') {
            layout_words(out, HELP_WIDTH, "", line);
        } else if (text_width(line) <= HELP_WIDTH) {
            text_addf(out, "%s\n", line);
        } else {
            const size_t start = second_column(line);
            char *lead = mem_text(line, start);

            layout_words(out, HELP_WIDTH, lead, line + start);
            mem_free(lead);
        }
        mem_free(line);
        lines += length + (lines[length] == '\n');
    }
}

/* entries of a verb in separate tables */
static void add_topics(Text *out, const char *verb)
{
    for (int i = 0; help_topic_at(i) != NULL; i++)
        if (help_topic_at(i)->page != NULL && strcmp(help_topic_at(i)->page, verb) == 0) {
            text_char(out, '\n');
            help_topic_at(i)->write(out);
        }
}

/* --- a page --- */

static void add_verb(Text *out, const Verb *verb)
{
    Text line = {0};

    text_addf(out, "%s - %s\n", verb->name, verb->brief);
    verb_usage(&line, verb);
    text_char(out, '\n');
    layout_words(out, HELP_WIDTH, "  usage: ", line.at != NULL ? line.at : verb->name);
    text_free(&line);
    if (verb->component != NULL)
        add_keys(out, verb->component);
    if (verb->help != NULL) {
        text_char(out, '\n');
        add_paragraphs(out, verb->help);
    }
    add_topics(out, verb->name);
    if (verb->component != NULL)
        add_members(out, verb->component);
    if (verb->example != NULL) {
        text_add(out, "\nExample:\n");
        add_indented(out, verb->example);
    }
    if (verb->see != NULL && verb->see[0] != '\0')
        text_addf(out, "\nSee also: %s\n", verb->see);
}

static bool add_function(Text *out, const char *word)
{
    Function row;

    if (!function_find(word, &row) || row.kind != FUNCTION_OPERATION)
        return false;
    text_addf(out, "%s - a function of %d argument%s; 'help functions' lists them all\n", word,
              row.least, row.least == 1 ? "" : "s");
    return true;
}

/* first words of variables of the whole model, and functions of runs: the text of their topic */
static bool add_quantity(Text *out, const char *word)
{
    const HelpTopic *topic = NULL;
    const size_t length = strcspn(word, "."); /* energy.kinetic is one of energy */

    for (int i = 0; whole_name(i) != NULL; i++)
        if (strlen(whole_name(i)) == length && strncmp(word, whole_name(i), length) == 0)
            topic = help_topic_find("variables");
    if (topic == NULL && function_is_figure(word))
        topic = help_topic_find("functions");
    if (topic == NULL)
        return false;
    text_addf(out,
              "%s - see the topic '%s'\n"
              "\n",
              word, topic->name);
    topic->write(out);
    return true;
}

/* "rpm - a unit: 1 rpm is 0.10472 rad/s" */
static bool add_unit(Text *out, const char *word)
{
    Unit unit;

    if (!unit_find(word, &unit))
        return false;
    text_addf(out, "%s - a unit: 1 %s is %.12g ", word, word, unit.factor);
    dimension_print(out, unit.dimension);
    text_add(out, "; 'help units' lists them all\n");
    return true;
}

/* "every - stands behind simulate, resume ...": a key, or a word that may follow operands */
static bool add_key(Text *out, const char *word)
{
    Text verbs = {0};
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++) {
        bool has = words_hold(verb.words, word);

        for (const char *letter = verb.pattern; !has && *letter != '\0'; letter++)
            has = pattern_word(*letter) != NULL && strcmp(pattern_word(*letter), word) == 0;
        for (int k = 0; !has && verb_key(&verb, k) != NULL; k++)
            has = strcmp(verb_key(&verb, k), word) == 0;
        if (has)
            text_addf(&verbs, "%s%s", verbs.length > 0 ? " " : "", verb.name);
    }
    if (verbs.length == 0)
        return false;
    text_addf(out,
              "%s - a keyword of these statements; 'help' of one explains its meaning "
              "there\n"
              "\n",
              word);
    layout_words(out, HELP_WIDTH, "  ", verbs.at);
    text_free(&verbs);
    return true;
}

/* the only word with that prefix; NULL: none, or several */
static const char *spelled_out(const char *word)
{
    const char *candidate, *found = NULL;

    for (int i = 0; help_word(i, &candidate); i++)
        if (strncmp(candidate, word, strlen(word)) == 0) {
            if (found != NULL)
                return NULL;
            found = candidate;
        }
    return found;
}

static void add_overview(Text *out)
{
    Verb verb;
    Text names = {0};
    VerbGroup group = GROUP_SCENE;
    char lead[64];

    text_add(out, "'help WORD' explains a verb, a component or a topic, 'apropos WORD' finds "
                  "words.\n"
                  "The Tab key completes the word at the cursor.\n"
                  "\n");
    for (int i = 0; verb_at(i, &verb) || names.length > 0; i++) {
        const bool more = verb_at(i, &verb);

        if (names.length > 0 && (!more || verb.group != group)) {
            text_addf(out, "%s\n", group_title(group));
            (void)snprintf(lead, sizeof lead, "  ");
            layout_words(out, HELP_WIDTH, lead, names.at);
            text_free(&names);
        }
        if (!more)
            break;
        group = verb.group;
        text_addf(&names, "%s%s", names.length > 0 ? " " : "", verb.name);
    }
    for (int i = 0; help_topic_at(i) != NULL; i++)
        text_addf(&names, "%s%s", i > 0 ? " " : "", help_topic_at(i)->name);
    text_add(out, "Topics of help\n");
    layout_words(out, HELP_WIDTH, "  ", names.at);
    layout_words(
        out, HELP_WIDTH, "",
        "The manual, 'info cotree', has a tour from an empty session to a plot, then to a motor "
        "arm; its chapter 'Teaching' has lessons with exercises and their solutions.");
    text_free(&names);
}

/* its line, and the notations where it has several */
static void add_topic(Text *out, const Topic *topic)
{
    const char *notation;

    text_addf(out, "show %s - %s\n", topic->name, topic->brief);
    for (int i = 1; (notation = topic_notation(topic, i)) != NULL; i++)
        text_addf(out, "%s%s", i == 1 ? "\nAlso as " : ", ", notation);
    if (topic_notation(topic, 1) != NULL)
        text_addf(out, ": show %s as %s\n", topic->name, topic_notation(topic, 1));
}

bool help_print(Text *out, const char *word)
{
    const HelpTopic *about;
    const Topic *topic;
    Verb verb;
    bool known = true;

    if (word == NULL || word[0] == '\0')
        add_overview(out);
    else if (verb_find(word, &verb))
        add_verb(out, &verb);
    else if ((about = help_topic_find(word)) != NULL) {
        text_addf(out, "%s - %s\n\n", about->name, about->brief);
        about->write(out);
    } else if ((topic = topic_find(word)) != NULL)
        add_topic(out, topic);
    else
        known = add_function(out, word) || add_quantity(out, word) || add_unit(out, word) ||
                add_key(out, word) ||
                (spelled_out(word) != NULL && help_print(out, spelled_out(word)));
    return known;
}

/* --- finding words --- */

bool help_word(int i, const char **word)
{
    Verb verb;
    int topics = 0;

    for (int v = 0; verb_at(v, &verb); v++)
        if (i-- == 0) {
            *word = verb.name;
            return true;
        }
    while (help_topic_at(topics) != NULL)
        topics++;
    if (i < topics) {
        *word = help_topic_at(i)->name;
        return true;
    }
    i -= topics;
    /* topics of show that aren't verbs too */
    for (int t = 0; topic_at(t) != NULL; t++)
        if (topic_at(t)->show != NULL && !verb_find(topic_at(t)->name, &verb) &&
            help_topic_find(topic_at(t)->name) == NULL && i-- == 0) {
            *word = topic_at(t)->name;
            return true;
        }
    return false;
}

/* a word that starts with the typed one, else the nearest */
const char *help_suggest(const char *word)
{
    Suggest suggest = suggest_for(word);
    const size_t length = strlen(word);
    const char *candidate;

    for (int i = 0; length > 2 && help_word(i, &candidate); i++)
        if (strncmp(candidate, word, length) == 0)
            return candidate;
    for (int i = 0; help_word(i, &candidate); i++)
        suggest_offer(&suggest, candidate);
    return suggest.best;
}

static bool mentions(const char *text, const char *word)
{
    return text != NULL && strcasestr(text, word) != NULL;
}

void help_apropos(Text *out, const char *word)
{
    Table table = table_for("ll");
    Verb verb;

    for (int i = 0; verb_at(i, &verb); i++)
        if (mentions(verb.name, word) || mentions(verb.brief, word) || mentions(verb.help, word)) {
            table_cells(&table, "%s\t%s", verb.name, verb.brief);
        }
    for (int i = 0; topic_at(i) != NULL; i++)
        if (topic_at(i)->show != NULL &&
            (mentions(topic_at(i)->name, word) || mentions(topic_at(i)->brief, word))) {
            table_cells(&table, "show %s\t%s", topic_at(i)->name, topic_at(i)->brief);
        }
    for (int i = 0; help_topic_at(i) != NULL; i++) {
        Text body = {0};

        help_topic_at(i)->write(&body);
        if (mentions(help_topic_at(i)->name, word) || mentions(help_topic_at(i)->brief, word) ||
            mentions(body.at, word)) {
            table_cells(&table, "help %s\t%s", help_topic_at(i)->name, help_topic_at(i)->brief);
        }
        text_free(&body);
    }
    table_finish(out, &table, 0);
}

bool help_example(int i, const char **name, const char **text)
{
    Verb verb;

    for (int v = 0; verb_at(v, &verb); v++)
        if (verb.example != NULL && i-- == 0) {
            *name = verb.name;
            *text = verb.example;
            return true;
        }
    return false;
}
