libcore_la_SOURCES += \
  lib/simulate/sweep/correlation.c \
  lib/simulate/sweep/correlation.h \
  lib/simulate/sweep/distribution.c \
  lib/simulate/sweep/distribution.h \
  lib/simulate/sweep/random_stream.c \
  lib/simulate/sweep/random_stream.h \
  lib/simulate/sweep/row_file.c \
  lib/simulate/sweep/row_file.h \
  lib/simulate/sweep/sampling.c \
  lib/simulate/sweep/sampling.h \
  lib/simulate/sweep/sweep_table.c \
  lib/simulate/sweep/sweep_table.h
