/* fuzz_statement.c: any text reads or is refused at a place in it, and what was read prints back */
#include "mutate.h"

#include "base/memory.h"
#include "language/syntax.h"

#include <string.h>

/* Length of the text's line of that number, counted from 1; -1: there is none. A line ends in a
 * newline, a carriage return or both. */
static int line_length(const char *text, int line)
{
    for (; line > 1; line--) {
        text += strcspn(text, "\r\n");
        if (*text == '\0')
            return -1;
        text += strncmp(text, "\r\n", 2) == 0 ? 2 : 1;
    }
    return (int)strcspn(text, "\r\n");
}

static void check_fault(const char *text, const Diag *diag)
{
    mutate_claim(diag->message[0] != '\0', "a fault has a message");
    mutate_claim(diag->place.line >= 1 && diag->place.column >= 1 && diag->place.width >= 1,
                 "a fault has a place");
    mutate_claim(diag->place.column <= line_length(text, diag->place.line) + 1,
                 "its place is in the text");
}

static void check_value(const Syntax *value)
{
    Pool *pool = pool_new(0);
    Syntax *again = NULL;
    Text first = {0};
    Text second = {0};
    Status status;

    mutate_claim(value->height <= SYNTAX_HEIGHT, "a tree's height is bounded");
    syntax_print(&first, value);
    status = syntax_parse_expression(first.at, pool, &again, NULL);
    mutate_claim(status == OK, "what is printed reads");
    syntax_print(&second, again);
    mutate_claim(strcmp(first.at, second.at) == 0, "and prints as before");
    text_free(&first);
    text_free(&second);
    pool_free(pool);
}

static void check_statement(const Statement *statement)
{
    const Syntax *const trailing[] = {statement->value, statement->at, statement->versus,
                                      statement->near_value, statement->within};
    bool raw = statement->kind == STATEMENT_VERB && strcmp(statement->row.pattern, "l") == 0;

    for (int i = 0; i < COUNT(trailing); i++)
        if (trailing[i] != NULL)
            check_value(trailing[i]);
    for (int i = 0; i < statement->operands.count && !raw; i++)
        check_value(statement->operands.at[i].value);
    for (int i = 0; i < statement->pairs.count; i++)
        check_value(statement->pairs.at[i].value);
    if (statement->rest != NULL)
        check_statement(statement->rest);
}

static void read_all(const char *text, SyntaxOptions options)
{
    size_t next = 0;

    while (next < strlen(text)) {
        Statement *statement = NULL;
        size_t before = next;
        Diag diag = {0};

        if (statement_parse(text, 1, options, &next, &statement, &diag) == OK) {
            mutate_claim(next > before, "reading goes on");
            check_statement(statement);
            statement_free(statement);
            continue;
        }
        mutate_claim(next == before && statement == NULL, "a failure changes nothing");
        check_fault(text, &diag);
        /* on behind the line */
        next += strcspn(text + next, "\n");
        next += text[next] == '\n' ? 1 : 0;
    }
}

void mutate_target(const char *text)
{
    read_all(text, (SyntaxOptions){false});
    read_all(text, (SyntaxOptions){.shortened = true});
}
