/* command.c: finding the row of a statement, and what commands share */
#include "command.h"

#include <string.h>

static bool has_no_operand(const ct_statement *statement)
{
    return ct_operand_count(statement) == 0;
}

static const Command table[] = {
#define COMMAND(verb, run, takes, flags) {verb, run, takes, flags},
#include "commands.def"
#undef COMMAND
};

const Command *command_find(const ct_statement *statement)
{
    const char *verb = ct_verb(statement);

    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        if (strcmp(table[i].verb, verb) == 0)
            return table[i].takes == NULL || table[i].takes(statement) ? &table[i] : NULL;
    return NULL;
}

void put_text(FILE *out, const char *text)
{
    size_t length = strlen(text);

    fwrite(text, 1, length, out);
    if (length > 0 && text[length - 1] != '\n')
        fputc('\n', out);
}

const char *call_word(const Call *call, int i)
{
    return i < ct_operand_count(call->statement)
               ? ct_expression_word(ct_operand(call->statement, i))
               : NULL;
}
