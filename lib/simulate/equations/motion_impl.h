/* motion_impl.h: declarations shared by the files of a motion */
#ifndef COTREE_SIMULATE_EQUATIONS_MOTION_IMPL_H
#define COTREE_SIMULATE_EQUATIONS_MOTION_IMPL_H

#include "algebra/anderson.h"
#include "algebra/kkt.h"
#include "simulate/equations/equations_limits.h"
#include "simulate/equations/motion.h"
#include "simulate/equations/netsolve.h"
#include "simulate/equations/partitioning.h"
#include "simulate/equations/signs.h"

/* How independent the rows in use are, by one measure, at the start of the last step (now, at) and
 * of the one before (before, before_at); a time of NAN: not computed. */
typedef struct Trend {
    double now, at, before, before_at;
} Trend;

struct Motion {
    const Equations *eq;
    MotionOptions options;
    int *rows, *wanted;
    int used;              /* constraint rows in use */
    int factored, steps;   /* matrices that closed-form elimination would save, in these steps */
    double row_ratio;      /* their pivot ratio when they were chosen; 0: not known yet */
    bool is_repartitioned; /* since the last renewal */
    bool is_implicit;      /* multipliers of rows in use are unknowns of the method */
    double rounding_error; /* largest since the last query */
    bool drifts;           /* over many steps, until a position is read and projected */
    bool is_projecting;    /* rates of a step are those of the nearest state on the manifold */
    double began, ends;    /* s: start of the last step, and its planned end */
    bool is_far;           /* from singular positions, by the extrapolation at its start */
    Trend by_groups, by_all;
    Ode ode;
    double low, high; /* s: time window of evaluations */
    Kkt *kkt;
    Kkt *nearest_kkt; /* with 1 for all masses; NULL: there are no constraints */
    Pattern unit_places;
    double *unit;
    Partitioning *partitioning;
    double *full_mass, *full_phi_u; /* full M and Phi_u for the embedded form */
    NetSolve *network;
    Signs *signs; /* of surfaces that it slides along; NULL: it never does */
    double *slip, *off, *way, *bounds;
    bool is_evaluated, is_factored, is_embedded_factored; /* valid at t, q */
    bool is_alone;                                        /* closed-form factors are valid there */
    double t, *q, *references;                            /* references of angles */
    uint64_t sides;                                       /* of switches, likewise */
    const double *solved;                                 /* [x'; z] */
    double *solved_before;
    Anderson *together;              /* of a network that reads u' or lambda; NULL: none does */
    double *solved_size, *turn_size; /* its largest [x'; z] so far; scales of a turn */
    double *top, *bottom, *du, *kept, *lambda, *lambda_all;
    double *nearest; /* a y */
    ImplicitJacobian implicit;
    double *dae_weight, *error_floor;
    double *row_size, *row_part; /* of all rows: largest entry so far, and one over it */
    bool *is_tested;             /* of unknowns of implicit equations */
    double *slopes;              /* of rates by y, for implicit equations; NULL: not yet */
    MotionCounts counts;
};

/* --- motion_place.c --- */

/* index of the first reference in y */
static inline int multi_turn_place(const Equations *eq)
{
    return eq->n + eq->nu + eq->nx;
}

/* whether t is in the step that began last */
static inline bool motion_is_in_step(const Motion *mo)
{
    return mo->t >= mo->began && mo->t <= mo->ends;
}

/* Bring the equations' positions up to date at (t, y); the factors below belong to them. */
void motion_at_position(Motion *motion, double t, const double *y);
bool motion_factor_embedded(Motion *motion);
/* Factor the matrix of accelerations and multipliers there; the second uses another M. */
bool motion_factor(Motion *motion);
bool motion_factor_with(Motion *motion, Kkt *kkt, const double *mass);
/* Choose independent speeds at the current position; true when they have changed
 * (motion_renew.c). */
bool motion_choose_independent(Motion *motion);
/* Put constraint rows in use that are independent at the current position, in place of worn ones.
 * The rows of an implicit method are returned for motion_return_rows(); NULL: they are still in
 * use. (motion_renew.c) */
int *motion_set_rows(Motion *motion);
void motion_return_rows(Motion *motion, int *rows);
/* Whether the closed-form elimination applies there: it is for the rows in use, and as accurate as
 * factors that need no refinement. */
bool motion_is_eliminated(Motion *motion);
/* whether the closed-form elimination is for the rows in use, and these are always independent */
bool motion_rows_are_fixed(const Motion *motion);
/* Solve the network there; false: it can't be solved. */
bool motion_find_network(Motion *motion, double t, const double *y);
/* Evaluate everything but the solution for u', with the current signs on surfaces. False where the
 * network can't be solved. */
bool motion_evaluate(Motion *motion, double t, const double *y);
/* then u', in the form of the run */
bool motion_solve_rates(Motion *motion);

/* whether drivers determine all speeds, so that u' and lambda are explicit and no linear system has
 * to be solved */
static inline bool motion_is_prescribed(const Motion *mo)
{
    return mo->eq->prescribed != NULL && mo->used == mo->eq->m;
}

/* --- motion_solve.c --- */

/* Solve in the form of the run, with the network where each depends on the other, and compute what
 * follows from the solution. */
bool motion_solve_plain(Motion *motion);
void motion_bring_power(Motion *motion, const double *acceleration);
void motion_write_rates(const Motion *motion, double *out);
void motion_spread_multipliers(Motion *motion);
/* what was solved for; false: not finite */
bool motion_report(const Motion *motion, Solved *out);

/* --- motion_implicit.c --- */

/* the motion's implicit equations, for its Ode */
void motion_open_implicit(Motion *motion);

/* --- motion_surfaces.c --- */

void motion_open_surfaces(Motion *motion);
/* motion_evaluate() with the signs that keep the motion on its surfaces; false: no such signs were
 * found */
bool motion_find_signs(Motion *motion, double t, const double *y);
/* that where there are surfaces, motion_evaluate() otherwise */
bool motion_evaluate_all(Motion *motion, double t, const double *y);
/* Project y onto the surfaces, along the effect of signs on the rates. */
bool motion_project_surfaces(Motion *motion, double t, double *y);

#endif
