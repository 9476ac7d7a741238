/* bode.c: `bode [OUTPUT...] [from=..] [to=..] [points=..] [> "file"]`, drawn by gnuplot
 *
 * Two panels over one axis of frequency: gain above, phase below. A file whose name ends in csv
 * gets the table. */
#include "copy.h"
#include "drawing.h"
#include "file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* column 0 is the frequency; gain and phase of each curve follow */
typedef struct Response {
    double *values;
    int rows;
    int columns;
    char **names;
} Response;

static void write_data(FILE *out, const Response *response)
{
    fputs("$response << end\n", out);
    for (int i = 0; i < response->rows; i++)
        for (int j = 0; j < response->columns; j++) {
            double value = response->values[i * response->columns + j];

            /* at a root on the imaginary axis the curve has a gap */
            if (isfinite(value))
                fprintf(out, "%.17g", value);
            else
                fputs("NaN", out);
            fputc(j == response->columns - 1 ? '\n' : ' ', out);
        }
    fputs("end\n", out);
}

/* new: "h8/V1" of "gain h8/V1 [dB]" */
static char *pair_name(const char *name)
{
    const char *first = strchr(name, ' ') + 1;

    return copy_piece(first, (size_t)(strrchr(name, '[') - first) - 1);
}

static void write_curves(FILE *out, const Response *response, int offset)
{
    for (int j = 1; j < response->columns; j += 2) {
        char *name = pair_name(response->names[j]);

        fprintf(out, "%s$response using 1:%d with lines title ", j == 1 ? "plot " : ", ",
                j + offset + 1);
        write_quoted(out, name);
        fprintf(out, " noenhanced linewidth 1.5 linecolor rgb '%s'", drawing_color(j / 2));
        free(name);
    }
    fputc('\n', out);
}

/* The first of some steps that divides an axis into at most six parts. For a span of less than a
 * step gnuplot chooses. */
static void write_axis(FILE *out, const Response *response, int first, const double steps[6])
{
    double least = INFINITY, most = -INFINITY;
    int i = 0;

    for (int r = 0; r < response->rows; r++)
        for (int j = first; j < response->columns; j += 2) {
            least = fmin(least, response->values[r * response->columns + j]);
            most = fmax(most, response->values[r * response->columns + j]);
        }
    while (i + 1 < 6 && (most - least) / steps[i] > 6)
        i++;
    if (most - least < steps[0])
        fputs("set ytics autofreq\n", out);
    else
        fprintf(out, "set ytics %g\n", steps[i]);
}

/* --- margins --- */

/* The first downward crossing of `level` by column j: the frequency, interpolated between rows on
 * the logarithmic axis, and the other column there. False if there is none. */
static bool find_crossing(const Response *response, int j, double level, int other,
                          double *frequency, double *value)
{
    for (int i = 1; i < response->rows; i++) {
        const double *a = response->values + (i - 1) * response->columns;
        const double *b = a + response->columns;

        if (!(a[j] >= level && b[j] < level))
            continue;

        const double s = (a[j] - level) / (a[j] - b[j]);

        *frequency = a[0] * pow(b[0] / a[0], s);
        *value = a[other] + s * (b[other] - a[other]);
        return true;
    }
    return false;
}

static void write_margin(FILE *out, const char *name, double value, const char *unit,
                         double frequency, double row)
{
    char text[96];

    (void)snprintf(text, sizeof text, "%s margin %.3g %s at %.3g Hz", name, value, unit, frequency);
    fputs("set label ", out);
    write_quoted(out, text);
    fprintf(out, " at graph 0.02, graph %g noenhanced textcolor rgb '#606060'\n", row);
    fprintf(out,
            "set arrow from first %.17g, graph 0 to first %.17g, graph 1 nohead back linecolor rgb "
            "'#909090' dashtype 3\n",
            frequency, frequency);
}

/* How far a loop of one curve is from where it would swing on: at the gain 1, and where the phase
 * is that of a change of sign. */
static void write_margins(FILE *out, const Response *response)
{
    double frequency, value;

    if (find_crossing(response, 1, 0, 2, &frequency, &value))
        write_margin(out, "phase", remainder(value + 180, 360), "deg", frequency, 0.18);
    if (find_crossing(response, 2, -180, 1, &frequency, &value))
        write_margin(out, "gain", -value, "dB", frequency, 0.08);
}

static void write_commands(FILE *out, const Drawing *drawing)
{
    const Response *response = drawing->of;
    bool is_alone = response->columns == 3;
    static const double decibels[6] = {5, 10, 20, 40, 60, 100};
    static const double degrees[6] = {15, 45, 90, 180, 360, 720};

    write_data(out, response);
    fputs("set multiplot layout 2,1\n", out);
    write_title(out, drawing->title);
    fprintf(out, "set logscale x\nset xrange [%.17g:%.17g]\nset lmargin 10\n", response->values[0],
            response->values[(response->rows - 1) * response->columns]);
    fputs("set border 3\nset tics nomirror\nset grid linetype 1 linecolor '#e0e0e0' linewidth "
          "0.7\nset format x '%h'\n",
          out);
    fputs(is_alone ? "set key off\n" : "set key inside bottom left Left reverse\n", out);
    if (is_alone)
        write_margins(out, response);
    fputs("set ylabel 'gain [dB]'\n", out);
    write_axis(out, response, 1, decibels);
    write_curves(out, response, 0);
    write_axis(out, response, 2, degrees);
    fputs("unset label\nset xlabel 'frequency [Hz]'\nunset title\nset key off\n"
          "set ylabel 'phase [deg]'\n",
          out);
    write_curves(out, response, 1);
    fputs("unset multiplot\n", out);
}

/* the same with characters */
static char *draw_text(const Drawing *drawing, int columns, int rows, bool unicode)
{
    const Response *response = drawing->of;
    const int count = (response->columns - 1) / 2;
    ct_curve *curves = check_allocated(calloc((size_t)count * 2 + 1, sizeof *curves));
    char **names = check_allocated(calloc((size_t)count + 1, sizeof *names));
    ct_chart charts[2];

    for (int i = 0; i < count; i++)
        names[i] = pair_name(response->names[2 * i + 1]);
    for (int half = 0; half < 2; half++) {
        for (int i = 0; i < count; i++)
            curves[half * count + i] = (ct_curve){.x = response->values,
                                                  .y = response->values + 2 * i + 1 + half,
                                                  .count = response->rows,
                                                  .stride = response->columns,
                                                  .x_scale = 1,
                                                  .label = names[i]};
        charts[half] = (ct_chart){.title = half == 0 ? drawing->title : "",
                                  .x_label = half == 1 ? "frequency [Hz]" : "",
                                  .left_label = half == 0 ? "gain [dB]" : "phase [deg]",
                                  .right_label = "",
                                  .x = {NAN, NAN},
                                  .y = {NAN, NAN},
                                  .x_is_log = true,
                                  .fits_x = true,
                                  .curves = curves + (ptrdiff_t)half * count,
                                  .count = count};
    }

    char *text = ct_chart_text(charts, 2, columns, rows, unicode);

    for (int i = 0; i < count; i++)
        free(names[i]);
    free(names);
    free(curves);
    return text;
}

static ct_status write_table(const Call *call, const char *path, bool append, ct_error *error)
{
    char *text = NULL;
    const char *rows;
    ct_status status = ct_bode_csv(call->session, call->statement, true, &text, error);
    ct_error why;

    if (status == CT_OK)
        status = csv_rows(call, text, &rows, error);
    if (status == CT_OK && file_write(path, rows, strlen(rows), append, &why) != CT_OK)
        status = ct_error_at(call->statement, NULL, error, "%s", why.message);
    ct_free(text);
    return status;
}

static bool has_curve(const Response *response)
{
    for (int i = 0; i < response->rows; i++)
        for (int j = 1; j < response->columns; j++)
            if (isfinite(response->values[i * response->columns + j]))
                return true;
    return false;
}

static ct_status command_bode(Call *call, ct_error *error)
{
    Response response = {0};
    const Drawing drawing = {.put = write_commands,
                             .text = draw_text,
                             .of = &response,
                             .title = ct_title(call->session)};
    bool append = false;
    const char *path = ct_redirect(call->statement, &append);
    ct_status status;

    if (path != NULL && strcmp(file_extension(path), "csv") == 0)
        return write_table(call, path, append, error);
    status = drawing_check(call, &path, error);
    if (status == CT_OK)
        status = ct_bode(call->session, call->statement, &response.values, &response.rows,
                         &response.columns, &response.names, error);
    if (status == CT_OK && !has_curve(&response))
        status = ct_error_at(call->statement, NULL, error,
                             "no curve to draw: what was asked for answers to no input");
    if (status == CT_OK)
        status = drawing_make(call, &drawing, path, error);
    ct_free(response.values);
    ct_words_free(response.names);
    return status;
}

const Command commands_bode[] = {
    {"bode", command_bode, NULL, WRITES | UNPAGED},
    {NULL, NULL, NULL, 0},
};
