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

int code_newton_rows(Code *code, const Expr *residuals, int first, int count, const char *name,
                     const char *what)
{
    int function;
    Arena *arena = code->arena;
    const VariableIndex *l = code->layout;
    const int width = count + 1;
    Expr *rows = NEW_ARRAY(Expr, count * width);
    Expr *unknowns = NEW_ARRAY(Expr, count);

    for (int k = 0; k < count; k++) {
        const int at = first + k;

        /* x', z, u' and lambda are consecutive in the layout, too */
        unknowns[k] = l->symbols[l->rates + at];
    }
    for (int i = 0; i < count; i++) {
        Expr *symbols = NULL;
        const int found = expr_symbols(&residuals[i], 1, &symbols);

        for (int k = 0; k < count; k++)
            rows[i * width + k] = expr_int(arena, 0);
        for (int e = 0; e < found; e++)
            for (int k = 0; k < count; k++)
                if (unknowns[k] == symbols[e])
                    rows[i * width + k] = expr_diff(arena, residuals[i], symbols[e]);
        rows[i * width + count] = expr_neg(arena, residuals[i]);
        mem_free(symbols);
    }
    function = code_add_function(code, name, what, rows, count, width);
    MEM_FREE(rows, unknowns);
    return function;
}

void code_add_newton(Code *code, const Expr *residuals, int count, const char *name)
{
    const int function =
        code_newton_rows(code, residuals, 0, count, name, "rows of [A | b] in A ds = b");

    code->groups[code->group_count++] = (CodeGroup){0, count, function, true};
}
