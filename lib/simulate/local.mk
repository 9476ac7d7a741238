libcore_la_SOURCES += \
  lib/simulate/embed.c \
  lib/simulate/embed.h \
  lib/simulate/kkt.c \
  lib/simulate/kkt.h \
  lib/simulate/least.c \
  lib/simulate/least.h \
  lib/simulate/linear.c \
  lib/simulate/linear.h \
  lib/simulate/rank.c \
  lib/simulate/rank.h \
  lib/simulate/run.h
