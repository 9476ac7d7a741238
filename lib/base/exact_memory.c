/* exact_memory.c: memory of GMP's numbers
 *
 * GMP has one set of functions a process. Ours are set once and hand on to those they found, but
 * between exact_begin() and exact_end() of this thread. */
#include "base/exact_memory.h"

#include "base/memory.h"

#include <gmp.h>
#include <pthread.h>

static void *(*found_new)(size_t);
static void *(*found_resize)(void *, size_t, size_t);
static void (*found_free)(void *, size_t);

/* The transaction that is between the two; 0: none is. One that failed there is over. */
static _Thread_local uint64_t inside;

static bool is_ours(void)
{
    return inside != 0 && transaction_now != NULL && transaction_now->number == inside;
}

static void *exact_new(size_t size)
{
    return is_ours() ? mem_grow(NULL, size, 1) : found_new(size);
}

static void *exact_resize(void *old, size_t before, size_t size)
{
    return is_ours() ? mem_grow(old, size, 1) : found_resize(old, before, size);
}

static void exact_free(void *piece, size_t size)
{
    if (is_ours())
        mem_free(piece);
    else
        found_free(piece, size);
}

static void set_functions(void)
{
    mp_get_memory_functions(&found_new, &found_resize, &found_free);
    mp_set_memory_functions(exact_new, exact_resize, exact_free);
}

void exact_begin(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;

    (void)pthread_once(&once, set_functions);
    inside = transaction_now != NULL ? transaction_now->number : 0;
}

void exact_end(void)
{
    inside = 0;
}
