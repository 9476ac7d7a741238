/* test_export.c: wrapping, named subexpressions, files in other formats */
#include "export/write.h"
#include "present/abbreviate.h"
#include "present/latex_lines.h"
#include "present/layout.h"
#include "session_kit.h"

#include <unistd.h>

static const Page page = {.columns = 40, .notation = NOTATION_TEXT};

static void formulas_break_before_signs_outside_brackets(void)
{
    Text out = {0};

    layout_formula(&out, &page, "y = ", "a*(b + c)*(d + e) + f*(g + h)*cos(i - j) - k");
    EXPECT_TEXT(out.at, "y = a*(b + c)*(d + e)\n    + f*(g + h)*cos(i - j) - k\n");
    text_free(&out);
}

static void a_formula_without_signs_breaks_at_products(void)
{
    Text out = {0};

    layout_formula(&out, &page, "", "aaaaaaaaaaaaaaaa*bbbbbbbbbbbbbbbbbb*cccccccccccccccccccc");
    EXPECT_TEXT(out.at, "aaaaaaaaaaaaaaaa*bbbbbbbbbbbbbbbbbb\n*cccccccccccccccccccc\n");
    text_free(&out);
}

static void nothing_is_lost_by_wrapping(void)
{
    uint64_t state = 3;
    static const char *const pieces[] = {"a",   "b1",  "cos(", "(",   ")",
                                         " + ", " - ", "*",    " = ", ", "};

    for (int i = 0; i < 2000; i++) {
        Text body = {0}, out = {0}, flat = {0}, bare = {0};

        for (int k = 0; k < 60; k++)
            text_add(&body, pieces[test_random(&state) % 10]);
        layout_formula(&out, &page, "", body.at);
        for (const char *c = out.at; *c != '\0'; c++)
            if (*c != ' ' && *c != '\n')
                text_char(&flat, *c);
        for (const char *c = body.at; *c != '\0'; c++)
            if (*c != ' ')
                text_char(&bare, *c);
        EXPECT_TEXT(flat.at, bare.at);
        text_free(&body);
        text_free(&out);
        text_free(&flat);
        text_free(&bare);
    }
}

/* --- LaTeX --- */

/* the rows of what latex_wrap() writes; the widest, and how often it holds a word */
static double widest_row(const char *text)
{
    double widest = 0;

    while (*text != '\0') {
        const char *end = strstr(text, " \\\\\n");
        const size_t length = end != NULL ? (size_t)(end - text) : strlen(text);
        char *row = mem_text(text, length);

        widest = fmax(widest, latex_width(row));
        mem_free(row);
        text += length + (end != NULL ? strlen(" \\\\\n") : 0);
    }
    return widest;
}

static int occurrences(const char *text, const char *word)
{
    int count = 0;

    for (; (text = strstr(text, word)) != NULL; text++)
        count++;
    return count;
}

static void latex_breaks_outside_brackets_first(void)
{
    Text out = {0};

    latex_wrap(&out, "a\\,\\left(b + c\\right) + d\\,\\cos\\left(e - f\\right) - g", 16);
    EXPECT_TEXT(out.at, "a\\,\\left(b + c\\right) \\\\\n"
                        "  &\\quad + d\\,\\cos\\left(e - f\\right) \\\\\n  &\\quad - g");
    text_free(&out);
}

static void brackets_of_latex_are_in_pairs_on_each_row(void)
{
    Text sum = {0}, out = {0};

    text_add(&sum, "k\\,\\left(a_{0}");
    for (int i = 1; i < 40; i++)
        text_addf(&sum, " %c b\\,\\left(a_{%d} + \\sin^{2}\\left(x_{%d}\\right)\\right)",
                  i % 3 == 0 ? '-' : '+', i, i);
    text_add(&sum, "\\right)");
    latex_wrap(&out, sum.at, 50);
    EXPECT(widest_row(out.at) <= 54);
    EXPECT(occurrences(out.at, " \\\\\n") >= 8);
    for (const char *row = out.at; row != NULL; row = strstr(row + 1, " \\\\\n")) {
        const char *end = strstr(row + 1, " \\\\\n");
        char *text = mem_text(row, end != NULL ? (size_t)(end - row) : strlen(row));

        EXPECT(occurrences(text, "\\left") == occurrences(text, "\\right"));
        mem_free(text);
    }
    text_free(&sum);
    text_free(&out);
}

static void a_wide_fraction_becomes_a_factor(void)
{
    Text out = {0};

    latex_wrap(&out, "\\frac{aaaaaaaaaaaa + bbbbbbbbbbbb + cccccccccccc}{d}", 34);
    EXPECT_TEXT(out.at, "\\frac{1}{d}\\,\\left(aaaaaaaaaaaa + bbbbbbbbbbbb\\right. \\\\\n"
                        "  &\\quad \\left. {} + cccccccccccc\\right)");
    text_free(&out);
    latex_wrap(&out, "\\frac{a + b}{c}", 30);
    EXPECT_TEXT(out.at, "\\frac{a + b}{c}");
    text_free(&out);
}

static void a_page_without_width_never_wraps(void)
{
    const Page endless = {.columns = 0, .notation = NOTATION_TEXT};
    Text out = {0};

    layout_formula(&out, &endless,
                   "x = ", "aaaaaaaaaaaaaaaaaaaaaaaaaa + bbbbbbbbbbbbbbbbbbbbbbbbbbbbb");
    EXPECT_TEXT(out.at, "x = aaaaaaaaaaaaaaaaaaaaaaaaaa + bbbbbbbbbbbbbbbbbbbbbbbbbbbbb\n");
    text_free(&out);
}

static void words_wrap_below_their_lead(void)
{
    Text out = {0};

    layout_words(&out, 16, "to: ", "one two three four\nfive");
    EXPECT_TEXT(out.at, "to: one two\n    three four\n    five\n");
    text_free(&out);
}

static void tables_align_and_leave_no_blanks_behind(void)
{
    Table table = table_for("lr");
    Text out = {0};

    table_cell(&table, "a");
    table_cells(&table, "%d", 5);
    table_cell(&table, "long");
    table_cell(&table, "");
    EXPECT(table_width(&table) == 7);
    table_print(&out, &table, 1);
    EXPECT_TEXT(out.at, " a     5\n long\n");
    text_free(&out);
    table_free(&table);
}

/* --- named subexpressions --- */

typedef struct Known {
    Expr *symbols;
    double *values;
    int count;
} Known;

static double known_value(void *context, Expr symbol)
{
    const Known *known = context;

    for (int i = 0; i < known->count; i++)
        if (known->symbols[i] == symbol)
            return known->values[i];
    return NAN;
}

static Expr random_expression(Arena *arena, uint64_t *state, Expr *pool, int *count)
{
    const Expr a = pool[test_random(state) % (uint64_t)*count];
    const Expr b = pool[test_random(state) % (uint64_t)*count];
    Expr e;

    switch (test_random(state) % 5) {
    case 0:
        e = expr_add(arena, a, b);
        break;
    case 1:
        e = expr_mul(arena, a, expr_add(arena, b, expr_int(arena, 2)));
        break;
    case 2:
        e = expr_sin(arena, expr_sub(arena, a, b));
        break;
    case 3:
        e = expr_name_temporary(arena, expr_add(arena, a, expr_cos(arena, b)));
        break;
    default:
        e = expr_square(arena, expr_sub(arena, a, expr_cos(arena, b)));
    }
    if (*count < 60)
        pool[(*count)++] = e;
    return e;
}

/* definitions are put in order: each uses earlier ones only, and the value stays */
static void names_keep_the_value(void)
{
    static const Naming namings[] = {{"w", 4, 24}, {"w", 1, 0}, {"w", 2, 3}};
    uint64_t state = 11;

    for (int trial = 0; trial < 60; trial++) {
        Arena *arena = arena_new();
        Expr pool[64], roots[3];
        Expr symbols[600];
        double values[600];
        Known known = {symbols, values, 3};
        Abbreviation names;
        int count = 3;

        for (int i = 0; i < 3; i++) {
            pool[i] = symbols[i] = expr_symbol(arena,
                                               i == 0   ? "x"
                                               : i == 1 ? "y"
                                                        : "z",
                                               SYMBOL_PARAMETER);
            values[i] = test_uniform(&state, -0.5, 0.5);
        }
        for (int i = 0; i < 57; i++)
            roots[i % 3] = random_expression(arena, &state, pool, &count);
        names = abbreviate(arena, roots, 3, &namings[trial % 3]);
        EXPECT(names.definitions.count > 0);
        for (int i = 0; i < names.definitions.count && known.count < 600; i++) {
            symbols[known.count] = names.definitions.at[i].symbol;
            values[known.count] = expr_evaluate(names.definitions.at[i].value, known_value, &known);
            EXPECT(!isnan(values[known.count]));
            known.count++;
        }
        for (int i = 0; i < 3; i++) {
            const double wanted = expr_evaluate(roots[i], known_value, &known);

            EXPECT_NEAR(expr_evaluate(names.roots[i], known_value, &known), wanted,
                        1e-9 * (1 + fabs(wanted)));
        }
        abbreviation_free(&names);
        arena_free(arena);
    }
}

static void what_stands_once_and_is_short_gets_no_name(void)
{
    static const Naming naming = {"w", 2, 10};
    Arena *arena = arena_new();
    const Expr x = expr_symbol(arena, "x", SYMBOL_PARAMETER);
    const Expr e = expr_add(arena, expr_sin(arena, x), expr_int(arena, 1));
    Abbreviation names = abbreviate(arena, &e, 1, &naming);

    EXPECT(names.definitions.count == 0 && names.roots[0] == e);
    abbreviation_free(&names);
    arena_free(arena);
}

/* --- files --- */

static void csv_quotes_names_that_hold_commas(void)
{
    static const char *const names[] = {"t", "f(a,b)", "say \"x\""};
    static const double values[] = {0, 1.0 / 3, NAN};
    Text out = {0};

    write_csv(&out, names, values, 1, 3, true);
    EXPECT_TEXT(out.at, "t,\"f(a,b)\",\"say \"\"x\"\"\"\n0,0.3333333333333333,nan\n");
    text_free(&out);
    write_csv(&out, names, values, 1, 2, false);
    EXPECT_TEXT(out.at, "0,0.3333333333333333\n");
    text_free(&out);
}

static bool write_file(const char *path, const char *first, const char *second)
{
    FILE *file = fopen(path, "w");

    if (file == NULL)
        return false;
    (void)fputs(first, file);
    (void)fputs(second, file);
    return fclose(file) == 0;
}

/* compiled by the C compiler, the exported functions give the numbers of the session */
static void exported_c_compiles_and_gives_the_same_numbers(void)
{
    static const char main_text[] =
        "#include <stdio.h>\n"
        "int main(void)\n{\n"
        "    double p[MODEL_P], y[6], out[16];\n"
        "    model_parameters(p);\n"
        "    y[0] = 1.0471975511965976, y[1] = 2.8487498818612176, y[2] = 0.67445626465380286;\n"
        "    y[3] = 12, y[4] = -2.0889318714683744, y[5] = -2.4402745825759697;\n"
        "    model_mass(p, 0, y, y, out);\n"
        "    printf(\"%.17g\\n%.17g\\n\", out[0], out[1]);\n"
        "    model_forces(p, 0, y, y, out);\n"
        "    printf(\"%.17g\\n\", out[0]);\n"
        "    model_constraints(p, 0, y, y, out);\n"
        "    printf(\"%.17g\\n\", out[0]);\n"
        "    return 0;\n}\n";
    const char *compiler = getenv("CC");
    char folder[] = "/tmp/cotree-test-XXXXXX", source[64], command[400];
    double numbers[4] = {NAN, NAN, NAN, NAN};
    char line[200];
    int count = 0;
    Kit kit = kit_new();
    FILE *pipe;

    if (mkdtemp(folder) == NULL) {
        SKIP("exported_c_compiles_and_gives_the_same_numbers", "no folder for its files");
        return;
    }
    EXPECT_DONE(&kit, SLIDER_CRANK ONE_TREE CRANK_START "export c");
    (void)snprintf(source, sizeof source, "%s/model.c", folder);
    EXPECT(write_file(source, kit.text, main_text));
    (void)snprintf(
        command, sizeof command, "%s -std=c99 -w -ffp-contract=off -o %s/model %s -lm && %s/model",
        compiler != NULL && compiler[0] != '\0' ? compiler : "cc", folder, source, folder);
    pipe = popen(command, "r"); /* NOLINT(cert-env33-c): the compiler of this build */
    EXPECT(pipe != NULL);
    while (pipe != NULL && count < 4 && fgets(line, sizeof line, pipe) != NULL)
        numbers[count++] = strtod(line, NULL);
    EXPECT(pipe != NULL && pclose(pipe) == 0);
    EXPECT_NEAR(numbers[0], kit_value(&kit, "mass(1,1)"), 1e-14);
    EXPECT_NEAR(numbers[1], kit_value(&kit, "mass(1,2)"), 1e-13);
    EXPECT_NEAR(numbers[2], kit_value(&kit, "forces(1)"), 1e-11);
    EXPECT_NEAR(numbers[3], 0, 1e-14);
    (void)unlink(source);
    (void)snprintf(source, sizeof source, "%s/model", folder);
    (void)unlink(source);
    EXPECT(rmdir(folder) == 0);
    kit_free(&kit);
}

static void exported_c_keeps_names_apart(void)
{
    Kit kit = kit_new();

    /* a parameter called like a keyword, one like an argument, one like a dotted coordinate */
    EXPECT_DONE(&kit, "scene planar\ndouble = 2\nq = 3\nm_x = 1\nbody m mass=double*q + m_x\n"
                      "gravity [0, -9.81]\nexport c");
    EXPECT_HOLDS(kit.text, "const real double_2 = p[0];");
    EXPECT_HOLDS(kit.text, "const real q = p[1];");
    EXPECT_HOLDS(kit.text, "const real m_x = p[2];");
    kit_free(&kit);
}

/* Only C differentiates what a mode asks of states; the others would fail their own check. */
static void modes_that_constrain_states_are_refused_but_in_c(void)
{
    static const struct {
        const char *model, *part, *side; /* NULL: it constrains nothing */
    } cases[] = {
        {"vsource V 0 a -5\ndiode D a b\ncapacitor C b 0 1e-3\nresistor R b 0 10\ninit C.v = 5",
         "D ", "closed"},
        {"vsource V 0 a -5e3\ndiode D a b\ncapacitor C b 0 1e-12\nresistor R b 0 1e9\ninit C.v = "
         "5e3",
         "D ", "closed"},
        {"vsource V a 0 5\nswitch S a b when=t > 1\ninductor L b c 1e-3\nresistor R c 0 10\n"
         "diode D d 0\nresistor R2 a d 1",
         "S ", "open"},
        {"vsource V a 0 5\ndiode D a b\nresistor R b 0 10\ncapacitor C c 0 1e-3\n"
         "resistor R2 b c 10",
         NULL, NULL},
        {"vsource V 0 a -5\ndiode D a b Ron=1e-3 Roff=1e9\ncapacitor C b 0 1e-3\n"
         "resistor R b 0 10",
         NULL, NULL},
    };
    static const char *const others[] = {"python", "fortran", "matlab"};

    for (int i = 0; i < COUNT(cases); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, cases[i].model);
        EXPECT_DONE(&kit, "export c");
        for (int k = 0; k < COUNT(others); k++) {
            char statement[32];

            snprintf(statement, sizeof statement, "export %s", others[k]);
            if (cases[i].part == NULL) {
                EXPECT_DONE(&kit, statement);
                continue;
            }
            EXPECT(kit_do(&kit, statement) == CT_FAILED);
            EXPECT(strncmp(kit.error.message, cases[i].part, 2) == 0);
            EXPECT_HOLDS(kit.error.message, cases[i].side);
            EXPECT_HOLDS(kit.error.message, others[k]);
            EXPECT_HOLDS(kit.error.hint, "export c");
            EXPECT_HOLDS(kit.error.hint, "Ron=");
        }
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(formulas_break_before_signs_outside_brackets);
    RUN(a_formula_without_signs_breaks_at_products);
    RUN(nothing_is_lost_by_wrapping);
    RUN(latex_breaks_outside_brackets_first);
    RUN(brackets_of_latex_are_in_pairs_on_each_row);
    RUN(a_wide_fraction_becomes_a_factor);
    RUN(a_page_without_width_never_wraps);
    RUN(words_wrap_below_their_lead);
    RUN(tables_align_and_leave_no_blanks_behind);
    RUN(names_keep_the_value);
    RUN(what_stands_once_and_is_short_gets_no_name);
    RUN(csv_quotes_names_that_hold_commas);
    RUN(exported_c_compiles_and_gives_the_same_numbers);
    RUN(exported_c_keeps_names_apart);
    RUN(modes_that_constrain_states_are_refused_but_in_c);
    return test_end();
}
