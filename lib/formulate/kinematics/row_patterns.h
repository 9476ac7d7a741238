/* row_patterns.h: rows of chords that close through instances, each derived once
 *
 * What lies outside of an instance differs in numbers most often: where it is fixed, and where the
 * chord leads. A pattern is such a row through the first instance, with symbols in the place of
 * those numbers; a row of another instance is the pattern's, renamed and filled in. Only while a
 * System is made. */
#ifndef COTREE_FORMULATE_KINEMATICS_ROW_PATTERNS_H
#define COTREE_FORMULATE_KINEMATICS_ROW_PATTERNS_H

#include "formulate/system/constraints.h"

typedef struct RowPatterns RowPatterns;

RowPatterns *row_patterns_new(System *system); /* new; borrows it */
void row_patterns_free(RowPatterns *patterns); /* NULL is fine */
/* As circuit_shown() and circuit_run() do, by a pattern. False: there is none, and can't be. */
bool row_pattern_show(RowPatterns *patterns, const Row *row, Expr *phi);
bool row_pattern_run(RowPatterns *patterns, const Row *row, int k, const int *speeds, int count);

#endif
