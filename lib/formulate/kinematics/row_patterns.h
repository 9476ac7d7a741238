/* row_patterns.h: rows of chords that close through instances, each derived once
 *
 * What lies outside of an instance differs mostly in numbers: where it is fixed, and where the
 * chord leads. A pattern is such a row through the first instance, with symbols for those numbers.
 * The row of another instance is the pattern, renamed and with its numbers substituted. Patterns
 * exist only while a System is built. */
#ifndef COTREE_FORMULATE_KINEMATICS_ROW_PATTERNS_H
#define COTREE_FORMULATE_KINEMATICS_ROW_PATTERNS_H

#include "formulate/system/constraints.h"

typedef struct RowPatterns RowPatterns;

RowPatterns *row_patterns_new(System *system); /* new; borrows it */
void row_patterns_free(RowPatterns *patterns); /* NULL is fine */
/* As circuit_shown() and circuit_run(), by a pattern. False: there is none, and there can't be
 * one. */
bool row_pattern_show(RowPatterns *patterns, const Row *row, Expr *phi);
bool row_pattern_run(RowPatterns *patterns, const Row *row, int k, const int *speeds, int count);

#endif
