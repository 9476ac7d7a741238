/* dop853_impl.h: a step of dop853, shared by its files: dop853.c takes it, dop853_stages.c sums its
 * stages, dop853_scale.c scales errors, dop853_stiff.c detects stiffness, dop853_dense.c
 * interpolates */
#ifndef COTREE_SIMULATE_INTEGRATE_DOP853_IMPL_H
#define COTREE_SIMULATE_INTEGRATE_DOP853_IMPL_H

#include "simulate/integrate/ode.h"

#define DOP853_AIM                                                                                 \
    0.1 /* of the tolerance, a step: some hundred of them then add up to about it                  \
         */

/* rows of the tableau: of each stage from those before it, by its number; and of weighted sums */
enum {
    ROW_END = 12,
    ROW_EXTRA, /* stages from here on are for dense output alone */
    STAGES = 16,
    ROW_ERROR_FIVE = STAGES,
    ROW_THIRD,
    ROW_DENSE,
    DENSE_ROWS = 4, /* from ROW_DENSE on */
    ROWS = ROW_DENSE + DENSE_ROWS
};

enum {
    DENSE_TERMS = 3 + DENSE_ROWS,
    DENSE_PARTS = 16, /* at most, of a step whose dense output has several */
    TOGETHER = 8      /* entries that are summed together */
};

/* y over a part of a step, along a polynomial */
typedef struct DensePart {
    double from, length; /* s */
    double *old;
    double *terms[DENSE_TERMS];
} DensePart;

/* steps since the last series of calm ones (dop853_stiff.c) */
typedef struct Stiffness {
    int steps;  /* that stability limits */
    double sum; /* of h |L| of those whose accuracy a fast component limits */
    int calm;   /* in series: neither */
} Stiffness;

/* All arrays belong to the stepper and are freed with it. */
typedef struct Dop853 {
    Stepper base;
    int n, all; /* entries in the error test; with quadratures */
    int room; /* of k, sums, old and dense output: `all`, and zeros up to a multiple of TOGETHER */
    double *k[STAGES], *sums[3];
    double *old, *new, *stage_point, *scale;
    DensePart dense[DENSE_PARTS]; /* memory for each is allocated when it is first needed */
    double *spare[3];             /* start of a part, the rate there and at its end */
    int parts;                    /* of the last step; 0: there is no dense output yet */
    double parted;                /* distance of its end from that of its parts, in tolerances */
    double step;                  /* s: length of the last step; */
    double rounding_error;        /* and factor by which rounding error raises its tolerance */
    double rounding[STAGES];      /* of rates at each stage, not 0 near a singular position; */
    double rounded;               /* the largest since an error was last estimated */
    bool was_rejected;
    Stiffness stiffness;
    double *peak; /* n: the largest |y'| of recent steps */
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

/* the tableau (dop853_table.c): positions of the stages in a step, as fractions of it; and its
 * rows */
extern const double dop853_nodes[STAGES];
extern const TableauTerms dop853_rows[ROWS];

/* The weighted sum of stages for a row of the tableau (room), in `sums`, which it returns. The
 * terms are added in the order of the row, on every processor. */
const double *dop853_weigh(const Dop853 *d, int row, double *sums);
/* out = old + h sum (count each) */
void dop853_move(const double *old, double h, const double *sum, int count, double *out);
/* Add the rounding error of rates so far to `rounded`, since it isn't the next stage's. */
void dop853_note_rounding(Dop853 *d);
/* Compute k[stage] and its rounding error from the stages before it, in a step h from `old` at
 * base.before; `point` (all) is its y. False: f is undefined there. */
bool dop853_set_stage(Dop853 *d, int stage, double h, double *point);
/* Stages 1 to 11 of such a step; `stage_point` is the point of stage 11. False: as above. */
bool dop853_set_stages(Dop853 *d, double h);

/* Set `scale`, the error that a step may have in each entry (n), for y at its ends a and b. */
void dop853_choose_scale(Dop853 *d, const double *a, const double *b);
/* the root of the mean square of v (n) in units of `scale`, and the sum of products of v and w */
double dop853_norm(const Dop853 *d, const double *v);
double dop853_product(const Dop853 *d, const double *v, const double *w);

/* Counts the step of h just taken as stiff or calm, and sets base.found_stiff and
 * base.is_oscillatory. `error`: its estimate, in tolerances. It reads `stage_point` of stage 11,
 * before any dense output is made. Mostly no evaluations; five where stiff steps have become
 * many. */
void dop853_watch_stiffness(Dop853 *d, double h, double error);

/* allocate a part of the dense output, unless that is done */
void dop853_reserve_room(Dop853 *d, DensePart *part);
/* The dense output of the last step, from its stages: three evaluations, or some hundreds where it
 * has several parts. Sets `parts` and `parted`. */
void dop853_make_dense(Dop853 *d);
/* y (all) at t in the last step, from its dense output, which has to exist */
void dop853_interpolate(const Dop853 *d, double t, double *y);

#endif
