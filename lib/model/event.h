/* event.h: events of a model: a condition, and the action when it becomes true */
#ifndef COTREE_MODEL_EVENT_H
#define COTREE_MODEL_EVENT_H

#include "expr/expr.h"

/* action when a condition becomes true */
typedef enum EventAction { EVENT_MARK, EVENT_STOP, EVENT_SET } EventAction;

typedef struct NewValue {
    const char *name; /* name of the variable, as in a Start */
    int primes;
    Expr value; /* over variables, t and parameters, evaluated just before the event */
} NewValue;

typedef struct Event {
    const char *name;
    Expr when;             /* a condition over variables, t and parameters */
    const char *condition; /* the same as written */
    EventAction action;
    int value_count;
    const NewValue *values; /* of EVENT_SET */
    const char *text;       /* its statement */
    bool is_bound;          /* not a user's event: it detects where the law of a part ends */
} Event;

#endif
