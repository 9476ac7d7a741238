BENCHES += bench_session
bench_session_SOURCES = tests/bench/bench_session.c tests/bench/bench.h \
  tests/bench/bench_model.h tests/unit/session_kit.h
bench_session_LDADD = $(unit_ldadd)
