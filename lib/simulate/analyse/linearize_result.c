/* linearize_result.c: the linear equations that are returned, with their names */
#include "simulate/analyse/linearize_impl.h"

#include "base/memory.h"

#include <string.h>

/* "h8"; for an angular velocity m1.Wx "m1.turnX", a small rotation about that axis */
static char *part_name(const Work *w, int speed)
{
    int i = speed_coordinate(w->system, speed);
    const char *name = system_u(w->system, speed)->name;
    const char *axis = strrchr(name, '.');
    Text text = {0};

    if (i >= 0)
        text_add(&text, system_q(w->system, i)->name);
    else if (axis != NULL)
        text_addf(&text, "%.*s.turn%c", (int)(axis - name), name,
                  axis[1] != '\0' ? axis[strlen(axis) - 1] - 'a' + 'A' : ' ');
    else
        text_addf(&text, "turn %s", name);
    return text_done(&text);
}

static char *copy(const char *text)
{
    return mem_text(text, strlen(text));
}

Linear *linear_new(const Work *w)
{
    const LinearOrder *order = w->order;
    const VariableIndex *l = w->l;
    Linear *out = NEW(Linear);
    const int places = w->places->free, f = w->speeds.free;

    out->at = order->at;
    out->places = places;
    out->freedoms = f;
    out->states = places + f + l->nx;
    out->inputs = order->input_count;
    out->outputs = order->output_count;
    out->parts = l->nu + l->nx;
    out->a = NEW_ARRAY(double, out->states * out->states);
    out->b = NEW_ARRAY(double, out->states * out->inputs);
    out->c = NEW_ARRAY(double, out->outputs * out->states);
    out->d = NEW_ARRAY(double, out->outputs * out->inputs);
    out->a_error = NEW_ARRAY(double, out->states * out->states);
    out->b_error = NEW_ARRAY(double, out->states * out->inputs);
    out->c_error = NEW_ARRAY(double, out->outputs * out->states);
    out->d_error = NEW_ARRAY(double, out->outputs * out->inputs);
    out->motion = NEW_ARRAY(double, out->parts * out->states);
    out->state_names = NEW_ARRAY(char *, out->states);
    out->input_names = NEW_ARRAY(char *, out->inputs);
    out->output_names = NEW_ARRAY(char *, out->outputs);
    out->part_names = NEW_ARRAY(char *, out->parts);
    for (int j = 0; j < l->nu; j++)
        out->part_names[j] = part_name(w, j);
    for (int i = 0; i < places; i++)
        out->state_names[i] =
            copy(out->part_names[partitioning_independent(w->places->partitioning)[i]]);
    for (int i = 0; i < f; i++)
        out->state_names[places + i] =
            copy(system_u(w->system, partitioning_independent(w->speeds.partitioning)[i])->name);
    for (int i = 0; i < l->nx; i++) {
        out->state_names[places + f + i] = copy(system_x(w->system, i)->name);
        out->part_names[l->nu + i] = copy(system_x(w->system, i)->name);
    }
    for (int i = 0; i < out->inputs; i++)
        out->input_names[i] = copy(order->inputs[i].name);
    for (int i = 0; i < out->outputs; i++)
        out->output_names[i] = copy(order->output_names[i]);
    return out;
}

static void free_names(char **names, int count)
{
    for (int i = 0; i < count; i++)
        mem_free(names[i]);
    mem_free(names);
}

void linear_free(Linear *linear)
{
    if (linear == NULL)
        return;
    MEM_FREE(linear->a, linear->b, linear->c, linear->d, linear->a_error, linear->b_error,
             linear->c_error, linear->d_error, linear->motion, linear->mass, linear->mass_error,
             linear->force, linear->force_error, linear->on_jump);
    free_names(linear->state_names, linear->states);
    free_names(linear->input_names, linear->inputs);
    free_names(linear->output_names, linear->outputs);
    free_names(linear->part_names, linear->parts);
    mem_free(linear);
}
