/* threads.h: work in pieces, on as many threads as are given
 *
 * Which thread takes which piece is left to chance, so pieces write to places of their own, and
 * what they make together is put together afterwards in an order of its own: then results are the
 * same for any number of threads. A piece allocates nothing, and neither polls nor fails.
 *
 * Threads begin with the first work and wait for the next: a moment awake, then asleep. Signals are
 * left to the thread that asks. Where the system refuses a thread, those that are there do it. */
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
/* Do pieces 0 to count - 1, and return when all are done. The caller's thread takes its share; it
 * does all of them where `threads` is NULL or busy with other work. */
void threads_do(Threads *threads, int count, void (*piece)(void *context, int which),
                void *context);

#endif
