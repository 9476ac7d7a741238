/* plot.c: `plot ITEM... [vs ITEM] [> "file"]`, drawn by gnuplot
 *
 * A file's extension determines the format. Without a file the picture is shown in a window if
 * there is a display; else the library draws it with characters, as large as the terminal. The
 * commands contain the data, so `plot ... > "fig.gp"` writes a script that needs nothing else. */
#include "plot.h"
#include "copy.h"
#include "plot_sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- data --- */

static bool is_name_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.';
}

/* the run that an expression names: new; "" when none */
static char *find_run(const ct_expression *expression)
{
    char *text = check_allocated(ct_expression_text(expression));
    char *run = NULL;

    for (const char *at = strstr(text, "run"); at != NULL && run == NULL;
         at = strstr(at + 1, "run")) {
        size_t digits = strspn(at + 3, "0123456789");

        if (digits > 0 && at[3 + digits] == '.' && (at == text || !is_name_letter(at[-1])))
            run = copy_piece(at, 3 + digits);
    }
    ct_free(text);
    return run != NULL ? run : copy_text("");
}

/* data of a file, drawn as they were measured */
static bool is_measured(const ct_expression *expression)
{
    char *text = check_allocated(ct_expression_text(expression));
    bool is_table = strncmp(text + strspn(text, "("), "table(", 6) == 0;

    ct_free(text);
    return is_table;
}

/* Assign a curve to every item, and a block to every named run. */
static void lay_out_curves(Plot *plot, const ct_statement *statement)
{
    int bars = 0;

    plot->count = ct_operand_count(statement);
    plot->curves = check_allocated(calloc((size_t)plot->count + 1, sizeof *plot->curves));
    plot->blocks = check_allocated(calloc((size_t)plot->count + 1, sizeof *plot->blocks));
    for (int i = 0; i < plot->count; i++) {
        char *run = find_run(ct_operand(statement, i));
        const bool measured = is_measured(ct_operand(statement, i));
        int block = 0;

        while (block < plot->blocks_count && (measured || plot->blocks[block].measured ||
                                              strcmp(plot->blocks[block].run, run) != 0))
            block++;
        if (block == plot->blocks_count)
            plot->blocks[plot->blocks_count++] = (PlotBlock){.run = run, .measured = measured};
        else
            free(run);
        bars += ct_operand_sign(statement, i) == '|';
        plot->curves[i] = (PlotCurve){
            .block = block, .group = plot->keys.panels ? i : bars, .measured = measured};
    }
}

/* An item without a unit is shown in that of its dimension, if this is known. */
static void label_columns(const Call *call, PlotBlock *block, const ct_expression *const *items)
{
    block->labels = check_allocated(calloc((size_t)block->columns + 1, sizeof *block->labels));
    for (int j = 0; j < block->columns; j++) {
        const char *name = j == 1 && block->caption != NULL ? block->caption : block->names[j];
        double size = 1;
        char *unit =
            j > 0 && plot_unit(name)[0] == '\0'
                ? ct_unit_in(call->session, items[j - 1], call->shell->settings.units, &size)
                : NULL;
        const size_t room = strlen(name) + (unit != NULL ? strlen(unit) : 0) + 4;

        for (int i = 0; i < block->rows && size != 1; i++)
            block->values[i * block->columns + j] /= size;
        block->labels[j] = check_allocated(malloc(room));
        (void)snprintf(block->labels[j], room, unit != NULL ? "%s [%s]" : "%s", name, unit);
        ct_free(unit);
    }
}

/* Over time, measured data are plotted at their own times, not at the output points of the run. */
static ct_status take_measured(const Call *call, const ct_expression *item, PlotBlock *block,
                               ct_error *error)
{
    double *values = NULL;
    char *name = NULL;
    int rows = 0;
    ct_status status = ct_measured(call->session, item, &values, &rows, &name, error);

    if (status == CT_OK && values != NULL && rows == 0)
        status = ct_error_at(call->statement, item, error, "the run meets no point of %s", name);
    if (status == CT_OK && values != NULL) {
        const char *unit = plot_unit(block->names[1]);

        ct_free(block->values);
        block->values = values;
        block->rows = rows;
        block->caption = copy_format("%s%s%s", name, *unit != '\0' ? " " : "", unit);
    } else if (status != CT_OK) {
        ct_free(values);
    }
    ct_free(name);
    return status;
}

static ct_status fill_block(const Call *call, Plot *plot, int number, ct_error *error)
{
    PlotBlock *block = &plot->blocks[number];
    const ct_expression **items = check_allocated(calloc((size_t)plot->count + 2, sizeof *items));
    int count = 0;

    for (int i = 0; i < plot->count; i++)
        if (plot->curves[i].block == number) {
            items[count++] = ct_operand(call->statement, i);
            plot->curves[i].column = count;
        }
    if (plot->versus != NULL)
        items[count++] = plot->versus;

    ct_status status = ct_table(call->session, items, count, 0, &block->values, &block->rows,
                                &block->columns, &block->names, error);

    if (status == CT_OK && block->rows < 2) {
        ct_error_at(call->statement, NULL, error, "there is no run to plot");
        error_hint(error, "simulate 1");
        status = CT_FAILED;
    }
    if (status == CT_OK && block->measured && plot->versus == NULL)
        status = take_measured(call, items[0], block, error);
    if (status == CT_OK)
        label_columns(call, block, items);
    free(items);
    return status;
}

/* What t is shown in, of `vs t [ms]`. The unit's size is that of the run's end in it. */
static ct_status find_time_unit(const Call *call, const ct_expression *versus, Plot *plot,
                                ct_error *error)
{
    double *values = NULL;
    char **names = NULL;
    int rows, columns;
    ct_status status =
        ct_table(call->session, &versus, 1, 0, &values, &rows, &columns, &names, error);

    if (status != CT_OK)
        return status;
    if (strcmp(names[1], "t") != 0 && values[2 * (rows - 1)] != 0) {
        plot->time_scale = values[2 * (rows - 1) + 1] / values[2 * (rows - 1)];
        free(plot->time_label);
        plot->time_label = copy_text(names[1]);
    }
    ct_free(values);
    ct_words_free(names);
    return CT_OK;
}

/* a length over a length, in one unit */
static bool is_path(const Call *call, const Plot *plot)
{
    char *unit = plot->versus != NULL ? ct_unit(call->session, plot->versus) : NULL;
    bool out = unit != NULL && strcmp(unit, "m") == 0;

    ct_free(unit);
    for (int i = 0; out && i < plot->count; i++) {
        const PlotBlock *block = &plot->blocks[plot->curves[i].block];

        out = strcmp(plot_unit(plot_label(plot, i)),
                     plot_unit(block->labels[block->columns - 1])) == 0;
    }
    return out;
}

#define SEEN 0.01 /* relative to the largest amplitude: smaller tones don't extend the axis */
#define ROOM 1.5  /* of the axis, times the highest frequency seen */

static bool is_spectral(const PlotBlock *block)
{
    return strcmp(block->names[0], "f") == 0;
}

/* as far as there is anything to be seen */
static double last_seen(const Plot *plot)
{
    double last = 0;

    for (int b = 0; b < plot->blocks_count; b++) {
        const PlotBlock *block = &plot->blocks[b];

        for (int j = 1; j < block->columns; j++) {
            double most = 0;

            for (int i = 1; i < block->rows; i++)
                most = fmax(most, block->values[i * block->columns + j]);
            for (int i = 1; i < block->rows; i++)
                if (block->values[i * block->columns + j] > SEEN * most)
                    last = fmax(last, block->values[i * block->columns]);
        }
    }
    return last;
}

/* spectra are over frequency, all of them or none */
static ct_status lay_out_spectra(const Call *call, Plot *plot, ct_error *error)
{
    int spectral = 0;

    for (int b = 0; b < plot->blocks_count; b++)
        spectral += is_spectral(&plot->blocks[b]);
    if (spectral == 0)
        return CT_OK;
    if (spectral < plot->blocks_count || ct_versus(call->statement) != NULL) {
        ct_error_at(call->statement, ct_versus(call->statement), error,
                    "spectra are over frequency, and are drawn over nothing else");
        error_hint(error, "plot spectrum(run1.h8) spectrum(run2.h8)");
        return CT_FAILED;
    }
    plot->spectral = true;
    free(plot->time_label);
    plot->time_label = copy_text("f [Hz], window of Hann");
    if (isnan(plot->keys.x[0]) && !plot->keys.x_is_log && !plot->keys.y_is_log &&
        last_seen(plot) > 0) {
        plot->keys.x[0] = 0;
        plot->keys.x[1] = ROOM * last_seen(plot);
    }
    return CT_OK;
}

static ct_status gather(const Call *call, Plot *plot, ct_error *error)
{
    ct_status status = CT_OK;
    const ct_expression *versus = ct_versus(call->statement);
    const char *word = versus != NULL ? ct_expression_word(versus) : NULL;
    bool over_time = versus == NULL || (word != NULL && strcmp(word, "t") == 0);

    plot->versus = over_time ? NULL : versus;
    plot->time_label = copy_text("t [s]");
    plot->time_scale = 1;
    lay_out_curves(plot, call->statement);
    for (int i = 0; i < plot->blocks_count && status == CT_OK; i++)
        status = fill_block(call, plot, i, error);
    if (status == CT_OK)
        status = lay_out_spectra(call, plot, error);
    if (status == CT_OK && over_time && versus != NULL)
        status = find_time_unit(call, versus, plot, error);
    if (status == CT_OK)
        plot->equal_scales = is_path(call, plot);
    return status;
}

static void plot_free(Plot *plot)
{
    for (int i = 0; i < plot->blocks_count; i++) {
        free(plot->blocks[i].run);
        ct_free(plot->blocks[i].values);
        ct_words_free(plot->blocks[i].names);
        for (int j = 0; plot->blocks[i].labels != NULL && j < plot->blocks[i].columns; j++)
            free(plot->blocks[i].labels[j]);
        free(plot->blocks[i].labels);
        free(plot->blocks[i].caption);
    }
    free(plot->blocks);
    free(plot->curves);
    free(plot->time_label);
}

/* --- the command --- */

static ct_status plot(Call *call, const char *path, ct_error *error)
{
    Plot plot = {.session = call->session};
    ct_status status;

    if (plot_is_of_sweep(call->statement))
        return plot_sweep(call, path, error);
    status = ct_plot_keys(call->session, call->statement, &plot.keys, error);
    if (status == CT_OK && plot.keys.map) {
        (void)ct_error_at(call->statement, ct_key_value(call->statement, "map"), error,
                          "map= is of a sweep's table");
        error_hint(error, "plot sweep map=on");
        status = CT_FAILED;
    }
    if (status == CT_OK)
        status = gather(call, &plot, error);
    if (status == CT_OK) {
        plot_lay_out(&plot);

        const Drawing drawing = {.put = plot_write,
                                 .text = plot_text,
                                 .of = &plot,
                                 .title = plot.keys.title,
                                 .height = plot.panels > 2 ? 100 + 250.0 * plot.panels : 0};

        status = drawing_make(call, &drawing, path, error);
    }
    plot_free(&plot);
    return status;
}

/* as if that statement had been typed */
static ct_status plot_text_of(Call *call, const char *text, const char *path, ct_error *error)
{
    ct_statement *last = NULL;
    ct_cursor cursor = {.text = text, .line = 1};
    ct_error why;
    ct_status status = ct_parse(&cursor, true, &last, &why);
    Call again = *call;

    again.statement = last;
    if (status == CT_OK)
        status = plot(&again, path, &why);
    if (status != CT_OK) {
        /* the place is that of `last`, whose text is not on this line */
        ct_error_at(call->statement, ct_operand(call->statement, 0), error, "%s", why.message);
        error->status = status;
        error_hint(error, "%s", why.hint);
    }
    ct_statement_free(last);
    return status;
}

/* `plot last`: the same again, of the model as it is now */
static ct_status plot_again(Call *call, const char *path, ct_error *error)
{
    if (call->shell->last_plot == NULL)
        return ct_error_at(call->statement, ct_operand(call->statement, 0), error,
                           "nothing was plotted yet");
    return plot_text_of(call, call->shell->last_plot, path, error);
}

static ct_status plot_fit(Call *call, const char *path, ct_error *error)
{
    ct_error why;
    char *text = ct_fit_plot(call->session, &why);
    ct_status status;

    if (text == NULL)
        return ct_error_at(call->statement, ct_operand(call->statement, 0), error, "%s",
                           why.message);
    status = plot_text_of(call, text, path, error);
    ct_free(text);
    return status;
}

static ct_status command_plot(Call *call, ct_error *error)
{
    const ct_statement *statement = call->statement;
    const char *word = call_word(call, 0);
    const char *path = NULL;
    ct_status status;

    if (ct_operand_count(statement) == 0)
        return ct_error_at(statement, NULL, error, "plot what? plot h8 h8'");
    status = drawing_check(call, &path, error);
    if (status != CT_OK)
        return status;
    if (word != NULL && strcmp(word, "last") == 0 && ct_operand_count(statement) == 1)
        return plot_again(call, path, error);
    if (word != NULL && strcmp(word, "fit") == 0 && ct_operand_count(statement) == 1)
        return plot_fit(call, path, error);

    status = plot(call, path, error);
    if (status == CT_OK) {
        free(call->shell->last_plot);
        call->shell->last_plot = copy_text(ct_statement_text(statement));
    }
    return status;
}

const Command commands_plot[] = {
    {"plot", command_plot, NULL, WRITES | UNPAGED},
    {NULL, NULL, NULL, 0},
};
