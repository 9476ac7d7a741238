/* march_slide.c: a forward run on surfaces that its equations jump on */
#include "simulate/run/march_impl.h"

#include "algebra/linear.h"

#include <math.h>
#include <string.h>

#define NEAR     1e-10 /* of a condition's largest size: as location leaves it */
#define ROUNDING 1e-14 /* of y */
#define END      1e-9  /* of a sign: so far beyond its end it may begin */
#define KEPT     64    /* surfaces, whose sides are all kept: each set of sides is a phase */

double march_on_surface(const March *m, int i)
{
    double size = vector_largest(m->stepper->y, m->length - 1);

    return fmax(NEAR * m->largest[i], ROUNDING * size);
}

void march_reach(March *m)
{
    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);

        if (guard.surface >= 0 && guard.end == 0)
            m->reach[guard.surface] = fmax(m->reach[guard.surface], m->largest[i]);
    }
}

void march_begin_surfaces(March *m)
{
    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);

        if (guard.surface < 0)
            continue;
        if (guard.end != 0) {
            m->mode[i] = 1;
            m->band[i] = END;
            continue;
        }
        m->largest[i] = fmax(m->largest[i], m->reach[guard.surface]);
        if (guard.side != 0) {
            m->mode[i] = guard.side;
            if (fabs(m->conditions[i]) <= march_on_surface(m, i))
                m->band[i] = march_on_surface(m, i);
        }
    }
}

/* what is known of the surface that condition i tells the side of */
static bool meets(March *m, int i, Meeting *out)
{
    const Guard guard = equations_guard(m->eq, i);
    bool near;

    m->largest[i] = fmax(m->largest[i], fabs(m->conditions[i]));
    near = i == m->root || guard.solved || fabs(m->conditions[i]) <= march_on_surface(m, i);
    *out = (Meeting){guard.surface,
                     near                   ? 0
                     : m->conditions[i] > 0 ? 1
                                            : -1,
                     !near, i == m->root && m->chatters[guard.surface].settles};
    return near || m->surfaces <= KEPT;
}

/* The surfaces that the run stands on, and where there are few of them all others: so that no step
 * sees what is behind one. `on`: whether the leg stays on sides of any. */
static int find_meetings(March *m, Meeting *at, bool *on)
{
    int count = 0;

    *on = false;
    march_evaluate(m, m->stepper->t, m->stepper->y);
    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);

        if (guard.surface < 0)
            continue;
        *on = *on || guard.side != 0 || guard.end != 0;
        if (guard.end < 0) { /* with the other end, just before it */
            if (i == m->root)
                at[count - 1].side = -1;
        } else if (guard.end > 0) {
            at[count++] = (Meeting){guard.surface, i == m->root ? 1 : 0, false, false};
        } else if (meets(m, i, &at[count])) {
            count++;
        }
    }
    return count;
}

Status march_slide(March *m, bool *entered, bool *changed, Diag *diag)
{
    Meeting *at = NEW_ARRAY(Meeting, m->eq->switch_count);
    double *y = NEW_ARRAY(double, m->length);
    double t = m->stepper->t;
    Leg next = m->leg;
    bool on = false;
    int count = m->root != ROOT_NONE ? find_meetings(m, at, &on) : 0;
    Status status = OK;

    *entered = *changed = false;
    if (m->plan->choose == NULL || m->root == ROOT_NONE || (count == 0 && !on))
        goto done;
    memcpy(y, m->stepper->y, (size_t)m->length * sizeof(double));
    CHECK(
        m->plan->choose(m->plan->context, t, m->low, m->high, y, at, count, &next, entered, diag));
    if (*entered) {
        march_reach(m);
        CHECK(march_enter(m, &next, t, y, changed, diag));
    }
    motion_window(m->leg.motion, m->low, m->high);
    if (*entered)
        (void)motion_project(m->leg.motion, t, m->stepper->y);
done:
    mem_free(at);
    mem_free(y);
    return status;
}
