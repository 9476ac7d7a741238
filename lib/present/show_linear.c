/* show_linear.c: linear equations and modes as text, and in other notations */
#include "present/show.h"

#include <math.h>
#include <string.h>

enum { MOST_PARTS = 6, DIGITS = 6 }; /* of a mode, in its line; of a number */

#define LEAST_PART 1e-3 /* of the largest */

static const char letters[] = "ABCD";

LinearMatrix linear_matrix(const Linear *linear, char letter)
{
    LinearMatrix m = {letter,         linear->a,           linear->states,
                      linear->states, linear->state_names, linear->state_names};

    if (letter == 'B' || letter == 'D') {
        m.columns = linear->inputs;
        m.column_names = linear->input_names;
    }
    if (letter == 'C' || letter == 'D') {
        m.rows = linear->outputs;
        m.row_names = linear->output_names;
    }
    m.at = letter == 'A'   ? linear->a
           : letter == 'B' ? linear->b
           : letter == 'C' ? linear->c
                           : linear->d;
    return m;
}

/* --- one matrix --- */

static void print_rounded(Text *out, const LinearMatrix *m, int columns)
{
    Table table = table_of_columns(m->columns + 1);

    table_cells(&table, "%c", m->letter);
    for (int j = 0; j < m->columns; j++)
        table_cell(&table, m->column_names[j]);
    for (int i = 0; i < m->rows; i++) {
        table_cell(&table, m->row_names[i]);
        for (int j = 0; j < m->columns; j++)
            table_cells(&table, "%.6g", m->at[i * m->columns + j]);
    }
    table_blocks(out, &table, 0, columns);
    table_free(&table);
}

void linear_latex(Text *out, double value, int digits)
{
    Text number = {0};

    text_number(&number, value, digits);
    latex_digits(out, number.at);
    text_free(&number);
}

/* all digits where commas are `between` entries, else LaTeX */
static void add_entries(Text *out, const LinearMatrix *m, const char *between, const char *rows)
{
    for (int i = 0; i < m->rows * m->columns; i++) {
        text_add(out, i == 0 ? "" : i % m->columns == 0 ? rows : between);
        if (between[0] == ',')
            text_number(out, m->at[i], 17);
        else
            linear_latex(out, m->at[i], DIGITS);
    }
}

static void print_matrix(Text *out, const View *view, const LinearMatrix *m)
{
    if (view_kind(view) == NOTATION_TYPESET) {
        text_addf(out, "%c &= \\begin{bmatrix} ", m->letter);
        add_entries(out, m, " & ", " \\\\ ");
        text_add(out, " \\end{bmatrix} \\\\\n");
    } else if (view->page.notation == NOTATION_C) {
        text_addf(out, "static const double %c[%d][%d] = {{", m->letter, m->rows, m->columns);
        add_entries(out, m, ", ", "}, {");
        text_add(out, "}};\n");
    } else if (view_kind(view) == NOTATION_SOURCE) {
        text_addf(out, "%c = [", m->letter);
        add_entries(out, m, ", ", "; ");
        text_add(out, "];\n");
    } else {
        print_rounded(out, m, view->page.columns);
    }
}

static void add_names(Table *table, const char *title, char *const *names, int count)
{
    Text text = {0};

    if (count == 0)
        return;
    for (int i = 0; i < count; i++)
        layout_item(&text, names[i]);
    table_cells(table, "%s\t%s", title, text.at);
    text_free(&text);
}

/* why the equations have no state, of the parts that there are */
static void print_why_empty(const Model *model, Text *out)
{
    Text drivers = {0};
    bool has_body = false, has_joint = false, has_network = false;

    for (int i = 0; i < model_count(model); i++) {
        const Instance *part = model_instance(model, i);

        has_body = has_body || part->row->family == FAMILY_BODY;
        has_joint = has_joint || (part->row->family == FAMILY_JOINT && !part->is_virtual &&
                                  part->coord_count > 0);
        has_network = has_network || part->scalar_count > 0;
        if (part->row->family == FAMILY_DRIVER)
            layout_item(&drivers, part->name);
    }
    if (drivers.length > 0)
        text_addf(out, "drivers prescribe all motion (%s)", drivers.at);
    else if (has_body)
        text_add(out, has_joint ? "the joints together leave no motion free"
                                : "no joint leaves a motion free");
    if (has_network)
        text_addf(out, "%snothing in the network stores energy", has_body ? ", and " : "");
    if (!has_body && !has_network)
        text_add(out, "there are no bodies and no network");
    text_free(&drivers);
}

void linear_print(const View *view, const Linear *linear, Text *out)
{
    const NotationKind kind = view_kind(view);
    Table table = table_for("ll");

    if (kind != NOTATION_TYPESET && kind != NOTATION_SOURCE) {
        table_cells(&table, "about\tt = %.6g s", linear->at);
        add_names(&table, "states", linear->state_names, linear->states);
        if (linear->states == 0) {
            Text why = {0};

            print_why_empty(view->model, &why);
            table_cells(&table, "states\tnone: %s", why.at);
            text_free(&why);
        }
        if (linear->is_shifted)
            table_cells(&table, "\tless what jumps with the inputs");
        add_names(&table, "inputs", linear->input_names, linear->inputs);
        add_names(&table, "outputs", linear->output_names, linear->outputs);
        table_wrap(out, &table, 0, view->page.columns);
    }
    view_open(out, view);
    for (int k = 0; letters[k] != '\0'; k++) {
        const LinearMatrix m = linear_matrix(linear, letters[k]);

        if (m.rows > 0 && m.columns > 0)
            print_matrix(out, view, &m);
    }
    view_close(out, view);
    table_free(&table);
}

Status show_linear(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    (void)selection;
    if (view->linear == NULL) {
        diag_set(diag, E_MISSING, "nothing has been linearized yet");
        diag_hint(diag, "linearize inputs=[V1] outputs=[h8]");
        return E_MISSING;
    }
    linear_print(view, view->linear, out);
    return OK;
}

/* --- modes --- */

/* the largest part that isn't listed yet, the first of equals; -1: the rest hardly move */
static int next_part(const Mode *mode, int parts, const bool *is_reported)
{
    int best = -1;

    for (int p = 0; p < parts; p++)
        if (!is_reported[p] && mode->amplitude[p] >= LEAST_PART &&
            (best < 0 || mode->amplitude[p] > (1 + 1e-6) * mode->amplitude[best]))
            best = p;
    return best;
}

/* "h2 1, h1 -0.7": what moves, against it, or late by an angle */
static char *shape_text(const Modes *modes, const Mode *mode)
{
    bool *is_reported = NEW_ARRAY(bool, modes->parts);
    Text text = {0};

    for (int k = 0; k < MOST_PARTS; k++) {
        int p = next_part(mode, modes->parts, is_reported);
        double phase;

        if (p < 0)
            break;
        is_reported[p] = true;
        phase = mode->phase[p] * 180 / M_PI;
        text_addf(&text, "%s%s %s%.3g", k > 0 ? ", " : "", modes->part_names[p],
                  fabs(phase) > 179.95 ? "-" : "", mode->amplitude[p]);
        if (fabs(phase) > 0.05 && fabs(phase) <= 179.95)
            text_addf(&text, " (%.1f deg)", phase);
    }
    mem_free(is_reported);
    return text_done(&text);
}

void linear_known(Text *out, double value, double error)
{
    const double digits = error > 0 && value != 0 ? floor(log10(fabs(value) / error)) : DIGITS;

    text_number(out, value, digits < 1 ? 1 : digits < DIGITS ? (int)digits : DIGITS);
}

static void add_known(Table *table, double value, double error)
{
    Text text = {0};

    linear_known(&text, value, error);
    table_cell(table, text.at);
    text_free(&text);
}

/* "-1 +- 3i", with as many digits as are known; "0? +- 3i" where growing or fading isn't */
static void add_figures(Table *table, const Mode *mode, int number)
{
    const double error = mode->error;
    Text text = {0};

    table_cells(table, "%d", number);
    linear_known(&text, mode->real, error);
    text_add(&text, mode->is_doubtful ? "?" : "");
    if (mode->imaginary > 0) {
        text_add(&text, " +- ");
        linear_known(&text, mode->imaginary, error);
        text_char(&text, 'i');
    }
    table_cell(table, text.at);
    add_known(table, mode->omega, error);
    add_known(table, mode->omega / (2 * M_PI), error / (2 * M_PI));
    add_known(table, mode->damping, mode->omega > 0 ? error / mode->omega : 0);
    text_free(&text);
}

/* what the marks mean, with how little is known */
static void add_doubts(const Modes *modes, Text *out)
{
    double largest = 0;

    for (int i = 0; i < modes->count; i++)
        if (modes->at[i].is_doubtful)
            largest = fmax(largest, modes->at[i].error);
    if (largest > 0)
        text_addf(out, "? 0 within %.2g 1/s: rounding leaves open whether it grows or fades\n",
                  largest);
}

/* Rows of figures with the moving parts: in the same line if the page has room for all parts, else
 * on lines of their own below. */
static void print_shapes(const Table *figures, char *const *shapes, int columns, Text *out)
{
    const int rows = figures->cells.count / figures->columns;
    const char *line;
    Text lines = {0};
    int widest = 0;

    table_print(&lines, figures, 0);
    line = lines.at;
    for (int i = 0; i < rows; i++) {
        const int width = layout_widest_item(shapes[i]);

        widest = width > widest ? width : widest;
    }
    for (int i = 0; i < rows; i++) {
        const size_t length = strcspn(line, "\n");
        Text lead = {0};

        if (columns == 0 || table_width(figures) + 2 + widest <= columns) {
            text_add_n(&lead, line, length);
            text_add(&lead, "  ");
        } else {
            text_add_n(out, line, length + 1);
            text_add(&lead, "      ");
        }
        layout_items(out, columns, lead.at, shapes[i]);
        text_free(&lead);
        line += length + 1;
    }
    text_free(&lines);
}

void modes_print(const View *view, const Modes *modes, Text *out)
{
    Table figures = table_for("rrrrr");
    char **shapes;

    if (modes->count == 0) {
        Text why = {0};

        print_why_empty(view->model, &why);
        layout_words(out, view->page.columns, "no modes: ", why.at);
        text_free(&why);
        return;
    }
    shapes = NEW_ARRAY(char *, modes->count + 1);
    table_cells(&figures, "mode\teigenvalue [1/s]\tomega [rad/s]\tf [Hz]\tdamping");
    shapes[0] = mem_text("what moves", strlen("what moves"));
    for (int i = 0; i < modes->count; i++) {
        add_figures(&figures, &modes->at[i], i + 1);
        shapes[i + 1] = shape_text(modes, &modes->at[i]);
    }
    print_shapes(&figures, shapes, view->page.columns, out);
    add_doubts(modes, out);
    for (int i = 0; i <= modes->count; i++)
        mem_free(shapes[i]);
    mem_free(shapes);
    table_free(&figures);
}
