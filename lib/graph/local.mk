libcore_la_SOURCES += \
	lib/graph/graph.c lib/graph/graph.h \
	lib/graph/sets.c lib/graph/sets.h \
	lib/graph/tree.h
