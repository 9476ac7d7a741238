/* triangular.c: groups found by columns that few rows have, from the tips of a tree inward
 *
 * The rows with an entry in some column form a group if at least as many columns have entries in
 * these rows only. After their removal the columns that they shared have fewer rows, and are
 * examined again. */
#include "algebra/triangular.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { MOST_ROWS = 6, MOST_OWN = 24 }; /* of a group: rows of a joint, and speeds of one body */

typedef LIST(int) TriangularIndices;

struct Triangular {
    const Pattern *pattern;
    const int *rows;
    int *group_of;            /* of the k-th row */
    TriangularIndices start;  /* of a group, in what follows: of `member`, and of `own` */
    TriangularIndices member; /* rows, by their numbers k */
    TriangularIndices own_start, own;
    TriangularIndices entry_start,
        entry; /* places of a group's rows in its own columns; -1: none */
};

typedef struct TriangularSearch {
    const Pattern *pattern;
    const int *rows;
    int *first, *at;           /* rows of a column, by k */
    int *left;                 /* of them, in no group yet */
    int *hits;                 /* of them, in the group that is tried */
    TriangularIndices waiting; /* columns to look at, the last one first */
    TriangularIndices touched; /* columns of the group that is tried */
    Triangular *form;
} TriangularSearch;

static int start_of_row(const TriangularSearch *s, int k)
{
    return s->pattern->start[s->rows[k]];
}

static int end_of_row(const TriangularSearch *s, int k)
{
    return s->pattern->start[s->rows[k] + 1];
}

/* rows of each column */
static void list_rows(TriangularSearch *s, int m)
{
    const int columns = s->pattern->rows;

    for (int k = 0; k < m; k++)
        for (int e = start_of_row(s, k); e < end_of_row(s, k); e++)
            s->left[s->pattern->row[e]]++;
    for (int c = 0; c < columns; c++)
        s->first[c + 1] = s->first[c] + s->left[c];
    s->at = NEW_ARRAY(int, s->first[columns]);
    for (int k = 0; k < m; k++)
        for (int e = start_of_row(s, k); e < end_of_row(s, k); e++) {
            const int c = s->pattern->row[e];

            s->at[s->first[c] + s->hits[c]++] = k;
        }
    memset(s->hits, 0, (size_t)columns * sizeof(int));
}

/* Columns with few rows are examined first: smaller groups compete less for rows. */
static void wait_for(TriangularSearch *s, const int *columns, int count)
{
    for (int rows = MOST_ROWS; rows > 0; rows--)
        for (int i = 0; i < count; i++) {
            const int c = columns != NULL ? columns[i] : i;

            if (s->left[c] == rows)
                LIST_PUSH(s->waiting, c);
        }
}

/* the rows of a column that are in no group, as a group to try; how many */
static int gather(TriangularSearch *s, int column)
{
    Triangular *form = s->form;
    const int before = form->member.count;

    s->touched.count = 0;
    for (int i = s->first[column]; i < s->first[column + 1]; i++) {
        const int k = s->at[i];

        if (form->group_of[k] >= 0)
            continue;
        LIST_PUSH(form->member, k);
        for (int e = start_of_row(s, k); e < end_of_row(s, k); e++) {
            const int c = s->pattern->row[e];

            if (s->hits[c]++ == 0)
                LIST_PUSH(s->touched, c);
        }
    }
    return form->member.count - before;
}

static void list_entries(TriangularSearch *s, int first, int first_own)
{
    Triangular *form = s->form;

    LIST_PUSH(form->entry_start, form->entry.count);
    for (int i = first; i < form->member.count; i++) {
        const int k = form->member.at[i];

        for (int j = first_own; j < form->own.count; j++) {
            int place = -1;

            for (int e = start_of_row(s, k); e < end_of_row(s, k); e++)
                if (s->pattern->row[e] == form->own.at[j])
                    place = e;
            LIST_PUSH(form->entry, place);
        }
    }
}

static void close_group(TriangularSearch *s, int first, int first_own)
{
    Triangular *form = s->form;

    list_entries(s, first, first_own);
    for (int i = first; i < form->member.count; i++)
        form->group_of[form->member.at[i]] = form->start.count - 1;
    LIST_PUSH(form->start, form->member.count);
    LIST_PUSH(form->own_start, form->own.count);
    for (int i = 0; i < s->touched.count; i++)
        s->left[s->touched.at[i]] -= s->hits[s->touched.at[i]];
}

static void try_column(TriangularSearch *s, int column)
{
    Triangular *form = s->form;
    const int first = form->member.count, first_own = form->own.count;
    const int rows = gather(s, column);
    int own;
    bool found;

    for (int i = 0; i < s->touched.count; i++)
        if (s->hits[s->touched.at[i]] == s->left[s->touched.at[i]])
            LIST_PUSH(form->own, s->touched.at[i]);
    own = form->own.count - first_own;
    found = rows > 0 && own >= rows && own <= MOST_OWN;
    if (found) {
        close_group(s, first, first_own);
    } else {
        form->member.count = first;
        form->own.count = first_own;
    }
    for (int i = 0; i < s->touched.count; i++)
        s->hits[s->touched.at[i]] = 0;
    if (found)
        wait_for(s, s->touched.at, s->touched.count);
}

Triangular *triangular_new(const Pattern *pattern, const int *rows, int m)
{
    const int columns = pattern->rows;
    Triangular *form = NEW(Triangular);
    TriangularSearch s = {.pattern = pattern,
                          .rows = rows,
                          .first = NEW_ARRAY(int, columns + 1),
                          .left = NEW_ARRAY(int, columns),
                          .hits = NEW_ARRAY(int, columns),
                          .form = form};

    form->pattern = pattern;
    form->rows = rows;
    form->group_of = NEW_ARRAY(int, m);
    for (int k = 0; k < m; k++)
        form->group_of[k] = -1;
    LIST_PUSH(form->start, 0);
    LIST_PUSH(form->own_start, 0);
    list_rows(&s, m);
    wait_for(&s, NULL, columns);
    while (s.waiting.count > 0) {
        const int c = s.waiting.at[--s.waiting.count];

        if (s.left[c] > 0 && s.left[c] <= MOST_ROWS)
            try_column(&s, c);
    }
    if (form->member.count < m) {
        triangular_free(form);
        form = NULL;
    }
    MEM_FREE(s.first, s.at, s.left, s.hits);
    LIST_FREE(s.waiting);
    LIST_FREE(s.touched);
    return form;
}

void triangular_free(Triangular *form)
{
    if (form == NULL)
        return;
    LIST_FREE(form->start);
    LIST_FREE(form->member);
    LIST_FREE(form->own_start);
    LIST_FREE(form->own);
    LIST_FREE(form->entry_start);
    LIST_FREE(form->entry);
    MEM_FREE(form->group_of, form);
}

int triangular_groups(const Triangular *form)
{
    return form->start.count - 1;
}

int triangular_group_of(const Triangular *form, int k)
{
    return form->group_of[k];
}

/* of a group of one row, which most are */
static double rest_of_row(const Triangular *form, int group, const double *values,
                          const double *square, const double *norm)
{
    const int *entry = form->entry.at + form->entry_start.at[group];
    const int *own = form->own.at + form->own_start.at[group];
    const int columns = form->own_start.at[group + 1] - form->own_start.at[group];
    double rest = 0;

    for (int j = 0; j < columns; j++)
        rest += values[entry[j]] * values[entry[j]] / square[own[j]];
    rest /= norm[form->rows[form->member.at[form->start.at[group]]]];
    return rest > 0 ? rest : 0;
}

double triangular_rest(const Triangular *form, int group, const double *values,
                       const double *square, const double *norm)
{
    const int first = form->start.at[group], rows = form->start.at[group + 1] - first;
    const int *own = form->own.at + form->own_start.at[group];
    const int columns = form->own_start.at[group + 1] - form->own_start.at[group];
    const int *entry = form->entry.at + form->entry_start.at[group];
    double row[MOST_ROWS][MOST_OWN], size[MOST_ROWS], least = INFINITY;

    if (rows == 1)
        return rest_of_row(form, group, values, square, norm);
    for (int i = 0; i < rows; i++) {
        double rest = 0;

        for (int j = 0; j < columns; j++)
            row[i][j] = entry[i * columns + j] >= 0 ? values[entry[i * columns + j]] : 0;
        for (int before = 0; before < i; before++) {
            double product = 0;

            for (int j = 0; j < columns; j++)
                product += row[i][j] * row[before][j] / square[own[j]];
            for (int j = 0; j < columns && product != 0; j++)
                row[i][j] -= product / size[before] * row[before][j];
        }
        for (int j = 0; j < columns; j++)
            rest += row[i][j] * row[i][j] / square[own[j]];
        size[i] = rest;
        rest /= norm[form->rows[form->member.at[first + i]]];
        if (!(rest >= least))
            least = rest;
        if (!(rest > 0))
            return 0;
    }
    return least;
}
