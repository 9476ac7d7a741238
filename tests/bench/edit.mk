BENCHES += bench_edit
bench_edit_SOURCES = tests/bench/bench_edit.c tests/bench/bench.h \
  tests/bench/bench_compile.h tests/bench/bench_model.h tests/random.h
bench_edit_LDADD = $(unit_ldadd)
