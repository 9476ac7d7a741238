/* plot_text.c: a plot with characters: a chart for each panel */
#include "copy.h"
#include "plot.h"

#include <math.h>
#include <stdlib.h>

/* a chart, and what it borrows */
typedef struct Panel {
    ct_curve *curves;
    double *marks;
    const char **names;
    char *labels[2];
} Panel;

static void add_curves(const Plot *plot, int number, Panel *panel, ct_chart *chart)
{
    panel->curves = check_allocated(calloc((size_t)plot->count + 1, sizeof *panel->curves));
    for (int i = 0; i < plot->count; i++) {
        const PlotCurve *curve = &plot->curves[i];
        const PlotBlock *block = &plot->blocks[curve->block];

        if (curve->panel == number)
            panel->curves[chart->count++] =
                (ct_curve){.x = block->values + plot_x_column(plot, block),
                           .y = block->values + curve->column,
                           .count = block->rows,
                           .stride = block->columns,
                           .x_scale = plot->versus == NULL ? plot->time_scale : 1,
                           .label = plot_label(plot, i),
                           .is_points = curve->measured,
                           .is_right = curve->right};
    }
    chart->curves = panel->curves;
}

/* lines where events happened, named once, in the uppermost panel */
static void add_marks(const Plot *plot, int number, Panel *panel, ct_chart *chart)
{
    const double *times;
    const char *name;
    int count, all = 0;

    for (int b = 0; b < plot->blocks_count; b++)
        for (int i = 0; plot_event(plot, &plot->blocks[b], i, &name, &times, &count); i++)
            all += count;
    panel->marks = check_allocated(calloc((size_t)all + 1, sizeof *panel->marks));
    panel->names = check_allocated(calloc((size_t)all + 1, sizeof *panel->names));
    for (int b = 0; b < plot->blocks_count; b++)
        for (int i = 0; plot_event(plot, &plot->blocks[b], i, &name, &times, &count); i++)
            for (int k = 0; k < count; k++) {
                panel->marks[chart->mark_count] = times[k] * plot->time_scale;
                panel->names[chart->mark_count++] = k == 0 && number == 0 ? name : "";
            }
    chart->marks = panel->marks;
    chart->mark_names = panel->names;
}

char *plot_text(const Drawing *drawing, int columns, int rows, bool unicode)
{
    const Plot *plot = drawing->of;
    ct_chart *charts = check_allocated(calloc((size_t)plot->panels + 1, sizeof *charts));
    Panel *panels = check_allocated(calloc((size_t)plot->panels + 1, sizeof *panels));

    for (int i = 0; i < plot->panels; i++) {
        ct_chart *chart = &charts[i];

        for (int side = 0; side < 2; side++)
            panels[i].labels[side] = plot_axis_label(plot, i, side == 1);
        *chart = (ct_chart){.title = i == 0 ? drawing->title : "",
                            .x_label = i == plot->panels - 1 ? plot_x_label(plot) : "",
                            .left_label = panels[i].labels[0] != NULL ? panels[i].labels[0] : "",
                            .right_label = panels[i].labels[1] != NULL ? panels[i].labels[1] : "",
                            .x = {plot->keys.x[0], plot->keys.x[1]},
                            .y = {plot->keys.y[0], plot->keys.y[1]},
                            .x_is_log = plot->keys.x_is_log,
                            .y_is_log = plot->keys.y_is_log,
                            .has_equal_scales = plot->equal_scales,
                            .fits_x = plot->versus == NULL};
        add_curves(plot, i, &panels[i], chart);
        add_marks(plot, i, &panels[i], chart);
    }

    char *text = ct_chart_text(charts, plot->panels, columns, rows, unicode);

    for (int i = 0; i < plot->panels; i++) {
        free(panels[i].curves);
        free(panels[i].marks);
        free(panels[i].names);
        free(panels[i].labels[0]);
        free(panels[i].labels[1]);
    }
    free(panels);
    free(charts);
    return text;
}
