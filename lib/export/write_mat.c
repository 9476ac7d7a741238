/* write_mat.c: numbers of a run for Matlab, Octave and NumPy, in the format of MAT-files of level 4
 *
 * A matrix is five integers (type, rows, columns, whether it is complex, length of its name), the
 * name with its 0, and its entries column by column. The thousands of the type define the byte
 * order, the tens the kind of numbers, the ones whether they are characters. MathWorks, MAT-File
 * Format, "Level 4 MAT-File Format". libmatio writes these, too, and brings 30 libraries with
 * it. */
#include "export/archive.h"
#include "export/write.h"

#include <string.h>

enum { BIG_ENDIAN_FIRST = 1000, BYTES = 50, CHARACTERS = 1 };

static void add_header(Text *out, const char *name, int type, int rows, int columns)
{
    const uint16_t one = 1;
    const bool is_little = *(const unsigned char *)&one == 1;
    const int32_t header[] = {(is_little ? 0 : BIG_ENDIAN_FIRST) + type, rows, columns, 0,
                              (int32_t)strlen(name) + 1};

    text_add_n(out, (const char *)header, sizeof header);
    text_add_n(out, name, strlen(name) + 1);
}

static void add_numbers(Text *out, const Exported *what)
{
    add_header(out, "data", 0, what->rows, what->columns);
    for (int c = 0; c < what->columns; c++)
        for (int r = 0; r < what->rows; r++)
            text_add_n(out,
                       (const char *)&what->values[(size_t)r * (size_t)what->columns + (size_t)c],
                       sizeof(double));
}

/* a row each, filled up with blanks */
static void add_words(Text *out, const char *name, const char *const *words, int count)
{
    size_t width = 1;

    for (int i = 0; i < count; i++)
        width = strlen(words[i]) > width ? strlen(words[i]) : width;
    add_header(out, name, BYTES + CHARACTERS, count, (int)width);
    for (size_t c = 0; c < width; c++)
        for (int i = 0; i < count; i++)
            text_char(out, c < strlen(words[i]) ? words[i][c] : ' ');
}

static Status pack(const Exported *what, Archive **out, Diag *diag)
{
    Text bytes = {0};
    size_t length;

    if (what->modes != NULL) {
        (void)diag_set(diag, E_VALUE, "'export mat' takes values of the last run");
        diag_hint(diag, "export csv modes has the modes");
        return E_VALUE;
    }
    add_numbers(&bytes, what);
    add_words(&bytes, "names", what->names, what->columns);
    add_words(&bytes, "units", what->units, what->columns);
    length = bytes.length;
    *out = NEW(Archive);
    (*out)->is_plain = true;
    archive_add(*out, "run.mat", text_done(&bytes), length);
    return OK;
}

const Format format_mat = {.need = NEED_RUN, .pack = pack, .splits_units = true};
