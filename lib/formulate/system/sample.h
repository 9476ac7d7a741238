/* sample.h: numbers at a random position */
#ifndef COTREE_FORMULATE_SYSTEM_SAMPLE_H
#define COTREE_FORMULATE_SYSTEM_SAMPLE_H

#include "formulate/system/system.h"

typedef struct Sample { /* a random position */
    const System *system;
    double *q;
    double *value; /* by numbers of symbols; NAN where there is none */
    int count;
    Evaluation *evaluation; /* NULL: nothing is remembered */
    uint32_t others;        /* seed of all other symbols' values, 0.7 to 1.3; 0: they have none */
} Sample;

/* in the system's pool; `vary`: with other parameters too, for what holds whatever they are */
Sample *sample_new(const System *system, uint64_t seed, bool vary);
/* gives data of parts, which are parameters in large scenes, back their own values: unit vectors,
 * say, stay such */
void sample_keep_data(Sample *sample);
/* From now on nodes that several expressions share are computed once, until that is forgotten: what
 * was asked for stays in the arena so long. */
void sample_remember(Sample *sample);
void sample_forget(Sample *sample);
/* of an expression in q and parameters; NAN where there is more in it */
double sample_number(Sample *sample, Expr e);

/* what an expression is where all its symbols have values that the seed chooses, 0.7 to 1.3 */
double expr_value_somewhere(Expr e, uint32_t seed);

#endif
