/* test_expr_code.c: what is printed as source code computes the same, in each language */
#include "test_expr.h"

#include <unistd.h>

enum { RANDOM_ONES = 40, MOST = OP_COUNT + RANDOM_ONES };

/* how a language writes a program that prints values, one a line */
typedef struct Language {
    const char *name;
    const char *has; /* command that succeeds where the language is there */
    Notation notation;
    const char *file;
    const char *begin;
    const char *symbol; /* name, value */
    const char *line;   /* of an expression */
    const char *end;
    const char *run; /* in the folder of the file */
} Language;

static const Language languages[] = {
    {"C", "${CC:-cc} --version", NOTATION_C, "try.c",
     "#include <math.h>\n#include <stdio.h>\nint main(void)\n{\n", "double %s = %.17g;\n",
     "printf(\"%%.17g\\n\", (double)(%s));\n", "return 0;\n}\n",
     "${CC:-cc} -w try.c -lm && ./a.out"},
    {"Python", "/usr/bin/python3 --version", NOTATION_PYTHON, "try.py", "import math\n",
     "%s = %.17g\n", "print(repr(float(%s)))\n", "", "/usr/bin/python3 try.py"},
    {"Fortran", "gfortran --version", NOTATION_FORTRAN, "try.f90",
     "program try\nimplicit none\ndouble precision :: a, b, c, x, y, z\n", "%s = %.17gd0\n",
     "print '(es25.17e3)', %s\n", "end program\n",
     "gfortran -ffree-line-length-none -w try.f90 && ./a.out"},
};

/* every function, and random expressions */
static void make_all(World *w, Expr *es)
{
    double value;

    for (int op = 0; op < OP_COUNT; op++) {
        Expr args[3] = {
            expr_add(w->arena, expr_mul(w->arena, w->symbols[3], expr_rational(w->arena, 1, 3)),
                     expr_rational(w->arena, 1, 7)),
            expr_sub(w->arena, w->symbols[1], w->symbols[2]), expr_neg(w->arena, w->symbols[4])};

        /* a table takes data: test_table.c */
        es[op] = expr_mul(w->arena, w->symbols[0],
                          expr_call(w->arena, op == OP_TABLE ? OP_SIN : (Op)op, args));
    }
    for (int i = 0; i < RANDOM_ONES; i++)
        es[OP_COUNT + i] = random_expr(w, 4, &value);
}

static void write_program(const Language *language, World *w, const Expr *es, FILE *file)
{
    (void)fputs(language->begin, file);
    for (int i = 0; i < TEST_SYMBOLS; i++)
        (void)fprintf(file, language->symbol, expr_name(w->symbols[i]), w->values[i]);
    for (int i = 0; i < MOST; i++) {
        Text text = {0};
        char *code;

        expr_print(&text, es[i], language->notation);
        code = text_done(&text);
        (void)fprintf(file, language->line, code);
        mem_free(code);
    }
    (void)fputs(language->end, file);
}

static void compare_values(const Language *language, World *w, const Expr *es, FILE *output)
{
    double got;
    int i = 0;

    for (; i < MOST && fscanf(output, "%lf", &got) == 1; i++) {
        double wanted = value_in(w, es[i]);

        if (isnan(wanted) && isnan(got)) /* unilateral() beyond its limit */
            continue;
        EXPECT_NEAR(got, wanted, 1e-13 * size_of(wanted));
        if (!(fabs(got - wanted) <= 1e-13 * size_of(wanted)))
            printf("    %s, expression %d\n", language->name, i);
    }
    EXPECT(i == MOST);
}

static void try_language(const Language *language)
{
    World w = world_new(17);
    Expr es[MOST];
    char folder[] = "/tmp/cotree-code-XXXXXX";
    char command[300];
    FILE *file;

    make_all(&w, es);
    EXPECT(mkdtemp(folder) != NULL);
    (void)snprintf(command, sizeof command, "%s/%s", folder, language->file);
    file = fopen(command, "w");
    EXPECT(file != NULL);
    if (file != NULL) {
        write_program(language, &w, es, file);
        (void)fclose(file);
        (void)snprintf(command, sizeof command, "cd %s && { %s; }", folder, language->run);
        file = popen(command, "r");
        EXPECT(file != NULL);
        if (file != NULL) {
            compare_values(language, &w, es, file);
            EXPECT(pclose(file) == 0);
        }
    }
    (void)snprintf(command, sizeof command, "rm -r %s", folder);
    EXPECT(system(command) == 0);
    arena_free(w.arena);
}

static void c_computes_the_same(void)
{
    try_language(&languages[0]);
}

static void python_computes_the_same(void)
{
    try_language(&languages[1]);
}

static void fortran_computes_the_same(void)
{
    try_language(&languages[2]);
}

static bool is_there(const Language *language)
{
    char command[100];

    (void)snprintf(command, sizeof command, "%s >/dev/null 2>&1", language->has);
    return system(command) == 0;
}

#define RUN_WITH(language, claim)                                                                  \
    do {                                                                                           \
        if (is_there(&(language)))                                                                 \
            RUN(claim);                                                                            \
        else                                                                                       \
            SKIP(#claim, "the language is not installed");                                         \
    } while (0)

int main(void)
{
    RUN_WITH(languages[0], c_computes_the_same);
    RUN_WITH(languages[1], python_computes_the_same);
    RUN_WITH(languages[2], fortran_computes_the_same);
    return test_end();
}
