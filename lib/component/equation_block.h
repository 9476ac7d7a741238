/* equation_block.h: equations that a subsystem is given, not derived from parts
 *
 * What moves its frames are coordinates of one part, a *block*, which deforms and whose root rests
 * on ground; every other unknown is a part of its own, which is 0 = equation in a network. */
#ifndef COTREE_COMPONENT_EQUATION_BLOCK_H
#define COTREE_COMPONENT_EQUATION_BLOCK_H

#include "component/component.h"

extern const Component component_block, component_unknown;

enum { GIVEN_POSE = 4 }; /* of a frame: x, y, z, and its turn about z */

/* All in the user's names. Owned by the pool that it was made in, and so are its arrays. */
typedef struct EquationBlock {
    /* of a block: mass q'' = force, in the order of its coordinates */
    int count;
    Expr *mass;  /* count x count, over coordinates, parameters and t; symmetric */
    Expr *force; /* over all variables */
    int frame_count;
    Expr *pose; /* frame_count x GIVEN_POSE, over coordinates and parameters */
    /* of an unknown */
    Expr equation; /* it is 0, of those of order 1 with NAME.v for NAME', of order 2 with NAME.rate
                      for NAME', NAME.v for NAME'', of others NAME.v for NAME itself */
    int order;     /* of its highest derivative: 0, 1, 2 */
} EquationBlock;

EquationBlock *equation_block_copy(Pool *pool, const EquationBlock *given); /* NULL: NULL */
bool equation_block_same(const EquationBlock *a, const EquationBlock *b);
bool equation_block_depends(const EquationBlock *given, Expr symbol); /* NULL: false */

#endif
