/* verbs.h: the tables behind verb_find(), one a file of rows */
#ifndef COTREE_LANGUAGE_VERBS_H
#define COTREE_LANGUAGE_VERBS_H

#include "language/syntax.h"

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* each ended by a row without a name */
extern const Verb verbs_build[];   /* scene, variables, trees */
extern const Verb verbs_look[];    /* show, count ... */
extern const Verb verbs_run[];     /* init, simulate, plot ... */
extern const Verb verbs_session[]; /* files, undo, help ... */
extern const Verb verbs_later[];   /* what comes with later versions, components too */

/* A small model that examples start from: a pendulum, 1 m long. */
#define PENDULUM                                                                                   \
    "scene planar\n"                                                                               \
    "gravity [0, -9.81]\n"                                                                         \
    "body m1 mass=1 inertia=0.1\n"                                                                 \
    "arm p1 m1 [0, 1]\n"                                                                           \
    "revolute h1 ground p1\n"

/* every row once, in any order: quicker than verb_at() */
bool verb_any(int i, Verb *verb);

/* whether a key of a row that is here, or a word of its operands, comes with a later version */
bool key_is_later(const char *verb, const char *key);
bool word_is_later(const char *verb, const char *word);

#endif
