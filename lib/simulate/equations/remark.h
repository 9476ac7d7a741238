/* remark.h: remarks of a run besides its numbers
 *
 * The code that finds something adds a remark: its kind, the part that it is about, when it
 * happened, how much. Callers query these; remark.def and remark.c alone contain the wording. */
#ifndef COTREE_SIMULATE_EQUATIONS_REMARK_H
#define COTREE_SIMULATE_EQUATIONS_REMARK_H

#include "base/memory.h"
#include "base/text.h"

typedef enum RemarkKind {
#define REMARK(kind, warns) REMARK_##kind,
#include "simulate/equations/remark.def"
#undef REMARK
    REMARK_KINDS
} RemarkKind;

/* remark.def defines which of these fields a kind has */
typedef struct Remark {
    RemarkKind kind;
    const char *what, *more, *others;
    double t; /* s */
    double size, to;
    int count, of;
    const double *times; /* s, rising */
    int time_count;
} Remark;

/* {0} is empty; remarks_free() */
typedef struct Remarks {
    LIST(Remark) list;
    Pool *pool; /* of texts and times */
} Remarks;

void remarks_add(Remarks *remarks, Remark remark); /* texts and times are copied */
void remarks_append(Remarks *remarks, const Remarks *more);
void remarks_free(Remarks *remarks);
/* a line of its words, with "warning: " where it warns; no newline */
void remark_write(const Remark *remark, Text *out);
/* all of them, one line each */
void remarks_write(const Remarks *remarks, Text *out);

#endif
