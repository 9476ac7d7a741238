/* multi_turn.c: turns of chords over any number of turns, as they were told (multi_turn_build.c) */
#include "formulate/constraints.h"
#include "formulate/system_impl.h"

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
    int count = system->constraints->counted.count;
    Expr *symbols;

    if (count == 0 || (expr_kinds(e) & 1U << SYMBOL_PARAMETER) == 0)
        return e;
    symbols = NEW_ARRAY(Expr, count);
    for (int i = 0; i < count; i++)
        symbols[i] = system->constraints->counted.at[i].told.symbol;
    e = expr_substitute(system->arena, e, symbols, NULL, count);
    mem_free(symbols);
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
