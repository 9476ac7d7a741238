/* drawing.c: pictures: gnuplot's terminal for a file or a window, or characters */
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
    const char *terminal;  /* gnuplot's; the first available one is used */
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
    return strcmp(extension, "gp") == 0 || strcmp(extension, "txt") == 0;
}

/* --- pieces of commands --- */

/* colours that can be distinguished with colour blindness too (Okabe and Ito 2008) */
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

/* In double quotes, gnuplot first interprets a backslash as an escape, a backquote as a shell
 * command and an @ as a macro. So characters that aren't harmless everywhere are written as octal
 * codes. In single quotes two quotes in a row can't be distinguished from one. */
void write_quoted(FILE *out, const char *text)
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

void write_title(FILE *out, const char *title)
{
    if (*title == '\0')
        return;
    fputs("set title ", out);
    write_quoted(out, title);
    fputs(" noenhanced\n", out);
}

/* --- where to --- */

static void write_warnings(const Shell *shell, char *warnings)
{
    /* a curve that doesn't change is no news */
    if (warnings != NULL && *warnings != '\0' && strncmp(warnings, "Warning: empty", 14) != 0 &&
        !shell->quiet)
        remark("gnuplot: %s", warnings);
    free(warnings);
}

/* Set the terminal, draw, and read the printed output. */
static ct_status draw_on(Call *call, const Drawing *drawing, const char *terminal, const char *path,
                         char **printed, ct_error *error)
{
    OutputBuffer paper;
    char *warnings = NULL;

    output_buffer_open(&paper);
    fprintf(paper.out, "reset\nundefine $*\nset terminal %s\n", terminal);
    if (path != NULL) {
        fputs("set output ", paper.out);

        /* a name that starts with a bar would be a program */
        char *safe = copy_format("%s%s", path[0] == '/' ? "" : "./", path);

        write_quoted(paper.out, safe);
        fputc('\n', paper.out);
        free(safe);
    }
    drawing->put(paper.out, drawing);

    char *commands = output_buffer_close(&paper);
    ct_status status = gnuplot_do(call->shell->gnuplot, commands, printed, &warnings, error);

    free(commands);
    write_warnings(call->shell, warnings);
    return status;
}

static ct_status draw_script(const Drawing *drawing, const char *path, ct_error *error)
{
    OutputBuffer paper;

    output_buffer_open(&paper);
    fputs("# gnuplot -p draws this\nset encoding utf8\n", paper.out);
    drawing->put(paper.out, drawing);

    char *commands = output_buffer_close(&paper);
    ct_status status = file_write(path, commands, paper.length, false, error);

    free(commands);
    return status;
}

static ct_status draw_file(Call *call, const Drawing *drawing, const char *path, ct_error *error)
{
    const char *extension = file_extension(path);
    char *place = NULL, *printed = NULL;

    const PictureFormat *format = find_format(call->shell->gnuplot, extension);

    if (format == NULL) {
        error_set(error, "this gnuplot can't write '.%s'", extension);
        error_hint(error, "svg works everywhere; gnuplot-nox has png, pdf and eps as well");
        return CT_FAILED;
    }

    ct_status status = file_place(path, &place, error);

    if (status != CT_OK)
        return status;

    char *terminal = terminal_for(format, drawing);

    status = draw_on(call, drawing, terminal, place, &printed, error);
    if (status == CT_OK && !file_has_content(place) && strcmp(place, path) != 0)
        status = error_set(error, "gnuplot drew nothing");
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

/* with characters; as large as the terminal, less the line of the statement */
static void draw_text(Call *call, const Drawing *drawing)
{
    int rows = 24, columns = 79;

    if (isatty(STDOUT_FILENO)) {
        terminal_size(&rows, &columns);
        rows = rows > 40 ? 38 : rows - 2;
        columns--;
    }

    char *text = check_allocated(drawing->text(drawing, columns, rows, call->shell->unicode));

    write_text(call->out, text);
    ct_free(text);
}

static ct_status draw_text_file(const Call *call, const Drawing *drawing, const char *path,
                                ct_error *error)
{
    enum { COLUMNS = 100, ROWS = 30 };
    char *text = check_allocated(drawing->text(drawing, COLUMNS, ROWS, call->shell->unicode));
    ct_status status = file_write(path, text, strlen(text), false, error);

    ct_free(text);
    return status;
}

static bool is_wanted(const Call *call, const char *terminal)
{
    return strcmp(call->shell->settings.terminal, terminal) == 0;
}

/* into a window, or on a terminal of gnuplot's that the user chose */
static ct_status draw_screen(Call *call, const Drawing *drawing, ct_error *error)
{
    const PictureFormat *window =
        drawing_in_window(call) ? find_format(call->shell->gnuplot, "") : NULL;
    char *terminal, *printed = NULL;

    if (window == NULL && is_wanted(call, "auto")) {
        draw_text(call, drawing);
        return CT_OK;
    }
    if (window != NULL) {
        /* the window remains when the script ends */
        char *window_terminal = terminal_for(window, drawing);

        terminal = copy_format("%s%s", window_terminal, call->shell->interactive ? "" : " persist");
        free(window_terminal);
    } else if (is_wanted(call, "window")) {
        error_set(error, "this gnuplot has no windows");
        error_hint(error, "apt install gnuplot-qt, or set terminal text");
        return CT_FAILED;
    } else {
        terminal = copy_text(call->shell->settings.terminal);
    }

    ct_status status = draw_on(call, drawing, terminal, NULL, &printed, error);

    if (status == CT_OK)
        write_text(call->out, printed + strspn(printed, "\f\n"));
    else if (error->hint[0] == '\0')
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
        return ct_error_at(statement, NULL, error,
                           "a picture can't be appended to another: '>' writes it anew");
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

/* what gnuplot isn't needed for */
static bool goes_without_gnuplot(const Call *call, const Drawing *drawing, const char *path)
{
    if (path != NULL)
        return strcmp(file_extension(path), "gp") == 0 ||
               (drawing->text != NULL && strcmp(file_extension(path), "txt") == 0);
    return drawing->text != NULL &&
           (is_wanted(call, "text") || (is_wanted(call, "auto") && !has_display()));
}

static ct_status make(Call *call, const Drawing *drawing, const char *path, ct_error *error)
{
    if (!goes_without_gnuplot(call, drawing, path)) {
        const ct_status status = gnuplot_start(&call->shell->gnuplot, error);

        if (status != CT_OK)
            return status;
        return path != NULL ? draw_file(call, drawing, path, error)
                            : draw_screen(call, drawing, error);
    }
    if (path == NULL) {
        draw_text(call, drawing);
        return CT_OK;
    }
    return strcmp(file_extension(path), "gp") == 0 ? draw_script(drawing, path, error)
                                                   : draw_text_file(call, drawing, path, error);
}

ct_status drawing_make(Call *call, const Drawing *drawing, const char *path, ct_error *error)
{
    ct_error why = {.status = CT_OK};
    const ct_status status = make(call, drawing, path, &why);

    if (status != CT_OK) {
        ct_error_at(call->statement, NULL, error, "%s", why.message);
        error->status = status;
        error_hint(error, "%s", why.hint);
    }
    return status;
}
