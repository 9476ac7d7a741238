# the shell
bin_PROGRAMS += cotree
cotree_SOURCES = \
    src/bode.c \
    src/command_call.c src/command_call.h \
    src/command.c src/command.h \
    src/command_draw.c src/command_look.c src/command_run.c src/command_session.c \
    src/report_error.c src/report_error.h \
    src/copy.c src/copy.h \
    src/drawing.c src/drawing.h \
    src/file.c src/file.h \
    src/gnuplot.c src/gnuplot.h \
    src/interrupt.c src/interrupt.h \
    src/library.c src/library.h \
    src/line_edit.c src/line_edit.h \
    src/main.c \
    src/out_of_memory.c src/out_of_memory.h \
    src/pager.c src/pager.h \
    src/plot.c src/plot.h src/plot_commands.c src/plot_sweep.c src/plot_sweep.h \
    src/plot_text.c \
    src/process.c src/process.h \
    src/progress.c src/progress.h \
    src/reader.c src/reader.h \
    src/replay.c src/replay.h \
    src/saved.c src/saved.h \
    src/settings.c src/settings.h src/settings.def \
    src/shell.c src/shell.h \
    src/terminal.c src/terminal.h \
    src/autosave.c src/autosave.h
cotree_CPPFLAGS = $(AM_CPPFLAGS) $(READLINE_CFLAGS)
cotree_LDADD = libcotree.la $(READLINE_LIBS)
