/* memory.c: memory, pools, growing arrays */
#include "base/memory.h"

#include "base/memory_impl.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* for tests: a table, list, arena or pool that starts with one element has to grow at once */
#ifdef COTREE_SMALL
enum { FIRST_ROOM = 1, FIRST_CHUNK = 16 };
#else
enum { FIRST_ROOM = 8, FIRST_CHUNK = 65536 };
#endif

/* With failing allocations what a transaction finds moves whenever something is added, so that no
 * byte of it has a reason to change (faults.c). */
#define MOVES_ALWAYS(memory)                                                                       \
    (FAULTS && transaction_is_trial() && (memory) != NULL && mem_is_old(memory))

/* the caller of an allocation, for debugging */
#define CALLER __builtin_return_address(0)

/* --- pieces --- */

/* the size of so many elements; SIZE_MAX, which can't be allocated, on overflow */
static size_t product(size_t count, size_t size)
{
    size_t out;

    return __builtin_mul_overflow(count, size, &out) ? SIZE_MAX : out;
}

void *mem_new(size_t size)
{
    return piece_new(size, true, CALLER) + 1;
}

void *mem_array(size_t count, size_t size)
{
    return piece_new(product(count, size), true, CALLER) + 1;
}

void *mem_grow(void *old, size_t count, size_t size)
{
    const size_t bytes = product(count, size);

    if (old == NULL)
        return piece_new(bytes, false, CALLER) + 1;
    return piece_resize(piece_of(old), bytes, CALLER) + 1;
}

char *mem_text(const char *text, size_t length)
{
    char *copy = mem_new(length + 1);

    memcpy(copy, text, length);
    return copy;
}

void mem_free(void *piece)
{
    if (piece != NULL)
        piece_drop(piece_of(piece));
}

void mem_free_each(void *const pieces[], int count)
{
    for (int i = 0; i < count; i++)
        mem_free(pieces[i]);
}

static void *room_for(void *at, int count, int *room, size_t size, const void *maker)
{
    const int more = count < FIRST_ROOM ? FIRST_ROOM : count + count / 2;

    at = mem_grow(at, (size_t)more, size);
    if (piece_of(at)->maker != NULL)
        piece_of(at)->maker = maker;
    *room = more;
    return at;
}

void *list_make_room(void *at, int count, int more, int *room, size_t size)
{
    if (at == NULL || count + more > *room)
        return room_for(at, count + more, room, size, CALLER);
    mem_keep_part(at, (char *)at + (size_t)count * size, (size_t)more * size);
    return at;
}

void *list_append_room(void *at, int count, int *room, size_t size)
{
    if (FAULTS)
        return list_room(at, count - 1, 1, room, size);
    return count > *room ? room_for(at, count, room, size, CALLER) : at;
}

typedef struct Chunk {
    struct Chunk *older;
    size_t size;
    _Alignas(16) unsigned char bytes[];
} Chunk;

struct Pool {
    Chunk *newest;
    size_t used;     /* of the newest */
    Chunk *floor;    /* the newest chunk at the call's first use of the pool, */
    size_t floor_at; /* and the bytes used of it: older contents aren't overwritten */
    size_t chunk_size;
    size_t held;
};

Pool *pool_new(size_t chunk_size)
{
    Pool *pool = NEW(Pool);

    pool->chunk_size = chunk_size > 0 && chunk_size < FIRST_CHUNK ? chunk_size : FIRST_CHUNK;
    return pool;
}

void pool_free(Pool *pool)
{
    if (pool == NULL)
        return;
    pool_release(pool, (PoolMark){NULL, 0});
    mem_free(pool);
}

static inline void keep_whole(Pool *pool)
{
    if (transaction_now == NULL || piece_of(pool)->kept == transaction_now->number)
        return;
    mem_keep_now(pool);
    pool->floor = pool->newest;
    pool->floor_at = pool->used;
}

void *pool_room(Pool *pool, size_t size)
{
    void *piece;

    keep_whole(pool);
    size = (size + 15) & ~(size_t)15;
    if (pool->newest == NULL || pool->newest->size - pool->used < size ||
        MOVES_ALWAYS(pool->newest)) {
        const size_t room = size > pool->chunk_size ? size : pool->chunk_size;
        Chunk *chunk = (Chunk *)(void *)(piece_new(sizeof(Chunk) + room, false, CALLER) + 1);

        chunk->older = pool->newest;
        chunk->size = room;
        pool->newest = chunk;
        pool->used = 0;
        pool->held += sizeof(Chunk) + room;
    }
    piece = pool->newest->bytes + pool->used;
    pool->used += size;
    return piece;
}

void *pool_alloc(Pool *pool, size_t size)
{
    return memset(pool_room(pool, size), 0, size);
}

char *pool_text(Pool *pool, const char *text, size_t length)
{
    char *copy = pool_room(pool, length + 1);

    memcpy(copy, text, length);
    copy[length] = '\0';
    return copy;
}

PoolMark pool_mark(const Pool *pool)
{
    return (PoolMark){pool->newest, pool->used};
}

void pool_release(Pool *pool, PoolMark mark)
{
    keep_whole(pool);
    while (pool->newest != mark.chunk) {
        Chunk *chunk = pool->newest;

        pool->newest = chunk->older;
        pool->held -= sizeof(Chunk) + chunk->size;
        mem_free(chunk);
    }
    pool->used = mark.used;
    if (pool->newest == NULL || !mem_is_old(pool->newest) || !mem_is_old(pool))
        return;
    if (pool->newest != pool->floor)
        pool->used = pool->newest->size;
    else if (pool->used < pool->floor_at)
        pool->used = pool->floor_at;
}

void pool_retain(Pool *pool, void *at, size_t size)
{
    const Chunk *chunk = pool->newest;
    const uintptr_t where = (uintptr_t)at;

    if (transaction_now == NULL)
        return;
    while (where < (uintptr_t)chunk->bytes || where >= (uintptr_t)chunk->bytes + chunk->size)
        chunk = chunk->older;
    mem_keep_part(chunk, at, size);
}

size_t pool_bytes(const Pool *pool)
{
    return pool->held;
}
