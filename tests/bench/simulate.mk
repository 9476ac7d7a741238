BENCHES += bench_simulate
bench_simulate_SOURCES = tests/bench/bench_simulate.c tests/bench/bench.h \
  tests/unit/simulate_script.h tests/unit/test.h
bench_simulate_CPPFLAGS = $(AM_CPPFLAGS) -I$(srcdir)/tests/unit
bench_simulate_LDADD = $(unit_ldadd)
BENCHES += bench_structure
bench_structure_SOURCES = tests/bench/bench_structure.c tests/bench/bench.h \
  tests/unit/simulate_script.h tests/unit/test.h
bench_structure_CPPFLAGS = $(AM_CPPFLAGS) -I$(srcdir)/tests/unit
bench_structure_LDADD = $(unit_ldadd)
