/* result_reader.c: the reader of a result, and any variable at its rows */
#include "simulate/run/result_reader_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* --- construction and destruction --- */

ResultReader *result_reader_of_run(const Result *result, Phases *phases)
{
    ResultReader *reader = NEW(ResultReader);

    reader->result = result;
    reader->phases = phases;
    return reader;
}

static void free_later(void *object)
{
    result_reader_free(object);
}

void result_reader_free(ResultReader *reader)
{
    if (reader == NULL || mem_frees_later(reader, free_later))
        return;
    phases_free(reader->phases);
    grid_free(&reader->asked);
    MEM_FREE(reader->asked_driven.values, reader);
}

const Result *result_reader_result(const ResultReader *reader)
{
    return reader->result;
}

Phase *result_reader_first(const ResultReader *reader)
{
    return reader->phases->at[reader->result->first];
}

bool result_reader_side(const ResultReader *reader, int which)
{
    const Phase *first = result_reader_first(reader);

    return first->closed != NULL && first->closed[which];
}

/* --- values --- */

typedef struct Items {
    const Expr *at;
    int count;
} Items;

static Status ask_items(Phases *phases, const Phase *phase, const void *context, Probe **out,
                        Diag *diag)
{
    const Items *items = context;

    return phases_probe(phases, phase, items->at, items->count, out, diag);
}

Status result_reader_values(ResultReader *reader, const Expr *items, int count, double *out,
                            Diag *diag)
{
    const Result *r = reader->result;
    const Items asked = {items, count};

    return phases_ask(reader->phases, &r->grid, &r->driven, r->first, ask_items, &asked, count, out,
                      diag);
}

Status result_reader_values_at(ResultReader *reader, const Expr *items, int count, double at,
                               double *out, Diag *diag)
{
    Phase *phase = NULL;
    const double *y = NULL, *driven = NULL;
    Probe *probe = NULL;
    Status status = OK;

    CHECK(result_reader_at(reader, at, &phase, &y, &driven, diag));
    CHECK(phases_probe(reader->phases, phase, items, count, &probe, diag));
    phase_probe_at(phase, probe, at, y, driven, count, out);
done:
    probe_free(probe);
    return status;
}

Status result_reader_values_along(ResultReader *reader, Expr item, const double *times, int count,
                                  const CallMonitor *watch, double *values, Diag *diag)
{
    const Phase *of = NULL; /* phase of the probe */
    Probe *probe = NULL;
    Status status = OK;

    for (int i = 0; i < count; i++) {
        Phase *phase = NULL;
        const double *y = NULL, *driven = NULL;

        CHECK(monitor_poll(watch));
        CHECK(result_reader_at(reader, times[i], &phase, &y, &driven, diag));
        if (phase != of) {
            probe_free(probe);
            probe = NULL;
            CHECK(phases_probe(reader->phases, phase, &item, 1, &probe, diag));
            of = phase;
        }
        phase_probe_at(phase, probe, times[i], y, driven, 1, &values[i]);
    }
done:
    probe_free(probe);
    return status;
}

/* --- rounding error --- */

enum { SHAKES = 3 };

/* plus or minus `by`, in a pattern that differs for each state and shake */
static double shaken(double value, double by, int state, int shake)
{
    const uint32_t mixed = ((uint32_t)state + 1) * 2654435761U ^ (uint32_t)shake * 0x85EBCA6BU;

    return (mixed >> 15 & 1) != 0 ? value + by : value - by;
}

/* The rounding error of each state: that of the largest coordinate or speed of its kind in the run,
 * or of this network state. */
static void state_roundings(const Result *r, double *out)
{
    const System *system = r->system;
    const int n = system_n(system), nu = system_nu(system), all = n + nu + system_nx(system);
    double largest[4] = {0};

    for (int i = 0; i < all; i++)
        out[i] = 0;
    for (int row = 0; row < r->grid.count; row++)
        for (int i = 0; i < all; i++)
            out[i] = fmax(out[i], fabs(grid_row(&r->grid, row)[i]));
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < n + nu; i++) {
            const bool is_angle =
                i < n ? system_q(system, i)->is_angle : system_u(system, i - n)->is_angle;
            double *of_kind = &largest[2 * (i < n) + is_angle];

            *of_kind = fmax(*of_kind, out[i]);
            out[i] = *of_kind;
        }
    for (int i = 0; i < all; i++)
        out[i] *= DBL_EPSILON;
}

Status result_reader_rounding(ResultReader *reader, Expr item, const double *times, int count,
                              double *open, Diag *diag)
{
    const System *system = reader->result->system;
    const int all = system_n(system) + system_nu(system) + system_nx(system);
    double *by = NEW_ARRAY(double, all);
    double *moved = NULL;
    Status status = OK;

    state_roundings(reader->result, by);
    for (int i = 0; i < count; i++) {
        Phase *phase = NULL;
        const double *y = NULL, *driven = NULL;
        Probe *probe = NULL;
        double value, other;

        open[i] = 0;
        CHECK(result_reader_at(reader, times[i], &phase, &y, &driven, diag));
        if (phase->motion == NULL || phase->length < all)
            continue;
        CHECK(phases_probe(reader->phases, phase, &item, 1, &probe, diag));
        mem_free(moved);
        moved = NEW_ARRAY(double, phase->length);
        memcpy(moved, y, (size_t)phase->length * sizeof *moved);
        phase_probe_at(phase, probe, times[i], moved, driven, 1, &value);
        for (int k = 0; k < SHAKES; k++) {
            for (int j = 0; j < all; j++)
                moved[j] = shaken(y[j], by[j], j, k);
            phase_probe_at(phase, probe, shaken(times[i], DBL_EPSILON * times[i], all, k), moved,
                           driven, 1, &other);
            open[i] = fmax(open[i], fabs(other - value));
        }
        probe_free(probe);
    }
done:
    MEM_FREE(by, moved);
    return status;
}
