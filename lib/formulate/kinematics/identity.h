/* identity.h: what tells one frame's motion from another's, in all Systems of an arena
 *
 * The identity of a chain is a tuple of its parent's, its axis, its angle and its speeds; that of a
 * frame is one of its parent's, its chains' and its shift. Where two are the same pointer, all that
 * follows from motion is the same expressions: what an earlier System derived of the parts that an
 * edit left alone is recalled, and not derived again. There is no list of what an edit touches, so
 * none can be wrong. */
#ifndef COTREE_FORMULATE_KINEMATICS_IDENTITY_H
#define COTREE_FORMULATE_KINEMATICS_IDENTITY_H

#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"

/* what follows from an identity, or from a key */
typedef enum Derived {
    DERIVED_TURN,      /* OrientationMotion of a chain's identity */
    DERIVED_TURN_REST, /* Vec: alpha0 */
    DERIVED_AXIS,      /* Vec: of a speed, in the axes of a chain */
    DERIVED_STEP,      /* step, v and product of a frame's */
    DERIVED_STEP_REST, /* Vec: a0 */
    DERIVED_ROW_SHOWN,
    DERIVED_ROW_VARIES, /* a position that moves the row was found */
    DERIVED_ROW_RUN,
    DERIVED_INERTIA,   /* force and torque of a mass at u' = 0 */
    DERIVED_COMPOSITE, /* Composite of what hangs beyond */
    DERIVED_SPEED,     /* force and torque per unit of u' */
    DERIVED_FORCE,     /* Vec: the sum at a node */
    DERIVED_PASSED,    /* that passed on, and its moment */
    DERIVED_TORQUE,    /* Vec: the sum at a node */
    DERIVED_TURNED,    /* Vec: that passed on */
    DERIVED_NETWORK_ROW,
    DERIVED_NETWORK_SLOPES
} Derived;

/* Of all chains and frames; behind these. Where parts deform, none are told (NULL). */
void identities_build(System *system);

/* An identity and what else something follows from, as one. */
enum { MOST_KEY = 48 };
typedef struct Key {
    Expr at[MOST_KEY];
    int count;
    bool is_determined; /* no identity in it is missing, and all fitted in */
} Key;
Key key_of(Expr identity);
void key_add(Key *key, const void *entries, size_t size); /* an array or a struct of expressions */
Expr key_end(const System *system, const Key *key);       /* NULL: it isn't told */
Expr key_of_inertia(const System *system, const Mass *mass); /* of DERIVED_INERTIA */
/* What is there and beyond it, as the parent of the frame sees it: it stands and turns alike
 * against the parent, wherever that is. Behind its motion. */
Expr key_passed(const System *system, int node, Expr beyond);
/* what is passed on to a frame: what hangs there as a whole, or of that */
typedef enum Passed { PASSED_WHOLE, PASSED_FORCE, PASSED_MOMENT, PASSED_TORQUE } Passed;
/* Of what is at a frame (NULL: nothing so far), and of what is passed on to it (NULL: nothing). */
Expr key_join(const System *system, Expr identity, Expr own, Passed how, Expr passed);

/* expr_recall() and expr_remember(); of NULL nothing is. */
bool derived_is_kept(const System *system, Expr key, Derived which);
bool derived_recall(const System *system, Expr key, Derived which, void *out, size_t size);
void derived_store(const System *system, Expr key, Derived which, const void *values, size_t size);

#endif
