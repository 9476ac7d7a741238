/* model_data.c: data files of table(), read when a statement is applied
 *
 * A file contains rows of numbers separated by commas, semicolons or blanks. Its first row may name
 * the columns, followed by units in brackets: "h [deg]" is h, converted to SI on reading. Lines
 * that begin with # are comments. The first column is x, in ascending order. The arena stores the
 * data by the names of file and column. So a statement that undo applies again finds the data that
 * it was made with. */
#include "expr/units.h"
#include "language/functions.h"
#include "model/model_impl.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Cells {
    LIST(char *) at; /* borrowed from the line that was split */
} Cells;

typedef struct DataReader {
    const char *file; /* as the user wrote it */
    Place place;      /* of the name in the statement */
    const char *column;
    Place column_place;
    int line;
    int x_cell, y_cell;  /* indices of the columns, from 0 */
    Unit x_unit, y_unit; /* factor 1 where the file has no unit */
    LIST(double) x;
    LIST(double) y;
    Diag *diag;
} DataReader;

/* --- files --- */

static void close_file(void *object)
{
    DataFile *file = object;

    if (file->in != NULL)
        (void)fclose(file->in);
    free(file->path);
    cleanup_close(&file->cleanup);
}

void data_close(DataFile *file)
{
    close_file(file);
}

Status data_open(const DataFinder *finder, const char *name, Place place, DataFile *out, Diag *diag)
{
    *out = (DataFile){0};
    cleanup_open(&out->cleanup, close_file, out);
    if (finder->find != NULL)
        out->path = finder->find(finder->context, name);
    if (finder->find != NULL && out->path == NULL) {
        (void)diag_at(diag, E_VALUE, place, "'%s' may not be read here", name);
        diag_hint(diag, "a --safe session reads only what lies in the script's folder");
        return E_VALUE;
    }
    out->in = fopen(out->path != NULL ? out->path : name, "r");
    if (out->in == NULL && errno == ENOMEM)
        transaction_fail();
    if (out->in == NULL) {
        (void)diag_at(diag, E_MISSING, place, "can't read '%s': %s", name, strerror(errno));
        diag_hint(diag, "a name is meant from the folder of the script, or from the current one");
        return E_MISSING;
    }
    return OK;
}

/* --- cells --- */

/* the column of a call: a text, a number as written; by default the second */
const char *data_column(const Syntax *call)
{
    return call->count > 2 ? call->args[2]->text : "2";
}

/* --- lines --- */

static char *trim(char *cell)
{
    size_t length;

    cell += strspn(cell, " \t\r\n");
    length = strlen(cell);
    while (length > 0 && strchr(" \t\r\n", cell[length - 1]) != NULL)
        length--;
    cell[length] = '\0';
    return cell;
}

/* Splits a line, in place, at commas or semicolons, or at blanks if it has neither; a cell may be
 * in quotes. */
static void split(char *line, Cells *cells)
{
    char *at = trim(line);
    const char *separators = strpbrk(at, ",;") != NULL ? ",;" : " \t";

    cells->at.count = 0;
    while (*at != '\0') {
        char *begin = at, *end;
        const bool quoted = *begin == '"';

        begin += quoted;
        end = begin + strcspn(begin, quoted ? "\"" : separators);
        if (!quoted && *separators == ' ' && end[strspn(end, separators)] == '[') {
            end += strcspn(end, "]"); /* a head's unit */
            end += *end != '\0';
        }
        at = end + (*end != '\0');
        *end = '\0';
        if (quoted)
            at += strcspn(at, separators);
        LIST_PUSH(cells->at, trim(begin));
        if (quoted && *at != '\0')
            at++;
        at += strspn(at, " \t");
    }
}

static bool is_cell_number(const char *cell, double *value)
{
    char *end;

    *value = strtod(cell, &end);
    return end != cell && *end == '\0' && *value - *value == 0;
}

static bool is_header(const Cells *cells)
{
    double value;

    for (int i = 0; i < cells->at.count; i++)
        if (!is_cell_number(cells->at.at[i], &value))
            return true;
    return false;
}

/* --- columns --- */

static bool is_number_text(const char *text)
{
    return text[0] != '\0' && text[strspn(text, "0123456789")] == '\0';
}

/* where the unit of a head begins, "[deg]" of "h [deg]"; NULL: it has none at its end */
static const char *unit_of_head(const char *head)
{
    const char *open = strrchr(head, '[');

    return open != NULL && head[strlen(head) - 1] == ']' ? open : NULL;
}

/* "h" matches "h [deg]", and so does "h [deg]" */
static bool is_head(const char *head, const char *name)
{
    const char *unit = unit_of_head(head);
    size_t length = unit != NULL ? (size_t)(unit - head) : 0;

    while (length > 0 && strchr(" \t", head[length - 1]) != NULL)
        length--;
    return strcmp(head, name) == 0 ||
           (length > 0 && strlen(name) == length && strncmp(head, name, length) == 0);
}

static Status take_unit(const DataReader *r, const Cells *cells, int cell, Unit *out)
{
    const char *head = cells->at.count > cell ? cells->at.at[cell] : "";
    const char *text = unit_of_head(head);
    size_t fault;

    if (text == NULL || unit_parse(text + 1, strlen(text) - 2, out, &fault))
        return OK;
    (void)diag_at(r->diag, E_UNIT, r->place, "column %d of %s, '%.60s': '%.40s' is no unit",
                  cell + 1, r->file, head, text);
    diag_hint(r->diag, "units are written as in [m], [deg], [kN/m]; [1] where there is none");
    return E_UNIT;
}

/* by its number from 1, or by its name in the first row */
static Status find_column(DataReader *r, const Cells *cells, bool named)
{
    Suggest suggest = suggest_for(r->column);

    if (is_number_text(r->column)) {
        const long number = strtol(r->column, NULL, 10);

        if (number >= 1 && number <= cells->at.count) {
            r->y_cell = (int)number - 1;
            return OK;
        }
        return diag_at(r->diag, E_VALUE, r->column_place, "%s has %d column%s", r->file,
                       cells->at.count, cells->at.count == 1 ? "" : "s");
    }
    for (int i = 0; named && i < cells->at.count; i++) {
        suggest_offer(&suggest, cells->at.at[i]);
        if (is_head(cells->at.at[i], r->column)) {
            r->y_cell = i;
            return OK;
        }
    }
    (void)diag_at(r->diag, E_NAME, r->column_place, "no column of %s is called '%s'", r->file,
                  r->column);
    suggest_or_hint(&suggest, r->diag,
                    named ? "its first row names them" : "its first row doesn't name them");
    return E_NAME;
}

/* rounded once where the unit is a ratio, so that 300 [ms] equals 0.3 */
static double in_si(const Unit *unit, double value)
{
    return unit->den != 0 && unit->pi_power == 0
               ? (double)((long double)value * (long double)unit->num / (long double)unit->den)
               : value * unit->factor;
}

static Status take_cell(const DataReader *r, const Cells *cells, int cell, const Unit *unit,
                        double *out)
{
    if (cell >= cells->at.count)
        return diag_at(r->diag, E_VALUE, r->place, "line %d of %s has no column %d", r->line,
                       r->file, cell + 1);
    if (!is_cell_number(cells->at.at[cell], out))
        return diag_at(r->diag, E_VALUE, r->place, "line %d of %s: '%.40s' is no number", r->line,
                       r->file, cells->at.at[cell]);
    *out = in_si(unit, *out);
    return *out - *out == 0 ? OK
                            : diag_at(r->diag, E_VALUE, r->place,
                                      "line %d of %s: '%.40s' is too large in its unit", r->line,
                                      r->file, cells->at.at[cell]);
}

static Status take_row(DataReader *r, const Cells *cells)
{
    double x, y;

    TRY(take_cell(r, cells, r->x_cell, &r->x_unit, &x));
    TRY(take_cell(r, cells, r->y_cell, &r->y_unit, &y));
    if (r->x.count > 0 && !(x > r->x.at[r->x.count - 1]))
        return diag_at(r->diag, E_VALUE, r->place,
                       "line %d of %s: the first column has to grow, and %g follows %g", r->line,
                       r->file, x, r->x.at[r->x.count - 1]);
    LIST_PUSH(r->x, x);
    LIST_PUSH(r->y, y);
    return OK;
}

/* far more than a table has, far less than fills the memory if a file has no end */
enum { LONGEST_LINE = 1 << 20, MOST_ROWS = 10000000 };

/* The next line without its end, which may be a newline, a carriage return or both; E_MISSING
 * without a message at the end of the file. */
static Status next_line(DataReader *r, FILE *in, Text *line)
{
    int c;

    text_free(line);
    text_add(line, "");
    r->line++;
    while ((c = getc(in)) != EOF && c != '\n' && c != '\r') {
        if (c == '\0')
            return diag_at(r->diag, E_VALUE, r->place, "line %d of %s holds a zero byte", r->line,
                           r->file);
        if (line->length >= LONGEST_LINE)
            return diag_at(r->diag, E_VALUE, r->place, "line %d of %s is longer than %d bytes",
                           r->line, r->file, LONGEST_LINE);
        text_char(line, (char)c);
    }
    if (c == '\r') {
        const int next = getc(in);

        if (next != '\n')
            (void)ungetc(next, in);
    }
    return c == EOF && line->length == 0 ? E_MISSING : OK;
}

static Status read_stream(DataReader *r, FILE *in)
{
    Cells cells = {0};
    Text line = {0};
    bool begun = false;
    Status status = OK;

    while ((status = next_line(r, in, &line)) == OK) {
        split(line.at, &cells);
        if (cells.at.count == 0 || cells.at.at[0][0] == '#')
            continue;
        if (!begun) {
            const bool named = is_header(&cells);

            begun = true;
            CHECK(find_column(r, &cells, named));
            if (named) {
                CHECK(take_unit(r, &cells, r->x_cell, &r->x_unit));
                CHECK(take_unit(r, &cells, r->y_cell, &r->y_unit));
                continue;
            }
        }
        CHECK(take_row(r, &cells));
        if (r->x.count > MOST_ROWS)
            CHECK(diag_at(r->diag, E_VALUE, r->place, "%s has more than %d rows", r->file,
                          MOST_ROWS));
    }
    if (status != E_MISSING)
        goto done;
    if (ferror(in))
        CHECK(diag_at(r->diag, E_VALUE, r->place, "can't read '%s': %s", r->file, strerror(errno)));
    status = OK;
    if (r->x.count < 2)
        status = diag_at(r->diag, E_VALUE, r->place, "%s has %d row%s of numbers; a curve takes 2",
                         r->file, r->x.count, r->x.count == 1 ? "" : "s");
done:
    text_free(&line);
    LIST_FREE(cells.at);
    return status;
}

/* --- the calls of a statement --- */

static Status read_call(const DataFinder *finder, Arena *arena, const Syntax *call, Diag *diag)
{
    const Unit none = {.factor = 1, .num = 1, .den = 1};
    DataReader r = {.file = call->args[0]->text,
                    .x_unit = none,
                    .y_unit = none,
                    .place = call->args[0]->place,
                    .column = data_column(call),
                    .column_place = call->count > 2 ? call->args[2]->place : call->args[0]->place,
                    .diag = diag};
    DataFile file;
    Status status = data_open(finder, r.file, r.place, &file, diag);

    if (status == OK)
        status = read_stream(&r, file.in);
    if (status == OK)
        arena_add_table(arena, r.file, r.column, r.x.at, r.y.at, r.x.count);
    data_close(&file);
    LIST_FREE(r.x);
    LIST_FREE(r.y);
    return status;
}

/* other forms are refused when the expression is built */
static bool is_data_call(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_CALL && function_takes_text(syntax->text) && syntax->count > 0 &&
           syntax->args[0]->kind == SYNTAX_STRING &&
           (syntax->count < 3 || syntax->args[2]->kind == SYNTAX_STRING ||
            syntax->args[2]->kind == SYNTAX_NUMBER);
}

Status data_read(const DataFinder *finder, Arena *arena, const Syntax *syntax, bool anew,
                 Diag *diag)
{
    if (syntax == NULL)
        return OK;
    if (is_data_call(syntax) &&
        (anew || arena_find_table(arena, syntax->args[0]->text, data_column(syntax)) == NULL))
        TRY(read_call(finder, arena, syntax, diag));
    for (int i = 0; i < syntax->count; i++)
        TRY(data_read(finder, arena, syntax->args[i], anew, diag));
    return OK;
}

Status data_read_statement(const DataFinder *finder, Arena *arena, const Statement *statement,
                           bool anew, Diag *diag)
{
    TRY(data_read(finder, arena, statement->value, anew, diag));
    for (int i = 0; i < statement->operands.count; i++)
        TRY(data_read(finder, arena, statement->operands.at[i].value, anew, diag));
    for (int i = 0; i < statement->pairs.count; i++)
        TRY(data_read(finder, arena, statement->pairs.at[i].value, anew, diag));
    return OK;
}
