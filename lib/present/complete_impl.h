/* complete_impl.h: an unfinished line, and the sources of completions at its end */
#ifndef COTREE_PRESENT_COMPLETE_IMPL_H
#define COTREE_PRESENT_COMPLETE_IMPL_H

#include "present/help.h"

typedef struct TypedLine {
    const KnownName *known;
    const char *text;    /* of the statement, to the cursor */
    size_t word;         /* where the word to be completed starts */
    bool is_of_run;      /* after `run1.`: the word starts there */
    bool is_glued;       /* directly after a number: 10k */
    char prefix[128];    /* that word */
    LIST(char *) before; /* words before it */
    Words *out;
} TypedLine;

/* --- complete_offer.c --- */

bool is_word_letter(char c);
/* a word that starts with the typed one, once; `key=` unless it is already set */
void offer(TypedLine *line, const char *word);
void offer_key(TypedLine *line, const char *key);
void offer_alternatives(TypedLine *line, const char *words); /* between bars */

/* --- complete_names.c: from the tables and the model --- */

void offer_verbs(TypedLine *line);
void offer_joint_types(TypedLine *line);
void offer_names(TypedLine *line);
void offer_variables(TypedLine *line); /* of a run */
void offer_values(TypedLine *line);
void offer_coordinates(TypedLine *line);
void offer_place(TypedLine *line, const Component *row, int place); /* of a component */
void offer_help_words(TypedLine *line);
void offer_notations(TypedLine *line);
bool topic_takes_instant(const TypedLine *line); /* of `show` */
/* what a setting of that name may be set to; false: there is none */
bool offer_setting(TypedLine *line, const char *name);
/* where a row or a key finds its words, in addition to values; false: nothing of its own */
bool offer_source(TypedLine *line, Offers offers);
bool source_is_alone(Offers offers); /* instead of the row's words, not in addition */
bool source_is_once(Offers offers);  /* only directly after the verb */

/* --- complete_members.c: after dots and keys --- */

void offer_members(TypedLine *line, const Verb *verb); /* NULL: of no verb */
void offer_key_value(TypedLine *line, const Verb *verb, const char *key);

/* --- complete_units.c --- */

/* the row's parameter of a key: after `set` that of a part, "m1.euler"; NULL: none */
const Param *key_param(const TypedLine *line, const Verb *verb, const char *key);
void offer_any_unit(TypedLine *line);
/* Units, if one is allowed there: those of the expected dimension, if known. True: only a unit is
 * allowed. */
bool offer_units(TypedLine *line, const Verb *verb, const char *key);

#endif
