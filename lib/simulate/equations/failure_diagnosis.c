/* failure_diagnosis.c: coincident frames, motions without mass, drivers at the end of their
 * range */
#include "simulate/equations/failure_diagnosis.h"

#include "algebra/linear.h"
#include "base/memory.h"
#include "base/text.h"
#include "formulate/kinematics/edges.h"
#include "simulate/equations/equations_limits.h"
#include "simulate/equations/rows.h"

#include <math.h>
#include <string.h>

enum { MOST_LOOKED_AT = 100 }; /* speeds; the cost grows with their fourth power */

static bool value_at(const VariableIndex *l, Parameters *parameters, Expr e, double t,
                     const double *y, double *out)
{
    const RowValues row = row_of_state(l, t, y);
    Diag ignored = {0};

    return probe_at(l, parameters, e, &row, out, &ignored) == OK;
}

/* a spring, damper or actuator whose two frames coincide: its direction is undefined there */
bool failure_meeting(const VariableIndex *l, Parameters *parameters, double t, const double *y,
                     const char *what, Diag *diag)
{
    FrameLine line;
    double length;

    for (int next = 0; system_line(l->system, &next, &line);)
        if (value_at(l, parameters, line.length, t, y, &length) &&
            fabs(length) < FAILURE_SAME_POINT) {
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
static double speed_of(const VariableIndex *l, Parameters *parameters, Expr length, double t,
                       const double *y, const double *rate, double time)
{
    const int count = variable_index_references(l) + l->multi_turns;
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

bool failure_closing(const VariableIndex *l, Parameters *parameters, double t, const double *y,
                     const double *rate, double time, const char *what, Diag *diag)
{
    FrameLine line;
    double length;

    for (int next = 0; system_line(l->system, &next, &line);)
        if (value_at(l, parameters, line.length, t, y, &length) &&
            fabs(length) <= FAILURE_SAME_POINT + time * speed_of(l, parameters, line.length, t, y,
                                                                 rate, FAILURE_DIFFERENCE * time)) {
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
static bool report_massless(const VariableIndex *l, const char *what, Diag *diag)
{
    const EquationForm *run = system_run(l->system);

    /* constraints may couple a speed to the mass of another */
    if (l->m > 0 || system_form_mass(l->system, NULL) != OK)
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

/* a beam in space whose sections have no rotary inertia; NULL: there is none */
static const char *thin_beam(const VariableIndex *l)
{
    enum { IN_PLANE = 2 }; /* families of shapes: stretch and bending */

    for (int i = 0; i < system_instance_count(l->system); i++) {
        const Instance *instance = system_instance(l->system, i);

        if (instance_bends(instance) && instance_value(instance, "modes")->count > IN_PLANE &&
            !instance_value(instance, "inertia_per_length")->given)
            return instance->name;
    }
    return NULL;
}

/* [S M S; Phi_u S R] at y, (nu + m) x nu: S divides columns by the root of the diagonal entry of M,
 * which is returned in `scale`; a column where that is zero is unchanged. R divides rows of Phi_u
 * by their size. */
static void scaled_rows(const VariableIndex *l, Parameters *parameters, double t, const double *y,
                        double *rows, double *scale)
{
    const EquationForm *run = system_run(l->system);
    double largest = 0;

    for (int i = 0; i < (l->nu + l->m) * l->nu; i++)
        if (!value_at(l, parameters,
                      i < l->nu * l->nu ? run->mass[i] : run->phi_u[i - l->nu * l->nu], t, y,
                      &rows[i]))
            rows[i] = 0;
    for (int j = 0; j < l->nu; j++)
        largest = fmax(largest, rows[j * l->nu + j]);
    for (int j = 0; j < l->nu; j++)
        scale[j] = rows[j * l->nu + j] > FAILURE_NO_MASS * largest ? sqrt(rows[j * l->nu + j]) : 1;
    for (int i = 0; i < l->nu * l->nu; i++)
        rows[i] /= scale[i / l->nu] * scale[i % l->nu];
    for (int k = l->nu; k < l->nu + l->m; k++) {
        double *row = rows + (ptrdiff_t)k * l->nu, size;

        for (int j = 0; j < l->nu; j++)
            row[j] /= scale[j];
        size = vector_largest(row, l->nu);
        for (int j = 0; j < l->nu && size > 0; j++)
            row[j] /= size;
    }
}

/* Speeds that together move no mass and obey the constraints, returned in `shares`: column j is a
 * linear combination of the others. */
static bool find_massless(const VariableIndex *l, const double *rows, int j, double *shares)
{
    const int count = l->nu + l->m;
    double *others = NEW_ARRAY(double, count * l->nu);
    double *column = NEW_ARRAY(double, count);
    double *made = NEW_ARRAY(double, count);
    double left = 0;

    for (int i = 0; i < count; i++) {
        column[i] = rows[i * l->nu + j];
        for (int k = 0; k < l->nu; k++)
            others[i * l->nu + k] = k == j ? 0 : rows[i * l->nu + k];
    }
    if (rows_solve(others, count, l->nu, column, shares) < 0)
        left = INFINITY;
    matrix_times(others, count, l->nu, shares, made);
    for (int i = 0; i < count; i++)
        left = hypot(left, column[i] - made[i]);
    shares[j] = -1;
    MEM_FREE(others, column, made);
    return left < FAILURE_SINGULAR;
}

/* the coordinates whose speeds have a share worth naming */
static int name_shares(const VariableIndex *l, const double *shares, const double *scale, Text *out)
{
    double largest = 0;
    int count = 0;

    for (int j = 0; j < l->nu; j++)
        largest = fmax(largest, fabs(shares[j]) / scale[j]);
    for (int j = 0; j < l->nu; j++) {
        const int q = speed_coordinate(l->system, j);

        if (fabs(shares[j]) / scale[j] > FAILURE_TAKES_PART * largest)
            text_addf(out, "%s%s", count++ > 0 ? ", " : "",
                      q >= 0 ? system_q(l->system, q)->name : system_u(l->system, j)->name);
    }
    return count;
}

/* what to change where the motion without mass belongs to a body, a beam, or several parts */
static void hint_at_mass(const char *beam, Diag *diag)
{
    if (beam != NULL)
        diag_hint(diag,
                  "a beam resists a turn about its axis by its sections alone: give %s "
                  "inertia_per_length=[Jx, Jy, Jz]",
                  beam);
    else
        diag_hint(diag, "give one of these bodies inertia= (in space [Jx, Jy, Jz]), or leave the "
                        "motion out by a joint with less freedom, as universal for spherical");
}

/* Speeds that together move no mass at y and that constraints don't prevent. Examples: the rotation
 * of a straight beam about its axis, or of a rod without inertia between two ball joints. */
static bool report_massless_here(const VariableIndex *l, Parameters *parameters, double t,
                                 const double *y, const char *what, Diag *diag)
{
    const char *beam = thin_beam(l);
    double *rows, *scale, *shares;
    Text named = {0};
    bool found = false;

    if (l->nu > MOST_LOOKED_AT || system_form_mass(l->system, NULL) != OK)
        return false;
    rows = NEW_ARRAY(double, (l->nu + l->m) * l->nu);
    scale = NEW_ARRAY(double, l->nu);
    shares = NEW_ARRAY(double, l->nu);
    scaled_rows(l, parameters, t, y, rows, scale);
    for (int j = 0; j < l->nu && !found; j++)
        found = find_massless(l, rows, j, shares);
    if (found) {
        const int count = name_shares(l, shares, scale, &named);

        (void)diag_set(diag, E_SINGULAR,
                       count == 1 ? "%s: what %s moves has no mass or inertia there"
                                  : "%s: %s can move together where there is no mass or inertia",
                       what, named.at);
        hint_at_mass(beam, diag);
    }
    text_free(&named);
    MEM_FREE(rows, scale, shares);
    return found;
}

/* the share of each constraint row in a driver's row, and the part of the driver's row that is
 * left */
static double find_parts(const VariableIndex *l, const Equations *equations, int driver,
                         double *parts)
{
    double *phi_u = pattern_spread(equations->rows, equations->phi_u);
    const double *row = phi_u + (ptrdiff_t)driver * l->nu;
    double *others = NEW_ARRAY(double, l->nu * l->m);
    double *own = NEW_ARRAY(double, l->nu);
    double left = 0;

    for (int k = 0; k < l->m; k++)
        for (int j = 0; j < l->nu; j++)
            others[j * l->m + k] = k == driver ? 0 : phi_u[(ptrdiff_t)k * l->nu + j];
    if (rows_solve(others, l->nu, l->m, row, parts) < 0)
        left = NAN;
    matrix_times(others, l->nu, l->m, parts, own);
    for (int j = 0; j < l->nu; j++)
        left = hypot(left, row[j] - own[j]);
    MEM_FREE(others, own, phi_u);
    return left;
}

double failure_own_part(const VariableIndex *l, const Equations *equations, int driver)
{
    double *parts = NEW_ARRAY(double, l->m);
    const double left = find_parts(l, equations, driver, parts);

    mem_free(parts);
    return left;
}

static void add_joint(const char *name, const char **named, int *count)
{
    for (int i = 0; i < *count; i++)
        if (strcmp(named[i], name) == 0)
            return;
    named[(*count)++] = name;
}

/* joints that a row belongs to or that move it, each once */
static void add_joints(const VariableIndex *l, const Equations *equations, int row,
                       const char **named, int *count)
{
    const System *system = l->system;

    if (!system_constraint(system, row)->is_driver)
        add_joint(system_instance_name(system, system_constraint(system, row)->instance), named,
                  count);
    for (int e = equations->rows->start[row]; e < equations->rows->start[row + 1]; e++) {
        const int q = speed_coordinate(system, equations->rows->row[e]);
        VariableReferent stand;

        if (q < 0 || equations->phi_u[e] == 0)
            continue;
        stand = system_referent(system, system_q(system, q)->name);
        if (stand.kind == REFERENT_COORDINATE && stand.instance->row->family != FAMILY_BODY)
            add_joint(stand.instance->name, named, count);
    }
}

void failure_leading(const VariableIndex *l, const Equations *equations, int driver,
                     const char *what, Diag *diag)
{
    const ConstraintRow *row = system_constraint(l->system, driver);
    const char **named = NEW_ARRAY(const char *, l->m + l->nu);
    double *parts = NEW_ARRAY(double, l->m);
    Text text = {0};
    double most = 0;
    int count = 0;

    (void)find_parts(l, equations, driver, parts);
    for (int k = 0; k < l->m; k++)
        most = fmax(most, fabs(parts[k]));
    for (int k = 0; k < l->m; k++)
        if (k == driver || fabs(parts[k]) > FAILURE_TAKES_PART * most)
            add_joints(l, equations, k, named, &count);
    for (int i = 0; i < count; i++)
        text_addf(&text, "%s%s", i == 0 ? "" : i == count - 1 ? " and " : ", ", named[i]);
    (void)diag_set(diag, E_SOLVER, "%s: %s leads where %s can't follow", what,
                   system_instance_name(l->system, row->instance),
                   count > 0 ? text.at : "the parts");
    diag_hint(diag, "keep its law within the loop's reach, lengthen the loop's parts, or end the "
                    "run before with an event and do=stop");
    text_free(&text);
    MEM_FREE(named, parts);
}

bool failure_beyond(const VariableIndex *l, Parameters *parameters, double t, const double *y,
                    const char *what, Diag *diag)
{
    const Switch *switches;
    SystemSurface surface;
    int time_only;

    (void)system_switches(l->system, &switches, &time_only);
    for (int i = 0; system_surface(l->system, i, &surface); i++) {
        const char *part;
        double beyond;

        if (!surface.law.is_unilateral ||
            !value_at(l, parameters, surface.condition, t, y, &beyond) ||
            !(beyond > FAILURE_SAME_POINT))
            continue;
        part = system_jumping_part(l->system, surface.condition);
        (void)diag_set(diag, E_SINGULAR, "%s: %s is %.6g beyond its limit", what,
                       part != NULL ? part : "unilateral()", beyond);
        diag_hint(diag, "start on the other side of it, with 'init' or 'guess'");
        return true;
    }
    return false;
}

bool failure_diagnose(const VariableIndex *layout, Parameters *parameters, double t,
                      const double *y, const char *what, Diag *diag)
{
    return failure_beyond(layout, parameters, t, y, what, diag) ||
           failure_meeting(layout, parameters, t, y, what, diag) ||
           report_massless(layout, what, diag) ||
           report_massless_here(layout, parameters, t, y, what, diag);
}
