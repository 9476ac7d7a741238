/* notation.c: the table of notations, and an expression printed in one of them */
#include "expr/print_impl.h"

#include <string.h>

const NotationRow *notation_row(Notation notation)
{
    static const NotationRow rows[] = {
#define NOTATION(id, word, dialect, kind, ...) {word, NOTATION_##kind, __VA_ARGS__},
#include "expr/notations.def"
#undef NOTATION
    };
    return &rows[notation];
}

bool notation_find(const char *word, Notation *out)
{
    for (Notation i = NOTATION_TEXT; i < NOTATIONS; i++)
        if (notation_row(i)->word != NULL && strcmp(notation_row(i)->word, word) == 0) {
            *out = i;
            return true;
        }
    return false;
}

void expr_print(Text *text, Expr e, Notation notation)
{
    static const Dialect *const dialects[] = {
#define NOTATION(id, word, dialect, ...) [NOTATION_##id] = dialect,
#include "expr/notations.def"
#undef NOTATION
    };

    if (dialects[notation] == NULL)
        print_tree(text, e);
    else
        print_with(text, e, dialects[notation]);
}

char *expr_text(Expr e)
{
    Text text = {0};

    expr_print(&text, e, NOTATION_TEXT);
    return text_done(&text);
}
