libcore_la_SOURCES += \
	lib/graph/graph.c lib/graph/graph.h \
	lib/graph/sets.c lib/graph/sets.h \
	lib/graph/sign_matrix.c \
	lib/graph/tree.c lib/graph/tree.h \
	lib/graph/tree_candidates.c lib/graph/tree_draft.c lib/graph/tree_draft.h \
	lib/graph/tree_fault.c
