/* causes.c: frames at the same point, and what has no mass */
#include "simulate/equations/causes.h"

#include "base/memory.h"
#include "simulate/equations/rows.h"

#include <math.h>

#define CLOSE 1e-12 /* m: positions are solved to less */
#define BRIEF 1e-6  /* of a time that is short: rates are as good as constant */

static bool value_at(const Layout *l, Parameters *parameters, Expr e, double t, const double *y,
                     double *out)
{
    const RowValues row = row_of_state(l, t, y);
    Diag ignored = {0};

    return probe_at(l, parameters, e, &row, out, &ignored) == OK;
}

/* a spring, damper or actuator between frames that meet: it has no direction there */
bool cause_meeting(const Layout *l, Parameters *parameters, double t, const double *y,
                   const char *what, Diag *diag)
{
    FrameLine line;
    double length;

    for (int next = 0; system_line(l->system, &next, &line);)
        if (value_at(l, parameters, line.length, t, y, &length) && fabs(length) < CLOSE) {
            (void)diag_set(diag, E_SINGULAR,
                           "%s: the frames of %s, %s and %s, are at the same point, where its line "
                           "has no direction",
                           what, line.name, line.tail, line.head);
            diag_hint(diag, "start where they are apart, with 'init' or 'guess'; what acts on a "
                            "joint has no line");
            return true;
        }
    return false;
}

/* how fast a length changes, at a state that changes at `rate` */
static double speed_of(const Layout *l, Parameters *parameters, Expr length, double t,
                       const double *y, const double *rate, double time)
{
    const int count = layout_references(l) + l->multi_turns;
    double *later = NEW_ARRAY(double, count);
    double before = 0, after = 0;

    for (int i = 0; i < count; i++)
        later[i] = y[i] + time * rate[i];
    if (!value_at(l, parameters, length, t, y, &before) ||
        !value_at(l, parameters, length, t, later, &after))
        after = before;
    mem_free(later);
    return fabs(after - before) / time;
}

bool cause_closing(const Layout *l, Parameters *parameters, double t, const double *y,
                   const double *rate, double time, const char *what, Diag *diag)
{
    FrameLine line;
    double length;

    for (int next = 0; system_line(l->system, &next, &line);)
        if (value_at(l, parameters, line.length, t, y, &length) &&
            fabs(length) <=
                CLOSE + time * speed_of(l, parameters, line.length, t, y, rate, BRIEF * time)) {
            (void)diag_set(
                diag, E_SOLVER,
                "%s: the frames of %s, %s and %s, come to the same point, where its line "
                "has no direction",
                what, line.name, line.tail, line.head);
            diag_hint(diag, "keep them apart, by a stop or an arm, or end the run before with an "
                            "event and do=stop; what acts on a joint has no line");
            return true;
        }
    return false;
}

/* a coordinate whose row of the mass matrix is empty */
static bool tell_massless(const Layout *l, const char *what, Diag *diag)
{
    const Reading *run = system_run(l->system);

    if (system_form_mass(l->system, NULL) != OK)
        return false;
    for (int j = 0; j < l->nu; j++) {
        bool is_empty = true;
        int q;

        for (int k = 0; k < l->nu && is_empty; k++)
            is_empty = expr_is_zero(run->mass[j * l->nu + k]);
        if (!is_empty)
            continue;
        q = speed_coordinate(l->system, j);
        (void)diag_set(diag, E_SINGULAR, "%s: what %s moves has no mass or inertia", what,
                       q >= 0 ? system_q(l->system, q)->name : system_u(l->system, j)->name);
        diag_hint(diag, "a body turns with inertia=, beside mass=: body m1 mass=2 inertia=0.1 in "
                        "the plane, inertia=[0.1, 0.2, 0.2] in space");
        return true;
    }
    return false;
}

bool cause_tell(const Layout *layout, Parameters *parameters, double t, const double *y,
                const char *what, Diag *diag)
{
    return cause_meeting(layout, parameters, t, y, what, diag) || tell_massless(layout, what, diag);
}
