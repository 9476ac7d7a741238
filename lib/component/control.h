/* control.h: shared by control blocks: limits, sampling, states
 *
 * A block is a voltage source whose value is a command over signals and states of its own. A
 * sampled block stores the command of the last sampling instant in a state. Its other states change
 * by their `next` instead of their rates. */
#ifndef COTREE_COMPONENT_CONTROL_H
#define COTREE_COMPONENT_CONTROL_H

#include "component/component_rows.h"

/* clang-format off */
#define BLOCK_PARAMS \
    {"limits", PARAM_LIST,   "V", "",  "the least and the largest output, [lo, hi]", false}, \
    {"period", PARAM_SCALAR, "s", "0", "sampled at multiples of it, and held; continuous if not given", false}
#define BLOCK_MEMBERS \
    {"held", "V", "the output since the last sampling instant, with period=", 1}
/* clang-format on */

bool block_is_sampled(const Instance *instance);
Expr block_state(const Instance *instance, Arena *arena, const char *member);
/* limited to the block's limits, where it has some */
Expr block_limited(const Instance *instance, Arena *arena, Expr command);
void block_relation(const Instance *instance, Arena *arena, Expr command, Relation *out);
/* number of states; `inner` of them are the block's own, sampled or not */
int block_state_count(const Instance *instance, int inner);
/* `out` contains the continuous state and the `next` of the sampled one: removes the one that does
 * not apply */
void block_choose(const Instance *instance, Arena *arena, OwnState *out);
/* the state after the block's own: the command, constant between sampling instants */
void block_held(const Instance *instance, Arena *arena, Expr command, OwnState *out);
MUST_USE Status block_check(const Instance *instance, Diag *diag);

#endif
