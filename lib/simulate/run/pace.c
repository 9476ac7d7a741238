/* pace.c: a run in real time */
#include "simulate/run/pace.h"

#include "base/clock.h"
#include "simulate/run/run_limits.h"

#include <math.h>
#include <time.h>

static void sleep_for(double duration)
{
    const struct timespec span = {.tv_sec = (time_t)duration,
                                  .tv_nsec = (long)(1e9 * (duration - floor(duration)))};

    (void)nanosleep(&span, NULL); /* a signal ends it: the caller checks the clock */
}

Pace pace_begin(double step, double from)
{
    const double now = clock_now();

    return (Pace){.step = step, .began = now, .from = from, .last = now, .before = from};
}

void pace_wait(Pace *pace, double t, const CallMonitor *watch)
{
    const double due = pace->began + (t - pace->from);
    const double now = clock_now(), took = now - pace->last, length = t - pace->before;
    double left;

    if (length < PACE_WHOLE_STEP * pace->step)
        return;
    if (took > pace->worst * length) {
        pace->worst = took / length;
        pace->worst_at = pace->before;
    }
    pace->late += took > length;
    pace->delay = fmax(pace->delay, now - due);
    while ((left = due - clock_now()) > 0 && monitor_poll(watch) == OK)
        sleep_for(fmin(left, PACE_CHECK));
    pace->last = clock_now();
    pace->before = t;
}
