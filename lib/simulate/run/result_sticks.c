/* result_sticks.c: when parts with dry friction stick in a run, by the modes of its segments */
#include "simulate/run/result_impl.h"

enum { LIMITS = 2 }; /* surfaces of a part */

/* the state of a part on a surface of its own in a phase */
static void read_surface(const PhaseKey *key, const OnSurface *on, StickRecord *out)
{
    SystemSurface surface = {0};

    (void)system_surface(key->system, on->surface, &surface);
    out->is_open = out->is_open || (surface.law.is_unilateral && on->side != 0 && !on->held);
    out->is_held = out->is_held || (on->held && on->most > 0);
}

/* What a part does in a phase; *any: it has a surface. Friction with a load sticks where its own
 * surface does, whether or not it is in contact. */
static void read_phase(const PhaseKey *key, const char *part, StickRecord *out, bool *any)
{
    int surfaces[LIMITS];
    const int count = system_surfaces_of_part(key->system, part, surfaces, LIMITS);
    bool sticks[2] = {false, false}, has_load = false;

    out->is_held = out->is_open = false;
    *any = count > 0;
    for (int i = 0; i < key->on_count; i++)
        for (int k = 0; k < count; k++) {
            const OnSurface *on = &key->on[i];
            SystemSurface surface = {0};

            if (on->surface != surfaces[k])
                continue;
            (void)system_surface(key->system, on->surface, &surface);
            read_surface(key, on, out);
            has_load = has_load || surface.load >= 0;
            sticks[surface.load >= 0] |= on->side == 0 || on->held;
        }
    out->sticks = sticks[has_load] && !(has_load && out->is_open);
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

        read_phase(key, part, out, &any);
        found = found || any;
        if (until > since) {
            out->stuck += out->sticks ? until - since : 0;
            out->slips += !out->sticks && !out->is_open && !slipped;
            slipped = !out->sticks && !out->is_open;
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
    read_phase(&result->phases.at[phase], part, out, &any);
    return any;
}
