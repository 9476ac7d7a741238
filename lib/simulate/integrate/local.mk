libcore_la_SOURCES += \
  lib/simulate/integrate/condensed.c \
  lib/simulate/integrate/condensed.h \
  lib/simulate/integrate/cvode.c \
  lib/simulate/integrate/dop853.c \
  lib/simulate/integrate/dop853_dense.c \
  lib/simulate/integrate/dop853_impl.h \
  lib/simulate/integrate/dop853_scale.c \
  lib/simulate/integrate/dop853_stages.c \
  lib/simulate/integrate/dop853_stiff.c \
  lib/simulate/integrate/dop853_table.c \
  lib/simulate/integrate/fixed.c \
  lib/simulate/integrate/fixed.h \
  lib/simulate/integrate/gauss.c \
  lib/simulate/integrate/stagnation.c \
  lib/simulate/integrate/stagnation.h \
  lib/simulate/integrate/ida.c \
  lib/simulate/integrate/integrate_limits.h \
  lib/simulate/integrate/method.c \
  lib/simulate/integrate/methods.def \
  lib/simulate/integrate/ode.h \
  lib/simulate/integrate/radau.c \
  lib/simulate/integrate/rk4.c \
  lib/simulate/integrate/shifted.c \
  lib/simulate/integrate/shifted.h \
  lib/simulate/integrate/stepper.c \
  lib/simulate/integrate/sundials.c \
  lib/simulate/integrate/sundials.h
