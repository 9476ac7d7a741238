/* sensitivity_jump.c: S at an instant where the equations or the state jump
 *
 * The instant t* is where a condition g(t, y, e, p) is 0. Its slope along the motion is that of one
 * more column of S, f itself, while t moves by 1. */
#include "simulate/sensitivity/sensitivity_impl.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* the state just before a crossing, with one more parameter: the time */
typedef struct JumpPoint {
    double t;
    SensitivityParameters by; /* of the order, and the time; owned */
    Variational *variational;
    double *unknowns; /* y, S, and y' as the last column */
    int n;
} JumpPoint;

static void point_close(JumpPoint *point)
{
    variational_free(point->variational);
    MEM_FREE((void *)point->by.sizes, (void *)point->by.symbols, (void *)point->by.weights,
             point->unknowns);
}

static void add_time(const SensitivityParameters *by, Expr time, SensitivityParameters *out)
{
    const int count = by->count + 1, symbols = by->symbol_count + 1;
    double *sizes = NEW_ARRAY(double, count);
    double *weights = NEW_ARRAY(double, symbols *count);
    Expr *all = NEW_ARRAY(Expr, symbols);

    memcpy(sizes, by->sizes, (size_t)by->count * sizeof(double));
    sizes[by->count] = 1;
    for (int i = 0; i < by->symbol_count; i++) {
        all[i] = by->symbols[i];
        memcpy(weights + (ptrdiff_t)i * count, by->weights + (ptrdiff_t)i * by->count,
               (size_t)by->count * sizeof(double));
    }
    all[by->symbol_count] = time;
    weights[symbols * count - 1] = 1;
    *out = (SensitivityParameters){.count = count,
                                   .sizes = sizes,
                                   .symbol_count = symbols,
                                   .symbols = all,
                                   .weights = weights};
}

static Status point_open(SensitivityPass *pass, JumpPoint *point, Diag *diag)
{
    const VariableIndex *l = pass->phase->layout;
    const int count = pass->order->by.count;
    double *rate;

    point->t = pass->t;
    add_time(&pass->order->by, l->symbols[l->t], &point->by);
    TRY(variational_new(pass->phase, &pass->reader->phases->parameters, &point->by,
                        &point->variational, diag));
    point->n = variational_states(point->variational);
    point->unknowns = NEW_ARRAY(double, point->n *(count + 2));
    memcpy(point->unknowns, pass->unknowns,
           (size_t)point->n * (size_t)(count + 1) * sizeof(double));
    rate = NEW_ARRAY(double, point->n + 1);
    if (variational_rate(point->variational, point->t, point->unknowns, rate))
        memcpy(point->unknowns + (ptrdiff_t)point->n * (count + 1), rate,
               (size_t)point->n * sizeof(double));
    else
        rate[0] = NAN;
    mem_free(rate);
    return OK;
}

/* --- the instant --- */

/* where a sign reaches its bound, and the motion leaves a surface that it slides along */
static Status bound_of(const Phase *phase, const Crossing *crossing, Guard guard, Expr *out,
                       Diag *diag)
{
    const VariableIndex *l = phase->layout;

    *out = NULL;
    for (int k = 0; k < l->slides && *out == NULL; k++)
        if (l->surfaces[l->slid_surface[k]].number == guard.surface)
            *out = compiled_bound(l, k, guard.end);
    if (*out != NULL)
        return OK;
    return diag_set(diag, E_MODEL,
                    "at t = %.6g s: what sticks in two or three directions begins to slip: there "
                    "are no sensitivities after that",
                    crossing->before);
}

/* what becomes 0 at a crossing of a condition in the state */
static Status difference_of(const Phase *phase, const Crossing *crossing, Expr *out, Diag *diag)
{
    IdealSwitch ideal;
    Guard guard;

    *out = crossing->difference;
    if (crossing->kind == CROSSING_EVENT)
        return OK;
    guard = equations_guard(compiled_equations(phase->numbers), crossing->condition);
    if (guard.end != 0)
        return bound_of(phase, crossing, guard, out, diag);
    *out = compiled_condition(phase->numbers, crossing->condition);
    if (*out != NULL)
        return OK;
    TRY(system_ideal(phase->system, compiled_margin(phase->numbers, crossing->condition), &ideal,
                     diag));
    *out = variable_index_on_surfaces(phase->layout, ideal.margin);
    return OK;
}

static Status refuse_grazing(double t, Expr difference, Diag *diag)
{
    char *what = expr_text(difference);

    (void)diag_set(diag, E_MODEL,
                   "at t = %.6g s: %s reaches 0 without a slope: the instant has no derivative", t,
                   what);
    mem_free(what);
    diag_hint(diag, "'at' an earlier instant has one");
    return E_MODEL;
}

/* dt* / dp of a condition, times sizes; 0 where it doesn't depend on p */
static Status instant_of(SensitivityPass *pass, const JumpPoint *point, Expr difference,
                         double *out, Diag *diag)
{
    const int count = point->by.count;
    double *slopes = NEW_ARRAY(double, count);
    ItemSlopes *items = NULL;
    bool moves = false;
    Status status = OK;

    CHECK(item_slopes_new(pass->phase, &pass->reader->phases->parameters, &point->by, &difference,
                          1, &items, diag));
    item_slopes_at(items, point->variational, point->t, point->unknowns, slopes);
    for (int p = 0; p < count - 1; p++)
        moves = moves || slopes[p] != 0;
    if (moves && !(fabs(slopes[count - 1]) > 0))
        CHECK(refuse_grazing(point->t, difference, diag));
    for (int p = 0; p < count - 1; p++)
        out[p] = moves ? -slopes[p] * point->by.sizes[p] / slopes[count - 1] : 0;
done:
    item_slopes_free(items);
    mem_free(slopes);
    return status;
}

/* --- jumps of time --- */

typedef LIST(Expr) TimeConditions;

static bool holds_time(Expr e)
{
    return (expr_kinds(e) & 1U << SYMBOL_TIME) != 0 &&
           (expr_kinds(e) & ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER)) == 0;
}

/* differences of the comparisons in the condition of an event that hold t alone */
static void gather(Arena *arena, Expr e, TimeConditions *out)
{
    if (expr_kind(e) != EXPR_CALL)
        return;
    if (expr_op(e) == OP_LT || expr_op(e) == OP_LE) {
        const Expr difference = expr_sub(arena, expr_arg(e, 0), expr_arg(e, 1));

        if (holds_time(difference))
            LIST_PUSH(*out, difference);
        return;
    }
    for (int i = 0; i < expr_arg_count(e); i++)
        gather(arena, expr_arg(e, i), out);
}

/* all conditions in t alone */
static Status time_conditions(const SensitivityPass *pass, TimeConditions *out, Diag *diag)
{
    const Phase *phase = pass->phase;
    const Equations *eq = compiled_equations(phase->numbers);

    for (int i = 0; i < eq->switch_count; i++) {
        const Expr condition = compiled_condition(phase->numbers, i);

        if (condition != NULL && holds_time(condition))
            LIST_PUSH(*out, condition);
    }
    for (int i = 0; i < pass->order->event_count; i++) {
        Expr when;

        TRY(system_resolve(phase->system, pass->order->events[i]->when, &when, diag));
        gather(system_arena(phase->system), when, out);
    }
    return OK;
}

/* whether the sign of a condition changes in the crossing */
static Status changes(SensitivityPass *pass, const Crossing *crossing, Expr condition, bool *out,
                      Diag *diag)
{
    Parameters *parameters = &pass->reader->phases->parameters;
    RowValues row = {.t = crossing->before};
    double before, after;

    TRY(probe_at(pass->phase->layout, parameters, condition, &row, &before, diag));
    row.t = crossing->after;
    TRY(probe_at(pass->phase->layout, parameters, condition, &row, &after, diag));
    *out = !(before * after > 0);
    return OK;
}

static Status refuse_coincidence(double t, Diag *diag)
{
    (void)diag_set(diag, E_MODEL,
                   "at t = %.6g s: several conditions change at one instant, which parameters move "
                   "apart",
                   t);
    return E_MODEL;
}

static Status instant_in_time(SensitivityPass *pass, const JumpPoint *point,
                              const Crossing *crossing, double *out, Diag *diag)
{
    const int count = point->by.count - 1;
    double *own = NEW_ARRAY(double, count);
    TimeConditions conditions = {0};
    bool any = false;
    Status status = OK;

    CHECK(time_conditions(pass, &conditions, diag));
    for (int i = 0; i < conditions.count; i++) {
        bool is_met;

        CHECK(changes(pass, crossing, conditions.at[i], &is_met, diag));
        if (!is_met)
            continue;
        CHECK(instant_of(pass, point, conditions.at[i], own, diag));
        for (int p = 0; p < count && any; p++)
            if (fabs(own[p] - out[p]) > 1e-9 * (fabs(own[p]) + fabs(out[p])))
                CHECK(refuse_coincidence(point->t, diag));
        memcpy(out, own, (size_t)count * sizeof(double));
        any = true;
    }
done:
    LIST_FREE(conditions);
    mem_free(own);
    return status;
}

/* --- the state --- */

static Status refuse_impact(const Crossing *crossing, Diag *diag)
{
    if (!crossing->has_impact)
        return OK;
    return diag_set(diag, E_MODEL, "at t = %.6g s: there are no sensitivities through an impact",
                    crossing->before);
}

static Status refuse_states(double t, Diag *diag)
{
    (void)diag_set(diag, E_MODEL,
                   "at t = %.6g s: ideal switches change the number of states: there are no "
                   "sensitivities after that",
                   t);
    diag_hint(diag, "Ron= and Roff= give switches and diodes resistances, and one set of states");
    return E_MODEL;
}

/* derivatives of y+ at the instant: S- + f- dt*, or through new values; new */
static Status arrive(SensitivityPass *pass, const JumpPoint *point, const Crossing *crossing,
                     const double *after, const double *instants, double **out, Diag *diag)
{
    const int count = pass->order->by.count, n = point->n;
    const CrossingPoint at = {.t = point->t,
                              .n = n,
                              .unknowns = point->unknowns,
                              .rate = point->unknowns + (ptrdiff_t)n * (count + 1),
                              .instants = instants};

    *out = NEW_ARRAY(double, n *count);
    if (crossing->has_new_values)
        return sensitivity_new_values(pass, &at, after, *out, diag);
    for (int p = 0; p < count; p++)
        for (int i = 0; i < n; i++)
            (*out)[p * n + i] = at.unknowns[(p + 1) * n + i] + at.rate[i] * instants[p];
    return OK;
}

/* S+ = d y+ - f+ dt* */
static Status leave(SensitivityPass *pass, const Crossing *crossing, const double *after, int phase,
                    int n, const double *arrived, const double *instants, Diag *diag)
{
    const int count = pass->order->by.count;
    double *rate = NEW_ARRAY(double, n + 1);
    Status status = OK;

    CHECK(sensitivity_open(pass, phase, diag));
    if (variational_states(pass->variational) != n)
        CHECK(refuse_states(crossing->before, diag));
    pass->t = crossing->after;
    motion_window(pass->phase->motion, crossing->after, INFINITY);
    memcpy(pass->unknowns, after, (size_t)n * sizeof(double));
    if (!variational_rate(pass->variational, pass->t, pass->unknowns, rate))
        CHECK(solver_failure(diag, pass->t, "the rates are undefined"));
    for (int p = 0; p < count; p++)
        for (int i = 0; i < n; i++)
            pass->unknowns[(ptrdiff_t)(p + 1) * n + i] = arrived[p * n + i] - rate[i] * instants[p];
    if (!variational_project(pass->variational, pass->t, pass->unknowns))
        CHECK(solver_failure(diag, pass->t, "the constraints have no derivatives"));
done:
    mem_free(rate);
    return status;
}

Status sensitivity_jump(SensitivityPass *pass, int which, Diag *diag)
{
    const Crossings *crossings = &pass->reader->result->crossings;
    const Crossing *crossing = &crossings->list.at[which];
    double *instants = NEW_ARRAY(double, pass->order->by.count);
    double *arrived = NULL;
    const double *after;
    JumpPoint point = {0};
    Expr difference = NULL;
    Status status = OK;

    CHECK(refuse_impact(crossing, diag));
    CHECK(point_open(pass, &point, diag));
    if (crossing->kind == CROSSING_TIME) {
        CHECK(instant_in_time(pass, &point, crossing, instants, diag));
    } else {
        CHECK(difference_of(pass->phase, crossing, &difference, diag));
        CHECK(instant_of(pass, &point, difference, instants, diag));
    }
    after = grid_row(&crossings->states, 2 * which + 1);
    CHECK(arrive(pass, &point, crossing, after, instants, &arrived, diag));
    CHECK(leave(pass, crossing, after, crossings->states.phase[2 * which + 1], point.n, arrived,
                instants, diag));
done:
    mem_free(arrived);
    point_close(&point);
    mem_free(instants);
    return status;
}
