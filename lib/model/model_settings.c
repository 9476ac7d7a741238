/* model_settings.c: the settings of a model, which `set` chooses */
#include "base/code_memory.h"
#include "base/threads.h"
#include "language/verbs.h"
#include "model/model_impl.h"

#include <stdlib.h>
#include <string.h>

static const struct {
    bool changes_equations;
    const char *hint;
    int most;                 /* for whole numbers from 1; 0: the values are words */
    const char *const *words; /* the name, then the values */
} settings[] = {
#define SETTING(id, changes, hint, ...)              {changes, hint, 0, WORDS(__VA_ARGS__)},
#define NUMBER_SETTING(id, changes, hint, most, ...) {changes, hint, most, WORDS(__VA_ARGS__)},
#include "model/model_settings.def"
};

const char *const *model_setting(int i)
{
    return i >= 0 && i < COUNT(settings) ? settings[i].words : NULL;
}

void setting_text(const State *state, ModelSetting setting, Text *out)
{
    const int value = state->setup.settings.at[setting];

    if (settings[setting].most > 0)
        text_addf(out, "%d", 1 + value);
    else
        text_add(out, settings[setting].words[1 + value]);
}

/* the index of a word in a list ended by NULL; -1: it isn't there */
static int find_word(const char *const *words, const char *word)
{
    for (int i = 0; word != NULL && words[i] != NULL; i++)
        if (strcmp(words[i], word) == 0)
            return i;
    return -1;
}

/* a whole number minus 1; -1: it is not permitted */
static int find_number(const Syntax *syntax, int most)
{
    char *end;
    long number;

    if (syntax == NULL || syntax->kind != SYNTAX_NUMBER || syntax->has_unit)
        return -1;
    number = strtol(syntax->text, &end, 10);
    return *end == '\0' && number >= 1 && number <= most ? (int)number - 1 : -1;
}

static Status refuse_setting(ModelSetting setting, Place place, Diag *diag)
{
    const char *const *words = settings[setting].words;
    Text list = {0};

    if (settings[setting].most > 0)
        text_addf(&list, "a whole number from 1 to %d", settings[setting].most);
    else
        for (int i = 1; words[i] != NULL; i++)
            text_addf(&list, "%s%s", i > 1 ? " or " : "", words[i]);
    (void)diag_at(diag, E_VALUE, place, "%s is %s", words[0], list.at);
    diag_hint(diag, "%s", settings[setting].hint);
    text_free(&list);
    return E_VALUE;
}

Status setting_apply(State *state, ModelSetting setting, const Statement *statement,
                     Outcome *outcome, Diag *diag)
{
    const int most = settings[setting].most, operands = statement->operands.count;
    const Syntax *given =
        statement->pairs.count == 1 && operands == 0   ? statement->pairs.at[0].value
        : operands == 2 && statement->pairs.count == 0 ? statement->operands.at[1].value
                                                       : NULL;
    const int value = most > 0 ? find_number(given, most)
                               : find_word(settings[setting].words + 1,
                                           given != NULL ? syntax_name(given) : NULL);

    if (value < 0 && statement->pairs.count > 1)
        return diag_at(diag, E_SYNTAX, statement->pairs.at[1].name_place, "one setting at a time");
    if (value < 0)
        return refuse_setting(setting,
                              given != NULL  ? given->place
                              : operands > 0 ? statement->operands.at[operands - 1].place
                                             : statement->pairs.at[0].name_place,
                              diag);
    state->setup.settings.at[setting] = value;
    state->setup.settings.is_given[setting] = true;
    outcome->changes_equations = settings[setting].changes_equations;
    if (setting == SETTING_EVALUATOR && value == EVALUATOR_NATIVE && !code_memory_is_there())
        text_add(&outcome->remarks, "no native code can be run here: the interpreter evaluates\n");
    return OK;
}
