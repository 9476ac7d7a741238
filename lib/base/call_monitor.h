/* call_monitor.h: long work reports progress and can be stopped
 *
 * The session hands a Watch down; long loops call poll(). A NULL watch never stops. */
#ifndef COTREE_BASE_CALL_MONITOR_H
#define COTREE_BASE_CALL_MONITOR_H

#include "base/diag.h"

#include <stddef.h>

typedef struct CallMonitor {
    void *context;
    bool (*stop)(void *context); /* whether to stop; cheap, e.g. reads a flag; may be NULL */
    /* fraction 0..1, or negative where unknown; may be NULL */
    void (*progress)(void *context, const char *phase, double fraction);
} CallMonitor;

/* OK, or E_STOPPED when the user has requested a stop. */
static inline Status monitor_poll(const CallMonitor *watch)
{
    return watch != NULL && watch->stop != NULL && watch->stop(watch->context) ? E_STOPPED : OK;
}

static inline void monitor_report(const CallMonitor *watch, const char *phase, double fraction)
{
    if (watch != NULL && watch->progress != NULL)
        watch->progress(watch->context, phase, fraction);
}

#endif
