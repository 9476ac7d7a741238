/* memory_end.c: the last words, which need no memory */
#include "memory_end.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const Unsaved *kept;

static void say(const char *text)
{
    const ssize_t written = write(STDERR_FILENO, text, strlen(text));

    (void)written; /* there is nobody left to tell */
}

_Noreturn void memory_end(void)
{
    say("\ncotree: out of memory\n");
    if (unsaved_is_kept(kept))
        say("the model was not saved: it is kept, and recover brings it back\n");
    (void)fflush(stdout);
    _exit(EXIT_FAILURE);
}

void memory_end_note(const Unsaved *unsaved)
{
    kept = unsaved;
}
