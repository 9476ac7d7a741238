/* resistance.h: how what hangs beyond a place resists its motion, in symbols
 *
 * A motion is alpha and a of an origin, three components each, and speeds that were met beyond and
 * have not yielded yet. Load = A motion - b, A symmetric. What can't move has rows of zeros. */
#ifndef COTREE_FORMULATE_REDUCED_RESISTANCE_H
#define COTREE_FORMULATE_REDUCED_RESISTANCE_H

#include "formulate/reduced/groups.h"

enum { MOTION = 6, SHIFT = 3 }; /* components of a motion; where those of a begin */

typedef struct Resistance {
    int count;   /* MOTION, then the speeds */
    int *speeds; /* count - MOTION */
    Expr *A;     /* count x count */
    Expr *b;
} Resistance;

/* what has yielded: x = inverse b - factor motion */
typedef struct Yield {
    int unknown; /* its place */
    int count;
    int *speeds;
    Expr inverse, right;
    Expr *factor;
} Yield;

void resistance_init(Arena *arena, Resistance *r); /* of nothing; freed with resistance_free() */
void resistance_free(Resistance *r);
/* m, S, J about the origin */
void resistance_add_body(Arena *arena, Resistance *r, const Group *group);
/* frees `part` */
void resistance_add(Arena *arena, Resistance *r, Resistance *part);
/* One more unknown: the motion holds it times (turn, shift), and nothing else of it is known. */
void resistance_add_speed(Arena *arena, Resistance *r, int speed, Vec turn, Vec shift);
/* keep nothing but what can move, of MOTION */
void resistance_confine(Arena *arena, Resistance *r, const bool *moves);
/* from the axes of a chain to those of another */
void resistance_turn(const System *system, Resistance *r, int from, int to);
/* to the origin from which that of now stands at `way` */
void resistance_shift(Arena *arena, Resistance *r, Vec way);
/* Let an unknown yield; false: nothing resists it. The place of a speed is given up. */
bool resistance_yield(Arena *arena, Resistance *r, int unknown, Yield *out);
void yield_free(Yield *yield);

#endif
