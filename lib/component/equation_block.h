/* equation_block.h: given equations of a subsystem, instead of derived ones
 *
 * The coordinates that move its frames belong to one part, a *block*. It is flexible, and its root
 * is fixed in ground. Every other unknown is a part of its own, with 0 = equation in a network. */
#ifndef COTREE_COMPONENT_EQUATION_BLOCK_H
#define COTREE_COMPONENT_EQUATION_BLOCK_H

#include "component/component.h"

extern const Component component_block, component_unknown;

enum { GIVEN_POSE = 4 }; /* of a frame's pose: x, y, z, and its turn about z */

/* All in the user's names. The pool of its creation owns it and its arrays. */
typedef struct EquationBlock {
    /* of a block: mass q'' = force, in the order of its coordinates */
    int count;
    Expr *mass;  /* count x count, over coordinates, parameters and t; symmetric */
    Expr *force; /* over all variables */
    int frame_count;
    Expr *pose; /* frame_count x GIVEN_POSE, over coordinates and parameters */
    /* of an unknown */
    /* 0 = equation. With order 1 it contains NAME.v for NAME'; with order 2 NAME.rate for NAME' and
     * NAME.v for NAME''; with order 0 NAME.v for NAME itself */
    Expr equation;
    int order; /* of its highest derivative: 0, 1, 2 */
} EquationBlock;

/* whether it is one of the unknowns that move no frame; its bare name is a variable */
bool instance_is_unknown(const Instance *instance);

EquationBlock *equation_block_copy(Pool *pool, const EquationBlock *given); /* of NULL: NULL */
bool equation_block_same(const EquationBlock *a, const EquationBlock *b);
bool equation_block_depends(const EquationBlock *given, Expr symbol); /* NULL: false */

#endif
