/* coordinate.h: values of coordinates, also of chords */
#ifndef COTREE_FORMULATE_KINEMATICS_COORDINATE_H
#define COTREE_FORMULATE_KINEMATICS_COORDINATE_H

#include "formulate/system/system.h"
#include "formulate/system/vector.h"

/* the constant rotation that remains between the ends of a chord when its turns are 0: Z_h R_0^T
 * Z_t^T */
Rotation chord_constant(const System *system, const Instance *joint, const Steps *steps);
/* a turn of a chord: the sum of turns about its axis where these merge, otherwise its sine and
 * cosine */
typedef struct ChordTurn {
    Expr angle; /* NULL: sine and cosine instead */
    Expr sine;
    Expr cosine;
} ChordTurn;
/* number `which` of one or two turns */
void chord_turn(const System *system, const Instance *owner, const Steps *steps, int which,
                ChordTurn *out);
/* the component along a slide's axis of the vector from tail to head */
Expr slide_value(const System *system, const Instance *owner, const Step *slide);
/* (euler_parameters.c) Euler parameters of a frame against ground, and of a head against a tail,
 * scalar part first */
void frame_parameters(const System *system, int node, Expr p[4]);
void relative_parameters(const System *system, int tail, int head, Expr p[4]);
/* current axis of a joint's turn: zero-position components of *chain */
Vec joint_axis(const System *system, const Instance *owner, const Steps *steps, int which,
               int *chain);
/* a screw: shift and turn by one coordinate */
bool steps_are_tied(const Steps *steps);
/* value of a coordinate and its first and second derivatives, branch or chord */
MUST_USE Status coordinate_value(System *system, const Instance *owner, int coordinate, int primes,
                                 Expr *out, Diag *diag);
/* The same for output: also three angles of a chord, each within half a turn of 0. They jump at
 * half a turn and at critical angles, so nothing may be attached to them. */
MUST_USE Status coordinate_shown(System *system, const Instance *owner, int coordinate, int primes,
                                 Expr *out, Diag *diag);
/* derivative of e(q) per unit of a speed */
Expr speed_partial(const System *system, Expr e, int speed);

#endif
