/* show_sides.c: parts with dry friction and rigid limits, over the last run or at an instant of it
 */
#include "present/show.h"

#include "component/component.h"
#include "present/present_limits.h"

#include <math.h>

enum { REPORTED_PARTS = 8 }; /* in the report of a run */

/* a contact without friction, or a limit: it has no bound */
static bool is_without_bound(const Instance *part)
{
    return part->row->press != NULL ? !instance_value(part, "mu")->given : instance_is_rigid(part);
}

static const char *side_name(const Instance *part, const StickRecord *record)
{
    if (part->row->press != NULL && record->is_open)
        return "open";
    if (is_without_bound(part))
        return record->sticks ? part->row->press != NULL ? "touches" : "holds" : "free";
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
        items[i] = is_without_bound(parts->at[i].part)
                       ? expr_int(model_arena(view->model), 0)
                       : expr_symbol(model_arena(view->model), name.at, SYMBOL_VARIABLE);
        text_free(&name);
    }
    status = view->integrals(view->session, items, parts->count, lost, diag);
    if (status == E_SINGULAR || status == E_SOLVER) { /* between rows something has no solution */
        for (int i = 0; i < parts->count; i++)
            lost[i] = NAN;
        status = OK;
    }
    for (int i = 0; i < parts->count; i++)
        parts->at[i].lost = lost[i];
    MEM_FREE(items, lost);
    return status;
}

/* Fills a list that the caller frees, also on failure; what is rigid where that is wanted too. */
static Status find_rubbing(const View *view, bool with_rigid, RubbingParts *out, Diag *diag)
{
    for (int i = 0; i < model_count(view->model); i++) {
        Rubbing rubbing = {.part = model_instance(view->model, i)};

        if (instance_sticks(rubbing.part) && (with_rigid || !is_without_bound(rubbing.part)) &&
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
        table_cells(&table, "%s\t%s\t%.6g\t%d", at->part->name, side_name(at->part, &at->record),
                    at->record.stuck, at->record.slips);
        if (isnan(at->lost))
            table_cell(&table, "unknown");
        else
            table_cells(&table, "%.6g", shown_loss(at, largest_energy(view, &parts)));
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
    if (isnan(at->lost))
        text_add(out, ", lost an unknown energy\n");
    else
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
    if (parts.count > 1 && !isnan(lost))
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
    const char *members[SHOWN] = {[EFFORT] = part->row->press == NULL
                                                 ? has_effort ? "effort"
                                                              : domain_through(part->row->domain)
                                             : is_without_bound(part) ? "fn"
                                                                      : "ft",
                                  [BOUND] = "bound",
                                  [HOLD] = "hold"};
    Expr items[SHOWN];

    for (int i = 0; i < SHOWN; i++) {
        Text name = {0};

        text_addf(&name, "%s.%s", part->name, members[i]);
        side->names[i] = text_done(&name);
        items[i] = expr_symbol(model_arena(view->model), side->names[i], SYMBOL_VARIABLE);
    }
    return view->instant->read(view->instant->context, items, is_without_bound(part) ? 1 : SHOWN,
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
    table_cell(table, !is_at_rest && effort == 0 && part->row->press == NULL
                          ? "free"
                          : side_name(part, record));
    add_value(view, table, side, EFFORT);
    if (is_without_bound(part)) {
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

/* parts that may stick, as they are at the instant */
typedef struct ShownParts {
    LIST(const char *) names;
    LIST(const Instance *) parts;
    LIST(StickRecord) records;
    LIST(ShownSide) sides;
    bool *shares; /* parts x parts */
} ShownParts;

static void parts_free(ShownParts *parts)
{
    for (int i = 0; i < parts->sides.count; i++)
        side_free(&parts->sides.at[i]);
    LIST_FREE(parts->names);
    LIST_FREE(parts->parts);
    LIST_FREE(parts->records);
    LIST_FREE(parts->sides);
    mem_free(parts->shares);
}

static Status read_parts(const View *view, ShownParts *parts, Diag *diag)
{
    const ViewInstant *instant = view->instant;

    for (int i = 0; i < model_count(view->model); i++) {
        const Instance *part = model_instance(view->model, i);
        StickRecord record;
        ShownSide side = {0};
        Status status;

        if (!instance_sticks(part) ||
            !result_stick_at(view->result, part->name, instant->time, &record))
            continue;
        status = read_side(view, part, &side, diag);
        LIST_PUSH(parts->names, part->name);
        LIST_PUSH(parts->parts, part);
        LIST_PUSH(parts->records, record);
        LIST_PUSH(parts->sides, side);
        TRY(status);
    }
    parts->shares = NEW_ARRAY(bool, parts->names.count * parts->names.count);
    return parts->names.count > 0 ? instant->shares(instant->context, parts->names.at,
                                                    parts->names.count, parts->shares, diag)
                                  : OK;
}

/* Where more parts stick than there are motions, who holds whom: "b1 sticks with b2, and its effort
 * is one of many". */
static void add_shares(const ShownParts *parts, Text *out)
{
    for (int i = 0; i < parts->names.count; i++) {
        const bool is_held = parts->records.at[i].is_held;
        Text others = {0};

        for (int k = 0; k < parts->names.count; k++)
            if (parts->shares[i * parts->names.count + k] && parts->sides.at[k].values[HOLD] > 0)
                layout_item(&others, parts->names.at[k]);
        if (others.length > 0 && parts->sides.at[i].values[HOLD] > 0)
            text_addf(out, "%s %s %s: its effort is one of many\n", parts->names.at[i],
                      is_held ? "is at its limit, held by" : "sticks together with", others.at);
        text_free(&others);
    }
}

static Status show_instant(const View *view, Text *out, Diag *diag)
{
    Table table = table_for("llrrr");
    ShownParts parts = {0};
    Status status = OK;

    CHECK(read_parts(view, &parts, diag));
    if (parts.names.count > 0) {
        text_addf(out, "at t = %.6g s\n", view->instant->time);
        table_cells(&table, "part\tside\teffort\tbound\tshare");
    } else {
        text_add(out, "nothing sticks or slips\n");
    }
    for (int i = 0; i < parts.names.count; i++)
        add_row(view, &table, parts.parts.at[i], &parts.records.at[i], &parts.sides.at[i]);
    table_print(out, &table, 0);
    add_shares(&parts, out);
done:
    table_free(&table);
    parts_free(&parts);
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
