/* write.h: files in other formats
 *
 * A format is a line of formats.def, and its row here: what it needs, and who writes it. */
#ifndef COTREE_EXPORT_WRITE_H
#define COTREE_EXPORT_WRITE_H

#include "present/show.h"
#include "simulate/analyse/linearize.h"
#include "simulate/run/result_reader.h"

/* Drivers whose motion is an input of the code, of the model and equations of a view. New;
 * inverse_free(). E_MODEL: there are none. */
typedef struct Inverse Inverse;
MUST_USE Status inverse_new(const View *view, Inverse **out, Diag *diag);
void inverse_free(Inverse *inverse); /* NULL is fine */

/* What is to be written; `view` has the equations that the format needs. */
typedef struct Exported {
    View view;
    /* of NEED_RUN: numbers row by row, and the names of their columns, */
    const char *const *names;
    const char *const *units; /* in which they are; "" where that isn't known */
    const double *values;
    int rows, columns;
    /* of NEED_CODE: formulas over the user's variables, called `names`, and the assembled start */
    const Expr *items;
    int item_count;
    ResultReader *start;
    const Inverse *inverse;              /* efforts of drivers from their motion; NULL */
    const Modes *modes;                  /* or these; NULL */
    const SweepTable *sweep;             /* that the numbers are of; NULL */
    bool with_header;                    /* the file is new */
    int version;                         /* of FMUs, 2 or 3 */
    bool only_exchange, only_simulation; /* else both kinds */
} Exported;

struct Archive; /* archive.h */
typedef struct Format {
    Need need;
    Status (*write)(const Exported *what, Text *out, Diag *diag); /* NULL: it is no text, but */
    Status (*pack)(const Exported *what, struct Archive **out, Diag *diag); /* files in a new one */
    bool splits_units; /* units are apart from the names of columns */
    bool takes_keys;   /* of the statement, which choose among its forms */
} Format;

#define FORMAT(word, brief) extern const Format format_##word;
#include "language/formats.def"
const Format *format_find(const char *name); /* NULL: none */

/* numbers row by row, 17 digits; names quoted if they contain a comma or a quote (RFC 4180) */
void write_csv(Text *out, const char *const *names, const double *values, int rows, int columns,
               bool with_header);

#endif
