/* model_check.c: checks whether the values of parts are valid numbers
 *
 * Rows of the component table refuse invalid numbers. Here values that follow from parameters are
 * replaced by their current numbers. So it makes no difference whether a mass is a number or
 * follows from a parameter, or whether a statement or a new value of the parameter sets it. */
#include "model/model_impl.h"

#include <math.h>
#include <string.h>

/* of parameters alone, and not a number yet */
static bool is_of_parameters(Expr e)
{
    return !expr_is_number(e) && (expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) == 0;
}

/* The values as numbers where parameters determine them; `out` has room for all values and, after
 * them, for their entries. E_DOMAIN where one isn't finite. */
static Status read_numbers(State *state, const Instance *part, Value *out, Diag *diag)
{
    Expr *entries = (Expr *)(out + part->row->param_count);

    for (int i = 0; i < part->row->param_count; i++) {
        out[i] = part->values[i];
        out[i].at = entries;
        entries += out[i].count;
        for (int k = 0; k < out[i].count; k++) {
            double value;

            out[i].at[k] = part->values[i].at[k];
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

/* the part that makes a frame; NULL: ground's */
static const Instance *maker_of(const State *state, int node)
{
    for (int i = 0; i < state->parts.count; i++) {
        const Instance *part = state->parts.at[i];

        if (part->head == node &&
            (part->row->places == PLACES_NONE || part->row->places == PLACES_FROM))
            return part;
    }
    return NULL;
}

/* an arm with at= needs a flexible part, and a position between its ends */
static Status check_section_frame(State *state, const Instance *arm, const Value *at, Diag *diag)
{
    const Instance *beam = maker_of(state, arm->tail);
    Status status = OK;

    if (beam == NULL || !instance_bends(beam)) {
        status =
            diag_set(diag, E_VALUE,
                     "%s doesn't start from the root of a beam, so at= has no meaning", arm->name);
        diag_hint(diag, "at= is a place along a beam; on a body the position is [x, y]");
    } else if (instance_value(arm, "position")->given) {
        status = diag_set(diag, E_VALUE, "%s has two places: a position and at=", arm->name);
        diag_hint(diag, "arm %s %s at=... is on the axis; a further arm from %s leads off it",
                  arm->name, beam->name, arm->name);
    } else if (expr_is_number(at->at[0])) {
        const double length = state_number(state, instance_scalar(beam, "length"));
        const double place = expr_value(at->at[0]);

        if (place < 0 || place > length * (1 + 1e-12)) {
            status = diag_set(diag, E_VALUE, "%s is off the beam: at=%g, and %s is %g long",
                              arm->name, place, beam->name, length);
            diag_hint(diag, "at= goes from 0, the root, to the length");
        }
    }
    if (status != OK)
        diag_about(diag, "at");
    return status;
}

static Status check_arm(State *state, const Instance *arm, Diag *diag)
{
    const int at = component_param(arm->row, "at");

    const Instance *on = at >= 0 && arm->values[at].given ? maker_of(state, arm->tail) : NULL;

    return arm->row->family == FAMILY_ARM && at >= 0 && arm->values[at].given &&
                   (on == NULL || on->given == NULL) /* a frame that given equations move */
               ? check_section_frame(state, arm, &arm->values[at], diag)
               : OK;
}

/* whether the coupler's rate is linear in another's: its slope contains no rate */
static bool is_linear_in(Arena *arena, Expr law, Expr rate)
{
    const Expr slope = expr_diff(arena, law, rate);
    Expr *symbols = NULL;
    const int count = expr_symbols(&slope, 1, &symbols);
    bool is_linear = true;

    for (int i = 0; i < count; i++)
        is_linear = is_linear && strchr(expr_name(symbols[i]), '\'') == NULL;
    mem_free(symbols);
    return is_linear;
}

/* a symbol that is no parameter: the coordinate's name into `name`, without its prime */
static Status check_followed(const Instance *part, Expr law, Expr symbol, Arena *arena, Text *name,
                             Diag *diag)
{
    const char *prime = strchr(expr_name(symbol), '\'');
    const bool of_rates = part->row->is_of_rates;
    Status status = OK;

    text_add_n(name, expr_name(symbol), strcspn(expr_name(symbol), "'"));
    if (expr_symbol_kind(symbol) == SYMBOL_TIME) {
        if (of_rates)
            return OK;
        status = diag_set(diag, E_VALUE, "a coupler follows coordinates, not time");
        diag_hint(diag, "a driver follows t");
    } else if (prime != NULL && !of_rates) {
        status = diag_set(diag, E_VALUE,
                          "a coupler of a coordinate follows coordinates, not "
                          "rates: %s",
                          expr_name(symbol));
        diag_hint(diag, "coupler %s %s' = ... gives a rate", part->name, part->coordinate);
    } else if (prime != NULL && prime[1] != '\0') {
        status = diag_set(diag, E_VALUE, "a rate follows no accelerations: %s", expr_name(symbol));
    } else if (prime != NULL && !is_linear_in(arena, law, symbol)) {
        status =
            diag_set(diag, E_VALUE, "%s' is not linear in %s", part->coordinate, expr_name(symbol));
        diag_hint(diag, "the factor of a rate contains coordinates, t and parameters alone");
    }
    return status;
}

/* A coupler may contain only coordinates that something can act on. */
static Status check_coupled(State *state, const Instance *part, Diag *diag)
{
    const Expr value = part->row->family == FAMILY_COUPLER ? part->values[0].at[0] : NULL;
    Expr *symbols = NULL;
    const int count = value != NULL ? expr_symbols(&value, 1, &symbols) : 0;
    Text name = {0};
    Status status = OK;

    for (int i = 0; i < count; i++) {
        int owner, coordinate;
        const Instance *followed;
        bool acts;

        if (expr_symbol_kind(symbols[i]) == SYMBOL_PARAMETER)
            continue;
        diag_about(diag, "%s", expr_name(symbols[i]));
        text_free(&name);
        CHECK(check_followed(part, value, symbols[i], state->arena, &name, diag));
        if (expr_symbol_kind(symbols[i]) == SYMBOL_TIME)
            continue;
        CHECK(coordinate_resolve(state, name.at, (Place){0}, &owner, &coordinate, diag));
        followed = state->parts.at[owner];
        acts = strchr(expr_name(symbols[i]), '\'') != NULL || !part->row->is_of_rates;
        if (acts && followed->coord_kind[coordinate] == COORDINATE_PARAMETER) {
            status = diag_set(diag, E_VALUE, "a coupler can't act on %s", name.at);
            diag_hint(diag, "it takes lengths and angles; a virtual joint has those between any "
                            "two frames");
            goto done;
        }
        if (acts && owner == part->joint && coordinate == part->joint_coordinate) {
            status = diag_set(diag, E_VALUE, "%s would follow itself", name.at);
            goto done;
        }
        CHECK(use_check_reach(state, followed->name, (Place){0}, diag));
    }
done:
    mem_free(symbols);
    text_free(&name);
    return status;
}

Status part_check(State *state, const Instance *part, Text *remarks, Diag *diag)
{
    const Component *row = part->row;
    ArenaMark *mark = arena_mark(state->arena);
    Instance numeric = *part;
    size_t size = (size_t)row->param_count * sizeof(Value);
    Status status = OK;

    for (int i = 0; i < row->param_count; i++)
        size += (size_t)part->values[i].count * sizeof(Expr);
    numeric.values = mem_new(size);
    CHECK(read_numbers(state, part, numeric.values, diag));
    CHECK(instance_check(&numeric, state->arena, state->setup.planar, diag));
    CHECK(coupled_check(state, part, remarks, diag));
    CHECK(check_arm(state, &numeric, diag));
    CHECK(check_coupled(state, part, diag));
    /* arms on it, as it may have become shorter */
    for (int i = 0; row->deforming != NULL && i < state->parts.count; i++)
        if (state->parts.at[i]->row->family == FAMILY_ARM && state->parts.at[i]->tail == part->head)
            CHECK(part_check(state, state->parts.at[i], remarks, diag));
    if (row->doubt != NULL)
        row->doubt(&numeric, state->setup.planar, remarks);
done:
    mem_free(numeric.values);
    arena_release(state->arena, mark);
    return status;
}

/* --- after a parameter has changed --- */

/* whether the line needs one of the changed definitions */
static bool needs_changed(const Line *line, const bool *changed)
{
    for (int i = 0; i < line->use_count && !line->is_gone; i++)
        if (changed[line->uses[i]])
            return true;
    return false;
}

/* marks the definitions that follow from marked ones */
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
