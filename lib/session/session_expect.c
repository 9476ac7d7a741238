/* session_expect.c: expect: conditions that values have to meet */
#include "session/session_impl.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_comparison(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_BINARY && syntax->text[0] != '\0' &&
           strchr("<>=!", syntax->text[0]) != NULL;
}

static const char *at_words(char *buffer, size_t size, const double *at)
{
    if (at == NULL)
        return "";
    (void)snprintf(buffer, size, " at t = %.6g", *at);
    return buffer;
}

/* The unit that two sides are shown in, with a blank in front; "" where neither has one. What their
 * values are to be divided by. */
static double shown_unit(const ct_session *session, const Syntax *left, const Syntax *right,
                         Text *out)
{
    const char *units = session->hooks.units != NULL ? session->hooks.units : "";
    Text unit = {0};
    double size = session_shown_unit(session, left, units, &unit);

    if (unit.length == 0)
        size = session_shown_unit(session, right, units, &unit);
    text_add(out, unit.length > 0 ? " " : "");
    text_add(out, unit.length > 0 ? unit.at : "");
    text_free(&unit);
    return size;
}

/* a hint for a reference that was wrapped, as by an arctangent, compared with a multi-turn angle */
static void hint_turns(double off, double tolerance, const Text *unit, Diag *diag)
{
    const double pi = acos(-1), turns = round(off / (2 * pi));
    Unit unit_given;
    size_t fault;

    if (turns == 0 || !(fabs(off - 2 * pi * turns) <= tolerance) || unit->length < 2 ||
        !unit_parse(unit->at + 1, unit->length - 1, &unit_given, &fault))
        return;
    for (int k = 0; k < 6; k++)
        if (unit_given.dimension.power[k] != (k == 5))
            return;
    diag_hint(diag, "that is %.15g whole turn%s: angles are counted on where an arctangent jumps",
              fabs(turns), fabs(turns) == 1 ? "" : "s");
}

static Status expect_near(ct_session *session, const Statement *s, const Syntax *left,
                          const double *at, Diag *diag)
{
    double value, expected, tolerance = 0;
    char when[48];
    Status status;
    Text text = {0}, unit = {0};

    CHECK(session_value_at(session, left, at, &value, diag));
    CHECK(session_value_at(session, s->near_value, at, &expected, diag));
    CHECK(model_check_alike(session->model, left, s->near_value, diag));
    if (s->within != NULL) {
        CHECK(session_value_at(session, s->within, at, &tolerance, diag));
        CHECK(model_check_alike(session->model, left, s->within, diag));
        CHECK(model_check_alike(session->model, s->near_value, s->within, diag));
    }
    if (!isfinite(value) || !isfinite(expected)) { /* never near */
        const Syntax *undefined = isfinite(value) ? s->near_value : left;

        syntax_print(&text, undefined);
        status = diag_at(diag, E_EXPECT, undefined->place, "%s is undefined%s", text.at,
                         at_words(when, sizeof when, at));
    } else if (!(fabs(value - expected) <= tolerance)) {
        const double size = shown_unit(session, left, s->near_value, &unit);

        syntax_print(&text, left);
        status = diag_at(diag, E_EXPECT, left->place,
                         "%s is %.15g%s%s, expected %.15g%s within %.3g%s: off by %.3g%s", text.at,
                         value / size, unit.at, at_words(when, sizeof when, at), expected / size,
                         unit.at, tolerance / size, unit.at, (value - expected) / size, unit.at);
        hint_turns(value - expected, tolerance, &unit, diag);
    }
done:
    text_free(&text);
    text_free(&unit);
    return status;
}

static Status expect_condition(ct_session *session, const Syntax *condition, const double *at,
                               Diag *diag)
{
    double holds, left, right;
    char when[48];
    Status status;
    Text text = {0}, unit = {0};

    CHECK(session_value_at(session, condition, at, &holds, diag));
    if (holds != 0 && !isnan(holds))
        goto done;
    syntax_print(&text, condition);
    if (is_comparison(condition)) {
        const double size = shown_unit(session, condition->args[0], condition->args[1], &unit);

        CHECK(session_value_at(session, condition->args[0], at, &left, diag));
        CHECK(session_value_at(session, condition->args[1], at, &right, diag));
        status = isfinite(left) && isfinite(right)
                     ? diag_at(diag, E_EXPECT, condition->place,
                               "%s does not hold%s: left is %.15g%s, right is %.15g%s", text.at,
                               at_words(when, sizeof when, at), left / size, unit.at, right / size,
                               unit.at)
                     : diag_at(diag, E_EXPECT, condition->place,
                               "%s does not hold%s: its %s side is undefined", text.at,
                               at_words(when, sizeof when, at), isfinite(left) ? "right" : "left");
    } else {
        status = diag_at(diag, E_EXPECT, condition->place, "%s does not hold%s", text.at,
                         at_words(when, sizeof when, at));
    }
done:
    text_free(&text);
    text_free(&unit);
    return status;
}

ct_status ct_expect(ct_session *session, const ct_statement *statement, ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    double instant = 0;
    const double *at = NULL;
    Status status;
    Diag diag = {0};

    session_begin(session);
    if (s->operands.count == 0) {
        status = diag_at(&diag, E_SYNTAX, s->verb_place, "'expect' needs a condition");
        diag_hint(&diag, "expect h8 ~ 1.05 within 1e-3 at 0.5");
        goto done;
    }
    if (s->at != NULL) {
        CHECK(session_instant(session, s->at, &instant, &diag));
        at = &instant;
    }
    if (s->near_value != NULL)
        status = expect_near(session, s, s->operands.at[0].value, at, &diag);
    else
        status = expect_condition(session, s->operands.at[0].value, at, &diag);
done:
    return session_report(status, &diag, error);
}
