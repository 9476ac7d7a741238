/* session_shape.c: modes as shapes: how what is drawn moves in one of them
 *
 * Places of frames and of points of beams are outputs of the linear equations, by whose rows a
 * mode's coordinates move them. The largest way of a point is a part of the whole's size; what
 * turns, turns little enough to look straight. */
#include "session/session_shape.h"

#include "simulate/analyse/linearize.h"

#include <math.h>
#include <string.h>

static const double LARGEST_WAY = 0.15; /* of the whole */
static const double LARGEST_TURN = 0.3; /* rad */

void shape_free(ModeShape *shape)
{
    MEM_FREE(shape->cosine, shape->sine);
}

/* the items that are places; 0 marks the others, of loads, which are unchanged */
static Expr *place_items(ct_session *session, const Mechanism *mechanism)
{
    Expr *out = NEW_ARRAY(Expr, mechanism->items.count);

    for (int i = 0; i < mechanism->items.count; i++)
        out[i] = expr_int(model_arena(session->model), 0);
    for (int spot = 0; spot < mechanism->spots; spot++)
        for (int i = 0; mechanism->place[spot] >= 0 && i < mechanism_spot_items(mechanism, spot);
             i++)
            out[mechanism->place[spot] + i] = session_add_outputs(
                session->model, mechanism->items.at[mechanism->place[spot] + i]);
    return out;
}

/* the amplitude of the state of that name, as cosine and sine; 0: not part of the mode */
static void state_in_mode(const Modes *modes, const Mode *mode, const char *name, double out[2])
{
    out[0] = out[1] = 0;
    for (int i = 0; i < modes->parts; i++)
        if (strcmp(modes->part_names[i], name) == 0) {
            out[0] = mode->amplitude[i] * cos(mode->phase[i]);
            out[1] = -mode->amplitude[i] * sin(mode->phase[i]);
        }
}

static void follow_mode(const Linear *linear, const Modes *modes, const Mode *mode,
                        ModeShape *shape)
{
    for (int s = 0; s < linear->places; s++) {
        double own[2];

        state_in_mode(modes, mode, linear->state_names[s], own);
        for (int i = 0; i < linear->outputs; i++) {
            shape->cosine[i] += linear->c[i * linear->states + s] * own[0];
            shape->sine[i] += linear->c[i * linear->states + s] * own[1];
        }
    }
}

/* the largest way of a point and the largest turn, and how large the whole is */
static void measure(const Mechanism *mechanism, const double *values, const ModeShape *shape,
                    double *way, double *turn, double *size)
{
    double low[3] = {0}, high[3] = {0};

    *way = *turn = 0;
    for (int spot = 0; spot < mechanism->spots; spot++) {
        const int first = mechanism->place[spot];
        double square[2] = {0};

        if (first < 0)
            continue;
        for (int i = 0; i < mechanism_spot_items(mechanism, spot); i++) {
            square[i >= 3] += shape->cosine[first + i] * shape->cosine[first + i] +
                              shape->sine[first + i] * shape->sine[first + i];
            if (i < 3) {
                low[i] = fmin(low[i], values[first + i]);
                high[i] = fmax(high[i], values[first + i]);
            }
        }
        *way = fmax(*way, sqrt(square[0]));
        *turn = fmax(*turn, 2 * sqrt(square[1]));
    }
    *size = hypot(hypot(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

static Status scale_shape(const Mechanism *mechanism, const double *values, int number,
                          ModeShape *shape, Diag *diag)
{
    double way, turn, size, scale;

    measure(mechanism, values, shape, &way, &turn, &size);
    scale = fmin(way > 1e-12 * size ? LARGEST_WAY * size / way : INFINITY,
                 turn > 1e-12 ? LARGEST_TURN / turn : INFINITY);
    if (!isfinite(scale))
        return diag_set(diag, E_VALUE, "mode %d moves nothing that is drawn", number);
    for (int i = 0; i < mechanism->items.count; i++) {
        shape->cosine[i] *= scale;
        shape->sine[i] *= scale;
    }
    return OK;
}

static Status linearize_places(ct_session *session, Run *run, double at, const Mechanism *mechanism,
                               Linear **out, Diag *diag)
{
    const int count = mechanism->items.count;
    Expr *items = place_items(session, mechanism);
    const char **names = NEW_ARRAY(const char *, count);
    LinearOrder order = {.about = run->reader,
                         .at = at,
                         .scene = model_scene_source(session->model),
                         .outputs = items,
                         .output_names = names,
                         .output_count = count,
                         .watch = &session->watch};
    Status status;

    for (int i = 0; i < count; i++)
        names[i] = "a place";
    (void)model_form(session->model, &order.independent, &order.independent_count);
    status = linearize(&order, out, diag);
    MEM_FREE(items, names);
    return status;
}

Status shape_find(ct_session *session, Run *run, double at, const Mechanism *mechanism, int number,
                  ModeShape *out, Diag *diag)
{
    const int count = mechanism->items.count;
    double *values = NEW_ARRAY(double, count);
    const Mode *mode;
    Linear *linear = NULL;
    Modes *modes = NULL;
    Status status;

    CHECK(linearize_places(session, run, at, mechanism, &linear, diag));
    CHECK(modes_find(linear, &modes, diag));
    if (number < 1 || number > modes->count)
        CHECK(diag_set(diag, E_VALUE, "there %s %d mode%s, counted from 1",
                       modes->count == 1 ? "is" : "are", modes->count,
                       modes->count == 1 ? "" : "s"));
    mode = &modes->at[number - 1];
    out->cosine = NEW_ARRAY(double, count);
    out->sine = NEW_ARRAY(double, count);
    follow_mode(linear, modes, mode, out);
    CHECK(result_reader_prepare(run->reader, &at, 1, &session->watch, diag));
    CHECK(result_reader_values_at(run->reader, mechanism->items.at, count, at, values, diag));
    CHECK(scale_shape(mechanism, values, number, out, diag));
    out->period = mode->imaginary > 0 ? 2 * M_PI / mode->imaginary : 1;
    if (mode->imaginary > 0)
        (void)snprintf(out->caption, sizeof out->caption, "mode %d, %.5g rad/s", number,
                       mode->omega);
    else
        (void)snprintf(out->caption, sizeof out->caption, "mode %d, %.5g 1/s", number, mode->real);
done:
    linear_free(linear);
    modes_free(modes);
    mem_free(values);
    return status;
}

void shape_move(const ModeShape *shape, int count, double phase, double *values)
{
    for (int i = 0; i < count; i++)
        values[i] += shape->cosine[i] * cos(phase) + shape->sine[i] * sin(phase);
}
