# unit tests of lib/model/syntax.h
