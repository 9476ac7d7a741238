/* distribution.h: distributions of parameters, by the inverse of their distribution function */
#ifndef COTREE_SIMULATE_SWEEP_DISTRIBUTION_H
#define COTREE_SIMULATE_SWEEP_DISTRIBUTION_H

#include "base/diag.h"

enum { DISTRIBUTION_MOST = 3 }; /* arguments */

/* One distribution, perhaps truncated. */
typedef struct Distribution {
    int kind;                     /* a number of distribution_find() */
    double at[DISTRIBUTION_MOST]; /* its arguments, in SI */
    double low, high;             /* values outside don't occur; infinite: not truncated */
} Distribution;

int distribution_find(const char *name);      /* -1: there is none */
const char *distribution_name(int kind);      /* 0, 1, ...; NULL at the end */
const char *distribution_arguments(int kind); /* "MEAN, DEVIATION" */
int distribution_argument_count(int kind);
/* E_VALUE for arguments that it can't have, and bounds that leave nothing. No place. */
MUST_USE Status distribution_check(const Distribution *distribution, Diag *diag);
/* the value below which lies the share u of (0, 1) */
double distribution_quantile(const Distribution *distribution, double u);

#endif
