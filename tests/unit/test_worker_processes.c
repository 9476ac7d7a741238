/* test_worker_processes.c: pieces in processes: each is done once, and a crash loses one of them */
#include "base/worker_processes.h"

#include "test.h"

#include <signal.h>
#include <unistd.h>

enum { PIECES = 200, CRASHES = 3, STOP_AFTER = 20 };

typedef struct Work {
    int taken[PIECES], lost[PIECES];
    double results[PIECES];
    int crash[CRASHES]; /* pieces that end their process */
    int count, stop_after;
    char why[200];
} Work;

static void do_piece(void *context, int which, void *result)
{
    const Work *work = context;

    for (int i = 0; i < CRASHES; i++)
        if (work->crash[i] == which)
            (void)raise(SIGKILL);
    if (work->stop_after > 0)
        (void)usleep(10000);
    *(double *)result = which * 0.1;
}

static void take(void *context, int which, const void *result)
{
    Work *work = context;

    memcpy(&work->results[which], result, sizeof(double));
    work->taken[which]++;
    work->count++;
}

static void lose(void *context, int which, const char *why)
{
    Work *work = context;

    work->lost[which]++;
    (void)snprintf(work->why, sizeof work->why, "%s", why);
}

static bool has_to_stop(void *context)
{
    const Work *work = context;

    return work->stop_after > 0 && work->count >= work->stop_after;
}

static void do_all(Work *work, int workers)
{
    const WorkPlan plan = {.first = 1,
                           .end = PIECES,
                           .workers = workers,
                           .size = sizeof(double),
                           .piece = do_piece,
                           .take = take,
                           .lose = lose,
                           .stop = has_to_stop,
                           .context = work};

    worker_processes_do(&plan);
}

static void each_piece_is_done_once(void)
{
    static const int workers[] = {1, 2, 8, MOST_WORKERS};

    for (size_t w = 0; w < sizeof workers / sizeof workers[0]; w++) {
        Work work = {.crash = {-1, -1, -1}};

        do_all(&work, workers[w]);
        EXPECT(work.taken[0] == 0 && work.count == PIECES - 1);
        for (int i = 1; i < PIECES; i++)
            EXPECT(work.taken[i] == 1 && work.lost[i] == 0 && work.results[i] == i * 0.1);
    }
}

/* also of the only worker: others are started */
static void a_crash_loses_its_piece(void)
{
    for (int workers = 1; workers <= 3; workers++) {
        Work work = {.crash = {1, 50, PIECES - 1}};

        do_all(&work, workers);
        for (int i = 1; i < PIECES; i++) {
            const bool is_lost = i == 1 || i == 50 || i == PIECES - 1;

            EXPECT(work.taken[i] == !is_lost && work.lost[i] == is_lost);
        }
        EXPECT(strstr(work.why, "signal 9") != NULL);
    }
}

static void a_stop_keeps_what_is_done(void)
{
    Work work = {.crash = {-1, -1, -1}, .stop_after = STOP_AFTER};

    do_all(&work, 2);
    EXPECT(work.count >= STOP_AFTER && work.count < PIECES - 1);
    for (int i = 0; i < PIECES; i++)
        EXPECT(work.taken[i] <= 1 && work.lost[i] == 0 &&
               (work.taken[i] == 0 || work.results[i] == i * 0.1));
}

int main(void)
{
    RUN(each_piece_is_done_once);
    RUN(a_crash_loses_its_piece);
    RUN(a_stop_keeps_what_is_done);
    return test_end();
}
