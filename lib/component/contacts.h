/* contacts.h: shapes that touch a surface, for what rolls on it and what may leave it */
#ifndef COTREE_COMPONENT_CONTACTS_H
#define COTREE_COMPONENT_CONTACTS_H

#include "component/component.h"

/* clang-format off */
#define SHAPE_PARAMS                                                                               \
    {"radius",   PARAM_SCALAR, "m", "0", "of the wheel, to the middle of a round rim, or of the ball", 0}, \
    {"axle",     PARAM_AXIS,   "1", "z", "of a wheel, in the axes of the tip; without it a ball rolls", 0}, \
    {"normal",   PARAM_AXIS,   "1", "z", "of the plane that it rolls on, in the axes of the tail; planar: y", 0}, \
    {"rim",      PARAM_SCALAR, "m", "0", "radius of a wheel's round rim", 0},                      \
    {"semiaxes", PARAM_LIST,   "m", "",  "[a, b, c] of an ellipsoid along the axes of the tip", 0}, \
    {"bowl",     PARAM_SCALAR, "m", "0", "radius of a bowl about the tail's origin, in which a ball rolls", 0}, \
    {"dome",     PARAM_SCALAR, "m", "0", "radius of a dome about the tail's origin, on which a ball rolls", 0}
#define FRICTION_PARAMS                                                                            \
    {"mu",     PARAM_LAW,    "1", "0", "coefficient of friction; without it none", 0},             \
    {"static", PARAM_SCALAR, "1", "1", "static over kinetic coefficient", 0}
#define ROLL_PARAMS                                                                                \
    SHAPE_PARAMS, FRICTION_PARAMS,                                                                 \
    {"offset", PARAM_SCALAR, "m", "0", "planar: of the way along the line where the wheel's angle is 0", 0}
/* clang-format on */

/* The rows of a shape: along the normal, with its gap, and along the tangents. */
void roll_contact(const Instance *instance, Arena *arena, bool planar, const FramesApart *apart,
                  Contact *out);
/* a wheel's rim, or the sections of a ball or an ellipsoid along its axes */
int roll_rings(const Instance *instance, Arena *arena, bool planar, ContactRing out[MOST_RINGS]);
/* Refuses the value `about`. */
MUST_USE Status contact_refuse(Diag *diag, const char *about, const char *message,
                               const char *hint);
/* Refuses shapes that there are not; a point is one without a radius. */
Status check_shape(const Instance *instance, bool planar, bool may_be_point, Diag *diag);

#endif
