/* motion_impl.h: what the files of a motion share */
#ifndef COTREE_SIMULATE_EQUATIONS_MOTION_IMPL_H
#define COTREE_SIMULATE_EQUATIONS_MOTION_IMPL_H

#include "algebra/anderson.h"
#include "algebra/kkt.h"
#include "simulate/equations/motion.h"
#include "simulate/equations/netsolve.h"
#include "simulate/equations/partitioning.h"
#include "simulate/equations/signs.h"

/* How independent the rows in use are, by one measure, where a step began, and where the one before
 * it did; times NAN: it was not asked for. */
typedef struct Trend {
    double now, at, before, before_at;
} Trend;

struct Motion {
    const Equations *eq;
    MotionOptions options;
    int *rows, *wanted;
    int used;              /* constraint rows in use */
    int factored, steps;   /* matrices that the equations could have eliminated, in these */
    double row_ratio;      /* their pivots when they were chosen; 0: not known yet */
    bool is_repartitioned; /* since the last renewal */
    bool is_implicit;      /* multipliers of the rows in use are unknowns of a method */
    double rounding_error; /* largest since it was asked for */
    bool drifts;           /* over many steps, until a position is read and brought back */
    bool is_projecting;    /* a step's rates are those of the nearest state on the manifold */
    double began, ends;    /* where a step did last, and is to */
    bool is_far;           /* from singular positions, as far as was foreseen there */
    Trend by_groups, by_all;
    Ode ode;
    double low, high; /* time window of evaluations */
    Kkt *kkt;
    Kkt *nearest_kkt; /* with 1 for all masses; NULL: there are no constraints */
    Pattern unit_places;
    double *unit;
    Partitioning *partitioning;
    double *full_mass, *full_phi_u; /* for that */
    NetSolve *network;
    Signs *signs; /* NULL: no surface is slid along */
    double *slip, *off, *way;
    bool is_evaluated, is_factored, is_embedded_factored; /* at t, q */
    bool is_alone;                                        /* factors of the equations' own there */
    double t, *q, *references;                            /* references of angles */
    uint64_t sides;                                       /* of switches, likewise */
    const double *solved;                                 /* [x'; z] */
    double *solved_before;
    Anderson *together;              /* of a network that reads u' or lambda; NULL: none does */
    double *solved_size, *turn_size; /* its largest [x'; z] so far; what a turn measures by */
    double *top, *bottom, *du, *kept, *lambda, *lambda_all;
    double *nearest; /* a y */
    ImplicitJacobian implicit;
    double *dae_weight, *error_floor;
    double *row_size, *row_part; /* of all rows: largest entry so far, and one over it */
    bool *is_tested;             /* of unknowns of implicit equations */
    double *slopes; /* of all rates by y, for implicit equations; NULL: not asked for yet */
    MotionCounts counts;
};

/* --- motion_place.c --- */

/* of the references in y */
static inline int multi_turn_place(const Equations *eq)
{
    return eq->n + eq->nu + eq->nx;
}

#define MOTION_WORN 0.1 /* of the pivot ratio when they were chosen: rows, independent speeds */

/* whether it stands in the step that began last */
static inline bool motion_is_in_step(const Motion *mo)
{
    return mo->t >= mo->began && mo->t <= mo->ends;
}

/* the equations' positions at (t, y), which the factors below belong to */
void motion_at_position(Motion *motion, double t, const double *y);
bool motion_factor_embedded(Motion *motion);
/* the matrix of accelerations and multipliers there; with another M */
bool motion_factor(Motion *motion);
bool motion_factor_with(Motion *motion, Kkt *kkt, const double *mass);
/* Choose independent speeds where the equations stand; true when they are others (motion_renew.c).
 */
bool motion_choose_independent(Motion *motion);
/* Constraint rows that are independent where the equations stand are in use from now on, in place
 * of worn ones. An implicit method keeps to its own, which are handed back (NULL: they are in use
 * still) for motion_return_rows(). (motion_renew.c) */
int *motion_set_rows(Motion *motion);
void motion_return_rows(Motion *motion, int *rows);
/* Whether what the equations have eliminated themselves serves there: it is of the rows in use, and
 * as sound as factors that need no refinement. */
bool motion_is_eliminated(Motion *motion);
/* whether what has been eliminated is of the rows in use, and these are always independent */
bool motion_rows_are_fixed(const Motion *motion);
/* the network there; false: it can't be solved */
bool motion_find_network(Motion *motion, double t, const double *y);
/* Everything but the solution for u', with signs on surfaces as they are: false where the network
 * can't be solved. */
bool motion_evaluate(Motion *motion, double t, const double *y);
/* then u', in the form of the run */
bool motion_solve_rates(Motion *motion);

/* nothing has to be solved for */
static inline bool motion_is_prescribed(const Motion *mo)
{
    return mo->eq->prescribed != NULL && mo->used == mo->eq->m;
}

/* --- motion_solve.c --- */

/* the solution by form, with the network where they hang together, and what is made of it */
bool motion_solve_plain(Motion *motion);
void motion_bring_power(Motion *motion, const double *acceleration);
void motion_write_rates(const Motion *motion, double *out);
void motion_spread_multipliers(Motion *motion);
/* what has been solved for; false: not finite */
bool motion_report(const Motion *motion, Solved *out);

/* --- motion_implicit.c --- */

/* the motion's implicit equations, for its Ode */
void motion_open_implicit(Motion *motion);

/* --- motion_surfaces.c --- */

void motion_open_surfaces(Motion *motion);
/* motion_evaluate() with the signs that keep the motion on its surfaces; false: there are none */
bool motion_find_signs(Motion *motion, double t, const double *y);
/* that where there are surfaces, or else motion_evaluate() */
bool motion_evaluate_all(Motion *motion, double t, const double *y);
/* y back onto the surfaces, along what signs do to the rates */
bool motion_project_surfaces(Motion *motion, double t, double *y);

#endif
