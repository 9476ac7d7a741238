libcore_la_SOURCES += \
  lib/simulate/equations/equations_limits.h \
  lib/simulate/equations/failure_diagnosis.c \
  lib/simulate/equations/failure_diagnosis.h \
  lib/simulate/equations/partitioning.c \
  lib/simulate/equations/partitioning.h \
  lib/simulate/equations/factors.c \
  lib/simulate/equations/factors.h \
  lib/simulate/equations/variable_index.c \
  lib/simulate/equations/variable_index.h \
  lib/simulate/equations/articulated.c \
  lib/simulate/equations/articulated.h \
  lib/simulate/equations/implicit_jacobian.c \
  lib/simulate/equations/implicit_jacobian.h \
	lib/simulate/equations/elimination.c lib/simulate/equations/elimination.h \
  lib/simulate/equations/mass_matrix.c \
  lib/simulate/equations/mass_matrix.h \
  lib/simulate/equations/passing.h \
  lib/simulate/equations/mode_forms.c \
  lib/simulate/equations/mode_forms.h \
  lib/simulate/equations/motion.c \
  lib/simulate/equations/motion.h \
  lib/simulate/equations/motion_impl.h \
  lib/simulate/equations/motion_implicit.c \
  lib/simulate/equations/motion_place.c \
  lib/simulate/equations/motion_renew.c \
  lib/simulate/equations/motion_solve.c \
  lib/simulate/equations/motion_surfaces.c \
  lib/simulate/equations/netdae.c \
  lib/simulate/equations/netdae.h \
  lib/simulate/equations/netsolve.c \
  lib/simulate/equations/netsolve.h \
  lib/simulate/equations/compiled_equations.c lib/simulate/equations/compiled_calls.c lib/simulate/equations/compiled_compile.c \
  lib/simulate/equations/compiled_rates.c lib/simulate/equations/compiled_guards.c lib/simulate/equations/compiled_equations_impl.h \
  lib/simulate/equations/compiled_equations.h \
  lib/simulate/equations/parameters.c \
  lib/simulate/equations/parameters.h \
  lib/simulate/equations/probe.c \
  lib/simulate/equations/probe.h \
  lib/simulate/equations/probe_states.c \
  lib/simulate/equations/rate_jacobian.c \
  lib/simulate/equations/rate_jacobian.h \
  lib/simulate/equations/redundant.c \
  lib/simulate/equations/redundant.h \
  lib/simulate/equations/remark.c \
  lib/simulate/equations/remark.def \
  lib/simulate/equations/remark.h \
  lib/simulate/equations/rows.c \
  lib/simulate/equations/rows.h \
  lib/simulate/equations/simulation_input.h \
  lib/simulate/equations/signs.c \
  lib/simulate/equations/signs.h \
  lib/simulate/equations/stiff_elements.c \
  lib/simulate/equations/stiff_elements.h \
  lib/simulate/equations/stiff_elements_impl.h \
  lib/simulate/equations/stiff_elements_ranges.c
