/* block_triangular.c: strongly connected components and matchings by BTF (Davis 2006), and two
 * kinds */
#include "algebra/block_triangular.h"

#include "base/memory.h"

#include <btf.h>
#include <stdlib.h>

/* rows of a pattern by places; free with mem_free() */
typedef struct PatternColumns {
    int *start, *at; /* n + 1; entries */
} PatternColumns;

static PatternColumns places_of(const bool *pattern, int n)
{
    PatternColumns p = {NEW_ARRAY(int, n + 1), NULL};
    int count = 0;

    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            count += pattern[i * n + j];
        p.start[i + 1] = count;
    }
    p.at = NEW_ARRAY(int, count);
    for (int i = 0, k = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            if (pattern[i * n + j])
                p.at[k++] = j;
    return p;
}

static void places_free(PatternColumns *p)
{
    MEM_FREE(p->start, p->at);
}

static int rising(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* BTF reads matrices by columns, ours are stored by rows: BTF sees the transpose, and a block
 * precedes those that it acts on. */
BlockTriangular block_triangular_find(const bool *pattern, int n)
{
    PatternColumns p = places_of(pattern, n);
    int *room = NEW_ARRAY(int, 4 * (size_t)n);
    BlockTriangular out = {0, NEW_ARRAY(int, n + 1), NEW_ARRAY(int, n)};

    if (n > 0)
        out.count = btf_strongcomp(n, p.start, p.at, NULL, out.order, out.start, room);
    for (int b = 0; b < out.count; b++)
        qsort(out.order + out.start[b], (size_t)(out.start[b + 1] - out.start[b]), sizeof(int),
              rising);
    mem_free(room);
    places_free(&p);
    return out;
}

void block_triangular_free(BlockTriangular *blocks)
{
    MEM_FREE(blocks->start, blocks->order);
    *blocks = (BlockTriangular){0};
}

bool block_triangular_match(const bool *pattern, int n, int *column)
{
    PatternColumns p = places_of(pattern, n);
    int *row = NEW_ARRAY(int, n), *room = NEW_ARRAY(int, 5 * (size_t)n);
    double work;
    const bool all = n == 0 || btf_maxtrans(n, n, p.start, p.at, 0, &work, row, room) == n;

    for (int c = 0; c < n && all; c++)
        column[row[c]] = c;
    MEM_FREE(row, room);
    places_free(&p);
    return all;
}

/* --- two kinds --- */

bool block_triangular_alternate(const bool *pattern, int n)
{
    int *kind = NEW_ARRAY(int, n), *queue = NEW_ARRAY(int, n);
    bool alternate = true;

    for (int first = 0; first < n && alternate; first++) {
        int count = 0;

        if (kind[first] != 0)
            continue;
        kind[first] = 1;
        queue[count++] = first;
        for (int k = 0; k < count && alternate; k++)
            for (int i = 0; i < n && alternate; i++) {
                if (!pattern[i * n + queue[k]] && !pattern[queue[k] * n + i])
                    continue;
                alternate = kind[i] != kind[queue[k]];
                if (kind[i] == 0) {
                    kind[i] = -kind[queue[k]];
                    queue[count++] = i;
                }
            }
    }
    MEM_FREE(kind, queue);
    return alternate;
}
