/* system_build.c: a System from a scene: copied parts, variables, and the order in which it is
 * built */
#include "component/equation_block.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/dynamics/shapes.h"
#include "formulate/expanded/equation_form.h"
#include "formulate/kinematics/constraint_rows.h"
#include "formulate/kinematics/frames.h"
#include "formulate/kinematics/identity.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/kinematics/multi_turn.h"
#include "formulate/kinematics/recursive.h"
#include "formulate/network/network_build.h"
#include "formulate/system/constraints.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/system_impl.h"
#include "formulate/system_build/ideal.h"
#include "formulate/system_build/lifted_constants.h"

#include <string.h>

/* Number of modes with equations of their own, which are the shortest. After these a run of a
 * network goes through further modes with numbers for sides, as forming and compiling a mode takes
 * the time of many steps. */
#ifndef FORMED
#define FORMED 8
#endif

/* --- copies of data that may change later --- */

static const char *keep_name(const System *system, const char *name)
{
    return pool_text(system->pool, name, strlen(name));
}

static const char **copy_names(const System *system, const char *const *from, int count)
{
    const char **names = pool_alloc(system->pool, (size_t)count * sizeof *names);

    for (int i = 0; i < count; i++)
        names[i] = from[i] != NULL ? keep_name(system, from[i]) : NULL;
    return names;
}

static void *copy_array(const System *system, const void *from, int count, size_t size)
{
    void *copy = pool_alloc(system->pool, (size_t)count * size);

    if (count > 0)
        memcpy(copy, from, (size_t)count * size);
    return copy;
}

static void copy_instance(System *system, const Instance *from, Instance *to)
{
    const int coordinates = from->coord_count;

    *to = *from;
    to->name = keep_name(system, from->name);
    to->text = NULL;
    to->given = equation_block_copy(system->pool, from->given);
    if (from->coordinate != NULL)
        to->coordinate = keep_name(system, from->coordinate);
    to->terminals =
        copy_array(system, from->terminals, from->terminal_count, sizeof *to->terminals);
    to->terminal_names = copy_names(system, from->terminal_names, from->terminal_count);
    to->scalar_edges =
        copy_array(system, from->scalar_edges, from->scalar_count, sizeof *to->scalar_edges);
    to->coord = copy_names(system, from->coord, coordinates);
    to->coord_kind = copy_array(system, from->coord_kind, coordinates, sizeof *to->coord_kind);
    to->coord_rotation =
        copy_array(system, from->coord_rotation, coordinates, sizeof *to->coord_rotation);
    to->values = values_copy(system->pool, from->values, from->row->param_count);
}

/* indices of an instance's coordinates, none yet */
static int *no_places(const System *system, int count)
{
    int *places = pool_alloc(system->pool, (size_t)count * sizeof *places);

    for (int i = 0; i < count; i++)
        places[i] = -1;
    return places;
}

static void copy_instances(System *system, const Scene *scene)
{
    const int count = scene->instance_count;
    Origin *origin = system->origin;
    Kinematics *kinematics = system->kinematics;

    origin->instance_count = count;
    origin->instances = pool_alloc(system->pool, (size_t)count * sizeof *origin->instances);
    kinematics->coordinate =
        pool_alloc(system->pool, (size_t)count * sizeof *kinematics->coordinate);
    kinematics->speed = pool_alloc(system->pool, (size_t)count * sizeof *kinematics->speed);
    for (int i = 0; i < count; i++) {
        const Instance *from = scene->instances[i];

        copy_instance(system, from, &origin->instances[i]);
        kinematics->coordinate[i] = no_places(system, from->coord_count);
        kinematics->speed[i] = no_places(system, from->coord_count);
    }
}

/* a name finds the first that has it */
static void enter_names(System *system)
{
    int coordinates = 0;

    for (int i = 0; i < system->origin->instance_count; i++)
        coordinates += system->origin->instances[i].coord_count;
    system->origin->instance_names = names_borrowing();
    system->origin->coordinate_names = names_borrowing();
    names_expect(system->origin->instance_names, system->origin->instance_count);
    names_expect(system->origin->coordinate_names, coordinates);
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];

        (void)names_add(system->origin->instance_names, instance->name);
        for (int c = 0; c < instance->coord_count; c++)
            if (names_add(system->origin->coordinate_names, instance->coord[c]) ==
                system->origin->coordinate_owners.count)
                LIST_PUSH(system->origin->coordinate_owners, (CoordinateOwner){i, c});
    }
}

static void vary_values(System *system, VaryValue vary, void *context)
{
    for (int i = 0; i < system->origin->instance_count; i++) {
        Instance *instance = &system->origin->instances[i];

        for (int k = 0; k < instance->row->param_count; k++)
            for (int c = 0; c < instance->values[k].count; c++)
                instance->values[k].at[c] = vary(context, instance, k, instance->values[k].at[c]);
    }
    for (int i = 0; i < 3; i++)
        system->origin->gravity.at[i] = vary(context, NULL, -1, system->origin->gravity.at[i]);
}

static void copy_graph(System *system, const Scene *scene)
{
    Origin *origin = system->origin;

    origin->graph = graph_copy(scene->graph);
    for (TreeKind kind = 0; kind < TREE_KINDS; kind++)
        if (scene->trees[kind] != NULL)
            origin->trees[kind] = tree_copy(scene->trees[kind], origin->graph);
}

static void copy_outputs(System *system, const Scene *scene)
{
    int count = scene->outputs.count;

    system->origin->output_count = count;
    system->origin->output_names = pool_alloc(system->pool, (size_t)count * sizeof(char *));
    system->origin->outputs = pool_alloc(system->pool, (size_t)count * sizeof(Expr));
    for (int i = 0; i < count; i++) {
        system->origin->outputs[i] = scene->outputs.at[i].body;
        system->origin->output_names[i] = keep_name(system, scene->outputs.at[i].name);
    }
}

static void copy_uses(System *system, const Scene *scene)
{
    Origin *origin = system->origin;

    origin->use_count = scene->uses.count;
    origin->uses = pool_alloc(system->pool, (size_t)scene->uses.count * sizeof *origin->uses);
    for (int i = 0; i < scene->uses.count; i++) {
        const SceneUse *use = &scene->uses.at[i];

        origin->uses[i] = (Instanced){.name = keep_name(system, use->name),
                                      .definition = keep_name(system, use->definition),
                                      .outer = use->outer,
                                      .first = -1};
    }
}

static void copy_rests(System *system, const SystemOptions *options)
{
    Origin *origin = system->origin;
    const Origin *like = options->like != NULL ? options->like->origin : NULL;

    origin->rest_count = like != NULL ? like->rest_count : options->rest_count;
    origin->rests = copy_array(system, like != NULL ? like->rests : options->rests,
                               origin->rest_count, sizeof *origin->rests);
}

static void copy_form(System *system, const Scene *scene)
{
    system->origin->form = scene->form;
    system->origin->independent_count = scene->independent_count;
    system->origin->independent =
        pool_alloc(system->pool, (size_t)scene->independent_count * sizeof(char *));
    for (int i = 0; i < scene->independent_count; i++)
        system->origin->independent[i] = keep_name(system, scene->independent[i]);
}

/* --- variables --- */

static void add_speed(System *system, Variable of, const char *name)
{
    of.name = name;
    of.symbol = expr_symbol(system->arena, name, SYMBOL_SPEED);
    LIST_PUSH(system->kinematics->u, of);
}

static void add_coordinate(System *system, const Instance *instance, int c)
{
    const char *name = instance->coord[c];
    const int shape = c - instance->pose_count;
    Variable own = {.name = name,
                    .symbol = expr_symbol(system->arena, name, SYMBOL_COORDINATE),
                    .edge = instance->edge,
                    .instance = instance->number,
                    .is_angle = instance->coord_kind[c] == COORDINATE_ANGLE,
                    .is_shape = shape >= 0 && instance_bends(instance),
                    .unit = 1};

    if (own.is_shape)
        own.unit = instance->row->deforming->unit(instance, system->origin->planar, shape);
    system->kinematics->coordinate[instance->number][c] = system->kinematics->q.count;
    LIST_PUSH(system->kinematics->q, own);
    if (instance->coord_kind[c] == COORDINATE_PARAMETER)
        return;
    system->kinematics->speed[instance->number][c] = system->kinematics->u.count;
    add_speed(system, own, system_join(system, name, "'"));
}

/* four Euler parameters go with three components of angular velocity, in the axes of the head */
static void add_parameters(System *system, const Instance *instance, int first)
{
    static const char *const speeds[] = {"Wx", "Wy", "Wz"};

    LIST_PUSH(system->kinematics->quaternions, system->kinematics->q.count);
    system->kinematics->speed[instance->number][first] = system->kinematics->u.count;
    for (int c = first; c < first + 4; c++)
        add_coordinate(system, instance, c);
    for (int i = 0; i < 3; i++)
        add_speed(
            system,
            (Variable){
                .edge = instance->edge, .instance = instance->number, .is_angle = true, .unit = 1},
            system_retain(system, "%s.%s", instance->name, speeds[i]));
}

/* coordinates of branches, each half in the tree of its half, in the order in which the edges were
 * made */
static void add_coordinates(System *system)
{
    const Tree *const halves[2] = {system->origin->trees[TREE_TRANSLATION],
                                   system->origin->trees[TREE_ROTATION]};

    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *instance = &system->origin->instances[i];

        if (instance->row->steps == NULL || instance->edge < 0)
            continue;
        for (int c = 0; c < instance->coord_count; c++) {
            bool branch = c >= instance->pose_count ||
                          tree_has(halves[instance->coord_rotation[c]], instance->edge);

            if (instance->coord_kind[c] != COORDINATE_PARAMETER && branch)
                add_coordinate(system, instance, c);
            else if (branch) {
                add_parameters(system, instance, c);
                c += 3;
            }
        }
    }
    system->kinematics->accelerations =
        pool_alloc(system->pool, (size_t)system->kinematics->u.count * sizeof(Expr));
    for (int j = 0; j < system->kinematics->u.count; j++) {
        system->kinematics->accelerations[j] =
            expr_symbol(system->arena, system_join(system, system->kinematics->u.at[j].name, "'"),
                        SYMBOL_ACCELERATION);
    }
}

/* a new rate of a coordinate, by `count` speeds, which the caller sets */
static CoordinateRate *new_rate(System *system, int place, int count)
{
    CoordinateRate *rate = &system->kinematics->coordinate_rates[place];

    rate->count = count;
    rate->speed = pool_alloc(system->pool, (size_t)count * sizeof *rate->speed);
    rate->entry = pool_alloc(system->pool, (size_t)count * sizeof *rate->entry);
    return rate;
}

/* p' = N w, N = 1/2 [-e^T; e0 1 + S(e)] */
static void parameter_rates(System *system, int first, int speed)
{
    Arena *arena = system->arena;
    Expr half = expr_rational(arena, 1, 2);
    Expr p[4];

    for (int i = 0; i < 4; i++)
        p[i] = expr_mul(arena, half, system->kinematics->q.at[first + i].symbol);
    for (int i = 0; i < 4; i++) {
        CoordinateRate *rate = new_rate(system, first + i, 3);

        for (int k = 0; k < 3; k++) {
            int row = i - 1;

            rate->speed[k] = speed + k;
            if (i == 0)
                rate->entry[k] = expr_neg(arena, p[1 + k]);
            else if (row == k)
                rate->entry[k] = p[0];
            else if (k == (row + 1) % 3)
                rate->entry[k] = expr_neg(arena, p[1 + 3 - row - k]);
            else
                rate->entry[k] = p[1 + 3 - row - k];
        }
    }
}

static void add_rates(System *system)
{
    Arena *arena = system->arena;
    size_t count = (size_t)system->kinematics->q.count;

    system->kinematics->coordinate_rates =
        pool_alloc(system->pool, count * sizeof *system->kinematics->coordinate_rates);
    system->run.q_rate = pool_alloc(system->pool, count * sizeof(Expr));
    for (int i = 0; i < system->origin->instance_count; i++)
        for (int c = 0; c < system->origin->instances[i].coord_count; c++) {
            int place = system->kinematics->coordinate[i][c];
            int speed = system->kinematics->speed[i][c];
            CoordinateRate *rate;

            if (place < 0 || speed < 0)
                continue;
            if (system->origin->instances[i].coord_kind[c] == COORDINATE_PARAMETER) {
                parameter_rates(system, place, speed);
                continue;
            }
            rate = new_rate(system, place, 1);
            rate->speed[0] = speed;
            rate->entry[0] = expr_int(arena, 1);
        }
    for (int i = 0; i < system->kinematics->q.count; i++) {
        const CoordinateRate *rate = &system->kinematics->coordinate_rates[i];

        system->run.q_rate[i] = expr_int(arena, 0);
        for (int k = 0; k < rate->count; k++)
            system->run.q_rate[i] = expr_add(
                arena, system->run.q_rate[i],
                expr_mul(arena, rate->entry[k], system->kinematics->u.at[rate->speed[k]].symbol));
    }
}

/* finds what supplies the motion of each driver */
static void add_drives(System *system)
{
    for (int i = 0; i < system->origin->instance_count; i++) {
        const Instance *driver = &system->origin->instances[i];
        Drive drive = {.instance = i, .constraint = -1};

        if (driver->row->family != FAMILY_DRIVER)
            continue;
        drive.by_source = driver->by >= 0 && driver->by_coordinate < 0;
        if (driver->by >= 0) {
            const Instance *by = &system->origin->instances[driver->by];
            const char *name = drive.by_source ? system_retain(system, "%s.value", by->name)
                                               : system_retain(system, "%s.effort",
                                                               by->coord[driver->by_coordinate]);

            drive.effort = expr_symbol(system->arena, name, SYMBOL_EFFORT);
        }
        LIST_PUSH(system->constraints->drives, drive);
    }
}

/* Makes a multiplier for each constraint row, and finds the row of each driver: its effort is
 * -lambda, unless it is known already. */
static void number_rows(System *system)
{
    system->constraints->multipliers =
        pool_alloc(system->pool, (size_t)system->constraints->rows.count * sizeof(Expr));
    for (int k = 0; k < system->constraints->rows.count; k++) {
        const char *name = system_retain(system, "lambda(%d)", k + 1);

        system->constraints->multipliers[k] = expr_symbol(system->arena, name, SYMBOL_MULTIPLIER);
        for (int i = 0; i < system->constraints->drives.count; i++) {
            Drive *drive = &system->constraints->drives.at[i];

            if (!system->constraints->rows.at[k].reported.is_driver ||
                system->constraints->rows.at[k].reported.instance != drive->instance)
                continue;
            drive->constraint = k;
            if (drive->effort == NULL)
                drive->effort = expr_neg(system->arena, system->constraints->multipliers[k]);
        }
    }
}

/* --- making and freeing --- */

static Status build(System *system, Diag *diag)
{
    Status status = OK;

    if (system->origin->trees[TREE_TRANSLATION] != NULL) {
        add_coordinates(system);
        add_rates(system);
    }
    add_drives(system);
    frames_build(system);
    isomorphic_build(system);
    identities_build(system);
    isomorphic_find_recalled(system);
    multi_turn_build(system);
    motion_build(system);
    elastics_build(system);
    system->is_early = true;
    CHECK(network_build(system, diag));
    if (system->origin->trees[TREE_TRANSLATION] != NULL)
        CHECK(constraints_build(system, diag));
    number_rows(system);
    if (system->origin->trees[TREE_TRANSLATION] != NULL)
        CHECK(dynamics_build(system, diag));
    system->is_early = false;
    CHECK(network_rows(system, diag));
    CHECK(equation_form_choose(system, diag));
    multi_turn_add_rows(system);
    CHECK(monitor_poll(system->watch));
    if (arena_status(system->arena) != OK) {
        status = diag_set(diag, arena_status(system->arena), "the equations can't be formed: %s",
                          arena_failure(system->arena));
        arena_reset(system->arena);
    }
done:
    isomorphic_free(system->alike);
    system->alike = NULL;
    return status;
}

/* the arguments from which a new System is built */
typedef struct SystemBuilder {
    const Scene *scene;
    const SystemOptions *options;
    NetworkForm taken;  /* the user's form or, where a state form doesn't exist, the other */
    const bool *closed; /* sides of ideal switches; NULL: in no mode */
    int closed_count;
    bool takes_sides; /* the sides of other switches are numbers, */
    bool takes_all;   /* and those of ideal switches too */
} SystemBuilder;

static const bool *keep_sides(System *system, const SystemBuilder *making)
{
    size_t bytes = (size_t)making->closed_count * sizeof(bool);
    bool *kept = pool_alloc(system->pool, bytes);

    if (making->closed == NULL)
        return NULL;
    memcpy(kept, making->closed, bytes);
    return kept;
}

/* expression nodes of a part's equations, at least */
enum { NODES_OF_A_PART = 24 };

static void take_scene(System *system, const SystemBuilder *making)
{
    const Scene *scene = making->scene;
    const SystemOptions *options = making->options;

    system->arena = scene->arena;
    arena_expect(system->arena, NODES_OF_A_PART * scene->instance_count);
    system->origin->revision = scene->revision;
    system->origin->planar = scene->planar;
    for (int i = 0; i < 3; i++)
        system->origin->gravity.at[i] = scene->gravity[i];
    for (int i = 0; i < scene->parameters.count; i++)
        LIST_PUSH(system->origin->parameters,
                  (GivenParameter){scene->parameters.at[i].symbol, scene->parameters.at[i].value});
    copy_instances(system, scene);
    enter_names(system);
    system->origin->wants_lifted = options->has_lifted;
    lifted_constants_set(system, scene);
    if (options->vary != NULL)
        vary_values(system, options->vary, options->context);
    copy_outputs(system, scene);
    copy_form(system, scene);
    copy_uses(system, scene);
    copy_rests(system, options);
}

static Status build_system_as(const SystemBuilder *making, bool *has_no_states, System **out,
                              Diag *diag)
{
    const CallMonitor *watch = making->options->watch;
    System *system = NEW(System);
    Status status = OK;

    system->pool = pool_new(0);
    system->origin = NEW(Origin);
    system->kinematics = NEW(Kinematics);
    system->constraints = NEW(Constraints);
    system->dynamics = NEW(Dynamics);
    system->network = NEW(Network);
    system->shown = NEW(Shown);
    system->scene = making->scene;
    system->network->asked_form = making->options->form;
    system->network->form = making->taken;
    system->network->gmin = making->options->gmin;
    system->network->closed = keep_sides(system, making);
    system->network->takes_sides = making->takes_sides;
    system->network->takes_all = making->takes_all;
    system->watch = watch;
    system->variable = system_variable;
    monitor_report(watch, "formulating", -1.0);
    take_scene(system, making);
    copy_graph(system, making->scene);
    CHECK(build(system, diag));
    *out = system;
    system->scene = NULL;
    system->watch = NULL;
    system = NULL;
done:
    if (status == E_STOPPED)
        (void)diag_set(diag, E_STOPPED, "stopped while the equations were formed");
    *has_no_states = system != NULL && system->network->has_no_states;
    system_free(system);
    return status;
}

/* Controlled sources among inductors or capacitors alone admit no state form; the equations of the
 * trees as they are can still be brought to a solvable form. */
static Status make(SystemBuilder making, System **out, Diag *diag)
{
    bool has_no_states = false;
    Diag why = {0};
    Status status;

    making.taken = making.options->form;
    status = build_system_as(&making, &has_no_states, out, diag);
    if (status != E_MODEL || !has_no_states)
        return status;
    making.taken = NETWORK_TREE;
    return build_system_as(&making, &has_no_states, out, &why) == OK ? OK : status;
}

static Status make_new(const Scene *scene, const SystemOptions *options, System **out, Diag *diag)
{
    SystemBuilder making = {.scene = scene, .options = options};

    if (options->like != NULL) {
        making.closed = options->like->network->closed;
        making.closed_count = options->like->network->ideals.count;
        making.takes_sides = options->like->network->takes_sides;
        making.takes_all = options->like->network->takes_all;
    }
    return make(making, out, diag);
}

Status system_new(const Scene *scene, const SystemOptions *options, const System **out, Diag *diag)
{
    System *system;
    Status status = make_new(scene, options, &system, diag);

    if (status == OK)
        *out = system;
    return status;
}

/* a view that owns it */
static System *viewed(const System *formed)
{
    System *view = system_view(formed);

    view->owns_formed = true;
    return view;
}

Status system_new_view(const Scene *scene, const SystemOptions *options, System **out, Diag *diag)
{
    System *system;
    Status status = make_new(scene, options, &system, diag);

    if (status == OK)
        *out = viewed(system);
    return status;
}

/* builds the equations of a mode that `whole` doesn't have yet */
static Status make_sided(System *whole, SceneSource source, const bool *closed, bool takes_all,
                         const CallMonitor *watch, System **out, Diag *diag)
{
    const SystemOptions options = {.watch = watch,
                                   .has_lifted = whole->origin->wants_lifted,
                                   .rests = whole->origin->rests,
                                   .rest_count = whole->origin->rest_count};
    Scene scene = {0};
    System *made;
    Status status = OK;

    CHECK(source.make(source.context, &scene, diag));
    if (whole->origin->revision != scene.revision) {
        status =
            diag_set(diag, E_MODEL,
                     "the switches ask for equations that aren't made yet, of a model that has "
                     "changed since");
        diag_hint(diag, "start a new run");
        goto done;
    }
    CHECK(make((SystemBuilder){.scene = &scene,
                               .options = &options,
                               .closed = closed,
                               .closed_count = whole->network->ideals.count,
                               .takes_sides = true,
                               .takes_all = takes_all},
               &made, diag));
    *out = viewed(made);
    (*out)->whole = whole;
done:
    scene_free(&scene);
    return status;
}

/* whether the ideal switches are on the sides of that mode */
static bool is_mode(const System *mode, const bool *closed)
{
    for (int i = 0; i < mode->network->ideals.count; i++)
        if (system_is_ideal(mode, i) && mode->network->closed[i] != closed[i])
            return false;
    return true;
}

Status system_mode(System *whole, SceneSource source, const bool *closed, const CallMonitor *watch,
                   System **out, Diag *diag)
{
    system_touch(whole);
    System *mode = NULL;
    Status status = OK;

    for (int i = 0; i < whole->modes.count; i++)
        if (is_mode(whole->modes.at[i], closed)) {
            *out = whole->modes.at[i];
            return OK;
        }
    if (whole->modes.count >= FORMED && whole->kinematics->u.count == 0 &&
        ideal_keeps_states(whole, closed)) {
        if (whole->numbered == NULL)
            CHECK(make_sided(whole, source, closed, true, watch, &whole->numbered, diag));
        *out = whole->numbered;
        return OK;
    }
    CHECK(make_sided(whole, source, closed, false, watch, &mode, diag));
    LIST_PUSH(whole->modes, mode);
    *out = mode;
done:
    return status;
}

Status system_sided(System *whole, SceneSource source, const CallMonitor *watch, System **out,
                    Diag *diag)
{
    system_touch(whole);
    int ideal = system_truly_ideal_count(whole);
    bool *closed = NULL;
    Status status = OK;

    if (ideal == whole->network->ideals.count)
        whole->sided = whole;
    else if (whole->sided == NULL && ideal > 0)
        CHECK(make_sided(whole, source, NULL, false, watch, &whole->sided, diag));
    else if (whole->sided == NULL) {
        closed = NEW_ARRAY(bool, whole->network->ideals.count);
        CHECK(system_mode(whole, source, closed, watch, &whole->sided, diag));
    }
    *out = whole->sided;
done:
    mem_free(closed);
    return status;
}
