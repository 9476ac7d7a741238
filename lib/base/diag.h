/* diag.h: an error, its position in the user's text, and a hint
 *
 * A fallible function returns Status and, when it isn't OK, fills a Diag. The
 * message is written where the facts are, in the user's words; the shell adds
 * the line and the caret. */
#ifndef COTREE_BASE_DIAG_H
#define COTREE_BASE_DIAG_H

#include <stdbool.h>

typedef enum Status {
#define STATUS(name, text) name,
#include "base/status.def"
#undef STATUS
} Status;

#define MUST_USE          __attribute__((warn_unused_result))
#define PRINTF(at, first) __attribute__((format(printf, at, first)))

/* leaves the function with what a call fails with */
#define TRY(call)                                                                                  \
    do {                                                                                           \
        const Status tried = (call);                                                               \
        if (tried != OK)                                                                           \
            return tried;                                                                          \
    } while (0)

/* the same by its one exit, where it has to tidy up; needs `Status status` and a label `done` */
#define CHECK(call)                                                                                \
    do {                                                                                           \
        if ((status = (call)) != OK)                                                               \
            goto done;                                                                             \
    } while (0)

/* a part of the user's text; line and column count from 1, 0 is "nowhere" */
typedef struct Place {
    int line;
    int column; /* in bytes */
    int width;  /* in bytes, at least 1 where there is a place */
} Place;

typedef struct Diag {
    Status status;
    Place place;
    char message[600];
    char hint[400];   /* empty where there is none */
    char inside[300]; /* the line of a definition where it arose, and a caret; empty: none */
    char about[100];  /* the variable, key or run ("run2.") that it is about; empty: none */
} Diag;

/* Fill `diag` (which may be NULL) and return `status`, so that a function can
 * end with `return diag_set(...)`. Clears all else. */
Status diag_set(Diag *diag, Status status, const char *format, ...) PRINTF(3, 4);

/* the same with a place in the text */
Status diag_at(Diag *diag, Status status, Place place, const char *format, ...) PRINTF(4, 5);

/* Add a hint to the message of diag_set(). */
void diag_hint(Diag *diag, const char *format, ...) PRINTF(2, 3);

/* Add what it is about, by name: whoever has the user's text finds the place of that. */
void diag_about(Diag *diag, const char *format, ...) PRINTF(2, 3);

/* the text of a status in status.def; never NULL */
const char *status_text(Status status);

#endif
