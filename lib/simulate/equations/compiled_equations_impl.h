/* compiled_equations_impl.h: what makes Numbers, and what of it is watched */
#ifndef COTREE_SIMULATE_EQUATIONS_COMPILED_EQUATIONS_IMPL_H
#define COTREE_SIMULATE_EQUATIONS_COMPILED_EQUATIONS_IMPL_H

#include "base/memory.h"
#include "simulate/equations/articulated.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/elimination.h"
#include "simulate/equations/mass_matrix.h"

typedef LIST(Expr) CompiledRoots;

struct CompiledEquations {
    Equations eq;
    const VariableIndex *layout;
    Parameters *parameters;
    Probe *main, *switching, *network;
    Pattern rows, masses, maps; /* where entries of Phi_u, M and N stand */
    /* M: of the main program; or NULL. By a matrix, from what that holds from mass_needs on; where
     * elimination does without, from a program of its own, as far as that was asked for. */
    MassMatrix *mass;
    Articulated *articulated;
    Probe *massing;
    Probe *rates; /* rates of t, q and u alone, where rows are eliminated; NULL: not so */
    int mass_needs;
    EliminatedBy eliminated_by;          /* whether the main program has eliminated M itself */
    bool is_articulated, is_mass_old;    /* factors are there; M is of another position */
    bool is_mass_constant, is_mass_kept; /* with the parameters of now: of bodies without joints */
    const double *eliminated_accelerations; /* of the main program, and what tells their rounding */
    Eliminated eliminated;                  /* of constrained speeds, */
    const double *eliminated_excess, *eliminated_step;
    int *eliminated_rows; /* for these rows */
    ConstrainedPlaces eliminated_places;
    /* of what `rates` tells: whether q' is there; where what tells rounding begins, and how much */
    bool has_rates_of_q;
    int rates_excess, rates_pivots;
    Probe *slip;        /* of surfaces that are slid along: h', or what of it they reach, and h */
    Guard *guards;      /* of the conditions, */
    Expr *shown_guards; /* which are these for a user; NULL: margins */
    int *quaternions, *network_places;
    LIST(int) margins;   /* whose they are, of the switches */
    bool is_network_new; /* its program has seen t, q, u, x as they are */
    double *magnitude_bound, *unit;
};

/* of roots that are on their surfaces as far as they have to be */
MUST_USE static inline Status compiled_compile(const VariableIndex *layout, Parameters *parameters,
                                               const CompiledRoots *roots, Probe **out, Diag *diag)
{
    const ProbeOrder order = {
        .roots = roots->at, .root_count = roots->count, .is_apart = true, .is_put = true};

    return probe_make(layout, parameters, &order, out, diag);
}

/* --- compiled_calls.c --- */

/* M and F are brought from a program of their own when somebody asks for them */
bool compiled_need_no_mass(const CompiledEquations *numbers);
/* The calls of the equations: those that are there anyway; behind the main program, where the
 * network and the power are known in these stages; behind the network's; behind that of M. */
void compiled_connect(CompiledEquations *numbers);
void compiled_connect_equations(CompiledEquations *numbers, Stage network, Stage power);
void compiled_connect_network(CompiledEquations *numbers);
void compiled_connect_mass(CompiledEquations *numbers);

/* --- compiled_compile.c --- */

/* The main program, and the network's where it is solved by iteration. `told` is what they tell of
 * accelerations themselves, if they do. */
MUST_USE Status compiled_compile_equations(CompiledEquations *numbers, const Expr *shown_guards,
                                           int eliminated_count, Diag *diag);
/* M and F, where elimination does without them */
MUST_USE Status compiled_compile_mass(CompiledEquations *numbers, Diag *diag);

/* --- compiled_rates.c --- */

bool compiled_have_pivots(const double *excess, int count); /* none is what rounding left */
bool compiled_speeds_are_rates(const System *system);       /* q' = u */
/* A program of rates alone where constraints are eliminated, if it may be. */
MUST_USE Status compiled_rates(CompiledEquations *numbers, const Constrained *solved, Diag *diag);
void compiled_end_rates(CompiledEquations *numbers);

/* --- compiled_watch.c --- */

/* conditions of jumps and bends, and of switches that stay on their sides; with their program */
MUST_USE Status compiled_watch(CompiledEquations *numbers, Parameters *parameters, Diag *diag);
/* how the surfaces that are slid along are left */
MUST_USE Status compiled_slide(CompiledEquations *numbers, Parameters *parameters, Diag *diag);

#endif
