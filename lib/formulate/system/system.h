/* system.h: a model's equations: a symbolic DAE with named variables
 *
 *     q' = N u,   Phi(q,t) = 0,   Phi_u u = nu,   Phi_u u' = gamma
 *     M u' + Phi_u^T lambda = F(q, u, x, z, t)
 *     G([x'; z], q, u, x, t) = 0                     (network states and algebraic unknowns)
 *
 * A System is finished when made, const ever after, and remembers the revision of its model. It
 * has two readings of the same definitions: one to show (each entry written as by hand, formed
 * by a view when asked for) and one to run (shared definitions, each emitted once). Both give the
 * same numbers. Expressions live in the model's arena. theory 3-8. */
#ifndef COTREE_FORMULATE_SYSTEM_SYSTEM_H
#define COTREE_FORMULATE_SYSTEM_SYSTEM_H

#include "base/call_monitor.h"
#include "model/scene.h"

typedef struct System System;

/* Asked for each entry of the components' values, and with the instance NULL for each of gravity:
 * what shall stand there instead. */
typedef Expr (*VaryValue)(void *context, const Instance *instance, int param, Expr value);

typedef struct SystemOptions {
    NetworkForm form; /* of the network's equations */
    VaryValue vary;   /* NULL: the values are those of the scene */
    void *context;
    Expr gmin; /* S, beside every scalar edge whose through variable is an expression of its across
                  variable: where a search for its state may begin; NULL: none */
    const System *like; /* in the mode of this one; NULL: in none */
    bool has_literals;  /* numbers of parts may stand in it as parameters (lifted_constants.h) */
    const CallMonitor *watch;
} SystemOptions;

/* New, and const ever after; free with system_free(). Copies what it needs of the scene; the arena
 * must outlive it. Trees, variables and their order are the scene's, whatever varies. Fails with
 * E_MODEL, E_ASSEMBLE (a constraint that is a non-zero constant), E_STOPPED. */
MUST_USE Status system_new(const Scene *scene, const SystemOptions *options, const System **out,
                           Diag *diag);
/* A view: what functions of a System that isn't const form when they are asked, and keep: entries
 * written out, reactions, switches, modes. New; free with system_free(). `formed` is borrowed, by
 * any number of views, and stays as it is. */
System *system_view(const System *formed);
/* Both: a view that owns what it is a view on. Fails as system_new(). */
MUST_USE Status system_new_view(const Scene *scene, const SystemOptions *options, System **out,
                                Diag *diag);
/* Whether the scalar trees are normal trees: then the form of the user's trees is state form. */
bool system_tree_is_normal(const System *system);
void system_free(const System *system); /* NULL is fine */
/* Whether these are the equations of the scene too, which differs from that they were made of in
 * numbers alone that stand in them as parameters: then they are of its revision from now on. What
 * was formed of them stays. */
bool system_follows(System *view, const Scene *scene);
/* whether it serves who asks for a System with that option */
bool system_serves(const System *system, bool has_literals);
Expr system_literal(const System *system, int i); /* such a parameter; NULL at the end */
uint64_t system_revision(const System *system);
/* Of the scene as it is: of its revision, and what vanished when the equations were made vanishes
 * with the parameters of now, of which `number` evaluates expressions. */
bool system_holds(const System *system, uint64_t revision,
                  double (*number)(const void *context, Expr e), const void *context);
Arena *system_arena(const System *system);
const char *system_instance_name(const System *system, int instance); /* borrowed */

/* --- variables; each list in order of the edges' making --- */

int system_n(const System *system);  /* coordinates q */
int system_nu(const System *system); /* speeds u */
int system_m(const System *system);  /* constraints */
int system_nx(const System *system); /* network states x */
int system_nz(const System *system); /* network algebraic unknowns z */

typedef struct Variable {
    const char *name; /* "h8", "h8'", "lambda(1)", "M7.i" */
    Expr symbol;
    const Expr *derivative_of; /* NULL */
    int edge;                  /* that brings it */
    int instance;
    bool is_angle;
    bool is_shape; /* of a part that deforms */
    double unit;   /* how much of it counts as 1 m, rad, m/s or rad/s of the part that it moves */
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
/* those of a row that may not be 0, by rising speeds, and how many; borrowed */
int system_n_row(const System *system, int i, const int **speeds, const Expr **entries);
/* first of four Euler parameters to be kept at unit length, or -1: call with 0, 1, ... */
int system_quaternion(const System *system, int i);

/* --- instances of subsystems --- */

typedef struct Instanced {
    const char *name, *definition;
    int outer;        /* the one around it; -1 */
    int first;        /* whose equations it took over, in its own names; -1: they were derived */
    bool is_recalled; /* those of all its frames and masses were known from an earlier System */
} Instanced;

/* an outer one before those inside; NULL at the end */
const Instanced *system_instanced(const System *system, int i);

/* --- angles of chords over full turns --- */

/* A turn of a chord that no sum of other turns tells, only its sine and cosine: the angle is the
 * one nearest to `reference`, which whoever runs the system keeps next to it (theory 2). */
typedef struct MultiTurn {
    const char *name; /* of the joint's coordinate */
    Expr reference;   /* symbol: an angle less than half a turn away */
    Expr angle;       /* in q and reference */
    Expr prescribed;  /* what a driver makes it, in t and parameters; NULL: there is none */
} MultiTurn;

int system_multi_turn_count(const System *system);
const MultiTurn *system_multi_turn(const System *system, int i);
/* Its rate, for keeping `reference` next to it: bounded also where sine and cosine vanish together.
 */
MUST_USE Status system_multi_turn_rate(System *system, int i, Expr *out, Diag *diag);

/* Where turns about one axis add up around a circuit their sum is known but for whole turns: what
 * is added to the sum, and stays as it is in a run. A start chooses it, so that angles begin where
 * they were given, or within half a turn of 0. */
typedef struct WholeTurns {
    const char *name; /* of the chord's coordinate whose angle it is; NULL: */
    int row;          /* it belongs to this constraint, which says that the sum is 0 */
    Expr sum;         /* of angles, in q and parameters; of a coordinate */
    Expr symbol;      /* rad; a parameter of no model */
} WholeTurns;
int system_whole_turns_count(const System *system);
const WholeTurns *system_whole_turns(const System *system, int i);
/* Whether the equations read full turns of any of them. O(nodes). */
bool system_reads_turns(const System *system);
/* Show each sum with so many full turns until the next call: an entry one; NULL: none. */
void system_show_turns(System *view, const int *turns);
/* The same expression for a reader: full turns as system_show_turns() has them, literals as
 * numbers. */
Expr system_plain(const System *system, Expr e);

/* An angle that a constraint compares by its sine alone, which half a turn off holds too: how far
 * it is off, within half a turn, in q, t and parameters. NULL at the end */
typedef struct AngleOff {
    const char *name; /* of the coordinate */
    Expr off;
} AngleOff;
const AngleOff *system_angle_off(const System *system, int i);

/* --- parts between two frames --- */

/* what pulls along a line: its distance, which is nowhere 0 */
typedef struct FrameLine {
    const char *name, *tail, *head; /* of the part and its frames */
    Expr length;
} FrameLine;

/* The next one from instance *next (0) on; false at the end. */
bool system_line(System *system, int *next, FrameLine *out);

/* a part that pushes, and what it exerts: an effort, or components of force and torque */
typedef struct Pusher {
    const char *name;
    int count;
    Expr value[6];
} Pusher;

/* Likewise; parts whose law can't be determined are passed over. */
bool system_pusher(System *system, int *next, Pusher *out);

/* --- constraints --- */

typedef struct ConstraintRow {
    int edge; /* chord that it belongs to */
    int instance;
    bool rotation;      /* moment row */
    char direction[24]; /* "x", "n1", "turn z": for messages */
    bool is_driver;
    bool is_coupler;
} ConstraintRow;

const ConstraintRow *system_constraint(const System *system, int k);
/* equations that vanished identically, one line each ("h9: turning about z follows from the
 * rotation tree"); NULL at the end */
const char *system_dropped(const System *system, int i);
/* lines about what was decided on the way, for the user; NULL at the end */
const char *system_remark(const System *system, int i);

/* --- the recursive form: interned, held definitions --- */

/* entry of a sparse matrix */
typedef struct Entry {
    int row, column;
    Expr value;
} Entry;

typedef struct EquationForm {
    Expr *phi;   /* m */
    Expr *phi_u; /* m x nu, row by row */
    Expr *nu;    /* m: Phi_u u = nu */
    Expr *gamma; /* m */
    Expr *mass;  /* nu x nu, symmetric; NULL until system_form_mass() */
    Expr *force; /* nu */
    /* G(w; q, u, x, t) = 0 for w = [x'; z]; w stands in A too where `network_nonlinear` */
    Expr *network_residual; /* nx+nz: G */
    Entry *network;         /* A = dG/dw: entries that aren't 0, row by row */
    int network_entries;
    Expr *network_rhs; /* nx+nz: r = -G at w = 0, so that A w = r where it is linear */
    bool network_nonlinear;
    Expr *q_rate; /* n */
} EquationForm;

/* What is formed later, when somebody asks for it, can be stopped, too; borrowed. */
void system_set_watch(System *system, const CallMonitor *watch);

/* definitions by recursion; a run uses them, or where it is shorter what is shown */
const EquationForm *system_definitions(const System *system);
const EquationForm *system_run(const System *system);
/* Write M out in both, for a view, where a run does without (composite_mass.h). Fails with
 * E_MEMORY.
 */
MUST_USE Status system_form_mass(System *view, Diag *diag);
/* --- the expanded form, entry by entry; folded; formed at the first call, then kept. Where M
 * would be far too long to be written out its entries, and those of F, stand over the definitions
 * of the recursive form: held expressions, to be printed with names for what they share --- */
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
    BLOCK_COUNT
} Block;
/* rows and columns of a block; columns 1 for vectors */
void system_block_size(const System *system, Block block, int *rows, int *columns);
const char *block_name(Block block); /* "mass", "forces" ... */
MUST_USE Status system_show(System *system, Block block, int row, int column, Expr *out,
                            Diag *diag);
/* an entry of A; 0 where there is none. O(entries) */
Expr system_network_entry(const System *system, int row, int column);
/* all of A, row by row; a new array, to be freed with mem_free() */
Expr *system_network_matrix(const System *system);
NetworkForm system_network_form(const System *system);
/* states of parts' own: where they start, and what samples them. NULL at the end */
typedef struct OwnSample {
    int state;     /* in x */
    Expr initial;  /* of parameters */
    Expr period;   /* s; NULL: it isn't sampled, but has a rate */
    Expr next;     /* its value behind a sampling instant, over the user's variables */
    bool is_input; /* or what the program that runs the model gives */
} OwnSample;
const OwnSample *system_sample(const System *system, int i);
/* Where states are other variables than in state form: names of those, which are 0 at a start that
 * nothing is said of. NULL at the end */
const char *system_at_rest(const System *system, int i);
/* What states and sources have to satisfy by themselves, = 0; it stands differentiated among the
 * network's equations. NULL at the end */
Expr system_invariant(const System *system, int i);
/* electrical equations as printed: `left = right`, one a network unknown */
int system_network_count(const System *system);
void system_network_equation(const System *system, int i, Expr *left, Expr *right);
int system_network_edge(const System *system, int i); /* whose relation it is */

/* as written (expanded form) and after sharing (recursive form) */
MUST_USE Status system_count(System *system, Block block, bool shared, OpCount *out, Diag *diag);

/* What one evaluation of the accelerations costs, in additions: operations of the program of a run,
 * what its blocks have in common counted once (*count), 20 for each function, and 2/3 N^3 + 2 N^2
 * for solving N = nu + m equations. To compare trees by. E_STOPPED, outputs unchanged. */
MUST_USE Status system_price(const System *system, const CallMonitor *watch, OpCount *count,
                             double *price);

/* --- frames that turn about one axis --- */

/* Two frames with other turns between them that add up to one turn, about an axis fixed in both:
 * a virtual revolute joint can tell their orientation. In every position at which the joints of
 * the system hold. */
typedef struct CommonTurn {
    int tail; /* nodes; the tail is nearer to the datum */
    int head;
    Expr axis[3]; /* unit vector in the frame of the tail */
} CommonTurn;

/* The pair that reaches furthest back to the datum, for each frame that is the end of such a pair.
 * Pairs at one turn's distance, and those that an edge joins already, are left out. A new list of
 * *count, to be freed with mem_free(). O(turns^2). */
CommonTurn *system_common_turns(const System *system, int *count);

/* --- variables a user can ask for --- */

/* The expression of a user's expression (SYMBOL_VARIABLEs in it) in q, u, x, z, u', x', lambda, t
 * and parameters; kept. Fails with E_NAME, or E_MISSING for what this model can't tell (an
 * undetermined reaction). */
MUST_USE Status system_resolve(System *system, Expr user, Expr *out, Diag *diag);
/* one variable by name, `primes` derivatives of it */
MUST_USE Status system_variable(System *system, const char *path, int primes, Expr *out,
                                Diag *diag);

/* The point of a part that deforms at a fraction of its length, 0 its root, in ground axes; false:
 * the part is rigid. What draws it asks for as many as it needs. */
bool system_axis_point(System *system, const Instance *part, Expr fraction, Expr point[3]);

/* energy.kinetic, energy.potential and the power of sources and losses, in (q, u, x, z, t) */
Expr system_kinetic(System *system);
Expr system_potential(System *system);
/* Power that sources give and losses take, so that d/dt(kinetic + potential) = power; holds
 * lambda where drivers work. */
Expr system_power(System *system);

/* A condition at which the right-hand side may jump or kink: the difference a - b of a comparison
 * in the equations and in what closes ideal switches, the argument of a kink, in (t, q, u, x, z).
 */
typedef struct Switch {
    Expr condition;
    Expr call;   /* whose it is */
    int surface; /* on which the equations jump, in the state; -1: they bend at most */
} Switch;
/* All of them, time-only ones first, and *time_only how many of those: in a mode those that hold t
 * alone in the whole. */
int system_switches(System *system, const Switch **switches, int *time_only);
/* What is 0 on a surface, each once whatever its scale and sign; NULL at the end. */
Expr system_surface(System *system, int i);
/* The part whose values jump or bend where that is 0, for messages; NULL: not known. */
const char *system_jumping_part(System *system, Expr condition);
/* the derivative of e along the motion, in u', x' and what else they solve for; E_MISSING where it
 * can't be determined */
MUST_USE Status system_rate(System *system, Expr e, Expr *out, Diag *diag);

/* --- switches: diodes and switches, ideal or between two resistances ---
 *
 * A system holds both sides of each in one equation. Its modes are systems in which every ideal one
 * is on a side, with the tree, the states and the equations of that; the side of one between two
 * resistances is a number there, which a run sets, since all else is the same. theory 8. */

typedef struct IdealSwitch {
    const char *name;
    Domain domain;
    int row;         /* of G, where both sides are in one equation; else -1 */
    Expr when;       /* what closes it, of this system's variables; NULL: a diode */
    Expr across;     /* less what is across it where its sides meet, */
    Expr through;    /* and less what flows there; both as this system tells them */
    Expr on;         /* across = on through when it is closed */
    Expr off, least; /* across + least = off through when it is open, or, of a diode that leaks,
                        across = off through; off NULL: nothing flows */
    Expr closed;     /* symbol: 1 or 0, where the side is a number of the run; else NULL */
    Expr margin;     /* of a diode in a mode: positive as long as it stays on its side; else NULL */
} IdealSwitch;

/* Across and through variable of a scalar edge, 0, 1 ... */
typedef struct ScalarPair {
    const char *name; /* of its part; borrowed */
    Domain domain;
    bool gives_across, gives_through; /* as a source, whatever meets it */
    bool stores, switches;
    bool gives_any;    /* a nullor's output: whatever keeps its input at nothing */
    bool energy_known; /* what it stores is in the energies */
    Expr across, through;
} ScalarPair;
int system_scalar_count(const System *system);
MUST_USE Status system_scalar(System *system, int i, ScalarPair *out, Diag *diag);

int system_ideal_count(const System *system);      /* of all switches */
bool system_is_ideal(const System *system, int i); /* else it is between two resistances */
/* Whether runs go through modes: not with resistances alone where another form than that of states
 * was asked for. */
bool system_has_modes(const System *system);
/* the symbol of a side that is a number in this system; NULL: it isn't */
Expr system_side(const System *system, int i);
/* Fails as system_resolve() does. */
MUST_USE Status system_ideal(System *system, int i, IdealSwitch *out, Diag *diag);
/* The system from which sides are found: `whole` with both sides of ideal switches in one equation,
 * and numbers for those of others. Owned by it. Fails as system_mode(). */
MUST_USE Status system_sided(System *whole, SceneSource source, const CallMonitor *watch,
                             System **out, Diag *diag);
/* The system in which they are on these sides, one a switch; those between resistances don't count.
 * Made when asked for first, and owned by `whole`. Fails as system_new() does where there is no
 * such network, and with E_MODEL where the scene is no longer what `whole` was made of. */
MUST_USE Status system_mode(System *whole, SceneSource source, const bool *closed,
                            const CallMonitor *watch, System **out, Diag *diag);

/* --- three-angle sequences, which lose a freedom where their first and last axis fall together ---
 */

typedef struct Critical {
    const char *instance;   /* whose turns they are; borrowed */
    const char *coordinate; /* of the turn between */
    const char *angles;     /* at which it happens, in words */
    Expr measure;           /* 0 there, between -1 and 1 */
} Critical;
#define CRITICAL_NEAR 0.02 /* the sine of about a degree: there it is said */
/* the i-th of the system, 0, 1 ...; false after the last */
bool system_critical(const System *system, int i, Critical *out);

/* --- where the law of a part that stores ends --- */

typedef struct Bound {
    const char *instance; /* whose law it is; borrowed */
    Expr measure;         /* over the user's variables: the law holds while it keeps its sign */
    bool is_gap;          /* charge or flux grow beyond bounds there; else they vanish */
} Bound;
/* All of a system: a new array, mem_free(). O(parts). */
int system_bounds(const System *system, Bound **out);

/* --- charges and fluxes that what moves changes: C(s) v, L(s) i --- */

typedef struct Storage {
    int state;    /* in x: the voltage or current */
    Expr content; /* charge or flux */
} Storage;
/* Those of states: a new array, mem_free(). O(parts). */
int system_storages(System *system, Storage **out);

/* --- nodes without charge --- */

/* Where x[state] is the current of a coil: the node at which it meets only coils, sources of
 * current and nonlinear laws, as diodes and transistors, so that no charge bounds the rate of its
 * voltage; NULL: there is none, or x[state] is no such current. O(parts^2). */
const Node *system_uncharged_node(const System *system, int state);

/* --- inverse runs: drivers, and what supplies their motion --- */

typedef struct Drive {
    int instance;   /* of the driver */
    int constraint; /* its row in Phi, or -1 */
    Expr effort;    /* symbol of its unknown: its own effort, or the source's value (`by=`) */
    bool by_source; /* the effort is a voltage or current source's value */
} Drive;
/* A potential in the equations of a terminal on which nothing stands: NULL: no more. */
Expr system_open_potential(const System *system, int i);
int system_drive_count(const System *system);
/* A driver whose motion has no continuous derivative of that order, by name; NULL: there is none */
const char *system_rough_driver(const System *system, int order);
const Drive *system_drive(const System *system, int i);

#endif
