libcore_la_SOURCES += \
  lib/simulate/assemble/assemble_limits.h \
  lib/simulate/assemble/reinitialise.c \
  lib/simulate/assemble/reinitialise.h \
  lib/simulate/assemble/reinitialise_impl.h \
  lib/simulate/assemble/reinitialise_stay.c \
  lib/simulate/assemble/reinitialise_targets.c \
  lib/simulate/assemble/level_rows.c \
  lib/simulate/assemble/level_rows.h \
  lib/simulate/assemble/mode_search.c \
  lib/simulate/assemble/mode_search.h \
  lib/simulate/assemble/mode_search_impl.h \
  lib/simulate/assemble/mode_search_jump.c \
  lib/simulate/assemble/kinematic_tree.c \
  lib/simulate/assemble/kinematic_tree.h \
  lib/simulate/assemble/kinematic_tree_rows.c \
  lib/simulate/assemble/perturbed_points.c lib/simulate/assemble/perturbed_points.h \
  lib/simulate/assemble/initial.c \
  lib/simulate/assemble/initial.h \
  lib/simulate/assemble/initial_given.c \
  lib/simulate/assemble/initial_guesses.c \
  lib/simulate/assemble/initial_impl.h \
  lib/simulate/assemble/initial_known.c \
  lib/simulate/assemble/initial_network.c \
  lib/simulate/assemble/initial_place.c \
  lib/simulate/assemble/initial_place_impl.h \
  lib/simulate/assemble/initial_problem.c \
  lib/simulate/assemble/initial_search.c \
  lib/simulate/assemble/initial_speed.c \
  lib/simulate/assemble/initial_trees.c \
  lib/simulate/assemble/initial_turns.c
