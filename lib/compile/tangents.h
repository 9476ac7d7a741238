/* tangents.h: derivatives of a program along directions, forward through its tape
 *
 * The partial derivatives of each instruction are found once where the numbers stand. Directions
 * are carried through them several at once, a lane each, with bounds of what rounding leaves open
 * where these are asked for; what no direction moves is passed over. */
#ifndef COTREE_COMPILE_TANGENTS_H
#define COTREE_COMPILE_TANGENTS_H

#include "compile/program.h"

enum { TANGENT_BATCH = 8 };

typedef struct Tangents Tangents;

/* New; borrows the program; tangents_free(). */
Tangents *tangents_new(const Program *program);
void tangents_free(Tangents *tangents); /* NULL is fine */
/* Evaluate at these inputs, which may be off by `errors`; NULL: no bounds are wanted. Directions
 * are 0. */
void tangents_at(Tangents *tangents, const double *inputs, const double *errors);
/* Let all directions be 0. */
void tangents_clear(Tangents *tangents);
/* A root there; *error, as below. */
double tangents_value(const Tangents *tangents, int root, double *error);
/* How an input moves along the direction of a lane, and how far that may be off. */
void tangents_move(Tangents *tangents, int lane, int input, double by, double error);
void tangents_run(Tangents *tangents); /* O(instructions that move) */
/* The derivative of a root along the direction of a lane; *error: how far it may be off, 0 where no
 * bounds are wanted; NULL: not asked for. */
double tangents_root(const Tangents *tangents, int root, int lane, double *error);

#endif
