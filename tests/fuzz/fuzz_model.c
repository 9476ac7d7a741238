/* fuzz_model.c: any statements leave a model that is whole
 *
 * A statement that is refused changes nothing, what is saved rebuilds the same model,
 * and undo leads back. */
#include "base/text.h"
#include "model/model.h"
#include "mutate.h"

#include <string.h>

enum { MOST_STATEMENTS = 60 }; /* of one input */

static int is_saved_as(const Model *model, const char *wanted)
{
    char *now = model_save(model);
    int same = strcmp(now, wanted) == 0;

    mem_free(now);
    return same;
}

static void apply_one(Model *model, const Statement *statement)
{
    char *before = model_save(model);
    Diag diag = {0};
    const Tree *trees[TREE_KINDS];

    if (model_apply(model, statement, &diag) != OK) {
        mutate_claim(diag.message[0] != '\0', "a failure says why");
        mutate_claim(is_saved_as(model, before), "a failure changes nothing");
    } else if (model_defining(model) == NULL) { /* a definition is done with its `end`, as one */
        char *after = model_save(model);

        mutate_claim(model_undo(model, &diag) == OK, "what was done can be undone");
        mutate_claim(is_saved_as(model, before), "undo leads back");
        mutate_claim(model_redo(model, &diag) == OK, "what was undone can be done again");
        mutate_claim(is_saved_as(model, after), "redo leads there again");
        mem_free(after);
        if (model_trees(model, trees, &diag) != OK)
            mutate_claim(diag.message[0] != '\0', "a tree that can't be says why");
    }
    mem_free(before);
}

static void apply_all(Model *model, const char *text, int most)
{
    size_t next = 0;

    for (int i = 0; i < most && text[next] != '\0'; i++) {
        Statement *statement = NULL;
        size_t start = next;
        Diag diag = {0};

        if (statement_parse(text, 1, (SyntaxOptions){false}, &next, &statement, &diag) != OK) {
            const char *end = strchr(text + start, '\n');

            next = end != NULL ? (size_t)(end + 1 - text) : strlen(text);
            continue;
        }
        if (statement->kind != STATEMENT_EMPTY &&
            (statement->kind != STATEMENT_VERB || statement->row.room == ROOM_MODEL))
            apply_one(model, statement);
        statement_free(statement);
    }
}

void mutate_target(const char *text)
{
    Model *model = model_new();
    Model *again = model_new();
    char *saved;

    apply_all(model, text, MOST_STATEMENTS);
    saved = model_save(model);
    apply_all(again, saved, 10 * MOST_STATEMENTS);
    mutate_claim(is_saved_as(again, saved), "what is saved rebuilds the model");
    mem_free(saved);
    model_free(again);
    model_free(model);
}
