/* section_frames.h: frames on flexible parts, and the speeds that move them (theory 9)
 *
 * A section frame is an arm with at=. Its branch turns and shifts it along axes of the part's root.
 * The rates follow from those of the shapes, by *dependent speeds*, which come after the system's
 * own speeds. */
#ifndef COTREE_FORMULATE_KINEMATICS_SECTION_FRAMES_H
#define COTREE_FORMULATE_KINEMATICS_SECTION_FRAMES_H

#include "formulate/system/kinematics.h"

/* how a dependent speed follows from speeds `first` and on: sum of factor u, and the rest of its
 * rate at u' = 0 */
typedef struct Dependent {
    int first, count;
    Expr *factor;
    Expr rate, rest;
} Dependent;

/* Allots dependent speeds to all section frames; before frames are built. */
void section_frames_build(System *system);
/* position and turns of a section frame in its part's axes; the first of its dependent speeds:
 * three shifts, then turns about z, y, x (a plane has one). NULL: the instance is no section
 * frame */
const SectionFrame *section_frame_of(const System *system, const Instance *arm, int *speed);

Expr speed_rate(const System *system, int speed);
/* its rate with u' or (NULL) without */
Expr speed_acceleration(const System *system, int speed, const Expr *accelerations);

/* The position in its root's axes of the point at `at` along a flexible part, and how its section
 * is turned; new, in the system's pool. */
const SectionFrame *shapes_point(const System *system, const Instance *part, Expr at);

/* of a flexible part: the number of shapes, the first of their speeds, and symbols of both; the
 * root is at rest */
int shapes_of(const Instance *part);
int shapes_first(const System *system, const Instance *part);
ShapeState shapes_state(const System *system, const Instance *part);

#endif
