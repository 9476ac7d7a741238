# unit tests of lib/compile
