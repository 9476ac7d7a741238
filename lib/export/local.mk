# what is shown, counted and drawn
libcore_la_SOURCES += lib/export/layout.h lib/export/layout.c \
	lib/export/abbreviate.h lib/export/abbreviate.c lib/export/view.h lib/export/view.c \
	lib/export/show.h lib/export/show.c lib/export/show_graph.c lib/export/show_equations.c \
	lib/export/show_session.c lib/export/show_linear.c lib/export/show_transfer.c \
	lib/export/show_state.c \
	lib/export/count.h lib/export/count.c \
	lib/export/latex_lines.h lib/export/latex_lines.c \
	lib/export/info.h lib/export/info.c lib/export/draw.c

# help, reference and completion
libcore_la_SOURCES += lib/export/help.h lib/export/help.c lib/export/help_topics.c \
	lib/export/reference.c lib/export/complete.c

# files in other formats
libcore_la_SOURCES += lib/export/write.h lib/export/write_csv.c lib/export/write_latex.c \
	lib/export/write_c.c lib/export/tables.h lib/export/tables.c
