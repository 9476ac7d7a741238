/* model_rebuild.c: rebuilds a state from its lines, and saves its lines as a script */
#include "model/model_impl.h"

/* the name that a line makes or changes, or the line itself */
static const char *line_name(const State *state, const Line *line)
{
    if (line->part >= 0)
        return state->parts.at[line->part]->name;
    if (line->use >= 0)
        return state->uses.at[line->use].name;
    return line->definition >= 0 ? state->definitions.at[line->definition].name : line->text;
}

/* whether it changes values inside an instance: set leg1.L1 = 2, set leg1.m1.mass = 3 */
static bool sets_inside(const State *state, const Line *line, const char *use)
{
    return line->key != NULL &&
           name_is_inside(line->part >= 0 ? state->parts.at[line->part]->name : line->key, use);
}

static Status rebuild(const State *old, int without, bool named, State **out, NameList *broken,
                      Text *remarks, Diag *diag)
{
    State *state = state_new(old->arena, old->overrides, old->apply);
    const int gone = without >= 0 ? old->lines.at[without].part : -1;
    const int gone_use = without >= 0 ? old->lines.at[without].use : -1;
    int count = 0;
    int *order = lines_in_order(old, &count);
    Status status = OK;

    state->has_named_laws = named;
    for (int i = 0; i < count; i++) {
        const Line *line = &old->lines.at[order[i]];

        if (order[i] == without || (gone >= 0 && line->part == gone) ||
            (gone_use >= 0 && sets_inside(old, line, old->uses.at[gone_use].name)))
            continue;
        status = state_apply_text(&state, line->text, diag);
        if (status != OK && broken != NULL) {
            name_list_add(broken, line_name(old, line));
            status = OK;
        }
        CHECK(status);
    }
    choices_copy(state, old, remarks);
    CHECK(starts_copy(state, old, broken, remarks, diag));
    state_forget_before(state, 0);
    *out = state;
    state = NULL;
done:
    mem_free(order);
    state_free(state);
    return status;
}

Status state_rebuild(const State *old, int without, State **out, NameList *broken, Text *remarks,
                     Diag *diag)
{
    return rebuild(old, without, old->has_named_laws, out, broken, remarks, diag);
}

Status state_rebuild_named(const State *old, State **out, Diag *diag)
{
    return rebuild(old, -1, true, out, NULL, NULL, diag);
}

Status apply_pairs(State **state, const Statement *statement, ApplyPair *apply, Outcome *outcome,
                   Diag *diag)
{
    State *work = *state;
    Status status = OK;

    if (statement->pairs.count == 0)
        return diag_at(diag, E_SYNTAX, statement->place, "'%s' is followed by NAME = value",
                       statement->verb);
    /* several pairs are applied to a copy, so that a failure undoes the earlier pairs */
    if (statement->pairs.count > 1)
        CHECK(state_rebuild(*state, -1, &work, NULL, NULL, diag));
    for (int i = 0; i < statement->pairs.count; i++)
        CHECK(apply(&work, &statement->pairs.at[i], outcome, diag));
    if (statement->pairs.count > 1)
        state_replace(state, work);
    else
        *state = work;
    work = NULL;
done:
    if (statement->pairs.count > 1)
        state_free(work);
    return status;
}

void state_save(const State *state, Text *text)
{
    int count = 0;
    int *order = lines_in_order(state, &count);

    for (int i = 0; i < count; i++)
        text_addf(text, "%s\n", state->lines.at[order[i]].text);
    mem_free(order);
    choices_save(state, text);
    starts_save(state, text);
}
