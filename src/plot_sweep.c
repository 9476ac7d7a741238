/* plot_sweep.c: the figures of many runs over their parameters, a panel each
 *
 * The first parameter that varies is the axis. Runs that differ in others are curves of a family,
 * coloured from the first to the last; with map=on the second one is an axis, too, and colours and
 * contours show the figure. A Monte Carlo is drawn as histograms. */
#include "plot_sweep.h"
#include "copy.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct SweepCurve {
    double *x, *y;
    int count;
    int figure; /* a column */
    int member; /* of the family, from 0 */
    char *label;
} SweepCurve;

typedef struct SweepPlot {
    ct_plot keys;
    ct_column *columns; /* parameters, then figures */
    int column_count, parameters, rows;
    bool is_random;
    char **labels;  /* of columns, with their units */
    int varying[2]; /* the first two parameters that vary; -1: none */
    int varying_count;
    int members;        /* curves of a figure */
    SweepCurve *curves; /* by figure */
    int curve_count;
} SweepPlot;

static int figures_of(const SweepPlot *plot)
{
    return plot->column_count - plot->parameters;
}

static void plot_free(SweepPlot *plot)
{
    for (int i = 0; i < plot->curve_count; i++) {
        free(plot->curves[i].x);
        free(plot->curves[i].y);
        free(plot->curves[i].label);
    }
    free(plot->curves);
    for (int c = 0; plot->labels != NULL && c < plot->column_count; c++)
        free(plot->labels[c]);
    free(plot->labels);
    ct_columns_free(plot->columns);
}

/* --- data --- */

static void find_varying(SweepPlot *plot)
{
    plot->varying[0] = plot->varying[1] = -1;
    for (int c = 0; c < plot->parameters; c++) {
        bool varies = false;

        for (int r = 1; r < plot->rows; r++)
            varies = varies || plot->columns[c].values[r] != plot->columns[c].values[0];
        if (varies && plot->varying_count++ < 2)
            plot->varying[plot->varying_count - 1] = c;
    }
    if (plot->varying[0] < 0)
        plot->varying[0] = 0;
}

/* whether two runs are on one curve: all parameters but that of the axis agree */
static bool are_together(const SweepPlot *plot, int a, int b)
{
    for (int c = 0; c < plot->parameters; c++)
        if (c != plot->varying[0] && plot->columns[c].values[a] != plot->columns[c].values[b])
            return false;
    return true;
}

/* "m = 2 kg, k = 1" of the parameters that vary but for the axis: new */
static char *member_label(const SweepPlot *plot, int row)
{
    OutputBuffer label;
    int count = 0;

    output_buffer_open(&label);
    for (int c = 0; c < plot->parameters; c++) {
        const ct_column *column = &plot->columns[c];
        bool varies = false;

        for (int r = 1; r < plot->rows; r++)
            varies = varies || column->values[r] != column->values[0];
        if (c != plot->varying[0] && varies)
            fprintf(label.out, "%s%s = %.4g%s%s", count++ > 0 ? ", " : "", column->name,
                    column->values[row], column->unit[0] != '\0' ? " " : "", column->unit);
    }
    return output_buffer_close(&label);
}

static void add_point(SweepCurve *curve, double x, double y)
{
    int k = curve->count++;

    /* in the order of x */
    for (; k > 0 && curve->x[k - 1] > x; k--) {
        curve->x[k] = curve->x[k - 1];
        curve->y[k] = curve->y[k - 1];
    }
    curve->x[k] = x;
    curve->y[k] = y;
}

static SweepCurve *add_curve(SweepPlot *plot, int figure, int member, int room)
{
    SweepCurve *curve;

    plot->curves = check_allocated(
        realloc(plot->curves, ((size_t)plot->curve_count + 1) * sizeof *plot->curves));
    curve = &plot->curves[plot->curve_count++];
    *curve = (SweepCurve){.x = check_allocated(calloc((size_t)room + 1, sizeof(double))),
                          .y = check_allocated(calloc((size_t)room + 1, sizeof(double))),
                          .figure = figure,
                          .member = member};
    return curve;
}

static void make_families(SweepPlot *plot)
{
    int *member = check_allocated(calloc((size_t)plot->rows + 1, sizeof *member));
    int *first = check_allocated(calloc((size_t)plot->rows + 1, sizeof *first));

    for (int r = 0; r < plot->rows; r++) {
        int m = 0;

        while (m < plot->members && !are_together(plot, first[m], r))
            m++;
        if (m == plot->members)
            first[plot->members++] = r;
        member[r] = m;
    }
    for (int f = plot->parameters; f < plot->column_count; f++)
        for (int m = 0; m < plot->members; m++) {
            SweepCurve *curve = add_curve(plot, f, m, plot->rows);

            curve->label = member_label(plot, first[m]);
            for (int r = 0; r < plot->rows; r++)
                if (member[r] == m && isfinite(plot->columns[f].values[r]))
                    add_point(curve, plot->columns[plot->varying[0]].values[r],
                              plot->columns[f].values[r]);
        }
    free(member);
    free(first);
}

/* Steps of a histogram, with as many intervals as the cube root of the count gives (Rice's rule).
 */
static void make_histograms(SweepPlot *plot)
{
    plot->members = 1;
    for (int f = plot->parameters; f < plot->column_count; f++) {
        const double *values = plot->columns[f].values;
        double least = INFINITY, most = -INFINITY;
        int finite = 0, bins;
        SweepCurve *curve;

        for (int r = 0; r < plot->rows; r++)
            if (isfinite(values[r])) {
                finite++;
                least = fmin(least, values[r]);
                most = fmax(most, values[r]);
            }
        bins = most > least ? (int)ceil(2 * cbrt(finite)) : 1;
        if (finite > 0 && !(most > least)) {
            const double room = least != 0 ? fabs(least) * 1e-3 : 1;

            least -= room;
            most += room;
        }
        curve = add_curve(plot, f, 0, 2 * bins + 2);
        curve->label = copy_text("");
        if (finite == 0)
            continue;
        curve->count = 2 * bins + 2;
        for (int b = 0; b <= bins; b++) {
            const double edge = least + (most - least) * b / bins;

            curve->x[2 * b] = curve->x[2 * b + 1] = edge;
        }
        for (int r = 0; r < plot->rows; r++)
            if (isfinite(values[r])) {
                int b = (int)((values[r] - least) / (most - least) * bins);

                b = b < bins ? b : bins - 1;
                curve->y[2 * b + 1]++;
                curve->y[2 * b + 2]++;
            }
    }
}

static void label_columns(SweepPlot *plot)
{
    plot->labels = check_allocated(calloc((size_t)plot->column_count + 1, sizeof *plot->labels));
    for (int c = 0; c < plot->column_count; c++)
        plot->labels[c] = plot->columns[c].unit[0] != '\0'
                              ? copy_format("%s [%s]", plot->columns[c].name, plot->columns[c].unit)
                              : copy_text(plot->columns[c].name);
}

/* --- gnuplot --- */

/* a colour of the family's k-th of n, from violet by blue and green to ochre */
static const char *family_color(int k, int n, char out[8])
{
    static const double anchors[4][3] = {
        {68, 1, 84}, {49, 104, 142}, {53, 183, 121}, {203, 178, 43}};
    const double place = n > 1 ? 3.0 * k / (n - 1) : 1;
    const int below = place >= 3 ? 2 : (int)place;
    int rgb[3];

    for (int i = 0; i < 3; i++)
        rgb[i] = (int)(anchors[below][i] +
                       (place - below) * (anchors[below + 1][i] - anchors[below][i]) + 0.5);
    (void)snprintf(out, 8, "#%02x%02x%02x", (unsigned)rgb[0] & 255U, (unsigned)rgb[1] & 255U,
                   (unsigned)rgb[2] & 255U);
    return out;
}

enum { MOST_NAMED = 12 }; /* curves in a legend; of more, a few */

static void write_curve_data(FILE *out, const SweepPlot *plot)
{
    for (int i = 0; i < plot->curve_count; i++) {
        fprintf(out, "$c%d << end\n", i);
        for (int k = 0; k < plot->curves[i].count; k++)
            fprintf(out, "%.17g %.17g\n", plot->curves[i].x[k], plot->curves[i].y[k]);
        fputs("end\n", out);
    }
}

static void write_label(FILE *out, const char *axis, const char *label)
{
    fprintf(out, "set %slabel ", axis);
    write_quoted(out, label);
    fputs(" noenhanced\n", out);
}

static void write_panel(FILE *out, const SweepPlot *plot, int figure)
{
    const char *sign = "plot";

    write_label(out, "x", plot->labels[plot->is_random ? figure : plot->varying[0]]);
    write_label(out, "y", plot->is_random ? "runs" : plot->labels[figure]);
    for (int i = 0; i < plot->curve_count; i++) {
        const SweepCurve *curve = &plot->curves[i];
        const bool is_named =
            plot->members > 1 &&
            (plot->members <= MOST_NAMED || curve->member == 0 ||
             curve->member == plot->members - 1 || curve->member % ((plot->members + 5) / 6) == 0);
        char color[8];

        if (curve->figure != figure || curve->count == 0)
            continue;
        fprintf(out, "%s $c%d using 1:2 with %s", sign, i,
                plot->is_random ? "filledcurves y1=0" : "linespoints");
        if (is_named) {
            fputs(" title ", out);
            write_quoted(out, curve->label);
            fputs(" noenhanced", out);
        } else {
            fputs(" notitle", out);
        }
        if (plot->is_random)
            fprintf(out, " fillcolor rgb '%s'", drawing_color(0));
        else
            fprintf(out, " linewidth 1.5 pointtype 7 pointsize 0.5 linecolor rgb '%s'",
                    plot->members > 1 ? family_color(curve->member, plot->members, color)
                                      : drawing_color(0));
        sign = ",";
    }
    fputs(*sign == ',' ? "\n" : "plot [0:1] [0:1] 1/0 notitle\n", out);
}

static void write_map(FILE *out, const SweepPlot *plot, int figure)
{
    write_label(out, "x", plot->labels[plot->varying[0]]);
    write_label(out, "y", plot->labels[plot->varying[1]]);
    write_label(out, "cb", plot->labels[figure]);
    fprintf(out, "$m%d << end\n", figure);
    for (int r = 0; r < plot->rows; r++) {
        const double x = plot->columns[plot->varying[0]].values[r];

        if (r > 0 && x != plot->columns[plot->varying[0]].values[r - 1])
            fputc('\n', out);
        fprintf(out, "%.17g %.17g ", x, plot->columns[plot->varying[1]].values[r]);
        if (isfinite(plot->columns[figure].values[r]))
            fprintf(out, "%.17g\n", plot->columns[figure].values[r]);
        else
            fputs("NaN\n", out);
    }
    fprintf(out,
            "end\nset pm3d map corners2color mean interpolate 4,4\nset contour base\n"
            "set cntrparam levels auto 8\nset cntrlabel onecolor\n"
            "set palette defined (0 '#440154', 1 '#31688e', 2 '#35b779', 3 '#fde725')\n"
            "splot $m%d using 1:2:3 with pm3d nocontour notitle, $m%d using 1:2:3 with lines "
            "nosurface linecolor rgb '#ffffff' notitle\n",
            figure, figure);
}

static void write_axis(FILE *out, const char *axis, const double range[2], bool is_log)
{
    if (is_log)
        fprintf(out, "set logscale %s\n", axis);
    if (!isnan(range[0]))
        fprintf(out, "set %srange [%.17g:%.17g]\n", axis, range[0], range[1]);
}

static void write_commands(FILE *out, const Drawing *drawing)
{
    const SweepPlot *plot = drawing->of;
    const bool is_alone = figures_of(plot) == 1;

    if (!plot->keys.map)
        write_curve_data(out, plot);
    fputs("set border 3\nset tics nomirror\nset key outside right top Left reverse\n", out);
    fputs(plot->keys.map ? "set style fill solid 1 noborder\n"
                         : "set style fill solid 0.6\n"
                           "set grid linetype 1 linecolor '#e0e0e0' linewidth 0.7\n",
          out);
    write_axis(out, "x", plot->keys.x, plot->keys.x_is_log);
    write_axis(out, "y", plot->keys.y, plot->keys.y_is_log);
    if (plot->is_random && isnan(plot->keys.y[0]) && !plot->keys.y_is_log)
        fputs("set yrange [0:*]\n", out);
    if (is_alone) {
        write_title(out, drawing->title);
    } else {
        fprintf(out, "set lmargin 12\nset multiplot layout %d,1", figures_of(plot));
        if (*drawing->title != '\0') {
            fputs(" title ", out);
            write_quoted(out, drawing->title);
            fputs(" noenhanced", out);
        }
        fputc('\n', out);
    }
    for (int f = plot->parameters; f < plot->column_count; f++)
        if (plot->keys.map)
            write_map(out, plot, f);
        else
            write_panel(out, plot, f);
    if (!is_alone)
        fputs("unset multiplot\n", out);
}

/* --- characters --- */

static char *draw_text(const Drawing *drawing, int columns, int rows, bool unicode)
{
    const SweepPlot *plot = drawing->of;
    ct_chart *charts = check_allocated(calloc((size_t)figures_of(plot) + 1, sizeof *charts));
    ct_curve *curves = check_allocated(calloc((size_t)plot->curve_count + 1, sizeof *curves));
    char *text;

    for (int i = 0; i < plot->curve_count; i++)
        curves[i] = (ct_curve){.x = plot->curves[i].x,
                               .y = plot->curves[i].y,
                               .count = plot->curves[i].count,
                               .stride = 1,
                               .x_scale = 1,
                               .label = plot->members > 1 ? plot->curves[i].label : ""};
    for (int f = 0; f < figures_of(plot); f++) {
        const int column = plot->parameters + f;

        charts[f] = (ct_chart){.title = f == 0 ? drawing->title : "",
                               .x_label = plot->labels[plot->is_random ? column : plot->varying[0]],
                               .left_label = plot->is_random ? "runs" : plot->labels[column],
                               .right_label = "",
                               .x = {plot->keys.x[0], plot->keys.x[1]},
                               .y = {plot->keys.y[0], plot->keys.y[1]},
                               .x_is_log = plot->keys.x_is_log,
                               .y_is_log = plot->keys.y_is_log,
                               .fits_x = true,
                               .curves = curves + (ptrdiff_t)f * plot->members,
                               .count = plot->members};
    }
    text = ct_chart_text(charts, figures_of(plot), columns, rows, unicode);
    free(charts);
    free(curves);
    return text;
}

/* --- the command --- */

bool plot_is_of_sweep(const ct_statement *statement)
{
    const char *word =
        ct_operand_count(statement) == 1 ? ct_expression_word(ct_operand(statement, 0)) : NULL;

    return word != NULL && strcmp(word, "sweep") == 0;
}

static ct_status check(const Call *call, const SweepPlot *plot, ct_error *error)
{
    const ct_expression *versus = ct_versus(call->statement);
    bool has_figure = false;

    if (versus != NULL) {
        (void)ct_error_at(call->statement, versus, error, "a sweep is drawn over its parameters");
        error_hint(error, "the first parameter of the sweep is the axis");
        return CT_FAILED;
    }
    for (int f = plot->parameters; f < plot->column_count; f++)
        for (int r = 0; r < plot->rows; r++)
            has_figure = has_figure || isfinite(plot->columns[f].values[r]);
    if (!has_figure)
        return ct_error_at(call->statement, NULL, error, "no run of the sweep has a figure");
    if (plot->keys.map && (plot->is_random || plot->varying_count != 2)) {
        (void)ct_error_at(call->statement, ct_key_value(call->statement, "map"), error,
                          "a map is drawn of a sweep of two parameters");
        error_hint(error, "sweep L=range(1, 2, 20) m=range(1, 5, 20) keep=[..] : simulate 5");
        return CT_FAILED;
    }
    return CT_OK;
}

ct_status plot_sweep(Call *call, const char *path, ct_error *error)
{
    SweepPlot plot = {.members = 0};
    ct_status status = ct_plot_keys(call->session, call->statement, &plot.keys, error);

    if (status == CT_OK)
        status = ct_sweep_columns(call->session, call->shell->settings.units, &plot.columns,
                                  &plot.column_count, &plot.parameters, &plot.rows, &plot.is_random,
                                  error);
    if (status == CT_OK) {
        find_varying(&plot);
        label_columns(&plot);
        status = check(call, &plot, error);
    }
    if (status == CT_OK) {
        if (plot.is_random)
            make_histograms(&plot);
        else
            make_families(&plot);

        const Drawing drawing = {.put = write_commands,
                                 .text = draw_text,
                                 .of = &plot,
                                 .title = plot.keys.title,
                                 .height =
                                     figures_of(&plot) > 1 ? 100 + 280.0 * figures_of(&plot) : 0};

        status = drawing_make(call, &drawing, path, error);
    }
    plot_free(&plot);
    return status;
}
