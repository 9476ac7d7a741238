/* terminal.c: properties of the terminal: its size, and the width of text */
#include "terminal.h"

#include <langinfo.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <wchar.h>

void terminal_size(int *rows, int *columns)
{
    struct winsize size = {0};

    *rows = 24;
    *columns = 80;
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 && size.ws_col > 0) {
        *rows = size.ws_row;
        *columns = size.ws_col;
    }
}

bool terminal_is_utf8(void)
{
    return strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
}

bool terminal_is_dumb(void)
{
    const char *term = getenv("TERM");

    return term == NULL || *term == '\0' || strcmp(term, "dumb") == 0;
}

int terminal_character(const char *text, size_t length, int *columns)
{
    wchar_t c = 0;
    mbstate_t state = {0};
    size_t bytes = mbrtowc(&c, text, length, &state);

    *columns = 1;
    if (bytes == 0 || bytes > length)
        return 1;

    int width = wcwidth(c);

    if (width >= 0)
        *columns = width;
    return (int)bytes;
}

int terminal_width(const char *text, size_t length)
{
    int width = 0;

    for (size_t i = 0; i < length;) {
        int columns;

        i += (size_t)terminal_character(text + i, length - i, &columns);
        width += columns;
    }
    return width;
}
