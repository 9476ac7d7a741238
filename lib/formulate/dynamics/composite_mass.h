/* composite_mass.h: M of a long mechanism by recursion, nothing of it written out
 *
 * Where every speed moves what hangs beyond it as one rigid body, column k of M is what its branch
 * feels of that body, a force and a moment, passed on from place to place towards the datum and
 * projected on the speeds met on the way (theory 4). Written out that is a formula for each pair of
 * speeds, though a place does the same to all that it passes on: so here stand the formulas of each
 * place and each speed, and whoever runs the system does the passing in numbers. */
#ifndef COTREE_FORMULATE_DYNAMICS_COMPOSITE_MASS_H
#define COTREE_FORMULATE_DYNAMICS_COMPOSITE_MASS_H

#include "formulate/system/system.h"

enum { AXIS_ANY = 3 };

/* a node that speeds move, through which something is passed */
typedef struct MassPlace {
    int parent;       /* place, before this one; -1: no speed is met further on */
    bool is_turned;   /* the parent's axes are others */
    int axis;         /* about which: one of the axes, of 0 to 2, or AXIS_ANY */
    bool has_step;    /* before that turn a force has a moment about the place that it turns at, */
    bool has_way;     /* and after it about the parent */
    int first, count; /* its speeds, in `speed_at` */
    /* where these stand among the needs */
    int step, way; /* m, towards this node: in its axes, and in those of the parent */
    int rotation;  /* to the axes of the parent: cosine and sine, or row by row */
} MassPlace;

/* where its vectors stand among the needs, in the axes of the place */
typedef struct MassSpeed {
    int place;
    bool turns, slides;
    int turn, slide;   /* motion per unit */
    int force, torque; /* that what hangs beyond takes per unit of u' */
} MassSpeed;

typedef struct CompositeMass {
    bool planar; /* all axes are those of the datum, forces lie in its x and y */
    int place_count, speed_count;
    MassPlace *places;
    MassSpeed *speeds;
    int *speed_at;    /* speeds, place by place, in order at each */
    LIST(Expr) needs; /* numbers of these are passed on */
    /* What moves with each place as one body, place by place: mass, first moment and inertia (row
     * by row) about the place, in its axes. With them and the vectors of places and speeds M u' = F
     * is solved without M. */
    LIST(Expr) bodies;
} CompositeMass;

enum { BODY_NEEDS = 13 };

/* NULL where M is short or doesn't follow so: it is run as it is written. Borrowed. */
const CompositeMass *system_composite_mass(const System *system);
/* what parts add to an entry of M beside that: rotors. NULL at the end */
const Entry *system_mass_share(const System *system, int i);

/* M written out from these: entries of one half, shares among them, of which several may stand at
 * one place; and pairs of speeds that may have one. Where that is so, of a composite mass. */
typedef LIST(Entry) MassEntries;
int64_t composite_mass_pairs(const CompositeMass *mass);
void composite_mass_entries(const System *system, MassEntries *out);

/* true: it has been made, and M needn't be */
bool composite_mass_build(System *system);
void composite_mass_free(CompositeMass *mass);             /* NULL is fine */
OpCount composite_mass_passing(const CompositeMass *mass); /* of one evaluation, beside its needs */

#endif
