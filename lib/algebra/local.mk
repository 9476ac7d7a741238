libcore_la_SOURCES += \
  lib/algebra/blocks.c \
  lib/algebra/blocks.h \
  lib/algebra/dense.c \
  lib/algebra/dense.h \
  lib/algebra/enclosure.c \
  lib/algebra/enclosure.h \
  lib/algebra/hessenberg_form.c \
  lib/algebra/hessenberg_form.h \
  lib/algebra/kkt.c \
  lib/algebra/kkt.h \
  lib/algebra/levenberg_marquardt.c \
  lib/algebra/levenberg_marquardt.h \
  lib/algebra/linear.c \
  lib/algebra/linear.h \
  lib/algebra/matrix3.c \
  lib/algebra/matrix3.h \
  lib/algebra/rank.c \
  lib/algebra/rank.h \
  lib/algebra/schur.c \
  lib/algebra/schur.h \
  lib/algebra/sparse.c \
  lib/algebra/sparse.h \
  lib/algebra/spectrum.c \
  lib/algebra/spectrum.h \
  lib/algebra/square.c \
  lib/algebra/square.h \
  lib/algebra/wide.h
