/* system_impl.h: what the files of formulation share
 *
 * Turns. The orientation of a frame is a product of turns along the rotation tree,
 * each about an axis that is constant in the position where every coordinate is 0,
 * and a constant rotation: R_0n = exp(k1 a1) exp(k2 a2) ... Z_n. Frames that differ by
 * constant rotations only share a *chain*: the last turn on their way. A vector fixed
 * in a frame is kept as (chain, Z_n r): neighbours about one axis merge because
 * their k are the same three expressions.
 *
 * Steps. Along the translation tree every node stands one constant or sliding shift
 * from its parent, a vector of one chain.
 *
 * Symbols: k axis of a turn, c a chain, n a node, r a shift, w angular velocity,
 * a0 acceleration that is left at u' = 0 (alpha0 likewise). */
#ifndef COTREE_FORMULATE_SYSTEM_IMPL_H
#define COTREE_FORMULATE_SYSTEM_IMPL_H

#include "base/memory.h"
#include "base/names.h"
#include "formulate/system.h"

typedef struct Vec {
    Expr at[3];
} Vec;

typedef struct Rotation {
    Expr at[9]; /* row by row */
} Rotation;

/* one turn of the rotation tree, or one free rotation by Euler parameters */
typedef struct Chain {
    int parent; /* -1: ground's own */
    int depth;
    int first; /* what hangs beyond it has the numbers first..last */
    int last;
    int resolve; /* chain in whose axes vectors of this one are computed by the reading to run */
    int speed;   /* the first of its speeds */
    int speed_count; /* 1, or 3 where it is free */
    bool is_free;
    Vec axis;   /* turn: zero-position axes, the same components before and after */
    Expr angle; /* turn: the coordinate, or its negative where the branch is passed backwards */
    Rotation matrix;   /* free: zero-position components after it to those before it */
    Expr parameter[4]; /* free: Euler parameters of that matrix */
} Chain;

/* a speed: what it moves, and along what */
typedef struct Speed {
    int chain;     /* that it turns; -1: none */
    int turn_node; /* that its branch of the rotation tree leads to */
    Vec axis;      /* of the turn, zero-position axes of `axis_chain` */
    int axis_chain;
    int slide_node; /* that its branch of the translation tree leads to; -1: it doesn't slide */
    Vec turn;       /* the axis in the axes of turn_node */
    Vec slide;      /* motion per unit in the axes of slide_node; both may be: a screw */
} Speed;

/* how a coordinate's rate follows from speeds */
typedef struct CoordinateRate {
    int count;
    int speed[3];
    Expr entry[3]; /* of N */
} CoordinateRate;

/* a shift coordinate in a step */
typedef struct Slide {
    int speed;
    Vec axis; /* of the step's chain, sign included */
} Slide;

typedef struct Frame { /* a mechanical node */
    int chain;
    Rotation zero; /* Z_n */
    /* step from the translation tree's parent; shift and slides point from it to this node */
    int parent; /* node; -1: ground */
    int base;   /* node in whose frame the shift is fixed: the edge's tail */
    int step_chain;
    Vec shift;
    int slide_count;
    Slide slide[3];
    /* quantities of the reading to run, in the axes of resolve(chain) */
    Vec step; /* the shift */
    Vec v;
    Vec product; /* velocity products of the step's acceleration */
    Vec p;       /* position, ground axes */
} Frame;

typedef struct ChainMotion { /* in the axes of its resolve chain */
    Vec w;
    Vec product; /* velocity products of the turn's angular acceleration */
} ChainMotion;

/* a mass at a node */
typedef struct Mass {
    int instance;
    int node;
    Expr mass;
    Rotation inertia; /* zero-position axes of the node's chain */
    bool has_inertia;
} Mass;

/* forces of one pass over the trees: at nodes, in the axes of resolve(chain of the node) */
typedef struct Loads {
    Vec *force;  /* one a node */
    Vec *torque; /* one a node */
} Loads;

/* what hangs beyond each node: sums of Loads inward */
typedef struct Sums {
    Vec *force;  /* of everything beyond in the translation tree, a node each */
    Vec *torque; /* of everything beyond in the rotation tree, arms included */
} Sums;

/* direction of a constraint row */
typedef enum RowKind {
    ROW_DATUM, /* n.d, n an axis of the datum */
    ROW_TAIL,  /* n.d, n fixed in the tail */
    ROW_DOT,   /* a_t . b_h */
    ROW_ANGLE, /* sum of turns about one axis */
    ROW_TIE,   /* u.d - lead times angle: a screw */
    ROW_DRIVER /* coordinate - f(t) */
} RowKind;

typedef struct Row {
    RowKind kind;
    int tail, head; /* nodes */
    Vec n;     /* DATUM: ground axes; TAIL, DOT (a), ANGLE (axis): zero axes of the tail's chain */
    Vec b;     /* DOT: zero axes of the head's chain */
    Expr phi;  /* to show */
    int owner; /* DRIVER: instance of the coordinate, and which */
    int coordinate;
    Expr lead; /* TIE: shift per turn's angle */
    Expr prescribed;
    ConstraintRow told;
} Row;

typedef struct TurnedChord {
    Turned told;
    int instance;
    int coordinate;
    Expr sine; /* both times one factor, 1 where the joint holds */
    Expr cosine;
} TurnedChord;

typedef struct CountedChord { /* whose angle is a sum */
    WholeTurns told;
    int instance, coordinate;
} CountedChord;

typedef struct Given {
    Expr symbol; /* a parameter */
    double value;
} Given;

typedef struct Sample { /* a random position */
    const System *system;
    double *q;
    double *parameter; /* in order of system->parameters */
} Sample;

/* multipliers of rows that vanished, from virtual branches that carry nothing (vanished.c) */
typedef struct Recovery {
    Expr *multipliers; /* mu, one a vanished row; 0 where it is open */
    Sums **sums;       /* what a unit of each puts beyond every node */
    int open_count;    /* combinations of mu that nothing determines */
    double *open;      /* vanished rows x open_count, at `sample` */
    Sample *sample;    /* the position */
} Recovery;

/* --- network --- */

enum { NETWORK_ORDER = 8 }; /* the highest of an equation */

typedef struct Branchlike { /* a scalar edge */
    int edge;
    int instance;
    int which;         /* of the instance's scalar edges */
    Relation relation; /* over the user's variables */
    bool branch;
    int cutset;    /* of a branch: its row among its tree's cutsets */
    int unknown;   /* its v or i is one; -1 */
    bool busy;     /* its v or i is being followed */
    bool is_steep; /* a chord whose v is the unknown, i following from it */
    int ideal;     /* which of the switches it is; -1 */
    Expr closed;   /* of one between two resistances: 1 or 0, a number of the run; NULL: it is none,
                      or both sides are in its equation */
    Expr v, i;     /* once known */
} Branchlike;

/* A network unknown and the equation that belongs to it: a state (with a rate), or algebraic. */
typedef struct Unknown {
    int branchlike; /* whose v (branch) or i (chord) it is, with its relation; -1 */
    int own;        /* a state of that instance's own; -1 */
    int instance;
    int derives; /* its equation is that of this unknown, differentiated; -1 */
    Expr symbol; /* y */
    Expr *rates; /* y', y'' ... as far as they are met; in the system's pool */
    int known;   /* how many */
    int order;   /* of the highest that is no expression of others */
    bool has_row;
    Expr left, right; /* its equation */
    Expr residual;    /* what a run solves instead of left - right; NULL: that */
} Unknown;

typedef struct NetworkEquation { /* as printed */
    Expr left, right;
    int edge; /* whose relation it is */
} NetworkEquation;

typedef struct CoordinateOwner {
    int instance;
    int coordinate;
} CoordinateOwner;

struct System {
    uint64_t revision;
    const Scene *scene; /* while it is made; NULL afterwards */
    Arena *arena;
    Pool *pool; /* names and small arrays */
    const Watch *watch;
    bool planar;
    Vec gravity;
    Form form;
    const char **independent;
    int independent_count;

    Instance *instances;
    int instance_count;
    Names *instance_names;   /* numbered as the instances */
    Names *coordinate_names; /* of all instances, */
    LIST(CoordinateOwner) coordinate_owners;
    Graph *graph;
    Tree *trees[TREE_KINDS];
    SignMatrix *cutsets[TREE_KINDS]; /* of scalar trees */
    const char **output_names;
    Expr *outputs;
    int output_count;

    LIST(Variable) q;
    LIST(Variable) u;
    LIST(Variable) x;
    LIST(Variable) z;
    Expr *accelerations;
    Expr *multipliers;
    LIST(Expr) rates;              /* of x, x' */
    int (*coordinate)[MAX_COORDS]; /* of an instance: its place in q, or -1 */

    int (*speed)[MAX_COORDS]; /* of an instance's coordinate: its place in u, or -1 */
    Speed *speeds;
    CoordinateRate *coordinate_rates;
    LIST(int) quaternions; /* the first of each four parameters */
    LIST(Chain) chains;
    Frame *frames; /* one a node of the graph; scalar nodes unused */
    ChainMotion *motions;
    Vec *alpha0; /* of chains, in the axes of their resolve chain */
    Vec *a0;     /* of nodes */
    LIST(TurnedChord) turned;
    LIST(CountedChord) counted;
    LIST(AngleOff) angles_off;
    LIST(Mass) masses;
    LIST(Row) rows;
    LIST(Row) vanished;     /* rows that hold in every position: no lambda tells what they carry */
    LIST(Given) parameters; /* as they were */
    LIST(const char *) dropped;
    LIST(const char *) remarks;

    NetworkForm network_form;
    NetworkForm asked_form; /* the same, where that exists */
    bool has_no_states;     /* a state form needs ever more derivatives */
    Expr leak; /* S, beside parts whose current is an expression of their voltage; NULL: none */
    LIST(int) ideals;   /* branches that switch, */
    const bool *closed; /* and the side that each ideal one is on; NULL: both are in one equation */
    bool takes_sides;   /* those between two resistances: their sides are numbers of the run */
    LIST(System *) modes; /* of those whose sides are open, made so far */
    System *sided;        /* the same whose sides are looked for; it or one of the modes */
    System *whole;        /* that it was made for, and which owns it; NULL: none */
    LIST(Branchlike) branches;
    int *scalar_of_edge; /* edge of the graph -> branches, or -1 */
    LIST(Unknown) unknowns;
    int listed;           /* unknowns that stand in x or z already */
    LIST(int) unknown_of; /* by expr_symbol_number(): unknown, and which rate of it, */
    LIST(int) rate_of;    /* as 1 + unknown and 0, 1, ...; 0: neither */
    int follow_depth;     /* of v and i being followed */
    bool leaves_trees;    /* the scalar trees in use aren't those of the user */
    bool is_network_open; /* unknowns may still be added */
    bool is_early;        /* reactions aren't there yet */
    bool asked_early;     /* and were asked for */
    bool met_loop;        /* following a chord led to a branch that is being followed */
    LIST(NetworkEquation) network_shown;
    LIST(OwnSample) samples;
    LIST(const char *) at_rest; /* in the form of the user's tree: states of state form, by name */
    LIST(Expr) invariants;      /* 0 throughout: rows that were differentiated */

    Reading definitions; /* by recursion, whatever the size */
    Reading run;         /* these, or the shorter equations as shown */
    LIST(Drive) drives;

    /* formed when asked for */
    Expr *shown[BLOCK_COUNT]; /* entries; NULL pointers until formed */
    Recovery *recovery;       /* NULL: not looked for yet, or no row vanished */
    Sums *actual;             /* with u', lambda: for reactions */
    Vec *actual_a;            /* accelerations of nodes */
    Vec *actual_alpha;        /* of chains */
    LIST(Switch) switches;
    LIST(Expr) surfaces; /* where they jump, in the state */
    int switches_of_time;
    bool switches_known;
    int64_t terms_guessed; /* of M written out; 0: not guessed yet */
    int depth;             /* of variables being resolved */
    /* how a name becomes an expression: system_variable(), which all that tells one stands before
     */
    Status (*variable)(System *system, const char *path, int primes, Expr *out, Diag *diag);
};

/* --- vectors (vector.c) --- */

Vec vec_zero(Arena *arena);
bool vec_is_zero(Vec a);
Vec vec_add(Arena *arena, Vec a, Vec b);
Vec vec_sub(Arena *arena, Vec a, Vec b);
Vec vec_scale(Arena *arena, Expr s, Vec a);
Vec vec_neg(Arena *arena, Vec a);
Vec vec_cross(Arena *arena, Vec a, Vec b);
Expr vec_dot(Arena *arena, Vec a, Vec b);
Vec vec_hold(Arena *arena, Vec a);
bool vec_same(Vec a, Vec b);
Rotation rotation_one(Arena *arena);
Rotation rotation_product(Arena *arena, const Rotation *a, const Rotation *b);
Rotation rotation_transpose(const Rotation *a);
Vec rotation_apply(Arena *arena, const Rotation *a, Vec b);
bool rotation_is_one(const Rotation *a);
Rotation inertia_turned(Arena *arena, const Rotation *z, const Expr tensor[6]); /* Z I Z^T */

/* --- frames and turns (frames.c) --- */

/* chains, frames and steps from the trees; masses. */
void frames_build(System *system);

typedef struct Turn {
    Vec axis;
    Expr angle;
    const Rotation *matrix; /* of a free rotation; NULL: a turn about the axis */
    bool back;              /* the matrix is passed backwards */
} Turn;
typedef LIST(Turn) Turns;

/* the turns that lead from one chain to another, neighbours about one axis merged: R_from_to */
void turns_between(const System *system, int from, int to, Turns *turns);
/* components of v in the axes of chain `to`, from those in chain `from` */
Vec vec_express(const System *system, Vec v, int from, int to);
/* what a speed turns about, in the axes of a chain */
Vec speed_axis(const System *system, int speed, int axes);
/* where it slides its node, per unit, in the axes of a chain; zero where it doesn't */
Vec speed_slide(const System *system, int speed, int axes);
/* the node nearest to the datum that it moves */
int speed_node(const System *system, int speed);
bool chain_is_beyond(const System *system, int chain, int turn); /* or the same */
/* angle of a constant rotation about an axis */
Expr rotation_angle(Arena *arena, const Rotation *rotation, Vec axis);
/* axes of the frame of a joint's tail to zero-position components */
Vec frame_vector(const System *system, int node, Vec in_frame);
/* the row's steps of an instance */
void instance_steps(const System *system, const Instance *instance, Steps *steps);

/* --- motion of the reading to run (recursive.c) --- */

void motion_build(System *system);
/* angular accelerations of chains and accelerations of nodes, with u' or (NULL) without */
void accelerations_build(System *system, const Expr *accelerations, Vec *alpha, Vec *a);
/* position of a node in ground axes, held */
Vec node_position(const System *system, int node);
/* sums inward over both trees of what acts on nodes; new arrays in the system's pool */
Sums *loads_sum(System *system, const Loads *loads);
Loads loads_new(System *system);
/* m (g - a) and -(I alpha + w x I w) of every mass */
void loads_add_inertia(System *system, Loads *loads, const Vec *alpha, const Vec *a);
void loads_add_force(System *system, Loads *loads, int node, Vec force, int chain);
void loads_add_torque(System *system, Loads *loads, int node, Vec torque, int chain);
/* a force or torque `effort` along a coordinate of an instance, on its head and reversed on its
 * tail */
void loads_add_effort(System *system, Loads *loads, const Instance *owner, int coordinate,
                      Expr effort);

/* --- what hangs beyond a node, taken together (composite.c) --- */

typedef struct Composite { /* about the node's origin, in its axes */
    Expr mass;
    Vec moment;
    Rotation inertia;
} Composite;

/* of every node, in the system's pool */
Composite *composites_new(System *system);
/* one unit of the speed moves everything beyond its branch as one rigid body */
bool speed_moves_as_one(const System *system, int speed);
/* what its branch feels of the composite beyond, per unit of u'; all else at rest */
void composite_loads(System *system, const Composite *composite, int speed, Loads *loads);

/* --- coordinates, also of chords (coordinate.c) --- */

/* the constant rotation that is left between the ends of a chord once its turns are undone: Z_h
 * R_0^T Z_t^T */
Rotation chord_constant(const System *system, const Instance *joint, const Steps *steps);
/* a turn of a chord: the sum of turns about its axis where they merge, else its sine and cosine */
typedef struct ChordTurn {
    Expr angle; /* NULL: sine and cosine instead */
    Expr sine;
    Expr cosine;
} ChordTurn;
/* `which` of one or two turns */
void chord_turn(System *system, const Instance *owner, const Steps *steps, int which,
                ChordTurn *out);
/* (turned.c) which turns of chords are told by sine and cosine alone */
void turned_build(System *system);
/* the angle of such a turn; NULL: it is none of them */
Expr turned_angle(const System *system, int instance, int coordinate);
/* the whole turns that the angle of a chord has beside the sum that tells it; 0: it has none */
Expr turned_whole(const System *system, int instance, int coordinate);
/* to rows of angles that sum up to 0, in the reading to run */
void turned_add_rows(System *system);
/* a driver makes it so */
void turned_drive(System *system, int instance, int coordinate, Expr prescribed);
/* the way from tail to head along a slide's axis */
Expr slide_value(System *system, const Instance *owner, const Step *slide);
/* (euler_parameters.c) Euler parameters of a frame against ground, and of a head against a tail,
 * scalar part first */
void frame_parameters(System *system, int node, Expr p[4]);
void relative_parameters(System *system, int tail, int head, Expr p[4]);
/* axis of a joint's turn, where it is now: zero-position components of *chain */
Vec joint_axis(System *system, const Instance *owner, const Steps *steps, int which, int *chain);
/* a screw: shift and turn by one coordinate */
bool steps_are_tied(const Steps *steps);
/* value of a coordinate and its first and second derivatives, branch or chord */
MUST_USE Status coordinate_value(System *system, const Instance *owner, int coordinate, int primes,
                                 Expr *out, Diag *diag);
/* derivative along the motion: q -> q', u -> u', x -> x', t -> 1 */
MUST_USE Status rate_of(System *system, Expr e, Expr *out, Diag *diag);
/* derivative of e(q) per unit of a speed */
Expr partial(System *system, Expr e, int speed);
/* E_MISSING while reactions, multipliers and entries of M can't be told yet */
MUST_USE Status wait_for_motion(System *system, Diag *diag);
/* e over user's variables to e over the system's */
MUST_USE Status resolve(System *system, Expr user, Expr *out, Diag *diag);

/* --- efforts (efforts.c): springs, motors, forces --- */

typedef struct Effort {
    const Instance *instance;
    Expr displacement, rate, value; /* along the line or the joint's coordinate */
    Vec direction;                  /* line: from tail to head, ground axes */
    bool is_line;
} Effort;

MUST_USE Status effort_of(System *system, const Instance *instance, Effort *out, Diag *diag);
/* what an effort adds to M in the column of a speed, per unit of its coordinate, and what is left
 * of it at u' = 0. E_MODEL where it isn't linear in u'. */
MUST_USE Status effort_inertia(System *system, const Effort *effort, int speed, Expr *out,
                               Diag *diag);
Expr effort_at_rest(System *system, const Effort *effort);
/* wrench of force and torque components: in axes of *chain */
MUST_USE Status wrench_of(System *system, const Instance *instance, Vec *force, Vec *torque,
                          int *chain, Diag *diag);
/* everything that pushes, without inertia and multipliers: springs on joints left out unless
 * `joints` */
MUST_USE Status efforts_add(System *system, Loads *loads, bool joints, Diag *diag);

/* --- numbers at a random position (sample.c) --- */

/* in the system's pool; `vary`: with other parameters too, for what holds whatever they are */
Sample *sample_new(System *system, uint64_t seed, bool vary);
/* of an expression in q and parameters; NAN where there is more in it */
double sample_number(Sample *sample, Expr e);

/* --- constraints (constraints.c), dynamics (dynamics.c), network (network.c), expanded.c --- */

MUST_USE Status constraints_build(System *system, Diag *diag);
MUST_USE Status dynamics_build(System *system, Diag *diag);
MUST_USE Status network_build(System *system, Diag *diag);
/* in state form in the place of the user's tree (network_tree.c) */
MUST_USE Status network_normal_tree(System *system, TreeKind kind, Diag *diag);
/* residuals and their Jacobian, once dynamics is there (network_rows.c) */
MUST_USE Status network_rows(System *system, Diag *diag);
/* the equation of an unknown, left = right */
MUST_USE Status network_row(System *system, int unknown, Diag *diag);
const Instance *branch_owner(const System *system, const Branchlike *branch);
Branchlike *scalar_branch(System *system, const Instance *instance, int which);
/* its member names: "i", or of an edge with a suffix "s.i" */
const char *branch_member(System *system, const Branchlike *branch, bool through);
TreeKind branch_tree(const System *system, const Branchlike *branch);
/* the next rate of a network symbol; E_MISSING where it can't be told */
MUST_USE Status network_rate(System *system, Expr symbol, Expr *out, Diag *diag);
bool network_knows(const System *system, Expr symbol);
/* the number of a new unknown, whose symbol is of that name and kind */
int network_new_unknown(System *system, Unknown unknown, const char *name, SymbolKind kind);
/* one rate more of an unknown, as a symbol */
Expr network_add_rate(System *system, int unknown, SymbolKind kind);
/* one whose equation is the relation of that edge, without symbol yet */
Unknown unknown_of_branch(const System *system, const Branchlike *branch);
/* `symbol` is the rate of that order of an unknown */
void network_know(System *system, Expr symbol, int unknown, int order);
/* the unknowns as states x and algebraic z of the System: new ones behind the old */
void network_list(System *system);
/* in the form of the user's tree: which rates are states, which is solved for (network_order.c) */
MUST_USE Status network_bring_order(System *system, Diag *diag);
/* what an expression is where all its symbols have values that the seed chooses, 0.7 to 1.3 */
double value_somewhere(Expr e, uint32_t seed);
/* v of a chord along its circuit */
MUST_USE Status circuit_across(System *system, Branchlike *branch, Expr *out, Diag *diag);
/* names of the edges in the circuit of a chord or the cutset of a branch; in the pool */
const char *network_company(System *system, const Branchlike *branch);
/* Whether an edge of a port gives its own variable (v of a branch, i of a chord) by the other edge;
 * where it doesn't its equation is the other of the two. */
bool port_gives_own(System *system, const Branchlike *branch);
/* how many switches are without resistance on one side or on both (ideal.c) */
int system_truly_ideal_count(const System *system);
/* the relation of a switch, on its side or of both (ideal.c) */
void ideal_take_side(System *system, Branchlike *branch);
/* What closed switches alone in a circuit share, or open ones alone in a cutset: currents as if by
 * equal resistances, voltages likewise. *shared: it is so, and *out = 0 */
MUST_USE Status ideal_share(System *system, const Branchlike *branch, bool *shared, Expr *out,
                            Diag *diag);
/* what changes sign where a function jumps or kinks; NULL: it does neither (switches.c) */
Expr switch_condition(Arena *arena, Expr e);
/* e is differentiated in time for `who`: E_MODEL where it jumps */
MUST_USE Status need_smooth(System *system, const char *who, Expr e, Diag *diag);
/* voltage and current of a scalar edge */
MUST_USE Status network_across(System *system, Branchlike *branch, Expr *out, Diag *diag);
MUST_USE Status network_through(System *system, Branchlike *branch, Expr *out, Diag *diag);

/* vectors as sums over chains, for the reading to show (framesum.c) */
typedef struct Part {
    int chain;
    Vec v; /* zero-position axes of the chain */
} Part;

typedef struct FrameSum {
    Part *parts; /* in the system's pool, by chain */
    int count;
} FrameSum;

FrameSum framesum_add(System *system, FrameSum a, Expr scale, FrameSum b);
FrameSum framesum_of(System *system, int chain, Vec v);
/* k of chain `turn` crossed with each part */
FrameSum framesum_cross(System *system, Vec axis, int chain, FrameSum b);
Expr framesum_dot(System *system, FrameSum a, FrameSum b);
/* the way from one node to another along the translation tree */
FrameSum framesum_way(System *system, int from, int to);

/* false: entries of M and F are too long for that, and stand over their definitions */
bool system_writes_out(System *system);

/* --- the cheaper reading (reading.c) --- */

MUST_USE Status reading_choose(System *system, Diag *diag);
/* an entry of what is shown, whole turns with it (expanded.c) */
MUST_USE Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag);

/* --- the embedded form (embedded.c) --- */

MUST_USE Status embedded_mass(System *system, int row, int column, Expr *out, Diag *diag);
MUST_USE Status embedded_force(System *system, int row, int column, Expr *out, Diag *diag);
int embedded_rows(const System *system); /* drivers don't count as constraints in it */
/* the effort of the only driver of a system with one freedom, in q, u and u' */
MUST_USE Status embedded_effort(System *system, const Row *driver, Expr *out, Diag *diag);

/* --- reactions (reactions.c, vanished.c) --- */

/* accelerations with u', sums inward with lambda */
MUST_USE Status actual_build(System *system, Diag *diag);
/* what a constraint row puts on its two ends: -lambda along its direction */
void loads_add_row(System *system, Loads *loads, const Row *row, Expr lambda);
/* multipliers of the rows that vanished, from the loads without them */
void recovery_build(System *system, const Loads *loads);

typedef struct ReactionPart { /* a component of a force or a moment */
    bool moment;
    bool own; /* in the axes of the tail, not of the datum */
    int axis; /* 0, 1, 2 */
} ReactionPart;
MUST_USE Status joint_reaction(System *system, const Instance *joint, ReactionPart part, Expr *out,
                               Diag *diag);

const char *system_keep(System *system, const char *format, ...)
    PRINTF(2, 3); /* text in the pool */

#endif
