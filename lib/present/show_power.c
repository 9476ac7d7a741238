/* show_power.c: the power of each edge at an instant, and Tellegen's theorem
 *
 * The through variables of a domain obey its cutset equations, and its across variables its circuit
 * equations, so that the sum of their products over all edges is 0. In mechanics this holds for
 * translation, rotation and the shapes of flexible parts, each by itself (theory 1). */
#include "present/show.h"

#include "component/component.h"
#include "present/present_limits.h"

#include <math.h>
#include <string.h>

enum { POWER_COLUMNS = 3 };

/* what is shown of a domain: a row an edge */
typedef struct PowerTable {
    Domain domain;
    int columns; /* of values; their names: */
    const char *heads[POWER_COLUMNS];
    LIST(int) edges;
    LIST(Expr) items;
    double *values; /* edges x columns */
} PowerTable;

static void power_table_free(PowerTable *table)
{
    LIST_FREE(table->edges);
    LIST_FREE(table->items);
    mem_free(table->values);
}

static void add_item(const View *view, PowerTable *table, const char *edge, const char *member)
{
    Text name = {0};

    text_addf(&name, "%s.%s", edge, member);
    LIST_PUSH(table->items, expr_symbol(model_arena(view->model), name.at, SYMBOL_VARIABLE));
    text_free(&name);
}

static bool is_flexible(const Model *model)
{
    for (int i = 0; i < model_count(model); i++)
        if (model_instance(model, i)->row->deforming != NULL)
            return true;
    return false;
}

static PowerTable power_table_of(const View *view, Domain domain)
{
    static const char *const mechanical[] = {"translation", "rotation", "deformation"};
    const Graph *graph = model_graph(view->model);
    const bool is_mechanical = domain == DOMAIN_MECHANICAL;
    PowerTable table = {.domain = domain, .columns = 2};

    if (is_mechanical && is_flexible(view->model))
        table.columns = POWER_COLUMNS;
    for (int c = 0; c < table.columns; c++)
        table.heads[c] = is_mechanical ? mechanical[c]
                         : c == 0      ? domain_across(domain)
                                       : domain_through(domain);
    for (int e = 0; e < graph_edge_count(graph); e++) {
        const Edge *edge = graph_edge(graph, e);

        if (edge->domain != domain)
            continue;
        LIST_PUSH(table.edges, e);
        for (int c = 0; c < table.columns; c++) {
            Text member = {0};

            text_addf(&member, "%s%s", is_mechanical ? "power." : "", table.heads[c]);
            add_item(view, &table, edge->name, member.at);
            text_free(&member);
        }
    }
    return table;
}

static Status read_values(const View *view, PowerTable *table, Diag *diag)
{
    table->values = NEW_ARRAY(double, table->items.count);
    return view->instant->read(view->instant->context, table->items.at, table->items.count,
                               table->values, diag);
}

/* power of an edge in a column of its sums: mechanics has one for each graph */
static double power_at(const PowerTable *table, int row, int column)
{
    const double *values = table->values + (ptrdiff_t)row * table->columns;

    return table->domain == DOMAIN_MECHANICAL ? values[column] : values[0] * values[1];
}

/* the sum of a column, and in *size that of the magnitudes of all its domain */
static double sum_of(const PowerTable *table, int column, double *size)
{
    double sum = 0;

    *size = 0;
    for (int i = 0; i < table->edges.count; i++) {
        sum += power_at(table, i, column);
        for (int c = 0; c < table->columns; c++)
            *size += fabs(power_at(table, i, c));
    }
    return sum;
}

static void add_number(Table *cells, double value, double size)
{
    table_cells(cells, "%.6g", fabs(value) <= POWER_NOISE * size ? 0.0 : value);
}

static void print_mechanical(const PowerTable *table, const Graph *graph, Text *out)
{
    Table cells = table_for(table->columns == POWER_COLUMNS ? "lrrrr" : "lrrr");
    double size, all = 0;

    table_cell(&cells, "mechanical [W]");
    for (int c = 0; c < table->columns; c++)
        table_cell(&cells, table->heads[c]);
    table_cell(&cells, "power");
    (void)sum_of(table, 0, &size);
    for (int i = 0; i < table->edges.count; i++) {
        double power = 0;

        table_cell(&cells, graph_edge(graph, table->edges.at[i])->name);
        for (int c = 0; c < table->columns; c++) {
            add_number(&cells, power_at(table, i, c), size);
            power += power_at(table, i, c);
        }
        add_number(&cells, power, size);
    }
    table_cell(&cells, "sum");
    for (int c = 0; c < table->columns; c++) {
        const double sum = sum_of(table, c, &size);

        add_number(&cells, sum, size * POWER_BALANCE / POWER_NOISE);
        all += sum;
    }
    add_number(&cells, all, size * POWER_BALANCE / POWER_NOISE);
    table_finish(out, &cells, 0);
}

static void print_scalar(const PowerTable *table, const Graph *graph, Text *out)
{
    Table cells = table_for("lrrr");
    double size, sum = sum_of(table, 0, &size);

    table_cells(&cells, "%s\t%s\t%s\t%s", domain_name(table->domain), table->heads[0],
                table->heads[1], table->domain == DOMAIN_THERMAL ? "product" : "power [W]");
    for (int i = 0; i < table->edges.count; i++) {
        const double *values = table->values + (ptrdiff_t)i * 2;

        table_cells(&cells, "%s\t%.6g\t%.6g", graph_edge(graph, table->edges.at[i])->name,
                    values[0] + 0.0, values[1] + 0.0);
        add_number(&cells, power_at(table, i, 0), size);
    }
    table_cells(&cells, "sum\t\t");
    add_number(&cells, sum, size * POWER_BALANCE / POWER_NOISE);
    table_finish(out, &cells, 0);
}

Status show_power(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Graph *graph = model_graph(view->model);
    bool any = false;

    (void)selection;
    text_addf(out, "at t = %.6g s\n", view->instant->time);
    for (Domain domain = 0; domain < DOMAIN_COUNT; domain++) {
        PowerTable table = power_table_of(view, domain);
        Status status = OK;

        if (table.edges.count > 0 && domain != DOMAIN_LOAD) { /* an unknown without a flow */
            status = read_values(view, &table, diag);
            if (status == OK && domain == DOMAIN_MECHANICAL)
                print_mechanical(&table, graph, out);
            else if (status == OK)
                print_scalar(&table, graph, out);
            any = true;
        }
        power_table_free(&table);
        TRY(status);
    }
    if (!any)
        text_add(out, "no edges\n");
    return OK;
}
