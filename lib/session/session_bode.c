/* session_bode.c: bode: gain and phase of outputs against inputs of the last linearisation
 *
 * The frequencies are even on a logarithmic axis, and closer about poles and zeros off the real
 * axis. The gain is a sum of logarithms of distances from i omega to the roots. A root at the
 * distance d bends the curve by less than 20/ln(10)/d^2 dB, so a peak halfway between two points
 * CLOSE d apart is higher than both by less than 20/ln(10)/2 (CLOSE/2)^2 = 0.04 dB. */
#include "session/session_impl.h"

#include "export/write.h"
#include "present/show.h"
#include "simulate/analyse/transfer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { USUAL_POINTS = 200, MOST_POINTS = 100000 };
static const double LEAST_FREQUENCY = 1e-140, MOST_FREQUENCY = 1e140; /* Hz */
static const double CLOSE =
    0.2; /* between points, of the distance to the root that they are about */
static const double UNDAMPED =
    1e-3; /* relative to a root: least distance of points to an undamped one */

/* the request */
typedef struct Bode {
    const Linear *linear; /* borrowed */
    double from, to;      /* Hz; 0: as the roots suggest */
    int points;
    LIST(int) outputs;
    LIST(Transfer *) transfers; /* of each output, against each input */
} Bode;

/* columns f, then gain and phase of each pair */
typedef struct BodeSheet {
    double *values;
    int rows, columns;
    LIST(char *) names; /* ended by NULL */
} BodeSheet;

static void bode_free(Bode *bode)
{
    for (int i = 0; i < bode->transfers.count; i++)
        transfer_free(bode->transfers.at[i]);
    LIST_FREE(bode->transfers);
    LIST_FREE(bode->outputs);
}

static void sheet_free(BodeSheet *sheet)
{
    for (int i = 0; i < sheet->names.count; i++)
        mem_free(sheet->names.at[i]);
    LIST_FREE(sheet->names);
    mem_free(sheet->values);
}

/* --- reading --- */

static Status find_output(const Bode *bode, const Operand *operand, int *out, Diag *diag)
{
    char *name = view_name(operand->value);
    Suggest suggest = suggest_for(name);
    Status status = OK;

    for (int i = 0; i < bode->linear->outputs; i++) {
        suggest_offer(&suggest, bode->linear->output_names[i]);
        if (strcmp(bode->linear->output_names[i], name) == 0) {
            *out = i;
            goto done;
        }
    }
    status =
        diag_at(diag, E_NAME, operand->place, "%s is no output of the last linearisation", name);
    suggest_or_hint(&suggest, diag, "linearize inputs=[V1] outputs=[%s]", name);
done:
    mem_free(name);
    return status;
}

static Status read_outputs(const Statement *s, Bode *bode, Diag *diag)
{
    for (int i = 0; i < s->operands.count; i++) {
        int output = 0;

        TRY(find_output(bode, &s->operands.at[i], &output, diag));
        LIST_PUSH(bode->outputs, output);
    }
    for (int i = 0; s->operands.count == 0 && i < bode->linear->outputs; i++)
        LIST_PUSH(bode->outputs, i);
    return OK;
}

/* a frequency in Hz; one whose dimension has an angle is an angular frequency */
static Status read_frequency(const Model *model, const Pair *pair, double *out, Diag *diag)
{
    static const Dimension rate = {{0, 0, -1, 0, 0, 0}};
    const Syntax *value = pair->value;
    Dimension dimension = rate;
    Expr e;

    TRY(model_expression(model, value, &e, diag));
    if ((expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) != 0)
        return diag_at(diag, E_VALUE, value->place, "%s must be a number, or made of parameters",
                       pair->name);
    if (model_dimension(model, value, &dimension) && !dimension_same(dimension, rate)) {
        diag_at(diag, E_UNIT, value->has_unit ? value->unit_place : value->place,
                "%s= is a frequency", pair->name);
        diag_hint(diag, "%s=1 kHz, or %s=10 [rad/s]", pair->name, pair->name);
        return E_UNIT;
    }
    *out = model_number(model, e);
    if (dimension_has_angle(dimension))
        *out /= 2 * M_PI;
    if (!isfinite(*out) || *out <= 0)
        return diag_at(diag, E_VALUE, value->place, "%s must be a frequency above 0", pair->name);
    if (*out < LEAST_FREQUENCY || *out > MOST_FREQUENCY)
        return diag_at(diag, E_VALUE, value->place, "%s must be a frequency from %g to %g Hz",
                       pair->name, LEAST_FREQUENCY, MOST_FREQUENCY);
    return OK;
}

static Status read_points(const Model *model, const Pair *pair, int *out, Diag *diag)
{
    double value;
    Expr e;

    TRY(model_expression(model, pair->value, &e, diag));
    TRY(model_check_unit(model, pair->value, "1", "points", diag));
    value = (expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) == 0 ? model_number(model, e) : NAN;
    if (!(value >= 2 && value <= MOST_POINTS && value == floor(value)))
        return diag_at(diag, E_VALUE, pair->value->place, "points= is a whole number from 2 to %d",
                       MOST_POINTS);
    *out = (int)value;
    return OK;
}

static Status read_keys(const Model *model, const Statement *s, Bode *bode, Diag *diag)
{
    const Pair *last = NULL;

    bode->points = USUAL_POINTS;
    for (int i = 0; i < s->pairs.count; i++) {
        const Pair *pair = s->pairs.at + i;

        if (strcmp(pair->name, "points") == 0) {
            TRY(read_points(model, pair, &bode->points, diag));
            continue;
        }
        last = pair;
        TRY(read_frequency(model, pair, strcmp(pair->name, "from") == 0 ? &bode->from : &bode->to,
                           diag));
    }
    if (last != NULL && bode->from > 0 && bode->to > 0 && bode->from >= bode->to) {
        diag_at(diag, E_VALUE, last->value->place, "the frequencies go up: from= is below to=");
        TRY(E_VALUE);
    }
    return OK;
}

/* --- numbers --- */

/* a decade around all poles and zeros that aren't 0 */
static void suggest_range(Bode *bode)
{
    double least = INFINITY, most = 0;

    for (int k = 0; k < bode->transfers.count; k++) {
        const Transfer *t = bode->transfers.at[k];

        for (int i = 0; i < t->poles + t->zeros; i++) {
            const Root root = i < t->poles ? t->pole[i] : t->zero[i - t->poles];
            const double f = hypot(root.real, root.imaginary) / (2 * M_PI);

            least = f > 0 ? fmin(least, f) : least;
            most = fmax(most, f);
        }
    }
    if (most == 0)
        least = most = 1;
    least = pow(10, floor(log10(least / 5)));
    most = pow(10, ceil(log10(most * 5)));
    /* if only one limit is given, and all roots are beyond it, the other is two decades away */
    if (bode->from == 0)
        bode->from = bode->to > 0 && bode->to <= least ? bode->to / 100 : least;
    if (bode->to == 0)
        bode->to = bode->from >= most ? bode->from * 100 : most;
}

static Status find_transfers(Bode *bode, const CallMonitor *watch, Diag *diag)
{
    for (int k = 0; k < bode->outputs.count; k++)
        for (int i = 0; i < bode->linear->inputs; i++) {
            Transfer *t = NULL;

            TRY(monitor_poll(watch));
            TRY(transfer_new(bode->linear, bode->outputs.at[k], i, &t, diag));
            LIST_PUSH(bode->transfers, t);
        }
    return OK;
}

/* whether anything is known to get through; else no digit of the response is */
static bool has_curve(const Transfer *t)
{
    return t->gain != 0;
}

static void remark_without_curve(ct_session *session, const Bode *bode)
{
    for (int k = 0; k < bode->transfers.count; k++) {
        const Transfer *t = bode->transfers.at[k];
        Text text = {0};

        if (has_curve(t))
            continue;
        text_addf(&text, "%s/%s is 0",
                  bode->linear->output_names[bode->outputs.at[k / bode->linear->inputs]],
                  bode->linear->input_names[k % bode->linear->inputs]);
        if (t->within > 0)
            text_addf(&text,
                      " within %.2g: rounding leaves open whether anything gets through, so "
                      "it has no curve",
                      t->within);
        else
            text_add(&text, ": it has no curve");
        session_remark(session, text.at);
        text_free(&text);
    }
}

static char *name_of(const Linear *linear, const char *what, int output, int input,
                     const char *unit)
{
    Text text = {0};

    text_addf(&text, "%s %s/%s [%s]", what, linear->output_names[output],
              linear->input_names[input], unit);
    return text_done(&text);
}

/* --- frequencies --- */

typedef LIST(double) Frequencies; /* Hz */

/* What counts as the damping of a root, 1/s: where it may be 0, the peak has no height to meet. */
static double damping_of(Root root)
{
    const double real = fabs(root.real), size = hypot(root.real, root.imaginary);

    return real > root.error ? real : fmax(root.error, UNDAMPED * size);
}

/* whether points about the one are about the other, too: a pole that several outputs have */
static bool is_near(Root a, Root b)
{
    const double least = fmin(damping_of(a), damping_of(b));

    return fabs(a.imaginary - b.imaginary) <= CLOSE / 10 * least &&
           fabs(damping_of(a) - damping_of(b)) <= CLOSE / 2 * least;
}

/* From the root outward, up to where even points are closer. */
static void add_side(const Bode *bode, Root root, double sign, Frequencies *out)
{
    const double ratio = pow(bode->to / bode->from, 1.0 / (bode->points - 1));
    const double damping = damping_of(root);
    double offset = 0, f;

    for (;;) {
        const double step = CLOSE * hypot(damping, offset);

        offset += step;
        f = (root.imaginary + sign * offset) / (2 * M_PI);
        if (!(f > 0) || step / (2 * M_PI) >= f * (ratio - 1) ||
            (sign > 0 ? f >= bode->to : f <= bode->from))
            return;
        if (f > bode->from && f < bode->to)
            LIST_PUSH(*out, f);
    }
}

static void add_about(const Bode *bode, Root root, Frequencies *out)
{
    const double f = root.imaginary / (2 * M_PI);

    if (fabs(root.real) > root.error && f > bode->from && f < bode->to)
        LIST_PUSH(*out, f);
    add_side(bode, root, 1, out);
    add_side(bode, root, -1, out);
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* The even points, and those about roots off the real axis, in order. */
static void find_frequencies(const Bode *bode, Frequencies *out)
{
    LIST(Root) roots = {0};
    int count = 0;

    for (int r = 0; r + 1 < bode->points; r++)
        LIST_PUSH(*out,
                  bode->from * pow(bode->to / bode->from, (double)r / (double)(bode->points - 1)));
    LIST_PUSH(*out, bode->to);
    for (int k = 0; k < bode->transfers.count; k++) {
        const Transfer *t = bode->transfers.at[k];

        for (int i = 0; i < t->poles + t->zeros; i++) {
            const Root root = i < t->poles ? t->pole[i] : t->zero[i - t->poles];
            bool is_known = root.imaginary <= 0;

            for (int m = 0; m < roots.count && !is_known; m++)
                is_known = is_near(roots.at[m], root);
            if (is_known)
                continue;
            LIST_PUSH(roots, root);
            add_about(bode, root, out);
        }
    }
    LIST_FREE(roots);
    qsort(out->at, (size_t)out->count, sizeof *out->at, by_value);
    for (int i = 0; i < out->count; i++)
        if (count == 0 || out->at[i] > out->at[count - 1])
            out->at[count++] = out->at[i];
    out->count = count;
}

/* --- the sheet --- */

static Status fill_sheet(const Bode *bode, const CallMonitor *watch, BodeSheet *sheet, Diag *diag)
{
    Frequencies f = {0};

    find_frequencies(bode, &f);

    const int rows = f.count, pairs = bode->transfers.count;
    double *omega = NEW_ARRAY(double, rows), *gain = NEW_ARRAY(double, rows),
           *phase = NEW_ARRAY(double, rows);
    Status status = OK;

    (void)diag;
    sheet->rows = rows;
    sheet->columns = 1 + 2 * pairs;
    sheet->values = mem_array((size_t)rows * (size_t)sheet->columns, sizeof(double));
    LIST_PUSH(sheet->names, mem_text("f [Hz]", 6));
    for (int r = 0; r < rows; r++) {
        sheet->values[r * sheet->columns] = f.at[r];
        omega[r] = 2 * M_PI * f.at[r];
    }
    for (int k = 0; k < pairs; k++) {
        const int output = bode->outputs.at[k / bode->linear->inputs];
        const int input = k % bode->linear->inputs;

        CHECK(monitor_poll(watch));
        transfer_response(bode->linear, output, input, bode->transfers.at[k], omega, rows, gain,
                          phase);
        LIST_PUSH(sheet->names, name_of(bode->linear, "gain", output, input, "dB"));
        LIST_PUSH(sheet->names, name_of(bode->linear, "phase", output, input, "deg"));
        for (int r = 0; r < rows; r++) {
            const bool is_known = has_curve(bode->transfers.at[k]);

            sheet->values[r * sheet->columns + 1 + 2 * k] = is_known ? gain[r] : NAN;
            sheet->values[r * sheet->columns + 2 + 2 * k] = is_known ? phase[r] : NAN;
        }
    }
    LIST_PUSH(sheet->names, NULL);
done:
    LIST_FREE(f);
    MEM_FREE(omega, gain, phase);
    return status;
}

static Status make_sheet(ct_session *session, const Statement *s, BodeSheet *out, Diag *diag)
{
    Bode bode = {.linear = session->linear};
    BodeSheet sheet = {0};
    Status status;

    session_begin(session);
    CHECK(linear_check_pairs(session->linear, diag));
    session_remark_linear(session);
    CHECK(read_outputs(s, &bode, diag));
    CHECK(read_keys(session->model, s, &bode, diag));
    CHECK(find_transfers(&bode, &session->watch, diag));
    suggest_range(&bode);
    remark_without_curve(session, &bode);
    CHECK(fill_sheet(&bode, &session->watch, &sheet, diag));
    *out = sheet;
    sheet = (BodeSheet){0};
done:
    if (status != OK && diag->place.line == 0)
        diag->place = s->verb_place;
    bode_free(&bode);
    sheet_free(&sheet);
    return status;
}

/* --- the public functions --- */

ct_status ct_bode(ct_session *session, const ct_statement *statement, double **values, int *rows,
                  int *columns, char ***names, ct_error *error)
{
    SESSION_WORK(session, error);

    BodeSheet sheet = {0};
    Diag diag = {0};
    const Status status = make_sheet(session, statement_of(statement), &sheet, &diag);

    if (status == OK) {
        *values = sheet.values;
        *rows = sheet.rows;
        *columns = sheet.columns;
        *names = sheet.names.at;
    }
    return session_report(status, &diag, error);
}

ct_status ct_bode_csv(ct_session *session, const ct_statement *statement, bool with_header,
                      char **text, ct_error *error)
{
    SESSION_WORK(session, error);

    BodeSheet sheet = {0};
    Text out = {0};
    Diag diag = {0};
    const Status status = make_sheet(session, statement_of(statement), &sheet, &diag);

    if (status == OK) {
        write_csv(&out, (const char *const *)sheet.names.at, sheet.values, sheet.rows,
                  sheet.columns, with_header);
        *text = text_done(&out);
    }
    sheet_free(&sheet);
    return session_report(status, &diag, error);
}
