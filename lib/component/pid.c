/* pid.c: PD and PID control, and transfer functions
 *
 * With e = ref - of, the filter's time constant T and the sampling period h (both s):
 *
 *     PD        u = Kp e + Kd e', or with a filter Kd (e - f)/T where f' = (e - f)/T
 *     PID       the same + Ki I,  I' = e + (y - u)/Kp
 *     sampled   Kd (e - previous)/h or Kd (e - f)/(T + h),  f+ = f + (e - f) h/(T + h),
 *               I+ = I + h I'
 *
 * y is u within its limits: the integral returns from them with the time constant Kp/Ki (Astrom and
 * Haegglund 1995, section 3.5).
 *
 * A transfer function has the states of the controllable canonical form, x1' = x2 ... and
 * xn' = of - a_n x1 - ... - a_1 xn. Sampled, these advance by the trapezoidal rule. */
#include "component/control.h"

#include "base/memory.h"
#include "expr/jumps.h"

#include <stdio.h>
#include <string.h>

/* clang-format off */
static const Param pd_params[] = {
    {"ref",    PARAM_LAW,    NULL, NULL, "the reference, any expression", ALIKE},
    {"of",     PARAM_LAW,    NULL, NULL, "the measured value, any expression", ALIKE},
    {"Kp",     PARAM_LAW,    NULL, NULL, "output per error, ref - of", 0},
    {"Kd",     PARAM_LAW,    NULL, NULL, "output per rate of the error", 0},
    {"filter", PARAM_SCALAR, "s",  "0",  "time constant of the rate", 0},
    BLOCK_PARAMS,
};
static const Param pid_params[] = {
    {"ref",     PARAM_LAW,    NULL, NULL, "the reference, any expression", ALIKE},
    {"of",      PARAM_LAW,    NULL, NULL, "the measured value, any expression", ALIKE},
    {"Kp",      PARAM_LAW,    NULL, NULL, "output per error, ref - of", 0},
    {"Ki",      PARAM_LAW,    NULL, NULL, "output per integral of the error", 0},
    {"Kd",      PARAM_LAW,    NULL, "0",  "output per rate of the error", 0},
    {"filter",  PARAM_SCALAR, "s",  "0",  "time constant of the rate", 0},
    {"initial", PARAM_SCALAR, NULL, "0",  "the integral at the start", 0},
    BLOCK_PARAMS,
};
static const Param transfer_params[] = {
    {"of",  PARAM_LAW,  NULL, NULL, "the input, any expression", 0},
    {"num", PARAM_LIST, NULL, NULL, "coefficients of the numerator, highest power first", 0},
    {"den", PARAM_LIST, NULL, NULL, "coefficients of the denominator", 0},
    BLOCK_PARAMS,
};

static const Member pd_members[] = {
    {"filtered", NULL, "the filtered error, with filter=", 1},
    {"previous", NULL, "the error at the last sampling instant, with period=", 1},
    BLOCK_MEMBERS,
};
static const Member pid_members[] = {
    {"integral", NULL, "integral of the error", 1},
    {"filtered", NULL, "the filtered error, with filter=", 1},
    {"previous", NULL, "the error at the last sampling instant, with period=", 1},
    BLOCK_MEMBERS,
};
static const Member transfer_members[] = {
    {"x1", NULL, "its states x1, x2 ..., each the derivative of the one before", 1},
    BLOCK_MEMBERS,
};
/* clang-format on */

/* --- PD and PID --- */

static bool is_pid(const Instance *instance)
{
    return component_param(instance->row, "Ki") >= 0;
}

static bool has_rate(const Instance *instance)
{
    return !expr_is_zero(instance_scalar(instance, "Kd"));
}

static bool has_filter(const Instance *instance)
{
    return !expr_is_zero(instance_scalar(instance, "filter"));
}

static Expr error_of(const Instance *instance, Arena *arena)
{
    return expr_sub(arena, instance_scalar(instance, "ref"), instance_scalar(instance, "of"));
}

/* the state that the derivative of the error needs; NULL: none */
static const char *rate_state(const Instance *instance)
{
    if (!has_rate(instance))
        return NULL;
    if (has_filter(instance))
        return "filtered";
    return block_is_sampled(instance) ? "previous" : NULL;
}

/* the derivative of the error, as the block computes it */
static Expr error_rate(const Instance *instance, Arena *arena)
{
    Expr e = error_of(instance, arena);
    Expr span = instance_scalar(instance, "filter");

    if (rate_state(instance) == NULL)
        return system_user_rate(arena, e);
    if (block_is_sampled(instance))
        span = expr_add(arena, span, instance_scalar(instance, "period"));
    return expr_div(arena, expr_sub(arena, e, block_state(instance, arena, rate_state(instance))),
                    span);
}

static Expr pid_command(const Instance *instance, Arena *arena)
{
    Expr terms[3] = {expr_int(arena, 0), expr_int(arena, 0), expr_int(arena, 0)};

    terms[0] = expr_mul(arena, instance_scalar(instance, "Kp"), error_of(instance, arena));
    if (is_pid(instance))
        terms[1] = expr_mul(arena, instance_scalar(instance, "Ki"),
                            block_state(instance, arena, "integral"));
    if (has_rate(instance))
        terms[2] = expr_mul(arena, instance_scalar(instance, "Kd"), error_rate(instance, arena));
    return expr_sum(arena, terms, 3);
}

static void pid_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                         Relation *out)
{
    (void)which;
    (void)motion;
    block_relation(instance, arena, pid_command(instance, arena), out);
    if (has_rate(instance) && rate_state(instance) == NULL)
        out->smooth = error_of(instance, arena);
}

static int pid_states(const Instance *instance)
{
    return block_state_count(instance, (int)is_pid(instance) + (rate_state(instance) != NULL));
}

static void integral_state(const Instance *instance, Arena *arena, OwnState *out)
{
    Expr command = pid_command(instance, arena);
    Expr rate = error_of(instance, arena);

    if (instance_value(instance, "limits")->given) {
        Expr over = expr_sub(arena, block_limited(instance, arena, command), command);

        rate = expr_add(arena, rate, expr_div(arena, over, instance_scalar(instance, "Kp")));
    }
    *out = (OwnState){.member = "integral",
                      .initial = instance_scalar(instance, "initial"),
                      .rate = rate,
                      .next = expr_add(arena, block_state(instance, arena, "integral"),
                                       expr_mul(arena, instance_scalar(instance, "period"), rate))};
    block_choose(instance, arena, out);
}

static void memory_state(const Instance *instance, Arena *arena, OwnState *out)
{
    Expr e = error_of(instance, arena);
    Expr h = instance_scalar(instance, "period");
    Expr T = instance_scalar(instance, "filter");
    Expr f = block_state(instance, arena, "filtered");
    Expr left = expr_sub(arena, e, f);

    *out = (OwnState){.member = rate_state(instance), .initial = expr_int(arena, 0), .next = e};
    if (has_filter(instance)) {
        out->rate = expr_div(arena, left, T);
        out->next =
            expr_add(arena, f, expr_mul(arena, left, expr_div(arena, h, expr_add(arena, T, h))));
    }
    block_choose(instance, arena, out);
}

static void pid_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    if (is_pid(instance) && k-- == 0)
        integral_state(instance, arena, out);
    else if (rate_state(instance) != NULL && k-- == 0)
        memory_state(instance, arena, out);
    else
        block_held(instance, arena, pid_command(instance, arena), out);
}

/* Without filter and sampling the block differentiates: a jump would be an impulse. */
static Status check_no_jump(const Instance *instance, Arena *arena, Diag *diag)
{
    static const char *const names[] = {"ref", "of"};
    const Expr error = error_of(instance, arena);
    const unsigned kinds = ~(1U << SYMBOL_PARAMETER);

    if (!has_rate(instance) || rate_state(instance) != NULL || !expr_jumps(arena, error, kinds))
        return OK;
    (void)diag_set(diag, E_VALUE, "%s takes the derivative of something that jumps",
                   instance->name);
    diag_hint(diag, "filter= smooths it, or give the source a rise time");
    for (size_t i = 0; i < COUNT(names); i++)
        if (expr_jumps(arena, instance_scalar(instance, names[i]), kinds)) {
            diag_about(diag, "%s", names[i]);
            break;
        }
    return E_VALUE;
}

static Status pid_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)planar;
    TRY(check_not_negative(instance, "filter", diag));
    TRY(block_check(instance, diag));
    TRY(check_no_jump(instance, arena, diag));
    if (is_pid(instance) && instance_value(instance, "limits")->given &&
        expr_is_zero(instance_scalar(instance, "Kp"))) {
        (void)diag_set(diag, E_VALUE, "with limits= %s needs Kp=", instance->name);
        diag_hint(diag, "its integral comes back from a limit with the time constant Kp/Ki; "
                        "an integrator of its own can have limits alone");
        return E_VALUE;
    }
    return OK;
}

const Component component_pd = {
    .name = "pd",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "proportional and derivative control",
    .params = pd_params,
    .param_count = COUNT(pd_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = pid_relation,
    .own_state_count = pid_states,
    .own_state = pid_state,
    .members = pd_members,
    .member_count = COUNT(pd_members),
    .check = pid_check,
    .help = "A voltage source of Kp*e + Kd*e', where e = ref - of. Both ref and of may be any "
            "expression with a derivative; one that jumps is refused. With filter=T the rate is "
            "that of a first-order lag, (e - f)/T with T*f' = e - f, and e may jump; f starts "
            "at 0. limits=[lo, hi] limit the output, and with period= it is sampled.",
    .example = "scene planar\nbody arm1 mass=1 inertia=0.02\nrevolute h1 ground arm1\n"
               "pd c1 a 0 ref=1 - exp(-5*t) of=h1 Kp=20 Kd=2\nmotor M1 h1 a 0 R=1 Kt=0.2\n"
               "init h1 = 0, h1' = 0\nsimulate 5\nprint h1, c1.v",
    .see = "pid sensor gain motor",
};

const Component component_pid = {
    .name = "pid",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "proportional, integral and derivative control",
    .params = pid_params,
    .param_count = COUNT(pid_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = pid_relation,
    .own_state_count = pid_states,
    .own_state = pid_state,
    .members = pid_members,
    .member_count = COUNT(pid_members),
    .check = pid_check,
    .help = "A voltage source of Kp*e + Ki*I + Kd*e', where e = ref - of and I' = e. The rate "
            "is that of pd; with filter= e may jump. limits=[lo, hi] limit the output y, "
            "without integral windup: I' = e + (y - u)/Kp, where u is the output before the "
            "limits, so that the integral returns with the time constant Kp/Ki. With period= it "
            "is sampled: I grows by period*I' at each instant.",
    .example = "scene planar\ngravity [0, -9.81]\nbody arm1 mass=1 inertia=0.02\n"
               "arm p arm1 [-0.2, 0]\nrevolute h1 ground p\n"
               "pid c1 a 0 ref=step(t) of=h1 Kp=40 Ki=60 Kd=8 filter=0.01 limits=[-24, 24]\n"
               "motor M1 h1 a 0 R=1 Kt=0.2\ninit h1 = 0, h1' = 0\nsimulate 5\nprint h1, c1.v",
    .see = "pd integrator motor",
};

/* --- transfer function --- */

static int order_of(const Instance *instance)
{
    return instance_value(instance, "den")->count - 1;
}

static Expr canonical(const Instance *instance, Arena *arena, int i)
{
    char member[16];

    (void)snprintf(member, sizeof member, "x%d", i + 1);
    return block_state(instance, arena, member);
}

/* symbols of all states */
static Expr *canonicals(const Instance *instance, Arena *arena)
{
    Expr *x = NEW_ARRAY(Expr, order_of(instance));

    for (int i = 0; i < order_of(instance); i++)
        x[i] = canonical(instance, arena, i);
    return x;
}

/* coefficient of x[i] in -xn', divided by the leading one */
static Expr denominator(const Instance *instance, Arena *arena, int i)
{
    const Value *den = instance_value(instance, "den");

    return expr_div(arena, den->at[den->count - 1 - i], den->at[0]);
}

/* of s^i, divided by the leading coefficient of the denominator; 0 where the list is shorter */
static Expr numerator(const Instance *instance, Arena *arena, int i)
{
    const Value *num = instance_value(instance, "num");
    Expr leading = instance_value(instance, "den")->at[0];

    return i < num->count ? expr_div(arena, num->at[num->count - 1 - i], leading)
                          : expr_int(arena, 0);
}

static Expr transfer_command(const Instance *instance, Arena *arena)
{
    int n = order_of(instance);
    Expr direct = numerator(instance, arena, n);
    Expr *terms = NEW_ARRAY(Expr, n + 1);
    Expr sum;

    for (int i = 0; i < n; i++) {
        Expr c = expr_sub(arena, numerator(instance, arena, i),
                          expr_mul(arena, denominator(instance, arena, i), direct));

        terms[i] = expr_mul(arena, c, canonical(instance, arena, i));
    }
    terms[n] = expr_mul(arena, direct, instance_scalar(instance, "of"));
    sum = expr_sum(arena, terms, n + 1);
    mem_free(terms);
    return sum;
}

static void transfer_relation(const Instance *instance, Arena *arena, int which,
                              const Motion1 *motion, Relation *out)
{
    (void)which;
    (void)motion;
    block_relation(instance, arena, transfer_command(instance, arena), out);
}

static int transfer_states(const Instance *instance)
{
    return block_state_count(instance, order_of(instance));
}

static Expr last_rate(const Instance *instance, Arena *arena, const Expr x[])
{
    Expr rate = instance_scalar(instance, "of");

    for (int i = 0; i < order_of(instance); i++)
        rate = expr_sub(arena, rate, expr_mul(arena, denominator(instance, arena, i), x[i]));
    return rate;
}

/* State k one sampling instant later, by the trapezoidal rule with a constant input. Each x+[i] is
 * slope[i] X + value[i] with X = x+[n-1], which the last row then determines. */
static Expr trapezoidal(const Instance *instance, Arena *arena, int k)
{
    int n = order_of(instance);
    Expr half = expr_mul(arena, expr_rational(arena, 1, 2), instance_scalar(instance, "period"));
    Expr *x = canonicals(instance, arena), *slope = NEW_ARRAY(Expr, n), *value = NEW_ARRAY(Expr, n);
    Expr factor = expr_int(arena, 1);
    Expr right;
    Expr next;

    slope[n - 1] = expr_int(arena, 1);
    value[n - 1] = expr_int(arena, 0);
    for (int i = n - 2; i >= 0; i--) {
        slope[i] = expr_mul(arena, half, slope[i + 1]);
        value[i] =
            expr_add(arena, x[i], expr_mul(arena, half, expr_add(arena, x[i + 1], value[i + 1])));
    }
    right = expr_add(arena, last_rate(instance, arena, x), last_rate(instance, arena, value));
    right = expr_add(arena, x[n - 1], expr_mul(arena, half, right));
    for (int i = 0; i < n; i++)
        factor = expr_add(
            arena, factor,
            expr_product(arena, (Expr[]){half, denominator(instance, arena, i), slope[i]}, 3));
    next = expr_add(arena, value[k], expr_mul(arena, slope[k], expr_div(arena, right, factor)));
    MEM_FREE(x, slope, value);
    return next;
}

static void transfer_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    int n = order_of(instance);
    Expr *x;

    if (k == n) {
        block_held(instance, arena, transfer_command(instance, arena), out);
        return;
    }
    x = canonicals(instance, arena);
    *out = (OwnState){.member = expr_name(x[k]) + strlen(instance->name) + 1,
                      .initial = expr_int(arena, 0),
                      .rate = k < n - 1 ? x[k + 1] : last_rate(instance, arena, x),
                      .next = trapezoidal(instance, arena, k)};
    mem_free(x);
    block_choose(instance, arena, out);
}

static Status transfer_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    const Value *num = instance_value(instance, "num");
    const Value *den = instance_value(instance, "den");

    (void)arena;
    (void)planar;
    if (expr_is_zero(den->at[0])) {
        (void)diag_set(diag, E_VALUE, "the first coefficient of den= of %s is zero",
                       instance->name);
        diag_hint(diag, "the highest power comes first: [1, 2, 5] is s^2 + 2*s + 5");
        diag_about(diag, "den");
        return E_VALUE;
    }
    if (num->count > den->count) {
        (void)diag_set(diag, E_VALUE,
                       "%s is improper: num= has more coefficients than den=", instance->name);
        diag_hint(diag, "it would differentiate its input; add a fast pole to the denominator");
        diag_about(diag, "num");
        return E_VALUE;
    }
    return block_check(instance, diag);
}

const Component component_transfer = {
    .name = "transfer",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "control: a transfer function",
    .params = transfer_params,
    .param_count = COUNT(transfer_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = transfer_relation,
    .own_state_count = transfer_states,
    .state_stem = "x",
    .own_state = transfer_state,
    .members = transfer_members,
    .member_count = COUNT(transfer_members),
    .check = transfer_check,
    .help = "A voltage source with the transfer function num(s)/den(s). The coefficients are "
            "numbers or parameters, the highest power first: num=[2, 3] den=[1, 3, 2] is (2*s + "
            "3)/(s^2 + 3*s + 2). It has a state for each power of the denominator, c1.x1 and "
            "its derivatives x2 and so on (controllable canonical form), and starts at rest. A "
            "numerator of higher degree is refused. limits=[lo, hi] limit the output, and with "
            "period= it is sampled, by the trapezoidal rule.",
    .example = "vsource V1 a 0 1\ntransfer c1 b 0 of=a.v num=[2, 3] den=[1, 3, 2]\nsimulate 2\n"
               "print c1.v, 1.5 - exp(-2) - exp(-4)/2",
    .see = "lag integrator bode linearize",
};
