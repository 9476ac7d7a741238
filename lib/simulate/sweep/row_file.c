/* row_file.c: lines of rows, each with its checksum */
#include "simulate/sweep/row_file.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { DIGITS = 16 }; /* hexadecimal, of a checksum or a number */
#define HASH_OF_NOTHING UINT64_C(14695981039346656037)

/* FNV-1a (Fowler, Noll, Vo) */
uint64_t row_file_hash(uint64_t from, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;

    for (size_t i = 0; i < size; i++)
        from = (from ^ at[i]) * UINT64_C(1099511628211);
    return from;
}

uint64_t row_file_fingerprint(const SweepTable *table, const char *text)
{
    const size_t size = (size_t)table->parameter_count * sizeof(double);
    uint64_t out = row_file_hash(HASH_OF_NOTHING, text, strlen(text) + 1);

    for (int i = 0; i < table->columns.count; i++) {
        out = row_file_hash(out, table->columns.at[i].name, strlen(table->columns.at[i].name) + 1);
        out = row_file_hash(out, table->columns.at[i].unit, strlen(table->columns.at[i].unit) + 1);
    }
    for (int r = 0; r < table->planned; r++)
        out = row_file_hash(out, sweep_table_row(table, r), size);
    return out;
}

/* --- writing --- */

/* a field of a text; what separates fields and lines becomes a blank */
static void add_field(Text *out, const char *text)
{
    text_char(out, '\t');
    for (; *text != '\0'; text++)
        text_char(out, strchr("\t\r\n", *text) != NULL ? ' ' : *text);
}

static void end_line(Text *out, size_t from)
{
    const uint64_t sum = row_file_hash(HASH_OF_NOTHING, out->at + from, out->length - from);

    text_addf(out, "\t%016" PRIx64 "\n", sum);
}

void row_file_add_head(const SweepTable *table, int planned, uint64_t fingerprint, Text *out)
{
    const size_t from = out->length;

    text_addf(out, "cotree rows 1\t%016" PRIx64 "\t%d\t%d\t%d", fingerprint, planned,
              table->parameter_count, table->is_random);
    for (int i = 0; i < table->columns.count; i++) {
        add_field(out, table->columns.at[i].name);
        add_field(out, table->columns.at[i].unit);
    }
    end_line(out, from);
}

void row_file_add_row(const SweepTable *table, int row, int number, Text *out)
{
    const double *values = sweep_table_row(table, row);
    const size_t from = out->length;

    text_addf(out, "row\t%d", number + 1);
    for (int i = 0; i < table->columns.count; i++) {
        uint64_t bits;

        memcpy(&bits, &values[i], sizeof bits);
        text_addf(out, "\t%016" PRIx64, bits);
    }
    add_field(out, table->reasons[row] != NULL ? table->reasons[row] : "");
    end_line(out, from);
}

/* --- reading --- */

void row_file_reader_free(RowFileReader *reader)
{
    LIST_FREE(reader->fields);
}

static bool read_bits(const char *field, uint64_t *out)
{
    char *end;

    if (strlen(field) != DIGITS || strspn(field, "0123456789abcdef") != DIGITS)
        return false;
    *out = strtoull(field, &end, 16);
    return *end == '\0';
}

static bool read_count(const char *field, int most, int *out)
{
    char *end;
    const long value = strtol(field, &end, 10);

    *out = (int)value;
    return end != field && *end == '\0' && value >= 0 && value <= most;
}

/* whether the line has the checksum at its end, which is cut off */
static bool check_line(char *line)
{
    char *last = strrchr(line, '\t');
    uint64_t sum;

    if (last == NULL || !read_bits(last + 1, &sum))
        return false;
    *last = '\0';
    return row_file_hash(HASH_OF_NOTHING, line, strlen(line)) == sum;
}

static void split(RowFileReader *reader, char *line)
{
    reader->fields.count = 0;
    for (;;) {
        char *end = line + strcspn(line, "\t");
        const bool is_last = *end == '\0';

        *end = '\0';
        LIST_PUSH(reader->fields, line);
        if (is_last)
            return;
        line = end + 1;
    }
}

bool row_file_next(RowFileReader *reader)
{
    char *end;

    while ((end = strchr(reader->at, '\n')) != NULL) {
        char *line = reader->at;

        *end = '\0';
        reader->at = end + 1;
        if (!check_line(line))
            continue;
        split(reader, line);
        return true;
    }
    return false;
}

enum { HEAD_FIELDS = 5, MOST_ROWS = 100000000 };

SweepTable *row_file_read_head(const RowFileReader *reader, uint64_t *fingerprint)
{
    char *const *fields = reader->fields.at;
    const int count = reader->fields.count;
    int planned, parameters, is_random;
    SweepTable *table;

    if (count < HEAD_FIELDS || (count - HEAD_FIELDS) % 2 != 0 ||
        strcmp(fields[0], "cotree rows 1") != 0 || !read_bits(fields[1], fingerprint) ||
        !read_count(fields[2], MOST_ROWS, &planned) ||
        !read_count(fields[3], (count - HEAD_FIELDS) / 2, &parameters) ||
        !read_count(fields[4], 1, &is_random))
        return NULL;
    table = sweep_table_new(planned);
    table->is_random = is_random != 0;
    for (int i = HEAD_FIELDS; i < count; i += 2)
        sweep_table_column(table, fields[i], fields[i + 1]);
    sweep_table_open(table, parameters);
    return table;
}

int row_file_read_row(const RowFileReader *reader, int columns, int planned, double *values,
                      const char **reason)
{
    char *const *fields = reader->fields.at;
    int number;

    if (reader->fields.count != columns + 3 || strcmp(fields[0], "row") != 0 ||
        !read_count(fields[1], planned, &number) || number == 0)
        return -1;
    for (int i = 0; i < columns; i++) {
        uint64_t bits;

        if (!read_bits(fields[2 + i], &bits))
            return -1;
        memcpy(&values[i], &bits, sizeof bits);
    }
    *reason = fields[2 + columns];
    return number - 1;
}
