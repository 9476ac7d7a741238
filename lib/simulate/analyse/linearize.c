/* linearize.c: derivatives of the equations along the constraints
 *
 * With w = (q, u, x) and the unknowns e = (u', lambda, x', z) that it determines, all equations are
 * E(w, e, inputs) = 0, and a deviation of w gives E_e de = -E_w dw. A deviation of one state also
 * moves the dependent coordinates and speeds: Phi_u ds = 0, (Phi_u u - nu)_q dq + Phi_u du = 0, dq
 * = N ds. Velocity rows determine speeds alone, so that there are more independent coordinates. */
#include "simulate/analyse/linearize_impl.h"

#include "base/memory.h"
#include "base/text.h"
#include "simulate/analyse/analyse_limits.h"

#include <math.h>
#include <string.h>

/* --- the equations, with symbols for inputs --- */

typedef struct LinearizeVary {
    const LinearOrder *order;
    const Expr *symbols;
    Arena *arena;
    Expr since; /* time after the point */
} LinearizeVary;

static Expr vary(void *context, const Instance *instance, int param, Expr value)
{
    const LinearizeVary *v = context;

    for (int i = 0; instance != NULL && i < v->order->input_count; i++) {
        const char *source = v->order->inputs[i].source;

        if (source != NULL && strcmp(source, instance->name) == 0 &&
            param == instance_input(instance))
            value = expr_sum(
                v->arena,
                (Expr[]){value, v->symbols[i],
                         expr_mul(v->arena, v->symbols[v->order->input_count + i], v->since)},
                3);
    }
    return value;
}

static double parameter(void *context, Expr symbol)
{
    const Work *w = context;

    for (int i = 0; i < 2 * w->order->input_count; i++)
        if (w->inputs[i] == symbol && w->order->inputs[i % w->order->input_count].source != NULL)
            return 0;
    return parameters_value(&w->order->about->phases->parameters, symbol);
}

static Status check_input(const Scene *scene, const LinearOrder *order, int i, Diag *diag)
{
    const char *name = order->inputs[i].source;

    if (name == NULL)
        return OK;
    for (int k = 0; k < scene->instance_count; k++)
        if (strcmp(scene->instances[k]->name, name) == 0 &&
            instance_input(scene->instances[k]) >= 0)
            return OK;
    (void)diag_set(diag, E_NAME, "%s has no value that an input could be", name);
    diag_hint(diag, "inputs are sources, actuators, and parameters: F = 0 N; force "
                    "F1 m1 [F, 0]; linearize inputs=[F]");
    return E_NAME;
}

static Status find_point(Work *w, Diag *diag)
{
    const double *y, *driven;

    TRY(result_reader_at(w->order->about, w->order->at, &w->phase, &y, &driven, diag));
    w->y = NEW_ARRAY(double, w->phase->length);
    memcpy(w->y, y, (size_t)w->phase->length * sizeof(double));
    return OK;
}

static Status open_system(Work *w, Diag *diag)
{
    const LinearOrder *order = w->order;
    Arena *arena = system_arena(order->about->result->system);
    LinearizeVary of = {
        order, NULL, arena,
        expr_sub(arena, expr_symbol(arena, "t", SYMBOL_TIME), expr_real(arena, order->at))};
    SystemOptions options = {.vary = vary, .context = &of, .watch = order->watch};
    Scene scene = {0};
    bool needed = false;
    Status status = OK;

    CHECK(order->scene.make(order->scene.context, &scene, diag));
    w->inputs = NEW_ARRAY(Expr, 2 * order->input_count);
    of.symbols = w->inputs;
    for (int i = 0; i < order->input_count; i++) {
        Text name = {0};

        CHECK(check_input(&scene, order, i, diag));
        text_addf(&name, order->inputs[i].source != NULL ? "#%s" : "%s", order->inputs[i].name);
        w->inputs[i] = expr_symbol(arena, name.at, SYMBOL_PARAMETER);
        text_addf(&name, "#rate");
        w->inputs[order->input_count + i] = expr_symbol(arena, name.at, SYMBOL_PARAMETER);
        text_free(&name);
        needed = needed || order->inputs[i].source != NULL;
    }
    CHECK(find_point(w, diag));
    w->system = w->phase->system;
    if (needed && system_revision(w->system) != scene.revision) {
        (void)diag_set(diag, E_MODEL,
                       "the model has changed since the run, so its sources are no "
                       "inputs there");
        diag_hint(diag, "run it again, or linearize about the start");
        CHECK(E_MODEL);
    }
    if (needed) {
        options.like = w->system;
        CHECK(system_new_view(&scene, &options, &w->varied, diag));
        w->system = w->varied;
    }
    w->l = variable_index_new(w->system);
    if (w->phase->closed != NULL)
        variable_index_set_sides(w->l, w->phase->closed);
    w->parameters = (Parameters){.value = parameter,
                                 .context = w,
                                 .evaluator = w->order->about->phases->parameters.evaluator};
done:
    scene_free(&scene);
    return status;
}

/* --- programs --- */

static void place_columns(Work *w)
{
    const VariableIndex *l = w->l;
    Columns *at = &w->at;
    const struct {
        int *place;
        const Expr *symbols;
        int count;
    } parts[] = {{&at->q, l->symbols + l->q, l->n},
                 {&at->u, l->symbols + l->u, l->nu},
                 {&at->x, l->symbols + l->x, l->nx},
                 {&at->acceleration, l->symbols + l->acceleration, l->nu},
                 {&at->multipliers, l->symbols + l->multipliers, l->m},
                 {&at->rates, l->symbols + l->rates, l->nx},
                 {&at->z, l->symbols + l->z, l->nz},
                 {&at->inputs, w->inputs, 2 * w->order->input_count}};

    at->place = NEW_ARRAY(int, l->count + 2 * w->order->input_count);
    for (int p = 0; p < COUNT(parts); p++) {
        *parts[p].place = at->count;
        for (int i = 0; i < parts[p].count; i++)
            at->place[at->count++] = probe_place(w->derived, parts[p].symbols[i]);
    }
}

typedef LIST(Expr) LinearizeRoots;

static Status push_rows(Work *w, LinearizeRoots *roots, Diag *diag)
{
    const VariableIndex *l = w->l;
    const EquationForm *run = system_run(l->system);

    w->rows.balance = 0;
    LIST_ROOM(*roots, l->nu);
    TRY(rows_balance(l, roots->at, diag));
    roots->count = l->nu;
    w->rows.acceleration = roots->count;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, row_acceleration(l, k));
    w->rows.network = roots->count;
    for (int i = 0; i < l->nx + l->nz; i++)
        LIST_PUSH(*roots, row_network(l, i));
    w->rows.velocity = roots->count;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, row_velocity(l, k));
    w->rows.phi = roots->count;
    for (int k = 0; k < l->m; k++)
        LIST_PUSH(*roots, run->phi[k]);
    w->rows.q_rate = roots->count;
    for (int i = 0; i < l->n; i++)
        LIST_PUSH(*roots, run->q_rate[i]);
    w->rows.outputs = roots->count;
    for (int i = 0; i < w->order->output_count; i++) {
        Expr e;

        TRY(system_resolve(l->system, w->order->outputs[i], &e, diag));
        LIST_PUSH(*roots, e);
    }
    w->rows.count = roots->count;
    return OK;
}

static Status compile(Work *w, Diag *diag)
{
    const VariableIndex *l = w->l;
    const EquationForm *run = system_run(l->system);
    LinearizeRoots rows = {0}, geometry = {0};
    Status status = OK;

    CHECK(push_rows(w, &rows, diag));
    CHECK(probe_new(l, &w->parameters, rows.at, rows.count, &w->derived, diag));
    place_columns(w);
    for (int i = 0; i < l->m * l->nu; i++)
        LIST_PUSH(geometry, run->phi_u[i]);
    for (int i = 0; i < l->n; i++)
        for (int j = 0; j < l->nu; j++)
            LIST_PUSH(geometry, system_n_entry(l->system, i, j));
    CHECK(probe_new(l, &w->parameters, geometry.at, geometry.count, &w->geometry, diag));
    w->along = tangents_new(residual_program(probe_residual(w->derived)));
    w->turning = tangents_new(residual_program(probe_residual(w->geometry)));
done:
    LIST_FREE(rows);
    LIST_FREE(geometry);
    return status;
}

/* --- the order --- */

static void dependence_free(Dependence *d)
{
    partitioning_free(d->partitioning);
    verified_solve_free(d->held);
    MEM_FREE(d->rows, d->is_independent, d->matrix, d->error);
}

static void work_free(Work *w)
{
    tangents_free(w->along);
    tangents_free(w->turning);
    probe_free(w->derived);
    probe_free(w->geometry);
    parameters_free(&w->parameters);
    variable_index_free(w->l);
    system_free(w->varied);
    dependence_free(&w->speeds);
    dependence_free(&w->own_places);
    MEM_FREE(w->inputs, w->at.place);
    verified_solve_free(w->equations);
    MEM_FREE(w->y, w->y_error, w->follow, w->follow_error, w->values, w->phi_u, w->map, w->matrix,
             w->matrix_error);
}

/* Names the laws that jump where they are linearized: their derivative there is none. */
static Status find_jumps(const Work *w, Linear *linear, Diag *diag)
{
    System *system = w->phase->system;
    LinearizeRoots conditions = {0};
    SystemSurface surface;
    Probe *probe = NULL;
    double *values = NULL;
    Text names = {0};
    Status status = OK;

    /* friction of a contact is named with the contact, or idle */
    for (int i = 0; system_surface(system, i, &surface); i++)
        if (surface.load < 0)
            LIST_PUSH(conditions, surface.condition);
    if (conditions.count == 0)
        goto done;
    CHECK(probe_new(w->phase->layout, &w->order->about->phases->parameters, conditions.at,
                    conditions.count, &probe, diag));
    values = NEW_ARRAY(double, conditions.count);
    phase_probe_at(w->phase, probe, w->order->at, w->y, NULL, conditions.count, values);
    for (int i = 0; i < conditions.count; i++) {
        const char *part = system_jumping_part(system, conditions.at[i]);

        if (fabs(values[i]) <= LINEARIZE_ON_JUMP)
            text_addf(&names, "%s%s", names.length > 0 ? ", " : "", part != NULL ? part : "a law");
    }
    linear->on_jump = names.at != NULL ? text_done(&names) : NULL;
done:
    text_free(&names);
    probe_free(probe);
    mem_free(values);
    LIST_FREE(conditions);
    return status;
}

Status linearize(const LinearOrder *order, Linear **out, Diag *diag)
{
    Work w = {.order = order};
    Status status = OK;

    CHECK(phase_refuse_by(result_reader_first(order->about), diag));
    CHECK(open_system(&w, diag));
    monitor_report(order->watch, "linearizing", -1);
    CHECK(compile(&w, diag));
    CHECK(linear_point(&w, diag));
    CHECK(linear_settled(&w, out, diag));
    (*out)->is_passing = linear_is_passing(&w, *out);
    status = find_jumps(&w, *out, diag);
    if (status != OK) {
        linear_free(*out);
        *out = NULL;
    }
done:
    work_free(&w);
    return status;
}
