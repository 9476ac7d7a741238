# unit tests of lib/graph
UNIT_TESTS += test_graph_graph
test_graph_graph_SOURCES = tests/unit/test_graph_graph.c tests/unit/test.h
test_graph_graph_LDADD = $(unit_ldadd)
