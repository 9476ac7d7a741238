/* stage.c: which stage of a program computes what depends on a kind of symbol */
#include "compile/program.h"

#include <assert.h>

Stage stage_of_symbol(SymbolKind kind)
{
    static const int stages[] = {
        [SYMBOL_PARAMETER] = STAGE_PARAMETER,
        [SYMBOL_TIME] = STAGE_TIME,
        [SYMBOL_COORDINATE] = STAGE_POSITION,
        [SYMBOL_SPEED] = STAGE_VELOCITY,
        [SYMBOL_STATE] = STAGE_VELOCITY,
        [SYMBOL_ALGEBRAIC] = STAGE_NETWORK,
        [SYMBOL_ACCELERATION] = STAGE_ACCELERATION,
        [SYMBOL_STATE_RATE] = STAGE_NETWORK,
        [SYMBOL_MULTIPLIER] = STAGE_ACCELERATION,
        [SYMBOL_EFFORT] = STAGE_ACCELERATION,
        [SYMBOL_JERK] = STAGE_ACCELERATION,
        [SYMBOL_TURN] = STAGE_POSITION,
        [SYMBOL_VARIABLE] = -1,
        [SYMBOL_ARGUMENT] = -1,
        [SYMBOL_TABLE] = -1,
    };

    assert(stages[kind] >= 0);
    return (Stage)stages[kind];
}

Stage stage_of(Expr e)
{
    unsigned kinds = expr_kinds(e);
    Stage stage = STAGE_PARAMETER;

    for (int kind = 0; kinds >> kind != 0; kind++) {
        if ((kinds >> kind & 1) != 0 && stage_of_symbol((SymbolKind)kind) > stage)
            stage = stage_of_symbol((SymbolKind)kind);
    }
    return stage;
}
