/* threads.c: pieces are assigned by counting down
 *
 * `left` counts pieces that no thread has started. A thread that decrements it owns that piece, and
 * the work isn't replaced until the piece is done. `undone` counts unfinished pieces. Between two
 * pieces of work `left` is 0, so that no thread reads the fields while they are written. */
#include "base/threads.h"

#include "base/clock.h"
#include "base/memory.h"

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>

/* s: how long an idle thread polls before it sleeps. Longer than the time between two evaluations
 * of a model that is large enough for threads, too short to be noticed. */
#define AWAKE 1e-4
enum { LOOKS = 64 }; /* between looks at the clock */

struct Threads {
    atomic_int left, undone;
    atomic_flag is_busy;
    atomic_int asleep;
    atomic_bool is_over;
    void (*piece)(void *context, int which);
    void *context;
    int wanted, started; /* without the caller's thread; refused ones count as started */
    int count;           /* threads running */
    pthread_t thread[MOST_THREADS - 1];
    pthread_mutex_t lock;
    pthread_cond_t wake;
    Cleanup cleanup;
};

static inline void pause_a_little(void)
{
#if defined __x86_64__ || defined __i386__
    __builtin_ia32_pause();
#endif
}

/* false: none is left */
static bool take_piece(Threads *t)
{
    int left = atomic_load(&t->left);

    do {
        if (left == 0)
            return false;
    } while (!atomic_compare_exchange_weak(&t->left, &left, left - 1));
    t->piece(t->context, left - 1);
    (void)atomic_fetch_sub(&t->undone, 1);
    return true;
}

static void keep_spinning(Threads *t)
{
    const double until = clock_now() + AWAKE;

    do {
        for (int i = 0; i < LOOKS; i++) {
            if (atomic_load_explicit(&t->left, memory_order_relaxed) > 0 ||
                atomic_load_explicit(&t->is_over, memory_order_relaxed))
                return;
            pause_a_little();
        }
    } while (clock_now() < until);
}

/* A thread that has announced its sleep checks once more, so that no wake-up is lost. */
static void sleep_until_work(Threads *t)
{
    (void)pthread_mutex_lock(&t->lock);
    (void)atomic_fetch_add(&t->asleep, 1);
    while (atomic_load(&t->left) == 0 && !atomic_load(&t->is_over))
        (void)pthread_cond_wait(&t->wake, &t->lock);
    (void)atomic_fetch_sub(&t->asleep, 1);
    (void)pthread_mutex_unlock(&t->lock);
}

static void *work(void *context)
{
    Threads *t = context;

    while (!atomic_load(&t->is_over)) {
        while (take_piece(t))
            ;
        keep_spinning(t);
        if (atomic_load(&t->left) == 0)
            sleep_until_work(t);
    }
    return NULL;
}

static void wake_all(Threads *t)
{
    (void)pthread_mutex_lock(&t->lock);
    (void)pthread_cond_broadcast(&t->wake);
    (void)pthread_mutex_unlock(&t->lock);
}

/* end the running threads */
static void end_all(Threads *t)
{
    atomic_store(&t->is_over, true);
    wake_all(t);
    for (int i = 0; i < t->count; i++)
        (void)pthread_join(t->thread[i], NULL);
    t->count = t->started = 0;
    atomic_store(&t->is_over, false);
}

static void start(Threads *t)
{
    sigset_t all, before;

    (void)sigfillset(&all);
    if (pthread_sigmask(SIG_SETMASK, &all, &before) != 0)
        return;
    for (; t->started < t->wanted; t->started++)
        if (pthread_create(&t->thread[t->count], NULL, work, t) == 0)
            t->count++;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
}

static void close_threads(void *object)
{
    Threads *t = object;

    end_all(t);
    (void)pthread_cond_destroy(&t->wake);
    (void)pthread_mutex_destroy(&t->lock);
    cleanup_close(&t->cleanup);
}

Threads *threads_new(void)
{
    const bool was_scratch = mem_scratch(true); /* not part of the call's transaction */
    Threads *t = NEW(Threads);

    (void)mem_scratch(was_scratch);
    atomic_flag_clear(&t->is_busy);
    (void)pthread_mutex_init(&t->lock, NULL);
    (void)pthread_cond_init(&t->wake, NULL);
    cleanup_open(&t->cleanup, close_threads, t);
    return t;
}

void threads_free(Threads *t)
{
    if (t == NULL)
        return;
    close_threads(t);
    mem_free(t);
}

void threads_set(Threads *t, int count)
{
    const int wanted = count < 1 ? 0 : count > MOST_THREADS ? MOST_THREADS - 1 : count - 1;

    if (t == NULL || wanted == t->wanted)
        return;
    end_all(t);
    t->wanted = wanted;
}

int threads_count(const Threads *t)
{
    return t != NULL ? t->wanted + 1 : 1;
}

static void do_all(int count, void (*piece)(void *context, int which), void *context)
{
    for (int i = 0; i < count; i++)
        piece(context, i);
}

/* A piece runs outside the transaction: nothing in it may leave the call. */
static void do_share(Threads *t, int count, void (*piece)(void *context, int which), void *context)
{
    Transaction *const own = transaction_now;

    t->piece = piece;
    t->context = context;
    atomic_store(&t->undone, count);
    atomic_store(&t->left, count);
    if (atomic_load(&t->asleep) > 0)
        wake_all(t);
    transaction_now = NULL;
    while (take_piece(t))
        ;
    transaction_now = own;
    while (atomic_load(&t->undone) > 0)
        pause_a_little();
    t->context = NULL;
}

void threads_do(Threads *t, int count, void (*piece)(void *context, int which), void *context)
{
    if (t == NULL || t->wanted == 0 || count < 2 || atomic_flag_test_and_set(&t->is_busy)) {
        do_all(count, piece, context);
        return;
    }
    if (t->started < t->wanted)
        start(t);
    if (t->count > 0)
        do_share(t, count, piece, context);
    else
        do_all(count, piece, context);
    atomic_flag_clear(&t->is_busy);
}
