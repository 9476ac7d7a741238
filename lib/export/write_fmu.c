/* write_fmu.c: the files of an FMU */
#include "export/fmu.h"
#include "export/shared_text.h"

#include "model/model.h"

#include <inttypes.h>
#include <string.h>

/* --- model_fmu.h: the model's numbers and tables for the instance --- */

static void add_numbers(Text *out, const char *type, const char *name, const int *values, int count)
{
    text_addf(out, "static const %s %s[] = {", type, name);
    for (int i = 0; i < count; i++)
        text_addf(out, "%d, ", values[i]);
    text_add(out, "0};\n");
}

static void add_events(const Code *code, Text *out)
{
    const CodeLive *live = &code->live;
    const int events = live->events.count;
    int *first = NEW_ARRAY(int, events), *count = NEW_ARRAY(int, events);
    int *action = NEW_ARRAY(int, events);

    text_add(out, "static const char *const fmu_event_name[] = {");
    for (int i = 0; i < events; i++) {
        const Event *event = live->events.at[i].event;

        first[i] = live->events.at[i].first;
        count[i] = event->action == EVENT_SET ? event->value_count : 0;
        action[i] = (int)event->action;
        text_addf(out, "\"%s\", ", event->name);
    }
    text_add(out, "0};\n");
    add_numbers(out, "int", "fmu_event_first", first, events);
    add_numbers(out, "int", "fmu_event_count", count, events);
    add_numbers(out, "int", "fmu_action", action, events);
    MEM_FREE(first, count, action);
}

/* variables that events set, and those that may be held */
static void add_targets(const CodeLive *live, Text *out)
{
    static const char *const names[] = {"fmu_level",    "fmu_place", "fmu_held_kind", "fmu_node",
                                        "fmu_attitude", "fmu_rate",  "fmu_turning"};
    int *column = NEW_ARRAY(int, live->targets.count);

    for (int c = 0; c < COUNT(names); c++) {
        for (int i = 0; i < live->targets.count; i++) {
            const CodeTarget *t = &live->targets.at[i];
            const int values[] = {(int)t->level, t->place, (int)t->held_kind, t->node,
                                  t->attitude,   t->rate,  t->turning};

            column[i] = values[c];
        }
        add_numbers(out, "int", names[c], column, live->targets.count);
    }
    text_add(out, "static const char *const fmu_target_name[] = {");
    for (int i = 0; i < live->targets.count; i++)
        text_addf(out, "\"%s\", ", live->targets.at[i].name);
    text_add(out, "0};\n");
    mem_free(column);
}

/* the requested items as text, which may contain strings */
static void add_output_names(const Code *code, Text *out)
{
    static const char *const to[] = {"\\\"", "\\\\"};

    text_add(out, "static const char *const fmu_output_name[] = {");
    for (int i = 0; i < code->outputs.count; i++) {
        text_char(out, '"');
        text_replace(out, code->outputs.at[i], "\"\\", to);
        text_add(out, "\", ");
    }
    text_add(out, "0};\n");
}

/* by state: whether it is an input */
static void add_inputs(const Code *code, Text *out)
{
    const VariableIndex *l = code->layout;
    const int states = l->n + l->nu + l->nx;
    int *is_input = NEW_ARRAY(int, states);

    for (int i = 0; i < code->live.held.count; i++)
        is_input[l->n + l->nu + code->live.held.at[i]] = 1;
    add_numbers(out, "int", "fmu_is_input", is_input, states);
    mem_free(is_input);
}

/* surfaces that a motion may slide along, among all sides, and whose they are */
static void add_slides(const Code *code, Text *out)
{
    const CodeLive *live = &code->live;
    int *of = NEW_ARRAY(int, live->sides.count);

    for (int i = 0; i < live->sides.count; i++)
        of[i] = -1;
    for (int k = 0; k < live->slides.count; k++)
        of[live->slides.at[k]] = k;
    add_numbers(out, "int", "fmu_slide_of", of, live->sides.count);
    add_numbers(out, "int", "fmu_slide", live->slides.at, live->slides.count);
    text_add(out, "static const char *const fmu_slide_name[] = {");
    for (int k = 0; k < live->slides.count; k++) {
        const Expr h = live->sides.at[live->slides.at[k]].surface.condition;
        const char *part = system_jumping_part(code->layout->system, h);

        text_addf(out, "\"%s\", ", part != NULL ? part : "parts");
    }
    text_add(out, "0};\n");
    mem_free(of);
}

static void add_tables(const Code *code, Text *out)
{
    const CodeLive *live = &code->live;
    const int parameters = model_parameter_count(code->view->model);
    int *numbers = NEW_ARRAY(int, live->sides.count + parameters);
    LIST(int) quaternions = {0};

    text_add(out, "\n#ifdef FMU_TABLES\n");
    for (int i = 0; i < parameters; i++)
        numbers[i] = live->depends[i];
    add_numbers(out, "int", "fmu_depends", numbers, parameters);
    for (int i = 0; i < live->timed; i++)
        numbers[i] = live->sides.at[i].is_floor;
    add_numbers(out, "int", "fmu_is_floor", numbers, live->timed);
    add_numbers(out, "int", "fmu_sample", live->samples.at, live->samples.count);
    add_inputs(code, out);
    for (int first; (first = system_quaternion(code->layout->system, quaternions.count)) >= 0;)
        LIST_PUSH(quaternions, first);
    add_numbers(out, "int", "fmu_quaternion", quaternions.at, quaternions.count);
    LIST_FREE(quaternions);
    mem_free(numbers);
    text_add(out, "static const char *const fmu_state_name[] = {"); /* of networks */
    for (int i = 0; i < code->layout->nx; i++)
        text_addf(out, "\"%s\", ", system_x(code->layout->system, i)->name);
    text_add(out, "0};\n");
    add_output_names(code, out);
    add_events(code, out);
    add_targets(live, out);
    add_slides(code, out);
    text_add(out, "#endif\n\n#endif\n");
}

/* whether time moves, not evenly or by signs alone, what anything else is compared with */
static bool follows_time(const Code *code)
{
    static const char *const of_signs[] = {"slides", "accelerations"};

    for (int i = 0; i < code->functions.count && code->live.slides.count > 0; i++) {
        const CodeFunction *f = &code->functions.at[i];

        if (strcmp(f->name, of_signs[0]) != 0 && strcmp(f->name, of_signs[1]) != 0)
            continue;
        for (int k = 0; k < f->rows; k++)
            if ((expr_kinds(code->roots.at[f->first + k]) & 1U << SYMBOL_TIME) != 0)
                return true;
    }
    for (int i = 0; i < code->live.sides.count + code->modes.ideals.count; i++) {
        const CodeFunction *f = code->functions.at;

        while (strcmp(f->name, "indicators") != 0)
            f++;
        if (i >= code->live.timed &&
            (expr_kinds(code->roots.at[f->first + i]) & 1U << SYMBOL_TIME) != 0)
            return true;
    }
    for (int g = 0; g < code->group_count; g++) {
        const CodeFunction *f = &code->functions.at[code->groups[g].function];

        for (int i = 0; i < f->rows * f->columns; i++)
            if ((expr_kinds(code->roots.at[f->first + i]) & 1U << SYMBOL_TIME) != 0)
                return code->live.sides.count + code->modes.ideals.count > code->live.timed;
    }
    return false;
}

static void write_header(const Code *code, const Exported *what, const char *token, Text *out)
{
    const VariableIndex *l = code->layout;
    const CodeLive *live = &code->live;
    const int rows = (l->nu + l->m > l->nx ? l->nu + l->m : l->nx) +
                     live->targets.count, /* of new values */
        states = l->n + l->nu + l->nx;
    int quaternions = 0;

    while (system_quaternion(l->system, quaternions) >= 0)
        quaternions++;
    text_addf(
        out,
        "/* model_fmu.h: what the instance (fmu.c) knows of the model (model.c) */\n"
        "#ifndef MODEL_FMU_H\n#define MODEL_FMU_H\n\n#define MODEL_DECLARED\n"
        "#include \"model.c\"\n\n#define FMU_TOKEN \"%s\"\n"
        "#define FMU_TOLERANCE %s\n\n"
        "enum {\n    FMU_MODEL_EXCHANGE = %d,\n    FMU_CO_SIMULATION = %d,\n"
        "    FMU_PARAMETERS = %d, /* the first ones, that have names */\n"
        "    FMU_FIRST_SIDE = %d, /* in p: signs of what is jumped at */\n"
        "    FMU_SIDES = %d,\n    FMU_SLIDES = %d, /* of those, that a motion may slide along */\n"
        "    FMU_SWITCHES = %d, /* ideal ones */\n    FMU_TIMED = %d, "
        "/* of those, that are of time alone */\n"
        "    FMU_EVENTS_COUNT = %d,\n    FMU_TARGETS = %d, /* that have new values or stay; */\n"
        "    FMU_GIVEN = %d, /* of them, the first: what events give values to */\n"
        "    FMU_FOLLOWS_TIME = %d,\n    FMU_SAMPLES = %d,\n    FMU_INPUTS = %d,\n    "
        "FMU_QUATERNIONS = %d,\n    "
        "FMU_ROWS = %d,\n    FMU_MAY_SHARE = %d, /* what nothing determines */\n",
        token, FMU_TOLERANCE, !what->only_simulation, !what->only_exchange,
        model_parameter_count(code->view->model), live->first, live->sides.count,
        live->slides.count, code->modes.ideals.count, live->timed, live->events.count,
        live->targets.count, live->given, follows_time(code), live->samples.count, live->held.count,
        quaternions, rows, code->is_redundant || code_has_modes(code));
    text_addf(out,
              "    FMU_SPACE = 2 * (FMU_ROWS + 2) * (FMU_ROWS + 2) + %d\n};\n"
              "enum { FMU_MARKS, FMU_STOPS, FMU_SETS };          /* what events do */\n"
              "enum { FMU_COORDINATE, FMU_SPEED, FMU_STATE };    /* what they give values to */\n"
              "enum { FMU_JOINT = 1, FMU_BODY, FMU_FRAME };      /* what may stay, 0: nothing */\n",
              2 * states * states + 16 * states + 1);
    if (live->slides.count > 0)
        text_add(out, "#define FMU_HAS_SLIDES\n");
    add_tables(code, out);
}

/* --- the archive --- */

static void take_text(Archive *archive, const char *name, Text *text)
{
    const size_t length = text->length;

    archive_add(archive, name, text_done(text), length);
}

static void take_lines(Archive *archive, const char *name, const char *const *lines)
{
    Text text = {0};

    for (int i = 0; lines[i] != NULL; i++)
        text_add(&text, lines[i]);
    take_text(archive, name, &text);
}

/* 128 bits of FNV-1a (Fowler, Noll, Vo), in two halves of other starts: what a description and a
 * binary know each other by */
static void make_token(const char *code, const Exported *what, char token[40])
{
    uint64_t half[2] = {UINT64_C(14695981039346656037), UINT64_C(88172645463325252)};

    for (int k = 0; k < COUNT(half); k++) {
        for (const char *c = code; *c != '\0'; c++)
            half[k] = (half[k] ^ (unsigned char)*c) * UINT64_C(1099511628211);
        half[k] = (half[k] ^ (uint64_t)what->version) * UINT64_C(1099511628211);
    }
    (void)snprintf(token, 40,
                   "{%08" PRIx64 "-%04" PRIx64 "-%04" PRIx64 "-%04" PRIx64 "-%012" PRIx64 "}",
                   half[0] >> 32, half[0] >> 16 & 0xffff, half[0] & 0xffff, half[1] >> 48,
                   half[1] & UINT64_C(0xffffffffffff));
}

/* which sources there are, of version 3 */
static void write_build(const Code *code, Text *out)
{
    text_add(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                  "<fmiBuildDescription fmiVersion=\"3.0\">\n"
                  "  <BuildConfiguration modelIdentifier=\"" FMU_IDENTIFIER "\">\n"
                  "    <SourceFileSet language=\"C99\">\n"
                  "      <SourceFile name=\"model.c\"/>\n      <SourceFile name=\"fmu.c\"/>\n"
                  "      <SourceFile name=\"fmu_step.c\"/>\n      <SourceFile "
                  "name=\"fmu_ahead.c\"/>\n      <SourceFile name=\"fmu_open.c\"/>\n"
                  "      <SourceFile name=\"fmu_values.c\"/>\n"
                  "      <SourceFile name=\"row_closure.c\"/>\n");
    if (code->live.slides.count > 0)
        text_add(out, "      <SourceFile name=\"fmu_slide.c\"/>\n"
                      "      <SourceFile name=\"surface_sides.c\"/>\n"
                      "      <SourceFile name=\"norm_complementarity.c\"/>\n"
                      "      <SourceFile name=\"complementarity.c\"/>\n");
    text_add(out, "      <SourceFile name=\"fmi3.c\"/>\n"
                  "    </SourceFileSet>\n    <Library name=\"m\"/>\n"
                  "  </BuildConfiguration>\n</fmiBuildDescription>\n");
}

/* The folder of a binary for this machine, named by the standard. */
static const char *binary_place(int version)
{
#if defined __linux__ && defined __x86_64__
    return version == 2 ? "binaries/linux64/" FMU_IDENTIFIER ".so"
                        : "binaries/x86_64-linux/" FMU_IDENTIFIER ".so";
#elif defined __linux__ && defined __aarch64__
    return version == 2 ? NULL : "binaries/aarch64-linux/" FMU_IDENTIFIER ".so";
#else
    (void)version;
    return NULL;
#endif
}

/* An FMU follows friction that sticks, but has no impacts. */
static Status check_limits(System *system, Diag *diag)
{
    const Switch *switches;
    SystemSurface surface;
    int time_only;

    (void)system_switches(system, &switches, &time_only);
    for (int i = 0; system_surface(system, i, &surface); i++) {
        const char *part;

        if (!surface.law.is_unilateral && !surface.law.is_norm)
            continue;
        part = system_jumping_part(system, surface.condition);
        if (surface.law.is_norm) {
            (void)diag_set(diag, E_MODEL,
                           "%s sticks in %d directions with one bound, which an FMU lacks",
                           part != NULL ? part : "direction()", surface.part_count);
            diag_hint(diag, "friction on each coordinate has a bound of its own: friction f p.s1 "
                            "force=2");
            return E_MODEL;
        }
        (void)diag_set(diag, E_MODEL, "%s is rigid, and an FMU has no impacts",
                       part != NULL ? part : "unilateral()");
        diag_hint(diag,
                  "k= makes a contact, stop or backlash compliant, torque= or force= bounds a "
                  "one-way clutch");
        return E_MODEL;
    }
    return OK;
}

static Status pack(const Exported *what, Archive **out, Diag *diag)
{
    Code *code = NULL;
    Archive *archive = NULL;
    Text text = {0}, model = {0};
    char token[40];

    if (what->inverse != NULL)
        return diag_set(diag, E_MODEL, "an FMU goes forward: efforts of drivers come as code");
    TRY(check_limits(what->view.system, diag));
    TRY(code_new(what, true, &code, diag));
    archive = NEW(Archive);
    archive->binary = binary_place(what->version);
    code_file(code, &language_c, &model);
    make_token(model.at, what, token);
    fmu_describe(code, what, token, &text);
    take_text(archive, "modelDescription.xml", &text);
    take_text(archive, "sources/model.c", &model);
    write_header(code, what, token, &text);
    take_text(archive, "sources/model_fmu.h", &text);
    take_lines(archive, "sources/fmu.h", shared_text_fmu_h);
    take_lines(archive, "sources/fmu.c", shared_text_fmu_c);
    take_lines(archive, "sources/fmu_step.c", shared_text_fmu_step_c);
    take_lines(archive, "sources/fmu_ahead.c", shared_text_fmu_ahead_c);
    take_lines(archive, "sources/fmu_open.c", shared_text_fmu_open_c);
    take_lines(archive, "sources/fmu_values.c", shared_text_fmu_values_c);
    take_lines(archive, "sources/row_closure.h", shared_text_row_closure_h);
    take_lines(archive, "sources/row_closure.c", shared_text_row_closure_c);
    if (code->live.slides.count > 0) {
        take_lines(archive, "sources/fmu_slide.c", shared_text_fmu_slide_c);
        take_lines(archive, "sources/surface_sides.h", shared_text_surface_sides_h);
        take_lines(archive, "sources/surface_sides.c", shared_text_surface_sides_c);
        take_lines(archive, "sources/norm_complementarity.h", shared_text_norm_complementarity_h);
        take_lines(archive, "sources/norm_complementarity.c", shared_text_norm_complementarity_c);
        take_lines(archive, "sources/complementarity.h", shared_text_complementarity_h);
        take_lines(archive, "sources/complementarity.c", shared_text_complementarity_c);
    }
    take_lines(archive, "sources/fmi.h", shared_text_fmi_h);
    if (what->version == 2)
        take_lines(archive, "sources/fmi2.c", shared_text_fmi2_c);
    else {
        take_lines(archive, "sources/fmi3.c", shared_text_fmi3_c);
        write_build(code, &text);
        take_text(archive, "sources/buildDescription.xml", &text);
    }
    code_free(code);
    *out = archive;
    return OK;
}

const Format format_fmu = {.need = NEED_CODE, .pack = pack, .takes_keys = true};
