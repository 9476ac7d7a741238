BENCHES += bench_program
bench_program_SOURCES = tests/bench/bench_program.c tests/bench/bench.h
bench_program_LDADD = $(unit_ldadd)
BENCHES += bench_native
bench_native_SOURCES = tests/bench/bench_native.c tests/bench/bench.h tests/bench/bench_model.h \
  tests/random.h tests/unit/form.h tests/unit/session_kit.h tests/unit/test.h
bench_native_LDADD = $(unit_ldadd)
