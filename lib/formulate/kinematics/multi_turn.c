/* multi_turn.c: turns of chords over any number of turns, as they were told (multi_turn_build.c) */
#include "formulate/kinematics/multi_turn.h"
#include "formulate/system/constraints.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

Expr multi_turn_whole(const System *system, int instance, int coordinate)
{
    for (int i = 0; i < system->constraints->counted.count; i++)
        if (system->constraints->counted.at[i].instance == instance &&
            system->constraints->counted.at[i].coordinate == coordinate)
            return system->constraints->counted.at[i].told.symbol;
    return expr_int(system->arena, 0);
}

int system_whole_turns_count(const System *system)
{
    return system->constraints->counted.count;
}

const WholeTurns *system_whole_turns(const System *system, int i)
{
    return &system->constraints->counted.at[i].told;
}

Expr system_plain(const System *system, Expr e)
{
    const Origin *origin = system->origin;
    const int turns = system->constraints->counted.count, count = turns + origin->literals;
    Expr *symbols, *values;

    if (count == 0 || (expr_kinds(e) & 1U << SYMBOL_PARAMETER) == 0)
        return e;
    symbols = NEW_ARRAY(Expr, count);
    values = NEW_ARRAY(Expr, count);
    for (int i = 0; i < turns; i++) {
        symbols[i] = system->constraints->counted.at[i].told.symbol;
        values[i] = expr_int(system->arena, 0);
    }
    for (int i = 1; i <= origin->literals; i++) {
        const GivenParameter *literal = &origin->parameters.at[origin->parameters.count - i];

        symbols[count - i] = literal->symbol;
        values[count - i] = expr_real(system->arena, literal->value);
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

    return chord != NULL ? chord->told.angle : NULL;
}

void multi_turn_drive(System *system, int instance, int coordinate, Expr prescribed)
{
    MultiTurnChord *chord = find(system, instance, coordinate);

    if (chord != NULL)
        chord->told.prescribed = prescribed;
}

int system_multi_turn_count(const System *system)
{
    return system->constraints->multi_turns.count;
}

const MultiTurn *system_multi_turn(const System *system, int i)
{
    return &system->constraints->multi_turns.at[i].told;
}

const AngleOff *system_angle_off(const System *system, int i)
{
    return i < system->constraints->angles_off.count ? &system->constraints->angles_off.at[i]
                                                     : NULL;
}
