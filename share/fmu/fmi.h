/* fmi.h: common part of the interface's two versions
 *
 * A version (fmi2.c, fmi3.c) declares its types and defines FmiInstance and so on as names for
 * them, and FMI(), FMI_STATE() and FMI_... for its function names. It implements the output of
 * messages (fmu_log), the creation of an instance, and functions that only it has. */
#ifndef FMI_H
#define FMI_H

#include "fmu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined _WIN32
#define EXPORTED __declspec(dllexport)
#elif defined __GNUC__
#define EXPORTED __attribute__((visibility("default")))
#else
#define EXPORTED
#endif

enum {
    ANY = FMU_INSTANTIATED | FMU_INITIALISING | FMU_EVENTS | FMU_CONTINUOUS | FMU_STEPPING,
    ALWAYS = ANY | FMU_TERMINATED | FMU_FAILED,
    COMPUTED = FMU_INITIALISING | FMU_EVENTS | FMU_CONTINUOUS | FMU_TERMINATED | FMU_FAILED
};

/* of messages, by their status */
static const char *const categories[] = {"logEvents", "logStatusWarning", "logStatusDiscard",
                                         "logStatusError", "logStatusFatal"};

/* the instance, if the function may be called in its present state */
static Fmu *allowed(FmiInstance instance, unsigned modes, const char *function)
{
    Fmu *fmu = (Fmu *)instance;
    char line[100];

    if (fmu == NULL || ((unsigned)fmu->now.mode & modes) != 0)
        return fmu;
    (void)snprintf(line, sizeof line, "%.60s can't be called here", function);
    fmu_log(fmu, FMU_ERROR, line);
    return NULL;
}

#define TAKE(modes)                                                                                \
    Fmu *fmu = allowed(instance, modes, __func__);                                                 \
                                                                                                   \
    if (fmu == NULL)                                                                               \
    return FMI(Error)
#define FAIL(text) return (FmiStatus)fmu_fail(fmu, FMU_ERROR, text, 0)
#define IS_SIZE(is, should)                                                                        \
    if ((is) != (size_t)(should))                                                                  \
    return (FmiStatus)fmu_fail(fmu, FMU_ERROR, "the arrays have another size", (double)(is))
/* a function of the interface: declared, then defined */
#define FUNCTION(name, arguments)                                                                  \
    EXPORTED FmiStatus name arguments;                                                             \
    FmiStatus name arguments

/* --- an instance --- */

FUNCTION(FMI(SetDebugLogging),
         (FmiInstance instance, FmiBoolean on, size_t count, const FmiString chosen[]))
{
    TAKE(ALWAYS);
    (void)count, (void)chosen;
    fmu->is_logging = on;
    return FMI(OK);
}

FUNCTION(FMI(ExitInitializationMode), (FmiInstance instance))
{
    FmuStatus status;

    TAKE(FMU_INITIALISING);
    status = fmu_initialise(fmu);
    if (status == FMU_OK)
        fmu->now.mode = fmu->is_cosimulation ? FMU_STEPPING : FMU_EVENTS;
    return (FmiStatus)status;
}

FUNCTION(FMI(Terminate), (FmiInstance instance))
{
    TAKE(FMU_EVENTS | FMU_CONTINUOUS | FMU_STEPPING);
    fmu->now.mode = FMU_TERMINATED;
    return FMI(OK);
}

FUNCTION(FMI(Reset), (FmiInstance instance))
{
    TAKE(ALWAYS);
    fmu_reset(fmu);
    return FMI(OK);
}

/* start time of the importer's experiment */
static void begin_at(Fmu *fmu, FmiBoolean hasTolerance, double tolerance, double start)
{
    if (hasTolerance && tolerance > 0)
        fmu->now.tolerance = tolerance;
    fmu->now.start = fmu->now.t = start;
}

/* --- variables --- */

static FmiStatus get_all(Fmu *fmu, const FmiReference references[], size_t count, double values[])
{
    FmuStatus status = FMU_OK;
    int looks = 0;
    size_t i;

    for (i = 0; i < count && status == FMU_OK; i++) {
        if (!looks && references[i] >= FMU_FIRST_STATE)
            status = fmu_look_behind(fmu, &looks);
        if (status == FMU_OK)
            status = fmu_get(fmu, references[i], &values[i]);
    }
    fmu_look_back(fmu, looks);
    return (FmiStatus)status;
}

static FmiStatus set_all(Fmu *fmu, const FmiReference references[], size_t count,
                         const double values[])
{
    FmuStatus status = FMU_OK;
    size_t i;

    for (i = 0; i < count && status == FMU_OK; i++)
        status = fmu_set(fmu, references[i], values[i]);
    return (FmiStatus)status;
}

/* --- the whole state --- */

static FmiStatus copy_state(Fmu *fmu, FmiState *state, const void *from)
{
    if (*state == NULL)
        *state = malloc(sizeof(FmuNumbers));
    if (*state == NULL)
        FAIL("there is no memory for a state");
    memcpy(*state, from, sizeof(FmuNumbers));
    return FMI(OK);
}

FUNCTION(FMI_STATE(Get, ), (FmiInstance instance, FmiState *state))
{
    TAKE(ALWAYS);
    return copy_state(fmu, state, &fmu->now);
}

FUNCTION(FMI_STATE(Set, ), (FmiInstance instance, FmiState state))
{
    TAKE(ALWAYS);
    if (state == NULL)
        FAIL("there is no state");
    memcpy(&fmu->now, state, sizeof(FmuNumbers));
    return FMI(OK);
}

FUNCTION(FMI_STATE(Free, ), (FmiInstance instance, FmiState *state))
{
    TAKE(ALWAYS);
    (void)fmu;
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return FMI(OK);
}

FUNCTION(FMI_STATE(Serialized, Size), (FmiInstance instance, FmiState state, size_t *size))
{
    TAKE(ALWAYS);
    (void)fmu, (void)state;
    *size = sizeof(FmuNumbers);
    return FMI(OK);
}

FUNCTION(FMI_STATE(Serialize, ),
         (FmiInstance instance, FmiState state, FmiByte bytes[], size_t size))
{
    TAKE(ALWAYS);
    if (state == NULL || size < sizeof(FmuNumbers))
        FAIL("a state has other bytes");
    memcpy(bytes, state, sizeof(FmuNumbers));
    return FMI(OK);
}

FUNCTION(FMI_READ_STATE,
         (FmiInstance instance, const FmiByte bytes[], size_t size, FmiState *state))
{
    TAKE(ALWAYS);
    IS_SIZE(size, sizeof(FmuNumbers));
    return copy_state(fmu, state, bytes);
}

/* --- model exchange --- */

FUNCTION(FMI(EnterEventMode), (FmiInstance instance))
{
    TAKE(FMU_CONTINUOUS | FMU_EVENTS);
    fmu->now.mode = FMU_EVENTS;
    return FMI(OK);
}

FUNCTION(FMI(EnterContinuousTimeMode), (FmiInstance instance))
{
    TAKE(FMU_EVENTS);
    fmu->now.mode = FMU_CONTINUOUS;
    return FMI(OK);
}

FUNCTION(FMI(CompletedIntegratorStep), (FmiInstance instance, FmiBoolean noSetPrior,
                                        FmiBoolean *enterEventMode, FmiBoolean *terminate))
{
    TAKE(FMU_CONTINUOUS);
    (void)noSetPrior;
    *enterEventMode = fmu_has_drifted(fmu) != 0;
    *terminate = 0;
    return FMI(OK);
}

FUNCTION(FMI(SetTime), (FmiInstance instance, double t))
{
    TAKE(FMU_EVENTS | FMU_CONTINUOUS);
    fmu_set_time(fmu, t);
    return FMI(OK);
}

FUNCTION(FMI(SetContinuousStates), (FmiInstance instance, const double x[], size_t count))
{
    TAKE(FMU_CONTINUOUS | FMU_EVENTS);
    IS_SIZE(count, FMU_CONTINUOUS_STATES);
    fmu_set_continuous(fmu, x);
    return FMI(OK);
}

FUNCTION(FMI_RATES, (FmiInstance instance, double rates[], size_t count))
{
    TAKE(COMPUTED);
    IS_SIZE(count, FMU_CONTINUOUS_STATES);
    return (FmiStatus)fmu_continuous_rates(fmu, rates);
}

FUNCTION(FMI(GetEventIndicators), (FmiInstance instance, double indicators[], size_t count))
{
    TAKE(COMPUTED);
    IS_SIZE(count, FMU_INDICATORS);
    return (FmiStatus)fmu_indicators(fmu, indicators);
}

FUNCTION(FMI(GetContinuousStates), (FmiInstance instance, double x[], size_t count))
{
    TAKE(COMPUTED);
    IS_SIZE(count, FMU_CONTINUOUS_STATES);
    fmu_continuous(fmu, x);
    return FMI(OK);
}

FUNCTION(FMI(GetNominalsOfContinuousStates),
         (FmiInstance instance, double nominals[], size_t count))
{
    size_t i;

    TAKE(ALWAYS);
    IS_SIZE(count, FMU_CONTINUOUS_STATES);
    for (i = 0; i < count; i++)
        nominals[i] = 1;
    return FMI(OK);
}

#endif
