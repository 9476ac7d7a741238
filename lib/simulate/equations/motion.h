/* motion.h: the equations of a system in numbers: rates, multipliers, projection
 *
 *     q' = N u,   Phi(q,t) = 0,   Phi_u u = nu,   Phi_u u' = gamma
 *     M u' + Phi_u^T lambda = F,   G([x'; z]) = 0
 *
 * Equations is what a model supplies: functions that bring arrays up to date. A Motion
 * solves them, in the augmented or the embedded form, and is an Ode in y = (q, u, x, a, work).
 *
 * a are references of angles that only a sine and a cosine tell: each such angle is the one nearest
 * to its a, over any number of turns. They are integrated by the angles' rates, and a projection
 * puts them on the angles. The rest reads no more of them than the turn, and doesn't feel them
 * move. Positions that stay are evaluated once, and nothing is allocated after motion_new() but by
 * motion_try_coordinate_partitioning(). */
#ifndef COTREE_SIMULATE_EQUATIONS_MOTION_H
#define COTREE_SIMULATE_EQUATIONS_MOTION_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"
#include "base/diag.h"
#include "simulate/integrate/ode.h"

#include <stddef.h>

typedef struct Solved Solved;

/* What a condition of the equations watches. */
typedef struct Guard {
    int surface; /* that the equations jump on; -1: they bend at most */
    int side;    /* of it, that they stay on; 0: they jump, or slide along it */
    int end; /* of the interval of its sign that is left there: -1 or 1; 0: it isn't slid along */
    bool solved; /* what is 0 on it is solved for with the jump: it is always stayed on a side of */
} Guard;

/* What a program has eliminated itself, for these constraint rows in use. */
typedef struct Eliminated {
    const int *rows;
    int row_count;
    const double *acceleration, *multiplier; /* nu, row_count: as power is up to date */
    /* row_count, by position(): for kkt_is_sound(); NULL: rows are always independent */
    const double *pivot, *taken;
    const double *left; /* of speeds that wait, likewise */
    int left_count;
    /* whether M leaves more of its pivots than rounding, by position() */
    bool (*has_pivots)(void *context);
    /* du of M du + G^T mu = 0, G du = bottom, by position() */
    void (*step)(void *context, const double *bottom, double *du);
} Eliminated;

typedef struct Equations {
    int n, nu, m, nx, nz;
    int multi_turn_count;  /* of a */
    const uint64_t *sides; /* counts changes of switches between resistances, which make equations
                              of other numbers of them; NULL: there are none */
    void *context;
    void (*take_references)(void *context,
                            const double *a); /* a for the calls below; NULL: there are none */
    /* bring phi, phi_u, mass, map, multi_turn up to date */
    void (*position)(void *context, double t, const double *q);
    /* then q_rate, multi_turn_rate, nu, gamma; network, network_rhs where network_at is NULL */
    void (*velocity)(void *context, const double *u, const double *x);
    bool has_nu_early; /* nu is up to date with phi_u */
    /* then network and network_residual at w = [x'; z]; NULL: the network is linear, A w = r */
    void (*network_at)(void *context, const double *w);
    /* how far each of network_residual may be off by what was rounded in the last network_at(),
     * nx+nz; INFINITY or NAN: no bound. NULL: nobody tells */
    void (*network_rounding)(void *context, double *out);
    /* u' and the multipliers of all m rows, for a network that reads them; NULL: it doesn't */
    void (*network_reads)(void *context, const double *acceleration, const double *multipliers);
    /* then what it solves for is known, [x'; z], */
    void (*network_solved)(void *context, const double *solved);
    /* and with it force; NULL: that is brought up to date with it */
    void (*loads)(void *context);
    /* then power; NULL when it is known before. `multipliers` of all m rows. */
    void (*accelerated)(void *context, const double *acceleration, const double *multipliers);
    const double *phi;        /* m */
    const double *phi_u;      /* m x nu: the entries that may not be 0, */
    const double *mass;       /* nu x nu: likewise, both halves; by equations_mass(); */
    const Pattern *rows;      /* where those of Phi_u stand, a column each row of it, */
    const Pattern *masses;    /* those of M, */
    const Pattern *maps;      /* and those of N, a column each row of it */
    const double *map;        /* n x nu: N; likewise; NULL: identity, n == nu */
    const double *q_rate;     /* n */
    const double *multi_turn; /* multi_turn_count: the angles near a, and their rates */
    const double *multi_turn_rate;
    const double *nu_rate; /* m: right-hand side of the velocity constraints */
    const double *gamma;   /* m */
    int network_entries;   /* of A = dG/dw */
    const int *network_row, *network_column;
    const double *network;          /* network_entries */
    const double *network_rhs;      /* nx+nz: r */
    const double *network_residual; /* nx+nz: G */
    bool network_is_constant;       /* A never changes in a run */
    /* u' of M u' = force where there are no constraints, by other means than M; false: M leaves
     * nothing but rounding of it. NULL: by M */
    bool (*without_mass)(void *context, double *acceleration);
    const Eliminated *eliminated; /* likewise where there are; NULL: by M and Phi_u, */
    /* until this has written it out, unless it takes more than `most` products, or more than a
     * program is worth. Where it has, nothing is up to date. Fails when it is stopped alone. NULL:
     * it isn't worth it, or there is nothing to eliminate. */
    Status (*eliminate)(void *context, const int *rows, int row_count, double most, Diag *diag);
    /* Where each speed has a row of its own, so that Phi_u is a permutation but for signs: u', and
     * the multipliers of all rows; NULL: not so */
    void (*prescribed)(void *context, double *acceleration, double *multiplier);
    /* Where no row, network or reference has to be seen to, or rows in use are those of
     * `eliminated` and always independent: q', u' and power of t, q and u, all at once; false: as
     * without_mass. What is above is not up to date then, or stays as it is. NULL: not so */
    bool (*outright)(void *context, double t, const double *y, double *out);
    bool is_outright_apart;             /* it stays */
    void (*bring_mass)(void *context);  /* M up to date; NULL: it is */
    const double *force;                /* nu; by equations_force() */
    void (*bring_force)(void *context); /* F up to date; NULL: it is */
    const double *power; /* 1: work done on the system per time, W; NULL: not known */
    const double *magnitude_bound, *unit; /* n+nu+nx+multi_turn_count, for Ode; may be NULL */
    const int *quaternions;               /* first of each four Euler parameters */
    int quaternion_count;
    /* conditions whose change of sign may bend or break the equations; time_only ones first */
    int switch_count, time_only;
    int margin_count; /* the last of them: positive as long as ideal switches stay on their sides */
    /* Whether the k-th margin is the current through a small resistance: it tells its sign although
     * errors of states, were they any, would move it far. NULL: none is. */
    bool (*guard_is_of_stiff_element)(void *context, int k);
    bool switches_read_network; /* [x'; z] of the last network_solved() */
    bool switches_follow_time;  /* those that aren't of time alone hold t too */
    const Guard *guards;        /* switch_count; NULL: they bend at most */
    void (*switches)(void *context, double t, const double *q, const double *u, const double *x,
                     double *out);
    /* surfaces that the motion slides along: their signs are found such that slip is 0 */
    int slide_count;
    void (*slide)(void *context, const double *signs); /* before velocity() */
    /* at a row that is solved: how fast each is left, and how far off it is (slide_count each) */
    void (*slip)(void *context, double t, const double *y, const Solved *solved, double *slip,
                 double *off);
} Equations;

static inline Guard equations_guard(const Equations *eq, int condition)
{
    return eq->guards != NULL ? eq->guards[condition] : (Guard){.surface = -1};
}

/* M where the equations stand */
static inline const double *equations_mass(const Equations *eq)
{
    if (eq->bring_mass != NULL)
        eq->bring_mass(eq->context);
    return eq->mass;
}
/* F where the equations stand */
static inline const double *equations_force(const Equations *eq)
{
    if (eq->bring_force != NULL)
        eq->bring_force(eq->context);
    return eq->force;
}
/* Put a onto the angles at (t, q). */
void equations_turn(const Equations *equations, double t, const double *q, double *a);
/* Bring each four Euler parameters of q to unit length. */
void equations_normalise(const Equations *equations, double *q);

typedef struct MotionOptions {
    const CallMonitor *watch; /* who may stop a factorisation, borrowed; NULL: nobody */
    const int *rows;          /* constraint rows in use at first, independent ones */
    int row_count;
    bool embedded;
    const int *independent; /* speeds asked for as independent (embedded); may be NULL */
    int independent_count;
    double tolerance; /* atol of the run: bounds what a projection may leave */
} MotionOptions;

typedef struct Motion Motion;

/* New; borrows the equations, copies the options. Free with motion_free(). */
Motion *motion_new(const Equations *equations, const MotionOptions *options);
void motion_free(Motion *motion); /* NULL is fine */
const Ode *motion_ode(const Motion *motion);
int motion_length(const Motion *motion); /* of y, work included */

/* Solved at a row: all numbers there are. Borrowed, until the next call on the motion. */
struct Solved {
    const double *acceleration; /* nu: u' */
    const double *multipliers;  /* m: lambda, of minimum norm where rows are redundant */
    const double *rates;        /* nx: x' */
    const double *algebraic;    /* nz: z */
    const double *signs;        /* slide_count: of surfaces that are slid along */
};
/* [x'; z] at (t, y): borrowed, until the next call; what the last evaluation found is told again
 * where it was at that time. NULL: there is no solution. */
const double *motion_network(Motion *motion, double t, const double *y);
/* where the next search for x' and z begins: [x'; z] */
void motion_guess(Motion *motion, const double *network);
bool motion_solve(Motion *motion, double t, const double *y, Solved *out);
/* The same from the constraint rows in use, as rates are: multipliers of others are 0. False where
 * rates follow from more than the equations at y, too: on surfaces that are slid along, and near
 * singular positions. */
bool motion_solve_in_use(Motion *motion, double t, const double *y, Solved *out);
const int *motion_rows(const Motion *motion, int *count); /* in use; borrowed */
void motion_rows_in_use(const Motion *motion, bool *out); /* the same: whether each is (m) */

/* Slip where the signs are given (slide_count each). */
bool motion_drift(Motion *motion, double t, const double *y, const double *signs, double *slip,
                  double *off);

/* Whether what is projected has drifted for many steps, as far as the error test lets it, rather
 * than for one. */
void motion_set_drifting(Motion *motion, bool drifts);
/* Back onto the constraints: to the nearest position in at most 8 sweeps, by masses where the
 * equations have eliminated themselves and nothing drifts, and to the velocity there that differs
 * by the least kinetic energy. */
bool motion_project(Motion *motion, double t, double *y);
/* largest |Phi| and |Phi_u u - nu| over all rows */
void motion_residuals(Motion *motion, double t, const double *y, double *position,
                      double *velocity);
/* Conditions of switching at a row; NAN where the network has no solution there. */
void motion_switches(Motion *motion, double t, const double *y, double *out);
/* The time that rates see is kept within [low, high], so that a step up to a switch
 * never looks behind it. */
void motion_window(Motion *motion, double low, double high);
double motion_clock(const Motion *motion, double t); /* t within that */
/* Derivatives of the rates for the motion's Ode; what they belong to is borrowed. */
void motion_offer_jacobian(Motion *motion, OdeJacobian jacobian);
/* Derivatives of what the motion's implicit equations are with multipliers, w = (y, L, M) of all m
 * rows, L' = lambda, M' = mu. `pattern` is -1 where there are none to be had: it is asked once,
 * when a solver starts. Borrowed. */
typedef struct ImplicitJacobian {
    void *context;
    int (*pattern)(void *context, const int **row, const int **column);
    bool (*at)(void *context, double t, double c, const double *w, const double *w_rate,
               double *values);
} ImplicitJacobian;
void motion_offer_implicit(Motion *motion, ImplicitJacobian jacobian);
/* Everything evaluated there, with the network that follows from these u' and multipliers; m of
 * them. What was solved for: u' isn't. False: the network has no solution. */
bool motion_evaluate_driven(Motion *motion, double t, const double *y, const double *acceleration,
                            const double *multipliers, Solved *out);
/* Other implicit equations of the same unknowns, for the motion's Ode; borrowed. */
void ode_set_jacobian(Motion *motion, const Dae *dae);

/* atol of the run, once it is known: bounds what a projection may leave */
void motion_tolerance(Motion *motion, double tolerance);

/* What was chosen at a configuration and wears out along the way: independent speeds of the
 * embedded form, and constraint rows where some are redundant. Off the manifold a redundant row
 * looks independent, so that rows are chosen where a state has been projected. */
typedef struct Renewed {
    bool rows, independent; /* chosen anew since the last call, and now others */
} Renewed;
/* Choose independent speeds at y, as asked for; does nothing in the augmented form. */
void motion_partition(Motion *motion, double t, const double *y);
/* At y, just projected: choose anew what has worn out. */
Renewed motion_renew(Motion *motion, double t, const double *y);
/* Behind each step: let the equations eliminate u' and multipliers themselves, once a run has
 * factored MOTION_FACTORS_PAID matrices for them, or has factored MOTION_FACTORS_SEEN and by these
 * will need so many more in `steps_ahead` (0: not known). That is about what writing the
 * elimination out and compiling it costs, at any size. Fails as that does. */
enum { MOTION_FACTORS_SEEN = 100, MOTION_FACTORS_PAID = 500 };
MUST_USE Status motion_try_coordinate_partitioning(Motion *motion, double steps_ahead, Diag *diag);

typedef struct MotionCounts {
    int64_t factorisations;
    int64_t regularised;
    double singular_time; /* first time of one; NAN */
} MotionCounts;
MotionCounts motion_counts(const Motion *motion);

#endif
