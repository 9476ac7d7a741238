libcore_la_SOURCES += lib/graph/graph.h lib/graph/tree.h
