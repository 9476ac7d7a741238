/* fmi3.c: the Functional Mock-up Interface, version 3.0: model exchange and co-simulation
 *
 * Types and functions are those that the standard names (fmi-standard.org), declared here. There
 * are no clocks, arrays, inputs or variables but real ones. */
#include "fmu.h"

#include <stdbool.h>
#include <stdint.h>
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

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef const char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum {
    fmi3Independent,
    fmi3Constant,
    fmi3Fixed,
    fmi3Tunable,
    fmi3Discrete,
    fmi3Dependent
} fmi3DependencyKind;
typedef enum {
    fmi3IntervalNotYetKnown,
    fmi3IntervalUnchanged,
    fmi3IntervalChanged
} fmi3IntervalQualifier;
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);
typedef void (*fmi3IntermediateUpdateCallback)(fmi3InstanceEnvironment, fmi3Float64, fmi3Boolean,
                                               fmi3Boolean, fmi3Boolean, fmi3Boolean, fmi3Boolean *,
                                               fmi3Float64 *);
typedef void (*fmi3ClockUpdateCallback)(fmi3InstanceEnvironment);
typedef void (*fmi3LockPreemptionCallback)(void);
typedef void (*fmi3UnlockPreemptionCallback)(void);

enum {
    ANY = FMU_INSTANTIATED | FMU_INITIALISING | FMU_EVENTS | FMU_CONTINUOUS | FMU_STEPPING,
    ALWAYS = ANY | FMU_TERMINATED | FMU_FAILED,
    COMPUTED = FMU_INITIALISING | FMU_EVENTS | FMU_CONTINUOUS | FMU_TERMINATED | FMU_FAILED
};

void fmu_say(Fmu *fmu, FmuStatus status, const char *text)
{
    static const char *const categories[] = {"logEvents", "logStatusWarning", "logStatusDiscard",
                                             "logStatusError", "logStatusFatal"};

    if (fmu->logger != NULL && (status >= FMU_ERROR || fmu->is_logging))
        ((fmi3LogMessageCallback)fmu->logger)(fmu->environment, (fmi3Status)status,
                                              categories[status], text);
}

/* the instance, if the function may be called where it stands */
static Fmu *allowed(fmi3Instance instance, unsigned modes, const char *function)
{
    Fmu *fmu = instance;
    char line[100];

    if (fmu == NULL || ((unsigned)fmu->now.mode & modes) != 0)
        return fmu;
    (void)snprintf(line, sizeof line, "%.60s can't be called here", function);
    fmu_say(fmu, FMU_ERROR, line);
    return NULL;
}

#define TAKE(modes)                                                                                \
    Fmu *fmu = allowed(instance, modes, __func__);                                                 \
                                                                                                   \
    if (fmu == NULL)                                                                               \
    return fmi3Error
#define FAIL(text) return (fmi3Status)fmu_fail(fmu, FMU_ERROR, text, 0)
#define IS_SIZE(is, should)                                                                        \
    if ((is) != (size_t)(should))                                                                  \
    return (fmi3Status)fmu_fail(fmu, FMU_ERROR, "the arrays have another size", (double)(is))
/* a function of the interface: declared, then defined */
#define FUNCTION(name, arguments)                                                                  \
    EXPORTED fmi3Status name arguments;                                                            \
    fmi3Status name arguments

/* --- an instance --- */

EXPORTED const char *fmi3GetVersion(void);
const char *fmi3GetVersion(void)
{
    return "3.0";
}

static Fmu *instantiate(fmi3String name, fmi3String token, int may, int is_cosimulation,
                        fmi3Boolean loggingOn, void *environment, fmi3LogMessageCallback log)
{
    const int is_ours = token != NULL && strcmp(token, FMU_TOKEN) == 0;
    Fmu *fmu = name != NULL && is_ours && may ? calloc(1, sizeof *fmu) : NULL;

    if ((!is_ours || !may) && log != NULL)
        log(environment, fmi3Error, "logStatusError",
            is_ours ? "the file has no such kind of model"
                    : "the model description is not of this binary");
    if (fmu == NULL)
        return NULL;
    fmu->release = free;
    fmu->logger = (void (*)(void))log;
    fmu->environment = environment;
    fmu->is_logging = loggingOn;
    fmu->is_cosimulation = is_cosimulation;
    fmu_reset(fmu);
    return fmu;
}

EXPORTED fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token,
                                                   fmi3String resources, fmi3Boolean visible,
                                                   fmi3Boolean loggingOn,
                                                   fmi3InstanceEnvironment environment,
                                                   fmi3LogMessageCallback log);
fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log)
{
    (void)resources, (void)visible;
    return instantiate(name, token, FMU_MODEL_EXCHANGE, 0, loggingOn, environment, log);
}

EXPORTED fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean loggingOn, fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
    const fmi3ValueReference required[], size_t count, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update);
fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                         fmi3Boolean visible, fmi3Boolean loggingOn,
                                         fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference required[], size_t count,
                                         fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update)
{
    (void)resources, (void)visible, (void)eventModeUsed, (void)earlyReturnAllowed, (void)required;
    (void)count, (void)update;
    return instantiate(name, token, FMU_CO_SIMULATION, 1, loggingOn, environment, log);
}

EXPORTED fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean loggingOn, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock);
fmi3Instance
fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                  fmi3Boolean visible, fmi3Boolean loggingOn,
                                  fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                  fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                  fmi3UnlockPreemptionCallback unlock)
{
    (void)resources, (void)visible, (void)update, (void)lock, (void)unlock;
    return instantiate(name, token, 0, 0, loggingOn, environment, log);
}

EXPORTED void fmi3FreeInstance(fmi3Instance instance);
void fmi3FreeInstance(fmi3Instance instance)
{
    free(instance);
}

FUNCTION(fmi3SetDebugLogging,
         (fmi3Instance instance, fmi3Boolean on, size_t count, const fmi3String categories[]))
{
    TAKE(ALWAYS);
    (void)count, (void)categories;
    fmu->is_logging = on;
    return fmi3OK;
}

FUNCTION(fmi3EnterInitializationMode,
         (fmi3Instance instance, fmi3Boolean hasTolerance, fmi3Float64 tolerance, fmi3Float64 start,
          fmi3Boolean hasStop, fmi3Float64 stop))
{
    TAKE(FMU_INSTANTIATED);
    (void)hasStop, (void)stop;
    if (hasTolerance && tolerance > 0)
        fmu->now.tolerance = tolerance;
    fmu->now.start = fmu->now.t = start;
    fmu->now.mode = FMU_INITIALISING;
    return fmi3OK;
}

FUNCTION(fmi3ExitInitializationMode, (fmi3Instance instance))
{
    FmuStatus status;

    TAKE(FMU_INITIALISING);
    status = fmu_initialise(fmu);
    if (status == FMU_OK)
        fmu->now.mode = fmu->is_cosimulation ? FMU_STEPPING : FMU_EVENTS;
    return (fmi3Status)status;
}

FUNCTION(fmi3Terminate, (fmi3Instance instance))
{
    TAKE(FMU_EVENTS | FMU_CONTINUOUS | FMU_STEPPING);
    fmu->now.mode = FMU_TERMINATED;
    return fmi3OK;
}

FUNCTION(fmi3Reset, (fmi3Instance instance))
{
    TAKE(ALWAYS);
    fmu_reset(fmu);
    return fmi3OK;
}

/* no structural parameters, no clocks */
#define NEVER(name, arguments, unused)                                                             \
    FUNCTION(name, arguments)                                                                      \
    {                                                                                              \
        TAKE(ALWAYS);                                                                              \
        (void)unused;                                                                              \
        FAIL(#name " has nothing to do in this model");                                            \
    }
NEVER(fmi3EnterConfigurationMode, (fmi3Instance instance), 0)
NEVER(fmi3ExitConfigurationMode, (fmi3Instance instance), 0)
NEVER(fmi3EnterStepMode, (fmi3Instance instance), 0)
NEVER(fmi3ActivateModelPartition, (fmi3Instance instance, fmi3ValueReference clock, fmi3Float64 t),
      (clock + t))

/* --- variables --- */

FUNCTION(fmi3GetFloat64, (fmi3Instance instance, const fmi3ValueReference references[],
                          size_t count, fmi3Float64 values[], size_t valueCount))
{
    FmuStatus status = FMU_OK;
    size_t i;

    TAKE(ALWAYS);
    IS_SIZE(valueCount, count);
    for (i = 0; i < count && status == FMU_OK; i++)
        status = fmu_get(fmu, references[i], &values[i]);
    return (fmi3Status)status;
}

FUNCTION(fmi3SetFloat64, (fmi3Instance instance, const fmi3ValueReference references[],
                          size_t count, const fmi3Float64 values[], size_t valueCount))
{
    FmuStatus status = FMU_OK;
    size_t i;

    TAKE(FMU_INSTANTIATED | FMU_INITIALISING | FMU_EVENTS | FMU_STEPPING);
    IS_SIZE(valueCount, count);
    for (i = 0; i < count && status == FMU_OK; i++)
        status = fmu_set(fmu, references[i], values[i]);
    return (fmi3Status)status;
}

/* of these types there are no variables */
#define NONE_OF(type, constant, name)                                                              \
    FUNCTION(name, (fmi3Instance instance, const fmi3ValueReference references[], size_t count,    \
                    constant type values[], size_t valueCount))                                    \
    {                                                                                              \
        TAKE(ALWAYS);                                                                              \
        (void)references, (void)values, (void)valueCount;                                          \
        if (count > 0)                                                                             \
            FAIL("there are no variables of that type");                                           \
        return fmi3OK;                                                                             \
    }
NONE_OF(fmi3Float32, , fmi3GetFloat32)
NONE_OF(fmi3Int8, , fmi3GetInt8)
NONE_OF(fmi3UInt8, , fmi3GetUInt8)
NONE_OF(fmi3Int16, , fmi3GetInt16)
NONE_OF(fmi3UInt16, , fmi3GetUInt16)
NONE_OF(fmi3Int32, , fmi3GetInt32)
NONE_OF(fmi3UInt32, , fmi3GetUInt32)
NONE_OF(fmi3Int64, , fmi3GetInt64)
NONE_OF(fmi3UInt64, , fmi3GetUInt64)
NONE_OF(fmi3Boolean, , fmi3GetBoolean)
NONE_OF(fmi3String, , fmi3GetString)
NONE_OF(fmi3Float32, const, fmi3SetFloat32)
NONE_OF(fmi3Int8, const, fmi3SetInt8)
NONE_OF(fmi3UInt8, const, fmi3SetUInt8)
NONE_OF(fmi3Int16, const, fmi3SetInt16)
NONE_OF(fmi3UInt16, const, fmi3SetUInt16)
NONE_OF(fmi3Int32, const, fmi3SetInt32)
NONE_OF(fmi3UInt32, const, fmi3SetUInt32)
NONE_OF(fmi3Int64, const, fmi3SetInt64)
NONE_OF(fmi3UInt64, const, fmi3SetUInt64)
NONE_OF(fmi3Boolean, const, fmi3SetBoolean)
NONE_OF(fmi3String, const, fmi3SetString)

FUNCTION(fmi3GetBinary, (fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                         size_t sizes[], fmi3Binary values[], size_t valueCount))
{
    TAKE(ALWAYS);
    (void)references, (void)sizes, (void)values, (void)valueCount;
    if (count > 0)
        FAIL("there are no variables of that type");
    return fmi3OK;
}

FUNCTION(fmi3SetBinary, (fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                         const size_t sizes[], const fmi3Binary values[], size_t valueCount))
{
    TAKE(ALWAYS);
    (void)references, (void)sizes, (void)values, (void)valueCount;
    if (count > 0)
        FAIL("there are no variables of that type");
    return fmi3OK;
}

#define NO_CLOCKS(name, arguments, unused)                                                         \
    FUNCTION(name, arguments)                                                                      \
    {                                                                                              \
        TAKE(ALWAYS);                                                                              \
        (void)references, unused;                                                                  \
        if (count > 0)                                                                             \
            FAIL("there are no clocks");                                                           \
        return fmi3OK;                                                                             \
    }
#define CLOCKS fmi3Instance instance, const fmi3ValueReference references[], size_t count
NO_CLOCKS(fmi3GetClock, (CLOCKS, fmi3Clock values[]), (void)values)
NO_CLOCKS(fmi3SetClock, (CLOCKS, const fmi3Clock values[]), (void)values)
NO_CLOCKS(fmi3GetIntervalDecimal,
          (CLOCKS, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[]),
          ((void)intervals, (void)qualifiers))
NO_CLOCKS(fmi3GetIntervalFraction,
          (CLOCKS, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
           fmi3IntervalQualifier qualifiers[]),
          ((void)counters, (void)resolutions, (void)qualifiers))
NO_CLOCKS(fmi3GetShiftDecimal, (CLOCKS, fmi3Float64 shifts[]), (void)shifts)
NO_CLOCKS(fmi3GetShiftFraction, (CLOCKS, fmi3UInt64 counters[], fmi3UInt64 resolutions[]),
          ((void)counters, (void)resolutions))
NO_CLOCKS(fmi3SetIntervalDecimal, (CLOCKS, const fmi3Float64 intervals[]), (void)intervals)
NO_CLOCKS(fmi3SetIntervalFraction,
          (CLOCKS, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]),
          ((void)counters, (void)resolutions))
NO_CLOCKS(fmi3SetShiftDecimal, (CLOCKS, const fmi3Float64 shifts[]), (void)shifts)
NO_CLOCKS(fmi3SetShiftFraction,
          (CLOCKS, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]),
          ((void)counters, (void)resolutions))

/* dependencies don't change: the description has them */
FUNCTION(fmi3GetNumberOfVariableDependencies,
         (fmi3Instance instance, fmi3ValueReference dependent, size_t *count))
{
    TAKE(ALWAYS);
    (void)dependent, (void)count;
    FAIL("dependencies are those of the description");
}

FUNCTION(fmi3GetVariableDependencies,
         (fmi3Instance instance, fmi3ValueReference dependent, size_t elements[],
          fmi3ValueReference independents[], size_t independentElements[],
          fmi3DependencyKind kinds[], size_t count))
{
    TAKE(ALWAYS);
    (void)dependent, (void)elements, (void)independents, (void)independentElements, (void)kinds;
    (void)count;
    FAIL("dependencies are those of the description");
}

FUNCTION(fmi3GetDirectionalDerivative,
         (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t unknownCount,
          const fmi3ValueReference knowns[], size_t knownCount, const fmi3Float64 seed[],
          size_t seedCount, fmi3Float64 sensitivity[], size_t sensitivityCount))
{
    TAKE(FMU_INITIALISING | FMU_EVENTS | FMU_CONTINUOUS | FMU_STEPPING | FMU_TERMINATED |
         FMU_FAILED);
    IS_SIZE(seedCount, knownCount);
    IS_SIZE(sensitivityCount, unknownCount);
    return (fmi3Status)fmu_derivatives(fmu, unknowns, unknownCount, knowns, knownCount, seed,
                                       sensitivity);
}

FUNCTION(fmi3GetAdjointDerivative,
         (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t unknownCount,
          const fmi3ValueReference knowns[], size_t knownCount, const fmi3Float64 seed[],
          size_t seedCount, fmi3Float64 sensitivity[], size_t sensitivityCount))
{
    TAKE(ALWAYS);
    (void)unknowns, (void)unknownCount, (void)knowns, (void)knownCount, (void)seed;
    (void)seedCount, (void)sensitivity, (void)sensitivityCount;
    FAIL("derivatives are along directions alone");
}

/* --- the whole state --- */

static FmuStatus copy_state(Fmu *fmu, fmi3FMUState *state, const void *from)
{
    if (*state == NULL)
        *state = malloc(sizeof(FmuNumbers));
    if (*state == NULL)
        return fmu_fail(fmu, FMU_ERROR, "there is no memory for a state", 0);
    memcpy(*state, from, sizeof(FmuNumbers));
    return FMU_OK;
}

FUNCTION(fmi3GetFMUState, (fmi3Instance instance, fmi3FMUState *state))
{
    TAKE(ALWAYS);
    return (fmi3Status)copy_state(fmu, state, &fmu->now);
}

FUNCTION(fmi3SetFMUState, (fmi3Instance instance, fmi3FMUState state))
{
    TAKE(ALWAYS);
    if (state == NULL)
        FAIL("there is no state");
    memcpy(&fmu->now, state, sizeof(FmuNumbers));
    return fmi3OK;
}

FUNCTION(fmi3FreeFMUState, (fmi3Instance instance, fmi3FMUState *state))
{
    TAKE(ALWAYS);
    (void)fmu;
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

FUNCTION(fmi3SerializedFMUStateSize, (fmi3Instance instance, fmi3FMUState state, size_t *size))
{
    TAKE(ALWAYS);
    (void)fmu, (void)state;
    *size = sizeof(FmuNumbers);
    return fmi3OK;
}

FUNCTION(fmi3SerializeFMUState,
         (fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size))
{
    TAKE(ALWAYS);
    if (state == NULL || size < sizeof(FmuNumbers))
        FAIL("a state has other bytes");
    memcpy(bytes, state, sizeof(FmuNumbers));
    return fmi3OK;
}

FUNCTION(fmi3DeserializeFMUState,
         (fmi3Instance instance, const fmi3Byte bytes[], size_t size, fmi3FMUState *state))
{
    TAKE(ALWAYS);
    IS_SIZE(size, sizeof(FmuNumbers));
    return (fmi3Status)copy_state(fmu, state, bytes);
}

/* --- model exchange --- */

FUNCTION(fmi3EnterEventMode, (fmi3Instance instance))
{
    TAKE(FMU_CONTINUOUS | FMU_EVENTS);
    fmu->now.mode = FMU_EVENTS;
    return fmi3OK;
}

FUNCTION(fmi3EvaluateDiscreteStates, (fmi3Instance instance))
{
    TAKE(FMU_INITIALISING | FMU_EVENTS);
    (void)fmu;
    return fmi3OK;
}

FUNCTION(fmi3UpdateDiscreteStates,
         (fmi3Instance instance, fmi3Boolean *again, fmi3Boolean *terminate,
          fmi3Boolean *nominalsChanged, fmi3Boolean *valuesChanged, fmi3Boolean *hasNext,
          fmi3Float64 *next))
{
    int moved = 0;
    FmuStatus status;

    TAKE(FMU_EVENTS);
    status = fmu_events(fmu, &moved);
    *again = *nominalsChanged = false;
    *valuesChanged = moved != 0;
    *terminate = fmu->now.is_stopped != 0;
    *hasNext = fmu->now.next < HUGE_VAL;
    *next = *hasNext ? fmu->now.next : 0;
    return (fmi3Status)status;
}

FUNCTION(fmi3EnterContinuousTimeMode, (fmi3Instance instance))
{
    TAKE(FMU_EVENTS);
    fmu->now.mode = FMU_CONTINUOUS;
    return fmi3OK;
}

FUNCTION(fmi3CompletedIntegratorStep, (fmi3Instance instance, fmi3Boolean noSetPrior,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminate))
{
    TAKE(FMU_CONTINUOUS);
    (void)noSetPrior;
    *enterEventMode = fmu_has_drifted(fmu) != 0;
    *terminate = false;
    return fmi3OK;
}

FUNCTION(fmi3SetTime, (fmi3Instance instance, fmi3Float64 t))
{
    TAKE(FMU_EVENTS | FMU_CONTINUOUS);
    fmu_set_time(fmu, t);
    return fmi3OK;
}

FUNCTION(fmi3SetContinuousStates, (fmi3Instance instance, const fmi3Float64 x[], size_t count))
{
    TAKE(FMU_CONTINUOUS | FMU_EVENTS);
    IS_SIZE(count, FMU_STATES);
    fmu_set_states(fmu, x);
    return fmi3OK;
}

FUNCTION(fmi3GetContinuousStateDerivatives,
         (fmi3Instance instance, fmi3Float64 rates[], size_t count))
{
    TAKE(COMPUTED);
    IS_SIZE(count, FMU_STATES);
    return (fmi3Status)fmu_rates(fmu, rates);
}

FUNCTION(fmi3GetEventIndicators, (fmi3Instance instance, fmi3Float64 indicators[], size_t count))
{
    TAKE(COMPUTED);
    IS_SIZE(count, FMU_INDICATORS);
    return (fmi3Status)fmu_indicators(fmu, indicators);
}

FUNCTION(fmi3GetContinuousStates, (fmi3Instance instance, fmi3Float64 x[], size_t count))
{
    TAKE(COMPUTED);
    IS_SIZE(count, FMU_STATES);
    memcpy(x, fmu->now.y, FMU_STATES * sizeof(double));
    return fmi3OK;
}

FUNCTION(fmi3GetNominalsOfContinuousStates,
         (fmi3Instance instance, fmi3Float64 nominals[], size_t count))
{
    size_t i;

    TAKE(ALWAYS);
    IS_SIZE(count, FMU_STATES);
    for (i = 0; i < count; i++)
        nominals[i] = 1;
    return fmi3OK;
}

FUNCTION(fmi3GetNumberOfEventIndicators, (fmi3Instance instance, size_t *count))
{
    TAKE(ALWAYS);
    (void)fmu;
    *count = FMU_INDICATORS;
    return fmi3OK;
}

FUNCTION(fmi3GetNumberOfContinuousStates, (fmi3Instance instance, size_t *count))
{
    TAKE(ALWAYS);
    (void)fmu;
    *count = FMU_STATES;
    return fmi3OK;
}

/* --- co-simulation --- */

FUNCTION(fmi3GetOutputDerivatives,
         (fmi3Instance instance, const fmi3ValueReference references[], size_t count,
          const fmi3Int32 orders[], fmi3Float64 values[], size_t valueCount))
{
    TAKE(FMU_STEPPING | FMU_TERMINATED | FMU_FAILED);
    IS_SIZE(valueCount, count);
    return (fmi3Status)fmu_output_rates(fmu, references, count, orders, values);
}

FUNCTION(fmi3DoStep,
         (fmi3Instance instance, fmi3Float64 from, fmi3Float64 step, fmi3Boolean noSetPrior,
          fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminate, fmi3Boolean *earlyReturn,
          fmi3Float64 *lastSuccessfulTime))
{
    FmuStatus status;

    TAKE(FMU_STEPPING);
    (void)noSetPrior;
    status = fmu_do_step(fmu, from, step);
    *eventHandlingNeeded = false;
    *earlyReturn = *terminate = fmu->now.is_stopped != 0;
    *lastSuccessfulTime = fmu->now.t;
    return (fmi3Status)status;
}
