/* test_expr_sympy.c: builders, derivatives and rewriting against SymPy, where it is there */
#include "test_expr.h"

#include <unistd.h>

static const char python[] = "/usr/bin/python3"; /* Debian's, for which python3-sympy is */

/* A random expression, and in `raw` how it was asked for. */
static Expr random_raw(World *w, int depth, Text *raw)
{
    static const char *const functions[] = {"sin", "cos", "tanh", "exp", "atan"};
    int choice = depth == 0 ? 0 : pick(w, 12);
    Expr a;
    Expr b;

    if (depth == 0 && pick(w, 3) == 0) {
        int num = pick(w, 19) - 9;
        int den = 1 + pick(w, 6);

        /* one in five is a multiple of pi */
        if (pick(w, 5) == 0) {
            text_addf(raw, "(%d)*pi/%d", num, den);
            return expr_mul(w->arena, expr_rational(w->arena, num, den), expr_pi(w->arena, 1));
        }
        text_addf(raw, "(%d)/%d", num, den);
        return expr_rational(w->arena, num, den);
    }
    if (depth == 0) {
        a = w->symbols[pick(w, TEST_SYMBOLS)];
        text_add(raw, expr_name(a));
        return a;
    }
    text_char(raw, '(');
    if (choice < 8) {
        a = random_raw(w, depth - 1, raw);
        text_add(raw, choice < 3 ? " + " : choice < 5 ? " - " : ")*(");
        b = random_raw(w, depth - 1, raw);
        text_char(raw, ')');
        return choice < 3   ? expr_add(w->arena, a, b)
               : choice < 5 ? expr_sub(w->arena, a, b)
                            : expr_mul(w->arena, a, b);
    }
    if (choice < 10) {
        int which = pick(w, COUNT(functions)), op = 0;

        while (strcmp(op_name((Op)op), functions[which]) != 0)
            op++;
        text_addf(raw, "%s(", functions[which]);
        a = expr_call1(w->arena, (Op)op, random_raw(w, depth - 1, raw));
        text_add(raw, "))");
        return a;
    }
    if (choice == 10) {
        int k = 2 + pick(w, 2);

        a = expr_pow(w->arena, random_raw(w, depth - 1, raw), expr_int(w->arena, k));
        text_addf(raw, ")**%d", k);
        return a;
    }
    text_add(raw, "1/sqrt(2 + (");
    a = random_raw(w, depth - 1, raw);
    text_add(raw, ")**2))");
    a = expr_add(w->arena, expr_square(w->arena, a), expr_int(w->arena, 2));
    return expr_div(w->arena, expr_int(w->arena, 1), expr_sqrt(w->arena, a));
}

static void write_lines(FILE *file)
{
    for (uint64_t seed = 1; seed <= 60; seed++) {
        World w = world_new(seed);
        Text line = {0};
        Expr e = random_raw(&w, 4, &line);
        Expr outcomes[] = {e, expr_diff(w.arena, e, w.symbols[3]), expr_expand(w.arena, e, 200),
                           expr_fold(w.arena, e), expr_collect(w.arena, e)};
        char *text;

        for (int i = 0; i < COUNT(outcomes); i++) {
            text_char(&line, ';');
            expr_print(&line, outcomes[i], NOTATION_PYTHON);
        }
        text = text_done(&line);
        fprintf(file, "%s\n", text);
        mem_free(text);
        arena_free(w.arena);
    }
}

static void outcomes_agree_with_sympy(void)
{
    const char *source = getenv("TOP_SRCDIR");
    char name[] = "/tmp/cotree-sympy-XXXXXX";
    char command[600];
    int fd = mkstemp(name);
    FILE *file = fd >= 0 ? fdopen(fd, "w") : NULL;

    EXPECT(file != NULL);
    if (file == NULL)
        return;
    write_lines(file);
    EXPECT(fclose(file) == 0);
    (void)snprintf(command, sizeof command, "%s '%s/tests/unit/check_sympy.py' %s", python,
                   source != NULL ? source : ".", name);
    (void)fflush(stdout);
    EXPECT(system(command) == 0);
    EXPECT(unlink(name) == 0);
}

int main(void)
{
    char command[100];

    (void)snprintf(command, sizeof command, "%s -c 'import sympy' 2>/dev/null", python);
    if (system(command) == 0)
        RUN(outcomes_agree_with_sympy);
    else
        SKIP("outcomes_agree_with_sympy", "no SymPy here (Debian: python3-sympy)");
    return test_end();
}
