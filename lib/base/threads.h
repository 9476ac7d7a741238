/* threads.h: work in pieces, on a given number of threads
 *
 * The assignment of pieces to threads is not deterministic. So each piece writes to memory of its
 * own, and the caller combines the results afterwards in a fixed order: then results are the same
 * for any number of threads. A piece allocates nothing, and neither polls nor fails.
 *
 * Threads start with the first work and wait for the next: they poll for a moment, then sleep.
 * Signals are delivered to the calling thread only. If the system refuses a thread, the others do
 * the work. */
#ifndef COTREE_BASE_THREADS_H
#define COTREE_BASE_THREADS_H

#include <stdbool.h>

enum { MOST_THREADS = 64 };

typedef struct Threads Threads;
Threads *threads_new(void);          /* new: one thread, the caller's; threads_free() */
void threads_free(Threads *threads); /* ends and joins them; NULL is fine */
/* From the next work on `count` of them at most, the caller's with them. NULL is fine. */
void threads_set(Threads *threads, int count);
int threads_count(const Threads *threads); /* 1 for NULL */
/* Do pieces 0 to count - 1, and return when all are done. The caller's thread does its share, or
 * all pieces if `threads` is NULL or busy with other work. */
void threads_do(Threads *threads, int count, void (*piece)(void *context, int which),
                void *context);

#endif
