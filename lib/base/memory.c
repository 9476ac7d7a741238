/* memory.c: memory, pools, growing arrays */
#include "base/memory.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void (*on_end)(void);

void mem_on_end(void (*ended)(void))
{
    on_end = ended;
}

static void *must(void *piece)
{
    if (piece == NULL) {
        if (on_end != NULL)
            on_end();
        (void)fputs("cotree: out of memory\n", stderr);
        abort();
    }
    return piece;
}

void *mem_new(size_t size)
{
    return must(calloc(1, size > 0 ? size : 1));
}

void *mem_array(size_t count, size_t size)
{
    return must(calloc(count > 0 ? count : 1, size > 0 ? size : 1));
}

void *mem_grow(void *old, size_t count, size_t size)
{
    return must(reallocarray(old, count > 0 ? count : 1, size));
}

char *mem_text(const char *text, size_t length)
{
    char *copy = mem_new(length + 1);

    memcpy(copy, text, length);
    return copy;
}

void mem_free(void *piece)
{
    free(piece);
}

void *list_room(void *at, int count, int *room, size_t size)
{
    if (count <= *room)
        return at;
    *room = count < 8 ? 8 : count + count / 2;
    return mem_grow(at, (size_t)*room, size);
}

typedef struct Chunk {
    struct Chunk *older;
    size_t size;
    size_t used;
    _Alignas(16) unsigned char bytes[];
} Chunk;

struct Pool {
    Chunk *newest;
    size_t chunk_size;
    size_t held;
};

Pool *pool_new(size_t chunk_size)
{
    Pool *pool = NEW(Pool);

    pool->chunk_size = chunk_size > 0 ? chunk_size : 65536;
    return pool;
}

void pool_free(Pool *pool)
{
    if (pool == NULL)
        return;
    pool_release(pool, (PoolMark){NULL, 0});
    mem_free(pool);
}

void *pool_alloc(Pool *pool, size_t size)
{
    Chunk *chunk = pool->newest;
    void *piece;

    size = (size + 15) & ~(size_t)15;
    if (chunk == NULL || chunk->size - chunk->used < size) {
        size_t room = size > pool->chunk_size ? size : pool->chunk_size;

        chunk = must(malloc(sizeof(Chunk) + room));
        *chunk = (Chunk){.older = pool->newest, .size = room};
        pool->newest = chunk;
        pool->held += sizeof(Chunk) + room;
    }
    piece = chunk->bytes + chunk->used;
    chunk->used += size;
    return memset(piece, 0, size);
}

char *pool_text(Pool *pool, const char *text, size_t length)
{
    char *copy = pool_alloc(pool, length + 1);

    memcpy(copy, text, length);
    return copy;
}

PoolMark pool_mark(const Pool *pool)
{
    return (PoolMark){pool->newest, pool->newest != NULL ? pool->newest->used : 0};
}

void pool_release(Pool *pool, PoolMark mark)
{
    while (pool->newest != mark.chunk) {
        Chunk *chunk = pool->newest;

        pool->newest = chunk->older;
        pool->held -= sizeof(Chunk) + chunk->size;
        free(chunk);
    }
    if (pool->newest != NULL)
        pool->newest->used = mark.used;
}

size_t pool_bytes(const Pool *pool)
{
    return pool->held;
}
