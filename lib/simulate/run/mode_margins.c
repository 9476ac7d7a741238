/* mode_margins.c: whether ideal switches may be in their mode at an instant
 *
 * An instant is located only so well, and where a mode goes over into another a margin may still be
 * below 0 by that: it rises before anything has moved. One that takes states beyond their tolerance
 * to rise is that of a wrong mode: a diode that is closed too early carries a current backwards,
 * which charges what it has no business to. */
#include "simulate/run/mode_margins.h"

#include "algebra/linear.h"

#define NOTHING 1e-4 /* of the absolute tolerance: where all is next to nothing, as at rest */
#define SHORT   1e-3 /* of a step: a way that slopes are told by */

double mode_margins_noise(double largest, const Control *control)
{
    return fmax(MARGIN_ROUNDING * largest, NOTHING * control->atol);
}

double mode_margins_moves(double time, const double *y, const double *rate, int count,
                          const Control *control)
{
    double largest = 0;

    for (int i = 0; i < count; i++)
        largest =
            fmax(largest, time * fabs(rate[i]) / (control->rtol * fabs(y[i]) + control->atol));
    return largest;
}

/* the longest time that a negative margin takes to rise, from what margins are here and `way` on */
static double time_to_rise(const double *here, const double *ahead, int count, double way,
                           double noise)
{
    double longest = 0;

    for (int i = 0; i < count; i++)
        if (here[i] < -noise)
            longest =
                fmax(longest, ahead[i] > here[i] ? way * here[i] / (here[i] - ahead[i]) : INFINITY);
    return longest;
}

double mode_margins_off(Phase *phase, double t, double behind, double step, const double *y,
                        const Control *control)
{
    const Equations *eq = compiled_equations(phase->numbers);
    const Ode *ode = motion_ode(phase->motion);
    const int count = eq->margin_count, first = eq->switch_count - count;
    const double way = SHORT * step;
    double *room, *here, *ahead, *rate, *moved, noise, off = 0;

    if (count == 0)
        return 0;
    room = NEW_ARRAY(double, 2 * eq->switch_count + 2 * phase->length);
    here = room;
    ahead = here + eq->switch_count;
    rate = ahead + eq->switch_count;
    moved = rate + phase->length;
    phase_enter(phase);
    motion_window(phase->motion, behind, INFINITY);
    motion_switches(phase->motion, behind, y, here);
    noise = mode_margins_noise(vector_largest(here + first, count), control);
    if (time_to_rise(here + first, here + first, count, 0, noise) > 0 &&
        ode->rate(ode->context, t, y, rate)) {
        for (int i = 0; i < phase->length; i++)
            moved[i] = y[i] + way * rate[i];
        motion_switches(phase->motion, behind + way, moved, ahead);
        off = mode_margins_moves(time_to_rise(here + first, ahead + first, count, way, noise), y,
                                 rate, phase->length - 1, control);
    }
    motion_window(phase->motion, -INFINITY, INFINITY);
    mem_free(room);
    return off;
}
