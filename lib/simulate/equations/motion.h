/* motion.h: the equations of a system in numbers: rates, multipliers, projection
 *
 *     q' = N u,   Phi(q,t) = 0,   Phi_u u = nu,   Phi_u u' = gamma
 *     M u' + Phi_u^T lambda = F,   G([x'; z]) = 0
 *
 * A model supplies Equations: functions that bring arrays up to date. A Motion solves them, in the
 * augmented or the embedded form, and is an Ode in y = (q, u, x, a, work).
 *
 * a are references of multi-turn angles, which are known by sine and cosine alone: of all values
 * that these allow, such an angle is the one nearest to its a. The rates of the angles are
 * integrated to a, and a projection sets a to the angles. The other equations depend on a only
 * through the number of turns, so that they are constant for small changes of a. Positions that
 * don't change are evaluated once. After motion_new() only motion_try_coordinate_partitioning()
 * allocates memory. */
#ifndef COTREE_SIMULATE_EQUATIONS_MOTION_H
#define COTREE_SIMULATE_EQUATIONS_MOTION_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"
#include "base/diag.h"
#include "simulate/equations/signs.h"
#include "simulate/integrate/ode.h"

#include <stddef.h>

typedef struct Solved Solved;

/* A condition of the equations that a run monitors. */
typedef struct Guard {
    int surface;  /* surface on which the equations jump; -1: a kink at most */
    int side;     /* side of the surface that they are on; 0: they jump, or slide along it */
    int end;      /* of its sign's interval, left there: -1 or 1; 0: no sliding */
    bool held;    /* on a side, and other parts keep it on its surface: its sign tells nothing */
    bool solved;  /* its measure is solved for with the jump: always on one side */
    bool is_idle; /* it tells nothing in the current mode */
    bool waits;   /* for its load, which is none in the current mode: idle besides */
    int load;     /* 1 + the surface whose effort is in its bound; 0: none */
    bool is_unilateral; /* what meets its surface has an impact */
    bool is_of_event;   /* of an event, which says when its surface is met */
    bool is_norm;       /* its condition is the norm of a vector, or of the vector's signs: never
                           negative */
} Guard;

/* What a program has eliminated in closed form, for these constraint rows in use. */
typedef struct Eliminated {
    const int *rows;
    int row_count;
    const double *acceleration, *multiplier; /* nu, row_count; valid when power is */
    /* row_count, valid after position(): for kkt_is_sound(); NULL: rows are always independent */
    const double *pivot, *taken;
    const double *left; /* of dependent speeds, likewise */
    int left_count;
    /* whether the pivots of M exceed rounding error; valid after position() */
    bool (*has_pivots)(void *context);
    /* du of M du + G^T mu = 0, G du = bottom; valid after position() */
    void (*step)(void *context, const double *bottom, double *du);
} Eliminated;

typedef struct Equations {
    int n, nu, m, nx, nz;
    int position_rows;     /* the first of m; of the velocity rows after them phi is 0 */
    int multi_turn_count;  /* of a */
    const uint64_t *sides; /* counts changes of switches between resistances, each of which changes
                              numbers in the equations; NULL: there are no such switches */
    void *context;
    void (*take_references)(void *context,
                            const double *a); /* a for the calls below; NULL: there are none */
    /* bring phi, phi_u, mass, map, multi_turn up to date */
    void (*position)(void *context, double t, const double *q);
    /* after these: brings q_rate, multi_turn_rate, nu, gamma up to date; and network, network_rhs
     * where network_at is NULL */
    void (*velocity)(void *context, const double *u, const double *x);
    bool has_nu_early; /* nu is up to date when phi_u is */
    /* after these: brings network and network_residual up to date at w = [x'; z]; NULL: the network
     * is linear, A w = r */
    void (*network_at)(void *context, const double *w);
    /* bound of the rounding error of each network_residual in the last network_at(), nx+nz;
     * INFINITY or NAN: no bound. NULL: no bounds are available */
    void (*network_rounding)(void *context, double *out);
    /* u' and the multipliers of all m rows, for a network that reads them; NULL: it doesn't */
    void (*network_reads)(void *context, const double *acceleration, const double *multipliers);
    /* then the network's solution [x'; z] is known, */
    void (*network_solved)(void *context, const double *solved);
    /* which brings force up to date; NULL: network_solved() does */
    void (*loads)(void *context);
    /* then power; NULL: it is up to date before. `multipliers` of all m rows. */
    void (*accelerated)(void *context, const double *acceleration, const double *multipliers);
    const double *phi;        /* m */
    const double *phi_u;      /* m x nu: the entries that may not be 0, */
    const double *mass;       /* nu x nu: likewise, both triangles; use equations_mass() */
    const Pattern *rows;      /* positions of those of Phi_u: a column for each row of it, */
    const Pattern *masses;    /* of those of M, */
    const Pattern *maps;      /* and of those of N: a column for each row of it */
    const double *map;        /* n x nu: N; likewise; NULL: identity, n == nu */
    const double *q_rate;     /* n */
    const double *multi_turn; /* multi_turn_count: the angles nearest to a, and their rates */
    const double *multi_turn_rate;
    const double *nu_rate; /* m: right-hand side of the velocity constraints */
    const double *gamma;   /* m */
    int network_entries;   /* of A = dG/dw */
    const int *network_row, *network_column;
    const double *network;          /* network_entries */
    const double *network_rhs;      /* nx+nz: r */
    const double *network_residual; /* nx+nz: G */
    bool network_is_constant;       /* A is the same throughout a run */
    /* u' of M u' = force where there are no constraints, without forming M; false: M is singular
     * within rounding. NULL: M is needed */
    bool (*without_mass)(void *context, double *acceleration);
    const Eliminated *eliminated; /* likewise with constraints; NULL: M and Phi_u are needed */
    /* Eliminate in closed form, which sets `eliminated`, unless that takes more than `most`
     * products, or a larger program than it is worth. Afterwards nothing is up to date. Fails only
     * when it is stopped. NULL: not worth it, or nothing to eliminate. */
    Status (*eliminate)(void *context, const int *rows, int row_count, double most, Diag *diag);
    /* Where each speed has a row of its own, so that Phi_u is a permutation except for signs: sets
     * u' and the multipliers of all rows; NULL: there is another case */
    void (*prescribed)(void *context, double *acceleration, double *multiplier);
    /* Where there is no row, network or reference, or rows in use are those of `eliminated` and
     * always independent: q', u' and power from t, q and u in one call; false: as without_mass. The
     * arrays above are then not up to date, or unchanged. NULL: there is another case */
    bool (*outright)(void *context, double t, const double *y, double *out);
    bool is_outright_apart;             /* it leaves them unchanged */
    void (*bring_mass)(void *context);  /* brings M up to date; NULL: M is */
    const double *force;                /* nu; by equations_force() */
    void (*bring_force)(void *context); /* brings F up to date; NULL: F is */
    const double *power; /* 1: work done on the system per time, W; NULL: not known */
    const double *magnitude_bound, *unit; /* n+nu+nx+multi_turn_count: see Ode; may be NULL */
    const int *quaternions;               /* first of each four Euler parameters */
    int quaternion_count;
    /* conditions whose change of sign may be a kink or a jump of the equations; time_only ones
     * first */
    int switch_count, time_only;
    int margin_count; /* the last of them: positive while ideal switches keep their states */
    /* Whether the k-th margin is the current through a small resistance: its sign is reliable
     * although errors of states, if there were any, would change it by much. NULL: none is. */
    bool (*guard_is_of_stiff_element)(void *context, int k);
    bool switches_read_network; /* they read [x'; z] of the last network_solved() */
    bool switches_follow_time;  /* those that don't depend on time alone may read t too */
    const Guard *guards;        /* switch_count; NULL: all are kinks at most */
    void (*switches)(void *context, double t, const double *q, const double *u, const double *x,
                     double *out);
    int sign_count; /* of surfaces, inputs: a mode changes guards and what follows */
    /* surfaces that the motion slides along: signs are solved for such that slip is 0 */
    int slide_count;
    const SignRange *sign_ranges;                      /* slide_count */
    void (*slide)(void *context, const double *signs); /* before velocity() */
    /* at a solved state: slip of each, and its distance `off` from the surface (slide_count
     * each); and where its bound is an expression the kinetic one and that at rest, per unit of its
     * load (2 slide_count) */
    void (*slip)(void *context, double t, const double *y, const Solved *solved, double *slip,
                 double *off, double *bounds);
} Equations;

static inline Guard equations_guard(const Equations *eq, int condition)
{
    return eq->guards != NULL ? eq->guards[condition] : (Guard){.surface = -1};
}

/* M at the current position */
static inline const double *equations_mass(const Equations *eq)
{
    if (eq->bring_mass != NULL)
        eq->bring_mass(eq->context);
    return eq->mass;
}
/* F at the current state */
static inline const double *equations_force(const Equations *eq)
{
    if (eq->bring_force != NULL)
        eq->bring_force(eq->context);
    return eq->force;
}
/* Set a to the angles at (t, q). */
void equations_turn(const Equations *equations, double t, const double *q, double *a);
/* Bring each four Euler parameters of q to unit length. */
void equations_normalise(const Equations *equations, double *q);

typedef struct MotionOptions {
    const CallMonitor *watch; /* can stop a factorisation, borrowed; NULL: nothing does */
    const int *rows;          /* independent constraint rows, in use at first */
    int row_count;
    bool embedded;
    const int *independent; /* speeds that the user wants independent (embedded); may be NULL */
    int independent_count;
    double tolerance; /* atol of the run: bounds what remains after a projection */
} MotionOptions;

typedef struct Motion Motion;

/* New; borrows the equations, copies the options. Free with motion_free(). */
Motion *motion_new(const Equations *equations, const MotionOptions *options);
void motion_free(Motion *motion); /* NULL is fine */
const Ode *motion_ode(const Motion *motion);
int motion_length(const Motion *motion); /* of y, work included */

/* The solution at a state: all unknowns. Borrowed, until the next call on the motion. */
struct Solved {
    const double *acceleration; /* nu: u' */
    const double *multipliers;  /* m: lambda, of minimum norm where rows are redundant */
    const double *rates;        /* nx: x' */
    const double *algebraic;    /* nz: z */
};
/* [x'; z] at (t, y): borrowed, until the next call. Where the last evaluation was at that time and
 * state, its result is returned. NULL: there is no solution. */
const double *motion_network(Motion *motion, double t, const double *y);
/* Set the initial guess of the next search for x' and z: [x'; z]. */
void motion_guess(Motion *motion, const double *network);
bool motion_solve(Motion *motion, double t, const double *y, Solved *out);
/* The same with the constraint rows in use, as in rates: multipliers of other rows are 0. False
 * where rates depend on more than the equations at y: on surfaces that the motion slides along, and
 * near singular positions. */
bool motion_solve_in_use(Motion *motion, double t, const double *y, Solved *out);
const int *motion_rows(const Motion *motion, int *count); /* in use; borrowed */
void motion_rows_in_use(const Motion *motion, bool *out); /* the same: whether each is (m) */

/* Set what depends on the mode of the equations, when that has changed. */
void motion_enter_mode(Motion *motion);
/* Slip for given signs (slide_count each). */
bool motion_drift(Motion *motion, double t, const double *y, const double *signs, double *slip,
                  double *off);
/* Of each sign the kinetic bound and that at rest, as of the last drift; per unit of the load where
 * it has one, 0 where its bound is no expression. Borrowed. */
const double *motion_bounds(const Motion *motion);
/* Move y along the effect of signs on the rates, until its distance from each surface is `off`
 * (slide_count). */
bool motion_leave_surfaces(Motion *motion, double t, double *y, const double *off);
/* What sign k changes: of y' by one unit of it (length of y, 0 but for u' and x'), of each slip
 * (slide_count), and of the power of what isn't conservative. By a difference of so much; the signs
 * are as before. False: it can't be evaluated. */
typedef struct SignEffect {
    double *way, *slip, power;
} SignEffect;
bool motion_sign_effect(Motion *motion, double t, const double *y, double *signs, int k,
                        double difference, SignEffect *out);

/* Set whether the state to project has drifted for many steps, as far as the error test allows, or
 * for one step. */
void motion_set_drifting(Motion *motion, bool drifts);
/* Project onto the constraints. Position: the nearest, in at most 8 sweeps; in the norm of M where
 * the equations are eliminated in closed form and the state hasn't drifted. Velocity: the one there
 * that differs by the least kinetic energy. */
bool motion_project(Motion *motion, double t, double *y);
/* largest |Phi| and |Phi_u u - nu| over all rows */
void motion_residuals(Motion *motion, double t, const double *y, double *position,
                      double *velocity);
/* Values of the conditions at a state; NAN where the network has no solution there. */
void motion_switches(Motion *motion, double t, const double *y, double *out);
/* Restrict the time that rates use to [low, high], so that a step up to a switch evaluates nothing
 * after it. */
void motion_window(Motion *motion, double low, double high);
double motion_clock(const Motion *motion, double t); /* t restricted to that interval */
/* Supply derivatives of the rates for the motion's Ode; their context is borrowed. */
void motion_offer_jacobian(Motion *motion, OdeJacobian jacobian);
/* Derivatives of the motion's implicit equations with multipliers, w = (y, L, M) of all m rows, L'
 * = lambda, M' = mu. `pattern` returns -1 where there are none; it is called once, when a solver
 * starts. Borrowed. */
typedef struct ImplicitJacobian {
    void *context;
    int (*pattern)(void *context, const int **row, const int **column);
    bool (*at)(void *context, double t, double c, const double *w, const double *w_rate,
               double *values);
} ImplicitJacobian;
void motion_offer_implicit(Motion *motion, ImplicitJacobian offered);
/* Evaluates everything there, with the network that follows from these u' and m multipliers. `out`
 * gets the solution, without u'. False: the network has no solution. */
bool motion_evaluate_driven(Motion *motion, double t, const double *y, const double *acceleration,
                            const double *multipliers, Solved *out);
/* Supply other implicit equations of the same unknowns for the motion's Ode; borrowed. */
void ode_set_jacobian(Motion *motion, const Dae *dae);

/* Set atol of the run, once it is known: bounds what remains after a projection. */
void motion_tolerance(Motion *motion, double tolerance);

/* Choices made at a configuration, which become worse as the motion leaves it: independent speeds
 * of the embedded form, and constraint rows in use where some are redundant. Off the manifold a
 * redundant row appears independent, so rows are chosen at projected states. */
typedef struct Renewed {
    bool rows, independent; /* chosen anew since the last call, and different now */
} Renewed;
/* Choose independent speeds at y, as the options want; does nothing in the augmented form. */
void motion_partition(Motion *motion, double t, const double *y);
/* At y, just projected: choose anew where a choice has become poor. */
Renewed motion_renew(Motion *motion, double t, const double *y);
/* After each step: let the equations eliminate u' and multipliers in closed form, once a run has
 * factored MOTION_FACTORS_PAID matrices for them; or has factored MOTION_FACTORS_SEEN and,
 * extrapolated from these, will need so many more in `steps_ahead` (0: not known). At any size that
 * costs about as much as deriving and compiling the elimination. Fails as that does. */
enum { MOTION_FACTORS_SEEN = 100, MOTION_FACTORS_PAID = 500 };
MUST_USE Status motion_try_coordinate_partitioning(Motion *motion, double steps_ahead, Diag *diag);

typedef struct MotionCounts {
    int64_t factorisations;
    int64_t regularised;
    double singular_time; /* time of the first singular position; NAN: none */
} MotionCounts;
MotionCounts motion_counts(const Motion *motion);

#endif
