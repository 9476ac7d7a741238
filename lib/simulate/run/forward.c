/* forward.c: a forward run from phase to phase */
#include "simulate/run/forward.h"

#include "base/memory.h"
#include "simulate/run/mode_switch.h"
#include "simulate/run/sliding.h"
#include "simulate/run/termination.h"

#include <math.h>

IntegrationPlan forward_plan(const ActiveRun *r, const SimulationInput *setting,
                             const RunOptions *options, const Method *method, Events *events)
{
    return (IntegrationPlan){.segment = phases_segment(r->phase, events),
                             .method = method,
                             .control = {.rtol = options->rtol,
                                         .atol = options->atol,
                                         .step = options->step,
                                         .most = options->most},
                             .every = options->every,
                             .watch = setting->watch};
}

Status forward_probe_seen(ActiveRun *r, Phase *phase, const Host *host, Diag *diag)
{
    if (phase->like->seen != NULL)
        return OK;
    return phases_probe(r->phases, phase, host->items, host->item_count, &phase->like->seen, diag);
}

bool forward_show_row(void *context, int phase_number, double t, const double *y)
{
    const ModeSwitching *s = context;
    Phase *phase = s->run->phases->at[phase_number];
    const Host *host = s->setting->host;
    double *values = NEW_ARRAY(double, host->item_count);
    Diag ignored = {0};
    bool stop;

    for (int i = 0; i < host->item_count; i++)
        values[i] = NAN;
    if (host->item_count > 0 && forward_probe_seen(s->run, phase, host, &ignored) == OK)
        phase_probe_at(phase, phase->like->seen, t, y, NULL, host->item_count, values);
    stop = host->row(host->context, t, values);
    mem_free(values);
    return stop;
}

/* the ChooseMethod of a plan */
static Status choose_method(void *context, const Segment *segment, double t, const double *y,
                            const Method **method, Diag *diag)
{
    const ModeSwitching *s = context;

    return phase_choose_method(s->run->phases->at[segment->phase], t, y, &s->control, method, diag);
}

Status forward_integrate(ActiveRun *r, const SimulationInput *setting, const IntegrationPlan *plan,
                         Grid *grid, Grid *corners, IntegrationReport *out, Diag *diag)
{
    ModeSwitching switching = {
        .run = r, .setting = setting, .control = plan->control, .stuck = NAN};
    IntegrationPlan through = *plan;
    Status status;

    switching.control.span = plan->to - plan->from;
    through.first = choose_method;
    through.choose = slide_choose;
    through.tell = sliding_report;
    through.explain = termination_diagnose;
    through.context = &switching;
    through.corners = corners;
    if (r->mode_search != NULL) {
        through.mode_switch = mode_switch;
        through.in_time = compiled_equations(phases_whole(r->phases)->numbers);
    }
    status = integrate(&through, r->begin, grid, out, diag);
    impact_tallies_report(&switching.impacts, &out->remarks);
    impact_tallies_free(&switching.impacts);
    mode_switching_free(&switching);
    return status;
}
