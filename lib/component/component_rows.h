/* component_rows.h: the rows of types.def by name, and what several of them share */
#ifndef COTREE_COMPONENT_COMPONENT_ROWS_H
#define COTREE_COMPONENT_COMPONENT_ROWS_H

#include "base/memory.h"
#include "component/component.h"

#define TYPE(id) extern const Component component_##id;
#include "component/types.def"
#undef TYPE

/* --- component.c: refuse numbers that a value can't be --- */

Status check_positive(const Instance *instance, const char *param, Diag *diag);
Status check_not_negative(const Instance *instance, const char *param, Diag *diag);

/* --- attitude.c: three shifts along the tail's axes, then any rotation --- */

enum { FREE_SHIFTS = 3, FREE_COORDS = 7, FREE_COORDS_PLANAR = 3 };

#define EULER_PARAM                                                                                \
    {                                                                                              \
        "euler", PARAM_WORD, NULL, "parameters|zxz|zyz|xyx|xzx|yxy|yzy|xyz|xzy|yxz|yzx|zxy|zyx",   \
            "coordinates of the rotation: Euler parameters q0 q1 q2 q3, or angles a1 a2 a3 of "    \
            "turns about these axes, each as the turns before it left it",                         \
            false                                                                                  \
    }

extern const CoordinateRow free_coords[FREE_COORDS];
extern const CoordinateRow free_coords_planar[FREE_COORDS_PLANAR];
/* Component.coords_of of rows with euler=; those of spherical are the rotation's alone */
const CoordinateRow *free_coords_of(const Instance *instance, int *count);
const CoordinateRow *spherical_coords_of(const Instance *instance, int *count);
/* the rotation, in coordinates `first` and on */
void attitude_steps(const Instance *instance, Arena *arena, int first, Steps *out);
void free_steps(const Instance *instance, Arena *arena, bool planar, Steps *out);
/* refuses euler= in a planar scene */
Status attitude_check(const Instance *instance, Arena *arena, bool planar, Diag *diag);

#endif
