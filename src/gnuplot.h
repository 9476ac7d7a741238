/* gnuplot.h: one living gnuplot, spoken to over pipes
 *
 * It is started by the first plot and kept, so that windows stay. When it was killed, the
 * next plot starts another. */
#ifndef COTREE_SRC_GNUPLOT_H
#define COTREE_SRC_GNUPLOT_H

#include "cotree.h"

typedef struct Gnuplot Gnuplot;

/* Start it where none runs. Which: $GNUPLOT, else the one found when cotree was built. */
ct_status gnuplot_start(Gnuplot **gnuplot, ct_error *error);
bool gnuplot_has_terminal(const Gnuplot *gnuplot, const char *terminal);

/* Have commands carried out, to the end: when it returns, files are complete. `*printed`: what
 * went to its standard output; `*warnings`: lines that it said without failing; both new, free().
 * CT_FAILED with gnuplot's own message when it complained, or when it ended. */
ct_status gnuplot_do(Gnuplot *gnuplot, const char *commands, char **printed, char **warnings,
                     ct_error *error);
void gnuplot_close(Gnuplot *gnuplot); /* NULL is fine */

#endif
