/* reinitialise_targets.c: what has a value behind an event: unknowns, or rows on their level */
#include "simulate/assemble/reinitialise_impl.h"

#include <math.h>

/* Positions are corrected in speeds: by that of a coordinate which has one of its own. */
static int column_of(const Reinit *reinit, const Target *target)
{
    const VariableIndex *l = reinit->plan.layout;
    Expr rate;

    if (target->place < 0 || target->level != LEVEL_POSITION || reinit->plan.equations->map == NULL)
        return target->place;
    rate = system_q_rate(l->system, target->place);
    for (int j = 0; j < l->nu; j++)
        if (l->symbols[l->u + j] == rate)
            return j;
    return -1;
}

void reinit_locate(const Reinit *reinit, Target *target)
{
    const VariableIndex *l = reinit->plan.layout;

    target->place = -1;
    for (int i = 0; i < level_count(l, target->level); i++)
        if (l->symbols[l->q + level_first(l, target->level) + i] == target->expr)
            target->place = i;
    target->column = column_of(reinit, target);
    target->multi_turn = -1;
    for (int k = 0; k < l->multi_turns; k++)
        if (system_multi_turn(l->system, k)->angle == target->expr)
            target->multi_turn = k;
}

bool reinit_is_chosen(const Reinit *reinit, int target, StateLevel level)
{
    return reinit->targets.at[target].level == level && !isnan(reinit->values[target]);
}

Rows reinit_rows(const Reinit *reinit, StateLevel level, bool direct)
{
    LevelRows *rows = reinit->levels[level];

    rows->t = reinit->t;
    rows->y = reinit->y;
    for (int k = 0; k < reinit->targets.count; k++) {
        const Target *target = &reinit->targets.at[k];
        const bool is_row = reinit_is_chosen(reinit, k, level) && (direct || target->column < 0);

        if (target->level == level)
            rows->target[target->row] = is_row ? reinit->values[k] : NAN;
    }
    return level_rows(rows, NULL);
}
