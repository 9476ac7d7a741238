/* diag.c: messages */
#include "base/diag.h"

#include <stdarg.h>
#include <stdio.h>

static void fill(Diag *diag, Status status, Place place, const char *format, va_list args)
{
    if (diag == NULL)
        return;
    diag->status = status;
    diag->place = place;
    diag->hint[0] = diag->about[0] = diag->inside[0] = '\0';
    (void)vsnprintf(diag->message, sizeof diag->message, format, args);
}

Status diag_set(Diag *diag, Status status, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    fill(diag, status, (Place){0, 0, 0}, format, args);
    va_end(args);
    return status;
}

Status diag_at(Diag *diag, Status status, Place place, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    fill(diag, status, place, format, args);
    va_end(args);
    return status;
}

void diag_hint(Diag *diag, const char *format, ...)
{
    va_list args;

    if (diag == NULL)
        return;
    va_start(args, format);
    (void)vsnprintf(diag->hint, sizeof diag->hint, format, args);
    va_end(args);
}

void diag_about(Diag *diag, const char *format, ...)
{
    va_list args;

    if (diag == NULL)
        return;
    va_start(args, format);
    (void)vsnprintf(diag->about, sizeof diag->about, format, args);
    va_end(args);
}

const char *status_text(Status status)
{
    static const char *const texts[] = {
#define STATUS(name, text) [name] = text,
#include "base/status.def"
#undef STATUS
    };
    return texts[status];
}
