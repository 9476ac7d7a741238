BENCHES += bench_graph
bench_graph_SOURCES = tests/bench/bench_graph.c tests/bench/bench.h
bench_graph_LDADD = $(unit_ldadd)
