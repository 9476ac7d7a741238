/* numbers.h: a System's expressions in numbers: programs, and where their inputs stand
 *
 * A Layout fixes the order of inputs for all programs over one system: t, references of angles that
 * count turns, q, u, x, signs on surfaces, x', z, u', lambda, efforts, u''; a program's parameters
 * come behind these. Numbers is the reading to run as Equations; a Probe computes any other
 * expressions at a row. Both are on the layout's sides of its surfaces (formulate/surfaces.h). */
#ifndef COTREE_SIMULATE_EQUATIONS_NUMBERS_H
#define COTREE_SIMULATE_EQUATIONS_NUMBERS_H

#include "compile/program.h"
#include "formulate/surfaces.h"
#include "formulate/system.h"
#include "simulate/equations/motion.h"
#include "simulate/equations/setting.h"

typedef struct Layout {
    System *system;
    Expr *side;   /* one a switch: symbol of the side that it is on; NULL: that is no number here */
    bool *closed; /* one a switch: that side */
    int switches;
    uint64_t sides; /* counts changes of them: what was computed with others is outdated */
    int n, nu, m, nx, nz, ne, turned, slides;
    int t, near, q, u, x, signs, rates, z, acceleration, multipliers, efforts, jerk; /* first */
    int count;
    Expr *symbols; /* count */
    Surface *surfaces;
    int surface_count; /* those that it slides along come first: `slides` of them */
} Layout;

/* y of a run is q, u, x, references, work */
static inline int layout_turned(const Layout *l) /* place of the first reference in it */
{
    return l->n + l->nu + l->nx;
}

Layout *layout_new(System *system); /* new; free with layout_free(). Symbols of u'' are made. */
/* The same on sides of some of the system's surfaces, by number: -1 or 1; 0: it slides along. */
typedef struct OnSurface {
    int surface, side;
} OnSurface;
Layout *layout_new_on(System *system, const OnSurface *on, int count);
/* e on the sides of the layout's surfaces */
Expr layout_on_surfaces(const Layout *layout, Expr e);
/* A symbol that is a side of a switch in this layout: its number; -1: it is none */
int layout_side_of(const Layout *layout, Expr symbol);
void layout_free(Layout *layout);
/* Sides of switches that are numbers, from now on in all programs over the layout; one a switch. */
void layout_take_sides(Layout *layout, const bool *closed);
/* whether any of the roots changes with t alone, while no state does */
bool layout_follows_time(const Layout *layout, const Expr *roots, int count);

/* Values of parameters, kept from the start of a run on. */
typedef struct Parameters {
    ParameterValue value;
    void *context;
    int count, room;
    Expr *symbols;
    double *values;
} Parameters;

double parameters_value(Parameters *parameters, Expr symbol); /* kept, else asked and kept */
void parameters_set(Parameters *parameters, Expr symbol, double value); /* kept from now on */
/* Whole turns of sums of angles are 0 where no others are kept. */
void parameters_begin_turns(Parameters *parameters, const System *system);
/* the number of an expression of parameters alone */
double parameters_evaluate(Parameters *parameters, Expr e);
void parameters_free(Parameters *parameters);

/* for expr_evaluate() and the like; the context is the Parameters */
double parameters_value_in(void *parameters, Expr symbol);

/* what a row knows; arrays may be NULL for 0 */
typedef struct RowValues {
    double t;
    const double *near, *q, *u, *x, *signs, *rates, *z, *acceleration, *multipliers, *efforts,
        *jerk;
} RowValues;

/* t, and what y holds */
RowValues row_of_state(const Layout *layout, double t, const double *y);
/* and what the motion solves for there, borrowed until the next call on it; false: it has no
 * solution, and the row is without */
bool row_solve(const Layout *layout, Motion *motion, double t, const double *y, RowValues *out);

typedef struct Probe Probe;
/* Compile; the layout outlives the probe. Fails as program_new() does. */
MUST_USE Status probe_new(const Layout *layout, Parameters *parameters, const Expr *roots,
                          int count, Probe **out, Diag *diag);
void probe_free(Probe *probe); /* NULL is fine */
/* Another value of a parameter, for this probe alone. False: no root holds it. */
bool probe_turn(Probe *probe, Expr parameter, double value);
/* The number of a symbol that somebody has put behind those of the layout, `place` among its
 * symbols: write here. */
double *probe_input(Probe *probe, int place);
/* the values of the roots; borrowed, until the next call */
const double *probe_values(Probe *probe, const RowValues *row);
/* How far these values may be off where the row is off by `errors`; t and parameters are as
 * number_error() has them. */
void probe_errors(const Probe *probe, const RowValues *errors, double *out);

typedef struct Numbers Numbers;
/* Compile the reading to run. `layout` and `parameters` outlive it. */
MUST_USE Status numbers_new(const Layout *layout, Parameters *parameters, Numbers **out,
                            Diag *diag);
void numbers_free(Numbers *numbers); /* NULL is fine */
const Equations *numbers_equations(const Numbers *numbers);
/* Another value of a parameter in all of its programs, where they hold it. */
void numbers_set(Numbers *numbers, Expr parameter, double value);
/* what condition i of the equations compares with 0; NULL: it is whether a diode stays on its side
 */
Expr numbers_condition(const Numbers *numbers, int i);
/* the switch, of system_ideal(), that a condition is the margin of, where that gives NULL */
int numbers_margin(const Numbers *numbers, int condition);

#endif
