libcore_la_SOURCES += \
  lib/simulate/fit/differences.c \
  lib/simulate/fit/differences.h \
  lib/simulate/fit/fit_result.c \
  lib/simulate/fit/fit_result.h \
  lib/simulate/fit/fit_solve.c \
  lib/simulate/fit/fit_solve.h \
  lib/simulate/fit/fit_statistics.c \
  lib/simulate/fit/loss.c \
  lib/simulate/fit/loss.h \
  lib/simulate/fit/optimiser.c \
  lib/simulate/fit/optimiser.h \
  lib/simulate/fit/optimum.c \
  lib/simulate/fit/optimum.h
