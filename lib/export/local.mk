libcore_la_SOURCES += \
  lib/export/formats.c \
  lib/export/write.h \
  lib/export/write_c.c \
  lib/export/write_csv.c \
  lib/export/write_dot.c \
  lib/export/write_latex.c
