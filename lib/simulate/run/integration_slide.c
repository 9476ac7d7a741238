/* integration_slide.c: what is known of surfaces that the equations of a segment jump on */
#include "simulate/run/integration_impl.h"

#include "algebra/linear.h"

#include <math.h>

#define NEAR     1e-10 /* of a condition's largest size: as location leaves it */
#define ROUNDING 1e-14 /* of y */
#define BEYOND   2     /* times as far as a unilateral surface was passed, it may be still */
#define END      1e-9  /* of a sign: so far beyond its end it may begin */
#define REST     1e-9  /* of the largest norm of a vector, */
#define STILL    1e-13 /* or of y, */
#define ERROR    0.3   /* or of the absolute tolerance: such a norm counts as 0 */

double integration_on_surface(const Integration *m, int i)
{
    const double size = fmax(1, vector_largest(m->stepper->y, m->length - 1)); /* as projected */

    return fmax(NEAR * m->largest[i], ROUNDING * size);
}

double integration_rest(const Integration *m, int i)
{
    const Guard guard = equations_guard(m->eq, i);
    const double size = fmax(1, vector_largest(m->stepper->y, m->length - 1));

    return fmax(fmax(m->rest[i], ERROR * m->control.atol),
                fmax(REST * fmax(m->largest[i], m->reach[guard.surface]), STILL * size));
}

void integration_reach(Integration *m)
{
    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);

        if (guard.surface >= 0 && guard.end == 0 && !guard.is_idle)
            m->reach[guard.surface] = fmax(m->reach[guard.surface], m->largest[i]);
    }
}

void integration_begin_surfaces(Integration *m)
{
    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);

        if (guard.surface < 0 || guard.is_idle)
            continue;
        if (guard.end != 0) {
            m->mode[i] = 1;
            m->band[i] = END;
            continue;
        }
        m->largest[i] = fmax(m->largest[i], m->reach[guard.surface]);
        if (guard.side == 0 && !guard.is_unilateral)
            continue;
        m->mode[i] = guard.is_unilateral ? -1 : guard.side;
        if (fabs(m->conditions[i]) <= integration_on_surface(m, i))
            m->band[i] = integration_on_surface(m, i);
        else if (guard.is_unilateral)
            m->band[i] = fmax(0, BEYOND * m->conditions[i]);
    }
}
