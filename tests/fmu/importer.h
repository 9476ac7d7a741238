/* importer.h: a Functional Mock-up Unit as a simulator meets it: one way in for both versions
 *
 * Reads the archive and its description, loads the binary, and calls it. Declared here from the
 * standard, not from what the exporter writes. */
#ifndef TESTS_FMU_IMPORTER_H
#define TESTS_FMU_IMPORTER_H

#include <stdbool.h>
#include <stddef.h>

enum { OK, WARNING, DISCARD, ERROR, FATAL }; /* as both versions number them */

typedef struct Variable {
    char name[200];
    unsigned reference;
    char causality[24], variability[24], initial[24];
    bool has_start;
    double start;
    int derivative; /* of version 2 a place from 1, of version 3 a reference; 0: none */
} Variable;

typedef struct Unit {
    char *path;
    int version;
    char token[100], identifier[100], model_name[200];
    bool has_exchange, has_simulation, has_derivatives;
    Variable *variables;
    int variable_count;
    int state_count, indicator_count;
    unsigned *states, *rates; /* references, in the order of the model's structure */
    unsigned *outputs;
    int output_count;
    unsigned *inputs, *parameters;
    int input_count, parameter_count;
    void *library;
    int messages; /* said so far of errors */
    char said[400];
} Unit;

/* Ends the test with a message where the archive isn't what the standard says. */
Unit *unit_open(const char *path);
void unit_close(Unit *unit);
const Variable *unit_variable(const Unit *unit, const char *name); /* NULL: there is none */

/* --- an instance --- */

typedef struct Instance {
    Unit *unit;
    void *handle;
} Instance;

typedef struct Discrete { /* what an event has brought */
    bool again, ends, moved, has_next;
    double next;
} Discrete;

Instance instance_new(Unit *unit, const char *name, bool is_simulation);
void instance_free(Instance *instance);
int instance_initialise(Instance *in, double tolerance, double start); /* enters the mode */
int instance_initialised(Instance *in);
int instance_terminate(Instance *in);
int instance_reset(Instance *in);
int instance_get(Instance *in, const unsigned *references, int count, double *values);
int instance_set(Instance *in, const unsigned *references, int count, const double *values);
int instance_enter_events(Instance *in);
int instance_update(Instance *in, Discrete *out);
int instance_enter_continuous(Instance *in);
int instance_step_done(Instance *in, bool *wants_events, bool *ends);
int instance_set_time(Instance *in, double t);
int instance_set_states(Instance *in, const double *x);
int instance_states(Instance *in, double *x);
int instance_rates(Instance *in, double *rates);
int instance_indicators(Instance *in, double *out);
/* *ends: the run is over, at *reached */
int instance_do_step(Instance *in, double t, double step, bool *ends, double *reached);
int instance_derivative(Instance *in, const unsigned *unknowns, int unknown_count,
                        const unsigned *knowns, int known_count, const double *seed, double *out);
int instance_keep(Instance *in, void **state);
int instance_go_back(Instance *in, void *state);
int instance_forget(Instance *in, void **state);
/* the state as bytes and back */
int instance_through_bytes(Instance *in, void **state);

#endif
