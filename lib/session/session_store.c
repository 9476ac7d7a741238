/* session_store.c: definitions of subsystems in files of their own
 *
 * A stored file is text: a first line with the version and a checksum of the rest, then definitions
 * only. Any other file is refused before the model is changed. */
#include "session/session_impl.h"

#include "language/verbs.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char HEAD[] = "# subsystem stored by cotree, version ";
enum { VERSION = 1 };

static uint64_t fingerprint(const char *text)
{
    uint64_t number = UINT64_C(14695981039346656037); /* FNV-1a (Fowler, Noll, Vo) */

    for (; *text != '\0'; text++)
        number = (number ^ (unsigned char)*text) * UINT64_C(1099511628211);
    return number;
}

/* --- store --- */

/* a subsystem with frames is one of a plane or of space */
static const char *scene_of(const Model *model, const char *name)
{
    const Subsystem *subsystem = model_find_subsystem(model, name);

    for (int i = 0; i < subsystem->port_count; i++)
        if (subsystem->ports[i].is_frame)
            return model_is_planar(model) ? "planar" : "spatial";
    return "any";
}

ct_status ct_store(ct_session *session, const ct_statement *statement, char **text, ct_error *error)
{
    SESSION_WORK(session, error);

    const Syntax *name = statement_of(statement)->operands.at[0].value;
    Text out = {0};
    Diag diag = {0};
    Status status = OK;
    char *body;

    session_begin(session);
    body = model_store(session->model, name->text);
    if (body == NULL) {
        Suggest suggest = suggest_for(name->text);

        for (int i = 0; i < model_subsystem_count(session->model); i++)
            suggest_offer(&suggest, model_subsystem(session->model, i)->name);
        status = diag_at(&diag, E_NAME, name->place, "there is no subsystem '%s'", name->text);
        if (suggest.best != NULL)
            diag_hint(&diag, "did you mean '%s'?", suggest.best);
        else
            diag_hint(&diag, "subsystem %s ... end defines one", name->text);
        return session_report(status, &diag, error);
    }
    text_addf(&out, "%s%d, %s scene, unedited: %016" PRIx64 "\n%s", HEAD, VERSION,
              scene_of(session->model, name->text), fingerprint(body), body);
    mem_free(body);
    *text = text_done(&out);
    return session_report(status, &diag, error);
}

/* --- load --- */

typedef struct SessionStoreLoad {
    Model *model;
    const Syntax *file;
    const char *text;
    size_t length;
    int lines; /* of the file's head */
    Text remarks;
} SessionStoreLoad;

/* the contents of a file's first line */
typedef struct Head {
    long version;
    char scene[8];
    uint64_t number; /* fingerprint of `rest` */
    const char *rest;
} Head;

/* NULL: `text` doesn't go on with `word` */
static const char *text_after(const char *text, const char *word)
{
    return strncmp(text, word, strlen(word)) == 0 ? text + strlen(word) : NULL;
}

static bool read_head(const char *text, Head *head)
{
    const char *at = text_after(text, HEAD);
    char *end;
    size_t length;

    if (at == NULL || !isdigit((unsigned char)*at))
        return false;
    head->version = strtol(at, &end, 10);
    at = text_after(end, ", ");
    if (at == NULL)
        return false;
    length = strspn(at, "abcdefghijklmnopqrstuvwxyz");
    if (length >= sizeof head->scene)
        return false;
    memcpy(head->scene, at, length);
    head->scene[length] = '\0';
    at = text_after(at + length, " scene, unedited: ");
    if (at == NULL || !isxdigit((unsigned char)*at))
        return false;
    head->number = strtoull(at, &end, 16);
    head->rest = end + 1;
    return *end == '\n';
}

/* the checksum in the first line is of the rest; `rest` is that of the text */
static Status check_head(const SessionStoreLoad *load, const char **rest, Diag *diag)
{
    const char *name = load->file->text;
    const char *scene = model_is_planar(load->model) ? "planar" : "spatial";
    Head head;

    if (strlen(load->text) != load->length || !read_head(load->text, &head)) {
        (void)diag_at(diag, E_VALUE, load->file->place, "'%s' is no stored subsystem", name);
        diag_hint(diag, "'store NAME \"FILE\"' writes one; 'source' replays a script");
        return E_VALUE;
    }
    if (head.version != VERSION) {
        (void)diag_at(diag, E_VALUE, load->file->place,
                      "'%s' was stored by another cotree: version %ld, not %d", name, head.version,
                      VERSION);
        diag_hint(diag, "its definitions are text: copy them into a script");
        return E_VALUE;
    }
    *rest = head.rest;
    if (fingerprint(*rest) == head.number &&
        (strcmp(head.scene, scene) == 0 || strcmp(head.scene, "any") == 0))
        return OK;
    if (fingerprint(*rest) == head.number) {
        (void)diag_at(diag, E_MODEL, load->file->place, "'%s' is of a %s scene", name, head.scene);
        diag_hint(diag, "this one is %s; 'scene' says which it is, before the first part", scene);
        return E_MODEL;
    }
    (void)diag_at(diag, E_VALUE, load->file->place, "'%s' is damaged, or was edited", name);
    diag_hint(diag,
              "an edited definition is a script: 'source' replays it, 'store' writes it anew");
    return E_VALUE;
}

static bool is_definition(const Statement *s)
{
    return s->kind == STATEMENT_PARAMETER || s->kind == STATEMENT_LAW ||
           (s->kind == STATEMENT_VERB && s->row.number == VERB_subsystem && s->body != NULL);
}

static Status load_statement(SessionStoreLoad *load, const Statement *s, Diag *diag)
{
    const char *there;
    bool same = false;

    if (s->kind == STATEMENT_EMPTY)
        return OK;
    if (!is_definition(s)) {
        (void)diag_at(diag, E_VALUE, load->file->place, "line %d of '%s' is no definition",
                      s->place.line + load->lines, load->file->text);
        diag_hint(diag, "a stored file holds parameters, laws and subsystems");
        return E_VALUE;
    }
    there = model_definition_like(load->model, s, &same);
    if (there == NULL)
        return model_apply(load->model, s, diag);
    if (same)
        return OK;
    if (s->kind == STATEMENT_VERB) {
        (void)diag_at(diag, E_NAME, load->file->place,
                      "the model has another subsystem %s than '%s'", s->operands.at[0].value->text,
                      load->file->text);
        diag_hint(diag, "rename or delete one of them");
        return E_NAME;
    }
    text_addf(&load->remarks, "the model's own stays: %s\n", there);
    return OK;
}

static Status load_all(SessionStoreLoad *load, const char *text, Diag *diag)
{
    Cursor cursor = {text, 0, 1, 0};
    Statement *statement = NULL;
    Status status = OK;

    while (status == OK && cursor.next < strlen(text)) {
        Diag why = {0};

        status = statement_read(&cursor, (SyntaxOptions){.whole = true}, &statement, &why);
        if (status == OK)
            status = load_statement(load, statement, &why);
        if (status != OK && why.place.line == load->file->place.line &&
            why.place.column == load->file->place.column)
            *diag = why;
        else if (status != OK) {
            (void)diag_at(diag, status, load->file->place, "line %d of '%s': %.300s",
                          why.place.line + load->lines, load->file->text, why.message);
            diag_hint(diag, "%s", why.hint);
        }
        statement_free(statement);
        statement = NULL;
    }
    return status;
}

ct_status ct_load(ct_session *session, const ct_statement *statement, ct_error *error)
{
    SESSION_WORK(session, error);

    const Syntax *file = statement_of(statement)->operands.at[0].value;
    SessionStoreLoad load = {.model = session->model, .file = file, .lines = 1};
    const char *rest = NULL;
    Text content = {0}, called = {0};
    Diag diag = {0};
    Status status = OK;
    uint64_t revision;
    int group;

    session_begin(session);
    CHECK(session_read_file(session, file, &content, &diag));
    load.text = content.at != NULL ? content.at : "";
    load.length = content.length;
    CHECK(check_head(&load, &rest, &diag));
    revision = model_revision(session->model);
    group = model_begin_group(session->model);
    status = load_all(&load, rest, &diag);
    text_addf(&called, "load \"%s\"", file->text);
    session_end_group(session, group, called.at, revision, status == OK);
    if (status == OK && load.remarks.length > 0)
        session_remark(session, load.remarks.at);
done:
    text_free(&called);
    text_free(&load.remarks);
    text_free(&content);
    return session_report(status, &diag, error);
}
