/* bench_expr.c: what expressions cost: building, bytes, a deep derivative, folding of a long sum */
#include "base/memory.h"
#include "expr/expr.h"

#include "bench.h"

enum { TRIES = 5, DEEP = 100000, WIDE = 20000, CHAIN = 800000 };

static Expr parameter(Arena *arena, const char *letter, int i)
{
    char name[24];

    (void)snprintf(name, sizeof name, "%s%d", letter, i);
    return expr_symbol(arena, name, SYMBOL_PARAMETER);
}

/* What formulation builds: (a + b)*cos(x) - c*sin(y), its products and squares, of many angles. */
static Arena *build(int64_t *made)
{
    Arena *arena = arena_new();
    Expr *angles = NEW_ARRAY(Expr, WIDE);

    for (int i = 0; i < WIDE; i++)
        angles[i] = parameter(arena, "h", i);
    *made = -arena_nodes(arena);
    for (int i = 0; i + 2 < WIDE; i++) {
        Expr s = expr_sin(arena, angles[i + 1]);
        Expr p =
            expr_mul(arena, expr_add(arena, angles[i], angles[i + 2]), expr_cos(arena, angles[i]));
        Expr q = expr_mul(arena, angles[i + 2], s);

        expr_mul(arena, expr_sub(arena, p, q), expr_add(arena, p, expr_square(arena, s)));
    }
    *made += arena_nodes(arena);
    mem_free(angles);
    return arena;
}

static void measure_building(void)
{
    Arena *arena;
    int64_t made = 0;
    double seconds;

    BENCH_LEAST(TRIES, seconds, arena_free(build(&made)));
    bench_line("expr.build_node", 1e9 * seconds / (double)made, "ns");
    arena = build(&made);
    bench_line("expr.node", (double)arena_bytes(arena) / (double)arena_nodes(arena), "bytes");
    arena_free(arena);
}

/* e -> e*sin(e) + p, three nodes a level */
static Expr deep(Arena *arena, int nodes)
{
    Expr p = expr_symbol(arena, "p", SYMBOL_PARAMETER);
    Expr e = expr_symbol(arena, "x", SYMBOL_COORDINATE);

    for (int i = 0; i < nodes / 3; i++)
        e = expr_add(arena, expr_mul(arena, e, expr_sin(arena, e)), p);
    return e;
}

static void measure_derivative(void)
{
    Arena *arena = arena_new();
    Expr e = deep(arena, DEEP);
    Expr x = expr_symbol(arena, "x", SYMBOL_COORDINATE);
    double seconds = 1e300;

    /* each try forgets the one before, or it would be remembered */
    for (int i = 0; i < TRIES; i++) {
        ArenaMark *mark = arena_mark(arena);
        double start = clock_now();
        double took;

        expr_diff(arena, e, x);
        took = clock_now() - start;
        seconds = took < seconds ? took : seconds;
        arena_release(arena, mark);
    }
    bench_line("expr.diff_1e5", 1e3 * seconds, "ms");
    arena_free(arena);
}

/* 8e5 levels of x -> x^2/2 + 1: hashes of 32 bits repeat along such a chain */
static void measure_chain(void)
{
    Arena *arena = arena_new();
    const Expr half = expr_rational(arena, 1, 2), one = expr_int(arena, 1);
    Expr e = expr_symbol(arena, "x", SYMBOL_STATE);
    const double start = clock_now();

    for (int i = 0; i < CHAIN; i++)
        e = expr_add(arena, expr_mul(arena, half, expr_square(arena, e)), one);
    bench_line("expr.chain_8e5", 1e3 * (clock_now() - start), "ms");
    arena_free(arena);
}

/* sum of p_i (cos x_j cos y_k + sin x_j sin y_k) */
static void measure_folding(void)
{
    Arena *arena = arena_new();
    Expr *terms = NEW_ARRAY(Expr, 2 * WIDE);
    Expr sum = NULL;
    Expr folded = NULL;
    double seconds;

    for (int i = 0; i < WIDE; i++) {
        Expr x = parameter(arena, "x", i % 100);
        Expr y = parameter(arena, "y", i % 7);
        Expr p = parameter(arena, "p", i);
        Expr c = expr_mul(arena, expr_cos(arena, x), expr_cos(arena, y));
        Expr s = expr_mul(arena, expr_sin(arena, x), expr_sin(arena, y));

        terms[i] = expr_mul(arena, p, c);
        terms[WIDE + i] = expr_mul(arena, p, s);
    }
    BENCH_LEAST(TRIES, seconds, sum = expr_sum(arena, terms, 2 * WIDE));
    bench_line("expr.sum_40000", 1e3 * seconds, "ms");
    BENCH_LEAST(TRIES, seconds, folded = expr_fold(arena, sum));
    bench_line("expr.fold_40000", 1e3 * seconds, "ms");
    BENCH_LEAST(TRIES, seconds, expr_collect(arena, folded));
    bench_line("expr.collect_20000", 1e3 * seconds, "ms");
    mem_free(terms);
    arena_free(arena);
}

int main(void)
{
    measure_building();
    measure_derivative();
    measure_folding();
    measure_chain();
    return 0;
}
