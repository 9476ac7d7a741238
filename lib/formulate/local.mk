libcore_la_SOURCES += lib/formulate/system.h
