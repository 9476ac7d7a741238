/* command.c: the tables of commands, and finding the row of a statement */
#include "command.h"

#include <string.h>

static const Command *const tables[] = {commands_look, commands_run,  commands_session,
                                        commands_plot, commands_bode, commands_draw,
                                        commands_shell};

const Command *command_find(const ct_statement *statement)
{
    static const Command run = {"", command_run, NULL, 0};
    const char *verb = ct_verb(statement);

    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++)
        for (const Command *row = tables[i]; row->verb != NULL; row++)
            if (strcmp(row->verb, verb) == 0 &&
                (row->takes != NULL ? row->takes(statement) : ct_carrier(statement) == CT_CALLER))
                return row;
    return ct_carrier(statement) == CT_SESSION ? &run : NULL;
}
