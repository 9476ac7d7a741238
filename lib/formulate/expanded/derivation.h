/* derivation.h: how an equation was derived: the terms of its entries, and the circuits and cutsets
 * that were projected
 *
 * A view describes the definitions that the equations were formed from. Lists are new, and the
 * caller frees them with LIST_FREE(); what they point to belongs to the view. theory 3-4, 8. */
#ifndef COTREE_FORMULATE_EXPANDED_DERIVATION_H
#define COTREE_FORMULATE_EXPANDED_DERIVATION_H

#include "formulate/system/system.h"

typedef enum TermKind {
    TERM_SHIFT,   /* of a constraint: a branch on the path, along the row's direction */
    TERM_TURN,    /* of a constraint: a turn on the path */
    TERM_WHOLE,   /* of a constraint that is no sum over branches */
    TERM_ASKED,   /* minus the value that a driver prescribes */
    TERM_MASS,    /* m v_j.v_k; of F: -m v_j.a at u' = 0 */
    TERM_INERTIA, /* w_j.I.w_k; of F: the velocity products of rotation */
    TERM_WEIGHT,  /* m g.v_j */
    TERM_FORCE,   /* F.v_j */
    TERM_TORQUE,  /* T.w_j */
    TERM_EFFORT,  /* on a coordinate or a line: effort times how much speed j moves it */
    TERM_ROTOR,   /* inertia on a coordinate */
    TERM_SHAPES,  /* of a flexible part: its local block on the root and the shapes */
    TERM_DRIVE    /* computed by an inverse run */
} TermKind;

typedef struct Term {
    TermKind kind;
    int edge; /* of SHIFT and TURN, with its sign on the path from tail to head; otherwise -1 */
    int sign;
    int instance; /* of all other kinds */
    Expr value;
    bool is_long; /* the value is not multiplied out, nor are like terms collected in it */
} Term;
typedef LIST(Term) Terms;

/* The terms of the sum that an entry is. None where definitions replace the sum because it would be
 * too long, or where the block's entries are no such sums. Fails as system_show() does. */
MUST_USE Status system_terms(System *view, Block block, int row, int column, Terms *out,
                             Diag *diag);

/* components of a vector in the axes of a node's frame */
typedef struct NarrativeVector {
    int node;
    Expr at[3];
} NarrativeVector;

/* a branch on the path of a circuit of the translation tree */
typedef struct WayStep {
    int edge;
    int sign; /* +1 where the path from the chord's tail to its head has its direction */
    NarrativeVector shift; /* from the edge's tail to its head, in the axes of its tail */
} WayStep;
typedef LIST(WayStep) Way;
void system_way(const System *view, int chord, Way *out);

/* The turns from the datum to a node, neighbours about one axis merged: angles; NULL for a free
 * rotation by Euler parameters. */
typedef LIST(Expr) Angles;
void system_angles(const System *view, int node, Angles *out);

/* the direction on which a constraint row projects its circuit */
typedef enum ConstraintDirection {
    ALONG_AXIS,    /* `a`, fixed in its node */
    ALONG_SQUARE,  /* none: `a` and `b`, each fixed in its node, remain orthogonal */
    ALONG_TURN,    /* `a` is the axis of the turns */
    ALONG_TIE,     /* `a`: the shift minus its value by the turn */
    ALONG_DRIVEN,  /* none: a prescribed coordinate */
    ALONG_COUPLED, /* none: a coordinate that follows others */
    ALONG_SPIN,    /* `a`, about which the head doesn't turn against the tail */
    ALONG_CONTACT  /* `a`, along which a point of the head has no velocity against the tail */
} ConstraintDirection;
typedef struct Projection {
    ConstraintDirection along;
    NarrativeVector a, b;
} Projection;
Projection system_projection(const System *view, int row);

/* Motion of a part with mass per unit of a speed: v of its mass centre, a sum over frames, and w,
 * which is 0 where the speed does not turn it. */
typedef struct UnitMotion {
    int instance;
    LIST(NarrativeVector) v;
    NarrativeVector w;
} UnitMotion;
typedef LIST(UnitMotion) UnitMotions;
void system_unit_motions(const System *view, int speed, UnitMotions *out);
void unit_motions_free(UnitMotions *motions);
/* the branches that a speed belongs to in the translation and the rotation tree; -1 */
void system_speed_edges(const System *view, int speed, int edges[2]);

#endif
