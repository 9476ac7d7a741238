/* show_derivation.c: `show derivation`: how an equation came about, step by step
 *
 * A constraint: the circuit of its chord in edges, the branches' vectors, what they are projected
 * on. A row of motion: the cutset of its branch, what a unit of its speed moves, and for each entry
 * the terms. A row of a network: the laws, circuits and cutsets that were followed. Terms that are
 * 0 are gathered by the reason. Each step is a line behind a word. */
#include "formulate/derivation.h"
#include "present/info.h"
#include "present/show.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LABEL 12 /* columns of the word before a step */

/* --- words in the notation --- */

static bool is_typeset(const View *view)
{
    return view_kind(view) == NOTATION_TYPESET;
}

static void add_word(Text *out, const View *view, const char *word)
{
    for (const char *c = word; *c != '\0'; c++) {
        if (is_typeset(view) && strchr("_#%&$", *c) != NULL)
            text_char(out, '\\');
        text_char(out, *c);
    }
}

static void add_formula(Text *out, const View *view, Expr e)
{
    char *text = view_expression(view, system_plain(view->system, e));

    text_addf(out, is_typeset(view) ? "$%s$" : "%s", text);
    mem_free(text);
}

static const char *edge_name_of(const View *view, int edge)
{
    return graph_edge(model_graph(view->model), edge)->name;
}

/* "r(h9)": a variable of an edge */
static void add_variable(Text *out, const View *view, const char *letter, bool is_vector, int edge)
{
    text_addf(out,
              !is_typeset(view) ? "%s("
              : is_vector       ? "\\underline{%s}_{\\mathrm{"
                                : "%s_{\\mathrm{",
              letter);
    add_word(out, view, edge_name_of(view, edge));
    text_add(out, is_typeset(view) ? "}}" : ")");
}

static void add_signed(Text *out, int sign, bool first)
{
    if (first)
        text_add(out, sign < 0 ? "-" : "");
    else
        text_add(out, sign < 0 ? " - " : " + ");
}

/* a step: its word, then what it says */
static void say(Text *out, const View *view, const char *label, const char *words)
{
    char lead[LABEL + 1];

    if (is_typeset(view)) {
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

static void say_done(Text *out, const View *view, const char *label, Text *words)
{
    if (words->length > 0)
        say(out, view, label, words->at);
    text_free(words);
}

static void say_title(Text *out, const View *view, const char *words)
{
    if (is_typeset(view))
        text_addf(out, "\\paragraph{%s}\n\n", words);
    else
        layout_words(out, view->page.columns, "", words);
}

/* "[L6, 0]": in a plane two components */
static void add_vector(Text *out, const View *view, const Expr at[3])
{
    const int count = model_is_planar(view->model) ? 2 : 3;

    text_char(out, '[');
    for (int i = 0; i < count; i++) {
        text_add(out, i > 0 ? ", " : "");
        add_formula(out, view, at[i]);
    }
    text_char(out, ']');
}

static const char *node_name(const View *view, int node)
{
    return graph_node(model_graph(view->model), node)->name;
}

static bool is_nothing(const Expr at[3])
{
    return expr_is_zero(at[0]) && expr_is_zero(at[1]) && expr_is_zero(at[2]);
}

/* "x of ground", "[1, 2, 0] of m1": a direction */
static void add_direction(Text *out, const View *view, const ToldVector *v)
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
        text_char(out, '[');
        for (int i = 0; i < 3; i++) {
            text_add(out, i > 0 ? ", " : "");
            add_formula(out, view, v->at[i]);
        }
        text_char(out, ']');
    }
    text_add(out, " of ");
    add_word(out, view, node_name(view, v->node));
}

/* --- terms, and those that vanish --- */

typedef struct Reason {
    const char *why; /* borrowed */
    Text names;
} Reason;

typedef struct Story {
    const View *view;
    Text *out;
    LIST(Reason) reasons;
    Equations equations;
} Story;

static void vanish(Story *story, const char *name, const char *why)
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
static void say_vanished(Story *story)
{
    for (int i = 0; i < story->reasons.count; i++) {
        Text words = {0};

        add_word(&words, story->view, story->reasons.at[i].names.at);
        text_addf(&words, ": %s", story->reasons.at[i].why);
        say_done(story->out, story->view, i == 0 ? "vanish" : "", &words);
        text_free(&story->reasons.at[i].names);
    }
    LIST_FREE(story->reasons);
}

/* what a term is of, in words */
static void add_term_name(Text *out, const View *view, Block block, const Term *term)
{
    static const char *const of_mass[] = {
        [TERM_MASS] = "m v.v", [TERM_INERTIA] = "w.I.w", [TERM_ROTOR] = "rotor"};
    static const char *const of_force[] = {
        [TERM_MASS] = "-m v.a", [TERM_INERTIA] = "-w.h'", [TERM_WEIGHT] = "weight",
        [TERM_FORCE] = "F.v",   [TERM_TORQUE] = "T.w",    [TERM_EFFORT] = "effort",
        [TERM_ROTOR] = "rotor", [TERM_DRIVE] = "drive"};
    static const char *const of_constraint[] = {[TERM_WHOLE] = "itself", [TERM_ASKED] = "asked"};

    if (term->edge >= 0) {
        text_addf(out, "%s%s", term->sign < 0 ? "-" : "+", edge_name_of(view, term->edge));
        return;
    }
    text_addf(out, "%s %s", system_instance_name(view->system, term->instance),
              block == BLOCK_MASS     ? of_mass[term->kind]
              : block == BLOCK_FORCES ? of_force[term->kind]
                                      : of_constraint[term->kind]);
}

/* --- circuits --- */

/* "r(h9) = r(r6) - r(r7) ..." */
static void say_way(Text *out, const View *view, int chord, const Way *way)
{
    Text words = {0};

    text_add(&words, is_typeset(view) ? "$" : "");
    add_variable(&words, view, "r", true, chord);
    text_add(&words, " = ");
    for (int i = 0; i < way->count; i++) {
        add_signed(&words, way->at[i].sign, i == 0);
        add_variable(&words, view, "r", true, way->at[i].edge);
    }
    text_addf(&words, "%s%s, the circuit of ", way->count == 0 ? "0" : "",
              is_typeset(view) ? "$" : "");
    add_word(&words, view, edge_name_of(view, chord));
    text_add(&words, " in the translation tree");
    say_done(out, view, "circuit", &words);
}

/* "turned by h8": what the orientation of a frame was replaced by */
static void add_turned(Text *out, const View *view, int node)
{
    Angles angles = {0};

    system_angles(view->system, node, &angles);
    for (int i = 0; i < angles.count; i++) {
        text_add(out, i == 0 ? ", turned by " : ", then ");
        if (angles.at[i] == NULL)
            text_add(out, "Euler parameters");
        else
            add_formula(out, view, angles.at[i]);
    }
    LIST_FREE(angles);
}

static void say_vectors(Text *out, const View *view, const Way *way)
{
    bool first = true;

    for (int i = 0; i < way->count; i++) {
        const WayStep *step = &way->at[i];
        Text words = {0};

        if (is_nothing(step->shift.at))
            continue;
        text_add(&words, is_typeset(view) ? "$" : "");
        add_variable(&words, view, "r", true, step->edge);
        text_addf(&words, "%s = ", is_typeset(view) ? "$" : "");
        add_vector(&words, view, step->shift.at);
        text_add(&words, " in ");
        add_word(&words, view, node_name(view, step->shift.node));
        add_turned(&words, view, step->shift.node);
        say_done(out, view, first ? "substituted" : "", &words);
        first = false;
    }
}

/* the rotation circuit, angles or angular velocities, in edges */
static void say_turns(Text *out, const View *view, int chord)
{
    const Tree *trees[TREE_KINDS];
    const Edge *edge = graph_edge(model_graph(view->model), chord);
    Diag ignored = {0};
    Text words = {0};

    if (model_trees(view->model, trees, &ignored) != OK)
        return;

    const Tree *tree = trees[TREE_ROTATION];
    const int room = tree_depth(tree, edge->tail) + tree_depth(tree, edge->head);
    int *edges = NEW_ARRAY(int, 2 * room + 1);
    const int count = tree_path(tree, edge->tail, edge->head, edges, edges + room);

    text_add(&words, is_typeset(view) ? "$" : "");
    add_variable(&words, view, is_typeset(view) ? "\\omega" : "w", true, chord);
    text_add(&words, " = ");
    for (int i = 0; i < count; i++) {
        add_signed(&words, edges[room + i], i == 0);
        add_variable(&words, view, is_typeset(view) ? "\\omega" : "w", true, edges[i]);
    }
    text_addf(&words, "%s%s, the circuit of ", count == 0 ? "0" : "", is_typeset(view) ? "$" : "");
    add_word(&words, view, edge->name);
    text_add(&words, " in the rotation tree");
    say_done(out, view, "circuit", &words);
    mem_free(edges);
}

static void say_projection(Text *out, const View *view, int row)
{
    const ConstraintRow *told = system_constraint(view->system, row);
    const Projection on = system_projection(view->system, row);
    Text words = {0};

    switch (on.along) {
    case ALONG_AXIS:
        text_add(&words, "on ");
        add_direction(&words, view, &on.a);
        text_add(&words, ", along which it carries a force");
        break;
    case ALONG_SQUARE:
        text_add(&words, "on the moment that keeps ");
        add_direction(&words, view, &on.a);
        text_add(&words, " square to ");
        add_direction(&words, view, &on.b);
        text_add(&words, ": their product is 0");
        break;
    case ALONG_TURN:
        text_add(&words, "on ");
        add_direction(&words, view, &on.a);
        text_add(&words, ", about which it carries a moment: the turns add up");
        break;
    case ALONG_TIE:
        text_add(&words, "on the wrench along ");
        add_direction(&words, view, &on.a);
        text_add(&words, " that does no work: the shift follows the turn");
        break;
    case ALONG_DRIVEN:
        add_word(&words, view, system_instance_name(view->system, told->instance));
        text_add(&words, " asks for the coordinate, with an unknown effort");
        break;
    }
    say_done(out, view, "projected", &words);
}

/* --- terms of an entry --- */

/* why a term of a constraint is 0 */
static const char *why_nothing_along(const Term *term, const Way *way)
{
    for (int i = 0; i < way->count; i++)
        if (way->at[i].edge == term->edge && is_nothing(way->at[i].shift.at))
            return "their ends stay together";
    return "square to that direction";
}

typedef struct Moved { /* what the two speeds of an entry of M, or the one of F, move */
    UnitMotions by[2];
} Moved;

static const char *why_at_rest(const Term *term, const Moved *moved, Block block)
{
    const bool turning = term->kind == TERM_INERTIA;

    for (int k = 0; k < (block == BLOCK_MASS ? 2 : 1); k++)
        for (int i = 0; i < moved->by[k].count; i++) {
            const UnitMotion *motion = &moved->by[k].at[i];

            if (motion->instance != term->instance)
                continue;
            if (turning && is_nothing(motion->w.at))
                return block == BLOCK_MASS ? "not turned by both speeds" : "not turned by it";
            if (!turning && motion->v.count == 0)
                return block == BLOCK_MASS ? "not moved by both speeds" : "not moved by it";
        }
    if (term->kind == TERM_WEIGHT)
        return "square to gravity, or there is none";
    if (block == BLOCK_FORCES)
        return "nothing along that motion";
    return turning ? "the two turns are square, or the inertia is 0"
                   : "the two motions are square, or the mass is 0";
}

/* The terms of an entry, those that vanish by their reasons, and the entry itself. */
static Status say_entry(Story *story, Block block, const char *letter, int row, int column,
                        const Way *way, const Moved *moved, Diag *diag)
{
    const View *view = story->view;
    const bool vector = block == BLOCK_FORCES || block == BLOCK_CONSTRAINTS;
    Terms terms = {0};
    Status status = OK;
    Expr e;

    CHECK(system_terms(view->system, block, row, column, &terms, diag));
    CHECK(system_show(view->system, block, row, column, &e, diag));
    for (int i = 0; i < terms.count; i++) {
        const Term *term = &terms.at[i];
        Text name = {0};

        add_term_name(&name, view, block, term);
        if (!expr_is_zero(term->value)) {
            Text left = {0};

            text_add(&left, is_typeset(view) ? "\\text{" : "  ");
            add_word(&left, view, name.at);
            text_add(&left, is_typeset(view) ? "}" : "");
            view_value(&story->equations, text_done(&left), term->value);
        } else if (term->edge >= 0 && way != NULL) {
            vanish(story, name.at, why_nothing_along(term, way));
        } else if (term->edge < 0 && moved != NULL) {
            vanish(story, name.at, why_at_rest(term, moved, block));
        }
        text_free(&name);
    }
    say_vanished(story);
    say(story->out, view, "terms",
        story->equations.count > 0 ? ""
        : terms.count > 0          ? "none is left"
                                   : "too long to be told one by one");
    view_value(&story->equations,
               view_entry_name(view, block_name(block), letter, row, vector ? -1 : column), e);
    view_open(story->out, view);
    view_equations(story->out, view, &story->equations);
    view_close(story->out, view);
done:
    equations_free(&story->equations);
    for (int i = 0; i < story->reasons.count; i++)
        text_free(&story->reasons.at[i].names);
    LIST_FREE(story->reasons);
    LIST_FREE(terms);
    return status;
}

static void say_title_done(Story *story, Text *title)
{
    if (story->out->length > 0)
        text_char(story->out, '\n');
    say_title(story->out, story->view, title->at);
    text_free(title);
}

/* constraint row k; its circuit where it is the first of that chord and half */
static Status tell_constraint(Story *story, int k, bool with_circuit, Diag *diag)
{
    const View *view = story->view;
    const ConstraintRow *row = system_constraint(view->system, k);
    Way way = {0};
    Text title = {0};
    Status status = OK;

    add_word(&title, view, system_instance_name(view->system, row->instance));
    text_addf(&title, ", %s: constraint %d", row->direction, k + 1);
    say_title_done(story, &title);
    if (!row->rotation && !row->is_driver)
        system_way(view->system, row->edge, &way);
    if (with_circuit && row->rotation)
        say_turns(story->out, view, row->edge);
    if (with_circuit && way.count > 0) {
        say_way(story->out, view, row->edge, &way);
        say_vectors(story->out, view, &way);
    }
    say_projection(story->out, view, k);
    CHECK(say_entry(story, BLOCK_CONSTRAINTS, "\\Phi", k, 0, &way, NULL, diag));
done:
    LIST_FREE(way);
    return status;
}

/* whether the row's circuit was told with the row before */
static bool goes_on(const View *view, int k)
{
    const ConstraintRow *row = system_constraint(view->system, k);
    const ConstraintRow *before = k > 0 ? system_constraint(view->system, k - 1) : NULL;

    return before != NULL && before->edge == row->edge && before->rotation == row->rotation &&
           !before->is_driver;
}

static void say_dropped(Story *story, const char *of)
{
    const size_t length = of != NULL ? strlen(of) : 0;
    const char *line;
    bool first = true;

    for (int i = 0; (line = system_dropped(story->view->system, i)) != NULL; i++) {
        Text words = {0};

        if (of != NULL && (strncmp(line, of, length) != 0 || line[length] != ':'))
            continue;
        add_word(&words, story->view, line);
        say_done(story->out, story->view, first ? "dropped" : "", &words);
        first = false;
    }
}

/* --- motion --- */

/* what of a cutset does no work on the motion of its branch, by the law that says so */
static const char *why_no_work(const View *view, int edge, int branch)
{
    const Instance *owner = model_edge_owner(view->model, edge);

    if (owner == NULL)
        return NULL;
    if (owner->is_virtual)
        return "virtual, carries nothing";
    if (edge == branch)
        return owner->row->family == FAMILY_JOINT ? "carries nothing along its own motion" : NULL;
    if (owner->row->family == FAMILY_JOINT)
        return "a joint, works by its multipliers alone";
    return owner->row->family == FAMILY_ARM ? "an arm, hands on what it carries" : NULL;
}

/* "F(h8) + F(m1) - F(h9) = 0": the cutset of a branch */
static void say_cutset(Story *story, int branch, TreeKind kind)
{
    const View *view = story->view;
    const Tree *trees[TREE_KINDS];
    const char *letter = kind == TREE_TRANSLATION ? "F" : "T";
    Diag ignored = {0};
    Text words = {0};

    if (model_trees(view->model, trees, &ignored) != OK)
        return;

    SignMatrix *cutsets = tree_cutsets(trees[kind]);
    const int *branches = tree_branches(trees[kind]);

    text_add(&words, is_typeset(view) ? "$" : "");
    for (int r = 0; r < cutsets->rows; r++)
        for (int i = cutsets->start[r]; branches[r] == branch && i < cutsets->start[r + 1]; i++) {
            const char *why = why_no_work(view, cutsets->column[i], branch);

            add_signed(&words, cutsets->entry[i], i == cutsets->start[r]);
            add_variable(&words, view, letter, true, cutsets->column[i]);
            if (why != NULL)
                vanish(story, edge_name_of(view, cutsets->column[i]), why);
        }
    text_addf(&words, " = 0%s, the cutset of ", is_typeset(view) ? "$" : "");
    add_word(&words, view, edge_name_of(view, branch));
    text_addf(&words, " in the %s tree", tree_kind_name(kind));
    sign_matrix_free(cutsets);
    say_done(story->out, view, "cutset", &words);
    say_vanished(story);
}

/* "m2 moves [0, L7] of m2, turns [0, 0, 1] of m2" */
static void say_unit_motion(Text *out, const View *view, const UnitMotion *motion,
                            const char *label)
{
    const bool turns = !is_nothing(motion->w.at);
    Text words = {0};

    add_word(&words, view, system_instance_name(view->system, motion->instance));
    for (int k = 0; k < motion->v.count; k++) {
        text_add(&words, k == 0 ? " moves " : " + ");
        add_vector(&words, view, motion->v.at[k].at);
        text_add(&words, " of ");
        add_word(&words, view, node_name(view, motion->v.at[k].node));
    }
    if (turns) {
        text_add(&words, motion->v.count > 0 ? ", turns about " : " turns about ");
        add_direction(&words, view, &motion->w);
    }
    say_done(out, view, label, &words);
}

static void say_unit_motions(Text *out, const View *view, int speed, const UnitMotions *motions)
{
    Text words = {0};
    bool any = false;

    text_add(&words, "on what a unit of ");
    add_formula(&words, view, system_u(view->system, speed)->symbol);
    text_add(&words, " moves:");
    for (int i = 0; i < motions->count; i++)
        any = any || motions->at[i].v.count > 0 || !is_nothing(motions->at[i].w.at);
    text_add(&words, any ? "" : " no part with mass");
    say_done(out, view, "projected", &words);
    for (int i = 0; i < motions->count; i++)
        if (motions->at[i].v.count > 0 || !is_nothing(motions->at[i].w.at))
            say_unit_motion(out, view, &motions->at[i], "");
}

/* the cutset of a speed's branch and what the speed moves */
static void say_speed(Story *story, int speed, const UnitMotions *motions)
{
    int edges[2];

    system_speed_edges(story->view->system, speed, edges);
    if (edges[0] >= 0)
        say_cutset(story, edges[0], TREE_TRANSLATION);
    if (edges[1] >= 0)
        say_cutset(story, edges[1], TREE_ROTATION);
    say_unit_motions(story->out, story->view, speed, motions);
}

/* entry of M, in column `column` */
static Status tell_column(Story *story, int row, int column, Moved *moved, Diag *diag)
{
    const View *view = story->view;

    if (row != column)
        say_unit_motions(story->out, view, column, &moved->by[1]);
    return say_entry(story, BLOCK_MASS, "M", row, column, NULL, moved, diag);
}

static void name_row(Text *title, const View *view, const char *what, int row)
{
    add_formula(title, view, system_u(view->system, row)->symbol);
    text_addf(title, "%s", what);
}

static Status tell_mass(Story *story, int row, int column, Diag *diag)
{
    const View *view = story->view;
    Moved moved = {{{0}, {0}}};
    Text title = {0};
    Status status;

    system_unit_motions(view->system, row, &moved.by[0]);
    system_unit_motions(view->system, column, &moved.by[1]);
    text_addf(&title, "mass(%d,%d): row of ", row + 1, column + 1);
    name_row(&title, view, ", column of ", row);
    add_formula(&title, view, system_acceleration(view->system, column));
    say_title_done(story, &title);
    say_speed(story, row, &moved.by[0]);
    status = tell_column(story, row, column, &moved, diag);
    unit_motions_free(&moved.by[0]);
    unit_motions_free(&moved.by[1]);
    return status;
}

static Status tell_force(Story *story, int row, Diag *diag)
{
    const View *view = story->view;
    Moved moved = {{{0}, {0}}};
    Text title = {0};
    Status status;

    system_unit_motions(view->system, row, &moved.by[0]);
    text_addf(&title, "forces(%d): row of ", row + 1);
    name_row(&title, view, "", row);
    say_title_done(story, &title);
    say_speed(story, row, &moved.by[0]);
    status = say_entry(story, BLOCK_FORCES, "F", row, 0, NULL, &moved, diag);
    unit_motions_free(&moved.by[0]);
    return status;
}

static Status tell_jacobian(Story *story, int row, int column, Diag *diag)
{
    const View *view = story->view;
    Text title = {0}, words = {0};

    text_addf(&title, "jacobian(%d,%d): constraint %d by ", row + 1, column + 1, row + 1);
    add_formula(&title, view, system_u(view->system, column)->symbol);
    say_title_done(story, &title);
    text_add(&words, "each term of the constraint by ");
    add_formula(&words, view, system_u(view->system, column)->symbol);
    say_done(story->out, view, "derived", &words);
    return say_entry(story, BLOCK_JACOBIAN, "\\Phi", row, column, NULL, NULL, diag);
}

/* the equation that the steps led to */
static void say_equation(Story *story)
{
    say(story->out, story->view, "equation", "");
    view_open(story->out, story->view);
    view_equations(story->out, story->view, &story->equations);
    view_close(story->out, story->view);
}

/* the columns of M that aren't 0, then F */
static Status tell_entries(Story *story, int row, Moved *moved, Diag *diag)
{
    const View *view = story->view;
    Status status = OK;

    for (int k = 0; status == OK && k < system_nu(view->system); k++) {
        Expr e;

        CHECK(poll(view->watch));
        CHECK(system_show(view->system, BLOCK_MASS, row, k, &e, diag));
        if (expr_is_zero(e))
            continue;
        system_unit_motions(view->system, k, &moved->by[1]);
        status = tell_column(story, row, k, moved, diag);
        unit_motions_free(&moved->by[1]);
    }
    CHECK(status);
    CHECK(say_entry(story, BLOCK_FORCES, "F", row, 0, NULL, moved, diag));
done:
    return status;
}

static Status tell_motion(Story *story, int row, Diag *diag)
{
    const View *view = story->view;
    const int m = system_m(view->system);
    Moved moved = {{{0}, {0}}};
    Text title = {0}, words = {0};
    Status status = OK;

    text_addf(&title, "row %d of the motion, of ", row + 1);
    name_row(&title, view, "", row);
    say_title_done(story, &title);
    system_unit_motions(view->system, row, &moved.by[0]);
    say_speed(story, row, &moved.by[0]);
    CHECK(tell_entries(story, row, &moved, diag));
    text_addf(&words, "M u' %s= F%s", m > 0 ? "+ Phi_u^T lambda " : "",
              m > 0 ? "; lambda is what the chords' joints carry" : "");
    if (!is_typeset(view))
        say(story->out, view, "stacked", words.at);
    CHECK(equations_add_motion(view, &story->equations, row, 0, diag));
    say_equation(story);
done:
    unit_motions_free(&moved.by[0]);
    text_free(&words);
    equations_free(&story->equations);
    return status;
}

/* --- networks --- */

static void add_network_variable(Text *out, const View *view, int edge, bool across)
{
    const Domain domain = graph_edge(model_graph(view->model), edge)->domain;

    add_variable(out, view, across ? domain_across(domain) : domain_through(domain), false, edge);
}

static void say_network_step(Story *story, const NetworkSteps *steps, const NetworkStep *step)
{
    const View *view = story->view;
    Text words = {0};

    if (step->is_summed) {
        text_add(&words, is_typeset(view) ? "$" : "");
        add_network_variable(&words, view, step->edge, step->is_across);
        text_add(&words, step->count > 0 ? " = " : " = 0");
        for (int i = 0; i < step->count; i++) {
            const SignedEdge *other = &steps->signed_edges.at[step->first + i];

            add_signed(&words, other->sign, i == 0);
            add_network_variable(&words, view, other->edge, step->is_across);
        }
        text_add(&words, is_typeset(view) ? "$" : "");
        say_done(story->out, view, step->is_across ? "circuit" : "cutset", &words);
    } else if (step->is_unknown) {
        text_add(&words, is_typeset(view) ? "$" : "");
        add_network_variable(&words, view, step->edge, step->is_across);
        text_addf(&words, "%s is an unknown, with an equation of its own",
                  is_typeset(view) ? "$" : "");
        say_done(story->out, view, "kept", &words);
    } else if (step->left != NULL && step->right != NULL) {
        add_formula(&words, view, step->left);
        text_addf(&words, "%s = ", step->is_rate ? "'" : "");
        add_formula(&words, view, step->right);
        text_add(&words, ", the law of ");
        add_word(&words, view, edge_name_of(view, step->edge));
        say_done(story->out, view, "law", &words);
    } else {
        add_word(&words, view, edge_name_of(view, step->edge));
        text_add(&words, " has a law for each of its sides");
        say_done(story->out, view, "law", &words);
    }
}

static void tell_network(Story *story, int equation)
{
    const View *view = story->view;
    NetworkSteps steps = {{0}, {0}};
    Text title = {0};

    add_word(&title, view, edge_name_of(view, system_network_edge(view->system, equation)));
    text_addf(&title, ": equation %d of the network", equation + 1);
    say_title_done(story, &title);
    system_network_steps(view->system, equation, &steps);
    for (int i = 0; i < steps.steps.count; i++)
        say_network_step(story, &steps, &steps.steps.at[i]);
    equations_add_network(view, &story->equations, equation, 0);
    say_equation(story);
    network_steps_free(&steps);
}

/* --- what was asked for --- */

static Status tell_all(Story *story, Diag *diag)
{
    const System *system = story->view->system;

    for (int k = 0; k < system_m(system); k++)
        TRY(tell_constraint(story, k, !goes_on(story->view, k), diag));
    say_dropped(story, NULL);
    for (int i = 0; i < system_nu(system); i++)
        TRY(tell_motion(story, i, diag));
    for (int i = 0; i < system_network_count(system); i++)
        tell_network(story, i);
    return OK;
}

/* a row of `show equations` */
static Status tell_row(Story *story, const Syntax *item, Diag *diag)
{
    const System *system = story->view->system;
    const int nu = system_nu(system), m = system_m(system);
    const int rows = nu + m + system_network_count(system);
    char *end = NULL;
    const long row = strtol(item->text, &end, 10) - 1;

    if (*end != '\0' || row < 0 || row >= rows || item->has_unit) {
        (void)diag_at(diag, E_VALUE, item->place, "the equations have %d row%s", rows,
                      rows == 1 ? "" : "s");
        diag_hint(diag, "rows are counted 1, 2, 3 ... in the order of 'show equations'");
        return E_VALUE;
    }
    if (row < nu)
        return tell_motion(story, (int)row, diag);
    if (row < nu + m)
        return tell_constraint(story, (int)row - nu, true, diag);
    tell_network(story, (int)row - nu - m);
    return OK;
}

static Status read_entry(const View *view, const Syntax *item, Block block, int at[2], Diag *diag)
{
    int size[2];

    system_block_size(view->system, block, &size[0], &size[1]);
    if (item->count != (block == BLOCK_MASS || block == BLOCK_JACOBIAN ? 2 : 1))
        return diag_at(diag, E_SYNTAX, item->place, "%s is asked for as %s", item->text,
                       block == BLOCK_MASS || block == BLOCK_JACOBIAN
                           ? "a row and a column: mass(2,3)"
                           : "a row: forces(1)");
    for (int i = 0; i < item->count; i++) {
        char *end = NULL;
        const Syntax *arg = item->args[i];
        const long number = strtol(arg->text, &end, 10);

        if (arg->kind != SYNTAX_NUMBER || *end != '\0' || number < 1 || number > size[i])
            return diag_at(diag, E_VALUE, arg->place, "%s has the %s 1 to %d", item->text,
                           i == 0 ? "rows" : "columns", size[i]);
        at[i] = (int)number - 1;
    }
    return OK;
}

static Status tell_entry(Story *story, const Syntax *item, Diag *diag)
{
    static const Block known[] = {BLOCK_MASS, BLOCK_FORCES, BLOCK_CONSTRAINTS, BLOCK_JACOBIAN};
    int at[2] = {0, 0};

    for (int i = 0; i < COUNT(known); i++) {
        if (strcmp(block_name(known[i]), item->text) != 0)
            continue;
        TRY(read_entry(story->view, item, known[i], at, diag));
        switch (known[i]) {
        case BLOCK_MASS:
            return tell_mass(story, at[0], at[1], diag);
        case BLOCK_FORCES:
            return tell_force(story, at[0], diag);
        case BLOCK_JACOBIAN:
            return tell_jacobian(story, at[0], at[1], diag);
        default:
            return tell_constraint(story, at[0], true, diag);
        }
    }
    (void)diag_at(diag, E_NAME, item->place, "'%s' is no block whose entries are derived",
                  item->text);
    diag_hint(diag, "mass(2,3), forces(1), constraints(1) and jacobian(1,2) are");
    return E_NAME;
}

static bool is_of(const View *view, int edge, int instance, const char *name)
{
    return (edge >= 0 && strcmp(edge_name_of(view, edge), name) == 0) ||
           strcmp(system_instance_name(view->system, instance), name) == 0;
}

/* the equations of an edge, a part or a coordinate */
static Status tell_equations_of(Story *story, const char *name, bool *any, Diag *diag)
{
    const View *view = story->view;
    const System *system = view->system;
    const char *chord = NULL;

    for (int k = 0; k < system_m(system); k++) {
        const ConstraintRow *row = system_constraint(system, k);

        if (!is_of(view, row->edge, row->instance, name))
            continue;
        TRY(tell_constraint(story, k, chord == NULL || !goes_on(view, k), diag));
        chord = system_instance_name(system, row->instance);
        *any = true;
    }
    for (int i = 0; i < system_nu(system); i++) {
        const Variable *u = system_u(system, i);
        const size_t length = strlen(name);
        const bool is_rate = strncmp(u->name, name, length) == 0 &&
                             (u->name[length] == '\0' || strcmp(u->name + length, "'") == 0);

        if (!is_rate && !is_of(view, u->edge, u->instance, name))
            continue;
        TRY(tell_motion(story, i, diag));
        *any = true;
    }
    for (int i = 0; i < system_network_count(system); i++)
        if (strcmp(edge_name_of(view, system_network_edge(system, i)), name) == 0) {
            tell_network(story, i);
            *any = true;
        }
    if (*any)
        say_dropped(story, name);
    return OK;
}

/* an edge that no equation is of, or whose variable was asked for: what it does in the graph */
static void tell_edge(Story *story, int edge)
{
    const View *view = story->view;
    const Tree *trees[TREE_KINDS];
    const Edge *at = graph_edge(model_graph(view->model), edge);
    Diag ignored = {0};
    Way way = {0};

    if (at->domain != DOMAIN_MECHANICAL || model_trees(view->model, trees, &ignored) != OK)
        return;
    if (tree_has(trees[TREE_TRANSLATION], edge)) {
        say_cutset(story, edge, TREE_TRANSLATION);
    } else {
        system_way(view->system, edge, &way);
        say_way(story->out, view, edge, &way);
        say_vectors(story->out, view, &way);
        LIST_FREE(way);
    }
    if (tree_has(trees[TREE_ROTATION], edge))
        say_cutset(story, edge, TREE_ROTATION);
    else
        say_turns(story->out, view, edge);
    say_dropped(story, at->name);
}

/* a variable: the edge it is of, and the formula it is computed by */
static Status tell_variable(Story *story, const Syntax *item, Diag *diag)
{
    const View *view = story->view;
    const Graph *graph = model_graph(view->model);
    const char *dot = strrchr(item->text, '.');
    char *name =
        mem_text(item->text, dot != NULL ? (size_t)(dot - item->text) : strlen(item->text));
    int edge = graph_find_edge(graph, item->text);
    Expr user, e;
    Text title = {0};
    Status status = OK;

    if (edge < 0)
        edge = graph_find_edge(graph, name);
    if (edge < 0) /* a coordinate of another name */
        for (int i = 0; i < model_count(view->model); i++) {
            const Instance *instance = model_instance(view->model, i);

            for (int k = 0; k < instance->coord_count; k++)
                edge = strcmp(instance->coord[k], item->text) == 0 ? instance->edge : edge;
        }
    status = model_expression(view->model, item, &user, diag);
    if (status == OK)
        status = system_resolve(view->system, user, &e, diag);
    if (status != OK && (edge < 0 || item->primes > 0 || dot != NULL))
        goto done;
    add_word(&title, view, item->text);
    say_title_done(story, &title);
    if (edge >= 0)
        tell_edge(story, edge);
    if (status == OK) {
        say(story->out, view, "formula", "");
        status = show_expression(view, item, 0, story->out, diag);
    } else {
        say(story->out, view, "equation", "none: it brings no unknown of its own");
        *diag = (Diag){0};
        status = OK;
    }
done:
    mem_free(name);
    return status;
}

Status show_derivation(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const Syntax *item = selection->item;
    Story story = {.view = view, .out = out};
    bool any = false;

    if (view_kind(view) == NOTATION_SOURCE || view_kind(view) == NOTATION_OUTLINE)
        return diag_set(diag, E_VALUE, "a derivation is written as text or as latex");
    if (item == NULL)
        return tell_all(&story, diag);
    if (item->kind == SYNTAX_NUMBER)
        return tell_row(&story, item, diag);
    if (item->kind == SYNTAX_CALL && item->primes == 0)
        return tell_entry(&story, item, diag);
    if (item->kind != SYNTAX_VARIABLE)
        return diag_at(diag, E_SYNTAX, item->place,
                       "'show derivation' takes a name, a row or an entry");
    if (item->primes == 0)
        TRY(tell_equations_of(&story, item->text, &any, diag));
    return any ? OK : tell_variable(&story, item, diag);
}
