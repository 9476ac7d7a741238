/* write_code.c: the formats that are code in a programming language */
#include "export/code.h"

static Status write_in(const Exported *what, const Language *language, const char *name, Text *out,
                       Diag *diag)
{
    Code *code = NULL;
    Status status = OK;

    CHECK(code_new(what, false, &code, diag));
    if (code_has_modes(code) && !language->differentiates)
        CHECK(code_modes_check(code, name, diag));
    code_file(code, language, out);
done:
    code_free(code);
    return status;
}

#define LANGUAGE(word)                                                                             \
    static Status write_##word(const Exported *what, Text *out, Diag *diag)                        \
    {                                                                                              \
        return write_in(what, &language_##word, #word, out, diag);                                 \
    }                                                                                              \
    const Format format_##word = {.need = NEED_CODE, .write = write_##word};

LANGUAGE(c)
LANGUAGE(python)
LANGUAGE(fortran)
LANGUAGE(matlab)
