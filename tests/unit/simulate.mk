# unit tests of lib/simulate
