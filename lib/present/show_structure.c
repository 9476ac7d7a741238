/* show_structure.c: sizes, blocks, and the nonzero patterns of M, the Jacobian and the network
 *
 * Each instance of a subsystem is a block: rows and columns are ordered block by block, those that
 * couple instances last. So M is block diagonal and the Jacobian bordered, as far as the ports'
 * motion is prescribed. */
#include "present/show.h"

#include <string.h>

enum { WIDEST = 60 }; /* columns of a pattern; above, it is one of blocks */

/* those of the mechanics, and those of networks, where there are such */
static void add_sizes(const View *view, Text *out)
{
    const System *system = view->system;
    const bool moves = view_is_mechanical(view);
    const bool flows = system_nx(system) + system_nz(system) > 0;
    const struct {
        bool applies;
        const char *what;
        int count;
    } sizes[] = {{moves, "coordinates", system_n(system)},
                 {moves, "speeds", system_nu(system)},
                 {moves, "constraints", system_m(system)},
                 {flows, "network states", system_nx(system)},
                 {flows, "algebraic unknowns", system_nz(system)}};
    Table table = table_for("lr");

    if (!moves && !flows)
        text_add(out, "no equations: the model has no unknowns\n");
    for (int i = 0; i < COUNT(sizes); i++) {
        if (!sizes[i].applies)
            continue;
        table_cells(&table, "%s\t%d", sizes[i].what, sizes[i].count);
    }
    table_finish(out, &table, 0);
}

/* --- blocks --- */

static int instance_count(const System *system)
{
    int count = 0;

    while (system_instanced(system, count) != NULL)
        count++;
    return count;
}

/* the innermost instance that a name is in; -1: none */
static int instance_of(const System *system, const char *name)
{
    const Instanced *one;
    int found = -1;

    for (int i = 0; (one = system_instanced(system, i)) != NULL; i++) {
        const size_t length = strlen(one->name);

        if (strncmp(name, one->name, length) == 0 && name[length] == '.')
            found = i;
    }
    return found;
}

static int outermost(const System *system, int instance)
{
    while (instance >= 0 && system_instanced(system, instance)->outer >= 0)
        instance = system_instanced(system, instance)->outer;
    return instance;
}

/* one row or column of a matrix */
typedef struct ShowStructureLine {
    const char *name;
    int instance; /* innermost; -1 */
    int at;       /* in the matrix */
} ShowStructureLine;
typedef LIST(ShowStructureLine) Lines;

/* those of the blocks, one after the other, then what joins them */
static void sort_lines(const System *system, Lines *lines)
{
    const int count = instance_count(system);
    Lines sorted = {0};

    for (int block = 0; block <= count; block++)
        for (int i = 0; i < lines->count; i++)
            if (outermost(system, lines->at[i].instance) == (block < count ? block : -1))
                LIST_PUSH(sorted, lines->at[i]);
    LIST_FREE(*lines);
    *lines = sorted;
}

static void speed_lines(const System *system, Lines *out)
{
    for (int j = 0; j < system_nu(system); j++) {
        const char *name = system_u(system, j)->name;

        LIST_PUSH(*out, (ShowStructureLine){name, instance_of(system, name), j});
    }
    sort_lines(system, out);
}

static void row_lines(const System *system, Lines *out)
{
    for (int k = 0; k < system_m(system); k++) {
        const char *name = system_instance_name(system, system_constraint(system, k)->instance);

        LIST_PUSH(*out, (ShowStructureLine){name, instance_of(system, name), k});
    }
    sort_lines(system, out);
}

static void network_lines(const System *system, Lines *out)
{
    const int states = system_nx(system);

    for (int i = 0; i < states + system_nz(system); i++) {
        const Variable *own = i < states ? system_x(system, i) : system_z(system, i - states);

        LIST_PUSH(*out, (ShowStructureLine){own->name, instance_of(system, own->name), i});
    }
    sort_lines(system, out);
}

static int lines_of(const Lines *lines, int instance)
{
    int count = 0;

    for (int i = 0; i < lines->count; i++)
        count += lines->at[i].instance == instance;
    return count;
}

static void add_counts(Table *table, const Lines *speeds, const Lines *rows, const Lines *network,
                       int instance)
{
    table_cells(table, "%d\t%d\t%d", lines_of(speeds, instance), lines_of(rows, instance),
                lines_of(network, instance));
}

/* the instance whose equations were reused for this one, by itself or with the enclosing one;
 * false: none */
static bool taken_from(const System *system, int instance, Text *out)
{
    const Instanced *own = system_instanced(system, instance);
    int around = instance;

    while (around >= 0 && system_instanced(system, around)->first < 0)
        around = system_instanced(system, around)->outer;
    if (around < 0)
        return false;
    text_addf(out, "%s%s", system_instanced(system, system_instanced(system, around)->first)->name,
              own->name + strlen(system_instanced(system, around)->name));
    return true;
}

static void add_blocks(const System *system, const Lines *speeds, const Lines *rows,
                       const Lines *network, Text *out)
{
    Table table = table_for("llrrrl");
    const Instanced *one;

    table_cells(&table, "block\tof\tspeeds\trows\tnetwork\tequations");
    for (int i = 0; (one = system_instanced(system, i)) != NULL; i++) {
        Text first = {0};

        table_cells(&table, "%s\t%s", one->name, one->definition);
        add_counts(&table, speeds, rows, network, i);
        if (one->is_recalled)
            table_cell(&table, "recalled");
        else if (taken_from(system, i, &first))
            table_cells(&table, "those of %s", first.at);
        else
            table_cell(&table, "derived");
        text_free(&first);
    }
    table_cells(&table, "between\t");
    add_counts(&table, speeds, rows, network, -1);
    table_cell(&table, "derived");
    table_finish(out, &table, 0);
}

/* how often each definition was derived, at the first of its instances; never where earlier
 * equations were recalled */
static void add_counters(const System *system, Text *out)
{
    const Instanced *one, *other;

    for (int i = 0; (one = system_instanced(system, i)) != NULL; i++) {
        int instances = 0, derived = 0;
        bool is_later = false;

        for (int k = 0; (other = system_instanced(system, k)) != NULL; k++) {
            Text first = {0};

            if (strcmp(one->definition, other->definition) != 0)
                continue;
            is_later = is_later || k < i;
            instances++;
            derived += !other->is_recalled && !taken_from(system, k, &first);
            text_free(&first);
        }
        if (is_later)
            continue;
        text_addf(out, "%s: ", one->definition);
        if (derived == 0)
            text_add(out, "recalled");
        else if (derived == 1)
            text_add(out, "derived once");
        else
            text_addf(out, "derived %d times", derived);
        text_add(out, ", ");
        layout_count(out, instances, "instance", "instances");
        text_char(out, '\n');
    }
}

/* --- patterns --- */

typedef struct ShowStructurePattern {
    const System *system;
    const Expr *entries;
    Lines rows, columns;
    int stride;
} ShowStructurePattern;

static bool is_filled(const ShowStructurePattern *p, int row, int column)
{
    return !expr_is_zero(p->entries[p->rows.at[row].at * p->stride + p->columns.at[column].at]);
}

static bool begins_block(const ShowStructurePattern *p, const Lines *lines, int i)
{
    return i > 0 && outermost(p->system, lines->at[i].instance) !=
                        outermost(p->system, lines->at[i - 1].instance);
}

/* columns `from` up to `to` of a pattern, the names of its rows `width` wide */
typedef struct Stripe {
    int from, to, width;
} Stripe;

static void add_row(const ShowStructurePattern *p, int row, Stripe stripe, Text *out)
{
    text_addf(out, "  %-*s", stripe.width, p->rows.at[row].name);
    for (int c = stripe.from; c < stripe.to; c++)
        text_addf(out, "%s %c", c > stripe.from && begins_block(p, &p->columns, c) ? " |" : "",
                  is_filled(p, row, c) ? 'x' : '.');
    text_char(out, '\n');
}

static void add_border(const ShowStructurePattern *p, Stripe stripe, Text *out)
{
    text_addf(out, "  %*s", stripe.width, "");
    for (int c = stripe.from; c < stripe.to; c++)
        text_add(out, c > stripe.from && begins_block(p, &p->columns, c) ? " + -" : " -");
    text_char(out, '\n');
}

/* the end of the columns from `from` on that the page has room for, at least one; page 0: all */
static int stripe_end(const ShowStructurePattern *p, int from, int width, int page)
{
    int to = from + 1, room = page - width - 4;

    while (to < p->columns.count &&
           (page == 0 || (room -= begins_block(p, &p->columns, to) ? 4 : 2) >= 0))
        to++;
    return to;
}

/* As many columns side by side as the page has room for, the others below, with their own
 * numbers. */
static void add_stripes(const ShowStructurePattern *p, int width, int page, Text *out)
{
    Stripe stripe = {.width = width};

    for (; stripe.from < p->columns.count; stripe.from = stripe.to) {
        stripe.to = stripe_end(p, stripe.from, width, page);
        if (stripe.to - stripe.from < p->columns.count)
            text_addf(out, stripe.to > stripe.from + 1 ? " columns %d to %d\n" : " column %d\n",
                      stripe.from + 1, stripe.to);
        for (int r = 0; r < p->rows.count; r++) {
            if (begins_block(p, &p->rows, r))
                add_border(p, stripe, out);
            add_row(p, r, stripe, out);
        }
    }
}

static const char *block_title(const ShowStructurePattern *p, const ShowStructureLine *line)
{
    const int instance = outermost(p->system, line->instance);

    return instance < 0 ? "between" : system_instanced(p->system, instance)->name;
}

/* one line a block: the blocks in which it isn't zero */
static void add_block_rows(const ShowStructurePattern *p, Text *out)
{
    for (int r = 0; r < p->rows.count;) {
        Text meets = {0};
        int end = r + 1;

        while (end < p->rows.count && !begins_block(p, &p->rows, end))
            end++;
        for (int c = 0; c < p->columns.count;) {
            bool met = false;
            const char *title = block_title(p, &p->columns.at[c]);

            do
                for (int k = r; k < end; k++)
                    met = met || is_filled(p, k, c);
            while (++c < p->columns.count && !begins_block(p, &p->columns, c));
            if (met)
                text_addf(&meets, " %s", title);
        }
        text_addf(out, "  %s:%s\n", block_title(p, &p->rows.at[r]),
                  meets.at != NULL ? meets.at : "");
        text_free(&meets);
        r = end;
    }
}

static void add_pattern(const ShowStructurePattern *p, const char *title, int page, Text *out)
{
    int filled = 0, width = 0;

    for (int r = 0; r < p->rows.count; r++) {
        const int length = (int)strlen(p->rows.at[r].name);

        width = length > width ? length : width;
        for (int c = 0; c < p->columns.count; c++)
            filled += is_filled(p, r, c);
    }
    text_addf(out, "%s, %d x %d, %d not zero\n", title, p->rows.count, p->columns.count, filled);
    if (p->columns.count > WIDEST && instance_count(p->system) > 0)
        add_block_rows(p, out);
    if (p->columns.count <= WIDEST)
        add_stripes(p, width, page, out);
}

Status show_structure(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    System *system = view->system;
    const EquationForm *reading = system_run(system);
    const int page = view->page.columns;
    Lines speeds = {0}, rows = {0}, network = {0};
    Expr *dense = NULL;
    Status status = OK;

    (void)selection;
    CHECK(system_form_mass(system, diag));
    speed_lines(system, &speeds);
    row_lines(system, &rows);
    network_lines(system, &network);
    add_sizes(view, out);
    if (instance_count(system) > 0) {
        add_blocks(system, &speeds, &rows, &network, out);
        add_counters(system, out);
    }
    if (speeds.count > 0)
        add_pattern(&(ShowStructurePattern){system, reading->mass, speeds, speeds, speeds.count},
                    "mass matrix", page, out);
    if (rows.count > 0)
        add_pattern(&(ShowStructurePattern){system, reading->phi_u, rows, speeds, speeds.count},
                    "jacobian", page, out);
    dense = system_network_matrix(system);
    if (network.count > 0)
        add_pattern(&(ShowStructurePattern){system, dense, network, network, network.count},
                    "network", page, out);
done:
    LIST_FREE(speeds);
    LIST_FREE(rows);
    LIST_FREE(network);
    mem_free(dense);
    return status;
}
