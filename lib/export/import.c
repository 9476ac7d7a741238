/* import.c: what importers share: names, statements that read, what was left out */
#include "export/import.h"

#include "language/functions.h"
#include "language/verbs.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* words that no name that is made here may be, and those that a parameter's may not be, either */
static void take_words(Import *import)
{
    static const char *const words[] = {"vs", "at", "as", "within"};
    Verb verb;
    Function function;

    for (int i = 0; i < COUNT(words); i++)
        import_make_name(import, words[i]);
    for (int i = 0; verb_any(i, &verb); i++)
        (void)names_add(import->verbs, verb.name);
    for (int i = 0; function_at(i, &function); i++)
        (void)names_add(import->verbs, function.name);
}

Import *import_new(const char *file, bool is_alone)
{
    Import *import = NEW(Import);

    import->file = file;
    import->is_alone = is_alone;
    import->pool = pool_new(0);
    import->whole = (ImportScope){.names = names_new(), .keys = names_new()};
    import->scope = &import->whole;
    import->verbs = names_new();
    take_words(import);
    return import;
}

void import_free(Import *import)
{
    if (import == NULL)
        return;
    pool_free(import->pool);
    import_scope_free(&import->whole);
    names_free(import->verbs);
    text_free(&import->script);
    LIST_FREE(import->from);
    text_free(&import->remarks);
    mem_free(import);
}

/* --- texts --- */

static const char *keep(Import *import, Text *text)
{
    const char *kept = pool_text(import->pool, text->at != NULL ? text->at : "", text->length);

    text_free(text);
    return kept;
}

const char *import_text(Import *import, const char *format, ...)
{
    Text text = {0};
    va_list args;

    va_start(args, format);
    text_addv(&text, format, args);
    va_end(args);
    return keep(import, &text);
}

const char *import_number(Import *import, double value)
{
    Text text = {0};

    text_number(&text, value, 17);
    return keep(import, &text);
}

/* --- names --- */

void import_make_name(Import *import, const char *name)
{
    (void)names_add(import->scope->names, name);
}

/* a letter, then letters, digits and _: an n before other first characters, _ for the rest */
static const char *make_legal(Import *import, const char *name)
{
    enum { LONGEST = 200 };
    Text text = {0};

    if (!isalpha((unsigned char)name[0]))
        text_char(&text, 'n');
    for (int i = 0; i < LONGEST && name[i] != '\0'; i++)
        text_char(&text, isalnum((unsigned char)name[i]) ? name[i] : '_');
    return keep(import, &text);
}

static void add_key(const Import *import, Text *key, char kind, const char *name)
{
    text_char(key, kind);
    for (; *name != '\0'; name++)
        text_char(key, import->ignores_case ? (char)tolower((unsigned char)*name) : *name);
}

static const char *known_in(const Import *import, const ImportScope *scope, char kind,
                            const char *name)
{
    Text key = {0};
    int i;

    add_key(import, &key, kind, name);
    i = names_find(scope->keys, key.at);
    text_free(&key);
    return i < 0 ? NULL : scope->ours.at[i];
}

const char *import_known(const Import *import, char kind, const char *name)
{
    const char *known = known_in(import, import->scope, kind, name);

    return known != NULL || kind != IMPORT_PARAMETER ? known
                                                     : known_in(import, &import->whole, kind, name);
}

void import_enter(Import *import, ImportScope *scope)
{
    scope->names = names_new();
    scope->keys = names_new();
    for (int i = 0; i < names_count(import->scope->names); i++)
        (void)names_add(scope->names, names_get(import->scope->names, i));
    import->scope = scope;
}

void import_return(Import *import)
{
    import->scope = &import->whole;
}

void import_scope_free(ImportScope *scope)
{
    names_free(scope->names);
    names_free(scope->keys);
    LIST_FREE(scope->ours);
}

static bool is_free(const Import *import, char kind, const char *name)
{
    return !name_is_reserved(name) && names_find(import->scope->names, name) < 0 &&
           (kind != IMPORT_PARAMETER || names_find(import->verbs, name) < 0);
}

const char *import_name(Import *import, char kind, const char *name)
{
    const char *known = known_in(import, import->scope, kind, name);
    const char *legal, *mine;
    Text key = {0};

    if (known != NULL)
        return known;
    legal = mine = make_legal(import, name);
    for (int number = 2; !is_free(import, kind, mine); number++)
        mine = import_text(import, "%s_%d", legal, number);
    import_make_name(import, mine);
    add_key(import, &key, kind, name);
    (void)names_add(import->scope->keys, key.at);
    text_free(&key);
    LIST_PUSH(import->scope->ours, mine);
    return mine;
}

/* --- statements --- */

static void end_line(Import *import, int line)
{
    text_char(&import->script, '\n');
    LIST_PUSH(import->from, line);
}

/* text in a comment or a remark is one line, whatever its bytes are */
static void add_plain(Text *out, const char *text)
{
    enum { LONGEST = 300 };
    size_t i = 0, length;

    for (; i < LONGEST && text[i] != '\0'; i += length == 0 ? 1 : length) {
        length = text_character(text + i);
        if (length == 0 || iscntrl((unsigned char)text[i]))
            text_char(out, ' ');
        else if (text[i] == '\\')
            text_char(out, '/');
        else
            text_add_n(out, text + i, length);
    }
    if (text[i] != '\0')
        text_add(out, " ...");
}

void import_comment(Import *import, int line, const char *format, ...)
{
    Text text = {0};
    va_list args;

    va_start(args, format);
    text_addv(&text, format, args);
    va_end(args);
    text_add(&import->script, "# ");
    add_plain(&import->script, text.at != NULL ? text.at : "");
    text_free(&text);
    end_line(import, line);
}

/* in a comment, and as a remark after `mark` */
static void remark(Import *import, int line, const char *mark, const Text *said)
{
    import_comment(import, line, "%s", said->at);
    text_add(&import->remarks, mark);
    add_plain(&import->remarks, said->at);
    text_char(&import->remarks, '\n');
}

void import_remark(Import *import, int line, const char *format, ...)
{
    Text said = {0};
    va_list args;

    va_start(args, format);
    text_addv(&said, format, args);
    va_end(args);
    remark(import, line, "", &said);
    text_free(&said);
}

void import_leave(Import *import, int line, bool is_part, const char *what, const char *format, ...)
{
    Text why = {0}, said = {0};
    va_list args;

    va_start(args, format);
    text_addv(&why, format, args);
    va_end(args);
    if (is_part && import->missing++ == 0) {
        import->missing_line = line;
        import->missing_what = import_text(import, "%s: %s", what, why.at);
    }
    text_addf(&said, "line %d: %s is left out: %s", line, what, why.at);
    remark(import, line, is_part ? "warning: " : "", &said);
    text_free(&why);
    text_free(&said);
}

bool import_add(Import *import, int line, const char *format, ...)
{
    Text text = {0};
    Statement *statement = NULL;
    size_t next = 0;
    Diag why = {0};
    bool reads;
    va_list args;

    va_start(args, format);
    text_addv(&text, format, args);
    va_end(args);

    /* the file's contents may be invalid here: that is reported here and not when it is applied */
    reads = statement_parse(text.at, 1, (SyntaxOptions){false}, &next, &statement, &why) == OK &&
            next == text.length;
    statement_free(statement);
    if (reads) {
        text_add(&import->script, text.at);
        end_line(import, line);
    } else {
        import_leave(import, line, true, text.at, "%s",
                     why.message[0] != '\0' ? why.message : "it is no statement");
    }
    text_free(&text);
    return reads;
}

void import_title(Import *import, int line, const char *title)
{
    Text plain = {0};

    if (title == NULL || title[0] == '\0')
        return;
    add_plain(&plain, title);
    for (char *c = plain.at; *c != '\0'; c++)
        if (*c == '"')
            *c = '\'';
    if (import->is_alone)
        import_add(import, line, "title \"%s\"", plain.at);
    else
        import_comment(import, line, "%s", plain.at);
    text_free(&plain);
}

Status import_refuse(const Import *import, int line, Diag *diag, const char *format, ...)
{
    Text why = {0};
    va_list args;

    va_start(args, format);
    text_addv(&why, format, args);
    va_end(args);
    if (line > 0)
        (void)diag_set(diag, E_VALUE, "line %d of %s: %.400s", line, import->file, why.at);
    else
        (void)diag_set(diag, E_VALUE, "%s: %.400s", import->file, why.at);
    text_free(&why);
    return E_VALUE;
}
