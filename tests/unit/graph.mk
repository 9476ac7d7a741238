# unit tests of lib/graph
UNIT_TESTS += test_graph_graph test_graph_tree test_graph_fault
test_graph_graph_SOURCES = tests/unit/test_graph_graph.c tests/unit/test.h
test_graph_graph_LDADD = $(unit_ldadd)
test_graph_tree_SOURCES = tests/unit/test_graph_tree.c tests/unit/test.h
test_graph_tree_LDADD = $(unit_ldadd)
test_graph_fault_SOURCES = tests/unit/test_graph_fault.c tests/unit/test.h
test_graph_fault_LDADD = $(unit_ldadd)
