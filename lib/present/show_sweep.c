/* show_sweep.c: the table of a sweep, and its statistics */
#include "present/show.h"

#include <math.h>

enum { DIGITS = 6 };

static Status need_table(const View *view, Diag *diag)
{
    if (view->sweep != NULL)
        return OK;
    (void)diag_set(diag, E_MISSING, "there is no sweep yet");
    diag_hint(diag, "sweep L=range(0.1, 0.3, 20) keep=[max(h1)] : simulate 5");
    return E_MISSING;
}

/* "max(h1) [deg]"; returns what values in SI are divided by */
static double title(const View *view, const SweepColumn *column, Text *out)
{
    Text unit = {0};
    const double size = column->unit[0] != '\0' ? view_unit(view, column->unit, &unit) : 1;

    text_add(out, column->name);
    if (unit.length > 0)
        text_addf(out, " [%s]", unit.at);
    text_free(&unit);
    return size;
}

static void add_number(Table *table, double value)
{
    if (isfinite(value))
        table_cells(table, "%.*g", DIGITS, value == 0 ? 0.0 : value);
    else
        table_cell(table, "-");
}

static void print_reasons(Text *out, const SweepTable *sweep, int columns)
{
    for (int r = 0; r < sweep->rows; r++) {
        Text lead = {0};

        if (sweep->reasons[r] == NULL)
            continue;
        text_addf(&lead, "run %d: ", r + 1);
        layout_words(out, columns, lead.at, sweep->reasons[r]);
        text_free(&lead);
    }
}

Status show_sweep(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const SweepTable *sweep = view->sweep;
    double *sizes;
    Table table;

    (void)selection;
    TRY(need_table(view, diag));
    sizes = NEW_ARRAY(double, sweep->columns.count);
    table = table_of_columns(sweep->columns.count + 1);
    table_cell(&table, "run");
    for (int c = 0; c < sweep->columns.count; c++) {
        Text text = {0};

        sizes[c] = title(view, &sweep->columns.at[c], &text);
        table_cell(&table, text.at);
        text_free(&text);
    }
    for (int r = 0; r < sweep->rows; r++) {
        table_cells(&table, "%d", r + 1);
        for (int c = 0; c < sweep->columns.count; c++)
            add_number(&table, sweep_table_row(sweep, r)[c] / sizes[c]);
    }
    table_blocks(out, &table, 0, view->page.columns);
    table_free(&table);
    print_reasons(out, sweep, view->page.columns);
    mem_free(sizes);
    return OK;
}

Status show_statistics(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    static const double shares[] = {0.05, 0.5, 0.95};
    const SweepTable *sweep = view->sweep;
    Table table;

    (void)selection;
    TRY(need_table(view, diag));
    table = table_of_columns(9);
    table_cells(&table, "\truns\tmean\tdeviation\tmin\t5 %%\tmedian\t95 %%\tmax");
    for (int c = 0; c < sweep->columns.count; c++) {
        const SweepStatistics s = sweep_statistics(sweep, c);
        double quantiles[COUNT(shares)];
        Text text = {0};
        const double size = title(view, &sweep->columns.at[c], &text);

        sweep_quantiles(sweep, c, shares, COUNT(shares), quantiles);
        table_cells(&table, "%s\t%d", text.at, s.count);
        add_number(&table, s.mean / size);
        add_number(&table, s.deviation / size);
        add_number(&table, s.least / size);
        for (int i = 0; i < COUNT(shares); i++)
            add_number(&table, quantiles[i] / size);
        add_number(&table, s.most / size);
        text_free(&text);
    }
    table_blocks(out, &table, 0, view->page.columns);
    table_free(&table);
    if (sweep->failures > 0)
        text_addf(out, "%d of %d runs failed: 'show sweep' has the reasons\n", sweep->failures,
                  sweep->rows);
    return OK;
}
