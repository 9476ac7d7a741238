/* session_help.c: help, reference and completion for programs */
#include "session/session_impl.h"

#include "present/help.h"

#include <string.h>

char *ct_help(const char *word)
{
    TRANSACTION(NULL);

    Text text = {0};

    return help_print(&text, word) ? text_done(&text) : NULL;
}

char *ct_apropos(const char *word)
{
    TRANSACTION(NULL);

    Text text = {0};

    help_apropos(&text, word);
    return text_done(&text);
}

const char *ct_help_suggest(const char *word)
{
    return help_suggest(word);
}

char *ct_reference(const char *format)
{
    TRANSACTION(NULL);

    static const struct {
        const char *name;
        void (*write)(Text *out);
    } formats[] = {
        {"texinfo", reference_texinfo}, {"man", reference_man}, {"words", reference_words}};
    Text text = {0};

    for (int i = 0; i < COUNT(formats); i++)
        if (strcmp(formats[i].name, format) == 0) {
            formats[i].write(&text);
            return text_done(&text);
        }
    return NULL;
}

bool ct_example(int i, const char **name, const char **text)
{
    return help_example(i, name, text);
}

char **ct_complete(ct_session *session, const char *line, size_t cursor, size_t *start)
{
    TRANSACTION(NULL);
    session_work(session);

    const KnownName known = {.model = session->model,
                             .linear = session->linear,
                             .runs = session->runs.count,
                             .setting = session->hooks.setting,
                             .context = session->hooks.context};
    Words words = {0};
    char **out;

    complete_line(&known, line, cursor, start, &words);
    LIST_PUSH(words, NULL);
    out = words.at;
    return out;
}

void ct_words_free(char **words)
{
    for (int i = 0; words != NULL && words[i] != NULL; i++)
        mem_free(words[i]);
    mem_free(words);
}

const char *ct_verb_name(int i)
{
    Verb verb;

    return verb_at(i, &verb) ? verb.name : NULL;
}
