/* beam.h: shapes of a beam, and integrals over its length; theory 9
 *
 * A shape is a polynomial in xi = x/L, exact. */
#ifndef COTREE_COMPONENT_BEAM_H
#define COTREE_COMPONENT_BEAM_H

#include "algebra/polynomial.h"
#include "component/component.h"

typedef enum ShapeFamily { SHAPE_U, SHAPE_V, SHAPE_W, SHAPE_PHI, SHAPE_FAMILIES } ShapeFamily;

enum { MOST_SHAPES = 16 }; /* of a family */

/* of the place along a beam: a key may vary as a polynomial of x, up to that degree */
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

/* of a value in which x is the place; no powers: it is no such polynomial */
Powers beam_powers(const Instance *instance, Arena *arena, Expr value);
/* of one of its keys */
Powers beam_key(const Beam *beam, const char *key);
Expr powers_at(Arena *arena, const Powers *p, Expr xi);
int beam_load_powers(const Instance *instance, Arena *arena);

/* P_k over 0..1 */
Polynomial beam_legendre(int k);
Expr beam_number(Arena *arena, const mpq_t value);
/* of the slopes of two shapes of one family, from 0 to xi, by xi */
Polynomial beam_shortening(const BeamShape *a, const BeamShape *b);
bool beam_bends(const BeamShape *shape);

void beam_section_frame(const Instance *instance, Arena *arena, bool planar, Expr at,
                        const ShapeState *state, SectionFrame *out);
void beam_inertia(const Instance *instance, Arena *arena, bool planar, Expr from,
                  const ShapeState *state, ShapeInertia *out);
double beam_unit(const Instance *instance, bool planar, int i);
const SectionPart *beam_section(bool planar, const char *name);

#endif
