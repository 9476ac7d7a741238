libcore_la_SOURCES += lib/component/component.h lib/component/types.def
