/* command_run.c: commands that run a model, and output of numbers */
#include "command.h"
#include "copy.h"
#include "file.h"
#include "library.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* if the statement requests a result (ct_prints()), the report is its output */
ct_status command_run(Call *call, ct_error *error)
{
    ct_status status;

    ct_seed(call->session, (uint64_t)call->shell->settings.seed);
    status = ct_run(call->session, call->statement, error);

    if (status == CT_OK && ct_prints(call->statement)) {
        char *text = ct_report(call->session);

        if (text == NULL)
            return ct_error_at(call->statement, NULL, error, "out of memory");
        write_text(call->out, text);
        ct_free(text);
    }
    return status;
}

static ct_status command_expect(Call *call, ct_error *error)
{
    return ct_expect(call->session, call->statement, error);
}

/* --- print --- */

/* One printed line: the text before `=`, and the unit after the number. */
typedef struct Printed {
    char *name;
    char *unit; /* NULL: none */
    double value;
} Printed;

/* whether the text that ends at `end` is a literal: its unit belongs to it and isn't a display
 * unit */
static bool is_literal(const char *text, const char *end)
{
    while (end > text && end[-1] == ' ')
        end--;
    if (end > text && end[-1] == ']')
        return true;
    while (end > text && (isalnum((unsigned char)end[-1]) || strchr("._'", end[-1]) != NULL))
        end--;
    return isdigit((unsigned char)*end) || *end == '.';
}

/* `h8 [deg]` is `h8 = 45 deg` */
static void name_printed(Printed *line, const ct_expression *expression)
{
    char *text = check_allocated(ct_expression_text(expression));
    char *open = strrchr(text, '[');
    size_t length = strlen(text);

    if (open != NULL && open > text && text[length - 1] == ']' && !is_literal(text, open)) {
        line->unit = copy_piece(open + 1, (size_t)(text + length - open) - 2);
        while (open > text && open[-1] == ' ')
            open--;
        *open = '\0';
    }
    line->name = copy_text(text);
    ct_free(text);
}

enum { NUMBER_SIZE = 64 };

/* Write a number, with a word for NaN and infinity, so that readers don't take the root of a
 * negative number for a value. Returns the length. */
static int write_number(char out[NUMBER_SIZE], int digits, double value)
{
    if (!isfinite(value))
        return snprintf(out, NUMBER_SIZE, "undefined");
    return snprintf(out, NUMBER_SIZE, "%.*g", digits, value == 0 ? 0.0 : value);
}

static void write_figure(FILE *out, int width, int digits, double value)
{
    char number[NUMBER_SIZE];

    (void)write_number(number, digits, value);
    fprintf(out, "%*s", width, number);
}

static void write_printed(const Call *call, const Printed *lines, int count)
{
    int widest = 0;

    for (int i = 0; i < count; i++) {
        int width = (int)strlen(lines[i].name);

        if (lines[i].name[0] != '"' && width > widest)
            widest = width;
    }
    for (int i = 0; i < count; i++) {
        const char *name = lines[i].name;

        if (name[0] == '"') {
            fprintf(call->out, "%.*s\n", (int)strlen(name) - 2, name + 1);
            continue;
        }
        fprintf(call->out, "%-*s = ", widest, name);
        write_figure(call->out, 0, call->shell->settings.digits, lines[i].value);
        fprintf(call->out, "%s%s\n", lines[i].unit != NULL ? " " : "",
                lines[i].unit != NULL ? lines[i].unit : "");
    }
}

/* An item without a unit is shown in that of its dimension, if this is known. */
static void show_in_unit(const Call *call, const ct_expression *expression, Printed *line)
{
    double size;
    char *unit = ct_unit_in(call->session, expression, call->shell->settings.units, &size);

    line->value /= size;
    line->unit = unit != NULL ? copy_text(unit) : NULL;
    ct_free(unit);
}

/* 0 where rounding alone made the value */
static ct_status round_printed(const Call *call, const ct_expression *expression, double *value,
                               ct_error *error)
{
    const ct_expression *instant = ct_at(call->statement);
    double at = 0;
    ct_status status = CT_OK;

    if (instant != NULL)
        status = ct_value(call->session, instant, NULL, &at, error);
    if (status == CT_OK)
        status = ct_round(call->session, expression, instant != NULL ? &at : NULL, value, error);
    return status;
}

static ct_status command_print(Call *call, ct_error *error)
{
    int count = ct_operand_count(call->statement);
    Printed *lines = check_allocated(calloc((size_t)count + 1, sizeof *lines));
    ct_status status = ct_apply(call->session, call->statement, error);

    /* a name alone may be a mistyped verb */
    if (status == CT_NOT_MINE)
        status = CT_OK;
    for (int i = 0; i < count && status == CT_OK; i++) {
        const ct_expression *expression = ct_operand(call->statement, i);

        name_printed(&lines[i], expression);
        if (lines[i].name[0] == '"')
            continue;
        status =
            ct_value(call->session, expression, ct_at(call->statement), &lines[i].value, error);
        if (status == CT_OK)
            status = round_printed(call, expression, &lines[i].value, error);
        if (status == CT_OK && lines[i].unit == NULL)
            show_in_unit(call, expression, &lines[i]);
    }
    if (status == CT_OK)
        write_printed(call, lines, count);
    for (int i = 0; i < count; i++) {
        free(lines[i].name);
        free(lines[i].unit);
    }
    free(lines);
    return status;
}

/* --- table --- */

typedef struct TableColumns {
    double *values; /* rows x columns */
    int rows;
    int columns;
    char **names;
    char **labels; /* names with units */
} TableColumns;

/* a column is as wide as its widest entry; new */
static int *column_widths(const TableColumns *table, int digits)
{
    int *widths = check_allocated(calloc((size_t)table->columns + 1, sizeof *widths));

    for (int j = 0; j < table->columns; j++) {
        widths[j] = (int)strlen(table->labels[j]);
        for (int i = 0; i < table->rows; i++) {
            char number[NUMBER_SIZE];
            int width = write_number(number, digits, table->values[i * table->columns + j]);

            if (width > widths[j])
                widths[j] = width;
        }
    }
    return widths;
}

/* the end of the columns from `from` on that fit next to the first one, at least one */
static int block_end(const Call *call, const TableColumns *table, const int *widths, int from)
{
    int room = call->columns - widths[0], to = from;

    if (call->columns == 0)
        return table->columns;
    while (to < table->columns && (room -= widths[to] + 2) >= 0)
        to++;
    return to > from || from == table->columns ? to : from + 1;
}

/* the first column, and those from `from` up to `to` */
static void write_block(const Call *call, const TableColumns *table, const int *widths, int from,
                        int to)
{
    fprintf(call->out, "%*s", widths[0], table->labels[0]);
    for (int j = from; j < to; j++)
        fprintf(call->out, "  %*s", widths[j], table->labels[j]);
    fputc('\n', call->out);
    for (int i = 0; i < table->rows; i++) {
        const double *row = table->values + (size_t)i * (size_t)table->columns;

        write_figure(call->out, widths[0], call->shell->settings.digits, row[0]);
        for (int j = from; j < to; j++) {
            fputs("  ", call->out);
            write_figure(call->out, widths[j], call->shell->settings.digits, row[j]);
        }
        fputc('\n', call->out);
    }
}

/* in blocks of columns where it is wider than the screen, each with the first one */
static void write_table(const Call *call, const TableColumns *table)
{
    int *widths = column_widths(table, call->shell->settings.digits);
    int from = 1;

    do {
        const int to = block_end(call, table, widths, from);

        if (from > 1)
            fputc('\n', call->out);
        write_block(call, table, widths, from, to);
        from = to;
    } while (from < table->columns);
    free(widths);
}

/* A column without a unit after its name gets that of its dimension, if this is known. */
static void label_columns(const Call *call, const ct_expression *const *items, int count,
                          TableColumns *table)
{
    table->labels = check_allocated(calloc((size_t)table->columns + 1, sizeof *table->labels));
    for (int j = 0; j < table->columns; j++) {
        const char *name = table->names[j];
        const bool is_asked = j > 0 && j <= count && name[strlen(name) - 1] != ']';
        double size = 1;
        char *unit =
            is_asked ? ct_unit_in(call->session, items[j - 1], call->shell->settings.units, &size)
                     : NULL;

        for (int i = 0; i < table->rows && unit != NULL; i++)
            table->values[i * table->columns + j] /= size;
        table->labels[j] = unit != NULL ? copy_format("%s [%s]", name, unit)
                           : j == 0     ? copy_format("%s [%s]", name, name[0] == 'f' ? "Hz" : "s")
                                        : copy_text(name);
        ct_free(unit);
    }
}

#define FAR_BELOW                                                                                  \
    1e-9 /* of the largest value in a column: smaller ones are compared with rounding */

/* Replace values due to rounding alone by 0; in a column that has no others, all */
static ct_status round_column(const Call *call, const ct_expression *item,
                              const TableColumns *table, int column, ct_error *error)
{
    double *values = table->values + column;
    const ptrdiff_t stride = table->columns;
    ptrdiff_t top = 0;
    ct_status status = CT_OK;

    for (int i = 1; i < table->rows; i++)
        if (fabs(values[i * stride]) > fabs(values[top * stride]))
            top = i;

    double largest = values[top * stride];

    status = ct_round(call->session, item, &table->values[top * stride], &largest, error);
    for (int i = 0; i < table->rows && status == CT_OK; i++)
        if (largest == 0)
            values[i * stride] = 0;
        else if (fabs(values[i * stride]) < FAR_BELOW * fabs(largest))
            status = ct_round(call->session, item, &table->values[i * stride], &values[i * stride],
                              error);
    return status;
}

/* the statement that requests all columns by name, so that units can follow these */
static ct_statement *asked_by_name(char *const *names)
{
    char *text = copy_text("table");
    ct_statement *statement = NULL;
    ct_error ignored;

    for (int j = 1; names[j] != NULL; j++) {
        char *longer = copy_format("%s %s", text, names[j]);

        free(text);
        text = longer;
    }

    ct_cursor cursor = {.text = text, .line = 1};

    (void)ct_parse(&cursor, false, &statement, &ignored);
    free(text);
    return statement;
}

/* A requested `t` is the first column, which is always there. */
static void drop_times(TableColumns *table, const ct_expression **items, int *count)
{
    for (int j = *count; j >= 1; j--) {
        const int columns = table->columns;

        if (strcmp(table->names[0], "t") != 0 || strcmp(table->names[j], "t") != 0)
            continue;
        ct_free(table->names[j]);
        for (int k = j; k < columns; k++) /* and what ends the names */
            table->names[k] = table->names[k + 1];
        for (int k = j; k < *count; k++)
            items[k - 1] = items[k];
        for (int i = 0, from = 0, to = 0; i < table->rows; i++)
            for (int k = 0; k < columns; k++, from++)
                if (k != j)
                    table->values[to++] = table->values[from];
        table->columns--;
        --*count;
    }
}

static ct_status command_table(Call *call, ct_error *error)
{
    const ct_statement *statement = call->statement;
    ct_statement *named = NULL;
    int count = ct_operand_count(statement);
    const ct_expression *step = ct_key_value(statement, "every");
    double every = 0;
    TableColumns table = {0};
    ct_status status = CT_OK;

    if (step != NULL)
        status = ct_duration(call->session, step, "every", &every, error);
    if (status == CT_OK && step != NULL && !(every > 0))
        status = ct_error_at(statement, step, error, "every= is a time above zero");
    if (status != CT_OK)
        return status;

    const ct_expression **items = check_allocated(calloc((size_t)count + 1, sizeof *items));

    for (int i = 0; i < count; i++)
        items[i] = ct_operand(statement, i);
    status = ct_table(call->session, items, count, every, &table.values, &table.rows,
                      &table.columns, &table.names, error);
    if (status == CT_OK && count == 0 && (named = asked_by_name(table.names)) != NULL) {
        count = ct_operand_count(named);
        free(items);
        items = check_allocated(calloc((size_t)count + 1, sizeof *items));
        for (int i = 0; i < count; i++)
            items[i] = ct_operand(named, i);
    }
    if (status == CT_OK)
        drop_times(&table, items, &count);
    for (int j = 1; j <= count && status == CT_OK && table.names[0][0] == 't'; j++)
        status = round_column(call, items[j - 1], &table, j, error);
    if (status == CT_OK) {
        label_columns(call, items, count, &table);
        write_table(call, &table);
        for (int j = 0; j < table.columns; j++)
            free(table.labels[j]);
        free(table.labels);
        ct_free(table.values);
        ct_words_free(table.names);
    }
    ct_statement_free(named);
    free(items);
    return status;
}

/* --- export --- */

/* Binary data is written to a file unchanged. */
static ct_status write_archive(Call *call, const ct_archive *archive, ct_error *error)
{
    char *binary = NULL, *bytes = NULL;
    size_t binary_length = 0, length = 0;
    ct_status status =
        ct_archive_is_zip(archive) ? library_of(archive, &binary, &binary_length, error) : CT_OK;

    if (status == CT_OK)
        status =
            ct_archive_pack(call->session, archive, binary, binary_length, &bytes, &length, error);
    if (status == CT_OK)
        fwrite(bytes, 1, length, call->out);
    ct_free(bytes);
    free(binary);
    return status;
}

static ct_status command_export(Call *call, ct_error *error)
{
    bool append = false;
    const char *path = ct_redirect(call->statement, &append);
    const char *format = call_word(call, 0), *rows = NULL;
    char *text = NULL;
    ct_archive *archive = NULL;
    ct_status status = path != NULL && !append
                           ? ct_export_archive(call->session, call->statement, &archive, error)
                           : CT_OK;

    if (archive != NULL)
        status = write_archive(call, archive, error);
    ct_archive_free(archive);
    if (archive != NULL || status != CT_OK)
        return status;
    status = ct_export(call->session, call->statement, true, &text, error);

    if (status == CT_OK && format != NULL && strcmp(format, "csv") == 0)
        status = csv_rows(call, text, &rows, error);
    if (status == CT_OK)
        write_text(call->out, rows != NULL ? rows : text);
    ct_free(text);
    return status;
}

const Command commands_run[] = {
    {"expect", command_expect, NULL, 0},
    {"print", command_print, NULL, 0},
    {"table", command_table, NULL, 0},
    {"export", command_export, NULL, 0},
    {NULL, NULL, NULL, 0},
};
