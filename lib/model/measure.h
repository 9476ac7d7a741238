/* measure.h: the dimension of a value, as far as its text determines it
 *
 * Literals with units, variables and functions have known dimensions. Sums, products, powers and
 * calls propagate them. A plain number is taken as SI: it may be a quantity of any dimension, so
 * the dimension of its product with a quantity is unknown.
 *
 * Two known dimensions that differ can't be added or compared. A value with a unit written in it
 * can't be used where another dimension is required (a key, an argument of sin). An unknown
 * dimension is accepted. A value without units may be meant in SI (force=-s, sin(s)), and so may a
 * bare t in a sum (10 V + t). Next to units the seconds of t may be omitted (30 deg*t). A quotient
 * without dimension is a number for a key, but not in a sum.
 *
 * All checks are made when a statement is applied, and cost nothing later. */
#ifndef COTREE_MODEL_MEASURE_H
#define COTREE_MODEL_MEASURE_H

#include "expr/units.h"

#include <stdbool.h>

typedef enum MeasureKind {
    MEASURE_ANY,    /* can't be determined */
    MEASURE_NUMBER, /* a plain number: 9.81 may be an acceleration */
    /* a number by its nature: sin(x), pi. Its product with a voltage is a voltage */
    MEASURE_RATIO,
    MEASURE_KNOWN /* `dimension` */
} MeasureKind;

typedef struct Measure {
    MeasureKind kind;
    Dimension dimension;
    bool has_units;  /* its text has a unit; a value of variables alone may be meant in SI */
    bool has_time;   /* t is among its factors */
    bool is_literal; /* its unit was written, and is not the result of a product of several */
    bool is_cycles;  /* and that unit is Hz, which is no angular rate */
} Measure;

#endif
