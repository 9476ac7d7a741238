/* progress.h: what long work is doing, on a terminal and after a second only */
#ifndef COTREE_SRC_PROGRESS_H
#define COTREE_SRC_PROGRESS_H

#include <stdbool.h>

typedef struct Progress {
    bool allowed;
    bool shown;
    char phase[40];
    double phase_began; /* s, as all times here, on a clock of no matter which start */
    double began;
    double last;
} Progress;

void progress_begin(Progress *progress, bool allowed);
/* fraction 0..1, or below 0 where unknown; cheap when called often */
void progress_show(Progress *progress, const char *phase, double fraction);
void progress_end(Progress *progress); /* erases the line */

#endif
