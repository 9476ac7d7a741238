/* session_sweep_file.c: rows of a sweep in a file, parts of a sweep, and `merge` */
#include "session/session_sweep.h"

#include "simulate/sweep/row_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const Syntax *key_of(const Statement *s, const char *name)
{
    for (int i = 0; i < s->pairs.count; i++)
        if (strcmp(s->pairs.at[i].name, name) == 0)
            return s->pairs.at[i].value;
    return NULL;
}

/* --- part=3/16 --- */

static Status read_part(ct_session *session, const Syntax *value, SweepFile *out, Diag *diag)
{
    double part = 0, parts = 0;

    if (value->kind == SYNTAX_BINARY && strcmp(value->text, "/") == 0) {
        TRY(session_number(session, value->args[0], &part, diag));
        TRY(session_number(session, value->args[1], &parts, diag));
    }
    if (!(part >= 1 && part <= parts && parts <= SWEEP_MOST_PARTS) || part != floor(part) ||
        parts != floor(parts)) {
        (void)diag_at(diag, E_VALUE, value->place, "part= is one of some parts of the runs");
        diag_hint(diag, "part=3/16 is the third of sixteen, for 16 jobs on as many machines");
        return E_VALUE;
    }
    out->part = (int)part - 1;
    out->parts = (int)parts;
    return OK;
}

/* the rows of the part alone: every so many'th */
static SweepTable *cut_part(const SweepTable *whole, const SweepFile *file)
{
    const int planned = whole->planned > file->part
                            ? (whole->planned - file->part + file->parts - 1) / file->parts
                            : 0;
    SweepTable *out = sweep_table_new(planned);

    out->is_random = whole->is_random;
    for (int i = 0; i < whole->columns.count; i++)
        sweep_table_column(out, whole->columns.at[i].name, whole->columns.at[i].unit);
    sweep_table_open(out, whole->parameter_count);
    for (int r = 0; r < planned; r++)
        memcpy(sweep_table_row(out, r), sweep_table_row(whole, file->part + r * file->parts),
               (size_t)whole->columns.count * sizeof(double));
    return out;
}

/* --- the file --- */

static Status append(const SweepFile *file, const Text *text, Diag *diag)
{
    const ct_hooks *hooks = &file->session->hooks;
    char *why;

    if (transaction_is_trial())
        return OK;
    why = hooks->append(hooks->context, file->name->text, text->at, text->length);
    if (why == NULL)
        return OK;
    (void)diag_at(diag, E_FILE, file->name->place, "%.500s", why);
    free(why);
    return E_FILE;
}

/* what it contains already; an empty text where there is no such file */
static Status read_content(const SweepFile *file, Text *out, Diag *diag)
{
    const ct_hooks *hooks = &file->session->hooks;
    char *why = NULL, *content = hooks->content(hooks->context, file->name->text, &why);

    if (why != NULL) {
        (void)diag_at(diag, E_FILE, file->name->place, "%.500s", why);
        free(why);
        free(content);
        return E_FILE;
    }
    text_add(out, content != NULL ? content : "");
    free(content);
    return OK;
}

/* a row that was made before, unless another one has its number */
static void take_old_row(const SweepFile *file, SweepTable *table, int number, const double *values,
                         const char *reason, bool *is_made)
{
    const int row = (number - file->part) / file->parts;

    if (number % file->parts != file->part || row >= table->planned || is_made[row])
        return;
    is_made[row] = true;
    memcpy(sweep_table_row(table, row) + table->parameter_count, values + table->parameter_count,
           (size_t)(table->columns.count - table->parameter_count) * sizeof(double));
    if (reason[0] != '\0') {
        table->reasons[row] = mem_text(reason, strlen(reason));
        table->failures++;
    }
}

static Status refuse_other(const SweepFile *file, Diag *diag)
{
    (void)diag_at(diag, E_FILE, file->name->place,
                  "'%s' has no rows of this sweep: model, statement or values are others",
                  file->name->text);
    diag_hint(diag, "delete it, or name another file");
    return E_FILE;
}

/* *has_head: it has the columns of this sweep */
static Status read_rows(const SweepFile *file, SweepTable *table, char *content, bool *is_made,
                        bool *has_head, Diag *diag)
{
    RowFileReader reader = {0};
    double *values = NEW_ARRAY(double, table->columns.count);
    const char *reason;
    Status status = OK;

    reader.at = content;
    while (row_file_next(&reader)) {
        uint64_t fingerprint = 0;
        SweepTable *head = row_file_read_head(&reader, &fingerprint);
        int number;

        if (head != NULL) {
            sweep_table_free(head);
            *has_head = true;
            CHECK(fingerprint == file->fingerprint ? OK : refuse_other(file, diag));
            continue;
        }
        number = row_file_read_row(&reader, table->columns.count, file->planned, values, &reason);
        if (*has_head && number >= 0)
            take_old_row(file, table, number, values, reason, is_made);
    }
done:
    mem_free(values);
    row_file_reader_free(&reader);
    return status;
}

Status sweep_file_plan(ct_session *session, const Statement *s, SweepTable **table, SweepFile *out,
                       Diag *diag)
{
    const Syntax *part = key_of(s, "part");
    char *model;
    SweepTable *cut;

    *out = (SweepFile){
        .session = session, .name = key_of(s, "file"), .parts = 1, .planned = (*table)->planned};
    if (part != NULL)
        TRY(read_part(session, part, out, diag));
    if (part != NULL && out->name == NULL) {
        (void)diag_at(diag, E_MISSING, part->place, "the rows of a part need a file");
        diag_hint(diag, "part=3/16 file=\"part3.rows\"; 'merge' then makes one table of all files");
        return E_MISSING;
    }
    if (out->name == NULL)
        return OK;
    if (out->name->kind != SYNTAX_STRING)
        return diag_at(diag, E_VALUE, out->name->place, "file= is the name of a file");
    if (session->hooks.append == NULL || session->hooks.content == NULL)
        return diag_at(diag, E_FILE, out->name->place, "this program writes no files of rows");
    model = model_save(session->model);
    out->fingerprint = row_file_fingerprint(*table, model);
    out->fingerprint = row_file_hash(out->fingerprint, s->rest->text, strlen(s->rest->text));
    mem_free(model);
    if (out->parts == 1)
        return OK;
    cut = cut_part(*table, out);
    sweep_table_free(*table);
    *table = cut;
    return OK;
}

Status sweep_file_open(SweepFile *file, SweepTable *table, bool *is_made, Diag *diag)
{
    Text content = {0}, text = {0};
    bool has_head = false;
    Status status = OK;

    if (file->name == NULL)
        return OK;
    CHECK(read_content(file, &content, diag));
    if (content.length > 0 && content.at[content.length - 1] != '\n')
        text_char(&text, '\n'); /* after a line that was not finished */
    CHECK(read_rows(file, table, content.at, is_made, &has_head, diag));
    if (!has_head && content.length > 0 && strncmp(content.at, "cotree rows", 11) != 0)
        CHECK(refuse_other(file, diag));
    if (!has_head)
        row_file_add_head(table, file->planned, file->fingerprint, &text);
    text_add(&text, "");
    CHECK(append(file, &text, diag));
    for (int r = 0; r < table->planned; r++)
        file->old += is_made[r];
done:
    text_free(&content);
    text_free(&text);
    return status;
}

Status sweep_file_add(const SweepFile *file, const SweepTable *table, int row, Diag *diag)
{
    Text text = {0};
    Status status;

    if (file->name == NULL)
        return OK;
    row_file_add_row(table, row, file->part + row * file->parts, &text);
    status = append(file, &text, diag);
    text_free(&text);
    return status;
}

/* --- merge --- */

typedef struct Merge {
    SweepTable *table; /* NULL: no file has been read */
    uint64_t fingerprint;
    bool *is_made;
    int made;
} Merge;

static void merge_row(Merge *merge, int number, const double *values, const char *reason)
{
    SweepTable *table = merge->table;

    if (merge->is_made[number])
        return;
    merge->is_made[number] = true;
    merge->made++;
    memcpy(sweep_table_row(table, number), values, (size_t)table->columns.count * sizeof(double));
    if (reason[0] != '\0') {
        table->reasons[number] = mem_text(reason, strlen(reason));
        table->failures++;
    }
}

/* *is_there: the file has rows of the same sweep as those before it */
static Status merge_head(Merge *merge, SweepTable *head, uint64_t fingerprint, const Syntax *name,
                         Diag *diag)
{
    if (merge->table != NULL && fingerprint != merge->fingerprint) {
        sweep_table_free(head);
        return diag_at(diag, E_FILE, name->place,
                       "'%s' has rows of another sweep than the first file", name->text);
    }
    if (merge->table != NULL) {
        sweep_table_free(head);
        return OK;
    }
    merge->table = head;
    merge->fingerprint = fingerprint;
    merge->is_made = NEW_ARRAY(bool, head->planned + 1);
    return OK;
}

static Status merge_content(Merge *merge, char *content, const Syntax *name, Diag *diag)
{
    RowFileReader reader = {0};
    double *values = NULL;
    Status status = OK;

    reader.at = content;
    while (row_file_next(&reader)) {
        uint64_t fingerprint = 0;
        SweepTable *head = row_file_read_head(&reader, &fingerprint);
        const char *reason;
        int number;

        if (head != NULL) {
            CHECK(merge_head(merge, head, fingerprint, name, diag));
            if (values == NULL)
                values = NEW_ARRAY(double, merge->table->columns.count + 1);
            continue;
        }
        if (values == NULL)
            continue;
        number = row_file_read_row(&reader, merge->table->columns.count, merge->table->planned,
                                   values, &reason);
        if (number >= 0)
            merge_row(merge, number, values, reason);
    }
    if (values == NULL) {
        status = diag_at(diag, E_FILE, name->place, "'%s' has no rows of a sweep", name->text);
        diag_hint(diag, "sweep .. file=\"%.200s\" : .. writes such a file", name->text);
    }
done:
    mem_free(values);
    row_file_reader_free(&reader);
    return status;
}

static Status merge_file(ct_session *session, const Syntax *name, Merge *merge, Diag *diag)
{
    Text content = {0};
    Status status;

    if (name->kind != SYNTAX_STRING) {
        (void)diag_at(diag, E_VALUE, name->place, "'merge' takes the names of files");
        diag_hint(diag, "merge \"part1.rows\" \"part2.rows\"");
        return E_VALUE;
    }
    CHECK(session_read_file(session, name, &content, diag));
    text_add(&content, "");
    CHECK(merge_content(merge, content.at, name, diag));
done:
    text_free(&content);
    return status;
}

static void report_nothing(const ct_session *session, Text *out)
{
    (void)session, (void)out;
}

/* how many rows there are, and that some are missing */
static void remark_merge(ct_session *session, const Merge *merge)
{
    const int missing = merge->table->planned - merge->made;
    Text line = {0};

    text_addf(&line, "%smerge: %d of %d runs", missing > 0 ? "warning: " : "", merge->made,
              merge->table->planned);
    for (int r = 0; missing > 0 && r < merge->table->planned; r++)
        if (!merge->is_made[r]) {
            text_addf(&line, ", run %d is the first of %d that are missing", r + 1, missing);
            break;
        }
    session_remark(session, line.at);
    text_free(&line);
}

Status session_merge(ct_session *session, const Statement *s, Diag *diag)
{
    Merge merge = {0};
    Status status = OK;

    if (s->operands.count == 0) {
        status = diag_at(diag, E_MISSING, s->verb_place, "'merge' needs the names of files");
        diag_hint(diag, "merge \"part1.rows\" \"part2.rows\"");
    }
    for (int i = 0; i < s->operands.count; i++)
        CHECK(merge_file(session, s->operands.at[i].value, &merge, diag));
    if (merge.table == NULL)
        goto done;
    merge.table->rows = merge.table->planned;
    for (int r = 0; r < merge.table->rows; r++)
        if (!merge.is_made[r])
            merge.table->reasons[r] = mem_text(SWEEP_MISSING, strlen(SWEEP_MISSING));
    remark_merge(session, &merge);
    sweep_table_free(session->sweep);
    session->sweep = merge.table;
    session->reporter = report_nothing;
    merge.table = NULL;
done:
    sweep_table_free(merge.table);
    mem_free(merge.is_made);
    return status;
}
