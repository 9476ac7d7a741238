/* verbs.h: the table of verb_find(), with the rows of verbs.def */
#ifndef COTREE_LANGUAGE_VERBS_H
#define COTREE_LANGUAGE_VERBS_H

#include "language/syntax.h"

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

enum { /* the verbs that are no component's, by number */
#define EVERY_VERB(word, ...) VERB_##word,
#include "language/verbs.def"
       VERB_COUNT
};

Verb verb_row(int number); /* of these */
/* every row once, in any order: quicker than verb_at() */
bool verb_any(int i, Verb *verb);

/* whether a word is in such a list of a row's; false for NULL */
bool words_hold(const char *const *words, const char *word);

#endif
