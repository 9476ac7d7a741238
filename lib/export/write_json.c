/* write_json.c: numbers as JSON (RFC 8259)
 *
 *     {"columns": [{"name": "t", "unit": "s"}, ...], "rows": [[0, 1], ...],
 *      "failures": [{"row": 2, "reason": "..."}]}
 *
 * What isn't a number is null. Rows count from 1; only a sweep has failures. */
#include "export/write.h"

#include "base/decimal.h"

#include <math.h>

static void add_text(Text *out, const char *text)
{
    text_char(out, '"');
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        if (*c == '"' || *c == '\\')
            text_char(out, '\\');
        if (*c < ' ')
            text_addf(out, "\\u%04x", *c);
        else
            text_char(out, (char)*c);
    }
    text_char(out, '"');
}

static void add_row(Text *out, const double *values, int columns)
{
    char number[DECIMAL_SIZE];

    for (int c = 0; c < columns; c++) {
        text_add(out, c > 0 ? ", " : "[");
        if (isfinite(values[c])) {
            (void)decimal_print(number, values[c], DECIMAL_EXACT);
            text_add(out, number);
        } else {
            text_add(out, "null");
        }
    }
    text_char(out, ']');
}

static void add_failures(Text *out, const SweepTable *sweep)
{
    int count = 0;

    text_add(out, ",\n \"failures\": [");
    for (int r = 0; r < sweep->rows; r++) {
        if (sweep->reasons[r] == NULL)
            continue;
        text_addf(out, "%s{\"row\": %d, \"reason\": ", count++ > 0 ? ",\n  " : "", r + 1);
        add_text(out, sweep->reasons[r]);
        text_char(out, '}');
    }
    text_char(out, ']');
}

static Status write(const Exported *what, Text *out, Diag *diag)
{
    if (what->modes != NULL) {
        (void)diag_set(diag, E_VALUE, "'export json' takes values of a run or a sweep");
        diag_hint(diag, "export csv modes has the modes");
        return E_VALUE;
    }
    text_add(out, "{\"columns\": [");
    for (int c = 0; c < what->columns; c++) {
        text_add(out, c > 0 ? ", {\"name\": " : "{\"name\": ");
        add_text(out, what->names[c]);
        text_add(out, ", \"unit\": ");
        add_text(out, what->units[c]);
        text_char(out, '}');
    }
    text_add(out, "],\n \"rows\": [");
    for (int r = 0; r < what->rows; r++) {
        text_add(out, r > 0 ? ",\n  " : "");
        add_row(out, what->values + (ptrdiff_t)r * what->columns, what->columns);
    }
    text_char(out, ']');
    if (what->sweep != NULL)
        add_failures(out, what->sweep);
    text_add(out, "}\n");
    return OK;
}

const Format format_json = {.need = NEED_RUN, .write = write, .splits_units = true};
