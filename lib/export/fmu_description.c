/* fmu_description.c: modelDescription.xml: the description of an FMU's variables for importers
 *
 * Value references are those of share/fmu/fmu.h: t, parameters, states, their rates, outputs, event
 * indicators. In version 2 variables are also referenced by their index in the list. */
#include "export/fmu.h"

#include "base/names.h"
#include "model/model.h"

#include <string.h>

typedef enum Group { GROUP_T, GROUP_P, GROUP_Y, GROUP_RATE, GROUP_OUT, GROUP_INDICATOR } Group;

typedef struct Described { /* a variable of the interface */
    Group group;
    int i; /* in its group */
    int reference;
    char *name;
    bool is_output, is_input;
    int place;           /* in the list, from 1 */
    char *unit;          /* NULL: none, or it isn't known */
    Dimension dimension; /* of that */
} Described;

typedef struct Description {
    const Code *code;
    const Exported *what;
    Text *out;
    LIST(Described) variables;
    LIST(int) outputs; /* in their order: places in `variables` */
    Names *names;      /* of variables, by their places there */
    int states;        /* inputs among them */
} Description;

/* those that change with states: what is jumped at, margins of diodes */
static int indicator_count(const Code *code)
{
    return code->live.sides.count - code->live.timed + code->modes.ideals.count;
}

/* --- the list --- */

static const Dimension seconds = {{0, 0, 1}};

/* of what is called `of`, or of its rate */
static void find_unit(const Description *d, const char *of, Described *variable)
{
    Text unit = {0};

    if (variable->group == GROUP_T)
        variable->dimension = seconds;
    else if (variable->group == GROUP_INDICATOR ||
             !model_text_dimension(d->code->view->model, of, &variable->dimension) ||
             (variable->group == GROUP_RATE &&
              !dimension_times(variable->dimension, seconds, -1, &variable->dimension)))
        return;
    dimension_print(&unit, variable->dimension);
    if (unit.at == NULL || strcmp(unit.at, "1") == 0)
        text_free(&unit);
    else
        variable->unit = text_done(&unit);
}

static void add_variable(Description *d, Group group, int i, int reference, const char *name,
                         const char *of)
{
    Described variable = {.group = group,
                          .i = i,
                          .reference = reference,
                          .name = mem_text(name, strlen(name)),
                          .is_output = group == GROUP_OUT,
                          .place = d->variables.count + 1};

    find_unit(d, of, &variable);
    (void)names_add(d->names, name);
    LIST_PUSH(d->variables, variable);
}

static bool is_input(const Description *d, int state)
{
    const VariableIndex *l = d->code->layout;
    bool is = false;

    for (int k = 0; k < d->code->live.held.count; k++)
        is = is || d->code->live.held.at[k] == state - l->n - l->nu;
    return is;
}

static const char *state_name(const Description *d, int i)
{
    const VariableIndex *l = d->code->layout;

    return i < l->n           ? system_q(l->system, i)->name
           : i < l->n + l->nu ? system_u(l->system, i - l->n)->name
                              : system_x(l->system, i - l->n - l->nu)->name;
}

/* a state, or an input, which has the name of its part: "U1" */
static void add_state(Description *d, int i, int reference)
{
    const char *name = state_name(d, i);
    Text part = {0};

    text_add_n(&part, name, is_input(d, i) ? (size_t)(strrchr(name, '.') - name) : strlen(name));
    add_variable(d, GROUP_Y, i, reference, part.at, name);
    d->variables.at[d->variables.count - 1].is_input = is_input(d, i);
    text_free(&part);
}

/* a requested item: a state or parameter itself, if it is one */
static void add_output(Description *d, int i, int reference)
{
    const char *name = d->code->outputs.at[i];
    int place = names_find(d->names, name);

    if (place < 0) {
        place = d->variables.count;
        add_variable(d, GROUP_OUT, i, reference, name, name);
    } else if (d->variables.at[place].is_output || d->variables.at[place].group != GROUP_Y)
        return;
    d->variables.at[place].is_output = true;
    LIST_PUSH(d->outputs, place);
}

static void list_variables(Description *d)
{
    const Code *code = d->code;
    const int parameters = model_parameter_count(code->view->model);
    int reference = 0;
    Text name = {0};

    add_variable(d, GROUP_T, 0, reference++, "t", "t");
    for (int i = 0; i < parameters; i++)
        add_variable(d, GROUP_P, i, reference++, expr_name(code->parameters.at[i]),
                     expr_name(code->parameters.at[i]));
    for (int i = 0; i < d->states; i++)
        add_state(d, i, reference++);
    for (int i = 0; i < d->states; i++, reference++) {
        if (is_input(d, i))
            continue;
        text_addf(&name, "der(%s)", state_name(d, i));
        add_variable(d, GROUP_RATE, i, reference, name.at, state_name(d, i));
        text_free(&name);
    }
    for (int i = 0; i < code->outputs.count; i++)
        add_output(d, i, reference++);
    for (int i = 0; d->what->version == 3 && i < indicator_count(code); i++) {
        text_addf(&name, "indicator(%d)", i + 1);
        add_variable(d, GROUP_INDICATOR, i, reference++, name.at, name.at);
        text_free(&name);
    }
}

/* --- attributes --- */

static void write_start(Description *d, double value)
{
    text_add(d->out, " start=\"");
    text_number(d->out, value, 17);
    text_char(d->out, '"');
}

/* causality, variability, initial; in version 2 the start value is with the type */
static void write_kind(Description *d, const Described *v)
{
    const char *causality = v->is_output ? "output" : "local";

    if (v->group == GROUP_T)
        text_add(d->out, " causality=\"independent\" variability=\"continuous\"");
    else if (v->group == GROUP_P && d->code->live.depends[v->i])
        text_add(d->out, " causality=\"calculatedParameter\" variability=\"tunable\" "
                         "initial=\"calculated\"");
    else if (v->group == GROUP_P)
        text_add(d->out, " causality=\"parameter\" variability=\"tunable\" initial=\"exact\"");
    else if (v->is_input)
        text_add(d->out, " causality=\"input\" variability=\"continuous\"");
    else
        text_addf(d->out, " causality=\"%s\" variability=\"continuous\" initial=\"%s\"", causality,
                  v->group == GROUP_Y ? "exact" : "calculated");
}

static void write_value(Description *d, const Described *v)
{
    const Code *code = d->code;

    if (v->unit != NULL) {
        text_add(d->out, " unit=\"");
        text_xml(d->out, v->unit);
        text_char(d->out, '"');
    }
    if (v->group == GROUP_P && !code->live.depends[v->i])
        write_start(d, code->values[v->i]);
    if (v->group == GROUP_Y)
        write_start(d, code->values[code->parameters.count + v->i]);
    if (v->group == GROUP_RATE) {
        const int state = 1 + model_parameter_count(code->view->model) + v->i;

        /* by its place in the list in version 2, where states' places are references and 1 */
        text_addf(d->out, " derivative=\"%d\"", d->what->version == 2 ? state + 1 : state);
    }
}

/* each unit once, in the base units that it is of */
static void write_units(Description *d)
{
    static const char *const bases[] = {"m", "kg", "s", "A", "K", "rad"};
    Names *known = names_new();

    text_add(d->out, "  <UnitDefinitions>\n");
    for (int i = 0; i < d->variables.count; i++) {
        const Described *v = &d->variables.at[i];

        if (v->unit == NULL || names_find(known, v->unit) >= 0)
            continue;
        (void)names_add(known, v->unit);
        text_add(d->out, "    <Unit name=\"");
        text_xml(d->out, v->unit);
        text_add(d->out, "\"><BaseUnit");
        for (int k = 0; k < COUNT(bases); k++)
            if (v->dimension.power[k] != 0)
                text_addf(d->out, " %s=\"%d\"", bases[k], v->dimension.power[k]);
        text_add(d->out, "/></Unit>\n");
    }
    text_add(d->out, "  </UnitDefinitions>\n");
    names_free(known);
}

static void write_variables(Description *d)
{
    text_add(d->out, "  <ModelVariables>\n");
    for (int i = 0; i < d->variables.count; i++) {
        const Described *v = &d->variables.at[i];

        text_addf(d->out, "    <%s name=\"", d->what->version == 2 ? "ScalarVariable" : "Float64");
        text_xml(d->out, v->name);
        text_addf(d->out, "\" valueReference=\"%d\"", v->reference);
        write_kind(d, v);
        if (d->what->version == 2) {
            text_add(d->out, "><Real");
            write_value(d, v);
            text_add(d->out, "/></ScalarVariable>\n");
        } else {
            write_value(d, v);
            text_add(d->out, "/>\n");
        }
    }
    text_add(d->out, "  </ModelVariables>\n");
}

/* --- what depends on what --- */

/* Which states a function's entry depends on. False: it contains solved variables too, so that it
 * may depend on all. */
static bool write_dependencies(Description *d, const char *function, int row)
{
    const Code *code = d->code;
    const unsigned solved = 1U << SYMBOL_STATE_RATE | 1U << SYMBOL_ALGEBRAIC |
                            1U << SYMBOL_ACCELERATION | 1U << SYMBOL_MULTIPLIER;
    const VariableIndex *l = code->layout;
    Expr *symbols;
    Expr e = NULL;
    int count, written = 0;

    for (int f = 0; f < code->functions.count; f++)
        if (strcmp(code->functions.at[f].name, function) == 0)
            e = code->roots.at[code->functions.at[f].first + row];
    if ((expr_kinds(e) & (solved | 1U << SYMBOL_TURN)) != 0)
        return false;
    count = expr_symbols(&e, 1, &symbols);
    text_add(d->out, " dependencies=\"");
    for (int i = 0; i < d->states; i++) {
        const int at = i < l->n           ? l->q + i
                       : i < l->n + l->nu ? l->u + i - l->n
                                          : l->x + i - l->n - l->nu;

        for (int k = 0; k < count; k++)
            if (symbols[k] == l->symbols[at])
                text_addf(d->out, "%s%d", written++ > 0 ? " " : "",
                          1 + model_parameter_count(code->view->model) + i +
                              (d->what->version == 2));
    }
    text_char(d->out, '"');
    mem_free(symbols);
    return true;
}

static void write_unknown(Description *d, const char *element, const Described *v, bool is_initial)
{
    text_addf(d->out, "      <%s %s=\"%d\"", element,
              d->what->version == 2 ? "index" : "valueReference",
              d->what->version == 2 ? v->place : v->reference);
    if (!is_initial && v->group == GROUP_RATE)
        (void)write_dependencies(d, "derivative", v->i);
    else if (!is_initial && v->group == GROUP_OUT)
        (void)write_dependencies(d, "outputs", v->i);
    text_add(d->out, "/>\n");
}

/* all of a group; outputs in their order, states among them */
static void write_group(Description *d, const char *element, Group group, bool is_initial)
{
    for (int i = 0; group == GROUP_OUT && i < d->outputs.count; i++) {
        const Described *v = &d->variables.at[d->outputs.at[i]];

        if (!is_initial || v->group == GROUP_OUT)
            write_unknown(d, element, v, is_initial);
    }
    for (int i = 0; group != GROUP_OUT && i < d->variables.count; i++)
        if (d->variables.at[i].group == group &&
            (group != GROUP_P || d->code->live.depends[d->variables.at[i].i]))
            write_unknown(d, element, &d->variables.at[i], is_initial);
}

static void write_structure(Description *d)
{
    const bool is_2 = d->what->version == 2;
    const struct {
        const char *name, *element;
        Group group;
    } parts[] = {{"Outputs", "Output", GROUP_OUT},
                 {"Derivatives", "ContinuousStateDerivative", GROUP_RATE}};

    text_add(d->out, "  <ModelStructure>\n");
    for (int i = 0; i < COUNT(parts); i++) {
        const bool any = parts[i].group == GROUP_OUT ? d->outputs.count > 0
                                                     : d->states > d->code->live.held.count;

        if (is_2 && any)
            text_addf(d->out, "    <%s>\n", parts[i].name);
        write_group(d, is_2 ? "Unknown" : parts[i].element, parts[i].group, false);
        if (is_2 && any)
            text_addf(d->out, "    </%s>\n", parts[i].name);
    }
    if (is_2)
        text_add(d->out, "    <InitialUnknowns>\n");
    for (int g = GROUP_P; g <= GROUP_OUT; g++)
        if (g != GROUP_Y)
            write_group(d, is_2 ? "Unknown" : "InitialUnknown", (Group)g, true);
    if (is_2)
        text_add(d->out, "    </InitialUnknowns>\n");
    else
        write_group(d, "EventIndicator", GROUP_INDICATOR, true);
    text_add(d->out, "  </ModelStructure>\n");
}

/* --- the whole --- */

static void write_sources(const Description *d)
{
    if (d->what->version == 2) {
        text_add(d->out, ">\n    <SourceFiles>\n      <File name=\"model.c\"/>\n"
                         "      <File name=\"fmu.c\"/>\n      <File name=\"fmu_step.c\"/>\n"
                         "      <File name=\"fmu_ahead.c\"/>\n"
                         "      <File name=\"fmu_open.c\"/>\n"
                         "      <File name=\"fmu_values.c\"/>\n"
                         "      <File name=\"row_closure.c\"/>\n");
        if (d->code->live.slides.count > 0)
            text_add(d->out, "      <File name=\"fmu_slide.c\"/>\n"
                             "      <File name=\"surface_sides.c\"/>\n"
                             "      <File name=\"norm_complementarity.c\"/>\n"
                             "      <File name=\"complementarity.c\"/>\n");
        text_add(d->out, "      <File name=\"fmi2.c\"/>\n    </SourceFiles>\n");
    }
}

static void write_kinds(const Description *d)
{
    const bool is_2 = d->what->version == 2;
    const char *state = is_2 ? "canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" "
                               "providesDirectionalDerivative=\"true\""
                             : "canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" "
                               "providesDirectionalDerivatives=\"true\"";

    if (!d->what->only_simulation) {
        text_addf(d->out, "  <ModelExchange modelIdentifier=\"" FMU_IDENTIFIER "\" %s%s", state,
                  is_2 ? "" : " needsCompletedIntegratorStep=\"true\"");
        write_sources(d);
        text_add(d->out, is_2 ? "  </ModelExchange>\n" : "/>\n");
    }
    if (!d->what->only_exchange) {
        text_addf(d->out,
                  "  <CoSimulation modelIdentifier=\"" FMU_IDENTIFIER "\" %s "
                  "canHandleVariableCommunicationStepSize=\"true\" maxOutputDerivativeOrder=\"1\"",
                  state);
        write_sources(d);
        text_add(d->out, is_2 ? "  </CoSimulation>\n" : "/>\n");
    }
}

static void write_head(const Description *d, const char *token)
{
    const bool is_2 = d->what->version == 2;
    const char *title = model_title(d->code->view->model);

    text_addf(d->out,
              "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
              "<fmiModelDescription fmiVersion=\"%s\" modelName=\"",
              is_2 ? "2.0" : "3.0");
    text_xml(d->out, title != NULL && title[0] != '\0' ? title : "model");
    text_addf(d->out, "\" %s=\"%s\" generationTool=\"cotree\" variableNamingConvention=\"flat\"",
              is_2 ? "guid" : "instantiationToken", token);
    if (is_2)
        text_addf(d->out, " numberOfEventIndicators=\"%d\"", indicator_count(d->code));
    text_add(d->out, ">\n");
}

static void write_categories(Text *out)
{
    static const char *const names[] = {"logEvents", "logStatusWarning", "logStatusDiscard",
                                        "logStatusError", "logStatusFatal"};

    text_add(out, "  <LogCategories>\n");
    for (int i = 0; i < COUNT(names); i++)
        text_addf(out, "    <Category name=\"%s\"/>\n", names[i]);
    text_add(out, "  </LogCategories>\n");
}

void fmu_describe(const Code *code, const Exported *what, const char *token, Text *out)
{
    const VariableIndex *l = code->layout;
    Description d = {.code = code, .what = what, .out = out};

    d.states = l->n + l->nu + l->nx;
    d.names = names_new();
    list_variables(&d);
    write_head(&d, token);
    write_kinds(&d);
    write_units(&d);
    write_categories(out);
    text_add(out, "  <DefaultExperiment startTime=\"0\" tolerance=\"" FMU_TOLERANCE "\"/>\n");
    write_variables(&d);
    write_structure(&d);
    text_add(out, "</fmiModelDescription>\n");
    for (int i = 0; i < d.variables.count; i++)
        MEM_FREE(d.variables.at[i].name, d.variables.at[i].unit);
    LIST_FREE(d.variables);
    LIST_FREE(d.outputs);
    names_free(d.names);
}
