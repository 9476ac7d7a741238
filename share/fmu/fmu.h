/* fmu.h: an instance of a model that handles events by itself
 *
 * The common part of both versions of the interface (fmi2.c, fmi3.c). All variable data is in one
 * struct without pointers, FmuNumbers: so a saved state is a copy of it, and instances are
 * independent. */
#ifndef FMU_H
#define FMU_H

#include "model_fmu.h"
#ifdef FMU_HAS_SLIDES
#include "surface_sides.h"
#endif

#include <stddef.h>

/* what functions return, as both versions number it */
typedef enum FmuStatus { FMU_OK, FMU_WARNING, FMU_DISCARD, FMU_ERROR, FMU_FATAL } FmuStatus;

/* the permitted calls depend on the state of the instance */
typedef enum FmuMode {
    FMU_INSTANTIATED = 1,
    FMU_INITIALISING = 2,
    FMU_EVENTS = 4,
    FMU_CONTINUOUS = 8,
    FMU_STEPPING = 16, /* of co-simulation */
    FMU_TERMINATED = 32,
    FMU_FAILED = 64
} FmuMode;

enum {                                           /* numbers in each array */
       FMU_STATES = MODEL_Q + MODEL_U + MODEL_X, /* with inputs, whose rates are 0 */
       FMU_CONTINUOUS_STATES = FMU_STATES - FMU_INPUTS,
       /* (dt, dy, ds, dp, dsigns), after s */
       FMU_SEEDS = 1 + MODEL_Y + MODEL_S + FMU_PARAMETERS + FMU_SLIDES,
       FMU_MEASURES = FMU_SIDES + FMU_SWITCHES, /* of what is jumped at, then margins of diodes */
       FMU_INDICATORS = FMU_MEASURES - FMU_TIMED,
       /* value references: time, then */
       FMU_FIRST_PARAMETER = 1,
       FMU_FIRST_STATE = FMU_FIRST_PARAMETER + FMU_PARAMETERS,
       FMU_FIRST_RATE = FMU_FIRST_STATE + FMU_STATES,
       FMU_FIRST_OUTPUT = FMU_FIRST_RATE + FMU_STATES,
       FMU_FIRST_INDICATOR = FMU_FIRST_OUTPUT + MODEL_OUTPUTS,
       FMU_VARIABLES = FMU_FIRST_INDICATOR + FMU_INDICATORS
};

typedef struct FmuNumbers {
    int mode, instant; /* state of the instance; number of sampling instants so far */
    int has_start;     /* events have been looked at */
    int is_solved;     /* s belongs to t and y */
    int is_changed;    /* parameters or states were set since events were looked at last */
    int is_stopped;    /* an event ends the run */
    double t, start;
    double next;    /* event of time; HUGE_VAL: none */
    double step;    /* of the integrator; 0: not known */
    double rhythm;  /* s: over which what follows time bends little; 0: not known */
    double sampled; /* time of the last samples */
    double tolerance;
    double p[MODEL_P + 1];
    double y[MODEL_Y + 1];
    double s[MODEL_S + FMU_SEEDS + 1];
    /* of what is jumped at: -1 or 1, 0 while the motion slides along it; open or closed */
    int side[FMU_MEASURES + 1];
    /* of what may be slid along: the sign, its bound; it is on a side, but kept on the surface by
     * others */
    double sign[FMU_SLIDES + 1], bound[FMU_SLIDES + 1];
    int held[FMU_SLIDES + 1];
    /* inverse of d slip/d sign of what is slid along: 0: not known, 1: of a state before, 2: here
     */
    double slopes[FMU_SLIDES * FMU_SLIDES + 1];
    int has_slopes;
    double error_floor[FMU_SWITCHES + 1]; /* of a margin that has ended without effect */
    int holds[FMU_EVENTS_COUNT + 1];      /* which events' conditions do */
} FmuNumbers;

typedef struct Fmu {
    FmuNumbers now;
    FmuNumbers kept; /* of fmu_look_behind() */
    int is_cosimulation, is_logging;
    int may_return_early;           /* from a step that an event ends, in version 3 */
    int has_no_state;               /* an error has left no valid state */
    int has_new_values;             /* an event has set some, at this instant */
    int is_decided[FMU_SLIDES + 1]; /* at this instant, as long as nothing else changes */
    char *name;
    void (*logger)(void); /* of the version's type, called by fmu_log() */
    void *environment;
    void (*release)(void *);
    double work[3 * MODEL_WORK + 16 * (MODEL_Y + MODEL_S + FMU_MEASURES + FMU_TARGETS + 4) +
                FMU_PARAMETERS + 3 * FMU_SLIDES];
    double space[FMU_SPACE]; /* of the integrator, and of new values */
} Fmu;

/* a message to the importer's logger; in the version's file */
void fmu_log(Fmu *fmu, FmuStatus status, const char *text);
/* The same with a number at its end; returns the status. */
FmuStatus fmu_fail(Fmu *fmu, FmuStatus status, const char *text, double value);

/* as it was when the file was made */
void fmu_reset(Fmu *fmu);
FmuStatus fmu_initialise(Fmu *fmu);

/* --- variables --- */

/* Values set between two steps of co-simulation may cause an event, which occurs at the start of
 * the next step. From this call until fmu_look_back() all values are those after that event.
 * *looks: whether this is so; false if the event fails. */
FmuStatus fmu_look_behind(Fmu *fmu, int *looks);
void fmu_look_back(Fmu *fmu, int looks);
FmuStatus fmu_get(Fmu *fmu, unsigned reference, double *value);
FmuStatus fmu_set(Fmu *fmu, unsigned reference, double value);
void fmu_set_time(Fmu *fmu, double t);
void fmu_set_states(Fmu *fmu, const double *y);
FmuStatus fmu_rates(Fmu *fmu, double *rates);
/* the same of those that are no inputs, which an importer has */
void fmu_set_continuous(Fmu *fmu, const double *x);
void fmu_continuous(const Fmu *fmu, double *x);
FmuStatus fmu_continuous_rates(Fmu *fmu, double *rates);
FmuStatus fmu_indicators(Fmu *fmu, double *out);
/* derivative of s along a direction in time and states, stored after s */
FmuStatus fmu_direction(Fmu *fmu, double dt, const double *dy);
/* of unknowns by knowns, times the seed of each of these */
FmuStatus fmu_derivatives(Fmu *fmu, const unsigned *unknowns, size_t unknown_count,
                          const unsigned *knowns, size_t known_count, const double *seed,
                          double *out);

/* Directions that the equations don't determine are shared out by a rule, to the least or to equal
 * values. Outputs that depend on them have no derivatives: NAN in `outputs`, by their numbers, and
 * a warning (fmu_open.c). */
FmuStatus fmu_mark_open(Fmu *fmu, const unsigned *unknowns, size_t count, double *outputs);

/* --- events --- */

/* Execute the events at this instant; *moved: states have changed. Sets the time of the next
 * event. */
FmuStatus fmu_events(Fmu *fmu, int *moved);
/* Set new values of the chosen targets, positions first; after these the speeds have to meet the
 * constraints too. Fails if the constraints aren't met or leave other values undetermined
 * (fmu_values.c). */
FmuStatus fmu_set_values(Fmu *fmu, const int *chosen, const double *values);
/* angles in the turn that is nearest to where they were */
void fmu_set_references(Fmu *fmu);
double fmu_larger(double a, double b);
/* After a step of the importer: whether states violate the constraints by more than the
 * tolerance. */
int fmu_has_drifted(Fmu *fmu);
/* states onto the constraints */
FmuStatus fmu_restore(Fmu *fmu);

/* Brings the next event near enough for what time moves; `is_new`: that may be other than it was
 * (fmu_ahead.c). */
void fmu_look_ahead(Fmu *fmu, int is_new);

/* the sign of indicator i while nothing happens */
int fmu_sense(const FmuNumbers *now, int i);
/* derivatives of indicators along the direction of the last fmu_direction() */
void fmu_indicator_rates(Fmu *fmu, double *rates);
/* after parameters or signs have changed */
void fmu_prepare(Fmu *fmu);

/* --- surfaces that the motion slides along, as of what sticks (fmu_slide.c) --- */

#ifdef FMU_HAS_SLIDES
int fmu_slides(const FmuNumbers *now); /* how many it slides along */
/* signs and s at the time and state of now; as model_solve() */
int fmu_slide_solve(Fmu *fmu);
/* After seeds are set and model_tangent(): signs move, too. As model_tangent(). */
int fmu_slide_direction(Fmu *fmu);
/* Sides after this instant, by measures and their rates: what is met, what ends. `close`: times
 * that can't be distinguished */
FmuStatus fmu_slide_sides(Fmu *fmu, const double *at, const double *rate, double close,
                          int *changes, int *moved);
/* how far the state is off what is slid along; onto that */
double fmu_slide_drift(Fmu *fmu);
FmuStatus fmu_slide_project(Fmu *fmu, int *moved);
#endif

/* --- co-simulation (fmu_step.c) --- */

/* From now on to `end`; where an event stops the run it ends there. */
FmuStatus fmu_advance(Fmu *fmu, double end);
/* The same for an importer's step, which starts where the last one ended. */
FmuStatus fmu_do_step(Fmu *fmu, double from, double step);
/* first derivatives of outputs by time */
FmuStatus fmu_output_rates(Fmu *fmu, const unsigned *references, size_t count, const int *orders,
                           double *values);

#endif
