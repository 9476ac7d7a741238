BENCHES += bench_algebra
bench_algebra_SOURCES = tests/bench/bench_algebra.c tests/bench/bench.h tests/random.h
bench_algebra_LDADD = $(unit_ldadd)
