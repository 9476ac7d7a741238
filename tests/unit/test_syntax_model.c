/* test_syntax_model.c: what the model refuses has its place and its way out, and changes nothing */
#include "test.h"

#include "base/memory.h"
#include "model/model.h"
#include "wrong.h"

/* apply every statement of a text; stops at the first that fails */
static Status apply(Model *model, const char *text, Diag *diag)
{
    Status status = OK;
    size_t next = 0;

    while (status == OK && next < strlen(text)) {
        Statement *statement = NULL;

        status = statement_parse(text, 1, (SyntaxOptions){false}, &next, &statement, diag);
        if (status == OK && statement->kind != STATEMENT_EMPTY)
            status = strcmp(statement->text, "undo") == 0   ? model_undo(model, diag)
                     : strcmp(statement->text, "redo") == 0 ? model_redo(model, diag)
                                                            : model_apply(model, statement, diag);
        statement_free(statement);
    }
    return status;
}

static bool check_block(const Wrong *wrong)
{
    Model *model = model_new();
    Diag diag = {0};
    Status setup = apply(model, wrong->setup, &diag);
    char *before = model_save(model);
    uint64_t revision = model_revision(model);
    Status status = apply(model, wrong->text, &diag);
    char *after = model_save(model);
    bool same = strcmp(before, after) == 0 && model_revision(model) == revision;
    /* what no word of the text is to blame for has its place at the verb */
    bool there =
        diag.place.column == wrong->column || (wrong->column == 1 && diag.place.column == 0);
    bool good = setup == OK && status != OK && there && same &&
                strstr(diag.message, wrong->message) != NULL &&
                strstr(diag.hint, wrong->hint) != NULL;

    if (!good)
        printf("wrong.txt:%d: %s%s\n  got    %d %s\n         %s\n  wanted %d %s\n         %s\n",
               wrong->line, wrong->text, same ? "" : " (changed)", diag.place.column, diag.message,
               diag.hint, wrong->column, wrong->message, wrong->hint);
    mem_free(before);
    mem_free(after);
    model_free(model);
    return good;
}

static void the_model_refuses_at_the_place_and_stays(void)
{
    FILE *file = wrong_open();
    int line = 0;
    int count = 0;
    Wrong wrong;

    EXPECT(file != NULL);
    while (file != NULL && wrong_next(file, &line, &wrong))
        if (strcmp(wrong.kind, "model") == 0) {
            EXPECT(check_block(&wrong));
            count++;
        }
    EXPECT(count >= 50);
    if (file != NULL)
        (void)fclose(file);
}

int main(void)
{
    RUN(the_model_refuses_at_the_place_and_stays);
    return test_end();
}
