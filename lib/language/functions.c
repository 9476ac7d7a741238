/* functions.c: the table of functions: operations of expressions, and what is made of them */
#include "language/functions.h"

#include "base/memory.h"

#include <ctype.h>
#include <limits.h>
#include <string.h>

static const struct {
    const char *name;
    int args;
    Op op;
} operations[] = {
#define OP(id, name, args, ...) {name, args, OP_##id},
#include "expr/ops.def"
#undef OP
};

static const Function others[] = {
    {"pulse", FUNCTION_SHAPE, 7, 8, "pulse(t, low, high, delay, rise, fall, width, period)", false,
     OP_COUNT},
    {"pwl", FUNCTION_SHAPE, 3, 10001, "pwl(t, t0, v0, t1, v1, ...)", false, OP_COUNT},
    {"table", FUNCTION_SHAPE, 2, 4, "table(\"file.csv\", x, column)", true, OP_COUNT},
    {"mean", FUNCTION_FIGURE, 1, 1, NULL, false, OP_COUNT},
    {"rms", FUNCTION_FIGURE, 1, 1, NULL, false, OP_COUNT},
    {"final", FUNCTION_FIGURE, 1, 1, NULL, false, OP_COUNT},
    {"first", FUNCTION_FIGURE, 1, 1, NULL, false, OP_COUNT},
    {"period", FUNCTION_FIGURE, 1, 1, NULL, false, OP_COUNT},
    {"settling", FUNCTION_FIGURE, 2, 2, NULL, false, OP_COUNT},
    {"spectrum", FUNCTION_FIGURE, 1, 1, NULL, false, OP_COUNT},
};

/* operators can't be called by name; `hold` occurs in equations only */
static bool is_called(const char *name)
{
    return isalpha((unsigned char)name[0]) && strcmp(name, "hold") != 0;
}

/* min and max have two or more arguments */
static bool folds(Op op)
{
    return op == OP_MIN || op == OP_MAX;
}

/* most differ in their first letter */
static bool is_same(const char *a, const char *b)
{
    return a[0] == b[0] && strcmp(a, b) == 0;
}

static Function operation(int i)
{
    return (Function){.name = operations[i].name,
                      .kind = FUNCTION_OPERATION,
                      .least = operations[i].args,
                      .most = folds(operations[i].op) ? INT_MAX : operations[i].args,
                      .op = operations[i].op};
}

bool function_at(int i, Function *row)
{
    for (int k = 0; k < COUNT(operations); k++)
        if (is_called(operations[k].name) && i-- == 0) {
            *row = operation(k);
            return true;
        }
    if (i >= COUNT(others))
        return false;
    *row = others[i];
    return true;
}

bool function_find(const char *name, Function *row)
{
    for (int i = 0; i < COUNT(operations) && is_called(name); i++)
        if (is_same(operations[i].name, name)) {
            *row = operation(i);
            return true;
        }
    for (int i = 0; i < COUNT(others); i++)
        if (others[i].kind != FUNCTION_FIGURE && is_same(others[i].name, name)) {
            *row = others[i];
            return true;
        }
    return false;
}

bool function_is_figure(const char *name)
{
    Function row;

    for (int i = 0; i < COUNT(others); i++)
        if (others[i].kind == FUNCTION_FIGURE && is_same(others[i].name, name))
            return true;
    return function_find(name, &row) && row.kind == FUNCTION_OPERATION && folds(row.op);
}

bool function_takes_text(const char *name)
{
    Function row;

    return function_find(name, &row) && row.takes_text;
}
