/* mechanism.c: a mechanism: which variables it is drawn from, its scale */
#include "present/mechanism_impl.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SHEET_WIDTH  800.0 /* px: no picture is larger */
#define SHEET_HEIGHT 560.0
#define MARGIN       70.0
#define LEAST_SIDE   360.0
#define FOOTER       40.0  /* px: below all that moves */
#define LONGEST      80.0  /* px: of the largest arrow */
#define LETTER       8.0   /* px: of the title */
#define HEAD         180.0 /* px: reserved next to the title */

enum { PER_NODE = 7, PER_LOAD = 6 }; /* items */

/* --- what it is drawn from --- */

static Expr variable(const Mechanism *mechanism, const char *owner, const char *member)
{
    Text name = {0};
    Expr symbol;

    text_addf(&name, "%s.%s", owner, member);
    symbol = expr_symbol(model_arena(mechanism->view->model), name.at, SYMBOL_VARIABLE);
    text_free(&name);
    return symbol;
}

static void add_node(Mechanism *mechanism, int node)
{
    static const char *const members[PER_NODE] = {"x", "y", "z", "q0", "q1", "q2", "q3"};

    mechanism->place[node] = mechanism->items.count;
    for (int i = 0; i < PER_NODE; i++)
        LIST_PUSH(mechanism->items,
                  variable(mechanism, graph_node(model_graph(mechanism->view->model), node)->name,
                           members[i]));
}

static void add_bent(Mechanism *mechanism, int bent)
{
    static const char *const axes[3] = {"x", "y", "z"};

    for (int k = 0; k < BENT_SPOTS; k++) {
        mechanism->place[mechanism->bents.at[bent].first + k] = mechanism->items.count;
        for (int i = 0; i < 3; i++) {
            char member[40];

            (void)snprintf(member, sizeof member, "%s(%.17g)", axes[i],
                           (double)k / (BENT_SPOTS - 1));
            LIST_PUSH(mechanism->items,
                      variable(mechanism, mechanism->bents.at[bent].part->name, member));
        }
    }
}

static void add_load(Mechanism *mechanism, const Instance *instance)
{
    Arena *arena = model_arena(mechanism->view->model);
    Load load = {.owner = instance, .node = instance->head, .first = mechanism->items.count};
    Expr force[3], torque[3];

    if (instance->row->wrench != NULL) {
        instance->row->wrench(instance, arena, model_is_planar(mechanism->view->model), force,
                              torque, &load.in_body);
    } else if (mechanism->options.reactions && instance->row->family == FAMILY_JOINT &&
               !instance->is_virtual) {
        static const char *const members[3] = {"fx", "fy", "fz"};
        const bool planar = model_is_planar(mechanism->view->model);

        load.reaction = true;
        for (int i = 0; i < 3; i++) {
            force[i] = planar && i == 2 ? expr_int(arena, 0)
                                        : variable(mechanism, instance->name, members[i]);
            torque[i] = expr_int(arena, 0);
        }
    } else {
        return;
    }
    for (int i = 0; i < PER_LOAD; i++)
        LIST_PUSH(mechanism->items, i < 3 ? force[i] : torque[i - 3]);
    LIST_PUSH(mechanism->loads, load);
}

static void add_rims(Mechanism *mechanism, const Instance *instance)
{
    const View *view = mechanism->view;
    ContactRing rings[MOST_RINGS];
    int count = 0;

    if (instance->row->rings != NULL)
        count = instance->row->rings(instance, model_arena(view->model),
                                     model_is_planar(view->model), rings);
    for (int k = 0; k < count; k++) {
        Rim rim = {.part = instance};

        for (int i = 0; i < 3; i++) {
            rim.first[i] = model_number(view->model, rings[k].first[i]);
            rim.second[i] = model_number(view->model, rings[k].second[i]);
        }
        LIST_PUSH(mechanism->rims, rim);
    }
}

/* Frames are fixed in the body that arms lead to them from. */
static void find_bodies(Mechanism *mechanism)
{
    const Model *model = mechanism->view->model;

    for (int n = 0; n < mechanism->nodes; n++) {
        const Node *node = graph_node(model_graph(model), n);

        mechanism->place[n] = mechanism->body[n] = -1;
        if (node->domain == DOMAIN_MECHANICAL && node->datum)
            mechanism->ground = mechanism->body[n] = n;
    }
    for (int i = 0; i < model_count(model); i++) {
        const Instance *instance = model_instance(model, i);

        if (instance->row->family == FAMILY_BODY)
            mechanism->body[instance->head] = instance->head;
        else if (instance->row->family == FAMILY_ARM)
            mechanism->body[instance->head] = mechanism->body[instance->tail];
    }
}

/* What gravity pulls down is below; else z is up. */
static void choose_axes(Mechanism *mechanism)
{
    static const double iso[3][3] = {{-0.7071067811865476, 0.7071067811865476, 0},
                                     {-0.408248290463863, -0.408248290463863, 0.816496580927726},
                                     {0.5773502691896258, 0.5773502691896258, 0.5773502691896258}};
    static const int planes[][3] = {
        [LOOK_XY] = {0, 1, 2}, [LOOK_XZ] = {0, 2, 1}, [LOOK_YZ] = {1, 2, 0}};
    const Model *model = mechanism->view->model;
    const Look look = model_is_planar(model) ? LOOK_XY : mechanism->options.look;
    const Expr *gravity = model_gravity(model);
    double most = 0;
    int up = 2;

    memset(mechanism->axes, 0, sizeof mechanism->axes);
    if (look != LOOK_ISO) {
        for (int i = 0; i < 3; i++)
            mechanism->axes[i][planes[look][i]] = look == LOOK_XZ && i == 2 ? -1 : 1;
        return;
    }
    for (int i = 0; i < 3; i++)
        if (fabs(model_number(model, gravity[i])) > most) {
            most = fabs(model_number(model, gravity[i]));
            up = i;
        }
    for (int row = 0; row < 3; row++)
        for (int i = 0; i < 3; i++)
            mechanism->axes[row][(i + up + 1) % 3] = iso[row][i];
}

Status mechanism_open(Mechanism *mechanism, const View *view, MechanismOptions options, Diag *diag)
{
    const Model *model = view->model;
    int bodies = 0;

    *mechanism = (Mechanism){.view = view, .options = options, .ground = -1};
    mechanism->nodes = mechanism->spots = graph_node_count(model_graph(model));
    for (int i = 0; i < model_count(model); i++) {
        const Instance *instance = model_instance(model, i);

        bodies += instance->row->family == FAMILY_BODY;
        if (instance_bends(instance)) {
            LIST_PUSH(mechanism->bents, ((Bent){instance, mechanism->spots}));
            mechanism->spots += BENT_SPOTS;
        }
    }
    mechanism->place = NEW_ARRAY(int, mechanism->spots);
    mechanism->body = NEW_ARRAY(int, mechanism->nodes);
    find_bodies(mechanism);
    if (bodies == 0) {
        (void)diag_set(diag, E_MISSING, "there is no body to draw");
        diag_hint(diag, "'draw' alone draws the linear graph");
        return E_MISSING;
    }
    for (int n = 0; n < mechanism->nodes; n++)
        if (mechanism->body[n] >= 0 && n != mechanism->ground)
            add_node(mechanism, n);
    for (int i = 0; i < mechanism->bents.count; i++)
        add_bent(mechanism, i);
    for (int i = 0; i < model_count(model); i++) {
        add_load(mechanism, model_instance(model, i));
        add_rims(mechanism, model_instance(model, i));
    }
    choose_axes(mechanism);
    mechanism_call(mechanism);
    return OK;
}

int mechanism_spot_items(const Mechanism *mechanism, int spot)
{
    return spot < mechanism->nodes ? PER_NODE : 3;
}

void mechanism_close(Mechanism *mechanism)
{
    LIST_FREE(mechanism->items);
    LIST_FREE(mechanism->loads);
    LIST_FREE(mechanism->bents);
    LIST_FREE(mechanism->rims);
    LIST_FREE(mechanism->names);
    MEM_FREE(mechanism->place, mechanism->body);
}

/* --- the scale --- */

/* the largest of a load's two vectors */
static void widen(const Mechanism *mechanism, const double *values, double *force, double *moment)
{
    for (int i = 0; i < mechanism->loads.count; i++) {
        const double *v = values + mechanism->loads.at[i].first;

        *force = fmax(*force, sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
        *moment = fmax(*moment, sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5]));
    }
}

/* how far a rim at a node reaches on the sheet at most, m */
static double reach_of(const Mechanism *mechanism, int node)
{
    double most = 0;

    for (int i = 0; i < mechanism->rims.count; i++) {
        const Rim *rim = &mechanism->rims.at[i];

        if (rim->part->head == node)
            most = fmax(most, fmax(hypot(hypot(rim->first[0], rim->first[1]), rim->first[2]),
                                   hypot(hypot(rim->second[0], rim->second[1]), rim->second[2])));
    }
    return most;
}

/* the area of all frames and ends of arrows, with the title above and the scales below */
static void lay_out_sheet(Mechanism *mechanism, const double *values, int rows)
{
    const char *title = model_title(mechanism->view->model);
    Point low = {0, 0}, high = {0, 0};

    mechanism->left = mechanism->top = 0;
    for (int r = 0; r < rows; r++) {
        const double *row = values + (size_t)r * (size_t)mechanism->items.count;

        for (int i = 0; i < mechanism->spots + mechanism->loads.count; i++) {
            const Load *load =
                i >= mechanism->spots ? &mechanism->loads.at[i - mechanism->spots] : NULL;
            double at[3], moment[3], reach;
            Point p, d = {0, 0};

            if (load == NULL && mechanism->place[i] < 0)
                continue;
            mechanism_place(mechanism, row, load != NULL ? load->node : i, at);
            p = mechanism_point(mechanism, at, NULL);
            if (load != NULL)
                d = mechanism_load(mechanism, row, load, moment);
            if (isfinite(d.x) && isfinite(d.y))
                p = (Point){p.x + d.x, p.y + d.y};
            reach = load == NULL ? mechanism->scale * reach_of(mechanism, i) : 0;
            low = (Point){fmin(low.x, p.x - reach), fmin(low.y, p.y - reach)};
            high = (Point){fmax(high.x, p.x + reach), fmax(high.y, p.y + reach)};
        }
    }
    mechanism->width = fmax(fmax(high.x - low.x + 2 * MARGIN, LEAST_SIDE),
                            title != NULL ? LETTER * text_width(title) + HEAD : 0);
    mechanism->height = fmax(high.y - low.y + 2 * MARGIN, LEAST_SIDE / 2);
    mechanism->left = (mechanism->width - low.x - high.x) / 2;
    mechanism->top = (mechanism->height - low.y - high.y) / 2;
    mechanism->height += FOOTER;
}

static const char *spot_name(const Mechanism *mechanism, int spot)
{
    return spot < mechanism->nodes
               ? graph_node(model_graph(mechanism->view->model), spot)->name
               : mechanism->bents.at[(spot - mechanism->nodes) / BENT_SPOTS].part->name;
}

Status mechanism_fit(Mechanism *mechanism, const double *values, int rows, Diag *diag)
{
    double low[2] = {0, 0}, high[2] = {0, 0}, force = 0, moment = 0;

    for (int r = 0; r < rows; r++) {
        const double *row = values + (size_t)r * (size_t)mechanism->items.count;

        for (int n = 0; n < mechanism->spots; n++) {
            double at[3];

            if (mechanism->place[n] < 0)
                continue;
            mechanism_place(mechanism, row, n, at);

            const Point p = mechanism_direction(mechanism, at);

            if (!isfinite(p.x) || !isfinite(p.y))
                return diag_set(diag, E_VALUE, "the place of %s is undefined",
                                spot_name(mechanism, n));
            const double reach = reach_of(mechanism, n);

            low[0] = fmin(low[0], p.x - reach);
            high[0] = fmax(high[0], p.x + reach);
            low[1] = fmin(low[1], p.y - reach);
            high[1] = fmax(high[1], p.y + reach);
        }
        widen(mechanism, row, &force, &moment);
    }

    const double wide = high[0] - low[0], tall = high[1] - low[1];
    const double by_width = wide > 0 ? (SHEET_WIDTH - 2 * MARGIN) / wide : INFINITY;
    const double by_height = tall > 0 ? (SHEET_HEIGHT - 2 * MARGIN) / tall : INFINITY;

    mechanism->scale = fmin(by_width, by_height);
    if (!isfinite(mechanism->scale))
        mechanism->scale = LEAST_SIDE / 2; /* all in one place: a metre is as good as any */
    mechanism->newton = force > 0 ? LONGEST / force : 0;
    mechanism->moment = moment > 0 ? 1 / moment : 0;
    lay_out_sheet(mechanism, values, rows);
    mechanism_settle_names(mechanism, values, rows);
    return OK;
}

void mechanism_draw(const Mechanism *mechanism, const double *values, double t, Picture *out)
{
    Sheet sheet = {.mechanism = mechanism, .values = values, .picture = out};

    mechanism_draw_parts(mechanism, values, t, out);
    sheet_names(&sheet);
}
