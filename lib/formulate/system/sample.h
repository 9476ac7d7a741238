/* sample.h: numbers at a random position */
#ifndef COTREE_FORMULATE_SYSTEM_SAMPLE_H
#define COTREE_FORMULATE_SYSTEM_SAMPLE_H

#include "formulate/system/system.h"

typedef struct Sample { /* a random position */
    const System *system;
    double *q;
    double *value; /* by numbers of symbols; NAN where there is no value */
    int count;
    Evaluation *evaluation; /* NULL: nothing is remembered */
    uint32_t others; /* seed of all other symbols' values, 0.7 to 1.3; 0: they have no values */
} Sample;

/* in the system's pool; `vary`: with other parameters too, for tests that must hold for any
 * parameters */
Sample *sample_new(const System *system, uint64_t seed, bool vary);
/* gives data of parts, which are parameters in large scenes, their own values again: unit vectors,
 * for example, then remain unit vectors */
void sample_keep_data(Sample *sample);
/* From now on nodes that several expressions share are computed once, until that is forgotten:
 * until then the evaluated expressions must remain in the arena. */
void sample_remember(Sample *sample);
void sample_forget(Sample *sample);
/* value of an expression in q and parameters; NAN where it contains more */
double sample_number(Sample *sample, Expr e);

/* value of an expression where all its symbols have values chosen by the seed, 0.7 to 1.3 */
double expr_value_somewhere(Expr e, uint32_t seed);

#endif
