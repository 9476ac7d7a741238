/* identity.h: identity of each frame's motion, across all Systems of an arena
 *
 * The identity of an orientation class is a tuple of its parent's identity, its axis, its angle and
 * its speeds. The identity of a frame is a tuple of its parent's, its classes' and its shift. Where
 * two identities are the same pointer, all results of the motion are the same expressions. A part
 * of an instance that follows another one (isomorphic.h) has the identity of its counterpart in its
 * own, since a result that is renamed may differ from a derived one in the order of its terms. So
 * results that an earlier System derived for parts that an edit did not change are recalled and not
 * derived again. There is no list of what an edit affects, so none can be wrong. */
#ifndef COTREE_FORMULATE_KINEMATICS_IDENTITY_H
#define COTREE_FORMULATE_KINEMATICS_IDENTITY_H

#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"

/* kinds of results that follow from an identity or a key */
typedef enum Derived {
    DERIVED_TURN,      /* OrientationMotion of an orientation class */
    DERIVED_TURN_REST, /* Vec: alpha0 */
    DERIVED_AXIS,      /* Vec: of a speed, in the axes of an orientation class */
    DERIVED_STEP,      /* shift, v and velocity product of a frame */
    DERIVED_STEP_REST, /* Vec: a0 */
    DERIVED_ROW_SHOWN,
    DERIVED_ROW_VARIES, /* a position where the row changes was found */
    DERIVED_ROW_RUN,
    DERIVED_INERTIA,   /* force and torque of a mass at u' = 0 */
    DERIVED_COMPOSITE, /* Composite of all beyond */
    DERIVED_FORCE,     /* Vec: the sum at a node */
    DERIVED_PASSED,    /* the sum passed on, and its moment */
    DERIVED_TORQUE,    /* Vec: the sum at a node */
    DERIVED_TURNED,    /* the sum passed on */
    DERIVED_NETWORK_ROW,
    DERIVED_NETWORK_SLOPES
} Derived;

/* Of all orientation classes and frames; after these are built, and after isomorphic_build(). Where
 * parts are flexible, all are NULL. */
void identities_build(System *system);

/* Combines an identity and other data that a result follows from. */
enum { MOST_KEY = 48 };
typedef struct Key {
    Expr at[MOST_KEY];
    int count;
    bool is_determined; /* every identity in it is known, and all fitted in */
} Key;
Key key_of(Expr identity);
void key_add(Key *key, const void *entries, size_t size); /* an array or a struct of expressions */
/* the turn of an orientation class relative to the class before it */
void key_add_turn(Key *key, const OrientationClass *chain);
Expr key_end(const System *system, const Key *key);          /* NULL: unknown identity */
Expr key_of_inertia(const System *system, const Mass *mass); /* of DERIVED_INERTIA */
/* Key of the loads at a frame and beyond it relative to its parent: equal where the frame has the
 * same position and turn against the parent, wherever the parent is. After its motion. */
Expr key_passed(const System *system, int node, Expr beyond);
/* what is passed on to a frame: the whole composite, or a part of the loads */
typedef enum Passed { PASSED_WHOLE, PASSED_FORCE, PASSED_MOMENT, PASSED_TORQUE } Passed;
/* Combines what is at a frame (NULL: nothing so far) and what is passed on to it (NULL:
 * nothing). */
Expr key_join(const System *system, Expr identity, Expr own, Passed how, Expr passed);

/* expr_recall() and expr_remember(); for NULL nothing is recalled or stored. */
bool derived_is_kept(const System *system, Expr key, Derived which);
bool derived_recall(const System *system, Expr key, Derived which, void *out, size_t size);
void derived_store(const System *system, Expr key, Derived which, const void *values, size_t size);

#endif
