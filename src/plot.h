/* plot.h: what a plot shows: curves, in panels of up to two axes */
#ifndef COTREE_SRC_PLOT_H
#define COTREE_SRC_PLOT_H

#include "drawing.h"

/* Items of one run share a table: column 0 is t, or the frequency. */
typedef struct PlotBlock {
    char *run; /* "run2", or "" for the last */
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
/* gnuplot's commands, data included: a Drawing's `put` */
void plot_put(FILE *out, const Drawing *drawing, bool as_text);

#endif
