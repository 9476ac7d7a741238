/* compiled_equations_impl.h: the compiled equations, and the conditions that a run monitors */
#ifndef COTREE_SIMULATE_EQUATIONS_COMPILED_EQUATIONS_IMPL_H
#define COTREE_SIMULATE_EQUATIONS_COMPILED_EQUATIONS_IMPL_H

#include "base/memory.h"
#include "simulate/equations/articulated.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/elimination.h"
#include "simulate/equations/mass_matrix.h"

typedef LIST(Expr) CompiledRoots;

/* the two conditions of a surface whose sign is an input */
typedef struct SurfaceGuards {
    int first;
    Stage stage; /* of its measure */
} SurfaceGuards;

struct CompiledEquations {
    Equations eq;
    const VariableIndex *layout;
    Parameters *parameters;
    Probe *main, *switching, *network;
    Pattern rows, masses, maps; /* positions of the entries of Phi_u, M and N */
    /* M. NULL: M is symbolic, and a program computes it. Otherwise a MassMatrix does, from roots:
     * those of the main program from mass_needs on; or, where elimination needs no M, those of
     * `massing`, which is made once M is requested. */
    MassMatrix *mass;
    Articulated *articulated;
    Probe *massing;
    Probe *rates; /* rates by t, q and u alone, where rows are eliminated; NULL: none */
    int mass_needs;
    EliminatedBy eliminated_by;          /* whether and how the main program eliminates M itself */
    bool is_articulated, is_mass_old;    /* the factorisation is valid; M is of another position */
    bool is_mass_constant, is_mass_kept; /* with the current parameters, as of free bodies */
    const double *eliminated_accelerations; /* of the main program, with rounding indicators */
    Eliminated eliminated;                  /* of constrained speeds, */
    const double *eliminated_excess, *eliminated_step;
    int *eliminated_rows; /* for these rows */
    ConstrainedPlaces eliminated_places;
    /* layout of the values of `rates`: whether they include q'; index and number of the rounding
     * indicators */
    bool has_rates_of_q;
    int rates_excess, rates_pivots;
    SignRange *sign_ranges;    /* of the signs of surfaces that the motion slides along */
    Probe *slip;               /* of all surfaces: slip of each, then `off` of each */
    SurfaceGuards *of_surface; /* of each surface */
    Guard *guards;             /* of the conditions, in the current mode; */
    Expr *shown_guards;        /* the expressions that users see for these; NULL: margins */
    bool guards_read_network;  /* in modes that slide along no surface, */
    bool guards_follow_time;   /* likewise */
    int *quaternions, *network_places;
    LIST(int) margins;   /* number of the switch that each belongs to */
    bool is_network_new; /* its program was run with the current t, q, u, x */
    double *magnitude_bound, *unit;
};

/* Compile roots that are already on their surfaces where they need to be. */
MUST_USE static inline Status compiled_compile(const VariableIndex *layout, Parameters *parameters,
                                               const CompiledRoots *roots, Probe **out, Diag *diag)
{
    const ProbeOrder order = {
        .roots = roots->at, .root_count = roots->count, .is_apart = true, .is_put = true};

    return probe_make(layout, parameters, &order, out, diag);
}

/* --- compiled_calls.c --- */

/* whether a program of their own computes M and F, once they are requested */
bool compiled_need_no_mass(const CompiledEquations *numbers);
/* Set the callbacks of the equations: those always present; those after the main program, where the
 * network and the power are known in these stages; those after the network's program; those after
 * the program of M. */
void compiled_connect(CompiledEquations *numbers);
void compiled_connect_equations(CompiledEquations *numbers, Stage network, Stage power);
void compiled_connect_network(CompiledEquations *numbers);
void compiled_connect_mass(CompiledEquations *numbers);

/* --- compiled_compile.c --- */

/* Compile the main program, and the network's where it is solved by iteration. The expressions
 * passed are `eliminated_count` closed-form accelerations and what comes with them; 0: there are
 * none. */
MUST_USE Status compiled_compile_equations(CompiledEquations *numbers,
                                           const Expr *eliminated_symbols, int eliminated_count,
                                           Diag *diag);
/* M and F, where elimination does without them */
MUST_USE Status compiled_compile_mass(CompiledEquations *numbers, Diag *diag);

/* --- compiled_rates.c --- */

bool compiled_have_pivots(const double *excess, int count); /* false: a pivot is rounding error */
bool compiled_speeds_are_rates(const System *system);       /* q' = u */
/* A program of rates alone where constraints are eliminated, if it may be. */
MUST_USE Status compiled_rates(CompiledEquations *numbers, const Constrained *solved, Diag *diag);
void compiled_end_rates(CompiledEquations *numbers);

/* --- compiled_guards.c --- */

/* Conditions of jumps and kinks, and of switches that keep their states; with their program. */
MUST_USE Status compiled_watch(CompiledEquations *numbers, Parameters *parameters, Diag *diag);

#endif
