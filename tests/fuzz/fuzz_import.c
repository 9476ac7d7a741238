/* fuzz_import.c: any text is a netlist or a robot, or is refused; what is made of it reads, each
 * statement from a line of the text, and a model takes it or says why not */
#include "mutate.h"

#include "export/import.h"
#include "model/model.h"

#include <string.h>

static int lines_of(const char *text)
{
    int lines = 1;

    for (; *text != '\0'; text++)
        lines += *text == '\n' || *text == '\r';
    return lines;
}

static void apply(const Import *import)
{
    const char *script = import->script.at != NULL ? import->script.at : "";
    Cursor cursor = {script, 0, 1, 0};
    Model *model = model_new();

    while (cursor.next < strlen(script)) {
        Statement *statement = NULL;
        Diag diag = {0};

        mutate_claim(statement_read(&cursor, (SyntaxOptions){false}, &statement, &diag) == OK,
                     "what is written reads");
        if (statement->kind != STATEMENT_EMPTY && model_apply(model, statement, &diag) != OK)
            mutate_claim(diag.message[0] != '\0', "a refusal has a message");
        statement_free(statement);
    }
    model_free(model);
}

static void read_as(const char *format, const char *text)
{
    Import *import = import_new("file", true);
    Diag diag = {0};

    if (importer_find(format)(import, text, strlen(text), &diag) != OK) {
        mutate_claim(diag.message[0] != '\0', "a refused file has a message");
    } else {
        mutate_claim(import->from.count ==
                         lines_of(import->script.at != NULL ? import->script.at : "") - 1,
                     "each line has its origin");
        for (int i = 0; i < import->from.count; i++)
            mutate_claim(import->from.at[i] >= 0 && import->from.at[i] <= lines_of(text),
                         "which is in the file");
        apply(import);
    }
    import_free(import);
}

void mutate_target(const char *text)
{
    read_as("spice", text);
    read_as("urdf", text);
}
