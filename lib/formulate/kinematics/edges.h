/* edges.h: the mechanical edges of a system, for code that computes its frames numerically
 *
 * Everything is borrowed from the System. */
#ifndef COTREE_FORMULATE_KINEMATICS_EDGES_H
#define COTREE_FORMULATE_KINEMATICS_EDGES_H

#include "component/component.h"
#include "formulate/system/system.h"
#include "graph/tree.h"

const Graph *system_graph(const System *system);
const Tree *system_tree(const System *system, TreeKind kind); /* NULL: there is none */
bool system_is_planar(const System *system);
int system_instance_count(const System *system);
const Instance *system_instance(const System *system, int i);
/* Joint primitives of an instance whose type has any, over parameters. */
void system_steps(const System *system, const Instance *instance, Steps *out);
/* The index in q of a coordinate of an instance; -1: it is the coordinate of a chord. */
int system_coordinate(const System *system, const Instance *instance, int coordinate);

/* What a name refers to in the position of frames. */
typedef enum EdgeStanding {
    REFERENT_NONE,       /* something else */
    REFERENT_COORDINATE, /* a coordinate of an instance */
    REFERENT_SHIFT,      /* the shift of a screw: its scale times its coordinate */
    REFERENT_POSITION,   /* x, y or z of a frame */
    REFERENT_ANGLE,      /* theta of a frame in a plane */
    REFERENT_PARAMETER   /* q0 to q3 of a frame */
} EdgeStanding;

typedef struct VariableReferent {
    EdgeStanding kind;
    const Instance *instance; /* COORDINATE, SHIFT */
    int which;                /* coordinate; 0, 1, 2 of a position; 0 to 3 of the parameters */
    int node;                 /* POSITION, ANGLE, PARAMETER */
} VariableReferent;
VariableReferent system_referent(const System *system, const char *name);

/* The prescribed value of the coordinate in a constraint row, in t and parameters; NULL: the row
 * belongs to no driver. */
Expr system_driven(const System *system, int row, const Instance **owner, int *coordinate);

#endif
