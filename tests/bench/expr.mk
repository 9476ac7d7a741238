BENCHES += bench_expr
bench_expr_SOURCES = tests/bench/bench_expr.c tests/bench/bench.h
bench_expr_LDADD = $(unit_ldadd)
