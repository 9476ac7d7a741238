/* heap.c: what to do first: the greatest saving */
#include "expr/expr_impl.h"

static bool above(Rank a, Rank b)
{
    if (a.saving != b.saving)
        return a.saving > b.saving;
    return a.later != b.later ? a.later < b.later : a.which < b.which;
}

void heap_push(Heap *heap, Rank rank)
{
    int at = heap->count;

    LIST_PUSH(*heap, rank);
    while (at > 0 && above(rank, heap->at[(at - 1) / 2])) {
        heap->at[at] = heap->at[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    heap->at[at] = rank;
}

Rank heap_pop(Heap *heap)
{
    Rank top = heap->at[0];
    Rank last = heap->at[--heap->count];
    int at = 0;

    for (int child = 1; child < heap->count; child = 2 * at + 1) {
        if (child + 1 < heap->count && above(heap->at[child + 1], heap->at[child]))
            child++;
        if (!above(heap->at[child], last))
            break;
        heap->at[at] = heap->at[child];
        at = child;
    }
    if (heap->count > 0)
        heap->at[at] = last;
    return top;
}
