/* pace.h: a run that keeps up with the clock
 *
 * It waits behind each step until as much time has gone by outside as within the run, so that what
 * looks on sees the motion as it would be. That needs steps whose work is known beforehand: fixed
 * ones. How well it went is told, by steps and not by the parts into which switches cut them. */
#ifndef COTREE_SIMULATE_RUN_PACE_H
#define COTREE_SIMULATE_RUN_PACE_H

#include "base/call_monitor.h"

#include <stdint.h>

typedef struct Pace {
    double step;         /* that the run was asked to take, s */
    double began, from;  /* times of the clock and of the run at its start, s */
    double last, before; /* likewise where the step under way began */
    /* what comes out */
    double worst, worst_at; /* the longest that a step took, as a part of its length; and when, s */
    double behind;          /* most that the run was behind the clock at the end of a step, s */
    int64_t late;           /* steps that took longer than they are */
} Pace;

/* The run begins now, at `from`. */
Pace pace_begin(double step, double from);
/* A step ended at t: wait for the clock. Returns early when `watch` asks to stop. */
void pace_wait(Pace *pace, double t, const CallMonitor *watch);

#endif
