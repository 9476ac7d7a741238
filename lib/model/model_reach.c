/* model_reach.c: which names of an instance of a subsystem are accessible from outside */
#include "model/model_impl.h"

#include <string.h>

/* whether `use` is the one being applied, or one around it: its names came by a port */
static bool is_around(const State *state, int use)
{
    int at = state->inside;

    while (at >= 0 && at != use)
        at = state->uses.at[at].outer;
    return at == use;
}

static bool is_port_of(const Use *use, const char *name)
{
    const int port = subsystem_port(use->subsystem, name + strlen(use->name) + 1);

    return port >= 0 && use->bound[port] == NULL;
}

Status use_check_reach(const State *state, const char *name, Place place, Diag *diag)
{
    const int around = state_use_around(state, name);
    const Use *use = around >= 0 ? &state->uses.at[around] : NULL;
    Text ports = {0};

    if (use == NULL || state->is_open || is_around(state, around) ||
        (is_port_of(use, name) && (use->outer < 0 || is_around(state, use->outer))))
        return OK;
    for (int i = 0; i < use->subsystem->port_count; i++)
        if (use->subsystem->ports[i].is_through)
            text_addf(&ports, " %s.%s", use->name, use->subsystem->ports[i].name);
    (void)diag_at(diag, E_NAME, place, "%s is inside %s: what attaches, attaches at ports", name,
                  use->name);
    if (ports.at != NULL)
        diag_hint(diag, "its ports are%s", ports.at);
    else
        diag_hint(diag, "a port is a frame that the inside makes and frames= names, or a terminal "
                        "in through=");
    text_free(&ports);
    return E_NAME;
}

Status use_check_bound(const State *state, const char *name, Place place, Diag *diag)
{
    const int around = state_use_around(state, name);
    const Use *use = around >= 0 ? &state->uses.at[around] : NULL;
    const int port =
        use != NULL ? subsystem_port(use->subsystem, name + strlen(use->name) + 1) : -1;

    if (port < 0 || use->bound[port] == NULL || state->inside >= 0)
        return OK;
    (void)diag_at(diag, E_NAME, place, "%s is given from outside: it is %s", name,
                  use->bound[port]);
    if (use->subsystem->ports[port].is_frame)
        diag_hint(diag, "write %s", use->bound[port]);
    else
        diag_hint(diag,
                  "write %s; with through=[%s] in its first line %s would have one of its own",
                  use->bound[port], use->subsystem->ports[port].name, use->subsystem->name);
    return E_NAME;
}
