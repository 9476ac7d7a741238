/* show_equations.c: coordinates, constraints, M, F and the network, as a person writes them
 *
 * M u' + Phi_u^T lambda = F, a row a speed; Phi = 0; left = right of each network unknown. */
#include "present/count.h"
#include "present/present_limits.h"
#include "present/show.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* --- what is counted and in which order --- */

static char *name_list(const Variable *(*variable)(const System *, int), const System *system,
                       int count)
{
    Text names = {0};

    for (int i = 0; i < count; i++)
        layout_item(&names, variable(system, i)->name);
    return text_done(&names);
}

/* a circuit has no coordinates to count */
static void add_freedom(Text *out, const View *view)
{
    const System *system = view->system;
    const int n = system_n(system), nu = system_nu(system), m = system_m(system);
    char *names;
    Text line = {0};

    if (!view_is_mechanical(view))
        return;
    names = name_list(system_q, system, n);
    layout_count(&line, m, "constraint", "constraints");
    text_add(&line, " in ");
    layout_count(&line, n, "coordinate", "coordinates");
    if (n > 0)
        text_addf(&line, " (%s)", names);
    if (nu != n)
        text_addf(&line, ", %d speeds", nu);
    text_add(&line, ": ");
    view_freedoms(&line, system, view->freedoms);
    view_comment(out, view, line.at);
    text_free(&line);
    mem_free(names);
}

/* "no mass matrix: nothing in the model can move", if that is true */
static bool says_nothing_moves(Text *out, const View *view, const char *what)
{
    const bool is_still = system_nu(view->system) == 0 && system_m(view->system) == 0;
    Text line = {0};

    text_addf(&line, "no %s: nothing in the model can move", what);
    if (is_still)
        view_comment(out, view, line.at);
    text_free(&line);
    return is_still;
}

static void add_dropped(Text *out, const View *view)
{
    const char *line;

    for (int i = 0; (line = system_dropped(view->system, i)) != NULL; i++) {
        if (i == 0)
            view_comment(out, view, "vanished identically:");
        if (view_kind(view) == NOTATION_READ)
            layout_words(out, view->page.columns, "  ", line);
        else
            view_comment(out, view, line);
    }
}

static const char *edge_name(const View *view, const Variable *variable)
{
    if (variable->edge < 0)
        return system_instance_name(view->system, variable->instance);
    return graph_edge(model_graph(view->model), variable->edge)->name;
}

static const char *coordinate_kind(const System *system, int coordinate)
{
    for (int i = 0; system_quaternion(system, i) >= 0; i++)
        if (coordinate >= system_quaternion(system, i) &&
            coordinate < system_quaternion(system, i) + 4)
            return "parameter";
    return system_q(system, coordinate)->is_angle ? "angle" : "length";
}

static void coordinate_rows(Table *table, const View *view)
{
    for (int i = 0; i < system_n(view->system); i++) {
        const Variable *q = system_q(view->system, i);
        char *rate = expr_text(system_q_rate(view->system, i));

        table_cells(table, "%d\t%s\t%s\t%s\t%s", i + 1, q->name, coordinate_kind(view->system, i),
                    edge_name(view, q), rate);
        mem_free(rate);
    }
}

static void unknown_rows(Table *table, const View *view)
{
    for (int i = 0; i < system_nx(view->system) + system_nz(view->system); i++) {
        const bool is_state = i < system_nx(view->system);
        const Variable *v = is_state ? system_x(view->system, i)
                                     : system_z(view->system, i - system_nx(view->system));

        table_cells(table, "%d\t%s\t%s\t%s\t", i + 1, v->name, is_state ? "state" : "algebraic",
                    edge_name(view, v));
    }
}

Status show_coordinates(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    Table table = table_for("rllll");

    (void)selection, (void)diag;
    table_cells(&table, "\tvariable\tkind\tof\trate");
    coordinate_rows(&table, view);
    unknown_rows(&table, view);
    add_freedom(out, view);
    if (table.cells.count > table.columns)
        table_print(out, &table, 0);
    else if (!view_is_mechanical(view))
        view_comment(out, view, "no coordinates, and no unknowns of a network");
    table_free(&table);
    return OK;
}

/* --- entries of blocks --- */

static Status check_numbers(const View *view, Block block, const Selection *selection, Diag *diag)
{
    int rows, columns;

    system_block_size(view->system, block, &rows, &columns);
    if (selection->number_count > 0 && selection->numbers[0] > rows)
        return diag_set(diag, E_VALUE, "%s has %d row%s, so there is no row %d", block_name(block),
                        rows, rows == 1 ? "" : "s", selection->numbers[0]);
    if (selection->number_count > 1 && selection->numbers[1] > columns)
        return diag_set(diag, E_VALUE, "%s has %d column%s, so there is no column %d",
                        block_name(block), columns, columns == 1 ? "" : "s", selection->numbers[1]);
    return OK;
}

static bool is_chosen(const Selection *selection, int row, int column)
{
    return (selection->number_count < 1 || selection->numbers[0] == row + 1) &&
           (selection->number_count < 2 || selection->numbers[1] == column + 1);
}

/* also where it has one column */
static bool is_matrix(Block block)
{
    return block == BLOCK_MASS || block == BLOCK_JACOBIAN || block == BLOCK_EMBEDDED_MASS ||
           block == BLOCK_DEPENDENT_RATES || block == BLOCK_COMPLEMENT;
}

/* Entries of a block under their names; of a symmetric one those on and above the diagonal, unless
 * a row was requested. Zeros are left out where many entries are written. */
static Status add_entries(Text *out, const View *view, Block block, const char *letter,
                          const Selection *selection, Diag *diag)
{
    EquationList equations = {0};
    Status status = OK;
    int rows, columns;
    const bool whole = selection->number_count == 0;

    CHECK(check_numbers(view, block, selection, diag));
    system_block_size(view->system, block, &rows, &columns);
    for (int r = 0; r < rows; r++)
        for (int c = whole && block == BLOCK_MASS ? r : 0; c < columns; c++) {
            const bool vector = columns == 1 && !is_matrix(block);
            Expr e;

            if (!is_chosen(selection, r, c))
                continue;
            CHECK(monitor_poll(view->watch));
            CHECK(selection->number_count == 2
                      ? system_show_alone(view->system, block, r, c, &e, diag)
                      : system_show(view->system, block, r, c, &e, diag));
            if (expr_is_zero(e) && !vector && selection->number_count < 2)
                continue;
            view_value(&equations,
                       view_entry_name(view, block_name(block), letter, r, vector ? -1 : c), e);
        }
    view_block(out, view, &equations);
done:
    equations_free(&equations);
    return status;
}

/* "what; rows h8, h10...", of which there is one a speed */
static void add_block_title(Text *out, const View *view, const char *what, const char *rows,
                            const char *note)
{
    char *names = name_list(system_u, view->system, system_nu(view->system));
    Text line = {0};

    text_addf(&line, "%s; %s %s%s", what, rows, names, note);
    view_comment(out, view, line.at);
    text_free(&line);
    mem_free(names);
}

/* --- the embedded form --- */

/* names of some of the speeds */
static char *speed_names(const System *system, const int *speeds, int count)
{
    Text names = {0};

    for (int i = 0; i < count; i++)
        layout_item(&names, system_u(system, speeds[i])->name);
    return text_done(&names);
}

/* the same of their coordinates: h8 of h8' */
static char *coordinate_names(const System *system, const int *speeds, int count)
{
    Text names = {0};

    for (int i = 0; i < count; i++) {
        const char *speed = system_u(system, speeds[i])->name;
        char *name = mem_text(speed, strcspn(speed, "'"));

        layout_item(&names, name);
        mem_free(name);
    }
    return text_done(&names);
}

/* the form that M and F are shown of, with a remark where the embedded one can't be written out */
static Form shown_form(Text *out, const View *view, const Selection *selection)
{
    const char *const *independent;
    int count;
    const Form form =
        system_m(view->system) > 0 ? model_form(view->model, &independent, &count) : FORM_AUGMENTED;
    const Form written = form_written(view->system, form);

    if (form != written && selection->number_count == 0)
        view_comment(out, view, form_too_long);
    return written;
}

/* "Mt = G^T M, 1 x 2; rows h8', columns h8', h10'" */
static Status add_embedded_title(Text *out, const View *view, const char *what, bool has_columns,
                                 Diag *diag)
{
    const int nu = system_nu(view->system);
    char *names, *all;
    int *speeds, dependent;
    Text line = {0};

    TRY(system_partition(view->system, &speeds, &dependent, diag));
    names = speed_names(view->system, speeds + dependent, nu - dependent);
    all = name_list(system_u, view->system, nu);
    text_addf(&line, "%s of the embedded form, %d x %d; rows %s", what, nu - dependent,
              has_columns ? nu : 1, names);
    if (has_columns)
        text_addf(&line, "; columns %s; entries not listed are 0", all);
    view_comment(out, view, line.at);
    text_free(&line);
    MEM_FREE(names, all, speeds);
    return OK;
}

static Status show_embedded(const View *view, Block block, const Selection *selection, Text *out,
                            Diag *diag)
{
    const bool is_mass = block == BLOCK_EMBEDDED_MASS;

    if (selection->number_count == 0)
        TRY(add_embedded_title(out, view, is_mass ? "mass matrix G^T M" : "right side G^T F",
                               is_mass, diag));
    return add_entries(out, view, block, is_mass ? "\\tilde{M}" : "\\tilde{F}", selection, diag);
}

Status show_partition(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const int nu = system_nu(view->system);
    char *names[2];
    int *speeds, dependent;
    Table table = table_for("ll");

    (void)selection;
    if (says_nothing_moves(out, view, "coordinates"))
        return OK;
    TRY(system_partition(view->system, &speeds, &dependent, diag));
    names[0] = coordinate_names(view->system, speeds, dependent);
    names[1] = coordinate_names(view->system, speeds + dependent, nu - dependent);
    table_cells(&table, "dependent (%d)\t%s", dependent, dependent > 0 ? names[0] : "none");
    table_cells(&table, "independent (%d)\t%s", nu - dependent, nu > dependent ? names[1] : "none");
    table_wrap(out, &table, 0, view->page.columns);
    table_free(&table);
    MEM_FREE(names[0], names[1], speeds);
    return OK;
}

/* "Phi_q G = 0: the largest entry is 2e-16 of its terms", in numbers */
static Status add_check(Text *out, const View *view, Diag *diag)
{
    double error;
    Text line = {0};

    TRY(system_complement_error(view->system, &error, diag));
    if (isnan(error))
        text_add(&line, "Phi_q G can't be evaluated at numbers drawn at random");
    else if (error <= COMPLEMENT_ROUNDING)
        text_add(&line, "Phi_q G = 0 at numbers drawn at random, to rounding");
    else
        text_addf(&line, "Phi_q G is %.2g of its terms at numbers drawn at random", error);
    view_comment(out, view, line.at);
    text_free(&line);
    return OK;
}

Status show_complement(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const int nu = system_nu(view->system);
    char *names[2];
    int *speeds, dependent;
    Text line = {0};
    Status status = OK;

    if (selection->number_count > 0)
        return add_entries(out, view, BLOCK_COMPLEMENT, "G", selection, diag);
    if (says_nothing_moves(out, view, "complement"))
        return OK;
    TRY(system_partition(view->system, &speeds, &dependent, diag));
    names[0] = speed_names(view->system, speeds, dependent);
    names[1] = speed_names(view->system, speeds + dependent, nu - dependent);
    if (dependent == 0) {
        view_comment(out, view, "no constraints: all coordinates are independent, and G is 1");
        goto done;
    }
    text_addf(&line, "J, %d x %d; rows %s; columns %s; entries not listed are 0", dependent,
              nu - dependent, names[0], names[1]);
    view_comment(out, view, line.at);
    CHECK(add_entries(out, view, BLOCK_DEPENDENT_RATES, "J", selection, diag));
    line.length = 0;
    text_addf(&line, "G = [J; 1], %d x %d; rows %s, %s", nu, nu - dependent, names[0], names[1]);
    view_comment(out, view, line.at);
    CHECK(add_entries(out, view, BLOCK_COMPLEMENT, "G", selection, diag));
    CHECK(add_check(out, view, diag));
done:
    text_free(&line);
    MEM_FREE(names[0], names[1], speeds);
    return status;
}

Status show_mass(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    const int nu = system_nu(view->system);

    if (shown_form(out, view, selection) == FORM_EMBEDDED)
        return show_embedded(view, BLOCK_EMBEDDED_MASS, selection, out, diag);
    if (selection->number_count == 0) {
        char what[64];

        if (says_nothing_moves(out, view, "mass matrix"))
            return OK;
        (void)snprintf(what, sizeof what, "mass matrix, %d x %d, symmetric", nu, nu);
        add_block_title(out, view, what, "rows and columns", "; entries not listed are 0");
    }
    return add_entries(out, view, BLOCK_MASS, "M", selection, diag);
}

Status show_forces(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    if (selection->number_count == 0 && says_nothing_moves(out, view, "forces"))
        return OK;
    if (shown_form(out, view, selection) == FORM_EMBEDDED)
        return show_embedded(view, BLOCK_EMBEDDED_FORCES, selection, out, diag);
    if (selection->number_count == 0)
        add_block_title(out, view, "right side F of the motion equations", "rows", "");
    return add_entries(out, view, BLOCK_FORCES, "F", selection, diag);
}

Status show_jacobian(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    if (system_m(view->system) == 0) {
        if (!says_nothing_moves(out, view, "jacobian"))
            add_freedom(out, view);
        return OK;
    }
    if (selection->number_count == 0) {
        char what[80];

        (void)snprintf(what, sizeof what, "jacobian of the constraints, %d x %d",
                       system_m(view->system), system_nu(view->system));
        add_block_title(out, view, what, "columns", "; entries not listed are 0");
    }
    return add_entries(out, view, BLOCK_JACOBIAN, "\\Phi", selection, diag);
}

/* --- equations --- */

/* "h9  x:  " with the edge's name once, all as wide as the widest */
static char *constraint_lead(const View *view, int k, int name_width, int direction_width)
{
    const ConstraintRow *row = system_constraint(view->system, k);
    const Graph *graph = model_graph(view->model);
    const bool again = k > 0 && system_constraint(view->system, k - 1)->edge == row->edge;
    const char *name = again || row->edge < 0 ? "" : graph_edge(graph, row->edge)->name;
    Text lead = {0};
    char direction[32];

    (void)snprintf(direction, sizeof direction, "%s:", row->direction);
    text_addf(&lead, "%-*s  %-*s  ", name_width, name, direction_width + 1, direction);
    return text_done(&lead);
}

static void lead_widths(const View *view, int *name_width, int *direction_width)
{
    const Graph *graph = model_graph(view->model);

    *name_width = *direction_width = 0;
    for (int k = 0; k < system_m(view->system); k++) {
        const ConstraintRow *row = system_constraint(view->system, k);
        const int name = row->edge < 0 ? 0 : text_width(graph_edge(graph, row->edge)->name);
        const int direction = text_width(row->direction);

        *name_width = name > *name_width ? name : *name_width;
        *direction_width = direction > *direction_width ? direction : *direction_width;
    }
}

typedef Expr Unknown(const System *system, int i);

static Expr speed(const System *system, int i)
{
    return system_u(system, i)->symbol;
}

/* on the left: what isn't 0 of a block's row i, or of its column i, times unknowns */
static Status push_terms(const View *view, ShownEquation *equation, Block block, int i, bool column,
                         Unknown *unknown, Diag *diag)
{
    const int count = column ? system_m(view->system) : system_nu(view->system);
    Expr e;

    for (int j = 0; j < count; j++) {
        TRY(monitor_poll(view->watch));
        TRY(system_show(view->system, block, column ? j : i, column ? i : j, &e, diag));
        if (!expr_is_zero(e))
            LIST_PUSH(equation->left, (ViewTerm){e, unknown(view->system, j)});
    }
    return OK;
}

static Status push_right(const View *view, ShownEquation *equation, Block block, int i, Diag *diag)
{
    Expr e;

    TRY(system_show(view->system, block, i, 0, &e, diag));
    LIST_PUSH(equation->right, (ViewTerm){e, NULL});
    return OK;
}

/* Add the equation to the others after success, else free it. */
static Status push_equation(EquationList *equations, ShownEquation *equation, Status status)
{
    if (status == OK) {
        LIST_PUSH(*equations, *equation);
    } else {
        LIST_FREE(equation->left);
        LIST_FREE(equation->right);
    }
    return status;
}

/* row k: Phi = 0, Phi_u u = nu ("velocity") or Phi_u u' = gamma ("acceleration") */
static Status add_constraint(const View *view, EquationList *equations, int k, const char *level,
                             Diag *diag)
{
    ShownEquation equation = {.lead = NULL, .name = NULL, .left = {0}, .right = {0}};
    const bool acceleration = level != NULL && strcmp(level, "acceleration") == 0;
    Status status = OK;
    int name_width, direction_width;
    Expr e;

    if (level == NULL) {
        CHECK(system_show(view->system, BLOCK_CONSTRAINTS, k, 0, &e, diag));
        LIST_PUSH(equation.left, (ViewTerm){e, NULL});
    } else {
        CHECK(push_terms(view, &equation, BLOCK_JACOBIAN, k, false,
                         acceleration ? system_acceleration : speed, diag));
        CHECK(push_right(view, &equation, acceleration ? BLOCK_ACCELERATION : BLOCK_VELOCITY, k,
                         diag));
    }
    lead_widths(view, &name_width, &direction_width);
    equation.lead = constraint_lead(view, k, name_width, direction_width);
done:
    return push_equation(equations, &equation, status);
}

Status show_constraints(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    EquationList equations = {0};
    Status status = OK;

    CHECK(check_numbers(view, BLOCK_CONSTRAINTS, selection, diag));
    for (int k = 0; k < system_m(view->system); k++)
        if (is_chosen(selection, k, 0) && selection->number_count < 2)
            CHECK(add_constraint(view, &equations, k, selection->level, diag));
    if (selection->number_count == 0 && !says_nothing_moves(out, view, "constraints"))
        add_freedom(out, view);
    if (equations.count > 0)
        view_block(out, view, &equations);
    if (selection->number_count == 0)
        add_dropped(out, view);
done:
    equations_free(&equations);
    return status;
}

/* "M7:  ", as wide as the widest; new */
static char *edge_lead(const View *view, const Variable *of, int width)
{
    char name[80];
    Text lead = {0};

    (void)snprintf(name, sizeof name, "%s:", edge_name(view, of));
    text_addf(&lead, "%-*s  ", width, name);
    return text_done(&lead);
}

/* the efforts of drivers, which the embedded form has on the left: G^T Phi_D^T lambda_D */
static Status push_driver_efforts(const View *view, ShownEquation *equation, int i, Diag *diag)
{
    Arena *arena = model_arena(view->model);
    const int nu = system_nu(view->system);
    int *speeds, dependent;
    Status status = OK;

    TRY(system_partition(view->system, &speeds, &dependent, diag));
    for (int k = 0; k < system_m(view->system); k++) {
        Expr sum = expr_int(arena, 0), g, phi;

        for (int j = 0; system_constraint(view->system, k)->is_driver && j < nu; j++) {
            CHECK(system_show(view->system, BLOCK_COMPLEMENT, j, i, &g, diag));
            CHECK(system_show(view->system, BLOCK_JACOBIAN, k, speeds[j], &phi, diag));
            sum = expr_add(arena, sum, expr_mul(arena, g, phi));
        }
        if (!expr_is_zero(sum))
            LIST_PUSH(equation->left, (ViewTerm){sum, system_multiplier(view->system, k)});
    }
done:
    mem_free(speeds);
    return status;
}

/* row i of the embedded form, Mt u' + G^T Phi_D^T lambda_D = Ft */
static Status push_embedded(const View *view, EquationList *equations, int i, Diag *diag)
{
    ShownEquation equation = {.lead = NULL, .name = NULL, .left = {0}, .right = {0}};
    Status status = OK;
    Text lead = {0};

    CHECK(push_terms(view, &equation, BLOCK_EMBEDDED_MASS, i, false, system_acceleration, diag));
    CHECK(push_driver_efforts(view, &equation, i, diag));
    CHECK(push_right(view, &equation, BLOCK_EMBEDDED_FORCES, i, diag));
    text_addf(&lead, "%d:  ", i + 1);
    equation.lead = text_done(&lead);
done:
    return push_equation(equations, &equation, status);
}

Status equations_add_motion(const View *view, EquationList *equations, int i, int lead_width,
                            Diag *diag)
{
    ShownEquation equation = {.lead = NULL, .name = NULL, .left = {0}, .right = {0}};
    Status status = OK;

    CHECK(push_terms(view, &equation, BLOCK_MASS, i, false, system_acceleration, diag));
    CHECK(push_terms(view, &equation, BLOCK_JACOBIAN, i, true, system_multiplier, diag));
    CHECK(push_right(view, &equation, BLOCK_FORCES, i, diag));
    equation.lead = edge_lead(view, system_u(view->system, i), lead_width);
done:
    return push_equation(equations, &equation, status);
}

static Status push_motions(const View *view, EquationList *equations, int lead_width, Diag *diag)
{
    const char *const *independent;
    int count, rows, columns;
    const bool embedded = model_form(view->model, &independent, &count) == FORM_EMBEDDED &&
                          system_m(view->system) > 0;

    system_block_size(view->system, BLOCK_EMBEDDED_FORCES, &rows, &columns);
    for (int i = 0; embedded && i < rows; i++)
        TRY(push_embedded(view, equations, i, diag));
    for (int i = 0; !embedded && i < system_nu(view->system); i++)
        TRY(equations_add_motion(view, equations, i, lead_width, diag));
    return OK;
}

void equations_add_network(const View *view, EquationList *equations, int i, int lead_width)
{
    ShownEquation equation = {.lead = NULL, .name = NULL, .left = {0}, .right = {0}};
    const Variable of = {.edge = system_network_edge(view->system, i)};
    Expr left, right;

    system_network_equation(view->system, i, &left, &right);
    LIST_PUSH(equation.left, (ViewTerm){left, NULL});
    LIST_PUSH(equation.right, (ViewTerm){right, NULL});
    equation.lead = edge_lead(view, &of, lead_width);
    LIST_PUSH(*equations, equation);
}

static void push_network(const View *view, EquationList *equations, int lead_width)
{
    for (int i = 0; i < system_network_count(view->system); i++)
        equations_add_network(view, equations, i, lead_width);
}

static int edge_lead_width(const View *view)
{
    const System *system = view->system;
    int width = 0;

    for (int i = 0; i < system_nu(system) + system_nx(system) + system_nz(system); i++) {
        const int j = i - system_nu(system), k = j - system_nx(system);
        const Variable *v = j < 0   ? system_u(system, i)
                            : k < 0 ? system_x(system, j)
                                    : system_z(system, k);
        const int w = text_width(edge_name(view, v)) + 1;

        width = w > width ? w : width;
    }
    return width;
}

Status show_network(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    EquationList equations = {0};

    (void)selection, (void)diag;
    if (system_network_count(view->system) == 0) {
        view_comment(out, view,
                     "no network: no electrical or other scalar component has an "
                     "equation of its own");
        return OK;
    }
    push_network(view, &equations, edge_lead_width(view));
    view_block(out, view, &equations);
    return OK;
}

Status show_equations(const View *view, const Selection *selection, Text *out, Diag *diag)
{
    EquationList equations = {0};
    Status status = OK;
    const int width = edge_lead_width(view);

    (void)selection;
    CHECK(push_motions(view, &equations, width, diag));
    for (int k = 0; k < system_m(view->system); k++)
        CHECK(add_constraint(view, &equations, k, NULL, diag));
    push_network(view, &equations, width);
    add_freedom(out, view);
    if (equations.count > 0)
        view_block(out, view, &equations);
    else if (!view_is_mechanical(view))
        view_comment(out, view, "no equations: the model has no unknowns");
done:
    equations_free(&equations);
    return status;
}

/* in programs, an expression needs a name that the model doesn't use */
static char *free_name(const View *view, int number)
{
    const char *name;
    Text text = {0};

    text_add(&text, "value");
    if (number > 0)
        text_addf(&text, "%d", number);
    for (int i = 0; (name = model_name(view->model, i)) != NULL; i++)
        if (strcmp(name, text.at) == 0) {
            text_char(&text, '_');
            i = -1;
        }
    return text_done(&text);
}

/* The left side of what is shown, e: as the user wrote it, or as the notation can have it. */
static char *left_side(const View *view, const Syntax *syntax, Expr user, Expr e, int number)
{
    char *written, *name;
    bool is_itself; /* no computation: x = x is no statement */

    if (view_kind(view) == NOTATION_TYPESET)
        return view_expression(view, user);
    if (view_kind(view) != NOTATION_SOURCE)
        return view_name(syntax);
    while (syntax->kind == SYNTAX_GROUP && syntax->primes == 0)
        syntax = syntax->args[0];
    written = view_name(syntax);
    is_itself = expr_kind(e) == EXPR_SYMBOL && strcmp(expr_name(e), written) == 0;
    name = syntax->kind != SYNTAX_VARIABLE || is_itself
               ? free_name(view, number)
               : view_expression(view,
                                 expr_symbol(model_arena(view->model), written, SYMBOL_VARIABLE));
    mem_free(written);
    return name;
}

Status show_expression(const View *view, const Syntax *syntax, int number, Text *out, Diag *diag)
{
    EquationList equations = {0};
    Expr user, e;

    TRY(model_expression(view->model, syntax, &user, diag));
    TRY(system_resolve(view->system, user, &e, diag));
    view_value(&equations, left_side(view, syntax, user, e, number),
               system_written(view->system, system_plain(view->system, e)));
    view_block(out, view, &equations);
    return OK;
}
