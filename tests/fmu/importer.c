/* importer.c: archive, description and functions of either version */
#include "importer.h"

#include <dlfcn.h>
#include <expat.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zip.h>

static void fail(const char *what, const char *which)
{
    fprintf(stderr, "%s: %s\n", what, which);
    exit(1);
}

static void *room(size_t size)
{
    void *piece = calloc(1, size + 1);

    if (piece == NULL)
        fail("no memory", "");
    return piece;
}

/* --- the archive --- */

static char *read_member(zip_t *zip, const char *name, size_t *length)
{
    zip_stat_t stat;
    zip_file_t *file;
    char *bytes;

    if (zip_stat(zip, name, 0, &stat) != 0)
        return NULL;
    bytes = room((size_t)stat.size);
    file = zip_fopen(zip, name, 0);
    if (file == NULL || zip_fread(file, bytes, stat.size) != (zip_int64_t)stat.size)
        fail("can't be read", name);
    zip_fclose(file);
    *length = (size_t)stat.size;
    return bytes;
}

static void load(Unit *unit, zip_t *zip)
{
    char place[300], path[] = "/tmp/fmu-XXXXXX";
    size_t length;
    char *bytes;
    int file;

    snprintf(place, sizeof place, "binaries/%s/%s.so",
             unit->version == 2 ? "linux64" : "x86_64-linux", unit->identifier);
    bytes = read_member(zip, place, &length);
    if (bytes == NULL)
        fail("there is no binary", place);
    file = mkstemp(path);
    if (file < 0 || write(file, bytes, length) != (ssize_t)length || close(file) != 0)
        fail("can't write", path);
    free(bytes);
    unit->library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    unlink(path);
    if (unit->library == NULL)
        fail("can't be loaded", dlerror());
}

/* --- its description --- */

typedef struct EquationForm {
    Unit *unit;
    char inside[40]; /* of the model's structure: which list */
} EquationForm;

static const char *attribute(const char *const *pairs, const char *name)
{
    for (; *pairs != NULL; pairs += 2)
        if (strcmp(pairs[0], name) == 0)
            return pairs[1];
    return NULL;
}

static void copy(char *out, size_t size, const char *text)
{
    snprintf(out, size, "%s", text != NULL ? text : "");
}

static void push(unsigned **list, int *count, unsigned value)
{
    *list = realloc(*list, (size_t)(*count + 1) * sizeof **list);
    if (*list == NULL)
        fail("no memory", "");
    (*list)[(*count)++] = value;
}

static void read_variable(Unit *unit, const char *const *at)
{
    Variable *v;

    unit->variables =
        realloc(unit->variables, (size_t)(unit->variable_count + 1) * sizeof *unit->variables);
    if (unit->variables == NULL || attribute(at, "name") == NULL ||
        attribute(at, "valueReference") == NULL)
        fail("no variable", "");
    v = &unit->variables[unit->variable_count++];
    memset(v, 0, sizeof *v);
    copy(v->name, sizeof v->name, attribute(at, "name"));
    v->reference = (unsigned)strtoul(attribute(at, "valueReference"), NULL, 10);
    copy(v->causality, sizeof v->causality, attribute(at, "causality"));
    copy(v->variability, sizeof v->variability, attribute(at, "variability"));
    copy(v->initial, sizeof v->initial, attribute(at, "initial"));
    if (strcmp(v->causality, "input") == 0)
        push(&unit->inputs, &unit->input_count, v->reference);
    if (strcmp(v->causality, "parameter") == 0)
        push(&unit->parameters, &unit->parameter_count, v->reference);
}

static void read_value(Unit *unit, const char *const *at)
{
    Variable *v = &unit->variables[unit->variable_count - 1];

    v->has_start = attribute(at, "start") != NULL;
    v->start = v->has_start ? strtod(attribute(at, "start"), NULL) : 0;
    v->derivative = attribute(at, "derivative") != NULL ? atoi(attribute(at, "derivative")) : 0;
}

static const Variable *by_place(const Unit *unit, int place)
{
    if (place < 1 || place > unit->variable_count)
        fail("there is no such place", unit->path);
    return &unit->variables[place - 1];
}

static const Variable *by_reference(const Unit *unit, unsigned reference)
{
    for (int i = 0; i < unit->variable_count; i++)
        if (unit->variables[i].reference == reference)
            return &unit->variables[i];
    fail("there is no such reference", unit->path);
    return NULL;
}

static void read_unknown(Unit *unit, const char *list, const char *const *at)
{
    const char *index = attribute(at, unit->version == 2 ? "index" : "valueReference");
    const Variable *v;

    if (index == NULL)
        fail("an unknown is nobody", list);
    v = unit->version == 2 ? by_place(unit, atoi(index))
                           : by_reference(unit, (unsigned)strtoul(index, NULL, 10));
    if (strcmp(list, "Outputs") == 0 || strcmp(list, "Output") == 0)
        push(&unit->outputs, &unit->output_count, v->reference);
    if (strcmp(list, "Derivatives") == 0 || strcmp(list, "ContinuousStateDerivative") == 0) {
        const Variable *state = unit->version == 2 ? by_place(unit, v->derivative)
                                                   : by_reference(unit, (unsigned)v->derivative);
        int count = unit->state_count;

        push(&unit->rates, &count, v->reference);
        push(&unit->states, &unit->state_count, state->reference);
    }
    if (strcmp(list, "EventIndicator") == 0)
        unit->indicator_count++;
}

static void XMLCALL begin(void *context, const char *element, const char **at)
{
    EquationForm *r = context;
    Unit *unit = r->unit;

    if (strcmp(element, "fmiModelDescription") == 0) {
        unit->version = atoi(attribute(at, "fmiVersion"));
        copy(unit->token, sizeof unit->token,
             attribute(at, unit->version == 2 ? "guid" : "instantiationToken"));
        copy(unit->model_name, sizeof unit->model_name, attribute(at, "modelName"));
        if (attribute(at, "numberOfEventIndicators") != NULL)
            unit->indicator_count = atoi(attribute(at, "numberOfEventIndicators"));
    } else if (strcmp(element, "ModelExchange") == 0 || strcmp(element, "CoSimulation") == 0) {
        const char *can = attribute(at, unit->version == 2 ? "providesDirectionalDerivative"
                                                           : "providesDirectionalDerivatives");

        *(element[0] == 'M' ? &unit->has_exchange : &unit->has_simulation) = true;
        copy(unit->identifier, sizeof unit->identifier, attribute(at, "modelIdentifier"));
        unit->has_derivatives = can != NULL && strcmp(can, "true") == 0;
    } else if (strcmp(element, "ScalarVariable") == 0)
        read_variable(unit, at);
    else if (strcmp(element, "Real") == 0)
        read_value(unit, at);
    else if (strcmp(element, "Float64") == 0) {
        read_variable(unit, at);
        read_value(unit, at);
    } else if (strcmp(element, "Outputs") == 0 || strcmp(element, "Derivatives") == 0 ||
               strcmp(element, "InitialUnknowns") == 0)
        copy(r->inside, sizeof r->inside, element);
    else if (strcmp(element, "Unknown") == 0)
        read_unknown(unit, r->inside, at);
    else if (unit->version == 3)
        for (int k = 0; k < 3; k++) {
            static const char *const lists[] = {"Output", "ContinuousStateDerivative",
                                                "EventIndicator"};

            if (strcmp(element, lists[k]) == 0)
                read_unknown(unit, element, at);
        }
}

static void XMLCALL end(void *context, const char *element)
{
    (void)context;
    (void)element;
}

Unit *unit_open(const char *path)
{
    Unit *unit = room(sizeof *unit);
    EquationForm reading = {unit, ""};
    XML_Parser parser = XML_ParserCreate(NULL);
    zip_t *zip = zip_open(path, ZIP_RDONLY, NULL);
    size_t length;
    char *text = zip != NULL ? read_member(zip, "modelDescription.xml", &length) : NULL;

    if (text == NULL)
        fail("no model description", path);
    unit->path = room(strlen(path));
    strcpy(unit->path, path);
    XML_SetUserData(parser, &reading);
    XML_SetElementHandler(parser, begin, end);
    if (XML_Parse(parser, text, (int)length, 1) != XML_STATUS_OK)
        fail("no XML", path);
    XML_ParserFree(parser);
    free(text);
    load(unit, zip);
    zip_discard(zip);
    return unit;
}

void unit_close(Unit *unit)
{
    dlclose(unit->library);
    free(unit->variables);
    free(unit->states);
    free(unit->inputs);
    free(unit->parameters);
    free(unit->rates);
    free(unit->outputs);
    free(unit->path);
    free(unit);
}

const Variable *unit_variable(const Unit *unit, const char *name)
{
    for (int i = 0; i < unit->variable_count; i++)
        if (strcmp(unit->variables[i].name, name) == 0)
            return &unit->variables[i];
    return NULL;
}

/* --- functions --- */

typedef void (*AnyFunction)(void);

static AnyFunction find(const Unit *unit, const char *name)
{
    char whole[80];
    void *found;
    AnyFunction function;

    snprintf(whole, sizeof whole, "fmi%d%s", unit->version, name);
    found = dlsym(unit->library, whole);
    if (found == NULL)
        fail("the binary lacks", whole);
    memcpy(&function, &found, sizeof function);
    return function;
}

/* fmi2NAME(...) or fmi3NAME(...) of these types */
#define CALL(unit, name, types) ((int(*) types)find(unit, name))

static void say(Unit *unit, int status, const char *text)
{
    if (status < ERROR)
        return;
    unit->messages++;
    copy(unit->said, sizeof unit->said, text);
}

static void logger_2(void *environment, const char *name, int status, const char *category,
                     const char *message, ...)
{
    char text[400];
    va_list args;

    (void)name;
    (void)category;
    va_start(args, message);
    vsnprintf(text, sizeof text, message, args);
    va_end(args);
    say(environment, status, text);
}

static void logger_3(void *environment, int status, const char *category, const char *message)
{
    (void)category;
    say(environment, status, message);
}

typedef struct Callbacks {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

typedef void (*Logger)(void *, int, const char *, const char *);
typedef void *(*Instantiate)(const char *, int, const char *, const char *, const Callbacks *, int,
                             int);
typedef void *(*InstantiateExchange)(const char *, const char *, const char *, bool, bool, void *,
                                     Logger);
typedef void *(*InstantiateSimulation)(const char *, const char *, const char *, bool, bool, bool,
                                       bool, const unsigned *, size_t, void *, Logger, void *);

Instance instance_new(Unit *unit, const char *name, bool is_simulation)
{
    static Callbacks callbacks = {logger_2, calloc, free, NULL, NULL};
    Instance in = {unit, NULL};

    callbacks.environment = unit;
    if (unit->version == 2)
        in.handle = ((Instantiate)find(unit, "Instantiate"))(name, is_simulation, unit->token,
                                                             "file:///tmp", &callbacks, 0, 0);
    else if (is_simulation)
        in.handle = ((InstantiateSimulation)find(unit, "InstantiateCoSimulation"))(
            name, unit->token, "/tmp/", false, false, false, false, NULL, 0, unit, logger_3, NULL);
    else
        in.handle = ((InstantiateExchange)find(unit, "InstantiateModelExchange"))(
            name, unit->token, "/tmp/", false, false, unit, logger_3);
    return in;
}

void instance_free(Instance *in)
{
    ((void (*)(void *))find(in->unit, "FreeInstance"))(in->handle);
    in->handle = NULL;
}

int instance_initialise(Instance *in, double tolerance, double start)
{
    int status;

    if (in->unit->version == 3)
        return CALL(in->unit, "EnterInitializationMode",
                    (void *, bool, double, double, bool, double))(in->handle, true, tolerance,
                                                                  start, false, 0.0);
    status = CALL(in->unit, "SetupExperiment", (void *, int, double, double, int, double))(
        in->handle, 1, tolerance, start, 0, 0.0);
    return status == OK ? CALL(in->unit, "EnterInitializationMode", (void *))(in->handle) : status;
}

#define PLAIN(function, name)                                                                      \
    int function(Instance *in)                                                                     \
    {                                                                                              \
        return CALL(in->unit, name, (void *))(in->handle);                                         \
    }
PLAIN(instance_initialised, "ExitInitializationMode")
PLAIN(instance_terminate, "Terminate")
PLAIN(instance_reset, "Reset")
PLAIN(instance_enter_events, "EnterEventMode")
PLAIN(instance_enter_continuous, "EnterContinuousTimeMode")

int instance_get(Instance *in, const unsigned *references, int count, double *values)
{
    const size_t n = (size_t)count;

    return in->unit->version == 2
               ? CALL(in->unit, "GetReal", (void *, const unsigned *, size_t, double *))(
                     in->handle, references, n, values)
               : CALL(in->unit, "GetFloat64", (void *, const unsigned *, size_t, double *, size_t))(
                     in->handle, references, n, values, n);
}

int instance_set(Instance *in, const unsigned *references, int count, const double *values)
{
    const size_t n = (size_t)count;

    return in->unit->version == 2
               ? CALL(in->unit, "SetReal", (void *, const unsigned *, size_t, const double *))(
                     in->handle, references, n, values)
               : CALL(in->unit, "SetFloat64",
                      (void *, const unsigned *, size_t, const double *, size_t))(
                     in->handle, references, n, values, n);
}

int instance_update(Instance *in, Discrete *out)
{
    struct {
        int again, ends, nominals, moved, has_next;
        double next;
    } two = {0};
    bool again = false, ends = false, nominals = false, moved = false, has_next = false;
    double next = 0;
    int status;

    if (in->unit->version == 2) {
        status = CALL(in->unit, "NewDiscreteStates", (void *, void *))(in->handle, &two);
        *out = (Discrete){two.again, two.ends, two.moved, two.has_next, two.next};
        return status;
    }
    status = CALL(in->unit, "UpdateDiscreteStates",
                  (void *, bool *, bool *, bool *, bool *, bool *, double *))(
        in->handle, &again, &ends, &nominals, &moved, &has_next, &next);
    *out = (Discrete){again, ends, moved, has_next, next};
    return status;
}

int instance_step_done(Instance *in, bool *wants_events, bool *ends)
{
    int wants = 0, over = 0, status;

    if (in->unit->version == 3)
        return CALL(in->unit, "CompletedIntegratorStep",
                    (void *, bool, bool *, bool *))(in->handle, true, wants_events, ends);
    status = CALL(in->unit, "CompletedIntegratorStep", (void *, int, int *, int *))(in->handle, 1,
                                                                                    &wants, &over);
    *wants_events = wants;
    *ends = over;
    return status;
}

int instance_set_time(Instance *in, double t)
{
    return CALL(in->unit, "SetTime", (void *, double))(in->handle, t);
}

#define ARRAY(function, name, constant, count)                                                     \
    int function(Instance *in, constant double *x)                                                 \
    {                                                                                              \
        return CALL(in->unit, name, (void *, constant double *, size_t))(in->handle, x,            \
                                                                         (size_t)in->unit->count); \
    }
ARRAY(instance_set_states, "SetContinuousStates", const, state_count)
ARRAY(instance_states, "GetContinuousStates", , state_count)
ARRAY(instance_rates, in->unit->version == 2 ? "GetDerivatives" : "GetContinuousStateDerivatives", ,
      state_count)
ARRAY(instance_indicators, "GetEventIndicators", , indicator_count)

int instance_do_step(Instance *in, double t, double step, bool *ends, double *reached)
{
    bool wants = false, early = false;
    int status, over = 0;

    *ends = false;
    *reached = t + step;
    if (in->unit->version == 3) {
        status = CALL(in->unit, "DoStep",
                      (void *, double, double, bool, bool *, bool *, bool *, double *))(
            in->handle, t, step, true, &wants, ends, &early, reached);
        return early ? ERROR : status; /* which was not allowed when it was made */
    }
    status = CALL(in->unit, "DoStep", (void *, double, double, int))(in->handle, t, step, 1);
    if (status != DISCARD)
        return status;
    status = CALL(in->unit, "GetBooleanStatus", (void *, int, int *))(in->handle, 3, &over);
    if (status == OK)
        status = CALL(in->unit, "GetRealStatus", (void *, int, double *))(in->handle, 2, reached);
    *ends = over;
    return over ? status : DISCARD;
}

int instance_derivative(Instance *in, const unsigned *unknowns, int unknown_count,
                        const unsigned *knowns, int known_count, const double *seed, double *out)
{
    const size_t n = (size_t)unknown_count, m = (size_t)known_count;

    return in->unit->version == 2
               ? CALL(in->unit, "GetDirectionalDerivative",
                      (void *, const unsigned *, size_t, const unsigned *, size_t, const double *,
                       double *))(in->handle, unknowns, n, knowns, m, seed, out)
               : CALL(in->unit, "GetDirectionalDerivative",
                      (void *, const unsigned *, size_t, const unsigned *, size_t, const double *,
                       size_t, double *, size_t))(in->handle, unknowns, n, knowns, m, seed, m, out,
                                                  n);
}

static const char *state_call(const Instance *in, const char *two, const char *three)
{
    return in->unit->version == 2 ? two : three;
}

int instance_keep(Instance *in, void **state)
{
    return CALL(in->unit, state_call(in, "GetFMUstate", "GetFMUState"),
                (void *, void **))(in->handle, state);
}

int instance_go_back(Instance *in, void *state)
{
    return CALL(in->unit, state_call(in, "SetFMUstate", "SetFMUState"),
                (void *, void *))(in->handle, state);
}

int instance_forget(Instance *in, void **state)
{
    return CALL(in->unit, state_call(in, "FreeFMUstate", "FreeFMUState"),
                (void *, void **))(in->handle, state);
}

int instance_through_bytes(Instance *in, void **state)
{
    size_t size = 0;
    unsigned char *bytes;
    int status = CALL(in->unit, state_call(in, "SerializedFMUstateSize", "SerializedFMUStateSize"),
                      (void *, void *, size_t *))(in->handle, *state, &size);

    bytes = room(size);
    if (status == OK)
        status = CALL(in->unit, state_call(in, "SerializeFMUstate", "SerializeFMUState"),
                      (void *, void *, unsigned char *, size_t))(in->handle, *state, bytes, size);
    if (status == OK)
        status = instance_forget(in, state);
    if (status == OK)
        status =
            CALL(in->unit, state_call(in, "DeSerializeFMUstate", "DeserializeFMUState"),
                 (void *, const unsigned char *, size_t, void **))(in->handle, bytes, size, state);
    free(bytes);
    return status;
}
