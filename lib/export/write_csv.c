/* write_csv.c: comma-separated values */
#include "export/write.h"

#include <math.h>
#include <string.h>

static void add_name(Text *out, const char *name)
{
    if (strpbrk(name, ",\"\n") == NULL) {
        text_add(out, name);
        return;
    }
    text_char(out, '"');
    for (; *name != '\0'; name++) {
        if (*name == '"')
            text_char(out, '"');
        text_char(out, *name);
    }
    text_char(out, '"');
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
        for (int c = 0; c < columns; c++) {
            const double value = values[(size_t)r * (size_t)columns + (size_t)c];

            if (isnan(value))
                text_add(out, "nan");
            else
                text_number(out, value, 17);
            text_char(out, c + 1 < columns ? ',' : '\n');
        }
}
