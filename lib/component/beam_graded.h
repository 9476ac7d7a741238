/* beam_graded.h: what varies along a beam
 *
 * A Graded holds parts of rising order in shapes and their rates, each as numbers along the beam:
 * coefficients of Legendre's polynomials, of powers of xi, or values at the points of a Gauss rule.
 */
#ifndef COTREE_COMPONENT_BEAM_GRADED_H
#define COTREE_COMPONENT_BEAM_GRADED_H

#include "base/memory.h"
#include "component/beam.h"

enum { ORDERS = 5 }; /* 0..4: products of two that go up to the second */

typedef struct Graded {
    Expr *at[ORDERS]; /* NULL: nothing of that order */
} Graded;

typedef enum Basis { BASIS_LEGENDRE, BASIS_POWERS, BASIS_POINTS } Basis;

typedef struct GradedShapes {
    const Beam *beam;
    Arena *arena;
    Pool *pool;
    Basis basis;
    int length; /* coefficients or points */
    int degree;
    Expr from;              /* where integrals begin, over 0..1 */
    Expr *points, *weights; /* of a Gauss rule, NULL where integrals are written out, */
    int point_count;
    Expr *legendre; /* and values of Legendre's polynomials there, of which sums are stable */
    const ShapeState *state;
    int limit[3]; /* orders of what the root feels, of its coupling with shapes, of shapes */
} GradedShapes;

/* Of quantities of that degree at most, with densities of that of `varies`; its arrays are the
 * pool's. */
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

/* What integrals over the beam are weighed with: a density. One that is constant is a factor
 * outside of them. */
typedef struct Weights {
    Expr factor;
    int band; /* in BASIS_LEGENDRE: of a symmetric matrix, (m, m + b) at m (band + 1) + b */
    Expr *at; /* of each part else; over xi */
} Weights;

Weights weights_of(const GradedShapes *along, const Powers *density);
/* Over x from 0 to L, of orders from..most. The factor is left to beam_add(). */
Expr graded_integral(const GradedShapes *along, const Weights *weights, Graded g, int from,
                     int most);
/* The same of a product, in BASIS_LEGENDRE, whose polynomials are orthogonal: one of the two comes
 * from graded_weighed(). */
Graded graded_weighed(const GradedShapes *along, const Weights *weights, Graded g);
Expr graded_inner(const GradedShapes *along, Graded weighed, Graded g, int from, int most);

/* to += factor what */
void beam_add(const GradedShapes *along, Expr *to, Expr factor, Expr what);
/* of which angle (x, y, z) is a shape; -1: of none */
int beam_angle(const BeamShape *shape);

/* d'Alembert's forces of the axis, of mass_per_length= */
void beam_add_axis(const GradedShapes *along, const Powers *density, ShapeInertia *out);
/* of the sections' turning, of inertia_per_length= */
void beam_add_rotary(const GradedShapes *along, const Powers J[3], ShapeInertia *out);

#endif
