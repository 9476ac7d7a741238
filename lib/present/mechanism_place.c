/* mechanism_place.c: where frames are, in ground and on the sheet */
#include "present/mechanism_impl.h"

#include <math.h>
#include <string.h>

void mechanism_place(const Mechanism *mechanism, const double *values, int spot, double out[3])
{
    const int place = mechanism->place[spot];

    for (int i = 0; i < 3; i++)
        out[i] = place >= 0 ? values[place + i] : 0;
}

/* v + 2 e x (e0 v + e x v), with e0, e the Euler parameters */
void mechanism_turn(const Mechanism *mechanism, const double *values, int node, const double in[3],
                    double out[3])
{
    const int place = mechanism->place[node];
    const double *p = values + place + 3;
    double c[3];

    if (place < 0) {
        memcpy(out, in, 3 * sizeof *out);
        return;
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        c[i] = p[0] * in[i] + p[1 + j] * in[k] - p[1 + k] * in[j];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        out[i] = in[i] + 2 * (p[1 + j] * c[k] - p[1 + k] * c[j]);
    }
}

static double along(const double axis[3], const double v[3])
{
    return axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
}

Point mechanism_direction(const Mechanism *mechanism, const double direction[3])
{
    return (Point){along(mechanism->axes[0], direction), -along(mechanism->axes[1], direction)};
}

Point mechanism_point(const Mechanism *mechanism, const double at[3], double *depth)
{
    const Point p = mechanism_direction(mechanism, at);

    if (depth != NULL)
        *depth = along(mechanism->axes[2], at) * mechanism->scale;
    return (Point){mechanism->left + p.x * mechanism->scale,
                   mechanism->top + p.y * mechanism->scale};
}

Point sheet_node(const Sheet *sheet, int spot, double *depth)
{
    double at[3];

    mechanism_place(sheet->mechanism, sheet->values, spot, at);
    return mechanism_point(sheet->mechanism, at, depth);
}

Point mechanism_load(const Mechanism *mechanism, const double *values, const Load *load,
                     double moment[3])
{
    double force[3];
    Point d;

    memcpy(force, values + load->first, sizeof force);
    memcpy(moment, values + load->first + 3, sizeof force);
    if (load->in_body) {
        mechanism_turn(mechanism, values, load->node, values + load->first, force);
        mechanism_turn(mechanism, values, load->node, values + load->first + 3, moment);
    }
    d = mechanism_direction(mechanism, force);
    return (Point){d.x * mechanism->newton, d.y * mechanism->newton};
}

double sheet_depth(const Sheet *sheet, int node)
{
    const Mechanism *mechanism = sheet->mechanism;
    const int body = mechanism->body[node];
    double sum = 0, depth;
    int count = 0;

    if (body == mechanism->ground)
        return -INFINITY;
    for (int n = 0; n < mechanism->nodes; n++)
        if (mechanism->body[n] == body) {
            (void)sheet_node(sheet, n, &depth);
            sum += depth;
            count++;
        }
    return sum / count;
}

int mechanism_color(const Mechanism *mechanism, int node)
{
    const Model *model = mechanism->view->model;
    int color = 0;

    for (int i = 0; i < model_count(model); i++) {
        const Instance *instance = model_instance(model, i);

        if (instance->row->family != FAMILY_BODY)
            continue;
        if (instance->head == mechanism->body[node])
            break;
        color++;
    }
    return color;
}
