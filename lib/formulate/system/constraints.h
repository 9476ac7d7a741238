/* constraints.h: constraint rows from the circuits of chords, and angles of chords */
#ifndef COTREE_FORMULATE_SYSTEM_CONSTRAINTS_H
#define COTREE_FORMULATE_SYSTEM_CONSTRAINTS_H

#include "base/memory.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"

/* direction of a constraint row */
typedef enum RowKind {
    ROW_DATUM,   /* n.d, n an axis of the datum */
    ROW_TAIL,    /* n.d, n fixed in the tail */
    ROW_DOT,     /* a_t . b_h */
    ROW_ANGLE,   /* sum of turns about one axis */
    ROW_TIE,     /* u.d - pitch times angle: a screw */
    ROW_DRIVER,  /* coordinate - f(t) */
    ROW_COUPLER, /* coordinate - f(coordinates), or the same of rates */
    ROW_CONTACT  /* n . (velocity of the head's point against the tail's) */
} RowKind;

/* A coordinate that a coupler follows, or whose rate it follows, and its factor. */
typedef struct Coupled {
    int owner, coordinate;
    Expr slope;
} Coupled;

typedef struct Row {
    RowKind kind;
    int tail, head; /* nodes */
    /* DATUM: ground axes; TAIL, DOT (a), ANGLE (axis), CONTACT: zero axes of the tail's orientation
     * class */
    Vec n;
    Vec point; /* CONTACT: from the head's origin to where the force acts, in the same axes */
    Vec b;     /* DOT: zero axes of the head's orientation class */
    Expr key;  /* DATUM, TAIL, DOT: identity of what it follows from (identity.h); or NULL */
    Expr phi;  /* for display; 0 of a velocity row */
    /* V u - n, which is 0, over the definitions of the recursive form: of a velocity row, or, where
     * it is simpler than the derivative of phi, of a position; NULL */
    Expr rate;
    int owner; /* DRIVER, COUPLER: instance of the coordinate, and which */
    int coordinate;
    Expr pitch; /* TIE: shift per angle */
    Expr prescribed;
    Coupled *coupled; /* COUPLER: its entries, in the system's pool */
    int coupled_count;
    ConstraintRow reported;
} Row;

typedef struct MultiTurnChord {
    MultiTurn reported;
    int instance;
    int coordinate;
    Expr sine; /* both have a common factor, which is 1 where the joint holds */
    Expr cosine;
} MultiTurnChord;

typedef struct CountedChord { /* a chord whose angle is a sum */
    WholeTurns reported;
    int instance, coordinate;
} CountedChord;

typedef struct Constraints {
    LIST(Row) rows;    /* those of positions, then those of velocities alone */
    Expr *multipliers; /* symbols, one for each row */
    /* rows that hold in every position: no lambda gives the load that they carry */
    LIST(Row) redundant_rows;
    LIST(const char *) dropped;
    LIST(MultiTurnChord) multi_turns;
    LIST(CountedChord) counted;
    LIST(AngleOff) angles_off;
    LIST(Drive) drives;
} Constraints;

#endif
