/* session_import.c: models from files of other programs */
#include "session/session_impl.h"

#include "export/import.h"

#include <errno.h>
#include <string.h>

/* more than any model that is typed or drawn */
enum { LARGEST = 64 << 20 };

Status session_read_file(ct_session *session, const Syntax *name, Text *out, Diag *diag)
{
    const DataFinder finder = {.find = session->hooks.find_file, .context = session->hooks.context};
    char piece[4096];
    DataFile file;
    size_t size = 0;
    Status status = data_open(&finder, name->text, name->place, &file, diag);

    while (status == OK && (size = fread(piece, 1, sizeof piece, file.in)) > 0) {
        text_add_n(out, piece, size);
        if (out->length > LARGEST)
            status = diag_at(diag, E_VALUE, name->place, "'%s' is larger than %d MiB", name->text,
                             LARGEST >> 20);
    }
    if (status == OK && ferror(file.in))
        status =
            diag_at(diag, E_VALUE, name->place, "can't read '%s': %s", name->text, strerror(errno));
    data_close(&file);
    return status;
}

/* Apply the statements; the message about one that the model refuses names the file's line. */
static Status apply_lines(Model *model, const Import *import, Diag *diag)
{
    const char *script = import->script.at;
    Cursor cursor = {script, 0, 1, 0};
    Statement *statement = NULL;
    Status status = OK;

    while (cursor.next < import->script.length) {
        CHECK(statement_read(&cursor, (SyntaxOptions){false}, &statement, diag));
        if (statement->kind != STATEMENT_EMPTY)
            status = model_apply(model, statement, diag);
        if (status != OK) {
            const Diag why = *diag;

            (void)diag_set(diag, status, "line %d of %s, as '%.200s': %.300s",
                           import->from.at[statement->place.line - 1], import->file,
                           statement->text, why.message);
            diag_hint(diag, "%s", why.hint);
            goto done;
        }
        statement_free(statement);
        statement = NULL;
    }
done:
    statement_free(statement);
    return status;
}

/* all or none, as one step */
static Status apply_import(ct_session *session, const Import *import, Diag *diag)
{
    Model *model = session->model;
    const uint64_t revision = model_revision(model);
    const int group = model_begin_group(model);
    Status status = apply_lines(model, import, diag);
    Text called = {0};

    text_addf(&called, "import of \"%s\"", import->file);
    session_end_group(session, group, called.at, revision, status == OK);
    text_free(&called);
    return status;
}

ct_status ct_import(ct_session *session, const ct_statement *statement, char **text,
                    ct_error *error)
{
    SESSION_WORK(session, error);

    const Statement *s = statement_of(statement);
    const Syntax *file = s->operands.at[1].value;
    Import *import = import_new(file->text, text != NULL || model_step_count(session->model) == 0);
    Text content = {0};
    Diag diag = {0};
    const char *name;
    Status status;

    session_begin(session);
    for (int i = 0; text == NULL && (name = model_name(session->model, i)) != NULL; i++)
        import_make_name(import, name);
    CHECK(session_read_file(session, file, &content, &diag));
    CHECK(importer_find(s->operands.at[0].value->text)(import, content.at != NULL ? content.at : "",
                                                       content.length, &diag));
    if (import->missing > 0 && text == NULL) {
        (void)diag_set(&diag, E_MODEL, "line %d of %s: %.400s", import->missing_line, import->file,
                       import->missing_what);
        diag_hint(&diag,
                  "%d part%s can't be said here: import ... > \"model.ct\" writes the rest, "
                  "to be completed",
                  import->missing, import->missing == 1 ? "" : "s");
        CHECK(E_MODEL);
    }
    if (text == NULL)
        CHECK(apply_import(session, import, &diag));
    else
        *text = text_done(&import->script);
    if (import->remarks.length > 0)
        session_remark(session, import->remarks.at);
done:
    if (status != OK && diag.place.line == 0)
        diag.place = file->place;
    text_free(&content);
    import_free(import);
    return session_report(status, &diag, error);
}
