/* help.h: help, reference and completion, from the rows of verbs, components and topics
 *
 * No code here refers to a verb or a component by name; text that belongs to no row (units, the
 * counting rule ...) is a help topic with a row of its own. */
#ifndef COTREE_PRESENT_HELP_H
#define COTREE_PRESENT_HELP_H

#include "base/text.h"
#include "model/model.h"
#include "simulate/analyse/linearize.h"

typedef struct HelpTopic {
    const char *name;
    const char *brief;
    void (*write)(Text *out); /* the text after the brief line */
    const char *page;         /* verb whose page includes it too; NULL */
} HelpTopic;

const HelpTopic *help_topic_at(int i); /* 0, 1, ... until NULL */
const HelpTopic *help_topic_find(const char *name);

/* Append the help on `word` (NULL or "": the overview); false, with nothing appended, if the word
 * is unknown. */
bool help_print(Text *out, const char *word);
/* every line about a word, one line each; nothing if there is none */
void help_apropos(Text *out, const char *word);
/* every word that help knows, once: 0, 1, ...; false at the end */
bool help_word(int i, const char **word);
/* first words of variables of the model as a whole, "energy": 0, 1, ...; NULL at the end */
const char *whole_name(int i);
const char *whole_member(int i, int k); /* its k-th, "kinetic"; NULL at the end */
const char *help_suggest(const char *word);
/* examples of verbs and components: 0, 1, ...; false at the end */
bool help_example(int i, const char **name, const char **text);

/* the tables as a chapter of the manual, as a section of the man page, or as words, one a line */
void reference_texinfo(Text *out);
void reference_man(Text *out);
void reference_words(Text *out);

/* the whole of a component row's keys and members, a table each, for help and reference */
typedef struct KeyText {
    const char *name;
    const char *unit;     /* "" none */
    const char *fallback; /* "": required */
    const char *meaning;
} KeyText;
/* the i-th key of a component, as text */
bool component_key(const Component *row, int i, KeyText *out);

/* where completion finds names and words, in addition to the tables */
typedef struct KnownName {
    const Model *model;
    const Linear *linear; /* the last linearisation; NULL */
    int runs;             /* run1 is the first */
    /* settings of the program: as ct_hooks has it; may be NULL */
    const char *const *(*setting)(void *context, int i);
    void *context;
} KnownName;

/* Words that are allowed at `cursor` of the line, in the order in which they should be offered.
 * *start is the offset of the word that they complete. */
typedef LIST(char *) Words;
void complete_line(const KnownName *known, const char *line, size_t cursor, size_t *start,
                   Words *out);

#endif
