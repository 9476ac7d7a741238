/* narrative.c: words and steps of a derivation, in text and in LaTeX */
#include "present/narrative.h"
#include "present/latex_lines.h"

#include <stdio.h>
#include <string.h>

#define LABEL 12 /* columns of the word before a step */

bool narrative_is_typeset(const View *view)
{
    return view_kind(view) == NOTATION_TYPESET;
}

void narrative_add_word(Text *out, const View *view, const char *word)
{
    if (narrative_is_typeset(view))
        latex_text(out, word);
    else
        text_add(out, word);
}

void narrative_add_mark(Text *out, const View *view)
{
    text_add(out, narrative_is_typeset(view) ? "$" : "");
}

void narrative_add_formula(Text *out, const View *view, Expr e)
{
    narrative_add_mark(out, view);
    view_add(out, view, e);
    narrative_add_mark(out, view);
}

const char *narrative_edge(const View *view, int edge)
{
    return graph_edge(model_graph(view->model), edge)->name;
}

void narrative_add_variable(Text *out, const View *view, const EdgeVariable *variable, int edge)
{
    const bool is_typeset = narrative_is_typeset(view);

    text_addf(out,
              !is_typeset           ? "%s("
              : variable->is_vector ? "\\underline{%s}_{\\mathrm{"
                                    : "%s_{\\mathrm{",
              is_typeset ? variable->latex : variable->text);
    narrative_add_word(out, view, narrative_edge(view, edge));
    text_add(out, is_typeset ? "}}" : ")");
}

SumOrder narrative_order(const int *sign, int count, size_t stride)
{
    SumOrder order = {0, 1, count};

    if (count <= 0 || sign[0] > 0)
        return order;
    for (int i = count - 1; i > 0; i--)
        if (*(const int *)((const char *)sign + (size_t)i * stride) > 0) {
            order.first = i;
            if (i == count - 1)
                order.step = -1;
            break;
        }
    return order;
}

void narrative_add_edge_sum(Text *out, const View *view, const EdgeVariable *variable, int edge,
                            const SignedEdge *terms, int count)
{
    const SumOrder order =
        edge < 0 ? (SumOrder){0, 1, count}
                 : narrative_order(count > 0 ? &terms->sign : NULL, count, sizeof *terms);

    narrative_add_mark(out, view);
    if (edge >= 0) {
        narrative_add_variable(out, view, variable, edge);
        text_add(out, count > 0 ? " = " : " = 0");
    }
    for (int k = 0; k < count; k++) {
        const SignedEdge *term = &terms[narrative_at(&order, k)];

        text_add(out, k == 0 ? term->sign < 0 ? "-" : "" : term->sign < 0 ? " - " : " + ");
        narrative_add_variable(out, view, variable, term->edge);
    }
    text_add(out, edge < 0 ? " = 0" : "");
    narrative_add_mark(out, view);
}

/* a step: its word, then its text */
void narrative_add(Text *out, const View *view, const char *label, const char *words)
{
    char lead[LABEL + 1];

    if (narrative_is_typeset(view)) {
        text_addf(out, "\\noindent\\emph{%s} %s\n\n", label, words);
        return;
    }
    if (words[0] == '\0') {
        text_addf(out, "%s\n", label);
        return;
    }
    (void)snprintf(lead, sizeof lead, "%-*s", LABEL, label);
    layout_words(out, view->page.columns, lead, words);
}

void narrative_add_done(Text *out, const View *view, const char *label, Text *words)
{
    if (words->length > 0)
        narrative_add(out, view, label, words->at);
    text_free(words);
}

static void write_title(Text *out, const View *view, const char *words)
{
    if (narrative_is_typeset(view))
        text_addf(out, "\\paragraph{%s}\n\n", words);
    else
        layout_words(out, view->page.columns, "", words);
}

static void add_components(Text *out, const View *view, const Expr *at, int count)
{
    for (int i = 0; i < count; i++) {
        text_add(out, i > 0 ? ", " : "[");
        narrative_add_formula(out, view, at[i]);
    }
    text_char(out, ']');
}

void narrative_add_vector(Text *out, const View *view, const Expr at[3])
{
    add_components(out, view, at, model_is_planar(view->model) ? 2 : 3);
}

const char *narrative_node(const View *view, int node)
{
    return graph_node(model_graph(view->model), node)->name;
}

bool narrative_is_nothing(const Expr at[3])
{
    return expr_is_zero(at[0]) && expr_is_zero(at[1]) && expr_is_zero(at[2]);
}

/* "x of ground", "[1, 2, 0] of m1": a direction */
void narrative_add_direction(Text *out, const View *view, const NarrativeVector *v)
{
    int axis = -1, others = 0;

    for (int i = 0; i < 3; i++) {
        if (expr_is(v->at[i], 1) || expr_is(v->at[i], -1))
            axis = i;
        else
            others += !expr_is_zero(v->at[i]);
    }
    if (axis >= 0 && others == 0 && expr_is_zero(v->at[(axis + 1) % 3]) &&
        expr_is_zero(v->at[(axis + 2) % 3])) {
        text_addf(out, "%s%c", expr_is(v->at[axis], -1) ? "-" : "", "xyz"[axis]);
    } else {
        add_components(out, view, v->at, 3);
    }
    text_add(out, " of ");
    narrative_add_word(out, view, narrative_node(view, v->node));
}

/* --- terms, and those that vanish --- */

void narrative_vanish(Narrative *story, const char *name, const char *why)
{
    int i = 0;

    while (i < story->reasons.count && strcmp(story->reasons.at[i].why, why) != 0)
        i++;
    if (i == story->reasons.count) {
        LIST_PUSH(story->reasons, (Reason){.why = why, .names = {0}});
    }
    layout_item(&story->reasons.at[i].names, name);
}

/* a line for each reason, once terms are written */
void narrative_add_vanished(Narrative *story)
{
    for (int i = 0; i < story->reasons.count; i++) {
        Text words = {0};

        narrative_add_word(&words, story->view, story->reasons.at[i].names.at);
        text_addf(&words, ": %s", story->reasons.at[i].why);
        narrative_add_done(story->out, story->view, i == 0 ? "vanish" : "", &words);
        text_free(&story->reasons.at[i].names);
    }
    LIST_FREE(story->reasons);
}

void narrative_title(Narrative *story, Text *title)
{
    if (story->out->length > 0)
        text_char(story->out, '\n');
    write_title(story->out, story->view, title->at);
    text_free(title);
}

/* the equation that the steps led to */
void narrative_add_equations(Narrative *story)
{
    narrative_add(story->out, story->view, "equation", "");
    view_block(story->out, story->view, &story->equations);
}
