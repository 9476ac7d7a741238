/* dop853_impl.h: a step of dop853 as its files share it: dop853.c takes it, dop853_stages.c sums
 * its stages, dop853_scale.c measures errors, dop853_stiff.c tells what limits it, dop853_dense.c
 * reads between its ends */
#ifndef COTREE_SIMULATE_INTEGRATE_DOP853_IMPL_H
#define COTREE_SIMULATE_INTEGRATE_DOP853_IMPL_H

#include "simulate/integrate/ode.h"

#define DOP853_AIM                                                                                 \
    0.1 /* of the tolerance, a step: some hundred of them then add up to about it                  \
         */

/* rows of the tableau: of a stage from those before it, by its number; and of their sums */
enum {
    ROW_END = 12,
    ROW_EXTRA, /* stages from here on serve the dense output alone */
    STAGES = 16,
    ROW_ERROR_FIVE = STAGES,
    ROW_THIRD,
    ROW_DENSE,
    DENSE_ROWS = 4, /* from ROW_DENSE on */
    ROWS = ROW_DENSE + DENSE_ROWS
};

enum {
    DENSE_TERMS = 3 + DENSE_ROWS,
    DENSE_PARTS = 16, /* at most, of a step whose dense output is made of several */
    TOGETHER = 8      /* entries that are summed together */
};

/* y over a part of a step, along a polynomial */
typedef struct DensePart {
    double from, length; /* s */
    double *old;
    double *terms[DENSE_TERMS];
} DensePart;

/* All arrays belong to the stepper, and are freed with it. */
typedef struct Dop853 {
    Stepper base;
    int n, all; /* in the error test; with quadratures */
    int room; /* of k, sums, old and dense output: all, and what fills a multiple of TOGETHER, which
               * is 0
               */
    double *k[STAGES], *sums[3];
    double *old, *new, *stage_point, *scale;
    DensePart dense[DENSE_PARTS]; /* room for each is taken when it is first needed */
    double *spare[3];             /* where a part begins, its rate there and at its end */
    int parts;                    /* of the last step; 0: dense output isn't there yet */
    double parted;                /* errors that it aims at, from its end to that of its parts */
    double step;                  /* of the last step, s; */
    double rounding_error;        /* and what rounding makes of its tolerance */
    double rounding[STAGES];      /* of rates at each stage, not 0 near a singular position; */
    double rounded;               /* the largest since an error was measured by it */
    bool was_rejected;
    int stiff, calm; /* steps above and below the boundary */
} Dop853;

/* a term of a weighted sum of stages */
typedef struct TableauEntry {
    int stage;
    double weight;
} TableauEntry;

typedef struct TableauTerms {
    const TableauEntry *at;
    int count;
} TableauTerms;

/* the tableau (dop853_table.c): where in a step its stages are, as parts of it; and its rows */
extern const double dop853_nodes[STAGES];
extern const TableauTerms dop853_rows[ROWS];

/* The weighted sum of stages that a row of the tableau tells (room), in `sums`, which it returns;
 * in the order of the row's terms, whatever the processor. */
const double *dop853_weigh(const Dop853 *d, int row, double *sums);
/* out = old + h sum (count each) */
void dop853_move(const double *old, double h, const double *sum, int count, double *out);
/* Rounding of rates so far is none of the next stage's. */
void dop853_note_rounding(Dop853 *d);
/* k[stage] and its rounding from the stages before it, in a step of h from `old` at base.before;
 * `point` (all) is where. False: f is undefined there. */
bool dop853_set_stage(Dop853 *d, int stage, double h, double *point);
/* Stages 1 to 11 of such a step; `stage_point` keeps that of stage 11. False: as above. */
bool dop853_set_stages(Dop853 *d, double h);

/* `scale`: an error that a step may make in each entry (n), with y at its ends a and b */
void dop853_choose_scale(Dop853 *d, const double *a, const double *b);
/* the root of the mean square of v (n) in units of `scale`, and the sum of products of v and w */
double dop853_norm(const Dop853 *d, const double *v);
double dop853_product(const Dop853 *d, const double *v, const double *w);

/* Counts the step of h just taken as stiff or calm, and sets base.is_stiff and base.swings. It
 * reads `stage_point` of stage 11, before any dense output is made. Mostly no evaluations; five
 * where stiff steps have become many. */
void dop853_watch_stiffness(Dop853 *d, double h);

/* room for a part of the dense output, unless it is there */
void dop853_reserve_room(Dop853 *d, DensePart *part);
/* The dense output of the last step, from its stages: three evaluations, some hundreds where it is
 * made of parts. Sets `parts` and `parted`. */
void dop853_make_dense(Dop853 *d);
/* y (all) at t of the last step, by a dense output that is made */
void dop853_interpolate(const Dop853 *d, double t, double *y);

#endif
