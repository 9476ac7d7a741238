/* session_sweep_entry.c: figures of the last sweep: sweep.value(3, max(h1)), sweep.mean(max(h1)) */
#include "session/session_sweep.h"

#include <math.h>

typedef struct SweepEntry {
    const char *name;
    const char *usage;
    int column; /* place of the argument that names a column */
    int count;  /* of arguments */
    double (*value)(const SweepTable *table, int column, double number);
} SweepEntry;

static double value_of(const SweepTable *table, int column, double number)
{
    return sweep_table_row(table, (int)number - 1)[column];
}

static double mean_of(const SweepTable *table, int column, double number)
{
    (void)number;
    return sweep_statistics(table, column).mean;
}

static double deviation_of(const SweepTable *table, int column, double number)
{
    (void)number;
    return sweep_statistics(table, column).deviation;
}

static double least_of(const SweepTable *table, int column, double number)
{
    (void)number;
    return sweep_statistics(table, column).least;
}

static double most_of(const SweepTable *table, int column, double number)
{
    (void)number;
    return sweep_statistics(table, column).most;
}

static double quantile_of(const SweepTable *table, int column, double number)
{
    double out;

    sweep_quantiles(table, column, &number, 1, &out);
    return out;
}

/* clang-format off */
static const SweepEntry entries[] = {
    {"sweep.value",     "sweep.value(RUN, FIGURE)",      1, 2, value_of},
    {"sweep.mean",      "sweep.mean(FIGURE)",            0, 1, mean_of},
    {"sweep.deviation", "sweep.deviation(FIGURE)",       0, 1, deviation_of},
    {"sweep.min",       "sweep.min(FIGURE)",             0, 1, least_of},
    {"sweep.max",       "sweep.max(FIGURE)",             0, 1, most_of},
    {"sweep.quantile",  "sweep.quantile(FIGURE, SHARE)", 0, 2, quantile_of},
};
/* clang-format on */

static const SweepEntry *find_entry(const char *name)
{
    for (int i = 0; i < COUNT(entries); i++)
        if (strcmp(entries[i].name, name) == 0)
            return &entries[i];
    return NULL;
}

bool sweep_entry_is_called(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_CALL && find_entry(syntax->text) != NULL;
}

static Status need_table(const ct_session *session, Diag *diag)
{
    if (session->sweep != NULL)
        return OK;
    (void)diag_set(diag, E_MISSING, "there is no sweep yet");
    diag_hint(diag, "sweep L=range(0.1, 0.3, 20) keep=[max(h1)] : simulate 5");
    return E_MISSING;
}

/* a column as it is written in the statement of the sweep; -1: there is none */
static int column_of(const SweepTable *table, const Syntax *syntax)
{
    Text text = {0};
    int column;

    syntax_print(&text, syntax);
    column = sweep_table_find(table, text.at);
    text_free(&text);
    return column;
}

static Status read_column(const SweepTable *table, const Syntax *syntax, int *out, Diag *diag)
{
    Text list = {0};

    *out = column_of(table, syntax);
    if (*out >= 0)
        return OK;
    for (int i = 0; i < table->columns.count; i++)
        text_addf(&list, "%s%s", i > 0 ? ", " : "", table->columns.at[i].name);
    (void)diag_at(diag, E_NAME, syntax->place, "the sweep has not kept this");
    diag_hint(diag, "it has: %.300s", list.at);
    text_free(&list);
    return E_NAME;
}

static Status check_number(const SweepEntry *entry, const SweepTable *table, const Syntax *syntax,
                           double number, Diag *diag)
{
    if (entry->value == value_of &&
        !(number >= 1 && number <= table->rows && number == floor(number)))
        return diag_at(diag, E_VALUE, syntax->place, "there are %d runs, counted from 1",
                       table->rows);
    if (entry->value == quantile_of && !(number >= 0 && number <= 1))
        return diag_at(diag, E_VALUE, syntax->place, "a share is between 0 and 1, not %g", number);
    return OK;
}

const Syntax *sweep_entry_number(const Syntax *call)
{
    const SweepEntry *entry = find_entry(call->text);

    return entry->count > 1 && call->count == entry->count ? call->args[1 - entry->column] : NULL;
}

Status sweep_entry_value(const ct_session *session, const Syntax *call, double number, double *out,
                         Diag *diag)
{
    const SweepEntry *entry = find_entry(call->text);
    int column;

    TRY(need_table(session, diag));
    if (call->count != entry->count) {
        (void)diag_at(diag, E_VALUE, call->place, "%s takes %d argument%s, not %d", call->text,
                      entry->count, entry->count == 1 ? "" : "s", call->count);
        diag_hint(diag, "%s", entry->usage);
        return E_VALUE;
    }
    TRY(read_column(session->sweep, call->args[entry->column], &column, diag));
    if (entry->count > 1)
        TRY(check_number(entry, session->sweep, sweep_entry_number(call), number, diag));
    *out = entry->value(session->sweep, column, number);
    return OK;
}

Status sweep_size(ct_session *session, const char *path, double *out, Diag *diag)
{
    TRY(need_table(session, diag));
    if (strcmp(path, "sweep.runs") == 0)
        *out = session->sweep->rows;
    else if (strcmp(path, "sweep.failed") == 0)
        *out = session->sweep->failures;
    else {
        (void)diag_set(diag, E_NAME, "there is no '%s'", path);
        diag_hint(diag, "sweep.runs and sweep.failed count; sweep.value(RUN, FIGURE) is a value");
        return E_NAME;
    }
    return OK;
}

bool sweep_entry_dimension(const ct_session *session, const Syntax *call, Dimension *out)
{
    const SweepEntry *entry = find_entry(call->text);
    const SweepTable *table = session->sweep;
    const char *text;
    size_t fault;
    Unit unit;
    int column;

    if (entry == NULL || table == NULL || call->count != entry->count)
        return false;
    column = column_of(table, call->args[entry->column]);
    text = column >= 0 ? table->columns.at[column].unit : "";
    if (text[0] == '\0' || !unit_parse(text, strlen(text), &unit, &fault))
        return false;
    *out = unit.dimension;
    return true;
}
