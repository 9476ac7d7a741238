/* report_error.h: errors and remarks on standard error: where, the line, a caret, the way out */
#ifndef COTREE_SRC_REPORT_ERROR_H
#define COTREE_SRC_REPORT_ERROR_H

#include "cotree.h"

/* Name and position of a piece of text. */
typedef struct Origin {
    const char *name; /* of the file, "-e", "<stdin>"; NULL: typed at the prompt */
    int line;         /* of the first physical line of the text; from 1 */
    int prompt;       /* columns of the prompt before it, where the caret may stand under the line
                         as typed; 0: the line is shown again */
} Origin;

/* Fill `error` and return CT_FAILED; no place, no hint. */
ct_status error_set(ct_error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* add a hint */
void error_hint(ct_error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Show an error in a logical line (its physical lines joined by newlines). */
void report_error(const Origin *origin, const char *text, const ct_error *error);
void remark(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
