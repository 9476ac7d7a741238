/* show_fit.c: what a fit or an optimisation found */
#include "present/show.h"

#include <math.h>

enum { DIGITS = 6, FEW_DIGITS = 3 };

static void add_number(Table *table, int digits, double value)
{
    if (isfinite(value))
        table_cells(table, "%.*g", digits, value == 0 ? 0.0 : value);
    else
        table_cell(table, "-");
}

/* "k [N/m]"; returns what values in SI are divided by */
static double title(const View *view, const char *name, const char *si, Text *out)
{
    Text unit = {0};
    const double size = si[0] != '\0' ? view_unit(view, si, &unit) : 1;

    text_add(out, name);
    if (unit.length > 0)
        text_addf(out, " [%s]", unit.at);
    text_free(&unit);
    return size;
}

static void print_parameters(const View *view, const FitResult *fit, Text *out)
{
    Table table = table_of_columns(5);

    table_cells(&table, "\tvalue\tstandard error\t95 %%\tinitial");
    for (int i = 0; i < fit->parameters.count; i++) {
        const FitParameter *parameter = &fit->parameters.at[i];
        Text text = {0};
        const double size = title(view, parameter->name, parameter->unit, &text);

        table_cell(&table, text.at);
        add_number(&table, DIGITS, parameter->value / size);
        add_number(&table, FEW_DIGITS, parameter->error / size);
        if (isfinite(parameter->half))
            table_cells(&table, "+-%.*g", FEW_DIGITS, parameter->half / size);
        else
            table_cell(&table, "-");
        add_number(&table, DIGITS, parameter->start / size);
        text_free(&text);
    }
    table_blocks(out, &table, 0, view->page.columns);
    table_free(&table);
}

static void print_correlations(const View *view, const FitResult *fit, Text *out)
{
    const int n = fit->parameters.count;
    Table table;

    if (n < 2)
        return;
    table = table_of_columns(n + 1);
    table_cell(&table, "correlation");
    for (int i = 0; i < n; i++)
        table_cell(&table, fit->parameters.at[i].name);
    for (int i = 0; i < n; i++) {
        table_cell(&table, fit->parameters.at[i].name);
        for (int k = 0; k < n; k++)
            add_number(&table, FEW_DIGITS, fit->correlations[i * n + k]);
    }
    text_char(out, '\n');
    table_blocks(out, &table, 0, view->page.columns);
    table_free(&table);
}

static void print_signals(const View *view, const FitResult *fit, Text *out)
{
    Table table = table_of_columns(4);

    table_cells(&table, "signal\tdata\trms of residuals\tsigma");
    for (int i = 0; i < fit->signals.count; i++) {
        const FitSignal *signal = &fit->signals.at[i];
        Text text = {0};
        const double size = title(view, signal->name, signal->unit, &text);

        table_cell(&table, text.at);
        table_cells(&table, "%d", signal->count);
        add_number(&table, FEW_DIGITS, signal->rms / size);
        add_number(&table, FEW_DIGITS, signal->sigma / size);
        text_free(&text);
    }
    text_char(out, '\n');
    table_blocks(out, &table, 0, view->page.columns);
    table_free(&table);
}

void fit_print(const View *view, const FitResult *fit, Text *out)
{
    Text line = {0};

    print_parameters(view, fit, out);
    print_correlations(view, fit, out);
    print_signals(view, fit, out);
    text_addf(&line, "%s in %d iteration%s, %d runs; loss %s",
              fit->is_stopped     ? "stopped"
              : fit->is_converged ? "converged"
                                  : "not converged",
              fit->iterations, fit->iterations == 1 ? "" : "s", fit->runs, loss_name(fit->loss));
    layout_words(out, view->page.columns, "", line.at);
    text_free(&line);
    for (int i = 0; i < fit->notes.count; i++)
        layout_words(out, view->page.columns, "", fit->notes.at[i]);
}

Status show_fit(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    (void)selection;
    if (view->fit == NULL) {
        (void)diag_set(diag, E_MISSING, "there is no fit yet");
        diag_hint(diag, "fit k d to=table(\"data.csv\", t, \"h\") by=h : simulate 5");
        return E_MISSING;
    }
    fit_print(view, view->fit, out);
    return OK;
}

/* --- an optimisation --- */

static const char *bound_text(const OptimumParameter *parameter)
{
    return parameter->value <= parameter->low    ? "at its lower bound"
           : parameter->value >= parameter->high ? "at its upper bound"
                                                 : "";
}

static void print_optimal(const View *view, const Optimum *optimum, Text *out)
{
    Table table = table_of_columns(4);

    table_cells(&table, "\tvalue\tinitial\t");
    for (int i = 0; i < optimum->parameters.count; i++) {
        const OptimumParameter *parameter = &optimum->parameters.at[i];
        Text text = {0};
        const double size = title(view, parameter->name, parameter->unit, &text);

        table_cell(&table, text.at);
        add_number(&table, DIGITS, parameter->value / size);
        add_number(&table, DIGITS, parameter->start / size);
        table_cell(&table, bound_text(parameter));
        text_free(&text);
    }
    if (optimum->parameters.count > 0) {
        Text text = {0};
        const double size = title(view, optimum->figure, optimum->unit, &text);

        table_cell(&table, text.at);
        add_number(&table, DIGITS, optimum->value / size);
        add_number(&table, DIGITS, optimum->start / size);
        table_cell(&table, optimum->is_maximum ? "maximum" : "minimum");
        text_free(&text);
    }
    table_blocks(out, &table, 0, view->page.columns);
    table_free(&table);
}

/* a side with its unit, as the other may be written in another one */
static void add_side(Table *table, double value, double size, const char *unit)
{
    if (isfinite(value))
        table_cells(table, "%.*g%s%s", DIGITS, value == 0 ? 0.0 : value / size,
                    unit[0] != '\0' ? " " : "", unit);
    else
        table_cell(table, "-");
}

static void print_constraints(const View *view, const Optimum *optimum, Text *out)
{
    Table table;

    if (optimum->constraints.count == 0)
        return;
    table = table_of_columns(4);
    table_cells(&table, "constraint\tleft\tright\t");
    for (int i = 0; i < optimum->constraints.count; i++) {
        const OptimumConstraint *constraint = &optimum->constraints.at[i];
        Text unit = {0};
        const double size =
            constraint->unit[0] != '\0' ? view_unit(view, constraint->unit, &unit) : 1;

        text_add(&unit, "");
        table_cell(&table, constraint->text);
        add_side(&table, constraint->left, size, unit.at);
        add_side(&table, constraint->right, size, unit.at);
        table_cell(&table, constraint->is_active ? "active" : "");
        text_free(&unit);
    }
    text_char(out, '\n');
    table_blocks(out, &table, 0, view->page.columns);
    table_free(&table);
}

void optimum_print(const View *view, const Optimum *optimum, Text *out)
{
    Text line = {0};

    print_optimal(view, optimum, out);
    print_constraints(view, optimum, out);
    text_addf(&line, "%s in %d runs%s",
              optimum->is_stopped     ? "stopped"
              : optimum->is_converged ? "converged"
                                      : "not converged",
              optimum->runs, optimum->is_feasible ? "" : "; not all constraints are met");
    layout_words(out, view->page.columns, "", line.at);
    text_free(&line);
}

Status show_optimum(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    (void)selection;
    if (view->optimum == NULL) {
        (void)diag_set(diag, E_MISSING, "there is no optimum yet");
        diag_hint(diag, "optimise k=[0, 20] minimise=max(h) : simulate 5");
        return E_MISSING;
    }
    optimum_print(view, view->optimum, out);
    return OK;
}
