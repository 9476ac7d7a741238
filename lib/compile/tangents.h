/* tangents.h: derivatives of a program along directions, forward through its tape
 *
 * The partial derivatives of each instruction are computed once at the present inputs. Several
 * directions are propagated at once, one lane each, with bounds of rounding errors if requested.
 * Slots that no direction changes are skipped. */
#ifndef COTREE_COMPILE_TANGENTS_H
#define COTREE_COMPILE_TANGENTS_H

#include "compile/program.h"

enum { TANGENT_BATCH = 8 };

typedef struct Tangents Tangents;

/* New; borrows the program; tangents_free(). */
Tangents *tangents_new(const Program *program);
void tangents_free(Tangents *tangents); /* NULL is fine */
/* Evaluate at these inputs, known within `errors`; NULL: no error bounds. Directions become 0. */
void tangents_at(Tangents *tangents, const double *inputs, const double *errors);
/* Set all directions to 0. */
void tangents_clear(Tangents *tangents);
/* A root there; *error, as below. */
double tangents_value(const Tangents *tangents, int root, double *error);
/* The component of a lane's direction along an input, and its error bound. */
void tangents_move(Tangents *tangents, int lane, int input, double by, double error);
void tangents_run(Tangents *tangents); /* O(instructions that move) */
/* The derivative of a root along the direction of a lane; *error: its error bound, 0 without
 * bounds; NULL: not returned. */
double tangents_root(const Tangents *tangents, int root, int lane, double *error);

#endif
