/* session_linear.c: equilibrium, linearize, modes, and the entries of what they found */
#include "session/session_impl.h"

#include "present/show.h"
#include "session/session_limits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const Syntax *value_of_key(const Statement *s, const char *key)
{
    for (int i = 0; i < s->pairs.count; i++)
        if (strcmp(s->pairs.at[i].name, key) == 0)
            return s->pairs.at[i].value;
    return NULL;
}

/* a time given as a number, or as an expression of parameters */
static Status read_instant(const ct_session *session, const Syntax *at, double *out, Diag *diag)
{
    Expr e;

    TRY(model_expression(session->model, at, &e, diag));
    TRY(model_check_unit(session->model, at, "s", "an instant", diag));
    if ((expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) != 0)
        return diag_at(diag, E_VALUE, at->place, "an instant is a number, or made of parameters");
    *out = model_number(session->model, e);
    return OK;
}

/* what friction holds at rest elsewhere, too */
static void remark_friction(ct_session *session)
{
    Text line = {0};
    int count = 0;

    for (int i = 0; i < model_count(session->model); i++) {
        const Instance *part = model_instance(session->model, i);

        if (instance_sticks(part) && count++ < MOST_NAMES)
            text_addf(&line, "%s%s", line.length > 0 ? ", " : "", part->name);
    }
    if (count == 0)
        return;
    text_addf(&line, "%s at rest: this equilibrium is the one that asks for no dry friction",
              count > MOST_NAMES ? ", ... may hold other positions" : " may hold other positions");
    session_remark(session, line.at);
    text_free(&line);
}

Status session_equilibrium(ct_session *session, const Statement *s, Diag *diag)
{
    RunInput input = {0};
    Run found = {0};
    Result *result = NULL;
    ResultReader *reader = NULL;
    System *system;
    const Syntax *at = value_of_key(s, "at");
    Status status;

    CHECK(session_running(session, &system, diag));
    run_input_make(session, system, &input);
    input.setting.keeps_rates = at != NULL;
    if (at != NULL)
        CHECK(read_instant(session, at, &input.setting.at, diag));
    CHECK(run_equilibrium(system, &input.setting, &result, &reader, diag));
    found = run_input_done(&input, result, reader);
    if (!session->is_sweeping)
        CHECK(session_store_equilibrium(session, &found, s->verb, diag));
    run_free(&session->start);
    session->start = found;
    found = (Run){0};
    session->start_is_later = true;
    session->reporter = NULL;
    session_remark_result(session, result);
    remark_friction(session);
done:
    run_free(&found);
    run_input_free(&input);
    return status;
}

Status session_op(ct_session *session, const Statement *s, Diag *diag)
{
    return session_equilibrium(session, s, diag);
}

/* --- the input of a linearisation --- */

typedef struct LinearQuery {
    LinearOrder order;
    LIST(LinearInput) inputs;
    LIST(Expr) outputs;
    LIST(char *) output_names;
} LinearQuery;

static void asked_free(LinearQuery *asked)
{
    LIST_FREE(asked->inputs);
    LIST_FREE(asked->outputs);
    for (int i = 0; i < asked->output_names.count; i++)
        mem_free(asked->output_names.at[i]);
    LIST_FREE(asked->output_names);
}

/* [a, b, c], or one alone: item i, NULL after the last */
static const Syntax *item_of(const Syntax *list, int i)
{
    if (list == NULL)
        return NULL;
    if (list->kind != SYNTAX_VECTOR)
        return i == 0 ? list : NULL;
    return i < list->count ? list->args[i] : NULL;
}

/* about an instant of the last run, or about the start */
static Status read_point(ct_session *session, const Statement *s, LinearQuery *asked, Diag *diag)
{
    const Syntax *at = value_of_key(s, "at");
    Run *run;
    Status status = OK;

    if (at == NULL) {
        CHECK(session_start(session, &run, diag));
        asked->order.at = result_times(run->result)[0];
    } else if (session->runs.count == 0) {
        diag_at(diag, E_MISSING, at->place,
                "at= takes an instant of the last run, and there is none");
        diag_hint(diag, "'simulate 10' makes one; without at= it is about the start");
        return E_MISSING;
    } else {
        run = session->runs.at + session->runs.count - 1;
        CHECK(read_instant(session, at, &asked->order.at, diag));
    }
    asked->order.about = run->reader;
    asked->order.scene = model_scene_source(session->model);
    asked->order.watch = &session->watch;
    (void)model_form(session->model, &asked->order.independent, &asked->order.independent_count);
done:
    return status;
}

static Status read_input(const Model *model, const Syntax *syntax, LinearQuery *asked, Diag *diag)
{
    Suggest suggest = suggest_for(syntax->text);
    bool is_name = syntax->kind == SYNTAX_VARIABLE && syntax->primes == 0;
    const Instance *part = is_name ? model_find(model, syntax->text) : NULL;
    Expr definition;

    /* a source before a parameter of its name: the parameter may be its amplitude alone */
    if (part != NULL && (instance_input(part) >= 0 || !model_has_parameter(model, syntax->text))) {
        LIST_PUSH(asked->inputs, (LinearInput){syntax->text, syntax->text});
        return OK;
    }
    if (is_name && model_has_parameter(model, syntax->text)) {
        LIST_PUSH(asked->inputs, (LinearInput){syntax->text, NULL});
        return OK;
    }
    for (int i = 0; i < model_parameter_count(model); i++)
        suggest_offer(&suggest, expr_name(model_parameter(model, i, &definition)));
    for (int i = 0; i < model_count(model); i++)
        suggest_offer(&suggest, model_instance(model, i)->name);
    diag_at(diag, E_NAME, syntax->place, "an input is a source, an actuator or a parameter%s%s%s",
            is_name ? ", and none is called '" : "", is_name ? syntax->text : "",
            is_name ? "'" : "");
    if (suggest.best != NULL && is_name)
        diag_hint(diag, "did you mean '%s'?", suggest.best);
    else
        diag_hint(diag, "linearize inputs=[V1] outputs=[h8]");
    return E_NAME;
}

static Status read_lists(ct_session *session, const Statement *s, LinearQuery *asked, Diag *diag)
{
    const Syntax *inputs = value_of_key(s, "inputs"), *outputs = value_of_key(s, "outputs");
    const Syntax *item;
    Status status = OK;
    Expr e;

    for (int i = 0; (item = item_of(inputs, i)) != NULL; i++)
        CHECK(read_input(session->model, item, asked, diag));
    for (int i = 0; (item = item_of(outputs, i)) != NULL; i++) {
        status = model_expression(session->model, item, &e, diag);
        if (status == OK)
            status = model_check_shown(session->model, item, diag);
        if (status != OK && diag->place.line == 0)
            diag->place = item->place;
        CHECK(status);
        LIST_PUSH(asked->outputs, session_add_outputs(session->model, e));
        LIST_PUSH(asked->output_names, view_name(item));
    }
    asked->order.inputs = asked->inputs.at;
    asked->order.input_count = asked->inputs.count;
    asked->order.outputs = asked->outputs.at;
    asked->order.output_names = (const char *const *)asked->output_names.at;
    asked->order.output_count = asked->outputs.count;
done:
    return status;
}

/* the output or else the inputs that a message is about */
static void place_key(const Statement *s, Diag *diag)
{
    const Syntax *outputs = value_of_key(s, "outputs"), *inputs = value_of_key(s, "inputs");

    if (outputs != NULL)
        session_place_item((const Syntax *const[]){outputs, outputs}, 2, diag);
    if (diag->place.line == 0 && inputs != NULL)
        diag->place = inputs->place;
}

static Status find_linear(ct_session *session, const Statement *s, Linear **out, Diag *diag)
{
    LinearQuery asked = {.order = {.at = 0}};
    Status status;

    CHECK(read_point(session, s, &asked, diag));
    CHECK(read_lists(session, s, &asked, diag));
    status = linearize(&asked.order, out, diag);
    if (status == E_NAME && diag->place.line == 0)
        place_key(s, diag);
done:
    asked_free(&asked);
    return status;
}

/* A law that jumps at the point, as friction at rest, has no derivative there. */
static void remark_jump(ct_session *session, const Linear *linear, const char *what)
{
    Text line = {0};

    if (linear->on_jump == NULL)
        return;
    text_addf(&line, "%s %s at the point: the %s are those without what it holds", linear->on_jump,
              strchr(linear->on_jump, ',') != NULL ? "jump" : "jumps", what);
    session_remark(session, line.at);
    text_free(&line);
}

/* Eigenvalues of a linear system are its own, whatever describes it; those at an instant of a
 * motion aren't. */
static void remark_passing(ct_session *session, const Linear *linear, const char *what)
{
    Text line = {0};

    remark_jump(session, linear, what);
    if (!linear->is_passing)
        return;
    text_addf(&line,
              "no rest and no steady motion at t = %.6g s: the %s are those of the coordinates",
              linear->at, what);
    for (int i = 0; i < linear->places && i < MOST_NAMES; i++)
        text_addf(&line, "%s %s", i == 0 ? "" : ",", linear->state_names[i]);
    text_addf(&line, "%s; other independent coordinates have others",
              linear->places > MOST_NAMES ? ", ..." : "");
    session_remark(session, line.at);
    text_free(&line);
}

static void report_linear(const ct_session *session, Text *out)
{
    const View view = session_view(session);

    linear_print(&view, session->linear, out);
}

Status session_linearize(ct_session *session, const Statement *s, Diag *diag)
{
    Linear *linear = NULL;
    Status status;

    CHECK(find_linear(session, s, &linear, diag));
    linear_free(session->linear);
    session->linear = linear;
    session->linear_is_old = false;
    session->reporter = report_linear;
    remark_jump(session, linear, "matrices");
done:
    return status;
}

void session_remark_linear(ct_session *session)
{
    if (session->linear == NULL)
        return;
    if (session->linear_is_old)
        session_remark(session, "linearized before the model changed");
    remark_passing(session, session->linear, "poles");
}

static void report_modes(const ct_session *session, Text *out)
{
    const View view = session_view(session);

    modes_print(&view, session->modes, out);
}

Status session_modes(ct_session *session, const Statement *s, Diag *diag)
{
    Linear *linear = NULL;
    Modes *modes = NULL;
    Status status;

    CHECK(find_linear(session, s, &linear, diag));
    CHECK(modes_find(linear, &modes, diag));
    remark_passing(session, linear, "modes");
    modes_free(session->modes);
    session->modes = modes;
    session->reporter = report_modes;
done:
    linear_free(linear);
    return status;
}

/* --- entries: modes.omega(1), linear.A(1,2) --- */

static double omega_of(const Mode *mode)
{
    return mode->omega;
}

static double damping_of(const Mode *mode)
{
    return mode->damping;
}

static const struct {
    const char *name;
    double (*of)(const Mode *mode); /* NULL: of the linear equations */
} entries[] = {{"modes.omega", omega_of}, {"modes.damping", damping_of},
               {"linear.A", NULL},        {"linear.B", NULL},
               {"linear.C", NULL},        {"linear.D", NULL}};

int session_entry(const char *name)
{
    for (int i = 0; i < COUNT(entries); i++)
        if (strcmp(entries[i].name, name) == 0)
            return i;
    return -1;
}

static Status mode_entry(const ct_session *session, int entry, const int *index, int count,
                         double *out, Diag *diag)
{
    if (session->modes == NULL) {
        (void)diag_set(diag, E_MISSING, "there are no modes yet");
        diag_hint(diag, "'modes' finds them");
        return E_MISSING;
    }
    if (session->modes->count == 0) {
        (void)diag_set(diag, E_VALUE, "there are no modes");
        diag_hint(diag, "'modes' shows why");
        return E_VALUE;
    }
    if (count != 1 || index[0] < 1 || index[0] > session->modes->count)
        return diag_set(diag, E_VALUE, "there %s %d mode%s, counted from 1",
                        session->modes->count == 1 ? "is" : "are", session->modes->count,
                        session->modes->count == 1 ? "" : "s");
    *out = entries[entry].of(&session->modes->at[index[0] - 1]);
    return OK;
}

static Status linear_entry(const ct_session *session, int entry, const int *index, int count,
                           double *out, Diag *diag)
{
    LinearMatrix matrix;

    if (session->linear == NULL) {
        (void)diag_set(diag, E_MISSING, "nothing has been linearized yet");
        diag_hint(diag, "linearize inputs=[V1] outputs=[h8]");
        return E_MISSING;
    }
    matrix = linear_matrix(session->linear, strchr(entries[entry].name, '.')[1]);
    if (count != 2 || index[0] < 1 || index[0] > matrix.rows || index[1] < 1 ||
        index[1] > matrix.columns)
        return diag_set(diag, E_VALUE, "%s has %d rows and %d columns, counted from 1",
                        entries[entry].name, matrix.rows, matrix.columns);
    *out = matrix.at[(index[0] - 1) * matrix.columns + index[1] - 1];
    return OK;
}

/* of a parameter, or of the value of a source or an actuator */
static bool input_dimension(const Model *model, const char *name, Dimension *out)
{
    const Instance *source = model_find(model, name);
    Unit unit;
    size_t fault;
    int param;

    if (source == NULL)
        return model_text_dimension(model, name, out);
    param = instance_input(source);
    if (param < 0 || source->row->params[param].unit == NULL ||
        !unit_parse(source->row->params[param].unit, strlen(source->row->params[param].unit), &unit,
                    &fault))
        return false;
    *out = unit.dimension;
    return true;
}

/* a whole number from 1 that is written out; 0: something else */
static int written_index(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_NUMBER && !syntax->has_unit &&
                   syntax->text[strspn(syntax->text, "0123456789")] == '\0' &&
                   strlen(syntax->text) < 6
               ? (int)strtol(syntax->text, NULL, 10)
               : 0;
}

/* rows are of rates of states, or of outputs; columns of states, or of inputs */
bool session_entry_dimension(void *context, const Syntax *call, Dimension *out)
{
    static const Dimension second = {{0, 0, 1, 0, 0, 0}};
    const ct_session *session = context;
    const int entry = session_entry(call->text);
    Dimension row = {{0}}, column = {{0}};
    LinearMatrix matrix;
    int i, j;

    if (sweep_entry_is_called(call))
        return sweep_entry_dimension(session, call, out);
    if (fit_entry_is_called(call))
        return fit_entry_dimension(session, call, out);
    if (optimum_entry_is_called(call))
        return optimum_entry_dimension(session, call, out);
    if (entry < 0 || entries[entry].of != NULL || session->linear == NULL || call->count != 2)
        return false;
    matrix = linear_matrix(session->linear, strchr(entries[entry].name, '.')[1]);
    i = written_index(call->args[0]);
    j = written_index(call->args[1]);
    if (i < 1 || i > matrix.rows || j < 1 || j > matrix.columns ||
        !model_text_dimension(session->model, matrix.row_names[i - 1], &row) ||
        !(matrix.column_names == session->linear->input_names
              ? input_dimension
              : model_text_dimension)(session->model, matrix.column_names[j - 1], &column))
        return false;
    return dimension_times(row, column, -1, out) &&
           (matrix.row_names != session->linear->state_names ||
            dimension_times(*out, second, -1, out));
}

Status session_entry_value(const ct_session *session, int entry, const int *index, int count,
                           double *out, Diag *diag)
{
    return entries[entry].of != NULL ? mode_entry(session, entry, index, count, out, diag)
                                     : linear_entry(session, entry, index, count, out, diag);
}
