/* section_frames.h: frames on parts that deform, and the speeds that move them (theory 9)
 *
 * A station is an arm with at=. Its branch turns and shifts it along axes of the part's root at
 * rates that follow from those of the shapes, by *dependent speeds*, which stand behind the
 * system's own. */
#ifndef COTREE_FORMULATE_KINEMATICS_SECTION_FRAMES_H
#define COTREE_FORMULATE_KINEMATICS_SECTION_FRAMES_H

#include "formulate/system/kinematics.h"

/* how a dependent speed follows from speeds `first` and on: sum factor u, and the rest of its rate
 * at u' = 0 */
typedef struct Dependent {
    int first, count;
    Expr *factor;
    Expr rate, rest;
} Dependent;

/* Places for dependent speeds of all stations; before frames are built. */
void section_frames_build(System *system);
/* where a station stands in its part's axes; the first of its dependent speeds: three shifts, then
 * turns about z, y, x (a plane has one). NULL: the instance is none */
const SectionFrame *section_frame_of(const System *system, const Instance *arm, int *speed);

Expr speed_rate(const System *system, int speed);
/* its rate with u' or (NULL) without */
Expr speed_acceleration(const System *system, int speed, const Expr *accelerations);

/* Where the point at `at` along a part that deforms stands in its root's axes, and how its section
 * is turned; new, in the system's pool. */
const SectionFrame *shapes_point(const System *system, const Instance *part, Expr at);

/* of a part that deforms: how many shapes, the first of their speeds, and symbols of both; the
 * root rests */
int shapes_of(const Instance *part);
int shapes_first(const System *system, const Instance *part);
ShapeState shapes_state(const System *system, const Instance *part);

#endif
