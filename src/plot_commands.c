/* plot_commands.c: a plot as gnuplot's commands: its panels, axes, curves and marks */
#include "copy.h"
#include "plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- panels --- */

const char *plot_unit(const char *label)
{
    const char *open = strrchr(label, '[');

    return open != NULL && label[strlen(label) - 1] == ']' ? open : "";
}

const char *plot_label(const Plot *plot, int curve)
{
    const PlotCurve *c = &plot->curves[curve];

    return plot->blocks[c->block].labels[c->column];
}

/* That of a curve, in brackets; an unknown one is assumed to be that of its neighbours. */
static const char *unit_of(const Plot *plot, int curve)
{
    const char *unit = plot_unit(plot_label(plot, curve));

    for (int i = 0; *unit == '\0' && i < plot->count; i++)
        if (plot->curves[i].group == plot->curves[curve].group)
            unit = plot_unit(plot_label(plot, i));
    return unit;
}

static bool same_unit(const Plot *plot, int a, int b)
{
    return strcmp(unit_of(plot, a), unit_of(plot, b)) == 0;
}

/* the first curve of the same group and unit */
static int first_alike(const Plot *plot, int curve)
{
    int i = 0;

    while (plot->curves[i].group != plot->curves[curve].group || !same_unit(plot, i, curve))
        i++;
    return i;
}

/* how many units a group has, and the place of the curve's among them */
static int count_units(const Plot *plot, int curve, int *place)
{
    int count = 0;

    for (int i = 0; i < plot->count; i++) {
        if (plot->curves[i].group != plot->curves[curve].group || first_alike(plot, i) != i)
            continue;
        if (same_unit(plot, i, curve))
            *place = count;
        count++;
    }
    return count;
}

void plot_lay_out(Plot *plot)
{
    int group = -1, units = 0;

    for (int i = 0; i < plot->count; i++) {
        int place = 0;

        if (plot->curves[i].group != group) {
            plot->panels += group < 0 ? 0 : units > 2 ? units : 1;
            group = plot->curves[i].group;
        }
        units = count_units(plot, i, &place);
        plot->curves[i].panel = plot->panels + (units > 2 ? place : 0);
        plot->curves[i].right = units == 2 && place == 1;
    }
    plot->panels += units > 2 ? units : 1;
}

/* --- labels --- */

/* what is measured so, for an axis of too many names */
static const char *find_quantity(const char *unit)
{
    static const char *const quantities[][2] = {{"[m]", "position"},
                                                {"[mm]", "position"},
                                                {"[m/s]", "velocity"},
                                                {"[m/s^2]", "acceleration"},
                                                {"[rad]", "angle"},
                                                {"[deg]", "angle"},
                                                {"[rad/s]", "angular velocity"},
                                                {"[rad/s^2]", "angular acceleration"},
                                                {"[N]", "force"},
                                                {"[N*m]", "torque"},
                                                {"[V]", "voltage"},
                                                {"[A]", "current"},
                                                {"[W]", "power"},
                                                {"[J]", "energy"},
                                                {"[Pa]", "pressure"},
                                                {"[m^3/s]", "flow"},
                                                {"[K]", "temperature"}};

    for (size_t i = 0; i < sizeof quantities / sizeof quantities[0]; i++)
        if (strcmp(quantities[i][0], unit) == 0)
            return quantities[i][1];
    return "value";
}

enum { LONGEST = 34 }; /* characters of the names at an axis */

/* Names of an axis's curves that have a unit, or have none that is known: new; "" none. */
static char *join_names(const Plot *plot, int panel, bool right, bool known)
{
    OutputBuffer names;
    int count = 0;

    output_buffer_open(&names);
    for (int i = 0; i < plot->count; i++) {
        const char *label = plot_label(plot, i);
        const PlotCurve *curve = &plot->curves[i];
        size_t length = strlen(label) - strlen(plot_unit(label));

        if (curve->panel != panel || curve->right != right || (*plot_unit(label) != '\0') != known)
            continue;
        while (length > 0 && label[length - 1] == ' ')
            length--;
        fprintf(names.out, "%s%.*s", count++ > 0 ? ", " : "", (int)length, label);
    }
    return output_buffer_close(&names);
}

static const char *unit_of_axis(const Plot *plot, int panel, bool right)
{
    for (int i = 0; i < plot->count; i++)
        if (plot->curves[i].panel == panel && plot->curves[i].right == right)
            return unit_of(plot, i);
    return "";
}

char *plot_axis_label(const Plot *plot, int panel, bool right)
{
    char *known = join_names(plot, panel, right, true);
    char *others = join_names(plot, panel, right, false);
    const char *unit = unit_of_axis(plot, panel, right);
    const char *quantity = find_quantity(unit);
    char *out = NULL;

    /* names with known unit, then the others; the quantity replaces a list that is too long */
    if (strlen(known) + strlen(others) > LONGEST)
        out = copy_format("%s%s%s", quantity, *unit != '\0' ? " " : "", unit);
    else if (*known != '\0' || *others != '\0')
        out =
            copy_format("%s%s%s%s%s", known, *known != '\0' ? " " : "", *known != '\0' ? unit : "",
                        *known != '\0' && *others != '\0' ? ", " : "", others);
    free(known);
    free(others);
    return out;
}

static int curves_of(const Plot *plot, int panel)
{
    int count = 0;

    for (int i = 0; i < plot->count; i++)
        count += plot->curves[i].panel == panel;
    return count;
}

static void write_axis_label(FILE *out, const Plot *plot, int panel, bool right)
{
    char *label = plot_axis_label(plot, panel, right);

    fprintf(out, label != NULL ? "set %slabel " : "unset %slabel\n", right ? "y2" : "y");
    if (label != NULL) {
        write_quoted(out, label);
        fputs(" noenhanced\n", out);
    }
    if (right)
        fprintf(out,
                label != NULL ? "set y2tics\nset border 11\n" : "unset y2tics\nset border 3\n");
    free(label);
}

static void write_range(FILE *out, const char *axis, const double range[2])
{
    if (isnan(range[0]))
        fprintf(out, "set autoscale %s\n", axis);
    else
        fprintf(out, "set %srange [%.17g:%.17g]\n", axis, range[0], range[1]);
}

/* --- data --- */

int plot_x_column(const Plot *plot, const PlotBlock *block)
{
    return plot->versus != NULL ? block->columns - 1 : 0;
}

const char *plot_x_label(const Plot *plot)
{
    const PlotBlock *block = &plot->blocks[0];

    return plot->versus != NULL ? block->labels[plot_x_column(plot, block)] : plot->time_label;
}

static void write_blocks(FILE *out, const Plot *plot)
{
    for (int b = 0; b < plot->blocks_count; b++) {
        const PlotBlock *block = &plot->blocks[b];

        fprintf(out, "$block%d << end\n", b);
        for (int i = 0; i < block->rows; i++)
            for (int j = 0; j < block->columns; j++)
                fprintf(out, "%.17g%c",
                        block->values[i * block->columns + j] * (j == 0 ? plot->time_scale : 1),
                        j == block->columns - 1 ? '\n' : ' ');
        fputs("end\n", out);
    }
}

/* --- events --- */

enum { MOST_MARKS = 40 }; /* of an event: more would be a wall */

bool plot_event(const Plot *plot, const PlotBlock *block, int i, const char **name,
                const double **times, int *count)
{
    const int run = *block->run != '\0' ? (int)strtol(block->run + 3, NULL, 10) : 0;

    if (plot->versus != NULL || plot->spectral || block->measured)
        return false;
    *name = ct_run_event(plot->session, run, i, times, count);
    if (*name != NULL && *count > MOST_MARKS)
        *count = 0;
    return *name != NULL;
}

/* Names of events next to their lines, in rows in which they overlap less. */
enum { NAME_ROWS = 6 };

typedef struct EventNames {
    double first, last; /* of the axis of t */
    bool is_log;
    double end[NAME_ROWS];         /* of the last name in a row, as parts of the axis */
    const char *latest[NAME_ROWS]; /* that name */
} EventNames;

#define LETTER   0.0085 /* a letter, as a part of the axis */
#define ROW_HIGH 0.045  /* height of a row relative to a single panel */

static EventNames names_over(const Plot *plot)
{
    EventNames out = {.first = INFINITY, .last = -INFINITY, .is_log = plot->keys.x_is_log};

    for (int b = 0; b < plot->blocks_count; b++) {
        const PlotBlock *block = &plot->blocks[b];

        if (block->measured)
            continue;
        out.first = fmin(out.first, block->values[0] * plot->time_scale);
        out.last =
            fmax(out.last, block->values[(block->rows - 1) * block->columns] * plot->time_scale);
    }
    if (!isnan(plot->keys.x[0])) {
        out.first = plot->keys.x[0];
        out.last = plot->keys.x[1];
    }
    return out;
}

static double part_of_axis(const EventNames *names, double t)
{
    return names->is_log ? log(t / names->first) / log(names->last / names->first)
                         : (t - names->first) / (names->last - names->first);
}

/* Where it covers no other name, at the left of its line where there is no room at the right. */
static void write_name(FILE *out, const Plot *plot, EventNames *names, const char *name, double t)
{
    const double at = part_of_axis(names, t), wide = LETTER * ((double)strlen(name) + 2);
    const bool left = at + wide > 1;
    const double from = left ? at - wide : at;
    int row = 0;

    while (row < NAME_ROWS && names->latest[row] != NULL && from < names->end[row]) {
        if (strcmp(names->latest[row], name) == 0)
            return;
        row++;
    }
    if (row == NAME_ROWS || !(at >= 0 && at <= 1))
        return;
    names->latest[row] = name;
    names->end[row] = from + wide;
    fputs("set label ", out);
    write_quoted(out, name);
    fprintf(out,
            " at first %.17g, graph %.3g %s offset %s0.5,0 noenhanced textcolor rgb '#606060'\n", t,
            0.98 - ROW_HIGH * row * plot->panels, left ? "right" : "left", left ? "-" : "");
}

typedef struct Mark {
    double t;
    const char *name;
} Mark;

static int compare_marks(const void *a, const void *b)
{
    const Mark *p = a, *q = b;

    return p->t < q->t ? -1 : p->t > q->t;
}

/* A line at each instant; the first of each event of a run is named, from left to right. */
static void write_events(FILE *out, const Plot *plot, bool named)
{
    EventNames names = names_over(plot);
    Mark *marks = NULL;
    const double *times;
    const char *name;
    int count, all = 0;

    fputs("unset arrow\nunset label\n", out);
    for (int b = 0; b < plot->blocks_count; b++)
        for (int i = 0; plot_event(plot, &plot->blocks[b], i, &name, &times, &count); i++) {
            for (int k = 0; k < count; k++)
                fprintf(out,
                        "set arrow from first %.17g, graph 0 to first %.17g, graph 1 nohead back "
                        "linecolor rgb '#909090' dashtype 3\n",
                        times[k] * plot->time_scale, times[k] * plot->time_scale);
            if (count == 0)
                continue;
            marks = check_allocated(realloc(marks, (size_t)(all + 1) * sizeof *marks));
            marks[all++] = (Mark){times[0] * plot->time_scale, name};
        }
    if (all > 0)
        qsort(marks, (size_t)all, sizeof *marks, compare_marks);
    for (int i = 0; named && i < all; i++)
        write_name(out, plot, &names, marks[i].name, marks[i].t);
    free(marks);
}

/* --- panels as commands --- */

static void write_curve(FILE *out, const Plot *plot, int i)
{
    const PlotCurve *curve = &plot->curves[i];
    const int x = plot_x_column(plot, &plot->blocks[curve->block]) + 1;

    fprintf(out, "$block%d using %d:%d axes x1y%d with %s title ", curve->block, x,
            curve->column + 1, curve->right ? 2 : 1, curve->measured ? "points" : "lines");
    write_quoted(out, plot_label(plot, i));
    fprintf(out, " linecolor rgb '%s'", drawing_color(i));
    if (curve->measured)
        fputs(" pointtype 6 pointsize 0.8", out);
    else
        fprintf(out, " linewidth 1.5 dashtype %d", drawing_dash(i));
}

static void write_panel(FILE *out, const Plot *plot, int panel)
{
    bool last = panel == plot->panels - 1, first = true;

    fputs(curves_of(plot, panel) > 1
              ? "set key noenhanced outside top left horizontal Left reverse samplen 2\n"
              : "unset key\n",
          out);
    write_events(out, plot, panel == 0);
    fputs(last ? "set xlabel " : "unset xlabel\n", out);
    if (last) {
        write_quoted(out, plot_x_label(plot));
        fputs(" noenhanced\n", out);
    }
    write_axis_label(out, plot, panel, false);
    write_axis_label(out, plot, panel, true);
    for (int i = 0; i < plot->count; i++) {
        if (plot->curves[i].panel != panel)
            continue;
        fputs(first ? "plot " : ", ", out);
        write_curve(out, plot, i);
        first = false;
    }
    fputc('\n', out);
}

static void write_scales(FILE *out, const Plot *plot)
{
    write_range(out, "x", plot->keys.x);
    write_range(out, "y", plot->keys.y);
    if (plot->versus == NULL && isnan(plot->keys.x[0]))
        fputs("set autoscale xfix\n", out);
    if (plot->keys.x_is_log)
        fputs("set logscale x\n", out);
    if (plot->keys.y_is_log)
        fputs("set logscale y\nset logscale y2\n", out);
    if (plot->equal_scales)
        fputs("set size ratio -1\n", out);
}

/* whether gnuplot labels that curve's axis with powers of ten, which need space */
static bool has_powers(const Plot *plot, int i)
{
    const PlotCurve *curve = &plot->curves[i];
    const PlotBlock *block = &plot->blocks[curve->block];
    double least = INFINITY, largest = 0;

    for (int r = 0; r < block->rows; r++) {
        const double size = fabs(block->values[r * block->columns + curve->column]);

        largest = fmax(largest, isfinite(size) ? size : 0);
        least = size > 0 ? fmin(least, size) : least;
    }
    return largest >= 1e6 || (largest > 0 && largest < 1e-3) ||
           (plot->keys.y_is_log && least < 1e-4);
}

/* width in characters next to the panels, for numbers and the label of an axis; 0: no axis there */
static int margin_for(const Plot *plot, bool right)
{
    enum { PLAIN = 11, POWERS = 16 };
    int margin = 0;

    for (int i = 0; i < plot->count; i++)
        if (plot->curves[i].right == right && margin < POWERS)
            margin = has_powers(plot, i) ? POWERS : PLAIN;
    return margin;
}

void plot_write(FILE *out, const Drawing *drawing)
{
    const Plot *plot = drawing->of;
    const int right = margin_for(plot, true);

    write_blocks(out, plot);
    if (plot->panels == 1)
        write_title(out, drawing->title);
    write_scales(out, plot);
    fputs(
        "set border 3\nset tics nomirror\nset grid linetype 1 linecolor '#e0e0e0' linewidth 0.7\n",
        out);
    if (plot->panels > 1) {
        fprintf(out, "set multiplot layout %d,1", plot->panels);
        if (*drawing->title != '\0') {
            fputs(" title ", out);
            write_quoted(out, drawing->title);
            fputs(" noenhanced", out);
        }
        /* the panels' axes of time are aligned */
        fprintf(out, "\nset lmargin %d\nset rmargin %d\n", margin_for(plot, false),
                right > 0 ? right : 3);
    }
    for (int i = 0; i < plot->panels; i++)
        write_panel(out, plot, i);
    if (plot->panels > 1)
        fputs("unset multiplot\n", out);
}
