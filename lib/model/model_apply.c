/* model_apply.c: the table of the model's verbs, with the function that carries out each */
#include "language/verbs.h"
#include "model/model_impl.h"

static Apply *const verbs[VERB_COUNT] = {
#define MODEL_VERB(word, ...) [VERB_##word] = apply_##word,
#include "language/verbs.def"
};

Status verb_apply(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    Status status = OK;
    Apply *apply = NULL;

    switch (statement->kind) {
    case STATEMENT_EMPTY:
        return OK;
    case STATEMENT_PARAMETER:
        apply = apply_parameter;
        break;
    case STATEMENT_LAW:
        apply = apply_law;
        break;
    case STATEMENT_VERB:
        apply = statement->row.component != NULL ? apply_component : verbs[statement->row.number];
        break;
    }
    if (apply == NULL)
        return diag_at(diag, E_MISSING, statement->verb_place, "'%s' builds nothing",
                       statement->verb);
    status = apply(state, statement, outcome, diag);
    if (status != OK && diag != NULL && diag->place.line == 0)
        diag->place = statement->place;
    return status;
}
