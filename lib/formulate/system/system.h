/* system.h: a model's equations: a symbolic DAE with named variables
 *
 *     q' = N u,   Phi(q,t) = 0,   Phi_u u = nu,   Phi_u u' = gamma
 *     M u' + Phi_u^T lambda = F(q, u, x, z, t)
 *     G([x'; z], q, u, x, t) = 0                     (network states and algebraic unknowns)
 *
 * where the last rows of Phi_u may be velocity rows V u = n without a position (theory 14), with
 * coordinates q (n), speeds u (nu), N n x nu, m constraints Phi, M nu x nu, multipliers lambda
 * (m), network states x (nx) and algebraic unknowns z (nz), G (nx + nz). A System is complete when
 * system_new() returns, const ever after, and stores the revision of its model. It has two forms of
 * the same definitions. The expanded form is shown: a view forms each entry on request, as written
 * by hand. The recursive form is run: it has shared definitions, each emitted once. Both give the
 * same numbers. Expressions live in the model's arena. theory 3-8. */
#ifndef COTREE_FORMULATE_SYSTEM_SYSTEM_H
#define COTREE_FORMULATE_SYSTEM_SYSTEM_H

#include "base/call_monitor.h"
#include "formulate/system/surfaces.h"
#include "model/scene.h"

typedef struct System System;

/* Called for each entry of the components' values, and with instance NULL for each entry of
 * gravity: returns the expression to use instead. */
typedef Expr (*VaryValue)(void *context, const Instance *instance, int param, Expr value);

typedef struct SystemOptions {
    NetworkForm form; /* of the network's equations */
    VaryValue vary;   /* NULL: the values of the scene */
    void *context;
    /* S, in parallel to every scalar edge whose through variable is an expression of its across
     * variable: a start for the search of its state; NULL: none */
    Expr gmin;
    const System *like; /* in the same mode as this system, with its rests; NULL: in none */
    /* conditions of events whose guards may be held at 0 (system_rest_guard()) */
    const Expr *rests;
    int rest_count;
    bool has_lifted; /* numbers of parts may be parameters in it (lifted_constants.h) */
    const CallMonitor *watch;
} SystemOptions;

/* New, and const ever after; free with system_free(). Copies what it needs of the scene; the arena
 * must outlive it. Trees, variables and their order are the scene's, also with `vary`. Fails with
 * E_MODEL, E_ASSEMBLE (a constraint that is a non-zero constant), E_STOPPED. */
MUST_USE Status system_new(const Scene *scene, const SystemOptions *options, const System **out,
                           Diag *diag);
/* A view: owns what functions of a System that isn't const form on request: expanded entries,
 * reactions, switches, modes. New; free with system_free(). `formed` is borrowed, by any number of
 * views, and is not changed. */
System *system_view(const System *formed);
/* Both: a view that owns its System. Fails as system_new(). */
MUST_USE Status system_new_view(const Scene *scene, const SystemOptions *options, System **out,
                                Diag *diag);
/* Whether the scalar trees are normal trees: then the form of the user's trees is the state
 * form. */
bool system_tree_is_normal(const System *system);
void system_free(const System *system); /* NULL is fine */
/* Whether these are the equations of this scene too, because it differs from the original only in
 * numbers that are parameters of the equations. If so the view takes the scene's revision. What was
 * formed remains valid. */
bool system_follows(System *view, const Scene *scene);
/* whether it can be used where a System with these lifted constants and rests is needed */
bool system_serves(const System *system, const SystemOptions *options);
Expr system_lifted_constant(const System *system, int i); /* such a parameter; NULL at the end */
uint64_t system_revision(const System *system);
/* Whether it is valid for the current scene: it has this revision, and rows that vanished when the
 * equations were formed also vanish with the current parameters; `number` evaluates expressions. */
bool system_holds(const System *system, uint64_t revision,
                  double (*number)(const void *context, Expr e), const void *context);
Arena *system_arena(const System *system);
const char *system_instance_name(const System *system, int instance); /* borrowed */

/* --- variables; each list in the order in which the edges were made --- */

int system_n(const System *system);  /* coordinates q */
int system_nu(const System *system); /* speeds u */
int system_m(const System *system);  /* constraints: rows of positions, then of velocities alone */
/* the number of the former */
int system_position_rows(const System *system);
int system_nx(const System *system); /* network states x */
int system_nz(const System *system); /* network algebraic unknowns z */

typedef struct Variable {
    const char *name; /* "h8", "h8'", "lambda(1)", "M7.i" */
    Expr symbol;
    const Expr *derivative_of; /* NULL */
    int edge;                  /* the edge that it belongs to */
    int instance;
    bool is_angle;
    bool is_shape; /* of a flexible part */
    double unit;   /* nominal value: as much as 1 m, rad, m/s or rad/s of the part that it moves */
} Variable;

const Variable *system_q(const System *system, int i);
const Variable *system_u(const System *system, int i);
const Variable *system_x(const System *system, int i);
const Variable *system_z(const System *system, int i);
Expr system_acceleration(const System *system, int i); /* symbol of u'[i] */
Expr system_multiplier(const System *system, int k);   /* symbol of lambda(k+1) */
Expr system_state_rate(const System *system, int i);   /* symbol of x'[i] */
Expr system_q_rate(const System *system, int i);       /* row i of N u */
/* column j of Phi_u as a correction of q: dq_i = sum_j N_ij du_j; entry of N */
Expr system_n_entry(const System *system, int i, int j);
/* those of a row that may differ from 0, by ascending speeds, and their number; borrowed */
int system_n_row(const System *system, int i, const int **speeds, const Expr **entries);
/* index of the first of four Euler parameters whose norm must remain 1, or -1: call with 0, 1,
 * ... */
int system_quaternion(const System *system, int i);

/* --- instances of subsystems --- */

typedef struct Instanced {
    const char *name, *definition;
    int outer; /* the one that contains it; -1 */
    int first; /* the instance whose equations it took over by renaming; -1: they were derived */
    bool is_recalled; /* those of all its frames and masses were recalled from an earlier System */
} Instanced;

/* outer ones before those inside; NULL at the end */
const Instanced *system_instanced(const System *system, int i);

/* --- multi-turn angles of chords --- */

/* A turn of a chord that only sine and cosine determine, no sum of other turns: the angle is the
 * one nearest to `reference`, which the program that runs the system updates (theory 2). */
typedef struct MultiTurn {
    const char *name; /* of the joint's coordinate */
    Expr reference;   /* symbol: an angle that differs by less than half a turn */
    Expr angle;       /* in q and reference */
    Expr prescribed;  /* its value by a driver, in t and parameters; NULL: there is none */
} MultiTurn;

int system_multi_turn_count(const System *system);
const MultiTurn *system_multi_turn(const System *system, int i);
/* Its rate, to update `reference`: bounded also where sine and cosine vanish together. */
MUST_USE Status system_multi_turn_rate(System *system, int i, Expr *out, Diag *diag);

/* Where turns about one axis add up around a circuit their sum is known up to full turns. These are
 * added to the sum, and are constant in a run. A start chooses them, so that angles begin at their
 * given values, or within half a turn of 0. */
typedef struct WholeTurns {
    const char *name; /* of the chord's coordinate that is this angle; NULL: */
    int row;          /* it belongs to this constraint, which requires that the sum is 0 */
    Expr sum;         /* of angles, in q and parameters; the sum of a coordinate */
    Expr symbol;      /* rad; not a parameter of the model */
} WholeTurns;
int system_whole_turns_count(const System *system);
const WholeTurns *system_whole_turns(const System *system, int i);
/* Whether the equations contain full turns of any of them. O(nodes). */
bool system_reads_turns(const System *system);
/* Shows each sum with these full turns until the next call: one entry for each; NULL: none. */
void system_show_turns(System *view, const int *turns);
/* The same expression for a reader: full turns as in system_show_turns(), lifted constants as
 * numbers. */
Expr system_plain(const System *system, Expr e);
/* An expression for a reader: without named subexpressions, multiplied out, folded and collected
 * where that is shorter; folded only, where it is long. */
Expr system_written(System *system, Expr e);

/* An angle that a constraint compares by its sine alone, which is also 0 at half a turn: its
 * deviation, within half a turn, in q, t and parameters. NULL at the end */
typedef struct AngleOff {
    const char *name; /* of the coordinate */
    Expr off;
} AngleOff;
const AngleOff *system_angle_off(const System *system, int i);

/* --- parts between two frames --- */

/* a part that acts along a line: its length, which is nowhere 0 */
typedef struct FrameLine {
    const char *name, *tail, *head; /* of the part and its frames */
    Expr length;
} FrameLine;

/* The next one from instance *next (0) on; false at the end. */
bool system_line(System *system, int *next, FrameLine *out);

/* a part with an effort, or with components of force and torque */
typedef struct Pusher {
    const char *name;
    int count;
    Expr value[6];
} Pusher;

/* Likewise; skips parts whose law can't be determined. */
bool system_pusher(System *system, int *next, Pusher *out);

/* --- constraints --- */

typedef struct ConstraintRow {
    int edge; /* the chord that it belongs to */
    int instance;
    bool rotation;      /* moment row */
    char direction[24]; /* "x", "n1", "turn z": for messages */
    bool is_driver;
    bool is_coupler;
    bool is_rate; /* a velocity row: it restricts speeds, and no position */
} ConstraintRow;

const ConstraintRow *system_constraint(const System *system, int k);
/* redundant equations, which vanish identically, one line each ("h9: turning about z follows from
 * the rotation tree"); NULL at the end */
const char *system_dropped(const System *system, int i);
/* messages for the user about decisions during the build; NULL at the end */
const char *system_remark(const System *system, int i);

/* --- the recursive form: interned definitions, as named temporaries --- */

/* entry of a sparse matrix */
typedef struct Entry {
    int row, column;
    Expr value;
} Entry;

typedef struct EquationForm {
    Expr *phi;   /* m; 0 of velocity rows */
    Expr *phi_u; /* m x nu, row by row */
    Expr *nu;    /* m: Phi_u u = nu */
    Expr *gamma; /* m */
    Expr *mass;  /* nu x nu, symmetric; NULL until system_form_mass() */
    Expr *force; /* nu */
    /* G(w; q, u, x, t) = 0 for w = [x'; z]; A contains w too where `network_nonlinear` */
    Expr *network_residual; /* nx+nz: G */
    Entry *network;         /* A = dG/dw: its nonzero entries, row by row */
    int network_entries;
    Expr *network_rhs; /* nx+nz: r = -G at w = 0, so that A w = r where it is linear */
    bool network_nonlinear;
    Expr *q_rate; /* n */
} EquationForm;

/* Lets the monitor stop what is formed later, on request; borrowed. */
void system_set_watch(System *system, const CallMonitor *watch);

/* recursive definitions; a run uses them, or the expanded form where that is shorter */
const EquationForm *system_definitions(const System *system);
const EquationForm *system_run(const System *system);
/* Forms M in both, for a view, where a run does without it (composite_mass.h). Fails with
 * E_MEMORY. */
MUST_USE Status system_form_mass(System *view, Diag *diag);
/* --- the expanded form, entry by entry; folded; formed at the first call, then stored. Where M
 * would be far too long in this form, its entries and those of F refer to the definitions of the
 * recursive form. These are named temporaries, which are printed with names for shared
 * subexpressions --- */
typedef enum Block {
    BLOCK_MASS,
    BLOCK_FORCES,
    BLOCK_CONSTRAINTS,
    BLOCK_JACOBIAN,
    BLOCK_VELOCITY,
    BLOCK_ACCELERATION,
    BLOCK_NETWORK,
    BLOCK_NETWORK_RHS,
    BLOCK_EMBEDDED_MASS,   /* Mt = G^T M, f x n; with at most 3 constraints */
    BLOCK_EMBEDDED_FORCES, /* Ft = G^T F */
    BLOCK_DEPENDENT_RATES, /* J: q_d' = J q_i', in the order of system_partition() */
    BLOCK_COMPLEMENT,      /* G = [J; 1], of Phi_q without drivers: Phi_q G = 0; n x f */
    BLOCK_COUNT
} Block;
/* rows and columns of a block; columns 1 for vectors */
void system_block_size(const System *system, Block block, int *rows, int *columns);
const char *block_name(Block block); /* "mass", "forces" ... */
MUST_USE Status system_show(System *system, Block block, int row, int column, Expr *out,
                            Diag *diag);
/* The same entry without the others of its block: written out also where those are too long to be.
 */
MUST_USE Status system_show_alone(System *system, Block block, int row, int column, Expr *out,
                                  Diag *diag);
/* Coordinate partitioning of the embedded form (theory 6): speeds, the dependent ones first, and
 * the number of these. A new array, mem_free(). Fails as system_show() of embedded blocks does. */
MUST_USE Status system_partition(System *system, int **speeds, int *dependent, Diag *diag);
/* The largest entry of Phi_q G at random values of all symbols, relative to its terms; NAN where
 * none of them can be evaluated. */
MUST_USE Status system_complement_error(System *system, double *out, Diag *diag);
/* an entry of A; 0 where there is none. O(entries) */
Expr system_network_entry(const System *system, int row, int column);
/* all of A, row by row; a new array, freed with mem_free() */
Expr *system_network_matrix(const System *system);
NetworkForm system_network_form(const System *system);
/* states of parts' own: their start and how they are sampled. NULL at the end */
typedef struct OwnSample {
    int state;     /* in x */
    Expr initial;  /* in parameters */
    Expr period;   /* s; NULL: it isn't sampled, but has a rate */
    Expr next;     /* its value after a sampling instant, over the user's variables */
    bool is_input; /* the program that runs the model may set it */
} OwnSample;
const OwnSample *system_sample(const System *system, int i);
/* Where the states differ from those of state form: names of the latter, which are 0 at a start
 * that doesn't set them. NULL at the end */
const char *system_at_rest(const System *system, int i);
/* An expression of states and sources alone that must be 0; its derivative is among the network's
 * equations. NULL at the end */
Expr system_invariant(const System *system, int i);
/* electrical equations as printed: `left = right`, one for each network unknown */
int system_network_count(const System *system);
void system_network_equation(const System *system, int i, Expr *left, Expr *right);
int system_network_edge(const System *system, int i); /* the edge whose relation it is */

/* as written (expanded form) and after sharing (recursive form) */
MUST_USE Status system_count(System *system, Block block, bool shared, OpCount *out, Diag *diag);

/* Cost of one evaluation of the accelerations, in additions: operations of the program of a run,
 * with common subexpressions of its blocks counted once (*count), 20 for each function, and 2/3 N^3
 * + 2 N^2 for solving N = nu + m equations. Serves to compare trees. E_STOPPED, outputs
 * unchanged. */
MUST_USE Status system_price(const System *system, const CallMonitor *watch, OpCount *count,
                             double *price);

/* --- frames that turn about one axis --- */

/* Two frames with other turns between them that add up to one turn, about an axis fixed in both: a
 * virtual revolute joint can determine their orientation. In every position at which the joints of
 * the system hold. */
typedef struct CommonTurn {
    int tail; /* nodes; the tail is nearer to the datum */
    int head;
    Expr axis[3]; /* unit vector in the frame of the tail */
} CommonTurn;

/* The pair nearest to the datum, for each frame that is the end of such a pair. Pairs that are one
 * turn apart, and those that an edge joins already, are left out. A new list of *count, freed with
 * mem_free(). O(turns^2). */
CommonTurn *system_common_turns(const System *system, int *count);

/* --- variables that a user can name --- */

/* The expression of a user's expression (SYMBOL_VARIABLEs in it) in q, u, x, z, u', x', lambda, t
 * and parameters; stored. Fails with E_NAME, or E_MISSING for what this model can't determine (an
 * undetermined reaction). */
MUST_USE Status system_resolve(System *system, Expr user, Expr *out, Diag *diag);
/* one variable by name, `primes` derivatives of it */
MUST_USE Status system_variable(System *system, const char *path, int primes, Expr *out,
                                Diag *diag);

/* The point of a flexible part at a fraction of its length, 0 its root, in ground axes; false: the
 * part is rigid. Callers that draw it choose the number of points. */
bool system_axis_point(System *system, const Instance *part, Expr fraction, Expr point[3]);

/* energy.kinetic, energy.potential and the power of sources and losses, in (q, u, x, z, t) */
Expr system_kinetic(System *system);
Expr system_potential(System *system);
/* Power of sources minus losses, so that d/dt(kinetic + potential) = power; it contains lambda
 * where drivers do work. */
Expr system_power(System *system);

/* A condition at which the right-hand side may jump or have a kink: the difference a - b of a
 * comparison in the equations or in the condition that closes an ideal switch, or the argument of a
 * kink, in (t, q, u, x, z). */
typedef struct Switch {
    Expr condition;
    Expr call; /* the call that it belongs to */
    /* the surface on which the equations jump, in the state; -1: they have a kink at most */
    int surface;
} Switch;
/* All of them, time-only ones first, and the number of those in *time_only. In a mode, time-only
 * are those that depend on t alone in the hybrid system. */
int system_switches(System *system, const Switch **switches, int *time_only);
/* A surface: the expression that is 0 on it, whatever its scale and sign, and its law. Each pair is
 * there once. */
typedef struct SystemSurface {
    Expr condition;
    SurfaceLaw law;
    int load;       /* the unilateral surface whose effort is in the law's bound; -1: none */
    int part_count; /* components of the vector, or the one of coulomb(); 0: there are none */
    Expr part[3];
} SystemSurface;
bool system_surface(System *system, int i, SystemSurface *out); /* false at the end */
/* h of an event's condition h > 0, on positions and t, of a resolved condition: alone, or with
 * other comparisons that are true too. NULL: it has none, or several. */
Expr system_rest_guard(const System *system, Expr when);
/* the surface on which that is held (SystemOptions.rests); -1: none */
int system_rest_surface(System *system, Expr guard);
/* The surfaces on which a part (instance_sticks()) may rest, one or, of two limits, two: their
 * number. O(its law). */
int system_surfaces_of_part(System *system, const char *part, int *out, int room);
/* The part whose values jump or have a kink where that is 0, for messages; NULL: unknown. */
const char *system_jumping_part(System *system, Expr condition);
/* Hints, where no acceleration fits, at the parts whose friction is bounded by the load of their
 * joint: what they hold may press it more than that. False: there are none. */
bool system_hint_locking(System *system, Diag *diag);
/* the derivative of e along the motion, in u', x' and the other variables solved for; E_MISSING
 * where it can't be determined */
MUST_USE Status system_rate(System *system, Expr e, Expr *out, Diag *diag);

/* --- switches: diodes and switches, ideal or between two resistances ---
 *
 * A system has both sides of each in one equation. Its modes are systems in which every ideal
 * switch is on one side, with the tree, the states and the equations of that mode. The side of a
 * switch between two resistances is a number there, which a run sets, since all else is equal.
 * theory 8. */

typedef struct IdealSwitch {
    const char *name;
    Domain domain;
    int row;      /* of G, where both sides are in one equation; otherwise -1 */
    Expr when;    /* its closing condition, in this system's variables; NULL: a diode */
    Expr across;  /* minus the across variable where its sides meet, */
    Expr through; /* and minus the through variable there; both in this system's variables */
    Expr on;      /* across = on through when it is closed */
    /* across + least = off through when it is open, or, of a diode that leaks, across = off
     * through; off NULL: no flow */
    Expr off, least;
    Expr closed; /* symbol: 1 or 0, where the side is a number of the run; otherwise NULL */
    /* event function of a diode in a mode: positive while it remains on its side; otherwise NULL */
    Expr margin;
} IdealSwitch;

/* Across and through variable of a scalar edge, 0, 1 ... */
typedef struct ScalarPair {
    const char *name; /* of its part; borrowed */
    Domain domain;
    bool gives_across, gives_through; /* prescribes it, as a source does */
    bool stores, switches;
    bool gives_any;    /* a nullor's output: whatever makes its input 0 */
    bool energy_known; /* the energies include its stored energy */
    Expr across, through;
} ScalarPair;
int system_scalar_count(const System *system);
MUST_USE Status system_scalar(System *system, int i, ScalarPair *out, Diag *diag);

int system_ideal_count(const System *system);      /* number of all switches */
bool system_is_ideal(const System *system, int i); /* otherwise it is between two resistances */
/* Whether runs go through modes: not if all switches have resistances and the user chose another
 * form than the state form. */
bool system_has_modes(const System *system);
/* the symbol of a side that is a number in this system; NULL: it isn't one */
Expr system_side(const System *system, int i);
/* Fails as system_resolve() does. */
MUST_USE Status system_ideal(System *system, int i, IdealSwitch *out, Diag *diag);
/* The system for finding the sides: `whole` with both sides of ideal switches in one equation, and
 * numbers for the sides of others. Owned by `whole`. Fails as system_mode(). */
MUST_USE Status system_sided(System *whole, SceneSource source, const CallMonitor *watch,
                             System **out, Diag *diag);
/* The mode with these sides, one for each switch; those between resistances are ignored. Built at
 * the first request, and owned by `whole`. Fails as system_new() does where there is no such
 * network, and with E_MODEL where the scene differs from that of `whole`. */
MUST_USE Status system_mode(System *whole, SceneSource source, const bool *closed,
                            const CallMonitor *watch, System **out, Diag *diag);

/* --- turns that are singular: three angles where their first and last axis are parallel, and
 * rotation vectors at half a turn --- */

typedef struct Critical {
    const char *instance;   /* the instance with these turns; borrowed */
    const char *coordinate; /* of three angles that of the middle turn */
    const char *angles;     /* critical angles, in words */
    const char *effect;     /* what happens there, and what avoids it */
    const char *remedy;
    Expr measure; /* 0 there, between -1 and 1 */
} Critical;
#define CRITICAL_NEAR 0.02 /* the sine of about a degree: within it a message is given */
/* the i-th of the system, 0, 1 ...; false after the last */
bool system_critical(System *system, int i, Critical *out);

/* --- limits of the laws of storage elements --- */

typedef struct Bound {
    const char *instance; /* the instance with the law; borrowed */
    Expr measure; /* over the user's variables: the law is valid while its sign remains the same */
    bool is_gap;  /* charge or flux is unbounded there; otherwise it vanishes */
} Bound;
/* All of a system: a new array, mem_free(). O(parts). */
int system_bounds(const System *system, Bound **out);

/* --- charges and fluxes that depend on the motion: C(s) v, L(s) i --- */

typedef struct Storage {
    int state;    /* in x: the voltage or current */
    Expr content; /* charge or flux */
} Storage;
/* Those of states: a new array, mem_free(). O(parts). */
int system_storages(System *system, Storage **out);

/* --- nodes without charge --- */

/* Where x[state] is the current of a coil: the node at which it meets only coils, sources of
 * current and nonlinear laws, such as diodes and transistors. No charge then bounds the rate of its
 * voltage. NULL: there is none, or x[state] is no such current. O(parts^2). */
const Node *system_uncharged_node(const System *system, int state);

/* --- inverse runs: drivers, and the efforts that supply their motion --- */

typedef struct Drive {
    int instance;   /* of the driver */
    int constraint; /* its row in Phi, or -1 */
    Expr effort;    /* symbol of its unknown: its own effort, or the source's value (`by=`) */
    bool by_source; /* the effort is a voltage or current source's value */
} Drive;
/* A potential in the equations of a terminal to which nothing is connected; NULL: no more. */
Expr system_open_potential(const System *system, int i);
int system_drive_count(const System *system);
/* the name of a driver whose motion has no continuous second derivative; NULL: there is none */
const char *system_rough_driver(const System *system);
const Drive *system_drive(const System *system, int i);

#endif
