/* model_opened.c: a definition that is being read, statement by statement
 *
 * Each statement is tried at once on a separate state; the model gets the definition when `end` is
 * read. */
#include "model/model_impl.h"

#include <string.h>

struct Opened {
    State *trial;
    int use; /* the instance there to which the statements are applied */
    Pool *pool;
    Statement whole;          /* the first line; at the end the definition */
    LIST(Statement) accepted; /* the other lines, in the pool */
    int lines;                /* number of all, empty ones included */
    Text text;                /* of the other lines, each indented */
    Body body;
};

static void add_line(Opened *opened, const Statement *statement)
{
    static const char indent[] = "  ";
    char *line = statement_full_text(statement);
    Text text = {0};
    Statement copy;

    opened->lines++;
    if (statement->kind != STATEMENT_EMPTY) {
        statement_copy_to(opened->pool, statement, line, opened->lines, (int)sizeof indent, &copy);
        LIST_PUSH(opened->accepted, copy);
    }
    text_addf(&text, "%s%s%s\n", opened->text.at != NULL ? opened->text.at : "", indent, line);
    text_free(&opened->text);
    opened->text = text;
    mem_free(line);
}

Status opened_begin(const State *state, const Statement *statement, Opened **out, Diag *diag)
{
    Opened *opened = NEW(Opened);
    Status status = OK;

    CHECK(state_rebuild(state, -1, &opened->trial, NULL, NULL, diag));
    CHECK(subsystem_begin(opened->trial, statement, &opened->use, diag));
    opened->pool = pool_new(0);
    statement_copy(opened->pool, statement, &opened->whole);
    opened->lines = 1;
    *out = opened;
    opened = NULL;
done:
    opened_free(opened);
    return status;
}

void opened_free(Opened *opened)
{
    if (opened == NULL)
        return;
    mem_keep(opened);
    state_free(opened->trial);
    LIST_FREE(opened->accepted);
    pool_free(opened->pool);
    text_free(&opened->text);
    mem_free(opened);
}

const char *opened_name(const Opened *opened)
{
    return opened->trial->uses.at[opened->use].name;
}

Status opened_add(Opened *opened, const Statement *statement, Diag *diag)
{
    const StateMark mark = state_mark(opened->trial);
    Outcome outcome = {0};
    Status status;

    mem_keep(opened);
    status = use_apply(&opened->trial, opened->use, statement, &outcome, diag);
    if (status == OK)
        add_line(opened, statement);
    else {
        (void)state_go_back(&opened->trial, &mark);
        subsystem_forget_places(opened->trial, opened->use);
    }
    text_free(&outcome.remarks);
    return status;
}

Status opened_end(Opened *opened, Place place, const Statement **out, Diag *diag)
{
    const char *lines = opened->text.at != NULL ? opened->text.at : "";
    char *first;
    Text text = {0};

    TRY(subsystem_check_ports(opened->trial, opened->use, place, diag));
    mem_keep(opened);
    first = statement_full_text(&opened->whole);
    text_addf(&text, "%s\n%send", first, lines);
    opened->body =
        (Body){.text = lines, .at = opened->accepted.at, .count = opened->accepted.count};
    opened->whole.text = pool_text(opened->pool, text.at, text.length);
    opened->whole.body = &opened->body;
    *out = &opened->whole;
    mem_free(first);
    text_free(&text);
    return OK;
}
