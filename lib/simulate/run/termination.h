/* termination.h: why a run can't continue, in terms of the user's parts
 *
 * Ever shorter steps only show where it ends. The cause shows in forces and in growth: two frames
 * that coincide, an undefined force, rounding error, a singularity of the solution. */
#ifndef COTREE_SIMULATE_RUN_TERMINATION_H
#define COTREE_SIMULATE_RUN_TERMINATION_H

#include "simulate/run/mode_switch.h"

/* the Explain of a plan; `context` is a ModeSwitching */
void termination_diagnose(void *context, const Segment *segment, Stepper *stepper,
                          bool *is_rounding, Diag *diag);

#endif
