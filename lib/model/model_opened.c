/* model_opened.c: a definition that is being read, statement by statement
 *
 * Each statement is tried at once on a separate state; the model gets the definition when `end` is
 * read. */
#include "model/model_impl.h"

#include <string.h>

struct Opened {
    State *trial;
    int use;   /* the instance there to which the statements are applied */
    Text text; /* the accepted statements, one on each line */
};

static void add_line(Opened *opened, const Statement *statement)
{
    char *line = statement_full_text(statement);
    Text text = {0};

    if (opened->text.at != NULL)
        text_addf(&text, "%s  ", opened->text.at);
    text_addf(&text, "%s\n", line);
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
    add_line(opened, statement);
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
    Outcome outcome = {EFFECT_NONE, {0}};
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

Status opened_end(const Opened *opened, Place place, Statement **out, Diag *diag)
{
    Text text = {0};
    Status status = OK;

    CHECK(subsystem_check_ports(opened->trial, opened->use, place, diag));
    text_addf(&text, "%send", opened->text.at);
    status = statement_parse(text.at, 1, (SyntaxOptions){.whole = true}, NULL, out, diag);
done:
    text_free(&text);
    return status;
}
