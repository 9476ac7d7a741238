/* integration_rows.c: rows of a forward run, from the interpolant of its last step */
#include "simulate/run/integration_impl.h"

#include <math.h>
#include <string.h>

#define SAME_ROW 1e-12 /* of the time between two rows: instants equal within rounding */

/* --- rows --- */

static void add_row(Integration *m, double t)
{
    double position = 0, velocity = 0;

    motion_residuals(m->segment.motion, t, m->y, &position, &velocity);
    m->out->position_residual = fmax(m->out->position_residual, position);
    m->out->velocity_residual = fmax(m->out->velocity_residual, velocity);
    grid_add(m->grid, t, m->segment.phase, m->y, m->length);
    m->grid->steps[m->grid->count - 1] = (int)(m->earlier.steps + m->stepper->counts.steps);
    m->out->reached = t;
    if (m->plan->see != NULL && m->plan->see(m->plan->context, m->segment.phase, t, m->y))
        m->is_stopped = true;
    m->has_new_row = false;
}

bool integration_add_row(Integration *m, double t)
{
    if (!motion_project(m->segment.motion, t, m->y))
        return false;
    add_row(m, t);
    return true;
}

void integration_add_new_row(Integration *m, double t)
{
    add_row(m, t);
    m->has_new_row = true;
}

void integration_enter_row(Integration *m)
{
    if (m->has_new_row)
        m->grid->phase[m->grid->count - 1] = m->segment.phase;
    m->has_new_row = false;
}

bool integration_has_row(const Integration *m, double t)
{
    const Grid *grid = m->grid;

    return grid->count > 0 && t - grid->times[grid->count - 1] <= SAME_ROW * m->plan->every;
}

static Status add_rows_to(Integration *m, double end, Diag *diag)
{
    const IntegrationPlan *plan = m->plan;

    for (; m->next_row <= m->rows; m->next_row++) {
        double t = plan->times != NULL
                       ? plan->times[m->next_row - 1]
                       : grid_time(plan->from, plan->to, plan->every, m->rows, m->next_row);

        if (t > end)
            break;
        if (integration_has_row(m, t))
            continue; /* an event's instant */
        m->stepper->method->at(m->stepper, t, m->y);
        if (!integration_add_row(m, t))
            return solver_failure(diag, t, "the constraints can't be met");
        if (m->is_stopped)
            return diag_set(diag, E_STOPPED, "stopped at t = %.6g s", t);
    }
    return OK;
}

Status integration_add_rows(Integration *m, Diag *diag)
{
    return add_rows_to(m, m->stepper->t, diag);
}

Status integration_add_rows_before(Integration *m, Diag *diag)
{
    return add_rows_to(m, m->stepper->t + SAME_ROW * m->plan->every, diag);
}

Status integration_cut(Integration *m, double t, Diag *diag)
{
    TRY(add_rows_to(m, t, diag)); /* the interpolant is still that of the last step */
    m->stepper->method->at(m->stepper, t, m->y);
    if (!motion_project(m->segment.motion, t, m->y))
        TRY(solver_failure(diag, t, "the constraints can't be met"));
    memcpy(m->stepper->y, m->y, (size_t)m->length * sizeof(double));
    m->stepper->t = t;
    return OK;
}
