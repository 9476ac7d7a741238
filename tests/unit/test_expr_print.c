/* test_expr_print.c: every kind of node in every notation */
#include "test_expr.h"

static void expect_in(Notation notation, Expr e, const char *wanted)
{
    Text text = {0};
    char *got;

    expr_print(&text, e, notation);
    got = text_done(&text);
    EXPECT_TEXT(got, wanted);
    mem_free(got);
}

static void numbers_print_as_briefly_as_is_exact(void)
{
    Arena *arena = arena_new();

    EXPECT_EXPR(expr_rational(arena, 1, 4), "0.25");
    EXPECT_EXPR(expr_rational(arena, -981, 100), "-9.81");
    EXPECT_EXPR(expr_rational(arena, 1, 3), "1/3");
    EXPECT_EXPR(expr_rational(arena, -2, 3), "-2/3");
    EXPECT_EXPR(expr_rational(arena, 1097, 500000000), "2.194e-6");
    EXPECT_EXPR(expr_rational(arena, 1, 100), "0.01");
    EXPECT_EXPR(expr_rational(arena, 1, 1024), "1/1024");
    EXPECT_EXPR(expr_rational(arena, 123456789, 1000), "123456.789");
    EXPECT_EXPR(expr_int(arena, INT64_MAX), "9223372036854775807");
    EXPECT_EXPR(expr_real(arena, 1e-30), "1e-30");
    EXPECT_EXPR(expr_real(arena, 3.141592653589793), "3.141592653589793");
    arena_free(arena);
}

/* what is printed reads back as the same number */
static void numbers_read_back(void)
{
    Arena *arena = arena_new();
    uint64_t random = 5;

    for (int i = 0; i < 4000; i++) {
        double value =
            ldexp(test_uniform(&random, 0.5, 1), (int)(test_random(&random) % 200) - 100);
        Expr e = i % 3 == 0 ? expr_real(arena, value)
                 : i % 3 == 1
                     ? expr_real(arena, floor(value * 1e6) / 1e6 + 0.1)
                     : expr_rational(arena, (int64_t)(test_random(&random) >> (2 + i % 60)),
                                     1 + (int64_t)(test_random(&random) >> (2 + i % 59)));
        char *text = expr_text(e);
        char *slash = strchr(text, '/');
        Expr back;

        if (slash != NULL) {
            *slash = '\0';
            back = expr_div(arena, expr_decimal(arena, text), expr_decimal(arena, slash + 1));
        } else
            back = expr_decimal(arena, text);
        EXPECT(back == e);
        mem_free(text);
    }
    arena_free(arena);
}

static void brackets_stand_only_where_needed(void)
{
    World w = world_new(1);
    Arena *A = w.arena;
    Expr a = w.symbols[0];
    Expr b = w.symbols[1];
    Expr x = w.symbols[3];
    Expr y = w.symbols[4];
    Expr two = expr_int(A, 2);
    Expr less = expr_call2(A, OP_LT, a, b);

    EXPECT_EXPR(expr_sub(A, a, expr_mul(A, two, b)), "a - 2*b");
    EXPECT_EXPR(expr_sub(A, b, a), "b - a");
    EXPECT_EXPR(expr_sub(A, expr_neg(A, b), a), "-a - b");
    EXPECT_EXPR(expr_sub(A, two, a), "2 - a");
    EXPECT_EXPR(expr_mul(A, expr_add(A, a, b), x), "x*(a + b)");
    EXPECT_EXPR(expr_div(A, a, expr_mul(A, b, x)), "a/(b*x)");
    EXPECT_EXPR(expr_div(A, expr_int(A, 1), x), "1/x");
    EXPECT_EXPR(expr_neg(A, expr_div(A, expr_int(A, 1), x)), "-1/x");
    EXPECT_EXPR(expr_div(A, expr_mul(A, two, a), expr_int(A, 3)), "2*a/3");
    EXPECT_EXPR(expr_div(A, a, expr_mul(A, expr_int(A, 3), x)), "a/(3*x)");
    EXPECT_EXPR(expr_pow(A, expr_add(A, a, b), two), "(a + b)^2");
    EXPECT_EXPR(expr_pow(A, expr_pow(A, a, b), x), "(a^b)^x");
    EXPECT_EXPR(expr_pow(A, a, expr_neg(A, b)), "a^(-b)");
    EXPECT_EXPR(expr_pow(A, a, expr_rational(A, 1, 3)), "a^(1/3)");
    EXPECT_EXPR(expr_pow(A, a, expr_rational(A, -2, 3)), "1/a^(2/3)");
    EXPECT_EXPR(expr_mul(A, a, less), "a*(a < b)");
    EXPECT_EXPR(expr_if(A, less, a, expr_neg(A, b)), "if(a < b, a, -b)");
    EXPECT_EXPR(expr_call2(A, OP_OR, expr_call2(A, OP_AND, less, x), y), "a < b && x || y");
    EXPECT_EXPR(expr_call2(A, OP_AND, expr_call2(A, OP_OR, less, x), y), "(a < b || x) && y");
    EXPECT_EXPR(expr_call1(A, OP_NOT, less), "!(a < b)");
    EXPECT_EXPR(expr_call1(A, OP_NOT, a), "!a");
    EXPECT_EXPR(expr_call2(A, OP_LE, expr_call2(A, OP_LT, a, b), x), "(a < b) <= x");
    EXPECT_EXPR(expr_call2(A, OP_ATAN2, a, b), "atan2(a, b)");
    EXPECT_EXPR(expr_add(A, x, expr_name_temporary(A, expr_add(A, a, b))), "x + a + b");
    EXPECT_EXPR(expr_sub(A, x, expr_name_temporary(A, expr_add(A, a, b))), "x - (a + b)");
    arena_free(A);
}

static void constraints_read_as_in_books(void)
{
    Arena *A = arena_new();
    Expr L4 = expr_symbol(A, "L4", SYMBOL_PARAMETER);
    Expr L5 = expr_symbol(A, "L5", SYMBOL_PARAMETER);
    Expr L6 = expr_symbol(A, "L6", SYMBOL_PARAMETER);
    Expr L7 = expr_symbol(A, "L7", SYMBOL_PARAMETER);
    Expr h8 = expr_symbol(A, "h8", SYMBOL_COORDINATE);
    Expr h10 = expr_symbol(A, "h10", SYMBOL_COORDINATE);
    Expr s11 = expr_symbol(A, "s11", SYMBOL_COORDINATE);
    Expr terms[3] = {expr_mul(A, expr_add(A, L6, L7), expr_cos(A, h10)), s11,
                     expr_neg(A, expr_mul(A, expr_add(A, L4, L5), expr_cos(A, h8)))};

    EXPECT_EXPR(expr_sum(A, terms, 3), "s11 - (L4 + L5)*cos(h8) + (L6 + L7)*cos(h10)");
    arena_free(A);
}

/* one expression that has every kind of node */
static Expr showpiece(Arena *A)
{
    Expr beta = expr_symbol(A, "beta8", SYMBOL_COORDINATE);
    Expr rate = expr_symbol(A, "beta8'", SYMBOL_SPEED);
    Expr m = expr_symbol(A, "m", SYMBOL_PARAMETER);
    Expr Kt = expr_symbol(A, "M7.Kt", SYMBOL_PARAMETER);
    Expr square = expr_product(A, (Expr[]){expr_rational(A, 1, 3), m, expr_square(A, rate)}, 3);
    Expr divided = expr_div(A, expr_square(A, expr_sin(A, beta)), expr_add(A, m, Kt));

    return expr_sum(A, (Expr[]){square, divided, expr_rational(A, -1, 4)}, 3);
}

static void every_notation_prints_every_kind(void)
{
    Arena *A = arena_new();
    Expr e = showpiece(A);

    expect_in(NOTATION_TEXT, e, "m*beta8'^2/3 + sin(beta8)^2/(m + M7.Kt) - 0.25");
    expect_in(NOTATION_UNICODE, e, "m·β8'²/3 + sin(β8)²/(m + M7.Kt) - 0.25");
    expect_in(NOTATION_LATEX, e,
              "\\frac{m\\,\\dot{\\beta}_{8}^{2}}{3} + \\frac{\\sin^{2}\\left(\\beta_{8}\\right)}"
              "{m + M_{7}.\\mathrm{Kt}} - \\frac{1}{4}");
    expect_in(NOTATION_C, e,
              "1.0/3.0*m*(beta8_d*beta8_d) + pow(sin(beta8), 2.0)/(m + M7_Kt) - 0.25");
    expect_in(NOTATION_MATLAB, e, "1/3*m*beta8_d^2 + sin(beta8)^2/(m + M7_Kt) - 0.25");
    expect_in(NOTATION_PYTHON, e, "1/3*m*beta8_d**2 + math.sin(beta8)**2/(m + M7_Kt) - 0.25");
    expect_in(NOTATION_FORTRAN, e, "1.0d0/3.0d0*m*beta8_d**2 + sin(beta8)**2/(m + M7_Kt) - 0.25d0");
    arena_free(A);
}

static void multiples_of_pi_keep_its_name(void)
{
    static const struct {
        int num, den, power;
        const char *text, *unicode, *latex, *python, *c;
    } rows[] = {
        {1, 1, 1, "pi", "π", "\\pi", "math.pi", "3.141592653589793"},
        {-1, 2, 1, "-pi/2", "-π/2", "-\\frac{\\pi}{2}", "-math.pi/2", "-1.5707963267948966"},
        {100, 1, 1, "100*pi", "100·π", "100\\,\\pi", "100*math.pi", "314.1592653589793"},
        {3, 4, 1, "3*pi/4", "3·π/4", "\\frac{3\\,\\pi}{4}", "3*math.pi/4", "2.356194490192345"},
        {2, 3, -1, "2/(3*pi)", "2/(3·π)", "\\frac{2}{3\\,\\pi}", "2/(3*math.pi)",
         "0.2122065907891938"},
        {1, 10, 1, "0.1*pi", "0.1·π", "0.1\\,\\pi", "0.1*math.pi", "0.3141592653589793"},
        {7, 180, 1, "7*pi/180", "7·π/180", "\\frac{7\\,\\pi}{180}", "7/180*math.pi",
         "0.12217304763960307"},
        {4, 1, 2, "4*pi^2", "4·π²", "4\\,\\pi^{2}", "4*math.pi**2", "39.47841760435743"},
    };
    World w = world_new(1);

    for (int i = 0; i < COUNT(rows); i++) {
        Expr e = expr_mul(w.arena, expr_rational(w.arena, rows[i].num, rows[i].den),
                          expr_pi(w.arena, rows[i].power));

        expect_in(NOTATION_TEXT, e, rows[i].text);
        expect_in(NOTATION_UNICODE, e, rows[i].unicode);
        expect_in(NOTATION_LATEX, e, rows[i].latex);
        expect_in(NOTATION_PYTHON, e, rows[i].python);
        expect_in(NOTATION_C, e, rows[i].c);
    }
    EXPECT_EXPR(expr_mul(w.arena, expr_mul(w.arena, expr_int(w.arena, 2), expr_pi(w.arena, 1)),
                         w.symbols[3]),
                "2*pi*x");
    EXPECT_EXPR(expr_pow(w.arena, w.symbols[3], expr_neg(w.arena, expr_pi(w.arena, 1))), "1/x^pi");
    EXPECT_EXPR(expr_pow(w.arena, w.symbols[3],
                         expr_mul(w.arena, expr_int(w.arena, 2), expr_pi(w.arena, 1))),
                "x^(2*pi)");
    arena_free(w.arena);
}

static void tree_shows_sharing(void)
{
    World w = world_new(1);
    Expr sum = expr_add(w.arena, w.symbols[0], w.symbols[3]);

    expect_in(NOTATION_TREE, expr_mul(w.arena, sum, expr_sin(w.arena, sum)),
              "product #1\n  sum #2\n    a\n    x\n  sin #3\n    sum #2 above\n");
    arena_free(w.arena);
}

static void latex_sets_names(void)
{
    Arena *A = arena_new();
    Expr e = expr_symbol(A, "m_rod", SYMBOL_PARAMETER);

    expect_in(NOTATION_LATEX, e, "m_{\\mathrm{rod}}");
    expect_in(NOTATION_LATEX, expr_symbol(A, "Kt", SYMBOL_PARAMETER), "\\mathrm{Kt}");
    expect_in(NOTATION_LATEX, expr_symbol(A, "q''", SYMBOL_ACCELERATION), "\\ddot{q}");
    expect_in(NOTATION_LATEX, expr_real(A, 1.5e-30), "1.5\\cdot 10^{-30}");
    expect_in(NOTATION_LATEX, expr_real(A, 1e-30), "10^{-30}");
    expect_in(NOTATION_LATEX, expr_real(A, -1e-30), "-10^{-30}");
    expect_in(NOTATION_LATEX, expr_int(A, 200000000000), "2\\cdot 10^{11}");
    expect_in(NOTATION_LATEX, expr_int(A, -100000000), "-10^{8}");
    expect_in(NOTATION_TEXT, expr_int(A, -47000000), "-4.7e7");
    expect_in(NOTATION_TEXT, expr_int(A, 100000), "100000");
    expect_in(NOTATION_TEXT, expr_int(A, 1234500000), "1234500000");
    EXPECT(expr_int(A, 47000000) == expr_decimal(A, "4.7e7")); /* what is printed reads back */
    arena_free(A);
}

static void every_function_prints_in_every_notation(void)
{
    World w = world_new(1);

    for (int op = 0; op < OP_COUNT; op++) {
        Expr args[3] = {expr_add(w.arena, w.symbols[3], w.symbols[4]), w.symbols[1], w.symbols[2]};
        Expr e = expr_call(w.arena, (Op)op, args);

        for (int notation = 0; notation <= NOTATION_TREE; notation++) {
            Text text = {0};
            char *got;
            int depth = 0;

            expr_print(&text, e, (Notation)notation);
            got = text_done(&text);
            EXPECT(strstr(got, "x") != NULL);
            for (const char *c = got; *c != '\0'; c++) {
                depth += (*c == '(' || *c == '{') - (*c == ')' || *c == '}');
                EXPECT(depth >= 0);
            }
            EXPECT(depth == 0);
            mem_free(got);
        }
    }
    arena_free(w.arena);
}

static void deep_nesting_prints(void)
{
    World w = world_new(1);
    Expr e = w.symbols[3];
    char *text;

    for (int i = 0; i < 100000; i++)
        e = expr_sin(w.arena, e);
    text = expr_text(e);
    EXPECT(strlen(text) == 500001);
    mem_free(text);
    arena_free(w.arena);
}

int main(void)
{
    RUN(numbers_print_as_briefly_as_is_exact);
    RUN(numbers_read_back);
    RUN(brackets_stand_only_where_needed);
    RUN(constraints_read_as_in_books);
    RUN(every_notation_prints_every_kind);
    RUN(multiples_of_pi_keep_its_name);
    RUN(tree_shows_sharing);
    RUN(latex_sets_names);
    RUN(every_function_prints_in_every_notation);
    RUN(deep_nesting_prints);
    return test_end();
}
