/* progress.c: what long work is doing, on a terminal and after a second only */
#include "progress.h"

#include "cotree.h"
#include "interrupt.h"
#include "terminal.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double PATIENCE = 1; /* s before the first word */
static const double PAUSE = 0.1;  /* s between two */

void progress_begin(Progress *progress, bool allowed)
{
    *progress = (Progress){.allowed = allowed && isatty(STDERR_FILENO) && !terminal_is_dumb()};
    progress->began = progress->phase_began = ct_clock();
}

static void write_duration(double seconds)
{
    if (seconds < 60)
        fprintf(stderr, "%.0f s", seconds);
    else if (seconds < 3600)
        fprintf(stderr, "%.0f min %02.0f s", (double)(int)(seconds / 60),
                (double)((int)seconds % 60));
    else
        fprintf(stderr, "%.1f h", seconds / 3600);
}

void progress_show(Progress *progress, const char *phase, double fraction)
{
    if (!progress->allowed)
        return;

    double now = ct_clock();

    if (strncmp(phase, progress->phase, sizeof progress->phase - 1) != 0) {
        snprintf(progress->phase, sizeof progress->phase, "%s", phase);
        progress->phase_began = now;
    }
    if (now - progress->began < PATIENCE || now - progress->last < PAUSE)
        return;
    progress->last = now;
    progress->shown = true;
    fprintf(stderr, "\r\033[K%s: ", progress->phase);
    if (fraction >= 0) {
        fprintf(stderr, "%.*f %%", fraction < 0.1 ? 1 : 0, 100 * fraction);
        if (fraction > 1e-6) {
            fputs(", ", stderr);
            write_duration((now - progress->phase_began) * (1 - fraction) / fraction);
            fputs(" to go", stderr);
        }
    } else {
        write_duration(now - progress->began);
    }
    fputs(" (Ctrl-C stops)", stderr);
    fflush(stderr);
}

void progress_end(Progress *progress)
{
    if (progress->shown)
        fputs("\r\033[K", stderr);
    else if (progress->allowed && interrupt_asked())
        fputc('\n', stderr); /* the terminal has written ^C */
    progress->shown = progress->allowed = false;
}
