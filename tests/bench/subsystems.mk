BENCHES += bench_subsystems
bench_subsystems_SOURCES = tests/bench/bench_subsystems.c tests/bench/bench.h \
  tests/bench/bench_compile.h tests/bench/bench_model.h tests/random.h
bench_subsystems_LDADD = $(unit_ldadd)
