/* foreign_syntax.h: what people used to other programs and languages type, and how it is written
 * here */
#ifndef COTREE_LANGUAGE_FOREIGN_SYNTAX_H
#define COTREE_LANGUAGE_FOREIGN_SYNTAX_H

typedef enum ForeignSyntaxKind {
    FOREIGN_VERB,     /* run, exit ... */
    FOREIGN_FUNCTION, /* ln, pow ... */
    FOREIGN_NAME,     /* e, PI ... */
    FOREIGN_UNIT,     /* inch, percent ... */
    FOREIGN_OPERATOR  /* and, mod ..., between values */
} ForeignSyntaxKind;

/* a sentence with a solution; NULL: none known */
const char *foreign_syntax_hint(ForeignSyntaxKind kind, const char *word);

#endif
