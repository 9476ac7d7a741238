/* resolve.c: expressions over the user's named quantities, in the system's variables
 *
 * The laws of parts read such quantities, and laws determine quantities: variables.c has the table
 * of these, and is called through the system. */
#include "formulate/system/resolve.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

#include <string.h>

Status system_wait_for_motion(System *system, Diag *diag)
{
    if (!system->is_early)
        return OK;
    system->asked_early = true;
    return diag_set(diag, E_MISSING, "what the network reads here follows from forces");
}

static Status resolve_symbol(System *system, Expr symbol, Expr *out, Diag *diag)
{
    const char *name = expr_name(symbol);
    size_t length = strlen(name);
    int primes = 0;
    Status status;
    char *path;

    for (; length > 0 && name[length - 1] == '\''; length--)
        primes++;
    path = mem_text(name, length);
    status = system->variable(system, path, primes, out, diag);
    if (status != OK)
        diag_about(diag, "%s", path);
    mem_free(path);
    return status;
}

static Status resolve_all(System *system, Expr user, Expr *out, Diag *diag)
{
    Expr *symbols, *values;
    const int count = expr_symbols(&user, 1, &symbols);
    int used = 0;
    Status status = OK;

    values = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++) {
        if (expr_symbol_kind(symbols[i]) != SYMBOL_VARIABLE)
            continue;
        symbols[used] = symbols[i];
        CHECK(resolve_symbol(system, symbols[used], &values[used], diag));
        used++;
    }
    *out = expr_substitute(system->arena, user, symbols, values, used);
done:
    MEM_FREE(symbols, values);
    return status;
}

Status variables_resolve(System *system, Expr user, Expr *out, Diag *diag)
{
    enum { DEEPEST = 40 };
    Status status;

    *out = user;
    if ((expr_kinds(user) & 1U << SYMBOL_VARIABLE) == 0)
        return OK;
    if (++system->shown->depth > DEEPEST) {
        system->shown->depth--;
        return diag_set(diag, E_MODEL, "the definitions of outputs or sources lead in a circle");
    }
    status = expr_kind(user) == EXPR_SYMBOL ? resolve_symbol(system, user, out, diag)
                                            : resolve_all(system, user, out, diag);
    system->shown->depth--;
    return status;
}

Status system_resolve(System *system, Expr user, Expr *out, Diag *diag)
{
    if (monitor_poll(system->watch) != OK)
        return diag_set(diag, E_STOPPED, "stopped");
    system_touch(system);
    return variables_resolve(system, user, out, diag);
}
