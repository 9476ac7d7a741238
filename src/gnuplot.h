/* gnuplot.h: one running gnuplot process, connected by pipes
 *
 * The first plot starts it, and it runs until the end, so that windows remain open. If it was
 * killed, the next plot starts another. */
#ifndef COTREE_SRC_GNUPLOT_H
#define COTREE_SRC_GNUPLOT_H

#include "cotree.h"

typedef struct Gnuplot Gnuplot;

/* Start it where none runs. Which: $GNUPLOT, else the one found when cotree was built. */
ct_status gnuplot_start(Gnuplot **gnuplot, ct_error *error);
bool gnuplot_has_terminal(const Gnuplot *gnuplot, const char *terminal);

/* Execute commands and wait for their end: when it returns, files are complete. `*printed`: its
 * standard output; `*warnings`: its messages without an error; both new, free(). CT_FAILED with
 * gnuplot's own message when it reported an error, or when it ended. */
ct_status gnuplot_do(Gnuplot *gnuplot, const char *commands, char **printed, char **warnings,
                     ct_error *error);
void gnuplot_close(Gnuplot *gnuplot); /* NULL is fine */

#endif
