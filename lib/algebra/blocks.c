/* blocks.c: strongly connected components, matchings and two kinds, without recursion */
#include "algebra/blocks.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

/* --- components --- */

typedef struct BlockSearch {
    const bool *pattern;
    int n, found, open_count, path_count;
    int *number; /* when a state was met, from 1; 0: not yet */
    int *low;    /* the earliest that is reached from it and still open */
    int *open, *path;
    int *next; /* of a state: the entry of its column that is looked at next */
    int *component;
    int components;
} BlockSearch;

static void meet(BlockSearch *s, int state)
{
    s->number[state] = s->low[state] = ++s->found;
    s->open[s->open_count++] = state;
    s->path[s->path_count++] = state;
    s->component[state] = -1;
}

/* all behind the last of the path are done: its component is closed where it reaches no earlier */
static void leave(BlockSearch *s)
{
    const int state = s->path[--s->path_count];
    int member;

    if (s->path_count > 0) {
        const int before = s->path[s->path_count - 1];

        if (s->low[state] < s->low[before])
            s->low[before] = s->low[state];
    }
    if (s->low[state] < s->number[state])
        return;
    do {
        member = s->open[--s->open_count];
        s->component[member] = s->components;
    } while (member != state);
    s->components++;
}

static void search_from(BlockSearch *s, int first)
{
    meet(s, first);
    while (s->path_count > 0) {
        const int state = s->path[s->path_count - 1];
        int to = s->next[state];

        while (to < s->n && !(s->pattern[to * s->n + state] && s->component[to] < 0))
            to++;
        if (to == s->n) {
            leave(s);
            continue;
        }
        s->next[state] = to + 1;
        if (s->number[to] == 0)
            meet(s, to);
        else if (s->number[to] < s->low[state])
            s->low[state] = s->number[to];
    }
}

Blocks blocks_find(const bool *pattern, int n)
{
    BlockSearch s = {.pattern = pattern,
                     .n = n,
                     .number = NEW_ARRAY(int, n),
                     .low = NEW_ARRAY(int, n),
                     .open = NEW_ARRAY(int, n),
                     .path = NEW_ARRAY(int, n),
                     .next = NEW_ARRAY(int, n),
                     .component = NEW_ARRAY(int, n)};
    Blocks out = {0};

    for (int i = 0; i < n; i++)
        s.component[i] = -1;
    for (int i = 0; i < n; i++)
        if (s.number[i] == 0)
            search_from(&s, i);
    /* what acts on nothing else is closed first */
    out = (Blocks){s.components, NEW_ARRAY(int, s.components + 1), NEW_ARRAY(int, n)};
    for (int b = 0, at = 0; b < s.components; b++) {
        for (int i = 0; i < n; i++)
            if (s.component[i] == s.components - 1 - b)
                out.order[at++] = i;
        out.start[b + 1] = at;
    }
    mem_free(s.number);
    mem_free(s.low);
    mem_free(s.open);
    mem_free(s.path);
    mem_free(s.next);
    mem_free(s.component);
    return out;
}

void blocks_free(Blocks *blocks)
{
    mem_free(blocks->start);
    mem_free(blocks->order);
    *blocks = (Blocks){0};
}

/* --- matching --- */

/* Give row r a column, moving others along a shortest alternating path. */
static bool place_row(const bool *pattern, int n, int r, int *column, int *row, int *from,
                      int *queue)
{
    int count = 0;

    for (int c = 0; c < n; c++)
        from[c] = -1;
    queue[count++] = r;
    for (int k = 0; k < count; k++)
        for (int c = 0; c < n; c++) {
            if (!pattern[queue[k] * n + c] || from[c] >= 0)
                continue;
            from[c] = queue[k];
            if (row[c] >= 0) {
                queue[count++] = row[c];
                continue;
            }
            while (c >= 0) {
                const int mover = from[c], left = column[mover];

                column[mover] = c;
                row[c] = mover;
                c = mover == r ? -1 : left;
            }
            return true;
        }
    return false;
}

bool blocks_match(const bool *pattern, int n, int *column)
{
    int *row = NEW_ARRAY(int, n), *from = NEW_ARRAY(int, n), *queue = NEW_ARRAY(int, n + 1);
    bool all = true;

    for (int i = 0; i < n; i++)
        row[i] = column[i] = -1;
    for (int r = 0; r < n && all; r++)
        all = place_row(pattern, n, r, column, row, from, queue);
    mem_free(row);
    mem_free(from);
    mem_free(queue);
    return all;
}

/* --- two kinds --- */

bool blocks_alternate(const bool *pattern, int n)
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
    mem_free(kind);
    mem_free(queue);
    return alternate;
}
