/* family_native.c: native code against the interpreter, and its functions against wider numbers
 *
 * Random expressions over all functions, their numbers from tiny to huge, infinite or none, are
 * made native for each instruction set that the processor has, for one and more evaluations at
 * once, with few registers and with all. Strict code has the interpreter's bits, stage by stage;
 * fused code those of C's fma() where a product and a sum are one; eight that are interpreted at
 * once have the bits of one. Sine, cosine, exponential and logarithm are held against those of long
 * double. */
#include "family.h"

#include "algebra/elementary.h"
#include "compile/native.h"
#include "compile/program_impl.h"

enum { INPUTS = 12, MOST_NODES = 400, MOST_ROOTS = 40 };

static const SymbolKind kinds[INPUTS] = {SYMBOL_PARAMETER,  SYMBOL_PARAMETER,    SYMBOL_TIME,
                                         SYMBOL_COORDINATE, SYMBOL_COORDINATE,   SYMBOL_COORDINATE,
                                         SYMBOL_SPEED,      SYMBOL_SPEED,        SYMBOL_STATE,
                                         SYMBOL_ALGEBRAIC,  SYMBOL_ACCELERATION, SYMBOL_MULTIPLIER};

/* --- random programs --- */

typedef struct Sample {
    Arena *arena;
    Program *program;
    Workspace *workspace; /* the interpreter's */
} Sample;

static Expr pick(Member *member, const Expr *nodes, int count)
{
    /* rather recent ones, so that it gets deep */
    const int back = member_one_of(member, member_one_of(member, 2) == 0 ? 12 : count);

    return nodes[back < count ? count - 1 - back : 0];
}

static Expr make_node(Member *member, Arena *arena, const Expr *nodes, int count)
{
    const int what = member_one_of(member, 20);
    Expr args[4];

    for (int i = 0; i < 4; i++)
        args[i] = pick(member, nodes, count);
    if (what < 5)
        return expr_sum(arena, args, 2 + member_one_of(member, 3));
    if (what < 10)
        return expr_product(arena, args, 2 + member_one_of(member, 3));
    if (what < 12)
        return expr_sub(arena, args[0], expr_mul(arena, args[1], args[2]));
    if (what == 12)
        return expr_pow(arena, args[0], expr_int(arena, member_one_of(member, 7) - 3));
    if (what == 13)
        return expr_sqrt(arena, expr_call1(arena, OP_ABS, args[0]));
    if (what == 14)
        return expr_neg(arena, args[0]);
    if (what == 15)
        return expr_real(arena, member_between(member, -3, 3));
    if (what == 16)
        return expr_pow(arena, expr_call1(arena, OP_ABS, args[0]),
                        expr_real(arena, member_between(member, -2, 2)));
    const Op op = (Op)member_one_of(member, OP_COUNT);

    return expr_call(arena, op == OP_TABLE ? OP_SIN : op, args);
}

static void make(Member *member, Sample *out)
{
    const int count = INPUTS + 5 + member_one_of(member, MOST_NODES - INPUTS - 5);
    const int root_count = 1 + member_one_of(member, MOST_ROOTS);
    Expr nodes[MOST_NODES], roots[MOST_ROOTS];

    out->arena = arena_new();
    for (int i = 0; i < INPUTS; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "s%d", i);
        nodes[i] = expr_symbol(out->arena, name, kinds[i]);
    }
    for (int i = INPUTS; i < count; i++) {
        nodes[i] = make_node(member, out->arena, nodes, i);
        if (arena_status(out->arena) != OK) { /* 1/0, perhaps */
            arena_reset(out->arena);
            nodes[i] = nodes[i - 1];
        }
    }
    for (int i = 0; i < root_count; i++)
        roots[i] = pick(member, nodes, count);
    if (program_new(roots, root_count, nodes, INPUTS, &out->program, NULL) != OK)
        abort();
    out->workspace = workspace_new(out->program);
}

static void sample_free(Sample *made)
{
    workspace_free(made->workspace);
    program_free(made->program);
    arena_free(made->arena);
}

static double any_number(Member *member)
{
    static const double odd[] = {0, -0.0, 1, -1, 5e-324, 1e308, -1e-308, INFINITY, -INFINITY, NAN};

    switch (member_one_of(member, 8)) {
    case 0:
        return odd[member_one_of(member, COUNT(odd))];
    case 1:
        return ldexp(member_between(member, -1, 1), member_one_of(member, 2000) - 1000);
    default:
        return member_between(member, -3, 3);
    }
}

static NativeTarget any_target(Member *member)
{
    static const int registers[] = {16, 16, 32}, widths[] = {2, 3, 4};
    Isa isa;
    NativeTarget target = {0};

    do
        isa = (Isa)member_one_of(member, 3);
    while (!native_has(isa));
    target.isa = isa;
    target.width = 1 << member_one_of(member, widths[isa]);
    target.registers =
        member_one_of(member, 2) == 0
            ? registers[isa]
            : FEWEST_REGISTERS + member_one_of(member, registers[isa] - FEWEST_REGISTERS + 1);
    target.fused = isa != ISA_SSE2 && member_one_of(member, 2) == 0;
    return target;
}

static uint64_t bits(double x)
{
    uint64_t out;

    memcpy(&out, &x, sizeof out);
    return out;
}

static bool is_same(double a, double b)
{
    return (isnan(a) && isnan(b)) || bits(a) == bits(b);
}

/* --- the same bits --- */

/* one run as fma() has it */
static void run_fused(const OpcodeRun *run, const uint32_t *operand, double *slots)
{
    for (int i = 0; i < run->count; i++, operand += 3) {
        const double a = slots[operand[0]], b = slots[operand[1]], c = slots[operand[2]];

        slots[run->result + i] = run->code == CODE_MULADD   ? fma(a, b, c)
                                 : run->code == CODE_MULSUB ? fma(a, b, -c)
                                                            : fma(-a, b, c);
    }
}

/* one by one, as some may need others */
static void run_fused_sines(const OpcodeRun *run, const uint32_t *operand, double *slots)
{
    double *result = slots + run->result;

    for (int i = 0; i < run->count; i++) {
        double sine, cosine;

        elementary_sincos_fused_all(&slots[operand[i]], &sine, &cosine, 1);
        if (run->code == CODE_SINCOS) {
            *result++ = sine;
            *result++ = cosine;
        } else {
            *result++ = run->code == CODE_SIN ? sine : cosine;
        }
    }
}

/* what native code is to give: slots, then roots */
static void expected(const Program *program, bool fused, double *slots)
{
    Program one = *program; /* of a single run */

    memset(one.first_run, 0, sizeof one.first_run);
    one.first_run[1] = 1;
    for (int r = 0; r < program->runs.count; r++) {
        const OpcodeRun *run = &program->runs.at[r];

        one.runs.at = &program->runs.at[r];
        if (fused &&
            (run->code == CODE_MULADD || run->code == CODE_MULSUB || run->code == CODE_SUBMUL))
            run_fused(run, program->tape.at + run->operands, slots);
        else if (fused &&
                 (run->code == CODE_SINCOS || run->code == CODE_SIN || run->code == CODE_COS))
            run_fused_sines(run, program->tape.at + run->operands, slots);
        else
            program_interpret(&one, STAGE_PARAMETER, STAGE_PARAMETER, slots);
    }
    program_hand_over(program, STAGE_PARAMETER, STAGE_ACCELERATION, slots,
                      slots + program->slot_count);
}

typedef struct SimdBatch {
    const Program *program;
    NativeTarget target;
    Native *native;
    NativeFrame *frame;
    double *slots; /* of all lanes, side by side */
    double *other; /* of one, and its roots */
    double inputs[WIDEST][INPUTS];
} SimdBatch;

static double *lane(const SimdBatch *l, int slot, int number)
{
    return &l->slots[slot * l->target.width + number];
}

/* other numbers for the inputs from a stage on */
static void draw_inputs(Member *member, SimdBatch *l, Stage from)
{
    for (int k = 0; k < l->target.width; k++)
        for (int i = 0; i < INPUTS; i++) {
            if (stage_of_symbol(kinds[i]) >= from)
                l->inputs[k][i] = any_number(member);
            *lane(l, i, k) = l->inputs[k][i];
        }
}

static bool simd_batch_agree(Member *member, const SimdBatch *l, const char *what)
{
    for (int k = 0; k < l->target.width; k++) {
        memcpy(l->other, l->inputs[k], sizeof l->inputs[k]);
        expected(l->program, l->target.fused, l->other);
        for (int i = 0; i < l->program->root_count; i++) {
            const double own = *lane(l, l->program->slot_count + i, k),
                         other = l->other[l->program->slot_count + i];

            if (is_same(own, other))
                continue;
            tell(member, "%s: root %d of lane %d is %a, not %a\n", what, i, k, own, other);
            return false;
        }
    }
    return true;
}

static bool stages_agree(Member *member, SimdBatch *l)
{
    bool agrees;

    draw_inputs(member, l, STAGE_PARAMETER);
    native_run(l->native, STAGE_PARAMETER, STAGE_ACCELERATION, l->slots, l->frame);
    agrees = simd_batch_agree(member, l, "all stages");
    for (int stage = 0; stage < STAGE_COUNT && agrees; stage++) {
        draw_inputs(member, l, (Stage)stage);
        native_run(l->native, (Stage)stage, STAGE_ACCELERATION, l->slots, l->frame);
        agrees = simd_batch_agree(member, l, "from a stage on");
    }
    return agrees;
}

/* either goes on where the other has been */
static bool turns_agree(Member *member, SimdBatch *l)
{
    if (l->target.width > 1 || l->target.fused)
        return true;
    draw_inputs(member, l, STAGE_PARAMETER);
    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        if (member_one_of(member, 2) == 0) {
            native_run(l->native, (Stage)stage, (Stage)stage, l->slots, l->frame);
            continue;
        }
        program_interpret(l->program, (Stage)stage, (Stage)stage, l->slots);
        program_hand_over(l->program, (Stage)stage, (Stage)stage, l->slots,
                          l->slots + l->program->slot_count);
    }
    return simd_batch_agree(member, l, "by turns");
}

/* a function of joined stages does what their own do, behind them too */
static bool joined_agrees(Member *member, SimdBatch *l)
{
    NativeTarget target = l->target;
    Native *joined;
    NativeFrame *frame;
    bool agrees;

    target.joined = true;
    joined = native_new(l->program, &target);
    if (joined == NULL)
        return false;
    frame = native_frame_new(joined);
    draw_inputs(member, l, STAGE_PARAMETER);
    native_run(l->native, STAGE_PARAMETER, NATIVE_JOINED - 1, l->slots, l->frame);
    native_run(joined, NATIVE_JOINED, NATIVE_JOINED_END, l->slots, frame);
    native_run(l->native, NATIVE_JOINED_END + 1, STAGE_ACCELERATION, l->slots, l->frame);
    agrees = simd_batch_agree(member, l, "joined");
    native_frame_free(frame);
    native_free(joined);
    return agrees;
}

static Verdict native_code(Member *member)
{
    Sample made;
    SimdBatch l = {.target = any_target(member)};
    Verdict verdict = REFUSED;
    int numbers;

    make(member, &made);
    numbers = made.program->slot_count + made.program->root_count;
    tell(member, "isa %d, width %d, registers %d, fused %d\n", (int)l.target.isa, l.target.width,
         l.target.registers, l.target.fused);
    l.program = made.program;
    l.native = native_new(made.program, &l.target);
    if (l.native != NULL) {
        l.frame = native_frame_new(l.native);
        l.slots = NEW_ARRAY(double, numbers *WIDEST);
        l.other = NEW_ARRAY(double, numbers);
        for (int i = 0; i < made.program->constants.count; i++) {
            l.other[INPUTS + i] = made.program->constants.at[i];
            for (int k = 0; k < l.target.width; k++)
                *lane(&l, INPUTS + i, k) = made.program->constants.at[i];
        }
        verdict = stages_agree(member, &l) && joined_agrees(member, &l) && turns_agree(member, &l)
                      ? AGREES
                      : DISAGREES;
    }
    mem_free(l.slots);
    mem_free(l.other);
    native_frame_free(l.frame);
    native_free(l.native);
    sample_free(&made);
    return verdict;
}

/* --- the interpreter's own lanes --- */

static Verdict abreast(Member *member)
{
    Sample made;
    SimdBatch l = {.target = {.width = ABREAST}};
    bool agrees = true;
    int numbers;

    make(member, &made);
    numbers = made.program->slot_count + made.program->root_count;
    l.program = made.program;
    l.slots = NEW_ARRAY(double, numbers *ABREAST);
    l.other = NEW_ARRAY(double, numbers);
    for (int i = 0; i < made.program->constants.count; i++) {
        l.other[INPUTS + i] = made.program->constants.at[i];
        for (int k = 0; k < ABREAST; k++)
            *lane(&l, INPUTS + i, k) = made.program->constants.at[i];
    }
    for (int stage = 0; stage < STAGE_COUNT && agrees; stage++) {
        draw_inputs(member, &l, (Stage)stage);
        program_interpret_abreast(l.program, (Stage)stage, STAGE_ACCELERATION, l.slots);
        agrees = simd_batch_agree(member, &l, "eight interpreted at once");
    }
    MEM_FREE(l.slots, l.other);
    sample_free(&made);
    return agrees ? AGREES : DISAGREES;
}

/* --- workspaces, which have code made on the way --- */

static Verdict workspaces(Member *member)
{
    const bool is_strict = member_one_of(member, 2) == 0;
    NativeTarget best = {.fused = false};
    Sample made;
    double *other;
    bool agrees = true;

    make(member, &made);
    workspace_choose(made.workspace, is_strict ? EVALUATOR_STRICT : EVALUATOR_NATIVE);
    (void)native_target(1, !is_strict, &best);
    for (int i = 0; i < INPUTS; i++)
        workspace_inputs(made.workspace)[i] = any_number(member);
    other = NEW_ARRAY(double, made.program->slot_count + made.program->root_count);
    memcpy(other, workspace_inputs(made.workspace),
           (size_t)made.program->slot_count * sizeof(double));
    for (int i = 0; i < 5000; i++) /* so often that it is made native */
        workspace_run(made.workspace, STAGE_PARAMETER, STAGE_ACCELERATION);
    expected(made.program, best.fused, other);
    for (int i = 0; i < made.program->root_count && agrees; i++) {
        const double a = workspace_roots(made.workspace)[i],
                     b = other[made.program->slot_count + i];

        agrees = is_same(a, b);
        if (!agrees)
            tell(member, "strict %d: root %d is %a, not %a\n", is_strict, i, a, b);
    }
    mem_free(other);
    sample_free(&made);
    return agrees ? AGREES : DISAGREES;
}

/* --- functions --- */

static double any_angle(Member *member)
{
    switch (member_one_of(member, 6)) {
    case 0:
        return member_between(member, -8, 8);
    case 1:
        return member_between(member, -1e4, 1e4);
    case 2:
        return member_between(member, -4e6, 4e6);
    case 3: /* as near as can be to whole quarters of a turn */
        return rint(member_between(member, -2e6, 2e6)) * 1.5707963267948966;
    case 4:
        return ldexp(member_between(member, -1, 1), member_one_of(member, 1024));
    default:
        return ldexp(member_between(member, -1, 1), -member_one_of(member, 1074));
    }
}

/* of the last place of what is meant */
static double units(double got, long double meant)
{
    const double near = (double)meant;

    if (isinf(near) || isnan(near) || !isfinite(got))
        return is_same(got, near) || (isnan(got) && isnan(near)) ? 0 : INFINITY;
    return (double)(fabsl((long double)got - meant) /
                    (nextafter(fabs(near), INFINITY) - fabs(near)));
}

static bool is_near(Member *member, const char *what, double x, double got, long double meant)
{
    const double off = units(got, meant);

    if (off < 1)
        return true;
    tell(member, "%s of %a is %a, off by %g units\n", what, x, got, off);
    return false;
}

static Verdict functions(Member *member)
{
    bool agrees = true;

    for (int i = 0; i < 1000 && agrees; i++) {
        const double x = any_angle(member), e = member_between(member, -750, 715),
                     l = ldexp(member_between(member, 0, 1), member_one_of(member, 2098) - 1074),
                     near = 1 + ldexp(member_between(member, -1, 1), -member_one_of(member, 52));

        double sine, cosine;

        elementary_sincos_fused_all(&x, &sine, &cosine, 1);
        agrees =
            is_near(member, "fused sine", x, sine, sinl(x)) &&
            is_near(member, "fused cosine", x, cosine, cosl(x)) &&
            is_near(member, "sine", x, elementary_sin(x), sinl(x)) &&
            is_near(member, "cosine", x, elementary_cos(x), cosl(x)) &&
            is_near(member, "exponential", e, elementary_exp(e), expl(e)) &&
            is_near(member, "exponential", 1 - near, elementary_exp(1 - near), expl(1 - near)) &&
            is_near(member, "logarithm", l, elementary_log(l), logl(l)) &&
            is_near(member, "logarithm", near, elementary_log(near), logl(near));
    }
    return agrees ? AGREES : DISAGREES;
}

enum { MANY = 40 };

static Verdict at_once(Member *member)
{
    const int count = 1 + member_one_of(member, MANY);
    double x[MANY], out[6][MANY];
    bool agrees = true;

    for (int i = 0; i < count; i++)
        x[i] = member_one_of(member, 2) == 0 ? any_number(member) : any_angle(member);
    elementary_sincos_all(x, out[0], out[1], count);
    elementary_exp_all(x, out[2], count);
    elementary_log_all(x, out[3], count);
    elementary_sincos_fused_all(x, out[4], out[5], count);
    for (int i = 0; i < count && agrees; i++) {
        double sine, cosine;

        elementary_sincos_fused_all(&x[i], &sine, &cosine, 1);
        agrees =
            is_same(out[0][i], elementary_sin(x[i])) && is_same(out[1][i], elementary_cos(x[i])) &&
            is_same(out[2][i], elementary_exp(x[i])) && is_same(out[3][i], elementary_log(x[i])) &&
            is_same(out[4][i], sine) && is_same(out[5][i], cosine);
        if (!agrees)
            tell(member, "%a, number %d of %d\n", x[i], i, count);
    }
    return agrees ? AGREES : DISAGREES;
}

int main(int argc, char **argv)
{
    /* where there is no native code all of it is refused */
    const double refused = native_has(ISA_SSE2) ? 0 : 1;
    const Family families[] = {
        {"native_code_has_the_interpreters_bits", 400, refused, 0, native_code},
        {"eight_interpreted_at_once_have_the_bits_of_one", 200, 0, 0, abreast},
        {"workspaces_have_these_bits_too", 100, 0, 0, workspaces},
        {"functions_are_right_to_the_last_place", 200, 0, 0, functions},
        {"many_at_once_have_the_bits_of_one", 5000, 0, 0, at_once},
    };

    return family_main(families, COUNT(families), argc, argv);
}
