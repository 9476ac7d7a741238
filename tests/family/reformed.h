/* reformed.h: a model whose equations are formed after each edit, and from those before
 *
 * Then the statements that save it are typed into a new model, whose arena has seen nothing else
 * but the names of symbols, in the order of the first: they decide the order of terms. */
#ifndef COTREE_TESTS_REFORMED_H
#define COTREE_TESTS_REFORMED_H

#include "base/text.h"

#include <stdbool.h>

typedef struct Reformed Reformed;

Reformed *reformed_new(bool has_lifted); /* with lifted constants, as for a run */
void reformed_free(Reformed *reformed);

typedef enum Reform {
    REFORM_REFUSED, /* there are no equations of the model as it is */
    REFORM_SAME,    /* the program of all equations is that of the model typed anew, as text */
    REFORM_DIFFERS
} Reform;

/* applies statements, but those that are refused; appends what becomes of them to `story` */
Reform reformed_change(Reformed *reformed, const char *lines, Text *story);

#endif
