/* code_function.c: functions of exported code, one by one, and formulas of the user's in them */
#include "export/code.h"

int code_add_function(Code *code, const char *name, const char *what, const Expr *entries, int rows,
                      int columns)
{
    LIST_PUSH(code->functions,
              (CodeFunction){name, what, code->roots.count, rows, columns, columns != 1});
    for (int i = 0; i < rows * columns; i++)
        LIST_PUSH(code->roots, entries[i]);
    return code->functions.count - 1;
}

Status code_resolve(Code *code, Expr user, Expr *out, const char *name, Diag *diag)
{
    Status status = system_resolve(code->layout->system, user, out, diag);
    Expr *symbols = NULL;
    int count;

    if (status != OK)
        return status;
    count = expr_symbols(out, 1, &symbols);
    for (int i = 0; status == OK && i < count; i++) {
        const SymbolKind kind = expr_symbol_kind(symbols[i]);

        if (kind == SYMBOL_EFFORT || kind == SYMBOL_JERK || kind == SYMBOL_VARIABLE)
            status = diag_set(diag, E_MISSING, "%s depends on %s, which exported code is not given",
                              name, expr_name(symbols[i]));
    }
    mem_free(symbols);
    return status;
}
