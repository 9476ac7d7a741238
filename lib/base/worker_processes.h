/* worker_processes.h: work in pieces, in processes that are copies of the calling one
 *
 * A piece may do anything but wait for user input: nothing that it changes reaches the caller, and
 * if it crashes, only that piece is lost. Pieces are assigned in their order, each to the process
 * that is free first. Their results arrive in any order, and the caller stores them by number: then
 * they are the same for any number of processes. The caller's other threads must not hold locks
 * that a piece needs. */
#ifndef COTREE_BASE_WORKER_PROCESSES_H
#define COTREE_BASE_WORKER_PROCESSES_H

#include <stdbool.h>
#include <stddef.h>

enum { MOST_WORKERS = 64 };

typedef struct WorkPlan {
    int first, end; /* pieces: from the first to before the end */
    int workers;    /* at most MOST_WORKERS are started */
    size_t size;    /* bytes of a result */
    /* in a worker: fills `result`, which is zeroed. What it leaves allocated is kept until the end.
     */
    void (*piece)(void *context, int which, void *result);
    void (*take)(void *context, int which, const void *result); /* in the caller */
    void (*lose)(void *context, int which, const char *why);    /* in the caller: it crashed */
    bool (*stop)(
        void *context); /* in the caller, now and then: ends the workers; results are kept */
    void *context;
} WorkPlan;

/* Do the pieces. Some may be left, neither taken nor lost, if the system refuses processes, or
 * after a stop. */
void worker_processes_do(const WorkPlan *plan);
int worker_processes_available(void); /* processors that the system has for this process */

#endif
