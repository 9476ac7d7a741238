# unit tests of lib/formulate
