/* result.c: queries about a run that need no solution */
#include "simulate/run/result_impl.h"

#include <math.h>

static void free_later(void *object)
{
    result_free(object);
}

void result_free(Result *r)
{
    if (r == NULL || mem_frees_later(r, free_later))
        return;
    for (int i = 0; i < r->phases.count; i++) {
        MEM_FREE(r->phases.at[i].closed, r->phases.at[i].on);
    }
    LIST_FREE(r->phases);
    parameters_free(&r->parameters);
    initial_free(&r->start);
    grid_free(&r->grid);
    grid_free(&r->corners);
    LIST_FREE(r->jumps);
    crossings_free(&r->crossings);
    mem_free(r->driven.values);
    LIST_FREE(r->events);
    pool_free(r->pool);
    remarks_free(&r->remarks);
    mem_free(r);
}

RunKind result_kind(const Result *r)
{
    return r->kind;
}

System *result_system(const Result *r)
{
    return r->system;
}

const RunReport *result_report(const Result *r)
{
    return &r->monitor_report;
}

int result_freedoms(const Result *r)
{
    return r->freedoms;
}

int result_full_turns(const Result *r, Expr symbol)
{
    double angle;

    return parameters_kept(&r->parameters, symbol, &angle) ? (int)lround(angle / (2 * M_PI)) : 0;
}

const Remarks *result_remarks(const Result *r)
{
    return &r->remarks;
}

int result_event_count(const Result *r)
{
    return r->events.count;
}

EventRecord result_event(const Result *r, int i)
{
    return r->events.at[i];
}

int result_rows(const Result *r)
{
    return r->grid.count;
}

const double *result_times(const Result *r)
{
    return r->grid.times;
}

const int *result_steps(const Result *r)
{
    return r->grid.steps;
}

int result_corner_count(const Result *r)
{
    return r->corners.count;
}

const double *result_corner_times(const Result *r)
{
    return r->corners.times;
}
