/* termination.h: why a run can't go on, in words of the user's parts
 *
 * Steps that get ever shorter tell no more than where. What is behind it is seen in what pushes
 * and in what grows: two frames that come together, a force without a value, what rounding leaves,
 * a solution that ends. */
#ifndef COTREE_SIMULATE_RUN_TERMINATION_H
#define COTREE_SIMULATE_RUN_TERMINATION_H

#include "simulate/run/mode_switch.h"

/* the Explain of a plan; `context` is a ModeSwitching */
void termination_diagnose(void *context, const Segment *segment, Stepper *stepper,
                          bool *is_rounding, Diag *diag);

#endif
