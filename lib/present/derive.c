/* derive.c: derivation of one row or entry, from its circuit or cutset to the remaining terms
 *
 * Terms that are 0 are grouped by the reason. */
#include "present/derive.h"

#include <string.h>

/* what a term is of, in words */
static void add_term_name(Text *out, const View *view, Block block, const Term *term)
{
    static const char *const of_mass[] = {[TERM_MASS] = "m v.v",
                                          [TERM_INERTIA] = "w.I.w",
                                          [TERM_ROTOR] = "rotor",
                                          [TERM_SHAPES] = "shapes"};
    static const char *const of_force[] = {
        [TERM_MASS] = "-m v.a", [TERM_INERTIA] = "-w.h'", [TERM_WEIGHT] = "weight",
        [TERM_FORCE] = "F.v",   [TERM_TORQUE] = "T.w",    [TERM_EFFORT] = "effort",
        [TERM_ROTOR] = "rotor", [TERM_DRIVE] = "drive",   [TERM_SHAPES] = "shapes"};
    static const char *const of_constraint[] = {[TERM_WHOLE] = "itself", [TERM_ASKED] = "asked"};

    if (term->edge >= 0) {
        text_addf(out, "%s%s", term->sign < 0 ? "-" : "+", narrative_edge(view, term->edge));
        return;
    }
    text_addf(out, "%s %s", system_instance_name(view->system, term->instance),
              block == BLOCK_MASS     ? of_mass[term->kind]
              : block == BLOCK_FORCES ? of_force[term->kind]
                                      : of_constraint[term->kind]);
}

/* --- circuits --- */

static SumOrder way_order(const Way *way)
{
    return narrative_order(way->count > 0 ? &way->at[0].sign : NULL, way->count, sizeof *way->at);
}

/* "r(h9) = r(r6) - r(r7), the circuit of h9 in the translation tree", or the cutset of a branch */
static void write_edges(Text *out, const View *view, const EdgeVariable *variable, int edge,
                        TreeKind kind, bool is_circuit, const SignedEdge *terms, int count)
{
    const char *label = is_circuit ? "circuit" : "cutset";
    Text words = {0};

    narrative_add_edge_sum(&words, view, variable, is_circuit ? edge : -1, terms, count);
    text_addf(&words, ", the %s of ", label);
    narrative_add_word(&words, view, narrative_edge(view, edge));
    text_addf(&words, " in the %s tree", tree_kind_name(kind));
    narrative_add_done(out, view, label, &words);
}

static const EdgeVariable translation = {"r", "r", true};
static const EdgeVariable angle = {"theta", "\\theta", true};
static const EdgeVariable angle_sign = {"θ", "\\theta", true};
static const EdgeVariable angular_velocity = {"w", "\\omega", true};

static void write_way(Text *out, const View *view, int chord, const Way *way)
{
    LIST(SignedEdge) terms = {0};

    for (int k = 0; k < way->count; k++)
        LIST_PUSH(terms, (SignedEdge){way->at[k].edge, way->at[k].sign});
    write_edges(out, view, &translation, chord, TREE_TRANSLATION, true, terms.at, terms.count);
    LIST_FREE(terms);
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
            narrative_add_formula(out, view, angles.at[i]);
    }
    LIST_FREE(angles);
}

static void write_vectors(Text *out, const View *view, const Way *way)
{
    const SumOrder order = way_order(way);
    bool first = true;

    for (int i = 0; i < way->count; i++) {
        const WayStep *step = &way->at[narrative_at(&order, i)];
        Text words = {0};

        if (narrative_is_nothing(step->shift.at))
            continue;
        narrative_add_mark(&words, view);
        narrative_add_variable(&words, view, &translation, step->edge);
        narrative_add_mark(&words, view);
        text_add(&words, " = ");
        narrative_add_vector(&words, view, step->shift.at);
        text_add(&words, " in ");
        narrative_add_word(&words, view, narrative_node(view, step->shift.node));
        add_turned(&words, view, step->shift.node);
        narrative_add_done(out, view, first ? "substituted" : "", &words);
        first = false;
    }
}

void derive_way(Text *out, const View *view, int chord)
{
    Way way = {0};

    system_way(view->system, chord, &way);
    write_way(out, view, chord, &way);
    write_vectors(out, view, &way);
    LIST_FREE(way);
}

/* the rotation circuit in edges: angles, which add in the plane, and angular velocities */
void derive_turns(Text *out, const View *view, int chord)
{
    const Tree *trees[TREE_KINDS];
    const Edge *edge = graph_edge(model_graph(view->model), chord);
    LIST(SignedEdge) terms = {0};
    Diag ignored = {0};

    if (model_trees(view->model, trees, &ignored) != OK)
        return;

    const Tree *tree = trees[TREE_ROTATION];
    const int room = tree_depth(tree, edge->tail) + tree_depth(tree, edge->head);
    int *edges = NEW_ARRAY(int, 2 * room + 1);
    const int count = tree_path(tree, edge->tail, edge->head, edges, edges + room);

    for (int k = 0; k < count; k++)
        LIST_PUSH(terms, (SignedEdge){edges[k], edges[room + k]});
    if (model_is_planar(view->model))
        write_edges(out, view, view->page.notation == NOTATION_UNICODE ? &angle_sign : &angle,
                    chord, TREE_ROTATION, true, terms.at, count);
    write_edges(out, view, &angular_velocity, chord, TREE_ROTATION, true, terms.at, count);
    LIST_FREE(terms);
    mem_free(edges);
}

static void write_projection(Text *out, const View *view, int row)
{
    const ConstraintRow *row_shown = system_constraint(view->system, row);
    const Projection on = system_projection(view->system, row);
    Text words = {0};

    switch (on.along) {
    case ALONG_AXIS:
        text_add(&words, "on ");
        narrative_add_direction(&words, view, &on.a);
        text_add(&words, ", along which it carries a force");
        break;
    case ALONG_SQUARE:
        text_add(&words, "on the moment that keeps ");
        narrative_add_direction(&words, view, &on.a);
        text_add(&words, " square to ");
        narrative_add_direction(&words, view, &on.b);
        text_add(&words, ": their product is 0");
        break;
    case ALONG_TURN:
        text_add(&words, "on ");
        narrative_add_direction(&words, view, &on.a);
        text_add(&words, ", about which it carries a moment: the turns add up");
        break;
    case ALONG_TIE:
        text_add(&words, "on the wrench along ");
        narrative_add_direction(&words, view, &on.a);
        text_add(&words, " that does no work: the shift follows the turn");
        break;
    case ALONG_COUPLED:
        narrative_add_word(&words, view, system_instance_name(view->system, row_shown->instance));
        text_add(&words, " ties the coordinate to others, with an unknown effort");
        break;
    case ALONG_SPIN:
        text_add(&words, "on ");
        narrative_add_direction(&words, view, &on.a);
        text_add(&words, ", about which the frames don't turn against each other");
        break;
    case ALONG_CONTACT:
        text_add(&words, "on ");
        narrative_add_direction(&words, view, &on.a);
        text_add(&words, ", along which the contact point has no velocity");
        break;
    case ALONG_DRIVEN:
        narrative_add_word(&words, view, system_instance_name(view->system, row_shown->instance));
        text_add(&words, " asks for the coordinate, with an unknown effort");
        break;
    }
    narrative_add_done(out, view, "projected", &words);
}

/* --- terms of an entry --- */

/* why a term of a constraint is 0 */
static const char *why_nothing_along(const Term *term, const Way *way)
{
    for (int i = 0; i < way->count; i++)
        if (way->at[i].edge == term->edge && narrative_is_nothing(way->at[i].shift.at))
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
            if (turning && narrative_is_nothing(motion->w.at))
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
static Status write_entry(Narrative *story, Block block, const char *letter, int row, int column,
                          const Way *way, const Moved *moved, Diag *diag)
{
    const View *view = story->view;
    const bool vector = block == BLOCK_FORCES || block == BLOCK_CONSTRAINTS;
    const bool is_backwards = way != NULL && way_order(way).step < 0;
    Terms terms = {0};
    Status status = OK;
    Expr e;

    CHECK(system_terms(view->system, block, row, column, &terms, diag));
    CHECK(system_show(view->system, block, row, column, &e, diag));
    for (int i = 0; i < terms.count; i++) {
        const Term *term = &terms.at[is_backwards ? terms.count - 1 - i : i];
        Text name = {0};

        add_term_name(&name, view, block, term);
        if (!expr_is_zero(term->value)) {
            Text left = {0};

            text_add(&left, narrative_is_typeset(view) ? "\\text{" : "  ");
            narrative_add_word(&left, view, name.at);
            text_add(&left, narrative_is_typeset(view) ? "}" : "");
            view_value(&story->equations, text_done(&left), term->value);
        } else if (term->edge >= 0 && way != NULL) {
            narrative_vanish(story, name.at, why_nothing_along(term, way));
        } else if (term->edge < 0 && moved != NULL) {
            narrative_vanish(story, name.at, why_at_rest(term, moved, block));
        }
        text_free(&name);
    }
    narrative_add_vanished(story);
    narrative_add(story->out, view, "terms",
                  story->equations.count > 0 ? ""
                  : terms.count > 0          ? "none is left"
                                             : "too long to be listed one by one");
    view_value(&story->equations,
               view_entry_name(view, block_name(block), letter, row, vector ? -1 : column), e);
    view_block(story->out, view, &story->equations);
done:
    equations_free(&story->equations);
    for (int i = 0; i < story->reasons.count; i++)
        text_free(&story->reasons.at[i].names);
    LIST_FREE(story->reasons);
    LIST_FREE(terms);
    return status;
}

/* constraint row k; its circuit where it is the first of that chord and half */
Status derive_constraint(Narrative *story, int k, bool with_circuit, Diag *diag)
{
    const View *view = story->view;
    const ConstraintRow *row = system_constraint(view->system, k);
    Way way = {0};
    Text title = {0};
    Status status = OK;

    narrative_add_word(&title, view, system_instance_name(view->system, row->instance));
    text_addf(&title, ", %s: constraint %d", row->direction, k + 1);
    narrative_title(story, &title);
    if (!row->rotation && !row->is_driver && !row->is_coupler)
        system_way(view->system, row->edge, &way);
    if (with_circuit && row->rotation)
        derive_turns(story->out, view, row->edge);
    if (with_circuit && way.count > 0) {
        write_way(story->out, view, row->edge, &way);
        write_vectors(story->out, view, &way);
    }
    write_projection(story->out, view, k);
    CHECK(write_entry(story, BLOCK_CONSTRAINTS, "\\Phi", k, 0, &way, NULL, diag));
done:
    LIST_FREE(way);
    return status;
}

/* whether the row's circuit was written with the row before */
bool derive_goes_on(const View *view, int k)
{
    const ConstraintRow *row = system_constraint(view->system, k);
    const ConstraintRow *before = k > 0 ? system_constraint(view->system, k - 1) : NULL;

    return before != NULL && before->edge == row->edge && before->rotation == row->rotation &&
           !before->is_driver && !before->is_coupler;
}

void derive_dropped(Narrative *story, const char *of)
{
    const size_t length = of != NULL ? strlen(of) : 0;
    const char *line;
    bool first = true;

    for (int i = 0; (line = system_dropped(story->view->system, i)) != NULL; i++) {
        Text words = {0};

        if (of != NULL && (strncmp(line, of, length) != 0 || line[length] != ':'))
            continue;
        narrative_add_word(&words, story->view, line);
        narrative_add_done(story->out, story->view, first ? "dropped" : "", &words);
        first = false;
    }
}

/* --- motion --- */

/* the reason why an edge of a cutset does no work on the motion of its branch, by its law */
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
void derive_cutset(Narrative *story, int branch, TreeKind kind)
{
    const View *view = story->view;
    const Tree *trees[TREE_KINDS];
    const EdgeVariable force = {"F", "F", true}, moment = {"T", "T", true};
    LIST(SignedEdge) terms = {0};
    Diag ignored = {0};

    if (model_trees(view->model, trees, &ignored) != OK)
        return;

    SignMatrix *cutsets = tree_cutsets(trees[kind]);
    const int *branches = tree_branches(trees[kind]);

    for (int r = 0; r < cutsets->rows; r++)
        for (int i = cutsets->start[r]; branches[r] == branch && i < cutsets->start[r + 1]; i++) {
            const char *why = why_no_work(view, cutsets->column[i], branch);

            LIST_PUSH(terms, (SignedEdge){cutsets->column[i], cutsets->entry[i]});
            if (why != NULL)
                narrative_vanish(story, narrative_edge(view, cutsets->column[i]), why);
        }
    write_edges(story->out, view, kind == TREE_TRANSLATION ? &force : &moment, branch, kind, false,
                terms.at, terms.count);
    LIST_FREE(terms);
    sign_matrix_free(cutsets);
    narrative_add_vanished(story);
}

/* "m2 moves [0, L7] of m2, turns [0, 0, 1] of m2" */
static void write_unit_motion(Text *out, const View *view, const UnitMotion *motion,
                              const char *label)
{
    const bool turns = !narrative_is_nothing(motion->w.at);
    Text words = {0};

    narrative_add_word(&words, view, system_instance_name(view->system, motion->instance));
    for (int k = 0; k < motion->v.count; k++) {
        text_add(&words, k == 0 ? " moves " : " + ");
        narrative_add_vector(&words, view, motion->v.at[k].at);
        text_add(&words, " of ");
        narrative_add_word(&words, view, narrative_node(view, motion->v.at[k].node));
    }
    if (turns) {
        text_add(&words, motion->v.count > 0 ? ", turns about " : " turns about ");
        narrative_add_direction(&words, view, &motion->w);
    }
    narrative_add_done(out, view, label, &words);
}

static bool has_beams(const View *view)
{
    for (int i = 0; i < model_count(view->model); i++)
        if (instance_bends(model_instance(view->model, i)))
            return true;
    return false;
}

static void write_unit_motions(Text *out, const View *view, int speed, const UnitMotions *motions)
{
    Text words = {0};
    bool any = false;

    text_add(&words, "on what a unit of ");
    narrative_add_formula(&words, view, system_u(view->system, speed)->symbol);
    text_add(&words, " moves:");
    for (int i = 0; i < motions->count; i++)
        any = any || motions->at[i].v.count > 0 || !narrative_is_nothing(motions->at[i].w.at);
    if (!any)
        text_add(&words, has_beams(view) ? " no rigid part; what beams give is summed along them"
                                         : " no part with mass");
    narrative_add_done(out, view, "projected", &words);
    for (int i = 0; i < motions->count; i++)
        if (motions->at[i].v.count > 0 || !narrative_is_nothing(motions->at[i].w.at))
            write_unit_motion(out, view, &motions->at[i], "");
}

/* the cutset of a speed's branch and what the speed moves */
static void write_speed(Narrative *story, int speed, const UnitMotions *motions)
{
    int edges[2];

    system_speed_edges(story->view->system, speed, edges);
    if (edges[0] >= 0)
        derive_cutset(story, edges[0], TREE_TRANSLATION);
    if (edges[1] >= 0)
        derive_cutset(story, edges[1], TREE_ROTATION);
    write_unit_motions(story->out, story->view, speed, motions);
}

/* entry of M, in column `column` */
static Status report_column(Narrative *story, int row, int column, Moved *moved, Diag *diag)
{
    const View *view = story->view;

    if (row != column)
        write_unit_motions(story->out, view, column, &moved->by[1]);
    return write_entry(story, BLOCK_MASS, "M", row, column, NULL, moved, diag);
}

static void name_row(Text *title, const View *view, const char *what, int row)
{
    narrative_add_formula(title, view, system_u(view->system, row)->symbol);
    text_addf(title, "%s", what);
}

Status derive_mass(Narrative *story, int row, int column, Diag *diag)
{
    const View *view = story->view;
    Moved moved = {{{0}, {0}}};
    Text title = {0};
    Status status;

    system_unit_motions(view->system, row, &moved.by[0]);
    system_unit_motions(view->system, column, &moved.by[1]);
    text_addf(&title, "mass(%d,%d): row of ", row + 1, column + 1);
    name_row(&title, view, ", column of ", row);
    narrative_add_formula(&title, view, system_acceleration(view->system, column));
    narrative_title(story, &title);
    write_speed(story, row, &moved.by[0]);
    status = report_column(story, row, column, &moved, diag);
    unit_motions_free(&moved.by[0]);
    unit_motions_free(&moved.by[1]);
    return status;
}

Status derive_force(Narrative *story, int row, Diag *diag)
{
    const View *view = story->view;
    Moved moved = {{{0}, {0}}};
    Text title = {0};
    Status status;

    system_unit_motions(view->system, row, &moved.by[0]);
    text_addf(&title, "forces(%d): row of ", row + 1);
    name_row(&title, view, "", row);
    narrative_title(story, &title);
    write_speed(story, row, &moved.by[0]);
    status = write_entry(story, BLOCK_FORCES, "F", row, 0, NULL, &moved, diag);
    unit_motions_free(&moved.by[0]);
    return status;
}

Status derive_jacobian(Narrative *story, int row, int column, Diag *diag)
{
    const View *view = story->view;
    Text title = {0}, words = {0};

    text_addf(&title, "jacobian(%d,%d): constraint %d by ", row + 1, column + 1, row + 1);
    narrative_add_formula(&title, view, system_u(view->system, column)->symbol);
    narrative_title(story, &title);
    text_add(&words, "each term of the constraint by ");
    narrative_add_formula(&words, view, system_u(view->system, column)->symbol);
    narrative_add_done(story->out, view, "derived", &words);
    return write_entry(story, BLOCK_JACOBIAN, "\\Phi", row, column, NULL, NULL, diag);
}

/* the columns of M that aren't 0, then F */
static Status report_entries(Narrative *story, int row, Moved *moved, Diag *diag)
{
    const View *view = story->view;
    Status status = OK;

    for (int k = 0; status == OK && k < system_nu(view->system); k++) {
        Expr e;

        CHECK(monitor_poll(view->watch));
        CHECK(system_show(view->system, BLOCK_MASS, row, k, &e, diag));
        if (expr_is_zero(e))
            continue;
        system_unit_motions(view->system, k, &moved->by[1]);
        status = report_column(story, row, k, moved, diag);
        unit_motions_free(&moved->by[1]);
    }
    CHECK(status);
    CHECK(write_entry(story, BLOCK_FORCES, "F", row, 0, NULL, moved, diag));
done:
    return status;
}

Status derive_motion(Narrative *story, int row, Diag *diag)
{
    const View *view = story->view;
    const int m = system_m(view->system);
    Moved moved = {{{0}, {0}}};
    Text title = {0}, words = {0};
    Status status = OK;

    text_addf(&title, "row %d of the motion, of ", row + 1);
    name_row(&title, view, "", row);
    narrative_title(story, &title);
    system_unit_motions(view->system, row, &moved.by[0]);
    write_speed(story, row, &moved.by[0]);
    CHECK(report_entries(story, row, &moved, diag));
    text_addf(&words, "M u' %s= F%s", m > 0 ? "+ Phi_u^T lambda " : "",
              m > 0 ? "; lambda is what the chords' joints carry" : "");
    if (!narrative_is_typeset(view))
        narrative_add(story->out, view, "stacked", words.at);
    CHECK(equations_add_motion(view, &story->equations, row, 0, diag));
    narrative_add_equations(story);
done:
    unit_motions_free(&moved.by[0]);
    text_free(&words);
    equations_free(&story->equations);
    return status;
}

/* --- networks --- */

static void write_network_step(Narrative *story, const NetworkSteps *steps, const NetworkStep *step)
{
    const View *view = story->view;
    const Domain domain = graph_edge(model_graph(view->model), step->edge)->domain;
    const char *letter = step->is_across ? domain_across(domain) : domain_through(domain);
    const EdgeVariable variable = {letter, letter, false};
    Text words = {0};

    if (step->is_summed) {
        narrative_add_edge_sum(&words, view, &variable, step->edge,
                               step->count > 0 ? &steps->signed_edges.at[step->first] : NULL,
                               step->count);
        narrative_add_done(story->out, view, step->is_across ? "circuit" : "cutset", &words);
    } else if (step->is_unknown) {
        narrative_add_mark(&words, view);
        narrative_add_variable(&words, view, &variable, step->edge);
        narrative_add_mark(&words, view);
        text_add(&words, " is an unknown, with an equation of its own");
        narrative_add_done(story->out, view, "kept", &words);
    } else if (step->left != NULL && step->right != NULL) {
        narrative_add_formula(&words, view, step->left);
        text_addf(&words, "%s = ", step->is_rate ? "'" : "");
        narrative_add_formula(&words, view, step->right);
        text_add(&words, ", the law of ");
        narrative_add_word(&words, view, narrative_edge(view, step->edge));
        narrative_add_done(story->out, view, "law", &words);
    } else {
        narrative_add_word(&words, view, narrative_edge(view, step->edge));
        text_add(&words, " has a law for each of its sides");
        narrative_add_done(story->out, view, "law", &words);
    }
}

void derive_network(Narrative *story, int equation)
{
    const View *view = story->view;
    NetworkSteps steps = {{0}, {0}};
    Text title = {0};

    narrative_add_word(&title, view,
                       narrative_edge(view, system_network_edge(view->system, equation)));
    text_addf(&title, ": equation %d of the network", equation + 1);
    narrative_title(story, &title);
    system_network_steps(view->system, equation, &steps);
    for (int i = 0; i < steps.steps.count; i++)
        write_network_step(story, &steps, &steps.steps.at[i]);
    equations_add_network(view, &story->equations, equation, 0);
    narrative_add_equations(story);
    network_steps_free(&steps);
}
