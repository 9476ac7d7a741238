BENCHES += bench_network
bench_network_SOURCES = tests/bench/bench_network.c tests/bench/bench.h \
  tests/bench/bench_model.h
bench_network_LDADD = $(unit_ldadd)
