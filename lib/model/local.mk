libcore_la_SOURCES += lib/model/model.h lib/model/syntax.h
include lib/model/syntax.mk
