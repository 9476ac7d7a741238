/* command_call.c: what the functions of commands share */
#include "command_call.h"

#include "file.h"

#include <stdlib.h>
#include <string.h>

void write_text(FILE *out, const char *text)
{
    size_t length = strlen(text);

    fwrite(text, 1, length, out);
    if (length > 0 && text[length - 1] != '\n')
        fputc('\n', out);
}

ct_status csv_rows(const Call *call, const char *text, const char **rows, ct_error *error)
{
    const size_t header = strcspn(text, "\n");
    bool append = false;
    const char *path = ct_redirect(call->statement, &append);
    char *columns = append ? file_first_line(path) : NULL;
    const bool is_new = columns == NULL || *columns == '\0';
    ct_status status = CT_OK;

    *rows = is_new ? text : text + header + 1;
    if (!is_new && (strlen(columns) != header || strncmp(columns, text, header) != 0)) {
        status = ct_error_at(call->statement, NULL, error,
                             "nothing is appended: the columns of '%s' are others", path);
        error_hint(error, "it has %.300s", columns);
    }
    free(columns);
    return status;
}

const char *call_word(const Call *call, int i)
{
    return i < ct_operand_count(call->statement)
               ? ct_expression_word(ct_operand(call->statement, i))
               : NULL;
}
