/* process.h: a child process, with pipes to its standard input, output and error
 *
 * It gets a process group of its own, so that Ctrl-C stops our work and not it. */
#ifndef COTREE_SRC_PROCESS_H
#define COTREE_SRC_PROCESS_H

#include "copy.h"
#include "cotree.h"

#include <sys/types.h>

typedef struct Process {
    pid_t pid; /* 0: none runs */
    int in;    /* its standard input; -1: closed */
    int out;   /* its standard output */
    int err;   /* its standard error */
    int ended; /* wait status, once pid is 0 */
} Process;

/* Start argv[0] (searched in PATH). CT_FAILED when it can't be started. */
ct_status process_start(Process *process, char *const argv[], ct_error *error);
/* Whether it still runs; reaps it when not. */
bool process_lives(Process *process);

/* Write `input`, and read the output until both streams end with `mark` and an end of line (NULL:
 * close the input and read until both end). The marks are removed. CT_STOPPED after Ctrl-C;
 * CT_FAILED when it ended before the marks. */
ct_status process_exchange(Process *process, const char *input, size_t length, const char *mark,
                           OutputBuffer *out, OutputBuffer *err, ct_error *error);

/* Close the pipes and wait up to `patience` milliseconds, then end it the hard way. Returns its
 * wait status. */
int process_end(Process *process, int patience);
/* how it ended, in words: "exit status 1", "killed by signal 9"; into `text` of 40 characters */
const char *process_ending(int ended, char text[40]);

#endif
