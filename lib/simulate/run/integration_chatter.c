/* integration_chatter.c: a motion that goes to and fro through a surface ever faster
 *
 * A relay that acts on a position, with damping beside it, is switched in swings that fade, each
 * shorter than the one before: they never end, and each costs steps. Once they are short against
 * the run, and many have passed, the motion is taken to rest where they lead, which is told with
 * how fast it still was. */
#include "simulate/run/integration_impl.h"

#include <math.h>

#define MANY   2000 /* times: what a run may spend on it */
#define FADED  0.01 /* of the first swing, and such a one is no lasting oscillation */
#define LONGER 1.5  /* than the first one: another chatter begins */
#define FORGET 0.9  /* of the longest one lately, from one to the next */

void integration_note_chatter(Integration *m, int i, double t)
{
    const Guard guard = equations_guard(m->eq, i);
    Chatter *chatter;
    double taken;

    if (guard.surface < 0 || guard.end != 0 || guard.is_unilateral || guard.is_norm)
        return;
    chatter = &m->chatters[guard.surface];
    taken = t - chatter->last;
    if (chatter->count++ == 0 || taken > LONGER * chatter->first)
        *chatter = (Chatter){.count = 1, .first = taken};
    chatter->last = t;
    chatter->recent = fmax(taken, FORGET * chatter->recent);
    chatter->settles = chatter->count > MANY && chatter->recent <= FADED * chatter->first;
}

void integration_report_settling(Integration *m, int i)
{
    const Guard guard = equations_guard(m->eq, i);
    Text what = {0};
    double value, rate;

    if (guard.surface < 0 || guard.end != 0 || !m->chatters[guard.surface].settles)
        return;
    rate = integration_condition_rate(m, i, &value);
    if (m->plan->tell != NULL)
        m->plan->tell(m->plan->context, &m->segment, i, &what);
    remarks_add(&m->out->remarks,
                (Remark){.kind = REMARK_SETTLES,
                         .what = what.at != NULL ? what.at : "a condition in the equations",
                         .t = m->stepper->t,
                         .size = fabs(rate)});
    m->chatters[guard.surface].count = 0;
    text_free(&what);
}
