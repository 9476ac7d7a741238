/* interrupt.c: Ctrl-C and other signals become flags that long work looks at */
#include "interrupt.h"

#include <stddef.h>
#include <unistd.h>

enum { PATIENCE = 2 }; /* s, between the request to end and the forced end */

static volatile sig_atomic_t asked, ending, resized, continued, second_ends;

static void on_interrupt(int number)
{
    if (asked && second_ends) {
        signal(number, SIG_DFL);
        raise(number);
    }
    asked = 1;
}

/* running work may save its results; if it doesn't check the flag in time, the alarm ends the
 * program */
static void on_end(int number)
{
    ending = number;
    alarm(PATIENCE);
}

static void on_resize(int number)
{
    (void)number;
    resized = 1;
}

static void on_continue(int number)
{
    (void)number;
    continued = 1;
}

/* no SA_RESTART: a read that waits for a pipe has to return */
static void handle(int number, void (*handler)(int))
{
    struct sigaction action = {.sa_handler = handler};

    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

void interrupt_setup(bool interactive)
{
    second_ends = !interactive;
    handle(SIGINT, on_interrupt);
    handle(SIGTERM, on_end);
    handle(SIGHUP, on_end);
    handle(SIGWINCH, on_resize);
    handle(SIGCONT, on_continue);
    handle(SIGPIPE, SIG_IGN);
}

bool interrupt_asked(void)
{
    return asked != 0 || ending != 0;
}

void interrupt_clear(void)
{
    asked = 0;
}

int interrupt_ending(void)
{
    return ending;
}

bool interrupt_resized(void)
{
    bool was = resized != 0;

    resized = 0;
    return was;
}

bool interrupt_continued(void)
{
    bool was = continued != 0;

    continued = 0;
    return was;
}

void interrupt_hold(sigset_t *wait)
{
    sigset_t held;

    sigemptyset(&held);
    sigaddset(&held, SIGINT);
    sigaddset(&held, SIGTERM);
    sigaddset(&held, SIGHUP);
    sigaddset(&held, SIGWINCH);
    sigaddset(&held, SIGCONT);
    sigprocmask(SIG_BLOCK, &held, wait);
}

void interrupt_release(const sigset_t *wait)
{
    sigprocmask(SIG_SETMASK, wait, NULL);
}

void interrupt_forget(void)
{
    sigset_t none;

    signal(SIGINT, SIG_DFL);
    signal(SIGPIPE, SIG_DFL);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
}
