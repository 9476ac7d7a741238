/* kinematic_tree.h: bodies, arms and joints in numbers: where frames stand, and what joints ask of
 * it
 *
 * A Link is a mechanical edge. Its coordinates c place the head against the tail: shifts in the
 * axes of the tail, then turns or Euler parameters, then a constant rotation R_0. It is read the
 * other way round, too, which knows no trees: a branch and a chord have the same coordinates where
 * the frames stand alike. Directions count with their sense here, unlike in Phi, which an axis
 * satisfies that is turned round. R_ab takes components in frame b to those in frame a. */
#ifndef COTREE_SIMULATE_ASSEMBLE_KINEMATIC_TREE_H
#define COTREE_SIMULATE_ASSEMBLE_KINEMATIC_TREE_H

#include "base/text.h"
#include "formulate/kinematics/edges.h"
#include "simulate/equations/compiled_equations.h"

/* Of a link, which places a frame against another: three shifts and four Euler parameters. What
 * deforms has more, and is no link. */
enum { POSE_COORDS = 7 };

typedef struct Pose { /* of a frame against another */
    double R[9];      /* row by row */
    double p[3];      /* m, axes of the other */
} Pose;

typedef struct LinkStep {
    double axis[3]; /* unit vector */
    double scale;   /* of its coordinate; 1 but for a screw's shift */
    int coordinate;
} LinkStep;

typedef struct Link {
    const Instance *instance;
    int edge, tail, head; /* nodes */
    bool holds;           /* a joint that isn't virtual: its frames can move in no other way */
    int shift_count, turn_count;
    LinkStep shift[3], turn[3];
    bool has_parameters; /* Euler parameters, in coordinates first_parameter..+3, in place of turns
                          */
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
    bool *is_moved; /* nodes that a block moves: what turns them is no link's coordinate */
    int *link_at;   /* number of the link of an edge that has one */
    Link frame; /* a frame against the datum: x y z, Euler parameters; in a plane x y, an angle */
} KinematicTree;

/* New; NULL where there is nothing mechanical. */
KinematicTree *kinematic_tree_new(const VariableIndex *layout, Parameters *parameters);
void kinematic_tree_free(KinematicTree *kinematic_tree); /* NULL is fine */

/* Poses of all nodes against the datum along two trees, from coordinates (links x POSE_COORDS). */
void kinematic_tree_poses(const KinematicTree *kinematic_tree, const Tree *rotation,
                          const Tree *translation, const double *c, Pose *poses);
/* The same at coordinates q of the system, along its trees; new. */
Pose *kinematic_tree_poses_at(const KinematicTree *kinematic_tree, const double *q);
void pose_between(const Pose *tail, const Pose *head, Pose *out);

void link_pose(const Link *link, const double *c, Pose *out);
/* Coordinates of a pose: angles are those nearest to what `c` holds before, Euler parameters of the
 * two signs those nearer to it. */
void link_read(const Link *link, const Pose *relative, double *c);
/* World axis of turn k, the tail's rotation given */
void link_turn_axis(const Link *link, const double *c, const double *R_tail, int k, double *out);
/* Move a rotation of Euler parameters or of three turns by a small turn `d` in the axes that it
 * leads to. */
void link_turn_by(const Link *link, double *c, const double d[3]);
void link_attitude(const Link *link, const double *c, double E[9]); /* its turns, without R_0 */

/* What a joint asks of a pose: a residual, 0 where it holds, and its derivatives by a turn and a
 * shift of the head, both in the axes of the tail. */
typedef struct LinkRow {
    double value;
    double by_turn[3], by_shift[3];
} LinkRow;
enum { LINK_ROWS = 4 }; /* at most, of one of the following */
int link_shift_rows(const Link *link, const Pose *relative, LinkRow *rows);
int link_turn_rows(const Link *link, const Pose *relative, LinkRow *rows);
void link_tie_row(const Link *link, const Pose *relative, LinkRow *row); /* of a screw */
/* of coordinate k being `value`; `near` (POSE_COORDS) chooses among turns and signs */
void link_value_row(const Link *link, const Pose *relative, const double *near, int k, double value,
                    LinkRow *row);

/* a joint whose directions lie the wrong way round, by more than a third of half a turn */
typedef struct Reversal {
    const Link *link; /* NULL: all agree */
    bool is_twisted;  /* a screw whose turn is not that of its shift */
    double
        about[3]; /* by that its head is turned further than the joint lets it; axes of the tail */
} Reversal;
/* The first one at coordinates q of the system, along its trees; none for no skeleton. */
Reversal kinematic_tree_reversal(const KinematicTree *kinematic_tree, const double *q);
/* "its axis reversed: z of t4 and z of h4 point opposite ways" */
void reversal_report(const KinematicTree *kinematic_tree, const Reversal *reversal, Text *out);
/* A coordinate of an instance there, of its turns those nearest to `near`. */
double kinematic_tree_value(const KinematicTree *kinematic_tree, const double *q,
                            const Instance *instance, int k, const double near[POSE_COORDS]);

#endif
