/* memory.h: allocation that never returns NULL, chunked pools, growing arrays
 *
 * A caller can't repair running out of memory in the middle of a formula. So these functions return
 * the requested memory, or leave the current call of the library and roll it back (transaction.h).
 * Everything else in lib/ reports by Status.
 *
 * A Pool allocates pieces that never move and are freed together, or back to a mark. Its pieces are
 * borrowed from it. */
#ifndef COTREE_BASE_MEMORY_H
#define COTREE_BASE_MEMORY_H

#include "base/transaction.h"

#include <stddef.h>

void *mem_new(size_t size);                 /* new, zeroed; a valid pointer for size 0 too */
void *mem_array(size_t count, size_t size); /* new, zeroed */
void *mem_grow(void *old, size_t count, size_t size); /* realloc; what is new isn't zeroed */
char *mem_text(const char *text, size_t length);      /* new, ended by a NUL */
void mem_free(void *piece);                           /* NULL is fine */
void mem_free_each(void *const pieces[], int count);

#define NEW(type)              ((type *)mem_new(sizeof(type)))
#define NEW_ARRAY(type, count) ((type *)mem_array((size_t)(count), sizeof(type)))
#define COUNT(array)           ((int)(sizeof(array) / sizeof((array)[0])))
/* frees several: MEM_FREE(names, values); */
#define MEM_FREE(...) mem_free_each((void *[]){__VA_ARGS__}, COUNT(((void *[]){__VA_ARGS__})))

/* A growing array: `LIST(int) ids = {0}; LIST_PUSH(ids, 3); ids.at[0]; LIST_FREE(ids);`
 * Its items move when it grows. */
#define LIST(type)                                                                                 \
    struct {                                                                                       \
        type *at;                                                                                  \
        int count;                                                                                 \
        int room;                                                                                  \
    }
#define LIST_ROOM(list, more)                                                                      \
    ((list).at = list_room((list).at, (list).count, (more), &(list).room, sizeof *(list).at))
#define LIST_PUSH(list, ...) (LIST_ROOM(list, 1), (list).at[(list).count++] = __VA_ARGS__)
/* the same for a list from which a call removes none of the older elements */
#define LIST_APPEND(list, ...)                                                                     \
    ((list).at = list_more_room((list).at, (list).count + 1, &(list).room, sizeof *(list).at),     \
     (list).at[(list).count++] = __VA_ARGS__)
#define LIST_FREE(list) (mem_free((list).at), (list).at = NULL, (list).count = (list).room = 0)
void *list_make_room(void *at, int count, int more, int *room, size_t size);
static inline void *list_room(void *at, int count, int more, int *room, size_t size)
{
    /* elements removed from an old list in this call may have to be restored */
    if (at == NULL || count + more > *room || mem_is_old(at))
        return list_make_room(at, count, more, room, size);
    return at;
}
void *list_append_room(void *at, int count, int *room, size_t size);
static inline void *list_more_room(void *at, int count, int *room, size_t size)
{
#ifndef COTREE_FAULTS
    if (count <= *room)
        return at;
#endif
    return list_append_room(at, count, room, size);
}

typedef struct Pool Pool;
typedef struct PoolMark {
    void *chunk;
    size_t used;
} PoolMark;

Pool *pool_new(size_t chunk_size); /* bytes; 0: 64 KiB. New; free with pool_free() */
void pool_free(Pool *pool);
void *pool_alloc(Pool *pool, size_t size); /* zeroed, aligned to 16 bytes */
void *pool_room(Pool *pool, size_t size);  /* the same, uninitialised */
char *pool_text(Pool *pool, const char *text, size_t length);
PoolMark pool_mark(const Pool *pool);
void pool_release(Pool *pool, PoolMark mark); /* frees pieces allocated after the mark */
/* Before `size` bytes at `at`, a piece of the pool's, are changed in place: mem_keep_part(). */
void pool_retain(Pool *pool, void *at, size_t size);
size_t pool_bytes(const Pool *pool); /* allocated from the system */

#endif
