/* pager.c: long text, a screen at a time */
#include "pager.h"

#include "copy.h"
#include "interrupt.h"
#include "terminal.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static bool is_longer_than_screen(const char *text, size_t length)
{
    int rows, columns, lines = 0;

    terminal_size(&rows, &columns);
    while (length > 0 && lines < rows) {
        size_t n = strcspn(text, "\n");
        int width = terminal_width(text, n < length ? n : length);

        lines += width <= columns ? 1 : (width + columns - 1) / columns;
        n = n < length ? n + 1 : length;
        text += n;
        length -= n;
    }
    return lines >= rows;
}

static void become_pager(void)
{
    const char *wanted = getenv("PAGER");

    interrupt_forget();
    if (wanted != NULL && *wanted != '\0') {
        /* in the place of the shell, or Ctrl-C would end that alone and the pager go on reading */
        execl("/bin/sh", "sh", "-c", copy_format("exec env %s", wanted), (char *)NULL);
    } else {
        execlp("less", "less", "-FRX", (char *)NULL);
        execlp("more", "more", (char *)NULL);
    }
    _exit(127);
}

/* Whether a pager showed it. */
static bool page(const char *text, size_t length)
{
    int ends[2];

    if (pipe2(ends, O_CLOEXEC) != 0)
        return false;

    pid_t pid = fork();

    if (pid == 0) {
        if (dup2(ends[0], STDIN_FILENO) < 0)
            _exit(127);
        become_pager();
    }
    close(ends[0]);

    /* who leaves the pager early closes the pipe: that is no error */
    while (pid > 0 && length > 0 && !interrupt_asked()) {
        ssize_t sent = write(ends[1], text, length);

        if (sent < 0 && errno != EINTR)
            break;
        if (sent > 0) {
            text += sent;
            length -= (size_t)sent;
        }
    }
    close(ends[1]);

    int ended = 0;

    /* Ctrl-C leaves the pager, whatever that would do with it */
    do
        if (pid > 0 && interrupt_asked())
            kill(pid, SIGTERM);
    while (pid > 0 && waitpid(pid, &ended, 0) < 0 && errno == EINTR);
    interrupt_clear();
    return pid > 0 && !(WIFEXITED(ended) && WEXITSTATUS(ended) == 127);
}

void pager_show(const char *text, size_t length, bool allowed)
{
    fflush(stdout);
    if (allowed && isatty(STDOUT_FILENO) && !terminal_is_dumb() &&
        is_longer_than_screen(text, length) && page(text, length))
        return;
    fwrite(text, 1, length, stdout);
}
