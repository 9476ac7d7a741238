/* model_check.c: whether the values of parts make sense as numbers
 *
 * Rows refuse numbers that a value can't be. Here values that follow from parameters are put in as
 * the numbers that they are now, so that it is one whether a mass was typed or follows from a
 * parameter, and whether a statement or a new value of the parameter brings it in. */
#include "model/model_impl.h"

#include <math.h>

/* of parameters alone, and no number yet */
static bool is_of_parameters(Expr e)
{
    return !expr_is_number(e) && (expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) == 0;
}

/* The values as numbers where parameters tell them; `out` has room for all. E_DOMAIN where one
 * isn't finite. */
static Status read_numbers(State *state, const Instance *part, Value *out, Diag *diag)
{
    for (int i = 0; i < part->row->param_count; i++) {
        out[i] = part->values[i];
        for (int k = 0; k < out[i].count; k++) {
            double value;

            if (!is_of_parameters(out[i].at[k]))
                continue;
            value = state_number(state, out[i].at[k]);
            if (!isfinite(value))
                return diag_set(diag, E_DOMAIN, "%s of %s has no finite value",
                                part->row->params[i].name, part->name);
            out[i].at[k] = expr_real(state->arena, value);
        }
    }
    return OK;
}

Status part_check(State *state, const Instance *part, Text *remarks, Diag *diag)
{
    const Component *row = part->row;
    ArenaMark *mark = arena_mark(state->arena);
    Instance numeric = *part;
    Status status = OK;

    numeric.values = NEW_ARRAY(Value, row->param_count);
    CHECK(read_numbers(state, part, numeric.values, diag));
    CHECK(instance_check(&numeric, state->arena, state->planar, diag));
    CHECK(coupled_check(state, part, diag));
    if (row->doubt != NULL)
        row->doubt(&numeric, state->planar, remarks);
done:
    mem_free(numeric.values);
    arena_release(state->arena, mark);
    return status;
}

/* --- after a parameter has changed --- */

/* whether the line needs one of the definitions that changed */
static bool needs_changed(const Line *line, const bool *changed)
{
    for (int i = 0; i < line->use_count && !line->is_gone; i++)
        if (changed[line->uses[i]])
            return true;
    return false;
}

/* mark the definitions that follow from those marked */
static void spread_change(const State *state, bool *changed)
{
    bool more = true;

    while (more) {
        more = false;
        for (int i = 0; i < state->lines.count; i++) {
            const Line *line = &state->lines.at[i];

            if (line->definition < 0 || changed[line->definition] || !needs_changed(line, changed))
                continue;
            changed[line->definition] = more = true;
        }
    }
}

Status parts_check_after(State *state, int definition, Text *remarks, Diag *diag)
{
    bool *changed = NEW_ARRAY(bool, state->definitions.count);
    bool *asked = NEW_ARRAY(bool, state->parts.count);
    Status status = OK;

    changed[definition] = true;
    spread_change(state, changed);
    for (int i = 0; i < state->lines.count; i++) {
        const Line *line = &state->lines.at[i];

        if (line->part < 0 || asked[line->part] || !needs_changed(line, changed))
            continue;
        asked[line->part] = true;
        CHECK(part_check(state, state->parts.at[line->part], remarks, diag));
    }
done:
    MEM_FREE(changed, asked);
    return status;
}
