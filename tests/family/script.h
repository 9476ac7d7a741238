/* script.h: the statements of a member, written piece by piece */
#ifndef COTREE_TESTS_SCRIPT_H
#define COTREE_TESTS_SCRIPT_H

#include <stdarg.h>
#include <stdio.h>

typedef struct Script {
    char text[1 << 17];
    size_t length;
} Script;

static inline void write_list(Script *script, const char *format, va_list arguments)
{
    const size_t room = sizeof script->text - script->length - 2;
    const int more = vsnprintf(script->text + script->length, room, format, arguments);

    script->length += more < 0 ? 0 : (size_t)more < room ? (size_t)more : room - 1;
}

/* as it stands, with its own ends of lines */
__attribute__((format(printf, 2, 3), unused)) static void write_piece(Script *script,
                                                                      const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    write_list(script, format, arguments);
    va_end(arguments);
}

__attribute__((format(printf, 2, 3), unused)) static void write_line(Script *script,
                                                                     const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    write_list(script, format, arguments);
    va_end(arguments);
    script->text[script->length++] = '\n';
    script->text[script->length] = '\0';
}

#endif
