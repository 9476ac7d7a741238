/* settings.c: what the user can set about the shell itself, one row a setting */
#include "settings.h"

#include "complain.h"

#include <stdlib.h>
#include <string.h>

typedef struct Setting {
    const char *const *words; /* the name, the values that are words, NULL */
    const char *brief;
    ct_status (*set)(Settings *settings, const char *text, ct_error *error);
    void (*show)(const Settings *settings, FILE *out);
} Setting;

static bool read_whole(const char *text, long low, long high, long *value)
{
    char *end;
    long got = strtol(text, &end, 10);

    if (end == text || *end != '\0' || got < low || got > high)
        return false;
    *value = got;
    return true;
}

static ct_status set_digits(Settings *settings, const char *text, ct_error *error)
{
    long value;

    if (!read_whole(text, 1, 17, &value))
        return error_say(error, "digits are a whole number from 1 to 17, not '%s'", text);
    settings->digits = (int)value;
    return CT_OK;
}

static void show_digits(const Settings *settings, FILE *out)
{
    fprintf(out, "%d", settings->digits);
}

static ct_status set_terminal(Settings *settings, const char *text, ct_error *error)
{
    if (strlen(text) >= sizeof settings->terminal ||
        text[strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789")] != '\0')
        return error_say(error, "a terminal is auto, text, window or one of gnuplot's, not '%s'",
                         text);
    (void)snprintf(settings->terminal, sizeof settings->terminal, "%s", text);
    return CT_OK;
}

static void show_terminal(const Settings *settings, FILE *out)
{
    fputs(settings->terminal, out);
}

static ct_status set_pager(Settings *settings, const char *text, ct_error *error)
{
    if (strcmp(text, "on") != 0 && strcmp(text, "off") != 0)
        return error_say(error, "the pager is on or off, not '%s'", text);
    settings->pager = strcmp(text, "on") == 0;
    return CT_OK;
}

static void show_pager(const Settings *settings, FILE *out)
{
    fputs(settings->pager ? "on" : "off", out);
}

static ct_status set_seed(Settings *settings, const char *text, ct_error *error)
{
    if (!read_whole(text, 0, 2147483647, &settings->seed))
        return error_say(error, "a seed is a whole number from 0 to 2147483647, not '%s'", text);
    return CT_OK;
}

static void show_seed(const Settings *settings, FILE *out)
{
    fprintf(out, "%ld", settings->seed);
}

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* clang-format off */
static const Setting table[] = {
    {WORDS("digits"), "significant digits of printed numbers",              set_digits,   show_digits},
    {WORDS("terminal", "auto", "text", "window"), "of plots: auto, text, window or a name of gnuplot's", set_terminal, show_terminal},
    {WORDS("pager", "on", "off"), "whether text longer than the screen is paged", set_pager,    show_pager},
    {WORDS("seed"), "of random numbers", set_seed,     show_seed},
};
/* clang-format on */
enum { SETTINGS = sizeof table / sizeof table[0] };

void settings_start(Settings *settings)
{
    *settings = (Settings){.digits = 6, .terminal = "auto", .pager = 1, .seed = 1};
}

/* the name that a `set` statement sets: `set digits 10` or `set digits = 10` */
static const char *name_set(const ct_statement *statement, const ct_expression **value)
{
    if (ct_key_count(statement) > 0)
        return ct_key(statement, 0, value);
    if (ct_operand_count(statement) == 0)
        return NULL;
    *value = ct_operand_count(statement) == 2 ? ct_operand(statement, 1) : NULL;
    return ct_expression_word(ct_operand(statement, 0));
}

static const Setting *find(const char *name)
{
    for (int i = 0; name != NULL && i < SETTINGS; i++)
        if (strcmp(table[i].words[0], name) == 0)
            return &table[i];
    return NULL;
}

ct_status settings_set(Settings *settings, const char *name, const char *value, ct_error *error)
{
    return find(name)->set(settings, value, error);
}

bool settings_own(const ct_statement *statement)
{
    const ct_expression *value;

    return find(name_set(statement, &value)) != NULL;
}

ct_status settings_apply(Settings *settings, const ct_statement *statement, ct_error *error)
{
    const ct_expression *value = NULL;
    const Setting *row = find(name_set(statement, &value));

    if (value == NULL)
        return ct_error_at(statement, NULL, error, "'%s' is set to one value: set %s VALUE",
                           row->words[0], row->words[0]);

    char *text = ct_expression_text(value);
    ct_error why;
    ct_status status = row->set(settings, text, &why);

    if (status != CT_OK)
        status = ct_error_at(statement, value, error, "%s", why.message);
    ct_free(text);
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
        table[i].show(settings, out);
        fprintf(out, "  (%s)\n", table[i].brief);
    }
}
