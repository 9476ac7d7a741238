/* composite_mass.h: mass matrix M of a long mechanism by recursion, without expanded entries
 *
 * Here every speed moves all that is beyond it as one rigid body (Walker and Orin 1982). Column k
 * of M is the force and moment that this body exerts on its branch. Both are passed on from place
 * to place towards the datum, and are projected on the speeds met on the way (theory 4). Expanded,
 * this gives one formula for each pair of speeds, though a place transforms all that it passes on
 * in the same way. So only the formulas of each place, of the body that moves with it alone, and of
 * each speed are stored here. The program that runs the system adds bodies up and passes loads on
 * numerically. An edit leaves the formulas of all other places as they were. */
#ifndef COTREE_FORMULATE_DYNAMICS_COMPOSITE_MASS_H
#define COTREE_FORMULATE_DYNAMICS_COMPOSITE_MASS_H

#include "formulate/system/system.h"

enum { AXIS_ANY = 3 };

/* a node that speeds move, through which loads are passed */
typedef struct MassPlace {
    int parent;       /* the next place inward; -1: no speed is met further inward */
    bool is_turned;   /* the parent has other axes */
    int axis;         /* of that turn: one of the axes, 0 to 2, or AXIS_ANY */
    bool has_step;    /* before that turn: a force has a moment about the place that it turns at */
    bool has_way;     /* after that turn: a force has a moment about the parent */
    int first, count; /* its speeds, in `speed_at` */
    /* indices of these among the needs */
    int step, way; /* m, towards this node: in its axes, and in those of the parent */
    int rotation;  /* to the axes of the parent: cosine and sine, or row by row */
} MassPlace;

/* indices of its vectors among the needs; axes of the place */
typedef struct MassSpeed {
    int place;
    bool turns, slides;
    int turn, slide; /* motion per unit */
} MassSpeed;

typedef struct CompositeMass {
    bool planar; /* all axes are those of the datum, forces lie in its x and y */
    int place_count, speed_count;
    MassPlace *places;
    MassSpeed *speeds;
    int *speed_at; /* speeds, place by place, in order at each */
    /* Expressions of the vectors of places and speeds. From `first_body` on, of what moves with
     * each place as one rigid body, place by place: mass (kg), first moment (kg m) and inertia (kg
     * m^2, row by row; in a plane the last entry alone) about the place, in its axes. */
    LIST(Expr) needs;
    int first_body;
} CompositeMass;

enum { BODY_NEEDS = 13 };

/* NULL where M is small or the recursion does not apply: then M is evaluated as an expression.
 * Borrowed. */
const CompositeMass *system_composite_mass(const System *system);
/* what rotors add to an entry of M besides; NULL at the end */
const Entry *system_mass_share(const System *system, int i);

/* M expanded from these, for a composite mass: entries of one half, including shares (several may
 * have one position), and the pairs of speeds that may have an entry. */
typedef LIST(Entry) MassEntries;
int64_t composite_mass_pairs(const CompositeMass *mass);
void composite_mass_entries(const System *system, MassEntries *out);

/* true: it was built, and M is not needed */
bool composite_mass_build(System *system);
void composite_mass_free(CompositeMass *mass); /* NULL is fine */
/* of one evaluation, without its needs */
OpCount composite_mass_passing(const CompositeMass *mass);

#endif
