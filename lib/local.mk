# the public face: sessions
libcore_la_SOURCES += lib/session.c lib/cotree.h
