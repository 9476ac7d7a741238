libcore_la_SOURCES += \
  lib/export/code.h \
  lib/export/code_head.c \
  lib/export/code_inverse.c \
  lib/export/code_make.c \
  lib/export/code_print.c \
  lib/export/code_states.c \
  lib/export/formats.c \
  lib/export/import.c \
  lib/export/import.h \
  lib/export/import_spice.c \
  lib/export/import_urdf.c \
  lib/export/importers.c \
  lib/export/spice_source.c \
  lib/export/spice_source.h \
  lib/export/spice_value.c \
  lib/export/spice_value.h \
  lib/export/write.h \
  lib/export/write_c.c \
  lib/export/write_code.c \
  lib/export/write_csv.c \
  lib/export/write_dot.c \
  lib/export/write_fortran.c \
  lib/export/write_latex.c \
  lib/export/write_matlab.c \
  lib/export/write_python.c \
  lib/export/xml.c \
  lib/export/xml.h
