/* pace.h: a run in real time
 *
 * It waits after each step until as much time has passed as in the run, so that an observer sees
 * the motion at its true speed. That needs steps of known cost: fixed ones. The report counts whole
 * steps, and not the parts into which switches divide them. */
#ifndef COTREE_SIMULATE_RUN_PACE_H
#define COTREE_SIMULATE_RUN_PACE_H

#include "base/call_monitor.h"

#include <stdint.h>

typedef struct Pace {
    double step;         /* requested step of the run, s */
    double began, from;  /* time of the clock and of the run at its start, s */
    double last, before; /* likewise at the start of the current step */
    /* what comes out */
    double worst, worst_at; /* longest duration of a step over its length; its time, s */
    double delay;           /* largest delay against the clock at the end of a step, s */
    int64_t late;           /* steps that took longer than their length */
} Pace;

/* Start the run now, at `from`. */
Pace pace_begin(double step, double from);
/* Called when a step has ended at t: wait for the clock. Returns early when `watch` requests a
 * stop. */
void pace_wait(Pace *pace, double t, const CallMonitor *watch);

#endif
