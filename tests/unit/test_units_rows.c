/* test_units_rows.c: laws of units that every row of the components obeys: what a variable is in,
 * and what a key takes */
#include "component/component.h"
#include "test_model.h"

/* a unit of another dimension than any */
#define OTHER "*A^7"

/* the part before the bar of "N/m|N*m", or behind it */
static void choose_unit(char *out, size_t size, const char *unit, bool on_angle)
{
    const char *bar = strchr(unit, '|');

    (void)snprintf(out, size, "%.*s",
                   (int)(bar == NULL || on_angle ? strlen(unit) : (size_t)(bar - unit)), unit);
    if (bar != NULL && on_angle)
        (void)snprintf(out, size, "%s", bar + 1);
}

static Status check_shown(const Model *model, const char *text, Diag *diag)
{
    Pool *pool = pool_new(0);
    Syntax *item = NULL;
    Status status = syntax_parse_expression(text, pool, &item, diag);

    if (status == OK)
        status = model_check_shown(model, item, diag);
    pool_free(pool);
    return status;
}

/* in this unit and in no other, derivatives by it and seconds */
static void expect_variable(const Model *model, const char *name, const char *unit, int primes)
{
    char text[200];
    Diag diag = {0};

    for (int n = 0; n <= primes; n++) {
        (void)snprintf(text, sizeof text, "%s%.*s [%s/s^%d]", name, n, "''", unit, n);
        if (n == 0)
            (void)snprintf(text, sizeof text, "%s [%s]", name, unit);
        if (check_shown(model, text, &diag) != OK) {
            test_faults++;
            printf("%s: %s\n", text, diag.message);
        }
        (void)snprintf(text, sizeof text, "%s%.*s [%s/s^%d]", name, n, "''", unit, n + 1);
        EXPECT(check_shown(model, text, &diag) == E_UNIT);
        (void)snprintf(text, sizeof text, "%s%.*s [%s/s^%d" OTHER "]", name, n, "''", unit,
                       n == 0 ? 3 : n);
        EXPECT(check_shown(model, text, &diag) == E_UNIT);
    }
}

static int expect_members(const Model *model, const Instance *part)
{
    const Member *member;
    int known = 0;

    for (int i = 0; (member = component_member(part->row, model_is_planar(model), i)) != NULL;
         i++) {
        const bool is_effort = strcmp(member->name, "effort") == 0 &&
                               (part->row->family != FAMILY_JOINT || part->coord_count == 1);
        const bool is_turn = part->row->family == FAMILY_JOINT
                                 ? part->coord_count > 0 && part->coord_kind[0] == COORDINATE_ANGLE
                                 : part->on_angle;
        const char *unit = is_effort ? (is_turn ? "N*m" : "N") : member->unit;
        char name[100], chosen[60];

        if (unit == NULL)
            continue;
        choose_unit(chosen, sizeof chosen, unit, part->on_angle);
        (void)snprintf(name, sizeof name, "%s.%s", part->name, member->name);
        expect_variable(model, name, chosen, member->primes);
        known++;
    }
    return known;
}

static void every_variable_is_in_its_unit_and_no_other(void)
{
    static const char *const coordinates[] = {"m", "rad", "1"};
    const Component *row;
    int known = 0;

    for (int i = 0; (row = component_at(i)) != NULL; i++) {
        Model *model = model_of(row->example);

        for (int k = 0; k < model_count(model); k++) {
            const Instance *part = model_instance(model, k);

            known += expect_members(model, part);
            for (int c = 0; c < part->coord_count; c++)
                expect_variable(model, part->coord[c], coordinates[part->coord_kind[c]], 2);
        }
        model_free(model);
    }
    EXPECT(known > 200);
}

/* what stands for a value of this kind before its unit; NULL: it has none */
static const char *value_of_kind(ParamKind kind, bool planar)
{
    switch (kind) {
    case PARAM_SCALAR:
    case PARAM_LAW:
        return "1";
    case PARAM_VECTOR:
    case PARAM_LAWS:
        return planar ? "[1, 1]" : "[1, 1, 1]";
    case PARAM_INERTIA:
    case PARAM_MOMENT:
        return planar ? "1" : "[1, 1, 1]";
    case PARAM_LIST:
    case PARAM_LIST_LAWS:
        return "[1, 2]";
    default:
        return NULL;
    }
}

static void expect_key(Model *model, const Instance *part, const Param *param)
{
    const char *value = value_of_kind(param->kind, model_is_planar(model));
    char unit[60], line[200];
    Diag diag = {0};
    Status status;

    if (value == NULL || param->unit == NULL)
        return;
    choose_unit(unit, sizeof unit, param->unit, part->on_angle);
    (void)snprintf(line, sizeof line, "set %s.%s = %s [%s" OTHER "]", part->name, param->name,
                   value, unit);
    status = apply_text(model, line, &diag);
    if (status != E_UNIT || strstr(diag.message, param->name) == NULL) {
        test_faults++;
        printf("%s: %s\n", line, status == OK ? "done" : diag.message);
    }
    /* which may be refused for another reason */
    (void)snprintf(line, sizeof line, "set %s.%s = %s [%s]", part->name, param->name, value, unit);
    if (apply_text(model, line, &diag) == E_UNIT) {
        test_faults++;
        printf("%s: %s\n", line, diag.message);
    }
}

static void every_key_takes_its_unit_and_no_other(void)
{
    const Component *row;

    for (int i = 0; (row = component_at(i)) != NULL; i++) {
        Model *model = model_of(row->example);

        for (int k = 0; k < model_count(model); k++)
            for (int p = 0; p < model_instance(model, k)->row->param_count; p++)
                expect_key(model, model_instance(model, k),
                           &model_instance(model, k)->row->params[p]);
        model_free(model);
    }
}

int main(void)
{
    RUN(every_variable_is_in_its_unit_and_no_other);
    RUN(every_key_takes_its_unit_and_no_other);
    return test_end();
}
