/* plot_sweep.h: `plot sweep`: the figures of many runs over their parameters */
#ifndef COTREE_SRC_PLOT_SWEEP_H
#define COTREE_SRC_PLOT_SWEEP_H

#include "drawing.h"

/* whether a statement asks for that */
bool plot_is_of_sweep(const ct_statement *statement);
ct_status plot_sweep(Call *call, const char *path, ct_error *error);

#endif
