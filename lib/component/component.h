/* component.h: one row a component type, one Instance a part of the user's model
 *
 * The row says what the type adds to the graph, how its statement reads, its steps
 * from tail to head (motion and reaction space follow), its effort or its scalar
 * relation, its members and its help. The engine asks a row, and never asks which row
 * it is. Rows are const tables; an Instance is owned by its model. */
#ifndef COTREE_COMPONENT_COMPONENT_H
#define COTREE_COMPONENT_COMPONENT_H

#include "expr/expr.h"
#include "graph/graph.h"

typedef struct Component Component;
typedef struct Instance Instance;

enum { MAX_COORDS = 7, MAX_VALUE = 9 };

/* --- how a statement gives its values --- */

typedef enum ParamKind {
    PARAM_SCALAR,   /* an expression of parameters */
    PARAM_LAW,      /* an expression of t, parameters and variables */
    PARAM_VECTOR,   /* three components in the frame named in `meaning`; two in a planar scene (z is
                       0) */
    PARAM_LAWS,     /* a vector of such expressions */
    PARAM_INERTIA,  /* planar: one number (Izz); spatial: three or six: Ixx Iyy Izz [Ixy Ixz Iyz]
                       tensor entries */
    PARAM_MOMENT,   /* a torque: planar one number (z), spatial a vector; of laws */
    PARAM_AXIS,     /* x y z -x -y -z or a vector; kept as a unit vector, exact where it is */
    PARAM_AXES,     /* two of them */
    PARAM_ROTATION, /* z(90 deg)*x(a): kept as 9 entries, row by row, tail components of head axes'
                       matrix R_tail_head */
    PARAM_WORD      /* one of the words in `fallback`, between '|', the first is the default */
} ParamKind;

typedef struct Param {
    const char *name;
    ParamKind kind;
    const char *unit;     /* of its value, as in brackets: "kg*m^2"; "" none, NULL any. Two between
                             '|': on a length (a line, a slide), on an angle */
    const char *fallback; /* the default: a number (for vectors: each entry), an axis' letter (for
                             axes: two), the words; NULL: must be given */
    const char *meaning;
    bool positional; /* may stand without its key behind the places (arm r m [..], resistor R1 a b
                        10) */
} Param;

typedef struct Value {
    bool given; /* by the user, not the fallback */
    int count;  /* entries of `at` */
    Expr at[MAX_VALUE];
    const char *word; /* of PARAM_WORD */
} Value;

/* --- what the statement connects --- */

typedef enum Places {
    PLACES_NONE,   /* body m1: makes the frame of its own name, edge ground -> m1 */
    PLACES_FROM,   /* arm r5 m1: makes the frame of its own name, edge m1 -> r5 */
    PLACES_FRAMES, /* revolute h8 r1 r2: edge r1 -> r2 */
    PLACES_ON,     /* force F1 m3: edge ground -> m3 */
    PLACES_LINK, /* spring k1 r1 r2, or spring k1 h8: between two frames or on a joint's coordinate
                  */
    PLACES_COORDINATE, /* driver D1 h8 = expr: a coordinate of a joint or body */
    PLACES_TERMINALS,  /* resistor R1 a b: scalar edge a -> b */
    PLACES_TRANSDUCER  /* motor M7 h1 a 0: on joint h1's coordinate, and scalar edge a -> b */
} Places;

typedef enum Family {
    FAMILY_BODY,
    FAMILY_ARM,
    FAMILY_JOINT,
    FAMILY_DRIVER,
    FAMILY_FORCE,
    FAMILY_SCALAR,
    FAMILY_TRANSDUCER
} Family;

/* --- steps of an edge with motion, from tail to head: shifts first, in tail axes, then turns ---
 */

typedef struct Step {
    Expr axis[3];   /* unit vector: of a shift in tail axes; of a turn in the axes that the turns
                       before it made */
    int coordinate; /* which of the instance's coordinates moves it */
    Expr scale;     /* distance or angle = scale * coordinate; 1 but for a screw's shift */
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
    COORDINATE_PARAMETER
} CoordinateKind;

typedef struct CoordinateRow {
    const char *member; /* "x", "theta", "s1"; "" when the coordinate has the instance's own name */
    CoordinateKind kind;
    bool rotation; /* of the rotation half */
} CoordinateRow;

/* --- efforts: forces between two frames or on a joint, and transducers --- */

typedef struct Motion1 { /* what an effort may depend on; entries that don't apply are 0 */
    Expr displacement;   /* distance between the two frames, or the joint's coordinate */
    Expr rate;
    Expr across;  /* transducer: voltage */
    Expr through; /* transducer: current, from plus to minus inside */
} Motion1;

/* --- scalar relations --- */

typedef enum RelationKind {
    RELATION_ACROSS,     /* v = value */
    RELATION_THROUGH,    /* i = value */
    RELATION_RESISTIVE,  /* v = value * i + offset */
    RELATION_CAPACITIVE, /* i = value * v' + offset */
    RELATION_INDUCTIVE   /* v = value * i' + series * i + offset */
} RelationKind;

typedef struct Relation {
    RelationKind kind;
    Expr value;
    Expr series;
    Expr offset; /* back-emf and its kin; 0 */
} Relation;

/* --- rows --- */

typedef struct Member { /* what can be asked of an instance: h9.fx, R1.power */
    const char *name;
    const char *unit;
    const char *meaning;
    int primes; /* derivatives in time that can be asked for */
} Member;

struct Component {
    const char *name;
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
    /* spatial, where values decide which they are (euler=); NULL: always `coords` */
    const CoordinateRow *(*coords_of)(const Instance *instance, int *count);
    const char *not_in_plane; /* refused in a planar scene: what serves there; NULL: it may */
    Branching translation; /* of its mechanical edge; of the scalar edge of those that have one */
    Branching rotation;    /* BRANCH_NEVER for forces, and the mechanical edge of transducers */
    int preference; /* completion: lower first; joints 10 and, in each tree, 1 a coordinate of that
                       half; bodies 50; virtual joints add 1000 */
    void (*steps)(const Instance *instance, Arena *arena, bool planar,
                  Steps *out); /* bodies, arms, joints */
    /* bodies: mass and inertia about the mass centre, body axes, as Ixx Iyy Izz Ixy Ixz Iyz tensor
     * entries (planar: Izz alone, the others 0); NULL where it has none */
    void (*inertia)(const Instance *instance, Arena *arena, bool planar, Expr *mass,
                    Expr tensor[6]);
    /* PLACES_ON: force and torque on the head, in ground axes or, with *in_body, in the head's */
    void (*wrench)(const Instance *instance, Arena *arena, bool planar, Expr force[3],
                   Expr torque[3], bool *in_body);
    /* PLACES_COORDINATE: the prescribed value, an expression of t and parameters */
    Expr (*prescribed)(const Instance *instance, Arena *arena);
    /* the force along the line (on the head, away from the tail) or the generalised force on the
     * joint's coordinate (on the head); NULL where it exerts none */
    Expr (*effort)(const Instance *instance, Arena *arena, const Motion1 *motion);
    Expr (*potential)(const Instance *instance, Arena *arena,
                      const Motion1 *motion); /* energy stored; NULL: none */
    Expr (*rotor)(const Instance *instance,
                  Arena *arena); /* inertia seen by the joint's coordinate (motor J); NULL: none */
    void (*relation)(const Instance *instance, Arena *arena, const Motion1 *motion,
                     Relation *out); /* scalar edges */
    const Member *members;           /* beyond those that its family has */
    int member_count;
    /* refuse values that no model could have (a negative mass is none of them unless numeric); may
     * be NULL */
    Status (*check)(const Instance *instance, Arena *arena, bool planar, Diag *diag);
    const char *help;
    const char *example; /* statements from an empty session that run */
    const char *see;
};

struct Instance {
    const Component *row;
    const char *name; /* borrowed from the model */
    int number;       /* in order of making */
    bool is_virtual;
    int tail; /* nodes; a scalar component's plus and minus; -1 where none */
    int head;
    int edge; /* mechanical edge, -1: none (springs on a joint have one along the joint's frames) */
    int scalar_edge; /* -1: none */
    int joint;       /* instance whose coordinate it acts on; -1 */
    int joint_coordinate;
    bool on_angle; /* that coordinate is an angle */
    Value *values; /* one a param of the row */
    int coord_count;
    const char *coord[MAX_COORDS]; /* names: "h8", "m1.x", or the user's coord= */
    CoordinateKind coord_kind[MAX_COORDS];
    bool coord_rotation[MAX_COORDS];
    int by; /* driver: instance (a source) or coordinate owner that supplies the motion; -1: its own
               effort */
    int by_coordinate; /* -1 when `by` is a source */
    const char *text;  /* its statement */
};

/* How many coordinates the instance has in this scene, and which, its values read. */
const CoordinateRow *instance_coords(const Instance *instance, bool planar, int *count);
const Component *component_find(const char *name);           /* exact; NULL */
const Component *component_at(int i);                        /* 0, 1, ...; NULL at the end */
int component_param(const Component *row, const char *name); /* -1: none */
const Value *instance_value(const Instance *instance,
                            const char *name);                    /* assert that the row has it */
Expr instance_scalar(const Instance *instance, const char *name); /* its only entry */
/* Members of an instance of this family and row, in order: NULL at the end. Those of its
 * coordinates (Instance.coord) are not repeated here, unless the family has them anyway. */
const Member *component_member(const Component *row, bool planar, int i);

/* step helpers for rows */
void steps_none(Arena *arena, Steps *out); /* no shift, no turn, R_0 = 1 */
void steps_shift(Arena *arena, Steps *out, const Expr axis[3], int coordinate);
void steps_turn(Arena *arena, Steps *out, const Expr axis[3], int coordinate);
/* how many motions the steps leave open: translation, rotation (a screw's one counts in both) */
void steps_freedom(const Steps *steps, int freedom[2]);
/* n1, n2 that make a right-handed triad u, n1, n2 with the unit vector u: x y for z, and so on in
 * circle; for others n1 is across the axis that u leans on least. */
void axis_complement(Arena *arena, const Expr u[3], Expr n1[3], Expr n2[3]);

#endif
