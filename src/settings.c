/* settings.c: what the user can set about the shell itself, one row a setting */
#include "settings.h"

#include "copy.h"
#include "report_error.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

typedef struct SettingRow {
    const char *const *words; /* the name, the values that are words, NULL */
    const char *brief;
    int low, high; /* of a number */
    ct_status (*set)(const struct SettingRow *row, void *value, const char *text, ct_error *error);
    void (*show)(const void *value, FILE *out);
    size_t at; /* of its value in Settings */
} SettingRow;

static ct_status set_number(const SettingRow *row, void *value, const char *text, ct_error *error)
{
    char *end;
    const long got = strtol(text, &end, 10);

    if (end == text || *end != '\0' || got < row->low || got > row->high)
        return error_set(error, "'%s' is no whole number from %d to %d", text, row->low, row->high);
    *(int *)value = (int)got;
    return CT_OK;
}

static void show_number(const void *value, FILE *out)
{
    fprintf(out, "%d", *(const int *)value);
}

static ct_status set_word(const SettingRow *row, void *value, const char *text, ct_error *error)
{
    if (strlen(text) >= SETTING_WORD ||
        text[strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789")] != '\0')
        return error_set(error, "%s takes a word, not '%s'", row->words[0], text);
    memcpy(value, text, strlen(text) + 1);
    return CT_OK;
}

static void show_word(const void *value, FILE *out)
{
    fputs(value, out);
}

static ct_status set_units(const SettingRow *row, void *value, const char *text, ct_error *error)
{
    (void)row;
    if (strlen(text) >= SETTING_UNITS)
        return error_set(error, "that are too many units");
    if (strcmp(text, "SI") != 0 && ct_check_units(text, error) != CT_OK)
        return CT_FAILED;
    memcpy(value, text, strlen(text) + 1);
    return CT_OK;
}

static ct_status set_switch(const SettingRow *row, void *value, const char *text, ct_error *error)
{
    if (strcmp(text, "on") != 0 && strcmp(text, "off") != 0)
        return error_set(error, "%s is on or off, not '%s'", row->words[0], text);
    *(bool *)value = strcmp(text, "on") == 0;
    return CT_OK;
}

static void show_switch(const void *value, FILE *out)
{
    fputs(*(const bool *)value ? "on" : "off", out);
}

#define WORDS(...)  ((const char *const[]){__VA_ARGS__, NULL})
#define PLACE(name) offsetof(Settings, name)

static const SettingRow table[] = {
#define NUMBER(name, start, low, high, brief)                                                      \
    {WORDS(#name), brief, low, high, set_number, show_number, PLACE(name)},
#define WORD(name, start, brief, ...)                                                              \
    {WORDS(#name, __VA_ARGS__), brief, 0, 0, set_word, show_word, PLACE(name)},
#define SWITCH(name, start, brief)                                                                 \
    {WORDS(#name, "on", "off"), brief, 0, 0, set_switch, show_switch, PLACE(name)},
#define UNITS(name, start, brief, ...)                                                             \
    {WORDS(#name, __VA_ARGS__), brief, 0, 0, set_units, show_word, PLACE(name)},
#include "settings.def"
};
enum { SETTINGS = sizeof table / sizeof table[0] };

void settings_start(Settings *settings)
{
    *settings = (Settings){
#define NUMBER(name, start, ...) .name = start,
#define WORD(name, start, ...)   .name = start,
#define SWITCH(name, start, ...) .name = start,
#define UNITS(name, start, ...)  .name = start,
#include "settings.def"
    };
}

/* the name that a `set` statement sets: `set digits 10` or `set digits = 10` */
static const char *name_set(const ct_statement *statement, const ct_expression **value)
{
    if (ct_key_count(statement) > 0)
        return ct_key(statement, 0, value);
    if (ct_operand_count(statement) == 0)
        return NULL;
    *value = ct_operand_count(statement) > 1 ? ct_operand(statement, 1) : NULL;
    return ct_expression_word(ct_operand(statement, 0));
}

static const SettingRow *find(const char *name)
{
    for (int i = 0; name != NULL && i < SETTINGS; i++)
        if (strcmp(table[i].words[0], name) == 0)
            return &table[i];
    return NULL;
}

ct_status settings_set(Settings *settings, const char *name, const char *value, ct_error *error)
{
    const SettingRow *row = find(name);

    return row->set(row, (char *)settings + row->at, value, error);
}

bool settings_own(const ct_statement *statement)
{
    const ct_expression *value;

    return find(name_set(statement, &value)) != NULL;
}

/* the value, and further ones as in `set units deg mm`, `count` of them */
static char *value_text(const ct_statement *statement, const ct_expression *value, int count)
{
    char *text = copy_text("");

    for (int i = 1; value != NULL && i <= count; i++) {
        char *next = check_allocated(ct_expression_text(value));
        char *both = copy_format("%s%s%s", text, i > 1 ? " " : "", next);

        ct_free(next);
        free(text);
        text = both;
        value = i + 1 < ct_operand_count(statement) ? ct_operand(statement, i + 1) : NULL;
    }
    return text;
}

void settings_report_dropped(const Settings *old, const Settings *settings)
{
    const char *before = old->units, *after = settings->units;
    char *both = copy_text(strcmp(after, "SI") != 0 ? after : "");
    char *dropped = copy_text("");

    for (const char *at = before; strcmp(before, "SI") != 0 && *at != '\0'; at += *at == ' ') {
        const int length = (int)strcspn(at, " ");
        char *more = copy_format("%s %.*s", both, length, at);
        ct_error ignored;

        /* a unit that fits among the others has none of its kind there */
        if (*both != '\0' && ct_check_units(more, &ignored) == CT_OK) {
            char *longer =
                copy_format("%s%s%.*s", dropped, *dropped != '\0' ? " " : "", length, at);

            free(dropped);
            dropped = longer;
        }
        free(more);
        at += length;
    }
    if (*dropped != '\0')
        remark("no longer shown in %s: 'set units %s %s' has both", dropped, after, dropped);
    free(both);
    free(dropped);
}

ct_status settings_apply(Settings *settings, const ct_statement *statement, ct_error *error)
{
    const ct_expression *value = NULL;
    const SettingRow *row = find(name_set(statement, &value));
    const int count = ct_operand_count(statement) > 1 ? ct_operand_count(statement) - 1 : 1;
    Settings after = *settings;
    ct_status status = CT_OK;

    if (value == NULL || (count > 1 && row->set != set_units)) {
        ct_error_at(statement, NULL, error, "'%s' is set to %s: set %s %s", row->words[0],
                    row->set == set_units ? "words" : "one value", row->words[0],
                    row->set == set_units ? "mm deg" : "VALUE");
        return CT_FAILED;
    }

    /* one more at a time: the last one is at fault */
    for (int i = 1; i <= count && status == CT_OK; i++) {
        char *text = value_text(statement, value, i);
        ct_error why;

        status = row->set(row, (char *)&after + row->at, text, &why);
        if (status != CT_OK)
            status = ct_error_at(statement, i > 1 ? ct_operand(statement, i) : value, error, "%s",
                                 why.message);
        free(text);
    }
    if (status == CT_OK)
        *settings = after;
    return status;
}

const char *const *settings_words(int i)
{
    return i >= 0 && i < SETTINGS ? table[i].words : NULL;
}

void settings_show(const Settings *settings, FILE *out)
{
    for (int i = 0; i < SETTINGS; i++) {
        fprintf(out, "%-9s  ", table[i].words[0]);
        table[i].show((const char *)settings + table[i].at, out);
        fprintf(out, "  (%s)\n", table[i].brief);
    }
}
