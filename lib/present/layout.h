/* layout.h: formulas, paragraphs and tables as lines of text
 *
 * A Page sets width and notation; everything is appended to a Text that the caller owns. Widths are
 * columns on a terminal, not bytes. */
#ifndef COTREE_PRESENT_LAYOUT_H
#define COTREE_PRESENT_LAYOUT_H

#include "base/memory.h"
#include "expr/expr.h"

typedef struct Page {
    int columns; /* 0: never wrap */
    bool unicode;
    Notation notation;
    const char *units; /* that numbers are in: "mm deg rpm"; NULL: SI */
} Page;

/* `lead` and `body` with a line end; the body is wrapped before + and - (outside brackets
 * rather than inside), later lines are indented to the end of the lead. */
void layout_formula(Text *out, const Page *page, const char *lead, const char *body);

/* Words between blanks, wrapped; later lines are indented to the end of the lead. Line ends in
 * `words` are preserved. */
void layout_words(Text *out, int columns, const char *lead, const char *words);

/* The same for items separated by commas, which aren't broken: "a 1, b 0.2 (3 deg)". */
void layout_items(Text *out, int columns, const char *lead, const char *items);
int layout_widest_item(const char *items);

/* "h8, h10, s11" */
void layout_item(Text *out, const char *item); /* with a comma where `out` isn't empty */

/* "1 constraint", "2 constraints" */
void layout_count(Text *out, int count, const char *one, const char *many);

/* A table of short cells: columns as wide as their widest cell, separated by two blanks. */
typedef struct Table {
    int columns;
    const char *align; /* one letter a column: l or r; NULL: l, then r */
    LIST(char *) cells;
} Table;

Table table_for(const char *align);
Table table_of_columns(int count); /* the first is one of names, the others have numbers */
void table_cell(Table *table, const char *text);
/* one or more, with a tab between two */
void table_cells(Table *table, const char *format, ...) PRINTF(2, 3);
int table_width(const Table *table);
int table_widest_cell(const Table *table);
void table_print(Text *out, const Table *table, int indent);
/* The same in blocks of columns no wider than the page, the first column in front of each. */
void table_blocks(Text *out, const Table *table, int indent, int columns);
/* As table_print(), with the words of the last column wrapped: next to the other columns, or below
 * them if the page is too narrow. */
void table_wrap(Text *out, const Table *table, int indent, int columns);
void table_free(Table *table);
/* table_print(), then table_free() */
void table_finish(Text *out, Table *table, int indent);
/* Numbers with all digits and commas between; four a line where there is a `line`, which then
 * stands between lines. */
void layout_numbers(Text *out, const double *at, int count, const char *line);

#endif
