/* code_head.c: description at the head of exported files */
#include "export/code.h"

#include "present/count.h"

#include <inttypes.h>

typedef struct Heading {
    const Language *language;
    const char *lead;
    Text *out;
} Heading;

/* A line; what would end a comment of C doesn't. */
static void say(const Heading *head, Text *line)
{
    text_add(head->out, head->lead);
    for (const char *c = line->at != NULL ? line->at : ""; *c != '\0'; c++) {
        if ((*c == '/' && c > line->at && c[-1] == '*') ||
            (*c == '*' && c > line->at && c[-1] == '/'))
            text_char(head->out, ' ');
        text_char(head->out, *c == '\n' || *c == '\\' ? ' ' : *c);
    }
    while (head->out->length > 0 && head->out->at[head->out->length - 1] == ' ')
        head->out->at[--head->out->length] = '\0';
    text_char(head->out, '\n');
    text_free(line);
}

#define SAY(head, ...)                                                                             \
    do {                                                                                           \
        Text line_ = {0};                                                                          \
        text_addf(&line_, __VA_ARGS__);                                                            \
        say(head, &line_);                                                                         \
    } while (0)

/* "p[3]  L4 = 0.1" */
static void write_entry(const Heading *head, const char *array, int i, const char *name,
                        const char *more)
{
    Text line = {0};

    text_addf(&line, "  ");
    code_element(head->language, array, i, &line);
    text_addf(&line, "  %s%s", name, more);
    say(head, &line);
}

static void write_parameters(const Code *code, const Heading *head)
{
    if (code->parameters.count > 0)
        SAY(head, "p: parameters (SI), and behind them what follows from them");
    for (int i = 0; i < code->parameters.count; i++) {
        Text value = {0};

        text_add(&value, " = ");
        text_number(&value, code->values[i], 17);
        write_entry(head, "p", i, expr_name(code->parameters.at[i]), value.at);
        text_free(&value);
    }
}

static void write_part(const Heading *head, const Code *code, const char *array, int at, int first,
                       int count, const char *what, const char *per)
{
    const VariableIndex *l = code->layout;

    for (int i = 0; i < count; i++) {
        Text more = {0};
        const bool is_q = first == l->q && i < l->n;

        if (i == 0)
            text_addf(&more, "  (%s)", what);
        if (is_q && system_q(l->system, i)->is_angle)
            text_addf(&more, "  rad%s", per);
        write_entry(head, array, at + i, expr_name(l->symbols[first + i]),
                    more.at != NULL ? more.at : "");
        text_free(&more);
    }
}

static void write_variables(const Code *code, const Heading *head)
{
    const VariableIndex *l = code->layout;
    const int k = l->nx + l->nz;

    SAY(head, "y: state (SI: m, rad, m/s, rad/s, V, A ...)");
    write_part(head, code, "y", 0, l->q, l->n, "coordinates", "");
    write_part(head, code, "y", l->n, l->u, l->nu, "speeds", "");
    write_part(head, code, "y", l->n + l->nu, l->x, l->nx, "network states", "");
    write_part(head, code, "y", variable_index_references(l), l->references, l->multi_turns,
               "what angles over full turns lie next to", "");
    SAY(head, "s: solved for");
    write_part(head, code, "s", 0, l->rates, l->nx, "rates of network states", "");
    write_part(head, code, "s", l->nx, l->z, l->nz, "algebraic unknowns", "");
    write_part(head, code, "s", k, l->acceleration, l->nu, "accelerations", "");
    write_part(head, code, "s", k + l->nu, l->multipliers, l->m, "multipliers", "");
}

static void write_functions(const Code *code, const Heading *head)
{
    SAY(head, "functions of (p, t, y, s), with additions, multiplications, function calls:");
    for (int f = 0; f < code->functions.count; f++) {
        const CodeFunction *function = &code->functions.at[f];
        const OpCount count = code_count(code, f);

        if (function->rows * function->columns > 0)
            SAY(head, "  %s: %s, %d x %d  (%" PRId64 ", %" PRId64 ", %" PRId64 ")", function->name,
                function->what, function->rows, function->columns, count.add, count.mul, count.fun);
    }
}

void code_head(const Code *code, const Language *language, const char *lead, Text *out)
{
    const Heading head = {language, lead, out};
    const Model *model = code->view->model;
    const char *title = model_title(model);
    const Tree *trees[TREE_KINDS];
    Diag unused;
    char *brief =
        model_trees(model, trees, &unused) == OK ? tree_brief(model, trees) : mem_text("", 0);

    SAY(&head, "%s", title != NULL && title[0] != '\0' ? title : "equations of motion");
    SAY(&head, "%s", "");
    SAY(&head, "q' = N u,  Phi(q, t) = 0,  Phi_u u = nu,  Phi_u u' = gamma,");
    SAY(&head, "M u' + Phi_u^T lambda = F,  A [x'; z] = b");
    if (code->is_augmented)
        SAY(&head, "(%s)", form_too_long);
    if (brief[0] != '\0')
        SAY(&head, "trees: %s", brief);
    SAY(&head, "%s", "");
    write_parameters(code, &head);
    write_variables(code, &head);
    for (int i = 0; i < code->outputs.count; i++)
        write_entry(&head, "outputs", i, code->outputs.at[i], "");
    for (int i = 0; i < code->conditions.count; i++)
        write_entry(&head, "conditions", i, code->conditions.at[i], "");
    write_functions(code, &head);
    SAY(&head, "%s", "");
    if (!code->live.is_wanted)
        SAY(&head, "It checks itself by numbers from where it was made:  %s", language->check);
    mem_free(brief);
}
