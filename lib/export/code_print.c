/* code_print.c: a function of numbers, line by line
 *
 * Only values that the function's entries need are written. A value that is used once is written
 * inside its user if lines remain short; any other is named, once. */
#include "export/code.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    LONGEST_PART = 72, /* letters of an inlined value */
    LONGEST_ARGUMENT = 24,
    WIDTH = 100, /* of a line; Fortran allows 132 */
    EXACT = 17
};

typedef enum Binding { BIND_SUM, BIND_NEGATIVE, BIND_PRODUCT, BIND_ATOM } Binding;

typedef struct CodePrintPart { /* a value in writing */
    char *text;                /* NULL: not written */
    Binding binding;
    bool is_exact; /* it is of the type of numbers: no literal or call in it */
} CodePrintPart;

typedef struct Printing {
    const Code *code;
    const Language *language;
    Text *out;
    Text locals;          /* names made, commas between */
    CodePrintPart *parts; /* one a value */
    int *uses;
    bool *needed;
    bool is_derived; /* derived parameters are what is written */
    int named;
    char *calls[OP_COUNT];
} Printing;

/* --- lines --- */

/* where a line may end: after a blank, or after a sign between factors */
static size_t breaking(const char *text, size_t most)
{
    size_t at = 0;

    for (size_t i = 1; i < most && text[i] != '\0'; i++)
        if (text[i] == ' ' || (text[i] == '*' && text[i + 1] != '*' && text[i - 1] != '*'))
            at = i + 1;
    return at > 0 ? at : most;
}

static void write_line(Text *out, const Language *language, const char *text)
{
    text_add(out, "    ");
    for (bool first = true; strlen(text) > WIDTH; first = false) {
        const size_t length = breaking(text, first ? WIDTH : WIDTH - 4);

        text_add_n(out, text, length);
        text_addf(out, "%s\n        ", language->onward);
        text += length;
    }
    text_addf(out, "%s\n", text);
}

static int first_of(const Language *language)
{
    return notation_row(language->notation)->first;
}

void code_element(const Language *language, const char *name, int i, Text *out)
{
    text_addf(out, language->array, name, i + first_of(language)); /* NOLINT: a format of ours */
}

static void write_assignment(Text *out, const Language *language, const char *form,
                             const char *left, const char *right)
{
    Text line = {0};

    text_addf(&line, form, left, right); /* NOLINT: a format of ours */
    write_line(out, language, line.at);
    text_free(&line);
}

void code_set(const Language *language, const char *left, const char *right, Text *out)
{
    write_assignment(out, language, language->result, left, right);
}

void code_number(const Language *language, double value, Text *out)
{
    Text digits = {0};

    text_number(&digits, value, EXACT);
    if (language->number != NULL && strpbrk(digits.at, ".ein") == NULL)
        text_add(&digits, ".0");
    text_addf(out, language->number != NULL ? language->number : "%s", digits.at);
    text_free(&digits);
}

void code_set_array(const Language *language, const char *name, const double *values, int count,
                    Text *out)
{
    for (int i = 0; i < count; i++) {
        Text left = {0}, number = {0}, right = {0};

        code_element(language, name, i, &left);
        code_number(language, values[i], &number);
        text_addf(&right, language->rounded != NULL ? language->rounded : "%s", number.at);
        code_set(language, left.at, right.at, out);
        text_free(&left);
        text_free(&number);
        text_free(&right);
    }
}

/* --- values --- */

static const LoweredValue *value_of(const Printing *pr, uint32_t v)
{
    return &pr->code->lowered.values.at[v];
}

/* the number of a derived parameter; -1: it is none */
static int given(const Printing *pr, uint32_t v)
{
    return pr->is_derived ? -1 : pr->code->derived[v];
}

static bool is_operation(const Printing *pr, uint32_t v)
{
    const LoweredValue *value = value_of(pr, v);

    return value->code != CODE_INPUT && value->code != CODE_CONSTANT && given(pr, v) < 0;
}

/* a cosine is computed by itself */
static uint32_t argument_of(const Printing *pr, uint32_t v, int i)
{
    const LoweredValue *value = value_of(pr, v);

    return value->code == CODE_COSINE ? value_of(pr, value->args[0])->args[0] : value->args[i];
}

static void mark_needed(Printing *pr, const uint32_t *roots, int count)
{
    const int values = pr->code->lowered.values.count;

    for (int i = 0; i < count; i++) {
        pr->needed[roots[i]] = true;
        pr->uses[roots[i]]++;
    }
    for (int v = values - 1; v >= 0; v--)
        if (pr->needed[v] && is_operation(pr, (uint32_t)v))
            for (int i = 0; i < code_operands(value_of(pr, (uint32_t)v)->code); i++) {
                const uint32_t a = argument_of(pr, (uint32_t)v, i);

                pr->needed[a] = true;
                pr->uses[a]++;
            }
}

static void set_part(Printing *pr, uint32_t v, Text *text, Binding binding, bool is_exact)
{
    pr->parts[v] = (CodePrintPart){text_done(text), binding, is_exact};
}

/* the text of its argument: "y[3]" */
static void source(const Printing *pr, const CodeInput *input, Text *out)
{
    static const char *const arrays[] = {"p", "t", "y", "s"};

    if (input->array == CODE_T)
        text_add(out, "t");
    else
        code_element(pr->language, arrays[input->array], input->place, out);
}

static void write_input(Printing *pr, uint32_t v)
{
    const CodeInput *input = &pr->code->inputs.at[value_of(pr, v)->args[0]];
    Text name = {0}, from = {0};

    text_add(&name, input->array == CODE_T ? "t" : input->name);
    if (input->array != CODE_T) {
        source(pr, input, &from);
        write_assignment(pr->out, pr->language, pr->language->local, input->name, from.at);
        text_addf(&pr->locals, "%s%s", pr->locals.length > 0 ? ", " : "", input->name);
        text_free(&from);
    }
    set_part(pr, v, &name, BIND_ATOM, true);
}

static void write_constant(Printing *pr, uint32_t v)
{
    const double value = value_constant(value_of(pr, v));
    Text text = {0};

    code_number(pr->language, value, &text);
    set_part(pr, v, &text, value < 0 ? BIND_NEGATIVE : BIND_ATOM, false);
}

static void add_part(const Printing *pr, uint32_t v, Binding least, Text *out)
{
    const CodePrintPart *part = &pr->parts[v];

    text_addf(out, part->binding < least ? "(%s)" : "%s", part->text);
}

static void compose_call(Printing *pr, uint32_t v, Op op, Text *out)
{
    if (pr->calls[op] == NULL)
        pr->calls[op] = op_code(op, pr->language->notation);
    for (const char *c = pr->calls[op]; *c != '\0';) {
        const size_t plain = strcspn(c, "$%");

        text_add_n(out, c, plain);
        c += plain;
        if (*c == '\0')
            break;
        add_part(pr, argument_of(pr, v, c[1] - '0'), *c == '%' ? BIND_ATOM : BIND_SUM, out);
        c += 2;
    }
}

/* the spline of a table, "model_table(table_1, x, order)" */
static void compose_table(const Printing *pr, uint32_t v, Text *out)
{
    const LoweredValue *value = value_of(pr, v);

    text_addf(out, "model_table(%d, ", 1 + (int)value_constant(value_of(pr, value->args[0])));
    add_part(pr, value->args[1], BIND_SUM, out);
    text_addf(out, ", %d)", (int)value_constant(value_of(pr, value->args[2])));
}

static void compose(Printing *pr, uint32_t v)
{
    static const struct {
        const char *sign;
        Binding binding, left, right;
    } binary[] = {[CODE_ADD] = {" + ", BIND_SUM, BIND_SUM, BIND_NEGATIVE + 1},
                  [CODE_SUB] = {" - ", BIND_SUM, BIND_SUM, BIND_NEGATIVE + 1},
                  [CODE_MUL] = {"*", BIND_PRODUCT, BIND_PRODUCT, BIND_ATOM}};
    const LoweredValue *value = value_of(pr, v);
    Binding binding = BIND_ATOM;
    bool is_exact = false;
    Text text = {0};

    switch (value->code) {
    case CODE_ADD:
    case CODE_SUB:
    case CODE_MUL:
        binding = binary[value->code].binding;
        add_part(pr, value->args[0], binary[value->code].left, &text);
        text_add(&text, binary[value->code].sign);
        add_part(pr, value->args[1], binary[value->code].right, &text);
        is_exact = pr->parts[value->args[0]].is_exact && pr->parts[value->args[1]].is_exact;
        break;
    case CODE_NEG:
        binding = BIND_NEGATIVE;
        text_char(&text, '-');
        add_part(pr, value->args[0], BIND_PRODUCT, &text);
        is_exact = pr->parts[value->args[0]].is_exact;
        break;
    case CODE_RECIP:
        binding = BIND_PRODUCT;
        code_number(pr->language, 1, &text);
        text_char(&text, '/');
        add_part(pr, value->args[0], BIND_ATOM, &text);
        break;
    case CODE_POW:
        text_add(&text, pr->language->power[0]);
        add_part(pr, value->args[0], BIND_ATOM, &text);
        text_add(&text, pr->language->power[1]);
        add_part(pr, value->args[1], BIND_ATOM, &text);
        text_add(&text, pr->language->power[2]);
        break;
    case CODE_SQRT:
        compose_call(pr, v, OP_SQRT, &text);
        break;
    case CODE_SIN:
    case CODE_SINCOS:
        compose_call(pr, v, OP_SIN, &text);
        break;
    case CODE_COS:
    case CODE_COSINE:
        compose_call(pr, v, OP_COS, &text);
        break;
    case CODE_SELECT:
        compose_call(pr, v, OP_IF, &text);
        break;
    case CODE_CALL + OP_TABLE:
        compose_table(pr, v, &text);
        break;
    default:
        compose_call(pr, v, (Op)(value->code - CODE_CALL), &text);
    }
    set_part(pr, v, &text, binding, is_exact);
}

/* of the type of numbers, where an operation may have left that */
static void rounded(const Printing *pr, const CodePrintPart *part, Text *out)
{
    if (pr->language->rounded != NULL && !part->is_exact)
        text_addf(out, pr->language->rounded, part->text); /* NOLINT: a format of ours */
    else
        text_add(out, part->text);
}

/* a name for it */
static void name_value(Printing *pr, uint32_t v)
{
    CodePrintPart *part = &pr->parts[v];
    Text text = {0};
    char name[24];

    (void)snprintf(name, sizeof name, "v%d", ++pr->named);
    rounded(pr, part, &text);
    write_assignment(pr->out, pr->language, pr->language->local, name, text.at);
    text_addf(&pr->locals, "%s%s", pr->locals.length > 0 ? ", " : "", name);
    text_free(&text);
    mem_free(part->text);
    *part = (CodePrintPart){mem_text(name, strlen(name)), BIND_ATOM, true};
}

/* patterns may write an argument twice, and read it between operators */
static bool is_call(const LoweredValue *value)
{
    return value->code == CODE_POW || value->code == CODE_SELECT || value->code >= CODE_CALL;
}

static void write_value(Printing *pr, uint32_t v)
{
    const LoweredValue *value = value_of(pr, v);

    if (value->code == CODE_INPUT)
        write_input(pr, v);
    else if (value->code == CODE_CONSTANT)
        write_constant(pr, v);
    else if (given(pr, v) >= 0) {
        Text text = {0};

        code_element(pr->language, "p", given(pr, v), &text);
        set_part(pr, v, &text, BIND_ATOM, true);
    } else {
        for (int i = 0; i < code_operands(value->code); i++) {
            const uint32_t a = argument_of(pr, v, i);

            if (is_call(value) && is_operation(pr, a) && pr->parts[a].binding != BIND_ATOM &&
                strlen(pr->parts[a].text) > LONGEST_ARGUMENT)
                name_value(pr, a);
        }
        compose(pr, v);
        if (pr->uses[v] > 1 || strlen(pr->parts[v].text) > LONGEST_PART)
            name_value(pr, v);
    }
}

/* --- functions --- */

static Printing printing(const Code *code, const Language *language, Text *out)
{
    const int values = code->lowered.values.count;

    return (Printing){.code = code,
                      .language = language,
                      .out = out,
                      .parts = NEW_ARRAY(CodePrintPart, values),
                      .uses = NEW_ARRAY(int, values),
                      .needed = NEW_ARRAY(bool, values)};
}

static void printing_free(Printing *pr)
{
    for (int v = 0; v < pr->code->lowered.values.count; v++)
        mem_free(pr->parts[v].text);
    for (int i = 0; i < OP_COUNT; i++)
        mem_free(pr->calls[i]);
    text_free(&pr->locals);
    MEM_FREE(pr->parts, pr->uses, pr->needed);
}

static void write_values(Printing *pr)
{
    for (int v = 0; v < pr->code->lowered.values.count; v++)
        if (pr->needed[v])
            write_value(pr, (uint32_t)v);
}

static void write_result(Printing *pr, const char *left, uint32_t v)
{
    Text right = {0};

    rounded(pr, &pr->parts[v], &right);
    code_set(pr->language, left, right.at, pr->out);
    text_free(&right);
}

void code_print(const Code *code, int function, const Language *language, Text *out)
{
    const CodeFunction *f = &code->functions.at[function];
    const uint32_t *roots = code->lowered.roots + f->first;
    const int count = f->rows * f->columns;
    Text body = {0};
    Printing pr = printing(code, language, &body);

    mark_needed(&pr, roots, count);
    write_values(&pr);
    for (int i = 0; i < count; i++) {
        const LoweredValue *value = value_of(&pr, roots[i]);
        Text left = {0};

        if (value->code == CODE_CONSTANT && value_constant(value) == 0)
            continue;
        if (!f->is_matrix || language->matrix == NULL)
            code_element(language, "out", i, &left);
        else
            text_addf(&left, language->matrix, "out", i / f->columns + first_of(language),
                      i % f->columns + first_of(language)); /* NOLINT: a format of ours */
        write_result(&pr, left.at, roots[i]);
        text_free(&left);
    }
    language->open(out, code, f, pr.locals.at != NULL ? pr.locals.at : "");
    if (body.length > 0)
        text_add(out, body.at);
    text_add(out, language->close);
    text_free(&body);
    printing_free(&pr);
}

char *code_print_derived(const Code *code, const Language *language, Text *out)
{
    Printing pr = printing(code, language, out);
    LIST(uint32_t) roots = {0};
    char *locals;

    pr.is_derived = true;
    for (int v = 0; v < code->lowered.values.count; v++)
        if (code->derived[v] >= 0)
            LIST_PUSH(roots, (uint32_t)v);
    mark_needed(&pr, roots.at, roots.count);
    write_values(&pr);
    for (int i = 0; i < roots.count; i++) {
        Text left = {0};

        code_element(language, "p", code->derived[roots.at[i]], &left);
        write_result(&pr, left.at, roots.at[i]);
        text_free(&left);
    }
    LIST_FREE(roots);
    locals = text_done(&pr.locals);
    printing_free(&pr);
    return locals;
}

OpCount code_count(const Code *code, int function)
{
    static const OpCount counts[CODE_CALL] = {
#define OPCODE(id, operands, adds, muls, functions, ...) {adds, muls, functions},
#include "compile/opcodes.def"
#undef OPCODE
        [CODE_SINCOS] = {0, 0, 1},
    };
    const CodeFunction *f = &code->functions.at[function];
    Printing pr = printing(code, NULL, NULL);
    OpCount total = {0};

    mark_needed(&pr, code->lowered.roots + f->first, f->rows * f->columns);
    for (int v = 0; v < code->lowered.values.count; v++)
        if (pr.needed[v] && is_operation(&pr, (uint32_t)v)) {
            const Opcode opcode = value_of(&pr, (uint32_t)v)->code;

            total = op_count_plus(total, opcode < CODE_CALL ? counts[opcode] : (OpCount){0, 0, 1});
        }
    printing_free(&pr);
    return total;
}
