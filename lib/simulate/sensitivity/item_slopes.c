/* item_slopes.c: d/dp h(t, y, e, p) = h_y S + h_e de/dp + h_p, with e = (u', lambda, x', z) */
#include "simulate/sensitivity/item_slopes.h"

#include "base/memory.h"

#include <math.h>

struct ItemSlopes {
    Phase *phase;
    const SensitivityParameters *by;
    Probe *probe;
    Tangents *tangents;
    int *places; /* symbol_count: inputs of the symbols; -1: not read */
    int count;
};

Status item_slopes_new(Phase *phase, Parameters *parameters, const SensitivityParameters *by,
                       const Expr *roots, int count, ItemSlopes **out, Diag *diag)
{
    ItemSlopes *s = NEW(ItemSlopes);
    Status status = OK;

    s->phase = phase;
    s->by = by;
    s->count = count;
    s->places = NEW_ARRAY(int, by->symbol_count);
    CHECK(probe_new(phase->layout, parameters, roots, count, &s->probe, diag));
    s->tangents = tangents_new(residual_program(probe_residual(s->probe)));
    for (int i = 0; i < by->symbol_count; i++)
        s->places[i] = probe_place(s->probe, by->symbols[i]);
    *out = s;
    s = NULL;
done:
    item_slopes_free(s);
    return status;
}

void item_slopes_free(ItemSlopes *s)
{
    if (s == NULL)
        return;
    tangents_free(s->tangents);
    probe_free(s->probe);
    MEM_FREE(s->places, s);
}

static void move(const ItemSlopes *s, int lane, int input, double by)
{
    if (by != 0)
        tangents_move(s->tangents, lane, input, by, 0);
}

/* (q, u, x, references) along a column */
static void move_state(const ItemSlopes *s, int lane, const double *column, double size)
{
    const VariableIndex *l = s->phase->layout;
    const int first[] = {l->q, l->u, l->x, l->references};
    const int length[] = {l->n, l->nu, l->nx, l->multi_turns};

    for (int part = 0; part < COUNT(first); part++)
        for (int i = 0; i < length[part]; i++)
            move(s, lane, first[part] + i, *column++ / size);
}

static void move_solved(const ItemSlopes *s, int lane, const double *solved, int parameter)
{
    const VariableIndex *l = s->phase->layout;
    const int first[] = {l->acceleration, l->multipliers, l->rates, l->z};
    const int length[] = {l->nu, l->m, l->nx, l->nz};

    for (int part = 0; part < COUNT(first); part++)
        for (int i = 0; i < length[part]; i++, solved += s->by->count)
            move(s, lane, first[part] + i, solved[parameter] / s->by->sizes[parameter]);
    for (int k = 0; k < l->slides; k++, solved += s->by->count)
        move(s, lane, l->signs + l->slid[k], solved[parameter] / s->by->sizes[parameter]);
}

static void move_parameters(const ItemSlopes *s, int lane, int parameter)
{
    for (int i = 0; i < s->by->symbol_count; i++)
        if (s->places[i] >= 0)
            move(s, lane, s->places[i], s->by->weights[i * s->by->count + parameter]);
}

void item_slopes_at(ItemSlopes *s, Variational *variational, double t, const double *unknowns,
                    double *out)
{
    const VariableIndex *l = s->phase->layout;
    const int n = variational_states(variational), count = s->by->count;
    const double *solved = NULL;
    RowValues row = row_of_state(l, t, unknowns);
    bool sound = true;

    if (!probe_reads_state(s->probe)) {
        solved = variational_solved(variational, t, unknowns);
        sound = solved != NULL && row_solve(l, s->phase->motion, t, unknowns, &row);
    }
    if (sound)
        probe_tangents(s->probe, &row, NULL, s->tangents);
    for (int first = 0; first < count; first += TANGENT_BATCH) {
        const int lanes = count - first < TANGENT_BATCH ? count - first : TANGENT_BATCH;

        tangents_clear(s->tangents);
        for (int lane = 0; lane < lanes && sound; lane++) {
            move_state(s, lane, unknowns + (ptrdiff_t)(first + lane + 1) * n,
                       s->by->sizes[first + lane]);
            if (solved != NULL)
                move_solved(s, lane, solved, first + lane);
            move_parameters(s, lane, first + lane);
        }
        if (sound)
            tangents_run(s->tangents);
        for (int lane = 0; lane < lanes; lane++)
            for (int i = 0; i < s->count; i++)
                out[i * count + first + lane] =
                    sound ? tangents_root(s->tangents, i, lane, NULL) : NAN;
    }
}
