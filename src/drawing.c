/* drawing.c: pictures by gnuplot: the terminal for a file, a window or a screen of characters */
#include "drawing.h"

#include "copy.h"
#include "file.h"
#include "terminal.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --- formats --- */

typedef struct PictureFormat {
    const char *extension; /* "" for a window */
    const char *terminal;  /* gnuplot's; the first that it has is taken */
    const char *options;
    double unit; /* of its size, a px */
} PictureFormat;

#define CM (2.54 / 152) /* so that 960 px are 16 cm, as wide as a page */

static const PictureFormat formats[] = {
    {"png", "pngcairo", "font 'Sans,12' linewidth 1.5", 1},
    {"png", "png", "linewidth 1.5", 1},
    {"svg", "svg", "font 'Sans,14' background 'white' linewidth 1.5", 1},
    {"pdf", "pdfcairo", "font 'Sans,11' linewidth 1.5", CM},
    {"eps", "epscairo", "font 'Sans,11' linewidth 1.5", CM},
    {"eps", "postscript", "eps color", CM},
    {"tex", "tikz", "color", CM},
    {"tikz", "tikz", "color", CM},
    {"gif", "gif", "", 1},
    {"txt", "dumb", "mono", 0},
    {"", "qt", "", 1},
    {"", "wxt", "", 1},
    {"", "x11", "", 1},
};
enum { FORMATS = sizeof formats / sizeof formats[0] };

/* new: the terminal with its options and size */
static char *terminal_for(const PictureFormat *format, const Drawing *drawing)
{
    const double width = drawing->width > 0 ? drawing->width : 960;
    const double height = drawing->height > 0 ? drawing->height : 600;
    const char *cm = format->unit == CM ? "cm" : "";
    char moving[64] = "";

    if (drawing->interval > 0 && strcmp(format->terminal, "gif") == 0)
        snprintf(moving, sizeof moving, "animate optimize loop 0 delay %.0f",
                 drawing->interval * 100 + 0.5);
    if (format->unit == 0)
        return copy_format("%s %s size 100,30", format->terminal, format->options);
    return copy_format("%s %s %s size %g%s,%g%s", format->terminal, moving, format->options,
                       width * format->unit, cm, height * format->unit, cm);
}

static const PictureFormat *find_format(const Gnuplot *gnuplot, const char *extension)
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

/* --- pieces of commands --- */

/* colours that stay apart for all eyes (Okabe and Ito 2008) */
static const char *const colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                     "#e69f00", "#56b4e9", "#000000"};
enum { COLORS = sizeof colors / sizeof colors[0] };

const char *drawing_color(int i)
{
    return colors[i % COLORS];
}

int drawing_dash(int i)
{
    return 1 + i / COLORS;
}

/* Between double quotes a backslash begins an escape, a backquote a command of a system's shell and
 * an @ the name of a macro, before anything else is looked at: what isn't harmless everywhere goes
 * by its number. In single quotes two primes in a row can't be told from one. */
void put_quoted(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text != '\0'; text++) {
        const unsigned char c = (unsigned char)*text;

        if (c < ' ' || c == 0x7F)
            fputc(' ', out);
        else if (strchr("\"'\\`@$%{}", c) != NULL)
            fprintf(out, "\\%03o", c);
        else
            fputc(c, out);
    }
    fputc('"', out);
}

void put_title(FILE *out, const char *title)
{
    if (*title == '\0')
        return;
    fputs("set title ", out);
    put_quoted(out, title);
    fputs(" noenhanced\n", out);
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
static ct_status draw_on(Call *call, const Drawing *drawing, const char *terminal, bool as_text,
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
    drawing->put(paper.out, drawing, as_text);

    char *commands = paper_close(&paper);
    ct_status status = gnuplot_do(call->shell->gnuplot, commands, printed, &warnings, error);

    free(commands);
    say_warnings(call->shell, warnings);
    return status;
}

static ct_status draw_script(const Drawing *drawing, const char *path, ct_error *error)
{
    Paper paper;

    paper_open(&paper);
    fputs("# gnuplot -p draws this\nset encoding utf8\n", paper.out);
    drawing->put(paper.out, drawing, false);

    char *commands = paper_close(&paper);
    ct_status status = file_write(path, commands, paper.length, false, error);

    free(commands);
    return status;
}

static ct_status draw_file(Call *call, const Drawing *drawing, const char *path, ct_error *error)
{
    const char *extension = file_extension(path);
    char *place = NULL, *printed = NULL;

    if (strcmp(extension, "gp") == 0)
        return draw_script(drawing, path, error);

    const PictureFormat *format = find_format(call->shell->gnuplot, extension);

    if (format == NULL) {
        error_say(error, "this gnuplot can't write '.%s'", extension);
        error_hint(error, "svg works everywhere; gnuplot-nox has png, pdf and eps as well");
        return CT_FAILED;
    }

    ct_status status = file_place(path, &place, error);

    if (status != CT_OK)
        return status;

    char *terminal = terminal_for(format, drawing);

    status = draw_on(call, drawing, terminal, strcmp(format->terminal, "dumb") == 0, place,
                     &printed, error);
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

bool drawing_in_window(const Call *call)
{
    const char *wanted = call->shell->settings.terminal;

    return strcmp(wanted, "window") == 0 || (strcmp(wanted, "auto") == 0 && has_display());
}

/* as large as the terminal, with room for the line that asked for it */
static char *text_terminal(void)
{
    int rows = 24, columns = 79;

    if (isatty(STDOUT_FILENO)) {
        terminal_size(&rows, &columns);
        rows = rows > 40 ? 38 : rows - 2;
        columns--;
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

static ct_status draw_screen(Call *call, const Drawing *drawing, ct_error *error)
{
    const char *wanted = call->shell->settings.terminal;
    bool is_auto = strcmp(wanted, "auto") == 0;
    const PictureFormat *window =
        drawing_in_window(call) ? find_format(call->shell->gnuplot, "") : NULL;
    char *terminal, *printed = NULL;

    bool as_text = strcmp(wanted, "text") == 0 || (is_auto && window == NULL);

    if (as_text) {
        terminal = text_terminal();
    } else if (window != NULL) {
        /* a script ends, the window it drew stays */
        char *window_terminal = terminal_for(window, drawing);

        terminal = copy_format("%s%s", window_terminal, call->shell->interactive ? "" : " persist");
        free(window_terminal);
    } else if (strcmp(wanted, "window") == 0) {
        error_say(error, "this gnuplot has no windows");
        error_hint(error, "apt install gnuplot-qt, or set terminal text");
        return CT_FAILED;
    } else {
        terminal = copy_text(wanted);
    }

    ct_status status = draw_on(call, drawing, terminal, as_text, NULL, &printed, error);

    if (status == CT_OK)
        put_drawn(call->out, printed);
    else if (!as_text && error->hint[0] == '\0')
        error_hint(error, "set terminal text draws without a display");
    free(printed);
    free(terminal);
    return status;
}

/* --- the public functions --- */

ct_status drawing_check(const Call *call, const char **path, ct_error *error)
{
    bool append = false;
    const ct_statement *statement = call->statement;

    *path = ct_redirect(statement, &append);
    if (*path != NULL && append)
        return ct_error_at(statement, NULL, error, "a picture can't be appended to another");
    if (*path != NULL && !is_known_extension(file_extension(*path))) {
        ct_error_at(statement, NULL, error,
                    "a plot goes to png, svg, pdf, eps, tex, txt or gp, not to "
                    "'%s'",
                    *path);
        error_hint(error, "the name's ending says the format: \"plot.png\"");
        return CT_FAILED;
    }

    ct_error why;

    if (*path != NULL && file_may_write(*path, &why) != CT_OK)
        return ct_error_at(statement, NULL, error, "%s", why.message);
    return CT_OK;
}

ct_status drawing_make(Call *call, const Drawing *drawing, const char *path, ct_error *error)
{
    ct_status status = CT_OK;
    ct_error why = {.status = CT_OK};

    if (path == NULL || strcmp(file_extension(path), "gp") != 0)
        status = gnuplot_start(&call->shell->gnuplot, &why);
    if (status == CT_OK)
        status =
            path != NULL ? draw_file(call, drawing, path, &why) : draw_screen(call, drawing, &why);
    if (status != CT_OK) {
        ct_error_at(call->statement, NULL, error, "%s", why.message);
        error->status = status;
        error_hint(error, "%s", why.hint);
    }
    return status;
}
