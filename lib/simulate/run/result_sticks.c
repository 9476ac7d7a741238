/* result_sticks.c: when parts with dry friction stick in a run, by the modes of its segments */
#include "simulate/run/result_impl.h"

enum { LIMITS = 2 }; /* surfaces of a part */

/* Whether a part is held on a surface in a phase; *held: it is at its bound there. *any: it has
 * one. */
static bool is_stuck(const PhaseKey *key, const char *part, bool *held, bool *any)
{
    int surfaces[LIMITS];
    const int count = system_surfaces_of_part(key->system, part, surfaces, LIMITS);
    bool sticks = false;

    *held = false;
    *any = count > 0;
    for (int i = 0; i < key->on_count; i++)
        for (int k = 0; k < count; k++)
            if (key->on[i].surface == surfaces[k]) {
                *held = *held || key->on[i].held;
                sticks = sticks || key->on[i].side == 0 || key->on[i].held;
            }
    return sticks;
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
        bool any;
        const double until = k < corners->count ? corners->times[k]
                             : grid->count > 0  ? grid->times[grid->count - 1]
                                                : since;

        out->sticks = is_stuck(key, part, &out->is_held, &any);
        found = found || any;
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
    int phase = result->first;
    bool any;

    for (int k = 0; k < corners->count && corners->times[k] <= t; k++)
        phase = corners->phase[k];
    *out = (StickRecord){0};
    out->sticks = is_stuck(&result->phases.at[phase], part, &out->is_held, &any);
    return any;
}
