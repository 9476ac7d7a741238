/* sliding.h: across a surface that the equations jump on, off it, or along it
 *
 * The signs on all surfaces that a run stands on are such that each is at an end of -1 .. 1 and the
 * motion leaves to that side, or between them and the motion stays: a linear complementarity
 * problem with bounds (theory 8). */
#ifndef COTREE_SIMULATE_RUN_SLIDING_H
#define COTREE_SIMULATE_RUN_SLIDING_H

#include "simulate/run/mode_switch.h"

/* the Choose of a plan; `context` is a ModeSwitching */
MUST_USE Status slide_choose(void *context, double t, double low, double high, double *y,
                             const Meeting *at, int count, Segment *segment, SurfaceChoice *chosen,
                             Diag *diag);
/* Enter the phase in which a start at t, not yet of a motion, goes on from what it stands on: what
 * rests on a surface is held there or leaves it. Where that asks for an impact, or no side is
 * found, the phase is as it was, and a run says why. y is unchanged. */
MUST_USE Status slide_begin(ActiveRun *run, const SimulationInput *setting, double t,
                            const double *y, Diag *diag);
/* what a condition of a segment is about: "s' (actuator f)"; `context` is a ModeSwitching */
void sliding_report(void *context, const Segment *segment, int condition, Text *out);

#endif
