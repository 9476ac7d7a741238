/* resistance.h: articulated inertia of all beyond a place, in symbols
 *
 * A motion consists of alpha and a of an origin, three components each, and of the speeds beyond
 * that are not eliminated yet. Load = A motion - b, with A symmetric. Components that can't move
 * have rows of zeros. */
#ifndef COTREE_FORMULATE_REDUCED_RESISTANCE_H
#define COTREE_FORMULATE_REDUCED_RESISTANCE_H

#include "formulate/reduced/groups.h"

enum { MOTION = 6, SHIFT = 3 }; /* components of a motion; index of the first component of a */

typedef struct Resistance {
    int count;   /* MOTION, then the speeds */
    int *speeds; /* count - MOTION */
    Expr *A;     /* count x count */
    Expr *b;
} Resistance;

/* an eliminated unknown: x = inverse b - factor motion */
typedef struct Yield {
    int unknown; /* its index */
    int count;
    int *speeds;
    Expr inverse, right;
    Expr *factor;
} Yield;

void resistance_init(Arena *arena, Resistance *r); /* zero; freed with resistance_free() */
void resistance_free(Resistance *r);
/* adds m, S, J about the origin */
void resistance_add_body(Arena *arena, Resistance *r, const Group *group);
/* frees `part` */
void resistance_add(Arena *arena, Resistance *r, Resistance *part);
/* Adds an unknown: its multiple of (turn, shift) is added to the motion, and nothing else of it is
 * known. */
void resistance_add_speed(Arena *arena, Resistance *r, int speed, Vec turn, Vec shift);
/* removes all components of MOTION that can't move */
void resistance_confine(Arena *arena, Resistance *r, const bool *moves);
/* from the axes of an orientation class to those of another */
void resistance_turn(const System *system, Resistance *r, int from, int to);
/* to the origin from which the current one is at `way` */
void resistance_shift(Arena *arena, Resistance *r, Vec way);
/* Eliminates an unknown; false: it has no inertia. Removes the index of a speed. */
bool resistance_yield(Arena *arena, Resistance *r, int unknown, Yield *out);
void yield_free(Yield *yield);

#endif
