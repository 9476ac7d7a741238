/* control.h: what control blocks share: limits, sampling, states
 *
 * A block is a voltage source whose value is a command over signals and states of its own. Sampled,
 * it holds the command of the last sampling instant in a state, and its other states move by their
 * `next` instead of their rates. */
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
/* between the limits, where there are some */
Expr block_limited(const Instance *instance, Arena *arena, Expr command);
void block_relation(const Instance *instance, Arena *arena, Expr command, Relation *out);
/* how many states, of which `inner` are the block's own in either case */
int block_state_count(const Instance *instance, int inner);
/* `out` as it is continuous, with `next` as it is sampled, becomes that of the two which counts */
void block_choose(const Instance *instance, Arena *arena, OwnState *out);
/* the state behind the block's own: the command, held */
void block_held(const Instance *instance, Arena *arena, Expr command, OwnState *out);
MUST_USE Status block_check(const Instance *instance, Diag *diag);

#endif
