/* write_code.c: the formats that are code in a programming language */
#include "export/code.h"

static Status write_in(const Exported *what, const Language *language, Text *out, Diag *diag)
{
    Code *code = NULL;

    TRY(code_new(what, false, &code, diag));
    language->file(code, language, out);
    code_free(code);
    return OK;
}

#define LANGUAGE(word)                                                                             \
    static Status write_##word(const Exported *what, Text *out, Diag *diag)                        \
    {                                                                                              \
        return write_in(what, &language_##word, out, diag);                                        \
    }                                                                                              \
    const Format format_##word = {.need = NEED_CODE, .write = write_##word};

LANGUAGE(c)
LANGUAGE(python)
LANGUAGE(fortran)
LANGUAGE(matlab)
