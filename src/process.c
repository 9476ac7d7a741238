/* process.c: a child process, with pipes to its standard input, output and error */
#include "process.h"

#include "interrupt.h"
#include "report_error.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static void close_one(int *file)
{
    if (*file >= 0)
        close(*file);
    *file = -1;
}

/* in the child: the pipes become its standard streams; errno is returned if exec fails */
static void become(char *const argv[], int in, int out, int err, int report)
{
    setpgid(0, 0);
    interrupt_forget();
    if (dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        dup2(err, STDERR_FILENO) >= 0)
        execvp(argv[0], argv);

    int reason = errno;

    if (write(report, &reason, sizeof reason) < 0)
        _exit(126);
    _exit(127);
}

ct_status process_start(Process *process, char *const argv[], ct_error *error)
{
    int pipes[4][2] = {{-1, -1}, {-1, -1}, {-1, -1}, {-1, -1}}; /* in, out, err, exec's errno */
    int reason = 0;

    *process = (Process){.in = -1, .out = -1, .err = -1};
    for (int i = 0; i < 4 && reason == 0; i++)
        if (pipe2(pipes[i], O_CLOEXEC) != 0)
            reason = errno;
    if (reason == 0) {
        process->pid = fork();
        if (process->pid == 0)
            become(argv, pipes[0][0], pipes[1][1], pipes[2][1], pipes[3][1]);
        if (process->pid < 0)
            reason = errno;
    }
    close_one(&pipes[0][0]);
    close_one(&pipes[1][1]);
    close_one(&pipes[2][1]);
    close_one(&pipes[3][1]);

    /* the pipe closes without a word when exec succeeds */
    if (reason == 0) {
        ssize_t got;

        do
            got = read(pipes[3][0], &reason, sizeof reason);
        while (got < 0 && errno == EINTR);
        if (got != (ssize_t)sizeof reason)
            reason = 0;
    }
    close_one(&pipes[3][0]);
    process->in = pipes[0][1];
    process->out = pipes[1][0];
    process->err = pipes[2][0];
    if (reason == 0) {
        fcntl(process->in, F_SETFL, O_NONBLOCK);
        return CT_OK;
    }
    if (process->pid > 0)
        waitpid(process->pid, NULL, 0);
    process->pid = 0;
    close_one(&process->in);
    close_one(&process->out);
    close_one(&process->err);
    return error_set(error, "can't start '%s': %s", argv[0], strerror(reason));
}

bool process_lives(Process *process)
{
    if (process->pid > 0 && waitpid(process->pid, &process->ended, WNOHANG) == process->pid) {
        process->pid = 0;
        close_one(&process->in);
        close_one(&process->out);
        close_one(&process->err);
    }
    return process->pid > 0;
}

/* Read the available data; false at the end of the stream. */
static bool take(int file, OutputBuffer *paper)
{
    char piece[8192];
    ssize_t got = read(file, piece, sizeof piece);

    if (got > 0)
        fwrite(piece, 1, (size_t)got, paper->out);
    return got > 0 || (got < 0 && (errno == EINTR || errno == EAGAIN));
}

/* whether the text ends with the marked line; the text before may lack its end of line */
static bool is_marked(OutputBuffer *paper, const char *mark)
{
    size_t length = mark != NULL ? strlen(mark) : 0;

    if (mark == NULL || fflush(paper->out) != 0 || paper->length < length + 1)
        return false;

    const char *tail = paper->text + paper->length - length - 1;

    return strncmp(tail, mark, length) == 0 && tail[length] == '\n';
}

static void remove_mark(OutputBuffer *paper, const char *mark)
{
    fseek(paper->out, -(long)strlen(mark) - 1, SEEK_END);
    fflush(paper->out);
}

/* Send more of the input; false when nobody reads it any longer. */
static bool send_more(Process *process, const char **input, size_t *length)
{
    ssize_t sent = *length > 0 ? write(process->in, *input, *length) : 0;

    if (sent < 0)
        return errno == EAGAIN || errno == EINTR;
    *input += sent;
    *length -= (size_t)sent;
    return true;
}

ct_status process_exchange(Process *process, const char *input, size_t length, const char *mark,
                           OutputBuffer *out, OutputBuffer *err, ct_error *error)
{
    bool out_open = true, err_open = true;
    bool out_done = false, err_done = false;

    while ((out_open && !out_done) || (err_open && !err_done)) {
        if (interrupt_asked()) {
            error_set(error, "stopped");
            return error->status = CT_STOPPED;
        }
        if (length == 0 && mark == NULL)
            close_one(&process->in);

        struct pollfd files[3] = {{out_open ? process->out : -1, POLLIN, 0},
                                  {err_open ? process->err : -1, POLLIN, 0},
                                  {length > 0 ? process->in : -1, POLLOUT, 0}};

        /* a signal may be delivered just before: check again at intervals */
        if (poll(files, 3, 50) <= 0)
            continue;
        if (files[0].revents != 0)
            out_open = take(process->out, out);
        if (files[1].revents != 0)
            err_open = take(process->err, err);
        if (files[2].revents != 0 && !send_more(process, &input, &length))
            length = 0;
        out_done = is_marked(out, mark);
        err_done = is_marked(err, mark);
    }
    if (mark == NULL)
        return CT_OK;
    if (out_done)
        remove_mark(out, mark);
    if (err_done)
        remove_mark(err, mark);
    if (out_done && err_done)
        return CT_OK;

    char how[40];

    process_end(process, 500);
    return error_set(error, "it ended on its own (%s)", process_ending(process->ended, how));
}

int process_end(Process *process, int patience)
{
    close_one(&process->in);
    close_one(&process->out);
    close_one(&process->err);
    for (int waited = 0; process_lives(process) && waited < patience; waited += 5)
        nanosleep(&(struct timespec){.tv_nsec = 5000000}, NULL);
    if (process->pid > 0) {
        kill(-process->pid, SIGKILL); /* and what it started */
        while (waitpid(process->pid, &process->ended, 0) < 0 && errno == EINTR)
            continue;
        process->pid = 0;
    }
    return process->ended;
}

const char *process_ending(int ended, char text[40])
{
    if (WIFSIGNALED(ended))
        snprintf(text, 40, "killed by signal %d", WTERMSIG(ended));
    else
        snprintf(text, 40, "exit status %d", WEXITSTATUS(ended));
    return text;
}
