libcore_la_SOURCES += \
  lib/simulate/assemble/reset.c \
  lib/simulate/assemble/reset.h \
  lib/simulate/assemble/sides.c \
  lib/simulate/assemble/sides.h \
  lib/simulate/assemble/sides_impl.h \
  lib/simulate/assemble/sides_jump.c \
  lib/simulate/assemble/skeleton.c \
  lib/simulate/assemble/skeleton.h \
  lib/simulate/assemble/skeleton_rows.c \
  lib/simulate/assemble/start.c \
  lib/simulate/assemble/start.h \
  lib/simulate/assemble/start_given.c \
  lib/simulate/assemble/start_impl.h \
  lib/simulate/assemble/start_known.c \
  lib/simulate/assemble/start_network.c \
  lib/simulate/assemble/start_place.c \
  lib/simulate/assemble/start_place_impl.h \
  lib/simulate/assemble/start_problem.c \
  lib/simulate/assemble/start_search.c \
  lib/simulate/assemble/start_speed.c \
  lib/simulate/assemble/start_trees.c \
  lib/simulate/assemble/start_turns.c
