/* session_plot.c: the keys of a plot, the events of a run that it marks, measured data, and a plot
 * as text */
#include "session/session_impl.h"

#include "expr/curve.h"
#include "present/chart.h"

#include <math.h>
#include <string.h>

/* what an item is shown in, a part of SI; 1: SI itself */
static double shown_unit(const Syntax *item)
{
    const bool is_literal =
        item != NULL && (item->kind == SYNTAX_NUMBER || item->kind == SYNTAX_VECTOR);

    return item != NULL && item->has_unit && !is_literal ? item->unit.factor : 1;
}

/* A plain number is in what the axis shows; one with a unit is converted. */
static Status read_range(ct_session *session, const Syntax *range, const Syntax *item,
                         double out[2], Diag *diag)
{
    double ends[2];

    if (range->kind != SYNTAX_VECTOR || range->count != 2) {
        (void)diag_at(diag, E_VALUE, range->place, "a range has two ends");
        diag_hint(diag, "[0, 1]");
        return E_VALUE;
    }
    for (int i = 0; i < 2; i++) {
        const Syntax *end = range->args[i];

        TRY(session_number(session, end, &ends[i], diag));
        if (range->has_unit || (end->has_unit && end->kind == SYNTAX_NUMBER))
            ends[i] *= (range->has_unit ? range->unit.factor : 1) / shown_unit(item);
    }
    if (!(ends[0] < ends[1]))
        return diag_at(diag, E_VALUE, range->place, "a range goes from less to more");
    memcpy(out, ends, sizeof ends);
    return OK;
}

/* which of some words, separated by bars, it is; -1 with a message */
static int find_word(const Pair *pair, const char *words, Diag *diag)
{
    const char *wanted = pair->value->text;
    const size_t length = strlen(wanted);
    int which = 0;

    for (const char *at = words; *at != '\0'; which++) {
        const size_t word = strcspn(at, "|");

        if (word == length && strncmp(at, wanted, word) == 0)
            return which;
        at += word + (at[word] == '|');
    }
    (void)diag_at(diag, E_VALUE, pair->value->place, "%s= is one of %s", pair->name, words);
    return -1;
}

static Status read_key(ct_session *session, const Statement *s, const Pair *pair, ct_plot *out,
                       Diag *diag)
{
    int word;

    if (strcmp(pair->name, "xrange") == 0)
        return read_range(session, pair->value, s->versus, out->x, diag);
    if (strcmp(pair->name, "yrange") == 0)
        return read_range(session, pair->value, s->operands.at[0].value, out->y, diag);
    if (strcmp(pair->name, "title") == 0) {
        out->title = pair->value->text;
        return pair->value->kind == SYNTAX_STRING
                   ? OK
                   : diag_at(diag, E_VALUE, pair->value->place, "a title stands in double quotes");
    }
    if (strcmp(pair->name, "log") == 0) {
        word = find_word(pair, "x|y|xy", diag);
        out->x_is_log = word == 0 || word == 2;
        out->y_is_log = word > 0;
    } else {
        word = find_word(pair, "on|off", diag);
        *(strcmp(pair->name, "map") == 0 ? &out->map : &out->panels) = word == 0;
    }
    return word < 0 ? E_VALUE : OK;
}

ct_status ct_plot_keys(ct_session *session, const ct_statement *statement, ct_plot *out,
                       ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    const char *title = model_title(session->model);
    ct_plot plot = {.x = {NAN, NAN}, .y = {NAN, NAN}, .title = title != NULL ? title : ""};
    Status status = OK;
    Diag diag = {0};

    session_begin(session);
    for (int i = 0; i < s->pairs.count; i++)
        CHECK(read_key(session, s, &s->pairs.at[i], &plot, &diag));
    *out = plot;
done:
    return session_report(status, &diag, error);
}

const char *ct_run_event(const ct_session *session, int run, int i, const double **times,
                         int *count)
{
    const int last = run == 0 ? session->runs.count - 1 : run - 1;
    const Result *result =
        last >= 0 && last < session->runs.count ? session->runs.at[last].result : NULL;

    if (result == NULL || i < 0 || i >= result_event_count(result))
        return NULL;

    const EventRecord record = result_event(result, i);

    *times = record.times;
    *count = record.count;
    return record.name;
}

/* --- measured data --- */

typedef LIST(double) Instants;

/* When x, a value a row, is that of a point, between two rows by a straight line. */
static void find_instants(const Curve *curve, const double *times, const double *x, int rows,
                          Instants *out)
{
    for (int r = 1; r < rows; r++)
        for (int i = 0; i < curve->count; i++) {
            const double s = (curve->data[i] - x[r - 1]) / (x[r] - x[r - 1]);

            /* what lies on a row is found once */
            if ((s > 0 || (s == 0 && r == 1)) && s <= 1)
                LIST_PUSH(*out, times[r - 1] + s * (times[r] - times[r - 1]));
        }
}

/* "x (file.csv)" */
static char *measured_name(const Curve *curve)
{
    const bool is_number = curve->column[strspn(curve->column, "0123456789")] == '\0';
    Text text = {0};

    text_addf(&text, "%s%s (%s)", is_number ? "column " : "", curve->column, curve->file);
    return text_done(&text);
}

/* the data of a table, whatever its owner in the formula */
static const Curve *find_curve(const Formula *formula)
{
    const Curve *out = NULL;

    for (int i = -1; i < formula->leaves.count && out == NULL; i++) {
        const Expr root = i < 0 ? formula->whole : formula->leaves.at[i].expr;
        Expr *tables = NULL;

        if (root != NULL && expr_tables(&root, 1, &tables) > 0)
            out = expr_data(tables[0]);
        mem_free(tables);
    }
    return out;
}

static Status find_measured(ct_session *session, const Syntax *item, const Syntax *argument,
                            double **values, int *rows, char **name, Diag *diag)
{
    Formula whole = {0}, place = {0};
    Run *source = NULL, *grid;
    Instants instants = {0};
    double *x = NULL;
    Status status = OK;

    CHECK(session_last_run(session, &source, diag));
    CHECK(formula_new(session, item, &whole, diag));
    CHECK(formula_new(session, argument, &place, diag));
    grid = formula_grid(session, &place, 1, source);

    const int all = result_rows(grid->result);

    x = NEW_ARRAY(double, all);
    CHECK(formula_rows(session, &place, 1, grid, source, NULL, all, x, 1, 0, diag));

    const Curve *curve = find_curve(&whole);

    if (curve == NULL)
        goto done;
    find_instants(curve, result_times(grid->result), x, all, &instants);
    *name = measured_name(curve);
    *rows = instants.count;
    *values = mem_array(2 * ((size_t)instants.count + 1), sizeof **values);
    for (int i = 0; i < instants.count; i++)
        (*values)[2 * i] = instants.at[i];
    if (instants.count > 0) /* without times it would be the rows of the run */
        CHECK(formula_rows(session, &whole, 1, grid, source, instants.at, instants.count, *values,
                           2, 1, diag));
done:
    formula_free(&whole);
    formula_free(&place);
    LIST_FREE(instants);
    mem_free(x);
    if (status != OK) {
        MEM_FREE(*values, *name);
        *values = NULL;
        *name = NULL;
    }
    return status;
}

ct_status ct_measured(ct_session *session, const ct_expression *item, double **values, int *rows,
                      char **name, ct_error *error)
{
    SESSION_WORK(session, error);

    const Syntax *syntax = syntax_of(item), *call = syntax;
    Status status = OK;
    Diag diag = {0};

    *values = NULL;
    *name = NULL;
    *rows = 0;
    session_begin(session);
    while (call->kind == SYNTAX_GROUP && call->primes == 0)
        call = call->args[0];
    if (call->kind == SYNTAX_CALL && strcmp(call->text, "table") == 0 && call->count > 1)
        status = find_measured(session, syntax, call->args[1], values, rows, name, &diag);
    return session_report(status, &diag, error);
}

/* --- as text --- */

static void read_chart(const ct_chart *in, Chart *out)
{
    ChartCurve *curves = NEW_ARRAY(ChartCurve, in->count);
    ChartMark *marks = NEW_ARRAY(ChartMark, in->mark_count);

    for (int i = 0; i < in->count; i++) {
        const ct_curve *c = &in->curves[i];

        curves[i] = (ChartCurve){c->x,       c->y,     c->count,     c->stride,
                                 c->x_scale, c->label, c->is_points, c->is_right};
    }
    for (int i = 0; i < in->mark_count; i++)
        marks[i] = (ChartMark){in->marks[i], in->mark_names[i]};
    *out = (Chart){.title = in->title,
                   .x_label = in->x_label,
                   .y_label = {in->left_label, in->right_label},
                   .x = {in->x[0], in->x[1]},
                   .y = {in->y[0], in->y[1]},
                   .x_is_log = in->x_is_log,
                   .y_is_log = in->y_is_log,
                   .has_equal_scales = in->has_equal_scales,
                   .fits_x = in->fits_x,
                   .curves = curves,
                   .count = in->count,
                   .marks = marks,
                   .mark_count = in->mark_count};
}

char *ct_chart_text(const ct_chart *charts, int count, int columns, int rows, bool unicode)
{
    TRANSACTION(NULL);

    Chart *all = NEW_ARRAY(Chart, count);
    Text text = {0};

    for (int i = 0; i < count; i++)
        read_chart(&charts[i], &all[i]);
    chart_text(all, count, columns, rows, unicode, &text);
    for (int i = 0; i < count; i++) {
        mem_free((void *)all[i].curves);
        mem_free((void *)all[i].marks);
    }
    mem_free(all);
    return text_done(&text);
}
