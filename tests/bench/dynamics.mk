BENCHES += bench_dynamics
bench_dynamics_SOURCES = tests/bench/bench_dynamics.c tests/bench/bench.h \
  tests/bench/bench_model.h tests/bench/robot_text.h tests/unit/form.h
bench_dynamics_CPPFLAGS = $(AM_CPPFLAGS) -I$(srcdir)/tests/unit
bench_dynamics_LDADD = $(unit_ldadd)
