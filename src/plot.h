/* plot.h: what a plot shows: curves, in panels of up to two axes */
#ifndef COTREE_SRC_PLOT_H
#define COTREE_SRC_PLOT_H

#include "drawing.h"

/* Items of one run share a table: column 0 is t, or the frequency. Measured data have their own. */
typedef struct PlotBlock {
    char *run; /* "run2", or "" for the last */
    bool measured;
    char *caption; /* of measured data: "x (file.csv)"; else NULL */
    double *values;
    int rows;
    int columns;
    char **names;
    char **labels; /* the names, each with its unit in brackets */
} PlotBlock;

typedef struct PlotCurve {
    int block;
    int column;
    int group;     /* between bars */
    bool measured; /* points */
    int panel;
    bool right; /* on the right axis */
} PlotCurve;

typedef struct Plot {
    ct_session *session;
    ct_plot keys;
    const ct_expression *versus; /* NULL: t, each run's own */
    char *time_label;            /* of t */
    double time_scale;           /* to the unit of the label */
    PlotBlock *blocks;
    int blocks_count;
    PlotCurve *curves;
    int count;
    int panels;
    bool equal_scales; /* a length over a length */
    bool spectral;     /* column 0 is the frequency, Hz */
} Plot;

/* the unit in brackets at the end of a label, "" if none */
const char *plot_unit(const char *label);
const char *plot_label(const Plot *plot, int curve);
/* Two units share a panel; more get one each. */
void plot_lay_out(Plot *plot);
int plot_x_column(const Plot *plot, const PlotBlock *block);
const char *plot_x_label(const Plot *plot);
/* New: the names of an axis's curves, or their quantity, and the unit; NULL: it has no curves. */
char *plot_axis_label(const Plot *plot, int panel, bool right);
/* Events of a run at instants, in the unit of t: the i-th, rising; false: there are no more. What
 * happened too often to be marked is left out. */
bool plot_event(const Plot *plot, const PlotBlock *block, int i, const char **name,
                const double **times, int *count);
/* gnuplot's commands, data included, and characters: a Drawing's `put` and `text` */
void plot_write(FILE *out, const Drawing *drawing);
char *plot_text(const Drawing *drawing, int columns, int rows, bool unicode);

#endif
