/* sundials.c: start and end of integrations by SUNDIALS */
#include "simulate/integrate/sundials.h"

#include <string.h>

const double sundials_nodes[1] = {1};

static void give_back(void *object)
{
    Sundials *s = object;

    s->calls->free(&s->memory);
    if (s->linear != NULL)
        SUNLinSolFree(s->linear);
    if (s->nonlinear != NULL)
        SUNNonlinSolFree(s->nonlinear);
    if (s->matrix != NULL)
        SUNMatDestroy(s->matrix);
    N_VDestroy(s->w);
    N_VDestroy(s->out);
    N_VDestroy(s->rate);
    SUNContext_Free(&s->context);
    cleanup_close(&s->cleanup);
}

void sundials_init(Sundials *s, const SundialsCalls *calls, const Method *method, const Ode *ode,
                   const Control *control, int n)
{
    stepper_init(&s->base, method, ode, control);
    s->calls = calls;
    s->all = stepper_length(&s->base);
    s->n = n;
    cleanup_open(&s->cleanup, give_back, s);
    mem_ask();
    if (SUNContext_Create(NULL, &s->context) != 0)
        transaction_fail();
    s->w = MEM_GIVEN(N_VNew_Serial(n, s->context));
    s->out = MEM_GIVEN(N_VNew_Serial(n, s->context));
}

void sundials_store_reason(int code, const char *module, const char *function, char *message,
                           void *stepper)
{
    Sundials *s = stepper;

    (void)code, (void)module, (void)function;
    (void)snprintf(s->reason, sizeof s->reason, "%s", message);
}

void sundials_place(Sundials *s, double t, const double *y)
{
    stepper_place(&s->base, t, y);
    memcpy(N_VGetArrayPointer(s->w), s->base.y, (size_t)s->all * sizeof(double));
    s->earlier = s->base.counts;
    s->is_new = true;
}

double sundials_quadrature_error(Sundials *s, double value, double rate)
{
    const Control *control = &s->base.control;
    const double part = stepper_part(&s->base);

    if (isfinite(rate))
        s->power = fmax(s->power, fabs(rate));
    /* a pulse that starts from rest is detected by what it moves */
    if (!(s->power > control->atol) || !(control->span > 0))
        return SUNDIALS_ANY;
    return part * (control->rtol * (fabs(value) + s->power * control->span) + control->atol);
}

int sundials_bound(Sundials *s, double end)
{
    const double most = stepper_allowed(&s->base, control_largest(&s->base.control));
    int code = s->calls->set_stop_time(s->memory, stepper_stop(&s->base, end));

    if (code == 0) /* growth is bounded there; a stop time only cuts a grown step */
        code = s->calls->set_max_step(s->memory, most);
    if (code == 0 && s->is_new)
        code = s->calls->set_first_step(s->memory, s->base.next);
    s->is_new = false;
    return code;
}

void sundials_count(Sundials *s)
{
    long steps = 0, failures = 0, jacobians = 0;

    (void)s->calls->get_steps(s->memory, &steps);
    (void)s->calls->get_failures(s->memory, &failures);
    if (s->linear != NULL)
        (void)s->calls->get_jacobians(s->memory, &jacobians);
    s->base.counts.steps = s->earlier.steps + steps;
    s->base.counts.rejected = s->earlier.rejected + failures;
    s->base.counts.jacobians = s->earlier.jacobians + jacobians;
}

/* the codes that CVODE and IDA share, negative */
static const char *reason_of(const Sundials *s, int code)
{
    switch (-code) {
    case 2:
        return "the tolerance is below what numbers hold";
    case 3:
        return "the error stays above the tolerance, however short the step";
    case 4:
        return "Newton's method finds no next step, however short";
    case 5:
    case 6:
    case 7:
        return "the linear equations of a step have no solution";
    case 8:
    case 9:
    case 10:
    case 11:
    case 12:
        return "the equations have no solution just behind this instant";
    case 22: /* h0 or a distance below the resolution of time */
    case 27:
        return "the step became too small";
    default:
        return s->reason;
    }
}

/* Newton's method is limited by rounding error, most where multipliers are among the unknowns and a
 * position is nearly singular. */
static void hint_at_way_out(Diag *diag)
{
    diag_hint(diag, "method=%s may get further; so may a coarser rtol=", method_radau.name);
}

Status sundials_failure(Sundials *s, int code, Diag *diag)
{
    (void)solver_failure(diag, s->base.t, reason_of(s, code));
    hint_at_way_out(diag);
    return E_SOLVER;
}

Status sundials_arrive(Sundials *s, double reached, Diag *diag)
{
    double h = 0, next = 0;

    (void)s->calls->get_last_step(s->memory, &h);
    (void)s->calls->get_next_step(s->memory, &next);
    if (stepper_arrive(&s->base, reached, h, next, diag) != OK) {
        hint_at_way_out(diag);
        return E_SOLVER;
    }
    memcpy(s->base.y, N_VGetArrayPointer(s->w), (size_t)s->all * sizeof(double));
    return OK;
}

void sundials_destroy(Stepper *stepper)
{
    if (stepper != NULL)
        give_back(stepper);
    stepper_free(stepper);
}

/* a derivative of the history's polynomial, of this order */
static bool read_history(Sundials *s, double t, int order, double *out)
{
    if (s->calls->get_derivative(s->memory, t, order, s->out) != 0)
        return false;
    memcpy(out, N_VGetArrayPointer(s->out), (size_t)s->all * sizeof(double));
    return true;
}

void sundials_at(Stepper *stepper, double t, double *y)
{
    Sundials *s = (Sundials *)stepper;

    if (t == s->base.t || !read_history(s, t, 0, y))
        memcpy(y, s->base.y, (size_t)s->all * sizeof(double));
}

Status sundials_shorten(Stepper *stepper, double t, Diag *diag)
{
    const Sundials *s = (const Sundials *)stepper;

    return stepper_reject(stepper, t, N_VGetArrayPointer(s->w), diag);
}

/* once there is a history */
bool sundials_slope(Stepper *stepper, double *rate)
{
    Sundials *s = (Sundials *)stepper;

    return s->base.t > s->base.before && read_history(s, s->base.t, 1, rate);
}
