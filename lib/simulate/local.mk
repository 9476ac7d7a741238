libcore_la_SOURCES += \
  lib/simulate/cvode.c \
  lib/simulate/dop853.c \
  lib/simulate/dop853_table.h \
  lib/simulate/embed.c \
  lib/simulate/embed.h \
  lib/simulate/ida.c \
  lib/simulate/kkt.c \
  lib/simulate/kkt.h \
  lib/simulate/least.c \
  lib/simulate/least.h \
  lib/simulate/linear.c \
  lib/simulate/linear.h \
  lib/simulate/march.c \
  lib/simulate/march.h \
  lib/simulate/method.c \
  lib/simulate/methods.def \
  lib/simulate/motion.c \
  lib/simulate/motion.h \
  lib/simulate/ode.h \
  lib/simulate/rank.c \
  lib/simulate/rank.h \
  lib/simulate/rk4.c \
  lib/simulate/run.h
