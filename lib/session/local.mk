libcore_la_SOURCES += \
  lib/session/session.c \
  lib/session/session_bode.c \
  lib/session/session_bounds.c \
  lib/session/session_draw.c \
  lib/session/session_figures.c \
  lib/session/session_formula.c \
  lib/session/session_freedoms.c \
  lib/session/session_help.c \
  lib/session/session_impl.h \
  lib/session/session_import.c \
  lib/session/session_input.c \
  lib/session/session_keep.c \
  lib/session/session_linear.c \
  lib/session/session_look.c \
  lib/session/session_plot.c \
  lib/session/session_run.c \
  lib/session/session_spectrum.c \
  lib/session/session_start.c \
  lib/session/session_statement.c \
  lib/session/session_systems.c \
  lib/session/session_table.c \
  lib/session/session_trees.c \
  lib/session/session_value.c \
  lib/cotree.h
