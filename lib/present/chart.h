/* chart.h: curves over axes, with characters
 *
 * Curves are of dots, as picture.h draws them; axes, ticks and legend are text around them. Where
 * there is more than one, each carries a letter, since there may be no colours. */
#ifndef COTREE_PRESENT_CHART_H
#define COTREE_PRESENT_CHART_H

#include "base/text.h"

typedef struct ChartCurve {
    const double *x, *y;
    int count, stride; /* from one number to the next, of both */
    double x_scale;    /* x is drawn times this */
    const char *label;
    bool is_points; /* measured: not joined */
    bool is_right;  /* on the right axis */
} ChartCurve;

typedef struct ChartMark { /* a line upright */
    double x;
    const char *name; /* "" none */
} ChartMark;

typedef struct Chart {
    const char *title, *x_label; /* "" none */
    const char *y_label[2];      /* left, right; "" none */
    double x[2], y[2];           /* NAN: what the curves need; y of the left axis */
    bool x_is_log, y_is_log;
    bool has_equal_scales, fits_x; /* of x no more than the data */
    const ChartCurve *curves;
    int count;
    const ChartMark *marks;
    int mark_count;
} Chart;

/* Charts above one another, their axes of x in line, in so many characters; no less than 20 columns
 * and 8 rows each. Braille where `unicode`. */
void chart_text(const Chart *charts, int count, int columns, int rows, bool unicode, Text *out);

#endif
