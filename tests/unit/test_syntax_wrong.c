/* test_syntax_wrong.c: wrong statements are refused at their place, with the way out */
#include "test.h"

#include "language/syntax.h"
#include "wrong.h"

/* what refuses the statement: its text alone, or not */
static bool check_block(const Wrong *wrong)
{
    Statement *statement = NULL;
    size_t next = 0;
    Diag diag = {0};
    Status status =
        statement_parse(wrong->text, 1, (SyntaxOptions){false}, &next, &statement, &diag);
    bool good = status != OK && next == 0 && statement == NULL && diag.place.line == 1 &&
                diag.place.column == wrong->column && diag.place.width > 0 &&
                strstr(diag.message, wrong->message) != NULL &&
                strstr(diag.hint, wrong->hint) != NULL;

    if (!good)
        printf("wrong.txt:%d: %s\n  got    %d %s\n         %s\n  wanted %d %s\n         %s\n",
               wrong->line, wrong->text, diag.place.column, diag.message, diag.hint, wrong->column,
               wrong->message, wrong->hint);
    statement_free(statement);
    return good;
}

static void wrong_statements_are_refused_at_their_place(void)
{
    FILE *file = wrong_open();
    int line = 0;
    int count = 0;
    Wrong wrong;

    EXPECT(file != NULL);
    while (file != NULL && wrong_next(file, &line, &wrong))
        if (strcmp(wrong.kind, "syntax") == 0) {
            EXPECT(check_block(&wrong));
            count++;
        }
    EXPECT(count >= 100);
    if (file != NULL)
        (void)fclose(file);
}

static void what_only_the_model_can_refuse_reads(void)
{
    FILE *file = wrong_open();
    int line = 0;
    Wrong wrong;

    EXPECT(file != NULL);
    while (file != NULL && wrong_next(file, &line, &wrong)) {
        char text[sizeof wrong.setup + sizeof wrong.text];
        size_t next = 0;

        if (strcmp(wrong.kind, "model") != 0)
            continue;
        (void)snprintf(text, sizeof text, "%s%s", wrong.setup, wrong.text);
        while (next < strlen(text)) {
            Statement *statement = NULL;
            Diag diag;

            if (statement_parse(text, 1, (SyntaxOptions){false}, &next, &statement, &diag) != OK) {
                printf("wrong.txt:%d: %d:%d: %s\n", wrong.line, diag.place.line, diag.place.column,
                       diag.message);
                test_faults++;
                break;
            }
            statement_free(statement);
        }
    }
    if (file != NULL)
        (void)fclose(file);
}

int main(void)
{
    RUN(wrong_statements_are_refused_at_their_place);
    RUN(what_only_the_model_can_refuse_reads);
    return test_end();
}
