/* multi_turn_build.c: turns of chords that are determined by their sine s and cosine c, over any
 * number of turns
 *
 * Where the turns of a circuit don't merge about one axis, only s and c of a chord's angle are
 * known, and atan2(s, c) (rad) jumps by a full turn. The angle is the value nearest to a reference,
 * among all that differ by full turns. The reference is a symbol of its own that runs store in
 * addition to q. They integrate it by the angle's rate, and set it to the angle whenever they
 * project q onto the constraints. */
#include "formulate/kinematics/coordinate.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/multi_turn.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"

static Expr whole_symbol(System *system, const char *name)
{
    return expr_symbol(system->arena, system_join(system, "#turns of ", name), SYMBOL_PARAMETER);
}

static void add_counted(System *system, const Instance *joint, int coordinate, Expr sum)
{
    const char *name = joint->coord[coordinate];
    const CountedChord chord = {.reported = {name, -1, sum, whole_symbol(system, name)},
                                .instance = joint->number,
                                .coordinate = coordinate};

    LIST_PUSH(system->constraints->counted, chord);
}

void multi_turn_add_rows(System *system)
{
    for (int k = 0; k < system->constraints->rows.count; k++) {
        const Row *row = &system->constraints->rows.at[k];
        const char *const name = system->origin->instances[row->reported.instance].name;
        CountedChord chord = {.instance = -1, .coordinate = -1};

        if (row->kind != ROW_ANGLE)
            continue;
        chord.reported = (WholeTurns){
            NULL, k, row->phi, whole_symbol(system, system_retain(system, "row %d, %s", k, name))};
        LIST_PUSH(system->constraints->counted, chord);
        system->run.phi[k] = expr_add(system->arena, system->run.phi[k], chord.reported.symbol);
        if (system->definitions.phi != system->run.phi)
            system->definitions.phi[k] =
                expr_add(system->arena, system->definitions.phi[k], chord.reported.symbol);
    }
}

static void add_multi_turn(System *system, const Instance *joint, const Steps *steps, int which)
{
    Arena *arena = system->arena;
    int coordinate = steps->turn[which].coordinate;
    MultiTurnChord chord = {.instance = joint->number, .coordinate = coordinate};
    ChordTurn turn;

    chord_turn(system, joint, steps, which, &turn);
    if (turn.angle != NULL) {
        add_counted(system, joint, coordinate, turn.angle);
        return;
    }
    if (steps_are_tied(steps) && !joint->is_virtual)
        return; /* determined by the shift */
    chord.sine = turn.sine;
    chord.cosine = turn.cosine;
    chord.reported.name = joint->coord[coordinate];
    chord.reported.reference =
        expr_symbol(arena, system_join(system, chord.reported.name, ".near"), SYMBOL_TURN);
    chord.reported.angle =
        expr_call(arena, OP_UNWRAP, (Expr[]){turn.sine, turn.cosine, chord.reported.reference});
    LIST_PUSH(system->constraints->multi_turns, chord);
}

void multi_turn_build(System *system)
{
    for (int i = 0;
         i < system->origin->instance_count && system->origin->trees[TREE_ROTATION] != NULL; i++) {
        const Instance *joint = &system->origin->instances[i];
        Steps steps;

        if (joint->row->steps == NULL || joint->edge < 0 || joint->coord_count == 0)
            continue;
        instance_steps(system, joint, &steps);
        /* three turns of a chord have no angles that sine and cosine could determine */
        for (int k = 0; k < steps.turn_count && steps.turn_count < 3; k++)
            if (system->kinematics->coordinate[i][steps.turn[k].coordinate] < 0)
                add_multi_turn(system, joint, &steps, k);
    }
}

/* (c s' - s c') r/(r^2 + 1e-8) with r = s^2 + c^2. Where the joint's constraints hold, r is 1 and
 * this is c s' - s c' */
Status system_multi_turn_rate(System *system, int i, Expr *out, Diag *diag)
{
    system_touch(system);
    Arena *arena = system->arena;
    const MultiTurnChord *chord = &system->constraints->multi_turns.at[i];
    Expr sine_rate;
    Expr cosine_rate;
    Expr size;
    Expr **known = &system->shown->turn_rates;

    if (*known == NULL)
        *known = NEW_ARRAY(Expr, system->constraints->multi_turns.count);
    if ((*known)[i] != NULL) {
        *out = (*known)[i];
        return OK;
    }
    TRY(system_rate_of(system, chord->sine, &sine_rate, diag));
    TRY(system_rate_of(system, chord->cosine, &cosine_rate, diag));
    size = expr_name_temporary(
        arena, expr_add(arena, expr_square(arena, chord->sine), expr_square(arena, chord->cosine)));
    *out = expr_sub(arena, expr_mul(arena, chord->cosine, sine_rate),
                    expr_mul(arena, chord->sine, cosine_rate));
    size = expr_div(arena, size, expr_add(arena, expr_square(arena, size), expr_real(arena, 1e-8)));
    mem_keep(*known);
    *out = (*known)[i] = expr_mul(arena, *out, size);
    return OK;
}
