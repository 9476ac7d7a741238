/* multi_turn.c: multi-turn angles of chords, as multi_turn_build.c determined them */
#include "formulate/kinematics/multi_turn.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

#include <string.h>

Expr multi_turn_whole(const System *system, int instance, int coordinate)
{
    for (int i = 0; i < system->constraints->counted.count; i++)
        if (system->constraints->counted.at[i].instance == instance &&
            system->constraints->counted.at[i].coordinate == coordinate)
            return system->constraints->counted.at[i].reported.symbol;
    return expr_int(system->arena, 0);
}

int system_whole_turns_count(const System *system)
{
    return system->constraints->counted.count;
}

const WholeTurns *system_whole_turns(const System *system, int i)
{
    return &system->constraints->counted.at[i].reported;
}

/* as an angle, in rad */
static Expr full_turns(const System *system, int i)
{
    const int *const turns = system->shown != NULL ? system->shown->full_turns : NULL;
    const int64_t halves = turns != NULL ? 2 * (int64_t)turns[i] : 0;

    return expr_mul(system->arena, expr_int(system->arena, halves), expr_pi(system->arena, 1));
}

void system_show_turns(System *view, const int *turns)
{
    const int count = view->constraints->counted.count;

    system_touch(view);
    mem_free(view->shown->full_turns);
    view->shown->full_turns = NULL;
    if (turns == NULL || count == 0)
        return;
    view->shown->full_turns = NEW_ARRAY(int, count);
    memcpy(view->shown->full_turns, turns, (size_t)count * sizeof(int));
}

static bool reads_any(const System *system, const Expr *roots, int count)
{
    Expr *symbols = NULL;
    const int found = expr_symbols(roots, count, &symbols);
    bool reads = false;

    for (int i = 0; i < system->constraints->counted.count && !reads; i++)
        for (int k = 0; k < found && !reads; k++)
            reads = symbols[k] == system->constraints->counted.at[i].reported.symbol;
    mem_free(symbols);
    return reads;
}

bool system_reads_turns(const System *system)
{
    const EquationForm *run = &system->run;

    return system->constraints->counted.count > 0 &&
           (reads_any(system, run->phi, system->constraints->rows.count) ||
            reads_any(system, run->force, system->kinematics->u.count) ||
            reads_any(system, run->network_residual, system_nx(system) + system_nz(system)) ||
            reads_any(system, run->network_rhs, system_nx(system) + system_nz(system)));
}

Expr system_plain(const System *system, Expr e)
{
    const Origin *origin = system->origin;
    const int turns = system->constraints->counted.count, count = turns + origin->lifted_count;
    Expr *symbols, *values;

    if (count == 0 || (expr_kinds(e) & 1U << SYMBOL_PARAMETER) == 0)
        return e;
    symbols = NEW_ARRAY(Expr, count);
    values = NEW_ARRAY(Expr, count);
    for (int i = 0; i < turns; i++) {
        symbols[i] = system->constraints->counted.at[i].reported.symbol;
        values[i] = full_turns(system, i);
    }
    for (int i = 1; i <= origin->lifted_count; i++) {
        const GivenParameter *lifted = &origin->parameters.at[origin->parameters.count - i];

        symbols[count - i] = lifted->symbol;
        values[count - i] = expr_real(system->arena, lifted->value);
    }
    e = expr_substitute(system->arena, e, symbols, values, count);
    MEM_FREE(symbols, values);
    return e;
}

static MultiTurnChord *find(const System *system, int instance, int coordinate)
{
    for (int i = 0; i < system->constraints->multi_turns.count; i++)
        if (system->constraints->multi_turns.at[i].instance == instance &&
            system->constraints->multi_turns.at[i].coordinate == coordinate)
            return &system->constraints->multi_turns.at[i];
    return NULL;
}

Expr multi_turn_angle(const System *system, int instance, int coordinate)
{
    const MultiTurnChord *chord = find(system, instance, coordinate);

    return chord != NULL ? chord->reported.angle : NULL;
}

void multi_turn_drive(System *system, int instance, int coordinate, Expr prescribed)
{
    MultiTurnChord *chord = find(system, instance, coordinate);

    if (chord != NULL)
        chord->reported.prescribed = prescribed;
}

int system_multi_turn_count(const System *system)
{
    return system->constraints->multi_turns.count;
}

const MultiTurn *system_multi_turn(const System *system, int i)
{
    return &system->constraints->multi_turns.at[i].reported;
}

const AngleOff *system_angle_off(const System *system, int i)
{
    return i < system->constraints->angles_off.count ? &system->constraints->angles_off.at[i]
                                                     : NULL;
}
