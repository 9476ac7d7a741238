/* constraints.h: what the circuits of chords ask for: constraint rows, angles of chords */
#ifndef COTREE_FORMULATE_SYSTEM_CONSTRAINTS_H
#define COTREE_FORMULATE_SYSTEM_CONSTRAINTS_H

#include "base/memory.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"

/* direction of a constraint row */
typedef enum RowKind {
    ROW_DATUM,  /* n.d, n an axis of the datum */
    ROW_TAIL,   /* n.d, n fixed in the tail */
    ROW_DOT,    /* a_t . b_h */
    ROW_ANGLE,  /* sum of turns about one axis */
    ROW_TIE,    /* u.d - pitch times angle: a screw */
    ROW_DRIVER, /* coordinate - f(t) */
    ROW_COUPLER /* coordinate - f(coordinates) */
} RowKind;

/* A coordinate that a coupler follows, and by how much. */
typedef struct Coupled {
    int owner, coordinate;
    Expr slope;
} Coupled;

typedef struct Row {
    RowKind kind;
    int tail, head; /* nodes */
    Vec n;     /* DATUM: ground axes; TAIL, DOT (a), ANGLE (axis): zero axes of the tail's chain */
    Vec b;     /* DOT: zero axes of the head's chain */
    Expr key;  /* DATUM, TAIL, DOT: what it follows from, as identity.h tells it; or NULL */
    Expr phi;  /* to show */
    int owner; /* DRIVER, COUPLER: instance of the coordinate, and which */
    int coordinate;
    Expr pitch; /* TIE: shift per angle */
    Expr prescribed;
    Coupled *coupled; /* COUPLER: so many of the system's pool */
    int coupled_count;
    ConstraintRow reported;
} Row;

typedef struct MultiTurnChord {
    MultiTurn reported;
    int instance;
    int coordinate;
    Expr sine; /* both times one factor, 1 where the joint holds */
    Expr cosine;
} MultiTurnChord;

typedef struct CountedChord { /* whose angle is a sum */
    WholeTurns reported;
    int instance, coordinate;
} CountedChord;

typedef struct Constraints {
    LIST(Row) rows;
    Expr *multipliers; /* symbols, one a row */
    /* rows that hold in every position: no lambda tells what they carry */
    LIST(Row) redundant_rows;
    LIST(const char *) dropped;
    LIST(MultiTurnChord) multi_turns;
    LIST(CountedChord) counted;
    LIST(AngleOff) angles_off;
    LIST(Drive) drives;
} Constraints;

#endif
