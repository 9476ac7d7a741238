libcore_la_SOURCES += \
  lib/export/archive.c \
  lib/export/archive.h \
  lib/export/c_step.c \
  lib/export/c_step.h \
  lib/export/code.h \
  lib/export/code_function.c \
  lib/export/code_head.c \
  lib/export/code_inverse.c \
  lib/export/code_live.c \
  lib/export/code_make.c \
  lib/export/code_modes.c \
  lib/export/code_print.c \
  lib/export/code_states.c \
  lib/export/code_text.c \
  lib/export/fmu.h \
  lib/export/fmu_description.c \
  lib/export/formats.c \
  lib/export/import.c \
  lib/export/import.h \
  lib/export/import_spice.c \
  lib/export/import_urdf.c \
  lib/export/importers.c \
  lib/export/shared_text.h \
  lib/export/spice_cards.c \
  lib/export/spice_cards.h \
  lib/export/spice_elements.c \
  lib/export/spice_impl.h \
  lib/export/spice_models.c \
  lib/export/spice_source.c \
  lib/export/spice_source.h \
  lib/export/spice_value.c \
  lib/export/spice_value.h \
  lib/export/write.h \
  lib/export/write_c.c \
  lib/export/write_code.c \
  lib/export/write_csv.c \
  lib/export/write_dot.c \
  lib/export/write_fmu.c \
  lib/export/write_fortran.c \
  lib/export/write_latex.c \
  lib/export/write_json.c \
  lib/export/write_mat.c \
  lib/export/write_matlab.c \
  lib/export/write_python.c \
  lib/export/xml.c \
  lib/export/xml.h

# what is the same for all models in code and FMUs, as strings, a line each
shared_parts = share/fmu/fmu.h share/fmu/fmu.c share/fmu/fmu_step.c share/fmu/fmu_ahead.c \
	share/fmu/fmu_open.c share/fmu/fmu_values.c lib/algebra/row_closure.h lib/algebra/row_closure.c \
	share/fmu/fmu_slide.c lib/algebra/complementarity.h lib/algebra/complementarity.c \
	lib/algebra/norm_complementarity.h lib/algebra/norm_complementarity.c \
	lib/algebra/surface_sides.h lib/algebra/surface_sides.c \
	share/fmu/fmi.h share/fmu/fmi2.c share/fmu/fmi3.c \
	share/code/modes.c share/code/modes_step.c share/code/open.c
EXTRA_DIST += $(shared_parts)
nodist_libcore_la_SOURCES = lib/export/shared_text.c
CLEANFILES += lib/export/shared_text.c
lib/export/shared_text.c: $(shared_parts) lib/export/local.mk
	$(AM_V_GEN)$(MKDIR_P) lib/export && { echo '#include "export/shared_text.h"'; \
	for part in $(shared_parts); do \
	  echo "const char *const shared_text_`basename $$part | tr . _`[] = {"; \
	  sed -e 's/\\/\\\\/g' -e 's/include "algebra\//include "/' -e 's/"/\\"/g' -e 's/^/"/' -e 's/$$/\\n",/' $(srcdir)/$$part; \
	  echo '0};'; done; } >$@.new && mv $@.new $@
