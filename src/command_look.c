/* command_look.c: commands that show the model, its equations, and help */
#include "command.h"

#include <stdlib.h>
#include <string.h>

/* print a text of the library, and free it */
static ct_status put(Call *call, ct_status status, char *text)
{
    if (status == CT_OK)
        write_text(call->out, text);
    ct_free(text);
    return status;
}

static ct_status command_show(Call *call, ct_error *error)
{
    char *text = NULL;
    const char *topic = call_word(call, 0);
    ct_status status = ct_show(call->session, call->statement, &text, error);

    status = put(call, status, text);
    if (status == CT_OK && topic != NULL && strcmp(topic, "settings") == 0)
        settings_show(&call->shell->settings, call->out);
    return status;
}

static ct_status command_count(Call *call, ct_error *error)
{
    char *text = NULL;
    ct_status status = ct_count(call->session, call->statement, &text, error);

    return put(call, status, text);
}

static ct_status command_check(Call *call, ct_error *error)
{
    char *text = NULL;
    ct_status status = ct_check(call->session, &text, error);

    return put(call, status, text);
}

static ct_status command_info(Call *call, ct_error *error)
{
    char *text = NULL;
    ct_status status = ct_info(call->session, call->statement, &text, error);

    return put(call, status, text);
}

static ct_status command_tree(Call *call, ct_error *error)
{
    char *text = NULL;
    ct_status status = ct_tree_text(call->session, &text, error);

    return put(call, status, text);
}

/* --- help --- */

static ct_status unknown_word(const Call *call, const char *word, ct_error *error)
{
    const char *meant = ct_help_suggest(word);

    ct_error_at(call->statement, ct_operand(call->statement, 0), error, "no help about '%s'", word);
    if (meant != NULL)
        error_hint(error, "did you mean '%s'?", meant);
    else
        error_hint(error, "help alone lists what there is; apropos %s searches", word);
    return CT_FAILED;
}

static ct_status command_help(Call *call, ct_error *error)
{
    const char *word = call_word(call, 0);
    char *text = ct_help(word != NULL ? word : "");
    ct_error ignored = {0};

    /* no word of the language: maybe a name of the model */
    if (text == NULL)
        (void)ct_info(call->session, call->statement, &text, &ignored);
    return text != NULL ? put(call, CT_OK, text) : unknown_word(call, word, error);
}

static ct_status command_apropos(Call *call, ct_error *error)
{
    const char *word = call_word(call, 0);

    if (word == NULL)
        return ct_error_at(call->statement, NULL, error, "apropos needs a word to look for");

    char *text = ct_apropos(word);

    if (text == NULL || *text == '\0') {
        ct_free(text);
        return ct_error_at(call->statement, ct_operand(call->statement, 0), error,
                           "nothing in the help has '%s'", word);
    }
    return put(call, CT_OK, text);
}

const Command commands_look[] = {
    {"show", command_show, NULL, 0},
    {"count", command_count, NULL, 0},
    {"check", command_check, NULL, 0},
    {"info", command_info, NULL, 0},
    {"tree", command_tree, NULL, 0},
    {"help", command_help, NULL, FORGOTTEN | OWN},
    {"apropos", command_apropos, NULL, FORGOTTEN | OWN},
    {NULL, NULL, NULL, 0},
};
