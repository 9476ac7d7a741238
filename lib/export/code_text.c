/* code_text.c: texts of a language, with $WORDS for what a model has there */
#include "export/code.h"

#include <string.h>

static int first_of(const Language *language)
{
    return notation_row(language->notation)->first;
}

/* --- lists and parts --- */

static void write_head(const Code *code, const Language *language, Text *out)
{
    code_head(code, language, notation_row(language->notation)->open, out);
}

static void write_prepare(const Code *code, const Language *language, Text *out)
{
    mem_free(code_print_derived(code, language, out));
}

static void write_values(const Code *code, const Language *language, Text *out)
{
    code_set_array(language, "p", code->values, code->parameters.count, out);
}

static void write_start(const Code *code, const Language *language, Text *out)
{
    code_set_array(language, "y", code->values + code->parameters.count, code->ny, out);
    if (code->states.count > 0)
        code_set_array(language, "s", code->states.at[0].s, code->ns, out);
}

static void write_code(const Code *code, const Language *language, Text *out)
{
    for (int f = 0; f < code->functions.count; f++)
        code_print(code, f, language, out);
}

/* where quaternions begin in y */
static void write_firsts(const Code *code, const Language *language, Text *out)
{
    for (int i = 0, first; (first = system_quaternion(code->layout->system, i)) >= 0; i++)
        text_addf(out, "%s%d", i > 0 ? ", " : "", first + first_of(language));
}

/* where sampled states are in y */
static void write_sampled(const Code *code, const Language *language, Text *out)
{
    for (int i = 0; i < code->live.samples.count; i++)
        text_addf(out, "%s%d", i > 0 ? language->between : "",
                  code->layout->n + code->layout->nu + code->live.samples.at[i] +
                      first_of(language));
}

static void write_ideal_names(const Code *code, const Language *language, Text *out)
{
    for (int k = 0; k < code->modes.ideals.count; k++) {
        text_add(out, k > 0 ? language->ideal[1] : "");
        text_addf(out, language->ideal[0], /* NOLINT: a format of ours */
                  code->modes.ideals.at[k].ideal.name);
    }
}

/* what solves for the parts of s, in their order */
static void write_solve(const Code *code, const Language *language, Text *out)
{
    const int at = first_of(language), first = code->layout->nx + code->layout->nz;

    for (int g = 0; g < code->group_count; g++) {
        const CodeGroup *group = &code->groups[g];
        const char *name = code->functions.at[group->function].name;

        if (group->iterates) /* NOLINTNEXTLINE: a format of ours */
            text_addf(out, language->solve[0], name, group->first + at, group->count);
        else /* NOLINTNEXTLINE */
            text_addf(out, language->solve[1], group->first + at, group->first + group->count,
                      name);
    }
    if (code->is_explicit)
        text_addf(out, language->solve[2], first + at, code->ns); /* NOLINT */
}

/* what rounding of the parts of s counts against */
static void write_sizes(const Code *code, const Language *language, Text *out)
{
    double sizes[CODE_PARTS];

    code_sizes(code, sizes);
    for (int i = 0; i < CODE_PARTS; i++) {
        text_add(out, i == 0 ? "[" : ", ");
        code_number(language, sizes[i], out);
    }
    text_char(out, ']');
}

/* the states that a file checks itself by, as cases of a number */
static void write_states(const Code *code, const Language *language, Text *out)
{
    for (int k = 0; k < code->states.count; k++) {
        const CodeState *state = &code->states.at[k];
        Text number = {0};

        text_addf(out, language->state, k + 1); /* NOLINT: a format of ours */
        code_number(language, state->t, &number);
        code_set(language, "t", number.at, out);
        text_free(&number);
        code_set_array(language, "y", state->y, code->ny, out);
        code_set_array(language, "s", state->s, code->ns, out);
        for (int f = 0; f < code->functions.count; f++) {
            Text left = {0}, both = {0};

            text_addf(&left, language->sums, f + 1); /* NOLINT: a format of ours */
            text_char(&both, '[');
            code_number(language, state->sums[f], &both);
            text_add(&both, ", ");
            code_number(language, state->size[f], &both);
            text_char(&both, ']');
            code_set(language, left.at, both.at, out);
            text_free(&left);
            text_free(&both);
        }
    }
}

static const CodeWord words[] = {{"HEAD", write_head},       {"PREPARE", write_prepare},
                                 {"VALUES", write_values},   {"START", write_start},
                                 {"CODE", write_code},       {"FIRSTS", write_firsts},
                                 {"SAMPLED", write_sampled}, {"IDEALNAMES", write_ideal_names},
                                 {"SOLVE", write_solve},     {"SIZES", write_sizes},
                                 {"CASES", write_states},    {NULL, NULL}};

/* --- numbers, and words for a yes or no --- */

typedef struct CodeSize {
    const char *name;
    int value;
    const char *text; /* NULL: the number */
} CodeSize;

static int largest_function(const Code *code)
{
    int largest = 1;

    for (int f = 0; f < code->functions.count; f++) {
        const int count = code->functions.at[f].rows * code->functions.at[f].columns;

        largest = count > largest ? count : largest;
    }
    return largest;
}

/* what the step of smooth equations is called: step, or what a longer one is made of */
static const char *smooth_step(const Code *code)
{
    return code_has_modes(code) ? "smooth_step" : code_is_sampled(code) ? "step_between" : "step";
}

static void write_size(const Code *code, const Language *language, const char *name, size_t length,
                       Text *out)
{
    const VariableIndex *l = code->layout;
    const bool has_modes = code_has_modes(code), is_sampled = code_is_sampled(code);
    const int most = l->nx + l->nz + l->nu + l->m, ideals = code->modes.ideals.count;
    const int for_modes = 9 * (most + 1) * (most + 2) + 2 * (code->ny + code->ns) +
                          2 * code->modes.gives.count + 4 * ideals;
    int quaternions = 0;

    while (system_quaternion(l->system, quaternions) >= 0)
        quaternions++;

    const CodeSize sizes[] = {
        {"NP", code->parameters.count + code->derived_count, NULL},
        {"PARAMETERS", code->parameters.count, NULL},
        {"Q", l->n, NULL},
        {"U", l->nu, NULL},
        {"X", l->nx, NULL},
        {"A", l->multi_turns, NULL},
        {"Y", code->ny, NULL},
        {"Z", l->nz, NULL},
        {"M", l->m, NULL},
        {"S", code->ns, NULL},
        {"OUTPUTS", code->outputs.count, NULL},
        {"CONDITIONS", code->conditions.count, NULL},
        {"LARGEST", most, NULL},
        {"WORK", 2 * (most + 1) * (most + 2) + 8 * (code->ny + 1) + (has_modes ? for_modes : 0),
         NULL},
        {"QUATERNIONS", quaternions, NULL},
        {"STATES", code->states.count, NULL},
        {"FUNCTIONS", code->functions.count, NULL},
        {"ROOM", largest_function(code), NULL},
        {"SAMPLES", code->live.samples.count, NULL},
        {"IDEALS", ideals, NULL},
        {"EDGES", code->modes.gives.count / 2, NULL},
        {"CLOSED", code->modes.first + first_of(language), NULL},
        /* of smooth equations, and through modes */
        {"SMOOTH", 0, smooth_step(code)},
        {"STEP", 0, is_sampled ? "step_between" : "step"},
        {"STATIC", 0, has_modes || is_sampled ? "static " : ""},
        {"REDUNDANT", 0, language->truth[code->is_redundant]},
        {"MODES", 0, language->truth[has_modes]},
        {"CONST", 0, has_modes ? "" : "const "}, /* parameters of a step: modes change them */
        {"PROJECTED", 0, has_modes ? "model_drifted(p, t, y, work)" : "MODEL_OK"},
    };

    for (int i = 0; i < COUNT(sizes); i++)
        if (strlen(sizes[i].name) == length && strncmp(sizes[i].name, name, length) == 0) {
            if (sizes[i].text != NULL)
                text_add(out, sizes[i].text);
            else
                text_addf(out, "%d", sizes[i].value);
        }
}

/* --- texts --- */

static const CodeWord *word_find(const CodeWord *list, const char *name, size_t length)
{
    for (; list != NULL && list->name != NULL; list++)
        if (strlen(list->name) == length && strncmp(list->name, name, length) == 0)
            return list;
    return NULL;
}

void code_fill(const Code *code, const Language *language, const char *text, Text *out)
{
    for (const char *c = text, *end; *c != '\0'; c = end) {
        const CodeWord *word;
        size_t length;

        end = c + strcspn(c, "$");
        text_add_n(out, c, (size_t)(end - c));
        if (*end == '\0')
            break;
        length = strspn(++end, "ABCDEFGHIJKLMNOPQRSTUVWXYZ");
        word = word_find(language->words, end, length);
        if (word == NULL)
            word = word_find(words, end, length);
        if (word != NULL)
            word->write(code, language, out);
        else
            write_size(code, language, end, length, out);
        end += length;
    }
}

static bool has_text(const Code *code, CodeWhen when)
{
    switch (when) {
    case CODE_WITH_TABLES:
        return code->lowered.tables.count > 0;
    case CODE_WITH_MODES:
        return code_has_modes(code);
    case CODE_WITH_SAMPLES:
        return code_is_sampled(code);
    case CODE_WITH_REDUNDANCE:
        return code->is_redundant;
    case CODE_WITHOUT_REDUNDANCE:
        return !code->is_redundant;
    default:
        return true;
    }
}

void code_file(const Code *code, const Language *language, Text *out)
{
    const size_t from = out->length;

    if (language->file != NULL)
        language->file(code, language, out);
    for (const CodeText *part = language->texts; part != NULL && part->text != NULL; part++)
        if (has_text(code, part->when))
            code_fill(code, language, part->text, out);
    if (language->wrap != NULL)
        language->wrap(out, from);
}
