/* functions.h: the functions that expressions may call, and their arguments */
#ifndef COTREE_LANGUAGE_FUNCTIONS_H
#define COTREE_LANGUAGE_FUNCTIONS_H

#include "expr/expr.h"

typedef enum FunctionKind {
    FUNCTION_OPERATION, /* a row of ops.def */
    FUNCTION_SHAPE,     /* of time or data: the model builds it from operations */
    FUNCTION_FIGURE     /* of a whole run: only where its rows are looked at */
} FunctionKind;

typedef struct Function {
    const char *name;
    FunctionKind kind;
    int least, most;   /* arguments */
    const char *usage; /* NULL: it follows from the count */
    bool takes_text;   /* file names among its arguments */
    Op op;             /* of FUNCTION_OPERATION; OP_COUNT: none */
} Function;

/* Rows by value. min and max are operations of several arguments, and figures of one. */
bool function_at(int i, Function *row); /* 0, 1, ...; false at the end */
/* an operation or a shape; false: unknown, *row unchanged */
bool function_find(const char *name, Function *row);
bool function_is_figure(const char *name); /* of one argument: min max mean rms */
bool function_takes_text(const char *name);

#endif
