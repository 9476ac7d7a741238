libcore_la_SOURCES += \
  lib/model/measure.c \
  lib/model/measure.h \
  lib/model/measure_check.c \
  lib/model/model.c \
  lib/model/model.h \
  lib/model/model_build.c \
  lib/model/model_check.c \
  lib/model/model_coupled.c \
  lib/model/model_data.c \
  lib/model/model_define.c \
  lib/model/model_draft.h \
  lib/model/model_event.c \
  lib/model/model_function.c \
  lib/model/model_history.c \
  lib/model/model_history.h \
  lib/model/model_impl.h \
  lib/model/model_lines.c \
  lib/model/model_mark.c \
  lib/model/model_names.c \
  lib/model/model_param.c \
  lib/model/model_places.c \
  lib/model/model_scene.c \
  lib/model/model_start.c \
  lib/model/model_state.c \
  lib/model/model_tree.c \
  lib/model/model_value.c
