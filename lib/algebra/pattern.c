/* pattern.c: terms by columns, and in a column by rows: sorted by counting, twice */
#include "algebra/pattern.h"

#include "algebra/linear.h"
#include "base/memory.h"

#include <string.h>

/* terms as in `from` (NULL: as they come) by rising keys, those of one key as they were */
static void sort(const int *key, int keys, const int *from, int count, int *to)
{
    int *next = NEW_ARRAY(int, keys + 1);

    for (int k = 0; k < count; k++)
        next[key[k] + 1]++;
    for (int i = 0; i < keys; i++)
        next[i + 1] += next[i];
    for (int i = 0; i < count; i++) {
        const int term = from != NULL ? from[i] : i;

        to[next[key[term]]++] = term;
    }
    mem_free(next);
}

Pattern pattern_of(int rows, int columns, int count, const int *row, const int *column, int *place)
{
    Pattern out = {.rows = rows, .columns = columns};
    int *by_row = NEW_ARRAY(int, count), *order = NEW_ARRAY(int, count);

    out.start = NEW_ARRAY(int, columns + 1);
    out.row = NEW_ARRAY(int, count);
    out.column = NEW_ARRAY(int, count);
    sort(row, rows, NULL, count, by_row);
    sort(column, columns, by_row, count, order);
    for (int i = 0; i < count; i++) {
        const int term = order[i], last = out.count - 1;

        if (last < 0 || out.row[last] != row[term] || out.column[last] != column[term]) {
            out.row[out.count] = row[term];
            out.column[out.count++] = column[term];
            out.start[column[term] + 1]++;
        }
        place[term] = out.count - 1;
    }
    for (int c = 0; c < columns; c++)
        out.start[c + 1] += out.start[c];
    MEM_FREE(by_row, order);
    return out;
}

void pattern_free(Pattern *pattern)
{
    MEM_FREE(pattern->start, pattern->row, pattern->column);
    *pattern = (Pattern){0};
}

Pattern pattern_full(int rows, int columns)
{
    Pattern p = {.rows = rows, .columns = columns, .count = rows * columns};

    p.start = NEW_ARRAY(int, columns + 1);
    p.row = NEW_ARRAY(int, p.count);
    p.column = NEW_ARRAY(int, p.count);
    for (int c = 0; c < columns; c++)
        p.start[c + 1] = p.start[c] + rows;
    for (int k = 0; k < p.count; k++) {
        p.row[k] = k % rows;
        p.column[k] = k / rows;
    }
    return p;
}

double pattern_dot(const Pattern *p, const double *values, int c, const double *v)
{
    double sum = 0;

    for (int k = p->start[c]; k < p->start[c + 1]; k++)
        sum += values[k] * v[p->row[k]];
    return sum;
}

void pattern_add(const Pattern *p, const double *values, int c, double factor, double *out)
{
    for (int k = p->start[c]; k < p->start[c + 1]; k++)
        out[p->row[k]] += factor * values[k];
}

double pattern_largest(const Pattern *p, const double *values, int c)
{
    return vector_largest(values + p->start[c], p->start[c + 1] - p->start[c]);
}

double pattern_at(const Pattern *p, const double *values, int row, int c)
{
    for (int k = p->start[c]; k < p->start[c + 1]; k++)
        if (p->row[k] == row)
            return values[k];
    return 0;
}

void pattern_fill(const Pattern *p, const double *values, double *out)
{
    memset(out, 0, (size_t)(p->rows * p->columns) * sizeof(double));
    for (int k = 0; k < p->count; k++)
        out[p->column[k] * p->rows + p->row[k]] = values[k];
}

double *pattern_spread(const Pattern *p, const double *values)
{
    double *out = NEW_ARRAY(double, p->rows * p->columns);

    pattern_fill(p, values, out);
    return out;
}
