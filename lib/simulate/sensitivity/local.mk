libcore_la_SOURCES += \
  lib/simulate/sensitivity/item_slopes.c \
  lib/simulate/sensitivity/item_slopes.h \
  lib/simulate/sensitivity/sensitivity.c \
  lib/simulate/sensitivity/sensitivity.h \
  lib/simulate/sensitivity/sensitivity_impl.h \
  lib/simulate/sensitivity/sensitivity_jump.c \
  lib/simulate/sensitivity/sensitivity_pass.c \
  lib/simulate/sensitivity/sensitivity_values.c \
  lib/simulate/sensitivity/variational.c \
  lib/simulate/sensitivity/variational.h
