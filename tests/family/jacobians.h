/* jacobians.h: derivatives of a script's mechanism, told beside differences */
#ifndef COTREE_TESTS_JACOBIANS_H
#define COTREE_TESTS_JACOBIANS_H

#include <stdint.h>

typedef struct JacobianTrial {
    const char *text;   /* statements, `simulate` the last */
    const char *method; /* of the run */
    double at;          /* s, an instant of it */
    uint64_t random;    /* by which the state is off there */
    double worst;       /* entry, in what differences leave open; NAN: there is no derivative */
    double implicit;    /* the same of its implicit equations, by all unknowns and their rates */
    char reason[1300];  /* of NAN */
} JacobianTrial;

/* Run it, and compare all entries near its state at that instant. */
void jacobian_try(JacobianTrial *trial);

#endif
