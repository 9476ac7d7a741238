/* layout.c: lines no wider than the page, broken where a person would break them */
#include "present/layout.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool starts_character(char c)
{
    return ((unsigned char)c & 0xC0) != 0x80;
}

/* Brackets that are open, a bit each: 1 for a call's. A break inside a call's is worth far less
 * than one inside a group's; the sum is in columns of score. */
typedef struct Brackets {
    uint64_t calls;
    int score;
} Brackets;

enum { GROUP = 24, CALL = 1000 };

static Brackets bracket(Brackets open, const char *s, size_t i)
{
    if (s[i] == '(' || s[i] == '[') {
        const bool call = i > 0 && isalnum((unsigned char)s[i - 1]);

        open.calls = open.calls * 2 + (call ? 1 : 0);
        open.score += call ? CALL : GROUP;
    } else if (s[i] == ')' || s[i] == ']') {
        open.score -= open.calls % 2 == 1 ? CALL : GROUP;
        open.calls /= 2;
    }
    return open;
}

/* a sum's next term, or the other side of an equation, starts after this blank */
static bool may_break(const char *at)
{
    return at[0] == ' ' && strchr("+-=<>", at[1]) != NULL && at[1] != '\0' &&
           (at[2] == ' ' || (at[2] == '=' && at[3] == ' '));
}

/* Where to end a line that starts at `s`: the blank that is far to the right and not deep in
 * brackets. Without such a blank, the first product sign or comma after which the rest can start a
 * line; else the whole. */
static size_t line_end(const char *s, int width, Brackets open)
{
    size_t best = 0, emergency = 0;
    int best_score = -1000000, columns = 0;

    for (size_t i = 0; s[i] != '\0'; i++) {
        if (columns >= width && best > 0)
            return best;
        if (columns >= width && emergency > 0)
            return emergency;
        if (i > 0 && may_break(s + i)) {
            const int score = columns - open.score;

            if (columns >= width)
                return i;
            if (score >= best_score) {
                best = i;
                best_score = score;
            }
        } else if (i > 0 && (s[i] == '*' || (s[i] == ' ' && s[i - 1] == ',')) && columns > 8) {
            emergency = i;
        }
        open = bracket(open, s, i);
        columns += starts_character(s[i]);
    }
    return columns <= width ? strlen(s) : best > 0 ? best : emergency > 0 ? emergency : strlen(s);
}

/* a line that starts inside brackets is indented a little more than others */
static int bracket_indent(const Brackets *open)
{
    const int depth = open->score / GROUP;

    return 2 * (depth < 4 ? depth : 4);
}

void layout_formula(Text *out, const Page *page, const char *lead, const char *body)
{
    const int indent = text_width(lead);
    int width = page->columns > 0 ? page->columns - indent : 0;
    int deeper = 0;
    Brackets open = {0, 0};

    if (width > 0 && width < 24)
        width = 24;
    text_add(out, lead);
    while (width > 0 && text_width(body) > width - deeper) {
        const size_t end = line_end(body, width - deeper, open);

        if (body[end] == '\0')
            break;
        for (size_t i = 0; i < end; i++)
            open = bracket(open, body, i);
        text_add_n(out, body, end);
        text_char(out, '\n');
        deeper = bracket_indent(&open);
        text_fill(out, ' ', indent + deeper);
        body += end;
        while (*body == ' ')
            body++;
    }
    text_add(out, body);
    text_char(out, '\n');
}

static size_t word_length(const char *words)
{
    return strcspn(words, " \n");
}

/* with its comma */
static size_t item_length(const char *items)
{
    const char *comma = strstr(items, ", ");

    return comma != NULL ? (size_t)(comma + 1 - items) : strlen(items);
}

static void wrap(Text *out, int columns, const char *lead, const char *words,
                 size_t (*next_length)(const char *words))
{
    const int indent = text_width(lead);
    int column = indent;
    bool fresh = true;

    text_add(out, lead);
    while (*words != '\0') {
        size_t length = next_length(words);
        char *word = mem_text(words, length);
        const int width = text_width(word);

        if (length > 0) {
            if (!fresh && columns > 0 && column + 1 + width > columns) {
                text_char(out, '\n');
                text_fill(out, ' ', indent);
                column = indent;
                fresh = true;
            }
            if (!fresh) {
                text_char(out, ' ');
                column++;
            }
            text_add(out, word);
            column += width;
            fresh = false;
        }
        mem_free(word);
        words += length;
        if (*words == '\n' && words[1] != '\0') {
            text_char(out, '\n');
            if (words[1] != '\n')
                text_fill(out, ' ', indent);
            column = indent;
            fresh = true;
        }
        words += *words != '\0';
    }
    text_char(out, '\n');
}

void layout_words(Text *out, int columns, const char *lead, const char *words)
{
    wrap(out, columns, lead, words, word_length);
}

void layout_items(Text *out, int columns, const char *lead, const char *items)
{
    wrap(out, columns, lead, items, item_length);
}

int layout_widest_item(const char *items)
{
    int widest = 0;

    while (*items != '\0') {
        const size_t length = item_length(items);
        char *item = mem_text(items, length);
        const int width = text_width(item);

        widest = width > widest ? width : widest;
        mem_free(item);
        items += length;
        items += *items == ' ';
    }
    return widest;
}

void layout_item(Text *out, const char *item)
{
    if (out->length > 0)
        text_add(out, ", ");
    text_add(out, item);
}

void layout_count(Text *out, int count, const char *one, const char *many)
{
    text_addf(out, "%d %s", count, count == 1 ? one : many);
}

Table table_for(const char *align)
{
    return (Table){.columns = (int)strlen(align), .align = align, .cells = {0}};
}

Table table_of_columns(int count)
{
    return (Table){.columns = count, .align = NULL, .cells = {0}};
}

void table_cell(Table *table, const char *text)
{
    LIST_PUSH(table->cells, mem_text(text, strlen(text)));
}

void table_cells(Table *table, const char *format, ...)
{
    Text cells = {0};
    va_list args;

    va_start(args, format);
    text_addv(&cells, format, args);
    va_end(args);
    for (const char *cell = cells.at, *end; cell != NULL; cell = *end != '\0' ? end + 1 : NULL) {
        end = cell + strcspn(cell, "\t");
        LIST_PUSH(table->cells, mem_text(cell, (size_t)(end - cell)));
    }
    text_free(&cells);
}

static int column_width(const Table *table, int column)
{
    int width = 0;

    for (int i = column; i < table->cells.count; i += table->columns) {
        const int w = text_width(table->cells.at[i]);

        width = w > width ? w : width;
    }
    return width;
}

int table_width(const Table *table)
{
    int width = 0;

    for (int c = 0; c < table->columns; c++)
        width += column_width(table, c) + (c > 0 ? 2 : 0);
    return width;
}

int table_widest_cell(const Table *table)
{
    int widest = 0;

    for (int c = 0; c < table->columns; c++) {
        const int width = column_width(table, c);

        widest = width > widest ? width : widest;
    }
    return widest;
}

static int *column_widths(const Table *table)
{
    int *width = NEW_ARRAY(int, table->columns);

    for (int c = 0; c < table->columns; c++)
        width[c] = column_width(table, c);
    return width;
}

/* cells `from` up to `to` of the row that starts at `first` */
static void add_cells(Text *out, const Table *table, const int *width, int first, int from, int to)
{
    for (int c = from; c < to; c++) {
        const char *cell = table->cells.at[first + c];
        const int blanks = width[c] - text_width(cell);
        const char align = table->align != NULL ? table->align[c] : c == 0 ? 'l' : 'r';

        if (c > from)
            text_add(out, "  ");
        if (align == 'r')
            text_fill(out, ' ', blanks);
        text_add(out, cell);
        if (align == 'l')
            text_fill(out, ' ', blanks);
    }
}

/* no blanks at the ends of lines */
static void trim(Text *out, size_t kept)
{
    while (out->length > kept && out->at[out->length - 1] == ' ')
        out->at[--out->length] = '\0';
}

void table_print(Text *out, const Table *table, int indent)
{
    table_blocks(out, table, indent, 0);
}

/* the end of the columns from `from` on that fit next to the first one, at least one */
static int block_end(const Table *table, const int *width, int from, int room)
{
    int to = from;

    room -= width[0];
    while (to < table->columns && (room -= width[to] + 2) >= 0)
        to++;
    return to > from ? to : from + 1;
}

void table_blocks(Text *out, const Table *table, int indent, int columns)
{
    int *width = column_widths(table);
    int from = 1;

    do {
        const int to =
            columns > 0 ? block_end(table, width, from, columns - indent) : table->columns;

        text_add(out, from > 1 ? "\n" : "");
        for (int i = 0; i < table->cells.count; i += table->columns) {
            size_t kept;

            text_fill(out, ' ', indent);
            kept = out->length;
            add_cells(out, table, width, i, 0, 1);
            text_add(out, to > 1 ? "  " : "");
            add_cells(out, table, width, i, from, to);
            trim(out, kept);
            text_char(out, '\n');
        }
        from = to;
    } while (from < table->columns);
    mem_free(width);
}

void table_wrap(Text *out, const Table *table, int indent, int columns)
{
    enum { LEAST = 24 };
    const int last = table->columns - 1;
    const bool fits_in_line =
        columns == 0 || table_width(table) + indent <= columns ||
        table_width(table) - column_width(table, last) + indent <= columns - LEAST;
    int *width = column_widths(table);

    for (int i = 0; i < table->cells.count; i += table->columns) {
        Text lead = {0};

        text_fill(&lead, ' ', indent);
        add_cells(&lead, table, width, i, 0, last);
        text_add(&lead, "  ");
        if (!fits_in_line) {
            trim(&lead, 0);
            text_char(&lead, '\n');
            text_add(out, lead.at);
            text_free(&lead);
            text_fill(&lead, ' ', indent + 4);
        }
        layout_words(out, columns, lead.at, table->cells.at[i + last]);
        text_free(&lead);
    }
    mem_free(width);
}

void table_free(Table *table)
{
    for (int i = 0; i < table->cells.count; i++)
        mem_free(table->cells.at[i]);
    LIST_FREE(table->cells);
}

void table_finish(Text *out, Table *table, int indent)
{
    table_print(out, table, indent);
    table_free(table);
}

void layout_numbers(Text *out, const double *at, int count, const char *line)
{
    enum { A_LINE = 4, EXACT = 17 };

    for (int i = 0; i < count; i++) {
        text_add(out, i == 0 ? "" : line != NULL && i % A_LINE == 0 ? line : ", ");
        text_number(out, at[i], EXACT);
    }
}
