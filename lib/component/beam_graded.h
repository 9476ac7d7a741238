/* beam_graded.h: quantities that vary along a beam
 *
 * A Graded has parts of ascending order in shapes and their rates. Each part is an array of numbers
 * along the beam: coefficients of Legendre polynomials, of powers of xi, or values at the points of
 * a Gauss rule. */
#ifndef COTREE_COMPONENT_BEAM_GRADED_H
#define COTREE_COMPONENT_BEAM_GRADED_H

#include "base/memory.h"
#include "component/beam.h"

enum { ORDERS = 5 }; /* 0..4: products of two quantities up to the second order */

typedef struct Graded {
    Expr *at[ORDERS]; /* NULL: this order is 0 */
} Graded;

typedef enum Basis { BASIS_LEGENDRE, BASIS_POWERS, BASIS_POINTS } Basis;

typedef struct GradedShapes {
    const Beam *beam;
    Arena *arena;
    Pool *pool;
    Basis basis;
    int length; /* coefficients or points */
    int degree;
    Expr from;              /* lower limit of integrals, in 0..1 */
    Expr *points, *weights; /* of a Gauss rule, NULL where integrals are exact, */
    int point_count;
    /* and values of Legendre polynomials there, whose sums are numerically stable */
    Expr *legendre;
    const ShapeState *state;
    /* orders of the loads on the root, of its coupling with shapes, and of the loads on shapes */
    int limit[3];
} GradedShapes;

/* For quantities of at most that degree, with densities of the degree of `varies`; its arrays are
 * in the pool. */
GradedShapes along_of(const Beam *beam, Expr from, const ShapeState *state, Pool *pool, Basis basis,
                      int degree, int varies);

Expr *parts_of(const GradedShapes *along, const Polynomial *p);
void parts_add(const GradedShapes *along, Expr **to, const Expr *parts, Expr scale);
void parts_hold(const GradedShapes *along, Expr *parts);
Graded graded_hold(const GradedShapes *along, Graded g);
void graded_add(const GradedShapes *along, Graded *to, Graded g, Expr scale);
Graded graded_plus(const GradedShapes *along, Graded a, int sign, Graded b);
Graded graded_scaled(const GradedShapes *along, Expr scale, Graded a);
Graded graded_constant(const GradedShapes *along, int value);
/* not in BASIS_LEGENDRE */
Graded graded_times(const GradedShapes *along, Graded a, Graded b);

/* The weight of integrals over the beam: a density. A constant one is a factor outside of the
 * integral. */
typedef struct Weights {
    Expr factor;
    int band; /* in BASIS_LEGENDRE: of a symmetric matrix, (m, m + b) at m (band + 1) + b */
    Expr *at; /* otherwise of each part; over xi */
} Weights;

Weights weights_of(const GradedShapes *along, const Powers *density);
/* Over x from 0 to L, of orders from..most. beam_add() applies the factor. */
Expr graded_integral(const GradedShapes *along, const Weights *weights, Graded g, int from,
                     int most);
/* The same for a product, in BASIS_LEGENDRE, whose polynomials are orthogonal: one of the two
 * factors comes from graded_weighed(). */
Graded graded_weighed(const GradedShapes *along, const Weights *weights, Graded g);
Expr graded_inner(const GradedShapes *along, Graded weighed, Graded g, int from, int most);

/* to += factor what */
void beam_add(const GradedShapes *along, Expr *to, Expr factor, Expr what);
/* the axis of the angle (0 x, 1 y, 2 z) that the shape is; -1: none */
int beam_angle(const BeamShape *shape);

/* d'Alembert's forces of the axis, of mass_per_length= */
void beam_add_axis(const GradedShapes *along, const Powers *density, ShapeInertia *out);
/* rotary inertia of the sections, of inertia_per_length= */
void beam_add_rotary(const GradedShapes *along, const Powers J[3], ShapeInertia *out);

#endif
