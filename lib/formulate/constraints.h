/* constraints.h: what the circuits of chords ask for: constraint rows, angles of chords */
#ifndef COTREE_FORMULATE_CONSTRAINTS_H
#define COTREE_FORMULATE_CONSTRAINTS_H

#include "base/memory.h"
#include "formulate/system.h"
#include "formulate/vector.h"

/* direction of a constraint row */
typedef enum RowKind {
    ROW_DATUM, /* n.d, n an axis of the datum */
    ROW_TAIL,  /* n.d, n fixed in the tail */
    ROW_DOT,   /* a_t . b_h */
    ROW_ANGLE, /* sum of turns about one axis */
    ROW_TIE,   /* u.d - pitch times angle: a screw */
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
    Expr pitch; /* TIE: shift per angle */
    Expr prescribed;
    ConstraintRow told;
} Row;

typedef struct MultiTurnChord {
    MultiTurn told;
    int instance;
    int coordinate;
    Expr sine; /* both times one factor, 1 where the joint holds */
    Expr cosine;
} MultiTurnChord;

typedef struct CountedChord { /* whose angle is a sum */
    WholeTurns told;
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

void constraints_free(Constraints *constraints); /* NULL is fine */
MUST_USE Status constraints_build(System *system, Diag *diag);

/* --- turns of chords (multi_turn.c, multi_turn_build.c) --- */

/* (multi_turn.c) which turns of chords are told by sine and cosine alone */
void multi_turn_build(System *system);
/* the angle of such a turn; NULL: it is none of them */
Expr multi_turn_angle(const System *system, int instance, int coordinate);
/* the whole turns that the angle of a chord has beside the sum that tells it; 0: it has none */
Expr multi_turn_whole(const System *system, int instance, int coordinate);
/* to rows of angles that sum up to 0, in the recursive form */
void multi_turn_add_rows(System *system);
/* a driver makes it so */
void multi_turn_drive(System *system, int instance, int coordinate, Expr prescribed);

#endif
