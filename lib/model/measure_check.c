/* measure_check.c: checks of required dimensions */
#include "model/model_impl.h"

#include <string.h>

/* of an item in a message, which also shows the whole statement below */
enum { LONGEST_NAME = 40 };

/* without brackets and signs */
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

/* A length per angle (a pitch in m/rev) is no length: it would be read per radian. The quotient of
 * a velocity and an angular rate is a radius. */
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

    if (core->kind == SYNTAX_VECTOR && !core->has_unit) {
        for (int i = 0; i < core->count; i++)
            TRY(unit_check(scope, core->args[i], unit, name, diag));
        return OK;
    }
    TRY(measure_of(scope, syntax, &given, diag));
    /* a ratio is a number, and that is taken as SI */
    if (!given.has_units || measure_is_plain(given))
        return OK;
    wanted = measure_of_unit(unit);
    if (!measures_fit(wanted, given) || is_pitch(wanted, given))
        return refuse(syntax, wanted, unit, name, given, diag);
    return OK;
}

Status unit_check_alike(const Scope *scope, const Syntax *syntax, const char *what, Diag *diag)
{
    const Syntax *core = bare(syntax);
    Measure whole = {.kind = MEASURE_NUMBER};
    Measure entry;

    for (int i = 0; core->kind == SYNTAX_VECTOR && i < core->count; i++) {
        TRY(measure_of(scope, core->args[i], &entry, diag));
        TRY(measures_join(whole, entry, core->args[i > 0 ? i - 1 : 0], core->args[i], what, &whole,
                          diag));
    }
    return OK;
}

Status unit_check_compared(const Scope *scope, const Syntax *left, const Syntax *right, Diag *diag)
{
    Measure a = {0};
    Measure b = {0};

    TRY(measure_of(scope, left, &a, diag));
    TRY(measure_of(scope, right, &b, diag));
    return measures_join(a, b, left, right, "compared", &a, diag);
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
