/* test_table.c: curves through data: the spline, its derivatives, files and what is wrong with them
 */
#include "session_kit.h"

#include "base/memory.h"
#include "compile/program.h"
#include "expr/expr.h"

#include <stdlib.h>
#include <unistd.h>

#define FILE_NAME "test_table_data.csv"

static void write_file(const char *text)
{
    FILE *out = fopen(FILE_NAME, "w");

    if (out == NULL || fputs(text, out) < 0)
        test_faults++;
    if (out != NULL)
        (void)fclose(out);
}

static void expect_value(Kit *kit, const char *expression, double wanted, double tolerance)
{
    double got = kit_value(kit, expression);

    if (!(fabs(got - wanted) <= tolerance)) {
        test_faults++;
        printf("%s is %.17g, wanted %.17g within %.3g: %s\n", expression, got, wanted, tolerance,
               kit->error.message);
    }
}

/* --- the spline --- */

/* a natural spline of points 0 1 0 at -1 0 1 is 1 - 3/2 x^2 + 1/2 |x|^3 */
static double hat(double x, int order)
{
    double a = fabs(x), sign = x < 0 ? -1 : 1;

    return order == 0   ? 1 - 1.5 * a * a + 0.5 * a * a * a
           : order == 1 ? sign * (-3 * a + 1.5 * a * a)
           : order == 2 ? -3 + 3 * a
                        : sign * 3;
}

static void three_points_make_the_known_curve(void)
{
    const double x[] = {-1, 0, 1}, y[] = {0, 1, 0};
    Curve *table = curve_new("f", "2", x, y, 3);

    for (int order = 0; order < 4; order++)
        for (int i = 0; i < 20; i++)
            EXPECT_NEAR(curve_value(table, -0.95 + 0.1 * i, order), hat(-0.95 + 0.1 * i, order),
                        1e-14);
    EXPECT(curve_value(table, 7, 0) == 0 && curve_value(table, -7, 1) == 0);
    EXPECT(curve_value(table, 0, 4) == 0);
    EXPECT(isnan(curve_value(table, NAN, 0)));
    curve_free(table);
}

/* fourth order inside, since the ends of a sine over whole turns are natural */
static void a_sine_comes_out_to_fourth_order(void)
{
    enum { POINTS = 201 };
    double x[POINTS], y[POINTS];
    Curve *table;

    for (int i = 0; i < POINTS; i++) {
        x[i] = 2 * M_PI * i / (POINTS - 1);
        y[i] = sin(x[i]);
    }
    table = curve_new("f", "2", x, y, POINTS);
    for (int i = 0; i < 169; i++) {
        const double at = 0.0371 * i;

        EXPECT_NEAR(curve_value(table, at, 0), sin(at), 1e-8);
        EXPECT_NEAR(curve_value(table, at, 1), cos(at), 1e-5);
        EXPECT_NEAR(curve_value(table, at, 2), -sin(at), 1e-3);
    }
    curve_free(table);
}

/* --- expressions --- */

static double half(void *context, Expr symbol)
{
    (void)symbol;
    return *(double *)context;
}

static void equal_data_are_one_expression(void)
{
    const double x[] = {0, 1, 2}, y[] = {0, 1, 4}, z[] = {0, 1, 5};
    Arena *arena = arena_new();
    Expr first = arena_add_table(arena, "a.csv", "2", x, y, 3);
    Expr t = expr_symbol(arena, "t", SYMBOL_TIME);
    char *text;

    EXPECT(arena_add_table(arena, "b.csv", "v", x, y, 3) == first);
    EXPECT(arena_add_table(arena, "a.csv", "3", x, z, 3) != first);
    EXPECT(arena_find_table(arena, "b.csv", "v") == first);
    EXPECT(arena_find_table(arena, "b.csv", "w") == NULL);
    EXPECT(expr_kinds(expr_table(arena, first, t, 0)) == 1U << SYMBOL_TIME);
    text = expr_text(expr_diff(arena, expr_table(arena, first, expr_square(arena, t), 0), t));
    EXPECT_TEXT(text, "2*t*table(\"a.csv\", t^2, 2, 1)");
    mem_free(text);
    arena_free(arena);
}

static void programs_compute_what_expressions_are(void)
{
    const double x[] = {0, 1, 2, 4}, y[] = {0, 1, 4, -3};
    Arena *arena = arena_new();
    Expr t = expr_symbol(arena, "t", SYMBOL_TIME), roots[3];
    Program *program = NULL;
    Workspace *workspace;
    Diag diag;

    roots[0] = expr_table(arena, arena_add_table(arena, "a.csv", "2", x, y, 4), t, 0);
    roots[1] = expr_diff(arena, roots[0], t);
    roots[2] = expr_diff(arena, roots[1], t);
    EXPECT(program_new(roots, 3, &t, 1, &program, &diag) == OK);
    workspace = workspace_new(program);
    for (int k = 0; k < 22; k++) {
        double at = -0.5 + 0.25 * k;

        workspace_inputs(workspace)[0] = at;
        workspace_run(workspace, STAGE_PARAMETER, STAGE_TIME);
        for (int i = 0; i < 3; i++)
            EXPECT(workspace_roots(workspace)[i] == expr_evaluate(roots[i], half, &at));
    }
    workspace_free(workspace);
    program_free(program);
    arena_free(arena);
}

/* --- files --- */

static void columns_go_by_number_and_by_name(void)
{
    Kit kit = kit_new();

    write_file("# measured\nt [s], \"v, left\" ,w\n0,1,10\n1,2,20\n\n2,3,40\n");
    EXPECT_DONE(&kit, "output a = table(\"" FILE_NAME "\", t)\n"
                      "output b = table(\"" FILE_NAME "\", t, 3)\n"
                      "output c = table(\"" FILE_NAME "\", t, \"v, left\")\n"
                      "body m mass=1 inertia=[1,1,1]\nsimulate 3 every=0.5\n");
    expect_value(&kit, "a at 1.5", 2.5, 1e-14);
    expect_value(&kit, "b at 2", 40, 1e-14);
    expect_value(&kit, "b at 3", 40, 0);
    expect_value(&kit, "c at 0.5", 1.5, 1e-14);
    expect_value(&kit, "table(\"" FILE_NAME "\", 1, 3)", 20, 0);
    kit_free(&kit);

    kit = kit_new();
    write_file("0 1\n1\t2\n2;4\n");
    expect_value(&kit, "table(\"" FILE_NAME "\", 2, 2)", 4, 0);
    (void)unlink(FILE_NAME);
    kit_free(&kit);
}

/* as factors by hand tell: 1 ms is 1e-3 s, 180 deg are pi, 60 rpm are 2 pi rad/s */
static void values_are_in_the_units_of_the_first_row(void)
{
    static const char *const files[] = {
        "t [ms], h [deg],w[rpm],plain,m [1],n [what]\n0,0,0,7,1,1\n300,180,60,8,2,2\n",
        "t [ms];\"h [deg]\";w [rpm];plain;m [1];n [what]\n0;0;0;7;1;1\n300;180;60;8;2;2\n",
        "t [ms] h [deg]\tw [ rpm ] plain m [1] n [what]\n0 0 0 7 1 1\n300 180 60 8 2 2\n",
    };

    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        Kit kit = kit_new();

        write_file(files[i]);
        expect_value(&kit, "table(\"" FILE_NAME "\", 0.3)", M_PI, 1e-15);
        expect_value(&kit, "table(\"" FILE_NAME "\", 0.15, \"h\")", M_PI / 2, 1e-15);
        expect_value(&kit, "table(\"" FILE_NAME "\", 0.15, \"h [deg]\")", M_PI / 2, 1e-15);
        expect_value(&kit, "table(\"" FILE_NAME "\", 0.15, 3)", M_PI, 1e-15);
        expect_value(&kit, "table(\"" FILE_NAME "\", 0.15, \"w\", 1)", 2 * M_PI / 0.3, 1e-12);
        expect_value(&kit, "table(\"" FILE_NAME "\", 0.3, \"plain\")", 8, 0);
        expect_value(&kit, "table(\"" FILE_NAME "\", 0.3, \"m\")", 2, 0);
        expect_value(&kit, "table(\"" FILE_NAME "\", 0.3, 1)", 0.3, 0);
        kit_free(&kit);
    }
    (void)unlink(FILE_NAME);
}

/* a capacitor takes C v': exact where the curve is a line */
static void a_source_follows_its_data_and_their_slope(void)
{
    Kit kit = kit_new();
    char *script;

    write_file("t,v\n0,0\n1,2\n2,4\n");
    EXPECT_DONE(&kit, "vsource E1 a 0 table(\"" FILE_NAME "\", t, \"v\")\n"
                      "capacitor C1 a 0 0.5\nresistor R1 a 0 4\nsimulate 2 every=0.5\n");
    expect_value(&kit, "C1.i at 1.5", 1, 1e-12);
    expect_value(&kit, "R1.i at 1.5", 0.75, 1e-12);
    script = ct_save(kit.session);
    EXPECT_HOLDS(script, "vsource E1 a 0 table(\"" FILE_NAME "\", t, \"v\")\n");
    ct_free(script);

    /* what was read stays, also when statements are applied anew */
    (void)unlink(FILE_NAME);
    EXPECT_DONE(&kit, "set R1.R = 8\nundo\ndelete C1\nsimulate 2 every=0.5\n");
    expect_value(&kit, "R1.i at 1.5", 0.75, 1e-12);
    EXPECT_DONE(&kit, "inductor L1 a 0 2\nexport c\n");
    EXPECT_HOLDS(kit.text, "static double model_table(int number, double v, int order)");
    EXPECT_HOLDS(kit.text, "static const double model_table_1[] = {\n        0, 1, 2, 0,\n");
    EXPECT_HOLDS(kit.text, "R(model_table(1, t, 0))");
    kit_free(&kit);
}

static void wrong_data_are_refused_at_their_place(void)
{
    /* clang-format off */
    static const struct { const char *file, *call; int column; const char *message, *hint; } wrong[] = {
        {NULL,               "(\"" FILE_NAME "\", t)",         18, "can't read '" FILE_NAME "'", "from the folder of the script"},
        {"0,1\n1,x\n",       "(\"" FILE_NAME "\", t)",         18, "line 2 of " FILE_NAME ": 'x' is no number", ""},
        {"0,1\n0,2\n",       "(\"" FILE_NAME "\", t)",         18, "line 2 of " FILE_NAME ": the first column has to grow", ""},
        {"0,1\n1\n",         "(\"" FILE_NAME "\", t)",         18, "line 2 of " FILE_NAME " has no column 2", ""},
        {"t,v\n0,1\n",       "(\"" FILE_NAME "\", t)",         18, "has 1 row of numbers; a curve takes 2", ""},
        {"",                 "(\"" FILE_NAME "\", t)",         18, "has 0 rows of numbers", ""},
        {"0,1\n1,2\n",       "(\"" FILE_NAME "\", t, 3)",      44, "has 2 columns", ""},
        {"t,volt\n0,1\n1,2\n", "(\"" FILE_NAME "\", t, \"vol\")", 44, "is called 'vol'", "did you mean 'volt'?"},
        {"0,1\n1,2\n",       "(\"" FILE_NAME "\", t, \"v\")",  44, "is called 'v'", "doesn't name them"},
        {"t,v [mQ]\n0,1\n1,2\n", "(\"" FILE_NAME "\", t)", 18, "column 2 of " FILE_NAME ", 'v [mQ]': '[mQ]' is no unit", "[kN/m]"},
        {"t [],v\n0,1\n1,2\n", "(\"" FILE_NAME "\", t)",  18, "column 1 of " FILE_NAME ", 't []': '[]' is no unit", "[1] where"},
        {"t [km],v\n0,1\n1e307,2\n", "(\"" FILE_NAME "\", t)", 18, "line 3 of " FILE_NAME ": '1e307' is too large", ""},
        {"0,1\n1,2\n",       "(\"" FILE_NAME "\", t, t)",      44, "a column is a number from 1 or a name", ""},
        {"0,1\n1,2\n",       "(\"" FILE_NAME "\", t, 2, 5)",   47, "derivatives of order 1, 2 and 3", ""},
        {"0,1\n1,2\n",       "(t, t)",                         12, "does not take 2 arguments", "table(\"file.csv\", x, column)"},
    };
    /* clang-format on */

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        Kit kit = kit_new();
        char line[200];

        (void)unlink(FILE_NAME);
        if (wrong[i].file != NULL)
            write_file(wrong[i].file);
        (void)snprintf(line, sizeof line, "output a = table%s\n", wrong[i].call);
        EXPECT(kit_do(&kit, line) == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, wrong[i].message);
        EXPECT_HOLDS(kit.error.hint, wrong[i].hint);
        if (kit.error.column != wrong[i].column) {
            test_faults++;
            printf("%s: at column %d, wanted %d\n", wrong[i].call, kit.error.column,
                   wrong[i].column);
        }
        kit_free(&kit);
    }
    (void)unlink(FILE_NAME);
}

/* --- in other notations --- */

/* the hat's cubics by hand: 1.5 d - 0.5 d^3 up, 1 - 1.5 d^2 + 0.5 d^3 down */
static void programs_are_given_the_data(void)
{
    Kit kit = kit_new();

    write_file("x,y\n-1,0\n0,1\n1,0\n");
    EXPECT_DONE(&kit, "scene planar\nbody m mass=1\nprismatic s ground m axis=x\n"
                      "actuator F s force=table(\"" FILE_NAME "\", s, \"y\")\n"
                      "show forces as matlab\n");
    EXPECT_HOLDS(kit.text, "% column y of " FILE_NAME "\n"
                           "table1_ = @(v) ppval(mkpp([-1, 0, 1], ...\n"
                           "    [-0.5, 0, 1.5, 0; ...\n"
                           "    0.5, -1.5, 0, 1]), min(max(v, -1), 1));\n");
    EXPECT_HOLDS(kit.text, "forces(1) = table1_(s);\n");
    EXPECT_DONE(&kit, "show forces as c\n");
    EXPECT_HOLDS(kit.text,
                 "static const double _table1[] = {3,\n    -1, 0, 1, 0,\n    1, 0, 0, -3,\n"
                 "    0};\nforces[0] = table(_table1, s, 0.0);\n");
    EXPECT_DONE(&kit, "show forces as latex\n");
    EXPECT_HOLDS(kit.text, "\\operatorname{table}_{\\text{test\\_table\\_data.csv, y}}"
                           "\\left(s\\right)");
    EXPECT_DONE(&kit, "show (table(\"" FILE_NAME "\", s, 2, 2)) as matlab\n");
    EXPECT_HOLDS(kit.text, "table1_dd = @(v) (-1 <= v & v <= 1).*ppval(mkpp([-1, 0, 1], ...\n"
                           "    [-3, 0; ...\n    3, -3]), v);\n");
    EXPECT_LACKS(kit.text, "table1_ = ");
    kit_free(&kit);
    (void)unlink(FILE_NAME);
}

/* value and derivatives, inside and outside, as an interpreter of the language finds them */
static void octave_computes_the_same(void)
{
    Kit kit = kit_new();
    FILE *script = fopen("test_table.m", "w"), *pipe;

    write_file("x,y\n-1,0.5\n0,1\n0.25,-3\n1,2\n");
    EXPECT_DONE(&kit, "scene planar\nbody m mass=1\nprismatic s ground m axis=x\n");
    for (int order = 0; order < 4; order++) {
        char line[120];

        (void)snprintf(line, sizeof line, "output w%d = table(\"" FILE_NAME "\", s, 2, %d)", order,
                       order);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_DONE(&kit, "show outputs as matlab");
    EXPECT(script != NULL);
    if (script != NULL) {
        (void)fprintf(script,
                      "for s = -1.3:0.1:1.3\n%s\nprintf('%%.17g\\n', w0, w1, w2, w3);\nend\n",
                      kit.text);
        (void)fclose(script);
        pipe = popen("octave-cli -q --norc test_table.m 2>/dev/null", "r");
        for (int i = 0; i < 4 * 27; i++) {
            const int point = i / 4, order = i % 4;
            char expression[120];
            double got = NAN;

            EXPECT(pipe != NULL && fscanf(pipe, "%lf", &got) == 1);
            (void)snprintf(expression, sizeof expression, "table(\"" FILE_NAME "\", %.17g, 2, %d)",
                           -1.3 + 0.1 * point, order);
            EXPECT_NEAR(got, kit_value(&kit, expression), 1e-9);
        }
        EXPECT(pipe != NULL && pclose(pipe) >= 0);
    }
    (void)unlink("test_table.m");
    (void)unlink(FILE_NAME);
    kit_free(&kit);
}

int main(void)
{
    RUN(three_points_make_the_known_curve);
    RUN(a_sine_comes_out_to_fourth_order);
    RUN(equal_data_are_one_expression);
    RUN(programs_compute_what_expressions_are);
    RUN(columns_go_by_number_and_by_name);
    RUN(values_are_in_the_units_of_the_first_row);
    RUN(a_source_follows_its_data_and_their_slope);
    RUN(wrong_data_are_refused_at_their_place);
    RUN(programs_are_given_the_data);
    if (system("octave-cli --version >/dev/null 2>&1") == 0) /* NOLINT(cert-env33-c) */
        RUN(octave_computes_the_same);
    else
        SKIP("octave_computes_the_same", "no octave-cli (package octave)");
    return test_end();
}
