/* beam.h: shapes of a beam, and integrals over its length; theory 9
 *
 * A shape is an exact polynomial in xi = x/L (no unit, 0 to 1). */
#ifndef COTREE_COMPONENT_BEAM_H
#define COTREE_COMPONENT_BEAM_H

#include "algebra/polynomial.h"
#include "component/component.h"

typedef enum ShapeFamily { SHAPE_U, SHAPE_V, SHAPE_W, SHAPE_PHI, SHAPE_FAMILIES } ShapeFamily;

enum { MOST_SHAPES = 16 }; /* of a family */

/* a value may vary along the beam as a polynomial of x, with that number of powers */
enum { MOST_POWERS = 13 };

typedef struct Powers {
    int count; /* of xi^0, xi^1 ... */
    Expr at[MOST_POWERS];
} Powers;

typedef struct BeamShape {
    ShapeFamily family;
    Polynomial value, slope, curve; /* over xi, and its derivatives by xi */
} BeamShape;

typedef struct Beam {
    const Instance *instance;
    Arena *arena;
    bool planar, shortens;
    /* order of T and work in shapes and their rates together, above which terms are dropped;
     * LIMITLESS */
    int limit;
    int count;
    BeamShape *shapes;
    Expr length;
} Beam;

enum { LIMITLESS = 8 };

/* Exact numbers may only be made between beam_open() and beam_close() (base/exact_memory.h). */
Beam beam_open(const Instance *instance, Arena *arena, bool planar);
void beam_close(Beam *beam);
/* number of shapes of each family */
void beam_modes(const Instance *instance, bool planar, int modes[SHAPE_FAMILIES]);

/* powers of x in a value; count 0: it is no such polynomial */
Powers beam_powers(const Instance *instance, Arena *arena, Expr value);
/* powers of one of the beam's keys */
Powers beam_key(const Beam *beam, const char *key);
Expr powers_at(Arena *arena, const Powers *p, Expr xi);
int beam_load_powers(const Instance *instance, Arena *arena);

/* P_k over 0..1 */
Polynomial beam_legendre(int k);
Expr beam_number(Arena *arena, const mpq_t value);
/* for two shapes of one family: integral of the product of their slopes, from 0 to xi */
Polynomial beam_shortening(const BeamShape *a, const BeamShape *b);
bool beam_bends(const BeamShape *shape);

void beam_section_frame(const Instance *instance, Arena *arena, bool planar, Expr at,
                        const ShapeState *state, SectionFrame *out);
void beam_inertia(const Instance *instance, Arena *arena, bool planar, Expr from,
                  const ShapeState *state, ShapeInertia *out);
double beam_unit(const Instance *instance, bool planar, int i);
const SectionPart *beam_section(bool planar, const char *name);

#endif
