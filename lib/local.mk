# the public face: sessions
libcore_la_SOURCES += lib/session.c lib/session_impl.h lib/session_statement.c lib/session_help.c \
	lib/session_linear.c lib/session_bode.c lib/session_look.c lib/session_trees.c lib/session_run.c \
	lib/session_bounds.c lib/session_freedoms.c lib/session_formula.c lib/session_value.c \
	lib/session_table.c lib/cotree.h
