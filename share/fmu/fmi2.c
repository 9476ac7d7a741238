/* fmi2.c: the Functional Mock-up Interface, version 2.0: model exchange and co-simulation
 *
 * Types and functions are those that the standard names (fmi-standard.org), declared here. */
#include <stddef.h>

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum {
    fmi2DoStepStatus,
    fmi2PendingStatus,
    fmi2LastSuccessfulTime,
    fmi2Terminated
} fmi2StatusKind;
typedef void (*fmi2CallbackLogger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String,
                                   fmi2String, ...);
typedef struct {
    fmi2CallbackLogger logger;
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;
typedef struct {
    fmi2Boolean newDiscreteStatesNeeded;
    fmi2Boolean terminateSimulation;
    fmi2Boolean nominalsOfContinuousStatesChanged;
    fmi2Boolean valuesOfContinuousStatesChanged;
    fmi2Boolean nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;

#define FMI(name)             fmi2##name
#define FMI_STATE(verb, what) fmi2##verb##FMUstate##what
#define FMI_READ_STATE        fmi2DeSerializeFMUstate
#define FMI_RATES             fmi2GetDerivatives
typedef fmi2Component FmiInstance;
typedef fmi2Boolean FmiBoolean;
typedef fmi2String FmiString;
typedef fmi2FMUstate FmiState;
typedef fmi2Byte FmiByte;
typedef fmi2ValueReference FmiReference;
typedef fmi2Status FmiStatus;
#include "fmi.h"

void fmu_log(Fmu *fmu, FmuStatus status, const char *text)
{
    if (fmu->logger != NULL && (status >= FMU_ERROR || fmu->is_logging))
        ((fmi2CallbackLogger)fmu->logger)(fmu->environment, fmu->name, (fmi2Status)status,
                                          categories[status], "%s", text);
}

/* --- an instance --- */

EXPORTED const char *fmi2GetTypesPlatform(void);
const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

EXPORTED const char *fmi2GetVersion(void);
const char *fmi2GetVersion(void)
{
    return "2.0";
}

EXPORTED fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid,
                                       fmi2String resources, const fmi2CallbackFunctions *functions,
                                       fmi2Boolean visible, fmi2Boolean loggingOn);
fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean loggingOn)
{
    const int may = type == fmi2ModelExchange ? FMU_MODEL_EXCHANGE : FMU_CO_SIMULATION;
    const int is_ours = guid != NULL && strcmp(guid, FMU_TOKEN) == 0;
    Fmu *fmu;

    (void)resources;
    (void)visible;
    if (functions == NULL || name == NULL)
        return NULL;
    if ((!is_ours || !may) && functions->logger != NULL)
        functions->logger(functions->componentEnvironment, name, fmi2Error, "logStatusError", "%s",
                          is_ours ? "the file has no such kind of model"
                                  : "the model description is not of this binary");
    if (!is_ours || !may)
        return NULL;
    fmu = functions->allocateMemory != NULL ? functions->allocateMemory(1, sizeof *fmu)
                                            : calloc(1, sizeof *fmu);
    if (fmu == NULL)
        return NULL;
    fmu->release = functions->allocateMemory != NULL ? functions->freeMemory : free;
    fmu->name = functions->allocateMemory != NULL ? functions->allocateMemory(strlen(name) + 1, 1)
                                                  : calloc(strlen(name) + 1, 1);
    if (fmu->name == NULL) {
        fmu->release(fmu);
        return NULL;
    }
    memcpy(fmu->name, name, strlen(name) + 1);
    fmu->logger = (void (*)(void))functions->logger;
    fmu->environment = functions->componentEnvironment;
    fmu->is_logging = loggingOn;
    fmu->is_cosimulation = type == fmi2CoSimulation;
    fmu_reset(fmu);
    return fmu;
}

EXPORTED void fmi2FreeInstance(fmi2Component instance);
void fmi2FreeInstance(fmi2Component instance)
{
    Fmu *fmu = instance;

    if (fmu == NULL)
        return;
    fmu->release(fmu->name);
    fmu->release(fmu);
}

FUNCTION(fmi2SetupExperiment, (fmi2Component instance, fmi2Boolean hasTolerance, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean hasStop, fmi2Real stop))
{
    TAKE(FMU_INSTANTIATED);
    (void)hasStop;
    (void)stop;
    begin_at(fmu, hasTolerance, tolerance, start);
    return fmi2OK;
}

FUNCTION(fmi2EnterInitializationMode, (fmi2Component instance))
{
    TAKE(FMU_INSTANTIATED);
    fmu->now.mode = FMU_INITIALISING;
    return fmi2OK;
}

/* --- variables --- */

FUNCTION(fmi2GetReal, (fmi2Component instance, const fmi2ValueReference references[], size_t count,
                       fmi2Real values[]))
{
    TAKE(ALWAYS);
    return get_all(fmu, references, count, values);
}

FUNCTION(fmi2SetReal, (fmi2Component instance, const fmi2ValueReference references[], size_t count,
                       const fmi2Real values[]))
{
    TAKE(ANY);
    return set_all(fmu, references, count, values);
}

/* of these types there are no variables */
#define NONE_OF(type, constant, name)                                                              \
    EXPORTED fmi2Status name(fmi2Component instance, const fmi2ValueReference references[],        \
                             size_t count, constant type values[]);                                \
    fmi2Status name(fmi2Component instance, const fmi2ValueReference references[], size_t count,   \
                    constant type values[])                                                        \
    {                                                                                              \
        TAKE(ALWAYS);                                                                              \
        (void)references;                                                                          \
        (void)values;                                                                              \
        return count == 0 ? fmi2OK                                                                 \
                          : (fmi2Status)fmu_fail(fmu, FMU_ERROR,                                   \
                                                 "there are no variables of that type", 0);        \
    }
NONE_OF(fmi2Integer, , fmi2GetInteger)
NONE_OF(fmi2Integer, const, fmi2SetInteger)
NONE_OF(fmi2Boolean, , fmi2GetBoolean)
NONE_OF(fmi2Boolean, const, fmi2SetBoolean)
NONE_OF(fmi2String, , fmi2GetString)
NONE_OF(fmi2String, const, fmi2SetString)

FUNCTION(fmi2GetDirectionalDerivative,
         (fmi2Component instance, const fmi2ValueReference unknowns[], size_t unknownCount,
          const fmi2ValueReference knowns[], size_t knownCount, const fmi2Real seed[],
          fmi2Real derivatives[]))
{
    TAKE(ALWAYS);
    return (fmi2Status)fmu_derivatives(fmu, unknowns, unknownCount, knowns, knownCount, seed,
                                       derivatives);
}

/* --- model exchange --- */

FUNCTION(fmi2NewDiscreteStates, (fmi2Component instance, fmi2EventInfo *info))
{
    int moved = 0;
    FmuStatus status;

    TAKE(FMU_EVENTS);
    status = fmu_events(fmu, &moved);
    memset(info, 0, sizeof *info);
    info->valuesOfContinuousStatesChanged = moved;
    info->terminateSimulation = fmu->now.is_stopped;
    info->nextEventTimeDefined = fmu->now.next < HUGE_VAL;
    info->nextEventTime = info->nextEventTimeDefined ? fmu->now.next : 0;
    return (fmi2Status)status;
}

/* --- co-simulation --- */

FUNCTION(fmi2SetRealInputDerivatives,
         (fmi2Component instance, const fmi2ValueReference references[], size_t count,
          const fmi2Integer orders[], const fmi2Real values[]))
{
    TAKE(ANY);
    (void)references;
    (void)orders;
    (void)values;
    return count == 0 ? fmi2OK
                      : (fmi2Status)fmu_fail(fmu, FMU_ERROR, "inputs are held over a step", 0);
}

FUNCTION(fmi2GetRealOutputDerivatives,
         (fmi2Component instance, const fmi2ValueReference references[], size_t count,
          const fmi2Integer orders[], fmi2Real values[]))
{
    TAKE(FMU_STEPPING | FMU_TERMINATED | FMU_FAILED);
    return (fmi2Status)fmu_output_rates(fmu, references, count, orders, values);
}

FUNCTION(fmi2DoStep, (fmi2Component instance, fmi2Real from, fmi2Real step, fmi2Boolean noSetPrior))
{
    FmuStatus status;

    TAKE(FMU_STEPPING);
    (void)noSetPrior;
    status = fmu_do_step(fmu, from, step);
    return status == FMU_OK && fmu->now.is_stopped ? fmi2Discard : (fmi2Status)status;
}

FUNCTION(fmi2CancelStep, (fmi2Component instance))
{
    TAKE(FMU_STEPPING);
    return (fmi2Status)fmu_fail(fmu, FMU_ERROR, "no step goes on beside", 0);
}

FUNCTION(fmi2GetStatus, (fmi2Component instance, fmi2StatusKind kind, fmi2Status *value))
{
    TAKE(ALWAYS);
    (void)fmu;
    *value = fmi2OK;
    return kind == fmi2DoStepStatus ? fmi2OK : fmi2Discard;
}

FUNCTION(fmi2GetRealStatus, (fmi2Component instance, fmi2StatusKind kind, fmi2Real *value))
{
    TAKE(ALWAYS);
    *value = fmu->now.t;
    return kind == fmi2LastSuccessfulTime ? fmi2OK : fmi2Discard;
}

FUNCTION(fmi2GetIntegerStatus, (fmi2Component instance, fmi2StatusKind kind, fmi2Integer *value))
{
    TAKE(ALWAYS);
    (void)fmu;
    (void)kind;
    *value = 0;
    return fmi2Discard;
}

FUNCTION(fmi2GetBooleanStatus, (fmi2Component instance, fmi2StatusKind kind, fmi2Boolean *value))
{
    TAKE(ALWAYS);
    *value = fmu->now.is_stopped;
    return kind == fmi2Terminated ? fmi2OK : fmi2Discard;
}

FUNCTION(fmi2GetStringStatus, (fmi2Component instance, fmi2StatusKind kind, fmi2String *value))
{
    TAKE(ALWAYS);
    (void)fmu;
    *value = "";
    return kind == fmi2PendingStatus ? fmi2OK : fmi2Discard;
}
