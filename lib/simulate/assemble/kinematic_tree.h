/* kinematic_tree.h: bodies, arms and joints as numbers: poses of frames, and the conditions of
 * joints
 *
 * A Link is a mechanical edge. Its coordinates c place the head relative to the tail: shifts in the
 * axes of the tail, then turns or Euler parameters, then a constant rotation R_0. Coordinates are
 * also computed from poses, without any tree: a branch and a chord have the same coordinates at the
 * same poses. Here the sense of a direction counts, unlike in Phi, which is also satisfied by a
 * reversed axis. R_ab transforms components in frame b to those in frame a. */
#ifndef COTREE_SIMULATE_ASSEMBLE_KINEMATIC_TREE_H
#define COTREE_SIMULATE_ASSEMBLE_KINEMATIC_TREE_H

#include "base/text.h"
#include "formulate/kinematics/edges.h"
#include "simulate/equations/compiled_equations.h"

/* Of a link, which places a frame relative to another: three shifts and four Euler parameters. A
 * flexible body has more, and is no link. */
enum { POSE_COORDS = 7 };

typedef struct Pose { /* of a frame relative to another */
    double R[9];      /* row by row */
    double p[3];      /* m, axes of the other */
} Pose;

typedef struct LinkStep {
    double axis[3]; /* unit vector */
    double scale;   /* per unit of its coordinate; 1 except for a screw's shift */
    int coordinate;
} LinkStep;

typedef struct Link {
    const Instance *instance;
    int edge, tail, head; /* nodes */
    bool holds;           /* a joint that isn't virtual: its frames can't move otherwise */
    int shift_count, turn_count;
    LinkStep shift[3], turn[3];
    bool has_parameters; /* Euler parameters, coordinates first_parameter..+3, in place of turns */
    int first_parameter;
    bool is_tied; /* a screw */
    double constant[3];
    double R0[9];
} Link;

typedef struct KinematicTree {
    const System *system;
    int node_count, datum;
    int link_count;
    Link *links;
    bool *is_moved; /* nodes that a block moves: no link's coordinate turns them */
    int *link_at;   /* number of each edge's link, if it has one */
    Link frame;     /* relative to the datum: x y z, Euler parameters; in a plane x y, an angle */
} KinematicTree;

/* New; NULL where there is no mechanics. */
KinematicTree *kinematic_tree_new(const VariableIndex *layout, Parameters *parameters);
void kinematic_tree_free(KinematicTree *kinematic_tree); /* NULL is fine */

/* Poses of all nodes relative to the datum along two trees, from coordinates (links x
 * POSE_COORDS). */
void kinematic_tree_poses(const KinematicTree *kinematic_tree, const Tree *rotation,
                          const Tree *translation, const double *c, Pose *poses);
/* The same at coordinates q of the system, along its trees; new. */
Pose *kinematic_tree_poses_at(const KinematicTree *kinematic_tree, const double *q);
void pose_between(const Pose *tail, const Pose *head, Pose *out);

void link_pose(const Link *link, const double *c, Pose *out);
/* Coordinates of a pose: angles nearest to the previous values in `c`; of the two signs of Euler
 * parameters, the one nearer to these. */
void link_read(const Link *link, const Pose *relative, double *c);
/* axis of turn k in axes of the datum, for this rotation of the tail */
void link_turn_axis(const Link *link, const double *c, const double *R_tail, int k, double *out);
/* Change a rotation by Euler parameters or three turns by a small turn `d` in the axes of the
 * head. */
void link_turn_by(const Link *link, double *c, const double d[3]);
void link_attitude(const Link *link, const double *c, double E[9]); /* its turns, without R_0 */

/* A condition of a joint on a pose: the residual, 0 where it holds, and its derivatives by a turn
 * and a shift of the head, both in the axes of the tail. */
typedef struct LinkRow {
    double value;
    double by_turn[3], by_shift[3];
} LinkRow;
enum { LINK_ROWS = 4 }; /* at most, from one of the following */
int link_shift_rows(const Link *link, const Pose *relative, LinkRow *rows);
int link_turn_rows(const Link *link, const Pose *relative, LinkRow *rows);
void link_tie_row(const Link *link, const Pose *relative, LinkRow *row); /* condition of a screw */
/* condition that coordinate k is `value`; `near` (POSE_COORDS) determines whole turns and signs */
void link_value_row(const Link *link, const Pose *relative, const double *near, int k, double value,
                    LinkRow *row);

/* a joint with reversed directions, by more than a third of half a turn */
typedef struct Reversal {
    const Link *link; /* NULL: no joint is reversed */
    bool is_twisted;  /* a screw whose turn is not that of its shift */
    double
        about[3]; /* rotation of its head by more than what the joint allows; in axes of the tail */
} Reversal;
/* The first one at coordinates q of the system, along its trees; none without mechanics. */
Reversal kinematic_tree_reversal(const KinematicTree *kinematic_tree, const double *q);
/* "its axis reversed: z of t4 and z of h4 point opposite ways" */
void reversal_report(const KinematicTree *kinematic_tree, const Reversal *reversal, Text *out);
/* A coordinate of an instance at q; of angles the value nearest to `near`. */
double kinematic_tree_value(const KinematicTree *kinematic_tree, const double *q,
                            const Instance *instance, int k, const double near[POSE_COORDS]);

#endif
