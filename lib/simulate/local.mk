libcore_la_SOURCES += lib/simulate/run.h
