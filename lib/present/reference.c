/* reference.c: the tables as a chapter of the manual, a section of the man page, a word list */
#include "present/help.h"

#include <string.h>

/* --- Texinfo --- */

static void add_texinfo(Text *out, const char *text)
{
    static const char *const to[] = {"@@", "@{", "@}"};

    text_replace(out, text, "@{}", to);
}

static void add_texinfo_example(Text *out, const char *lines)
{
    text_add(out, "\n@example\n");
    add_texinfo(out, lines);
    if (lines[0] != '\0' && lines[strlen(lines) - 1] != '\n')
        text_char(out, '\n');
    text_add(out, "@end example\n");
}

/* lines that start with a blank are unchanged */
static void add_texinfo_paragraphs(Text *out, const char *lines)
{
    bool kept = false;

    text_char(out, '\n');
    while (*lines != '\0') {
        const size_t length = strcspn(lines, "\n");
        char *line = mem_text(lines, length);

        if ((line[0] == ' ') != kept)
            text_add(out, kept ? "@end display\n\n" : "\n@display\n");
        kept = line[0] == ' ';
        add_texinfo(out, line);
        text_char(out, '\n');
        mem_free(line);
        lines += length + (lines[length] == '\n');
    }
    if (kept)
        text_add(out, "@end display\n");
}

/* one of texinfo's two-column lists; opened by the first row */
static void add_texinfo_row(Text *out, bool *is_open, const char *what, const char *name,
                            const char *unit, const char *fallback, const char *meaning)
{
    if (!*is_open)
        text_addf(out, "\n%s\n@table @code\n", what);
    *is_open = true;
    text_add(out, "@item ");
    add_texinfo(out, name);
    text_char(out, '\n');
    add_texinfo(out, meaning);
    if (unit[0] != '\0' && strcmp(unit, "1") != 0) {
        text_add(out, " (");
        add_texinfo(out, unit);
        text_char(out, ')');
    }
    if (fallback[0] != '\0') {
        text_add(out, ", @code{");
        add_texinfo(out, fallback);
        text_add(out, "} if not said");
    }
    text_char(out, '\n');
}

/* in one paragraph, those of the row alone with what they mean */
static void add_texinfo_members(Text *out, const Component *row)
{
    const Member *member;
    bool is_open = false;

    for (int i = 0; (member = component_member(row, false, i)) != NULL; i++) {
        text_addf(out, "%s@code{", i == 0 ? "\nVariables: " : ", ");
        add_texinfo(out, member->name);
        text_char(out, '}');
        if (member->unit != NULL && strcmp(member->unit, "1") != 0) {
            text_add(out, " (");
            add_texinfo(out, member->unit);
            text_char(out, ')');
        }
        is_open = true;
    }
    if (is_open)
        text_add(out, ".\n");
    for (int i = 0; i < row->member_count; i++)
        text_addf(out, "@code{%s}: %s.\n", row->members[i].name, row->members[i].meaning);
}

static void add_texinfo_component(Text *out, const Component *row)
{
    KeyText key;
    bool is_open = false;

    for (int i = 0; component_key(row, i, &key); i++)
        add_texinfo_row(out, &is_open, "Keys:", key.name, key.unit, key.fallback, key.meaning);
    if (is_open)
        text_add(out, "@end table\n");
    add_texinfo_members(out, row);
}

static void add_texinfo_verb(Text *out, const Verb *verb)
{
    Text usage = {0};

    text_add(out, "\n@subheading @code{");
    add_texinfo(out, verb->name);
    text_add(out, "}\n@cindex @code{");
    add_texinfo(out, verb->name);
    text_add(out, "}\n");
    add_texinfo(out, verb->brief);
    text_add(out, ".\n");
    verb_usage(&usage, verb);
    add_texinfo_example(out, usage.at != NULL ? usage.at : verb->name);
    text_free(&usage);
    if (verb->help != NULL) {
        add_texinfo_paragraphs(out, verb->help);
    }
    if (verb->component != NULL)
        add_texinfo_component(out, verb->component);
    if (verb->example != NULL) {
        text_add(out, "\n@noindent\nExample:\n");
        add_texinfo_example(out, verb->example);
    }
}

static void add_texinfo_topics(Text *out)
{
    for (int i = 0; help_topic_at(i) != NULL; i++) {
        const HelpTopic *topic = help_topic_at(i);
        Text body = {0};

        text_addf(out, "\n@node About %s\n@section About %s\n\n", topic->name, topic->name);
        topic->write(&body);
        text_add(out, "@verbatim\n");
        text_add(out, body.at != NULL ? body.at : "");
        text_add(out, "@end verbatim\n");
        text_free(&body);
    }
}

void reference_texinfo(Text *out)
{
    Verb verb;
    int group = -1;

    text_add(out, "@c made from the tables of the program by `cotree --reference texinfo'\n"
                  "@node Reference\n@chapter Reference\n\n"
                  "Every verb and component, in the words of @code{help}.\n\n@menu\n");
    for (int i = 0; verb_at(i, &verb); i++) {
        if ((int)verb.group != group)
            text_addf(out, "* %s::\n", group_title(verb.group));
        group = (int)verb.group;
    }
    for (int i = 0; help_topic_at(i) != NULL; i++)
        text_addf(out, "* About %s::\n", help_topic_at(i)->name);
    text_add(out, "@end menu\n");
    group = -1;
    for (int i = 0; verb_at(i, &verb); i++) {
        if ((int)verb.group != group)
            text_addf(out, "\n@node %s\n@section %s\n", group_title(verb.group),
                      group_title(verb.group));
        group = (int)verb.group;
        add_texinfo_verb(out, &verb);
    }
    add_texinfo_topics(out);
}

/* --- man --- */

static void add_man(Text *out, const char *text)
{
    const char *from = text;

    for (; *text != '\0'; text++) {
        /* a line must not start with a request of roff */
        if ((*text == '.' || *text == '\'') && (text == from || text[-1] == '\n'))
            text_add(out, "\\&");
        if (*text == '\\')
            text_add(out, "\\e");
        else if (*text == '-')
            text_add(out, "\\-");
        else if (*text == '\'')
            text_add(out, "\\(aq");
        else
            text_char(out, *text);
    }
}

void reference_man(Text *out)
{
    Verb verb;
    int group = -1;

    text_add(out, ".SH COMMANDS\n");
    for (int i = 0; verb_at(i, &verb); i++) {
        Text usage = {0};

        if ((int)verb.group != group)
            text_addf(out, ".SS %s\n", group_title(verb.group));
        group = (int)verb.group;
        verb_usage(&usage, &verb);
        text_add(out, ".TP\n.B ");
        add_man(out, usage.at != NULL ? usage.at : verb.name);
        text_char(out, '\n');
        add_man(out, verb.brief);
        text_char(out, '\n');
        text_free(&usage);
    }
}

void reference_words(Text *out)
{
    const char *word;

    for (int i = 0; help_word(i, &word); i++)
        text_addf(out, "%s\n", word);
}
