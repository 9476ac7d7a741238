libcore_la_SOURCES += \
  lib/simulate/equations/causes.c \
  lib/simulate/equations/causes.h \
  lib/simulate/equations/embed.c \
  lib/simulate/equations/embed.h \
  lib/simulate/equations/layout.c \
  lib/simulate/equations/motion.c \
  lib/simulate/equations/motion.h \
  lib/simulate/equations/motion_impl.h \
  lib/simulate/equations/motion_renew.c \
  lib/simulate/equations/motion_surfaces.c \
  lib/simulate/equations/netdae.c \
  lib/simulate/equations/netdae.h \
  lib/simulate/equations/netsolve.c \
  lib/simulate/equations/netsolve.h \
  lib/simulate/equations/numbers.c \
  lib/simulate/equations/numbers.h \
  lib/simulate/equations/parameters.c \
  lib/simulate/equations/redundant.c \
  lib/simulate/equations/redundant.h \
  lib/simulate/equations/rows.c \
  lib/simulate/equations/rows.h \
  lib/simulate/equations/setting.h \
  lib/simulate/equations/signs.c \
  lib/simulate/equations/signs.h \
  lib/simulate/equations/steep.c \
  lib/simulate/equations/steep.h
