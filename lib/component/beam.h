/* beam.h: shapes of a beam, and integrals over its length; theory 9
 *
 * A shape is a polynomial in xi = x/L, exact. */
#ifndef COTREE_COMPONENT_BEAM_H
#define COTREE_COMPONENT_BEAM_H

#include "algebra/polynomial.h"
#include "component/component.h"

typedef enum ShapeFamily { SHAPE_U, SHAPE_V, SHAPE_W, SHAPE_PHI, SHAPE_FAMILIES } ShapeFamily;

enum { MOST_SHAPES = 16 }; /* of a family */

typedef struct BeamShape {
    ShapeFamily family;
    Polynomial value, slope, curve; /* over xi, and its derivatives by xi */
} BeamShape;

typedef struct Beam {
    const Instance *instance;
    Arena *arena;
    bool planar, shortens, rotates;
    int limit; /* order of T and work in shapes and their rates together; LIMITLESS */
    int count;
    BeamShape *shapes;
    Expr length;
} Beam;

enum { LIMITLESS = 8 };

/* Exact numbers are made between the two alone (base/exact_memory.h). */
Beam beam_open(const Instance *instance, Arena *arena, bool planar);
void beam_close(Beam *beam);
/* how many shapes of each family */
void beam_modes(const Instance *instance, bool planar, int modes[SHAPE_FAMILIES]);

Expr beam_number(Arena *arena, const mpq_t value);
Expr beam_value_at(Arena *arena, const Polynomial *p, Expr xi);
/* of the slopes of two shapes of one family, from 0 to xi, by xi */
Polynomial beam_shortening(const BeamShape *a, const BeamShape *b);
bool beam_bends(const BeamShape *shape);

void beam_station(const Instance *instance, Arena *arena, bool planar, Expr at,
                  const ShapeState *state, Station *out);
void beam_inertia(const Instance *instance, Arena *arena, bool planar, const ShapeState *state,
                  ShapeInertia *out);
double beam_unit(const Instance *instance, bool planar, int i);
SectionForce beam_has_section(const Instance *instance, bool planar, const char *name);
Expr beam_section(const Instance *instance, Arena *arena, bool planar, const char *name, Expr at,
                  const ShapeState *state);

#endif
