libcore_la_SOURCES += lib/compile/program.h
