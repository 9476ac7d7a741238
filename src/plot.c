/* plot.c: `plot ITEM... [vs ITEM] [> "file"]`, drawn by gnuplot
 *
 * A file's extension says in which format. Without a file the picture goes into a window when
 * there is a display, else it is drawn with characters, as large as the terminal. The data
 * travel inside the commands, so `plot ... > "fig.gp"` writes a script that needs nothing else. */
#include "copy.h"
#include "drawing.h"

#include <stdlib.h>
#include <string.h>

/* --- data --- */

/* Items of one run share a table: column 0 is t. */
typedef struct PlotBlock {
    char *run; /* "run2", or "" for the last */
    double *values;
    int rows;
    int columns;
    char **names;
    char **labels; /* the names, each with its unit in brackets */
} PlotBlock;

typedef struct PlotCurve {
    int item;
    int block;
    int column;
} PlotCurve;

typedef struct Picture {
    const ct_expression *versus; /* NULL: t, each run's own */
    char *time_label;            /* of t */
    double time_scale;           /* to the unit of the label */
    PlotBlock *blocks;
    int blocks_count;
    PlotCurve *curves;
    int count;
} Picture;

static bool is_name_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.';
}

/* the run that an expression names: new; "" when none */
static char *find_run(const ct_expression *expression)
{
    char *text = copy_check(ct_expression_text(expression));
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

/* Give every item its curve, and every run that is named a block. */
static void lay_out_curves(Picture *picture, const ct_statement *statement)
{
    picture->count = ct_operand_count(statement);
    picture->curves = copy_check(calloc((size_t)picture->count + 1, sizeof *picture->curves));
    picture->blocks = copy_check(calloc((size_t)picture->count + 1, sizeof *picture->blocks));
    for (int i = 0; i < picture->count; i++) {
        char *run = find_run(ct_operand(statement, i));
        int block = 0;

        while (block < picture->blocks_count && strcmp(picture->blocks[block].run, run) != 0)
            block++;
        if (block == picture->blocks_count)
            picture->blocks[picture->blocks_count++].run = run;
        else
            free(run);
        picture->curves[i] = (PlotCurve){.item = i, .block = block};
    }
}

/* the unit in brackets at the end of a name, "" if none */
static const char *unit_of(const char *name)
{
    const char *open = strrchr(name, '[');

    return open != NULL && name[strlen(name) - 1] == ']' ? open : "";
}

/* What has no unit behind it is in that of its dimension, where this is known. */
static void label_columns(const Call *call, PlotBlock *block, const ct_expression *const *items)
{
    block->labels = copy_check(calloc((size_t)block->columns + 1, sizeof *block->labels));
    for (int j = 0; j < block->columns; j++) {
        const char *name = block->names[j];
        char *unit =
            j > 0 && unit_of(name)[0] == '\0' ? ct_unit(call->session, items[j - 1]) : NULL;
        const size_t room = strlen(name) + (unit != NULL ? strlen(unit) : 0) + 4;

        block->labels[j] = copy_check(malloc(room));
        (void)snprintf(block->labels[j], room, unit != NULL ? "%s [%s]" : "%s", name, unit);
        ct_free(unit);
    }
}

static ct_status fill_block(const Call *call, Picture *picture, int number, ct_error *error)
{
    PlotBlock *block = &picture->blocks[number];
    const ct_expression **items = copy_check(calloc((size_t)picture->count + 2, sizeof *items));
    int count = 0;

    for (int i = 0; i < picture->count; i++)
        if (picture->curves[i].block == number) {
            items[count++] = ct_operand(call->statement, i);
            picture->curves[i].column = count;
        }
    if (picture->versus != NULL)
        items[count++] = picture->versus;

    ct_status status = ct_table(call->session, items, count, 0, &block->values, &block->rows,
                                &block->columns, &block->names, error);

    if (status == CT_OK)
        label_columns(call, block, items);
    free(items);
    if (status == CT_OK && block->rows < 2) {
        ct_error_at(call->statement, NULL, error, "there is no run to plot");
        error_hint(error, "simulate 1");
        return CT_FAILED;
    }
    return status;
}

/* What t is shown in, of `vs t [ms]`. The unit's size is that of the run's end in it. */
static ct_status find_time_unit(const Call *call, const ct_expression *versus, Picture *picture,
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
        picture->time_scale = values[2 * (rows - 1) + 1] / values[2 * (rows - 1)];
        free(picture->time_label);
        picture->time_label = copy_text(names[1]);
    }
    ct_free(values);
    ct_words_free(names);
    return CT_OK;
}

static ct_status gather(const Call *call, Picture *picture, ct_error *error)
{
    ct_status status = CT_OK;
    const ct_expression *versus = ct_versus(call->statement);
    const char *word = versus != NULL ? ct_expression_word(versus) : NULL;
    bool over_time = versus == NULL || (word != NULL && strcmp(word, "t") == 0);

    picture->versus = over_time ? NULL : versus;
    picture->time_label = copy_text("t [s]");
    picture->time_scale = 1;
    lay_out_curves(picture, call->statement);
    for (int i = 0; i < picture->blocks_count && status == CT_OK; i++)
        status = fill_block(call, picture, i, error);
    if (status == CT_OK && over_time && versus != NULL)
        status = find_time_unit(call, versus, picture, error);
    return status;
}

static void picture_free(Picture *picture)
{
    for (int i = 0; i < picture->blocks_count; i++) {
        free(picture->blocks[i].run);
        ct_free(picture->blocks[i].values);
        ct_words_free(picture->blocks[i].names);
        for (int j = 0; picture->blocks[i].labels != NULL && j < picture->blocks[i].columns; j++)
            free(picture->blocks[i].labels[j]);
        free(picture->blocks[i].labels);
    }
    free(picture->blocks);
    free(picture->curves);
    free(picture->time_label);
}

/* --- commands --- */

static const char *curve_name(const Picture *picture, int i)
{
    const PlotCurve *curve = &picture->curves[i];

    return picture->blocks[curve->block].labels[curve->column];
}

static int x_column(const Picture *picture, const PlotBlock *block)
{
    return picture->versus != NULL ? block->columns - 1 : 0;
}

static void put_labels(FILE *out, const Picture *picture, bool as_text)
{
    const PlotBlock *first = &picture->blocks[0];
    const char *unit = unit_of(curve_name(picture, 0));

    fputs("set xlabel ", out);
    put_quoted(out, picture->versus != NULL ? first->labels[x_column(picture, first)]
                                            : picture->time_label);

    fprintf(out, " noenhanced\nset key noenhanced %s\n",
            as_text ? "below" : "outside right top Left reverse samplen 2");

    /* characters don't stand upright: the legend says it all */
    if (as_text)
        return;

    /* one curve names the axis; of several, the unit that they share */
    for (int i = 1; i < picture->count; i++)
        if (strcmp(unit_of(curve_name(picture, i)), unit) != 0)
            unit = "";
    fputs("set ylabel ", out);
    put_quoted(out, picture->count == 1 ? curve_name(picture, 0) : unit);
    fputs(" noenhanced\n", out);
    if (picture->count == 1)
        fputs("unset key\n", out);
}

static void put_blocks(FILE *out, const Picture *picture)
{
    for (int b = 0; b < picture->blocks_count; b++) {
        const PlotBlock *block = &picture->blocks[b];

        fprintf(out, "$block%d << end\n", b);
        for (int i = 0; i < block->rows; i++)
            for (int j = 0; j < block->columns; j++)
                fprintf(out, "%.17g%c",
                        block->values[i * block->columns + j] * (j == 0 ? picture->time_scale : 1),
                        j == block->columns - 1 ? '\n' : ' ');
        fputs("end\n", out);
    }
}

static void put_commands(FILE *out, const Drawing *drawing, bool as_text)
{
    const Picture *picture = drawing->of;

    put_blocks(out, picture);
    put_title(out, drawing->title);
    put_labels(out, picture, as_text);
    if (picture->versus == NULL)
        fputs("set autoscale xfix\n", out);
    if (!as_text)
        fputs("set border 3\nset tics nomirror\nset grid linetype 1 linecolor '#e0e0e0' linewidth "
              "0.7\n",
              out);
    for (int i = 0; i < picture->count; i++) {
        const PlotCurve *curve = &picture->curves[i];

        fprintf(out, "%s$block%d using %d:%d with lines title ", i == 0 ? "plot " : ", ",
                curve->block, x_column(picture, &picture->blocks[curve->block]) + 1,
                curve->column + 1);
        put_quoted(out, curve_name(picture, i));
        if (!as_text)
            fprintf(out, " linewidth 1.5 linecolor rgb '%s'", drawing_color(i));
    }
    fputc('\n', out);
}

/* --- the command --- */

static ct_status plot(Call *call, const char *path, ct_error *error)
{
    Picture picture = {0};
    ct_status status = gather(call, &picture, error);
    const Drawing drawing = {.put = put_commands, .of = &picture, .title = ct_title(call->session)};

    if (status == CT_OK)
        status = drawing_make(call, &drawing, path, error);
    picture_free(&picture);
    return status;
}

/* `plot last`: the same again, of the model as it is now */
static ct_status plot_again(Call *call, const char *path, ct_error *error)
{
    ct_statement *last = NULL;
    ct_cursor cursor = {.text = call->shell->last_plot, .line = 1};

    if (call->shell->last_plot == NULL)
        return ct_error_at(call->statement, ct_operand(call->statement, 0), error,
                           "nothing was plotted yet");

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
