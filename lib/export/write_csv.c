/* write_csv.c: comma-separated values */
#include "export/write.h"

#include "base/decimal.h"

#include <math.h>
#include <string.h>

static void add_name(Text *out, const char *name)
{
    static const char *const to[] = {"\"\""};
    const char *quote = strpbrk(name, ",\"\n") != NULL ? "\"" : "";

    text_add(out, quote);
    text_replace(out, name, "\"", to);
    text_add(out, quote);
}

static void add_row(Text *out, const double *values, int columns)
{
    char *at = text_room(out, (size_t)columns * (DECIMAL_SIZE + 1));

    for (int c = 0; c < columns; c++) {
        at += decimal_print(at, isfinite(values[c]) ? values[c] : (double)NAN, DECIMAL_EXACT);
        *at++ = c + 1 < columns ? ',' : '\n';
    }
    text_extend(out, at);
}

void write_csv(Text *out, const char *const *names, const double *values, int rows, int columns,
               bool with_header)
{
    for (int c = 0; with_header && c < columns; c++) {
        if (c > 0)
            text_char(out, ',');
        add_name(out, names[c]);
    }
    if (with_header)
        text_char(out, '\n');
    for (int r = 0; r < rows; r++)
        add_row(out, values + (ptrdiff_t)r * columns, columns);
}

/* a row a mode, with the amplitude and phase of every part */
static void write_modes(const Modes *modes, bool with_header, Text *out)
{
    static const char *const titles[] = {"mode",      "real",    "imaginary", "omega",
                                         "frequency", "damping", "error"};
    const int columns = COUNT(titles) + 2 * modes->parts;
    char **names = NEW_ARRAY(char *, columns);
    double *values = NEW_ARRAY(double, modes->count *columns);

    for (int c = 0; c < COUNT(titles); c++)
        names[c] = mem_text(titles[c], strlen(titles[c]));
    for (int p = 0; p < modes->parts; p++) {
        Text text = {0};

        text_addf(&text, "%s phase [deg]", modes->part_names[p]);
        names[COUNT(titles) + 2 * p] = mem_text(modes->part_names[p], strlen(modes->part_names[p]));
        names[COUNT(titles) + 2 * p + 1] = text_done(&text);
    }
    for (int i = 0; i < modes->count; i++) {
        const Mode *mode = &modes->at[i];
        const double figures[] = {
            i + 1,         mode->real, mode->imaginary, mode->omega, mode->omega / (2 * M_PI),
            mode->damping, mode->error};
        double *row = values + (ptrdiff_t)i * columns;

        memcpy(row, figures, sizeof figures);
        for (int p = 0; p < modes->parts; p++) {
            row[COUNT(figures) + 2 * p] = mode->amplitude[p];
            row[COUNT(figures) + 2 * p + 1] = mode->phase[p] * 180 / M_PI;
        }
    }
    write_csv(out, (const char *const *)names, values, modes->count, columns, with_header);
    for (int c = 0; c < columns; c++)
        mem_free(names[c]);
    MEM_FREE(names, values);
}

static Status write(const Exported *what, Text *out, Diag *diag)
{
    (void)diag;
    if (what->modes != NULL)
        write_modes(what->modes, what->with_header, out);
    else
        write_csv(out, what->names, what->values, what->rows, what->columns, what->with_header);
    return OK;
}

const Format format_csv = {.need = NEED_RUN, .write = write};
