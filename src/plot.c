/* plot.c: `plot ITEM... [vs ITEM] [> "file"]`, drawn by gnuplot
 *
 * A file's extension says in which format. Without a file the picture goes into a window when
 * there is a display, else it is drawn with characters, as large as the terminal. The data
 * travel inside the commands, so `plot ... > "fig.gp"` writes a script that needs nothing else. */
#include "command.h"
#include "copy.h"
#include "file.h"
#include "terminal.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- formats --- */

typedef struct Format {
    const char *extension; /* "" for a window */
    const char *terminal;  /* gnuplot's; the first that it has is taken */
    const char *options;
} Format;

static const Format formats[] = {
    {"png", "pngcairo", "size 960,600 font 'Sans,12' linewidth 1.5"},
    {"png", "png", "size 960,600 linewidth 1.5"},
    {"svg", "svg", "size 960,600 font 'Sans,14' background 'white' linewidth 1.5"},
    {"pdf", "pdfcairo", "size 16cm,10cm font 'Sans,11' linewidth 1.5"},
    {"eps", "epscairo", "size 16cm,10cm font 'Sans,11' linewidth 1.5"},
    {"eps", "postscript", "eps color size 16cm,10cm"},
    {"txt", "dumb", "mono size 100,30"},
    {"", "qt", "size 960,600"},
    {"", "wxt", "size 960,600"},
    {"", "x11", "size 960,600"},
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

/* colours that stay apart for all eyes (Okabe and Ito 2008) */
static const char *const colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                     "#e69f00", "#56b4e9", "#000000"};
enum { COLORS = sizeof colors / sizeof colors[0] };

static const Format *find_format(const Gnuplot *gnuplot, const char *extension)
{
    for (int i = 0; i < FORMATS; i++)
        if (strcmp(formats[i].extension, extension) == 0 &&
            gnuplot_has_terminal(gnuplot, formats[i].terminal))
            return &formats[i];
    return NULL;
}

static bool is_known_extension(const char *extension)
{
    for (int i = 0; i < FORMATS; i++)
        if (*extension != '\0' && strcmp(formats[i].extension, extension) == 0)
            return true;
    return strcmp(extension, "gp") == 0;
}

/* --- data --- */

/* Items of one run share a table: column 0 is t. */
typedef struct Block {
    char *run; /* "run2", or "" for the last */
    double *values;
    int rows;
    int columns;
    char **names;
} Block;

typedef struct Curve {
    int item;
    int block;
    int column;
} Curve;

typedef struct Picture {
    const ct_expression *versus; /* NULL: t */
    Block *blocks;
    int blocks_count;
    Curve *curves;
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
    char *text = ct_expression_text(expression);
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
        picture->curves[i] = (Curve){.item = i, .block = block};
    }
}

static ct_status fill_block(const Call *call, Picture *picture, int number, ct_error *error)
{
    Block *block = &picture->blocks[number];
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

    free(items);
    if (status == CT_OK && block->rows < 2) {
        ct_error_at(call->statement, NULL, error, "there is no run to plot");
        error_hint(error, "simulate 1");
        return CT_FAILED;
    }
    return status;
}

static ct_status gather(const Call *call, Picture *picture, ct_error *error)
{
    ct_status status = CT_OK;
    const ct_expression *versus = ct_versus(call->statement);
    const char *word = versus != NULL ? ct_expression_word(versus) : NULL;

    picture->versus = word != NULL && strcmp(word, "t") == 0 ? NULL : versus;
    lay_out_curves(picture, call->statement);
    for (int i = 0; i < picture->blocks_count && status == CT_OK; i++)
        status = fill_block(call, picture, i, error);
    return status;
}

static void picture_free(Picture *picture)
{
    for (int i = 0; i < picture->blocks_count; i++) {
        free(picture->blocks[i].run);
        ct_free(picture->blocks[i].values);
        ct_words_free(picture->blocks[i].names);
    }
    free(picture->blocks);
    free(picture->curves);
}

/* --- commands --- */

/* a string of gnuplot's; a quote in it is doubled */
static void put_quoted(FILE *out, const char *text)
{
    fputc('\'', out);
    for (; *text != '\0'; text++) {
        if (*text == '\'')
            fputc('\'', out);
        fputc(*text == '\n' ? ' ' : *text, out);
    }
    fputc('\'', out);
}

static const char *curve_name(const Picture *picture, int i)
{
    const Curve *curve = &picture->curves[i];

    return picture->blocks[curve->block].names[curve->column];
}

static int x_column(const Picture *picture, const Block *block)
{
    return picture->versus != NULL ? block->columns - 1 : 0;
}

/* the unit in brackets at the end of a name, "" if none */
static const char *unit_of(const char *name)
{
    const char *open = strrchr(name, '[');

    return open != NULL && name[strlen(name) - 1] == ']' ? open : "";
}

static void put_labels(FILE *out, const Picture *picture, const char *title, bool as_text)
{
    const Block *first = &picture->blocks[0];
    const char *x = first->names[x_column(picture, first)];
    const char *unit = unit_of(curve_name(picture, 0));

    if (*title != '\0') {
        fputs("set title ", out);
        put_quoted(out, title);
        fputs(" noenhanced\n", out);
    }
    fputs("set xlabel ", out);
    put_quoted(out, strcmp(x, "t") == 0 ? "t [s]" : x);

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
        const Block *block = &picture->blocks[b];

        fprintf(out, "$block%d << end\n", b);
        for (int i = 0; i < block->rows; i++)
            for (int j = 0; j < block->columns; j++)
                fprintf(out, "%.17g%c", block->values[i * block->columns + j],
                        j == block->columns - 1 ? '\n' : ' ');
        fputs("end\n", out);
    }
}

static void put_commands(FILE *out, const Picture *picture, const char *title, bool as_text)
{
    put_blocks(out, picture);
    put_labels(out, picture, title, as_text);
    if (picture->versus == NULL)
        fputs("set autoscale xfix\n", out);
    if (!as_text)
        fputs("set border 3\nset tics nomirror\nset grid linetype 1 linecolor '#e0e0e0' linewidth "
              "0.7\n",
              out);
    for (int i = 0; i < picture->count; i++) {
        const Curve *curve = &picture->curves[i];

        fprintf(out, "%s$block%d using %d:%d with lines title ", i == 0 ? "plot " : ", ",
                curve->block, x_column(picture, &picture->blocks[curve->block]) + 1,
                curve->column + 1);
        put_quoted(out, curve_name(picture, i));
        if (!as_text)
            fprintf(out, " linewidth 1.5 linecolor rgb '%s'", colors[i % COLORS]);
    }
    fputc('\n', out);
}

/* --- where to --- */

static void say_warnings(const Shell *shell, char *warnings)
{
    /* a curve that doesn't change is no news */
    if (warnings != NULL && *warnings != '\0' && strncmp(warnings, "Warning: empty", 14) != 0 &&
        !shell->quiet)
        remark("gnuplot: %s", warnings);
    free(warnings);
}

/* Set the terminal, draw, and take what is drawn with characters. */
static ct_status draw(Call *call, const Picture *picture, const char *terminal, bool as_text,
                      const char *path, char **printed, ct_error *error)
{
    Paper paper;
    char *warnings = NULL;

    paper_open(&paper);
    fprintf(paper.out, "reset\nundefine $*\nset terminal %s\n", terminal);
    if (path != NULL) {
        fputs("set output ", paper.out);

        /* a name that begins with a bar would be a program */
        char *safe = copy_format("%s%s", path[0] == '/' ? "" : "./", path);

        put_quoted(paper.out, safe);
        fputc('\n', paper.out);
        free(safe);
    }
    put_commands(paper.out, picture, ct_title(call->session), as_text);

    char *commands = paper_close(&paper);
    ct_status status = gnuplot_do(call->shell->gnuplot, commands, printed, &warnings, error);

    free(commands);
    say_warnings(call->shell, warnings);
    return status;
}

static ct_status plot_script(const Call *call, const Picture *picture, const char *path,
                             ct_error *error)
{
    Paper paper;

    paper_open(&paper);
    fputs("# gnuplot -p draws this\nset encoding utf8\n", paper.out);
    put_commands(paper.out, picture, ct_title(call->session), false);

    char *commands = paper_close(&paper);
    ct_status status = file_write(path, commands, paper.length, false, error);

    free(commands);
    return status;
}

static ct_status plot_file(Call *call, const Picture *picture, const char *path, ct_error *error)
{
    const char *extension = file_extension(path);
    char *place = NULL, *printed = NULL;

    if (strcmp(extension, "gp") == 0)
        return plot_script(call, picture, path, error);

    const Format *format = find_format(call->shell->gnuplot, extension);

    if (format == NULL) {
        error_say(error, "this gnuplot can't write '.%s'", extension);
        error_hint(error, "svg works everywhere; gnuplot-nox has png, pdf and eps as well");
        return CT_FAILED;
    }

    ct_status status = file_place(path, &place, error);

    if (status != CT_OK)
        return status;

    char *terminal = copy_format("%s %s", format->terminal, format->options);

    status = draw(call, picture, terminal, strcmp(format->terminal, "dumb") == 0, place, &printed,
                  error);
    if (status == CT_OK && !file_has_content(place) && strcmp(place, path) != 0)
        status = error_say(error, "gnuplot drew nothing");
    if (status == CT_OK)
        status = file_settle(place, path, true, error);
    else
        file_settle(place, path, false, NULL);
    free(terminal);
    free(place);
    free(printed);
    return status;
}

static bool has_display(void)
{
    const char *x = getenv("DISPLAY");
    const char *wayland = getenv("WAYLAND_DISPLAY");

    return (x != NULL && *x != '\0') || (wayland != NULL && *wayland != '\0');
}

/* as large as the terminal, with room for the line that asked for it */
static char *text_terminal(void)
{
    int rows = 24, columns = 79;

    if (isatty(STDOUT_FILENO)) {
        terminal_size(&rows, &columns);
        rows = rows > 40 ? 38 : rows - 2;
        columns = columns > 120 ? 120 : columns - 1;
    }
    return copy_format("dumb %s size %d,%d", terminal_has_colors() ? "ansi256" : "mono",
                       columns < 20 ? 20 : columns, rows < 8 ? 8 : rows);
}

/* what gnuplot drew with characters, without its form feed and the blanks at line ends */
static void put_drawn(FILE *out, const char *drawn)
{
    drawn += strspn(drawn, "\f\n");
    while (*drawn != '\0') {
        size_t length = strcspn(drawn, "\n"), shown = length;

        while (shown > 0 && drawn[shown - 1] == ' ')
            shown--;
        fprintf(out, "%.*s\n", (int)shown, drawn);
        drawn += length + (drawn[length] == '\n');
    }
}

static ct_status plot_screen(Call *call, const Picture *picture, ct_error *error)
{
    const char *wanted = call->shell->settings.terminal;
    bool is_auto = strcmp(wanted, "auto") == 0;
    const Format *window = NULL;
    char *terminal, *printed = NULL;

    if (strcmp(wanted, "window") == 0 || (is_auto && has_display()))
        window = find_format(call->shell->gnuplot, "");

    bool as_text = strcmp(wanted, "text") == 0 || (is_auto && window == NULL);

    if (as_text) {
        terminal = text_terminal();
    } else if (window != NULL) {
        /* a script ends, the window it drew stays */
        terminal = copy_format("%s %s%s", window->terminal, window->options,
                               call->shell->interactive ? "" : " persist");
    } else if (strcmp(wanted, "window") == 0) {
        error_say(error, "this gnuplot has no windows");
        error_hint(error, "apt install gnuplot-qt, or set terminal text");
        return CT_FAILED;
    } else {
        terminal = copy_text(wanted);
    }

    ct_status status = draw(call, picture, terminal, as_text, NULL, &printed, error);

    if (status == CT_OK)
        put_drawn(call->out, printed);
    else if (!as_text && error->hint[0] == '\0')
        error_hint(error, "set terminal text draws without a display");
    free(printed);
    free(terminal);
    return status;
}

/* --- the command --- */

static ct_status plot(Call *call, const char *path, ct_error *error)
{
    Picture picture = {0};
    ct_status status = gather(call, &picture, error);
    ct_error why = {.status = CT_OK};
    bool needs_gnuplot = path == NULL || strcmp(file_extension(path), "gp") != 0;

    if (status == CT_OK) {
        if (needs_gnuplot)
            status = gnuplot_start(&call->shell->gnuplot, &why);
        if (status == CT_OK)
            status = path != NULL ? plot_file(call, &picture, path, &why)
                                  : plot_screen(call, &picture, &why);
        if (status != CT_OK) {
            ct_error_at(call->statement, NULL, error, "%s", why.message);
            error->status = status;
            error_hint(error, "%s", why.hint);
        }
    }
    picture_free(&picture);
    return status;
}

/* `plot last`: the same again, of the model as it is now */
static ct_status plot_again(Call *call, const char *path, ct_error *error)
{
    ct_statement *last = NULL;
    size_t next = 0;

    if (call->shell->last_plot == NULL)
        return ct_error_at(call->statement, ct_operand(call->statement, 0), error,
                           "nothing was plotted yet");

    ct_error why;
    ct_status status = ct_parse(call->shell->last_plot, 1, true, &next, &last, &why);
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

ct_status command_plot(Call *call, ct_error *error)
{
    const ct_statement *statement = call->statement;
    const char *word = call_word(call, 0);
    bool append = false;
    const char *path = ct_redirect(statement, &append);

    if (ct_operand_count(statement) == 0)
        return ct_error_at(statement, NULL, error, "plot what? plot h8 h8'");
    if (path != NULL && append)
        return ct_error_at(statement, NULL, error, "a picture can't be appended to another");
    if (path != NULL && !is_known_extension(file_extension(path))) {
        ct_error_at(statement, NULL, error,
                    "a plot goes to png, svg, pdf, eps, txt or gp, not to "
                    "'%s'",
                    path);
        error_hint(error, "the name's ending says the format: \"plot.png\"");
        return CT_FAILED;
    }
    if (word != NULL && strcmp(word, "last") == 0 && ct_operand_count(statement) == 1)
        return plot_again(call, path, error);

    ct_status status = plot(call, path, error);

    if (status == CT_OK) {
        free(call->shell->last_plot);
        call->shell->last_plot = copy_text(ct_statement_text(statement));
    }
    return status;
}
