/* fmi3.c: the Functional Mock-up Interface, version 3.0: model exchange and co-simulation
 *
 * Types and functions are those that the standard names (fmi-standard.org), declared here. There
 * are no clocks, arrays or variables but real ones. */
#include <stddef.h>

#include <stdbool.h>
#include <stdint.h>

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

#define FMI(name)             fmi3##name
#define FMI_STATE(verb, what) fmi3##verb##FMUState##what
#define FMI_READ_STATE        fmi3DeserializeFMUState
#define FMI_RATES             fmi3GetContinuousStateDerivatives
typedef fmi3Instance FmiInstance;
typedef fmi3Boolean FmiBoolean;
typedef fmi3String FmiString;
typedef fmi3FMUState FmiState;
typedef fmi3Byte FmiByte;
typedef fmi3ValueReference FmiReference;
typedef fmi3Status FmiStatus;
#include "fmi.h"

void fmu_log(Fmu *fmu, FmuStatus status, const char *text)
{
    if (fmu->logger != NULL && (status >= FMU_ERROR || fmu->is_logging))
        ((fmi3LogMessageCallback)fmu->logger)(fmu->environment, (fmi3Status)status,
                                              categories[status], text);
}

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
    Fmu *fmu = instantiate(name, token, FMU_CO_SIMULATION, 1, loggingOn, environment, log);

    (void)resources, (void)visible, (void)eventModeUsed, (void)required;
    (void)count, (void)update;
    if (fmu != NULL)
        fmu->may_return_early = earlyReturnAllowed;
    return fmu;
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

FUNCTION(fmi3EnterInitializationMode,
         (fmi3Instance instance, fmi3Boolean hasTolerance, fmi3Float64 tolerance, fmi3Float64 start,
          fmi3Boolean hasStop, fmi3Float64 stop))
{
    TAKE(FMU_INSTANTIATED);
    (void)hasStop, (void)stop;
    begin_at(fmu, hasTolerance, tolerance, start);
    fmu->now.mode = FMU_INITIALISING;
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
    TAKE(ALWAYS);
    IS_SIZE(valueCount, count);
    return get_all(fmu, references, count, values);
}

FUNCTION(fmi3SetFloat64, (fmi3Instance instance, const fmi3ValueReference references[],
                          size_t count, const fmi3Float64 values[], size_t valueCount))
{
    TAKE(ANY);
    IS_SIZE(valueCount, count);
    return set_all(fmu, references, count, values);
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

/* --- model exchange --- */

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
    *count = FMU_CONTINUOUS_STATES;
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
    *terminate = fmu->now.is_stopped != 0;
    *earlyReturn = *terminate && fmu->may_return_early;
    *lastSuccessfulTime = fmu->now.t;
    return (fmi3Status)status;
}
