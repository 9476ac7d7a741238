/* show_sides.c: parts with dry friction, over the last run or at an instant of it */
#include "present/show.h"

#include "component/component.h"

#include <math.h>

static const char *side_name(const StickRecord *record)
{
    return record->is_held ? "held at its bound" : record->sticks ? "sticks" : "slips";
}

static Status show_course(const View *view, Text *out)
{
    Table table = table_for("llrr");

    for (int i = 0; i < model_count(view->model); i++) {
        const Instance *part = model_instance(view->model, i);
        StickRecord record;

        if (!part->row->sticks || !result_stick(view->result, part->name, &record))
            continue;
        if (table.cells.count == 0)
            table_cells(&table, "part\tat the end\tstuck [s]\tslips");
        table_cells(&table, "%s\t%s\t%.6g\t%d", part->name, side_name(&record), record.stuck,
                    record.slips);
    }
    if (table.cells.count == 0)
        text_add(out, "nothing sticks or slips\n");
    table_finish(out, &table, 0);
    return OK;
}

/* --- at an instant --- */

/* the values of a part that are shown, by the names of their variables */
enum { EFFORT, BOUND, HOLD, SHOWN };

typedef struct ShownSide {
    char *names[SHOWN];
    double values[SHOWN];
} ShownSide;

static void side_free(ShownSide *side)
{
    for (int i = 0; i < SHOWN; i++)
        mem_free(side->names[i]);
}

static Status read_side(const View *view, const Instance *part, ShownSide *side, Diag *diag)
{
    const bool has_effort =
        component_find_member(part->row, model_is_planar(view->model), "effort") != NULL;
    const char *members[SHOWN] = {[EFFORT] =
                                      has_effort ? "effort" : domain_through(part->row->domain),
                                  [BOUND] = "bound",
                                  [HOLD] = "hold"};
    Expr items[SHOWN];

    for (int i = 0; i < SHOWN; i++) {
        Text name = {0};

        text_addf(&name, "%s.%s", part->name, members[i]);
        side->names[i] = text_done(&name);
        items[i] = expr_symbol(model_arena(view->model), side->names[i], SYMBOL_VARIABLE);
    }
    return view->instant->read(view->instant->context, items, SHOWN, side->values, diag);
}

static void add_value(const View *view, Table *table, const ShownSide *side, int which)
{
    Text value = {0};

    view_quantity(view, side->names[which], side->values[which] + 0.0, 6, &value);
    table_cell(table, value.at);
    text_free(&value);
}

/* At rest the bound is that of static friction. What slips is at its bound, with viscous friction
 * beside it. */
static void add_row(const View *view, Table *table, const char *part, const StickRecord *record,
                    const ShownSide *side)
{
    const int bound = record->sticks && !record->is_held ? HOLD : BOUND;
    const double effort = fabs(side->values[EFFORT]), most = side->values[bound];
    const bool is_at_rest = record->sticks || record->is_held;

    table_cell(table, part);
    table_cell(table, !is_at_rest && effort == 0 ? "free" : side_name(record));
    add_value(view, table, side, EFFORT);
    add_value(view, table, side, bound);
    if (is_at_rest && most > 0)
        table_cells(table, "%.4g %%", 100 * effort / most);
    else
        table_cell(table, effort > 0 ? "100 %" : "");
}

static Status show_instant(const View *view, Text *out, Diag *diag)
{
    Table table = table_for("llrrr");
    Status status = OK;

    for (int i = 0; i < model_count(view->model); i++) {
        const Instance *part = model_instance(view->model, i);
        StickRecord record;
        ShownSide side = {0};

        if (!part->row->sticks ||
            !result_stick_at(view->result, part->name, view->instant->time, &record))
            continue;
        if (table.cells.count == 0) {
            text_addf(out, "at t = %.6g s\n", view->instant->time);
            table_cells(&table, "part\tside\teffort\tbound\tshare");
        }
        status = read_side(view, part, &side, diag);
        if (status == OK)
            add_row(view, &table, part->name, &record, &side);
        side_free(&side);
        CHECK(status);
    }
    if (table.cells.count == 0)
        text_add(out, "nothing sticks or slips\n");
    table_print(out, &table, 0);
done:
    table_free(&table);
    return status;
}

Status show_sides(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    (void)selection;
    if (view->result == NULL)
        return show_without_run(diag);
    return view->instant != NULL ? show_instant(view, out, diag) : show_course(view, out);
}
