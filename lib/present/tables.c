/* tables.c: the data of curves in programming languages
 *
 * Between its points a curve is a cubic, y + c1 d + c2 d^2 + c3 d^3 of the distance d from the
 * point before: in C from x, y and y'' at the points, in Matlab from the coefficients. */
#include "present/tables.h"
#include "present/layout.h"

#include "base/memory.h"
#include "expr/curve.h"

enum { EXACT = 17 };

/* the points, then x, y and y'' of each */
static void print_c(Text *out, Expr symbol)
{
    const Curve *curve = expr_data(symbol);

    text_addf(out, "/* column %s of %s */\nstatic const double %s[] = {%d,\n    ", curve->column,
              curve->file, expr_name(symbol), curve->count);
    layout_numbers(out, curve->data, 3 * curve->count, ",\n    ");
    text_add(out, "};\n");
}

/* the cubic from point i on, by rising powers */
static void cubic(const Curve *curve, int i, double *out)
{
    const double *x = curve->data, *y = x + curve->count, *m = y + curve->count;
    const double h = x[i + 1] - x[i];

    out[0] = y[i];
    out[1] = (y[i + 1] - y[i]) / h - h * (2 * m[i] + m[i + 1]) / 6;
    out[2] = m[i] / 2;
    out[3] = (m[i + 1] - m[i]) / (6 * h);
}

/* ppval() continues the last cubic: outside, the value must be that of the end, a derivative 0 */
static void print_matlab(Text *out, Expr symbol, int order)
{
    const Curve *curve = expr_data(symbol);
    const double first = curve->data[0], last = curve->data[curve->count - 1];

    expr_print(out, symbol, NOTATION_MATLAB);
    text_addf(out, "%.*s = @(v) ", order, "ddd");
    if (order > 0) {
        text_char(out, '(');
        text_number(out, first, EXACT);
        text_add(out, " <= v & v <= ");
        text_number(out, last, EXACT);
        text_add(out, ").*");
    }
    text_add(out, "ppval(mkpp([");
    layout_numbers(out, curve->data, curve->count, ", ...\n    ");
    text_add(out, "], ...\n    [");
    for (int i = 0; i + 1 < curve->count; i++) {
        double c[CURVE_ORDERS];

        cubic(curve, i, c);
        if (i > 0)
            text_add(out, "; ...\n    ");
        for (int k = CURVE_ORDERS - 1; k >= order; k--) {
            double value = c[k];

            for (int d = 0; d < order; d++)
                value *= k - d;
            text_add(out, k < CURVE_ORDERS - 1 ? ", " : "");
            text_number(out, value, EXACT);
        }
    }
    text_add(out, "]), ");
    if (order == 0) {
        text_add(out, "min(max(v, ");
        text_number(out, first, EXACT);
        text_add(out, "), ");
        text_number(out, last, EXACT);
        text_add(out, ")");
    } else {
        text_char(out, 'v');
    }
    text_add(out, ");\n");
}

void tables_print(Text *out, Notation notation, const char *lead, const Expr *roots, int count)
{
    Expr *symbols = NULL;
    const int found = expr_tables(roots, count, &symbols);

    for (int i = 0; i < found; i++) {
        const unsigned orders = expr_table_orders(roots, count, symbols[i]);
        const Curve *curve = expr_data(symbols[i]);

        if (notation == NOTATION_C) {
            text_add(out, lead);
            print_c(out, symbols[i]);
        } else if (notation == NOTATION_MATLAB) {
            text_addf(out, "%s%% column %s of %s\n", lead, curve->column, curve->file);
            for (int order = 0; order < CURVE_ORDERS; order++)
                if ((orders & 1U << order) != 0)
                    print_matlab(out, symbols[i], order);
        }
    }
    mem_free(symbols);
}
