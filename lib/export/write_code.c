/* write_code.c: the formats that are code in a programming language */
#include "export/code.h"

#include "model/model.h"

/* A step of constant length chatters about what sticks: it would creep. */
static Status check_friction(const Exported *what, const char *language, Diag *diag)
{
    const Model *model = what->view.model;

    for (int i = 0; i < model_count(model) && what->inverse == NULL; i++) {
        const Instance *part = model_instance(model, i);

        if (!instance_sticks(part))
            continue;
        (void)diag_set(diag, E_MODEL,
                       "%s %s sticks at rest, which a step of exported %s doesn't do",
                       part->row->name, part->name, language);
        diag_hint(diag, "%s",
                  instance_is_rigid(part)
                      ? "in simulate alone there are impacts; k= makes it compliant, and an FMU "
                        "then follows it"
                      : "export fmu does; or an actuator or a source with a steep but continuous "
                        "law, such as -2*tanh(h1'/0.001), creeps instead");
        return E_MODEL;
    }
    return OK;
}

static Status write_in(const Exported *what, const Language *language, const char *name, Text *out,
                       Diag *diag)
{
    Code *code = NULL;
    Status status = OK;

    CHECK(check_friction(what, name, diag));
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
