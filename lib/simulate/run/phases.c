/* phases.c: phases of a run, and any variable at its rows */
#include "simulate/run/phases.h"

#include "base/memory.h"

#include <string.h>

/* --- phases --- */

void phases_free(Phases *p)
{
    if (p == NULL)
        return;
    for (int i = 0; i < p->count; i++)
        phase_free(p->at[i]);
    LIST_FREE(*p);
    LIST_FREE(p->by_sides);
    names_free(p->sides);
    parameters_free(&p->parameters);
    mem_free(p);
}

/* what names sides of switches; new */
static char *name_of(const bool *closed, int count)
{
    char *name = mem_array((size_t)count + 1, 1);

    for (int i = 0; i < count; i++)
        name[i] = closed[i] ? '1' : '0';
    return name;
}

Phase *phases_find(const Phases *p, const bool *closed, int count)
{
    char *name = name_of(closed, count);
    const int number = p->sides != NULL ? names_find(p->sides, name) : -1;

    mem_free(name);
    return number >= 0 ? p->at[p->by_sides.at[number]] : NULL;
}

void phases_add(Phases *p, Phase *phase)
{
    phase->number = p->count;
    if (phase->closed != NULL && phase->on_count == 0) {
        char *name = name_of(phase->closed, system_ideal_count(phase->system));

        if (p->sides == NULL)
            p->sides = names_new();
        if (names_add(p->sides, name) == p->by_sides.count)
            LIST_PUSH(p->by_sides, p->count);
        mem_free(name);
    }
    LIST_PUSH(*p, phase);
}

Phase *phases_whole(const Phases *p)
{
    return p->at[0];
}

/* speeds asked for as independent, by the names of their coordinates */
static Status find_independent(const VariableIndex *l, const Manner *manner, int *out, Diag *diag)
{
    for (int i = 0; i < manner->independent_count; i++) {
        out[i] = -1;
        for (int j = 0; j < l->nu; j++) {
            const Variable *u = system_u(l->system, j);
            const char *name = u->derivative_of != NULL ? expr_name(*u->derivative_of) : u->name;

            if (l->n == l->nu) /* u = q' */
                name = system_q(l->system, j)->name;
            if (strcmp(name, manner->independent[i]) == 0)
                out[i] = j;
        }
        if (out[i] < 0) {
            (void)diag_set(diag, E_NAME, "'%s' is no coordinate of these trees",
                           manner->independent[i]);
            diag_hint(diag, "'form embedded' chooses independent ones by itself; show coordinates "
                            "lists all");
            return E_NAME;
        }
    }
    return OK;
}

Status phases_open(Phases *p, Phase *phase, const Manner *manner, Diag *diag)
{
    mem_keep(p);
    int *independent = NEW_ARRAY(int, manner->independent_count);
    MotionOptions options = {.watch = manner->watch,
                             .embedded = manner->embedded,
                             .rows = manner->rows,
                             .row_count = manner->row_count,
                             .independent = independent,
                             .independent_count = manner->independent_count,
                             .tolerance = p->tolerance};
    Status status = OK;

    CHECK(find_independent(phase->layout, manner, independent, diag));
    CHECK(phase_open(phase, &p->parameters, &options, manner->host, diag));
done:
    mem_free(independent);
    return status;
}

void phases_tolerance(Phases *p, double tolerance)
{
    mem_keep(p);
    p->tolerance = tolerance;
    for (int i = 0; i < p->count; i++)
        if (p->at[i]->motion != NULL)
            motion_tolerance(p->at[i]->motion, tolerance);
}

Segment phases_segment(const Phase *phase, Events *events)
{
    phase_enter(phase);
    return (Segment){.phase = phase->number,
                     .equations = compiled_equations(phase->numbers),
                     .motion = phase->motion,
                     .events = events,
                     .samples = phase->samples,
                     .onset = phase->onset,
                     .stiff = phase_stiff_method(phase),
                     .coupled = phase_coupled_method(phase)};
}

/* --- values --- */

const double *driven_row(const Driven *driven, int row)
{
    return driven->values != NULL ? driven->values + (ptrdiff_t)row * driven->length : NULL;
}

/* what may follow from the potential of a terminal on which nothing stands */
static const unsigned may_need_open =
    1U << SYMBOL_STATE | 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_ACCELERATION |
    1U << SYMBOL_STATE_RATE | 1U << SYMBOL_MULTIPLIER | 1U << SYMBOL_EFFORT | 1U << SYMBOL_JERK;

Status phases_probe(Phases *p, const Phase *phase, const Expr *items, int count, Probe **out,
                    Diag *diag)
{
    mem_keep(p);
    Expr *roots = NEW_ARRAY(Expr, count);
    Status status = OK;

    for (int i = 0; i < count; i++) {
        CHECK(system_resolve(phase->system, items[i], &roots[i], diag));
        if ((expr_kinds(roots[i]) & may_need_open) != 0)
            CHECK(phase_refuse_open(phase, diag));
    }
    CHECK(probe_new(phase->layout, &p->parameters, roots, count, out, diag));
done:
    mem_free(roots);
    return status;
}

/* how many rows from this one on are of its phase */
static int same_phase(const Grid *grid, int row)
{
    int end = row + 1;

    while (end < grid->count && grid->phase[end] == grid->phase[row])
        end++;
    return end - row;
}

Status phases_ask(Phases *p, const Grid *grid, const Driven *driven, int first, Ask ask,
                  const void *context, int count, double *out, Diag *diag)
{
    mem_keep(p);
    Probe **probes = NEW_ARRAY(Probe *, p->count);
    Status status = OK;

    if (grid->count == 0)
        CHECK(ask(p, p->at[first], context, &probes[first], diag));
    for (int i = 0, rows; i < grid->count; i += rows) {
        Phase *phase = p->at[grid->phase[i]];
        Probe **probe = &probes[phase->like->number];

        rows = same_phase(grid, i);
        if (*probe == NULL)
            CHECK(ask(p, phase->like, context, probe, diag));
        phase_enter(phase);
        if (probe_reads_state(*probe)) {
            probe_values_of_states(*probe, p->parameters.evaluator, grid->times + i,
                                   grid_row(grid, i), grid_length(grid, i), rows, count,
                                   out + (ptrdiff_t)i * count);
            continue;
        }
        for (int k = i; k < i + rows; k++)
            phase_probe_at(phase, *probe, grid->times[k], grid_row(grid, k), driven_row(driven, k),
                           count, out + (ptrdiff_t)k * count);
    }
done:
    for (int i = 0; i < p->count; i++)
        probe_free(probes[i]);
    mem_free(probes);
    return status;
}
