/* session_sweep_sets.c: sets of parameters from a file of rows
 *
 * The first line names the parameters, each perhaps with its unit: "L [mm], m". The others have
 * their numbers. Cells are separated by commas or semicolons, or by blanks where there are neither;
 * lines that begin with # are comments. */
#include "session/session_sweep.h"

#include <math.h>
#include <stdlib.h>

typedef struct SetsReader {
    const Syntax *file;
    SweepSets *sets;
    int line;
    Diag *diag;
} SetsReader;

void sweep_sets_free(SweepSets *sets)
{
    for (int i = 0; i < sets->names.count; i++)
        mem_free(sets->names.at[i]);
    LIST_FREE(sets->names);
    LIST_FREE(sets->values);
    LIST_FREE(sets->units);
}

/* a cell of the first line */
static Status read_head(SetsReader *r, char *cell)
{
    char *open = strchr(cell, '[');
    Unit unit = {.factor = 0};
    size_t length, fault;

    if (open != NULL) {
        char *close = strchr(open, ']');

        if (close == NULL || close[1 + strspn(close + 1, " \t\r")] != '\0' ||
            !unit_parse(open + 1, (size_t)(close - open) - 1, &unit, &fault))
            return diag_at(r->diag, E_UNIT, r->file->place, "line %d of '%s': '%s' is no unit",
                           r->line, r->file->text, open);
        *open = '\0';
    }
    length = strlen(cell);
    while (length > 0 && strchr(" \t\r", cell[length - 1]) != NULL)
        length--;
    LIST_PUSH(r->sets->names, mem_text(cell, length));
    LIST_PUSH(r->sets->units, unit);
    return OK;
}

static Status read_number(SetsReader *r, const char *cell, int column)
{
    const Unit *unit = &r->sets->units.at[column];
    char *end;
    const double value = strtod(cell, &end);

    if (end == cell || end[strspn(end, " \t\r")] != '\0' || !isfinite(value)) {
        (void)diag_at(r->diag, E_VALUE, r->file->place, "line %d of '%s': '%s' is no number",
                      r->line, r->file->text, cell);
        diag_hint(r->diag, "the first line names the parameters, the others have their values");
        return E_VALUE;
    }
    LIST_PUSH(r->sets->values, unit->factor != 0 ? value * unit->factor : value);
    return OK;
}

/* the end of a cell that begins at `at`; a unit in brackets may follow a blank */
static char *cell_end(char *at, const char *separators)
{
    char *end = at + strcspn(at, separators);

    if (separators[0] == ' ' && end[strspn(end, " \t")] == '[') {
        end += strcspn(end, "]");
        end += *end != '\0';
    }
    return end;
}

static Status read_line(SetsReader *r, char *line)
{
    const char *separators = strpbrk(line, ",;") != NULL ? ",;" : " \t";
    const bool is_head = r->sets->names.count == 0;
    char *at = line + strspn(line, " \t\r");
    int cells = 0;

    if (*at == '\0' || *at == '#')
        return OK;
    at[strcspn(at, "\r")] = '\0';
    while (*at != '\0') {
        char *end = cell_end(at, separators);
        char *next = end + (*end != '\0');

        *end = '\0';
        if (is_head)
            TRY(read_head(r, at));
        else if (cells < r->sets->names.count)
            TRY(read_number(r, at, cells));
        cells++;
        at = next + strspn(next, " \t");
    }
    if (!is_head && cells != r->sets->names.count)
        return diag_at(r->diag, E_VALUE, r->file->place,
                       "line %d of '%s' has %d value%s, and the first line %d name%s", r->line,
                       r->file->text, cells, cells == 1 ? "" : "s", r->sets->names.count,
                       r->sets->names.count == 1 ? "" : "s");
    r->sets->rows += !is_head;
    return OK;
}

Status sweep_sets_read(ct_session *session, const Syntax *file, SweepSets *out, Diag *diag)
{
    SetsReader r = {.file = file, .sets = out, .diag = diag};
    Text text = {0};
    char *at;
    Status status = OK;

    if (file->kind != SYNTAX_STRING) {
        status = diag_at(diag, E_VALUE, file->place, "sets= is the name of a file");
        diag_hint(diag, "sets=\"sets.csv\"");
        goto done;
    }
    CHECK(session_read_file(session, file, &text, diag));
    at = text.at;
    while (at != NULL && *at != '\0') {
        char *end = at + strcspn(at, "\n");
        char *next = end + (*end != '\0');

        *end = '\0';
        r.line++;
        CHECK(read_line(&r, at));
        at = next;
    }
    if (out->rows == 0) {
        status = diag_at(diag, E_VALUE, file->place, "'%s' has no sets", file->text);
        diag_hint(diag, "the first line names the parameters, the others have their values");
    }
done:
    text_free(&text);
    return status;
}
