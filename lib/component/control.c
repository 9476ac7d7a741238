/* control.c: limits and sampling of control blocks; input, gain, sum, integrator, lag
 *
 * With the input e, states x and the period h (s), continuous and from one sampling instant to the
 * next (x+):
 *   integrator   y = x,   x' = k e         x+ = x + h k e, or where a limit lies before that
 *   lag          y = x,   x' = (k e - x)/T   x+ = x + (k e - x)(1 - exp(-h/T)), exact for constant
 * e
 */
#include "component/control.h"

/* --- shared by blocks --- */

bool block_is_sampled(const Instance *instance)
{
    return instance_value(instance, "period")->given;
}

Expr block_state(const Instance *instance, Arena *arena, const char *member)
{
    return instance_variable(instance, arena, member);
}

Expr block_limited(const Instance *instance, Arena *arena, Expr command)
{
    const Value *limits = instance_value(instance, "limits");

    if (!limits->given)
        return command;
    command = expr_call2(arena, OP_MAX, limits->at[0], command);
    return expr_call2(arena, OP_MIN, limits->at[1], command);
}

void block_relation(const Instance *instance, Arena *arena, Expr command, Relation *out)
{
    *out =
        (Relation){.kind = RELATION_ACROSS,
                   .value = block_is_sampled(instance) ? block_state(instance, arena, "held")
                                                       : block_limited(instance, arena, command)};
}

int block_state_count(const Instance *instance, int inner)
{
    return inner + (block_is_sampled(instance) ? 1 : 0);
}

void block_choose(const Instance *instance, Arena *arena, OwnState *out)
{
    if (block_is_sampled(instance)) {
        out->rate = expr_int(arena, 0);
        out->period = instance_scalar(instance, "period");
    } else {
        out->period = NULL;
        out->next = NULL;
    }
}

void block_held(const Instance *instance, Arena *arena, Expr command, OwnState *out)
{
    *out = (OwnState){.member = "held",
                      .initial = expr_int(arena, 0),
                      .rate = expr_int(arena, 0),
                      .period = instance_scalar(instance, "period"),
                      .next = block_limited(instance, arena, command)};
}

Status block_check(const Instance *instance, Diag *diag)
{
    const Value *limits = instance_value(instance, "limits");

    if (limits->given && limits->count != 2) {
        (void)diag_set(diag, E_VALUE, "limits of %s are two numbers", instance->name);
        diag_hint(diag, "the least and the largest output: limits=[-10, 10]");
        diag_about(diag, "limits");
        return E_VALUE;
    }
    if (limits->given && expr_is_number(limits->at[0]) && expr_is_number(limits->at[1]) &&
        expr_value(limits->at[0]) >= expr_value(limits->at[1])) {
        (void)diag_set(diag, E_VALUE, "limits of %s leave nothing between them", instance->name);
        diag_hint(diag, "the least output comes first: limits=[-10, 10]");
        diag_about(diag, "limits");
        return E_VALUE;
    }
    if (block_is_sampled(instance))
        TRY(check_positive(instance, "period", diag));
    return OK;
}

/* clang-format off */
static const Param input_params[] = {
    {"period",  PARAM_SCALAR, "s", NULL, "time between two values", 0},
    {"initial", PARAM_SCALAR, "V", "0", "the value until a program sets one", 0},
};
static const Param gain_params[] = {
    {"of", PARAM_LAW, NULL, NULL, "the input, any expression", 0},
    {"k",  PARAM_LAW, NULL, NULL, "the factor", 0},
    BLOCK_PARAMS,
};
static const Param sum_params[] = {
    {"of", PARAM_LIST_LAWS, NULL, NULL, "the summands: [a.v, -b.v]", 0},
    BLOCK_PARAMS,
};
static const Param integrator_params[] = {
    {"of",      PARAM_LAW,    NULL, NULL, "the input, any expression", 0},
    {"k",       PARAM_LAW,    NULL, "1",  "output's rate per input", 0},
    {"initial", PARAM_SCALAR, "V",  "0",  "the output at the start", 0},
    BLOCK_PARAMS,
};
static const Param lag_params[] = {
    {"of",      PARAM_LAW,    NULL, NULL, "the input, any expression", 0},
    {"k",       PARAM_LAW,    NULL, "1",  "output per input at rest", 0},
    {"T",       PARAM_SCALAR, "s",  NULL, "time constant", 0},
    {"initial", PARAM_SCALAR, "V",  "0",  "the output at the start", 0},
    BLOCK_PARAMS,
};

static const Member input_members[] = {
    {"held", "V", "the value that was set last", 1},
};
static const Member plain_members[] = {
    BLOCK_MEMBERS,
};
static const Member state_members[] = {
    {"x", "V", "the state: the output before the limits", 1},
    BLOCK_MEMBERS,
};
/* clang-format on */

static Status plain_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return block_check(instance, diag);
}

static int no_states(const Instance *instance)
{
    return block_state_count(instance, 0);
}

static int one_state(const Instance *instance)
{
    return block_state_count(instance, 1);
}

/* the sum of the inputs, times k where the row has one */
static Expr amplified(const Instance *instance, Arena *arena)
{
    const Value *of = instance_value(instance, "of");
    Expr sum = expr_sum(arena, of->at, of->count);

    if (component_param(instance->row, "k") < 0)
        return sum;
    return expr_mul(arena, instance_scalar(instance, "k"), sum);
}

/* --- input --- */

static int input_states(const Instance *instance)
{
    (void)instance;
    return 1;
}

static void input_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_ACROSS, .value = block_state(instance, arena, "held")};
}

static void input_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    (void)k;
    *out = (OwnState){.member = "held",
                      .initial = instance_scalar(instance, "initial"),
                      .rate = expr_int(arena, 0),
                      .period = instance_scalar(instance, "period"),
                      .next = block_state(instance, arena, "held"),
                      .is_input = true};
}

const Component component_input = {
    .name = "input",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "control: a voltage that a program sets",
    .params = input_params,
    .param_count = COUNT(input_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = input_relation,
    .own_state_count = input_states,
    .own_state = input_state,
    .members = input_members,
    .member_count = COUNT(input_members),
    .positive = "period",
    .help = "A voltage source whose value is set by a program that runs the model with the "
            "library (ct_simulate). The program is asked for a value at multiples of the "
            "period; the value is held until the next multiple. This serves to test a "
            "controller or an interface to other hardware. In the shell the source keeps its "
            "initial value. In an FMU it is an input, which the importer may set at any time.",
    .example = "input U1 a 0 period=10 ms initial=2\nresistor R1 a 0 1 kohm\nsimulate 1\n"
               "print R1.i",
    .see = "gain pid vsource",
};

/* --- gain and sum --- */

static void plain_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    (void)which;
    (void)motion;
    block_relation(instance, arena, amplified(instance, arena), out);
}

static void plain_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    (void)k;
    block_held(instance, arena, amplified(instance, arena), out);
}

const Component component_gain = {
    .name = "gain",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "control: a multiple",
    .params = gain_params,
    .param_count = COUNT(gain_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = plain_relation,
    .own_state_count = no_states,
    .own_state = plain_state,
    .members = plain_members,
    .member_count = COUNT(plain_members),
    .check = plain_check,
    .help = "A voltage source of k times its input, which may be any expression: gain c1 out 0 "
            "of=ref.v - h8 k=5. With limits=[lo, hi] it saturates, with period= it is sampled.",
    .example = "vsource V1 a 0 sin(10*t)\ngain c1 b 0 of=a.v k=5 limits=[-2, 2]\n"
               "resistor R1 b 0 1 kohm\nsimulate 1\nprint max(c1.v), min(c1.v)",
    .see = "sum lag pid vcvs",
};

const Component component_sum = {
    .name = "sum",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "control: a sum",
    .params = sum_params,
    .param_count = COUNT(sum_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = plain_relation,
    .own_state_count = no_states,
    .own_state = plain_state,
    .members = plain_members,
    .member_count = COUNT(plain_members),
    .check = plain_check,
    .help = "A voltage source of the sum of its inputs: sum c1 out 0 of=[ref.v, -h8]. With "
            "limits=[lo, hi] it saturates, with period= it is sampled.",
    .example = "vsource V1 a 0 sin(10*t)\nvsource V2 b 0 0.5\nsum c1 c 0 of=[a.v, -2*b.v]\n"
               "simulate 1\nprint max(c1.v), min(c1.v)",
    .see = "gain integrator pid",
};

/* --- integrator --- */

/* the input, or 0 where the output is at a limit */
static Expr integrand(const Instance *instance, Arena *arena)
{
    Expr x = block_state(instance, arena, "x");
    Expr e = amplified(instance, arena);
    Expr zero = expr_int(arena, 0);
    const Value *limits = instance_value(instance, "limits");
    Expr full;
    Expr empty;

    if (!limits->given)
        return e;
    full = expr_call2(arena, OP_AND, expr_call2(arena, OP_LE, limits->at[1], x),
                      expr_call2(arena, OP_LT, zero, e));
    empty = expr_call2(arena, OP_AND, expr_call2(arena, OP_LE, x, limits->at[0]),
                       expr_call2(arena, OP_LT, e, zero));
    return expr_if(arena, full, zero, expr_if(arena, empty, zero, e));
}

static void integrator_relation(const Instance *instance, Arena *arena, int which,
                                const Motion1 *motion, Relation *out)
{
    (void)which;
    (void)motion;
    block_relation(instance, arena, block_state(instance, arena, "x"), out);
}

static void integrator_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    Expr x = block_state(instance, arena, "x");
    Expr step;

    if (k == 1) {
        block_held(instance, arena, x, out);
        return;
    }
    step = expr_mul(arena, instance_scalar(instance, "period"), amplified(instance, arena));
    *out = (OwnState){.member = "x",
                      .initial = instance_scalar(instance, "initial"),
                      .rate = integrand(instance, arena),
                      .next = block_limited(instance, arena, expr_add(arena, x, step))};
    block_choose(instance, arena, out);
}

const Component component_integrator = {
    .name = "integrator",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "control: an integral",
    .params = integrator_params,
    .param_count = COUNT(integrator_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = integrator_relation,
    .own_state_count = one_state,
    .own_state = integrator_state,
    .members = state_members,
    .member_count = COUNT(state_members),
    .check = plain_check,
    .help = "A voltage source whose rate is k times its input; initial= is its first value. "
            "With limits=[lo, hi] it stops at a limit until its input changes sign. With "
            "period= it is sampled: it grows by period*k times the input at each instant.",
    .example = "vsource V1 a 0 cos(10*t)\nintegrator c1 b 0 of=a.v k=10\n"
               "simulate 1\nprint c1.v, sin(10)",
    .see = "lag gain pid",
};

/* --- lag --- */

static void lag_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    Expr x = block_state(instance, arena, "x");
    Expr T = instance_scalar(instance, "T");
    Expr left = expr_sub(arena, amplified(instance, arena), x);
    Expr decay;

    if (k == 1) {
        block_held(instance, arena, x, out);
        return;
    }
    decay = expr_call1(arena, OP_EXP,
                       expr_neg(arena, expr_div(arena, instance_scalar(instance, "period"), T)));
    *out = (OwnState){
        .member = "x",
        .initial = instance_scalar(instance, "initial"),
        .rate = expr_div(arena, left, T),
        .next =
            expr_add(arena, x, expr_mul(arena, left, expr_sub(arena, expr_int(arena, 1), decay)))};
    block_choose(instance, arena, out);
}

const Component component_lag = {
    .name = "lag",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "control: a first-order lag",
    .params = lag_params,
    .param_count = COUNT(lag_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = integrator_relation,
    .own_state_count = one_state,
    .own_state = lag_state,
    .members = state_members,
    .member_count = COUNT(state_members),
    .positive = "T",
    .check = plain_check,
    .help = "A first-order lag: a voltage source with T*x' + x = k*of. initial= is its first "
            "value, limits=[lo, hi] limit its output, and with period= it is sampled.",
    .example = "vsource V1 a 0 1\nlag c1 b 0 of=a.v k=3 T=0.1\nsimulate 0.1\n"
               "print c1.v, 3*(1 - exp(-1))",
    .see = "integrator transfer gain",
};
