BENCHES += bench_formulate
bench_formulate_SOURCES = tests/bench/bench_formulate.c tests/bench/bench.h \
  tests/bench/bench_model.h tests/random.h
bench_formulate_LDADD = $(unit_ldadd)
