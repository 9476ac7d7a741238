/* component.h: one row for each component type, one Instance for each part of the user's model
 *
 * The row defines what the type adds to the graph, its statement, its joint primitives from tail to
 * head (motion and reaction space follow), its effort or its scalar relation, its members and its
 * help. The engine calls a row, and never tests which row it is. Rows are const tables; an Instance
 * is owned by its model. */
#ifndef COTREE_COMPONENT_COMPONENT_H
#define COTREE_COMPONENT_COMPONENT_H

#include "expr/expr.h"
#include "graph/graph.h"

typedef struct Component Component;
typedef struct Instance Instance;

/* --- values in a statement --- */

typedef enum ParamKind {
    PARAM_SCALAR,  /* an expression of parameters */
    PARAM_LAW,     /* an expression of t, parameters and variables */
    PARAM_VECTOR,  /* three components in the frame named in `meaning`; two in a planar scene (z is
                      0) */
    PARAM_LAWS,    /* a vector of such expressions */
    PARAM_INERTIA, /* planar: one number (Izz); spatial: three or six: Ixx Iyy Izz [Ixy Ixz Iyz]
                      tensor entries */
    PARAM_MOMENT,  /* a torque: planar one number (z), spatial a vector; of laws */
    PARAM_AXIS,    /* x y z -x -y -z or a vector; stored as a unit vector, exact where possible */
    PARAM_AXES,    /* two of them */
    /* z(90 deg)*x(a): stored as the 9 entries of R_tail_head, row by row, from head to tail axes */
    PARAM_ROTATION,
    PARAM_LIST,      /* one or more expressions of parameters, [a, b]; fallback "": none */
    PARAM_LIST_LAWS, /* one or more laws */
    PARAM_WORD /* one of the words in `fallback`, separated by '|'; the first is the default */
} ParamKind;

typedef enum ParamUse {
    POSITIONAL = 1,   /* its key may be omitted after the terminals: arm r m [..] */
    GIVES_SOURCE = 2, /* an across or through variable, independent of the rest of the network */
    GIVES_LOAD = 4,   /* an effort that acts on bodies from outside */
    GIVES = GIVES_SOURCE | GIVES_LOAD,
    /* these params of a row are subtracted from each other: one dimension for all, whichever it
     * is */
    ALIKE = 8,
    ALONG = 16, /* may vary along the part: as a polynomial of x, the position along it */
    GEARS = 32, /* where it is given, other values belong to a shaft that turns, even on a length */
    PAIRED = 64 /* where it isn't given, it has the value of the other PAIRED param of the row */
} ParamUse;

typedef struct Param {
    const char *name;
    ParamKind kind;
    /* of its value, as in brackets: "kg*m^2"; "" none, NULL any. Two separated by '|': on a length
     * (a line, a slide), and on an angle */
    const char *unit;
    const char *fallback; /* the default: a number (for vectors: each entry), an axis' letter (for
                             axes: two), the words; NULL: must be given */
    const char *meaning;
    int use; /* of ParamUse */
} Param;

/* the applicable unit: the first of "N/m|N*m" on a length, the second on an angle; new string,
 * NULL: any */
char *param_unit(const Param *param, bool on_angle);
/* which of the two units applies to a part */
bool instance_takes_angle(const Instance *instance, const Param *param);
/* whether it holds without a bound, as a stop; and whether a run may hold it at rest at all */
bool instance_is_rigid(const Instance *instance);
bool instance_sticks(const Instance *instance);
/* the param whose value applies: that param or, where it is PAIRED and not given, the other one */
int instance_in_force(const Instance *instance, int param);

typedef struct Value {
    bool given;                    /* set by the user, not the fallback */
    int count;                     /* entries of `at` */
    Expr *at;                      /* in the pool of its owner */
    const char *word;              /* of PARAM_WORD */
    const struct Measure *measure; /* of an ALIKE param (model/measure.h); NULL: any */
} Value;

/* --- terminals of a statement --- */

typedef enum Places {
    PLACES_NONE,   /* body m1: makes the frame of its own name, edge ground -> m1 */
    PLACES_FROM,   /* arm r5 m1: makes the frame of its own name, edge m1 -> r5 */
    PLACES_FRAMES, /* revolute h8 r1 r2: edge r1 -> r2 */
    PLACES_ON,     /* force F1 m3: edge ground -> m3 */
    PLACES_LINK,  /* spring k1 r1 r2, or spring k1 h8: between two frames or on a joint's coordinate
                   */
    PLACES_JOINT, /* brake b1 h8: a joint's coordinate; or two terminals (variants) */
    PLACES_JOINTS,     /* clutch c1 h1 h2: two of them; or two terminals */
    PLACES_COORDINATE, /* driver D1 h8 = expr: a coordinate of a joint or (driver) a body */
    PLACES_TERMINALS,  /* resistor R1 a b: the terminals of its scalar edges */
    PLACES_TRANSDUCER, /* motor M7 h1 a 0: on joint h1's coordinate, then terminals */
    PLACES_SENSED,     /* sensor v1 h8' a 0: an expression of variables, then terminals */
    PLACES_PARTS       /* coupling K1 L1 L2: two scalar parts of its domain */
} Places;

typedef enum Family {
    FAMILY_BODY,
    FAMILY_ARM,
    FAMILY_JOINT,
    FAMILY_DRIVER,
    FAMILY_COUPLER, /* between coordinates of joints */
    FAMILY_CONTACT, /* rows of motion between two frames at a point: wheels, blades */
    FAMILY_FORCE,
    FAMILY_SCALAR,
    FAMILY_TRANSDUCER
} Family;

/* --- joint primitives of an edge with motion, from tail to head: first shifts, in tail axes, then
 * turns --- */

typedef struct Step {
    /* unit vector: for a shift in tail axes; for a turn in the axes after the turns before it */
    Expr axis[3];
    int coordinate; /* number of the instance's coordinate that moves it */
    Expr scale;     /* distance or angle = scale * coordinate; 1 except for a screw's shift */
} Step;

typedef struct Steps {
    int shift_count;
    Step shift[3];
    Expr constant[3]; /* a fixed shift in tail axes (arms); zeros otherwise */
    int turn_count;
    Step turn[3];
    bool quaternion; /* rotation by Euler parameters in coordinates `first_parameter`..+3, instead
                        of turns */
    int first_parameter;
    Expr rotation[9]; /* constant R_0 after the turns */
} Steps;

typedef enum CoordinateKind {
    COORDINATE_LENGTH,
    COORDINATE_ANGLE,
    COORDINATE_PARAMETER,
    COORDINATE_TWIST /* of a shape, in rad: it turns no frame as a whole */
} CoordinateKind;

typedef struct CoordinateRow {
    /* "x", "theta", "s1"; "" when the instance's own name is the coordinate's name */
    const char *member;
    CoordinateKind kind;
    bool rotation; /* it belongs to the rotation half */
} CoordinateRow;

/* --- flexible parts: shapes with coordinates of their own, after those of its pose ---
 *
 * All in the axes of its root, the frame that its edge leads to; theory 9. */

typedef struct ShapeState { /* symbols, or their replacements */
    const Expr *q, *rate;   /* of each shape */
    Expr w[3];              /* angular velocity of the root */
} ShapeState;

typedef struct SectionFrame { /* position and orientation of a frame on a flexible part */
    Expr position[3];
    Expr angle[3]; /* of turns about z, then the new y, then the newest x (rad) */
    Expr bend[3];  /* position'' in the axes of the root at q'' = 0 */
    Expr twist[3]; /* angle'' at q'' = 0 */
    Expr *shift;   /* d position/d q: shapes x 3 */
    Expr *turn;    /* d angle/d q, likewise */
} SectionFrame;

/* arrays of a ShapeInertia: ROW(name, entries where there are `count` shapes) */
#define SHAPE_ARRAYS_OF_ROOT(ROW)                                                                  \
    ROW(moment, 3) ROW(inertia, 9) ROW(bias_force, 3) ROW(bias_torque, 3)
#define SHAPE_ARRAYS_OF_SHAPES(ROW)                                                                \
    ROW(with_shift, 3 * count)                                                                     \
    ROW(with_turn, 3 * count)                                                                      \
    ROW(block, count *count)                                                                       \
    ROW(bias, count) ROW(push, count) ROW(stress, count) ROW(drive, count)
/* for a load that is a sum of `powers` powers of xi, the position along the part over its length */
#define SHAPE_ARRAYS_OF_LOAD(ROW)                                                                  \
    ROW(extent, powers) ROW(spread, 3 * powers) ROW(spread_shift, 3 * powers * count)

/* Its local block over the acceleration a of the root, its angular acceleration alpha and q'',
 * minus a field of weight g: force = mass (a - g) + alpha x moment + sum with_shift q'' +
 * bias_force, and so on. `own` acts on q, including elasticity and damping. */
typedef struct ShapeInertia {
    Expr mass, moment[3], inertia[9];
    Expr *with_shift, *with_turn; /* shapes x 3 */
    Expr *block;                  /* shapes x shapes */
    Expr bias_force[3], bias_torque[3], *bias;
    Expr *push;         /* of elasticity and damping */
    Expr *stress;       /* of elasticity alone */
    Expr stored;        /* elastic energy, J */
    Expr *load;         /* per length, ground axes, over the user's variables: powers x 3 */
    Expr *extent;       /* integral of each power along the part, */
    Expr *spread;       /* its first moment, powers x 3, */
    Expr *spread_shift; /* and its generalised forces: powers x shapes x 3 */
    Expr *drive;        /* other generalised forces on q, over the user's variables */
} ShapeInertia;

typedef struct SectionPart { /* a component of the load in a section, in its axes */
    const char *name;
    bool in_plane, in_space, moment;
    int axis;
} SectionPart;

typedef struct Deforming {
    int (*count)(const Instance *instance, bool planar);
    CoordinateRow (*coordinate)(const Instance *instance, bool planar, int i);
    /* nominal value of a shape's coordinate: it moves no point by more than 1 m, or turns none by
     * more than 1 rad */
    double (*unit)(const Instance *instance, bool planar, int i);
    /* number of powers of its load along the part; 0: there is no load */
    int (*load_powers)(const Instance *instance, Arena *arena);
    /* section frame at the position `at` from its root; the arrays of `out` have room for all
     * shapes */
    void (*station)(const Instance *instance, Arena *arena, bool planar, Expr at,
                    const ShapeState *state, SectionFrame *out);
    /* inertia of the part beyond the position `from` */
    void (*inertia)(const Instance *instance, Arena *arena, bool planar, Expr from,
                    const ShapeState *state, ShapeInertia *out);
    /* the force or moment in a section with that name, "bending"; the name ends at its bracket.
     * NULL as function: the part has no length, and no sections */
    const SectionPart *(*section)(bool planar, const char *name);
} Deforming;

/* --- contacts: rows of motion between two frames, in axes of the tail --- */

/* how far the head is from the tail */
typedef struct FramesApart {
    Expr way[3];  /* from the tail's origin to the head's (m) */
    Expr turn[9]; /* from axes of the head to those of the tail, row by row */
    Expr angle;   /* planar: of the head against the tail (rad); otherwise NULL */
} FramesApart;

/* The velocity of the head's point against the tail's point has no component along `along`, or its
 * angular velocity has none. */
typedef struct ContactRow {
    const char *direction; /* for messages */
    Expr along[3];         /* a unit vector, of a turn of any length */
    /* the position whose rate that component is, 0 in contact (m, rad); NULL: there is none */
    Expr gap;
    bool turns;
} ContactRow;

enum { CONTACT_ROWS = 3 };

typedef struct Contact {
    Expr point[3]; /* from the head's origin to the point of contact */
    Expr normal[3];
    int count;
    ContactRow row[CONTACT_ROWS];
} Contact;

/* an ellipse about the tip's origin, first cos a + second sin a (m), in axes of the tip: to draw */
typedef struct ContactRing {
    Expr first[3], second[3];
} ContactRing;

enum { MOST_RINGS = 3 };

/* --- parts that resist every motion of two frames --- */

enum { MOST_RELATIVE = 6 }; /* coordinates of one frame against another */

/* --- efforts: forces between two frames or on a joint, and transducers --- */

typedef struct Motion1 { /* what an effort or relation may depend on; 0 where it doesn't apply */
    Expr displacement;   /* distance between the two frames, or the joint's coordinate */
    Expr rate;
    Expr across;  /* voltage of the (first) scalar edge */
    Expr through; /* its current, from plus to minus inside */
} Motion1;

/* --- scalar edges and their relations --- */

typedef struct ScalarEdge {
    const char *suffix; /* "p": T1.p; "" for the part's own name */
    int plus, minus;    /* indices of the part's terminals; -1: the datum */
    Branching branching;
    int preference; /* in trees: sources of across 10, storage of across 20, resistive 30, storage
                       of through 40, sources of through 50 */
} ScalarEdge;

typedef enum RelationKind {
    RELATION_ACROSS,     /* v = value */
    RELATION_THROUGH,    /* i = value */
    RELATION_RESISTIVE,  /* v = value * i + rest */
    RELATION_CONDUCTIVE, /* i = value, which contains the edge's own v: a diode */
    RELATION_CAPACITIVE, /* i = content' + rest */
    RELATION_INDUCTIVE,  /* v = content' + rest */
    /* of a part with two edges: v = value or i = inverse, over the v and i of the other edge; each
     * edge gives one of them, depending on the tree */
    RELATION_PORT,
    RELATION_FREE,     /* value = 0, which determines neither: a nullor's output */
    RELATION_IMPLICIT, /* value = 0, over its own v and i: a resistance that may be 0 */
    RELATION_IDEAL     /* closed v = on i + least, open i = v/off: see Ideal */
} RelationKind;

/* A switch or diode. In runs its relation is that of its current side. Elsewhere both sides are one
 * equation. For an ideal one, without resistance on one side or on both, that gives neither v nor
 * i. Closed v = on i + least, through the open side's point v = least, i = least/off. */
typedef struct Ideal {
    /* its closing condition; NULL: a diode, which closes at v > least and opens below */
    Expr when;
    Expr on;    /* resistance when closed, or 0 */
    Expr off;   /* resistance when open; NULL: no flow */
    Expr least; /* across variable at which it begins to conduct */
} Ideal;

/* of one scalar edge; over t, parameters and the user's variables, including its own */
typedef struct Relation {
    RelationKind kind;
    Expr value;
    Expr inverse; /* RESISTIVE whose value contains the edge's own i: i over its v; may be NULL */
    Expr content; /* charge or flux, or its equivalent in other domains */
    Expr rest;    /* back-emf, resistance of a winding; 0 */
    Expr stored;  /* energy in the edge, J; NULL: none, or unknown in closed form */
    /* the expression whose rate `value` contains, so that it must not jump; NULL: none */
    Expr smooth;
    Ideal ideal;   /* of RELATION_IDEAL, and where the part `switches` */
    bool switches; /* between two resistances: `ideal` has them, `value` contains both */
} Relation;

/* a state of a part's own, x' = rate, or one that is constant between sampling instants and then
 * replaced */
typedef struct OwnState {
    const char *member; /* "integral": c1.integral */
    Expr initial;
    Expr rate;     /* 0 where it is sampled */
    Expr period;   /* s; NULL: continuous */
    Expr next;     /* sampled: its value from a sampling instant on, over values just before it */
    bool is_input; /* the program that runs the model may set it instead */
} OwnState;

/* --- rows --- */

typedef struct Member { /* a named quantity of an instance: h9.fx, R1.power */
    const char *name;
    const char *unit;
    const char *meaning;
    int primes; /* number of time derivatives that have names */
} Member;

struct Component {
    const char *name;
    /* rows of the same name, NULL at the end. PLACES_JOINT, PLACES_JOINTS: on terminals, one a
     * domain; PLACES_COORDINATE: of the rate of the coordinate. NULL: none */
    const struct Component *const *variants;
    bool is_of_rates; /* PLACES_COORDINATE: that one */
    bool sticks;      /* dry friction, which a run holds at rest */
    Family family;
    Domain domain; /* of its scalar edge, or MECHANICAL */
    Places places;
    const char *brief;
    const Param *params;
    int param_count;
    const CoordinateRow *coords; /* spatial */
    int coord_count;
    const CoordinateRow *coords_planar; /* NULL: as spatial */
    int coord_count_planar;
    /* spatial, where values decide which coordinates it has (euler=); NULL: always `coords` */
    const CoordinateRow *(*coords_of)(const Instance *instance, int *count);
    /* refused in a planar scene: what to use there instead; NULL: it may be used */
    const char *not_in_plane;
    Branching translation; /* of its mechanical edge; of the scalar edge of those that have one */
    Branching rotation;    /* BRANCH_NEVER for forces, and for the mechanical edge of transducers */
    /* for completion: lower first; joints 10, plus, in each tree, 1 for each coordinate of that
     * half; bodies 50; virtual joints add 1000 */
    int preference;
    void (*steps)(const Instance *instance, Arena *arena, bool planar,
                  Steps *out); /* bodies, arms, joints */
    /* bodies: mass and inertia about the mass centre, body axes, as Ixx Iyy Izz Ixy Ixz Iyz tensor
     * entries (planar: Izz alone, the others 0); NULL where it has none */
    void (*inertia)(const Instance *instance, Arena *arena, bool planar, Expr *mass,
                    Expr tensor[6]);
    const Deforming *deforming; /* NULL: it is rigid */
    /* PLACES_ON: force and torque on the head, in ground axes or, with *in_body, in the head's */
    void (*wrench)(const Instance *instance, Arena *arena, bool planar, Expr force[3],
                   Expr torque[3], bool *in_body);
    /* FAMILY_CONTACT and what has `press`: its rows, the first along the normal, and the point at
     * which their forces act */
    void (*contact)(const Instance *instance, Arena *arena, bool planar, const FramesApart *apart,
                    Contact *out);
    bool turns; /* its rows are of turns: it acts with a moment, and at no point */
    bool joins; /* it is a rod from the tail's origin to the head's: to draw */
    /* what a picture shows of a round tip: the number of rings; NULL: nothing */
    int (*rings)(const Instance *instance, Arena *arena, bool planar, ContactRing out[MOST_RINGS]);
    /* PLACES_COORDINATE: the prescribed value, an expression of t and parameters; for a coupler one
     * of parameters and other coordinates, or of their rates, by the user's names */
    Expr (*prescribed)(const Instance *instance, Arena *arena);
    /* the force along the line (on the head, away from the tail) or the generalised force on the
     * joint's coordinate (on the head); NULL where it exerts none */
    Expr (*effort)(const Instance *instance, Arena *arena, const Motion1 *motion);
    /* of friction between two frames or in a joint of several coordinates: the force or torque on
     * the head against one component of their motion, whose norm is `speed`; NULL: there is but
     * that one. load: of a contact that opens its normal force, otherwise NULL */
    Expr (*rub)(const Instance *instance, Arena *arena, Expr rate, Expr speed, Expr load);
    /* of a contact that opens: the normal force on the head, never negative, by its gap and the
     * rate of that; `contact` gives both. NULL: it is none, or what it has are rows */
    Expr (*press)(const Instance *instance, Arena *arena, Expr gap, Expr rate);
    /* Of a part that resists every motion of its frames: efforts on the head along `count`
     * coordinates x of it in axes of the tail, 6 in space (position, rotation vector) and 3 in the
     * plane, and the share of them that is lost. Returns the energy that it stores, J. */
    Expr (*restore)(const Instance *instance, Arena *arena, int count, const Expr *x,
                    const Expr *rate, Expr *effort, Expr *lost);
    /* of a part that sticks: the most that its dry friction is at this rate, or at rest the most
     * that it holds; load as above */
    Expr (*bound)(const Instance *instance, Arena *arena, Expr rate, Expr load, bool at_rest);
    /* whether it holds without a bound, on one side; NULL: never */
    bool (*is_rigid)(const Instance *instance);
    Expr (*potential)(const Instance *instance, Arena *arena,
                      const Motion1 *motion); /* energy stored; NULL: none */
    Expr (*rotor)(const Instance *instance,
                  Arena *arena);    /* inertia on the joint's coordinate (motor J); NULL: none */
    int terminal_count;             /* of scalar parts; 0: two */
    const char *terminal_usage;     /* " A B C D", for help; NULL: by the places */
    const ScalarEdge *scalar_edges; /* NULL: one from the first terminal to the second */
    int scalar_edge_count;
    /* of scalar edge `which`. In `motion` across and through are that edge's own, as the user's
     * variables; displacement and rate are those of the joint's coordinate, likewise. */
    void (*relation)(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                     Relation *out);
    /* its law, a current from its voltage, is so long that it is shown by name */
    bool has_named_law;
    /* PLACES_PARTS: adds its terms to the relation of the edge of parts[which] */
    void (*couple)(const Instance *instance, Arena *arena, const Instance *const parts[2],
                   int which, Relation *out);
    /* entry of the symmetric matrix of the energy that its parts store together */
    Expr (*stores)(const Instance *instance, Arena *arena, const Instance *const parts[2], int row,
                   int column);
    const char *couples; /* the row that its parts must have */
    /* "x": its own states are x1, x2 ..., and `members` contains the first; NULL: each has a
     * member */
    const char *state_stem;
    int (*own_state_count)(const Instance *instance); /* NULL: none */
    void (*own_state)(const Instance *instance, Arena *arena, int k, OwnState *out);
    const Member *members; /* in addition to those of its family */
    int member_count;
    const char *positive; /* the param that must be above 0; NULL: none */
    /* Refuses values that no model can have. Values of parameters alone are numbers here, and only
     * numbers are checked. May be NULL. */
    Status (*check)(const Instance *instance, Arena *arena, bool planar, Diag *diag);
    /* adds a line about permitted but unlikely numbers; may be NULL */
    void (*doubt)(const Instance *instance, bool planar, Text *out);
    const char *help;
    const char *example; /* statements that run from an empty session */
    const char *see;
};

struct Instance {
    const Component *row;
    const char *name; /* borrowed from the model */
    int number;       /* in order of making */
    bool is_virtual;
    int tail; /* nodes; a scalar component's plus and minus; -1 where none */
    int head;
    int edge; /* mechanical edge, -1: none (a spring on a joint has one along the joint's frames) */
    int terminal_count;          /* of a scalar part; 0: it has none */
    int *terminals;              /* nodes */
    const char **terminal_names; /* "0": the datum */
    int scalar_count;
    int *scalar_edges;
    int parts[2]; /* PLACES_PARTS: instances; -1 */
    Expr sensed;  /* PLACES_SENSED: over the user's variables; NULL */
    /* equation block of a part whose equations no row defines (equation_block.h); NULL */
    const struct EquationBlock *given;
    int joint; /* the instance whose coordinate it acts on; -1 */
    int joint_coordinate;
    int rubbed; /* the joint against whose motion as a whole it acts; -1 */
    /* PLACES_JOINTS: the one whose coordinate the effort acts on with the other sign; -1 */
    int second_joint;
    int second_coordinate;
    const char *coordinate; /* its name, as in the user's expressions; NULL */
    bool on_angle;          /* that coordinate is an angle */
    bool is_geared;         /* a value of use GEARS is given */
    Value *values;          /* one for each param of the row */
    int coord_count;
    /* number of coordinates that place its head: they come first, those of shapes follow */
    int pose_count;
    const char **coord; /* names: "h8", "m1.x", or the user's coord= */
    CoordinateKind *coord_kind;
    bool *coord_rotation;
    /* driver: instance (a source) or coordinate owner that supplies the motion; -1: its own
     * effort */
    int by;
    int by_coordinate; /* -1 when `by` is a source */
    const char *text;  /* its statement */
};

/* whether it is flexible along a length, as a beam is */
bool instance_bends(const Instance *instance);
/* The coordinates of its pose in this scene, once its values are read. */
const CoordinateRow *instance_coords(const Instance *instance, bool planar, int *count);
/* The number of its coordinates, including those of shapes, and the i-th of them. */
int instance_coord_count(const Instance *instance, bool planar);
CoordinateRow instance_coord(const Instance *instance, bool planar, int i);
/* Refuses values that no model can have, by the row's check; values are numbers where possible. */
MUST_USE Status instance_check(const Instance *instance, Arena *arena, bool planar, Diag *diag);
const Component *component_find(const char *name);           /* exact; NULL */
const Component *component_at(int i);                        /* 0, 1, ...; NULL at the end */
int component_param(const Component *row, const char *name); /* -1: none */
int component_source(const Component *row); /* the param that makes it a source; -1: none */
/* the one of its params that is an input from outside, a single number; -1: none */
int instance_input(const Instance *instance);
const Value *instance_value(const Instance *instance,
                            const char *name); /* assert that the row has it */
/* whether the user gave a key; false also where the row has none of that name */
bool instance_has(const Instance *instance, const char *name);
Expr instance_scalar(const Instance *instance, const char *name); /* its only entry; NULL: none */
/* A copy of values and of all they own. */
Value *values_copy(Pool *pool, const Value *values, int count);
/* The parameter that replaces an entry of a value in the equations: "#b1.mass[0]" */
Expr instance_lifted_constant(const Instance *instance, Arena *arena, int param, int entry);
/* Members of an instance of this family and row, in order: NULL at the end. Those of its
 * coordinates (Instance.coord) are not repeated here, unless the family has them anyway. */
const Member *component_member(const Component *row, bool planar, int i);
/* whether its edge is between frames alone: no transducer */
bool component_acts_on_frames(const Component *row);
const Member *component_find_member(const Component *row, bool planar, const char *name); /* NULL */

/* --- helpers for scalar rows --- */

/* The variable that a user writes for a member: "R1.i"; for a second edge "T1.s.v". */
Expr instance_variable(const Instance *instance, Arena *arena, const char *member);
/* The joint's coordinate that the part acts on, with `primes` derivatives: "h1'". */
Expr instance_coordinate(const Instance *instance, const Instance *joint, Arena *arena, int primes);
/* The same without primes, where the joint isn't available: to differentiate a law of the
 * position. */
Expr instance_joint_coordinate(const Instance *instance, Arena *arena);
/* potential of one of its terminals: "c.v"; 0 at the datum */
Expr instance_potential(const Instance *instance, Arena *arena, int terminal);
/* its scalar edges; *count of them */
const ScalarEdge *component_scalar_edges(const Component *row, int *count);
int component_terminals(const Component *row);
/* across or through variable of a part's scalar edge, by the names of its domain */
Expr instance_across(const Instance *instance, Arena *arena, int which);
Expr instance_through(const Instance *instance, Arena *arena, int which);
/* names of both variables in a domain: "v" and "i", "p" and "flow" ... */
const char *domain_across(Domain domain);
const char *domain_through(Domain domain);
const char *domain_across_unit(Domain domain);
/* time derivative of an expression over t, parameters and the user's variables: over those and
 * their primed names */
Expr system_user_rate(Arena *arena, Expr e);

/* helpers for the joint primitives of rows */
void steps_none(Arena *arena, Steps *out); /* no shift, no turn, R_0 = 1 */
void steps_shift(Arena *arena, Steps *out, const Expr axis[3], int coordinate);
void steps_turn(Arena *arena, Steps *out, const Expr axis[3], int coordinate);
/* the number of free motions: translation, rotation (a screw's one counts in both) */
void steps_freedom(const Steps *steps, int freedom[2]);
/* n1, n2 that form a right-handed triad u, n1, n2 with the unit vector u: x y for z, and so on in
 * cyclic order; for other u, n1 is orthogonal to the axis that has the smallest component of u. */
void axis_complement(Arena *arena, const Expr u[3], Expr n1[3], Expr n2[3]);

#endif
