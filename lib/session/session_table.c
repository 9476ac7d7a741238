/* session_table.c: values, tables and exports for programs */
#include "session/session_impl.h"

#include "export/archive.h"
#include "export/write.h"
#include "present/show.h"
#include "session/session_code.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- one value --- */

/* what bare names mean: with `at` the last run, and only without one the start */
static Status source_at(ct_session *session, const double *at, Run **out, Diag *diag)
{
    if (at != NULL && session->runs.count > 0) {
        *out = session->runs.at + session->runs.count - 1;
        return OK;
    }
    return session_source(session, out, diag);
}

Status session_value_at(ct_session *session, const Syntax *syntax, const double *at, double *out,
                        Diag *diag)
{
    Formula formula = {0};
    Run *source = NULL;
    Status status;

    CHECK(formula_new(session, syntax, &formula, diag));
    if (formula_needs_run(&formula))
        CHECK(source_at(session, at, &source, diag));
    CHECK(formula_value(session, &formula, source, at, out, diag));
done:
    formula_free(&formula);
    if (status != OK && diag->place.line == 0)
        diag->place = syntax->place;
    return status;
}

/* of a value of that dimension work, where a torque has it too */
static bool is_energy(const Model *model, const Syntax *syntax)
{
    const char *name = strstr(syntax->text, "energy.");

    if (syntax->kind == SYNTAX_VARIABLE)
        return (name != NULL && (name == syntax->text || name[-1] == '.')) ||
               model_is_integral(model, syntax->text);
    for (int i = 0; i < syntax->count; i++)
        if (is_energy(model, syntax->args[i]))
            return true;
    return false;
}

double session_shown_unit(const ct_session *session, const Syntax *syntax, const char *units,
                          Text *out)
{
    static const Dimension none, work = {{2, 1, -2, 0, 0, 0}};
    Dimension dimension = none;

    if (!model_dimension(session->model, syntax, &dimension) ||
        memcmp(&dimension, &none, sizeof none) == 0)
        return 1;
    dimension = dimension_without_angle(dimension);
    if (memcmp(&dimension, &work, sizeof work) == 0 && is_energy(session->model, syntax))
        return energy_print_in(out, units);
    return dimension_print_in(out, dimension, units);
}

char *ct_unit_in(const ct_session *session, const ct_expression *expression, const char *units,
                 double *size)
{
    SESSION_CALL(session, NULL);

    Text unit = {0};

    *size = session_shown_unit(session, syntax_of(expression), units, &unit);
    return unit.length > 0 ? text_done(&unit) : NULL;
}

char *ct_unit(const ct_session *session, const ct_expression *expression)
{
    double size;

    return ct_unit_in(session, expression, "", &size);
}

ct_status ct_check_units(const char *units, ct_error *error)
{
    Diag diag = {0};
    const Status status = unit_list_check(units, &diag);

    return session_report(status, &diag, error);
}

ct_status ct_duration(ct_session *session, const ct_expression *expression, const char *name,
                      double *value, ct_error *error)
{
    SESSION_WORK(session, error);

    Status status;
    Diag diag = {0};

    session_begin(session);
    CHECK(session_value_at(session, syntax_of(expression), NULL, value, &diag));
    CHECK(model_check_unit(session->model, syntax_of(expression), "s", name, &diag));
done:
    return session_report(status, &diag, error);
}

ct_status ct_round(ct_session *session, const ct_expression *expression, const double *at,
                   double *value, ct_error *error)
{
    SESSION_WORK(session, error);

    Formula formula = {0};
    Run *source = NULL;
    Status status;
    Diag diag = {0};

    if (!formula_may_be_rounding(syntax_of(expression), *value))
        return CT_OK;
    /* remarks of the call that found the value are preserved */
    CHECK(formula_new(session, syntax_of(expression), &formula, &diag));
    if (formula_needs_run(&formula))
        CHECK(source_at(session, at, &source, &diag));
    CHECK(formula_round(session, &formula, source, at, value, &diag));
done:
    formula_free(&formula);
    return session_report(status, &diag, error);
}

ct_status ct_value(ct_session *session, const ct_expression *expression, const ct_expression *at,
                   double *value, ct_error *error)
{
    SESSION_WORK(session, error);

    double instant;
    Status status;
    Diag diag = {0};

    session_begin(session);
    if (at != NULL)
        CHECK(session_instant(session, syntax_of(at), &instant, &diag));
    CHECK(session_value_at(session, syntax_of(expression), at != NULL ? &instant : NULL, value,
                           &diag));
done:
    return session_report(status, &diag, error);
}

/* --- tables --- */

typedef struct TableSheet {
    double *values;
    int rows, columns;
    bool is_spectral;   /* over frequency, not time */
    LIST(char *) names; /* ended by NULL once it is done */
    LIST(char *) units; /* of those that are exported */
} TableSheet;

static void sheet_free(TableSheet *sheet)
{
    mem_free(sheet->values);
    for (int i = 0; i < sheet->names.count; i++)
        mem_free(sheet->names.at[i]);
    for (int i = 0; i < sheet->units.count; i++)
        mem_free(sheet->units.at[i]);
    LIST_FREE(sheet->units);
    LIST_FREE(sheet->names);
}

/* the item as written, followed by its display unit in brackets */
static char *column_name(const Syntax *item)
{
    Syntax bare = *item;
    Text name = {0};
    char *written;

    if (item->kind != SYNTAX_NUMBER && item->kind != SYNTAX_VECTOR)
        bare.has_unit = false;
    written = view_name(&bare);
    text_add(&name, written);
    mem_free(written);
    if (item->has_unit && !bare.has_unit)
        text_addf(&name, item->unit_text[0] == '[' ? " %s" : " [%s]", item->unit_text);
    return text_done(&name);
}

static Status read_items(ct_session *session, const Syntax *const *items, int count,
                         Formula *formulas, TableSheet *sheet, Diag *diag)
{
    Status status = OK;

    for (int i = 0; i < count; i++) {
        status = sheet->is_spectral ? spectrum_formula(session, items[i], &formulas[i], diag)
                                    : formula_new(session, items[i], &formulas[i], diag);
        if (status != OK && diag->place.line == 0)
            diag->place = items[i]->place;
        if (status != OK)
            return status;
        LIST_PUSH(sheet->names, column_name(items[i]));
    }
    return status;
}

/* what the source's state is made of */
static int state_count(const Run *source)
{
    const System *system = result_system(source->result);

    return system_n(system) + system_nu(system) + system_nx(system);
}

/* all coordinates, speeds and network states of the source */
static void all_items(const Run *source, Formula *formulas, TableSheet *sheet)
{
    const System *system = result_system(source->result);
    const int n = system_n(system), moving = n + system_nu(system), count = state_count(source);

    for (int i = 0; i < count; i++) {
        const Variable *v = i < n        ? system_q(system, i)
                            : i < moving ? system_u(system, i - n)
                                         : system_x(system, i - moving);
        const Leaf leaf = {
            .kind = LEAF_VARIABLE, .expr = v->symbol, .run = -1, .symbol = v->symbol};

        formulas[i] = (Formula){.scale = 1, .whole = v->symbol};
        LIST_PUSH(formulas[i].leaves, leaf);
        LIST_PUSH(sheet->names, mem_text(v->name, strlen(v->name)));
    }
}

static const double MOST_VALUES = 2e7; /* of a table: far more than is read, far less than memory */

static double last_time(const Run *run)
{
    return result_times(run->result)[result_rows(run->result) - 1];
}

/* the times of a grid of its own: from the run's start in even steps, its end included */
static double *even_times(const Run *grid, double every, int *rows)
{
    const double *times = result_times(grid->result);
    const double first = times[0];
    const int steps = (int)((last_time(grid) - first) / every + 1e-9);
    double *out = NEW_ARRAY(double, steps + 1);

    for (int i = 0; i <= steps; i++)
        out[i] = first + i * every;
    *rows = steps + 1;
    return out;
}

static Status fill_sheet(ct_session *session, const Formula *formulas, int count, Run *grid,
                         Run *source, double every, TableSheet *sheet, Diag *diag)
{
    double *times = NULL;
    const double *stamps;
    Status status;

    sheet->columns = count + 1;
    if (sheet->is_spectral)
        return spectrum_rows(session, formulas, count, grid, source, &sheet->values, &sheet->rows,
                             diag);
    if (every > 0 &&
        last_time(grid) - result_times(grid->result)[0] > every * MOST_VALUES / (count + 1)) {
        (void)diag_set(diag, E_VALUE, "that makes %.3g rows",
                       (last_time(grid) - result_times(grid->result)[0]) / every);
        diag_hint(diag, "take a larger step, every=");
        return E_VALUE;
    }
    if (every > 0 && result_rows(grid->result) > 1)
        times = even_times(grid, every, &sheet->rows);
    else
        sheet->rows = result_rows(grid->result);
    stamps = times != NULL ? times : result_times(grid->result);
    sheet->values = mem_array((size_t)sheet->rows * (size_t)(count + 1), sizeof *sheet->values);
    for (int r = 0; r < sheet->rows; r++)
        sheet->values[(size_t)r * (size_t)(count + 1)] = stamps[r];
    CHECK(formula_rows(session, formulas, count, grid, source, times, sheet->rows, sheet->values,
                       count + 1, 1, diag));
done:
    mem_free(times);
    return status;
}

static Status make_sheet(ct_session *session, const Syntax *const *items, int count, Run *source,
                         double every, TableSheet *out, Diag *diag)
{
    TableSheet sheet = {0};
    int columns = count;
    Formula *formulas = NULL;
    Status status = OK;

    for (int i = 0; i < count; i++)
        sheet.is_spectral = sheet.is_spectral || spectrum_is_called(items[i]);
    LIST_PUSH(sheet.names, mem_text(sheet.is_spectral ? "f" : "t", 1));
    if (sheet.is_spectral && every > 0) {
        status = diag_set(diag, E_VALUE, "a spectrum takes no every=: its rows are frequencies");
        goto done;
    }
    if (count == 0) {
        columns = state_count(source);
        formulas = NEW_ARRAY(Formula, columns);
        all_items(source, formulas, &sheet);
    } else {
        formulas = NEW_ARRAY(Formula, columns);
        CHECK(read_items(session, items, count, formulas, &sheet, diag));
    }
    CHECK(fill_sheet(session, formulas, columns, formula_grid(session, formulas, columns, source),
                     source, every, &sheet, diag));
    LIST_PUSH(sheet.names, NULL);
    *out = sheet;
    sheet = (TableSheet){0};
done:
    if (status != OK)
        session_place_item(items, count, diag);
    for (int i = 0; i < columns; i++)
        if (formulas != NULL)
            formula_free(&formulas[i]);
    mem_free(formulas);
    sheet_free(&sheet);
    return status;
}

static void remark_changes(ct_session *session)
{
    Text text = {0};

    if (!session->changed)
        return;
    text_addf(&text, "these are rows of run%d: the model has changed since", session->runs.count);
    session_remark(session, text.at);
    text_free(&text);
}

Status session_last_run(ct_session *session, Run **out, Diag *diag)
{
    if (session->runs.count == 0)
        return session_start(session, out, diag);
    *out = session->runs.at + session->runs.count - 1;
    remark_changes(session);
    return OK;
}

static Status last_sheet(ct_session *session, const ct_expression *const *items, int count,
                         double every, TableSheet *out, Diag *diag)
{
    const Syntax **list = NEW_ARRAY(const Syntax *, count);
    Run *source = NULL;
    Status status;

    session_begin(session);
    for (int i = 0; i < count; i++)
        list[i] = syntax_of(items[i]);
    CHECK(session_last_run(session, &source, diag));
    monitor_report(&session->watch, "reading rows", -1);
    CHECK(make_sheet(session, list, count, source, every, out, diag));
done:
    mem_free(list);
    return status;
}

ct_status ct_table(ct_session *session, const ct_expression *const *items, int count, double every,
                   double **values, int *rows, int *columns, char ***names, ct_error *error)
{
    SESSION_WORK(session, error);

    TableSheet sheet = {0};
    Diag diag = {0};
    const Status status = last_sheet(session, items, count, every, &sheet, &diag);

    if (status == OK) {
        *values = sheet.values;
        *rows = sheet.rows;
        *columns = sheet.columns;
        *names = sheet.names.at;
    }
    return session_report(status, &diag, error);
}

/* --- columns --- */

void session_unit(const ct_session *session, const char *name, Text *out)
{
    Pool *pool = pool_new(0);
    Syntax *syntax = NULL;
    Diag ignored = {0};

    if (syntax_parse_expression(name, pool, &syntax, &ignored) == OK)
        (void)session_shown_unit(session, syntax, "", out);
    pool_free(pool);
}

/* the name of a column without the unit that it is in, which is returned, new */
static char *split_unit(const ct_session *session, char *name)
{
    char *bracket = strstr(name, " [");
    Text unit = {0};

    if (strcmp(name, "t") == 0 || strcmp(name, "f") == 0) {
        text_add(&unit, name[0] == 't' ? "s" : "Hz");
    } else if (bracket != NULL) {
        text_add_n(&unit, bracket + 2, strcspn(bracket + 2, "]"));
        *bracket = '\0';
    } else {
        session_unit(session, name, &unit);
    }
    return text_done(&unit);
}

void ct_columns_free(ct_column *columns)
{
    for (int i = 0; columns != NULL && columns[i].name != NULL; i++)
        MEM_FREE(columns[i].name, columns[i].unit, columns[i].values);
    mem_free(columns);
}

ct_status ct_columns(ct_session *session, const ct_expression *const *items, int count,
                     double every, ct_column **out, int *columns, int *rows, ct_error *error)
{
    SESSION_WORK(session, error);

    TableSheet sheet = {0};
    Diag diag = {0};
    const Status status = last_sheet(session, items, count, every, &sheet, &diag);

    if (status == OK) {
        *columns = sheet.columns;
        *rows = sheet.rows;
        *out = NEW_ARRAY(ct_column, sheet.columns + 1);
    }
    for (int c = 0; c < sheet.columns; c++) {
        ct_column *column = &(*out)[c];

        column->name = mem_text(sheet.names.at[c], strlen(sheet.names.at[c]));
        column->unit = split_unit(session, column->name);
        column->values = NEW_ARRAY(double, sheet.rows);
        for (int r = 0; r < sheet.rows; r++)
            column->values[r] = sheet.values[(ptrdiff_t)r * sheet.columns + c];
    }
    sheet_free(&sheet);
    return session_report(status, &diag, error);
}

/* --- exports --- */

static bool begins_with(const Statement *s, const char *word)
{
    const Syntax *item = s->operands.count > 1 ? s->operands.at[1].value : NULL;

    return item != NULL && item->kind == SYNTAX_VARIABLE && item->primes == 0 && !item->has_unit &&
           strcmp(item->text, word) == 0;
}

static bool is_alone(const Statement *s, const char *word)
{
    return s->operands.count == 2 && begins_with(s, word);
}

/* the table of the last sweep; names and units are copied */
static Status read_sweep(const ct_session *session, const Statement *s, TableSheet *sheet,
                         Exported *what, Diag *diag)
{
    const SweepTable *sweep = session->sweep;

    if (sweep == NULL) {
        (void)diag_at(diag, E_MISSING, s->operands.at[1].place, "there is no sweep yet");
        diag_hint(diag, "sweep L=range(0.1, 0.3, 20) keep=[max(h1)] : simulate 5");
        return E_MISSING;
    }
    for (int c = 0; c < sweep->columns.count; c++) {
        const SweepColumn *column = &sweep->columns.at[c];

        LIST_PUSH(sheet->names, mem_text(column->name, strlen(column->name)));
        LIST_PUSH(sheet->units, mem_text(column->unit, strlen(column->unit)));
    }
    what->sweep = sweep;
    what->names = (const char *const *)sheet->names.at;
    what->units = (const char *const *)sheet->units.at;
    what->values = sweep->values;
    what->rows = sweep->rows;
    what->columns = sweep->columns.count;
    return OK;
}

/* A requested `t` is the first column, which is always there. */
static void drop_times(TableSheet *sheet)
{
    for (int c = sheet->columns - 1; c > 0 && !sheet->is_spectral; c--) {
        const int columns = sheet->columns;
        double *to = sheet->values;

        if (strcmp(sheet->names.at[c], "t") != 0)
            continue;
        mem_free(sheet->names.at[c]);
        for (int k = c + 1; k < sheet->names.count; k++)
            sheet->names.at[k - 1] = sheet->names.at[k];
        sheet->names.count--;
        for (size_t i = 0; i < (size_t)sheet->rows * (size_t)columns; i++)
            if ((int)(i % (size_t)columns) != c)
                *to++ = sheet->values[i];
        sheet->columns--;
    }
}

/* numbers of the last run or, with the word `start`, of the start; or the modes; units in a
 * separate row, or with the names */
static Status read_numbers(ct_session *session, const Statement *s, bool splits_units,
                           TableSheet *sheet, Exported *what, Diag *diag)
{
    const bool is_start = begins_with(s, "start");
    const int first = is_start ? 2 : 1, count = s->operands.count - first;
    const Syntax **items = NEW_ARRAY(const Syntax *, count);
    Run *source = NULL;
    Status status = OK;

    if (is_alone(s, "sweep")) {
        status = read_sweep(session, s, sheet, what, diag);
        goto done;
    }
    what->modes = is_alone(s, "modes") ? session->modes : NULL;
    if (is_alone(s, "modes") && what->modes == NULL) {
        status = diag_at(diag, E_MISSING, s->operands.at[1].place, "there are no modes yet");
        diag_hint(diag, "'modes' finds them");
    }
    if (status != OK || is_alone(s, "modes"))
        goto done;
    for (int i = 0; i < count; i++)
        items[i] = s->operands.at[i + first].value;
    CHECK(is_start ? session_start(session, &source, diag)
                   : session_last_run(session, &source, diag));
    CHECK(make_sheet(session, items, count, source, 0, sheet, diag));
    drop_times(sheet);
    for (int c = 0; c < sheet->columns && splits_units; c++)
        LIST_PUSH(sheet->units, split_unit(session, sheet->names.at[c]));
    what->names = (const char *const *)sheet->names.at;
    what->units = (const char *const *)sheet->units.at;
    what->values = sheet->values;
    what->rows = sheet->rows;
    what->columns = sheet->columns;
done:
    mem_free(items);
    return status;
}

void code_items_free(CodeItems *items)
{
    for (int i = 0; i < items->names.count; i++)
        mem_free(items->names.at[i]);
    LIST_FREE(items->names);
    LIST_FREE(items->formulas);
    inverse_free(items->inverse);
}

Status session_code_item(ct_session *session, const Syntax *item, CodeItems *items, Diag *diag)
{
    Expr e;
    const Status status = model_expression(session->model, item, &e, diag);

    if (status != OK)
        return status;
    LIST_PUSH(items->formulas, session_add_outputs(session->model, e));
    LIST_PUSH(items->names, column_name(item));
    return OK;
}

Status session_read_code(ct_session *session, CodeItems *items, bool is_inverse, Exported *what,
                         Diag *diag)
{
    Run *start;
    Status status = OK;

    CHECK(session_prepare(session, NEED_RUNNING, &what->view, diag));
    CHECK(session_start(session, &start, diag));
    if (is_inverse)
        CHECK(inverse_new(&what->view, &items->inverse, diag));
    what->inverse = items->inverse;
    what->start = start->reader;
    what->items = items->formulas.at;
    what->item_count = items->formulas.count;
    what->names = (const char *const *)items->names.at;
done:
    return status;
}

/* what the format needs; only numbers and code have items */
static Status prepare(ct_session *session, const Statement *s, const Format *format,
                      TableSheet *sheet, CodeItems *items, Exported *what, Diag *diag)
{
    const Need need = format->need;
    const bool is_inverse = need == NEED_CODE && begins_with(s, "inverse");
    Status status = OK;

    if (need == NEED_RUN)
        return read_numbers(session, s, format->splits_units, sheet, what, diag);
    for (int i = is_inverse ? 2 : 1; need == NEED_CODE && status == OK && i < s->operands.count;
         i++)
        status = session_code_item(session, s->operands.at[i].value, items, diag);
    if (need == NEED_CODE)
        return status != OK ? status : session_read_code(session, items, is_inverse, what, diag);
    if (s->operands.count > 1)
        return diag_at(diag, E_SYNTAX, s->operands.at[1].place, "'export %s' takes no items",
                       s->operands.at[0].value->text);
    return session_prepare_formulas(session, need, &what->view, diag);
}

/* options of FMUs only */
static Status read_form(ct_session *session, const Statement *s, const Format *format,
                        Exported *what, Diag *diag)
{
    what->version = 2;
    for (int i = 0; i < s->pairs.count; i++) {
        const Pair *pair = &s->pairs.at[i];
        double number;

        if (strcmp(pair->name, "kind") == 0) {
            what->only_exchange = strcmp(pair->value->text, "exchange") == 0;
            what->only_simulation = strcmp(pair->value->text, "simulation") == 0;
            if (!what->only_exchange && !what->only_simulation &&
                strcmp(pair->value->text, "both") != 0)
                return diag_at(diag, E_VALUE, pair->value->place,
                               "kind= is one of both, exchange, simulation");
            continue;
        }
        TRY(session_number(session, pair->value, &number, diag));
        if (number != 2 && number != 3)
            return diag_at(diag, E_VALUE, pair->value->place, "version= is 2 or 3");
        what->version = (int)number;
    }
    if (!format->takes_keys && s->pairs.count > 0)
        return diag_at(diag, E_SYNTAX, s->pairs.at[0].name_place, "'export %s' takes no keys",
                       s->operands.at[0].value->text);
    return OK;
}

static Status refuse_text(const Statement *s, Diag *diag)
{
    const char *name = s->operands.at[0].value->text;

    (void)diag_at(diag, E_SYNTAX, s->operands.at[0].place,
                  s->append ? "'export %s' makes a whole file, which can't be appended to another"
                            : "'export %s' goes to a file",
                  name);
    diag_hint(diag, "export %s > \"model.%s\"", name, name);
    return E_SYNTAX;
}

ct_status ct_export_archive(ct_session *session, const ct_statement *statement, ct_archive **out,
                            ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    const Format *format =
        s->operands.count > 0 ? format_find(s->operands.at[0].value->text) : NULL;
    Exported what = {.view = session_view(session)};
    TableSheet sheet = {0};
    CodeItems items = {0};
    Diag diag = {0};
    Archive *archive = NULL;
    Status status = OK;

    *out = NULL;
    if (format == NULL || format->pack == NULL)
        return CT_OK;
    session_begin(session);
    CHECK(read_form(session, s, format, &what, &diag));
    CHECK(prepare(session, s, format, &sheet, &items, &what, &diag));
    CHECK(format->pack(&what, &archive, &diag));
    *out = (ct_archive *)(void *)archive;
done:
    sheet_free(&sheet);
    code_items_free(&items);
    session_end_formulas(&what.view);
    return session_report(status, &diag, error);
}

static const Archive *archive_of(const ct_archive *archive)
{
    return (const Archive *)(const void *)archive;
}

bool ct_archive_is_zip(const ct_archive *archive)
{
    return !archive_of(archive)->is_plain;
}

bool ct_archive_file(const ct_archive *archive, int i, const char **name, const char **bytes,
                     size_t *length)
{
    const Archive *a = archive_of(archive);

    if (i < 0 || i >= a->files.count)
        return false;
    *name = a->files.at[i].name;
    *bytes = a->files.at[i].bytes;
    *length = a->files.at[i].length;
    return true;
}

const char *ct_archive_binary(const ct_archive *archive)
{
    return archive_of(archive)->binary;
}

ct_status ct_archive_pack(ct_session *session, const ct_archive *archive, const char *binary,
                          size_t binary_length, char **bytes, size_t *length, ct_error *error)
{
    SESSION_WORK(session, error);

    Diag diag = {0};

    return session_report(
        archive_pack(archive_of(archive), binary, binary_length, bytes, length, &diag), &diag,
        error);
}

void ct_archive_free(ct_archive *archive)
{
    archive_free((Archive *)(void *)archive);
}

ct_status ct_export(ct_session *session, const ct_statement *statement, bool with_header,
                    char **text, ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    const char *name = s->operands.count > 0 ? s->operands.at[0].value->text : "";
    const Format *format = format_find(name);
    Exported what = {.view = session_view(session), .with_header = with_header};
    NamedLaws laws = {0};
    TableSheet sheet = {0};
    CodeItems items = {0};
    Text out = {0};
    Diag diag = {0};
    Status status;

    session_begin(session);
    if (format == NULL) {
        status = diag_at(&diag, E_NAME, s->verb_place, "no format is called '%s'", name);
        goto done;
    }
    CHECK(read_form(session, s, format, &what, &diag));
    if (format->write == NULL) {
        status = refuse_text(s, &diag);
        goto done;
    }
    CHECK(prepare(session, s, format, &sheet, &items, &what, &diag));
    if (format->need == NEED_SYSTEM)
        CHECK(session_name_laws(session, s, &laws, &what.view, &diag));
    CHECK(format->write(&what, &out, &diag));
    *text = text_done(&out);
done:
    sheet_free(&sheet);
    code_items_free(&items);
    session_end_named_laws(session, &laws, &what.view);
    session_end_formulas(&what.view);
    text_free(&out);
    return session_report(status, &diag, error);
}
