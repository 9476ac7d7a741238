/* show_sides.c: parts with dry friction and rigid limits, over the last run or at an instant of it
 */
#include "present/show.h"

#include "component/component.h"
#include "present/present_limits.h"

#include <math.h>

enum { REPORTED_PARTS = 8 }; /* in the report of a run */

static const char *side_name(const Instance *part, const StickRecord *record)
{
    if (instance_is_rigid(part))
        return record->sticks ? "holds" : "free";
    return record->is_held ? "held at its bound" : record->sticks ? "sticks" : "slips";
}

/* --- over the run --- */

/* parts that may stick in the last run */
typedef struct Rubbing {
    const Instance *part;
    StickRecord record;
    double lost; /* J; of what is rigid 0 */
} Rubbing;
typedef LIST(Rubbing) RubbingParts;

static Status read_lost(const View *view, RubbingParts *parts, Diag *diag)
{
    Expr *items = NEW_ARRAY(Expr, parts->count);
    double *lost = NEW_ARRAY(double, parts->count);
    Status status = OK;

    for (int i = 0; i < parts->count; i++) {
        Text name = {0};

        text_addf(&name, "%s.loss", parts->at[i].part->name);
        items[i] = instance_is_rigid(parts->at[i].part)
                       ? expr_int(model_arena(view->model), 0)
                       : expr_symbol(model_arena(view->model), name.at, SYMBOL_VARIABLE);
        text_free(&name);
    }
    CHECK(view->integrals(view->session, items, parts->count, lost, diag));
    for (int i = 0; i < parts->count; i++)
        parts->at[i].lost = lost[i];
done:
    MEM_FREE(items, lost);
    return status;
}

/* Fills a list that the caller frees, also on failure; what is rigid where that is wanted too. */
static Status find_rubbing(const View *view, bool with_rigid, RubbingParts *out, Diag *diag)
{
    for (int i = 0; i < model_count(view->model); i++) {
        Rubbing rubbing = {.part = model_instance(view->model, i)};

        if (instance_sticks(rubbing.part) && (with_rigid || !instance_is_rigid(rubbing.part)) &&
            result_rows(view->result) > 0 &&
            result_stick(view->result, rubbing.part->name, &rubbing.record))
            LIST_PUSH(*out, rubbing);
    }
    return out->count > 0 ? read_lost(view, out, diag) : OK;
}

/* a size of the energies of the run, J */
static double largest_energy(const View *view, const RubbingParts *parts)
{
    const double scale = result_report(view->result)->energy_scale;
    double largest = isfinite(scale) ? scale : 0;

    for (int i = 0; i < parts->count; i++)
        largest = fmax(largest, fabs(parts->at[i].lost));
    return largest;
}

static double shown_loss(const Rubbing *rubbing, double largest)
{
    return fabs(rubbing->lost) <= LOSS_NOISE * largest ? 0 : rubbing->lost;
}

static Status show_course(const View *view, Text *out, Diag *diag)
{
    Table table = table_for("llrrr");
    RubbingParts parts = {0};
    Status status = OK;

    CHECK(find_rubbing(view, true, &parts, diag));
    for (int i = 0; i < parts.count; i++) {
        const Rubbing *at = &parts.at[i];

        if (i == 0)
            table_cells(&table, "part\tat the end\tstuck [s]\tslips\tlost [J]");
        table_cells(&table, "%s\t%s\t%.6g\t%d\t%.6g", at->part->name,
                    side_name(at->part, &at->record), at->record.stuck, at->record.slips,
                    shown_loss(at, largest_energy(view, &parts)));
    }
    if (parts.count == 0)
        text_add(out, "nothing sticks or slips\n");
    table_print(out, &table, 0);
done:
    table_free(&table);
    LIST_FREE(parts);
    return status;
}

static void add_count(Text *out, const char *what, int count)
{
    if (count == 1)
        text_addf(out, "%s once", what);
    else if (count > 1)
        text_addf(out, "%s %d times", what, count);
    else
        text_addf(out, "never %s", what);
}

/* "f1: stuck 0.71 to 0.79 s, slipped 3 times, lost 1.32 J" */
static void report_part(const Rubbing *at, double largest, Text *out)
{
    const StickRecord *record = &at->record;

    text_addf(out, "%s: ", at->part->name);
    if (record->spans == 1)
        text_addf(out, "stuck %.6g to %.6g s", record->from, record->to);
    else
        add_count(out, "stuck", record->spans);
    if (record->spans > 1)
        text_addf(out, " for %.6g s", record->stuck);
    text_add(out, ", ");
    add_count(out, "slipped", record->slips);
    text_addf(out, ", lost %.6g J\n", shown_loss(at, largest));
}

Status report_friction(const View *view, Text *out, Diag *diag)
{
    RubbingParts parts = {0};
    double lost = 0;
    Status status = OK;

    CHECK(find_rubbing(view, false, &parts, diag));
    for (int i = 0; i < parts.count; i++) {
        if (i < REPORTED_PARTS)
            report_part(&parts.at[i], largest_energy(view, &parts), out);
        lost += shown_loss(&parts.at[i], largest_energy(view, &parts));
    }
    if (parts.count > REPORTED_PARTS)
        text_addf(out, "and %d more parts with friction: 'show sides' lists them\n",
                  parts.count - REPORTED_PARTS);
    if (parts.count > 1)
        text_addf(out, "friction: lost %.6g J in all\n", lost);
done:
    LIST_FREE(parts);
    return status;
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
    return view->instant->read(view->instant->context, items, instance_is_rigid(part) ? 1 : SHOWN,
                               side->values, diag);
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
static void add_row(const View *view, Table *table, const Instance *part, const StickRecord *record,
                    const ShownSide *side)
{
    const int bound = record->sticks && !record->is_held ? HOLD : BOUND;
    const double effort = fabs(side->values[EFFORT]), most = side->values[bound];
    const bool is_at_rest = record->sticks || record->is_held;

    table_cell(table, part->name);
    table_cell(table, !is_at_rest && effort == 0 ? "free" : side_name(part, record));
    add_value(view, table, side, EFFORT);
    if (instance_is_rigid(part)) {
        table_cell(table, "none");
        table_cell(table, "");
        return;
    }
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

        if (!instance_sticks(part) ||
            !result_stick_at(view->result, part->name, view->instant->time, &record))
            continue;
        if (table.cells.count == 0) {
            text_addf(out, "at t = %.6g s\n", view->instant->time);
            table_cells(&table, "part\tside\teffort\tbound\tshare");
        }
        status = read_side(view, part, &side, diag);
        if (status == OK)
            add_row(view, &table, part, &record, &side);
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

Status show_without_run(Diag *diag)
{
    (void)diag_set(diag, E_MISSING, "there is no run yet");
    diag_hint(diag, "'simulate 10' makes one");
    return E_MISSING;
}

Status show_sides(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    (void)selection;
    if (view->result == NULL)
        return show_without_run(diag);
    return view->instant != NULL ? show_instant(view, out, diag) : show_course(view, out, diag);
}
