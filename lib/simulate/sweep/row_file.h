/* row_file.h: a file of rows of a sweep, to which each row is appended when it is made
 *
 * Lines of fields between tabs; the last field is a checksum of the others. The first line has the
 * columns. Numbers are written by their bits. A line that is incomplete or damaged, as the last one
 * after the program was killed, is left out by the reader, and its row is made again. */
#ifndef COTREE_SIMULATE_SWEEP_ROW_FILE_H
#define COTREE_SIMULATE_SWEEP_ROW_FILE_H

#include "base/text.h"
#include "simulate/sweep/sweep_table.h"

#include <stdint.h>

uint64_t row_file_hash(uint64_t from, const void *bytes, size_t size);
/* of the columns and parameters of all rows, and of a text */
uint64_t row_file_fingerprint(const SweepTable *table, const char *text);

void row_file_add_head(const SweepTable *table, int planned, uint64_t fingerprint, Text *out);
/* `number`: of the row among all rows of the sweep, from 0 */
void row_file_add_row(const SweepTable *table, int row, int number, Text *out);

/* --- reading --- */

typedef struct RowFileReader {
    char *at; /* the rest of the content, which is changed; new lines end with \0 */
    LIST(char *) fields;
} RowFileReader;
void row_file_reader_free(RowFileReader *reader);
/* the fields of the next line that is complete; false: there is none */
bool row_file_next(RowFileReader *reader);
/* The columns: a new table without rows; NULL: the line is no head. */
SweepTable *row_file_read_head(const RowFileReader *reader, uint64_t *fingerprint);
/* The number of a row, its values into `values` and its reason ("": none); -1: it is none of a
 * table of so many columns and rows. */
int row_file_read_row(const RowFileReader *reader, int columns, int planned, double *values,
                      const char **reason);

#endif
