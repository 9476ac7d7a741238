/* show_transfer.c: transfer functions as text, and in other notations */
#include "present/show.h"
#include "simulate/analyse/transfer.h"

#include <math.h>

enum { DIGITS = 6 };

#define SLIGHT 1e-9 /* errors of zeros, relative */

/* --- polynomials and roots --- */

/* "2 s^2 - s + 0.5"; in latex s^{10} */
static void add_polynomial(Text *out, const double *at, int degree, bool latex)
{
    bool any = false;

    for (int k = 0; k <= degree; k++) {
        const int power = degree - k;
        const double size = fabs(at[k]);
        const bool is_one = fabs(size - 1) < 1e-7; /* as it prints */

        if (at[k] == 0)
            continue;
        text_add(out, any ? at[k] < 0 ? " - " : " + " : at[k] < 0 ? "-" : "");
        any = true;
        if ((!is_one || power == 0) && latex)
            linear_latex(out, size, DIGITS);
        else if (!is_one || power == 0)
            text_number(out, size, DIGITS);
        if (!is_one && power > 0)
            text_char(out, ' ');
        if (power > 0)
            text_char(out, 's');
        if (power > 1)
            text_addf(out, latex ? "^{%d}" : "^%d", power);
    }
    if (!any)
        text_char(out, '0');
}

static int terms_of(const double *at, int degree)
{
    int count = 0;

    for (int k = 0; k <= degree; k++)
        count += at[k] != 0;
    return count;
}

/* in brackets where it is a sum */
static void add_factor(Text *out, const double *at, int degree)
{
    const bool is_sum = terms_of(at, degree) > 1;

    text_add(out, is_sum ? "(" : "");
    add_polynomial(out, at, degree, false);
    text_add(out, is_sum ? ")" : "");
}

/* what a zero is to be small against: itself, or where it is 0 the least of all others */
static double scale_of_zero(const Transfer *t, const Root *zero)
{
    double least = hypot(zero->real, zero->imaginary);

    for (int i = 0; i < t->zeros + t->poles && zero->real == 0 && zero->imaginary == 0; i++) {
        const Root *root = i < t->zeros ? &t->zero[i] : &t->pole[i - t->zeros];
        const double size = hypot(root->real, root->imaginary);

        least = size > 0 && (least == 0 || size < least) ? size : least;
    }
    return least;
}

/* Whether a root needs a mark. For a pole only its side of 0 matters, however near; a zero whose
 * error is at most SLIGHT behaves like one at 0. */
static bool wants_mark(const Transfer *t, const Root *root)
{
    const bool is_zero = root >= t->zero && root < t->zero + t->zeros;

    return root_is_doubtful(root) && !(is_zero && root->error <= SLIGHT * scale_of_zero(t, root));
}

/* "-2 +- 3i", "+-3i"; "0?" where the side of 0 can't be determined */
static void add_root(Text *out, const Transfer *t, const Root *root)
{
    const bool is_doubtful = wants_mark(t, root);

    if (root->real != 0 || root->imaginary == 0 || is_doubtful)
        linear_known(out, root->real, root->error);
    text_add(out, is_doubtful ? "?" : "");
    if (root->imaginary > 0) {
        text_add(out, root->real != 0 || is_doubtful ? " +- " : "+-");
        linear_known(out, root->imaginary, root->error);
        text_char(out, 'i');
    }
}

/* what the marks mean */
static void add_doubts(Table *table, const Transfer *t)
{
    double largest = 0;

    if (t->within > 0)
        table_cells(table, "?\t0 within %.2g: rounding leaves open whether anything gets through",
                    t->within);
    for (int i = 0; i < t->zeros + t->poles; i++) {
        const Root *root = i < t->zeros ? &t->zero[i] : &t->pole[i - t->zeros];

        if (wants_mark(t, root))
            largest = fmax(largest, root->error);
    }
    if (largest > 0)
        table_cells(table, "?\t0 within %.2g 1/s: rounding leaves open on which side", largest);
}

/* "0, -1, -2 +- 3i" */
static void add_roots(Table *table, const char *title, const Transfer *t, const Root *roots,
                      int count)
{
    Text text = {0};

    if (count == 0)
        return;
    for (int i = 0; i < count; i++) {
        if (roots[i].imaginary < 0)
            continue;
        text_add(&text, text.length > 0 ? ", " : "");
        add_root(&text, t, &roots[i]);
    }
    table_cells(table, "%s\t%s", title, text.at);
    text_free(&text);
}

/* --- one transfer function --- */

static void add_left_out(Table *table, const Transfer *t)
{
    Text text = {0};

    if (t->idle > 0) {
        layout_count(&text, t->idle, "state", "states");
        text_addf(&text, " between which and the two no way leads");
    }
    if (t->cancelled > 0) {
        text_add(&text, t->idle > 0 ? ", " : "");
        layout_count(&text, t->cancelled, "pole", "poles");
        text_add(&text, t->cancelled == 1 ? " equal to a zero" : " equal to zeros");
    }
    if (text.length > 0)
        table_cells(table, "left out\t%s", text.at);
    text_free(&text);
}

/* coefficients of many fast roots may overflow */
static bool has_coefficients(const Transfer *t)
{
    for (int i = 0; i <= t->zeros; i++)
        if (!isfinite(t->numerator[i]))
            return false;
    for (int i = 0; i <= t->poles; i++)
        if (!isfinite(t->denominator[i]))
            return false;
    return true;
}

/* one that is 0 but for what rounding leaves open */
static bool is_open(const Root *root, int count)
{
    for (int i = 0; i < count; i++)
        if (root_is_doubtful(&root[i]) && root[i].imaginary == 0)
            return true;
    return false;
}

/* what a constant input leads to; with a mark where that hangs on a root that may be 0 */
static void add_at_rest(Table *table, const Transfer *t)
{
    const double last = t->denominator[t->poles];
    const bool is_doubtful = is_open(t->zero, t->zeros) || is_open(t->pole, t->poles);

    if (last != 0)
        table_cells(table, "at rest\t%.*g%s", DIGITS, t->numerator[t->zeros] / last,
                    is_doubtful ? "?" : "");
    else
        table_cells(table, "at rest\tno bound%s", is_doubtful ? "?" : "");
}

static void print_text(Text *out, const View *view, const Transfer *t, int output, int input)
{
    const Linear *linear = view->linear;
    Table table = table_for("ll");
    Text lead = {0}, body = {0};

    text_addf(&lead, "%s/%s = ", linear->output_names[output], linear->input_names[input]);
    if (has_coefficients(t))
        add_factor(&body, t->numerator, t->zeros);
    else
        text_addf(&body, "gain prod(s - zero)/prod(s - pole), %d zeros and %d poles", t->zeros,
                  t->poles);
    text_add(&body, t->within > 0 ? "?" : "");
    if (t->poles > 0 && has_coefficients(t)) {
        text_char(&body, '/');
        add_factor(&body, t->denominator, t->poles);
    }
    layout_formula(out, &view->page, lead.at, body.at);
    if (t->gain != 0 && t->poles > 0) {
        table_cells(&table, "gain\t%.*g", DIGITS, t->gain);
        if (has_coefficients(t))
            add_at_rest(&table, t);
        add_roots(&table, "zeros", t, t->zero, t->zeros);
        add_roots(&table, "poles", t, t->pole, t->poles);
    }
    add_doubts(&table, t);
    add_left_out(&table, t);
    table_finish(out, &table, 2);
    text_free(&lead);
    text_free(&body);
}

static void print_latex(Text *out, const Transfer *t, int output, int input)
{
    text_addf(out, "H_{%d,%d}(s) &= ", output + 1, input + 1);
    if (t->poles > 0)
        text_add(out, "\\frac{");
    add_polynomial(out, t->numerator, t->zeros, true);
    if (t->poles > 0) {
        text_add(out, "}{");
        add_polynomial(out, t->denominator, t->poles, true);
        text_char(out, '}');
    }
    text_add(out, " \\\\\n");
}

/* coefficients by falling powers, under the names of their row and column */
static void print_code(Text *out, const Transfer *t, int output, int input, bool is_c)
{
    const char *const names[] = {"numerator", "denominator"};
    const double *const at[] = {t->numerator, t->denominator};
    const int counts[] = {t->zeros + 1, t->poles + 1};

    for (int k = 0; k < COUNT(names); k++) {
        if (is_c)
            text_addf(out, "static const double %s_%d_%d[%d] = {", names[k], output + 1, input + 1,
                      counts[k]);
        else
            text_addf(out, "%s{%d,%d} = [", names[k], output + 1, input + 1);
        layout_numbers(out, at[k], counts[k], NULL);
        text_add(out, is_c ? "};\n" : "];\n");
    }
}

static Status print_one(const View *view, int output, int input, Text *out, Diag *diag)
{
    const NotationKind kind = view_kind(view);
    Transfer *t = NULL;
    Text name = {0};
    Status status;

    CHECK(monitor_poll(view->watch));
    CHECK(transfer_new(view->linear, output, input, &t, diag));
    text_addf(&name, "%s/%s", view->linear->output_names[output], view->linear->input_names[input]);
    if (!has_coefficients(t) && (kind == NOTATION_TYPESET || kind == NOTATION_SOURCE)) {
        (void)diag_set(diag, E_VALUE, "the coefficients of %s are beyond what numbers hold",
                       name.at);
        diag_hint(diag, "'show transfer' shows its gain, zeros and poles");
        CHECK(E_VALUE);
    }
    if (kind == NOTATION_TYPESET) {
        print_latex(out, t, output, input);
    } else if (kind == NOTATION_SOURCE) {
        view_comment(out, view, name.at);
        print_code(out, t, output, input, view->page.notation == NOTATION_C);
    } else {
        print_text(out, view, t, output, input);
    }
done:
    transfer_free(t);
    text_free(&name);
    return status;
}

/* --- the topic --- */

Status linear_check_pairs(const Linear *linear, Diag *diag)
{
    if (linear == NULL)
        (void)diag_set(diag, E_MISSING, "nothing has been linearized yet");
    else if (linear->inputs == 0 || linear->outputs == 0)
        (void)diag_set(diag, E_MISSING, "what was linearized has no %s",
                       linear->inputs > 0    ? "outputs"
                       : linear->outputs > 0 ? "inputs"
                                             : "inputs and outputs");
    else
        return OK;
    diag_hint(diag, "linearize inputs=[V1] outputs=[h8]");
    return E_MISSING;
}

static Status check_entry(const Linear *linear, const Selection *selection, Diag *diag)
{
    if ((selection->number_count > 0 && selection->numbers[0] > linear->outputs) ||
        (selection->number_count > 1 && selection->numbers[1] > linear->inputs))
        return diag_set(diag, E_VALUE, "there are %d outputs and %d inputs", linear->outputs,
                        linear->inputs);
    return OK;
}

Status show_transfer(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Linear *linear = view->linear;

    TRY(linear_check_pairs(linear, diag));
    TRY(check_entry(linear, selection, diag));
    view_open(out, view);
    for (int o = 0; o < linear->outputs; o++)
        for (int i = 0; i < linear->inputs; i++)
            if ((selection->number_count < 1 || selection->numbers[0] == o + 1) &&
                (selection->number_count < 2 || selection->numbers[1] == i + 1))
                TRY(print_one(view, o, i, out, diag));
    if (view->page.notation == NOTATION_MATLAB && selection->number_count == 0)
        text_add(out, "H = tf(numerator, denominator);\n");
    view_close(out, view);
    return OK;
}
