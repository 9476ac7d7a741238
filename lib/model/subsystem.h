/* subsystem.h: definitions of subsystems, and their instances, as a model stores them */
#ifndef COTREE_MODEL_SUBSYSTEM_H
#define COTREE_MODEL_SUBSYSTEM_H

#include "language/syntax.h"

typedef struct Port {
    const char *name;
    bool is_frame;   /* otherwise a terminal */
    bool is_through; /* the inside determines its motion or voltage: named as leg1.B, never bound */
} Port;

typedef struct Subsystem {
    const char *name;
    Body body;
    Port *ports;
    int port_count;
    const char **parameters; /* those that `use` may set */
    int parameter_count;
    int size; /* number of statements of an instance, including those of instances inside */
} Subsystem;

typedef struct BlockEquations
    BlockEquations; /* for an instance with given equations (model_given.c) */

typedef struct Use { /* an instance of a subsystem */
    const char *name;
    const Subsystem *subsystem;
    /* by port: what it is attached to outside; NULL: made inside, or not yet bound */
    const char **bound;
    int outer; /* the use in which it was made; -1 */
    int line;
    BlockEquations *equations; /* NULL: it is made of parts */
    bool is_trial; /* for a definition that is being read: ports are bound where they occur */
} Use;

#endif
