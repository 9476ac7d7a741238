/* result_reader.c: the reader of a result, and any variable at its rows */
#include "simulate/run/result_reader_impl.h"

/* --- made and freed --- */

ResultReader *result_reader_of_run(const Result *result, Phases *phases)
{
    ResultReader *reader = NEW(ResultReader);

    reader->result = result;
    reader->phases = phases;
    return reader;
}

/* one of the phases that has these equations already; NULL */
static Phase *find_like(const Phases *phases, const PhaseKey *key)
{
    for (int i = 1; i < phases->count; i++) {
        Phase *phase = phases->at[i];
        bool is_same = phase->system == key->system && phase->on_count == key->on_count;

        for (int k = 0; k < key->on_count && is_same; k++)
            is_same =
                phase->on[k].surface == key->on[k].surface && phase->on[k].side == key->on[k].side;
        if (is_same)
            return phase;
    }
    return NULL;
}

static Status add_phase(Phases *phases, const PhaseKey *key, const Manner *manner, Diag *diag)
{
    const int switches = system_ideal_count(phases->system);
    Phase *phase = find_like(phases, key);

    if (phase != NULL) {
        phases_add(phases, phase_new_like(phase, key->closed, switches));
        return OK;
    }
    TRY(phase_new_on(key->system, &phases->parameters, key->closed, switches, key->on,
                     key->on_count, &phase, diag));
    phases_add(phases, phase);
    if (key->is_open)
        TRY(phases_open(phases, phase, manner, diag));
    return OK;
}

Status result_reader_new(const Result *result, ResultReader **out, Diag *diag)
{
    Phases *phases = NEW(Phases);
    const Parameters *known = &result->parameters;
    Status status = OK;

    phases->system = result->system;
    phases->tolerance = result->tolerance;
    phases->parameters = (Parameters){
        .value = known->value, .context = known->context, .evaluator = known->evaluator};
    for (int i = 0; i < known->count; i++)
        parameters_set(&phases->parameters, known->symbols[i], known->values[i]);
    for (int i = 0; i < result->phases.count; i++)
        CHECK(add_phase(phases, &result->phases.at[i], &result->manner, diag));
    if (result->phases.at[0].is_open && result->start.network != NULL)
        motion_guess(phases_whole(phases)->motion, result->start.network);
    *out = result_reader_of_run(result, phases);
    phases = NULL;
done:
    phases_free(phases);
    return status;
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
                                  const Watch *watch, double *values, Diag *diag)
{
    const Phase *of = NULL; /* that the probe is of */
    Probe *probe = NULL;
    Status status = OK;

    for (int i = 0; i < count; i++) {
        Phase *phase = NULL;
        const double *y = NULL, *driven = NULL;

        CHECK(poll(watch));
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

/* --- one question --- */

Status result_values(const Result *result, const Expr *items, int count, double *out, Diag *diag)
{
    ResultReader *reader = NULL;
    Status status = OK;

    CHECK(result_reader_new(result, &reader, diag));
    CHECK(result_reader_values(reader, items, count, out, diag));
done:
    result_reader_free(reader);
    return status;
}

Status result_values_at(const Result *result, const Expr *items, int count, double at, double *out,
                        Diag *diag)
{
    ResultReader *reader = NULL;
    Status status = OK;

    CHECK(result_reader_new(result, &reader, diag));
    CHECK(result_reader_values_at(reader, items, count, at, out, diag));
done:
    result_reader_free(reader);
    return status;
}
