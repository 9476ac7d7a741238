/* out_of_memory.c: the last words, which need no memory */
#include "out_of_memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool is_kept;

static void say(const char *text)
{
    const ssize_t written = write(STDERR_FILENO, text, strlen(text));

    (void)written; /* an error can't be reported any more */
}

_Noreturn void out_of_memory(void)
{
    say("\ncotree: out of memory\n");
    if (is_kept)
        say("the model was not saved: it is kept, and recover brings it back\n");
    (void)fflush(stdout);
    _exit(EXIT_FAILURE);
}

void out_of_memory_note(bool kept)
{
    is_kept = kept;
}
