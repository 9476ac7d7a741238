/* component_rows.h: the rows of types.def by name, and functions that several rows share */
#ifndef COTREE_COMPONENT_COMPONENT_ROWS_H
#define COTREE_COMPONENT_COMPONENT_ROWS_H

#include "base/memory.h"
#include "component/component.h"

#define TYPE(id) extern const Component component_##id;
#include "component/types.def"
#undef TYPE

/* --- component.c: refuse numbers that a value can't have --- */

MUST_USE Status check_positive(const Instance *instance, const char *param, Diag *diag);
MUST_USE Status check_not_negative(const Instance *instance, const char *param, Diag *diag);

/* stops.c: e= of what is rigid or k= of what is compliant; of_k: the keys that belong to k=, first
 * that of its damping, NULL at the end */
MUST_USE Status check_limit_law(const Instance *instance, const char *const *of_k, Diag *diag);
/* friction.c: static= is 1 or more; what: "bound" */
MUST_USE Status check_static_ratio(const Instance *instance, const char *what, Diag *diag);
/* friction.c: a bound, 0 where its law falls below 0: friction drives nothing */
Expr friction_positive(Arena *arena, Expr bound);

Expr axis_dot(Arena *arena, const Expr a[3], const Expr b[3]);
void axis_cross(Arena *arena, const Expr a[3], const Expr b[3], Expr out[3]); /* a x b */

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
/* Component.coords_of of rows with euler=; spherical has only those of the rotation */
const CoordinateRow *free_coords_of(const Instance *instance, int *count);
const CoordinateRow *spherical_coords_of(const Instance *instance, int *count);
/* the rotation, in coordinates from `first` on */
void attitude_steps(const Instance *instance, Arena *arena, int first, Steps *out);
void free_steps(const Instance *instance, Arena *arena, bool planar, Steps *out);
/* refuses euler= in a planar scene */
MUST_USE Status attitude_check(const Instance *instance, Arena *arena, bool planar, Diag *diag);

/* --- scalar.c: shared by scalar domains; relations are those of Component.relation --- */

/* content value*x, and stored energy value*x^2/2 */
void scalar_storage(RelationKind kind, Expr value, Expr x, Arena *arena, Relation *out);
/* of rows with a param `value`: across = value, or through = -value (the flow into plus) */
void scalar_across_source(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out);
void scalar_through_source(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out);
/* couples a line to a joint: across = rate of the joint's coordinate, and through acts on it */
void scalar_rate_of_joint(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out);
Expr scalar_through_on_joint(const Instance *instance, Arena *arena, const Motion1 *motion);
/* of two edges p and s, lossless: across_p = ratio * across_s, through_s = -ratio * through_p */
void scalar_converter(const Instance *instance, Arena *arena, int which, Expr ratio, Relation *out);
/* of rows with params k and d: through = k*deflection + d*across, deflection' = across. The
 * deflection is a state of the part's own where both k and d are given, and content where only k
 * is. */
void scalar_spring(const Instance *instance, const char *deflection, Arena *arena,
                   const Motion1 *motion, Relation *out);
int scalar_spring_states(const Instance *instance);
void scalar_spring_state(const Instance *instance, const char *deflection, Arena *arena,
                         OwnState *out);
MUST_USE Status scalar_check_spring(const Instance *instance, Arena *arena, bool planar,
                                    Diag *diag);
/* refuses a joint's coordinate of the other kind; `instead` names an alternative */
MUST_USE Status scalar_check_hinge(const Instance *instance, bool hinge, const char *instead,
                                   Diag *diag);

#endif
