libcore_la_SOURCES += \
  lib/simulate/analyse/analyse_limits.h \
  lib/simulate/analyse/equilibrium.c \
  lib/simulate/analyse/freedoms.c \
  lib/simulate/analyse/freedoms.h \
  lib/simulate/analyse/gain.c \
  lib/simulate/analyse/gain.h \
  lib/simulate/analyse/linear_equations.h \
  lib/simulate/analyse/linearize.c \
  lib/simulate/analyse/linearize.h \
  lib/simulate/analyse/linearize_columns.c \
  lib/simulate/analyse/linearize_result.c \
  lib/simulate/analyse/linearize_settle.c \
  lib/simulate/analyse/linearize_impl.h \
  lib/simulate/analyse/linearize_point.c \
  lib/simulate/analyse/modes.c \
  lib/simulate/analyse/search.c \
  lib/simulate/analyse/search.h \
  lib/simulate/analyse/siso.c \
  lib/simulate/analyse/siso.h \
  lib/simulate/analyse/equilibrium_residual.c \
  lib/simulate/analyse/equilibrium_residual.h \
  lib/simulate/analyse/transfer.c \
  lib/simulate/analyse/transfer.h \
  lib/simulate/analyse/zero_pencil.c \
  lib/simulate/analyse/zero_pencil.h \
  lib/simulate/analyse/zeros.c \
  lib/simulate/analyse/zeros.h
