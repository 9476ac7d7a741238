/* subsystem.h: definitions of subsystems, and their instances, as a model keeps them */
#ifndef COTREE_MODEL_SUBSYSTEM_H
#define COTREE_MODEL_SUBSYSTEM_H

#include <stdbool.h>

typedef struct Port {
    const char *name;
    bool is_frame;   /* else a terminal */
    bool is_through; /* the inside gives its motion or voltage: reached as leg1.B, never bound */
} Port;

typedef struct Subsystem {
    const char *name;
    const char *body; /* its statements, a line each */
    Port *ports;
    int port_count;
    const char **parameters; /* that `use` may give another value */
    int parameter_count;
    int size; /* statements of an instance, those of instances inside included */
} Subsystem;

typedef struct BlockEquations
    BlockEquations; /* of an instance that is given them (model_given.c) */

typedef struct Use { /* an instance of a subsystem */
    const char *name;
    const Subsystem *subsystem;
    const char **bound; /* by port: where it is attached outside; NULL: made inside, or not yet */
    int outer;          /* the use in which it was made; -1 */
    int line;
    BlockEquations *equations; /* NULL: it is made of parts */
    bool is_trial; /* of a definition that is being read: ports are bound where they are met */
} Use;

#endif
