/* worker_processes.c: children by fork(), a pipe from each, and a counter in shared memory
 *
 * A worker adds 1 to `next` to get a piece, writes its number to `current` while it works, and
 * sends the number and the result. The pipe of a worker that ended is closed, and its last
 * `current` is the piece that was lost. */
#include "base/worker_processes.h"

#include "base/memory.h"

#include <errno.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

enum {
    LOOK_EVERY = 50, /* ms: between calls of plan->stop */
    EXIT_MEMORY = 3  /* of a worker that ran out of memory */
};

typedef struct SharedCounters {
    atomic_int next;
    atomic_int current[MOST_WORKERS]; /* -1: none */
} SharedCounters;

typedef struct Worker {
    pid_t process; /* 0: none */
    int from;      /* end of its pipe */
    int last;      /* piece that arrived last; -1: none */
    char *record;  /* that is being read: number and result */
    size_t length; /* bytes of it that arrived */
} Worker;

typedef struct Workers {
    const WorkPlan *plan;
    SharedCounters *shared;
    Worker at[MOST_WORKERS];
    int count;
    size_t record; /* bytes */
    Cleanup cleanup;
} Workers;

int worker_processes_available(void)
{
#ifdef __linux__
    cpu_set_t processors;

    if (sched_getaffinity(0, sizeof processors, &processors) == 0)
        return CPU_COUNT(&processors);
#endif
    return (int)sysconf(_SC_NPROCESSORS_ONLN);
}

/* --- in a worker --- */

/* in a record: its number is before it, and any type may stand there */
enum { RESULT_AT = _Alignof(max_align_t) };

static bool send_all(int to, const char *bytes, size_t length)
{
    while (length > 0) {
        const ssize_t sent = write(to, bytes, length);

        if (sent < 0 && errno == EINTR)
            continue;
        if (sent <= 0)
            return false;
        bytes += sent;
        length -= (size_t)sent;
    }
    return true;
}

/* Ends the process before its transaction ends, which would free pieces of the caller's. Returns
 * where memory has ended. */
static int worker_main(const Workers *workers, int number, int to)
{
    const WorkPlan *plan = workers->plan;
    atomic_int *const current = &workers->shared->current[number];
    char *record;
    int which;

    TRANSACTION(EXIT_MEMORY);
    record = mem_new(workers->record);
    while ((which = atomic_fetch_add(&workers->shared->next, 1)) < plan->end) {
        atomic_store(current, which);
        memset(record, 0, workers->record);
        memcpy(record, &which, sizeof which);
        plan->piece(plan->context, which, record + RESULT_AT);
        if (!send_all(to, record, workers->record))
            _exit(1);
        atomic_store(current, -1);
    }
    _exit(0);
}

static _Noreturn void become_worker(const Workers *workers, int number, int to)
{
    (void)signal(SIGINT, SIG_IGN); /* the caller decides */
#ifdef __linux__
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    _exit(worker_main(workers, number, to));
}

/* --- in the caller --- */

static bool start_worker(Workers *workers, int number)
{
    Worker *worker = &workers->at[number];
    int ends[2];

    if (pipe(ends) != 0)
        return false;
    atomic_store(&workers->shared->current[number], -1);
    worker->process = fork();
    if (worker->process == 0)
        become_worker(workers, number, ends[1]);
    (void)close(ends[1]);
    if (worker->process < 0) {
        worker->process = 0;
        (void)close(ends[0]);
        return false;
    }
    worker->from = ends[0];
    worker->last = -1;
    worker->length = 0;
    return true;
}

static int wait_for(pid_t process)
{
    int status = 0;

    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR)
            return 0;
    return status;
}

/* ends all that run; what they sent stays unread */
static void close_workers(void *object)
{
    Workers *workers = object;

    for (int i = 0; i < workers->count; i++) {
        Worker *worker = &workers->at[i];

        if (worker->process == 0)
            continue;
        (void)kill(worker->process, SIGKILL);
        (void)close(worker->from);
        (void)wait_for(worker->process);
        worker->process = 0;
    }
    if (workers->shared != NULL)
        (void)munmap(workers->shared, sizeof *workers->shared);
    workers->shared = NULL;
    cleanup_close(&workers->cleanup);
}

/* false: its end */
static bool read_some(const Workers *workers, Worker *worker)
{
    const WorkPlan *plan = workers->plan;
    const ssize_t got =
        read(worker->from, worker->record + worker->length, workers->record - worker->length);

    if (got < 0 && errno == EINTR)
        return true;
    if (got <= 0)
        return false;
    worker->length += (size_t)got;
    if (worker->length < workers->record)
        return true;
    worker->length = 0;
    memcpy(&worker->last, worker->record, sizeof worker->last);
    plan->take(plan->context, worker->last, worker->record + RESULT_AT);
    return true;
}

static void report_loss(const Workers *workers, int which, int status)
{
    const WorkPlan *plan = workers->plan;
    char why[200];

    if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_MEMORY)
        (void)snprintf(why, sizeof why, "its process ran out of memory");
    else if (WIFSIGNALED(status))
        (void)snprintf(why, sizeof why, "its process was ended by signal %d (%s)", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
    else
        (void)snprintf(why, sizeof why, "its process ended");
    plan->lose(plan->context, which, why);
}

/* A worker closed its pipe: it is done, or another one is started in its place. */
static void end_worker(Workers *workers, int number)
{
    Worker *worker = &workers->at[number];
    const int which = atomic_load(&workers->shared->current[number]);
    int status;

    (void)close(worker->from);
    status = wait_for(worker->process);
    worker->process = 0;
    if (which < 0 || which == worker->last)
        return;
    report_loss(workers, which, status);
    if (atomic_load(&workers->shared->next) < workers->plan->end)
        (void)start_worker(workers, number);
}

/* Read what there is, and wait `wait` ms at most; false: all have ended. */
static bool look_at_workers(Workers *workers, int wait)
{
    struct pollfd pipes[MOST_WORKERS];
    int numbers[MOST_WORKERS], count = 0;

    for (int i = 0; i < workers->count; i++)
        if (workers->at[i].process != 0) {
            pipes[count] = (struct pollfd){.fd = workers->at[i].from, .events = POLLIN};
            numbers[count++] = i;
        }
    if (count == 0)
        return false;
    if (poll(pipes, (nfds_t)count, wait) <= 0)
        return true;
    for (int i = 0; i < count; i++)
        if (pipes[i].revents != 0 && !read_some(workers, &workers->at[numbers[i]]))
            end_worker(workers, numbers[i]);
    return true;
}

/* after a stop: what was finished before it */
static void read_rest(Workers *workers)
{
    atomic_store(&workers->shared->next, workers->plan->end);
    for (int i = 0; i < workers->count; i++)
        if (workers->at[i].process != 0) {
            (void)kill(workers->at[i].process, SIGKILL);
            while (read_some(workers, &workers->at[i]))
                ;
        }
}

void worker_processes_do(const WorkPlan *plan)
{
    Workers *workers = NEW(Workers);
    void *shared = mmap(NULL, sizeof(SharedCounters), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);

    workers->plan = plan;
    workers->record = RESULT_AT + plan->size;
    for (int i = 0; i < plan->workers && i < MOST_WORKERS; i++)
        workers->at[i].record = mem_new(workers->record);
    workers->shared = shared != MAP_FAILED ? shared : NULL;
    cleanup_open(&workers->cleanup, close_workers, workers);
    if (workers->shared != NULL) {
        atomic_store(&workers->shared->next, plan->first);
        while (workers->count < plan->workers && workers->count < MOST_WORKERS &&
               start_worker(workers, workers->count))
            workers->count++;
        while (look_at_workers(workers, LOOK_EVERY))
            if (plan->stop(plan->context)) {
                read_rest(workers);
                break;
            }
    }
    close_workers(workers);
    for (int i = 0; i < MOST_WORKERS; i++)
        mem_free(workers->at[i].record);
    mem_free(workers);
}
