/* bench_model.h: a model from text, for benchmarks */
#ifndef COTREE_TESTS_BENCH_MODEL_H
#define COTREE_TESTS_BENCH_MODEL_H

#include "model/model.h"

#include <stdio.h>
#include <string.h>

/* What a text builds; statements that look, run or check are passed over. NULL, and a line about
 * it, where a statement fails. */
static Model *bench_model(const char *text)
{
    Model *model = model_new();

    for (size_t next = 0; text[0] != '\0'; text += next, next = 0) {
        Statement *statement = NULL;
        Diag diag = {0};
        Status status = statement_parse(text, 1, (SyntaxOptions){0}, &next, &statement, &diag);

        if (status == OK &&
            (statement->kind == STATEMENT_PARAMETER || statement->kind == STATEMENT_LAW ||
             (statement->kind == STATEMENT_VERB && statement->row.room == ROOM_MODEL)))
            status = model_apply(model, statement, &diag);
        statement_free(statement);
        if (status != OK) {
            printf("# %s\n", diag.message);
            model_free(model);
            return NULL;
        }
    }
    return model;
}

#endif
