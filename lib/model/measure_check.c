/* measure_check.c: dimensions of variables, and places where one is wanted */
#include "model/model_impl.h"

#include <string.h>

enum { LONGEST_NAME = 40 }; /* of an item in a message; it stands below it anyway */

/* --- variables --- */

/* of a terminal's potential; NULL: the name is none */
static const char *potential_unit(const State *state, const char *name)
{
    const char *dot = strrchr(name, '.');
    char *terminal = mem_text(name, dot != NULL ? (size_t)(dot - name) : 0);
    const char *unit = NULL;

    if (names_find(state->terminals, terminal) >= 0)
        unit = domain_across_unit(terminal_domain(state, terminal));
    mem_free(terminal);
    return unit;
}

/* of a joint: along its only coordinate; of what acts on one, or along a line */
static const char *effort_unit(const Instance *part)
{
    static const char *const units[] = {"N", "N*m", NULL};

    if (part->row->family != FAMILY_JOINT)
        return part->on_angle ? "N*m" : "N";
    return part->coord_count == 1 ? units[part->coord_kind[0]] : NULL;
}

static const char *member_unit(const State *state, const Instance *part, const char *name)
{
    const Member *member;

    for (int i = 0; (member = component_member(part->row, state->planar, i)) != NULL; i++)
        if (strcmp(member->name, name) == 0)
            return strcmp(name, "effort") == 0 ? effort_unit(part) : member->unit;
    return NULL;
}

Measure variable_measure(const State *state, const Instance *own, const char *name)
{
    static const char *const units[] = {"m", "rad", "1"};
    const char *member = "";
    const Thing *thing = state_thing(state, name);
    const Instance *part = state_owner(state, name, &member);
    size_t length = own != NULL ? strlen(own->name) : 0;
    Text resolved = {0};
    Measure out = {.kind = MEASURE_ANY};

    if (whole_unit(name) != NULL)
        return measure_of_unit(whole_unit(name));
    if (own != NULL && strncmp(name, own->name, length) == 0 && name[length] == '.')
        return measure_of_unit(member_unit(state, own, name + length + 1));
    /* a member may stand for a coordinate that the user has given a name */
    if (thing == NULL && part != NULL &&
        variable_resolve(state, NULL, name, 0, 0, (Place){0}, &resolved, NULL) == OK)
        thing = state_thing(state, resolved.at);
    text_free(&resolved);
    if (thing != NULL && thing->kind != THING_DEFINITION) {
        part = state->parts.at[thing->index];
        if (thing->kind == THING_COORDINATE || part->coord_count == 1)
            out = measure_of_unit(
                units[part->coord_kind[thing->kind == THING_COORDINATE ? thing->coordinate : 0]]);
    } else if (part != NULL)
        out = measure_of_unit(member_unit(state, part, member));
    else if (thing == NULL)
        out = measure_of_unit(potential_unit(state, name));
    return out;
}

/* --- wanted dimensions --- */

/* brackets and signs taken off */
static const Syntax *bare(const Syntax *syntax)
{
    while ((syntax->kind == SYNTAX_GROUP && syntax->primes == 0) ||
           (syntax->kind == SYNTAX_UNARY && strcmp(syntax->text, "!") != 0))
        syntax = syntax->args[0];
    return syntax;
}

static bool is_literal(const Syntax *syntax)
{
    return (syntax->kind == SYNTAX_NUMBER || syntax->kind == SYNTAX_VECTOR) && syntax->has_unit;
}

/* A length for each angle (a pitch in m/rev) is no length: it would be taken for one radian. What
 * a quotient of a velocity and a rate gives is a radius. */
static bool is_pitch(Measure wanted, Measure given)
{
    static const Dimension length = {{1, 0, 0, 0, 0, 0}};

    return memcmp(&wanted.dimension, &length, sizeof length) == 0 && given.is_literal &&
           given.dimension.power[5] < 0;
}

static Status refuse(const Syntax *syntax, Measure wanted, const char *unit, const char *name,
                     Measure given, Diag *diag)
{
    const Syntax *core = bare(syntax);
    Place place = is_literal(core) ? core->unit_place : syntax->place;
    Text got = {0};

    if (is_literal(core))
        text_add(&got, core->unit_text);
    else
        measure_print(&got, given);
    if (strcmp(unit, "1") == 0)
        (void)diag_at(diag, E_UNIT, place, "%s has no unit, got %s", name, got.at);
    else
        (void)diag_at(diag, E_UNIT, place, "%s expected for %s, got %s", unit, name, got.at);
    measure_hint(wanted, given, SI_HINT, diag);
    text_free(&got);
    return E_UNIT;
}

Status unit_check(const Scope *scope, const Syntax *syntax, const char *unit, const char *name,
                  Diag *diag)
{
    const Syntax *core = bare(syntax);
    Measure given = {0};
    Measure wanted;
    Status status = OK;

    if (core->kind == SYNTAX_VECTOR && !core->has_unit) {
        for (int i = 0; i < core->count; i++)
            CHECK(unit_check(scope, core->args[i], unit, name, diag));
        return OK;
    }
    CHECK(measure_of(scope, syntax, &given, diag));
    /* a ratio is a number, and that is taken as SI */
    if (!given.has_units || measure_is_plain(given))
        return OK;
    wanted = measure_of_unit(unit);
    if (!measures_fit(wanted, given) || is_pitch(wanted, given))
        status = refuse(syntax, wanted, unit, name, given, diag);
done:
    return status;
}

Status unit_check_alike(const Scope *scope, const Syntax *syntax, const char *name, Diag *diag)
{
    const Syntax *core = bare(syntax);
    Measure whole = {.kind = MEASURE_NUMBER};
    Measure entry;
    Text what = {0};
    Status status = OK;

    text_addf(&what, "components of %s", name);
    for (int i = 0; core->kind == SYNTAX_VECTOR && i < core->count; i++) {
        CHECK(measure_of(scope, core->args[i], &entry, diag));
        CHECK(measures_join(whole, entry, core->args[i > 0 ? i - 1 : 0], core->args[i], what.at,
                            &whole, diag));
    }
done:
    text_free(&what);
    return status;
}

Status unit_check_compared(const Scope *scope, const Syntax *left, const Syntax *right, Diag *diag)
{
    Measure a = {0};
    Measure b = {0};
    Status status = OK;

    CHECK(measure_of(scope, left, &a, diag));
    CHECK(measure_of(scope, right, &b, diag));
    CHECK(measures_join(a, b, left, right, "compared", &a, diag));
done:
    return status;
}

Status unit_check_shown(const Scope *scope, const Syntax *item, Diag *diag)
{
    Measure wanted = {.kind = MEASURE_KNOWN, .has_units = true, .is_literal = true};
    Measure given = {0};
    Syntax plain = *item;
    Text name = {0};
    Text text = {0};
    Status status = OK;

    CHECK(measure_of(scope, item, &given, diag));
    if (!item->has_unit || item->kind == SYNTAX_NUMBER || item->kind == SYNTAX_VECTOR)
        goto done;
    wanted.dimension = item->unit.dimension;
    wanted.is_cycles = item->unit.is_cycles;
    if (measures_fit(wanted, given))
        goto done;
    plain.has_unit = false;
    syntax_print(&name, &plain);
    if (name.length > LONGEST_NAME) {
        text_free(&name);
        text_add(&name, "this");
    }
    measure_print(&text, given);
    status = diag_at(diag, E_UNIT, item->unit_place, "%s is %s%s: it can't be shown in %s", name.at,
                     measure_is_plain(given) ? "" : "in ", text.at, item->unit_text);
    measure_hint(wanted, given, "without a unit it is shown in SI", diag);
done:
    text_free(&name);
    text_free(&text);
    return status;
}
