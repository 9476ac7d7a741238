/* exact_memory.c: memory of GMP's numbers and FLINT's polynomials
 *
 * Each library has one set of functions a process. Ours are set once and hand on to those they
 * found, but between exact_begin() and exact_end() of this thread. */
#include "base/exact_memory.h"

#include "base/flint_library.h"
#include "base/memory.h"

#include <gmp.h>
#include <pthread.h>

/* before ours */
static struct {
    void *(*new)(size_t);
    void *(*resize)(void *, size_t, size_t);
    void (*free)(void *, size_t);
} of_gmp;

static struct {
    void *(*new)(size_t);
    void *(*new_array)(size_t, size_t);
    void *(*resize)(void *, size_t);
    void (*free)(void *);
} of_flint;

/* The transaction that is between the two; 0: none is. One that failed there is over. */
static _Thread_local uint64_t inside;
static _Thread_local int depth; /* of pairs */
/* FLINT's integers of a call that has failed: it frees all of its pieces itself */
static _Thread_local bool is_dropping;

static bool is_ours(void)
{
    return inside != 0 && transaction_now != NULL && transaction_now->number == inside;
}

static void *gmp_new(size_t size)
{
    return is_ours() ? mem_grow(NULL, size, 1) : of_gmp.new(size);
}

static void *gmp_resize(void *old, size_t before, size_t size)
{
    return is_ours() ? mem_grow(old, size, 1) : of_gmp.resize(old, before, size);
}

static void gmp_free(void *piece, size_t size)
{
    if (is_ours() && !is_dropping)
        mem_free(piece);
    else if (!is_dropping)
        of_gmp.free(piece, size);
}

static void *flint_new(size_t size)
{
    return is_ours() ? mem_grow(NULL, size, 1) : of_flint.new(size);
}

static void *flint_new_array(size_t count, size_t size)
{
    return is_ours() ? mem_array(count, size) : of_flint.new_array(count, size);
}

static void *flint_resize(void *old, size_t size)
{
    return is_ours() ? mem_grow(old, size, 1) : of_flint.resize(old, size);
}

static void flint_drop(void *piece)
{
    if (is_ours() && !is_dropping)
        mem_free(piece);
    else if (!is_dropping)
        of_flint.free(piece);
}

static void set_gmp_functions(void)
{
    mp_get_memory_functions(&of_gmp.new, &of_gmp.resize, &of_gmp.free);
    mp_set_memory_functions(gmp_new, gmp_resize, gmp_free);
}

static void set_flint_functions(void)
{
    flint.__flint_get_memory_functions(&of_flint.new, &of_flint.new_array, &of_flint.resize,
                                       &of_flint.free);
    flint.__flint_set_memory_functions(flint_new, flint_new_array, flint_resize, flint_drop);
}

void exact_begin(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;

    (void)pthread_once(&once, set_gmp_functions);
    depth = is_ours() ? depth + 1 : 1;
    inside = transaction_now != NULL ? transaction_now->number : 0;
}

void exact_end(void)
{
    if (--depth <= 0)
        inside = 0;
}

/* of a call that fails */
static void drop(void *object)
{
    (void)object;
    is_dropping = true;
    flint.flint_cleanup();
    is_dropping = false;
    inside = 0;
}

void exact_open(ExactMemory *memory)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;

    (void)pthread_once(&once, set_flint_functions);
    flint.flint_cleanup();
    exact_begin();
    cleanup_open(&memory->cleanup, drop, NULL);
}

void exact_close(ExactMemory *memory)
{
    cleanup_close(&memory->cleanup);
    flint.flint_cleanup();
    exact_end();
}
