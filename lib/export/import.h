/* import.h: statements of ours from the text of another program's file
 *
 * A format is a line of importers.def, and a function in lib/export. Its input is translated to
 * statements. Elements without an equivalent statement are omitted, and reported with their line in
 * a comment and in a remark. Names are made legal, and numbered where they clash. */
#ifndef COTREE_EXPORT_IMPORT_H
#define COTREE_EXPORT_IMPORT_H

#include "base/memory.h"
#include "base/names.h"
#include "base/text.h"

/* names of a part of the file that has its own, as a subsystem; the file's parameters are known
 * there, too */
typedef struct ImportScope {
    Names *names;            /* names in use, ours */
    Names *keys;             /* a kind and a name of the file */
    LIST(const char *) ours; /* by key */
} ImportScope;

typedef struct Import {
    const char *file;   /* as the user calls it */
    bool is_alone;      /* the statements make a complete model, which may have a title */
    bool ignores_case;  /* names of the file that differ only in case are one */
    Pool *pool;         /* of all that its reader makes */
    Names *verbs;       /* words that no parameter has */
    ImportScope whole;  /* names of the file, */
    ImportScope *scope; /* and those of the part that is being read */
    Text script;        /* the statements, a line each */
    LIST(int) from;     /* by line of the script: line of the file; 0: of none */
    Text remarks;       /* lines */
    int missing;        /* parts of the model that were left out; */
    int missing_line;   /* the first of them */
    const char *missing_what;
} Import;

/* reads a text; what can't be left out without another meaning fails with a message */
typedef Status Importer(Import *import, const char *text, size_t length, Diag *diag);
#define IMPORTER(word, brief) Importer importer_##word;
#include "language/importers.def"
#undef IMPORTER

Import *import_new(const char *file, bool is_alone); /* new; import_free() */
void import_free(Import *import);
/* a name that the model has already */
void import_make_name(Import *import, const char *name);
/* NULL: unknown format */
Importer *importer_find(const char *format);

/* --- for importers --- */

/* The name here of what the file calls so; `kind` separates the file's spaces of names. */
enum { IMPORT_PARAMETER = 'p' };
const char *import_name(Import *import, char kind, const char *name);
/* the same where it has been met; NULL */
const char *import_known(const Import *import, char kind, const char *name);
/* Start and end of a part with names of its own; names used before can't be reused in it. Such
 * parts aren't nested. */
void import_enter(Import *import, ImportScope *scope);
void import_return(Import *import);
void import_scope_free(ImportScope *scope); /* its arrays */
/* a text that lives as long as the import */
const char *import_text(Import *import, const char *format, ...) PRINTF(2, 3);
/* a number as it is written in statements, exact */
const char *import_number(Import *import, double value);
/* Add a statement made from that line of the file. False: it doesn't read, and was left out as a
 * part. */
bool import_add(Import *import, int line, const char *format, ...) PRINTF(3, 4);
/* the file's name of its model, in a comment if the model has other parts; NULL: none */
void import_title(Import *import, int line, const char *title);
void import_comment(Import *import, int line, const char *format, ...) PRINTF(3, 4);
/* what has to be known about what was made: a comment and a remark */
void import_remark(Import *import, int line, const char *format, ...) PRINTF(3, 4);
/* Report an element of the file without equivalent statement, in a comment and a remark. A part is
 * an element without which the model is incomplete. */
void import_leave(Import *import, int line, bool is_part, const char *what, const char *format, ...)
    PRINTF(5, 6);
/* the message about a file that is refused */
MUST_USE Status import_refuse(const Import *import, int line, Diag *diag, const char *format, ...)
    PRINTF(4, 5);

#endif
