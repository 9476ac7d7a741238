libcore_la_SOURCES += \
  lib/export/formats.c \
  lib/export/import.c \
  lib/export/import.h \
  lib/export/import_spice.c \
  lib/export/importers.c \
  lib/export/spice_source.c \
  lib/export/spice_source.h \
  lib/export/spice_value.c \
  lib/export/spice_value.h \
  lib/export/write.h \
  lib/export/write_c.c \
  lib/export/write_csv.c \
  lib/export/write_dot.c \
  lib/export/write_latex.c
