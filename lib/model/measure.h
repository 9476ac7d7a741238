/* measure.h: what dimension a value has, as far as its text tells
 *
 * Literals with units, variables and functions have dimensions that are known, and sums,
 * products, powers and calls carry them on. A plain number is taken as SI: it may stand for a
 * quantity of any dimension, so nothing is known of its product with one. Two dimensions that
 * are known and differ can't be added or compared, and a value with a unit written in it can't
 * stand where another dimension is wanted (a key, an argument of sin). What isn't known passes;
 * what has no units may be meant in SI (force=-s, sin(s)), and a bare t in a sum, too (10 V + t);
 * beside units its seconds may be left out (30 deg*t). A quotient that has lost its dimension is a
 * number to a key, but not to a sum. All this is decided where a statement is applied, and costs
 * nothing later. */
#ifndef COTREE_MODEL_MEASURE_H
#define COTREE_MODEL_MEASURE_H

#include "expr/units.h"

#include <stdbool.h>

typedef enum MeasureKind {
    MEASURE_ANY,    /* can't be determined */
    MEASURE_NUMBER, /* a plain number: 9.81 may be an acceleration */
    MEASURE_RATIO,  /* a number by its nature: sin(x), pi. Times a voltage it is a voltage */
    MEASURE_KNOWN   /* `dimension` */
} MeasureKind;

typedef struct Measure {
    MeasureKind kind;
    Dimension dimension;
    bool has_units;  /* a unit was written for it; a value of variables alone may be meant in SI */
    bool has_time;   /* t is among its factors */
    bool is_literal; /* its unit is one that was written, not what a product makes of several */
    bool is_cycles;  /* and that one is Hz, which is no angular rate */
} Measure;

#endif
