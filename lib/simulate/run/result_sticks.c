/* result_sticks.c: when parts with dry friction stick in a run, by the modes of its segments */
#include "simulate/run/result_impl.h"

/* whether a surface is stuck to in a phase; *held: its part is at its bound */
static bool is_stuck(const PhaseKey *key, int surface, bool *held)
{
    *held = false;
    for (int i = 0; i < key->on_count; i++)
        if (key->on[i].surface == surface) {
            *held = key->on[i].held;
            return key->on[i].side == 0 || *held;
        }
    return false;
}

bool result_stick(const Result *result, const char *part, StickRecord *out)
{
    const Grid *corners = &result->corners, *grid = &result->grid;
    double since = grid->count > 0 ? grid->times[0] : 0;
    int phase = result->first;
    bool slipped = false, stuck = false, found = false;

    *out = (StickRecord){0};
    for (int k = 0; k <= corners->count; k++) {
        const PhaseKey *key = &result->phases.at[phase];
        const int surface = system_surface_of_part(key->system, part);
        const double until = k < corners->count ? corners->times[k]
                             : grid->count > 0  ? grid->times[grid->count - 1]
                                                : since;

        found = found || surface >= 0;
        out->sticks = is_stuck(key, surface, &out->is_held);
        if (until > since) {
            out->stuck += out->sticks ? until - since : 0;
            out->slips += !out->sticks && !slipped;
            slipped = !out->sticks;
            if (out->sticks && !stuck) {
                out->spans++;
                out->from = since;
            }
            if (out->sticks)
                out->to = until;
            stuck = out->sticks;
        }
        since = until;
        phase = k < corners->count ? corners->phase[k] : phase;
    }
    return found;
}

bool result_stick_at(const Result *result, const char *part, double t, StickRecord *out)
{
    const Grid *corners = &result->corners;
    const PhaseKey *key;
    int phase = result->first, surface;

    for (int k = 0; k < corners->count && corners->times[k] <= t; k++)
        phase = corners->phase[k];
    key = &result->phases.at[phase];
    surface = system_surface_of_part(key->system, part);
    *out = (StickRecord){0};
    out->sticks = is_stuck(key, surface, &out->is_held);
    return surface >= 0;
}
