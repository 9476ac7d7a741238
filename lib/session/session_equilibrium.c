/* session_equilibrium.c: an equilibrium becomes the start of the model */
#include "session/session_impl.h"

#include <math.h>

/* the unknowns whose values repeat a configuration */
typedef struct Unknowns {
    LIST(const char *) names;
    LIST(Expr) symbols;
} Unknowns;

static void add_unknown(Unknowns *unknowns, const char *name, Expr symbol)
{
    LIST_PUSH(unknowns->names, name);
    LIST_PUSH(unknowns->symbols, symbol);
}

static void list_unknowns(const System *system, Unknowns *out)
{
    for (int i = 0; i < system_n(system); i++)
        add_unknown(out, system_q(system, i)->name, system_q(system, i)->symbol);
    for (int i = 0; i < system_multi_turn_count(system); i++)
        add_unknown(out, system_multi_turn(system, i)->name, system_multi_turn(system, i)->angle);
    for (int i = 0; i < system_whole_turns_count(system); i++)
        if (system_whole_turns(system, i)->name != NULL)
            add_unknown(out, system_whole_turns(system, i)->name,
                        system_whole_turns(system, i)->sum);
    for (int i = 0; i < system_nx(system); i++)
        add_unknown(out, system_x(system, i)->name, system_x(system, i)->symbol);
    for (int i = 0; i < system_nz(system); i++)
        add_unknown(out, system_z(system, i)->name, system_z(system, i)->symbol);
}

/* Statements that set the equilibrium as initial state, to all digits. A variable without a value
 * in the mode at rest, as the current of a switch that is solved for separately, is omitted; the
 * next assembly determines it. */
static Status write_starts(const Run *equilibrium, Text *out, Diag *diag)
{
    Unknowns unknowns = {0};
    int written = 0;
    Status status = OK;

    list_unknowns(result_system(equilibrium->result), &unknowns);
    text_add(out, "init none\nguess none");
    for (int i = 0; i < unknowns.names.count; i++) {
        Diag why = {0};
        double value;

        status =
            result_reader_values(equilibrium->reader, &unknowns.symbols.at[i], 1, &value, &why);
        if (status == E_STOPPED || status == E_MEMORY) {
            *diag = why;
            goto done;
        }
        if (status == OK && isfinite(value))
            text_addf(out, "%s%s = %.17g", written++ == 0 ? "\nguess " : ", ", unknowns.names.at[i],
                      value);
    }
    text_char(out, '\n');
    status = OK;
done:
    LIST_FREE(unknowns.names);
    LIST_FREE(unknowns.symbols);
    return status;
}

Status session_store_equilibrium(ct_session *session, const Run *equilibrium, const char *called,
                                 Diag *diag)
{
    const uint64_t revision = model_revision(session->model);
    const int group = model_begin_group(session->model);
    Text text = {0};
    int count = 0;
    Status status;

    CHECK(write_starts(equilibrium, &text, diag));
    CHECK(session_apply_text(session->model, text.at, &count, diag));
done:
    session_end_group(session, group, called, revision, status == OK);
    text_free(&text);
    return status;
}
